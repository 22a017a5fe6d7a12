/* system.h - a model and its state made ready for dynamics: what room model cannot do, since it
 * computes nothing. */
#ifndef DYNAMICS_SYSTEM_H
#define DYNAMICS_SYSTEM_H

#include "base/arena.h"
#include "model/model.h"
#include "spec/model_spec.h"

/* system_prepare: compute the constants of m's bodies in double once, for all who will need them;
 * into m->arena. */
void system_prepare(struct model *m);

/* state_make: state_given, with rates that closed chains can have: random ones of a ring are
 * projected on its loops (loop_project.c). NULL as state_given. */
struct state *state_make(const struct model *m, const struct model_spec *spec, struct arena *a);

#endif
