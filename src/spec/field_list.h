/* field_list.h - the list kinds of field.c: "[8, 4, 4]", "8x4x4", "[0, 0, -9.81] m/s^2", "[[0, 1],
 * [1, 2]]". */
#ifndef SPEC_FIELD_LIST_H
#define SPEC_FIELD_LIST_H

#include "spec/field.h"

/* Readers of one kind each; arguments and failure as field_set. Nothing is changed on failure. */
bool field_ints_set(const struct field *f, void *base, const char *text, char *why, int size);
bool field_reals_set(const struct field *f, void *base, const char *text, char *why, int size);
bool field_int_list_set(const struct field *f, void *base, const char *text, struct arena *a,
                        char *why, int size);
bool field_pair_list_set(const struct field *f, void *base, const char *text, struct arena *a,
                         char *why, int size);

/* field_list_print: any list kind, as field_print. */
void field_list_print(const struct field *f, const void *base, struct text *out);

/* field_refuse: the clause, printf-like, into `why`. Always returns false. */
bool field_refuse(char *why, int size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* field_in_range: whether `value` is within the field's bounds; the clause in `why` names them. */
bool field_in_range(const struct field *f, double value, char *why, int size);

/* field_int_parse: a decimal whole number and nothing after it. */
bool field_int_parse(const char *text, int64_t *value, char *why, int size);

#endif
