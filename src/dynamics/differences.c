/* differences.c - central differences of the dynamics, column by column or several at once
 * (differences.h). */
#include "dynamics/differences.h"

#include <math.h>
#include <string.h>

#include "dynamics/integrate.h"

struct differences differences_make(const struct model *m, const struct state *s, long most,
                                    const struct lanes_type *type, struct arena *a)
{
    const int n = m->nq + m->nu;
    struct differences f = {.d = dynamics_take(m, a), .tau = s->tau, .most = most};
    dynamics_load(f.d, s);
    f.shifted = TAKE(a, n, double), f.change = TAKE(a, n, double);
    /* Loops are closed by pivots, which differ from state to state. */
    if (!type || m->nloop > 0) return f;
    f.type = type;
    f.lanes = type->hold(m, s, a);
    f.state = TAKE(a, size_product(n, type->width), double);
    f.q = TAKE(a, size_product(m->nq, type->width), double);
    f.u = TAKE(a, size_product(m->nu, type->width), double);
    f.ud = TAKE(a, size_product(m->nu, type->width), double);
    return f;
}

/* q' of all joints: their own business. */
static void rates(const struct differences *f, const double *y, double *dq)
{
    const struct model *m = f->d->model;
    for (int i = 0; i < m->nbody; i++) {
        const struct body *b = &f->d->body[i];
        body_qdot(b, y + b->q_at, y + m->nq + b->u_at, dq + b->q_at);
    }
}

bool differences_derivative(struct differences *f, const double *y, double *dy)
{
    const int nq = f->d->model->nq;
    /* Whoever steps would go on for ever where steps vanish. */
    if (++f->evaluations > f->most) return false;
    rates(f, y, dy);
    return dynamics_forward(f->d, y, y + nq, f->tau, dy + nq, NULL);
}

/* A step that balances rounding against the third derivative: the cube root of eps. Coordinates
 * near zero are taken as a hundredth, so that it does not vanish. */
static double step_of(double y) { return 6e-6 * fmax(fabs(y), 1e-2); }

/* One column after the other. */
static bool by_columns(struct differences *f, const double *y, double *dfdy)
{
    const int n = f->d->model->nq + f->d->model->nu;
    memcpy(f->shifted, y, (size_t)n * sizeof *y);
    for (int j = 0; j < n; j++) {
        const double h = step_of(y[j]);
        f->shifted[j] = y[j] + h;
        bool good = differences_derivative(f, f->shifted, f->change);
        for (int i = 0; i < n; i++) dfdy[i * n + j] = f->change[i];
        f->shifted[j] = y[j] - h;
        good = good && differences_derivative(f, f->shifted, f->change);
        for (int i = 0; i < n; i++) dfdy[i * n + j] = (dfdy[i * n + j] - f->change[i]) / (2 * h);
        f->shifted[j] = y[j];
        if (!good) return false;
    }
    return true;
}

/* Lane k gets the state y with number j moved by h; its q' goes to f->state. */
static void set_lane(struct differences *f, int k, const double *y, int j, double h)
{
    const int nq = f->d->model->nq, nu = f->d->model->nu, width = f->type->width;
    memcpy(f->shifted, y, (size_t)(nq + nu) * sizeof *y);
    f->shifted[j] = y[j] + h;
    for (int i = 0; i < nq; i++) f->q[i * width + k] = f->shifted[i];
    for (int i = 0; i < nu; i++) f->u[i * width + k] = f->shifted[nq + i];
    rates(f, f->shifted, f->state + (size_t)k * (size_t)(nq + nu));
}

/* Two lanes a column, both sides of it; where columns are left over, their lanes repeat the last.
 */
static bool by_lanes(struct differences *f, const double *y, double *dfdy)
{
    const int nq = f->d->model->nq, nu = f->d->model->nu, n = nq + nu, width = f->type->width;
    for (int first = 0; first < n; first += width / 2) {
        for (int k = 0; k < width; k += 2) {
            const int j = first + k / 2 < n ? first + k / 2 : n - 1;
            set_lane(f, k, y, j, step_of(y[j]));
            set_lane(f, k + 1, y, j, -step_of(y[j]));
        }
        if (!f->type->forward(f->lanes, f->q, f->u, f->tau, f->ud)) return false;
        for (int k = 0; k < width && first + k / 2 < n; k += 2) {
            const int j = first + k / 2;
            const double *up = f->state + (size_t)k * (size_t)n, *down = up + n, h = step_of(y[j]);
            for (int i = 0; i < nq; i++) dfdy[i * n + j] = (up[i] - down[i]) / (2 * h);
            for (int i = 0; i < nu; i++)
                dfdy[(nq + i) * n + j] =
                    (f->ud[i * width + k] - f->ud[i * width + k + 1]) / (2 * h);
        }
    }
    f->evaluations += 2 * n;
    return true;
}

/* Where evaluations end or the dynamics break down on the way, the columns are gone through one by
 * one: so many are made, and so many counted, as without lanes. */
bool differences_jacobian(struct differences *f, const double *y, double *dfdy)
{
    const int n = f->d->model->nq + f->d->model->nu;
    if (f->type && f->evaluations + 2 * n <= f->most && by_lanes(f, y, dfdy)) return true;
    return by_columns(f, y, dfdy);
}
