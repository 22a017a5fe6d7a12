/* level_choice.h - level 'auto-tolerance': the network level that measured errors allow, instead of
 * a guess.
 *
 * Errors are those of the network ladder (accuracy.h), measured once for a family: runs that are
 * alike but for their size, level and seeds. Levels are ordered by what they cost by construction,
 * not by a clock, so the choice is the same on every host. */
#ifndef STUDY_LEVEL_CHOICE_H
#define STUDY_LEVEL_CHOICE_H

#include "base/arena.h"
#include "spec/identity.h"
#include "spec/run_spec.h"

/* level_family: SHA-256, in hexadecimal, of the settings of `spec` without its numbers of ranks and
 * bodies, level, tolerance, seeds, recording and scenario. */
void level_family(const struct run_spec *spec, char hex[65]);

/* level_family_by: the same by what identified many such runs, which takes half the time. */
void level_family_by(struct identity *by, const struct run_spec *spec, char hex[65]);

/* What a ladder knows of one level. */
struct level_error {
    char level[16];  /* its name */
    double error;    /* of the makespan, relative: the largest of all points measured */
    char at[48];     /* the point of that error */
};

/* level_cheapest: the first of loggp, link, auto, packet, flit with error[i].error <= tolerance;
 * returns its index in `error` (n), -1: none. */
int level_cheapest(const struct level_error *error, int n, double tolerance);

/* level_take: `spec`, which asks for auto-tolerance and is a copy that nobody has run yet, becomes
 * the run at this level, with the identity of any such run; its text lives in `a`. *choice keeps
 * what was asked for. */
void level_take(struct run_spec *spec, const struct level_error *taken, struct level_choice *choice,
                struct arena *a);

#endif
