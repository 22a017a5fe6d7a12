/* scenes.c - see scenes.h. The seconds that a choice rests on, those of the network's levels and of
 * omissions, are measured alone: side by side they disturb each other. All else is pieces of one
 * crew, so that no processor is idle while another works at the largest scene.
 *
 * What is stored is not measured again: host times of today would replace those of the study. */
#include "app/scenes.h"

#include <stdlib.h>

#include "app/keep.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "study/savings.h"
#include "study/side_by_side.h"

/* A chain, a floating base, a tree, a loop and a stiff system: one of each kind. */
static const char *const scene[] = {"speedup-t3e", "free-floating", "tree-humanoid", "four-bar",
                                    "stiff-polymer"};
enum { SCENES = sizeof scene / sizeof *scene };

/* The ladders of a scene, and its grades, take about as long as a scene of the suite with so many
 * bodies. */
enum { LADDER_BODIES = 20000, GRADE_BODIES = 10000 };

/* A scene, and what is still to be measured of it. */
struct study {
    struct plan plan;
    bool ladders, grades, omissions;
    struct accuracy_report accuracy; /* the network's levels, then all ladders */
};

/* The pieces: scenes of the suite, then ladders of each scene, then grades of each. */
struct studies {
    const struct common *common;
    struct store *store;
    struct study of[SCENES];
    int nsuite; /* 0: the suite is stored */
    struct stability_report suite;
    struct arena *arena, *part; /* of all reports; of the piece in the making */
    struct progress progress;
};

/* --- what is wanted --------------------------------------------------------------------------- */

/* One row is enough. */
static bool note_row(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)ncolumn;
    (void)name;
    (void)value;
    *(bool *)context = true;
    return false;
}

/* Whether `sql` with this scene has no row yet, or is to be measured in any case (--force). */
static bool is_wanted(const struct studies *k, const char *sql, const char *name, bool *wanted,
                      struct err *e)
{
    bool stored = false;
    bool ok = store_select(k->store, sql, 1, &name, note_row, &stored, e);
    *wanted = !stored || k->common->force;
    return ok;
}

static bool begin_study(struct studies *k, int i, struct err *e)
{
    struct study *x = &k->of[i];
    struct plan_options o = common_plan(k->common);
    bool ok = plan_read(&x->plan, scene[i], &o, e) &&
              is_wanted(k, "SELECT 1 FROM ladder_choice WHERE scenario = ?1", scene[i],
                        &x->ladders, e) &&
              is_wanted(k, "SELECT 1 FROM stability WHERE suite = ?1", scene[i], &x->grades, e) &&
              is_wanted(k, "SELECT 1 FROM omission WHERE scenario = ?1", scene[i], &x->omissions,
                        e);
    return ok && (!x->ladders || accuracy_network(x->plan.run, x->plan.nrun, k->arena,
                                                  &x->accuracy, e));
}

/* --- pieces ----------------------------------------------------------------------------------- */

static bool make_grades(const struct run_spec *spec, int nspec, const struct stability_options *o,
                        struct arena *a, const void **data, size_t *bytes, struct err *e)
{
    struct stability_report r;
    if (!stability_measure(spec, nspec, o, a, &r, e)) return false;
    *data = r.row;
    *bytes = (size_t)r.nrow * sizeof *r.row;
    return true;
}

static bool make_ladders(const struct plan *p, struct arena *a, const void **data, size_t *bytes,
                         struct err *e)
{
    struct accuracy_report r;
    if (!accuracy_programs(p->run, p->nrun, a, &r, e)) return false;
    *data = r.rung;
    *bytes = (size_t)r.nrung * sizeof *r.rung;
    return true;
}

/* Rows or rungs, plain structs that travel between processes as they are. Nothing where it is
 * stored. */
static bool make_piece(void *context, int i, const void **data, size_t *bytes, struct err *e)
{
    struct studies *k = context;
    struct stability_options o = {.workers = 1, .first = i, .scenes = 1, .quiet = true};
    const int of = i - k->nsuite;
    const struct study *x = &k->of[of < 0 ? 0 : of % SCENES];
    *bytes = 0;
    arena_empty(k->part, 0);
    if (of < 0) return make_grades(NULL, 0, &o, k->part, data, bytes, e);
    if (of < SCENES) return !x->ladders || make_ladders(&x->plan, k->part, data, bytes, e);
    return !x->grades || make_grades(x->plan.run, x->plan.nrun, &o, k->part, data, bytes, e);
}

/* Behind the levels, which come first in a report. */
static bool take_ladders(struct studies *k, struct study *x, const void *data, size_t bytes,
                         struct err *e)
{
    if (!x->ladders) return true;
    accuracy_append(&x->accuracy, data, (int)(bytes / sizeof(struct accuracy_rung)));
    accuracy_decide(&x->accuracy, 0);
    return keep_accuracy(k->store, &x->accuracy, e);
}

static bool take_grades(struct studies *k, const struct study *x, const void *data, size_t bytes,
                        struct err *e)
{
    struct stability_report r = {.arena = k->arena};
    if (!x->grades) return true;
    text_copy(r.suite, sizeof r.suite, x->plan.run[0].scenario);
    stability_append(&r, data, (int)(bytes / sizeof(struct stability_row)));
    return keep_stability(k->store, &r, e);
}

/* What is whole is stored; the suite is with its last scene. */
static bool take_piece(void *context, int i, const void *data, size_t bytes, struct err *e)
{
    struct studies *k = context;
    const int of = i - k->nsuite;
    bool ok = true;
    if (of < 0) stability_append(&k->suite, data, (int)(bytes / sizeof(struct stability_row)));
    if (of == -1) ok = keep_stability(k->store, &k->suite, e);
    if (of >= 0 && of < SCENES) ok = take_ladders(k, &k->of[of], data, bytes, e);
    if (of >= SCENES) ok = take_grades(k, &k->of[of - SCENES], data, bytes, e);
    progress_show(&k->progress, i + 1);
    return ok;
}

static int bodies_of(const struct studies *k, int i)
{
    if (i < k->nsuite) return stability_suite_bodies(i);
    return i < k->nsuite + SCENES ? LADDER_BODIES : GRADE_BODIES;
}

/* The longest first: one scene of the suite takes as long as all the others. */
static bool measure_pieces(struct studies *k, struct err *e)
{
    const int n = k->nsuite + 2 * SCENES;
    int *turn = TAKE(k->arena, n, int);
    for (int i = 0; i < n; i++) {
        int at = i;
        for (; at > 0 && bodies_of(k, turn[at - 1]) < bodies_of(k, i); at--)
            turn[at] = turn[at - 1];
        turn[at] = i;
    }
    k->progress = progress_make("scenes", n, k->common->quiet);
    const struct pieces p = {n, turn, k, make_piece, take_piece};
    const bool ok = side_by_side(&p, k->common->jobs, e);
    progress_end(&k->progress);
    return ok;
}

/* --- omissions -------------------------------------------------------------------------------- */

/* What leaving out saves, for each omission of the scenario. */
static bool savings(const struct plan *p, struct store *s, struct err *e)
{
    struct run_estimate *r = memory_zeroed((size_t)p->nrun + 1, sizeof *r);
    struct savings *all = memory_zeroed(1, sizeof *all);
    int64_t work = RUN_EXPLAIN_WORK;
    bool ok = true;
    for (int i = 0; ok && i < p->nrun; i++) ok = run_explain(&p->run[i], &work, &r[i], e);
    ok = ok && savings_measure(p, r, all, e) && savings_store(s, all, e);
    free(all);
    free(r);
    return ok;
}

/* --- the whole -------------------------------------------------------------------------------- */

/* Levels alone, then the crew, then savings alone. */
bool scenes_measure(const struct common *c, struct store *s, struct err *e)
{
    struct studies *k = memory_zeroed(1, sizeof *k);
    *k = (struct studies){
        .common = c, .store = s, .arena = arena_create(), .part = arena_create()};
    k->suite = (struct stability_report){.suite = "suite", .arena = k->arena};
    bool wanted = false;
    bool ok = is_wanted(k, "SELECT 1 FROM stability WHERE suite = ?1", "suite", &wanted, e);
    if (wanted) k->nsuite = stability_suite_size();
    for (int i = 0; ok && i < SCENES; i++) ok = begin_study(k, i, e);
    ok = ok && measure_pieces(k, e);
    for (int i = 0; ok && i < SCENES; i++)
        ok = !k->of[i].omissions || savings(&k->of[i].plan, s, e);
    for (int i = 0; i < SCENES; i++) plan_free(&k->of[i].plan);
    arena_destroy(k->part);
    arena_destroy(k->arena);
    free(k);
    return ok;
}
