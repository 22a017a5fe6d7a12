/* joint.c - motion of the joint types: transforms, subspaces, bias, stepping along the group (physics 1.3). */
#include "dynamics/body.h"

#include "linalg/angle.h"

/* Columns of constant subspaces: H's in the order of u, then W's. */
static const signed char pick_fixed[6] = {0, 1, 2, 3, 4, 5};
static const signed char pick_revolute[6] = {2, 0, 1, 3, 4, 5};
static const signed char pick_prismatic[6] = {5, 0, 1, 2, 3, 4};
static const signed char pick_cylindrical[6] = {2, 5, 0, 1, 3, 4};
static const signed char pick_spherical[6] = {0, 1, 2, 3, 4, 5};
static const signed char pick_planar[6] = {2, 3, 4, 0, 1, 5};
static const signed char pick_floating[6] = {3, 4, 5, 0, 1, 2};

static const signed char *const pick_of[JOINT_MIXED] = {
    [JOINT_FIXED] = pick_fixed,
    [JOINT_REVOLUTE] = pick_revolute,
    [JOINT_PRISMATIC] = pick_prismatic,
    [JOINT_CYLINDRICAL] = pick_cylindrical,
    [JOINT_SPHERICAL] = pick_spherical,
    [JOINT_PLANAR] = pick_planar,
    [JOINT_FLOATING] = pick_floating,
};

/* Rotation of the quaternion x y z w, evaluated as if it were normalised. */
static void quaternion_rotation(const real *q, real *r)
{
    real x = q[0], y = q[1], z = q[2], w = q[3];
    real f = 2 / (x * x + y * y + z * z + w * w);
    real fx = f * x, fy = f * y, fz = f * z;
    real xx = fx * x, yy = fy * y, zz = fz * z, xy = fx * y, xz = fx * z, yz = fy * z, wx = fx * w, wy = fy * w,
         wz = fz * w;
    r[0] = 1 - (yy + zz), r[1] = xy - wz, r[2] = xz + wy;
    r[3] = xy + wz, r[4] = 1 - (xx + zz), r[5] = yz - wx;
    r[6] = xz - wy, r[7] = yz + wx, r[8] = 1 - (xx + yy);
}

/* r = E Rz(theta). */
static void turn_about_z(const real *e, real theta, real *r)
{
    real s, c;
    angle_sincos(theta, &s, &c);
    for (int i = 0; i < 3; i++) {
        r[3 * i] = c * e[3 * i] + s * e[3 * i + 1];
        r[3 * i + 1] = c * e[3 * i + 1] - s * e[3 * i];
        r[3 * i + 2] = e[3 * i + 2];
    }
}

/* p = t + E (x, y, z). */
static void shift(const struct xform *tree, real x, real y, real z, real *p)
{
    real d[3] = {x, y, z};
    mat3_mul_vec(p, tree->r, d);
    vec3_add(p, tree->p);
}

/* p = t + x E's column k. */
static void shift_along(const struct xform *tree, int k, real x, real *p)
{
    for (int i = 0; i < 3; i++) p[i] = tree->p[i] + x * tree->r[3 * i + k];
}

/* Sliding directions: displacement in the joint frame of the first n of slide's rows by x (n). */
static void slide_by(const struct body *b, int n, const real *x, real *d)
{
    for (int i = 0; i < 3; i++) {
        d[i] = x[0] * b->slide[i];
        if (n > 1) d[i] += x[1] * b->slide[3 + i];
    }
}

static void place_quaternion(const struct body *b, const real *quat, struct xform *x)
{
    real rotation[9];
    quaternion_rotation(quat, rotation);
    mat3_mul(x->r, b->tree.r, rotation);
}

/* Slot and point-plane: W and the last columns of H follow the directions seen from the body. */
static void slide_subspace(const struct body *b, const real *rotation, struct subspace *s)
{
    for (int k = 0; k < 36; k++) s->col[k] = 0;
    for (int k = 0; k < 3; k++) {
        s->col[6 * k + k] = 1;
        mat3_mul_vec_transposed(s->col + 6 * (3 + k) + 3, rotation, b->slide + 3 * k);
    }
}

/* H = [(cos b, 0, sin b); 0], [y; 0]; W = [(-sin b, 0, cos b); 0], [0; U]. */
static void universal_subspace(real sine, real cosine, struct subspace *s)
{
    for (int k = 0; k < 36; k++) s->col[k] = 0;
    s->col[0] = cosine, s->col[2] = sine;
    s->col[6 + 1] = 1;
    s->col[12] = -sine, s->col[14] = cosine;
    for (int k = 3; k < 6; k++) s->col[6 * k + k] = 1;
}

/* H = unit [z; pitch z]; W = unit [-pitch z; z], then the four others. */
static void helical_subspace(const struct body *b, struct subspace *s)
{
    static const signed char others[4] = {0, 1, 3, 4};
    for (int k = 0; k < 36; k++) s->col[k] = 0;
    const real advance = b->unit * b->pitch;
    s->col[2] = b->unit, s->col[5] = advance;
    s->col[6 + 2] = -advance, s->col[6 + 5] = b->unit;
    for (int k = 0; k < 4; k++) s->col[6 * (2 + k) + others[k]] = 1;
}

void body_subspace(const struct body *b, const real *q, struct subspace *s)
{
    s->d = b->d;
    s->c = 6 - b->d;
    s->pick = pick_of[b->joint];
    if (s->pick) return;
    if (b->joint == JOINT_UNIVERSAL) {
        real sine, cosine;
        angle_sincos(q[1], &sine, &cosine);
        universal_subspace(sine, cosine, s);
    } else if (b->joint == JOINT_HELICAL) {
        helical_subspace(b, s);
    } else {
        real rotation[9];
        quaternion_rotation(q, rotation);
        slide_subspace(b, rotation, s);
    }
}

/* r = E Rx(alpha) Ry(beta). */
static void place_universal(const struct body *b, const real *q, struct body_pose *pose)
{
    const real *e = b->tree.r;
    real sa, ca, sb, cb, *r = pose->x.r;
    angle_sincos(q[0], &sa, &ca);
    angle_sincos(q[1], &sb, &cb);
    for (int i = 0; i < 3; i++) {
        real x = e[3 * i], y = ca * e[3 * i + 1] + sa * e[3 * i + 2], z = ca * e[3 * i + 2] - sa * e[3 * i + 1];
        r[3 * i] = cb * x - sb * z;
        r[3 * i + 1] = y;
        r[3 * i + 2] = cb * z + sb * x;
    }
    vec3_copy(pose->x.p, b->tree.p);
    universal_subspace(sb, cb, &pose->s);
}

/* Slot and point-plane: p = t + E (directions . x). */
static void place_sliding(const struct body *b, const real *q, struct body_pose *pose)
{
    real rotation[9], d[3];
    quaternion_rotation(q, rotation);
    mat3_mul(pose->x.r, b->tree.r, rotation);
    slide_by(b, b->d - 3, q + 4, d);
    shift(&b->tree, d[0], d[1], d[2], pose->x.p);
    slide_subspace(b, rotation, &pose->s);
}

/* long: one case per joint type */
void body_place(const struct body *b, const real *q, struct body_pose *pose)
{
    struct xform *x = &pose->x;
    const struct xform *tree = &b->tree;
    pose->s.d = b->d;
    pose->s.c = 6 - b->d;
    pose->s.pick = pick_of[b->joint];
    switch (b->joint) {
    case JOINT_FIXED: *x = *tree; break;
    case JOINT_REVOLUTE:
        turn_about_z(tree->r, q[0], x->r);
        vec3_copy(x->p, tree->p);
        break;
    case JOINT_PRISMATIC:
        for (int i = 0; i < 9; i++) x->r[i] = tree->r[i];
        shift_along(tree, 2, q[0], x->p);
        break;
    case JOINT_HELICAL:
        turn_about_z(tree->r, q[0], x->r);
        shift_along(tree, 2, b->pitch * q[0], x->p);
        helical_subspace(b, &pose->s);
        break;
    case JOINT_CYLINDRICAL:
        turn_about_z(tree->r, q[0], x->r);
        shift_along(tree, 2, q[1], x->p);
        break;
    case JOINT_UNIVERSAL: place_universal(b, q, pose); break;
    case JOINT_SPHERICAL:
        place_quaternion(b, q, x);
        vec3_copy(x->p, tree->p);
        break;
    case JOINT_PLANAR:
        turn_about_z(tree->r, q[0], x->r);
        shift(tree, q[1], q[2], 0, x->p);
        break;
    case JOINT_SLOT:
    case JOINT_POINT_PLANE: place_sliding(b, q, pose); break;
    case JOINT_FLOATING:
        place_quaternion(b, q + 3, x);
        shift(tree, q[0], q[1], q[2], x->p);
        break;
    case JOINT_MIXED: break;
    }
}

void body_rate(const struct body_pose *pose, const real *u, real *h)
{
    screw_zero(h);
    subspace_h(&pose->s, u, h);
}

/* kappa: acceleration by the motion of H's columns in the body. */
static void add_kappa(const struct body *b, const struct body_pose *pose, const real *h, const real *u, real *bias)
{
    if (b->joint == JOINT_UNIVERSAL) {
        real rate = u[0] * u[1];
        bias[0] -= pose->s.col[2] * rate;
        bias[2] += pose->s.col[0] * rate;
    } else if (b->joint == JOINT_SLOT || b->joint == JOINT_POINT_PLANE) {
        vec3_cross_sub(bias + 3, h, h + 3);
    }
}

void body_bias(const struct body *b, const struct body_pose *pose, const real *v, const real *h, const real *u,
               real *bias)
{
    real w[3], p[3], t[3];
    for (int i = 0; i < 3; i++) w[i] = v[i] - h[i];
    mat3_mul_vec_transposed(p, pose->x.r, pose->x.p);
    vec3_cross(bias, w, h);
    vec3_cross(t, w, p);
    vec3_cross(bias + 3, w, t);
    /* 2 w x v_J + w_J x v_J */
    if (b->joint != JOINT_FIXED && b->joint != JOINT_REVOLUTE && b->joint != JOINT_SPHERICAL &&
        b->joint != JOINT_UNIVERSAL) {
        for (int i = 0; i < 3; i++) t[i] = w[i] + w[i] + h[i];
        vec3_cross_add(bias + 3, t, h + 3);
        add_kappa(b, pose, h, u, bias);
    } else if (b->joint == JOINT_UNIVERSAL) {
        add_kappa(b, pose, h, u, bias);
    }
}

void body_qdot(const struct body *b, const real *q, const real *u, real *qd)
{
    const real *c = q, *w = u;
    real *cd = qd;
    switch (b->joint) {
    case JOINT_HELICAL: qd[0] = b->unit * u[0]; return;
    case JOINT_PLANAR: {
        real sine, cosine;
        angle_sincos(q[0], &sine, &cosine);
        vec3_set(qd, u[0], cosine * u[1] - sine * u[2], sine * u[1] + cosine * u[2]);
        return;
    }
    case JOINT_FLOATING: {
        real rotation[9];
        quaternion_rotation(q + 3, rotation);
        mat3_mul_vec(qd, rotation, u);
        c = q + 3, w = u + 3, cd = qd + 3;
        break;
    }
    case JOINT_SPHERICAL: break;
    case JOINT_SLOT:
    case JOINT_POINT_PLANE:
        for (int i = 3; i < b->d; i++) qd[1 + i] = u[i];
        break;
    default:
        for (int i = 0; i < b->d; i++) qd[i] = u[i];
        return;
    }
    /* c' = 1/2 c (0, w) */
    real half = (real)0.5;
    cd[0] = half * (c[3] * w[0] + c[1] * w[2] - c[2] * w[1]);
    cd[1] = half * (c[3] * w[1] + c[2] * w[0] - c[0] * w[2]);
    cd[2] = half * (c[3] * w[2] + c[0] * w[1] - c[1] * w[0]);
    cd[3] = -half * (c[0] * w[0] + c[1] * w[1] + c[2] * w[2]);
}

/* c <- c exp(h w / 2), normalised. */
static void step_quaternion(real *c, const real *w, real h)
{
    const real norm = vec3_norm(w), half = (real)0.5 * h;
    real s, k;
    angle_sincos(half * norm, &s, &k);
    real f = norm > 0 ? s / norm : half;
    real x = f * w[0], y = f * w[1], z = f * w[2];
    real n[4] = {c[0] * k + c[3] * x + c[1] * z - c[2] * y, c[1] * k + c[3] * y + c[2] * x - c[0] * z,
                 c[2] * k + c[3] * z + c[0] * y - c[1] * x, c[3] * k - c[0] * x - c[1] * y - c[2] * z};
    real scale = 1 / real_sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] + n[3] * n[3]);
    for (int i = 0; i < 4; i++) c[i] = scale * n[i];
}

void body_step(const struct body *b, real *q, const real *u, real h)
{
    real rate[7], half;
    switch (b->joint) {
    case JOINT_SPHERICAL: step_quaternion(q, u, h); return;
    case JOINT_SLOT:
    case JOINT_POINT_PLANE:
        step_quaternion(q, u, h);
        for (int i = 3; i < b->d; i++) q[1 + i] += h * u[i];
        return;
    case JOINT_FLOATING:
        /* displacement along the axes of mid-step, so that the step is symmetric in time */
        half = (real)0.5 * h;
        step_quaternion(q + 3, u + 3, half);
        body_qdot(b, q, u, rate);
        for (int i = 0; i < 3; i++) q[i] += h * rate[i];
        step_quaternion(q + 3, u + 3, half);
        return;
    case JOINT_PLANAR:
        half = (real)0.5 * h;
        q[0] += half * u[0];
        body_qdot(b, q, u, rate);
        for (int i = 1; i < 3; i++) q[i] += h * rate[i];
        q[0] += half * u[0];
        return;
    default:
        body_qdot(b, q, u, rate);
        for (int i = 0; i < b->nq; i++) q[i] += h * rate[i];
    }
}
