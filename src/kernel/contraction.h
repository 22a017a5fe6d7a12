/* contraction.h - parallel forward dynamics of a tree: the constraint force system eliminated in
 * the order of a tree contraction, one rank's program (physics 6.2).
 *
 * A compound is a connected set of bodies with a top joint and one open bottom body:
 *
 *     a_1 = P11 f_1 + P12 f_2 + beta_1,   a_2 = P12^T f_1 + P22 f_2 + beta_2
 *
 * f_1 acts at the top joint, f_2 at the bottom body. Loads come in columns: the real ones first,
 * then one for each loop constraint. The paper's formulation contracts what remains of tau after a
 * bias inverse dynamics, without velocity terms; the direct one keeps those in beta and in the
 * joints' biases. Refinements contract again, with the residual for a load. */
#ifndef KERNEL_CONTRACTION_H
#define KERNEL_CONTRACTION_H

#include "kernel/compound.h"
#include "kernel/motion.h"
#include "kernel/tree.h"

/* What is given for one solution: zero where a pointer is NULL. */
struct contraction_given {
    const real *active; /* own joints: joint forces, column 0 */
    const real *bias;   /* own bodies (SPACE): joint bias accelerations, column 0 */
    const real *load;   /* own bodies (SPACE x room): external loads of all columns */
    const real *base;   /* (SPACE) acceleration of the base, column 0 */
};

struct contraction {
    struct tree tree;
    struct closure closure;
    bool direct;
    int room; /* columns that arrays are made for: 1 + loop constraints */
    int m;    /* columns of the present solution */
    struct contraction_given given;
    real *tau;           /* own joints: given forces and springs */
    real *active;        /* own joints: forces of the present solution */
    real *ud;            /* (room x own joints) answers of all columns */
    real *answer;        /* own joints */
    real *load;          /* own bodies (SPACE x room) */
    real *compound;      /* own bodies: P11, P12, P22, beta_1, beta_2 (compound.h) */
    real *f1, *f2;       /* own bodies (SPACE x room) */
    real *acceleration;  /* own bodies (SPACE x room) */
    real *offset;        /* own bodies (SPACE): accelerations that column 0 does not contain */
    real *residual_bias; /* own bodies (SPACE) */
    real *joint;         /* own bodies: N (PACKED), h (SPACE x room) of a raked joint */
    real *record;        /* what undoing the operations into own compounds needs */
    int *record_at;      /* (own operations) */
    real *message, *anchor_acceleration;
    real **side; /* (2 nloop) accelerations of own loop sides */
    real *side_room;
    real *lambda; /* (nrow) loop forces, summed over refinements */
    struct motion motion;
    int refined; /* corrections applied */
    bool published; /* the first evaluation's answer is out */
    real residual, residual_scale; /* largest constraint residual over this */
    bool broken;
};

/* contraction_carve: room for rank `rank`. */
void contraction_carve(struct contraction *k, struct carve *c, const struct kernel_job *job,
                       int rank);

/* contraction_set: the communicator of this rank. */
void contraction_set(struct contraction *k, struct comm *c);

/* contraction_run: the job's evaluation or time steps; the first evaluation's answer into the job's
 * arrays. */
void contraction_run(struct contraction *k);

/* contraction_solve: f1, f2 of all own bodies for what is given (k->given, k->m columns): contract,
 * then undo. */
void contraction_solve(struct contraction *k);

/* contraction_record_size: numbers that an operation leaves for its undoing at the rank of its
 * `into`. */
static inline int contraction_record_size(enum tree_kind kind, int room)
{
    return kind == TREE_RAKE ? COMPOUND_MATRICES + 2 * SPACE * room
                             : 2 * SQUARE + XFORM_NUMBERS + SPACE * room;
}

#endif
