/* text.h - strings: nearest valid name, growing buffer, whole files. */
#ifndef BASE_TEXT_H
#define BASE_TEXT_H

#include <stdbool.h>
#include <stddef.h>

#include "base/err.h"

/* text_nearest: the name among `names` (n of them) with the smallest edit distance to `word` (a swap of two
 * neighbours counts one), ignoring case, the first of equals. When none is close enough to be a likely
 * misspelling (distance > 1 + length/3): the shortest name that `word` abbreviates, or NULL. */
const char *text_nearest(const char *word, const char *const *names, int n);

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

/* text_free: give the memory back and return to {0}. */
void text_free(struct text *t);

/* text_read_file: the whole file `path` into *t (replaced). Returns false with ERR_NO_INPUT or ERR_IO. */
bool text_read_file(struct text *t, const char *path, struct err *e);

/* text_copy: copy s into buffer[size], truncating; always NUL-terminated. */
void text_copy(char *buffer, size_t size, const char *s);

/* text_real: x with as few digits (15 to 17) as read back to the same double. */
void text_real(char buffer[32], double x);

#endif
