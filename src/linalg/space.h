/* space.h - the algebra of the programs: one source, two spaces, chosen by the build of each archive.
 *
 * Screws, the motions and forces of bodies, have six components in space and three in a plane. Files of room kernel and
 * what they use of dynamics are compiled with SPACE 6 and SPACE 3. Names that differ carry the space (SPACE_NAME); a
 * header renames them right under each prototype's comment, so that the plain name always means "in this file's space
 * and precision". Without SPACE it is six. */
#ifndef LINALG_SPACE_H
#define LINALG_SPACE_H

#include "linalg/real.h"

#ifndef SPACE
#define SPACE 6
#endif

#if SPACE == 6
#define SPACE_NAME(name) REAL_NAME(name)
#elif SPACE == 3
#define SPACE_NAME(name) REAL_NAME(name##_planar)
#else
#error "SPACE must be 6 or 3"
#endif

/* Numbers of a square matrix and of a symmetric one; operations of products of square matrices. */
enum {
    SQUARE = SPACE * SPACE,
    PACKED = SPACE * (SPACE + 1) / 2,
    SQUARE_VEC_FLOP = SPACE * (2 * SPACE - 1),
    SQUARE_MUL_FLOP = SPACE * SQUARE_VEC_FLOP
};

#endif
