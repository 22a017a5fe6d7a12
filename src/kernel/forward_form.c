/* forward_form.c - joint forces of a block and beside it, and the accelerations that they give
 * (forward_form.h). */
#include "kernel/forward_form.h"

#include <string.h>

#include "kernel/extremes.h"
#include "kernel/forward_exact.h"
#include "kernel/tags.h"

/* active_force: F = H x for joint i, x (d): the given part of the joint's force (physics 4.1). */
static void active_force(struct forward *f, int i, const real *x, real *force)
{
    screw_zero(force);
    subspace_h(forward_subspace(f, i), x, force);
    f->chain.work.flop += (uint64_t)body_cost(forward_body(f, i))->h;
}

/* forward_begin_forces: F = H x of own joints and, by messages, of those beside the block; direct:
 * the gain of body lo-1 comes along when `gain` is set.
 *
 * Every row needs its neighbours' forces, so that each rank keeps copies of the joints lo-1 and hi.
 * 8 d bytes each way, and 48 more to the right for the gain (physics 4.5, step 4). */
void forward_begin_forces(struct forward *f, const real *x, bool gain)
{
    struct chain *ch = &f->chain;
    struct comm *c = ch->comm;
    const int k = comm_rank(c), last = ch->hi - 1, d = forward_body(f, last)->d;
    const int64_t size = sizeof(real);
    f->active = x;
    for (int i = ch->lo; i < ch->hi; i++)
        active_force(f, i, x + chain_u_at(ch, i), chain_at(ch, f->force, i));
    chain_report(ch);
    if (forward_has_left(f)) comm_send(c, k - 1, TAG_ACTIVE, x, forward_body(f, ch->lo)->d * size);
    if (forward_has_right(f)) {
        memcpy(f->message, x + chain_u_at(ch, last), (size_t)d * sizeof(real));
        /* The gain of the edge body, from which the right neighbour computes y_{lo-1} itself. */
        if (gain) screw_copy(f->message + d, chain_at(ch, f->gain, last));
        comm_send(c, k + 1, TAG_ACTIVE, f->message, (d + (gain ? SPACE : 0)) * size);
        comm_recv(c, k + 1, TAG_ACTIVE, f->message, forward_body(f, ch->hi)->d * size);
        active_force(f, ch->hi, f->message, f->force_right);
    }
    /* The left neighbour's active force, and its gain if loads are in the constraints. */
    if (!forward_has_left(f)) return;
    const int before = forward_body(f, ch->lo - 1)->d;
    comm_recv(c, k - 1, TAG_ACTIVE, f->message, (before + (gain ? SPACE : 0)) * size);
    active_force(f, ch->lo - 1, f->message, f->force_left);
    if (gain) screw_copy(f->gain_left, f->message + before);
}

/* forward_add_reactions: F += W FS of own joints and of both neighbours, after a solution. The
 * solver has already delivered FS of joint lo-1 (b->left, step 8); FS of joint hi comes from the
 * right (physics 4.5, step 9: 8 c bytes). */
void forward_add_reactions(struct forward *f)
{
    struct chain *ch = &f->chain;
    struct comm *c = ch->comm;
    const int k = comm_rank(c);
    const int64_t size = sizeof(real);
    if (forward_has_left(f))
        comm_send(c, k - 1, TAG_REACTION, blocks_row_r(&f->blocks, ch->lo),
                  forward_row_size(f, ch->lo) * size);
    for (int i = ch->lo; i < ch->hi; i++)
        forward_add_reaction(f, i, blocks_row_r(&f->blocks, i), chain_at(ch, f->force, i));
    if (forward_has_left(f)) forward_add_reaction(f, ch->lo - 1, f->blocks.left, f->force_left);
    if (!forward_has_right(f)) return;
    comm_recv(c, k + 1, TAG_REACTION, f->message, forward_row_size(f, ch->hi) * size);
    forward_add_reaction(f, ch->hi, f->message, f->force_right);
}

/* forward_body_acceleration: y = Phi_i (F_i - X_{i+1} F_{i+1} + gain). Phi is applied by mass,
 * centre and inertia, not as a matrix. */
void forward_body_acceleration(struct forward *f, int i, const real *force, const real *next,
                               const real *gain, real *y)
{
    struct chain *ch = &f->chain;
    real net[SPACE];
    screw_copy(net, force);
    if (next) {
        real moved[SPACE];
        transform_force(ch->dense, moved, chain_transform(ch, i + 1), next, &ch->work);
        screw_sub(net, moved);
        ch->work.flop += SCREW_ADD_FLOP;
    }
    if (gain) screw_add(net, gain);
    body_accelerate(forward_body(f, i), net, y);
    ch->work.flop += (uint64_t)(BODY_ACCELERATE_FLOP + (gain ? SCREW_ADD_FLOP : 0));
    ch->work.call++;
}

/* forward_force_above: F of joint i + 1; NULL: there is none. */
const real *forward_force_above(struct forward *f, int i)
{
    if (i + 1 < f->chain.hi) return chain_at(&f->chain, f->force, i + 1);
    return forward_has_right(f) ? f->force_right : NULL;
}

/* forward_operator_form: z_i = y_i - X_i^T y_{i-1} - b_i of own bodies (physics 4.8); without
 * `terms` the velocity terms, the external forces and the base are left out. Notes the residual.
 *
 * One pass along the block: y_{i-1} is at hand when body i needs it. The residual is the largest
 * constraint violation over the largest term that went into one, so that it measures cancelled
 * digits. */
void forward_operator_form(struct forward *f, bool terms)
{
    struct chain *ch = &f->chain;
    const int lo = ch->lo, hi = ch->hi;
    real before[SPACE], y[SPACE], moved[SPACE], residual = 0, scale = 0;
    const struct job_omit *omit = &ch->job->omit;
    const bool watch = f->watch;
    const bool gain = terms && !omit->load, bias = terms && !omit->velocity,
               base = terms && !omit->base;
    if (f->exact) {
        exact_operator_form(f, gain, bias, base);
        return;
    }
    /* y of the body before the block is computed here again: cheaper than a message. */
    if (forward_has_left(f))
        forward_body_acceleration(f, lo - 1, f->force_left, f->force, gain ? f->gain_left : NULL,
                                  before);
    else screw_copy(before, ch->shared->base);
    for (int i = lo; i < hi; i++) {
        real *z = chain_at(ch, f->z, i), reaction[SPACE];
        forward_body_acceleration(f, i, chain_at(ch, f->force, i), forward_force_above(f, i),
                                  gain ? chain_at(ch, f->gain, i) : NULL, y);
        screw_copy(z, y);
        if (watch) scale = largest_size(scale, SPACE, y);
        /* Body 0 hangs on the base, whose acceleration takes the place of y_{-1} (physics 4.5). */
        if (i > 0 || base) {
            transform_base(ch->dense, i == 0 && omit->turn, moved, chain_transform(ch, i), before,
                           &ch->work);
            screw_sub(z, moved);
            ch->work.flop += SCREW_ADD_FLOP;
            if (watch) scale = largest_size(scale, SPACE, moved);
        }
        /* The direct form keeps the velocity terms in the constraint (physics 4.5). */
        if (bias) {
            screw_sub(z, chain_at(ch, ch->b, i));
            ch->work.flop += SCREW_ADD_FLOP;
            if (watch) scale = largest_size(scale, SPACE, chain_at(ch, ch->b, i));
        }
        screw_copy(before, y);
        /* A monitor is not part of the algorithm: its operations are not charged. */
        if (!watch) continue;
        forward_violation(f, i, z, reaction);
        residual = largest_size(residual, forward_row_size(f, i), reaction);
    }
    f->residual = scale > 0 ? residual / scale : residual;
    f->residual_scale = scale;
}

/* forward_right_hand_side: r = - what the joints' rows are violated by (physics 4.6). In a
 * refinement the same expression is the residual of the system, without its rounding errors. */
void forward_right_hand_side(struct forward *f)
{
    struct chain *ch = &f->chain;
    for (int i = ch->lo; i < ch->hi; i++) {
        real *r = blocks_row_r(&f->blocks, i);
        forward_violation(f, i, chain_at(ch, f->z, i), r);
        for (int k = 0; k < forward_row_size(f, i); k++) r[k] = -r[k];
        ch->work.flop += (uint64_t)forward_violation_flops(f, i);
        ch->work.div += forward_resistance(f, i) > 0;
    }
}
