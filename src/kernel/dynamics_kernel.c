/* dynamics_kernel.c - the kernels "inverse", "forward" and "dynamics" (dynamics_kernel.h). */
#include "kernel/dynamics_kernel.h"

#include <string.h>

#include "kernel/contraction.h"
#include "kernel/dynamics_program.h"
#include "kernel/estimate.h"
#include "kernel/forward.h"
#include "kernel/publish.h"

/* Names of the stages as in the paper: the three sweeps of Newton-Euler, then assembly, solution
 * and accelerations of the constraint force algorithm. */
static const char *const stage_name[] = {"Pre-processing", "NE[1]",  "NE[2]", "NE[3]",
                                         "CFA[1]",         "CFA[2]", "CFA[3]"};
enum { INVERSE_STAGES = 4, FORWARD_STAGES = 7 };

/* INVERSE_DEPTH: of the calls of inverse dynamics in double precision, with those of a send and a
 * wait at level link, which are 64 bytes deeper than at loggp [B]. With a body on each of 2^20
 * ranks that leaves 48 bytes of a page. */
enum { INVERSE_DEPTH = REAL_BITS == 64 ? 1312 : 0 };

/* INVERSE_DEEPEST, FORWARD_DEEPEST: with any joints, solver, formulation and rule of time steps. */
enum { INVERSE_DEEPEST = 1664, FORWARD_DEEPEST = 2880 };

/* inverse's workspaces: one rank's share of the model, accelerations given, joint forces made. */
struct chain_inverse {
    struct chain chain;
    real *ud, *tau; /* own joints */
};
struct tree_inverse {
    struct tree tree;
    real *ud, *tau;
};

/* One body a rank: a textbook row of three square blocks and a right-hand side is the largest
 * message there is. */
static int64_t largest_message(const void *job_)
{
    const struct kernel_job *job = job_;
    bool gathers = job->spec->kernel.solver == SOLVER_THOMAS;
    /* Trees and Thomas gather compounds or rows of unknown number: no bound. */
    if (kernel_branches(job->model, &job->omit) || gathers || job->model->nbody != job->nrank)
        return -1;
    return (3 * SQUARE + SPACE) * (int64_t)sizeof(real);
}

/* What a spec may ask for and the program does not have is refused here, before anything is
 * built. */
static bool accepts_inverse(const struct kernel_job *job, struct err *e)
{
    const struct run_spec *spec = job->spec;
    const struct model *model = job->model;
    if (spec->nrank > model->nbody)
        return err_set(e, ERR_CONFIG, "%d ranks for %d bodies: each rank needs at least one body",
                       spec->nrank, model->nbody);
    /* Compounds have structured operators only. */
    if (kernel_branches(model, &job->omit) && spec->kernel.operators == OPERATORS_DENSE)
        return err_set(e, ERR_CONFIG, "dense operators exist for open chains only");
    return true;
}

/* Linearly implicit springs change the rows of the system (physics 9.0); where a variant would need
 * them and has not been written, the run is refused and not computed differently. */
static bool accepts_implicit(const struct kernel_job *job, struct err *e)
{
    const struct kernel_spec *k = &job->spec->kernel;
    const struct model *model = job->model;
    if (k->formulation != FORMULATION_DIRECT)
        return err_set(
            e, ERR_CONFIG,
            "linearly implicit steps exist in the direct formulation: kernel.formulation");
    if (model->nloop > 0)
        return err_set(e, ERR_CONFIG, "linearly implicit steps exist for open systems only");
    if (kernel_branches(model, &job->omit) && k->inner_refinements > 0)
        return err_set(
            e, ERR_CONFIG,
            "linearly implicit steps of trees have no inner refinement: take an outer one");
    return true;
}

static bool accepts_forward(const struct kernel_job *job, struct err *e)
{
    const struct kernel_spec *k = &job->spec->kernel;
    const struct model *model = job->model;
    if (!accepts_inverse(job, e)) return false;
    /* Phi = I^-1 enters the constraint system: massless bodies and point masses have none (physics
     * 1.4). */
    if (!model->has_phi)
        return err_set(
            e, ERR_CONFIG,
            "a body has no invertible inertia: the constraint force algorithm needs one");
    /* The textbook's reduction forms inverses and keeps no factors (physics 5.3 i). */
    if (!kernel_branches(model, &job->omit) && k->solver == SOLVER_PCR &&
        k->inner_refinements + k->outer_refinements > 0)
        return err_set(e, ERR_CONFIG,
                       "solver pcr keeps no factors to refine with: choose pcr-symmetric");
    /* forward_exact.c is the operator form of chains (physics 4.8); the paper's form takes its
     * answer from products with B and C instead. */
    if (k->residual == RESIDUAL_TWICE &&
        (kernel_branches(model, &job->omit) || k->formulation != FORMULATION_DIRECT))
        return err_set(e, ERR_CONFIG,
                       "residual: twice exists for open chains in the direct formulation");
    return !kernel_spec_implicit(k) || accepts_implicit(job, e);
}

static bool prepare(struct kernel_job *job, struct arena *a, struct err *e)
{
    /* Trees have pieces, chains have blocks; both are made once and read by all ranks. */
    (void)e;
    const bool tree = kernel_branches(job->model, &job->omit);
    job->shared = tree ? (const void *)tree_shared_make(job, a) : chain_shared_make(job, a);
    return true;
}

/* Inverse dynamics needs accelerations and forces, but not the right neighbour's first pose: its
 * force arrives already moved to this rank's frame. */
static void chain_inverse_carve(struct chain_inverse *v, struct carve *c,
                                const struct kernel_job *job, int rank)
{
    chain_carve(&v->chain, c, job, rank, false, true, true);
    scan_carve(&v->chain.scan, c, v->chain.dense, job->spec->kernel.composites_incoming, rank,
               job->nrank);
    const int nu = chain_nu(v->chain.shared, v->chain.lo, v->chain.hi);
    /* The forces are written when the accelerations have been used. */
    v->ud = v->tau = CARVE(c, nu, real);
}

/* Pieces scan by pointer jumping, whose room is part of the tree's own. */
static void tree_inverse_carve(struct tree_inverse *v, struct carve *c,
                               const struct kernel_job *job, int rank)
{
    tree_carve(&v->tree, c, job, rank);
    v->ud = CARVE(c, v->tree.nu, real);
    v->tau = CARVE(c, v->tree.nu, real);
}

/* head: room for a workspace's struct, before what is carved; 16 bytes, the alignment of
 * carve.h. */
static size_t head(size_t size) { return (size + 15) & ~(size_t)15; }

/* The size of a workspace is found by carving it without a base. */
static size_t inverse_bytes(const void *job_, int rank)
{
    const struct kernel_job *job = job_;
    if (kernel_branches(job->model, &job->omit)) {
        struct tree_inverse measured;
        struct carve c = {.used = head(sizeof measured)};
        tree_inverse_carve(&measured, &c, job, rank);
        return c.used;
    }
    struct chain_inverse measured;
    struct carve c = {.used = head(sizeof measured)};
    chain_inverse_carve(&measured, &c, job, rank);
    return c.used;
}

/* Chain or tree: the same question to another program. */
static size_t forward_bytes(const void *job_, int rank)
{
    const struct kernel_job *job = job_;
    if (kernel_branches(job->model, &job->omit)) {
        struct contraction measured;
        struct carve c = {.used = head(sizeof measured)};
        contraction_carve(&measured, &c, job, rank);
        return c.used;
    }
    struct forward measured;
    struct carve c = {.used = head(sizeof measured)};
    forward_carve(&measured, &c, job, rank);
    return c.used;
}

/* Inverse and forward dynamics use the same memory, one after the other. */
static size_t dynamics_bytes(const void *job_, int rank)
{
    const struct kernel_job *job = job_;
    const size_t inverse = inverse_bytes(job, rank), forward = forward_bytes(job, rank);
    return inverse > forward ? inverse : forward;
}

/* Open chains in double precision alone: dense operators, residuals in twice the digits and
 * programs for trees have larger frames. */
static bool is_plain(const struct kernel_job *job)
{
    const struct kernel_spec *k = &job->spec->kernel;
    return REAL_BITS == 64 && !kernel_branches(job->model, &job->omit) &&
           k->operators == OPERATORS_STRUCTURED && k->residual != RESIDUAL_TWICE &&
           !kernel_spec_implicit(k);
}

static int inverse_deepest(const void *job_)
{
    const struct kernel_job *job = job_;
    return !is_plain(job) ? 0 : model_all_revolute(job->model) ? INVERSE_DEPTH : INVERSE_DEEPEST;
}

static int forward_deepest(const void *job) { return is_plain(job) ? FORWARD_DEEPEST : 0; }

/* The program of one rank: the three recurrences in order, then its own part of tau. */
static void chain_inverse_run(struct comm *c, const struct kernel_job *job, struct chain_inverse *v)
{
    struct chain *ch = &v->chain;
    struct carve room = {.base = (char *)v, .used = head(sizeof *v)};
    chain_inverse_carve(v, &room, job, comm_rank(c));
    ch->comm = ch->scan.comm = c;
    comm_stage(c, STAGE_PLACE);
    chain_load(ch);
    /* Own joints are contiguous in the model's arrays. */
    const int first = ch->shared->body[ch->lo].u_at, nu = chain_nu(ch->shared, ch->lo, ch->hi);
    for (int k = 0; k < nu; k++) v->ud[k] = (real)job->state->qdd[first + k];
    chain_place(ch);
    comm_stage(c, STAGE_VELOCITY);
    chain_velocity(ch);
    comm_stage(c, STAGE_ACCELERATION);
    chain_bias(ch);
    chain_acceleration(ch, v->ud);
    comm_stage(c, STAGE_FORCE);
    chain_force(ch, v->tau);
    publish_reals(c, OUTPUT_TAU, first, nu, v->tau);
}

/* As chain_inverse_run; own joints of a piece are scattered over the model's arrays, so that they
 * are copied and published body by body. */
static void tree_inverse_run(struct comm *c, const struct kernel_job *job, struct tree_inverse *v)
{
    struct tree *t = &v->tree;
    struct carve room = {.base = (char *)v, .used = head(sizeof *v)};
    tree_inverse_carve(v, &room, job, comm_rank(c));
    t->comm = c;
    comm_stage(c, STAGE_PLACE);
    tree_load(t);
    for (int l = 0; l < t->n; l++)
        for (int k = 0; k < tree_body(t, l)->d; k++)
            v->ud[t->u_at[l] + k] = (real)job->state->qdd[tree_body(t, l)->u_at + k];
    tree_place(t);
    comm_stage(c, STAGE_VELOCITY);
    tree_velocity(t);
    comm_stage(c, STAGE_ACCELERATION);
    tree_bias(t);
    tree_acceleration(t, v->ud);
    comm_stage(c, STAGE_FORCE);
    tree_force(t, v->tau, NULL);
    for (int l = 0; l < t->n; l++)
        publish_reals(c, OUTPUT_TAU, tree_body(t, l)->u_at, tree_body(t, l)->d,
                      v->tau + t->u_at[l]);
}

/* Branches decide between two programs with the same stages and outputs. */
static void inverse_run(struct comm *c, const void *job_, void *workspace)
{
    const struct kernel_job *job = job_;
    if (kernel_branches(job->model, &job->omit)) tree_inverse_run(c, job, workspace);
    else chain_inverse_run(c, job, workspace);
}

/* The workspace begins with the struct itself; what it points to follows it. */
static void chain_forward_run(struct comm *c, const struct kernel_job *job, struct forward *f)
{
    struct carve room = {.base = (char *)f, .used = head(sizeof *f)};
    forward_carve(f, &room, job, comm_rank(c));
    forward_set(f, c);
    forward_run(f);
}

/* The same for trees (contraction.h). */
static void tree_forward_run(struct comm *c, const struct kernel_job *job, struct contraction *k)
{
    struct carve room = {.base = (char *)k, .used = head(sizeof *k)};
    contraction_carve(k, &room, job, comm_rank(c));
    contraction_set(k, c);
    contraction_run(k);
}

/* One kernel for both: which algorithm runs depends on the model. */
static void either_forward_run(struct comm *c, const void *job_, void *workspace)
{
    const struct kernel_job *job = job_;
    if (kernel_branches(job->model, &job->omit)) tree_forward_run(c, job, workspace);
    else chain_forward_run(c, job, workspace);
}

/* The barrier separates the two measurements. Forward dynamics expects a workspace of zeros, as it
 * would find it when run alone. */
static void both_run(struct comm *c, const void *job, void *workspace)
{
    inverse_run(c, job, workspace);
    comm_barrier(c);
    memset(workspace, 0, dynamics_bytes(job, comm_rank(c)));
    either_forward_run(c, job, workspace);
}

/* The three kernels of this precision and space: the same sources make six sets of them. */
const struct kernel_type inverse_kernel = {
    .name = "inverse",
    .title = "inverse dynamics by recursive doubling (parallel Newton-Euler)",
    .needs_model = true,
    .planar = SPACE == 3,
    .does_inverse = true,
    .rank = {.nstage = INVERSE_STAGES,
             .stage_name = stage_name,
             .workspace_bytes = inverse_bytes,
             .largest_message = largest_message,
             .run = inverse_run,
             .depth = INVERSE_DEPTH,
             .deepest = inverse_deepest},
    .accepts = accepts_inverse,
    .prepare = prepare,
    .estimate = estimate_inverse,
};

const struct kernel_type forward_kernel = {
    .name = "forward",
    .title = "forward dynamics by the constraint force algorithm",
    .needs_model = true,
    .planar = SPACE == 3,
    .does_forward = true,
    .rank = {.nstage = FORWARD_STAGES,
             .stage_name = stage_name,
             .workspace_bytes = forward_bytes,
             .largest_message = largest_message,
             .run = either_forward_run,
             .deepest = forward_deepest},
    .accepts = accepts_forward,
    .prepare = prepare,
    .estimate = estimate_forward,
};

const struct kernel_type dynamics_kernel = {
    .name = "dynamics",
    .title = "inverse, then forward dynamics",
    .needs_model = true,
    .planar = SPACE == 3,
    .does_inverse = true,
    .does_forward = true,
    .rank = {.nstage = FORWARD_STAGES,
             .stage_name = stage_name,
             .workspace_bytes = dynamics_bytes,
             .largest_message = largest_message,
             .run = both_run,
             .deepest = forward_deepest},
    .accepts = accepts_forward,
    .prepare = prepare,
    .estimate = estimate_dynamics,
};
