/* carve.h - laying out one rank's workspace: the same function measures it and points into it. */
#ifndef KERNEL_CARVE_H
#define KERNEL_CARVE_H

#include <stddef.h>

struct carve {
    char *base;  /* NULL: measure only */
    size_t used; /* so far [B] */
};

/* carve_bytes: the next `size` bytes, aligned to 16; NULL while measuring. */
static inline void *carve_bytes(struct carve *c, size_t size)
{
    void *p = c->base ? c->base + c->used : NULL;
    c->used += (size + 15) & ~(size_t)15;
    return p;
}

/* CARVE(c, n, type): an array of n elements. */
#define CARVE(c, n, type) ((type *)carve_bytes((c), (size_t)(n) * sizeof(type)))

#endif
