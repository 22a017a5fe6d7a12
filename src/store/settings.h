/* settings.h - the settings of a run as rows that all runs share.
 *
 * Each setting and value stands once in table setting; table run_setting says which run has which.
 * A run has some 170, and shares nearly all with the run before, whose rows are remembered. */
#ifndef STORE_SETTINGS_H
#define STORE_SETTINGS_H

#include "store/connection.h"

/* settings_put: the "key = value" lines of a run's configuration `config`, which may be NULL.
 * Nothing where the database is a passing one, whose settings nobody asks for. Within a
 * transaction; returns false with *e set. */
bool settings_put(struct store *s, int64_t run, const char *config, struct err *e);

/* settings_forget: rows that were put may be gone again. Nothing else removes one. */
void settings_forget(struct store *s);

#endif
