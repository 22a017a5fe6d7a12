/* test_why_beside.c - slack, even shares and ranges of why, each against runs that change what they
 * speak of. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/random.h"
#include "measure/balance.h"
#include "plan/plan.h"
#include "run/run.h"
#include "study/why.h"
#include "study/why_limits.h"
#include "study/why_range.h"

static struct plan scene(struct random *r, const char *level)
{
    static const char *const machines[] = {"t3e-300", "paragon-am", "t3e-300-mpt", "meiko-cs-2"};
    static const char *const kernels[] = {"inverse", "forward",  "dynamics", "allreduce",
                                          "ring",    "alltoall", "barrier"};
    char machine[48], ranks[32], n[32], kernel[32], word[32];
    const int P = 2 + (int)random_below(r, 15);
    snprintf(machine, sizeof machine, "machine=%s", machines[random_below(r, 4)]);
    snprintf(ranks, sizeof ranks, "ranks=%d", P);
    snprintf(n, sizeof n, "n=%d", P + (int)random_below(r, 20));
    snprintf(kernel, sizeof kernel, "kernel=%s", kernels[random_below(r, 7)]);
    snprintf(word, sizeof word, "level=%s", level);
    const char *const set[] = {machine, ranks, n, kernel, word};
    struct plan p;
    struct err e;
    err_clear(&e);
    const struct plan_options o = {.nset = 5, .set = set};
    if (!plan_read(&p, "speedup-t3e", &o, &e)) fail_msg("%s", e.text);
    return p;
}

static struct why study(const struct run_spec *spec, unsigned ask, struct arena *a)
{
    struct why w;
    struct err e;
    err_clear(&e);
    if (!why_study(spec, ask, 1, true, a, &w, &e)) fail_msg("%s", e.text);
    return w;
}

static struct run_result run(const struct run_spec *spec, struct arena *a)
{
    struct run_result r;
    struct err e;
    err_clear(&e);
    if (!run_one(spec, a, &r, &e)) fail_msg("%s", e.text);
    assert_true(r.status <= RUN_INVALID);
    return r;
}

/* The makespan when rank `rank` stops for `delay` where it enters stage `stage`. */
static int64_t delayed(const struct run_spec *spec, const struct run_result *r, int rank, int stage,
                       int64_t delay, struct arena *a)
{
    const int64_t cells = (int64_t)r->nrank * r->nstage;
    /* own 0: computing lasts as counted, and target is spent on entering */
    int64_t *own = TAKE(a, cells, int64_t), *target = TAKE(a, cells, int64_t);
    target[(int64_t)rank * r->nstage + stage] = delay;
    const struct balance b = {r->nrank, r->nstage, own, target};
    struct run_spec changed = *spec;
    changed.record.balance = &b;
    return run(&changed, a).makespan_ps;
}

/* Without contention slack is exact: a stop of that length costs nothing. The slack of a stage is
 * the least of what a rank does in it, so a longer stop at its beginning often costs, but need not.
 */
static void a_rank_may_stop_as_long_as_its_slack(void **state)
{
    (void)state;
    struct random r = random_make(21, 0, 0);
    int asked = 0, tight = 0;
    for (int k = 0; k < 25; k++) {
        struct plan p = scene(&r, "loggp");
        struct arena *a = arena_create();
        const struct why w = study(&p.run[0], WHY_SLACK, a);
        assert_non_null(w.run.rank_slack);
        for (int i = 0; i < 6; i++) {
            const int rank = (int)random_below(&r, (uint64_t)w.run.nrank);
            const int stage = (int)random_below(&r, (uint64_t)w.run.nstage);
            const int64_t slack = w.run.rank_slack[(int64_t)rank * w.run.nstage + stage];
            if (slack == INT64_MAX) continue;
            const int64_t with = delayed(&p.run[0], &w.run, rank, stage, slack, a);
            if (with != w.run.makespan_ps)
                fail_msg("scene %d, %s on %s: rank %d has a slack of %lld ps in stage %d, and the "
                         "run takes %lld instead of %lld ps",
                         k, p.run[0].kernel.name, p.run[0].machine.name, rank, (long long)slack,
                         stage, (long long)with, (long long)w.run.makespan_ps);
            asked++;
            tight += delayed(&p.run[0], &w.run, rank, stage, slack + 100000, a) > with;
        }
        arena_destroy(a);
        plan_free(&p);
    }
    print_message("%d delays of a rank's slack change nothing, %d of 100 ns more do\n", asked,
                  tight);
    assert_true(asked > 60);
    assert_true(tight > asked * 3 / 10);
}

/* Where messages share links, slack keeps their order, and a stop may change it: it holds for most.
 * At the slack itself two messages come to a link at once, so the stop is a picosecond shorter. */
static void with_contention_most_stops_of_that_length_cost_nothing(void **state)
{
    (void)state;
    struct random r = random_make(25, 0, 0);
    int asked = 0, free_of_cost = 0;
    for (int k = 0; k < 40; k++) {
        struct plan p = scene(&r, "link");
        struct arena *a = arena_create();
        const struct why w = study(&p.run[0], WHY_SLACK, a);
        for (int i = 0; i < 6; i++) {
            const int rank = (int)random_below(&r, (uint64_t)w.run.nrank);
            const int stage = (int)random_below(&r, (uint64_t)w.run.nstage);
            const int64_t slack = w.run.rank_slack[(int64_t)rank * w.run.nstage + stage];
            if (slack == 0 || slack == INT64_MAX) continue;
            asked++;
            free_of_cost += delayed(&p.run[0], &w.run, rank, stage, slack - 1, a) <=
                            w.run.makespan_ps;
        }
        arena_destroy(a);
        plan_free(&p);
    }
    print_message("%d stops at level link, %d without cost\n", asked, free_of_cost);
    assert_true(asked > 40);
    assert_true(free_of_cost >= asked * 98 / 100);
}

/* Slack is found in the same run: it changes no time, and the path is the same. */
static void looking_for_slack_changes_nothing(void **state)
{
    (void)state;
    static const char *const level[] = {"loggp", "link", "packet"};
    struct random r = random_make(22, 0, 0);
    for (int k = 0; k < 12; k++) {
        struct plan p = scene(&r, level[k % 3]);
        struct arena *a = arena_create();
        const struct why with = study(&p.run[0], WHY_SLACK, a), without = study(&p.run[0], 0, a);
        assert_true(with.run.digest == without.run.digest);
        assert_int_equal(with.run.makespan_ps, without.run.makespan_ps);
        assert_int_equal(with.run.npath, without.run.npath);
        for (int64_t i = 0; i < with.run.npath; i++) {
            assert_int_equal(with.run.path[i].end_ps, without.run.path[i].end_ps);
            assert_int_equal(with.run.path[i].cause, without.run.path[i].cause);
        }
        assert_null(without.run.rank_slack);
        /* What is on the path has no slack, and no rank ends later than the run. */
        int critical = 0;
        for (int i = 0; i < with.run.nslack; i++) critical += with.run.slack[i].critical_ps > 0;
        assert_true(critical >= 1);
        arena_destroy(a);
        plan_free(&p);
    }
}

static void even_shares_are_the_mean_of_each_stage(void **state)
{
    (void)state;
    struct random r = random_make(23, 0, 0);
    for (int k = 0; k < 8; k++) {
        struct plan p = scene(&r, "loggp");
        struct arena *a = arena_create();
        const struct run_result plain = run(&p.run[0], a);
        struct run_spec changed = p.run[0];
        changed.record.balance = why_even(&plain, a);
        const struct run_result even = run(&changed, a);
        for (int s = 0; s < plain.nstage; s++) {
            int64_t sum = 0, again = 0, least = INT64_MAX, most = 0;
            bool entered = true;
            for (int i = 0; i < plain.nrank; i++) {
                const int64_t own = plain.stage[(int64_t)i * plain.nstage + s].compute_ps;
                const int64_t new = even.stage[(int64_t)i * plain.nstage + s].compute_ps;
                sum += own, again += new;
                least = new < least ? new : least, most = new > most ? new : most;
                /* Who never enters a stage cannot be given a part of it. */
                entered = entered && new > 0;
            }
            if (entered) assert_int_equal(again, sum);
            if (entered) assert_in_range(most - least, 0, 1);
        }
        /* Answers are those of the run: only times of computing differ. */
        assert_int_equal(even.status, plain.status);
        arena_destroy(a);
        plan_free(&p);
    }
}

static void crossings_of_lines(void **state)
{
    (void)state;
    /* 10 + 2 (x - 1) and 16 + 5 (x - 3): both 12 + ... at x = 7/3 */
    const double x = why_crossing(10, 2, 3, 16, 5);
    assert_true(fabs(10 + 2 * (x - 1) - (16 + 5 * (x - 3))) < 1e-12);
    assert_true(isnan(why_crossing(10, 2, 3, 16, 2)));
}

static int64_t scaled(const struct run_spec *spec, const char *key, double factor, struct arena *a)
{
    struct run_spec changed = *spec;
    assert_true(why_scale(&changed.machine, key, factor));
    return run(&changed, a).makespan_ps;
}

/* Without contention the run is the path's straight line up to the range, and longer behind it. */
static void another_path_takes_over_where_the_range_says(void **state)
{
    (void)state;
    struct random r = random_make(24, 0, 0);
    int asked = 0;
    for (int k = 0; k < 12; k++) {
        struct plan p = scene(&r, "loggp");
        struct arena *a = arena_create();
        const struct why w = study(&p.run[0], WHY_TOLERANCES, a);
        for (int i = 0; i < w.nparameter; i++) {
            const struct why_parameter *x = &w.parameter[i];
            if (x->range <= 1.001) continue;
            const double T = (double)w.run.makespan_ps, own = (double)x->time_ps;
            const double before = 1 + 0.98 * (x->range - 1), behind = 1 + 1.1 * (x->range - 1);
            const double close = 1e-6 * T + 1000;
            assert_true(x->range <= x->tolerance * 1.0001);
            assert_true(fabs((double)scaled(&p.run[0], x->key, before, a) - T -
                             own * (before - 1)) <= close);
            assert_true((double)scaled(&p.run[0], x->key, behind, a) >
                        T + own * (behind - 1) - close);
            asked++;
        }
        arena_destroy(a);
        plan_free(&p);
    }
    print_message("%d ranges\n", asked);
    assert_true(asked >= 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rank_may_stop_as_long_as_its_slack),
        cmocka_unit_test(with_contention_most_stops_of_that_length_cost_nothing),
        cmocka_unit_test(looking_for_slack_changes_nothing),
        cmocka_unit_test(even_shares_are_the_mean_of_each_stage),
        cmocka_unit_test(crossings_of_lines),
        cmocka_unit_test(another_path_takes_over_where_the_range_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
