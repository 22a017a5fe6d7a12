/* dynamics_table.h - the serial algorithms behind one table per precision, double in and out.
 *
 * This is the door for whoever does not compute in `real`: run (references of a simulated answer),
 * app (verify), report (accuracy). Answers are rounded to double at the very end. */
#ifndef DYNAMICS_DYNAMICS_TABLE_H
#define DYNAMICS_DYNAMICS_TABLE_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/work.h"
#include "model/model.h"
#include "spec/kernel_spec.h"

/* The serial ways from joint forces to accelerations. */
enum forward_method {
    FORWARD_ABA,
    FORWARD_CRBA,
    FORWARD_CRBA_SPARSE,
    FORWARD_CFA_PAPER,
    FORWARD_CFA_DIRECT,
    FORWARD_CFA_ROBUST, /* direct, inner and outer refinement; articulated bodies where that fails
                         */
    FORWARD_METHODS
};

/* Loops are closed by every method: cfa-* by the bordered system, the others by columns of M^-1
 * J^T. */
struct forward_report {
    double residual;             /* see cfa_report */
    int rank, nrow;
    int refined;                 /* cfa-robust: corrections applied, inner and outer */
    bool fell_back;              /* cfa-robust: articulated bodies had to solve it */
};

struct dynamics_totals {
    double kinetic, potential, linear[3], angular[3], mass, com[3];
};

enum { POSE_NUMBERS = 24 };

/* The neighbours of a part of a chain (model_part): numbers from and for the one towards the tip or
 * the base. Each returns false when the neighbour does not answer. */
struct part_ends {
    const void *context;
    bool (*take)(const void *context, bool tip, double *x, int n);
    bool (*give)(const void *context, bool tip, const double *x, int n);
};

struct held; /* a model in a state, in some precision; opaque */

struct dynamics_type {
    const char *name;            /* "float", "double", "quad" */
    double epsilon;

    /* inverse: tau (nu) for s->qdd, loops cut open: what actuators and springs do together. */
    void (*inverse)(const struct model *m, const struct state *s, struct arena *scratch,
                    double *tau, struct work *w);

    /* inverse_part: the same of a part of a chain of revolute joints, all parts together: how the
     * body before its first one moves is taken from the side of the base, how its last one moves
     * given to that of the tip, and forces go the other way. tau and work are those of the bodies
     * that are here, and the same bits as inverse has for them. False: a neighbour is silent. */
    bool (*inverse_part)(const struct model *m, const struct state *s,
                         const struct part_ends *ends, struct arena *scratch, double *tau,
                         struct work *w);

    /* forward_part: qdd of the same parts by articulated bodies, springs included; inertias go from
     * tip to base besides. *found: the method did not break down here; whether it did elsewhere is
     * not known. False: a neighbour is silent. */
    bool (*forward_part)(const struct model *m, const struct state *s,
                         const struct part_ends *ends, struct arena *scratch, double *qdd,
                         bool *found, struct work *w);

    /* hold, inverse_held: inverse for many accelerations qdd (nu) of one state: bodies' constants
     * and the state in this precision are made once, in `a`; no work is counted. */
    struct held *(*hold)(const struct model *m, const struct state *s, struct arena *a);
    void (*inverse_held)(struct held *h, const double *qdd, double *tau);

    /* forward: qdd (nu) for s->tau plus springs; lambda (nrow) and report may be NULL. False: the
     * method broke down (singular pivot) or does not apply (constraint forces with massless
     * bodies). */
    bool (*forward)(const struct model *m, const struct state *s, enum forward_method method,
                    struct arena *scratch, double *qdd, double *lambda,
                    struct forward_report *report, struct work *w);

    /* mass_matrix: (nu x nu) row-major at s->q. */
    void (*mass_matrix)(const struct model *m, const struct state *s, struct arena *scratch,
                        double *mass, struct work *w);

    /* wrenches: (nbody x 6) [force; moment] that each joint transmits to its body from the parent
     * when inverse dynamics gives s->qdd: user's body axes, about the body's origin. */
    void (*wrenches)(const struct model *m, const struct state *s, struct arena *scratch,
                     double *wrench);

    /* kinematics: (nbody x POSE_NUMBERS) of each body, world axes: rotation (9) to world, position,
     * velocity, angular velocity, acceleration (without gravity), angular acceleration (3 each). */
    void (*kinematics)(const struct model *m, const struct state *s, struct arena *scratch,
                       double *pose);

    /* totals: energy (springs included), momentum, centre of mass. */
    void (*totals)(const struct model *m, const struct state *s, struct arena *scratch,
                   struct dynamics_totals *t);

    /* advance: move s->q, s->qd by `steps` fixed steps of h; false when the dynamics broke down. */
    bool (*advance)(const struct model *m, struct state *s, enum step_rule rule, double h,
                    int steps, struct arena *scratch, struct work *w);

    /* drift: largest violation of the loops' position and velocity constraints. */
    void (*drift)(const struct model *m, const struct state *s, struct arena *scratch,
                  double *position, double *velocity);
};

/* dynamics_type_of: the table of a precision. */
const struct dynamics_type *dynamics_type_of(enum precision precision);

/* forward_method_name: "aba", "crba", "crba-sparse", "cfa-paper", "cfa-direct", "cfa-robust". */
const char *forward_method_name(enum forward_method method);

#endif
