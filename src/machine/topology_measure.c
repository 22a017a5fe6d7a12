/* topology_measure.c - see topology_measure.h.
 *
 * Distances are those of the graph of links, by a breadth-first search from each router that has
 * nodes, and counted for pairs of nodes; the routes of the family may be longer (a dragonfly's
 * minimal route takes one global link even where two are shorter). */
#include "machine/topology_measure.h"

#include <string.h>

#include "machine/topology_internal.h"

/* Routers up to which all distances are measured, and from how many at most above that; of very
 * large networks fewer, so that together no more routers are found than MOST_FOUND, and routes to a
 * part of the others, of at most MOST_STEPS links: a second or two each. */
enum { ALL_SOURCES = 4096, SAMPLED_SOURCES = 64, MOST_FOUND = 1 << 25, MOST_STEPS = 1 << 29 };

struct survey {
    const struct topology *t;
    const int *first, *to; /* topology_neighbours */
    int *distance, *queue;
    double *ways; /* shortest ways from the source */
    int *nodes;   /* (nrouter) */
    double routes, route_pairs; /* links of the routes that were walked, and of how many pairs */
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

/* The routes from one node of a router to one of every `each`-th other: all nodes of a router have
 * as long ones. */
static void walk_routes(struct survey *s, int source, int each, struct topology_measure *m)
{
    const struct topology *t = s->t;
    const double nodes = s->nodes[source];
    int node = source * t->nodes_per_router;
    for (int64_t i = 0; i < t->nnode; i += (int64_t)t->nodes_per_router * each) {
        int pairs = s->nodes[topology_router_of(t, (int)i)];
        s->route_pairs += nodes * (pairs - (i == node));
        if (i == node || pairs == 0) continue;
        int n = topology_distance(t, node, (int)i);
        s->routes += nodes * n * pairs;
        if (n > m->longest_route) m->longest_route = n;
    }
}

/* Sums over pairs of different nodes: those of one router are no link apart. */
static void measure_distances(struct survey *s, struct topology_measure *m)
{
    const struct topology *t = s->t;
    const int with_nodes = t->nnode / t->nodes_per_router;
    double links = 0, pairs = 0, ways = 0, router_pairs = 0;
    m->sampled = with_nodes > ALL_SOURCES;
    m->nsource = m->sampled ? SAMPLED_SOURCES : with_nodes;
    while (m->sampled && m->nsource > 1 && m->nsource > MOST_FOUND / with_nodes) m->nsource /= 2;
    for (int k = 0; k < m->nsource; k++) {
        /* Routers with nodes have the lowest numbers. */
        int source = (int)((int64_t)k * with_nodes / m->nsource), nodes = s->nodes[source];
        if (nodes == 0) continue;
        search(s, source);
        double away = 0;
        for (int r = 0; r < with_nodes; r++) {
            pairs += (double)nodes * (s->nodes[r] - (r == source));
            if (r == source || s->nodes[r] == 0) continue;
            links += (double)nodes * s->nodes[r] * s->distance[r];
            away += s->distance[r];
            ways += s->ways[r];
            router_pairs++;
            if (s->distance[r] > m->diameter) m->diameter = s->distance[r];
            if (m->least_ways <= 0 || s->ways[r] < m->least_ways) m->least_ways = s->ways[r];
        }
        walk_routes(s, source, m->sampled ? 1 + (int)(away * m->nsource / MOST_STEPS) : 1, m);
    }
    m->mean = pairs > 0 ? links / pairs : 0;
    m->mean_route = s->route_pairs > 0 ? s->routes / s->route_pairs : 0;
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
