/* published.h - machines/published.csv: measured and advertised figures of real machines, each with
 * its source. */
#ifndef APP_PUBLISHED_H
#define APP_PUBLISHED_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"
#include "study/probe.h"

/* What a figure is to the machine file. */
enum published_use {
    USE_CALIBRATED, /* "yes": a number of the file was derived from it */
    USE_HELD,       /* "no": nothing was; it says how well the model predicts */
    USE_OTHER       /* "other": measured on other software or another machine; its error is shown */
};

/* One figure. Texts lie in the arena. */
struct published {
    const char *id;
    const char *machine; /* stem of the machine file */
    enum probe_quantity quantity;
    const char *at_text; /* as written, "" where the quantity has no place */
    double at;
    int ranks;               /* "at" is 1024@16: of so many ranks; 0: not said */
    double value, low, high; /* SI; low = high = value without a published range */
    const char *unit;        /* as written: us, MB/s, B, ... */
    double scale;            /* SI per unit */
    const char *evidence;    /* P, PR, D, E */
    enum published_use use;
    double add;              /* SI, what the simulator leaves out, added to its answer */
    int nset;
    const char **set; /* (nset) "machine.key=value": the machine that was measured, where it is not
                         the file's */
    const char *source;
    const char *
        cause; /* why the simulator misses it, or cannot be held against it; "": nothing is known */
    double missed; /* relative error that the cause explains, which it begins with ("+40 %: ...");
                      NaN: it names none */
};

/* published_use_name: "yes", "no", "other". */
const char *published_use_name(enum published_use use);

/* published_read: all rows of `path` into (*n) records in `a`.
 * Returns false with ERR_NO_INPUT, ERR_IO, or ERR_DATA with file and line. */
bool published_read(const char *path, struct arena *a, struct published **row, int *n,
                    struct err *e);

#endif
