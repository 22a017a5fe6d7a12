/* figure_drawings.c - figures with a drawing for each of several rows.
 *
 * A line "-- each: QUERY" of a description has a row for each drawing: what ?1 is bound to, what
 * the drawing is called after, and where several drawings belong together a name for all of them
 * ("accuracy-four-bar" for its three ladders). */
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/memory.h"
#include "base/text.h"
#include "report/figure_text.h"
#include "report/report.h"

/* A row of -- each. */
static bool add_drawing(void *context, int ncolumn, const char *const *name,
                        const char *const *value)
{
    struct report_drawings *d = context;
    /* Three arrays that grow together. */
    const size_t n = (size_t)d->n + 1;
    (void)name;
    CHECK(ncolumn == 2 || ncolumn == 3);
    /* a row that was left without its name */
    if (value[0] == NULL || value[1] == NULL) return true;
    d->which = memory_resize(d->which, n, sizeof *d->which);
    d->as = memory_resize(d->as, n, sizeof *d->as);
    d->of = memory_resize(d->of, n, sizeof *d->of);
    d->which[d->n] = memory_text(value[0]);
    d->as[d->n] = figure_file_name(d->figure, value[1]);
    /* Without a name for several drawings each stands for itself. */
    d->of[d->n] = ncolumn > 2 && value[2] ? figure_file_name(d->figure, value[2])
                                          : memory_text(d->as[d->n]);
    d->n++;
    return true;
}

/* Frees drawing i. */
static void drop_drawing(struct report_drawings *d, int i)
{
    free(d->which[i]);
    free(d->as[i]);
    free(d->of[i]);
}

void report_drawings_free(struct report_drawings *d)
{
    for (int i = 0; i < d->n; i++) drop_drawing(d, i);
    free(d->which);
    free(d->as);
    free(d->of);
    *d = (struct report_drawings){0};
}

/* Only the drawing called `as` stays, the first of that name; if none is, those that belong to
 * `as`. */
static void keep_drawings(struct report_drawings *d, const char *as)
{
    int n = 0;
    bool exact = false;
    for (int i = 0; i < d->n; i++) exact = exact || strcmp(d->as[i], as) == 0;
    for (int i = 0; i < d->n; i++) {
        const bool kept = exact ? n == 0 && strcmp(d->as[i], as) == 0 : strcmp(d->of[i], as) == 0;
        if (!kept) {
            drop_drawing(d, i);
            continue;
        }
        d->which[n] = d->which[i];
        d->as[n] = d->as[i];
        d->of[n++] = d->of[i];
    }
    d->n = n;
}

/* The figure that `name` is a drawing of: NAME itself, or what stands before one of its hyphens,
 * the last one first. */
static bool find_description(const char *data_dir, const char *name, struct report_drawings *d,
                             struct text *sql, struct err *e)
{
    char each[2000];
    text_copy(d->figure, sizeof d->figure, name);
    /* What begins with _ draws what a verb has computed: no figure by itself. */
    if (name[0] == '_') return figure_unknown(data_dir, name, e);
    if (figure_description(data_dir, name, sql, e)) return true;
    for (char *hyphen = strrchr(d->figure, '-'); hyphen != NULL; hyphen = strrchr(d->figure, '-')) {
        *hyphen = '\0';
        /* Without a line -- each: a figure has no drawings of its own. */
        if (figure_description(data_dir, d->figure, sql, e) &&
            figure_line(sql->s, "-- each: ", each, sizeof each))
            return true;
        text_free(sql);
    }
    return figure_unknown(data_dir, name, e);
}

bool report_drawings_find(struct store *s, const char *data_dir, const char *name,
                          struct report_drawings *d, struct err *e)
{
    struct text sql = {0};
    char each[2000], needs[200] = "";
    *d = (struct report_drawings){0};
    if (!find_description(data_dir, name, d, &sql, e)) return false;
    bool ok = true;
    /* A figure with several drawings: as many as rows; some of them if they were asked for by
     * their own name. */
    if (figure_line(sql.s, "-- each: ", each, sizeof each)) {
        ok = store_select(s, each, 0, NULL, add_drawing, d, e);
        if (ok && strcmp(d->figure, name) != 0) keep_drawings(d, name);
        figure_line(sql.s, "-- needs: ", needs, sizeof needs);
        if (ok && d->n == 0)
            ok = err_set(e, ERR_NO_INPUT, "database %s has no rows for figure '%s'%s%s",
                         store_path(s), name, *needs ? "; first: " : "", needs);
    } else {
        /* A figure without: a single drawing that needs no row. */
        const char *const alone[] = {"", name};
        add_drawing(d, 2, NULL, alone);
    }
    text_free(&sql);
    if (!ok) report_drawings_free(d);
    return ok;
}
