/* lump.c - bodies on fixed joints made one with their parents. */
#include "model/lump.h"

#include <math.h>
#include <string.h>

/* Files give quaternions of any length; zero is the identity, as in complete_frame of model.c. */
void frame_normalise(struct frame *f)
{
    double *q = f->quat;
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (length == 0)
        q[3] = 1;
    else
        for (int i = 0; i < 4; i++) q[i] /= length;
}

/* Of a unit quaternion: body into parent components. */
static void rotation(const double quat[4], double r[9])
{
    double x = quat[0], y = quat[1], z = quat[2], w = quat[3];
    const double m[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
                         2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                         2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
    memcpy(r, m, sizeof m);
}

/* y may be x: the vector is copied first. */
void frame_turn(const struct frame *f, const double *x, double *y)
{
    double r[9], t[3] = {x[0], x[1], x[2]};
    rotation(f->quat, r);
    for (int i = 0; i < 3; i++) y[i] = r[3 * i] * t[0] + r[3 * i + 1] * t[1] + r[3 * i + 2] * t[2];
}

/* Points move, directions only turn. */
void frame_apply(const struct frame *f, const double *x, double *y)
{
    frame_turn(f, x, y);
    for (int i = 0; i < 3; i++) y[i] += f->p[i];
}

/* The Hamilton product a b, in which b turns first; then the inner origin in the outer's parent. */
struct frame frame_compose(const struct frame *outer, const struct frame *inner)
{
    const double *a = outer->quat, *b = inner->quat;
    struct frame f;
    f.quat[0] = a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1];
    f.quat[1] = a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0];
    f.quat[2] = a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3];
    f.quat[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
    frame_apply(outer, inner->p, f.p);
    return f;
}

/* The symmetric tensor xx xy xz yy yz zz from a frame's axes to its parent's: R J R^T. */
static void tensor_turn(const struct frame *f, const double j[6], double out[6])
{
    double r[9];
    rotation(f->quat, r);
    /* First R J, then its product with R^T; one triangle is enough of the result. */
    const double full[9] = {j[0], j[1], j[2], j[1], j[3], j[4], j[2], j[4], j[5]};
    double t[9];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            t[3 * i + k] =
                r[3 * i] * full[k] + r[3 * i + 1] * full[3 + k] + r[3 * i + 2] * full[6 + k];
    for (int i = 0, n = 0; i < 3; i++)
        for (int k = i; k < 3; k++, n++)
            out[n] =
                t[3 * i] * r[3 * k] + t[3 * i + 1] * r[3 * k + 1] + t[3 * i + 2] * r[3 * k + 2];
}

/* Add the mass of `part`, whose frame is `at` in the whole's frame. */
static void body_add(struct body_def *whole, const struct body_def *part, const struct frame *at)
{
    /* Both in the whole's axes first. */
    double com[3], inertia[6], d[3];
    frame_apply(at, part->com, com);
    tensor_turn(at, part->inertia, inertia);
    /* Two frames without mass have no common centre; the share 0 leaves it where it is. */
    double m1 = whole->mass, m2 = part->mass, m = m1 + m2, share = m != 0 ? m2 / m : 0;
    for (int i = 0; i < 3; i++) d[i] = com[i] - whole->com[i];
    /* Steiner's terms of both parts together are m1 m2 / m (d^2 U - d d^T). They hold the
     * distance of the centres only, so that parts far from the origin lose no digits. */
    double reduced = m1 * share, square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    for (int i = 0, n = 0; i < 3; i++)
        for (int k = i; k < 3; k++, n++)
            whole->inertia[n] += inertia[n] + reduced * ((i == k ? square : 0) - d[i] * d[k]);
    /* The centre moves last: d was measured from the old one. */
    for (int i = 0; i < 3; i++) whole->com[i] += share * d[i];
    whole->mass = m;
}

/* Where the frame `inner`, fixed on old body i, is in the new body. */
static struct frame moved(const struct lumped *l, int i, const struct frame *inner)
{
    struct frame f = *inner;
    frame_normalise(&f);
    return i < 0 ? f : frame_compose(&l->at[i], &f);
}

/* A loop keeps its frames in space: only the bodies under them are others. */
static bool loops_move(const struct model *m, const struct lumped *l, struct err *e)
{
    for (int i = 0; i < m->nloop; i++) {
        struct loop_def loop = m->loop[i];
        loop.frame_a = moved(l, loop.body_a, &loop.frame_a);
        loop.frame_b = moved(l, loop.body_b, &loop.frame_b);
        if (loop.body_a >= 0) loop.body_a = l->body[loop.body_a];
        if (loop.body_b >= 0) loop.body_b = l->body[loop.body_b];
        if (model_add_loop(l->model, &loop, e) < 0) return false;
    }
    return true;
}

/* Same units and gravity, no bodies yet. */
static struct model *model_like(const struct model *m, struct arena *a)
{
    struct model *n = model_begin(a, m->file);
    memcpy(n->gravity, m->gravity, sizeof n->gravity);
    n->metre = m->metre;
    n->kilogram = m->kilogram;
    n->second = m->second;
    return n;
}

/* One pass, parents first: where a body has gone is known when its children come. */
bool lump_fixed(const struct model *m, bool allow_nonphysical, struct arena *a, struct lumped *out,
                struct err *e)
{
    struct body_def *def = TAKE(a, m->nbody, struct body_def);
    int n = 0;
    /* For each old body: the new one that has taken it, and where in it. */
    *out = (struct lumped){NULL, TAKE(a, m->nbody, int), TAKE(a, m->nbody, struct frame)};
    for (int i = 0; i < m->nbody; i++) {
        const struct body_def *old = &m->body[i];
        int parent = old->parent < 0 ? -1 : out->body[old->parent];
        struct frame placement = moved(out, old->parent, &old->placement);
        /* A body fixed to the base leaves nothing that moves. */
        if (old->joint == JOINT_FIXED) {
            out->body[i] = parent;
            out->at[i] = placement;
            if (parent >= 0) body_add(&def[parent], old, &placement);
        } else {
            /* A body that moves keeps its own frame. */
            out->body[i] = n;
            out->at[i] = (struct frame){{0, 0, 0, 1}, {0, 0, 0}};
            def[n] = *old;
            def[n].parent = parent;
            def[n++].placement = placement;
        }
    }
    /* Nothing moves at all: the caller says so in its own words. */
    if (n == 0) return true;
    out->model = model_like(m, a);
    for (int i = 0; i < n; i++)
        if (model_add_body(out->model, &def[i], e) < 0) return false;
    return loops_move(m, out, e) && model_finish(out->model, allow_nonphysical, e);
}

/* Joints keep their order and fixed ones have no coordinates: q, u and tau are the same arrays. */
struct state *lump_state(const struct lumped *lumped, const struct model *old,
                         const struct state *s, struct arena *a)
{
    struct state *new = TAKE(a, 1, struct state);
    *new = *s;
    new->fext = NULL;
    if (!s->fext) return new;
    double *fext = state_fext_need(new, lumped->model, a);
    for (int i = 0; i < old->nbody; i++) {
        /* The base takes any force. */
        if (lumped->body[i] < 0) continue;
        /* A wrench on a lost body acts on the one that took it up. */
        const struct frame *at = &lumped->at[i];
        double f[3], n[3], *sum = fext + 6 * lumped->body[i];
        frame_turn(at, s->fext + 6 * i, f);
        frame_turn(at, s->fext + 6 * i + 3, n);
        const double *p = at->p; /* moment about the new origin: n + p x f */
        for (int k = 0; k < 3; k++) {
            sum[k] += f[k];
            sum[3 + k] += n[k] + p[(k + 1) % 3] * f[(k + 2) % 3] - p[(k + 2) % 3] * f[(k + 1) % 3];
        }
    }
    return new;
}
