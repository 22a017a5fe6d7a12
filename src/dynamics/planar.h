/* planar.h - whether a scene's motion stays in one plane, and in which.
 *
 * It does when one direction, the normal, is the axis of every revolute and planar joint, is
 * orthogonal to the axis of every prismatic one, and is left alone by every placement at every
 * configuration; other joints than these and fixed ones leave the plane. Then the mass, the centre
 * of mass seen along the normal and the inertia about it are all of a body that acts; the parts of
 * gravity, wrenches and offsets out of the plane do no work. An acceleration of the base must turn
 * it about the normal. */
#ifndef DYNAMICS_PLANAR_H
#define DYNAMICS_PLANAR_H

#include <stdbool.h>

#include "model/model.h"
#include "spec/kernel_spec.h"

/* planar_scene: whether the motion of m in state s (NULL: the base does not accelerate) is planar
 * to the rounding of `precision`. Otherwise false with ERR_CONFIG naming what leaves the plane. */
bool planar_scene(const struct model *m, const struct state *s, enum precision precision,
                  struct err *e);

#endif
