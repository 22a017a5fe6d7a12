/* net_flit.h - wormhole switching: the two ways of level flit, and what they share.
 *
 * Flit k of a packet crosses resource h at x(h,k) >= x(h-1,k) + tau, one flit time after flit k-1,
 * and a credit latency after the flit a buffer's size earlier has left the FIFO behind h. A head at
 * the front of its FIFO asks for its output; the output is its own, credits or not, until its tail
 * has crossed. With one virtual channel per link this needs no events for flits (net_flit_train.c);
 * with several they share links flit by flit (net_flit_event.c). */
#ifndef NET_NET_FLIT_H
#define NET_NET_FLIT_H

#include "net/net_packet.h"

/* The functions of one way. */
struct flit_way {
    struct fabric *(*create)(struct net *n, struct err *e);
    bool (*deadlock)(const struct net *n, char *text, int size);
};

extern const struct flit_way flit_train, flit_event;

/* flit_arrival: when v is delivered whose last flit is ejected at `tail`. Flits that wait behind a
 * slow resource save the setup of the routers after it, which the head has paid; v is never
 * delivered sooner than in an empty network. */
static inline sim_ps flit_arrival(const struct fabric *f, const struct flight *v, sim_ps tail)
{
    sim_ps at = tail + net_end(f->net, v->m->bytes);
    if (f->net->setup == 0) return at;
    sim_ps least = ps_later(v->m->injected, flight_empty(f->net, v));
    return at > least ? at : least;
}

#endif
