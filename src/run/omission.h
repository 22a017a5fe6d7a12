/* omission.h - what a run does not compute because its scene does not need it, and how to compute it all the same.
 *
 * An omission is exact when every number of the answer (tau, q'', q and q' at the end, loop forces) is the same with it
 * and without; what only the simulator leaves out changes no simulated time either, though its events and so the digest
 * may differ. A bounded one changes the answer by less than its bound, relative to the answer's largest number.
 * --keep-all puts all of them back (KEEP_* of spec/run_spec.h). */
#ifndef RUN_OMISSION_H
#define RUN_OMISSION_H

#include "kernel/kernel.h"
#include "measure/run_result.h"
#include "mech/model.h"
#include "spec/run_spec.h"

/* omission_prepare: the scene that a job's kernel gets, and what it leaves out there, spec->keep obeyed: job->omit,
 * and job->state with what is put back. Needs job->spec, model and state (NULL: kernels without a model). */
void omission_prepare(struct kernel_job *job, struct state *s, struct arena *a);

/* omission_job: job->omit alone. */
struct job_omit omission_job(const struct run_spec *spec, const struct model *m, const struct state *s);

/* omission_list: those that act in this run whatever spec->keep says, into out (RUN_MAX_OMISSIONS). m, s NULL: kernels
 * without a model. Returns how many. */
int omission_list(const struct run_spec *spec, const struct kernel_type *kernel, const struct model *m,
                  const struct state *s, struct omission *out);

/* omission_note: those that spec->keep does not put back, into the result. */
void omission_note(const struct run_spec *spec, const struct kernel_type *kernel, const struct kernel_job *job,
                   struct run_result *out);

/* omission_largest_message, omission_machine, omission_record: what the world is told, with spec->keep obeyed. */
int64_t omission_largest_message(const struct run_spec *spec, const struct kernel_type *kernel,
                                 const struct kernel_job *job);
struct machine_spec omission_machine(const struct run_spec *spec);
struct record_spec omission_record(const struct run_spec *spec);

#endif
