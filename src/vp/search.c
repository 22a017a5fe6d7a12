/* search.c - searches that end when one rank has found: a network with an eureka, the wired or of
 * all ranks that interrupts them (comm_search).
 *
 * A rank says at the end of each step what came of it. It stops there until the events have come to
 * its clock, so that it never goes beyond a signal. One that comes before the end of a step
 * interrupts it: the rank's clock is then that of the signal, and computing after it was never
 * done. (The host has done it; its time is taken back, its operations stay counted. A step with
 * messages in it is not taken back: these were sent.) A signal takes the time of a collective
 * without data, and so does the end of a search in which nobody found anything. */
#include "vp/explain.h"
#include "vp/matching.h"
#include "vp/meeting.h"
#include "vp/offload.h"
#include "vp/path.h"

/* What a rank knew when its step began. */
struct step {
    sim_ps begin, computed; /* its clock; computing of its stage until then */
    bool waits;             /* at the end of a step, or with nothing left to look at */
};

struct search {
    struct step *step; /* (nrank) */
    int entered, exhausted;
    bool found;
    sim_ps signal;  /* what a signal takes to all ranks */
    sim_ps release; /* when all ranks know the end; SIM_NEVER: it is not in sight */
    uint32_t path;  /* of release */
};

struct search *search_create(struct world *w, sim_ps signal)
{
    struct search *s = TAKE(w->scratch, 1, struct search);
    *s = (struct search){.step = TAKE(w->scratch, w->nrank, struct step),
                         .signal = signal,
                         .release = SIM_NEVER};
    return s;
}

static void begin_step(struct vp *v, struct step *step)
{
    *step = (struct step){.begin = v->clock, .computed = vp_stage_time(v)->compute_ps};
}

/* The barrier before a search clears the network: nobody is left in the last one. */
static int begin_search(struct vp *v, struct search *s)
{
    struct world *w = v->world;
    if (++s->entered == w->nrank) {
        s->entered = s->exhausted = 0;
        s->found = false;
        s->release = SIM_NEVER;
    }
    v->comm.type->barrier(&v->comm);
    begin_step(v, &s->step[v->comm.rank]);
    return 0;
}

/* The end is decided by v at its clock, as far as the events have come: everybody who waits hears
 * of it. */
static void release(struct vp *v, struct search *s)
{
    struct world *w = v->world;
    s->release = ps_later(v->clock, s->signal);
    if (w->path)
        s->path = path_add(w->path, vp_path_until(v, v->clock), s->release, PATH_COLLECTIVE, -1,
                           v->stage, -1, 0);
    for (int i = 0; i < w->nrank; i++)
        if (s->step[i].waits && s->release < w->vp[i].matching->until)
            timer_set(&w->vp[i], s->release);
}

/* Computing of v after `time` has not been done. Of all spans its own last ones, which others may
 * stand between. */
static void cut_spans(struct vp *v, sim_ps time)
{
    struct run_result *r = v->world->result;
    const int64_t end = time - v->world->start;
    for (int64_t i = r->nspan - 1; i >= 0; i--) {
        struct span *s = &r->span[i];
        if (s->rank != v->comm.rank) continue;
        if (s->end_ps <= end) return;
        s->end_ps = end;
        if (s->begin_ps > end) s->begin_ps = end;
    }
}

/* The clock goes back to the signal, if nothing but computing was done since the step began. */
static void interrupt(struct vp *v, const struct search *s, const struct step *step)
{
    struct stage_time *t = vp_stage_time(v);
    const sim_ps late = v->clock - s->release;
    if (late <= 0 || t->compute_ps - step->computed != v->clock - step->begin) return;
    t->compute_ps -= late;
    if (v->world->record->spans) cut_spans(v, s->release);
    v->clock = s->release;
    v->path = s->path;
}

/* Until the signal, or until `time`, whichever comes first. */
static void stop_until(struct vp *v, struct step *step, sim_ps time)
{
    struct matching *k = v->matching;
    k->least = SIM_NEVER; /* no message that comes shortens this */
    step->waits = true;
    /* What has no time is ended by a signal alone. */
    if (time < SIM_NEVER) timer_set(v, time);
    else k->until = SIM_NEVER, k->timer++;
    vp_block(v, WAITING_POLL, NULL);
    step->waits = false;
}

int vp_search(struct comm *c, int state)
{
    struct vp *v = (struct vp *)c;
    struct search *s = v->world->search;
    struct step *step = &s->step[c->rank];
    if (!v->matching)
        vp_misuse(v, "a search in a program that has promised to do without looks at the clock "
                     "(a kernel in one file declares .wildcards = 1)");
    if (state == COMM_SEARCH_BEGIN) return begin_search(v, s);
    offload_called(v);
    /* What comes of the step counts where no signal came before its end. */
    if (s->release == SIM_NEVER) stop_until(v, step, v->clock);
    const bool counts = s->release > v->clock;
    if (counts && s->release == SIM_NEVER) {
        s->exhausted += state == COMM_SEARCH_EXHAUSTED;
        s->found = state == COMM_SEARCH_FOUND;
        if (s->found || s->exhausted == v->world->nrank) release(v, s);
        else if (state == COMM_SEARCH_EXHAUSTED) stop_until(v, step, SIM_NEVER);
    }
    /* A signal that is still on its way interrupts the next step. */
    if (counts && state == COMM_SEARCH_GOES_ON) {
        begin_step(v, step);
        return 0;
    }
    /* Somebody has found, or nobody ever will: the end comes to all ranks at one time. */
    interrupt(v, s, step);
    vp_path_join(v, s->path);
    vp_wait_until(v, s->release, s->release);
    return !s->found ? -1 : counts && state == COMM_SEARCH_FOUND ? 2 : 1;
}
