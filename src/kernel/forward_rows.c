/* forward_rows.c - one joint's row of the constraint system (forward_rows.h). */
#include "kernel/forward_rows.h"

#include <string.h>

#include "kernel/assembly.h"
#include "kernel/forward_exact.h"

void forward_project(struct forward *f, int i, const real *M, int j, real *out)
{
    struct chain *ch = &f->chain;
    const struct subspace *left = forward_subspace(f, i), *right = forward_subspace(f, j);
    const int a = SPACE - forward_row_size(f, i), n = forward_row_size(f, j);
    if (a == left->d && n == right->c) {
        assembly_project(ch, left, M, right, out);
        return;
    }
    real turned[SQUARE];
    assembly_turn(ch, left, M, right, turned);
    for (int r = a; r < SPACE; r++)
        memcpy(out + (r - a) * n, turned + SPACE * r + SPACE - n, (size_t)n * sizeof(real));
}

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
    if (f->exact) exact_add(f, i, more);
}

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
