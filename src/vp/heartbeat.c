/* heartbeat.c - how far a run is, for whoever shows it (world_parts.h). */
#include "measure/run_heartbeat.h"
#include "vp/world_parts.h"

void world_tell_heartbeat(const struct world *w)
{
    struct run_heartbeat *p = w->load->heartbeat;
    if (!p) return;
    atomic_store_explicit(&p->events, sim_events(w->sim), memory_order_relaxed);
    atomic_store_explicit(&p->ended, w->nfinished, memory_order_relaxed);
    if (p->beat) p->beat(p->context);
}

/* Another thread reads these, and needs none of them in step with another: relaxed order
 * is enough. */
void world_begin_heartbeat(const struct world *w, double now)
{
    struct run_heartbeat *p = w->load->heartbeat;
    if (!p) return;
    atomic_store_explicit(&p->events, 0, memory_order_relaxed);
    atomic_store_explicit(&p->ended, 0, memory_order_relaxed);
    atomic_store_explicit(&p->nrank, w->nrank, memory_order_relaxed);
    atomic_store_explicit(&p->begin, now, memory_order_relaxed);
}
