/* blocks.c - local elimination around the reduction of the interface rows (blocks.h).
 *
 *     rank k-1            rank k                         rank k+1
 *     ..  o  o  e    |    o  o  o  o  e    |    o  o  ..      o: inside, e: interface, the last row
 *               '------- spike S -------'   how e of rank k couples to it once the o are gone
 *
 * eliminate_inside, couple, reduction of the e, back: physics 5.4 a. Time for m rows a rank: m - 1
 * times the elimination and the substitution, and the reduction of P rows (10.8). */
#include "kernel/blocks.h"

#include <string.h>

#include "kernel/scan.h"
#include "kernel/tags.h"

/* One function lays out the memory for four schemes; which buffers exist follows from solver and
 * rows. */
void blocks_carve(struct blocks *b, struct carve *c, const struct kernel_spec *spec,
                  const struct row_layout *layout, int rank, int m, bool keep)
{
    const int largest = layout->largest;
    b->rows.used = false;
    b->layout = layout;
    b->size = layout->size;
    b->nrow = layout->nrow;
    b->lo = layout->first[rank];
    b->hi = layout->first[rank + 1];
    b->m = m;
    b->keep = keep;
    b->d_stride = packed_size(largest);
    b->l_stride = largest * largest;
    b->r_stride = largest * m;
    b->factor_stride = block_factor_size(largest, largest, largest);
    const int rows = b->hi - b->lo;
    enum solver method = spec->solver;
    /* The partition method is this file's elimination with a reduction of the interface rows; every
     * solver but Thomas and those of all rows works like this, also with one row per rank. */
    if (method == SOLVER_PARTITION)
        method = spec->part_solver == PART_CR ? SOLVER_CR : SOLVER_PCR_SYMMETRIC;
    reduction_carve(&b->reduction, c, spec, method, layout, rank, m, keep);
    b->left = CARVE(c, largest * m, real);
    const bool all_rows = layout->nrow > layout->nrank &&
                          (spec->solver == SOLVER_PCR || spec->solver == SOLVER_PCR_SYMMETRIC);
    if (method == SOLVER_THOMAS) blocks_serial_carve(b, c, rank);
    if (all_rows) blocks_rows_carve(b, c);
    if (rows == 1 && !all_rows) { /* the reduction's own row, nothing is copied */
        b->D = b->reduction.D;
        b->r = b->reduction.r;
        b->L = reduction_left(&b->reduction);
        b->message = b->reduction.out_a; /* free until the reduction begins */
        return;
    }
    b->message = CARVE(c, block_update_size(largest, m) + largest * largest, real);
    b->D = CARVE(c, rows * b->d_stride, real);
    b->L = CARVE(c, rows * b->l_stride, real);
    b->r = CARVE(c, rows * b->r_stride, real);
    if (!all_rows) b->factor = CARVE(c, (rows - 1) * b->factor_stride, real);
}

/* transpose: out (n x m) from in (m x n). */
static void transpose(int m, int n, const real *in, real *out)
{
    for (int i = 0; i < m; i++)
        for (int j = 0; j < n; j++) out[j * m + i] = in[i * n + j];
}

/* add: sum += x, n elements; counted, as the receiver's work. */
static void add(int n, real *sum, const real *x, struct work *w)
{
    for (int i = 0; i < n; i++) sum[i] += x[i];
    w->flop += (uint64_t)n;
}

/* Orders of what a rank couples to: the row before its block, the last row of the next block. After
 * the elimination inside, these are neighbours in the interface system. */
static int order_left(const struct blocks *b) { return b->lo > 0 ? b->size[b->lo - 1] : 0; }
static int order_right(const struct blocks *b)
{
    return b->hi < b->nrow ? b->reduction.size[comm_rank(b->comm) + 1] : 0;
}

/* spread_nothing: a pivot failed; whatever follows is not a number, on every rank. No rank stops:
 * the others wait for its messages, and the schedule of messages must not depend on the data. */
static void spread_nothing(struct blocks *b, real *a_side, int na, real *b_side, int nb)
{
    b->broken = true;
    for (int i = 0; i < na; i++) a_side[i] = (real)__builtin_nan("");
    for (int i = 0; i < nb; i++) b_side[i] = (real)__builtin_nan("");
}

/* eliminate_inside: rows lo .. hi-2 by (5.3). The spike S, the coupling to the previous interface,
 * ends in place of the last row's L; `sum` collects what the previous interface row gets.
 *
 * Each row is eliminated towards its next row (b) and the previous interface row (a): 955 flops for
 * c = 5, against 405 of a serial factorisation, which has no previous interface. */
static void eliminate_inside(struct blocks *b, real *sum, struct work *w)
{
    const int m = b->m, cs = order_left(b);
    struct reduction *red = &b->reduction; /* its buffers are still free */
    const int nsum = block_update_size(cs, m);
    for (int i = 0; i < nsum; i++) sum[i] = 0;
    for (int i = b->lo; i < b->hi - 1; i++) {
        const int c = b->size[i], cn = b->size[i + 1];
        real up[BLOCK_FULL];
        /* U_i = L_{i+1}^T: the matrix is symmetric and only L is stored. */
        transpose(cn, c, blocks_row_L(b, i + 1), up);
        if (!block_row_eliminate(c, cs, cn, m, blocks_row_D(b, i), blocks_row_L(b, i), up,
                                 blocks_row_r(b, i), b->factor + (i - b->lo) * b->factor_stride,
                                 red->y, red->out_a, red->out_b, w))
            spread_nothing(b, red->out_a, nsum + cs * cn, red->out_b,
                           block_update_size(cn, m) + cs * cn);
        /* y replaces r: the substitution needs it, the right-hand side is used up. */
        memcpy(blocks_row_r(b, i), red->y, (size_t)(c * m) * sizeof(real));
        dense_subtract(packed_size(cn), blocks_row_D(b, i + 1), red->out_b, w);
        dense_subtract(cn * m, blocks_row_r(b, i + 1), red->out_b + packed_size(cn), w);
        /* Rank 0 has no interface to its left, hence no spike. */
        if (cs == 0) continue;
        memcpy(blocks_row_L(b, i + 1), red->out_b + block_update_size(cn, m),
               (size_t)(cn * cs) * sizeof(real));
        add(nsum, sum, red->out_a, w);
    }
}

/* couple: the local Schur complement to the left, the right neighbour's into D, r and U.
 *
 * One message per rank boundary, of 8 (c^2 + c(c+1)/2 + c m) bytes, or of 8 c^2 from a rank with
 * one row, whose L is then its coupling itself (physics 4.5, step 6). */
static void couple(struct blocks *b, struct work *w)
{
    struct comm *comm = b->comm;
    const int k = comm_rank(comm), P = comm_size(comm), m = b->m, rows = b->hi - b->lo;
    const int c = b->size[b->hi - 1], cs = order_left(b), cr = order_right(b);
    if (k > 0) { /* [S, dD, dr] */
        memcpy(b->message, blocks_row_L(b, b->hi - 1), (size_t)(c * cs) * sizeof(real));
        const int n = c * cs + (rows > 1 ? block_update_size(cs, m) : 0);
        comm_send(comm, k - 1, TAG_INTERFACE, b->message, n * (int64_t)sizeof(real));
    }
    if (k + 1 < P) {
        const int theirs = b->layout->first[k + 2] - b->hi;
        const int n = cr * c + (theirs > 1 ? block_update_size(c, m) : 0);
        comm_recv(comm, k + 1, TAG_INTERFACE, b->message, n * (int64_t)sizeof(real));
        /* U of the own interface row is the transpose of what the right neighbour calls its
         * spike. */
        transpose(cr, c, b->message, reduction_right(&b->reduction));
        if (theirs > 1) {
            dense_subtract(packed_size(c), b->reduction.D, b->message + cr * c, w);
            dense_subtract(c * m, b->reduction.r, b->message + cr * c + packed_size(c), w);
            work_report(comm, w);
        }
    }
}

/* back: the interface solution to the right, then the rows inside from the end (physics 5.4 a). */
static void back(struct blocks *b, struct work *w)
{
    struct comm *comm = b->comm;
    const int k = comm_rank(comm), P = comm_size(comm), m = b->m, c = b->size[b->hi - 1],
              cs = order_left(b);
    if (b->hi - b->lo > 1)
        memcpy(blocks_row_r(b, b->hi - 1), b->reduction.r, (size_t)(c * m) * sizeof(real));
    /* Sent before own rows are substituted, so that the neighbour can begin. */
    if (k + 1 < P) comm_send(comm, k + 1, TAG_BACK, b->reduction.r, c * m * (int64_t)sizeof(real));
    if (k > 0) comm_recv(comm, k - 1, TAG_BACK, b->left, cs * m * (int64_t)sizeof(real));
    for (int i = b->hi - 2; i >= b->lo; i--)
        block_row_resubstitute(b->size[i], cs, b->size[i + 1], m,
                               b->factor + (i - b->lo) * b->factor_stride, blocks_row_r(b, i),
                               b->left, blocks_row_r(b, i + 1), w);
    work_report(comm, w);
}

void blocks_solve(struct blocks *b, struct work *w)
{
    const int last = b->hi - 1, rows = b->hi - b->lo, c = b->size[last], cs = order_left(b);
    b->reduction.comm = b->comm;
    if (b->reduction.method == SOLVER_THOMAS) {
        blocks_serial_solve(b, false, w);
        return;
    }
    if (b->rows.used) {
        blocks_rows_solve(b, false, w);
        return;
    }
    /* Down to one row per rank, the rank's last. */
    if (rows > 1) {
        eliminate_inside(b, b->message + c * cs, w);
        /* The last row, changed by the elimination, is the rank's row of the interface system. */
        memcpy(b->reduction.D, blocks_row_D(b, last), (size_t)packed_size(c) * sizeof(real));
        memcpy(b->reduction.r, blocks_row_r(b, last), (size_t)(c * b->m) * sizeof(real));
        memcpy(reduction_left(&b->reduction), blocks_row_L(b, last),
               (size_t)(c * cs) * sizeof(real));
    }
    /* What has been computed is charged before the rank waits for others. */
    work_report(b->comm, w);
    couple(b, w);
    reduction_run(&b->reduction, TAG_REDUCE, w);
    b->broken = b->broken || b->reduction.broken;
    back(b, w);
}

/* The same steps as blocks_solve with the factors kept: S, L and U are known on both sides of every
 * boundary, so only vectors are sent: 8 c m bytes each. */
void blocks_resolve(struct blocks *b, struct work *w)
{
    struct comm *comm = b->comm;
    const int k = comm_rank(comm), P = comm_size(comm), m = b->m, rows = b->hi - b->lo,
              last = b->hi - 1;
    const int cs = order_left(b), c = b->size[last];
    struct reduction *red = &b->reduction;
    if (red->method == SOLVER_THOMAS) {
        blocks_serial_solve(b, true, w);
        return;
    }
    if (b->rows.used) {
        blocks_rows_solve(b, true, w);
        return;
    }
    /* The sum for the previous interface row, vectors only. */
    for (int i = 0; i < cs * m; i++) b->message[i] = 0;
    for (int i = b->lo; i < last; i++) {
        /* As eliminate_inside, for vectors: y for the way back, v for the next row and the
         * interface. */
        const int cn = b->size[i + 1];
        block_row_reduce(b->size[i], cs, cn, m, b->factor + (i - b->lo) * b->factor_stride,
                         blocks_row_r(b, i), red->y, red->out_a, red->out_b, w);
        memcpy(blocks_row_r(b, i), red->y, (size_t)(b->size[i] * m) * sizeof(real));
        dense_subtract(cn * m, blocks_row_r(b, i + 1), red->out_b, w);
        add(cs * m, b->message, red->out_a, w);
    }
    /* Inside eliminated: the last row's right-hand side is that of the interface row. */
    if (rows > 1) memcpy(red->r, blocks_row_r(b, last), (size_t)(c * m) * sizeof(real));
    work_report(comm, w);
    if (k > 0 && rows > 1)
        comm_send(comm, k - 1, TAG_INTERFACE, b->message, cs * m * (int64_t)sizeof(real));
    if (k + 1 < P && b->layout->first[k + 2] - b->hi > 1) {
        comm_recv(comm, k + 1, TAG_INTERFACE, b->message, c * m * (int64_t)sizeof(real));
        dense_subtract(c * m, red->r, b->message, w);
        work_report(comm, w);
    }
    /* The interface rows with the factors of the first solution, then back as before. */
    reduction_rerun(red, TAG_REDUCE, w);
    back(b, w);
}
