/* body_constants.h - a body's constants in quad precision, rounded to each precision's `real` by
 * body.c.
 *
 * Everything that depends on the model alone is computed here once, so that no precision inherits
 * the rounding of turning frames, normalising quaternions or inverting inertias. */
#ifndef DYNAMICS_BODY_CONSTANTS_H
#define DYNAMICS_BODY_CONSTANTS_H

#include <stdbool.h>

#include "model/model.h"

typedef __float128 quad;

struct body_constants {
    quad tree_r[9], tree_p[3]; /* joint frame -> parent's body frame, internal axes */
    quad user[9];              /* user's body axes = user * internal axes */
    /* rows: own axes of joints that do not turn the body's frame, in the joint frame */
    quad slide[9];
    quad unit;                 /* 1 / sqrt(1 + pitch^2) */
    quad s[3], jc[6];          /* centre of mass; inertia about it */
    quad ms[3], j[6];          /* about the origin */
    quad phi_a[6], phi_b[9], phi_c[6];
    bool turned;
};

/* body_constants_place: frames of body i: tree, user, slide, unit, turned. */
void body_constants_place(const struct model *m, int i, struct body_constants *c);

/* body_constants_inertia: s, jc, ms, j, phi of body i (and user). */
void body_constants_inertia(const struct model *m, int i, struct body_constants *c);

/* frame_constants_make: frame f on body i (-1: the base) as (r, p) from the frame to the body's
 * internal axes. */
void frame_constants_make(const struct model *m, int i, const struct frame *f, quad *r, quad *p);

/* direction_unit: x = the given direction made unit. direction_orthonormalise: t = the part of t
 * orthogonal to the unit vector n, made unit. direction_any_orthogonal: t = some unit vector
 * orthogonal to n, exact for coordinate axes. */
void direction_unit(const double *from, quad *x);
void direction_orthonormalise(quad *t, const quad *n);
void direction_any_orthogonal(const quad *n, quad *t);

#endif
