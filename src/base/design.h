/* design.h - where to sample a unit cube: Sobol' and Halton sequences, Latin hypercubes, random
 * points.
 *
 * The sequences are GSL's (gsl_qrng.h). All are the same on every host, and a longer sequence
 * begins with the shorter one, but for Latin hypercubes. */
#ifndef BASE_DESIGN_H
#define BASE_DESIGN_H

#include <stdbool.h>
#include <stdint.h>

enum design { DESIGN_SOBOL, DESIGN_LATIN_HYPERCUBE, DESIGN_HALTON, DESIGN_RANDOM, DESIGNS };

/* design_name: "sobol", "latin-hypercube", "halton", "random". */
const char *design_name(enum design d);

/* design_dimensions: the most dimensions that a design has: 40 of Sobol', 1229 of Halton. */
int design_dimensions(enum design d);

/* design_fill: n points in k dimensions, k <= design_dimensions.
 *
 *   seed  in   sequences are moved by it as a whole (Cranley and Patterson 1976), 0: not at all
 *   u     out  (n x k) in [0, 1), point by point */
void design_fill(enum design d, uint64_t seed, int n, int k, double *u);

#endif
