/* explain_search.c - one axis at a time, simplexes from several starts, and what can be taken
 * back; see explain_search.h. */
#include "app/explain_search.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multimin.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/gsl_errors.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/random.h"

/* --- choices ---------------------------------------------------------------------------------- */

static const char *const baselines[EXPLAIN_BASELINES] = {
    "fastest serial", "rnea+aba", "rnea+crba", "rnea+cfa-paper", "rnea+cfa-direct",
    "parallel code on one processor"};

const char *explain_baseline(int i) { return baselines[i]; }

const char *explain_baseline_of(const struct claim_rule *rule)
{
    for (int i = 0; i < EXPLAIN_BASELINES; i++)
        if (strncmp(rule->designated, baselines[i], strlen(baselines[i])) == 0 &&
            strchr(", ", rule->designated[strlen(baselines[i])]))
            return baselines[i];
    return NULL;
}

/* Where the word for the operators stands at the end of a variant's name; its end when it names
 * none. */
static size_t operators_at(const char *variant)
{
    static const char *const word[] = {"structured", "dense"};
    size_t n = strlen(variant);
    for (int i = 0; i < 2; i++)
        if (n >= strlen(word[i]) && strcmp(variant + n - strlen(word[i]), word[i]) == 0)
            return n - strlen(word[i]);
    return n;
}

bool explain_own_operators(const struct claim_rule *rule, enum operators operators)
{
    const char *word = rule->designated + operators_at(rule->designated);
    return *word == '\0' || (strcmp(word, "dense") == 0) == (operators == OPERATORS_DENSE);
}

void explain_variant(const struct claim_rule *rule, const char *baseline, enum operators operators,
                     struct text *out)
{
    const char *own = explain_baseline_of(rule);
    size_t end = operators_at(rule->designated), begin = own && baseline ? strlen(own) : 0;
    if (begin) text_add(out, "%s", baseline); /* another one in the place of its own */
    text_add(out, "%.*s", (int)(end - begin), rule->designated + begin);
    if (rule->designated[end]) text_add(out, operators == OPERATORS_DENSE ? "dense" : "structured");
}

/* --- grades ----------------------------------------------------------------------------------- */

/* What a stored point says of one claim in one variant; NULL: that was not judged there. */
static const struct explain_verdict *verdict_of(const struct explain_point *p, int rule,
                                                const char *variant)
{
    for (int i = 0; i < p->nverdict; i++)
        if (p->verdict[i].rule == rule && strcmp(p->verdict[i].variant, variant) == 0)
            return &p->verdict[i];
    return NULL;
}

/* The worst of all claims with this baseline. */
static struct explain_grade grade_with(const struct explain_goal *g, const struct explain_point *p,
                                       const char *baseline)
{
    struct explain_grade w = {
        .holds = true, .margin = INFINITY, .value = NAN, .baseline = baseline};
    for (int i = 0; i < g->subject->nrule; i++) {
        struct text name = {0};
        explain_variant(g->subject->rule[i], baseline, g->operators, &name);
        const struct explain_verdict *v = verdict_of(p, i, name.s);
        text_free(&name);
        w.holds = w.holds && v && v->told && v->holds; /* all claims, and all of them told */
        double margin = v ? v->margin : NAN; /* a variant that the claim does not have */
        if (!(margin >= w.margin) && !isnan(w.margin))
            w.margin = margin, w.value = v ? v->value : NAN, w.rule = i;
    }
    return w;
}

/* Whether another serial code could make one of these claims hold: some compare with none. */
static bool any_baseline(const struct explain_subject *s)
{
    for (int i = 0; i < s->nrule; i++)
        if (explain_baseline_of(s->rule[i])) return true;
    return false;
}

/* Whether this style of operators is the one that a claim's own verdict rests on. */
static bool own_operators(const struct explain_goal *g)
{
    for (int i = 0; i < g->subject->nrule; i++)
        if (explain_own_operators(g->subject->rule[i], g->operators)) return true;
    return false;
}

/* An order without ties of opinion: whatever holds, then the smallest change, then the smallest
 * lack. A margin that is not known is the worst. */
bool explain_better(const struct explain_grade *a, const struct explain_grade *b)
{
    if (a->holds != b->holds) return a->holds; /* what holds is always better */
    if (a->holds) return a->distance < b->distance; /* then the smaller change */
    if (isnan(a->margin) || isnan(b->margin)) return !isnan(a->margin);
    return a->margin > b->margin;
}

/* The best that can be said of a point: with the claim's own baseline, or another one, whose price
 * is a longer way from the paper. */
struct explain_grade explain_grade_point(const struct explain_goal *g,
                                         const struct explain_point *p, const double *u)
{
    double distance = explain_space_distance(&g->subject->space, u);
    struct explain_grade best = grade_with(g, p, NULL);
    distance += own_operators(g) ? 0 : log(2); /* another style counts as a factor of 2 */
    best.distance = distance;
    for (int i = 0; !g->own && any_baseline(g->subject) && i < EXPLAIN_BASELINES; i++) {
        struct explain_grade other = grade_with(g, p, baselines[i]);
        other.distance = distance + log(2); /* and so does another baseline */
        if (explain_better(&other, &best)) best = other;
    }
    return best;
}

/* --- one look at a point ---------------------------------------------------------------------- */

/* What a round of one search asks for. */
struct round {
    struct explain_search *search;
    struct explain_request *request; /* of all searches, growing */
    int *nrequest, most;
    bool waiting;    /* a value is missing: what follows from it is not looked at */
    bool collecting; /* but these points do not depend on each other */
};

/* One point more for the next campaign, unless somebody has asked for it: points are simulated
 * together, since runs are what a search costs. */
static void ask(struct round *r, const double *u)
{
    struct explain_goal *g = &r->search->goal;
    for (int i = 0; i < *r->nrequest; i++)
        if (r->request[i].subject == g->subject && r->request[i].operators == g->operators &&
            memcmp(r->request[i].u, u, sizeof r->request[i].u) == 0)
            return;
    if (*r->nrequest == r->most) return; /* in a later round */
    struct explain_request *q = &r->request[(*r->nrequest)++];
    q->subject = g->subject;
    q->operators = g->operators;
    memcpy(q->u, u, sizeof q->u);
}

/* Keeps the better one. */
static void consider(struct explain_best *best, const double *u, const struct explain_grade *grade)
{
    if (best->any && !explain_better(grade, &best->grade)) return;
    best->any = true;
    best->grade = *grade;
    memcpy(best->u, u, sizeof best->u);
}

/* The grade of u, snapped; false when it has to be made first. */
static bool look(struct round *r, double *u, struct explain_grade *grade)
{
    struct explain_search *s = r->search;
    explain_space_snap(&s->goal.subject->space, u);
    const struct explain_point *p = explain_known(s->goal.subject, s->goal.operators, u);
    if (!p) {
        ask(r, u);
        return false;
    }
    *grade = explain_grade_point(&s->goal, p, u);
    consider(&s->best, u, grade);
    return true;
}

/* --- one axis alone --------------------------------------------------------------------------- */

/* What the end of axis i alone does to the margin. */
static void weigh(struct explain_search *s, int i, double end, const struct explain_grade *grade)
{
    double change = grade->margin - s->nominal; /* against the nominal point */
    if (isnan(change)) return; /* a margin that is not told weighs nothing */
    s->swing[i] = fmax(s->swing[i], fabs(change));
    if (change > s->gain[i]) s->gain[i] = change, s->end[i] = end; /* the better of the two ends */
}

/* From where the claim fails on axis i alone to where it holds: where it begins to, by
 * bisection. */
static bool scan_boundary(struct round *r, int i, double fails, double holds)
{
    enum { HALVINGS = 7 }; /* to 1/128 of the axis */
    struct explain_search *s = r->search;
    struct explain_grade grade;
    for (int k = 0; k < HALVINGS; k++) {
        double u[EXPLAIN_MOST_AXES] = {0};
        u[i] = 0.5 * (fails + holds);
        if (!look(r, u, &grade)) return false;
        if (grade.holds) holds = u[i], consider(&s->single, u, &grade);
        else fails = u[i];
    }
    return true;
}

/* A claim with two bounds may hold between nothing and an end at which it fails: small changes are
 * doubled while they bring it nearer, then the best margin is sought between its neighbours. */
static bool scan_between(struct round *r, int i, double end, double margin_at_end)
{
    enum { DOUBLINGS = 5, HALVES = 6 }; /* from 1/32 of the axis */
    double best = r->search->nominal, low = 0, at = 0, high = ldexp(end, -DOUBLINGS);
    bool rises = true; /* still doubling */
    for (int k = 0; k < DOUBLINGS + HALVES; k++) {
        double u[EXPLAIN_MOST_AXES] = {0}, x;
        struct explain_grade grade;
        /* Outwards first; then the middles of both sides in turn. A margin that rises to the end
         * has no peak. */
        if (!rises && at == 0) return true;
        if (rises && k >= DOUBLINGS && margin_at_end > best) return true;
        rises = rises && k < DOUBLINGS;
        x = u[i] = rises ? high : k % 2 ? 0.5 * (low + at) : 0.5 * (at + high);
        if (!look(r, u, &grade)) return false;
        if (grade.holds) consider(&r->search->single, u, &grade);
        if (grade.holds) return scan_boundary(r, i, fabs(x) > fabs(at) ? at : low, u[i]);
        if (grade.margin > best) {
            if (fabs(x) < fabs(at)) high = at;
            else low = at, high = rises ? 2 * x : high;
            best = grade.margin, at = x;
        } else if (!rises) *(fabs(x) > fabs(at) ? &high : &low) = x;
        else rises = false;
    }
    return true;
}

/* From nothing to the end of axis i: where the claim begins to hold. */
static bool scan_axis(struct round *r, int i, double end)
{
    struct explain_search *s = r->search;
    struct explain_grade grade;
    double u[EXPLAIN_MOST_AXES] = {0};
    /* The ends are enough where starts are given, and of claims that can never hold. */
    const bool between = s->goal.starts > 0 && s->goal.nfrom == 0;
    u[i] = end;
    if (!look(r, u, &grade)) return false;
    weigh(s, i, end, &grade);
    if (!grade.holds)
        return !between || s->goal.subject->space.axis[i].dear ||
               scan_between(r, i, end, grade.margin);
    consider(&s->single, u, &grade);
    return scan_boundary(r, i, 0, end);
}

/* Every axis alone, from the nominal point to its ends: which of them matter, and whether one alone
 * would do. False while points are missing. */
static bool scan(struct round *r)
{
    struct explain_search *s = r->search;
    const struct explain_space *space = &s->goal.subject->space;
    double u[EXPLAIN_MOST_AXES] = {0};
    struct explain_grade grade = {.margin = NAN};
    bool all = look(r, u, &grade); /* the nominal point */
    s->nominal = grade.margin;
    for (int i = 0; i < space->n; i++) s->gain[i] = s->swing[i] = s->end[i] = 0;
    for (int i = 0; i < space->n; i++) {
        all = scan_axis(r, i, space->axis[i].most) && all;
        if (space->axis[i].least < 0) all = scan_axis(r, i, space->axis[i].least) && all;
    }
    return all;
}

/* --- simplexes -------------------------------------------------------------------------------- */

/* Where it holds the distance counts, elsewhere how far it is from holding: any point that holds is
 * better than all that do not. */
static double cost_of(const struct explain_grade *g)
{
    const double fails = 50, short_by = isnan(g->margin) ? 20 : fmin(20, fmax(-g->margin, 1e-6));
    return g->holds ? g->distance : fails + short_by + 0.002 * g->distance;
}

/* The axes that simplexes move along: of those that change anything the most effective, the dear
 * ones when asked. */
static int effective_axes(const struct explain_search *s, bool dear, int axis[EXPLAIN_MOST_AXES])
{
    enum { MOST = 6 }; /* a simplex in more dimensions needs too many points */
    const struct explain_space *space = &s->goal.subject->space;
    int n = 0;
    while (n < MOST) {
        int best = -1;
        for (int i = 0; i < space->n; i++) {
            bool taken = (space->axis[i].dear && !dear) || s->swing[i] < 1e-6;
            for (int k = 0; k < n; k++) taken = taken || axis[k] == i;
            if (!taken && (best < 0 || s->swing[i] > s->swing[best])) best = i;
        }
        if (best < 0) break; /* no other axis changes anything */
        axis[n++] = best;
    }
    return n;
}

/* One simplex: where it begins, and in which of the axes. */
struct descent {
    struct round *round;
    double u[EXPLAIN_MOST_AXES]; /* of all axes at the start */
    double step;                 /* of the first corners, a part of the box */
    int n, axis[EXPLAIN_MOST_AXES];
};

/* What GSL minimises. Where a point has yet to be made the rest of this descent is thrown away, and
 * made again with it in the next round. */
static double simplex_cost(const gsl_vector *x, void *context)
{
    struct descent *d = context;
    struct round *r = d->round;
    double u[EXPLAIN_MOST_AXES];
    struct explain_grade grade;
    if (r->waiting && !r->collecting) return 0; /* any value: the simplex is thrown away */
    memcpy(u, d->u, sizeof u);
    for (int i = 0; i < d->n; i++) u[d->axis[i]] = gsl_vector_get(x, (size_t)i);
    if (look(r, u, &grade)) return cost_of(&grade);
    r->waiting = true;
    return 0;
}

/* Given starts, then half-way to the better ends, the nominal point, anywhere in the box; at last
 * the answer so far, with smaller steps. */
static struct descent begin_at(struct round *r, int start)
{
    const struct explain_search *s = r->search;
    const struct explain_space *space = &s->goal.subject->space;
    struct random random = random_make(s->goal.seed, (uint64_t)start, (uint64_t)s->goal.operators);
    struct descent d = {.round = r, .step = start < s->goal.starts ? 0.4 : 0.1};
    d.n = effective_axes(s, s->goal.dear && start == s->goal.starts - 1, d.axis);
    for (int i = 0; i < d.n; i++) {
        const struct explain_axis *a = &space->axis[d.axis[i]];
        double drawn = random_uniform(&random, a->least, a->most);
        if (start == s->goal.nfrom) d.u[d.axis[i]] = 0.5 * s->end[d.axis[i]];
        if (start > s->goal.nfrom + 1) d.u[d.axis[i]] = drawn;
    }
    if (start < s->goal.nfrom) memcpy(d.u, s->goal.from[start], sizeof d.u);
    if (start == s->goal.starts) memcpy(d.u, s->from[1], sizeof d.u);
    return d;
}

static bool iterate(struct descent *d, gsl_multimin_fminimizer *m, gsl_vector *x, gsl_vector *step)
{
    struct round *r = d->round;
    gsl_multimin_function f = {.f = simplex_cost, .n = (size_t)d->n, .params = d};
    r->waiting = false; /* nothing is missing yet */
    /* The corners of the first simplex do not depend on each other: all are asked for at once. */
    r->collecting = true;
    bool begun = gsl_multimin_fminimizer_set(m, &f, x, step) == GSL_SUCCESS;
    r->collecting = false;
    for (int k = 0; begun && !r->waiting && k < r->search->goal.steps; k++) {
        if (gsl_multimin_fminimizer_iterate(m) != GSL_SUCCESS) break; /* it cannot improve */
        if (gsl_multimin_fminimizer_size(m) < 0.02) break; /* corners within 2 % of each other */
    }
    return !r->waiting;
}

static bool simplex(struct round *r, int start)
{
    struct descent d = begin_at(r, start);
    const struct explain_space *space = &r->search->goal.subject->space;
    if (d.n == 0) return true; /* no axis changes anything */
    gsl_error_handler_t *handler = gsl_set_error_handler(gsl_errors_returned);
    gsl_multimin_fminimizer *m =
        gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, (size_t)d.n);
    gsl_vector *x = gsl_vector_alloc((size_t)d.n), *step = gsl_vector_alloc((size_t)d.n);
    if (!m || !x || !step) check_memory(0);
    for (int i = 0; i < d.n; i++) {
        const struct explain_axis *a = &space->axis[d.axis[i]];
        double u = d.u[d.axis[i]];
        gsl_vector_set(x, (size_t)i, u);
        /* A step that leads out of the box would be no step. */
        gsl_vector_set(step, (size_t)i,
                       (u <= 0.5 * (a->least + a->most) ? d.step : -d.step) * a->most);
    }
    bool ended = iterate(&d, m, x, step);
    gsl_multimin_fminimizer_free(m);
    gsl_vector_free(x);
    gsl_vector_free(step);
    gsl_set_error_handler(handler);
    return ended;
}

/* The dear axes beside the best of the cheap ones. */
static bool beside(struct round *r)
{
    enum { VALUES = 3 }; /* thirds of the axis */
    const struct explain_space *space = &r->search->goal.subject->space;
    struct explain_grade grade;
    bool all = true;
    for (int i = 0; i < space->n; i++)
        for (int k = 1; space->axis[i].dear && k <= VALUES; k++) { /* only the slow ones */
            double u[EXPLAIN_MOST_AXES];
            memcpy(u, r->search->from[0], sizeof u);
            u[i] = space->axis[i].most * k / VALUES;
            all = look(r, u, &grade) && all;
        }
    return all;
}

/* --- taking back ------------------------------------------------------------------------------ */

/* The change of axis i spread over the others, where that holds, too: as long a way with fewer
 * changes. */
static bool hand_over(struct round *r, double *u, int i, bool *changed)
{
    struct explain_grade grade;
    const struct explain_space *space = &r->search->goal.subject->space;
    double v[EXPLAIN_MOST_AXES], all = explain_space_distance(space, u), others = all - fabs(u[i]);
    if (others <= 0) return true; /* there is no other change */
    for (int k = 0; k < EXPLAIN_MOST_AXES; k++) v[k] = k == i ? 0 : u[k] * all / others;
    if (!look(r, v, &grade)) return false;
    if (!grade.holds) return true; /* the change is needed */
    memcpy(u, v, sizeof v);
    *changed = true;
    return true;
}

/* The least |u[i]| that still holds, by bisection; *u is left there. */
static bool take_back(struct round *r, double *u, int i, bool *changed)
{
    enum { HALVINGS = 6 }; /* to 1/64 of the change */
    struct explain_grade grade;
    double fails = 0, holds = u[i], was = u[i], v[EXPLAIN_MOST_AXES]; /* as in scan_boundary */
    memcpy(v, u, sizeof v);
    v[i] = 0; /* without it at all */
    if (!look(r, v, &grade)) return false;
    if (grade.holds) holds = 0; /* not needed at all */
    else if (!hand_over(r, u, i, changed)) return false;
    if (u[i] == 0) return true;
    for (int k = 0; holds != 0 && k < HALVINGS; k++) {
        memcpy(v, u, sizeof v);
        v[i] = 0.5 * (fails + holds);
        if (!look(r, v, &grade)) return false;
        if (grade.holds) holds = v[i];
        else fails = v[i];
    }
    u[i] = holds;
    if (fabs(was - holds) > 0.01) *changed = true; /* by more than a per cent */
    return true;
}

/* From the smallest change to the largest: those that are not needed go. */
static bool polish(struct round *r, const double *from)
{
    enum { ROUNDS = 3 }; /* taking back one change may make another one needless */
    struct explain_search *s = r->search;
    int n = s->goal.subject->space.n;
    double u[EXPLAIN_MOST_AXES];
    memcpy(u, from, sizeof u);
    for (int k = 0; k < ROUNDS; k++) {
        bool tried[EXPLAIN_MOST_AXES] = {false}, changed = false;
        for (int j = 0; j < n; j++) {
            int least = -1;
            for (int i = 0; i < n; i++)
                if (!tried[i] && (least < 0 || fabs(u[i]) < fabs(u[least]))) least = i;
            tried[least] = true;
            if (u[least] != 0 && !take_back(r, u, least, &changed)) return false;
        }
        if (!changed) break; /* another round would be the same */
    }
    return true;
}

/* --- all searches ----------------------------------------------------------------------------- */

/* Stage k begins: from where it does is settled by what was known then, once for all rounds. */
static const double *stage(struct explain_search *s, int k)
{
    if (s->begun == k) memcpy(s->from[s->begun++], s->best.u, sizeof s->from[0]);
    return s->from[k];
}

/* What the search can do with what is known; true when it has come to its end. */
static bool advance(struct round *r)
{
    struct explain_search *s = r->search;
    if (!s->scanned && !(s->scanned = scan(r))) return false;
    bool all = true;
    for (int i = 0; i < s->goal.starts; i++)
        if (!s->ended[i]) all = (s->ended[i] = simplex(r, i)) && all;
    if (!all) return false; /* a simplex waits for its points */
    stage(s, 0);
    if (s->goal.starts && !s->beside && !(s->beside = beside(r))) return false;
    if (s->begun < 2 && !s->best.grade.holds) return true; /* nothing to take back */
    if (s->polished == 0) s->polished += polish(r, stage(s, 1));
    if (s->polished == 0 || s->goal.starts == 0) return s->polished;
    /* Around what is left there may be a shorter way. */
    if (s->begun == 2) memcpy(s->from[1], s->best.u, sizeof s->from[1]), s->begun = 3;
    if (!s->ended[s->goal.starts] && !(s->ended[s->goal.starts] = simplex(r, s->goal.starts)))
        return false;
    if (s->begun == 3) memcpy(s->from[2], s->best.u, sizeof s->from[2]), s->begun = 4;
    return polish(r, s->from[2]);
}

bool explain_search_all(struct explain_bench *b, struct explain_search *search, int n)
{
    enum { MOST_REQUESTS = 512 }; /* points of one batch */
    struct explain_request *request = memory_zeroed(MOST_REQUESTS, sizeof *request);
    struct progress progress = progress_make("points", 4000, b->common->quiet);
    bool ok = true;
    for (int nrequest = 1; ok && nrequest > 0;) {
        nrequest = 0; /* each round begins anew: what is known answers at once */
        for (int i = 0; i < n; i++) {
            struct round r = {.search = &search[i],
                              .request = request,
                              .nrequest = &nrequest,
                              .most = MOST_REQUESTS};
            if (!search[i].done) search[i].done = advance(&r);
        }
        ok = explain_make(b, request, nrequest);
        progress_show(&progress, b->made);
    }
    progress_end(&progress);
    free(request);
    return ok;
}
