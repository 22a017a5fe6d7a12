/* totals.c - energy, momentum, centre of mass; positions and motion of all bodies; drift of
 * loops. */
#include "dynamics/dynamics.h"
#include "dynamics/loops.h"

/* One body's part; com in *t is the first moment until the end. */
static void add_body(const struct dynamics *d, int i, const struct xform *x,
                     struct motion_totals *t)
{
    const struct body_mass *b = d->body[i].mass;
    const real m = b->inertia.m;
    const real *v = d->v + 6 * i, half = (real)0.5;
    real vc[3], spin[3], linear[3], c[3];
    /* Velocity of the centre of mass, and spin about it: kinetic energy without a distant
     * origin. */
    vec3_copy(vc, v + 3);
    vec3_cross_add(vc, v, b->s);
    sym3_mul_vec(spin, b->jc, v);
    t->kinetic += half * (m * vec3_dot(vc, vc) + vec3_dot(v, spin));
    /* In the base's frame: place, then linear and angular momentum about the base's origin. */
    mat3_mul_vec(c, x->r, b->s);
    vec3_add(c, x->p);
    for (int k = 0; k < 3; k++) t->potential -= m * (real)d->model->gravity[k] * c[k];
    vec3_scale(linear, m, vc);
    mat3_mul_vec(linear, x->r, linear);
    mat3_mul_vec(spin, x->r, spin);
    vec3_add(t->linear, linear);
    /* About the base's origin: spin plus c x m v. */
    vec3_add(t->angular, spin);
    vec3_cross_add(t->angular, c, linear);
    t->mass += m;
    for (int k = 0; k < 3; k++) t->com[k] += m * c[k];
}

/* All bodies at q in motion u: poses, velocities and bias in d; where they are in the base's
 * frame. */
static struct xform *world_motion(struct dynamics *d, const real *q, const real *u)
{
    dynamics_place(d, q);
    dynamics_velocities(d, u);
    return dynamics_world(d, NULL);
}

/* Sums over bodies; the base has no energy. */
void motion_totals_of(struct dynamics *d, const real *q, const real *u, struct motion_totals *t)
{
    struct arena_mark mark = arena_mark(d->arena);
    const struct xform *x = world_motion(d, q, u);
    *t = (struct motion_totals){0};
    /* Parts of all bodies about the base's origin. */
    for (int i = 0; i < d->nbody; i++) {
        const struct body *b = &d->body[i];
        add_body(d, i, &x[i], t);
        /* Springs store energy, dampers do not. k (q - rest)^2 / 2, where u = q'; the rate of a
         * helical joint is u = q' / unit, and so is the power of its spring. */
        real stretch = b->has_spring ? q[b->q_at] - b->details->spring.rest : 0;
        t->potential += b->details->spring.stiffness * stretch * stretch / 2 / b->details->unit;
    }
    /* Massless systems have no centre. */
    for (int k = 0; k < 3 && t->mass > 0; k++) t->com[k] /= t->mass;
    arena_release(d->arena, mark);
}

/* Everything that an observer in the base's frame would measure. */
void forward_kinematics(struct dynamics *d, const real *q, const real *u, const real *ud,
                        struct body_motion *out)
{
    struct arena_mark mark = arena_mark(d->arena);
    const struct xform *x = world_motion(d, q, u);
    for (int i = 0; i < d->nbody; i++) {
        const struct body *b = &d->body[i];
        static const real still[6] = {0};
        real *a = d->a + 6 * i, carried[6];
        /* As in rnea.c, but without gravity: these are accelerations that an observer sees. */
        screw_copy(a, d->bias + 6 * i);
        subspace_h(&d->pose[i].s, ud + b->u_at, a);
        /* The base stands still here even when the state moves it. */
        xform_motion(carried, &d->pose[i].x, b->parent >= 0 ? d->a + 6 * b->parent : still);
        screw_add(a, carried);
        struct body_motion *o = &out[i];
        /* From internal to user axes, and everything else into the base's. */
        mat3_mul_transposed(o->r, x[i].r, b->details->user);
        vec3_copy(o->p, x[i].p);
        mat3_mul_vec(o->w, x[i].r, d->v + 6 * i);
        mat3_mul_vec(o->v, x[i].r, d->v + 6 * i + 3);
        mat3_mul_vec(o->alpha, x[i].r, a);
        mat3_mul_vec(o->a, x[i].r, a + 3);
    }
    arena_release(d->arena, mark);
}

/* What the constraints still lack at the positions and velocities themselves. */
void loop_drift(struct dynamics *d, const real *q, const real *u, real *g, real *rho)
{
    struct arena_mark mark = arena_mark(d->arena);
    struct loops l;
    struct work uncounted = {0};
    dynamics_place(d, q);
    dynamics_velocities(d, u);
    loops_take(d, &l, &uncounted);
    for (int k = 0; k < l.nloop; k++)
        for (int i = 0; i < l.pose[k].c; i++) {
            if (g) g[l.loop[k].row_at + i] = l.pose[k].g[i];
            if (rho) rho[l.loop[k].row_at + i] = l.pose[k].rho[i];
        }
    arena_release(d->arena, mark);
}
