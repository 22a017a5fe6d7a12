/* scene.c - seeded systems for tests. */
#include "dynamics/system.h"
#include "scene.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

struct scene scene_of(const struct model_spec *spec)
{
    struct scene s = {.a = arena_create()};
    struct err e;
    err_clear(&e);
    s.model = model_build(spec, s.a, &e);
    if (!s.model) fail_msg("%s", e.text);
    s.state = state_make(s.model, spec, s.a);
    return s;
}

void scene_end(struct scene *s) { arena_destroy(s->a); }

struct model_spec spec_random(enum model_generator generator, int nbody, enum model_joint joint,
                              uint64_t seed)
{
    return (struct model_spec){.generator = generator,
                               .nbody = nbody,
                               .joint = joint,
                               .base = BASE_FIXED,
                               .inertia = INERTIA_RANDOM,
                               .pose = POSE_RANDOM,
                               .axes = AXES_TWISTED,
                               .length = 1,
                               .radius = 0.05,
                               .mass = 1,
                               .mass_ratio = 10,
                               .gravity = {1, -2, -9.81},
                               .rate = 1,
                               .torque = 1,
                               .external_force = 1,
                               .branch = 2,
                               .seed = seed};
}

double relative_error(int n, const double *x, const double *y)
{
    double difference = 0, size = 0;
    for (int i = 0; i < n; i++) {
        double d = fabs(x[i] - y[i]);
        if (!(d <= difference)) difference = isnan(d) ? INFINITY : d;
        size = fmax(size, fabs(y[i]));
    }
    return size > 0 ? difference / size : difference;
}
