/* work_count.h - what the serial algorithms execute, by formula from the bodies' joint types. w may
 * be NULL.
 *
 * The formulas are sums of what the operations declare beside themselves (*_FLOP, joint_cost);
 * tests hold every sum against the operations that the source executes, to the flop. The fast paths
 * of revolute.h count by themselves. */
#ifndef DYNAMICS_WORK_COUNT_H
#define DYNAMICS_WORK_COUNT_H

#include "dynamics/dynamics.h"

/* work_count_rnea, work_count_crba: one call of rnea_full, of crba's general code. */
void work_count_rnea(const struct dynamics *d, struct work *w);
void work_count_crba(const struct dynamics *d, struct work *w);

/* work_count_aba: the three sweeps of aba_full, without dynamics_place and dynamics_velocities; not
 * moving: of aba_response. */
void work_count_aba(const struct dynamics *d, bool moving, struct work *w);

/* work_count_place, work_count_velocities, work_count_springs, work_count_load: dynamics_place,
 * dynamics_velocities, springs_add, dynamics_load. */
void work_count_place(const struct dynamics *d, struct work *w);
void work_count_velocities(const struct dynamics *d, struct work *w);
void work_count_springs(const struct dynamics *d, struct work *w);
void work_count_load(const struct dynamics *d, struct work *w);

#endif
