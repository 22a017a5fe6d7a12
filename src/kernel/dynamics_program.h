/* dynamics_program.h - the programs "inverse", "forward" and "dynamics" as room program wants them:
 * scenes, omissions, outputs, what may be trusted, references. */
#ifndef KERNEL_DYNAMICS_PROGRAM_H
#define KERNEL_DYNAMICS_PROGRAM_H

#include "kernel/kernel.h"
#include "kernel/scene.h"
#include "program/program.h"

/* What they publish. */
enum dynamics_output {
    OUTPUT_TAU,      /* (nu) inverse dynamics: joint forces, model order */
    OUTPUT_QDD,      /* (nu) forward dynamics: joint accelerations */
    OUTPUT_Q_END,    /* (nq) state after the last time step */
    OUTPUT_QD_END,   /* (nu) */
    OUTPUT_LAMBDA,   /* (nrow) loop forces */
    OUTPUT_RESIDUAL, /* (nrank) largest constraint residual that each rank saw in all evaluations,
                        relative */
    OUTPUT_RESIDUAL_SCALE, /* (nrank) what each rank's residual is relative to */
    OUTPUT_CONDITION, /* (nrank) largest diagonal element over its last pivot, a lower bound of the
                         condition of the block-scaled system; 0: not seen by the solver */
    OUTPUT_REFINED,   /* (1) corrections applied by the first evaluation, inner and outer */
    OUTPUT_LOOP_RANK  /* (1) rank of the loops' constraint matrix; -1: no loops */
};

/* program_run.own of these programs. */
struct dynamics_run {
    /* the text in the precision and the space that the settings ask for */
    const struct kernel_type *kernel;
    struct kernel_job job;
    struct scene *scene;              /* NULL: opened for a given model, without references */
    struct kernel_spec given;         /* the settings before refinements were added */
    double residual_before;           /* of the first attempt */
    int attempts;
    bool reverted;                    /* refinements did not help: the given settings hold */
};

/* dynamics_open: open such a program for a model and a state at hand instead of the spec's scene;
 * then check and baselines are not to be called. r->type, spec and arena are set. Returns false as
 * program_type.open. */
bool dynamics_open(struct program_run *r, const struct model *m, const struct state *s,
                   struct err *e);

/* dynamics_run_of: own of a run of one of these programs. */
static inline struct dynamics_run *dynamics_run_of(const struct program_run *r) { return r->own; }

#endif
