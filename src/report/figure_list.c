/* figure_list.c - the figures that plots/ has, by name.
 *
 * A figure is a pair of NAME.sql and NAME.gp: adding one is adding two files. */
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/check.h"
#include "base/memory.h"
#include "base/text.h"
#include "report/figure_text.h"
#include "report/report.h"

/* Stem of a file in plots/ that is a figure: it has both parts. NULL otherwise. */
static char *figure_stem(const char *plots, const char *file)
{
    size_t n = strlen(file);
    if (n < 5 || strcmp(file + n - 4, ".sql") != 0) return NULL;
    struct text script = {0};
    text_add(&script, "%s/%.*s.gp", plots, (int)(n - 4), file);
    bool drawn = access(script.s, R_OK) == 0;
    text_free(&script);
    return drawn ? memory_text_part(file, n - 4) : NULL;
}

/* For qsort. */
static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

int report_figures(const char *data_dir, char ***name)
{
    struct text plots = {0};
    struct dirent **entry = NULL;
    text_add(&plots, "%s/plots", data_dir);
    int nentry = scandir(plots.s, &entry, NULL, alphasort), n = 0;
    /* A folder that is not there has no figures; one that cannot be listed has some. */
    if (nentry < 0 && errno == ENOMEM) check_memory(0);
    *name = memory_zeroed((size_t)(nentry > 0 ? nentry : 0) + 1, sizeof **name);
    for (int i = 0; i < nentry; i++) {
        /* What begins with _ draws what a verb computed (plot.h): no figure by itself. */
        char *stem = entry[i]->d_name[0] != '_' ? figure_stem(plots.s, entry[i]->d_name) : NULL;
        if (stem != NULL) (*name)[n++] = stem;
        free(entry[i]);
    }
    free(entry);
    text_free(&plots);
    /* Without their endings they sort otherwise. */
    qsort(*name, (size_t)n, sizeof **name, compare_names);
    return n;
}

bool figure_unknown(const char *data_dir, const char *wanted, struct err *e)
{
    char **name;
    int n = report_figures(data_dir, &name);
    const char *nearest = text_nearest(wanted, (const char *const *)name, n);
    struct text all = {0};
    for (int i = 0; i < n; i++) text_add(&all, "%s%s", i ? ", " : "", name[i]);
    /* The nearest name, or all of them. */
    if (nearest != NULL)
        err_set(e, ERR_NO_INPUT, "there is no figure '%s'; did you mean '%s'?", wanted, nearest);
    else
        err_set(e, ERR_NO_INPUT, "there is no figure '%s'; known: %s", wanted,
                n > 0 ? all.s : "none");
    for (int i = 0; i < n; i++) free(name[i]);
    free(name);
    text_free(&all);
    return false;
}

/* A name with a slash is none, so that no path leads out of plots/. */
static bool read_description(const char *data_dir, const char *name, struct text *sql,
                             struct err *e)
{
    struct text plots = {0}, file = {0}, path = {0};
    text_add(&plots, "%s/plots", data_dir);
    text_add(&file, "%s.sql", name);
    text_add(&path, "%s/%s", plots.s, file.s);
    char *stem = strchr(name, '/') == NULL ? figure_stem(plots.s, file.s) : NULL;
    bool ok = stem != NULL && text_read_file(sql, path.s, e);
    free(stem);
    text_free(&plots);
    text_free(&file);
    text_free(&path);
    return ok;
}

/* Whose statements another one has: what stands before the line is its own. */
bool figure_description(const char *data_dir, const char *name, struct text *sql, struct err *e)
{
    char like[64];
    struct text own = {0};
    bool ok = read_description(data_dir, name, &own, e);
    const bool shares = ok && figure_line(own.s ? own.s : "", "-- like: ", like, sizeof like);
    if (ok) text_add(sql, "%s", own.s ? own.s : "");
    text_free(&own);
    if (!shares) return ok;
    ok = read_description(data_dir, like, &own, e);
    if (ok) text_add(sql, "%s", own.s ? own.s : "");
    text_free(&own);
    return ok;
}
