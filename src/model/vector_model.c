/* vector_model.c - models and states made from reference vectors. */
#include "model/vector_model.h"

#include <stdio.h>
#include <string.h>

#include "base/text.h"

/* The quaternion, normalised where used, is the exact rotation; R was its rounding. */
static struct frame frame_from(const struct vector_frame *f)
{
    struct frame out;
    memcpy(out.quat, f->quat, sizeof out.quat);
    memcpy(out.p, f->p, sizeof out.p);
    return out;
}

static struct body_def body_from(const struct vector_case *c, int i)
{
    /* The format's five types under their names here. */
    static const enum model_joint joint[] = {[VECTOR_FIXED] = JOINT_FIXED,
                                             [VECTOR_REVOLUTE] = JOINT_REVOLUTE,
                                             [VECTOR_PRISMATIC] = JOINT_PRISMATIC,
                                             [VECTOR_SPHERICAL] = JOINT_SPHERICAL,
                                             [VECTOR_FLOATING] = JOINT_FLOATING};
    const struct vector_body *b = &c->body[i];
    struct body_def def = {.parent = b->parent,
                           .joint = joint[b->joint],
                           .placement = frame_from(&b->placement),
                           .mass = b->mass,
                           .line = b->line};
    /* Files without names: numbered, as generated models. */
    if (b->name[0])
        text_copy(def.name, sizeof def.name, b->name);
    else
        snprintf(def.name, sizeof def.name, "body %d", i);
    memcpy(def.axis, b->axis, sizeof def.axis);
    memcpy(def.com, b->com, sizeof def.com);
    memcpy(def.inertia, b->inertia, sizeof def.inertia);
    /* Arrays over velocities: the number of a joint of one freedom stands at v. */
    if (c->spring && vector_joint_nv(b->joint) == 1) {
        def.stiffness = c->spring[b->v];
        def.rest = c->spring_q0[b->v];
        def.damping = c->damping[b->v];
    }
    return def;
}

/* By rows and without stabilisation: answers have none, and the states meet the loops. */
static struct loop_def loop_from(const struct vector_case *c, int i)
{
    const struct vector_loop *l = &c->loop[i];
    struct loop_def def = {.body_a = l->body_a,
                           .body_b = l->body_b,
                           .frame_a = frame_from(&l->frame_a),
                           .frame_b = frame_from(&l->frame_b),
                           .nrow = l->nrow,
                           .line = l->line};
    /* Loops have no names in the format. */
    snprintf(def.name, sizeof def.name, "loop %d", i);
    memcpy(def.row, l->row, sizeof def.row);
    return def;
}

/* Bodies, then loops, which need them. */
struct model *vector_model(const struct vector_case *c, struct arena *a, struct err *e)
{
    struct model *m = model_begin(a, c->path);
    memcpy(m->gravity, c->gravity, sizeof m->gravity);
    for (int i = 0; i < c->nbody; i++) {
        struct body_def def = body_from(c, i);
        if (model_add_body(m, &def, e) < 0) return NULL;
    }
    for (int i = 0; i < c->nloop; i++) {
        struct loop_def def = loop_from(c, i);
        if (model_add_loop(m, &def, e) < 0) return NULL;
    }
    /* Massless bodies are part of the references: algorithms are to say what they make of
     * them. */
    return model_finish(m, true, e) ? m : NULL;
}

/* Absent arrays stay zero. */
static void copy(double *to, const double *from, int n)
{
    if (from) memcpy(to, from, (size_t)n * sizeof *to);
}

/* In the file's own conventions, which are ours (spec/joint_list.h). */
struct state *vector_state(const struct vector_case *c, const struct model *m, struct arena *a)
{
    struct state *s = state_take(m, a);
    copy(s->q, c->q, m->nq);
    copy(s->qd, c->qd, m->nu);
    copy(s->qdd, c->qdd, m->nu);
    copy(s->tau, c->tau, m->nu);
    if (c->external) copy(state_fext_need(s, m, a), c->external, 6 * m->nbody);
    return s;
}

/* By a scenario's path; read again for the state, since only the spec is kept. */
struct model *vector_model_build(const struct model_spec *spec, struct arena *a, struct err *e)
{
    struct vector_case c;
    return vector_read(spec->path, &c, a, e) ? vector_model(&c, a, e) : NULL;
}

/* The file has been read for the model: it fails here only if it has changed since. */
struct state *vector_state_make(const struct model *m, const struct model_spec *spec,
                                struct arena *a, struct err *e)
{
    struct vector_case c;
    return vector_read(spec->path, &c, a, e) ? vector_state(&c, m, a) : NULL;
}
