/* settings.c - see settings.h.
 *
 * A configuration's text has its keys in the order of the tables, so that a line stands at the same
 * place as in the run before: lines are compared in step, and only those that differ are looked up.
 */
#include "store/settings.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "spec/setting_number.h"
#include "store/binding.h"
#include "store/setting_rows.h"

/* The lines of the run that was put last, and their rows. */
struct settings {
    char *config; /* owned */
    int64_t *id;  /* owned, (capacity) row of each line */
    size_t capacity;
};

void settings_forget(struct store *s)
{
    if (s->settings == NULL) return;
    free(s->settings->config);
    free(s->settings->id);
    free(s->settings);
    s->settings = NULL;
}

/* "key = value" as it lies in the text. */
struct line {
    const char *key, *value;
    int nkey, nvalue;
};

/* The value of a setting as a number, which figures and queries need; NULL where it is none. */
static void bind_number(sqlite3_stmt *add, const struct line *l)
{
    double number;
    enum unit unit;
    char *name = memory_text_part(l->key, (size_t)l->nkey),
         *text = memory_text_part(l->value, (size_t)l->nvalue);
    if (setting_number(name, text, &number, &unit))
        store_bound(sqlite3_bind_double(add, 3, number));
    else store_bound(sqlite3_bind_null(add, 3));
    store_bound(sqlite3_bind_text(add, 4, units_si(unit), -1, SQLITE_STATIC));
    free(name);
    free(text);
}

/* A statement with key and value bound as parts of the text: no copies. */
static sqlite3_stmt *start(struct store *s, enum statement which, const struct line *l,
                           struct err *e)
{
    sqlite3_stmt *q = store_statement(s, which, e);
    if (q == NULL) return NULL;
    store_bound(sqlite3_bind_text(q, 1, l->key, l->nkey, SQLITE_STATIC));
    store_bound(sqlite3_bind_text(q, 2, l->value, l->nvalue, SQLITE_STATIC));
    return q;
}

/* The row of a setting, made when it is new. */
static bool row_of(struct store *s, const struct line *l, int64_t *id, struct err *e)
{
    sqlite3_stmt *find = start(s, STATEMENT_SETTING_FIND, l, e);
    if (find == NULL || !store_find_id(s, find, id, e)) return false;
    if (*id != 0) return true;
    sqlite3_stmt *add = start(s, STATEMENT_SETTING_ADD, l, e);
    if (add == NULL) return false;
    bind_number(add, l);
    if (!store_step(s, add, e)) return false;
    *id = sqlite3_last_insert_rowid(s->db);
    return true;
}

/* That run `run` has the settings of the rows in `list`, a list in JSON: one statement for all of
 * them takes two thirds of the time of one for each. */
static bool join(struct store *s, int64_t run, const struct text *list, struct err *e)
{
    struct binding b;
    if (!bind_start(s, STATEMENT_RUN_SETTINGS, &b, e)) return false;
    bind_int(&b, run);
    bind_text(&b, list->s);
    return store_step(s, b.statement, e);
}

/* Where the line at `at` ends: at a line feed or at the end of the text. */
static const char *end_of(const char *at) { return strchrnul(at, '\n'); }

/* Behind that. */
static const char *next_of(const char *end) { return *end != '\0' ? end + 1 : end; }

/* Line by line, those of the run before at once. */
static bool put_changed(struct store *s, int64_t run, const char *config, struct settings *now,
                        struct err *e)
{
    const struct settings *last = s->settings;
    const char *before = last != NULL ? last->config : "";
    struct text list = {0};
    bool ok = true;
    size_t n = 0;
    for (const char *line = config; *line != '\0' && ok; n++) {
        const char *end = end_of(line), *other = end_of(before);
        const size_t length = (size_t)(end - line);
        const bool same = (size_t)(other - before) == length && memcmp(line, before, length) == 0;
        const char *equals = memmem(line, length, " = ", 3);
        if (n == now->capacity) {
            now->capacity = now->capacity > 0 ? 2 * now->capacity : 256;
            now->id = memory_resize(now->id, now->capacity, sizeof *now->id);
        }
        now->id[n] = 0;
        /* What is no setting has no row. */
        if (equals != NULL) {
            const struct line l = {line, equals + 3, (int)(equals - line), (int)(end - equals - 3)};
            if (same) now->id[n] = last->id[n];
            else ok = row_of(s, &l, &now->id[n], e);
            text_add_bytes(&list, list.length > 0 ? "," : "[", 1);
            text_add_integer(&list, now->id[n]);
        }
        line = next_of(end);
        before = next_of(other);
    }
    if (ok && list.length > 0) {
        text_add_bytes(&list, "]", 1);
        ok = join(s, run, &list, e);
    }
    text_free(&list);
    return ok;
}

/* All lines at once, into a table without rows. */
static bool put_first(struct store *s, int64_t run, struct settings *now, struct err *e)
{
    /* Cut into its words in place. */
    char *copy = memory_text(now->config);
    size_t most = 1, n = 0, lines = 0;
    for (const char *at = copy; (at = strchr(at, '\n')) != NULL; at++) most++;
    struct setting_row *row = memory_take(most, sizeof *row);
    now->id = memory_zeroed(most, sizeof *now->id);
    now->capacity = most;
    for (char *line = copy, *next; *line != '\0'; line = next, lines++) {
        char *end = line + strcspn(line, "\n");
        next = *end != '\0' ? end + 1 : end;
        *end = '\0';
        char *equals = strstr(line, " = ");
        if (equals == NULL) continue;
        *equals = '\0';
        enum unit unit;
        row[n].key = line;
        row[n].value = equals + 3;
        row[n].numeric = setting_number(line, row[n].value, &row[n].number, &unit);
        row[n].unit = units_si(unit);
        now->id[lines] = (int64_t)++n;
    }
    int64_t first = 0;
    const bool ok = setting_rows_put(s, run, row, n, &first, e);
    for (size_t i = 0; i < lines; i++)
        if (now->id[i] != 0) now->id[i] += first - 1;
    free(row);
    free(copy);
    return ok;
}

/* A database that nobody else sees has no settings before its first run, so that none need be
 * looked for. */
bool settings_put(struct store *s, int64_t run, const char *config, struct err *e)
{
    if (s->passing || config == NULL) return true;
    struct settings now = {.config = memory_text(config)};
    const bool ok = s->unpublished && !s->had_settings ? put_first(s, run, &now, e)
                                                       : put_changed(s, run, config, &now, e);
    s->had_settings = true;
    settings_forget(s);
    s->settings = memory_zeroed(1, sizeof *s->settings);
    *s->settings = now;
    /* Half of them say nothing about the other half. */
    if (!ok) settings_forget(s);
    return ok;
}
