/* ways.c - in which way a run is executed: ranks in any order, by windows of simulated time, or one
 * thing after the other (world.h). */
#include "spec/topology_list.h"
#include "vp/windows.h"

/* What of a program keeps its ranks in the order of time, whatever the machine; NULL: nothing. */
static const char *by_program(const struct world_load *load)
{
    if (load->foreign) return "the program is not a built-in one";
    if (load->meets) return "the network does a collective of all ranks";
    return load->timed ? "receives from anybody and tests depend on time" : NULL;
}

/* What of the records. */
static const char *by_record(const struct record_spec *record)
{
    if (record->spans) return "a timeline is recorded";
    if (record->balance) return "computing follows a table of shares";
    return record->path ? "a critical path is recorded" : NULL;
}

/* In the order in which a user would change it: the program, the machine, what is recorded. The
 * conditions are those under which the ranks are a Kahn network (team.h), and what keeps its
 * records in the order of events. */
const char *world_ordered(const struct machine_spec *m, const struct world_load *load,
                          const struct record_spec *record)
{
    const char *why = by_program(load);
    if (why) return why;
    if (m->network.level != LEVEL_LOGGP || topology_has(m->topology.family, TOPOLOGY_SHARED))
        return "messages wait for each other at links (network.level loggp has none)";
    if (m->topology.nfailed_link + m->topology.nfailed_router > 0)
        return "ways around what failed are found as they are needed";
    if (m->topology.processors_per_node > 1) return "processors of a node share a port";
    if (m->software.kernel_server) return "one kernel server serves the whole machine";
    if (!software_all_eager(&m->software, load->largest_message))
        return "large messages shake hands";
    if (m->noise.background_load > 0) return "other jobs' traffic follows time";
    return by_record(record);
}

/* Whether level `link` serves the network's resources: on a bus all levels do. */
static bool by_link(const struct machine_spec *m)
{
    return m->network.level == LEVEL_LINK || topology_has(m->topology.family, TOPOLOGY_SHARED);
}

/* A node's port whose messages come in order is taken when they are handed over, before their
 * time. */
static bool private_ports(const struct machine_spec *m, const struct world_load *load)
{
    return m->topology.processors_per_node == 1 &&
           software_all_eager(&m->software, load->largest_message);
}

/* A message comes in the event of its head at the last resource, an end latency before it arrives.
 * From there it takes the receiver's overhead, and whatever that sends the sender's; hand-shakes
 * are answered at once. */
sim_ps windows_lookahead(const struct machine_spec *m, const struct world_load *load)
{
    struct software_segment list[SOFTWARE_MAX_SEGMENTS];
    const int n = software_segments(&m->software, list);
    const struct software_cost cost = software_cost_make(&m->software);
    sim_ps send = SIM_NEVER, recv = SIM_NEVER, latency = SIM_NEVER;
    for (int i = 0; i < n; i++) {
        const sim_ps own = sim_from_seconds(list[i].latency);
        if (cost.message[i].send < send) send = cost.message[i].send;
        if (cost.message[i].recv < recv) recv = cost.message[i].recv;
        if (own < latency) latency = own;
    }
    const sim_ps end = ps_later(latency, sim_from_seconds(m->network.end_latency));
    if (!software_all_eager(&m->software, load->largest_message)) return end;
    return ps_later(ps_later(ps_later(send, recv), end), windows_wire(m, load));
}

sim_ps windows_wire(const struct machine_spec *m, const struct world_load *load)
{
    return by_link(m) && private_ports(m, load) ? sim_from_seconds(m->network.hop_latency) : 0;
}

/* Whether each step of a hand-shake concerns one rank alone: no sender is held until its data have
 * arrived, and answers do not ask what a processor computes meanwhile. */
static bool answers_apart(const struct software_spec *s)
{
    struct software_segment list[SOFTWARE_MAX_SEGMENTS];
    const int n = software_segments(s, list);
    for (int i = 0; i < n; i++)
        if (list[i].protocol == PROTOCOL_SYNCHRONOUS) return false;
    return s->offload != OFFLOAD_NONE;
}

/* Beyond what keeps ranks from going on in any order: what acts between ranks beside the network,
 * and what the network does with a message at the moment when it is sent. */
static const char *by_network(const struct machine_spec *m, const struct world_load *load)
{
    const bool several = m->topology.processors_per_node > 1;
    if (!by_link(m) && m->network.level != LEVEL_LOGGP)
        return "the network itself, at this network.level, is most of the work";
    if (!software_all_eager(&m->software, load->largest_message) && !answers_apart(&m->software))
        return "large messages shake hands, and hold or wait for a processor";
    if (several && m->software.shared_bandwidth > 0) return "processors of a node share a memory";
    if (m->software.kernel_server) return "one kernel server serves the whole machine";
    if (m->noise.background_load > 0) return "other jobs' traffic follows time";
    if (m->network.routing != ROUTING_DETERMINISTIC)
        return "routes depend on what other messages do when one sets out";
    return NULL;
}

const char *windows_alone(const struct machine_spec *m, const struct world_load *load,
                          const struct record_spec *record)
{
    const char *why = by_program(load);
    if (!why) why = by_network(m, load);
    if (!why) why = by_record(record);
    if (why) return why;
    /* A window of half of it must have a length. */
    return windows_lookahead(m, load) < 2 ? "messages take no time from node to node" : NULL;
}

const char *world_alone(const struct machine_spec *m, const struct world_load *load,
                        const struct record_spec *record)
{
    return world_ordered(m, load, record) ? windows_alone(m, load, record) : NULL;
}
