/* schedule_run.c - ranks execute schedules, on comm.h: any machine and level (schedule_run.h).
 *
 * A rank is one loop that always does what can happen first in simulated time: receives
 * are posted as soon as they may be, since posting takes no time; then a message that has
 * come, or an operation of a processor. Ties are decided by the order of readiness, so a
 * run is the same whatever the host does. */
#include "schedule/schedule_run.h"

#include <string.h>

#include "base/size.h"

enum { NONE = -1, MOST_CPUS = 256 };

/* A message under way. */
struct pending {
    struct comm_request request; /* first */
    int op;
    struct pending *next; /* free ones */
};

/* Operations of one processor that may start, in the order in which they could; and the one that
 * computes. */
struct cpu {
    int first, last; /* NONE: none */
    int computing;   /* NONE: it is free */
    int64_t until;
};

/* What a rank knows of one of its operations. */
struct progress {
    int32_t needs; /* what it still waits for */
    int32_t next;  /* in its list */
    int64_t ready; /* since when it may start */
};

struct execution {
    struct comm *comm;
    const struct schedule_job *job;
    const struct schedule_op *op; /* of this rank */
    const int64_t *edge_first;    /* likewise */
    int nop, ndone, ncpu;
    int first_receive, last_receive; /* that may start: nothing holds them up */
    struct pending *spare;
    struct cpu *cpu;           /* (ncpu) */
    struct progress *progress; /* (nop) */
};

size_t schedule_workspace(const void *job, int rank)
{
    const struct schedule *s = ((const struct schedule_job *)job)->schedule;
    /* MOST_CPUS is the largest number that a file can name plus one, so no counting is
     * needed before. */
    const size_t n = (size_t)(s->first[rank + 1] - s->first[rank]);
    return size_sum(size_product(n, sizeof(struct progress)), MOST_CPUS * sizeof(struct cpu));
}

/* ---- what may start ---- */

/* Lists by number within the rank: an operation is in one list at most. */
static void append(struct execution *x, int *first, int *last, int op)
{
    x->progress[op].next = NONE;
    if (*first == NONE) *first = op;
    else x->progress[*last].next = op;
    *last = op;
}

static int take_first(struct execution *x, int *first)
{
    const int op = *first;
    *first = x->progress[op].next;
    return op;
}

/* Receives go to a list of their own, since they occupy no processor until their message
 * is there. */
static void may_start(struct execution *x, int op)
{
    struct cpu *p = &x->cpu[x->op[op].cpu];
    x->progress[op].needs = NONE; /* it starts once */
    x->progress[op].ready = comm_now_ps(x->comm);
    if (x->op[op].kind == SCHEDULE_RECEIVE) append(x, &x->first_receive, &x->last_receive, op);
    else append(x, &p->first, &p->last, op);
}

/* `op` has started, or has finished: those that wait for that have one thing less to wait for. Of
 * those that may start at the same time sends come first: what they start takes longest. */
static void tell(struct execution *x, int op, bool start)
{
    /* Two walks: all counts go down first, so that those at zero can start in the order
     * of their kinds. */
    const uint32_t *edge = x->job->schedule->edge;
    const int64_t begin = x->edge_first[op], end = x->edge_first[op + 1];
    for (int64_t k = begin; k < end; k++)
        if ((edge[k] & 1) == start) x->progress[edge[k] >> 1].needs--;
    for (int kind = SCHEDULE_SEND; kind <= SCHEDULE_COMPUTE; kind++)
        for (int64_t k = begin; k < end; k++)
            if ((edge[k] & 1) == start && x->op[edge[k] >> 1].kind == kind &&
                x->progress[edge[k] >> 1].needs == 0)
                may_start(x, (int)(edge[k] >> 1));
}

static void finished(struct execution *x, int op)
{
    x->ndone++;
    tell(x, op, false);
}

/* ---- operations ---- */

/* As many as are under way at a time, not as many as the rank has messages. */
static struct pending *pending_make(struct execution *x, int op)
{
    struct pending *p = x->spare;
    if (p) x->spare = p->next;
    else p = TAKE(x->job->arena, 1, struct pending);
    *p = (struct pending){.op = op};
    return p;
}

/* Where the operation stands in the file, for reports. */
static void stand_at(struct execution *x, int op)
{
    x->comm->file = x->job->path;
    x->comm->line = x->op[op].line;
}

static void start_receive(struct execution *x, int op)
{
    const struct schedule_op *o = &x->op[op];
    const bool any_tag = o->tag == SCHEDULE_ANY;
    struct pending *p = pending_make(x, op);
    stand_at(x, op);
    /* No buffer and any size: schedules have sizes and no data, and sizes of receives are
     * not compared (docs/schedules.md). */
    comm_irecv_matching(x->comm, o->peer, any_tag ? 0 : o->tag, any_tag ? 0 : COMM_WHOLE_TAG, NULL,
                        INT64_MAX, &p->request);
    /* The rank's completion queue tells which message is next, at the cost of a heap and
     * not of a look at every one. */
    comm_watch(x->comm, &p->request);
    tell(x, op, true);
}

static void send(struct execution *x, int op)
{
    const struct schedule_op *o = &x->op[op];
    struct pending *p = pending_make(x, op);
    stand_at(x, op);
    /* Data NULL: the message has a size and no content. The call takes the sender's
     * software time. */
    comm_isend(x->comm, o->peer, o->tag, NULL, o->size, &p->request);
    tell(x, op, true);
    /* A hand-shake: the send has finished when the queue says so. An eager one is over. */
    if (p->request.active) {
        comm_watch(x->comm, &p->request);
        return;
    }
    p->next = x->spare;
    x->spare = p;
    finished(x, op);
}

/* With one processor its time is the rank's; several compute beside each other. */
static void compute(struct execution *x, struct cpu *p, int op)
{
    const int64_t duration = x->op[op].size * x->job->unit_ps;
    tell(x, op, true);
    if (x->ncpu == 1) {
        comm_elapse(x->comm, duration);
        finished(x, op);
        return;
    }
    /* The rank's clock stands: other processors and messages go on until this one is
     * done. */
    p->computing = op;
    p->until = comm_now_ps(x->comm) + duration;
}

/* The message that is complete first, if it is by `time`. */
static bool complete_one(struct execution *x, int64_t time)
{
    struct pending *p = (struct pending *)comm_next_complete(x->comm, time);
    /* INT64_MAX as time waits without limit; then NULL means that nothing is under way. */
    if (!p) return false;
    const int op = p->op;
    p->next = x->spare;
    x->spare = p;
    finished(x, op);
    return true;
}

/* The processor whose first operation has waited longest among those that are free, and when the
 * next of the others will be free. */
static struct cpu *choose(struct execution *x, int64_t *next_end)
{
    struct cpu *best = NULL;
    *next_end = INT64_MAX;
    /* Of those that have waited equally long the lowest processor. */
    for (int i = 0; i < x->ncpu; i++) {
        struct cpu *p = &x->cpu[i];
        if (p->computing != NONE) {
            if (p->until < *next_end) *next_end = p->until;
        } else if (p->first != NONE) {
            if (!best || x->progress[p->first].ready < x->progress[best->first].ready) best = p;
        }
    }
    return best;
}

/* Computing times that are over by now. */
static void end_computing(struct execution *x)
{
    /* The clock may have passed several ends at once, since messages take the rank's
     * software meanwhile. */
    const int64_t now = comm_now_ps(x->comm);
    for (int i = 0; i < x->ncpu; i++) {
        struct cpu *p = &x->cpu[i];
        const int op = p->computing;
        if (op == NONE || p->until > now) continue;
        p->computing = NONE;
        finished(x, op);
    }
}

/* ---- the rank ---- */

static void begin(struct execution *x, void *workspace)
{
    /* The workspace holds the processors, then one record for each operation
     * (schedule_workspace). */
    x->cpu = workspace;
    x->progress = (struct progress *)((char *)workspace + MOST_CPUS * sizeof *x->cpu);
    x->first_receive = x->last_receive = NONE;
    for (int i = 0; i < x->nop; i++) {
        x->progress[i].needs = x->op[i].needs;
        if (x->op[i].cpu >= x->ncpu) x->ncpu = x->op[i].cpu + 1;
    }
    for (int i = 0; i < x->ncpu; i++) x->cpu[i] = (struct cpu){NONE, NONE, NONE, 0};
    /* What needs nothing may start at once, sends first, as in tell. */
    for (int kind = SCHEDULE_SEND; kind <= SCHEDULE_COMPUTE; kind++)
        for (int i = 0; i < x->nop; i++)
            if (x->op[i].kind == kind && x->op[i].needs == 0) may_start(x, i);
}

void schedule_rank(struct comm *c, const void *job, void *workspace)
{
    const struct schedule *s = ((const struct schedule_job *)job)->schedule;
    const int64_t first = s->first[comm_rank(c)];
    struct execution x = {
        .comm = c, .job = job, .op = s->op + first, .edge_first = s->edge_first + first, .ncpu = 1};
    x.nop = (int)(s->first[comm_rank(c) + 1] - first);
    /* Reports name file and line of the schedule (stand_at). */
    c->keep_site = 1;
    begin(&x, workspace);
    for (;;) {
        int64_t next_end;
        while (x.first_receive != NONE) start_receive(&x, take_first(&x, &x.first_receive));
        if (x.ncpu > 1) end_computing(&x);
        /* The end of a computing time may have freed receives. */
        if (x.first_receive != NONE) continue;
        struct cpu *p = choose(&x, &next_end);
        /* a message that came before the operation could start goes first */
        if (complete_one(&x, p ? x.progress[p->first].ready : next_end)) continue;
        /* Neither an operation, nor a message, nor a computing time is left. */
        if (!p && next_end == INT64_MAX) break;
        if (!p) continue;
        const int op = take_first(&x, &p->first);
        if (x.op[op].kind == SCHEDULE_SEND) send(&x, op);
        else compute(&x, p, op);
    }
    if (x.ndone < x.nop) comm_fail(c, "the schedule has operations that nothing ever starts");
}
