/* scan.c - recursive doubling over ranks (scan.h).
 *
 * P = 8, incoming form; an arrow is one message of v (48 bytes), with T (96 bytes) where marked:
 *
 *     step 0, d = 1   0 -> 1 =T> 2 =T> 3 =T> 4 =T> 5 =T> 6 =T> 7
 *     step 1, d = 2   0 -> 2   1 -> 3   2 =T> 4   3 =T> 5   4 =T> 6   5 =T> 7
 *     step 2, d = 4   0 -> 4   1 -> 5   2 -> 6   3 -> 7
 *
 * After step j rank k holds the sum over the ranks k - 2^(j+1) + 1 .. k; a sender below 2^j has no
 * T^(j). For P = 2^lg a scan has P lg - P + 1 messages, of which P lg - 2 (P - 1) carry a T
 * (physics 3.1). */
#include "kernel/scan.h"

#include <string.h>

#include "linalg/dense.h"

enum { SCREW_BYTES = SPACE * (int)sizeof(real) };

/* Dense operators are general 6 x 6 products: what the paper's code does, and 66 flops instead of
 * 42 (physics 1.2). Results go by way of g, because a product may not write over its argument. */
void transform_force(bool dense, real *y, const real *T, const real *f, struct work *w)
{
    if (dense) {
        real g[SPACE];
        dense_product(SPACE, 1, SPACE, T, f, g, w);
        screw_copy(y, g);
        return;
    }
    xform_force(y, (const struct xform *)T, f);
    w->flop += XFORM_FORCE_FLOP;
    w->call++;
}

void transform_motion(bool dense, real *y, const real *T, const real *v, struct work *w)
{
    if (dense) {
        real g[SPACE];
        dense_product_tn(SPACE, 1, SPACE, T, v, g, w);
        screw_copy(y, g);
        return;
    }
    xform_motion(y, (const struct xform *)T, v);
    w->flop += XFORM_MOTION_FLOP;
    w->call++;
}

/* A base that does not turn has only [0; a]: the rotation of one 3-vector. */
void transform_base(bool dense, bool slides, real *y, const real *T, const real *v, struct work *w)
{
    if (dense || !slides) {
        transform_motion(dense, y, T, v, w);
        return;
    }
    xform_slide(y, (const struct xform *)T, v);
    w->flop += XFORM_SLIDE_FLOP;
    w->call++;
}

void transform_compose(bool dense, real *c, const real *a, const real *b, struct work *w)
{
    if (dense) {
        dense_product(SPACE, SPACE, SPACE, a, b, c, w);
        return;
    }
    xform_compose((struct xform *)c, (const struct xform *)a, (const struct xform *)b);
    w->flop += XFORM_COMPOSE_FLOP;
    w->call++;
}

/* The paper's transform is a product of a shift and a rotation; a code that multiplies them out for
 * every joint pays for it, so this one is counted too. */
void transform_expand(bool dense, real *T, const struct xform *x, struct work *w)
{
    if (!dense) {
        memcpy(T, x, sizeof *x);
        return;
    }
    real shift[SQUARE] = {0}, turn[SQUARE] = {0};
    xform_factors(x, shift, turn);
    dense_product(SPACE, SPACE, SPACE, shift, turn, T, w);
}

/* levels: transforms that a rank with `before` ranks on its composites' side ever holds. */
static int levels(int before)
{
    int n = 0;
    for (int d = 1; d <= before; d *= 2) n++;
    return n;
}

/* Rank k of the incoming form holds levels with 2^j <= k, of the outgoing one levels with 2^j <= P
 * - 1 - k: at most ceil(log2 P) transforms of 96 bytes (288 as matrices). */
void scan_carve(struct scan *s, struct carve *c, bool dense, bool incoming, int rank, int nrank)
{
    s->dense = dense;
    s->incoming = incoming;
    s->size = dense ? SQUARE : XFORM_NUMBERS;
    /* One vector more than the transforms, since v follows the newest transform in the first
     * scan. */
    s->level = CARVE(c, s->size * levels(incoming ? rank : nrank - 1 - rank) + SPACE, real);
    s->in = CARVE(c, s->size + SPACE, real);
}

/* add_motion: v += T^T u. */
static void add_motion(struct scan *s, real *v, const real *T, const real *u, struct work *w)
{
    real moved[SPACE];
    transform_motion(s->dense, moved, T, u, w);
    screw_add(v, moved);
    w->flop += SCREW_ADD_FLOP;
}

/* first_incoming: composites first, then v right behind the newest one, so that both leave as one
 * message without being packed.
 *
 * The message from k-d carries T_{k-d} only if that rank has one at this level (k >= 2d). Values
 * are those from before the step: both are sent before they are updated (physics 3.1). */
static void first_incoming(struct scan *s, int tag, real *v, struct work *w)
{
    struct comm *c = s->comm;
    const int k = comm_rank(c), P = comm_size(c), size = s->size;
    const int pair = (size + SPACE) * (int)sizeof(real);
    real *now = s->level + (k > 0 ? size : 0); /* where v lives */
    screw_copy(now, v);
    work_report(c, w);
    for (int d = 1, j = 0; d < P; d *= 2, j++) {
        real *T = s->level + j * size;
        /* A composite reaches d ranks to the left; below rank d there is none to send. */
        if (k + d < P) {
            if (k >= d) comm_send(c, k + d, tag + j, T, pair);
            else comm_send(c, k + d, tag + j, now, SCREW_BYTES);
        }
        if (k < d) continue;
        /* v moves up behind the new level first, because T^(j+1) is written where v was. physics
         * (3.1), then (3.2). */
        if (k >= 2 * d) {
            comm_recv(c, k - d, tag + j, s->in, pair);
            real *next = now + size;
            screw_copy(next, now);
            add_motion(s, next, T, s->in + size, w);
            transform_compose(s->dense, T + size, s->in, T, w);
            now = next;
        } else {
            /* Rank k - d starts the chain: v is final here, and no composite reaches further. */
            comm_recv(c, k - d, tag + j, s->in, SCREW_BYTES);
            add_motion(s, now, T, s->in, w);
        }
        work_report(c, w);
    }
    screw_copy(v, now);
}

/* first_outgoing: physics (3.4). Transforms travel to the left with tags after those of the
 * vectors: a phase has TAG_STEP = 64 tags and at most 31 steps. */
static void first_outgoing(struct scan *s, int tag, real *v, struct work *w)
{
    struct comm *c = s->comm;
    const int k = comm_rank(c), P = comm_size(c), size = s->size;
    const int transform_tag = tag + 32;
    for (int d = 1, j = 0; d < P; d *= 2, j++) {
        real *T = s->level + j * size;
        /* The sender projects: only it holds the transform from its frame to frame k+d. */
        if (k + d < P) {
            transform_motion(s->dense, s->in, T, v, w);
            work_report(c, w);
            comm_send(c, k + d, tag + j, s->in, SCREW_BYTES);
            if (k >= d) comm_send(c, k - d, transform_tag + j, T, size * (int)sizeof(real));
        }
        if (k >= d) {
            comm_recv(c, k - d, tag + j, s->in, SCREW_BYTES);
            screw_add(v, s->in);
            w->flop += SCREW_ADD_FLOP;
            work_report(c, w);
        }
        /* The composite that ends at k + d continues this one; it is needed only if somebody lies
         * behind. */
        if (k + 2 * d < P) {
            comm_recv(c, k + d, transform_tag + j, s->in, size * (int)sizeof(real));
            transform_compose(s->dense, T + size, T, s->in, w);
            work_report(c, w);
        }
    }
}

void scan_first(struct scan *s, int tag, real *v, struct work *w)
{
    if (s->incoming) first_incoming(s, tag, v, w);
    else first_outgoing(s, tag, v, w);
}

/* Vectors only: the composites of scan_first are valid as long as the coordinates are. */
void scan_motion(struct scan *s, int tag, real *v, struct work *w)
{
    struct comm *c = s->comm;
    const int k = comm_rank(c), P = comm_size(c);
    work_report(c, w);
    for (int d = 1, j = 0; d < P; d *= 2, j++) {
        const real *T = s->level + j * s->size;
        if (k + d < P) {
            /* Outgoing composites belong to the sender, incoming ones to the receiver. */
            if (!s->incoming) {
                transform_motion(s->dense, s->in, T, v, w);
                work_report(c, w);
            }
            /* The value before this step's update, as in the first scan. */
            comm_send(c, k + d, tag + j, s->incoming ? v : s->in, SCREW_BYTES);
        }
        if (k < d) continue;
        comm_recv(c, k - d, tag + j, s->in, SCREW_BYTES);
        if (s->incoming) {
            add_motion(s, v, T, s->in, w);
        } else {
            screw_add(v, s->in);
            w->flop += SCREW_ADD_FLOP;
        }
        work_report(c, w);
    }
}

/* Mirror image of scan_motion: the same composites, transposed, carry forces the other way. physics
 * (3.3): no matrix is ever sent here. */
void scan_force(struct scan *s, int tag, real *f, struct work *w)
{
    struct comm *c = s->comm;
    const int k = comm_rank(c), P = comm_size(c);
    work_report(c, w);
    for (int d = 1, j = 0; d < P; d *= 2, j++) {
        const real *T = s->level + j * s->size;
        if (k >= d) {
            if (s->incoming) {
                transform_force(s->dense, s->in, T, f, w);
                work_report(c, w);
            }
            comm_send(c, k - d, tag + j, s->incoming ? s->in : f, SCREW_BYTES);
        }
        /* Nobody to the right: this rank's force is final, but it still sends in later steps. */
        if (k + d >= P) continue;
        comm_recv(c, k + d, tag + j, s->in, SCREW_BYTES);
        if (!s->incoming) transform_force(s->dense, s->in, T, s->in, w);
        screw_add(f, s->in);
        w->flop += SCREW_ADD_FLOP;
        work_report(c, w);
    }
}
