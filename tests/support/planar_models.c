/* planar_models.c - see planar_models.h. */
#include "planar_models.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"

static void unit_quaternion(struct random *r, double *q)
{
    double length = 0;
    for (int i = 0; i < 4; i++) {
        q[i] = random_normal(r);
        length += q[i] * q[i];
    }
    for (int i = 0; i < 4; i++) q[i] /= sqrt(length);
}

/* y = R(q) x, or with R^T. */
static void turn(const double *q, bool back, const double *x, double *y)
{
    const double s = back ? -1 : 1, w = q[3], u[3] = {s * q[0], s * q[1], s * q[2]};
    const double t[3] = {2 * (u[1] * x[2] - u[2] * x[1]), 2 * (u[2] * x[0] - u[0] * x[2]),
                         2 * (u[0] * x[1] - u[1] * x[0])};
    const double c[3] = {u[1] * t[2] - u[2] * t[1], u[2] * t[0] - u[0] * t[2],
                         u[0] * t[1] - u[1] * t[0]};
    const double result[3] = {x[0] + w * t[0] + c[0], x[1] + w * t[1] + c[1],
                              x[2] + w * t[2] + c[2]};
    memcpy(y, result, sizeof result);
}

/* c = a^-1 b. */
static void quotient(const double *a, const double *b, double *c)
{
    const double x = -a[0], y = -a[1], z = -a[2], w = a[3];
    c[0] = w * b[0] + x * b[3] + y * b[2] - z * b[1];
    c[1] = w * b[1] - x * b[2] + y * b[3] + z * b[0];
    c[2] = w * b[2] + x * b[1] - y * b[0] + z * b[3];
    c[3] = w * b[3] - x * b[0] - y * b[1] - z * b[2];
}

/* A body of points anyhow: tr(S) U - S for the second moment S = B B^T of a random B. */
static void inertia(struct random *r, double *j)
{
    double b[9], s[9];
    for (int i = 0; i < 9; i++) b[i] = random_uniform(r, -0.5, 0.5);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            s[3 * i + k] = b[3 * i] * b[3 * k] + b[3 * i + 1] * b[3 * k + 1] +
                           b[3 * i + 2] * b[3 * k + 2] + (i == k ? 0.05 : 0);
    const double trace = s[0] + s[4] + s[8];
    const double full[6] = {trace - s[0], -s[1], -s[2], trace - s[4], -s[5], trace - s[8]};
    memcpy(j, full, sizeof full);
}

/* The plane: two unit vectors across and the normal, in the base's frame. */
static void plane(uint64_t seed, double *x, double *y, double *n)
{
    struct random r = random_make(seed, 1, 0);
    double q[4];
    unit_quaternion(&r, q);
    turn(q, false, (const double[]){1, 0, 0}, x);
    turn(q, false, (const double[]){0, 1, 0}, y);
    turn(q, false, (const double[]){0, 0, 1}, n);
}

/* The first of mixed joints turns, so that there is only one plane. */
static enum model_joint pick_joint(const struct planar_options *o, bool first, struct random *r)
{
    static const enum model_joint mixed[] = {JOINT_REVOLUTE, JOINT_REVOLUTE, JOINT_PRISMATIC,
                                             JOINT_PLANAR, JOINT_FIXED};
    return o->joint != JOINT_MIXED ? o->joint : first ? JOINT_REVOLUTE : mixed[random_below(r, 5)];
}

/* Axes of body `def` whose frame is turned by q in the base. */
static void set_axes(struct body_def *def, struct random *r, double tilt, const double *q,
                     const double *plane_x, const double *plane_y, const double *normal)
{
    const double angle = random_uniform(r, -3, 3), sign = random_below(r, 2) ? 1 : -1;
    double across[3], axis[3];
    for (int k = 0; k < 3; k++) {
        across[k] = cos(angle) * plane_x[k] + sin(angle) * plane_y[k];
        axis[k] = def->joint == JOINT_PRISMATIC ? across[k] + tilt * normal[k]
                                                : sign * normal[k] + tilt * across[k];
    }
    turn(q, true, axis, def->axis);
    for (int k = 0; k < 3; k++) across[k] -= sign * tilt * normal[k];
    if (def->joint == JOINT_PLANAR) turn(q, true, across, def->axis2);
}

static void add_loops(struct model *m, const struct planar_options *o, double (*pose)[4],
                      const double *normal)
{
    for (int l = 0; l < o->loops; l++) {
        struct random r = random_make(o->seed, 3, (uint64_t)(o->twins ? l / 2 : l));
        struct loop_def def = {.joint = random_below(&r, 2) ? JOINT_REVOLUTE : JOINT_PRISMATIC};
        double frame[4], z[3], turned[4];
        def.body_b = (int)random_below(&r, (uint64_t)o->n);
        def.body_a = random_below(&r, 3) ? (int)random_below(&r, (uint64_t)o->n) : -1;
        if (def.body_a == def.body_b) def.body_a = -1;
        snprintf(def.name, sizeof def.name, "l%d", l);
        /* a frame whose z (prismatic: y) is the normal: the shortest turn there */
        unit_quaternion(&r, frame);
        const double from[3] = {0, def.joint == JOINT_PRISMATIC, def.joint == JOINT_REVOLUTE};
        z[0] = from[1] * normal[2] - from[2] * normal[1];
        z[1] = from[2] * normal[0] - from[0] * normal[2];
        z[2] = from[0] * normal[1] - from[1] * normal[0];
        const double w = 1 + from[1] * normal[1] + from[2] * normal[2];
        const double length = sqrt(z[0] * z[0] + z[1] * z[1] + z[2] * z[2] + w * w);
        for (int k = 0; k < 3; k++) turned[k] = z[k] / length;
        turned[3] = w / length;
        const double none[4] = {0, 0, 0, 1};
        quotient(def.body_a < 0 ? none : pose[def.body_a], turned, def.frame_a.quat);
        quotient(pose[def.body_b], turned, def.frame_b.quat);
        for (int k = 0; k < 3; k++) {
            def.frame_a.p[k] = random_uniform(&r, -1, 1);
            def.frame_b.p[k] = random_uniform(&r, -1, 1);
        }
        def.alpha = def.beta = 3;
        struct err e = {0};
        if (model_add_loop(m, &def, &e) < 0) abort();
    }
}

const struct model *planar_model(const struct planar_options *o, struct arena *a)
{
    struct err e = {0};
    struct model *m = model_begin(a, NULL);
    double(*pose)[4] = arena_take(a, (size_t)o->n * sizeof *pose);
    double x[3], y[3], normal[3];
    plane(o->seed, x, y, normal);
    for (int i = 0; i < o->n; i++) {
        struct random r = random_make(o->seed, 2, (uint64_t)i);
        struct body_def def = {.parent = i - 1};
        const double none[4] = {0, 0, 0, 1};
        snprintf(def.name, sizeof def.name, "b%d", i);
        def.joint = pick_joint(o, i == 0, &r);
        if (o->tree && i > 0) def.parent = (int)random_below(&r, (uint64_t)i + 1) - 1;
        unit_quaternion(&r, pose[i]);
        quotient(def.parent < 0 ? none : pose[def.parent], pose[i], def.placement.quat);
        for (int k = 0; k < 3; k++) {
            def.placement.p[k] = random_uniform(&r, -1, 1);
            def.com[k] = random_uniform(&r, -0.5, 0.5);
        }
        if (def.joint != JOINT_FIXED)
            set_axes(&def, &r, i == o->n - 1 ? o->tilt : 0, pose[i], x, y, normal);
        def.mass = random_uniform(&r, 0.5, 2);
        inertia(&r, def.inertia);
        if (o->springs && joint_nu(def.joint) == 1)
            def.stiffness = 3, def.rest = 0.2, def.damping = 0.1;
        if (model_add_body(m, &def, &e) < 0) abort();
    }
    if (o->loops > 0) add_loops(m, o, pose, normal);
    struct random r = random_make(o->seed, 4, 0);
    for (int k = 0; k < 3; k++) m->gravity[k] = random_uniform(&r, -10, 10);
    if (!model_finish(m, false, &e)) {
        fprintf(stderr, "%s\n", e.text);
        abort();
    }
    return m;
}

struct state *planar_state(const struct planar_options *o, const struct model *m, struct arena *a)
{
    struct state *s = state_take(m, a);
    struct random r = random_make(o->seed, 5, 0);
    double x[3], y[3], normal[3];
    plane(o->seed, x, y, normal);
    for (int k = 0; k < m->nq; k++) s->q[k] = random_uniform(&r, -1.5, 1.5);
    for (int k = 0; k < m->nu; k++) {
        s->qd[k] = random_normal(&r);
        s->qdd[k] = random_normal(&r);
        s->tau[k] = random_normal(&r);
    }
    if (!o->loads) return s;
    double *fext = state_fext_need(s, m, a);
    for (int k = 0; k < 6 * m->nbody; k++) fext[k] = random_normal(&r);
    const double turns = random_normal(&r);
    for (int k = 0; k < 3; k++) {
        s->base_acceleration[k] = turns * normal[k];
        s->base_acceleration[3 + k] = random_normal(&r);
    }
    return s;
}
