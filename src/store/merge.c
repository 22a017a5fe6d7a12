/* merge.c - one database attached to another one, and its rows taken over; see merge.h.
 *
 * Numbers of rows mean nothing outside their database. So rows that others refer to (builds,
 * settings, runs) are found again by what identifies them, and references are translated on the
 * way. The list of tables comes from the schema itself: a new table with a run_id is merged without
 * a word here. */
#include "store/merge.h"

#include <string.h>
#include <sys/stat.h>

#include "base/text.h"
#include "store/connection.h"
#include "store/guard.h"
#include "store/schema.h"

/* Studies whose rows stand for themselves. Verdicts on claims and explanations are left out: they
 * judge all runs of a database together, so after a merge they are to be made anew. */
static const char *const study_table[] = {"check_point", "ladder", "ladder_choice", "stability",
                                          "omission",    "load_series", "load_point",
                                          "real_run",    "real_stage",  "real_sample"};

/* --- the other database ----------------------------------------------------------------------- */

/* By device and inode: two paths may name one file. */
static bool same_file(const char *a, const char *b)
{
    struct stat x, y;
    return stat(a, &x) == 0 && stat(b, &y) == 0 && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

/* Whether it is a database of this version: opening it as every reader does tells. */
static bool look_at(const struct store *s, const char *from, struct err *e)
{
    if (same_file(s->path, from))
        return err_set(e, ERR_USAGE, "%s would be merged into itself", from);
    struct store *other = store_open(from, STORE_READ, e);
    if (other == NULL) return false;
    const bool older = store_remark(other) != NULL;
    store_close(other);
    return !older ||
           err_set(e, ERR_DATA,
                   "database %s is of an older version; `mimdsim query --upgrade %s` upgrades it",
                   from, from);
}

/* As schema `other` of the same connection, so that one statement can read both. */
static bool attach(struct store *s, const char *from, struct err *e)
{
    sqlite3_stmt *q = NULL;
    bool ok = sqlite3_prepare_v2(s->db, "ATTACH ?1 AS other", -1, &q, NULL) == SQLITE_OK;
    if (ok) store_bound(sqlite3_bind_text(q, 1, from, -1, SQLITE_STATIC));
    ok = ok && sqlite3_step(q) == SQLITE_DONE;
    /* The failure is that of the other database. */
    if (!ok) store_failed(&(struct store){.db = s->db, .path = (char *)from}, e);
    sqlite3_finalize(q);
    return ok;
}

/* Whether schema.sql makes this table so. */
static bool is_made(const char *how, const char *table)
{
    struct text made = {0};
    text_add(&made, "%s %s (", how, table);
    const bool found = strstr(schema_text(), made.s) != NULL;
    text_free(&made);
    return found;
}

/* Tables of the first databases of this version, and those that came later, which store.c adds when
 * it opens a database for writing. All others are the user's own and stay where they are. */
static bool is_required(const char *table) { return is_made("CREATE TABLE", table); }
static bool is_optional(const char *table)
{
    return is_made("CREATE TABLE IF NOT EXISTS", table);
}

/* Every table of ours must be there, but for those that came later: they are empty then. A view
 * in the place of a table could return anything. */
static bool check_tables(struct store *s, const char *from, struct err *e)
{
    int lacking = 0;
    sqlite3_stmt *q = NULL;
    bool ok = sqlite3_prepare_v2(
                  s->db,
                  "SELECT m.name, o.type FROM main.sqlite_schema m LEFT JOIN other.sqlite_schema o "
                  "USING (name) WHERE m.type = 'table' AND (o.type IS NULL OR o.type <> 'table')",
                  -1, &q, NULL) == SQLITE_OK;
    while (ok && sqlite3_step(q) == SQLITE_ROW) {
        const bool absent = sqlite3_column_type(q, 1) == SQLITE_NULL;
        const char *table = store_cell(q, 0);
        lacking += is_required(table) || (!absent && is_optional(table));
    }
    ok = (sqlite3_finalize(q) == SQLITE_OK && ok) || store_failed(s, e);
    return ok && (lacking == 0 || err_set(e, ERR_DATA,
                                          "database %s lacks %d of the tables of this version",
                                          from, lacking));
}

/* ---- which runs ---- */

/* Two programs that disagree about one run: whoever is right, a merge must not choose in
 * silence. */
static bool check_digests(struct store *s, const char *from, struct err *e)
{
    /* Only runs that ended well have a digest that means something; both builds are told. */
    static const char sql[] =
        "SELECT h.config_hash, h.seed, h.rep, h.digest, o.digest, hb.version || ' ' || hb.git || ' "
        "' || hb.compiler, ob.version || ' ' || ob.git || ' ' || ob.compiler FROM main.run h JOIN "
        "other.run o USING (config_hash, seed, rep) JOIN main.build hb ON hb.id = h.build_id JOIN "
        "other.build ob ON ob.id = o.build_id WHERE h.status = 'ok' AND o.status = 'ok' AND "
        "h.digest <> o.digest ORDER BY h.id LIMIT 1";
    sqlite3_stmt *q = NULL;
    bool ok = sqlite3_prepare_v2(s->db, sql, -1, &q, NULL) == SQLITE_OK;
    const int code = ok ? sqlite3_step(q) : SQLITE_ERROR;
    /* One example is enough to stop. */
    if (code == SQLITE_ROW) {
        const char *text[7];
        for (int i = 0; i < 7; i++) text[i] = store_cell(q, i);
        ok = err_set(e, ERR_DATA,
                     "run %.12s, seed %s, repetition %s has digest %s in %s (build %s) and %s in "
                     "%s (build %s); one of them is wrong: run it again with --force",
                     text[0], text[1], text[2], text[3], s->path, text[5], text[4], from, text[6]);
    } else if (code != SQLITE_DONE) {
        ok = store_failed(s, e);
    }
    sqlite3_finalize(q);
    return ok;
}

/* Table merge_run: `old`, the number there, of each run that is taken over; `new`, its number here.
 * Counts what is taken and what stays. */
static bool choose_runs(struct store *s, struct store_merged *done, struct err *e)
{
    return store_exec(
               s,
               "CREATE TEMP TABLE merge_run (old INTEGER PRIMARY KEY, here INTEGER, new INTEGER);"
               "INSERT INTO merge_run (old, here) SELECT o.id, h.id FROM other.run o"
               " LEFT JOIN main.run h USING (config_hash, seed, rep)"
               " WHERE h.id IS NULL OR (h.status <> 'ok' AND o.status = 'ok')",
               e) &&
           store_number(s, "SELECT count(*) FROM merge_run WHERE here IS NULL", &done->added, e) &&
           store_number(s, "SELECT count(*) FROM merge_run WHERE here IS NOT NULL", &done->replaced,
                        e) &&
           store_number(
               s, "SELECT (SELECT count(*) FROM other.run) - (SELECT count(*) FROM merge_run)",
               &done->present, e);
}

/* ---- rows ---- */

/* How a column of a table is taken over. */
static const char *translation(const char *column)
{
    if (strcmp(column, "run_id") == 0) return "m.new";
    if (strcmp(column, "build_id") == 0)
        return "(SELECT h.id FROM main.build h JOIN other.build o USING (version, git, compiler, "
               "flags) WHERE o.id = t.build_id)";
    if (strcmp(column, "setting_id") == 0)
        return "(SELECT h.id FROM main.setting h JOIN other.setting o USING (key, value) WHERE "
               "o.id = t.setting_id)";
    return NULL;
}

/* The columns of a table, but for the number of the row, and what each gets. */
static bool list_columns(struct store *s, const char *table, struct text *to, struct text *from,
                         struct err *e)
{
    sqlite3_stmt *q = NULL;
    bool ok = sqlite3_prepare_v2(
                  s->db, "SELECT name FROM pragma_table_info(?1, 'main') WHERE name <> 'id'", -1,
                  &q, NULL) == SQLITE_OK;
    if (ok) store_bound(sqlite3_bind_text(q, 1, table, -1, SQLITE_STATIC));
    while (ok && sqlite3_step(q) == SQLITE_ROW) {
        const char *name = store_cell(q, 0),
                   *comma = to->length > 0 ? ", " : "", *translated = translation(name);
        text_add(to, "%s\"%s\"", comma, name);
        if (translated != NULL) text_add(from, "%s%s", comma, translated);
        else text_add(from, "%st.\"%s\"", comma, name);
    }
    return (sqlite3_finalize(q) == SQLITE_OK && ok) || store_failed(s, e);
}

/* INSERT the rows of other.`table` as t that `which` (the rest of the query, "" for all)
 * chooses. */
static bool take_rows(struct store *s, const char *insert, const char *table, const char *which,
                      struct err *e)
{
    struct text to = {0}, from = {0}, sql = {0};
    bool ok = list_columns(s, table, &to, &from, e);
    text_add(&sql, "%s INTO main.\"%s\" (%s) SELECT %s FROM other.\"%s\" t %s", insert, table, to.s,
             from.s, table, which);
    ok = ok && store_exec(s, sql.s, e);
    text_free(&to);
    text_free(&from);
    text_free(&sql);
    return ok;
}

/* The runs themselves. Those that they replace go first, with all that belongs to them. */
static bool take_runs(struct store *s, struct err *e)
{
    /* Builds and settings first: runs refer to them. OR IGNORE, as most of them are there
     * already. */
    return take_rows(s, "INSERT OR IGNORE", "build", "", e) &&
           take_rows(s, "INSERT OR IGNORE", "setting",
                     "WHERE t.id IN (SELECT setting_id FROM other.run_setting JOIN merge_run ON "
                     "run_id = old)",
                     e) &&
           store_exec(s, "DELETE FROM main.run WHERE id IN (SELECT here FROM merge_run)", e) &&
           take_rows(s, "INSERT", "run", "JOIN merge_run m ON m.old = t.id ORDER BY t.id", e) &&
           store_exec(s,
                      "UPDATE merge_run SET new = (SELECT h.id FROM other.run o JOIN main.run h"
                      " USING (config_hash, seed, rep) WHERE o.id = old)",
                      e);
}

/* Every table whose rows belong to a run, where the other database has it. */
static bool take_parts(struct store *s, struct err *e)
{
    sqlite3_stmt *q = NULL;
    bool ok =
        sqlite3_prepare_v2(
            s->db,
            "SELECT DISTINCT m.name FROM main.sqlite_schema m, pragma_foreign_key_list(m.name) f"
            " JOIN other.sqlite_schema o ON o.name = m.name"
            " WHERE m.type = 'table' AND f.\"table\" = 'run' AND f.\"from\" = 'run_id'",
            -1, &q, NULL) == SQLITE_OK;
    if (!ok) store_failed(s, e);
    bool row = true;
    while (ok && (ok = store_next(s, q, &row, e)) && row) {
        const char *table = store_cell(q, 0);
        if (!is_required(table) && !is_optional(table)) continue;
        ok = take_rows(s, "INSERT", table, "JOIN merge_run m ON m.old = t.run_id", e);
    }
    sqlite3_finalize(q);
    return ok;
}

/* What is there stays: a study has no digest that could decide between two. */
static bool take_studies(struct store *s, struct store_merged *done, struct err *e)
{
    bool ok = true;
    for (size_t i = 0; ok && i < sizeof study_table / sizeof study_table[0]; i++) {
        /* tables that came later may be missing there */
        if (sqlite3_table_column_metadata(s->db, "other", study_table[i], NULL, NULL, NULL, NULL,
                                          NULL, NULL) != SQLITE_OK)
            continue;
        ok = take_rows(s, "INSERT OR IGNORE", study_table[i], "", e);
        done->studies += sqlite3_changes(s->db);
    }
    return ok;
}

/* ---- all of it ---- */

bool store_merge(struct store *s, const char *from, struct store_merged *done, struct err *e)
{
    memset(done, 0, sizeof *done);
    if (!look_at(s, from, e) || !attach(s, from, e)) return false;
    /* Checks first, then runs, then what refers to them; the last statement commits. */
    bool ok = store_exec(s, "BEGIN IMMEDIATE", e) && guard_schema(s, "other", from, e) &&
              check_tables(s, from, e) && check_digests(s, from, e) && choose_runs(s, done, e) &&
              take_runs(s, e) && take_parts(s, e) && take_studies(s, done, e) &&
              store_exec(s, "DROP TABLE merge_run; COMMIT", e);
    if (!ok && !sqlite3_get_autocommit(s->db)) sqlite3_exec(s->db, "ROLLBACK", NULL, NULL, NULL);
    sqlite3_exec(s->db, "DETACH other", NULL, NULL, NULL);
    s->build_id = 0; /* its row may have been forgotten with the rest */
    return ok;
}
