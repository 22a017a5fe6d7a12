/* netcheck_ask.h - one reference case as a network and a message list, asked of every level that is
 * wanted. */
#ifndef STUDY_NETCHECK_ASK_H
#define STUDY_NETCHECK_ASK_H

#include "machine/topology.h"
#include "net/traffic.h"
#include "study/netcheck.h"

/* A row being answered. */
struct netcheck_question {
    const struct netcheck *n;
    struct netcheck_row *row;
    struct machine_spec machine;
    const struct topology *topology; /* of the machine */
    struct traffic q;
    const double *arrival; /* (q.nmessage) reference [cycles], NULL: none */
    bool any_order;        /* arrivals agree as sets */
    /* the answer is the mean latency of messages from `warm` on, not the makespan */
    bool latency;
    sim_ps warm, until;  /* and born before `until`, 0: all */
    sim_ps last;         /* out of netcheck_mean: the last arrival of these */
    double channel;      /* what the reference's channels add to the mean latency [cycles] */
    struct arena *arena; /* scratch */
    struct arena *rows;  /* of what the row keeps */
};

/* netcheck_empty: when message m would arrive in an empty network [cycles]. */
double netcheck_empty(const struct netcheck_question *k, int m);

/* netcheck_empty_latency: mean over the messages from `warm` on of netcheck_empty less their times,
 * the channels' share included [cycles]. */
double netcheck_empty_latency(const struct netcheck_question *k);

/* netcheck_ask: fill the row's answers at the levels wanted. */
void netcheck_ask(struct netcheck_question *k);

/* netcheck_mean: the mean latency of k's list at `level` [cycles]. False: the level cannot say, and
 * the answer has the reason; a deadlock is one. */
bool netcheck_mean(struct netcheck_question *k, enum network_level level, double *latency);

/* netcheck_error: relative error of `found` against the row's band; 0 inside. */
double netcheck_error(const struct netcheck_row *row, double found);

/* netcheck_ask_saturation: fill them with the load at which the mean latency of `pattern` is three
 * times `empty`, sought from the reference's bracket outwards. */
void netcheck_ask_saturation(struct netcheck_question *k, const char *pattern, int flits);

/* netcheck_unanswered: no level can answer the row, for the reason `why`. */
void netcheck_unanswered(struct netcheck_row *row, const char *why);

#endif
