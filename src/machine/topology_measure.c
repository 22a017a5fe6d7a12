/* topology_measure.c - see topology_measure.h.
 *
 * Distances are those of the graph of links, by a breadth-first search from each router that has
 * nodes, and counted for pairs of nodes; the routes of the family may be longer (a dragonfly's
 * minimal route takes one global link even where two are shorter). */
#include "machine/topology_measure.h"

#include <string.h>

#include "machine/topology_internal.h"

/* Routers up to which all distances are measured, and from how many above that; pairs of routers
 * whose routes are walked. */
enum { ALL_SOURCES = 4096, SAMPLED_SOURCES = 64, ROUTE_PAIRS = 1 << 22 };

struct survey {
    const struct topology *t;
    const int *first, *to; /* topology_neighbours */
    int *distance, *queue;
    double *ways; /* shortest ways from the source */
    int *nodes;   /* (nrouter) */
};

static struct survey survey_make(const struct topology *t, struct arena *a)
{
    const struct topology_neighbours near = topology_neighbours(t, a);
    struct survey s = {.t = t, .first = near.first, .to = near.to};
    s.distance = TAKE(a, t->nrouter, int);
    s.queue = TAKE(a, t->nrouter, int);
    s.ways = TAKE(a, t->nrouter, double);
    s.nodes = TAKE(a, t->nrouter, int);
    for (int i = 0; i < t->nnode; i++)
        s.nodes[topology_router_of(t, i)] += topology_router_works(t, topology_router_of(t, i));
    return s;
}

/* Distances from `source`, and in how many ways each is reached: the sum over the routers before
 * it, one for each parallel cable. */
static void search(const struct survey *s, int source)
{
    int head = 0, tail = 0;
    memset(s->distance, -1, (size_t)s->t->nrouter * sizeof *s->distance);
    memset(s->ways, 0, (size_t)s->t->nrouter * sizeof *s->ways);
    s->distance[source] = 0;
    s->ways[source] = 1;
    s->queue[tail++] = source;
    while (head < tail) {
        int r = s->queue[head++];
        for (int i = s->first[r]; i < s->first[r + 1]; i++) {
            int to = s->to[i];
            if (s->distance[to] < 0) {
                s->distance[to] = s->distance[r] + 1;
                s->queue[tail++] = to;
            }
            if (s->distance[to] == s->distance[r] + 1) s->ways[to] += s->ways[r];
        }
    }
}

/* The routes from one node of a router to one of every other: all nodes of a router have as long
 * ones. */
static double walk_routes(const struct survey *s, int source, struct topology_measure *m)
{
    const struct topology *t = s->t;
    double sum = 0;
    int node = source * t->nodes_per_router;
    for (int i = 0; i < t->nnode; i += t->nodes_per_router) {
        int pairs = s->nodes[topology_router_of(t, i)];
        if (i == node || pairs == 0) continue;
        int n = topology_distance(t, node, i);
        sum += (double)n * pairs;
        if (n > m->longest_route) m->longest_route = n;
    }
    return sum;
}

/* Sums over pairs of different nodes: those of one router are no link apart. */
static void measure_distances(const struct survey *s, struct topology_measure *m)
{
    const struct topology *t = s->t;
    const int with_nodes = t->nnode / t->nodes_per_router;
    double links = 0, routes = 0, pairs = 0, ways = 0, router_pairs = 0;
    m->sampled = with_nodes > ALL_SOURCES;
    m->nsource = m->sampled ? SAMPLED_SOURCES : with_nodes;
    for (int k = 0; k < m->nsource; k++) {
        /* Routers with nodes have the lowest numbers. */
        int source = (int)((int64_t)k * with_nodes / m->nsource), nodes = s->nodes[source];
        if (nodes == 0) continue;
        search(s, source);
        for (int r = 0; r < with_nodes; r++) {
            pairs += (double)nodes * (s->nodes[r] - (r == source));
            if (r == source || s->nodes[r] == 0) continue;
            links += (double)nodes * s->nodes[r] * s->distance[r];
            ways += s->ways[r];
            router_pairs++;
            if (s->distance[r] > m->diameter) m->diameter = s->distance[r];
            if (m->least_ways <= 0 || s->ways[r] < m->least_ways) m->least_ways = s->ways[r];
        }
        routes += nodes * walk_routes(s, source, m);
    }
    m->mean = pairs > 0 ? links / pairs : 0;
    m->mean_route = pairs > 0 ? routes / pairs : 0;
    m->mean_ways = router_pairs > 0 ? ways / router_pairs : 0;
}

static void count_ports(const struct survey *s, struct topology_measure *m)
{
    for (int r = 0; r < s->t->nrouter; r++) {
        int n = s->first[r + 1] - s->first[r] + s->nodes[r];
        if (n > m->ports) m->ports = n;
        bool first = m->least_ports == 0 || n < m->least_ports;
        if (first && topology_router_works(s->t, r)) m->least_ports = n;
    }
}

int64_t topology_bisection(const struct topology *t)
{
    return t->type->bisection ? t->type->bisection(t) : -1;
}

/* The halves are found by partitioning in any case, since a picture shows them; where they are
 * wider than a closed form says, they are not the ones that it means. */
static void measure_bisection(const struct topology *t, struct topology_measure *m, struct arena *a)
{
    if (t->nrouter < 2) return;
    int64_t exact = topology_bisection(t);
    m->half = TAKE(a, t->nrouter, bool);
    int64_t found = topology_partition(t, m->half, a);
    m->source = exact >= 0 ? BISECTION_EXACT : BISECTION_PARTITION;
    m->bisection = exact >= 0 ? exact : found;
    if (found != m->bisection) m->half = NULL;
}

struct topology_measure topology_measure(const struct topology *t, struct arena *a)
{
    struct topology_measure m = {0};
    struct survey s = survey_make(t, a);
    /* What does not work is not counted; a bus is one link. */
    for (int r = 0; r < t->nrouter; r++) {
        m.nrouter += topology_router_works(t, r);
        m.nnode += s.nodes[r];
    }
    m.ncable = t->nlink == 1 ? 1 : s.first[t->nrouter] / 2;
    count_ports(&s, &m);
    /* One router: every two nodes are as near as can be. */
    if (t->nrouter > 1) measure_distances(&s, &m);
    measure_bisection(t, &m, a);
    return m;
}
