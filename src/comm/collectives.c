/* collectives.c - dissemination and binomial trees over point-to-point messages. */
#include "comm/collectives.h"

void collective_barrier(struct comm *c, int tag)
{
    int rank = comm_rank(c), size = comm_size(c);
    for (int distance = 1, round = 0; distance < size; distance *= 2, round++) {
        comm_send(c, (rank + distance) % size, tag + round, NULL, 0);
        comm_recv(c, (rank - distance % size + size) % size, tag + round, NULL, 0);
    }
}

void collective_broadcast(struct comm *c, int root, int tag, void *data, int64_t bytes)
{
    int size = comm_size(c), relative = (comm_rank(c) - root + size) % size, mask = 1;
    while (mask < size && !(relative & mask)) mask *= 2;
    if (relative) comm_recv(c, (relative - mask + root) % size, tag, data, bytes);
    for (mask /= 2; mask > 0; mask /= 2)
        if (relative + mask < size) comm_send(c, (relative + mask + root) % size, tag, data, bytes);
}

enum { SUM_CHUNK = 64 };

/* Binomial reduction of up to SUM_CHUNK numbers to rank 0. */
static void reduce_chunk(struct comm *c, int tag, double *data, int n)
{
    double other[SUM_CHUNK];
    int rank = comm_rank(c), size = comm_size(c);
    for (int mask = 1; mask < size; mask *= 2) {
        if (rank & mask) {
            comm_send(c, rank - mask, tag, data, n * (int64_t)sizeof *data);
            return;
        }
        if (rank + mask >= size) continue;
        comm_recv(c, rank + mask, tag, other, n * (int64_t)sizeof *data);
        for (int k = 0; k < n; k++) data[k] += other[k];
        struct work w = {.flop = (uint64_t)n};
        comm_work(c, &w);
    }
}

void collective_sum(struct comm *c, int tag, double *data, int n)
{
    for (int first = 0; first < n; first += SUM_CHUNK)
        reduce_chunk(c, tag, data + first, n - first < SUM_CHUNK ? n - first : SUM_CHUNK);
    collective_broadcast(c, 0, tag + 1, data, n * (int64_t)sizeof *data);
}
