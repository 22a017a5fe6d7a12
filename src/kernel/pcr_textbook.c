/* pcr_textbook.c - parallel cyclic reduction as in the textbooks (physics 5.3 i): every rank sends
 * its whole row both ways, every receiver inverts its neighbours' diagonal blocks itself.
 *
 *     alpha = L D_a^-1, gamma = U D_b^-1,  D -= alpha U_a + gamma L_b,  r -= alpha r_a + gamma r_b,
 *     new L = -alpha L_a, new U = -gamma U_b
 *
 * A row is the numbers [L D U r]; where there is no neighbour its block takes the row's own order,
 * as in a code that sends fixed rows. */
#include "kernel/scan.h"
#include "kernel/reduction.h"

#include <string.h>

/* Blocks lie in the order in which they are sent, so that a row is its own message. */
struct textbook_row textbook_row_at(real *base, int c, int nl, int nu)
{
    struct textbook_row v = {.c = c, .nl = nl, .nu = nu, .L = base};
    v.D = v.L + c * (nl > 0 ? nl : c);
    v.U = v.D + c * c;
    v.r = v.U + c * (nu > 0 ? nu : c);
    return v;
}

static int row_size(const struct textbook_row *v, int m) { return (int)(v->r - v->L) + v->c * m; }

/* orders: of the rows at `distance` from rank k; 0 where there is none. */
static void orders(const struct reduction *s, int k, int distance, int *nl, int *nu)
{
    *nl = k >= distance ? s->size[k - distance] : 0;
    *nu = k + distance < comm_size(s->comm) ? s->size[k + distance] : 0;
}

/* One call for each side; the names of the paper: alpha on the left, gamma on the right, both
 * `alpha` here. The neighbour's D is inverted in place, in the receiver's copy of its row. */
bool textbook_row_fold(struct textbook_row *row, const real *K, struct textbook_row *v,
                       const real *back, const real *onward, int norder, real *next, int m,
                       struct work *w)
{
    real alpha[BLOCK_FULL], product[BLOCK_FULL];
    const int c = row->c;
    if (!dense_invert(v->c, v->D, w)) return false;
    dense_product(c, v->c, v->c, K, v->D, alpha, w);
    dense_product(c, c, v->c, alpha, back, product, w);
    dense_subtract(c * c, row->D, product, w);
    for (int l = 0; l < m; l++) /* column by column: m may be larger than a block */
        for (int i = 0; i < c; i++) {
            real sum = 0;
            for (int k = 0; k < v->c; k++) sum += alpha[i * v->c + k] * v->r[k * m + l];
            row->r[i * m + l] -= sum;
        }
    /* The same tally as dense_product makes, for the loop above. */
    w->flop += (uint64_t)(dense_product_flops(c, m, v->c) + c * m);
    dense_product(c, norder, v->c, alpha, onward, next, w);
    for (int i = 0; i < c * norder; i++) next[i] = -next[i];
    return true;
}

/* begin: the row in its first form, out of where the assembly put its blocks. */
static struct textbook_row begin(struct reduction *s)
{
    int nl, nu;
    orders(s, comm_rank(s->comm), 1, &nl, &nu);
    struct textbook_row row = textbook_row_at(s->out_a, s->c, nl, nu);
    memcpy(row.L, reduction_left(s), (size_t)(s->c * nl) * sizeof(real));
    memcpy(row.U, reduction_right(s), (size_t)(s->c * nu) * sizeof(real));
    for (int i = 0; i < s->c; i++)
        for (int j = 0; j <= i; j++)
            row.D[i * s->c + j] = row.D[j * s->c + i] = s->D[packed_index(i, j)];
    memcpy(row.r, s->r, (size_t)(s->c * s->m) * sizeof(real));
    return row;
}

/* next_row: lay out the row for its neighbours at the next distance: D and r move, L and U come in.
 * The two outgoing buffers take turns. */
static struct textbook_row next_row(struct reduction *s, const struct textbook_row *row, int nl,
                                    int nu, const real *L, const real *U)
{
    struct textbook_row next = textbook_row_at(s->out_b, s->c, nl, nu);
    memcpy(next.L, L, (size_t)(s->c * nl) * sizeof(real));
    memcpy(next.U, U, (size_t)(s->c * nu) * sizeof(real));
    memcpy(next.D, row->D, (size_t)(s->c * s->c) * sizeof(real));
    memcpy(next.r, row->r, (size_t)(s->c * s->m) * sizeof(real));
    real *swap = s->out_a;
    s->out_a = s->out_b;
    s->out_b = swap;
    return next;
}

void pcr_textbook_run(struct reduction *s, int tag, struct work *w)
{
    struct comm *comm = s->comm;
    const int P = comm_size(comm), k = comm_rank(comm), m = s->m;
    struct textbook_row row = begin(s);
    bool sound = true;
    work_report(comm, w);
    for (int d = 1, slot = 0; d < P; d *= 2, slot++) {
        real L[BLOCK_FULL], U[BLOCK_FULL];
        int far_a = 0, far_b = 0, unused;
        const int64_t bytes = row_size(&row, m) * (int64_t)sizeof(real);
        /* The whole row, both ways, before it changes: 8 (3 c^2 + c m) bytes (physics 5.3 i). */
        if (k + d < P) comm_send(comm, k + d, tag + slot, row.L, bytes);
        if (k >= d) comm_send(comm, k - d, tag + slot, row.L, bytes);
        if (k >= d) {
            orders(s, k - d, d, &far_a, &unused);
            struct textbook_row v = textbook_row_at(s->in_a, row.nl, far_a, s->c);
            comm_recv(comm, k - d, tag + slot, s->in_a, row_size(&v, m) * (int64_t)sizeof(real));
            sound = textbook_row_fold(&row, row.L, &v, v.U, v.L, far_a, L, m, w) && sound;
            work_report(comm, w);
        }
        if (k + d < P) {
            orders(s, k + d, d, &unused, &far_b);
            struct textbook_row v = textbook_row_at(s->in_b, row.nu, s->c, far_b);
            comm_recv(comm, k + d, tag + slot, s->in_b, row_size(&v, m) * (int64_t)sizeof(real));
            sound = textbook_row_fold(&row, row.U, &v, v.L, v.U, far_b, U, m, w) && sound;
            work_report(comm, w);
        }
        row = next_row(s, &row, far_a, far_b, L, U);
    }
    /* Alone at last: x = D^-1 r. The textbook inverts where a factorisation would do. */
    sound = dense_invert(s->c, row.D, w) && sound;
    /* The monitor expects inverse pivots; the diagonal of D^-1 is the nearest thing to them
     * here. */
    for (int i = 0; i < s->c; i++) s->factor[packed_index(i, i)] = row.D[i * s->c + i];
    s->last = s->factor;
    dense_product(s->c, m, s->c, row.D, row.r, s->r, w);
    /* No pivot test on the way: an inversion that failed leaves numbers without meaning in the
     * row. */
    if (!sound) reduction_break(s, 0, 0);
}
