/* compound.h - rake and merge of compounds, without messages (physics 6.2). */
#ifndef KERNEL_COMPOUND_H
#define KERNEL_COMPOUND_H

#include <stdbool.h>

#include "base/work.h"
#include "dynamics/algebra.h"
#include "linalg/real.h"

/* Symmetric matrices are packed (linalg/dense.h), columns of loads lie one behind the other,
 * (SPACE) each. */
struct compound {
    real *p11, *p12, *p22; /* PACKED, SQUARE, PACKED */
    real *beta1, *beta2;   /* (SPACE x m) */
};

enum { COMPOUND_MATRICES = 2 * PACKED + SQUARE };

/* compound_at: the parts of the compound that begins at `base`; compound_size: its numbers. */
static inline int compound_size(int m) { return COMPOUND_MATRICES + 2 * SPACE * m; }
static inline struct compound compound_at(real *base, int m)
{
    return (struct compound){base, base + PACKED, base + PACKED + SQUARE, base + COMPOUND_MATRICES,
                             base + COMPOUND_MATRICES + SPACE * m};
}

/* The joint on top of a compound, and what is given there. */
struct joint_view {
    const struct xform *x;
    const struct subspace *s;
    const real *active; /* (d); NULL: zero */
    const real *bias;   /* (SPACE); NULL: zero */
    real resistance;    /* of a linearly implicit spring (implicit.h); 0: none */
};

/* packed_multiply: y (SPACE) = S x for a packed symmetric square S; y may not be x.
 * SQUARE_VEC_FLOP. */
void packed_multiply(const real *S, const real *x, real *y, struct work *w);

/* joint_compliance: N (packed) = W (W^T Z W)^-1 W^T for the packed Z, with a resistance (Z + H s^-1
 * H^T)^-1. False when what is inverted is not positive definite. */
bool joint_compliance(const struct joint_view *v, const real *Z, real *N, struct work *w);

/* joint_force: h (SPACE x m): h_j = H active - N (Z H active + beta_j - entry_j - bias), active and
 * bias for j = 0 only; `entry` (SPACE x m) is the acceleration of the parent's side in this frame,
 * NULL: zero. */
void joint_force(const struct joint_view *v, int m, const real *Z, const real *N, const real *beta,
                 const real *entry, real *h, struct work *w);

/* compound_rake: what a leaf compound with top joint v does to its parent's bottom body: adds X N
 * X^T to dI (packed) and X h to dp (SPACE x m); leaves N (PACKED) and h (SPACE x m) in `joint`. */
bool compound_rake(const struct joint_view *v, int m, const struct compound *leaf, real *joint,
                   real *dI, real *dp, struct work *w);

/* compound_absorb: the parent u takes dI, dp over (6.3); `record` gets dI, n21, P22, dp, beta_2 (as
 * long as a compound). */
bool compound_absorb(int m, struct compound *u, const real *dI, const real *dp, real *record,
                     struct work *w);

/* compound_merge: u takes its only child v over (6.4); `record` gets h_0 (SPACE x m), M_1, M_3,
 * X. */
bool compound_merge(const struct joint_view *v, int m, struct compound *u,
                    const struct compound *below, real *record, struct work *w);

#endif
