/* probe_collective.h - collectives and rings of neighbours as benchmarks measure them on a
 * simulated machine; part of probe.h, whose bench it is given. */
#ifndef STUDY_PROBE_COLLECTIVE_H
#define STUDY_PROBE_COLLECTIVE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/err.h"
#include "study/probe.h"

/* probe_collective: the quantities PROBE_BROADCAST to PROBE_B_EFF of `ranks` ranks into *value
 * (SI), at the machine's own level, alone on the machine.
 *
 *   b_eff after Rabenseifner and Koniges (2001): 21 sizes from 1 B to `bytes`, twelve in powers of
 * two up to 4 KiB and the rest evenly spaced in their logarithm; six patterns of rings in the order
 * of ranks and six in random order, of 2, 4, 8, max(16, P/4), max(32, P/2) and P ranks; the mean
 * over the sizes, the logarithmic mean over the patterns of each order, and of the two orders. The
 * exchange is of non-blocking messages.
 *
 *   Returns false with ERR_CONFIG as run_one. */
bool probe_collective(const struct machine_spec *m, enum probe_quantity q, int64_t bytes, int ranks,
                      double *value, struct err *e);

#endif
