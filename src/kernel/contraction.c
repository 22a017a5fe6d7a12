/* contraction.c - forward dynamics of a tree around the contraction: loads, accelerations, loops,
 * refinements (contraction.h).
 *
 * One evaluation: place the bodies; scan the velocities; meet the other sides of loops; in the
 * paper's form the bias forces; contract, solve the roots, undo (contraction_solve.c);
 * accelerations of all bodies; joint accelerations; inner refinements; loop forces; outer
 * refinements. Every step works on all columns (the real loads and one unit load for each loop
 * constraint) at once. */
#include "kernel/contraction.h"

#include <math.h>
#include <string.h>

#include "kernel/chain.h"
#include "kernel/compound.h"
#include "kernel/dynamics_program.h"
#include "kernel/extremes.h"
#include "kernel/implicit.h"
#include "kernel/publish.h"
#include "kernel/tags.h"

enum { TAG_ANCHOR = TAG_TREE + 2 };

/* records: numbers of the records of rank `rank`'s operations; their places into `at` unless NULL.
 * An operation's record lives where its `into` lives, since undoing it begins there. */
static int records(const struct tree_plan *plan, int rank, int room, int *at)
{
    int n = 0;
    for (int i = plan->ops.at[rank]; i < plan->ops.at[rank + 1]; i++) {
        const struct tree_op *op = &plan->op[plan->ops.item[i]];
        if (at) at[i - plan->ops.at[rank]] = n;
        if (op->to == rank) n += contraction_record_size(op->kind, room);
    }
    return n;
}

/* Columns: one for the real loads, one for each loop constraint, all contracted together, because
 * the matrices are the same for all (physics 7.2). `room` is their number. */
void contraction_carve(struct contraction *k, struct carve *c, const struct kernel_job *job,
                       int rank)
{
    const struct tree_shared *s = job->shared;
    const struct tree_plan *plan = s->plan;
    tree_carve(&k->tree, c, job, rank);
    closure_carve(&k->closure, c, s->closure, rank);
    const int n = k->tree.n, nu = k->tree.nu, room = k->room = k->closure.m;
    k->direct = job->spec->kernel.formulation == FORMULATION_DIRECT;
    k->tau = CARVE(c, nu, real);
    k->active = CARVE(c, nu, real);
    k->answer = CARVE(c, nu, real);
    motion_carve(&k->motion, c, job, k->tree.nq, nu);
    k->ud = CARVE(c, room * nu, real);
    k->load = CARVE(c, SPACE * room * n, real);
    k->compound = CARVE(c, compound_size(room) * n, real);
    /* Forces at the top and at the bottom of each compound, in every column. */
    k->f1 = CARVE(c, SPACE * room * n, real);
    k->f2 = CARVE(c, SPACE * room * n, real);
    k->acceleration = CARVE(c, SPACE * room * n, real);
    k->offset = CARVE(c, SPACE * n, real);
    k->residual_bias = CARVE(c, SPACE * n, real);
    k->joint = CARVE(c, (PACKED + SPACE * room) * n, real);
    k->record_at = CARVE(c, plan->ops.at[rank + 1] - plan->ops.at[rank], int);
    k->record = CARVE(c, records(plan, rank, room, k->record_at), real);
    /* The longest message is that of a merge: a compound, up to 7 coordinates (a floating joint: a
     * quaternion and a position), up to six active forces, a bias; room for the columns of an
     * undoing too. */
    k->message = CARVE(c, compound_size(room) + 7 + SPACE + SPACE + 2 * SPACE * room, real);
    k->anchor_acceleration = CARVE(c, SPACE * room, real);
    /* Loop sides that this rank owns have columns of their own for the exchange. */
    const int sides = s->closure ? 2 * s->closure->nloop : 0;
    k->side = CARVE(c, sides, real *);
    k->side_room = CARVE(c, k->closure.takes_part ? SPACE * room * sides : 0, real);
    k->lambda = CARVE(c, room - 1, real);
}

void contraction_set(struct contraction *k, struct comm *c) { k->tree.comm = k->closure.comm = c; }

static real *columns(real *array, int room, int l) { return array + SPACE * room * l; }
static bool has_loops(const struct contraction *k) { return k->room > 1; }

/* given_forces: tau of own joints, springs included; implicit ones in the form tau_0 (physics
 * 9.0). */
static void given_forces(struct contraction *k)
{
    struct tree *t = &k->tree;
    for (int l = 0; l < t->n; l++) {
        const struct body *b = tree_body(t, l);
        real *tau = k->tau + t->u_at[l];
        for (int i = 0; i < b->d; i++) tau[i] = (real)t->job->state->tau[b->u_at + i];
        if (!b->has_spring) continue;
        body_spring(b, t->q + t->q_at[l], t->u + t->u_at[l], tau);
        spring_force(b, implicit_step(t->job), t->u + t->u_at[l], tau);
        t->work.flop += BODY_SPRING_FLOP + (steps_implicitly(t->job) ? 3 : 0);
    }
}

/* make_loads: external loads of all columns: Fext - P in column 0 if it has the velocity terms,
 * loop forces behind. A loop's column is its unit force on both of its bodies, +T_b W and -T_a W
 * (7.2). */
static void make_loads(struct contraction *k, bool terms)
{
    struct tree *t = &k->tree;
    memset(k->load, 0, (size_t)(SPACE * k->room * t->n) * sizeof(real));
    for (int l = 0; l < t->n; l++) {
        real *load = columns(k->load, k->room, l);
        if (terms) {
            tree_gyro(t, l, load);
            for (int i = 0; i < SPACE; i++) load[i] = -load[i];
        }
        closure_loads(&k->closure, t->bodies[l], load, &t->work);
    }
}

/* meet_loops: poses and velocities of the loops' own sides, then the exchange. A rank computes the
 * place of a loop only for loops with a side of its own. */
static void meet_loops(struct contraction *k)
{
    struct tree *t = &k->tree;
    const struct closure_shared *s = t->shared->closure;
    if (!s) return;
    for (int side = 0; side < 2 * s->nloop && k->closure.takes_part; side++) {
        if (s->owner[side] != comm_rank(t->comm)) continue;
        const int l = t->shared->plan->local[closure_body(s, side)];
        tree_base_pose(t, l, &k->closure.side_pose[side]);
        screw_copy(k->closure.side_velocity + SPACE * side, tree_at(t->v, l));
    }
    closure_meet(&k->closure, &t->work);
}

/* accelerate: accelerations of own bodies in all columns of the present solution; column 0 adds up
 * if `add`: V'_i = Phi_i (f_1 + f_2 - P_i + Fext_i), physics 6.2 at the end. */
static void accelerate(struct contraction *k, bool add)
{
    struct tree *t = &k->tree;
    const bool loads = k->given.load != NULL;
    for (int l = 0; l < t->n; l++)
        for (int j = 0; j < k->m; j++) {
            real net[SPACE], y[SPACE], *a = columns(k->acceleration, k->room, l) + SPACE * j;
            const real *f1 = columns(k->f1, k->room, l) + SPACE * j,
                       *f2 = columns(k->f2, k->room, l) + SPACE * j;
            for (int i = 0; i < SPACE; i++)
                net[i] = f1[i] + f2[i] + (loads ? columns(k->load, k->room, l)[SPACE * j + i] : 0);
            body_accelerate(tree_body(t, l), net, y);
            for (int i = 0; i < SPACE; i++) a[i] = add ? a[i] + y[i] : y[i];
            t->work.flop += (uint64_t)(BODY_ACCELERATE_FLOP + SCREW_ADD_FLOP * (1 + loads + add));
            t->work.call++;
        }
    tree_report(t);
}

/* share_anchors: accelerations of anchor bodies to the pieces hanging there: 48 bytes a column. */
static void share_anchors(struct contraction *k, int m)
{
    struct tree *t = &k->tree;
    const struct tree_plan *plan = t->shared->plan;
    const int64_t bytes = SPACE * m * (int64_t)sizeof(real);
    int nkid;
    const int *kid = tree_kids(t, &nkid);
    for (int i = 0; i < nkid; i++)
        comm_send(t->comm, kid[i], TAG_ANCHOR,
                  columns(k->acceleration, k->room, plan->local[plan->anchor[kid[i]]]), bytes);
    if (t->piece >= 0 && plan->parent[t->piece] >= 0)
        comm_recv(t->comm, plan->parent[t->piece], TAG_ANCHOR, k->anchor_acceleration, bytes);
}

/* joint_accelerations: ud = H^T (a - X^T a_parent - bias - base) of columns 0 .. m-1; notes what
 * the constraints of column 0 leave over, as a bias for the next refinement.
 *
 * The residual is W^T Z in the operator form (physics 4.8). A residual by the assembled matrix
 * would share its rounding errors and show nothing (physics 8.6). */
static void joint_accelerations(struct contraction *k, int m, const real *bias, const real *base)
{
    struct tree *t = &k->tree;
    real residual = 0, scale = 0;
    /* The parent of a piece's top body lives on another rank. */
    share_anchors(k, m);
    for (int l = 0; l < t->n; l++) {
        const int p = tree_parent(t, l), d = tree_body(t, l)->d;
        const bool on_base = tree_body(t, l)->parent < 0;
        const struct subspace *s = &t->pose[l].s;
        for (int j = 0; j < m; j++) {
            real z[SPACE], moved[SPACE], rest[SPACE],
                *a = columns(k->acceleration, k->room, l) + SPACE * j;
            /* The base moves in the real column only; loop columns are pure responses to a
             * force. */
            const real *below = on_base  ? (j == 0 ? base : NULL)
                                : p >= 0 ? columns(k->acceleration, k->room, p) + SPACE * j
                                         : k->anchor_acceleration + SPACE * j;
            screw_copy(z, a);
            if (below) {
                xform_motion(moved, &t->pose[l].x, below);
                screw_sub(z, moved);
                t->work.flop += XFORM_MOTION_FLOP + SCREW_ADD_FLOP;
            }
            if (j == 0 && bias) {
                screw_sub(z, bias + SPACE * l);
                t->work.flop += SCREW_ADD_FLOP;
            }
            subspace_h_transposed(s, z, k->ud + j * t->nu + t->u_at[l]);
            t->work.flop += (uint64_t)body_cost(tree_body(t, l))->h_transposed;
            /* What is left over is the constraints' own violation, as a vector: -W W^T z. */
            if (j > 0) continue;
            subspace_w_transposed(s, z, rest);
            residual = largest_size(residual, SPACE - d, rest);
            scale = largest_size(scale, SPACE, a);
            real *left_over = k->residual_bias + SPACE * l;
            screw_zero(left_over);
            for (int i = 0; i < SPACE - d; i++) rest[i] = -rest[i];
            subspace_w(s, rest, left_over);
        }
    }
    k->residual = scale > 0 ? residual / scale : residual;
    k->residual_scale = scale;
    tree_report(t);
}

/* refine_inside: contract again with the constraints' residual for a bias (physics 8.6, inner
 * refinement). One column only: the matrices have not changed, and loop columns are accurate as
 * they are. Corrections add to accelerations, not to joint forces. */
static void refine_inside(struct contraction *k, const real *bias, const real *base)
{
    const int m = k->m, inner = k->tree.job->spec->kernel.inner_refinements;
    const struct contraction_given given = k->given;
    for (int pass = 0; pass < inner; pass++) {
        k->m = 1;
        k->given = (struct contraction_given){.bias = k->residual_bias};
        comm_stage(k->tree.comm, STAGE_SOLVE);
        contraction_solve(k);
        comm_stage(k->tree.comm, STAGE_FINISH);
        accelerate(k, true);
        joint_accelerations(k, 1, bias, base);
    }
    k->m = m;
    k->given = given;
}

/* close_loops: lambda from the accelerations of the loops' bodies (physics 7.5); all columns put
 * together in `active`, which has been used. */
static void close_loops(struct contraction *k)
{
    struct tree *t = &k->tree;
    const struct closure_shared *s = t->shared->closure;
    for (int side = 0; s && side < 2 * s->nloop && k->closure.takes_part; side++) {
        if (s->owner[side] != comm_rank(t->comm)) continue;
        const int l = t->shared->plan->local[closure_body(s, side)];
        k->side[side] = k->side_room + SPACE * k->room * side;
        memcpy(k->side[side], columns(k->acceleration, k->room, l),
               (size_t)(SPACE * k->room) * sizeof(real));
        /* The paper's form and refinements solve for a difference; the constraint concerns the
         * whole. */
        screw_add(k->side[side], k->offset + SPACE * l);
        t->work.flop += SCREW_ADD_FLOP;
    }
    if (s) closure_solve(&k->closure, k->side, &t->work);
    /* u' = u'_0 + sum of lambda_j u'_j. */
    for (int i = 0; i < t->nu; i++) {
        real sum = k->ud[i];
        for (int j = 1; j < k->room; j++) sum += k->closure.lambda[j - 1] * k->ud[j * t->nu + i];
        k->active[i] = sum;
    }
    t->work.flop += (uint64_t)(2 * (k->room - 1) * t->nu);
    tree_report(t);
}

/* add_up: the answer and the loop forces += what the last solution gave. */
static void add_up(struct contraction *k)
{
    struct tree *t = &k->tree;
    for (int i = 0; i < t->nu; i++) k->answer[i] += k->active[i];
    for (int j = 1; j < k->room; j++) k->lambda[j - 1] += k->closure.lambda[j - 1];
    t->work.flop += (uint64_t)(t->nu + k->room - 1);
}

/* first_solution: u' for all columns. The direct form (physics 4.3) gives velocity terms, base and
 * tau at once; the paper's form (4.2) gives tau less the bias forces and nothing else. */
static void first_solution(struct contraction *k)
{
    struct tree *t = &k->tree;
    const struct job_omit *omit = &t->job->omit;
    const bool loads = k->direct && !omit->load;
    const real *bias = k->direct && !omit->velocity ? t->b : NULL;
    const real *base = k->direct && !omit->base ? t->shared->base : NULL;
    k->m = k->room;
    make_loads(k, loads);
    /* A pointer that stays NULL saves the operations on zeros. */
    k->given =
        (struct contraction_given){k->active, bias, loads || has_loops(k) ? k->load : NULL, base};
    tree_report(t);
    comm_stage(t->comm, STAGE_SOLVE);
    contraction_solve(k);
    comm_stage(t->comm, STAGE_FINISH);
    accelerate(k, false);
    joint_accelerations(k, k->m, bias, base);
    refine_inside(k, bias, base);
    close_loops(k);
    add_up(k);
}

/* loop_forces: f -= the loops' forces on own bodies, for inverse dynamics of the closed system. The
 * load columns keep the unit forces of the first solution. */
static void loop_forces(struct contraction *k, real *f)
{
    struct tree *t = &k->tree;
    for (int l = 0; l < t->n && has_loops(k); l++)
        for (int j = 1; j < k->room; j++)
            screw_axpy(tree_at(f, l), -k->lambda[j - 1], columns(k->load, k->room, l) + SPACE * j);
}

/* refine: u' += M^-1 (tau - inverse dynamics(u')) (physics 8.6, outer refinement). False when that
 * would not have made it better. */
static bool refine(void *solver, struct refinement *course)
{
    struct contraction *k = solver;
    struct tree *t = &k->tree;
    comm_stage(t->comm, STAGE_ACCELERATION);
    tree_acceleration(t, k->answer);
    /* Loops see the accelerations of the answer so far, plus those of the correction. */
    memcpy(k->offset, t->a, (size_t)(SPACE * t->n) * sizeof(real));
    comm_stage(t->comm, STAGE_FORCE);
    memset(k->residual_bias, 0, (size_t)(SPACE * t->n) * sizeof(real));
    loop_forces(k, k->residual_bias);
    tree_force(t, k->active, k->residual_bias);
    for (int i = 0; i < t->nu; i++) k->active[i] = k->tau[i] - k->active[i];
    /* A linearly implicit spring also pulls back with s u' (physics 9.0). */
    for (int l = 0; l < t->n && steps_implicitly(t->job); l++)
        for (int i = t->u_at[l]; i < t->u_at[l] + tree_body(t, l)->d; i++)
            k->active[i] -=
                spring_resistance(tree_body(t, l), implicit_step(t->job)) * k->answer[i];
    t->work.flop += (uint64_t)(steps_implicitly(t->job) ? 3 * t->nu : t->nu);
    tree_report(t);
    /* The correction needs no velocity terms: they cancel in the difference. */
    k->m = 1;
    k->given = (struct contraction_given){.active = k->active};
    comm_stage(t->comm, STAGE_SOLVE);
    contraction_solve(k);
    comm_stage(t->comm, STAGE_FINISH);
    accelerate(k, false);
    joint_accelerations(k, 1, NULL, NULL);
    refine_inside(k, NULL, NULL);
    close_loops(k);
    if (!refinement_accept(course, t->comm, TAG_EXTREME, t->nu, k->active, k->answer)) return false;
    add_up(k);
    return true;
}

/* refine_outside: as often as the job allows and it helps. The paper's residual does not see the
 * errors of its bias forces. */
static void refine_outside(struct contraction *k)
{
    const struct kernel_spec *spec = &k->tree.job->spec->kernel;
    k->refined = spec->inner_refinements +
                 refinement_run(k->tree.comm, TAG_EXTREME, spec->outer_refinements, k->direct,
                                &k->residual, &k->residual_scale, refine, k);
}

/* evaluate: the answer from the coordinates and rates in the tree. */
static void evaluate(struct contraction *k)
{
    struct tree *t = &k->tree;
    comm_stage(t->comm, STAGE_PLACE);
    given_forces(k);
    tree_place(t);
    comm_stage(t->comm, STAGE_VELOCITY);
    tree_velocity(t);
    comm_stage(t->comm, STAGE_ASSEMBLY);
    meet_loops(k);
    tree_bias(t);
    /* Nothing solved yet: the answer and what it does not contain are zero. */
    memcpy(k->active, k->tau, (size_t)t->nu * sizeof(real));
    memset(k->answer, 0, (size_t)t->nu * sizeof(real));
    memset(k->offset, 0, (size_t)(SPACE * t->n) * sizeof(real));
    memset(k->lambda, 0, (size_t)(k->room - 1) * sizeof(real));
    /* The paper's form: FT = tau - xi, xi = inverse dynamics at u' = 0 (physics 4.2). */
    if (!k->direct && !t->job->omit.bias) {
        tree_report(t);
        comm_stage(t->comm, STAGE_ACCELERATION);
        tree_acceleration(t, NULL);
        memcpy(k->offset, t->a, (size_t)(SPACE * t->n) * sizeof(real));
        comm_stage(t->comm, STAGE_FORCE);
        tree_force(t, k->ud, NULL);
        comm_stage(t->comm, STAGE_ASSEMBLY);
        for (int i = 0; i < t->nu; i++) k->active[i] = k->tau[i] - k->ud[i];
        t->work.flop += (uint64_t)t->nu;
    }
    first_solution(k);
    refine_outside(k);
}

/* publish: the answer and the loop forces. */
static void publish(const struct contraction *k)
{
    const struct tree *t = &k->tree;
    for (int l = 0; l < t->n; l++) {
        /* A broken solution is published as "not a number", never as a number that looks like
         * one. */
        const struct body *b = tree_body(t, l);
        real answer[SPACE];
        for (int i = 0; i < b->d; i++)
            answer[i] = k->broken ? (real)__builtin_nan("") : k->answer[t->u_at[l] + i];
        publish_reals(t->comm, OUTPUT_QDD, b->u_at, b->d, answer);
    }
    if (comm_rank(t->comm) != 0) return;
    publish_number(t->comm, OUTPUT_REFINED, 0, k->refined);
    for (int j = 0; j + 1 < k->room; j++)
        publish_number(t->comm, OUTPUT_LAMBDA, k->closure.shared->place[j], (double)k->lambda[j]);
    if (has_loops(k)) publish_number(t->comm, OUTPUT_LOOP_RANK, 0, k->closure.rank);
}

/* evaluate_once: for the time steps; only the first answer is kept, since it is what references
 * check. */
static void evaluate_once(void *program)
{
    struct contraction *k = program;
    evaluate(k);
    if (!k->published) publish(k);
    motion_watch(&k->motion.seen, k->residual, k->residual_scale, 0);
    k->published = true;
}

/* Coordinates and rates belong to the tree, answers to the contraction; motion.h moves them. */
void contraction_run(struct contraction *k)
{
    struct tree *t = &k->tree;
    struct motion *m = &k->motion;
    tree_load(t);
    m->comm = t->comm;
    m->body = t->shared->body;
    m->bodies = t->bodies, m->n = t->n;
    m->q = t->q, m->u = t->u, m->ud = k->answer;
    m->evaluate = evaluate_once;
    m->program = k;
    m->work = &t->work;
    motion_run(m);
    tree_report(t);
}
