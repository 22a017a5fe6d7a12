/* made_run.h - hand-made specs and results for the tests of store and report: plausible, never
 * simulated. */
#ifndef SUPPORT_MADE_RUN_H
#define SUPPORT_MADE_RUN_H

#include "base/arena.h"
#include "measure/run_result.h"
#include "spec/run_spec.h"

/* made_spec: the defaults of all tables with this machine and n bodies on `nrank` ranks; hash and
 * text filled. */
struct run_spec made_spec(struct arena *a, const char *machine, int n, int nrank, int rep);

/* made_identity: fill config_text and config_hash anew after a change of `spec`. */
void made_identity(struct run_spec *spec, struct arena *a);

/* made_result: seven stages whose parts add up to the makespan on every rank; four baselines, two
 * checks. */
struct run_result made_result(struct arena *a, const struct run_spec *spec);

/* made_spans: add a timeline in which ranks k and k^1 exchange one message in every stage. */
void made_spans(struct run_result *r, struct arena *a);

#endif
