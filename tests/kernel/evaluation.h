/* evaluation.h - one kernel evaluation on many ranks without a simulator, compared with the serial
 * algorithms. */
#ifndef TESTS_KERNEL_EVALUATION_H
#define TESTS_KERNEL_EVALUATION_H

#include "../support/many_ranks.h"
#include "base/arena.h"
#include "kernel/kernel.h"
#include "model/model.h"

struct evaluation {
    struct many_ranks_result counts;
    /* relative to the largest reference element; 0 when not computed */
    double tau_error, qdd_error;
    double residual;             /* largest of all ranks */
    double condition;
    size_t rank_bytes; /* largest workspace */
    double *tau, *qdd; /* (nu) */
    double *q_end, *qd_end;
    double *lambda;
    double *measured;
    int loop_rank;
};

/* evaluation_spec: a chain of n revolute joints on P ranks, kernel `name`, everything else at its
 * usual value. */
struct run_spec evaluation_spec(const char *name, int n, int P);

/* evaluate: build the spec's model and state in `a`, run the kernel, compare with RNEA and ABA.
 * Asserts that the run ends, nothing is left unread and the kernel accepts the spec. */
struct evaluation evaluate(const struct run_spec *spec, struct arena *a);

/* evaluate_omitting: the same for a given model and state, without what the job is to leave out. */
struct evaluation evaluate_omitting(const struct run_spec *spec, const struct model *model,
                                    const struct state *state, struct job_omit omit,
                                    struct arena *a);

/* evaluate_unwatched: the same, nothing is left out, and nobody wants residuals. */
struct evaluation evaluate_unwatched(const struct run_spec *spec, const struct model *model,
                                     const struct state *state, struct arena *a);

/* evaluate_model: the same, and nothing is left out. */
struct evaluation evaluate_model(const struct run_spec *spec, const struct model *model,
                                 const struct state *state, struct arena *a);

#endif
