/* published.h - machines/published.csv: measured and advertised figures of real machines, each with its source. */
#ifndef APP_PUBLISHED_H
#define APP_PUBLISHED_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"
#include "run/probe.h"

/* One figure. Texts lie in the arena. */
struct published {
    const char *id;
    const char *machine; /* stem of the machine file */
    enum probe_quantity quantity;
    const char *at_text; /* as written, "" where the quantity has no place */
    double at;
    double value, low, high; /* SI; low = high = value without a published range */
    const char *unit;        /* as written: us, MB/s, B, ... */
    double scale;            /* SI per unit */
    const char *evidence;    /* P, PR, D, E */
    bool calibrated;         /* a number of the machine file was derived from it */
    double add;              /* SI, what the simulator leaves out, added to its answer */
    int nset;
    const char **set; /* (nset) "machine.key=value": the machine that was measured, where it is not the file's */
    const char *source;
};

/* published_read: all rows of `path` into (*n) records in `a`.
 * Returns false with ERR_NO_INPUT, ERR_IO, or ERR_DATA with file and line. */
bool published_read(const char *path, struct arena *a, struct published **row, int *n, struct err *e);

#endif
