/* report_query.c - the rows of a query as one JSON document; tables are in report_table.c.
 *
 * The document is for programs: all digits, and null for NULL. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/json.h"
#include "base/memory.h"
#include "base/text.h"
#include "report/report.h"

/* A document on its way: as everywhere, the keys of an object are sorted. */
struct document_rows {
    struct json j;
    struct arena *a;
    int ncolumn;
    struct key_place {
        char *name;
        int at;
    } * column; /* (ncolumn) by name */
};

/* For qsort: by name, equal names by their places. */
static int compare_columns(const void *a, const void *b)
{
    const struct key_place *x = a, *y = b;
    int order = strcmp(x->name, y->name);
    return order ? order : x->at - y->at;
}

static bool is_column(const struct document_rows *d, const char *name)
{
    for (int i = 0; i < d->ncolumn; i++)
        if (strcmp(d->column[i].name, name) == 0) return true;
    return false;
}

/* Columns of one name, which a join may give, would be one key: the second becomes "name:1", as
 * SQLite calls it, or has the first number behind it that no other column has. */
static void name_apart(struct document_rows *d)
{
    for (int i = 0, first = 0, number = 1; i < d->ncolumn; i++) {
        struct text t = {0};
        if (strcmp(d->column[first].name, d->column[i].name) != 0) first = i, number = 1;
        if (first == i) continue;
        do {
            t.length = 0;
            text_add(&t, "%s:%d", d->column[first].name, number++);
        } while (is_column(d, t.s));
        d->column[i].name = arena_text(d->a, t.s);
        text_free(&t);
    }
    /* "x:1" may stand behind "x!" */
    qsort(d->column, (size_t)d->ncolumn, sizeof *d->column, compare_columns);
}

/* Keys are sorted once, for all rows. */
static bool json_header(void *context, int ncolumn, const char *const *name,
                        const struct store_value *value)
{
    struct document_rows *d = context;
    (void)value;
    d->ncolumn = ncolumn;
    d->column = TAKE(d->a, ncolumn, struct key_place);
    for (int i = 0; i < ncolumn; i++)
        d->column[i] = (struct key_place){arena_text(d->a, name[i]), i};
    qsort(d->column, (size_t)ncolumn, sizeof *d->column, compare_columns);
    name_apart(d);
    json_array(&d->j);
    return true;
}

/* SQL's types are JSON's; what is not finite was stored as NULL. */
void report_value_json(struct json *j, const struct store_value *v)
{
    switch (v->kind) {
    case STORE_NULL: json_null(j); break;
    case STORE_INT: json_int(j, v->integer); break;
    case STORE_REAL: json_real(j, v->real); break;
    case STORE_TEXT: json_text(j, v->text); break;
    }
}

/* One object per row, columns in the order of their names. */
static bool json_row(void *context, int ncolumn, const char *const *name,
                     const struct store_value *value)
{
    struct document_rows *d = context;
    struct json *j = &d->j;
    (void)name;
    json_object(j);
    for (int i = 0; i < ncolumn; i++) {
        json_key(j, d->column[i].name);
        report_value_json(j, &value[d->column[i].at]);
    }
    json_end(j);
    return true;
}

static bool query_json(struct store *s, const char *sql, int nparam, const char *const *param,
                       FILE *out, struct err *e)
{
    struct document_rows d = {.j = json_make(out), .a = arena_create()};
    bool ok = store_query(s, sql, nparam, param, json_header, json_row, &d, e);
    /* A query that failed after its head leaves a list open. */
    if (d.j.depth > 0) json_end(&d.j);
    if (ok) json_finish(&d.j);
    arena_destroy(d.a);
    return ok;
}

/* Widths need all rows: the table is printed at the end, JSON row by row. */
bool report_query(struct store *s, const char *sql, int nparam, const char *const *param, bool json,
                  FILE *out, struct err *e)
{
    const struct report_look plain = {0};
    if (!json) return report_table(s, sql, nparam, param, &plain, out, e);
    const bool ok = query_json(s, sql, nparam, param, out, e);
    /* A full disk shows up when the buffer is flushed. */
    if (ok && (fflush(out) != 0 || ferror(out))) return err_set(e, ERR_IO,
                                                                "the output cannot be written");
    return ok;
}
