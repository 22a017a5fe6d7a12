/* keep.h - ladders and grades of stability into the database, in place of older ones of the same scenario. */
#ifndef APP_KEEP_H
#define APP_KEEP_H

#include "run/accuracy.h"
#include "run/stability.h"
#include "store/store.h"

/* keep_accuracy: tables ladder and ladder_choice. keep_stability: table stability. One transaction each; they return
 * false as store_insert does, with nothing changed. */
bool keep_accuracy(struct store *s, const struct accuracy_report *r, struct err *e);
bool keep_stability(struct store *s, const struct stability_report *r, struct err *e);

#endif
