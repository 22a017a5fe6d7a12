/* part_hosts.c - see part_hosts.h. */
#include "run/part_hosts.h"

#include "hosts/hosts_copy.h"
#include "vp/world.h"

enum { TAG_PART = 420, TAG_HANDED };

static bool sum(const void *hosts, int64_t *x, int n)
{
    return hosts_all_sum(hosts, TAG_PART, x, n);
}

static bool largest(const void *hosts, int64_t *x, int n)
{
    return hosts_all_largest(hosts, TAG_PART, x, n);
}

static bool give(const void *hosts, int to, const void *data, size_t bytes)
{
    return hosts_copy_out(hosts, to, TAG_HANDED, data, bytes);
}

static bool take(const void *hosts, int from, void *data, size_t bytes)
{
    return hosts_copy_in(hosts, from, TAG_HANDED, data, bytes);
}

struct run_part part_hosts(const struct hosts *h, int nrank)
{
    struct run_part p = {.number = h->rank, .of = h->size, .context = h,
                     .sum = sum, .largest = largest, .give = give, .take = take};
    const struct world_load load = {.nrank = nrank, .hosts = h};
    world_part(&load, &p.first, &p.end);
    return p;
}
