/* cmd_why.c - mimdsim why: what limits a run, what each parameter contributes, and what would help.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/flag.h"
#include "app/known_error.h"
#include "app/verb.h"
#include "app/why_beside.h"
#include "app/why_print.h"
#include "plan/file_kind.h"
#include "report/how_sure.h"
#include "spec/identity.h"
#include "store/store.h"

static const char doc[] = "Explain what the time of a run is made of: its critical path by cause, "
                          "stage and rank, what each parameter of the "
                          "machine contributes, what idealised machines would gain, and how "
                          "much later everything else may be (slack).\n\n"
                          "Example: mimdsim why speedup-t3e --set n=128\n"
                          "         mimdsim why mimdsim.db 3\n"
                          "\vThe first point of SCENARIO is explained, or with a database the run "
                          "RUN (column id of table run), which is made "
                          "again. A run of a scenario is stored with its explanation (tables "
                          "critical_path, sensitivity, path_range, ideal, path_resource, slack, "
                          "rank_slack, roofline); the figures are why, slack and roofline.\n\n"
                          "The critical path is the chain of operations that determines when the "
                          "last rank ends: its durations add up to the run's time. At levels loggp "
                          "and link the path goes through the message that holds a resource; at "
                          "the other levels that waiting is 'contention'. `count` is how often the "
                          "path pays the parameter: latencies, bytes, operations. The last column "
                          "tells by which factor the time behind a parameter may grow before the "
                          "run takes 5 % longer; it is confirmed by simulation. 'On another path' "
                          "means that other operations determine the time by then, and 'from' the "
                          "factor at which they take over.\n\n"
                          "'Perfect balance' lets every rank compute the mean over all ranks in "
                          "each stage. Slack is the longest delay that leaves the run as long as "
                          "it is. The last table says which rate computing, the port and message "
                          "software would allow by themselves.\n\n"
                          "--brief: the path and the contributions alone, from one run.";

static const char run_sql[] =
    "SELECT r.config_text, r.rep, l.name FROM run r JOIN v_label l ON l.run_id = r.id "
    "WHERE r.id = CAST(?1 AS INTEGER)";

/* The row of the run that was asked for. */
struct found {
    struct text config, name;
    int rep;
    bool there;
};

/* The first row, and there is only one. Its texts are copied: they live as long as the query. */
static bool take_config(void *context, int ncolumn, const char *const *name,
                        const char *const *value)
{
    struct found *f = context;
    (void)ncolumn, (void)name;
    /* A row of an older database may lack its settings: then it counts as not found. */
    if (value[0] == NULL || value[1] == NULL) return false;
    text_add(&f->config, "%s", value[0]);
    text_add(&f->name, "%s", value[2] != NULL ? value[2] : "");
    f->rep = atoi(value[1]);
    f->there = true;
    return false;
}

/* The settings of a stored run. */
static bool from_database(const struct common *c, struct run_spec *run, struct arena *a,
                          struct err *e)
{
    char why[256];
    struct found f = {0};
    if (c->narg < 2)
        return err_set(e, ERR_USAGE,
                       "which run of %s? `mimdsim query %s \"SELECT run_id, name, n, P, level FROM "
                       "v_run\"` lists them",
                       c->arg[0], c->arg[0]);
    const char *const param[] = {c->arg[1]};
    struct store *s = arguments_database(c, "", e);
    bool ok = s && arguments_run_number(c->arg[1], e) &&
              store_select(s, run_sql, 1, param, take_config, &f, e);
    if (ok && !f.there)
        ok = err_set(e, ERR_NO_INPUT, "there is no run %s in %s", c->arg[1], c->arg[0]);
    /* The settings are text, and keys may have changed since: what cannot be read is refused
     * with its reason, not guessed. */
    if (ok && !run_from_text(run, f.config.s, a, why, sizeof why))
        ok = err_set(e, ERR_DATA, "run %s of %s cannot be made again: %s", c->arg[1], c->arg[0],
                     why);
    /* The repetition is no setting, but the seed of its random numbers depends on it. */
    if (ok) run->rep = f.rep;
    /* What it was called then is no setting, either. */
    if (ok && f.name.length > 0) run->called = arena_text(a, f.name.s);
    text_free(&f.config);
    text_free(&f.name);
    store_close(s);
    return ok;
}

/* ---- rows ---- */

/* Each table is emptied first, so that explaining a run again leaves no row of before. All of it
 * is written within one transaction: a run has its whole explanation, or the one of before. */
static bool put_shares(struct store *s, int64_t run, const struct why *w, struct err *e)
{
    static const char *const name[] = {"run_id", "stage", "cause", "time_ps", "steps"};
    bool ok = store_delete(s, "critical_path", "run_id", store_int(run), e);
    for (int i = 0; ok && i < w->nshare; i++) {
        const struct store_value v[] = {
            store_int(run), store_text(w->run.stage_name[w->share[i].stage]),
            store_text(path_cause_word(w->share[i].cause)), store_int(w->share[i].time_ps),
            store_int(w->share[i].steps)};
        ok = store_insert(s, "critical_path", 5, name, v, e);
    }
    return ok;
}

/* Factors that were not asked for, or not found, are NULL. */
static bool put_parameters(struct store *s, int64_t run, const struct why *w, struct err *e)
{
    static const char *const name[] = {"run_id",           "key",      "rate", "time_ps", "count",
                                       "factor_5_percent", "same_path"};
    bool ok = store_delete(s, "sensitivity", "run_id", store_int(run), e);
    for (int i = 0; ok && i < w->nparameter; i++) {
        const struct why_parameter *p = &w->parameter[i];
        const struct store_value v[] = {store_int(run),
                                        store_text(p->key),
                                        store_int(p->rate),
                                        store_int(p->time_ps),
                                        p->count > 0 ? store_real(p->count) : store_null(),
                                        p->tolerance > 0 ? store_real(p->tolerance) : store_null(),
                                        p->tolerance > 0 ? store_int(p->same_path) : store_null()};
        ok = store_insert(s, "sensitivity", 7, name, v, e);
    }
    return ok;
}

/* Only parameters behind which another path was found have one. */
static bool put_ranges(struct store *s, int64_t run, const struct why *w, struct err *e)
{
    static const char *const name[] = {"run_id", "key", "factor"};
    bool ok = store_delete(s, "path_range", "run_id", store_int(run), e);
    for (int i = 0; ok && i < w->nparameter; i++) {
        const struct why_parameter *p = &w->parameter[i];
        const struct store_value v[] = {store_int(run), store_text(p->key), store_real(p->range)};
        ok = p->range <= 0 || store_insert(s, "path_range", 3, name, v, e);
    }
    return ok;
}

/* What a level cannot run is NULL. */
static bool put_limits(struct store *s, int64_t run, const struct why *w, struct err *e)
{
    static const char *const name[] = {"run_id", "machine", "what", "makespan_ps"};
    bool ok = store_delete(s, "ideal", "run_id", store_int(run), e);
    for (int i = 0; ok && i < w->nlimit; i++) {
        const struct why_limit *l = &w->limit[i];
        const struct store_value v[] = {store_int(run), store_text(l->name), store_text(l->what),
                                        l->makespan_ps > 0 ? store_int(l->makespan_ps)
                                                           : store_null()};
        ok = store_insert(s, "ideal", 4, name, v, e);
    }
    return ok;
}

/* The run and what explains it, in one transaction. */
static bool put_all(const struct common *c, const struct run_spec *spec, const struct why *w,
                    struct err *e)
{
    struct store *s = arguments_store(c, c->database, e);
    /* A run that is stored already keeps its row; only its explanation is replaced. */
    bool ok =
        s && (store_has(s, spec) || store_put(s, spec, NULL, &w->run, e)) &&
        known_error_note(s, NULL, spec, 1, e) && store_begin(s, e);
    if (ok) {
        const int64_t run = store_run_id(s, spec);
        ok = put_shares(s, run, w, e) && put_parameters(s, run, w, e) &&
             put_ranges(s, run, w, e) && put_limits(s, run, w, e) && why_beside_put(s, run, w, e);
        if (ok) ok = store_commit(s, e);
        else store_rollback(s);
    }
    store_close(s);
    return ok;
}

/* ---- the verb ---- */

/* How far the time is known: of the run that was stored now, or of the one that was asked for. */
static bool tell_errors(const struct common *c, const struct run_spec *spec, bool keep,
                        const char *stored, struct text *out, struct err *e)
{
    struct how_sure h;
    struct text ids = {0};
    struct store *s = store_open(keep ? c->database : c->arg[0], STORE_READ, e);
    bool ok = s != NULL;
    if (ok && keep) text_add(&ids, "[%lld]", (long long)store_run_id(s, spec));
    else text_add(&ids, "[%lld]", strtoll(stored, NULL, 10));
    ok = ok && how_sure_read(s, ids.s, &h, e);
    if (ok) how_sure_sentence(&h, out);
    if (ok && out->length == 0) text_add(out, "How sure: not known.");
    text_free(&ids);
    store_close(s);
    return ok;
}

/* The study first: nothing is stored of a run that cannot be explained. `stored`: the number of the
 * run in a database, NULL: it is one of a scenario. */
static bool explain(const struct common *c, const struct run_spec *spec, const char *stored,
                    bool brief, struct arena *a, struct err *e)
{
    struct why w;
    if (!why_study(spec, brief ? 0 : WHY_ALL, c->jobs, c->quiet, a, &w, e))
        return false;
    const bool keep = stored == NULL;
    if (keep && !put_all(c, spec, &w, e)) return false;
    struct text sure = {0};
    bool ok = tell_errors(c, spec, keep, stored, &sure, e);
    if (ok && c->json) why_print_json(spec, &w, sure.s, stdout);
    else if (ok) why_print(spec, &w, sure.s, stdout);
    text_free(&sure);
    return ok;
}

/* Everything that a user can get wrong is found before the first run: a study takes a while. The
 * exit status is that of any verb; what was printed before a figure or a row failed stays valid. */
int cmd_why(int argc, char **argv)
{
    struct common c;
    /* One study needs three batches of runs; --brief only the first. */
    const bool brief = take_flag(&argc, argv, "--brief");
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_STORE | TAKES_JOBS, "SCENARIO\nDB RUN", doc, 1,
                 2);
    struct err e;
    err_clear(&e);
    struct arena *a = arena_create();
    struct plan p = {0};
    const struct plan_options o = common_plan(&c);
    const bool database = c.narg > 1 || file_kind_of(c.arg[0], a) == FILE_DATABASE;
    struct run_spec run;
    /* A database names the run by number; a scenario is read as by every other verb. */
    bool ok = database ? from_database(&c, &run, a, &e) : plan_read(&p, c.arg[0], &o, &e);
    if (ok && !database) {
        /* A scenario is a set of points; one of them is explained, and the reader is told which. */
        run = p.run[0];
        if (p.nrun > 1 && !c.quiet) fprintf(stderr, "mimdsim: the first of %d points\n", p.nrun);
    }
    ok = ok && explain(&c, &run, database ? c.arg[1] : NULL, brief, a, &e);
    plan_free(&p);
    arena_destroy(a);
    return ok ? 0 : common_fail(&c, &e);
}
