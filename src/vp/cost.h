/* cost.h - how long the message software takes, by size, in picoseconds. */
#ifndef VP_COST_H
#define VP_COST_H

#include "base/picoseconds.h"
#include "machine/node_use.h"
#include "sim/sim.h"
#include "spec/software_spec.h"

/* Durations of the message software for one range of sizes [ps], from software_segments. */
struct message_cost {
    int64_t below;       /* the first size of the next range, INT64_MAX: none */
    sim_ps send, recv, rendezvous;
    double send_byte, recv_byte; /* [ps/B] */
    enum message_protocol protocol;
};

/* Durations of the message software [ps], from software_spec. */
struct software_cost {
    struct message_cost message[SOFTWARE_MAX_SEGMENTS]; /* by rising size */
    sim_ps kernel_time, barrier, shared_latency;
    double kernel_byte, shared_byte; /* [ps/B] */
};

/* byte_cost: `fixed` and `per_byte` of `bytes`, in whole picoseconds. */
static inline sim_ps byte_cost(sim_ps fixed, double per_byte, int64_t bytes)
{
    return fixed + ps_rounded(per_byte * (double)bytes);
}

/* message_cost: that of messages of `bytes`. */
static inline const struct message_cost *message_cost(const struct software_cost *s, int64_t bytes)
{
    const struct message_cost *m = s->message;
    while (bytes >= m->below) m++;
    return m;
}

/* software_cost_make: from a machine's message software. */
struct software_cost software_cost_make(const struct software_spec *s);

/* software_cost_used: that of machine `m` whose ranks use their nodes like this: where copies pass
 * a memory that ranks share (software.copy_traffic), a byte copied takes at least copy_traffic *
 * sharers / shared bandwidth, its part of the memory's time while all of them copy. What copies
 * nothing stays as it is. */
struct software_cost software_cost_used(const struct machine_spec *m, const struct node_use *u);

#endif
