/* net_clocked_few.c - looks at routers in which few lanes meet: what net_clocked_allocate.c does,
 * without its lists.
 *
 * Each lane has one way on, and no two heads ask at one port, so that each gets the free channel
 * whose turn it is. What is left is the switch, among so few bids that a set of them is a byte.
 *
 * Say bids 0 and 1 are for one output, 1 and 2 from one input, and the output's turn is nearer to
 * 0, the input's to 1. Then nearer_out[1] = {0} and nearer_in[2] = {1}. In the first round the
 * outputs offer themselves to 0 and 2; 1 is offered nothing, so that 2 is the best of its input,
 * and both win. Had the output's turn been nearer to 1, its input would have accepted that, and 2
 * would have to come back, as 0 would: nothing is left for a second round.
 *
 * Offers depend on turns as they were before the round, which is why turns are compared once, when
 * a bid is added: those of a port that has been given do not count any more. */
#include "base/check.h"
#include "net/net_clocked_step.h"

enum { FEW = 8 };

/* A bid for the switch. */
struct bid {
    struct clocked_lane *lane, *channel; /* of a head: the channel that it got, NULL: none */
    struct clocked_port *in, *out;
    uint8_t number; /* of the channel */
    uint8_t input;  /* of the lane in its router */
    bool head;
};

struct bids {
    int n;
    /* Bids for the same output that are nearer to its turn, of the same input that are nearer to
     * the turn of that, and all that meet this one. */
    uint8_t nearer_in[FEW], nearer_out[FEW], meet[FEW];
    bool merged[FEW]; /* it won against another of the same input and output */
    struct bid bid[FEW];
};

/* Whether b is before x, of the same input and output: that which has its channel before that which
 * hopes for it, then by turn. */
static inline bool bid_before(const struct clocked *g, const struct bid *b, const struct bid *x)
{
    const int turn = b->in->turn;
    int mine = g->channel[b->input] - turn, its = g->channel[x->input] - turn;
    if (mine < 0) mine += (int)g->nchannel;
    if (its < 0) its += (int)g->nchannel;
    return b->head != x->head ? !b->head : mine < its;
}

/* Of two FIFOs of an input that bid for one output one does. The other one will have to come back.
 */
static void bids_merge(struct clocked *g, struct bids *s, int i, const struct bid *b)
{
    struct bid *x = &s->bid[i], loser = *b;
    if (bid_before(g, b, x)) {
        loser = *x;
        *x = *b;
    }
    s->merged[i] = true;
    if (loser.channel) clocked_own(g, loser.lane, loser.channel);
}

/* Notes which of two bids for one output, or of one input, is nearer to the turn. */
static void bids_compare(struct bids *s, int i, int n)
{
    const struct clocked_port *in = s->bid[n].in, *out = s->bid[n].out, *in2 = s->bid[i].in,
                              *out2 = s->bid[i].out;
    const uint8_t mine = (uint8_t)(1 << n), its = (uint8_t)(1 << i);
    s->meet[n] |= its;
    s->meet[i] |= mine;
    if (in == in2) {
        const int turn = in->accept;
        if (clocked_after(out->out, turn) < clocked_after(out2->out, turn)) s->nearer_in[i] |= mine;
        else s->nearer_in[n] |= its;
    } else {
        const int turn = out->grant;
        if (clocked_after(in->in, turn) < clocked_after(in2->in, turn)) s->nearer_out[i] |= mine;
        else s->nearer_out[n] |= its;
    }
}

/* False: it was merged with another one. */
static bool bids_add(struct clocked *g, struct bids *s, const struct bid *b)
{
    const int n = s->n;
    CHECK(n < FEW);
    for (int i = 0; i < n; i++)
        if (s->bid[i].in == b->in && s->bid[i].out == b->out) {
            bids_merge(g, s, i, b);
            return false;
        }
    s->nearer_in[n] = s->nearer_out[n] = s->meet[n] = 0;
    s->merged[n] = false;
    s->bid[s->n++] = *b;
    for (int i = 0; i < n; i++)
        if (s->bid[i].in == b->in || s->bid[i].out == b->out) bids_compare(s, i, n);
    return true;
}

/* The set of bids that win, in rounds: every output that has none yet offers itself to the input
 * whose turn it is, every input accepts one. Turns move on in the first round alone. */
static unsigned bids_win(const struct clocked *g, const struct bids *s)
{
    unsigned left = (1u << s->n) - 1, won = 0;
    for (int k = 0; k < g->iterations && left; k++) {
        unsigned offered = 0, accepted = 0;
        for (int i = 0; i < s->n; i++)
            if ((left >> i & 1) && !(s->nearer_out[i] & left)) offered |= 1u << i;
        for (int i = 0; i < s->n; i++)
            if ((offered >> i & 1) && !(s->nearer_in[i] & offered)) accepted |= 1u << i;
        for (int i = 0; i < s->n; i++) {
            if (!(accepted >> i & 1)) continue;
            left &= ~(1u << i | s->meet[i]);
            if (k == 0) clocked_crosses(s->bid[i].in, s->bid[i].out);
        }
        won |= accepted;
    }
    return won;
}

/* The bid of head v, number b->input of its router, into *b, and the channel that it gets. False:
 * it makes none. */
static bool bid_of_head(struct clocked *g, struct clocked_router *o, struct clocked_lane *v,
                        int32_t now, struct bid *b, int32_t *again)
{
    struct clocked_port *p = v->way;
    const struct clocked_chance c = clocked_find(g, v, p, v->head.first, v->head.count, now);
    const int32_t at = clocked_later(b->in->passed, p->free);
    const bool bids = c.bids && at <= now;
    b->head = true;
    b->channel = c.channel;
    b->number = (uint8_t)c.number;
    *again = clocked_sooner(*again, c.again);
    if (c.bids && !bids) *again = clocked_sooner(*again, at);
    if (c.channel) clocked_given(v, b->input, c.channel, p->lanes_out + c.number);
    if (c.channel || bids) clocked_tries(g, o, v);
    if (c.channel && !bids) {
        clocked_own(g, v, c.channel);
        *again = clocked_sooner(*again, now + g->flit);
    }
    return bids;
}

/* What becomes of a bid. False: it has to come back. Whom others meet sends one flit: these bid
 * again in the next cycle. */
static bool bid_ends(struct clocked *g, const struct bid *b, bool won, bool met, int32_t now)
{
    const int32_t most = met ? 1 : INT32_MAX;
    if (won) b->in->turn = g->after[b->input];
    if (!b->head) {
        if (won) clocked_send(g, b->lane, now, most);
        return won;
    }
    if (!b->channel) return false;
    if (won && (g->whole || b->out >= g->sink ||
                clocked_room(g, b->channel, b->out, 1, now, false) <= now)) {
        clocked_pass_on(g, b->lane, b->in, b->out, b->number, now, most);
        return true;
    }
    clocked_own(g, b->lane, b->channel);
    return false;
}

/* All bids. Returns when to look again. */
static int32_t bids_end(struct clocked *g, const struct bid *bid, int n, int32_t now)
{
    struct bids s;
    int32_t again = CLOCKED_NEVER;
    s.n = 0;
    for (int i = 0; i < n; i++)
        if (!bids_add(g, &s, &bid[i])) again = now + g->flit;
    const unsigned won = bids_win(g, &s);
    for (int i = 0; i < s.n; i++)
        if (!bid_ends(g, &s.bid[i], won >> i & 1, s.meet[i] || s.merged[i], now))
            again = now + g->flit;
    return again;
}

/* Of two bids for one input or output, whether it is y's turn. */
static inline bool pair_turn(const struct clocked *g, const struct bid *x, const struct bid *y)
{
    const struct clocked_port *in = x->in, *out = x->out;
    if (in == y->in && out == y->out) return bid_before(g, y, x);
    if (in == y->in)
        return clocked_after(y->out->out, in->accept) < clocked_after(out->out, in->accept);
    return clocked_after(y->in->in, out->grant) < clocked_after(in->in, out->grant);
}

/* Two bids at most, without sets. One of two that meet wins: the turn that it won by moves on. */
static int32_t pair_ends(struct clocked *g, const struct bid *bid, int n, int32_t now)
{
    int32_t again = CLOCKED_NEVER;
    const struct bid *x = &bid[0], *y = &bid[n - 1];
    const bool in = x->in == y->in, out = x->out == y->out;
    if (n < 2 || (!in && !out)) {
        for (int i = 0; i < n; i++) {
            clocked_crosses(bid[i].in, bid[i].out);
            if (!bid_ends(g, &bid[i], true, false, now)) again = now + g->flit;
        }
        return again;
    }
    const bool second = pair_turn(g, x, y);
    /* Offers and acceptances come to this: the loser's port is given away in the first round. */
    const struct bid *winner = second ? y : x, *loser = second ? x : y;
    clocked_crosses(winner->in, winner->out);
    if (loser->channel) clocked_own(g, loser->lane, loser->channel);
    bid_ends(g, winner, true, true, now);
    return now + g->flit;
}

/* ---- two that send ---- */

/* A FIFO that has its channel and has sent its head. */
struct sender {
    struct bid bid;
    struct clocked_lane *to;
    int32_t left;              /* flits that are still to be sent */
    int32_t at;                /* when the next one can go, as far as that is its own affair */
    int32_t sent, first, last; /* flits that went; when */
};

static bool goes_on(const struct clocked_lane *v)
{
    return v->head.state == LANE_SENDING && v->front->ahead->sent > 0;
}

static struct sender sender_of(const struct clocked *g, struct clocked_router *o,
                               struct clocked_lane *v, int32_t now)
{
    const struct clocked_leg *m = v->front->ahead;
    const int i = (int)(v - o->lane);
    return (struct sender){
        .bid = {.lane = v, .in = &o->port[g->entry[i]], .out = v->way, .input = (uint8_t)i},
        .to = &g->lane[m->lane],
        .left = m->flits - m->sent,
        .at = now};
}

/* Its next flit crosses at `at`. */
static void sender_sends(struct clocked *g, struct sender *s, int32_t at)
{
    struct clocked_port *in = s->bid.in, *out = s->bid.out;
    struct clocked_lane *v = s->bid.lane, *to = s->to;
    clocked_crosses(in, out);
    in->turn = g->after[s->bid.input];
    in->passed = out->free = at + g->flit;
    clocked_stay(g, v, v->out++)->go = at;
    to->clear = CLOCKED_NEVER;
    if (out < g->sink) clocked_stay(g, to, to->in++)->come = at + g->reach + out->wire;
    if (s->sent++ == 0) s->first = at;
    s->last = at;
    s->left--;
}

/* Two FIFOs that go on and share an input or an output, flit by flit as their turns are, until
 * somebody else may dispute that or a tail has gone: the records tell the future, as after the
 * flits of one that is alone. Returns when the next one of them can go. */
static int32_t duet(struct clocked *g, struct clocked_router *o, int32_t now)
{
    struct sender s[2] = {sender_of(g, o, g->active[0], now), sender_of(g, o, g->active[1], now)};
    int32_t until = now + ROUTER_AHEAD * g->flit;
    for (int i = 0; i < 2; i++) {
        clocked_tries(g, o, s[i].bid.lane);
        until = clocked_undisputed(g, s[i].bid.lane, s[!i].bid.lane, s[i].bid.out, until, now);
    }
    for (int32_t at = now; at == now || at < until;) {
        const int i = s[0].at != s[1].at ? s[1].at < s[0].at : pair_turn(g, &s[0].bid, &s[1].bid);
        sender_sends(g, &s[i], at);
        for (int k = 0; k < 2; k++) {
            s[k].at = s[k].left > 0 ? clocked_sends_from(g, s[k].bid.lane, at + g->flit, false)
                                    : CLOCKED_NEVER;
            /* A flit or credit that is not known yet may come. */
            if (s[k].at == CLOCKED_NEVER)
                until = clocked_sooner(until, now + clocked_sooner(g->reach, g->credit));
        }
        at = clocked_sooner(s[0].at, s[1].at);
        if (s[i].left == 0) break;
    }
    for (int i = 0; i < 2; i++)
        if (s[i].sent > 0)
            clocked_sent(g, s[i].bid.lane, s[i].bid.in, s[i].sent, s[i].first, s[i].last);
    return clocked_sooner(s[0].at, s[1].at);
}

int32_t clocked_few(struct clocked *g, struct clocked_router *o, int n, int32_t now)
{
    struct bid bid[FEW];
    int32_t again = CLOCKED_NEVER;
    int nbid = 0;
    if (n > FEW) return -1;
    if (n == 2 && !g->whole && goes_on(g->active[0]) && goes_on(g->active[1]))
        return duet(g, o, now);
    for (int k = 0; k < n; k++) {
        struct clocked_lane *v = g->active[k];
        const int i = (int)(v - o->lane);
        struct bid *b = &bid[nbid];
        *b = (struct bid){
            .lane = v, .in = &o->port[g->entry[i]], .out = v->way, .input = (uint8_t)i};
        if (v->head.state == LANE_SENDING) clocked_tries(g, o, v);
        else if (!bid_of_head(g, o, v, now, b, &again)) continue;
        nbid++;
    }
    /* Only now does anything cross: what bids see is the state at the beginning of the cycle. */
    return clocked_sooner(again,
                          nbid <= 2 ? pair_ends(g, bid, nbid, now) : bids_end(g, bid, nbid, now));
}
