/* range.h - a numeric setting between two values: {from: 100 MB/s, to: 1 GB/s, scale: log}. */
#ifndef PLAN_RANGE_H
#define PLAN_RANGE_H

#include "plan/setting.h"

struct range {
    const char *key; /* in full */
    const struct field *field;
    double low, high; /* SI, low < high */
    bool log;         /* even in the logarithm; by default where low > 0 */
    int line;
};

/* range_read: the range that the mapping `n` gives for `key`. Returns false with ERR_DATA: no
 * number, from not below to, scale: log from 0, an unknown key of the mapping. */
bool range_read(struct range *r, const char *key, const struct node *n, const char *file,
                struct arena *a, struct err *e);

/* range_text: the value at u (0: low, 1: high), rounded to four digits and within the range, as
 * text that setting_make takes; in `a`. */
const char *range_text(const struct range *r, double u, struct arena *a);

#endif
