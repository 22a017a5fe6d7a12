/* cfa_system.c - factor and solve by elimination of joints, leaves first. */
#include "dynamics/cfa_system.h"

#include "linalg/dense.h"

/* Bodies with several children couple them; others pass on to the next joint only. */
static int child_count(const struct dynamics *d, int i)
{
    return d->model->child_at[i + 1] - d->model->child_at[i];
}

/* Phi of body i as it stands.
 * Phi of a body with several children is lowered by each child that is eliminated. */
static const struct sym6 *phi_of(const struct dynamics *d, const struct cfa_system *s, int i)
{
    return child_count(d, i) > 1 ? &s->phi[i] : &d->body[i].mass->phi;
}

/* Whether column k of W is a pure rotation axis among unit columns: then X W = [r_k; 0]. */
static bool is_angular(const struct subspace *s, int k) { return s->pick && s->pick[s->d + k] < 3; }

/* Column k of X W. */
static void moved_column(const struct body_pose *pose, int k, real *xw)
{
    real column[6];
    if (!pose->s.pick) {
        subspace_column(&pose->s, pose->s.d + k, column);
        xform_force(xw, &pose->x, column);
        return;
    }
    /* A unit column moved is a column of the rotation, with a lever arm if it is a force. */
    int axis = pose->s.pick[pose->s.d + k];
    const real *r = pose->x.r + axis % 3;
    vec3_set(column, r[0], r[3], r[6]);
    if (axis < 3) {
        vec3_copy(xw, column);
        vec3_set(xw + 3, 0, 0, 0);
    } else {
        vec3_cross(xw, pose->x.p, column);
        vec3_copy(xw + 3, column);
    }
}

/* u = Phi xw; only the angular half of xw when that is all there is. */
static void phi_times(const struct sym6 *phi, const real *xw, bool angular, real *u)
{
    if (!angular) {
        sym6_mul(u, phi, xw);
        return;
    }
    /* Half of the products are with zeros. */
    sym3_mul_vec(u, phi->a, xw);
    mat3_mul_vec_transposed(u + 3, phi->b, xw);
}

/* g (packed) = W^T Phi W. */
static void project(const struct subspace *s, const struct sym6 *phi, real *g, struct work *w)
{
    real full[36], t[36];
    sym6_expand(full, phi);
    /* Picked columns: the entries are there already. */
    if (s->pick) {
        for (int i = 0; i < s->c; i++)
            for (int j = 0; j <= i; j++)
                g[packed_index(i, j)] = full[6 * s->pick[s->d + i] + s->pick[s->d + j]];
        return;
    }
    for (int j = 0; j < s->c; j++)
        for (int i = 0; i < 6; i++) t[6 * j + i] = screw_dot(full + 6 * i, s->col + 6 * (s->d + j));
    for (int i = 0; i < s->c; i++)
        for (int j = 0; j <= i; j++)
            g[packed_index(i, j)] = screw_dot(s->col + 6 * (s->d + i), t + 6 * j);
    w->flop += (uint64_t)(SCREW_DOT_FLOP * (6 * s->c + packed_size(s->c)));
}

/* phi -= y^T D^-1 y for y (c x 6). */
static void lower_phi(struct sym6 *phi, int c, const real *y, const real *g)
{
    /* The 21 entries of a symmetric 6x6, block by block. */
    static const signed char row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int k = 0; k < c; k++) {
        const real *v = y + 6 * k;
        real inverse = g[packed_index(k, k)], t[6];
        for (int j = 0; j < 6; j++) t[j] = inverse * v[j];
        for (int e = 0; e < 6; e++) {
            phi->a[e] -= t[row[e]] * v[column[e]];
            phi->c[e] -= t[3 + row[e]] * v[3 + column[e]];
        }
        for (int e = 0; e < 9; e++) phi->b[e] -= t[e / 3] * v[3 + e % 3];
    }
}

/* The parent's block (packed n x n) -= y^T D^-1 y for y (c x n).
 * The parent's W is known, so its block of A itself can be lowered. */
static void lower_block(real *block, int n, int c, const real *y, const real *g)
{
    for (int k = 0; k < c; k++) {
        const real *v = y + n * k;
        real inverse = g[packed_index(k, k)];
        for (int i = 0; i < n; i++) {
            real t = inverse * v[i];
            for (int j = 0; j <= i; j++) block[packed_index(i, j)] -= t * v[j];
        }
    }
}

/* U = Phi_p X W (column k at u + 6 k) and g += (X W)^T U; returns the flops. */
static int couple(const struct body_pose *pose, const struct sym6 *phi, real *u, real *g)
{
    int c = pose->s.c, flop = 0;
    real xw[36];
    for (int k = 0; k < c; k++) {
        /* A moment needs no lever arm: 30 flops instead of 75. */
        bool angular = is_angular(&pose->s, k);
        moved_column(pose, k, xw + 6 * k);
        phi_times(phi, xw + 6 * k, angular, u + 6 * k);
        flop += angular ? 2 * MAT3_VEC_FLOP
                        : SYM6_MUL_FLOP + (pose->s.pick ? VEC3_CROSS_FLOP : XFORM_FORCE_FLOP);
        for (int j = 0; j <= k; j++) {
            int first = is_angular(&pose->s, j) ? j : k, other = first == j ? k : j;
            bool short_dot = is_angular(&pose->s, first);
            g[packed_index(k, j)] += short_dot ? vec3_dot(xw + 6 * first, u + 6 * other)
                                               : screw_dot(xw + 6 * first, u + 6 * other);
            flop += short_dot ? VEC3_DOT_FLOP + 1 : SCREW_DOT_FLOP + 1;
        }
    }
    return flop;
}

/* Eliminate joint i; false when its block is not positive definite. */
static bool eliminate(struct dynamics *d, int i, struct cfa_system *s, struct work *w)
{
    const struct body_pose *pose = &d->pose[i];
    struct cfa_row *row = &s->row[i];
    int c = pose->s.c, parent = d->body[i].parent;
    real u[36];
    if (c == 0) return true;
    /* All children have been eliminated: its own diagonal block is final now. */
    if (child_count(d, i) > 1) project(&pose->s, &s->phi[i], row->g, w);
    /* A joint on the base couples to nobody below. */
    if (parent < 0) return dense_factor(c, row->g, row->g, w);
    w->flop += (uint64_t)couple(pose, phi_of(d, s, parent), u, row->g);
    if (!dense_factor(c, row->g, row->g, w)) return false;
    /* An only child meets one joint below, others the whole body (6 columns). */
    bool alone = child_count(d, parent) == 1;
    const struct subspace *ps = &d->pose[parent].s;
    row->width = alone ? ps->c : 6;
    for (int k = 0; k < c; k++) {
        if (alone)
            subspace_w_transposed(ps, u + 6 * k, row->y + row->width * k);
        else
            screw_copy(row->y + 6 * k, u + 6 * k);
    }
    dense_forward(c, row->width, row->g, row->y, w);
    if (alone)
        lower_block(s->row[parent].g, row->width, c, row->y, row->g);
    else
        lower_phi(&s->phi[parent], c, row->y, row->g);
    uint64_t n = (uint64_t)row->width;
    w->flop += (uint64_t)c * (n + n * (n + 1));
    if (alone) w->flop += (uint64_t)(c * joint_cost_of(d->body[parent].joint)->w_transposed);
    return true;
}

/* All own blocks first, then every joint's elimination adds to its parent's. */
bool cfa_factor(struct dynamics *d, struct cfa_system *s, struct work *w)
{
    /* A chain needs no lowered Phi: every body has at most one child. */
    s->row = TAKE(d->arena, d->nbody, struct cfa_row);
    s->phi = d->model->is_chain ? NULL : TAKE(d->arena, d->nbody, struct sym6);
    for (int i = 0; i < d->nbody; i++) {
        if (child_count(d, i) > 1)
            s->phi[i] = d->body[i].mass->phi;
        else
            project(&d->pose[i].s, &d->body[i].mass->phi, s->row[i].g, w);
    }
    /* Children have higher numbers than their parents: no fill on this way (physics 6.1). */
    for (int i = d->nbody - 1; i >= 0; i--)
        if (!eliminate(d, i, s, w)) return false;
    return true;
}

/* Towards the root: r_i = L^-1 (r_i + what children left), its effect on the parent. beta (nbody x
 * 6): accelerations of bodies with several children by the forces eliminated there. */
static void solve_inward(struct dynamics *d, const struct cfa_system *s, int i, real *r, real *beta,
                         struct work *w)
{
    const struct body_pose *pose = &d->pose[i];
    const struct cfa_row *row = &s->row[i];
    int c = pose->s.c, parent = d->body[i].parent;
    /* Where the effect below goes: into the row of the next joint, or into the body that siblings
     * share. */
    bool alone = parent >= 0 && child_count(d, parent) == 1, carried = parent >= 0 && !alone;
    const bool gathers = child_count(d, i) > 1;
    real t[6] = {0}, z[6];
    /* What the siblings' forces do to the common parent. */
    if (carried) xform_motion(t, &pose->x, beta + 6 * parent);
    if (gathers) screw_sub(t, beta + 6 * i);
    if (carried || gathers) {
        subspace_w_transposed(&pose->s, t, z);
        for (int k = 0; k < c; k++) r[6 * i + k] += z[k];
        w->flop += (uint64_t)(joint_cost_of(d->body[i].joint)->w_transposed + c);
    }
    /* L^-1 of the row, then its effect below through y. */
    dense_forward(c, 1, row->g, r + 6 * i, w);
    for (int k = 0; k < c && parent >= 0; k++) {
        real scaled = r[6 * i + k] * row->g[packed_index(k, k)];
        real *to = alone ? r + 6 * parent : beta + 6 * parent;
        for (int j = 0; j < row->width; j++)
            to[j] += (alone ? scaled : -scaled) * row->y[row->width * k + j];
    }
    if (parent >= 0) w->flop += (uint64_t)(c * (1 + 2 * row->width));
    w->flop += (uint64_t)((carried ? XFORM_MOTION_FLOP : 0) + (gathers ? SCREW_ADD_FLOP : 0));
}

/* Towards the leaves: x_i = L^-T D^-1 (r_i + y g), g the parent's x or the joint force on it not
 * yet spoken for. */
static void solve_outward(struct dynamics *d, const struct cfa_system *s, int i, real *r, real *g,
                          real *x, struct work *w)
{
    const struct body_pose *pose = &d->pose[i];
    const struct cfa_row *row = &s->row[i];
    int c = pose->s.c, parent = d->body[i].parent;
    bool alone = parent >= 0 && child_count(d, parent) == 1;
    /* The root has nothing below it. */
    const real *from = parent < 0 ? NULL : alone ? r + 6 * parent : g + 6 * parent;
    real *force = x + 6 * i, t[6];
    for (int k = 0; k < c; k++)
        for (int j = 0; j < row->width; j++) r[6 * i + k] += row->y[row->width * k + j] * from[j];
    /* D^-1 and L^-T of the row. */
    dense_scale(c, 1, row->g, r + 6 * i, w);
    dense_backward(c, 1, row->g, r + 6 * i, w);
    screw_zero(force);
    subspace_w(&pose->s, r + 6 * i, force);
    screw_copy(g + 6 * i, force);
    w->flop += (uint64_t)(2 * c * row->width + joint_cost_of(d->body[i].joint)->w);
    /* The parent's remaining force is what its other children see. */
    if (parent < 0 || alone) return;
    xform_force(t, &pose->x, force);
    screw_sub(g + 6 * parent, t);
    w->flop += XFORM_FORCE_FLOP + 6;
}

/* Two sweeps for each right-hand side; the factors stay. */
void cfa_solve(struct dynamics *d, const struct cfa_system *s, real *r, real *x, struct work *w)
{
    struct arena_mark mark = arena_mark(d->arena);
    real *beta = TAKE(d->arena, size_product(6, d->nbody), real),
         *g = TAKE(d->arena, size_product(6, d->nbody), real);
    for (int i = d->nbody - 1; i >= 0; i--) solve_inward(d, s, i, r, beta, w);
    for (int i = 0; i < d->nbody; i++) solve_outward(d, s, i, r, g, x, w);
    arena_release(d->arena, mark);
}
