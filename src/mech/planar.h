/* planar.h - whether a scene's motion stays in one plane, and in which.
 *
 * It does when one direction, the normal, is the axis of every revolute and planar joint, is orthogonal to the axis of
 * every prismatic one, and is left alone by every placement at every configuration; other joints than these and fixed
 * ones leave the plane. Then the mass, the centre of mass seen along the normal and the inertia about it are all of a
 * body that acts; the parts of gravity, wrenches and offsets out of the plane do no work. An acceleration of the base
 * must turn it about the normal. */
#ifndef MECH_PLANAR_H
#define MECH_PLANAR_H

#include <stdbool.h>

#include "mech/body_constants.h"
#include "mech/model.h"
#include "spec/kernel_spec.h"

/* planar_scene: whether the motion of m in state s (NULL: the base does not accelerate) is planar to the rounding of
 * `precision`. Otherwise false with ERR_CONFIG naming what leaves the plane. */
bool planar_scene(const struct model *m, const struct state *s, enum precision precision, struct err *e);

/* planar_normals: the normal in the base's frame, then in every body's own frame: (nbody + 1) unit vectors (3), in `a`.
 * NULL with *e set when some body's joint leaves the plane by an angle of more than `tolerance`. */
quad *planar_normals(const struct model *m, quad tolerance, struct arena *a, struct err *e);

/* planar_frame: rows (3 x 3) normal, x, y of body i's planar frame in its own frame, for its normal: x along the axis
 * of a prismatic joint, along x of a planar one, otherwise anywhere. i = -1: the base. */
void planar_frame(const struct model *m, int i, const quad *normal, quad *rows);

/* planar_placement: x (4) = cosine, sine, shift of the planar frame `inner` (rows in the axes of frame f) in the planar
 * frame `outer` (rows in the axes that f lies in). */
void planar_placement(const quad *outer, const quad *inner, const struct frame *f, quad *x);

/* planar_normal_in: the normal of the planar frame `outer` in the axes of frame f. */
void planar_normal_in(const struct frame *f, const quad *outer, quad *normal);

/* planar_loop_direction: which of the six unit vectors of its frame, [angular; linear], is constraint k of a loop
 * joint; -1: the joint's constraints move or are no unit vectors. */
int planar_loop_direction(enum model_joint joint, int k);

#endif
