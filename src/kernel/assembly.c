/* assembly.c - the blocks of the constraint force system (assembly.h). */
#include "kernel/assembly.h"

#include <string.h>

#include "linalg/dense.h"

/* Phi is constant in the body's frame (physics 1.8); a code with dense operators inverts it
 * anew. */
void assembly_inverse_inertia(struct chain *ch, int i, real *phi)
{
    const struct body *b = &ch->shared->body[i];
    if (!ch->dense) {
        body_phi(b, phi);
        ch->work.flop += BODY_PHI_FLOP;
        return;
    }
    chain_shifted_inertia(b, phi, &ch->work);
    dense_invert(SPACE, phi, &ch->work);
}

/* transpose: a square matrix in place. */
static void transpose(real *M)
{
    for (int i = 0; i < SPACE; i++)
        for (int j = 0; j < i; j++) {
            const real t = M[SPACE * i + j];
            M[SPACE * i + j] = M[SPACE * j + i];
            M[SPACE * j + i] = t;
        }
}

/* move_rows: row_k <- X^T row_k: M X for the square matrix M, in place, by the structured
 * transform. */
static void move_rows(struct chain *ch, const real *X, real *M)
{
    for (int k = 0; k < SPACE; k++)
        xform_motion(M + SPACE * k, (const struct xform *)X, M + SPACE * k);
    ch->work.flop += SPACE * XFORM_MOTION_FLOP;
    ch->work.call++;
}

/* physics (4.1). E is built first, because X^T Phi X is E X up to the sign. */
void assembly_operators(struct chain *ch, int i, real *D, real *E)
{
    if (D) assembly_inverse_inertia(ch, i, D);
    /* Joint 0 hangs on the base, which contributes nothing: D_00 = Phi_0. */
    if (i == 0) {
        memset(E, 0, SQUARE * sizeof *E);
        return;
    }
    const real *X = chain_transform(ch, i);
    real phi[SQUARE], moved[SQUARE];
    assembly_inverse_inertia(ch, i - 1, phi);
    if (ch->dense) {
        dense_product_tn(SPACE, SPACE, SPACE, X, phi, E, &ch->work);
        if (D) dense_product(SPACE, SPACE, SPACE, E, X, moved, &ch->work);
    } else {
        /* (Phi X)^T = X^T Phi, as Phi is symmetric: the transform acts on rows, the cheap way,
         * twice. */
        memcpy(E, phi, sizeof phi);
        move_rows(ch, X, E);
        transpose(E); /* X^T Phi */
        if (D) {
            memcpy(moved, E, sizeof moved);
            move_rows(ch, X, moved);
        }
    }
    if (D) {
        for (int k = 0; k < SQUARE; k++) D[k] += moved[k];
        ch->work.flop += SQUARE;
    }
    for (int k = 0; k < SQUARE; k++) E[k] = -E[k];
}

/* expand: out (SPACE x SPACE) = [H W] as a matrix, column by column. */
static void expand(const struct subspace *s, real *out)
{
    for (int k = 0; k < SPACE; k++) {
        real column[SPACE];
        subspace_column(s, k, column);
        for (int i = 0; i < SPACE; i++) out[SPACE * i + k] = column[i];
    }
}

/* turn_part: out (na x nb) = (columns from a0 of Q_a)^T M (columns from b0 of Q_b), by full
 * products. H comes first in Q: a0 = 0 means all columns, a0 = d those of W. */
static void turn_part(struct chain *ch, const struct subspace *a, int a0, const real *M,
                      const struct subspace *b, int b0, real *out)
{
    const int na = SPACE - a0, nb = SPACE - b0;
    real left[SQUARE], right[SQUARE], product[SQUARE], part[SQUARE];
    expand(a, left);
    expand(b, right);
    for (int i = 0; i < SPACE; i++)
        for (int j = 0; j < nb; j++) part[i * nb + j] = right[SPACE * i + b0 + j];
    dense_product(SPACE, nb, SPACE, M, part, product, &ch->work);
    for (int i = 0; i < SPACE; i++)
        for (int j = 0; j < na; j++) part[i * na + j] = left[SPACE * i + a0 + j];
    dense_product_tn(na, nb, SPACE, part, product, out, &ch->work);
}

/* W_a^T M W_b, the blocks of A (physics 4.2). Axes that pick components cost nothing; a general
 * Q costs its products. */
void assembly_project(struct chain *ch, const struct subspace *a, const real *M,
                      const struct subspace *b, real *out)
{
    if (ch->dense) {
        turn_part(ch, a, a->d, M, b, b->d, out);
        return;
    }
    subspace_project(a, true, M, b, true, out);
    ch->work.flop += (uint64_t)((b->pick ? 0 : SQUARE_VEC_FLOP * b->c) +
                                (a->pick ? 0 : SCREW_DOT_FLOP * a->c * b->c));
    ch->work.call++;
}

void assembly_turn(struct chain *ch, const struct subspace *a, const real *M,
                   const struct subspace *b, real *out)
{
    if (ch->dense || !a->pick || !b->pick) {
        turn_part(ch, a, 0, M, b, 0, out);
        return;
    }
    /* Q permutes axes: the blocks of A, B and C are the same numbers in another order. */
    for (int i = 0; i < SPACE; i++)
        for (int j = 0; j < SPACE; j++) out[SPACE * i + j] = M[SPACE * a->pick[i] + b->pick[j]];
}

/* H^T x and W^T x side by side, in the order of Q = [H W]. */
void assembly_turn_vector(struct chain *ch, const struct subspace *s, const real *x, real *y)
{
    subspace_h_transposed(s, x, y);
    subspace_w_transposed(s, x, y + s->d);
    if (!s->pick) ch->work.flop += SQUARE_VEC_FLOP;
}

/* Rows of the lower triangle one behind the other (linalg/dense.h). */
void assembly_pack(int c, const real *M, int stride, real *packed)
{
    for (int i = 0; i < c; i++)
        for (int j = 0; j <= i; j++) packed[packed_index(i, j)] = M[i * stride + j];
}
