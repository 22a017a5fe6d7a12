/* dynamics_kernel.c - the kernels "inverse", "forward" and "dynamics" (dynamics_kernel.h). */
#include "kernel/dynamics_kernel.h"

#include <string.h>

#include "kernel/estimate.h"
#include "kernel/forward.h"

static const char *const stage_name[] = {"Pre-processing", "NE[1]", "NE[2]", "NE[3]", "CFA[1]", "CFA[2]", "CFA[3]"};
enum { INVERSE_STAGES = 4, FORWARD_STAGES = 7 };

/* inverse's workspace. */
struct inverse {
    struct chain chain;
    real *ud, *tau; /* own joints */
};

static bool accepts_inverse(const struct run_spec *spec, const struct model *model, struct err *e)
{
    if (spec->nrank > model->nbody)
        return err_set(e, ERR_CONFIG, "%d processors for %d bodies: each needs at least one", spec->nrank, model->nbody);
    return true;
}

static bool accepts_forward(const struct run_spec *spec, const struct model *model, struct err *e)
{
    const struct kernel_spec *k = &spec->kernel;
    if (!accepts_inverse(spec, model, e)) return false;
    if (!model->has_phi)
        return err_set(e, ERR_CONFIG, "a body has no invertible inertia: the constraint force algorithm needs one");
    if (k->solver == SOLVER_PCR && k->inner_refinements + k->outer_refinements > 0)
        return err_set(e, ERR_CONFIG, "solver pcr keeps no factors to refine with: choose pcr-symmetric");
    return true;
}

static bool prepare(struct kernel_job *job, struct arena *a, struct err *e)
{
    (void)e;
    job->shared = chain_shared_make(job, a);
    return true;
}

static void inverse_carve(struct inverse *v, struct carve *c, const struct kernel_job *job, int rank)
{
    chain_carve(&v->chain, c, job, rank, false, true);
    scan_carve(&v->chain.scan, c, v->chain.dense, job->spec->kernel.composites_incoming, rank, job->nrank);
    const int nu = chain_nu(v->chain.shared, v->chain.lo, v->chain.hi);
    v->ud = CARVE(c, nu, real);
    v->tau = CARVE(c, nu, real);
}

static size_t inverse_bytes(const struct kernel_job *job, int rank)
{
    struct inverse measured;
    struct carve c = {.used = sizeof measured};
    inverse_carve(&measured, &c, job, rank);
    return c.used;
}

static size_t forward_bytes(const struct kernel_job *job, int rank)
{
    struct forward measured;
    struct carve c = {.used = sizeof measured};
    forward_carve(&measured, &c, job, rank);
    return c.used;
}

static size_t dynamics_bytes(const struct kernel_job *job, int rank)
{
    const size_t inverse = inverse_bytes(job, rank), forward = forward_bytes(job, rank);
    return inverse > forward ? inverse : forward;
}

static void inverse_run(struct comm *c, const struct kernel_job *job, void *workspace)
{
    struct inverse *v = workspace;
    struct chain *ch = &v->chain;
    struct carve room = {.base = workspace, .used = (sizeof *v + 15) & ~(size_t)15};
    inverse_carve(v, &room, job, comm_rank(c));
    ch->comm = ch->scan.comm = c;
    comm_stage(c, STAGE_PLACE);
    chain_load(ch);
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
    for (int k = 0; k < nu && job->tau; k++) job->tau[first + k] = (double)v->tau[k];
}

static void forward_run(struct comm *c, const struct kernel_job *job, void *workspace)
{
    struct forward *f = workspace;
    struct carve room = {.base = workspace, .used = (sizeof *f + 15) & ~(size_t)15};
    forward_carve(f, &room, job, comm_rank(c));
    forward_set(f, c);
    chain_load(&f->chain);
    forward_evaluate(f);
    forward_store(f);
}

static void dynamics_run(struct comm *c, const struct kernel_job *job, void *workspace)
{
    inverse_run(c, job, workspace);
    comm_barrier(c);
    memset(workspace, 0, dynamics_bytes(job, comm_rank(c)));
    forward_run(c, job, workspace);
}

const struct kernel_type inverse_kernel = {
    .name = "inverse",
    .title = "inverse dynamics by recursive doubling (parallel Newton-Euler)",
    .needs_model = true,
    .does_inverse = true,
    .nstage = INVERSE_STAGES,
    .stage_name = stage_name,
    .accepts = accepts_inverse,
    .prepare = prepare,
    .workspace_bytes = inverse_bytes,
    .run = inverse_run,
    .estimate = estimate_inverse,
};

const struct kernel_type forward_kernel = {
    .name = "forward",
    .title = "forward dynamics by the constraint force algorithm",
    .needs_model = true,
    .does_forward = true,
    .nstage = FORWARD_STAGES,
    .stage_name = stage_name,
    .accepts = accepts_forward,
    .prepare = prepare,
    .workspace_bytes = forward_bytes,
    .run = forward_run,
    .estimate = estimate_forward,
};

const struct kernel_type dynamics_kernel = {
    .name = "dynamics",
    .title = "inverse, then forward dynamics",
    .needs_model = true,
    .does_inverse = true,
    .does_forward = true,
    .nstage = FORWARD_STAGES,
    .stage_name = stage_name,
    .accepts = accepts_forward,
    .prepare = prepare,
    .workspace_bytes = dynamics_bytes,
    .run = dynamics_run,
    .estimate = estimate_dynamics,
};
