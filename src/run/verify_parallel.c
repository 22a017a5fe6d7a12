/* verify_parallel.c - rows of the parallel kernels, run on virtual processors with several numbers of ranks. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "dynamics/planar.h"
#include "kernel/kernel.h"
#include "run/launch.h"
#include "run/omission.h"
#include "run/verify_rows.h"

/* One way to run a kernel; what is not named is zero: paper, pcr-symmetric, structured operators, block partition. */
struct variant {
    const char *name;
    struct kernel_spec kernel;
};

static const struct variant variant_table[] = {
    {"parallel inverse incoming", {.name = "inverse", .composites_incoming = true}},
    {"parallel inverse outgoing", {.name = "inverse"}},
    {"parallel inverse dense operators",
     {.name = "inverse", .composites_incoming = true, .operators = OPERATORS_DENSE}},
    {"parallel inverse balanced", {.name = "inverse", .composites_incoming = true, .partition = PARTITION_BALANCED}},
#define FORWARD(text, ...) {"parallel forward " text, {.name = "forward", .composites_incoming = true, __VA_ARGS__}}
#define BOTH(text, ...)                                                                                                \
    FORWARD("paper " text, .formulation = FORMULATION_PAPER, __VA_ARGS__),                                             \
        FORWARD("direct " text, .formulation = FORMULATION_DIRECT, __VA_ARGS__),                                       \
        FORWARD("refined " text, .formulation = FORMULATION_DIRECT, .inner_refinements = 1, __VA_ARGS__),              \
        FORWARD("robust " text, .formulation = FORMULATION_DIRECT, .inner_refinements = 1, .outer_refinements = 1,     \
                __VA_ARGS__)
    BOTH("thomas", .solver = SOLVER_THOMAS),
    BOTH("cr", .solver = SOLVER_CR),
    BOTH("pcr", .solver = SOLVER_PCR),
    BOTH("pcr-symmetric", .solver = SOLVER_PCR_SYMMETRIC),
    BOTH("cr-pcr", .solver = SOLVER_CR_PCR, .hybrid_levels = 1),
    BOTH("partition+pcr", .solver = SOLVER_PARTITION, .part_solver = PART_PCR),
    BOTH("partition+cr", .solver = SOLVER_PARTITION, .part_solver = PART_CR),
    FORWARD("direct dense operators", .formulation = FORMULATION_DIRECT, .solver = SOLVER_PCR_SYMMETRIC,
            .operators = OPERATORS_DENSE),
    FORWARD("direct balanced", .formulation = FORMULATION_DIRECT, .solver = SOLVER_PARTITION, .part_solver = PART_CR,
            .partition = PARTITION_BALANCED),
    {"parallel inverse planar", {.name = "inverse", .composites_incoming = true, .algebra = ALGEBRA_PLANAR}},
    FORWARD("paper planar", .formulation = FORMULATION_PAPER, .algebra = ALGEBRA_PLANAR),
    FORWARD("direct planar", .formulation = FORMULATION_DIRECT, .algebra = ALGEBRA_PLANAR),
};
enum { VARIANTS = sizeof variant_table / sizeof *variant_table, MAX_RANKS = 5 };

/* P = 1, 2, 3, n/2, n without repetition; of large cases 3 and n. */
static int ranks_choose(const struct verify_options *o, int n, int rank[MAX_RANKS])
{
    enum { LARGE = 200 };
    const int all[MAX_RANKS] = {1, 2, 3, n / 2, n}, few[2] = {3, n};
    bool large = n > LARGE && !o->all_ranks;
    int count = 0;
    for (int i = 0; i < (large ? 2 : MAX_RANKS); i++) {
        int p = large ? few[i] : all[i];
        if (p >= 1 && p <= n && (count == 0 || p > rank[count - 1])) rank[count++] = p;
    }
    return count;
}

/* What one run gave. */
struct outcome {
    enum { ANSWERED, REFUSED, BROKEN } kind;
    double *x, *lambda;  /* tau or qdd, loop forces */
    int loop_rank;
    double condition;    /* a lower bound, of the block-scaled system */
    char text[96];       /* refused, broken: why */
};

static bool job_make(struct verify_case *v, const struct kernel_type *kernel, const struct run_spec *spec, bool lumped,
                     struct kernel_job *job, struct err *e)
{
    const struct model *m = lumped ? v->lumped : v->model;
    *job = (struct kernel_job){.spec = spec, .model = m, .state = lumped ? v->lumped_state : v->state,
                               .nrank = spec->nrank};
    job_want(job, OUTPUT_RESIDUAL, spec->nrank, v->arena);
    job_want(job, OUTPUT_CONDITION, spec->nrank, v->arena);
    job_want(job, OUTPUT_LOOP_RANK, 1, v->arena);
    job->omit = omission_job(spec, m, job->state);
    if (kernel->does_inverse) job_want(job, OUTPUT_TAU, m->nu, v->arena);
    if (kernel->does_forward) job_want(job, OUTPUT_QDD, m->nu, v->arena);
    if (m->nrow > 0) job_want(job, OUTPUT_LAMBDA, m->nrow, v->arena);
    return kernel->accepts(spec, m, e) && kernel->prepare(job, v->arena, e);
}

/* Answers do not depend on the machine; this one is simple, and as large as it must be. */
static struct machine_spec machine_make(const struct verify_options *o, int nrank)
{
    struct machine_spec crossbar = {
        .name = "crossbar",
        .topology = {.family = TOPOLOGY_CROSSBAR, .ndim = 1, .dims = {nrank}, .nodes_per_router = 1,
                     .processors_per_node = 1},
        .node = {.flop_rate = 1e9, .clock = 1e9, .copy_bandwidth = 1e9},
        .network = {.level = LEVEL_LOGGP, .link_bandwidth = 1e9, .hop_latency = 1e-7, .end_latency = 1e-7,
                    .virtual_channels = 1},
        .software = {.send_overhead = 1e-6, .recv_overhead = 1e-6, .eager_bytes = -1},
    };
    return o->machine ? *o->machine : crossbar;
}

/* Run a kernel on nrank virtual processors. */
static bool kernel_run(struct verify_case *v, const struct kernel_spec *kernel_spec, int nrank, struct outcome *out,
                       struct err *e)
{
    const struct kernel_type *kernel = kernel_spec->algebra == ALGEBRA_PLANAR
                                           ? kernel_find_planar(kernel_spec->name, kernel_spec->precision)
                                           : kernel_find_precision(kernel_spec->name, kernel_spec->precision);
    struct run_spec *spec = TAKE(v->arena, 1, struct run_spec);
    struct run_result *result = TAKE(v->arena, 1, struct run_result);
    struct kernel_job job;
    struct err refused;
    err_clear(&refused);
    *out = (struct outcome){.kind = REFUSED};
    *spec = (struct run_spec){.machine = machine_make(v->options, nrank), .kernel = *kernel_spec, .nrank = nrank};
    if (!kernel) err_set(&refused, ERR_CONFIG, "there is no such kernel");
    if (!kernel || !job_make(v, kernel, spec, kernel->does_forward, &job, &refused)) {
        text_copy(out->text, sizeof out->text, refused.text);
        return true;
    }
    if (!launch_job(kernel, &job, &spec->machine, &spec->record, 0, launch_largest_message(kernel, &job), v->arena,
                    v->arena, result, e))
        return false;
    *out = (struct outcome){.kind = result->status == RUN_OK ? ANSWERED : BROKEN,
                            .x = job_output(&job, kernel->does_forward ? OUTPUT_QDD : OUTPUT_TAU),
                            .lambda = job_output(&job, OUTPUT_LAMBDA),
                            .loop_rank = (int)*job_output(&job, OUTPUT_LOOP_RANK)};
    for (int i = 0; i < nrank; i++) out->condition = fmax(out->condition, job_output(&job, OUTPUT_CONDITION)[i]);
    text_copy(out->text, sizeof out->text, result->text);
    return true;
}

/* The errors of a variant over all numbers of ranks. */
struct spread {
    double error, lambda_error, condition;
    int worst, lambda_worst, rank_deficiency;
    bool answered;
    char ranks[32], text[128];
};

static void spread_add(struct spread *s, const struct verify_case *v, const struct outcome *x, int nrank, bool inverse)
{
    const struct vector_case *c = v->vector;
    bool good = x->kind == ANSWERED;
    double error = good ? verify_error(x->x, inverse ? c->tau_id : c->qdd_fd, c->nv) : INFINITY;
    size_t used = strlen(s->ranks);
    snprintf(s->ranks + used, sizeof s->ranks - used, "%s%d", used ? "," : "", nrank);
    if (!good) text_copy(s->text, sizeof s->text, x->text);
    if (!s->answered || error > s->error) {
        s->error = error;
        s->worst = nrank;
    }
    s->answered = true;
    if (good) s->condition = fmax(s->condition, x->condition);
    if (!inverse && c->lambda && good) {
        double lambda_error = verify_error(x->lambda, c->lambda, c->nrow);
        if (s->lambda_worst == 0 || lambda_error > s->lambda_error) {
            s->lambda_error = lambda_error;
            s->lambda_worst = nrank;
        }
        if (x->loop_rank > 0 && x->loop_rank < c->nrow) s->rank_deficiency = c->nrow - x->loop_rank;
    }
}

static bool variant_run(struct verify_case *v, const struct kernel_spec *kernel, struct spread *s, struct err *e)
{
    bool inverse = strcmp(kernel->name, "inverse") == 0;
    int rank[MAX_RANKS], n = ranks_choose(v->options, inverse ? v->model->nbody : v->lumped->nbody, rank);
    *s = (struct spread){0};
    for (int i = 0; i < n; i++) {
        struct outcome x;
        struct arena_mark mark = arena_mark(v->arena);
        if (!kernel_run(v, kernel, rank[i], &x, e)) return false;
        if (x.kind == REFUSED)
            text_copy(s->text, sizeof s->text, x.text);
        else
            spread_add(s, v, &x, rank[i], inverse);
        arena_release(v->arena, mark);
    }
    return true;
}

/* The errors of the variant's accelerations and loop forces in another precision, with the ranks that were worst. */
static bool error_in(struct verify_case *v, const struct kernel_spec *kernel, enum precision precision, int nrank,
                     double *error, double *lambda_error, struct err *e)
{
    const struct vector_case *c = v->vector;
    struct kernel_spec again = *kernel;
    struct arena_mark mark = arena_mark(v->arena);
    struct outcome x;
    again.precision = precision;
    if (!kernel_run(v, &again, nrank, &x, e)) return false;
    *error = *lambda_error = INFINITY;
    if (x.kind == ANSWERED) *error = verify_error(x.x, c->qdd_fd, c->nv);
    if (x.kind == ANSWERED && c->lambda) *lambda_error = verify_error(x.lambda, c->lambda, c->nrow);
    arena_release(v->arena, mark);
    return true;
}

/* Above the tolerance: by rounding, if the kernel itself finds the system singular to its precision, or if the error
 * goes away in quad precision, or, of large cases, for which that takes long, if it is in proportion to the error in
 * single precision. */
static bool explain(struct verify_case *v, const struct kernel_spec *kernel, double condition, struct verify_row *row,
                    struct err *e)
{
    enum { QUAD_LIMIT = 310 };
    bool quad = v->vector->nv <= QUAD_LIMIT;
    double error, ignored;
    char before[64];
    if (condition * dynamics_type_of(kernel->precision)->epsilon >= 1) {
        row->verdict = VERIFY_ROUNDING;
        snprintf(row->note, sizeof row->note, "P=%d; its condition is above %.0e", row->worst_rank, condition);
        return true;
    }
    if (!error_in(v, kernel, quad ? PRECISION_QUAD : PRECISION_FLOAT, row->worst_rank, &error,
                  &ignored, e))
        return false;
    if (quad ? verify_error_vanishes(row->error, error) : verify_error_scales(row->error, error))
        row->verdict = VERIFY_ROUNDING;
    text_copy(before, sizeof before, row->note);
    snprintf(row->note, sizeof row->note, "P=%d%s%s%s; in %s precision %.1e", row->worst_rank,
             isfinite(row->error) ? "" : " breaks down", before[0] ? ": " : "", before, quad ? "quad" : "single",
             error);
    return true;
}

/* Loop forces are no better than the accelerations: `rounded` tells that rounding explains those. */
static bool lambda_row(struct verify_case *v, const char *name, const struct kernel_spec *kernel,
                       const struct spread *s, bool rounded, struct err *e)
{
    struct verify_row *row = verify_row_add(v, name, "lambda");
    row->parallel = true;
    row->error = s->lambda_error;
    row->tolerance = verify_tolerance_forward(v);
    row->worst_rank = s->lambda_worst;
    text_copy(row->ranks, sizeof row->ranks, s->ranks);
    if (s->lambda_error <= row->tolerance) return true;
    double ignored, quad;
    if (!error_in(v, kernel, PRECISION_QUAD, s->lambda_worst, &ignored, &quad, e)) return false;
    row->verdict = rounded || verify_error_vanishes(row->error, quad) ? VERIFY_ROUNDING : VERIFY_FAIL;
    snprintf(row->note, sizeof row->note, "P=%d; in quad precision %.1e", row->worst_rank, quad);
    return true;
}

static bool variant_row(struct verify_case *v, const struct variant *variant, struct err *e)
{
    struct kernel_spec kernel = variant->kernel;
    bool inverse = strcmp(kernel.name, "inverse") == 0;
    const char *quantity = inverse ? "tau_id" : "qdd_fd";
    struct spread s;
    kernel.precision = v->options->precision;
    if (!variant_run(v, &kernel, &s, e)) return false;
    if (!s.answered) {
        verify_row_skip(v, variant->name, quantity, s.text);
        v->report->row[v->report->nrow - 1].parallel = true;
        return true;
    }
    struct verify_row *row = verify_row_add(v, variant->name, quantity);
    row->parallel = true;
    row->error = s.error;
    row->worst_rank = s.worst;
    row->tolerance = inverse ? verify_tolerance_inverse(v) : verify_tolerance_forward(v);
    row->verdict = s.error <= row->tolerance ? VERIFY_PASS : VERIFY_FAIL;
    text_copy(row->ranks, sizeof row->ranks, s.ranks);
    text_copy(row->note, sizeof row->note, s.text);
    if (row->verdict == VERIFY_FAIL && !inverse && !explain(v, &kernel, s.condition, row, e)) return false;
    if (inverse || !v->vector->lambda || s.rank_deficiency > 0) return true;
    return lambda_row(v, variant->name, &kernel, &s, row->verdict == VERIFY_ROUNDING, e);
}

/* Whether three components describe the case, to the rounding of its numbers. */
static bool in_plane(const struct verify_case *v)
{
    struct err why;
    err_clear(&why);
    return planar_scene(v->model, v->state, PRECISION_DOUBLE, &why);
}

bool verify_parallel(struct verify_case *v, struct err *e)
{
    const bool planar = in_plane(v);
    char unfit[96];
    bool has_unfit = verify_unfit_body(v->lumped, unfit, sizeof unfit);
    for (int i = 0; i < VARIANTS; i++) {
        const struct variant *variant = &variant_table[i];
        bool inverse = strcmp(variant->kernel.name, "inverse") == 0;
        if (!(inverse ? v->vector->tau_id : v->vector->qdd_fd)) continue;
        if (variant->kernel.algebra == ALGEBRA_PLANAR && !planar) continue;
        if (!inverse && has_unfit)
            verify_row_skip(v, variant->name, "qdd_fd", unfit);
        else if (!variant_row(v, variant, e))
            return false;
    }
    return true;
}
