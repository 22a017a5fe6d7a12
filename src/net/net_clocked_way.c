/* net_clocked_way.c - ways on, channels and loads of net_clocked.h, and out of the network; its
 * pools.
 *
 * Behind its first router the way of a packet is a byte of a table (routing_steps), where its rule
 * has one: the leg carries the row, that is the state of the packet and the goal of its leg, so
 * that the route itself need not be touched. Else, and always at the first router, the rule is
 * asked. */
#include "net/net_clocked_step.h"

/* ---- loads ---- */

/* Flits of v whose credits are not back, or that are known already to come later than now: level
 * flit. See router_used. */
static int32_t flits_used(const struct clocked *g, const struct clocked_port *p,
                          const struct clocked_lane *v)
{
    const union clocked_stay *stay = clocked_ring(g, v);
    const int32_t late = g->credit + p->wire, sent = g->now + g->reach + p->wire;
    /* The latest first: those before it are back as soon as one is. */
    int32_t used = 0;
    for (int32_t k = v->out - 1; k >= 0 && k >= v->out - g->ring; k--, used++)
        if (stay[clocked_place(g, k)].go + late <= g->now) break;
    for (int32_t k = v->in - 1; k >= 0 && k >= v->in - g->ring; k--, used--)
        if (stay[clocked_place(g, k)].come < sent) break;
    return used;
}

/* The first of these, credits that are not back: level packet. An entry tells when the first flit
 * of a packet left; the others followed, one in a cycle, and so do their credits. */
static int32_t packets_used(const struct clocked *g, const struct clocked_port *p,
                            const struct clocked_lane *v)
{
    const union clocked_stay *stay = clocked_ring(g, v);
    const int32_t late = g->credit + p->wire;
    int32_t used = 0, end = v->out;
    for (int32_t k = v->nleft - 1; k >= 0; end = stay[clocked_place(g, k--)].position) {
        const union clocked_stay *s = &stay[clocked_place(g, k)];
        const int32_t flits = end - s->position, since = g->now - late - s->at;
        const int32_t back = since < 0 ? 0 : since / g->flit + 1;
        if (back >= flits) break;
        used += flits - back;
    }
    return used;
}

/* Mostly nothing is under way, and no lane has to be looked at. */
int64_t clocked_used(const void *of, int link)
{
    const struct clocked *g = of;
    const struct clocked_port *p = &g->port[g->port_of[link]];
    int32_t used = p->held;
    const bool home = p->passed + g->credit + p->wire <= g->now; /* all credits of what left */
    if (home && used == 0) return 0;
    for (uint32_t k = 0; k < g->nchannel; k++) {
        if (p->lane[k].clear <= g->now) continue; /* it has nothing, and all its credits */
        if (!g->whole) used += flits_used(g, p, &p->lane[k]);
        else if (!home) used += packets_used(g, p, &p->lane[k]);
    }
    /* A packet that is still crossing. */
    if (g->whole && p->free > g->now) used -= (p->free - g->now) / g->flit;
    return used;
}

/* ---- ways on ---- */

struct clocked_way clocked_option(const struct clocked *g, const struct clocked_lane *v, int i)
{
    if (v->head.noption <= 1) return (struct clocked_way){v->way, v->head.first, v->head.count, 0};
    const struct route_option *o = &g->option[clocked_number(g, v) * CLOCKED_OPTIONS + i];
    return (struct clocked_way){&g->port[g->port_of[o->link]], o->first, o->count, o->priority};
}

/* The one way on of v's front, or the first of them. */
static void way_is(struct clocked_lane *v, int noption, struct clocked_port *p, int first,
                   int count)
{
    v->way = p;
    v->head = (struct clocked_head){LANE_ASKING, (uint8_t)noption, (uint8_t)first, (uint8_t)count};
}

/* l goes over option o on its channel `number`. */
static void take(struct clocked *g, struct clocked_leg *l, const struct route_option *o, int number)
{
    struct route *way = &l->worm->route;
    routing_take(g->routing, way, o, number);
    if (!g->steps) return;
    l->state = routing_state(g->routing, way, &l->goal);
    l->row = l->state * g->nrouter * g->nrouter + l->goal;
}

/* Rules that look at loads see them as they are now: of a port the flits that it was given, less
 * the credits that are back. */
void clocked_route(struct clocked *g, struct clocked_lane *v)
{
    const struct routing_view view = {clocked_used, g};
    struct route_option *o = &g->option[clocked_number(g, v) * CLOCKED_OPTIONS];
    struct route *way = &v->front->worm->route;
    const bool looks = g->looks_on || (g->looks && way->channel < 0);
    const int n = routing_next(g->routing, way, &view, o);
    if (n > 0) {
        way_is(v, n, &g->port[g->port_of[o->link]], o->first, o->count);
        if (n > 1) v->other = g->port[g->port_of[o[1].link]].out;
        /* To the table the channels of one way are all alike. */
        else if (g->steps) take(g, v->front, o, o->first);
    } else {
        int first = 0;
        const int count = routing_eject(g->routing, way, &first);
        way_is(v, 0, g->sink + way->node, first, count);
    }
    if (looks) v->due += g->setup;
}

/* A leg that ends here goes on in the state of the step, towards the target: one more step, which
 * is no such end. A draw takes the same number out of the packet's row as the rule itself would. */
void clocked_route_on(struct clocked *g, struct clocked_lane *v, const struct clocked_port *p)
{
    const struct routing_steps *s = g->steps;
    struct clocked_leg *l = v->front;
    const int step = s->step[l->row + p->row], state = step >> ROUTING_STEP_BITS;
    int out = step & ((1 << ROUTING_STEP_BITS) - 1);
    /* Out of the network, over channels of the state in which it came. */
    if (out == ROUTING_STEP_EJECT) {
        way_is(v, 0, g->sink + l->worm->route.node, s->eject_first[l->state],
               s->eject_count[l->state]);
        return;
    }
    if (out == ROUTING_STEP_TURN) l->goal = l->worm->route.target;
    l->state = state;
    l->row = state * g->nrouter * g->nrouter + l->goal;
    if (out == ROUTING_STEP_TURN) {
        clocked_route_on(g, v, p);
        return;
    }
    if (out == ROUTING_STEP_ANY) out = s->any[p->to] + routing_draw(&l->worm->route, s->fan);
    v->way = g->exit[p->to * CLOCKED_WORD + out];
    v->head = g->asking[state];
}

/* Of several options that lead over this channel the first one is as good as any. */
void clocked_taken(struct clocked *g, const struct clocked_lane *v, struct clocked_leg *l,
                   const struct clocked_port *p, int number)
{
    const struct route_option *o = &g->option[clocked_number(g, v) * CLOCKED_OPTIONS];
    while (&g->port[g->port_of[o->link]] != p || number < o->first || number >= o->first + o->count)
        o++;
    take(g, l, o, number);
}

/* The leg ahead stands in the FIFO of the channel as soon as that is its own, before a flit is
 * there: packets come in the order in which they got the channel. */
void clocked_own(struct clocked *g, struct clocked_lane *v, struct clocked_lane *out)
{
    struct clocked_leg *l = v->front, *m = clocked_leg(g, out);
    struct clocked_port *p = clocked_port_of(g, out);
    if (p < g->sink && l->state < 0) clocked_taken(g, v, l, p, clocked_channel_of(p, out));
    m->worm = l->worm;
    m->flits = l->flits;
    m->goal = l->goal;
    m->state = l->state;
    m->row = l->row;
    l->ahead = m;
    v->way = p;
    v->head.state = LANE_SENDING;
    v->head.noption = 1;
}

/* ---- out of the network ---- */

/* An arrival is that of the tail and the end's own time behind it. */
void clocked_delivered(struct clocked *g, struct clocked_worm *w, int32_t tail)
{
    struct clocked_result *r = g->result;
    const sim_ps arrival = tail * g->unit + net_end(g->net, g->list->bytes[w->message]);
    const int m = w->message;
    clocked_worm_return(g, w);
    g->done++;
    /* Told ahead of time what is not simulated. */
    if (g->list->stop > 0 && arrival > g->list->stop) return;
    r->arrived++;
    if (arrival > r->makespan) r->makespan = arrival;
    if (r->arrival) r->arrival[m] = arrival;
    if (r->injected) r->injected[m] = w->begun * g->unit;
}

/* ---- pools ---- */

/* Chunks come from the arena of the network, and go with it. */
struct clocked_leg *clocked_leg(struct clocked *g, struct clocked_lane *v)
{
    enum { CHUNK = 128 };
    if (!g->free_leg) {
        struct clocked_leg *chunk = TAKE(g->net->arena, CHUNK, struct clocked_leg);
        for (int i = 0; i < CHUNK; i++) clocked_leg_return(g, &chunk[i]);
    }
    struct clocked_leg *l = g->free_leg;
    g->free_leg = l->behind;
    *l = (struct clocked_leg){.lane = clocked_number(g, v), .state = -1};
    v->owned = true;
    if (v->clear <= g->now) clocked_restart(v);
    v->clear = CLOCKED_NEVER;
    if (clocked_port_of(g, v) < g->sink) clocked_enter(v, l);
    return l;
}

/* What its size says, mostly that of the message before. */
static inline void worm_size(struct clocked *g, struct clocked_worm *w, int64_t bytes)
{
    if (bytes != g->bytes) {
        g->bytes = bytes;
        g->flits = (int32_t)net_packet_flits(g->net, bytes, 0);
        g->gap = (int32_t)(net_port(g->net, bytes)->gap / g->unit);
    }
    w->flits = g->flits;
    w->gap = g->gap;
}

/* The draws of its route depend on its number alone, as at the other levels. */
struct clocked_worm *clocked_worm(struct clocked *g, int message)
{
    enum { CHUNK = 64 };
    if (!g->free_worm) {
        struct clocked_worm *chunk = TAKE(g->net->arena, CHUNK, struct clocked_worm);
        for (int i = 0; i < CHUNK; i++) clocked_worm_return(g, &chunk[i]);
    }
    struct clocked_worm *w = g->free_worm;
    const struct clocked_list *q = g->list;
    g->free_worm = w->next;
    w->message = message;
    worm_size(g, w, q->bytes[message]);
    const struct net_message m = {.id = message};
    w->route = routing_start(g->routing, q->src[message], q->dst[message], net_choice(&m));
    return w;
}
