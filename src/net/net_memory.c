/* net_memory.c - what a network takes of the host's memory, before anything is sent (net.h).
 *
 * Two parts: tables with a row for each resource, of which the system gives pages only where
 * something passes, and the messages on their way. Which those are depends on the program; a rank
 * is taken to send to ranks at distances of powers of two, as recursive doubling does. */
#include <math.h>

#include "net/net.h"
#include "net/net_internal.h"

/* PAGE_BYTES: how the system gives memory. IN_FLIGHT: messages of a rank on their way at one time,
 * as seen with dynamics of 4,096 bodies on 4,096 ranks, on tori of 4,096 and of 2 million nodes, at
 * levels packet and flit. HOPS_OF_PAGE: how many of a way's resources lie in one page, as seen with
 * 256 and 4,096 ranks on nodes of a large torus at random. */
enum { PAGE_BYTES = 4096, IN_FLIGHT = 16, HOPS_OF_PAGE = 3 };

/* Mean number of resources on a way; few ranks are looked at. */
static double mean_way(const struct net *n, const int *node, int nrank)
{
    enum { LOOKED_AT = 16 };
    const int step = nrank / LOOKED_AT + 1;
    double sum = 0;
    int count = 0;
    for (int rank = 0; rank < nrank; rank += step) {
        for (int64_t far = 1; far < nrank; far *= 2) {
            const int to = (int)((rank + far) % nrank);
            if (node[rank] == node[to]) continue;
            sum += topology_distance(n->topology, node[rank], node[to]) + 2;
            count++;
        }
    }
    return count ? sum / count : 0;
}

/* The share of all nodes that lie between the first and the last one in use. */
static double span(const struct net *n, const int *node, int nrank)
{
    int first = n->nnode, last = -1;
    for (int i = 0; i < nrank; i++) {
        if (node[i] < first) first = node[i];
        if (node[i] > last) last = node[i];
    }
    return last < first ? 0 : (double)(last - first + 1) / n->nnode;
}

/* So many throws at `n` things miss a share of them. */
static double hit(double n, double throws) { return n > 0 ? n * -expm1(-throws / n) : 0; }

double net_memory(const struct net *n, size_t tables, const int *node, int nrank, double messages)
{
    const double way = mean_way(n, node, nrank), share = span(n, node, nrank);
    const double ways = fmin(messages, 2 * nrank * log2(nrank));
    /* Where messages do not meet, nobody looks at links, and each node has a port. */
    const double touched = n->type == &net_loggp ? nrank : ways * way;
    const double pages = hit((double)tables / PAGE_BYTES * share, touched / HOPS_OF_PAGE);
    const double resources = hit(n->nresource * share, touched);
    const double flying = fmin(messages, (double)nrank * IN_FLIGHT);
    /* The result has a list of all resources; of more, of the few in use. */
    const double listed = n->load && n->nresource <= NET_LINKS_WHOLE ? n->nresource : 0;
    return pages * PAGE_BYTES + listed * (double)sizeof(struct link_load) +
           resources * (double)n->resource_bytes +
           flying * ((double)n->message_bytes + way * (double)n->hop_bytes);
}
