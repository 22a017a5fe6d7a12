/* verify_trajectory.c - rows of the integrators: the reference's states at its times, each by an
 * independent stepper.
 *
 * Energies and momenta are computed from the reference's own states, and held against what the file
 * says of them. An error made early grows with the motion's own sensitivity: the tolerance of an
 * instant is the stepper's, or its local errors grown until then. A row shows the instant that
 * comes closest to its tolerance or exceeds it most. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "dynamics/trajectory.h"
#include "model/vector_model.h"
#include "study/verify_rows.h"

/* A stepper with the error per step that it is given, the error at the end that it then holds for
 * tame motions, and how many local errors add up before they grow. */
static const struct {
    const char *name;
    double local, global, slack;
} stepper_table[] = {{"rk8pd", 1e-13, 1e-8, 10},     {"rkck", 1e-12, 1e-7, 100},
                     {"msadams", 1e-12, 1e-6, 1000}, {"bsimp", 1e-12, 1e-7, 100},
                     {"rk4imp", 1e-9, 1e-4, 1000},   {"msbdf", 1e-9, 1e-3, 10000}};
enum { STEPPERS = sizeof stepper_table / sizeof *stepper_table };

struct worst {
    double error, tolerance;
};

/* Keep the pair whose error is the larger part of its tolerance. */
static void worst_take(struct worst *w, double error, double tolerance)
{
    if (error / tolerance >= w->error / w->tolerance || w->tolerance == 0)
        *w = (struct worst){error, tolerance};
}

/* Where a tolerance grows beyond this with the motion's sensitivity, as the file tells it, nothing
 * is compared. */
static const double hopeless = 1e-3;

/* The tolerance at an instant: asked for, or the stepper's local errors grown by the
 * sensitivity. */
static double tolerance_at(const struct verify_case *v, int instant, int stepper)
{
    /* The user's tolerance replaces the stepper's own. */
    double asked = v->options->tolerance_forward > 0 ? v->options->tolerance_forward
                                                     : stepper_table[stepper].global;
    double grown = stepper_table[stepper].slack * stepper_table[stepper].local *
                   v->vector->instant[instant].sensitivity;
    return isfinite(grown) ? fmax(asked, grown) : asked;
}

/* The largest error of n numbers that form one vector, over its largest component in the whole
 * motion: a joint that passes through zero keeps its scale. */
static double motion_error(const struct vector_case *c, const double *x, int instant, bool rates,
                           int at, int n)
{
    double difference = 0, scale = 0;
    for (int k = 0; k < n; k++) {
        const struct vector_instant *t = &c->instant[instant];
        if (!isfinite(x[at + k])) return INFINITY;
        difference = fmax(difference, fabs(x[at + k] - (rates ? t->qd : t->q)[at + k]));
        for (int i = 0; i < c->ninstant; i++)
            scale = fmax(scale, fabs((rates ? c->instant[i].qd : c->instant[i].q)[at + k]));
    }
    return scale > 0 ? difference / scale : difference > 0 ? INFINITY : 0;
}

/* Joint by joint; linear and angular parts by themselves, as their units differ. A floating base
 * has seven coordinates, three of them linear. */
static double state_error(const struct vector_case *c, int instant, const struct state *s)
{
    double worst = 0;
    for (int i = 0; i < c->nbody; i++) {
        const struct vector_body *b = &c->body[i];
        int nq = vector_joint_nq(b->joint), nv = vector_joint_nv(b->joint),
            linear = nq == 7 ? 3 : 0;
        worst = fmax(worst, motion_error(c, s->q, instant, false, b->q, linear));
        worst = fmax(worst, motion_error(c, s->q, instant, false, b->q + linear, nq - linear));
        worst = fmax(worst, motion_error(c, s->qd, instant, true, b->v, linear));
        worst = fmax(worst, motion_error(c, s->qd, instant, true, b->v + linear, nv - linear));
    }
    return worst;
}

/* A row of a pair of error and tolerance. */
static void row_fill(struct verify_case *v, const char *name, const char *quantity,
                     const struct worst *w)
{
    struct verify_row *row = verify_row_add(v, name, quantity);
    row->error = row->plain = w->error;
    row->tolerance = w->tolerance;
    row->verdict = w->error <= w->tolerance ? VERIFY_PASS : VERIFY_FAIL;
}

/* Evaluations that one interval between instants may take, for all files about the same time: a
 * stiff motion needs ever more of an explicit stepper, and is left to the others. */
static long evaluations_allowed(const struct vector_case *c)
{
    return 24000000L / c->nbody / c->ninstant;
}

/* The reference's states by one stepper; a row only where it got to the end. */
static bool stepper_row(struct verify_case *v, int k)
{
    const struct vector_case *c = v->vector;
    struct trajectory_options o = {.stepper = stepper_table[k].name,
                                   .tolerance = stepper_table[k].local,
                                   .most_evaluations = evaluations_allowed(c)};
    struct state *s = state_take(v->model, v->arena);
    struct worst worst = {0, 0};
    struct err e;
    char why[96];
    memcpy(s->q, c->q, (size_t)c->nq * sizeof *c->q);
    memcpy(s->qd, c->qd, (size_t)c->nv * sizeof *c->qd);
    err_clear(&e);
    /* From instant to instant, without going back to the reference's states: errors accumulate
     * as they would in a simulation. */
    for (int i = 0; i < c->ninstant; i++) {
        double tolerance = tolerance_at(v, i, k),
               duration = c->instant[i].time - (i > 0 ? c->instant[i - 1].time : 0);
        if (duration > 0 && !trajectory_advance(v->model, s, duration, &o, v->arena, NULL, &e)) {
            snprintf(why, sizeof why, "gave up before t = %g: too stiff for it",
                     c->instant[i].time);
            verify_row_skip(v, stepper_table[k].name, "states", why);
            return false;
        }
        double error = state_error(c, i, s);
        /* Past this instant every stepper is off: the motion is chaotic on this time scale. */
        if (tolerance > hopeless) {
            snprintf(why, sizeof why, "the motion is too sensitive for it (error %.1e)", error);
            verify_row_skip(v, stepper_table[k].name, "states", why);
            return false;
        }
        worst_take(&worst, error, tolerance);
    }
    row_fill(v, stepper_table[k].name, "states", &worst);
    return true;
}

/* --- totals at the reference's own states ----------------------------------------------------- */

/* The case that an instant of the motion is: its state, energy and momentum. */
static struct vector_case case_at(const struct vector_case *c, const struct vector_instant *t)
{
    struct vector_case x = *c;
    x.q = t->q;
    x.qd = t->qd;
    x.kinetic = t->energy[0];
    x.potential = t->energy[1];
    x.has_energy = x.has_momentum = true;
    memcpy(x.linear, t->linear, sizeof x.linear);
    memcpy(x.angular, t->angular, sizeof x.angular);
    return x;
}

/* The worst instant of each total. Each instant is a case of its own, with scales of its own. */
static bool totals_rows(struct verify_case *v, struct err *e)
{
    const struct vector_case *c = v->vector;
    struct verify_row worst[VERIFY_QUANTITIES] = {{.error = 0}};
    const double tolerance = verify_tolerance_inverse(v->options);
    for (int i = 0; i < c->ninstant; i++) {
        struct arena_mark mark = arena_mark(v->arena);
        const struct vector_case at = case_at(c, &c->instant[i]);
        struct verify_case x = *v;
        x.vector = &at;
        x.state = vector_state(&at, v->model, v->arena);
        if (!verify_answers_make(&x.answers, &at, v->model, x.state, v->arena, e)) return false;
        double *y = TAKE(v->arena, x.answers.n + 1, double);
        verify_answers_compute(&x.answers, &at, v->model, x.state, v->options->precision, v->arena,
                               y);
        for (int k = VERIFY_KINETIC; k <= VERIFY_ANGULAR; k++) {
            struct verify_row row = {.error = 0};
            verify_row_judge(&x, &row, (enum verify_quantity)k, y + x.answers.at[k], tolerance);
            /* A row that tells something replaces one that does not. */
            bool told = row.verdict != VERIFY_NOT_APPLICABLE, first = worst[k].tolerance == 0;
            if (first ||
                (told && (row.error > worst[k].error || worst[k].verdict == VERIFY_NOT_APPLICABLE)))
                worst[k] = row;
        }
        arena_release(v->arena, mark);
    }
    for (int k = VERIFY_KINETIC; k <= VERIFY_ANGULAR; k++) {
        struct verify_row *row =
            verify_row_add(v, "totals", verify_quantity_name((enum verify_quantity)k));
        memcpy(worst[k].algorithm, row->algorithm, sizeof row->algorithm);
        memcpy(worst[k].quantity, row->quantity, sizeof row->quantity);
        *row = worst[k];
    }
    return true;
}

/* --- what the file says twice ----------------------------------------------------------------- */

/* The file says it twice: both must be equal but for rounding when it was written. */
static void twice_take(struct worst *w, double x, double again, double scale)
{
    /* decimal numbers read into double: two or three roundings */
    const double few_roundings = 1e-15;
    worst_take(w, x == again ? 0 : scale > 0 ? fabs(x - again) / scale : INFINITY, few_roundings);
}

/* The sum of the energies, and the states written with 45 digits. */
static void twice_rows(struct verify_case *v)
{
    const struct vector_case *c = v->vector;
    struct worst sum = {0, 0}, digits = {0, 0};
    for (int i = 0; i < c->ninstant; i++) {
        const struct vector_instant *t = &c->instant[i];
        twice_take(&sum, t->energy[2], t->energy[0] + t->energy[1],
                   fmax(fabs(t->energy[0]), fabs(t->energy[1])));
        for (int k = 0; t->digits && k < c->nq + c->nv; k++)
            twice_take(&digits, k < c->nq ? t->q[k] : t->qd[k - c->nq], t->digits[k],
                       fabs(t->digits[k]));
    }
    row_fill(v, "kinetic + potential", "energy.total", &sum);
    if (c->instant[0].digits) row_fill(v, "trajectory.states", "states_45_digits", &digits);
}

/* At least one stepper must reach the end, or the motion is not verified. */
bool verify_trajectory(struct verify_case *v, struct err *e)
{
    bool any = false;
    for (int k = 0; k < STEPPERS; k++) any = stepper_row(v, k) || any;
    if (!any) {
        struct verify_row *row = verify_row_add(v, "any integrator", "states");
        row->error = INFINITY;
        row->verdict = VERIFY_FAIL;
    }
    twice_rows(v);
    return totals_rows(v, e);
}
