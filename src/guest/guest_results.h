/* guest_results.h - the numbers that ranks publish, by result, and how they differ from others. */
#ifndef GUEST_GUEST_RESULTS_H
#define GUEST_GUEST_RESULTS_H

#include <stdbool.h>
#include <stdint.h>

#include <mimdsim/program_abi.h>

enum { GUEST_MOST_NUMBERS = 1 << 28 }; /* of one result */

/* One result: as long as the last element that was published; the others are not numbers. */
struct guest_result {
    int64_t n, capacity;
    double *x;            /* (n), owned */
    unsigned char *given; /* (n) 1: published, owned */
};

struct guest_results {
    struct guest_result of[MIMDSIM_OUTPUTS];
};

/* guest_results_put: elements first .. first + n - 1 of result `output`. Returns false with a
 * clause in `why`: out of range, or published already. */
bool guest_results_put(struct guest_results *r, int output, int64_t first, int64_t n,
                       const double *data, char *why, int size);

/* guest_results_gap: the first element that nobody published, -1: none. */
int64_t guest_results_gap(const struct guest_result *r);

/* guest_results_difference: max |x - y| / max |y|; the difference itself where y is zero; NaN when
 * lengths differ or anything is not a number. */
double guest_results_difference(const struct guest_result *x, const struct guest_result *y);

/* guest_results_clear: give all back. */
void guest_results_clear(struct guest_results *r);

#endif
