/* net_clocked_records.h - the records of net_clocked.h.
 *
 * They are those of net_router.h, with times in cycles. The lanes of a router's inputs stand one
 * after the other, so that a set of them is a word. */
#ifndef NET_NET_CLOCKED_RECORDS_H
#define NET_NET_CLOCKED_RECORDS_H

#include "net/net_clocked.h"
#include "net/net_router.h"

/* A set of a router's outputs is a word, one of its lanes so many words. Each lane has so many ways
 * on, and a bid for each. */
enum { CLOCKED_NEVER = INT32_MAX, CLOCKED_WORD = 64, CLOCKED_SET = 4, CLOCKED_OPTIONS = 2 };
enum { CLOCKED_LANES = CLOCKED_SET * CLOCKED_WORD, CLOCKED_BIDS = CLOCKED_OPTIONS * CLOCKED_LANES };
enum { CLOCKED_ROW = ROUTER_LINE / 8 }; /* places of a ring in a cache line */

/* For whole packets and for flits apart: `whole` is constant in each. */
#define CLOCKED_INLINED static inline __attribute__((always_inline))

/* A packet. */
struct clocked_worm {
    _Alignas(ROUTER_LINE) int32_t flits, message;
    int first, count;          /* channels over which it may enter the network */
    int32_t begun;             /* when its head left its node */
    int32_t gap;               /* after it, from its tail on */
    struct clocked_worm *next; /* in the pool */
    struct route route;
};

/* A packet at one port of its way. */
struct clocked_leg {
    _Alignas(ROUTER_LINE) struct clocked_leg *behind; /* the next in the FIFO, or in the pool */
    struct clocked_leg *ahead;                        /* of the same packet at its next port */
    struct clocked_worm *worm;
    int32_t flits;
    int32_t sent, first; /* flits that crossed the port; when its head did */
    int32_t lane;
    int32_t goal; /* router to which the table leads it, */
    int state;    /* by this state; -1: by the rule itself */
    int row;      /* of both in the table */
};

/* What the front of a FIFO is about, and over how many ways and which channels of the first one. */
struct clocked_head {
    uint8_t state; /* enum lane_state */
    uint8_t noption, first, count;
};

/* A virtual channel of a port, and the FIFO at its end (struct lane). */
struct clocked_lane {
    _Alignas(ROUTER_LINE) int32_t clear; /* CLOCKED_NEVER: it is not, or that is not known */
    int32_t free, left, in, out, due;
    int32_t nleft; /* packets that left since it was clear */
    uint16_t port;
    uint8_t other; /* output of the second of several ways */
    struct clocked_leg *front, *back;
    struct clocked_port *way; /* its first or only way on */
    struct clocked_head head;
    bool owned, starved;
    uint8_t accept, grant;
};

/* A link, or a node's way in or out (struct port). */
struct clocked_port {
    _Alignas(ROUTER_LINE) struct clocked_lane *lane;
    int32_t passed, free;
    int32_t held; /* flits in its lanes */
    int32_t row;  /* of `to` in the table */
    uint16_t wire;
    int16_t from, to; /* routers; ~from: node */
    uint8_t in, out;
    uint8_t lanes_out; /* out x channels */
    uint8_t accept, grant, turn, enter;
};

/* A lane of a router whose front is under way. */
struct clocked_coming {
    int32_t due, lane;
};

struct clocked_router {
    _Alignas(ROUTER_LINE) int32_t wake; /* time of its next look */
    int32_t retry;                      /* until when some lane has to wait after an allocation */
    struct clocked_lane *lane;          /* its first ones */
    struct clocked_port *port;
    uint64_t *slot;                /* its word of the first slot, */
    struct clocked_coming *coming; /* (room) those of next .. end - 1, by due */
    uint16_t next, end, room;
    uint16_t bit;               /* and its bit in that */
    uint64_t busy[CLOCKED_SET]; /* (sets words) lanes whose front has come */
};

struct clocked_source {
    int32_t front, back; /* messages that have not begun, -1: none */
    int32_t free, wake;
    struct clocked_port *port;
    struct clocked_worm *waiting;
    struct clocked_leg *sending;
};

/* Where a flit of a FIFO is: level flit. When packet n left, and its first flit's number in the
 * FIFO: level packet. */
union clocked_stay {
    struct {
        int32_t come, go;
    };
    struct {
        int32_t position, at;
    };
};

struct clocked {
    struct clocked_lane *lane;
    struct clocked_port *port;
    struct clocked_router *router;
    union clocked_stay *stay; /* see clocked_ring */
    int32_t *retry;           /* (lanes) it took part in an allocation and does not before then */
    uint64_t *slot;           /* (wheel + 1, words): a bit for each router, then for each node */
    uint64_t *again;          /* routers that are looked at again in this cycle */
    int32_t wheel;            /* slots - 1: a power of two */
    int32_t now, last;        /* the last cycle that has a bit */
    int32_t words, router_words, word_shift, stay_row;
    int sets;     /* words for the lanes of the router that has most */
    int32_t flit; /* cycles of one */
    int32_t tau, credit, reach, setup, pause, buffer, ring, longest_wire;
    int32_t due; /* from when a head crosses a port, without a cable, until it asks, or looks */
    uint32_t nchannel;
    struct clocked_port *sink; /* first way out */
    bool sources;              /* nodes came to this cycle */
    bool whole, single, strict, priority, looks, looks_on;
    bool queues; /* fronts under way stand in their router's queue */
    int iterations;
    struct clocked_source *source;
    int32_t *start, *next; /* (messages) cycle; the next in their source's list */
    struct clocked_leg *free_leg;
    struct clocked_worm *free_worm;
    const struct routing *routing;
    struct route_option *option;       /* (lanes x CLOCKED_OPTIONS) of fronts */
    int32_t *port_of;                  /* (resources) */
    const struct routing_steps *steps; /* NULL: all ways are found by the rule itself */
    struct clocked_port **exit;        /* (routers x CLOCKED_WORD) by number of the output */
    struct clocked_head asking[4];     /* by state behind a step */
    /* Of a router's lanes: their ports, channels, the channels after these. */
    uint8_t entry[CLOCKED_LANES], channel[CLOCKED_LANES], after[CLOCKED_LANES];
    int nrouter, nnode, nport, nask, nbid;
    struct net *net;
    const struct clocked_list *list;
    struct clocked_result *result;
    int64_t bytes;                         /* of the message before, its flits and gap */
    int32_t flits, gap, longest, shortest; /* flits of packets */
    int done;                              /* messages that have left the network */
    sim_ps unit;
    struct clocked_match *match; /* (lanes) scratch of one allocation */
    struct clocked_side *side;   /* (ports) */
    struct clocked_ask *ask;
    struct clocked_bid *bid;
    struct clocked_lane *active[CLOCKED_LANES + 1]; /* one more is written before it is counted */
};

#endif
