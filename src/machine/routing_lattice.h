/* routing_lattice.h - routers with coordinates, and links along one of them: meshes, tori,
 * hypercubes and HyperX networks, as the rules see them. */
#ifndef MACHINE_ROUTING_LATTICE_H
#define MACHINE_ROUTING_LATTICE_H

#include "machine/routing_internal.h"

enum { LATTICE_MOST_DIMS = 32 };

struct lattice {
    int ndim, degree;
    int diameter; /* by its own links: a hypercube's Xpress links are not used */
    bool wraps;   /* rings: two ways round */
    bool direct;  /* a link to every other router of a line, not to its neighbours alone */
    int radix[LATTICE_MOST_DIMS], stride[LATTICE_MOST_DIMS];
    int first[LATTICE_MOST_DIMS];  /* place of a dimension in a router's row of `out` */
    int bundle[LATTICE_MOST_DIMS]; /* parallel cables, numbered one after the other */
    /* (nrouter x degree) links that leave: up and down in each dimension, or to each coordinate */
    int *out;
    int *at; /* (nrouter x ndim) coordinates */
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
int lattice_dimension(const struct lattice *g, int from, int to, bool descending);

/* lattice_link: the link from p's router in dimension d to coordinate `to`, upwards (way 0) or
 * downwards (1) where there are two ways. */
int lattice_link(const struct lattice *g, const struct route *p, int d, int to, int way);

/* lattice_way: 0 up or 1 down from coordinate x to y in dimension d, the shorter way round a ring;
 * -1: both are as long. */
int lattice_way(const struct lattice *g, int d, int x, int y);

/* lattice_crosses: whether the way from x to y in direction `way` passes the edge of the ring. */
static inline bool lattice_crosses(const struct lattice *g, int x, int y, int way)
{
    return g->wraps && (way == 0 ? x > y : x < y);
}

#endif
