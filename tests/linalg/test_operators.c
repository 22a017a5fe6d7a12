/* test_operators.c - what the small dense operators promise beside their answers: costs, refusals,
 * factors that serve one by one, and systems of no order. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "linalg/block_tridiag.h"
#include "linalg/eigen.h"
#include "linalg/least_norm.h"

#define assert_near(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))

static void fill(struct random *r, double *x, int n)
{
    for (int i = 0; i < n; i++) x[i] = random_uniform(r, -1, 1);
}

/* Symmetric, with a diagonal that dominates: positive definite, full storage. */
static void positive(struct random *r, int c, double *A)
{
    for (int i = 0; i < c; i++)
        for (int j = 0; j <= i; j++)
            A[i * c + j] = A[j * c + i] = random_uniform(r, -1, 1) + (i == j ? c + 1 : 0);
}

static void pack(int c, const double *A, double *packed)
{
    for (int i = 0; i < c; i++)
        for (int j = 0; j <= i; j++) packed[packed_index(i, j)] = A[i * c + j];
}

static void packed_matrices_have_one_place_for_each_pair(void **state)
{
    (void)state;
    int next = 0;
    for (int i = 0; i < 7; i++)
        for (int j = 0; j <= i; j++) assert_int_equal(packed_index(i, j), next++);
    for (int c = 0; c < 8; c++) {
        assert_int_equal(packed_size(c), packed_index(c, 0));
        /* sums over what an elimination does, column by column */
        int factor = 0, substitution = 0;
        for (int k = 0; k < c; k++) factor += (k + 1) * (k + 1), substitution += 2 * k + 1;
        assert_int_equal(dense_factor_flops(c), factor);
        assert_int_equal(dense_triangular_flops(c, 3), 3 * substitution);
    }
    assert_int_equal(dense_product_flops(4, 3, 5), 4 * 3 * (5 + 4));
    assert_int_equal(dense_symmetric_flops(4, 5), 10 * (5 + 4));
    assert_int_equal(dense_product_flops(4, 3, 0), 0);
    assert_int_equal(dense_symmetric_flops(4, 0), 0);
}

/* A factor by hand: A = [4 2; 2 10], L = [1; 1/2 1], D = (4, 9). */
static void a_factor_has_the_inverse_pivots_on_its_diagonal(void **state)
{
    (void)state;
    const double A[3] = {4, 2, 10};
    double G[3], B[2] = {8, 13};
    struct work w = {0};
    assert_true(dense_factor(2, A, G, &w));
    assert_true(G[0] == 0.25 && G[1] == 0.5 && G[2] == 1.0 / 9);
    dense_forward(2, 1, G, B, &w);
    assert_true(B[0] == 8 && B[1] == 9);
    dense_scale(2, 1, G, B, &w);
    assert_true(B[0] == 2 && B[1] == 1);
    dense_backward(2, 1, G, B, &w);
    assert_true(B[0] == 1.5 && B[1] == 1);
}

static void each_operator_costs_what_its_header_says(void **state)
{
    (void)state;
    struct random r = random_make(31, 0, 0);
    for (int c = 1; c <= 6; c++)
        for (int m = 1; m <= 3; m++) {
            double A[36], G[21], B[18], C[36], a[9] = {0}, b[9] = {0};
            struct work w = {0};
            positive(&r, c, A), pack(c, A, G), fill(&r, B, c * m);
            assert_true(dense_factor(c, G, G, &w));
            assert_int_equal(w.flop + w.div, dense_factor_flops(c));
            assert_int_equal(w.div, c);
            assert_int_equal(w.call, 1);
            w = (struct work){0}, dense_forward(c, m, G, B, &w), dense_scale(c, m, G, B, &w);
            assert_int_equal(w.flop, dense_triangular_flops(c, m));
            assert_int_equal(w.div, 0);
            w = (struct work){0}, dense_scale(c, m, G, B, &w);
            assert_int_equal(w.flop, c * m);
            w = (struct work){0}, dense_backward(c, m, G, B, &w);
            assert_int_equal(w.flop, c * (c - 1) * m);
            w = (struct work){0}, dense_solve(c, m, G, B, &w);
            assert_int_equal(w.flop, 2 * dense_triangular_flops(c, m) - c * m);
            w = (struct work){0}, dense_product_tn(c, c, m, A, A, C, &w);
            assert_int_equal(w.flop, c * c * (2 * m - 1));
            assert_int_equal(w.call, 1);
            w = (struct work){0}, dense_subtract(9, a, b, &w);
            assert_int_equal(w.flop, 9);
            w = (struct work){0};
            assert_true(dense_invert(c, A, &w));
            assert_int_equal(w.div, c);
            assert_int_equal(w.call, 1);
            positive(&r, c, A), w = (struct work){0};
            assert_true(dense_solve_general(c, m, A, B, &w));
            assert_int_equal(w.flop + w.div, 2 * c * c * c / 3 + 2 * c * c * m);
            assert_int_equal(w.div, c);
        }
}

static void no_matrix_without_its_pivots_is_inverted(void **state)
{
    (void)state;
    static const double wrong[][4] = {{0, 1, 1, 0},   {1, 2, 2, 4},        {1, 1, 1, 1},
                                      {NAN, 0, 0, 1}, {INFINITY, 0, 0, 1}, {1, 0, 0, -INFINITY},
                                      {1, 0, 0, NAN}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        double A[4];
        struct work w = {0};
        memcpy(A, wrong[k], sizeof A);
        if (dense_invert(2, A, &w)) fail_msg("matrix %d has been inverted", (int)k);
    }
    /* neither symmetric nor definite, but with its pivots: [2 1; 1 -1]^-1 = [1 1; 1 -2] / 3 */
    double A[4] = {2, 1, 1, -1};
    struct work w = {0};
    assert_true(dense_invert(2, A, &w));
    assert_near(A[0], 1.0 / 3, 1e-15), assert_near(A[1], 1.0 / 3, 1e-15);
    assert_near(A[2], 1.0 / 3, 1e-15), assert_near(A[3], -2.0 / 3, 1e-15);
}

static void a_general_system_without_a_pivot_is_refused(void **state)
{
    (void)state;
    double zero[4] = {0}, column[9] = {1, 0, 2, 3, 0, 4, 5, 0, 6}, number[1] = {NAN};
    double b[3] = {1, 1, 1}, swap[4] = {0, 2, 4, 0}, x[2] = {6, 8};
    struct work w = {0};
    assert_false(dense_solve_general(2, 1, zero, b, &w));
    assert_false(dense_solve_general(3, 1, column, b, &w));
    assert_false(dense_solve_general(1, 1, number, b, &w));
    assert_true(dense_solve_general(2, 1, swap, x, &w));
    assert_true(x[0] == 2 && x[1] == 3);
}

static void a_row_that_is_not_definite_is_refused_in_every_size(void **state)
{
    (void)state;
    static const int size[][3] = {{5, 5, 5}, {5, 0, 5}, {5, 5, 0}, {3, 3, 3}, {2, 4, 1}, {1, 0, 0}};
    for (size_t k = 0; k < sizeof size / sizeof *size; k++)
        for (int m = 1; m <= 2; m++) {
            const int c = size[k][0], nl = size[k][1], nu = size[k][2];
            double D[21] = {0}, L[36] = {0}, U[36] = {0}, r[12] = {0}, factor[100], y[12];
            double to_a[80], to_b[80];
            struct work w = {0};
            for (int i = 0; i < c; i++) D[packed_index(i, i)] = 1;
            assert_true(block_row_eliminate(c, nl, nu, m, D, L, U, r, factor, y, to_a, to_b, &w));
            D[packed_index(c - 1, c - 1)] = 0;
            assert_false(block_row_eliminate(c, nl, nu, m, D, L, U, r, factor, y, to_a, to_b, &w));
            D[packed_index(c - 1, c - 1)] = NAN;
            assert_false(block_row_eliminate(c, nl, nu, m, D, L, U, r, factor, y, to_a, to_b, &w));
        }
}

/* The costs of block_row.h: those named in it, then all orders by its formulas. */
static void rows_cost_what_their_header_says(void **state)
{
    (void)state;
    double D[21] = {0}, L[36] = {0}, r[18] = {0}, factor[100], y[18], to_a[90], to_b[90];
    for (int i = 0; i < 6; i++) D[packed_index(i, i)] = 1;
    struct work two = {0}, one = {0};
    assert_true(block_row_eliminate(5, 5, 5, 1, D, L, L, r, factor, y, to_a, to_b, &two));
    assert_true(block_row_eliminate(5, 5, 0, 1, D, L, NULL, r, factor, y, to_a, NULL, &one));
    assert_int_equal(two.flop + two.div, 915);
    assert_int_equal(one.flop + one.div, 385);
    for (int k = 0; k < 7 * 7 * 7; k++) {
        const int c = k % 7, nl = k / 7 % 7, nu = k / 49, m = 2;
        struct work w = {0}, again = {0}, back = {0};
        assert_true(block_row_eliminate(c, nl, nu, m, D, L, L, r, factor, y, to_a, to_b, &w));
        block_row_reduce(c, nl, nu, m, factor, r, y, to_a, to_b, &again);
        block_row_resubstitute(c, nl, nu, m, factor, y, r, r, &back);
        int flops = dense_factor_flops(c) + dense_triangular_flops(c, m);
        flops += dense_triangular_flops(c, nl + nu) + dense_symmetric_flops(nl, c);
        flops += dense_symmetric_flops(nu, c) + dense_product_flops(nl + nu, m, c);
        flops += dense_product_flops(nu, nl, c);
        assert_int_equal(w.flop + w.div, flops);
        assert_int_equal(again.flop,
                         dense_triangular_flops(c, m) + dense_product_flops(nl + nu, m, c));
        assert_int_equal(back.flop,
                         c * (c - 1) * m +
                             (nl + nu > 0 ? dense_product_flops(c, m, nl + nu) + 2 * c * m : 0));
    }
}

/* Rows of no unknowns cut a system in two; a system of no rows is solved at once. */
static void empty_rows_cut_a_system_in_two(void **state)
{
    (void)state;
    static const unsigned char size[5] = {2, 2, 0, 1, 1};
    struct arena *a = arena_create();
    struct block_tridiag t = block_tridiag_make(a, 5, size), none = block_tridiag_make(a, 0, size);
    struct work w = {0};
    double x[5 * 6] = {0};
    for (int i = 0; i < 5 * BLOCK_PACKED; i++) assert_true(t.D[i] == 0);
    for (int i = 0; i < 5 * BLOCK_FULL; i++) assert_true(t.L[i] == 0);
    assert_int_equal(block_tridiag_factor(&none, &w), -1);
    block_tridiag_solve(&none, 1, x, &w);
    assert_int_equal(w.flop + w.div + w.call, 0);
    /* [2 0 | 1 0; 0 2 | 0 1; .. | 2 0; .. | 0 2] and [4 2; 2 4], by hand */
    for (int i = 0; i < 2; i++) {
        t.D[i * BLOCK_PACKED] = t.D[i * BLOCK_PACKED + 2] = 2;
        t.D[(3 + i) * BLOCK_PACKED] = 4;
        t.L[BLOCK_FULL + 3 * i] = 1;
    }
    t.L[4 * BLOCK_FULL] = 2;
    x[0] = 4, x[1] = 5, x[6] = 5, x[7] = 4, x[18] = 10, x[24] = 8;
    assert_int_equal(block_tridiag_factor(&t, &w), -1);
    block_tridiag_solve(&t, 1, x, &w);
    assert_near(x[0], 1, 1e-15), assert_near(x[1], 2, 1e-15);
    assert_near(x[6], 2, 1e-15), assert_near(x[7], 1, 1e-15);
    assert_near(x[18], 2, 1e-15), assert_near(x[24], 1, 1e-15);
    arena_destroy(a);
}

static void the_first_row_and_the_last_are_named_when_they_are_bad(void **state)
{
    (void)state;
    static const unsigned char size[4] = {1, 2, 1, 3};
    for (int bad = 0; bad < 4; bad++) {
        struct arena *a = arena_create();
        struct block_tridiag t = block_tridiag_make(a, 4, size);
        struct work w = {0};
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < size[i]; k++)
                t.D[i * BLOCK_PACKED + packed_index(k, k)] =
                    i == bad && k == size[i] - 1 ? -1e-300 : 1;
        assert_int_equal(block_tridiag_factor(&t, &w), bad);
        arena_destroy(a);
    }
}

/* --- eigenvalues and least norms --- */

static void eigenvectors_rebuild_their_matrix(void **state)
{
    (void)state;
    struct random r = random_make(32, 0, 0);
    for (int n = 1; n <= 14; n++) {
        double a[196], kept[196], v[196], w[14], trace = 0, sum = 0, alone[14];
        struct work done = {0};
        positive(&r, n, a);
        for (int i = 0; i < n; i++) a[i * n + i] -= n + 1, trace += a[i * n + i];
        memcpy(kept, a, sizeof a);
        assert_true(eigen_symmetric(n, a, v, w, &done) < 12);
        for (int i = 0; i < n; i++) sum += w[i];
        assert_near(sum, trace, 1e-13);
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) {
                double x = 0;
                for (int k = 0; k < n; k++) x += v[i * n + k] * w[k] * v[j * n + k];
                assert_near(x, kept[i * n + j], 1e-13);
            }
        /* without vectors the values are the same bits, for less work */
        struct work less = {0};
        eigen_symmetric(n, kept, NULL, alone, &less);
        assert_memory_equal(alone, w, sizeof *w * (size_t)n);
        assert_true(n == 1 ? less.flop == done.flop : less.flop < done.flop);
        assert_int_equal(less.div, done.div);
    }
}

static void diagonal_matrices_need_no_sweep_and_no_number_ends(void **state)
{
    (void)state;
    double diagonal[9] = {3, 0, 0, 0, -1, 0, 0, 0, 2}, v[9], w[3];
    struct work done = {0};
    assert_int_equal(eigen_symmetric(3, diagonal, v, w, &done), 0);
    assert_true(w[0] == 3 && w[1] == -1 && w[2] == 2);
    for (int i = 0; i < 9; i++) assert_true(v[i] == (i % 4 == 0));
    assert_int_equal(eigen_symmetric(0, diagonal, v, w, &done), 0);
    double wrong[4] = {NAN, NAN, NAN, NAN};
    assert_true(eigen_symmetric(2, wrong, v, w, &done) <= 60);
    /* equal elements on the diagonal turn by an eighth: values 5 and -1 */
    double equal[4] = {2, 3, 3, 2};
    eigen_symmetric(2, equal, v, w, &done);
    assert_near(fmax(w[0], w[1]), 5, 1e-15), assert_near(fmin(w[0], w[1]), -1, 1e-15);
    assert_near(fabs(v[0]), sqrt(0.5), 1e-15);
}

/* least_norm.h: eigenvalues above 1e-10 max(largest, 1) count. */
static void the_rank_changes_at_the_stated_share(void **state)
{
    (void)state;
    static const struct {
        double first, second;
        int rank;
    } row[] = {{1, 2e-10, 2},    {1, 0.5e-10, 1},    {100, 2e-8, 2}, {100, 0.5e-8, 1},
               {0.01, 2e-10, 2}, {0.01, 0.5e-10, 1}, {0, 0, 0},      {1, -1, 1}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        double s[4] = {row[k].first, 0, 0, row[k].second}, r[2] = {1, 1}, room[8];
        const double reference[2] = {1, 1};
        struct work w = {0};
        assert_int_equal(least_norm_solve(2, reference, s, r, room, &w), row[k].rank);
        assert_near(r[0], row[k].rank > 0 ? 1 / row[k].first : 0, 1e-12 * fabs(r[0]));
        assert_near(r[1], row[k].rank > 1 ? 1 / row[k].second : 0, 1e-12 * fabs(r[1]));
        assert_int_equal(w.call, 1);
    }
}

/* Constraints in other units, S -> U S U, r -> U r: the rank stays, and x becomes U^-1 x. */
static void units_of_constraints_change_no_answer(void **state)
{
    (void)state;
    struct random rnd = random_make(33, 0, 0);
    for (int trial = 0; trial < 20; trial++) {
        enum { N = 4, RANK = 2 };
        double b[N * RANK], s[N * N], t[N * N], unit[N], r[N], q[N], room[N * N + 2 * N];
        double reference[N], scaled[N];
        struct work w = {0};
        fill(&rnd, b, N * RANK), fill(&rnd, r, N);
        for (int i = 0; i < N; i++) {
            unit[i] = ldexp(1, (int)random_below(&rnd, 40) - 20);
            reference[i] = 1 + i, scaled[i] = reference[i] * unit[i] * unit[i];
            q[i] = r[i] * unit[i];
        }
        for (int i = 0; i < N * N; i++) {
            s[i] = b[i / N * 2] * b[i % N * 2] + b[i / N * 2 + 1] * b[i % N * 2 + 1];
            t[i] = s[i] * unit[i / N] * unit[i % N];
        }
        assert_int_equal(least_norm_solve(N, reference, s, r, room, &w), RANK);
        assert_int_equal(least_norm_solve(N, scaled, t, q, room, &w), RANK);
        for (int i = 0; i < N; i++) assert_near(q[i] * unit[i], r[i], 1e-9 * (fabs(r[i]) + 1));
    }
    double nothing[1] = {7};
    assert_int_equal(least_norm_solve(0, nothing, nothing, nothing, nothing, &(struct work){0}), 0);
    assert_true(nothing[0] == 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packed_matrices_have_one_place_for_each_pair),
        cmocka_unit_test(a_factor_has_the_inverse_pivots_on_its_diagonal),
        cmocka_unit_test(each_operator_costs_what_its_header_says),
        cmocka_unit_test(no_matrix_without_its_pivots_is_inverted),
        cmocka_unit_test(a_general_system_without_a_pivot_is_refused),
        cmocka_unit_test(a_row_that_is_not_definite_is_refused_in_every_size),
        cmocka_unit_test(rows_cost_what_their_header_says),
        cmocka_unit_test(empty_rows_cut_a_system_in_two),
        cmocka_unit_test(the_first_row_and_the_last_are_named_when_they_are_bad),
        cmocka_unit_test(eigenvectors_rebuild_their_matrix),
        cmocka_unit_test(diagonal_matrices_need_no_sweep_and_no_number_ends),
        cmocka_unit_test(the_rank_changes_at_the_stated_share),
        cmocka_unit_test(units_of_constraints_change_no_answer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
