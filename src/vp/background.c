/* background.c - what other users of the machine do to its links: each link serves their messages
 * too, Poisson in time, so often that they take the given fraction of its time. Links are
 * independent; ports of nodes are one's own. */
#include <math.h>

#include "base/picoseconds.h"
#include "vp/vp.h"

struct background {
    struct world *world;
    struct random random;
    double mean_gap; /* between the messages on one link [ps] */
    sim_ps busy;     /* of one message */
    sim_ps next;     /* when the next one comes, at levels that ask */
    int link;
};

/* Exponential gaps make a Poisson process; at least 1 ps, so that time moves on. log1p(-u) with u
 * in [0, 1) never sees a logarithm of zero. */
static sim_ps gap(struct background *b)
{
    return ps_rounded(floor(-b->mean_gap * log1p(-random_uniform(&b->random, 0, 1)))) + 1;
}

static void pass(void *subject, uint64_t argument, sim_ps now)
{
    (void)argument;
    struct background *b = subject;
    struct world *w = b->world;
    /* Background must not keep a dead run alive: when nothing but background events is left, they
     * end, too, and the deadlock is seen. `alone`: all else is stuck. */
    bool alone = w->ready_count == 0 && sim_pending(w->sim) < w->background_events;
    w->background_events--;
    if (alone || w->nfinished == w->nrank || !net_occupy(w->net, b->link, now, b->busy)) return;
    w->background_events++;
    sim_at(w->sim, now + gap(b), LANE_BACKGROUND, (uint64_t)b->link, pass, b, 0);
}

/* The messages up to `now`, without an event for each. */
static sim_ps serve(void *context, int link, sim_ps now, sim_ps free)
{
    struct background *b = (struct background *)context + link;
    for (; b->next <= now; b->next += gap(b))
        free = ps_later(b->next > free ? b->next : free, b->busy);
    return free;
}

void background_start(struct world *w, uint64_t seed)
{
    const struct noise_spec *s = &w->machine->noise;
    if (s->background_load <= 0) return;
    int nlink = w->topology->nlink;
    struct background *b = TAKE(w->scratch, nlink, struct background);
    /* Levels that can be asked need no events for this traffic: only links that are used are worked
     * out. */
    const bool asked = net_ask_others(w->net, serve, b);
    if (!asked) w->background_events = nlink;
    for (int i = 0; i < nlink; i++) {
        double rate = topology_link_bandwidth(w->topology, i, w->machine->network.link_bandwidth);
        /* Load = busy / mean gap, whatever the size of the messages and the rate of the link. */
        double busy = (double)s->background_bytes / (rate * w->machine->network.link_bandwidth) *
                      SIM_PS_PER_S;
        /* A stream of its own for each link: what happens on one does not move the others. */
        b[i] = (struct background){.world = w,
                                   .random = random_make(seed, UINT64_MAX, (uint64_t)i),
                                   .mean_gap = busy / s->background_load,
                                   .busy = ps_rounded(busy),
                                   .link = i};
        b[i].next = gap(&b[i]);
        if (!asked) sim_at(w->sim, b[i].next, LANE_BACKGROUND, (uint64_t)i, pass, &b[i], 0);
    }
}
