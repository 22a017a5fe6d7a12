/* net_auto.h - optimistic messages: the closed form, and what level auto's two halves share.
 *
 * An optimistic message crosses resource h in [begin_h, end_h); packet i of it begins at begin_h +
 * i pace. */
#ifndef NET_NET_AUTO_H
#define NET_NET_AUTO_H

#include "net/net_packet.h"

/* auto_pace: time between the packets of a message. */
static inline sim_ps auto_pace(const struct flight *w) { return w->full * w->pass[0].flit; }

/* auto_begin: when packet `index` begins to cross its pass h. */
static inline sim_ps auto_begin(const struct flight *w, int index, int h)
{
    return w->pass[h].begin + index * auto_pace(w);
}

/* auto_tail: when the last flit of packet `index` crosses pass h; `slow`: slowest flit time of
 * passes 0 .. h. */
static inline sim_ps auto_tail(const struct flight *w, int index, int h, sim_ps slow)
{
    return auto_begin(w, index, h) + (flight_packet_flits(w, index) - 1) * slow;
}

/* auto_slow: slowest flit time of passes 0 .. h. */
static inline sim_ps auto_slow(const struct flight *w, int h)
{
    sim_ps slow = 0;
    for (int i = 0; i <= h; i++)
        if (w->pass[i].flit > slow) slow = w->pass[i].flit;
    return slow;
}

/* pass_claim: s into the claims of its resource, which are in the order of time. */
void pass_claim(struct fabric *f, struct pass *s);

/* auto_lane: the virtual channel behind pass h that packet `index` takes: packets that overlap
 * there use as many channels as overlap, in turn. */
int auto_lane(const struct fabric *f, const struct flight *w, int index, int h);

/* auto_overlap: how many packets of w are at once in the FIFOs behind pass h. */
int auto_overlap(const struct fabric *f, const struct flight *w, int h);

/* auto_until: grants before this time have been made. */
static inline sim_ps auto_until(const struct fabric *f)
{
    sim_ps now = sim_now(f->net->sim);
    return now + (f->late == now);
}

/* auto_granted: how many packets of an undisturbed message began to cross pass h before `until`. */
int auto_granted(const struct flight *w, int h, sim_ps until);

/* auto_turn: set o's round-robin pointer as the first `granted` packets of pass s have, unless
 * others came later. */
void auto_turn(const struct fabric *f, struct resource *o, const struct pass *s, int granted);

/* auto_clear: from when on nothing at pass h tells that w was there. */
static inline sim_ps auto_clear(const struct fabric *f, const struct pass *s)
{
    sim_ps credit = s->hop == s->flight->nhop ? 0 : s[1].end + f->net->credit,
           end = s->end + f->net->setup;
    return end > credit ? end : credit;
}

/* auto_earliest: lower bound of the time at which a simulated message asks for its pass s, which it
 * has not passed. */
sim_ps auto_earliest(const struct fabric *f, const struct pass *s, sim_ps now);

/* auto_simulate: from `now` on w is simulated packet by packet, and with it everybody whom it might
 * meet. */
void auto_simulate(struct fabric *f, struct flight *w, sim_ps now);

/* auto_occupied: as packet_occupied; whoever would have crossed the resource in that time is
 * simulated from now on. */
void auto_occupied(void *subject, uint64_t argument, sim_ps now);

#endif
