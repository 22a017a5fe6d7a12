/* swept.c - see swept.h.
 *
 * Settings are rows (view v_setting), since there are hundreds; who draws or fits needs those few
 * that were varied as columns beside the results. SQL cannot make columns of rows, so the view is
 * written anew when other settings vary than before. */
#include "store/swept.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "spec/field.h"
#include "spec/run_label.h"
#include "store/connection.h"

enum { MOST_KEYS = 64, NAME = 96 };

/* Settings with more than one value, and what their columns are called. */
struct swept {
    int n;
    char key[MOST_KEYS][NAME], name[MOST_KEYS][NAME];
};

/* Columns that the view has anyway; a setting that is one of them needs no other. */
static const char *const fixed[] = {"run_id",     "name", "scenario", "machine", "kernel",
                                    "makespan_s", "n",    "P",        "level",   "seed"};

/* SQL knows no capitals. */
static bool is_fixed(const char *name)
{
    for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++)
        if (strcasecmp(fixed[i], name) == 0) return true;
    return false;
}

/* Letters, digits and '_' alone: nothing of a key can end the quotes around it. */
static void plain_name(const char *key, char *name)
{
    size_t k = 0;
    for (; k < NAME - 1 && key[k] != '\0'; k++)
        name[k] = isalnum((unsigned char)key[k]) ? key[k] : '_';
    name[k] = '\0';
}

/* The end of the key that people use; settings of programs have only their own name. */
static const char *short_key(const char *key)
{
    const struct field_table *t = NULL;
    if (field_find_full(key, &t) == NULL || t == NULL) return key;
    const size_t prefix = strlen(t->prefix);
    return field_short_key(t, prefix > 0 ? key + prefix + 1 : key);
}

static bool is_taken(const struct swept *w, const char *column)
{
    for (int i = 0; i < w->n; i++)
        if (strcasecmp(w->name[i], column) == 0) return true;
    return false;
}

/* Keys that only a sign or capitals tell apart, as x.y and x-y do, have one plain name: SQL would
 * call the second "x_y:1", or lose it, so those that come later are counted. */
static void own_name(const struct swept *w, const char *key, char *column)
{
    enum { NUMBER = 13 }; /* '_' and any int */
    plain_name(short_key(key), column);
    if (!is_taken(w, column)) return;
    plain_name(key, column);
    const size_t length = strlen(column), at = length < NAME - NUMBER ? length : NAME - NUMBER;
    for (int i = 2; is_taken(w, column); i++) snprintf(column + at, NUMBER, "_%d", i);
}

/* One column more, unless there is one. */
static bool take_key(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    struct swept *w = context;
    (void)ncolumn, (void)name;
    const char *key = value[0];
    /* Keys of our own have no other signs: what a stranger wrote there is no column. */
    if (key == NULL || strlen(key) >= NAME || strpbrk(key, "'\"\\") != NULL) return true;
    char *column = w->name[w->n];
    own_name(w, key, column);
    /* model.n and ranks stand there as n and P. */
    if (is_fixed(column) || strcmp(key, "ranks") == 0 || strcmp(key, "scenario") == 0) return true;
    snprintf(w->key[w->n++], NAME, "%s", key);
    return w->n < MOST_KEYS;
}

/* As sqlite_schema keeps it, so that an unchanged view is recognised by its text. */
static void view_text(const struct swept *w, struct text *sql)
{
    text_add(sql, "CREATE VIEW v_swept AS /* made by mimdsim */ SELECT r.id AS run_id, l.name, "
                  "r.scenario, r.machine, r.kernel, r.level, r.n, r.P, r.seed, r.makespan_ps * "
                  "1e-12 AS makespan_s");
    for (int i = 0; i < w->n; i++)
        text_add(sql,
                 ", (SELECT coalesce(s.number, s.value) FROM v_setting s WHERE s.run_id = r.id AND "
                 "s.key = '%s') AS \"%s\"",
                 w->key[i], w->name[i]);
    text_add(sql, " FROM run r JOIN v_label l ON l.run_id = r.id WHERE r.status = 'ok'");
}

/* The one value there is. */
static bool take_text(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)ncolumn, (void)name;
    text_add(context, "%s", value[0] != NULL ? value[0] : "");
    return false;
}

bool store_swept_view(struct store *s, struct err *e)
{
    static const char there[] = "SELECT sql FROM sqlite_schema WHERE name = 'v_swept'";
    /* Each value of a setting is stored once, so this reads a small table however many runs. */
    static const char keys[] = "SELECT key FROM setting WHERE key <> 'label' GROUP BY key HAVING "
                               "count(*) > 1 ORDER BY key";
    /* A database of one run, as it is being made, sweeps nothing. */
    if (s->unpublished) return true;
    struct swept w = {0};
    struct text before = {0}, now = {0};
    bool ok = store_select(s, there, 0, NULL, take_text, &before, e) &&
              store_select(s, keys, 0, NULL, take_key, &w, e);
    const bool foreign = before.length > 0 && strstr(before.s, "/* made by mimdsim */") == NULL;
    if (ok && w.n > 0) view_text(&w, &now);
    /* Mostly nothing has changed, and nothing is written. */
    const bool same = before.length == now.length &&
                      (now.length == 0 || strcmp(before.s, now.s) == 0);
    if (ok && !foreign && !same) {
        store_show(s);
        ok = store_begin(s, e) &&
             (before.length == 0 || store_exec(s, "DROP VIEW v_swept", e)) &&
             (now.length == 0 || store_exec(s, now.s, e));
        if (ok) ok = store_commit(s, e);
        else store_rollback(s);
    }
    text_free(&before);
    text_free(&now);
    return ok;
}
