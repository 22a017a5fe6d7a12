/* topology_partition.c - a narrow cut into two halves, by moving routers from several beginnings.
 *
 * Beginnings are the order of numbers, which cuts a grid across its last dimension and a network of
 * groups between groups, orders by distance from a few routers, and orders by chance. From each,
 * passes of Fiduccia and Mattheyses: every router is moved once, the one that saves most cables
 * first, and the best state on the way is kept, until a pass saves nothing. */
#include <string.h>

#include "base/random.h"
#include "machine/topology_measure.h"

enum {
    NEAR_STARTS = 6,    /* beginnings by distance */
    RANDOM_STARTS = 10, /* beginnings by chance */
    MOST_PASSES = 12,
    MOST_REFINED = 3000 /* routers; above, the beginnings are compared as they are */
};

struct cut {
    const struct topology *t;
    int n;
    const int *first, *to; /* topology_neighbours */
    int *weight;     /* (n) nodes on each router */
    int largest;     /* of the weights */
    bool *half;      /* (n) */
    int64_t balance; /* nodes of the second half less those of the first */
    int64_t size;    /* links from one half to the other */
    int *gain, *order, *moved;
    bool *locked;
};

/* The size and every router's gain of the present halves: a router's gain is how many of its links
 * cross less those that do not. */
static void weigh(struct cut *c)
{
    int64_t crossing = 0;
    c->balance = 0;
    for (int r = 0; r < c->n; r++) {
        c->gain[r] = 0;
        for (int i = c->first[r]; i < c->first[r + 1]; i++) {
            bool crosses = c->half[r] != c->half[c->to[i]];
            c->gain[r] += crosses ? 1 : -1;
            crossing += crosses;
        }
        c->balance += c->half[r] ? c->weight[r] : -c->weight[r];
    }
    c->size = crossing / 2;
}

/* The first half of the nodes in this order; routers without nodes follow what they are joined to
 * mostly, since they weigh nothing. */
static void begin(struct cut *c)
{
    int64_t all = 0, taken = 0;
    for (int r = 0; r < c->n; r++) all += c->weight[r];
    for (int i = 0; i < c->n; i++) {
        int r = c->order[i];
        c->half[r] = 2 * taken >= all;
        taken += c->weight[r];
    }
    for (int r = 0; r < c->n; r++) {
        if (c->weight[r] > 0) continue;
        int second = 0, degree = c->first[r + 1] - c->first[r];
        for (int i = c->first[r]; i < c->first[r + 1]; i++) second += c->half[c->to[i]];
        c->half[r] = 2 * second > degree;
    }
    weigh(c);
}

static void move(struct cut *c, int r)
{
    c->size -= c->gain[r];
    c->balance += c->half[r] ? -2 * c->weight[r] : 2 * c->weight[r];
    c->half[r] = !c->half[r];
    c->gain[r] = -c->gain[r];
    for (int i = c->first[r]; i < c->first[r + 1]; i++) {
        int s = c->to[i];
        c->gain[s] += c->half[s] == c->half[r] ? -2 : 2;
    }
}

static int64_t magnitude(int64_t x) { return x < 0 ? -x : x; }

/* The router whose move saves most and keeps the halves within one router of each other, or -1. */
static int best_move(const struct cut *c)
{
    int best = -1;
    for (int r = 0; r < c->n; r++) {
        if (c->locked[r] || (best >= 0 && c->gain[r] <= c->gain[best])) continue;
        int64_t then = c->balance + (c->half[r] ? -2 : 2) * (int64_t)c->weight[r];
        if (magnitude(then) <= 2 * (int64_t)c->largest) best = r;
    }
    return best;
}

/* Every router once; then back to where the cut was smallest with halves as equal as at the
 * beginning. Returns whether it became smaller. */
static bool pass(struct cut *c)
{
    int n = 0, kept = 0;
    int64_t least = c->size, equal = magnitude(c->balance);
    memset(c->locked, 0, (size_t)c->n * sizeof *c->locked);
    for (int r; (r = best_move(c)) >= 0;) {
        move(c, r);
        c->locked[r] = true;
        c->moved[n++] = r;
        if (magnitude(c->balance) <= equal && c->size < least) least = c->size, kept = n;
    }
    while (n > kept) move(c, c->moved[--n]);
    return kept > 0;
}

/* By distance from a router: what is near stays together. */
static void order_near(struct cut *c, int from)
{
    int head = 0, tail = 0;
    memset(c->locked, 0, (size_t)c->n * sizeof *c->locked);
    c->order[tail++] = from;
    c->locked[from] = true;
    while (head < tail) {
        int r = c->order[head++];
        for (int i = c->first[r]; i < c->first[r + 1]; i++) {
            if (c->locked[c->to[i]]) continue;
            c->locked[c->to[i]] = true;
            c->order[tail++] = c->to[i];
        }
    }
    /* What does not work is joined to nothing, and comes last. */
    for (int r = 0; r < c->n; r++)
        if (!c->locked[r]) c->order[tail++] = r;
}

static void order_randomly(struct cut *c, struct random *r)
{
    for (int i = 0; i < c->n; i++) c->order[i] = i;
    for (int i = c->n - 1; i > 0; i--) {
        int j = (int)random_below(r, (uint64_t)i + 1), other = c->order[j];
        c->order[j] = c->order[i];
        c->order[i] = other;
    }
}

/* Only routers with nodes weigh: switches above the leaves have none. */
static struct cut cut_make(const struct topology *t, struct arena *a)
{
    int n = t->nrouter;
    struct cut c = {.t = t, .n = n, .weight = TAKE(a, n, int), .half = TAKE(a, n, bool)};
    c.gain = TAKE(a, n, int);
    c.order = TAKE(a, n, int);
    c.moved = TAKE(a, n, int);
    c.locked = TAKE(a, n, bool);
    for (int i = 0; i < t->nnode; i++) {
        if (!topology_router_works(t, topology_router_of(t, i))) continue;
        int weight = ++c.weight[topology_router_of(t, i)];
        if (weight > c.largest) c.largest = weight;
    }
    const struct topology_neighbours near = topology_neighbours(t, a);
    c.first = near.first;
    c.to = near.to;
    return c;
}

int64_t topology_partition(const struct topology *t, bool *half, struct arena *a)
{
    struct arena_mark mark = arena_mark(a);
    struct cut c = cut_make(t, a);
    struct random r = random_make(1, 0x637574, 0); /* "cut" */
    int64_t best = -1, equal = 0;
    for (int start = 0; start < 1 + NEAR_STARTS + RANDOM_STARTS; start++) {
        if (start == 0)
            for (int i = 0; i < c.n; i++) c.order[i] = i;
        else if (start <= NEAR_STARTS)
            order_near(&c, (int)((int64_t)(start - 1) * c.n / NEAR_STARTS));
        else order_randomly(&c, &r);
        begin(&c);
        for (int i = 0; c.n <= MOST_REFINED && i < MOST_PASSES && pass(&c); i++) {
        }
        /* Halves as equal as can be come first: an uneven cut is easily narrower. */
        int64_t uneven = magnitude(c.balance);
        if (best >= 0 && (uneven > equal || (uneven == equal && c.size >= best))) continue;
        best = c.size;
        equal = uneven;
        memcpy(half, c.half, (size_t)c.n * sizeof *half);
    }
    arena_release(a, mark);
    return best;
}
