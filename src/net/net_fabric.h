/* net_fabric.h - the records of the levels with buffers: messages on their routes, resources,
 * FIFOs, packets.
 *
 * Zeroed memory is an idle resource, and what lies behind a resource is made when it is first used,
 * so that untouched nodes of a large machine cost next to nothing. */
#ifndef NET_NET_FABRIC_H
#define NET_NET_FABRIC_H

#include "net/net_internal.h"

struct packet;
struct flight;

/* What has left a FIFO but whose credits may still be on their way: a line from (first flit, at) to
 * (last, tail). */
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
    /* when the tail of the last one of these has left: the next may ask */
    sim_ps left;
    sim_ps home;                  /* when all credits of these are back */
    sim_ps free;                  /* when the channel may be allocated to the next packet */
    uint32_t position;            /* flits that ever entered; wraps */
    bool starved;                 /* somebody upstream waits for a packet of it to be granted */
};

/* A port or link. */
struct resource {
    sim_ps free;                  /* taken until then */
    sim_ps wake;                  /* 1 + time of its next arbitration event, 0: none */
    struct packet *request;       /* FIFO fronts that want it */
    struct fifo *fifo;            /* (channels) behind it, NULL until used */
    sim_ps turn_time;             /* when `turn` was last set */
    uint32_t turn;                /* round robin: input from which the next search starts */
    /* auto: optimistic messages by time; detailed ones that have yet to pass */
    struct pass *claim, *pending;
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
    /* auto: from when another may follow in the same FIFO without noticing */
    sim_ps follow;
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
    /* auto: time of the delivery posted when it was admitted, -1: none */
    sim_ps foreseen;
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
    /* of the FIFO it is in; input: port and channel, for round robin */
    int32_t channel, input;
};

struct fabric {
    struct net *net;
    struct resource *resource;    /* (nresource) */
    /* what an event of a resource does: subject the fabric, argument its number */
    sim_action *look;
    /* resource `argument` begins to serve others, for debt[argument] */
    sim_action *occupied;
    sim_ps *debt;                 /* (nresource) NULL until used */
    /* sees that resource r is looked at, without an event of its own; NULL: packet_wake posts one
     */
    void (*wake)(struct fabric *f, int r, sim_ps at);
    bool ahead;                   /* messages are handed over when their arrival is known */
    bool cuts;                    /* messages larger than a buffer travel in pieces of its size */
    struct source *source;        /* (nnode) */
    struct hop *way;              /* (max_hops + 2) scratch: the route of the message being made */
    /* (nnode x processors) injection port for the processor's own messages alone */
    sim_ps *own_port;
    int nprocessor, nchannel, nlane; /* channels per link; channels per class */
    int nclass;
    int buffer;                   /* flits per channel */
    /* how a message of cut_bytes, the last one, was cut; -1: none yet */
    int64_t cut_bytes;
    int cut_packets;
    int32_t cut_full, cut_last;
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

#endif
