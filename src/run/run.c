/* run.c - one run: build, place, go, verify, collect. */
#include "run/run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "base/progress.h"
#include "dynamics/system.h"
#include "kernel/kernel.h"
#include "model/model.h"
#include "run/launch.h"
#include "run/omission.h"
#include "run/references.h"
#include "run/scene.h"
#include "run/trust.h"

/* The arrays for the answers. */
static bool make_job(struct kernel_job *job, const struct kernel_type *kernel, const struct run_spec *spec,
                     struct scene *scene, struct arena *a, struct err *e)
{
    *job = (struct kernel_job){.spec = spec, .nrank = spec->nrank};
    if (scene) {
        const struct model *m = job->model = scene->model;
        job->state = scene->state;
        job->omit = omission_job(spec, m, scene->state);
        job->omit.fixed = scene->fixed;
        if (kernel->does_inverse) job_want(job, OUTPUT_TAU, m->nu, a);
        if (kernel->does_forward) job_want(job, OUTPUT_QDD, m->nu, a);
        if (m->nrow) job_want(job, OUTPUT_LAMBDA, m->nrow, a);
        job_want(job, OUTPUT_LOOP_RANK, 1, a);
        *job_output(job, OUTPUT_LOOP_RANK) = -1;
        if (spec->kernel.steps > 0) {
            job_want(job, OUTPUT_Q_END, m->nq, a);
            job_want(job, OUTPUT_QD_END, m->nu, a);
        }
        job_want(job, OUTPUT_RESIDUAL, spec->nrank, a);
        job_want(job, OUTPUT_RESIDUAL_SCALE, spec->nrank, a);
        job_want(job, OUTPUT_CONDITION, spec->nrank, a);
    } else {
        job_want(job, OUTPUT_SECONDS, spec->nrank, a);
    }
    return kernel->accepts(spec, job->model, e) && kernel->prepare(job, a, e);
}

static double largest_measured(const struct kernel_job *job)
{
    const double *seconds = job->model ? NULL : job_output(job, OUTPUT_SECONDS);
    double largest = seconds ? 0 : NAN;
    for (int i = 0; seconds && i < job->nrank; i++) largest = fmax(largest, seconds[i]);
    return largest;
}

static void verify(const struct kernel_job *job, const struct kernel_type *kernel, struct scene *scene,
                   struct arena *scratch, struct run_result *out)
{
    out->measured_s = largest_measured(job);
    if (out->status != RUN_OK && out->status != RUN_INVALID) return;
    references_loops(job, scratch, out);
    references_check(job, scene, scratch, out);
    references_baselines(job, kernel, scene, scratch, out);
}

/* The program once, with the settings that it has now. */
static bool attempt(const struct run_spec *spec, const struct kernel_type *kernel, struct kernel_job *job,
                    struct scene *scene, struct arena *scratch, struct arena *a, struct run_result *out, struct err *e)
{
    struct machine_spec machine = omission_machine(spec);
    struct record_spec record = omission_record(spec);
    memset(out, 0, sizeof *out);
    if (!make_job(job, kernel, spec, scene, scratch, e)) return false;
    if (!launch_job(kernel, job, &machine, &record, spec->seed + (uint64_t)spec->rep,
                    omission_largest_message(spec, kernel, job), scratch, a, out, e))
        return false;
    out->residual = NAN;
    if (out->status == RUN_OK) trust_check(job, out);
    return true;
}

/* Attempts until the answer needs no further refinement; `spec` ends with the refinements of the last. When the last is
 * no better than the first, the first is what holds. */
static bool refine(struct run_spec *spec, const struct kernel_type *kernel, struct kernel_job *job,
                   struct scene *scene, struct arena *scratch, struct arena *a, struct run_result *out, struct err *e)
{
    const struct kernel_spec given = spec->kernel;
    struct arena_mark work = arena_mark(scratch), results = arena_mark(a);
    if (!attempt(spec, kernel, job, scene, scratch, a, out, e)) return false;
    const double before = out->residual;
    const bool solves = job->model && job_output(job, OUTPUT_QDD);
    while (solves && out->status != RUN_DEADLOCK && trust_refine(spec, job->model, out)) {
        arena_release(scratch, work);
        arena_release(a, results);
        if (!attempt(spec, kernel, job, scene, scratch, a, out, e)) return false;
    }
    const bool worse = out->residual >= before || isnan(out->residual);
    if (worse && (spec->kernel.inner_refinements > given.inner_refinements ||
                  spec->kernel.outer_refinements > given.outer_refinements)) {
        spec->kernel = given;
        arena_release(scratch, work);
        arena_release(a, results);
        if (!attempt(spec, kernel, job, scene, scratch, a, out, e)) return false;
    }
    out->inner_added = spec->kernel.inner_refinements - given.inner_refinements;
    out->outer_added = spec->kernel.outer_refinements - given.outer_refinements;
    out->twice_added = spec->kernel.residual != given.residual;
    out->residual_before = before;
    return true;
}

bool run_sharing(const struct run_spec *spec, struct scene_shelf *shelf, struct arena *a, struct run_result *out,
                 struct err *e)
{
    memset(out, 0, sizeof *out);
    double begin = host_seconds();
    const struct kernel_type *kernel = omission_kernel(spec, NULL, NULL, e);
    if (!kernel) return false;
    if (spec->machine.network.level == LEVEL_AUTO_TOLERANCE)
        return err_set(e, ERR_CONFIG,
                       "level 'auto-tolerance' is for 'mimdsim run' and 'mimdsim paper'; choose a level");
    struct scene *scene = kernel->needs_model ? scene_take(shelf, spec, e) : NULL;
    if (kernel->needs_model && !scene) return false;
    if (scene) kernel = omission_kernel(spec, scene->model, scene->state, e);
    if (!kernel) return false;
    struct arena *scratch = arena_create();
    struct kernel_job job;
    struct run_spec own = *spec;
    bool ok = refine(&own, kernel, &job, scene, scratch, a, out, e);
    if (ok) out->nomission = omission_list(&job, kernel, out->omission);
    if (ok && job.model) {
        out->nbody = job.model->nbody + job.omit.fixed;
        out->nu = job.model->nu;
    }
    if (ok) verify(&job, kernel, scene, scratch, out);
    arena_destroy(scratch);
    out->host_total_s = host_seconds() - begin;
    out->host_peak_bytes = host_peak_bytes();
    return ok;
}

bool run_one(const struct run_spec *spec, struct arena *a, struct run_result *out, struct err *e)
{
    struct scene_shelf *shelf = scene_shelf_create();
    bool ok = run_sharing(spec, shelf, a, out, e);
    scene_shelf_destroy(shelf);
    return ok;
}

enum { STACK_PAGES_BYTES = 2 * 4096 };

bool run_explain(const struct run_spec *spec, struct run_estimate *out, struct err *e)
{
    memset(out, 0, sizeof *out);
    const struct kernel_type *kernel = omission_kernel(spec, NULL, NULL, e);
    if (!kernel) return false;
    struct arena *scratch = arena_create();
    struct kernel_job job = {.spec = spec, .nrank = spec->nrank};
    struct model *m = kernel->needs_model ? model_build(&spec->model, scratch, e) : NULL;
    bool ok = !kernel->needs_model || m;
    if (ok && m) {
        struct state *s = state_make(m, &spec->model, scratch);
        const int fixed = omission_scene(spec, &m, &s, scratch);
        job.model = m, job.state = s;
        job.omit = omission_job(spec, m, s);
        job.omit.fixed = fixed;
        kernel = omission_kernel(spec, m, s, e);
    }
    ok = ok && kernel;
    if (ok) ok = kernel->accepts(spec, job.model, e);
    if (ok) {
        struct kernel_estimate k = {0};
        kernel->estimate(spec, job.model, &job.omit, &k);
        out->nbody = m ? m->nbody + job.omit.fixed : 0;
        out->nu = m ? m->nu : 0;
        if (m) out->metre = m->metre, out->kilogram = m->kilogram, out->second = m->second;
        out->messages = k.messages;
        out->bytes = k.bytes;
        out->flops = k.flops;
        out->nomission = omission_list(&job, kernel, out->omission);
        out->nunused = omission_unused(&job, kernel, out->unused);
        /* Measured with bench/bench_messages: host seconds per message and per flop, bytes beside a rank's own. */
        double per_message = spec->machine.network.level == LEVEL_LOGGP ? 0.4e-6 : 1.5e-6;
        out->host_s = k.messages * per_message + k.flops * 0.6e-9 + spec->nrank * 1.5e-6;
        out->host_bytes = spec->nrank * (k.rank_bytes + STACK_PAGES_BYTES + 1400.0) + (double)out->nbody * 1200.0;
    }
    arena_destroy(scratch);
    return ok;
}
