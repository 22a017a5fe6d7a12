/* load_store.c - curves as rows: tables load_series and load_point (load_curve.h).
 *
 * A series is known by a digest of all that its points depend on, so a stored point is the point
 * that would be measured again. */
#include <math.h>
#include <string.h>

#include "app/load_curve.h"
#include "base/text.h"

/* What one row fills. */
struct reading {
    struct load_point *p;
    bool found;
};

/* There is one. */
static bool note_row(void *context, int ncolumn, const char *const *name,
                     const struct store_value *v)
{
    (void)ncolumn, (void)name, (void)v;
    ((struct reading *)context)->found = true;
    return true;
}

bool load_store_series(struct store *s, const struct load_series *x, struct err *e)
{
    /* its key is among its columns */
    return store_insert_row(s, "load_series", 0, NULL, NULL, &load_series_columns, x, e);
}

/* For curves that go on: their row is there, with what was found. */
bool load_add_series(struct store *s, const struct load_series *x, struct err *e)
{
    struct reading r = {.p = NULL};
    const char *const bound[] = {x->series};
    /* what an earlier search found stays */
    if (!store_query(s, "SELECT series FROM load_series WHERE series = ?1", 1, bound, NULL,
                     note_row, &r, e))
        return false;
    return r.found || load_store_series(s, x, e);
}

/* The point's own key is its load and whether it is a probe: both are columns of the row. */
bool load_store_point(struct store *s, const struct load_series *x, const struct load_point *p,
                      struct err *e)
{
    static const char *const name[] = {"series"};
    const struct store_value key[] = {store_text(x->series)};
    return store_insert_row(s, "load_point", 1, name, key, &load_point_columns, p, e);
}

/* Points first: a point without its series would be drawn nowhere and never go. */
bool load_forget(struct store *s, const struct load_series *x, struct err *e)
{
    return store_delete(s, "load_point", "series", store_text(x->series), e) &&
           store_delete(s, "load_series", "series", store_text(x->series), e);
}

/* A REAL that is whole may come back as an integer. */
static double real_of(const struct store_value *v)
{
    return v->kind == STORE_REAL ? v->real : v->kind == STORE_INT ? (double)v->integer : NAN;
}

/* NULL stands for a latency that there is none of: an unstable point has none, and prints none. */
static int64_t whole_of(const struct store_value *v)
{
    return v->kind == STORE_INT ? v->integer : -1;
}

/* Words of the column, as the table has them; an unknown one is no point. */
static bool status_of(const char *word, enum load_status *status)
{
    const struct column_table *t = &load_point_columns;
    for (int i = 0; i < t->n; i++)
        for (int k = 0; strcmp(t->column[i].name, "status") == 0 && k < t->column[i].nword; k++)
            if (word && strcmp(t->column[i].word[k], word) == 0) {
                *status = (enum load_status)k;
                return true;
            }
    return false;
}

/* In the order of the query. Whatever is not there is NAN or -1, as in a point that was measured.
 */
static bool read_point(void *context, int ncolumn, const char *const *name,
                       const struct store_value *v)
{
    struct reading *r = context;
    struct load_point *p = r->p;
    (void)ncolumn, (void)name;
    if (!status_of(v[0].text, &p->status)) return true;
    p->created = real_of(&v[1]);
    p->accepted = real_of(&v[2]);
    p->mean_ps = real_of(&v[3]);
    p->half_ps = real_of(&v[4]);
    p->p50_ps = whole_of(&v[5]);
    p->p99_ps = whole_of(&v[6]);
    p->max_ps = whole_of(&v[7]);
    p->messages = whole_of(&v[8]);
    p->warmup_ps = whole_of(&v[9]);
    p->length_ps = whole_of(&v[10]);
    p->lag = real_of(&v[11]);
    p->events = whole_of(&v[12]);
    p->host_s = real_of(&v[13]);
    text_copy(p->text, sizeof p->text, v[14].text ? v[14].text : "");
    r->found = true;
    return true;
}

/* By its load and kind within the series. */
bool load_find_point(struct store *s, const struct load_series *x, double offered, bool probe,
                     bool *found, struct load_point *p, struct err *e)
{
    /* Equal bits: a load is written and read with 17 digits. */
    char load[32];
    snprintf(load, sizeof load, "%.17g", offered);
    const char *const bound[] = {x->series, load, probe ? "1" : "0"};
    *p = (struct load_point){.offered = offered, .probe = probe};
    struct reading r = {.p = p};
    bool ok = store_query(s,
                          "SELECT status, created, accepted, mean_ps, half_ps, p50_ps, p99_ps, "
                          "max_ps, messages, warmup_ps, length_ps, batch_lag, events, host_s, text "
                          "FROM load_point WHERE series = ?1 AND offered = CAST(?2 AS REAL) AND "
                          "probe = CAST(?3 AS INTEGER)",
                          3, bound, NULL, read_point, &r, e);
    *found = ok && r.found;
    return ok;
}
