/* lump.h - bodies on fixed joints made one with the body that carries them.
 *
 * The motion and the joint forces stay the same; there are fewer bodies, and frames without mass
 * (tool points, optical frames of robots) no longer stand in the way of algorithms that divide by
 * every body's inertia. */
#ifndef MODEL_LUMP_H
#define MODEL_LUMP_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"
#include "model/model.h"

struct lumped {
    struct model *model;  /* without fixed joints; NULL when nothing can move */
    int *body;            /* (nbody of the old) the new body that it is part of, -1: the base */
    struct frame *at;     /* (nbody of the old) its frame in that body's frame */
};

/* lump_fixed: m with every body on a fixed joint added to its parent, in `a`; loops follow.
 *
 *   allow_nonphysical  as in model_finish, for the lumped bodies
 *
 *   Bodies fixed to the base vanish in it. Masses add; the inertia about the common centre of mass
 * is J1 + J2 + m1 m2 / (m1 + m2) (d^2 U - d d^T), d between the centres. Returns false with *e set
 * as model_finish. */
bool lump_fixed(const struct model *m, bool allow_nonphysical, struct arena *a, struct lumped *out,
                struct err *e);

/* lump_state: the state of `lumped` that is state s of the old model: the same arrays, external
 * wrenches gathered on the new bodies (new array). */
struct state *lump_state(const struct lumped *lumped, const struct model *old,
                         const struct state *s, struct arena *a);

/* frame_compose: outer o inner. frame_apply: y = R x + p; frame_turn: y = R x. frame_normalise:
 * quaternion to length 1; a zero one becomes the identity. */
struct frame frame_compose(const struct frame *outer, const struct frame *inner);
void frame_apply(const struct frame *f, const double *x, double *y);
void frame_turn(const struct frame *f, const double *x, double *y);
void frame_normalise(struct frame *f);

#endif
