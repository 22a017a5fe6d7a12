/* pipelined-broadcast.c - a long message from rank 0 to all others along a chain of ranks, cut into
 * segments: while a rank forwards one, the next is on its way to it. Short segments fill the chain
 * soon, long ones cost less software; the best length is between. */
#include <mimdsim/program.h>
#include <string.h>

static int64_t bytes = 1 << 20, segment = 16384;

static unsigned char value(int64_t i) { return (unsigned char)(i * 37 % 251); }

/* A number that differs when any byte does. */
static double checksum(const unsigned char *x)
{
    uint64_t h = 14695981039346656037u;
    for (int64_t i = 0; i < bytes; i++) h = (h ^ x[i]) * 1099511628211u;
    return (double)(h >> 12);
}

static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    unsigned char *x = comm_memory(c, bytes);
    for (int64_t i = 0; me == 0 && i < bytes; i++) x[i] = value(i);
    comm_stage(c, 0);
    for (int64_t at = 0; at < bytes; at += segment) {
        const int64_t m = bytes - at < segment ? bytes - at : segment;
        if (me > 0) comm_recv(c, me - 1, 0, x + at, m);
        if (me < p - 1) comm_send(c, me + 1, 0, x + at, m);
    }
    comm_stage(c, 1);
    const double sum = checksum(x);
    comm_publish(c, 0, me, 1, &sum);
}

/* One processor makes the copies of all ranks. */
static void serial(struct comm *c)
{
    unsigned char *x = comm_memory(c, bytes), *copy = comm_memory(c, bytes);
    for (int64_t i = 0; i < bytes; i++) x[i] = value(i);
    for (int rank = 0; rank < comm_run_size(c); rank++) {
        for (int64_t i = 0; i < bytes; i++) copy[i] = x[i];
        const double sum = checksum(copy);
        comm_publish(c, 0, rank, 1, &sum);
    }
}

PROGRAM(.title = "a broadcast along a chain of ranks, in segments",
        .parameter = {PROGRAM_SIZE(bytes, 1, 1e9, "length of the message"),
                      PROGRAM_SIZE(segment, 1, 1e9, "length of a segment")},
        .stage = {"chain", "checksum"}, .output = {"checksum"}, .run = run,
        .serial = {{"copies on one processor", serial}});
