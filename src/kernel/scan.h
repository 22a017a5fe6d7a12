/* scan.h - first-order linear recurrences along the ranks by recursive doubling (Kogge and Stone
 * 1973).
 *
 *     v_k += T_k^T v_{k-1}  (motions, upwards)        f_k += T_{k+1} f_{k+1}  (forces, downwards)
 *
 * ceil(log2 P) steps, distance 2^j in step j. Two ways to hold the composite transforms,
 * physics 3.1 and 3.2: incoming: rank k holds T^(j) from its frame to frame k-2^j, sent along with
 * v: one message a step; outgoing: rank k holds the one from frame k+2^j to its own, as in the
 * paper: two messages a step. All levels are kept: later scans at the same configuration send
 * vectors only.
 *
 * A transform is a pair (r, p), or with `dense` a full square matrix (general products). */
#ifndef KERNEL_SCAN_H
#define KERNEL_SCAN_H

#include <stdbool.h>

#include "base/work.h"
#include "comm/comm.h"
#include "kernel/carve.h"
#include "linalg/real.h"
#include "linalg/screw.h"

struct scan {
    struct comm *comm;
    bool dense, incoming;
    int size;    /* numbers per transform: XFORM_NUMBERS or SQUARE */
    real *level; /* transforms T^(0), T^(1), ...; then, while the first scan runs, v */
    real *in;    /* receive: one transform and one vector */
};

/* transform_force: y = T f; transform_motion: y = T^T v; transform_compose: c = a o b; each with
 * its account. y may be the argument; c may be neither. */
void transform_force(bool dense, real *y, const real *T, const real *f, struct work *w);
void transform_motion(bool dense, real *y, const real *T, const real *v, struct work *w);
void transform_compose(bool dense, real *c, const real *a, const real *b, struct work *w);

/* transform_base: y = T^T v for the acceleration v of the base; `slides`: it has no angular part,
 * which saves most of the work but with dense operators. */
void transform_base(bool dense, bool slides, real *y, const real *T, const real *v, struct work *w);

/* transform_expand: the square matrix of a pair, as the product of a shift and a rotation (dense)
 * or a copy. */
void transform_expand(bool dense, real *T, const struct xform *x, struct work *w);

/* scan_carve: room of rank `rank` of `nrank` for its levels. */
void scan_carve(struct scan *s, struct carve *c, bool dense, bool incoming, int rank, int nrank);

/* scan_first: inclusive scan of the motion v (SPACE) in place, building the composites from level
 * 0.
 *
 *   level 0  in   incoming: T_k, frame k -> k-1 (rank 0: none); outgoing: T_{k+1}, frame k+1 -> k
 * (last rank: none) w        in/out  work done but not yet reported; reported at each communication
 * step */
void scan_first(struct scan *s, int tag, real *v, struct work *w);

/* scan_motion: another scan of a motion v (SPACE) with the composites of scan_first. */
void scan_motion(struct scan *s, int tag, real *v, struct work *w);

/* scan_force: reverse inclusive scan of a force f (SPACE), f_k += T_{k+1} f_{k+1}. */
void scan_force(struct scan *s, int tag, real *f, struct work *w);

/* work_report: tell the machine what was done since the last report. */
static inline void work_report(struct comm *c, struct work *w)
{
    comm_work(c, w);
    *w = (struct work){0};
}

#endif
