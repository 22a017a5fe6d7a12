/* topology_megafly.c - Dragonfly+ or Megafly: groups of leaf and spine routers, joined by links
 * between spines; minimal routes.
 *
 * dims = {p, l, s, h, g}: p nodes on each leaf, l leaves and s spines in a group, h global links on
 * each spine, g groups (0: the most, s h + 1). In a group every leaf is joined to every spine;
 * between groups there is the same number of links for any two (Shpiner et al., "Dragonfly+: low
 * cost topology for scaling datacenters", HiPINEB 2017; Flajslik et al., "Megafly: a topology for
 * exascale systems", ISC 2018). Global port q of group G, at its spine floor(q / h), leads to group
 * G + 1 + (q mod (g-1)) mod g, as in topology_dragonfly.c.
 *
 * A route climbs to the spine that has the link to the other group and comes down from that link's
 * other end; within a group it goes by the spine that its ends name. Nothing climbs after it came
 * down or crossed, hence no circle of waiting with one class.
 *
 * Routers: the leaves of all groups, then the spines. Links: cable leaf-spine (leaf s + spine): 2c
 * up and 2c + 1 down; then the global ones by group and port. */
#include "base/check.h"
#include "machine/topology_internal.h"

struct megafly {
    int l, s, h, g;
    int copies;       /* links between two groups */
    int used;         /* global ports in use per group */
    int first_spine;  /* number of the first spine: as many leaves */
    int first_global; /* number of the first global link */
};

static bool megafly_sizes(const struct topology *t, int64_t groups, int64_t most, struct err *e)
{
    const int *dims = t->spec->dims;
    bool positive = dims[0] >= 1 && dims[1] >= 1 && dims[2] >= 1 && dims[3] >= 1;
    if (!positive || groups < 2 || groups > most)
        return err_set(e, ERR_CONFIG,
                       "topology dragonfly-plus: {%d nodes/leaf, %d leaves/group, %d spines/group, "
                       "%d global links/spine, %d groups}; expected at least {1, 1, 1, 1, 2} and "
                       "no more groups than spines x global links + 1",
                       dims[0], dims[1], dims[2], dims[3], dims[4]);
    /* Cables in a group, nodes and global links, all groups: two links each at most. */
    int64_t in_group = (int64_t)dims[1] * dims[2];
    if (in_group > INT32_MAX || (int64_t)dims[0] * dims[1] > INT32_MAX ||
        groups > INT32_MAX / 4 / (in_group + (int64_t)dims[0] * dims[1] + most))
        return err_set(e, ERR_CONFIG,
                       "topology dragonfly-plus: more nodes and links than can be numbered");
    return true;
}

static bool megafly_create(struct topology *t, struct arena *a, struct err *e)
{
    const int *dims = t->spec->dims;
    int64_t most = (int64_t)dims[2] * dims[3] + 1, groups = dims[4] > 0 ? dims[4] : most;
    struct megafly *g = TAKE(a, 1, struct megafly);
    if (!megafly_sizes(t, groups, most, e)) return false;
    *g = (struct megafly){.l = dims[1], .s = dims[2], .h = dims[3], .g = (int)groups};
    g->copies = (int)((most - 1) / (groups - 1));
    g->used = g->copies * (g->g - 1);
    g->first_spine = g->g * g->l;
    g->first_global = 2 * g->first_spine * g->s;
    t->state = g;
    t->nrouter = g->g * (g->l + g->s);
    /* Nodes hang on leaves alone, which have the lowest numbers. */
    t->nodes_per_router = dims[0];
    t->nnode = g->first_spine * dims[0];
    t->nlink = g->first_global + g->g * g->used;
    /* A leaf has its spines, a spine its leaves and then its global links. */
    t->nport = g->l + g->h > g->s ? g->l + g->h : g->s;
    t->max_hops = 3;
    return true;
}

/* stage: links behind; via: what picks among equal spines and among parallel global links. */
static void megafly_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    (void)t;
    (void)choice;
    c->stage = 0;
    c->via = (int)(((unsigned)c->router + (unsigned)c->target + (unsigned)c->at) & INT32_MAX);
}

static void up(const struct megafly *g, struct route_cursor *c, int spine, struct hop *h)
{
    h->link = 2 * (c->router * g->s + spine);
    h->port = c->router % g->l;
    c->router = g->first_spine + c->router / g->l * g->s + spine;
}

static void down(const struct megafly *g, struct route_cursor *c, struct hop *h)
{
    int spine = (c->router - g->first_spine) % g->s;
    h->link = 2 * (c->target * g->s + spine) + 1;
    h->port = spine;
    c->router = c->target;
}

static bool megafly_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    const struct megafly *g = t->state;
    if (c->router == c->target) return false;
    h->vc_class = 0;
    int to = c->target / g->l;
    bool on_leaf = c->router < g->first_spine;
    int group = on_leaf ? c->router / g->l : (c->router - g->first_spine) / g->s;
    /* Within the group: up to any spine, and down. */
    if (group == to) {
        if (on_leaf) up(g, c, c->via % g->s, h);
        else down(g, c, h);
        return true;
    }
    int q = (to - group - 1 + g->g) % g->g + (g->g - 1) * (c->via % g->copies);
    if (on_leaf) {
        up(g, c, q / g->h, h);
        return true;
    }
    /* The other end of a link has the port that leads back, in the same copy. */
    int slot = q % (g->g - 1), peer = g->g - 2 - slot + q - slot;
    h->link = g->first_global + group * g->used + q;
    h->port = g->l + peer % g->h;
    c->router = g->first_spine + to * g->s + peer / g->h;
    return true;
}

/* Leaves of one group are two links apart, others three. Between other routers nobody asks. */
static int megafly_distance(const struct topology *t, int from, int to)
{
    const struct megafly *g = t->state;
    if (from == to) return 0;
    return from / g->l == to / g->l ? 2 : 3;
}

/* The numbering of the header, backwards. */
static void megafly_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct megafly *g = t->state;
    if (link < g->first_global) {
        int leaf = link / 2 / g->s, spine = link / 2 % g->s;
        int above = g->first_spine + leaf / g->l * g->s + spine;
        bool upwards = link % 2 == 0;
        *from = upwards ? leaf : above;
        *to = upwards ? above : leaf;
        *port = upwards ? leaf % g->l : spine;
        return;
    }
    int group = (link - g->first_global) / g->used, q = (link - g->first_global) % g->used;
    int slot = q % (g->g - 1), peer = g->g - 2 - slot + q - slot;
    *from = g->first_spine + group * g->s + q / g->h;
    *to = g->first_spine + (group + 1 + slot) % g->g * g->s + peer / g->h;
    *port = g->l + peer % g->h;
}

/* dim_bandwidth: between leaves and spines, global. */
static int megafly_rate_dim(const struct topology *t, int link)
{
    const struct megafly *g = t->state;
    return link < g->first_global ? 0 : 1;
}

const struct topology_type topology_dragonfly_plus = {
    .name = "dragonfly-plus",
    .create = megafly_create,
    .start = megafly_start,
    .next = megafly_next,
    .distance = megafly_distance,
    .ends = megafly_ends,
    .rate_dim = megafly_rate_dim,
    .parts = topology_group_parts,
};
