/* test_block_tridiag.c - block elimination against dense elimination of the same system, all orders of blocks. */
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
                s->dense[(s->at[i] + r) * n + s->at[i] + c] = s->dense[(s->at[i] + c) * n + s->at[i] + r] = v;
            }
            for (int c = 0; c < before; c++) {
                const double v = random_uniform(g, -0.5, 0.5);
                s->t.L[i * BLOCK_FULL + r * before + c] = v;
                s->dense[(s->at[i] + r) * n + s->at[i - 1] + c] = s->dense[(s->at[i - 1] + c) * n + s->at[i] + r] = v;
            }
        }
    }
    for (int i = 0; i < n * RHS; i++) s->x[i] = random_uniform(g, -1, 1);
    for (int i = 0; i < n; i++)
        for (int l = 0; l < RHS; l++)
            for (int k = 0; k < n; k++) s->r[i * RHS + l] += s->dense[i * n + k] * s->x[k * RHS + l];
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
            memcpy(z + i * 6 * RHS, s.r + s.at[i] * RHS, (size_t)(s.size[i] * RHS) * sizeof(double));
        assert_int_equal(block_tridiag_factor(&s.t, &w), -1);
        block_tridiag_solve(&s.t, RHS, z, &w);
        for (int i = 0; i < ROWS; i++)
            for (int k = 0; k < s.size[i] * RHS; k++)
                assert_true(fabs(z[i * 6 * RHS + k] - s.x[s.at[i] * RHS + k]) < 1e-12);
        arena_destroy(a);
    }
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

static void eliminating_a_row_leaves_the_neighbours_schur_complement(void **state)
{
    (void)state;
    struct random g = random_make(6, 0, 0);
    for (int c = 0; c <= 6; c++)
        for (int nl = 0; nl <= 6; nl++)
            for (int nu = 0; nu <= 6; nu++) {
                enum { M = 2 };
                const int width = nl + nu + M;
                double D[21], full[36], L[36], U[36], r[12], B[6 * 14], rest[12 * 14];
                double factor[100], y[12], to_a[80], to_b[80], v_a[12], v_b[12], again[12];
                struct work w = {0};
                for (int i = 0; i < c; i++)
                    for (int j = 0; j <= i; j++)
                        full[i * c + j] = full[j * c + i] = D[packed_index(i, j)] =
                            random_uniform(&g, -1, 1) + (i == j ? 7 : 0);
                for (int i = 0; i < c * nl; i++) L[i] = random_uniform(&g, -1, 1);
                for (int i = 0; i < c * nu; i++) U[i] = random_uniform(&g, -1, 1);
                for (int i = 0; i < c * M; i++) r[i] = random_uniform(&g, -1, 1);
                assert_true(block_row_eliminate(c, nl, nu, M, D, L, U, r, factor, y, to_a, to_b, &w));
                for (int i = 0; i < c; i++) { /* B = D^-1 [L U r] */
                    for (int j = 0; j < nl; j++) B[i * width + j] = L[i * nl + j];
                    for (int j = 0; j < nu; j++) B[i * width + nl + j] = U[i * nu + j];
                    for (int j = 0; j < M; j++) B[i * width + nl + nu + j] = r[i * M + j];
                }
                if (c > 0) assert_true(dense_solve_general(c, width, full, B, &w));
                for (int i = 0; i < nl + nu; i++)
                    for (int j = 0; j < width; j++) {
                        rest[i * width + j] = 0;
                        for (int k = 0; k < c; k++)
                            rest[i * width + j] += (i < nl ? L[k * nl + i] : U[k * nu + i - nl]) * B[k * width + j];
                    }
                for (int i = 0; i < nl; i++) {
                    for (int j = 0; j <= i; j++) assert_true(fabs(to_a[packed_index(i, j)] - rest[i * width + j]) < 1e-13);
                    for (int j = 0; j < M; j++)
                        assert_true(fabs(to_a[packed_size(nl) + i * M + j] - rest[i * width + nl + nu + j]) < 1e-13);
                }
                for (int i = 0; i < nu; i++) {
                    for (int j = 0; j <= i; j++)
                        assert_true(fabs(to_b[packed_index(i, j)] - rest[(nl + i) * width + nl + j]) < 1e-13);
                    for (int j = 0; j < nl; j++) {
                        const double E = to_b[block_update_size(nu, M) + i * nl + j];
                        assert_true(fabs(E + rest[(nl + i) * width + j]) < 1e-13);
                        assert_true(nl == 0 || E == to_a[block_update_size(nl, M) + j * nu + i]);
                    }
                }
                block_row_reduce(c, nl, nu, M, factor, r, again, v_a, v_b, &w);
                for (int i = 0; i < nl * M; i++) assert_true(v_a[i] == to_a[packed_size(nl) + i]);
                for (int i = 0; i < nu * M; i++) assert_true(v_b[i] == to_b[packed_size(nu) + i]);
                double x_a[12], x_b[12]; /* x = D^-1 (r - L x_a - U x_b) */
                for (int i = 0; i < nl * M; i++) x_a[i] = random_uniform(&g, -1, 1);
                for (int i = 0; i < nu * M; i++) x_b[i] = random_uniform(&g, -1, 1);
                block_row_resubstitute(c, nl, nu, M, factor, y, x_a, x_b, &w);
                for (int i = 0; i < c; i++)
                    for (int l = 0; l < M; l++) {
                        double x = B[i * width + nl + nu + l];
                        for (int j = 0; j < nl; j++) x -= B[i * width + j] * x_a[j * M + l];
                        for (int j = 0; j < nu; j++) x -= B[i * width + nl + j] * x_b[j * M + l];
                        assert_true(fabs(y[i * M + l] - x) < 1e-12);
                    }
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thomas_solves_all_orders_of_blocks),
        cmocka_unit_test(a_row_of_five_costs_480),
        cmocka_unit_test(the_first_bad_row_is_named),
        cmocka_unit_test(eliminating_a_row_leaves_the_neighbours_schur_complement),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
