/* design_system.c - a chain's constraint system as a matrix (design_system.h). */
#include "design_system.h"

#include <math.h>
#include <string.h>

#include "../support/many_ranks.h"
#include "base/random.h"
#include "dynamics/dynamics.h"
#include "kernel/blocks.h"
#include "linalg/block_tridiag.h"

enum { ITERATIONS = 120 };

struct design_system design_system_make(const struct model *m, const struct state *s,
                                        struct arena *a)
{
    struct design_system x = {.n = m->nbody, .a = a};
    struct dynamics *d = dynamics_take(m, a);
    x.size = TAKE(a, x.n, unsigned char);
    x.D = TAKE(a, 36 * x.n, double);
    x.L = TAKE(a, 36 * x.n, double);
    dynamics_place(d, s->q);
    for (int i = 0; i < x.n; i++) {
        const struct body_pose *pose = &d->pose[i];
        const int c = pose->s.c;
        x.size[i] = (unsigned char)c;
        for (int k = 0; k < c; k++) {
            double w[6], own[6], moved[6], row[6];
            subspace_column(&pose->s, pose->s.d + k, w);
            body_accelerate(&d->body[i], w, own);
            if (i > 0) {
                double force[6];
                xform_force(force, &pose->x, w);
                body_accelerate(&d->body[i - 1], force, moved);
                subspace_w_transposed(&d->pose[i - 1].s, moved, row);
                for (int j = 0; j < x.size[i - 1]; j++)
                    x.L[36 * i + k * x.size[i - 1] + j] = -row[j];
                xform_motion(moved, &pose->x, moved);
                screw_add(own, moved);
            }
            subspace_w_transposed(&pose->s, own, row);
            for (int j = 0; j < c; j++) x.D[36 * i + j * c + k] = row[j];
        }
    }
    return x;
}

/* y = A v, six numbers a row. */
static void multiply(const struct design_system *x, const double *v, double *y)
{
    memset(y, 0, (size_t)(6 * x->n) * sizeof *y);
    for (int i = 0; i < x->n; i++) {
        const int c = x->size[i], b = i > 0 ? x->size[i - 1] : 0;
        for (int r = 0; r < c; r++) {
            for (int k = 0; k < c; k++) y[6 * i + r] += x->D[36 * i + r * c + k] * v[6 * i + k];
            for (int k = 0; k < b; k++) {
                y[6 * i + r] += x->L[36 * i + r * b + k] * v[6 * (i - 1) + k];
                y[6 * (i - 1) + k] += x->L[36 * i + r * b + k] * v[6 * i + r];
            }
        }
    }
}

static struct block_tridiag tridiagonal(const struct design_system *x)
{
    struct block_tridiag t = block_tridiag_make(x->a, x->n, x->size);
    for (int i = 0; i < x->n; i++) {
        const int c = x->size[i];
        for (int r = 0; r < c; r++)
            for (int k = 0; k <= r; k++)
                t.D[i * BLOCK_PACKED + packed_index(r, k)] = x->D[36 * i + r * c + k];
        memcpy(t.L + i * BLOCK_FULL, x->L + 36 * i, 36 * sizeof(double));
    }
    return t;
}

/* Cholesky of the diagonal blocks, G with D = G G^T, full. */
static double *block_factors(const struct design_system *x)
{
    double *G = TAKE(x->a, 36 * x->n, double);
    for (int i = 0; i < x->n; i++) {
        const int c = x->size[i];
        double *g = G + 36 * i;
        for (int r = 0; r < c; r++)
            for (int k = 0; k <= r; k++) {
                double sum = x->D[36 * i + r * c + k];
                for (int j = 0; j < k; j++) sum -= g[r * c + j] * g[k * c + j];
                g[r * c + k] = r == k ? sqrt(sum) : sum / g[k * c + k];
            }
    }
    return G;
}

/* v = G v, G^T v, G^-1 v or G^-T v. */
static void apply_factor(const struct design_system *x, const double *G, bool transposed,
                         bool inverse, double *v)
{
    for (int i = 0; i < x->n; i++) {
        const int c = x->size[i];
        const double *g = G + 36 * i;
        double *w = v + 6 * i, y[6];
        for (int s = 0; s < c; s++) {
            const int r = inverse == transposed ? c - 1 - s : s;
            double sum = 0;
            for (int k = 0; k < c; k++) {
                const double element = transposed ? g[k * c + r] : g[r * c + k];
                const bool there = transposed ? k >= r : k <= r;
                if (!there || (inverse && k == r)) continue;
                sum += element * (inverse ? y[k] : w[k]);
            }
            y[r] = inverse ? (w[r] - sum) / g[r * c + r] : sum;
        }
        memcpy(w, y, (size_t)c * sizeof *w);
    }
}

static double normalise(int n, double *v)
{
    double sum = 0;
    for (int k = 0; k < n; k++) sum += v[k] * v[k];
    for (int k = 0; k < n; k++) v[k] /= sqrt(sum);
    return sqrt(sum);
}

static void begin(int n, double *v)
{
    struct random g = random_make(3, 0, 0);
    for (int k = 0; k < n; k++) v[k] = random_uniform(&g, -1, 1);
    normalise(n, v);
}

/* Rows shorter than six have nothing behind their ends. */
static void trim(const struct design_system *x, double *v)
{
    for (int i = 0; i < x->n; i++)
        for (int k = x->size[i]; k < 6; k++) v[6 * i + k] = 0;
}

double design_condition(const struct design_system *x, bool scaled)
{
    struct arena_mark mark = arena_mark(x->a);
    const int n = 6 * x->n;
    double *v = TAKE(x->a, n, double), *y = TAKE(x->a, n, double), *G = block_factors(x), high = 0,
           low = 0;
    struct block_tridiag t = tridiagonal(x);
    struct work w = {0};
    const bool good = block_tridiag_factor(&t, &w) < 0;
    begin(n, v);
    trim(x, v);
    for (int k = 0; good && k < ITERATIONS; k++) {
        if (scaled) apply_factor(x, G, true, true, v);
        multiply(x, v, y);
        if (scaled) apply_factor(x, G, false, true, y);
        high = normalise(n, y);
        memcpy(v, y, (size_t)n * sizeof *v);
    }
    begin(n, v);
    trim(x, v);
    for (int k = 0; good && k < ITERATIONS; k++) {
        if (scaled) apply_factor(x, G, false, false, v);
        block_tridiag_solve(&t, 1, v, &w);
        if (scaled) apply_factor(x, G, true, false, v);
        trim(x, v);
        low = normalise(n, v);
    }
    arena_release(x->a, mark);
    return good ? high * low : NAN;
}

double design_mass_condition(const struct model *m, const struct state *s, struct arena *a)
{
    struct arena_mark mark = arena_mark(a);
    struct dynamics *d = dynamics_take(m, a);
    double *v = TAKE(a, m->nu, double), *y = TAKE(a, m->nu, double), high = 0, low = 0;
    struct work w = {0};
    bool good = true;
    begin(m->nu, v);
    /* without gravity and at rest inverse dynamics is M u' */
    for (int k = 0; k < ITERATIONS; k++) {
        rnea(d, s->q, d->zero, v, y, &w);
        high = normalise(m->nu, y);
        memcpy(v, y, (size_t)m->nu * sizeof *v);
    }
    begin(m->nu, v);
    dynamics_place(d, s->q);
    for (int k = 0; good && k < ITERATIONS; k++) {
        good = aba_response(d, v, y, &w);
        low = normalise(m->nu, y);
        memcpy(v, y, (size_t)m->nu * sizeof *v);
    }
    arena_release(a, mark);
    return good ? high * low : NAN;
}

/* --- backward errors -------------------------------------------------------------------------- */

struct posed {
    const struct design_system *x;
    struct kernel_spec spec;
    struct row_layout layout;
    const double *r;
    double *found;
    bool broken;
};

static void solve(struct comm *c, void *context)
{
    struct posed *p = context;
    const struct design_system *x = p->x;
    struct blocks *b = arena_take(x->a, sizeof *b);
    struct carve room = {0};
    struct work w = {0};
    blocks_carve(b, &room, &p->spec, &p->layout, comm_rank(c), 1, false);
    room = (struct carve){.base = arena_take(x->a, room.used)};
    memset(b, 0, sizeof *b);
    blocks_carve(b, &room, &p->spec, &p->layout, comm_rank(c), 1, false);
    b->comm = b->reduction.comm = c;
    for (int i = b->lo; i < b->hi; i++) {
        const int n = x->size[i], before = i > 0 ? x->size[i - 1] : 0;
        for (int r = 0; r < n; r++)
            for (int k = 0; k <= r; k++)
                blocks_row_D(b, i)[packed_index(r, k)] = x->D[36 * i + r * n + k];
        if (i > 0) memcpy(blocks_row_L(b, i), x->L + 36 * i, (size_t)(n * before) * sizeof(double));
        memcpy(blocks_row_r(b, i), p->r + 6 * i, (size_t)n * sizeof(double));
    }
    blocks_solve(b, &w);
    for (int i = b->lo; i < b->hi; i++)
        memcpy(p->found + 6 * i, blocks_row_r(b, i), (size_t)x->size[i] * sizeof(double));
    if (b->broken || b->reduction.broken) p->broken = true;
}

/* Largest componentwise error, residual in long double. */
static double judge(const struct design_system *x, const double *r, const double *found)
{
    long double *y = TAKE(x->a, 6 * x->n, long double), *z = TAKE(x->a, 6 * x->n, long double),
                worst = 0;
    for (int i = 0; i < 6 * x->n; i++) y[i] = -r[i], z[i] = fabs(r[i]);
    for (int i = 0; i < x->n; i++) {
        const int c = x->size[i], b = i > 0 ? x->size[i - 1] : 0;
        for (int e = 0; e < c * (c + b); e++) {
            const int row = e / (c + b), k = e % (c + b),
                      at = k < c ? 6 * i + k : 6 * (i - 1) + k - c;
            const long double t =
                k < c ? x->D[36 * i + row * c + k] : x->L[36 * i + row * b + k - c];
            y[6 * i + row] += t * found[at], z[6 * i + row] += fabsl(t * found[at]);
            if (k < c) continue;
            y[at] += t * found[6 * i + row], z[at] += fabsl(t * found[6 * i + row]);
        }
    }
    for (int i = 0; i < 6 * x->n; i++)
        if (z[i] > 0 && !(fabsl(y[i]) / z[i] <= worst)) worst = fabsl(y[i]) / z[i];
    return (double)worst;
}

double design_backward_error(const struct design_system *x, enum solver solver,
                             enum part_solver part, int nrank)
{
    struct arena_mark mark = arena_mark(x->a);
    const int n = x->n;
    double *r = TAKE(x->a, 6 * n, double), *found = TAKE(x->a, 6 * n, double);
    unsigned char *interface = TAKE(x->a, nrank, unsigned char);
    int *first = TAKE(x->a, nrank + 1, int);
    struct posed p = {
        .x = x, .r = r, .found = found, .spec = {.solver = solver, .part_solver = part}};
    begin(6 * n, r);
    trim(x, r);
    p.layout = (struct row_layout){
        .nrow = n, .nrank = nrank, .first = first, .size = x->size, .interface = interface};
    for (int k = 0; k <= nrank; k++) first[k] = (int)((long)n * k / nrank);
    for (int k = 0; k < nrank; k++) interface[k] = x->size[first[k + 1] - 1];
    for (int i = 0; i < n; i++)
        p.layout.largest = x->size[i] > p.layout.largest ? x->size[i] : p.layout.largest;
    many_ranks_run(nrank, solve, &p);
    double error = p.broken ? (double)INFINITY : judge(x, r, found);
    arena_release(x->a, mark);
    return error;
}
