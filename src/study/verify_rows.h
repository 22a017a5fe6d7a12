/* verify_rows.h - what the parts of verify share: the case under test and how a row is judged. */
#ifndef STUDY_VERIFY_ROWS_H
#define STUDY_VERIFY_ROWS_H

#include "dynamics/dynamics_table.h"
#include "model/model.h"
#include "model/vector.h"
#include "study/verify.h"
#include "study/verify_answers.h"

struct verify_case {
    const struct vector_case *vector;
    const struct verify_options *options;
    const struct model *model;    /* a body for each of the file's */
    const struct state *state;
    /* bodies on fixed joints made one with their parents; the same model without any */
    const struct model *lumped;
    const struct state *lumped_state;
    struct verify_answers answers;
    /* the same scene without extremes of mass and inertia; made by verify_even */
    struct verify_case *even;
    struct verify_report *report;
    struct arena *arena;          /* of the case, given back at its end */
};

/* verify_row_add: a new row with its algorithm and quantity, everything else zero. */
struct verify_row *verify_row_add(struct verify_case *v, const char *algorithm,
                                  const char *quantity);

/* verify_loops_skip: a new row that says why loop forces are not compared, when loops are redundant
 * in quad precision; whatever an algorithm says of its own rank. Returns whether they are. */
bool verify_loops_skip(struct verify_case *v, const char *algorithm);

/* verify_row_skip: a new row that says why the algorithm does not apply. */
void verify_row_skip(struct verify_case *v, const char *algorithm, const char *quantity,
                     const char *why);

/* verify_row_judge: error, tolerance and verdict of an answer y to quantity k (its numbers alone):
 * pass or fail; not applicable where rounding of the inputs alone could double or remove what is
 * compared. */
void verify_row_judge(const struct verify_case *v, struct verify_row *row, enum verify_quantity k,
                      const double *y, double tolerance);

/* verify_row_refuted: does the exact answer, articulated bodies in quad precision, miss the file's
 * by more than the tolerance of a row that says fail? Then the row's note says so, and nothing
 * excuses it. */
bool verify_row_refuted(const struct verify_case *v, struct verify_row *row,
                        enum verify_quantity k);

/* verify_row_explain: the verdict of a row above its tolerance that is not refuted, from the same
 * algorithm's error in quad precision: rounding when that meets the row's tolerance; else a failure
 * of the algorithm, when it is right
 * (`sane`) about the scene without extremes; else fail. */
void verify_row_explain(struct verify_row *row, double quad, bool sane);

/* verify_tolerance_inverse, verify_tolerance_forward: what is asked for in the precision under
 * test. */
double verify_tolerance_inverse(const struct verify_options *o);
double verify_tolerance_forward(const struct verify_options *o);

/* verify_lump: v->lumped and its state: bodies on fixed joints made one with their parents when
 * constraint forces need it. False with *e set when that makes no sense. */
bool verify_lump(struct verify_case *v, struct err *e);

/* verify_even: the scene without extremes, v->even, with exact accelerations as its reference.
 * False with *e set. */
bool verify_even(struct verify_case *v, struct err *e);

/* verify_even_right: is qdd (nu) right about that scene? Any precision is good to eight digits
 * there. */
bool verify_even_right(const struct verify_case *v, const double *qdd);

/* verify_unfit_body: why constraint forces do not apply to m, as text in `why`; false when they
 * do. */
bool verify_unfit_body(const struct model *m, char *why, int size);

/* The parts: rows of the serial algorithms, of the parallel kernels, of the URDF file, of a
 * trajectory. False with *e set when something that the file names cannot be used. */
bool verify_serial(struct verify_case *v, struct err *e);
bool verify_parallel(struct verify_case *v, struct err *e);
bool verify_urdf(struct verify_case *v, struct err *e);
bool verify_trajectory(struct verify_case *v, struct err *e);

#endif
