/* topology_dragonfly.c - groups of routers, all-to-all inside and between groups; minimal and
 * Valiant routes.
 *
 * dims = {p, a, h, g}: p nodes and h global links per router, a routers per group, g groups (0: the
 * most, a h + 1). Global port q of group G, at its router floor(q / h), is slot q mod (g-1) of copy
 * floor(q / (g-1)) of the links between two groups. Slot s leads to group G + 1 + s mod g, or with
 * absolute numbers to the s-th of the other groups; the same copy leads back from there (Hastings
 * et al., "Comparing global link arrangements for dragonfly networks", CLUSTER 2015). Minimal:
 * local, global, local. Valiant: minimal to a random third group, then minimal. The class is the
 * number of global links behind, so that routes cannot wait in a circle.
 *
 * Links: local r (a-1) + j', j' the other router of the group less one where above; then global by
 * group and port. */
#include "base/check.h"
#include "machine/topology_internal.h"

struct dragonfly {
    int a, h, g;
    int copies;       /* links between two groups */
    int used;         /* global ports in use per group */
    int first_global; /* number of the first global link */
    bool valiant, absolute;
};

/* With fewer groups than a h + 1 the global ports are shared out evenly: `copies` links between any
 * two groups; the rest stays unused. */
static bool dragonfly_create(struct topology *t, struct arena *a, struct err *e)
{
    const int *dims = t->spec->dims;
    int64_t p = dims[0], most = (int64_t)dims[1] * dims[2] + 1,
            groups = dims[3] > 0 ? dims[3] : most;
    struct dragonfly *g = TAKE(a, 1, struct dragonfly);
    if (p < 1 || dims[1] < 1 || dims[2] < 1 || groups < 2 || groups > most)
        return err_set(e, ERR_CONFIG,
                       "topology dragonfly: {%d nodes/router, %d routers/group, %d global "
                       "links/router, %d groups}; expected at least {1, 1, 1, 2} and no more "
                       "groups than routers x global links + 1",
                       dims[0], dims[1], dims[2], dims[3]);
    if (groups * dims[1] * (p + dims[1] + dims[2]) > INT32_MAX / 2)
        return err_set(e, ERR_CONFIG,
                       "topology dragonfly: more nodes and links than can be numbered");
    *g = (struct dragonfly){.a = dims[1], .h = dims[2], .g = (int)groups};
    /* Links are numbered group by group: local ones first, then the global ports in use. */
    g->copies = (int)((most - 1) / (groups - 1));
    g->used = g->copies * (g->g - 1);
    g->absolute = t->spec->absolute;
    g->valiant = t->spec->routing == ROUTE_VALIANT && g->g > 2;
    t->state = g;
    t->nrouter = g->g * g->a;
    t->nodes_per_router = (int)p;
    g->first_global = t->nrouter * (g->a - 1);
    t->nlink = g->first_global + g->g * g->used;
    t->nport = g->a - 1 + g->h;
    /* local, global, local; Valiant: local, global, local, global, local. The class is the number
     * of global links behind. */
    t->max_hops = g->valiant ? 5 : 3;
    t->nclass = g->valiant ? 3 : 2;
    t->fixed_routes = !g->valiant;
    return true;
}

/* The slot of group `from` whose links lead to group `to`, and the other way about. */
static int slot_to(const struct dragonfly *g, int from, int to)
{
    return g->absolute ? to - (to > from) : (to - from - 1 + g->g) % g->g;
}
static int group_at(const struct dragonfly *g, int from, int slot)
{
    return g->absolute ? slot + (slot >= from) : (from + 1 + slot) % g->g;
}

/* the global port of group `from` that leads to group `to`, in the copy that these ends use */
static int global_port(const struct dragonfly *g, int from, int to, int ends)
{
    return slot_to(g, from, to) + (g->g - 1) * (ends % g->copies);
}

/* stage: global links behind; via: group to pass through first, -1: none; at: what picks among
 * parallel links */
static void dragonfly_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    const struct dragonfly *g = t->state;
    int from = c->router / g->a, to = c->target / g->a;
    c->stage = 0;
    c->via = -1;
    c->at = c->router + c->target;
    if (!g->valiant || from == to) return;
    /* A third group by chance: drawn from g - 2 numbers, which step over both ends. */
    int low = from < to ? from : to, high = from < to ? to : from;
    int via = (int)(choice % (uint64_t)(g->g - 2));
    via += via >= low;
    via += via >= high;
    c->via = via;
}

/* A router has no link to itself: numbers above it move down by one. */
static void local_hop(const struct dragonfly *g, struct route_cursor *c, int to, struct hop *h)
{
    int i = c->router % g->a, j = to % g->a;
    h->link = c->router * (g->a - 1) + j - (j > i);
    h->port = i - (i > j);
    c->router = to;
}

static bool dragonfly_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    const struct dragonfly *g = t->state;
    int group = c->router / g->a, goal = c->via >= 0 ? c->via : c->target / g->a;
    if (c->router == c->target && c->via < 0) return false;
    h->vc_class = c->stage;
    if (group == goal) { /* the last, local, link */
        local_hop(g, c, c->target, h);
        return true;
    }
    /* To the router of this group that has the global link, if this is not the one. */
    int q = global_port(g, group, goal, c->at), gate = group * g->a + q / g->h;
    if (gate != c->router) {
        local_hop(g, c, gate, h);
        return true;
    }
    const int peer = slot_to(g, goal, group) + q - slot_to(g, group, goal);
    h->link = g->first_global + group * g->used + q;
    h->port = g->a - 1 + peer % g->h;
    c->router = goal * g->a + peer / g->h;
    c->stage++;
    /* The third group is reached: from here minimal to the target. */
    if (goal == c->via) c->via = -1;
    return true;
}

/* The numbering of the header, backwards. */
static void dragonfly_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct dragonfly *g = t->state;
    if (link < g->first_global) {
        *from = link / (g->a - 1);
        int i = *from % g->a, j = link % (g->a - 1);
        j += j >= i;
        *to = *from - i + j;
        *port = i - (i > j);
        return;
    }
    int group = (link - g->first_global) / g->used, q = (link - g->first_global) % g->used;
    const int slot = q % (g->g - 1), goal = group_at(g, group, slot),
              peer = slot_to(g, goal, group) + q - slot;
    *from = group * g->a + q / g->h;
    *to = goal * g->a + peer / g->h;
    *port = g->a - 1 + peer % g->h;
}

static int dragonfly_rate_dim(const struct topology *t, int link)
{
    const struct dragonfly *g = t->state;
    return link < g->first_global ? 0 : 1; /* dim_bandwidth: local, global */
}

/* Nodes of a router, routers of a group. */
int topology_group_parts(const struct topology *t, int64_t *size)
{
    *size = (int64_t)t->spec->dims[0] * t->spec->dims[1];
    return 1;
}

const struct topology_type topology_dragonfly = {
    .name = "dragonfly",
    .create = dragonfly_create,
    .start = dragonfly_start,
    .next = dragonfly_next,
    .ends = dragonfly_ends,
    .rate_dim = dragonfly_rate_dim,
    .parts = topology_group_parts,
};
