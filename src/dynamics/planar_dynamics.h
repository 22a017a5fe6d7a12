/* planar_dynamics.h - serial dynamics of planar systems in three components, double in and out:
 * what the parallel programs in three components are compared with.
 *
 * Every operation that is executed is counted. */
#ifndef DYNAMICS_PLANAR_DYNAMICS_H
#define DYNAMICS_PLANAR_DYNAMICS_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/work.h"
#include "model/model.h"

/* planar_inverse: joint forces tau (nu) for s->qdd by recursive Newton-Euler, loops cut open,
 * springs not considered; the scene is planar (planar.h). Adds what it did to *w. */
void planar_inverse(const struct model *m, const struct state *s, struct arena *scratch,
                    double *tau, struct work *w);

/* planar_forward: accelerations qdd (nu) for s->tau and springs by articulated bodies, of closed
 * chains by columns of M^-1 J^T. False when an articulated inertia is singular along its joint.
 * Adds what it did to *w. */
bool planar_forward(const struct model *m, const struct state *s, struct arena *scratch,
                    double *qdd, struct work *w);

#endif
