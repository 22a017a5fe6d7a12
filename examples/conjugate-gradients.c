/* conjugate-gradients.c - the method of conjugate gradients (Hestenes and Stiefel 1952) for
 * Poisson's equation on n by n points, in strips of rows: a step takes one exchange with the
 * neighbours and two sums over all ranks. */
#include <math.h>
#include <mimdsim/program.h>

static int64_t n = 64, iterations = 30;

/* y = A x for a strip of m rows: 4 x less the four neighbours; rows -1 and m are the neighbours'.
 */
static void apply(const double *x, double *y, int64_t m)
{
    for (int64_t i = 0; i < m; i++)
        for (int64_t j = 0; j < n; j++) {
            const double *at = x + i * n + j;
            y[i * n + j] =
                4 * at[0] - at[-n] - at[n] - (j > 0 ? at[-1] : 0) - (j < n - 1 ? at[1] : 0);
        }
}

static double dot(const double *x, const double *y, int64_t m)
{
    double sum = 0;
    for (int64_t i = 0; i < m * n; i++) sum += x[i] * y[i];
    return sum;
}

static double total(struct comm *c, double sum)
{
    if (comm_size(c) > 1) comm_allreduce(c, COMM_SUM, &sum, 1);
    return sum;
}

/* The rows next to the strip, from the neighbours; at the edge of the grid they stay zero. */
static void exchange(struct comm *c, double *x, int64_t m)
{
    const int me = comm_rank(c), p = comm_size(c);
    if (me > 0) comm_send(c, me - 1, 1, x, n * 8);
    if (me < p - 1) comm_send(c, me + 1, 2, x + (m - 1) * n, n * 8);
    if (me > 0) comm_recv(c, me - 1, 2, x - n, n * 8);
    if (me < p - 1) comm_recv(c, me + 1, 1, x + m * n, n * 8);
}

/* The rows of rank `me` of p; the parallel program is the serial one with p > 1. */
static void solve(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c), parallel = p > 1;
    const int64_t first = n * me / p, m = n * (me + 1) / p - first, size = m * n;
    double *x = comm_memory(c, size * 8), *r = comm_memory(c, size * 8),
           *q = comm_memory(c, size * 8);
    double *d = (double *)comm_memory(c, (size + 2 * n) * 8) + n;
    if (m < 1) comm_fail(c, "%d ranks for %ld rows", p, (long)n);
    for (int64_t i = 0; i < size; i++) d[i] = r[i] = (double)(((first * n + i) * 29) % 101) - 50;
    double rr = total(c, dot(r, r, m));
    for (int64_t k = 0; k < iterations && rr > 0; k++) {
        if (parallel) comm_stage(c, 0), exchange(c, d, m), comm_stage(c, 1);
        apply(d, q, m);
        double dq = dot(d, q, m);
        if (parallel) comm_stage(c, 2);
        const double alpha = rr / total(c, dq);
        if (parallel) comm_stage(c, 1);
        for (int64_t i = 0; i < size; i++) x[i] += alpha * d[i], r[i] -= alpha * q[i];
        double next = dot(r, r, m);
        if (parallel) comm_stage(c, 2);
        next = total(c, next);
        if (parallel) comm_stage(c, 1);
        for (int64_t i = 0; i < size; i++) d[i] = r[i] + next / rr * d[i];
        rr = next;
    }
    comm_publish(c, 0, first * n, size, x);
    const double residual = sqrt(rr);
    if (me == 0) comm_publish(c, 1, 0, 1, &residual);
}

PROGRAM(.title = "conjugate gradients for Poisson's equation on a square",
        .parameter = {PROGRAM_WHOLE(n, 2, 10000, "rows and columns of the grid"),
                      PROGRAM_WHOLE(iterations, 1, 1e6, "steps of the method")},
        .stage = {"neighbours", "compute", "sums"}, .output = {"x", "residual"}, .run = solve,
        .serial = {{"one processor", solve}}, .tolerance = 1e-9);
