/* last_words.h - what a process says that a CHECK or an abort ends. */
#ifndef SUPPORT_LAST_WORDS_H
#define SUPPORT_LAST_WORDS_H

#include <stddef.h>

/* words_of: run `act` in a process of its own; what it wrote to its standard error is in `words`.
 * Returns how it ended, as waitpid says. */
int words_of(void (*act)(void), char *words, size_t size);

/* expect_abort: the same; it must end by abort(). */
void expect_abort(void (*act)(void), char *words, size_t size);

#endif
