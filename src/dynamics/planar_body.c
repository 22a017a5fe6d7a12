/* planar_body.c - constants, motion and loads of the bodies of a planar scene (planar_body.h). */
#include "dynamics/planar_body.h"

#include <string.h>

#include "base/check.h"
#include "dynamics/planar_frame.h"
#include "linalg/angle.h"

/* As body_constants_place, in three components. */
static void make_frames(const struct model *m, int i, const quad *normal, struct body *b)
{
    const struct body_def *def = &m->body[i];
    quad own[9], parents[9], x[4], along = 0;
    planar_frame(m, i, normal + 3 * (i + 1), own);
    planar_frame(m, def->parent, normal + 3 * (def->parent + 1), parents);
    /* Cosine, sine and shift of the joint frame in the parent's. */
    planar_placement(parents, own, &def->placement, x);
    b->tree = (struct xform){(real)x[0], (real)x[1], {(real)x[2], (real)x[3]}};
    for (int k = 0; k < 9; k++) b->frame[k] = (real)own[k];
    /* An axis against the normal turns the other way round. */
    for (int k = 0; k < 3; k++) along += def->axis[k] * own[k];
    b->flipped =
        (joint_plane(def->joint) == PLANE_TURNS || joint_plane(def->joint) == PLANE_MOVES) &&
        along < 0;
    b->has_spring = joint_springs(m, i, &b->spring);
}

/* About the normal alone: all that acts of a body in its plane (physics 1.5). */
static void make_inertia(const struct model *m, int i, const quad *normal, struct body *b)
{
    static const signed char at[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    const struct body_def *def = &m->body[i];
    quad own[9], jc = 0, jo, mass = def->mass;
    planar_frame(m, i, normal + 3 * (i + 1), own);
    /* j = n^T J n. */
    for (int j = 0; j < 9; j++) jc += own[j / 3] * def->inertia[at[j]] * own[j % 3];
    b->m = (real)mass;
    b->jc = (real)jc;
    /* Zero when there are none: planar scenes may have massless bodies. */
    b->per_m = mass > 0 && jc > 0 ? (real)(1 / mass) : 0;
    b->per_jc = mass > 0 && jc > 0 ? (real)(1 / jc) : 0;
    jo = jc;
    /* Parallel axes: J_o = J_c + m |s|^2, with s in the plane. */
    for (int k = 0; k < 2; k++) {
        quad s = 0;
        for (int j = 0; j < 3; j++) s += own[3 * (k + 1) + j] * def->com[j];
        b->s[k] = (real)s;
        b->ms[k] = (real)(mass * s);
        jo += mass * s * s;
    }
    b->jo = (real)jo;
}

/* Whether the planar frames of bodies i and j (-1: the base) lie alike in their own. */
static bool same_frame(const struct model *m, int i, int j, const quad *normal)
{
    const quad *a = normal + 3 * (i + 1), *b = normal + 3 * (j + 1);
    return bodies_alike(m, i, j) && memcmp(a, b, 3 * sizeof *normal) == 0;
}

/* Whether bodies i and j are the same in all but their places in the model. */
static bool alike(const struct model *m, int i, int j, const quad *normal)
{
    return same_frame(m, i, j, normal) &&
           same_frame(m, m->body[i].parent, m->body[j].parent, normal) &&
           bodies_weigh_alike(m, i, j) && bodies_hang_alike(m, i, j);
}

/* The scene's normals: whoever asked for the plane has seen to it that there is one. */
static quad *normals_of(const struct model *m, struct arena *a)
{
    struct err e;
    err_clear(&e);
    quad *normal = planar_normals(m, 1e-3Q, a, &e);
    CHECK(normal);
    return normal;
}

/* Equal neighbours are copied, as in space. */
const struct body *bodies_make(const struct model *m, struct arena *a)
{
    struct body *b = TAKE(a, m->nbody, struct body);
    struct arena *scratch = arena_create();
    const quad *normal = normals_of(m, scratch);
    for (int i = 0; i < m->nbody; i++) {
        if (i > 0 && alike(m, i, i - 1, normal)) {
            b[i] = b[i - 1];
        } else {
            make_inertia(m, i, normal, &b[i]);
            make_frames(m, i, normal, &b[i]);
        }
        body_seat(m, i, &b[i]);
        b[i].plane = joint_plane(b[i].joint);
    }
    arena_destroy(scratch);
    return b;
}

/* Of the base's acceleration the part in the plane; the rest does no work. */
void base_motion(const struct model *m, const struct state *s, real *a)
{
    struct arena *scratch = arena_create();
    quad rows[9];
    planar_frame(m, -1, normals_of(m, scratch), rows);
    arena_destroy(scratch);
    /* Rows: the normal takes the angular part, x and y take a - g (physics 1.6). */
    for (int k = 0; k < 3; k++) {
        quad sum = 0;
        for (int j = 0; j < 3; j++)
            sum += rows[3 * k + j] *
                   (k == 0 ? s->base_acceleration[j]
                           : (quad)s->base_acceleration[3 + j] - (quad)m->gravity[j]);
        a[k] = (real)sum;
    }
}

/* Columns [H W]. Picked: those of a slide are x, then normal and y. Given: against the normal, and
 * y against y. */
static void subspace_set(const struct body *b, struct subspace *s)
{
    static const signed char straight[3] = {0, 1, 2}, slide[3] = {1, 0, 2};
    s->d = b->d;
    s->c = SPACE - b->d;
    /* A flip changes signs, so its columns are written out. */
    s->pick = b->flipped ? NULL : b->plane == PLANE_SLIDES ? slide : straight;
    if (!b->flipped) return;
    for (int k = 0; k < SQUARE; k++) s->col[k] = 0;
    s->col[0] = -1;
    s->col[4] = 1;
    s->col[8] = b->plane == PLANE_MOVES ? -1 : 1;
}

/* Columns never move in the plane: they are fixed in the body. */
void body_subspace(const struct body *b, const real *q, struct subspace *s)
{
    (void)q;
    subspace_set(b, s);
}

/* The tree's transform, turned by q about the normal. */
static void turn(const struct body *b, real q, struct xform *x)
{
    real s, c;
    angle_sincos(b->flipped ? -q : q, &s, &c);
    x->c = b->tree.c * c - b->tree.s * s;
    x->s = b->tree.s * c + b->tree.c * s;
}

/* Turn, slide or both, from the placement. */
void body_place(const struct body *b, const real *q, struct body_pose *pose)
{
    struct xform *x = &pose->x;
    subspace_set(b, &pose->s);
    *x = b->tree;
    switch (b->plane) {
    case PLANE_TURNS:
        turn(b, q[0], x);
        break;
    case PLANE_SLIDES:
        x->p[0] += q[0] * x->c;
        x->p[1] += q[0] * x->s;
        break;
    case PLANE_MOVES:
        /* y changes its sign with the axis, x does not. */
        xform_shift(&b->tree, q[1], b->flipped ? -q[2] : q[2], x->p);
        turn(b, q[0], x);
        break;
    default:
        break;
    }
}

/* physics 1.5: centripetal at the origin, Coriolis of what slides. */
void body_bias(const struct body *b, const struct body_pose *pose, const real *v, const real *h,
               const real *u, real *bias)
{
    (void)u;
    const struct xform *x = &pose->x;
    /* omega* of (1.9), the parent's rate; p* is the joint's place in own axes. */
    const real w = v[0] - h[0], pull = -(w * w);
    bias[0] = 0;
    bias[1] = pull * (x->c * x->p[0] + x->s * x->p[1]);
    bias[2] = pull * (x->c * x->p[1] - x->s * x->p[0]);
    if (b->plane != PLANE_SLIDES && b->plane != PLANE_MOVES) return;
    /* 2 w* + w_J, as in space. */
    const real t = w + w + h[0];
    bias[1] -= t * h[2];
    bias[2] += t * h[1];
}

/* The moment about the normal and the forces in the plane. */
void body_load(const struct body *b, const double *fext, real *f)
{
    screw_zero(f);
    for (int k = 0; k < 3 && fext; k++) {
        const real *row = b->frame + 3 * k;
        const double *x = k == 0 ? fext + 3 : fext;
        f[k] = row[0] * (real)x[0] + row[1] * (real)x[1] + row[2] * (real)x[2];
    }
}

/* As in space: a planar joint's velocity is given in body axes. */
void body_qdot(const struct body *b, const real *q, const real *u, real *qd)
{
    for (int i = 0; i < b->d; i++) qd[i] = u[i];
    if (b->plane != PLANE_MOVES) return;
    real sine, cosine;
    angle_sincos(q[0], &sine, &cosine);
    qd[1] = cosine * u[1] - sine * u[2];
    qd[2] = sine * u[1] + cosine * u[2];
}

/* Angles step exactly, slides along their own axis, too. */
void body_step(const struct body *b, real *q, const real *u, real h)
{
    real rate[3];
    /* Half the turn, the shift, the other half. */
    if (b->plane == PLANE_MOVES) { /* displacement along the axes of mid-step */
        const real half = (real)0.5 * h;
        q[0] += half * u[0];
        body_qdot(b, q, u, rate);
        for (int i = 1; i < 3; i++) q[i] += h * rate[i];
        q[0] += half * u[0];
        return;
    }
    for (int i = 0; i < b->d; i++) q[i] += h * u[i];
}

/* Given columns cost 6 flops to expand (screw_axpy) and 5 to reduce (screw_dot). */
#define GIVEN(d)                                                                                   \
    .rate = 6 * (d), .h = 6 * (d), .h_transposed = 5 * (d), .w = 6 * (3 - (d)),                    \
    .w_transposed = 5 * (3 - (d))
#define PICKED(d) .rate = (d), .h = (d), .w = 3 - (d)

/* Turning the tree by an angle; the bias w, w w, the origin in own axes and its product; that of
 * slides besides. */
enum { TURN = 6, SHIFT = 8, BIAS = 10, SLIDES = 6 };

#define STEPS(n) .step = {.flop = 2 * (n)}
#define PLANAR_STEPS .qdot = {.flop = 6, .trig = 2}, .step = {.flop = 15, .trig = 2}

/* By motion in the plane; flipped joints multiply by their columns. */
static const struct joint_cost picked[PLANE_MOVES + 1] = {
    [PLANE_STAYS] = {.bias = BIAS, PICKED(0)},
    [PLANE_TURNS] = {.place = TURN, .place_trig = 2, .bias = BIAS, STEPS(1), PICKED(1)},
    [PLANE_SLIDES] = {.place = 4, .bias = BIAS + SLIDES, STEPS(1), PICKED(1)},
    [PLANE_MOVES] =
        {.place = TURN + SHIFT, .place_trig = 2, .bias = BIAS + SLIDES, PLANAR_STEPS, PICKED(3)},
};
static const struct joint_cost given[PLANE_MOVES + 1] = {
    [PLANE_TURNS] = {.place = TURN, .place_trig = 2, .bias = BIAS, STEPS(1), GIVEN(1)},
    [PLANE_MOVES] =
        {.place = TURN + SHIFT, .place_trig = 2, .bias = BIAS + SLIDES, PLANAR_STEPS, GIVEN(3)},
};

const struct joint_cost *joint_cost_of(enum model_joint joint)
{
    return &picked[joint_plane(joint)];
}

bool body_picks(const struct body *b) { return !b->flipped; }

const struct joint_cost *body_cost(const struct body *b)
{
    return b->flipped ? &given[b->plane] : &picked[b->plane];
}
