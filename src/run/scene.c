/* scene.c - see scene.h. */
#include "run/scene.h"

#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "dynamics/planar_dynamics.h"
#include "dynamics/system.h"
#include "run/omission.h"

/* Bodies: what may stay in memory beside the scene in use. */
enum { MOST_SCENES = 32, MOST_BODIES = 1 << 17 };

struct scene_shelf {
    long clock;
    int nscene;
    struct scene *scene[MOST_SCENES];
};

struct scene_shelf *scene_shelf_create(void)
{
    struct scene_shelf *shelf = calloc(1, sizeof *shelf);
    CHECK(shelf);
    return shelf;
}

static void scene_destroy(struct scene *s) { arena_destroy(s->arena); }

void scene_shelf_destroy(struct scene_shelf *shelf)
{
    for (int i = 0; shelf && i < shelf->nscene; i++) scene_destroy(shelf->scene[i]);
    free(shelf);
}

static struct scene *scene_make(const struct run_spec *spec, struct err *e)
{
    struct arena *a = arena_create();
    struct scene *s = TAKE(a, 1, struct scene);
    s->arena = a;
    s->spec = spec->model;
    s->keep = spec->keep;
    s->still = spec->kernel.steps == 0;
    s->model = model_build(&spec->model, a, e);
    if (s->model) s->state = state_make(s->model, &spec->model, a);
    if (s->state) {
        s->nbody = s->model->nbody;
        s->movable = omission_movable(s->model);
        s->fixed = omission_scene(spec, &s->model, &s->state, a);
        system_prepare(s->model);
        s->state->at_rest = omission_job(spec, s->model, s->state).velocity;
        return s;
    }
    if (s->model) err_set(e, ERR_NO_INPUT, "%s can no longer be read", spec->model.path);
    arena_destroy(a);
    return NULL;
}

/* Give the least recently used scene away, until there is room for one of `nbody` bodies. */
static void make_room(struct scene_shelf *shelf, int nbody)
{
    for (;;) {
        long bodies = nbody;
        int oldest = 0;
        for (int i = 0; i < shelf->nscene; i++) {
            bodies += shelf->scene[i]->model->nbody;
            if (shelf->scene[i]->used < shelf->scene[oldest]->used) oldest = i;
        }
        if (shelf->nscene == 0 || (shelf->nscene < MOST_SCENES && bodies <= MOST_BODIES)) return;
        scene_destroy(shelf->scene[oldest]);
        shelf->scene[oldest] = shelf->scene[--shelf->nscene];
    }
}

struct scene *scene_take(struct scene_shelf *shelf, const struct run_spec *spec, struct err *e)
{
    shelf->clock++;
    for (int i = 0; i < shelf->nscene && !(spec->keep & KEEP_SCENES); i++) {
        struct scene *s = shelf->scene[i];
        if (s->fixed != omission_mergeable(spec, s->nbody, s->movable)) continue;
        if (s->still != (spec->kernel.steps == 0)) continue;
        if (s->keep != spec->keep || memcmp(&s->spec, &spec->model, sizeof s->spec) != 0) continue;
        s->used = shelf->clock;
        return s;
    }
    struct scene *s = scene_make(spec, e);
    if (!s) return NULL;
    make_room(shelf, s->model->nbody);
    s->used = shelf->clock;
    return shelf->scene[shelf->nscene++] = s;
}

/* Room for an answer, and an arena to compute it with; NULL when it has been asked for before. */
static struct arena *ask(struct scene *s, struct serial_answer *x)
{
    if (x->asked) return NULL;
    x->asked = true;
    x->x = TAKE(s->arena, s->model->nu, double);
    return arena_create();
}

const struct serial_answer *scene_inverse(struct scene *s)
{
    struct serial_answer *x = &s->inverse;
    struct arena *scratch = ask(s, x);
    if (!scratch) return x;
    dynamics_type_of(PRECISION_DOUBLE)->inverse(s->model, s->state, scratch, x->x, &x->work);
    x->found = true;
    arena_destroy(scratch);
    return x;
}

const struct serial_answer *scene_forward(struct scene *s, enum forward_method method)
{
    struct serial_answer *x = &s->forward[method];
    struct arena *scratch = ask(s, x);
    if (!scratch) return x;
    x->found = dynamics_type_of(PRECISION_DOUBLE)
                   ->forward(s->model, s->state, method, scratch, x->x, NULL, NULL, &x->work);
    arena_destroy(scratch);
    return x;
}

const struct serial_answer *scene_planar_inverse(struct scene *s)
{
    struct serial_answer *x = &s->planar_inverse;
    struct arena *scratch = ask(s, x);
    if (!scratch) return x;
    planar_inverse(s->model, s->state, scratch, x->x, &x->work);
    x->found = true;
    arena_destroy(scratch);
    return x;
}

const struct serial_answer *scene_planar_forward(struct scene *s)
{
    struct serial_answer *x = &s->planar_forward;
    struct arena *scratch = ask(s, x);
    if (!scratch) return x;
    x->found = planar_forward(s->model, s->state, scratch, x->x, &x->work);
    arena_destroy(scratch);
    return x;
}
