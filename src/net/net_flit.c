/* net_flit.c - level flit: wormhole switching, by trains of flits or flit by flit.
 *
 * Trains need one event for each packet and resource, the other way one for each flit that crosses
 * one, or for those that nobody can meet within a hop latency. With one virtual channel both
 * describe the same router. */
#include "net/net_flit.h"

/* With one channel nobody shares a link while a worm holds it, and trains are exact; with several
 * the flits of different worms alternate. */
static const struct flit_way *way_of(const struct net *n)
{
    return n->machine->network.virtual_channels == 1 ? &flit_train : &flit_event;
}

static bool flit_create(struct net *n, struct err *e)
{
    n->state = way_of(n)->create(n, e);
    return n->state != NULL;
}

static bool flit_deadlock(const struct net *n, char *text, int size)
{
    return way_of(n)->deadlock(n, text, size);
}

const struct net_type net_flit = {"flit",        LEVEL_FLIT,    flit_create, packet_send,
                                  packet_occupy, flit_deadlock, false, false};
