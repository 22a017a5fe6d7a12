/* topology_twisted.c - twisted tori: rings that come back shifted.
 *
 * dims = {k_0, k_1, ...} as of a torus; topology.twist = {t_1, t_2, ...}: who leaves dimension d
 * over its edge upwards comes in t_d places further up in dimension 0, downwards t_d places further
 * down. {2a, a} with twist {a} is the rectangular twisted torus, whose diameter is a where the
 * torus has 3a/2 (Camara et al., "Twisted torus topologies for enhanced interconnection networks",
 * IEEE Trans. Parallel Distrib. Syst. 21, 2010; the doubly twisted torus of Sequin 1981).
 *
 * From one router to another there are several offsets: for every number of times that an edge is
 * crossed, another one of dimension 0. The one with the fewest links is taken; of equal ones the
 * first in the order in which no edge, the upper one, the lower one is crossed, dimension 1
 * fastest. Routes go dimension by dimension, the lowest first. In a dimension no edge is crossed
 * twice, so that two classes do: 1 until the edge has been crossed.
 *
 * Link: dimension d of router r upwards 2 (r n + d), downwards one more. */
#include "base/check.h"
#include "machine/topology_internal.h"

struct twisted {
    int ndim;
    int radix[MACHINE_MAX_DIMS], stride[MACHINE_MAX_DIMS];
    int twist[MACHINE_MAX_DIMS]; /* [0] is 0 */
};

static bool twisted_numbers(struct twisted *g, const struct topology_spec *s, struct err *e)
{
    int64_t nrouter = 1;
    if (s->ndim < 2 || s->ndim > MACHINE_MAX_DIMS || s->ntwist < 1 || s->ntwist >= s->ndim)
        return err_set(e, ERR_CONFIG,
                       "topology twisted-torus: %d dimensions, %d numbers in topology.twist; "
                       "expected 2 to %d dimensions and a twist for each but the first",
                       s->ndim, s->ntwist, MACHINE_MAX_DIMS);
    for (int d = 0; d < s->ndim; d++) {
        if (s->dims[d] < 2)
            return err_set(e, ERR_CONFIG,
                           "topology twisted-torus: radix %d in dimension %d; expected at least 2",
                           s->dims[d], d);
        g->radix[d] = s->dims[d];
        g->stride[d] = (int)nrouter;
        nrouter *= s->dims[d];
        if (nrouter * s->nodes_per_router > INT32_MAX / (2 * s->ndim))
            return err_set(e, ERR_CONFIG,
                           "topology twisted-torus: more routers than can be numbered");
    }
    for (int d = 0; d < s->ntwist; d++) {
        if (s->twist[d] < 0 || s->twist[d] >= s->dims[0])
            return err_set(e, ERR_CONFIG,
                           "topology twisted-torus: twist %d of dimension %d; expected 0 to %d",
                           s->twist[d], d + 1, s->dims[0] - 1);
        g->twist[d + 1] = s->twist[d];
    }
    g->ndim = s->ndim;
    return true;
}

/* The offsets from one router to another with the fewest links; returns how many links. */
static int twisted_offset(const struct twisted *g, int from, int to, int best[MACHINE_MAX_DIMS])
{
    int diff[MACHINE_MAX_DIMS], crossed[MACHINE_MAX_DIMS] = {0}, least = -1;
    for (int d = 0; d < g->ndim; d++)
        diff[d] = to / g->stride[d] % g->radix[d] - from / g->stride[d] % g->radix[d];
    for (;;) {
        /* An upper edge crossed leads k_d places on, and twist further in dimension 0, which the
         * offset of dimension 0 has to make good; there the shorter way round. */
        int offset[MACHINE_MAX_DIMS], links = 0, x = diff[0], k = g->radix[0];
        for (int i = 1; i < g->ndim; i++) {
            offset[i] = diff[i] + crossed[i] * g->radix[i];
            x -= crossed[i] * g->twist[i];
            links += offset[i] < 0 ? -offset[i] : offset[i];
        }
        x = ((x % k) + k) % k;
        offset[0] = 2 * x <= k ? x : x - k;
        links += offset[0] < 0 ? -offset[0] : offset[0];
        if (least < 0 || links < least) {
            least = links;
            for (int i = 0; i < g->ndim; i++) best[i] = offset[i];
        }
        /* The next combination of crossings: 0, 1, -1 in each dimension but the first. */
        int d = 1;
        while (d < g->ndim && crossed[d] < 0) crossed[d++] = 0;
        if (d == g->ndim) break;
        crossed[d] = crossed[d] == 0 ? 1 : -1;
    }
    return least;
}

/* From the origin to all routers: every router sees the same network. */
static int twisted_diameter(const struct twisted *g, int nrouter)
{
    int longest = 0, offset[MACHINE_MAX_DIMS];
    for (int r = 0; r < nrouter; r++) {
        int n = twisted_offset(g, 0, r, offset);
        if (n > longest) longest = n;
    }
    return longest;
}

static bool twisted_create(struct topology *t, struct arena *a, struct err *e)
{
    struct twisted *g = TAKE(a, 1, struct twisted);
    if (!twisted_numbers(g, t->spec, e)) return false;
    t->state = g;
    t->nrouter = g->stride[g->ndim - 1] * g->radix[g->ndim - 1];
    t->nport = 2 * g->ndim;
    t->nlink = t->nport * t->nrouter;
    t->nclass = 2;
    t->max_hops = twisted_diameter(g, t->nrouter);
    return true;
}

/* Enter the first dimension >= c->stage with an offset. The offset is the whole route's: what is
 * mended does not change those of other dimensions, since via keeps them from the start. */
static void twisted_turn(const struct twisted *g, struct route_cursor *c)
{
    int offset[MACHINE_MAX_DIMS];
    twisted_offset(g, c->via, c->target, offset);
    for (int d = c->stage; d < g->ndim; d++) {
        if (offset[d] == 0) continue;
        c->stage = d;
        c->at = c->router / g->stride[d] % g->radix[d];
        c->step = offset[d] < 0 ? -1 : 1;
        c->left = offset[d] < 0 ? -offset[d] : offset[d];
        return;
    }
    c->left = 0;
}

/* via: the router where the route begins. */
static void twisted_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    (void)choice;
    c->via = c->router;
    c->stage = c->left = 0;
    if (c->router != c->target) twisted_turn(t->state, c);
}

/* The router next to r in dimension d, up or down; over the edge with the twist. */
static int twisted_neighbour(const struct twisted *g, int r, int d, bool down)
{
    int k = g->radix[d], x = r / g->stride[d] % k, y = down ? x - 1 : x + 1;
    if (y >= 0 && y < k) return r + (down ? -g->stride[d] : g->stride[d]);
    /* Dimension 0 has no twist, so that its own coordinate is not changed twice. */
    y = down ? k - 1 : 0;
    r += (y - x) * g->stride[d];
    int k0 = g->radix[0], x0 = r % k0;
    return r - x0 + (x0 + (down ? k0 - g->twist[d] : g->twist[d])) % k0;
}

static bool twisted_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    const struct twisted *g = t->state;
    if (c->left == 0) return false;
    int d = c->stage, k = g->radix[d];
    bool down = c->step < 0;
    /* Class 1 while the edge of this dimension is still ahead or being crossed. */
    h->vc_class = down ? c->at - c->left < 0 : c->at + c->left >= k;
    h->port = 2 * d + !down;
    h->link = 2 * (c->router * g->ndim + d) + down;
    c->router = twisted_neighbour(g, c->router, d, down);
    c->at = (c->at + c->step + k) % k;
    if (--c->left == 0 && c->router != c->target) {
        c->stage++;
        twisted_turn(g, c);
    }
    return true;
}

static int twisted_distance(const struct topology *t, int from, int to)
{
    int offset[MACHINE_MAX_DIMS];
    return twisted_offset(t->state, from, to, offset);
}

static void twisted_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct twisted *g = t->state;
    int d = link / 2 % g->ndim;
    bool down = link % 2;
    *from = link / 2 / g->ndim;
    *to = twisted_neighbour(g, *from, d, down);
    *port = 2 * d + !down;
}

static int twisted_rate_dim(const struct topology *t, int link)
{
    const struct twisted *g = t->state;
    return link / 2 % g->ndim;
}

const struct topology_type topology_twisted_torus = {
    .name = "twisted-torus",
    .create = twisted_create,
    .start = twisted_start,
    .next = twisted_next,
    .distance = twisted_distance,
    .ends = twisted_ends,
    .rate_dim = twisted_rate_dim,
    .parts = topology_grid_parts,
};
