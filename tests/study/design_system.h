/* design_system.h - the constraint forces' system A of a chain as a matrix, its condition numbers,
 * and the backward errors of its solvers, for the tables of the design. */
#ifndef TESTS_RUN_DESIGN_SYSTEM_H
#define TESTS_RUN_DESIGN_SYSTEM_H

#include "base/arena.h"
#include "model/model.h"
#include "spec/kernel_spec.h"

struct design_system {
    int n;
    unsigned char *size; /* (n) orders */
    double *D, *L;       /* (36 n) full c x c; (36 n) c_i x c_{i-1} */
    struct arena *a;
};

/* design_system_make: A = W^T P^T Phi P W of a chain (physics 4.1) at s->q. */
struct design_system design_system_make(const struct model *m, const struct state *s,
                                        struct arena *a);

/* design_condition: of A in the 2-norm by power iterations on A and, through block Cholesky, on its
 * inverse; scaled: of A with unit diagonal blocks. NaN when a pivot is not positive.
 * design_mass_condition: of the mass matrix. */
double design_condition(const struct design_system *x, bool scaled);
double design_mass_condition(const struct model *m, const struct state *s, struct arena *a);

/* design_backward_error: largest |A x - r| / (|A||x| + |r|) of all components for a seeded r, x
 * from `solver` on nrank ranks. INFINITY when a pivot was not positive. */
double design_backward_error(const struct design_system *x, enum solver solver,
                             enum part_solver part, int nrank);

#endif
