/* accuracy.c - which points of a scenario its ladders stand at, and the cheapest rung of each;
 * see accuracy.h.
 *
 * A scenario has many points, a ladder takes many evaluations: each ladder is climbed at one
 * point, the largest that takes seconds. Which one that is follows from estimates, so it is the
 * same on every computer. */
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

/* What a choice compares. The network levels simulate one and the same machine, so that only the
 * seconds of this computer differ; the other ladders compare programs, whose cost is the
 * predicted time on the machine. NAN: not known. */
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
        /* `!(cost >= 0)` is true for NAN as well: a rung without a cost cannot be chosen. */
        if (!applies || x->status != RUNG_OK || !(cost_of(x) >= 0)) continue;
        c.at = x->at;
        /* The finest rung has the least error; of rungs with the same error it is the cheaper
         * one. */
        bool finer = !c.finest || x->error < c.finest->error ||
                     (x->error == c.finest->error && cost_of(x) < cost_of(c.finest));
        if (strcmp(ladder, "network") == 0) /* the level itself, not one that happens to agree */
            finer = strcmp(x->method, x->reference) == 0;
        if (finer) c.finest = x;
        /* On a tie of costs the earlier rung stays: rungs are added in a fixed order, so the
         * choice is reproducible. */
        if (x->error <= tolerance && (!c.rung || cost_of(x) < cost_of(c.rung))) c.rung = x;
    }
    /* What accuracy beyond the tolerance would cost. */
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

/* What a ladder's limit counts: messages, bodies or degrees of freedom of one evaluation. */
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
        /* A point within the limit beats one beyond it. Within, the larger one shows more;
         * beyond, the smaller one is the less bad. */
        bool within = x <= most[ladder], best_within = b <= most[ladder];
        if (best < 0 || (within && !best_within) || (!within && !best_within && x < b) ||
            (within && best_within && (x > b || (x == b && spec[i].nrank >= spec[best].nrank))))
            best = i;
    }
    return best;
}

/* The scene of one point in an arena of the ladder's own. The arena exists even when this
 * returns false, since the model cannot be built. */
static bool ladder_begin(struct ladder *l, struct accuracy_report *r, const struct run_spec *spec,
                         int which, int nbody, struct err *e)
{
    *l = (struct ladder){
        .report = r, .name = ladder_name[which], .spec = *spec, .arena = arena_create()};
    level_family(spec, l->family);
    /* The question which level to take is answered by this ladder; a run needs a level. The
     * other ladders take it as it is. */
    if (spec->machine.network.level == LEVEL_AUTO_TOLERANCE)
        l->spec.machine.network.level = LEVEL_LINK;
    if (nbody == spec->nrank) snprintf(l->at, sizeof l->at, "n=P=%d", nbody);
    else if (nbody > 0) snprintf(l->at, sizeof l->at, "n=%d P=%d", nbody, spec->nrank);
    else snprintf(l->at, sizeof l->at, "P=%d", spec->nrank);
    /* A kernel without a model (ping-pong, a collective) has a network ladder only. */
    if (nbody == 0) return true;
    l->model = model_build(&spec->model, l->arena, e);
    if (!l->model) return false;
    system_prepare(l->model);
    l->state = state_make(l->model, &spec->model, l->arena);
    return true;
}

/* One ladder, at its best point. That no point suits it is no error: r->host_s[which] stays 0. */
static bool climb(struct accuracy_report *r, const struct run_spec *spec,
                  const struct run_estimate *size, int nspec, int which, struct err *e)
{
    static void (*const ladder[LADDERS])(struct ladder *) = {ladder_network, ladder_arithmetic,
                                                             ladder_integration};
    int at = point_choose(spec, size, nspec, which);
    if (at < 0) return true;
    struct ladder l;
    double begin = host_seconds();
    /* Time all of it, the scene's construction included: that is what the user waits for. */
    bool good = ladder_begin(&l, r, &spec[at], which, (int)size[at].nbody, e);
    if (good) ladder[which](&l);
    arena_destroy(l.arena);
    r->host_s[which] = host_seconds() - begin;
    return good;
}

/* The sizes of all runs, by their estimates: nothing is simulated to choose a point. */
static bool begin(struct accuracy_report *r, const struct run_spec *spec, int nspec,
                  struct arena *a, struct run_estimate **size, struct err *e)
{
    *r = (struct accuracy_report){.arena = a};
    if (nspec == 0) return err_set(e, ERR_CONFIG, "the scenario has no runs");
    text_copy(r->scenario, sizeof r->scenario, spec[0].scenario);
    *size = TAKE(a, nspec, struct run_estimate);
    int64_t work = RUN_EXPLAIN_WORK;
    for (int i = 0; i < nspec; i++)
        if (!run_explain(&spec[i], &work, &(*size)[i], e)) return false;
    return true;
}

bool accuracy_network(const struct run_spec *spec, int nspec, struct arena *a,
                      struct accuracy_report *r, struct err *e)
{
    struct run_estimate *size = NULL;
    return begin(r, spec, nspec, a, &size, e) && climb(r, spec, size, nspec, NETWORK, e);
}

bool accuracy_programs(const struct run_spec *spec, int nspec, struct arena *a,
                       struct accuracy_report *r, struct err *e)
{
    struct run_estimate *size = NULL;
    return begin(r, spec, nspec, a, &size, e) && climb(r, spec, size, nspec, ARITHMETIC, e) &&
           climb(r, spec, size, nspec, INTEGRATION, e);
}

/* A ladder that was not climbed has nothing to choose from. */
static bool is_climbed(const struct accuracy_report *r, const char *ladder)
{
    for (int i = 0; i < r->nrung; i++)
        if (strcmp(r->rung[i].ladder, ladder) == 0) return true;
    return false;
}

void accuracy_decide(struct accuracy_report *r, double within)
{
    for (int k = 0; k < LADDERS; k++) {
        if (!is_climbed(r, ladder_name[k])) continue;
        r->choice[r->nchoice++] = accuracy_choose(r, ladder_name[k], ladder_quantity[k],
                                                  within > 0 ? within : usual_tolerance[k]);
        /* A tolerance meant for simulated times says little about a motion: its usual one is
         * answered, too. */
        if (k == INTEGRATION && within > 0 && within != usual_tolerance[k])
            r->choice[r->nchoice++] =
                accuracy_choose(r, ladder_name[k], ladder_quantity[k], usual_tolerance[k]);
    }
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
    accuracy_decide(r, within);
    return true;
}
