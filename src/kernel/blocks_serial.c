/* blocks_serial.c - block Thomas on rank 0: every other rank sends its rows there and gets its
 * solution back. */
#include <string.h>

#include "kernel/blocks.h"
#include "kernel/scan.h"
#include "kernel/tags.h"
#include "linalg/block_tridiag.h"

/* Rank 0 holds the whole system. One buffer for messages is enough: they are received one by
 * one. */
void blocks_serial_carve(struct blocks *b, struct carve *c, int rank)
{
    if (rank != 0) {
        const int rows = b->hi - b->lo;
        b->gathered = CARVE(c, rows * (b->d_stride + b->l_stride + b->r_stride), real);
        return;
    }
    /* Blocks of the whole system have the maximal size, as block_tridiag expects them. */
    real *D = CARVE(c, (size_t)b->nrow * BLOCK_PACKED, real),
         *L = CARVE(c, (size_t)b->nrow * BLOCK_FULL, real);
    b->x = CARVE(c, (size_t)b->nrow * BLOCK_MAX * b->m, real);
    int most = 0; /* a message holds the largest block and the row before it */
    for (int k = 0; k < b->layout->nrank; k++) {
        const int rows = b->layout->first[k + 1] - b->layout->first[k] + 1;
        most = rows > most ? rows : most;
    }
    b->gathered = CARVE(c, most * (b->d_stride + b->l_stride + b->r_stride), real);
    b->whole = (struct block_tridiag){.nrow = b->nrow, .size = b->size, .D = D, .L = L};
}

/* A place for rows: where their D, L, r begin, and how many numbers apart two of them lie. */
struct place {
    real *D, *L, *r;
    int d_stride, l_stride, r_stride;
};

/* pack: rows from .. to-1 from a place into a message; returns the number of elements. D and L go
 * only with the first solution, later right-hand sides find the factors on rank 0. */
static int pack(const struct blocks *b, int from, int to, const struct place *p, bool again,
                real *message)
{
    int n = 0;
    for (int i = from; i < to; i++) {
        const int c = b->size[i], before = i > 0 ? b->size[i - 1] : 0, at = i - from;
        if (!again) {
            memcpy(message + n, p->D + (size_t)at * p->d_stride,
                   (size_t)packed_size(c) * sizeof(real));
            n += packed_size(c);
            memcpy(message + n, p->L + (size_t)at * p->l_stride,
                   (size_t)(c * before) * sizeof(real));
            n += c * before;
        }
        memcpy(message + n, p->r + (size_t)at * p->r_stride, (size_t)(c * b->m) * sizeof(real));
        n += c * b->m;
    }
    return n;
}

/* The inverse of pack. */
static int unpack(const struct blocks *b, int from, int to, const struct place *p, bool again,
                  const real *message)
{
    int n = 0;
    for (int i = from; i < to; i++) {
        const int c = b->size[i], before = i > 0 ? b->size[i - 1] : 0, at = i - from;
        if (!again) {
            memcpy(p->D + (size_t)at * p->d_stride, message + n,
                   (size_t)packed_size(c) * sizeof(real));
            n += packed_size(c);
            memcpy(p->L + (size_t)at * p->l_stride, message + n,
                   (size_t)(c * before) * sizeof(real));
            n += c * before;
        }
        memcpy(p->r + (size_t)at * p->r_stride, message + n, (size_t)(c * b->m) * sizeof(real));
        n += c * b->m;
    }
    return n;
}

/* numbers: in a message of rows from .. to-1. */
static int numbers(const struct blocks *b, int from, int to, bool again)
{
    int n = 0;
    for (int i = from; i < to; i++) {
        const int c = b->size[i], before = i > 0 ? b->size[i - 1] : 0;
        n += c * b->m + (again ? 0 : packed_size(c) + c * before);
    }
    return n;
}

/* own_place, whole_place: where a rank's rows lie in its blocks, and in rank 0's system. */
static struct place own_place(const struct blocks *b)
{
    return (struct place){b->D, b->L, b->r, b->d_stride, b->l_stride, b->r_stride};
}
static struct place whole_place(const struct blocks *b, int from)
{
    const int stride = BLOCK_MAX * b->m;
    return (struct place){b->whole.D + (size_t)from * BLOCK_PACKED,
                          b->whole.L + (size_t)from * BLOCK_FULL,
                          b->x + (size_t)from * stride,
                          BLOCK_PACKED,
                          BLOCK_FULL,
                          stride};
}

/* solve_whole: rank 0 receives all rows, solves, and sends the solutions with the row before each
 * block in front.
 *
 * The reference for parallel solvers: least work (480 flops a row for c = 5, physics 5.1), all of
 * it on one rank, and 2 (P - 1) messages through one node. */
static void solve_whole(struct blocks *b, bool again, struct work *w)
{
    struct comm *comm = b->comm;
    const int P = comm_size(comm);
    struct place own = own_place(b), to = whole_place(b, 0);
    /* Own rows take the same way, without a message. */
    pack(b, b->lo, b->hi, &own, again, b->gathered);
    unpack(b, b->lo, b->hi, &to, again, b->gathered);
    /* Ranks in order: receiving whoever comes first would save nothing, since the solution needs
     * all. */
    for (int k = 1; k < P; k++) {
        const int from = b->layout->first[k], end = b->layout->first[k + 1];
        comm_recv(comm, k, TAG_GATHER, b->gathered,
                  numbers(b, from, end, again) * (int64_t)sizeof(real));
        to = whole_place(b, from);
        const int n = unpack(b, from, end, &to, again, b->gathered);
        w->bytes += (uint64_t)n * sizeof(real);
    }
    if (!again && block_tridiag_factor(&b->whole, w) >= 0) b->broken = true;
    block_tridiag_solve(&b->whole, b->m, b->x, w);
    if (b->broken)
        /* A failed pivot: all solutions become "not a number", so that every rank sees it. */
        for (size_t i = 0; i < (size_t)b->nrow * BLOCK_MAX * (size_t)b->m; i++)
            b->x[i] = (real)__builtin_nan("");
    work_report(comm, w);
    for (int k = 1; k < P; k++) {
        /* One row more in front: the next operation of each rank needs the solution beside its
         * block. */
        const int from = b->layout->first[k] - 1, end = b->layout->first[k + 1];
        const struct place at = whole_place(b, from);
        const int n = pack(b, from, end, &at, true, b->gathered);
        w->bytes += (uint64_t)n * sizeof(real);
        work_report(comm, w);
        comm_send(comm, k, TAG_GATHER + 1, b->gathered, n * (int64_t)sizeof(real));
    }
    const struct place at = whole_place(b, 0);
    pack(b, b->lo, b->hi, &at, true, b->gathered);
    unpack(b, b->lo, b->hi, &own, true, b->gathered);
}

void blocks_serial_solve(struct blocks *b, bool again, struct work *w)
{
    struct comm *comm = b->comm;
    if (comm_rank(comm) == 0) {
        solve_whole(b, again, w);
        return;
    }
    const struct place own = own_place(b);
    const int n = pack(b, b->lo, b->hi, &own, again, b->gathered);
    w->bytes += (uint64_t)n * sizeof(real);
    work_report(comm, w);
    comm_send(comm, 0, TAG_GATHER, b->gathered, n * (int64_t)sizeof(real));
    const int before = b->size[b->lo - 1] * b->m;
    comm_recv(comm, 0, TAG_GATHER + 1, b->gathered,
              (before + numbers(b, b->lo, b->hi, true)) * (int64_t)sizeof(real));
    memcpy(b->left, b->gathered, (size_t)before * sizeof(real));
    unpack(b, b->lo, b->hi, &own, true, b->gathered + before);
}
