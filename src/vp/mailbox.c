/* mailbox.c - messages and receives find each other by (source, tag), in the order sent and the
 * order posted.
 *
 * Used by programs that have promised to do without wildcards and tests (world_load.timed
 * = false): what a receive takes then follows from the order of sends and receives alone,
 * not from time, and no event is needed to match. */
#include "base/check.h"
#include "vp/explain.h"
#include "vp/vp.h"

static inline bool fits(const struct message *m, const struct comm_request *r)
{
    return message_fits(m, message_source(m), r);
}

void message_bind(struct vp *v, struct comm_request *r, struct message *m, sim_ps now)
{
    /* Kernels say how much they expect; MPI says how much fits. The first is checked, the
     * second is cut. */
    if (r->kind == RECEIVE_EXACT && m->bytes != r->bytes) size_mismatch(v, r, m);
    r->truncated = m->bytes > r->capacity;
    r->bytes = m->bytes;
    r->tag = m->tag;
    r->peer = message_source(m);
    r->detail = m;
    /* Nothing has come but a request to send: data follow when both ends know of each
     * other (rendezvous.c). */
    if (m->kind == MESSAGE_REQUEST_TO_SEND) {
        r->active = REQUEST_COMING;
        m->receive = r;
        rendezvous_matched(m, r, now);
        return;
    }
    r->active = REQUEST_MATCHED;
    vp_notify(v, r, m->net.arrival);
}

static inline sim_ps later(sim_ps a, sim_ps b) { return a > b ? a : b; }

/* Messages stand in the order in which they came. Lists are short in programs that post
 * receives early, so they are searched from the start. */
void mailbox_post(struct vp *v, struct comm_request *r)
{
    for (struct message **p = &v->unexpected; *p; p = &(*p)->next) {
        struct message *m = *p;
        if (!fits(m, r)) continue;
        *p = m->next;
        if (!m->next) v->unexpected_end = p;
        message_bind(v, r, m, later(m->net.arrival, r->posted_ps));
        return;
    }
    r->active = REQUEST_POSTED;
    r->detail = NULL;
    *v->posted_end = r;
    v->posted_end = (struct comm_request **)&r->detail;
}

/* Receives stand in the order of posting, and the first that fits takes the message, as
 * MPI orders it (section 3.5). */
void mailbox_deliver(struct vp *v, struct message *m)
{
    for (struct comm_request **p = &v->posted; *p; p = (struct comm_request **)&(*p)->detail) {
        struct comm_request *r = *p;
        if (!fits(m, r)) continue;
        *p = r->detail;
        if (!r->detail) v->posted_end = p;
        message_bind(v, r, m, later(m->net.arrival, r->posted_ps));
        return;
    }
    m->next = NULL;
    *v->unexpected_end = m;
    v->unexpected_end = &m->next;
}
