/* why_parameters.c - how much of a critical path each parameter of the machine stands for (why.h).
 *
 * Every duration on the path is linear in the times that the machine's file gives. So the
 * contribution of one of them is what the duration grows by when that time is doubled, found by the
 * functions that the simulation itself uses: no formula is written twice. The overheads of software
 * and the operations of nodes have many parameters a step and are found that way; all other causes
 * have one, which is the whole step. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "machine/node_use.h"
#include "study/why.h"
#include "vp/cost.h"
#include "vp/meeting.h"

enum parameter {
    FLOP_RATE,
    DIV,
    SQRT,
    TRIG,
    CALL,
    COPY,
    L1_BANDWIDTH,
    L2_BANDWIDTH,
    L2_SHARED,
    L3_BANDWIDTH,
    L3_SHARED,
    MEMORY_BANDWIDTH,
    MEMORY_SHARED,
    SEND_OVERHEAD,
    SEND_COPY,
    RECV_OVERHEAD,
    RECV_COPY,
    EAGER_COPY,
    SHORT_SAVING,
    SHORT_COPY,
    SHARED_LATENCY,
    SHARED_BANDWIDTH,
    KERNEL_TIME,
    KERNEL_BYTE,
    HOP,
    CABLE,
    END,
    SEGMENT_LATENCY,
    LINK,
    INJECTION,
    EJECTION,
    GAP,
    GAP_PER_BYTE,
    RENDEZVOUS,
    BARRIER,
    COLLECTIVE_LATENCY,
    COLLECTIVE_HOP,
    COLLECTIVE_BANDWIDTH,
    PARAMETERS
};

/* A number of machine_spec, and of each segment of its software where it has segments; NONE: there
 * is none. */
static const struct row {
    const char *key;
    ptrdiff_t at, segment;
    bool rate;
} table[PARAMETERS] = {
#define AT(member) offsetof(struct machine_spec, member)
#define SEGMENT(member) offsetof(struct software_segment, member)
#define NONE -1
    [FLOP_RATE] = {"machine.node.flop_rate", AT(node.flop_rate), NONE, true},
    [DIV] = {"machine.node.div", AT(node.div_cycles), NONE, false},
    [SQRT] = {"machine.node.sqrt", AT(node.sqrt_cycles), NONE, false},
    [TRIG] = {"machine.node.trig", AT(node.trig_cycles), NONE, false},
    [CALL] = {"machine.node.call", AT(node.call_time), NONE, false},
    [COPY] = {"machine.node.copy.bandwidth", AT(node.copy_bandwidth), NONE, true},
    [L1_BANDWIDTH] = {"machine.node.l1.bandwidth", AT(node.level[NODE_L1].bandwidth), NONE, true},
    [L2_BANDWIDTH] = {"machine.node.l2.bandwidth", AT(node.level[NODE_L2].bandwidth), NONE, true},
    [L2_SHARED] = {"machine.node.l2.shared", AT(node.level[NODE_L2].shared), NONE, true},
    [L3_BANDWIDTH] = {"machine.node.l3.bandwidth", AT(node.level[NODE_L3].bandwidth), NONE, true},
    [L3_SHARED] = {"machine.node.l3.shared", AT(node.level[NODE_L3].shared), NONE, true},
    [MEMORY_BANDWIDTH] = {"machine.node.memory.bandwidth", AT(node.level[NODE_MEMORY].bandwidth),
                          NONE, true},
    [MEMORY_SHARED] = {"machine.node.memory.shared", AT(node.level[NODE_MEMORY].shared), NONE,
                       true},
    [SEND_OVERHEAD] = {"machine.software.send.overhead", AT(software.send_overhead),
                       SEGMENT(send_overhead), false},
    [SEND_COPY] = {"machine.software.send.copy", AT(software.send_copy), SEGMENT(send_copy), false},
    [RECV_OVERHEAD] = {"machine.software.recv.overhead", AT(software.recv_overhead),
                       SEGMENT(recv_overhead), false},
    [RECV_COPY] = {"machine.software.recv.copy", AT(software.recv_copy), SEGMENT(recv_copy), false},
    [EAGER_COPY] = {"machine.software.eager.copy", AT(software.eager_copy), NONE, false},
    [SHORT_SAVING] = {"machine.software.short.saving", AT(software.short_saving), NONE, false},
    [SHORT_COPY] = {"machine.software.short.copy", AT(software.short_copy), NONE, false},
    [SHARED_LATENCY] = {"machine.software.shared.latency", AT(software.shared_latency), NONE,
                        false},
    [SHARED_BANDWIDTH] = {"machine.software.shared.bandwidth", AT(software.shared_bandwidth), NONE,
                          true},
    [KERNEL_TIME] = {"machine.software.kernel.time", AT(software.kernel_time), NONE, false},
    [KERNEL_BYTE] = {"machine.software.kernel.per_byte", AT(software.kernel_per_byte), NONE, false},
    [HOP] = {"machine.network.hop_latency", AT(network.hop_latency), NONE, false},
    [CABLE] = {"machine.topology.dim_latency", NONE, NONE, false}, /* of all dimensions */
    [END] = {"machine.network.end_latency", AT(network.end_latency), NONE, false},
    [SEGMENT_LATENCY] = {"machine.software.segments latency", NONE, SEGMENT(latency), false},
    [LINK] = {"machine.network.link.bandwidth", AT(network.link_bandwidth), NONE, true},
    [INJECTION] = {"machine.network.injection.bandwidth", AT(network.injection_bandwidth), NONE,
                   true},
    [EJECTION] = {"machine.network.ejection.bandwidth", AT(network.ejection_bandwidth), NONE, true},
    [GAP] = {"machine.software.gap", AT(software.gap), SEGMENT(gap), false},
    [GAP_PER_BYTE] = {"machine.software.gap_per_byte", AT(software.gap_per_byte),
                      SEGMENT(gap_per_byte), false},
    [RENDEZVOUS] = {"machine.software.rendezvous.latency", AT(software.rendezvous_latency),
                    SEGMENT(rendezvous_latency), false},
    [BARRIER] = {"machine.software.barrier.time", AT(software.barrier_time), NONE, false},
    [COLLECTIVE_LATENCY] = {"machine.network.collective.latency", AT(network.collective.latency),
                            NONE, false},
    [COLLECTIVE_HOP] = {"machine.network.collective.per_link",
                        AT(network.collective.hop_latency), NONE, false},
    [COLLECTIVE_BANDWIDTH] = {"machine.network.collective.bandwidth",
                              AT(network.collective.bandwidth), NONE, true},
#undef AT
#undef SEGMENT
#undef NONE
};

static double *number(struct machine_spec *m, const struct row *r)
{
    return r->at < 0 ? NULL : (double *)(void *)((char *)m + r->at);
}

static void scale(struct machine_spec *m, enum parameter p, double factor)
{
    const struct row *r = &table[p];
    double *x = number(m, r);
    if (x) *x = r->rate ? *x / factor : *x * factor;
    for (int d = 0; p == CABLE && d < MACHINE_MAX_DIMS; d++) m->topology.dim_latency[d] *= factor;
    if (r->segment < 0) return;
    for (int i = 0; i < m->software.nsegment; i++) {
        double *y = (double *)(void *)((char *)&m->software.segment[i] + r->segment);
        if (*y > 0) *y *= factor; /* negative: the segment has the constant above */
    }
}

bool why_scale(struct machine_spec *m, const char *key, double factor)
{
    for (int p = 0; p < PARAMETERS; p++) {
        if (strcmp(table[p].key, key) != 0) continue;
        scale(m, (enum parameter)p, factor);
        return true;
    }
    return false;
}

/* ---- contributions ---- */

/* The machine as it is and with one parameter doubled at a time. */
struct priced {
    struct node_cost node;
    struct software_cost software;
    bool engine; /* which makes the copies of message software */
};

static struct priced price(const struct machine_spec *m, const struct node_use *u)
{
    return (struct priced){node_use_cost(&m->node, u), software_cost_used(m, u),
                           m->software.offload == OFFLOAD_COPIES};
}

/* The ranks of the run on its machine: placed again, as the run has placed them. */
static struct node_use use_of(const struct machine_spec *m, const struct run_result *r)
{
    struct node_use u;
    struct err e;
    err_clear(&e);
    CHECK(node_use_make(m, r->nrank, r->working_set, &u, &e));
    return u;
}

/* What step `s` takes at these prices, for the causes that have several parameters. */
static double duration(const struct priced *q, const struct path_step *s, bool server)
{
    const struct message_cost *c = message_cost(&q->software, s->count);
    /* Copies are the processor's, or steps of their own where an engine makes them. */
    const double send = q->engine ? 0 : c->send_byte, recv = q->engine ? 0 : c->recv_byte;
    double software = 0;
    switch (s->cause) {
    case PATH_COMPUTE:
        return (double)node_cost_ps(&q->node, &s->work);
    case PATH_SERVER:
        return (double)byte_cost(q->software.kernel_time, q->software.kernel_byte, s->count);
    case PATH_MEMORY:
        return (double)byte_cost(q->software.shared_latency, q->software.shared_byte, s->count);
    case PATH_ENGINE_SEND:
        return (double)byte_cost(0, c->send_byte, s->count);
    case PATH_ENGINE_RECV:
        return (double)byte_cost(0, c->recv_byte, s->count);
    case PATH_SEND:
        software = (double)byte_cost(c->send, send, s->count);
        break;
    case PATH_RECV:
        software = (double)byte_cost(c->recv, recv, s->count);
        break;
    default:
        CHECK(false);
    }
    /* Every message end passes the kernel server, whose time may be the longer one. */
    const double service =
        (double)byte_cost(q->software.kernel_time, q->software.kernel_byte, s->count);
    return server && service > software ? service : software;
}

static bool has_several(const struct path_step *s)
{
    return s->cause == PATH_COMPUTE || s->cause == PATH_MEMORY || s->cause == PATH_SEND ||
           s->cause == PATH_RECV || s->cause == PATH_SERVER || s->cause == PATH_ENGINE_SEND ||
           s->cause == PATH_ENGINE_RECV;
}

/* The parameter of a cause that has one; PARAMETERS: none. Ports without a bandwidth of their own
 * have the link's, and an injection port is as slow as the software's G where that is slower. */
static enum parameter only(const struct machine_spec *m, enum path_cause cause)
{
    const struct network_spec *w = &m->network;
    const double injection =
        w->injection_bandwidth > 0 ? w->injection_bandwidth : w->link_bandwidth;
    switch (cause) {
    case PATH_GAP:
        return GAP;
    case PATH_HOP:
        return HOP;
    case PATH_CABLE:
        return CABLE;
    case PATH_END:
        return END;
    case PATH_LINK_BYTES:
        return LINK;
    case PATH_INJECTION_BYTES:
        if (m->software.nsegment > 0 || injection <= 0 || m->software.gap_per_byte > 1 / injection)
            return GAP_PER_BYTE;
        return w->injection_bandwidth > 0 ? INJECTION : LINK;
    case PATH_EJECTION_BYTES:
        return w->ejection_bandwidth > 0 ? EJECTION : LINK;
    case PATH_RENDEZVOUS:
        return RENDEZVOUS;
    case PATH_BARRIER:
        return BARRIER;
    default:
        return PARAMETERS;
    }
}

/* A collective of the network has three: a constant, the bytes, and the links with all the rest. */
static void add_collective(const struct machine_spec *m, const struct path_step *s, double *time)
{
    /* A network without the constant gives the time of the bytes alone.
     * They may be those of a link, where the collective has no rate of its own: that is what the
     * parameter link.bandwidth then stands for. */
    struct network_spec bytes = m->network;
    bytes.collective.latency = 0;
    const double vector = (double)meeting_time(&bytes, 0, s->count),
                 constant = (double)meeting_time(&m->network, 0, 0);
    time[COLLECTIVE_LATENCY] += constant;
    time[m->network.collective.bandwidth > 0 ? COLLECTIVE_BANDWIDTH : LINK] += vector;
    time[COLLECTIVE_HOP] += (double)(s->end_ps - s->begin_ps) - constant - vector;
}

/* Add the steps that are one parameter's alone; of the end latency a part may be the segment's. */
static void add_whole(const struct machine_spec *m, const struct path_step *s, double *time)
{
    if (s->cause == PATH_COLLECTIVE) {
        add_collective(m, s, time);
        return;
    }
    const enum parameter p = only(m, s->cause);
    double whole = (double)(s->end_ps - s->begin_ps);
    if (p == PARAMETERS) return;
    if (p == END) {
        const double end = round(m->network.end_latency * SIM_PS_PER_S);
        time[SEGMENT_LATENCY] += whole - end;
        whole = end;
    }
    time[p] += whole;
}

static int longer_first(const void *a, const void *b)
{
    const struct why_parameter *x = a, *y = b;
    if (x->time_ps != y->time_ps) return llabs(x->time_ps) < llabs(y->time_ps) ? 1 : -1;
    return strcmp(x->key, y->key);
}

void why_contributions(const struct machine_spec *m, struct why *out)
{
    double time[PARAMETERS] = {0};
    const struct node_use use = use_of(m, &out->run);
    struct priced plain = price(m, &use), doubled[KERNEL_BYTE + 1];
    /* Those behind KERNEL_BYTE are the only parameter of their causes: add_whole needs no
     * prices. */
    for (int p = 0; p <= KERNEL_BYTE; p++) {
        struct machine_spec changed = *m;
        scale(&changed, (enum parameter)p, 2);
        doubled[p] = price(&changed, &use);
    }
    /* One pass over the path: millions of steps are possible, parameters are few. */
    const bool server = m->software.kernel_server;
    for (int64_t i = 0; i < out->run.npath; i++) {
        const struct path_step *s = &out->run.path[i];
        if (!has_several(s)) {
            add_whole(m, s, time);
            continue;
        }
        const double now = duration(&plain, s, server);
        for (int p = 0; p <= KERNEL_BYTE; p++) time[p] += duration(&doubled[p], s, server) - now;
    }
    out->nparameter = 0;
    for (int p = 0; p < PARAMETERS; p++) {
        if (fabs(time[p]) < 0.5) continue;
        struct machine_spec own = *m;
        const double *x = number(&own, &table[p]);
        const double value = x && (table[p].segment < 0 || m->software.nsegment == 0) ? *x : 0;
        /* Operations that are priced in cycles are counted in cycles, too. */
        const bool cycles = p == DIV || p == SQRT || p == TRIG;
        const double seconds = time[p] / SIM_PS_PER_S * (cycles ? m->node.clock : 1);
        out->parameter[out->nparameter++] = (struct why_parameter){
            .key = table[p].key,
            .rate = table[p].rate,
            .value = value,
            .time_ps = (int64_t)llround(time[p]),
            .count = value > 0 ? (table[p].rate ? seconds * value : seconds / value) : 0};
    }
    qsort(out->parameter, (size_t)out->nparameter, sizeof out->parameter[0], longer_first);
}

int64_t why_contribution(const struct run_spec *spec, const struct run_result *r, const char *key)
{
    struct why w = {.run = *r};
    why_contributions(&spec->machine, &w);
    for (int i = 0; i < w.nparameter; i++)
        if (strcmp(w.parameter[i].key, key) == 0) return w.parameter[i].time_ps;
    return 0;
}
