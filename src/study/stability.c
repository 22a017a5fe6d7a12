/* stability.c - walks through the scenes; see stability.h.
 *
 * Accelerations come first, by every algorithm; then motions, of stiff scenes by every stepper
 * and of the others to see whether energy is kept. Nothing stops at a failure: failures are what
 * the suite is for. */
#include "study/stability.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/json.h"
#include "base/progress.h"
#include "base/text.h"
#include "study/side_by_side.h"
#include "study/stability_scene.h"

/* Points of a scenario by what their models have: bodies as built, a base that is not fixed. */
static void name_scene(const struct stability_scene *c, const struct model *m, char *name, int size)
{
    static const char *const base[] = {"", ", moving", ", floating"};
    if (!c->complete) snprintf(name, (size_t)size, "%s", c->name);
    else snprintf(name, (size_t)size, "%.40s, n = %d%s", c->name, m->nbody, base[c->spec.base]);
}

/* One scene in an arena of its own; larger ones than most_bodies are left out without an error.
 * Scenes that move are tried with all steppers, others with two of them for their energy. */
static bool measure_scene(struct stability_report *r, const struct stability_scene *c,
                          int most_bodies, struct err *e)
{
    struct arena *a = arena_create();
    struct model *m;
    struct state *s;
    /* good: left out because of its size */
    bool good = (most_bodies > 0 && c->spec.nbody > most_bodies);
    if (!good) {
        good = scene_build(c, a, &m, &s, e);
        char name[64] = "";
        if (good) name_scene(c, m, name, (int)sizeof name);
        if (good) stability_accelerations(r, name, m, s, true, a);
        if (good && c->moves) stability_motion(r, name, m, s, c->spec.damping > 0, a);
        else if (good) stability_energy(r, name, m, s, a);
    }
    arena_destroy(a);
    return good;
}

/* The scenes of a report, and who makes them. */
struct making {
    const struct stability_scene *scene; /* (n) */
    int n, most_bodies;
    struct stability_report *report;     /* all rows, in this process */
    struct stability_report part;        /* those of one scene, where it is made */
    struct progress progress;
};

/* The rows of scene i, without those of the scenes before it. */
static bool make_scene(void *context, int i, const void **data, size_t *bytes, struct err *e)
{
    struct making *k = context;
    k->part.nrow = 0;
    if (!measure_scene(&k->part, &k->scene[i], k->most_bodies, e)) return false;
    *data = k->part.row;
    *bytes = (size_t)k->part.nrow * sizeof *k->part.row;
    return true;
}

/* Behind those of the scenes before it, whoever made them. */
static bool take_scene(void *context, int i, const void *data, size_t bytes, struct err *e)
{
    struct making *k = context;
    (void)e;
    stability_append(k->report, data, (int)(bytes / sizeof(struct stability_row)));
    progress_show(&k->progress, i + 1);
    return true;
}

/* The scenes by their bodies, the largest first: one of them takes as long as all small ones. */
static int *largest_first(const struct stability_scene *scene, int n, struct arena *a)
{
    int *turn = TAKE(a, n, int);
    for (int i = 0; i < n; i++) {
        int at = i;
        for (; at > 0 && scene[turn[at - 1]].spec.nbody < scene[i].spec.nbody; at--)
            turn[at] = turn[at - 1];
        turn[at] = i;
    }
    return turn;
}

/* All scenes; rows are plain structs, so they travel between processes as they are. */
static bool measure_scenes(struct stability_report *r, const struct stability_scene *scene, int n,
                           const struct stability_options *o, struct err *e)
{
    struct making k = {.scene = scene, .n = n, .most_bodies = o->most_bodies, .report = r};
    k.part = (struct stability_report){.arena = arena_create()};
    k.progress = progress_make("scenes", n, o->quiet);
    const struct pieces p = {n, largest_first(scene, n, k.part.arena), &k, make_scene, take_scene};
    const bool good = side_by_side(&p, o->workers, e);
    progress_end(&k.progress);
    arena_destroy(k.part.arena);
    return good;
}

/* The points of a scenario that are different scenes: kernels, levels and processors make no
 * other. */
static bool measure_points(struct stability_report *r, const struct run_spec *spec, int nspec,
                           const struct stability_options *o, struct err *e)
{
    struct stability_scene *scene = TAKE(r->arena, nspec, struct stability_scene);
    int n = 0;
    /* Points that differ in kernel, level or number of processors only are one scene. */
    for (int i = 0; i < nspec; i++) {
        bool seen = false;
        for (int k = 0; k < i && !seen; k++)
            /* Structs are compared as bytes: specs are filled from zeros, so padding is equal. */
            seen = memcmp(&spec[k].model, &spec[i].model, sizeof spec[i].model) == 0;
        if (seen) continue;
        /* A ping-pong computes nothing that could be stiff. */
        if (!kernel_spec_needs_model(&spec[i].kernel))
            return err_set(e, ERR_CONFIG, "kernel '%s' has no scene", spec[i].kernel.name);
        char name[64];
        snprintf(name, sizeof name, "%.28s point %d", spec[i].scenario, i + 1);
        /* A scenario's model says everything: nothing is filled in. Stiffness or damping makes
         * steppers interesting. */
        scene[n++] = (struct stability_scene){
            .name = arena_text(r->arena, name),
            .spec = spec[i].model,
            .complete = true,
            .moves = spec[i].model.stiffness > 0 || spec[i].model.damping > 0};
    }
    return measure_scenes(r, scene, n, o, e);
}

/* Rows are added in the order of scenes and algorithms: the same on every computer. */
bool stability_measure(const struct run_spec *spec, int nspec, const struct stability_options *o,
                       struct arena *a, struct stability_report *r, struct err *e)
{
    /* a scenario's points, or the built-in suite */
    double begin = host_seconds();
    int n;
    const struct stability_scene *suite = scene_list(&n);
    *r = (struct stability_report){.arena = a, .suite = "suite"};
    if (nspec > 0) text_copy(r->suite, sizeof r->suite, spec[0].scenario);
    if (o->scenes > 0) n = o->scenes;
    bool good = nspec > 0 ? measure_points(r, spec, nspec, o, e)
                          : measure_scenes(r, suite + o->first, n, o, e);
    r->host_s = host_seconds() - begin;
    return good;
}

int stability_suite_size(void)
{
    int n;
    scene_list(&n);
    return n;
}

int stability_suite_bodies(int i)
{
    int n;
    return scene_list(&n)[i].spec.nbody;
}

/* --- printing --------------------------------------------------------------------------------- */


/* A line per row, then the counts. A failure of the algorithm is a finding, not an error of the
 * program. */
void stability_print(FILE *out, const struct stability_report *r)
{
    /* Counts by status, in the order of the enum. */
    int count[3] = {0}, by_algorithm = 0;
    columns_title(&stability_columns, out);
    for (int i = 0; i < r->nrow; i++) {
        columns_print(&stability_columns, &r->row[i], out);
        count[r->row[i].status]++;
        by_algorithm += r->row[i].cause == CAUSE_ALGORITHM;
    }
    fprintf(out,
            "\n%d ok, %d degraded, %d failed of %d; in %d cases the cause is the algorithm, not "
            "rounding\n",
            count[0], count[1], count[2], r->nrow, by_algorithm);
}

void stability_print_json(FILE *out, const struct stability_report *r)
{
    struct json j = json_make(out);
    json_object(&j);
    json_key(&j, "rows");
    columns_json_list(&stability_columns, r->row, r->nrow, sizeof *r->row, &j);
    json_key_text(&j, "suite", r->suite);
    json_end(&j);
    json_finish(&j);
}
