/* system.c - see system.h. */
#include "dynamics/system.h"

#include "dynamics/integrate.h"

/* Once a model, in double: every run of it reads these. */
void system_prepare(struct model *m)
{
    m->constants = NULL; /* bodies_make would hand the old ones back */
    m->constants = bodies_make(m, m->arena);
}

/* Random velocities made consistent with the loops.
 * A ring's seeded rates violate its closure; the nearest rates that do not are taken. */
static void close_velocities(const struct model *m, struct state *s, struct arena *a)
{
    struct arena_mark mark = arena_mark(a);
    struct dynamics *d = dynamics_take(m, a);
    loop_project(d, s->q, s->qd, 0, NULL);
    arena_release(a, mark);
}

/* Loops are a matter of dynamics, seeds one of models. */
struct state *state_make(const struct model *m, const struct model_spec *spec, struct arena *a)
{
    struct state *s = state_given(m, spec, a);
    if (s && spec->generator == MODEL_RING) close_velocities(m, s, a);
    return s;
}
