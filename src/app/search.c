/* search.c - see search.h.
 *
 * A goal is one number for a point: points that break the limit are behind all that keep it, in the
 * order of how much they break it, and points that cannot run are behind those. So the simplex
 * finds its way back to where the limit holds. */
#include "app/search.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multimin.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/outcome.h"
#include "base/design.h"
#include "base/gsl_errors.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/units.h"
#include "report/csv.h"
#include "report/report.h"
#include "run/run.h"

/* A point that was judged. */
struct judged {
    struct outcome outcome;
    double value; /* of the goal, in SI */
    enum unit unit;
    bool within;
    double rank; /* smaller is better; NOWHERE: it cannot run */
};

#define NOWHERE 1e9

struct search {
    struct plan *plan;
    const struct plan_search *asked;
    struct store *store;
    struct err *err;
    int index;          /* the run of the plan whose ranges are searched */
    int tried;          /* runs of this combination of listed values */
    bool failed;        /* an error that ends the search, in *err */
    struct judged best; /* of the group */
    int group_tried;
};

/* ---- values */

/* A formula for a run and what it came to. */
static bool evaluate(const struct plan_search *asked, const struct expression *x,
                     const struct run_spec *run, const struct outcome *o,
                     struct expression_value *v, struct err *e)
{
    return outcome_value(x, run, o, "optimise", asked->file, asked->line, v, e);
}

/* Goal and limit of a run, and where that puts it. */
static bool judge(const struct plan_search *asked, const struct run_spec *run, struct judged *j,
                  struct err *e)
{
    struct expression_value goal, limit = {.number = 1, .truth = true};
    if (!evaluate(asked, asked->goal, run, &j->outcome, &goal, e)) return false;
    if (asked->within != NULL && !evaluate(asked, asked->within, run, &j->outcome, &limit, e))
        return false;
    if (!limit.truth)
        return err_set_at(e, ERR_DATA, asked->file, asked->line,
                          "optimise: within: '%.120s': a value; expected a condition such as "
                          "'makespan <= 2 ms'",
                          expression_text(asked->within));
    j->value = goal.number;
    j->unit = goal.unit;
    j->within = limit.number != 0;
    /* the least of the negative is the greatest */
    const double wanted = asked->greatest ? -goal.number : goal.number;
    /* between -1 and 1 whatever its unit, in its order */
    if (!j->outcome.ok || !isfinite(wanted)) j->rank = NOWHERE;
    else if (!j->within) j->rank = 2 + fmin(limit.excess, 1e6);
    else j->rank = wanted / (1 + fabs(wanted));
    return true;
}

/* ---- runs */

/* Every run of a search is a row like any other. */
static bool keep_run(void *context, const struct run_spec *spec, const struct run_result *r)
{
    struct search *x = context;
    return store_put(x->store, spec, NULL, r, x->err);
}

/* The point at u: a run of the plan with these values. */
static bool try_point(struct search *x, const double *u, struct judged *j)
{
    const struct plan_search *a = x->asked;
    const char *key[PLAN_MOST_RANGES], *text[PLAN_MOST_RANGES];
    struct run_spec run;
    for (int i = 0; i < a->nrange; i++) {
        key[i] = a->range[i].key;
        /* the simplex may step outside: then the border is meant */
        text[i] = range_text(&a->range[i], fmin(fmax(u[i], 0), 1), x->plan->arena);
    }
    /* through the scenario's own settings: what follows from a value follows here, too */
    if (!plan_vary(x->plan, x->index, a->nrange, key, text, &run, x->err)) return false;
    if (!store_has(x->store, &run) &&
        !run_campaign(&run, NULL, 1, NULL, 1, true, keep_run, x, x->err))
        return false;
    /* stored ones count, too: a search asked for again ends at the same point */
    x->tried++;
    return outcome_read(x->store, &run, &j->outcome, x->err) && judge(a, &run, j, x->err);
}

/* The better of two, the first of equals. */
static void keep_best(struct search *x, const struct judged *j)
{
    x->group_tried++;
    if (x->group_tried == 1 || j->rank < x->best.rank) x->best = *j;
}

/* For GSL, which knows no errors: after one, every point is as bad as can be. */
static double cost(const gsl_vector *v, void *context)
{
    struct search *x = context;
    double u[PLAN_MOST_RANGES];
    struct judged j = {.rank = NOWHERE};
    if (x->failed || x->tried >= x->asked->most) return NOWHERE;
    for (int i = 0; i < x->asked->nrange; i++) u[i] = gsl_vector_get(v, (size_t)i);
    x->failed = !try_point(x, u, &j);
    if (!x->failed) keep_best(x, &j);
    return j.rank;
}

/* A few points spread evenly, and both ends: where the simplex begins. */
static bool spread(struct search *x, double *start)
{
    enum { SPREAD = 16 };
    const int k = x->asked->nrange, n = x->asked->most / 3 < SPREAD ? x->asked->most / 3 : SPREAD;
    /* the sequence begins with the middle */
    double u[SPREAD * PLAN_MOST_RANGES], least = INFINITY;
    design_fill(DESIGN_SOBOL, 0, n, k, u);
    /* an optimum often lies at an end */
    for (int i = 0; i < k && n > 2; i++) {
        u[(n - 2) * k + i] = 0;
        u[(n - 1) * k + i] = 1;
    }
    for (int p = 0; p < n; p++) {
        struct judged j;
        if (!try_point(x, &u[p * k], &j)) return false;
        keep_best(x, &j);
        /* the first of equals, so that the search is the same everywhere */
        if (j.rank >= least) continue;
        least = j.rank;
        memcpy(start, &u[p * k], (size_t)k * sizeof *start);
    }
    return true;
}

/* Nelder and Mead from there, until the corners are within a two-thousandth of the ranges. */
static bool descend(struct search *x, const double *start)
{
    const size_t k = (size_t)x->asked->nrange;
    /* a simplex that cannot improve ends by a status, not by a message */
    gsl_error_handler_t *handler = gsl_set_error_handler(gsl_errors_returned);
    gsl_multimin_fminimizer *m =
        gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, k);
    gsl_vector *at = gsl_vector_alloc(k), *step = gsl_vector_alloc(k);
    gsl_multimin_function f = {.f = cost, .n = k, .params = x};
    for (size_t i = 0; i < k; i++) {
        gsl_vector_set(at, i, start[i]);
        /* towards the inside */
        gsl_vector_set(step, i, start[i] > 0.5 ? -0.15 : 0.15);
    }
    bool going = gsl_multimin_fminimizer_set(m, &f, at, step) == GSL_SUCCESS;
    while (going && !x->failed && x->tried < x->asked->most)
        going = gsl_multimin_fminimizer_iterate(m) == GSL_SUCCESS &&
                gsl_multimin_fminimizer_size(m) > 0.0005;
    gsl_vector_free(at);
    gsl_vector_free(step);
    gsl_multimin_fminimizer_free(m);
    gsl_set_error_handler(handler);
    return !x->failed;
}

/* One combination of listed values. */
static bool search_combination(struct search *x, int index)
{
    double start[PLAN_MOST_RANGES] = {0};
    struct judged j = {.rank = NOWHERE};
    /* each combination has its own number of runs */
    x->index = index;
    x->tried = 0;
    if (x->asked->nrange > 0) return spread(x, start) && descend(x, start);
    /* nothing but listed values: the plan's run is all there is */
    if (!outcome_read(x->store, &x->plan->run[index], &j.outcome, x->err) ||
        !judge(x->asked, &x->plan->run[index], &j, x->err))
        return false;
    keep_best(x, &j);
    return true;
}

/* ---- answers */

/* Six digits are what people read. */
static void print_value(const struct judged *b, char *text, int size)
{
    snprintf(text, (size_t)size, "%.6g", b->value);
    if (b->unit < UNIT_KINDS) units_print(strtod(text, NULL), b->unit, text, size);
}

/* One row for each point of the other axes, also where nothing could run. */
static bool store_best(struct search *x, int group)
{
    static const char *const name[] = {"scenario", "ordinal",    "goal",  "within", "run_id",
                                       "value",    "value_text", "holds", "tried"};
    const struct plan_search *a = x->asked;
    const struct judged *b = &x->best;
    char text[64];
    struct text goal = {0};
    text_add(&goal, "%s %s", a->greatest ? "greatest" : "least", expression_text(a->goal));
    print_value(b, text, (int)sizeof text);
    /* without any point that runs there is no best one */
    const bool found = b->rank < NOWHERE;
    const struct store_value value[] = {
        store_text(x->plan->name),
        store_int(group),
        store_text(goal.s),
        store_text(a->within != NULL ? expression_text(a->within) : NULL),
        found ? store_int(b->outcome.id) : store_null(),
        found ? store_real(b->value) : store_null(),
        store_text(found ? text : NULL),
        store_int(found && b->within),
        store_int(x->group_tried)};
    const bool ok = store_insert(x->store, "optimum", 9, name, value, x->err);
    text_free(&goal);
    return ok;
}

/* Names and units are asked of the first run, before it is made: what is not known fits anything.
 */
bool search_check(const struct plan *p, struct err *e)
{
    /* no result yet: comparisons with it are false, which is all that is asked here */
    struct judged j = {.outcome = outcome_unknown};
    const struct plan_search *a = p->search;
    if (a == NULL) return true;
    /* counted before anything is built */
    const int64_t runs = a->nrange > 0 ? (int64_t)p->nrun * a->most : p->nrun;
    if (runs > SEARCH_MOST)
        return err_set_at(e, ERR_CONFIG, a->file, a->line,
                          "optimise: %d combinations with up to %d runs each are %lld runs; "
                          "expected at most %d",
                          p->nrun, a->most, (long long)runs, SEARCH_MOST);
    /* levels are settled before the search, for the plan's own runs */
    for (int i = 0; i < p->nrun && a->nrange > 0; i++)
        if (p->run[i].machine.network.level == LEVEL_AUTO_TOLERANCE)
            return err_set_at(e, ERR_CONFIG, a->file, a->line,
                              "optimise: ranges need one network level, not auto-tolerance");
    return judge(a, &p->run[0], &j, e);
}

/* Group by group; runs of a group may stand anywhere in the plan, so they are listed first. */
bool search_run(struct plan *p, struct store *s, struct err *e)
{
    /* counting sort: begin[g] becomes the place of the first run of group g */
    int *begin = memory_zeroed((size_t)p->ngroup + 2, sizeof *begin),
        *run = memory_zeroed((size_t)p->nrun + 1, sizeof *run);
    for (int i = 0; i < p->nrun; i++) begin[p->group[i] + 2]++;
    for (int g = 0; g < p->ngroup; g++) begin[g + 2] += begin[g + 1];
    for (int i = 0; i < p->nrun; i++) run[begin[p->group[i] + 1]++] = i;
    bool ok = store_delete(s, "optimum", "scenario", store_text(p->name), e);
    for (int g = 0; g < p->ngroup && ok; g++) {
        struct search x = {.plan = p, .asked = p->search, .store = s, .err = e};
        for (int i = begin[g]; i < begin[g + 1] && ok; i++)
            /* what is refused is a row of its own, and no candidate */
            if (p->run[run[i]].refused == NULL) ok = search_combination(&x, run[i]);
        ok = ok && (x.group_tried == 0 || store_best(&x, g));
    }
    free(begin);
    free(run);
    return ok;
}

/* A column for each setting that is swept or searched. */
static void add_key(struct text *sql, const char *key)
{
    if (strcmp(key, "n_over_p") == 0) text_add(sql, ", r.n / r.P AS n_over_p");
    else if (strcmp(key, "model.n") == 0 || strcmp(key, "program.n") == 0) text_add(sql, ", r.n");
    else if (strcmp(key, "ranks") == 0) text_add(sql, ", r.P");
    else if (strcmp(key, "machine.name") == 0) text_add(sql, ", r.label AS machine");
    else
        text_add(
            sql,
            ", (SELECT value FROM v_setting v WHERE v.run_id = r.id AND v.key = '%s') AS \"%s\"",
            key, strncmp(key, "machine.", 8) == 0 ? key + 8 : key);
}

/* Swept keys first, then what was searched by ranges. */
bool search_print(struct store *s, const struct plan *p, const struct run_table_look *l, FILE *out,
                  struct err *e)
{
    struct text sql = {0};
    /* the scenario's name as a value: it comes from a file's name */
    const char *const bound[] = {p->name};
    text_add(&sql, "SELECT o.goal, o.%s, o.within, iif(o.holds, 'yes', 'no') AS holds, o.tried",
             l->json || l->csv ? "value" : "value_text AS value");
    for (int i = 0; i < p->nswept; i++) add_key(&sql, p->swept[i].key);
    for (int i = 0; i < p->search->nrange; i++) add_key(&sql, p->search->range[i].key);
    text_add(&sql, ", r.makespan_ps / 1e6 AS makespan_us, r.id AS run FROM optimum o"
                   " LEFT JOIN run r ON r.id = o.run_id WHERE o.scenario = ?1 ORDER BY o.ordinal");
    const bool ok = run_table_show(s, sql.s, bound[0], l, out, e);
    text_free(&sql);
    return ok;
}
