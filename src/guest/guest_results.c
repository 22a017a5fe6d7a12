/* guest_results.c - see guest_results.h.
 *
 * On the host's heap and outside of simulated time: results are there to be checked. */
#include "guest/guest_results.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Room for `n` elements; those that are new are not numbers, and given by nobody. */
static void grow(struct guest_result *r, int64_t n)
{
    /* At least doubled, so that ranks may publish piece by piece. `given` says which
     * elements have come: a published NaN is a number that came. */
    if (n > r->capacity) {
        const int64_t capacity = n > 2 * r->capacity ? n : 2 * r->capacity;
        r->x = memory_resize(r->x, (size_t)capacity, sizeof *r->x);
        r->given = memory_resize(r->given, (size_t)capacity, 1);
        r->capacity = capacity;
    }
    for (int64_t i = r->n; i < n; i++) r->x[i] = NAN, r->given[i] = 0;
    if (n > r->n) r->n = n;
}

bool guest_results_put(struct guest_results *r, int output, int64_t first, int64_t n,
                       const double *data, char *why, int size)
{
    /* The comparison cannot wrap, since the limit is far below 2^63; what the message tells may. */
    if (first < 0 || n < 0 || first > GUEST_MOST_NUMBERS - n) {
        snprintf(why, (size_t)size, "publishes elements %lld to %lld of a result; expected 0 to %d",
                 (long long)first, (long long)((uint64_t)first + (uint64_t)n - 1),
                 GUEST_MOST_NUMBERS - 1);
        return false;
    }
    struct guest_result *to = &r->of[output];
    grow(to, first + n);
    /* Two ranks with different numbers for one element: whose would count? */
    for (int64_t i = 0; i < n; i++) {
        if (to->given[first + i]) {
            snprintf(why, (size_t)size, "publishes element %lld of a result again",
                     (long long)(first + i));
            return false;
        }
        to->given[first + i] = 1;
        to->x[first + i] = data[i];
    }
    return true;
}

/* -1: all elements up to the last have been published. */
int64_t guest_results_gap(const struct guest_result *r)
{
    const unsigned char *gap = r->n > 0 ? memchr(r->given, 0, (size_t)r->n) : NULL;
    return gap != NULL ? gap - r->given : -1;
}

/* The largest difference over the largest magnitude: relative to the result as a whole,
 * so that elements near zero do not spoil it. All zeros: the plain difference. */
double guest_results_difference(const struct guest_result *x, const struct guest_result *y)
{
    double largest = 0, scale = 0;
    if (x->n != y->n) return NAN;
    for (int64_t i = 0; i < x->n; i++) {
        const double d = fabs(x->x[i] - y->x[i]);
        /* Equal infinities differ by NaN, and that is told, too: no result should be infinite. */
        if (isnan(d)) return NAN;
        largest = fmax(largest, d);
        scale = fmax(scale, fabs(y->x[i]));
    }
    return scale > 0 ? largest / scale : largest;
}

void guest_results_clear(struct guest_results *r)
{
    for (int i = 0; i < MIMDSIM_OUTPUTS; i++) {
        free(r->of[i].x);
        free(r->of[i].given);
    }
    memset(r, 0, sizeof *r);
}
