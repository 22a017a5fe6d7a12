/* world_parts.h - what a run of one job and a run of several (jobs.h) are made of: the pieces of
 * world.c that both use. */
#ifndef VP_WORLD_PARTS_H
#define VP_WORLD_PARTS_H

#include "vp/vp.h"

enum { WORLD_STACK_BYTES = 64 * 1024 }; /* of a rank, where its program says nothing */

/* world_all_eager: whether no message of a program shakes hands. Then those of a node come in
 * order, and the network may use fewer events. */
bool world_all_eager(const struct machine_spec *m, const struct world_load *load);

/* world_arrived: the end of a message's trip on one host thread. */
void world_arrived(struct message *m);

/* world_deliver: the same for the network; `context` is the world whose messages it carries. */
void world_deliver(void *context, struct net_message *m);

/* world_make_network: w->net over w->topology; `links`: count what passes each link. False with the
 * error of net_create. */
bool world_make_network(struct world *w, bool links, struct err *e);

/* world_make_tables: w->extra where the machine asks for it, and the arrays of w->result for its
 * ranks, from w->arena. */
void world_make_tables(struct world *w);

/* world_name_stages: the stages of a result, and "end" behind them. */
void world_name_stages(struct run_result *r, int nstage, const char *const *name);

/* world_begin_heartbeat: the run begins at `now`, wall time [s]. */
void world_begin_heartbeat(const struct world *w, double now);

/* world_tell_heartbeat: how far w's run is. */
void world_tell_heartbeat(const struct world *w);

/* world_loop: let all ready ranks go on, take an event, and so on until there is none. */
void world_loop(struct world *w);

/* world_collect: times, counts and digest of ranks that have all ended, into w->result. */
void world_collect(struct world *w);

/* world_copy_links: what passed each link because of this job, into w->result. */
void world_copy_links(struct world *w);

/* world_stack_text: the sentence for rank `rank` of w, whose stack was too small. */
void world_stack_text(const struct world *w, int rank, char *text, size_t size);

#endif
