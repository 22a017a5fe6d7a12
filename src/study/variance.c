/* variance.c - see variance.h.
 *
 * The mean is taken off before products are formed: the estimate of a first-order share is a
 * difference of products, and a large mean would drown it. */
#include "study/variance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/design.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/size.h"
#include "base/sorted.h"

enum { RESAMPLES = 200 }; /* of the bootstrap: its own error is 5 % of the standard error */

int64_t variance_rows(int n, int k) { return (int64_t)n * (k + 2); }

void variance_design(uint64_t seed, int n, int k, double *u)
{
    const size_t block = size_product(n, k);
    /* A and B side by side, so that they are independent of each other */
    const enum design d =
        2 * k <= design_dimensions(DESIGN_SOBOL) ? DESIGN_SOBOL : DESIGN_LATIN_HYPERCUBE;
    double *both = memory_zeroed(size_sum(size_product(2, block), 1), sizeof *both);
    design_fill(d, seed, n, 2 * k, both);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < k; j++) {
            const double a = both[(size_t)(2 * i) * (size_t)k + (size_t)j],
                         b = both[(size_t)(2 * i + 1) * (size_t)k + (size_t)j];
            const size_t at = (size_t)i * (size_t)k + (size_t)j;
            u[at] = a;
            u[block + at] = b;
            /* the sample of input m is A but for column m */
            for (int m = 0; m < k; m++) u[(size_t)(2 + m) * block + at] = m == j ? b : a;
        }
    free(both);
}

/* Sums over the n points, or over a resample of them. */
struct sums {
    double square, first, total; /* of (y - mean)^2 in A and B, of the two estimators */
};

static struct sums sums_of(int n, int input, const double *y, double mean, const int *chosen)
{
    const double *a = y, *b = y + n, *mixed = y + (size_t)(2 + input) * (size_t)n;
    struct sums s = {0};
    for (int i = 0; i < n; i++) {
        const int at = chosen != NULL ? chosen[i] : i;
        const double da = a[at] - mean, db = b[at] - mean, dm = mixed[at] - mean;
        s.square += 0.5 * (da * da + db * db);
        s.first += db * (dm - da);
        s.total += 0.5 * (da - dm) * (da - dm);
    }
    return s;
}

/* Standard errors by drawing the n points anew with repetition, the same draws for every input. */
static void bootstrap(int n, int input, const double *y, double mean, struct variance_share *share)
{
    int *chosen = memory_zeroed((size_t)n, sizeof *chosen);
    double sum[2] = {0}, square[2] = {0};
    int counted = 0;
    for (int r = 0; r < RESAMPLES; r++) {
        struct random stream = random_make(1, (uint64_t)r, (uint64_t)n);
        for (int i = 0; i < n; i++) chosen[i] = (int)random_below(&stream, (uint64_t)n);
        const struct sums s = sums_of(n, input, y, mean, chosen);
        if (s.square <= 0) continue;
        const double estimate[] = {s.first / s.square, s.total / s.square};
        for (int q = 0; q < 2; q++) {
            sum[q] += estimate[q];
            square[q] += estimate[q] * estimate[q];
        }
        counted++;
    }
    free(chosen);
    double error[2];
    for (int q = 0; q < 2; q++) {
        const double m = sum[q] / counted;
        error[q] = counted > 1 ? sqrt(fmax(square[q] / counted - m * m, 0)) : NAN;
    }
    share->first_error = error[0];
    share->total_error = error[1];
}

double variance_shares(int n, int k, const double *y, struct variance_share *share)
{
    double mean = 0;
    for (int i = 0; i < 2 * n; i++) mean += y[i] / (2 * n);
    const double whole = sums_of(n, 0, y, mean, NULL).square;
    for (int j = 0; j < k; j++) {
        share[j] = (struct variance_share){NAN, NAN, NAN, NAN};
        /* nothing varies: there is nothing to share */
        if (!(whole > 0)) continue;
        const struct sums s = sums_of(n, j, y, mean, NULL);
        share[j].first = s.first / whole;
        share[j].total = s.total / whole;
        bootstrap(n, j, y, mean, &share[j]);
    }
    return whole / n;
}

struct variance_band variance_band(int n, double *y)
{
    int finite = 0;
    for (int i = 0; i < n; i++)
        if (isfinite(y[i])) y[finite++] = y[i];
    if (finite == 0) return (struct variance_band){NAN, NAN, NAN, NAN, NAN, 0};
    sort_numbers(y, (size_t)finite);
    struct variance_band b = {.n = finite};
    for (int i = 0; i < finite; i++) b.mean += y[i] / finite;
    for (int i = 0; i < finite; i++) b.deviation += (y[i] - b.mean) * (y[i] - b.mean);
    b.deviation = finite > 1 ? sqrt(b.deviation / (finite - 1)) : NAN;
    b.low = sorted_quantile(y, finite, 0.05);
    b.median = sorted_quantile(y, finite, 0.5);
    b.high = sorted_quantile(y, finite, 0.95);
    return b;
}
