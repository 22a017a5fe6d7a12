/* test_joins.c - graphs in which times meet, built at random beside plain lists: who binds, whose
 * it is, what slack each rank has; and what stops the program. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../support/last_words.h"
#include "base/random.h"
#include "measure/slack.h"

enum { MOST = 600, RANKS = 4, STAGES = 3 };

/* The same graph as lists; node 0 is the start. */
struct twin {
    int n;
    int before[MOST], rank[MOST], stage[MOST];
    int64_t time[MOST];
    enum path_cause cause[MOST];
};

static void note(struct twin *t, uint32_t node, int before, int64_t time, enum path_cause cause,
                 int rank, int stage)
{
    assert_int_equal(node, t->n);
    t->before[t->n] = before, t->time[t->n] = time, t->cause[t->n] = cause;
    t->rank[t->n] = rank >= 0 ? rank : t->rank[before];
    t->stage[t->n] = stage >= 0 ? stage : t->stage[before];
    t->n++;
}

/* Steps of all lengths, none among them, and joins of a later time with an earlier one. */
static void grow(struct random *r, struct path_log *p, struct twin *t)
{
    memset(t, 0, sizeof *t);
    t->n = 1, t->cause[0] = PATH_START;
    while (t->n < MOST) {
        const int from = (int)random_below(r, (uint64_t)t->n);
        const int rank = (int)random_below(r, RANKS + 1) - 1;
        const int stage = (int)random_below(r, STAGES + 1) - 1;
        if (random_below(r, 4) == 0 && t->n > 1) {
            const int other = (int)random_below(r, (uint64_t)t->n);
            const int winner = t->time[from] >= t->time[other] ? from : other;
            const int loser = winner == from ? other : from;
            const uint32_t made =
                path_join(p, (uint32_t)winner, (uint32_t)loser, 0, PATH_POLL, rank, stage);
            note(t, made, winner, t->time[winner], PATH_POLL, rank, stage);
            continue;
        }
        const int64_t time = t->time[from] + (int64_t)random_below(r, 4) * 10;
        const enum path_cause cause = (enum path_cause)(1 + random_below(r, PATH_CAUSES - 1));
        const struct work w = {.flop = 1};
        const uint32_t made = cause == PATH_COMPUTE
                                  ? path_add_work(p, (uint32_t)from, time, rank, stage, &w)
                                  : path_add(p, (uint32_t)from, time, cause, rank, stage, -1, 1);
        if (time == t->time[from]) assert_int_equal(made, from);
        else note(t, made, from, time, cause, rank, stage);
    }
}

static void nodes_are_what_was_said_of_them(void **state)
{
    (void)state;
    static struct twin t;
    struct random r = random_make(91, 0, 0);
    for (int trial = 0; trial < 5; trial++) {
        struct path_log *p = path_log_create();
        struct arena *a = arena_create();
        assert_false(path_keeps_losers(p));
        path_keep_losers(p);
        assert_true(path_keeps_losers(p));
        grow(&r, p, &t);
        assert_int_equal(path_nodes(p), t.n);
        for (int k = 1; k < t.n; k++) {
            int rank, stage, at = k;
            path_owner(p, (uint32_t)k, &rank, &stage);
            assert_true(rank == t.rank[k] && stage == t.stage[k]);
            assert_int_equal(path_time(p, (uint32_t)k), t.time[k]);
            /* the way back, asked for at a time of its own */
            const int64_t time = (int64_t)random_below(&r, (uint64_t)t.time[k] + 20);
            while (t.time[at] > time) at = t.before[at];
            assert_int_equal(path_at(p, (uint32_t)k, time), at);
            /* a trace has every step that takes time, and no other */
            int64_t n, steps = 0;
            const struct path_step *s = path_trace(p, (uint32_t)k, &n, a);
            for (int i = k; i != 0; i = t.before[i]) {
                if (t.time[i] == t.time[t.before[i]]) continue;
                steps++;
                assert_int_equal(s[n - steps].cause, t.cause[i]);
                assert_int_equal(s[n - steps].end_ps, t.time[i]);
                assert_int_equal(s[n - steps].rank, t.rank[i]);
                assert_int_equal(s[n - steps].stage, t.stage[i]);
                assert_int_equal(s[n - steps].work.flop, t.cause[i] == PATH_COMPUTE);
            }
            assert_int_equal(steps, n);
        }
        arena_destroy(a);
        path_log_destroy(p);
    }
}

/* What a rank does itself, the least slack of it; and rows whose times add up. */
static void ranks_and_rows_are_sums_over_nodes(void **state)
{
    (void)state;
    static struct twin t;
    struct random r = random_make(92, 0, 0);
    for (int trial = 0; trial < 10; trial++) {
        struct path_log *p = path_log_create();
        struct arena *a = arena_create();
        path_keep_losers(p);
        grow(&r, p, &t);
        uint32_t end[RANKS];
        int64_t makespan = 0, want[RANKS * STAGES], sum = 0, critical = 0, near = 0, all[3] = {0};
        for (int k = 0; k < RANKS; k++) {
            end[k] = (uint32_t)random_below(&r, (uint64_t)t.n);
            makespan = t.time[end[k]] > makespan ? t.time[end[k]] : makespan;
        }
        int64_t *slack = slack_of(p, RANKS, end);
        for (int k = 0; k < RANKS * STAGES; k++) want[k] = INT64_MAX;
        for (int k = 1; k < t.n; k++) {
            const int64_t time = t.time[k] - t.time[t.before[k]];
            const bool own = t.cause[k] == PATH_COMPUTE || t.cause[k] == PATH_SEND ||
                             t.cause[k] == PATH_RECV || t.cause[k] == PATH_POLL;
            int64_t *cell = &want[t.rank[k] * STAGES + t.stage[k]];
            if (own && time > 0 && slack[k] < *cell) *cell = slack[k];
            sum += time;
            if (slack[k] == 0) critical += time;
            if (slack[k] <= makespan / SLACK_NEAR) near += time;
        }
        const int64_t *least = slack_ranks(p, slack, RANKS, STAGES, a);
        for (int k = 0; k < RANKS * STAGES; k++) assert_int_equal(least[k], want[k]);
        int n;
        const struct slack_row *row = slack_rows(p, slack, makespan, &n, a);
        for (int i = 0; i < n; i++) {
            assert_true(row[i].steps > 0 && row[i].least_ps > 0);
            assert_true(i == 0 || row[i - 1].time_ps >= row[i].time_ps);
            assert_true(row[i].critical_ps <= row[i].near_ps && row[i].near_ps <= row[i].time_ps);
            all[0] += row[i].time_ps, all[1] += row[i].critical_ps, all[2] += row[i].near_ps;
        }
        assert_int_equal(all[0], sum);
        assert_int_equal(all[1], critical);
        assert_int_equal(all[2], near);
        assert_true(critical >= makespan); /* the path itself has no slack */
        free(slack);
        arena_destroy(a);
        path_log_destroy(p);
    }
}

/* By hand: a message that comes 7 ps before its receive may be 7 ps later, less the lag; and a rank
 * that ends 5 ps before the run may be 5 ps later. */
static void a_loser_has_the_slack_of_its_lead(void **state)
{
    (void)state;
    for (int64_t lag = 0; lag <= 9; lag += 3) {
        struct path_log *p = path_log_create();
        path_keep_losers(p);
        const uint32_t message = path_add(p, 0, 13, PATH_HOP, 0, 0, -1, 1),
                       ready = path_add(p, 0, 20, PATH_COMPUTE, 1, 0, -1, -1);
        const uint32_t met = path_join(p, ready, message, lag, PATH_POLL, 1, 0);
        const uint32_t end[2] = {path_add(p, met, 30, PATH_RECV, 1, 0, -1, 1),
                                 path_add(p, message, 25, PATH_SEND, 0, 0, -1, 1)};
        int64_t *slack = slack_of(p, 2, end);
        const int64_t lead = 7 - lag > 0 ? 7 - lag : 0;
        assert_int_equal(slack[ready], 0);
        assert_int_equal(slack[end[0]], 0);
        assert_int_equal(slack[end[1]], 5);
        assert_int_equal(slack[message], lead < 5 ? lead : 5);
        free(slack);
        path_log_destroy(p);
    }
}

/* Nearly critical is who has at most a twentieth of the makespan left: 5 of 100 ps, not 6. */
static void nearly_critical_ends_at_a_twentieth(void **state)
{
    (void)state;
    for (int64_t early = 4; early <= 6; early++) {
        struct path_log *p = path_log_create();
        struct arena *a = arena_create();
        int n;
        path_keep_losers(p);
        const uint32_t end[2] = {path_add(p, 0, 100, PATH_COMPUTE, 0, 0, -1, -1),
                                 path_add(p, 0, 100 - early, PATH_SEND, 1, 0, -1, 1)};
        int64_t *slack = slack_of(p, 2, end);
        const struct slack_row *row = slack_rows(p, slack, 100, &n, a);
        assert_int_equal(n, 2);
        assert_true(row[0].cause == PATH_COMPUTE && row[1].cause == PATH_SEND);
        assert_true(row[0].critical_ps == 100 && row[0].near_ps == 100);
        assert_int_equal(row[0].least_ps, INT64_MAX);
        assert_int_equal(row[1].critical_ps, 0);
        assert_int_equal(row[1].near_ps, early <= 5 ? 100 - early : 0);
        assert_int_equal(row[1].least_ps, early);
        free(slack);
        arena_destroy(a);
        path_log_destroy(p);
    }
}

/* --- what stops the program --- */

static struct path_log *log_;

static void earlier_than_its_cause(void) { path_add(log_, 1, 9, PATH_SEND, 0, 0, -1, 1); }
static void after_no_node(void) { path_add(log_, 99, 50, PATH_SEND, 0, 0, -1, 1); }
static void joins_no_node(void) { path_join(log_, 99, 0, 0, PATH_POLL, 0, 0); }
static void loses_to_itself(void) { path_lose(log_, 1, 1, 0); }
static void loses_to_no_node(void) { path_lose(log_, 1, 99, 0); }

static void graphs_without_an_order_stop_the_program(void **state)
{
    (void)state;
    static void (*const wrong[])(void) = {earlier_than_its_cause, after_no_node, joins_no_node,
                                          loses_to_itself, loses_to_no_node};
    log_ = path_log_create();
    path_keep_losers(log_);
    path_add(log_, 0, 10, PATH_SEND, 0, 0, -1, 1);
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char words[512];
        expect_abort(wrong[k], words, sizeof words);
        if (!strstr(words, "CHECK(")) fail_msg("%d: '%s'", (int)k, words);
    }
    path_log_destroy(log_);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes_are_what_was_said_of_them),
        cmocka_unit_test(ranks_and_rows_are_sums_over_nodes),
        cmocka_unit_test(a_loser_has_the_slack_of_its_lead),
        cmocka_unit_test(nearly_critical_ends_at_a_twentieth),
        cmocka_unit_test(graphs_without_an_order_stop_the_program),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
