/* routing.c - the table of routing rules, and what all of them share: random numbers, classes of
 * channels, walks through an empty network. */
#include "machine/routing.h"

#include "machine/routing_internal.h"

static const struct routing_type *const lists[] = {
    routing_lattice_types,  routing_tree_types, routing_dragonfly_types,
    routing_adaptive_types, routing_leg_types,
};

/* The first entry for a rule and family holds: special ones stand before general ones. */
static const struct routing_type *type_of(enum routing_rule rule, enum topology_family family)
{
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        for (const struct routing_type *t = lists[i]; t->create; t++)
            if (t->rule == rule && (t->families == 0 || t->families >> family & 1)) return t;
    return NULL;
}

struct routing *routing_create(const struct topology *t, enum routing_rule rule, int channels,
                               struct arena *a, struct err *e)
{
    const enum topology_family family = t->spec->family;
    const struct routing_type *type =
        topology_has(family, TOPOLOGY_NO_LINKS) ? NULL : type_of(rule, family);
    if (!type) {
        err_set(e, ERR_CONFIG, "network.routing '%s' is not for topology '%s'",
                routing_rule_name(rule), topology_family_name(family));
        return NULL;
    }
    /* The other rules know the family's links, and would go over those that failed. */
    if (rule != ROUTING_DETERMINISTIC && !topology_whole(t)) {
        err_set(e, ERR_CONFIG,
                "network.routing '%s' does not go around what network.failed names; expected "
                "'deterministic'",
                routing_rule_name(rule));
        return NULL;
    }
    struct routing *r = TAKE(a, 1, struct routing);
    *r = (struct routing){
        .topology = t, .type = type, .rule = rule, .channels = channels, .max_hops = t->max_hops};
    r->most = ROUTING_MOST_OPTIONS;
    r->end = TAKE(a, t->nlink + 1, int);
    for (int i = 0, from, port; i < t->nlink; i++)
        topology_link_ends(t, i, &from, &r->end[i], &port);
    if (!type->create(r, a, e)) return NULL;
    /* Rules by dimensions do not use a hypercube's Xpress links, its own routes do. */
    if (t->spec->xpress) r->minimal = false;
    return r;
}

void routing_keep(struct routing *r, struct arena *a)
{
    if (r->keep && r->topology->nrouter <= ROUTING_KEEP_MOST) r->keep(r, a);
}

struct route routing_start(const struct routing *r, int src, int dst, uint64_t choice)
{
    const struct topology *t = r->topology;
    const int router = topology_router_of(t, src);
    return (struct route){.router = router,
                          .source = src,
                          .target = topology_router_of(t, dst),
                          .node = dst,
                          .via = -1,
                          .last = -1,
                          .channel = -1,
                          .choice = choice};
}

int routing_inject(const struct routing *r, struct route *p, int *first)
{
    *first = 0;
    return r->type->inject ? r->type->inject(r, p, first) : r->channels;
}

int routing_eject(const struct routing *r, const struct route *p, int *first)
{
    *first = 0;
    return r->type->eject ? r->type->eject(r, p, first) : r->channels;
}

int routing_next(const struct routing *r, struct route *p, const struct routing_view *view,
                 struct route_option *option)
{
    return r->type->next(r, p, view, option);
}

/* Nothing is in the way: the option of the highest priority, of equals the first, on its last
 * channel, which is none of the escape channels. */
bool routing_empty(const struct routing *r, struct route *p, int *link)
{
    const struct routing_view empty = {0};
    struct route_option option[ROUTING_MOST_OPTIONS];
    const int n = routing_next(r, p, &empty, option);
    if (n == 0) return false;
    const struct route_option *best = option;
    for (int i = 1; i < n; i++)
        if (option[i].priority > best->priority) best = &option[i];
    CHECK(p->hops < r->max_hops);
    *link = best->link;
    routing_take(r, p, best, best->first + best->count - 1);
    return true;
}
