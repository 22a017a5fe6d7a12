/* screw.h - vectors and transforms of the build's space: those of spatial.h or those of
 * planar.h. */
#ifndef LINALG_SCREW_H
#define LINALG_SCREW_H

#include "linalg/space.h"

#if SPACE == 6
#include "linalg/spatial.h"
#else
#include "linalg/planar.h"
#endif

#endif
