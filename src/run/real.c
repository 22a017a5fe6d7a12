/* real.c - one real run repeated, and what came of it (real.h). */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "host/host_load.h"
#include "run/real_parts.h"

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
        out->messages += real_facts(r, i)[FACT_MESSAGES];
        out->bytes += real_facts(r, i)[FACT_BYTES];
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
            text_add(&t, " %d", (int)real_facts(r, i)[FACT_PROCESSOR]);
        set |= (uint64_t)real_facts(r, i)[FACT_PROCESSORS];
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
    for (int i = 0; i < r->nrank; i++) sum += (double)real_facts(r, i)[FACT_OWN_NS] * 1e-9;
    return sum;
}

/* The first time is not counted.
 *
 * Once to judge it and to warm up caches and memory, then for the clock. */
static bool measure(struct real *r, const struct real_order *order, struct arena *a, struct err *e)
{
    if (!real_repeat(r, true, e)) return false;
    real_note_digest(r, true);
    const double before = own_seconds(r);
    const struct host_load_begin load = host_load_start();
    if (!real_sample(r, order, a, e)) return false;
    if (!real_chief(r)) return true;
    r->out->load = host_load_read(&load, own_seconds(r) - before);
    summarise(r, a);
    place(r);
    if (r->out->status == RUN_OK) real_bursts_text(r->out, r->out->text, sizeof r->out->text);
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
    r.memory = arena_create();
    bool ok = real_simulate(&r, e);
    if (ok && out->status == RUN_OK) ok = measure(&r, order, a, e);
    real_forget(&r);
    arena_destroy(r.memory);
    free(r.facts);
    return ok;
}
