/* stability.h - the suite of stiff and extreme scenes against every algorithm: what holds, what
 * degrades, what fails.
 *
 * Accelerations are held against quad precision at the same inputs; motions against a tight
 * reference. */
#ifndef STUDY_STABILITY_H
#define STUDY_STABILITY_H

#include <stdbool.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/err.h"
#include "measure/study_row.h"
#include "spec/run_spec.h"

struct stability_report {
    char suite[64];             /* "suite" or the scenario's name */
    int nrow, room;
    struct stability_row *row;  /* in the arena */
    double host_s;
    struct arena *arena;        /* borrowed */
};

struct stability_options {
    int most_bodies; /* leave out larger scenes; 0: none */
    int first, scenes; /* of the built-in suite: the first scene, and how many; 0: all of them */
    /* processes that measure scenes, 0: as many as processors; no row depends on it */
    int workers;
    bool quiet;
};

/* stability_measure: all rows. spec (nspec): the points of a scenario; NULL, 0: the built-in suite.
 *
 *   a  in  memory of the report
 *
 *   Returns false with ERR_CONFIG or ERR_DATA when a scene cannot be built, ERR_INTERNAL when a
 * worker dies. */
bool stability_measure(const struct run_spec *spec, int nspec, const struct stability_options *o,
                       struct arena *a, struct stability_report *r, struct err *e);

/* stability_suite_size, stability_suite_bodies: the scenes of the built-in suite, and the bodies of
 * scene i. */
int stability_suite_size(void);
int stability_suite_bodies(int i);

/* stability_append: rows (n) of another report on the same suite, behind those of `r`. */
void stability_append(struct stability_report *r, const struct stability_row *row, int n);

/* stability_print: a line a row, then the counts and the worst scene. stability_print_json: the
 * same as one document. */
void stability_print(FILE *out, const struct stability_report *r);
void stability_print_json(FILE *out, const struct stability_report *r);

#endif
