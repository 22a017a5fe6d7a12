/* trust.h - whether an answer may be believed, by what the solver itself saw. */
#ifndef RUN_TRUST_H
#define RUN_TRUST_H

#include "kernel/kernel.h"
#include "measure/run_result.h"

/* trust_check: out->residual and condition = the worst over the ranks. A residual that is no number or leaves fewer
 * than about four digits (one in single precision), or a condition that reaches what the precision resolves, makes
 * the run RUN_INVALID; its text says which setting would mend it. Kernels without forward dynamics: NaN, no verdict. */
void trust_check(const struct kernel_job *job, struct run_result *out);

#endif
