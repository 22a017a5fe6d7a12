/* dense_work.h - what the serial algorithms cost in generic code: full 6x6 matrices, nothing exploited or kept.
 *
 * The baseline of a run with dense operators: inertias shifted (two products of 396) and inverted (432) in every call,
 * transforms as 6x6 matrices, projections on H and W as matrix products, physics 2.5. Counted by formula; one-degree
 * chains come to about 2000 (Newton-Euler), 3050 (articulated bodies) and 6500 (constraint forces) a body. */
#ifndef MECH_DENSE_WORK_H
#define MECH_DENSE_WORK_H

#include "base/work.h"
#include "mech/dynamics_table.h"

/* dense_work_inverse: adds to *w what one inverse dynamics of m costs. */
void dense_work_inverse(const struct model *m, struct work *w);

/* dense_work_forward: adds to *w what one forward dynamics by `method` costs (without loops and refinements). */
void dense_work_forward(const struct model *m, enum forward_method method, struct work *w);

#endif
