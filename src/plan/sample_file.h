/* sample_file.h - `sample:` of a sweep: points drawn from ranges and lists instead of their
 * product.
 *
 *     sweep:
 *       sample:
 *         points: 64
 *         method: sobol              # sobol, latin-hypercube, halton or random
 *         seed: 1
 *         of:
 *           machine.network.link.bandwidth: {from: 100 MB/s, to: 1 GB/s}
 *           kernel.solver: [cr, pcr]
 *
 * A sample is one axis: it combines with the others of the sweep. */
#ifndef PLAN_SAMPLE_FILE_H
#define PLAN_SAMPLE_FILE_H

#include "plan/scenario_file.h"

enum { SAMPLE_MAX_KEYS = 40 };

/* sample_file_read: the axis that the mapping `n` describes. Returns false with ERR_DATA, file and
 * line. */
bool sample_file_read(struct axis *x, const struct node *n, const char *file, struct arena *a,
                      struct err *e);

#endif
