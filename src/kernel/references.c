/* references.c - serial answers, tolerances and baselines; see references.h.
 *
 * A run is right when it agrees with a serial algorithm that shares no code with it but the joints:
 * RNEA for joint forces, ABA for accelerations, the serial integrator for time steps. A run is fast
 * when it beats the fastest of the serial codes on one node, whose operations are counted and
 * priced by the same rules. */
#include "kernel/references.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"
#include "dynamics/dynamics_table.h"
#include "kernel/dense_tally.h"
#include "kernel/divided.h"
#include "kernel/dynamics_program.h"
#include "kernel/omission.h"
#include "measure/rank_sums.h"
#include "model/model_part.h"

/* Largest difference and largest element of the reference (maximum norm), as in physics 8.2. An
 * infinity or a NaN among the answers makes the difference a NaN. */
struct deviation {
    double difference, largest;
};

static struct deviation deviation_of(const double *x, const double *reference, int n)
{
    struct deviation d = {0, 0};
    for (int i = 0; i < n; i++) {
        if (!isfinite(x[i])) return (struct deviation){NAN, 0};
        d.largest = fmax(d.largest, fabs(reference[i]));
        d.difference = fmax(d.difference, fabs(x[i] - reference[i]));
    }
    return d;
}

/* Two vectors of zeros agree whatever they are divided by. */
static double relative(struct deviation d)
{
    return isnan(d.difference) ? NAN : d.difference == 0 ? 0 : d.difference / d.largest;
}

static double relative_error(const double *x, const double *reference, int n)
{
    return relative(deviation_of(x, reference, n));
}

/* A chain of revolute joints has a number for each body, so that its parts are theirs. False: a
 * process does not answer. */
static bool divided_error(const struct program_run *r, const struct scene *scene, int output,
                          const struct serial_answer *reference, double *error)
{
    const int first = scene->first;
    struct deviation d = deviation_of(program_output(r, output) + first, reference->x + first,
                                      scene->end - first);
    if (!divided_worst(r->part, &d.difference, &d.largest)) return false;
    *error = reference->found ? relative(d) : NAN;
    return true;
}

static void check_inverse(const struct program_run *r, struct scene *scene, struct run_result *out)
{
    /* RNEA is the reference of inverse dynamics: shortest, and of the best accuracy (physics
     * 2.1). */
    const struct kernel_job *job = &dynamics_run_of(r)->job;
    double error;
    if (!r->divided) {
        error =
            relative_error(program_output(r, OUTPUT_TAU), scene_inverse(scene)->x, job->model->nu);
    } else if (!divided_inverse(r->part, scene) ||
               !divided_error(r, scene, OUTPUT_TAU, &scene->inverse, &error)) {
        divided_silent(out);
        return;
    }
    program_check_add(out, "tau", "rnea", error,
                      references_tolerance_inverse(&job->spec->kernel, job->model->nbody));
}

/* A hundred times the error of the serial code of the same formulation: what rounding does to this
 * very system. */
static double rounding_of(const struct kernel_spec *k, struct scene *scene, struct arena *scratch)
{
    const bool paper = k->formulation == FORMULATION_PAPER;
    const int nu = scene->model->nu;
    double *qdd = TAKE(scratch, nu, double);
    struct work w = {0};
    const bool found = dynamics_type_of(k->precision)
                           ->forward(scene->model, scene->state,
                                     paper ? FORWARD_CFA_PAPER : FORWARD_CFA_DIRECT, scratch, qdd,
                                     NULL, NULL, &w);
    const double *reference = scene_forward(scene, FORWARD_ABA)->x;
    const double error = found ? 100 * relative_error(qdd, reference, nu) : 0;
    return isfinite(error) ? fmin(error, 1e-2) : 0;
}

/* The same where each process has a part: the first one makes all of the scene for it. */
static double rounding_of_whole(const struct program_run *r, struct arena *scratch)
{
    struct err e;
    err_clear(&e);
    if (r->part->number > 0 || !scene_fits(&r->spec, r->spec.model.nbody, &e)) return 0;
    struct scene *whole = scene_create(&r->spec, r->order.keep, &e);
    const double rounding = whole ? rounding_of(&r->spec.kernel, whole, scratch) : 0;
    scene_destroy(whole);
    return rounding;
}

static void check_forward(const struct program_run *r, struct scene *scene, struct arena *scratch,
                          struct run_result *out)
{
    const struct kernel_job *job = &dynamics_run_of(r)->job;
    double error;
    /* ABA is the reference of forward dynamics (physics 2.2): another formulation, so that a
     * mistake in the constraint force algorithm cannot hide in both. */
    if (!r->divided) {
        const struct serial_answer *aba = scene_forward(scene, FORWARD_ABA);
        error = aba->found ? relative_error(program_output(r, OUTPUT_QDD), aba->x, job->model->nu)
                           : NAN;
    } else if (!divided_forward(r->part, scene) ||
               !divided_error(r, scene, OUTPUT_QDD, &scene->forward[FORWARD_ABA], &error)) {
        divided_silent(out);
        return;
    }
    double tolerance = references_tolerance(&job->spec->kernel, job->model->nbody);
    /* Only an error beyond the general tolerance makes it worth solving the system once more. */
    if (error > tolerance)
        tolerance = fmax(tolerance, r->divided ? rounding_of_whole(r, scratch)
                                               : rounding_of(&job->spec->kernel, scene, scratch));
    program_check_add(out, "qdd", "aba", error, tolerance);
}

/* The state at the end of the job's time steps by the serial integrator, begun at q + change.
 * False: broke down. */
static bool end_state(const struct kernel_job *job, double change, struct arena *scratch,
                      struct state *end)
{
    const struct kernel_spec *k = &job->spec->kernel;
    const struct model *m = job->model;
    *end = *job->state;
    end->q = TAKE(scratch, m->nq, double);
    end->qd = TAKE(scratch, m->nu, double);
    /* All coordinates change by about the same relative and absolute amount. */
    for (int i = 0; i < m->nq; i++) end->q[i] = job->state->q[i] * (1 + change) + change;
    memcpy(end->qd, job->state->qd, (size_t)m->nu * sizeof(double));
    struct work w = {0};
    return dynamics_type_of(PRECISION_DOUBLE)
        ->advance(m, end, k->step, k->step_size / m->second, k->steps, scratch, &w);
}

/* The serial integrator takes the same steps by the same rule, so that both have the same
 * integration error and only rounding is compared. */
static void check_steps(const struct program_run *r, struct arena *scratch, struct run_result *out)
{
    const struct kernel_job *job = &dynamics_run_of(r)->job;
    const double change = 1e-8;
    const int nq = job->model->nq, nu = job->model->nu;
    struct state end, other;
    const bool found = end_state(job, 0, scratch, &end) && end_state(job, change, scratch, &other);
    /* Chaotic motion magnifies any difference. How much a change of 1e-8 grows on the way tells by
     * how much two correct programs may differ at the end. */
    double growth = 1;
    if (found)
        growth = fmax(
            growth, fmax(relative_error(other.q, end.q, nq), relative_error(other.qd, end.qd, nu)) /
                        change);
    const double tolerance =
        fmin(references_tolerance(&job->spec->kernel, job->model->nbody) * growth, 1e-2);
    const double *q = program_output(r, OUTPUT_Q_END), *qd = program_output(r, OUTPUT_QD_END);
    program_check_add(out, "q", "steps", found ? relative_error(q, end.q, nq) : NAN, tolerance);
    program_check_add(out, "qd", "steps", found ? relative_error(qd, end.qd, nu) : NAN, tolerance);
}

void references_loops(const struct program_run *r, struct arena *scratch, struct run_result *out)
{
    const struct kernel_job *job = &dynamics_run_of(r)->job;
    if (job->model->nrow == 0) return;
    struct arena_mark mark = arena_mark(scratch);
    struct state end = *job->state;
    if (program_output(r, OUTPUT_Q_END)) end.q = program_output(r, OUTPUT_Q_END);
    if (program_output(r, OUTPUT_QD_END)) end.qd = program_output(r, OUTPUT_QD_END);
    /* Violations are measured in double precision, whatever the run's. */
    dynamics_type_of(PRECISION_DOUBLE)
        ->drift(job->model, &end, scratch, &out->drift_position, &out->drift_velocity);
    out->loop_rows = job->model->nrow;
    out->loop_rank = (int)*program_output(r, OUTPUT_LOOP_RANK);
    arena_release(scratch, mark);
}

void references_check(const struct program_run *r, struct scene *scene, struct arena *scratch,
                      struct run_result *out)
{
    struct arena_mark mark = arena_mark(scratch);
    if (program_output(r, OUTPUT_TAU)) check_inverse(r, scene, out);
    if (program_output(r, OUTPUT_QDD) && r->spec.kernel.steps == 0)
        check_forward(r, scene, scratch, out);
    if (program_output(r, OUTPUT_QDD) && program_output(r, OUTPUT_Q_END))
        check_steps(r, scratch, out);
    arena_release(scratch, mark);
}

/* How often a run computes the accelerations (physics 9: four evaluations a step for Runge-Kutta,
 * one for the others). */
static uint64_t evaluations(const struct kernel_spec *k)
{
    const uint64_t steps = (uint64_t)k->steps;
    if (steps == 0) return 1;
    return k->step == STEP_RK4 ? 4 * steps : k->step == STEP_KDK ? steps + 1 : steps;
}

static void repeat(struct work *w, uint64_t times)
{
    w->flop *= times, w->div *= times, w->sqrt *= times, w->trig *= times, w->bytes *= times,
        w->call *= times;
}

/* What a method takes at least on a model, by formula: the factorisation of the mass matrix; of
 * chains of constraint forces with revolute joints, a row's elimination with one neighbour and what
 * the accelerations take twice, in the paper's form an inverse dynamics besides. Dense codes are
 * tallied by formula alone. */
static struct work least_work(const struct model *m, enum forward_method method, bool dense)
{
    enum { ROW = 415, ACCELERATIONS = 240, BIAS = 330 };
    const uint64_t n = (uint64_t)m->nu;
    struct work w = {0};
    const bool revolute = m->nloop == 0 && model_all_revolute(m);
    if (m->nloop == 0 && dense) dense_tally_forward(m, method, &w);
    /* Cholesky of the mass matrix (physics 2.3) is the part that grows fastest. */
    else if (m->nloop == 0 && method == FORWARD_CRBA) w.flop = n * (n + 1) * (2 * n + 1) / 6;
    else if (revolute && method == FORWARD_CFA_PAPER) w.flop = (n - 1) * (ROW + BIAS);
    else if (revolute && method == FORWARD_CFA_DIRECT) w.flop = (n - 1) * (ROW + ACCELERATIONS);
    return w;
}

/* Whether `method` takes more than the articulated-body algorithm's work `aba`, known from that
 * bound; false when it is not known, or aba is NULL. */
static bool never_fastest(const struct model *m, enum forward_method method, bool dense,
                          const struct work_price *price, const struct work *aba)
{
    const struct work least = least_work(m, method, dense);
    return method != FORWARD_ABA && aba &&
           price->price_ps(price->context, &least) > price->price_ps(price->context, aba);
}

/* The work of a method on a chain of `n` bodies that is made like `like`. */
static struct work work_of_chain(const struct scene *like, enum forward_method method, int n)
{
    struct run_spec spec = {.model = like->spec, .nrank = 1};
    struct err e;
    err_clear(&e);
    spec.model.nbody = n;
    struct scene *s = scene_create(&spec, like->keep, &e);
    CHECK(s != NULL); /* its bodies are the first ones of a chain that is there */
    s->state->at_rest = like->state->at_rest;
    const struct work w = scene_forward(s, method)->work;
    scene_destroy(s);
    return w;
}

/* Of a chain each body between the ends costs the same: two short ones tell the work of all. */
static struct work counted_work(const struct scene *scene, enum forward_method method)
{
    enum { SHORT = 4 };
    const struct work more = work_of_chain(scene, method, SHORT + 1);
    struct work w = work_of_chain(scene, method, SHORT);
    const uint64_t rest = (uint64_t)(scene->model->nbody - SHORT);
    w.flop += (more.flop - w.flop) * rest;
    w.div += (more.div - w.div) * rest;
    w.sqrt += (more.sqrt - w.sqrt) * rest;
    w.trig += (more.trig - w.trig) * rest;
    w.bytes += (more.bytes - w.bytes) * rest;
    w.call += (more.call - w.call) * rest;
    return w;
}

/* The serial codes of the same task in the same style: Newton-Euler, then each way to the
 * accelerations. */
static void add_serial(const struct kernel_job *job, const struct kernel_type *kernel,
                       const struct work_price *price, struct scene *scene, struct run_result *out)
{
    static const enum forward_method methods[] = {FORWARD_ABA, FORWARD_CRBA, FORWARD_CFA_PAPER,
                                                  FORWARD_CFA_DIRECT};
    const bool dense = job->spec->kernel.operators == OPERATORS_DENSE;
    struct work inverse = {0};
    if (kernel->does_inverse) {
        /* The serial inverse dynamics is part of the task, if the parallel run does it. */
        inverse = scene_inverse(scene)->work;
        if (dense) dense_tally_inverse(job->model, &inverse);
        program_baseline_add(out, price, "rnea", &inverse);
    }
    const bool keep = job->keep & KEEP_BASELINE;
    const bool choose = job->spec->record.baselines == BASELINES_NEEDED && !keep;
    struct work aba_work;
    const struct work *aba = NULL;
    int first = kernel->does_forward ? out->nbaseline : 0;
    for (int i = 0; kernel->does_forward && i < 4; i++) {
        /* Cubic work: never the fastest at this size, and very slow to find out. */
        if (methods[i] == FORWARD_CRBA && job->model->nu > OMISSION_CRBA_MOST && !keep) continue;
        if (choose && never_fastest(job->model, methods[i], dense, price, aba)) continue;
        struct work w;
        if (i > 0 && omission_counted(job)) {
            w = counted_work(scene, methods[i]);
        } else {
            const struct serial_answer *serial = scene_forward(scene, methods[i]);
            if (!serial->found) continue;
            w = serial->work;
        }
        if (dense) dense_tally_forward(job->model, methods[i], &w);
        /* ABA comes first: it is the bound for those that follow. */
        if (i == 0) aba_work = w, aba = &aba_work;
        repeat(&w, evaluations(&job->spec->kernel));
        work_add(&w, &inverse);
        char name[40];
        snprintf(name, sizeof name, "%s%s", kernel->does_inverse ? "rnea+" : "",
                 forward_method_name(methods[i]));
        program_baseline_add(out, price, name, &w);
    }
    program_fastest_add(out, first);
}

/* The same in three components, for programs that compute in these: nothing else would be a fair
 * match. Dense operators have no serial code of that kind. */
static void add_planar(const struct kernel_job *job, const struct kernel_type *kernel,
                       const struct work_price *price, struct scene *scene, struct run_result *out)
{
    struct work inverse = {0};
    if (job->spec->kernel.operators == OPERATORS_DENSE) return;
    const int first = out->nbaseline;
    if (kernel->does_inverse) {
        inverse = scene_planar_inverse(scene)->work;
        program_baseline_add(out, price, "rnea", &inverse);
    }
    if (kernel->does_forward && scene_planar_forward(scene)->found) {
        struct work w = scene_planar_forward(scene)->work;
        repeat(&w, evaluations(&job->spec->kernel));
        work_add(&w, &inverse);
        program_baseline_add(out, price, kernel->does_inverse ? "rnea+aba" : "aba", &w);
    }
    program_fastest_add(out, kernel->does_inverse && kernel->does_forward ? first + 1 : first);
}

static void add_parallel_work(const struct work_price *price, struct run_result *out)
{
    struct work all = {0};
    /* The parallel program's own work on one processor: the denominator of relative speedup. */
    for (int i = 0; i < out->nstage; i++) {
        const struct stage_row row = stage_row_make(out, i);
        work_add(&all, &row.all.work);
    }
    program_baseline_add(out, price, "parallel code on one processor", &all);
}

void references_baselines(const struct kernel_job *job, const struct kernel_type *kernel,
                          struct scene *scene, const struct work_price *price,
                          struct arena *scratch, struct run_result *out)
{
    struct arena_mark mark = arena_mark(scratch);
    add_parallel_work(price, out);
    if (kernel->planar) add_planar(job, kernel, price, scene, out);
    else add_serial(job, kernel, price, scene, out);
    arena_release(scratch, mark);
}
