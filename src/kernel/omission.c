/* omission.c - see omission.h. */
#include "kernel/omission.h"

#include "dynamics/planar.h"
#include "kernel/estimate.h"
#include "kernel/references.h"
#include "model/lump.h"
#include "model/model_part.h"

static bool all_zero(const double *x, int n)
{
    for (int i = 0; i < n; i++)
        if (x[i] != 0) return false;
    return true;
}

bool omission_still(const struct model *m, const struct state *s)
{
    const int first = m->u_at[m->first];
    return all_zero(s->qd + first, m->u_at[m->end] - first);
}

/* A term that is zero in all its parts for the whole run is not computed. Exact zeros only: a small
 * number is a number. */
struct job_omit omission_job(const struct run_spec *spec, unsigned keep, const struct model *m,
                             const struct state *s)
{
    struct job_omit o = {0};
    if (!m) return o;
    /* With time steps a state at rest begins to move: velocities count. */
    const bool rest = spec->kernel.steps == 0 && !s->others_move && omission_still(m, s);
    o.velocity = rest && !(keep & KEEP_VELOCITY);
    /* P = 0 and no external force: nothing loads the bodies. */
    o.load = o.velocity && !s->fext;
    /* At constant velocity without gravity the base's term is zero (physics 1.6). */
    o.base = all_zero(s->base_acceleration, 6) && all_zero(m->gravity, 3) && !(keep & KEEP_BASE);
    o.turn = all_zero(s->base_acceleration, 3) && !(keep & KEEP_TURN);
    /* All three causes gone: the bias xi is zero (physics 4.2). */
    o.bias = o.load && o.base && !(keep & KEEP_BIAS);
    /* Only where the programs for trees have all that is asked for. */
    o.branches = (keep & KEEP_BRANCHES) && kernel_fits_trees(&spec->kernel);
    return o;
}

/* in_plane: whether a run that leaves the algebra open takes three components. Not for loops in
 * float: there the spatial programs' loop forces out of the plane, zero in truth, are rounding of
 * any size: no bound would hold. */
static bool in_plane(const struct run_spec *spec, unsigned keep, const struct model *m,
                     const struct state *s)
{
    /* planar_scene says why not; here only whether. */
    const struct kernel_spec *k = &spec->kernel;
    struct err why;
    err_clear(&why);
    if ((keep & KEEP_SPATIAL) || k->operators != OPERATORS_STRUCTURED) return false;
    return !(m->nloop > 0 && k->precision == PRECISION_FLOAT) &&
           planar_scene(m, s, k->precision, &why);
}

/* "auto" decides by the scene; a planar algebra that was asked for and does not fit is an error
 * with its reason. */
const struct kernel_type *omission_kernel(const struct run_spec *spec, unsigned keep,
                                          const struct model *m, const struct state *s,
                                          struct err *e)
{
    const struct kernel_spec *k = &spec->kernel;
    const struct kernel_type *kernel = kernel_find_precision(k->name, k->precision);
    if (!kernel)
        err_set(e, ERR_CONFIG, "no kernel is called '%s'; 'mimdsim kernels' lists them", k->name);
    /* A part of a model is there only of scenes that are not planar. */
    if (!kernel || !m || !model_whole(m) || k->algebra == ALGEBRA_SPATIAL) return kernel;
    if (k->algebra == ALGEBRA_AUTO)
        return in_plane(spec, keep, m, s) ? kernel_find_planar(k->name, k->precision) : kernel;
    return planar_scene(m, s, k->precision, e) ? kernel_find_planar(k->name, k->precision) : NULL;
}

/* A fixed joint has no coordinate: its body can be part of the one that carries it. */
int omission_movable(const struct model *m)
{
    int n = m->nbody - (m->end - m->first); /* what is not here is revolute */
    for (int i = m->first; i < m->end; i++) n += m->body[i].joint != JOINT_FIXED;
    return n;
}

/* Merging must leave a body for every rank: P is given, and the model is not cut below it. */
int omission_mergeable(int nrank, unsigned keep, int nbody, int movable)
{
    return movable > 0 && movable >= nrank && !(keep & KEEP_FIXED) ? nbody - movable : 0;
}

int omission_scene(int nrank, unsigned keep, struct model **m, struct state **s, struct arena *a)
{
    struct lumped lumped;
    struct err refused;
    err_clear(&refused);
    int fixed = omission_mergeable(nrank, keep, (*m)->nbody, omission_movable(*m));
    /* A model whose fixed joints cannot be merged (a loop in the way) is taken as it is. */
    if (fixed > 0 && lump_fixed(*m, true, a, &lumped, &refused)) {
        *s = lump_state(&lumped, *m, *s, a);
        *m = lumped.model;
    } else {
        fixed = 0;
    }
    /* What is kept is computed with zeros, so that both ways can be compared. */
    if (keep & KEEP_EXTERNAL) state_fext_need(*s, *m, a);
    (*m)->general_joints = (keep & KEEP_GENERAL) != 0;
    return fixed;
}

bool omission_counted(const struct kernel_job *job)
{
    const struct model *m = job->model;
    const struct model_spec *spec = &job->spec->model;
    return !(job->keep & KEEP_BASELINE) && model_divides(spec) && m->has_phi &&
           m->nbody == spec->nbody && m->nbody > OMISSION_CRBA_MOST;
}

/* terms: what the kernel's equations do without. Each line names what is left out, its bound (0:
 * exact) and the reason, for `explain`. */
static void list_terms(const struct kernel_job *job, const struct kernel_type *kernel,
                       struct left_out *l)
{
    const struct job_omit *o = &job->omit;
    const bool paper = kernel->does_forward && job->spec->kernel.formulation == FORMULATION_PAPER;
    if (!job->state->fext) leave_out_add(l, KEEP_EXTERNAL, 0, "external forces", "no body has any");
    if (o->velocity)
        leave_out_add(l, KEEP_VELOCITY, 0, "velocity terms",
                      "all joint rates are zero, without time steps");
    if (o->base)
        leave_out_add(l, KEEP_BASE, 0, "base and gravity terms",
                      "the base does not accelerate, without gravity");
    else if (o->turn)
        leave_out_add(l, KEEP_TURN, 0, "angular base terms", "the base does not turn");
    if (o->bias && paper)
        leave_out_add(l, KEEP_BIAS, 0, "bias stage",
                      "no velocities, no gravity, no external forces: there is no bias");
}

/* list_model: what another program or another model of the same system would do; the rounding
 * differs. */
static void list_model(const struct kernel_job *job, const struct kernel_type *kernel,
                       struct left_out *l)
{
    const struct model *m = job->model;
    const struct kernel_spec *k = &job->spec->kernel;
    /* Twice the tolerance: both programs may be off by it, in opposite directions. */
    const double bound =
        2 * (kernel->does_forward ? references_tolerance(k, m->nbody + job->omit.fixed)
                                  : references_tolerance_inverse(k, m->nbody + job->omit.fixed));
    leave_out_add(l, KEEP_SCENES, 0, "scene and serial answers of other runs",
                  "runs of one scene share them");
    if (job->omit.fixed > 0)
        leave_out_add(l, KEEP_FIXED, bound, "fixed joints",
                      "a body on a fixed joint is merged with the body that carries it");
    if (m->is_chain && m->nloop == 0)
        leave_out_add(l, kernel_fits_trees(k) ? KEEP_BRANCHES : 0, bound, "branch and loop phases",
                      "an open chain has no branches or loops");
    if (kernel->planar)
        leave_out_add(l, k->algebra == ALGEBRA_AUTO ? KEEP_SPATIAL : 0, bound,
                      "out-of-plane components",
                      "all joints move in one plane: three components of six");
    if (model_all_revolute(m))
        leave_out_add(l, KEEP_GENERAL, 0, "general joints in the serial references",
                      "all joints are revolute");
    if (kernel->does_forward && !kernel->planar && job->spec->record.baselines == BASELINES_NEEDED)
        leave_out_add(l, KEEP_BASELINE, 0, "serial codes that cannot be fastest",
                      "record.baselines selects only the needed ones");
    if (kernel->does_forward && !kernel->planar && m->nu > OMISSION_CRBA_MOST)
        leave_out_add(l, KEEP_BASELINE, 0, "mass-matrix baseline",
                      "more than 512 degrees of freedom: cubic, never fastest");
    if (kernel->does_forward && !kernel->planar && omission_counted(job))
        leave_out_add(l, KEEP_BASELINE, 0, "answers of serial constraint forces",
                      "each body of a long chain costs the same: its work is counted");
}

void omission_list(const struct kernel_job *job, const struct kernel_type *kernel,
                   struct left_out *l)
{
    list_terms(job, kernel, l);
    list_model(job, kernel, l);
}

int omission_unused(const struct kernel_job *job, const struct kernel_type *kernel,
                    const char **out)
{
    const struct kernel_spec *k = &job->spec->kernel;
    const enum model_generator made = job->spec->model.generator;
    int n = 0;
    /* Only files bring surprises; for generated models the field tables know what acts. */
    if (!job->model || (made != MODEL_URDF && made != MODEL_VECTOR)) return 0;
    const bool branches = !job->model->is_chain || job->model->nloop > 0;
    const bool idle = k->formulation == FORMULATION_DIRECT ? job->omit.velocity : job->omit.bias;
    if (branches && kernel->does_forward && k->solver != SOLVER_PCR_SYMMETRIC)
        out[n++] = "kernel.solver: the file's model branches or closes loops: it is contracted";
    if (k->composites_incoming && branches)
        out[n++] = "kernel.composites_incoming: the file's model branches or closes loops: it "
                   "takes incoming ones";
    else if (k->composites_incoming && idle && !kernel->does_inverse && k->outer_refinements == 0)
        out[n++] =
            "kernel.composites_incoming: nothing moves in the file's state, so nothing is scanned";
    return n;
}
