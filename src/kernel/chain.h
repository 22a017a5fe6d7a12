/* chain.h - one rank's share of a chain: a contiguous block of bodies, and parallel Newton-Euler on
 * it.
 *
 * Inverse dynamics is three linear recurrences along the chain with the same transforms (physics 3;
 * Lee and Chang 1986): velocities and accelerations upwards, forces downwards. Each is a sweep over
 * the block, a scan over the ranks, and with more than one body a second sweep. */
#ifndef KERNEL_CHAIN_H
#define KERNEL_CHAIN_H

#include <stdbool.h>

#include "dynamics/algebra.h"
#include "kernel/carve.h"
#include "kernel/kernel.h"
#include "kernel/reduction.h"
#include "kernel/scan.h"
#include "model/model.h"

/* What all ranks share, made by prepare; read-only. */
struct chain_shared {
    const struct body *body;           /* (nbody) constants */
    struct row_layout layout;          /* bodies over ranks; constraints of each joint */
    /* room for a pose, a subspace: columns only if some joint needs them */
    size_t pose_bytes, subspace_bytes;
    real base[SPACE];                  /* acceleration of the base minus gravity */
};

/* One rank's share. Arrays over own bodies are indexed by i - lo. */
struct chain {
    struct comm *comm;
    const struct kernel_job *job;
    const struct chain_shared *shared;
    int n, lo, hi;
    bool dense;       /* operators as full square matrices */
    bool composed;    /* a scan has built the composites at these coordinates */
    struct work work; /* done since the last report */
    real *q, *u;      /* coordinates and rates of own bodies, from q_at and u_at of body lo */
    /* struct body_pose of own bodies, pose_bytes apart; one more for body hi if asked for */
    char *pose;
    real *matrix;     /* dense: the transforms as matrices, (SQUARE) each */
    struct scan scan;
    real *h;         /* (SPACE) joint velocity H u */
    real *v, *a, *f; /* (SPACE) velocity, acceleration, force */
    /* (SPACE) joint bias acceleration; h, v and b have no room when the job omits velocities */
    real *b;
};

/* chain_shared_make: from a job's model, state and number of ranks. */
struct chain_shared *chain_shared_make(const struct kernel_job *job, struct arena *a);

/* chain_carve: room for rank `rank`'s share; `edge`: with a pose for the right neighbour's first
 * body; `forces`: accelerations and forces will be wanted, not only velocities; `once`: each of the
 * three is computed once, so that accelerations take the room of the bias and forces that of the
 * joint velocities. The scan's room is the caller's to carve, so that it can be shared. */
void chain_carve(struct chain *ch, struct carve *c, const struct kernel_job *job, int rank,
                 bool edge, bool forces, bool once);

/* chain_load: coordinates and rates of own bodies from the job's state. */
void chain_load(struct chain *ch);

/* chain_place: transforms, subspaces and joint velocities of own bodies. */
void chain_place(struct chain *ch);

/* chain_velocity: v of own bodies; nothing when the job omits velocities. The first of the scans
 * upwards builds the composites of them all. Stage NE[1]. */
void chain_velocity(struct chain *ch);

/* chain_bias: b of own bodies from v; nothing when the job omits velocities. */
void chain_bias(struct chain *ch);

/* chain_acceleration: a of own bodies from b and u' (ud over own joints, NULL: zero). Stage
 * NE[2]. */
void chain_acceleration(struct chain *ch, const real *ud);

/* chain_force: f of own bodies, and joint forces tau over own joints. Stage NE[3]. */
void chain_force(struct chain *ch, real *tau);

/* chain_bias_force: joint forces tau over own joints at u' = 0: the three stages NE[1] to NE[3]. */
void chain_bias_force(struct chain *ch, real *tau);

/* chain_gyro: P - Fext of own body i into f (SPACE). */
void chain_gyro(struct chain *ch, int i, real *f);

/* chain_gain: Fext - P of own bodies into gain (SPACE each). */
void chain_gain(struct chain *ch, real *gain);

/* chain_pose: of own body i, or of body hi. */
static inline struct body_pose *chain_pose(const struct chain *ch, int i)
{
    return (struct body_pose *)(void *)(ch->pose + (size_t)(i - ch->lo) * ch->shared->pose_bytes);
}

/* chain_transform: the transform of own body i (or of body hi) in the form that the operators
 * use. */
static inline const real *chain_transform(const struct chain *ch, int i)
{
    return ch->dense ? ch->matrix + SQUARE * (i - ch->lo) : (const real *)&chain_pose(ch, i)->x;
}

/* chain_at: element i of an array of 6-vectors over own bodies. */
static inline real *chain_at(const struct chain *ch, real *array, int i)
{
    return array + SPACE * (i - ch->lo);
}

/* chain_u_at, chain_q_at: place of body i's first rate (coordinate) in arrays over own joints. */
static inline int chain_u_at(const struct chain *ch, int i)
{
    return ch->shared->body[i].u_at - ch->shared->body[ch->lo].u_at;
}
static inline int chain_q_at(const struct chain *ch, int i)
{
    return ch->shared->body[i].q_at - ch->shared->body[ch->lo].q_at;
}

/* chain_nu, chain_nq: rates (coordinates) of own joints. */
int chain_nu(const struct chain_shared *shared, int lo, int hi);
int chain_nq(const struct chain_shared *shared, int lo, int hi);

/* chain_report: tell the machine what was done since the last report. */
static inline void chain_report(struct chain *ch) { work_report(ch->comm, &ch->work); }

/* The stages of all kernels of dynamics. */
enum {
    STAGE_PLACE,
    STAGE_VELOCITY,
    STAGE_ACCELERATION,
    STAGE_FORCE,
    STAGE_ASSEMBLY,
    STAGE_SOLVE,
    STAGE_FINISH
};

#endif
