/* net_clocked_allocate.h - looks at routers in which lanes meet: what one notes of each. */
#ifndef NET_NET_CLOCKED_ALLOCATE_H
#define NET_NET_CLOCKED_ALLOCATE_H

#include "net/net_clocked_step.h"

/* Of a lane in one allocation, see struct lane. */
struct clocked_match {
    struct clocked_lane *match, *wish, *fresh, *pick;
    int pick_priority;
    bool bars;
};

/* Of a port. */
struct clocked_side {
    const struct clocked_port *match, *wish, *pick;
};

struct clocked_ask {
    struct clocked_lane *in, *out;
    int priority;
};

struct clocked_bid {
    struct clocked_lane *lane;
    struct clocked_port *in, *out;
    bool spec;
};

#endif
