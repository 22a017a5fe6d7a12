/* machine_topology.h - the networks of machines: numbers, costs, pictures. */
#ifndef APP_MACHINE_TOPOLOGY_H
#define APP_MACHINE_TOPOLOGY_H

#include "app/verb.h"

/* machine_topology: what `machines NAME... --topology` does with the machines in c->arg: prints
 * each network (with --json one object, of several machines a list) and draws it into c->directory
 * as topology-NAME. Without gnuplot, or of a network too large to draw, there is a remark instead.
 * Returns the exit status. */
int machine_topology(const struct common *c, struct arena *a);

#endif
