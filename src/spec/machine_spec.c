/* machine_spec.c - the settings of a machine, and how many processors it has.
 *
 * Zero means "no cost" or "as the other one" in many rows; the row says which. Bounds are wide:
 * they refuse mistyped units (a latency of 3 s), not unusual machines. */
#include "spec/machine_spec.h"

#include <math.h>
#include <string.h>

#include "base/size.h"
#include "comm/collective_rules.h"
#include "spec/collective_spec.h"
#include "spec/machine_idle.h"
#include "spec/spec_fields.h"

#define AT(member) .offset = offsetof(struct machine_spec, member)
#define COUNT(member) .count = offsetof(struct machine_spec, member)

/* Words of enums, in the order of their values; topologies and levels have lists of their own, from
 * which this table and every other one is made. */
static const char *const families[] = {
#define X(constant, word, stem, ndim, routers, traits) [constant] = word,
    TOPOLOGY_LIST(X)
#undef X
    NULL};
static const char *const ties[] = {"positive", "parity", "random", NULL};
static const char *const routings[] = {"minimal", "valiant", NULL};
static const char *const levels[] = {
#define X(constant, word, stem, cost, fineness) [constant] = word,
    LEVEL_LIST(X)
#undef X
    [LEVEL_AUTO_TOLERANCE] = "auto-tolerance", NULL};
static const char *const arbitrations[] = {"round-robin", "first-come", NULL};
static const char *const rules[] = {
#define X(constant, word, chance, doc) [constant] = word,
    ROUTING_LIST(X)
#undef X
    NULL};
static const char *const allocators[] = {"select", "islip", NULL};
static const char *const operations[] = {"logical", "integer", "real", NULL};
static const char *const barriers[] = {"software", "hardware", NULL};
static const char *const placements[] = {"linear", "snake",  "gray", "random",
                                         "list",   "groups", NULL};
static const char *const spreads[] = {"block", "cyclic", NULL};

static const char *const offloads[] = {"handshakes", "none", "copies", NULL};
static const char *const node_models[] = {"rates", "roofline", NULL};

/* Numbers of one cache or of the memory. They act, and are part of an identity, with node.model
 * 'roofline' alone: machine files state them, and runs by rates stay what they were. */
#define LEVEL(name, member)                                                                        \
    AT(node.level[name].member), .idle = machine_idle_unless_roofline,                             \
        .dormant = machine_dormant_unless_roofline
#define LEVEL_RATE(name, member)                                                                   \
    .kind = FIELD_REAL, .unit = UNIT_BANDWIDTH, LEVEL(name, member), .min = 0, .max = 1e15,        \
    .fallback = "unlimited", .zero = "unlimited"
#define LEVEL_SIZE(name)                                                                           \
    .kind = FIELD_INT64, .unit = UNIT_BYTES, LEVEL(name, bytes), .min = 0, .max = 1e12,            \
    .fallback = "0 B"
#define LEVEL_COUNT(name) .kind = FIELD_INT, LEVEL(name, processors), .max = 1 << 20

/* A price of compiled code; 0 is none. Finer ones act with node.code.issue alone. */
#define CODE_PRICE(name)                                                                           \
    .key = "node.code." #name, .kind = FIELD_REAL, .unit = UNIT_CYCLES, AT(node.code.name),        \
    .min = 0, .max = 1e6, .fallback = "0 cycles"
#define FINER(name, text) {CODE_PRICE(name), .idle = machine_idle_without_code, .doc = text}

/* A price or a power, 0 where the file states none. */
#define PRICE(member)                                                                              \
    .kind = FIELD_REAL, AT(price.member), .min = 0, .max = 1e12, .fallback = "0",            \
    .label = true, .idle = machine_idle_in_runs

/* A setting of the network's own collectives. */
#define HARDWARE(member)                                                                           \
    AT(network.collective.member), .min = 0, .idle = machine_idle_without_hardware

static const struct field fields[] = {
    {.key = "name", .kind = FIELD_TEXT, AT(name), .capacity = 64, .fallback = "",
     .doc = "the name of its file"},
    {.key = "label", .kind = FIELD_TEXT, AT(label), .capacity = 96, .fallback = "", .label = true,
     .doc = "what it is called in tables and figures (in its file also `name`); default: the name "
            "of its file"},
    {.key = "title", .kind = FIELD_TEXT, AT(title), .capacity = 128, .fallback = "", .label = true,
     .doc = "one line of description"},

    /* Where routers are and how they are connected (docs/network.md 2). */
    {.key = "topology.family", .kind = FIELD_CHOICE, AT(topology.family), .choice = families,
     .doc = "how routers are connected"},
    {.key = "topology.dims", .kind = FIELD_INTS, AT(topology.dims), COUNT(topology.ndim),
     .capacity = MACHINE_MAX_DIMS, .min = 1, .max = 1 << 24,
     .doc = "torus, mesh: radix of each dimension, fastest first; hypercube: [log2 routers]; "
            "fat-tree: [arity, levels]; dragonfly: [terminals per router, routers per group, "
            "global links per router, groups]; hyperx: routers in each dimension; slim-fly: [q]; "
            "dragonfly-plus: [nodes per leaf, leaves per group, spines per group, global links per "
            "spine, groups]; folded-clos: [nodes per leaf, leaves below each switch of level 2, "
            "...]; express-mesh, express-torus, twisted-torus: as torus; random-regular: [routers, "
            "degree]; others: [routers]"},
    {.key = "topology.dim_bandwidth", .kind = FIELD_REALS, .unit = UNIT_BANDWIDTH,
     AT(topology.dim_bandwidth),
     .capacity = MACHINE_MAX_DIMS, .at_least = 1, .min = 0, .max = 1e15, .fallback = "0 B/s",
     .idle = machine_idle_without_links,
     .doc = "link rate of each dimension (fat-tree: between switch levels, from the lowest; "
            "dragonfly: local, global; hypercube: cube, Xpress), 0: network.link.bandwidth"},
    {.key = "topology.dim_latency", .kind = FIELD_REALS, .unit = UNIT_TIME,
     AT(topology.dim_latency),
     .capacity = MACHINE_MAX_DIMS, .at_least = 1, .min = 0, .max = 1, .fallback = "0 s",
     .idle = machine_idle_without_links,
     .doc = "what each dimension's links take longer than network.hop_latency, for long cables; "
            "dimensions as for topology.dim_bandwidth"},
    {.key = "topology.nodes_per_router", .kind = FIELD_INT, AT(topology.nodes_per_router), .min = 1,
     .max = 4096,
     .fallback = "1", .idle = machine_idle_with_own_nodes, .doc = "nodes on each router"},
    {.key = "topology.processors_per_node", .kind = FIELD_INT, AT(topology.processors_per_node),
     .min = 1,
     .max = 4096, .fallback = "1", .doc = "processors that share a node's port to the network"},
    {.key = "topology.tie", .kind = FIELD_CHOICE, AT(topology.tie), .choice = ties,
     .fallback = "positive",
     .idle = machine_idle_unless_ring,
     .doc = "direction at half the ring: always up, or up only from even coordinates"},
    {.key = "topology.routing", .kind = FIELD_CHOICE, AT(topology.routing), .choice = routings,
     .fallback = "minimal", .idle = machine_idle_unless_dragonfly,
     .doc = "valiant: dragonfly through a random group, fat tree up through random ports"},
    {.key = "topology.xpress", .kind = FIELD_BOOL, AT(topology.xpress), .fallback = "false",
     .idle = machine_idle_unless_hypercube,
     .doc = "additional links on spare ports (Origin2000): one parallel to each link, from 3 "
            "dimensions on one to the opposite router"},
    /* What single families need beside dims: lists have one number for each dimension, level or
     * link, and are empty where the family has no use for them. */
    {.key = "topology.bundle", .kind = FIELD_INT_LIST, AT(topology.bundle),
     COUNT(topology.nbundle),
     .min = 1, .max = 4096, .fallback = "[]", .idle = machine_idle_unless_bundles,
     .doc = "parallel cables between two routers (hyperx: for each dimension; folded-clos: from "
            "each level upwards; graph: for each of topology.links); default: one"},
    {.key = "topology.up", .kind = FIELD_INT_LIST, AT(topology.up), COUNT(topology.nup),
     .min = 1, .max = 1 << 20, .fallback = "[]", .idle = machine_idle_unless_levels,
     .doc = "folded-clos: how many switches of the next level each switch is joined to, for each "
            "level but the last"},
    {.key = "topology.express", .kind = FIELD_INT, AT(topology.express), .min = 2, .max = 1 << 20,
     .fallback = "4", .idle = machine_idle_unless_express,
     .doc = "express-mesh, express-torus: every how many routers of a line express links begin "
            "and end"},
    {.key = "topology.twist", .kind = FIELD_INT_LIST, AT(topology.twist), COUNT(topology.ntwist),
     .min = 0, .max = 1 << 24, .fallback = "[]", .idle = machine_idle_unless_twisted,
     .doc = "twisted-torus: how many places the wrap links of dimension 1, 2, ... are shifted in "
            "dimension 0"},
    {.key = "topology.seed", .kind = FIELD_SEED, AT(topology.seed), .fallback = "1",
     .idle = machine_idle_unless_seeded, .doc = "random-regular: draws another graph"},
    /* Family graph: the file lists every cable. */
    {.key = "topology.links", .kind = FIELD_PAIR_LIST, AT(topology.link), COUNT(topology.nlink),
     .min = 0, .max = 1 << 24, .fallback = "[]", .idle = machine_idle_unless_graph,
     .doc = "graph: router pairs, each "
                                                                         "connected in both "
                                                                         "directions"},
    {.key = "topology.link_percent", .kind = FIELD_INT_LIST,
     AT(topology.link_percent), COUNT(topology.nlink_percent),
     .min = 1, .max = 1000000, .fallback = "[]", .idle = machine_idle_unless_graph,
     .doc = "graph: rate of each link in % of network.link.bandwidth; twice as many entries: there "
            "and back of each"},
    /* Weights choose the route; they say nothing of rates or latencies. */
    {.key = "topology.link_weight", .kind = FIELD_INT_LIST,
     AT(topology.link_weight), COUNT(topology.nlink_weight),
     .min = 1, .max = 1000000, .fallback = "[]", .idle = machine_idle_unless_graph,
     .doc = "graph: what each link counts in the choice of the shortest route; default: 1"},

    /* What computing costs: counts by class times these (machine/node_cost.c). Rates are those
     * measured with small dense code, far below a processor's peak. */
    {.key = "node.flop_rate", .kind = FIELD_REAL, .unit = UNIT_FLOP_RATE, AT(node.flop_rate),
     .min = 1, .max = 1e18,
     .doc = "rate of additions and multiplications in small dense double-precision code"},
    {.key = "node.serial_rate", .kind = FIELD_REAL, .unit = UNIT_FLOP_RATE, AT(node.serial_rate),
     .min = 0, .max = 1e18, .fallback = "0 flop/s",
     .doc = "the same for the serial codes, the baselines of the speedup; 0: node.flop_rate"},
    {.key = "node.clock", .kind = FIELD_REAL, .unit = UNIT_FREQUENCY, AT(node.clock), .min = 1,
     .max = 1e13, .doc = "processor clock, for the cycle counts below"},
    {.key = "node.div", .kind = FIELD_REAL, .unit = UNIT_CYCLES, AT(node.div_cycles), .min = 0,
     .max = 1e6, .fallback = "0 cycles", .doc = "time of one division"},
    {.key = "node.sqrt", .kind = FIELD_REAL, .unit = UNIT_CYCLES, AT(node.sqrt_cycles), .min = 0,
     .max = 1e6, .fallback = "0 cycles", .doc = "time of one square root"},
    {.key = "node.trig", .kind = FIELD_REAL, .unit = UNIT_CYCLES, AT(node.trig_cycles), .min = 0,
     .max = 1e6, .fallback = "0 cycles", .doc = "time of one sine or cosine"},
    {.key = "node.instruction", .kind = FIELD_REAL, .unit = UNIT_CYCLES,
     AT(node.instruction_cycles), .min = 0, .max = 1e6, .fallback = "0 cycles",
     .doc = "time of one instruction of programs made by mimdsim cc; 0: one cycle, or less where "
            "node.flop_rate tells that several are issued at once"},
    /* Where the first is given, all hold for blocks of compiled code in the place of
     * node.instruction and node.flop_rate (machine/node_cost.h). Only calibrate gives them. */
    {CODE_PRICE(issue),
     .doc = "programs made by mimdsim cc, finer: one instruction that waits for nothing, however "
            "wide; 0: node.instruction and node.flop_rate hold"},
    FINER(div, "a division where none waits for the one before; 0: node.div"),
    FINER(root, "a square root; 0: node.sqrt"),
    FINER(chain, "a floating-point addition that waits for the one before it through a loop"),
    FINER(step, "a nominal cycle of the other instructions of such a chain (docs/compiler.md)"),
    FINER(load, "a load of a floating-point number or a vector; with it blocks of a loop overlap"),
    FINER(whole, "an instruction that computes with whole numbers or addresses"),
    FINER(add, "a floating-point addition, comparison or conversion where none waits for another"),
    FINER(multiply, "a floating-point product, likewise"),
    FINER(fetch, "a piece of a loop's code that has to be fetched (docs/compiler.md)"),
    FINER(add_latency, "a chain's addition that waits for something else; 0: node.code.chain"),
    FINER(multiply_latency, "a floating-point product in a chain; 0: four of node.code.step"),
    {.key = "node.code.window", .kind = FIELD_REAL, AT(node.code.window), .min = 0, .max = 1e9,
     .fallback = "0", .idle = machine_idle_without_code,
     .doc = "floating-point instructions that can wait for earlier results at a time; 0: no limit"},
    {.key = "node.call", .kind = FIELD_REAL, .unit = UNIT_TIME, AT(node.call_time), .min = 0,
     .max = 1, .fallback = "0 s", .doc = "overhead of one call of a small operator"},
    {.key = "node.copy.bandwidth", .kind = FIELD_REAL, .unit = UNIT_BANDWIDTH,
     AT(node.copy_bandwidth), .min = 0, .max = 1e15, .fallback = "unlimited", .zero = "unlimited",
     .doc = "rate of memory copies by the program (packing)"},

    /* Caches and memory (docs/nodes.md), the nearest first. */
    {.key = "node.model", .kind = FIELD_CHOICE, AT(node.model), .choice = node_models,
     .fallback = "rates",
     .doc = "what computing costs: rates: each operation at its price; roofline: the longer one of "
            "operations and bytes moved, by the level where the working set lies (docs/nodes.md)"},
    {.key = "node.l1.size", LEVEL_SIZE(NODE_L1),
     .doc = "capacity of the first cache of a processor, 0 B: none"},
    {.key = "node.l1.bandwidth", LEVEL_RATE(NODE_L1, bandwidth),
     .doc = "bytes that a processor loads from and stores to its first cache"},
    /* The second and third cache may belong to several processors: a bandwidth of one alone, one
     * of all together. */
    {.key = "node.l2.size", LEVEL_SIZE(NODE_L2), .doc = "capacity of the second cache, 0 B: none"},
    {.key = "node.l2.bandwidth", LEVEL_RATE(NODE_L2, bandwidth),
     .doc = "bytes between the second cache and one processor"},
    {.key = "node.l2.shared", LEVEL_RATE(NODE_L2, shared),
     .doc = "bytes between one second cache and all its processors together"},
    {.key = "node.l2.processors", LEVEL_COUNT(NODE_L2), .min = 1, .fallback = "1",
     .doc = "processors that share one second cache, and its capacity"},
    {.key = "node.l3.size", LEVEL_SIZE(NODE_L3), .doc = "capacity of the third cache, 0 B: none"},
    {.key = "node.l3.bandwidth", LEVEL_RATE(NODE_L3, bandwidth),
     .doc = "bytes between the third cache and one processor"},
    {.key = "node.l3.shared", LEVEL_RATE(NODE_L3, shared),
     .doc = "bytes between one third cache and all its processors together"},
    {.key = "node.l3.processors", LEVEL_COUNT(NODE_L3), .min = 1, .fallback = "1",
     .doc = "processors that share one third cache, and its capacity"},
    /* The memory has no capacity: what does not fit cannot be run anyway. */
    {.key = "node.memory.bandwidth", LEVEL_RATE(NODE_MEMORY, bandwidth),
     .doc = "bytes between the memory and one processor that has it alone: STREAM on one"},
    {.key = "node.memory.shared", LEVEL_RATE(NODE_MEMORY, shared),
     .doc = "bytes between one memory and all its processors together: STREAM on all"},
    {.key = "node.memory.processors", LEVEL_COUNT(NODE_MEMORY), .min = 0, .fallback = "0",
     .doc = "processors that share one memory, counted through the nodes; 0: those of a node"},

    /* The wire (docs/network.md 1). Zero load: T = R hop_latency + (S - 1) flits + end_latency. */
    {.key = "network.level", .kind = FIELD_CHOICE, AT(network.level), .choice = levels,
     .fallback = "link",
     .doc = "detail of the network model; 'auto-tolerance 2%': the cheapest level within 2%"},
    {.key = "network.tolerance", .kind = FIELD_REAL, .unit = UNIT_PERCENT, AT(network.tolerance),
     .min = 0, .max = 1,
     .fallback = "2 %", .idle = machine_idle_unless_tolerance,
     .doc = "level 'auto-tolerance': permitted relative error of the makespan"},
    /* What does not work. The keys are the network's, the numbers go with the topology. */
    {.key = "network.failed.links", .kind = FIELD_PAIR_LIST, AT(topology.failed_link),
     COUNT(topology.nfailed_link), .min = 0, .max = 1 << 30, .fallback = "[]",
     .idle = machine_idle_without_links,
     .doc = "cables that do not work, as pairs of routers; of a bundle one for each time that the "
            "pair is named"},
    /* With a router all its links fail, and its nodes take no part. */
    {.key = "network.failed.routers", .kind = FIELD_INT_LIST, AT(topology.failed_router),
     COUNT(topology.nfailed_router), .min = 0, .max = 1 << 30, .fallback = "[]",
     .idle = machine_idle_without_links,
     .doc = "routers that do not work; no rank is placed on their nodes"},
    {.key = "network.link.bandwidth", .kind = FIELD_REAL, .unit = UNIT_BANDWIDTH,
     AT(network.link_bandwidth),
     .min = 0, .max = 1e15,
     .zero = "unlimited",
     .doc = "payload rate of one link and direction; unlimited at loggp and link only"},
    {.key = "network.injection.bandwidth", .kind = FIELD_REAL, .unit = UNIT_BANDWIDTH,
     AT(network.injection_bandwidth), .min = 0, .max = 1e15, .fallback = "0 B/s",
     .instead = "as a link",
     .doc = "rate from node into network, 0: that of a link"},
    {.key = "network.ejection.bandwidth", .kind = FIELD_REAL, .unit = UNIT_BANDWIDTH,
     AT(network.ejection_bandwidth),
     .min = 0, .max = 1e15, .fallback = "0 B/s", .instead = "as a link",
     .doc = "rate from network into node, 0: that of a link"},
    {.key = "network.hop_latency", .kind = FIELD_REAL, .unit = UNIT_TIME, AT(network.hop_latency),
     .min = 0, .max = 1, .fallback = "0 s",
     .doc = "time of the head of a message per router: router and wire"},
    {.key = "network.end_latency", .kind = FIELD_REAL, .unit = UNIT_TIME, AT(network.end_latency),
     .min = 0,
     .max = 1, .fallback = "0 s", .doc = "time in the network interfaces, entry and exit together"},
    {.key = "network.credit_latency", .kind = FIELD_REAL, .unit = UNIT_TIME,
     AT(network.credit_latency), .min = 0,
     .max = 1, .fallback = "0 s", .idle = machine_idle_above_packets,
     .doc = "time until a freed buffer is known upstream"},
    {.key = "network.routing_latency", .kind = FIELD_REAL, .unit = UNIT_TIME,
     AT(network.routing_latency), .min = 0,
     .max = 1, .fallback = "0 s", .idle = machine_idle_above_packets,
     .doc = "part of hop_latency: route of a head at the front of its buffer"},
    {.key = "network.vc_allocation_latency", .kind = FIELD_REAL, .unit = UNIT_TIME,
     AT(network.vc_allocation_latency),
     .min = 0, .max = 1, .fallback = "0 s", .idle = machine_idle_above_packets,
     .doc = "part of hop_latency: a free virtual channel for a head"},
    /* Sizes on the wire: a packet is header and payload in whole flits. */
    {.key = "network.flit", .kind = FIELD_INT64, .unit = UNIT_BYTES, AT(network.flit_bytes),
     .min = 1, .max = 1 << 20,
     .fallback = "8 B", .doc = "unit of flow control; sizes on the wire are whole flits"},
    {.key = "network.packet", .kind = FIELD_INT64, .unit = UNIT_BYTES, AT(network.packet_bytes),
     .min = 0, .max = 1 << 30, .fallback = "0 B",
     .doc = "largest payload of a packet, 0 B: a message is one packet"},
    {.key = "network.header", .kind = FIELD_INT64, .unit = UNIT_BYTES, AT(network.header_bytes),
     .min = 0,
     .max = 1 << 20, .fallback = "0 B", .doc = "header added to each packet on the wire"},
    /* Buffers and arbitration of routers: levels packet, flit and auto. */
    {.key = "network.virtual_channels", .kind = FIELD_INT, AT(network.virtual_channels), .min = 1,
     .max = 64,
     .fallback = "1", .idle = machine_idle_above_packets,
     .doc = "virtual channels per link and direction, all "
                                                         "classes together"},
    {.key = "network.buffer", .kind = FIELD_INT, AT(network.buffer_flits), .min = 1, .max = 1 << 24,
     .fallback = "16",
     .idle = machine_idle_above_packets, .doc = "flits that a virtual channel can hold"},
    {.key = "network.arbitration", .kind = FIELD_CHOICE, AT(network.arbitration),
     .choice = arbitrations,
     .fallback = "round-robin", .idle = machine_idle_above_packets,
     .doc = "arbitration between messages that wait "
                                                                   "for the same link"},
    {.key = "network.routing", .kind = FIELD_CHOICE, AT(network.routing), .choice = rules,
     .fallback = "deterministic", .idle = machine_idle_without_links,
     .doc = "which of several routes a packet takes (docs/network.md)"},
    {.key = "network.vc_allocator", .kind = FIELD_CHOICE, AT(network.vc_allocator),
     .choice = allocators, .fallback = "select", .idle = machine_idle_unless_routed,
     .doc = "how heads get virtual channels: by a routing rule's priorities, or without them"},
    {.key = "network.allocator_iterations", .kind = FIELD_INT, AT(network.allocator_iterations),
     .min = 1, .max = 16, .fallback = "3", .idle = machine_idle_without_allocators,
     .doc = "rounds of offers in which channels and the switch of a router are given"},
    /* What the network does by itself: the algorithm "hardware" (docs/collectives.md). */
    {.key = "network.collective.kinds", .kind = FIELD_TEXT, HARDWARE(kinds), .capacity = 64,
     .fallback = "", .valid = collective_kinds_valid,
     .doc = "collectives that the network does by itself, for the algorithm 'hardware': some of "
            "broadcast, reduce, allreduce; barriers: software.barrier.kind"},
    {.key = "network.collective.operations", .kind = FIELD_CHOICE, HARDWARE(operations),
     .choice = operations, .fallback = "real",
     .doc = "what it combines: bits and truths; also whole numbers; also floating-point numbers"},
    {.key = "network.collective.largest", .kind = FIELD_INT64, .unit = UNIT_BYTES,
     HARDWARE(largest), .max = 1e15, .fallback = "0 B", .doc = "longest vector, 0 B: any"},
    {.key = "network.collective.radix", .kind = FIELD_INT, HARDWARE(radix), .max = 1 << 20,
     .fallback = "0", .doc = "children of each switch in a tree of its own; 0: over the links"},
    {.key = "network.collective.latency", .kind = FIELD_REAL, .unit = UNIT_TIME, HARDWARE(latency),
     .max = 10, .fallback = "0 s", .doc = "beside links and bytes, from the last rank's entry"},
    {.key = "network.collective.per_link", .kind = FIELD_REAL, .unit = UNIT_TIME,
     HARDWARE(hop_latency), .max = 1, .fallback = "0 s", .doc = "each link of the tree, each way"},
    {.key = "network.collective.bandwidth", .kind = FIELD_REAL, .unit = UNIT_BANDWIDTH,
     HARDWARE(bandwidth), .max = 1e15, .fallback = "0 B/s", .instead = "as a link",
     .doc = "rate of the vector through the tree, 0: that of a link"},

    /* What processors and interfaces do for a message: LogGP's o, g and G (Alexandrov et al. 1995),
     * with sizes that change the protocol. */
    {.key = "software.send.overhead", .kind = FIELD_REAL, .unit = UNIT_TIME,
     AT(software.send_overhead), .min = 0,
     .max = 10, .fallback = "0 s", .idle = machine_idle_send_overhead,
     .doc = "processor time to send a message (LogGP's o)"},
    {.key = "software.send.copy", .kind = FIELD_REAL, .unit = UNIT_TIME_PER_BYTE,
     AT(software.send_copy), .min = 0,
     .max = 1, .fallback = "0 s/B", .idle = machine_idle_send_copy,
     .doc = "processor time per byte sent"},
    {.key = "software.recv.overhead", .kind = FIELD_REAL, .unit = UNIT_TIME,
     AT(software.recv_overhead), .min = 0,
     .max = 10, .fallback = "0 s", .idle = machine_idle_recv_overhead,
     .doc = "processor time to receive a message"},
    {.key = "software.recv.copy", .kind = FIELD_REAL, .unit = UNIT_TIME_PER_BYTE,
     AT(software.recv_copy), .min = 0,
     .max = 1, .fallback = "0 s/B", .idle = machine_idle_recv_copy,
     .doc = "processor time per byte received"},
    {.key = "software.copy_traffic", .kind = FIELD_REAL, .unit = UNIT_NONE,
     AT(software.copy_traffic), .idle = machine_idle_unless_roofline,
     .dormant = machine_dormant_unless_roofline, .min = 0, .max = 16, .fallback = "0",
     .doc = "bytes that each byte copied by message software moves through the memory: when ranks "
            "share one (node.memory.shared), copies take at least their part of its time"},
    {.key = "software.gap", .kind = FIELD_REAL, .unit = UNIT_TIME, AT(software.gap), .min = 0,
     .max = 10,
     .fallback = "0 s", .idle = machine_idle_gap,
     .doc = "least time between two messages of one node (LogGP's g)"},
    {.key = "software.gap_per_byte", .kind = FIELD_REAL, .unit = UNIT_TIME_PER_BYTE,
     AT(software.gap_per_byte),
     .min = 0, .max = 1, .fallback = "0 s/B",
     .idle = machine_idle_gap_per_byte,
     .doc = "time per byte of interface and protocol (LogGP's G); the slower of "
                                       "this and the wire counts"},
    /* The classic protocol: short, eager and rendezvous messages by two limits. */
    {.key = "software.short.limit", .kind = FIELD_INT64, .unit = UNIT_BYTES,
     AT(software.short_bytes), .min = 0,
     .max = 1 << 30, .fallback = "0 B", .idle = machine_idle_with_segments,
     .doc = "messages up to this size are short"},
    {.key = "software.short.saving", .kind = FIELD_REAL, .unit = UNIT_TIME,
     AT(software.short_saving), .min = 0,
     .max = 1, .fallback = "0 s", .idle = machine_idle_unless_short,
     .doc = "send overhead that a short message does not have"},
    {.key = "software.short.copy", .kind = FIELD_REAL, .unit = UNIT_TIME_PER_BYTE,
     AT(software.short_copy), .min = 0,
     .max = 1, .fallback = "0 s/B", .idle = machine_idle_unless_short,
     .doc = "receiver's time per byte of a short message, in addition to software.recv.copy"},
    {.key = "software.eager.limit", .kind = FIELD_INT64, .unit = UNIT_BYTES,
     AT(software.eager_bytes), .min = -1,
     .max = 1e15, .fallback = "unlimited", .idle = machine_idle_with_segments,
     .doc = "longer messages use the rendezvous protocol (handshake first)"},
    {.key = "software.eager.copy", .kind = FIELD_REAL, .unit = UNIT_TIME_PER_BYTE,
     AT(software.eager_copy), .min = 0, .max = 1, .fallback = "0 s/B",
     .idle = machine_idle_with_segments,
     .doc = "receiver's time per byte of an eager message that is not short, added to "
            "software.recv.copy"},
    {.key = "software.rendezvous.latency", .kind = FIELD_REAL, .unit = UNIT_TIME,
     AT(software.rendezvous_latency),
     .min = 0, .max = 10, .fallback = "0 s", .idle = machine_idle_unless_eager_limit,
     .doc = "software time added by the handshake"},
    {.key = "software.segments", .kind = FIELD_SEGMENTS,
     AT(software.segment), COUNT(software.nsegment),
     .capacity = SOFTWARE_MAX_SEGMENTS, .fallback = "[]",
     .doc = "message software by size, in place of short and eager: each segment {from: 8 KiB, "
            "...} may give send.overhead, send.copy, recv.overhead, recv.copy, latency, gap, "
            "gap_per_byte, protocol (eager, rendezvous, synchronous) and rendezvous.latency; what "
            "it does not give is software's"},
    /* Who answers while a processor computes, and who copies. */
    {.key = "software.offload", .kind = FIELD_CHOICE, AT(software.offload), .choice = offloads,
     .fallback = "handshakes",
     .doc = "what a network engine does beside the processor: handshakes of large messages; none, "
            "so that these wait while a processor computes; copies, beside the handshakes "
            "(docs/nodes.md)"},
    {.key = "software.kernel.server", .kind = FIELD_BOOL, AT(software.kernel_server),
     .fallback = "false",
     .doc = "both ends of every message pass one server of the whole machine (TCP loopback)"},
    {.key = "software.kernel.time", .kind = FIELD_REAL, .unit = UNIT_TIME, AT(software.kernel_time),
     .min = 0, .max = 10, .fallback = "0 s", .idle = machine_idle_unless_server,
     .doc = "service time of this server per message end"},
    {.key = "software.kernel.per_byte", .kind = FIELD_REAL, .unit = UNIT_TIME_PER_BYTE,
     AT(software.kernel_per_byte),
     .min = 0, .max = 1, .fallback = "0 s/B", .idle = machine_idle_unless_server,
     .doc = "service time of this "
                                                                                 "server per byte"},
    {.key = "software.collectives", .kind = FIELD_TEXT, AT(software.collectives), .capacity = 512,
     .fallback = "",
     .valid = collective_rules_valid, .idle = machine_idle_without_collectives,
     .doc = "algorithms that the message software selects: 'allreduce ring from 64 KiB on 8 ranks; "
            "...', the last that matches counts; else MPICH's choice (docs/collectives.md)"},
    /* Barriers, one-sided transfers, and the channel between processors of one node. */
    {.key = "software.barrier.kind", .kind = FIELD_CHOICE, AT(software.barrier), .choice = barriers,
     .fallback = "software", .doc = "barrier by messages or by hardware"},
    {.key = "software.barrier.time", .kind = FIELD_REAL, .unit = UNIT_TIME,
     AT(software.barrier_time), .min = 0,
     .max = 10, .fallback = "0 s", .idle = machine_idle_unless_hardware_barrier,
     .doc = "hardware barrier: time "
                                                                                "from the last "
                                                                                "arrival to the "
                                                                                "release"},
    {.key = "software.put.overhead", .kind = FIELD_REAL, .unit = UNIT_TIME,
     AT(software.put_overhead), .min = 0,
     .max = 10, .fallback = "0 s", .idle = machine_idle_in_programs,
     .doc = "one-sided: time of a put in addition to the wire, 0: not available"},
    {.key = "software.get.overhead", .kind = FIELD_REAL, .unit = UNIT_TIME,
     AT(software.get_overhead), .min = 0,
     .max = 10, .fallback = "0 s", .idle = machine_idle_in_programs,
     .doc = "one-sided: time of a get in addition to request and reply on the wire, 0: not "
            "available"},
    {.key = "software.shared.latency", .kind = FIELD_REAL, .unit = UNIT_TIME,
     AT(software.shared_latency), .min = 0,
     .max = 10, .fallback = "0 s", .idle = machine_idle_unless_shared_node,
     .doc = "latency of the channel within a node"},
    {.key = "software.shared.bandwidth", .kind = FIELD_REAL, .unit = UNIT_BANDWIDTH,
     AT(software.shared_bandwidth),
     .min = 0, .max = 1e15, .fallback = "0 B/s", .idle = machine_idle_unless_several,
     .doc = "rate of the channel within a node, 0: such messages take the software path of the "
            "network"},

    /* Which rank runs where. */
    {.key = "placement.kind", .kind = FIELD_CHOICE, AT(placement.kind), .choice = placements,
     .fallback = "linear",
     .doc = "order in which ranks fill the nodes; groups: whole routers, planes, sub-trees or "
            "groups of the network where jobs leave them free"},
    {.key = "placement.spread", .kind = FIELD_CHOICE, AT(placement.spread), .choice = spreads,
     .fallback = "block",
     .idle = machine_idle_unless_several,
     .doc = "ranks on the processors of a node: fill one node first, or one "
                                         "rank per node"},
    {.key = "placement.seed", .kind = FIELD_SEED, AT(placement.seed), .fallback = "1",
     .idle = machine_idle_unless_random,
     .doc = "seed of the random order"},
    {.key = "placement.list", .kind = FIELD_INT_LIST, AT(placement.list), COUNT(placement.nlist),
     .min = 0, .max = 1 << 30, .fallback = "[]", .idle = machine_idle_unless_list,
     .doc = "processor of each rank"},

    /* What other jobs and the operating system take; seeded by the run. */
    {.key = "noise.compute", .kind = FIELD_REAL, .unit = UNIT_PERCENT, AT(noise.compute_cv),
     .min = 0, .max = 10,
     .fallback = "0 %", .doc = "relative standard deviation of each computing time"},
    {.key = "noise.background.load", .kind = FIELD_REAL, .unit = UNIT_PERCENT,
     AT(noise.background_load), .min = 0,
     .max = 0.95, .fallback = "0 %", .idle = machine_idle_at_loggp,
     .doc = "share of each link used by other jobs"},
    {.key = "noise.background.message", .kind = FIELD_INT64, .unit = UNIT_BYTES,
     AT(noise.background_bytes), .min = 1,
     .max = 1 << 30, .fallback = "1024 B", .idle = machine_idle_unless_background,
     .doc = "message size of these jobs"},

    /* What a network costs: for `machines --topology` alone, so that no run depends on it. */
    {.key = "price.router", PRICE(router), .doc = "of one router, in any currency"},
    {.key = "price.port", PRICE(port), .doc = "of one port of a router"},
    {.key = "price.cable", PRICE(cable), .doc = "of one cable, whatever its length"},
    {.key = "price.metre", PRICE(metre), .doc = "of one metre of cable"},
    {.key = "power.router", PRICE(router_power), .doc = "of one router [W]"},
    {.key = "power.port", PRICE(port_power), .doc = "of one port of a router [W]"},
    {.key = "floor.routers_per_rack", .kind = FIELD_INT, AT(price.rack_routers), .min = 0,
     .max = 1 << 20, .fallback = "0", .label = true, .idle = machine_idle_in_runs,
     .doc = "routers in a rack, for the lengths of cables; 0: lengths are not known"},
    {.key = "floor.pitch", .kind = FIELD_REAL, .unit = UNIT_LENGTH, AT(price.rack_pitch),
     .min = 0, .max = 1e6, .fallback = "1 m", .label = true, .idle = machine_idle_in_runs,
     .doc = "from one rack to the next, in rows of a square"},
};

const struct field_table machine_table = {
    .prefix = "machine", .doc = "the machine: nodes, network, message software, placement, noise",
    .offset = offsetof(struct run_spec, machine),
    .size = sizeof(struct machine_spec), .nfield = (int)(sizeof fields / sizeof *fields),
    .field = fields,
};

const char *network_level_name(enum network_level level) { return levels[level]; }

/* Each level's line of the list says its place in the order. */
void network_levels_by_cost(enum network_level level[LEVELS])
{
#define X(constant, word, stem, cost, fineness) level[cost] = constant;
    LEVEL_LIST(X)
#undef X
}

void network_levels_by_fineness(enum network_level level[LEVELS])
{
#define X(constant, word, stem, cost, fineness) level[fineness] = constant;
    LEVEL_LIST(X)
#undef X
}

void network_levels_by_name(enum network_level level[LEVELS])
{
    for (int i = 0; i < LEVELS; i++) { /* each into its place among those before it */
        int at = i;
        for (; at > 0 && strcmp(levels[level[at - 1]], levels[i]) > 0; at--)
            level[at] = level[at - 1];
        level[at] = (enum network_level)i;
    }
}
