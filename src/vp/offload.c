/* offload.c - see offload.h.
 *
 * A rank runs ahead: when an event at some time is dispatched, everything that the rank does up to
 * its next wait has been done on the host, at later clocks. So whether it computed at that time is
 * known: what it has computed since is kept, piece by piece, and pieces that have ended before the
 * event are forgotten. */
#include "vp/offload.h"

#include <string.h>

#include "vp/path.h"

bool offload_check(const struct machine_spec *m, struct err *e)
{
    if (m->software.offload != OFFLOAD_COPIES || !m->software.kernel_server) return true;
    return err_set(e, ERR_CONFIG,
                   "machine.software.offload is copies, but with machine.software.kernel.server "
                   "the kernel makes them: expected handshakes or none");
}

/* Computing of a rank without a call in between, in the order of time. */
struct pieces {
    int n, capacity;
    struct piece {
        sim_ps begin, end;
    } * piece;
};

/* Nothing comes any more at times before that of the event being dispatched. */
static void forget(struct pieces *p, sim_ps now)
{
    int old = 0;
    while (old < p->n && p->piece[old].end <= now) old++;
    if (old == 0) return; /* also where there is no array yet */
    p->n -= old;
    memmove(p->piece, p->piece + old, (size_t)p->n * sizeof *p->piece);
}

static void append(struct pieces *p, struct piece piece, struct world *w)
{
    if (p->n == p->capacity) forget(p, sim_now(w->sim));
    /* Half of the room free again, or twice the room: a piece is moved a few times at most. The
     * run's memory keeps the old one until it ends. */
    if (2 * p->n >= p->capacity) {
        struct piece *old = p->piece;
        p->capacity = p->capacity > 0 ? 2 * p->capacity : 8;
        p->piece = TAKE(w->scratch, p->capacity, struct piece);
        if (p->n > 0) memcpy(p->piece, old, (size_t)p->n * sizeof *old);
    }
    p->piece[p->n++] = piece;
}

void offload_computed(struct vp *v, sim_ps begin)
{
    struct world *w = v->world;
    /* Only hand-shakes ask. */
    if (w->machine->software.offload != OFFLOAD_NONE || w->eager_only || v->clock == begin) return;
    if (v->extra->pieces == NULL) v->extra->pieces = TAKE(w->scratch, 1, struct pieces);
    struct pieces *p = v->extra->pieces;
    /* Counted work that follows counted work is one piece: nothing is answered in between. */
    const bool goes_on = !v->called && p->n > 0 && p->piece[p->n - 1].end == begin;
    if (goes_on) p->piece[p->n - 1].end = v->clock;
    else append(p, (struct piece){begin, v->clock}, w);
    v->called = false;
}

/* At the very beginning and end of a piece the rank is in the calls before and behind it. */
sim_ps offload_answer(const struct vp *v, sim_ps time)
{
    const struct pieces *p = v->extra ? v->extra->pieces : NULL;
    for (int i = 0; p != NULL && i < p->n && p->piece[i].begin < time; i++)
        if (time < p->piece[i].end) return p->piece[i].end;
    return time;
}

/* A copy of `bytes` at `per_byte` that engine work at `path` ends with, as a node of the log. */
static uint32_t log_copy(const struct vp *v, uint32_t path, sim_ps end, enum path_cause cause,
                         int64_t bytes)
{
    struct world *w = v->world;
    if (w->path == NULL) return path;
    return path_add(w->path, path, end, cause, v->comm.rank, v->stage, -1, bytes);
}

void offload_send(struct vp *v, struct message *m)
{
    struct world *w = v->world;
    if (w->machine->software.offload != OFFLOAD_COPIES) return;
    const sim_ps copy = byte_cost(0, message_cost(&w->software, m->bytes)->send_byte, m->bytes);
    /* The engine goes on from the copy before, or begins now. */
    const bool busy = v->extra->engine_free > v->clock;
    /* The rank's clock does not stand by when many long copies follow each other: no sum of them
     * may wrap. */
    const sim_ps end = ps_later(busy ? v->extra->engine_free : v->clock, copy);
    v->extra->engine_path =
        log_copy(v, busy ? v->extra->engine_path : v->path, end, PATH_ENGINE_SEND, m->bytes);
    v->extra->engine_free = end;
    m->net.ready = m->copied = v->extra->engine_free;
    m->net.path = m->copied_path = v->extra->engine_path;
}

void offload_receive(struct message *m)
{
    const struct vp *v = m->to;
    const struct world *w = v->world;
    if (w->machine->software.offload != OFFLOAD_COPIES) return;
    const sim_ps copy = byte_cost(0, message_cost(&w->software, m->bytes)->recv_byte, m->bytes);
    m->net.arrival = ps_later(m->net.arrival, copy);
    m->net.uncontended = ps_later(m->net.uncontended, copy);
    m->net.path = log_copy(v, m->net.path, m->net.arrival, PATH_ENGINE_RECV, m->bytes);
}
