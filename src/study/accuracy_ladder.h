/* accuracy_ladder.h - what the three ladders share; private to accuracy*.c. */
#ifndef STUDY_ACCURACY_LADDER_H
#define STUDY_ACCURACY_LADDER_H

#include "model/model.h"
#include "study/accuracy.h"

/* One ladder at one point of a scenario. */
struct ladder {
    struct accuracy_report *report;
    const char *name;
    char at[48], family[65];
    struct run_spec spec;
    struct model *model; /* NULL: the kernel needs none */
    struct state *state;
    struct arena *arena; /* scratch */
};

/* ladder_add: a new rung, failed until its maker says otherwise, error and costs unknown. The
 * pointer holds until the next is added. */
struct accuracy_rung *ladder_add(struct ladder *l, const char *method, const char *rung,
                                 const char *quantity, const char *reference);

/* ladder_grade: error and status: ok up to `fine`, degraded up to `poor`, otherwise failed. */
void ladder_grade(struct accuracy_rung *r, double error, double fine, double poor);

/* ladder_network, ladder_arithmetic, ladder_integration: climb. */
void ladder_network(struct ladder *l);
void ladder_arithmetic(struct ladder *l);
void ladder_integration(struct ladder *l);

#endif
