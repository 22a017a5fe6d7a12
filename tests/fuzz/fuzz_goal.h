/* fuzz_goal.h - a schedule that was accepted, executed by its ranks if it is small. */
#ifndef TESTS_FUZZ_FUZZ_GOAL_H
#define TESTS_FUZZ_FUZZ_GOAL_H

#include "fuzz.h"
#include "schedule/schedule.h"

/* goal_try: `s` (NULL: refused with *e) is whole: operations and dependencies lie in their ranks. A
 * small one runs to its end, or to a deadlock that is told. */
void goal_try(const struct schedule *s, struct arena *a, const struct err *e);

#endif
