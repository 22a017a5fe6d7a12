/* lab_report.c - the runs that the report of an attempt needs: the scenario's own with their spans
 * and paths, and for each of them one at every place of the sliders. */
#include "app/lab_report.h"

#include <string.h>
#include <unistd.h>

#include "lab/lab_page.h"
#include "run/run.h"
#include "spec/run_label.h"

/* A scenario of a lesson has at most 6 runs; a student may have added some. */
enum { MOST_RUNS = 12 };

/* What is gathered for the page. */
struct gathered {
    struct lab lab;
    struct lab_result check;
    struct plan plan;
    int nrun;
    struct lab_page_run run[MOST_RUNS];
    struct run_result result[MOST_RUNS];
};

/* A file of the attempt. */
static const char *in_folder(const char *folder, const char *file, struct arena *a)
{
    struct text t = {0};
    text_add(&t, "%s/%s", folder, file);
    const char *path = arena_text(a, t.s);
    text_free(&t);
    return path;
}

/* A run of a sweep is told from the others by its machine, its ranks and its parameters. The lines
 * of parameters become one. */
static const char *title_of(const struct run_spec *spec, struct arena *a)
{
    struct text t = {0};
    run_label(spec, &t);
    text_add(&t, ", P = %d", spec->nrank);
    if (spec->program.arguments[0] != '\0') text_add(&t, ", %s", spec->program.arguments);
    for (const char *s = spec->program.parameters; s != NULL && *s != '\0';) {
        const size_t n = strcspn(s, "\n");
        if (n > 0) text_add(&t, ", %.*s", (int)n, s);
        s += n + (s[n] == '\n');
    }
    const char *title = arena_text(a, t.s);
    text_free(&t);
    return title;
}

/* The settings of one place of the sliders: the number of the place has a digit for each slider,
 * the last one the lowest. */
static int settings_at(const struct lab *l, int place, const char **key, const char **text)
{
    for (int i = l->nslider - 1; i >= 0; i--) {
        key[i] = l->slider[i].key;
        text[i] = l->slider[i].value[place % l->slider[i].nvalue];
        place /= l->slider[i].nvalue;
    }
    return l->nslider;
}

/* One run at one place: what it takes, and of what. One that cannot be made there leaves zeros. */
static bool run_at(struct gathered *g, int index, int place, lab_shares out, struct err *e)
{
    const char *key[LAB_SLIDERS], *text[LAB_SLIDERS];
    struct run_spec spec;
    struct run_result r;
    struct arena *a = arena_create();
    const int n = settings_at(&g->lab, place, key, text);
    bool ok = plan_vary(&g->plan, index, n, key, text, &spec, e);
    memset(out, 0, sizeof(lab_shares));
    if (ok && spec.refused == NULL) {
        /* The path alone: the page has spans of the scenario's own runs only, or it would be as
         * large as all of them together. */
        spec.record.path = true;
        spec.record.spans = spec.record.links = false;
        ok = run_one(&spec, a, &r, e);
        if (ok && r.status == RUN_OK) lab_shares_of(&r, out);
    }
    arena_destroy(a);
    return ok;
}

/* All places of one run. */
static const lab_shares *run_grid(struct gathered *g, int index, struct arena *a, struct err *e)
{
    const int n = lab_points(&g->lab);
    lab_shares *point = arena_take(a, (size_t)n * sizeof *point);
    for (int i = 0; i < n; i++)
        if (!run_at(g, index, i, point[i], e)) return NULL;
    return point;
}

/* The runs of the scenario, each with everything that the page shows. One that does not end well
 * has been told by the check, and has no times. */
static bool make_runs(struct gathered *g, struct arena *a, struct err *e)
{
    const int n = g->plan.nrun < MOST_RUNS ? g->plan.nrun : MOST_RUNS;
    for (int i = 0; i < n; i++) {
        struct run_spec spec = g->plan.run[i];
        struct run_result *r = &g->result[g->nrun];
        spec.record.spans = spec.record.path = true;
        /* What is recorded changes no simulated time. */
        if (!run_one(&spec, a, r, e)) return false;
        if (r->status != RUN_OK) continue;
        const lab_shares *point = run_grid(g, i, a, e);
        if (point == NULL) return false;
        g->run[g->nrun++] =
            (struct lab_page_run){.title = title_of(&spec, a), .result = r, .point = point};
    }
    return true;
}

/* The student's texts: the program, which is there, and notes.md, which may be. */
static bool read_texts(struct lab_page *p, const char *folder, struct text *source,
                       struct text *notes, struct arena *a, struct err *e)
{
    const char *path = in_folder(folder, "notes.md", a);
    const bool noted = access(path, R_OK) == 0;
    if (!text_read_file(source, in_folder(folder, p->lab->program, a), e)) return false;
    if (noted && !text_read_file(notes, path, e)) return false;
    p->source = source->s != NULL ? source->s : "";
    p->notes = noted && notes->s != NULL ? notes->s : NULL;
    return true;
}

bool lab_report(const struct common *c, const char *folder, struct arena *a, const char **path,
                bool *right, struct err *e)
{
    /* Large, and zero from the start: in the arena and not on the stack. */
    struct gathered *g = TAKE(a, 1, struct gathered);
    const struct node *answers;
    const struct plan_options o = common_plan(c);
    if (!lab_attempt(&g->lab, folder, &answers, a, e) || !lab_check(&g->check, folder, a, e))
        return false;
    /* A program that does not run has no timeline; the page has the rest of it all the same. */
    bool ok = true;
    if (strcmp(g->check.program, "ok") == 0)
        ok =
            plan_read(&g->plan, in_folder(folder, "scenario.yaml", a), &o, e) && make_runs(g, a, e);
    struct text source = {0}, notes = {0};
    struct lab_page page = {.lab = &g->lab, .check = &g->check, .nrun = g->nrun, .run = g->run};
    *path = in_folder(folder, "report.html", a);
    /* The page goes to folder/report.html, in place of an older one, whatever the verdicts are. */
    *right = g->check.right == g->check.nanswer;
    ok = ok && read_texts(&page, folder, &source, &notes, a, e) && lab_page_write(&page, *path, e);
    text_free(&source);
    text_free(&notes);
    plan_free(&g->plan);
    return ok;
}
