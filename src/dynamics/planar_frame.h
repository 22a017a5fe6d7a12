/* planar_frame.h - frames of a planar scene, in quad precision, for the constants of its bodies and
 * loops. */
#ifndef DYNAMICS_PLANAR_FRAME_H
#define DYNAMICS_PLANAR_FRAME_H

#include "base/arena.h"
#include "base/err.h"
#include "dynamics/body_constants.h"
#include "model/model.h"

/* planar_normals: the normal in the base's frame, then in every body's own frame: (nbody + 1) unit
 * vectors (3), in `a`. NULL with *e set when some body's joint leaves the plane by an angle of more
 * than `tolerance`. */
quad *planar_normals(const struct model *m, quad tolerance, struct arena *a, struct err *e);

/* planar_frame: rows (3 x 3) normal, x, y of body i's planar frame in its own frame, for its
 * normal: x along the axis of a prismatic joint, along x of a planar one, otherwise anywhere. i =
 * -1: the base. */
void planar_frame(const struct model *m, int i, const quad *normal, quad *rows);

/* planar_placement: x (4) = cosine, sine, shift of the planar frame `inner` (rows in the axes of
 * frame f) in the planar frame `outer` (rows in the axes that f lies in). */
void planar_placement(const quad *outer, const quad *inner, const struct frame *f, quad *x);

/* planar_normal_in: the normal of the planar frame `outer` in the axes of frame f. */
void planar_normal_in(const struct frame *f, const quad *outer, quad *normal);

/* planar_loop_direction: which of the six unit vectors of its frame, [angular; linear], is
 * constraint k of a loop joint; -1: the joint's constraints move or are no unit vectors. */
int planar_loop_direction(enum model_joint joint, int k);

#endif
