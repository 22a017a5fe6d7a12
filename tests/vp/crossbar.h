/* crossbar.h - a crossbar whose costs are round numbers, for tests that work out times by hand. */
#ifndef TESTS_VP_CROSSBAR_H
#define TESTS_VP_CROSSBAR_H

#include "spec/machine_spec.h"

/* o_s 2 us + 1 ns/B, one resource of 100 ns, 300 ns at the ends, 1 B/ns behind the first byte, o_r
 * 3 us + 2 ns/B: a message of b bytes arrives 2400 ns + b ns + (b - 1) ns after its sender began.
 */
static inline struct machine_spec crossbar(int nodes)
{
    struct machine_spec m = {.name = "test"};
    m.topology = (struct topology_spec){.family = TOPOLOGY_CROSSBAR,
                                        .ndim = 1,
                                        .dims = {nodes},
                                        .nodes_per_router = 1,
                                        .processors_per_node = 1};
    m.node = (struct node_spec){.flop_rate = 1e9, .clock = 1e9, .copy_bandwidth = 1e9};
    m.network = (struct network_spec){.level = LEVEL_LOGGP,
                                      .link_bandwidth = 1e9,
                                      .hop_latency = 100e-9,
                                      .end_latency = 300e-9,
                                      .virtual_channels = 1};
    m.software = (struct software_spec){.send_overhead = 2e-6,
                                        .recv_overhead = 3e-6,
                                        .send_copy = 1e-9,
                                        .recv_copy = 2e-9,
                                        .eager_bytes = -1};
    return m;
}

#endif
