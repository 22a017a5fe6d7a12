/* compute.c - computing time that the program states itself (mimdsim/compute.h), from C and from
 * Fortran. */
#include <mimdsim/compute.h>
#include <stddef.h>

#include "guest.h"

void mimdsim_compute_(const double *flops, const double *bytes);

static void compute(const void *place, double flops, double bytes)
{
    const struct mimdsim_runtime *r = mimdsim_host->runtime;
    guest_account(place);
    if (r->size >= offsetof(struct mimdsim_runtime, compute) + sizeof r->compute)
        r->compute(mimdsim_host, flops, bytes);
}

WEAK void mimdsim_compute(double flops, double bytes)
{
    compute(__builtin_return_address(0), flops, bytes);
}

WEAK void mimdsim_compute_(const double *flops, const double *bytes)
{
    compute(__builtin_return_address(0), *flops, *bytes);
}
