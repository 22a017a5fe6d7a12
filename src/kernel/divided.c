/* divided.c - see divided.h. */
#include "kernel/divided.h"

#include <math.h>
#include <string.h>

#include "base/text.h"
#include "dynamics/planar.h"
#include "kernel/omission.h"
#include "model/model_part.h"
#include "spec/program_list.h"

/* Joints whose axes are twisted against each other leave every plane, and the first two bodies of a
 * chain are those of a chain of two. */
static bool leaves_the_plane(const struct run_spec *spec)
{
    struct model_spec two = spec->model;
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    two.nbody = 2;
    const struct model *m = model_build(&two, a, &e);
    const bool leaves = m && !planar_scene(m, NULL, spec->kernel.precision, &e);
    arena_destroy(a);
    return leaves;
}

bool divided_fits(const struct run_spec *spec, unsigned keep)
{
    const struct kernel_spec *k = &spec->kernel;
    /* Up to there the mass matrix of all bodies is a serial code, too. */
    const bool forward = kernel_spec_has(k, PROGRAM_FORWARD);
    if (forward && spec->model.nbody <= OMISSION_CRBA_MOST) return false;
    return k->steps == 0 && keep == 0 && model_divides(&spec->model) &&
           k->algebra != ALGEBRA_PLANAR &&
           k->operators == OPERATORS_STRUCTURED && k->partition != PARTITION_BALANCED &&
           spec->nrank <= spec->model.nbody && leaves_the_plane(spec);
}

bool divided_all(const struct run_part *p, bool yes)
{
    int64_t no = !yes;
    return p->sum(p->context, &no, 1) && no == 0;
}

bool divided_agree(const struct run_part *p, struct model *model, struct state *state)
{
    int64_t v[3] = {model == NULL, model && !omission_still(model, state),
                    model && !model->has_phi};
    if (!p->sum(p->context, v, 3) || v[0] > 0) return false;
    state->others_move = v[1] > 0;
    model->has_phi = v[2] == 0;
    return true;
}

/* --- the serial answer ------------------------------------------------------------------------ */

/* Numbers of process by number: the tip is where the last one is. */
static bool take(const void *part, bool tip, double *x, int n)
{
    const struct run_part *p = part;
    return p->take(p->context, p->number + (tip ? 1 : -1), x, (size_t)n * sizeof *x);
}

static bool give(const void *part, bool tip, const double *x, int n)
{
    const struct run_part *p = part;
    return p->give(p->context, p->number + (tip ? 1 : -1), x, (size_t)n * sizeof *x);
}

/* Counts of operations are whole numbers: their sum does not depend on the parts. */
static bool add_work(const struct run_part *p, struct work *w)
{
    int64_t v[] = {(int64_t)w->flop, (int64_t)w->div, (int64_t)w->sqrt,
                   (int64_t)w->trig, (int64_t)w->bytes, (int64_t)w->call};
    if (!p->sum(p->context, v, 6)) return false;
    *w = (struct work){.flop = (uint64_t)v[0], .div = (uint64_t)v[1], .sqrt = (uint64_t)v[2],
                       .trig = (uint64_t)v[3], .bytes = (uint64_t)v[4], .call = (uint64_t)v[5]};
    return true;
}

bool divided_inverse(const struct run_part *p, struct scene *s)
{
    struct serial_answer *x = &s->inverse;
    const struct part_ends ends = {p, take, give};
    if (x->asked) return x->found;
    x->asked = true;
    x->x = TAKE(s->arena, s->model->nu, double);
    struct arena *scratch = arena_create();
    const bool ok = dynamics_type_of(PRECISION_DOUBLE)
                        ->inverse_part(s->model, s->state, &ends, scratch, x->x, &x->work);
    arena_destroy(scratch);
    x->found = ok && add_work(p, &x->work);
    return x->found;
}

bool divided_forward(const struct run_part *p, struct scene *s)
{
    struct serial_answer *x = &s->forward[FORWARD_ABA];
    const struct part_ends ends = {p, take, give};
    bool found;
    if (x->asked) return true;
    x->asked = true;
    x->x = TAKE(s->arena, s->model->nu, double);
    struct arena *scratch = arena_create();
    const bool ok = dynamics_type_of(PRECISION_DOUBLE)
                        ->forward_part(s->model, s->state, &ends, scratch, x->x, &found, &x->work);
    arena_destroy(scratch);
    int64_t broken = !found;
    if (!ok || !add_work(p, &x->work) || !p->sum(p->context, &broken, 1)) return false;
    x->found = broken == 0;
    return true;
}

void divided_silent(struct run_result *out)
{
    out->job_broken = true;
    out->status = RUN_FAILED;
    text_copy(out->text, sizeof out->text, "a process of the job does not answer");
}

/* Of numbers that are not negative, the larger one has the larger bits, and a NaN larger ones than
 * infinity. */
bool divided_worst(const struct run_part *p, double *difference, double *reference)
{
    int64_t bits[2];
    const double x[2] = {fabs(*difference), fabs(*reference)};
    memcpy(bits, x, sizeof bits);
    if (!p->largest(p->context, bits, 2)) return false;
    memcpy(difference, &bits[0], sizeof *difference);
    memcpy(reference, &bits[1], sizeof *reference);
    return true;
}
