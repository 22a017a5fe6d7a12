/* net_account.h - what passed over each link and port: accounts that the levels write at every
 * step, read by net_links. */
#ifndef NET_NET_ACCOUNT_H
#define NET_NET_ACCOUNT_H

#include <stdatomic.h>

#include "net/net_internal.h"

/* net_loads_make: the accounts of all resources for n->njob jobs, none of which is in use. */
void net_loads_make(struct net *n);

/* net_load: the account of a resource, number `at` of n->load, which is in use from now on. Threads
 * that share a run have accounts of their own, but not parts of them. */
enum { NET_LOADS = 1024 };
static inline struct link_load *net_load(struct net *n, size_t at)
{
    if (n->load_used && !atomic_load_explicit(&n->load_used[at / NET_LOADS], memory_order_relaxed))
        atomic_store_explicit(&n->load_used[at / NET_LOADS], true, memory_order_relaxed);
    return &n->load[at];
}

/* net_job: the job that m belongs to. */
static inline int net_job(const struct net_message *m) { return (int)(m->id >> NET_ID_JOB); }

/* net_account_of: the number in n->load of a resource's account for a job. */
static inline size_t net_account_of(const struct net *n, int resource, int job)
{
    return (size_t)job * (size_t)n->nresource + (size_t)resource;
}

/* net_account: resource was used for `busy` by a message of `job` with `bytes` of payload that
 * waited `queue` for it (or by a part of one: messages 0). */
static inline void net_account(struct net *n, int resource, int job, int messages, int64_t bytes,
                               sim_ps busy, sim_ps queue)
{
    if (!n->load) return;
    struct link_load *l = net_load(n, net_account_of(n, resource, job));
    l->messages += messages;
    l->bytes += bytes;
    l->busy_ps += busy;
    l->queue_ps += queue;
}

/* net_account_packet: the same of packet `index` of m, which counts with its first one. */
static inline void net_account_packet(struct net *n, int resource, const struct net_message *m,
                                      int64_t index, sim_ps busy, sim_ps queue)
{
    if (n->load)
        net_account(n, resource, net_job(m), index == 0, index == 0 ? m->bytes : 0, busy, queue);
}

/* net_account_early: asks for the memory that net_account will need. */
static inline void net_account_early(const struct net *n, int resource, int job)
{
    if (!n->load) return;
    const struct link_load *l = &n->load[net_account_of(n, resource, job)];
    __builtin_prefetch(&l->messages, 1);
    __builtin_prefetch(&l->queue_ps, 1);
}

#endif
