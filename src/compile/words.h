/* words.h - lists of words: command lines. */
#ifndef COMPILE_WORDS_H
#define COMPILE_WORDS_H

#include "base/arena.h"
#include "base/err.h"

/* A list that grows in an arena, always ended by NULL; start from {.arena = a}. Words are borrowed.
 */
struct words {
    struct arena *arena;
    const char **word;
    int n, capacity;
};

/* words_add: append a word. words_add_all: append n words. */
void words_add(struct words *w, const char *word);
void words_add_all(struct words *w, int n, const char *const *word);

/* words_add_parts: append the parts of a text that blanks separate; quotes and backslashes keep a
 * part together, as in gcc's @file. Copied. */
void words_add_parts(struct words *w, const char *text);

/* words_expand: append n words, each @FILE replaced by the words in FILE; one that cannot be read
 * stays as it is, as with gcc. Files in files are followed to a depth of 10; deeper is ERR_USAGE.
 */
bool words_expand(struct words *w, int n, const char *const *word, struct err *e);

#endif
