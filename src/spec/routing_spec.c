/* routing_spec.c - what is known of a routing rule by its line of the list.
 *
 * The rules themselves are in room machine, which this room must not know: settings, identities and
 * reasons why a setting is idle need no more than the words and whether chance plays a part. A new
 * rule is a line of the list and an entry in one of machine's tables. */
#include "spec/machine_spec.h"

/* As users write it, and as results show it. */
const char *routing_rule_name(enum routing_rule rule)
{
    static const char *const name[] = {
#define X(constant, word, chance, doc) [constant] = word,
        ROUTING_LIST(X)
#undef X
    };
    return name[rule];
}

/* As `explain` says it: a clause without an end, so that a sentence can go on behind it. The rules
 * in full, with what keeps each free of deadlock, are in docs/network.md. */
const char *routing_rule_doc(enum routing_rule rule)
{
    static const char *const words[] = {
#define X(constant, word, chance, doc) [constant] = doc,
        ROUTING_LIST(X)
#undef X
    };
    return words[rule];
}

/* Chance or load: repetitions of a run with other seeds may then differ. Loads alone would be the
 * same in each, but every rule by load also draws: of equal queues, or the router to go through. */
bool routing_rule_chance(enum routing_rule rule)
{
    static const bool by[] = {
#define X(constant, word, chance, doc) [constant] = chance,
        ROUTING_LIST(X)
#undef X
    };
    return by[rule];
}
