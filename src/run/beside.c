/* beside.c - see beside.h.
 *
 * Every job of a set is a run of its own: this one looks at one of them and simulates the others
 * for what they do to it. They are prepared, judged and repeated as they would be alone, so that
 * their messages are the same. */
#include "run/beside.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/memory.h"
#include "base/text.h"
#include "run/launch.h"
#include "run/omission.h"
#include "run/run.h"
#include "sim/sim.h"

/* One job of the set; for the run itself `run` is the caller's. */
struct member {
    bool runs, opened;
    struct program_run *run;        /* opened; of the run itself borrowed, else owned */
    struct run_cache *cache;        /* owned; NULL: the run itself */
    struct arena *own, *scratch;    /* owned but for the run itself */
    struct arena_mark work, results;
    struct arena *arena; /* of its result */
    struct run_result *out;
    struct record_spec record;
};

struct group {
    const struct job_set *set;
    int own; /* number of the run itself, from 0 */
    struct member member[JOB_MOST];
};

/* What a job beside the run is: its own program on the run's machine. */
static struct run_spec neighbour(const struct run_spec *own, const struct run_spec *job)
{
    struct run_spec s = *job;
    /* Repetitions are those of the whole run: its noise is another one each time, for all. */
    const struct placement_spec place = job->machine.placement;
    s.machine = own->machine;
    s.machine.placement = place;
    s.rep = own->rep;
    return s;
}

/* Programs keep scenes in their cache: each job has its own, so that none gives away another's. */
static bool open_member(struct group *g, int i, const struct program_run *r, struct err *e)
{
    struct member *m = &g->member[i];
    const struct run_spec spec = neighbour(&r->spec, g->set->job[i]);
    /* Marked at once: what a failing open has taken is given back by close_members. */
    m->runs = m->opened = true;
    m->own = arena_create();
    m->scratch = arena_create();
    m->arena = arena_create();
    m->cache = run_cache_create();
    m->run = memory_zeroed(1, sizeof *m->run);
    m->out = memory_zeroed(1, sizeof *m->out);
    /* Told with its name: what the user asked for was another job's row. */
    struct err why;
    err_clear(&why);
    if (run_open(&spec, NULL, m->cache, m->own, m->run, &why)) return true;
    return err_set(e, why.kind, "job '%s' beside it: %.400s", spec.job.name, why.text);
}

/* Images of people's programs first: their ranks have ended, and nothing else points into them. */
static void close_members(struct group *g)
{
    for (int i = 0; i < g->set->n; i++) {
        struct member *m = &g->member[i];
        /* The run itself is its caller's. */
        if (!m->opened) continue;
        run_close(m->run);
        run_cache_destroy(m->cache);
        arena_destroy(m->own);
        arena_destroy(m->scratch);
        arena_destroy(m->arena);
        free(m->run);
        free(m->out);
    }
}

/* All programs that run, the caller's among them. */
static bool open_members(struct group *g, struct program_run *r, struct arena *scratch,
                         struct arena *a, struct run_result *out, struct err *e)
{
    for (int i = 0; i < g->set->n; i++) {
        /* Who is idle needs no program: its number of ranks is in its settings. */
        if (i == g->own || g->set->idle[i]) continue;
        if (!open_member(g, i, r, e)) return false;
    }
    g->member[g->own] = (struct member){.runs = true,
                                        .run = r,
                                        .scratch = scratch,
                                        .arena = a,
                                        .out = out,
                                        .record = omission_record(&r->spec, r->order.keep)};
    /* Each attempt starts from here: a program that asks for many keeps the memory of one. */
    for (int i = 0; i < g->set->n; i++) {
        struct member *m = &g->member[i];
        if (!m->runs) continue;
        m->work = arena_mark(m->scratch);
        m->results = arena_mark(m->arena);
    }
    return true;
}

/* Memory and result as before the first attempt; then as each program has itself prepared. */
static bool prepare(struct group *g, struct err *e)
{
    for (int i = 0; i < g->set->n; i++) {
        struct member *m = &g->member[i];
        if (!m->runs) continue;
        arena_release(m->scratch, m->work);
        arena_release(m->arena, m->results);
        /* A result of the attempt before must not shine through. */
        memset(m->out, 0, sizeof *m->out);
        m->out->residual = m->out->measured_s = NAN;
        if (!m->run->type->prepare(m->run, m->scratch, e)) return false;
    }
    return true;
}

/* The set as launch.h takes it, in its order: places depend on it. */
static bool launch(struct group *g, struct arena *world, struct err *e)
{
    const struct program_run *r = g->member[g->own].run;
    const struct machine_spec machine = omission_machine(&r->spec, r->order.keep);
    struct launch_job job[JOB_MOST];
    for (int i = 0; i < g->set->n; i++) {
        const struct member *m = &g->member[i];
        const struct run_spec *s = i == g->own ? &r->spec : g->set->job[i];
        struct run_spec repeated = *s;
        repeated.rep = r->spec.rep;
        /* An idle job has a place and nothing else. */
        job[i] = (struct launch_job){.name = s->job.name,
                                     .nrank = s->nrank,
                                     .placement = &s->machine.placement,
                                     .start_ps = sim_from_seconds(s->job.start),
                                     .seed = run_spec_seed(&repeated)};
        if (!m->runs) continue;
        /* Promises are each program's own; the weakest counts for the network. */
        job[i].r = m->run;
        job[i].largest = omission_largest_message(m->run);
        job[i].record = &m->record;
        job[i].scratch = m->scratch;
        job[i].arena = m->arena;
        job[i].out = m->out;
    }
    /* The traffic of strangers is the same whichever job is looked at. */
    return launch_jobs(job, g->set->n, &machine, job[0].seed, r->order.heartbeat, world, e);
}

/* Whether one of the programs asks for one more attempt; all of them judge. */
static bool once_more(struct group *g)
{
    bool more = false;
    for (int i = 0; i < g->set->n; i++) {
        const struct member *m = &g->member[i];
        /* A run that did not end well has no answer to be judged. */
        if (!m->runs || (m->out->status != RUN_OK && m->out->status != RUN_INVALID)) continue;
        m->out->residual = m->out->measured_s = NAN;
        if (m->out->status == RUN_OK && m->run->type->judge) m->run->type->judge(m->run, m->out);
        if (m->run->type->again && m->run->type->again(m->run, m->out)) more = true;
    }
    return more;
}

bool beside_attempts(struct program_run *r, struct arena *scratch, struct arena *world,
                     struct arena *a, struct run_result *out, struct err *e)
{
    memset(out, 0, sizeof *out);
    if (r->spec.record.path)
        return err_set(e, ERR_CONFIG,
                       "what binds a run is found for a program that has its machine alone, and "
                       "job '%s' shares it; take the scenario without 'jobs'",
                       r->spec.job.name);
    /* What processes cannot share, one does. */
    if (r->order.hosts && r->order.hosts->rank > 0) return true;
    /* Of the heap: so many members are too many for a stack. */
    struct group *g = memory_zeroed(1, sizeof *g);
    g->set = r->spec.jobs;
    g->own = r->spec.job.number - 1;
    /* Whatever fails, everything that was opened is closed at the end. */
    bool ok = open_members(g, r, scratch, a, out, e);
    /* A program may change its settings and ask again; then all start once more, since what the
     * others met has changed. */
    do ok = ok && prepare(g, e) && launch(g, world, e);
    while (ok && once_more(g));
    if (r->order.threads > 1 || r->order.hosts)
        text_copy(out->alone, sizeof out->alone, "several jobs share the machine");
    close_members(g);
    free(g);
    return ok;
}
