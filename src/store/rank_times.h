/* rank_times.h - where the time of single ranks went, as one text a run; view rank_stage shows its
 * rows.
 *
 * The text is JSON, so that any program with SQLite reads the view, without functions of ours. */
#ifndef STORE_RANK_TIMES_H
#define STORE_RANK_TIMES_H

#include "base/text.h"
#include "measure/run_result.h"
#include "store/connection.h"

/* An entry begins with rank and stage; the columns of struct stage_time follow (run_row.h). */
enum { RANK_ENTRY_KEYS = 2 };

/* rank_times_add: "[[rank, stage, ...], ...]" of all ranks and stages of `r` in that order, but for
 * stages in which a rank did nothing; appended. */
void rank_times_add(const struct run_result *r, struct text *t);

/* rank_times_upgrade: rows of the table that view rank_stage was before version 7, put aside under
 * the name `older`, become entries of rank_times; the table goes. Within the caller's
 * transaction. */
bool rank_times_upgrade(struct store *s, const char *older, struct err *e);

#endif
