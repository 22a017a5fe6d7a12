/* cmd_plot.c - mimdsim plot: draw a figure from a database alone. */
#include <stdlib.h>

#include "app/verb.h"
#include "base/json.h"
#include "report/report.h"
#include "store/store.h"

static const char doc[] =
    "Draw FIGURE from the database DB into a folder: FIGURE.png, .svg, .csv and the script .gp.\n\n"
    "Example: mimdsim plot mimdsim.db fig6 --dir figures\n\v"
    "Without FIGURE: list the figures there are.";

/* A list of names: a line each, or one document. */
static void print_names(const struct common *c, const char *folder, const char *ending, int n, const char *const *name)
{
    struct json j = json_make(stdout);
    if (c->json) json_array(&j);
    for (int i = 0; i < n; i++) {
        struct text t = {0};
        text_add(&t, "%s%s%s%s", folder, folder[0] ? "/" : "", name[i], ending);
        if (c->json) json_text(&j, t.s);
        else puts(t.s);
        text_free(&t);
    }
    if (!c->json) return;
    json_end(&j);
    json_finish(&j);
}

static int list_figures(const struct common *c)
{
    char **name;
    int n = report_figures(plan_data_dir(), &name);
    print_names(c, "", "", n, (const char *const *)name);
    for (int i = 0; i < n; i++) free(name[i]);
    free(name);
    return 0;
}

int cmd_plot(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, TAKES_DIR, "DB FIGURE...", doc, 0, 64);
    if (c.narg < 2) return list_figures(&c);
    struct err e;
    err_clear(&e);
    struct store *s = store_open(c.arg[0], STORE_READ, &e);
    bool ok = s != NULL;
    for (int i = 1; ok && i < c.narg; i++) ok = report_figure(s, plan_data_dir(), c.arg[i], c.directory, &e);
    store_close(s);
    if (!ok) return common_fail(&c, &e);
    if (c.json || !c.quiet) print_names(&c, c.directory, ".png", c.narg - 1, c.arg + 1);
    return 0;
}
