/* closure.h - closed chains: loop forces from the accelerations that the open system would have
 * (physics 7.2).
 *
 * The system, cut open at the loop joints, is solved for m = 1 + nrow columns of loads at once: the
 * real ones, and one unit loop force per constraint. From the accelerations of the loops' bodies
 * rank 0 forms S = W^T J M^-1 J^T W and the constraint residual, solves for lambda in the
 * least-norm sense and broadcasts it; the answer is column 0 plus lambda times the others. */
#ifndef KERNEL_CLOSURE_H
#define KERNEL_CLOSURE_H

#include <stdbool.h>

#include "base/work.h"
#include "comm/comm.h"
#include "dynamics/algebra.h"
#include "kernel/carve.h"
#include "linalg/real.h"
#include "model/model.h"

/* What all ranks share. Side s of the 2 nloop ones: body a (s even) or b (odd) of loop s / 2. */
struct closure_shared {
    int nloop, nrow;
    const struct loop *loop; /* (nloop) */
    const int *place;        /* (nrow) in the model's lambda */
    const int *owner;        /* (2 nloop) rank that owns the side's body; -1: the base */
    const struct body *body; /* (nbody) */
    const real *base;        /* (SPACE) acceleration of the base minus gravity; NULL: zero */
};

struct closure {
    struct comm *comm;
    const struct closure_shared *shared;
    int m;                         /* columns: 1 + nrow */
    bool takes_part;               /* this rank owns a side */
    struct loop_pose *pose;        /* (nloop) of loops with a side here */
    /* (2 nloop) body to base; own sides filled in before closure_meet */
    struct xform *side_pose;
    real *side_velocity;           /* (2 nloop x SPACE) */
    real *contribution;            /* (6 (m + 1)) */
    real *S, *reference, *scratch; /* rank 0 */
    real *lambda;                  /* (nrow), on every rank after closure_solve */
    int rank;                      /* of S, on rank 0 */
};

/* closure_shared_make: the loops of a model; `owner` (2 nloop) and `base` as above, borrowed. NULL
 * when there are none. */
struct closure_shared *closure_shared_make(const struct model *m, const struct body *body,
                                           const real *base, const int *owner, struct arena *a);

/* closure_body: body of side s; -1: the base. */
static inline int closure_body(const struct closure_shared *s, int side)
{
    return side % 2 ? s->loop[side / 2].body_b : s->loop[side / 2].body_a;
}

/* closure_carve: room for rank `rank`. */
void closure_carve(struct closure *cl, struct carve *c, const struct closure_shared *shared,
                   int rank);

/* closure_meet: both sides of every loop exchange pose and velocity and place the loop. */
void closure_meet(struct closure *cl, struct work *w);

/* closure_loads: load (m x SPACE) of an own body: column 1 + row += the force of that row's unit
 * lambda. */
void closure_loads(struct closure *cl, int body, real *load, struct work *w);

/* closure_solve: lambda on every rank.
 *
 *   acceleration  in  (2 nloop) for own sides: (m x SPACE) classical acceleration of the body for
 * each column */
void closure_solve(struct closure *cl, real *const *acceleration, struct work *w);

#endif
