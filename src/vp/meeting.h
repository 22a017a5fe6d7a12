/* meeting.h - collectives that the machine's network does by itself (comm_meet): who has come, what
 * they brought, and when all may go.
 *
 * From the entry of the last rank to the result on all ranks takes
 *
 *     latency + links of the tree, up and down, x hop_latency + bytes / bandwidth
 *
 * of the settings network.collective.*. The links: of a tree of its own 2 ceil(log_radix(nodes));
 * else of the network's own links from the first rank's router to the farthest rank's and back,
 * where switches stand above the nodes (fat tree, folded Clos) only there, as that way goes up and
 * down. Nothing waits for other messages: the networks that are known to have such trees give them
 * wires, channels or priorities of their own. */
#ifndef VP_MEETING_H
#define VP_MEETING_H

#include "vp/vp.h"

/* meeting_create: w->meeting of w's machine, once topology and placement are there; in the run's
 * memory. It stays NULL where the network does nothing. meeting_hardware: what the network does, as
 * programs see it; NULL: nothing. */
void meeting_create(struct world *w);
const struct comm_hardware *meeting_hardware(const struct world *w);

/* meeting_links: links of the tree, up and down, of nrank ranks placed by p. */
int meeting_links(const struct machine_spec *m, const struct topology *t,
                  const struct placement *p);

/* meeting_time: from the last entry to the result everywhere over so many links [ps]. */
sim_ps meeting_time(const struct network_spec *n, int links, int64_t bytes);

/* vp_meet: comm_meet of a virtual processor. vp_search (search.c): comm_search, on a network with
 * an eureka. */
void vp_meet(struct comm *c, const struct comm_meeting *m);
int vp_search(struct comm *c, int state);

/* search_create: the state of searches whose signal takes `signal` [ps], in memory of the run. */
struct search *search_create(struct world *w, sim_ps signal);

/* meeting_describe: what `v`, which waits in one, waits for; as describe in deadlock.c. */
int meeting_describe(const struct vp *v, char *s, int size);

#endif
