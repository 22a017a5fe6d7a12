/* scene.h - a model in its state with its serial answers, made once for all runs of a campaign that
 * need it.
 *
 * Runs that differ in machine, network, processors or solver have the same scene: its model, the
 * answers that theirs are held against and the work of the serial codes. Sharing them changes no
 * result. */
#ifndef KERNEL_SCENE_H
#define KERNEL_SCENE_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"
#include "dynamics/dynamics_table.h"
#include "model/model.h"
#include "program/program.h"
#include "spec/run_spec.h"

struct serial_answer {
    bool asked, found;       /* found: false when the method broke down */
    double *x;               /* (nu) */
    struct work work;
};

struct scene {
    struct model *model;     /* as kernel/omission.h leaves it */
    struct state *state;
    struct arena *arena;     /* owned */
    struct model_spec spec;  /* what it was made from */
    unsigned keep;
    int first, end;          /* bodies that are here, of model->nbody */
    bool still;              /* made for one evaluation: what is at rest stays so */
    int nbody, movable;      /* bodies as described; those on joints that move */
    int mergeable;           /* the others, where P lets them become part of these; otherwise 0 */
    int fixed;               /* those that have; a loop may be in the way */
    long used;               /* when it was last asked for */
    struct serial_answer inverse, forward[FORWARD_METHODS]; /* in double precision */
    struct serial_answer planar_inverse, planar_forward;     /* the same in three components */
};

/* scene_cache_create, scene_cache_destroy: a few scenes, the least recently used making room for
 * new ones. The caller owns it; destroy accepts NULL. */
struct program_cache *scene_cache_create(void);
void scene_cache_destroy(struct program_cache *cache);

/* scene_fits: whether the system has memory for a run with `n` bodies of the kind that `spec` asks
 * for; *e says how much is missing. Files are as large as their models: always true. */
bool scene_fits(const struct run_spec *spec, int n, struct err *e);

/* scene_take: the scene that `spec` asks for, with what `keep` (KEEP_* of the order) puts back,
 * from the cache or made now; borrowed until the next call. `part`: not NULL, what ranks of that
 * part need of it, on all processes or, where one of them cannot make its part, on none (NULL
 * without an error). NULL with *e set when it cannot be built. */
struct scene *scene_take(struct program_cache *cache, const struct run_spec *spec, unsigned keep,
                         const struct run_part *part, struct err *e);

/* scene_create, scene_destroy: all of a scene, of which no cache knows. The caller owns it; NULL
 * with *e set as above. destroy accepts NULL. */
struct scene *scene_create(const struct run_spec *spec, unsigned keep, struct err *e);
void scene_destroy(struct scene *s);

/* scene_inverse: joint forces for the state's accelerations by recursive Newton-Euler.
 * scene_forward: accelerations by `method`. Computed at the first call. */
const struct serial_answer *scene_inverse(struct scene *s);
const struct serial_answer *scene_forward(struct scene *s, enum forward_method method);

/* scene_planar_inverse, scene_planar_forward: by recursive Newton-Euler and by articulated bodies
 * of three components, for scenes that are planar (dynamics/planar.h). */
const struct serial_answer *scene_planar_inverse(struct scene *s);
const struct serial_answer *scene_planar_forward(struct scene *s);

#endif
