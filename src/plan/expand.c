/* expand.c - from settings and axes to runs: all points of a plan, and one of them made again. */
#include "plan/expand.h"

#include <string.h>

#include "base/text.h"
#include "plan/expand_parts.h"
#include "spec/identity.h"

/* A run of a plan takes about 7 KB, so the largest plan takes 0.7 GB and a few seconds. */
enum { MAX_RUNS = 100000 };

/* One point: 1 run made, 0 left out, -1 failed. */
static int make_point(struct expansion *x, struct run_spec *run)
{
    return expand_spec(x, run) ? expand_finish(x, run) : -1;
}

/* The next point; false behind the last. */
static bool advance(struct expansion *x)
{
    /* As an odometer: the last axis turns fastest. */
    for (int i = x->scenario->naxis - 1; i >= 0; i--) {
        if (++x->point[i] < x->scenario->axis[i].npoint) return true;
        x->point[i] = 0;
    }
    return false;
}

/* The number of the present point, of all axes or of those that are not searched. */
static int64_t point_number(const struct expansion *x, bool all)
{
    int64_t number = 0;
    /* the last axis counts ones, as in the odometer */
    for (int i = 0; i < x->scenario->naxis; i++)
        if (all || !x->scenario->axis[i].searched)
            number = number * x->scenario->axis[i].npoint + x->point[i];
    return number;
}

/* Of a search: the point of the other axes becomes the next group, unless it is one already. */
static int group_of(struct expansion *x, int64_t *outer)
{
    struct plan *p = x->plan;
    if (x->scenario->search == NULL) return 0;
    /* what is searched makes no difference between groups */
    const int64_t number = point_number(x, false);
    /* the latest first: it is that one unless a searched axis is slower than another */
    for (int i = p->ngroup - 1; i >= 0; i--)
        if (outer[i] == number) return i;
    outer[p->ngroup] = number;
    return p->ngroup++;
}

/* A run joins the plan, with its repetitions behind it. */
static void add_run(struct expansion *x, const struct run_spec *made, int group)
{
    struct plan *p = x->plan;
    struct run_spec *run = x->run + p->nrun;
    /* Without anything random all repetitions would be the same run. */
    const bool repeats = run_spec_is_random(made) && !made->refused;
    const int repetitions = repeats ? x->scenario->repetitions : 1;
    for (int rep = 0; rep < repetitions; rep++) {
        if (&run[rep] != made) run[rep] = *made;
        run[rep].rep = rep;
        p->point[p->nrun + rep] = point_number(x, true);
        p->group[p->nrun + rep] = group;
        p->memory->start_of[p->nrun + rep] = x->present;
    }
    p->nrun += repetitions;
}

/* All points in order; repetitions of one follow each other. */
static bool expand_points(struct expansion *x, int64_t capacity)
{
    struct plan *p = x->plan;
    const struct scenario_jobs *jobs = x->scenario->jobs;
    int64_t *outer = x->scenario->search != NULL ? TAKE(p->arena, capacity, int64_t) : NULL;
    x->run = TAKE(p->arena, capacity, struct run_spec);
    p->run = x->run;
    p->point = TAKE(p->arena, capacity, int64_t);
    p->group = TAKE(p->arena, capacity, int);
    p->memory->start_of = TAKE(p->arena, capacity, struct start *);
    struct run_spec *joint =
        jobs != NULL ? TAKE(p->arena, expand_jobs_runs(jobs), struct run_spec) : NULL;
    do {
        struct run_spec *made = jobs != NULL ? joint : &x->run[p->nrun];
        const int n = jobs != NULL ? expand_jobs(x, joint) : make_point(x, made);
        if (n < 0) return false;
        if (n == 0) continue;
        const int group = group_of(x, outer);
        for (int i = 0; i < n; i++) add_run(x, &made[i], group);
    } while (advance(x));
    /* Nothing can run: that is an error, not a plan. */
    if (p->nrun > 0 && p->nrefused == p->nrun) {
        *x->err = p->refusal;
        return false;
    }
    if (p->nrun > 0) return true;
    return err_set_at(x->err, ERR_CONFIG, x->scenario->path, 0,
                      "%s excludes all runs", x->scenario->ncondition > 1 ? "'only' with all its "
                                                                            "conditions"
                      : x->scenario->condition[0].line == 0 ? "--only" : "'only'");
}

/* The product of all axes and repetitions, filtered by `only`. */
bool expand_runs(struct plan *p, const struct scenario *s, struct err *e)
{
    struct expansion x = {.plan = p, .scenario = s, .err = e, .changes = {.arena = p->arena},
                          .calls = {.arena = p->arena}, .work = EXPAND_WORK};
    int64_t n = s->repetitions;
    if (s->jobs != NULL) n *= expand_jobs_runs(s->jobs);
    /* Counted before anything is built: a few lines can ask for any number of runs. The count stops
     * growing long before it overflows. */
    for (int i = 0; i < s->naxis && n < INT64_MAX / SCENARIO_MAX_POINTS; i++)
        n *= s->axis[i].npoint;
    if (n > MAX_RUNS)
        return err_set_at(e, ERR_CONFIG, s->path, 0,
                          "the sweep has %s%lld runs; expected at most %d: make it smaller, or "
                          "split it into several scenarios",
                          n < INT64_MAX / SCENARIO_MAX_POINTS ? "" : "more than ", (long long)n,
                          MAX_RUNS);
    x.identity = identity_or_own(s->identity);
    p->memory = TAKE(p->arena, 1, struct plan_memory);
    bool fine = expand_points(&x, n);
    identity_back(x.identity, s->identity);
    p->search = s->search;
    p->answer = s->answer;
    p->memory->scenario = s;
    p->memory->starts = x.starts;
    return fine;
}

struct machine_file *expand_machine(const struct plan *p, int index)
{
    return &p->memory->start_of[index]->whole;
}

/* The point is set as the odometer was, and made once more with the further settings behind all
 * others. What it counts is not the plan's. */
bool plan_vary(struct plan *p, int index, int n, const char *const *key, const char *const *text,
               struct run_spec *run, struct err *e)
{
    struct scenario s = *p->memory->scenario;
    struct plan counts = *p;
    struct expansion x = {.plan = &counts, .scenario = &s, .err = e, .starts = p->memory->starts,
                          .changes = {.arena = p->arena}, .calls = {.arena = p->arena},
                          .work = EXPAND_WORK};
    /* the odometer as it stood when the point was made */
    int64_t number = p->point[index];
    for (int i = s.naxis - 1; i >= 0; i--) {
        x.point[i] = (int)(number % s.axis[i].npoint);
        number /= s.axis[i].npoint;
    }
    /* a list of its own, behind which the further settings stand */
    struct setting_list set = {0};
    for (int i = 0; i < s.set.n; i++)
        if (!setting_list_add(&set, s.set.at[i].key, s.set.at[i].text, s.set.at[i].file, 0,
                              p->arena, e))
            return false;
    for (int i = 0; i < n; i++)
        if (!setting_list_add(&set, key[i], text[i], "optimise", 0, p->arena, e)) return false;
    s.set = set;
    s.ncondition = 0;
    x.identity = identity_or_own(s.identity);
    /* conditions were asked when the plan was made */
    const int made = make_point(&x, run);
    identity_back(x.identity, s.identity);
    run->rep = p->run[index].rep;
    return made == 1;
}

/* ---- what does not act */

/* Whether a setting acts in a job that runs beside this one, which the plan may have left out. */
static bool acts_beside(const struct run_spec *run, const struct field *f)
{
    const struct job_set *jobs = run->jobs;
    for (int i = 0; jobs != NULL && i < jobs->n; i++)
        if (!jobs->idle[i] && f->idle(jobs->job[i]) == NULL) return true;
    return false;
}

/* Why a setting acts in no run, NULL when it acts in one. */
static const char *why_idle(const struct plan *p, const struct setting *s)
{
    const char *why = NULL;
    if (s->kind != SETTING_FIELD || s->field->idle == NULL) return NULL;
    for (int i = 0; i < p->nrun; i++) {
        const struct run_spec *run = &p->run[i];
        if ((why = s->field->idle(run)) == NULL || acts_beside(run, s->field)) return NULL;
    }
    return why;
}

/* One remark per key and reason. */
static void add_unused(struct plan *p, const char *key, const char *why)
{
    struct text t = {0};
    text_add(&t, "%s: %s", key, why);
    for (int i = 0; i < p->nunused && t.s != NULL; i++)
        if (strcmp(p->unused[i], t.s) == 0) text_free(&t);
    if (t.s != NULL) p->unused[p->nunused++] = arena_text(p->arena, t.s);
    text_free(&t);
}

static void add_unused_of(struct plan *p, const struct setting_list *list)
{
    for (int i = 0; i < list->n; i++) {
        const char *why = why_idle(p, &list->at[i]);
        if (why != NULL) add_unused(p, list->at[i].key, why);
    }
}

/* Settings that act in no run of the plan are told: a solver of a program that has none is
 * usually a mistake. */
void expand_unused(struct plan *p, struct scenario *s)
{
    int ntable, n = 1;
    bool random = false;
    const struct field_table *const *table = field_tables(&ntable);
    for (int i = 0; i < ntable; i++) n += table[i]->nfield;
    p->unused = TAKE(p->arena, n, const char *);
    struct setting_list **list;
    const int nlist = scenario_lists(s, p->arena, &list);
    for (int i = 0; i < nlist; i++) add_unused_of(p, list[i]);
    for (int i = 0; i < p->nrun && !random; i++) random = run_spec_is_random(&p->run[i]);
    if (s->repetitions > 1 && !random)
        add_unused(p, "repetitions", "nothing is random in these runs, so each is made once");
}
