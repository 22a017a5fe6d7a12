/* lanes.h - `real` as several doubles side by side: one source computes as many scenes at once.
 *
 * A part of real.h, for builds with REAL_LANES. Every element sees the operations that a double
 * would see, in the same order and none of them contracted, so each has the bits of the serial
 * code. Their memory is not aligned: registers of every width are loaded from arrays of doubles. */
#ifndef LINALG_LANES_H
#define LINALG_LANES_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

typedef double real __attribute__((vector_size(8 * REAL_LANES), aligned(8)));
typedef int64_t real_mask __attribute__((vector_size(8 * REAL_LANES), aligned(8)));

#define LANES_JOIN(name, lanes) name##_f64x##lanes
#define LANES_NAME(name, lanes) LANES_JOIN(name, lanes)
#define REAL_NAME(name) LANES_NAME(name, REAL_LANES)

/* REAL: the same number in all lanes; nothing less zero keeps its bits, -0 too. */
#define REAL(x) ((double)(x) - (real){0})

/* real_all: a comparison holds in every lane. real_where: x where it holds, y elsewhere, by bits.
 */
static inline bool real_all(real_mask holds)
{
    int64_t all = -1;
    for (int k = 0; k < REAL_LANES; k++) all &= holds[k];
    return all != 0;
}
static inline real real_where(real_mask holds, real x, real y)
{
    return (real)(((real_mask)x & holds) | ((real_mask)y & ~holds));
}

/* real_sqrt: exact to the last bit in every lane, as IEEE 754 has it. */
static inline real real_sqrt(real x)
{
    for (int k = 0; k < REAL_LANES; k++) x[k] = sqrt(x[k]);
    return x;
}

#endif
