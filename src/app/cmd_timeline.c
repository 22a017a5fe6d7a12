/* cmd_timeline.c - mimdsim timeline: who computes, sends and waits when, in one run.
 *
 * One run, whether stored or made now, in all formats that people can look at: bars of letters,
 * a picture, and traces for two kinds of viewers. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/flag.h"
#include "app/verb.h"
#include "base/beside.h"
#include "base/check.h"
#include "base/text.h"
#include "base/units.h"
#include "plan/file_kind.h"
#include "report/report.h"
#include "report/timeline_picture.h"
#include "report/trace.h"
#include "run/run.h"
#include "spec/identity.h"
#include "spec/run_label.h"
#include "store/store.h"

static const char doc[] =
    "Show the timeline of one run: run RUN of the database DB (default: the first with a "
    "timeline), or the first point of SCENARIO, which is run for this.\n\n"
    "Example: mimdsim timeline scenarios/fig8.yaml\n"
    "         mimdsim timeline paper.db --format chrome\n"
    "         mimdsim timeline speedup-t3e --from \"300 us\" --to \"600 us\" --ranks 0..15\n"
    "\v--from TIME, --to TIME: this part of the run alone, such as \"300 us\"; --ranks A..B: these "
    "ranks alone.\n\n"
    "Text goes to standard output, the rest into the folder: timeline.png and .svg (gnuplot), "
    "timeline.json (Chrome trace "
    "events: ui.perfetto.dev), timeline.paje (ViTE). The picture takes any number of ranks: where "
    "they are more than it has rows, a row is a group of ranks and shows what they do most. Over "
    "it runs the critical path; of a stored run it is found by running it again. Traces hold at "
    "most 200000 spans, because viewers fail on more; a remark says how many are omitted.";

/* What part of the run is shown, as it was asked for. */
struct part {
    int64_t begin_ps, end_ps;  /* 0, 0: all of it */
    int first_rank, last_rank; /* with some_ranks */
    bool some_ranks;
};

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
    struct part part;
};

/* "300 us" in picoseconds. */
static bool read_time(const char *option, const char *text, int64_t *ps, struct err *e)
{
    char why[256];
    double seconds;
    if (!text) return true;
    if (!units_parse(text, UNIT_TIME, &seconds, why, sizeof why))
        return err_set(e, ERR_USAGE, "%s: %s", option, why);
    /* A run ends within 13.3 days (int64 picoseconds). */
    if (!(seconds >= 0 && seconds < 9e6))
        return err_set(e, ERR_USAGE, "%s: '%s' is not a time within a run", option, text);
    *ps = (int64_t)(seconds * 1e12 + 0.5);
    return true;
}

/* "3..7", or "3" alone. */
static bool read_ranks(const char *text, struct part *p, struct err *e)
{
    /* The whole text must be one of the two forms: %n tells where reading stopped. */
    int end = 0;
    if (!text) return true;
    bool ok = sscanf(text, "%d..%d%n", &p->first_rank, &p->last_rank, &end) == 2 && !text[end];
    if (!ok) {
        ok = sscanf(text, "%d%n", &p->first_rank, &end) == 1 && !text[end];
        p->last_rank = p->first_rank;
    }
    p->some_ranks = true;
    return (ok && p->first_rank >= 0 && p->last_rank >= p->first_rank) ||
           err_set(e, ERR_USAGE, "--ranks: '%s' is no range of ranks such as 0..15", text);
}

/* Both are known: whether the part lies in the run. */
static bool check_part(const struct shown *t)
{
    /* What a run has is known only now: messages tell it. */
    const struct part *p = &t->part;
    const struct run_result *r = &t->result;
    if (p->some_ranks && p->last_rank >= r->nrank)
        return err_set(t->e, ERR_USAGE, "--ranks: the run has ranks 0 to %d", r->nrank - 1);
    if (p->end_ps > 0 && p->end_ps <= p->begin_ps)
        return err_set(t->e, ERR_USAGE, "--to is not after --from");
    /* A run that is stuck has no end. */
    if (r->makespan_ps > 0 && p->begin_ps >= r->makespan_ps)
        return err_set(t->e, ERR_USAGE, "--from: the run ends at %.6g us",
                       (double)r->makespan_ps * 1e-6);
    return true;
}

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
    if (!t->store || (wanted && !arguments_run_number(wanted, t->e)) ||
        !store_query(
            t->store,
            "SELECT id, format('%s on %s%s, P = %d', kernel, machine, iif(nu > 0 OR id IN (SELECT "
            "run_id FROM v_setting WHERE key = 'program.n'), format(', n = %d', n), ''), P), "
            "status, text FROM run WHERE id = ifnull(?1, (SELECT min(run_id) FROM span))",
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

/* The settings of a stored run, to make it again. */
static bool take_config(void *context, int ncolumn, const char *const *name,
                        const char *const *value)
{
    (void)ncolumn;
    (void)name;
    if (value[0] && value[1]) text_add(context, "%s\n%s", value[1], value[0]);
    return false;
}

/* The critical path of a stored run is found by making the run again. That it cannot be made again
 * is a remark: the picture is drawn without it. */
static void find_path(struct shown *t)
{
    /* Settings are kept as text; the repetition decides the seed of random numbers. */
    char id[24], why[256] = "it has no settings";
    const char *const param[] = {id};
    struct text config = {0};
    struct run_spec spec;
    struct run_result again;
    struct err e;
    err_clear(&e);
    snprintf(id, sizeof id, "%lld", (long long)t->run_id);
    bool ok = store_select(t->store, "SELECT config_text, rep FROM run WHERE id = ?1", 1, param,
                           take_config, &config, &e) && config.s;
    const char *text = ok ? strchr(config.s, '\n') + 1 : NULL;
    ok = ok && run_from_text(&spec, text, t->arena, why, sizeof why);
    if (ok) {
        spec.rep = atoi(config.s);
        spec.record.path = true;
        ok = run_one(&spec, t->arena, &again, &e) && again.makespan_ps == t->result.makespan_ps;
        text_copy(why, sizeof why, e.kind ? e.text : "it takes another time now");
    }
    /* Another time would be another path: then none is drawn. */
    if (ok) {
        t->result.path = again.path;
        t->result.npath = again.npath;
    } else if (!t->common->quiet)
        fprintf(stderr,
                "mimdsim: the picture has no critical path: run %s cannot be made again: %s\n", id,
                why);
    text_free(&config);
}

/* Nothing goes into the folder. */
static bool only_prints(const struct common *c)
{
    return c->format != NULL ? strcmp(c->format, "text") == 0 : c->json;
}

/* The first point of a scenario, run now with its spans, into a database in memory: the picture
 * is drawn by a query. */
static bool from_scenario(struct shown *t)
{
    struct plan plan = {0};
    struct plan_options o = common_plan(t->common);
    if (!plan_read(&plan, t->common->arg[0], &o, t->e)) return false;
    if (!only_prints(t->common) && !report_folder_check(t->common->directory, t->e)) {
        plan_free(&plan);
        return false;
    }
    /* The first point only: a timeline of a sweep would be unreadable. */
    struct run_spec spec = plan.run[0];
    /* Recording is switched on whatever the scenario says. */
    spec.record.spans = spec.record.path = true;
    snprintf(t->title, sizeof t->title, "%s on %s%s", spec.kernel.name, spec.machine.name,
             run_size(&spec, spec.nrank).s);
    if (plan.nrun > 1 && !t->common->quiet)
        fprintf(stderr, "mimdsim: the first of %d points: %s\n", plan.nrun, t->title);
    bool ok = run_one(&spec, t->arena, &t->result, t->e);
    t->status = t->result.status;
    if (ok && t->status != RUN_OK) fprintf(stderr, "mimdsim: %s: %s\n", t->title, t->result.text);
    t->store = ok ? store_open("timeline", STORE_MEMORY, t->e) : NULL;
    /* For the picture's provenance: the row alone, as the spans are at hand. */
    struct run_result row = t->result;
    row.nspan = 0;
    row.span = NULL;
    ok = ok && t->store && store_put(t->store, &spec, NULL, &row, t->e);
    if (ok) t->run_id = store_run_id(t->store, &spec);
    plan_free(&plan);
    return ok;
}

/* One format, to a file in the folder, or to standard output. */
static bool write_trace(struct shown *t, enum trace_format format, const char *ending)
{
    char path[512] = "standard output";
    int64_t left_out = 0;
    struct trace_options o = {.title = t->title,
                              .begin_ps = t->part.begin_ps,
                              .end_ps = t->part.end_ps,
                              .first_rank = t->part.first_rank,
                              .last_rank = t->part.last_rank,
                              .some_ranks = t->part.some_ranks};
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
                "mimdsim: %s: %lld waits in barriers of the machine are written as computing "
                "times: the language GOAL has no barriers\n",
                path, (long long)left_out);
    else if (ok && left_out > 0)
        fprintf(stderr, "mimdsim: %s: the last %lld of %lld spans are omitted, because viewers "
                        "fail on more than %d\n",
                path, (long long)left_out, (long long)t->result.nspan, TRACE_MAX_SPANS);
    return ok;
}

/* The picture of the part that was asked for. Reasons not to draw are remarks: the other formats
 * are written. */
static bool draw_picture(struct shown *t)
{
    const struct part *p = &t->part;
    if (t->status == RUN_DEADLOCK) {
        fprintf(stderr, "mimdsim: no picture: a run that does not end has no time axis\n");
        return true;
    }
    /* What was run now has its path already. */
    if (t->result.npath == 0) find_path(t);
    /* The part that was asked for, or all of it. */
    const struct timeline_view v = {
        .run = &t->result,
        .run_id = t->run_id,
        .title = t->title,
        .first_rank = p->some_ranks ? p->first_rank : 0,
        .last_rank = p->some_ranks ? p->last_rank : t->result.nrank - 1,
        .begin_ps = p->begin_ps,
        .end_ps = p->end_ps > 0 && p->end_ps < t->result.makespan_ps ? p->end_ps
                                                                     : t->result.makespan_ps};
    if (v.end_ps <= v.begin_ps) {
        fprintf(stderr, "mimdsim: no picture: the run takes no time\n");
        return true;
    }
    bool ok =
        timeline_picture(t->store, plan_data_dir(), &v, "timeline", t->common->directory, t->e);
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
    struct err e;
    err_clear(&e);
    struct shown t = {.common = &c, .e = &e, .arena = arena_create()};
    /* The options of this verb alone come out first. */
    const char *from = take_value(&argc, argv, "--from"), *to = take_value(&argc, argv, "--to");
    const char *ranks = take_value(&argc, argv, "--ranks");
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_DIR | TAKES_FORMAT, "SCENARIO|DB [RUN]", doc, 1,
                 2);
    /* Two arguments are a database and a run, even if the file is none: then that is the mistake
     * to tell. */
    bool ok = read_time("--from", from, &t.part.begin_ps, &e) &&
              read_time("--to", to, &t.part.end_ps, &e) && read_ranks(ranks, &t.part, &e) &&
              (is_database(c.arg[0]) || c.narg > 1 ? from_database(&t) : from_scenario(&t)) &&
              check_part(&t) && show(&t);
    store_close(t.store);
    arena_destroy(t.arena);
    if (!ok) return common_fail(&c, &e);
    /* What the run found is the exit status, as with `run`. */
    if (t.status == RUN_DEADLOCK) return err_exit_status(ERR_DEADLOCK);
    return t.status == RUN_OK ? 0 : err_exit_status(ERR_CHECK);
}
