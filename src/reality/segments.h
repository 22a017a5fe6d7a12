/* segments.h - measured messages as the segments of message software that the simulator has. */
#ifndef REALITY_SEGMENTS_H
#define REALITY_SEGMENTS_H

#include "reality/messages.h"
#include "spec/software_spec.h"

/* One segment with how well it fits: largest relative residual of the points that it was made of.
 */
struct fitted_segment {
    struct software_segment segment; /* every number given */
    double one_way, send, recv;      /* residuals */
    int points;
};

/* segments_of: out of at least one measured size, into out (SOFTWARE_MAX_SEGMENTS); returns how
 * many. Of each: o_s and o_r with their slopes; latency and G out of what a message takes beside
 * them; g where trains are slower than either. A time that would come out below nothing is nothing,
 * and the receiver's is then less, so that the sum stays that of the round trip. */
int segments_of(const struct messages *m, struct fitted_segment *out);

#endif
