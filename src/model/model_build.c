/* model_build.c - from a spec to a model and its state: which reader or generator. */
#include "model/generator.h"
#include "model/model_part.h"
#include "model/urdf_model.h"
#include "model/vector_model.h"

/* Sources with a file have readers; all others are a matter of numbers. */
struct model *model_build(const struct model_spec *spec, struct arena *a, struct err *e)
{
    switch (spec->generator) {
    case MODEL_URDF: return urdf_model_build(spec, a, e);
    case MODEL_VECTOR: return vector_model_build(spec, a, e);
    default: return generator_model(spec, a, e);
    }
}

bool model_divides(const struct model_spec *spec)
{
    return spec->generator == MODEL_SERIAL_CHAIN && spec->joint == JOINT_REVOLUTE &&
           spec->base != BASE_FLOATING;
}

bool model_all_revolute(const struct model *m)
{
    for (int i = m->first; i < m->end; i++)
        if (m->body[i].joint != JOINT_REVOLUTE) return false;
    return true;
}

struct model *model_part(const struct model_spec *spec, int first, int end, struct arena *a,
                         struct err *e)
{
    return generator_part(spec, first, end, a, e);
}

/* Vectors bring states of their own; all else is seeded. */
struct state *state_given(const struct model *m, const struct model_spec *spec, struct arena *a)
{
    if (spec->generator != MODEL_VECTOR) return state_generate(m, spec, a);
    struct err e;
    err_clear(&e);
    return vector_state_make(m, spec, a, &e);
}
