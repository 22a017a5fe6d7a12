/* real.c - one real run repeated, and what came of it (real.h). */
#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/digest.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "host/host_load.h"
#include "run/real_parts.h"

/* SAMPLES: that are wanted where nobody says how many; MOST_SAMPLES: of one task. LATE_NS: a rank
 * that begins later than this has disturbed the repetition. */
enum { SAMPLES = 30, MOST_SAMPLES = 20000, LATE_NS = 3000 };

/* --- one repetition --------------------------------------------------------------------------- */

/* All memory of the rank is touched before the clock runs. */
static void *make_workspace(const struct program_run *run, int rank, struct arena *scratch)
{
    const size_t bytes = run->rank->workspace_bytes(run->job, rank);
    char *w = arena_take(scratch, bytes);
    for (size_t i = 0; i < bytes; i += 4096) *(volatile char *)&w[i] = 0;
    return w;
}

/* Each process learns those of all, so that all come to the same decisions. */
static bool tell_facts(struct real *r, const struct host_times *t)
{
    int64_t mine[FACTS] = {[FACT_BEGIN] = t->begin_ns,
                           [FACT_END] = t->end_ns - t->published_ns,
                           [FACT_PREEMPTED] = t->preempted,
                           [FACT_LATE] = t->late_ns,
                           [FACT_DIGEST] = (int64_t)host_comm_digest(r->comm),
                           [FACT_MESSAGES] = t->messages,
                           [FACT_BYTES] = t->bytes,
                           [FACT_NOW] = host_clock_ns(),
                           [FACT_PROCESSOR] = sched_getcpu(),
                           [FACT_PROCESSORS] = (int64_t)host_processor_set(),
                           [FACT_OWN_NS] = (int64_t)(host_processor_seconds() * 1e9)};
    memcpy(&mine[FACT_STAGES], t->stage_ns, sizeof t->stage_ns);
    if (r->hosts != NULL) return r->hosts->call->gather(mine, FACTS, r->facts);
    memcpy(r->facts, mine, sizeof mine);
    return true;
}

/* MPI does not say which process has gone. */
static bool lost(struct real *r, struct err *e)
{
    return err_set(e, ERR_INTERNAL, "%s cannot reach all processes",
                   r->hosts != NULL ? r->hosts->call->library : "MPI");
}

/* What is inside of the two marks is measured, and nothing else.
 *
 * The ranks once. `judged`: its answer is gathered and checked. */
static bool repeat(struct real *r, bool judged, struct err *e)
{
    static const struct run_order order = {.real = true};
    struct arena *own = arena_create(), *scratch = arena_create();
    struct program_run run = {.spec = r->own};
    struct host_times times;
    bool left = false;
    /* Everything anew, as for a first run: images of people's programs, outputs, tables. */
    bool ok =
        run_open(&r->own, &order, r->cache, own, &run, e) && run.type->prepare(&run, scratch, e);
    if (ok) {
        const struct rank_program *p = run.rank;
        const int rank = r->hosts != NULL ? r->hosts->rank : 0;
        void *workspace = make_workspace(&run, rank, scratch);
        r->nstage = p->nstage;
        for (int i = 0; i < p->nstage; i++)
            text_copy(r->stage_name[i], sizeof r->stage_name[i], p->stage_name[i]);
        struct comm *c =
            host_comm_run_begin(r->comm, p->timed, p->nstage, run.output, PROGRAM_OUTPUTS);
        /* People's own programs mark their time themselves: their copy of the image is not part of
         * it (guest_world.c). */
        if (!p->foreign) c->type->mark(c, 1);
        p->run(c, run.job, workspace);
        if (!p->foreign) c->type->mark(c, 0);
        ok = host_comm_run_end(r->comm, &times, &left) && tell_facts(r, &times);
        if (!ok) lost(r, e);
    }
    if (ok && judged) {
        ok = real_judge(r, &run, own, scratch) || lost(r, e);
    }
    run_close(&run);
    arena_destroy(scratch);
    arena_destroy(own);
    return ok;
}

/* --- all repetitions -------------------------------------------------------------------------- */

/* Facts are gathered by MPI into one array of all processes.
 *
 * One row a rank. */
static const int64_t *facts_of(const struct real *r, int rank)
{
    return r->facts + (size_t)rank * FACTS;
}

/* The time of a repetition, and of its stages.
 *
 * One sample out of what all ranks told: from the common begin to the last end where they share a
 * clock, else the longest of them. */
static struct real_sample sample_of(const struct real *r, double *mean, double *largest)
{
    const bool one = host_comm_one_clock(r->comm);
    struct real_sample s = {0};
    int64_t begin = INT64_MAX, span = 0;
    for (int i = 0; i < r->nrank; i++) {
        const int64_t *f = facts_of(r, i);
        if (f[FACT_BEGIN] < begin) begin = f[FACT_BEGIN];
        s.disturbed = s.disturbed || f[FACT_PREEMPTED] > 0 || f[FACT_LATE] > LATE_NS;
    }
    for (int i = 0; i < r->nrank; i++) {
        const int64_t *f = facts_of(r, i), took = f[FACT_END] - (one ? begin : f[FACT_BEGIN]);
        if (took > span) span = took;
    }
    s.seconds = (double)span * 1e-9;
    /* The last stage: what a rank idles until the last one has ended. */
    for (int k = 0; k <= r->nstage; k++) mean[k] = largest[k] = 0;
    for (int i = 0; i < r->nrank; i++) {
        const int64_t *f = facts_of(r, i);
        double rest = (double)span * 1e-9;
        for (int k = 0; k <= r->nstage; k++) {
            const double x = k < r->nstage ? (double)f[FACT_STAGES + k] * 1e-9 : fmax(rest, 0);
            mean[k] += x / r->nrank;
            largest[k] = fmax(largest[k], x);
            rest -= x;
        }
    }
    return s;
}

/* Of all ranks together; each rank's is of what it published, in its order. */
static void note_digest(struct real *r, bool first)
{
    uint64_t d = DIGEST_START;
    for (int i = 0; i < r->nrank; i++) d = digest_mix(d, (uint64_t)facts_of(r, i)[FACT_DIGEST]);
    if (first) r->first_digest = d;
    r->out->repeatable = r->out->repeatable && d == r->first_digest;
}

/* How many repetitions are enough depends on how often the host disturbs them.
 *
 * Until there are enough, or the time is up. All processes come to the same end, since they go by
 * the same numbers: the clock is the first one's. */
static bool sample(struct real *r, const struct real_order *order, struct arena *a, struct err *e)
{
    struct real_result *out = r->out;
    const int wanted = order->samples > 0 ? order->samples : SAMPLES;
    const int most = wanted > MOST_SAMPLES / 8 ? MOST_SAMPLES : 8 * wanted;
    const double limit = order->seconds > 0 ? order->seconds : 5;
    const int64_t begin = facts_of(r, 0)[FACT_NOW];
    const size_t row = (size_t)r->nstage + 1;
    int clean = 0;
    out->sample = TAKE(a, most, struct real_sample);
    for (int i = 0; i < 2; i++) r->stage[i] = TAKE(a, size_product((size_t)most, row), double);
    while (clean < wanted && out->nsample < most) {
        const double took = (double)(facts_of(r, 0)[FACT_NOW] - begin) * 1e-9;
        if (took > limit && out->nsample >= (wanted < 3 ? wanted : 3)) break;
        if (!repeat(r, false, e)) return false;
        const size_t at = (size_t)out->nsample * row;
        const struct real_sample s = sample_of(r, &r->stage[0][at], &r->stage[1][at]);
        note_digest(r, false);
        out->sample[out->nsample++] = s;
        out->disturbed += s.disturbed;
        clean += !s.disturbed;
    }
    return true;
}

/* --- what came of it -------------------------------------------------------------------------- */

/* Statistics of column `column` of a table with `row` columns, over the samples that count. */
static struct real_times times_of(const struct real_result *out, const double *table, size_t row,
                                  size_t column, double *room)
{
    const bool all = out->nsample - out->disturbed < REAL_LEAST_SAMPLES;
    int n = 0;
    for (int i = 0; i < out->nsample; i++)
        if (all || !out->sample[i].disturbed) room[n++] = table[(size_t)i * row + column];
    return real_times_of(room, n);
}

/* Statistics over repetitions: of the whole run, then stage by stage. */
static void summarise(struct real *r, struct arena *a)
{
    struct real_result *out = r->out;
    /* One array is sorted again and again. */
    double *room = TAKE(a, out->nsample, double), *seconds = TAKE(a, out->nsample, double);
    const size_t row = (size_t)r->nstage + 1;
    for (int i = 0; i < out->nsample; i++) seconds[i] = out->sample[i].seconds;
    out->time = times_of(out, seconds, 1, 0, room);
    out->nstage = r->nstage + 1;
    for (int k = 0; k < out->nstage; k++) {
        struct real_stage *s = &out->stage[k];
        text_copy(s->name, sizeof s->name, k < r->nstage ? r->stage_name[k] : "end");
        const struct real_times mean = times_of(out, r->stage[0], row, (size_t)k, room);
        s->min_s = mean.min;
        s->median_s = mean.median;
        s->largest_s = times_of(out, r->stage[1], row, (size_t)k, room).median;
    }
    for (int i = 0; i < r->nrank; i++) {
        out->messages += facts_of(r, i)[FACT_MESSAGES];
        out->bytes += facts_of(r, i)[FACT_BYTES];
    }
}

/* "one computer, processors 0 1": where each rank was at the end. */
static void place(struct real *r)
{
    struct real_result *out = r->out;
    /* Processors as the system numbers them; those of a rank that moves are where it ended. */
    const bool one = host_comm_one_clock(r->comm);
    struct text t = {0};
    text_add(&t, "%s, processors", one ? "one computer" : "several computers");
    uint64_t set = 0;
    for (int i = 0; i < r->nrank; i++) {
        if (t.length < sizeof out->placement)
            text_add(&t, " %d", (int)facts_of(r, i)[FACT_PROCESSOR]);
        set |= (uint64_t)facts_of(r, i)[FACT_PROCESSORS];
    }
    text_copy(out->placement, sizeof out->placement, t.s);
    text_free(&t);
    out->processors = host_processors(set);
    out->oversubscribed = one && r->nrank > out->processors;
}

/* Processor time of the job so far: what the load of others is told from. */
static double own_seconds(const struct real *r)
{
    double sum = 0;
    for (int i = 0; i < r->nrank; i++) sum += (double)facts_of(r, i)[FACT_OWN_NS] * 1e-9;
    return sum;
}

/* The first time is not counted.
 *
 * Once to judge it and to warm up caches and memory, then for the clock. */
static bool measure(struct real *r, const struct real_order *order, struct arena *a, struct err *e)
{
    if (!repeat(r, true, e)) return false;
    note_digest(r, true);
    const double before = own_seconds(r);
    const struct host_load_begin load = host_load_start();
    if (!sample(r, order, a, e)) return false;
    if (!real_chief(r)) return true;
    r->out->load = host_load_read(&load, own_seconds(r) - before);
    summarise(r, a);
    place(r);
    return true;
}

/* What cannot run for real is refused by all processes alike, before anything is tried. */
static bool refuse(const struct run_spec *spec, int processes, struct err *e)
{
    if (spec->kernel.own && spec->program.kind != PROGRAM_KERNEL)
        return err_set(e, ERR_CONFIG,
                       "'%.60s' has main or is a schedule: a real run takes built-in programs and "
                       "kernels in one file; MPI programs run by their own mpicc and mpirun, which "
                       "mimdsim record times",
                       spec->kernel.name);
    if (spec->nrank != processes)
        return err_set(e, ERR_CONFIG, "a run of %d ranks on %d processes", spec->nrank, processes);
    return true;
}

bool run_real(const struct run_spec *spec, const struct hosts *hosts, struct host_comm *comm,
              const struct real_order *order, struct run_cache *cache, struct arena *a,
              struct real_result *out, struct err *e)
{
    const int processes = hosts != NULL ? hosts->size : 1;
    struct real r = {.spec = spec,
                     .own = *spec,
                     .hosts = hosts,
                     .comm = comm,
                     .cache = cache,
                     .out = out,
                     .nrank = processes};
    memset(out, 0, sizeof *out);
    out->nrank = processes;
    out->repeatable = true;
    /* Where and with what, also for a run that comes to nothing. */
    text_copy(out->backend, sizeof out->backend, "mpi");
    text_copy(out->library, sizeof out->library, hosts != NULL ? hosts->call->library : "none");
    host_name(out->host, (int)sizeof out->host);
    host_processor_name(out->processor, (int)sizeof out->processor);
    if (spec->refused) return err_set(e, (enum err_kind)spec->refused_kind, "%s", spec->refused);
    if (!refuse(spec, processes, e)) return false;
    r.facts = memory_zeroed((size_t)processes * FACTS, sizeof *r.facts);
    bool ok = real_simulate(&r, e);
    if (ok && out->status == RUN_OK) ok = measure(&r, order, a, e);
    real_forget(&r);
    free(r.facts);
    return ok;
}
