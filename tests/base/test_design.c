/* test_design.c - points that fill a cube: known beginnings, evenness, and the same points again.
 */
#include "base/design.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { N = 64, K = 6 };

/* Sobol's sequence in two dimensions begins so (Bratley and Fox 1988), without the origin. */
static void sobol_begins_as_published(void **state)
{
    (void)state;
    static const double expected[] = {0.5, 0.5, 0.75, 0.25, 0.25, 0.75, 0.375, 0.375, 0.875, 0.875};
    double u[10];
    design_fill(DESIGN_SOBOL, 0, 5, 2, u);
    for (int i = 0; i < 10; i++) assert_true(u[i] == expected[i]);
}

/* Halton in bases 2 and 3. */
static void halton_begins_as_published(void **state)
{
    (void)state;
    double u[6];
    design_fill(DESIGN_HALTON, 0, 3, 2, u);
    const double expected[] = {1 / 2., 1 / 3., 1 / 4., 2 / 3., 3 / 4., 1 / 9.};
    for (int i = 0; i < 6; i++) assert_true(fabs(u[i] - expected[i]) < 1e-15);
}

static void a_latin_hypercube_has_each_slice_once(void **state)
{
    (void)state;
    double u[N * K];
    design_fill(DESIGN_LATIN_HYPERCUBE, 7, N, K, u);
    for (int k = 0; k < K; k++) {
        int seen[N] = {0};
        for (int i = 0; i < N; i++) seen[(int)(u[i * K + k] * N)]++;
        for (int i = 0; i < N; i++) assert_int_equal(seen[i], 1);
    }
    /* the dimensions are in different orders */
    int same = 0;
    for (int i = 0; i < N; i++) same += (int)(u[i * K] * N) == (int)(u[i * K + 1] * N);
    assert_true(same < N / 4);
}

static void all_are_within_the_cube_and_the_same_again(void **state)
{
    (void)state;
    for (int d = 0; d < DESIGNS; d++)
        for (uint64_t seed = 0; seed < 3; seed++) {
            double u[N * K], again[N * K], mean = 0;
            design_fill((enum design)d, seed, N, K, u);
            design_fill((enum design)d, seed, N, K, again);
            assert_memory_equal(u, again, sizeof u);
            for (int i = 0; i < N * K; i++) {
                assert_true(u[i] >= 0 && u[i] < 1);
                mean += u[i] / (N * K);
            }
            assert_true(fabs(mean - 0.5) < 0.05);
        }
}

static void another_seed_gives_other_points(void **state)
{
    (void)state;
    for (int d = 0; d < DESIGNS; d++) {
        double u[N * K], other[N * K];
        design_fill((enum design)d, 1, N, K, u);
        design_fill((enum design)d, 2, N, K, other);
        assert_memory_not_equal(u, other, sizeof u);
    }
}

/* A longer sequence begins with the shorter one, so that more samples repeat no run. */
static void sequences_can_be_continued(void **state)
{
    (void)state;
    static const enum design d[] = {DESIGN_SOBOL, DESIGN_HALTON, DESIGN_RANDOM};
    for (int i = 0; i < 3; i++) {
        double u[N * K], longer[2 * N * K];
        design_fill(d[i], 5, N, K, u);
        design_fill(d[i], 5, 2 * N, K, longer);
        assert_memory_equal(u, longer, sizeof u);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sobol_begins_as_published),
        cmocka_unit_test(halton_begins_as_published),
        cmocka_unit_test(a_latin_hypercube_has_each_slice_once),
        cmocka_unit_test(all_are_within_the_cube_and_the_same_again),
        cmocka_unit_test(another_seed_gives_other_points),
        cmocka_unit_test(sequences_can_be_continued),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
