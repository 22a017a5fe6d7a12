/* test_clocked.c - lists that are played in cycles have the times of events: on the networks that
 * the bench compares, beyond saturation, and near the last cycle that there is. */
#include "play.h"

/* The networks on which levels are compared with BookSim (bench/bench_net.c), at its loads and
 * beyond: rules with two ways over one port, ways by load, cables of many cycles. */
static const struct {
    struct topology_spec topology;
    enum routing_rule rule;
    const char *pattern;
    double load;
    int vcs, buffer;
} compared[] = {
    {{.family = TOPOLOGY_MESH, .ndim = 2, .dims = {8, 8}, .nodes_per_router = 1},
     ROUTING_ADAPTIVE_XY_YX, "transpose", 0.3, 4, 16},
    {{.family = TOPOLOGY_TORUS, .ndim = 2, .dims = {8, 8}, .nodes_per_router = 1},
     ROUTING_BOOKSIM_MIN_ADAPT, "tornado(8,2)", 0.3, 4, 16},
    {{.family = TOPOLOGY_HYPERX, .ndim = 2, .dims = {4, 4}, .nodes_per_router = 4},
     ROUTING_BOOKSIM_UGAL, "uniform", 0.3, 4, 16},
    {{.family = TOPOLOGY_FAT_TREE, .ndim = 2, .dims = {4, 3}, .nodes_per_router = 1},
     ROUTING_NCA, "uniform", 0.3, 4, 16},
    {{.family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {2, 4, 2, 0}, .nodes_per_router = 1,
      .dim_latency = {9e-9, 99e-9}},
     ROUTING_BOOKSIM_UGAL, "uniform", 0.3, 3, 256},
};

/* Packets of `flits` flits on network i of those, with credits that take `credit` cycles. */
static void list_on_compared_agrees(int i, int flits, int credit, enum network_level level)
{
    enum { CYCLES = 150, STAGES = 4 };
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    struct topology_spec s = compared[i].topology;
    s.processors_per_node = 1;
    s.tie = TIE_RANDOM;
    struct machine_spec m = netcheck_machine(&s, compared[i].vcs, compared[i].buffer, 0, STAGES);
    m.network.routing = compared[i].rule;
    m.network.vc_allocator = ALLOCATOR_ISLIP;
    m.network.credit_latency = credit * 1e-9;
    m.network.level = level;
    const struct topology *t = topology_create(&m.topology, a, &e);
    struct traffic q;
    struct traffic_result x;
    int clocked = 0;
    assert_true(t && netcheck_load(compared[i].pattern, t, flits, compared[i].load, CYCLES, 1, a,
                                   &q, &e));
    assert_true(play(&m, &q, true, a, &x, &e));
    play_in_cycles(&m, &q, a, &x, i, &clocked);
    assert_int_equal(clocked, 1);
    arena_destroy(a);
}

static void lists_on_compared_networks_agree(void **state)
{
    (void)state;
    static const int flits[] = {1, 4, 6};
    for (int i = 0; i < (int)(sizeof compared / sizeof *compared); i++)
        for (int k = 0; k < 3; k++)
            for (int credit = 1; credit <= 2; credit++) {
                list_on_compared_agrees(i, flits[k], credit, LEVEL_PACKET);
                list_on_compared_agrees(i, flits[k], credit, LEVEL_FLIT);
            }
}

/* Packets of mixed lengths to near nodes of a torus, more than it can take: places are taken in the
 * cycle in which they are left, so that the order of looks counts. One of some 200 such lists
 * showed that bits of looks that were not needed any more changed the order. */
static void looks_that_are_not_needed_any_more_change_no_order(void **state)
{
    (void)state;
    enum { MESSAGES = 2300, SIDE = 8, CYCLES = 170 };
    static const int seed[] = {5, 10, 986, 1165, 1190};
    const struct topology_spec s = square(TOPOLOGY_TORUS, SIDE);
    struct machine_spec m = netcheck_machine(&s, 4, 16, 0, 3);
    m.network.hop_latency = 7e-9;
    m.network.routing_latency = 1e-9;
    m.network.routing = ROUTING_BOOKSIM_MIN_ADAPT;
    m.network.level = LEVEL_PACKET;
    m.network.vc_allocator = ALLOCATOR_ISLIP;
    m.network.allocator_iterations = 1;
    for (size_t k = 0; k < sizeof seed / sizeof *seed; k++) {
        struct arena *a = arena_create();
        struct random r = random_make((uint64_t)seed[k], 3, 4);
        struct traffic q = list_of(MESSAGES, a);
        struct traffic_result x;
        struct err e;
        int clocked = 0;
        err_clear(&e);
        for (int i = 0; i < MESSAGES; i++) {
            q.src[i] = below(&r, SIDE * SIDE);
            q.dst[i] = (q.src[i] + (below(&r, 2) ? 1 : SIDE / 2)) % (SIDE * SIDE);
            q.bytes[i] = 16 * (1 + below(&r, 8));
            q.time[i] = 1000 * (sim_ps)below(&r, CYCLES);
        }
        assert_true(play(&m, &q, true, a, &x, &e));
        play_in_cycles(&m, &q, a, &x, seed[k], &clocked);
        assert_int_equal(clocked, 1);
        arena_destroy(a);
    }
}

/* One message after the other over a mesh: `n` of them, every `gap` from `first` on. Returns
 * whether they were played in cycles; the times are those of events in any case. */
static bool far_list_agrees(const struct machine_spec *m, int n, sim_ps first, sim_ps gap,
                            sim_ps stop)
{
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    struct traffic q = list_of(n, a);
    q.stop = stop;
    for (int i = 0; i < n; i++) {
        q.src[i] = i % 9;
        q.dst[i] = (i * 5 + 1) % 9;
        q.bytes[i] = 64;
        q.time[i] = first + i * gap;
    }
    struct traffic_result x;
    int clocked = 0;
    assert_true(play(m, &q, true, a, &x, &e));
    play_in_cycles(m, &q, a, &x, n, &clocked);
    arena_destroy(a);
    return clocked > 0;
}

/* Times of cycles are 32 bits: what may come near their end is played by events, also where it is
 * beyond the end that a list stops, or begins. */
static void late_cycles_are_played_by_events(void **state)
{
    (void)state;
    const struct topology_spec s = square(TOPOLOGY_MESH, 3);
    struct machine_spec m = netcheck_machine(&s, 2, 16, 0, 3);
    m.network.routing = ROUTING_BOOKSIM_DIM_ORDER;
    const sim_ps cycle = 1000, last = (sim_ps)1 << 30;
    for (int level = 0; level < 2; level++) {
        m.network.level = level ? LEVEL_FLIT : LEVEL_PACKET;
        assert_true(far_list_agrees(&m, 40, 0, 7 * cycle, 0));
        /* Far into the run, but not too far; idle between messages for long. */
        assert_true(far_list_agrees(&m, 40, (last - 100000) * cycle, 7 * cycle, 0));
        assert_true(far_list_agrees(&m, 40, 5 * cycle, last / 41 * cycle, 0));
        assert_true(far_list_agrees(&m, 40, 0, 7 * cycle, 4 * last * cycle));
        /* Across the limit while the last messages are under way; by those that begin; across that
         * of 31 and of 32 bits. */
        assert_false(far_list_agrees(&m, 40, (last - 45) * cycle, cycle, 0));
        assert_false(far_list_agrees(&m, 40, (last - 20) * cycle, 7 * cycle, 0));
        assert_false(far_list_agrees(&m, 40, 0, last / 8 * cycle, 0));
        assert_false(far_list_agrees(&m, 40, (2 * last - 20) * cycle, 7 * cycle, 0));
        assert_false(far_list_agrees(&m, 40, (4 * last - 20) * cycle, 7 * cycle, 0));
        assert_false(far_list_agrees(&m, 40, 4 * last * cycle, 7 * cycle, 0));
        assert_false(far_list_agrees(&m, 40, (last - 20) * cycle, 7 * cycle, (last + 9) * cycle));
        /* Whom the stop cuts off is not stuck, although his arrival was told before: by events, and
         * in cycles of half a flit. */
        struct machine_spec uneven = m, half = m;
        uneven.network.hop_latency = 5.503e-9;
        half.network.hop_latency = 5.5e-9;
        for (sim_ps stop = cycle; stop < 40 * cycle; stop += cycle) {
            assert_false(far_list_agrees(&uneven, 1, 0, cycle, stop));
            assert_true(far_list_agrees(&half, 1, 0, cycle, stop));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_on_compared_networks_agree),
        cmocka_unit_test(looks_that_are_not_needed_any_more_change_no_order),
        cmocka_unit_test(late_cycles_are_played_by_events),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
