/* vp_comm.c - comm.h made of fibers, mailboxes, the network and a clock of one's own.
 *
 * Every advance of a clock is charged to one component of one stage, so that the components of a rank add up to its
 * finishing time without remainder. */
#include <string.h>

#include "base/check.h"
#include "base/digest.h"
#include "base/picoseconds.h"
#include "comm/collectives.h"
#include "vp/vp.h"

enum { BARRIER_TAG = 1 << 30 };

static void charge_send(struct vp *v, const struct message *m)
{
    const struct world *w = v->world;
    const struct message_cost *s = message_cost(&w->software, m->bytes);
    sim_ps begin = v->clock, cost = byte_cost(s->send, s->send_byte, m->bytes);
    if (w->machine->software.kernel_server) {
        sim_ps service = server_pass(v, m->bytes);
        cost = cost > service ? cost : service;
    }
    vp_advance(v, v->clock + cost);
    vp_stage_time(v)->send_ps += cost;
    if (w->record->spans) vp_span(v, SPAN_SEND, begin, v->clock, m->to->comm.rank, m->bytes, m->net.id);
}

static void charge_receive(struct vp *v, const struct message *m)
{
    const struct world *w = v->world;
    const struct message_cost *s = message_cost(&w->software, m->bytes);
    sim_ps begin = v->clock, cost = byte_cost(s->recv, s->recv_byte, m->bytes);
    if (w->machine->software.kernel_server) {
        sim_ps service = server_pass(v, m->bytes);
        cost = cost > service ? cost : service;
    }
    vp_advance(v, v->clock + cost);
    vp_stage_time(v)->recv_ps += cost;
    if (w->record->spans) vp_span(v, SPAN_RECV, begin, v->clock, m->from->comm.rank, m->bytes, m->net.id);
}

static void vp_isend(struct comm *c, int dst, int tag, const void *data, int64_t bytes, struct comm_request *r)
{
    struct vp *v = (struct vp *)c;
    struct world *w = v->world;
    CHECK(dst >= 0 && dst < w->nrank && tag >= 0 && bytes >= 0);
    CHECK(bytes <= w->load->largest_message || w->load->largest_message < 0);
    struct message *m = message_take(w, bytes);
    if (bytes) memcpy(m->data, data, (size_t)bytes);
    m->from = v;
    m->to = &w->vp[dst];
    m->tag = tag;
    m->net.id = (int64_t)v->comm.rank << 32 | v->sent++;
    m->sent = v->clock;
    vp_stage_time(v)->messages++;
    vp_stage_time(v)->bytes += bytes;
    charge_send(v, m);
    m->net.ready = v->clock;
    m->net.bytes = bytes;
    if (!w->eager_only && message_cost(&w->software, bytes)->protocol != PROTOCOL_EAGER) {
        rendezvous_send(v, m, r);
        return;
    }
    if (r) r->active = REQUEST_DONE;
    m->kind = MESSAGE_EAGER;
    vp_launch(w, m, v, m->to);
}

static void vp_irecv(struct comm *c, int src, int tag, void *buffer, int64_t bytes, struct comm_request *r)
{
    struct vp *v = (struct vp *)c;
    CHECK(src >= 0 && src < v->world->nrank && tag >= 0 && bytes >= 0);
    *r = (struct comm_request){
        .buffer = buffer, .bytes = bytes, .peer = src, .tag = tag, .file = c->file, .line = c->line};
    mailbox_post(v, r);
}

static void finish_receive(struct vp *v, struct comm_request *r)
{
    struct message *m = r->detail;
    sim_ps begin = v->clock;
    vp_wait_until(v, m->net.arrival, m->net.uncontended);
    if (v->world->record->spans) vp_span(v, SPAN_WAIT, begin, v->clock, r->peer, m->bytes, -1);
    charge_receive(v, m);
    if (m->bytes) memcpy(r->buffer, m->data, (size_t)m->bytes);
    v->digest = digest_mix(v->digest, (uint64_t)m->net.id);
    v->digest = digest_mix(v->digest, (uint64_t)m->net.arrival);
    message_give(v->world, m);
    r->active = REQUEST_DONE;
    r->detail = NULL;
}

/* What holds the sender of a synchronous message is its software: it counts as sending, whatever delays the data. */
static void finish_synchronous(struct vp *v, struct comm_request *r)
{
    const sim_ps time = (sim_ps)(intptr_t)r->detail, held = time > v->clock ? time - v->clock : 0;
    if (held && v->world->record->spans) vp_span(v, SPAN_SEND, v->clock, time, r->peer, r->bytes, -1);
    vp_stage_time(v)->send_ps += held;
    vp_advance(v, v->clock + held);
    r->active = REQUEST_DONE;
    r->detail = NULL;
}

static void vp_wait(struct comm *c, struct comm_request *r)
{
    struct vp *v = (struct vp *)c;
    if (r->active == REQUEST_DONE) return;
    r->file = c->file;
    r->line = c->line;
    if (r->active == REQUEST_SENDING) vp_block(v, WAITING_SEND, r);
    if (r->active == REQUEST_DELIVERED) {
        finish_synchronous(v, r);
        return;
    }
    if (r->active == REQUEST_SENT) {
        sim_ps time = (sim_ps)(intptr_t)r->detail;
        vp_wait_until(v, time, time);
        r->active = REQUEST_DONE;
        r->detail = NULL;
        return;
    }
    if (r->active == REQUEST_POSTED) vp_block(v, WAITING_RECEIVE, r);
    CHECK(r->active == REQUEST_MATCHED);
    finish_receive(v, r);
}

/* The last rank to enter lets everybody go at the same time. The release time stays valid until the next barrier is
 * complete, for which every rank must have left this one. */
static void hardware_barrier(struct vp *v)
{
    struct world *w = v->world;
    if (v->clock > w->barrier_latest) w->barrier_latest = v->clock;
    if (++w->barrier_count < w->nrank) {
        vp_block(v, WAITING_BARRIER, NULL);
    } else {
        w->barrier_release = w->barrier_latest + w->software.barrier;
        w->barrier_count = 0;
        w->barrier_latest = 0;
        for (int i = 0; i < w->nrank; i++)
            if (&w->vp[i] != v) vp_wake(w, &w->vp[i]);
    }
    vp_wait_until(v, w->barrier_release, w->barrier_release);
}

static void vp_barrier(struct comm *c)
{
    struct vp *v = (struct vp *)c;
    sim_ps begin = v->clock;
    if (v->world->nrank > 1) {
        if (v->world->machine->software.barrier == BARRIER_HARDWARE) hardware_barrier(v);
        else collective_barrier(c, BARRIER_TAG);
    }
    if (v->world->record->spans) vp_span(v, SPAN_BARRIER, begin, v->clock, -1, 0, -1);
}

static void vp_work(struct comm *c, const struct work *work)
{
    struct vp *v = (struct vp *)c;
    const struct world *w = v->world;
    sim_ps begin = v->clock, cost = node_cost_ps(&w->node_cost, work);
    if (w->noisy) {
        double factor = 1 + w->machine->noise.compute_cv * random_normal(&v->noise);
        cost = factor > 0 ? ps_rounded((double)cost * factor) : 0;
    }
    vp_advance(v, v->clock + cost);
    vp_stage_time(v)->compute_ps += cost;
    work_add(&vp_stage_time(v)->work, work);
    if (w->record->spans) vp_span(v, SPAN_COMPUTE, begin, v->clock, -1, 0, -1);
}

static void vp_stage(struct comm *c, int stage)
{
    struct vp *v = (struct vp *)c;
    CHECK(stage >= 0 && stage < v->world->nstage);
    v->stage = stage;
}

static int64_t vp_now(struct comm *c) { return ((struct vp *)c)->clock; }

const struct comm_type vp_comm_type = {
    .name = "vp",
    .isend = vp_isend,
    .irecv = vp_irecv,
    .wait = vp_wait,
    .barrier = vp_barrier,
    .work = vp_work,
    .stage = vp_stage,
    .now_ps = vp_now,
    .publish = comm_publish_here,
};
