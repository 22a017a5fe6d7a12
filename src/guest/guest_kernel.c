/* guest_kernel.c - a program that declares itself by mimdsim/program.h, as a program of runs.
 *
 * Its results are those that its ranks publish. They are compared with what its first serial code
 * publishes, by its own check, or by both. Serial codes run on one processor of the same machine,
 * and their computing is counted as the ranks' is; so does the parallel code on one processor.
 *
 * A declared program is data in the image, so it can be read without running any of its
 * code: the reader's copy of the image is for that, and the ranks' copies are made by the
 * run. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"
#include "guest/guest_program.h"
#include "guest/guest_world.h"
#include "guest/serial_answers.h"

/* program_run.own */
struct guest_run {
    struct loader_template *reader; /* owned: a copy to read from, in which only estimate runs */
    struct loader_instance *copy;
    const struct mimdsim_program *declared; /* in that copy */
    enum program_cost cost;
    struct rank_program rank;
    struct guest_world ranks; /* of the run */
    struct guest_world *job;  /* = &ranks: what the ranks are given */
    struct guest_results results;
    struct text said;
};

static const char *const one_stage[] = {"program"};

/* The program's own memory is its image's and comm_memory's. */
static size_t workspace_bytes(const void *job, int rank)
{
    (void)job, (void)rank;
    return sizeof(struct guest_rank);
}

/* --- open, close ------------------------------------------------------------------------------ */

/* Only one copy is reserved. Its variables get the run's parameters, so that estimate
 * sees them. */
static bool read_declaration(struct guest_run *g, const struct run_spec *spec, struct arena *a,
                             struct err *e)
{
    static const struct loader_hooks none;
    g->reader = loader_open(spec->program.image, e);
    if (g->reader == NULL || !loader_reserve(g->reader, 1, &none, e)) return false;
    g->copy = loader_instantiate(g->reader, 0, NULL, e);
    if (g->copy == NULL) return false;
    g->declared = guest_declared(g->copy, a);
    /* The file may have changed since its sheet was read. */
    if (g->declared == NULL)
        return err_set(e, ERR_DATA, "%s declares no program any more", spec->program.file);
    guest_parameters_set(g->declared, spec->program.parameters, a);
    return true;
}

/* The run's setting goes before the program's wish; counted blocks are the default. */
static enum program_cost cost_of(const struct guest_run *g, const struct program_run *r)
{
    if (r->order.real) return PROGRAM_COST_REAL;
    if (r->spec.program.cost != PROGRAM_COST_DECLARED) return r->spec.program.cost;
    return g->declared->cost == MIMDSIM_COST_AUTHOR ? PROGRAM_COST_AUTHOR : PROGRAM_COST_BLOCKS;
}

/* A program without stages has one. Matching in simulated time costs events, so a program
 * says if it uses wildcards, tests or probes (.wildcards). */
static void make_rank(struct guest_run *g)
{
    const struct mimdsim_program *p = g->declared;
    int n = 0;
    while (n < MIMDSIM_STAGES && p->stage[n] != NULL) n++;
    g->rank = (struct rank_program){
        .nstage = n > 0 ? n : 1,
        .stage_name = n > 0 ? p->stage : one_stage,
        .workspace_bytes = workspace_bytes,
        .run = guest_rank_run,
        .foreign = true,
        .timed = p->wildcards != 0,
        .stack_bytes = p->stack_bytes > 0 ? p->stack_bytes : GUEST_STACK_BYTES,
    };
}

/* Set first, so that close finds what was made when this fails half-way. */
static bool kernel_open(struct program_run *r, struct err *e)
{
    struct guest_run *g = TAKE(r->arena, 1, struct guest_run);
    r->own = g;
    if (r->spec.program.image == NULL)
        return err_set(e, ERR_CONFIG, "program '%s' of a stored run is not at hand",
                       r->spec.kernel.name);
    if (!read_declaration(g, &r->spec, r->arena, e)) return false;
    g->cost = cost_of(g, r);
    make_rank(g);
    r->rank = &g->rank;
    return true;
}

static void kernel_close(struct program_run *r)
{
    struct guest_run *g = r->own;
    if (g == NULL) return;
    guest_world_close(&g->ranks);
    guest_results_clear(&g->results);
    text_free(&g->said);
    loader_close(g->reader);
}

/* The ranks' world is on the run's arena and refers to the run, which outlives it. */
static bool kernel_prepare(struct program_run *r, struct arena *scratch, struct err *e)
{
    struct guest_run *g = r->own;
    memset(r->output, 0, sizeof r->output);
    g->ranks = (struct guest_world){.spec = &r->spec,
                                    .part = GUEST_RUN,
                                    .cost = g->cost,
                                    .calls = &guest_calls,
                                    .memory = scratch,
                                    .results = &g->results,
                                    .output = r->order.output,
                                    .host_limit = r->order.host_limit,
                                    .stack_bytes = g->rank.stack_bytes,
                                    .said = &g->said};
    r->said = &g->said;
    g->job = &g->ranks;
    r->job = &g->job;
    return guest_world_open(&g->ranks, &r->spec.machine.node, r->spec.nrank, e);
}

/* --- is the answer right? --------------------------------------------------------------------- */

/* A part that did not end has no answer to compare with. */
static void lose(struct run_result *out, const char *what, const char *why)
{
    if (out->status == RUN_OK) snprintf(out->text, sizeof out->text, "%.60s: %.1900s", what, why);
    out->status = RUN_INVALID;
}

/* Every element up to the last must come from some rank; NaN in its place would only say
 * that something is wrong. */
static void check_gaps(const struct guest_run *g, struct run_result *out)
{
    for (int i = 0; i < MIMDSIM_OUTPUTS && g->declared->output[i] != NULL; i++) {
        const int64_t gap = guest_results_gap(&g->results.of[i]);
        char text[120];
        snprintf(text, sizeof text, "no rank published its element %lld", (long long)gap);
        if (gap >= 0) lose(out, g->declared->output[i], text);
    }
}

static void compare(const struct guest_run *g, const char *reference,
                    const struct guest_results *with, struct run_result *out)
{
    for (int i = 0; i < MIMDSIM_OUTPUTS && g->declared->output[i] != NULL; i++) {
        /* Results are compared by name. The serial code may publish fewer, and not other
         * lengths. */
        const struct guest_result *x = &g->results.of[i], *y = &with->of[i];
        if (y->n == 0) continue; /* the serial code does not know it */
        char text[160];
        snprintf(text, sizeof text, "the ranks published %lld numbers, '%s' %lld", (long long)x->n,
                 reference, (long long)y->n);
        if (x->n != y->n) lose(out, g->declared->output[i], text);
        program_check_add(out, g->declared->output[i], reference, guest_results_difference(x, y),
                          g->declared->tolerance);
    }
}

/* The check is the program's code on one processor, in a world of its own that may look
 * at the results. Its time counts nowhere. */
static void run_check(struct program_run *r, struct run_result *out)
{
    struct guest_run *g = r->own;
    struct arena *memory = arena_create();
    struct run_result *end = TAKE(memory, 1, struct run_result);
    struct guest_results none = {0};
    struct guest_world w = {.spec = &r->spec,
                            .cost = g->cost,
                            .calls = &guest_calls,
                            .memory = memory,
                            .results = &none,
                            .seen = &g->results,
                            .check = out,
                            .host_limit = r->order.host_limit,
                            .tolerance = g->declared->tolerance};
    struct err e;
    err_clear(&e);
    if (!guest_alone(&w, GUEST_CHECK, g->rank.stack_bytes, memory, end, &e))
        lose(out, "check", e.text);
    else if (end->status != RUN_OK) lose(out, "check", end->text);
    guest_results_clear(&none);
    arena_destroy(memory);
}

/* First whether there is a whole answer, then whether it is that of the serial code, then
 * what the program says itself. */
static void kernel_check(struct program_run *r, struct arena *scratch, struct run_result *out)
{
    struct guest_run *g = r->own;
    const struct mimdsim_serial *first = &g->declared->serial[0];
    char why[1024] = "";
    (void)scratch;
    check_gaps(g, out);
    if (first->run != NULL) {
        const struct serial_answer *a =
            serial_answer(r, GUEST_SERIAL, g->cost, g->rank.stack_bytes, why, (int)sizeof why);
        if (a != NULL) compare(g, first->name, &a->results, out);
        else lose(out, first->name, why);
    }
    if (g->declared->check != NULL) run_check(r, out);
}

/* --- what the speedup is measured against ----------------------------------------------------- */

static void add_baseline(struct program_run *r, int part, const char *name, struct run_result *out)
{
    struct guest_run *g = r->own;
    char why[1024];
    const struct serial_answer *a =
        serial_answer(r, part, g->cost, g->rank.stack_bytes, why, (int)sizeof why);
    if (a == NULL)
        return; /* the first one's failure has been told; a parallel code may need more ranks */
    /* Time and counted work of one processor: what the speedup divides by. */
    struct baseline *b = &out->baseline[out->nbaseline++];
    text_copy(b->name, sizeof b->name, name);
    b->time_ps = a->time_ps;
    b->work = a->work;
}

static void kernel_baselines(struct program_run *r, const struct work_price *price,
                             struct arena *scratch, struct run_result *out)
{
    struct guest_run *g = r->own;
    int n = 0;
    (void)price, (void)scratch;
    for (; n < MIMDSIM_SERIALS && g->declared->serial[n].run != NULL; n++)
        add_baseline(r, GUEST_SERIAL + n, g->declared->serial[n].name, out);
    /* Speedup is against the fastest serial code, not against the first. */
    program_fastest_add(out, 0);
    /* Without a serial code the parallel one on one processor is all there is. */
    if (n == 0 || r->spec.record.baselines == BASELINES_ALL)
        add_baseline(r, GUEST_RUN, "parallel code on one processor", out);
}

static void kernel_estimate(const struct program_run *r, struct program_estimate *out)
{
    const struct guest_run *g = r->own;
    /* What the program leaves alone stays unknown. */
    struct mimdsim_estimate e = {NAN, NAN, NAN, NAN};
    if (g->declared->estimate != NULL) {
        const int64_t argument[4] = {r->spec.nrank, (int64_t)(intptr_t)&e};
        loader_start(g->copy, 0, NULL);
        loader_call(g->copy, (void *)g->declared->estimate, argument);
    }
    *out = (struct program_estimate){.messages = e.messages,
                                     .bytes = e.bytes,
                                     .flops = e.flops,
                                     .rank_bytes = e.rank_bytes};
}

/* The whole result as it stands; none where nobody published anything. */
static const double *kernel_answer(const struct program_run *r, int output, int64_t *n)
{
    const struct guest_run *g = r->own;
    *n = output < MIMDSIM_OUTPUTS ? g->results.of[output].n : 0;
    return *n > 0 ? g->results.of[output].x : NULL;
}

/* As if a rank of this process had published it, with the same refusals. */
static bool kernel_take(struct program_run *r, int output, int64_t first, int64_t n,
                        const double *data, char *why, int size)
{
    struct guest_run *g = r->own;
    return guest_results_put(&g->results, output, first, n, data, why, size);
}

static const struct program_type kernel_type = {
    .name = "program",
    .title = "a program of your own",
    .cache_create = serial_answers_create,
    .cache_destroy = serial_answers_destroy,
    .open = kernel_open,
    .close = kernel_close,
    .prepare = kernel_prepare,
    .check = kernel_check,
    .baselines = kernel_baselines,
    .estimate = kernel_estimate,
    .answer = kernel_answer,
    .take = kernel_take,
};

const struct program_type *guest_program(enum program_kind kind)
{
    switch (kind) {
    case PROGRAM_KERNEL:
        return &kernel_type;
    case PROGRAM_MPI:
        return &guest_mpi_type;
    default:
        return NULL;
    }
}
