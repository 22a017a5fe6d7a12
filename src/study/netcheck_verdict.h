/* netcheck_verdict.h - whether the answers to a reference's cases keep the accuracy that is
 * stated. */
#ifndef STUDY_NETCHECK_VERDICT_H
#define STUDY_NETCHECK_VERDICT_H

#include "study/netcheck_accuracy.h"

/* netcheck_row_fails: whether the answer of `level` to a row breaks its stated accuracy, or, with
 * `within` >= 0, is further than that from the reference. why[160] (may be NULL) tells in what. A
 * row that was not answered, not counted or played does not fail; one whose reference contradicts
 * itself does. */
bool netcheck_row_fails(const struct netcheck_row *row, enum network_level level, double within,
                        char why[160]);

/* What is said of the rows of one group at one level. */
struct netcheck_verdict {
    int cases, failed; /* judged; of them failed */
    double mean;       /* of |error| */
    /* what it may be: the classes' mean, and for n cases (worst - mean) / sqrt(n) more */
    double mean_limit;
    double low, high;  /* the widest limits of its classes */
    bool pass;
    char why[160]; /* of the first row that fails, or of the mean; "" */
};

/* netcheck_verdict: of the rows of `group` (NULL: all) at `level`; within as of
 * netcheck_row_fails. */
struct netcheck_verdict netcheck_verdict(const struct netcheck *n, const char *group,
                                         enum network_level level, double within);

/* netcheck_pass: whether all groups at all levels pass and no reference contradicts itself. */
bool netcheck_pass(const struct netcheck *n, double within);

/* netcheck_opens_group: whether row i is the first of its group. */
bool netcheck_opens_group(const struct netcheck *n, int i);

#endif
