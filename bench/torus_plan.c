/* torus_plan.c - the main scenario with another machine size; see torus_plan.h. */
#include "torus_plan.h"

#include <stdio.h>

/* Torus dimensions with the product nrank, as equal as powers of two allow. */
static void torus_of(int nrank, int dims[3])
{
    dims[0] = dims[1] = dims[2] = 1;
    for (int k = 0; nrank > 1; nrank /= 2, k++) dims[k % 3] *= 2;
}

bool torus_plan_read(struct plan *p, int nrank, const char *level, struct err *e)
{
    int dims[3];
    char set[3][96];
    torus_of(nrank, dims);
    snprintf(set[0], sizeof set[0], "machine.topology.dims=[%d, %d, %d]", dims[0], dims[1],
             dims[2]);
    snprintf(set[1], sizeof set[1], "model.n=%d", nrank);
    snprintf(set[2], sizeof set[2], "machine.network.level=%s", level);
    const char *all[] = {set[0], set[1], set[2], "record.links=false"};
    struct plan_options o = {.nset = 4, .set = all};
    return plan_read(p, "speedup-t3e", &o, e);
}
