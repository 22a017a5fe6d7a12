/* background.c - what other users of the machine do to its links. */
#include <math.h>

#include "vp/vp.h"

struct background {
    struct world *world;
    struct random random;
    double mean_gap;   /* between the messages of one node [ps] */
    int64_t bytes;
    int node;
    uint32_t sent;
};

static int other_node(struct background *b)
{
    int n = b->world->topology->nnode, k = (int)random_below(&b->random, (uint64_t)n - 1);
    return k >= b->node ? k + 1 : k;
}

static sim_ps gap(struct background *b) { return (sim_ps)(-b->mean_gap * log1p(-random_uniform(&b->random, 0, 1))) + 1; }

static void emit(void *subject, uint64_t argument, sim_ps now)
{
    (void)argument;
    struct background *b = subject;
    struct world *w = b->world;
    if (w->nfinished == w->nrank) return;
    struct message *m = message_take(w, 0);
    m->kind = MESSAGE_BACKGROUND;
    m->net.id = (int64_t)(w->nrank + b->node) << 32 | b->sent++;
    m->net.src = b->node;
    m->net.dst = other_node(b);
    m->net.bytes = b->bytes;
    m->net.ready = now;
    net_send(w->net, &m->net);
    sim_at(w->sim, now + gap(b), LANE_BACKGROUND, (uint64_t)b->node, emit, b, 0);
}

/* Mean number of links between two different random nodes. */
static double mean_distance(const struct topology *t, struct random r)
{
    enum { SAMPLES = 2000 };
    double sum = 0;
    for (int k = 0; k < SAMPLES; k++) {
        int a = (int)random_below(&r, (uint64_t)t->nnode), b = (int)random_below(&r, (uint64_t)t->nnode - 1);
        sum += topology_distance(t, a, b >= a ? b + 1 : b);
    }
    return sum / SAMPLES;
}

void background_start(struct world *w, uint64_t seed)
{
    const struct noise_spec *s = &w->machine->noise;
    const struct topology *t = w->topology;
    if (s->background_load <= 0 || t->nnode < 2 || t->nlink == 0) return;
    double busy = (double)s->background_bytes / w->machine->network.link_bandwidth * SIM_PS_PER_S;
    double hops = mean_distance(t, random_make(seed, UINT64_MAX, 0));
    double mean_gap = busy * hops * t->nnode / (s->background_load * t->nlink);
    struct background *b = TAKE(w->scratch, t->nnode, struct background);
    for (int i = 0; i < t->nnode; i++) {
        b[i] = (struct background){.world = w, .random = random_make(seed, UINT64_MAX, (uint64_t)i + 1),
                                   .mean_gap = mean_gap, .bytes = s->background_bytes, .node = i};
        sim_at(w->sim, gap(&b[i]), LANE_BACKGROUND, (uint64_t)i, emit, &b[i], 0);
    }
}
