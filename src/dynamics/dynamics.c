/* dynamics.c - a model's work arrays; positions and velocities of all bodies; springs. */
#include "dynamics/dynamics.h"

#include "dynamics/revolute.h"

/* All work arrays at once, six numbers a body and quantity, so that no call allocates. */
struct dynamics *dynamics_take(const struct model *m, struct arena *a)
{
    struct dynamics *d = TAKE(a, 1, struct dynamics);
    d->model = m;
    d->nbody = m->nbody;
    d->nu = m->nu;
    d->body = bodies_make(m, a);
    const bool revolute = !m->general_joints && model_all_revolute(m);
    d->revolute = revolute ? revolutes_take(m, d->body, a) : NULL;
    d->pose = TAKE(a, m->nbody, struct body_pose);
    d->v = TAKE(a, size_product(6, m->nbody), real);
    d->a = TAKE(a, size_product(6, m->nbody), real);
    d->f = TAKE(a, size_product(6, m->nbody), real);
    d->bias = TAKE(a, size_product(6, m->nbody), real);
    d->zero = TAKE(a, m->nu, real);
    /* The fast paths lay their own records into one piece of memory. */
    if (d->revolute) d->scratch = TAKE(a, size_product(DYNAMICS_SCRATCH, m->nbody + 2), real);
    d->arena = a;
    /* A base at rest in a field of gravity accelerates against it. */
    for (int i = 0; i < 3; i++) d->base[3 + i] = -REAL(m->gravity[i]);
    return d;
}

/* Loads are turned into internal axes once, not in every evaluation. */
void dynamics_load(struct dynamics *d, const struct state *s)
{
    base_motion(d->model, s, d->base);
    /* Without wrenches the loops that add them are left out. */
    if (!s->fext) {
        d->load = NULL;
        return;
    }
    if (!d->load) d->load = TAKE(d->arena, size_product(6, d->nbody), real);
    for (int i = d->model->first; i < d->model->end; i++)
        body_load(&d->body[i], s->fext + 6 * i, d->load + 6 * i);
}

/* The poses that all later calls refer to. */
void dynamics_place(struct dynamics *d, const real *q)
{
    for (int i = 0; i < d->nbody; i++) body_place(&d->body[i], q + d->body[i].q_at, &d->pose[i]);
}

/* From the base up: a parent's transform is there before its children's. */
struct xform *dynamics_world(struct dynamics *d, struct work *w)
{
    struct xform *x = TAKE(d->arena, d->nbody, struct xform);
    for (int i = 0; i < d->nbody; i++) {
        const int p = d->body[i].parent;
        if (p < 0) {
            x[i] = d->pose[i].x;
            continue;
        }
        xform_compose(&x[i], &x[p], &d->pose[i].x);
        if (w) w->flop += XFORM_COMPOSE_FLOP;
    }
    return x;
}

/* Physics (2.1), and b of (1.9), which needs the body's own velocity alone. */
void dynamics_velocities(struct dynamics *d, const real *u)
{
    for (int i = 0; i < d->nbody && !d->at_rest; i++) {
        const struct body *b = &d->body[i];
        real h[6], *v = d->v + 6 * i;
        body_rate(&d->pose[i], u + b->u_at, h);
        screw_copy(v, h);
        /* The base does not move: velocities are relative to it. */
        if (b->parent >= 0) {
            real carried[6];
            xform_motion(carried, &d->pose[i].x, d->v + 6 * b->parent);
            screw_add(v, carried);
        }
        body_bias(b, &d->pose[i], v, h, u + b->u_at, d->bias + 6 * i);
    }
}

/* Springs are forces like others; implicit.c treats them otherwise. */
void springs_add(struct dynamics *d, const real *q, const real *u, real *tau)
{
    for (int i = d->model->first; i < d->model->end; i++) {
        const struct body *b = &d->body[i];
        body_spring(b, q + b->q_at, u + b->u_at, tau + b->u_at);
    }
}
