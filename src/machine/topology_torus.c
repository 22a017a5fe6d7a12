/* topology_torus.c - tori and meshes of any dimensions and mixed radix, dimension-order routes by
 * coordinates.
 *
 * Nothing is tabulated. In dimension d (stride s, radix k) a line of routers has m links each way,
 * m = k on a torus and k - 1 on a mesh; the link that leaves router r upwards, or on a mesh arrives
 * at r from above, has number base[d] + (down ? lines m : 0) + r - (k - m) s floor(r / (s k)),
 * which leaves no gaps. The dateline class is 1 while the wrap link of the present dimension is
 * still to be crossed. */
#include "base/check.h"
#include "machine/topology_internal.h"

struct torus {
    int ndim;
    bool wraps;
    enum tie_rule tie;
    unsigned radix[MACHINE_MAX_DIMS], stride[MACHINE_MAX_DIMS];
    unsigned per_line[MACHINE_MAX_DIMS]; /* links of a line in one direction */
    int base[MACHINE_MAX_DIMS + 1];      /* first link of each dimension */
    int count[MACHINE_MAX_DIMS];         /* links of a dimension in one direction */
};

/* Hops from coordinate x to y in dimension d: positive upwards, negative downwards; of a tie, bit d
 * of `choice` decides where chance does. The rule for ties decides who contends on half the ring
 * (physics 10.3): with all messages going up, half of the links stay idle. */
static int torus_offset(const struct torus *g, int d, int x, int y, int choice)
{
    int diff = y - x;
    if (!g->wraps || diff == 0) return diff;
    int k = (int)g->radix[d];
    int up = diff < 0 ? diff + k : diff;
    if (2 * up != k) return 2 * up < k ? up : up - k;
    bool down = g->tie == TIE_RANDOM ? choice >> d & 1 : g->tie == TIE_PARITY && x % 2 != 0;
    return down ? -up : up;
}

/* Strides and link numbers. A mesh has k - 1 links a line, a torus k; a ring of one router has none
 * of either. max_hops is the sum of the longest ways of all dimensions. */
static bool torus_shape(struct torus *g, struct topology *t, struct err *e)
{
    const struct topology_spec *s = t->spec;
    int64_t nrouter = 1, nlink = 0;
    if (s->ndim < 1 || s->ndim > MACHINE_MAX_DIMS)
        return err_set(e, ERR_CONFIG, "topology %s: %d dimensions; expected 1 to %d", t->type->name,
                       s->ndim, MACHINE_MAX_DIMS);
    for (int d = 0; d < s->ndim; d++) {
        if (s->dims[d] < 1)
            return err_set(e, ERR_CONFIG,
                           "topology %s: radix %d in dimension %d; expected at least 1",
                           t->type->name, s->dims[d], d);
        g->stride[d] = (unsigned)nrouter;
        g->radix[d] = (unsigned)s->dims[d];
        nrouter *= s->dims[d];
        /* Two links a dimension leave each router: their number must fit, too. */
        if (nrouter * s->nodes_per_router > INT32_MAX / (2 * s->ndim))
            return err_set(e, ERR_CONFIG, "topology %s: more routers than can be numbered",
                           t->type->name);
    }
    for (int d = 0; d < s->ndim; d++) {
        /* Links of a line, then of the dimension; both directions are numbered apart. */
        g->per_line[d] = g->wraps && g->radix[d] > 1 ? g->radix[d] : g->radix[d] - 1;
        g->base[d] = (int)nlink;
        g->count[d] = (int)(nrouter / s->dims[d] * g->per_line[d]);
        nlink += 2 * (int64_t)g->count[d];
        t->max_hops += (int)(g->wraps ? g->radix[d] / 2 : g->radix[d] - 1);
    }
    g->ndim = s->ndim;
    g->base[s->ndim] = (int)nlink;
    t->nrouter = (int)nrouter;
    t->nlink = (int)nlink;
    return true;
}

static bool torus_make(struct topology *t, struct arena *a, bool wraps, struct err *e)
{
    struct torus *g = TAKE(a, 1, struct torus);
    g->wraps = wraps;
    g->tie = t->spec->tie;
    t->state = g;
    if (!torus_shape(g, t, e)) return false;
    t->nport = 2 * g->ndim;
    /* Two classes break the circle of waiting on each ring (Dally and Seitz 1987); a mesh has
     * none. */
    t->nclass = wraps ? 2 : 1;
    t->fixed_routes = !wraps || g->tie != TIE_RANDOM;
    return true;
}

static bool torus_create(struct topology *t, struct arena *a, struct err *e)
{
    return torus_make(t, a, true, e);
}
static bool mesh_create(struct topology *t, struct arena *a, struct err *e)
{
    return torus_make(t, a, false, e);
}

/* Enter the first dimension >= c->stage in which the coordinates differ: dimension order, lowest
 * first. A turn back to a lower dimension never happens, hence no circle across dimensions. */
static void torus_turn(const struct torus *g, struct route_cursor *c)
{
    for (int d = c->stage; d < g->ndim; d++) {
        unsigned k = g->radix[d], s = g->stride[d];
        int x = (int)((unsigned)c->router / s % k), y = (int)((unsigned)c->target / s % k);
        int offset = torus_offset(g, d, x, y, c->via);
        if (offset == 0) continue;
        c->stage = d;
        c->at = x;
        c->left = offset < 0 ? -offset : offset;
        c->step = offset < 0 ? -1 : 1;
        return;
    }
    c->left = 0;
}

/* The choice is carried along as bits, one for each dimension's tie. */
static void torus_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    c->via = (int)(choice & INT32_MAX);
    if (c->router != c->target) torus_turn(t->state, c);
}

/* `lower` is the router that leaves upwards or, for a mesh's downward link, the lower end. On a
 * mesh the numbers of lines move together, since the last router of a line has no link up. */
static int torus_link(const struct torus *g, int d, int lower, bool down)
{
    int link = g->base[d] + lower + (down ? g->count[d] : 0);
    if (g->per_line[d] != g->radix[d])
        link -= (int)(g->stride[d] * ((unsigned)lower / (g->stride[d] * g->radix[d])));
    return link;
}

static bool torus_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    const struct torus *g = t->state;
    if (c->left == 0) return false;
    int d = c->stage, k = (int)g->radix[d], s = (int)g->stride[d];
    /* Class 1 while the wrap link of this dimension is still ahead or being crossed. */
    bool down = c->step < 0,
         wraps = g->wraps && (down ? c->at - c->left < 0 : c->at + c->left >= k);
    h->vc_class = wraps;
    h->port = 2 * d + !down;
    h->link = torus_link(g, d, down && !g->wraps ? c->router - s : c->router, down);
    /* Over the edge of the ring the coordinate comes in on the other side. */
    int to = c->at + c->step;
    if (to == k || to < 0) to -= c->step * k;
    c->router += (to - c->at) * s;
    c->at = to;
    /* This dimension is done. */
    if (--c->left == 0 && c->router != c->target) {
        c->stage++;
        torus_turn(g, c);
    }
    return true;
}

/* Sum of the ways in each dimension; of a tie both are equally long. */
static int torus_distance(const struct topology *t, int from, int to)
{
    const struct torus *g = t->state;
    unsigned p = (unsigned)from, q = (unsigned)to;
    int hops = 0;
    for (int d = 0; d < g->ndim; d++) {
        int offset = torus_offset(g, d, (int)(p % g->radix[d]), (int)(q % g->radix[d]), 0);
        hops += offset < 0 ? -offset : offset;
        p /= g->radix[d];
        q /= g->radix[d];
    }
    return hops;
}

/* Links are numbered dimension by dimension. */
static int torus_rate_dim(const struct topology *t, int link)
{
    const struct torus *g = t->state;
    int d = 0;
    while (link >= g->base[d + 1]) d++;
    return d;
}

/* The inverse of torus_link: x is the place along the line, `line` the router at its beginning. */
static void torus_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct torus *g = t->state;
    int d = torus_rate_dim(t, link);
    unsigned i = (unsigned)(link - g->base[d]), s = g->stride[d], k = g->radix[d],
             m = g->per_line[d];
    bool down = i >= (unsigned)g->count[d];
    if (down) i -= (unsigned)g->count[d];
    unsigned x = i / s % m, line = i / s / m * s * k + i % s;
    unsigned next = down && g->wraps ? (x + k - 1) % k : (x + 1) % k;
    int a = (int)(line + x * s), b = (int)(line + next * s);
    bool swap = down && !g->wraps; /* numbered by its lower end */
    *from = swap ? b : a;
    *to = swap ? a : b;
    *port = 2 * d + (down ? 0 : 1); /* going down one comes from the + neighbour */
}

/* With radices in falling order k_1 >= k_2 >= ..., C_i the product of those behind k_i, and e the
 * first of them that is even (the last if none is), a mesh is cut at sum C_i, i = 1 .. e, and a
 * torus at twice that (Azizoglu and Egecioglu, "The bisection width and the isoperimetric number of
 * arrays", Discrete Appl. Math. 138, 2004; of generalised cylinders, 2003). */
static int64_t torus_bisection(const struct topology *t)
{
    const struct torus *g = t->state;
    unsigned radix[MACHINE_MAX_DIMS];
    int64_t rest = t->nrouter, cables = 0;
    for (int d = 0; d < g->ndim; d++) {
        int i = d;
        for (; i > 0 && radix[i - 1] < g->radix[d]; i--) radix[i] = radix[i - 1];
        radix[i] = g->radix[d];
    }
    /* Across the longest dimension; of an odd one a layer is left, which is cut in turn. */
    for (int d = 0; d < g->ndim && radix[d] > 1; d++) {
        rest /= radix[d];
        cables += rest;
        if (radix[d] % 2 == 0) break;
    }
    return g->wraps ? 2 * cables : cables;
}

/* A block grows by one dimension at a time. */
int topology_grid_parts(const struct topology *t, int64_t *size)
{
    int64_t block = t->nodes_per_router;
    for (int i = 0; i < t->spec->ndim; i++) size[i] = block *= t->spec->dims[i];
    return t->spec->ndim;
}

/* One set of functions for both: g->wraps is all the difference. */
const struct topology_type topology_torus = {
    .name = "torus",
    .create = torus_create,
    .start = torus_start,
    .next = torus_next,
    .distance = torus_distance,
    .ends = torus_ends,
    .rate_dim = torus_rate_dim,
    .bisection = torus_bisection,
    .parts = topology_grid_parts,
};
const struct topology_type topology_mesh = {
    .name = "mesh",
    .create = mesh_create,
    .start = torus_start,
    .next = torus_next,
    .distance = torus_distance,
    .ends = torus_ends,
    .rate_dim = torus_rate_dim,
    .bisection = torus_bisection,
    .parts = topology_grid_parts,
};
