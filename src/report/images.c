/* images.c - the pictures that gnuplot has made of a figure: whole, or not there.
 *
 * gnuplot writes them under their names by itself, and ends with status 0 when the disk is full or
 * the script has drawn nothing. A PNG file ends with the chunk IEND (PNG 1.2, 11.2.5), an SVG file
 * with its root's end tag: what has its end was written whole. */
#include "report/images.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"

/* Of both formats: the ending of the name, and what stands at the end of a file that is whole. */
static const struct format {
    const char *ending, *end;
    int length;
} formats[] = {
    {"png", "\0\0\0\0IEND\xae\x42\x60\x82", 12},
    {"svg", "</svg>", 6},
};
enum { FORMATS = sizeof formats / sizeof *formats, TAIL = 64 };

static void path_of(struct text *path, const char *dir, const char *name, const struct format *f)
{
    text_add(path, "%s/%s.%s", dir, name, f->ending);
}

void images_remove(const char *dir, const char *name)
{
    for (int i = 0; i < FORMATS; i++) {
        struct text path = {0};
        path_of(&path, dir, name, &formats[i]);
        unlink(path.s);
        text_free(&path);
    }
}

/* Whether the last bytes of the file, but for line ends, are those of a whole one. */
static bool has_end(FILE *in, const struct format *f)
{
    char tail[TAIL];
    if (fseek(in, 0, SEEK_END) != 0) return false;
    const long size = ftell(in), from = size > TAIL ? size - TAIL : 0;
    if (size < 0 || fseek(in, from, SEEK_SET) != 0) return false;
    size_t n = fread(tail, 1, sizeof tail, in);
    while (n > 0 && tail[n - 1] == '\n') n--;
    return n >= (size_t)f->length && memcmp(tail + n - f->length, f->end, (size_t)f->length) == 0;
}

bool images_check(const char *work, const char *dir, const char *name, struct err *e)
{
    int there = 0;
    bool whole = true;
    for (int i = 0; i < FORMATS && whole; i++) {
        struct text path = {0};
        path_of(&path, work, name, &formats[i]);
        FILE *in = access(path.s, F_OK) == 0 ? text_open_file(path.s, e) : NULL;
        whole = e->kind == ERR_NONE;
        if (in != NULL) {
            there++;
            whole = has_end(in, &formats[i]);
            fclose(in);
        }
        if (!whole)
            err_set(e, ERR_IO, "%s/%s.%s was not drawn to its end: is the disk full?", dir, name,
                    formats[i].ending);
        text_free(&path);
    }
    /* A script may draw one format alone; none is no drawing. */
    return whole && (there > 0 ||
                     err_set(e, ERR_UNAVAILABLE,
                             "gnuplot has ended without a picture %s/%s.png or .svg; the data and "
                             "the script are beside it",
                             dir, name));
}
