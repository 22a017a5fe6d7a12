/* deadlock.c - who waits for whom when no event is left, or how far a rank came when simulated time
 * ended.
 *
 * Nothing is detected here: when no event is left and ranks still wait, the run is a
 * deadlock by definition. What is worked out is a text that names a cause. */
#include <stdio.h>
#include <string.h>

#include "base/picoseconds.h"
#include "vp/explain.h"
#include "vp/matching.h"
#include "vp/meeting.h"

/* -1 where no single rank could end the wait. */
static int peer_of(const struct vp *v)
{
    return v->waiting_for == WAITING_RECEIVE || v->waiting_for == WAITING_SEND ? v->waiting->peer
                                                                               : -1;
}

/* "at most 80 bytes, any tag, from any rank"; "a message" where any number of bytes will do. A tag
 * may carry further numbers above its lower 32 bits. Room mpi keeps context and plane there, which
 * mean nothing to a reader. */
static int describe_receive(const struct comm_request *r, char *s, int size)
{
    char tag[48] = "any tag", from[24] = "any rank", what[48] = "a message";
    if (r->mask & UINT32_MAX)
        snprintf(tag, sizeof tag, "tag %lld", (long long)(r->tag & UINT32_MAX));
    if (r->peer >= 0) snprintf(from, sizeof from, "rank %d", r->peer);
    if (r->kind == RECEIVE_PROBE)
        return snprintf(s, size, "probes for a message, %s, from %s", tag, from);
    if (r->bytes < INT64_MAX)
        snprintf(what, sizeof what, "%s%lld bytes", r->kind == RECEIVE_EXACT ? "" : "at most ",
                 (long long)r->bytes);
    return snprintf(s, size, "waits to receive %s, %s, from %s", what, tag, from);
}

static int describe(const struct vp *v, char *s, int size)
{
    const char *stage = v->world->result->stage_name[v->stage];
    const struct comm_request *r = v->waiting;
    char receive[160];
    /* Each says the call site as well: that is where to look in the program. */
    switch (v->waiting_for) {
    case WAITING_RECEIVE:
        describe_receive(r, receive, sizeof receive);
        return snprintf(s, size, "rank %d in %s %s (%s:%d)", v->comm.rank, stage, receive,
                        vp_base_name(r->file), r->line);
    case WAITING_SEND:
        return snprintf(s, size,
                        "rank %d in %s waits for rank %d to take %lld bytes, tag %lld (%s:%d)",
                        v->comm.rank, stage, r->peer, (long long)r->bytes,
                        (long long)(r->tag & UINT32_MAX), vp_base_name(r->file), r->line);
    case WAITING_BARRIER:
        return snprintf(s, size,
                        "rank %d in %s waits in a barrier (%s:%d) that %d of %d ranks have entered",
                        v->comm.rank, stage, vp_base_name(v->comm.file), v->comm.line,
                        v->world->barrier_count, v->world->nrank);
    case WAITING_MEETING:
        return meeting_describe(v, s, size);
    case WAITING_POLL: /* longer than a look: for the end of a search */
        return snprintf(s, size, "rank %d in %s waits for the end of a search (%s:%d)",
                        v->comm.rank, stage, vp_base_name(v->comm.file), v->comm.line);
    case WAITING_ANY: /* for a receive that nothing has come for, if there is one */
        r = v->posted;
        if (r) describe_receive(r, receive, sizeof receive);
        return snprintf(s, size, "rank %d in %s %s%s (%s:%d)", v->comm.rank, stage,
                        r ? "waits for any of several requests, first it "
                          : "waits for any of several requests",
                        r ? receive : "", vp_base_name(r ? r->file : v->comm.file),
                        r ? r->line : v->comm.line);
    default:
        return snprintf(s, size, "rank %d in %s waits for the kernel server", v->comm.rank, stage);
    }
}

/* Anybody could end the wait of `v`: all others have finished or wait, too. Three of them
 * are told. Three are enough to see a pattern; a list of 65,536 would not be read. */
static void describe_others(struct world *w, const struct vp *v, char *s, int size)
{
    int finished = 0, told = 0, used = 0;
    for (int i = 0; i < w->nrank; i++) finished += w->vp[i].waiting_for == WAITING_NOTHING;
    used += snprintf(s, size, "; of the others %d have finished and %d wait", finished,
                     w->nrank - 1 - finished);
    for (int i = 0; i < w->nrank && told < 3 && used < size; i++) {
        if (&w->vp[i] == v || w->vp[i].waiting_for == WAITING_NOTHING) continue;
        used += snprintf(s + used, size - used, "%s", told++ ? "; " : ": ");
        if (used < size) used += describe(&w->vp[i], s + used, size - used);
    }
}

/* Such a wait ends every chain: there is no one to follow. */
static bool waits_for_anybody(const struct vp *v)
{
    return v->waiting_for == WAITING_ANY ||
           (v->waiting_for == WAITING_RECEIVE && v->waiting->peer < 0);
}

static struct vp *first_blocked(struct world *w)
{
    for (int i = 0; i < w->nrank; i++)
        if (w->vp[i].waiting_for != WAITING_NOTHING) return &w->vp[i];
    return NULL;
}

/* A rank on the cycle that starts from `v`, or the end of the chain when it leads to a
 * finished rank or a barrier. After P steps along waits for single ranks one is on a
 * cycle, if there is one: the first steps may lead into it from outside. */
static struct vp *walk_into_cycle(struct world *w, struct vp *v)
{
    for (int steps = 0; steps < w->nrank; steps++) {
        int peer = peer_of(v);
        if (peer < 0 || w->vp[peer].waiting_for == WAITING_NOTHING) return v;
        v = &w->vp[peer];
    }
    return v;
}

sim_ps deadlock_reached(const struct world *w, int first, int n)
{
    sim_ps latest = 0;
    for (int i = first; i < first + n; i++) {
        const struct vp *v = &w->vp[i];
        const sim_ps at = v->waiting_for == WAITING_NOTHING ? v->finish : v->clock - w->start;
        if (at > latest) latest = at;
    }
    return latest;
}

/* Each rank has waited since it stood still, or ended: so its parts add up to the run's time. */
void deadlock_time(struct world *w, sim_ps reached)
{
    w->result->makespan_ps = reached;
    for (int i = w->first; i < w->first + w->nown; i++) {
        const struct vp *v = &w->vp[i];
        const sim_ps at = v->waiting_for == WAITING_NOTHING ? v->finish : v->clock - w->start;
        if (v->stages) v->stages[w->nstage].wait_ps += reached - at;
    }
}

void deadlock_explain(struct world *w)
{
    char *text = w->result->text;
    int size = (int)sizeof w->result->text, used = 0;
    /* Full buffers of the network can lock up by themselves; then ranks only suffer. */
    if (net_deadlock(w->net, text, size)) return;
    struct vp *start = walk_into_cycle(w, first_blocked(w)), *v = start;
    used += snprintf(text, size, "deadlock: ");
    /* Up to eight links of the chain: longer cycles look alike. */
    for (int k = 0; k < 8 && used < size; k++) {
        used += describe(v, text + used, size - used);
        int peer = peer_of(v);
        if (waits_for_anybody(v) && used < size) describe_others(w, v, text + used, size - used);
        if (peer < 0 || used >= size) return;
        if (w->vp[peer].waiting_for == WAITING_NOTHING) {
            snprintf(text + used, size - used, ", and rank %d has finished", peer);
            return;
        }
        v = &w->vp[peer];
        if (v == start) {
            snprintf(text + used, size - used, ": a cycle of %d", k + 1);
            return;
        }
        used += snprintf(text + used, size - used, "; ");
    }
    if (used < size) snprintf(text + used, size - used, "and so on");
}

/* For programs that promise to receive everything. The first such rank is told. */
void find_leftovers(struct world *w)
{
    for (int i = 0; i < w->nrank; i++) {
        struct vp *v = &w->vp[i];
        const struct message *m = v->matching ? matching_leftover(v) : v->unexpected;
        if (!m) continue;
        char text[512];
        snprintf(text, sizeof text,
                 "it has ended without receiving the message of %lld bytes, tag %lld, that rank %d "
                 "sent it at %.9g s",
                 (long long)m->bytes, (long long)m->tag, m->from->comm.rank,
                 (double)(m->sent - w->start) / SIM_PS_PER_S);
        vp_record_failure(v, v->comm.file, v->comm.line, text);
        return;
    }
}

void late_explain(struct world *w)
{
    struct run_result *r = w->result;
    const struct vp *v = w->late;
    /* No rank passed the end, so an event did: the rank that has come farthest says how
     * far the run is. */
    for (int i = 0; i < w->nrank && !w->late; i++)
        if (!v || w->vp[i].clock > v->clock) v = &w->vp[i];
    snprintf(r->text, sizeof r->text,
             "simulated time ends at %.3g s: rank %d had reached %.6g s in %s, and what %s next "
             "comes later",
             PS_LAST / SIM_PS_PER_S, v->comm.rank, (double)v->clock / SIM_PS_PER_S,
             r->stage_name[v->stage], w->late ? "it does" : "happens");
}
