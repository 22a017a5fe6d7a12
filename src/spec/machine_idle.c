/* machine_idle.c - why a setting of a machine has no effect in a run: the clause that its row of
 * the field table names. */
#include "spec/machine_idle.h"

#include <stddef.h>

#include "spec/collective_spec.h"
#include "spec/run_spec.h"

/* `why`, where the family has no such trait (topology_list.h). */
static const char *unless(const struct run_spec *r, enum topology_trait trait, const char *why)
{
    return topology_has(r->machine.topology.family, trait) ? NULL : why;
}

const char *machine_idle_with_own_nodes(const struct run_spec *r)
{
    return topology_has(r->machine.topology.family, TOPOLOGY_OWN_NODES)
               ? "topology.dims says how many nodes a router has"
               : NULL;
}

/* A crossbar and a bus have ports of nodes alone. */
const char *machine_idle_without_links(const struct run_spec *r)
{
    return topology_has(r->machine.topology.family, TOPOLOGY_NO_LINKS)
               ? "the topology has no links between routers"
               : NULL;
}

const char *machine_idle_unless_ring(const struct run_spec *r)
{
    return unless(r, TOPOLOGY_RINGS, "only a torus has two equally long ways round");
}

const char *machine_idle_unless_dragonfly(const struct run_spec *r)
{
    return unless(r, TOPOLOGY_CHOOSES, "only dragonflies and fat trees choose their routing");
}

/* The Origin, whose routers have ports to spare. */
const char *machine_idle_unless_hypercube(const struct run_spec *r)
{
    return unless(r, TOPOLOGY_CUBE, "only a hypercube has Xpress links");
}

/* HyperX, folded Clos and listed graphs count parallel cables; elsewhere two routers have one. */
const char *machine_idle_unless_bundles(const struct run_spec *r)
{
    return unless(r, TOPOLOGY_BUNDLES, "this topology has no bundles of parallel cables");
}

/* A fat tree of one arity has as many switches above each as below. */
const char *machine_idle_unless_levels(const struct run_spec *r)
{
    return unless(r, TOPOLOGY_LEVELS,
                  "only a folded Clos network says how many switches are above each");
}

/* The interval has a default, which must not look as if it acted. */
const char *machine_idle_unless_express(const struct run_spec *r)
{
    return unless(r, TOPOLOGY_EXPRESS, "only express cubes have express links");
}

/* A plain torus comes in where it left. */
const char *machine_idle_unless_twisted(const struct run_spec *r)
{
    return unless(r, TOPOLOGY_TWISTED, "only a twisted torus shifts its wrap links");
}

/* Placements and noise have seeds of their own. */
const char *machine_idle_unless_seeded(const struct run_spec *r)
{
    return unless(r, TOPOLOGY_SEEDED, "only a random network is drawn");
}

const char *machine_idle_unless_graph(const struct run_spec *r)
{
    return unless(r, TOPOLOGY_LISTED, "only family 'graph' takes its links from the file");
}

const char *machine_idle_unless_tolerance(const struct run_spec *r)
{
    return r->machine.network.level == LEVEL_AUTO_TOLERANCE
               ? NULL
               : "network.level is not 'auto-tolerance'";
}

/* Packets, flits and buffers: what only the levels that know them can use. On the others a message
 * is one unit whose flits follow at the rate of the slowest resource. */
const char *machine_idle_above_packets(const struct run_spec *r)
{
    enum network_level level = r->machine.network.level;
    if (level == LEVEL_LOGGP) return "level 'loggp' moves whole messages";
    return level == LEVEL_LINK ? "level 'link' moves whole messages" : NULL;
}

/* Long cables need the same routers as a rule does. */
const char *machine_idle_without_allocators(const struct run_spec *r)
{
    const char *why = machine_idle_above_packets(r);
    for (int d = 0; d < MACHINE_MAX_DIMS; d++)
        if (r->machine.topology.dim_latency[d] > 0) return why;
    return machine_idle_unless_routed(r);
}

/* Without a rule there is one way on, and every channel of a class is as good. */
const char *machine_idle_unless_routed(const struct run_spec *r)
{
    const char *why = machine_idle_above_packets(r);
    if (why != NULL) return why;
    return r->machine.network.routing != ROUTING_DETERMINISTIC
               ? NULL
               : "network.routing is 'deterministic'";
}

const char *machine_idle_unless_server(const struct run_spec *r)
{
    return r->machine.software.kernel_server ? NULL : "software.kernel.server is off";
}

const char *machine_idle_with_segments(const struct run_spec *r)
{
    return r->machine.software.nsegment > 0 ? "software.segments says it by size" : NULL;
}

/* Numbers that every segment gives itself: then the one for all sizes is never used. `number` is
 * the place of the number in a segment, -1 there means not given. */
static const char *idle_if_given(const struct run_spec *r, size_t number)
{
    const struct software_spec *s = &r->machine.software;
    for (int i = 0; i < s->nsegment; i++)
        if (*(const double *)(const void *)((const char *)&s->segment[i] + number) < 0) return NULL;
    return s->nsegment > 0 ? "every segment of software.segments gives its own" : NULL;
}

const char *machine_idle_send_overhead(const struct run_spec *r)
{
    return idle_if_given(r, offsetof(struct software_segment, send_overhead));
}

const char *machine_idle_send_copy(const struct run_spec *r)
{
    return idle_if_given(r, offsetof(struct software_segment, send_copy));
}

const char *machine_idle_recv_overhead(const struct run_spec *r)
{
    return idle_if_given(r, offsetof(struct software_segment, recv_overhead));
}

const char *machine_idle_recv_copy(const struct run_spec *r)
{
    return idle_if_given(r, offsetof(struct software_segment, recv_copy));
}

const char *machine_idle_gap(const struct run_spec *r)
{
    return idle_if_given(r, offsetof(struct software_segment, gap));
}

const char *machine_idle_gap_per_byte(const struct run_spec *r)
{
    return idle_if_given(r, offsetof(struct software_segment, gap_per_byte));
}

/* A handshake needs a limit, or a segment that shakes hands without saying how long. */
const char *machine_idle_unless_eager_limit(const struct run_spec *r)
{
    if (r->machine.software.nsegment > 0) {
        const struct software_segment *s = r->machine.software.segment;
        bool used = false;
        for (int i = 0; i < r->machine.software.nsegment; i++)
            used = used || (s[i].protocol != PROTOCOL_EAGER && s[i].rendezvous_latency < 0);
        return used ? NULL : "no segment of software.segments takes it";
    }
    return r->machine.software.eager_bytes >= 0
               ? NULL
               : "software.eager.limit is unlimited: no message shakes hands";
}

const char *machine_idle_unless_short(const struct run_spec *r)
{
    if (r->machine.software.nsegment > 0) return machine_idle_with_segments(r);
    return r->machine.software.short_bytes > 0 ? NULL
                                               : "software.short.limit is 0: no message is short";
}

const char *machine_idle_unless_hardware_barrier(const struct run_spec *r)
{
    return r->machine.software.barrier == BARRIER_HARDWARE
               ? NULL
               : "software.barrier.kind is not 'hardware'";
}

static const char *idle_unless_shared(const struct run_spec *r)
{
    return r->machine.software.shared_bandwidth > 0
               ? NULL
               : "software.shared.bandwidth is 0: no channel within a node";
}

const char *machine_idle_unless_several(const struct run_spec *r)
{
    return r->machine.topology.processors_per_node > 1 ? NULL : "a node has one processor";
}

const char *machine_idle_unless_shared_node(const struct run_spec *r)
{
    const char *why = machine_idle_unless_several(r);
    return why != NULL ? why : idle_unless_shared(r);
}

const char *machine_idle_unless_random(const struct run_spec *r)
{
    return r->machine.placement.kind == PLACEMENT_RANDOM ? NULL : "placement.kind is not 'random'";
}

const char *machine_idle_unless_list(const struct run_spec *r)
{
    return r->machine.placement.kind == PLACEMENT_LIST ? NULL : "placement.kind is not 'list'";
}

const char *machine_idle_at_loggp(const struct run_spec *r)
{
    return r->machine.network.level != LEVEL_LOGGP
               ? NULL
               : "network.level 'loggp' has no links that other jobs take";
}

const char *machine_idle_unless_background(const struct run_spec *r)
{
    const char *why = machine_idle_at_loggp(r);
    if (why != NULL) return why;
    return r->machine.noise.background_load > 0 ? NULL : "noise.background.load is 0";
}

/* Prices, powers and the floor plan: asked before anything runs. */
const char *machine_idle_in_runs(const struct run_spec *r)
{
    (void)r;
    return "no run depends on it; `mimdsim machines --topology` does";
}

const char *machine_idle_in_programs(const struct run_spec *r)
{
    (void)r;
    return "no program puts or gets; `mimdsim validate` does";
}

/* The finer prices of code act together, or not at all. */
const char *machine_idle_without_code(const struct run_spec *r)
{
    return r->machine.node.code.issue > 0 ? NULL : "node.code.issue is 0";
}

const char *machine_idle_without_collectives(const struct run_spec *r)
{
    return kernel_spec_has(&r->kernel, PROGRAM_COLLECTIVE)
               ? NULL
               : "this kernel calls no collective that it chooses";
}

/* Rates know operations alone: where data lie makes no difference. */
bool machine_dormant_unless_roofline(const void *machine)
{
    return ((const struct machine_spec *)machine)->node.model != NODE_ROOFLINE;
}

/* The same question of a whole run, with its answer for people. */
const char *machine_idle_unless_roofline(const struct run_spec *r)
{
    return machine_dormant_unless_roofline(&r->machine)
               ? "node.model 'rates' knows neither caches nor memories"
               : NULL;
}

/* Whether people's own programs ask for it is not known before they run: what they may name acts.
 * Of built-in ones it is known, by the name of the algorithm or by the machine's rules. */
const char *machine_idle_without_hardware(const struct run_spec *r)
{
    if (r->machine.network.collective.kinds[0] == '\0') return "network.collective.kinds is empty";
    return r->kernel.own || collective_meets(r) ? NULL
                                                : "no collective is done by 'hardware' here";
}
