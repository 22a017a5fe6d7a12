/* routing.h - where a packet may go on from where its head is: the rules of network.routing, with
 * the virtual channels that keep each of them free of deadlock. No time in here.
 *
 * A level of the network asks at every router, when the head is at the front of its buffer, which
 * links and channels the packet may take (routing_next), gives it one of them by the state of its
 * buffers, and says which (routing_take). Random choices are drawn from a number of the packet's
 * own, so that they depend neither on the order of events nor on the number of workers. */
#ifndef MACHINE_ROUTING_H
#define MACHINE_ROUTING_H

#include "base/check.h"
#include "machine/topology.h"
#include "spec/routing_list.h"

enum { ROUTING_MOST_OPTIONS = 256 }; /* at one router */

/* A packet's way so far. Plain data, may be copied. */
struct route {
    int router, target; /* where its head is; of its destination */
    int source, node;   /* nodes: its source, its destination */
    int via;            /* where its first leg ends: a router, or a node; -1: none */
    int phase;          /* of the rule: legs behind, or the order of dimensions */
    int part;           /* of the rule: class on the ring, or the channel's order */
    int last;           /* of the rule: dimension and direction of the last link, its place, -1 */
    int channel;        /* that it came over, -1: from its node */
    int hops;           /* links behind */
    uint32_t drawn;     /* random numbers drawn from `choice` */
    uint64_t choice;
    struct route_cursor leg; /* rules that follow the topology's own routes: the present leg */
};

/* One way on. */
struct route_option {
    int link;
    int first, count; /* channels of it: first .. first + count - 1 */
    int priority;     /* the higher one is preferred where allocators obey it */
    int part, last;   /* what the route has on it */
};

/* What a rule may know of the load: flits that `link` was given and whose credits are not back. */
struct routing_view {
    int64_t (*used)(const void *of, int link); /* NULL: an empty network */
    const void *of;
};

struct routing {
    const struct topology *topology;
    const struct routing_type *type;
    enum routing_rule rule;
    int channels; /* virtual channels of a link */
    int escape;   /* so many lowest channels are free of deadlock by themselves and open to every
                     packet; 0: all channels are */
    int max_hops; /* longest route in links */
    int most;     /* ways on at one router */
    int *end;     /* (nlink) the router that a link leads to */
    bool minimal; /* through an empty network it takes as few links as the topology's own routes */
    bool fixed;   /* through an empty network the way depends on its ends alone */
    bool by_load; /* routes depend on `used` */
    bool at_source; /* by_load only at the first router */
    bool fits; /* above the escape a channel may be given only to a packet that it can hold whole:
                  one that stands behind another could not turn to the escape */
    bool kept; /* behind the first router the way needs no division, draw or load to be found again:
                  see routing_steps */
    void *state;                                      /* of the rule */
    void (*keep)(struct routing *r, struct arena *a); /* see routing_keep; NULL: nothing */
};

/* routing_create: rule `rule` on topology t, of which everything works unless the rule is the
 * deterministic one, with `channels` virtual channels a link (0: as many as it needs, for levels
 * without channels), memory from `a`; t is borrowed. Returns NULL with ERR_CONFIG when the rule is
 * not for this family, needs more channels, or something has failed. */
struct routing *routing_create(const struct topology *t, enum routing_rule rule, int channels,
                               struct arena *a, struct err *e);

/* routing_keep: for many packets: of a small network, work out once and keep in `a` what the rule
 * asks for at every step. Answers stay the same. */
void routing_keep(struct routing *r, struct arena *a);

/* routing_start: a packet from node src to node dst; `choice` is its random number. */
struct route routing_start(const struct routing *r, int src, int dst, uint64_t choice);

/* routing_inject: the channels over which it may enter the network: *first .. *first + result - 1.
 */
int routing_inject(const struct routing *r, struct route *p, int *first);

/* routing_eject: the channels over which it may leave the network at its target's router, once
 * routing_next has said 0: *first .. *first + result - 1. */
int routing_eject(const struct routing *r, const struct route *p, int *first);

/* routing_next: the ways on from p->router into option[ROUTING_MOST_OPTIONS]; returns how many, 0:
 * this is the target's router. To be called once at each router: it may draw random numbers. */
int routing_next(const struct routing *r, struct route *p, const struct routing_view *view,
                 struct route_option *option);

/* routing_take: p goes over option o on its channel `channel`. */
static inline void routing_take(const struct routing *r, struct route *p,
                                const struct route_option *o, int channel)
{
    CHECK(channel >= o->first && channel < o->first + o->count);
    p->router = r->end[o->link];
    p->part = o->part;
    p->last = o->last;
    p->channel = channel;
    p->hops++;
}

/* Ways behind the first router, of rules by which these depend on few states of a packet: a byte
 * for each state, router and goal. Low bits: the output, as links that leave the router are
 * numbered, or one of ROUTING_STEP_*; above them the state behind it, which names the channels. */
struct routing_steps {
    int nstate;
    const uint8_t *step;                    /* (nstate x nrouter x nrouter) */
    uint8_t first[4], count[4];             /* channels of a link by the state behind it */
    uint8_t eject_first[4], eject_count[4]; /* channels out of the network, by state */
    int fan;      /* of ROUTING_STEP_ANY: outputs `any`, `any` + 1, ... of the router, by chance */
    uint8_t *any; /* (nrouter) */
};

enum {
    ROUTING_STEP_BITS = 6,
    ROUTING_STEP_MOST = 60, /* outputs of a router, at most */
    ROUTING_STEP_ANY = 61,  /* one of some outputs, drawn by routing_draw */
    ROUTING_STEP_TURN,      /* the first leg ends: on to the target, in the state of the step */
    ROUTING_STEP_EJECT
};

/* routing_steps: these for rule r, memory from `a`; NULL: the rule is not of that kind, or the
 * network large. */
const struct routing_steps *routing_steps(const struct routing *r, struct arena *a);

/* routing_state: the state of p, which has left its first router; *goal: where its leg ends. */
int routing_state(const struct routing *r, const struct route *p, int *goal);

/* routing_draw: a random number below n >= 1 of packet p. */
int routing_draw(struct route *p, int n);

/* routing_empty: one step of p through an empty network, over *link; false when it is there. */
bool routing_empty(const struct routing *r, struct route *p, int *link);

#endif
