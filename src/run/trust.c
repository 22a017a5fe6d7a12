/* trust.c - residual and condition of a run; see trust.h. */
#include "run/trust.h"

#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "kernel/estimate.h"
#include "run/references.h"

static double worst(const double *x, int n)
{
    double largest = 0;
    for (int i = 0; x && i < n; i++)
        if (isnan(x[i])) return x[i];
        else if (x[i] > largest) largest = x[i];
    return largest;
}

double trust_residual(const struct kernel_job *job)
{
    double residual = 0, scale = 0;
    if (!job->residual_scale) return worst(job->residual, job->nrank);
    for (int i = 0; i < job->nrank; i++) {
        if (isnan(job->residual[i])) return job->residual[i];
        residual = fmax(residual, job->residual[i] * job->residual_scale[i]);
        scale = fmax(scale, job->residual_scale[i]);
    }
    return scale > 0 ? residual / scale : residual;
}

/* What to do about it: the direct form refines its solution, the paper's form can be replaced by it. */
static const char *remedy(const struct kernel_spec *k)
{
    if (k->formulation == FORMULATION_PAPER) return "kernel.formulation: direct";
    if (k->inner_refinements == 0) return "kernel.inner_refinements: 1";
    if (k->outer_refinements == 0) return "kernel.outer_refinements: 1";
    const bool unstable = k->solver == SOLVER_PCR || k->solver == SOLVER_PCR_SYMMETRIC || k->solver == SOLVER_CR_PCR;
    if (unstable) return "kernel.solver: cr";
    if (k->residual == RESIDUAL_TWICE) return "more kernel.inner_refinements, or a higher kernel.precision";
    return "kernel.residual: twice (open chains), or a higher kernel.precision";
}

/* How much the residual of a formulation overstates its error: the paper's is that of accelerations which the joints
 * take up again. */
static double overstated(const struct kernel_spec *k) { return k->formulation == FORMULATION_PAPER ? 30 : 1; }

double trust_needs(const struct kernel_spec *k, int n)
{
    return fmin(overstated(k) * references_tolerance(k, n), 1e-3);
}

/* The next thing to try; false: nothing is left. */
static bool refine_more(struct kernel_spec *k, bool twice)
{
    enum { MOST_OUTER = 4, FEW_INNER = 4, MOST_INNER = 20 };
    if (k->inner_refinements == 0) {
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

bool trust_refine(struct run_spec *spec, const struct model *m, const struct run_result *out)
{
    struct kernel_spec *k = &spec->kernel;
    const bool enough = out->residual <= trust_needs(k, m->nbody); /* false for what is no number */
    const bool keeps_factors = k->solver != SOLVER_PCR || kernel_branches(spec, m);
    if (k->refinement != REFINEMENT_AS_NEEDED || enough || !keeps_factors) return false;
    return refine_more(k, !kernel_branches(spec, m) && k->formulation == FORMULATION_DIRECT);
}

void trust_check(const struct kernel_job *job, struct run_result *out)
{
    out->residual = NAN;
    if (!job->qdd || !job->residual) return;
    const struct kernel_spec *k = &job->spec->kernel;
    bool single = k->precision == PRECISION_FLOAT;
    double poor = overstated(k) * (single ? 0.1 : 1e-4), epsilon = k->precision == PRECISION_QUAD ? 0x1p-112 : 0x1p-52;
    double resolved = 0.1 / (single ? 0x1p-23 : epsilon);
    if (k->residual == RESIDUAL_TWICE) resolved = INFINITY; /* what the factors lack, the residual would show */
    out->residual = trust_residual(job);
    out->condition = worst(job->condition, job->nrank);
    if (out->residual <= poor && out->condition <= resolved) return; /* a NaN is not to be trusted */
    out->status = RUN_INVALID;
    snprintf(out->text, sizeof out->text,
             "the answer is not to be trusted: the constraints' residual is %.2g, the condition at least %.2g; try %s",
             out->residual, out->condition, remedy(k));
}
