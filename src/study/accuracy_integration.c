/* accuracy_integration.c - the integration ladder: which stepper, and on how many processors, in
 * the least time. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/progress.h"
#include "base/text.h"
#include "dynamics/dynamics_table.h"
#include "dynamics/trajectory.h"
#include "study/accuracy_ladder.h"
#include "study/trial.h"

static const char reference_name[] = "rk8pd 1e-13";
enum { MOST_EVALUATIONS = 30000, MOST_FIXED_STEPS = 8192, LEAST_FIXED_STEPS = 16 };

/* Where a motion ends, and what it keeps. */
struct ending {
    struct state *s;
    struct dynamics_totals totals;
    double drift; /* of the loops' positions */
};

/* What the rungs share while the ladder is climbed. */
struct climb {
    struct ladder *l;
    double duration;        /* [model's time] */
    struct ending begin, reference;
    double uncertainty;     /* of the reference's state */
    int64_t evaluation_ps;  /* least predicted time of one evaluation */
    int64_t
        implicit_ps; /* of one linearly implicit step on as many processors; -1: there is none */
    int processors;         /* and on how many */
};

/* Each rung moves its own copy: the scene's state is the beginning of all. */
static struct state *copy_of(const struct model *m, const struct state *s, struct arena *a)
{
    struct state *c = TAKE(a, 1, struct state);
    *c = *s;
    c->q = TAKE(a, m->nq, double);
    c->qd = TAKE(a, m->nu, double);
    memcpy(c->q, s->q, (size_t)m->nq * sizeof *c->q);
    memcpy(c->qd, s->qd, (size_t)m->nu * sizeof *c->qd);
    return c;
}

/* Energy, momentum and the drift of the loops at the end. Double precision is enough: these
 * errors are of the stepper, many orders above rounding. */
static void ending_measure(struct ending *x, const struct model *m, struct arena *a)
{
    const struct dynamics_type *t = dynamics_type_of(PRECISION_DOUBLE);
    double velocity;
    t->totals(m, x->s, a, &x->totals);
    t->drift(m, x->s, a, &x->drift, &velocity);
}

/* Time in which the fastest joint turns by about 2 rad, at its present rate or, from rest, under
 * its present acceleration (a t^2 / 2): long enough to show the stepper's error, and so short
 * that it is not the chaos of the motion that is measured. */
static double duration_of(struct ladder *l)
{
    const struct model *m = l->model;
    double *qdd = TAKE(l->arena, m->nu, double), rate = 0, force = 0;
    struct work w = {0};
    /* If the dynamics break down here, the rates alone decide; the reference will fail and say
     * why. */
    bool good = dynamics_type_of(PRECISION_DOUBLE)
                    ->forward(m, l->state, FORWARD_ABA, l->arena, qdd, NULL, NULL, &w);
    for (int i = 0; i < m->nu; i++) {
        rate = fmax(rate, fabs(l->state->qd[i]));
        if (good) force = fmax(force, fabs(qdd[i]));
    }
    /* From a t^2 / 2 = 2 follows t = 2 / sqrt(a): both rates have the unit 1 / time. */
    double fastest = fmax(rate, sqrt(force));
    return fastest > 0 ? 2 / fastest : 1;
}

/* The parallel forward kernel's time on 1, 2, 4, ... processors; the least of them. Every rung's
 * predicted time is its number of evaluations times the time of one. One per processor count is
 * enough for all of them. */
static void fastest_evaluation(struct climb *c)
{
    struct ladder *l = c->l;
    struct run_spec spec = l->spec;
    spec.kernel.steps = 0;
    spec.kernel.precision = PRECISION_DOUBLE;
    text_copy(spec.kernel.name, sizeof spec.kernel.name, "forward");
    spec.record = (struct record_spec){0};
    int most = (int)fmin(l->model->nbody, (double)machine_spec_processors(&spec.machine));
    c->evaluation_ps = -1;
    /* Powers of two, and the largest number of processors that has a body for each. */
    for (int P = 1; P <= most; P = P < most && 2 * P > most ? most : 2 * P) {
        spec.nrank = P;
        struct arena_mark mark = arena_mark(l->arena);
        struct trial t = trial_run(&spec, l->model, l->state, l->arena);
        /* Of equal times the fewer processors. */
        bool better = t.answered && (c->evaluation_ps < 0 || t.makespan_ps < c->evaluation_ps);
        if (better) c->evaluation_ps = t.makespan_ps, c->processors = P;
        arena_release(l->arena, mark);
    }
}

/* One implicit step: two less one, so that what comes once is not in it. */
static void implicit_evaluation(struct climb *c)
{
    /* The step size cancels in the difference; it only has to be small enough for the step to
     * succeed. */
    struct ladder *l = c->l;
    struct run_spec spec = l->spec;
    int64_t ps[2] = {-1, -1};
    spec.kernel.precision = PRECISION_DOUBLE;
    spec.kernel.formulation = FORMULATION_DIRECT;
    spec.kernel.step = STEP_LINEARLY_IMPLICIT;
    spec.kernel.step_size = c->duration * l->model->second / MOST_FIXED_STEPS;
    text_copy(spec.kernel.name, sizeof spec.kernel.name, "forward");
    spec.record = (struct record_spec){0};
    spec.nrank = c->processors;
    /* k = 0: one step, k = 1: two; without a number of processors the forward kernel has failed
     * already. */
    for (int k = 0; k < 2 && c->processors > 0; k++) {
        struct arena_mark mark = arena_mark(l->arena);
        spec.kernel.steps = k + 1;
        struct trial t = trial_run(&spec, l->model, l->state, l->arena);
        if (t.answered) ps[k] = t.makespan_ps;
        arena_release(l->arena, mark);
    }
    c->implicit_ps = ps[0] >= 0 && ps[1] >= 0 ? ps[1] - ps[0] : -1;
}

/* Relative error of the state: the larger one of coordinates and of velocities, as they have
 * different units. */
static double state_error(const struct climb *c, const struct state *x)
{
    const struct model *m = c->l->model;
    const struct state *r = c->reference.s, *b = c->begin.s;
    return fmax(trial_change_error(x->q, r->q, b->q, m->nq),
                trial_change_error(x->qd, r->qd, b->qd, m->nu));
}

/* Relative error of the total energy, which the reference keeps. The scale is the energy that
 * moves: the largest of the kinetic energies and of the potential energy exchanged. The
 * potential energy itself has an arbitrary zero. */
static double energy_error(const struct climb *c, const struct ending *x)
{
    const struct dynamics_totals *t = &x->totals, *r = &c->reference.totals, *b = &c->begin.totals;
    double scale = fmax(fmax(r->kinetic, b->kinetic), fabs(r->potential - b->potential));
    return scale > 0 ? fabs(t->kinetic + t->potential - r->kinetic - r->potential) / scale : 0;
}

/* Relative error of momentum, linear or angular about the origin, the larger one. Where gravity
 * or a fixed base acts, momentum changes, but in the reference, too. */
static double momentum_error(const struct climb *c, const struct ending *x)
{
    const struct dynamics_totals *r = &c->reference.totals, *b = &c->begin.totals;
    return fmax(trial_change_error(x->totals.linear, r->linear, b->linear, 3),
                trial_change_error(x->totals.angular, r->angular, b->angular, 3));
}

/* The rows of one rung: state first, then what should be kept. */
static void add_rows(struct climb *c, const char *method, const char *rung, struct ending *x,
                     long evaluations, double host_s, const char *why)
{
    static const char *const quantity[] = {"state", "energy", "momentum", "loop position"};
    const struct model *m = c->l->model;
    /* Only a rung that reached the end has something to measure. */
    if (x) ending_measure(x, m, c->l->arena);
    for (int k = 0; k < (m->nloop > 0 ? 4 : 3); k++) {
        struct accuracy_rung *r =
            ladder_add(c->l, method, rung, quantity[k], k == 3 ? "closed loops" : reference_name);
        /* The cost of integrating is the evaluations of the dynamics; adding vectors is left
         * out. */
        if (c->evaluation_ps >= 0) r->machine_ps = c->evaluation_ps * evaluations;
        r->host_s = host_s;
        if (!x) {
            text_copy(r->text, sizeof r->text, why);
            continue;
        }
        double error = k == 0 ? state_error(c, x->s) : k == 1 ? energy_error(c, x)
                     : k == 2 ? momentum_error(c, x) : x->drift;
        /* A relative error of a tenth is still a motion of the same kind; above 1 it is another
         * motion. */
        ladder_grade(r, error, 0.1, 1);
        snprintf(r->text, sizeof r->text, "%ld evaluations, P = %d%s", evaluations, c->processors,
                 k == 0 && error < c->uncertainty ? "; below the reference's own uncertainty" : "");
    }
}

/* One library stepper: adaptive to `tolerance`, or (fixed > 0) in so many equal steps. */
static void library_rung(struct climb *c, const char *stepper, double tolerance, long fixed)
{
    struct ladder *l = c->l;
    struct arena_mark mark = arena_mark(l->arena);
    struct ending x = {.s = copy_of(l->model, l->state, l->arena)};
    const struct trajectory_options o = {.stepper = stepper,
                                         .tolerance = tolerance,
                                         .fixed_steps = fixed,
                                         .most_evaluations = MOST_EVALUATIONS};
    struct trajectory_report report = {0};
    /* trajectory_advance says why it failed in e.text; a failed rung is a row, not an error. */
    struct err e;
    err_clear(&e);
    char method[32], rung[32];
    snprintf(method, sizeof method, "%s%s", stepper, fixed > 0 ? " fixed" : "");
    if (fixed > 0) snprintf(rung, sizeof rung, "%ld steps", fixed);
    else snprintf(rung, sizeof rung, "tolerance %.0e", tolerance);
    /* The host's time includes the Jacobians of implicit steppers, and so do report.evaluations. */
    double begin = host_seconds();
    bool good = trajectory_advance(l->model, x.s, c->duration, &o, l->arena, &report, &e);
    add_rows(c, method, rung, good ? &x : NULL, report.evaluations, host_seconds() - begin, e.text);
    arena_release(l->arena, mark);
}

/* One of the program's own steppers, in `steps` equal steps. */
static void own_rung(struct climb *c, enum step_rule rule, int steps)
{
    static const char *const name[] = {"own semi-implicit", "own kdk", "own rk4", "own implicit"};
    static const int evaluations[] = {1, 1, 4, 1};
    struct ladder *l = c->l;
    struct arena_mark mark = arena_mark(l->arena);
    struct ending x = {.s = copy_of(l->model, l->state, l->arena)};
    struct work w = {0};
    char rung[32];
    snprintf(rung, sizeof rung, "%d steps", steps);
    double begin = host_seconds();
    bool good = dynamics_type_of(PRECISION_DOUBLE)
                    ->advance(l->model, x.s, rule, c->duration / steps, steps, l->arena, &w);
    /* Evaluations of the dynamics per step; kick-drift-kick needs one more for its first half
     * kick. */
    long count = (long)steps * evaluations[rule] + (rule == STEP_KDK);
    /* A linearly implicit step solves another system than an evaluation: it has a time of its
     * own, put in the place of evaluation_ps for these rows. */
    const int64_t explicit_ps = c->evaluation_ps;
    if (rule == STEP_LINEARLY_IMPLICIT) c->evaluation_ps = c->implicit_ps;
    const bool refused = rule == STEP_LINEARLY_IMPLICIT && l->model->nloop > 0;
    add_rows(c, name[rule], rung, good ? &x : NULL, count, host_seconds() - begin,
             refused ? "closed chains have no linearly implicit step" : "the dynamics broke down");
    c->evaluation_ps = explicit_ps;
    arena_release(l->arena, mark);
}

/* The end by two independent tight ways; their difference is what the reference may be wrong by. */
static bool reference_find(struct climb *c)
{
    struct ladder *l = c->l;
    /* Two different formulas, one of order 8 and one of order 5: they share no systematic error. */
    const struct trajectory_options tight = {.stepper = "rk8pd", .tolerance = 1e-13},
                                    other = {.stepper = "rkck", .tolerance = 1e-12};
    struct ending second = {.s = copy_of(l->model, l->state, l->arena)};
    struct err e;
    err_clear(&e);
    c->begin.s = l->state;
    c->reference.s = copy_of(l->model, l->state, l->arena);
    ending_measure(&c->begin, l->model, l->arena);
    bool good =
        trajectory_advance(l->model, c->reference.s, c->duration, &tight, l->arena, NULL, &e);
    if (good) {
        ending_measure(&c->reference, l->model, l->arena);
        good = trajectory_advance(l->model, second.s, c->duration, &other, l->arena, NULL, &e);
        /* Where the second way fails, the first is the reference without a bound of its error:
         * `error < NAN` is never true, so no row is marked. */
        c->uncertainty = good ? state_error(c, second.s) : NAN;
        return true;
    }
    struct accuracy_rung *r = ladder_add(l, "reference", "tight", "state", reference_name);
    text_copy(r->text, sizeof r->text, e.text);
    return false;
}

/* Fixed steps of implicit methods are few: each takes a Jacobian of 2 (n_q + n_u) evaluations.
 * Multistep methods choose step and order together: they have no fixed steps. */
static void library_rungs(struct climb *c, const char *stepper)
{
    /* Decades in steps of 100 show the order of a method as a slope. */
    static const double tolerance[] = {1e-3, 1e-5, 1e-7, 1e-9, 1e-11};
    const bool implicit = strstr(stepper, "imp") || strcmp(stepper, "msbdf") == 0;
    for (int k = 0; k < 5; k++) library_rung(c, stepper, tolerance[k], 0);
    if (strncmp(stepper, "ms", 2) == 0) return;
    for (long steps = implicit ? 8 : 16; steps <= (implicit ? 128 : 1024);
         steps *= implicit ? 4 : 8)
        library_rung(c, stepper, 1e-12, steps);
}

/* The reference, the price of an evaluation, then all steppers; each adds its rows. */
void ladder_integration(struct ladder *l)
{
    struct climb c = {.l = l, .duration = duration_of(l)};
    if (!reference_find(&c)) return;
    fastest_evaluation(&c);
    implicit_evaluation(&c);
    for (const char *const *s = trajectory_steppers(); *s; s++)
        library_rungs(&c, *s);
    for (int rule = STEP_SEMI_IMPLICIT; rule <= STEP_LINEARLY_IMPLICIT; rule++)
        /* Four evaluations a step: RK4 stops at a quarter of the steps, for the same largest
         * cost. */
        for (int steps = LEAST_FIXED_STEPS; steps <= MOST_FIXED_STEPS / (rule == STEP_RK4 ? 4 : 1);
             steps *= 4)
            own_rung(&c, (enum step_rule)rule, steps);
}
