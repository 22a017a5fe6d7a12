/* urdf_model.h - models made from URDF robots. */
#ifndef MODEL_URDF_MODEL_H
#define MODEL_URDF_MODEL_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"
#include "model/model.h"
#include "model/urdf.h"
#include "spec/model_spec.h"

struct urdf_options {
    bool floating;          /* the root link moves freely; false: it is the base, and no body */
    /* a body for every link; false: links on fixed joints are part of their parents */
    bool keep_fixed;
    bool allow_nonphysical; /* accept inertias that no body has */
    double gravity[3];
};

/* urdf_model: the robot as a model in `a`; bodies in the robot's order. Joint damping acts, limits
 * do not.
 *
 *   Returns NULL with ERR_DATA at the link's line: a moving link without mass or with an inertia
 * that no body has, unless allowed; a negative mass or a number that is not finite, always; nothing
 * moves. */
struct model *urdf_model(const struct urdf_robot *robot, const struct urdf_options *o,
                         struct arena *a, struct err *e);

/* urdf_model_build: the model of the URDF file spec->path with the base and gravity of `spec`,
 * fixed links merged. */
struct model *urdf_model_build(const struct model_spec *spec, struct arena *a, struct err *e);

#endif
