/* passes.h - points of a plan measured in several passes: a computer whose speed changes is found
 * out, and its slow times are not kept.
 *
 * The processors of a guest may share a core of their host with others, for seconds or minutes, and
 * a laptop changes its clock. What was measured under two conditions fits no one machine. So each
 * point is measured at the beginning and at the end, and the lesser time is kept; then those that
 * were slowed down both times are measured again. */
#ifndef REALITY_PASSES_H
#define REALITY_PASSES_H

#include "reality/rates.h"

/* A look at the computer's speed that is longer than another one by more than this part is of
 * another condition. */
#define PASSES_SAME 0.10

struct passes {
    int n;                              /* points */
    int made;                           /* passes so far */
    struct rate_sample kept[RATES_MOST]; /* (n) */
    double ratio[RATES_MOST];           /* (n) time of the second pass over that of the first */
};

/* passes_run: all points of plan `p` once more on one rank in this process, those alone that
 * passes_again names where `least` > 0; the lesser time is kept.
 *
 *   word  in  of the line of progress
 *
 *   Errors as rate_sample_take; ERR_BUSY in the first pass alone. */
bool passes_run(struct passes *x, const struct plan *p, const char *word, int samples,
                double seconds, double least, bool quiet, struct err *e);

/* passes_add: one more measurement of point i, which was made in pass number x->made (from 0). */
void passes_add(struct passes *x, int i, const struct rate_sample *again);

/* passes_least: the least time of a multiplication or addition before or after a kept point, or
 * `least` where that is less and > 0. passes_again: whether a point was measured while the computer
 * took more than PASSES_SAME longer for that than `least`, before or after. */
double passes_least(const struct passes *x, double least);
bool passes_again(const struct rate_sample *s, double least);

/* passes_changed: how many points of both took over PASSES_SAME longer in one of the first two
 * passes than in the other; *by: the median of these by which part, 0 where there are none. */
int passes_changed(const struct passes *a, const struct passes *b, double *by);

/* passes_slow: kept points that passes_again names. */
int passes_slow(const struct passes *x, double least);

/* passes_speed: how fast the computer was while the kept points were measured: the median of each
 * operation. All 0 without points. */
struct host_speed passes_speed(const struct passes *x);

#endif
