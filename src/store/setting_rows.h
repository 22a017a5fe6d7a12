/* setting_rows.h - the settings of a database's first run, put by one statement.
 *
 * A statement for each of them takes twice as long: it begins, ends and reports each time. */
#ifndef STORE_SETTING_ROWS_H
#define STORE_SETTING_ROWS_H

#include "store/connection.h"

/* A row of table setting; all texts are borrowed. */
struct setting_row {
    const char *key, *value, *unit;
    double number; /* in SI base units */
    bool numeric;  /* whether there is a number */
};

/* setting_rows_put: the (n) rows `row` into table setting, in which none of them is, and that run
 * `run` has all settings of that table, which has no others. *first: the id of row[0]; those of the
 * rest follow it one by one. Within a transaction; returns false with *e set. */
bool setting_rows_put(struct store *s, int64_t run, const struct setting_row *row, size_t n,
                      int64_t *first, struct err *e);

#endif
