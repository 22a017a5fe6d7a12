/* schema_document.c - the manual of the database: its tables, views and columns, with what
 * schema.sql and the tables of columns say of them.
 *
 * Names, types and keys are those of a database made for it; the words are the comments of the same
 * text. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"
#include "store/rows.h"
#include "store/store.h"

struct document {
    FILE *out;
    const char *schema;    /* the whole text */
    char block[64];        /* the table or view that is being written */
    bool view;
    const char *about;     /* its first line of comment in the text */
    const char *statement; /* its CREATE in the text */
};

/* The text is read line by line, in place. */
static const char *next_line(const char *line)
{
    const char *end = strchr(line, '\n');
    return end != NULL ? end + 1 : line + strlen(line);
}

/* Whether the text at `line` begins with `word`. */
static bool starts(const char *line, const char *word)
{
    return strncmp(line, word, strlen(word)) == 0;
}

/* The statement that makes `name`; *about the first of the comment lines right above it, or the
 * statement itself. */
static const char *find_statement(const char *schema, const char *name, const char **about)
{
    static const char *const opening[] = {"CREATE TABLE IF NOT EXISTS ", "CREATE TABLE ",
                                          "CREATE VIEW IF NOT EXISTS ", "CREATE VIEW "};
    *about = NULL;
    for (const char *line = schema; *line; line = next_line(line)) {
        /* Comment lines right above the statement belong to it; any other line in between ends
         * them. */
        if (starts(line, "-- ")) {
            if (*about == NULL) *about = line;
            continue;
        }
        for (int i = 0; i < 4; i++) {
            const char *rest = line + strlen(opening[i]);
            if (!starts(line, opening[i]) || !starts(rest, name) || rest[strlen(name)] != ' ')
                continue;
            if (*about == NULL) *about = line;
            return line;
        }
        *about = NULL;
    }
    return NULL;
}

/* The comment of column `name` of the table at `statement`, in text; false: there is none. */
static bool table_comment(const char *statement, const char *name, struct text *out)
{
    for (const char *line = next_line(statement); *line && *line != ')'; line = next_line(line)) {
        /* A line of a table: "    name TYPE ...,  -- text". */
        const char *word = line + strspn(line, " "), *end = next_line(line),
                   *dashes = strstr(word, "-- ");
        const size_t length = strcspn(word, " ");
        if (length != strlen(name) || strncmp(word, name, length) != 0) continue;
        if (dashes == NULL || dashes >= end) return false;
        text_add_bytes(out, dashes + 3, (size_t)(end - dashes) - 4);
        return true;
    }
    return false;
}

/* The same of a view: a line "--   name: text" above its statement. */
static bool view_comment(const char *about, const char *statement, const char *name,
                         struct text *out)
{
    for (const char *line = about; line < statement; line = next_line(line)) {
        const char *word = line + 5, *end = next_line(line);
        const size_t length = strlen(name);
        if (!starts(line, "--   ") || strncmp(word, name, length) != 0 || word[length] != ':')
            continue;
        text_add_bytes(out, word + length + 2, (size_t)(end - word) - length - 3);
        return true;
    }
    return false;
}

/* Whether the statement, up to its semicolon, reads from `table`. */
static bool reads(const char *statement, const char *table)
{
    const char *end = strchr(statement, ';');
    struct text word = {0};
    bool found = false;
    text_add(&word, " %s", table);
    for (const char *at = strstr(statement, word.s); at != NULL && at < end;
         at = strstr(at + 1, word.s))
        /* The whole name, behind FROM or JOIN: "run" is not "run_setting". */
        found = found || (strchr(" \n;)", at[word.length]) != NULL && at[word.length] &&
                          (starts(at - 4, "FROM") || starts(at - 4, "JOIN")));
    text_free(&word);
    return found;
}

/* What is said of a column: by its own table, by its view, or by the first table or view of entries
 * that the view reads and has it. */
static void describe(const struct document *d, const char *name, struct text *out)
{
    if (!d->view) {
        table_comment(d->statement, name, out);
        return;
    }
    if (view_comment(d->about, d->statement, name, out)) return;
    for (const char *line = d->schema; *line; line = next_line(line)) {
        char table[64] = "";
        const bool view = sscanf(line, "CREATE VIEW %63[a-z_]", table) == 1;
        if ((!view && sscanf(line, "CREATE TABLE %63[a-z_]", table) != 1) ||
            !reads(d->statement, table))
            continue;
        const char *about = NULL;
        if (view) find_statement(d->schema, table, &about);
        if (view ? view_comment(about, line, name, out) : table_comment(line, name, out)) return;
    }
}

/* A heading for each table or view, its comment as text, and the head of the list of columns. */
static void open_block(struct document *d, const char *kind, const char *name)
{
    text_copy(d->block, sizeof d->block, name);
    d->view = strcmp(kind, "view") == 0;
    d->statement = find_statement(d->schema, name, &d->about);
    CHECK(d->statement != NULL);
    fprintf(d->out, "\n## %s `%s`\n\n", d->view ? "View" : "Table", name);
    for (const char *line = d->about; line < d->statement; line = next_line(line))
        if (!starts(line, "--   "))
            fprintf(d->out, "%.*s", (int)(next_line(line) - line) - 3, line + 3);
    fprintf(d->out, "\n| column | type | meaning |\n| --- | --- | --- |\n");
}

/* A row of the structure: kind, block, column, type, whether it may be NULL, place in the key. */
static bool write_column(void *context, int ncolumn, const char *const *name,
                         const char *const *value)
{
    struct document *d = context;
    struct text said = {0}, cell = {0};
    (void)ncolumn;
    (void)name;
    /* Rows come block by block. */
    if (strcmp(d->block, value[1]) != 0) open_block(d, value[0], value[1]);
    describe(d, value[2], &said);
    /* A bar would end the cell. */
    for (size_t i = 0; i < said.length; i++)
        text_add(&cell, "%s%c", said.s[i] == '|' ? "\\" : "", said.s[i]);
    const bool key = strcmp(value[5], "0") != 0, null = !d->view && strcmp(value[4], "0") == 0;
    fprintf(d->out, "| `%s` | %s%s%s | %s |\n", value[2], value[3], null ? ", NULL" : "",
            key ? ", key" : "", cell.length > 0 ? cell.s : "-");
    text_free(&said);
    text_free(&cell);
    return true;
}

/* Every column of tables, then of views, in the order of the text, ?1: nothing refers to a table
 * before it is made. A key is never NULL. */
static const char structure_sql[] =
    "SELECT m.type, m.name, p.name, coalesce(nullif(p.type, ''), 'computed'), p.\"notnull\" OR "
    "p.pk > 0, p.pk FROM sqlite_schema m, pragma_table_info(m.name) p WHERE m.type IN ('table', "
    "'view') AND m.name NOT LIKE 'sqlite%' ORDER BY m.type, instr(?1, ' ' || m.name || "
    "iif(m.type = 'view', ' AS', ' (')), p.cid";

bool store_document(FILE *out, struct err *e)
{
    struct text schema = {0};
    rows_schema(&schema);
    struct document d = {.out = out, .schema = schema.s};
    /* An empty database of this version tells names, types and keys as SQLite sees them. */
    struct store *s = store_open("(a new database)", STORE_MEMORY, e);
    fprintf(out, "# The database\n\n");
    for (const char *line = schema.s; starts(line, "-- "); line = next_line(line))
        fprintf(out, "%.*s", (int)(next_line(line) - line) - 3, line + 3);
    fprintf(out, "\n`mimdsim query --schema` writes this page. `NULL` behind a type: the value may "
                 "be unknown; `key`: part of the\nprimary key.\n");
    bool ok = s != NULL && store_select(s, structure_sql, 1, &d.schema, write_column, &d, e);
    store_close(s);
    text_free(&schema);
    return ok;
}
