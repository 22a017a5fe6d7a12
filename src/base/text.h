/* text.h - strings: nearest valid name, growing buffer, whole files. */
#ifndef BASE_TEXT_H
#define BASE_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/err.h"

/* text_nearest: the name among `names` (n of them) with the smallest edit distance to `word` (a
 * swap of two neighbours counts one), ignoring case, the first of equals. When none is close enough
 * to be a likely misspelling (distance > 1 + length/3): the shortest name that `word` abbreviates,
 * or NULL. */
const char *text_nearest(const char *word, const char *const *names, int n);

/* text_hint: the end of a message about an unknown word: "; did you mean 'NAME'?" of the nearest
 * name, or `otherwise` where none is near. Use its member: text_hint(word, names, n, "").s. */
struct text_hint {
    char s[200];
};
struct text_hint text_hint(const char *word, const char *const *names, int n,
                           const char *otherwise);

/* A growing text on the heap; start from {0}, end with text_free. */
struct text {
    char *s;         /* NUL-terminated, owned; NULL when nothing was added yet */
    size_t length;   /* without the NUL */
    size_t capacity;
};

/* text_reserve: room for `n` more bytes and a NUL behind them. */
void text_reserve(struct text *t, size_t n);

/* text_add: append printf-like. */
void text_add(struct text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* text_add_bytes: append `n` bytes. */
void text_add_bytes(struct text *t, const char *s, size_t n);

/* text_put_integer: the decimal digits of `v`, with its sign, at `at`, without a NUL; returns where
 * they end. In a tenth of printf's time. text_add_integer: append them. */
enum { TEXT_INTEGER = 20 }; /* characters at most */
char *text_put_integer(char *at, int64_t v);
void text_add_integer(struct text *t, int64_t v);

/* text_free: give the memory back and return to {0}. */
void text_free(struct text *t);

/* text_file_kind: what a file with st_mode `mode` is, for messages: "a pipe", "a folder". */
const char *text_file_kind(unsigned mode);

/* text_open_file: the regular file `path` for reading, opened without waiting for anybody, and not
 * through a pipe or a device, which may have no end. Returns NULL with ERR_NO_INPUT (not there),
 * ERR_DATA (no regular file) or ERR_IO. */
FILE *text_open_file(const char *path, struct err *e);

/* text_read_file: the whole regular file `path` into *t (replaced). Returns false with
 * ERR_NO_INPUT, ERR_DATA (no regular file), ERR_CONFIG (larger than this computer's memory) or
 * ERR_IO. */
bool text_read_file(struct text *t, const char *path, struct err *e);

/* text_read_stream: all that is left of `in` into *t (replaced), for standard input; `name` is what
 * messages call it. Returns false with ERR_IO. */
bool text_read_stream(struct text *t, FILE *in, const char *name, struct err *e);

/* text_stream: a stream that appends what is printed on it to *t, until it is closed with
 * text_stream_end. */
FILE *text_stream(struct text *t);
void text_stream_end(FILE *stream);

/* text_copy: copy s into buffer[size], truncating; always NUL-terminated. */
void text_copy(char *buffer, size_t size, const char *s);

/* text_real: x with as few digits (15 to 17) as read back to the same double. */
void text_real(char buffer[32], double x);

#endif
