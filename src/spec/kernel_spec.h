/* kernel_spec.h - which parallel program runs on the virtual processors, in which variant. */
#ifndef SPEC_KERNEL_SPEC_H
#define SPEC_KERNEL_SPEC_H

#include <stdbool.h>
#include <stdint.h>

#include "spec/program_list.h"

enum formulation { FORMULATION_PAPER, FORMULATION_DIRECT };
enum solver {
    SOLVER_PCR_SYMMETRIC,
    SOLVER_PCR,
    SOLVER_CR,
    SOLVER_CR_PCR,
    SOLVER_PARTITION,
    SOLVER_THOMAS
};
enum operators { OPERATORS_STRUCTURED, OPERATORS_DENSE };
enum algebra { ALGEBRA_AUTO, ALGEBRA_SPATIAL, ALGEBRA_PLANAR };
enum precision { PRECISION_DOUBLE, PRECISION_FLOAT, PRECISION_QUAD };
enum part_solver { PART_PCR, PART_CR };
enum residual_rule { RESIDUAL_WORKING, RESIDUAL_TWICE };
enum partition_rule { PARTITION_BLOCK, PARTITION_BALANCED };
enum refinement_rule { REFINEMENT_AS_NEEDED, REFINEMENT_AS_GIVEN };
enum step_rule { STEP_SEMI_IMPLICIT, STEP_KDK, STEP_RK4, STEP_LINEARLY_IMPLICIT };

struct kernel_spec {
    /* a person's own program of this name (program_spec.h): no built-in one */
    bool own;
    char name[32]; /* "inverse", "forward", "dynamics" (both), "pingpong", ...: see room kernel */
    enum formulation formulation;
    enum solver solver;
    enum part_solver part_solver; /* what solver partition uses on the interfaces */
    /* dense: general 6x6 operators as the paper's code, structured: (r, p) pairs */
    enum operators operators;
    /* auto: planar where the scene is, unless the operators are dense */
    enum algebra algebra;
    enum precision precision;
    enum partition_rule partition;
    bool composites_incoming;    /* true: physics 3.1; false: the paper's outgoing form 3.2; trees
                                    and closed chains always take incoming ones */
    int hybrid_levels;           /* cr-pcr: levels of CR before PCR */
    /* as needed: more than the numbers below where the residual asks for it */
    enum refinement_rule refinement;
    /* precision of forces and residual of the direct form's refinement, chains */
    enum residual_rule residual;
    int inner_refinements;       /* residual corrections with stored factors */
    int outer_refinements;       /* corrections through inverse dynamics */
    int steps;                   /* time steps; 0: one evaluation */
    double step_size;            /* [s] */
    enum step_rule step;         /* how a time step is made, physics 9 */
    char algorithm[32];          /* collectives: by name, or "auto" */
    int repeat;                  /* micro-benchmarks: repetitions */
    int ring_ranks;              /* ring, random-ring: of one ring; 0: all in one */
    int64_t message_bytes;       /* micro-benchmarks: size [B] */
    int distance;                /* shift: rank distance */
    int root;                    /* collectives: rank; from the end when negative */
};

/* kernel_spec_has: whether the program has a trait (program_list.h). */
bool kernel_spec_has(const struct kernel_spec *k, enum program_trait trait);

/* kernel_spec_needs_model: false for the message benchmarks. */
bool kernel_spec_needs_model(const struct kernel_spec *k);

/* kernel_spec_implicit: whether its time steps treat springs linearly implicitly; false without
 * steps. */
static inline bool kernel_spec_implicit(const struct kernel_spec *k)
{
    return k->steps > 0 && k->step == STEP_LINEARLY_IMPLICIT;
}

#endif
