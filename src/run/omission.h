/* omission.h - what a run does not compute because its scene does not need it, and how to compute it all the same.
 *
 * An omission is exact: every result is the same bits with it and without, which --keep-all shows by putting all of
 * them back. */
#ifndef RUN_OMISSION_H
#define RUN_OMISSION_H

#include "kernel/kernel.h"
#include "run/run.h"

/* omission_list: those that act in this run, into out->omission. m NULL: kernels without a model. */
void omission_list(const struct run_spec *spec, const struct kernel_type *kernel, const struct model *m,
                   struct run_estimate *out);

/* omission_largest_message, omission_machine, omission_record: what the world is told, with spec->keep obeyed. */
int64_t omission_largest_message(const struct run_spec *spec, const struct kernel_type *kernel,
                                 const struct kernel_job *job);
struct machine_spec omission_machine(const struct run_spec *spec);
struct record_spec omission_record(const struct run_spec *spec);

#endif
