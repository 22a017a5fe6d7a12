/* verify_parallel.c - rows of the parallel kernels, run on virtual processors with several
 * numbers of ranks.
 *
 * A row is a variant of a kernel; its error is the worst over the numbers of ranks, since an
 * error in the communication may show with one number of ranks only (odd, not a power of two,
 * one body per rank). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "dynamics/planar.h"
#include "kernel/dynamics_program.h"
#include "run/launch.h"
#include "study/trial.h"
#include "study/verify_rows.h"

/* One way to run a kernel; what is not named is zero: paper, pcr-symmetric, structured operators,
 * block partition. */
struct variant {
    const char *name;
    struct kernel_spec kernel;
};

/* Every solver with every formulation and refinement, then the operators, partitions and the
 * plane with one solver: a full product would repeat the same code. */
static const struct variant variant_table[] = {
    {"parallel inverse incoming", {.name = "inverse", .composites_incoming = true}},
    {"parallel inverse outgoing", {.name = "inverse"}},
    {"parallel inverse dense operators",
     {.name = "inverse", .composites_incoming = true, .operators = OPERATORS_DENSE}},
    {"parallel inverse balanced",
     {.name = "inverse", .composites_incoming = true, .partition = PARTITION_BALANCED}},
#define FORWARD(text, ...)                                                                         \
    {                                                                                              \
        "parallel forward " text, { .name = "forward", .composites_incoming = true, __VA_ARGS__ }  \
    }
#define BOTH(text, ...)                                                                            \
    FORWARD("paper " text, .formulation = FORMULATION_PAPER, __VA_ARGS__),                         \
        FORWARD("direct " text, .formulation = FORMULATION_DIRECT, __VA_ARGS__),                   \
        FORWARD("refined " text, .formulation = FORMULATION_DIRECT, .inner_refinements = 1,        \
                __VA_ARGS__),                                                                      \
        FORWARD("robust " text, .formulation = FORMULATION_DIRECT, .inner_refinements = 1,         \
                .outer_refinements = 1, __VA_ARGS__)
    BOTH("thomas", .solver = SOLVER_THOMAS),
    BOTH("cr", .solver = SOLVER_CR),
    BOTH("pcr", .solver = SOLVER_PCR),
    BOTH("pcr-symmetric", .solver = SOLVER_PCR_SYMMETRIC),
    BOTH("cr-pcr", .solver = SOLVER_CR_PCR, .hybrid_levels = 1),
    BOTH("partition+pcr", .solver = SOLVER_PARTITION, .part_solver = PART_PCR),
    BOTH("partition+cr", .solver = SOLVER_PARTITION, .part_solver = PART_CR),
    FORWARD("direct dense operators", .formulation = FORMULATION_DIRECT,
            .solver = SOLVER_PCR_SYMMETRIC, .operators = OPERATORS_DENSE),
    FORWARD("direct balanced", .formulation = FORMULATION_DIRECT, .solver = SOLVER_PARTITION,
            .part_solver = PART_CR, .partition = PARTITION_BALANCED),
    {"parallel inverse planar",
     {.name = "inverse", .composites_incoming = true, .algebra = ALGEBRA_PLANAR}},
    FORWARD("paper planar", .formulation = FORMULATION_PAPER, .algebra = ALGEBRA_PLANAR),
    FORWARD("direct planar", .formulation = FORMULATION_DIRECT, .algebra = ALGEBRA_PLANAR),
};
enum { VARIANTS = sizeof variant_table / sizeof *variant_table, MAX_RANKS = 5 };

/* P = 1, 2, 3, n/2, n without repetition, in rising order; of large cases 3 and n only, as each
 * run takes its time. */
static int ranks_choose(const struct verify_options *o, int n, int rank[MAX_RANKS])
{
    enum { LARGE = 200 };
    const int all[MAX_RANKS] = {1, 2, 3, n / 2, n}, few[2] = {3, n};
    bool large = n > LARGE && !o->all_ranks;
    /* rising numbers: a repetition is not larger than the one before */
    int count = 0;
    for (int i = 0; i < (large ? 2 : MAX_RANKS); i++) {
        int p = large ? few[i] : all[i];
        if (p >= 1 && p <= n && (count == 0 || p > rank[count - 1])) rank[count++] = p;
    }
    return count;
}

/* What one run gave: refused before it began, broken on the way, or an answer. */
struct outcome {
    enum { ANSWERED, REFUSED, BROKEN } kind;
    double *x, *lambda;  /* tau or qdd, loop forces */
    char text[96];       /* refused, broken: why */
};

/* Runs a kernel on nrank virtual processors; in space unless the plane is asked for. A refusal
 * and a break are outcomes; false with *e set only when the run cannot be made at all. */
static bool kernel_run(struct verify_case *v, const struct kernel_spec *kernel, int nrank,
                       struct outcome *out, struct err *e)
{
    struct program_run *r = TAKE(v->arena, 1, struct program_run);
    struct run_result *result = TAKE(v->arena, 1, struct run_result);
    struct run_spec spec = {.machine =
                                v->options->machine ? *v->options->machine : trial_machine(nrank),
                            .kernel = *kernel,
                            .nrank = nrank};
    /* Forward kernels need inertias with inverses: bodies on fixed joints are lumped for them. */
    const bool lumped = kernel_spec_has(kernel, PROGRAM_FORWARD);
    struct err refused;
    err_clear(&refused);
    if (spec.kernel.algebra == ALGEBRA_AUTO) spec.kernel.algebra = ALGEBRA_SPATIAL;
    *out = (struct outcome){.kind = REFUSED};
    if (!trial_open(r, &spec, lumped ? v->lumped : v->model, lumped ? v->lumped_state : v->state,
                    v->arena, &refused) ||
        !r->type->prepare(r, v->arena, &refused)) {
        text_copy(out->text, sizeof out->text, refused.text);
        return true;
    }
    /* The machine that the user named, or the crossbar: answers must not depend on it. */
    if (!launch_run(r, &spec.machine, &spec.record, 0, launch_largest_message(r), NULL, v->arena,
                    NULL, v->arena, result, e))
        return false;
    *out = (struct outcome){.kind = result->status == RUN_OK ? ANSWERED : BROKEN,
                            .x = program_output(r, lumped ? OUTPUT_QDD : OUTPUT_TAU),
                            .lambda = program_output(r, OUTPUT_LAMBDA)};
    text_copy(out->text, sizeof out->text, result->text);
    return true;
}

/* The worst answers of a variant over all numbers of ranks. */
struct spread {
    struct verify_row answer, lambda; /* judged; worst_rank 0: none */
    char ranks[32], text[128]; /* numbers of ranks tried; why one was refused or broke down */
};

/* Keep the row with the larger error; NaN compares as not larger. */
static void worst_take(struct verify_row *worst, struct verify_row *row, int nrank)
{
    if (worst->worst_rank > 0 && !(row->error > worst->error)) return;
    row->worst_rank = nrank;
    *worst = *row;
}

/* The judgement of one number of ranks, into the worst of its variant. */
static void spread_add(struct spread *s, const struct verify_case *v, const struct outcome *x,
                       int nrank, bool forward)
{
    const struct verify_options *o = v->options;
    bool good = x->kind == ANSWERED;
    struct verify_row row = {.worst_rank = 0};
    /* the list of numbers of ranks, "1,2,3" */
    size_t used = strlen(s->ranks);
    snprintf(s->ranks + used, sizeof s->ranks - used, "%s%d", used ? "," : "", nrank);
    if (!good) text_copy(s->text, sizeof s->text, x->text);
    verify_row_judge(v, &row, forward ? VERIFY_QDD_FD : VERIFY_TAU_ID, good ? x->x : NULL,
                     forward ? verify_tolerance_forward(o) : verify_tolerance_inverse(o));
    /* A run that breaks down is the worst answer, and its reason is kept. */
    if (!good) snprintf(row.note, sizeof row.note, "breaks down: %.100s", x->text);
    worst_take(&s->answer, &row, nrank);
    if (!forward || !v->vector->lambda) return;
    struct verify_row lambda = {.worst_rank = 0};
    verify_row_judge(v, &lambda, VERIFY_LAMBDA, good ? x->lambda : NULL,
                     verify_tolerance_forward(o));
    worst_take(&s->lambda, &lambda, nrank);
}

/* All numbers of ranks. Each run's memory is released; *s has copies. */
static bool variant_run(struct verify_case *v, const struct kernel_spec *kernel, struct spread *s,
                        struct err *e)
{
    const bool forward = kernel_spec_has(kernel, PROGRAM_FORWARD);
    int rank[MAX_RANKS],
        n = ranks_choose(v->options, forward ? v->lumped->nbody : v->model->nbody, rank);
    *s = (struct spread){.ranks = ""};
    for (int i = 0; i < n; i++) {
        struct outcome x;
        struct arena_mark mark = arena_mark(v->arena);
        if (!kernel_run(v, kernel, rank[i], &x, e)) return false;
        /* Another number of ranks may still be accepted. */
        if (x.kind == REFUSED)
            text_copy(s->text, sizeof s->text, x.text);
        else
            spread_add(s, v, &x, rank[i], forward);
        arena_release(v->arena, mark);
    }
    return true;
}

/* Is the variant in quad precision, on nrank processors, right about the scene without extremes? */
static bool is_sane(struct verify_case *v, const struct kernel_spec *quad, int nrank, bool *sane,
                    struct err *e)
{
    if (!verify_even(v, e)) return false;
    struct arena_mark mark = arena_mark(v->arena);
    struct outcome x;
    if (!kernel_run(v->even, quad, nrank, &x, e)) return false;
    *sane = x.kind == ANSWERED && verify_even_right(v, x.x);
    arena_release(v->arena, mark);
    return true;
}

/* A row above its tolerance by the same variant in quad precision, on as many ranks as were
 * worst. */
static bool explain(struct verify_case *v, const struct kernel_spec *kernel, enum verify_quantity k,
                    struct verify_row *row, struct err *e)
{
    struct kernel_spec again = *kernel;
    struct arena_mark mark = arena_mark(v->arena);
    struct outcome x;
    /* asked only where it matters: the even scene costs another run */
    bool sane = true;
    if (verify_row_refuted(v, row, k)) return true;
    /* The same variant on the same ranks, so that only the precision differs. */
    again.precision = PRECISION_QUAD;
    if (!kernel_run(v, &again, row->worst_rank, &x, e)) return false;
    const double *y = k == VERIFY_LAMBDA ? x.lambda : x.x;
    double error = x.kind == ANSWERED ? verify_answers_error(&v->answers, k, y) : INFINITY;
    arena_release(v->arena, mark);
    /* Inverse dynamics has no system that could be singular: nothing excuses it. */
    if (k == VERIFY_TAU_ID)
        sane = false; /* inverse dynamics has no system to solve that could be singular */
    else if (error > row->tolerance && !is_sane(v, &again, row->worst_rank, &sane, e)) return false;
    verify_row_explain(row, error, sane);
    return true;
}

/* A row of the report from what the ranks gave, explained if it fails. */
static bool row_keep(struct verify_case *v, const struct variant *variant,
                     const struct kernel_spec *kernel, enum verify_quantity k,
                     const struct spread *s, struct err *e)
{
    struct verify_row *row = verify_row_add(v, variant->name, verify_quantity_name(k));
    struct verify_row found = k == VERIFY_LAMBDA ? s->lambda : s->answer;
    /* the spread's row has numbers, the new one has names */
    memcpy(found.algorithm, row->algorithm, sizeof found.algorithm);
    memcpy(found.quantity, row->quantity, sizeof found.quantity);
    memcpy(found.ranks, s->ranks, sizeof found.ranks);
    found.parallel = true;
    *row = found;
    return row->verdict != VERIFY_FAIL || explain(v, kernel, k, row, e);
}

/* One variant: its row, and one for the loop forces where the file has them. */
static bool variant_row(struct verify_case *v, const struct variant *variant, struct err *e)
{
    struct kernel_spec kernel = variant->kernel;
    const bool forward = kernel_spec_has(&kernel, PROGRAM_FORWARD);
    enum verify_quantity quantity = forward ? VERIFY_QDD_FD : VERIFY_TAU_ID;
    struct spread s;
    kernel.precision = v->options->precision;
    if (!variant_run(v, &kernel, &s, e)) return false;
    /* No number of ranks could run it: the last refusal is the reason. */
    if (s.answer.worst_rank == 0) {
        verify_row_skip(v, variant->name, verify_quantity_name(quantity), s.text);
        v->report->row[v->report->nrow - 1].parallel = true;
        return true;
    }
    if (!row_keep(v, variant, &kernel, quantity, &s, e)) return false;
    if (s.lambda.worst_rank == 0) return true;
    /* On redundant loops a difference of lambda is no error. */
    if (verify_loops_skip(v, variant->name)) {
        v->report->row[v->report->nrow - 1].parallel = true;
        return true;
    }
    return row_keep(v, variant, &kernel, VERIFY_LAMBDA, &s, e);
}

/* Whether three components describe the case, to the rounding of its numbers. planar_scene compares
 * axes, offsets and forces with the plane's; its reason is not needed here. */
static bool in_plane(const struct verify_case *v)
{
    struct err why;
    err_clear(&why);
    return planar_scene(v->model, v->state, PRECISION_DOUBLE, &why);
}

/* All variants that apply to the case: the file must have the quantity, the plane needs a planar
 * scene, forward kernels need inertias. */
bool verify_parallel(struct verify_case *v, struct err *e)
{
    const bool planar = in_plane(v);
    char unfit[96];
    bool has_unfit = verify_unfit_body(v->lumped, unfit, sizeof unfit);
    for (int i = 0; i < VARIANTS; i++) {
        const struct variant *variant = &variant_table[i];
        const bool forward = kernel_spec_has(&variant->kernel, PROGRAM_FORWARD);
        if (!(forward ? v->vector->qdd_fd : v->vector->tau_id)) continue;
        if (variant->kernel.algebra == ALGEBRA_PLANAR && !planar) continue;
        if (forward && has_unfit)
            verify_row_skip(v, variant->name, "qdd_fd", unfit);
        else if (!variant_row(v, variant, e))
            return false;
    }
    return true;
}
