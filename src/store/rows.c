/* rows.c - statements out of tables of columns (rows.h).
 *
 * The columns of a row stand once, beside their struct; INSERT, CREATE TABLE and the order of
 * binding all come from there, so that they cannot disagree. */
#include "store/rows.h"

#include <string.h>

#include "base/check.h"
#include "measure/load_row.h"
#include "measure/real_row.h"
#include "measure/run_row.h"
#include "measure/study_row.h"
#include "spec/field.h"
#include "spec/spec_fields.h"
#include "store/run_entries.h"
#include "store/schema.h"

enum { MOST_SEGMENTS = 5 };

/* A table of schema.sql: the keys that are bound first, what a statement fills in itself, and its
 * columns in order. */
struct row_table {
    enum statement statement;
    const char *name, *keys;
    const char *made, *maker; /* ", column" and ", expression"; "": none */
    const struct column_table *segment[MOST_SEGMENTS + 1];
};

/* The columns of a run come from five structs; every other row is one struct. */
static const struct row_table row_table[] = {
    {STATEMENT_RUN_INSERT,
     "run",
     "build_id",
     ", created_utc",
     ", strftime('%Y-%m-%dT%H:%M:%SZ', 'now')",
     {&run_identity_columns, &run_outcome_columns, &run_level_columns, &run_refinement_columns,
      &run_config_columns}},
    {STATEMENT_STAGE, "stage", "run_id, stage", "", "", {&stage_row_columns}},
    {STATEMENT_BASELINE, "baseline", "run_id, ordinal", "", "", {&baseline_columns}},
    {STATEMENT_ERROR_CHECK, "error_check", "run_id, ordinal", "", "", {&error_check_columns}},
    {STATEMENT_OMISSION, "run_omission", "run_id", "", "", {&omission_columns}},
    {STATEMENT_SPAN, "span", "run_id, span", "", "", {&span_columns}},
};
enum { TABLES = sizeof row_table / sizeof *row_table };

/* Tables that studies fill, by store_insert_row: their keys stand in schema.sql. */
static const struct {
    const char *name;
    const struct column_table *columns;
} study_table[] = {
    {"ladder", &accuracy_rung_columns},
    {"ladder_choice", &accuracy_choice_columns},
    {"stability", &stability_columns},
    {"omission", &saving_columns},
    {"load_series", &load_series_columns},
    {"load_point", &load_point_columns},
    {"real_run", &real_result_columns},
    {"real_stage", &real_stage_columns},
    {"real_sample", &real_sample_columns},
};
enum { STUDY_TABLES = sizeof study_table / sizeof *study_table };

/* A statement without a table would be a mistake of ours. */
static const struct row_table *table_of(enum statement which)
{
    const struct row_table *t = row_table;
    while (t < row_table + TABLES && t->statement != which) t++;
    CHECK(t < row_table + TABLES);
    return t;
}

void rows_insert(enum statement which, struct text *sql)
{
    /* Keys first, then what the statement fills in itself, then the columns: rows_bind counts on
     * it. */
    const struct row_table *t = table_of(which);
    int ncolumn = 0;
    text_add(sql, "INSERT INTO %s (%s%s", t->name, t->keys, t->made);
    for (int i = 0; t->segment[i] != NULL; i++) ncolumn += columns_list(t->segment[i], sql);
    /* A question mark for each key, the expression, a question mark for each column. */
    text_add(sql, ") VALUES (?");
    for (const char *c = t->keys; *c; c++)
        if (*c == ',') text_add(sql, ", ?");
    text_add(sql, "%s", t->maker);
    for (int i = 0; i < ncolumn; i++) text_add(sql, ", ?");
    text_add(sql, ")");
}

/* The column definitions of the table called name[0 .. length). */
static void add_columns(const char *name, size_t length, struct text *sql)
{
    for (int i = 0; i < TABLES; i++) {
        const struct row_table *t = &row_table[i];
        if (strlen(t->name) != length || strncmp(t->name, name, length) != 0) continue;
        /* A row of several structs has their columns one after the other. */
        for (int k = 0; t->segment[k] != NULL; k++) columns_define(t->segment[k], sql);
        return;
    }
    for (int i = 0; i < STUDY_TABLES; i++) {
        if (strlen(study_table[i].name) != length ||
            strncmp(study_table[i].name, name, length) != 0)
            continue;
        columns_define(study_table[i].columns, sql);
        return;
    }
    /* our own mistake in schema.sql, which a message without the table's name would not find */
    struct text missing = {0};
    text_add(&missing, "schema.sql asks for the columns of '%.*s', which row_table lacks",
             (int)length, name);
    check_failed(__FILE__, __LINE__, missing.s);
}

/* A mark VIEW.words or VIEW.fields: what the entries of a run hold behind their keys, as that view
 * shows it, as its lines of comment or its list of columns. False: the mark is none of these. */
static bool add_entry_view(const char *mark, struct text *sql)
{
    const struct entry_view *v = entry_view, *end = entry_view + ENTRY_VIEWS;
    size_t n = 0;
    for (; v < end; v++)
        if (n = strlen(v->view), strncmp(mark, v->view, n) == 0 && mark[n] == '.') break;
    if (v == end) return false;
    const bool words = strncmp(mark + n, ".words@", 7) == 0;
    for (int i = 0; i < v->columns->n; i++) {
        const struct column *c = &v->columns->column[i];
        if (words) text_add(sql, "--   %s: %s\n", c->name, c->doc);
        else
            text_add(sql, "       , json_extract(e.value, '$[%d]') AS %s\n", v->nkey + i, c->name);
    }
    return true;
}

/* A row for each setting whose 0 has a word of its own (field.h). */
static void add_unlimited(struct text *sql)
{
    int n;
    const struct field_table *const *table = field_tables(&n);
    const char *before = "SELECT";
    for (int i = 0; i < n; i++)
        for (int k = 0; k < table[i]->nfield; k++) {
            const struct field *f = &table[i]->field[k];
            if (f->zero == NULL) continue;
            text_add(sql, "%s '%s.%s' AS key", before, table[i]->prefix, f->key);
            before = "\nUNION ALL SELECT";
        }
    text_add(sql, ";\n");
}

/* schema.sql has a line "@table@" where the columns of that table belong. */
void rows_schema(struct text *sql)
{
    const char *rest = schema_text(), *at;
    while ((at = strchr(rest, '@')) != NULL) {
        const char *end = strchr(at + 1, '@');
        /* A mark is a whole line; an @ anywhere else in schema.sql stops the program here. */
        CHECK(end != NULL && end[1] == '\n');
        text_add_bytes(sql, rest, (size_t)(at - rest));
        if (strncmp(at + 1, "unlimited@", 10) == 0) add_unlimited(sql);
        else if (!add_entry_view(at + 1, sql)) add_columns(at + 1, (size_t)(end - at - 1), sql);
        rest = end + 2;
    }
    text_add(sql, "%s", rest);
}

void rows_database(struct text *sql)
{
    rows_schema(sql);
    text_add(sql, "PRAGMA application_id = %d; PRAGMA user_version = %d;", STORE_APPLICATION,
             STORE_VERSION);
    text_add(sql, "INSERT INTO meta VALUES ('rank_rows_limit', %d), ('link_rows_limit', %d),"
                  " ('span_rows_limit', %d);",
             STORE_RANK_ROWS, STORE_LINK_ROWS, STORE_SPAN_ROWS);
}

/* One value into the statement's next parameter. Texts are not copied: the row lives until the
 * step. */
static void bind_column(struct binding *b, const struct column *c, const void *row)
{
    struct column_value v = {0};
    column_read(c, row, &v);
    switch (v.kind) {
    case VALUE_ABSENT: bind_null(b); break;
    case VALUE_REAL: bind_real(b, v.real); break;
    /* What lies in the buffer is gone when the statement runs. */
    case VALUE_TEXT:
        store_bound(sqlite3_bind_text(b->statement, b->next++, v.text, -1,
                          v.text == v.buffer ? SQLITE_TRANSIENT : SQLITE_STATIC));
        break;
    default: bind_int(b, v.integer); break;
    }
}

/* In the order of rows_insert; the check fails when the two differ. */
void rows_bind(enum statement which, struct binding *b, const void *row)
{
    const struct row_table *t = table_of(which);
    for (int i = 0; t->segment[i] != NULL; i++)
        for (int k = 0; k < t->segment[i]->n; k++)
            if (!(t->segment[i]->column[k].flags & COLUMN_NO_SQL))
                bind_column(b, &t->segment[i]->column[k], row);
    CHECK(b->next - 1 == sqlite3_bind_parameter_count(b->statement));
}
