/* timed_world.h - a crossbar with round numbers, and runs of programs that ask for time on it. */
#ifndef TESTS_VP_TIMED_WORLD_H
#define TESTS_VP_TIMED_WORLD_H

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "vp/world.h"

static const char *const stage_name[] = {"work"};

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

static inline int64_t trip(int64_t bytes)
{
    return 2400000 + 1000 * bytes + 1000 * (bytes > 0 ? bytes - 1 : 0);
}
static inline int64_t receipt(int64_t bytes) { return 3000000 + 2000 * bytes; }

enum { US = 1000000 };

struct outcome {
    struct arena *arena;
    struct run_result r;
};

static inline struct outcome run_load(const struct machine_spec *m, struct world_load load)
{
    struct outcome o = {.arena = arena_create()};
    struct record_spec record = {.spans = false};
    struct err e;
    err_clear(&e);
    load.nstage = 1;
    load.stage_name = stage_name;
    load.largest_message = -1;
    if (!world_run(m, &load, &record, 1, o.arena, &o.r, &e)) fail_msg("%s", e.text);
    return o;
}

static inline struct outcome go(const struct machine_spec *m, int nrank, world_program *program,
                                void *context)
{
    return run_load(m, (struct world_load){.nrank = nrank,
                                           .program = program,
                                           .context = context,
                                           .timed = true,
                                           .foreign = true});
}

static inline void expect_ok(const struct outcome *o)
{
    if (o->r.status != RUN_OK) fail_msg("%s", o->r.text);
}

#endif
