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
#include "base/text.h"
#include "machine/topology.h"
#include "net/pattern.h"

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
        .allocator_iterations = 1,
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

bool netcheck_load(const char *pattern, const struct topology *t, int flits, double load,
                   int cycles, uint64_t seed, struct arena *a, struct traffic *q, struct err *e)
{
    struct pattern p;
    const struct pattern_load l = {.load = load,
                                   .flits = flits,
                                   .bytes = (int64_t)flits * NETCHECK_FLIT_BYTES,
                                   .cycle_ps = NETCHECK_CYCLE_PS,
                                   .cycles = cycles,
                                   .seed = seed,
                                   .most = NETCHECK_MOST_MESSAGES};
    return pattern_read(&p, pattern, t, a, e) && pattern_traffic(&p, &l, a, q, e);
}

double netcheck_channel_load(const char *pattern, const struct topology *t, struct arena *a,
                             struct err *e)
{
    struct pattern p;
    if (!pattern_read(&p, pattern, t, a, e)) return -1;
    /* All routes of all pairs are followed: only where they are few and do not depend on the
     * load or on chance. */
    if (t->nnode > MOST_ROUTED_NODES || !t->fixed_routes || p.rule == PATTERN_BAD_GROUP) return 0;
    return pattern_channel_load(&p, t, 1, 1, a);
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
