/* cmd_timeline.c - mimdsim timeline: who computes, sends and waits when, in one run.
 *
 * One run, whether stored or made now, in all formats that people can look at: bars of letters,
 * a picture, and traces for two kinds of viewers. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/verb.h"
#include "base/beside.h"
#include "base/check.h"
#include "plan/file_kind.h"
#include "report/report.h"
#include "report/trace.h"
#include "run/run.h"
#include "store/store.h"

static const char doc[] =
    "Show the timeline of one run: run RUN of the database DB (default: the first with a "
    "timeline), or the first point of "
    "SCENARIO, which is run for this.\n\n"
    "Example: mimdsim timeline scenarios/fig8.yaml\n"
    "         mimdsim timeline paper.db --format chrome\n"
    "\vText goes to standard output, the rest into the folder: timeline.png and .svg (gnuplot), "
    "timeline.json (Chrome trace "
    "events: ui.perfetto.dev), timeline.paje (ViTE). Traces hold at most 200000 spans and "
    "pictures 20000, because viewers fail on more; a remark says how many are omitted.";

enum { PICTURE_SPANS = 20000 }; /* more bars than these gnuplot draws for minutes */

/* The run that is shown, wherever it came from. */
struct shown {
    const struct common *common;
    struct err *e;
    struct arena *arena;
    struct store *store; /* where the picture finds the run */
    int64_t run_id; /* in `store`; 0: there is none */
    struct run_result result; /* with its spans */
    enum run_status status; /* of the run shown */
    char title[160]; /* kernel, machine, n and P */
};

/* By content: a database may have any name. */
static bool is_database(const char *path)
{
    struct arena *a = arena_create();
    bool yes = file_kind_of(path, a) == FILE_DATABASE;
    arena_destroy(a);
    return yes;
}

/* The run's title and status. A run that did not end well is shown all the same, with its
 * reason. */
static bool take_first(void *context, int ncolumn, const char *const *name,
                       const struct store_value *value)
{
    struct shown *t = context;
    (void)ncolumn;
    (void)name;
    t->run_id = value[0].integer;
    snprintf(t->title, sizeof t->title, "%s", value[1].text ? value[1].text : "");
    t->status = strcmp(value[2].text, "ok") == 0         ? RUN_OK
                : strcmp(value[2].text, "deadlock") == 0 ? RUN_DEADLOCK
                                                         : RUN_INVALID;
    if (t->status != RUN_OK) fprintf(stderr, "mimdsim: %s: %s\n", t->title, value[3].text);
    return false;
}

/* A stored run: the one asked for, or the first that has spans. */
static bool from_database(struct shown *t)
{
    const char *wanted = t->common->narg > 1 ? t->common->arg[1] : NULL;
    const char *const param[] = {wanted};
    t->store = arguments_database(t->common, "", t->e);
    if (!t->store || (wanted && !arguments_run_number(wanted, t->e)) || !store_query(t->store,
                                  "SELECT id, format('%s on %s, n = %d, P = %d', kernel, machine,"
                                  " n, P), status,"
                                  " text FROM run"
                                  " WHERE id = ifnull(?1, (SELECT min(run_id) FROM span))",
                                  1, param, NULL, take_first, t, t->e))
        return false;
    if (!t->run_id)
        return err_set(t->e, ERR_NO_INPUT,
                       wanted ? "there is no run %s in %s"
                              : "no run%s of %s has a timeline; record it with "
                                "`record: {spans: true}`",
                       wanted ? wanted : "", t->common->arg[0]);
    return trace_read(t->store, t->run_id, t->arena, &t->result, t->e);
}

/* The first point of a scenario, run now with its spans, into a database in memory: the picture
 * is drawn by a query. */
static bool from_scenario(struct shown *t)
{
    struct plan plan = {0};
    struct plan_options o = common_plan(t->common);
    if (!plan_read(&plan, t->common->arg[0], &o, t->e)) return false;
    /* The first point only: a timeline of a sweep would be unreadable. */
    struct run_spec spec = plan.run[0];
    /* Recording is switched on whatever the scenario says. */
    spec.record.spans = true;
    snprintf(t->title, sizeof t->title, "%s on %s, n = %d, P = %d", spec.kernel.name,
             spec.machine.name, spec.model.nbody, spec.nrank);
    if (plan.nrun > 1 && !t->common->quiet)
        fprintf(stderr, "mimdsim: the first of %d points: %s\n", plan.nrun, t->title);
    bool ok = run_one(&spec, t->arena, &t->result, t->e);
    t->status = t->result.status;
    if (ok && t->status != RUN_OK) fprintf(stderr, "mimdsim: %s: %s\n", t->title, t->result.text);
    t->store = ok ? store_open("timeline", STORE_MEMORY, t->e) : NULL;
    ok = ok && t->store && store_put(t->store, &spec, NULL, &t->result, t->e);
    if (ok) t->run_id = store_run_id(t->store, &spec);
    plan_free(&plan);
    return ok;
}

/* One format, to a file in the folder, or to standard output. */
static bool write_trace(struct shown *t, enum trace_format format, const char *ending)
{
    char path[512] = "standard output";
    int64_t left_out = 0;
    struct trace_options o = {.title = t->title};
    struct beside file = {.out = stdout};
    if (ending) {
        if (!report_folder(t->common->directory, t->e)) return false;
        snprintf(path, sizeof path, "%s/timeline.%s", t->common->directory, ending);
        if (!beside_begin(&file, path, t->e)) return false;
    }
    bool ok = trace_write(&t->result, format, &o, file.out, &left_out, t->e);
    if (ending) ok = beside_end(&file, ok, t->e) && ok;
    if (ok && ending && !t->common->quiet) fprintf(stderr, "mimdsim: %s\n", path);
    /* What was cut is said: a trace that ends early would be misread. */
    if (ok && format == TRACE_GOAL && left_out > 0)
        fprintf(stderr,
                "mimdsim: %s: %lld waits in barriers of the machine are written as computing times: "
                "the language GOAL has no barriers\n",
                path, (long long)left_out);
    else if (ok && left_out > 0)
        fprintf(stderr, "mimdsim: %s: the last %lld of %lld spans are omitted, because viewers "
                        "fail on more than %d\n",
                path, (long long)left_out, (long long)t->result.nspan, TRACE_MAX_SPANS);
    return ok;
}

/* The picture is figure fig8 of this one run. Reasons not to draw are remarks: the other formats
 * are written. */
static bool draw_picture(struct shown *t)
{
    if (t->status == RUN_DEADLOCK) {
        fprintf(stderr, "mimdsim: no picture: a run that does not end has no time axis\n");
        return true;
    }
    if (t->result.nspan > PICTURE_SPANS) {
        fprintf(stderr, "mimdsim: no picture: %lld spans are too many; the most is %d\n",
                (long long)t->result.nspan, PICTURE_SPANS);
        return true;
    }
    bool ok = report_figure_run(t->store, plan_data_dir(), "fig8", t->run_id, "timeline",
                                t->common->directory, t->e);
    if (ok && !t->common->quiet)
        fprintf(stderr, "mimdsim: %s/timeline.png\n", t->common->directory);
    return ok;
}

/* Without --format everything that people can open; with --json the Chrome trace, which is JSON. */
static bool show(struct shown *t)
{
    /* text goes to standard output and has no ending */
    static const char *const ending[] = {
        [TRACE_CHROME] = "json", [TRACE_PAJE] = "paje", [TRACE_CSV] = "csv", [TRACE_GOAL] = "goal"};
    const char *word = t->common->format;
    enum trace_format format;
    if (!word && t->common->json) return write_trace(t, TRACE_CHROME, NULL);
    if (!word)
        return write_trace(t, TRACE_TEXT, NULL) && write_trace(t, TRACE_CHROME, "json") &&
               write_trace(t, TRACE_PAJE, "paje") && draw_picture(t);
    if (strcmp(word, "picture") == 0) return draw_picture(t);
    if (!trace_format_find(word, &format))
        return err_set(t->e, ERR_USAGE,
                       "--format: '%s' is none of picture, text, chrome, paje, csv, goal", word);
    return write_trace(t, format, format == TRACE_TEXT ? NULL : ending[format]);
}

/* A database or a scenario: the content of the file decides. */
int cmd_timeline(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_DIR | TAKES_FORMAT, "SCENARIO|DB [RUN]", doc, 1,
                 2);
    struct err e;
    err_clear(&e);
    struct shown t = {.common = &c, .e = &e, .arena = arena_create()};
    /* Two arguments are a database and a run, even if the file is none: then that is the mistake
     * to tell. */
    bool ok =
        (is_database(c.arg[0]) || c.narg > 1 ? from_database(&t) : from_scenario(&t)) && show(&t);
    store_close(t.store);
    arena_destroy(t.arena);
    if (!ok) return common_fail(&c, &e);
    /* What the run found is the exit status, as with `run`. */
    if (t.status == RUN_DEADLOCK) return err_exit_status(ERR_DEADLOCK);
    return t.status == RUN_OK ? 0 : err_exit_status(ERR_CHECK);
}
