/* trust.c - residual and condition of a run; see trust.h.
 *
 * The solver sees by how much its answer violates the constraints, and how much of the diagonal
 * elimination has used up. Neither needs a reference, so that answers are judged where no serial
 * code could run. */
#include "kernel/trust.h"

#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "kernel/divided.h"
#include "kernel/dynamics_program.h"
#include "kernel/estimate.h"
#include "kernel/references.h"

/* A number that is none must not hide behind the others. */
static double worst(const double *x, int n)
{
    double largest = 0;
    for (int i = 0; x && i < n; i++)
        if (isnan(x[i])) return x[i];
        else if (x[i] > largest) largest = x[i];
    return largest;
}

/* What the ranks that are here have seen. */
struct seen {
    double residual, scale; /* the residual is absolute where there is a scale */
    double condition;
};

static struct seen seen_by(const struct program_run *r)
{
    const double *x = program_output(r, OUTPUT_RESIDUAL),
                 *of = program_output(r, OUTPUT_RESIDUAL_SCALE),
                 *condition = program_output(r, OUTPUT_CONDITION);
    const int first = r->divided ? r->part->first : 0,
              n = r->divided ? r->part->end - first : r->spec.nrank;
    struct seen s = {.condition = condition ? worst(condition + first, n) : 0};
    if (!of) s.residual = x ? worst(x + first, n) : 0;
    for (int i = first; of && i < first + n && !isnan(s.residual); i++) {
        const bool none = isnan(x[i]) || isnan(of[i]);
        /* A rank's residual is relative to its own scale; times that scale it is absolute and can
         * be compared. */
        s.residual = none ? NAN : fmax(s.residual, x[i] * of[i]);
        s.scale = none ? NAN : fmax(s.scale, of[i]);
    }
    return s;
}

static double residual_of(const struct seen *s)
{
    return s->scale > 0 ? s->residual / s->scale : s->residual;
}

double trust_residual(const struct program_run *r)
{
    const struct seen s = seen_by(r);
    return residual_of(&s);
}

double trust_condition(const struct program_run *r) { return seen_by(r).condition; }

/* Of the ranks of all processes. False: one does not answer. */
static bool seen_by_all(const struct program_run *r, struct seen *s)
{
    double nothing = 0;
    *s = seen_by(r);
    return !r->divided || (divided_worst(r->part, &s->residual, &s->scale) &&
                           divided_worst(r->part, &s->condition, &nothing));
}

/* What to do about it: the direct form refines its solution, the paper's form can be replaced by
 * it. What the run has tried by itself is not named again. */
static const char *remedy(const struct kernel_job *job)
{
    const struct kernel_spec *k = &job->spec->kernel;
    const bool tree = kernel_branches(job->model, &job->omit);
    const bool refines = k->refinement == REFINEMENT_AS_GIVEN && (tree || k->solver != SOLVER_PCR);
    const bool unstable =
        k->solver == SOLVER_PCR || k->solver == SOLVER_PCR_SYMMETRIC || k->solver == SOLVER_CR_PCR;
    if (k->formulation == FORMULATION_PAPER) return "kernel.formulation: direct";
    if (refines && k->inner_refinements == 0 && !(tree && kernel_spec_implicit(k)))
        return "kernel.inner_refinements: 1";
    if (refines && k->outer_refinements == 0) return "kernel.outer_refinements: 1";
    if (unstable && !tree) return "kernel.solver: cr";
    if (k->residual == RESIDUAL_TWICE)
        return "more kernel.inner_refinements, or a higher kernel.precision";
    return refines && !tree ? "kernel.residual: twice, or a higher kernel.precision"
                            : "a higher kernel.precision";
}

/* How much the residual of a formulation overstates its error: the paper's is that of accelerations
 * which the joints take up again. */
static double overstated(const struct kernel_spec *k)
{
    return k->formulation == FORMULATION_PAPER ? 30 : 1;
}

/* The largest residual that an answer of `n` bodies may have without refinement: what a correct
 * program may be wrong by. */
static double may_be(const struct kernel_spec *k, int n)
{
    return fmin(overstated(k) * references_tolerance(k, n), 1e-3);
}

/* The next thing to try, where the program has inner refinements and residuals in twice the digits;
 * false: nothing is left. */
static bool refine_more(struct kernel_spec *k, bool inner, bool twice)
{
    enum { MOST_OUTER = 4, FEW_INNER = 4, MOST_INNER = 20 };
    if (inner && k->inner_refinements == 0) {
        k->inner_refinements = 1;
    } else if (k->outer_refinements == 0 && k->residual != RESIDUAL_TWICE) {
        k->outer_refinements = 1;
    } else if (twice && k->residual != RESIDUAL_TWICE) {
        k->residual = RESIDUAL_TWICE;
        k->inner_refinements = k->inner_refinements > FEW_INNER ? k->inner_refinements : FEW_INNER;
    } else if (twice && k->inner_refinements < MOST_INNER) {
        k->inner_refinements = MOST_INNER;
    } else if (!twice && k->outer_refinements < MOST_OUTER) {
        k->outer_refinements = MOST_OUTER;
    } else {
        return false;
    }
    return true;
}

bool trust_refine(struct run_spec *spec, const struct model *m, const struct job_omit *omit,
                  const struct run_result *out)
{
    struct kernel_spec *k = &spec->kernel;
    const bool enough = out->residual <= may_be(k, m->nbody); /* false for what is no number */
    const bool chain = !kernel_branches(m, omit), keeps_factors = k->solver != SOLVER_PCR || !chain;
    if (k->refinement != REFINEMENT_AS_NEEDED || enough || !keeps_factors) return false;
    return refine_more(k, chain || !kernel_spec_implicit(k),
                       chain && k->formulation == FORMULATION_DIRECT);
}

void trust_check(const struct program_run *r, struct run_result *out)
{
    out->residual = NAN;
    /* Only forward dynamics solves a system and has a residual. */
    if (!program_output(r, OUTPUT_QDD) || !program_output(r, OUTPUT_RESIDUAL)) return;
    const struct kernel_spec *k = &r->spec.kernel;
    bool single = k->precision == PRECISION_FLOAT;
    /* poor: about four digits left, one in single precision. resolved: from 0.1/eps on, the last
     * pivots have hardly a correct digit. */
    double poor = overstated(k) * (single ? 0.1 : 1e-4),
           epsilon = k->precision == PRECISION_QUAD ? 0x1p-112 : 0x1p-52;
    double resolved = 0.1 / (single ? 0x1p-23 : epsilon);
    /* what the factors lack, the residual would show */
    if (k->residual == RESIDUAL_TWICE) resolved = INFINITY;
    struct seen seen;
    if (!seen_by_all(r, &seen)) {
        divided_silent(out);
        return;
    }
    out->residual = residual_of(&seen);
    out->condition = seen.condition;
    /* a NaN is not to be trusted */
    if (out->residual <= poor && out->condition <= resolved) return;
    out->status = RUN_INVALID;
    char residual[32] = "no number"; /* whose sign would differ from host to host */
    if (!isnan(out->residual)) snprintf(residual, sizeof residual, "%.2g", out->residual);
    snprintf(out->text, sizeof out->text,
             "the answer is not to be trusted: the constraints' residual is %s, the condition at "
             "least %.2g; try %s",
             residual, out->condition, remedy(&dynamics_run_of(r)->job));
}
