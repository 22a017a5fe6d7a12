/* revolute.h - compact constants and the fast paths of systems whose joints are all revolute.
 *
 * A body takes 22 numbers in one piece of memory; r = E Rz(q) and the joint's simple H and b are
 * exploited throughout. Second moments S = tr(J)/2 U - J replace the inertia: with K = w'~ + w~ w~
 * the moment about the centre of mass is the skew part of K S (33 flops instead of 42), and K gives
 * both the centre's and the children's accelerations. */
#ifndef DYNAMICS_REVOLUTE_H
#define DYNAMICS_REVOLUTE_H

#include "dynamics/dynamics.h"

struct revolute {
    real e[9], t[3]; /* joint frame -> parent's body frame */
    real m, s[3];    /* mass; centre of mass */
    real second[6];  /* second moments of mass about the centre of mass, xx xy xz yy yz zz */
    int parent;
};

/* revolutes_take: of all bodies of d, from their constants. */
struct revolute *revolutes_take(const struct model *m, const struct body *b, struct arena *a);

/* rnea_revolute, aba_revolute, crba_revolute: rnea, aba and crba for d->revolute. w may be NULL. */
void rnea_revolute(struct dynamics *d, const real *q, const real *u, const real *ud, real *tau,
                   struct work *w);
bool aba_revolute(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
                  struct work *w);
void crba_revolute(struct dynamics *d, const real *q, real *mass, struct work *w);

/* rnea_revolute_part: of the bodies of d->model that are here, see dynamics_table.h. False: a
 * neighbour is silent. */
struct part_ends;
bool rnea_revolute_part(struct dynamics *d, const real *q, const real *u, const real *ud,
                        const struct part_ends *ends, real *tau, struct work *w);

/* aba_revolute_part: as rnea_revolute_part; *found: no joint of this part broke it down. */
bool aba_revolute_part(struct dynamics *d, const real *q, const real *u, const real *tau,
                       const struct part_ends *ends, real *ud, bool *found, struct work *w);

/* What a fast path executes [flop]: for each body, for each that hangs on another one besides. */
struct revolute_cost {
    int body, child, div; /* div: divisions a body */
};

/* revolute_count: *w += that for all bodies of d, a sine, a cosine and a call each. w may be
 * NULL. */
void revolute_count(const struct dynamics *d, struct revolute_cost cost, struct work *w);

#endif
