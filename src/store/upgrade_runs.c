/* upgrade_runs.c - stored configurations are read back into runs, which are identified as new ones
 * are.
 *
 * Before version 6 a run that asked for level 'auto-tolerance' was identified by the question;
 * since then by the level that it took, as any other run with that level. */
#include "store/upgrade_runs.h"

#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "spec/identity.h"
#include "spec/run_label.h"
#include "spec/setting_number.h"
#include "spec/spec_fields.h"
#include "store/binding.h"

/* What is prepared once for all runs. */
struct work {
    struct store *s;
    sqlite3_stmt *select, *update, *older, *forget, *setting, *link, *name;
    struct identity *identity;
    int version;
    int64_t *kept;
};

/* Prepared for all runs of the database: preparing six statements takes longer than running
 * them. */
static bool prepare(struct store *s, sqlite3_stmt **out, const char *sql, struct err *e)
{
    return sqlite3_prepare_v2(s->db, sql, -1, out, NULL) == SQLITE_OK || store_failed(s, e);
}

static bool open_work(struct work *w, struct err *e)
{
    return prepare(w->s, &w->select, "SELECT id, config_text, level, machine,"
                   " machine_changes FROM run ORDER BY id", e) &&
           prepare(w->s, &w->name, "UPDATE run SET label = ?, machine_key = ? WHERE id = ?", e) &&
           prepare(w->s, &w->update, "UPDATE run SET config_hash = ?, config_text = ? WHERE id = ?",
                   e) &&
           prepare(w->s, &w->older, "INSERT INTO run_older VALUES (?, ?, ?)", e) &&
           prepare(w->s, &w->forget,
                   "DELETE FROM run_setting WHERE run_id = ?1"
                   " AND setting_id IN (SELECT id FROM setting WHERE key = ?2)",
                   e) &&
           prepare(w->s, &w->setting, "INSERT OR IGNORE INTO setting (key, value) VALUES (?1, ?2)",
                   e) &&
           prepare(
               w->s, &w->link,
               "INSERT INTO run_setting SELECT ?1, id FROM setting WHERE key = ?2 AND value = ?3",
               e);
}

/* Also after a failure half way: finalizing NULL does nothing. */
static void close_work(struct work *w)
{
    sqlite3_stmt *const all[] = {w->select, w->update, w->older, w->forget, w->setting, w->link,
                                 w->name};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) sqlite3_finalize(all[i]);
    identity_destroy(w->identity);
}

/* A run that this program cannot describe keeps its row, and table run_older says why. */
static bool note_older(struct work *w, int64_t run, const char *why, struct err *e)
{
    struct binding b = {w->older, 1};
    bind_int(&b, run);
    bind_int(&b, w->version);
    bind_text(&b, why);
    ++*w->kept;
    return store_step(w->s, w->older, e);
}

/* The value of one setting of a stored run becomes `value`: the row of run_setting is replaced. */
static bool change_setting(struct work *w, int64_t run, const char *key, const char *value,
                           struct err *e)
{
    struct binding forget = {w->forget, 1}, setting = {w->setting, 1}, link = {w->link, 1};
    bind_int(&forget, run);
    bind_text(&forget, key);
    bind_text(&setting, key);
    bind_text(&setting, value);
    bind_int(&link, run);
    bind_text(&link, key);
    bind_text(&link, value);
    return store_step(w->s, w->forget, e) && store_step(w->s, w->setting, e) &&
           store_step(w->s, w->link, e);
}

/* A run that asked for a tolerance is a run at the level that it took: two settings change. */
static bool settle_level(struct work *w, int64_t run, struct run_spec *spec, const char *level,
                         struct err *e)
{
    static const char *const key[] = {"network.level", "network.tolerance"};
    struct arena *a = arena_create();
    bool ok = true;
    for (int i = 0; i < 2 && ok; i++) {
        const struct field *f = &machine_table.field[field_find(&machine_table, key[i])];
        const char *value = i == 0 ? level : f->fallback;
        char full[64], why[160];
        snprintf(full, sizeof full, "machine.%s", key[i]);
        ok = field_set(f, &spec->machine, value, a, why, (int)sizeof why) &&
             change_setting(w, run, full, value, e);
    }
    arena_destroy(a);
    return ok;
}

/* The identity of a run, in its row. When two runs are the same run now, the second keeps its
 * old identity and is noted as older. */
static bool update_run(struct work *w, int64_t run, const struct run_spec *spec, const char *text,
                       struct err *e)
{
    struct binding b = {w->update, 1};
    bind_text(&b, spec->config_hash);
    bind_text(&b, text);
    bind_int(&b, run);
    const int code = sqlite3_step(w->update);
    sqlite3_reset(w->update);
    if (code == SQLITE_DONE) return true;
    /* The unique key (config_hash, seed, rep). */
    if (code != SQLITE_CONSTRAINT) return store_failed(w->s, e);
    return note_older(w, run, "another stored run has the same settings", e);
}

/* Names of runs and of their machines are new in version 7: made as for a new run that nobody gave
 * a name. */
static bool name_run(struct work *w, int64_t run, const char *text, struct err *e)
{
    struct binding b = {w->name, 1};
    struct text label = {0};
    char key[LABEL_KEY_LENGTH + 1];
    run_label_changed(store_cell(w->select, 3),
                      store_cell(w->select, 4), &label);
    machine_fingerprint(text, key);
    bind_text(&b, label.s);
    bind_text(&b, key);
    bind_int(&b, run);
    const bool ok = store_step(w->s, w->name, e);
    text_free(&label);
    return ok;
}

/* Numbers of settings are new in version 7, too. */
static bool number_settings(struct store *s, struct err *e)
{
    sqlite3_stmt *all = NULL, *set = NULL;
    bool ok = prepare(s, &all, "SELECT id, key, value FROM setting", e) &&
              prepare(s, &set, "UPDATE setting SET number = ?1, unit = ?2 WHERE id = ?3", e);
    bool row = true;
    while (ok && (ok = store_next(s, all, &row, e)) && row) {
        double number;
        enum unit unit;
        const bool is = setting_number(store_cell(all, 1),
                                       store_cell(all, 2), &number, &unit);
        if (is) store_bound(sqlite3_bind_double(set, 1, number));
        else store_bound(sqlite3_bind_null(set, 1));
        store_bound(sqlite3_bind_text(set, 2, units_si(unit), -1, SQLITE_STATIC));
        store_bound(sqlite3_bind_int64(set, 3, sqlite3_column_int64(all, 0)));
        ok = store_step(s, set, e);
    }
    sqlite3_finalize(all);
    sqlite3_finalize(set);
    return ok;
}

/* One run: its text is read as settings, which are then identified as those of a new run. */
static bool upgrade_run(struct work *w, struct arena *a, struct err *e)
{
    const int64_t run = sqlite3_column_int64(w->select, 0);
    const char *text = store_cell(w->select, 1);
    const char *level = store_cell(w->select, 2);
    struct run_spec spec;
    char why[320];
    if (w->version < 7 && !name_run(w, run, text, e)) return false;
    if (!run_from_text(&spec, text, a, why, (int)sizeof why)) return note_older(w, run, why, e);
    const bool asked =
        spec.machine.network.level == LEVEL_AUTO_TOLERANCE && strcmp(level, "auto-tolerance") != 0;
    if (asked && !settle_level(w, run, &spec, level, e)) return false;
    identity_forget(w->identity); /* the arena is used anew for every run */
    identity_set(w->identity, &spec, a);
    /* What was stored stays as it is, but for the level: an older program may have known fewer
     * settings. */
    return update_run(w, run, &spec, asked ? spec.config_text : text, e);
}

/* Runs in the order of their ids: of two equal ones the older keeps the identity. */
bool upgrade_runs(struct store *s, int version, int64_t *kept, struct err *e)
{
    struct work w = {.s = s, .identity = identity_of_runs(), .version = version, .kept = kept};
    bool ok = open_work(&w, e);
    bool row = true;
    while (ok && (ok = store_next(s, w.select, &row, e)) && row) {
        struct arena *a = arena_create();
        ok = upgrade_run(&w, a, e);
        arena_destroy(a);
    }
    close_work(&w);
    if (ok && version < 7) ok = number_settings(s, e);
    /* Whether a machine was the shipped one was not stored before version 5. */
    if (ok && version < 5) ok = store_exec(s, "UPDATE run SET machine_hash = 'not stored'", e);
    return ok;
}
