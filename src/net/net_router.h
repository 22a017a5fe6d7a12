/* net_router.h - routers with virtual channels whose packets may have several ways on: the records
 * of levels packet and flit for machines with a routing rule (network.routing) or long cables.
 *
 * A port is a resource of the network: a link between two routers, or a node's way in or out.
 * Behind each lies a lane for each virtual channel: a FIFO of the router at its end, and at the
 * same time the channel of the router at its beginning. What moves is a flit on level flit and a
 * whole packet on level packet; all else is the same. */
#ifndef NET_NET_ROUTER_H
#define NET_NET_ROUTER_H

#include "net/net_packet.h"
#include "net/net_way.h"

enum { ROUTER_AHEAD = 16 }; /* most flits that a router sends ahead of time */

/* A packet in the network. */
struct worm {
    struct worm *next; /* in the pool */
    struct flight *flight;
    int32_t flits, index;
    int first, count; /* channels over which it may enter the network */
    struct route route;
};

/* A worm at one port of its way. */
struct leg {
    struct leg *behind; /* the next in the FIFO behind the port, or in the pool */
    struct leg *ahead;  /* of the same worm at its next port, NULL: not known yet */
    struct worm *worm;
    int32_t sent; /* flits that crossed the port */
    int32_t port, channel;
    sim_ps ask, first, tail; /* since when it wanted the port; its head and tail crossed it */
};

enum lane_state {
    LANE_IDLE,    /* empty, or the head of its front is not there */
    LANE_ROUTING, /* the front's way on is found at `due` */
    LANE_ASKING,  /* it asks for a channel from `due` on */
    LANE_SENDING  /* it has one */
};

/* A virtual channel of a port, and the FIFO at its end. */
struct lane {
    struct leg *owner;        /* who sends over it, from its head to its tail */
    sim_ps free;              /* when the next may own it, if nobody does */
    struct leg *front, *back; /* worms in the FIFO */
    sim_ps left;              /* when the tail of the one that left last had left */
    int64_t in, out;          /* flits that ever entered and left */
    sim_ps *come, *go; /* (ring) of flit n: its arrival; its departure, whose credit flit n + buffer
                          needs. Both may lie ahead (router_send) */
    int32_t port, channel;
    enum lane_state state;
    sim_ps due;
    struct route_option *option; /* (noption) of the front, none: to its node */
    int noption, room;
    int out_first, out_count; /* channels to its node */
    bool starved;             /* somebody upstream waits for a flit of it to be sent */
    bool bars; /* one of its options has no channel, which spoils its turn at the switch */
    struct lane *busy, **busy_link; /* the router's lanes that have a front */
    uint32_t accept, grant; /* round robin: as a FIFO that asks, as a channel that is given */
    /* Of one allocation: */
    struct lane *match, *wish, *fresh, *pick; /* given; intended for; in this round; accepted */
    int pick_priority;
};

/* A link, or a node's way in or out. */
struct port {
    struct lane *lane; /* (channels), NULL until used */
    sim_ps flit, wire; /* time of a flit; what the cable adds to the hop latency */
    sim_ps passed;     /* when the FIFOs at its end can pass on the next flit */
    int32_t from, to;  /* routers, -1: a node */
    uint32_t in, out;  /* its number among the inputs of `to`, among the outputs of `from` */
    /* The switch: round robin as an input and as an output, channel whose turn it is. */
    uint32_t accept, grant;
    int turn;
    int enter; /* way in: channel whose turn it is to take the next packet */
    struct port *match, *wish, *pick;
};

/* A FIFO's request for a channel, and its bid for the way through the switch. */
struct ask {
    struct lane *in, *out;
    int priority;
};
struct bid {
    struct lane *lane;
    struct port *in, *out;
    bool spec; /* its channel is still being asked for */
};

enum { ROUTER_POSTED = 3 };

struct router {
    struct lane *busy;
    sim_ps wake;                  /* 1 + time of its next event, 0: none */
    sim_ps posted[ROUTER_POSTED]; /* 1 + times of events that were posted and are to come, or 0 */
};

struct routers {
    struct fabric fabric; /* first */
    const struct routing *routing;
    sim_action *look;      /* what an event of a router does: router_look */
    bool whole;            /* packets move as one: level packet */
    bool priority;         /* allocation of channels obeys the options' priorities */
    bool strict;           /* heads bid for all their options, as in BookSim's router */
    int iterations;        /* of an allocation */
    bool single;           /* a channel that a lone head is given in the first one stays its own */
    int64_t ring;          /* places of a lane's arrays - 1: a power of two of at least a buffer */
    struct port *port;     /* (nresource) */
    struct router *router; /* (nrouter) */
    struct leg **sending;  /* (nnode) packets that leave their nodes */
    struct worm **waiting; /* (nnode) packets that wait for a channel into the network */
    struct worm *free_worm;
    struct leg *free_leg;
    struct ask *ask; /* (room) scratch of one allocation */
    struct bid *bid;
    int nask, nbid, ask_room, bid_room;
    sim_ps now;
};

/* router_later, router_sooner: of two times the later, the sooner one. */
static inline sim_ps router_later(sim_ps a, sim_ps b) { return a > b ? a : b; }
static inline sim_ps router_sooner(sim_ps a, sim_ps b) { return a < b ? a : b; }

/* router_lanes_make: the lanes behind port p, at their first use (router_lanes). */
struct lane *router_lanes_make(struct routers *g, int p);

/* router_wake: see that router r is looked at, at time `at` or earlier. */
void router_wake(struct routers *g, int r, sim_ps at);

/* router_route: the way on of v's front; what it asks for from when on. */
void router_route(struct routers *g, struct lane *v);

/* router_front: lane v may have a new front: find out when its way on is due. */
void router_front(struct routers *g, struct lane *v);

/* router_own: the front of v gets lane `out`, by its option o. */
void router_own(struct routers *g, struct lane *v, struct lane *out);

/* router_send: the front of v sends what moves at once; its channel and the switch are its own. */
void router_send(struct routers *g, struct lane *v, sim_ps now);

/* router_look: an event of router `argument`. */
void router_look(void *subject, uint64_t argument, sim_ps now);

/* router_allocate: an event of router r: channels to heads, then the switch to flits. Returns when
 * it is worth looking again. */
sim_ps router_allocate(struct routers *g, int r, sim_ps now);

/* router_used: flits that link was given and whose credits are not back at g->now. */
int64_t router_used(const void *of, int link);

/* router_source: an event of node's way into the network. */
void router_source(struct routers *g, int node, sim_ps now);

/* router_leg: lane v of port p becomes w's: a leg at the end of its FIFO. */
struct leg *router_leg(struct routers *g, struct worm *w, struct lane *v);
void router_leg_return(struct routers *g, struct leg *l);
struct worm *router_worm(struct routers *g, struct flight *m);
void router_worm_return(struct routers *g, struct worm *w);

#endif
