/* test_path.c - the graph of what binds: steps add up to the time, in order, with what each of
 * them is. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "measure/path.h"

/* A run of two ranks by hand: rank 0 computes 10 ps and sends (2 ps); the wire takes 5 ps and the
 * message waits 3 ps for a link; rank 1 receives (4 ps). */
struct by_hand {
    uint32_t computed, sent, waited, there, received;
};

static struct by_hand make(struct path_log *p)
{
    const struct work w = {.flop = 7, .div = 1};
    struct by_hand n;
    n.computed = path_add_work(p, 0, 10, 0, 2, &w);
    n.sent = path_add(p, n.computed, 12, PATH_SEND, 0, 3, -1, 100);
    n.waited = path_add(p, n.sent, 15, PATH_CONTENTION, -1, -1, 9, 0);
    n.there = path_add(p, n.waited, 20, PATH_HOP, -1, -1, 9, 2);
    n.received = path_add(p, n.there, 24, PATH_RECV, 1, 4, -1, 100);
    return n;
}

static void an_empty_graph_is_its_start(void **state)
{
    (void)state;
    struct path_log *p = path_log_create();
    struct arena *a = arena_create();
    int64_t n = -1;
    assert_int_equal(path_nodes(p), 1);
    assert_int_equal(path_time(p, 0), 0);
    path_trace(p, 0, &n, a);
    assert_int_equal(n, 0);
    arena_destroy(a);
    path_log_destroy(p);
    path_log_destroy(NULL);
}

static void steps_stand_in_the_order_of_time_and_leave_no_gap(void **state)
{
    (void)state;
    struct path_log *p = path_log_create();
    struct arena *a = arena_create();
    const struct by_hand at = make(p);
    int64_t n;
    const struct path_step *s = path_trace(p, at.received, &n, a);
    static const enum path_cause cause[] = {PATH_COMPUTE, PATH_SEND, PATH_CONTENTION, PATH_HOP,
                                            PATH_RECV};
    static const int64_t end[] = {10, 12, 15, 20, 24};
    assert_int_equal(n, 5);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(s[i].cause, cause[i]);
        assert_int_equal(s[i].end_ps, end[i]);
        assert_int_equal(s[i].begin_ps, i > 0 ? end[i - 1] : 0);
    }
    arena_destroy(a);
    path_log_destroy(p);
}

static void a_step_says_whose_it_is(void **state)
{
    (void)state;
    struct path_log *p = path_log_create();
    struct arena *a = arena_create();
    int64_t n;
    const struct path_step *s = path_trace(p, make(p).received, &n, a);
    /* of computing: what was counted, and no count of messages */
    assert_int_equal(s[0].rank, 0);
    assert_int_equal(s[0].stage, 2);
    assert_int_equal(s[0].work.flop, 7);
    assert_int_equal(s[0].work.div, 1);
    assert_int_equal(s[0].count, 0);
    assert_int_equal(s[0].resource, -1);
    assert_int_equal(s[1].count, 100);
    /* the wire has no rank of its own: it is that of the message */
    assert_int_equal(s[2].rank, 0);
    assert_int_equal(s[2].stage, 3);
    assert_int_equal(s[2].resource, 9);
    assert_int_equal(s[3].count, 2);
    assert_int_equal(s[4].rank, 1);
    assert_int_equal(s[4].stage, 4);
    arena_destroy(a);
    path_log_destroy(p);
}

/* Only what takes time can be on a critical path. */
static void what_takes_no_time_makes_no_node(void **state)
{
    (void)state;
    struct path_log *p = path_log_create();
    struct arena *a = arena_create();
    const struct work w = {.flop = 1}, other = {.flop = 2};
    const uint32_t sent = path_add(p, 0, 5, PATH_SEND, 0, 0, -1, 8);
    const int64_t before = path_nodes(p);
    int64_t n;
    assert_int_equal(path_add(p, sent, 5, PATH_HOP, 1, 1, 3, 1), sent);
    assert_int_equal(path_add_work(p, sent, 5, 1, 1, &w), sent);
    assert_int_equal(path_nodes(p), before);
    /* and its work is not taken for that of the next one */
    const struct path_step *s = path_trace(p, path_add_work(p, sent, 6, 0, 0, &other), &n, a);
    assert_int_equal(n, 2);
    assert_int_equal(s[1].work.flop, 2);
    arena_destroy(a);
    path_log_destroy(p);
}

static void the_way_back_stops_at_a_time(void **state)
{
    (void)state;
    struct path_log *p = path_log_create();
    const struct by_hand at = make(p);
    assert_int_equal(path_at(p, at.received, 100), at.received);
    assert_int_equal(path_at(p, at.received, 24), at.received);
    assert_int_equal(path_at(p, at.received, 23), at.there);
    assert_int_equal(path_at(p, at.received, 14), at.sent);
    assert_int_equal(path_at(p, at.received, 10), at.computed);
    assert_int_equal(path_at(p, at.received, 9), 0);
    path_log_destroy(p);
}

/* Any graph: the array has grown many times, and still every chain is whole. */
static void chains_of_a_large_graph_are_whole(void **state)
{
    (void)state;
    enum { NODES = 20000 };
    struct path_log *p = path_log_create();
    struct random r = random_make(5, 0, 0);
    for (uint32_t i = 1; i <= NODES; i++) {
        const uint32_t before = (uint32_t)random_below(&r, i);
        const int64_t time = path_time(p, before) + 1 + (int64_t)random_below(&r, 1000);
        const struct work w = {.flop = i};
        const uint32_t made = i % 3 == 0
                                  ? path_add_work(p, before, time, (int)(i % 7), 1, &w)
                                  : path_add(p, before, time, PATH_HOP, (int)(i % 7), 1, (int)i, i);
        assert_int_equal(made, i);
    }
    assert_true(path_bytes(p) >= NODES * 32);
    for (uint32_t i = 1; i <= NODES; i += 97) {
        struct arena *a = arena_create();
        int64_t n;
        const struct path_step *s = path_trace(p, i, &n, a);
        int64_t sum = 0;
        for (int64_t k = 0; k < n; k++) {
            assert_int_equal(s[k].begin_ps, sum);
            sum = s[k].end_ps;
        }
        assert_int_equal(sum, path_time(p, i));
        /* the last step is node i itself */
        if (i % 3 == 0) assert_int_equal(s[n - 1].work.flop, i);
        else assert_int_equal(s[n - 1].count, i);
        arena_destroy(a);
    }
    path_log_destroy(p);
}

static void every_cause_has_a_word_of_its_own(void **state)
{
    (void)state;
    for (int i = 0; i < PATH_CAUSES; i++)
        for (int k = 0; k < i; k++)
            assert_string_not_equal(path_cause_word((enum path_cause)i),
                                    path_cause_word((enum path_cause)k));
    assert_string_equal(path_cause_word(PATH_COMPUTE), "computing");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_graph_is_its_start),
        cmocka_unit_test(steps_stand_in_the_order_of_time_and_leave_no_gap),
        cmocka_unit_test(a_step_says_whose_it_is),
        cmocka_unit_test(what_takes_no_time_makes_no_node),
        cmocka_unit_test(the_way_back_stops_at_a_time),
        cmocka_unit_test(chains_of_a_large_graph_are_whole),
        cmocka_unit_test(every_cause_has_a_word_of_its_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
