/* vector_mutant.h - reference vectors with answers changed in their text: what verify must find. */
#ifndef TESTS_RUN_VECTOR_MUTANT_H
#define TESTS_RUN_VECTOR_MUTANT_H

#include <stdbool.h>
#include <stddef.h>

/* vector_text_numbers: where the numbers of the value of `key` stand in `text`, first character
 * each, in their order; keys of a map inside the value are passed over. `from`: search from there.
 * Returns how many, at most `room`; 0: the key is not there. */
int vector_text_numbers(const char *text, const char *key, const char *from, const char **number,
                        int room);

/* vector_text_key: the key in quotes, followed by a colon, or NULL. */
const char *vector_text_key(const char *text, const char *key);

/* vector_text_put: a new text (malloc) where the token at `at` of `length` characters is
 * replaced. */
char *vector_text_put(const char *text, const char *at, size_t length, const char *with);

/* vector_text_end: the first character behind the number at `at`. */
const char *vector_text_end(const char *at);

#endif
