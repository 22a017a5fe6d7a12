/* omission.c - see omission.h. */
#include "run/omission.h"

#include "base/check.h"
#include "base/text.h"
#include "dynamics/planar.h"
#include "kernel/estimate.h"
#include "model/lump.h"
#include "run/launch.h"
#include "run/references.h"

enum { BASELINE_MOST = 512 }; /* degrees of freedom of the mass-matrix baseline, see references.h */

int64_t omission_largest_message(const struct run_spec *spec, const struct kernel_type *kernel,
                                 const struct kernel_job *job)
{
    if (spec->keep & KEEP_START_EVENTS) return -1;
    return launch_largest_message(kernel, job);
}

struct machine_spec omission_machine(const struct run_spec *spec)
{
    struct machine_spec m = spec->machine;
    if ((spec->keep & KEEP_CONTENTION) && m.network.level == LEVEL_AUTO) m.network.level = LEVEL_PACKET;
    return m;
}

struct record_spec omission_record(const struct run_spec *spec)
{
    struct record_spec r = spec->record;
    if (spec->keep & KEEP_SPANS) r.spans = true;
    if (spec->keep & KEEP_LINKS) r.links = true;
    return r;
}

static bool all_zero(const double *x, int n)
{
    for (int i = 0; i < n; i++)
        if (x[i] != 0) return false;
    return true;
}

struct job_omit omission_job(const struct run_spec *spec, const struct model *m, const struct state *s)
{
    struct job_omit o = {0};
    if (!m) return o;
    const bool rest = spec->kernel.steps == 0 && all_zero(s->qd, m->nu);
    o.velocity = rest && !(spec->keep & KEEP_VELOCITY);
    o.load = o.velocity && !s->fext;
    o.base = all_zero(s->base_acceleration, 6) && all_zero(m->gravity, 3) && !(spec->keep & KEEP_BASE);
    o.turn = all_zero(s->base_acceleration, 3) && !(spec->keep & KEEP_TURN);
    o.bias = o.load && o.base && !(spec->keep & KEEP_BIAS);
    return o;
}

/* in_plane: whether a run that leaves the algebra open takes three components. Not for loops in float: there the
 * spatial programs' loop forces out of the plane, zero in truth, are rounding of any size: no bound would hold. */
static bool in_plane(const struct run_spec *spec, const struct model *m, const struct state *s)
{
    const struct kernel_spec *k = &spec->kernel;
    struct err why;
    err_clear(&why);
    if ((spec->keep & KEEP_SPATIAL) || k->operators != OPERATORS_STRUCTURED) return false;
    return !(m->nloop > 0 && k->precision == PRECISION_FLOAT) && planar_scene(m, s, k->precision, &why);
}

const struct kernel_type *omission_kernel(const struct run_spec *spec, const struct model *m, const struct state *s,
                                          struct err *e)
{
    const struct kernel_spec *k = &spec->kernel;
    const struct kernel_type *kernel = kernel_find_precision(k->name, k->precision);
    if (!kernel) err_set(e, ERR_CONFIG, "no kernel is called '%s'; 'mimdsim kernels' lists them", k->name);
    if (!kernel || !m || k->algebra == ALGEBRA_SPATIAL) return kernel;
    if (k->algebra == ALGEBRA_AUTO) return in_plane(spec, m, s) ? kernel_find_planar(k->name, k->precision) : kernel;
    return planar_scene(m, s, k->precision, e) ? kernel_find_planar(k->name, k->precision) : NULL;
}

int omission_movable(const struct model *m)
{
    int n = 0;
    for (int i = 0; i < m->nbody; i++) n += m->body[i].joint != JOINT_FIXED;
    return n;
}

int omission_mergeable(const struct run_spec *spec, int nbody, int movable)
{
    return movable > 0 && movable >= spec->nrank && !(spec->keep & KEEP_FIXED) ? nbody - movable : 0;
}

int omission_scene(const struct run_spec *spec, struct model **m, struct state **s, struct arena *a)
{
    struct lumped lumped;
    struct err refused;
    err_clear(&refused);
    int fixed = omission_mergeable(spec, (*m)->nbody, omission_movable(*m));
    if (fixed > 0 && lump_fixed(*m, true, a, &lumped, &refused)) {
        *s = lump_state(&lumped, *m, *s, a);
        *m = lumped.model;
    } else {
        fixed = 0;
    }
    if (spec->keep & KEEP_EXTERNAL) state_fext_need(*s, *m, a);
    (*m)->general_joints = (spec->keep & KEEP_GENERAL) != 0;
    return fixed;
}

struct list {
    unsigned keep; /* of the run */
    struct omission *item;
    int n;
};

static void add(struct list *l, unsigned keep, double bound, const char *what, const char *why)
{
    if (l->keep & keep) return;
    CHECK(l->n < RUN_MAX_OMISSIONS);
    struct omission *o = &l->item[l->n++];
    *o = (struct omission){.keep = keep, .bound = bound};
    text_copy(o->what, sizeof o->what, what);
    text_copy(o->why, sizeof o->why, why);
}

/* terms: what the kernel's equations do without. */
static void list_terms(const struct kernel_job *job, const struct kernel_type *kernel, struct list *l)
{
    const struct job_omit *o = &job->omit;
    const bool paper = kernel->does_forward && job->spec->kernel.formulation == FORMULATION_PAPER;
    if (!job->state->fext) add(l, KEEP_EXTERNAL, 0, "external forces", "no body has any");
    if (o->velocity) add(l, KEEP_VELOCITY, 0, "velocity terms", "all joint rates are zero, without time steps");
    if (o->base) add(l, KEEP_BASE, 0, "base and gravity terms", "the base does not accelerate, without gravity");
    else if (o->turn) add(l, KEEP_TURN, 0, "angular base terms", "the base does not turn");
    if (o->bias && paper)
        add(l, KEEP_BIAS, 0, "bias stage", "no velocities, no gravity, no external forces: there is no bias");
}

/* list_model: what another program or another model of the same system would do; the rounding differs. */
static void list_model(const struct kernel_job *job, const struct kernel_type *kernel, struct list *l)
{
    const struct model *m = job->model;
    const struct kernel_spec *k = &job->spec->kernel;
    const double bound = 2 * (kernel->does_forward ? references_tolerance(k, m->nbody + job->omit.fixed)
                                                   : references_tolerance_inverse(k, m->nbody + job->omit.fixed));
    add(l, KEEP_SCENES, 0, "scene and serial answers of other runs", "runs of one scene share them");
    bool revolute = true;
    for (int i = 0; i < m->nbody; i++) revolute = revolute && m->body[i].joint == JOINT_REVOLUTE;
    if (job->omit.fixed > 0)
        add(l, KEEP_FIXED, bound, "fixed joints", "a body on a fixed joint is part of the one that carries it");
    if (m->is_chain && m->nloop == 0)
        add(l, kernel_fits_trees(k) ? KEEP_BRANCHES : 0, bound, "branch and loop phases", "an open chain has neither");
    if (kernel->planar)
        add(l, k->algebra == ALGEBRA_AUTO ? KEEP_SPATIAL : 0, bound, "out-of-plane components",
            "all joints move in one plane: three components of six");
    if (revolute) add(l, KEEP_GENERAL, 0, "general joints in the serial references", "all joints are revolute");
    if (kernel->does_forward && !kernel->planar && job->spec->record.baselines == BASELINES_NEEDED)
        add(l, KEEP_BASELINE, 0, "serial codes that cannot be fastest", "record.baselines asks for the needed ones");
    if (kernel->does_forward && !kernel->planar && m->nu > BASELINE_MOST)
        add(l, KEEP_BASELINE, 0, "mass-matrix baseline", "more than 512 degrees of freedom: cubic, never fastest");
}

/* list_starts: sends need no event of their own where every message is eager: always, or because the largest is. */
static void list_starts(const struct kernel_job *job, const struct kernel_type *kernel, struct list *l)
{
    const enum network_level level = job->spec->machine.network.level;
    const int64_t eager = software_eager_most(&job->spec->machine.software);
    const int64_t largest = launch_largest_message(kernel, job);
    if (level != LEVEL_LINK && level != LEVEL_PACKET && level != LEVEL_AUTO) return;
    if (eager == INT64_MAX)
        add(l, 0, 0, "events that start messages", "the machine sends every message at once, in order");
    else if (largest >= 0 && largest <= eager)
        add(l, KEEP_START_EVENTS, 0, "events that start messages", "eager sends are in order");
}

int omission_list(const struct kernel_job *job, const struct kernel_type *kernel, struct omission *out)
{
    const struct run_spec *spec = job->spec;
    const struct network_spec *n = &spec->machine.network;
    struct list l = {spec->keep, out, 0};
    if (job->model) {
        list_terms(job, kernel, &l);
        list_model(job, kernel, &l);
    }
    list_starts(job, kernel, &l);
    if (n->level == LEVEL_AUTO)
        add(&l, KEEP_CONTENTION, 0, "contention where routes share no link", "level auto has the packet level's times");
    if (!spec->record.spans) add(&l, KEEP_SPANS, 0, "timeline", "record.spans does not ask for it");
    if (!spec->record.links) add(&l, KEEP_LINKS, 0, "counters of single links", "record.links does not ask for them");
    return l.n;
}

int omission_unused(const struct kernel_job *job, const struct kernel_type *kernel, const char **out)
{
    const struct kernel_spec *k = &job->spec->kernel;
    const enum model_generator made = job->spec->model.generator;
    int n = 0;
    if (!job->model || (made != MODEL_URDF && made != MODEL_VECTOR)) return 0;
    const bool branches = !job->model->is_chain || job->model->nloop > 0;
    const bool idle = k->formulation == FORMULATION_DIRECT ? job->omit.velocity : job->omit.bias;
    if (branches && kernel->does_forward && k->solver != SOLVER_PCR_SYMMETRIC)
        out[n++] = "kernel.solver: the file's model branches or closes loops: it is contracted";
    if (k->composites_incoming && branches)
        out[n++] = "kernel.composites_incoming: the file's model branches or closes loops: it takes incoming ones";
    else if (k->composites_incoming && idle && !kernel->does_inverse && k->outer_refinements == 0)
        out[n++] = "kernel.composites_incoming: nothing moves in the file's state, so nothing is scanned";
    return n;
}
