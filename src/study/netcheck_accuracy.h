/* netcheck_accuracy.h - the stated accuracy of each network level, by class of case. */
#ifndef STUDY_NETCHECK_ACCURACY_H
#define STUDY_NETCHECK_ACCURACY_H

#include "study/netcheck.h"

/* How far a level's answers of one class may be from the reference's, relative to the reference. */
struct netcheck_accuracy {
    const char *levels; /* "flit", "packet, auto" */
    const char *cases;  /* the class in words */
    double mean;        /* largest mean of |error| over many cases */
    double low, high;   /* least and largest error of one case */
    double message;     /* largest |error| of one message's arrival; 0: every arrival is the
                           reference's;     -1: messages have no reference */
};

/* netcheck_accuracies: entry i of the table, NULL after the last: the one place where the figures
 * stand. */
const struct netcheck_accuracy *netcheck_accuracies(int i);

/* netcheck_accuracy_of: the entry that holds for a row at `level`; never NULL. */
const struct netcheck_accuracy *netcheck_accuracy_of(const struct netcheck_row *row,
                                                     enum network_level level);

#endif
