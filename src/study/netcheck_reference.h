/* netcheck_reference.h - BookSim's networks as this program's: its routing rules by name, its
 * numbering of nodes, its files of routers. */
#ifndef STUDY_NETCHECK_REFERENCE_H
#define STUDY_NETCHECK_REFERENCE_H

#include "study/netcheck_rows.h"

/* A network of the reference. */
struct netcheck_reference {
    struct topology_spec topology;
    enum routing_rule rule;
    int *node;       /* (nodes) our number of each of its nodes, NULL: the same */
    char digits[32]; /* "(k,n)": what patterns of digits go by, "" where there are none */
};

/* netcheck_reference: the network of case c, memory from r->arena. False with ERR_DATA in *why (or
 * with ERR_UNAVAILABLE: a network or rule that this program does not have). */
bool netcheck_reference(struct netcheck_reader *r, const struct node *c,
                        struct netcheck_reference *f, struct err *why);

/* netcheck_routing: the rule that the reference calls `function` on networks of `family`. False
 * with ERR_UNAVAILABLE (known ones are listed). */
bool netcheck_routing(const char *function, enum topology_family family, enum routing_rule *rule,
                      struct err *e);

/* netcheck_routers_read: the text form of an arbitrary network, lines of "router R node N ...
 * router R ...", as a graph; nodes are numbered router by router. False with ERR_DATA and the line.
 */
bool netcheck_routers_read(const char *path, const char *text, struct arena *a,
                           struct topology_spec *s, struct err *e);

#endif
