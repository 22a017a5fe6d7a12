/* traffic.h - lists of messages with dependencies replayed on a level of the network, without
 * processors.
 *
 * Message m may start `delay[m]` after the last of its dependencies has arrived, and not before
 * `time[m]`; a node sends its ready messages in the order (ready, m). A list has no cycles if every
 * dependency has a lower number. */
#ifndef NET_TRAFFIC_H
#define NET_TRAFFIC_H

#include "machine/topology.h"
#include "net/net.h"

struct traffic {
    int nmessage;
    int *src, *dst; /* (nmessage) nodes */
    int64_t *bytes; /* (nmessage) payload */
    sim_ps *time;   /* (nmessage) earliest start [ps] */
    sim_ps *delay;  /* (nmessage) after the last dependency's arrival [ps] */
    /* (nmessage + 1) dependencies of m: dep[dep_first[m] .. dep_first[m+1] - 1]; NULL: none */
    int *dep_first;
    int *dep;    /* numbers of other messages */
    sim_ps stop; /* nothing that happens later is simulated [ps]; 0: all is */
    bool singly; /* an event for everything, also where one for all of an instant would do */
};

/* What a replay tells; the arrays are the caller's, (nmessage) or NULL where not wanted. */
struct traffic_result {
    sim_ps *arrival, *injected, *uncontended; /* [ps]; SIM_NEVER for messages that never arrived */
    sim_ps makespan;                          /* last arrival [ps] */
    int arrived;
    int64_t events;  /* dispatched, those that start messages included */
    uint64_t digest; /* of the events */
    bool clocked;    /* it was played in cycles (net_clocked.h) */
    int nlink;
    const struct link_load *link; /* when asked for, in the arena */
    /* messages are left that nothing can move; text names the cycle */
    bool deadlock;
    char text[512];
};

/* traffic_run: replay `q` on the network of machine `m` over `t`.
 *
 *   a           memory of the net and of the link loads
 *   want_links  record loads
 *
 *   Returns false with ERR_CONFIG when the level cannot run on the machine, ERR_DATA when a message
 * has no such node, a negative size or a dependency that does not exist. A deadlock is a result,
 * not an error. */
bool traffic_run(const struct traffic *q, const struct machine_spec *m, const struct topology *t,
                 struct arena *a, bool want_links, struct traffic_result *out, struct err *e);

#endif
