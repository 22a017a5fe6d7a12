/* omission.c - see omission.h. */
#include "run/omission.h"

#include <stdio.h>

#include "base/text.h"
#include "mech/model.h"
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

static void add(struct run_estimate *out, unsigned keep, const char *what, const char *why)
{
    int most = (int)(sizeof out->omission / sizeof *out->omission);
    if (out->nomission == most) return;
    struct omission *o = &out->omission[out->nomission++];
    text_copy(o->what, sizeof o->what, what);
    text_copy(o->why, sizeof o->why, why);
    o->exact = true;
    o->keep = keep;
}

static void list_model(const struct run_spec *spec, const struct kernel_type *kernel, const struct model *m,
                       struct run_estimate *out)
{
    bool revolute = true;
    for (int i = 0; i < m->nbody; i++) revolute = revolute && m->body[i].joint == JOINT_REVOLUTE;
    if (spec->model.external_force == 0 && spec->model.generator != MODEL_VECTOR)
        add(out, KEEP_EXTERNAL, "external forces", "no body has any");
    if (m->is_chain && m->nloop == 0)
        add(out, 0, "branch and loop phases", "an open chain has neither");
    if (revolute) add(out, 0, "general joints in the serial references", "all joints are revolute");
    if (kernel->does_forward && m->nu > BASELINE_MOST)
        add(out, KEEP_BASELINE, "mass-matrix baseline", "more than 512 degrees of freedom: cubic cost, never fastest");
}

void omission_list(const struct run_spec *spec, const struct kernel_type *kernel, const struct model *m,
                   struct run_estimate *out)
{
    const struct network_spec *n = &spec->machine.network;
    out->nomission = 0;
    if (m) list_model(spec, kernel, m, out);
    if (kernel->largest_message && (n->level == LEVEL_LINK || n->level == LEVEL_PACKET || n->level == LEVEL_AUTO))
        add(out, KEEP_START_EVENTS, "events that start messages", "eager sends are in order");
    if (n->level == LEVEL_AUTO)
        add(out, KEEP_CONTENTION, "contention where routes share no link", "level auto gives the packet level's times");
    if (!spec->record.spans) add(out, KEEP_SPANS, "timeline", "record.spans does not ask for it");
    if (!spec->record.links) add(out, KEEP_LINKS, "counters of single links", "record.links does not ask for them");
}
