/* routing_steps.c - ways behind the first router, kept for every state, router and goal: asked of
 * the rule itself. */
#include "machine/routing_internal.h"

enum { MOST_STATES = 3 };

static int states_of(const struct routing *r)
{
    switch (r->type->state) {
    case ROUTING_BY_GOAL:
    case ROUTING_BY_CHANCE:
        return 1;
    case ROUTING_BY_ORDER:
    case ROUTING_BY_LEG:
        return 2;
    case ROUTING_BY_STAGE:
        return 3;
    default:
        return 0;
    }
}

/* Whether a packet in `state` is on the way to an intermediate router. */
static bool is_aside(const struct routing *r, int state)
{
    const enum routing_state_kind kind = r->type->state;
    return state == 0 && (kind == ROUTING_BY_LEG ||
                          (kind == ROUTING_BY_STAGE && r->rule == ROUTING_BOOKSIM_UGAL));
}

int routing_state(const struct routing *r, const struct route *p, int *goal)
{
    const enum routing_state_kind kind = r->type->state;
    const int state = kind == ROUTING_BY_STAGE                             ? p->part
                      : kind == ROUTING_BY_ORDER || kind == ROUTING_BY_LEG ? p->phase
                                                                           : 0;
    *goal = p->target;
    if (is_aside(r, state))
        *goal = kind == ROUTING_BY_LEG ? p->via : topology_router_of(r->topology, p->via);
    return state;
}

/* A packet in `state` at `router`, whose leg ends at `goal`; node: one of goal's. */
static struct route pose(const struct routing *r, int state, int router, int goal, int node)
{
    const bool aside = is_aside(r, state);
    return (struct route){.router = router,
                          .target = aside ? (goal + 1) % r->topology->nrouter : goal,
                          .source = -1,
                          .node = node,
                          .via = !aside                             ? -1
                                 : r->type->state == ROUTING_BY_LEG ? goal
                                                                    : node,
                          .phase = state,
                          .part = state,
                          .last = -1};
}

/* Numbers of links among those that leave their router. */
static uint8_t *outputs_of(const struct topology *t, struct arena *a)
{
    uint8_t *output = TAKE(a, t->nlink + 1, uint8_t);
    int *leaving = TAKE(a, t->nrouter, int);
    for (int l = 0; l < t->nlink; l++) {
        int from, to, port;
        topology_link_ends(t, l, &from, &to, &port);
        if (leaving[from] > ROUTING_STEP_MOST) return NULL;
        output[l] = (uint8_t)leaving[from]++;
    }
    return output;
}

/* The step of one packet. */
static uint8_t step_of(const struct routing *r, struct routing_steps *s, const uint8_t *output,
                       struct route p, int goal)
{
    const struct routing_view empty = {0};
    struct route_option o[ROUTING_MOST_OPTIONS];
    int ignored, state = routing_state(r, &p, &ignored), first = 0;
    if (p.router == goal && is_aside(r, state))
        return (uint8_t)(ROUTING_STEP_TURN | 1 << ROUTING_STEP_BITS);
    struct route before = p;
    const int router = p.router, n = routing_next(r, &p, &empty, o);
    if (n == 0) {
        s->eject_count[state] = (uint8_t)routing_eject(r, &p, &first);
        s->eject_first[state] = (uint8_t)first;
        return ROUTING_STEP_EJECT;
    }
    /* Drawn as it will be drawn again. */
    const bool any = p.drawn > 0;
    if (any) s->any[router] = (uint8_t)(output[o->link] - routing_draw(&before, s->fan));
    routing_take(r, &p, o, o->first);
    state = routing_state(r, &p, &ignored);
    s->first[state] = (uint8_t)o->first;
    s->count[state] = (uint8_t)o->count;
    return (uint8_t)((any ? ROUTING_STEP_ANY : output[o->link]) | state << ROUTING_STEP_BITS);
}

const struct routing_steps *routing_steps(const struct routing *r, struct arena *a)
{
    const struct topology *t = r->topology;
    const int nstate = states_of(r), n = t->nrouter;
    /* On a HyperX a first leg may end at the target. */
    if (nstate == 0 || !r->kept || n > ROUTING_KEEP_MOST || r->channels > UINT8_MAX ||
        (r->rule == ROUTING_BOOKSIM_VALIANT && t->spec->family == TOPOLOGY_HYPERX))
        return NULL;
    const uint8_t *output = outputs_of(t, a);
    if (!output) return NULL;
    struct routing_steps *s = TAKE(a, 1, struct routing_steps);
    uint8_t *step = TAKE_FULL(a, size_product(size_product((size_t)nstate, (size_t)n), (size_t)n),
                              uint8_t, true);
    int *node = TAKE(a, n, int); /* 1 + one of each router's; 0: nobody goes there */
    for (int i = 0; i < t->nnode; i++) node[topology_router_of(t, i)] = i + 1;
    *s = (struct routing_steps){.nstate = nstate, .step = step, .any = TAKE(a, n, uint8_t)};
    if (r->type->state == ROUTING_BY_CHANCE) s->fan = t->spec->dims[0];
    for (int k = 0; k < nstate; k++)
        for (int i = 0; i < n; i++)
            for (int goal = 0; goal < n; goal++)
                if (node[goal] > 0)
                    step[(k * n + i) * n + goal] =
                        step_of(r, s, output, pose(r, k, i, goal, node[goal] - 1), goal);
    return s;
}
