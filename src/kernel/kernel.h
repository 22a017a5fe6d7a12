/* kernel.h - the table of kernels: parallel programs written against comm.h alone.
 *
 * A job is one evaluation shared by all ranks: what is given is read-only, each rank writes only its own bodies'
 * answers into the output arrays. (The gathering of answers for the check costs no simulated time; neither do
 * `residual` and `condition`, which the answer does not need.) */
#ifndef KERNEL_KERNEL_H
#define KERNEL_KERNEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/err.h"
#include "comm/comm.h"
#include "spec/run_spec.h"

struct model;
struct state;

/* What of the general program a job leaves out because it would only add zeros; all false: nothing. run decides it from
 * the scene (run/omission.h), the programs and the estimates only ask. */
struct job_omit {
    bool velocity; /* no joint moves, nor will: no velocities, bias accelerations and gyroscopic forces */
    bool load;     /* nor are there external forces: bodies carry no loads of their own */
    bool base;     /* the base does not accelerate, and there is no gravity */
    bool turn;     /* the base's acceleration has no angular part */
    bool bias;     /* velocity, load and base: the joint forces that the paper's formulation subtracts are zero */
    int fixed;     /* bodies on fixed joints that have become part of others in job->model */
};

struct kernel_job {
    const struct run_spec *spec;
    const struct model *model; /* NULL for kernels that need none (micro-benchmarks) */
    const struct state *state; /* q, qd, qdd, tau, external forces */
    struct job_omit omit;
    int nrank;
    const void *shared;     /* what prepare made: partition tables, constant inertias; read-only */
    double *tau;            /* out (nu): inverse dynamics, model order; NULL if the task has none */
    double *qdd;            /* out (nu): forward dynamics; NULL if the task has none */
    double *q_end, *qd_end; /* out: state after the last time step; NULL when steps = 0 */
    double *lambda;         /* out: loop forces; NULL without loops */
    double *measured;       /* out (nrank): micro-benchmarks: one number per rank [s]; NULL otherwise */
    double *residual;       /* out (nrank): largest constraint residual seen by each rank in all evaluations, relative;
                               may be NULL */
    double *residual_scale; /* out (nrank): what each rank's residual is relative to; may be NULL */
    double *condition;      /* out (nrank): largest diagonal element over its last pivot, a lower bound of the
                               condition of the block-scaled system; 0: not seen by the solver; may be NULL */
    int *refined;           /* out (1): corrections applied by the first evaluation, inner and outer; may be NULL */
    int *loop_rank;         /* out (1): rank of the loops' constraint matrix; may be NULL */
};

/* What a run will cost, known before it runs (mimdsim explain). */
struct kernel_estimate {
    double messages, bytes; /* sent, all ranks */
    double flops;           /* all ranks */
    double rank_bytes;      /* host memory per rank, workspace and messages in flight */
};

struct kernel_type {
    const char *name;
    const char *title; /* one line for people */
    bool needs_model;
    bool does_inverse, does_forward;
    bool planar; /* computes in three components: the scene must be planar (dynamics/planar.h) */
    int nstage;
    const char *const *stage_name; /* (nstage) */

    /* accepts: false with ERR_CONFIG when this kernel cannot run the spec (n < P, wrong model). */
    bool (*accepts)(const struct run_spec *spec, const struct model *model, struct err *e);

    /* prepare: tables shared by all ranks, from `a`, into job->shared; costs no simulated time. */
    bool (*prepare)(struct kernel_job *job, struct arena *a, struct err *e);

    /* workspace_bytes: private memory of rank `rank`; given zeroed to run, aligned to 16. */
    size_t (*workspace_bytes)(const struct kernel_job *job, int rank);

    /* largest_message: no message of this job is larger [B]; -1: not known. May be NULL: not known. */
    int64_t (*largest_message)(const struct kernel_job *job);

    /* run: the program of one rank. */
    void (*run)(struct comm *c, const struct kernel_job *job, void *workspace);

    /* estimate: counts by formula, without running. */
    void (*estimate)(const struct run_spec *spec, const struct model *model, const struct job_omit *omit,
                     struct kernel_estimate *out);
};

/* kernel_find: by name, in double precision; NULL when there is none. */
const struct kernel_type *kernel_find(const char *name);

/* kernel_find_precision: the same kernel computing in `precision`. Micro-benchmarks are the same in all. */
const struct kernel_type *kernel_find_precision(const char *name, enum precision precision);

/* kernel_find_planar: the same kernel in three components instead of six, for planar scenes (dynamics/planar.h). NULL
 * when there is none. */
const struct kernel_type *kernel_find_planar(const char *name, enum precision precision);

/* kernel_list: all of them, (*n) pointers, in double precision. */
const struct kernel_type *const *kernel_list(int *n);

#endif
