/* netcheck_case.c - topologies by name, one-step patterns and random loads of the reference
 * data. */
#include "study/netcheck_case.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/random.h"
#include "base/text.h"
#include "machine/topology.h"

/* most nodes whose routes are all followed; channels inside and between a dragonfly's groups
 * [cycles] */
enum { MOST_ROUTED_NODES = 4096, LOCAL_CHANNEL = 10, GLOBAL_CHANNEL = 100 };

/* ---- topologies ---- */

struct family_name {
    const char *word;
    enum topology_family family;
};

static const struct family_name families[] = {
    {"fattree", TOPOLOGY_FAT_TREE},    {"fat_tree", TOPOLOGY_FAT_TREE},
    {"dragonfly", TOPOLOGY_DRAGONFLY}, {"fullmesh", TOPOLOGY_FULL_MESH},
    {"full_mesh", TOPOLOGY_FULL_MESH}, {"crossbar", TOPOLOGY_CROSSBAR},
    {"hypercube", TOPOLOGY_HYPERCUBE}, {"hcube", TOPOLOGY_HYPERCUBE},
    {"torus", TOPOLOGY_TORUS},         {"ring", TOPOLOGY_TORUS},
    {"mesh", TOPOLOGY_MESH},           {"bus", TOPOLOGY_BUS},
};

/* The number that begins at `text`. One beyond INT_MAX becomes INT_MAX, which size_fits refuses. */
static int number_at(const char *text, char **end)
{
    errno = 0;
    long x = strtol(text, end, 10);
    return errno || x > INT_MAX ? INT_MAX : (int)x;
}

/* the numbers in `text`, whatever stands between them */
static int numbers_in(const char *text, int *number, int most)
{
    int n = 0;
    while (*text && n < most) {
        if (isdigit((unsigned char)*text)) {
            char *end;
            number[n++] = number_at(text, &end);
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
        radix[n++] = number_at(text, &end);
        text = end + (*end == 'x' && isdigit((unsigned char)end[1]));
    }
    int times = 1;
    if (by_power && n == 1 && numbers_in(text, &times, 1) == 1)
        for (n = 0; n < times && n < most; n++) radix[n] = radix[0];
    return n;
}

/* Nodes and links as real numbers: an int product of a stranger's numbers could overflow, a real
 * one only becomes large.
 *     torus, mesh   n = prod d_i             links <= 2 ndim n
 *     hypercube     n = 2^x                  links = x n
 *     fat tree      n = k^l                  links = 2 l n
 *     full mesh     n = x                    links = x^2
 *     dragonfly     groups g = a h + 1       n = p a g, links = a g (a + h) */
static void size_of(const struct topology_spec *s, double *node, double *link)
{
    double x = s->dims[0], y = s->ndim > 1 ? s->dims[1] : 1, z = s->ndim > 2 ? s->dims[2] : 1;
    *node = x;
    *link = x;
    if (s->family == TOPOLOGY_TORUS || s->family == TOPOLOGY_MESH) {
        for (int d = 1; d < s->ndim; d++) *node *= s->dims[d];
        *link = 2 * s->ndim * *node;
    } else if (s->family == TOPOLOGY_HYPERCUBE) {
        *node = exp2(x);
        *link = x * *node;
    } else if (s->family == TOPOLOGY_FAT_TREE) {
        *node = pow(x, y);
        *link = 2 * y * *node;
    } else if (s->family == TOPOLOGY_FULL_MESH) {
        *link = x * x;
    } else if (s->family == TOPOLOGY_DRAGONFLY) {
        *node = x * y * (y * z + 1);
        *link = y * (y * z + 1) * (y + z);
    }
}

/* Refuse before anything is allocated. The fourth number of a dragonfly is set by this program
 * and may be 0. */
static bool size_fits(const char *name, const struct topology_spec *s, struct err *e)
{
    double node, link;
    size_of(s, &node, &link);
    for (int d = 0; d < s->ndim; d++)
        if (s->dims[d] < 1 && !(s->family == TOPOLOGY_DRAGONFLY && d == 3))
            return err_set(e, ERR_DATA, "topology '%s': size %d; expected 1 or more", name,
                           s->dims[d]);
    if (node <= NETCHECK_MOST_NODES && link <= NETCHECK_MOST_LINKS) return true;
    return err_set(e, ERR_DATA,
                   "topology '%s' has %.4g nodes and %.4g links; expected at most %d and %d", name,
                   node, link, NETCHECK_MOST_NODES, NETCHECK_MOST_LINKS);
}

/* A name almost like one of ours is a spelling mistake (ERR_DATA); any other is a network that
 * this program does not have (ERR_UNAVAILABLE), and only that case is left out. */
static bool unknown_family(const char *name, struct err *e)
{
    const char *word[sizeof families / sizeof *families];
    char start[64];
    for (size_t i = 0; i < sizeof families / sizeof *families; i++) word[i] = families[i].word;
    /* The family's name ends where the numbers begin. */
    snprintf(start, sizeof start, "%.*s", (int)strcspn(name, "0123456789_"), name);
    const char *near = text_nearest(start, word, sizeof families / sizeof *families);
    if (near)
        return err_set(e, ERR_DATA, "unknown topology '%.64s'; did you mean '%s'?", name, near);
    return err_set(e, ERR_UNAVAILABLE, "topology '%.64s' is not supported", name);
}

/* Words in the names of networks whose routes depend on the load. Routes of this program do not. */
static const char *adaptive_word(const char *name)
{
    static const char *const word[] = {"ugal", "adaptive", "adapt", "anca"};
    for (size_t i = 0; i < sizeof word / sizeof *word; i++)
        if (strstr(name, word[i])) return word[i];
    return NULL;
}

bool netcheck_topology(const char *name, int tie, struct topology_spec *s, struct err *e)
{
    /* Ties of the shortest way around a ring: as asked, and random on the reference's own torus. */
    *s = (struct topology_spec){.nodes_per_router = 1, .processors_per_node = 1};
    bool random = tie == 1 || (tie < 0 && strstr(name, "native"));
    s->tie = random ? TIE_RANDOM : tie == 2 ? TIE_PARITY : TIE_POSITIVE;
    /* families[] has the longer words first: "fullmesh" before "mesh", "hypercube" before
     * "hcube". */
    const char *found = NULL;
    for (size_t i = 0; !found && i < sizeof families / sizeof *families; i++) {
        found = strstr(name, families[i].word);
        s->family = families[i].family;
    }
    if (!found) return unknown_family(name, e);
    if (adaptive_word(name))
        return err_set(e, ERR_UNAVAILABLE, "adaptive routing ('%s') is not supported",
                       adaptive_word(name));
    bool grid = s->family == TOPOLOGY_TORUS || s->family == TOPOLOGY_MESH;
    /* Grids are "8x8" or "k8n2"; the other families are numbers with letters between them. */
    s->ndim = (grid ? radices_in : numbers_in)(found, s->dims, MACHINE_MAX_DIMS);
    if (s->ndim == 0)
        /* The numbers may stand before the family, "8x8 torus": then look from the beginning. */
        s->ndim =
            (grid ? radices_in : numbers_in)(name, s->dims, MACHINE_MAX_DIMS); /* "8x8 torus" */
    int needed = s->family == TOPOLOGY_FAT_TREE ? 2 : s->family == TOPOLOGY_DRAGONFLY ? 3 : 1;
    if (s->ndim < needed)
        return err_set(e, ERR_DATA, "topology '%s': its numbers are missing", name);
    if (s->family == TOPOLOGY_DRAGONFLY)
        s->dims[3] = 0; /* what follows p, a and h is the number of nodes */
    if (!size_fits(name, s, e)) return false;
    if (strstr(name, "valiant")) s->routing = ROUTE_VALIANT;
    if (s->family == TOPOLOGY_FAT_TREE)
        s->routing = ROUTE_VALIANT; /* the reference's way up is random */
    return true;
}

/* The reference's router. Its pipeline takes 3 cycles (switch allocation, traversal, link) or 5
 * with routing and allocation of channels in front, each one cycle. */
struct machine_spec netcheck_machine(const struct topology_spec *s, int vcs, int buffer,
                                     int packet_flits, int head_cycles)
{
    const double cycle = 1e-9;
    struct machine_spec m = {.name = "reference", .topology = *s};
    m.network = (struct network_spec){
        .link_bandwidth = NETCHECK_FLIT_BYTES / cycle,
        .hop_latency = head_cycles * cycle,
        .end_latency = 2 * cycle,
        .credit_latency = 2 * cycle,
        .routing_latency = head_cycles > 3 ? cycle : 0,
        .vc_allocation_latency = head_cycles > 4 ? cycle : 0,
        .flit_bytes = NETCHECK_FLIT_BYTES,
        .packet_bytes = (int64_t)packet_flits * NETCHECK_FLIT_BYTES,
        .virtual_channels = vcs,
        .buffer_flits = buffer,
        .arbitration = ARBITRATION_ROUND_ROBIN,
    };
    /* Every message is eager: the reference knows no rendezvous. */
    m.software.eager_bytes = -1;
    return m;
}

/* ---- lists ---- */

/* The arrays of a list of n messages, by their own arena. */
static void traffic_take(struct traffic *q, int n, struct arena *a)
{
    *q = (struct traffic){.nmessage = n};
    q->src = TAKE(a, n + 1, int);
    q->dst = TAKE(a, n + 1, int);
    q->bytes = TAKE(a, n + 1, int64_t);
    q->time = TAKE(a, n + 1, sim_ps);
}

/* Each node sends to i + d (mod n), to i + d where that is a node, or to i xor d. */
bool netcheck_step(const char *pattern, int distance, int nnode, int flits, struct arena *a,
                   struct traffic *q, struct err *e)
{
    bool shift = strcmp(pattern, "shift") == 0, trunc = strcmp(pattern, "trunc") == 0;
    if (!shift && !trunc && strcmp(pattern, "xor") != 0)
        return err_set(e, ERR_DATA,
                       "unknown pattern '%.64s' of a step; expected shift, trunc or xor", pattern);
    traffic_take(q, nnode, a);
    q->nmessage = 0;
    for (int i = 0; i < nnode; i++) {
        /* 64 bits: i + distance may pass INT_MAX. */
        int64_t far = (int64_t)i + distance, to = shift ? far % nnode : trunc ? far : i ^ distance;
        if (to >= nnode) continue;
        q->src[q->nmessage] = i;
        q->dst[q->nmessage] = (int)to;
        q->bytes[q->nmessage++] = (int64_t)flits * NETCHECK_FLIT_BYTES;
    }
    return true;
}

/* ---- random loads ---- */

enum rule {
    UNIFORM,
    BIT_COMPLEMENT,
    BIT_REVERSE,
    TRANSPOSE,
    SHUFFLE,
    TORNADO,
    NEIGHBOUR,
    SHIFT,
    XOR,
    BAD_DRAGONFLY
};

struct pattern {
    enum rule rule;
    int nnode, bits; /* nodes; log2 of them */
    int radix, ndim; /* tornado, neighbour */
    int distance;    /* shift, xor */
    int group;       /* nodes per group of a dragonfly */
};

/* Names of the reference's patterns, and which of them permute bits of the node's number. */
static const struct {
    const char *word;
    enum rule rule;
    bool power_of_two;
} rules[] = {
    {"uniform", UNIFORM, false},
    {"bitcomp", BIT_COMPLEMENT, true},
    {"bitrev", BIT_REVERSE, true},
    {"transpose", TRANSPOSE, true},
    {"shuffle", SHUFFLE, true},
    {"tornado", TORNADO, false},
    {"neighbor", NEIGHBOUR, false},
    {"shift", SHIFT, false},
    {"xor", XOR, true},
    {"bad_dragon", BAD_DRAGONFLY, false},
};
enum { RULES = sizeof rules / sizeof *rules };

/* The word before the bracket or the numbers is the pattern's name. One almost like it is a
 * mistake (ERR_DATA), another is a pattern that this program does not have (ERR_UNAVAILABLE). */
static int rule_of(const char *text, struct err *e)
{
    const char *word[RULES];
    char start[64];
    int length = (int)strcspn(text, "(0123456789");
    snprintf(start, sizeof start, "%.*s", length, text);
    for (int i = 0; i < RULES; i++) {
        word[i] = rules[i].word;
        if (strcmp(start, word[i]) == 0) return i;
    }
    const char *near = text_nearest(start, word, RULES);
    if (near) err_set(e, ERR_DATA, "unknown pattern '%.64s'; did you mean '%s'?", text, near);
    else
        err_set(e, ERR_UNAVAILABLE,
                "pattern '%.64s' is not supported; known: uniform, bitcomp, bitrev, transpose, "
                "shuffle, tornado, neighbor, shift, xor, bad_dragon",
                text);
    return -1;
}

/* tornado(k,n) and neighbor(k,n) move digits to the base k: there must be k^n nodes */
static bool digits_read(const char *text, const struct topology *t, const int *number, int n,
                        struct pattern *p, struct err *e)
{
    bool given = n > 0,
         grid = t->spec->family == TOPOLOGY_TORUS || t->spec->family == TOPOLOGY_MESH;
    p->radix = given ? number[0] : t->spec->dims[0];
    p->ndim = n > 1 ? number[1] : t->spec->ndim;
    if (!given && !grid) return err_set(e, ERR_DATA, "pattern '%.64s': its radix is missing", text);
    if (p->radix >= 2 && p->ndim >= 1 && p->ndim < 32 && pow(p->radix, p->ndim) == t->nnode)
        return true;
    return err_set(e, ERR_DATA, "pattern '%.64s': %d digits to the base %d do not number %d nodes",
                   text, p->ndim, p->radix, t->nnode);
}

/* A pattern with its numbers, checked against the network before anything is sent. */
static bool pattern_read(const char *text, const struct topology *t, struct pattern *p,
                         struct err *e)
{
    int number[2] = {0, 0}, n = numbers_in(text, number, 2), found = rule_of(text, e);
    if (found < 0) return false;
    *p = (struct pattern){.rule = rules[found].rule, .nnode = t->nnode, .distance = number[0]};
    /* bits = ceil(log2 nnode); a pattern of bits needs it exact. */
    while (p->bits < 30 && 1 << p->bits < t->nnode) p->bits++;
    if (rules[found].power_of_two && 1 << p->bits != t->nnode)
        return err_set(e, ERR_DATA, "pattern '%.64s' needs 2^n nodes, not %d", text, t->nnode);
    if (p->rule == TORNADO || p->rule == NEIGHBOUR) return digits_read(text, t, number, n, p, e);
    bool far = p->rule == SHIFT || p->rule == XOR;
    if (far && n < 1) return err_set(e, ERR_DATA, "pattern '%.64s': its distance is missing", text);
    if (far && p->distance >= t->nnode)
        return err_set(e, ERR_DATA, "pattern '%.64s': expected a distance below the %d nodes", text,
                       t->nnode);
    /* A dragonfly's group has a routers with p nodes each. */
    if (p->rule == BAD_DRAGONFLY) p->group = t->spec->dims[0] * t->spec->dims[1];
    if (p->rule == BAD_DRAGONFLY && t->spec->family != TOPOLOGY_DRAGONFLY)
        return err_set(e, ERR_DATA, "pattern '%.64s' needs a dragonfly", text);
    return true;
}

/* Every coordinate of i moved up by `step` around its ring; i is written to the base `radix`. */
static int digits_moved(const struct pattern *p, int i, int step)
{
    int to = 0, stride = 1;
    for (int d = 0; d < p->ndim; d++, stride *= p->radix)
        to += (i / stride + step) % p->radix * stride;
    return to;
}

static int bits_reversed(int i, int bits)
{
    int to = 0;
    for (int b = 0; b < bits; b++) to |= (i >> b & 1) << (bits - 1 - b);
    return to;
}

/* Where node i sends to; definitions of Dally and Towles, Principles and Practices of
 * Interconnection Networks, section 3.2. */
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
        /* Half way around, less one: the worst case of minimal routing on a ring. */
        return digits_moved(p, i, (p->radix + 1) / 2 - 1);
    case NEIGHBOUR:
        return digits_moved(p, i, 1);
    case SHIFT:
        return (i + p->distance) % p->nnode;
    case XOR:
        return i ^ p->distance;
    case BAD_DRAGONFLY:
        /* A random node of the next group: all of a group's messages share its one link there. */
        return ((i / p->group + 1) * p->group) % p->nnode +
               (int)random_below(r, (uint64_t)p->group);
    }
    CHECK(false);
    return 0;
}

/* Cycles until the next arrival (>= 1), when each cycle has one with probability prob:
 * geometric, by inversion of u uniform in [0, 1). log1p keeps small probabilities exact. */
static double geometric(struct random *r, double prob)
{
    if (prob >= 1) return 1;
    double u = random_uniform(r, 0, 1);
    return floor(log1p(-u) / log1p(-prob)) + 1;
}

bool netcheck_load(const char *pattern, const struct topology *t, int flits, double load,
                   int cycles, uint64_t seed, struct arena *a, struct traffic *q, struct err *e)
{
    struct pattern p = {0};
    if (!pattern_read(pattern, t, &p, e)) return false;
    if (flits < 1 || !(load > 0) || load > 1 || cycles < 1)
        return err_set(
            e, ERR_DATA,
            "load %g with packets of %d flits for %d cycles; expected a load above 0 and up to 1, "
            "packets of at least 1 flit and at least 1 cycle",
            load, flits, cycles);
    /* A load counts flits, an arrival is a packet. */
    double prob = load / flits;
    double expected = prob * cycles * t->nnode;
    if (expected > NETCHECK_MOST_MESSAGES)
        return err_set(e, ERR_DATA,
                       "load %g for %d cycles on %d nodes is %.3g messages; expected at most %d",
                       load, cycles, t->nnode, expected, NETCHECK_MOST_MESSAGES);
    /* Room for the mean and eight standard deviations (n p (1 - p) < expected): a list that
     * needs more would be cut, which no seed is likely to show. */
    int most = (int)(expected + 8 * sqrt(expected) + 64), n = 0;
    traffic_take(q, most, a);
    /* Each node has a random stream of its own, so that its messages do not depend on the other
     * nodes. */
    for (int i = 0; i < t->nnode; i++) {
        struct random r = random_make(seed, 0x6c6f6164, (uint64_t)i); /* "load" */
        for (double at = geometric(&r, prob) - 1; at < cycles && n < most;
             at += geometric(&r, prob), n++) {
            q->src[n] = i;
            q->dst[n] = destination(&p, i, &r);
            q->bytes[n] = (int64_t)flits * NETCHECK_FLIT_BYTES;
            q->time[n] = (sim_ps)at * NETCHECK_CYCLE_PS;
        }
    }
    q->nmessage = n;
    return true;
}

double netcheck_channel_load(const char *pattern, const struct topology *t, struct arena *a,
                             struct err *e)
{
    struct pattern p;
    if (!pattern_read(pattern, t, &p, e)) return -1;
    /* All routes of all pairs are followed: only where they are few and do not depend on the
     * load or on chance. */
    if (t->nnode > MOST_ROUTED_NODES || !t->fixed_routes || p.rule == BAD_DRAGONFLY) return 0;
    struct arena_mark mark = arena_mark(a);
    double *load = TAKE(a, t->nlink + 1, double), most = 0;
    struct hop *route = TAKE(a, t->max_hops + 2, struct hop);
    struct random r = random_make(0, 0, 0);
    int per_source = p.rule == UNIFORM ? t->nnode : 1;
    /* Each source sends one flit per cycle, spread over its destinations. */
    for (int i = 0; i < t->nnode; i++)
        for (int k = 0; k < per_source; k++) {
            int to = p.rule == UNIFORM ? k : destination(&p, i, &r),
                n = topology_route(t, i, to, 0, route);
            for (int h = 0; h < n; h++) load[route[h].link] += 1.0 / per_source;
        }
    for (int l = 0; l < t->nlink; l++) most = fmax(most, load[l]);
    arena_release(a, mark);
    return most;
}

double netcheck_channel_cycles(const struct topology *t, const struct traffic *q, sim_ps first,
                               struct arena *a)
{
    if (t->spec->family != TOPOLOGY_DRAGONFLY) return 0;
    int routers = t->spec->dims[1];
    double sum = 0;
    struct arena_mark mark = arena_mark(a);
    struct hop *route = TAKE(a, t->max_hops + 2, struct hop);
    int n = 0, from, to, port;
    for (int m = 0; m < q->nmessage; m++) {
        if (q->time[m] < first) continue;
        /* The same random number as in the run: the message's number chooses among routes. */
        int hops = topology_route(t, q->src[m], q->dst[m], (uint64_t)m, route);
        n++;
        for (int h = 0; h < hops; h++) {
            topology_link_ends(t, route[h].link, &from, &to, &port);
            /* A group has `routers` routers, numbered group by group: the same quotient is the
             * same group. One cycle of the channel is in the level's latency already. */
            sum += from / routers == to / routers ? LOCAL_CHANNEL - 1 : GLOBAL_CHANNEL - 1;
        }
    }
    arena_release(a, mark);
    return n > 0 ? sum / n : 0;
}
