/* topology_clos.c - folded Clos networks of any radix and oversubscription, d-mod-k routes.
 *
 * dims = {m_1, ..., m_h}: m_1 nodes on each leaf switch, m_2 leaves below each switch of level 2,
 * and so on up to level h. topology.up = {w_2, ..., w_h}: how many switches of the next level each
 * switch is joined to. topology.bundle = {b_2, ..., b_h}: cables to each of them (default 1). These
 * are the parallel-ports generalised fat trees of Zahavi ("Fat-tree routing and node ordering
 * providing contention free traffic for MPI global collectives", J. Parallel Distrib. Comput. 72,
 * 2012), after the extended ones of Oehring et al. (IPPS 1995). The oversubscription of a switch of
 * level l is m_l b_l / (w_{l+1} b_{l+1}); m_1 = w_2 = ... = k is the k-ary tree of topology_tree.c.
 *
 * A switch of level l is (high, low): high = the number of its leaf's first node over m_1 ... m_l,
 * low below W_l = w_2 ... w_l says which of the equal switches it is; its number within the level
 * is high W_l + low. Its u-th switch above is (high / m_{l+1}, low w_{l+1} + u).
 *
 * A route climbs to the lowest level that is above both ends, at level l through up port
 * floor(node / W_l) mod (w_{l+1} b_{l+1}) of the destination node (Valiant: of a random number),
 * and comes down by the cables of the same rule. Nothing climbs after it came down: one class.
 *
 * Cable c = base_l + (switch w_{l+1} + u) b_{l+1} + i: link 2c upwards, 2c + 1 downwards. */
#include "base/check.h"
#include "machine/topology_internal.h"

struct clos {
    int h;                           /* levels */
    int m[MACHINE_MAX_DIMS];         /* children of a switch of level l + 1 */
    int w[MACHINE_MAX_DIMS];         /* switches above a switch of level l + 1 */
    int b[MACHINE_MAX_DIMS];         /* cables to each of them */
    int span[MACHINE_MAX_DIMS + 1];  /* nodes below a switch of level l: m_1 ... m_l */
    int width[MACHINE_MAX_DIMS + 1]; /* W_l */
    int first[MACHINE_MAX_DIMS + 1]; /* number of the first switch of level l + 1 */
    int cable[MACHINE_MAX_DIMS];     /* first cable above level l + 1 */
    bool random;
};

/* The lists of the file, which have one number for each pair of levels. */
static bool clos_lists(struct clos *g, const struct topology_spec *s, struct err *e)
{
    if (s->ndim < 1 || s->ndim > MACHINE_MAX_DIMS || s->nup != s->ndim - 1 ||
        (s->nbundle != 0 && s->nbundle != s->ndim - 1))
        return err_set(e, ERR_CONFIG,
                       "topology folded-clos: %d levels, %d numbers in topology.up, %d in "
                       "topology.bundle; expected 1 to %d levels and one number less in "
                       "topology.up, and in topology.bundle as many or none",
                       s->ndim, s->nup, s->nbundle, MACHINE_MAX_DIMS);
    g->h = s->ndim;
    for (int l = 0; l < s->ndim; l++) {
        g->m[l] = s->dims[l];
        g->w[l] = l < s->nup ? s->up[l] : 0;
        g->b[l] = l < s->nbundle ? s->bundle[l] : 1;
        if (g->m[l] < 1 || (l < s->nup && g->w[l] < 1) || g->b[l] < 1)
            return err_set(e, ERR_CONFIG,
                           "topology folded-clos: level %d has %d below and %d above each switch, "
                           "by %d cables; expected at least 1",
                           l + 1, g->m[l], g->w[l], g->b[l]);
    }
    return true;
}

/* Switches of a level: as many `high` as the nodes are more than one switch spans, times W_l. All
 * products are checked before they are made. */
static bool clos_shape(struct clos *g, struct topology *t, struct err *e)
{
    int64_t nodes = 1, width = 1, nrouter = 0, ncable = 0;
    bool fits = true;
    for (int l = 0; l < g->h && fits; l++) fits = (nodes *= g->m[l]) < INT32_MAX / 4;
    int64_t span = 1;
    for (int l = 0; l < g->h && fits; l++) {
        span *= g->m[l];
        g->span[l] = (int)span;
        g->width[l] = (int)width;
        int64_t switches = nodes / span * width, above = (int64_t)g->w[l] * g->b[l];
        g->first[l] = (int)nrouter;
        g->cable[l] = (int)ncable;
        nrouter += switches;
        fits = above < INT32_MAX && switches < INT32_MAX && switches * above < INT32_MAX / 4;
        if (!fits) break;
        if (l + 1 < g->h) ncable += switches * above, width *= g->w[l];
        fits = nrouter < INT32_MAX / 4 && ncable < INT32_MAX / 4 && width < INT32_MAX / 4;
        /* Ports: from below first, from above behind them; nodes come by injection ports. */
        int64_t port = (l > 0 ? (int64_t)g->m[l] * g->b[l - 1] : 0) + above;
        fits = fits && port < INT32_MAX / 4;
        if (fits && port > t->nport) t->nport = (int)port;
    }
    if (!fits)
        return err_set(e, ERR_CONFIG,
                       "topology folded-clos: more nodes, switches or cables than can be numbered");
    t->nnode = (int)nodes;
    t->nrouter = (int)nrouter;
    t->nlink = 2 * (int)ncable;
    return true;
}

static bool clos_create(struct topology *t, struct arena *a, struct err *e)
{
    struct clos *g = TAKE(a, 1, struct clos);
    if (!clos_lists(g, t->spec, e) || !clos_shape(g, t, e)) return false;
    t->nodes_per_router = g->m[0];
    g->random = t->spec->routing == ROUTE_VALIANT && g->h > 1;
    t->fixed_routes = !g->random;
    t->state = g;
    /* A switch of the highest level with one child has nothing to join: no route goes there. */
    int top = g->h;
    while (top > 1 && g->m[top - 1] == 1) top--;
    t->max_hops = 2 * (top - 1);
    return true;
}

/* Levels to climb from leaf v so that leaf w is below: spans are in nodes, leaves have m_1. */
static int clos_climb(const struct clos *g, int v, int w)
{
    int level = 0;
    while (v / (g->span[level] / g->m[0]) != w / (g->span[level] / g->m[0])) level++;
    return level;
}

/* stage: level of the router; left: levels still to climb; via: the number that ports go by. */
static void clos_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    const struct clos *g = t->state;
    c->stage = 0;
    c->left = clos_climb(g, c->router, c->target);
    c->via = g->random ? (int)(choice & INT32_MAX) : c->target * g->m[0] + c->at;
}

/* The up port above level l that the number `via` names: which switch, and which cable to it. */
static int named_port(const struct clos *g, int l, int via, int *cable)
{
    int port = via / g->width[l] % (g->w[l] * g->b[l]);
    *cable = port / g->w[l];
    return port % g->w[l];
}

static bool clos_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    const struct clos *g = t->state;
    if (c->router == c->target) return false;
    int l = c->stage, i = c->router - g->first[l], high = i / g->width[l], low = i % g->width[l];
    int cable;
    h->vc_class = 0;
    if (c->left > 0) {
        int u = named_port(g, l, c->via, &cable);
        h->link = 2 * (g->cable[l] + (i * g->w[l] + u) * g->b[l] + cable);
        h->port = high % g->m[l + 1] * g->b[l] + cable;
        c->router = g->first[l + 1] + high / g->m[l + 1] * g->width[l + 1] + low * g->w[l] + u;
        c->stage++;
        c->left--;
        return true;
    }
    /* Down: the switch above the target's leaf that this one was reached from, or would have been;
     * the cable is the one by which the rule climbs there. */
    l--;
    int u = low % g->w[l], below = low / g->w[l];
    named_port(g, l, c->via, &cable);
    int child = c->target / (g->span[l] / g->m[0]) * g->width[l] + below;
    h->link = 2 * (g->cable[l] + (child * g->w[l] + u) * g->b[l] + cable) + 1;
    h->port = (l > 0 ? g->m[l] * g->b[l - 1] : 0) + u * g->b[l] + cable;
    c->router = g->first[l] + child;
    c->stage--;
    return true;
}

/* Up and down again; between leaves, which alone have nodes. */
static int clos_distance(const struct topology *t, int from, int to)
{
    return 2 * clos_climb(t->state, from, to);
}

/* dim_bandwidth[l]: between levels l + 1 and l + 2. */
static int clos_rate_dim(const struct topology *t, int link)
{
    const struct clos *g = t->state;
    int l = 0;
    while (l + 2 < g->h && link / 2 >= g->cable[l + 1]) l++;
    return l;
}

/* The numbering of the header, backwards. */
static void clos_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct clos *g = t->state;
    int l = clos_rate_dim(t, link), c = link / 2 - g->cable[l];
    int cable = c % g->b[l], u = c / g->b[l] % g->w[l], i = c / g->b[l] / g->w[l];
    int high = i / g->width[l], low = i % g->width[l];
    int lower = g->first[l] + i;
    int upper = g->first[l + 1] + high / g->m[l + 1] * g->width[l + 1] + low * g->w[l] + u;
    bool upwards = link % 2 == 0;
    *from = upwards ? lower : upper;
    *to = upwards ? upper : lower;
    *port = upwards ? high % g->m[l + 1] * g->b[l] + cable
                    : (l > 0 ? g->m[l] * g->b[l - 1] : 0) + u * g->b[l] + cable;
}

/* Sub-trees. */
static int clos_parts(const struct topology *t, int64_t *size)
{
    int64_t block = 1;
    for (int i = 0; i < t->spec->ndim; i++) size[i] = block *= t->spec->dims[i];
    return t->spec->ndim;
}

const struct topology_type topology_folded_clos = {
    .name = "folded-clos",
    .create = clos_create,
    .start = clos_start,
    .next = clos_next,
    .distance = clos_distance,
    .ends = clos_ends,
    .rate_dim = clos_rate_dim,
    .parts = clos_parts,
};
