/* planar_models.h - seeded random planar scenes whose plane, frames and offsets lie anyhow in
 * space. */
#ifndef TESTS_SUPPORT_PLANAR_MODELS_H
#define TESTS_SUPPORT_PLANAR_MODELS_H

#include "base/arena.h"
#include "model/model.h"

struct planar_options {
    int n;
    bool tree;              /* parents anywhere; otherwise a chain */
    enum model_joint joint; /* JOINT_MIXED: revolute, prismatic, planar and fixed ones */
    bool springs, loads;    /* loads: external wrenches and a moving base */
    double tilt;            /* of the last body's axis out of the plane */
    int loops;              /* joints that close loops, between random bodies and the base */
    bool twins;             /* every loop twice */
    uint64_t seed;
};

/* planar_model: body frames turned anyhow, offsets and centres of mass off the plane, full
 * inertias, half of the axes against the normal. */
const struct model *planar_model(const struct planar_options *o, struct arena *a);

/* planar_state: random coordinates, rates, accelerations, forces; gravity is the model's. */
struct state *planar_state(const struct planar_options *o, const struct model *m, struct arena *a);

#endif
