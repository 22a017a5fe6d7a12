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

static void print_name(const struct common *c, struct json *j, const char *name)
{
    if (c->json) json_text(j, name);
    else puts(name);
}

/* The pictures that figure `name` stands for. */
static bool list_pictures(const struct common *c, struct store *s, const char *name, struct json *j, struct err *e)
{
    struct report_drawings d;
    if (!report_drawings_find(s, plan_data_dir(), name, &d, e)) return false;
    for (int i = 0; i < d.n; i++) {
        struct text t = {0};
        text_add(&t, "%s/%s.png", c->directory, d.as[i]);
        print_name(c, j, t.s);
        text_free(&t);
    }
    report_drawings_free(&d);
    return true;
}

static int list_figures(const struct common *c)
{
    char **name;
    int n = report_figures(plan_data_dir(), &name);
    struct json j = json_make(stdout);
    if (c->json) json_array(&j);
    for (int i = 0; i < n; i++) {
        print_name(c, &j, name[i]);
        free(name[i]);
    }
    free(name);
    if (!c->json) return 0;
    json_end(&j);
    json_finish(&j);
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
    struct json j = json_make(stdout);
    bool list = ok && (c.json || !c.quiet);
    if (list && c.json) json_array(&j);
    for (int i = 1; list && i < c.narg; i++) list = list_pictures(&c, s, c.arg[i], &j, &e);
    if (ok && c.json) {
        json_end(&j);
        json_finish(&j);
    }
    store_close(s);
    return ok ? 0 : common_fail(&c, &e);
}
