/* setting_rows.c - see setting_rows.h.
 *
 * SQLite reads them as a table of its own, whose cells are those of an array: a virtual table
 * (sqlite.org/vtab.html), that is there while the statement is. */
#include "store/setting_rows.h"

#include "store/binding.h"

/* What the table reads; its members are those of the statement that follows. */
struct source {
    const struct setting_row *row; /* (n), borrowed */
    size_t n;
};

/* First members are SQLite's. */
struct table {
    sqlite3_vtab base;
    const struct source *source;
};
struct cursor {
    sqlite3_vtab_cursor base;
    size_t at;
};

enum { KEY, VALUE, NUMBER, UNIT };

static const struct source *source_of(const sqlite3_vtab_cursor *c)
{
    return ((const struct table *)c->pVtab)->source;
}

static int connect_table(sqlite3 *db, void *source, int n, const char *const *word,
                         sqlite3_vtab **out, char **message)
{
    (void)n, (void)word, (void)message;
    struct table *t = sqlite3_malloc(sizeof *t);
    if (t == NULL) return SQLITE_NOMEM;
    *t = (struct table){.source = source};
    *out = &t->base;
    const int code = sqlite3_declare_vtab(db, "CREATE TABLE x (key, value, number, unit)");
    if (code == SQLITE_OK) return SQLITE_OK;
    sqlite3_free(t);
    *out = NULL;
    return code;
}

static int disconnect(sqlite3_vtab *t)
{
    sqlite3_free(t);
    return SQLITE_OK;
}

/* There is one way to read it: all of it, in order. */
static int plan_read_all(sqlite3_vtab *t, sqlite3_index_info *plan)
{
    plan->estimatedRows = (sqlite3_int64)((const struct table *)t)->source->n;
    return SQLITE_OK;
}

static int open_cursor(sqlite3_vtab *t, sqlite3_vtab_cursor **out)
{
    (void)t;
    struct cursor *c = sqlite3_malloc(sizeof *c);
    if (c == NULL) return SQLITE_NOMEM;
    *c = (struct cursor){.at = 0};
    *out = &c->base;
    return SQLITE_OK;
}

static int close_cursor(sqlite3_vtab_cursor *c)
{
    sqlite3_free(c);
    return SQLITE_OK;
}

static int begin_reading(sqlite3_vtab_cursor *c, int plan, const char *text, int n,
                         sqlite3_value **v)
{
    (void)plan, (void)text, (void)n, (void)v;
    ((struct cursor *)c)->at = 0;
    return SQLITE_OK;
}

static int next_row(sqlite3_vtab_cursor *c)
{
    ((struct cursor *)c)->at++;
    return SQLITE_OK;
}

static int is_behind_last(sqlite3_vtab_cursor *c)
{
    return ((const struct cursor *)c)->at >= source_of(c)->n;
}

/* The texts outlive the statement: no copies. */
static int read_cell(sqlite3_vtab_cursor *c, sqlite3_context *out, int column)
{
    const struct setting_row *row = &source_of(c)->row[((const struct cursor *)c)->at];
    switch (column) {
    case KEY: sqlite3_result_text(out, row->key, -1, SQLITE_STATIC); break;
    case VALUE: sqlite3_result_text(out, row->value, -1, SQLITE_STATIC); break;
    case UNIT: sqlite3_result_text(out, row->unit, -1, SQLITE_STATIC); break;
    case NUMBER: /* without a result it is NULL */
        if (row->numeric) sqlite3_result_double(out, row->number);
    }
    return SQLITE_OK;
}

static int read_rowid(sqlite3_vtab_cursor *c, sqlite3_int64 *out)
{
    *out = (sqlite3_int64)((const struct cursor *)c)->at;
    return SQLITE_OK;
}

static const sqlite3_module module = {.xConnect = connect_table,
                                      .xDisconnect = disconnect,
                                      .xBestIndex = plan_read_all,
                                      .xOpen = open_cursor,
                                      .xClose = close_cursor,
                                      .xFilter = begin_reading,
                                      .xNext = next_row,
                                      .xEof = is_behind_last,
                                      .xColumn = read_cell,
                                      .xRowid = read_rowid};

/* Without memory the table may stay, in which case it reads `source` no more: no statement names
 * it. */
bool setting_rows_put(struct store *s, int64_t run, const struct setting_row *row, size_t n,
                      int64_t *first, struct err *e)
{
    static const char name[] = "made_setting";
    struct source source = {row, n};
    bool ok = sqlite3_create_module(s->db, name, &module, &source) == SQLITE_OK ||
              store_failed(s, e);
    ok = ok && store_exec(s,
                          "INSERT INTO setting (key, value, number, unit) "
                          "SELECT key, value, number, unit FROM made_setting",
                          e);
    *first = sqlite3_last_insert_rowid(s->db) - (int64_t)n + 1;
    sqlite3_create_module(s->db, name, NULL, NULL);
    struct binding b;
    if (!ok || !bind_start(s, STATEMENT_FIRST_SETTINGS, &b, e)) return false;
    bind_int(&b, run);
    return store_step(s, b.statement, e);
}
