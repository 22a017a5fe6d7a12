/* load_row.h - the plain structs of a load curve: what is offered to a network, and what becomes of
 * it at each offered load. Each has its table of columns (column.h). */
#ifndef MEASURE_LOAD_ROW_H
#define MEASURE_LOAD_ROW_H

#include <stdbool.h>
#include <stdint.h>

#include "measure/column.h"

/* One curve: a network under one traffic (study/load.h). */
struct load_series {
    char series[65];   /* SHA-256 of everything that its points depend on */
    char machine[160]; /* its name, with what was changed of it */
    char routing[48];  /* of the machine */
    char level[16];    /* of the network */
    char traffic[96];  /* pattern, or the recorded run */
    int nodes;         /* that send and receive */
    int64_t bytes;     /* of a message; 0: as recorded */
    double flits;      /* of a message, headers included; mean of recorded ones */
    double cycle_ps;   /* time of a flit on a link */
    double empty_ps;   /* mean latency in the empty network */
    double bound;      /* 1 / load of the most loaded link; NaN: not known */
    double saturation; /* load at which the mean latency is three times empty_ps; NaN: none */
    double low, high;  /* highest load that surely holds, lowest that surely does not; NaN: none */
    int probes;        /* loads that were tried to find it; 0: it was not looked for */
    char note[160];    /* what is to be known of the numbers above, "" */
};

enum load_status {
    LOAD_OK,       /* a steady state, its mean known as closely as asked */
    LOAD_WIDE,     /* a steady state as far as it was run, its mean less closely known */
    LOAD_UNSTABLE, /* the backlog grows: no steady state, no latency */
    LOAD_DEADLOCK  /* messages wait for each other for ever */
};

/* What becomes of one offered load. */
struct load_point {
    double offered; /* asked for: flits per node and cycle of a link */
    bool probe;     /* of the search for saturation: as long as it takes to decide */
    enum load_status status;
    double created;  /* really offered while it was measured */
    double accepted; /* delivered while it was measured */
    double mean_ps;  /* latency, from creation to the last flit; NaN without a steady state */
    double half_ps;  /* half the width of its 95 % confidence interval */
    int64_t p50_ps, p99_ps, max_ps; /* -1: no steady state */
    int64_t messages;               /* measured */
    int64_t warmup_ps;              /* left out at the beginning */
    int64_t length_ps;              /* simulated */
    double lag;                     /* autocorrelation of the batch means */
    int64_t events;                 /* dispatched by the simulator, shorter attempts included */
    double host_s;                  /* processor time of this computer, likewise */
    char text[160];                 /* of a deadlock: which cycle */
};

extern const struct column_table load_series_columns, load_point_columns;

#endif
