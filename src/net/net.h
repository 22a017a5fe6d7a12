/* net.h - what every network level provides: messages in, arrival times out.
 *
 * Contract with the virtual processors: net_send is called with an injection-ready time that is
 * never earlier than the time of the event being dispatched. The level answers through `deliver`,
 * either at once (the time is known: loggp) or from an event. `arrival` is when the tail is in the
 * destination's memory, before o_r. All nodes and links are reached through arguments; there is no
 * global state. Semantics of the levels: docs/network.md. */
#ifndef NET_NET_H
#define NET_NET_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/err.h"
#include "measure/run_result.h"
#include "sim/sim.h"
#include "spec/machine_spec.h"

struct topology;
struct path_log;
struct net;

/* Lanes of the levels' events: deliveries and freed resources, starts of messages, arriving heads,
 * arbitration. Who calls net_send with ready == sim_now must itself be in a lane <=
 * NET_LANE_START. */
enum { NET_LANE_FREE = 16, NET_LANE_START = 32, NET_LANE_HEAD = 48, NET_LANE_ARBITRATE = 64 };

/* Parts of a message's number: its job's from this bit on, then 24 bits of its sender, then how
 * many that had sent before. */
enum { NET_ID_JOB = 56, NET_ID_RANKS = 0xffffff };

/* One message on its way; embedded in the mailbox's own struct, which stays in place until
 * deliver. */
struct net_message {
    /* Nodes (not ranks, not routers). Not side by side: compilers would load both as one word just
     * after they were stored as two, which has to wait until the stores are done. */
    int src;
    /* of the source node that sends: the own messages of `uncontended` are its */
    int processor;
    int dst;
    /* in: node of `ready` in the graph of net_set_path; out: node of `arrival` */
    uint32_t path;
    int64_t bytes;      /* payload >= 0 */
    int64_t id;         /* unique and deterministic: breaks ties; (source, count) order */
    sim_ps ready;       /* when the source may start injecting */
    sim_ps injected;    /* out: when injection began */
    sim_ps arrival;     /* out: when the tail arrived */
    sim_ps
        uncontended; /* out: when it would have arrived had no other message (of another rank) been
                        in its way; the sender's own gap g and port are part of it, as in LogGP */
};

typedef void net_deliver_fn(void *context, struct net_message *m);

struct net_type {
    const char *name;
    enum network_level level;
    bool (*create)(struct net *n, struct err *e);
    void (*send)(struct net *n, struct net_message *m);
    void (*occupy)(struct net *n, int link, sim_ps now, sim_ps busy); /* NULL: the level cannot */
    /* messages remain and no event: names the cycle */
    bool (*deadlock)(const struct net *n, char *text, int size);
    bool asks; /* for others' messages when a message comes to a link (net_ask_others) */
    /* it says what binds at each resource (net_set_path); else its contention is one lump a
     * message */
    bool paths;
};

/* net_create: the level of `m->network` over `t`.
 *
 *   m, t, s, a  borrowed for the life of the net; memory comes from a, events go to s
 *   deliver     called once per message with `context`
 *   want_links  record link_load
 *
 *   Returns NULL with ERR_CONFIG when the level cannot run on this machine (buffer too small, ...).
 */
struct net *net_create(const struct machine_spec *m, const struct topology *t, struct sim *s,
                       struct arena *a, net_deliver_fn *deliver, void *context, bool want_links,
                       struct err *e);

/* net_takes: whether a message of `bytes` is of no more packets, or pieces of a buffer's size, than
 * a level that simulates them counts, 2^31 - 1; else why not, in `text`. */
bool net_takes(const struct net *n, int64_t bytes, char *text, size_t size);

/* net_send: hand over a message; see the contract above. m is borrowed until deliver. */
void net_send(struct net *n, struct net_message *m);

/* net_set_in_order: whether the messages of each node are handed over in the order of their ready
 * times, so that a start needs no event. At first true if all messages are eager; never true where
 * processors share a port. A processor that runs ahead is in order with itself, but not with the
 * data and answers of a rendezvous: the caller who expects none may say true, and says false before
 * its first, which then is late at ports that were promised ahead of its time. */
void net_set_in_order(struct net *n, bool in_order);

/* net_share: the same network for one of several host threads that run ranks at once: it delivers
 * with `context`, and each node's messages are sent through one share alone. For level loggp in
 * order, without a path log; memory from `a`. */
struct net *net_share(const struct net *n, void *context, struct arena *a);

/* net_foresee: call early(m) shortly before m is delivered. It may ask for memory, and must change
 * nothing. Not every message is announced, and not on every level. Call it before any message is
 * sent. */
typedef void net_early_fn(const struct net_message *m);
void net_foresee(struct net *n, net_early_fn *early);

/* net_gather: from now on all that is to be looked at in one instant shares an event, and a message
 * is handed over as soon as its arrival is known, which may lie ahead: the same times to the bit,
 * with fewer events. Returns whether this level does it. Call it before any message is sent. */
bool net_gather(struct net *n);

/* net_defers: whether it acts on no result when what the receiver of a message does is worked out
 * later on the host, as long as no event at its arrival or after it has been dispatched. */
bool net_defers(const struct net *n);

/* net_set_path: record what binds on each message's way in `log` (borrowed; measure/path.h); NULL:
 * do not. Call it before any message is sent. */
void net_set_path(struct net *n, struct path_log *log);

/* net_zero_load: arrival - ready of a single message in an empty network, the closed form [ps].
 * net_zero_load_of: of the message m (src, dst, bytes, id), on the route that its id draws. */
sim_ps net_zero_load(const struct net *n, int src, int dst, int64_t bytes);
sim_ps net_zero_load_of(const struct net *n, const struct net_message *m);

/* net_flits: the flits of all packets of a message of `bytes`, headers included. net_flit_ps: the
 * time of a flit on a link of the machine's link rate [ps]. */
int64_t net_flits(const struct net *n, int64_t bytes);
double net_flit_ps(const struct net *n);

/* net_occupy: directed link `link` serves somebody else's traffic for `busy` from `now`, or from
 * when it is free, first come first served. Called at the time `now` of the event being dispatched.
 * False: this level knows no such thing. */
bool net_occupy(struct net *n, int link, sim_ps now, sim_ps busy);

/* net_others_fn: from when on `link` is free for a message that comes at `now`: `free`, or later
 * when others' messages came to it by then; those of the same instant go first. Asked with rising
 * `now` for each link. */
typedef sim_ps net_others_fn(void *context, int link, sim_ps now, sim_ps free);

/* net_ask_others: ask `others` whenever a message comes to a link; instead of net_occupy at each of
 * theirs, and with the same outcome, but without an event for each. False: this level cannot. Call
 * it before any message is sent. */
bool net_ask_others(struct net *n, net_others_fn *others, void *context);

/* net_deadlock: true when messages are in the network but no event can move them; `text` (size
 * bytes) then names the cycle of links. */
bool net_deadlock(const struct net *n, char *text, int size);

/* net_count_jobs: messages of different jobs (NET_ID_JOB) are counted apart, for net_links. Call it
 * before any message is sent. */
void net_count_jobs(struct net *n, int njob);

/* net_links: the loads recorded so far of messages of `job`, as a list of *nlink entries in `a`:
 * injection ports, links, ejection ports. Of a network with more than NET_LINKS_WHOLE of them only
 * those that something passed. NULL and 0 when not recorded. */
enum { NET_LINKS_WHOLE = 1 << 21 };
struct link_load *net_links(const struct net *n, int job, struct arena *a, int *nlink);

/* net_memory: host memory that network n takes in a run whose `nrank` ranks, on the nodes node[i],
 * send `messages` in all, estimated [B]. `tables`: what net_create took from its arena [B]. They
 * have a row for each resource, and only pages with rows in use are memory. */
double net_memory(const struct net *n, size_t tables, const int *node, int nrank,
                  double messages);

/* net_port_load: the account of the injection port of `node`, for processes that share a run; NULL
 * when not recorded. Its from, to and node are not set. */
struct link_load *net_port_load(struct net *n, int node);

#endif
