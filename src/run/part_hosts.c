/* part_hosts.c - see part_hosts.h. */
#include "run/part_hosts.h"

#include "hosts/hosts_copy.h"
#include "vp/world.h"

enum { TAG_PART = 420, TAG_HANDED, TAG_AGREED };

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

static bool agree(const void *hosts, bool ok, struct err *e)
{
    return hosts_agree(hosts, TAG_AGREED, ok, e);
}

struct run_part part_hosts(const struct hosts *h, int nrank)
{
    struct run_part p = {.number = h->rank, .of = h->size, .context = h,
                     .sum = sum, .largest = largest, .give = give, .take = take, .agree = agree};
    const struct world_load load = {.nrank = nrank, .hosts = h};
    world_part(&load, &p.first, &p.end);
    return p;
}
