/* extra.h - what only some machines ask of a rank: noise, a kernel server, an engine beside the
 * processor. Apart from struct vp, of which there are as many as memory holds. */
#ifndef VP_EXTRA_H
#define VP_EXTRA_H

#include <stdint.h>

#include "base/random.h"
#include "sim/sim.h"

struct pieces; /* offload.c */

struct vp_extra {
    struct random noise;
    sim_ps server_start;   /* when the kernel server began with it */
    sim_ps engine_free;    /* when its engine has made the copies so far */
    struct pieces *pieces; /* of computing, NULL: none are kept */
    uint32_t engine_path;  /* node of engine_free */
};

#endif
