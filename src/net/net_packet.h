/* net_packet.h - virtual cut-through: the state that the levels `packet` and `auto` share.
 *
 * Packets of at most a buffer's size go from resource to resource (injection port, links, ejection port). Behind each
 * resource but the last lies one FIFO per virtual channel; only its front packet may ask for the next resource. A
 * resource that is granted at t is taken for exactly the packet's length: the credit rule lets a packet go only when
 * it will never stall on the way, so everything about it is known at the grant and one event per resource is enough.
 *
 * Level `auto` adds claims: a message that meets nobody is not simulated but only noted on its resources. */
#ifndef NET_NET_PACKET_H
#define NET_NET_PACKET_H

#include "net/net_internal.h"

struct packet;
struct flight;

/* What has left a FIFO but whose credits may still be on their way: a line from (first flit, at) to (last, tail). */
struct credit {
    struct credit *next;
    sim_ps at, tail;       /* when its first and last flit crossed the next resource */
    uint32_t position;     /* of its first flit in the sequence of all flits of the FIFO */
    int32_t flits;
};

/* Flits of one virtual channel behind a resource. */
struct fifo {
    struct packet *front, *back;  /* packets that were not yet granted their next resource */
    struct credit *first, *last;  /* packets that were, oldest first */
    sim_ps left;                  /* when the tail of the last one of these has left: the next may ask */
    sim_ps home;                  /* when all credits of these are back */
    uint32_t position;            /* flits that ever entered; wraps */
    bool starved;                 /* somebody upstream waits for a packet of it to be granted */
};

/* Zeroed memory is an idle resource, so that untouched nodes of a large machine cost no memory. */
struct resource {
    sim_ps free;                  /* taken until then */
    sim_ps wake;                  /* 1 + time of its next arbitration event, 0: none */
    struct packet *request;       /* FIFO fronts that want it */
    struct fifo *fifo;            /* (channels) behind it, NULL until used */
    sim_ps turn_time;             /* when `turn` was last set */
    uint32_t turn;                /* round robin: input from which the next search starts */
    struct pass *claim, *pending; /* auto: optimistic messages by time; detailed ones that have yet to pass */
};

/* A node's messages that are not entirely injected, by (ready, id). */
struct source {
    struct flight *front, *back;
    struct pass *last_claim;      /* auto: last claim on the injection port */
};

struct presence;

enum pass_state { PASS_NONE, PASS_CLAIM, PASS_PENDING };

/* A message's way over one resource. */
struct pass {
    struct pass *next, *prev;     /* auto: in resource->claim or ->pending */
    struct flight *flight;
    sim_ps begin, end;            /* auto: of the claim */
    sim_ps follow;                /* auto: from when another may follow in the same FIFO without noticing */
    sim_ps last;                  /* when it was granted last */
    sim_ps flit;                  /* time of a flit */
    int resource, port;           /* port: the input at the next router */
    int granted;                  /* packets that were granted it */
    int16_t hop;
    int16_t channel, nchannel;    /* the virtual channels behind it that the message may use */
    enum pass_state state;
};

/* A message in the network. */
struct flight {
    struct net_message *m;
    struct flight *next;          /* in its source, in the pool, among the retired */
    int npacket, injected, ejected;
    int32_t full, last;           /* flits of all packets but the last, and of the last */
    sim_ps slowest;               /* flit time of its slowest resource */
    int nhop;                     /* R: pass[0 .. nhop] */
    bool optimistic;              /* not simulated */
    sim_ps arrival;               /* when it is delivered, SIM_NEVER: not known */
    sim_ps foreseen;              /* auto: time of the delivery posted when it was admitted, -1: none */
    sim_ps clear;                 /* auto: when its last trace is gone */
    sim_ps port_before;           /* auto: until when the injection port was taken by others */
    struct pass pass[];
};

struct packet {
    struct packet *next;          /* in its FIFO, in the pool */
    struct packet *next_request;  /* among the requests of a resource */
    struct flight *flight;
    sim_ps arrive;                /* when its head is at the end of the resource granted last */
    sim_ps ask;                   /* from when it may ask for the next one */
    sim_ps tail;                  /* when its last flit crosses the resource granted last */
    uint32_t position;            /* in its FIFO */
    int32_t flits, index, hop;    /* hop: of the resource granted last */
    int32_t channel, input;       /* of the FIFO it is in; input: port and channel, for round robin */
};

struct fabric {
    struct net *net;
    struct resource *resource;    /* (nresource) */
    sim_action *look;             /* what an event of a resource does: subject the fabric, argument its number */
    bool cuts;                    /* messages larger than a buffer travel in pieces of its size */
    struct source *source;        /* (nnode) */
    struct hop *way;              /* (max_hops + 2) scratch: the route of the message being made */
    sim_ps *own_port;             /* (nnode x processors) injection port for the processor's own messages alone */
    int nprocessor, nchannel, nlane; /* channels per link; channels per class */
    int nclass;
    int buffer;                   /* flits per channel */
    sim_ps late;                  /* when a message was delivered last in LANE_LATE, -1: never */
    sim_ps fastest;               /* flit time of the fastest resource */
    bool first_come;
    struct packet *free_packet;
    struct credit *free_credit;
    struct fifo *free_fifo;       /* unused part of a chunk of FIFOs */
    int nfree_fifo;
    struct flight **free_flight;  /* by nhop / 4 */
    struct flight *retired, *retired_back; /* auto: delivered, traces not yet gone */
    struct flight **marked;       /* auto: scratch, messages being turned into simulated ones */
    struct presence *presence;    /* auto: scratch, their packets in FIFOs */
    int nmarked, marked_room, npresence, presence_room;
    int64_t nadmitted, nflight;   /* auto: messages that were never simulated; all */
};

/* fabric_create: the state without a meaning: routes, messages, sources, for any level with buffers. Returns NULL with
 * ERR_CONFIG when the network numbers cannot be. */
struct fabric *fabric_create(struct net *n, size_t size, sim_action *look, struct err *e);

/* packet_send: net_type.send of levels packet and flit. */
void packet_send(struct net *n, struct net_message *m);

/* packet_fabric: the state of levels packet and auto. Returns NULL with ERR_CONFIG when the machine's buffers are too
 * small for cut-through. */
struct fabric *packet_fabric(struct net *n, sim_action *look, struct err *e);

/* packet_look: an event of a resource on levels packet and auto. */
void packet_look(void *subject, uint64_t argument, sim_ps now);

/* Pools: nothing is allocated once a run has reached its widest point. */
struct flight *flight_take(struct fabric *f, struct net_message *m);
void flight_return(struct fabric *f, struct flight *w);
struct packet *packet_take(struct fabric *f);
void packet_return(struct fabric *f, struct packet *p);
struct credit *credit_take(struct fabric *f);
void credit_return(struct fabric *f, struct credit *c);
struct fifo *fifo_of(struct fabric *f, struct resource *r, int channel);

static inline int32_t flight_packet_flits(const struct flight *w, int index)
{
    return index < w->npacket - 1 ? w->full : w->last;
}

/* source_enter: put w among the messages of its node that wait for the injection port. */
void source_enter(struct fabric *f, struct flight *w);

/* flight_measure: fill in m->uncontended; to be called in the order in which the processor sends. */
void flight_measure(struct fabric *f, struct flight *w);

/* packet_wake: see that resource r is looked at, at time `at` or earlier. */
void packet_wake(struct fabric *f, int r, sim_ps at);

/* packet_enter: packet p, granted its pass p->hop, stands in the FIFO behind it. */
void packet_enter(struct fabric *f, struct packet *p);

/* packet_leave_record: p has been, or is being, granted the resource after `q` at `at`, its tail crosses at `tail`. */
void packet_left(struct fabric *f, struct fifo *q, uint32_t position, int32_t flits, sim_ps at, sim_ps tail,
                 sim_ps flit);

/* fifo_room: from when on (>= now) a packet of `flits`, one flit every `flit`, may enter q; SIM_NEVER when that
 * depends on a grant yet to come. */
sim_ps fifo_room(struct fabric *f, struct fifo *q, int32_t flits, sim_ps flit, sim_ps now);

/* packet_deliver_at: post the delivery of w. */
void packet_deliver_at(struct fabric *f, struct flight *w, sim_ps arrival);

/* auto: apply to o's round-robin pointer what claims did before `now`; w was delivered; s leaves its list. */
void auto_catch_up(struct fabric *f, struct resource *o, sim_ps now);
void auto_delivered(struct fabric *f, struct flight *w);
void pass_unlink(struct fabric *f, struct pass *s);

/* packet_name_cycle: write "A waits for B waits for A" for the `count` resources way[]; returns true. */
bool packet_name_cycle(const struct net *n, const int *way, int count, char *text, int size);

/* packet_stuck: net_type.stuck of both levels. */
bool packet_stuck(const struct net *n, char *text, int size);

#endif
