/* contraction_solve.c - one solution of the tree's constraint forces: contract, solve the roots,
 * undo (contraction.h).
 */
#include <string.h>

#include "kernel/compound.h"
#include "kernel/contraction.h"
#include "kernel/implicit.h"
#include "kernel/tags.h"
#include "linalg/dense.h"

enum { TAG_UP = TAG_TREE, TAG_DOWN = TAG_TREE + 1 };

static const struct tree_plan *plan_of(const struct contraction *k) { return k->tree.shared->plan; }
static int local_of(const struct contraction *k, int body) { return plan_of(k)->local[body]; }
static real *columns(real *array, int room, int l) { return array + SPACE * room * l; }

/* The matrices of a compound do not depend on the number of columns; its betas lie behind them, one
 * column after the other, so that a solution for one column uses the first part of the room. */
static struct compound own_compound(const struct contraction *k, int body)
{
    return compound_at(k->compound + compound_size(k->room) * local_of(k, body), k->m);
}

/* own_joint: the view of an own body's joint: what is given at it, zero where a pointer is NULL. */
static struct joint_view own_joint(const struct contraction *k, int body)
{
    const int l = local_of(k, body);
    const struct tree *t = &k->tree;
    struct joint_view v = {.x = &t->pose[l].x, .s = &t->pose[l].s};
    v.resistance = spring_resistance(tree_body(t, l), implicit_step(t->job));
    if (k->given.active) v.active = k->given.active + t->u_at[l];
    if (k->given.bias) v.bias = k->given.bias + SPACE * l;
    return v;
}

/* single_bodies: every own body as a compound: P11 = P12 = P22 = Phi, beta = Phi (Fext - P)
 * (physics 6.1). Top and bottom of a single body are the same body. */
static void single_bodies(struct contraction *k)
{
    struct tree *t = &k->tree;
    for (int l = 0; l < t->n; l++) {
        const struct body *b = tree_body(t, l);
        struct compound c = own_compound(k, t->bodies[l]);
        real full[SQUARE];
        body_phi(b, full);
        for (int i = 0; i < SPACE; i++)
            for (int j = 0; j <= i; j++)
                c.p11[packed_index(i, j)] = c.p22[packed_index(i, j)] = full[SPACE * i + j];
        memcpy(c.p12, full, sizeof full);
        for (int j = 0; j < k->m; j++) {
            real *beta = c.beta1 + SPACE * j;
            screw_zero(beta);
            if (k->given.load && (j == 0 || k->m > 1)) {
                body_accelerate(b, columns((real *)k->given.load, k->room, l) + SPACE * j, beta);
                t->work.flop += BODY_ACCELERATE_FLOP;
            }
            screw_copy(c.beta2 + SPACE * j, beta);
        }
    }
}

/* A pivot that fails does not stop the contraction: its messages are awaited elsewhere. */
static void check(struct contraction *k, bool sound) { k->broken = k->broken || !sound; }

/* rake: own leaves summed, sent to their parent's rank or absorbed there (physics 6.2, RAKE).
 * However many leaves of one owner hang there, one message of 27 numbers for m = 1. */
static void rake(struct contraction *k, const struct tree_op *op, real *record)
{
    struct tree *t = &k->tree;
    const int me = comm_rank(t->comm), m = k->m;
    real *dI = k->message, *dp = dI + PACKED;
    const int64_t bytes = (PACKED + SPACE * m) * (int64_t)sizeof(real);
    if (op->from == me) {
        memset(dI, 0, (size_t)bytes);
        /* What each leaf needs for its undoing, N and h, stays in k->joint at the leaf's owner. */
        for (int i = 0; i < op->count; i++) {
            const int v = plan_of(k)->absorbed[op->first + i];
            const struct joint_view joint = own_joint(k, v);
            const struct compound leaf = own_compound(k, v);
            check(k, compound_rake(&joint, m, &leaf,
                                   k->joint + (PACKED + SPACE * k->room) * local_of(k, v), dI, dp,
                                   &t->work));
        }
        /* From here on the leaf's owner has nothing to do until the way back. */
        if (op->to != me) {
            tree_report(t);
            comm_send(t->comm, op->to, TAG_UP, dI, bytes);
            return;
        }
    } else {
        comm_recv(t->comm, op->from, TAG_UP, dI, bytes);
    }
    /* A rake within a rank takes the same steps without the message. */
    struct compound u = own_compound(k, op->into);
    check(k, compound_absorb(m, &u, dI, dp, record, &t->work));
    tree_report(t);
}

/* merge: the compound below, here or by message with its joint's coordinates and what is given
 * there (physics 6.2, MERGE): 90 numbers for m = 1, and the joint's. */
static void merge(struct contraction *k, const struct tree_op *op, real *record)
{
    struct tree *t = &k->tree;
    const int me = comm_rank(t->comm), m = k->m, size = compound_size(m),
              v = plan_of(k)->absorbed[op->first];
    const struct body *b = &t->shared->body[v];
    /* What is not given is not sent: a correction has no bias, the first solution of a body at rest
     * neither. */
    const int nactive = k->given.active ? b->d : 0, nbias = k->given.bias ? SPACE : 0;
    const int64_t bytes = (size + b->nq + nactive + nbias) * (int64_t)sizeof(real);
    real *q = k->message + size, *active = q + b->nq, *bias = active + nactive;
    struct joint_view joint;
    struct body_pose pose;
    struct compound below;
    if (op->from == me) {
        joint = own_joint(k, v);
        below = own_compound(k, v);
        if (op->to != me) {
            /* A compound's parts lie one behind the other: one copy for all matrices and betas. */
            memcpy(k->message, below.p11, (size_t)size * sizeof(real));
            memcpy(q, t->q + t->q_at[local_of(k, v)], (size_t)b->nq * sizeof(real));
            if (nactive) memcpy(active, joint.active, (size_t)nactive * sizeof(real));
            if (nbias) screw_copy(bias, joint.bias);
            tree_report(t);
            comm_send(t->comm, op->to, TAG_UP, k->message, bytes);
            return;
        }
    } else {
        comm_recv(t->comm, op->from, TAG_UP, k->message, bytes);
        /* The joint is placed again from its coordinates: at most 7 numbers instead of a transform
         * with its subspaces. */
        body_place(b, q, &pose);
        t->work.flop += (uint64_t)body_cost(b)->place;
        t->work.trig += (uint64_t)body_cost(b)->place_trig;
        t->work.div += (uint64_t)body_cost(b)->place_div;
        t->work.call++;
        joint = (struct joint_view){&pose.x, &pose.s, nactive ? active : NULL, nbias ? bias : NULL,
                                    spring_resistance(b, implicit_step(t->job))};
        below = compound_at(k->message, m);
    }
    struct compound u = own_compound(k, op->into);
    check(k, compound_merge(&joint, m, &u, &below, record, &t->work));
    tree_report(t);
}

/* solve_roots: joint forces of the compounds that are left, against the base. Nothing hangs at
 * their bottom any more: f_2 = 0. */
static void solve_roots(struct contraction *k)
{
    struct tree *t = &k->tree;
    for (int i = 0; i < plan_of(k)->nroot; i++) {
        const int v = plan_of(k)->root[i];
        if (plan_of(k)->owner[v] != comm_rank(t->comm)) continue;
        const struct compound c = own_compound(k, v);
        const struct joint_view joint = own_joint(k, v);
        real N[PACKED], bias[SPACE] = {0}, moved[SPACE];
        /* The view with one more bias; the joint itself stays as it is. */
        struct joint_view seen = joint;
        /* f = H tau - N (P11 H tau + beta_1 - X^T V'_base - b), physics 6.2: root compounds. */
        if (joint.bias) screw_copy(bias, joint.bias);
        if (k->given.base) { /* the base's acceleration acts like a bias */
            xform_motion(moved, joint.x, k->given.base);
            screw_add(bias, moved);
            t->work.flop += XFORM_MOTION_FLOP + SCREW_ADD_FLOP;
        }
        seen.bias = bias;
        check(k, joint_compliance(&joint, c.p11, N, &t->work));
        joint_force(&seen, k->m, c.p11, N, c.beta1, NULL, columns(k->f1, k->room, local_of(k, v)),
                    &t->work);
        memset(columns(k->f2, k->room, local_of(k, v)), 0, (size_t)(SPACE * k->m) * sizeof(real));
    }
}

/* unrake: acceleration of the parent's bottom body back to the leaves: f_v = h + N X_v^T a_2.
 * (physics 6.2, Undo). */
static void unrake(struct contraction *k, const struct tree_op *op, const real *record)
{
    struct tree *t = &k->tree;
    const int me = comm_rank(t->comm), m = k->m;
    real *a2 = k->message, part[SPACE];
    if (op->to == me) {
        const real *dI = record, *n21 = record + PACKED, *n22 = n21 + SQUARE;
        const real *dp = record + COMPOUND_MATRICES, *beta2 = dp + SPACE * m;
        for (int j = 0; j < m; j++) {
            real *f1 = columns(k->f1, k->room, local_of(k, op->into)) + SPACE * j;
            real *f2 = columns(k->f2, k->room, local_of(k, op->into)) + SPACE * j,
                 *a = a2 + SPACE * j;
            /* a_2 = n21 f_1 + P22 f_2 + beta_2, all as they were after the absorption. */
            packed_multiply(n22, f2, a, &t->work);
            for (int i = 0; i < SPACE; i++)
                a[i] += screw_dot(n21 + SPACE * i, f1) + beta2[SPACE * j + i];
            /* Without the leaves' forces, f_2 is what it was before the rake. */
            packed_multiply(dI, a, part, &t->work);
            for (int i = 0; i < SPACE; i++) f2[i] -= part[i] + dp[SPACE * j + i];
            t->work.flop += SQUARE_VEC_FLOP + 4 * SCREW_ADD_FLOP;
        }
        if (op->from != me) {
            tree_report(t);
            comm_send(t->comm, op->from, TAG_DOWN, a2, SPACE * m * (int64_t)sizeof(real));
            return;
        }
    } else {
        comm_recv(t->comm, op->to, TAG_DOWN, a2, SPACE * m * (int64_t)sizeof(real));
    }
    for (int i = 0; i < op->count; i++) {
        const int l = local_of(k, plan_of(k)->absorbed[op->first + i]);
        const real *N = k->joint + (PACKED + SPACE * k->room) * l, *h = N + PACKED;
        for (int j = 0; j < m; j++) {
            real *f1 = columns(k->f1, k->room, l) + SPACE * j;
            /* The parent's acceleration in the leaf's frame; N turns it into a force. */
            xform_motion(part, &t->pose[l].x, a2 + SPACE * j);
            packed_multiply(N, part, f1, &t->work);
            screw_add(f1, h + SPACE * j);
            screw_zero(columns(k->f2, k->room, l) + SPACE * j);
            t->work.flop += XFORM_MOTION_FLOP + SCREW_ADD_FLOP;
        }
    }
    tree_report(t);
}

/* unmerge: f_v = h_0 + M_1 f_1 - M_3 f_2; v gets (f_v, f_2), u is left with -X f_v at its bottom
 * (physics 6.2, Undo). */
static void unmerge(struct contraction *k, const struct tree_op *op, const real *record)
{
    struct tree *t = &k->tree;
    const int me = comm_rank(t->comm), m = k->m, v = plan_of(k)->absorbed[op->first];
    real *pair = k->message;
    if (op->to == me) {
        /* In the order in which compound_merge left them. */
        const real *h = record, *M1 = record + SPACE * m, *M3 = M1 + SQUARE;
        const struct xform *x = (const struct xform *)(M3 + SQUARE);
        for (int j = 0; j < m; j++) {
            real *f1 = columns(k->f1, k->room, local_of(k, op->into)) + SPACE * j;
            real *f2 = columns(k->f2, k->room, local_of(k, op->into)) + SPACE * j,
                 *fv = pair + 2 * SPACE * j;
            for (int i = 0; i < SPACE; i++)
                fv[i] = h[SPACE * j + i] + screw_dot(M1 + SPACE * i, f1) -
                        screw_dot(M3 + SPACE * i, f2);
            /* v's bottom is the common bottom: f_2 goes there unchanged. */
            screw_copy(fv + SPACE, f2);
            xform_force(f2, x, fv);
            for (int i = 0; i < SPACE; i++) f2[i] = -f2[i];
            t->work.flop += 2 * SQUARE_VEC_FLOP + 2 * SCREW_ADD_FLOP + XFORM_FORCE_FLOP;
        }
        if (op->from != me) {
            tree_report(t);
            comm_send(t->comm, op->from, TAG_DOWN, pair, 2 * SPACE * m * (int64_t)sizeof(real));
            return;
        }
    } else {
        comm_recv(t->comm, op->to, TAG_DOWN, pair, 2 * SPACE * m * (int64_t)sizeof(real));
    }
    for (int j = 0; j < m; j++) {
        screw_copy(columns(k->f1, k->room, local_of(k, v)) + SPACE * j, pair + 2 * SPACE * j);
        screw_copy(columns(k->f2, k->room, local_of(k, v)) + SPACE * j,
                   pair + 2 * SPACE * j + SPACE);
    }
    tree_report(t);
}

/* Three passes: contract in the plan's order, solve the roots, undo in the opposite order. Sends do
 * not wait, and every rank keeps the global order of operations, so that no two wait for each other
 * (physics 6.3). */
void contraction_solve(struct contraction *k)
{
    const struct tree_plan *plan = plan_of(k);
    const int me = comm_rank(k->tree.comm), first = plan->ops.at[me],
              count = plan->ops.at[me + 1] - first;
    single_bodies(k);
    tree_report(&k->tree);
    for (int i = 0; i < count; i++) {
        const struct tree_op *op = &plan->op[plan->ops.item[first + i]];
        if (op->kind == TREE_RAKE) rake(k, op, k->record + k->record_at[i]);
        else merge(k, op, k->record + k->record_at[i]);
    }
    solve_roots(k);
    tree_report(&k->tree);
    for (int i = count - 1; i >= 0; i--) {
        const struct tree_op *op = &plan->op[plan->ops.item[first + i]];
        if (op->kind == TREE_RAKE) unrake(k, op, k->record + k->record_at[i]);
        else unmerge(k, op, k->record + k->record_at[i]);
    }
}
