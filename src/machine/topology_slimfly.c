/* topology_slimfly.c - Slim Fly networks: the graphs of McKay, Miller and Siran of diameter 2.
 *
 * dims = {q}, a prime power q = 4 w + delta with delta -1, 0 or 1: 2 q^2 routers of (3 q - delta) /
 * 2 links (Besta and Hoefler, "Slim Fly: a cost effective low-diameter network topology", SC 2014;
 * Hafner 2004 for the sets X and X'). Over the field of q elements, with a primitive element z, the
 * routers are (0, x, y) and (1, m, c), numbered (s q + x) q + y, and joined when
 *
 *   (0, x, y) and (0, x, y'):  y - y' is in X        (1, m, c) and (1, m, c'):  c - c' is in X'
 *   (0, x, y) and (1, m, c):   y = m x + c
 *
 *   delta  1: X = {1, z^2, ..., z^(q-3)},  X' = {z, z^3, ..., z^(q-2)}
 *   delta  0: X = {1, z^2, ..., z^(q-2)},  X' = {z, z^3, ..., z^(q-1)}
 *   delta -1: X = {1, z^2, ..., z^(2w-2), z^(2w-1), z^(2w+1), ..., z^(4w-3)},
 *             X' = {z, z^3, ..., z^(2w-1), z^(2w), z^(2w+2), ..., z^(4w-2)}
 *
 * Routes are found by arithmetic: two routers that are not joined have a common neighbour, of which
 * the lowest-numbered one is taken. The class is the number of links behind.
 *
 * Links: by the router they leave, first to its q neighbours on the other side by their x or m,
 * then to those of its own line by their y or c. */
#include "base/check.h"
#include "machine/topology_internal.h"

/* 2 q^2 routers of about 1.5 q links have to be numbered in an int: q = 809 is the last. */
enum { SLIMFLY_MOST_Q = 800 };

struct slimfly {
    int q, delta;
    int near, leaving; /* neighbours on the own line, and all */
    int *add, *times;  /* (q x q) of the field */
    int *minus;        /* (q) -a */
    int *inverse;      /* (q) 1 / a, of 0: 0 */
    bool *joined[2];   /* (q) whether a difference is in X, X' */
    int *rank[2];      /* (q x q) [a q + b]: place of b among the neighbours of a on a line */
    int *neighbour[2]; /* (q x near) of a on a line of the side, rising */
};

/* ---- the field of q = p^n elements: polynomials over the integers mod p, as numbers in base p */

/* q = p^n, 0 where q is no power of a prime. */
static int prime_of(int q, int *n)
{
    int p = 2;
    while (p < q && q % p != 0) p++;
    for (*n = 0; q > 1 && q % p == 0; ++*n) q /= p;
    return q == 1 && *n > 0 ? p : 0;
}

static int sum_mod(int a, int b, int p)
{
    int sum = 0;
    for (int unit = 1; a > 0 || b > 0; unit *= p, a /= p, b /= p) sum += (a % p + b % p) % p * unit;
    return sum;
}

/* a times the polynomial x, where x^n = `rest`: shift by one digit, and put `rest` in for what
 * falls out, as often as its digit says. */
static int times_x(int a, int rest, int q, int p)
{
    int high = a / (q / p), product = a % (q / p) * p;
    while (high-- > 0) product = sum_mod(product, rest, p);
    return product;
}

/* Powers of x under x^n = rest: power[i] = x^i. Whether x is primitive, which makes the polynomial
 * irreducible too: its first q - 1 powers are all elements but 0. For n = 1 "x" is the number
 * `rest`. */
static bool primitive_powers(int rest, int q, int p, int n, int *power)
{
    power[0] = 1;
    for (int i = 1; i < q; i++) {
        power[i] = n == 1 ? power[i - 1] * rest % p : times_x(power[i - 1], rest, q, p);
        if (power[i] == 0) return false;
        if (power[i] == 1) return i == q - 1;
    }
    return false;
}

/* Sums digit by digit, products through logarithms. The least `rest` with primitive powers is
 * taken: the same network on every host. Every field has a primitive element. */
static void field_make(struct slimfly *g, int p, int n, int *power, struct arena *a)
{
    const int q = g->q, pairs = q * q; /* q is at most 800 */
    int rest = 1;
    int *log = TAKE(a, q, int);
    while (!primitive_powers(rest, q, p, n, power)) {
        rest++;
        CHECK(rest < q);
    }
    for (int i = 0; i < q - 1; i++) log[power[i]] = i;
    g->add = TAKE(a, pairs, int);
    g->times = TAKE(a, pairs, int);
    g->minus = TAKE(a, q, int);
    g->inverse = TAKE(a, q, int);
    for (int i = 0; i < q; i++)
        for (int j = 0; j < q; j++) {
            int sum = sum_mod(i, j, p);
            g->add[i * q + j] = sum;
            if (sum == 0) g->minus[i] = j;
            if (i > 0 && j > 0) g->times[i * q + j] = power[(log[i] + log[j]) % (q - 1)];
            if (g->times[i * q + j] == 1) g->inverse[i] = j;
        }
}

static int difference(const struct slimfly *g, int x, int y)
{
    return g->add[x * g->q + g->minus[y]];
}

static int product(const struct slimfly *g, int x, int y) { return g->times[x * g->q + y]; }

/* ---- the network */

/* X and X' of the header, by exponents of z: the lower half of the even or odd ones as they come;
 * with delta -1 the upper half has the other parity, which keeps -X = X. */
static void sets_make(struct slimfly *g, const int *power)
{
    int w = (g->q + 1) / 4;
    for (int i = 0; i < g->near; i++) {
        int own = 2 * i, other = 2 * i + 1;
        if (g->delta < 0 && i >= w) own = 2 * i - 1, other = 2 * i;
        g->joined[0][power[own % (g->q - 1)]] = true;
        g->joined[1][power[other % (g->q - 1)]] = true;
    }
}

/* Who is joined on a line, of both sides, in rising order, and the reverse. */
static void lines_make(struct slimfly *g, struct arena *a)
{
    const int q = g->q, pairs = q * q, joined = q * g->near;
    for (int side = 0; side < 2; side++) {
        g->rank[side] = TAKE(a, pairs, int);
        g->neighbour[side] = TAKE(a, joined, int);
        for (int x = 0; x < q; x++) {
            int n = 0;
            for (int y = 0; y < q; y++) {
                if (!g->joined[side][difference(g, y, x)]) continue;
                CHECK(n < g->near);
                g->neighbour[side][x * g->near + n] = y;
                g->rank[side][x * q + y] = n++;
            }
        }
    }
}

static bool slimfly_create(struct topology *t, struct arena *a, struct err *e)
{
    int q = t->spec->dims[0], n = 0;
    int p = q >= 3 && q <= SLIMFLY_MOST_Q ? prime_of(q, &n) : 0;
    if (p == 0 || q % 4 == 2)
        return err_set(e, ERR_CONFIG,
                       "topology slim-fly: q = %d; expected a prime power of 3 to %d, such as 3, "
                       "4, 5, 7, 8, 9, 11, 13, 16, 17, 19, 23, 25, 27",
                       q, SLIMFLY_MOST_Q);
    struct slimfly *g = TAKE(a, 1, struct slimfly);
    g->q = q;
    g->delta = q % 4 == 3 ? -1 : q % 4;
    g->near = (q - g->delta) / 2;
    g->leaving = q + g->near;
    int64_t nlink = 2 * (int64_t)q * q * g->leaving;
    if (nlink + 2 * (int64_t)q * q * t->spec->nodes_per_router > INT32_MAX / 2)
        return err_set(e, ERR_CONFIG,
                       "topology slim-fly: more nodes and links than can be numbered");
    g->joined[0] = TAKE(a, q, bool);
    g->joined[1] = TAKE(a, q, bool);
    int *power = TAKE(a, q, int);
    field_make(g, p, n, power, a);
    sets_make(g, power);
    lines_make(g, a);
    t->state = g;
    t->nrouter = 2 * q * q;
    t->nlink = (int)nlink;
    t->nport = g->leaving;
    /* The class is the link's place on the route: nobody waits for the class that he holds. */
    t->max_hops = 2;
    t->nclass = 2;
    return true;
}

/* Router (side, line, at); line is x or m, at is y or c. */
struct place {
    int side, line, at;
};

static struct place place_of(const struct slimfly *g, int router)
{
    return (struct place){router / (g->q * g->q), router / g->q % g->q, router % g->q};
}

/* Of a router: the `at` of its neighbour on line `line` of the other side, from y = m x + c. */
static int across(const struct slimfly *g, struct place p, int line)
{
    int mx = product(g, p.line, line);
    return p.side == 0 ? difference(g, p.at, mx) : g->add[p.at * g->q + mx];
}

static bool near(const struct slimfly *g, int side, int x, int y)
{
    return g->joined[side][difference(g, x, y)];
}

static bool adjacent(const struct slimfly *g, struct place p, struct place r)
{
    if (p.side != r.side) return across(g, p, r.line) == r.at;
    return p.line == r.line && near(g, p.side, p.at, r.at);
}

/* The lowest-numbered router that is joined to both, which are not joined. On one line of a side
 * it is a third of that line. On two lines of a side it is across: y - m x = y' - m x' has one m.
 * On two sides it is on p's or r's line, by whether the gap is in X or X', which are all but 0. */
static struct place between(const struct slimfly *g, struct place p, struct place r)
{
    if (p.side == r.side && p.line == r.line) {
        struct place third = p;
        for (int i = 0; i < g->near; i++) {
            third.at = g->neighbour[p.side][p.at * g->near + i];
            if (near(g, p.side, third.at, r.at)) break;
        }
        return third;
    }
    if (p.side == r.side) {
        int rise = difference(g, p.at, r.at), run = difference(g, p.line, r.line);
        int m = product(g, rise, g->inverse[run]);
        /* From the other side the equation is c = y - m x: the slope changes its sign. */
        if (p.side == 1) m = g->minus[m];
        return (struct place){1 - p.side, m, across(g, p, m)};
    }
    /* Side 0 has the lower numbers. */
    struct place low = p.side == 0 ? p : r, high = p.side == 0 ? r : p;
    struct place via = {0, low.line, across(g, high, low.line)};
    if (near(g, 0, low.at, via.at)) return via;
    return (struct place){1, high.line, across(g, low, high.line)};
}

/* Router and target are all that a route needs, beside the number of links behind. */
static void slimfly_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    (void)t;
    (void)choice;
    c->stage = 0;
}

/* The port by which a router is entered is the place of the one before among its neighbours. */
static int slot_of(const struct slimfly *g, struct place p, struct place to)
{
    return p.side != to.side ? to.line : g->q + g->rank[p.side][p.at * g->q + to.at];
}

static bool slimfly_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    const struct slimfly *g = t->state;
    if (c->router == c->target) return false;
    struct place p = place_of(g, c->router), r = place_of(g, c->target);
    struct place to = adjacent(g, p, r) ? r : between(g, p, r);
    h->link = c->router * g->leaving + slot_of(g, p, to);
    h->port = slot_of(g, to, p);
    h->vc_class = c->stage++;
    c->router = (to.side * g->q + to.line) * g->q + to.at;
    return true;
}

static int slimfly_distance(const struct topology *t, int from, int to)
{
    const struct slimfly *g = t->state;
    if (from == to) return 0;
    return adjacent(g, place_of(g, from), place_of(g, to)) ? 1 : 2;
}

static void slimfly_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct slimfly *g = t->state;
    int slot = link % g->leaving;
    *from = link / g->leaving;
    struct place p = place_of(g, *from), r = p;
    if (slot < g->q) r = (struct place){1 - p.side, slot, across(g, p, slot)};
    else r.at = g->neighbour[p.side][p.at * g->near + slot - g->q];
    *to = (r.side * g->q + r.line) * g->q + r.at;
    *port = slot_of(g, r, p);
}

/* dim_bandwidth: links of a line, links across. */
static int slimfly_rate_dim(const struct topology *t, int link)
{
    const struct slimfly *g = t->state;
    return link % g->leaving < g->q ? 1 : 0;
}

const struct topology_type topology_slim_fly = {
    .name = "slim-fly",
    .create = slimfly_create,
    .start = slimfly_start,
    .next = slimfly_next,
    .distance = slimfly_distance,
    .ends = slimfly_ends,
    .rate_dim = slimfly_rate_dim,
};
