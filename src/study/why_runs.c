/* why_runs.c - see why_runs.h. */
#include "study/why_runs.h"

#include <string.h>

#include "run/run.h"

/* Results of a batch; arrays are copied, since a campaign's own live for one call only. */
struct batch {
    const struct run_spec *spec; /* (n) */
    struct run_result *result;   /* (n) */
    struct arena *arena;
};

static void *copied(struct arena *a, const void *from, size_t bytes)
{
    if (bytes == 0) return NULL;
    void *to = arena_take(a, bytes);
    memcpy(to, from, bytes);
    return to;
}

static bool keep_result(void *context, const struct run_spec *spec, const struct run_result *r)
{
    struct batch *b = context;
    struct run_result *to = &b->result[spec - b->spec];
    const size_t rows = r->stage ? (size_t)r->nrank * (size_t)r->nstage : 0;
    *to = *r;
    to->stage = copied(b->arena, r->stage, rows * sizeof *r->stage);
    to->finish_ps =
        copied(b->arena, r->finish_ps, r->finish_ps ? (size_t)r->nrank * sizeof *r->finish_ps : 0);
    to->path = copied(b->arena, r->path, (size_t)r->npath * sizeof *r->path);
    to->slack = copied(b->arena, r->slack, (size_t)r->nslack * sizeof *r->slack);
    to->rank_slack =
        copied(b->arena, r->rank_slack, r->rank_slack ? rows * sizeof *r->rank_slack : 0);
    to->link = copied(b->arena, r->link, (size_t)r->nlink * sizeof *r->link);
    to->span = NULL, to->nspan = 0;
    return true;
}

/* What a study needs of a run beside the order of its own: no timelines, no counters of links. */
struct run_spec why_bare(const struct run_spec *spec, bool path)
{
    struct run_spec s = *spec;
    s.record.spans = s.record.links = false;
    s.record.path = path;
    return s;
}

bool why_batch(const struct run_spec *spec, int n, int workers, bool quiet, struct arena *a,
               struct run_result *result, struct err *e)
{
    struct batch b = {spec, result, a};
    return n == 0 || run_campaign(spec, NULL, n, NULL, workers, quiet, keep_result, &b, e);
}
