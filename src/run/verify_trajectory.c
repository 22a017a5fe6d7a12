/* verify_trajectory.c - rows of the integrators: the reference's states at its times, each by an independent stepper.
 *
 * An error made early grows with the motion's own sensitivity: the tolerance of an instant is the stepper's, or its
 * local errors grown until then. A row shows the instant that comes closest to its tolerance or exceeds it most. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "dynamics/trajectory.h"
#include "run/verify_rows.h"

/* A stepper with the error per step that it is given, the error at the end that it then holds for tame motions, and how
 * many local errors add up before they grow. */
static const struct {
    const char *name;
    double local, global, slack;
} stepper_table[] = {{"rk8pd", 1e-13, 1e-8, 10},   {"rkck", 1e-12, 1e-7, 100},   {"msadams", 1e-12, 1e-6, 1000},
                     {"bsimp", 1e-12, 1e-7, 100},  {"rk4imp", 1e-9, 1e-4, 1000}, {"msbdf", 1e-9, 1e-3, 10000}};
enum { STEPPERS = sizeof stepper_table / sizeof *stepper_table };

struct worst {
    double error, tolerance;
};

/* Keep the pair whose error is the larger part of its tolerance. */
static void worst_take(struct worst *w, double error, double tolerance)
{
    if (error / tolerance >= w->error / w->tolerance || w->tolerance == 0) *w = (struct worst){error, tolerance};
}

static double tolerance_at(const struct verify_case *v, int instant, int stepper)
{
    double asked = v->options->tolerance_forward > 0 ? v->options->tolerance_forward : stepper_table[stepper].global;
    double grown =
        stepper_table[stepper].slack * stepper_table[stepper].local * v->vector->instant[instant].sensitivity;
    return isfinite(grown) ? fmax(asked, grown) : asked;
}

static double state_error(const struct vector_case *c, const struct vector_instant *t, const struct state *s)
{
    return fmax(verify_error(s->q, t->q, c->nq), verify_error(s->qd, t->qd, c->nv));
}

/* Energy against the largest energy of the motion, kinetic or potential, so that a total near zero does not mislead. */
static double energy_error(struct verify_case *v, const struct state *s, double reference)
{
    struct dynamics_totals t;
    dynamics_type_of(PRECISION_DOUBLE)->totals(v->model, s, v->arena, &t);
    double scale = fmax(fmax(fabs(t.kinetic), fabs(t.potential)), fabs(reference));
    return scale > 0 ? fabs(t.kinetic + t.potential - reference) / scale : 0;
}

static void row_fill(struct verify_case *v, const char *name, const char *quantity, const struct worst *w)
{
    struct verify_row *row = verify_row_add(v, name, quantity);
    row->error = w->error;
    row->tolerance = w->tolerance;
    row->verdict = w->error <= w->tolerance ? VERIFY_PASS : VERIFY_FAIL;
}

/* Evaluations that an interval may take: a stiff motion needs ever more of an explicit stepper, and is left to others.
 */
static long evaluations_allowed(const struct vector_case *c) { return 24000000L / c->nbody / c->ninstant; }

static bool stepper_rows(struct verify_case *v, int k)
{
    const struct vector_case *c = v->vector;
    const double hopeless = 0.1; /* a tolerance that says nothing */
    struct trajectory_options o = {.stepper = stepper_table[k].name, .tolerance = stepper_table[k].local,
                                   .most_evaluations = evaluations_allowed(c)};
    struct state *s = state_take(v->model, v->arena);
    struct worst state = {0, 0}, energy = {0, 0};
    struct err e;
    char why[96];
    memcpy(s->q, c->q, (size_t)c->nq * sizeof *c->q);
    memcpy(s->qd, c->qd, (size_t)c->nv * sizeof *c->qd);
    err_clear(&e);
    for (int i = 1; i < c->ninstant; i++) {
        double tolerance = tolerance_at(v, i, k), duration = c->instant[i].time - c->instant[i - 1].time;
        if (!trajectory_advance(v->model, s, duration, &o, v->arena, NULL, &e)) {
            snprintf(why, sizeof why, "gave up before t = %g: too stiff for it", c->instant[i].time);
            verify_row_skip(v, stepper_table[k].name, "states", why);
            return false;
        }
        double error = state_error(c, &c->instant[i], s);
        if (tolerance > hopeless) {
            snprintf(why, sizeof why, "the motion is too sensitive for it (error %.1e)", error);
            verify_row_skip(v, stepper_table[k].name, "states", why);
            return false;
        }
        worst_take(&state, error, tolerance);
        worst_take(&energy, energy_error(v, s, c->instant[i].energy), tolerance);
    }
    row_fill(v, stepper_table[k].name, "states", &state);
    row_fill(v, stepper_table[k].name, "energy", &energy);
    return true;
}

void verify_trajectory(struct verify_case *v)
{
    bool any = false;
    for (int k = 0; k < STEPPERS; k++) any = stepper_rows(v, k) || any;
    if (any) return;
    struct verify_row *row = verify_row_add(v, "any stepper", "states");
    row->error = INFINITY;
    row->verdict = VERIFY_FAIL;
}
