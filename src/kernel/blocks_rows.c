/* blocks_rows.c - parallel cyclic reduction with all rows of all ranks taking part (physics 5.4 b;
 * the textbook form is the conventional algorithm of the paper's figure 7).
 *
 * Step d couples row i with i-d and i+d. What rows send is written one behind the other in row
 * order, so that the part for each destination rank leaves as one message without being packed;
 * what they receive lies the same way. */
#include <string.h>

#include "kernel/blocks.h"
#include "kernel/scan.h"
#include "kernel/tags.h"

/* most: numbers that one row sends at most to one side: [L D U r], or a symmetric update and E. */
static int most(const struct blocks *b)
{
    const int largest = b->reduction.largest;
    return b->reduction.method == SOLVER_PCR ? 3 * largest * largest + largest * b->m
                                             : block_update_size(largest, b->m) + largest * largest;
}

static int steps(int n)
{
    int lg = 0;
    while ((1 << lg) < n) lg++;
    return lg;
}

/* The textbook's form sends the same row both ways, so that one outgoing buffer serves; but it
 * needs a second one in which the next step's rows grow. The symmetric form sends two different
 * updates. */
void blocks_rows_carve(struct blocks *b, struct carve *c)
{
    const int n = b->hi - b->lo, room = n * most(b);
    struct blocks_rows *to = &b->rows;
    to->used = true;
    to->textbook = b->reduction.method == SOLVER_PCR;
    to->out_a = CARVE(c, room, real);
    to->out_b = CARVE(c, to->textbook ? 0 : room, real);
    to->in_a = CARVE(c, room, real);
    to->in_b = CARVE(c, room, real);
    to->spare = CARVE(c, to->textbook ? room : 0, real);
    to->out_a_at = CARVE(c, n + 1, int);
    to->out_b_at = CARVE(c, n + 1, int);
    to->in_a_at = CARVE(c, n + 1, int);
    to->in_b_at = CARVE(c, n + 1, int);
    to->L = CARVE(c, n, real *);
    to->U = CARVE(c, n, real *);
    b->factor = CARVE(c, n * b->factor_stride * (b->keep ? steps(b->nrow) + 1 : 1), real);
}

/* order: of row i; 0 when there is none. */
static int order(const struct blocks *b, int i) { return i < 0 || i >= b->nrow ? 0 : b->size[i]; }

/* numbers: what row `from` sends to row `to` in the step of distance d. Sender and receiver both
 * call this, so that no message needs a header. */
static int numbers(const struct blocks *b, int from, int to, int d, bool again)
{
    const int c = order(b, from), other = from + (from - to); /* the row on the other side */
    if (again) return order(b, to) * b->m;
    if (!b->rows.textbook)
        return block_update_size(order(b, to), b->m) + order(b, to) * order(b, other);
    const int nl = order(b, from - d), nu = order(b, from + d);
    return c * (nl > 0 ? nl : c) + c * c + c * (nu > 0 ? nu : c) + c * b->m;
}

/* send_side: own rows' parts for the rows at distance `d` (signed), one message per owner. */
static void send_side(struct blocks *b, int d, const real *out, const int *at, int tag)
{
    /* Rows whose partner at distance d exists. Consecutive rows with partners on the same rank form
     * one message: at most two owners per step for equal blocks, since the block is shifted as a
     * whole. */
    const int k = comm_rank(b->comm);
    int i = b->lo > -d ? b->lo : -d;
    const int end = b->hi + d < b->nrow ? b->hi : b->nrow - d;
    while (i < end) {
        const int owner = row_owner(b->layout, i + d), stop = b->layout->first[owner + 1] - d;
        const int to = stop < end ? stop : end;
        if (owner != k)
            comm_send(b->comm, owner, tag, out + at[i - b->lo],
                      (at[to - b->lo] - at[i - b->lo]) * (int64_t)sizeof(real));
        i = to;
    }
}

/* receive_side: parts for own rows from the rows at distance `d` (signed: sources are row + d). Own
 * sources' parts are copied from `out`, and the copy is charged as memory traffic. Notes where each
 * row's part lies. */
static void receive_side(struct blocks *b, int d, const real *out, const int *out_at, real *in,
                         int *at, int tag, bool again)
{
    const int k = comm_rank(b->comm), distance = d < 0 ? -d : d;
    const int begin = b->lo > -d ? b->lo : -d, end = b->hi + d < b->nrow ? b->hi : b->nrow - d;
    int n = 0;
    for (int i = b->lo; i <= b->hi; i++) {
        at[i - b->lo] = n;
        if (i >= begin && i < end) n += numbers(b, i + d, i, distance, again);
    }
    for (int i = begin; i < end;) {
        const int owner = row_owner(b->layout, i + d), stop = b->layout->first[owner + 1] - d;
        const int to = stop < end ? stop : end, from = at[i - b->lo], size = at[to - b->lo] - from;
        if (owner != k) {
            comm_recv(b->comm, owner, tag, in + from, size * (int64_t)sizeof(real));
        } else {
            memcpy(in + from, out + out_at[i + d - b->lo], (size_t)size * sizeof(real));
            b->rows.work->bytes += (uint64_t)size * sizeof(real);
        }
        i = to;
    }
}

/* transposed_above: U of own rows: the transpose of the next row's L, by message from the next rank
 * for the last. in_b is free until the first step and keeps U; out_a takes the message. */
static void transposed_above(struct blocks *b)
{
    struct blocks_rows *s = &b->rows;
    const int k = comm_rank(b->comm), n = b->hi - b->lo;
    if (k > 0)
        comm_send(b->comm, k - 1, TAG_INTERFACE, blocks_row_L(b, b->lo),
                  order(b, b->lo) * order(b, b->lo - 1) * (int64_t)sizeof(real));
    for (int i = b->lo; i < b->hi; i++) {
        const int c = order(b, i), above = order(b, i + 1);
        const real *L = s->out_a;
        s->L[i - b->lo] = blocks_row_L(b, i);
        real *U = s->U[i - b->lo] = s->in_b + (i - b->lo) * b->l_stride;
        if (i == b->nrow - 1) break;
        if (i - b->lo < n - 1) L = blocks_row_L(b, i + 1);
        else comm_recv(b->comm, k + 1, TAG_INTERFACE, s->out_a, c * above * (int64_t)sizeof(real));
        for (int r = 0; r < above; r++)
            for (int j = 0; j < c; j++) U[j * above + r] = L[r * c + j];
    }
}

/* eliminate: all own rows towards both sides (again: their right-hand sides only). Every row is
 * eliminated in every step: n log2 n eliminations instead of n, in exchange for log2 n steps
 * without a way back (physics 5.4 b). */
static void eliminate(struct blocks *b, int d, int slot, bool again, struct work *w)
{
    struct blocks_rows *s = &b->rows;
    const int n = b->hi - b->lo;
    int at_a = 0, at_b = 0;
    for (int i = b->lo; i < b->hi; i++) {
        const int at = i - b->lo, nl = order(b, i - d), nu = order(b, i + d);
        /* With `keep` each step has factors of its own, else the next step writes over them. */
        real *factor = b->factor + ((b->keep ? slot * n : 0) + at) * b->factor_stride;
        s->out_a_at[at] = at_a, s->out_b_at[at] = at_b;
        if (again)
            block_row_reduce(b->size[i], nl, nu, b->m, factor, blocks_row_r(b, i), b->reduction.y,
                             s->out_a + at_a, s->out_b + at_b, w);
        else if (!block_row_eliminate(b->size[i], nl, nu, b->m, blocks_row_D(b, i), s->L[at],
                                      s->U[at], blocks_row_r(b, i), factor, b->reduction.y,
                                      s->out_a + at_a, s->out_b + at_b, w))
            b->broken = true;
        if (i - d >= 0) at_a += numbers(b, i, i - d, d, again);
        if (i + d < b->nrow) at_b += numbers(b, i, i + d, d, again);
    }
    s->out_a_at[n] = at_a, s->out_b_at[n] = at_b;
    /* A failed pivot spreads in everything that this rank sends (blocks.c, spread_nothing). */
    for (int k = 0; k < at_a && b->broken; k++) s->out_a[k] = (real)__builtin_nan("");
    for (int k = 0; k < at_b && b->broken; k++) s->out_b[k] = (real)__builtin_nan("");
}

/* apply: D -= S, r -= v from one side; the new coupling is what lies behind, and stays there until
 * the next step has used it. */
static void apply(struct blocks *b, int d, real *in, const int *at, real **coupling, bool again,
                  struct work *w)
{
    for (int i = b->lo; i < b->hi; i++) {
        if (i + d < 0 || i + d >= b->nrow) continue;
        const int c = b->size[i], packed = again ? 0 : packed_size(c);
        real *update = in + at[i - b->lo];
        if (!again) {
            dense_subtract(packed, blocks_row_D(b, i), update, w);
            coupling[i - b->lo] = update + packed + c * b->m;
        }
        dense_subtract(c * b->m, blocks_row_r(b, i), update + packed, w);
    }
    work_report(b->comm, w);
}

/* finish: the rows stand alone: D x = r for each. */
static void finish(struct blocks *b, int slot, bool again, struct work *w)
{
    const int n = b->hi - b->lo;
    for (int i = b->lo; i < b->hi; i++) {
        real *factor = b->factor + ((b->keep ? slot * n : 0) + i - b->lo) * b->factor_stride;
        if (!again && !dense_factor(b->size[i], blocks_row_D(b, i), factor, w)) b->broken = true;
        dense_solve(b->size[i], b->m, factor, blocks_row_r(b, i), w);
        for (int k = 0; k < b->size[i] * b->m && b->broken; k++)
            blocks_row_r(b, i)[k] = (real)__builtin_nan("");
    }
    work_report(b->comm, w);
}

/* pass_on: the last own row's solution to the right, the row's before the block from the left. The
 * assembly of accelerations needs it (physics 4.5, steps 8 and 9). */
static void pass_on(struct blocks *b)
{
    const int k = comm_rank(b->comm);
    const int64_t size = b->m * (int64_t)sizeof(real);
    if (b->hi < b->nrow)
        comm_send(b->comm, k + 1, TAG_BACK, blocks_row_r(b, b->hi - 1), order(b, b->hi - 1) * size);
    if (b->lo > 0) comm_recv(b->comm, k - 1, TAG_BACK, b->left, order(b, b->lo - 1) * size);
}

static void symmetric(struct blocks *b, bool again, struct work *w)
{
    struct blocks_rows *s = &b->rows;
    int slot = 0;
    /* Both sides are sent before anything is received: with buffered sends no rank waits in a
     * circle. The order of receiving fixes the order of additions, hence the bits of the result. */
    for (int d = 1; d < b->nrow; d *= 2, slot++) {
        eliminate(b, d, slot, again, w);
        work_report(b->comm, w);
        send_side(b, d, s->out_b, s->out_b_at, TAG_REDUCE + slot);
        send_side(b, -d, s->out_a, s->out_a_at, TAG_REDUCE + slot);
        receive_side(b, -d, s->out_b, s->out_b_at, s->in_a, s->in_a_at, TAG_REDUCE + slot, again);
        apply(b, -d, s->in_a, s->in_a_at, s->L, again, w);
        receive_side(b, d, s->out_a, s->out_a_at, s->in_b, s->in_b_at, TAG_REDUCE + slot, again);
        apply(b, d, s->in_b, s->in_b_at, s->U, again, w);
    }
    finish(b, slot, again, w);
}

/* textbook_begin: own rows as [L D U r], one behind the other. Blocks are full squares: the
 * textbook does not use symmetry. */
static void textbook_begin(struct blocks *b)
{
    struct blocks_rows *s = &b->rows;
    int at = 0;
    for (int i = b->lo; i < b->hi; i++) {
        struct textbook_row row =
            textbook_row_at(s->spare + at, b->size[i], order(b, i - 1), order(b, i + 1));
        s->out_a_at[i - b->lo] = at;
        at += numbers(b, i, i + 1, 1, false);
        memcpy(row.L, s->L[i - b->lo], (size_t)(row.c * row.nl) * sizeof(real));
        memcpy(row.U, s->U[i - b->lo], (size_t)(row.c * row.nu) * sizeof(real));
        for (int r = 0; r < row.c; r++)
            for (int j = 0; j <= r; j++)
                row.D[r * row.c + j] = row.D[j * row.c + r] =
                    blocks_row_D(b, i)[packed_index(r, j)];
        memcpy(row.r, blocks_row_r(b, i), (size_t)(row.c * b->m) * sizeof(real));
    }
    s->out_a_at[b->hi - b->lo] = at;
    real *swap = s->out_a;
    s->out_a = s->spare;
    s->spare = swap;
}

/* textbook_step: every own row from itself and its two neighbours at distance d, into the spare
 * rows (physics 5.3 i). Both neighbours' D are inverted here and by every other row that couples to
 * them. */
static void textbook_step(struct blocks *b, int d, struct work *w)
{
    struct blocks_rows *s = &b->rows;
    int at = 0;
    for (int i = b->lo; i < b->hi; i++) {
        const int c = b->size[i];
        real L[BLOCK_FULL], U[BLOCK_FULL];
        struct textbook_row row =
            textbook_row_at(s->out_a + s->out_a_at[i - b->lo], c, order(b, i - d), order(b, i + d));
        /* Left: alpha = L D_a^-1; its U leads back to this row, its L on to row i - 2d. */
        if (i - d >= 0) {
            struct textbook_row v =
                textbook_row_at(s->in_a + s->in_a_at[i - b->lo], row.nl, order(b, i - 2 * d), c);
            if (!textbook_row_fold(&row, row.L, &v, v.U, v.L, v.nl, L, b->m, w)) b->broken = true;
        }
        /* Right: gamma = U D_b^-1, mirrored. */
        if (i + d < b->nrow) {
            struct textbook_row v =
                textbook_row_at(s->in_b + s->in_b_at[i - b->lo], row.nu, c, order(b, i + 2 * d));
            if (!textbook_row_fold(&row, row.U, &v, v.L, v.U, v.nu, U, b->m, w)) b->broken = true;
        }
        /* The row changes its neighbours, and with their orders the size of its blocks. */
        struct textbook_row next =
            textbook_row_at(s->spare + at, c, order(b, i - 2 * d), order(b, i + 2 * d));
        memcpy(next.L, L, (size_t)(c * next.nl) * sizeof(real));
        memcpy(next.U, U, (size_t)(c * next.nu) * sizeof(real));
        memcpy(next.D, row.D, (size_t)(c * c) * sizeof(real));
        memcpy(next.r, row.r, (size_t)(c * b->m) * sizeof(real));
        at += numbers(b, i, i + 2 * d, 2 * d, false);
    }
    /* Offsets are noted only now: the loop above read those of the step before. */
    for (int i = b->lo, sum = 0; i <= b->hi; i++) {
        s->out_a_at[i - b->lo] = sum;
        if (i < b->hi) sum += numbers(b, i, i + 2 * d, 2 * d, false);
    }
    real *swap = s->out_a;
    s->out_a = s->spare;
    s->spare = swap;
}

static void textbook(struct blocks *b, struct work *w)
{
    struct blocks_rows *s = &b->rows;
    textbook_begin(b);
    for (int d = 1, slot = 0; d < b->nrow; d *= 2, slot++) {
        work_report(b->comm, w);
        send_side(b, d, s->out_a, s->out_a_at, TAG_REDUCE + slot);
        send_side(b, -d, s->out_a, s->out_a_at, TAG_REDUCE + slot);
        receive_side(b, -d, s->out_a, s->out_a_at, s->in_a, s->in_a_at, TAG_REDUCE + slot, false);
        receive_side(b, d, s->out_a, s->out_a_at, s->in_b, s->in_b_at, TAG_REDUCE + slot, false);
        textbook_step(b, d, w);
    }
    /* Each row stands alone: x = D^-1 r, by an inverse again. */
    for (int i = b->lo; i < b->hi; i++) {
        const int c = b->size[i];
        struct textbook_row row = textbook_row_at(s->out_a + s->out_a_at[i - b->lo], c, 0, 0);
        if (!dense_invert(c, row.D, w)) b->broken = true;
        dense_product(c, b->m, c, row.D, row.r, blocks_row_r(b, i), w);
        for (int k = 0; k < c * b->m && b->broken; k++)
            blocks_row_r(b, i)[k] = (real)__builtin_nan("");
    }
    work_report(b->comm, w);
}

/* What the first call leaves in factors is enough for `again`; the textbook's form keeps
 * nothing. */
void blocks_rows_solve(struct blocks *b, bool again, struct work *w)
{
    b->rows.work = w;
    if (!again) transposed_above(b);
    if (b->rows.textbook) textbook(b, w);
    else symmetric(b, again, w);
    pass_on(b);
}
