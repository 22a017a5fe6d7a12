/* offload.h - which part of a message's way the processors make themselves, and which a network
 * engine beside them (software.offload).
 *
 *   handshakes  large messages shake hands whatever the ranks do; copies take the processor's time
 *   none        a rank answers only inside a call of message software: hand-shakes wait for the end
 *               of its computing
 *   copies      an engine at each processor also makes the copies of message software, one after
 *               the other on the way out, each at once on the way in
 */
#ifndef VP_OFFLOAD_H
#define VP_OFFLOAD_H

#include "vp/vp.h"

/* offload_check: false with ERR_CONFIG where the engine would make copies that are the kernel's. */
bool offload_check(const struct machine_spec *m, struct err *e);

/* offload_called: v has called message software; what it computes from here on is another piece.
 * offload_computed: v has computed since `begin` until now. Both only matter with
 * OFFLOAD_NONE. */
static inline void offload_called(struct vp *v) { v->called = true; }
void offload_computed(struct vp *v, sim_ps begin);

/* offload_answer: when v can react to what comes to it at `time`, which is not before the event
 * being dispatched: at once, or with OFFLOAD_NONE when the computing that it is at then has
 * ended. */
sim_ps offload_answer(const struct vp *v, sim_ps time);

/* offload_send: with OFFLOAD_COPIES the engine of v copies m, whose overhead v has just paid: sets
 * its ready time, and the node of that in the path log. */
void offload_send(struct vp *v, struct message *m);

/* offload_receive: with OFFLOAD_COPIES the engine at the receiver copies m: it arrives as much
 * later. For messages with data, once each. */
void offload_receive(struct message *m);

#endif
