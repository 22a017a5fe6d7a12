/* test_scan.c - scans along the ranks against the recurrence done one body after the other, their
 * messages by the formulas of the header, and the largest numbers of all ranks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "../support/many_ranks.h"
#include "base/arena.h"
#include "base/random.h"
#include "kernel/extremes.h"
#include "kernel/scan.h"

enum { MOST_RANKS = 40, SCANS = 3 };

/* One chain of bodies, a body a rank: random rigid transforms, motions and forces. */
struct chain_of_ranks {
    bool dense, incoming;
    int nrank;
    struct arena *arena;
    struct xform step[MOST_RANKS]; /* from frame k to frame k - 1 */
    real square[MOST_RANKS][SQUARE];
    real v[SCANS][MOST_RANKS][SPACE], f[MOST_RANKS][SPACE];         /* given */
    real found[SCANS][MOST_RANKS][SPACE], force[MOST_RANKS][SPACE]; /* by the ranks */
};

static void random_transform(struct random *r, struct xform *x)
{
    real q[4], length = 0;
    for (int i = 0; i < 4; i++) q[i] = random_normal(r), length += q[i] * q[i];
    for (int i = 0; i < 4; i++) q[i] /= sqrt(length);
    for (int i = 0; i < 3; i++) x->p[i] = random_uniform(r, -1, 1);
    /* columns: images of the axes, v + 2 w (u x v) + 2 u x (u x v) */
    for (int c = 0; c < 3; c++) {
        real e[3] = {c == 0, c == 1, c == 2}, a[3], b[3];
        for (int i = 0; i < 3; i++)
            a[i] = q[(i + 1) % 3] * e[(i + 2) % 3] - q[(i + 2) % 3] * e[(i + 1) % 3];
        for (int i = 0; i < 3; i++)
            b[i] = q[(i + 1) % 3] * a[(i + 2) % 3] - q[(i + 2) % 3] * a[(i + 1) % 3];
        for (int i = 0; i < 3; i++) x->r[3 * i + c] = e[i] + 2 * q[3] * a[i] + 2 * b[i];
    }
}

/* The matrix of a pair by hand: force [n; f] -> [r n + p x (r f); r f]. */
static void matrix_of(const struct xform *x, real *m)
{
    for (int c = 0; c < 6; c++) {
        real turned[2][3];
        for (int h = 0; h < 2; h++)
            for (int i = 0; i < 3; i++) turned[h][i] = c / 3 == h ? x->r[3 * i + c % 3] : 0;
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            m[6 * i + c] = turned[0][i] + x->p[j] * turned[1][k] - x->p[k] * turned[1][j];
            m[6 * (i + 3) + c] = turned[1][i];
        }
    }
}

static void make_chain(struct chain_of_ranks *c, struct random *r, int nrank)
{
    c->nrank = nrank;
    for (int k = 0; k < nrank; k++) {
        random_transform(r, &c->step[k]);
        matrix_of(&c->step[k], c->square[k]);
        for (int i = 0; i < SPACE; i++) {
            c->f[k][i] = random_normal(r);
            for (int s = 0; s < SCANS; s++) c->v[s][k][i] = random_normal(r);
        }
    }
}

static void rank(struct comm *comm, void *context)
{
    struct chain_of_ranks *c = context;
    const int k = comm_rank(comm), P = comm_size(comm);
    struct scan s = {0};
    struct carve room = {0};
    struct work w = {0};
    scan_carve(&s, &room, c->dense, c->incoming, k, P);
    room = (struct carve){.base = arena_take(c->arena, room.used + 16)};
    scan_carve(&s, &room, c->dense, c->incoming, k, P);
    s.comm = comm;
    /* level 0: incoming T_k, outgoing T_{k+1} */
    const int at = c->incoming ? k : k + 1;
    if (at > 0 && at < P) transform_expand(c->dense, s.level, &c->step[at], &w);
    for (int n = 0; n < SCANS; n++) {
        memcpy(c->found[n][k], c->v[n][k], sizeof c->found[n][k]);
        if (n == 0) scan_first(&s, 0, c->found[n][k], &w);
        else scan_motion(&s, 64 * n, c->found[n][k], &w);
    }
    memcpy(c->force[k], c->f[k], sizeof c->force[k]);
    scan_force(&s, 64 * SCANS, c->force[k], &w);
    comm_work(comm, &w);
}

static void near(const real *x, const real *y, int n, double size)
{
    for (int i = 0; i < n; i++)
        if (!(fabs((double)(x[i] - y[i])) <= 1e-13 * size))
            fail_msg("%d: %.17g, not %.17g", i, (double)x[i], (double)y[i]);
}

static void check_answers(const struct chain_of_ranks *c)
{
    real sum[SPACE], moved[SPACE];
    const double size = 10.0 * c->nrank * c->nrank;
    for (int s = 0; s < SCANS; s++)
        for (int k = 0; k < c->nrank; k++) {
            for (int i = 0; i < SPACE; i++) {
                moved[i] = 0; /* T^T v of the rank before */
                for (int j = 0; j < SPACE && k > 0; j++)
                    moved[i] += c->square[k][SPACE * j + i] * sum[j];
            }
            for (int i = 0; i < SPACE; i++) sum[i] = c->v[s][k][i] + moved[i];
            near(c->found[s][k], sum, SPACE, size);
        }
    for (int k = c->nrank - 1; k >= 0; k--) {
        for (int i = 0; i < SPACE; i++) {
            moved[i] = 0; /* T f of the rank behind */
            for (int j = 0; j < SPACE && k + 1 < c->nrank; j++)
                moved[i] += c->square[k + 1][SPACE * i + j] * sum[j];
        }
        for (int i = 0; i < SPACE; i++) sum[i] = c->f[k][i] + moved[i];
        near(c->force[k], sum, SPACE, size);
    }
}

static void scans_are_the_recurrence(void **state)
{
    (void)state;
    struct random r = random_make(9, 0, 0);
    for (int P = 1; P <= MOST_RANKS; P += P < 18 ? 1 : 11)
        for (int variant = 0; variant < 4; variant++) {
            static struct chain_of_ranks c;
            memset(&c, 0, sizeof c);
            c.arena = arena_create();
            c.dense = variant & 1, c.incoming = variant & 2;
            make_chain(&c, &r, P);
            const struct many_ranks_result m = many_ranks_run(P, rank, &c);
            assert_int_equal(m.blocked, 0);
            assert_int_equal(m.unread, 0);
            check_answers(&c);
            /* vectors: one for every pair of ranks d apart, d a power of two, in each scan; the
             * composites: with them (incoming) or in messages of their own */
            int64_t vectors = 0, composites = 0;
            for (int d = 1; d < P; d *= 2) {
                vectors += P - d;
                composites += P > 2 * d ? P - 2 * d : 0;
            }
            const int64_t number = (int64_t)sizeof(real), T = c.dense ? SQUARE : XFORM_NUMBERS;
            assert_int_equal(m.messages, (SCANS + 1) * vectors + (c.incoming ? 0 : composites));
            assert_int_equal(m.bytes, number * ((SCANS + 1) * vectors * SPACE + composites * T));
            arena_destroy(c.arena);
        }
}

/* P = 2^lg: P lg - P + 1 messages a scan, P lg - 2 (P - 1) of which carry a composite. */
static void messages_of_powers_of_two(void **state)
{
    (void)state;
    struct random r = random_make(10, 0, 0);
    for (int lg = 0; lg <= 5; lg++) {
        static struct chain_of_ranks c;
        const int P = 1 << lg;
        memset(&c, 0, sizeof c);
        c.arena = arena_create();
        make_chain(&c, &r, P);
        c.incoming = true;
        const int64_t in = many_ranks_run(P, rank, &c).messages;
        c.incoming = false;
        const int64_t out = many_ranks_run(P, rank, &c).messages;
        assert_int_equal(in, (SCANS + 1) * (P * lg - P + 1));
        assert_int_equal(out - in, P * lg - 2 * (P - 1));
        arena_destroy(c.arena);
    }
}

static void transforms_move_forces_and_motions(void **state)
{
    (void)state;
    struct random r = random_make(11, 0, 0);
    for (int round = 0; round < 100; round++) {
        struct xform a, b, both;
        real A[SQUARE], B[SQUARE], AB[SQUARE] = {0}, T[SQUARE], x[SPACE], y[SPACE], z[SPACE];
        struct work w = {0};
        random_transform(&r, &a), random_transform(&r, &b);
        matrix_of(&a, A), matrix_of(&b, B);
        for (int i = 0; i < SPACE; i++) x[i] = random_normal(&r);
        for (int i = 0; i < 36; i++)
            for (int j = 0; j < 6; j++) AB[i] += A[i / 6 * 6 + j] * B[6 * j + i % 6];
        transform_expand(true, T, &a, &w);
        near(T, A, SQUARE, 10);
        transform_compose(false, (real *)&both, (const real *)&a, (const real *)&b, &w);
        transform_expand(true, T, &both, &w);
        near(T, AB, SQUARE, 50);
        transform_compose(true, T, A, B, &w);
        near(T, AB, SQUARE, 50);
        for (int dense = 0; dense < 2; dense++) {
            const real *own = dense ? A : (const real *)&a;
            for (int i = 0; i < SPACE; i++) {
                z[i] = 0;
                for (int j = 0; j < SPACE; j++) z[i] += A[SPACE * i + j] * x[j];
            }
            memcpy(y, x, sizeof y);
            transform_force(dense, y, own, y, &w); /* in place */
            near(y, z, SPACE, 50);
            for (int i = 0; i < SPACE; i++) {
                z[i] = 0;
                for (int j = 0; j < SPACE; j++) z[i] += A[SPACE * j + i] * x[j];
            }
            transform_motion(dense, y, own, x, &w);
            near(y, z, SPACE, 50);
            transform_base(dense, false, y, own, x, &w);
            near(y, z, SPACE, 50);
            /* a base that does not turn */
            real slide[SPACE] = {0, 0, 0, x[3], x[4], x[5]};
            transform_motion(dense, z, own, slide, &w);
            const int64_t before = (int64_t)w.flop;
            transform_base(dense, true, y, own, slide, &w);
            near(y, z, SPACE, 50);
            assert_int_equal((int64_t)w.flop - before, dense ? 66 : 15);
        }
    }
}

static void the_largest_of_numbers(void **state)
{
    (void)state;
    const real x[] = {1, -7, 3}, wrong[] = {1, (real)NAN, 2}, none[] = {-(real)INFINITY};
    assert_true(largest_size(0, 3, x) == 7);
    assert_true(largest_size(8, 3, x) == 8);
    assert_true(largest_size(5, 0, NULL) == 5);
    assert_true(isinf((double)largest_size(0, 3, wrong)));
    assert_true(isinf((double)largest_size(0, 1, none)));
    const real last[] = {(real)NAN, 5};
    assert_true(isinf((double)largest_size(9, 2, last)));
}

struct extreme {
    real given[MOST_RANKS][4];
    int n;
    bool began;
    real residual;
};

static void find_largest(struct comm *c, void *context)
{
    const struct extreme *x = context;
    real mine[4];
    memcpy(mine, x->given[comm_rank(c)], sizeof mine);
    largest_everywhere(c, 5, x->n, mine);
    for (int i = 0; i < 4; i++) {
        real most = x->given[comm_rank(c)][i];
        for (int k = 0; k < comm_size(c) && i < x->n; k++)
            most = x->given[k][i] > most ? x->given[k][i] : most;
        assert_true(mine[i] == most);
    }
}

static void every_rank_knows_the_largest(void **state)
{
    (void)state;
    struct random r = random_make(4, 0, 0);
    for (int P = 1; P <= MOST_RANKS; P++) {
        struct extreme x = {.n = P % 4 + 1};
        for (int k = 0; k < P; k++)
            for (int i = 0; i < 4; i++) x.given[k][i] = random_normal(&r);
        if (P % 3 == 0) x.given[P / 2][0] = (real)INFINITY;
        const struct many_ranks_result m = many_ranks_run(P, find_largest, &x);
        assert_int_equal(m.blocked, 0);
        assert_int_equal(m.unread, 0);
        int rounds = 0;
        while (1 << rounds < P) rounds++;
        assert_int_equal(m.messages, (int64_t)P * rounds);
    }
}

/* Corrections that shrink by `factor`, of an answer of 2: refinement goes on while they do. */
struct course {
    int calls[MOST_RANKS];
    double factor, residual;
    int most, done;
    bool sees;
    double left; /* residual afterwards */
};
struct solver {
    struct comm *comm;
    struct course *c;
};

static bool correct(void *solver, struct refinement *course)
{
    const struct solver *s = solver;
    const int k = comm_rank(s->comm);
    const real answer = 2, size = 2 * (real)pow(s->c->factor, ++s->c->calls[k]);
    /* only the last rank has a correction at all */
    const real mine = k == comm_size(s->comm) - 1 ? size : 0;
    return refinement_accept(course, s->comm, 100 * s->c->calls[k], 1, &mine, &answer);
}

static void refine(struct comm *comm, void *context)
{
    struct course *c = context;
    struct solver s = {comm, c};
    /* the worst rank decides for all */
    real residual = comm_rank(comm) == 0 ? (real)c->residual : 0, scale = 3;
    const int done = refinement_run(comm, 10, c->most, c->sees, &residual, &scale, correct, &s);
    assert_true(scale == 3);
    if (comm_rank(comm) == 0) c->left = (double)residual;
    c->done = done;
}

static void refinement_goes_on_while_corrections_shrink(void **state)
{
    (void)state;
    static const struct {
        double factor, residual;
        int most;
        bool sees;
        int done;
        double left;
    } cases[] = {
        {0.5, 1, 3, true, 3, 0.125},
        {0.5, 1, 1, true, 1, 0.5},
        {0.5, 1, 0, true, 0, 1},          /* none is wanted */
        {0.5, 1e-12, 3, true, 0, 1e-12},  /* nothing to mend */
        {0.5, 1e-12, 3, false, 3, 1e-12}, /* the residual tells nothing: it is tried */
        {1, 1, 3, true, 0, 1},            /* a correction as large as the answer is none */
        {2, 1, 3, true, 0, 1},
        {NAN, 1, 3, true, 0, 1},
        {0, 1, 3, true, 1, 0}, /* nothing is smaller than nothing */
        {0.5, NAN, 2, true, 2, NAN},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int P = 1; P <= 5; P += 2) {
            struct course c = {.factor = cases[i].factor,
                               .residual = cases[i].residual,
                               .most = cases[i].most,
                               .sees = cases[i].sees};
            const struct many_ranks_result m = many_ranks_run(P, refine, &c);
            assert_int_equal(m.blocked, 0);
            assert_int_equal(c.done, cases[i].done);
            if (cases[i].most == 0) assert_int_equal(m.messages, 0);
            if (!(c.left == cases[i].left) && !isnan(cases[i].left))
                fail_msg("case %zu: %g left", i, c.left);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scans_are_the_recurrence),
        cmocka_unit_test(messages_of_powers_of_two),
        cmocka_unit_test(transforms_move_forces_and_motions),
        cmocka_unit_test(the_largest_of_numbers),
        cmocka_unit_test(every_rank_knows_the_largest),
        cmocka_unit_test(refinement_goes_on_while_corrections_shrink),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
