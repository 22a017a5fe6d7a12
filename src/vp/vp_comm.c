/* vp_comm.c - comm.h made of fibers, mailboxes, the network and a clock of one's own.
 *
 * Every advance of a clock is charged to one component of one stage, so that the components of a
 * rank add up to its finishing time without remainder. */
#include <string.h>

#include "base/check.h"
#include "base/digest.h"
#include "base/picoseconds.h"
#include "comm/collectives.h"
#include "vp/explain.h"
#include "vp/shared.h"
#include "vp/matching.h"
#include "vp/offload.h"
#include "vp/meeting.h"
#include "vp/balance.h"
#include "vp/path.h"
#include "vp/vp.h"

enum { BARRIER_TAG = 1 << 30 };

/* The number of m within its job: what others run beside it is no part of a job's own record. */
static int64_t own_id(const struct message *m)
{
    return m->net.id & (((int64_t)1 << NET_ID_JOB) - 1);
}

/* One end of a message: overhead and copying by the machine's segments (docs/network.md). Where one
 * kernel server serves the whole machine, the rank waits for its turn first and is busy for the
 * longer of the two. Returns how long without the waiting. */
static inline sim_ps charge(struct vp *v, enum path_cause cause, sim_ps overhead, double per_byte,
                            int64_t bytes)
{
    const struct software_spec *software = &v->world->machine->software;
    if (software->offload == OFFLOAD_COPIES) per_byte = 0;
    sim_ps cost = byte_cost(overhead, per_byte, bytes);
    if (software->kernel_server) {
        const sim_ps service = server_pass(v, bytes);
        cost = cost > service ? cost : service;
    }
    const sim_ps served = v->clock;
    vp_advance(v, v->clock + cost);
    vp_path(v, cause, served, bytes);
    return cost;
}

/* Spans cover waiting for the server, too. */
static void charge_send(struct vp *v, const struct message *m)
{
    const struct world *w = v->world;
    const struct message_cost *s = message_cost(&w->software, m->bytes);
    const sim_ps begin = v->clock;
    vp_stage_time(v)->send_ps += charge(v, PATH_SEND, s->send, s->send_byte, m->bytes);
    if (w->record->spans)
        vp_span(v, SPAN_SEND, begin, v->clock, (int)(m->to - w->vp), m->bytes, own_id(m));
}

static void charge_receive(struct vp *v, const struct message *m)
{
    const struct world *w = v->world;
    const struct message_cost *s = message_cost(&w->software, m->bytes);
    const sim_ps begin = v->clock;
    vp_stage_time(v)->recv_ps += charge(v, PATH_RECV, s->recv, s->recv_byte, m->bytes);
    if (w->record->spans)
        vp_span(v, SPAN_RECV, begin, v->clock, message_source(m), m->bytes, own_id(m));
}

static struct message *make_message(struct vp *v, int dst, int64_t tag, const void *data,
                                    int64_t bytes)
{
    struct world *w = v->world;
    /* Arguments come from programs, also somebody else's. */
    if (dst < 0 || dst >= w->nrank)
        vp_misuse(v, "a message to rank %d: there are 0 .. %d", dst, w->nrank - 1);
    if (tag < 0 || bytes < 0)
        vp_misuse(v, "a message of %lld bytes with tag %lld to rank %d", (long long)bytes,
                  (long long)tag, dst);
    CHECK(bytes <= w->load->largest_message || w->load->largest_message < 0);
    /* comm.h copies what is sent: the program may change its buffer at once, whatever the
     * protocol. */
    struct message *m = message_take(w->pool, data ? bytes : 0);
    if (data && bytes) memcpy(m->data, data, (size_t)bytes);
    m->hollow = !data;
    m->bytes = bytes;
    m->from = v;
    m->to = &w->vp[dst];
    m->tag = tag;
    /* Sender and count make a number that is unique in the run and orders events at one
     * time, whichever way the host runs ranks. */
    m->net.id = (int64_t)w->job << NET_ID_JOB | (int64_t)v->comm.rank << 32 | v->sent++;
    m->sent = v->clock;
    /* Counted at the sender, so that totals over ranks count each message once. */
    vp_stage_time(v)->messages++;
    vp_stage_time(v)->bytes += bytes;
    /* It is ready for the network when the sender's software has done its part. */
    charge_send(v, m);
    offload_called(v);
    m->net.ready = v->clock;
    m->net.bytes = bytes;
    m->net.path = v->path;
    offload_send(v, m);
    /* The order of sending counts from here, before the network says when it arrives. */
    if (v->matching) matching_announce(m);
    return m;
}

/* An eager message needs nothing of its receiver, so its request is complete now; any
 * other shakes hands. */
static void vp_isend(struct comm *c, int dst, int64_t tag, const void *data, int64_t bytes,
                     struct comm_request *r)
{
    struct vp *v = (struct vp *)c;
    struct world *w = v->world;
    struct message *m = make_message(v, dst, tag, data, bytes);
    if (!w->eager_only && message_cost(&w->software, bytes)->protocol != PROTOCOL_EAGER) {
        rendezvous_send(v, m, r);
        return;
    }
    if (r) r->active = REQUEST_DONE;
    m->kind = MESSAGE_EAGER;
    vp_launch(w, m, v, m->to);
}

/* Always with a hand-shake, whatever the size: its end means that a receive has matched. */
static void vp_isend_synchronous(struct comm *c, int dst, int64_t tag, const void *data,
                                 int64_t bytes, struct comm_request *r)
{
    struct vp *v = (struct vp *)c;
    if (v->world->eager_only)
        vp_misuse(v, "a synchronous send in a program that has promised to do without it "
                     "(a kernel in one file declares .wildcards = 1)");
    struct message *m = make_message(v, dst, tag, data, bytes);
    m->synchronous = 1;
    rendezvous_send(v, m, r);
}

/* Without wildcards the order of sending decides, so an untimed program needs no events
 * here. */
static void post(struct vp *v, struct comm_request *r)
{
    offload_called(v);
    /* Where a hand-shake waits for the receive to be posted, this is what it waits for. */
    if (v->world->path && path_keeps_losers(v->world->path)) r->path = vp_path_until(v, v->clock);
    if (v->matching) matching_post(v, r);
    else r->posted_ps = v->clock, mailbox_post(v, r);
}

/* The size is exact: kernels know what they expect. */
static void vp_irecv(struct comm *c, int src, int64_t tag, void *buffer, int64_t bytes,
                     struct comm_request *r)
{
    struct vp *v = (struct vp *)c;
    if (src < 0 || src >= v->world->nrank || tag < 0 || bytes < 0)
        vp_misuse(v, "a receive of %lld bytes, tag %lld, from rank %d: there are 0 .. %d",
                  (long long)bytes, (long long)tag, src, v->world->nrank - 1);
    *r = (struct comm_request){.buffer = buffer,
                               .bytes = bytes,
                               .capacity = bytes,
                               .peer = src,
                               .tag = tag,
                               .mask = COMM_WHOLE_TAG,
                               .kind = RECEIVE_EXACT,
                               .file = c->file,
                               .line = c->line};
    post(v, r);
}

static void vp_irecv_matching(struct comm *c, int src, int64_t tag, int64_t mask, void *buffer,
                              int64_t capacity, struct comm_request *r)
{
    struct vp *v = (struct vp *)c;
    if (src < COMM_ANY_SOURCE || src >= v->world->nrank || tag < 0 || capacity < 0)
        vp_misuse(v, "a receive of %lld bytes, tag %lld, from rank %d: there are 0 .. %d",
                  (long long)capacity, (long long)tag, src, v->world->nrank - 1);
    /* Only matching in simulated time knows who came first. */
    if (src < 0 && !v->matching)
        vp_misuse(v, "a receive from any source in a program that has promised to do without it "
                     "(a kernel in one file declares .wildcards = 1)");
    *r = (struct comm_request){.buffer = buffer,
                               .bytes = capacity,
                               .capacity = capacity,
                               .peer = src,
                               .tag = tag,
                               .mask = mask,
                               .file = c->file,
                               .line = c->line};
    post(v, r);
}

static void finish_receive(struct vp *v, struct comm_request *r)
{
    struct message *m = r->detail;
    /* The whole barrier is one span, whatever happens inside. */
    sim_ps begin = v->clock;
    vp_path_join(v, m->net.path);
    vp_wait_until(v, m->net.arrival, m->net.uncontended);
    if (v->world->record->spans) vp_span(v, SPAN_WAIT, begin, v->clock, r->peer, m->bytes, -1);
    charge_receive(v, m);
    const int64_t kept = m->bytes < r->capacity ? m->bytes : r->capacity;
    if (kept && !m->hollow) memcpy(r->buffer, m->data, (size_t)kept);
    v->digest = digest_mix(v->digest, (uint64_t)own_id(m));
    v->digest = digest_mix(v->digest, (uint64_t)(m->net.arrival - v->world->start));
    message_give(v->world->pool, m);
    r->active = REQUEST_DONE;
    r->detail = NULL;
}

/* What holds the sender of a synchronous message is its software: it counts as sending, whatever
 * delays the data. */
static void finish_synchronous(struct vp *v, struct comm_request *r)
{
    const sim_ps time = (sim_ps)(intptr_t)r->detail, held = time > v->clock ? time - v->clock : 0;
    if (held && v->world->record->spans)
        vp_span(v, SPAN_SEND, v->clock, time, r->peer, r->bytes, -1);
    vp_stage_time(v)->send_ps += held;
    vp_path_join(v, r->path);
    vp_advance(v, v->clock + held);
    r->active = REQUEST_DONE;
    r->detail = NULL;
}

/* The states say how far a request has come when its owner waits; a wait may find it at
 * any of them. */
static void vp_wait(struct comm *c, struct comm_request *r)
{
    struct vp *v = (struct vp *)c;
    offload_called(v);
    if (r->active == REQUEST_DONE) return;
    r->file = c->file;
    r->line = c->line;
    if (r->active == REQUEST_SENDING) vp_block(v, WAITING_SEND, r);
    if (r->active == REQUEST_DELIVERED) {
        finish_synchronous(v, r);
        return;
    }
    /* The clear to send came at `time`: the sender is held until then, which counts as
     * waiting. */
    if (r->active == REQUEST_SENT) {
        sim_ps time = (sim_ps)(intptr_t)r->detail;
        vp_path_join(v, r->path);
        vp_wait_until(v, time, time);
        r->active = REQUEST_DONE;
        r->detail = NULL;
        return;
    }
    if (r->active == REQUEST_POSTED || r->active == REQUEST_COMING) vp_block(v, WAITING_RECEIVE, r);
    if (r->active != REQUEST_MATCHED) vp_misuse(v, "a wait for a request that was never started");
    finish_receive(v, r);
}

/* From the last rank's entry to the release, which is a node of its own even where the machine's
 * barrier takes no time: other ranks' entries lead to it, too. */
static void release_path(struct vp *v)
{
    struct world *w = v->world;
    const uint32_t last = path_at(w->path, w->barrier_path, w->barrier_latest);
    const uint32_t free =
        path_add(w->path, last, w->barrier_release, PATH_BARRIER, -1, v->stage, -1, 1);
    w->barrier_path = path_join(w->path, free, last, w->software.barrier, PATH_BARRIER, -1, -1);
}

/* The last rank to enter lets everybody go at the same time. The release time stays valid
 * until the next barrier is complete, for which every rank must have left this one. O(P)
 * for each barrier, and no messages: a network for barriers alone, such as the T3E's,
 * with the machine's time for it. */
static void enter_hardware_barrier(struct vp *v)
{
    struct world *w = v->world;
    if (w->path && path_keeps_losers(w->path)) v->path = vp_path_until(v, v->clock);
    if (v->clock > w->barrier_latest) {
        w->barrier_latest = v->clock;
        w->barrier_path = v->path;
    }
    if (++w->barrier_count < w->nrank) {
        vp_block(v, WAITING_BARRIER, NULL);
    } else {
        w->barrier_release = w->barrier_latest + w->software.barrier;
        if (w->path) release_path(v);
        w->barrier_count = 0;
        w->barrier_latest = 0;
        for (int i = 0; i < w->nrank; i++)
            if (&w->vp[i] != v) vp_wake(w, &w->vp[i]);
    }
}

static void hardware_barrier(struct vp *v)
{
    const struct world *w = v->world;
    if (w->share_barrier) w->share_barrier(v);
    else enter_hardware_barrier(v);
    if (w->path) path_lose(w->path, v->path, w->barrier_path, w->software.barrier);
    vp_path_join(v, w->barrier_path);
    vp_wait_until(v, w->barrier_release, w->barrier_release);
}

/* A machine without such a network runs an algorithm over its messages. */
static void vp_barrier(struct comm *c)
{
    struct vp *v = (struct vp *)c;
    /* Noise scales each piece of computing by a normal factor, never below zero; each
     * rank has a stream of its own, so that others' work does not move it. */
    sim_ps begin = v->clock;
    offload_called(v);
    if (v->world->nrank > 1) {
        if (v->world->machine->software.barrier == BARRIER_HARDWARE) hardware_barrier(v);
        else collective_barrier(c, BARRIER_TAG);
    }
    if (v->world->record->spans) vp_span(v, SPAN_BARRIER, begin, v->clock, -1, 0, -1);
}

/* `work` NULL: time that was not counted. */
static inline void compute(struct vp *v, sim_ps cost, const struct work *work)
{
    const struct world *w = v->world;
    sim_ps begin = v->clock;
    if (w->noisy) {
        double factor = 1 + w->machine->noise.compute_cv * random_normal(&v->extra->noise);
        cost = factor > 0 ? ps_rounded((double)cost * factor) : 0;
    }
    if (__builtin_expect(w->balanced != NULL, 0)) cost = vp_balance_cost(v, cost);
    vp_advance(v, v->clock + cost);
    if (w->path && work) vp_path_work(v, begin, work);
    else vp_path(v, PATH_COMPUTE, begin, -1);
    vp_stage_time(v)->compute_ps += cost;
    offload_computed(v, begin);
    if (w->record->spans) vp_span(v, SPAN_COMPUTE, begin, v->clock, -1, 0, -1);
}

/* Operations are counted by stage, and their time follows from the node's rates
 * (machine/node_cost.h). */
static void vp_work(struct comm *c, const struct work *work)
{
    struct vp *v = (struct vp *)c;
    work_add(&vp_stage_time(v)->work, work);
    compute(v, node_cost_ps(&v->world->node_cost, work), work);
}

/* Times longer than simulated time are cut, so that the clock stops at the end instead of
 * wrapping. */
static void vp_elapse(struct comm *c, int64_t ps)
{
    struct vp *v = (struct vp *)c;
    if (ps < 0) vp_misuse(v, "computing for %lld ps", (long long)ps);
    compute(v, ps < PS_TOO_LONG ? ps : PS_TOO_LONG, NULL);
}

/* Stages are numbered in the program's list; time from here on is charged to this one. */
static void vp_stage(struct comm *c, int stage)
{
    struct vp *v = (struct vp *)c;
    if (stage < 0 || stage >= v->world->nstage)
        vp_misuse(v, "stage %d: there are 0 .. %d", stage, v->world->nstage - 1);
    v->stage = stage;
    if (__builtin_expect(v->world->balanced != NULL, 0)) compute(v, vp_balance_entry(v), NULL);
}

/* A job's clock begins with it. */
static int64_t vp_now(struct comm *c)
{
    const struct vp *v = (struct vp *)c;
    return v->clock - v->world->start;
}

/* Outputs are for checking answers and take no simulated time. */
static void vp_publish(struct comm *c, int output, int64_t first, int64_t n, const double *data)
{
    const struct comm_output *o = output >= 0 && comm_wanted(c, output) ? &c->output[output] : NULL;
    if (output < 0 || (o && (first < 0 || n < 0 || first > o->n - n)))
        vp_misuse((struct vp *)c, "elements %lld .. %lld of output %d, which has %lld",
                  (long long)first, (long long)(first + n - 1), output, o ? (long long)o->n : 0LL);
    comm_publish_here(c, output, first, n, data);
    struct world *w = ((struct vp *)c)->world;
    if (w->published && o) shared_published(w, output, first, n);
}

const struct comm_type vp_comm_type = {
    .name = "vp",
    .isend = vp_isend,
    .irecv = vp_irecv,
    .wait = vp_wait,
    .barrier = vp_barrier,
    .meet = vp_meet,
    .search = vp_search,
    .work = vp_work,
    .stage = vp_stage,
    .now_ps = vp_now,
    .publish = vp_publish,
    .elapse = vp_elapse,
    .end_run = vp_fail,
    .isend_synchronous = vp_isend_synchronous,
    .irecv_matching = vp_irecv_matching,
    .complete_any = vp_complete_any,
    .probe = vp_probe,
    .receive_into = vp_receive_into,
    .cancel = vp_cancel,
    .watch = vp_watch,
    .next_complete = vp_next_complete,
};
