/* loop.h - a loop joint's local computations: frames, constraint subspace, velocity terms.
 *
 * A loop joint acts in a loop frame. Its force F = W lambda acts on body b as T_b F and on body a
 * as -T_a F; with A classical, W^T (T_b^T A_b - T_a^T A_a + gamma) + 2 alpha W^T rho + beta^2 g = 0
 * (physics 7.2). Loops given by rows use frame a's axes and each body's own point; those by a joint
 * use frame b (physics 7.3). */
#ifndef DYNAMICS_LOOP_H
#define DYNAMICS_LOOP_H

#include <stdbool.h>

#include "base/work.h"
#include "linalg/real.h"
#include "linalg/spatial.h"
#include "model/model.h"

struct loop {
    int body_a, body_b;      /* -1: the base */
    int c, row_at;           /* constraints; the first one's place in lambda */
    bool by_rows;
    enum model_joint joint;
    struct xform a, b;       /* frame a, b in the internal frames of their bodies */
    real row[36];            /* by_rows: column k at row + 6 k, [angular; linear] */
    real alpha, beta;
};

/* A loop in a configuration and motion. */
struct loop_pose {
    struct xform ta, tb;     /* loop frame -> internal frame of a, of b */
    int c;
    real w[36];              /* (6 x c) column k at w + 6 k */
    real gamma[6];           /* velocity-dependent acceleration */
    real stabilise[6];       /* (c) 2 alpha W^T rho + beta^2 g */
    real g[6], rho[6];       /* (c) violation of position and velocity: g, W^T rho */
};

/* loop_make: the constants of loop i of m. */
void loop_make(const struct model *m, int i, struct loop *l);

/* loop_rows: constraints of all loops. loops_make: the constants of all loops (nloop), and of each
 * constraint its place in the model's lambda. */
static inline int loop_rows(const struct model *m) { return m->nrow; }
static inline void loops_make(const struct model *m, struct loop *loop, int *place)
{
    for (int l = 0; l < m->nloop; l++) loop_make(m, l, &loop[l]);
    for (int k = 0; k < m->nrow; k++) place[k] = k;
}

/* loop_place: the loop's pose and velocity terms.
 *
 *   xa, xb  in  transforms of the internal frames of a and b to the base, or to any one common
 * frame (identity for the base) va, vb  in  (6) velocities of a and b in their internal frames
 * (zero for the base)
 *
 * loop_place_flops: what it executes. */
void loop_place(const struct loop *l, const struct xform *xa, const struct xform *xb,
                const real *va, const real *vb, struct loop_pose *p);
int loop_place_flops(const struct loop *l);

/* loop_force: adds -T_a W lambda to fa (6) and T_b W lambda to fb (6), internal frames; either may
 * be NULL. 12 flops a constraint, XFORM_FORCE_FLOP + SCREW_ADD_FLOP a side. */
void loop_force(const struct loop_pose *p, const real *lambda, real *fa, real *fb);

/* loop_column: T_b W (6 x c, column k at out + 6 k) for side b, -T_a W for side a: the loop's
 * columns at a body. XFORM_FORCE_FLOP a constraint. */
void loop_column(const struct loop_pose *p, bool side_b, real *out);

/* loop_residual: r (c) = W^T (T_b^T ab - T_a^T aa + gamma) + stabilise, for accelerations (6) of
 * the two bodies. LOOP_RESIDUAL_FLOP and 12 a constraint. */
enum { LOOP_RESIDUAL_FLOP = 2 * XFORM_MOTION_FLOP + 2 * SCREW_ADD_FLOP };
void loop_residual(const struct loop_pose *p, const real *aa, const real *ab, real *r);


#endif
