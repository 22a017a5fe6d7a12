/* ranks.c - a world's ranks: made, and let go on one after the other. */
#include "base/digest.h"
#include "vp/arrivals.h"
#include "vp/matching.h"
#include "vp/meeting.h"
#include "vp/team.h"

/* The clock stops with the program's last call. */
static void rank_main(void *argument)
{
    struct vp *v = argument;
    struct world *w = v->world;
    w->load->program(&v->comm, w->load->context);
    v->finish = v->clock - w->start;
    w->nfinished++;
    if (w->whole != w) w->whole->nfinished++;
}

void world_make_ranks(struct world *w, uint64_t seed)
{
    const int row = w->nstage + 1;
    for (int i = w->first; i < w->first + w->nown; i++) {
        struct vp *v = &w->vp[i];
        v->comm = (struct comm){.type = &vp_comm_type,
                                .rank = i,
                                .size = w->nrank,
                                .noutput = w->load->noutput,
                                .hardware = meeting_hardware(w),
                                .output = w->load->output};
        v->world = w;
        /* Rows belong to the result and outlive the ranks. */
        v->stages = w->result->stage + (size_t)i * (size_t)row;
        v->posted_end = &v->posted;
        v->unexpected_end = &v->unexpected;
        v->node = w->placement.node[i];
        v->processor = w->placement.processor[i];
        v->digest = DIGEST_START;
        /* The stream depends on seed and rank alone. */
        v->extra = w->extra ? &w->extra[i] : NULL;
        if (w->noisy) v->extra->noise = random_make(seed, (uint64_t)i, 0);
        v->clock = w->start;
        v->fiber = fiber_start(w->fibers, (int)(v - w->whole->vp), rank_main, v);
        /* Tables of matching only where they are used: at 65,536 ranks they would take
         * memory for nothing. */
        if (w->load->timed) v->matching = matching_create(w);
    }
    /* All start together; the host's order acts on no result. */
    const int *order = w->nown == w->nrank ? w->load->order : NULL;
    for (int i = w->first; i < w->first + w->nown; i++) vp_wake(w, &w->vp[order ? order[i] : i]);
}

/* A place in a ring without a division. */
static inline struct vp *ready_ahead(const struct world *w, int ahead)
{
    if (ahead >= w->ready_count) return NULL;
    int at = w->ready_head + ahead;
    return w->ready[at >= w->nown ? at - w->nown : at];
}

/* With many ranks each lies cold in memory when its turn comes: the ring tells early
 * enough who is next. Eight ahead the rank's state, five ahead its fiber, three ahead its stack and
 * request, one ahead its message: each is reached through the one before. */
static inline void warm_up(const struct world *w)
{
    const struct vp *far = ready_ahead(w, 8), *middle = ready_ahead(w, 5),
                    *near = ready_ahead(w, 3);
    if (far) arrivals_warm_receiver(far);
    if (middle) arrivals_warm_fiber(middle);
    if (near) {
        fiber_prefetch_stack(near->fiber);
        if (near->waiting) __builtin_prefetch(near->waiting);
    }
    const struct vp *next = ready_ahead(w, 1);
    if (next && next->waiting && next->waiting->active == REQUEST_MATCHED)
        arrivals_warm_message(next->waiting->detail);
}

/* First come, first served, as vp_wake has put them. */
void world_resume(struct world *w, int64_t most)
{
    while (w->ready_count && !w->stopped && most-- > 0) {
        warm_up(w);
        struct vp *v = w->ready[w->ready_head];
        if (++w->ready_head == w->nown) w->ready_head = 0;
        w->ready_count--;
        fiber_enter(v->fiber);
    }
}
