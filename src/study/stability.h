/* stability.h - the suite of stiff and extreme scenes against every algorithm: what holds, what degrades, what fails.
 *
 * Accelerations are held against quad precision at the same inputs; motions against a tight reference. */
#ifndef STUDY_STABILITY_H
#define STUDY_STABILITY_H

#include <stdbool.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/err.h"
#include "measure/column.h"
#include "spec/run_spec.h"

enum stability_status { STABILITY_OK, STABILITY_DEGRADED, STABILITY_FAILED };

/* Why an acceleration is not ok: the same algorithm in quad precision is right to 1e-8, or is not. The second is a
 * failure of the algorithm on that scene; the row's reason names what answers it. */
enum stability_cause { CAUSE_UNKNOWN, CAUSE_ROUNDING, CAUSE_ALGORITHM };

struct stability_row {
    char subject[64], algorithm[40], precision[8];
    enum stability_status status; /* double: ok to 1e-8, degraded to 1e-2; float: 1e-3 and 1e-1 */
    double error;         /* relative; NaN: no number */
    double residual;      /* |tau - inverse dynamics(answer)| over the largest joint force, in quad precision; with
                             loops: of the constraints, as the algorithm sees it */
    double condition;     /* of the scene: change of the answer over that of the inputs; NaN: not measured */
    double growth;        /* of the reduction: largest diagonal element over its last pivot; NaN: none */
    int refinements;      /* corrections that were applied, inner and outer; -1: does not apply */
    double energy_drift;  /* of motions: change of the energy over the kinetic energy or what was exchanged; of
                             accelerations: power of the error, u . M (answer - reference), over the largest joint
                             force times the sum of |u|; NaN: at rest */
    double step_s;        /* of motions: largest stable or mean step, in the model's time; NaN otherwise */
    enum stability_cause cause; /* of accelerations that are not ok */
    char reason[192];
};

struct stability_report {
    char suite[64];             /* "suite" or the scenario's name */
    int nrow, room;
    struct stability_row *row;  /* in the arena */
    double host_s;
    struct arena *arena;        /* borrowed */
};

/* stability_measure: all rows. spec (nspec): the points of a scenario; NULL, 0: the built-in suite.
 *
 *   most_bodies  in  leave out larger scenes; 0: none
 *   a            in  memory of the report
 *
 *   Returns false with ERR_CONFIG or ERR_DATA when a scene cannot be built. */
bool stability_measure(const struct run_spec *spec, int nspec, int most_bodies, bool quiet, struct arena *a,
                       struct stability_report *r, struct err *e);

/* stability_print: a line a row, then the counts and the worst scene. stability_print_json: the same as one document.
 */
void stability_print(FILE *out, const struct stability_report *r);
void stability_print_json(FILE *out, const struct stability_report *r);

/* stability_columns: of struct stability_row, as the database has them, and as they are printed. */
extern const struct column_table stability_columns;

#endif
