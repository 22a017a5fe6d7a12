/* net_path.c - what binds on a message's way, for critical paths (measure/path.h): the head that
 * arrives at a resource, or the message that holds it.
 *
 * A resource remembers the node at which it was last taken and for how many bytes. Only when a
 * later message finds it busy do the nodes come into being that lead from there to the moment it is
 * free: most holds bind nobody. */
#include "net/net_path.h"
#include "net/net_way.h"

struct net_hold {
    uint32_t node; /* when it was taken */
    bool taken;    /* ever */
    bool others;   /* since then it has served other users' messages */
    int64_t bytes; /* of the message that took it */
};

void net_set_path(struct net *n, struct path_log *log)
{
    n->path = log;
    if (log != NULL) n->hold = TAKE(n->arena, n->nresource, struct net_hold);
}

/* Which bandwidth makes a rate what it is. Ports without one of their own have the link's. */
static enum path_cause rate_cause(const struct net *n, struct net_rate r, int64_t bytes)
{
    if (r.byte == n->link.byte) return PATH_LINK_BYTES;
    if (r.byte == net_port(n, bytes)->rate.byte) return PATH_INJECTION_BYTES;
    return r.byte == n->ejection.byte ? PATH_EJECTION_BYTES : PATH_LINK_BYTES;
}

static uint32_t add(const struct net *n, uint32_t before, sim_ps duration, enum path_cause cause,
                    int resource, int64_t count)
{
    const sim_ps time = ps_later(path_time(n->path, before), duration);
    return path_add(n->path, before, time, cause, -1, -1, resource, count);
}

/* From the moment when the resource was taken to the moment when it is free, as net_port_busy and
 * the levels have it. */
static uint32_t until_free(const struct net *n, int resource, const struct net_hold *h)
{
    const struct net_rate rate = net_resource_rate(n, resource, h->bytes);
    const enum path_cause cause = rate_cause(n, rate, h->bytes);
    const int64_t flits = net_flits(n, h->bytes);
    if (!net_is_injection(n, resource))
        return add(n, h->node, net_rate_time(rate, flits), cause, resource, flits);
    const struct net_port *p = net_port(n, h->bytes);
    const sim_ps flit = net_rate_time(rate, 1);
    const uint32_t tail =
        add(n, h->node, net_rate_time(rate, flits - 1), cause, resource, flits - 1);
    return p->gap > flit ? add(n, tail, p->gap, PATH_GAP, resource, 1)
                         : add(n, tail, flit, cause, resource, 1);
}

/* How long it was held, as until_free has it. */
static sim_ps held(const struct net *n, int resource, const struct net_hold *h)
{
    const int64_t flits = net_flits(n, h->bytes);
    return net_is_injection(n, resource)
               ? net_port_busy(n, h->bytes, flits)
               : net_rate_time(net_resource_rate(n, resource, h->bytes), flits);
}

uint32_t net_path_take(struct net *n, int resource, uint32_t own, sim_ps at, int64_t bytes)
{
    struct net_hold *h = &n->hold[resource];
    uint32_t node = own;
    int rank, stage;
    path_owner(n->path, own, &rank, &stage);
    /* Of message and holder the later one binds; whom other users' messages held binds nobody. */
    if (at > path_time(n->path, own) && h->others)
        node = path_add(n->path, own, at, PATH_BACKGROUND, -1, -1, resource, 1);
    else if (at > path_time(n->path, own))
        node = path_join(n->path, until_free(n, resource, h), own, 0, PATH_CONTENTION, rank, stage);
    else if (h->taken && !h->others)
        node = path_join(n->path, own, h->node, held(n, resource, h), PATH_CONTENTION, rank, stage);
    CHECK(path_time(n->path, node) == at);
    *h = (struct net_hold){.node = node, .taken = true, .bytes = bytes};
    return node;
}

void net_path_others(struct net *n, int resource)
{
    if (n->path) n->hold[resource].others = true;
}

uint32_t net_path_hops(const struct net *n, uint32_t before, int hops, int resource)
{
    return add(n, before, hops * n->tau, PATH_HOP, resource, hops);
}

uint32_t net_path_cable(const struct net *n, uint32_t before, sim_ps wire, int resource)
{
    return add(n, before, wire, PATH_CABLE, resource, 1);
}

/* Hop latencies are what a faster router changes; what is left over is cable. */
uint32_t net_path_way(const struct net *n, uint32_t before, const struct net_message *m, sim_ps way)
{
    const sim_ps cables = n->wire ? net_cables(n, m) : 0;
    const int hops = n->tau > 0 ? (int)((way - cables) / n->tau) : 0;
    return net_path_cable(n, net_path_hops(n, before, hops, -1), cables, -1);
}

uint32_t net_path_tail(const struct net *n, uint32_t before, struct net_rate slow, int64_t bytes)
{
    const int64_t flits = net_flits(n, bytes) - 1;
    const uint32_t tail =
        add(n, before, net_rate_time(slow, flits), rate_cause(n, slow, bytes), -1, flits);
    return add(n, tail, net_end(n, bytes), PATH_END, -1, 1);
}

/* Levels that do not say who binds whom: the way through the empty network, and all the rest is
 * contention. */
void net_path_whole(const struct net *n, struct net_message *m)
{
    struct net_rate slow;
    const sim_ps way = net_way(n, m, &slow);
    uint32_t node = net_path_tail(n, net_path_way(n, m->path, m, way), slow, m->bytes);
    if (path_time(n->path, node) > m->arrival)
        node = m->path; /* the sender's own messages overlap */
    m->path = path_add(n->path, node, m->arrival, PATH_CONTENTION, -1, -1, -1, 0);
}
