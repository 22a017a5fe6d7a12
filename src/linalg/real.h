/* real.h - the scalar of the numerics: one source, three precisions, chosen by the build of each
 * archive.
 *
 * Files of linalg, dynamics and kernel that compute are compiled three times, with REAL_BITS 32, 64
 * and 128, some of them twice more for the plane (SPACE, space.h). Their public names carry the
 * precision and the space: the build makes real_names.h from the headers (real_names.awk), so that
 * the plain name always means "in this file's precision and space". Without REAL_BITS it is double,
 * without SPACE it is six components. Answers of another precision are reached through const tables
 * of functions (dynamics_table.h, kernel.h).
 *
 * With REAL_LANES 4 or 8 a `real` is that many doubles side by side, of as many states (lanes.h).
 * What is one number for all of them is written REAL(x), and a comparison that all of them must
 * pass real_all(x > y). */
#ifndef LINALG_REAL_H
#define LINALG_REAL_H

#ifndef REAL_BITS
#define REAL_BITS 64
#endif
#ifndef REAL_LANES
#define REAL_LANES 1
#endif

#if REAL_BITS == 32
#include <math.h>
typedef float real;
#define REAL_NAME(name) name##_f32
#define REAL_EPSILON 1.1920929e-07f
#define real_sqrt sqrtf
#define real_fabs fabsf
#define real_sin sinf
#define real_cos cosf
#define real_exp expf
#elif REAL_BITS == 64 && REAL_LANES > 1
#include "linalg/lanes.h"
#define REAL_EPSILON 2.2204460492503131e-16
#elif REAL_BITS == 64
#include <math.h>
typedef double real;
#define REAL_NAME(name) name##_f64
#define REAL_EPSILON 2.2204460492503131e-16
#define real_sqrt sqrt
#define real_fabs fabs
#define real_sin sin
#define real_cos cos
#define real_exp exp
#elif REAL_BITS == 128
typedef __float128 real;
#define REAL_NAME(name) name##_f128
#define REAL_EPSILON 1.92592994438723585305597794258492732e-34Q
/* libquadmath; declared here because its header belongs to gcc alone. */
__float128 sqrtq(__float128);
__float128 fabsq(__float128);
__float128 sinq(__float128);
__float128 cosq(__float128);
__float128 expq(__float128);
#define real_sqrt sqrtq
#define real_fabs fabsq
#define real_sin sinq
#define real_cos cosq
#define real_exp expq
#else
#error "REAL_BITS must be 32, 64 or 128"
#endif

#if REAL_LANES == 1
#define REAL(x) ((real)(x))
#define real_all(condition) (condition)
#define real_where(condition, x, y) ((condition) ? (x) : (y))
#endif

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

#include "linalg/real_names.h" /* made by the build */

/* A build in which every operation of the source is executed as often as it is written, for tests
 * that count them. */
#ifdef REAL_COUNTED
#ifdef __clang__
#pragma clang optimize off
#else
#pragma GCC optimize("O0")
#endif
#endif

#endif
