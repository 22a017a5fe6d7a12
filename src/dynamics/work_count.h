/* work_count.h - what the serial algorithms execute, by formula from the bodies' joint types. w may be NULL. */
#ifndef DYNAMICS_WORK_COUNT_H
#define DYNAMICS_WORK_COUNT_H

#include "dynamics/dynamics.h"

/* Each adds to *w what one call for d does. */
#define work_count_rnea REAL_NAME(work_count_rnea)
void work_count_rnea(const struct dynamics *d, struct work *w);
#define work_count_aba REAL_NAME(work_count_aba)
void work_count_aba(const struct dynamics *d, struct work *w);
#define work_count_crba REAL_NAME(work_count_crba)
void work_count_crba(const struct dynamics *d, struct work *w);

/* work_count_place, work_count_velocities: dynamics_place, dynamics_velocities. */
#define work_count_place REAL_NAME(work_count_place)
void work_count_place(const struct dynamics *d, struct work *w);
#define work_count_velocities REAL_NAME(work_count_velocities)
void work_count_velocities(const struct dynamics *d, struct work *w);

#endif
