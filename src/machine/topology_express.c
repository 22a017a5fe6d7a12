/* topology_express.c - express cubes: meshes and tori whose every i-th router has further links to
 * those i places away.
 *
 * dims as of a torus; topology.express = i >= 2 is the interval of all dimensions. Routers whose
 * coordinate is a multiple of i are interchanges and have express links to the next ones up and
 * down their line, beside the local links (Dally, "Express cubes: improving the performance of
 * k-ary n-cube interconnection networks", IEEE Trans. Comput. 40, 1991; here the interchange is
 * part of the router, which costs no further hop). On a torus i divides every radix.
 *
 * Routes mend the lowest dimension first and never turn round within it: by local links to the
 * first interchange on the way, by express links as far as they lead, by local ones to the end. On
 * a torus the direction with fewer links is taken, of two equal ones the shorter way, else up.
 * These are the shortest routes without steps back; a step back to an interchange behind would save
 * links now and then, and cost classes. Within a line every link leads further the same way, so
 * that a mesh needs one class and a torus the two of a dateline: 1 until the wrap has been crossed.
 *
 * Links: dimension by dimension, by line; on a line local ones up, local down, express up, express
 * down, each by its lower end (on a torus: by the router they leave). */
#include "base/check.h"
#include "machine/topology_internal.h"

struct express {
    int ndim, interval;
    bool wraps;
    int radix[MACHINE_MAX_DIMS], stride[MACHINE_MAX_DIMS];
    int nlocal[MACHINE_MAX_DIMS];   /* local links of a line in one direction */
    int nexpress[MACHINE_MAX_DIMS]; /* express links of a line in one direction */
    int base[MACHINE_MAX_DIMS + 1]; /* first link of each dimension */
};

/* Both kinds of links of a line of k routers; a ring of one router has none. */
static void express_line(struct express *g, int d, int k)
{
    g->nlocal[d] = g->wraps && k > 1 ? k : k - 1;
    g->nexpress[d] = g->wraps && k > 1 ? k / g->interval : (k - 1) / g->interval;
}

static bool express_radix(const struct express *g, const struct topology *t, int d, struct err *e)
{
    int k = t->spec->dims[d], i = g->interval;
    if (k < 1)
        return err_set(e, ERR_CONFIG, "topology %s: radix %d in dimension %d; expected at least 1",
                       t->type->name, k, d);
    /* An express link that leads to its own router, or a short one at the wrap, would be neither.
     */
    if (g->wraps && k > 1 && (k % i != 0 || k < 2 * i))
        return err_set(e, ERR_CONFIG,
                       "topology %s: radix %d in dimension %d; expected a multiple of "
                       "topology.express, which is %d, and at least twice as much",
                       t->type->name, k, d, i);
    return true;
}

/* The longest way along a line of k routers, by trying all ends: lines are short. */
static int express_longest(const struct express *g, int d);

static bool express_make(struct topology *t, struct arena *a, bool wraps, struct err *e)
{
    const struct topology_spec *s = t->spec;
    struct express *g = TAKE(a, 1, struct express);
    int64_t nrouter = 1, nlink = 0;
    if (s->ndim < 1 || s->ndim > MACHINE_MAX_DIMS || s->express < 2)
        return err_set(e, ERR_CONFIG,
                       "topology %s: %d dimensions, topology.express is %d; expected 1 to %d "
                       "dimensions and an interval of at least 2",
                       t->type->name, s->ndim, s->express, MACHINE_MAX_DIMS);
    *g = (struct express){.ndim = s->ndim, .interval = s->express, .wraps = wraps};
    for (int d = 0; d < s->ndim; d++) {
        if (!express_radix(g, t, d, e)) return false;
        g->radix[d] = s->dims[d];
        g->stride[d] = (int)nrouter;
        nrouter *= s->dims[d];
        /* At most four links a dimension leave each router. */
        if (nrouter * s->nodes_per_router > INT32_MAX / (4 * s->ndim))
            return err_set(e, ERR_CONFIG, "topology %s: more routers than can be numbered",
                           t->type->name);
        express_line(g, d, s->dims[d]);
    }
    for (int d = 0; d < s->ndim; d++) {
        g->base[d] = (int)nlink;
        nlink += nrouter / s->dims[d] * 2 * (g->nlocal[d] + g->nexpress[d]);
        t->max_hops += express_longest(g, d);
    }
    g->base[s->ndim] = (int)nlink;
    t->state = g;
    t->nrouter = (int)nrouter;
    t->nlink = (int)nlink;
    t->nport = 4 * s->ndim;
    t->nclass = wraps ? 2 : 1;
    return true;
}

static bool express_mesh_create(struct topology *t, struct arena *a, struct err *e)
{
    return express_make(t, a, false, e);
}
static bool express_torus_create(struct topology *t, struct arena *a, struct err *e)
{
    return express_make(t, a, true, e);
}

/* floor(x / i) and ceil(x / i), also of what lies below 0. */
static int floor_div(int x, int i) { return x >= 0 ? x / i : -((-x + i - 1) / i); }
static int ceil_div(int x, int i) { return -floor_div(-x, i); }

/* Links from x to y >= x on an unrolled line: to the first interchange, express, from the last. */
static int express_links(int x, int y, int i)
{
    int first = ceil_div(x, i), last = floor_div(y, i);
    return last > first ? first * i - x + last - first + y - last * i : y - x;
}

/* Steps from x to y, down where negative, as places on the line and not as links. */
static int express_offset(const struct express *g, int d, int x, int y)
{
    int diff = y - x, k = g->radix[d], i = g->interval;
    if (!g->wraps || diff == 0) return diff;
    int up = diff < 0 ? diff + k : diff, down = k - up;
    int by_up = express_links(x, x + up, i), by_down = express_links(x - down, x, i);
    if (by_up != by_down) return by_up < by_down ? up : -down;
    return up <= down ? up : -down;
}

static int express_ways(const struct express *g, int d, int x, int y)
{
    int offset = express_offset(g, d, x, y), end = x + offset;
    return offset < 0 ? express_links(end, x, g->interval) : express_links(x, end, g->interval);
}

/* On a ring all interchanges are alike, on a mesh the ends are not: from the first interval on. */
static int express_longest(const struct express *g, int d)
{
    int longest = 0, k = g->radix[d], from = k < g->interval ? k : g->interval;
    for (int x = 0; x < from; x++)
        for (int y = 0; y < k; y++) {
            int n = express_ways(g, d, x, y);
            if (n > longest) longest = n;
        }
    return longest;
}

/* Enter the first dimension >= c->stage in which the coordinates differ: at is the place on the
 * unrolled line, left the places to go, step the direction. */
static void express_turn(const struct express *g, struct route_cursor *c)
{
    for (int d = c->stage; d < g->ndim; d++) {
        int x = c->router / g->stride[d] % g->radix[d], y = c->target / g->stride[d] % g->radix[d];
        int offset = express_offset(g, d, x, y);
        if (offset == 0) continue;
        c->stage = d;
        c->at = x;
        c->step = offset < 0 ? -1 : 1;
        c->left = offset < 0 ? -offset : offset;
        return;
    }
    c->left = 0;
}

static void express_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    (void)choice;
    c->stage = c->left = 0;
    if (c->router != c->target) express_turn(t->state, c);
}

/* First link of router r's line in dimension d; of the four rows of a line, `row` counts from the
 * local links up. */
static int line_base(const struct express *g, int d, int r, int row)
{
    int line = r / (g->stride[d] * g->radix[d]) * g->stride[d] + r % g->stride[d];
    int all = 2 * (g->nlocal[d] + g->nexpress[d]);
    int before = row < 2 ? row * g->nlocal[d] : 2 * g->nlocal[d] + (row - 2) * g->nexpress[d];
    return g->base[d] + line * all + before;
}

/* One link: express where this is an interchange and the next one is still on the way. */
static bool express_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    const struct express *g = t->state;
    if (c->left == 0) return false;
    int d = c->stage, k = g->radix[d];
    bool down = c->step < 0, fast = c->at % g->interval == 0 && c->left >= g->interval;
    int length = fast ? g->interval : 1;
    /* Class 1 while the wrap is still ahead or being crossed. */
    h->vc_class = g->wraps && (down ? c->at - c->left < 0 : c->at + c->left >= k);
    h->port = 4 * d + 2 * fast + !down;
    int to = c->at + c->step * length;
    int lower = down && !g->wraps ? to : c->at;
    h->link = line_base(g, d, c->router, 2 * fast + down) + lower / length;
    /* Over the edge of the ring the coordinate comes in on the other side. */
    if (to >= k || to < 0) to -= c->step * k;
    c->router += (to - c->at) * g->stride[d];
    c->at = to;
    c->left -= length;
    if (c->left == 0 && c->router != c->target) {
        c->stage++;
        express_turn(g, c);
    }
    return true;
}

static int express_distance(const struct topology *t, int from, int to)
{
    const struct express *g = t->state;
    int hops = 0;
    for (int d = 0; d < g->ndim; d++)
        hops +=
            express_ways(g, d, from / g->stride[d] % g->radix[d], to / g->stride[d] % g->radix[d]);
    return hops;
}

/* The numbering of the header, backwards. */
static void express_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct express *g = t->state;
    int d = 0;
    while (link >= g->base[d + 1]) d++;
    int i = link - g->base[d], all = 2 * (g->nlocal[d] + g->nexpress[d]), line = i / all;
    i %= all;
    bool fast = i >= 2 * g->nlocal[d];
    if (fast) i -= 2 * g->nlocal[d];
    int row = fast ? g->nexpress[d] : g->nlocal[d], length = fast ? g->interval : 1;
    bool down = i >= row;
    int k = g->radix[d], x = i % row * length,
        y = (down && g->wraps ? x - length + k : x + length) % k;
    int begin = line / g->stride[d] * g->stride[d] * k + line % g->stride[d];
    int a = begin + x * g->stride[d], b = begin + y * g->stride[d];
    bool swap = down && !g->wraps; /* numbered by its lower end */
    *from = swap ? b : a;
    *to = swap ? a : b;
    *port = 4 * d + 2 * fast + !down;
}

/* dim_bandwidth: of each dimension, for local and express links alike. */
static int express_rate_dim(const struct topology *t, int link)
{
    const struct express *g = t->state;
    int d = 0;
    while (link >= g->base[d + 1]) d++;
    return d;
}

/* One set of functions for both: g->wraps is all the difference. */
const struct topology_type topology_express_mesh = {
    .name = "express-mesh",
    .create = express_mesh_create,
    .start = express_start,
    .next = express_next,
    .distance = express_distance,
    .ends = express_ends,
    .rate_dim = express_rate_dim,
    .parts = topology_grid_parts,
};
const struct topology_type topology_express_torus = {
    .name = "express-torus",
    .create = express_torus_create,
    .start = express_start,
    .next = express_next,
    .distance = express_distance,
    .ends = express_ends,
    .rate_dim = express_rate_dim,
    .parts = topology_grid_parts,
};
