/* topology_graph.c - routers and cables as given one by one, deterministic shortest paths.
 *
 * A route has the least sum of weights; towards a target it goes to the lowest-numbered neighbour
 * on such a way, and of parallel cables over the one that its ends name. Next links are found by a
 * search per target when it is first used, and kept. The class is the number of links behind, which
 * frees any graph of deadlock; a tree needs one class only. */
#include "machine/topology_graph.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"

/* routers; above, twice the distance from router 0 bounds the longest route */
enum { GRAPH_EXACT_DIAMETER = 1024 };

struct graph {
    struct arena *arena;
    int nrouter;
    /* (nrouter + 1) links that leave a router, sorted by neighbour: first[r] .. first[r+1] - 1 */
    int *first;
    int *from, *to, *port; /* (nlink) of each directed link */
    int *percent;          /* (nlink) of the link rate, NULL: 100 */
    int *weight;           /* (nlink) NULL: 1 */
    /* (nrouter) per target: the link to take from every router; NULL until needed. Threads of one
     * run ask side by side: who finds none makes it under the lock, and then shows it */
    int *_Atomic *next;
    pthread_mutex_t lock; /* of the search and of the arena */
    int64_t *distance; /* (nrouter) of the search */
    int *queue;        /* (nrouter) of the search */
    bool *waiting;     /* (nrouter) of the search: stands in the queue */
    bool tree, parallel;
};

struct graph_link {
    int from, to;
    int percent, weight;
};

/* By router, then by neighbour: next_links takes the lowest neighbour, ports go by neighbour. */
static int link_order(const void *a, const void *b)
{
    const struct graph_link *p = a, *q = b;
    return p->from != q->from ? (p->from > q->from) - (p->from < q->from)
                              : (p->to > q->to) - (p->to < q->to);
}

/* Both directions of all cables, parallel ones behind each other. */
static struct graph_link *directed_links(const struct graph_cable *cable, int ncable, int nlink,
                                         struct arena *a)
{
    struct graph_link *all = TAKE(a, nlink + 1, struct graph_link);
    int n = 0;
    for (int i = 0; i < ncable; i++) {
        const struct graph_cable *c = &cable[i];
        for (int k = 0; k < c->parallel; k++) {
            all[n++] = (struct graph_link){c->a, c->b, c->there, c->weight};
            all[n++] = (struct graph_link){c->b, c->a, c->back, c->weight};
        }
    }
    qsort(all, (size_t)nlink, sizeof *all, link_order);
    return all;
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
        if (g->weight) g->weight[l] = all[l].weight;
        g->first[all[l].from + 1]++;
        /* links are sorted by `from`, so ports go by neighbour */
        g->port[l] = arrived[all[l].to]++;
    }
    for (int r = 0; r < g->nrouter; r++) {
        if (g->first[r + 1] > t->nport) t->nport = g->first[r + 1];
        g->first[r + 1] += g->first[r];
    }
}

static int weight_of(const struct graph *g, int link) { return g->weight ? g->weight[link] : 1; }

/* Sums of weights to `target`; returns the largest, -1 when some router cannot be reached. Links
 * come in pairs of one weight, so that distances to and from are equal. Routers wait in a queue
 * whenever they have come nearer (Bellman and Ford): with equal weights each does once, O(links),
 * and the search is breadth-first. */
static int64_t search(struct graph *g, int target)
{
    int head = 0, waiting = 1, n = g->nrouter;
    int64_t farthest = 0;
    for (int r = 0; r < n; r++) g->distance[r] = -1;
    g->distance[target] = 0;
    g->queue[0] = target;
    while (waiting > 0) {
        int r = g->queue[head];
        head = head + 1 == n ? 0 : head + 1;
        waiting--;
        g->waiting[r] = false;
        for (int l = g->first[r]; l < g->first[r + 1]; l++) {
            int to = g->to[l];
            int64_t d = g->distance[r] + weight_of(g, l);
            if (g->distance[to] >= 0 && g->distance[to] <= d) continue;
            g->distance[to] = d;
            if (g->waiting[to]) continue;
            g->waiting[to] = true;
            /* A ring buffer: no router stands in it twice. */
            int place = head + waiting++;
            g->queue[place >= n ? place - n : place] = to;
        }
    }
    for (int r = 0; r < n; r++) {
        if (g->distance[r] < 0) return -1;
        if (g->distance[r] > farthest) farthest = g->distance[r];
    }
    return farthest;
}

static int *search_links(struct graph *g, int target)
{
    int *next = TAKE(g->arena, g->nrouter, int);
    search(g, target);
    for (int r = 0; r < g->nrouter; r++) {
        next[r] = -1;
        for (int l = g->first[r]; l < g->first[r + 1] && next[r] < 0; l++)
            if (g->distance[g->to[l]] == g->distance[r] - weight_of(g, l)) next[r] = l;
    }
    return next;
}

/* On demand: a run mostly sends to few of the routers of a large graph. nrouter numbers for each
 * target. */
static const int *next_links(struct graph *g, int target)
{
    int *next = atomic_load_explicit(&g->next[target], memory_order_acquire);
    if (next) return next;
    pthread_mutex_lock(&g->lock);
    next = atomic_load_explicit(&g->next[target], memory_order_relaxed);
    if (!next) {
        next = search_links(g, target);
        atomic_store_explicit(&g->next[target], next, memory_order_release);
    }
    pthread_mutex_unlock(&g->lock);
    return next;
}

/* Of weighted routes the one with the most links, by walking each: the sum of weights does not
 * say it. */
static int64_t longest_walk(struct graph *g)
{
    int64_t longest = 0;
    for (int target = 0; target < g->nrouter; target++) {
        const int *next = next_links(g, target);
        for (int r = 0; r < g->nrouter; r++) {
            int64_t n = 0;
            for (int at = r; at != target; at = g->to[next[at]]) n++;
            if (n > longest) longest = n;
        }
    }
    return longest;
}

/* The most links of a route: a search from every router, O(routers x links), or for large graphs a
 * bound from one (no route is longer than by way of router 0, and every link counts at least the
 * least weight). */
static int64_t longest_route(struct graph *g, int nlink)
{
    int64_t longest = search(g, 0);
    if (longest < 0) return -1;
    int least = g->weight ? INT32_MAX : 1;
    for (int l = 0; l < nlink && g->weight; l++)
        if (g->weight[l] < least) least = g->weight[l];
    if (g->nrouter > GRAPH_EXACT_DIAMETER) return 2 * longest / least;
    if (g->weight) return longest_walk(g);
    for (int r = 1; r < g->nrouter; r++) {
        int64_t far = search(g, r);
        if (far > longest) longest = far;
    }
    return longest;
}

/* Rates and weights are kept only where they say something. */
static bool differ(const struct graph_cable *cable, int ncable, bool weights)
{
    for (int i = 0; i < ncable; i++)
        if (weights ? cable[i].weight != 1 : cable[i].there != 100 || cable[i].back != 100)
            return true;
    return false;
}

bool graph_build(struct topology *t, int nrouter, const struct graph_cable *cable, int ncable,
                 struct arena *a, struct err *e)
{
    struct graph *g = TAKE(a, 1, struct graph);
    int64_t nlink = 0;
    *g = (struct graph){.arena = a,
                        .nrouter = nrouter,
                        .tree = ncable == nrouter - 1,
                        .lock = PTHREAD_MUTEX_INITIALIZER};
    for (int i = 0; i < ncable; i++) {
        nlink += 2 * (int64_t)cable[i].parallel;
        if (cable[i].parallel > 1) g->parallel = true;
    }
    if (nlink > INT32_MAX / 4)
        return err_set(e, ERR_CONFIG, "topology %s: more links than can be numbered",
                       t->type->name);
    /* Everything about links in arrays by number; searches share one queue. */
    int n = (int)nlink;
    g->first = TAKE(a, nrouter + 1, int);
    g->from = TAKE(a, n + 1, int);
    g->to = TAKE(a, n + 1, int);
    g->port = TAKE(a, n + 1, int);
    g->percent = differ(cable, ncable, false) ? TAKE(a, n + 1, int) : NULL;
    g->weight = differ(cable, ncable, true) ? TAKE(a, n + 1, int) : NULL;
    g->next = TAKE(a, nrouter, int *_Atomic);
    g->distance = TAKE(a, nrouter, int64_t);
    g->queue = TAKE(a, nrouter, int);
    g->waiting = TAKE(a, nrouter, bool);
    /* Everything is indexed before the first search. */
    graph_index(g, directed_links(cable, ncable, n, a), n, t);
    t->state = g;
    t->nrouter = nrouter;
    t->nlink = n;
    int64_t longest = longest_route(g, n);
    if (longest < 0)
        return err_set(e, ERR_CONFIG, "topology %s: not all routers can be reached from router 0",
                       t->type->name);
    t->max_hops = longest < nrouter ? (int)longest : nrouter - 1;
    /* One class more on each hop: whoever waits, waits for a higher class, and circles are
     * impossible. A tree has no circle to begin with. */
    t->nclass = g->tree || t->max_hops < 2 ? 1 : t->max_hops;
    return true;
}

/* Rates: one percentage for both directions, or one for each. Weights and numbers of parallel
 * cables: one for each pair of routers. */
static struct graph_cable cable_of(const struct topology_spec *s, int i)
{
    int there =
        s->nlink_percent == 0 ? 100 : s->link_percent[s->nlink_percent == s->nlink ? i : 2 * i];
    return (struct graph_cable){
        .a = s->link[i][0],
        .b = s->link[i][1],
        .there = there,
        .back = s->nlink_percent == 2 * s->nlink ? s->link_percent[2 * i + 1] : there,
        .weight = s->nlink_weight > 0 ? s->link_weight[i] : 1,
        .parallel = s->nbundle > 0 ? s->bundle[i] : 1};
}

/* Pairs as small number and large number, to find those that are listed twice. */
static int pair_order(const void *a, const void *b)
{
    const int64_t *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

/* A pair that is listed twice is more likely a mistake than a bundle, which topology.bundle is
 * for. */
static bool listed_once(const struct topology_spec *s, struct arena *a, struct err *e)
{
    struct arena_mark mark = arena_mark(a);
    int64_t *pair = TAKE(a, s->nlink + 1, int64_t);
    int64_t twice = -1;
    for (int i = 0; i < s->nlink; i++) {
        int p = s->link[i][0], q = s->link[i][1];
        pair[i] = p < q ? p * (int64_t)s->dims[0] + q : q * (int64_t)s->dims[0] + p;
    }
    qsort(pair, (size_t)s->nlink, sizeof *pair, pair_order);
    for (int i = 1; i < s->nlink && twice < 0; i++)
        if (pair[i] == pair[i - 1]) twice = pair[i];
    arena_release(a, mark);
    return twice < 0 || err_set(e, ERR_CONFIG,
                                "topology graph: routers %d and %d are joined twice; parallel "
                                "cables are counted by topology.bundle",
                                (int)(twice / s->dims[0]), (int)(twice % s->dims[0]));
}

/* The lists of the file, before anything is made of them. */
static bool lists_fit(const struct topology_spec *s, struct err *e)
{
    if (s->dims[0] < 1 || s->nlink < 0 || s->nlink > INT32_MAX / 4)
        return err_set(e, ERR_CONFIG, "topology graph: %d routers, %d links", s->dims[0], s->nlink);
    if (s->nlink_percent != 0 && s->nlink_percent != s->nlink && s->nlink_percent != 2 * s->nlink)
        return err_set(e, ERR_CONFIG,
                       "topology graph: %d rates for %d links; expected one or two for each",
                       s->nlink_percent, s->nlink);
    if ((s->nlink_weight != 0 && s->nlink_weight != s->nlink) ||
        (s->nbundle != 0 && s->nbundle != s->nlink))
        return err_set(e, ERR_CONFIG,
                       "topology graph: %d weights and %d numbers in topology.bundle for %d "
                       "links; expected one for each, or none",
                       s->nlink_weight, s->nbundle, s->nlink);
    for (int i = 0; i < s->nlink; i++) {
        int a = s->link[i][0], b = s->link[i][1];
        if (a < 0 || b < 0 || a >= s->dims[0] || b >= s->dims[0] || a == b)
            return err_set(
                e, ERR_CONFIG,
                "topology graph: link %d joins routers %d and %d; expected two of 0 to %d", i, a, b,
                s->dims[0] - 1);
        struct graph_cable c = cable_of(s, i);
        if (c.weight < 1 || c.parallel < 1)
            return err_set(e, ERR_CONFIG,
                           "topology graph: link %d has weight %d and %d cables; expected at least "
                           "1",
                           i, c.weight, c.parallel);
    }
    return true;
}

static bool graph_create(struct topology *t, struct arena *a, struct err *e)
{
    const struct topology_spec *s = t->spec;
    if (!lists_fit(s, e) || !listed_once(s, a, e)) return false;
    struct graph_cable *cable = TAKE(a, s->nlink + 1, struct graph_cable);
    for (int i = 0; i < s->nlink; i++) cable[i] = cable_of(s, i);
    return graph_build(t, s->dims[0], cable, s->nlink, a, e);
}

/* via: what picks one of parallel cables. */
void graph_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    (void)choice;
    unsigned node = (unsigned)c->target * (unsigned)t->nodes_per_router + (unsigned)c->at;
    c->stage = 0;
    c->via = (int)(((unsigned)c->router + node) & INT32_MAX);
}

/* One of the links beside `link`, which is the first of its bundle. */
static int parallel_link(const struct graph *g, int link, int via)
{
    int n = 1, from = g->from[link], to = g->to[link];
    while (link + n < g->first[from + 1] && g->to[link + n] == to) n++;
    return link + via % n;
}

bool graph_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    struct graph *g = t->state;
    if (c->router == c->target) return false;
    int link = next_links(g, c->target)[c->router];
    if (g->parallel) link = parallel_link(g, link, c->via);
    *h = (struct hop){link, g->tree ? 0 : c->stage++, g->port[link]};
    c->router = g->to[link];
    return true;
}

void graph_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct graph *g = t->state;
    *from = g->from[link];
    *to = g->to[link];
    *port = g->port[link];
}

double graph_share(const struct topology *t, int link)
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
