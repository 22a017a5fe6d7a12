/* cmd_interference.c - mimdsim interference: how much longer jobs take beside each other, and
 * beside background traffic of the same load.
 *
 * The scenario's jobs are run alone, in pairs and all together, which are runs like any others.
 * What the others load the network with is then known from their link loads, and each job is run
 * once more, alone, with that much random traffic in their place: the cheap way, with its error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/keep.h"
#include "app/verb.h"
#include "base/json.h"
#include "base/size.h"
#include "plan/machine_changes.h"
#include "report/report.h"
#include "run/run.h"
#include "spec/identity.h"
#include "store/store.h"

static const char doc[] =
    "Run the jobs of SCENARIO alone, in all pairs and all together, print how much longer each "
    "takes beside each other one, and draw the matrix as interference.png and .svg.\n\n"
    "Example: mimdsim interference neighbours\n"
    "\vEach job lies on the same processors in every combination. Beside 'background' it runs "
    "alone, with random traffic on all links in place of the others: as much as they put on the "
    "mean link, in messages of their mean size, drawn five times (once where the program or the "
    "machine draws, too). Its error is the slowdown beside it over the slowdown beside all "
    "others, less one. Runs that are stored already are not repeated.";

/* SAMPLES: of the background, which is drawn by chance. */
enum { SAMPLES = 5 };

/* The largest load, and the largest message of it, that a machine file may state. Rows may have
 * been written by others. */
static const double MOST_LOAD = 0.95, MOST_BYTES = 1 << 30;

struct request {
    const struct common *common;
    struct plan plan;
    struct store *store;
    struct arena *arena;
    struct err *err;
    int failed; /* runs that did not end well */
};

/* ---- runs */

/* Into the database, as `mimdsim run` does it; what went wrong is told at once. */
static bool keep_result(void *context, const struct run_spec *spec, const struct run_result *result)
{
    struct request *r = context;
    if (result->status != RUN_OK) {
        r->failed++;
        fprintf(stderr, "mimdsim: job %s beside '%s': %s\n", spec->job.name, spec->job.beside,
                result->text);
    }
    return store_put(r->store, spec, NULL, result, r->err);
}

/* Those that are not stored yet. */
static bool make_runs(struct request *r, const struct run_spec *run, int n)
{
    /* Points that cannot run were told by the plan. */
    bool *skip = TAKE(r->arena, n + 1, bool);
    for (int i = 0; i < n; i++)
        skip[i] = run[i].refused != NULL || (store_has(r->store, &run[i]) && !r->common->force);
    return n == 0 || run_campaign(run, NULL, n, skip, r->common->jobs, r->common->quiet,
                                  keep_result, r, r->err);
}

/* ---- what takes the place of the others */

/* Mean busy share of all links, and mean size of a message on them [B]. */
struct traffic {
    double load, bytes;
};

/* One row; a database without link loads gives NULL. */
static bool take_traffic(void *context, int ncolumn, const char *const *name,
                         const struct store_value *v)
{
    struct traffic *t = context;
    (void)ncolumn, (void)name;
    if (v[0].kind == STORE_REAL) t->load = v[0].real;
    if (v[1].kind == STORE_REAL) t->bytes = v[1].real;
    return false;
}

/* Of the jobs that run beside `job` when all do: each as if it went on for ever as in its own run.
 * Only links count: ports are a node's own. */
static const char traffic_sql[] =
    "WITH other AS (SELECT r.id, r.makespan_ps FROM run r JOIN v_setting s ON s.run_id = r.id AND "
    "s.key = 'job.set' AND s.value = ?1 JOIN v_setting n ON n.run_id = r.id AND n.key = 'job.name' "
    "AND n.value <> ?2 JOIN v_setting b ON b.run_id = r.id AND b.key = 'job.beside' WHERE "
    "r.rep = 0 "
    "AND r.status = 'ok' AND length(b.value) = (SELECT max(length(v.value)) FROM v_setting v JOIN "
    "v_setting w ON w.run_id = v.run_id AND w.key = 'job.set' AND w.value = ?1 JOIN v_setting m ON "
    "m.run_id = v.run_id AND m.key = 'job.name' AND m.value = n.value WHERE v.key = 'job.beside')) "
    "SELECT total(1.0 * l.busy_ps / o.makespan_ps) / count(DISTINCT l.link), 1.0 * "
    "total(l.sent_bytes) / nullif(total(l.messages), 0) FROM link_load l JOIN other o ON o.id = "
    "l.run_id WHERE l.from_router IS NOT NULL AND l.to_router IS NOT NULL AND o.makespan_ps > 0";

/* As people read it, and back: the same bits on every host. */
static double four_digits(double x)
{
    char text[32];
    snprintf(text, sizeof text, "%.3e", x);
    return strtod(text, NULL);
}

/* The run alone with that much traffic of strangers; false: it has none to be beside. */
static bool background_of(struct request *r, const struct run_spec *alone, struct run_spec *run)
{
    const char *const param[] = {alone->job.set, alone->job.name};
    struct traffic t = {0};
    /* Read anew for each: there are few, and each differs by its load alone. */
    struct machine_changes known = {.arena = r->arena};
    if (!store_query(r->store, traffic_sql, 2, param, NULL, take_traffic, &t, r->err) ||
        t.load <= 0)
        return false;
    *run = *alone;
    /* The links of a machine file are never busy all the time. Four digits: the load is a mean over
     * a run, and stands in the names of machines and figures. */
    run->machine.noise.background_load = four_digits(t.load < MOST_LOAD ? t.load : MOST_LOAD);
    run->machine.noise.background_bytes = (int64_t)fmin(fmax(t.bytes, 1), MOST_BYTES);
    memset(run->job.beside, 0, sizeof run->job.beside);
    text_copy(run->job.beside, sizeof run->job.beside, "background");
    /* Another machine than before, in what it is called and in what it differs by. */
    run->called = NULL;
    machine_changes_note(&known, run);
    run_identify(run, r->arena);
    return true;
}

/* Level loggp knows no links, and a scenario that has background of its own asks something else. */
static bool takes_background(const struct run_spec *run)
{
    return run->job.beside[0] == '\0' && run->rep == 0 && run->refused == NULL &&
           run->machine.network.level != LEVEL_LOGGP && run->machine.noise.background_load <= 0;
}

/* A repetition draws all chances anew: where the job itself has some, it would be another one. */
static int samples_of(const struct run_spec *run)
{
    const bool own =
        kernel_spec_has(&run->kernel, PROGRAM_RANDOM) || run->machine.noise.compute_cv > 0;
    return own ? 1 : SAMPLES;
}

/* All of them, once the runs beside real neighbours are stored. */
static bool make_background(struct request *r)
{
    const size_t most = size_product(SAMPLES, (size_t)r->plan.nrun + 1);
    struct run_spec *run = TAKE(r->arena, most, struct run_spec);
    int n = 0;
    /* One for each job of each point. */
    for (int i = 0; i < r->plan.nrun; i++) {
        if (!takes_background(&r->plan.run[i])) continue;
        if (background_of(r, &r->plan.run[i], &run[n])) {
            const int samples = samples_of(&run[n]);
            for (int k = 1; k < samples; k++) {
                run[n + k] = run[n];
                run[n + k].rep = k;
            }
            n += samples;
        } else if (r->err->kind != ERR_NONE) return false;
    }
    return make_runs(r, run, n);
}

/* ---- what is told */

/* ?1: a JSON array of job.set. Slow-downs are means over repetitions. */
static const char table_sql[] =
    "WITH wanted AS (SELECT value AS job_set, min(key) AS place FROM json_each(?1) GROUP BY "
    "value), "
    "member AS (SELECT r.id, r.kernel, r.P, r.makespan_ps, r.machine, r.level, r.placement, "
    "r.background_load, s.value AS job_set, w.place, n.value AS job, CAST(k.value AS INTEGER) AS "
    "number, b.value AS beside FROM run r JOIN v_setting s ON s.run_id = r.id AND s.key = "
    "'job.set' JOIN wanted w ON w.job_set = s.value JOIN v_setting n ON n.run_id = r.id AND "
    "n.key = "
    "'job.name' JOIN v_setting k ON k.run_id = r.id AND k.key = 'job.number' JOIN v_setting b ON "
    "b.run_id = r.id AND b.key = 'job.beside' WHERE r.status = 'ok'), "
    "time AS (SELECT *, avg(makespan_ps) AS ps, min(id) AS first FROM member GROUP BY job_set, "
    "job, "
    "beside), "
    "cell AS (SELECT t.*, a.ps AS alone_ps, 1.0 * t.ps / nullif(a.ps, 0) AS slowdown, t.beside = "
    "'background' AS strangers FROM time t JOIN time a ON a.job_set = t.job_set AND a.job = t.job "
    "AND a.beside = '' WHERE t.beside <> ''), "
    "whole AS (SELECT job_set, job, slowdown FROM (SELECT *, row_number() OVER (PARTITION BY "
    "job_set, job ORDER BY length(beside) DESC, first DESC) AS nth FROM cell WHERE NOT strangers) "
    "WHERE nth = 1) "
    "SELECT c.job, c.beside, c.kernel, c.P, c.machine, c.level, c.placement, c.alone_ps / 1e6 AS "
    "alone_us, c.ps / 1e6 AS makespan_us, round(c.slowdown, 4) AS slowdown, iif(c.strangers, "
    "round(100 * c.background_load, 2), NULL) AS background_percent, iif(c.strangers, round(100 * "
    "(c.slowdown / w.slowdown - 1), 1), NULL) AS error_percent FROM cell c LEFT JOIN whole w ON "
    "w.job_set = c.job_set AND w.job = c.job ORDER BY c.place, c.number, c.strangers, "
    "length(c.beside) - length(replace(c.beside, '+', '')), c.first";

/* Only the sets of this plan: the database may have others. */
static bool print_table(struct request *r)
{
    struct text sets = {0};
    /* Runs of one set follow each other. */
    const char *last = "";
    for (int i = 0; i < r->plan.nrun; i++) {
        if (strcmp(last, r->plan.run[i].job.set) == 0) continue;
        last = r->plan.run[i].job.set;
        text_add(&sets, "%s\"%s\"", sets.length > 0 ? "," : "[", last);
    }
    text_add(&sets, "]");
    /* People get a table, programs the same rows as JSON. */
    const char *const param[] = {sets.s};
    const bool ok =
        report_query(r->store, table_sql, 1, param, r->common->json, stdout, r->err);
    text_free(&sets);
    return ok;
}

/* ---- all */

/* All combinations, with what passes each link; the user's own settings have the last word. */
static bool read_plan(struct request *r)
{
    const char *set[COMMON_MOST_SETS + 2] = {"combinations=alone,pairs,all", "record.links=true"};
    /* In this order: what is given last counts. */
    struct plan_options o = common_plan(r->common);
    for (int i = 0; i < o.nset; i++) set[2 + i] = o.set[i];
    o.set = set;
    o.nset += 2;
    return plan_read(&r->plan, r->common->arg[0], &o, r->err);
}

static bool answer(struct request *r)
{
    if (!read_plan(r) || !report_folder_check(r->common->directory, r->err)) return false;
    r->store = arguments_store(r->common, r->common->database, r->err);
    /* Rows first: table and picture are made of them. */
    return r->store && make_runs(r, r->plan.run, r->plan.nrun) && make_background(r) &&
           print_table(r) && keep_draw(r->common, r->store, "interference", r->err);
}

int cmd_interference(int argc, char **argv)
{
    struct common c;
    struct err e;
    err_clear(&e);
    /* Levels are swept by the scenario, or by --set. */
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_STORE | TAKES_DIR | TAKES_JOBS, "SCENARIO", doc,
                 1, 1);
    struct request r = {.common = &c, .arena = arena_create(), .err = &e};
    const bool ok = answer(&r);
    store_close(r.store);
    plan_free(&r.plan);
    arena_destroy(r.arena);
    if (!ok) return common_fail(&c, &e);
    return r.failed > 0 ? 1 : 0;
}
