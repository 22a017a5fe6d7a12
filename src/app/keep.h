/* keep.h - ladders and grades of stability into the database, in place of older ones of the same
 * scenario, and their figures out of it. */
#ifndef APP_KEEP_H
#define APP_KEEP_H

#include "app/verb.h"
#include "store/store.h"
#include "study/accuracy.h"
#include "study/stability.h"

/* keep_accuracy: tables ladder and ladder_choice. keep_stability: table stability. One transaction
 * each; they return false as store_insert does, with nothing changed. */
bool keep_accuracy(struct store *s, const struct accuracy_report *r, struct err *e);
bool keep_stability(struct store *s, const struct stability_report *r, struct err *e);

/* keep_open: the database and the folder of figures that the command line names, asked for before
 * anything is computed. A new database gets its file from store_publish alone. Returns NULL as
 * store_open, or with ERR_CREATE. */
struct store *keep_open(const struct common *c, struct err *e);

/* keep_draw: draw `figure` from `s` into the folder that the command line names, and say on stderr,
 * unless quiet, where it is and how to have a report with it. Returns false as report_figure. */
bool keep_draw(const struct common *c, struct store *s, const char *figure, struct err *e);

#endif
