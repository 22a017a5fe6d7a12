/* scene.h - seeded systems for the tests of room dynamics: all joint types, chains and trees, every
 * kind of base. */
#ifndef TESTS_MECH_SCENE_H
#define TESTS_MECH_SCENE_H

#include "base/arena.h"
#include "model/model.h"

struct scene {
    struct arena *a;
    struct model *model;
    struct state *state;
};

/* scene_of: the scene of a spec; fails the test with the message when it cannot be made. End with
 * scene_end. */
struct scene scene_of(const struct model_spec *spec);
void scene_end(struct scene *s);

/* spec_random: a spec with random inertias and pose, gravity, rates, torques and external
 * forces. */
struct model_spec spec_random(enum model_generator generator, int nbody, enum model_joint joint,
                              uint64_t seed);

/* largest |x - y| over the largest |y| of n numbers; infinite when not finite. */
double relative_error(int n, const double *x, const double *y);

#endif
