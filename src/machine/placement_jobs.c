/* placement_jobs.c - which processors each of several jobs gets; see placement_jobs.h.
 *
 * One table says for each processor whose it is. A job of a machine alone goes the same way, with
 * all processors free. */
#include "machine/placement_jobs.h"

#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "base/random.h"
#include "machine/placement_order.h"

enum { BROKEN = -1 };

/* What is being filled. */
struct filling {
    const struct machine_spec *machine;
    const struct topology *topology;
    int64_t nprocessor, nfree;
    int *owner; /* (nprocessor) 1 + job, 0: free, BROKEN: it does not work */
    int *rank;  /* (nprocessor) of it, by lists */
    struct placement *placement; /* (n) */
    const struct placement_job *job; /* (n) */
    struct err *err;
};

/* The next rank of job `i` lives on `processor`. */
static void put(struct filling *f, int i, int rank, int64_t processor)
{
    const int per_node = f->machine->topology.processors_per_node;
    f->placement[i].node[rank] = (int)(processor / per_node);
    f->placement[i].processor[rank] = (int)(processor % per_node);
    f->owner[processor] = i + 1;
    f->nfree--;
}

/* "job 'a': ", or nothing where there is one job. */
static const char *whose(const struct placement_job *job, char *buffer, size_t size)
{
    buffer[0] = '\0';
    if (job->name) snprintf(buffer, size, "job '%.31s': ", job->name);
    return buffer;
}

/* ---- lists */

/* Whoever has the processor already is told with his rank. */
static bool refuse_taken(const struct filling *f, int i, int rank, int processor)
{
    const int other = f->owner[processor] - 1, per_node = f->machine->topology.processors_per_node;
    if (f->owner[processor] == BROKEN)
        return err_set(f->err, ERR_CONFIG,
                       "placement.list: processor %d of rank %d hangs on router %d, which "
                       "network.failed.routers names",
                       processor, rank, topology_router_of(f->topology, processor / per_node));
    if (other == i)
        return err_set(f->err, ERR_CONFIG, "placement.list: ranks %d and %d on processor %d",
                       f->rank[processor], rank, processor);
    return err_set(f->err, ERR_CONFIG,
                   "jobs '%.31s' and '%.31s' overlap: rank %d of one and rank %d of the other on "
                   "processor %d",
                   f->job[other].name, f->job[i].name, f->rank[processor], rank, processor);
}

/* The list may name more processors than there are ranks; none twice. */
static bool place_by_list(struct filling *f, int i)
{
    const struct placement_job *job = &f->job[i];
    const struct placement_spec *s = job->spec;
    char name[48];
    whose(job, name, sizeof name);
    if (s->nlist < job->nrank)
        return err_set(f->err, ERR_CONFIG, "%splacement.list names %d processors for %d ranks",
                       name, s->nlist, job->nrank);
    for (int r = 0; r < job->nrank; r++) {
        const int processor = s->list[r];
        if (processor < 0 || processor >= f->nprocessor)
            return err_set(f->err, ERR_CONFIG,
                           "%splacement.list: processor %d of rank %d; expected 0 to %lld", name,
                           processor, r, (long long)f->nprocessor - 1);
        if (f->owner[processor]) return refuse_taken(f, i, r, processor);
        f->rank[processor] = r;
        put(f, i, r, processor);
    }
    return true;
}

/* ---- orders and chance */

/* The first free ones along the job's own order of all processors. */
static bool place_in_order(struct filling *f, int i)
{
    struct machine_spec m = *f->machine;
    m.placement = *f->job[i].spec;
    if (!placement_fits(&m, f->err)) return false;
    int64_t at = 0;
    for (int r = 0; r < f->job[i].nrank; r++) {
        int64_t processor;
        do processor = placement_processor(&m, f->topology, at++);
        while (f->owner[processor]);
        put(f, i, r, processor);
    }
    return true;
}

/* Fisher and Yates over the free processors, as far as needed. */
static void place_randomly(struct filling *f, int i, struct arena *a)
{
    struct random g = random_make(f->job[i].spec->seed, 0x706c616365, 0); /* "place" */
    struct arena_mark mark = arena_mark(a);
    int64_t *all = TAKE(a, f->nfree, int64_t), n = 0;
    for (int64_t k = 0; k < f->nprocessor; k++)
        if (!f->owner[k]) all[n++] = k;
    for (int r = 0; r < f->job[i].nrank; r++) {
        const int64_t k = r + (int64_t)random_below(&g, (uint64_t)(n - r)), other = all[k];
        all[k] = all[r];
        all[r] = other;
        put(f, i, r, other);
    }
    arena_release(a, mark);
}

/* ---- groups */

/* A router, what the family knows between, the whole. */
int placement_groups(const struct topology *t, int64_t *size)
{
    size[0] = t->nodes_per_router;
    int n = 1 + topology_parts(t, size + 1);
    size[n++] = t->nnode;
    /* Each size once, and none that does not divide the machine into whole parts. */
    int kept = 0;
    for (int i = 0; i < n; i++)
        if (t->nnode % size[i] == 0 && (kept == 0 || size[i] > size[kept - 1]))
            size[kept++] = size[i];
    return kept;
}

/* The free processors of each block of `size` processors. */
static void count_free(const struct filling *f, int64_t size, int64_t *count)
{
    memset(count, 0, (size_t)(f->nprocessor / size) * sizeof *count);
    for (int64_t k = 0; k < f->nprocessor; k++) count[k / size] += !f->owner[k];
}

/* The fullest block that still has room for `want`; else, with `any`, the emptiest one; -1: none.
 * The first of equals. */
static int64_t choose_block(const int64_t *count, int64_t n, int64_t want, bool any)
{
    int64_t best = -1, most = -1;
    for (int64_t b = 0; b < n; b++) {
        if (count[b] >= want && (best < 0 || count[b] < count[best])) best = b;
        if (most < 0 || count[b] > count[most]) most = b;
    }
    return best >= 0 || !any ? best : most;
}

/* Ranks from `rank` on into the free processors of one block, as far as they go; the next rank. */
static int fill_block(struct filling *f, int i, int rank, int64_t first, int64_t size)
{
    for (int64_t k = first; k < first + size && rank < f->job[i].nrank; k++)
        if (!f->owner[k]) put(f, i, rank++, k);
    return rank;
}

/* A job that fits into one part of the network gets the smallest such part, the fullest of several,
 * so that larger parts stay whole for others. One that does not takes as few of the largest parts
 * as it can. */
static void place_in_groups(struct filling *f, int i, struct arena *a)
{
    const int per_node = f->machine->topology.processors_per_node, want = f->job[i].nrank;
    int64_t level[PLACEMENT_LEVELS];
    const int n = placement_groups(f->topology, level);
    struct arena_mark mark = arena_mark(a);
    int64_t *count = TAKE(a, f->topology->nnode, int64_t);
    int64_t size = f->nprocessor;
    for (int k = 0; k < n - 1; k++) {
        size = level[k] * per_node;
        count_free(f, size, count);
        const int64_t b = choose_block(count, f->nprocessor / size, want, false);
        if (b < 0) continue;
        fill_block(f, i, 0, b * size, size);
        arena_release(a, mark);
        return;
    }
    for (int rank = 0; rank < want;) {
        count_free(f, size, count);
        const int64_t b = choose_block(count, f->nprocessor / size, want - rank, true);
        rank = fill_block(f, i, rank, b * size, size);
    }
    arena_release(a, mark);
}

/* ---- all */

/* One job that is not a list, on what is left. */
static bool place(struct filling *f, int i, struct arena *a)
{
    const struct placement_job *job = &f->job[i];
    char name[48];
    if (job->nrank > f->nfree)
        return err_set(f->err, ERR_CONFIG,
                       "%s%d ranks, but %lld of the %lld processors of machine %s are free",
                       whose(job, name, sizeof name), job->nrank, (long long)f->nfree,
                       (long long)f->nprocessor, f->machine->name);
    switch (job->spec->kind) {
    case PLACEMENT_RANDOM:
        place_randomly(f, i, a);
        return true;
    case PLACEMENT_GROUPS:
        place_in_groups(f, i, a);
        return true;
    default:
        return place_in_order(f, i);
    }
}

/* Processors whose router does not work belong to nobody. */
static void leave_out_broken(struct filling *f)
{
    const int per_node = f->machine->topology.processors_per_node;
    for (int64_t k = 0; k < f->nprocessor; k++) {
        if (placement_works(f->topology, (int)(k / per_node))) continue;
        f->owner[k] = BROKEN;
        f->nfree--;
    }
}

/* One rank a processor: there is no time slicing in this simulator. */
bool placement_create_jobs(struct placement *p, const struct machine_spec *m,
                           const struct topology *t, int n, const struct placement_job *job,
                           struct arena *a, struct err *e)
{
    struct filling f = {.machine = m, .topology = t, .placement = p, .job = job, .err = e};
    f.nprocessor = f.nfree = (int64_t)t->nnode * m->topology.processors_per_node;
    for (int i = 0; i < n; i++)
        p[i] = (struct placement){job[i].nrank, TAKE(a, job[i].nrank, int),
                                  TAKE(a, job[i].nrank, int)};
    struct arena_mark mark = arena_mark(a);
    f.owner = TAKE(a, f.nprocessor, int);
    f.rank = TAKE(a, f.nprocessor, int);
    if (!topology_whole(t)) leave_out_broken(&f);
    bool ok = true;
    for (int i = 0; i < n && ok; i++)
        if (job[i].spec->kind == PLACEMENT_LIST) ok = place_by_list(&f, i);
    for (int i = 0; i < n && ok; i++)
        if (job[i].spec->kind != PLACEMENT_LIST) ok = place(&f, i, a);
    arena_release(a, mark);
    return ok;
}
