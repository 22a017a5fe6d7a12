/* routing_shared.c - what the routing rules share: random numbers of a packet, loads, and whether
 * there are channels enough. */
#include "machine/routing_internal.h"

/* splitmix64 of the packet's number and of how many it has drawn: no stream is shared. The upper
 * 32 bits times n, as a fixed-point fraction of n. */
int routing_draw(struct route *p, int n)
{
    uint64_t z = p->choice + ((uint64_t)++p->drawn) * 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return (int)((z >> 32) * (uint64_t)n >> 32);
}

int64_t routing_used(const struct routing_view *view, int link)
{
    return view->used ? view->used(view->of, link) : 0;
}

bool routing_needs(struct routing *r, int least, const char *why, struct err *e)
{
    if (r->channels == 0) r->channels = least;
    if (r->channels >= least) return true;
    return err_set(e, ERR_CONFIG,
                   "network.virtual_channels is %d; network.routing '%s' on topology '%s' needs "
                   "at least %d: %s",
                   r->channels, routing_rule_name(r->rule),
                   topology_family_name(r->topology->spec->family), least, why);
}
