/* test_blocks.c - distributed block tridiagonal solvers against block Thomas: orders 0 to 6,
 * several right-hand sides, further ones with kept factors, any split. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "../support/many_ranks.h"
#include "base/random.h"
#include "kernel/blocks.h"

enum { MOST_ROWS = 40, MOST_RHS = 4 };

/* A random system, its solutions, and what the ranks found. */
struct posed {
    struct kernel_spec spec;
    struct row_layout layout;
    int m;
    bool again; /* solve for further right-hand sides */
    int first[MOST_ROWS + 1];
    unsigned char size[MOST_ROWS], interface[MOST_ROWS];
    double D[MOST_ROWS * BLOCK_PACKED], L[MOST_ROWS * BLOCK_FULL];
    double r[2][MOST_ROWS * BLOCK_MAX * MOST_RHS], x[2][MOST_ROWS * BLOCK_MAX * MOST_RHS];
    double found[2][MOST_ROWS * BLOCK_MAX * MOST_RHS];
    double worst_left; /* largest error of the row before a block */
    struct arena *arena;
};

static double *row_of(double *all, int m, int i) { return all + i * BLOCK_MAX * m; }

/* pose: a diagonally dominant system of n rows on P ranks with blocks cut at random places. */
static void pose(struct posed *p, struct random *g, int n, int P, int m, int order)
{
    p->m = m;
    p->layout = (struct row_layout){
        .nrow = n, .nrank = P, .first = p->first, .size = p->size, .interface = p->interface};
    for (int i = 0; i < n; i++)
        p->size[i] = (unsigned char)(order >= 0 ? order : (int)random_below(g, 7));
    for (int i = 0; i < n; i++)
        p->layout.largest = p->size[i] > p->layout.largest ? p->size[i] : p->layout.largest;
    for (int k = 0; k <= P; k++) p->first[k] = k;
    for (int extra = n - P; extra > 0; extra--)
        for (int k = (int)random_below(g, (uint64_t)P) + 1; k <= P; k++) p->first[k]++;
    for (int k = 0; k < P; k++) p->interface[k] = p->size[p->first[k + 1] - 1];
    for (int i = 0; i < n; i++) {
        for (int r = 0; r < p->size[i]; r++)
            for (int c = 0; c <= r; c++)
                p->D[i * BLOCK_PACKED + packed_index(r, c)] =
                    random_uniform(g, -1, 1) + (r == c ? 9 : 0);
        for (int k = 0; k < BLOCK_FULL; k++)
            p->L[i * BLOCK_FULL + k] = random_uniform(g, -0.5, 0.5);
        for (int k = 0; k < p->size[i] * m; k++)
            for (int s = 0; s < 2; s++) row_of(p->r[s], m, i)[k] = random_uniform(g, -1, 1);
    }
}

/* reference: by block Thomas, whose rows take room for six. */
static void reference(struct posed *p)
{
    struct block_tridiag t = block_tridiag_make(p->arena, p->layout.nrow, p->size);
    struct work w = {0};
    memcpy(t.D, p->D, (size_t)p->layout.nrow * BLOCK_PACKED * sizeof(double));
    memcpy(t.L, p->L, (size_t)p->layout.nrow * BLOCK_FULL * sizeof(double));
    assert_int_equal(block_tridiag_factor(&t, &w), -1);
    for (int s = 0; s < 2; s++) {
        memcpy(p->x[s], p->r[s], sizeof p->x[s]);
        block_tridiag_solve(&t, p->m, p->x[s], &w);
    }
}

static void solve(struct comm *c, void *context)
{
    struct posed *p = context;
    struct blocks *b = arena_take(p->arena, sizeof *b);
    struct carve room = {0};
    struct work w = {0};
    const int m = p->m, rank = comm_rank(c);
    blocks_carve(b, &room, &p->spec, &p->layout, rank, m, p->again);
    room = (struct carve){.base = arena_take(p->arena, room.used)};
    memset(b, 0, sizeof *b);
    blocks_carve(b, &room, &p->spec, &p->layout, rank, m, p->again);
    b->comm = c;
    for (int pass = 0; pass <= p->again; pass++) {
        for (int i = b->lo; i < b->hi; i++) {
            const int before = i > 0 ? p->size[i - 1] : 0, n = p->size[i];
            if (pass == 0) {
                memcpy(blocks_row_D(b, i), p->D + i * BLOCK_PACKED,
                       (size_t)packed_size(n) * sizeof(double));
                memcpy(blocks_row_L(b, i), p->L + i * BLOCK_FULL,
                       (size_t)(n * before) * sizeof(double));
            }
            memcpy(blocks_row_r(b, i), row_of(p->r[pass], m, i), (size_t)(n * m) * sizeof(double));
        }
        if (pass == 0) blocks_solve(b, &w);
        else blocks_resolve(b, &w);
        for (int i = b->lo; i < b->hi; i++)
            memcpy(row_of(p->found[pass], m, i), blocks_row_r(b, i),
                   (size_t)(p->size[i] * m) * sizeof(double));
        for (int k = 0; b->lo > 0 && k < p->size[b->lo - 1] * m; k++)
            p->worst_left =
                fmax(p->worst_left, fabs(b->left[k] - row_of(p->x[pass], m, b->lo - 1)[k]));
    }
    assert_false(b->broken);
}

/* check: all numbers of all rows. */
static void check(struct posed *p, struct random *g, int n, int P, int m, int order)
{
    p->arena = arena_create();
    p->worst_left = 0;
    pose(p, g, n, P, m, order);
    reference(p);
    const struct many_ranks_result r = many_ranks_run(P, solve, p);
    assert_int_equal(r.blocked, 0);
    assert_int_equal(r.unread, 0);
    for (int pass = 0; pass <= p->again; pass++)
        for (int i = 0; i < n; i++)
            for (int k = 0; k < p->size[i] * m; k++)
                assert_true(fabs(row_of(p->found[pass], m, i)[k] - row_of(p->x[pass], m, i)[k]) <
                            1e-13);
    assert_true(p->worst_left < 1e-13);
    arena_destroy(p->arena);
}

static void every_solver(bool again, int order)
{
    static struct posed p; /* large */
    struct random g = random_make(11, again, (uint64_t)(order + 1));
    for (int solver = 0; solver <= SOLVER_THOMAS; solver++)
        for (int part = 0; part < 2; part++)
            for (int n = 1; n <= MOST_ROWS; n += n < 10 ? 1 : 10)
                for (int P = 1; P <= n; P += P < 6 ? 1 : 5)
                    for (int m = 1; m <= MOST_RHS; m += 3) {
                        if (again && solver == SOLVER_PCR) continue; /* keeps no factors */
                        memset(&p, 0, sizeof p);
                        p.again = again;
                        p.spec.solver = solver;
                        p.spec.part_solver = part ? PART_CR : PART_PCR;
                        p.spec.hybrid_levels = (n + P) % 4;
                        check(&p, &g, n, P, m, order);
                    }
}

static void blocks_of_five(void **state)
{
    (void)state;
    every_solver(false, 5);
}

static void blocks_of_all_orders(void **state)
{
    (void)state;
    every_solver(false, -1);
}

static void further_right_hand_sides(void **state)
{
    (void)state;
    every_solver(true, -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_of_five),
        cmocka_unit_test(blocks_of_all_orders),
        cmocka_unit_test(further_right_hand_sides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
