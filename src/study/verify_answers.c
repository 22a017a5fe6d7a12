/* verify_answers.c - the answers of a reference vector, exact ones, and how far roundings of the
 * inputs move them. */
#include "study/verify_answers.h"

#include <math.h>
#include <string.h>

#include "dynamics/dynamics_table.h"
#include "dynamics/system.h"
#include "model/vector_model.h"
#include "model/vector_perturb.h"

/* Inputs are moved by 2^-40 of themselves, and the answers' changes taken 2^13 times smaller: in
 * quad precision that is the effect of 2^-53 to 12 bits, as long as the condition is below 2^40. */
static const double moved = 0x1p-40;

const char *verify_quantity_name(enum verify_quantity k)
{
    static const char *const name[VERIFY_QUANTITIES] = {"tau_id",
                                                        "bias",
                                                        "gravity_torque",
                                                        "joint_wrench_id",
                                                        "fk",
                                                        "energy.kinetic",
                                                        "energy.potential",
                                                        "momentum.linear",
                                                        "momentum.angular",
                                                        "com_world",
                                                        "total_mass",
                                                        "M",
                                                        "qdd_fd",
                                                        "lambda"};
    return name[k];
}

/* --- the list --------------------------------------------------------------------------------- */

/* Append n numbers, in vectors of `part` numbers each. Numbers of a vector know its first one: they
 * will share its scale. */
static void append(struct verify_answers *x, const double *from, int n, int part)
{
    for (int i = 0; i < n; i++) {
        x->reference[x->n] = from[i];
        x->group[x->n] = x->n - i % part;
        x->n++;
    }
}

/* Joint forces or accelerations: vectors are the linear and the angular part of one joint. */
static void append_joints(struct verify_answers *x, const struct vector_case *c, const double *from)
{
    for (int i = 0; from && i < c->nbody; i++) {
        int n = vector_joint_nv(c->body[i].joint);
        append(x, from + c->body[i].v, n, n < 3 ? 1 : 3);
    }
}

/* The first degree of freedom of the linear or the angular part that each one belongs to: joints
 * with one or two have parts of one number, others parts of three. */
static void parts_find(struct verify_answers *x, const struct vector_case *c)
{
    for (int i = 0; i < c->nbody; i++) {
        int n = vector_joint_nv(c->body[i].joint), v = c->body[i].v;
        for (int k = 0; k < n; k++) x->part[v + k] = v + k - (n < 3 ? 0 : k % 3);
    }
}

/* The mass matrix: what one joint's linear or angular part has to do with another's is one
 * block. */
static void append_matrix(struct verify_answers *x, const struct vector_case *c)
{
    int nv = c->nv, start = x->n;
    if (!c->mass_matrix) return;
    append(x, c->mass_matrix, nv * nv, 1);
    for (int i = 0; i < nv; i++)
        for (int k = 0; k < nv; k++)
            x->group[start + i * nv + k] = start + x->part[i] * nv + x->part[k];
}

static void append_poses(struct verify_answers *x, const struct vector_case *c)
{
    for (int i = 0; i < c->npose; i++) {
        const struct vector_pose *p = &c->pose[i];
        append(x, p->R, 9, 9);
        append(x, p->p, 3, 3);
        append(x, p->v, 3, 3);
        append(x, p->w, 3, 3);
        append(x, p->a, 3, 3);
        append(x, p->alpha, 3, 3);
    }
}

/* Where the numbers of each quantity come from; NULL or a count of 0: the file does not have it. */
static void append_quantity(struct verify_answers *x, const struct vector_case *c,
                            enum verify_quantity k)
{
    switch (k) {
    case VERIFY_TAU_ID: append_joints(x, c, c->tau_id); break;
    case VERIFY_BIAS: append_joints(x, c, c->bias); break;
    case VERIFY_GRAVITY_TORQUE: append_joints(x, c, c->gravity_torque); break;
    case VERIFY_QDD_FD: append_joints(x, c, c->qdd_fd); break;
    case VERIFY_WRENCH: append(x, c->joint_wrench, c->joint_wrench ? 6 * c->nbody : 0, 3); break;
    case VERIFY_FK: append_poses(x, c); break;
    case VERIFY_KINETIC: append(x, &c->kinetic, c->has_energy, 1); break;
    case VERIFY_POTENTIAL: append(x, &c->potential, c->has_energy, 1); break;
    case VERIFY_LINEAR: append(x, c->linear, c->has_momentum ? 3 : 0, 3); break;
    case VERIFY_ANGULAR: append(x, c->angular, c->has_momentum ? 3 : 0, 3); break;
    case VERIFY_COM: append(x, c->com_world, c->has_com ? 3 : 0, 3); break;
    case VERIFY_TOTAL_MASS: append(x, &c->total_mass, c->has_com, 1); break;
    case VERIFY_MASS_MATRIX: append_matrix(x, c); break;
    case VERIFY_LAMBDA: append(x, c->lambda, c->lambda ? c->nrow : 0, 1); break;
    case VERIFY_QUANTITIES: break;
    }
}

/* Numbers of all quantities together, and 16 for the totals. */
static size_t room_for(const struct vector_case *c)
{
    size_t nv = (size_t)c->nv,
           n = 4 * nv + 6 * (size_t)c->nbody + POSE_NUMBERS * (size_t)c->npose + 16;
    return n + (c->mass_matrix ? nv * nv : 0) + (size_t)c->nrow;
}

/* 0: the file does not have the quantity. */
static int count_of(const struct verify_answers *x, enum verify_quantity k)
{
    return x->at[k + 1] - x->at[k];
}

/* --- computing -------------------------------------------------------------------------------- */

/* Copies a quantity to its place in y, as many numbers as the file has of it. */
static void put(const struct verify_answers *x, enum verify_quantity k, const double *from,
                double *y)
{
    if (count_of(x, k) > 0) memcpy(y + x->at[k], from, (size_t)count_of(x, k) * sizeof *y);
}

/* Three inverse dynamics: as given, without accelerations (bias forces), and at rest without
 * external forces (gravity). */
static void put_inverse(const struct verify_answers *x, const struct model *m,
                        const struct state *s, const struct dynamics_type *type, struct arena *a,
                        double *y)
{
    struct state bias = *s, rest = *s;
    struct work w = {0};
    double *tau = TAKE(a, m->nu + 1, double), *wrench = TAKE(a, size_product(6, m->nbody), double);
    bias.qdd = rest.qdd = rest.qd = TAKE(a, m->nu + 1, double);
    rest.fext = NULL;
    type->inverse(m, s, a, tau, &w);
    put(x, VERIFY_TAU_ID, tau, y);
    type->inverse(m, &bias, a, tau, &w);
    put(x, VERIFY_BIAS, tau, y);
    type->inverse(m, &rest, a, tau, &w);
    put(x, VERIFY_GRAVITY_TORQUE, tau, y);
    if (count_of(x, VERIFY_WRENCH) == 0) return;
    type->wrenches(m, s, a, wrench);
    put(x, VERIFY_WRENCH, wrench, y);
}

/* Energies, momenta and mass of the whole system. */
static void put_totals(const struct verify_answers *x, const struct model *m, const struct state *s,
                       const struct dynamics_type *type, struct arena *a, double *y)
{
    struct dynamics_totals t;
    type->totals(m, s, a, &t);
    put(x, VERIFY_KINETIC, &t.kinetic, y);
    put(x, VERIFY_POTENTIAL, &t.potential, y);
    put(x, VERIFY_LINEAR, t.linear, y);
    put(x, VERIFY_ANGULAR, t.angular, y);
    put(x, VERIFY_COM, t.com, y);
    put(x, VERIFY_TOTAL_MASS, &t.mass, y);
}

/* Poses are computed of all bodies; the file may have those of a few. */
static void put_poses(const struct verify_answers *x, const struct vector_case *c,
                      const struct model *m, const struct state *s,
                      const struct dynamics_type *type, struct arena *a, double *y)
{
    if (c->npose == 0) return;
    double *pose = TAKE(a, size_product(POSE_NUMBERS, m->nbody), double),
           *to = y + x->at[VERIFY_FK];
    type->kinematics(m, s, a, pose);
    for (int i = 0; i < c->npose; i++)
        memcpy(to + POSE_NUMBERS * i, pose + POSE_NUMBERS * (size_t)c->pose[i].body,
               POSE_NUMBERS * sizeof *to);
}

void verify_answers_compute(const struct verify_answers *x, const struct vector_case *c,
                            const struct model *m, const struct state *s, enum precision precision,
                            struct arena *a, double *y)
{
    const struct dynamics_type *type = dynamics_type_of(precision);
    struct arena_mark mark = arena_mark(a);
    struct work w = {0};
    put_inverse(x, m, s, type, a, y);
    put_totals(x, m, s, type, a, y);
    put_poses(x, c, m, s, type, a, y);
    if (count_of(x, VERIFY_MASS_MATRIX) > 0)
        type->mass_matrix(m, s, a, y + x->at[VERIFY_MASS_MATRIX], &w);
    arena_release(a, mark);
}

/* Accelerations and loop forces in quad precision. redundant (may be NULL): see verify_answers. On
 * redundant loops accelerations are unique and loop forces are not: the rank tells. */
static bool put_forward(const struct verify_answers *x, const struct model *m,
                        const struct state *s, struct arena *a, double *y, int *redundant)
{
    struct arena_mark mark = arena_mark(a);
    double *qdd = TAKE(a, m->nu + 1, double), *lambda = TAKE(a, m->nrow + 1, double);
    struct forward_report report = {0};
    struct work w = {0};
    bool good =
        dynamics_type_of(PRECISION_QUAD)->forward(m, s, FORWARD_ABA, a, qdd, lambda, &report, &w);
    if (redundant) *redundant = good && m->nloop > 0 ? report.nrow - report.rank : 0;
    if (good) put(x, VERIFY_QDD_FD, qdd, y);
    if (good) put(x, VERIFY_LAMBDA, lambda, y);
    arena_release(a, mark);
    return good;
}

/* --- scales ----------------------------------------------------------------------------------- */

/* What joints transmit, as a force and a moment for each body, in the states that answers are given
 * for. A joint's force is a component of it. Where that component cancels whatever the inputs are,
 * as a ball's gyroscopic moment does, no input can move it; then, and only then, a rounding of what
 * it is a component of is what moves it. */
static const double cancels =
    1e-18; /* of the other scale: what quad precision leaves of a number that cancels */

/* The states in which wrenches are needed: with the file's accelerations, without them, at rest,
 * and with the exact accelerations. */
enum load { LOAD_INVERSE, LOAD_BIAS, LOAD_REST, LOAD_FORWARD, LOADS };

/* What a sample needs: the exact answers to compare with, and the scales that it raises. */
struct sampler {
    struct verify_answers *x;
    const struct vector_case *c;
    struct arena *a;
    double *wrench[LOADS], *scale[LOADS]; /* (6 nbody) exact; (2 nbody) force, moment */
    double *qdd;                          /* (nv) exact */
};

/* Wrenches in all joints in one of these states. */
static void wrenches_of(const struct sampler *p, const struct model *m, const struct state *s,
                        enum load load, double *wrench)
{
    struct state at = *s;
    double *zero = TAKE(p->a, m->nu + 1, double);
    if (load == LOAD_BIAS || load == LOAD_REST) at.qdd = zero;
    if (load == LOAD_REST) at.qd = zero, at.fext = NULL;
    if (load == LOAD_FORWARD) at.qdd = p->qdd;
    dynamics_type_of(PRECISION_QUAD)->wrenches(m, &at, p->a, wrench);
}

/* Scales at least what the wrenches are, and at least what they move by. */
static void wrenches_take(const struct sampler *p, const struct model *m, const struct state *s,
                          enum load load)
{
    struct arena_mark mark = arena_mark(p->a);
    double *w = TAKE(p->a, size_product(6, m->nbody), double);
    wrenches_of(p, m, s, load, w);
    /* moved is the relative change of the inputs: change / moved is the effect of a change by 1. */
    for (int i = 0; i < 6 * m->nbody; i++) {
        double *scale = &p->scale[load][i / 3], *exact = &p->wrench[load][i];
        *scale = fmax(*scale, fmax(fabs(*exact), fabs(w[i] - *exact) / moved));
    }
    arena_release(p->a, mark);
}

/* The scale of the wrench that degree of freedom v of body i is a component of. */
static double wrench_scale(const struct sampler *p, enum load load, int i, int v)
{
    enum vector_joint joint = p->c->body[i].joint;
    bool linear =
        joint == VECTOR_PRISMATIC || (joint == VECTOR_FLOATING && v - p->c->body[i].v < 3);
    return p->scale[load][2 * i + (linear ? 0 : 1)];
}

/* Joint forces that cancel get the scale of the wrench that they are a component of; after
 * `share`. */
static void forces_mend(const struct sampler *p, enum verify_quantity k, enum load load)
{
    if (count_of(p->x, k) == 0) return;
    for (int i = 0; i < p->c->nbody; i++)
        for (int v = p->c->body[i].v; v < p->c->body[i].v + vector_joint_nv(p->c->body[i].joint);
             v++) {
            double *scale = &p->x->scale[p->x->at[k] + v], other = wrench_scale(p, load, i, v);
            /* Only a scale that is nothing but leftover digits is replaced. */
            if (*scale < cancels * other) *scale = other;
        }
}

/* Accelerations that cancel: how far they move when joint forces move by roundings of what these
 * are components of. There is no wrench of an acceleration: joint forces are shaken by what
 * would be roundings of their wrenches, and the accelerations' response is the scale. */
static void accelerations_mend(const struct sampler *p, const struct model *m,
                               const struct state *s, struct random *r, double *y)
{
    struct verify_answers *x = p->x;
    struct state shaken = *s;
    int first = x->at[VERIFY_QDD_FD], n = count_of(x, VERIFY_QDD_FD);
    double least = INFINITY, largest = 0;
    for (int k = 0; k < n; k++) {
        least = fmin(least, x->scale[first + k]);
        largest = fmax(largest, x->scale[first + k]);
    }
    /* Least and largest scale within ten digits: no number cancels. */
    if (!x->forward || least > 1e-10 * largest) return; /* nothing cancels */
    shaken.tau = TAKE(p->a, m->nu + 1, double);
    for (int i = 0; i < p->c->nbody; i++)
        for (int v = p->c->body[i].v; v < p->c->body[i].v + vector_joint_nv(p->c->body[i].joint);
             v++)
            shaken.tau[v] =
                s->tau[v] + moved * wrench_scale(p, LOAD_FORWARD, i, v) * random_uniform(r, -1, 1);
    if (!put_forward(x, m, &shaken, p->a, y, NULL)) return;
    for (int k = first; k < first + n; k++) {
        double other = fabs(y[k] - x->exact[k]) / moved;
        if (x->scale[k] < cancels * other) x->scale[k] = other;
    }
}

/* Each sample moves all inputs at once, by random amounts. Fewer where a sample takes long: a
 * sample of many bodies already holds many roundings. */
static int samples_of(const struct vector_case *c) { return c->nbody > 200 ? 3 : 6; }

/* One sample: scale at least what it moves. */
static bool sample(const struct sampler *p, struct random *r, double *y, struct err *e)
{
    struct verify_answers *x = p->x;
    struct arena_mark mark = arena_mark(p->a);
    /* The perturbed case is a case of its own: its model and state are built from it as from a
     * file. */
    const struct vector_case *c = vector_perturb(p->c, moved, r, p->a);
    struct model *m = vector_model(c, p->a, e);
    if (!m) return false;
    system_prepare(m);
    const struct state *s = vector_state(c, m, p->a);
    for (int load = 0; load < LOADS; load++) wrenches_take(p, m, s, (enum load)load);
    verify_answers_compute(x, c, m, s, PRECISION_QUAD, p->a, y);
    /* A sample in which articulated bodies break down says nothing of accelerations. */
    bool forward = x->forward && put_forward(x, m, s, p->a, y, NULL);
    for (int i = 0; i < x->n; i++)
        if (i < x->at[VERIFY_QDD_FD] || forward)
            x->scale[i] = fmax(x->scale[i], fabs(y[i] - x->exact[i]) / moved);
    arena_release(p->a, mark);
    return true;
}

/* The exact wrenches in all four states, before any sample. */
static struct sampler sampler_make(struct verify_answers *x, const struct vector_case *c,
                                   const struct model *m, const struct state *s, struct arena *a)
{
    struct sampler p = {.x = x, .c = c, .a = a, .qdd = TAKE(a, c->nv + 1, double)};
    if (x->forward) memcpy(p.qdd, x->exact + x->at[VERIFY_QDD_FD], (size_t)c->nv * sizeof *p.qdd);
    for (int load = 0; load < LOADS; load++) {
        p.wrench[load] = TAKE(a, size_product(6, c->nbody), double);
        p.scale[load] = TAKE(a, size_product(2, c->nbody), double);
        wrenches_of(&p, m, s, (enum load)load, p.wrench[load]);
    }
    return p;
}

/* One scale for all numbers of a vector. What cannot move is zero; of 77 digits that cancel, some
 * 1e-77 is left. */
static void share(struct verify_answers *x)
{
    /* far below any digit of quad precision, far above what is left of zero */
    const double digits_left = 1e-50;
    for (int k = 0; k < VERIFY_QUANTITIES; k++) {
        double largest = 0;
        for (int i = x->at[k]; i < x->at[k + 1]; i++) largest = fmax(largest, fabs(x->exact[i]));
        for (int i = x->at[k]; i < x->at[k + 1]; i++)
            x->scale[i] = fmax(x->scale[i], digits_left * largest);
    }
    for (int i = 0; i < x->n; i++) x->scale[x->group[i]] = fmax(x->scale[x->group[i]], x->scale[i]);
    for (int i = 0; i < x->n; i++) x->scale[i] = x->scale[x->group[i]];
}

/* The list of answers, their exact values, then their scales: at least their own size, raised by
 * the samples, shared within vectors, mended where they cancel. */
bool verify_answers_make(struct verify_answers *x, const struct vector_case *c,
                         const struct model *m, const struct state *s, struct arena *a,
                         struct err *e)
{
    size_t room = room_for(c);
    *x = (struct verify_answers){.group = TAKE(a, room, int), .reference = TAKE(a, room, double),
                                 .exact = TAKE(a, room, double), .scale = TAKE(a, room, double),
                                 .part = TAKE(a, c->nv + 1, int)};
    /* Where the numbers of each quantity begin; at[VERIFY_QUANTITIES] is the end of the last. */
    parts_find(x, c);
    for (int k = 0; k < VERIFY_QUANTITIES; k++) {
        x->at[k] = x->n;
        append_quantity(x, c, (enum verify_quantity)k);
    }
    x->at[VERIFY_QUANTITIES] = x->n;
    verify_answers_compute(x, c, m, s, PRECISION_QUAD, a, x->exact);
    x->forward = c->qdd_fd && put_forward(x, m, s, a, x->exact, &x->redundant);
    /* Scales: each sample can only raise them, so their order does not count. */
    for (int i = 0; i < x->n; i++) x->scale[i] = fabs(x->exact[i]);
    const struct sampler p = sampler_make(x, c, m, s, a);
    struct random r = random_make(1, 53, 0);
    double *y = TAKE(a, room, double);
    for (int k = samples_of(c); k > 0; k--)
        if (!sample(&p, &r, y, e)) return false;
    share(x);
    /* Last, as a shared scale may already have mended a number. */
    forces_mend(&p, VERIFY_TAU_ID, LOAD_INVERSE);
    forces_mend(&p, VERIFY_BIAS, LOAD_BIAS);
    forces_mend(&p, VERIFY_GRAVITY_TORQUE, LOAD_REST);
    accelerations_mend(&p, m, s, &r, y);
    return true;
}

/* --- judging ---------------------------------------------------------------------------------- */

/* A number that no input can move must be exact: any difference is infinite. */
double verify_answers_error(const struct verify_answers *x, enum verify_quantity k, const double *y)
{
    const double *reference = x->reference + x->at[k], *scale = x->scale + x->at[k];
    double error = 0;
    for (int i = 0; i < count_of(x, k); i++) {
        double difference = fabs(y[i] - reference[i]);
        if (!isfinite(y[i]) || (difference > 0 && scale[i] == 0)) return INFINITY;
        if (difference > 0) error = fmax(error, difference / scale[i]);
    }
    return error;
}

/* The usual measure: the largest difference over the largest number. */
double verify_answers_plain(const struct verify_answers *x, enum verify_quantity k, const double *y)
{
    const double *reference = x->reference + x->at[k];
    double difference = 0, scale = 0;
    for (int i = 0; i < count_of(x, k); i++) {
        if (!isfinite(y[i])) return INFINITY;
        difference = fmax(difference, fabs(y[i] - reference[i]));
        scale = fmax(scale, fabs(reference[i]));
    }
    return scale > 0 ? difference / scale : difference;
}

bool verify_answers_tells(const struct verify_answers *x, enum verify_quantity k, double tolerance)
{
    /* Every number is zero and none can move: then a zero is a right answer. */
    bool fixed = true; /* nothing moves: all are zero, and exactly so */
    for (int i = x->at[k]; i < x->at[k + 1]; i++) {
        if (fabs(x->exact[i]) > 10 * tolerance * x->scale[i]) return true;
        fixed = fixed && x->scale[i] == 0;
    }
    return fixed;
}
