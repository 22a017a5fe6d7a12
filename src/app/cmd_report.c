/* cmd_report.c - mimdsim report: everything that a database holds, as pictures, Markdown and
 * HTML.
 *
 * Chapters without rows are left out: a database with one study gives a report on that study. */
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/parameters.h"
#include "app/verb.h"
#include "base/json.h"
#include "base/memory.h"
#include "base/text.h"
#include "report/report.h"
#include "report/report_document.h"
#include "store/store.h"

static const char doc[] =
    "Draw all figures for which the database DB (default mimdsim.db) has data, and\n"
    "write DB.md and DB.html next to the folder of figures: every run by kernel and\n"
    "machine, claims, figures, error against run time, stability, omissions and what\n"
    "they save. DB.html is one file without anything from elsewhere: its tables sort\n"
    "by a click on a heading, its pictures show numbers under the pointer.\n\n"
    "Example: mimdsim report mimdsim.db\n"
    "\vNothing is run: `mimdsim accuracy`, `stability` and `explain --measure` fill\n"
    "the database. Without gnuplot the report has no pictures, says so, and the exit\n"
    "status is 69.";

enum { MOST_FIGURES = 128, MOST_SCENARIOS = 64 }; /* with rows; with a plan */

/* What is gathered before the document can be written. */
struct report {
    const struct common *common;
    struct store *store; /* opened for reading */
    struct err *e;
    int undrawn; /* figures of which gnuplot has made no picture */
    int nfigure;
    char *figure[MOST_FIGURES]; /* drawn, and not shown in a section of their own */
    int nplan;
    struct plan plan[MOST_SCENARIOS]; /* (nplan) of the scenarios that still exist */
};

/* Their figures appear there, not in the chapter of figures. */
static bool has_section(const char *figure)
{
    return strcmp(figure, "accuracy") == 0 || strcmp(figure, "stability") == 0 ||
           strcmp(figure, "omissions") == 0 || strcmp(figure, "explain") == 0 ||
           strcmp(figure, "runs") == 0;
}

/* Draw `name`, taken over, if there are rows for it: most databases have rows for a few figures. */
static bool draw(struct report *r, char *name)
{
    struct err e;
    err_clear(&e);
    bool drawn = report_figure(r->store, plan_data_dir(), name, r->common->directory, &e);
    if (!drawn && e.kind == ERR_UNAVAILABLE) {
        if (r->undrawn++ == 0) err_print(&e); /* of all figures the reason is the same */
        drawn = true; /* as numbers */
    }
    /* The name is kept, or freed here. */
    if (drawn && !has_section(name) && r->nfigure < MOST_FIGURES) r->figure[r->nfigure++] = name;
    else free(name);
    /* No rows: the figure is of another study. A description that cannot be read is none of
     * that. */
    const bool no_rows = e.kind == ERR_NO_INPUT && e.file[0] == '\0';
    if (!drawn && !no_rows) *r->e = e;
    return drawn || no_rows;
}

/* Every figure that plots/ has: a new one needs no line here. */
static bool draw_all(struct report *r)
{
    char **name;
    int n = report_figures(plan_data_dir(), &name);
    bool ok = true;
    for (int i = 0; i < n; i++) {
        if (ok) ok = draw(r, name[i]);
        else free(name[i]);
    }
    free(name);
    return ok;
}

/* The plan of a scenario, for the numbers of its machine. A file that does not exist any more,
 * or has changed, is left out: the report is about what is stored. */
static bool add_plan(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    struct report *r = context;
    struct plan_options o = common_plan(r->common);
    struct err ignored;
    (void)ncolumn;
    (void)name;
    err_clear(&ignored);
    if (r->nplan == MOST_SCENARIOS) return false;
    if (plan_read(&r->plan[r->nplan], value[0], &o, &ignored)) r->nplan++;
    else plan_free(&r->plan[r->nplan]);
    /* One that is there and cannot be read is worth a word. */
    if (ignored.file[0] && ignored.kind != ERR_DATA && ignored.kind != ERR_CONFIG)
        fprintf(stderr, "mimdsim: the machine of scenario %s is left out of the report: %s: %s\n",
                value[0], ignored.file, ignored.text);
    return true;
}

/* "a/paper.db": "paper"; a dot in front is part of the name. */
static char *stem_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *stem = memory_text(slash ? slash + 1 : path);
    char *dot = strrchr(stem, '.');
    if (dot && dot != stem) *dot = '\0';
    return stem;
}

/* The report is named after the database and lies beside the folder of figures. */
static bool write_document(struct report *r, const char *path, const char *stem)
{
    struct arena *a = arena_create();
    struct text title = {0};
    text_add(&title, "What %s holds", path);
    struct document d = {.store = r->store,
                         .name = stem,
                         .title = title.s,
                         .data_dir = plan_data_dir(),
                         .figures = r->common->directory,
                         .nfigure = r->nfigure,
                         .figure = (const char *const *)r->figure};
    bool ok = store_select(r->store, "SELECT DISTINCT scenario FROM run ORDER BY 1", 0, NULL,
                           add_plan, r, r->e) &&
              parameters_gather(r->plan, r->nplan, a, &d.parameter, &d.nparameter, r->e) &&
              document_write(&d, r->e);
    text_free(&title);
    arena_destroy(a);
    return ok;
}

/* Which files were written: paths, or a list of them. */
static void tell(const struct common *c, const char *stem)
{
    static const char *const ending[] = {"md", "html"}; /* as page.c writes them */
    const char *slash = strrchr(c->directory, '/');
    struct json j = json_make(stdout);
    if (c->json) json_array(&j);
    for (int i = 0; i < 2; i++) {
        struct text t = {0};
        text_add(&t, "%.*s%s.%s", slash ? (int)(slash + 1 - c->directory) : 0, c->directory, stem,
                 ending[i]);
        if (c->json) json_text(&j, t.s);
        else puts(t.s);
        text_free(&t);
    }
    if (!c->json) return;
    json_end(&j);
    json_finish(&j);
}

/* The database is only read; figures and report are files beside each other. */
int cmd_report(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, TAKES_DIR, "[DB]", doc, 0, 1);
    const char *path = c.narg ? c.arg[0] : "mimdsim.db";
    char *stem = stem_of(path);
    struct err e;
    err_clear(&e);
    /* Too large for the stack: plans are kept until the document is written. */
    struct report *r = memory_zeroed(1, sizeof *r);
    *r = (struct report){.common = &c, .e = &e};
    r->store = arguments_database(&c, "mimdsim.db", &e);
    bool ok = r->store && draw_all(r) && write_document(r, path, stem);
    if (ok) tell(&c, stem);
    store_close(r->store);
    for (int i = 0; i < r->nfigure; i++) free(r->figure[i]);
    for (int i = 0; i < r->nplan; i++) plan_free(&r->plan[i]);
    const int undrawn = r->undrawn;
    /* The report is there, with the numbers; that its pictures are not is a failure all the
     * same. */
    if (ok && undrawn > 0)
        fprintf(stderr, "mimdsim: the report %s.html has no pictures, or not all of them\n", stem);
    free(r);
    free(stem);
    if (!ok) return common_fail(&c, &e);
    /* The report is there, and says which figures are not. */
    return undrawn > 0 ? err_exit_status(ERR_UNAVAILABLE) : 0;
}
