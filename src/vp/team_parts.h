/* team_parts.h - shares of ranks, the threads that run them, and what goes between them: the
 * insides of team.h.
 *
 * team_queue.c: which share is next; team_mail.c: messages to other shares and processes;
 * team_barrier.c: the machine's barrier; team.c: threads and turns. */
#ifndef VP_TEAM_PARTS_H
#define VP_TEAM_PARTS_H

#include <pthread.h>
#include <stdatomic.h>

#include "vp/post.h"
#include "vp/team.h"

/* Shares for each thread: enough to divide the work evenly, and few enough that most neighbours are
 * in one's own. TURN: how often each rank of a share may go on in one turn, on average. */
enum { SHARES_PER_THREAD = 8, TURN = 4, BATCH = 62, MOST_THREADS = 1024 };

/* Messages for one share, in the order sent. */
struct batch {
    struct batch *next;
    int n;
    struct message *message[BATCH];
};

/* AGAIN: something came for it while a thread ran it. */
enum { IDLE, QUEUED, RUNNING, AGAIN };

struct share {
    struct world world; /* first: a rank's world is its share */
    _Atomic(struct batch *) inbox; /* the newest first */
    _Atomic int state;
    struct batch **out; /* (nshare) being filled for other shares, NULL: none */
    int *touched;       /* (ntouched) shares for which there is one */
    int ntouched, home; /* home: the thread at which it queues */
    int barriers;       /* of the machine's, whose end it has seen */
    int told;           /* ranks that the heartbeat knows to have ended */
    bool made;
};

/* A host thread. */
struct worker {
    struct team *team;
    pthread_t thread;
    struct message_pool pool;
    pthread_mutex_t lock; /* of the queue */
    struct share **queue; /* (nshare) ring */
    int head, count, number;
    struct random random; /* of delays in tests */
};

struct team {
    struct world *world; /* of the whole run */
    struct share *share; /* (nshare) */
    struct worker *worker; /* (nworker) */
    struct message_depot *depot;
    int nshare, nworker, shift; /* rank r is in share r >> shift */
    int first, end;             /* shares of this process; all, unless several share the run */
    struct post *post;          /* to the other processes, NULL: there are none */
    struct batch **in;          /* (nshare) letters for shares, to be handed over */
    enum post_state state;      /* how the run has ended on all */
    _Atomic bool over;          /* it has */
    uint64_t seed;
    struct check_note note;
    _Atomic int active;  /* shares that are not idle; 0: the run is over */
    _Atomic int waiting; /* shares in queues */
    _Atomic bool stop;   /* a rank has failed */
    _Atomic int sleepers;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t news;
    int inside; /* ranks in the machine's barrier whose shares are in it as a whole */
    sim_ps latest;
    int processes;          /* of the job, that are in it as a whole: process 0 counts */
    sim_ps latest_process;
    _Atomic bool whole; /* all ranks of this process are in it, and it has not ended */
    _Atomic sim_ps release;
    _Atomic int barriers;
};

/* --- team.c --- */

/* team_create: shares and workers for w->load->threads threads; nobody runs yet. team_go: run(k)
 * on each of them, worker 0 on the caller's own thread, until all have returned; a system that
 * refuses a thread leaves its work to the others. team_gather: what the shares know becomes the
 * world's; a deadlock is explained from the ranks' own states, which are those of a run on one
 * thread: whoever can go on does, in any order. team_destroy: what the team has beside the run's
 * scratch. */
struct team *team_create(struct world *w, uint64_t seed);
void team_go(struct team *t, void *(*run)(void *worker));
void team_gather(struct team *t);
void team_destroy(struct team *t);

/* team_delay: for tests: k's thread loses its processor for a while, where it would matter most
 * (world_load.delays). */
void team_delay(struct worker *k);

/* --- team_queue.c --- */

/* team_enqueue: s, which is QUEUED, at the end of its thread's queue. team_look_around: the next
 * share for k, of its own queue or of another; NULL: none waits. team_next_share: the same,
 * waiting; NULL: the run is over. */
void team_enqueue(struct team *t, struct share *s);
struct share *team_look_around(struct worker *k);
struct share *team_next_share(struct worker *k);

/* team_notify: something has come for s. Whoever calls this runs a share, or serves the post, so
 * that the run is not over meanwhile. team_wake_all: threads that sleep look whether the run is
 * over. */
void team_notify(struct team *t, struct share *s);
void team_wake_all(struct team *t);

/* --- team_mail.c --- */

/* batch_new: an empty one. team_push: hand b over to share `to`. team_send_out: what the turn of s
 * has collected for others. team_take_in: what has come for s, matched with its receives. */
struct batch *batch_new(void);
void team_push(struct team *t, struct share *to, struct batch *b);
void team_send_out(struct team *t, struct share *s);
void team_take_in(struct share *s);

/* --- team_barrier.c --- */

/* team_barrier: v enters the machine's barrier; it returns when v may leave. team_leave_barrier:
 * wake the ranks of s when one has ended. team_enter_process: one more process is in it as a whole;
 * team_release: all are. */
void team_barrier(struct vp *v);
void team_leave_barrier(struct team *t, struct share *s);
void team_enter_process(struct team *t, sim_ps latest);
void team_release(struct team *t, sim_ps time);

#endif
