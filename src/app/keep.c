/* keep.c - see keep.h.
 *
 * Results of a study replace those of the same scenario, in one transaction: never half old,
 * half new. */
#include "app/keep.h"

#include "app/arguments.h"
#include "app/levels.h"
#include "report/report.h"

struct store *keep_open(const struct common *c, struct err *e)
{
    struct store *s =
        report_folder_check(c->directory, e) ? arguments_store_whole(c, c->database, e) : NULL;
    if (s != NULL) store_show(s);
    return s;
}

/* Ladders and choices together: a choice refers to a rung. */
bool keep_accuracy(struct store *s, const struct accuracy_report *r, struct err *e)
{
    static const char *const name[] = {"scenario"};
    const struct store_value value[] = {store_text(r->scenario)};
    if (!store_begin(s, e)) return false;
    bool ok = store_note_build(s, e) &&
              store_delete(s, "ladder", "scenario", store_text(r->scenario), e) &&
              store_delete(s, "ladder_choice", "scenario", store_text(r->scenario), e) &&
              ladder_store(s, r, e);
    for (int i = 0; ok && i < r->nchoice; i++)
        ok = store_insert_row(s, "ladder_choice", 1, name, value, &accuracy_choice_columns,
                              &r->choice[i], e);
    if (ok) return store_commit(s, e);
    store_rollback(s);
    return false;
}

static bool store_row(struct store *s, const struct stability_report *r, int i, struct err *e)
{
    static const char *const name[] = {"suite", "ordinal"};
    const struct store_value value[] = {store_text(r->suite), store_int(i)};
    return store_insert_row(s, "stability", 2, name, value, &stability_columns, &r->row[i], e);
}

/* Rows of a suite, numbered in their order. */
bool keep_stability(struct store *s, const struct stability_report *r, struct err *e)
{
    if (!store_begin(s, e)) return false;
    bool ok =
        store_note_build(s, e) && store_delete(s, "stability", "suite", store_text(r->suite), e);
    for (int i = 0; ok && i < r->nrow; i++) ok = store_row(s, r, i, e);
    if (ok) return store_commit(s, e);
    store_rollback(s);
    return false;
}

/* The figure is drawn from the database, so it can be drawn again by `mimdsim plot`. */
bool keep_draw(const struct common *c, struct store *s, const char *figure, struct err *e)
{
    struct report_drawings d;
    if (!report_figure(s, plan_data_dir(), figure, c->directory, e)) return false;
    if (c->quiet) return true;
    /* A study may have several drawings: each is told. */
    if (!report_drawings_find(s, plan_data_dir(), figure, &d, e)) return false;
    for (int i = 0; i < d.n; i++)
        fprintf(stderr, "mimdsim: figure %s/%s.png\n", c->directory, d.as[i]);
    fprintf(stderr, "mimdsim: a report with it: mimdsim report %s\n", c->database);
    report_drawings_free(&d);
    return true;
}
