/* trust.c - residual and condition of a run; see trust.h. */
#include "run/trust.h"

#include <math.h>
#include <stdio.h>

#include "base/text.h"

static double worst(const double *x, int n)
{
    double largest = 0;
    for (int i = 0; x && i < n; i++)
        if (isnan(x[i])) return x[i];
        else if (x[i] > largest) largest = x[i];
    return largest;
}

/* Of all ranks: a rank whose terms are nothing but rounding beside those of others has no say. */
static double worst_residual(const struct kernel_job *job)
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
    return k->outer_refinements == 0 ? "kernel.outer_refinements: 1" : "a higher kernel.precision";
}

void trust_check(const struct kernel_job *job, struct run_result *out)
{
    out->residual = NAN;
    if (!job->qdd || !job->residual) return;
    const struct kernel_spec *k = &job->spec->kernel;
    bool single = k->precision == PRECISION_FLOAT;
    double poor = single ? 0.1 : 1e-4, epsilon = k->precision == PRECISION_QUAD ? 0x1p-112 : 0x1p-52;
    double resolved = 0.1 / (single ? 0x1p-23 : epsilon);
    out->residual = worst_residual(job);
    out->condition = worst(job->condition, job->nrank);
    if (out->residual <= poor && out->condition <= resolved) return; /* a NaN is not to be trusted */
    out->status = RUN_INVALID;
    snprintf(out->text, sizeof out->text,
             "the answer is not to be trusted: the constraints' residual is %.2g, the condition at least %.2g; try %s",
             out->residual, out->condition, remedy(k));
}
