/* tree.h - one rank's piece of a tree, and parallel Newton-Euler on it by pointer jumping
 * (physics 6.4).
 *
 * Sweeps inside the piece; between pieces, the state of the anchor bodies is a recurrence along
 * each piece's ancestors, and jumping over 2^j of them at a time takes ceil(log2 depth) steps. */
#ifndef KERNEL_TREE_H
#define KERNEL_TREE_H

#include "dynamics/algebra.h"
#include "kernel/carve.h"
#include "kernel/closure.h"
#include "kernel/kernel.h"
#include "kernel/scan.h"
#include "kernel/tree_plan.h"

struct tree_shared {
    const struct tree_plan *plan;
    const struct body *body;              /* (nbody) */
    const struct closure_shared *closure; /* NULL without loops */
    real base[SPACE];                     /* acceleration of the base minus gravity */
};

/* Arrays over own bodies are in the order of plan.bodies; index l. */
struct tree {
    struct comm *comm;
    const struct kernel_job *job;
    const struct tree_shared *shared;
    int n, nu, nq;          /* own bodies, rates and coordinates */
    int piece;              /* this rank's piece; -1: none */
    const int *bodies;      /* (n) */
    const int *q_at, *u_at; /* (n + 1) places in q, u and all arrays over own joints */
    bool poses;             /* the base's place is wanted: composites all the way down */
    bool composed;          /* a scan has built the composites at these coordinates */
    struct work work;
    real *q, *u;
    struct body_pose *pose;
    real *h, *v, *a, *f, *b; /* (SPACE) joint velocity; velocity, acceleration, force; bias */
    /* composites of the anchor, (XFORM_NUMBERS) each: to the anchors 2^j pieces down */
    real *level;
    struct xform *base_pose; /* poses: anchor to base */
    real *path;              /* (XFORM_NUMBERS) body to the piece's anchor */
    real *in;                /* messages: a pair (transform, vector) */
};

/* tree_shared_make: from a job's model, state and number of ranks. */
struct tree_shared *tree_shared_make(const struct kernel_job *job, struct arena *a);

/* tree_carve: room for rank `rank`. */
void tree_carve(struct tree *t, struct carve *c, const struct kernel_job *job, int rank);

/* tree_load, tree_place, tree_velocity, tree_bias, tree_acceleration, tree_force: as those of
 * chain.h; `more` (own bodies x SPACE) is added to the bodies' forces, NULL: nothing. */
void tree_load(struct tree *t);
void tree_place(struct tree *t);
void tree_velocity(struct tree *t);
void tree_bias(struct tree *t);
void tree_acceleration(struct tree *t, const real *ud);
void tree_force(struct tree *t, real *tau, const real *more);

/* tree_gyro: P - Fext of own body l into f (SPACE). */
void tree_gyro(struct tree *t, int l, real *f);

/* tree_base_pose: own body l to base; needs `poses` and tree_velocity. */
void tree_base_pose(struct tree *t, int l, struct xform *x);

/* tree_parent: index of own body l's parent among own bodies; -1: it is the anchor (or the
 * base). */
static inline int tree_parent(const struct tree *t, int l)
{
    const int p = t->shared->body[t->bodies[l]].parent;
    return p >= 0 && t->shared->plan->owner[p] == t->piece ? t->shared->plan->local[p] : -1;
}

/* tree_body: constants of own body l. */
static inline const struct body *tree_body(const struct tree *t, int l)
{
    return &t->shared->body[t->bodies[l]];
}

/* tree_at: element l of an array of 6-vectors. */
static inline real *tree_at(real *array, int l) { return array + SPACE * l; }

/* tree_kids: pieces hanging at this one, (*n) of them. */
static inline const int *tree_kids(const struct tree *t, int *n)
{
    const struct tree_lists *kids = &t->shared->plan->kids;
    *n = t->piece < 0 ? 0 : kids->at[t->piece + 1] - kids->at[t->piece];
    return t->piece < 0 ? NULL : kids->item + kids->at[t->piece];
}

/* tree_report: tell the machine what was done since the last report. */
static inline void tree_report(struct tree *t) { work_report(t->comm, &t->work); }

#endif
