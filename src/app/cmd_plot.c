/* cmd_plot.c - mimdsim plot: draw a figure from a database alone.
 *
 * A figure needs no scenario and no run: everything is in the database and in plots/. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/arguments.h"
#include "app/verb.h"
#include "base/json.h"
#include "report/report.h"

static const char doc[] =
    "Draw FIGURE from the database DB into a folder: FIGURE.png, .svg, .csv, the script .gp and "
    ".provenance.\n\n"
    "Example: mimdsim plot mimdsim.db fig6 --dir figures\n"
    "\vWithout FIGURE: list the available figures, what each shows, and the command that makes "
    "the runs it needs.";

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

/* No argument: figures; a database: the same; figures: draw them. */
int cmd_plot(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, TAKES_DIR, "[DB [FIGURE...]]", doc, 0, 64);
    struct err e;
    err_clear(&e);
    struct store *s = c.narg > 0 ? open_database(&c, &e) : NULL;
    /* Figures in the order of the command line; the first failure ends it. */
    bool ok = s != NULL || c.narg == 0;
    for (int i = 1; ok && i < c.narg; i++)
        ok = report_figure(s, plan_data_dir(), c.arg[i], c.directory, &e);
    /* A database alone lists figures as well: the user wants to choose one. */
    if (ok && c.narg < 2) list_figures(&c);
    else if (ok && (c.json || !c.quiet)) ok = print_pictures(&c, s, &e);
    store_close(s);
    return ok ? 0 : common_fail(&c, &e);
}
