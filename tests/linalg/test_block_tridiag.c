/* test_block_tridiag.c - block elimination against dense elimination of the same system, all orders
 * of blocks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "base/random.h"
#include "linalg/block_tridiag.h"

enum { ROWS = 9, RHS = 3, FULL = ROWS * 6 };

/* A random system: its blocks, and the same as one dense matrix. */
struct made {
    unsigned char size[ROWS];
    int at[ROWS + 1];
    struct block_tridiag t;
    double dense[FULL * FULL], x[FULL * RHS], r[FULL * RHS];
};

static void make(struct made *s, struct random *g, struct arena *a)
{
    memset(s, 0, sizeof *s);
    for (int i = 0; i < ROWS; i++) {
        s->size[i] = (unsigned char)random_below(g, 7);
        s->at[i + 1] = s->at[i] + s->size[i];
    }
    const int n = s->at[ROWS];
    s->t = block_tridiag_make(a, ROWS, s->size);
    for (int i = 0; i < ROWS; i++) {
        const int before = i > 0 ? s->size[i - 1] : 0;
        for (int r = 0; r < s->size[i]; r++) {
            for (int c = 0; c <= r; c++) {
                const double v = random_uniform(g, -1, 1) + (r == c ? 8 : 0);
                s->t.D[i * BLOCK_PACKED + packed_index(r, c)] = v;
                s->dense[(s->at[i] + r) * n + s->at[i] + c] =
                    s->dense[(s->at[i] + c) * n + s->at[i] + r] = v;
            }
            for (int c = 0; c < before; c++) {
                const double v = random_uniform(g, -0.5, 0.5);
                s->t.L[i * BLOCK_FULL + r * before + c] = v;
                s->dense[(s->at[i] + r) * n + s->at[i - 1] + c] =
                    s->dense[(s->at[i - 1] + c) * n + s->at[i] + r] = v;
            }
        }
    }
    for (int i = 0; i < n * RHS; i++) s->x[i] = random_uniform(g, -1, 1);
    for (int i = 0; i < n; i++)
        for (int l = 0; l < RHS; l++)
            for (int k = 0; k < n; k++)
                s->r[i * RHS + l] += s->dense[i * n + k] * s->x[k * RHS + l];
}

static void thomas_solves_all_orders_of_blocks(void **state)
{
    (void)state;
    struct random g = random_make(5, 0, 0);
    static struct made s; /* too large for a stack; written anew in each round */
    for (int round = 0; round < 50; round++) {
        struct arena *a = arena_create();
        struct work w = {0};
        double z[ROWS * 6 * RHS] = {0};
        make(&s, &g, a);
        for (int i = 0; i < ROWS; i++)
            memcpy(z + i * 6 * RHS, s.r + s.at[i] * RHS,
                   (size_t)(s.size[i] * RHS) * sizeof(double));
        assert_int_equal(block_tridiag_factor(&s.t, &w), -1);
        block_tridiag_solve(&s.t, RHS, z, &w);
        for (int i = 0; i < ROWS; i++)
            for (int k = 0; k < s.size[i] * RHS; k++)
                assert_true(fabs(z[i * 6 * RHS + k] - s.x[s.at[i] * RHS + k]) < 1e-12);
        arena_destroy(a);
    }
}

enum { BEAM = 60 };

/* Solve S K S x = r for x, K = the second difference (condition about BEAM^2), S = diag(scale); the
 * largest error of S x against `z`. `jacobi`: scale the system to a diagonal of ones first. */
static double beam_error(const double *scale, const double *z, bool jacobi, struct arena *a)
{
    static const unsigned char size[BEAM] = {[0 ... BEAM - 1] = 1};
    struct block_tridiag t = block_tridiag_make(a, BEAM, size);
    double x[BEAM * 6] = {0}, by[BEAM], largest = 0, error = 0;
    struct work w = {0};
    for (int i = 0; i < BEAM; i++) by[i] = jacobi ? 1 / sqrt(2 * scale[i] * scale[i]) : 1;
    for (int i = 0; i < BEAM; i++) {
        __float128 r = 2 * (__float128)z[i];
        if (i > 0) r -= z[i - 1];
        if (i < BEAM - 1) r -= z[i + 1];
        t.D[i * BLOCK_PACKED] = 2 * scale[i] * scale[i] * by[i] * by[i];
        if (i > 0) t.L[i * BLOCK_FULL] = -scale[i] * scale[i - 1] * by[i] * by[i - 1];
        x[6 * i] = (double)(r * scale[i]) * by[i];
    }
    assert_int_equal(block_tridiag_factor(&t, &w), -1);
    block_tridiag_solve(&t, 1, x, &w);
    for (int i = 0; i < BEAM; i++) {
        error = fmax(error, fabs(x[6 * i] * by[i] * scale[i] - z[i]));
        largest = fmax(largest, fabs(z[i]));
    }
    return error / largest;
}

/* Scaling a system whose unknowns differ by sixteen decades neither helps nor harms: elimination is
 * invariant to it. */
static void scaling_by_the_diagonal_changes_no_error(void **state)
{
    (void)state;
    struct random g = random_make(8, 0, 0);
    double plain = 0, scaled = 0;
    for (int round = 0; round < 40; round++) {
        struct arena *a = arena_create();
        double scale[BEAM], z[BEAM];
        for (int i = 0; i < BEAM; i++)
            scale[i] = pow(10, random_uniform(&g, -8, 8)), z[i] = random_uniform(&g, -1, 1);
        plain += log(beam_error(scale, z, false, a));
        scaled += log(beam_error(scale, z, true, a));
        arena_destroy(a);
    }
    assert_true(plain < 40 * log(1e-11)); /* the condition seen without scaling is 1e16 and more */
    assert_true(fabs(plain - scaled) < 40 * log(2));
}

static void a_row_of_five_costs_480(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    static const unsigned char size[8] = {5, 5, 5, 5, 5, 5, 5, 5};
    struct block_tridiag t = block_tridiag_make(a, 8, size);
    struct work w = {0}, less = {0};
    double x[8 * 6] = {0};
    for (int pass = 0; pass < 2; pass++) { /* with 8 rows and with 7 */
        for (int i = 0; i < 8; i++)
            for (int k = 0; k < 15; k++) t.D[i * BLOCK_PACKED + k] = 0;
        for (int i = 0; i < 8; i++)
            for (int k = 0; k < 5; k++) t.D[i * BLOCK_PACKED + packed_index(k, k)] = 1;
        t.nrow = 8 - pass;
        struct work *to = pass ? &less : &w;
        assert_int_equal(block_tridiag_factor(&t, to), -1);
        block_tridiag_solve(&t, 1, x, to);
    }
    assert_int_equal(w.flop + w.div - less.flop - less.div, 480);
    arena_destroy(a);
}

static void the_first_bad_row_is_named(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    static const unsigned char size[3] = {1, 1, 1};
    struct block_tridiag t = block_tridiag_make(a, 3, size);
    struct work w = {0};
    t.D[0] = t.D[2 * BLOCK_PACKED] = 1;
    t.D[BLOCK_PACKED] = 0.25;
    t.L[BLOCK_FULL] = 0.5;
    assert_int_equal(block_tridiag_factor(&t, &w), 1);
    arena_destroy(a);
}

enum { M = 2 };

/* One row with its neighbours' couplings, what eliminating it gave, and D^-1 [L U r] by dense
 * elimination. */
struct eliminated {
    int c, nl, nu, width;
    double D[21], L[36], U[36], r[12], factor[100], y[12], to_a[80], to_b[80];
    double inverse_times[6 * 14], schur[12 * 14];
};

/* eliminate_random: fill *e; schur is [L U]^T D^-1 [L U r]. */
static void eliminate_random(struct eliminated *e, int c, int nl, int nu, struct random *g)
{
    double full[36];
    struct work w = {0};
    *e = (struct eliminated){.c = c, .nl = nl, .nu = nu, .width = nl + nu + M};
    for (int i = 0; i < c; i++)
        for (int j = 0; j <= i; j++)
            full[i * c + j] = full[j * c + i] = e->D[packed_index(i, j)] =
                random_uniform(g, -1, 1) + (i == j ? 7 : 0);
    for (int i = 0; i < c * nl; i++) e->L[i] = random_uniform(g, -1, 1);
    for (int i = 0; i < c * nu; i++) e->U[i] = random_uniform(g, -1, 1);
    for (int i = 0; i < c * M; i++) e->r[i] = random_uniform(g, -1, 1);
    assert_true(block_row_eliminate(c, nl, nu, M, e->D, e->L, e->U, e->r, e->factor, e->y, e->to_a,
                                    e->to_b, &w));
    for (int i = 0; i < c; i++)
        for (int j = 0; j < e->width; j++)
            e->inverse_times[i * e->width + j] = j < nl        ? e->L[i * nl + j]
                                                 : j < nl + nu ? e->U[i * nu + j - nl]
                                                               : e->r[i * M + j - nl - nu];
    if (c > 0) assert_true(dense_solve_general(c, e->width, full, e->inverse_times, &w));
    for (int i = 0; i < nl + nu; i++)
        for (int j = 0; j < e->width; j++)
            for (int k = 0; k < c; k++)
                e->schur[i * e->width + j] += (i < nl ? e->L[k * nl + i] : e->U[k * nu + i - nl]) *
                                              e->inverse_times[k * e->width + j];
}

/* check_side: S and v of the n neighbour's unknowns that begin at row `first` of the Schur
 * complement. */
static void check_side(const struct eliminated *e, int n, int first, const double *update)
{
    for (int i = 0; i < n; i++) {
        const double *row = e->schur + (first + i) * e->width;
        for (int j = 0; j <= i; j++)
            assert_true(fabs(update[packed_index(i, j)] - row[first + j]) < 1e-13);
        for (int j = 0; j < M; j++)
            assert_true(fabs(update[packed_size(n) + i * M + j] - row[e->nl + e->nu + j]) < 1e-13);
    }
}

static void eliminating_a_row_leaves_the_neighbours_schur_complement(void **state)
{
    (void)state;
    struct random g = random_make(6, 0, 0);
    struct eliminated e;
    for (int size = 0; size < 7 * 7 * 7; size++) {
        eliminate_random(&e, size % 7, size / 7 % 7, size / 49, &g);
        check_side(&e, e.nl, 0, e.to_a);
        check_side(&e, e.nu, e.nl, e.to_b);
        for (int i = 0; i < e.nu; i++)
            for (int j = 0; j < e.nl; j++) {
                const double E = e.to_b[block_update_size(e.nu, M) + i * e.nl + j];
                assert_true(fabs(E + e.schur[(e.nl + i) * e.width + j]) < 1e-13);
                assert_true(E == e.to_a[block_update_size(e.nl, M) + j * e.nu + i]);
            }
    }
}

static void a_stored_factor_serves_further_right_hand_sides(void **state)
{
    (void)state;
    struct random g = random_make(7, 0, 0);
    struct eliminated e;
    for (int size = 0; size < 7 * 7 * 7; size++) {
        double again[12], v_a[12], v_b[12], x_a[12], x_b[12];
        struct work w = {0};
        eliminate_random(&e, size % 7, size / 7 % 7, size / 49, &g);
        block_row_reduce(e.c, e.nl, e.nu, M, e.factor, e.r, again, v_a, v_b, &w);
        for (int i = 0; i < e.nl * M; i++) assert_true(v_a[i] == e.to_a[packed_size(e.nl) + i]);
        for (int i = 0; i < e.nu * M; i++) assert_true(v_b[i] == e.to_b[packed_size(e.nu) + i]);
        for (int i = 0; i < e.nl * M; i++) x_a[i] = random_uniform(&g, -1, 1);
        for (int i = 0; i < e.nu * M; i++) x_b[i] = random_uniform(&g, -1, 1);
        /* D^-1 (r - L x_a - U x_b) */
        block_row_resubstitute(e.c, e.nl, e.nu, M, e.factor, again, x_a, x_b, &w);
        for (int i = 0; i < e.c; i++)
            for (int l = 0; l < M; l++) {
                double x = e.inverse_times[i * e.width + e.nl + e.nu + l];
                for (int j = 0; j < e.nl; j++)
                    x -= e.inverse_times[i * e.width + j] * x_a[j * M + l];
                for (int j = 0; j < e.nu; j++)
                    x -= e.inverse_times[i * e.width + e.nl + j] * x_b[j * M + l];
                assert_true(fabs(again[i * M + l] - x) < 1e-12);
            }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thomas_solves_all_orders_of_blocks),
        cmocka_unit_test(scaling_by_the_diagonal_changes_no_error),
        cmocka_unit_test(a_row_of_five_costs_480),
        cmocka_unit_test(the_first_bad_row_is_named),
        cmocka_unit_test(eliminating_a_row_leaves_the_neighbours_schur_complement),
        cmocka_unit_test(a_stored_factor_serves_further_right_hand_sides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
