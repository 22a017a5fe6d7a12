/* verify_answers.h - the answers of a reference vector as one list of numbers, each with the scale
 * it is measured by.
 *
 * The scale of a number is how far the exact answer moves when the inputs move by one rounding, in
 * units of that rounding: the answer's condition times its size. Numbers that are one vector - the
 * force, or the moment, of one joint or body - share the largest scale among them; nothing else
 * does. An error of 1e-12 times the scale is what a change of the inputs by 1e-12 of themselves
 * would make. */
#ifndef STUDY_VERIFY_ANSWERS_H
#define STUDY_VERIFY_ANSWERS_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"
#include "model/model.h"
#include "model/vector.h"
#include "spec/kernel_spec.h"

enum verify_quantity {
    VERIFY_TAU_ID,
    VERIFY_BIAS,
    VERIFY_GRAVITY_TORQUE,
    VERIFY_WRENCH,
    VERIFY_FK,
    VERIFY_KINETIC,
    VERIFY_POTENTIAL,
    VERIFY_LINEAR,
    VERIFY_ANGULAR,
    VERIFY_COM,
    VERIFY_TOTAL_MASS,
    VERIFY_MASS_MATRIX,
    VERIFY_QDD_FD,
    VERIFY_LAMBDA,
    VERIFY_QUANTITIES
};

struct verify_answers {
    int n;                           /* numbers altogether */
    /* where each quantity begins; none: the file does not hold it */
    int at[VERIFY_QUANTITIES + 1];
    int *group;                      /* (n) first number of the vector that it is part of */
    /* (nv) the same for degrees of freedom: one joint's linear or angular part */
    int *part;
    double *reference;               /* (n) as the file has them */
    /* (n) in quad precision; accelerations by articulated bodies */
    double *exact;
    double *scale;                   /* (n) */
    bool forward;                    /* exact accelerations were found */
    /* constraints of loops that others imply: with any, loop forces are not unique */
    int redundant;
};

/* verify_answers_make: the answers of c with their exact values and scales; memory from `a`. m, s:
 * its model and state. Returns false with *e set when a perturbed model cannot be built. */
bool verify_answers_make(struct verify_answers *x, const struct vector_case *c,
                         const struct model *m, const struct state *s, struct arena *a,
                         struct err *e);

/* verify_answers_compute: all but accelerations and loop forces in `precision` into y (x->n). */
void verify_answers_compute(const struct verify_answers *x, const struct vector_case *c,
                            const struct model *m, const struct state *s, enum precision precision,
                            struct arena *a, double *y);

/* verify_answers_error: the largest |y - reference| / scale of quantity k; y holds its numbers
 * alone. INFINITY when one is no number, or differs where the inputs cannot move the answer.
 * verify_answers_plain: max |y - reference| over max |reference|: what is quoted of other
 * libraries. */
double verify_answers_error(const struct verify_answers *x, enum verify_quantity k,
                            const double *y);
double verify_answers_plain(const struct verify_answers *x, enum verify_quantity k,
                            const double *y);

/* verify_answers_tells: is some number of quantity k larger than ten tolerances times its scale, or
 * none free to move? Where none is, a wrong answer cannot be told from a rounded one. */
bool verify_answers_tells(const struct verify_answers *x, enum verify_quantity k, double tolerance);

/* verify_quantity_name: the key in the file: "tau_id", "energy.kinetic", ... */
const char *verify_quantity_name(enum verify_quantity k);

#endif
