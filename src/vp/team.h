/* team.h - one run on several host threads, where the order in which ranks go acts on nothing.
 *
 * Where every message is eager, each node has one processor and no receive depends on time, all
 * that is known of a message is known when it is sent, from its sender alone, and what a receive
 * takes follows from the order of sending: the ranks are a Kahn process network (Kahn 1974), whose
 * result is the same in whatever order they run. So they need neither windows nor a common clock.
 * Ranks are divided into shares of neighbours; a share is run by one thread at a time, and any
 * thread may take a share that has something to do. */
#ifndef VP_TEAM_H
#define VP_TEAM_H

#include "vp/vp.h"

/* --- ranks.c: what a share does as a whole run on one thread does --- */

/* world_make_ranks: w's own ranks at time 0, all ready. world_resume: let ready ranks go on until
 * none is left, the run has stopped, or `most` of them have. */
void world_make_ranks(struct world *w, uint64_t seed);
void world_resume(struct world *w, int64_t most);

/* --- team.c --- */

/* team_run: all ranks of `w`, whose tables and network are there and whose ranks are not, on
 * w->load->threads threads until none can go on. For loads that world_alone lets pass. */
void team_run(struct world *w, uint64_t seed);

/* team_part: the ranks *first .. *end - 1 of such a load that `process` of load->hosts runs;
 * without hosts, all. */
void team_part(const struct world_load *load, int process, int *first, int *end);

/* team_elsewhere: whether m, sent by a rank of share w, ends in another share. team_post: hand it
 * over. */
static inline bool team_elsewhere(const struct world *w, const struct message *m)
{
    return m->to < w->vp + w->first || m->to >= w->vp + w->first + w->nown;
}
void team_post(struct world *w, struct message *m);

#endif
