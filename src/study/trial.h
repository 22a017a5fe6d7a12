/* trial.h - one evaluation of a parallel kernel on virtual processors, without references: for
 * ladders and suites.
 *
 * A trial never ends the program that makes it: a kernel that refuses the scene or a machine that
 * cannot run the level is an outcome with its reason. */
#ifndef STUDY_TRIAL_H
#define STUDY_TRIAL_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "measure/run_result.h"
#include "model/model.h"
#include "program/program.h"
#include "spec/run_spec.h"

struct trial {
    bool answered;      /* the program ran to its end; the numbers may still be no numbers */
    char text[160];     /* why not */
    double *tau, *qdd;  /* (nu) NULL when the task has none */
    double *lambda;     /* (nrow) loop forces, NULL when there are no loops */
    int loop_rank;      /* of the loops' constraint matrix; -1: no loops */
    double residual;    /* largest over the ranks, relative; NaN when a rank's is */
    int refined;        /* corrections applied, inner and outer */
    double condition;   /* largest over the ranks, a lower bound; 0: not known */
    int64_t makespan_ps;
    int64_t *finish_ps; /* (nrank) */
    double host_s;      /* wall time of the simulation */
};

/* trial_run: run spec->kernel on spec->machine with spec->nrank processors for model m (NULL:
 * kernels without a model) in state s. Memory from a; where the system refuses memory the process
 * ends (check_memory). */
struct trial trial_run(const struct run_spec *spec, const struct model *m, const struct state *s,
                       struct arena *a);

/* trial_open: the program of `spec` opened (program.h) for that model and state, or for what it
 * asks for where m is NULL. Memory from a. Returns false with *e set when it cannot run them. */
bool trial_open(struct program_run *r, const struct run_spec *spec, const struct model *m,
                const struct state *s, struct arena *a, struct err *e);

/* trial_machine: a crossbar of nrank processors; answers do not depend on the machine. */
struct machine_spec trial_machine(int nrank);

/* trial_error: max |x - reference| / max |reference| over n numbers; INFINITY when x or the
 * reference has what is no number, 0 for equal. */
double trial_error(const double *x, const double *reference, int n);

/* trial_change_error: max |x - reference| over the largest number (of n) that the reference has at
 * the end of a motion or `begin` at its beginning: what has come to rest would have no scale of its
 * own. INFINITY when x or the reference has no numbers. */
double trial_change_error(const double *x, const double *reference, const double *begin, int n);

#endif
