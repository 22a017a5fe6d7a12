/* schedule_program.h - schedules as programs of runs: `program: x.goal`. */
#ifndef SCHEDULE_SCHEDULE_PROGRAM_H
#define SCHEDULE_SCHEDULE_PROGRAM_H

#include "program/program.h"
#include "spec/program_spec.h"

/* schedule_sheet: what the schedule in file `path` declares, in `a`; the whole file is read and
 * checked. Returns NULL as schedule_read. */
const struct program_sheet *schedule_sheet(const char *path, struct arena *a, struct err *e);

/* schedule_program: schedules, as any program. */
extern const struct program_type schedule_program;

#endif
