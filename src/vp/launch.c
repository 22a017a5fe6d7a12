/* launch.c - a message sets out: into the network, or over the memory that two processors of one
 * node share. */
#include "vp/explain.h"
#include "vp/path.h"
#include "vp/vp.h"
#include "vp/windows.h"

/* Not inlined, so that the text takes no room on the stack of a rank that sends. A message that is
 * not sent does not matter any more: the run has ended. */
static __attribute__((noinline)) bool takes(const struct world *w, const struct message *m,
                                            const struct vp *from)
{
    char why[256];
    if (net_takes(w->net, m->net.bytes, why, sizeof why)) return true;
    vp_record_failure((struct vp *)from, NULL, 0, why);
    return false;
}

/* The network knows nodes; ranks are needed for the record of what binds alone. */
void vp_launch(struct world *w, struct message *m, const struct vp *from, const struct vp *to)
{
    m->net.src = from->node;
    /* the other rank's state may lie cold, or be another thread's */
    m->net.dst = w->placement.node[to - w->vp];
    m->net.processor = from->processor;
    if (!w->shared_channel || m->net.src != m->net.dst) {
        if (!takes(w, m, from)) return;
        if (w->windows) windows_post(w, m);
        else net_send(w->net, &m->net);
        return;
    }
    /* Memory that two processors share (docs/network.md): latency and bytes at its
     * bandwidth, without contention, so the arrival is known at once and takes no event. */
    m->net.injected = m->net.ready;
    m->net.arrival =
        m->net.ready + byte_cost(w->software.shared_latency, w->software.shared_byte, m->net.bytes);
    m->net.uncontended = m->net.arrival;
    if (w->path)
        m->net.path = path_add(w->path, m->net.path, m->net.arrival, PATH_MEMORY, from->comm.rank,
                               -1, -1, m->net.bytes);
    w->arrived(m);
}
