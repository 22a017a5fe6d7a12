/* cfa_system.h - the constraint forces' matrix A = W^T P^T Phi P W of a tree, factored from the
 * leaves to the root.
 *
 * (P F)_i = F_i - sum X_k F_k over children k is the net joint force on body i. Joints that meet in
 * a body are coupled pairwise by the body's Phi. Eliminating one of them only lowers that Phi, S_i
 * = W^T (Phi_i + X^T Phi_p X) W,    Phi_p -= U S_i^-1 U^T,  U = Phi_p X W, so siblings need no
 * blocks of their own: cost is linear in n for every tree. Where the parent p has no other child,
 * only W_p^T Phi_p W_p matters and is lowered alone: on a chain this is block Thomas, physics
 * 5.1. */
#ifndef DYNAMICS_CFA_SYSTEM_H
#define DYNAMICS_CFA_SYSTEM_H

#include "dynamics/dynamics.h"

struct cfa_row {
    real g[21];         /* S (c x c) packed, then its factor L D L^T */
    /* (c x width) L^-1 U^T, or L^-1 U^T W_p where the parent has no other child */
    real y[36];
    int width;          /* 6, or the parent's c; 0 on the base */
};

struct cfa_system {
    struct cfa_row *row;  /* (nbody) */
    /* (nbody) lowered inverse inertias of bodies with several children; NULL for chains */
    struct sym6 *phi;
};

/* cfa_factor: at d's poses; memory from d->arena. Returns false when a block is not positive
 * definite. */
bool cfa_factor(struct dynamics *d, struct cfa_system *s, struct work *w);

/* cfa_solve: x = W A^-1 r: r (nbody x 6, first c of each body used) in, x (nbody x 6) constraint
 * forces in body axes out; r is destroyed. */
void cfa_solve(struct dynamics *d, const struct cfa_system *s, real *r, real *x, struct work *w);

#endif
