/* test_node_use.c - where working sets lie, who shares the way to them, and what that costs:
 * against numbers worked out by hand, and for random nodes against what must hold of any. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "machine/node_use.h"

enum { KIB = 1024 };

/* Four processors a node; one of 100 Mflop/s has 32 KiB of its own at 8 GB/s, two share 512 KiB at
 * 4 and together 6 GB/s, all a memory of 1 and together 2 GB/s. */
static struct machine_spec machine(void)
{
    struct machine_spec m = {.topology = {.family = TOPOLOGY_CROSSBAR,
                                          .ndim = 1,
                                          .dims = {4},
                                          .nodes_per_router = 1,
                                          .processors_per_node = 4}};
    m.node = (struct node_spec){.flop_rate = 1e8,
                                .clock = 1e8,
                                .div_cycles = 10,
                                .call_time = 1e-9,
                                .copy_bandwidth = 1e9,
                                .model = NODE_ROOFLINE};
    m.node.level[NODE_L1] = (struct memory_level){.bytes = 32 * KIB, .bandwidth = 8e9};
    m.node.level[NODE_L2] = (struct memory_level){512 * KIB, 4e9, 6e9, 2};
    m.node.level[NODE_MEMORY] = (struct memory_level){0, 1e9, 2e9, 0};
    return m;
}

static struct node_use use_of(const struct machine_spec *m, int nrank, int64_t working_set)
{
    struct node_use u;
    struct err e;
    err_clear(&e);
    assert_true(node_use_make(m, nrank, working_set, &u, &e));
    return u;
}

static void a_working_set_lies_in_the_nearest_cache_that_holds_it(void **state)
{
    (void)state;
    const struct machine_spec m = machine();
    struct node_use u = node_use_alone(0);
    assert_int_equal(node_use_level(&m.node, &u), NODE_L1);
    u.working_set = 32 * KIB;
    assert_int_equal(node_use_level(&m.node, &u), NODE_L1);
    u.working_set++;
    assert_int_equal(node_use_level(&m.node, &u), NODE_L2);
    u.working_set = 512 * KIB;
    assert_int_equal(node_use_level(&m.node, &u), NODE_L2);
    /* two ranks have half of it each */
    u = use_of(&m, 2, 256 * KIB);
    assert_int_equal(u.sharers[NODE_L2], 2);
    assert_int_equal(node_use_level(&m.node, &u), NODE_L2);
    u.working_set++;
    assert_int_equal(node_use_level(&m.node, &u), NODE_MEMORY);
    /* a node without caches has only its memory */
    const struct node_spec bare = {.model = NODE_ROOFLINE};
    u = node_use_alone(0);
    assert_int_equal(node_use_level(&bare, &u), NODE_MEMORY);
}

static void ranks_share_what_lies_between_them_and_their_data(void **state)
{
    (void)state;
    struct machine_spec m = machine();
    static const struct {
        int nrank, l2, memory;
    } block[] = {{1, 1, 1}, {2, 2, 2}, {3, 2, 3}, {4, 2, 4}, {5, 2, 4}, {16, 2, 4}};
    for (size_t i = 0; i < sizeof block / sizeof *block; i++) {
        const struct node_use u = use_of(&m, block[i].nrank, 0);
        assert_int_equal(u.sharers[NODE_L1], 1);
        assert_int_equal(u.sharers[NODE_L2], block[i].l2);
        assert_int_equal(u.sharers[NODE_L3], 1);
        assert_int_equal(u.sharers[NODE_MEMORY], block[i].memory);
    }
    /* one rank a node first: four have a memory each */
    m.placement.spread = SPREAD_CYCLIC;
    assert_int_equal(use_of(&m, 4, 0).sharers[NODE_MEMORY], 1);
    assert_int_equal(use_of(&m, 5, 0).sharers[NODE_MEMORY], 2);
    /* a memory of two nodes */
    m.placement.spread = SPREAD_BLOCK;
    m.node.level[NODE_MEMORY].processors = 8;
    assert_int_equal(use_of(&m, 7, 0).sharers[NODE_MEMORY], 7);
    assert_int_equal(use_of(&m, 16, 0).sharers[NODE_MEMORY], 8);
    /* listed places: the last processors of each node */
    int list[4] = {3, 7, 11, 15};
    m.placement = (struct placement_spec){.kind = PLACEMENT_LIST, .nlist = 4, .list = list};
    assert_int_equal(use_of(&m, 4, 0).sharers[NODE_MEMORY], 2);
}

static void bandwidths_are_a_processors_own_or_its_part_of_the_shared(void **state)
{
    (void)state;
    const struct machine_spec m = machine();
    struct node_use u = node_use_alone(0);
    assert_float_equal(node_use_bandwidth(&m.node, &u, NODE_MEMORY), 1e9, 0);
    u.sharers[NODE_MEMORY] = 2;
    assert_float_equal(node_use_bandwidth(&m.node, &u, NODE_MEMORY), 1e9, 0);
    u.sharers[NODE_MEMORY] = 4;
    assert_float_equal(node_use_bandwidth(&m.node, &u, NODE_MEMORY), 5e8, 0);
    u.sharers[NODE_L2] = 2;
    assert_float_equal(node_use_bandwidth(&m.node, &u, NODE_L2), 3e9, 0);
    assert_true(isinf(node_use_bandwidth(&m.node, &u, NODE_L3)));
}

/* 100 Mflop/s: 10 ns a flop; 4 B a flop where nobody counts; 1 ns a byte from memory, 2 ns with
 * four sharers, 1/8 ns from L1. */
static void work_takes_the_longer_one_of_operations_and_transfer(void **state)
{
    (void)state;
    const struct machine_spec m = machine();
    struct node_use u = use_of(&m, 4, 1 << 30);
    struct node_cost c = node_use_cost(&m.node, &u);
    assert_float_equal(c.moved, 2000, 1e-9);
    /* 10 flops: 100 ns against 40 B at 2 ns */
    assert_int_equal(node_cost_ps(&c, &(struct work){.flop = 10}), 100000);
    /* counted bytes replace the 4 B: 60 B take 120 ns */
    assert_int_equal(node_cost_ps(&c, &(struct work){.flop = 10, .moved = 60}), 120000);
    /* a copied byte is loaded and stored: 40 + 2 * 50 B at 2 ns; not its price by rates */
    assert_int_equal(node_cost_ps(&c, &(struct work){.flop = 10, .bytes = 50}), 280000);
    /* division and call are operations: 100 + 100 + 1 ns */
    assert_int_equal(node_cost_ps(&c, &(struct work){.flop = 10, .div = 1, .call = 1}), 201000);
    assert_float_equal(node_cost_stated_ps(&c, 10, 60), 120000, 1e-9);
    assert_float_equal(node_cost_stated_ps(&c, 10, -60), 100000, 1e-9);
    assert_float_equal(node_cost_stated_ps(&c, NAN, 60), 120000, 1e-9);
    /* code: the third roof is that of its instructions */
    assert_float_equal(node_cost_code_ps(&c, &(struct work){.flop = 1, .bytes = 24}, 5), 48000,
                       1e-9);
    assert_float_equal(node_cost_code_ps(&c, &(struct work){.flop = 1, .bytes = 24}, 50),
                       (float)(50 * c.instruction), 1e-6);
    /* within the first cache */
    u.working_set = 0;
    c = node_use_cost(&m.node, &u);
    assert_float_equal(c.moved, 125, 1e-9);
    assert_int_equal(node_cost_ps(&c, &(struct work){.flop = 10, .moved = 960}), 120000);
    assert_float_equal(node_cost_make(&m.node).moved, 125, 1e-9);
}

/* Bytes pass every level on their way: a slow one in between holds them up. */
static void the_slowest_level_on_the_way_counts(void **state)
{
    (void)state;
    struct machine_spec m = machine();
    m.node.level[NODE_L2].bandwidth = 5e8;
    struct node_use u = node_use_alone(1 << 30);
    assert_float_equal(node_use_cost(&m.node, &u).moved, 2000, 1e-9);
    u.working_set = 0;
    assert_float_equal(node_use_cost(&m.node, &u).moved, 125, 1e-9);
    /* without any number bytes are free */
    memset(m.node.level, 0, sizeof m.node.level);
    assert_float_equal(node_use_cost(&m.node, &u).moved, 0, 0);
    assert_float_equal(node_cost_make(&m.node).moved, 0, 0);
}

static void rates_stay_what_they_were(void **state)
{
    (void)state;
    struct machine_spec m = machine(), plain = machine();
    m.node.model = plain.node.model = NODE_RATES;
    memset(plain.node.level, 0, sizeof plain.node.level);
    const struct node_use u = use_of(&m, 16, 1 << 30);
    const struct node_cost a = node_use_cost(&m.node, &u), b = node_cost_make(&plain.node);
    const struct work w = {.flop = 7, .div = 2, .bytes = 100, .call = 3, .moved = 12345};
    assert_int_equal(u.sharers[NODE_MEMORY], 1);
    assert_int_equal(node_cost_ps(&a, &w), node_cost_ps(&b, &w));
    assert_int_equal(node_cost_ps(&a, &w), 70000 + 200000 + 100000 + 3000);
    assert_float_equal(node_cost_stated_ps(&a, 7, 100), 170000, 1e-9);
    assert_float_equal(node_cost_code_ps(&a, &w, 0), 270000, 1e-9);
}

static void more_ranks_than_processors_are_refused(void **state)
{
    (void)state;
    const struct machine_spec m = machine();
    struct node_use u;
    struct err e;
    err_clear(&e);
    assert_false(node_use_make(&m, 17, 0, &u, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
}

static double one_of(struct random *r, double least, double most)
{
    return least * exp(random_uniform(r, 0, 1) * log(most / least));
}

/* A node whose levels are drawn: the further ones larger. */
static struct machine_spec drawn(struct random *r)
{
    struct machine_spec m = machine();
    int64_t bytes = 1 << 12;
    for (int i = 0; i < NODE_LEVELS; i++) {
        bytes = (int64_t)(one_of(r, 2, 64) * (double)bytes);
        const bool there = random_uniform(r, 0, 1) < 0.8;
        m.node.level[i] = (struct memory_level){there ? bytes : 0, one_of(r, 1e8, 1e11),
                                                one_of(r, 1e8, 1e12), (int)one_of(r, 1, 16)};
    }
    return m;
}

/* More data, more sharers, slower levels: never faster. Twice the work: never more than twice the
 * time, but for rounding. Never less than the operations alone. */
static void time_grows_with_data_sharers_and_work(void **state)
{
    (void)state;
    struct random r = random_make(17, 0, 0);
    for (int k = 0; k < 20000; k++) {
        struct machine_spec m = drawn(&r);
        struct node_use u = node_use_alone((int64_t)one_of(&r, 1, 1e10));
        for (int i = NODE_L2; i < NODE_LEVELS; i++) u.sharers[i] = (int)one_of(&r, 1, 16);
        const struct work w = {.flop = (uint64_t)one_of(&r, 1, 1e6),
                               .moved = (uint64_t)one_of(&r, 1, 1e7)};
        const struct work two = {.flop = 2 * w.flop, .moved = 2 * w.moved};
        const struct node_cost c = node_use_cost(&m.node, &u);
        const int64_t ps = node_cost_ps(&c, &w);
        assert_true(ps >= (int64_t)((double)w.flop * c.flop));
        assert_true(llabs(node_cost_ps(&c, &two) - 2 * ps) <= 1);
        struct node_use more = u;
        more.working_set *= 4;
        assert_true(node_use_level(&m.node, &more) >= node_use_level(&m.node, &u));
        struct node_cost other = node_use_cost(&m.node, &more);
        assert_true(node_cost_ps(&other, &w) >= ps);
        more = u;
        more.sharers[NODE_L2 + k % 3]++;
        other = node_use_cost(&m.node, &more);
        assert_true(node_cost_ps(&other, &w) >= ps);
        m.node.level[k % NODE_LEVELS].bandwidth /= 2;
        other = node_use_cost(&m.node, &u);
        assert_true(node_cost_ps(&other, &w) >= ps);
    }
}

static void what_is_told_names_level_sharers_and_ridge(void **state)
{
    (void)state;
    struct machine_spec m = machine();
    char text[320];
    struct node_use u = use_of(&m, 4, 1 << 20);
    node_use_tell(&m.node, &u, text, sizeof text);
    /* 500 MB/s against 100 Mflop/s: 5 B in the time of a flop */
    assert_non_null(
        strstr(text, "1 MiB a rank in the memory, which 4 ranks share: 500 MB/s for each"));
    assert_non_null(strstr(text, "below 0.2 flop/B"));
    m.node.model = NODE_RATES;
    node_use_tell(&m.node, &u, text, sizeof text);
    assert_non_null(strstr(text, "left out: caches"));
    m.node.level[NODE_MEMORY].bandwidth = 0;
    node_use_tell(&m.node, &u, text, sizeof text);
    assert_string_equal(text, "");
}

static void levels_have_names(void **state)
{
    (void)state;
    assert_string_equal(node_level_name(NODE_L1), "L1");
    assert_string_equal(node_level_name(NODE_MEMORY), "memory");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_working_set_lies_in_the_nearest_cache_that_holds_it),
        cmocka_unit_test(ranks_share_what_lies_between_them_and_their_data),
        cmocka_unit_test(bandwidths_are_a_processors_own_or_its_part_of_the_shared),
        cmocka_unit_test(work_takes_the_longer_one_of_operations_and_transfer),
        cmocka_unit_test(the_slowest_level_on_the_way_counts),
        cmocka_unit_test(rates_stay_what_they_were),
        cmocka_unit_test(more_ranks_than_processors_are_refused),
        cmocka_unit_test(time_grows_with_data_sharers_and_work),
        cmocka_unit_test(what_is_told_names_level_sharers_and_ridge),
        cmocka_unit_test(levels_have_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
