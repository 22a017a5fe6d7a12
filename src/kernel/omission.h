/* omission.h - what the programs of multibody dynamics leave out because a scene does not need it
 * (physics of rest, planes and missing loads), and how to compute it all the same.
 *
 * An omission is exact when every number of the answer (tau, q'', q and q' at the end, loop forces)
 * is the same with it and without. A bounded one changes the answer by less than its bound,
 * relative to the answer's largest number.
 * --keep-all puts all of them back (KEEP_* of spec/run_spec.h). */
#ifndef KERNEL_OMISSION_H
#define KERNEL_OMISSION_H

#include "kernel/kernel.h"
#include "model/model.h"
#include "program/program.h"
#include "spec/run_spec.h"

/* Cubic work: above so many degrees of freedom nobody tries the mass matrix. */
enum { OMISSION_CRBA_MOST = 512 };

/* omission_scene: the scene that the kernels and the serial codes get: bodies on fixed joints
 * become part of others where that leaves enough for all `nrank` ranks; what `keep` (KEEP_* of the
 * order, here and below) puts back is added. Changes *m and *s, replacing them by new ones in `a`
 * when bodies merge. Returns how many did. */
int omission_scene(int nrank, unsigned keep, struct model **m, struct state **s, struct arena *a);

/* omission_still: whether no joint of the bodies of m that are here moves. */
bool omission_still(const struct model *m, const struct state *s);

/* omission_movable: bodies of m on joints that move. omission_mergeable: how many bodies
 * omission_scene will merge of `nbody`, `movable` of which are on joints that move. */
int omission_movable(const struct model *m);
int omission_mergeable(int nrank, unsigned keep, int nbody, int movable);

/* omission_kernel: the kernel that spec->kernel names, in the algebra that it asks for; auto: in
 * three components where the scene is planar and the operators are not dense. m, s NULL: kernels
 * without a model. NULL with *e set when there is no such kernel, or the scene is not planar as
 * asked. */
const struct kernel_type *omission_kernel(const struct run_spec *spec, unsigned keep,
                                          const struct model *m, const struct state *s,
                                          struct err *e);

/* omission_job: what a kernel leaves out in a scene. m, s NULL: kernels without a model. */
struct job_omit omission_job(const struct run_spec *spec, unsigned keep, const struct model *m,
                             const struct state *s);

/* omission_counted: whether the serial constraint force algorithm is counted and not executed:
 * generated chains of revolute joints, too long for the mass matrix. Each body of such a chain
 * costs the same. */
bool omission_counted(const struct kernel_job *job);

/* omission_list: what a program leaves out by its job's spec, model, state and omit. */
void omission_list(const struct kernel_job *job, const struct kernel_type *kernel,
                   struct left_out *l);

/* omission_unused: settings that act nowhere because of what a model's file says, "key: reason"
 * (constant texts), into out (2); what the settings alone decide is in the fields' tables. Returns
 * how many. */
int omission_unused(const struct kernel_job *job, const struct kernel_type *kernel,
                    const char **out);

#endif
