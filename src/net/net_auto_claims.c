/* net_auto_claims.c - what optimistic messages have claimed: where each is by its closed form, and
 * what stays of it when it has been delivered (net_auto.h). */
#include "net/net_account.h"
#include "net/net_auto.h"

static inline sim_ps later(sim_ps a, sim_ps b) { return a > b ? a : b; }

/* ---- lists of passes ---- */

/* A pass is in one list at a time: as a claim, or as one that is still to come. */
static struct pass **pass_list(struct fabric *f, const struct pass *s)
{
    struct resource *o = &f->resource[s->resource];
    return s->state == PASS_CLAIM ? &o->claim : &o->pending;
}

void pass_unlink(struct fabric *f, struct pass *s)
{
    if (s->state == PASS_NONE) return;
    if (s->prev)
        s->prev->next = s->next;
    else
        *pass_list(f, s) = s->next;
    if (s->next) s->next->prev = s->prev;
    if (s->hop == 0 && f->source[s->resource].last_claim == s)
        f->source[s->resource].last_claim = s->prev;
    s->state = PASS_NONE;
}

/* Insertion by time from the front. Claims of an injection port come in order, so that they are
 * appended without a search. */
void pass_claim(struct fabric *f, struct pass *s)
{
    struct resource *o = &f->resource[s->resource];
    struct pass *before = NULL, *after = o->claim;
    if (s->hop == 0) {
        before = f->source[s->resource].last_claim;
        after = NULL;
        f->source[s->resource].last_claim = s;
    }
    while (after && after->begin < s->begin) {
        before = after;
        after = after->next;
    }
    s->prev = before;
    s->next = after;
    *(before ? &before->next : &o->claim) = s;
    if (after) after->prev = s;
    s->state = PASS_CLAIM;
}

/* ---- where a message is ---- */

/* A packet stays behind pass h from its head's arrival until its tail has left; packets come one
 * pace apart. */
int auto_overlap(const struct fabric *f, const struct flight *w, int h)
{
    sim_ps pace = auto_pace(w), stay = f->net->tau + pace - w->pass[0].flit + w->pass[h + 1].flit;
    return (int)((stay + pace - 1) / pace);
}

int auto_lane(const struct fabric *f, const struct flight *w, int index, int h)
{
    const struct pass *s = &w->pass[h];
    if (s->nchannel == 1 || w->npacket == 1) return s->channel;
    return s->channel + index % auto_overlap(f, w, h);
}

/* The last pass behind that has granted a packet more: from there the next packet needs tau a hop,
 * if nothing delays it. A lower bound that only grows with time. */
sim_ps auto_earliest(const struct fabric *f, const struct pass *s, sim_ps now)
{
    const struct flight *w = s->flight;
    int g = s->hop - 1;
    while (g >= 0 && w->pass[g].granted <= s->granted) g--;
    sim_ps at = now;
    if (g >= 0 && w->pass[g].granted == s->granted + 1)
        at = later(now, w->pass[g].last + f->net->tau);
    return at + (s->hop - g - 1) * f->net->tau;
}

/* ---- after delivery ---- */

/* A pointer that a later grant has set already stays. */
void auto_turn(const struct fabric *f, struct resource *o, const struct pass *s, int granted)
{
    const struct flight *w = s->flight;
    sim_ps at = auto_begin(w, granted - 1, s->hop);
    if (s->hop == 0 || at < o->turn_time) return;
    o->turn = (uint32_t)(s[-1].port * f->nchannel + auto_lane(f, w, granted - 1, s->hop - 1)) + 1;
    o->turn_time = at;
}

/* Packets begin one pace apart, strictly before `until`. */
int auto_granted(const struct flight *w, int h, sim_ps until)
{
    if (!w->m) return w->npacket; /* delivered */
    sim_ps since = until - w->pass[h].begin;
    if (since <= 0) return 0;
    if (w->npacket == 1) return 1;
    sim_ps count = (since + auto_pace(w) - 1) / auto_pace(w);
    return count < w->npacket ? (int)count : w->npacket;
}

/* Round-robin pointers are brought up to date when somebody needs them, not at every claim. */
void auto_catch_up(struct fabric *f, struct resource *o, sim_ps now)
{
    for (const struct pass *s = o->claim; s && s->begin < now; s = s->next)
        auto_turn(f, o, s, auto_granted(s->flight, s->hop, now));
}

/* The same sums as the grants of level packet would have made. */
static void auto_account(struct fabric *f, const struct flight *w, sim_ps wait)
{
    sim_ps slow = 0;
    for (int h = 0; h <= w->nhop; h++) {
        const struct pass *s = &w->pass[h];
        slow = later(slow, s->flit);
        int64_t gaps = (int64_t)(w->npacket - 1) * (w->full - 1) + w->last - 1;
        net_account(f->net, s->resource, net_job(w->m), 1, w->m->bytes,
                    gaps * slow + w->npacket * s->flit, h == 0 ? wait : 0);
    }
}

/* Forget messages whose last trace is gone. A delivered message still matters for a while: its last
 * credits are on their way. */
static void retire(struct fabric *f, sim_ps now)
{
    while (f->retired && f->retired->clear <= now) {
        struct flight *w = f->retired;
        f->retired = w->next;
        for (int h = 0; h <= w->nhop; h++) {
            struct pass *s = &w->pass[h];
            if (s->state == PASS_CLAIM) auto_turn(f, &f->resource[s->resource], s, w->npacket);
            pass_unlink(f, s);
        }
        flight_return(f, w);
    }
}

void auto_delivered(struct fabric *f, struct flight *w)
{
    if (f->net->load) auto_account(f, w, w->m->injected - w->m->ready);
    w->m = NULL;
    w->next = NULL;
    *(f->retired ? &f->retired_back->next : &f->retired) = w;
    f->retired_back = w;
    retire(f, sim_now(f->net->sim));
}
