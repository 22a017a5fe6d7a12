/* topology_graph.c - routers and links as given in a file, deterministic shortest paths.
 *
 * The next router towards a target is the lowest-numbered neighbour that is nearer to it. Next hops
 * are found by a breadth-first search per target when it is first used, and kept. The class is the
 * number of links behind, which frees any graph of deadlock; a tree needs one class only. */
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "machine/topology_internal.h"

/* routers; above, twice the distance from router 0 bounds the longest route */
enum { GRAPH_EXACT_DIAMETER = 1024 };

struct graph {
    struct arena *arena;
    int nrouter;
    /* (nrouter + 1) links that leave a router, sorted by neighbour: first[r] .. first[r+1] - 1 */
    int *first;
    int *from, *to, *port; /* (nlink) of each directed link */
    int *percent;          /* (nlink) of the link rate, NULL: 100 */
    int **next; /* (nrouter) per target: the link to take from every router; NULL until needed */
    int *distance, *queue; /* (nrouter) of the search */
    bool tree;
};

struct graph_link {
    int from, to;
    int percent;
};

/* By router, then by neighbour: next_links takes the lowest neighbour, ports go by neighbour. */
static int link_order(const void *a, const void *b)
{
    const struct graph_link *p = a, *q = b;
    return p->from != q->from ? (p->from > q->from) - (p->from < q->from)
                              : (p->to > q->to) - (p->to < q->to);
}

/* Every line of the file is two directed links. Rates: one percentage for both directions, or one
 * for each. Double links are refused, as routes could not tell them apart. */
static bool links_read(const struct topology_spec *s, struct graph_link *all, struct err *e)
{
    for (int i = 0; i < s->nlink; i++) {
        int a = s->link[i][0], b = s->link[i][1];
        if (a < 0 || b < 0 || a >= s->dims[0] || b >= s->dims[0] || a == b)
            return err_set(
                e, ERR_CONFIG,
                "topology graph: link %d joins routers %d and %d; expected two of 0 to %d", i, a, b,
                s->dims[0] - 1);
        int there =
            s->nlink_percent == 0 ? 100 : s->link_percent[s->nlink_percent == s->nlink ? i : 2 * i];
        int back = s->nlink_percent == 2 * s->nlink ? s->link_percent[2 * i + 1] : there;
        all[2 * i] = (struct graph_link){a, b, there};
        all[2 * i + 1] = (struct graph_link){b, a, back};
    }
    qsort(all, 2 * (size_t)s->nlink, sizeof *all, link_order);
    for (int i = 1; i < 2 * s->nlink; i++)
        if (link_order(&all[i - 1], &all[i]) == 0)
            return err_set(e, ERR_CONFIG, "topology graph: routers %d and %d are joined twice",
                           all[i].from, all[i].to);
    return true;
}

/* Counting sort: first[] holds the number of links of each router, then where they begin. */
static void graph_index(struct graph *g, const struct graph_link *all, int nlink,
                        struct topology *t)
{
    int *arrived = TAKE(g->arena, g->nrouter, int);
    for (int l = 0; l < nlink; l++) {
        g->from[l] = all[l].from;
        g->to[l] = all[l].to;
        if (g->percent) g->percent[l] = all[l].percent;
        g->first[all[l].from + 1]++;
        /* links are sorted by `from`, so ports go by neighbour */
        g->port[l] = arrived[all[l].to]++;
    }
    for (int r = 0; r < g->nrouter; r++) {
        if (g->first[r + 1] > t->nport) t->nport = g->first[r + 1];
        g->first[r + 1] += g->first[r];
    }
}

/* Breadth-first from `target` backwards; returns the largest distance, -1 when some router cannot
 * be reached. Links come in pairs, so that distances to and from are equal. O(links). */
static int search(struct graph *g, int target)
{
    int head = 0, tail = 0;
    memset(g->distance, -1, (size_t)g->nrouter * sizeof *g->distance);
    g->distance[target] = 0;
    g->queue[tail++] = target;
    while (head < tail) {
        int r = g->queue[head++];
        for (int l = g->first[r]; l < g->first[r + 1]; l++) {
            if (g->distance[g->to[l]] >= 0) continue;
            g->distance[g->to[l]] = g->distance[r] + 1;
            g->queue[tail++] = g->to[l];
        }
    }
    return tail == g->nrouter ? g->distance[g->queue[tail - 1]] : -1;
}

/* On demand: a run mostly sends to few of the routers of a large graph. nrouter numbers for each
 * target. */
static const int *next_links(struct graph *g, int target)
{
    if (g->next[target]) return g->next[target];
    int *next = TAKE(g->arena, g->nrouter, int);
    search(g, target);
    for (int r = 0; r < g->nrouter; r++) {
        next[r] = -1;
        for (int l = g->first[r]; l < g->first[r + 1] && next[r] < 0; l++)
            if (g->distance[g->to[l]] == g->distance[r] - 1) next[r] = l;
    }
    g->next[target] = next;
    return next;
}

/* The diameter: a search from every router, O(routers x links), or for large graphs a bound from
 * one (no route is longer than by way of router 0). */
static int longest_route(struct graph *g)
{
    int longest = search(g, 0);
    if (longest < 0) return -1;
    if (g->nrouter > GRAPH_EXACT_DIAMETER) return 2 * longest;
    for (int r = 1; r < g->nrouter; r++) {
        int far = search(g, r);
        if (far > longest) longest = far;
    }
    return longest;
}

static bool graph_create(struct topology *t, struct arena *a, struct err *e)
{
    const struct topology_spec *s = t->spec;
    int n = s->dims[0], nlink = 2 * s->nlink;
    if (n < 1 || s->nlink < 0 || s->nlink > INT32_MAX / 4)
        return err_set(e, ERR_CONFIG, "topology graph: %d routers, %d links", n, s->nlink);
    if (s->nlink_percent != 0 && s->nlink_percent != s->nlink && s->nlink_percent != 2 * s->nlink)
        return err_set(e, ERR_CONFIG,
                       "topology graph: %d rates for %d links; expected one or two for each",
                       s->nlink_percent, s->nlink);
    struct graph *g = TAKE(a, 1, struct graph);
    *g = (struct graph){.arena = a, .nrouter = n, .tree = s->nlink == n - 1};
    struct graph_link *all = TAKE(a, nlink + 1, struct graph_link);
    if (!links_read(s, all, e)) return false;
    /* Everything about links in arrays by number; searches share one queue. */
    g->first = TAKE(a, n + 1, int);
    g->from = TAKE(a, nlink + 1, int);
    g->to = TAKE(a, nlink + 1, int);
    g->port = TAKE(a, nlink + 1, int);
    g->percent = s->nlink_percent > 0 ? TAKE(a, nlink + 1, int) : NULL;
    g->next = TAKE(a, n, int *);
    g->distance = TAKE(a, n, int);
    g->queue = TAKE(a, n, int);
    /* Everything is indexed before the first search. */
    graph_index(g, all, nlink, t);
    t->state = g;
    t->nrouter = n;
    t->nlink = nlink;
    t->max_hops = longest_route(g);
    if (t->max_hops < 0)
        return err_set(e, ERR_CONFIG,
                       "topology graph: not all routers can be reached from router 0");
    /* One class more on each hop: whoever waits, waits for a higher class, and circles are
     * impossible. A tree has no circle to begin with. */
    t->nclass = g->tree || t->max_hops < 2 ? 1 : t->max_hops;
    return true;
}

static void graph_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    (void)t;
    (void)choice;
    c->stage = 0;
}

static bool graph_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    struct graph *g = t->state;
    if (c->router == c->target) return false;
    int link = next_links(g, c->target)[c->router];
    *h = (struct hop){link, g->tree ? 0 : c->stage++, g->port[link]};
    c->router = g->to[link];
    return true;
}

static void graph_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct graph *g = t->state;
    *from = g->from[link];
    *to = g->to[link];
    *port = g->port[link];
}

static double graph_share(const struct topology *t, int link)
{
    const struct graph *g = t->state;
    return g->percent ? g->percent[link] / 100.0 : 1;
}

const struct topology_type topology_graph = {
    .name = "graph",
    .create = graph_create,
    .start = graph_start,
    .next = graph_next,
    .ends = graph_ends,
    .share = graph_share,
};
