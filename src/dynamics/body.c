/* body.c - a body's constants in this precision: rounding of body_constants, external wrenches, springs. */
#include "dynamics/body.h"

#include <string.h>

#include "dynamics/body_constants.h"

static void round_to(real *y, const quad *x, int n)
{
    for (int i = 0; i < n; i++) y[i] = (real)x[i];
}

static void make_inertia(const struct model *m, int i, struct body *b)
{
    struct body_constants c;
    body_constants_inertia(m, i, &c);
    b->m = b->inertia.m = (real)m->body[i].mass;
    round_to(b->s, c.s, 3);
    round_to(b->jc, c.jc, 6);
    round_to(b->inertia.ms, c.ms, 3);
    round_to(b->inertia.j, c.j, 6);
    round_to(b->phi.a, c.phi_a, 6);
    round_to(b->phi.b, c.phi_b, 9);
    round_to(b->phi.c, c.phi_c, 6);
}

static void make_frames(const struct model *m, int i, struct body *b)
{
    const struct body_def *def = &m->body[i];
    struct body_constants c;
    body_constants_place(m, i, &c);
    b->turned = c.turned;
    round_to(b->tree.r, c.tree_r, 9);
    round_to(b->tree.p, c.tree_p, 3);
    round_to(b->user, c.user, 9);
    round_to(b->slide, c.slide, 9);
    round_to(&b->unit, &c.unit, 1);
    b->pitch = (real)def->pitch;
    b->has_spring = def->stiffness != 0 || def->damping != 0;
    b->stiffness = (real)def->stiffness;
    b->rest = (real)def->rest;
    b->damping = (real)def->damping;
}

/* Where body i hangs; these differ between otherwise equal bodies. */
static void place_in_model(const struct model *m, int i, struct body *b)
{
    const struct body_def *def = &m->body[i];
    b->parent = def->parent;
    b->joint = def->joint;
    b->d = joint_nu(def->joint);
    b->nq = joint_nq(def->joint);
    b->q_at = m->q_at[i];
    b->u_at = m->u_at[i];
}

static bool same_numbers(const double *x, const double *y, int n) { return memcmp(x, y, (size_t)n * sizeof *x) == 0; }

/* Whether the turning of two bodies' frames is the same. */
static bool same_turn(const struct model *m, int i, int j)
{
    if (i == j) return true;
    if (i < 0 || j < 0) return false;
    const struct body_def *a = &m->body[i], *b = &m->body[j];
    return a->joint == b->joint && same_numbers(a->axis, b->axis, 3) && same_numbers(a->axis2, b->axis2, 3);
}

/* Whether bodies i and j have the same inertia, in frames turned alike. */
static bool same_inertia(const struct model *m, int i, int j)
{
    const struct body_def *a = &m->body[i], *b = &m->body[j];
    return same_turn(m, i, j) && same_numbers(&a->mass, &b->mass, 1) && same_numbers(a->com, b->com, 3) &&
           same_numbers(a->inertia, b->inertia, 6);
}

/* Whether all else is the same, too. */
static bool same_frames(const struct model *m, int i, int j)
{
    const struct body_def *a = &m->body[i], *b = &m->body[j];
    return same_turn(m, i, j) && same_turn(m, a->parent, b->parent) &&
           same_numbers(a->placement.quat, b->placement.quat, 4) && same_numbers(a->placement.p, b->placement.p, 3) &&
           a->pitch == b->pitch && a->stiffness == b->stiffness && a->rest == b->rest && a->damping == b->damping;
}

const struct body *bodies_make(const struct model *m, struct arena *a)
{
    if (REAL_BITS == 64 && m->constants) return m->constants;
    struct body *b = TAKE(a, m->nbody, struct body);
    for (int i = 0; i < m->nbody; i++) {
        if (i > 0) b[i] = b[i - 1];
        if (i == 0 || !same_inertia(m, i - 1, i)) make_inertia(m, i, &b[i]);
        if (i == 0 || !same_frames(m, i - 1, i)) make_frames(m, i, &b[i]);
        place_in_model(m, i, &b[i]);
    }
    return b;
}

void base_motion(const struct model *m, const struct state *s, real *a)
{
    for (int i = 0; i < 6; i++) a[i] = (real)s->base_acceleration[i] - (i < 3 ? 0 : (real)m->gravity[i - 3]);
}

void body_inertia_factors(const struct body *b, real *shift, real *about)
{
    static const signed char at[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    for (int i = 0; i < 6; i++) shift[7 * i] = 1;
    shift[4] = -b->s[2], shift[5] = b->s[1], shift[9] = b->s[2];
    shift[11] = -b->s[0], shift[15] = -b->s[1], shift[16] = b->s[0];
    for (int i = 0; i < 9; i++) about[6 * (i / 3) + i % 3] = b->jc[at[i]];
    for (int i = 3; i < 6; i++) about[7 * i] = b->m;
}

void body_load(const struct body *b, const double *fext, real *f)
{
    screw_zero(f);
    if (!fext) return;
    for (int i = 0; i < 3; i++) f[i] = (real)fext[3 + i], f[3 + i] = (real)fext[i];
    if (!b->turned) return;
    mat3_mul_vec_transposed(f, b->user, f);
    mat3_mul_vec_transposed(f + 3, b->user, f + 3);
}

void body_spring(const struct body *b, const real *q, const real *u, real *tau)
{
    if (b->has_spring) tau[0] -= b->stiffness * (q[0] - b->rest) + b->damping * u[0];
}
