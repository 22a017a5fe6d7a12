/* collective_rules.h - which algorithm a machine's software takes for which collective, as a text.
 *
 *     allreduce recursive-doubling; allreduce rabenseifner from 2 KiB on 8 ranks
 *
 * Rules stand between semicolons or commas, all in brackets or not: collective, algorithm, and from
 * which size and number of ranks on; the last one that matches counts (collectives.h says what a
 * size is). */
#ifndef COMM_COLLECTIVE_RULES_H
#define COMM_COLLECTIVE_RULES_H

#include "comm/collectives.h"

enum { COLLECTIVE_MAX_RULES = 64 };

/* collective_rules_parse: `text` into at most COLLECTIVE_MAX_RULES rules (NULL: only look) and
 * their number *n.
 *
 *   Returns false with a clause in `why` (`size` bytes): what was expected, the nearest valid name.
 */
bool collective_rules_parse(const char *text, struct collective_rule *rule, int *n, char *why,
                            int size);

/* collective_rules_valid: whether it would read. collective_choice_valid: whether `text` is "auto"
 * or the name of some collective's algorithm. Clauses as above; for tables of settings. */
bool collective_rules_valid(const char *text, char *why, int size);
bool collective_choice_valid(const char *text, char *why, int size);

/* collective_algorithm_names: of one collective, "binomial, ring, ..." into `buffer`. */
void collective_algorithm_names(enum collective_kind kind, char *buffer, int size);

#endif
