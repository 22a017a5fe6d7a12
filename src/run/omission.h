/* omission.h - what a run does not record or simulate because nothing asks for it, and the list of
 * all that it leaves out, its program's part included.
 *
 * What the simulator alone leaves out changes no simulated time, though its events and so the
 * digest may differ.
 * --keep-all puts all of it back (KEEP_* of spec/run_spec.h). */
#ifndef RUN_OMISSION_H
#define RUN_OMISSION_H

#include "measure/run_result.h"
#include "program/program.h"
#include "spec/run_spec.h"

/* omission_listing: all that a run leaves out, after open, into out (RUN_MAX_OMISSIONS). Returns
 * how many. */
int omission_listing(const struct program_run *r, struct omission *out);

/* omission_largest_message, omission_machine, omission_record: what the world is told; `keep` of
 * the order (KEEP_*) is put back. */
int64_t omission_largest_message(const struct program_run *r);
struct machine_spec omission_machine(const struct run_spec *spec, unsigned keep);
struct record_spec omission_record(const struct run_spec *spec, unsigned keep);

#endif
