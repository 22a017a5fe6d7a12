/* compute.h - computing time that a program states itself.
 *
 * For MPI programs, and any other, that `mimdsim cc` compiles. With `program.cost: author` in the
 * scenario, or --set program.cost=author, this is all that computing costs; otherwise calls do
 * nothing. `mimdsim cc` defines __MIMDSIM__, so that the same source compiles elsewhere:
 *
 *     #ifdef __MIMDSIM__
 *     #include <mimdsim/compute.h>
 *     #else
 *     #define mimdsim_compute(flops, bytes) ((void)0)
 *     #endif
 *
 * Fortran: external mimdsim_compute; call mimdsim_compute(flops, bytes), two double precision. */
#ifndef MIMDSIM_COMPUTE_H
#define MIMDSIM_COMPUTE_H

#ifdef __cplusplus
extern "C" {
#endif

/* mimdsim_compute: this rank now takes the time of `flops` additions and multiplications and of
 * copying `bytes` bytes, on the node of the run's machine: at its node.flop_rate and
 * node.copy.bandwidth, one after the other, times program.factor. */
void mimdsim_compute(double flops, double bytes);

#ifdef __cplusplus
}
#endif

#endif
