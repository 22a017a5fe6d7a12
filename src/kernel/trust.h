/* trust.h - whether an answer may be believed, by what the solver itself saw. */
#ifndef KERNEL_TRUST_H
#define KERNEL_TRUST_H

#include "kernel/kernel.h"
#include "measure/run_result.h"
#include "model/model.h"
#include "program/program.h"

/* trust_check: out->residual and condition = the worst over the ranks. A residual that is no number
 * or leaves fewer than about four digits (one in single precision; both less one and a half in the
 * paper's formulation), or a condition that reaches what the precision resolves (but with residuals
 * in twice the digits), makes the run RUN_INVALID; its text says which setting would mend it.
 * Kernels without forward dynamics: NaN, no verdict. */
void trust_check(const struct program_run *r, struct run_result *out);

/* trust_residual: the worst of all ranks in proportion to the largest term that any has: a rank
 * whose terms are nothing but rounding beside those of others has no say. NaN when a rank's is no
 * number. */
double trust_residual(const struct program_run *r);

/* trust_condition: the largest of all ranks, 0 when the run has none. NaN when a rank's is no
 * number. */
double trust_condition(const struct program_run *r);

/* trust_refine: more refinements for spec->kernel, which gave out->residual on `m`, of which it
 * left out `omit`, when that is too much: one inner, then one outer; then open chains in the direct
 * formulation get their residual in twice the digits with four inner ones and with twenty, others
 * up to four outer ones. Linearly implicit steps of trees have no inner ones. False: none is
 * needed, none is left, or the settings forbid it; *spec is then unchanged. */
bool trust_refine(struct run_spec *spec, const struct model *m, const struct job_omit *omit,
                  const struct run_result *out);

#endif
