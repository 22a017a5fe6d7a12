/* network_picture.c - where routers stand in a picture of their network, and how cables run.
 *
 * Grids stand as grids, further dimensions as copies beside and above; networks whose switches
 * have no nodes stand in rings, the leaves outside; all others on one circle, in the order of
 * their numbers. A cable is a straight line, on a grid an arc where it passes other routers. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "store/temporary.h"
#include "study/network_view.h"

enum { ARC_PIECES = 8 };

struct picture {
    const struct network_view *v;
    double *x, *y; /* (nrouter) from -1 to 1 */
    bool grid;
    double step; /* of a grid: between neighbours */
    int every;   /* routers whose cables are drawn */
    int npair;   /* joined pairs of routers */
};

/* Dimension 0 to the right, 1 up, each further one where the picture is narrower; its step is as
 * wide as all that lies that way already, and a gap. */
static void place_grid(struct picture *p)
{
    const struct topology_spec *s = p->v->topology->spec;
    bool cube = topology_has(s->family, TOPOLOGY_CUBE);
    int ndim = cube ? s->dims[0] : s->ndim, n = p->v->topology->nrouter;
    int axis[32];
    double wide[2] = {1, 1}, extent[2] = {0, 0}, step[32];
    for (int d = 0; d < ndim; d++) {
        int k = cube ? 2 : s->dims[d];
        int w = axis[d] = d < 2 ? d : extent[1] < extent[0];
        step[d] = wide[w];
        extent[w] += (k - 1) * step[d];
        wide[w] = extent[w] + step[d] * 1.6;
    }
    double scale = 2 / fmax(1, fmax(extent[0], extent[1]));
    for (int r = 0; r < n; r++) {
        int rest = r;
        double at[2] = {-extent[0] / 2, -extent[1] / 2};
        for (int d = 0; d < ndim; d++) {
            int k = cube ? 2 : s->dims[d];
            at[axis[d]] += rest % k * step[d];
            rest /= k;
        }
        p->x[r] = at[0] * scale;
        p->y[r] = at[1] * scale;
    }
    p->grid = true;
    p->step = scale;
}

/* How far each router is from those with nodes: the leaves of a tree are level 0. */
static int levels(const struct topology *t, int *level, struct arena *a)
{
    int top = 0, from, to, port;
    bool more = true;
    (void)a;
    for (int r = 0; r < t->nrouter; r++) level[r] = r < t->nnode / t->nodes_per_router ? 0 : -1;
    for (int at = 0; more; at++) {
        more = false;
        for (int l = 0; l < t->nlink; l++) {
            topology_link_ends(t, l, &from, &to, &port);
            if (level[from] != at || level[to] >= 0) continue;
            level[to] = at + 1;
            top = at + 1;
            more = true;
        }
    }
    return top;
}

/* A ring for each level, smaller further up. The routers of a level share it evenly, in the order
 * of their numbers, so that those of a group or subtree stand at one angle. */
static void place_rings(struct picture *p, struct arena *a)
{
    const struct topology *t = p->v->topology;
    const double turn = 2 * 3.14159265358979323846;
    int *level = TAKE(a, t->nrouter, int), top = levels(t, level, a);
    int *count = TAKE(a, top + 1, int), *placed = TAKE(a, top + 1, int);
    for (int r = 0; r < t->nrouter; r++) count[level[r]]++;
    for (int r = 0; r < t->nrouter; r++) {
        int l = level[r];
        double angle = turn * (placed[l]++ + 0.5) / count[l];
        double radius = top == 0 ? 1 : 1 - 0.75 * l / top;
        /* From the top on, with the clock. */
        p->x[r] = radius * sin(angle);
        p->y[r] = radius * cos(angle);
    }
}

static bool is_grid(const struct topology_spec *s)
{
    bool lattice = topology_has(s->family, TOPOLOGY_GRID) || s->family == TOPOLOGY_HYPERX;
    if (topology_has(s->family, TOPOLOGY_CUBE)) return s->dims[0] > 1;
    /* A ring and a full mesh look better on a circle. */
    return lattice && s->ndim > 1;
}

/* One piece of a line, straight. */
static bool piece(struct store *s, const double at[4], int cut, int far, struct err *e)
{
    const struct store_value row[] = {store_real(at[0]), store_real(at[1]), store_real(at[2]),
                                      store_real(at[3]), store_int(cut),    store_int(far)};
    return store_temporary_row(s, "topology_line", 6, row, e);
}

/* A cable from a to b. Straight where nothing is between; on a grid else an arc that leaves the
 * line by a share of its length, so that longer ones pass outside of shorter ones. */
static bool cable(const struct picture *p, struct store *s, int a, int b, struct err *e)
{
    const bool *half = p->v->measure.half;
    double dx = p->x[b] - p->x[a], dy = p->y[b] - p->y[a], length = hypot(dx, dy);
    bool far = p->grid && length > 1.7 * p->step;
    int n = far ? ARC_PIECES : 1, cut = half && half[a] != half[b];
    double last[2] = {p->x[a], p->y[a]}, bulge = far ? 0.09 : 0;
    bool ok = true;
    for (int i = 1; i <= n && ok; i++) {
        double f = (double)i / n, out = 4 * f * (1 - f) * bulge;
        double now[2] = {p->x[a] + f * dx - out * dy, p->y[a] + f * dy + out * dx};
        ok =
            piece(s, (double[]){last[0], last[1], now[0] - last[0], now[1] - last[1]}, cut, far, e);
        last[0] = now[0];
        last[1] = now[1];
    }
    return ok;
}

/* Pairs of joined routers, each from its lower end, by lists of neighbours; `s` NULL only counts.
 */
static bool pairs(struct picture *p, struct store *s, struct arena *a, struct err *e)
{
    const struct topology *t = p->v->topology;
    struct arena_mark mark = arena_mark(a);
    const struct topology_neighbours near = topology_neighbours(t, a);
    int *seen = TAKE(a, t->nrouter, int);
    bool ok = true;
    p->npair = 0;
    for (int r = 0; r < t->nrouter && ok; r++)
        for (int i = near.first[r]; i < near.first[r + 1] && ok; i++) {
            const int to = near.to[i];
            /* The way back is the same line, and so are parallel cables. */
            if (to <= r || seen[to] == r + 1) continue;
            seen[to] = r + 1;
            p->npair++;
            if (s && r % p->every == 0) ok = cable(p, s, r, to, e);
        }
    arena_release(a, mark);
    return ok;
}

static bool tables(struct store *s, struct err *e)
{
    return store_temporary(s, "topology_about",
                           "title TEXT, subtitle TEXT, every INTEGER, pairs INTEGER, "
                           "routers INTEGER, grid INTEGER, halves INTEGER",
                           e) &&
           store_temporary(s, "topology_router", "router INTEGER, x REAL, y REAL, kind INTEGER",
                           e) &&
           store_temporary(s, "topology_line",
                           "x REAL, y REAL, dx REAL, dy REAL, cut INTEGER, far INTEGER", e);
}

/* 0 and 1: the half of a router with nodes; 2: a switch without, or what does not work. */
static bool routers(const struct picture *p, struct store *s, struct err *e)
{
    const struct topology *t = p->v->topology;
    bool ok = true;
    for (int r = 0; r < t->nrouter && ok; r++) {
        const bool *half = p->v->measure.half;
        bool nodes = r < t->nnode / t->nodes_per_router && topology_router_works(t, r);
        int kind = nodes ? half && half[r] : 2;
        const struct store_value row[] = {store_int(r), store_real(p->x[r]), store_real(p->y[r]),
                                          store_int(kind)};
        ok = store_temporary_row(s, "topology_router", 4, row, e);
    }
    return ok;
}

static bool about(const struct picture *p, struct store *s, struct err *e)
{
    const struct network_view *v = p->v;
    const struct topology_measure *m = &v->measure;
    char title[256], text[256];
    snprintf(title, sizeof title, "%s: %s %s", v->spec->name, v->family, v->dims);
    snprintf(text, sizeof text,
             "%d routers, %d nodes, diameter %d, mean distance %.3g, bisection %s%lld cables",
             m->nrouter, m->nnode, m->diameter, m->mean,
             m->source == BISECTION_PARTITION ? "at most " : "", (long long)m->bisection);
    const struct store_value row[] = {
        store_text(title),     store_text(text),   store_int(p->every),       store_int(p->npair),
        store_int(m->nrouter), store_int(p->grid), store_int(m->half != NULL)};
    return store_temporary_row(s, "topology_about", 7, row, e);
}

bool network_view_tables(const struct network_view *v, struct store *s, struct arena *a,
                         struct err *e)
{
    int n = v->topology->nrouter;
    if (n > NETWORK_VIEW_ROUTERS)
        return err_set(e, ERR_DATA, "%d routers are too many for a picture; expected at most %d", n,
                       NETWORK_VIEW_ROUTERS);
    struct picture p = {.v = v, .x = TAKE(a, n, double), .y = TAKE(a, n, double), .every = 1};
    if (is_grid(v->topology->spec)) place_grid(&p);
    else place_rings(&p, a);
    /* Counted first: how many cables there are decides which are drawn. */
    pairs(&p, NULL, a, e);
    p.every = 1 + (p.npair - 1) / NETWORK_VIEW_PAIRS;
    return tables(s, e) && routers(&p, s, e) && pairs(&p, s, a, e) && about(&p, s, e);
}
