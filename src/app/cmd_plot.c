/* cmd_plot.c - mimdsim plot: draw a figure from a database alone.
 *
 * A figure needs no scenario and no run: everything is in the database and in plots/. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/arguments.h"
#include "app/flag.h"
#include "app/plot_options.h"
#include "app/verb.h"
#include "base/json.h"
#include "report/plot.h"
#include "report/report.h"

static const char doc[] =
    "Draw FIGURE, any column over another, or the rows of your own query QUERY.sql from the "
    "database DB into a folder: NAME.png, .svg, .csv, the script .gp and .provenance.\n\n"
    "Example: mimdsim plot mimdsim.db fig6 --dir figures\n"
    "Example: mimdsim plot mimdsim.db --x n --y speedup --by machine,level --where "
    "kernel=dynamics\n"
    "\vWithout FIGURE: list the available figures, what each shows, and the command that makes "
    "the runs it needs.\n\n"
    "KEY is a column of the view v_run or of table run, a setting such as "
    "machine.network.hop_latency, or the end of one; a query has its own columns. Axes are "
    "logarithmic where the range asks for it. Several runs in one place become "
    "several curves; what --by leaves together is drawn as mean and spread, which standard error "
    "says.";

/* The pictures that figure `name` stands for, as paths: a script can pick them up. */
static bool list_pictures(const struct common *c, struct store *s, const char *name, struct json *j,
                          struct err *e)
{
    /* One figure may be several drawings, such as one for each scenario. */
    struct report_drawings d;
    if (!report_drawings_find(s, plan_data_dir(), name, &d, e)) return false;
    for (int i = 0; i < d.n; i++) {
        struct text t = {0};
        /* The name of the drawing and not of the figure: accuracy-SCENARIO is one of several. */
        text_add(&t, "%s/%s.png", c->directory, d.as[i]);
        if (c->json) json_text(j, t.s);
        else puts(t.s);
        text_free(&t);
    }
    report_drawings_free(&d);
    return true;
}

/* The pictures that were made: a line each, or one document. */
static bool print_pictures(const struct common *c, struct store *s, struct err *e)
{
    struct json j = json_make(stdout);
    bool ok = true;
    if (c->json) json_array(&j);
    /* The first argument is the database. */
    for (int i = 1; ok && i < c->narg; i++) ok = list_pictures(c, s, c->arg[i], &j, e);
    if (c->json) {
        json_end(&j);
        json_finish(&j);
    }
    return ok;
}

/* A figure, what it shows, and the command that fills a database for it. */
static void print_figure(const struct common *c, struct json *j, const char *name)
{
    /* Both come from the comment at the top of the figure's query. */
    struct text title = {0}, needs = {0};
    report_figure_about(plan_data_dir(), name, &title, &needs);
    if (c->json) {
        json_object(j);
        json_key_text(j, "name", name);
        json_key_text(j, "needs", needs.s);
        json_key_text(j, "title", title.s);
        json_end(j);
    } else {
        printf("%-14s %s\n", name, title.s);
        if (needs.length > 0) printf("%-14s   needs: %s\n", "", needs.s);
    }
    text_free(&title);
    text_free(&needs);
}

/* All figures that plots/ has. */
static void list_figures(const struct common *c)
{
    char **name;
    struct json j = json_make(stdout);
    int n = report_figures(plan_data_dir(), &name);
    if (c->json) json_array(&j);
    for (int i = 0; i < n; i++) {
        print_figure(c, &j, name[i]);
        free(name[i]);
    }
    free(name);
    if (!c->json) return;
    json_end(&j);
    json_finish(&j);
}

/* Only asked when the database is missing on the command line. */
static bool is_figure(const char *word)
{
    char **name;
    bool found = false; /* all names are freed on the way */
    int n = report_figures(plan_data_dir(), &name);
    for (int i = 0; i < n; i++) {
        found = found || strcmp(name[i], word) == 0;
        free(name[i]);
    }
    free(name);
    return found;
}

/* A figure alone lacks its database: the message writes the command. The rest is as for all
 * verbs. */
static struct store *open_database(const struct common *c, struct err *e)
{
    if (c->narg > 1 || !is_figure(c->arg[0]) || access(c->arg[0], F_OK) == 0)
        return arguments_database(c, "", e);
    err_set(e, ERR_USAGE,
            "'%s' is a figure; the database comes first: `mimdsim plot mimdsim.db %s`", c->arg[0],
            c->arg[0]);
    return NULL;
}

/* Remarks on what was drawn, for people. */
static void say(const struct common *c, const struct text *told)
{
    if (told->length > 0 && !c->quiet) fprintf(stderr, "mimdsim: %s\n", told->s);
}

/* "my.sql": a query of the user's own. */
static bool is_query(const char *word)
{
    const size_t n = strlen(word);
    return n > 4 && strcmp(word + n - 4, ".sql") == 0;
}

/* The picture that was made, as the others are told. */
static void print_picture(const struct common *c, const char *name)
{
    /* The same words as for figures by name, so that a script reads one form. */
    struct text path = {0};
    text_add(&path, "%s/%s.png", c->directory, name);
    struct json j = json_make(stdout);
    if (c->json) {
        json_array(&j);
        json_text(&j, path.s);
        json_end(&j);
        json_finish(&j);
    } else if (!c->quiet) {
        puts(path.s);
    }
    text_free(&path);
}

/* One picture of what the options ask for, from stored runs or from the rows of a query. */
static bool draw_request(const struct common *c, struct store *s, struct plot_request *r,
                         struct err *e)
{
    struct text sql = {0}, told = {0};
    struct arena *a = arena_create();
    /* The database, and perhaps a query. */
    const char *file = c->narg == 2 ? c->arg[1] : NULL;
    bool ok = c->narg <= 2 || err_set(e, ERR_USAGE, "one picture at a time: '%s'", c->arg[2]);
    if (ok && file != NULL && !is_query(file))
        ok = err_set(e, ERR_USAGE,
                     "--x and --y draw runs or the rows of QUERY.sql, not figure '%s'", file);
    if (ok && file != NULL) ok = text_read_file(&sql, file, e);
    if (ok && file != NULL) r->query = sql.s != NULL ? sql.s : "";
    plot_options_name(r, file, a);
    ok = ok && plot_draw(s, plan_data_dir(), r, c->directory, &told, e);
    /* A mistake in a query of the user's own is told with its file. */
    if (file != NULL && !ok) err_in(e, file);
    say(c, &told);
    if (ok) print_picture(c, r->as);
    text_free(&sql);
    text_free(&told);
    arena_destroy(a);
    return ok;
}

/* Figures in the order of the command line; the first failure ends it. */
static bool draw_figures(const struct common *c, struct store *s, const struct plot_request *r,
                         struct err *e)
{
    struct text told = {0};
    /* Conditions make the database smaller: every figure then shows what is left. */
    bool ok = r->nwhere == 0 || plot_only(s, r->nwhere, r->where, &told, e);
    say(c, &told);
    text_free(&told);
    for (int i = 1; ok && i < c->narg; i++)
        ok = report_figure(s, plan_data_dir(), c->arg[i], c->directory, e);
    return ok && (!(c->json || !c->quiet) || print_pictures(c, s, e));
}

/* No argument: figures; a database: the same; figures: draw them. */
int cmd_plot(int argc, char **argv)
{
    struct common c;
    struct plot_request r;
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    /* What belongs to this verb alone is taken out first; what was wrong in it is told after --help
     * had its chance. */
    bool axes = false, columns = take_flag(&argc, argv, "--columns");
    const bool right = plot_options_take(&r, &argc, argv, &axes, a, &e);
    common_parse(&c, argc, argv, TAKES_DIR, "[DB [FIGURE...|QUERY.sql]]", doc, 0, 64);
    if (right && axes && c.narg == 0)
        err_set(&e, ERR_USAGE, "the database is missing: `mimdsim plot DB --x ...`");
    bool ok = right && e.kind == ERR_NONE;
    struct store *s = ok && c.narg > 0 ? open_database(&c, &e) : NULL;
    ok = ok && (s != NULL || c.narg == 0);
    /* A database alone lists figures as well: the user wants to choose one. */
    /* What is asked for: a list of columns, one picture, the list of figures, or figures by
     * name. */
    if (ok && columns && s != NULL) ok = plot_columns(s, stdout, &e);
    else if (ok && (axes || (c.narg == 2 && is_query(c.arg[1])))) ok = draw_request(&c, s, &r, &e);
    else if (ok && c.narg < 2) list_figures(&c);
    else if (ok) ok = draw_figures(&c, s, &r, &e);
    store_close(s);
    arena_destroy(a);
    return ok ? 0 : common_fail(&c, &e);
}
