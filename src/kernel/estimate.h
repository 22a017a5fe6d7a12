/* estimate.h - messages, bytes, flops and memory of the dynamics kernels by formula
 * (physics 3.1, 4.5, 5). */
#ifndef KERNEL_ESTIMATE_H
#define KERNEL_ESTIMATE_H

#include "kernel/kernel.h"
#include "linalg/space.h"
#include "model/model.h"

/* estimate_inverse, estimate_forward, estimate_dynamics: of one evaluation (times the time steps)
 * by the kernel of that name, less what `omit` leaves out. Messages and bytes are exact for open
 * chains of equal joints (the bytes of cyclic reduction are a bound), flops within a tenth; trees:
 * see estimate_tree. */
void estimate_inverse(const struct run_spec *spec, const struct model *model,
                      const struct job_omit *omit, struct program_estimate *out);
/* estimate_forward: see above. */
void estimate_forward(const struct run_spec *spec, const struct model *model,
                      const struct job_omit *omit, struct program_estimate *out);
/* estimate_dynamics: see above. */
void estimate_dynamics(const struct run_spec *spec, const struct model *model,
                       const struct job_omit *omit, struct program_estimate *out);

/* kernel_fits_trees: whether the programs for trees have what is asked for: not dense operators,
 * nor residuals in twice the digits, nor inner refinements of linearly implicit steps. */
static inline bool kernel_fits_trees(const struct kernel_spec *k)
{
    const bool inner = kernel_spec_implicit(k) && k->inner_refinements > 0;
    return k->operators != OPERATORS_DENSE && k->residual != RESIDUAL_TWICE && !inner;
}

/* kernel_branches: the programs for trees run it: the model is not a plain open chain, or the run
 * keeps branch and loop phases all the same. */
static inline bool kernel_branches(const struct model *m, const struct job_omit *omit)
{
    return !m->is_chain || m->nloop > 0 || omit->branches;
}

/* estimate_tree: of one inverse or forward dynamics (or both added up) on a tree, from its plan:
 * messages, bytes and flops as they are counted, but for the least norm solution of loops;
 * refinements count as often as asked for, although they may stop early. */
void estimate_tree(const struct run_spec *spec, const struct model *model,
                   const struct job_omit *omit, bool inverse, bool forward,
                   struct program_estimate *out);

#endif
