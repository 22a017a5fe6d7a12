/* shard.h - a part of a plan for one of several hosts: every run belongs to one shard, by its
 * identity. */
#ifndef APP_SHARD_H
#define APP_SHARD_H

#include <stdbool.h>

#include "base/err.h"
#include "spec/run_spec.h"

struct shard {
    int number, of; /* 1 .. of; of 0: everything */
};

/* shard_parse: "3/8"; NULL is everything. Returns false with ERR_USAGE. */
bool shard_parse(const char *text, struct shard *out, struct err *e);

/* shard_of: the shard (1 .. of) that the run belongs to. It depends on the run's identity and on
 * `of` alone, so every host finds the same, whatever else is in its plan. */
int shard_of(const struct run_spec *run, int of);

enum { RUN_NAME = 96 }; /* room for the name of a run */

/* run_name: "HASH-REP", what `mimdsim plan` calls a run and --point takes. */
void run_name(const struct run_spec *run, char out[RUN_NAME]);

/* shard_has: whether the run belongs to it. */
bool shard_has(const struct shard *s, const struct run_spec *run);

#endif
