/* loop.c - loop joints: pose, constraint subspace, velocity terms, forces. */
#include "dynamics/loop.h"

#include "dynamics/body.h"
#include "dynamics/body_constants.h"

/* The model's frame in internal axes of its body, in quad precision first. */
static void frame_to(const struct model *m, int body, const struct frame *f, struct xform *x)
{
    quad r[9], p[3];
    frame_constants_make(m, body, f, r, p);
    for (int k = 0; k < 9; k++) x->r[k] = (real)r[k];
    for (int k = 0; k < 3; k++) x->p[k] = (real)p[k];
}

/* All that depends on the model alone. */
void loop_make(const struct model *m, int i, struct loop *l)
{
    const struct loop_def *def = &m->loop[i];
    l->body_a = def->body_a;
    l->body_b = def->body_b;
    l->row_at = m->row_at[i];
    l->c = m->row_at[i + 1] - m->row_at[i];
    l->by_rows = def->nrow > 0;
    l->joint = def->joint;
    l->alpha = (real)def->alpha;
    l->beta = (real)def->beta;
    frame_to(m, def->body_a, &def->frame_a, &l->a);
    frame_to(m, def->body_b, &def->frame_b, &l->b);
    /* Files give [linear; angular], here the angular part comes first. */
    for (int k = 0; k < def->nrow; k++)
        for (int j = 0; j < 6; j++) l->row[6 * k + j] = (real)def->row[k][(j + 3) % 6];
}

/* y = a^-1 o b. */
enum { BETWEEN_FLOP = MAT3_MUL_FLOP + 3 + MAT3_VEC_FLOP };
/* The relative pose: constraints concern it alone. */
static void between(struct xform *y, const struct xform *a, const struct xform *b)
{
    real p[3];
    mat3_transposed_mul(y->r, a->r, b->r);
    for (int k = 0; k < 3; k++) p[k] = b->p[k] - a->p[k];
    mat3_mul_vec_transposed(y->p, a->r, p);
}

/* Rotation vector of a small rotation: vee of (R - R^T) / 2. */
enum { SMALL_ANGLE_FLOP = 6 };
/* Exact to second order; a constraint that is met sees no more of it. */
static void small_angle(const real *r, real *angle)
{
    const real half = (real)0.5;
    vec3_set(angle, half * (r[7] - r[5]), half * (r[2] - r[6]), half * (r[3] - r[1]));
}

/* y = w x (w x p). */
enum { CENTRIPETAL_FLOP = 2 * VEC3_CROSS_FLOP };
/* Of a point at p on a body that turns by w. */
static void centripetal(const real *w, const real *p, real *y)
{
    vec3_cross(y, w, p);
    vec3_cross(y, w, y);
}

/* Whether the constraints' directions are fixed in frame a, not in b. */
static bool moves_with_a(const struct loop *l) { return joint_has(l->joint, JOINT_AS_IT_LIES); }

/* Constraint columns in frame b for joints; r: frame b -> frame a. */
static void joint_columns(const struct loop *l, const real *r, struct loop_pose *p)
{
    /* The joint's own W (physics 1.3): its columns are fixed in frame b, whatever q. */
    struct body free = {.joint = l->joint, .d = 6 - l->c};
    struct subspace s;
    /* The constrained directions lie in frame a: columns of W are rows of r. */
    if (moves_with_a(l)) {
        for (int k = 0; k < l->c; k++)
            for (int j = 0; j < 3; j++)
                p->w[6 * k + j] = 0, p->w[6 * k + 3 + j] = r[3 * (3 - l->c + k) + j];
        return;
    }
    body_subspace(&free, NULL, &s);
    for (int k = 0; k < l->c; k++) subspace_column(&s, s.d + k, p->w + 6 * k);
}

/* Common end: projections of position error (6) and relative velocity (6); flops a constraint. */
enum { PROJECT_FLOP = 2 * SCREW_DOT_FLOP + 5 };
static void project(const struct loop *l, const real *error, const real *relative,
                    struct loop_pose *p)
{
    for (int k = 0; k < l->c; k++) {
        /* Position and velocity of the constraint, and Baumgarte's terms for both (7.2). */
        p->g[k] = screw_dot(p->w + 6 * k, error);
        p->rho[k] = screw_dot(p->w + 6 * k, relative);
        p->stabilise[k] = 2 * l->alpha * p->rho[k] + l->beta * l->beta * p->g[k];
    }
}

/* Axes of frame a; each body's own point. gamma is the difference of the points' centripetal
 * accelerations. */
enum {
    PLACE_ROWS_FLOP = 2 * XFORM_COMPOSE_FLOP + MAT3_MUL_FLOP + 2 * XFORM_MOTION_FLOP +
                      SCREW_ADD_FLOP + 2 * CENTRIPETAL_FLOP + 2 * MAT3_VEC_FLOP + 3 + BETWEEN_FLOP +
                      SMALL_ANGLE_FLOP
};
static void place_rows(const struct loop *l, const struct xform *xa, const struct xform *xb,
                       const real *va, const real *vb, struct loop_pose *p)
{
    struct xform wa, wb, rel;
    real a[6], b[6], error[6], relative[6];
    /* Both frames in the base's. */
    xform_compose(&wa, xa, &l->a);
    xform_compose(&wb, xb, &l->b);
    p->ta = l->a;
    /* Both bodies' forces in axes of frame a, each at its own point. */
    mat3_transposed_mul(p->tb.r, xb->r, wa.r);
    vec3_copy(p->tb.p, l->b.p);
    /* The rows are the columns of W as they stand: both are in axes of frame a. */
    for (int k = 0; k < 6 * l->c; k++) p->w[k] = l->row[k];
    xform_motion(a, &p->ta, va);
    xform_motion(b, &p->tb, vb);
    for (int k = 0; k < 6; k++) relative[k] = b[k] - a[k];
    real ca[3], cb[3];
    /* gamma: what the points' accelerations are at zero joint accelerations (7.3). */
    centripetal(va, l->a.p, ca);
    centripetal(vb, l->b.p, cb);
    mat3_mul_vec_transposed(ca, p->ta.r, ca);
    mat3_mul_vec_transposed(cb, p->tb.r, cb);
    screw_zero(p->gamma);
    for (int k = 0; k < 3; k++) p->gamma[3 + k] = cb[k] - ca[k];
    /* g of (7.2): rotation vector and distance from frame a to frame b. */
    between(&rel, &wa, &wb);
    small_angle(rel.r, error);
    vec3_copy(error + 3, rel.p);
    project(l, error, relative, p);
}

/* Frame b throughout: physics (7.1)-(7.3). A joint whose W moves with b adds one vector more. */
enum {
    PLACE_JOINT_FLOP = 2 * XFORM_COMPOSE_FLOP + 2 * BETWEEN_FLOP + 2 * XFORM_MOTION_FLOP +
                       SCREW_ADD_FLOP + 2 * MAT3_VEC_FLOP + VEC3_CROSS_FLOP + 2 * CENTRIPETAL_FLOP +
                       VEC3_ADD_FLOP + 3 + VEC3_CROSS_ADD_FLOP + SMALL_ANGLE_FLOP +
                       2 * MAT3_VEC_FLOP
};
static void place_joint(const struct loop *l, const struct xform *xa, const struct xform *xb,
                        const real *va, const real *vb, struct loop_pose *p)
{
    struct xform wa, wb, rel;
    real a[6], b[6], relative[6], error[6], angle[3], pa[3], pb[3], t[3];
    xform_compose(&wa, xa, &l->a);
    xform_compose(&wb, xb, &l->b);
    p->tb = l->b;
    /* Body a is taken to the point of body b: one point for both, since the joint lets them
     * slip. */
    between(&p->ta, xa, &wb);
    between(&rel, &wa, &wb);
    joint_columns(l, rel.r, p);
    xform_motion(a, &p->ta, va);
    xform_motion(b, &p->tb, vb);
    for (int k = 0; k < 6; k++) relative[k] = b[k] - a[k];
    /* omega_J and v_J of (7.1). */
    const real *turn = relative, *slip = relative + 3;
    mat3_mul_vec_transposed(pa, p->ta.r, p->ta.p);
    mat3_mul_vec_transposed(pb, p->tb.r, p->tb.p);
    /* Angular part: the relative rotation is seen from a turning frame. */
    vec3_cross(p->gamma, turn, a);
    centripetal(b, pb, p->gamma + 3);
    centripetal(a, pa, t);
    vec3_sub(p->gamma + 3, t);
    for (int k = 0; k < 3; k++) t[k] = a[k] + a[k];
    /* W moving with frame a cancels w_J x v_J */
    if (!moves_with_a(l)) vec3_add(t, turn);
    vec3_cross_sub(p->gamma + 3, t, slip);
    /* The position error, turned from frame a into frame b. */
    small_angle(rel.r, angle);
    mat3_mul_vec_transposed(error, rel.r, angle);
    mat3_mul_vec_transposed(error + 3, rel.r, rel.p);
    project(l, error, relative, p);
}

/* Rows of a file are given in frame a, joints in frame b. */
void loop_place(const struct loop *l, const struct xform *xa, const struct xform *xb,
                const real *va, const real *vb, struct loop_pose *p)
{
    p->c = l->c;
    if (l->by_rows)
        place_rows(l, xa, xb, va, vb, p);
    else
        place_joint(l, xa, xb, va, vb, p);
}

/* The sums beside the two functions above. */
int loop_place_flops(const struct loop *l)
{
    const int joint = PLACE_JOINT_FLOP + (moves_with_a(l) ? 0 : VEC3_ADD_FLOP);
    return (l->by_rows ? PLACE_ROWS_FLOP : joint) + l->c * PROJECT_FLOP;
}

/* Equal and opposite on the two bodies, each moved to its origin. */
void loop_force(const struct loop_pose *p, const real *lambda, real *fa, real *fb)
{
    /* W lambda acts on b, its reaction on a; X of physics 1.2 takes it to the bodies' origins. */
    real f[6], t[6];
    screw_zero(f);
    for (int k = 0; k < p->c; k++) screw_axpy(f, lambda[k], p->w + 6 * k);
    if (fb) {
        xform_force(t, &p->tb, f);
        screw_add(fb, t);
    }
    if (fa) {
        xform_force(t, &p->ta, f);
        screw_sub(fa, t);
    }
}

/* One column a constraint: the same force for a unit of lambda. */
void loop_column(const struct loop_pose *p, bool side_b, real *out)
{
    for (int k = 0; k < p->c; k++) {
        xform_force(out + 6 * k, side_b ? &p->tb : &p->ta, p->w + 6 * k);
        for (int j = 0; j < 6 && !side_b; j++) out[6 * k + j] = -out[6 * k + j];
    }
}

/* W^T (T_b^T a_b - T_a^T a_a + gamma) + stabilisation (7.2). */
void loop_residual(const struct loop_pose *p, const real *aa, const real *ab, real *r)
{
    real a[6], b[6];
    xform_motion(a, &p->ta, aa);
    xform_motion(b, &p->tb, ab);
    for (int k = 0; k < 6; k++) b[k] = (b[k] - a[k]) + p->gamma[k];
    for (int k = 0; k < p->c; k++) r[k] = screw_dot(p->w + 6 * k, b) + p->stabilise[k];
}
