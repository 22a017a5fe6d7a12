/* extremes.c - the largest numbers of all ranks (extremes.h). */
#include "kernel/extremes.h"

#include <math.h>

#include "base/check.h"
#include "kernel/scan.h"

enum { MOST = 4 };

real largest_size(real so_far, int n, const real *x)
{
    for (int i = 0; i < n; i++) {
        const real size = real_fabs(x[i]);
        if (size > so_far) so_far = size;
        if (!(size <= so_far)) so_far = (real)INFINITY;
    }
    return so_far;
}

void largest_everywhere(struct comm *c, int tag, int n, real *x)
{
    const int rank = comm_rank(c), P = comm_size(c);
    const int64_t bytes = n * (int64_t)sizeof(real);
    real in[MOST];
    CHECK(n <= MOST);
    for (int d = 1, round = 0; d < P; d *= 2, round++) {
        comm_send(c, (rank + d) % P, tag + round, x, bytes);
        comm_recv(c, (rank - d + P) % P, tag + round, in, bytes);
        for (int i = 0; i < n; i++)
            if (in[i] > x[i]) x[i] = in[i];
    }
}

bool refinement_begin(struct refinement *r, struct comm *c, int tag, real residual)
{
    real worst = largest_size(0, 1, &residual);
    r->before = 1;
    largest_everywhere(c, tag, 1, &worst);
    return worst > (real)1e6 * REAL_EPSILON;
}

bool refinement_accept(struct refinement *r, struct comm *c, int tag, int n, const real *correction, const real *answer)
{
    real size[2] = {largest_size(0, n, correction), largest_size(0, n, answer)};
    largest_everywhere(c, tag, 2, size);
    const real relative = size[1] > 0 ? size[0] / size[1] : size[0] > 0;
    if (!(relative < r->before)) return false;
    r->before = relative;
    return true;
}
