/* stability_motion.c - steppers: largest stable step and cost of each on stiff scenes; energy
 * kept by all others.
 *
 * On a stiff scene an explicit stepper is limited by stability, not by accuracy: 2 / omega for a
 * frequency omega, about 2.8 / omega for RK4. The suite measures this limit and what reaching 1
 * % costs, so that explicit and implicit steppers can be compared in evaluations and in
 * simulated time. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "dynamics/dynamics_table.h"
#include "dynamics/trajectory.h"
#include "study/stability_scene.h"
#include "study/trial.h"

/* Steps of one test for stability; evaluations that a stepper may take; steps of a short motion;
 * bodies of the largest scene that is moved; evaluations spent on reaching an error of 1 %. */
enum {
    STEPS = 400,
    MOST_EVALUATIONS = 300000,
    SHORT_STEPS = 32,
    MOST_MOVED = 8192,
    MOST_OWN = 40000
};

/* Steps [model's time] longer than this are not tried. */
#define LONGEST 10.0

/* A stepper moves a copy: the scene's state is the beginning of all. */
static struct state copy_of(const struct model *m, const struct state *s, struct arena *a)
{
    struct state c = *s;
    c.q = TAKE(a, m->nq, double);
    c.qd = TAKE(a, m->nu, double);
    memcpy(c.q, s->q, (size_t)m->nq * sizeof *c.q);
    memcpy(c.qd, s->qd, (size_t)m->nu * sizeof *c.qd);
    return c;
}

/* Total energy in double precision, in the model's units. */
static double energy_of(const struct model *m, const struct state *s, struct arena *a)
{
    struct dynamics_totals t;
    dynamics_type_of(PRECISION_DOUBLE)->totals(m, s, a, &t);
    return t.kinetic + t.potential;
}

/* Whether `steps` steps of h stay within bounds. Springs and inertia keep energy; an unstable
 * step makes it grow without limit, far beyond the room for what gravity and motors add. */
static bool is_stable(const struct model *m, const struct state *s, enum step_rule rule, double h,
                      struct arena *a)
{
    struct arena_mark mark = arena_mark(a);
    struct state x = copy_of(m, s, a);
    struct work w = {0};
    /* Room for the work of gravity and motors: 100 units or three times the energy. */
    double before = energy_of(m, s, a), room = 100 + 3 * fabs(before);
    bool good = dynamics_type_of(PRECISION_DOUBLE)->advance(m, &x, rule, h, STEPS, a, &w);
    double after = good ? energy_of(m, &x, a) : NAN;
    arena_release(a, mark);
    return isfinite(after) && after < before + room;
}

/* The largest stable step, by bisection of its logarithm to 2 %. 0: none of 1e-12 .. LONGEST.
 * That stability ends once and for all at one step size is assumed. */
static double largest_step(const struct model *m, const struct state *s, enum step_rule rule,
                           struct arena *a)
{
    /* Invariant: low is stable, high is not. */
    double low = 1e-12, high = LONGEST;
    if (!is_stable(m, s, rule, low, a)) return 0;
    if (is_stable(m, s, rule, high, a)) return high;
    while (high / low > 1.02) {
        double h = sqrt(low * high);
        if (is_stable(m, s, rule, h, a)) low = h;
        else high = h;
    }
    return low;
}

/* Simulated seconds of `steps` time steps of the parallel kernel, a body per processor; steps =
 * 0: of one evaluation. NaN: the kernel cannot run it. */
static double machine_time(const struct model *m, const struct state *s, enum step_rule rule,
                           int steps, double h, struct arena *a)
{
    struct arena_mark mark = arena_mark(a);
    struct run_spec spec = {.machine = trial_machine(m->nbody), .nrank = m->nbody};
    spec.kernel = (struct kernel_spec){.name = "forward",
                                       .formulation = FORMULATION_DIRECT,
                                       .solver = SOLVER_CR,
                                       .algebra = ALGEBRA_SPATIAL,
                                       .composites_incoming = true,
                                       .steps = steps,
                                       .step = rule,
                                       .step_size = h * m->second};
    struct trial t = trial_run(&spec, m, s, a);
    arena_release(a, mark);
    return t.answered ? (double)t.makespan_ps * 1e-12 : NAN;
}

/* The larger error of coordinates and of rates. */
static double motion_error(const struct model *m, const struct state *begin,
                           const struct state *end, const struct state *reference)
{
    return fmax(trial_change_error(end->q, reference->q, begin->q, m->nq),
                trial_change_error(end->qd, reference->qd, begin->qd, m->nu));
}

/* Error of `steps` steps; their end in *end. INFINITY: broke down. */
static double error_of(const struct model *m, const struct state *s, enum step_rule rule,
                       double duration, double steps, const struct state *reference,
                       struct state *end, struct arena *a)
{
    struct work w = {0};
    *end = copy_of(m, s, a);
    bool good = dynamics_type_of(PRECISION_DOUBLE)
                    ->advance(m, end, rule, duration / steps, (int)steps, a, &w);
    if (!good) return INFINITY;
    return motion_error(m, s, end, reference);
}

/* One of the program's own steppers: its largest stable step, then how many steps, from half of
 * that on, an error of 1 % takes. */
static void own_row(struct stability_report *r, const char *subject, const struct model *m,
                    const struct state *s, enum step_rule rule, double duration,
                    const struct state *reference, struct arena *a)
{
    static const char *const name[] = {"own semi-implicit", "own kdk", "own rk4", "own implicit"};
    struct stability_row *x = row_add(r, subject, name[rule], "double");
    x->step_s = largest_step(m, s, rule, a);
    if (x->step_s == 0) {
        text_copy(x->reason, sizeof x->reason, "no step is stable");
        return;
    }
    const int each = rule == STEP_RK4 ? 4 : 1;
    double steps = ceil(2 * duration / x->step_s), error = INFINITY;
    /* A stiff scene makes explicit steppers hopeless: the number of evaluations says so without
     * a run. */
    if (steps * each > MOST_EVALUATIONS) {
        snprintf(x->reason, sizeof x->reason, "%.1e evaluations at half that step: not run",
                 steps * each);
        x->status = STABILITY_DEGRADED;
        return;
    }
    struct state end = {0};
    /* Double the steps until the error is small or the next doubling is too long. */
    for (;; steps *= 2) {
        error = error_of(m, s, rule, duration, steps, reference, &end, a);
        if (error <= 0.01 || 2 * steps * each > MOST_OWN) break;
    }
    row_grade(x, error, false);
    x->status = error <= 0.01     ? STABILITY_OK
                : isfinite(error) ? STABILITY_DEGRADED
                                  : STABILITY_FAILED;
    double E = energy_of(m, reference, a), h = duration / steps;
    /* A reference at rest at energy 0 would divide by zero. */
    if (isfinite(error)) x->energy_drift = fabs(energy_of(m, &end, a) - E) / fmax(fabs(E), 1e-300);
    /* One step is the difference of two runs: what happens once cancels. */
    double each_s = machine_time(m, s, rule, 2, h, a) - machine_time(m, s, rule, 1, h, a);
    snprintf(x->reason, sizeof x->reason, "%.0f evaluations, %.3g s on the machine%s%s",
             steps * each, steps * each_s, error <= 0.01 ? "" : "; 1% needs more",
             x->step_s >= LONGEST ? "; longer steps not tried" : "");
}

/* A library's stepper with step control: here the tolerance is given, and the step is found.
 * Limits are wider, since 1e-6 per step adds up. */
static void library_row(struct stability_report *r, const char *subject, const struct model *m,
                        const struct state *s, const char *stepper, double duration,
                        const struct state *reference, struct arena *a)
{
    const struct trajectory_options o = {
        .stepper = stepper, .tolerance = 1e-6, .most_evaluations = MOST_EVALUATIONS};
    struct stability_row *x = row_add(r, subject, stepper, "double");
    struct trajectory_report t = {0};
    struct state end = copy_of(m, s, a);
    struct err e;
    err_clear(&e);
    if (!trajectory_advance(m, &end, duration, &o, a, &t, &e)) {
        text_copy(x->reason, sizeof x->reason, e.text);
        return;
    }
    double error = motion_error(m, s, &end, reference);
    /* Graded by hand: row_grade's limits are for single evaluations. */
    x->error = isfinite(error) ? error : NAN;
    x->status = error <= 1e-3 ? STABILITY_OK : error <= 0.1 ? STABILITY_DEGRADED : STABILITY_FAILED;
    x->step_s = t.steps > 0 ? duration / (double)t.steps : NAN;
    double E = energy_of(m, reference, a);
    x->energy_drift = fabs(energy_of(m, &end, a) - E) / fmax(fabs(E), 1e-300);
    snprintf(x->reason, sizeof x->reason,
             "%ld evaluations at tolerance 1e-6, %.3g s on the machine", t.evaluations,
             (double)t.evaluations * machine_time(m, s, STEP_SEMI_IMPLICIT, 0, 0, a));
}

/* The reference for undamped springs is explicit and of high order, for damped ones implicit: an
 * explicit one could not reach the end. */
void stability_motion(struct stability_report *r, const char *subject, const struct model *m,
                      const struct state *s, bool damped, struct arena *scratch)
{
    static const char *const stepper[] = {"rkf45",  "rk8pd", "msadams", "rk2imp",
                                          "rk4imp", "bsimp", "msbdf"};
    double fast = largest_step(m, s, STEP_RK4, scratch);
    if (m->nu > 40 || fast == 0)
        return; /* implicit steppers' dense Jacobians are for small systems */
    /* Undamped: some twenty of the fastest oscillations. Damped: until the slow motion has been
     * seen too. */
    double duration = damped ? fmin(0.05 / m->second, 1e6 * fast) : 50 * fast;
    struct trajectory_options tight = {.stepper = damped ? "bsimp" : "rk8pd", .tolerance = 1e-12};
    struct state reference = copy_of(m, s, scratch);
    struct err e;
    err_clear(&e);
    if (!trajectory_advance(m, &reference, duration, &tight, scratch, NULL, &e)) {
        text_copy(row_add(r, subject, tight.stepper, "double")->reason, 120, e.text);
        return;
    }
    for (int rule = STEP_SEMI_IMPLICIT; rule <= STEP_LINEARLY_IMPLICIT; rule++)
        own_row(r, subject, m, s, (enum step_rule)rule, duration, &reference, scratch);
    for (size_t k = 0; k < sizeof stepper / sizeof *stepper; k++)
        library_row(r, subject, m, s, stepper[k], duration, &reference, scratch);
}

/* --- energy of scenes that are not stiff ------------------------------------------------------ */

/* The time in which the fastest joint turns by about a third of a radian, at its rate or from
 * rest under its acceleration. 0: no acceleration can be computed. */
static double short_time(const struct model *m, const struct state *s, struct arena *a)
{
    double *qdd = TAKE(a, m->nu + 1, double), rate = 0, force = 0;
    struct work w = {0};
    if (!dynamics_type_of(PRECISION_DOUBLE)->forward(m, s, FORWARD_ABA, a, qdd, NULL, NULL, &w))
        return 0;
    for (int i = 0; i < m->nu; i++)
        rate = fmax(rate, fabs(s->qd[i])), force = fmax(force, fabs(qdd[i]));
    double fastest = fmax(rate, sqrt(force));
    return isfinite(fastest) ? fastest > 0 ? 0.3 / fastest : 1 : 0;
}

/* Error and energy of one motion. Without motors and dampers energy is kept: its change is an
 * error, relative to the energy that moves. */
static void judge_motion(struct stability_row *x, const struct model *m, const struct state *begin,
                         const struct state *end, const struct state *reference, struct arena *a)
{
    struct dynamics_totals t[2];
    dynamics_type_of(PRECISION_DOUBLE)->totals(m, begin, a, &t[0]);
    dynamics_type_of(PRECISION_DOUBLE)->totals(m, end, a, &t[1]);
    double scale = fmax(fmax(t[0].kinetic, t[1].kinetic), fabs(t[1].potential - t[0].potential));
    double change = t[1].kinetic - t[0].kinetic + (t[1].potential - t[0].potential);
    x->energy_drift = scale > 0 ? fabs(change) / scale : fabs(change);
    double error = motion_error(m, begin, end, reference);
    row_grade(x, error, false);
    /* Right at the end but with energy lost on the way: not ok. */
    if (x->status == STABILITY_OK && !(x->energy_drift <= 1e-6)) x->status = STABILITY_DEGRADED;
}

/* The end of a motion by a tight stepper. Where the scene moves too fast to be followed within
 * the evaluations allowed, *duration is divided by ten, at most three times. Returns false, with
 * *e set unless the duration was 0. */
static bool follow(const struct model *m, const struct state *begin, double *duration,
                   struct state *end, struct arena *a, struct err *e)
{
    /* Evaluations allowed: fewer for large scenes, so that each takes about the same time. */
    const double most = fmin(fmax(1e6 / m->nbody, 300), 4000);
    const struct trajectory_options tight = {
        .stepper = "rkck", .tolerance = 1e-12, .most_evaluations = (long)most};
    for (int k = 0; k < 4 && *duration > 0; k++, *duration /= 10) {
        *end = copy_of(m, begin, a);
        err_clear(e);
        if (trajectory_advance(m, end, *duration, &tight, a, NULL, e)) return true;
    }
    return false;
}

/* Two rows: fixed steps of RK4 and a tight library stepper, both with the motors off and without
 * external forces, so that energy must be kept. */
void stability_energy(struct stability_report *r, const char *subject, const struct model *m,
                      const struct state *s, struct arena *scratch)
{
    const struct trajectory_options usual = {.stepper = "rk8pd", .tolerance = 1e-10};
    struct state begin = copy_of(m, s, scratch), reference = {0}, end;
    struct err e;
    err_clear(&e);
    /* zeros: the motors are off */
    begin.tau = TAKE(scratch, m->nu + 1, double);
    begin.fext = NULL;
    struct stability_row *x = row_add(r, subject, "motion rk4", "double");
    /* An evaluation of such a scene takes seconds: a motion takes hundreds. */
    if (m->nbody > MOST_MOVED) {
        snprintf(x->reason, sizeof x->reason,
                 "no motion: an evaluation of %d bodies takes too long", m->nbody);
        x->status = STABILITY_DEGRADED;
        return;
    }
    double duration = short_time(m, &begin, scratch);
    if (!follow(m, &begin, &duration, &reference, scratch, &e)) {
        text_copy(x->reason, sizeof x->reason, duration > 0 ? e.text : "articulated bodies broke "
                                                                       "down");
        return;
    }
    struct work w = {0};
    end = copy_of(m, &begin, scratch);
    x->step_s = duration / SHORT_STEPS;
    if (dynamics_type_of(PRECISION_DOUBLE)
            ->advance(m, &end, STEP_RK4, x->step_s, SHORT_STEPS, scratch, &w))
        judge_motion(x, m, &begin, &end, &reference, scratch);
    x = row_add(r, subject, "motion rk8pd", "double");
    end = copy_of(m, &begin, scratch);
    struct trajectory_report t = {0};
    if (trajectory_advance(m, &end, duration, &usual, scratch, &t, &e)) {
        x->step_s = t.steps > 0 ? duration / (double)t.steps : NAN;
        judge_motion(x, m, &begin, &end, &reference, scratch);
    } else {
        text_copy(x->reason, sizeof x->reason, e.text);
    }
}
