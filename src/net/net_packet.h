/* net_packet.h - virtual cut-through: the functions that the levels `packet` and `auto` share.
 *
 * Packets of at most a buffer's size go from resource to resource (injection port, links, ejection
 * port). Behind each resource but the last lies one FIFO per virtual channel; only its front packet
 * may ask for the next resource. A resource that is granted at t is taken for exactly the packet's
 * length: the credit rule lets a packet go only when it will never stall on the way, so everything
 * about it is known at the grant and one event per resource is enough.
 *
 * Level `auto` adds claims: a message that meets nobody is not simulated but only noted on its
 * resources. */
#ifndef NET_NET_PACKET_H
#define NET_NET_PACKET_H

#include "net/net_fabric.h"

/* fabric_create: routes, messages and sources for a level with buffers, memory from the arena of n.
 *
 *   size  of the level's state, which begins with the fabric; zeroed
 *   look  what events of resources do; `occupied` is to be set afterwards, see packet_occupied
 *
 *   Returns NULL with ERR_CONFIG when flits, channels or buffers of the machine make no sense. */
struct fabric *fabric_create(struct net *n, size_t size, sim_action *look, struct err *e);

/* packet_fabric: the same for levels packet and auto, which also need buffers that hold a packet
 * and the credit round trip: otherwise NULL with ERR_CONFIG that names the keys. */
struct fabric *packet_fabric(struct net *n, size_t size, sim_action *look, struct err *e);

/* packet_send: net_type.send of levels packet and flit. */
void packet_send(struct net *n, struct net_message *m);

/* packet_occupy: net_type.occupy of all levels with buffers: posts f->occupied. */
void packet_occupy(struct net *n, int link, sim_ps now, sim_ps busy);

/* packet_look: an event of a resource on levels packet and auto. */
void packet_look(void *subject, uint64_t argument, sim_ps now);

/* Pools: nothing is allocated once a run has reached its widest point. flight_take also finds the
 * route of m and cuts it into packets, flight_plain cuts it only; fifo_of makes the FIFOs behind r
 * when they are first used. */
struct flight *flight_take(struct fabric *f, struct net_message *m);
struct flight *flight_plain(struct fabric *f, struct net_message *m, struct net_rate slowest);
void flight_return(struct fabric *f, struct flight *w);
struct packet *packet_take(struct fabric *f);
void packet_return(struct fabric *f, struct packet *p);
struct credit *credit_take(struct fabric *f);
void credit_return(struct fabric *f, struct credit *c);
struct fifo *fifo_of(struct fabric *f, struct resource *r, int channel);

/* flight_packet_flits: the flits of packet `index` of w. */
static inline int32_t flight_packet_flits(const struct flight *w, int index)
{
    return index < w->npacket - 1 ? w->full : w->last;
}

/* flight_empty: how long w takes from its injection in an empty network; at most PS_TOO_LONG. */
static inline sim_ps flight_empty(const struct net *n, const struct flight *w)
{
    int64_t flits = (int64_t)(w->npacket - 1) * w->full + w->last;
    return ps_later(ps_times(flits - 1, w->slowest), w->nhop * n->tau + net_end(n, w->m->bytes));
}

/* source_enter: put w among the messages of its node that wait for the injection port. */
void source_enter(struct fabric *f, struct flight *w);

/* flight_measure: fill in m->uncontended; to be called in the order in which the processor
 * sends. */
void flight_measure(struct fabric *f, struct flight *w);

/* packet_wake: see that resource r is looked at, at time `at` or earlier. */
void packet_wake(struct fabric *f, int r, sim_ps at);

/* packet_occupied: event, resource `argument` is taken by others for debt[argument], from when it
 * is free. */
void packet_occupied(void *subject, uint64_t argument, sim_ps now);

/* packet_ejection_setup: how long an ejection port of one virtual channel is idle between
 * packets. */
static inline sim_ps packet_ejection_setup(const struct fabric *f)
{
    return f->nchannel == 1 ? f->net->allocation : 0;
}

/* packet_enter: packet p, granted its pass p->hop, stands in the FIFO behind it. */
void packet_enter(struct fabric *f, struct packet *p);

/* packet_left: a packet of q, `flits` long from `position`, was granted its next resource at `at`;
 * its tail crosses it at `tail`, where a flit takes `flit`. */
void packet_left(struct fabric *f, struct fifo *q, uint32_t position, int32_t flits, sim_ps at,
                 sim_ps tail, sim_ps flit);

/* packet_deliver_at: w will be delivered at `arrival`. */
void packet_deliver_at(struct fabric *f, struct flight *w, sim_ps arrival);

/* auto: apply to o's round-robin pointer what claims did before `now`; w was delivered; s leaves
 * its list. */
void auto_catch_up(struct fabric *f, struct resource *o, sim_ps now);
void auto_delivered(struct fabric *f, struct flight *w);
void pass_unlink(struct fabric *f, struct pass *s);

/* packet_name_cycle: write "A waits for B waits for A" for the `count` resources way[]; returns
 * true. */
bool packet_name_cycle(const struct net *n, const int *way, int count, char *text, int size);

/* packet_deadlock: net_type.deadlock of both levels. */
bool packet_deadlock(const struct net *n, char *text, int size);

#endif
