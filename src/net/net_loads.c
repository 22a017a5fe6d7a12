/* net_loads.c - what passed each port and link of a network, as a list (net.h).
 *
 * The levels count by number of resource (net_account) and leave untouched what nothing passes. Who
 * a resource is, is only found out here: of 10^8 links, which a machine file of a few bytes may
 * have, a run on 16 ranks uses a few hundred, and a list of all of them would take 10 GB. So would
 * looking at each, where the system gives memory to what is only read, as some guests of
 * hypervisors do: parts that nothing has passed are not read. */
#include "base/check.h"
#include "net/net.h"
#include "net/net_account.h"
#include "net/net_internal.h"

/* Whether anything came by; queueing and busy times only grow with messages or their packets. */
static bool used(const struct link_load *l)
{
    return l->messages != 0 || l->bytes != 0 || l->busy_ps != 0 || l->queue_ps != 0;
}

/* A node's port, or a link from router to router. */
static void name_load(const struct net *n, int resource, struct link_load *l)
{
    int port;
    l->from = l->to = l->node = -1;
    if (net_is_injection(n, resource)) {
        l->node = resource;
        l->to = topology_router_of(n->topology, resource);
    } else if (net_is_ejection(n, resource)) {
        l->node = resource - n->nnode - n->nlink;
        l->from = topology_router_of(n->topology, l->node);
    } else {
        topology_link_ends(n->topology, resource - n->nnode, &l->from, &l->to, &port);
    }
}

void net_loads_make(struct net *n)
{
    const size_t size = size_product((size_t)n->njob, (size_t)n->nresource);
    n->load = TAKE(n->arena, size, struct link_load);
    if (n->nresource > NET_LINKS_WHOLE)
        n->load_used = TAKE(n->arena, size / NET_LOADS + 1, _Atomic bool);
}

/* The next of the resources from `i` that anything came by, nresource: none. `first`: where those
 * of the job begin. */
static int next_used(const struct net *n, size_t first, int i)
{
    while (i < n->nresource) {
        const size_t at = first + (size_t)i;
        if (n->load_used[at / NET_LOADS]) {
            if (used(&n->load[at])) return i;
            i++;
        } else {
            const size_t left = NET_LOADS - at % NET_LOADS;
            i = (size_t)(n->nresource - i) > left ? i + (int)left : n->nresource;
        }
    }
    return i;
}

void net_count_jobs(struct net *n, int njob)
{
    CHECK(n->in_flight == 0 && n->njob == 1);
    if (!n->load || njob == 1) return;
    n->njob = njob;
    net_loads_make(n);
}

struct link_load *net_links(const struct net *n, int job, struct arena *a, int *nlink)
{
    *nlink = 0;
    if (!n->load) return NULL;
    CHECK(job >= 0 && job < n->njob);
    const size_t first = (size_t)job * (size_t)n->nresource;
    const bool whole = n->nresource <= NET_LINKS_WHOLE;
    /* Counted first: an arena gives nothing back. */
    int count = whole ? n->nresource : 0;
    for (int i = 0; !whole && (i = next_used(n, first, i)) < n->nresource; i++) count++;
    struct link_load *list = TAKE(a, count, struct link_load);
    for (int i = 0; *nlink < count; i++) {
        if (!whole) i = next_used(n, first, i);
        list[*nlink] = n->load[first + (size_t)i];
        name_load(n, i, &list[(*nlink)++]);
    }
    return list;
}

struct link_load *net_port_load(struct net *n, int node)
{
    return n->load ? net_load(n, (size_t)node) : NULL;
}
