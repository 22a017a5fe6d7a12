/* column.c - values out of rows, and rows as SQL, JSON and aligned text.
 *
 * A table is walked, never a struct: whoever adds a result adds a row to its table, and every
 * output has it. Tables are short; nothing in here is worth an index. */
#include "measure/column.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/check.h"

/* More than any table has; sort_keys checks it. */
enum { MOST_COLUMNS = 128 };

/* Absent where the table says that this number means nothing (no loops: 0 rows). */
static void set_int(const struct column *c, int64_t x, struct column_value *v)
{
    if ((c->absent == ABSENT_ZERO && x <= 0) || (c->absent == ABSENT_NEGATIVE && x < 0)) return;
    v->kind = VALUE_INT;
    v->integer = x;
}

/* "Not a number" and infinity are absent: no database and no JSON could hold them. */
static void set_real(const struct column *c, double x, struct column_value *v)
{
    if (!isfinite(x) || (c->absent == ABSENT_ZERO && x <= 0) ||
        (c->absent == ABSENT_NEGATIVE && x < 0))
        return;
    v->kind = VALUE_REAL;
    v->real = x;
}

/* Borrowed: texts live in the row, or in the value's own buffer. */
static void set_text(const char *s, struct column_value *v)
{
    if (s == NULL) return;
    v->kind = VALUE_TEXT;
    v->text = s;
}

/* A value outside the enum is a mistake of the program, not of its input. */
static void set_word(const struct column *c, unsigned x, struct column_value *v)
{
    CHECK(x < (unsigned)c->nword);
    set_text(c->word[x], v);
}

/* One value: known at all? made by a function? else read from its place by its kind. */
void column_read(const struct column *c, const void *row, struct column_value *v)
{
    v->kind = VALUE_ABSENT;
    /* Not known: absent, and the place is not even looked at. */
    if (c->known != NULL && !c->known(row)) return;
    if (c->value != NULL) {
        c->value(c, row, v);
        return;
    }
    /* The struct that holds the value: the row, or what one of its members points to. */
    const char *base = row;
    /* memcpy, since the type of the pointer is not known here. */
    if (c->part > 0) memcpy(&base, base + c->part - 1, sizeof base);
    const void *at = base + c->offset;
    /* Each kind from its C type to one of four kinds of value. */
    switch (c->kind) {
    case COLUMN_INT: set_int(c, *(const int *)at, v); break;
    case COLUMN_INT64: set_int(c, *(const int64_t *)at, v); break;
    case COLUMN_COUNT: set_int(c, (int64_t)*(const uint64_t *)at, v); break;
    case COLUMN_REAL: set_real(c, *(const double *)at, v); break;
    case COLUMN_WORD: set_word(c, *(const unsigned *)at, v); break;
    case COLUMN_CHARS: set_text(at, v); break;
    case COLUMN_STRING: set_text(*(const char *const *)at, v); break;
    case COLUMN_BOOL:
        v->kind = VALUE_BOOL;
        v->integer = *(const bool *)at;
        break;
    /* SQLite's integers are signed: a fingerprint of 64 bits is a text. */
    case COLUMN_HEX:
        snprintf(v->buffer, sizeof v->buffer, "%016" PRIx64, *(const uint64_t *)at);
        set_text(v->buffer, v);
        break;
    }
}

/* --- the database ----------------------------------------------------------------------------- */

/* SQLite's types for STRICT tables. */
static const char *sql_type(enum column_kind kind)
{
    switch (kind) {
    case COLUMN_REAL: return "REAL";
    case COLUMN_WORD:
    case COLUMN_CHARS:
    case COLUMN_STRING:
    case COLUMN_HEX: return "TEXT";
    default: return "INTEGER";
    }
}

/* Enums become CHECK constraints: the database refuses what the program does not know. The line of
 * documentation stands behind each column as an SQL comment. */
void columns_define(const struct column_table *t, struct text *sql)
{
    for (int i = 0; i < t->n; i++) {
        const struct column *c = &t->column[i];
        if (c->flags & COLUMN_NO_SQL) continue;
        /* No column without its line in the manual. */
        CHECK(c->doc != NULL);
        text_add(sql, "    %s %s%s", c->name, sql_type(c->kind),
                 c->flags & COLUMN_NULL ? "" : " NOT NULL");
        /* name TYPE [NOT NULL] [CHECK (..)], -- documentation */
        if (c->nword > 0) text_add(sql, " CHECK (%s IN (", c->name);
        for (int k = 0; k < c->nword; k++) text_add(sql, "%s'%s'", k > 0 ? ", " : "", c->word[k]);
        text_add(sql, "%s, -- %s\n", c->nword > 0 ? "))" : "", c->doc);
    }
}

/* Names for an INSERT, in the order of the table; how many there are. */
int columns_list(const struct column_table *t, struct text *sql)
{
    int n = 0;
    for (int i = 0; i < t->n; i++) {
        if (t->column[i].flags & COLUMN_NO_SQL) continue;
        text_add(sql, ", %s", t->column[i].name);
        n++;
    }
    return n;
}

/* --- JSON ------------------------------------------------------------------------------------- */

static const char *json_name(const struct column *c) { return c->key != NULL ? c->key : c->name; }

/* The columns that JSON shows, by key. Returns how many. Sorted, so that documents can be compared
 * by text; insertion sort, once for a whole list of rows. */
static int sort_keys(const struct column_table *t, const struct column *sorted[MOST_COLUMNS])
{
    int n = 0;
    CHECK(t->n <= MOST_COLUMNS);
    for (int i = 0; i < t->n; i++) {
        const struct column *c = &t->column[i];
        int at = n;
        if (c->flags & COLUMN_NO_JSON) continue;
        for (; at > 0 && strcmp(json_name(sorted[at - 1]), json_name(c)) > 0; at--)
            sorted[at] = sorted[at - 1];
        sorted[at] = c;
        n++;
    }
    return n;
}

/* json_scale: users of JSON get seconds where the database has picoseconds. */
static void json_value(const struct column *c, const struct column_value *v, struct json *j)
{
    switch (v->kind) {
    case VALUE_ABSENT: json_null(j); break;
    case VALUE_INT:
        if (c->json_scale != 0) json_real(j, (double)v->integer * c->json_scale);
        else json_int(j, v->integer);
        break;
    case VALUE_REAL: json_real(j, c->json_scale != 0 ? v->real * c->json_scale : v->real); break;
    case VALUE_TEXT: json_text(j, v->text); break;
    case VALUE_BOOL: json_bool(j, v->integer); break;
    }
}

static void json_row(const struct column *const *sorted, int n, const void *row, struct json *j)
{
    json_object(j);
    for (int i = 0; i < n; i++) {
        const struct column *c = sorted[i];
        struct column_value v = {0};
        const bool known = c->known == NULL || c->known(row);
        /* A list that is not known has no key; a value has one, with null. */
        if (!known && (c->flags & COLUMN_OPTIONAL || c->json != NULL)) continue;
        json_key(j, json_name(c));
        if (c->json != NULL) {
            c->json(c, row, j);
            continue;
        }
        column_read(c, row, &v);
        json_value(c, &v, j);
    }
    json_end(j);
}

void columns_json(const struct column_table *t, const void *row, struct json *j)
{
    const struct column *sorted[MOST_COLUMNS];
    json_row(sorted, sort_keys(t, sorted), row, j);
}

/* The keys are sorted once for all rows. */
void columns_json_list(const struct column_table *t, const void *row, int n, size_t size,
                       struct json *j)
{
    const struct column *sorted[MOST_COLUMNS];
    const int nkey = sort_keys(t, sorted);
    json_array(j);
    for (int i = 0; i < n; i++) json_row(sorted, nkey, (const char *)row + (size_t)i * size, j);
    json_end(j);
}

/* --- the terminal ----------------------------------------------------------------------------- */

/* Heads are as wide as their cells, which keeps the columns aligned. */
void columns_title(const struct column_table *t, FILE *out)
{
    for (int i = 0; i < t->n; i++) {
        const struct column *c = &t->column[i];
        if (c->title != NULL && c->title[0])
            fprintf(out, "%s%*s", c->before != NULL ? c->before : "", c->width, c->title);
    }
    fputc('\n', out);
}

/* Digits and form are the column's: a time needs others than a ratio. */
static void print_real(const struct column *c, double x, FILE *out)
{
    if (c->scale != 0) x *= c->scale;
    switch (c->style) {
    case 'e': fprintf(out, "%*.*e", c->width, c->digits, x); break;
    case 'f': fprintf(out, "%*.*f", c->width, c->digits, x); break;
    default: fprintf(out, "%*.*g", c->width, c->digits, x); break;
    }
}

/* "-" where nothing is known, so that every line has all cells. */
void columns_cells(const struct column_table *t, const void *row, FILE *out)
{
    for (int i = 0; i < t->n; i++) {
        const struct column *c = &t->column[i];
        struct column_value v = {0};
        /* Not a column of the terminal. */
        if (c->title == NULL) continue;
        if (c->before != NULL) fputs(c->before, out);
        column_read(c, row, &v);
        if (v.kind == VALUE_ABSENT) fprintf(out, "%*s", c->width, "-");
        else if (v.kind == VALUE_TEXT) fprintf(out, "%*s", c->width, v.text);
        else if (v.kind == VALUE_REAL) print_real(c, v.real, out);
        else if (c->style) print_real(c, (double)v.integer, out);
        else fprintf(out, "%*" PRId64, c->width, v.integer);
    }
}

void columns_print(const struct column_table *t, const void *row, FILE *out)
{
    columns_cells(t, row, out);
    fputc('\n', out);
}
