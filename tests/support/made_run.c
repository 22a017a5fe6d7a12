/* made_run.c - hand-made specs and results for the tests of store and report. */
#include "made_run.h"

#include <math.h>
#include <string.h>

#include "base/digest.h"
#include "base/random.h"
#include "base/text.h"
#include "spec/field.h"
#include "spec/identity.h"

void made_identity(struct run_spec *spec, struct arena *a) { run_identify(spec, a); }

struct run_spec made_spec(struct arena *a, const char *machine, int n, int nrank, int rep)
{
    struct run_spec spec;
    run_spec_defaults(&spec, a);
    text_copy(spec.scenario, sizeof spec.scenario, "made");
    text_copy(spec.machine.name, sizeof spec.machine.name, machine);
    text_copy(spec.kernel.name, sizeof spec.kernel.name, "dynamics");
    spec.machine.network.level = LEVEL_LINK;
    spec.model.nbody = n;
    spec.nrank = nrank;
    spec.rep = rep;
    made_identity(&spec, a);
    return spec;
}

/* One rank's stages: random parts, the last stage waits up to the makespan. */
static void fill_rank(struct run_result *r, int rank, struct random *random)
{
    static const double weight[] = {0.10, 0.18, 0.12, 0.12, 0.12, 0.24, 0.12};
    int64_t left = r->makespan_ps;
    for (int i = 0; i < r->nstage; i++) {
        struct stage_time *t = &r->stage[(int64_t)rank * r->nstage + i];
        double total = weight[i] * (double)r->makespan_ps;
        t->compute_ps = (int64_t)(total * random_uniform(random, 0.3, 0.5));
        t->send_ps = (int64_t)(total * 0.1);
        t->recv_ps = (int64_t)(total * 0.1);
        t->wait_ps = (int64_t)(total * 0.2);
        t->contention_ps = r->nrank > 32 ? (int64_t)(total * 0.05) : 0;
        t->messages = i > 0 ? 3 : 0;
        t->bytes = 288 * t->messages;
        t->work.flop = (uint64_t)(1000 * (i + 1));
        t->work.call = 10;
        left -= t->compute_ps + t->send_ps + t->recv_ps + t->wait_ps + t->contention_ps;
    }
    r->stage[(int64_t)(rank + 1) * r->nstage - 1].wait_ps += left;
}

static void add_baseline(struct run_result *r, const char *name, double seconds)
{
    struct baseline *b = &r->baseline[r->nbaseline++];
    text_copy(b->name, sizeof b->name, name);
    b->time_ps = (int64_t)(seconds * 1e12);
    b->work.flop = (uint64_t)(seconds * 6e7);
}

struct run_result made_result(struct arena *a, const struct run_spec *spec)
{
    static const char *const stage[] = {"Pre-processing", "NE[1]",  "NE[2]", "NE[3]",
                                        "CFA[1]",         "CFA[2]", "CFA[3]"};
    double n = spec->model.nbody, p = spec->nrank;
    struct run_result r = {.status = RUN_OK, .nbody = spec->model.nbody, .nu = spec->model.nbody};
    bool contended = spec->machine.network.level != LEVEL_LOGGP;
    r.makespan_ps =
        (int64_t)(1e12 * (80e-6 * n / p + 115e-6 * log2(p + 1) + (contended ? 2e-9 * p * p : 0)));
    r.nrank = spec->nrank;
    r.nstage = 7;
    for (int i = 0; i < 7; i++) text_copy(r.stage_name[i], sizeof r.stage_name[i], stage[i]);
    r.stage = TAKE(a, (int64_t)r.nrank * r.nstage, struct stage_time);
    r.finish_ps = TAKE(a, r.nrank, int64_t);
    struct random random = random_make(7, (uint64_t)n, (uint64_t)p);
    for (int k = 0; k < r.nrank; k++) {
        fill_rank(&r, k, &random);
        r.finish_ps[k] = r.makespan_ps - k;
        r.messages += 18;
        r.bytes += 18 * 288;
    }
    add_baseline(&r, "rnea + aba", n * 22e-6);
    add_baseline(&r, "rnea + crba", n * 14e-6 + n * n * 0.7e-6 + n * n * n * 0.01e-6);
    add_baseline(&r, "serial cfa", n * 50e-6);
    add_baseline(&r, "same code, one processor", n * 80e-6 + n * log2(n + 1) * 29e-6);
    r.nerror = 2;
    r.error[0] = (struct error_check){"tau", "rnea", 3e-15, 1e-11};
    r.error[1] = (struct error_check){"qdd", "aba", 2e-13, 1e-9};
    r.events = r.messages * 2;
    r.digest = digest_mix(DIGEST_START, (uint64_t)r.makespan_ps);
    r.host_s = 0.001;
    r.host_total_s = 0.002;
    r.host_peak_bytes = 1 << 20;
    r.stack_peak_bytes = 4096;
    return r;
}

void made_spans(struct run_result *r, struct arena *a)
{
    r->span = TAKE(a, (int64_t)r->nrank * r->nstage * 4, struct span);
    for (int k = 0; k < r->nrank; k++) {
        int64_t now = 0;
        for (int i = 0; i < r->nstage; i++) {
            int64_t length = r->makespan_ps / r->nstage;
            const int64_t end[] = {length / 2 + 1000 * k, length / 2 + 1000 * k + length / 10,
                                   length * 9 / 10, length};
            const enum span_kind kind[] = {SPAN_COMPUTE, SPAN_SEND, SPAN_WAIT, SPAN_RECV};
            int64_t begin = now;
            for (int j = 0; j < 4; j++) {
                bool sends = kind[j] == SPAN_SEND, receives = kind[j] == SPAN_RECV;
                int64_t pair = (int64_t)i * r->nrank;
                r->span[r->nspan++] = (struct span){
                    .rank = k, .stage = i, .kind = kind[j], .begin_ps = begin,
                    .end_ps = now + end[j],
                    .peer = kind[j] == SPAN_COMPUTE ? -1 : k ^ 1,
                    .bytes = sends || receives ? 288 : 0,
                    .message = sends ? pair + k : receives ? pair + (k ^ 1) : -1};
                begin = now + end[j];
            }
            now += length;
        }
    }
}
