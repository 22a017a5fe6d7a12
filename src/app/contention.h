/* contention.h - what each level of the network makes of messages that meet on a named machine's
 * wires. */
#ifndef APP_CONTENTION_H
#define APP_CONTENTION_H

#include "app/validation.h"
#include "base/json.h"

enum { CONTENTION_RANKS = 16, CONTENTION_ROWS = 2 };

/* One pattern at every level: bytes that each of `ranks` sends a second [B/s], NAN where the
 * machine has no such level (worms that do not fit the buffers). */
struct contention {
    enum probe_quantity quantity;
    int ranks;
    double level[LEVELS];
};

/* contention_measure: total exchange and exchange of halves among CONTENTION_RANKS ranks, or all of
 * a smaller machine, into row[CONTENTION_ROWS]. Returns how many rows there are: 0 on a machine of
 * fewer than four, -1 with the error of plan_machine. */
int contention_measure(const char *machine, struct contention row[CONTENTION_ROWS], struct arena *a,
                       struct err *e);

/* contention_print, contention_json: as a table, and as the member "contention" of the object that
 * is open. */
void contention_print(const struct contention *row, int n);
void contention_json(const struct contention *row, int n, struct json *j);

#endif
