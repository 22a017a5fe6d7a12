/* flop_meter.h - counts the operations on quad numbers that a program really executes.
 *
 * In quad precision every addition, subtraction, multiplication and division is a call into the
 * compiler's library, and so are root, sine and cosine. A program linked with the --wrap options of
 * tests/local.am comes here instead. Archives made with REAL_COUNTED (linalg/real.h) are not
 * optimised, so that what is counted is what the source says: nothing is merged, hoisted or left
 * out. Making the constants of a model counts nothing, as it is done once for all evaluations. */
#ifndef TESTS_SUPPORT_FLOP_METER_H
#define TESTS_SUPPORT_FLOP_METER_H

#include "base/work.h"

/* flop_meter_start: count from zero. flop_meter_stop: what was executed since: flop, div, sqrt and
 * trig. */
void flop_meter_start(void);
struct work flop_meter_stop(void);

/* flop_meter_pause, flop_meter_resume: what is executed between them is not counted; they nest. */
void flop_meter_pause(void);
void flop_meter_resume(void);

#endif
