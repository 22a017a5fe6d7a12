/* cmd_plot.c - mimdsim plot: draw a figure from a database alone. */
#include <stdlib.h>

#include "app/verb.h"
#include "report/report.h"
#include "store/store.h"

static const char doc[] =
    "Draw FIGURE from the database DB into a folder: FIGURE.png, .svg, .csv and the script .gp.\n\n"
    "Example: mimdsim plot mimdsim.db fig6 --dir figures\n\v"
    "Without FIGURE: list the figures there are.";

static int list_figures(void)
{
    char **name;
    int n = report_figures(plan_data_dir(), &name);
    for (int i = 0; i < n; i++) {
        puts(name[i]);
        free(name[i]);
    }
    free(name);
    return 0;
}

int cmd_plot(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, TAKES_DIR, "DB FIGURE...", doc, 0, 64);
    if (c.narg < 2) return list_figures();
    struct err e;
    err_clear(&e);
    struct store *s = store_open(c.arg[0], STORE_READ, &e);
    bool ok = s != NULL;
    for (int i = 1; ok && i < c.narg; i++) {
        ok = report_figure(s, plan_data_dir(), c.arg[i], c.directory, &e);
        if (ok && !c.quiet) printf("%s/%s.png\n", c.directory, c.arg[i]);
    }
    store_close(s);
    return ok ? 0 : common_fail(&c, &e);
}
