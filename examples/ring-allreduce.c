/* ring-allreduce.c - the sum of a vector over all ranks, in 2 (P - 1) steps round a ring (Patarasuk
 * and Yuan, J. Parallel Distrib. Comput. 69, 2009): no algorithm sends fewer bytes. */
#include <mimdsim/program.h>

static int64_t n = 10000;

static double value(int rank, int64_t i) { return (double)((rank + 1) * (i % 1000 + 1)); }

static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    double *x = comm_memory(c, n * 8), *in = comm_memory(c, (n / p + 1) * 8);
    for (int64_t i = 0; i < n; i++) x[i] = value(me, i);
    for (int step = 0; step < 2 * (p - 1); step++) {
        const int out = (me - step + 2 * p) % p, got = (out + p - 1) % p; /* numbers of blocks */
        const int64_t a = n * out / p, b = n * got / p, m = n * (got + 1) / p - b;
        comm_stage(c, step < p - 1 ? 0 : 1);
        comm_send(c, (me + 1) % p, step, x + a, (n * (out + 1) / p - a) * 8);
        comm_recv(c, (me + p - 1) % p, step, in, m * 8);
        for (int64_t i = 0; i < m; i++) x[b + i] = step < p - 1 ? x[b + i] + in[i] : in[i];
    }
    const int64_t first = n * me / p;
    comm_publish(c, 0, first, n * (me + 1) / p - first, x + first);
}

static void serial(struct comm *c) /* one processor adds the vectors of all ranks of the run */
{
    double *x = comm_memory(c, n * 8);
    for (int rank = 0; rank < comm_run_size(c); rank++)
        for (int64_t i = 0; i < n; i++) x[i] += value(rank, i);
    comm_publish(c, 0, 0, n, x);
}

PROGRAM(.title = "sum of a vector over all ranks, round a ring",
        .parameter = {PROGRAM_WHOLE(n, 1, 1e8, "numbers of the vector")},
        .stage = {"reduce-scatter", "allgather"}, .output = {"sum"}, .run = run,
        .serial = {{"add one vector after the other", serial}}, .tolerance = 1e-12);
