/* scenes.c - see scenes.h. One after the other: times that are measured side by side disturb
 * each other.
 *
 * What is stored is not measured again: host times of today would replace those of the study. */
#include "app/scenes.h"

#include <stdlib.h>

#include "app/keep.h"
#include "base/memory.h"
#include "base/progress.h"
#include "study/savings.h"

/* A chain, a floating base, a tree, a loop and a stiff system: one of each kind. */
static const char *const scene[] = {"speedup-t3e", "free-floating", "tree-humanoid", "four-bar",
                                    "stiff-polymer"};
enum { SCENES = sizeof scene / sizeof *scene };

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
static bool is_wanted(const struct common *c, struct store *s, const char *sql, const char *name,
                      bool *wanted, struct err *e)
{
    bool stored = false;
    bool ok = store_select(s, sql, 1, &name, note_row, &stored, e);
    *wanted = !stored || c->force;
    return ok;
}

/* Error against run time of one scenario. */
static bool ladders(const struct common *c, const struct plan *p, struct store *s, const char *name,
                    struct err *e)
{
    bool wanted;
    if (!is_wanted(c, s, "SELECT 1 FROM ladder_choice WHERE scenario = ?1", name, &wanted, e))
        return false;
    if (!wanted) return true;
    struct arena *a = arena_create();
    struct accuracy_report r; /* rows in the arena */
    bool ok = accuracy_measure(p->run, p->nrun, 0, true, a, &r, e) && keep_accuracy(s, &r, e);
    arena_destroy(a);
    return ok;
}

/* Stability: of the scenes of p, or of the built-in suite (p NULL). */
static bool grades(const struct common *c, const struct plan *p, struct store *s, const char *name,
                   struct err *e)
{
    bool wanted;
    if (!is_wanted(c, s, "SELECT 1 FROM stability WHERE suite = ?1", name, &wanted, e))
        return false;
    if (!wanted) return true;
    struct arena *a = arena_create();
    struct stability_report r;
    const struct stability_options o = {.workers = c->jobs, .quiet = p || c->quiet};
    bool ok = stability_measure(p ? p->run : NULL, p ? p->nrun : 0, &o, a, &r, e) &&
              keep_stability(s, &r, e);
    arena_destroy(a);
    return ok;
}

/* What leaving out saves, for each omission of the scenario. */
static bool savings(const struct common *c, const struct plan *p, struct store *s, const char *name,
                    struct err *e)
{
    bool wanted;
    if (!is_wanted(c, s, "SELECT 1 FROM omission WHERE scenario = ?1", name, &wanted, e))
        return false;
    if (!wanted) return true;
    struct run_estimate *r = memory_zeroed((size_t)p->nrun + 1, sizeof *r);
    struct savings *all = memory_zeroed(1, sizeof *all);
    bool ok = true;
    for (int i = 0; ok && i < p->nrun; i++) ok = run_explain(&p->run[i], &r[i], e);
    ok = ok && savings_measure(p, r, all, e) && savings_store(s, all, e);
    free(all);
    free(r);
    return ok;
}

/* The suite, then three studies per scene. */
bool scenes_measure(const struct common *c, struct store *s, struct err *e)
{
    if (!grades(c, NULL, s, "suite", e)) return false;
    /* The suite shows its own progress, the scenes this one. */
    struct progress progress = progress_make("error against run time", SCENES, c->quiet);
    bool ok = true;
    for (int i = 0; ok && i < SCENES; i++) {
        struct plan p = {0}; /* freed below, also when it could not be read */
        struct plan_options o = common_plan(c);
        ok = plan_read(&p, scene[i], &o, e) && ladders(c, &p, s, scene[i], e) &&
             grades(c, &p, s, scene[i], e) && savings(c, &p, s, scene[i], e);
        plan_free(&p);
        progress_show(&progress, i + 1);
    }
    progress_end(&progress);
    return ok;
}
