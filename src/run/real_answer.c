/* real_answer.c - the answer of a real run: the simulated one that it is compared with, its
 * gathering from all processes, its checks (real.h). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/digest.h"
#include "base/memory.h"
#include "base/text.h"
#include "hosts/hosts_copy.h"
#include "run/real_parts.h"

/* Of the job's own messages, apart from those of app/campaign_mpi.c and run.c. */
enum { TAG_VERDICT = 500, TAG_ANSWER };

bool real_chief(const struct real *r) { return r->hosts == NULL || r->hosts->rank == 0; }

/* --- the simulated run ------------------------------------------------------------------------ */

/* Copies: the simulated run is closed before the real one begins. */
static void keep_answers(struct real *r, const struct program_run *run)
{
    for (int i = 0; i < PROGRAM_OUTPUTS; i++) {
        struct kept_answer *k = &r->simulated[i];
        const double *x = program_answer(run, i, &k->n);
        if (x == NULL) continue;
        k->x = memory_take((size_t)k->n, sizeof *k->x);
        memcpy(k->x, x, (size_t)k->n * sizeof *x);
    }
}

/* The same program, the same settings, no network to speak of.
 *
 * At the cheapest level: what is wanted is the answer, which no level changes, and whether the
 * program comes to an end. */
static bool simulate(struct real *r, struct kernel_spec *settled, struct err *e)
{
    /* As run_sharing, but that the program stays open until its answer is copied. */
    struct arena *own = arena_create();
    struct run_cache *cache = run_cache_create();
    struct run_result *result = TAKE(own, 1, struct run_result);
    struct program_run run = {.spec = r->own};
    struct run_spec spec = r->own;
    spec.machine.network.level = LEVEL_LOGGP;
    bool ok =
        run_open(&spec, NULL, cache, own, &run, e) && run_attempts(&run, cache, own, result, e);
    if (ok && result->status == RUN_OK) {
        keep_answers(r, &run);
        for (int64_t k = 0; k < (int64_t)result->nrank * result->nstage; k++)
            work_add(&r->out->work, &result->stage[k].work);
        *settled = run.spec.kernel;
    } else if (ok) {
        r->out->status = result->status;
        snprintf(r->out->text, sizeof r->out->text, "simulated, so not run for real: %.900s",
                 result->text);
    }
    run_close(&run);
    run_cache_destroy(cache);
    arena_destroy(own);
    return ok;
}

/* The first process simulates; all learn whether to go on, and with which settings. */
bool real_simulate(struct real *r, struct err *e)
{
    struct {
        bool made;
        enum run_status status;
        struct kernel_spec kernel;
    } verdict = {.made = true, .kernel = r->own.kernel};
    if (real_chief(r)) {
        verdict.made = simulate(r, &verdict.kernel, e);
        verdict.status = r->out->status;
    }
    if (r->hosts != NULL && !hosts_tell(r->hosts, TAG_VERDICT, &verdict, sizeof verdict))
        return err_set(e, ERR_INTERNAL, "%s cannot reach all processes", r->hosts->call->library);
    r->out->status = verdict.status;
    r->own.kernel = verdict.kernel;
    return verdict.made;
}

/* --- the answer ------------------------------------------------------------------------------- */

/* Processes share no memory: blocks of bytes travel, of one build of this program.
 *
 * What one process published, as one block: count, then (output, first, n) and the numbers. */
static void pack(const struct host_comm *c, struct text *block)
{
    struct host_published p;
    for (int i = 0; host_comm_published(c, i, &p); i++) {
        text_add_bytes(block, (const char *)&p, offsetof(struct host_published, x));
        text_add_bytes(block, (const char *)p.x, (size_t)p.n * sizeof *p.x);
    }
}

/* The other way: each publication to where the program keeps it. What it refuses is its own
 * mistake, and the run has failed. */
static bool unpack(struct program_run *run, const struct text *block, struct run_result *res)
{
    for (size_t at = 0; at < block->length;) {
        struct host_published p = {0};
        char why[200] = "";
        memcpy(&p, block->s + at, offsetof(struct host_published, x));
        at += offsetof(struct host_published, x);
        const size_t bytes = (size_t)p.n * sizeof *p.x;
        double *x = memory_take((size_t)p.n, sizeof *x);
        memcpy(x, block->s + at, bytes);
        at += bytes;
        const bool ok = program_take(run, (int)p.output, p.first, p.n, x, why, (int)sizeof why);
        free(x);
        if (ok) continue;
        res->status = RUN_FAILED;
        text_copy(res->text, sizeof res->text, why);
        return true;
    }
    return true;
}

/* Everything that was published into the first process's `run`. */
static bool gather_answer(struct real *r, struct program_run *run, struct run_result *res)
{
    struct text block = {0};
    int64_t bytes;
    bool ok = true;
    /* Size first, then the block: whoever receives makes room for it. */
    pack(r->comm, &block);
    if (!real_chief(r)) {
        bytes = (int64_t)block.length;
        ok = hosts_copy_out(r->hosts, 0, TAG_ANSWER, &bytes, sizeof bytes) &&
             hosts_copy_out(r->hosts, 0, TAG_ANSWER, block.s, block.length);
        text_free(&block);
        return ok;
    }
    ok = unpack(run, &block, res);
    for (int i = 1; ok && i < r->nrank; i++) {
        ok = hosts_copy_in(r->hosts, i, TAG_ANSWER, &bytes, sizeof bytes);
        block.length = 0;
        if (ok) text_reserve(&block, (size_t)bytes);
        ok = ok && hosts_copy_in(r->hosts, i, TAG_ANSWER, block.s, (size_t)bytes);
        block.length = ok ? (size_t)bytes : 0;
        ok = ok && unpack(run, &block, res);
    }
    text_free(&block);
    return ok;
}

/* Numbers that were published are all that an answer is.
 *
 * Bit by bit, and by how much; a fingerprint of it all. */
static void compare(struct real *r, const struct program_run *run)
{
    struct real_result *out = r->out;
    out->same_bits = true;
    out->answer = DIGEST_START;
    for (int i = 0; i < PROGRAM_OUTPUTS; i++) {
        const struct kept_answer *k = &r->simulated[i];
        int64_t n;
        const double *x = program_answer(run, i, &n);
        double largest = 0, worst = 0;
        /* What a built-in program does not ask for here is what its monitors saw in the simulation
         * (kernel.h, watch). */
        if (x == NULL && !r->spec->kernel.own) continue;
        if (x == NULL) n = 0;
        if (n != k->n) {
            out->same_bits = false;
            out->difference = INFINITY; /* kept as NULL: it is no number */
            continue;
        }
        /* As words: two zeros of different sign are not the same bits, two equal NaNs are. */
        for (int64_t j = 0; j < n; j++) {
            uint64_t bits[2];
            memcpy(&bits[0], &x[j], sizeof bits[0]);
            memcpy(&bits[1], &k->x[j], sizeof bits[1]);
            out->answer = digest_mix(out->answer, bits[0]);
            out->same_bits = out->same_bits && bits[0] == bits[1];
            worst = fmax(worst, fabs(x[j] - k->x[j]));
            largest = fmax(largest, fabs(k->x[j]));
        }
        if (worst > 0) worst = largest > 0 ? worst / largest : worst;
        out->difference = fmax(out->difference, worst);
    }
}

/* The program's own checks, as of a simulated run. */
static void check(struct real *r, struct program_run *run, struct arena *scratch,
                  struct run_result *res)
{
    struct real_result *out = r->out;
    if (res->status == RUN_OK && run->type->judge) run->type->judge(run, res);
    if ((res->status == RUN_OK || res->status == RUN_INVALID) && run->type->check)
        run->type->check(run, scratch, res);
    out->status = res->status;
    text_copy(out->text, sizeof out->text, res->status == RUN_OK ? "" : res->text);
    out->checks = res->nerror;
    out->worst_error = out->worst_tolerance = NAN;
    /* All passed checks tell little: the one that came nearest to failing is kept. */
    double nearest = -1;
    for (int i = 0; i < res->nerror; i++) {
        const struct error_check *c = &res->error[i];
        const double part = c->tolerance > 0 ? c->relative / c->tolerance : c->relative;
        if (part <= nearest) continue;
        nearest = part;
        out->worst_error = c->relative;
        out->worst_tolerance = c->tolerance;
    }
}

bool real_judge(struct real *r, struct program_run *run, struct arena *own, struct arena *scratch)
{
    /* A result as of a simulated run that went well: judges and checks look at nothing else. */
    struct run_result *res = TAKE(own, 1, struct run_result);
    res->residual = res->measured_s = NAN;
    res->nrank = r->nrank;
    if (!gather_answer(r, run, res)) return false;
    if (!real_chief(r)) return true;
    compare(r, run);
    check(r, run, scratch, res);
    return true;
}

/* The simulated answers are the only memory from the heap. */
void real_forget(struct real *r)
{
    for (int i = 0; i < PROGRAM_OUTPUTS; i++) free(r->simulated[i].x);
}
