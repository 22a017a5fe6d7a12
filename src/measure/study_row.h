/* study_row.h - the plain structs that studies of many runs produce: rungs of ladders, what was
 * chosen of them, grades of stability, savings of omissions. Each has its table of columns
 * (column.h), out of which the database is made. */
#ifndef MEASURE_STUDY_ROW_H
#define MEASURE_STUDY_ROW_H

#include <stdbool.h>
#include <stdint.h>

#include "measure/column.h"
#include "measure/run_result.h"

/* A rung of a ladder of methods: its error, and its cost twice (study/accuracy.h). */
enum rung_status { RUNG_OK, RUNG_DEGRADED, RUNG_FAILED };

struct accuracy_rung {
    char ladder[16], at[48];  /* "network", "n=P=128" */
    char family[65];          /* runs alike but for their size: level_choice.h */
    char method[48], rung[32];/* a curve, and a point on it */
    char quantity[24], reference[40];
    double error;             /* relative; NaN: failed */
    double host_s;            /* NaN: not measured */
    int64_t machine_ps;       /* predicted; -1: the machine file has no cost for it */
    enum rung_status status;
    char text[160];           /* why it failed; processors used */
};

/* The cheapest rung that is good enough. */
struct accuracy_choice {
    const char *ladder, *at, *quantity;
    double tolerance;
    const struct accuracy_rung *rung, *finest; /* rung NULL: none is within the tolerance */
    double cost_ratio;                         /* cost of the finest over that of the rung */
};

/* An algorithm on a scene (study/stability.h). */
enum stability_status { STABILITY_OK, STABILITY_DEGRADED, STABILITY_FAILED };

/* Why an acceleration is not ok: the same algorithm in quad precision is right to 1e-8, or is not.
 * The second is a failure of the algorithm on that scene; the row's reason names what answers
 * it. */
enum stability_cause { CAUSE_UNKNOWN, CAUSE_ROUNDING, CAUSE_ALGORITHM };

struct stability_row {
    char subject[64], algorithm[40], precision[8];
    enum stability_status status; /* double: ok to 1e-8, degraded to 1e-2; float: 1e-3 and 1e-1 */
    double error;         /* relative; NaN: no number */
    double residual;      /* |tau - inverse dynamics(answer)| over the largest joint force, in quad
                             precision; with loops: of the constraints, as the algorithm sees
                             it */
    /* of the scene: change of the answer over that of the inputs; NaN: not measured */
    double condition;
    /* of the reduction: largest diagonal element over its last pivot; NaN: none */
    double growth;
    int refinements;      /* corrections that were applied, inner and outer; -1: does not apply */
    double energy_drift;  /* of motions: change of the energy over the kinetic energy or what was
                             exchanged; of  accelerations: power of the error, u . M (answer -
                             reference), over the largest joint  force times the sum of |u|; NaN: at
                             rest */
    /* of motions: largest stable or mean step, in the model's time; NaN otherwise */
    double step_s;
    enum stability_cause cause; /* of accelerations that are not ok */
    char reason[192];
};

/* What an omission saves, measured (study/savings.h). */
struct saving {
    struct omission omission;
    char at[48];              /* the point where it was measured: "n=P=128" */
    bool measured;            /* false: nothing brings it back */
    double host_s;            /* of the run without it, references included [s] */
    double host_saved_s;      /* below noise_s in size: cannot be told from nothing */
    double noise_s;           /* how far two such times differ by chance */
    int64_t machine_ps, machine_saved_ps; /* predicted */
};

/* The columns of the structs, as the database has them, and as they are printed. */
extern const struct column_table accuracy_rung_columns, accuracy_choice_columns, stability_columns,
    saving_columns;

#endif
