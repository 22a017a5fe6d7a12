/* space.h - the algebra of the programs: one source, two spaces, chosen by the build of each
 * archive.
 *
 * Screws, the motions and forces of bodies, have six components in space and three in a plane.
 * Files of room kernel and what they use of dynamics are compiled with SPACE 6 and SPACE 3
 * (real.h). */
#ifndef LINALG_SPACE_H
#define LINALG_SPACE_H

#include "linalg/real.h"

/* Numbers of a square matrix and of a symmetric one; operations of products of square matrices. */
enum {
    SQUARE = SPACE * SPACE,
    PACKED = SPACE * (SPACE + 1) / 2,
    SQUARE_VEC_FLOP = SPACE * (2 * SPACE - 1),
    SQUARE_MUL_FLOP = SPACE * SQUARE_VEC_FLOP
};

#endif
