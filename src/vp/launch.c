/* launch.c - a message sets out: into the network, or over the memory that two processors of one node share. */
#include "vp/vp.h"

void vp_launch(struct world *w, struct message *m, const struct vp *from, const struct vp *to)
{
    m->net.src = from->node;
    m->net.dst = to->node;
    m->net.processor = from->processor;
    if (!w->shared_channel || from->node != to->node) {
        net_send(w->net, &m->net);
        return;
    }
    m->net.injected = m->net.ready;
    m->net.arrival = m->net.ready + byte_cost(w->software.shared_latency, w->software.shared_byte, m->net.bytes);
    m->net.uncontended = m->net.arrival;
    w->arrived(m);
}
