/* windows.h - one run on several host threads where messages meet in the network: by windows of
 * simulated time.
 *
 * Of a message that arrives now its receiver makes nothing that enters the network within the
 * lookahead: interfaces and software take their time. So the network may go on for that long before
 * it must know what ranks have sent, and ranks of one window do not act on each other. Time is cut
 * into windows of half of the lookahead (conservative windows; Chandy and Misra 1979, Nicol 1993).
 * While one thread takes the network's events through a window, all of them let those ranks go on
 * to which messages have come in the window before, in shares (team_parts.h).
 *
 * The order is that of one thread. The network has one thread, and takes what ranks have sent in
 * the order of the arrivals that made them send it. It takes it later than on one thread would, but
 * no event of the network comes between: a message begins with an event whose key no other has
 * (net_keys.h: its sender and number, or the port of a node). Who enters the machine's barrier is
 * counted; the window in which all may have come is made by one thread in the order of arrivals. */
#ifndef VP_WINDOWS_H
#define VP_WINDOWS_H

#include "vp/vp.h"

/* windows_alone: why a run cannot be made by windows, although things must happen in the order of
 * time; NULL: it can. A constant text. */
const char *windows_alone(const struct machine_spec *m, const struct world_load *load,
                          const struct record_spec *record);

/* windows_lookahead: how much later than the arrival's event whatever a message makes its receiver
 * send has its first event [ps]. For loads that windows_alone lets pass. */
sim_ps windows_lookahead(const struct machine_spec *m, const struct world_load *load);

/* windows_wire: the part of it that passes behind the time at which a message is ready [ps]. */
sim_ps windows_wire(const struct machine_spec *m, const struct world_load *load);

/* windows_run: all ranks of `w`, whose tables and network are there and whose ranks are not, on
 * w->load->threads threads until none can go on. */
void windows_run(struct world *w, uint64_t seed);

/* windows_post: m, sent by a rank of share w, goes to the network. windows_deliver: m comes from
 * the network of world w. windows_barrier: v enters the machine's barrier; it returns when v may
 * leave. */
void windows_post(struct world *w, struct message *m);
void windows_deliver(struct world *w, struct message *m);
void windows_barrier(struct vp *v);

#endif
