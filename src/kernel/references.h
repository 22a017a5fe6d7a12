/* references.h - the serial answers and costs that a simulated run is held against. */
#ifndef KERNEL_REFERENCES_H
#define KERNEL_REFERENCES_H

#include "kernel/kernel.h"
#include "kernel/scene.h"
#include "measure/run_result.h"
#include "model/model.h"
#include "program/program.h"
#include "spec/run_spec.h"

/* references_check: compare the run's answers with the serial ones: tau with RNEA, qdd with ABA
 * (closed chains: with the articulated-body algorithm's bordered system). Fills out->error; a
 * relative error above the tolerance, or one that is no number, makes the run RUN_INVALID with its
 * text. Jobs that step in time compare the state at the end with the serial integrator's, of the
 * same rule and step; what may differ is what the forward dynamics may, grown as a small change of
 * the first state grows on the way. */
void references_check(const struct program_run *r, struct scene *scene, struct arena *scratch,
                      struct run_result *out);

/* references_loops: how many loop constraints there are, how many are independent, and how far the
 * state at the end of the run violates them. Without loops: nothing. */
void references_loops(const struct program_run *r, struct arena *scratch, struct run_result *out);

/* references_tolerance: the largest relative error of the accelerations that a correct program may
 * show for `n` bodies: the formulation's error growth (docs/accuracy.md), with two decades of room.
 * Where more is found, the error of the serial code of the same formulation on the same system
 * counts, with two decades too, up to 1e-2. */
double references_tolerance(const struct kernel_spec *k, int n);

/* references_tolerance_inverse: the same of the joint forces. */
double references_tolerance_inverse(const struct kernel_spec *k, int n);

/* references_baselines: predicted times, by `price`, of the serial codes on one node, and of the
 * whole parallel work on one processor (out->stage must be filled). CRBA's O(n^3) factorisation is
 * left out above OMISSION_CRBA_MOST; of the constraint force algorithm's work see omission.h. */
void references_baselines(const struct kernel_job *job, const struct kernel_type *kernel,
                          struct scene *scene, const struct work_price *price,
                          struct arena *scratch, struct run_result *out);

#endif
