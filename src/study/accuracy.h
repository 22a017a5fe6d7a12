/* accuracy.h - how wrong each cheaper answer is: three ladders of methods, error against time.
 *
 *   network      closed form, loggp, link, packet, flit, auto: simulated times against the finest
 * level arithmetic   precisions, algorithms, solvers, refinements: accelerations against quad
 * precision integration  steppers, tolerances, step sizes: the state at the end against a tight
 * reference
 *
 * Every rung has its cost twice: seconds of this computer, and predicted time on the simulated
 * machine. What fails is a rung too. */
#ifndef STUDY_ACCURACY_H
#define STUDY_ACCURACY_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/err.h"
#include "measure/study_row.h"
#include "spec/run_spec.h"

enum { ACCURACY_MOST_CHOICES = 8 };

struct accuracy_report {
    char scenario[64];
    int nrung, room;
    struct accuracy_rung *rung; /* in the arena */
    int nchoice;
    struct accuracy_choice choice[ACCURACY_MOST_CHOICES];
    double host_s[3];           /* wall time of each ladder */
    struct arena *arena;        /* borrowed */
};

/* accuracy_measure: the ladders of a scenario, each at the largest of its points that takes
 * seconds.
 *
 *   spec, nspec  in   the scenario's runs
 *   within       in   relative error asked for; 0: 2% of simulated times, 1e-10 of accelerations,
 * 1e-6 of states quiet        in   no progress a            in   memory of the report
 *
 *   Returns false with ERR_CONFIG or ERR_DATA when no ladder can be climbed. */
bool accuracy_measure(const struct run_spec *spec, int nspec, double within, bool quiet,
                      struct arena *a, struct accuracy_report *r, struct err *e);

/* accuracy_network: the network ladder alone, at the largest point of `spec` (nspec) that takes
 * seconds; no choices. accuracy_programs: the other two, whose choices rest on no seconds of this
 * computer, so that they may be climbed beside other work. Both return as accuracy_measure. */
bool accuracy_network(const struct run_spec *spec, int nspec, struct arena *a,
                      struct accuracy_report *r, struct err *e);
bool accuracy_programs(const struct run_spec *spec, int nspec, struct arena *a,
                       struct accuracy_report *r, struct err *e);

/* accuracy_append: rungs (n) of another report on the same scenario, behind those of `r`.
 * accuracy_decide: the choices of all ladders in `r`, once; `within` as for accuracy_measure. */
void accuracy_append(struct accuracy_report *r, const struct accuracy_rung *rung, int n);
void accuracy_decide(struct accuracy_report *r, double within);

/* accuracy_choose: the cheapest rung of ladder `ladder` for `quantity` with status ok and error <=
 * tolerance. Cost is the host's time on the network ladder, the machine's on the others; rungs
 * without a cost are passed over. */
struct accuracy_choice accuracy_choose(const struct accuracy_report *r, const char *ladder,
                                       const char *quantity, double tolerance);

/* accuracy_print: all rungs as tables, then one line a ladder. accuracy_print_json: the same as one
 * document. */
void accuracy_print(FILE *out, const struct accuracy_report *r);
void accuracy_print_json(FILE *out, const struct accuracy_report *r);

#endif
