/* body_constants.c - turning of frames and inverse inertias, always compiled in quad precision. */
#undef REAL_BITS
#define REAL_BITS 128
#include "dynamics/body_constants.h"

#include "linalg/vec3.h"

/* Rotation of a quaternion x y z w of any length. */
static void rotation_of(const double *quat, quad *r)
{
    /* In quad from the file's doubles: a length that is off by rounding is no error of the
     * rotation. */
    quad x = quat[0], y = quat[1], z = quat[2], w = quat[3];
    quad f = 2 / (x * x + y * y + z * z + w * w);
    r[0] = 1 - f * (y * y + z * z), r[1] = f * (x * y - w * z), r[2] = f * (x * z + w * y);
    r[3] = f * (x * y + w * z), r[4] = 1 - f * (x * x + z * z), r[5] = f * (y * z - w * x);
    r[6] = f * (x * z - w * y), r[7] = f * (y * z + w * x), r[8] = 1 - f * (x * x + y * y);
}

/* x = the given direction made unit. Squares of doubles overflow in doubles, never in quad. */
void direction_unit(const double *from, quad *x)
{
    for (int i = 0; i < 3; i++) x[i] = from[i];
    vec3_scale(x, 1 / vec3_norm(x), x);
}

/* t = the part of t orthogonal to the unit vector n, made unit. */
void direction_orthonormalise(quad *t, const quad *n)
{
    quad dot = vec3_dot(t, n);
    for (int i = 0; i < 3; i++) t[i] -= dot * n[i];
    vec3_scale(t, 1 / vec3_norm(t), t);
}

/* Some unit vector orthogonal to n: exact for coordinate axes. */
void direction_any_orthogonal(const quad *n, quad *t)
{
    /* Along the smallest component, so that the difference does not cancel. */
    int k = 0;
    for (int i = 1; i < 3; i++)
        if (fabsq(n[i]) < fabsq(n[k])) k = i;
    vec3_set(t, k == 0, k == 1, k == 2);
    direction_orthonormalise(t, n);
}

/* Columns of a rotation from two of its columns, first (index i) and second (index (i + 1) % 3). */
static void rotation_from(quad *r, int i, const quad *first, const quad *second)
{
    quad third[3];
    vec3_cross(third, first, second);
    for (int k = 0; k < 3; k++) {
        r[3 * k + i] = first[k];
        r[3 * k + (i + 1) % 3] = second[k];
        r[3 * k + (i + 2) % 3] = third[k];
    }
}

/* Columns: the joint's own axes, its axis along z (or x), as its traits say. */
static void own_axes(const struct body_def *b, quad *columns)
{
    quad n[3], t[3];
    const bool directed = b->axis2[0] != 0 || b->axis2[1] != 0 || b->axis2[2] != 0;
    direction_unit(b->axis, n);
    if (joint_has(b->joint, JOINT_TWO_AXES) || (joint_has(b->joint, JOINT_NORMAL) && directed)) {
        direction_unit(b->axis2, t);
        direction_orthonormalise(t, n);
    } else {
        direction_any_orthogonal(n, t);
    }
    rotation_from(columns, joint_has(b->joint, JOINT_ALONG_X) ? 0 : 2, n, t);
}

/* Whether the joint's axis is z as it stands and nothing else is asked of x and y: the common
 * case. */
static bool along_z(const struct body_def *b)
{
    return !joint_has(b->joint, JOINT_TWO_AXES) && b->axis[0] == 0 && b->axis[1] == 0 &&
           b->axis[2] > 0 && b->axis2[0] == 0 && b->axis2[1] == 0 && b->axis2[2] == 0;
}

/* The rotation internal -> user of body i's frame: the joint's own axes. False: not turned. */
static bool turn_of(const struct model *m, int i, quad *r)
{
    mat3_identity(r);
    if (i < 0) return false;
    const struct body_def *b = &m->body[i];
    if (along_z(b) || !joint_has(b->joint, JOINT_AXIS) || joint_has(b->joint, JOINT_AS_IT_LIES))
        return false;
    own_axes(b, r);
    return !(r[0] == 1 && r[4] == 1 && r[8] == 1);
}

/* The joint's own axes as rows, where they do not turn the body's frame. */
static void slide_of(const struct body_def *b, quad *slide)
{
    quad columns[9];
    mat3_identity(slide);
    if (!joint_has(b->joint, JOINT_AS_IT_LIES)) return;
    own_axes(b, columns);
    mat3_transpose(slide, columns);
}

/* y = R^T S R for the symmetric S.
 * Of an inertia given in user axes. */
static void turn_back(quad *y, const quad *r, const quad *s)
{
    quad transposed[9];
    mat3_transpose(transposed, r);
    sym3_rotate(y, transposed, s);
}

/* Inverse of a symmetric 3x3 by cofactors; false when it is not positive definite. */
static bool invert(quad *y, const quad *s)
{
    /* Cofactors of the first row give determinant and inverse. */
    quad a = s[3] * s[5] - s[4] * s[4], b = s[2] * s[4] - s[1] * s[5],
         c = s[1] * s[4] - s[2] * s[3];
    quad det = s[0] * a + s[1] * b + s[2] * c;
    if (!(s[0] > 0) || !(s[0] * s[3] - s[1] * s[1] > 0) || !(det > 0)) return false;
    y[0] = a / det, y[1] = b / det, y[2] = c / det;
    y[3] = (s[0] * s[5] - s[2] * s[2]) / det;
    y[4] = (s[1] * s[2] - s[0] * s[4]) / det;
    y[5] = (s[0] * s[3] - s[1] * s[1]) / det;
    return true;
}

/* Phi = [Ji, -Ji s~; s~ Ji, U/m - s~ Ji s~], zero when there is none. */
static void phi_of(struct body_constants *c, quad mass)
{
    quad inverse[6], full[9], skew[9], t[9];
    for (int i = 0; i < 9; i++) c->phi_b[i] = 0;
    for (int i = 0; i < 6; i++) c->phi_a[i] = c->phi_c[i] = 0;
    /* Massless bodies and point masses have none; the constraint force algorithm refuses them. */
    if (!(mass > 0) || !invert(inverse, c->jc)) return;
    for (int i = 0; i < 6; i++) c->phi_a[i] = inverse[i];
    /* (1.8), about the body's origin. */
    sym3_expand(full, inverse);
    mat3_skew(skew, c->s);
    mat3_mul(t, full, skew);
    for (int i = 0; i < 9; i++) c->phi_b[i] = -t[i];
    mat3_mul(full, skew, c->phi_b);
    sym3_from_mat3(c->phi_c, full);
    c->phi_c[0] += 1 / mass, c->phi_c[3] += 1 / mass, c->phi_c[5] += 1 / mass;
}

/* Inertia about the origin: J - m s~ s~. */
static void about_origin(struct body_constants *c, quad mass)
{
    const quad *s = c->s;
    vec3_scale(c->ms, mass, s);
    /* J - m s~ s~, written out. */
    c->j[0] = c->jc[0] + mass * (s[1] * s[1] + s[2] * s[2]);
    c->j[1] = c->jc[1] - mass * (s[0] * s[1]);
    c->j[2] = c->jc[2] - mass * (s[0] * s[2]);
    c->j[3] = c->jc[3] + mass * (s[0] * s[0] + s[2] * s[2]);
    c->j[4] = c->jc[4] - mass * (s[1] * s[2]);
    c->j[5] = c->jc[5] + mass * (s[0] * s[0] + s[1] * s[1]);
}

/* Frames are given in user axes; everything inside is in turned ones. */
void frame_constants_make(const struct model *m, int i, const struct frame *f, quad *r, quad *p)
{
    quad turn[9], rotation[9], offset[3] = {f->p[0], f->p[1], f->p[2]};
    bool turned = turn_of(m, i, turn);
    rotation_of(f->quat, turned ? rotation : r);
    vec3_copy(p, offset);
    if (!turned) return;
    mat3_transposed_mul(r, turn, rotation);
    mat3_mul_vec_transposed(p, turn, offset);
}

/* The parent's frame is turned, too: both ends of the joint's placement. */
void body_constants_place(const struct model *m, int i, struct body_constants *c)
{
    const struct body_def *b = &m->body[i];
    quad r[9];
    c->turned = turn_of(m, i, c->user);
    frame_constants_make(m, b->parent, &b->placement, c->turned ? r : c->tree_r, c->tree_p);
    if (c->turned) mat3_mul(c->tree_r, r, c->user);
    slide_of(b, c->slide);
    quad pitch = b->pitch;
    c->unit = b->pitch == 0 ? 1 : 1 / sqrtq(1 + pitch * pitch);
}

/* Turned by the same rotation as the frame. */
void body_constants_inertia(const struct model *m, int i, struct body_constants *c)
{
    const struct body_def *b = &m->body[i];
    for (int k = 0; k < 3; k++) c->s[k] = b->com[k];
    for (int k = 0; k < 6; k++) c->jc[k] = b->inertia[k];
    if (turn_of(m, i, c->user)) {
        quad inertia[6];
        for (int k = 0; k < 6; k++) inertia[k] = b->inertia[k];
        /* Centre and inertia into turned axes together. */
        mat3_mul_vec_transposed(c->s, c->user, c->s);
        turn_back(c->jc, c->user, inertia);
    }
    about_origin(c, b->mass);
    phi_of(c, b->mass);
}
