/* routing_tree.c - fat trees: which up port; the way down is the only one.
 *
 * Links are numbered as in topology_tree.c: cable c = (l k^(n-1) + w) k + u is the u-th up port of
 * switch (l, w), link 2c upwards and 2c + 1 downwards. Up then down never waits in a circle, so
 * that every packet may use any channel. */
#include "machine/routing_internal.h"

struct tree {
    int k, nswitch; /* ports each way; switches of a level */
};

static bool tree_create(struct routing *r, struct arena *a, struct err *e)
{
    struct tree *g = TAKE(a, 1, struct tree);
    g->k = r->topology->spec->dims[0];
    g->nswitch = r->topology->nrouter / r->topology->spec->dims[1];
    r->state = g;
    r->by_load = r->rule != ROUTING_NCA;
    r->minimal = r->kept = true;
    if (r->rule != ROUTING_ADAPTIVE) r->most = 1;
    if (g->k > ROUTING_MOST_OPTIONS)
        return err_set(e, ERR_CONFIG,
                       "network.routing on a fat-tree of arity %d; expected at most %d", g->k,
                       ROUTING_MOST_OPTIONS);
    return routing_needs(r, 1, "", e);
}

/* Nearest common ancestor: any up port; the emptier of two drawn with replacement, of equals the
 * first; or all of them, the emptiest first. */
static int tree_up(const struct routing *r, struct route *p, const struct routing_view *view,
                   int first, struct route_option *option)
{
    const struct tree *g = r->state;
    const struct route_option any = {.count = r->channels, .priority = 1};
    int n = r->rule == ROUTING_ADAPTIVE ? g->k : 1, port = 0;
    if (n == 1) port = routing_draw(p, g->k);
    if (r->rule == ROUTING_ANCA) {
        const int other = routing_draw(p, g->k);
        if (routing_used(view, first + 2 * port) > routing_used(view, first + 2 * other))
            port = other;
    }
    int best = 0;
    for (int i = 0; i < n; i++) {
        option[i] = any;
        option[i].link = first + 2 * (port + i);
        if (i > 0 && routing_used(view, option[i].link) < routing_used(view, option[best].link))
            best = i;
    }
    option[best].priority = 2;
    return n;
}

/* At level l a switch w is above the target if their digits from l on are equal. */
static int tree_next(const struct routing *r, struct route *p, const struct routing_view *view,
                     struct route_option *option)
{
    const struct tree *g = r->state;
    const int l = p->router / g->nswitch, w = p->router % g->nswitch;
    int below = 1;
    if (p->router == p->target) return 0;
    for (int i = 0; i < l; i++) below *= g->k;
    if (w / below != p->target / below) return tree_up(r, p, view, 2 * p->router * g->k, option);
    /* Down: the switch below has the target's digit l - 1, its up port has ours. */
    below /= g->k;
    const int up = w / below % g->k, down = p->target / below % g->k;
    const int under = (l - 1) * g->nswitch + w + (down - up) * below;
    *option = (struct route_option){.link = 2 * (under * g->k + up) + 1, .count = r->channels};
    return 1;
}

enum { TREES = 1 << TOPOLOGY_FAT_TREE };

const struct routing_type routing_tree_types[] = {
    {ROUTING_NCA, TREES, tree_create, NULL, tree_next, NULL, ROUTING_BY_CHANCE},
    {ROUTING_ANCA, TREES, tree_create, NULL, tree_next, NULL, ROUTING_BY_MORE},
    {ROUTING_ADAPTIVE, TREES, tree_create, NULL, tree_next, NULL, ROUTING_BY_MORE},
    {0, 0, NULL, NULL, NULL, NULL, 0},
};
