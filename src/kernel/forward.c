/* forward.c - the constraint force algorithm on a block of a chain (forward.h). Symbols as in
 * physics 4.
 *
 *                   scans system            accelerations        accuracy (physics 8.2)
 *     paper (4.2)     3   A FS = -B FT      C FT + B^T FS        loses what its bias loses
 *     direct (4.3)    1   A FS = -W^T Z     H^T (Z + D W FS)     to the last digits
 *
 * Both use the same A, the same solvers and the same exchange of edge data (4.5). The direct form
 * never multiplies D out: it works through forces and accelerations of bodies (forward_form.c). */
#include "kernel/forward.h"

#include <math.h>
#include <string.h>

#include "kernel/assembly.h"
#include "kernel/dynamics_program.h"
#include "kernel/extremes.h"
#include "kernel/forward_exact.h"
#include "kernel/forward_form.h"
#include "kernel/forward_rows.h"
#include "kernel/publish.h"
#include "kernel/tags.h"

/* What is carved depends on the formulation: the paper's needs D and E, accelerations and forces;
 * the direct one does with poses, velocities and z. */
void forward_carve(struct forward *f, struct carve *c, const struct kernel_job *job, int rank)
{
    const struct kernel_spec *spec = &job->spec->kernel;
    const struct chain_shared *s = job->shared;
    struct chain *ch = &f->chain;
    const bool refine = spec->outer_refinements > 0;
    f->direct = spec->formulation == FORMULATION_DIRECT;
    f->watch = job->watch || refine;
    f->step = implicit_step(job);
    chain_carve(ch, c, job, rank, true, refine || !f->direct, false);
    const int m = ch->hi - ch->lo, nu = chain_nu(s, ch->lo, ch->hi);
    f->tau = CARVE(c, nu, real);
    f->ud = CARVE(c, nu, real);
    motion_carve(&f->motion, c, job, chain_nq(s, ch->lo, ch->hi), nu);
    /* Joint forces of own joints and of the two beside the block. */
    f->force = CARVE(c, SPACE * m, real);
    f->exact = spec->residual == RESIDUAL_TWICE ? CARVE(c, SPACE * (m + 2), twice) : NULL;
    f->force_left = CARVE(c, SPACE, real);
    f->force_right = CARVE(c, SPACE, real);
    f->gain = CARVE(c, f->direct || refine ? SPACE * m : 0, real);
    f->gain_left = CARVE(c, SPACE, real);
    f->z = CARVE(c, SPACE * m, real);
    /* The paper's form multiplies with D and E after the solution: they are kept. */
    f->D = CARVE(c, f->direct ? 0 : SQUARE * m, real);
    f->E = CARVE(c, f->direct ? 0 : SQUARE * (m + 1), real);
    f->message = CARVE(c, 14, real);
    f->left = carve_bytes(c, s->subspace_bytes);
    /* The composites are not needed any more when the system is assembled, unless for outer
     * refinement: then scan and solver share their room. */
    const size_t before = c->used;
    scan_carve(&ch->scan, c, ch->dense, spec->composites_incoming, rank, job->nrank);
    const size_t after = c->used;
    if (!refine) c->used = before;
    blocks_carve(&f->blocks, c, spec, &s->layout, rank, 1, spec->inner_refinements > 0 || refine);
    if (c->used < after) c->used = after;
}

void forward_set(struct forward *f, struct comm *c)
{
    f->chain.comm = f->chain.scan.comm = f->blocks.comm = f->blocks.reduction.comm = c;
}

/* exchange_joints: coordinates of the edge joints both ways; the neighbours' subspaces and
 * transform from them (physics 4.5, step 0). At most 7 numbers travel in place of matrices, and the
 * receiver pays for computing them again. */
static void exchange_joints(struct forward *f)
{
    struct chain *ch = &f->chain;
    struct comm *c = ch->comm;
    const int k = comm_rank(c), last = ch->hi - 1;
    const int64_t size = sizeof(real);
    if (forward_has_left(f))
        comm_send(c, k - 1, TAG_JOINT, ch->q, forward_body(f, ch->lo)->nq * size);
    if (forward_has_right(f))
        comm_send(c, k + 1, TAG_JOINT, ch->q + chain_q_at(ch, last),
                  forward_body(f, last)->nq * size);
    /* From the right the whole pose: X_hi couples body hi-1 to what lies above. */
    if (forward_has_right(f)) {
        const struct body *b = forward_body(f, ch->hi);
        const struct joint_cost *cost = body_cost(b);
        comm_recv(c, k + 1, TAG_JOINT, f->message, b->nq * size);
        body_place(b, f->message, chain_pose(ch, ch->hi));
        ch->work.flop += (uint64_t)cost->place;
        ch->work.trig += (uint64_t)cost->place_trig;
        ch->work.div += (uint64_t)cost->place_div;
        if (ch->dense)
            transform_expand(true, ch->matrix + SQUARE * (ch->hi - ch->lo),
                             &chain_pose(ch, ch->hi)->x, &ch->work);
    }
    /* From the left only W_{lo-1}: it stands in L_lo (physics 4.2). */
    if (forward_has_left(f)) {
        const struct body *b = forward_body(f, ch->lo - 1);
        comm_recv(c, k - 1, TAG_JOINT, f->message, b->nq * size);
        body_subspace(b, f->message, f->left);
        work_add(&ch->work, &body_cost(b)->subspace);
    }
    chain_report(ch);
}

/* given_forces: tau of own joints, springs included; implicit ones in the form tau_0 (physics
 * 9.0). */
static void given_forces(struct forward *f)
{
    struct chain *ch = &f->chain;
    const int first = forward_body(f, ch->lo)->u_at, nu = chain_nu(ch->shared, ch->lo, ch->hi);
    for (int k = 0; k < nu; k++) f->tau[k] = (real)ch->job->state->tau[first + k];
    for (int i = ch->lo; i < ch->hi; i++) {
        const struct body *b = forward_body(f, i);
        if (!b->has_spring) continue;
        body_spring(b, ch->q + chain_q_at(ch, i), ch->u + chain_u_at(ch, i),
                    f->tau + chain_u_at(ch, i));
        spring_force(b, f->step, ch->u + chain_u_at(ch, i), f->tau + chain_u_at(ch, i));
        ch->work.flop += BODY_SPRING_FLOP + (f->step > 0 ? 3 : 0);
    }
}

/* assemble_direct: A_ii and L_i only (physics 4.2). B and C are never needed in the direct form. */
static void assemble_direct(struct forward *f)
{
    struct chain *ch = &f->chain;
    for (int i = ch->lo; i < ch->hi; i++) {
        real D[SQUARE], E[SQUARE], A[SQUARE];
        assembly_operators(ch, i, D, E);
        forward_project(f, i, D, i, A);
        const real resistance = forward_resistance(f, i);
        /* D + H s^-1 H^T, whose H components come first in joint axes (physics 9.0). */
        for (int k = 0; k < forward_body(f, i)->d && resistance > 0; k++)
            A[(SPACE + 1) * k] += 1 / resistance;
        assembly_pack(forward_row_size(f, i), A, forward_row_size(f, i),
                      blocks_row_D(&f->blocks, i));
        if (i > 0) forward_project(f, i, E, i - 1, blocks_row_L(&f->blocks, i));
    }
}

/* assemble_paper: D and E in joint axes, which hold A, B and C side by side (physics 4.2): A in the
 * last c rows and columns, C in the first d, B in between. */
static void assemble_paper(struct forward *f)
{
    struct chain *ch = &f->chain;
    for (int i = ch->lo; i < ch->hi + forward_has_right(f); i++) {
        real D[SQUARE], E[SQUARE], *turned = f->E + SQUARE * (i - ch->lo);
        const bool own = i < ch->hi;
        const struct subspace *s = forward_subspace(f, i);
        /* E of joint hi couples the last own row to the next rank's first. */
        assembly_operators(ch, i, own ? D : NULL, E);
        if (i > 0) assembly_turn(ch, s, E, forward_subspace(f, i - 1), turned);
        if (!own) continue;
        real *diagonal = f->D + SQUARE * (i - ch->lo), *L = blocks_row_L(&f->blocks, i);
        assembly_turn(ch, s, D, s, diagonal);
        /* The solver gets copies of its parts; D and E stay for the products with B and C. */
        assembly_pack(s->c, diagonal + (SPACE + 1) * s->d, SPACE, blocks_row_D(&f->blocks, i));
        if (i == 0) continue;
        const int before = forward_subspace(f, i - 1)->d, nbefore = SPACE - before;
        for (int r = 0; r < s->c; r++)
            memcpy(L + r * nbefore, turned + SPACE * (s->d + r) + before,
                   (size_t)nbefore * sizeof(real));
    }
}

/* multiply_rows: y (rows from .. to-1) of D F_i + E_i F_{i-1} + E_{i+1}^T F_{i+1} in joint axes;
 * `active` says that only H's components of the forces differ from zero.
 *
 * Rows below d of H FT give C FT, rows from d on B FT; with W FS added they give u' and A FS + B
 * FT. */
static void multiply_rows(struct forward *f, int i, int from, int to, bool active, real *y)
{
    struct chain *ch = &f->chain;
    const real *D = f->D + SQUARE * (i - ch->lo), *E = f->E + SQUARE * (i - ch->lo),
               *next = E + SQUARE;
    bool begun = false;
    for (int r = from; r < to; r++) y[r] = 0;
    for (int j = i - 1; j <= i + 1; j++) {
        /* The chain's ends have one neighbour. */
        if (j < 0 || j >= ch->n) continue;
        real x[SPACE];
        const struct subspace *s = forward_subspace(f, j);
        const real *force = j < ch->lo    ? f->force_left
                            : j == ch->hi ? f->force_right
                                          : chain_at(ch, f->force, j);
        assembly_turn_vector(ch, s, force, x);
        const int n = active ? s->d : SPACE;
        for (int r = from; r < to; r++)
            for (int k = 0; k < n; k++) {
                const real element = j < i    ? E[SPACE * r + k]
                                     : j == i ? D[SPACE * r + k]
                                              : next[SPACE * k + r];
                /* The first product is stored, not added to zero: no operation that the formula
                 * does not have. */
                y[r] = begun || k > 0 ? y[r] + element * x[k] : element * x[k];
            }
        ch->work.flop += (uint64_t)(2 * n * (to - from) - (!begun && n > 0 ? to - from : 0));
        begun = begun || n > 0;
    }
}

/* paper_residual: largest |W^T D F|, an acceleration that a joint forbids, over the largest
 * acceleration of a body; it is a monitor, so it costs the machine nothing: the work is
 * restored. */
static void paper_residual(struct forward *f)
{
    struct chain *ch = &f->chain;
    const struct work before = ch->work;
    real residual = 0, scale = 0, y[SPACE];
    for (int i = ch->lo; i < ch->hi; i++) {
        const int d = forward_subspace(f, i)->d;
        multiply_rows(f, i, d, SPACE, false, y);
        residual = largest_size(residual, SPACE - d, y + d);
        forward_body_acceleration(f, i, chain_at(ch, f->force, i), forward_force_above(f, i), NULL,
                                  y);
        scale = largest_size(scale, SPACE, y);
    }
    f->residual = scale > 0 ? residual / scale : residual;
    f->residual_scale = scale;
    ch->work = before;
}

/* solve_operator_form: FS with inner refinements; z holds the answer. `again`: the system is
 * factored already.
 *
 * Every pass solves for what the present forces violate. The first one is the solution itself
 * (physics 4.6, 4.7), the others are inner refinement (8.6) with the factors at hand. */
static void solve_operator_form(struct forward *f, bool terms, bool again)
{
    struct chain *ch = &f->chain;
    const int inner = ch->job->spec->kernel.inner_refinements;
    if (f->exact) exact_begin(f);
    forward_operator_form(f, terms);
    for (int pass = 0; pass <= inner; pass++) {
        forward_right_hand_side(f);
        chain_report(ch);
        comm_stage(ch->comm, STAGE_SOLVE);
        if (pass == 0 && !again) blocks_solve(&f->blocks, &ch->work);
        else blocks_resolve(&f->blocks, &ch->work);
        comm_stage(ch->comm, STAGE_FINISH);
        forward_add_reactions(f);
        forward_operator_form(f, terms);
        chain_report(ch);
    }
}

/* joint_accelerations: ud = H^T z (physics 4.7). */
static void joint_accelerations(struct forward *f, real *ud)
{
    struct chain *ch = &f->chain;
    for (int i = ch->lo; i < ch->hi; i++) {
        subspace_h_transposed(forward_subspace(f, i), chain_at(ch, f->z, i),
                              ud + chain_u_at(ch, i));
        ch->work.flop += (uint64_t)body_cost(forward_body(f, i))->h_transposed;
    }
    chain_report(ch);
}

/* evaluate_direct: physics 4.3: one scan, then the system with all velocity terms in it. */
static void evaluate_direct(struct forward *f)
{
    struct chain *ch = &f->chain;
    comm_stage(ch->comm, STAGE_VELOCITY);
    chain_velocity(ch);
    comm_stage(ch->comm, STAGE_ASSEMBLY);
    chain_bias(ch);
    if (!ch->job->omit.load) chain_gain(ch, f->gain);
    assemble_direct(f);
    forward_begin_forces(f, f->tau, !ch->job->omit.load);
    solve_operator_form(f, true, false);
    joint_accelerations(f, f->ud);
}

/* paper_solution: u' = C FT + B^T FS with A FS = -B FT, (4.3), (4.4). */
static void paper_solution(struct forward *f, const real *active)
{
    struct chain *ch = &f->chain;
    const int inner = ch->job->spec->kernel.inner_refinements;
    real y[SPACE];
    /* A FS = -B FT. */
    forward_begin_forces(f, active, false);
    for (int i = ch->lo; i < ch->hi; i++) {
        const int d = forward_subspace(f, i)->d;
        real *r = blocks_row_r(&f->blocks, i);
        multiply_rows(f, i, d, SPACE, true, y);
        for (int k = d; k < SPACE; k++) r[k - d] = -y[k];
    }
    chain_report(ch);
    comm_stage(ch->comm, STAGE_SOLVE);
    blocks_solve(&f->blocks, &ch->work);
    comm_stage(ch->comm, STAGE_FINISH);
    forward_add_reactions(f);
    /* Inner refinement by the operator form: products with A would repeat its rounding errors
     * (physics 8.6). */
    for (int pass = 0; pass < inner; pass++) {
        forward_operator_form(f, false);
        forward_right_hand_side(f);
        chain_report(ch);
        comm_stage(ch->comm, STAGE_SOLVE);
        blocks_resolve(&f->blocks, &ch->work);
        comm_stage(ch->comm, STAGE_FINISH);
        forward_add_reactions(f);
    }
    for (int i = ch->lo; i < ch->hi; i++) {
        /* u' = H^T D (H FT + W FS), both parts in one product. */
        multiply_rows(f, i, 0, forward_subspace(f, i)->d, false, y);
        memcpy(f->ud + chain_u_at(ch, i), y, (size_t)forward_subspace(f, i)->d * sizeof(real));
    }
    chain_report(ch);
    if (f->watch) paper_residual(f);
}

/* evaluate_paper: bias forces xi by inverse dynamics with u' = 0, FT = tau - xi, then (4.3), (4.4).
 * Three scans; without velocities, gravity and loads xi is zero and none is needed. */
static void evaluate_paper(struct forward *f)
{
    struct chain *ch = &f->chain;
    const int nu = chain_nu(ch->shared, ch->lo, ch->hi);
    const bool bias = !ch->job->omit.bias;
    if (bias) chain_bias_force(ch, f->ud);
    comm_stage(ch->comm, STAGE_ASSEMBLY);
    for (int k = 0; k < nu; k++) f->ud[k] = bias ? f->tau[k] - f->ud[k] : f->tau[k];
    ch->work.flop += (uint64_t)(bias ? nu : 0);
    assemble_paper(f);
    paper_solution(f, f->ud);
}

/* refine: u' += M^-1 (tau - inverse dynamics(u')) with the factors at hand (physics 8.6, outer
 * refinement). False when that would not have made it better. */
static bool refine(void *solver, struct refinement *course)
{
    struct forward *f = solver;
    struct chain *ch = &f->chain;
    const int nu = chain_nu(ch->shared, ch->lo, ch->hi);
    real *rest = f->gain; /* not needed any more; at least as many numbers as joint rates */
    comm_stage(ch->comm, STAGE_ACCELERATION);
    chain_acceleration(ch, f->ud);
    comm_stage(ch->comm, STAGE_FORCE);
    chain_force(ch, rest);
    for (int k = 0; k < nu; k++) rest[k] = f->tau[k] - rest[k];
    for (int i = ch->lo; i < ch->hi && f->step > 0; i++)
        for (int k = 0; k < forward_body(f, i)->d; k++)
            rest[chain_u_at(ch, i) + k] -= forward_resistance(f, i) * f->ud[chain_u_at(ch, i) + k];
    ch->work.flop += (uint64_t)(f->step > 0 ? 3 * nu : nu);
    comm_stage(ch->comm, STAGE_ASSEMBLY);
    /* The correction is a response to forces alone: no velocity terms. */
    forward_begin_forces(f, rest, false);
    solve_operator_form(f, false, true);
    joint_accelerations(f, rest);
    /* All ranks decide by the same numbers, so that none refines alone. */
    if (!refinement_accept(course, ch->comm, TAG_EXTREME, nu, rest, f->ud)) return false;
    for (int k = 0; k < nu; k++) f->ud[k] += rest[k];
    ch->work.flop += (uint64_t)nu;
    return true;
}

/* refine_outside: as often as the job allows and it helps. The paper's residual does not see the
 * errors of its bias forces. */
static void refine_outside(struct forward *f)
{
    const struct kernel_spec *spec = &f->chain.job->spec->kernel;
    f->refined = spec->inner_refinements +
                 refinement_run(f->chain.comm, TAG_EXTREME, spec->outer_refinements, f->direct,
                                &f->residual, &f->residual_scale, refine, f);
}

/* evaluate: ud from the coordinates and rates in the chain. The stages of the paper's figures. */
static void evaluate(struct forward *f)
{
    struct chain *ch = &f->chain;
    comm_stage(ch->comm, STAGE_PLACE);
    given_forces(f);
    chain_place(ch);
    exchange_joints(f);
    if (f->direct) evaluate_direct(f);
    else evaluate_paper(f);
    refine_outside(f);
}

/* publish: the answer. */
static void publish(const struct forward *f)
{
    const struct chain *ch = &f->chain;
    const int k = comm_rank(ch->comm), first = forward_body(f, ch->lo)->u_at,
              nu = chain_nu(ch->shared, ch->lo, ch->hi);
    publish_reals(ch->comm, OUTPUT_QDD, first, nu, f->ud);
    if (k == 0) publish_number(ch->comm, OUTPUT_REFINED, 0, f->refined);
}

/* evaluate_once: for the time steps; only the first answer is kept. */
static void evaluate_once(void *program)
{
    struct forward *f = program;
    evaluate(f);
    if (!f->published) publish(f);
    motion_watch(&f->motion.seen, f->residual, f->residual_scale, f->blocks.reduction.condition);
    f->published = true;
}

/* Time steps and single evaluations take the same way (motion.h). */
void forward_run(struct forward *f)
{
    struct chain *ch = &f->chain;
    struct motion *m = &f->motion;
    chain_load(ch);
    m->comm = ch->comm;
    m->body = ch->shared->body;
    m->first = ch->lo, m->n = ch->hi - ch->lo;
    m->q = ch->q, m->u = ch->u, m->ud = f->ud;
    m->evaluate = evaluate_once;
    m->program = f;
    m->work = &ch->work;
    motion_run(m);
    chain_report(ch);
}
