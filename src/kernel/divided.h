/* divided.h - scenes of which each of several processes makes a part, and their serial answers in
 * as many parts.
 *
 * Of a chain of revolute joints a rank needs its own bodies and the constants of one on each side.
 * Newton-Euler goes along the chain twice, articulated bodies three times, so that a process
 * computes the references of its own bodies from what its neighbours hand over. Branches, loops,
 * time steps and planar scenes stay whole. */
#ifndef KERNEL_DIVIDED_H
#define KERNEL_DIVIDED_H

#include "kernel/scene.h"
#include "measure/run_result.h"
#include "program/run_part.h"

/* divided_fits: whether processes may have parts of the scene that `spec` asks for; the same on all
 * of them. */
bool divided_fits(const struct run_spec *spec, unsigned keep);

/* divided_all: whether all processes say `yes`; false also when one of them does not answer. */
bool divided_all(const struct run_part *p, bool yes);

/* divided_agree: what is known of all bodies only when every process has looked at its own: whether
 * some move, and whether all have an inertia to invert. `model` NULL: this process could not make
 * its part. False: one could not; then none has. */
bool divided_agree(const struct run_part *p, struct model *model, struct state *state);

/* divided_inverse: s->inverse for the bodies that are here, with the work of all. False: a process
 * does not answer. */
bool divided_inverse(const struct run_part *p, struct scene *s);

/* divided_forward: s->forward[FORWARD_ABA] likewise. */
bool divided_forward(const struct run_part *p, struct scene *s);

/* divided_silent: a process did not answer: the run has failed, and its job is broken. */
void divided_silent(struct run_result *out);

/* divided_worst: the largest of *difference and of *reference over all processes; a NaN is larger
 * than any number. False as above. */
bool divided_worst(const struct run_part *p, double *difference, double *reference);

#endif
