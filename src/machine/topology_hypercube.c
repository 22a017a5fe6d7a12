/* topology_hypercube.c - binary n-cubes with e-cube routes, and the 16-processor Origin's Xpress links.
 *
 * The link that leaves router r in dimension d is r n + d. With Xpress, one more link per
 * router, n 2^n + r, joins opposite corners; a route between opposite corners takes it, others are e-cube. */
#include "base/check.h"
#include "machine/topology_internal.h"

struct hypercube {
    int ndim;
    bool xpress;
};

static bool hypercube_create(struct topology *t, struct arena *a, struct err *e)
{
    const struct topology_spec *s = t->spec;
    struct hypercube *g = TAKE(a, 1, struct hypercube);
    int n = s->dims[0];
    if (n < 0 || n > 24)
        return err_set(e, ERR_CONFIG, "topology hypercube: %d dimensions; expected 0 to 24 (2^n routers)", n);
    if (s->xpress && n < 2)
        return err_set(e, ERR_CONFIG,
                       "topology hypercube: Xpress links need opposite corners, so at least 2 dimensions");
    g->ndim = n;
    g->xpress = s->xpress;
    t->state = g;
    t->nrouter = 1 << n;
    t->nport = n + (g->xpress ? 1 : 0);
    t->nlink = t->nport << n;
    t->max_hops = g->xpress && n == 2 ? 1 : n;
    if (g->xpress && n > 2) t->max_hops = n - 1;
    return true;
}

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
    if (g->xpress && diff == all) {
        h->link = (g->ndim << g->ndim) + c->router;
        h->port = g->ndim;
        c->router = c->target;
        return true;
    }
    int d = __builtin_ctz(diff);
    h->link = c->router * g->ndim + d;
    h->port = d;
    c->router ^= 1 << d;
    return true;
}

static int hypercube_distance(const struct topology *t, int from, int to)
{
    const struct hypercube *g = t->state;
    unsigned diff = (unsigned)(from ^ to);
    if (g->xpress && diff == (1u << g->ndim) - 1) return 1;
    return __builtin_popcount(diff);
}

static void hypercube_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct hypercube *g = t->state;
    int first_xpress = g->ndim << g->ndim;
    if (link >= first_xpress) {
        *from = link - first_xpress;
        *to = *from ^ ((1 << g->ndim) - 1);
        *port = g->ndim;
        return;
    }
    *from = link / g->ndim;
    *port = link % g->ndim;
    *to = *from ^ (1 << *port);
}

static int hypercube_rate_dim(const struct topology *t, int link)
{
    const struct hypercube *g = t->state;
    return link >= g->ndim << g->ndim ? 1 : 0; /* dim_bandwidth[0]: cube links, [1]: Xpress links */
}

const struct topology_type topology_hypercube = {
    .name = "hypercube",
    .create = hypercube_create,
    .start = hypercube_start,
    .next = hypercube_next,
    .distance = hypercube_distance,
    .ends = hypercube_ends,
    .rate_dim = hypercube_rate_dim,
};
