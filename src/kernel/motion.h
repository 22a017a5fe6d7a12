/* motion.h - a rank integrates its own joints in time (physics 9): semi-implicit Euler,
 * kick-drift-kick, Runge-Kutta 4.
 *
 * The accelerations come from a forward dynamics program on the coordinates and rates that are
 * advanced here; ranks meet only in there. Coordinates move along their group; in Runge-Kutta
 * stages quaternions are plain numbers, normalised at the end of the step. */
#ifndef KERNEL_MOTION_H
#define KERNEL_MOTION_H

#include "dynamics/algebra.h"
#include "kernel/carve.h"
#include "kernel/kernel.h"

/* The worst of all evaluations that a rank has seen. */
struct motion_seen {
    double residual, scale; /* largest violation, relative to the largest term */
    double condition;
    bool any;
};

struct motion {
    const struct kernel_job *job;
    struct comm *comm;
    const struct body *body; /* of all bodies */
    const int *bodies;       /* (n) own bodies; NULL: first, first + 1, .. */
    int first, n, nq, nu;
    real *q, *u;                     /* own coordinates and rates, body after body: advanced */
    const real *ud;                  /* own accelerations, made by evaluate */
    void (*evaluate)(void *program); /* ud from q and u; every rank must call it */
    void *program;
    struct work *work;
    struct motion_seen seen;
    /* q, u at the beginning of the step; sums of slopes; last accelerations */
    real *q0, *u0, *dq, *qsum, *usum, *a;
};

/* motion_carve: room for stepping nq coordinates and nu rates. */
void motion_carve(struct motion *m, struct carve *c, const struct kernel_job *job, int nq, int nu);

/* motion_run: all time steps of the job; publishes the last state and what was seen on the way.
 * Without time steps one evaluation. */
void motion_run(struct motion *m);

/* motion_watch: what this rank saw in one more evaluation, a residual relative to `scale` and a
 * condition: *seen keeps the largest of all evaluations so far. A number that is none stays. */
void motion_watch(struct motion_seen *seen, real residual, real scale, real condition);

#endif
