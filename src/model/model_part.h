/* model_part.h - models of which only some bodies are here, for processes that share a scene.
 *
 * State and loads are of a part's own bodies, first .. end - 1. Of the one beside it on each side,
 * with which its ranks exchange messages, the constants are here as well. */
#ifndef MODEL_MODEL_PART_H
#define MODEL_MODEL_PART_H

#include "model/model.h"

/* model_divides: whether bodies of the system that `spec` asks for can be made without the others:
 * generated chains whose joints are all revolute. */
bool model_divides(const struct model_spec *spec);

/* model_part: the system of which bodies first .. end - 1 are here. Whether others have an inertia
 * to invert is not known: has_phi is that of the part. NULL as model_build. */
struct model *model_part(const struct model_spec *spec, int first, int end, struct arena *a,
                         struct err *e);

/* model_whole: whether all bodies are here. */
static inline bool model_whole(const struct model *m) { return m->end - m->first == m->nbody; }

/* model_known_first, model_known_end: the bodies whose constants are here. */
static inline int model_known_first(const struct model *m)
{
    return m->first > 0 ? m->first - 1 : 0;
}
static inline int model_known_end(const struct model *m)
{
    return m->end < m->nbody ? m->end + 1 : m->nbody;
}

#endif
