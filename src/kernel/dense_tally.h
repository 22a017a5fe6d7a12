/* dense_tally.h - operation counts of the serial codes when written with general 6x6 operators.
 *
 * The serial algorithms of room dynamics exploit the structure of rigid transforms and count what
 * they do. A parallel code with dense operators has to be held against serial codes of the same
 * style, which are tallied here: products of full matrices, inertias moved and inverted every time.
 * For a revolute joint: Newton-Euler 2000 flops a body, articulated bodies 3000, the constraint
 * force algorithm 6400. */
#ifndef KERNEL_DENSE_TALLY_H
#define KERNEL_DENSE_TALLY_H

#include "base/work.h"
#include "dynamics/dynamics_table.h"

/* dense_tally_inverse, dense_tally_forward: replace the flops and operator calls that the
 * structured code counted in *w for model m by those of the dense one; divisions, roots and sines
 * are the same in both. */
void dense_tally_inverse(const struct model *m, struct work *w);
void dense_tally_forward(const struct model *m, enum forward_method method, struct work *w);

#endif
