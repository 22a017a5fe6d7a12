/* routing_lattice.h - routers with coordinates, and links along one of them: meshes, tori,
 * hypercubes and HyperX networks, as the rules see them. */
#ifndef MACHINE_ROUTING_LATTICE_H
#define MACHINE_ROUTING_LATTICE_H

#include "machine/routing_internal.h"

enum { LATTICE_MOST_DIMS = 32 };

struct lattice {
    int nrouter, ndim, degree;
    int diameter; /* by its own links: a hypercube's Xpress links are not used */
    bool wraps;   /* rings: two ways round */
    bool direct;  /* a link to every other router of a line, not to its neighbours alone */
    int radix[LATTICE_MOST_DIMS], stride[LATTICE_MOST_DIMS];
    int first[LATTICE_MOST_DIMS];  /* place of a dimension in a router's row of `out` */
    int bundle[LATTICE_MOST_DIMS]; /* parallel cables, numbered one after the other */
    /* (nrouter x degree) links that leave: up and down in each dimension, or to each coordinate */
    int *out;
    int *at; /* (nrouter x ndim) coordinates */
    /* (nrouter x nrouter) by order of dimensions, ascending and descending: place in a router's row
     * of `out` of the link on to another router; NULL: not kept */
    uint8_t *slot[2];
    uint8_t *far; /* (nrouter x nrouter) dimensions in which two routers differ; NULL: not kept */
    struct lattice_step *step; /* (nrouter x nrouter) NULL: not kept */
};

/* The lowest dimension in which two routers differ, on a mesh or torus: the links up and down that
 * leave the first one, whether each passes the edge of the ring, and the shorter way: 0, 1, -1. */
struct lattice_step {
    int link[2];
    bool crosses[2];
    uint8_t dim;
    int8_t way;
};

/* lattice_create: of r->topology, memory from a. */
struct lattice *lattice_create(const struct routing *r, struct arena *a);

/* lattice_at: coordinate d of a router. */
static inline int lattice_at(const struct lattice *g, int router, int d)
{
    return g->at[router * g->ndim + d];
}

/* lattice_dimension: the first dimension in which two routers differ, -1: none; from the last one
 * on if descending. */
static inline int lattice_dimension(const struct lattice *g, int from, int to, bool descending)
{
    const int n = g->ndim, *x = &g->at[from * n], *y = &g->at[to * n];
    int d = descending ? n - 1 : 0;
    if (descending)
        while (d >= 0 && x[d] == y[d]) d--;
    else
        while (d < n && x[d] == y[d]) d++;
    return d < n ? d : -1;
}

/* lattice_link: the link from p's router in dimension d to coordinate `to`, upwards (way 0) or
 * downwards (1) where there are two ways. The cable of a bundle is that of the packet's number,
 * without a draw: loads do not matter to it. */
static inline int lattice_link(const struct lattice *g, const struct route *p, int d, int to,
                               int way)
{
    const int *row = &g->out[p->router * g->degree + g->first[d]];
    if (!g->direct) return row[way];
    return g->bundle[d] == 1 ? row[to] : row[to] + (int)(p->choice % (uint64_t)g->bundle[d]);
}

/* lattice_way: 0 up or 1 down from coordinate x to y in dimension d, the shorter way round a ring;
 * -1: both are as long. */
static inline int lattice_way(const struct lattice *g, int d, int x, int y)
{
    if (!g->wraps) return y < x;
    const int k = g->radix[d], up = y < x ? y - x + k : y - x;
    return 2 * up == k ? -1 : 2 * up > k;
}

/* lattice_crosses: whether the way from x to y in direction `way` passes the edge of the ring. */
static inline bool lattice_crosses(const struct lattice *g, int x, int y, int way)
{
    return g->wraps && (way == 0 ? x > y : x < y);
}

#endif
