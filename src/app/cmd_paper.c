/* cmd_paper.c - mimdsim paper: every run, figure and claim of the paper, and the report of them.
 *
 * The study can be interrupted at any point and begun again: runs, samples and searches that are
 * stored are not made again, and the report is written last. */
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/explain_claims.h"
#include "app/flag.h"
#include "app/levels.h"
#include "app/parameters.h"
#include "app/sampling.h"
#include "app/scenes.h"
#include "app/verb.h"
#include "base/check.h"
#include "base/progress.h"
#include "report/claims.h"
#include "report/report.h"
#include "report/report_document.h"
#include "run/run.h"
#include "spec/run_label.h"
#include "store/store.h"

static const char doc[] =
    "Reproduce the evaluation of the paper: run its scenarios into paper.db, sample\n"
    "the uncertain machine parameters, measure error against run time, stability\n"
    "and omissions on five scenes, draw the figures, judge the claims, and write\n"
    "paper.md and paper.html next to the folder of figures.\n\n"
    "Example: mimdsim paper\n"
    "         mimdsim paper fig7         one figure with its runs\n"
    "\vRuns that are stored already are not repeated, unless --force is given.\n"
    "--paper-only: omit the five scenes; this takes two thirds of the time.";

enum { MOST_PLANS = 64, MOST_FIGURES = 128 }; /* scenarios; figures of the report */

/* What the stages of the study share. A stage returns false with *e set; what was stored before
 * stays. */
struct paper {
    const struct common *common; /* the command line */
    const char *database;
    struct store *store;
    struct err *e;
    struct claim_rules rules; /* read once, judged several times */
    const struct run_spec
        *run; /* the runs of all plans while they are made, and how each is executed */
    struct run_order *order; /* (runs) in step with `run` */
    bool paper_only; /* without the scenes */
    int failed;      /* runs that could not be made, or did not end */
    int undrawn; /* figures of which gnuplot has made no picture */
    int nplan;
    struct plan plan[MOST_PLANS]; /* (nplan) kept to the end for figures and parameters */
};

/* --set applies to all scenarios: a study with a changed machine. */
static bool add_plan(struct paper *p, const char *name)
{
    /* The study's scenarios are files of this program: too many would be our mistake. */
    CHECK(p->nplan < MOST_PLANS);
    struct plan_options o = common_plan(p->common);
    return plan_read(&p->plan[p->nplan++], name, &o, p->e);
}

/* All scenarios of the paper, by their names, or those asked for. */
static bool add_plans(struct paper *p)
{
    for (int i = 0; i < p->common->narg; i++)
        if (!add_plan(p, p->common->arg[i])) return false;
    if (p->common->narg) return true;
    const char **stem, **title;
    int n;
    struct arena *a = arena_create();
    bool ok = plan_list("scenarios", a, &stem, &title, &n, p->e);
    for (int i = 0; ok && i < n; i++)
        /* The names tell: figures of the paper, and studies around them. */
        if (strncmp(stem[i], "fig", 3) == 0 || strncmp(stem[i], "paper-", 6) == 0)
            ok = add_plan(p, stem[i]);
    arena_destroy(a);
    return ok;
}

/* A run that failed is stored with its reason and told; the others go on. */
static bool keep_result(void *context, const struct run_spec *spec, const struct run_result *r)
{
    struct paper *p = context;
    p->failed += r->status == RUN_FAILED;
    if (r->status != RUN_OK)
        fprintf(stderr, "mimdsim: %s: %s%s: %s\n", spec->scenario, spec->kernel.name,
                run_size(spec, spec->nrank).s, r->text);
    return store_put(p->store, spec, &p->order[spec - p->run], r, p->e);
}

/* The runs of all scenarios as one campaign, so that workers are busy until the last run of all,
 * not of each scenario. */
static bool run_plans(struct paper *p)
{
    int n = 0, at = 0;
    for (int i = 0; i < p->nplan; i++) n += p->plan[i].nrun;
    struct arena *a = arena_create();
    struct run_spec *spec = TAKE(a, n + 1, struct run_spec);
    bool *skip = TAKE(a, n + 1, bool);
    p->order = TAKE(a, n + 1, struct run_order);
    for (int i = 0; i < p->nplan; i++)
        for (int k = 0; k < p->plan[i].nrun; k++, at++) {
            spec[at] = p->plan[i].run[k];
            p->order[at] = (struct run_order){0};
        }
    p->run = spec;
    /* Levels first: they decide which run is the same as a stored one. */
    bool ok = levels_settle(p->store, spec, p->order, n, p->common->quiet, a, p->e);
    /* What is stored is left out, but for --force. */
    for (int i = 0; i < n && ok; i++) skip[i] = !p->common->force && store_has(p->store, &spec[i]);
    ok = ok && run_campaign(spec, p->order, n, skip, p->common->jobs, p->common->quiet, keep_result,
                            p, p->e);
    p->run = NULL;
    p->order = NULL;
    arena_destroy(a);
    return ok;
}

/* Figures with a section of their own in the report. */
static bool has_section(const char *figure)
{
    return strcmp(figure, "accuracy") == 0 || strcmp(figure, "stability") == 0 ||
           strcmp(figure, "omissions") == 0 || strcmp(figure, "explain") == 0;
}

/* One figure. Without gnuplot its CSV is there and the others go on; without rows a figure of a
 * section was not measured, which is no error. */
static bool draw(struct paper *p, const char *name)
{
    struct err e;
    err_clear(&e);
    if (report_figure(p->store, plan_data_dir(), name, p->common->directory, &e)) return true;
    if (e.kind == ERR_NO_INPUT && has_section(name)) return true; /* nobody measured it */
    if (e.kind == ERR_UNAVAILABLE) {
        err_print(&e);
        p->undrawn++;
        return true;
    }
    *p->e = e;
    return false;
}

/* Figures of the scenarios, then those of the whole study. */
static bool draw_all(struct paper *p, struct progress *progress)
{
    int done = 0;
    for (int i = 0; i < p->nplan; i++)
        for (int k = 0; k < p->plan[i].nfigure; k++) {
            if (!draw(p, p->plan[i].figure[k])) return false;
            progress_show(progress, ++done);
        }
    return p->common->narg || (draw(p, "claims") && draw(p, "accuracy") && draw(p, "stability") &&
                               draw(p, "omissions") && draw(p, "explain"));
}

/* With a progress line. */
static bool draw_figures(struct paper *p)
{
    int n = 1;
    for (int i = 0; i < p->nplan; i++) n += p->plan[i].nfigure;
    /* One second a figure: worth a progress line. */
    struct progress progress = progress_make("figures", n, p->common->quiet);
    bool ok = draw_all(p, &progress);
    progress_end(&progress);
    return ok;
}

/* Samples before verdicts, which quote them; then the search for what would make failed claims
 * hold. */
static bool judge(struct paper *p)
{
    return claims_read(&p->rules, plan_data_dir(), p->e) &&
           sampling_run(p->common, &p->rules, SAMPLING_SAMPLES, p->store, p->e) &&
           claims_decide(&p->rules, p->store, p->e) &&
           explain_claims(p->common, &p->rules, EXPLAIN_SEED, p->store, p->e);
}

/* All figures that the plans ask for, in the order of the report, after the chart of claims. */
static int figure_names(const struct paper *p, const char **name)
{
    int n = 0;
    name[n++] = "claims";
    for (int i = 0; i < p->nplan; i++)
        for (int k = 0; k < p->plan[i].nfigure && n < MOST_FIGURES; k++)
            name[n++] = p->plan[i].figure[k];
    return n;
}

/* paper.md and paper.html beside the folder of figures. */
static bool write_documents(struct paper *p, double began)
{
    const char *name[MOST_FIGURES];
    struct arena *a = arena_create();
    struct document d = {.store = p->store,
                         .name = "paper",
                         .whole = true,
                         .title = "Parallel multibody dynamics on MIMD machines: the evaluation "
                                  "reproduced",
                         .data_dir = plan_data_dir(),
                         .figures = p->common->directory,
                         .figure = name};
    d.nfigure = figure_names(p, name);
    /* Parameters are those of the machines that were run. */
    bool ok = parameters_gather(p->plan, p->nplan, a, &d.parameter, &d.nparameter, p->e);
    d.host_s = host_seconds() - began;
    ok = ok && document_write(&d, p->e);
    arena_destroy(a);
    return ok;
}

/* Asked for by figure, only the runs and the figures are made: claims need all runs. */
static bool answer(struct paper *p, double began)
{
    bool whole = p->common->narg == 0;
    p->store = arguments_store(p->common, p->database, p->e);
    if (!p->store || !add_plans(p) || !run_plans(p)) return false;
    if (whole && !judge(p)) return false;
    if (whole && !p->paper_only && !scenes_measure(p->common, p->store, p->e)) return false;
    /* Figures after the studies, whose rows they show. */
    if (!draw_figures(p)) return false;
    if (!whole) return true;
    return write_documents(p, began) && claims_print(p->store, p->common->json, stdout, p->e);
}

/* Status 1 when runs failed: everything else of the study was done all the same. */
int cmd_paper(int argc, char **argv)
{
    struct common c;
    bool paper_only = take_flag(&argc, argv, "--paper-only");
    common_parse(&c, argc, argv, TAKES_STORE | TAKES_DIR | TAKES_JOBS, "[FIGURE...]", doc, 0, 16);
    struct err e;
    err_clear(&e);
    /* Before anything else: the report tells how long all of it took. */
    double began = host_seconds();
    struct paper p = {.common = &c, .database = c.database_given ? c.database : "paper.db", .e = &e,
                      .paper_only = paper_only};
    bool ok = answer(&p, began);
    store_close(p.store);
    claims_free(&p.rules);
    for (int i = 0; i < p.nplan; i++) plan_free(&p.plan[i]);
    if (ok && !c.quiet)
        fprintf(stderr, "mimdsim: %s, %s/%s in %.1f s\n", p.database, c.directory,
                c.narg ? "" : ", paper.md, paper.html", host_seconds() - began);
    if (ok && p.failed > 0)
        fprintf(stderr, "mimdsim: %d runs failed; each is stored with its reason, and tried again "
                        "next time\n",
                p.failed);
    /* Failed runs are a finding: everything was written, but the exit status says so. */
    if (ok && p.failed > 0) return err_exit_status(ERR_CHECK);
    if (ok) return p.undrawn > 0 ? err_exit_status(ERR_UNAVAILABLE) : 0;
    return common_fail(&c, &e);
}
