/* path.h - what made each simulated time what it is: the graph of what binds, and its critical
 * path.
 *
 * Every time of a run is an earlier time plus a duration. Where two times meet (a receive that was
 * posted and a message that arrives, a message and the port that it finds busy) the later one
 * binds. A node of the graph is such a time with the one node that it follows from, so the chain
 * from the last rank's end back to the start is the critical path, and its durations add up to the
 * makespan without remainder. */
#ifndef MEASURE_PATH_H
#define MEASURE_PATH_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/work.h"

/* X(constant, word, one line): what a duration on the path is. */
#define PATH_CAUSES_LIST(X)                                                                        \
    X(PATH_START, "start", "the beginning of the run")                                             \
    X(PATH_COMPUTE, "computing", "counted operations on the node")                                 \
    X(PATH_SEND, "send overhead", "o_s and copies of the sender's software")                       \
    X(PATH_RECV, "receive overhead", "o_r and copies of the receiver's software")                  \
    X(PATH_GAP, "gap", "g: the injection port between two messages of one node")                   \
    X(PATH_HOP, "hop latency", "routers and wires, per resource of the route")                     \
    X(PATH_CABLE, "cables", "what long links take beyond the hop latency, topology.dim_latency")   \
    X(PATH_END, "end latency", "network interfaces, entry and exit together: L without the hops")  \
    X(PATH_INJECTION_BYTES, "injection bandwidth", "bytes at the rate of the injection port, G")   \
    X(PATH_LINK_BYTES, "link bandwidth", "bytes at the rate of a link")                            \
    X(PATH_EJECTION_BYTES, "ejection bandwidth", "bytes at the rate of the ejection port")         \
    X(PATH_CONTENTION, "contention",                                                               \
      "waiting for resources that others hold, where the level does not tell for whom")            \
    X(PATH_BACKGROUND, "background", "waiting for messages of other users of the machine")         \
    X(PATH_RENDEZVOUS, "rendezvous", "software time of a hand-shake")                              \
    X(PATH_MEMORY, "shared memory", "between processors of one node")                              \
    X(PATH_BARRIER, "barrier", "hardware barrier, last arrival to release")                        \
    X(PATH_SERVER, "kernel server",                                                                \
      "the machine's one kernel server, busy with messages of other ranks")                        \
    X(PATH_ENGINE_SEND, "sending engine", "copies that the sender's network engine makes")         \
    X(PATH_ENGINE_RECV, "receiving engine", "copies that the receiver's network engine makes")     \
    X(PATH_COLLECTIVE, "collective",                                                               \
      "a collective of the network, last arrival to the result everywhere")                        \
    X(PATH_POLL, "polling", "looking for messages that are not there yet")

enum path_cause {
#define X(constant, word, doc) constant,
    PATH_CAUSES_LIST(X)
#undef X
        PATH_CAUSES
};

/* path_cause_word: "computing", "send overhead", ... */
const char *path_cause_word(enum path_cause cause);

/* One step of the critical path. */
struct path_step {
    int64_t begin_ps, end_ps;
    enum path_cause cause;
    int rank;      /* whose computing or message it is */
    int stage;     /* of that rank */
    int resource;  /* hops and bytes: number of the network's resource (net_internal.h), else -1 */
    int64_t count; /* messages: their size [B]; hops: how many; bytes: how many flits */
    struct work work; /* computing: what was counted, where it was counted */
};

/* The graph while a run makes it. */
struct path_log;

/* path_log_create: an empty graph but for node 0, the start at time 0. path_log_destroy: accepts
 * NULL. */
struct path_log *path_log_create(void);
void path_log_destroy(struct path_log *p);

/* path_add: a node at `time` [ps] that follows from node `before`, which is not later; returns its
 * number. Rank and stage are those of `before` where they are -1. Where the time is the same, no
 * node is made: `before`. */
uint32_t path_add(struct path_log *p, uint32_t before, int64_t time, enum path_cause cause,
                  int rank, int stage, int resource, int64_t count);

/* path_add_work: as path_add, for computing whose operations are counted. */
uint32_t path_add_work(struct path_log *p, uint32_t before, int64_t time, int rank, int stage,
                       const struct work *w);

/* path_keep_losers: from now on the log also keeps what came in time and binds nobody, from which
 * slack follows (slack.h): 48 bytes more for each message. path_keeps_losers: whether it does. */
void path_keep_losers(struct path_log *p);
bool path_keeps_losers(const struct path_log *p);

/* path_join: two times meet: `winner` is the later one (or as late), and `loser` would bind if it
 * were later by more than time(winner) - lag - time(loser). Returns the node from which all goes
 * on that waits for both, with a cause that says whose it is: PATH_POLL of a rank; `winner`, where
 * losers are not kept. path_lose: one more loser of
 * `joined`; no effect where they are not kept. */
uint32_t path_join(struct path_log *p, uint32_t winner, uint32_t loser, int64_t lag,
                   enum path_cause cause, int rank, int stage);
void path_lose(struct path_log *p, uint32_t loser, uint32_t joined, int64_t lag);

/* path_owner: whose node it is. */
void path_owner(const struct path_log *p, uint32_t node, int *rank, int *stage);

/* path_time: of a node [ps]. path_nodes: how many there are. path_bytes: the graph's memory [B]. */
int64_t path_time(const struct path_log *p, uint32_t node);
int64_t path_nodes(const struct path_log *p);
int64_t path_bytes(const struct path_log *p);

/* path_at: the latest node on the way back from `node` that is not later than `time`. */
uint32_t path_at(const struct path_log *p, uint32_t node, int64_t time);

/* path_trace: the steps from the start to `node`, in the order of time, *n of them, in `a`. */
struct path_step *path_trace(const struct path_log *p, uint32_t node, int64_t *n, struct arena *a);

#endif
