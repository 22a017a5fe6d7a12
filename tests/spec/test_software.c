/* test_software.c - segments of message software: limits at their edges, lists completed, and what
 * is sent at once; levels, programs and machines as the lists say. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>

#include "base/random.h"
#include "spec/run_spec.h"

static struct software_spec classic(int64_t short_bytes, int64_t eager_bytes)
{
    return (struct software_spec){.send_overhead = 5,
                                  .send_copy = 0.5,
                                  .recv_overhead = 7,
                                  .recv_copy = 0.25,
                                  .gap = 3,
                                  .gap_per_byte = 0.125,
                                  .rendezvous_latency = 11,
                                  .eager_bytes = eager_bytes,
                                  .eager_copy = 2,
                                  .short_bytes = short_bytes,
                                  .short_saving = 1.5,
                                  .short_copy = 4};
}

static void limits_make_one_to_three_segments(void **state)
{
    (void)state;
    static const struct {
        int64_t short_bytes, eager_bytes;
        int n;
        int64_t from[3];
    } cases[] = {
        {0, -1, 1, {0}},         /* neither */
        {0, 0, 2, {0, 1}},       /* only empty messages are eager */
        {1, -1, 2, {0, 2}},      /* short ones alone */
        {0, 4096, 2, {0, 4097}}, /* eager ones alone */
        {64, 4096, 3, {0, 65, 4097}},
        {4096, 64, 3, {0, 65, 4097}}, /* short ones that shake hands */
        {64, 64, 2, {0, 65}},         /* one step where both limits agree */
        {64, 63, 3, {0, 64, 65}},
        {1, 0, 3, {0, 1, 2}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct software_segment s[SOFTWARE_MAX_SEGMENTS];
        struct software_spec soft = classic(cases[i].short_bytes, cases[i].eager_bytes);
        assert_int_equal(software_segments(&soft, s), cases[i].n);
        for (int k = 0; k < cases[i].n; k++) assert_int_equal(s[k].from, cases[i].from[k]);
    }
}

/* What the header says of one size, said again without segments. */
static void check_size(const struct software_spec *soft, int64_t bytes)
{
    struct software_segment list[SOFTWARE_MAX_SEGMENTS];
    int n = software_segments(soft, list);
    const struct software_segment *s = software_segment_of(list, n, bytes);
    bool is_short = bytes <= soft->short_bytes && soft->short_bytes > 0;
    bool eager = soft->eager_bytes == -1 || bytes <= soft->eager_bytes;
    double saving = !is_short                                  ? 0
                    : soft->short_saving > soft->send_overhead ? soft->send_overhead
                                                               : soft->short_saving;
    assert_true(s->from <= bytes && (s == &list[n - 1] || s[1].from > bytes));
    assert_true(s->send_overhead == soft->send_overhead && s->send_copy == soft->send_copy);
    assert_true(s->recv_overhead == soft->recv_overhead && s->recv_copy == soft->recv_copy);
    assert_true(s->gap == soft->gap && s->gap_per_byte == soft->gap_per_byte);
    assert_true(s->rendezvous_latency == soft->rendezvous_latency && s->latency == 0);
    assert_true(s->send_saving == saving);
    assert_true(s->recv_extra == (!eager ? 0 : is_short ? soft->short_copy : soft->eager_copy));
    assert_int_equal(s->protocol, eager ? PROTOCOL_EAGER : PROTOCOL_RENDEZVOUS);
    assert_true(eager == (bytes <= software_eager_most(soft)));
    /* all messages up to this size are sent at once exactly when it is eager itself */
    assert_true(software_all_eager(soft, bytes) == eager);
}

static void every_size_is_as_the_limits_say(void **state)
{
    (void)state;
    struct random r = random_make(5, 0, 0);
    for (int round = 0; round < 3000; round++) {
        int64_t a = (int64_t)random_below(&r, 6), b = (int64_t)random_below(&r, 7) - 1;
        if (random_below(&r, 2)) a <<= 20;
        if (random_below(&r, 2) && b > 0) b <<= 20;
        struct software_spec soft = classic(a, b);
        if (random_below(&r, 3) == 0) soft.short_saving = 99; /* more than there is to save */
        const int64_t at[] = {0, 1, a - 1, a, a + 1, b - 1, b, b + 1, (int64_t)1 << 40};
        for (size_t i = 0; i < sizeof at / sizeof *at; i++)
            if (at[i] >= 0) check_size(&soft, at[i]);
    }
    struct software_spec none = classic(0, -1), some = classic(0, 100);
    assert_true(software_all_eager(&none, -1));
    assert_false(software_all_eager(&some, -1));
    assert_true(software_eager_most(&none) == INT64_MAX);
}

static struct software_segment not_given(int64_t from)
{
    return (struct software_segment){.from = from,
                                     .send_overhead = -1,
                                     .send_copy = -1,
                                     .recv_overhead = -1,
                                     .recv_copy = -1,
                                     .latency = -1,
                                     .gap = -1,
                                     .gap_per_byte = -1,
                                     .rendezvous_latency = -1};
}

static void a_list_is_completed_by_the_numbers_of_the_whole(void **state)
{
    (void)state;
    struct software_segment out[SOFTWARE_MAX_SEGMENTS];
    struct software_spec soft = classic(64, 4096);
    soft.nsegment = 3;
    soft.segment[0] = not_given(0);
    soft.segment[1] = not_given(10);
    soft.segment[1].send_overhead = 0; /* 0 is given */
    soft.segment[1].latency = 9;
    soft.segment[1].gap = 21;
    soft.segment[1].gap_per_byte = 22;
    soft.segment[1].recv_overhead = 23;
    soft.segment[2] = not_given(20);
    soft.segment[2].protocol = PROTOCOL_SYNCHRONOUS;
    soft.segment[2].rendezvous_latency = 2;
    soft.segment[2].send_copy = 31;
    soft.segment[2].recv_copy = 32;
    assert_int_equal(software_segments(&soft, out), 3);
    assert_true(out[0].send_overhead == 5 && out[0].send_copy == 0.5 && out[0].recv_overhead == 7);
    assert_true(out[0].recv_copy == 0.25 && out[0].gap == 3 && out[0].gap_per_byte == 0.125);
    assert_true(out[0].latency == 0 && out[0].rendezvous_latency == 11);
    assert_true(out[1].send_overhead == 0 && out[1].latency == 9 && out[1].gap == 21);
    assert_true(out[1].gap_per_byte == 22 && out[1].recv_overhead == 23 && out[1].send_copy == 0.5);
    assert_true(out[2].rendezvous_latency == 2 && out[2].send_copy == 31 && out[2].recv_copy == 32);
    /* short and eager numbers have no part in lists */
    for (int i = 0; i < 3; i++) assert_true(out[i].send_saving == 0 && out[i].recv_extra == 0);
    /* the spec itself stays as it was */
    assert_true(soft.segment[0].send_overhead == -1);
    assert_int_equal(software_eager_most(&soft), 19);
    assert_true(software_all_eager(&soft, 19));
    assert_false(software_all_eager(&soft, 20));
    assert_int_equal(software_segment_of(out, 3, 9)->from, 0);
    assert_int_equal(software_segment_of(out, 3, 10)->from, 10);
    assert_int_equal(software_segment_of(out, 3, INT64_MAX)->from, 20);
    /* none is sent at once */
    soft.segment[0].protocol = PROTOCOL_RENDEZVOUS;
    assert_int_equal(software_eager_most(&soft), -1);
    assert_false(software_all_eager(&soft, 0));
    /* as many as there may be */
    for (int i = 0; i < SOFTWARE_MAX_SEGMENTS; i++) soft.segment[i] = not_given(i * 100);
    soft.nsegment = SOFTWARE_MAX_SEGMENTS;
    assert_int_equal(software_segments(&soft, out), SOFTWARE_MAX_SEGMENTS);
    assert_int_equal(software_segment_of(out, SOFTWARE_MAX_SEGMENTS, 650)->from, 600);
    assert_true(software_eager_most(&soft) == INT64_MAX);
}

static void orders_of_levels_name_each_once(void **state)
{
    (void)state;
    enum network_level level[LEVELS];
    network_levels_by_cost(level);
    static const char *const cost[] = {"loggp", "link", "auto", "packet", "flit"};
    static const char *const fine[] = {"flit", "packet", "auto", "link", "loggp"};
    static const char *const name[] = {"auto", "flit", "link", "loggp", "packet"};
    assert_int_equal(LEVELS, 5);
    for (int i = 0; i < LEVELS; i++) assert_string_equal(network_level_name(level[i]), cost[i]);
    network_levels_by_fineness(level);
    for (int i = 0; i < LEVELS; i++) assert_string_equal(network_level_name(level[i]), fine[i]);
    network_levels_by_name(level);
    for (int i = 0; i < LEVELS; i++) assert_string_equal(network_level_name(level[i]), name[i]);
    assert_string_equal(network_level_name(LEVEL_AUTO_TOLERANCE), "auto-tolerance");
}

static void programs_have_the_traits_of_their_names(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        unsigned traits;
    } cases[] = {
        {"inverse", PROGRAM_SCENE | PROGRAM_INVERSE},
        {"forward", PROGRAM_SCENE | PROGRAM_FORWARD},
        {"dynamics", PROGRAM_SCENE | PROGRAM_INVERSE | PROGRAM_FORWARD},
        {"barrier", 0},
        {"random-ring", PROGRAM_MESSAGE | PROGRAM_RING | PROGRAM_RANDOM},
        {"scatter", PROGRAM_MESSAGE | PROGRAM_COLLECTIVE | PROGRAM_ROOT},
        {"scan", PROGRAM_MESSAGE | PROGRAM_COLLECTIVE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kernel_spec k = {0};
        strcpy(k.name, cases[i].name);
        for (unsigned bit = 1; bit <= PROGRAM_ROOT; bit *= 2)
            assert_true(kernel_spec_has(&k, (enum program_trait)bit) ==
                        ((cases[i].traits & bit) != 0));
        assert_true(kernel_spec_needs_model(&k) == ((cases[i].traits & PROGRAM_SCENE) != 0));
    }
    struct kernel_spec k = {.step = STEP_LINEARLY_IMPLICIT};
    assert_false(kernel_spec_implicit(&k));
    k.steps = 1;
    assert_true(kernel_spec_implicit(&k));
    k.step = STEP_RK4;
    assert_false(kernel_spec_implicit(&k));
}

static int64_t processors(enum topology_family family, const int *dims, int n, int per_router,
                          int per_node)
{
    struct machine_spec m = {0};
    m.topology.family = family;
    m.topology.ndim = n;
    memcpy(m.topology.dims, dims, (size_t)n * sizeof *dims);
    m.topology.nodes_per_router = per_router;
    m.topology.processors_per_node = per_node;
    return machine_spec_processors(&m);
}

/* By hand, from the definitions of the families. */
static void processors_of_the_other_families(void **state)
{
    (void)state;
    const int mesh[] = {3, 5, 7}, fly[] = {5}, plus[] = {2, 3, 4, 1, 6}, clos[] = {4, 3, 2},
              random[] = {10, 3}, tree[] = {2, 10};
    assert_int_equal(processors(TOPOLOGY_EXPRESS_MESH, mesh, 3, 2, 1), 210);
    assert_int_equal(processors(TOPOLOGY_TWISTED_TORUS, mesh, 2, 1, 1), 15);
    assert_int_equal(processors(TOPOLOGY_HYPERX, mesh, 3, 3, 2), 630);
    assert_int_equal(processors(TOPOLOGY_SLIM_FLY, fly, 1, 4, 1), 200); /* 2 q^2 routers */
    /* 2 nodes a leaf, 3 leaves a group, 6 groups; nodes_per_router has no part */
    assert_int_equal(processors(TOPOLOGY_DRAGONFLY_PLUS, plus, 5, 99, 1), 36);
    assert_int_equal(processors(TOPOLOGY_FOLDED_CLOS, clos, 3, 99, 2), 48);
    assert_int_equal(processors(TOPOLOGY_RANDOM_REGULAR, random, 2, 4, 1), 40);
    assert_int_equal(processors(TOPOLOGY_FAT_TREE, tree, 2, 99, 1), 1024);
    /* too many to count is the largest number, not one that has wrapped */
    const int huge[] = {1 << 24, 1 << 24, 1 << 24}, deep[] = {2, 1 << 24}, one[] = {1, 1 << 24};
    assert_true(processors(TOPOLOGY_TORUS, huge, 3, 1, 1) == INT64_MAX);
    assert_true(processors(TOPOLOGY_TORUS, huge, 2, 1 << 10, 1 << 10) == INT64_MAX);
    assert_true(processors(TOPOLOGY_FAT_TREE, deep, 2, 1, 1) == INT64_MAX);
    assert_true(processors(TOPOLOGY_HYPERCUBE, huge, 1, 1, 1) == INT64_MAX);
    assert_int_equal(processors(TOPOLOGY_FAT_TREE, one, 2, 1, 1), 1);
    assert_true(processors(TOPOLOGY_TORUS, huge, 2, 1, 1) == (int64_t)1 << 48);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(limits_make_one_to_three_segments),
        cmocka_unit_test(every_size_is_as_the_limits_say),
        cmocka_unit_test(a_list_is_completed_by_the_numbers_of_the_whole),
        cmocka_unit_test(orders_of_levels_name_each_once),
        cmocka_unit_test(programs_have_the_traits_of_their_names),
        cmocka_unit_test(processors_of_the_other_families),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
