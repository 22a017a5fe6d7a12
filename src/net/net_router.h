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

/* Most flits that a router sends ahead of time; bytes of a cache line, which most steps need. */
enum { ROUTER_AHEAD = 16, ROUTER_LINE = 64 };

/* A packet in the network. What a step at a router asks of it lies in its first line. */
struct worm {
    _Alignas(ROUTER_LINE) int32_t flits;
    int32_t index;
    struct route route;
    struct worm *next; /* in the pool */
    struct flight *flight;
    int first, count; /* channels over which it may enter the network */
};

/* A worm at one port of its way. */
struct leg {
    struct leg *behind; /* the next in the FIFO behind the port, or in the pool */
    struct leg *ahead;  /* of the same worm at its next port, NULL: not known yet */
    struct worm *worm;
    int32_t sent, port, channel; /* flits that crossed the port; over which it goes */
    sim_ps ask, first, tail;     /* since when it wanted the port; its head and tail crossed it */
};

enum lane_state {
    LANE_IDLE,    /* empty, or the head of its front is not there */
    LANE_ROUTING, /* the front's way on is found at `due` */
    LANE_ASKING,  /* it asks for a channel from `due` on */
    LANE_SENDING  /* it has one */
};

/* A flit in a FIFO: when it comes, and when it goes and a credit with it. Both may lie ahead. */
struct stay {
    sim_ps come, go;
};

enum { LANE_OPTIONS = 2 }; /* ways on that a lane has memory for: few rules give more */

/* A virtual channel of a port, and the FIFO at its end. What a router asks of a channel that it may
 * give lies in the first line, what it asks of a FIFO in the second. */
struct lane {
    /* From when on it can be given to anybody: it is empty, nobody's, and all its credits are back;
     * SIM_NEVER: it is not, or that is not known. */
    _Alignas(ROUTER_LINE) sim_ps clear;
    sim_ps free;            /* when the next may own it, if nobody does */
    sim_ps left;            /* when the flit that left last had left */
    int64_t in, out;        /* flits that ever entered and left */
    struct stay *stay;      /* (ring) of flit n */
    uint32_t accept, grant; /* round robin: as a FIFO that asks, as a channel that is given */

    struct port *of;                /* port[port] */
    struct leg *front;              /* of the worms in the FIFO */
    sim_ps due;                     /* see lane_state */
    struct lane *busy, **busy_link; /* the router's lanes whose front has come */
    uint64_t ways;                  /* the outputs of all its ways on; see router_bit */
    int32_t way;                    /* its first or only way on: port, */
    int16_t first, count;           /* channels */
    int16_t noption;
    uint8_t state;  /* enum lane_state */
    bool starved;   /* somebody upstream waits for a flit of it to be sent */
    uint32_t input; /* its number among the FIFOs of the router at its end, */
    uint32_t output; /* among the channels of the router at its beginning: turns go by these */
    int32_t port;
    struct leg *owner;           /* who sends over it, from its head to its tail */
    struct leg *back;            /* of the worms in the FIFO */
    struct route_option *option; /* (noption) of the front, none: to its node */
    int room;                    /* options that there is memory for, */
    int16_t channel;             /* of its port */
    bool bars;                   /* an option without a channel spoils its turn */
    struct route_option few[LANE_OPTIONS]; /* memory for the options of most */
    /* Of one allocation: */
    int pick_priority;
    struct lane *match, *wish, *fresh, *pick; /* given; intended for; in this round; accepted */
    sim_ps retry; /* it took part in one and does not before then (router_tries) */
};

/* A link, or a node's way in or out. */
struct port {
    _Alignas(ROUTER_LINE) struct lane *lane; /* (channels), NULL until used */
    sim_ps flit, wire; /* time of a flit; what the cable adds to the hop latency */
    sim_ps passed;     /* when the FIFOs at its end can pass on the next flit */
    sim_ps free;       /* of a link or way out: when it can take the next flit */
    int32_t to;        /* router at its end, -1: a node */
    uint32_t in, out;  /* its number among the inputs of `to`, among the outputs of `from` */
    /* The switch: round robin as an input and as an output, channel whose turn it is. */
    uint32_t accept, grant;
    int turn;

    int32_t from; /* router, -1: a node */
    int enter;    /* way in: channel whose turn it is to take the next packet */
    struct port *match, *wish, *pick;
};

enum { ROUTER_POSTED = 3, ROUTER_LANE_AGAIN = NET_LANE_ARBITRATE + 1 /* a second look at once */ };

struct router {
    struct lane *busy;
    struct coming *coming; /* (room) those of `next` .. `end` - 1, by due (net_router_front.h) */
    int32_t next, end, room;
    sim_ps wake;                  /* 1 + its next event, or 0 */
    sim_ps retry;                 /* until when some lane has to wait after an allocation */
    bool second;                  /* its next look was asked for in its own instant */
    sim_ps posted[ROUTER_POSTED]; /* 1 + times of events that were posted and are to come, or 0 */
};

struct routers {
    struct fabric fabric; /* first */
    const struct routing *routing;
    sim_action *look; /* what an event of a router does: router_look */
    void (*post)(struct routers *g, int r, sim_ps at); /* see that r is looked at, at time `at` */
    bool whole;                                        /* packets move as one: level packet */
    bool priority;  /* allocation of channels obeys the options' priorities */
    bool strict;    /* heads bid for all their options, as in BookSim's router */
    int iterations; /* of an allocation */
    bool single;    /* a channel that a lone head is given in the first one stays its own */
    bool quick;     /* a head whose way is clear goes without an allocation (router_quick) */
    int64_t ring;   /* places of a lane's arrays - 1: a power of two of at least a buffer */
    /* Of the net, where a step finds them: hop latency and credit; from when a flit crosses a port
     * until it is in the FIFO behind it, and a head's setup there; a channel's pause after a tail;
     * buffer and channels; the first way out. */
    sim_ps tau, credit, reach, setup, pause;
    int64_t buffer;
    uint32_t nchannel;
    int32_t sink;
    struct port *port;     /* (nresource) */
    struct router *router; /* (nrouter) */
    struct leg **sending;  /* (nnode) packets that leave their nodes */
    struct worm **waiting; /* (nnode) packets that wait for a channel into the network */
    struct worm *free_worm;
    struct leg *free_leg;
    struct ask *ask; /* (room) scratch of one allocation (net_router_allocate.c) */
    struct bid *bid;
    struct lane **active; /* (lanes of the router that has most) */
    int nask, nbid, ask_room, bid_room;
    sim_ps now;
    bool even;                  /* links and ways out have one rate */
    bool fits, looks, looks_on; /* of the rule: `fits`, loads decide at the source, also later */
    bool few;                   /* no rule's list of options is longer than a lane's memory */
    bool spares;                /* no look at a router without need (router_gather) */
    struct gather *gather;      /* one event for all of an instant; NULL: one for each router */
};

/* router_look_at: if router r is due: channels to heads, then the switch to flits. `second`: all
 * that were due before this instant have had their turn; who is asked for in it has none earlier.
 * router_look: an event of router `argument`; beyond their number, a second one. */
void router_look_at(struct routers *g, int r, bool second, sim_ps now);
void router_look(void *subject, uint64_t argument, sim_ps now);

/* router_post: an event of router r at `at` (routers.post). */
void router_post(struct routers *g, int r, sim_ps at);

/* router_used: flits that link was given and whose credits are not back at g->now. */
int64_t router_used(const void *of, int link);

/* router_source_look: an event of node's way into the network. router_gather: net_gather. */
void router_source_look(struct routers *g, int node, sim_ps now);
bool router_gather(struct net *n);

#endif
