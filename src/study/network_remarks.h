/* network_remarks.h - what the network of a plan's runs does in words: routing rules at each level,
 * ways around what failed, collectives that the network does itself. For `explain`. */
#ifndef STUDY_NETWORK_REMARKS_H
#define STUDY_NETWORK_REMARKS_H

#include <stdio.h>

#include "base/json.h"
#include "plan/plan.h"

/* network_remarks_print: lines for people: each rule once with the number of runs that have it,
 * what the level of the runs makes of it and leaves out, and the same of the other levels where
 * load or chance choose; then what failed, and collectives by "hardware" with their times. */
void network_remarks_print(const struct plan *p, FILE *out);

/* network_remarks_json: the members `collectives` and `routing` of the object that is open. The
 * caller keeps the order of keys: each writes one. */
void network_collectives_json(const struct plan *p, struct json *j);
void network_routing_json(const struct plan *p, struct json *j);

#endif
