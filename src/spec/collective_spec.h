/* collective_spec.h - which collectives a machine's network does by itself, and which runs use
 * that.
 *
 * A machine says it by network.collective.kinds, and of barriers by software.barrier.kind; programs
 * ask for it by the algorithm "hardware" (comm/collectives.h). */
#ifndef SPEC_COLLECTIVE_SPEC_H
#define SPEC_COLLECTIVE_SPEC_H

#include "comm/collectives.h"
#include "spec/run_spec.h"

/* collective_kinds_valid: whether `text` names collectives that a network may do (broadcast,
 * reduce, allreduce), divided by commas or blanks; else a clause in `why`. For tables of settings.
 */
bool collective_kinds_valid(const char *text, char *why, int size);

/* collective_hardware: what the network of `m` does; kinds is 0 where it does nothing. */
struct comm_hardware collective_hardware(const struct machine_spec *m);

/* collective_refusal: why `s` cannot be done by the algorithm "hardware" on machine `m`, as a
 * clause into `why`. */
void collective_refusal(const struct machine_spec *m, const struct collective_shape *s, char *why,
                        int size);

/* collective_rules_fit: whether each rule of software.collectives that says "hardware" is for a
 * collective that the network of `m` does; else a clause in `why`. */
bool collective_rules_fit(const struct machine_spec *m, char *why, int size);

/* collective_meets: whether a built-in program of this run may call a collective of the network. */
bool collective_meets(const struct run_spec *r);

#endif
