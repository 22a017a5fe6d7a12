/* why.c - the runs behind why.h: the one with its path, and how far parameters may move before it
 * is 5 % longer. */
#include "study/why.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "study/why_limits.h"
#include "study/why_range.h"
#include "study/why_runs.h"

/* ---- the path ---- */

static int longer_share(const void *a, const void *b)
{
    const struct why_share *x = a, *y = b;
    if (x->time_ps != y->time_ps) return x->time_ps < y->time_ps ? 1 : -1;
    return x->stage != y->stage ? x->stage - y->stage : (int)x->cause - (int)y->cause;
}

static int longer_rank(const void *a, const void *b)
{
    const struct why_rank *x = a, *y = b;
    if (x->time_ps != y->time_ps) return x->time_ps < y->time_ps ? 1 : -1;
    return x->rank - y->rank;
}

enum { CELLS = RUN_MAX_STAGES * PATH_CAUSES };

static void add_shares(struct why *w, struct arena *a)
{
    struct why_share *cell = TAKE(a, CELLS, struct why_share);
    for (int64_t i = 0; i < w->run.npath; i++) {
        const struct path_step *s = &w->run.path[i];
        struct why_share *c = &cell[s->stage * PATH_CAUSES + (int)s->cause];
        c->cause = s->cause;
        c->stage = s->stage;
        c->time_ps += s->end_ps - s->begin_ps;
        c->steps++;
    }
    qsort(cell, CELLS, sizeof *cell, longer_share);
    for (w->nshare = 0; w->nshare < CELLS && cell[w->nshare].time_ps > 0;) w->nshare++;
    w->share = cell;
}

/* A message of the path is a change of the rank that computes, sends or receives. */
static bool is_of_rank(enum path_cause c)
{
    return c == PATH_COMPUTE || c == PATH_SEND || c == PATH_RECV || c == PATH_POLL ||
           c == PATH_SERVER;
}

static void add_ranks(struct why *w, struct arena *a)
{
    struct why_rank *of = TAKE(a, w->run.nrank, struct why_rank);
    int before = -1;
    for (int r = 0; r < w->run.nrank; r++) of[r].rank = r;
    for (int64_t i = 0; i < w->run.npath; i++) {
        const struct path_step *s = &w->run.path[i];
        of[s->rank].time_ps += s->end_ps - s->begin_ps;
        if (!is_of_rank(s->cause)) continue;
        w->messages += before >= 0 && before != s->rank;
        before = s->rank;
    }
    qsort(of, (size_t)w->run.nrank, sizeof *of, longer_rank);
    while (w->ranks < w->run.nrank && of[w->ranks].time_ps > 0) w->ranks++;
    w->nrank = w->ranks < WHY_RANKS ? w->ranks : WHY_RANKS;
    memcpy(w->rank, of, (size_t)w->nrank * sizeof *of);
}

static int longer_resource(const void *a, const void *b)
{
    const struct why_resource *x = a, *y = b;
    if (x->time_ps != y->time_ps) return x->time_ps < y->time_ps ? 1 : -1;
    return x->resource - y->resource;
}

/* Where it passes: the links and ports, as far as the level tells. */
static void add_resources(struct why *w, struct arena *a)
{
    if (w->run.nlink == 0) return;
    struct why_resource *of = TAKE(a, w->run.nlink, struct why_resource);
    for (int i = 0; i < w->run.nlink; i++) of[i].resource = i;
    for (int64_t i = 0; i < w->run.npath; i++) {
        const struct path_step *s = &w->run.path[i];
        if (s->resource >= 0 && s->resource < w->run.nlink)
            of[s->resource].time_ps += s->end_ps - s->begin_ps;
    }
    qsort(of, (size_t)w->run.nlink, sizeof *of, longer_resource);
    while (w->nresource < WHY_RANKS && w->nresource < w->run.nlink &&
           of[w->nresource].time_ps > 0) {
        w->resource[w->nresource] = of[w->nresource];
        w->nresource++;
    }
}

/* --- how far a parameter may move ------------------------------------------------------------- */

enum { ASKED = 8, ROUNDS = 6 };
static const double LONGER = 1.05, MOST_FACTOR = 1000, NEAR = 1e-4;

/* One parameter's search: the run takes 5 % longer between the factors `low` and `high`. */
struct search {
    struct why_parameter *parameter;
    double low, high; /* high 0: not known yet */
    double low_time, high_time;
    double trial;
    bool done;
};

/* The path alone gives a lower bound of the time, since the makespan is the longest of all paths:
 * the first trial can only be too far. After that a straight line between both ends. */
static double next_trial(const struct search *s, double plain, double goal)
{
    if (s->high == 0) {
        const double share = (double)s->parameter->time_ps / plain;
        return share > 0 ? 1 + (LONGER - 1) / share : MOST_FACTOR + 1;
    }
    return s->low + (s->high - s->low) * (goal - s->low_time) / (s->high_time - s->low_time);
}

/* Times are whole picoseconds, so the last factor is as near as they are. */
static void take_trial(struct search *s, double time, double goal)
{
    if (time > goal) s->high = s->trial, s->high_time = time;
    else s->low = s->trial, s->low_time = time;
    s->done = fabs(time - goal) <= NEAR * goal || s->high == 0;
    s->parameter->tolerance = s->trial;
}

static bool round_of(const struct run_spec *spec, struct search *s, int n, int workers, bool quiet,
                     struct arena *a, double plain, bool *more, struct err *e)
{
    struct run_spec run[ASKED];
    struct run_result result[ASKED];
    int of[ASKED], k = 0;
    for (int i = 0; i < n; i++) {
        if (s[i].done) continue;
        s[i].trial = next_trial(&s[i], plain, LONGER * plain);
        s[i].done = s[i].trial > MOST_FACTOR;
        if (s[i].done) continue;
        run[k] = why_bare(spec, true);
        why_scale(&run[k].machine, s[i].parameter->key, s[i].trial);
        of[k++] = i;
    }
    *more = k > 0;
    if (k == 0) return true;
    if (!why_batch(run, k, workers, quiet, a, result, e)) return false;
    for (int i = 0; i < k; i++) {
        struct search *x = &s[of[i]];
        if (result[i].status > RUN_INVALID) {
            x->done = true;
            continue;
        }
        take_trial(x, (double)result[i].makespan_ps, LONGER * plain);
        /* The same path pays it as often, so its time grew by the factor and no more. */
        const double grown = (double)why_contribution(&run[i], &result[i], x->parameter->key);
        x->parameter->same_path =
            fabs(grown - x->trial * (double)x->parameter->time_ps) <= 1e-6 * grown + 1000;
    }
    return true;
}

static bool find_tolerances(const struct run_spec *spec, int workers, bool quiet, struct arena *a,
                            struct why *w, struct err *e)
{
    struct search s[ASKED];
    int n = 0;
    bool more = true, ok = true;
    const double plain = (double)w->run.makespan_ps;
    for (int i = 0; i < w->nparameter && n < ASKED; i++)
        if (w->parameter[i].time_ps > 0)
            s[n++] = (struct search){.parameter = &w->parameter[i], .low = 1, .low_time = plain};
    for (int k = 0; ok && more && k < ROUNDS; k++)
        ok = round_of(spec, s, n, workers, quiet, a, plain, &more, e);
    return ok;
}

/* ---- all of it ---- */

bool why_study(const struct run_spec *spec, unsigned ask, int workers, bool quiet, struct arena *a,
               struct why *out, struct err *e)
{
    *out = (struct why){0};
    struct run_spec run = why_bare(spec, true);
    /* Slack comes from the same run; the counters of links name them. */
    run.record.slack = run.record.links = ask & WHY_SLACK;
    if (!why_batch(&run, 1, 1, quiet, a, &out->run, e)) return false;
    const struct run_result *r = &out->run;
    if (r->status > RUN_INVALID) {
        const enum err_kind kind = r->refusal ? (enum err_kind)r->refusal
                                   : r->status == RUN_DEADLOCK ? ERR_DEADLOCK
                                                               : ERR_CHECK;
        return err_set(e, kind, "%s", r->text);
    }
    add_shares(out, a);
    add_ranks(out, a);
    add_resources(out, a);
    out->roof = roofline_rows(&spec->machine, r, &out->nroof, a);
    why_contributions(&spec->machine, out);
    return (!(ask & WHY_LIMITS) || why_limits(spec, workers, quiet, a, out, e)) &&
           (!(ask & WHY_TOLERANCES) || (find_tolerances(spec, workers, quiet, a, out, e) &&
                                        why_ranges(spec, workers, quiet, a, out, e)));
}
