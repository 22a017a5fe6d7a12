/* work_count.h - what the serial algorithms execute, by formula from the bodies' joint types. w may be NULL. */
#ifndef DYNAMICS_WORK_COUNT_H
#define DYNAMICS_WORK_COUNT_H

#include "dynamics/dynamics.h"

/* Each adds to *w what one call for d does. */
void work_count_rnea(const struct dynamics *d, struct work *w);
void work_count_aba(const struct dynamics *d, struct work *w);
void work_count_crba(const struct dynamics *d, struct work *w);

/* work_count_place, work_count_velocities: dynamics_place, dynamics_velocities. */
void work_count_place(const struct dynamics *d, struct work *w);
void work_count_velocities(const struct dynamics *d, struct work *w);

#endif
