/* verify_rows.h - what the parts of verify share: the case under test and how a row is judged. */
#ifndef RUN_VERIFY_ROWS_H
#define RUN_VERIFY_ROWS_H

#include "dynamics/dynamics_table.h"
#include "model/model.h"
#include "model/vector.h"
#include "run/verify.h"

struct verify_case {
    const struct vector_case *vector;
    const struct verify_options *options;
    const struct model *model;    /* a body for each of the file's */
    const struct state *state;
    const struct model *lumped;   /* bodies on fixed joints made one with their parents; the same model without any */
    const struct state *lumped_state;
    struct verify_report *report;
    struct arena *arena;          /* of the case, given back at its end */
};

/* verify_error: max |x - ref| / max |ref|, absolute where ref is zero; INFINITY if an x is no number. */
double verify_error(const double *x, const double *ref, int n);

/* verify_error_beside: the same for an x that may cancel: measured by a thousandth of `scale`, the largest of what it
 * is made of, where ref is smaller. verify_largest: max |x|. */
double verify_error_beside(const double *x, const double *ref, int n, double scale);
double verify_largest(const double *x, int n);

/* verify_row_add: a new row with its algorithm and quantity, everything else zero. */
struct verify_row *verify_row_add(struct verify_case *v, const char *algorithm, const char *quantity);

/* verify_row_skip: a new row that says why the algorithm does not apply. */
void verify_row_skip(struct verify_case *v, const char *algorithm, const char *quantity, const char *why);

/* verify_tolerance_inverse, verify_tolerance_forward: what is asked for in this case. */
double verify_tolerance_inverse(const struct verify_case *v);
double verify_tolerance_forward(const struct verify_case *v);

/* verify_tolerance_robust: of the direct formulation with refinement. In extreme cases it must be as accurate as the
 * best library, unless that is better than ten roundings of the inputs or a few of the answer. */
double verify_tolerance_robust(const struct verify_case *v);

/* verify_error_vanishes: does an error `error` in double and `quad` in quad precision show that rounding causes it?
 * What is wrong stays wrong in any precision. verify_error_scales: the same from the error in single precision, where
 * the unit of rounding is 2^29 times larger. */
bool verify_error_vanishes(double error, double quad);
bool verify_error_scales(double error, double single);

/* verify_unfit_body: why constraint forces do not apply to m, as text in `why`; false when they do. */
bool verify_unfit_body(const struct model *m, char *why, int size);

/* The parts: rows of the serial algorithms, of the parallel kernels, of a trajectory. */
void verify_serial(struct verify_case *v);
bool verify_parallel(struct verify_case *v, struct err *e);
void verify_trajectory(struct verify_case *v);

#endif
