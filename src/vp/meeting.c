/* meeting.c - see meeting.h.
 *
 * As the hardware barrier, with data: the last rank to come does the network's work on the vectors
 * of all, which lie in the memory of one process, and lets everybody go at one time. No events,
 * O(P) for each collective. */
#include "vp/meeting.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/digest.h"
#include "base/memory.h"
#include "comm/collectives.h"
#include "spec/collective_spec.h"
#include "vp/explain.h"
#include "vp/path.h"

struct meeting {
    struct comm_hardware hardware;
    int links;
    struct comm_meeting first; /* of the rank that came first, whose number is .. */
    int rank, inside;
    void **data; /* (nrank) */
    sim_ps latest, release;
    uint32_t path, done; /* of latest, of release */
};

/* The number of levels of a tree with so many leaves. */
static int levels(int leaves, int radix)
{
    int n = 0;
    for (int64_t reach = 1; reach < leaves; reach *= radix) n++;
    return n;
}

/* Nodes in use: ranks of one node come through one port. Ranks of a node stand together or not, so
 * each node is counted at the first of its ranks. */
static int nodes_in_use(const struct placement *p, int nnode)
{
    bool *seen = memory_zeroed((size_t)nnode, sizeof *seen);
    int n = 0;
    for (int i = 0; i < p->nrank; i++) {
        n += !seen[p->node[i]];
        seen[p->node[i]] = true;
    }
    free(seen);
    return n;
}

int meeting_links(const struct machine_spec *m, const struct topology *t, const struct placement *p)
{
    const int radix = m->network.collective.radix;
    int farthest = 0;
    /* A radix of one is a chain, whose depth is the number of nodes. */
    if (radix > 0) {
        const int nodes = nodes_in_use(p, t->nnode);
        return 2 * (radix > 1 ? levels(nodes, radix) : nodes - 1);
    }
    if (topology_has(m->topology.family, TOPOLOGY_NO_LINKS)) return 0;
    for (int i = 1; i < p->nrank; i++) {
        const int links = topology_distance(t, p->node[0], p->node[i]);
        if (links > farthest) farthest = links;
    }
    /* The root of a tree over switches is the top one, half-way to the farthest rank. */
    return topology_has(m->topology.family, TOPOLOGY_ABOVE) ? farthest : 2 * farthest;
}

sim_ps meeting_time(const struct network_spec *n, int links, int64_t bytes)
{
    const struct network_collective_spec *c = &n->collective;
    const double rate = c->bandwidth > 0 ? c->bandwidth : n->link_bandwidth;
    /* An unlimited link takes no time for any number of bytes. */
    const sim_ps vector = rate > 0 ? ps_rounded((double)bytes * (SIM_PS_PER_S / rate)) : 0;
    /* A tree over millions of slow links may be longer than simulated time. */
    const sim_ps tree = ps_times(links, sim_from_seconds(c->hop_latency));
    return ps_later(ps_later(sim_from_seconds(c->latency), tree), vector);
}

void meeting_create(struct world *w)
{
    const struct comm_hardware h = collective_hardware(w->machine);
    if (h.kinds == 0 && !h.eureka) return;
    struct meeting *m = TAKE(w->scratch, 1, struct meeting);
    m->hardware = h;
    w->meeting = m;
    /* Barriers have a time of their own, and no data. */
    if (w->machine->network.collective.kinds[0] == '\0') return;
    /* One pointer a rank: the vectors themselves are where the ranks have them. */
    m->data = TAKE(w->scratch, w->nrank, void *);
    m->links = meeting_links(w->machine, w->topology, &w->placement);
    /* A signal is a collective without data. */
    if (h.eureka) w->search = search_create(w, meeting_time(&w->machine->network, m->links, 0));
}

const struct comm_hardware *meeting_hardware(const struct world *w)
{
    return w->meeting ? &w->meeting->hardware : NULL;
}

/* The first one says what it is; whoever comes with anything else has made a mistake. */
static void compare(struct vp *v, const struct comm_meeting *m)
{
    struct meeting *g = v->world->meeting;
    if (g->inside == 0) {
        g->first = *m;
        g->rank = v->comm.rank;
        g->latest = 0;
    }
    if (m->kind != g->first.kind || m->root != g->first.root || m->bytes != g->first.bytes)
        vp_misuse(
            v,
            "%s of %lld B, root %d, by the network, in which rank %d calls %s of %lld B, root "
            "%d",
            collective_name((enum collective_kind)m->kind), (long long)m->bytes, m->root, g->rank,
            collective_name((enum collective_kind)g->first.kind), (long long)g->first.bytes,
            g->first.root);
}

/* All are there. The path goes on from the last rank's entry, as that of a barrier. */
static void complete(struct vp *v)
{
    struct world *w = v->world;
    struct meeting *g = w->meeting;
    const sim_ps time = meeting_time(&w->machine->network, g->links, g->first.bytes);
    /* On the fiber of the last rank, whose call is still in progress, as those of all others
     * are. */
    g->first.act(g->data, w->nrank, g->first.context);
    g->release = ps_later(g->latest, time);
    g->inside = 0;
    if (w->path) {
        const uint32_t last = path_at(w->path, g->path, g->latest);
        const uint32_t all =
            path_add(w->path, last, g->release, PATH_COLLECTIVE, -1, v->stage, -1, g->first.bytes);
        g->done = path_join(w->path, all, last, time, PATH_COLLECTIVE, -1, -1);
    }
    for (int i = 0; i < w->nrank; i++)
        if (&w->vp[i] != v) vp_wake(w, &w->vp[i]);
}

/* One rank of one alone has met everybody. */
void vp_meet(struct comm *c, const struct comm_meeting *m)
{
    struct vp *v = (struct vp *)c;
    struct world *w = v->world;
    struct meeting *g = w->meeting;
    const sim_ps begin = v->clock;
    CHECK(g && g->data && !w->team); /* world_alone */
    /* Nobody to wait for, and nothing to combine: data stay as they are. */
    if (w->nrank == 1) return;
    compare(v, m);
    /* From here on nobody touches it but the network, until all leave. */
    g->data[c->rank] = m->data;
    if (w->path && path_keeps_losers(w->path)) v->path = vp_path_until(v, v->clock);
    if (g->inside == 0 || v->clock > g->latest) {
        g->latest = v->clock;
        g->path = v->path;
    }
    /* The last one does the work of all, and then goes on as if it had waited, too. */
    if (++g->inside < w->nrank) vp_block(v, WAITING_MEETING, NULL);
    else complete(v);
    /* The next one is complete when all have left this one: until then `release` and `done` hold.
     */
    if (w->path)
        path_lose(w->path, v->path, g->done,
                  meeting_time(&w->machine->network, g->links, m->bytes));
    vp_path_join(v, g->done);
    vp_wait_until(v, g->release, g->release);
    /* No event and no message tells of it: so the digest does. */
    v->digest = digest_mix(v->digest, (uint64_t)g->release);
    if (w->record->spans) vp_span(v, SPAN_BARRIER, begin, v->clock, -1, m->bytes, -1);
}

int meeting_describe(const struct vp *v, char *s, int size)
{
    const struct meeting *g = v->world->meeting;
    /* How many have come tells whether one is late or most never will. */
    return snprintf(
        s, (size_t)size,
        "rank %d in %s waits in a collective of the network, %s of %lld B (%s:%d), that "
        "%d of %d ranks have entered",
        v->comm.rank, v->world->result->stage_name[v->stage],
        collective_name((enum collective_kind)g->first.kind), (long long)g->first.bytes,
        vp_base_name(v->comm.file), v->comm.line, g->inside, v->world->nrank);
}
