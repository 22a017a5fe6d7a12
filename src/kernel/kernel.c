/* kernel.c - the table of the dynamics kernels, in three precisions and two spaces. */
#include "kernel/kernel.h"

#include <string.h>

/* What each precision's archive defines (dynamics_kernel.h, seen from outside any precision): the
 * same sources compiled for float, double and quad, in six and in three components. */
extern const struct kernel_type inverse_kernel_f32, inverse_kernel_f64, inverse_kernel_f128;
extern const struct kernel_type forward_kernel_f32, forward_kernel_f64, forward_kernel_f128;
extern const struct kernel_type dynamics_kernel_f32, dynamics_kernel_f64, dynamics_kernel_f128;
extern const struct kernel_type inverse_kernel_planar_f32, inverse_kernel_planar_f64,
    inverse_kernel_planar_f128;
extern const struct kernel_type forward_kernel_planar_f32, forward_kernel_planar_f64,
    forward_kernel_planar_f128;
extern const struct kernel_type dynamics_kernel_planar_f32, dynamics_kernel_planar_f64,
    dynamics_kernel_planar_f128;

/* One table for each combination; the order within a table is of no importance. */
static const struct kernel_type *const in_double[] = {&inverse_kernel_f64, &forward_kernel_f64,
                                                      &dynamics_kernel_f64};
static const struct kernel_type *const in_float[] = {&inverse_kernel_f32, &forward_kernel_f32,
                                                     &dynamics_kernel_f32};
static const struct kernel_type *const in_quad[] = {&inverse_kernel_f128, &forward_kernel_f128,
                                                    &dynamics_kernel_f128};
static const struct kernel_type *const planar_in_double[] = {
    &inverse_kernel_planar_f64, &forward_kernel_planar_f64, &dynamics_kernel_planar_f64};
static const struct kernel_type *const planar_in_float[] = {
    &inverse_kernel_planar_f32, &forward_kernel_planar_f32, &dynamics_kernel_planar_f32};
static const struct kernel_type *const planar_in_quad[] = {
    &inverse_kernel_planar_f128, &forward_kernel_planar_f128, &dynamics_kernel_planar_f128};
enum { NPLANAR = sizeof planar_in_double / sizeof planar_in_double[0] };
enum { NKERNEL = sizeof in_double / sizeof in_double[0] };

/* Three names: a search is as fast as anything. */
static const struct kernel_type *find(const struct kernel_type *const *table, int n,
                                      const char *name)
{
    for (int i = 0; i < n; i++)
        if (strcmp(table[i]->name, name) == 0) return table[i];
    return NULL;
}

const struct kernel_type *kernel_find_precision(const char *name, enum precision precision)
{
    return find(precision == PRECISION_FLOAT  ? in_float
                : precision == PRECISION_QUAD ? in_quad
                                              : in_double,
                NKERNEL, name);
}

/* The caller has made sure that the scene is planar (omission.c). */
const struct kernel_type *kernel_find_planar(const char *name, enum precision precision)
{
    return find(precision == PRECISION_FLOAT  ? planar_in_float
                : precision == PRECISION_QUAD ? planar_in_quad
                                              : planar_in_double,
                NPLANAR, name);
}

/* By name alone: what does not depend on precision (titles, needs) is the same in all tables. */
const struct kernel_type *kernel_find(const char *name)
{
    return kernel_find_precision(name, PRECISION_DOUBLE);
}
