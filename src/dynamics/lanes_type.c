/* lanes_type.c - forward dynamics of as many states as this build has lanes (lanes_type.h). */
#include "dynamics/lanes_type.h"

#include "dynamics/dynamics.h"

/* All arrays of numbers are arrays of lanes here. */
struct lanes {
    struct dynamics *d;
    real *sum; /* (nu) forces with those of springs */
};

static struct lanes *hold(const struct model *m, const struct state *s, struct arena *a)
{
    struct lanes *l = TAKE(a, 1, struct lanes);
    l->d = dynamics_take(m, a);
    dynamics_load(l->d, s);
    l->sum = TAKE(a, m->nu, real);
    return l;
}

/* Springs first, as in dynamics_forward: explicit, however stiff. */
static bool forward(struct lanes *l, const double *q, const double *u, const double *tau,
                    double *ud)
{
    const real *rates = (const real *)u, *coordinates = (const real *)q;
    struct arena_mark mark = arena_mark(l->d->arena);
    for (int k = 0; k < l->d->nu; k++) l->sum[k] = REAL(tau[k]);
    springs_add(l->d, coordinates, rates, l->sum);
    const bool good = aba(l->d, coordinates, rates, l->sum, (real *)ud, NULL);
    arena_release(l->d->arena, mark);
    return good;
}

/* One table a width; lanes_types.c has them side by side. */
#define lanes_type_here REAL_NAME(lanes_type)
extern const struct lanes_type lanes_type_here;
const struct lanes_type lanes_type_here = {.width = REAL_LANES, .hold = hold, .forward = forward};
