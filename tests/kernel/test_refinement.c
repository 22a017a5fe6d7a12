/* test_refinement.c - the course of outer refinement, decided by the worst of all ranks: when it
 * begins, how long it goes on, and what is told of it. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "../support/many_ranks.h"
#include "base/random.h"
#include "kernel/extremes.h"

enum { MOST_RANKS = 9, MOST_PASSES = 8, N = 3 };

/* What the ranks of one run hold, and what each of them found. */
struct shared {
    /* of each rank: its residual, the sizes of its corrections and of its answer */
    double residual[MOST_RANKS], correction[MOST_PASSES][MOST_RANKS], answer[MOST_RANKS];
    int most;
    bool sees;
    /* results */
    bool begun[MOST_RANKS];
    int done[MOST_RANKS], calls[MOST_RANKS];
    double before[MOST_RANKS], left[MOST_RANKS], scale[MOST_RANKS];
};

static double largest_of(const double *x, int n)
{
    double most = 0;
    for (int i = 0; i < n; i++) {
        if (isnan(x[i])) return INFINITY;
        most = fmax(most, fabs(x[i]));
    }
    return most;
}

static void run(struct shared *x, int n, many_ranks_program *program)
{
    const struct many_ranks_result r = many_ranks_run(n, program, x);
    assert_int_equal(r.blocked, 0);
    assert_int_equal(r.unread, 0);
}

/* ---- whether it begins ---- */

static void begin(struct comm *c, void *context)
{
    struct shared *x = context;
    const int k = comm_rank(c);
    struct refinement r = {.before = -1};
    x->begun[k] = refinement_begin(&r, c, 3, x->residual[k]);
    x->before[k] = r.before;
}

/* By the worst rank, which all of them know; up to a million roundings nothing is gained. */
static void it_begins_where_the_worst_rank_needs_it(void **state)
{
    (void)state;
    const double enough = 1e6 * DBL_EPSILON;
    const struct {
        double residual;
        bool begun;
    } row[] = {{0, false},          {enough, false},  {enough * (1 + DBL_EPSILON), true},
               {-2 * enough, true}, {-enough, false}, {1, true},
               {INFINITY, true},    {NAN, true}};
    for (int n = 1; n <= MOST_RANKS; n++)
        for (int worst = 0; worst < n; worst += 1 + n / 3)
            for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
                struct shared x = {.most = 1};
                for (int k = 0; k < n; k++) x.residual[k] = 1e-3 * enough;
                x.residual[worst] = row[i].residual;
                run(&x, n, begin);
                for (int k = 0; k < n; k++) {
                    assert_int_equal(x.begun[k], row[i].begun);
                    assert_true(x.before[k] == 1);
                }
            }
}

/* ---- how long it goes on ---- */

/* One rank's part of a correction: its numbers in some order, the largest as given. */
static void spread(double largest, int k, double part[N])
{
    for (int i = 0; i < N; i++) part[i] = i == k % N ? largest : largest / (2 + i);
}

static void accept_all(struct comm *c, void *context)
{
    struct shared *x = context;
    const int k = comm_rank(c);
    struct refinement r = {.before = 1};
    double answer[N], correction[N];
    spread(x->answer[k], k, answer);
    for (int pass = 0; pass < MOST_PASSES; pass++) {
        spread(x->correction[pass][k], k + pass, correction);
        if (!refinement_accept(&r, c, 7, N, correction, answer)) break;
        x->done[k]++;
    }
    x->before[k] = r.before;
}

/* Corrections are taken while they shrink, in proportion to the answer; ranks with small numbers
 * have no say beside those with large ones. */
static void corrections_are_taken_while_they_shrink(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 60; seed++) {
        struct shared x = {.most = 0};
        struct random r = random_make(seed, 0, 0);
        const int n = 1 + (int)random_below(&r, MOST_RANKS);
        double before = 1;
        int done = 0;
        for (int k = 0; k < n; k++) {
            x.answer[k] = random_uniform(&r, -5, 5);
            for (int p = 0; p < MOST_PASSES; p++)
                x.correction[p][k] =
                    random_uniform(&r, -1, 1) * pow(random_uniform(&r, 0.1, 1), p) * 3;
        }
        /* now and then one that is as large as the last one, one of zeros, and no number at all */
        if (seed % 4 == 0) memcpy(x.correction[2], x.correction[1], sizeof x.correction[1]);
        if (seed % 5 == 0) memset(x.correction[3], 0, sizeof x.correction[3]);
        if (seed % 6 == 0) x.correction[1][n / 2] = NAN;
        if (seed % 10 == 0) memset(x.answer, 0, sizeof x.answer);
        for (bool going = true; going && done < MOST_PASSES;) {
            const double size = largest_of(x.correction[done], n), of = largest_of(x.answer, n);
            const double relative = of > 0 ? size / of : size > 0;
            going = relative < before;
            if (going) before = relative, done++;
        }
        run(&x, n, accept_all);
        for (int k = 0; k < n; k++) {
            assert_int_equal(x.done[k], done);
            assert_true(x.before[k] == before);
        }
    }
}

/* ---- all of it ---- */

/* A solver whose corrections are given, and which spoils residual and scale as real ones do. */
struct solver {
    struct shared *x;
    struct comm *c;
    int k;
    double *residual, *scale;
};

static bool correct(void *solver, struct refinement *course)
{
    struct solver *s = solver;
    const int pass = s->x->calls[s->k]++;
    double answer[N], correction[N];
    *s->residual = 77, *s->scale = 88;
    spread(s->x->answer[s->k], s->k, answer);
    spread(s->x->correction[pass][s->k], s->k, correction);
    return refinement_accept(course, s->c, 9, N, correction, answer);
}

static void refine(struct comm *c, void *context)
{
    struct shared *x = context;
    const int k = comm_rank(c);
    double residual = x->residual[k], scale = 4 + k;
    struct solver s = {x, c, k, &residual, &scale};
    x->done[k] = refinement_run(c, 20, x->most, x->sees, &residual, &scale, correct, &s);
    x->left[k] = residual;
    x->scale[k] = scale;
}

static void a_run_stops_with_the_last_that_helped(void **state)
{
    (void)state;
    static const struct {
        int most;
        bool sees;
        double residual, correction[4];
        int done, calls;
        double left; /* the smaller of the residual and of the last correction taken */
    } row[] = {
        {0, true, 1, {0.1}, 0, 0, 1},               /* none is allowed */
        {4, true, 1e-12, {0.1}, 0, 0, 1e-12},       /* none is needed */
        {4, false, 1e-12, {0.1, 0.2}, 1, 2, 1e-12}, /* the residual tells nothing: tried */
        {4, true, 1, {0.5, 0.25, 0.3}, 2, 3, 0.25},
        {2, true, 1, {0.5, 0.25, 0.125}, 2, 2, 0.25},
        {4, true, 0.1, {0.5, 0.25, 0.3}, 2, 3, 0.1},
        {4, true, 1, {2}, 0, 1, 1}, /* larger than the answer */
        {4, true, 1, {NAN}, 0, 1, 1},
        {4, true, 1, {0.5, 0, 0}, 2, 3, 0},
        /* what is no number stays none, so that nobody trusts the answer */
        {3, true, NAN, {0.5, 0.25, 0.125}, 3, 3, NAN},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        for (int n = 1; n <= MOST_RANKS; n += 4) {
            struct shared x = {.most = row[i].most, .sees = row[i].sees};
            for (int k = 0; k < n; k++) {
                x.residual[k] = row[i].residual;
                x.answer[k] = k == n - 1 ? 1 : 0.01;
                for (int p = 0; p < 4; p++)
                    x.correction[p][k] = k == 0 ? row[i].correction[p] : 1e-9;
            }
            /* of the last correction of zeros on all ranks nothing is left */
            if (i == 8) memset(x.correction[1], 0, 2 * sizeof x.correction[1]);
            run(&x, n, refine);
            for (int k = 0; k < n; k++) {
                assert_int_equal(x.done[k], row[i].done);
                assert_int_equal(x.calls[k], row[i].calls);
                if (isnan(row[i].left)) assert_true(isnan(x.left[k]));
                else if (x.left[k] != row[i].left)
                    fail_msg("row %d: %g, not %g", (int)i, x.left[k], row[i].left);
                assert_true(x.scale[k] == 4 + k);
            }
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_begins_where_the_worst_rank_needs_it),
        cmocka_unit_test(corrections_are_taken_while_they_shrink),
        cmocka_unit_test(a_run_stops_with_the_last_that_helped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
