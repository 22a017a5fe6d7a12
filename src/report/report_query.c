/* report_query.c - the rows of a query as an aligned table or as one JSON document.
 *
 * A table is for eyes: six digits, "-" for NULL. The document is for programs: all digits, null. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/json.h"
#include "base/memory.h"
#include "base/text.h"
#include "report/report.h"

/* A table on its way to the terminal. */
struct grid {
    struct arena *a;
    int ncolumn;
    int *width;          /* (ncolumn) [characters] */
    bool *number;        /* (ncolumn) no text in it: aligned to the right */
    int64_t nrow, capacity;
    char **cell;         /* (capacity x ncolumn), row 0: the names */
};

/* Characters of UTF-8 text: bytes that do not continue one. */
static int text_width(const char *s)
{
    int n = 0;
    for (; *s; s++) n += ((unsigned char)*s & 0xC0) != 0x80;
    return n;
}

/* A value as people read it; what could move the cursor becomes a blank. */
static char *readable(struct arena *a, const struct store_value *v)
{
    char buffer[40];
    switch (v->kind) {
    case STORE_NULL: return arena_text(a, "-");
    case STORE_INT: snprintf(buffer, sizeof buffer, "%lld", (long long)v->integer); break;
    case STORE_REAL: snprintf(buffer, sizeof buffer, "%.6g", v->real); break;
    case STORE_TEXT: {
        char *s = arena_text(a, v->text);
        for (char *c = s; *c; c++)
            if ((unsigned char)*c < ' ' || *c == 127) *c = ' ';
        return s;
    }
    }
    return arena_text(a, buffer);
}

/* A row takes the widths of its columns with it, so that printing needs no second look at all
 * cells. */
static void grid_add(struct grid *g, char *const *cell)
{
    if (g->nrow == g->capacity) {
        g->capacity = g->capacity ? 2 * g->capacity : 64;
        g->cell = memory_resize(g->cell, (size_t)(g->capacity * g->ncolumn), sizeof *g->cell);
    }
    for (int i = 0; i < g->ncolumn; i++) {
        int width = text_width(cell[i]);
        if (width > g->width[i]) g->width[i] = width;
        g->cell[g->nrow * g->ncolumn + i] = cell[i];
    }
    g->nrow++;
}

/* Columns of numbers are aligned to the right until a text is seen in them. */
static bool grid_header(void *context, int ncolumn, const char *const *name,
                        const struct store_value *value)
{
    struct grid *g = context;
    (void)value;
    g->ncolumn = ncolumn;
    /* The names are row 0 and widen the columns like any row. */
    g->width = TAKE(g->a, ncolumn, int);
    g->number = TAKE(g->a, ncolumn, bool);
    char **cell = TAKE(g->a, ncolumn, char *);
    for (int i = 0; i < ncolumn; i++) {
        g->number[i] = true;
        cell[i] = arena_text(g->a, name[i]);
    }
    grid_add(g, cell);
    return true;
}

static bool grid_row(void *context, int ncolumn, const char *const *name,
                     const struct store_value *value)
{
    struct grid *g = context;
    (void)name;
    char **cell = TAKE(g->a, ncolumn, char *);
    for (int i = 0; i < ncolumn; i++) {
        if (value[i].kind == STORE_TEXT) g->number[i] = false;
        cell[i] = readable(g->a, &value[i]);
    }
    grid_add(g, cell);
    return true;
}

/* The last column is not padded: no line ends in blanks. */
static void grid_print(const struct grid *g, FILE *out)
{
    for (int64_t r = 0; r < g->nrow; r++)
        for (int i = 0; i < g->ncolumn; i++) {
            const char *cell = g->cell[r * g->ncolumn + i], *end = i + 1 < g->ncolumn ? "  " : "\n";
            int pad = g->width[i] - text_width(cell);
            if (g->number[i]) fprintf(out, "%*s%s%s", pad, "", cell, end);
            else fprintf(out, "%s%*s%s", cell, i + 1 < g->ncolumn ? pad : 0, "", end);
        }
}

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

/* Columns of one name, which a join may give, would be one key: the second becomes "name:1", as
 * SQLite calls it. */
static void name_apart(struct document_rows *d)
{
    for (int i = 0, first = 0; i < d->ncolumn; i++) {
        struct text t = {0};
        if (strcmp(d->column[first].name, d->column[i].name) != 0) first = i;
        if (first == i) continue;
        /* "x", "x:1", "x:2" */
        text_add(&t, "%s:%d", d->column[first].name, i - first);
        d->column[i].name = arena_text(d->a, t.s);
        text_free(&t);
    }
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
    bool ok;
    if (json) ok = query_json(s, sql, nparam, param, out, e);
    else {
        /* All rows in memory: a database of reports has thousands, not millions. */
        struct grid g = {.a = arena_create()};
        ok = store_query(s, sql, nparam, param, grid_header, grid_row, &g, e);
        if (ok) grid_print(&g, out);
        free(g.cell);
        arena_destroy(g.a);
    }
    /* A full disk shows up when the buffer is flushed. */
    if (ok && (fflush(out) != 0 || ferror(out))) return err_set(e, ERR_IO,
                                                                "the output cannot be written");
    return ok;
}
