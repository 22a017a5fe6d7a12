/* dynamics_kernel.h - the kernels of multibody dynamics in the build's precision, for the table in
 * kernel.c. */
#ifndef KERNEL_DYNAMICS_KERNEL_H
#define KERNEL_DYNAMICS_KERNEL_H

#include "kernel/kernel.h"
#include "linalg/space.h"

/* inverse: parallel Newton-Euler; forward: constraint force algorithm; dynamics: both, a barrier
 * between them. */
extern const struct kernel_type inverse_kernel;
extern const struct kernel_type forward_kernel;
extern const struct kernel_type dynamics_kernel;

#endif
