/* test_slack.c - slack against its meaning: in random graphs every node is delayed by its slack,
 * which must not lengthen the run, and by one picosecond more, which must. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "measure/slack.h"

enum { RANKS = 5, STEPS = 60, MOST = 1024 };

/* The same graph as plain lists: node k is at the latest of time(from) + after over its edges. */
struct model {
    int n, nedge;
    struct {
        int from, to;
        int64_t after;
    } edge[4 * MOST];
    uint32_t number[MOST]; /* of the node in the log */
    int64_t time[MOST];
};

/* Times with node `late` later by `delay`; edges lead from lower to higher numbers and are sorted
 * by their ends. */
static int64_t run_model(struct model *m, const int *end, int late, int64_t delay)
{
    int64_t makespan = 0;
    memset(m->time, 0, sizeof m->time);
    for (int k = 0, i = 0; k < m->n; k++) {
        for (; i < m->nedge && m->edge[i].to == k; i++) {
            const int64_t t = m->time[m->edge[i].from] + m->edge[i].after;
            if (t > m->time[k]) m->time[k] = t;
        }
        if (k == late) m->time[k] += delay;
    }
    for (int r = 0; r < RANKS; r++)
        if (m->time[end[r]] > makespan) makespan = m->time[end[r]];
    return makespan;
}

static void edge(struct model *m, int from, int to, int64_t after)
{
    m->edge[m->nedge].from = from;
    m->edge[m->nedge].to = to;
    m->edge[m->nedge++].after = after;
}

/* The makings of a node: it takes `duration` after `from`. */
static int step(struct model *m, struct path_log *p, int from, int64_t duration,
                enum path_cause cause, int rank, int stage)
{
    const int k = m->n++;
    m->number[k] = path_add(p, m->number[from], path_time(p, m->number[from]) + duration, cause,
                            rank, stage, -1, 1);
    edge(m, from, k, duration);
    return k;
}

/* Two meet; the loser is `lag` before what it delays. */
static int meet(struct model *m, struct path_log *p, int a, int b, int64_t lag, int rank, int stage)
{
    const int k = m->n++;
    const int64_t ta = path_time(p, m->number[a]), tb = path_time(p, m->number[b]) + lag;
    /* What is `lag` behind b is a node of its own where it binds, as a port's release is. */
    if (tb > ta) {
        const uint32_t free = path_add(p, m->number[b], tb, PATH_GAP, -1, -1, 7, 1);
        m->number[k] = path_join(p, free, m->number[a], 0, PATH_POLL, rank, stage);
    } else {
        m->number[k] = path_join(p, m->number[a], m->number[b], lag, PATH_POLL, rank, stage);
    }
    edge(m, a, k, 0);
    edge(m, b, k, lag);
    return k;
}

/* Ranks that compute, send to each other and wait, and one port that all messages pass. */
static void random_graph(struct random *r, struct model *m, struct path_log *p, int *end)
{
    int at[RANKS] = {0}, port = 0;
    m->n = 1, m->nedge = 0, m->number[0] = 0;
    for (int k = 0; k < STEPS; k++) {
        const int a = (int)random_below(r, RANKS), b = (int)random_below(r, RANKS);
        const int stage = k / (STEPS / 3 + 1);
        at[a] = step(m, p, at[a], 1 + (int64_t)random_below(r, 900), PATH_COMPUTE, a, stage);
        if (a == b) continue;
        /* The port is free 200 after it was taken. */
        const int taken = port == 0 ? at[a] : meet(m, p, at[a], port, 200, a, stage);
        port = taken;
        const int arrival =
            step(m, p, taken, 50 + (int64_t)random_below(r, 500), PATH_END, a, stage);
        at[b] = meet(m, p, at[b], arrival, 0, b, stage);
        at[b] = step(m, p, at[b], 30, PATH_RECV, b, stage);
    }
    memcpy(end, at, sizeof at);
}

/* The model's times are the log's: else the rest would prove nothing. */
static void assert_same_times(struct model *m, const struct path_log *p, const int *end)
{
    run_model(m, end, -1, 0);
    for (int k = 0; k < m->n; k++) assert_int_equal(m->time[k], path_time(p, m->number[k]));
}

static void every_node_can_be_as_late_as_its_slack_and_no_later(void **state)
{
    (void)state;
    struct model *m = malloc(sizeof *m);
    struct random r = random_make(11, 0, 0);
    int asked = 0;
    for (int graph = 0; graph < 200; graph++) {
        struct path_log *p = path_log_create();
        int end[RANKS];
        uint32_t last[RANKS];
        path_keep_losers(p);
        random_graph(&r, m, p, end);
        assert_same_times(m, p, end);
        for (int i = 0; i < RANKS; i++) last[i] = m->number[end[i]];
        int64_t *slack = slack_of(p, RANKS, last);
        const int64_t makespan = run_model(m, end, -1, 0);
        for (int k = 1; k < m->n; k++) {
            const int64_t s = slack[m->number[k]];
            if (s == INT64_MAX) { /* nothing ever waits for it */
                assert_int_equal(run_model(m, end, k, 1 << 30), makespan);
                continue;
            }
            assert_int_equal(run_model(m, end, k, s), makespan);
            assert_int_equal(run_model(m, end, k, s + 1), makespan + 1);
            asked++;
        }
        free(slack);
        path_log_destroy(p);
    }
    assert_true(asked > 10000);
    free(m);
}

/* By hand: rank 0 computes 100; rank 1 computes 30 and 20, then waits for a message that takes 10.
 */
static void sums_tell_what_is_critical_and_what_nearly_is(void **state)
{
    (void)state;
    struct path_log *p = path_log_create();
    struct arena *a = arena_create();
    path_keep_losers(p);
    const uint32_t x = path_add(p, 0, 100, PATH_COMPUTE, 0, 0, -1, -1);
    const uint32_t wire = path_add(p, x, 110, PATH_END, 0, 0, -1, 1);
    uint32_t y = path_add(p, 0, 30, PATH_COMPUTE, 1, 0, -1, -1);
    y = path_add(p, y, 50, PATH_COMPUTE, 1, 1, -1, -1);
    y = path_join(p, wire, y, 0, PATH_POLL, 1, 1);
    y = path_add(p, y, 140, PATH_RECV, 1, 1, -1, 8);
    const uint32_t end[] = {x, y};
    int64_t *slack = slack_of(p, 2, end);
    assert_int_equal(slack[x], 0);
    int n;
    const struct slack_row *row = slack_rows(p, slack, 140, &n, a);
    assert_int_equal(n, 4);
    /* the longest first: computing in stage 0, 130 in all, 100 of them critical, 60 to spare */
    assert_int_equal(row[0].stage, 0);
    assert_int_equal(row[0].cause, PATH_COMPUTE);
    assert_int_equal(row[0].steps, 2);
    assert_int_equal(row[0].time_ps, 130);
    assert_int_equal(row[0].critical_ps, 100);
    assert_int_equal(row[0].near_ps, 100);
    assert_int_equal(row[0].least_ps, 60);
    assert_int_equal(row[1].cause, PATH_RECV);
    assert_int_equal(row[1].least_ps, INT64_MAX);
    const int64_t *rank = slack_ranks(p, slack, 2, 2, a);
    assert_int_equal(rank[0], 0);
    assert_int_equal(rank[1], INT64_MAX); /* rank 0 does nothing in stage 1 */
    assert_int_equal(rank[2], 60);
    assert_int_equal(rank[3], 0);
    free(slack);
    /* A node at which times meet is no step of a path. */
    int64_t steps;
    path_trace(p, y, &steps, a);
    assert_int_equal(steps, 3);
    arena_destroy(a);
    path_log_destroy(p);
}

/* Without losers nothing more is stored, and the winner itself goes on. */
static void a_log_that_keeps_no_losers_is_as_before(void **state)
{
    (void)state;
    struct path_log *p = path_log_create();
    const uint32_t x = path_add(p, 0, 100, PATH_COMPUTE, 0, 0, -1, -1);
    const int64_t bytes = path_bytes(p);
    assert_false(path_keeps_losers(p));
    assert_int_equal(path_join(p, x, 0, 0, PATH_POLL, 1, 1), x);
    path_lose(p, 0, x, 0);
    assert_int_equal(path_nodes(p), 2);
    assert_int_equal(path_bytes(p), bytes);
    path_log_destroy(p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_node_can_be_as_late_as_its_slack_and_no_later),
        cmocka_unit_test(sums_tell_what_is_critical_and_what_nearly_is),
        cmocka_unit_test(a_log_that_keeps_no_losers_is_as_before),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
