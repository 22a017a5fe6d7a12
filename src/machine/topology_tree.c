/* topology_tree.c - k-ary n-trees with d-mod-k routes.
 *
 * k^n nodes, n levels of k^(n-1) switches. A switch (l, w), w with n-1 digits of base k, is joined
 * to the k switches (l+1, w') that differ from it at most in digit l. The leaf of node p is w =
 * floor(p / k). A route climbs to the lowest level where the digits that differ can be mended, at
 * level l through the up port that digit l of the destination names (Valiant: through random ones)
 * and comes down setting digit by digit, without cycles of waiting.
 *
 * Cable c = (l k^(n-1) + w) k + u is the u-th up port of (l, w): link 2c upwards, 2c + 1 downwards.
 */
#include "base/check.h"
#include "machine/topology_internal.h"

enum { TREE_MAX_LEVELS = 24 };

struct tree {
    int k, n;
    int nswitch;                    /* per level */
    bool random;                    /* up ports */
    int power[TREE_MAX_LEVELS + 1]; /* k^i */
};

/* Powers of k first: all numbering is by digits. Sizes are checked on the way, before they can
 * wrap. */
static bool tree_create(struct topology *t, struct arena *a, struct err *e)
{
    struct tree *g = TAKE(a, 1, struct tree);
    g->k = t->spec->dims[0];
    g->n = t->spec->dims[1];
    if (g->k < 2 || g->n < 1 || g->n > TREE_MAX_LEVELS)
        return err_set(e, ERR_CONFIG,
                       "topology fat-tree: arity %d, %d levels; expected at least 2 and 1 to %d",
                       g->k, g->n, TREE_MAX_LEVELS);
    int64_t nodes = 1;
    for (int i = 0; i <= g->n; i++) {
        if (i > 0) nodes *= g->k;
        if (nodes * g->n > INT32_MAX / 4)
            return err_set(e, ERR_CONFIG,
                           "topology fat-tree: %d^%d nodes are more than can be numbered", g->k,
                           g->n);
        g->power[i] = (int)nodes;
    }
    g->nswitch = g->power[g->n - 1];
    /* Valiant: up ports by chance spread what d-mod-k would send over the same switches. */
    g->random = t->spec->routing == ROUTE_VALIANT && g->n > 1;
    t->fixed_routes = !g->random;
    t->state = g;
    t->nrouter = g->n * g->nswitch;
    t->nnode = (int)nodes;
    /* k nodes on each leaf; the switches above have none. */
    t->nodes_per_router = g->k;
    t->nlink = 2 * (g->n - 1) * (int)nodes;
    t->nport = 2 * g->k;
    t->max_hops = 2 * (g->n - 1);
    return true;
}

/* Levels to climb between leaves v and w: one more than the highest digit in which they differ; 0
 * in the same leaf. */
static int tree_climb(const struct tree *g, int v, int w)
{
    int level = 0;
    while (v / g->power[level] != w / g->power[level]) level++;
    return level;
}

/* left: levels still to climb; stage: level of the router; at: local number of the destination
 * node; via: number whose digits are the random up ports. */
static void tree_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    const struct tree *g = t->state;
    c->via = (int)(choice % (uint64_t)g->nswitch);
    c->stage = 0;
    c->left = tree_climb(t->state, c->router, c->target);
}

static int digit(const struct tree *g, int w, int i) { return w / g->power[i] % g->k; }

static bool tree_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    const struct tree *g = t->state;
    if (c->router == c->target) return false;
    int l = c->stage, w = c->router - l * g->nswitch;
    h->vc_class = 0;
    if (c->left > 0) { /* up, through the port named by the destination's digit l */
        int up = g->random ? digit(g, c->via, l)
                 : l == 0  ? c->at
                           : digit(g, c->target, l - 1),
            from = digit(g, w, l);
        h->link = 2 * ((l * g->nswitch + w) * g->k + up);
        h->port = from;
        c->router = (l + 1) * g->nswitch + w + (up - from) * g->power[l];
        c->stage++;
        c->left--;
        return true;
    }
    /* Down: only one way leads to the target. It sets digit l - 1. */
    int up = digit(g, w, l - 1), down = digit(g, c->target, l - 1);
    int below = w + (down - up) * g->power[l - 1];
    h->link = 2 * (((l - 1) * g->nswitch + below) * g->k + up) + 1;
    h->port = g->k + up;
    c->router = (l - 1) * g->nswitch + below;
    c->stage--;
    return true;
}

/* Up and down again. */
static int tree_distance(const struct topology *t, int from, int to)
{
    return 2 * tree_climb(t->state, from, to);
}

static int tree_rate_dim(const struct topology *t, int link)
{
    const struct tree *g = t->state;
    return link / 2 / g->power[g->n]; /* dim_bandwidth[l]: between levels l and l + 1 */
}

static void tree_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct tree *g = t->state;
    /* Cable c back into level, switch and port; the parity of the link is its direction. */
    int up = link / 2 % g->k, w = link / 2 / g->k % g->nswitch, l = tree_rate_dim(t, link);
    int lower = l * g->nswitch + w;
    int upper = (l + 1) * g->nswitch + w + (up - digit(g, w, l)) * g->power[l];
    bool down = link % 2;
    *from = down ? upper : lower;
    *to = down ? lower : upper;
    *port = down ? g->k + up : digit(g, w, l);
}

/* Every switch of the highest level has as many subtrees in one half as in the other: half of its
 * cables. With an odd arity a subtree is cut, too, for which there is no form here. */
static int64_t tree_bisection(const struct topology *t)
{
    const struct tree *g = t->state;
    return g->n > 1 && g->k % 2 == 0 ? t->nnode / 2 : -1;
}

/* Sub-trees. */
static int tree_parts(const struct topology *t, int64_t *size)
{
    int64_t block = 1;
    for (int i = 0; i < t->spec->dims[1]; i++) size[i] = block *= t->spec->dims[0];
    return t->spec->dims[1];
}

const struct topology_type topology_fat_tree = {
    .name = "fat-tree",
    .create = tree_create,
    .start = tree_start,
    .next = tree_next,
    .distance = tree_distance,
    .ends = tree_ends,
    .rate_dim = tree_rate_dim,
    .bisection = tree_bisection,
    .parts = tree_parts,
};
