/* test_plan.c - plans of random trees carried out step by step on a plain forest: each operation
 * may happen when its turn comes, those of a round do not touch each other, and all are done at the
 * end; lists and ancestors against their definitions; rows of a reduction. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "kernel/blocks.h"
#include "kernel/carve.h"
#include "kernel/tree_plan.h"

enum { MOST = 120 };

enum shape { CHAIN, STAR, RANDOM, FOREST, COMB, BINARY, SHAPES };

static int parent_of(enum shape shape, int i, struct random *r)
{
    if (i == 0) return -1;
    switch (shape) {
    case CHAIN:
        return i - 1;
    case STAR:
        return 0;
    case RANDOM:
        return (int)random_below(r, (uint64_t)i);
    case FOREST:
        return (int)random_below(r, (uint64_t)i + 3) - 3 < 0 ? -1
                                                             : (int)random_below(r, (uint64_t)i);
    case COMB:
        return i % 2 ? i - 1 : i - 2;
    default:
        return (i - 1) / 2;
    }
}

static struct model *tree(enum shape shape, int n, struct random *r, struct arena *a)
{
    struct err e;
    err_clear(&e);
    struct model *m = model_begin(a, NULL);
    for (int i = 0; i < n; i++) {
        const struct body_def b = {.name = "body",
                                   .parent = parent_of(shape, i, r),
                                   .joint = JOINT_REVOLUTE,
                                   .axis = {0, 0, 1},
                                   .placement.quat = {0, 0, 0, 1},
                                   .mass = 1,
                                   .inertia = {1, 0, 0, 1, 0, 1}};
        assert_true(model_add_body(m, &b, &e) >= 0);
    }
    if (!model_finish(m, false, &e)) fail_msg("%s", e.text);
    return m;
}

/* --- lists and ancestors --- */

/* k's items are exactly the i with key[i] = k, ascending. */
static void check_lists(const struct tree_lists *l, int nkey, int n, const int *key)
{
    for (int k = 0; k < nkey; k++) {
        int at = l->at[k];
        for (int i = 0; i < n; i++)
            if (key[i] == k) {
                assert_true(at < l->at[k + 1]);
                assert_int_equal(l->item[at++], i);
            }
        assert_int_equal(at, l->at[k + 1]);
    }
}

static void check_pieces(const struct tree_plan *p, const struct model *m)
{
    int key[MOST];
    check_lists(&p->bodies, p->nrank, p->nbody, p->owner);
    for (int i = 0; i < p->nbody; i++) {
        /* place among its owner's */
        int before = 0;
        for (int k = 0; k < i; k++) before += p->owner[k] == p->owner[i];
        assert_int_equal(p->local[i], before);
        /* a body hangs in its piece, or at the piece's anchor, which is another piece's body */
        const int k = p->owner[i], parent = m->body[i].parent;
        if (parent < 0 || p->owner[parent] != k) assert_int_equal(p->anchor[k], parent);
    }
    for (int k = 0; k < p->npiece; k++) {
        assert_int_equal(p->parent[k], p->anchor[k] < 0 ? -1 : p->owner[p->anchor[k]]);
        assert_true(p->parent[k] < k); /* numbered from the base on */
        assert_true(p->bodies.at[k + 1] > p->bodies.at[k]);
    }
    check_lists(&p->kids, p->npiece, p->npiece, p->parent);
    for (int j = 0; j < p->nlevel; j++) {
        for (int k = 0; k < p->npiece; k++) {
            int up = k;
            for (int step = 0; step < 1 << j && up >= 0; step++) up = p->parent[up];
            assert_int_equal(tree_plan_ancestor(p, j, k), up);
            key[k] = up >= 0 && p->anchor[up] >= 0 ? up : -1;
        }
        check_lists(&p->descendants[j], p->npiece, p->npiece, key);
    }
}

/* --- the contraction, carried out --- */

struct forest {
    int up[MOST];  /* parent compound; -1: the base */
    int top[MOST]; /* the compound that a body belongs to */
    bool alive[MOST];
    int rounds[MOST]; /* last round in which the compound took part in a merge, or was raked */
};

static int children(const struct forest *f, int n, int u)
{
    int count = 0;
    for (int i = 0; i < n; i++) count += f->alive[i] && f->up[i] == u;
    return count;
}

/* v becomes part of u. */
static void unite(struct forest *f, int n, int u, int v)
{
    f->alive[v] = false;
    for (int i = 0; i < n; i++) {
        if (f->alive[i] && f->up[i] == v) f->up[i] = u;
        if (f->top[i] == v) f->top[i] = u;
    }
}

static void carry_out(const struct tree_plan *p, const struct tree_op *op, struct forest *f)
{
    const int n = p->nbody, u = op->into;
    assert_true(f->alive[u]);
    assert_int_equal(op->to, p->owner[u]);
    assert_true(op->count >= 1);
    assert_true(op->kind == TREE_RAKE || op->count == 1);
    for (int l = 0; l < op->count; l++) {
        const int v = p->absorbed[op->first + l];
        assert_true(f->alive[v]);
        assert_int_equal(f->up[v], u);
        assert_int_equal(op->from, p->owner[v]); /* one message has one sender */
        if (op->kind == TREE_RAKE) assert_int_equal(children(f, n, v), 0);
        else assert_int_equal(children(f, n, u), 1);
        /* in a round compounds are merged once: pairs are independent of each other */
        if (op->round > 0 && op->kind == TREE_MERGE) {
            assert_true(f->rounds[u] < op->round && f->rounds[v] < op->round);
            f->rounds[u] = f->rounds[v] = op->round;
        }
        if (op->round == 0) assert_int_equal(op->from, op->to);
        unite(f, n, u, v);
    }
}

static void check_contraction(const struct tree_plan *p, const struct model *m)
{
    static struct forest f;
    const int n = p->nbody;
    int absorbed = 0, last = 0, roots = 0;
    memset(&f, 0, sizeof f);
    for (int i = 0; i < n; i++) f.up[i] = m->body[i].parent, f.top[i] = i, f.alive[i] = true;
    for (int k = 0; k < p->nop; k++) {
        assert_true(p->op[k].round >= last && p->op[k].round <= p->nround);
        assert_int_equal(p->op[k].first, absorbed);
        last = p->op[k].round;
        absorbed += p->op[k].count;
        carry_out(p, &p->op[k], &f);
    }
    /* every body but those on the base has vanished, and the last round was not in vain */
    assert_int_equal(last, p->nround);
    for (int i = 0; i < n; i++) {
        assert_int_equal(f.alive[i], m->body[i].parent < 0);
        roots += m->body[i].parent < 0;
        if (f.alive[i]) assert_int_equal(p->root[roots - 1], i);
    }
    assert_int_equal(p->nroot, roots);
    assert_int_equal(absorbed, n - roots);
    /* each rank's list: the operations with its name on either side, in the order of all */
    for (int r = 0; r < p->nrank; r++) {
        int at = p->ops.at[r];
        for (int k = 0; k < p->nop; k++)
            if (p->op[k].from == r || p->op[k].to == r) {
                assert_true(at < p->ops.at[r + 1]);
                assert_int_equal(p->ops.item[at++], k);
            }
        assert_int_equal(at, p->ops.at[r + 1]);
    }
}

static void plans_can_be_carried_out(void **state)
{
    (void)state;
    struct random r = random_make(61, 0, 0);
    static const int sizes[] = {1, 2, 3, 5, 8, 17, 40, MOST};
    for (int shape = 0; shape < SHAPES; shape++)
        for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
            const int n = sizes[s], ranks[] = {1, 2, 3, n / 2, n - 1, n};
            struct arena *a = arena_create();
            const struct model *m = tree((enum shape)shape, n, &r, a);
            for (size_t k = 0; k < sizeof ranks / sizeof *ranks; k++) {
                if (ranks[k] < 1 || ranks[k] > n) continue;
                const struct tree_plan *p = tree_plan_make(m, ranks[k], a);
                const int limit = (n + ranks[k] - 1) / ranks[k];
                assert_true(p->npiece >= 1 && p->npiece <= ranks[k]);
                for (int i = 0; i < p->npiece; i++)
                    assert_true(p->bodies.at[i + 1] - p->bodies.at[i] < 2 * limit + 1);
                check_pieces(p, m);
                check_contraction(p, m);
            }
            arena_destroy(a);
        }
}

/* One rank owns all: no message, no round, no ancestor. One body per rank: pieces are bodies. */
static void the_extremes_of_a_split(void **state)
{
    (void)state;
    struct random r = random_make(62, 0, 0);
    struct arena *a = arena_create();
    const struct model *m = tree(RANDOM, 50, &r, a);
    const struct tree_plan *one = tree_plan_make(m, 1, a), *all = tree_plan_make(m, 50, a);
    assert_int_equal(one->npiece, 1);
    assert_int_equal(one->nround, 0);
    assert_int_equal(one->nlevel, 0);
    assert_int_equal(one->anchor[0], -1);
    assert_int_equal(all->npiece, 50);
    for (int i = 0; i < 50; i++) {
        assert_int_equal(all->anchor[all->owner[i]], m->body[i].parent);
        assert_int_equal(all->local[i], 0);
    }
    arena_destroy(a);
}

/* A star is raked at once, a chain takes ceil(log2 n) rounds, with one body per rank. */
static void stars_and_chains_take_known_rounds(void **state)
{
    (void)state;
    struct random r = random_make(63, 0, 0);
    for (int n = 2; n <= MOST; n += n < 20 ? 1 : 25) {
        struct arena *a = arena_create();
        int rounds = 0;
        while (1 << rounds < n) rounds++;
        assert_int_equal(tree_plan_make(tree(STAR, n, &r, a), n, a)->nround, 1);
        const int chain = tree_plan_make(tree(CHAIN, n, &r, a), n, a)->nround;
        /* a chain's leaf is raked while the rest is merged, which may save the last round */
        assert_true(chain <= rounds && chain >= rounds - 1);
        arena_destroy(a);
    }
}

/* --- rows and memory --- */

static void the_owner_of_a_row_is_found(void **state)
{
    (void)state;
    struct random r = random_make(64, 0, 0);
    for (int trial = 0; trial < 300; trial++) {
        int first[40], nrank = 1 + (int)random_below(&r, 39);
        first[0] = 0;
        for (int k = 1; k <= nrank; k++) first[k] = first[k - 1] + 1 + (int)random_below(&r, 4);
        const struct row_layout l = {.nrank = nrank, .nrow = first[nrank], .first = first};
        for (int i = 0; i < first[nrank]; i++) {
            const int k = row_owner(&l, i);
            assert_true(k >= 0 && k < nrank && first[k] <= i && i < first[k + 1]);
        }
    }
}

/* A row [L D U r] lies in one piece; where there is no neighbour its block has the row's order. A
 * neighbour v behind the coupling K is folded in: D -= K D_v^-1 back, r -= K D_v^-1 r_v, next =
 * -K D_v^-1 onward; held against a solution of D_v X = [back onward r_v]. */
static void a_folded_row_has_what_elimination_leaves(void **state)
{
    (void)state;
    struct random g = random_make(66, 0, 0);
    for (int trial = 0; trial < 7 * 7 * 7; trial++) {
        enum { M = 2, WIDEST = 6 + 6 + M };
        const int c = trial % 7, n = trial / 7 % 7, far = trial / 49, width = c + far + M;
        double base[150], other[150], K[36], back[36], onward[36], next[36], A[36];
        double X[6 * WIDEST], D[36], r[6 * M];
        struct textbook_row row = textbook_row_at(base, c, n, 0);
        struct textbook_row v = textbook_row_at(other, n, c, far);
        struct work w = {0};
        assert_ptr_equal(row.L, base);
        assert_int_equal(row.D - row.L, c * (n > 0 ? n : c));
        assert_int_equal(row.U - row.D, c * c);
        assert_int_equal(row.r - row.U, c * c);
        assert_int_equal(v.r - v.U, n * (far > 0 ? far : n));
        for (int i = 0; i < 36; i++) {
            K[i] = random_uniform(&g, -1, 1), back[i] = random_uniform(&g, -1, 1);
            onward[i] = random_uniform(&g, -1, 1);
        }
        for (int i = 0; i < 150; i++) base[i] = other[i] = random_uniform(&g, -1, 1);
        for (int i = 0; i < n; i++) v.D[i * n + i] += 8;
        memcpy(A, v.D, sizeof *A * (size_t)(n * n));
        memcpy(D, row.D, sizeof *D * (size_t)(c * c));
        memcpy(r, row.r, sizeof *r * (size_t)(c * M));
        for (int i = 0; i < n; i++)
            for (int j = 0; j < width; j++)
                X[i * width + j] = j < c         ? back[i * c + j]
                                   : j < c + far ? onward[i * far + j - c]
                                                 : v.r[i * M + j - c - far];
        if (n > 0) assert_true(dense_solve_general(n, width, A, X, &w));
        assert_true(textbook_row_fold(&row, K, &v, back, onward, far, next, M, &w));
        for (int i = 0; i < c; i++)
            for (int j = 0; j < width; j++) {
                double sum = 0;
                for (int k = 0; k < n; k++) sum += K[i * n + k] * X[k * width + j];
                const double got = j < c ? D[i * c + j] - row.D[i * c + j]
                                   : j < c + far
                                       ? -next[i * far + j - c]
                                       : r[i * M + j - c - far] - row.r[i * M + j - c - far];
                if (!(fabs(got - sum) < 1e-13)) fail_msg("%d %d %d: %g %g", c, n, far, got, sum);
            }
    }
    /* a neighbour without an inverse is told */
    double base[32] = {0}, other[32] = {0}, K[4] = {0}, next[4];
    struct textbook_row row = textbook_row_at(base, 2, 2, 0), v = textbook_row_at(other, 2, 2, 0);
    struct work w = {0};
    assert_false(textbook_row_fold(&row, K, &v, K, K, 0, next, 1, &w));
}

static void the_condition_is_the_largest_growth(void **state)
{
    (void)state;
    const double before[4] = {2, 8, 1, NAN}, pivot[4] = {0.5, 3, 10, 1};
    assert_true(reduction_condition(0, before, pivot) == 0);
    assert_true(reduction_condition(1, before, pivot) == 1);
    assert_true(reduction_condition(2, before, pivot) == 24);
    assert_true(reduction_condition(3, before, pivot) == 24);
    assert_true(reduction_condition(4, before, pivot) == 24); /* no number: broken tells of it */
}

/* What is measured is what is laid out: pieces lie one behind the other, each on its 16 bytes. */
static void measuring_and_laying_out_agree(void **state)
{
    (void)state;
    struct random r = random_make(65, 0, 0);
    _Alignas(16) static char room[4096];
    for (int trial = 0; trial < 200; trial++) {
        struct carve measure = {.base = NULL}, lay = {.base = room};
        size_t end = 0;
        for (int k = 0; k < 20; k++) {
            const size_t size = (size_t)random_below(&r, 130);
            assert_null(carve_bytes(&measure, size));
            char *p = carve_bytes(&lay, size);
            assert_true((size_t)(p - room) % 16 == 0);
            assert_true((size_t)(p - room) >= end && (size_t)(p - room) < end + 16);
            end = (size_t)(p - room) + size;
            assert_int_equal(measure.used, lay.used);
            assert_true(lay.used >= end && lay.used < end + 16);
        }
        double *three = CARVE(&lay, 3, double);
        assert_true((char *)three >= room + end && lay.used == measure.used + 32);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plans_can_be_carried_out),
        cmocka_unit_test(the_extremes_of_a_split),
        cmocka_unit_test(stars_and_chains_take_known_rounds),
        cmocka_unit_test(the_owner_of_a_row_is_found),
        cmocka_unit_test(a_folded_row_has_what_elimination_leaves),
        cmocka_unit_test(the_condition_is_the_largest_growth),
        cmocka_unit_test(measuring_and_laying_out_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
