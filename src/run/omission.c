/* omission.c - see omission.h. */
#include "run/omission.h"

#include "base/check.h"
#include "base/text.h"
#include "run/launch.h"

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
    o.bias = o.load && o.base && !(spec->keep & KEEP_BIAS);
    return o;
}

void omission_prepare(struct kernel_job *job, struct state *s, struct arena *a)
{
    if (s && (job->spec->keep & KEEP_EXTERNAL)) state_fext_need(s, job->model, a);
    job->state = s;
    job->omit = omission_job(job->spec, job->model, s);
}

struct list {
    struct omission *item;
    int n;
};

static void add(struct list *l, unsigned keep, const char *what, const char *why)
{
    CHECK(l->n < RUN_MAX_OMISSIONS);
    struct omission *o = &l->item[l->n++];
    *o = (struct omission){.keep = keep};
    text_copy(o->what, sizeof o->what, what);
    text_copy(o->why, sizeof o->why, why);
}

static void list_terms(const struct run_spec *spec, const struct kernel_type *kernel, const struct model *m,
                       const struct state *s, struct list *l)
{
    struct run_spec all_out = *spec;
    all_out.keep = 0;
    const struct job_omit o = omission_job(&all_out, m, s);
    if (!s->fext) add(l, KEEP_EXTERNAL, "external forces", "no body has any");
    if (o.velocity) add(l, KEEP_VELOCITY, "velocity terms", "all joint rates are zero, and there are no time steps");
    if (o.base) add(l, KEEP_BASE, "base and gravity terms", "the base does not accelerate, and there is no gravity");
    if (o.bias && kernel->does_forward && spec->kernel.formulation == FORMULATION_PAPER)
        add(l, KEEP_BIAS, "bias stage", "no velocities, no gravity, no external forces: there is no bias");
}

static void list_model(const struct kernel_type *kernel, const struct model *m, struct list *l)
{
    add(l, KEEP_SCENES, "scene and serial answers of other runs", "runs of one scene share them");
    bool revolute = true;
    for (int i = 0; i < m->nbody; i++) revolute = revolute && m->body[i].joint == JOINT_REVOLUTE;
    if (m->is_chain && m->nloop == 0) add(l, 0, "branch and loop phases", "an open chain has neither");
    if (revolute) add(l, 0, "general joints in the serial references", "all joints are revolute");
    if (kernel->does_forward && m->nu > BASELINE_MOST)
        add(l, KEEP_BASELINE, "mass-matrix baseline", "more than 512 degrees of freedom: cubic cost, never fastest");
}

int omission_list(const struct run_spec *spec, const struct kernel_type *kernel, const struct model *m,
                  const struct state *s, struct omission *out)
{
    const struct network_spec *n = &spec->machine.network;
    struct list l = {out, 0};
    if (m) {
        list_terms(spec, kernel, m, s, &l);
        list_model(kernel, m, &l);
    }
    if (kernel->largest_message && (n->level == LEVEL_LINK || n->level == LEVEL_PACKET || n->level == LEVEL_AUTO))
        add(&l, KEEP_START_EVENTS, "events that start messages", "eager sends are in order");
    if (n->level == LEVEL_AUTO)
        add(&l, KEEP_CONTENTION, "contention where routes share no link", "level auto gives the packet level's times");
    if (!spec->record.spans) add(&l, KEEP_SPANS, "timeline", "record.spans does not ask for it");
    if (!spec->record.links) add(&l, KEEP_LINKS, "counters of single links", "record.links does not ask for them");
    return l.n;
}

void omission_note(const struct run_spec *spec, const struct kernel_type *kernel, const struct kernel_job *job,
                   struct run_result *out)
{
    struct omission all[RUN_MAX_OMISSIONS];
    const int n = omission_list(spec, kernel, job->model, job->state, all);
    out->nomission = 0;
    for (int i = 0; i < n; i++)
        if (!(spec->keep & all[i].keep)) out->omission[out->nomission++] = all[i];
}
