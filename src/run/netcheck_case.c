/* netcheck_case.c - topologies by name, one-step patterns and random loads of the reference data. */
#include "run/netcheck_case.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/random.h"
#include "machine/topology.h"

/* ---- topologies ---- */

struct family_name {
    const char *word;
    enum topology_family family;
};

static const struct family_name families[] = {
    {"fattree", TOPOLOGY_FAT_TREE},    {"fat_tree", TOPOLOGY_FAT_TREE},   {"dragonfly", TOPOLOGY_DRAGONFLY},
    {"fullmesh", TOPOLOGY_FULL_MESH},  {"full_mesh", TOPOLOGY_FULL_MESH}, {"crossbar", TOPOLOGY_CROSSBAR},
    {"hypercube", TOPOLOGY_HYPERCUBE}, {"hcube", TOPOLOGY_HYPERCUBE},     {"torus", TOPOLOGY_TORUS},
    {"ring", TOPOLOGY_TORUS},          {"mesh", TOPOLOGY_MESH},           {"bus", TOPOLOGY_BUS},
};

/* the numbers in `text`, whatever stands between them */
static int numbers_in(const char *text, int *number, int most)
{
    int n = 0;
    while (*text && n < most) {
        if (isdigit((unsigned char)*text)) {
            char *end;
            number[n++] = (int)strtol(text, &end, 10);
            text = end;
        } else {
            text++;
        }
    }
    return n;
}

/* "8x8" anywhere in text: numbers joined by x; or "k8n2", "k8_n2": n times k */
static int radices_in(const char *text, int *radix, int most)
{
    int n = 0;
    bool by_power = false;
    for (; *text && !isdigit((unsigned char)*text); text++) by_power = *text == 'k';
    while (isdigit((unsigned char)*text) && n < most) {
        char *end;
        radix[n++] = (int)strtol(text, &end, 10);
        text = end + (*end == 'x' && isdigit((unsigned char)end[1]));
    }
    int times = 1;
    if (by_power && n == 1 && numbers_in(text, &times, 1) == 1)
        for (n = 0; n < times && n < most; n++) radix[n] = radix[0];
    return n;
}

bool netcheck_topology(const char *name, int tie, struct topology_spec *s, struct err *e)
{
    *s = (struct topology_spec){.nodes_per_router = 1, .processors_per_node = 1};
    s->tie = tie == 0 ? TIE_POSITIVE : TIE_PARITY;
    const char *found = NULL;
    for (size_t i = 0; !found && i < sizeof families / sizeof *families; i++) {
        found = strstr(name, families[i].word);
        s->family = families[i].family;
    }
    if (!found) return err_set(e, ERR_DATA, "unknown topology '%s'", name);
    bool grid = s->family == TOPOLOGY_TORUS || s->family == TOPOLOGY_MESH;
    s->ndim = (grid ? radices_in : numbers_in)(found, s->dims, MACHINE_MAX_DIMS);
    if (s->ndim == 0) s->ndim = (grid ? radices_in : numbers_in)(name, s->dims, MACHINE_MAX_DIMS); /* "8x8 torus" */
    int needed = s->family == TOPOLOGY_FAT_TREE ? 2 : s->family == TOPOLOGY_DRAGONFLY ? 3 : 1;
    if (s->ndim < needed) return err_set(e, ERR_DATA, "topology '%s' lacks its numbers", name);
    if (strstr(name, "valiant")) s->routing = ROUTE_VALIANT;
    if (s->family == TOPOLOGY_FAT_TREE) s->routing = ROUTE_VALIANT; /* the reference's way up is random */
    if (s->family == TOPOLOGY_DRAGONFLY) s->dims[3] = 0;            /* what follows p, a and h is the number of nodes */
    return true;
}

struct machine_spec netcheck_machine(const struct topology_spec *s, int vcs, int buffer, int packet_flits,
                                     int head_cycles)
{
    const double cycle = 1e-9;
    struct machine_spec m = {.name = "reference", .topology = *s};
    m.network = (struct network_spec){
        .link_bandwidth = NETCHECK_FLIT_BYTES / cycle,
        .hop_latency = head_cycles * cycle,
        .end_latency = 2 * cycle,
        .credit_latency = 2 * cycle,
        .flit_bytes = NETCHECK_FLIT_BYTES,
        .packet_bytes = (int64_t)packet_flits * NETCHECK_FLIT_BYTES,
        .virtual_channels = vcs,
        .buffer_flits = buffer,
        .arbitration = ARBITRATION_ROUND_ROBIN,
    };
    m.software.eager_bytes = -1;
    return m;
}

/* ---- lists ---- */

static void traffic_take(struct traffic *q, int n, struct arena *a)
{
    *q = (struct traffic){.nmessage = n};
    q->src = TAKE(a, n + 1, int);
    q->dst = TAKE(a, n + 1, int);
    q->bytes = TAKE(a, n + 1, int64_t);
    q->time = TAKE(a, n + 1, sim_ps);
}

bool netcheck_step(const char *pattern, int distance, int nnode, int flits, struct arena *a, struct traffic *q,
                   struct err *e)
{
    bool shift = strcmp(pattern, "shift") == 0, trunc = strcmp(pattern, "trunc") == 0;
    if (!shift && !trunc && strcmp(pattern, "xor") != 0)
        return err_set(e, ERR_DATA, "unknown pattern '%s' of a step", pattern);
    traffic_take(q, nnode, a);
    q->nmessage = 0;
    for (int i = 0; i < nnode; i++) {
        int to = shift ? (i + distance) % nnode : trunc ? i + distance : i ^ distance;
        if (to >= nnode) continue;
        q->src[q->nmessage] = i;
        q->dst[q->nmessage] = to;
        q->bytes[q->nmessage++] = (int64_t)flits * NETCHECK_FLIT_BYTES;
    }
    return true;
}

/* ---- random loads ---- */

enum rule { UNIFORM, BIT_COMPLEMENT, BIT_REVERSE, TRANSPOSE, SHUFFLE, TORNADO, NEIGHBOUR, SHIFT, BAD_DRAGONFLY };

struct pattern {
    enum rule rule;
    int nnode, bits; /* nodes; log2 of them */
    int radix, ndim; /* tornado, neighbour */
    int distance;    /* shift */
    int group;       /* nodes per group of a dragonfly */
};

static const struct {
    const char *word;
    enum rule rule;
    bool power_of_two;
} rules[] = {
    {"uniform", UNIFORM, false},    {"bitcomp", BIT_COMPLEMENT, true}, {"bitrev", BIT_REVERSE, true},
    {"transpose", TRANSPOSE, true}, {"shuffle", SHUFFLE, true},        {"tornado", TORNADO, false},
    {"neighbor", NEIGHBOUR, false}, {"shift", SHIFT, false},           {"bad_dragon", BAD_DRAGONFLY, false},
};

static bool pattern_read(const char *text, const struct topology *t, struct pattern *p, struct err *e)
{
    int number[2] = {0, 0}, n = numbers_in(text, number, 2), found = -1;
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++)
        if (strncmp(text, rules[i].word, strlen(rules[i].word)) == 0) found = (int)i;
    if (found < 0) return err_set(e, ERR_DATA, "unknown pattern '%s'", text);
    *p = (struct pattern){.rule = rules[found].rule, .nnode = t->nnode, .distance = number[0]};
    while (1 << p->bits < t->nnode) p->bits++;
    if (rules[found].power_of_two && 1 << p->bits != t->nnode)
        return err_set(e, ERR_DATA, "pattern '%s' needs 2^n nodes, not %d", text, t->nnode);
    if (p->rule == TORNADO || p->rule == NEIGHBOUR) {
        p->radix = n > 0 ? number[0] : t->spec->dims[0];
        p->ndim = n > 1 ? number[1] : t->spec->ndim;
        if (n < 1 && t->spec->ndim < 1) return err_set(e, ERR_DATA, "pattern '%s' lacks its radix", text);
    }
    if (p->rule == SHIFT && n < 1) return err_set(e, ERR_DATA, "pattern '%s' lacks its distance", text);
    if (p->rule == BAD_DRAGONFLY) p->group = t->spec->dims[0] * t->spec->dims[1];
    if (p->rule == BAD_DRAGONFLY && t->spec->family != TOPOLOGY_DRAGONFLY)
        return err_set(e, ERR_DATA, "pattern '%s' needs a dragonfly", text);
    return true;
}

/* every coordinate of i moved up by `step` around its ring */
static int digits_moved(const struct pattern *p, int i, int step)
{
    int to = 0, stride = 1;
    for (int d = 0; d < p->ndim; d++, stride *= p->radix) to += (i / stride + step) % p->radix * stride;
    return to;
}

static int bits_reversed(int i, int bits)
{
    int to = 0;
    for (int b = 0; b < bits; b++) to |= (i >> b & 1) << (bits - 1 - b);
    return to;
}

static int destination(const struct pattern *p, int i, struct random *r)
{
    int mask = p->nnode - 1, half = p->bits / 2;
    switch (p->rule) {
    case UNIFORM:
        return (int)random_below(r, (uint64_t)p->nnode);
    case BIT_COMPLEMENT:
        return ~i & mask;
    case BIT_REVERSE:
        return bits_reversed(i, p->bits);
    case TRANSPOSE:
        return (i >> half | i << half) & mask;
    case SHUFFLE:
        return (i << 1 & mask) | i >> (p->bits - 1);
    case TORNADO:
        return digits_moved(p, i, (p->radix + 1) / 2 - 1);
    case NEIGHBOUR:
        return digits_moved(p, i, 1);
    case SHIFT:
        return (i + p->distance) % p->nnode;
    case BAD_DRAGONFLY:
        return ((i / p->group + 1) * p->group) % p->nnode + (int)random_below(r, (uint64_t)p->group);
    }
    CHECK(false);
    return 0;
}

/* cycles until the next arrival, >= 1, when each cycle has one with probability prob */
static double geometric(struct random *r, double prob)
{
    if (prob >= 1) return 1;
    double u = random_uniform(r, 0, 1);
    return floor(log1p(-u) / log1p(-prob)) + 1;
}

bool netcheck_load(const char *pattern, const struct topology *t, int flits, double load, int cycles, uint64_t seed,
                   struct arena *a, struct traffic *q, struct err *e)
{
    struct pattern p = {0};
    if (!pattern_read(pattern, t, &p, e)) return false;
    if (flits < 1 || !(load > 0) || cycles < 1)
        return err_set(e, ERR_DATA, "load %g with packets of %d flits for %d cycles", load, flits, cycles);
    double prob = load / flits;
    double expected = prob * cycles * t->nnode;
    int most = (int)(expected + 8 * sqrt(expected) + 64), n = 0;
    traffic_take(q, most, a);
    for (int i = 0; i < t->nnode; i++) {
        struct random r = random_make(seed, 0x6c6f6164, (uint64_t)i); /* "load" */
        for (double at = geometric(&r, prob) - 1; at < cycles && n < most; at += geometric(&r, prob), n++) {
            q->src[n] = i;
            q->dst[n] = destination(&p, i, &r);
            q->bytes[n] = (int64_t)flits * NETCHECK_FLIT_BYTES;
            q->time[n] = (sim_ps)at * NETCHECK_CYCLE_PS;
        }
    }
    q->nmessage = n;
    return true;
}
