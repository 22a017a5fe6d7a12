/* estimate.h - messages, bytes, flops and memory of the dynamics kernels by formula (physics 3.1, 4.5, 5). */
#ifndef KERNEL_ESTIMATE_H
#define KERNEL_ESTIMATE_H

#include "kernel/kernel.h"
#include "linalg/real.h"

/* estimate_inverse, estimate_forward, estimate_dynamics: of one evaluation (times the time steps) by the kernel of that
 * name. Messages and bytes are exact for open chains of equal joints, flops within a tenth. */
#define estimate_inverse REAL_NAME(estimate_inverse)
void estimate_inverse(const struct run_spec *spec, const struct model *model, struct kernel_estimate *out);
/* estimate_forward: see above. */
#define estimate_forward REAL_NAME(estimate_forward)
void estimate_forward(const struct run_spec *spec, const struct model *model, struct kernel_estimate *out);
/* estimate_dynamics: see above. */
#define estimate_dynamics REAL_NAME(estimate_dynamics)
void estimate_dynamics(const struct run_spec *spec, const struct model *model, struct kernel_estimate *out);

#endif
