/* balance.h - how long each rank is to compute in each stage, whatever it counts: for the question
 * what an even share of the work would buy (study/why.h). */
#ifndef MEASURE_BALANCE_H
#define MEASURE_BALANCE_H

#include <stdint.h>

/* Both (nrank x nstage), rank by rank. Computing of `own` [ps] in all takes `target` [ps] in all,
 * each piece in proportion; where own is 0, target is spent when the rank enters the stage. */
struct balance {
    int nrank, nstage;
    const int64_t *own, *target;
};

#endif
