/* accuracy_arithmetic.c - the arithmetic ladder: accelerations by every algorithm in every
 * precision. */
#include <math.h>
#include <stdio.h>

#include "base/progress.h"
#include "base/text.h"
#include "dynamics/dynamics_table.h"
#include "dynamics/planar_dynamics.h"
#include "kernel/omission.h"
#include "machine/node_cost.h"
#include "study/accuracy_ladder.h"
#include "study/trial.h"

/* Articulated bodies in quad precision: rounding is some 1e-34, far below every other rung. */
static const char reference_name[] = "quad aba";
static const char *const precision_name[] = {"double", "float", "quad"};
/* Rungs of a method in the order in which their errors fall. */
static const enum precision from_coarse[] = {PRECISION_FLOAT, PRECISION_DOUBLE, PRECISION_QUAD};
/* Quad precision is arithmetic by libquadmath, and factoring a dense mass matrix is O(n^3). */
enum {
    MOST_DENSE = 300
}; /* degrees of freedom beyond which the mass matrix takes too long in quad precision */

/* What is worth using; above a tenth an answer is none. */
static void grade(struct accuracy_rung *r, double error) { ladder_grade(r, error, 1e-2, 0.1); }

/* Seconds of one evaluation (t NULL: articulated bodies in three components), set-up included: the
 * best of three batches of some milliseconds. */
static double time_forward(struct ladder *l, const struct dynamics_type *t,
                           enum forward_method method, double *qdd)
{
    /* Batches: one evaluation of a small scene is shorter than the clock can tell. The minimum
     * of the batches, not their mean: a busy computer only ever makes them longer. */
    double best = INFINITY;
    for (int batch = 0; batch < 3; batch++) {
        double begin = host_seconds(), spent;
        int n = 0;
        do {
            struct work w = {0};
            /* Each evaluation begins with the same memory, as if it were the first. */
            struct arena_mark mark = arena_mark(l->arena);
            if (t) t->forward(l->model, l->state, method, l->arena, qdd, NULL, NULL, &w);
            else planar_forward(l->model, l->state, l->arena, qdd, &w);
            arena_release(l->arena, mark);
            spent = host_seconds() - begin;
        } while (++n < 1000 && spent < 2e-3);
        best = fmin(best, spent / n);
    }
    return best;
}

/* One serial algorithm in one precision: a row that fails with its reason, or an error with both
 * costs. *reference has (nu) accelerations. */
static void serial_rung(struct ladder *l, enum forward_method method, enum precision precision,
                        const double *reference)
{
    const struct dynamics_type *t = dynamics_type_of(precision);
    double *qdd = TAKE(l->arena, l->model->nu, double);
    char name[48];
    snprintf(name, sizeof name, "serial %s", forward_method_name(method));
    struct accuracy_rung *r = ladder_add(l, name, precision_name[precision], "qdd", reference_name);
    bool dense = method == FORWARD_CRBA || method == FORWARD_CRBA_SPARSE;
    if (dense && precision == PRECISION_QUAD && l->model->nu > MOST_DENSE) {
        text_copy(r->text, sizeof r->text,
                  "left out: more than 300 degrees of freedom in quad precision");
        return;
    }
    /* Once with counted operations, for the error and the predicted time; timed separately
     * below, without anything else between the clock's readings. */
    struct work w = {0};
    struct forward_report report = {0};
    if (!t->forward(l->model, l->state, method, l->arena, qdd, NULL, &report, &w)) {
        text_copy(r->text, sizeof r->text, "a pivot was not positive");
        return;
    }
    if (report.fell_back) text_copy(r->text, sizeof r->text,
                                    "solved by articulated bodies instead");
    /* The row stays: it shows what the robust algorithm answers, but its error is that of
     * articulated bodies. */
    grade(r, trial_error(qdd, reference, l->model->nu));
    struct node_cost cost = node_cost_make(&l->spec.machine.node);
    /* No machine file has a price for quad arithmetic. Float costs as much as double there. */
    if (precision != PRECISION_QUAD) r->machine_ps = node_cost_ps(&cost, &w);
    r->host_s = time_forward(l, t, method, qdd);
}

/* The serial code that the parallel programs have to beat where they compute in three components,
 * too. */
static void planar_rung(struct ladder *l, const double *reference)
{
    struct err e;
    err_clear(&e);
    /* The planar code applies only where the parallel kernel would choose it by itself
     * (omission.h). */
    const struct kernel_type *kernel = omission_kernel(&l->spec, 0, l->model, l->state, &e);
    if (!kernel || !kernel->planar) return;
    double *qdd = TAKE(l->arena, l->model->nu, double);
    struct accuracy_rung *r = ladder_add(l, "serial planar aba", "double", "qdd", reference_name);
    struct work w = {0};
    if (!planar_forward(l->model, l->state, l->arena, qdd, &w)) {
        text_copy(r->text, sizeof r->text, "a pivot was not positive");
        return;
    }
    struct node_cost cost = node_cost_make(&l->spec.machine.node);
    grade(r, trial_error(qdd, reference, l->model->nu));
    r->machine_ps = node_cost_ps(&cost, &w);
    r->host_s = time_forward(l, NULL, FORWARD_ABA, qdd);
}

/* All serial algorithms in all precisions, then the planar one. */
static void serial_rungs(struct ladder *l, const double *reference)
{
    /* Method by method, so that the points of one curve follow each other. */
    for (int m = 0; m < FORWARD_METHODS; m++)
        for (int p = 0; p < 3; p++) {
            struct arena_mark mark = arena_mark(l->arena);
            serial_rung(l, (enum forward_method)m, from_coarse[p], reference);
            arena_release(l->arena, mark);
        }
    planar_rung(l, reference);
}

/* --- on the machine --------------------------------------------------------------------------- */

/* The solvers of the forward kernel's block tridiagonal system. PART_CR or PART_PCR solves the
 * reduced system of the partition method; the other solvers ignore it. */
static const struct {
    const char *name;
    enum solver solver;
    enum part_solver part;
} solver_table[] = {
    {"thomas", SOLVER_THOMAS, PART_CR}, {"cr", SOLVER_CR, PART_CR}, {"pcr", SOLVER_PCR, PART_CR},
    {"pcr-symmetric", SOLVER_PCR_SYMMETRIC, PART_CR}, {"cr-pcr", SOLVER_CR_PCR, PART_CR},
    {"partition+cr", SOLVER_PARTITION, PART_CR}, {"partition+pcr", SOLVER_PARTITION, PART_PCR},
};
enum { SOLVERS = sizeof solver_table / sizeof *solver_table };

static const struct {
    const char *name;
    int inner, outer;
    enum residual_rule residual; /* twice: the direct form of open chains */
} refinement_table[] = {{"", 0, 0, RESIDUAL_WORKING}, {" inner", 1, 0, RESIDUAL_WORKING},
                        {" robust", 1, 1, RESIDUAL_WORKING}, {" twice", 4, 0, RESIDUAL_TWICE}};

/* One parallel forward dynamics on the machine of the scenario, with a row whatever its outcome. */
static void parallel_rung(struct ladder *l, const struct kernel_spec *kernel, const char *method,
                          const char *rung, const double *reference)
{
    struct run_spec spec = l->spec;
    spec.kernel = *kernel;
    /* Recording would cost host time that a normal run does not spend. */
    spec.record = (struct record_spec){0};
    struct arena_mark mark = arena_mark(l->arena);
    struct trial t = trial_run(&spec, l->model, l->state, l->arena);
    struct accuracy_rung *r = ladder_add(l, method, rung, "qdd", reference_name);
    text_copy(r->text, sizeof r->text, t.text);
    if (t.answered) {
        grade(r, trial_error(t.qdd, reference, l->model->nu));
        /* The residual is known without a reference: telling it beside the true error shows how
         * far a user may trust it. */
        int length = isnan(t.residual)
                         ? snprintf(r->text, sizeof r->text,
                                    "the residual is no number")
                         : snprintf(r->text, sizeof r->text, "residual %.1e", t.residual);
        if (t.condition > 0)
            snprintf(r->text + length, sizeof r->text - (size_t)length, ", condition %.1e",
                     t.condition);
        /* One trial gives both costs; only the host's time has noise, so only that is repeated. */
        r->machine_ps = t.makespan_ps;
        r->host_s = t.host_s;
        for (int i = 0; i < 2 && t.host_s < 5e-3;
             i++) /* the fastest of a few: the others were disturbed */
            r->host_s = fmin(r->host_s, trial_run(&spec, l->model, l->state, l->arena).host_s);
    }
    arena_release(l->arena, mark);
}

/* One solver in one formulation: float and double, each with all refinements. Quad is left out:
 * a parallel program in it has no price on the machine. */
static void solver_rungs(struct ladder *l, enum formulation f, int solver, const char *solver_name,
                         const double *reference)
{
    char method[48], rung[32];
    snprintf(method, sizeof method, "%s %s", f == FORMULATION_PAPER ? "paper" : "direct",
             solver_name);
    /* The doubled residual exists for the direct form of open chains alone (kernel_spec.h). */
    const bool has_twice = f == FORMULATION_DIRECT && l->model->is_chain && l->model->nloop == 0;
    for (int p = 0; p < 2; p++)
        for (int k = 0; k < (has_twice ? 4 : 3); k++) {
            struct kernel_spec kernel = {.name = "forward",
                                         .formulation = f,
                                         .solver = solver_table[solver].solver,
                                         .part_solver = solver_table[solver].part,
                                         .precision = from_coarse[p],
                                         .algebra = l->spec.kernel.algebra,
                                         .composites_incoming = true,
                                         .hybrid_levels = 1,
                                         .residual = refinement_table[k].residual,
                                         .inner_refinements = refinement_table[k].inner,
                                         .outer_refinements = refinement_table[k].outer};
            snprintf(rung, sizeof rung, "%s%s", precision_name[from_coarse[p]],
                     refinement_table[k].name);
            parallel_rung(l, &kernel, method, rung, reference);
        }
}

/* Serial codes first: they need no machine to be right, and show what the parallel ones may
 * reach. */
void ladder_arithmetic(struct ladder *l)
{
    const struct model *m = l->model;
    double *reference = TAKE(l->arena, m->nu, double);
    struct work w = {0};
    /* Without a reference there is no error to tell: one failed row says so, instead of an empty
     * ladder. */
    if (!dynamics_type_of(PRECISION_QUAD)
             ->forward(m, l->state, FORWARD_ABA, l->arena, reference, NULL, NULL, &w)) {
        struct accuracy_rung *r = ladder_add(l, "serial aba", "quad", "qdd", reference_name);
        text_copy(r->text, sizeof r->text, "the reference itself broke down");
        return;
    }
    serial_rungs(l, reference);
    bool chain =
        m->is_chain && m->nloop == 0; /* trees and loops are contracted: no solver to choose */
    for (int f = 0; f < 2; f++)
        for (int s = 0; s < (chain ? (int)SOLVERS : 1); s++)
            solver_rungs(l, (enum formulation)f, s, chain ? solver_table[s].name : "contraction",
                         reference);
}
