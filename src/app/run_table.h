/* run_table.h - what `mimdsim run` answers: one row a run of the plan, one column a key that the
 * scenario sweeps. */
#ifndef APP_RUN_TABLE_H
#define APP_RUN_TABLE_H

#include <stdbool.h>
#include <stdio.h>

#include "plan/plan.h"
#include "store/store.h"

/* How the rows are shown. */
struct run_table_look {
    bool json, csv;      /* all columns, for programs; else a table for people */
    const char *columns; /* --columns: names with commas, "all"; NULL: those that say something */
};

/* run_table_take: "--columns LIST" and "--csv" out of the arguments. False with ERR_USAGE. */
bool run_table_take(int *argc, char **argv, struct run_table_look *l, struct err *e);

/* run_table_check: whether the columns that `l` names are there for the runs of `p`, before any run
 * is made. False with ERR_USAGE. */
bool run_table_check(const struct plan *p, const struct run_table_look *l, struct err *e);

/* run_table_show: the rows of any query with one parameter in the same look, but for the choice of
 * columns. */
bool run_table_show(struct store *s, const char *sql, const char *param,
                    const struct run_table_look *l, FILE *out, struct err *e);

/* run_table_print: the runs of `p` that `s` holds, in plan order. The keys that are swept stand
 * behind P, each by the end of its name that no other column has: link.bandwidth. A table leaves
 * out columns without any value, and on a terminal it is at most as wide: what is the same in all
 * rows then stands above it. Returns false with ERR_IO, or ERR_USAGE: an unknown column, with the
 * nearest. */
bool run_table_print(struct store *s, const struct plan *p, const struct run_table_look *l,
                     FILE *out, struct err *e);

#endif
