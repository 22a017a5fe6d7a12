/* design.c - see design.h.
 *
 * A sequence fills the cube evenly: n points of it estimate a mean with an error of nearly 1/n, of
 * random points with 1/sqrt(n). A Latin hypercube has each of n slices once in each dimension. */
#include "base/design.h"

#include <gsl/gsl_qrng.h>
#include <math.h>
#include <stdlib.h>

#include "base/check.h"
#include "base/random.h"

static const struct {
    const char *name;
    int dimensions;
} designs[DESIGNS] = {
    {"sobol", 40}, {"latin-hypercube", 100000}, {"halton", 1229}, {"random", 100000}};

/* Names as users write them. */
const char *design_name(enum design d) { return designs[d].name; }

int design_dimensions(enum design d) { return designs[d].dimensions; }

/* The sequence, and every dimension of it turned by a number of its own that follows from the
 * seed: the points stay as even, but are others. */
static void fill_sequence(const gsl_qrng_type *type, uint64_t seed, int n, int k, double *u)
{
    gsl_qrng *q = gsl_qrng_alloc(type, (unsigned)k);
    CHECK(q != NULL);
    for (int i = 0; i < n; i++) CHECK(gsl_qrng_get(q, &u[(size_t)i * (size_t)k]) == 0);
    gsl_qrng_free(q);
    for (int j = 0; j < k && seed != 0; j++) {
        struct random r = random_make(seed, (uint64_t)j, 0);
        const double turn = random_uniform(&r, 0, 1);
        for (int i = 0; i < n; i++) {
            double *x = &u[(size_t)i * (size_t)k + (size_t)j];
            *x += turn;
            *x -= floor(*x);
        }
    }
}

/* In each dimension a random order of the n slices, and a random place in each (McKay, Beckman and
 * Conover 1979). */
static void fill_hypercube(uint64_t seed, int n, int k, double *u)
{
    for (int j = 0; j < k; j++) {
        struct random r = random_make(seed, (uint64_t)j, 1);
        double *column = &u[j];
        for (int i = 0; i < n; i++) column[(size_t)i * (size_t)k] = i;
        for (int i = n - 1; i > 0; i--) {
            const size_t other = random_below(&r, (uint64_t)i + 1);
            const double kept = column[(size_t)i * (size_t)k];
            column[(size_t)i * (size_t)k] = column[other * (size_t)k];
            column[other * (size_t)k] = kept;
        }
        for (int i = 0; i < n; i++) {
            double *x = &column[(size_t)i * (size_t)k];
            *x = (*x + random_uniform(&r, 0, 1)) / n;
        }
    }
}

/* Every point has a stream of its own: more points do not change the first ones. */
static void fill_random(uint64_t seed, int n, int k, double *u)
{
    for (int i = 0; i < n; i++) {
        struct random r = random_make(seed, (uint64_t)i, 2);
        for (int j = 0; j < k; j++) u[(size_t)i * (size_t)k + (size_t)j] = random_uniform(&r, 0, 1);
    }
}

/* More dimensions than a sequence has would be a mistake of ours: callers ask first. */
void design_fill(enum design d, uint64_t seed, int n, int k, double *u)
{
    CHECK(k >= 1 && k <= design_dimensions(d) && n >= 0);
    switch (d) {
    case DESIGN_SOBOL:
        fill_sequence(gsl_qrng_sobol, seed, n, k, u);
        return;
    case DESIGN_HALTON:
        fill_sequence(gsl_qrng_halton, seed, n, k, u);
        return;
    case DESIGN_LATIN_HYPERCUBE:
        fill_hypercube(seed, n, k, u);
        return;
    default:
        fill_random(seed, n, k, u);
        return;
    }
}
