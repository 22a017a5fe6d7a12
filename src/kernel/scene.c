/* scene.c - see scene.h. */
#include "kernel/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/size.h"
#include "dynamics/planar_dynamics.h"
#include "dynamics/system.h"
#include "kernel/divided.h"
#include "kernel/kernel.h"
#include "kernel/omission.h"
#include "model/model_part.h"
#include "spec/program_list.h"

/* What may stay in memory beside the scene in use: scenes, and bodies of all of them together. */
enum { MOST_SCENES = 32, MOST_BODIES = 1 << 17 };

/* One cache for each worker, which has one run at a time: no lock is needed. */
struct program_cache {
    long clock;
    int nscene;
    struct scene *scene[MOST_SCENES];
};

struct program_cache *scene_cache_create(void)
{
    struct program_cache *cache = memory_zeroed(1, sizeof *cache);
    return cache;
}

void scene_destroy(struct scene *s)
{
    if (s) arena_destroy(s->arena);
}

void scene_cache_destroy(struct program_cache *cache)
{
    for (int i = 0; cache && i < cache->nscene; i++) scene_destroy(cache->scene[i]);
    free(cache);
}

/* Bytes of a body that no run was seen to need less than (host_peak_bytes), ranks included. */
enum { LEAST_BODY_BYTES = 1200, LEAST_FORWARD_BODY_BYTES = 3500 };

/* Of 10^7 bodies, asked for by a line of text, none is made when they cannot fit: making them takes
 * minutes, and the memory of everybody else. */
bool scene_fits(const struct run_spec *spec, int n, struct err *e)
{
    const enum model_generator made = spec->model.generator;
    if (made == MODEL_URDF || made == MODEL_VECTOR) return true;
    const bool forward = kernel_spec_has(&spec->kernel, PROGRAM_FORWARD);
    const int each = forward ? LEAST_FORWARD_BODY_BYTES : LEAST_BODY_BYTES;
    char what[64];
    snprintf(what, sizeof what, "a run of %d bodies", n);
    return size_in_memory(size_product((size_t)n, (size_t)each), "", 0, what, e);
}

/* All bodies, or those of a part's ranks. */
static struct model *make_model(const struct run_spec *spec, const struct run_part *part,
                                struct arena *a, struct err *e)
{
    if (!part) return model_build(&spec->model, a, e);
    return model_part(&spec->model, kernel_block(spec->model.nbody, spec->nrank, part->first),
                      kernel_block(spec->model.nbody, spec->nrank, part->end), a, e);
}

/* One arena per scene, so that giving it away is one call. What can be left out is decided here,
 * once for all runs that share the scene. */
static struct scene *scene_make(const struct run_spec *spec, unsigned keep,
                                const struct run_part *part, struct err *e)
{
    struct arena *a = arena_create();
    struct scene *s = TAKE(a, 1, struct scene);
    s->arena = a;
    s->spec = spec->model;
    s->keep = keep;
    s->still = spec->kernel.steps == 0;
    s->model = make_model(spec, part, a, e);
    if (s->model) s->state = state_make(s->model, &spec->model, a);
    if (part && !divided_agree(part, s->model, s->state)) {
        err_clear(e);
        arena_destroy(a);
        return NULL;
    }
    if (s->state) {
        s->first = s->model->first;
        s->end = s->model->end;
        s->nbody = s->model->nbody;
        s->movable = omission_movable(s->model);
        s->mergeable = omission_mergeable(spec->nrank, keep, s->nbody, s->movable);
        s->fixed = omission_scene(spec->nrank, keep, &s->model, &s->state, a);
        system_prepare(s->model);
        s->state->at_rest = omission_job(spec, keep, s->model, s->state).velocity;
        return s;
    }
    /* The model was read when the scenario was planned; the file has gone since. */
    if (s->model) err_set(e, ERR_NO_INPUT, "%s can no longer be read", spec->model.path);
    arena_destroy(a);
    return NULL;
}

struct scene *scene_create(const struct run_spec *spec, unsigned keep, struct err *e)
{
    return scene_make(spec, keep, NULL, e);
}

/* The last scene takes its place: order is kept by `used`, not by position. */
static void give_away(struct program_cache *cache, int i)
{
    scene_destroy(cache->scene[i]);
    cache->scene[i] = cache->scene[--cache->nscene];
}

/* Give the least recently used scene away, by the cache's own clock and no host time, until
 * there is room for one of `nbody` bodies. */
static void make_room(struct program_cache *cache, int nbody)
{
    for (;;) {
        long bodies = nbody;
        int oldest = 0;
        for (int i = 0; i < cache->nscene; i++) {
            bodies += cache->scene[i]->model->nbody;
            if (cache->scene[i]->used < cache->scene[oldest]->used) oldest = i;
        }
        if (cache->nscene == 0 || (cache->nscene < MOST_SCENES && bodies <= MOST_BODIES)) return;
        give_away(cache, oldest);
    }
}

/* The number of the cached scene that `spec` asks for, -1: none. A scene depends on the model's
 * description, on what is kept, on whether anything moves, and on how many fixed bodies may be
 * merged, which depends on P. Everything else of a spec may differ. */
static int find(const struct program_cache *cache, const struct run_spec *spec, unsigned keep,
                const struct run_part *part)
{
    const int n = spec->model.nbody;
    const int first = part ? kernel_block(n, spec->nrank, part->first) : 0,
              end = part ? kernel_block(n, spec->nrank, part->end) : n;
    for (int i = 0; i < cache->nscene && !(keep & KEEP_SCENES); i++) {
        const struct scene *s = cache->scene[i];
        /* P may leave fewer bodies to merge than the cached scene has merged. */
        if (s->mergeable != omission_mergeable(spec->nrank, keep, s->nbody, s->movable)) continue;
        /* What is at rest now may move after the first time step. */
        if (s->still != (spec->kernel.steps == 0)) continue;
        const bool whole = !part && s->end - s->first == s->nbody;
        if (!whole && (s->first != first || s->end != end)) continue;
        /* The whole description counts, field by field, so its bytes are compared. */
        if (s->keep != keep || memcmp(&s->spec, &spec->model, sizeof s->spec) != 0) continue;
        return i;
    }
    return -1;
}

struct scene *scene_take(struct program_cache *cache, const struct run_spec *spec, unsigned keep,
                         const struct run_part *part, struct err *e)
{
    cache->clock++;
    int i = find(cache, spec, keep, part);
    /* Process 0 may have given its part away for a run that it made alone. Then all make theirs
     * again, so that they ask each other the same questions. */
    if (part && !divided_all(part, i >= 0) && i >= 0) {
        give_away(cache, i);
        i = -1;
    }
    if (i < 0) {
        struct scene *s = scene_make(spec, keep, part, e);
        if (!s) return NULL;
        /* Only when the new scene exists is an old one given away. */
        make_room(cache, s->model->nbody);
        i = cache->nscene++;
        cache->scene[i] = s;
    }
    cache->scene[i]->used = cache->clock;
    return cache->scene[i];
}

/* Room for an answer, and an arena to compute it with; NULL when it has been asked for before: the
 * answer, or the failure to get one, is then there already. */
static struct arena *ask(struct scene *s, struct serial_answer *x)
{
    if (x->asked) return NULL;
    x->asked = true;
    x->x = TAKE(s->arena, s->model->nu, double);
    return arena_create();
}

/* Serial answers are computed when the first run asks for them, in an arena of their own that is
 * freed at once; only the answer stays with the scene. */
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

/* The same for planar scenes; a run asks for one kind or the other. */
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
