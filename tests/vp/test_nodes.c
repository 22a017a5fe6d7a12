/* test_nodes.c - ranks that compute on nodes with caches and a memory that they share: exact
 * times. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "vp/world.h"

static const char *const stage_name[] = {"all"};

/* Two nodes of two processors, 1 ns a flop; 64 KiB a processor at 4 GB/s, a memory for each node of
 * 2 GB/s for one and 3 GB/s for both. */
static struct machine_spec two_nodes(void)
{
    struct machine_spec m = {.name = "test"};
    m.topology = (struct topology_spec){.family = TOPOLOGY_CROSSBAR,
                                        .ndim = 1,
                                        .dims = {2},
                                        .nodes_per_router = 1,
                                        .processors_per_node = 2};
    m.node = (struct node_spec){.flop_rate = 1e9, .clock = 1e9, .model = NODE_ROOFLINE};
    m.node.level[NODE_L1] = (struct memory_level){.bytes = 64 << 10, .bandwidth = 4e9};
    m.node.level[NODE_MEMORY] = (struct memory_level){.bandwidth = 2e9, .shared = 3e9};
    m.network =
        (struct network_spec){.level = LEVEL_LOGGP, .link_bandwidth = 1e9, .virtual_channels = 1};
    m.software = (struct software_spec){.eager_bytes = -1};
    return m;
}

/* A piece that the memory decides, 6000 B for 1000 flops, and one of operations alone. */
static void compute(struct comm *c, void *context)
{
    (void)context;
    comm_work(c, &(struct work){.flop = 1000, .moved = 6000});
    comm_work(c, &(struct work){.flop = 1000, .moved = 1});
}

static struct run_result go(const struct machine_spec *m, int nrank, int64_t working_set,
                            struct arena *a)
{
    struct run_result r = {0};
    const struct record_spec record = {0};
    struct err e;
    err_clear(&e);
    const struct world_load load = {.nrank = nrank,
                                    .program = compute,
                                    .nstage = 1,
                                    .stage_name = stage_name,
                                    .largest_message = 0,
                                    .working_set = working_set};
    if (!world_run(m, &load, &record, 1, a, &r, &e)) fail_msg("%s", e.text);
    assert_int_equal(r.working_set, working_set);
    for (int i = 0; i < nrank; i++) assert_int_equal(r.finish_ps[i], r.makespan_ps);
    return r;
}

static void assert_takes(const struct machine_spec *m, int nrank, int64_t working_set, int64_t ps)
{
    struct arena *a = arena_create();
    assert_int_equal(go(m, nrank, working_set, a).makespan_ps, ps);
    arena_destroy(a);
}

static void data_come_from_the_level_that_holds_them(void **state)
{
    (void)state;
    const struct machine_spec m = two_nodes();
    /* 6000 B at 4 GB/s are 1500 ns, at 2 GB/s 3000 */
    assert_takes(&m, 1, 64 << 10, 1500000 + 1000000);
    assert_takes(&m, 1, (64 << 10) + 1, 3000000 + 1000000);
}

static void two_ranks_on_a_memory_have_half_of_it_each(void **state)
{
    (void)state;
    struct machine_spec m = two_nodes();
    /* 1.5 GB/s each; the first cache is nobody else's */
    assert_takes(&m, 2, 1 << 20, 4000000 + 1000000);
    assert_takes(&m, 2, 1 << 10, 1500000 + 1000000);
    /* a third rank has the other node's memory, and is taken as slow as the others */
    assert_takes(&m, 3, 1 << 20, 4000000 + 1000000);
    /* one rank a node */
    m.placement.spread = SPREAD_CYCLIC;
    assert_takes(&m, 2, 1 << 20, 3000000 + 1000000);
}

static void by_rates_the_same_node_has_no_memory(void **state)
{
    (void)state;
    struct machine_spec m = two_nodes();
    m.node.model = NODE_RATES;
    assert_takes(&m, 4, 1 << 20, 2000000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(data_come_from_the_level_that_holds_them),
        cmocka_unit_test(two_ranks_on_a_memory_have_half_of_it_each),
        cmocka_unit_test(by_rates_the_same_node_has_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
