/* rendezvous.c - large messages: request to send, clear to send, data. Both ends' software reacts
 * without waiting for its kernel (asynchronous progress), so a hand-shake costs two zero-byte trips
 * and the machine's software time. The sender's request is complete when the clear to send is
 * there, that of a synchronous message when its data arrived. */
#include "base/check.h"
#include "vp/offload.h"
#include "vp/path.h"
#include "vp/vp.h"

/* The three parts travel as the same message with another size and start. */
static void travel(struct message *m, struct vp *from, struct vp *to, int64_t bytes, sim_ps ready)
{
    m->net.bytes = bytes;
    m->net.ready = ready;
    vp_launch(from->world, m, from, to);
}

/* Request to send: 0 bytes, so that it never waits for room at the receiver. */
void rendezvous_send(struct vp *v, struct message *m, struct comm_request *r)
{
    m->kind = MESSAGE_REQUEST_TO_SEND;
    m->send = r;
    if (r)
        *r = (struct comm_request){.bytes = m->bytes,
                                   .peer = (int)(m->to - v->world->vp),
                                   .tag = m->tag,
                                   .active = REQUEST_SENDING,
                                   .file = v->comm.file,
                                   .line = v->comm.line};
    /* The request does not wait for what an engine copies. */
    m->net.path = v->path;
    travel(m, v, m->to, 0, v->clock);
}

/* The request binds unless the receive was posted after it had arrived. */
static uint32_t bind_path(const struct message *m, const struct comm_request *r, sim_ps now,
                          sim_ps ready)
{
    struct vp *v = m->to;
    struct path_log *p = v->world->path;
    const bool posted = now > m->net.arrival;
    const uint32_t winner = posted ? vp_path_until(v, now) : m->net.path;
    const uint32_t loser = posted ? m->net.path : r->path;
    return path_add(p, path_join(p, winner, loser, 0, PATH_POLL, v->comm.rank, v->stage), ready,
                    PATH_RENDEZVOUS, v->comm.rank, v->stage, -1, m->bytes);
}

/* The receive is posted and the request is there: clear to send, after the software's time. What
 * contention has cost so far is kept in `delay`. */
void rendezvous_matched(struct message *m, struct comm_request *r, sim_ps now)
{
    struct vp *v = m->to;
    now = offload_answer(v, now);
    const sim_ps ready = now + message_cost(&v->world->software, m->bytes)->rendezvous;
    m->delay += m->net.arrival - m->net.uncontended;
    m->kind = MESSAGE_CLEAR_TO_SEND;
    if (v->world->path) m->net.path = bind_path(m, r, now, ready);
    travel(m, v, m->from, 0, ready);
}

/* the sender's request ends in `state` at the message's arrival; nobody may wait for it */
static void release_sender(struct message *m, int state)
{
    struct comm_request *s = m->send;
    if (!s) return;
    s->active = state;
    s->detail = (void *)(intptr_t)m->net.arrival;
    s->path = m->net.path;
    m->send = NULL;
    vp_notify(m->from, s, m->net.arrival);
}

/* When the data can leave, with its node: the sender's software, or its engine, may be busy. */
static sim_ps leave(struct message *m)
{
    const sim_ps ready = offload_answer(m->from, m->net.arrival);
    const bool computed = ready > m->net.arrival;
    if (computed && m->from->world->path) m->net.path = vp_path_until(m->from, ready);
    if (m->copied <= ready) return ready;
    m->net.path = m->copied_path;
    return m->copied;
}

/* Clear to send has arrived: the data leave. A synchronous protocol holds the sender until they
 * have arrived, any other lets it go on now. */
static void cleared(struct message *m)
{
    bool held = message_cost(&m->from->world->software, m->bytes)->protocol == PROTOCOL_SYNCHRONOUS;
    if (m->synchronous) held = false; /* the program asked to know that it is taken, which it is */
    m->delay += m->net.arrival - m->net.uncontended;
    m->kind = MESSAGE_DATA;
    if (!held) release_sender(m, REQUEST_SENT);
    travel(m, m->from, m->to, m->bytes, leave(m));
}

/* Data never come before a receive matched: that is what the handshake was for. */
void rendezvous_deliver(struct message *m)
{
    if (m->kind == MESSAGE_CLEAR_TO_SEND) {
        cleared(m);
        return;
    }
    CHECK(m->kind == MESSAGE_DATA && m->receive);
    struct comm_request *r = m->receive;
    offload_receive(m);
    /* Delays of request and answer count as contention of the whole message. */
    m->net.uncontended -= m->delay;
    release_sender(m, REQUEST_DELIVERED);
    r->active = REQUEST_MATCHED;
    r->detail = m;
    vp_notify(m->to, r, m->net.arrival);
}
