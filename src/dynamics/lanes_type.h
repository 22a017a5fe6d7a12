/* lanes_type.h - forward dynamics of several states of one tree at once, each in a lane of wide
 * registers.
 *
 * A lane has the bits of dynamics_forward in double precision, which has the same source (aba.c,
 * aba_revolute.c; linalg/lanes.h). Which widths a host has is found out where it runs. */
#ifndef DYNAMICS_LANES_TYPE_H
#define DYNAMICS_LANES_TYPE_H

#include <stdbool.h>

#include "base/arena.h"
#include "model/model.h"

struct lanes; /* a tree whose states are asked for; opaque */

struct lanes_type {
    int width; /* states at once */

    /* hold: the constants of m, a tree without loops, under the gravity, base and wrenches of s. */
    struct lanes *(*hold)(const struct model *m, const struct state *s, struct arena *a);

    /* forward: accelerations ud (nu x width) by articulated bodies at q (nq x width), u (nu x
     * width) under the forces tau (nu) and springs. False: they break down in one lane at least,
     * and none has an answer. */
    bool (*forward)(struct lanes *l, const double *q, const double *u, const double *tau,
                    double *ud);
};

/* lanes_type_of: the table of 4 or 8 lanes. NULL: this host's registers are not so wide. */
const struct lanes_type *lanes_type_of(int width);

/* lanes_type_widest: the widest of this host; NULL: none. */
const struct lanes_type *lanes_type_widest(void);

#endif
