/* kernel.h - the table of kernels: parallel programs written against comm.h alone.
 *
 * A job is one evaluation shared by all ranks and read-only to them; their answers leave by comm_publish, which costs
 * no simulated time. */
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

/* What a program of multibody dynamics publishes. */
enum dynamics_output {
    OUTPUT_TAU,            /* (nu) inverse dynamics: joint forces, model order */
    OUTPUT_QDD,            /* (nu) forward dynamics: joint accelerations */
    OUTPUT_Q_END,          /* (nq) state after the last time step */
    OUTPUT_QD_END,         /* (nu) */
    OUTPUT_LAMBDA,         /* (nrow) loop forces */
    OUTPUT_RESIDUAL,       /* (nrank) largest constraint residual that each rank saw in all evaluations, relative */
    OUTPUT_RESIDUAL_SCALE, /* (nrank) what each rank's residual is relative to */
    OUTPUT_CONDITION,      /* (nrank) largest diagonal element over its last pivot, a lower bound of the condition of
                              the block-scaled system; 0: not seen by the solver */
    OUTPUT_REFINED,        /* (1) corrections applied by the first evaluation, inner and outer */
    OUTPUT_LOOP_RANK,      /* (1) rank of the loops' constraint matrix */
    DYNAMICS_OUTPUTS
};

/* What a micro-benchmark publishes. */
enum micro_output { OUTPUT_SECONDS /* (nrank) what each rank measured, simulated [s] */, MICRO_OUTPUTS };

enum { KERNEL_OUTPUTS = DYNAMICS_OUTPUTS };

struct kernel_job {
    const struct run_spec *spec;
    const struct model *model; /* NULL for kernels that need none (micro-benchmarks) */
    const struct state *state; /* q, qd, qdd, tau, external forces */
    struct job_omit omit;
    int nrank;
    const void *shared;     /* what prepare made: partition tables, constant inertias; read-only */
    struct comm_output output[KERNEL_OUTPUTS]; /* what the ranks are to publish; x NULL: not wanted */
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

/* job_output: the numbers of an output of the job, NULL where it is not wanted. job_want: n of them, zero, from `a`. */
static inline double *job_output(const struct kernel_job *job, int output) { return job->output[output].x; }
static inline void job_want(struct kernel_job *job, int output, int64_t n, struct arena *a)
{
    job->output[output] = (struct comm_output){TAKE(a, n > 0 ? n : 1, double), n};
}

/* kernel_list: all of them, (*n) pointers, in double precision. */
const struct kernel_type *const *kernel_list(int *n);

#endif
