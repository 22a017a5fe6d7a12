/* accuracy.c - which points of a scenario its ladders stand at, and the cheapest rung of each; see
 * accuracy.h. */
#include "study/accuracy.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/progress.h"
#include "base/text.h"
#include "dynamics/system.h"
#include "run/run.h"
#include "study/accuracy_ladder.h"
#include "study/level_choice.h"

/* --- the cheapest rung ------------------------------------------------------------------------ */

static double cost_of(const struct accuracy_rung *x)
{
    if (strcmp(x->ladder, "network") == 0) return x->host_s;
    return x->machine_ps >= 0 ? (double)x->machine_ps : NAN;
}

struct accuracy_choice accuracy_choose(const struct accuracy_report *r, const char *ladder,
                                       const char *quantity, double tolerance)
{
    struct accuracy_choice c = {
        .ladder = ladder, .at = "", .quantity = quantity, .tolerance = tolerance};
    for (int i = 0; i < r->nrung; i++) {
        const struct accuracy_rung *x = &r->rung[i];
        bool applies = strcmp(x->ladder, ladder) == 0 && strcmp(x->quantity, quantity) == 0;
        if (!applies || x->status != RUNG_OK || !(cost_of(x) >= 0)) continue;
        c.at = x->at;
        bool finer = !c.finest || x->error < c.finest->error ||
                     (x->error == c.finest->error && cost_of(x) < cost_of(c.finest));
        if (strcmp(ladder, "network") == 0) /* the level itself, not one that happens to agree */
            finer = strcmp(x->method, x->reference) == 0;
        if (finer) c.finest = x;
        if (x->error <= tolerance && (!c.rung || cost_of(x) < cost_of(c.rung))) c.rung = x;
    }
    if (c.rung && c.finest && cost_of(c.rung) > 0)
        c.cost_ratio = cost_of(c.finest) / cost_of(c.rung);
    return c;
}

/* --- points ----------------------------------------------------------------------------------- */

/* Limits that keep each ladder to seconds: messages of one evaluation, bodies, degrees of
 * freedom. */
enum { MOST_MESSAGES = 20000, MOST_BODIES = 256, MOST_MOVING = 40 };

enum { NETWORK, ARITHMETIC, INTEGRATION, LADDERS };
static const char *const ladder_name[LADDERS] = {"network", "arithmetic", "integration"};
static const char *const ladder_quantity[LADDERS] = {"makespan", "qdd", "state"};
static const double usual_tolerance[LADDERS] = {0.02, 1e-10, 1e-6};

static double size_of(int ladder, const struct run_estimate *x)
{
    if (ladder == NETWORK) return x->messages;
    return ladder == ARITHMETIC ? (double)x->nbody : (double)x->nu;
}

/* The largest point within the limit, the smallest of all when none is; of equal ones the last with
 * most ranks. -1: this ladder needs a model and there is none. */
static int point_choose(const struct run_spec *spec, const struct run_estimate *size, int nspec,
                        int ladder)
{
    static const double most[LADDERS] = {MOST_MESSAGES, MOST_BODIES, MOST_MOVING};
    int best = -1;
    for (int i = 0; i < nspec; i++) {
        if (ladder != NETWORK && size[i].nu == 0) continue;
        double x = size_of(ladder, &size[i]), b = best >= 0 ? size_of(ladder, &size[best]) : 0;
        bool within = x <= most[ladder], best_within = b <= most[ladder];
        if (best < 0 || (within && !best_within) || (!within && !best_within && x < b) ||
            (within && best_within && (x > b || (x == b && spec[i].nrank >= spec[best].nrank))))
            best = i;
    }
    return best;
}

static bool ladder_begin(struct ladder *l, struct accuracy_report *r, const struct run_spec *spec,
                         int which, int nbody, struct err *e)
{
    *l = (struct ladder){
        .report = r, .name = ladder_name[which], .spec = *spec, .arena = arena_create()};
    level_family(spec, l->family);
    if (spec->machine.network.level == LEVEL_AUTO_TOLERANCE)
        l->spec.machine.network.level = LEVEL_LINK;
    if (nbody == spec->nrank) snprintf(l->at, sizeof l->at, "n=P=%d", nbody);
    else if (nbody > 0) snprintf(l->at, sizeof l->at, "n=%d P=%d", nbody, spec->nrank);
    else snprintf(l->at, sizeof l->at, "P=%d", spec->nrank);
    if (nbody == 0) return true;
    l->model = model_build(&spec->model, l->arena, e);
    if (!l->model) return false;
    system_prepare(l->model);
    l->state = state_make(l->model, &spec->model, l->arena);
    return true;
}

static bool climb(struct accuracy_report *r, const struct run_spec *spec,
                  const struct run_estimate *size, int nspec, int which, struct err *e)
{
    static void (*const ladder[LADDERS])(struct ladder *) = {ladder_network, ladder_arithmetic,
                                                             ladder_integration};
    int at = point_choose(spec, size, nspec, which);
    if (at < 0) return true;
    struct ladder l;
    double begin = host_seconds();
    bool good = ladder_begin(&l, r, &spec[at], which, (int)size[at].nbody, e);
    if (good) ladder[which](&l);
    arena_destroy(l.arena);
    r->host_s[which] = host_seconds() - begin;
    return good;
}

static bool begin(struct accuracy_report *r, const struct run_spec *spec, int nspec,
                  struct arena *a, struct run_estimate **size, struct err *e)
{
    *r = (struct accuracy_report){.arena = a};
    if (nspec == 0) return err_set(e, ERR_CONFIG, "the scenario has no runs");
    text_copy(r->scenario, sizeof r->scenario, spec[0].scenario);
    *size = TAKE(a, nspec, struct run_estimate);
    for (int i = 0; i < nspec; i++)
        if (!run_explain(&spec[i], &(*size)[i], e)) return false;
    return true;
}

bool accuracy_network(const struct run_spec *spec, int nspec, struct arena *a,
                      struct accuracy_report *r, struct err *e)
{
    struct run_estimate *size = NULL;
    return begin(r, spec, nspec, a, &size, e) && climb(r, spec, size, nspec, NETWORK, e);
}

bool accuracy_measure(const struct run_spec *spec, int nspec, double within, bool quiet,
                      struct arena *a, struct accuracy_report *r, struct err *e)
{
    struct run_estimate *size = NULL;
    if (!begin(r, spec, nspec, a, &size, e)) return false;
    struct progress p = progress_make("ladders", LADDERS, quiet);
    for (int k = 0; k < LADDERS; k++) {
        if (!climb(r, spec, size, nspec, k, e)) return false;
        progress_show(&p, k + 1);
    }
    progress_end(&p);
    for (int k = 0; k < LADDERS; k++) {
        if (r->host_s[k] == 0) continue;
        r->choice[r->nchoice++] = accuracy_choose(r, ladder_name[k], ladder_quantity[k],
                                                  within > 0 ? within : usual_tolerance[k]);
        if (k == INTEGRATION && within > 0 && within != usual_tolerance[k])
            r->choice[r->nchoice++] =
                accuracy_choose(r, ladder_name[k], ladder_quantity[k], usual_tolerance[k]);
    }
    return true;
}
