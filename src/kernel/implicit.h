/* implicit.h - joint springs that a time step treats linearly implicitly (physics 9.0).
 *
 * With spring forces at the end of the step, tau = tau_0 - s u', s = h c + h^2 k, a joint's
 * acceleration is u' = s^-1 (tau_0 - H^T F): its force is unknown in every component, its row of
 * the constraint system is Q^T D Q + s^-1 on the components along H, Q = [H W]. Elimination begins
 * at F = H tau_0, where u' = 0. */
#ifndef KERNEL_IMPLICIT_H
#define KERNEL_IMPLICIT_H

#include "dynamics/algebra.h"
#include "dynamics/spring.h"
#include "kernel/kernel.h"
#include "model/model.h"

/* steps_implicitly: whether the job's time steps are linearly implicit. */
static inline bool steps_implicitly(const struct kernel_job *job)
{
    return kernel_spec_implicit(&job->spec->kernel);
}

/* implicit_step: h in the model's time; 0 when steps are explicit. */
static inline real implicit_step(const struct kernel_job *job)
{
    return steps_implicitly(job) ? (real)(job->spec->kernel.step_size / job->model->second) : 0;
}

#endif
