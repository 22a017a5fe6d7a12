/* node_use.c - see node_use.h.
 *
 * Loops that pass over their data again and again find nothing of it in a cache that does not hold
 * all: what was used longest ago goes first, and is needed next. So a working set lies in one
 * level, and every load and store of it comes from there. */
#include "machine/node_use.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/units.h"

bool node_use_check(const struct machine_spec *m, struct err *e)
{
    const struct memory_level *memory = &m->node.level[NODE_MEMORY];
    if (m->node.model != NODE_ROOFLINE || memory->bandwidth > 0 || memory->shared > 0) return true;
    return err_set(e, ERR_CONFIG,
                   "machine.node.model is roofline, and no memory of %s is stated: give "
                   "machine.node.memory.bandwidth, such as 10 GB/s",
                   m->name[0] != '\0' ? m->name : "the machine");
}

struct node_use node_use_alone(int64_t working_set)
{
    struct node_use u = {.working_set = working_set};
    for (int i = 0; i < NODE_LEVELS; i++) u.sharers[i] = 1;
    return u;
}

/* How many processors share a level: a cache is a processor's own unless said otherwise. */
static int processors_of(const struct machine_spec *m, enum node_level level)
{
    const int n = m->node.level[level].processors;
    if (level == NODE_MEMORY && n == 0) return m->topology.processors_per_node;
    return n;
}

/* Ranks on the fullest group of `size` neighbouring processors. Processors are numbered through
 * the nodes, so that a memory may belong to several of them. */
static int fullest(const struct machine_spec *m, const struct placement *p, int size)
{
    const int per_node = m->topology.processors_per_node;
    if (size <= 1 || p->nrank == 0) return 1;
    const int64_t groups = machine_spec_processors(m) / size + 1;
    int *count = memory_zeroed((size_t)groups, sizeof *count), most = 1;
    for (int i = 0; i < p->nrank; i++) {
        const int64_t processor = (int64_t)p->node[i] * per_node + p->processor[i];
        const int n = ++count[processor / size];
        if (n > most) most = n;
    }
    free(count);
    return most;
}

struct node_use node_use_placed(const struct machine_spec *m, const struct placement *p,
                                int64_t working_set)
{
    struct node_use u = node_use_alone(working_set);
    if (m->node.model != NODE_ROOFLINE) return u;
    for (int i = NODE_L1; i < NODE_LEVELS; i++)
        u.sharers[i] = fullest(m, p, processors_of(m, (enum node_level)i));
    return u;
}

bool node_use_make(const struct machine_spec *m, int nrank, int64_t working_set,
                   struct node_use *out, struct err *e)
{
    *out = node_use_alone(working_set);
    if (m->node.model != NODE_ROOFLINE) return true;
    if (!node_use_check(m, e)) return false;
    struct arena *a = arena_create();
    const struct topology *t = topology_create(&m->topology, a, e);
    struct placement p;
    const bool ok = t != NULL && placement_create(&p, m, t, nrank, a, e);
    if (ok) *out = node_use_placed(m, &p, working_set);
    arena_destroy(a);
    return ok;
}

/* A cache that does not exist holds nothing, not even an empty working set: what is in no cache
 * lies in the memory. */
enum node_level node_use_level(const struct node_spec *s, const struct node_use *u)
{
    for (int i = NODE_L1; i < NODE_MEMORY; i++) {
        const int64_t part = s->level[i].bytes / u->sharers[i];
        if (s->level[i].bytes > 0 && u->working_set <= part) return (enum node_level)i;
    }
    return NODE_MEMORY;
}

double node_use_bandwidth(const struct node_spec *s, const struct node_use *u,
                          enum node_level level)
{
    const struct memory_level *l = &s->level[level];
    const double own = l->bandwidth > 0 ? l->bandwidth : INFINITY,
                 part = l->shared > 0 ? l->shared / u->sharers[level] : INFINITY;
    return fmin(own, part);
}

struct node_cost node_use_cost(const struct node_spec *s, const struct node_use *u)
{
    struct node_cost c = node_cost_make(s);
    if (!c.roofline) return c;
    c.moved = 0;
    for (int i = NODE_L1; i <= (int)node_use_level(s, u); i++)
        c.moved = fmax(c.moved, 1e12 / node_use_bandwidth(s, u, (enum node_level)i));
    return c;
}

/* " in the memory, which 4 ranks share": where, and with whom. */
static void tell_place(enum node_level level, int sharers, char *text, int size)
{
    char with[48] = "";
    if (sharers > 1) snprintf(with, sizeof with, ", which %d ranks share", sharers);
    snprintf(text, (size_t)size, "%s%s%s", level == NODE_MEMORY ? "the " : "",
             node_level_name(level), with);
}

/* The rates of a machine whose file states a memory leave it out on purpose: that is told. */
void node_use_tell(const struct node_spec *s, const struct node_use *u, char *text, int size)
{
    const enum node_level level = node_use_level(s, u);
    const struct node_cost c = node_use_cost(s, u);
    char set[32], place[64], rate[40], roof[120] = "no bandwidth is stated";
    text[0] = '\0';
    if (s->model == NODE_RATES) {
        if (s->level[NODE_MEMORY].bandwidth > 0)
            snprintf(text, (size_t)size,
                     "each operation at its price; left out: caches, and the memory that "
                     "processors share (machine.node.model=roofline counts both)");
        return;
    }
    units_print((double)u->working_set, UNIT_BYTES, set, sizeof set);
    tell_place(level, u->sharers[level], place, sizeof place);
    /* Where operations and transfer take the same time: the ridge of the roof. */
    if (c.moved > 0) units_print(1e12 / c.moved, UNIT_BANDWIDTH, rate, sizeof rate);
    if (c.moved > 0)
        snprintf(roof, sizeof roof, "%s for each, which decides below %.3g flop/B", rate,
                 c.flop > 0 ? c.moved / c.flop : INFINITY);
    snprintf(text, (size_t)size,
             "roofline: %s a rank in %s: %s; left out: latencies of caches, and that ranks do not "
             "all compute at the same time",
             set, place, roof);
}
