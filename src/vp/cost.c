/* cost.c - seconds of the machine to picoseconds, once (cost.h). */
#include "vp/cost.h"

/* Overheads as whole picoseconds, times per byte as doubles: a byte may cost less than one. The
 * saving of short messages is at most the overhead (spec/software_spec.c): never negative. */
static struct message_cost message_cost_make(const struct software_segment *s, int64_t below)
{
    return (struct message_cost){
        .below = below,
        .send = sim_from_seconds(s->send_overhead) - sim_from_seconds(s->send_saving),
        .recv = sim_from_seconds(s->recv_overhead),
        .rendezvous = sim_from_seconds(s->rendezvous_latency),
        .send_byte = s->send_copy * SIM_PS_PER_S,
        .recv_byte = s->recv_copy * SIM_PS_PER_S + s->recv_extra * SIM_PS_PER_S,
        .protocol = s->protocol,
    };
}

struct software_cost software_cost_make(const struct software_spec *s)
{
    struct software_segment list[SOFTWARE_MAX_SEGMENTS];
    /* The processors know segments alone, as the network does. */
    const int n = software_segments(s, list);
    struct software_cost cost = {
        .kernel_time = sim_from_seconds(s->kernel_time),
        .barrier = sim_from_seconds(s->barrier_time),
        .shared_latency = sim_from_seconds(s->shared_latency),
        .kernel_byte = s->kernel_per_byte * SIM_PS_PER_S,
        .shared_byte = s->shared_bandwidth > 0 ? SIM_PS_PER_S / s->shared_bandwidth : 0,
    };
    /* A segment ends where the next begins; the last never. */
    for (int i = 0; i < n; i++)
        cost.message[i] = message_cost_make(&list[i], i + 1 < n ? list[i + 1].from : INT64_MAX);
    return cost;
}

/* The longer one of a copy alone and its part of the memory's time. */
static double shared_byte(double own, double least) { return own > 0 && own < least ? least : own; }

struct software_cost software_cost_used(const struct machine_spec *m, const struct node_use *u)
{
    struct software_cost cost = software_cost_make(&m->software);
    const struct memory_level *memory = &m->node.level[NODE_MEMORY];
    if (m->node.model != NODE_ROOFLINE || !(memory->shared > 0)) return cost;
    /* The sharers copy all at once, as in an exchange, and each byte passes several times. */
    const double least =
        m->software.copy_traffic * u->sharers[NODE_MEMORY] / memory->shared * SIM_PS_PER_S;
    for (int i = 0; i < SOFTWARE_MAX_SEGMENTS; i++) {
        cost.message[i].send_byte = shared_byte(cost.message[i].send_byte, least);
        cost.message[i].recv_byte = shared_byte(cost.message[i].recv_byte, least);
    }
    return cost;
}
