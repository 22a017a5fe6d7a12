/* dynamics_program.c - see dynamics_program.h. */
#include "kernel/dynamics_program.h"

#include <math.h>
#include <string.h>

#include "kernel/divided.h"
#include "kernel/omission.h"
#include "kernel/references.h"
#include "kernel/trust.h"

/* --- open and prepare ------------------------------------------------------------------------- */

/* Opening decides which kernel runs and what it leaves out; nothing is computed yet. `given` keeps
 * the settings as they were, because attempts may add refinements. */
bool dynamics_open(struct program_run *r, const struct model *m, const struct state *s,
                   struct err *e)
{
    struct dynamics_run *d = TAKE(r->arena, 1, struct dynamics_run);
    *d = (struct dynamics_run){.given = r->spec.kernel};
    /* Monitors cost the machine nothing, but a real processor their time: a real run is made
     * without them, after a simulated one whose answer they judged. */
    const bool watch = !r->order.real;
    d->job = (struct kernel_job){.spec = &r->spec,
                                 .model = m,
                                 .state = s,
                                 .omit = omission_job(&r->spec, r->order.keep, m, s),
                                 .keep = r->order.keep,
                                 .nrank = r->spec.nrank,
                                 .watch = watch};
    d->kernel = omission_kernel(&r->spec, r->order.keep, m, s, e);
    if (!d->kernel || !d->kernel->accepts(&d->job, e)) return false;
    r->own = d;
    r->rank = &d->kernel->rank;
    r->job = &d->job;
    r->nbody = m->nbody;
    r->nu = m->nu;
    r->metre = m->metre, r->kilogram = m->kilogram, r->second = m->second;
    return true;
}

/* Host memory of a body, beside the ranks' [B]: the model; then, when the ranks are gone,
 * references in other precisions and serial codes. Peaks of runs with 4,096 to 65,536 bodies on 16
 * to 1,024 ranks (host_peak_bytes), less the rest, of chains whose bodies weigh alike: 320 bytes
 * more where they do not. */
enum {
    MODEL_BODY_BYTES = 780,
    INVERSE_BODY_BYTES = 560,
    TREE_BODY_BYTES = 2300,
    LOOP_BODY_BYTES = 4000,
    CHAIN_BODY_BYTES = 3000,
    COUNTED_BODY_BYTES = 720 /* articulated bodies alone: what their arrays have of a body */
};

/* The scene belongs to the cache: runs of one campaign that differ in machine or network share it.
 * Its part, if processes divide it; where one of them cannot, all have it whole. */
static struct scene *take_scene(struct program_run *r, struct err *e)
{
    const struct run_part *part = divided_fits(&r->spec, r->order.keep) ? r->part : NULL;
    const int n = r->spec.model.nbody, nrank = r->spec.nrank;
    const int first = part ? kernel_block(n, nrank, part->first) : 0,
              end = part ? kernel_block(n, nrank, part->end) : n;
    const bool fits = scene_fits(&r->spec, end - first, e);
    /* The others do not wait for one that cannot hold its part. */
    if (part ? !part->agree(part->context, fits, e) : !fits) return NULL;
    struct scene *s = part ? scene_take(r->cache, &r->spec, r->order.keep, part, e) : NULL;
    r->divided = s != NULL;
    return s ? s : scene_take(r->cache, &r->spec, r->order.keep, NULL, e);
}

/* Bodies that were merged away still count in the run's row: the user described them. */
static bool open(struct program_run *r, struct err *e)
{
    struct scene *scene = take_scene(r, e);
    if (!scene || !dynamics_open(r, scene->model, scene->state, e)) return false;
    struct dynamics_run *d = dynamics_run_of(r);
    d->scene = scene;
    d->job.omit.fixed = scene->fixed;
    r->nbody += scene->fixed;
    return true;
}

static bool prepare(struct program_run *r, struct arena *a, struct err *e)
{
    struct dynamics_run *d = dynamics_run_of(r);
    const struct model *m = d->job.model;
    /* What this run will publish, with the room for it. An output that is not wanted costs
     * nothing. */
    memset(r->output, 0, sizeof r->output);
    if (d->kernel->does_inverse) program_want(r, OUTPUT_TAU, m->nu, a);
    if (d->kernel->does_forward) program_want(r, OUTPUT_QDD, m->nu, a);
    if (m->nrow > 0) program_want(r, OUTPUT_LAMBDA, m->nrow, a);
    if (r->spec.kernel.steps > 0) {
        program_want(r, OUTPUT_Q_END, m->nq, a);
        program_want(r, OUTPUT_QD_END, m->nu, a);
    }
    if (d->job.watch) {
        program_want(r, OUTPUT_RESIDUAL, r->spec.nrank, a);
        program_want(r, OUTPUT_RESIDUAL_SCALE, r->spec.nrank, a);
        program_want(r, OUTPUT_CONDITION, r->spec.nrank, a);
    }
    program_want(r, OUTPUT_REFINED, 1, a);
    /* Without loops there is no rank to report: -1 says so. */
    program_want(r, OUTPUT_LOOP_RANK, 1, a);
    *program_output(r, OUTPUT_LOOP_RANK) = -1;
    return d->kernel->prepare(&d->job, a, e);
}

/* --- attempts --------------------------------------------------------------------------------- */

static void judge(struct program_run *r, struct run_result *out) { trust_check(r, out); }

/* The attempts are over: what was added to the given settings. */
static void tell_added(const struct dynamics_run *d, const struct kernel_spec *now,
                       struct run_result *out)
{
    /* Differences to the settings as given: what the program did on its own account. */
    out->inner_added = now->inner_refinements - d->given.inner_refinements;
    out->outer_added = now->outer_refinements - d->given.outer_refinements;
    out->twice_added = now->residual != d->given.residual;
    out->residual_before = d->residual_before;
}

/* More refinement until the residual is small enough. When the last attempt is no better than the
 * first, the first is what holds: it is made again. */
static bool again(struct program_run *r, struct run_result *out)
{
    struct dynamics_run *d = dynamics_run_of(r);
    struct kernel_spec *now = &r->spec.kernel;
    /* The first attempt's residual is what later ones must beat. */
    if (d->attempts++ == 0) d->residual_before = out->residual;
    const bool solves =
        d->kernel->does_forward && (out->status == RUN_OK || out->status == RUN_INVALID);
    if (solves && !d->reverted && trust_refine(&r->spec, d->job.model, &d->job.omit, out))
        return true;
    const bool added = now->inner_refinements > d->given.inner_refinements ||
                       now->outer_refinements > d->given.outer_refinements;
    /* A residual that is no number is never better. */
    const bool worse = out->residual >= d->residual_before || isnan(out->residual);
    if (added && worse && !d->reverted) {
        *now = d->given;
        d->reverted = true;
        return true;
    }
    tell_added(d, now, out);
    return false;
}

/* --- what the answer is worth ----------------------------------------------------------------- */

/* Loops are judged by their drift, answers by the serial codes. */
static void check(struct program_run *r, struct arena *scratch, struct run_result *out)
{
    const struct dynamics_run *d = dynamics_run_of(r);
    references_loops(r, scratch, out);
    references_check(r, d->scene, scratch, out);
}

static void baselines(struct program_run *r, const struct work_price *price, struct arena *scratch,
                      struct run_result *out)
{
    const struct dynamics_run *d = dynamics_run_of(r);
    references_baselines(&d->job, d->kernel, d->scene, price, scratch, out);
}

/* --- before it runs --------------------------------------------------------------------------- */

static void estimate(const struct program_run *r, struct program_estimate *out)
{
    const struct dynamics_run *d = dynamics_run_of(r);
    const struct model *m = d->job.model;
    d->kernel->estimate(&r->spec, m, &d->job.omit, out);
    const int each = !d->kernel->does_forward      ? INVERSE_BODY_BYTES
                     : m->nloop > 0                ? LOOP_BODY_BYTES
                     : omission_counted(&d->job) ? COUNTED_BODY_BYTES
                     : m->is_chain                 ? CHAIN_BODY_BYTES
                                                   : TREE_BODY_BYTES;
    out->model_bytes = (double)m->nbody * MODEL_BODY_BYTES;
    out->reference_bytes = (double)m->nbody * each;
}

static void leave_out(const struct program_run *r, struct left_out *l)
{
    const struct dynamics_run *d = dynamics_run_of(r);
    omission_list(&d->job, d->kernel, l);
}

static int unused(const struct program_run *r, const char **out)
{
    const struct dynamics_run *d = dynamics_run_of(r);
    return omission_unused(&d->job, d->kernel, out);
}

/* All three are the same but for their names and for the text that the ranks run (kernel.h). */
#define DYNAMICS(word, text)                                                                       \
    {                                                                                              \
        .name = word, .title = text, .has_scene = true, .repeats = true,                           \
        .cache_create = scene_cache_create,                                                        \
        .cache_destroy = scene_cache_destroy, .open = open, .prepare = prepare, .judge = judge,    \
        .again = again, .check = check, .baselines = baselines, .estimate = estimate,              \
        .leave_out = leave_out, .unused = unused,                                                  \
    }

const struct program_type inverse_program =
    DYNAMICS("inverse", "inverse dynamics by recursive doubling (parallel Newton-Euler)");
const struct program_type forward_program =
    DYNAMICS("forward", "forward dynamics by the constraint force algorithm");
const struct program_type dynamics_program = DYNAMICS("dynamics", "inverse, then forward dynamics");
