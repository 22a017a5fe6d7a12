/* last_words.h - what a process says that a CHECK or an abort ends. */
#ifndef SUPPORT_LAST_WORDS_H
#define SUPPORT_LAST_WORDS_H

#include <stddef.h>

/* expect_abort: run `act` in a process of its own, which must end by abort(); what it wrote to its
 * standard error is in `words`. */
void expect_abort(void (*act)(void), char *words, size_t size);

#endif
