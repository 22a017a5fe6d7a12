/* forward.h - parallel forward dynamics of a chain by the constraint force algorithm, one rank's
 * program.
 *
 * Joint forces are F = H FT + W FS; the active FT are given, the constraint forces FS follow from a
 * block tridiagonal system and the accelerations from them. Two formulations (physics 4.2, 4.3):
 * the paper's, where FT is what remains of tau after a bias inverse dynamics, A FS = -B FT, u' = C
 * FT + B^T FS; and the direct one, where velocity terms stay in the constraint equation and D is
 * never multiplied out, which needs one scan instead of three and is more accurate by digits. */
#ifndef KERNEL_FORWARD_H
#define KERNEL_FORWARD_H

#include "kernel/blocks.h"
#include "kernel/chain.h"
#include "kernel/motion.h"

/* About twice the digits of real (quad itself has no longer type). */
#if REAL_BITS == 32
typedef double twice;
#else
typedef __float128 twice;
#endif

struct forward {
    struct chain chain;
    struct blocks blocks;
    struct subspace *left; /* of joint lo-1 */
    bool direct;
    bool watch; /* somebody wants the residual */
    /* h of linearly implicit steps; 0: springs are explicit (implicit.h) */
    real step;
    /* own joints: the forces that the present solution began with */
    const real *active;
    real *tau;                      /* own joints: given forces and springs */
    real *ud;                       /* own joints: the answer */
    real *force;                    /* own bodies (SPACE): F in the body's frame */
    /* F of own joints, lo-1 and hi in twice the precision; NULL: not asked for */
    twice *exact;
    real *force_left, *force_right; /* F of bodies lo-1 and hi */
    /* direct: Fext - P of own bodies (SPACE); unused when the job omits loads */
    real *gain;
    real *gain_left;                /* of body lo-1 */
    /* own bodies (SPACE): acceleration of the joint, H^T z = u', W^T z = 0 */
    real *z;
    /* paper: Q^T D Q of own joints, Q^T E Q also of joint hi (SQUARE each) */
    real *D, *E;
    real *message;                  /* coordinates or forces of an edge joint */
    struct motion motion;
    int refined;   /* corrections applied */
    bool published;   /* the first evaluation's answer is out */
    real residual; /* largest |W^T z| over the largest term in it */
    real residual_scale; /* that term */
};

/* forward_carve: room for rank `rank`. */
void forward_carve(struct forward *f, struct carve *c, const struct kernel_job *job, int rank);

/* forward_set: the communicator of this rank. */
void forward_set(struct forward *f, struct comm *c);

/* forward_run: the job's evaluation or time steps; the first evaluation's answer into the job's
 * arrays. */
void forward_run(struct forward *f);

#endif
