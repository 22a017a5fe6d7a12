/* forward_rows.c - one joint's row of the constraint system (forward_rows.h). */
#include "kernel/forward_rows.h"

#include <string.h>

#include "kernel/assembly.h"
#include "kernel/forward_exact.h"

/* out = (rows of joint i)^T M (rows of joint j): W^T M W as in physics (4.2), or all six components
 * where a spring is linearly implicit (physics 9.0). */
void forward_project(struct forward *f, int i, const real *M, int j, real *out)
{
    struct chain *ch = &f->chain;
    const struct subspace *left = forward_subspace(f, i), *right = forward_subspace(f, j);
    const int a = SPACE - forward_row_size(f, i), n = forward_row_size(f, j);
    if (a == left->d && n == right->c) {
        assembly_project(ch, left, M, right, out);
        return;
    }
    /* At least one side is full: take the whole matrix in joint axes and cut out the rows' part. */
    real turned[SQUARE];
    assembly_turn(ch, left, M, right, turned);
    for (int r = a; r < SPACE; r++)
        memcpy(out + (r - a) * n, turned + SPACE * r + SPACE - n, (size_t)n * sizeof(real));
}

/* F += W FS; a soft joint's unknowns hold the components along H as well. */
void forward_add_reaction(struct forward *f, int i, const real *x, real *force)
{
    const struct subspace *s = forward_subspace(f, i);
    const struct joint_cost *cost = body_cost(forward_body(f, i));
    const bool soft = forward_resistance(f, i) > 0;
    real more[SPACE] = {0};
    f->chain.work.flop += (uint64_t)(cost->w + (soft ? cost->h : 0));
    if (s->pick && !f->exact) { /* unit columns: no sum to round before */
        if (soft) subspace_h(s, x, force);
        subspace_w(s, x + (soft ? s->d : 0), force);
        return;
    }
    if (soft) subspace_h(s, x, more);
    subspace_w(s, x + (soft ? s->d : 0), more);
    screw_add(force, more);
    f->chain.work.flop += SCREW_ADD_FLOP;
    /* Corrections go into the long form too, before they are rounded into the short one. */
    if (f->exact) exact_add(f, i, more);
}

/* What the joint's row is violated by: W^T z, and for a soft joint H^T z - s^-1 (tau_0 - H^T F). */
void forward_violation(struct forward *f, int i, const real *z, real *out)
{
    struct chain *ch = &f->chain;
    const struct subspace *s = forward_subspace(f, i);
    const real resistance = forward_resistance(f, i), *given = f->active + chain_u_at(ch, i);
    real force[SPACE];
    if (resistance > 0) {
        subspace_h_transposed(s, z, out);
        subspace_h_transposed(s, chain_at(ch, f->force, i), force);
        for (int k = 0; k < s->d; k++) out[k] -= (given[k] - force[k]) / resistance;
    }
    subspace_w_transposed(s, z, out + forward_row_size(f, i) - s->c);
}
