/* uncertainty.c - see uncertainty.h.
 *
 * A sample is a run with other numbers in its machine. What is kept of it are two times: thousands
 * of whole rows would say nothing more, and the database of a study stays one that can be sent
 * around. */
#include "app/uncertainty.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/flag.h"
#include "app/stored.h"
#include "base/memory.h"
#include "base/text.h"
#include "report/report.h"
#include "run/run.h"
#include "spec/identity.h"
#include "study/uncertain.h"
#include "study/variance.h"

/* Fixed: samples are the same in every study, and stored ones are found again. */
enum { UNCERTAINTY_SEED = 0, LEAST = 4, MOST = 10000 };

/* One run of the plan with its parameters. */
struct point {
    const struct run_spec *run;
    int64_t id; /* in table run */
    int k;
    struct uncertain *parameter; /* (k) */
    int rows;  /* of the design that are run: 2 n for bands, n (k + 2) for shares */
    double *u; /* (rows x k) */
    char design[65];
};

/* What is needed to keep a result. */
struct work_on {
    struct store *store;
    struct err *err;
    const struct point *point;
    const struct run_spec *first; /* of the campaign: a sample's number is its place */
};

/* A misspelt number must not become a study of another size. */
bool uncertainty_take(int *argc, char **argv, struct uncertainty_options *o, struct err *e)
{
    const char *text = take_value(argc, argv, "--uncertainty");
    /* both are taken, whether they make sense together or not: the message is about that */
    const bool bands = take_flag(argc, argv, "--bands-only");
    char *end;
    *o = (struct uncertainty_options){.shares = !bands};
    if (text == NULL)
        return !bands || err_set(e, ERR_USAGE, "--bands-only belongs to --uncertainty N");
    const long n = strtol(text, &end, 10);
    if (end == text || *end != '\0' || n < LEAST || n > MOST)
        return err_set(e, ERR_USAGE,
                       "--uncertainty: '%.40s' is not a number of samples from %d to %d", text,
                       LEAST, MOST);
    o->n = (int)n;
    return true;
}

/* Whether the scenario gives the parameter itself: it sweeps it, or its value is not the file's. */
static bool is_given(const struct plan *p, const struct uncertain *u, const struct run_spec *run,
                     const struct machine_spec *file)
{
    struct text full = {0};
    text_add(&full, "machine.%s", u->key);
    bool given = uncertain_number(u, &run->machine) != uncertain_number(u, file);
    for (int i = 0; i < p->nswept && !given; i++) given = strcmp(p->swept[i].key, full.s) == 0;
    text_free(&full);
    return given;
}

/* The parameters that are drawn for run `index`. */
static int parameters_of(const struct plan *p, int index, struct arena *a, struct uncertain **list)
{
    const struct origin *origin;
    const struct run_spec *run = &p->run[index];
    int norigin, n = 0;
    /* the file's ranges, not those of other machines with the same name */
    plan_origins(p, index, &origin, &norigin);
    const struct machine_spec *file = plan_machine_file(p, index);
    const int all = uncertain_list(origin, norigin, file, UNCERTAIN_ALL, a, list);
    for (int i = 0; i < all; i++) {
        const struct uncertain u = (*list)[i];
        /* a parameter without effect would cost n runs and explain nothing */
        const bool idle = u.field->idle != NULL && u.field->idle(run) != NULL;
        if (!idle && !is_given(p, &u, run, file)) (*list)[n++] = u;
    }
    return n;
}

/* Parameters alone are looked at: no memory of runs is taken. */
bool uncertainty_count(const struct plan *p, const struct uncertainty_options *o, struct err *e)
{
    int64_t total = 0;
    struct arena *a = arena_create();
    for (int i = 0; i < p->nrun && o->n > 0; i++) {
        struct uncertain *list;
        /* lists are looked at once each */
        struct arena_mark mark = arena_mark(a);
        const int k = parameters_of(p, i, a, &list);
        arena_release(a, mark);
        if (k > 0) total += o->shares ? variance_rows(o->n, k) : 2 * o->n;
    }
    arena_destroy(a);
    /* as large as a plan may be */
    if (total <= UNCERTAINTY_MOST) return true;
    return err_set(
        e, ERR_CONFIG,
        "--uncertainty %d means %lld runs; expected at most %d: take fewer samples, points "
        "(--only), or --bands-only",
        o->n, (long long)total, UNCERTAINTY_MOST);
}

/* What the samples of a point depend on, besides its run. */
static void identify(struct point *x, int n)
{
    struct text all = {0};
    /* more samples are another design: A and B move in it */
    text_add(&all, "%d %d\n", n, UNCERTAINTY_SEED);
    for (int i = 0; i < x->k; i++)
        text_add(&all, "%s %.17g %.17g\n", x->parameter[i].key, x->parameter[i].low,
                 x->parameter[i].high);
    stored_digest(&all, x->design);
}

/* Samples with these identities are stored already. */
struct known {
    bool *skip;
    int rows, n;
};

/* A sample that is stored for the same design. */
static bool add_known(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    struct known *k = context;
    const int at = atoi(value[0]);
    (void)ncolumn, (void)name;
    /* each once, and none beyond the design */
    if (at >= 0 && at < k->rows && !k->skip[at]) k->skip[at] = true, k->n++;
    return true;
}

/* Samples of another design have the same numbers, but other values. */
static bool find_known(struct store *s, const struct point *x, struct known *k, struct err *e)
{
    char id[24];
    snprintf(id, sizeof id, "%lld", (long long)x->id);
    const char *const bound[] = {id, x->design};
    return store_select(s,
                        "SELECT sample FROM uncertainty_sample WHERE run_id = ?1 AND design = ?2",
                        2, bound, add_known, k, e);
}

/* Two times of one sample. */
static bool keep_sample(void *context, const struct run_spec *spec, const struct run_result *r)
{
    static const char *const name[] = {"run_id", "sample", "design", "makespan_ps", "serial_ps"};
    struct work_on *w = context;
    /* a wrong or failed run is a sample without a time */
    const bool fine = r->status == RUN_OK;
    int64_t serial = 0;
    /* the last serial code is the parallel one on one processor: no other code */
    for (int i = 0; i < r->nbaseline; i++)
        if (strcmp(r->baseline[i].name, "fastest serial") == 0) serial = r->baseline[i].time_ps;
    const struct store_value value[] = {store_int(w->point->id), store_int(spec - w->first),
                                        store_text(w->point->design),
                                        fine ? store_int(r->makespan_ps) : store_null(),
                                        fine && serial > 0 ? store_int(serial) : store_null()};
    return store_insert(w->store, "uncertainty_sample", 5, name, value, w->err);
}

/* The runs of a point: copies of its run with other machines. */
static struct run_spec *make_runs(const struct point *x, struct arena *a)
{
    struct run_spec *run = TAKE(a, x->rows, struct run_spec);
    /* machines of samples have no file: their values go into the copies */
    for (int i = 0; i < x->rows; i++) {
        run[i] = *x->run;
        for (int j = 0; j < x->k; j++)
            uncertain_apply(
                &x->parameter[j],
                uncertain_value(&x->parameter[j], x->u[(size_t)i * (size_t)x->k + (size_t)j]),
                &run[i].machine);
        run_identify(&run[i], a);
    }
    return run;
}

/* All samples of a point in one transaction; an interrupted study goes on with the next point. */
static bool run_point(const struct common *c, const struct point *x, struct store *s, struct err *e)
{
    struct known known = {.rows = x->rows, .skip = memory_zeroed((size_t)x->rows, sizeof(bool))};
    bool ok = c->force || find_known(s, x, &known, e);
    if (ok && known.n < x->rows) {
        struct arena *a = arena_create();
        struct run_spec *run = make_runs(x, a);
        /* what is stored is left out, one by one */
        struct work_on w = {s, e, x, run};
        ok = store_begin(s, e);
        /* samples of another design are of no use any more */
        if (ok && known.n == 0)
            ok = store_delete(s, "uncertainty_sample", "run_id", store_int(x->id), e);
        ok = ok &&
             run_campaign(run, NULL, x->rows, known.skip, c->jobs, c->quiet, keep_sample, &w, e);
        if (ok) ok = store_commit(s, e);
        else store_rollback(s);
        arena_destroy(a);
    }
    free(known.skip);
    return ok;
}

/* ---- what the samples say */

/* What the samples of a point came to. */
struct results {
    int rows;
    double *makespan, *speedup; /* (rows) NaN: not known */
};

/* Times as stored; what could not be run stays not known. */
static bool add_result(void *context, int ncolumn, const char *const *name,
                       const char *const *value)
{
    struct results *r = context;
    const int at = atoi(value[0]);
    (void)ncolumn, (void)name;
    if (at < 0 || at >= r->rows || value[1] == NULL) return true;
    r->makespan[at] = strtod(value[1], NULL);
    if (value[2] != NULL && r->makespan[at] > 0)
        r->speedup[at] = strtod(value[2], NULL) / r->makespan[at];
    return true;
}

/* One row of table uncertainty. */
static bool store_band(struct store *s, const struct point *x, const char *quantity, double nominal,
                       int tried, const struct variance_band *b, struct err *e)
{
    static const char *const name[] = {"run_id", "quantity",  "nominal", "samples", "failed",
                                       "mean",   "deviation", "low",     "median",  "high"};
    const struct store_value value[] = {
        store_int(x->id),        store_text(quantity), store_real(nominal),      store_int(b->n),
        store_int(tried - b->n), store_real(b->mean),  store_real(b->deviation), store_real(b->low),
        store_real(b->median),   store_real(b->high)};
    return store_insert(s, "uncertainty", 10, name, value, e);
}

/* One row of table uncertainty_share for each parameter. */
static bool store_shares(struct store *s, const struct point *x, const char *quantity,
                         const struct variance_share *share, struct err *e)
{
    static const char *const name[] = {"run_id",      "quantity", "key",        "low",
                                       "high",        "class",    "printed",    "first",
                                       "first_error", "total",    "total_error"};
    /* the range stands beside the share: without it the share means nothing */
    for (int i = 0; i < x->k; i++) {
        const struct uncertain *u = &x->parameter[i];
        struct text key = {0};
        text_add(&key, "machine.%s", u->key);
        const struct store_value value[] = {store_int(x->id),
                                            store_text(quantity),
                                            store_text(key.s),
                                            store_real(u->low),
                                            store_real(u->high),
                                            store_text(u->evidence),
                                            store_int(u->printed),
                                            store_real(share[i].first),
                                            store_real(share[i].first_error),
                                            store_real(share[i].total),
                                            store_real(share[i].total_error)};
        const bool ok = store_insert(s, "uncertainty_share", 11, name, value, e);
        text_free(&key);
        if (!ok) return false;
    }
    return true;
}

/* Shares need every point of the design; a band takes what there is. */
static bool judge_quantity(struct store *s, const struct point *x, int n, const char *quantity,
                           double nominal, double *y, struct err *e)
{
    /* one missing time makes all differences of its point meaningless */
    bool whole = x->rows > 2 * n;
    struct variance_share *share = memory_zeroed((size_t)x->k, sizeof *share);
    for (int i = 0; i < x->rows; i++) whole = whole && isfinite(y[i]);
    for (int i = 0; i < x->k; i++) share[i] = (struct variance_share){NAN, NAN, NAN, NAN};
    if (whole) variance_shares(n, x->k, y, share);
    /* the band last: it sorts what the shares need in the design's order */
    const struct variance_band band = variance_band(2 * n, y);
    const bool ok = band.n == 0 || (store_band(s, x, quantity, nominal, 2 * n, &band, e) &&
                                    store_shares(s, x, quantity, share, e));
    free(share);
    return ok;
}

/* The run itself: its time, and its speedup where it has one. */
static bool add_nominal(void *context, int ncolumn, const char *const *name,
                        const char *const *value)
{
    double *nominal = context;
    (void)ncolumn, (void)name;
    nominal[0] = value[0] != NULL ? strtod(value[0], NULL) : NAN;
    nominal[1] = value[1] != NULL ? strtod(value[1], NULL) : NAN;
    return false;
}

/* Bands and shares are made anew from all samples: old and new ones are equal. */
static bool judge_point(struct store *s, const struct point *x, int n, struct err *e)
{
    char id[24];
    snprintf(id, sizeof id, "%lld", (long long)x->id);
    const char *const bound[] = {id};
    /* what is not stored is not known */
    struct results r = {.rows = x->rows};
    /* time and speedup of the run that the band is around */
    double nominal[2] = {NAN, NAN};
    r.makespan = memory_take((size_t)x->rows, sizeof *r.makespan);
    r.speedup = memory_take((size_t)x->rows, sizeof *r.speedup);
    for (int i = 0; i < x->rows; i++) r.makespan[i] = r.speedup[i] = NAN;
    bool ok =
        store_select(
            s, "SELECT sample, makespan_ps, serial_ps FROM uncertainty_sample WHERE run_id = ?1", 1,
            bound, add_result, &r, e) &&
        store_select(
            s,
            "SELECT r.makespan_ps, (SELECT speedup FROM v_speedup v WHERE v.run_id = r.id AND"
            " v.baseline = 'fastest serial') FROM run r WHERE r.id = ?1",
            1, bound, add_nominal, nominal, e);
    ok = ok && store_begin(s, e);
    if (ok) {
        ok = store_delete(s, "uncertainty", "run_id", store_int(x->id), e) &&
             store_delete(s, "uncertainty_share", "run_id", store_int(x->id), e) &&
             judge_quantity(s, x, n, "makespan_ps", nominal[0], r.makespan, e) &&
             judge_quantity(s, x, n, "speedup", nominal[1], r.speedup, e);
        if (ok) ok = store_commit(s, e);
        else store_rollback(s);
    }
    free(r.makespan);
    free(r.speedup);
    return ok;
}

/* The design of a run, and everything about it. 1: done, 0: nothing to do, -1: failed. */
static int do_point(const struct common *c, const struct plan *p, int index,
                    const struct uncertainty_options *o, struct store *s, struct err *e)
{
    struct point x = {.run = &p->run[index], .id = store_run_id(s, &p->run[index])};
    /* what did not run has nothing that could be uncertain */
    if (x.id == 0 || !store_has(s, x.run)) return 0;
    struct arena *a = arena_create();
    x.k = parameters_of(p, index, a, &x.parameter);
    bool ok = true;
    if (x.k > 0) {
        /* bands take the two samples alone, which stand first in the design */
        const int64_t whole = variance_rows(o->n, x.k);
        x.rows = o->shares ? (int)whole : 2 * o->n;
        x.u = TAKE(a, size_product(whole, x.k), double);
        variance_design(UNCERTAINTY_SEED, o->n, x.k, x.u);
        identify(&x, o->n);
        ok = run_point(c, &x, s, e) && judge_point(s, &x, o->n, e);
    }
    const bool some = x.k > 0;
    arena_destroy(a);
    return ok ? some : -1;
}

/* Point by point: each is kept when it is complete. */
bool uncertainty_run(const struct common *c, const struct plan *p,
                     const struct uncertainty_options *o, struct store *s, struct err *e)
{
    /* runs that had something uncertain */
    int done = 0;
    for (int i = 0; i < p->nrun; i++) {
        const int one = do_point(c, p, i, o, s, e);
        if (one < 0) return false;
        done += one;
    }
    if (done == 0 && !c->quiet)
        fprintf(stderr,
                "mimdsim: no parameter of these machines has a range or a class of evidence; "
                "the uncertainty is not known\n");
    return true;
}

/* Means over the runs of the plan; a parameter that is drawn in some runs only counts there. */
bool uncertainty_print(struct store *s, const struct plan *p, FILE *out, struct err *e)
{
    /* runs by their numbers: no text of a user becomes a part of SQL */
    struct text ids = {0};
    for (int i = 0; i < p->nrun; i++) {
        const int64_t id = store_run_id(s, &p->run[i]);
        if (id > 0) text_add(&ids, "%s%lld", ids.length ? "," : "[", (long long)id);
    }
    text_add(&ids, "%s]", ids.length ? "" : "[");
    const char *const bound[] = {ids.s};
    fputs("\nShare of the variance of the predicted time by parameter, mean over the runs "
          "(standard error):\n",
          out);
    const bool ok = report_query(
        s,
        "SELECT substr(key, 9) AS parameter, class, iif(printed, 'file', 'class') AS range_from, "
        "printf('%.1f %%', 100 * avg(first)) AS alone, printf('%.1f', 100 * avg(first_error)) AS "
        "\"+-\", printf('%.1f %%', 100 * avg(total)) AS with_interactions, printf('%.1f', 100 * "
        "avg(total_error)) AS \"+- \", count(*) AS runs FROM uncertainty_share WHERE quantity = "
        "'makespan_ps' AND first IS NOT NULL AND run_id IN (SELECT value FROM json_each(?1)) GROUP "
        "BY key, class, printed ORDER BY avg(total) DESC, key",
        1, bound, false, out, e);
    text_free(&ids);
    return ok;
}
