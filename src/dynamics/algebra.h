/* algebra.h - bodies, loops, transforms and vectors of the build's space: those of body.h and
 * loop.h, or those of planar_body.h and planar_loop.h.
 *
 * The programs are written once for both; sizes are SPACE, SQUARE, PACKED and XFORM_NUMBERS. */
#ifndef DYNAMICS_ALGEBRA_H
#define DYNAMICS_ALGEBRA_H

#include "linalg/space.h"

#if SPACE == 6
#include "dynamics/body.h"
#include "dynamics/loop.h"
#else
#include "dynamics/planar_body.h"
#include "dynamics/planar_loop.h"
#endif

#endif
