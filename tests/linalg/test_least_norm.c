/* test_least_norm.c - eigenvalues of known matrices; least-norm solutions, their rank and their
 * scaling. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "linalg/eigen.h"
#include "linalg/least_norm.h"

#define assert_near(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))
#define PI 3.14159265358979323846

/* The second difference matrix has eigenvalues 2 - 2 cos(k pi / (n + 1)). */
static void second_difference_eigenvalues(void **state)
{
    (void)state;
    enum { N = 9 };
    double a[N * N] = {0}, v[N * N], w[N];
    for (int i = 0; i < N; i++) {
        a[i * N + i] = 2;
        if (i) a[i * N + i - 1] = a[(i - 1) * N + i] = -1;
    }
    assert_true(eigen_symmetric(N, a, v, w, &(struct work){0}) < 12);
    for (int k = 1; k <= N; k++) {
        double want = 2 - 2 * cos(k * PI / (N + 1)), nearest = 1e9;
        for (int i = 0; i < N; i++) nearest = fmin(nearest, fabs(w[i] - want));
        assert_true(nearest < 1e-14);
    }
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            double dot = 0;
            for (int k = 0; k < N; k++) dot += v[k * N + i] * v[k * N + j];
            assert_near(dot, i == j, 1e-14);
        }
}

static void tiny_eigenvalues_of_graded_matrices_keep_their_digits(void **state)
{
    (void)state;
    /* diag(1, 1e-20) turned by a small coupling that keeps it positive definite */
    double a[4] = {1, 1e-11, 1e-11, 2e-20}, w[2];
    eigen_symmetric(2, a, NULL, w, &(struct work){0});
    double small = fmin(w[0], w[1]);
    assert_near(small / 1.99e-20, 1, 0.01); /* 2e-20 - 1e-22 */
}

/* S = B B^T with B (n x r): x is the shortest solution, S x = r on the range, rank r. */
static void the_shortest_solution_is_found(void **state)
{
    (void)state;
    struct random rnd = random_make(4, 0, 0);
    for (int rank = 0; rank <= 5; rank++) {
        enum { N = 5 };
        double b[N * N] = {0}, s[N * N], copy[N * N], x[N], r[N], y[N], room[N * N + 2 * N],
                     reference[N];
        struct work w = {0};
        for (int i = 0; i < N; i++) {
            for (int k = 0; k < rank; k++) b[i * N + k] = random_uniform(&rnd, -1, 1);
            y[i] = random_uniform(&rnd, -1, 1);
            reference[i] = 1;
        }
        for (int i = 0; i < N; i++)
            for (int j = 0; j < N; j++) {
                s[i * N + j] = 0;
                for (int k = 0; k < rank; k++) s[i * N + j] += b[i * N + k] * b[j * N + k];
            }
        memcpy(copy, s, sizeof s);
        for (int i = 0; i < N; i++) {
            r[i] = 0;
            for (int j = 0; j < N; j++) r[i] += s[i * N + j] * y[j];
            x[i] = r[i];
        }
        assert_int_equal(least_norm_solve(N, reference, copy, x, room, &w), rank);
        double nx = 0, ny = 0;
        for (int i = 0; i < N; i++) {
            double sum = 0;
            for (int j = 0; j < N; j++) sum += s[i * N + j] * x[j];
            assert_near(sum, r[i], 1e-11);
            nx += x[i] * x[i], ny += y[i] * y[i];
        }
        assert_true(nx <= ny * (1 + 1e-9));
        assert_true(rank < N || fabs(nx - ny) < 1e-8 * ny);
        assert_true(w.flop > 0);
    }
}

/* Noise of the reduced matrix counts against the block that it came from, not against itself. */
static void rounding_noise_is_not_rank(void **state)
{
    (void)state;
    double s[4] = {1, 0, 0, 3e-14}, x[2] = {1, 1e-14}, reference[2] = {2, 100}, room[8];
    struct work w = {0};
    assert_int_equal(least_norm_solve(2, reference, s, x, room, &w), 1);
    assert_near(x[0], 1, 1e-15);
    assert_near(x[1], 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(second_difference_eigenvalues),
        cmocka_unit_test(tiny_eigenvalues_of_graded_matrices_keep_their_digits),
        cmocka_unit_test(the_shortest_solution_is_found),
        cmocka_unit_test(rounding_noise_is_not_rank),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
