/* collective_times.c - see collective_times.h.
 *
 * The kernels are the benchmarks of docs/collectives.md, run by the path of real runs: their stage
 * "collective" is the call alone, without the barrier between repetitions. On few ranks several
 * algorithms send the same messages, so that a rule asks for a clear difference. */
#include "reality/collective_times.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "reality/fit.h"
#include "reality/predict.h"
#include "run/real.h"

/* REPEAT: calls of a run, as the scenario says. */
enum { REPEAT = 4, ELEMENT = 8, LEAST_GOOD = 3 };

/* What makes a rule: less than this part of the other's time. */
#define CLEARLY 0.9

static const char stage[] = "collective";

/* The benchmark of a barrier has a name of its own, since "barrier" is the machine's. */
static const char *kernel_of(enum collective_kind kind)
{
    return kind == COLLECTIVE_BARRIER ? "message-barrier" : collective_name(kind);
}

/* The call that the benchmark makes. */
static struct collective_shape shape_of(enum collective_kind kind, int nrank, int64_t bytes)
{
    const bool vector = kind == COLLECTIVE_BROADCAST || kind == COLLECTIVE_REDUCE ||
                        kind == COLLECTIVE_ALLREDUCE || kind == COLLECTIVE_SCAN;
    const int64_t count = kind == COLLECTIVE_BARRIER ? 0 : bytes / ELEMENT;
    return (struct collective_shape){.kind = kind,
                                     .size = nrank,
                                     .count = count,
                                     .total = vector ? count : count * nrank,
                                     .element = ELEMENT,
                                     .commutative = true};
}

/* --- measuring -------------------------------------------------------------------------------- */

/* Everything that one measurement needs. */
struct measuring {
    struct plan *plan;
    const struct hosts *hosts;
    struct host_comm *comm;
    const struct machine_spec *machine;
    struct real_order order;
    struct run_cache *cache;
    struct collective_times *out;
};

/* The stage's time of one call, mean over ranks, as the machine predicts it. */
static bool predict(struct measuring *m, const struct run_spec *spec, double *seconds,
                    struct err *e)
{
    struct run_spec there = *spec;
    struct arena *a = arena_create();
    struct run_result *r = TAKE(a, 1, struct run_result);
    there.machine = *m->machine;
    const bool ok = predict_simulate(&there, m->cache, a, r, e);
    *seconds = 0;
    for (int k = 0; ok && k < r->nstage; k++) {
        if (strcmp(r->stage_name[k], stage) != 0) continue;
        for (int i = 0; i < r->nrank; i++) {
            const struct stage_time *t = &r->stage[(size_t)i * (size_t)r->nstage + (size_t)k];
            *seconds +=
                1e-12 / r->nrank / REPEAT *
                (double)(t->compute_ps + t->send_ps + t->recv_ps + t->wait_ps + t->contention_ps);
        }
    }
    arena_destroy(a);
    return ok;
}

/* The same as measured; the first process alone knows. */
static double measured_stage(const struct real_result *r)
{
    for (int k = 0; k < r->nstage; k++)
        if (strcmp(r->stage[k].name, stage) == 0) return r->stage[k].median_s / REPEAT;
    return 0;
}

/* One algorithm at one size, on all processes. What the first one finds too disturbed is left out
 * and counted. */
static bool take(struct measuring *m, struct collective_sample s, struct err *e)
{
    char bytes[32];
    snprintf(bytes, sizeof bytes, "%lld B", (long long)s.bytes);
    const char *const key[] = {"kernel.name", "kernel.algorithm", "kernel.message"};
    const char *const text[] = {kernel_of(s.kind), s.algorithm->name, bytes};
    struct run_spec spec;
    const int settings = s.kind == COLLECTIVE_BARRIER ? 2 : 3;
    if (!plan_vary(m->plan, 0, settings, key, text, &spec, e)) return false;
    struct arena *a = arena_create();
    struct real_result *r = TAKE(a, 1, struct real_result);
    bool ok = run_real(&spec, m->hosts, m->comm, &m->order, m->cache, a, r, e);
    if (ok && r->status != RUN_OK)
        ok = err_set(e, ERR_CHECK, "%s by %s: %.600s", text[0], text[1], r->text);
    const bool disturbed = ok && r->nsample - r->disturbed < LEAST_GOOD;
    if (ok && m->machine != NULL && disturbed) m->out->left_out++;
    else if (ok && m->machine != NULL) {
        ok = predict(m, &spec, &s.predicted, e);
        s.measured = measured_stage(r);
        s.samples = r->nsample;
        s.disturbed = r->disturbed;
        m->out->sample[m->out->n++] = s;
    }
    arena_destroy(a);
    return ok;
}

/* All algorithms that can do the call of one kind at one size. */
static bool take_all(struct measuring *m, enum collective_kind kind, int64_t bytes, struct err *e)
{
    int n;
    const struct collective_algorithm *table = collective_algorithms(kind, &n);
    const struct collective_shape shape = shape_of(kind, m->out->nrank, bytes);
    for (int i = 0; i < n; i++) {
        const struct collective_sample s = {.kind = kind, .algorithm = &table[i], .bytes = bytes};
        if (!collective_applies(&table[i], &shape) || m->out->n == COLLECTIVE_TIMES_MOST) continue;
        if (!take(m, s, e)) return false;
    }
    return true;
}

bool collective_times_measure(struct plan *p, const struct hosts *hosts, struct host_comm *comm,
                              const struct machine_spec *machine, int samples, double seconds,
                              bool large, struct collective_times *out, struct err *e)
{
    static const int64_t size[] = {8, 1024, 65536, 1048576};
    const int nsize = large ? 4 : 3;
    struct measuring m = {p, hosts, comm, machine, {samples, seconds, 0}, run_cache_create(), out};
    bool ok = true;
    out->n = out->left_out = 0;
    out->nrank = hosts->size;
    for (int kind = 0; ok && kind < COLLECTIVE_KINDS; kind++)
        for (int i = 0; ok && i < (kind == COLLECTIVE_BARRIER ? 1 : nsize); i++)
            ok = take_all(&m, (enum collective_kind)kind, kind == COLLECTIVE_BARRIER ? 0 : size[i],
                          e);
    run_cache_destroy(m.cache);
    if (ok && machine != NULL) collective_times_judge(out);
    return ok;
}

/* --- rules ------------------------------------------------------------------------------------ */

/* Predicted against measured, of every sample. */
static void judge_residuals(struct collective_times *t)
{
    double off[COLLECTIVE_TIMES_MOST];
    for (int i = 0; i < t->n; i++)
        off[i] = fabs(t->sample[i].predicted / t->sample[i].measured - 1);
    fit_residuals(off, t->n, &t->median_residual, &t->residual);
}

/* Samples first .. end - 1 are one call by several algorithms: whether the fastest of them is
 * clearly faster than the one that the rules so far choose, and then a rule for it. */
static void judge_call(struct collective_times *t, int first, int end, struct collective_rule *rule,
                       int *nrule, struct text *text)
{
    const struct collective_sample *s = &t->sample[first], *best = s, *chosen = NULL;
    const struct collective_shape shape = shape_of(s->kind, t->nrank, s->bytes);
    const struct collective_algorithm *usual = collective_choose(&shape, rule, *nrule);
    for (int i = first; i < end; i++) {
        if (t->sample[i].measured < best->measured) best = &t->sample[i];
        if (t->sample[i].algorithm == usual) chosen = &t->sample[i];
    }
    if (chosen == NULL || best->measured >= CLEARLY * chosen->measured) return;
    /* Rules compare the bytes of all blocks for some of the collectives. */
    const int64_t from = collective_shape_bytes(&shape);
    rule[(*nrule)++] = (struct collective_rule){s->kind, best->algorithm, from, t->nrank};
    text_add(text, "%s%s %s", text->length > 0 ? "; " : "", collective_name(s->kind),
             best->algorithm->name);
    /* The smallest size that was tried stands for all below it. */
    if (s->bytes > ELEMENT) text_add(text, " from %lld B", (long long)from);
}

void collective_times_judge(struct collective_times *t)
{
    struct collective_rule rule[COLLECTIVE_TIMES_MOST];
    struct text text = {0};
    int nrule = 0;
    judge_residuals(t);
    for (int i = 0, end; i < t->n; i = end) {
        end = i + 1;
        while (end < t->n && t->sample[end].kind == t->sample[i].kind &&
               t->sample[end].bytes == t->sample[i].bytes)
            end++;
        judge_call(t, i, end, rule, &nrule, &text);
    }
    text_copy(t->rules, sizeof t->rules,
              text.s != NULL && text.length < sizeof t->rules ? text.s : "");
    text_free(&text);
}
