/* vector_perturb.c - reference vectors changed on purpose; see the header. */
#include "model/vector_perturb.h"

#include <math.h>
#include <string.h>

/* How far, and where the numbers come from: one stream in a fixed order, so that a seed names a
 * vector. */
struct shaker {
    double size;
    struct random *r;
};

/* The largest component stands for the length: within sqrt(n) of it, and no square overflows. */
static double length_of(const double *x, int n)
{
    double largest = 0;
    for (int i = 0; i < n; i++) largest = fmax(largest, fabs(x[i]));
    return largest;
}

/* Each of n numbers moves by up to size * scale. */
static void shake_by(const struct shaker *s, double *x, int n, double scale)
{
    for (int i = 0; i < n; i++) x[i] += s->size * scale * random_uniform(s->r, -1, 1);
}

/* A vector's components share one scale: its direction is as uncertain as its length. */
static void shake_vector(const struct shaker *s, double *x, int n)
{
    shake_by(s, x, n, length_of(x, n));
}

/* Each by itself; so what is zero stays zero. */
static void shake_numbers(const struct shaker *s, double *x, int n)
{
    for (int i = 0; i < n; i++) shake_vector(s, x + i, 1);
}

/* Quaternions need not stay of length 1: models normalise them. They do not read R. */
static void shake_frame(const struct shaker *s, struct vector_frame *f)
{
    shake_vector(s, f->p, 3);
    shake_vector(s, f->quat, 4);
}

/* xx xy xz yy yz zz: what is no diagonal entry moves by the root of its row's and its column's. */
static void shake_inertia(const struct shaker *s, double *i)
{
    /* |J_xy| cannot exceed sqrt(J_xx J_yy) in a body: that is its scale, even where it is zero. */
    const double root[3] = {sqrt(fabs(i[0])), sqrt(fabs(i[3])), sqrt(fabs(i[5]))};
    static const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int k = 0; k < 6; k++) shake_by(s, i + k, 1, root[row[k]] * root[column[k]]);
}

/* The original stays as it is: many perturbed ones are made of it. */
static void *copied(struct arena *a, const void *x, size_t bytes)
{
    void *y = arena_take(a, bytes + 1);
    if (bytes > 0) memcpy(y, x, bytes);
    return y;
}

/* What the file leaves out stays left out. */
static double *copied_numbers(struct arena *a, const double *x, int n)
{
    return x ? copied(a, x, (size_t)n * sizeof *x) : NULL;
}

/* Numbers over the degrees of freedom: those of one joint, linear and angular, are vectors. */
static const double *shaken_joints(const struct shaker *s, const struct vector_case *c,
                                   const double *x, struct arena *a)
{
    /* A floating joint has two vectors of three, others one of all. */
    double *y = copied_numbers(a, x, c->nv);
    for (int i = 0; y && i < c->nbody; i++) {
        int n = vector_joint_nv(c->body[i].joint), part = n < 3 ? n : 3;
        for (int k = 0; k < n; k += part) shake_vector(s, y + c->body[i].v + k, part);
    }
    return y;
}

/* A floating joint's place and turn have scales of their own. */
static const double *shaken_coordinates(const struct shaker *s, const struct vector_case *c,
                                        struct arena *a)
{
    double *q = copied_numbers(a, c->q, c->nq);
    for (int i = 0; i < c->nbody; i++) {
        int n = vector_joint_nq(c->body[i].joint), linear = n == 7 ? 3 : 0;
        shake_vector(s, q + c->body[i].q, linear);
        shake_vector(s, q + c->body[i].q + linear, n - linear);
    }
    return q;
}

/* In a fixed order: each number takes the stream's next. */
static void shake_bodies(const struct shaker *s, struct vector_case *c)
{
    for (int i = 0; i < c->nbody; i++) {
        struct vector_body *b = &c->body[i];
        /* Others have no axis. */
        if (vector_joint_nv(b->joint) == 1) shake_vector(s, b->axis, 3);
        shake_frame(s, &b->placement);
        shake_vector(s, &b->mass, 1);
        shake_vector(s, b->com, 3);
        shake_inertia(s, b->inertia);
    }
}

/* Linear and angular half of a row apart: their units differ. */
static void shake_loops(const struct shaker *s, struct vector_case *c)
{
    for (int i = 0; i < c->nloop; i++) {
        struct vector_loop *l = &c->loop[i];
        shake_frame(s, &l->frame_a);
        shake_frame(s, &l->frame_b);
        for (int k = 0; k < l->nrow; k++)
            shake_vector(s, l->row[k], 3), shake_vector(s, l->row[k] + 3, 3);
    }
}

/* Bodies and loops change in place, so they are copied; other arrays are replaced as a whole. */
static struct vector_case *copy_with_bodies(const struct vector_case *c, struct arena *a)
{
    struct vector_case *x = copied(a, c, sizeof *c);
    x->body = copied(a, c->body, (size_t)c->nbody * sizeof *c->body);
    x->loop = copied(a, c->loop, (size_t)c->nloop * sizeof *c->loop);
    return x;
}

/* Every input, none of the answers. */
struct vector_case *vector_perturb(const struct vector_case *c, double size, struct random *r,
                                   struct arena *a)
{
    const struct shaker s = {size, r};
    /* Bodies and loops are our own copies now. */
    struct vector_case *x = copy_with_bodies(c, a);
    shake_vector(&s, x->gravity, 3);
    shake_bodies(&s, x);
    shake_loops(&s, x);
    x->q = shaken_coordinates(&s, c, a);
    x->qd = shaken_joints(&s, c, c->qd, a);
    x->qdd = shaken_joints(&s, c, c->qdd, a);
    x->tau = shaken_joints(&s, c, c->tau, a);
    /* Force and moment apart: their scales differ. */
    double *external = copied_numbers(a, c->external, 6 * c->nbody);
    for (int i = 0; external && i < 2 * c->nbody; i++) shake_vector(&s, external + 3 * i, 3);
    x->external = external;
    double *spring = copied_numbers(a, c->spring, c->nv),
           *rest = copied_numbers(a, c->spring_q0, c->nv);
    double *damping = copied_numbers(a, c->damping, c->nv);
    if (spring)
        shake_numbers(&s, spring, c->nv), shake_numbers(&s, rest, c->nv),
            shake_numbers(&s, damping, c->nv);
    x->spring = spring;
    x->spring_q0 = rest;
    x->damping = damping;
    return x;
}

/* The same joints and motion with masses that are kind to every algorithm. */
struct vector_case *vector_even(const struct vector_case *c, struct arena *a)
{
    struct vector_case *x = copy_with_bodies(c, a);
    /* A link is as long as the way to its centre or from its parent's joint, whichever is
     * longer. */
    double link = 0;
    for (int i = 0; i < c->nbody; i++)
        link += fmax(length_of(c->body[i].com, 3), length_of(c->body[i].placement.p, 3)) / c->nbody;
    /* 2/5 m r^2: a ball whose radius is the mean link. Where all is at one point, any size will
     * do. */
    const double moment = link > 0 ? 0.4 * link * link : 1;
    for (int i = 0; i < c->nbody; i++) {
        struct vector_body *b = &x->body[i];
        /* Every mass alike: no ratio is left that could cost digits. */
        b->mass = 1;
        memset(b->inertia, 0, sizeof b->inertia);
        b->inertia[0] = b->inertia[3] = b->inertia[5] = moment;
    }
    return x;
}
