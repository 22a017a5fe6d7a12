/* text_file.c - whole files and streams as texts; apart from text.c, which err.c stands on.
 *
 * Files come from strangers, and their names stand in files of strangers: a name may lead to a
 * device without an end, or to a pipe that nobody writes. Only regular files are read, and their
 * size is known before memory is taken. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/check.h"
#include "base/size.h"
#include "base/text.h"

const char *text_file_kind(unsigned mode)
{
    if (S_ISREG(mode)) return "a file";
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a pipe";
    if (S_ISSOCK(mode)) return "a socket";
    return "a device";
}

FILE *text_open_file(const char *path, struct err *e)
{
    struct stat info;
    /* O_NONBLOCK: the opening of a pipe would wait for its writer. O_NOCTTY: a terminal's would
     * make it ours. On a regular file neither has an effect. */
    int file = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file < 0) {
        /* A socket cannot be opened; what it is says more than "No such device or address". */
        const bool other = errno == ENXIO && stat(path, &info) == 0 && !S_ISREG(info.st_mode);
        if (other) err_set_at(e, ERR_DATA, path, 0, "%s, not a file", text_file_kind(info.st_mode));
        else err_set_at(e, ERR_NO_INPUT, path, 0, "cannot open: %s", strerror(errno));
        return NULL;
    }
    /* Of the opened file, not of the name: it may lead elsewhere by now. */
    FILE *in = NULL;
    if (fstat(file, &info) != 0) err_set_at(e, ERR_IO, path, 0, "cannot read: %s", strerror(errno));
    else if (!S_ISREG(info.st_mode))
        err_set_at(e, ERR_DATA, path, 0, "%s, not a file", text_file_kind(info.st_mode));
    else if ((in = fdopen(file, "rb")) == NULL)
        err_set_at(e, ERR_INTERNAL, path, 0, "cannot open: %s", strerror(errno));
    if (!in) close(file);
    return in;
}

bool text_read_stream(struct text *t, FILE *in, const char *name, struct err *e)
{
    t->length = 0;
    /* Read until a short read: a file may have grown since it was looked at. */
    bool more = true;
    while (more) {
        text_reserve(t, 65536);
        size_t n = fread(t->s + t->length, 1, 65536, in);
        t->length += n;
        /* A signal is no reason to give up. */
        more = n == 65536 || (ferror(in) && errno == EINTR);
        if (more) clearerr(in);
    }
    t->s[t->length] = '\0';
    /* A part of a file is no file. */
    return !ferror(in) || err_set_at(e, ERR_IO, name, 0, "cannot read: %s", strerror(errno));
}

bool text_read_file(struct text *t, const char *path, struct err *e)
{
    struct stat info;
    FILE *in = text_open_file(path, e);
    if (!in) return false;
    /* Refused before any of it is in memory, with the size that the system tells. */
    const size_t size = fstat(fileno(in), &info) == 0 ? (size_t)info.st_size : 0;
    const bool ok =
        size_in_memory(size, path, 0, "the file", e) && text_read_stream(t, in, path, e);
    fclose(in);
    return ok;
}

/* A stream's buffer, on its way into the text. */
static ssize_t append(void *text, const char *data, size_t size)
{
    text_add_bytes(text, data, size);
    return (ssize_t)size;
}

/* Not open_memstream, whose output is short, without a word, when there is no memory for more. */
FILE *text_stream(struct text *t)
{
    FILE *stream = fopencookie(t, "w", (cookie_io_functions_t){.write = append});
    if (!stream) check_memory(BUFSIZ);
    text_add_bytes(t, "", 0); /* an empty text, where nothing is printed */
    return stream;
}

void text_stream_end(FILE *stream) { fclose(stream); }
