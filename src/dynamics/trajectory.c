/* trajectory.c - the dynamics as GSL wants them. */
#include "dynamics/trajectory.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <string.h>

#include "base/check.h"
#include "base/gsl_errors.h"
#include "base/text.h"
#include "dynamics/differences.h"

static const char *const names[] = {"rk2",    "rk4",    "rkf45",  "rkck",  "rk8pd", "msadams",
                                    "rk1imp", "rk2imp", "rk4imp", "bsimp", "msbdf", NULL};

const char *const *trajectory_steppers(void) { return names; }

/* In the order of the names; GSL's types are variables, hence no static table. */
static const gsl_odeiv2_step_type *stepper_of(int i)
{
    const gsl_odeiv2_step_type *const type[] = {
        gsl_odeiv2_step_rk2,    gsl_odeiv2_step_rk4,    gsl_odeiv2_step_rkf45,
        gsl_odeiv2_step_rkck,   gsl_odeiv2_step_rk8pd,  gsl_odeiv2_step_msadams,
        gsl_odeiv2_step_rk1imp, gsl_odeiv2_step_rk2imp, gsl_odeiv2_step_rk4imp,
        gsl_odeiv2_step_bsimp,  gsl_odeiv2_step_msbdf};
    return type[i];
}

/* dy = f(y), and how it changes with y, as GSL calls them. */
static int derivative(double t, const double y[], double dy[], void *context)
{
    (void)t;
    return differences_derivative(context, y, dy) ? GSL_SUCCESS : GSL_EBADFUNC;
}

static int jacobian(double t, const double y[], double *dfdy, double dfdt[], void *context)
{
    const struct differences *f = context;
    (void)t;
    /* Nothing depends on time alone. */
    for (int i = 0; i < f->d->model->nq + f->d->model->nu; i++) dfdt[i] = 0;
    return differences_jacobian(context, y, dfdy) ? GSL_SUCCESS : GSL_EBADFUNC;
}

/* y -> state, quaternions normalised. */
static void state_from(const struct dynamics *d, const double *y, struct state *s)
{
    const struct model *m = d->model;
    memcpy(s->q, y, (size_t)m->nq * sizeof *y);
    memcpy(s->qd, y + m->nq, (size_t)m->nu * sizeof *y);
    for (int i = 0; i < m->nbody; i++) {
        const int quaternion = joint_quaternion(d->body[i].joint);
        if (quaternion < 0) continue;
        double *c = s->q + d->body[i].q_at + quaternion;
        const double length = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2] + c[3] * c[3]);
        for (int k = 0; k < 4; k++) c[k] /= length;
    }
}

/* Its number in both tables. */
static int stepper_find(const char *name, struct err *e)
{
    int count = (int)(sizeof names / sizeof *names) - 1;
    for (int i = 0; i < count; i++)
        if (strcmp(names[i], name) == 0) return i;
    /* As everywhere: the nearest name. */
    err_set(e, ERR_USAGE, "no integrator '%s'%s", name, text_hint(name, names, count, "").s);
    return -1;
}

/* Drive to the end; the number of steps, negative when GSL failed. GSL's default handler would
 * abort. */
static long drive(gsl_odeiv2_driver *driver, double duration, double *y)
{
    /* GSL's driver chooses its steps by its own estimate of the error. */
    double t = 0;
    gsl_error_handler_t *handler = gsl_set_error_handler(gsl_errors_returned);
    int status = gsl_odeiv2_driver_apply(driver, &t, duration, y);
    gsl_set_error_handler(handler);
    return status == GSL_SUCCESS ? (long)driver->e->count : -1;
}

/* The same in `steps` equal steps, past the driver's control of the error; it still says how well
 * implicit equations are to be solved. */
static long drive_fixed(gsl_odeiv2_driver *driver, double duration, long steps, double *y,
                        double *error)
{
    const double h = duration / (double)steps;
    int status = GSL_SUCCESS;
    gsl_error_handler_t *handler = gsl_set_error_handler(gsl_errors_returned);
    for (long k = 0; k < steps && status == GSL_SUCCESS; k++)
        status =
            gsl_odeiv2_step_apply(driver->s, (double)k * h, h, y, error, NULL, NULL, driver->sys);
    gsl_set_error_handler(handler);
    return status == GSL_SUCCESS ? steps : -1;
}

/* GSL steps plain numbers: quaternions are normalised when they come back. */
bool trajectory_advance(const struct model *m, struct state *s, double duration,
                        const struct trajectory_options *options, struct arena *scratch,
                        struct trajectory_report *report, struct err *e)
{
    int which = stepper_find(options->stepper, e);
    if (which < 0) return false;
    size_t n = (size_t)(m->nq + m->nu);
    if (report) *report = (struct trajectory_report){0};
    /* A system of fixed joints. */
    if (n == 0) return true; /* nothing can move */
    if (!(duration > 0) || !isfinite(duration))
        return err_set(e, ERR_CHECK, "integrator '%s': the duration %g is not positive and "
                                     "finite", options->stepper, duration);
    struct arena_mark mark = arena_mark(scratch);
    /* q and u as one vector of plain numbers. */
    const long most = options->most_evaluations > 0 ? options->most_evaluations : 10000000;
    struct differences f = differences_make(m, s, most, lanes_type_widest(), scratch);
    double *y = TAKE(scratch, n, double);
    /* q first, then u; the state itself stays as it is until the end is known to be good. */
    memcpy(y, s->q, (size_t)m->nq * sizeof *y);
    memcpy(y + m->nq, s->qd, (size_t)m->nu * sizeof *y);
    double first = options->first_step > 0 ? options->first_step : duration / 1000;
    gsl_odeiv2_system system = {derivative, jacobian, n, &f};
    /* The first step is a guess; the driver finds its own. */
    gsl_error_handler_t *handler = gsl_set_error_handler(gsl_errors_returned);
    gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(
        &system, stepper_of(which), first, options->tolerance, options->tolerance);
    gsl_set_error_handler(handler);
    if (!driver) check_memory(n * sizeof(double));
    long steps = options->fixed_steps > 0 ? drive_fixed(driver, duration, options->fixed_steps, y,
                                                        TAKE(scratch, n, double))
                                          : drive(driver, duration, y);
    gsl_odeiv2_driver_free(driver);
    /* A step may end in overflow without GSL noticing. */
    bool finite = true;
    for (size_t i = 0; i < n; i++) finite = finite && isfinite(y[i]);
    /* All or nothing: a failed run leaves the state where it began. */
    if (steps >= 0 && finite) state_from(f.d, y, s);
    if (report) *report = (struct trajectory_report){steps < 0 ? 0 : steps, f.evaluations};
    arena_release(scratch, mark);
    if (steps >= 0 && finite) return true;
    if (steps >= 0)
        return err_set(e, ERR_CHECK,
                       "integrator '%s' produced a value that is not a finite number",
                       options->stepper);
    if (f.evaluations > f.most)
        return err_set(e, ERR_CHECK, "integrator '%s' did not reach the end time within %ld "
                                     "evaluations", options->stepper, f.most);
    return err_set(e, ERR_CHECK, "integrator '%s' %s", options->stepper,
                   options->fixed_steps > 0 ? "broke down in a fixed step"
                                            : "gave up: its step size vanished");
}
