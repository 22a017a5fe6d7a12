/* vp.h - the insides of room vp: virtual processors, their messages, and the world they share.
 *
 * Files: world.c builds and runs, team.c, windows.c on threads; vp_comm.c is comm.h for a virtual
 * processor; clock.c its time; mailbox.c matches messages, matching.c, poll.c, timer.c where time
 * decides; arrivals.c, pool.c, launch.c, rendezvous.c carry them; server.c is the shared kernel
 * server; background.c loads the links; deadlock.c and failure.c explain. */
#ifndef VP_VP_H
#define VP_VP_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/check.h"
#include "base/picoseconds.h"
#include "base/random.h"
#include "comm/comm.h"
#include "machine/node_cost.h"
#include "machine/placement.h"
#include "machine/topology.h"
#include "measure/run_result.h"
#include "net/net.h"
#include "sim/fiber.h"
#include "sim/sim.h"
#include "spec/run_spec.h"
#include "vp/cost.h"
#include "vp/extra.h"
#include "vp/message.h"
#include "vp/world.h"

/* Lanes of the events that this room posts before the starts of messages at the same time: messages
 * that arrive for receives from anybody, such receives, looks at the clock, others' services. */
enum { LANE_ARRIVAL = NET_LANE_START - 5, LANE_POST, LANE_POLL, LANE_SERVER, LANE_BACKGROUND };

enum waiting_for {
    WAITING_NOTHING, WAITING_RECEIVE, WAITING_SEND, WAITING_BARRIER, WAITING_MEETING,
    WAITING_SERVER, WAITING_ANY, WAITING_POLL
};

struct vp {
    struct comm comm; /* first: a kernel's comm is its vp */
    struct world *world;
    sim_ps clock;
    /* What the delivery of a message needs, in one line of the cache: */
    struct stage_time *stages; /* (nstage + 1) this rank's row in the result */
    int stage;
    enum waiting_for waiting_for;
    struct comm_request *waiting;                 /* the request it waits for */
    struct comm_request *posted, **posted_end;    /* receives without a message, in order */
    struct message *unexpected, **unexpected_end; /* messages without a receive, in order */
    struct matching *matching;                    /* timed programs: instead of `unexpected` */
    uint32_t sent; /* messages so far: the lower half of their numbers */
    int node, processor;
    uint32_t path;   /* node of `clock`, where critical paths are recorded */
    uint64_t digest; /* of what it received and when */
    sim_ps finish;   /* clock at its end */
    struct fiber *fiber;
    bool called; /* message software since it last computed (offload.h) */
    struct vp_extra *extra; /* NULL: this machine asks for none of it */
} __attribute__((aligned(64)));
_Static_assert(sizeof(struct vp) <= 192, "a rank takes three lines of the cache");

struct world {
    const struct machine_spec *machine;
    const struct record_spec *record;
    struct run_result *result;
    struct arena *arena;   /* of the result */
    struct arena *scratch; /* of the run */
    struct sim *sim;
    struct net *net;
    struct topology *topology;
    struct placement placement;
    struct fiber_pool *fibers;
    struct stack_fault *fault; /* tells whose stack was not enough; NULL: nobody does */
    struct vp *vp; /* (nrank) */
    struct vp_extra *extra; /* (nrank) of its ranks; NULL: none */
    int nrank, nstage, nfinished;
    struct software_cost software;
    struct node_cost node_cost;
    bool shared_channel, eager_only, noisy, broken; /* broken: a process of the job is silent */
    struct meeting *meeting; /* collectives of the network (meeting.h), NULL: it does none */
    struct search *search;   /* its eureka (search.c), NULL: it has none */
    bool stopped, failed; /* a rank went beyond the end of time, or failed: nobody goes on */
    /* by its ranks, where processes share the run (shared.h); NULL: not kept */
    struct published *published;
    struct vp **ready; /* (nown) ring of ranks that can go on */
    int ready_head, ready_count;
    struct message_pool *pool; /* of the host thread */
    struct arrivals *arrivals; /* until receivers go on (arrivals.h); NULL: none */
    struct team *team; /* several threads, each share of ranks its world (team.h); NULL: one */
    struct windows *windows; /* they go by windows of time (windows.h); NULL: they do not */
    /* what several jobs share: ring, `stopped`, server (jobs.h); itself where there is one */
    struct world *whole;
    int job;      /* number among them, from 0 */
    sim_ps start; /* when its ranks begin: the zero of all that is told of them */
    int first, nown;           /* its ranks: first .. first + nown - 1 */
    void (*arrived)(struct message *m);    /* what the end of a message's trip means */
    void (*share_barrier)(struct vp *v);   /* v of a share enters the machine's; NULL: one thread */

    struct path_log *path; /* what binds (path.h), NULL unless recorded; owned */
    /* what was computed so far, as record->balance has it; NULL: that does not act (balance.h) */
    int64_t *balanced;
    uint32_t barrier_path; /* of barrier_latest, then of barrier_release */
    int barrier_count; /* hardware barrier: ranks inside */
    sim_ps barrier_latest, barrier_release;
    const struct vp *late; /* the rank whose clock would pass the end of time, NULL: none */
    int64_t background_events; /* of other jobs' traffic, pending */
    /* kernel server; of the message end that it served last: when it began; whose that was */
    sim_ps server_free;
    uint32_t server_path;
    int served_rank, served_stage;
    int64_t server_bytes, span_capacity;
    const struct world_load *load;
};

/* --- clock.c --- */

/* vp_wake: put a rank that waits at the end of the ready ring. */
void vp_wake(struct world *w, struct vp *v);

/* vp_notify: r of v becomes complete at `time`, now or later: wake v if it waits for that. */
void vp_notify(struct vp *v, struct comm_request *r, sim_ps time);

/* vp_block: leave the fiber until somebody wakes `v`. */
void vp_block(struct vp *v, enum waiting_for what, struct comm_request *r);

/* vp_time_out: what `v` does next ends after PS_LAST: the run has failed, and this never returns to
 * the rank. */
_Noreturn void vp_time_out(struct vp *v);

/* vp_stage_time: the row of the stage in progress. */
static inline struct stage_time *vp_stage_time(struct vp *v) { return &v->stages[v->stage]; }

/* vp_advance: the clock becomes `time`. One that passes the end of time stops there: its rank goes
 * no further. */
static inline void vp_advance(struct vp *v, sim_ps time)
{
    if (__builtin_expect(time > PS_LAST, 0)) vp_time_out(v);
    v->clock = time;
}

/* vp_wait_until: advance the clock to `time`, of which up to `uncontended` would have passed
 * anyway; charged to the stage's wait and contention. No effect when the clock is later. */
void vp_wait_until(struct vp *v, sim_ps time, sim_ps uncontended);

/* vp_span: record [begin, end) of `v`; neighbours of one kind are joined. For runs that record
 * spans. */
void vp_span(struct vp *v, enum span_kind kind, sim_ps begin, sim_ps end, int peer, int64_t bytes,
             int64_t message);

/* --- launch.c --- */

/* vp_launch: hand m over to the network, or to the channel that both processors of one node share;
 * m->net holds nodes, bytes and ready time. `from` and `to` are the ranks at the ends of this
 * trip. */
void vp_launch(struct world *w, struct message *m, const struct vp *from, const struct vp *to);

extern const struct comm_type vp_comm_type; /* comm.h as a virtual processor does it (vp_comm.c) */

/* server_pass (server.c): be served by the machine's one kernel server for a message end of
 * `bytes`; blocks, charges waiting to contention, and returns the service time that is still to be
 * charged as overhead. */
sim_ps server_pass(struct vp *v, int64_t bytes);

/* background_start (background.c): begin the seeded traffic of others on the links, when the
 * machine has it; it ends with the ranks. It acts at levels that can occupy a link (net_occupy). */
void background_start(struct world *w, uint64_t seed);

#endif
