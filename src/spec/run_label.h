/* run_label.h - what a run is called in titles, legends and tables: a name that was given to it, or
 * its machine with what was changed of it.
 *
 * A machine on which something was changed is another machine. Its name says so: "t3e-300,
 * hop_latency 60 us". */
#ifndef SPEC_RUN_LABEL_H
#define SPEC_RUN_LABEL_H

#include "base/text.h"
#include "spec/field.h"

enum { LABEL_KEY_LENGTH = 16 }; /* digits of a machine's fingerprint */

/* field_short_key: the shortest end of `key` (a row of `t`) that no other row's key ends in and
 * that says something by itself: "hop_latency" of "network.hop_latency", but "placement.kind". A
 * part of `key`. */
const char *field_short_key(const struct field_table *t, const char *key);

/* run_label_changed: `name`, and what differs, appended: "t3e-300, hop_latency 60 us, topology.dims
 * 8x4x4".
 *
 *   changes  in  JSON object of keys without "machine." and values (run_spec.machine_changes); NULL
 * or not an object: none. Of more than three changes the others are counted, with a fingerprint of
 * all of them. */
void run_label_changed(const char *name, const char *changes, struct text *out);

/* run_label_made: what a run is called that nobody has named: its machine with `changes`, behind
 * "solver beside ring" where it tells of one of several jobs; appended. */
void run_label_made(const struct run_spec *run, const char *changes, struct text *out);

/* run_label: what `run` is called, appended: `called`, as the plan made it; else `label`; else its
 * machine with what was changed. */
void run_label(const struct run_spec *run, struct text *out);

/* run_size: ", n = 16, P = 4" of a run on `nrank` ranks, for titles and messages; without n where
 * its program has neither bodies nor a parameter n. */
struct run_size {
    char s[48];
};
struct run_size run_size(const struct run_spec *run, int nrank);

/* machine_fingerprint: LABEL_KEY_LENGTH digits of the SHA-256 of the machine's settings in `config`
 * (run_spec's config_text), without the level of the network and its tolerance, which ask something
 * of a machine: runs that have the same one ran on the same machine. */
void machine_fingerprint(const char *config, char hex[LABEL_KEY_LENGTH + 1]);

#endif
