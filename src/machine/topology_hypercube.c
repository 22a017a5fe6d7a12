/* topology_hypercube.c - binary n-cubes with e-cube routes, and the Origin's Xpress links on spare
 * ports of routers.
 *
 * The link that leaves router r in dimension d is r n + d. Xpress links follow, for n up to 2 one
 * beside each of them, n 2^n + r n + d: what goes to a router's odd nodes takes them. From n = 3 on
 * there is one a router, n 2^n + r, to the opposite corner; a route between opposite corners takes
 * it, others are e-cube. */
#include "base/check.h"
#include "machine/topology_internal.h"

/* A router of the Origin has six ports, two of them for nodes: with up to two dimensions each link
 * has a spare pair. */
enum { MOST_DOUBLED = 2 };

struct hypercube {
    int ndim;
    bool doubled;  /* Xpress links lie beside the cube's */
    bool diagonal; /* they join opposite corners */
};

/* nport links leave every router, so that the number of links is nport 2^n. The opposite corner
 * costs one link instead of n, which makes n - 1 the longest route. */
static bool hypercube_create(struct topology *t, struct arena *a, struct err *e)
{
    const struct topology_spec *s = t->spec;
    struct hypercube *g = TAKE(a, 1, struct hypercube);
    int n = s->dims[0];
    if (n < 0 || n > 24)
        return err_set(e, ERR_CONFIG,
                       "topology hypercube: %d dimensions; expected 0 to 24 (2^n routers)", n);
    if (s->xpress && n < 1)
        return err_set(
            e, ERR_CONFIG,
            "topology hypercube: Xpress links join two routers, so at least 1 dimension");
    g->ndim = n;
    g->doubled = s->xpress && n <= MOST_DOUBLED;
    g->diagonal = s->xpress && !g->doubled;
    t->state = g;
    t->nrouter = 1 << n;
    t->nport = n + (g->doubled ? n : 0) + (g->diagonal ? 1 : 0);
    t->nlink = t->nport << n;
    t->max_hops = g->diagonal ? n - 1 : n;
    return true;
}

/* Router and target are all that a route needs. */
static void hypercube_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    (void)t;
    (void)choice;
    (void)c;
}

static bool hypercube_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    const struct hypercube *g = t->state;
    unsigned diff = (unsigned)(c->router ^ c->target), all = (1u << g->ndim) - 1;
    if (diff == 0) return false;
    h->vc_class = 0;
    /* All bits differ: the direct link, which leads back to the same number in all bits. */
    if (g->diagonal && diff == all) {
        h->link = (g->ndim << g->ndim) + c->router;
        h->port = g->ndim;
        c->router = c->target;
        return true;
    }
    /* e-cube: the lowest differing bit first. One order for all makes circles of waiting impossible
     * with one class. */
    int d = __builtin_ctz(diff);
    bool beside = g->doubled && c->at % 2;
    h->link = c->router * g->ndim + d + (beside ? g->ndim << g->ndim : 0);
    h->port = d + (beside ? g->ndim : 0);
    c->router ^= 1 << d;
    return true;
}

/* Number of differing bits. */
static int hypercube_distance(const struct topology *t, int from, int to)
{
    const struct hypercube *g = t->state;
    unsigned diff = (unsigned)(from ^ to);
    if (g->diagonal && diff == (1u << g->ndim) - 1) return 1;
    return __builtin_popcount(diff);
}

/* Cube links by router and dimension; then Xpress links in the same order, or by router. */
static void hypercube_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct hypercube *g = t->state;
    int first_xpress = g->ndim << g->ndim;
    bool beside = g->doubled && link >= first_xpress;
    if (g->diagonal && link >= first_xpress) {
        *from = link - first_xpress;
        *to = *from ^ ((1 << g->ndim) - 1);
        *port = g->ndim;
        return;
    }
    link -= beside ? first_xpress : 0;
    *from = link / g->ndim;
    *to = *from ^ (1 << link % g->ndim);
    *port = link % g->ndim + (beside ? g->ndim : 0);
}

static int hypercube_rate_dim(const struct topology *t, int link)
{
    const struct hypercube *g = t->state;
    return link >= g->ndim << g->ndim ? 1 : 0; /* dim_bandwidth[0]: cube links, [1]: Xpress links */
}

/* Half of the routers have a cable across any dimension, and as many Xpress links lie beside; those
 * to the opposite corner all cross (the folded hypercube's 2^n). */
static int64_t hypercube_bisection(const struct topology *t)
{
    const struct hypercube *g = t->state;
    int64_t half = t->nrouter / 2;
    return half * (1 + g->doubled + g->diagonal);
}

/* Sub-cubes. */
static int hypercube_parts(const struct topology *t, int64_t *size)
{
    int n = 0;
    for (int64_t block = t->nodes_per_router; 2 * block <= t->nnode; block *= 2)
        size[n++] = 2 * block;
    return n;
}

const struct topology_type topology_hypercube = {
    .name = "hypercube",
    .create = hypercube_create,
    .start = hypercube_start,
    .next = hypercube_next,
    .distance = hypercube_distance,
    .ends = hypercube_ends,
    .rate_dim = hypercube_rate_dim,
    .bisection = hypercube_bisection,
    .parts = hypercube_parts,
};
