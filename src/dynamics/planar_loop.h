/* planar_loop.h - loop joints of a planar scene: what loop.h is for space.
 *
 * A constraint acts by its part in the plane; those without any are left out, and their forces are
 * zero. */
#ifndef DYNAMICS_PLANAR_LOOP_H
#define DYNAMICS_PLANAR_LOOP_H

#include <stdbool.h>

#include "linalg/planar.h"
#include "model/model.h"

struct loop {
    int body_a, body_b; /* -1: the base */
    int c, row_at;      /* constraints that act; the first one's place among those of all loops */
    bool by_rows;
    struct xform a, b; /* frame a, b in the planar frames of their bodies */
    real w[6 * SPACE]; /* column k at w + SPACE k, [about the normal; x, y] */
    real alpha, beta;
};

/* A loop in a configuration and motion; shapes as in loop.h. */
struct loop_pose {
    struct xform ta, tb;
    int c;
    real w[6 * SPACE];
    real gamma[SPACE];
    real stabilise[6];
};

/* loop_rows: constraints of all loops that act in the plane. */
int loop_rows(const struct model *m);

/* loops_make: the constants of all loops (nloop), and of each acting constraint the place in the
 * model's lambda. */
void loops_make(const struct model *m, struct loop *loop, int *place);

/* loop_place, loop_place_flops: as in loop.h. */
int loop_place_flops(const struct loop *l);
void loop_place(const struct loop *l, const struct xform *xa, const struct xform *xb,
                const real *va, const real *vb, struct loop_pose *p);

/* loop_column: as in loop.h. */
void loop_column(const struct loop_pose *p, bool side_b, real *out);

#endif
