/* kernel.h - the texts of the built-in programs: what ranks execute, written against comm.h alone,
 * in each precision and space.
 *
 * A job is one evaluation shared by all ranks and read-only to them; their answers leave by
 * comm_publish, which costs no simulated time. */
#ifndef KERNEL_KERNEL_H
#define KERNEL_KERNEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/err.h"
#include "comm/comm.h"
#include "program/program.h"
#include "spec/run_spec.h"

struct model;
struct state;

/* What of the general program a job leaves out because it would only add zeros; all false: nothing.
 * run decides it from the scene (run/omission.h), the programs and the estimates only ask. */
struct job_omit {
    /* no joint moves, nor will: no velocities, bias accelerations and gyroscopic forces */
    bool velocity;
    bool load;     /* nor are there external forces: bodies carry no loads of their own */
    bool base;     /* the base does not accelerate, and there is no gravity */
    bool turn;     /* the base's acceleration has no angular part */
    /* velocity, load and base: the joint forces that the paper's formulation subtracts are zero */
    bool bias;
    int fixed;     /* bodies on fixed joints that have become part of others in job->model */
    bool branches; /* not left out: branch and loop phases, although nothing branches */
};

struct kernel_job {
    const struct run_spec *spec;
    const struct model *model; /* NULL for kernels that need none (micro-benchmarks) */
    const struct state *state; /* q, qd, qdd, tau, external forces */
    struct job_omit omit;
    unsigned keep; /* KEEP_* of the order */
    int nrank;
    const void *shared;     /* what prepare made: partition tables, constant inertias; read-only */
    bool watch;             /* the ranks are to publish what the solver sees of its own answer */
};

struct kernel_type {
    const char *name;
    const char *title; /* one line for people */
    bool needs_model;
    bool does_inverse, does_forward;
    bool planar; /* computes in three components: the scene must be planar (dynamics/planar.h) */
    struct rank_program rank; /* what each rank executes; its job is a struct kernel_job */

    /* accepts: false with ERR_CONFIG when this kernel cannot run the job (n < P, wrong model), of
     * which spec, model and omit are there. */
    bool (*accepts)(const struct kernel_job *job, struct err *e);

    /* prepare: tables shared by all ranks, from `a`, into job->shared; costs no simulated time. */
    bool (*prepare)(struct kernel_job *job, struct arena *a, struct err *e);

    /* estimate: counts by formula, without running. */
    void (*estimate)(const struct run_spec *spec, const struct model *model,
                     const struct job_omit *omit, struct program_estimate *out);
};

/* kernel_block: the first of n bodies that rank k has where ranks have equal numbers of them,
 * larger blocks first; of k = nrank, n. */
static inline int kernel_block(int n, int nrank, int k)
{
    return k * (n / nrank) + (k < n % nrank ? k : n % nrank);
}

/* kernel_find: a kernel of dynamics by name, in double precision; NULL when there is none. */
const struct kernel_type *kernel_find(const char *name);

/* kernel_find_precision: the same kernel computing in `precision`. */
const struct kernel_type *kernel_find_precision(const char *name, enum precision precision);

/* kernel_find_planar: the same kernel in three components instead of six, for planar scenes
 * (dynamics/planar.h). NULL when there is none. */
const struct kernel_type *kernel_find_planar(const char *name, enum precision precision);

#endif
