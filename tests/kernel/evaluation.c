/* evaluation.c - kernels on many ranks against the serial algorithms (evaluation.h). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "dynamics/dynamics.h"
#include "dynamics/system.h"
#include "evaluation.h"

struct run_spec evaluation_spec(const char *name, int n, int P)
{
    struct run_spec s = {.nrank = P};
    snprintf(s.kernel.name, sizeof s.kernel.name, "%s", name);
    s.kernel.composites_incoming = true;
    s.kernel.formulation = FORMULATION_DIRECT;
    s.model = (struct model_spec){.generator = MODEL_SERIAL_CHAIN,
                                  .nbody = n,
                                  .joint = JOINT_REVOLUTE,
                                  .inertia = INERTIA_RANDOM,
                                  .pose = POSE_RANDOM,
                                  .axes = AXES_TWISTED,
                                  .length = 1,
                                  .radius = 0.05,
                                  .mass = 1,
                                  .mass_ratio = 4,
                                  .gravity = {0, 0, -9.81},
                                  .rate = 1,
                                  .torque = 1,
                                  .branch = 2,
                                  .seed = (uint64_t)(7 * n + 1)};
    return s;
}

struct running {
    const struct kernel_type *kernel;
    const struct kernel_job *job;
    char **workspace;
};

static void program(struct comm *c, void *context)
{
    struct running *r = context;
    r->kernel->run(c, r->job, r->workspace[comm_rank(c)]);
}

static double relative_error(int n, const double *x, const double *reference)
{
    double error = 0, scale = 0;
    for (int i = 0; i < n; i++) {
        const double e = fabs(x[i] - reference[i]);
        if (!(e <= error)) error = e;
        scale = fmax(scale, fabs(reference[i]));
    }
    return scale > 0 ? error / scale : error;
}

/* compare: with RNEA and ABA. */
static void compare(const struct kernel_job *job, struct arena *a, struct evaluation *v)
{
    const struct model *m = job->model;
    const struct state *s = job->state;
    struct dynamics *d = dynamics_take(m, a);
    struct work w = {0};
    double *reference = TAKE(a, m->nu + 1, double), *tau = TAKE(a, m->nu + 1, double);
    dynamics_load(d, s);
    if (job_output(job, OUTPUT_TAU)) {
        rnea(d, s->q, s->qd, s->qdd, reference, &w);
        v->tau_error = relative_error(m->nu, job_output(job, OUTPUT_TAU), reference);
    }
    if (!job_output(job, OUTPUT_QDD)) return;
    memcpy(tau, s->tau, (size_t)m->nu * sizeof *tau);
    springs_add(d, s->q, s->qd, tau);
    if (m->nloop == 0) assert_true(aba(d, s->q, s->qd, tau, reference, &w));
    else assert_true(closed_forward(d, s->q, s->qd, tau, reference, NULL, NULL, &w));
    v->qdd_error = relative_error(m->nu, job_output(job, OUTPUT_QDD), reference);
}

/* want: every output of the program `k` for the job's model. */
static void want(struct kernel_job *job, const struct kernel_type *k, struct arena *a)
{
    const struct model *m = job->model;
    if (k->does_inverse) job_want(job, OUTPUT_TAU, m->nu, a);
    if (k->does_forward) job_want(job, OUTPUT_QDD, m->nu, a);
    if (job->spec->kernel.steps > 0) {
        job_want(job, OUTPUT_Q_END, m->nq, a);
        job_want(job, OUTPUT_QD_END, m->nu, a);
    }
    if (m->nrow > 0) job_want(job, OUTPUT_LAMBDA, m->nrow, a);
    job_want(job, OUTPUT_LOOP_RANK, 1, a);
    job_want(job, OUTPUT_RESIDUAL, job->nrank, a);
    job_want(job, OUTPUT_CONDITION, job->nrank, a);
}

/* keep: what it published. */
static void keep(const struct kernel_job *job, struct evaluation *v)
{
    v->tau = job_output(job, OUTPUT_TAU);
    v->qdd = job_output(job, OUTPUT_QDD);
    v->q_end = job_output(job, OUTPUT_Q_END);
    v->qd_end = job_output(job, OUTPUT_QD_END);
    v->lambda = job_output(job, OUTPUT_LAMBDA);
    v->loop_rank = (int)*job_output(job, OUTPUT_LOOP_RANK);
    for (int r = 0; r < job->nrank; r++) {
        v->residual = fmax(v->residual, job_output(job, OUTPUT_RESIDUAL)[r]);
        v->condition = fmax(v->condition, job_output(job, OUTPUT_CONDITION)[r]);
    }
}

struct evaluation evaluate_omitting(const struct run_spec *spec, const struct model *model, const struct state *state,
                                    struct job_omit omit, struct arena *a)
{
    struct err e = {0};
    struct evaluation v = {0};
    const struct kernel_type *k = spec->kernel.algebra == ALGEBRA_PLANAR
                                      ? kernel_find_planar(spec->kernel.name, spec->kernel.precision)
                                      : kernel_find_precision(spec->kernel.name, spec->kernel.precision);
    assert_non_null(k);
    struct kernel_job job = {.spec = spec, .model = model, .state = state, .omit = omit, .nrank = spec->nrank};
    if (model) want(&job, k, a);
    else job_want(&job, OUTPUT_SECONDS, spec->nrank, a);
    if (!k->accepts(spec, model, &e) || !k->prepare(&job, a, &e)) fail_msg("%s", e.text);
    char **workspace = TAKE(a, spec->nrank, char *);
    for (int r = 0; r < spec->nrank; r++) {
        const size_t bytes = k->workspace_bytes(&job, r);
        v.rank_bytes = bytes > v.rank_bytes ? bytes : v.rank_bytes;
        workspace[r] = arena_take(a, bytes);
    }
    struct running running = {.kernel = k, .job = &job, .workspace = workspace};
    v.counts = many_ranks_publishing(spec->nrank, program, &running, job.output, KERNEL_OUTPUTS);
    assert_int_equal(v.counts.blocked, 0);
    assert_int_equal(v.counts.unread, 0);
    if (model) keep(&job, &v);
    else v.measured = job_output(&job, OUTPUT_SECONDS);
    if (k->needs_model && spec->kernel.steps == 0) compare(&job, a, &v);
    return v;
}

struct evaluation evaluate_model(const struct run_spec *spec, const struct model *model, const struct state *state,
                                 struct arena *a)
{
    return evaluate_omitting(spec, model, state, (struct job_omit){0}, a);
}

struct evaluation evaluate(const struct run_spec *spec, struct arena *a)
{
    struct err e = {0};
    const struct kernel_type *k = kernel_find(spec->kernel.name);
    assert_non_null(k);
    if (!k->needs_model) return evaluate_model(spec, NULL, NULL, a);
    const struct model *model = model_build(&spec->model, a, &e);
    if (!model) fail_msg("%s", e.text);
    return evaluate_model(spec, model, state_make(model, &spec->model, a), a);
}
