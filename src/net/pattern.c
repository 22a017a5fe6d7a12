/* pattern.c - traffic patterns by name, their messages by chance, and the load of their links.
 *
 * The reference series of docs/network.md and the curves of `mimdsim load` are both made here, so
 * that a pattern's name means one thing. */
#include "net/pattern.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"

/* Routes that pattern_channel_load follows, digits, and numbers of a pattern, at most. */
enum { MOST_ROUTES = 1 << 24, MOST_DIGITS = 31, MOST_NUMBERS = 16 };

/* Every name, how many numbers stand behind it, with an example for messages, and whether it
 * permutes bits of the node's number. The first of a rule is the one that messages list. */
static const struct {
    const char *word;
    enum pattern_rule rule;
    int least, most;
    const char *example;
    bool power_of_two, alias;
} rules[] = {
    {"uniform", PATTERN_UNIFORM, 0, 0, "uniform", false, false},
    {"bitcomp", PATTERN_BIT_COMPLEMENT, 0, 0, "bitcomp", true, false},
    {"bitrev", PATTERN_BIT_REVERSE, 0, 0, "bitrev", true, false},
    {"transpose", PATTERN_TRANSPOSE, 0, 0, "transpose", true, false},
    {"shuffle", PATTERN_SHUFFLE, 0, 0, "shuffle", true, false},
    {"tornado", PATTERN_TORNADO, 0, 2, "tornado(8,2) or tornado", false, false},
    {"neighbor", PATTERN_NEIGHBOUR, 0, 2, "neighbor(8,2) or neighbor", false, false},
    {"shift", PATTERN_SHIFT, 1, 1, "shift(1)", false, false},
    {"xor", PATTERN_XOR, 1, 1, "xor(1)", true, false},
    {"randperm", PATTERN_PERMUTATION, 0, 1, "randperm(1)", false, false},
    {"bad_dragon", PATTERN_BAD_GROUP, 0, 0, "bad_dragon", false, false},
    {"badrandom", PATTERN_BAD_GROUP, 0, 0, "badrandom", false, true},
    {"hotspot", PATTERN_HOT_SPOT, 0, MOST_NUMBERS, "hotspot(0,5)", false, false},
};
enum { RULES = sizeof rules / sizeof *rules };

/* ---- names */

/* How many numbers are in `text`, whatever stands between them, and the first `most` of them. One
 * beyond INT_MAX becomes INT_MAX, which every check of a range refuses. */
static int numbers_in(const char *text, int *number, int most)
{
    int n = 0;
    while (*text) {
        char *end;
        if (!isdigit((unsigned char)*text)) {
            text++;
            continue;
        }
        errno = 0;
        long x = strtol(text, &end, 10);
        if (n < most) number[n] = errno || x > INT_MAX ? INT_MAX : (int)x;
        n++;
        text = end;
    }
    return n;
}

/* Nothing but whole numbers behind the name, which brackets may enclose: a sign would be passed
 * over like what stands between them. */
static bool numbers_are_whole(const char *text, struct err *e)
{
    const char *rest = text + strcspn(text, "(0123456789");
    const size_t length = strlen(rest);
    const bool closed = length > 0 && rest[length - 1] == ')';
    return (strspn(rest, "0123456789,_(){} ") == length && (rest[0] == '(') == closed) ||
           err_set(e, ERR_DATA,
                   "pattern '%.64s': expected whole numbers in brackets, such as (8,2)", text);
}

/* As many numbers as the pattern has a use for, in one list: BookSim's second list of a hotspot is
 * of rates. */
static bool numbers_are_used(const char *text, int n, int rule, struct err *e)
{
    const int least = rules[rule].least, most = rules[rule].most;
    const char *list = strchr(text, '{');
    if (list && strchr(list + 1, '{'))
        return err_set(e, ERR_DATA,
                       "pattern '%.64s': expected one list of nodes; one is hit as often as "
                       "it is named",
                       text);
    if (n >= least && n <= most) return true;
    char expected[48] = "none";
    if (most > least) snprintf(expected, sizeof expected, "%d to %d", least, most);
    else if (most > 0) snprintf(expected, sizeof expected, "%d", most);
    return err_set(e, ERR_DATA, "pattern '%.64s': %d number%s; expected %s, as in %s", text, n,
                   n == 1 ? "" : "s", expected, rules[rule].example);
}

/* All names, for a message. */
static void list_known(char *out, size_t size)
{
    size_t at = 0;
    for (int i = 0; i < RULES && at < size; i++)
        if (!rules[i].alias)
            at += (size_t)snprintf(out + at, size - at, "%s%s", i > 0 ? ", " : "", rules[i].word);
}

/* The word before the bracket or the numbers is the pattern's name. One almost like it is a
 * mistake (ERR_DATA), another is a pattern that this program does not have (ERR_UNAVAILABLE). */
static int rule_of(const char *text, struct err *e)
{
    const char *word[RULES];
    char start[64], known[192];
    int length = (int)strcspn(text, "(0123456789");
    snprintf(start, sizeof start, "%.*s", length, text);
    for (int i = 0; i < RULES; i++) {
        word[i] = rules[i].word;
        if (strcmp(start, word[i]) == 0) return i;
    }
    const char *near = text_nearest(start, word, RULES);
    list_known(known, sizeof known);
    if (near) err_set(e, ERR_DATA, "unknown pattern '%.64s'; did you mean '%s'?", text, near);
    else err_set(e, ERR_UNAVAILABLE, "pattern '%.64s' is not supported; known: %s", text, known);
    return -1;
}

/* ---- numbers of a pattern against the network */

/* tornado(k,n) and neighbor(k,n) move digits to the base k: there must be k^n nodes. Without
 * numbers they move the coordinates of a grid's router, or all nodes as one ring. */
static bool digits_read(struct pattern *p, const char *text, const struct topology *t,
                        const int *number, int n, struct arena *a, struct err *e)
{
    const struct topology_spec *s = t->spec;
    const bool given = n > 0, grid = s->family == TOPOLOGY_TORUS || s->family == TOPOLOGY_MESH;
    const int own = grid || given ? s->ndim : 1, ndim = n > 1 ? number[1] : own;
    int *radix = TAKE(a, MOST_DIGITS, int);
    double nodes = given || !grid ? 1 : s->nodes_per_router;
    p->below = (int)nodes;
    p->ndim = ndim;
    p->radix = radix;
    for (int d = 0; d < ndim && d < MOST_DIGITS; d++) {
        radix[d] = given ? number[0] : grid ? s->dims[d] : t->nnode;
        nodes *= radix[d];
    }
    const bool fit = !given || (number[0] >= 2 && ndim >= 1 && ndim <= MOST_DIGITS);
    return (fit && nodes == t->nnode) ||
           err_set(e, ERR_DATA, "pattern '%.64s': %d digits to the base %d do not number %d nodes",
                   text, ndim, number[0], t->nnode);
}

/* shift(d) and xor(d). */
static bool distance_read(struct pattern *p, const char *text, struct err *e)
{
    if (p->distance < p->nnode) return true;
    return err_set(e, ERR_DATA, "pattern '%.64s': expected a distance below the %d nodes", text,
                   p->nnode);
}

/* A dragonfly's group has a routers with p nodes each, a dragonfly+'s l leaves. */
static bool group_read(struct pattern *p, const char *text, const struct topology *t, struct err *e)
{
    if (t->spec->family != TOPOLOGY_DRAGONFLY && t->spec->family != TOPOLOGY_DRAGONFLY_PLUS)
        return err_set(e, ERR_DATA, "pattern '%.64s' needs a dragonfly", text);
    p->group = t->spec->dims[0] * t->spec->dims[1];
    return true;
}

/* hotspot(d,...): a node may be named several times, to be hit as often. */
static bool spots_read(struct pattern *p, const char *text, const int *number, int n,
                       struct arena *a, struct err *e)
{
    int *spot = TAKE(a, MOST_NUMBERS, int);
    /* Node 0 if none is named. */
    p->nspot = n > 0 ? n : 1;
    p->spot = spot;
    for (int i = 0; i < n; i++) {
        spot[i] = number[i];
        if (number[i] >= p->nnode)
            return err_set(e, ERR_DATA, "pattern '%.64s': expected nodes below %d", text, p->nnode);
    }
    return true;
}

/* Every order of the nodes is equally likely (Fisher and Yates; Knuth, TAOCP 2, 3.4.2 P). */
static void permutation_draw(struct pattern *p, uint64_t seed, struct arena *a)
{
    int *to = TAKE(a, p->nnode, int);
    struct random r = random_make(seed, 0x7065726d, 0); /* "perm" */
    for (int i = 0; i < p->nnode; i++) to[i] = i;
    for (int i = p->nnode - 1; i > 0; i--) {
        int j = (int)random_below(&r, (uint64_t)i + 1), kept = to[i];
        to[i] = to[j];
        to[j] = kept;
    }
    p->permutation = to;
}

bool pattern_read(struct pattern *p, const char *text, const struct topology *t, struct arena *a,
                  struct err *e)
{
    int number[MOST_NUMBERS] = {0};
    const int n = numbers_in(text, number, MOST_NUMBERS), found = rule_of(text, e);
    if (found < 0 || !numbers_are_whole(text, e) || !numbers_are_used(text, n, found, e))
        return false;
    *p = (struct pattern){.rule = rules[found].rule, .nnode = t->nnode, .distance = number[0]};
    /* bits = ceil(log2 nnode); a pattern of bits needs it exact. */
    while (p->bits < 30 && 1 << p->bits < t->nnode) p->bits++;
    if (rules[found].power_of_two && 1 << p->bits != t->nnode)
        return err_set(e, ERR_DATA, "pattern '%.64s' needs 2^n nodes, not %d", text, t->nnode);
    switch (p->rule) {
    case PATTERN_TORNADO:
    case PATTERN_NEIGHBOUR:
        return digits_read(p, text, t, number, n, a, e);
    case PATTERN_SHIFT:
    case PATTERN_XOR:
        return distance_read(p, text, e);
    case PATTERN_BAD_GROUP:
        return group_read(p, text, t, e);
    case PATTERN_HOT_SPOT:
        return spots_read(p, text, number, n, a, e);
    case PATTERN_PERMUTATION:
        permutation_draw(p, (uint64_t)number[0], a);
        return true;
    default:
        return true;
    }
}

/* ---- destinations */

/* Every digit of i moved up around its ring: by 1, or half way around, less one, which is the worst
 * case of minimal routing on a ring. */
static int digits_moved(const struct pattern *p, int i)
{
    int to = i % p->below, stride = p->below;
    for (int d = 0; d < p->ndim; stride *= p->radix[d++]) {
        const int step = p->rule == PATTERN_TORNADO ? (p->radix[d] + 1) / 2 - 1 : 1;
        to += (int)((i / stride % p->radix[d] + (int64_t)step) % p->radix[d]) * stride;
    }
    return to;
}

static int bits_reversed(int i, int bits)
{
    int to = 0;
    for (int b = 0; b < bits; b++) to |= (i >> b & 1) << (bits - 1 - b);
    return to;
}

int pattern_destination(const struct pattern *p, int src, struct random *r)
{
    int mask = p->nnode - 1, half = p->bits / 2;
    switch (p->rule) {
    case PATTERN_UNIFORM:
        return (int)random_below(r, (uint64_t)p->nnode);
    case PATTERN_BIT_COMPLEMENT:
        return ~src & mask;
    case PATTERN_BIT_REVERSE:
        return bits_reversed(src, p->bits);
    case PATTERN_TRANSPOSE:
        return (src >> half | src << half) & mask;
    case PATTERN_SHUFFLE:
        return p->bits > 0 ? (src << 1 & mask) | src >> (p->bits - 1) : 0;
    case PATTERN_TORNADO:
    case PATTERN_NEIGHBOUR:
        return digits_moved(p, src);
    case PATTERN_SHIFT:
        return (int)(((int64_t)src + p->distance) % p->nnode);
    case PATTERN_XOR:
        return src ^ p->distance;
    case PATTERN_PERMUTATION:
        return p->permutation[src];
    case PATTERN_BAD_GROUP:
        /* A random node of the next group: all of a group's messages share its one link there. */
        return ((src / p->group + 1) * p->group) % p->nnode +
               (int)random_below(r, (uint64_t)p->group);
    case PATTERN_HOT_SPOT:
        return p->spot[random_below(r, (uint64_t)p->nspot)];
    }
    CHECK(false);
    return 0;
}

bool pattern_is_random(const struct pattern *p)
{
    return p->rule == PATTERN_UNIFORM || p->rule == PATTERN_BAD_GROUP ||
           p->rule == PATTERN_HOT_SPOT;
}

/* ---- random loads */

/* Cycles until the next arrival (>= 1), when each cycle has one with probability prob:
 * geometric, by inversion of u uniform in [0, 1). log1p keeps small probabilities exact. */
static double geometric(struct random *r, double prob)
{
    if (prob >= 1) return 1;
    double u = random_uniform(r, 0, 1);
    return floor(log1p(-u) / log1p(-prob)) + 1;
}

/* The arrays of a list of n messages, by their own arena. */
static void traffic_take(struct traffic *q, int n, struct arena *a)
{
    *q = (struct traffic){.nmessage = n};
    q->src = TAKE_FULL(a, n + 1, int, true);
    q->dst = TAKE_FULL(a, n + 1, int, true);
    q->bytes = TAKE_FULL(a, n + 1, int64_t, true);
    q->time = TAKE_FULL(a, n + 1, sim_ps, true);
}

bool pattern_traffic(const struct pattern *p, const struct pattern_load *l, struct arena *a,
                     struct traffic *q, struct err *e)
{
    if (l->flits < 1 || !(l->load > 0) || l->load > 1 || l->cycles < 1)
        return err_set(
            e, ERR_DATA,
            "load %g with packets of %d flits for %lld cycles; expected a load above 0 and up to "
            "1, packets of at least 1 flit and at least 1 cycle",
            l->load, l->flits, (long long)l->cycles);
    /* A load counts flits, an arrival is a packet. */
    double prob = l->load / l->flits, expected = prob * (double)l->cycles * p->nnode;
    if (expected > l->most)
        return err_set(e, ERR_DATA,
                       "load %g for %lld cycles on %d nodes is %.3g messages; expected at most %d",
                       l->load, (long long)l->cycles, p->nnode, expected, l->most);
    /* Room for the mean and eight standard deviations (n p (1 - p) < expected): a list that
     * needs more would be cut, which no seed is likely to show. */
    int most = (int)(expected + 8 * sqrt(expected) + 64), n = 0;
    traffic_take(q, most, a);
    /* Each node has a random stream of its own, so that its messages do not depend on the other
     * nodes. */
    for (int i = 0; i < p->nnode; i++) {
        struct random r = random_make(l->seed, 0x6c6f6164, (uint64_t)i); /* "load" */
        for (double at = geometric(&r, prob) - 1; at < (double)l->cycles && n < most;
             at += geometric(&r, prob), n++) {
            q->src[n] = i;
            q->dst[n] = pattern_destination(p, i, &r);
            q->bytes[n] = l->bytes;
            q->time[n] = (sim_ps)(at * l->cycle_ps);
        }
    }
    q->nmessage = n;
    return true;
}

/* ---- the most loaded link */

double pattern_channel_load(const struct pattern *p, const struct topology *t, int draws,
                            double link_bandwidth, struct arena *a)
{
    /* How many messages of a source stand for all of them: every destination of a uniform pattern
     * is taken once, chance is averaged, a permutation with one route needs one. */
    bool every = p->rule == PATTERN_UNIFORM && t->fixed_routes;
    int each = every ? t->nnode : pattern_is_random(p) || !t->fixed_routes ? draws : 1;
    if (t->nlink == 0 || (int64_t)each * t->nnode > MOST_ROUTES) return 0;
    struct arena_mark mark = arena_mark(a);
    double *load = TAKE(a, t->nlink, double), most = 0;
    struct hop *route = TAKE(a, t->max_hops + 2, struct hop);
    struct random r = random_make(0, 0, 0);
    /* Each source sends one flit per cycle, spread over its messages. */
    for (int i = 0; i < t->nnode; i++)
        for (int k = 0; k < each; k++) {
            int to = every ? k : pattern_destination(p, i, &r),
                n = topology_route(t, i, to, t->fixed_routes ? 0 : random_u64(&r), route);
            for (int h = 0; h < n; h++) load[route[h].link] += 1.0 / each;
        }
    for (int l = 0; l < t->nlink; l++)
        most = fmax(most, load[l] / topology_link_bandwidth(t, l, link_bandwidth));
    arena_release(a, mark);
    return most;
}
