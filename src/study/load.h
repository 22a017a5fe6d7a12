/* load.h - latency and accepted load of a network against offered load, and where it saturates.
 *
 * An open system: every node creates messages by a pattern at random times (net/pattern.h), or as
 * a recorded run did, whatever becomes of the earlier ones. The unit of load is the flit per node
 * and cycle, where a cycle is the time of a flit on a link: at load 1 a node's messages, headers
 * included, would keep one link busy. Latency counts from the creation of a message to its last
 * flit at the destination, the wait at the source included, the processor's overhead not.
 *
 * A point is run for T cycles. Messages created in the first three quarters are measured, the
 * traffic goes on behind them. Warm-up, mean, interval and trend: study/steady.h. T is doubled
 * until the interval is as narrow as asked, or the number of messages would pass the limit. A
 * point has no steady state where of the messages created in the first three quarters more than a
 * tenth, or in two runs in succession any, have not arrived at T, and where the latency still rises
 * in the longest run and its mean is beyond saturation. A mean that rises below that says nothing
 * yet: its interval reaches up to saturation.
 *
 * Saturation is the load at which the mean latency is three times that of the empty network, found
 * by bisection; a load counts as decided where the interval does not contain that latency. */
#ifndef STUDY_LOAD_H
#define STUDY_LOAD_H

#include "base/arena.h"
#include "base/err.h"
#include "measure/load_row.h"
#include "net/pattern.h"

enum {
    LOAD_CRITERION = 3, /* latency at saturation, in latencies of the empty network: the convention
                           of the reference series (docs/network.md) */
    LOAD_MOST_MESSAGES = 1 << 22, /* of one run, whatever is asked for */
    LOAD_LEAST_MESSAGES = 10000   /* smallest limit that can be asked for */
};

/* What is offered to what. Borrowed for the life of the question; several threads may use it. */
struct load_question {
    const struct machine_spec *machine;     /* its level included */
    const char *traffic;                    /* the pattern's name, for people */
    const struct load_recording *recording; /* instead of the pattern; NULL: none */
    int64_t bytes;                          /* payload of a message of the pattern */
    uint64_t seed;
    double within; /* wanted: half the interval over the mean */
    int most;      /* messages of the longest run */
    /* out of load_begin */
    const struct topology *topology;
    struct pattern pattern;
    int nodes; /* that send and receive: all, or those of the recorded ranks */
    int flits;
    double cycle_ps, empty_ps;
};

/* Messages of a real run, to be repeated: message m starts at time[m] of each period. */
struct load_recording {
    int nmessage;
    int nrank;
    int *src, *dst; /* (nmessage) ranks; nodes out of load_begin */
    int64_t *bytes; /* (nmessage) */
    sim_ps *time;   /* (nmessage) rising, below period */
    sim_ps period;  /* of the run */
    double load;    /* what it offers at its own speed: flits per node and cycle; of load_begin */
};

/* load_begin: fill in the rest of *q, in memory of `keep`, and the facts of its series in *s:
 * nodes, sizes, the empty network's latency (exact mean over all pairs of the pattern, over 2^16
 * drawn messages where there are more or routes are of chance), the bound. Returns false as
 * pattern_read, and with ERR_CONFIG when the level cannot run on the machine. */
bool load_begin(struct load_question *q, struct load_recording *recording, struct load_series *s,
                struct arena *keep, struct err *e);

/* load_measure: the point at `offered` into *p. probe: end as soon as it is decided on which side
 * of saturation it lies. Returns false with ERR_CONFIG or ERR_DATA (a load that needs more messages
 * than q->most in the shortest run that means something). */
bool load_measure(const struct load_question *q, double offered, bool probe, struct load_point *p,
                  struct err *e);

/* load_least_messages: how many messages the shortest run at `offered` has that means something. */
double load_least_messages(const struct load_question *q, double offered);

/* load_first_probe: the load that load_saturate asks for first. */
double load_first_probe(const struct load_series *s);

/* load_side: whether a point lies above saturation (1), below (-1), or cannot be told (0). */
int load_side(const struct load_point *p, double empty_ps);

/* load_saturate: look for saturation between 0 and 1 into the members of *s, to 1 % of itself or
 * to a load that cannot be told. Where none is found, s->low is 1 if the network holds at full
 * load, and less if that cannot be told (0: nor of any other load that was tried). `probe` measures
 * a load, or knows it already. Returns false where `probe` did. */
typedef bool load_probe_fn(void *context, double offered, struct load_point *p, struct err *e);
bool load_saturate(struct load_series *s, load_probe_fn *probe, void *context, struct err *e);

#endif
