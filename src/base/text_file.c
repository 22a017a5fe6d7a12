/* text_file.c - a whole file as a text; apart from text.c, which err.c stands on. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"

bool text_read_file(struct text *t, const char *path, struct err *e)
{
    t->length = 0;
    FILE *in = fopen(path, "rb");
    if (!in) return err_set_at(e, ERR_NO_INPUT, path, 0, "cannot open: %s", strerror(errno));
    /* Read until a short read: files of unknown length, pipes too. */
    size_t n;
    do { /* a directory opens well and fails in the first read */
        text_reserve(t, 65536);
        n = fread(t->s + t->length, 1, 65536, in);
        t->length += n;
    } while (n == 65536);
    t->s[t->length] = '\0';
    int failure = ferror(in) ? errno : 0;
    fclose(in);
    /* A part of a file is no file. */
    if (failure) return err_set_at(e, ERR_IO, path, 0, "cannot read: %s", strerror(failure));
    return true;
}
