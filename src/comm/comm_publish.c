/* comm_publish.c - outputs of ranks that share one memory: a copy each (comm.h).
 *
 * The copy is not charged: publishing is the simulator's way to look at an answer, no part of the
 * program. */
#include <string.h>

#include "base/check.h"
#include "comm/comm.h"

/* What nobody wants is not copied. Ranks of one process share the output's memory; each writes its
 * own elements, so that their order does not matter. */
void comm_publish_here(struct comm *c, int output, int64_t first, int64_t n, const double *data)
{
    if (!comm_wanted(c, output)) return;
    const struct comm_output *o = &c->output[output];
    /* the program names elements that its output does not have */
    CHECK(first >= 0 && n >= 0 && first <= o->n - n);
    if (n > 0) memcpy(o->x + first, data, (size_t)n * sizeof *data);
}
