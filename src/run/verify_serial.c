/* verify_serial.c - rows of the serial algorithms: inverse dynamics, kinematics, mass matrix, every way forward. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "dynamics/dynamics.h"
#include "model/urdf_model.h"
#include "run/verify_rows.h"

static const struct dynamics_type *type_of(const struct verify_case *v)
{
    return dynamics_type_of(v->options->precision);
}

/* Judge a row whose answer is rounded once more than the reference: no explanation but the tolerance. */
static void judge(struct verify_row *row, double error, double tolerance)
{
    row->error = error;
    row->tolerance = tolerance;
    row->verdict = error <= tolerance ? VERIFY_PASS : VERIFY_FAIL;
}

static void row_plain(struct verify_case *v, const char *algorithm, const char *quantity, double error)
{
    judge(verify_row_add(v, algorithm, quantity), error, verify_tolerance_inverse(v));
}

/* --- inverse dynamics ------------------------------------------------------------------------------------------ */

/* The largest component of the wrenches that joints transmit at `s`: what joint forces are rounded against. */
static double largest_wrench(struct verify_case *v, const struct state *s)
{
    struct dynamics *d = dynamics_take(v->model, v->arena);
    double *tau = TAKE(v->arena, v->model->nu + 1, double);
    dynamics_load(d, s);
    rnea_full(d, s->q, s->qd, s->qdd, tau, NULL);
    return verify_largest(d->f, 6 * v->model->nbody);
}

/* tau for the case's state with some of it set to zero. Joint forces that cancel, as a balanced pose's under gravity,
 * are measured by the wrenches they are part of. */
static void rnea_row(struct verify_case *v, const char *quantity, const struct state *s, const double *ref)
{
    if (!ref) return;
    double *tau = TAKE(v->arena, v->model->nu + 1, double);
    struct work w = {0};
    type_of(v)->inverse(v->model, s, v->arena, tau, &w);
    row_plain(v, "rnea", quantity, verify_error_beside(tau, ref, v->model->nu, largest_wrench(v, s)));
}

/* A robot whose URDF file lies beside the case: the same answer must come from our own reading of it. */
static void urdf_row(struct verify_case *v)
{
    const struct vector_case *c = v->vector;
    char path[512];
    const char *slash = strrchr(c->path, '/');
    int folder = slash ? (int)(slash - c->path) + 1 : 0;
    snprintf(path, sizeof path, "%.*s%s", folder, c->path, c->urdf);
    if (!c->urdf[0] || !c->tau_id || access(path, R_OK) != 0) return;
    struct urdf_robot robot;
    struct urdf_options o = {
        .floating = c->body[0].joint == VECTOR_FLOATING, .keep_fixed = true, .allow_nonphysical = true};
    struct err e;
    err_clear(&e);
    memcpy(o.gravity, c->gravity, sizeof o.gravity);
    struct model *m = urdf_read(path, &robot, v->arena, &e) ? urdf_model(&robot, &o, v->arena, &e) : NULL;
    struct verify_row *row = verify_row_add(v, "rnea of the URDF file", "tau_id");
    double *tau = TAKE(v->arena, v->model->nu + 1, double);
    struct work w = {0};
    bool same = m && m->nbody == c->nbody && m->nu == c->nv;
    if (same) type_of(v)->inverse(m, v->state, v->arena, tau, &w);
    judge(row, same ? verify_error(tau, c->tau_id, c->nv) : INFINITY, verify_tolerance_inverse(v));
    if (!same) text_copy(row->note, sizeof row->note, m ? "other bodies than the file's" : e.text);
}

static void inverse_rows(struct verify_case *v)
{
    const struct vector_case *c = v->vector;
    struct state bias = *v->state, rest = *v->state;
    bias.qdd = rest.qdd = rest.qd = TAKE(v->arena, v->model->nu + 1, double);
    rest.fext = NULL;
    rnea_row(v, "tau_id", v->state, c->tau_id);
    rnea_row(v, "bias", &bias, c->bias);
    rnea_row(v, "gravity_torque", &rest, c->gravity_torque);
    urdf_row(v);
}

/* --- kinematics, joint wrenches, totals ------------------------------------------------------------------------ */

/* The largest of each vector over all bodies. */
struct pose_scale {
    double p, v, w, a, alpha;
};

static struct pose_scale pose_scale_of(const struct body_motion *x, int n)
{
    struct pose_scale s = {0};
    for (int i = 0; i < n; i++) {
        s.p = fmax(s.p, verify_largest(x[i].p, 3));
        s.v = fmax(s.v, verify_largest(x[i].v, 3));
        s.w = fmax(s.w, verify_largest(x[i].w, 3));
        s.a = fmax(s.a, verify_largest(x[i].a, 3));
        s.alpha = fmax(s.alpha, verify_largest(x[i].alpha, 3));
    }
    return s;
}

/* A body at rest among moving ones is measured by those. */
static double pose_error(const struct body_motion *x, const struct vector_pose *ref, const struct pose_scale *all)
{
    double e = verify_error(x->r, ref->R, 9);
    e = fmax(e, verify_error_beside(x->p, ref->p, 3, all->p));
    e = fmax(e, verify_error_beside(x->v, ref->v, 3, all->v));
    e = fmax(e, verify_error_beside(x->w, ref->w, 3, all->w));
    e = fmax(e, verify_error_beside(x->a, ref->a, 3, all->a));
    return fmax(e, verify_error_beside(x->alpha, ref->alpha, 3, all->alpha));
}

static void kinematics_row(struct verify_case *v, struct dynamics *d)
{
    const struct vector_case *c = v->vector;
    if (c->npose == 0) return;
    struct body_motion *motion = TAKE(v->arena, v->model->nbody, struct body_motion);
    forward_kinematics(d, v->state->q, v->state->qd, v->state->qdd, motion);
    const struct pose_scale all = pose_scale_of(motion, v->model->nbody);
    double error = 0;
    for (int i = 0; i < c->npose; i++) error = fmax(error, pose_error(&motion[c->pose[i].body], &c->pose[i], &all));
    row_plain(v, "kinematics", "fk", error);
}

/* The joint forces that RNEA leaves behind, from internal [moment; force] to the user's [force; moment]. */
static void wrench_row(struct verify_case *v, struct dynamics *d)
{
    const struct vector_case *c = v->vector;
    if (!c->joint_wrench) return;
    int n = v->model->nbody;
    double *tau = TAKE(v->arena, v->model->nu + 1, double), *wrench = TAKE(v->arena, 6 * n, double);
    struct work w = {0};
    dynamics_load(d, v->state);
    rnea_full(d, v->state->q, v->state->qd, v->state->qdd, tau, &w);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            for (int l = 0; l < 3; l++) {
                double turn = d->body[i].user[3 * k + l];
                wrench[6 * i + k] += turn * d->f[6 * i + 3 + l];
                wrench[6 * i + 3 + k] += turn * d->f[6 * i + l];
            }
    row_plain(v, "rnea", "joint_wrench_id", verify_error(wrench, c->joint_wrench, 6 * n));
}

static void totals_rows(struct verify_case *v)
{
    const struct vector_case *c = v->vector;
    struct dynamics_totals t;
    type_of(v)->totals(v->model, v->state, v->arena, &t);
    if (c->has_energy) {
        const double x[2] = {t.kinetic, t.potential}, ref[2] = {c->kinetic, c->potential};
        row_plain(v, "totals", "energy", verify_error(x, ref, 2));
    }
    if (c->has_momentum) { /* |p| <= sqrt(2 m T): what the bodies' momenta may cancel to */
        double linear = sqrt(2 * t.mass * t.kinetic), arm = verify_largest(t.com, 3);
        for (int i = 0; i < v->model->nbody; i++) arm = fmax(arm, verify_largest(v->model->body[i].placement.p, 3));
        double angular = fmax(linear * arm, verify_largest(t.angular, 3));
        row_plain(v, "totals", "momentum",
                  fmax(verify_error_beside(t.linear, c->linear, 3, linear),
                       verify_error_beside(t.angular, c->angular, 3, angular)));
    }
    if (c->has_com)
        row_plain(v, "totals", "com_world",
                  fmax(verify_error(t.com, c->com_world, 3), verify_error(&t.mass, &c->total_mass, 1)));
}

static void mass_row(struct verify_case *v)
{
    if (!v->vector->mass_matrix) return;
    int n = v->model->nu;
    double *mass = TAKE(v->arena, n * n, double);
    struct work w = {0};
    type_of(v)->mass_matrix(v->model, v->state, v->arena, mass, &w);
    row_plain(v, "crba", "M", verify_error(mass, v->vector->mass_matrix, n * n));
}

/* --- forward dynamics ------------------------------------------------------------------------------------------ */

struct answer {
    double *qdd, *lambda;
    struct forward_report report;
    bool good;
};

static struct answer forward(struct verify_case *v, const struct dynamics_type *type, enum forward_method method)
{
    bool cfa = method >= FORWARD_CFA_PAPER;
    const struct model *m = cfa ? v->lumped : v->model;
    const struct state *s = cfa ? v->lumped_state : v->state;
    struct answer x = {.qdd = TAKE(v->arena, m->nu + 1, double), .lambda = TAKE(v->arena, m->nrow + 1, double)};
    struct work w = {0};
    x.good = type->forward(m, s, method, v->arena, x.qdd, x.lambda, &x.report, &w);
    return x;
}

static double error_in(struct verify_case *v, enum forward_method method, enum precision precision)
{
    struct answer x = forward(v, dynamics_type_of(precision), method);
    return x.good ? verify_error(x.qdd, v->vector->qdd_fd, v->vector->nv) : INFINITY;
}

/* A large error is by rounding when the same algorithm is right in quad precision, or, where that would take long, when
 * the error is in proportion to that in single precision; a breakdown of the latter is as large an error as there is.
 */
static void explain(struct verify_case *v, enum forward_method method, bool good, struct verify_row *row)
{
    enum { QUAD_LIMIT = 310 };
    bool by_single = good && v->vector->nv > QUAD_LIMIT && v->options->precision == PRECISION_DOUBLE;
    bool is_quad = v->options->precision == PRECISION_QUAD;
    double other = error_in(v, method, by_single ? PRECISION_FLOAT : is_quad ? PRECISION_DOUBLE : PRECISION_QUAD);
    double coarse = is_quad ? other : row->error, fine = is_quad ? row->error : other;
    if (by_single ? verify_error_scales(row->error, other) : verify_error_vanishes(coarse, fine))
        row->verdict = VERIFY_ROUNDING;
    snprintf(row->note, sizeof row->note, "%sin %s precision %.1e", good ? "" : "breaks down; ",
             by_single ? "single" : is_quad ? "double" : "quad", other);
}

/* Loop forces are no better than the accelerations: `rounded` tells that rounding explains those. */
static void lambda_row(struct verify_case *v, enum forward_method method, const struct answer *x, bool rounded)
{
    const char *name = forward_method_name(method);
    const struct vector_case *c = v->vector;
    if (!c->lambda) return;
    if (x->report.rank < x->report.nrow) {
        char why[96];
        snprintf(why, sizeof why, "redundant loops (rank %d of %d): lambda is not unique", x->report.rank,
                 x->report.nrow);
        verify_row_skip(v, name, "lambda", why);
        return;
    }
    struct verify_row *row = verify_row_add(v, name, "lambda");
    judge(row, verify_error(x->lambda, c->lambda, c->nrow), verify_tolerance_forward(v));
    if (row->verdict != VERIFY_FAIL) return;
    struct answer quad = forward(v, dynamics_type_of(PRECISION_QUAD), method);
    double error = quad.good ? verify_error(quad.lambda, c->lambda, c->nrow) : INFINITY;
    if (rounded || verify_error_vanishes(row->error, error)) row->verdict = VERIFY_ROUNDING;
    snprintf(row->note, sizeof row->note, "in quad precision %.1e", error);
}

/* unfit: why constraint forces do not apply, NULL when they do. */
static void forward_row(struct verify_case *v, enum forward_method method, const char *unfit)
{
    enum { MASS_MATRIX_LIMIT = 2000 };
    const struct vector_case *c = v->vector;
    const char *name = forward_method_name(method);
    bool mass_matrix = method == FORWARD_CRBA || method == FORWARD_CRBA_SPARSE, robust = method == FORWARD_CFA_ROBUST;
    const char *why = method >= FORWARD_CFA_PAPER ? unfit : NULL;
    if (mass_matrix && c->nv > MASS_MATRIX_LIMIT) why = "left out: its time grows as the cube of the size";
    if (why) {
        verify_row_skip(v, name, "qdd_fd", why);
        return;
    }
    struct answer x = forward(v, type_of(v), method);
    struct verify_row *row = verify_row_add(v, name, "qdd_fd");
    double tolerance = robust ? verify_tolerance_robust(v) : verify_tolerance_forward(v);
    bool strict = tolerance < verify_tolerance_forward(v);
    judge(row, x.good ? verify_error(x.qdd, c->qdd_fd, c->nv) : INFINITY, tolerance);
    if (row->verdict == VERIFY_FAIL && !strict) explain(v, method, x.good, row);
    if (x.good && c->nrow > 0) lambda_row(v, method, &x, row->verdict == VERIFY_ROUNDING);
}

static void forward_rows(struct verify_case *v)
{
    char unfit[96];
    const char *why = verify_unfit_body(v->lumped, unfit, sizeof unfit) ? unfit : NULL;
    for (int k = 0; v->vector->qdd_fd && k < FORWARD_METHODS; k++) forward_row(v, (enum forward_method)k, why);
}

void verify_serial(struct verify_case *v)
{
    inverse_rows(v);
    if (v->options->precision == PRECISION_DOUBLE) {
        struct dynamics *d = dynamics_take(v->model, v->arena);
        wrench_row(v, d);
        kinematics_row(v, d);
    }
    totals_rows(v);
    mass_row(v);
    forward_rows(v);
}
