/* tree.c - parallel Newton-Euler on pieces of a tree (tree.h). */
#include "kernel/tree.h"

#include <string.h>

#include "kernel/tags.h"

/* A pair is a transform and a vector: 144 bytes in double precision, a vector 48. */
enum {
    VECTOR_BYTES = SPACE * (int)sizeof(real),
    PAIR_BYTES = (XFORM_NUMBERS + SPACE) * (int)sizeof(real)
};

/* side_owners: of the 2 nloop loop sides; -1: the base, which no rank owns. */
static const int *side_owners(const struct model *m, const struct tree_plan *plan, struct arena *a)
{
    int *owner = TAKE(a, size_sum(size_product(2, m->nloop), 1), int);
    for (int l = 0; l < m->nloop; l++) {
        owner[2 * l] = m->loop[l].body_a < 0 ? -1 : plan->owner[m->loop[l].body_a];
        owner[2 * l + 1] = m->loop[l].body_b < 0 ? -1 : plan->owner[m->loop[l].body_b];
    }
    return owner;
}

struct tree_shared *tree_shared_make(const struct kernel_job *job, struct arena *a)
{
    const struct model *m = job->model;
    struct tree_shared *s = TAKE(a, 1, struct tree_shared);
    s->plan = tree_plan_make(m, job->nrank, a);
    s->body = bodies_make(m, a);
    base_motion(m, job->state, s->base);
    s->closure = closure_shared_make(m, s->body, job->omit.base ? NULL : s->base,
                                     side_owners(m, s->plan, a), a);
    return s;
}

/* One function carves and measures: while measuring, pointers are NULL and only sizes count. */
void tree_carve(struct tree *t, struct carve *c, const struct kernel_job *job, int rank)
{
    const struct tree_shared *s = job->shared;
    const struct tree_plan *plan = s->plan;
    t->job = job;
    t->shared = s;
    t->piece = rank < plan->npiece ? rank : -1;
    t->bodies = plan->bodies.item + plan->bodies.at[rank];
    t->n = plan->bodies.at[rank + 1] - plan->bodies.at[rank];
    t->poses = s->closure != NULL;
    /* Places of own joints in q and u; needed while running only, hence the tests for NULL. */
    int *q_at = CARVE(c, t->n + 1, int), *u_at = CARVE(c, t->n + 1, int);
    t->nq = t->nu = 0;
    for (int l = 0; l < t->n; l++) {
        const struct body *b = tree_body(t, l);
        if (q_at) q_at[l] = t->nq, u_at[l] = t->nu;
        t->nq += b->nq, t->nu += b->d;
    }
    if (q_at) q_at[t->n] = t->nq, u_at[t->n] = t->nu;
    t->q_at = q_at, t->u_at = u_at;
    t->q = CARVE(c, t->nq, real);
    t->u = CARVE(c, t->nu, real);
    /* Poses, then one 6-vector a body for each quantity of the sweeps. */
    t->pose = CARVE(c, t->n, struct body_pose);
    t->h = CARVE(c, SPACE * t->n, real);
    t->v = CARVE(c, SPACE * t->n, real);
    t->a = CARVE(c, SPACE * t->n, real);
    t->f = CARVE(c, SPACE * t->n, real);
    t->b = CARVE(c, SPACE * t->n, real);
    /* Composites: of the anchor, one a level of jumping, and of own bodies. */
    t->level = CARVE(c, XFORM_NUMBERS * (plan->nlevel + 1), real);
    t->base_pose = CARVE(c, 1, struct xform);
    t->path = CARVE(c, XFORM_NUMBERS * t->n, real);
    t->in = CARVE(c, XFORM_NUMBERS + SPACE, real);
}

/* Arrays over own joints are dense, whatever the bodies' numbers in the model. */
void tree_load(struct tree *t)
{
    const struct state *s = t->job->state;
    for (int l = 0; l < t->n; l++) {
        const struct body *b = tree_body(t, l);
        for (int k = 0; k < b->nq; k++) t->q[t->q_at[l] + k] = (real)s->q[b->q_at + k];
        for (int k = 0; k < b->d; k++) t->u[t->u_at[l] + k] = (real)s->qd[b->u_at + k];
    }
}

/* scans_velocity: whether the velocities are wanted, or what their scan builds on the way: loops
 * need the poses of their bodies, which are the composites of this scan. */
static bool scans_velocity(const struct tree *t) { return !t->job->omit.velocity || t->poses; }

/* As chain_place: operations are counted per body and reported once. */
void tree_place(struct tree *t)
{
    const bool moves = scans_velocity(t);
    t->composed = false;
    for (int l = 0; l < t->n; l++) {
        const struct body *b = tree_body(t, l);
        const struct joint_cost *cost = body_cost(b);
        body_place(b, t->q + t->q_at[l], &t->pose[l]);
        if (moves) body_rate(&t->pose[l], t->u + t->u_at[l], tree_at(t->h, l));
        t->work.flop += (uint64_t)(cost->place + (moves ? cost->rate : 0));
        t->work.trig += (uint64_t)cost->place_trig;
        t->work.div += (uint64_t)cost->place_div;
        t->work.call += moves ? 2 : 1;
    }
    tree_report(t);
}

/* add_motion: v += X^T u. */
static void add_motion(struct tree *t, real *v, const struct xform *x, const real *u)
{
    real moved[SPACE];
    xform_motion(moved, x, u);
    screw_add(v, moved);
    t->work.flop += XFORM_MOTION_FLOP + SCREW_ADD_FLOP;
    t->work.call++;
}

/* sweep_up: x_i = source_i + X_i^T x_parent over the piece; `entry` is the anchor's x, NULL: zero.
 * x may be source. Parents come before children. */
static void sweep_up(struct tree *t, const real *source, const real *entry, real *x)
{
    for (int l = 0; l < t->n; l++) {
        const int p = tree_parent(t, l);
        if (x != source) screw_copy(tree_at(x, l), source + SPACE * l);
        if (p >= 0) add_motion(t, tree_at(x, l), &t->pose[l].x, tree_at(x, p));
        else if (entry) add_motion(t, tree_at(x, l), &t->pose[l].x, entry);
    }
}

/* make_paths: transforms from own bodies to the piece's anchor, by composition from parent to
 * child: 63 flops a body (physics 6.4, step 1). */
static void make_paths(struct tree *t)
{
    for (int l = 0; l < t->n; l++) {
        const int p = tree_parent(t, l);
        if (p < 0) {
            memcpy(t->path + XFORM_NUMBERS * l, &t->pose[l].x, XFORM_NUMBERS * sizeof(real));
            continue;
        }
        xform_compose((struct xform *)(t->path + XFORM_NUMBERS * l),
                      (struct xform *)(t->path + XFORM_NUMBERS * p), &t->pose[l].x);
        t->work.flop += XFORM_COMPOSE_FLOP;
        t->work.call++;
    }
}

/* grounded: the piece hangs at the base, so that nothing enters it. */
static bool grounded(const struct tree *t, int piece) { return t->shared->plan->parent[piece] < 0; }

/* hand_down: x (and, first, the path) of the anchor bodies to the pieces hanging there (physics
 * 6.4, step 2). 144 bytes at first, 48 later. */
static void hand_down(struct tree *t, const real *x, bool first, int tag)
{
    int nkid;
    const int *kid = tree_kids(t, &nkid);
    real message[XFORM_NUMBERS + SPACE];
    for (int k = 0; k < nkid; k++) {
        const int l = t->shared->plan->local[t->shared->plan->anchor[kid[k]]];
        screw_copy(message, x + SPACE * l);
        if (first)
            memcpy(message + SPACE, t->path + XFORM_NUMBERS * l, XFORM_NUMBERS * sizeof(real));
        comm_send(t->comm, kid[k], tag, message, first ? PAIR_BYTES : VECTOR_BYTES);
    }
}

/* jump: one step of pointer jumping (physics 6.4, step 3): E += T_j^T E of the 2^j-th ancestor;
 * first: its composite joins ours. E is the motion of the own anchor body. */
static void jump(struct tree *t, int j, real *E, bool first, int tag)
{
    const struct tree_plan *plan = t->shared->plan;
    const int k = t->piece, a = tree_plan_ancestor(plan, j, k);
    const struct tree_lists *to = &plan->descendants[j];
    real message[XFORM_NUMBERS + SPACE], *T = t->level + XFORM_NUMBERS * j;
    /* what leaves: E, and while composing the transform that goes on from the anchor's ancestor */
    const bool onward = first && (a >= 0 || t->poses);
    screw_copy(message, E);
    if (onward)
        memcpy(message + SPACE, a >= 0 ? T : (const real *)t->base_pose,
               XFORM_NUMBERS * sizeof(real));
    for (int i = to->at[k]; i < to->at[k + 1]; i++)
        comm_send(t->comm, to->item[i], tag + j, message, onward ? PAIR_BYTES : VECTOR_BYTES);
    /* An ancestor at the base has no anchor: nothing comes from it, and T_j already reaches the
     * base. */
    if (a < 0 || grounded(t, a)) {
        if (first && a >= 0) memcpy(t->base_pose, T, XFORM_NUMBERS * sizeof(real));
        return;
    }
    /* The ancestor's composite continues ours, to its own ancestor or, for loops, down to the
     * base. */
    const bool further = tree_plan_ancestor(plan, j, a) >= 0,
               composes = first && (further || t->poses);
    comm_recv(t->comm, a, tag + j, t->in, composes ? PAIR_BYTES : VECTOR_BYTES);
    add_motion(t, E, (struct xform *)T, t->in);
    if (composes) {
        struct xform *next = further ? (struct xform *)(T + XFORM_NUMBERS) : t->base_pose;
        xform_compose(next, (struct xform *)(t->in + SPACE), (struct xform *)T);
        t->work.flop += XFORM_COMPOSE_FLOP;
        t->work.call++;
    }
    tree_report(t);
}

/* scan_up: x_i += X_i^T x_parent along the whole tree, in place (physics 6.4): sweep from zero,
 * hand the anchors' values down, jump ceil(log2 depth) times, sweep again with what enters. */
static void scan_up(struct tree *t, real *x, int tag)
{
    const bool first = !t->composed;
    const struct tree_plan *plan = t->shared->plan;
    real E[SPACE] = {0}, *inside = t->f; /* free until the forces */
    t->composed = true;
    if (t->piece < 0) return;
    int nkid;
    tree_kids(t, &nkid);
    /* The first sweep only serves the pieces that hang here. */
    if (nkid > 0) sweep_up(t, x, NULL, inside);
    if (first && (nkid > 0 || t->poses)) make_paths(t);
    tree_report(t);
    hand_down(t, inside, first, tag);
    /* Only the first scan at these coordinates carries transforms. */
    if (!grounded(t, t->piece)) {
        comm_recv(t->comm, plan->parent[t->piece], tag, t->in, first ? PAIR_BYTES : VECTOR_BYTES);
        screw_copy(E, t->in);
        if (first) memcpy(t->level, t->in + SPACE, XFORM_NUMBERS * sizeof(real));
    } else if (first) {
        /* A piece at the base is its own beginning: its composites end here. */
        xform_identity(t->base_pose);
    }
    /* Now the piece's own motions, from the true motion of its anchor. */
    for (int j = 0; j < plan->nlevel; j++) jump(t, j, E, first, tag + 1);
    sweep_up(t, x, grounded(t, t->piece) ? NULL : E, x);
    tree_report(t);
}

/* As in chain_velocity: a scene at rest needs no scan, unless loops want its composites. */
void tree_velocity(struct tree *t)
{
    if (!scans_velocity(t)) return;
    memcpy(t->v, t->h, (size_t)(SPACE * t->n) * sizeof(real));
    scan_up(t, t->v, TAG_VELOCITY);
}

void tree_bias(struct tree *t)
{
    for (int l = 0; l < t->n && !t->job->omit.velocity; l++) {
        const struct body *b = tree_body(t, l);
        body_bias(b, &t->pose[l], tree_at(t->v, l), tree_at(t->h, l), t->u + t->u_at[l],
                  tree_at(t->b, l));
        t->work.flop += (uint64_t)body_cost(b)->bias;
        t->work.call++;
    }
}

void tree_acceleration(struct tree *t, const real *ud)
{
    const size_t size = (size_t)(SPACE * t->n) * sizeof(real);
    if (t->job->omit.velocity) memset(t->a, 0, size);
    else memcpy(t->a, t->b, size);
    for (int l = 0; l < t->n; l++) {
        const struct body *b = tree_body(t, l);
        if (ud) {
            /* V'_base = [0; -g] enters at every body on the base (physics 1.6, 2.2). */
            subspace_h(&t->pose[l].s, ud + t->u_at[l], tree_at(t->a, l));
            t->work.flop += (uint64_t)body_cost(b)->h;
        }
        if (b->parent >= 0 || t->job->omit.base) continue;
        real moved[SPACE];
        transform_base(false, t->job->omit.turn, moved, (const real *)&t->pose[l].x,
                       t->shared->base, &t->work);
        screw_add(tree_at(t->a, l), moved);
        t->work.flop += SCREW_ADD_FLOP;
    }
    scan_up(t, t->a, TAG_ACCELERATION);
}

/* As chain_gyro: P - Fext (physics 1.10, 1.6). */
void tree_gyro(struct tree *t, int l, real *f)
{
    const struct body *b = tree_body(t, l);
    const double *fext = t->job->state->fext;
    if (t->job->omit.velocity) {
        screw_zero(f);
    } else {
        body_gyro(b, tree_at(t->v, l), f);
        t->work.flop += BODY_GYRO_FLOP;
        t->work.call++;
    }
    if (!fext) return;
    real load[SPACE];
    body_load(b, fext + 6 * t->bodies[l], load);
    screw_sub(f, load);
    t->work.flop += (uint64_t)body_load_flops(b) + SCREW_ADD_FLOP;
}

/* sweep_down: f_parent += X f inside the piece, in place; `out` (SPACE) gets what leaves at the
 * anchor. Children come after their parents, hence the descending order. */
static void sweep_down(struct tree *t, real *f, real *out)
{
    screw_zero(out);
    /* What passes through a joint on the base loads nobody: skipped. */
    for (int l = t->n - 1; l >= 0; l--) {
        const int p = tree_parent(t, l);
        real moved[SPACE];
        if (p < 0 && grounded(t, t->piece)) continue;
        xform_force(moved, &t->pose[l].x, tree_at(f, l));
        screw_add(p >= 0 ? tree_at(f, p) : out, moved);
        t->work.flop += XFORM_FORCE_FLOP + SCREW_ADD_FLOP;
        t->work.call++;
    }
}

/* scan_down: what reaches each piece's anchor from the whole subtree above, then into the bodies
 * (physics 6.4, F phase). The same jumps, mirrored: what was sent to all descendants is received
 * from them. Their number is large in bushy trees, and each one is charged. */
static void scan_down(struct tree *t)
{
    const struct tree_plan *plan = t->shared->plan;
    real *inside = t->a; /* the accelerations have been used */
    real g[SPACE], moved[SPACE];
    if (t->piece < 0) return;
    /* On a copy: the sweep is made again once the forces of the pieces above are known. */
    memcpy(inside, t->f, (size_t)(SPACE * t->n) * sizeof(real));
    if (!grounded(t, t->piece)) sweep_down(t, inside, g);
    /* Each piece sends its sum so far before it adds what arrives: after step j it stands for
     * 2^(j+1) levels of pieces, each counted once. */
    for (int j = 0; j < plan->nlevel; j++) {
        const int a = tree_plan_ancestor(plan, j, t->piece);
        const struct tree_lists *from = &plan->descendants[j];
        if (a >= 0 && !grounded(t, a)) {
            xform_force(moved, (struct xform *)(t->level + XFORM_NUMBERS * j), g);
            t->work.flop += XFORM_FORCE_FLOP;
            t->work.call++;
            tree_report(t);
            comm_send(t->comm, a, TAG_FORCE + 1 + j, moved, VECTOR_BYTES);
        }
        for (int i = from->at[t->piece]; i < from->at[t->piece + 1]; i++) {
            comm_recv(t->comm, from->item[i], TAG_FORCE + 1 + j, moved, VECTOR_BYTES);
            screw_add(g, moved);
            t->work.flop += SCREW_ADD_FLOP;
        }
        tree_report(t);
    }
    if (!grounded(t, t->piece))
        comm_send(t->comm, plan->parent[t->piece], TAG_FORCE, g, VECTOR_BYTES);
    /* The complete sums, at the bodies where they act. */
    int nkid;
    const int *kid = tree_kids(t, &nkid);
    for (int k = 0; k < nkid; k++) {
        comm_recv(t->comm, kid[k], TAG_FORCE, moved, VECTOR_BYTES);
        screw_add(tree_at(t->f, plan->local[plan->anchor[kid[k]]]), moved);
        t->work.flop += SCREW_ADD_FLOP;
    }
    sweep_down(t, t->f, g);
}

/* F_i = I_i V'_i + P_i - Fext_i + sum over children (physics 2.3, 2.4); tau = H^T F (2.5). */
void tree_force(struct tree *t, real *tau, const real *more)
{
    const bool terms = !t->job->omit.velocity || t->job->state->fext;
    for (int l = 0; l < t->n; l++) {
        real inertial[SPACE], *f = tree_at(t->f, l);
        if (terms) tree_gyro(t, l, f);
        body_force(tree_body(t, l), tree_at(t->a, l), inertial);
        if (terms) screw_add(f, inertial);
        else screw_copy(f, inertial);
        if (more) screw_add(f, more + SPACE * l);
        t->work.flop += (uint64_t)(BODY_FORCE_FLOP + (terms + (more != NULL)) * SCREW_ADD_FLOP);
        t->work.call++;
    }
    scan_down(t);
    for (int l = 0; l < t->n; l++) {
        subspace_h_transposed(&t->pose[l].s, tree_at(t->f, l), tau + t->u_at[l]);
        t->work.flop += (uint64_t)body_cost(tree_body(t, l))->h_transposed;
    }
    tree_report(t);
}

/* Pose of a body in the base's frame: anchor to base, then body to anchor. */
void tree_base_pose(struct tree *t, int l, struct xform *x)
{
    xform_compose(x, t->base_pose, (struct xform *)(t->path + XFORM_NUMBERS * l));
    t->work.flop += XFORM_COMPOSE_FLOP;
}
