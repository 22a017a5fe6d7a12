/* assembly.h - the blocks of the constraint force system of a chain (physics 4.1; Fijany, Sharf,
 * D'Eleuterio 1995).
 *
 *     D_ii = Phi_i + X_i^T Phi_{i-1} X_i,  E_i = D_{i,i-1} = -X_i^T Phi_{i-1};  A_ii = W_i^T D_ii
 * W_i,  L_i = W_i^T E_i W_{i-1}.  Seen in the axes Q = [H W] of the joints (Q_i^T D_ii Q_i, Q_i^T
 * E_i Q_{i-1}) the same matrices contain the blocks of A, B and C side by side. */
#ifndef KERNEL_ASSEMBLY_H
#define KERNEL_ASSEMBLY_H

#include "kernel/chain.h"

/* assembly_inverse_inertia: Phi (SPACE x SPACE) of body i; with dense operators shifted and
 * inverted anew. */
void assembly_inverse_inertia(struct chain *ch, int i, real *phi);

/* assembly_operators: D_ii and E_i (SPACE x SPACE each) of joint i, an own body or the first one
 * behind the block (whose D is of no use: D may be NULL). E is zero for i = 0. */
void assembly_operators(struct chain *ch, int i, real *D, real *E);

/* assembly_project: out (c_a x c_b) = W_a^T M W_b. */
void assembly_project(struct chain *ch, const struct subspace *a, const real *M,
                      const struct subspace *b, real *out);

/* assembly_turn: out (SPACE x SPACE) = Q_a^T M Q_b. */
void assembly_turn(struct chain *ch, const struct subspace *a, const real *M,
                   const struct subspace *b, real *out);

/* assembly_turn_vector: y (SPACE) = Q^T x. */
void assembly_turn_vector(struct chain *ch, const struct subspace *s, const real *x, real *y);

/* assembly_pack: the symmetric (c x c) matrix M, row stride `stride`, into packed storage. */
void assembly_pack(int c, const real *M, int stride, real *packed);

/* chain_shifted_inertia: dense operators: the square inertia of a body about its origin, by two
 * full products. */
void chain_shifted_inertia(const struct body *b, real *inertia, struct work *w);

#endif
