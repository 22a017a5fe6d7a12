/* verify_urdf.c - rows of the URDF file that a reference vector names: our own reading of it is the
 * same robot. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "dynamics/system.h"
#include "model/lump.h"
#include "model/urdf_model.h"
#include "study/verify_rows.h"

/* The largest difference of n numbers, of their largest. Both are decimal texts read once, or
 * turned by a few rounded operations: a vector's length is what these round against. */
static double difference(const double *x, const double *ref, int n)
{
    double largest = 0, scale = 0;
    for (int i = 0; i < n; i++) {
        largest = fmax(largest, fabs(x[i] - ref[i]));
        scale = fmax(scale, fabs(ref[i]));
    }
    return largest == 0 ? 0 : scale > 0 ? largest / scale : INFINITY;
}

/* A frame's turn is the same for a quaternion and its negative: columns are compared. */
static double frame_difference(const struct frame *x, const struct frame *ref)
{
    double worst = difference(x->p, ref->p, 3);
    /* Both are normalised: files have few digits. */
    struct frame a = *x, b = *ref;
    frame_normalise(&a);
    frame_normalise(&b);
    for (int k = 0; k < 3; k++) {
        const double unit[3] = {k == 0, k == 1, k == 2};
        double column[3], right[3];
        frame_turn(&a, unit, column);
        frame_turn(&b, unit, right);
        worst = fmax(worst, difference(column, right, 3));
    }
    return worst;
}

/* Names, kinds and parents must be equal: there is no rounding of them. */
static bool same_joint(const struct body_def *x, const struct body_def *ref)
{
    return x->joint == ref->joint && x->parent == ref->parent && strcmp(x->name, ref->name) == 0;
}

/* A row without scales of its own; the tolerance is the one of double precision, whatever
 * precision is under test, since reading a file computes nothing. */
static void row_plain(struct verify_case *v, const char *quantity, double error, const char *where)
{
    struct verify_row *row = verify_row_add(v, "URDF file", quantity);
    row->error = row->plain = error;
    row->tolerance = verify_tolerance_inverse(&(struct verify_options){.tolerance_inverse = 0});
    row->verdict = error <= row->tolerance ? VERIFY_PASS : VERIFY_FAIL;
    if (error > 0 && where) snprintf(row->note, sizeof row->note, "largest at body '%.60s'", where);
}

/* The worst body of each kind of number. Each kind of number is a row of its own: a wrong axis and
 * a wrong mass have different causes. */
static void body_rows(struct verify_case *v, const struct model *m)
{
    enum { JOINT, AXIS, FRAME, MASS, COM, INERTIA, KINDS };
    static const char *const name[KINDS] = {
        "joint, parent, name", "axis", "placement", "mass", "com", "inertia_com"};
    double worst[KINDS] = {0};
    const char *at[KINDS] = {NULL};
    /* Axes of fixed and free joints mean nothing. */
    for (int i = 0; i < m->nbody; i++) {
        const struct body_def *x = &m->body[i], *ref = &v->model->body[i];
        bool moves = x->joint == JOINT_REVOLUTE || x->joint == JOINT_PRISMATIC;
        const double error[KINDS] = {[JOINT] = same_joint(x, ref) ? 0 : INFINITY,
                                     [AXIS] = moves ? difference(x->axis, ref->axis, 3) : 0,
                                     [FRAME] = frame_difference(&x->placement, &ref->placement),
                                     [MASS] = difference(&x->mass, &ref->mass, 1),
                                     [COM] = difference(x->com, ref->com, 3),
                                     [INERTIA] = difference(x->inertia, ref->inertia, 6)};
        for (int k = 0; k < KINDS; k++)
            /* NaN never counts as larger: numbers of a file are finite. */
            if (error[k] > worst[k]) worst[k] = error[k], at[k] = ref->name;
    }
    for (int k = 0; k < KINDS; k++) row_plain(v, name[k], worst[k], at[k]);
}

/* The file's answers from the URDF's model: joint forces, and accelerations without the damping
 * that robots have and the reference does not. */
static void answer_rows(struct verify_case *v, struct model *m)
{
    const struct dynamics_type *type = dynamics_type_of(v->options->precision);
    double *tau = TAKE(v->arena, m->nu + 1, double), *qdd = TAKE(v->arena, m->nu + 1, double);
    struct work w = {0};
    if (v->vector->tau_id) {
        type->inverse(m, v->state, v->arena, tau, &w);
        verify_row_judge(v, verify_row_add(v, "rnea of the URDF file", "tau_id"), VERIFY_TAU_ID,
                         tau, verify_tolerance_inverse(v->options));
    }
    if (v->vector->qdd_fd) {
        bool good = type->forward(m, v->state, FORWARD_ABA, v->arena, qdd, NULL, NULL, &w);
        verify_row_judge(v, verify_row_add(v, "aba of the URDF file", "qdd_fd"), VERIFY_QDD_FD,
                         good ? qdd : NULL, verify_tolerance_forward(v->options));
    }
}

/* The URDF file lies beside the vector's. It is read with fixed joints kept and without judging
 * its masses, as the reference did. */
bool verify_urdf(struct verify_case *v, struct err *e)
{
    const struct vector_case *c = v->vector;
    char path[512];
    const char *slash = strrchr(c->path, '/');
    int folder = slash ? (int)(slash - c->path) + 1 : 0;
    struct urdf_robot robot;
    struct urdf_options o = {.floating = c->body[0].joint == VECTOR_FLOATING,
                             .keep_fixed = true,
                             .allow_nonphysical = true};
    /* Most files name no URDF file. */
    if (!c->urdf[0]) return true;
    snprintf(path, sizeof path, "%.*s%s", folder, c->path, c->urdf);
    if (access(path, R_OK) != 0)
        return err_set_at(e, ERR_DATA, c->path, c->urdf_line, "the URDF file '%.200s' does not "
                                                              "exist; it must be in the folder of "
                          "this file", c->urdf);
    /* URDF has no gravity: the vector's. */
    memcpy(o.gravity, c->gravity, sizeof o.gravity);
    struct model *m =
        urdf_read(path, &robot, v->arena, e) ? urdf_model(&robot, &o, v->arena, e) : NULL;
    if (!m) return false;
    /* The reference may have left out or joined bodies: then nothing can be compared. */
    if (m->nbody != c->nbody || m->nu != c->nv)
        return err_set_at(e, ERR_DATA, c->path, c->urdf_line,
                          "'%.200s' has %d bodies and %d degrees of freedom, this "
                          "file %d and %d", c->urdf, m->nbody, m->nu, c->nbody, c->nv);
    /* The reference has no damping. */
    for (int i = 0; i < m->nbody; i++) m->body[i].damping = 0;
    system_prepare(m);
    body_rows(v, m);
    answer_rows(v, m);
    return true;
}
