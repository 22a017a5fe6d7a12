/* why.c - the runs behind why.h: the one with its path, the idealised machines, and how far
 * parameters may move. */
#include "study/why.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/progress.h"
#include "run/run.h"

/* ---- runs ---- */

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
    to->span = NULL, to->nspan = 0;
    to->link = NULL, to->nlink = 0;
    return true;
}

/* What a study needs of a run beside the order of its own: no timelines, no counters of links. */
static struct run_spec bare(const struct run_spec *spec, bool path)
{
    struct run_spec s = *spec;
    s.record.spans = s.record.links = false;
    s.record.path = path;
    return s;
}

static bool run_batch(const struct run_spec *spec, int n, int workers, bool quiet, struct arena *a,
                      struct run_result *result, struct err *e)
{
    struct batch b = {spec, result, a};
    return n == 0 || run_campaign(spec, NULL, n, NULL, workers, quiet, keep_result, &b, e);
}

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

/* --- idealised machines ----------------------------------------------------------------------- */

static void no_latency(struct machine_spec *m)
{
    m->network.hop_latency = m->network.end_latency = m->network.routing_latency = 0;
    m->network.vc_allocation_latency = m->network.credit_latency = 0;
    m->software.rendezvous_latency = m->software.shared_latency = 0;
    for (int i = 0; i < m->software.nsegment; i++)
        m->software.segment[i].latency = m->software.segment[i].rendezvous_latency = 0;
}

static void no_overhead(struct machine_spec *m)
{
    struct software_spec *s = &m->software;
    s->send_overhead = s->recv_overhead = s->send_copy = s->recv_copy = s->eager_copy = 0;
    s->short_saving = s->short_copy = s->kernel_time = s->kernel_per_byte = s->gap = 0;
    for (int i = 0; i < s->nsegment; i++) {
        struct software_segment *x = &s->segment[i];
        x->send_overhead = x->recv_overhead = x->send_copy = x->recv_copy = x->gap = 0;
        x->send_saving = x->recv_extra = 0;
    }
}

/* So fast that a flit takes the least time there is, 1 ps. Levels with flits refuse the rate 0,
 * which means unlimited elsewhere; ports without a bandwidth of their own have the link's. */
static void no_bytes(struct machine_spec *m)
{
    m->network.link_bandwidth = 1e18;
    /* a latency is many such flits, which a buffer has to hold */
    m->network.buffer_flits = 1 << 24;
    m->network.injection_bandwidth = m->network.ejection_bandwidth = 0;
    memset(m->topology.dim_bandwidth, 0, sizeof m->topology.dim_bandwidth);
    m->software.gap_per_byte = 0;
    for (int i = 0; i < m->software.nsegment; i++) m->software.segment[i].gap_per_byte = 0;
}

static void no_computing(struct machine_spec *m)
{
    /* node_cost.c: no cost, neither of operations nor of instructions */
    m->node.flop_rate = m->node.clock = 0;
    m->node.div_cycles = m->node.sqrt_cycles = m->node.trig_cycles = m->node.call_time = 0;
    m->node.copy_bandwidth = 0;
}

static void no_contention(struct machine_spec *m) { m->network.level = LEVEL_LOGGP; }

static const struct ideal {
    const char *name, *what;
    void (*change)(struct machine_spec *m);
} ideals[] = {
    {"zero latency", "hop, end, segment and rendezvous latencies are 0", no_latency},
    {"zero overhead", "o_s, o_r, copies and gap g are 0", no_overhead},
    {"infinite bandwidth", "links, ports and G take no time a byte", no_bytes},
    {"infinitely fast nodes", "no operation takes time", no_computing},
    {"no contention", "level loggp: messages wait for their own port alone", no_contention},
};

enum { IDEALS = sizeof ideals / sizeof ideals[0] };

static bool find_limits(const struct run_spec *spec, int workers, bool quiet, struct arena *a,
                        struct why *w, struct err *e)
{
    struct run_spec run[IDEALS];
    struct run_result result[IDEALS];
    for (int i = 0; i < IDEALS; i++) {
        run[i] = bare(spec, false);
        ideals[i].change(&run[i].machine);
    }
    if (!run_batch(run, IDEALS, workers, quiet, a, result, e)) return false;
    for (int i = 0; i < IDEALS; i++)
        w->limit[w->nlimit++] =
            (struct why_limit){ideals[i].name, ideals[i].what,
                               result[i].status <= RUN_INVALID ? result[i].makespan_ps : 0};
    return true;
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

/* How often the path of a run pays a parameter, in the same unit as why_parameter.time_ps. */
static int64_t contribution_of(const struct run_spec *spec, const struct run_result *r,
                               const char *key)
{
    struct why w = {.run = *r};
    why_contributions(&spec->machine, &w);
    for (int i = 0; i < w.nparameter; i++)
        if (strcmp(w.parameter[i].key, key) == 0) return w.parameter[i].time_ps;
    return 0;
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
        run[k] = bare(spec, true);
        why_scale(&run[k].machine, s[i].parameter->key, s[i].trial);
        of[k++] = i;
    }
    *more = k > 0;
    if (!run_batch(run, k, workers, quiet, a, result, e)) return false;
    for (int i = 0; i < k; i++) {
        struct search *x = &s[of[i]];
        if (result[i].status > RUN_INVALID) {
            x->done = true;
            continue;
        }
        take_trial(x, (double)result[i].makespan_ps, LONGER * plain);
        /* The same path pays it as often, so its time grew by the factor and no more. */
        const double grown = (double)contribution_of(&run[i], &result[i], x->parameter->key);
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
    const struct run_spec run = bare(spec, true);
    if (!run_batch(&run, 1, 1, quiet, a, &out->run, e)) return false;
    const struct run_result *r = &out->run;
    if (r->status > RUN_INVALID) {
        const enum err_kind kind = r->refusal ? (enum err_kind)r->refusal
                                   : r->status == RUN_DEADLOCK ? ERR_DEADLOCK
                                                               : ERR_CHECK;
        return err_set(e, kind, "%s", r->text);
    }
    add_shares(out, a);
    add_ranks(out, a);
    why_contributions(&spec->machine, out);
    return (!(ask & WHY_LIMITS) || find_limits(spec, workers, quiet, a, out, e)) &&
           (!(ask & WHY_TOLERANCES) || find_tolerances(spec, workers, quiet, a, out, e));
}
