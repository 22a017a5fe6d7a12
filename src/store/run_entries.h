/* run_entries.h - rows that a run has many of, kept as one text a run, and shown as rows by views:
 * where the time of single ranks went (rank_stage), what passed the links (link_load).
 *
 * The text is JSON, "[[key, ..., value, ...], ...]", so that any program with SQLite reads the
 * views, without functions of ours. */
#ifndef STORE_RUN_ENTRIES_H
#define STORE_RUN_ENTRIES_H

#include <stdbool.h>

#include "base/text.h"
#include "measure/column.h"
#include "measure/run_result.h"

/* One such view. An entry holds its keys, then the columns, all of them integers or absent. */
struct entry_view {
    const char *view, *table;          /* names in schema.sql */
    const char *const *key;            /* (nkey) what tells the entries of a run apart */
    int nkey;
    const struct column_table *columns;
};

enum { ENTRY_RANK_STAGE, ENTRY_LINK_LOAD, ENTRY_VIEWS };
extern const struct entry_view entry_view[ENTRY_VIEWS];

/* run_entries_ranks: whether those of a run of nrank ranks are kept; of more, sums alone. */
bool run_entries_ranks(int nrank);

/* rank_entries: all ranks and stages of `r` in that order, but for stages in which a rank did
 * nothing; appended. */
void rank_entries(const struct run_result *r, struct text *t);

/* link_entries: the links of `r` in the order of their numbers, of more than STORE_LINK_ROWS the
 * busiest; appended. */
void link_entries(const struct run_result *r, struct text *t);

#endif
