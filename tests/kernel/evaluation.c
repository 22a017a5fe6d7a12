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
#include "kernel/dynamics_program.h"
#include "kernel/micro_program.h"
#include "kernel/programs.h"

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
    const struct program_run *run;
    char **workspace;
};

static void program(struct comm *c, void *context)
{
    struct running *r = context;
    r->run->rank->run(c, r->run->job, r->workspace[comm_rank(c)]);
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
static void compare(const struct program_run *r, struct arena *a, struct evaluation *v)
{
    const struct model *m = dynamics_run_of(r)->job.model;
    const struct state *s = dynamics_run_of(r)->job.state;
    struct dynamics *d = dynamics_take(m, a);
    struct work w = {0};
    double *reference = TAKE(a, m->nu + 1, double), *tau = TAKE(a, m->nu + 1, double);
    dynamics_load(d, s);
    if (v->tau) {
        rnea(d, s->q, s->qd, s->qdd, reference, &w);
        v->tau_error = relative_error(m->nu, v->tau, reference);
    }
    if (!v->qdd) return;
    memcpy(tau, s->tau, (size_t)m->nu * sizeof *tau);
    springs_add(d, s->q, s->qd, tau);
    if (m->nloop == 0) assert_true(aba(d, s->q, s->qd, tau, reference, &w));
    else assert_true(closed_forward(d, s->q, s->qd, tau, reference, NULL, NULL, &w));
    v->qdd_error = relative_error(m->nu, v->qdd, reference);
}

/* keep: what a program of dynamics published. */
static void keep(const struct program_run *r, struct evaluation *v)
{
    v->tau = program_output(r, OUTPUT_TAU);
    v->qdd = program_output(r, OUTPUT_QDD);
    v->q_end = program_output(r, OUTPUT_Q_END);
    v->qd_end = program_output(r, OUTPUT_QD_END);
    v->lambda = program_output(r, OUTPUT_LAMBDA);
    v->loop_rank = (int)*program_output(r, OUTPUT_LOOP_RANK);
    for (int k = 0; k < r->spec.nrank && dynamics_run_of(r)->job.watch; k++) {
        v->residual = fmax(v->residual, program_output(r, OUTPUT_RESIDUAL)[k]);
        v->condition = fmax(v->condition, program_output(r, OUTPUT_CONDITION)[k]);
    }
}

/* go: every rank to its end, without a simulator. */
static void go(const struct program_run *r, struct arena *a, struct evaluation *v)
{
    const int nrank = r->spec.nrank;
    char **workspace = TAKE(a, nrank, char *);
    for (int k = 0; k < nrank; k++) {
        const size_t bytes = r->rank->workspace_bytes(r->job, k);
        v->rank_bytes = bytes > v->rank_bytes ? bytes : v->rank_bytes;
        workspace[k] = arena_take(a, bytes);
    }
    struct running running = {.run = r, .workspace = workspace};
    v->counts = many_ranks_publishing(nrank, program, &running, r->output, PROGRAM_OUTPUTS);
    assert_int_equal(v->counts.blocked, 0);
    assert_int_equal(v->counts.unread, 0);
}

/* open_scene: whether a scene is planar is asked in double precision, whatever the program computes
 * in. */
static void open_scene(struct program_run *r, const struct model *model, const struct state *state,
                       struct job_omit omit, bool watch)
{
    struct err e = {0};
    const struct kernel_spec given = r->spec.kernel;
    r->spec.kernel.precision = PRECISION_DOUBLE;
    if (!dynamics_open(r, model, state, &e)) fail_msg("%s", e.text);
    struct dynamics_run *d = dynamics_run_of(r);
    r->spec.kernel.precision = given.precision;
    d->kernel = d->kernel->planar ? kernel_find_planar(given.name, given.precision)
                                  : kernel_find_precision(given.name, given.precision);
    d->job.omit = omit;
    d->job.watch = watch;
    r->rank = &d->kernel->rank;
}

static struct evaluation evaluate_as(const struct run_spec *spec, const struct model *model,
                                     const struct state *state, struct job_omit omit, bool watch,
                                     struct arena *a)
{
    struct err e = {0};
    struct evaluation v = {0};
    struct program_run *r = TAKE(a, 1, struct program_run);
    *r = (struct program_run){.type = program_find(spec->kernel.name), .spec = *spec, .arena = a};
    if (r->spec.kernel.algebra == ALGEBRA_AUTO) r->spec.kernel.algebra = ALGEBRA_SPATIAL;
    assert_non_null(r->type);
    if (!model && !r->type->open(r, &e)) fail_msg("%s", e.text);
    if (model) open_scene(r, model, state, omit, watch);
    if (!r->type->prepare(r, a, &e)) fail_msg("%s", e.text);
    go(r, a, &v);
    if (model) keep(r, &v);
    else v.measured = program_output(r, OUTPUT_SECONDS);
    if (model && spec->kernel.steps == 0) compare(r, a, &v);
    return v;
}

struct evaluation evaluate_omitting(const struct run_spec *spec, const struct model *model,
                                    const struct state *state, struct job_omit omit,
                                    struct arena *a)
{
    return evaluate_as(spec, model, state, omit, true, a);
}

struct evaluation evaluate_unwatched(const struct run_spec *spec, const struct model *model,
                                     const struct state *state, struct arena *a)
{
    return evaluate_as(spec, model, state, (struct job_omit){0}, false, a);
}

struct evaluation evaluate_model(const struct run_spec *spec, const struct model *model,
                                 const struct state *state, struct arena *a)
{
    return evaluate_omitting(spec, model, state, (struct job_omit){0}, a);
}

struct evaluation evaluate(const struct run_spec *spec, struct arena *a)
{
    struct err e = {0};
    const struct program_type *type = program_find(spec->kernel.name);
    assert_non_null(type);
    if (!type->has_scene) return evaluate_model(spec, NULL, NULL, a);
    const struct model *model = model_build(&spec->model, a, &e);
    if (!model) fail_msg("%s", e.text);
    return evaluate_model(spec, model, state_make(model, &spec->model, a), a);
}
