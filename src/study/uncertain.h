/* uncertain.h - the parameters of a machine that are not known exactly, and values drawn from their
 * ranges.
 *
 * A range is the one that the machine's file prints. Where it prints none, the class of evidence
 * decides: a factor either way, the median of the ranges that the shipped files print for that
 * class: P 1.15, PR 1.4, D 1.6, E 1.7; of mixed classes the widest. Clocks and whole numbers
 * without a range are facts of the design, and what nobody gave evidence for is a default: neither
 * is drawn. */
#ifndef STUDY_UNCERTAIN_H
#define STUDY_UNCERTAIN_H

#include "base/arena.h"
#include "plan/plan.h"
#include "spec/field.h"
#include "spec/machine_spec.h"

struct uncertain {
    const char *key; /* network.link.bandwidth: without "machine." */
    const struct field *field;
    double low, high;     /* SI, low < high */
    const char *evidence; /* P, PR, D, E or mixed, "" */
    bool printed;         /* the file gives the range; else the class does */
};

/* Which ranges count. */
enum uncertain_ranges { UNCERTAIN_PRINTED, UNCERTAIN_ALL };

/* uncertain_list: the uncertain parameters among the n origins of a machine's values, in their
 * order.
 *
 *   at     in   of which machine: parameters of UNCERTAIN_ALL that are 0 there are not drawn
 *   list   out  in `a`
 *   Returns how many. */
int uncertain_list(const struct origin *o, int n, const struct machine_spec *at,
                   enum uncertain_ranges which, struct arena *a, struct uncertain **list);

/* uncertain_value: where x in [0, 1) lies in the range: even in the logarithm, as rates and times
 * are known by factors; even from a range that begins at 0. A whole number stays one. */
double uncertain_value(const struct uncertain *u, double x);

/* uncertain_number: the parameter's value in `m`; uncertain_apply: it becomes `value`. The run has
 * to be identified anew (identity.h). */
double uncertain_number(const struct uncertain *u, const struct machine_spec *m);
void uncertain_apply(const struct uncertain *u, double value, struct machine_spec *m);

/* uncertain_class_factor: the factor of a class of evidence such as "P/PR"; 0: of none. */
double uncertain_class_factor(const char *evidence);

#endif
