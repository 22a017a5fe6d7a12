/* net_loggp.c - no contention: a message waits for its node's injection port and for nothing else.
 *
 *     inj = max(ready, port),  port = inj + (S-1 flits) + max(g, 1 flit),  arrival = inj + R tau +
 * (S-1 flits) + end
 *
 * which is LogGP with G the time of a flit and L = R tau + end. Where the port has one sender,
 * whose messages come in the order of their ready times, the answer is known in net_send and costs
 * no event. */
#include "net/net_account.h"
#include "net/net_path.h"
#include "net/net_way.h"

struct loggp {
    sim_ps *port;     /* (nnode) when the injection port is free */
    /* (nnode x processors) the same had no other processor of the node sent anything */
    sim_ps *own_port;
    int nprocessor;
};

static bool loggp_create(struct net *n, struct err *e)
{
    (void)e;
    struct loggp *g = TAKE(n->arena, 1, struct loggp);
    g->nprocessor = n->topology->spec->processors_per_node;
    g->port = TAKE(n->arena, n->nnode, sim_ps);
    /* With one processor a node both ports are one, and nothing can be contended. */
    g->own_port = g->nprocessor == 1
                      ? g->port
                      : TAKE(n->arena, size_product(n->nnode, g->nprocessor), sim_ps);
    n->state = g;
    return true;
}

/* take a port at `ready` or when it is free; returns when */
static sim_ps port_take(sim_ps *port, sim_ps ready, sim_ps busy)
{
    sim_ps at = ready > *port ? ready : *port;
    *port = ps_later(at, busy);
    return at;
}

/* The three formulas above. `uncontended` takes the port that only this processor uses. */
static void loggp_inject(struct net *n, struct net_message *m)
{
    struct loggp *g = n->state;
    struct net_rate slow;
    const sim_ps way = net_way(n, m, &slow);
    int64_t flits = net_flits(n, m->bytes);
    sim_ps busy = net_port_busy(n, m->bytes, flits);
    sim_ps flight = way + net_rate_time(slow, flits - 1) + net_end(n, m->bytes);
    m->injected = port_take(&g->port[m->src], m->ready, busy);
    m->arrival = m->injected + flight;
    m->uncontended = m->arrival;
    if (g->nprocessor > 1)
        m->uncontended =
            port_take(&g->own_port[m->src * g->nprocessor + m->processor], m->ready, busy) + flight;
    if (n->path) {
        const uint32_t sent =
            net_path_take(n, net_injection(n, m->src), m->path, m->injected, m->bytes);
        m->path = net_path_tail(n, net_path_way(n, sent, m, way), slow, m->bytes);
    }
    net_account(n, net_injection(n, m->src), net_job(m), 1, m->bytes, busy, m->injected - m->ready);
    net_arrive(n, m);
}

static void loggp_start(void *subject, uint64_t argument, sim_ps now)
{
    (void)now;
    loggp_inject(subject, (struct net_message *)(uintptr_t)argument);
}

/* An answer at once needs the order of ready times; else the start is an event in that order. */
static void loggp_send(struct net *n, struct net_message *m)
{
    if (n->port_private) loggp_inject(n, m);
    else
        sim_at(n->sim, m->ready, NET_LANE_START, net_start_key(m->id), loggp_start, n,
               (uintptr_t)m);
}

const struct net_type net_loggp = {"loggp", LEVEL_LOGGP, loggp_create, loggp_send,
                                   NULL,    NULL,        false,        true};
