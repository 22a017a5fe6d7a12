/* audit_again.c - stored runs made again, and all their rows compared bit by bit (audit.h). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/random.h"
#include "base/text.h"
#include "run/run.h"
#include "study/audit_rules.h"

/* Columns that a run made again need not have: they are not compared. */
static const char *const other_column[] = {
    /* the order of runs, the program and the moment */
    "id", "run_id", "build_id", "created_utc",
    /* this computer */
    "host_s", "host_total_s", "host_peak_bytes", "stack_peak_bytes",
    /* what people call it, which is no part of the configuration that it is made from */
    "scenario", "label",
    /* checked with the configuration (audit_config.c) */
    "machine_hash"};

/* The tables that hold rows of a run, with the column of its id and the order that makes two
 * reads comparable. */
static const struct {
    const char *name, *key, *order;
} table[] = {{"run", "id", "id"},
             {"stage", "run_id", "stage"},
             {"rank_stage", "run_id", "rank, stage"},
             {"baseline", "run_id", "ordinal"},
             {"error_check", "run_id", "ordinal"},
             {"run_omission", "run_id", "what"},
             {"link_load", "run_id", "link"},
             {"span", "run_id", "span"}};
enum { TABLES = sizeof table / sizeof *table };

/* --- which runs ------------------------------------------------------------------------------- */

/* The state of the comparison: runs of `store` that were chosen, and a scratch database in
 * memory for the runs made now. */
struct again {
    struct store *store, *scratch;
    struct audit_report *report;
    struct arena *arena;
    struct random random;
    int64_t seen, wanted;
    int n;
    int64_t *id;
    struct run_spec *spec; /* (n) runs as stored */
    struct run_order *order;
    const struct run_spec *now; /* what is made at present, and how */
    const struct run_order *how;
    struct err *err;
};

/* Reservoir sampling (Knuth, The Art of Computer Programming, vol. 2, section 3.4.2, algorithm
 * R): each run is as likely as any other, in one pass and without knowing how many there are. */
static bool choose(void *context, int ncolumn, const char *const *name, const struct store_value *v)
{
    (void)ncolumn, (void)name;
    struct again *g = context;
    int64_t at = g->seen++;
    if (at >= g->wanted) at = (int64_t)random_below(&g->random, (uint64_t)g->seen);
    if (at < g->wanted) g->id[at] = v[0].integer;
    return true;
}

/* The level that a tolerance chose: columns level_asked, level_error, level_error_at, level. Older
 * configurations have the question instead of the level. */
static void take_choice(struct run_spec *spec, struct level_choice *choice,
                        const struct store_value *v)
{
    /* level_asked ends in the tolerance, "... 2 %": the word before the last one. */
    const char *percent = strrchr(v[5].text, ' ');
    while (percent && percent > v[5].text && percent[-1] != ' ') percent--;
    *choice = (struct level_choice){.made = true,
                                    .tolerance = percent ? strtod(percent, NULL) / 100 : 0,
                                    .error = v[6].real};
    text_copy(choice->at, sizeof choice->at, v[7].kind == STORE_TEXT ? v[7].text : "");
    for (int i = 0; i <= LEVEL_AUTO; i++)
        if (strcmp(network_level_name((enum network_level)i), v[8].text) == 0)
            spec->machine.network.level = (enum network_level)i;
}

/* One chosen row as a run; columns as in read_specs. Failed runs have nothing to compare, and
 * models from files may have changed since. */
static bool take_spec(void *context, int ncolumn, const char *const *name,
                      const struct store_value *v)
{
    (void)ncolumn, (void)name;
    struct again *g = context;
    struct run_spec *spec = &g->spec[g->n];
    char why[256];
    const bool failed = strcmp(v[1].text, "failed") == 0;
    if (failed || !audit_spec(spec, v[0].text, g->arena, why, sizeof why) ||
        spec->model_file[0] != '\0' || spec->kernel.own) {
        g->report->nleft++; /* a text that cannot be read has been told */
        return true;
    }
    spec->rep = (int)v[2].integer;
    /* Stored under what the row says it is: other rules have held that against the
     * configuration. */
    text_copy(spec->config_hash, sizeof spec->config_hash, v[3].text);
    /* The row is compared as it was stored: with its text, changes and hash, not with those that
     * this program would write. */
    spec->config_text = arena_text(g->arena, v[0].text);
    spec->machine_changes = v[4].kind == STORE_TEXT ? arena_text(g->arena, v[4].text) : NULL;
    spec->machine_hash = spec->machine_changes ? "" : NULL;
    if (v[5].kind == STORE_TEXT) take_choice(spec, &g->order[g->n].level_choice, v);
    /* The ids of the runs kept move up; g->n <= g->seen, so none is overwritten before it is
     * read. */
    g->id[g->n++] = g->id[g->seen];
    return true;
}

static const char *number(char buffer[24], int64_t id)
{
    snprintf(buffer, 24, "%lld", (long long)id);
    return buffer;
}

/* The chosen rows as runs. */
static bool read_specs(struct again *g, int64_t chosen)
{
    char id[24];
    g->spec = TAKE(g->arena, chosen + 1, struct run_spec);
    g->order = TAKE(g->arena, chosen + 1, struct run_order);
    for (g->seen = 0; g->seen < chosen; g->seen++) {
        const char *const param[] = {number(id, g->id[g->seen])};
        if (!store_query(g->store,
                         "SELECT config_text, status, rep, config_hash, machine_changes, "
                         "level_asked, level_error,"
                         " level_error_at, level FROM run WHERE id = CAST(?1 AS INTEGER)",
                         1, param, NULL, take_spec, g, g->err))
            return false;
    }
    return true;
}

/* --- comparing -------------------------------------------------------------------------------- */

/* One run's rows of a table, a line each. */
struct lines {
    int64_t n;
    struct text text;
    struct text names; /* of the columns that are compared */
};

/* Names of columns, not their places: a newer schema may have more. */
static bool is_other_column(const char *name)
{
    for (size_t i = 0; i < sizeof other_column / sizeof *other_column; i++)
        if (strcmp(name, other_column[i]) == 0) return true;
    return false;
}

static void add_value(struct text *t, const struct store_value *v)
{
    switch (v->kind) {
    case STORE_NULL:
        text_add(t, "NULL");
        break;
    case STORE_INT:
        text_add(t, "%lld", (long long)v->integer);
        break;
    /* 17 digits tell every double from every other: equal texts are equal bits. */
    case STORE_REAL:
        text_add(t, "%.17g", v->real);
        break;
    case STORE_TEXT:
        text_add(t, "'%s'", v->text);
        break;
    }
}

/* The columns of the scratch database decide: what an older database lacks fails as a query. */
static bool take_names(void *context, int ncolumn, const char *const *name,
                       const struct store_value *v)
{
    (void)v;
    struct lines *l = context;
    for (int i = 0; i < ncolumn; i++)
        if (!is_other_column(name[i]))
            text_add(&l->names, "%s%s", l->names.length ? ", " : "", name[i]);
    return true;
}

static bool take_line(void *context, int ncolumn, const char *const *name,
                      const struct store_value *v)
{
    struct lines *l = context;
    l->n++;
    for (int i = 0; i < ncolumn; i++) {
        text_add(&l->text, "%s = ", name[i]);
        add_value(&l->text, &v[i]);
        text_add_bytes(&l->text, "\n", 1);
    }
    return true;
}

/* A query for names alone has no rows. */
static bool nothing(void *context, int ncolumn, const char *const *name,
                    const struct store_value *v)
{
    (void)context, (void)ncolumn, (void)name, (void)v;
    return true;
}

/* The first line of x that y has otherwise. */
static void tell_difference(struct audit_report *r, int64_t run, const char *name,
                            const struct lines *x, const struct lines *y)
{
    /* The first byte that differs, then back to the beginning of its line: "name = value". */
    const char *p = x->text.s ? x->text.s : "", *q = y->text.s ? y->text.s : "";
    if (x->n != y->n) {
        audit_find(r, run, "again", "table %s has %lld rows of it, made again %lld", name,
                   (long long)x->n, (long long)y->n);
        return;
    }
    while (*p && *p == *q) p++, q++;
    while (p > x->text.s && p[-1] != '\n') p--, q--;
    audit_find(r, run, "again", "table %s: %.*s; made again: %.*s", name, (int)strcspn(p, "\n"), p,
               (int)strcspn(q, "\n"), q);
}

/* The rows of run `id` of table t in `s`, columns as in `names`. */
static bool read_lines(struct store *s, int t, const char *names, int64_t id, struct lines *l,
                       struct err *e)
{
    struct text sql = {0};
    char n[24];
    const char *const param[] = {number(n, id)};
    text_add(&sql, "SELECT %s FROM %s WHERE %s = CAST(?1 AS INTEGER) ORDER BY %s", names,
             table[t].name, table[t].key, table[t].order);
    bool ok = store_query(s, sql.s, 1, param, NULL, take_line, l, e);
    text_free(&sql);
    return ok;
}

/* One table of one run. *same becomes false when rows differ; false is returned only when a
 * database cannot be read. */
static bool compare_table(struct again *g, int t, int64_t id, int64_t fresh, bool tell, bool *same)
{
    struct lines ours = {0}, theirs = {0};
    struct text sql = {0};
    /* No row, but the names of the columns. */
    text_add(&sql, "SELECT * FROM %s WHERE 0", table[t].name);
    bool ok = store_query(g->scratch, sql.s, 0, NULL, take_names, nothing, &ours, g->err) &&
              read_lines(g->store, t, ours.names.s, id, &ours, g->err) &&
              read_lines(g->scratch, t, ours.names.s, fresh, &theirs, g->err);
    bool equal = ok && ours.n == theirs.n &&
                 strcmp(ours.text.s ? ours.text.s : "", theirs.text.s ? theirs.text.s : "") == 0;
    if (ok && !equal && tell) tell_difference(g->report, id, table[t].name, &ours, &theirs);
    *same = *same && equal;
    text_free(&sql);
    text_free(&ours.text);
    text_free(&ours.names);
    text_free(&theirs.text);
    return ok;
}

/* Whether run i of the scratch database equals the stored one; where not, it is told if `tell`. */
static bool compare_run(struct again *g, int i, bool tell, bool *same)
{
    int64_t fresh = store_run_id(g->scratch, &g->spec[i]);
    *same = true;
    for (int t = 0; t < TABLES; t++)
        if (!compare_table(g, t, g->id[i], fresh, tell, same)) return false;
    return true;
}

/* --- all of it -------------------------------------------------------------------------------- */

/* run_campaign hands results over with the run they belong to: its place tells its order. */
static bool keep(void *context, const struct run_spec *spec, const struct run_result *result)
{
    struct again *g = context;
    return store_put(g->scratch, spec, &g->how[spec - g->now], result, g->err);
}

/* Runs made now; their rows replace older ones of theirs in the scratch database. */
static bool make(struct again *g, const struct run_spec *spec, const struct run_order *order, int n,
                 const struct audit_options *o)
{
    g->now = spec;
    g->how = order;
    return run_campaign(spec, order, n, NULL, n == 1 ? 1 : o->jobs, n == 1 || o->quiet, keep, g,
                        g->err);
}

/* Make all runs at once, in parallel. Of a run whose rows differ, the rows alone know whether it
 * was made with --keep-all: it is made again with everything kept, and only if that differs too,
 * once more as it was, to tell the difference. */
static bool make_again(struct again *g, const struct audit_options *o)
{
    if (g->n == 0) return true;
    if (!make(g, g->spec, g->order, g->n, o)) return false;
    for (int i = 0; i < g->n; i++) {
        bool same, kept = false;
        if (!compare_run(g, i, false, &same)) return false;
        if (same) continue;
        struct run_order all = g->order[i];
        all.keep = KEEP_ALL;
        if (!make(g, &g->spec[i], &all, 1, o) || !compare_run(g, i, false, &kept)) return false;
        if (kept) continue;
        if (!make(g, &g->spec[i], &g->order[i], 1, o) || !compare_run(g, i, true, &same))
            return false;
    }
    g->report->nagain = g->n;
    return true;
}

/* Memory: one scratch database with the rows of all chosen runs, released at the end. */
bool audit_again(struct store *s, const struct audit_options *o, struct audit_report *r,
                 struct err *e)
{
    struct again g = {.store = s,
                      .report = r,
                      .arena = arena_create(),
                      .random = random_make(o->seed, 0, 0),
                      .err = e};
    /* The reservoir is as large as the number of runs wanted. */
    g.wanted = o->again == AUDIT_ALL || o->again > r->nrun ? r->nrun : o->again;
    g.id = TAKE(g.arena, g.wanted + 1, int64_t);
    g.scratch = store_open("made again", STORE_SCRATCH, e);
    bool ok = g.scratch &&
              store_query(s, "SELECT id FROM run ORDER BY id", 0, NULL, NULL, choose, &g, e) &&
              read_specs(&g, g.wanted) && make_again(&g, o);
    store_close(g.scratch);
    arena_destroy(g.arena);
    return ok && e->kind == ERR_NONE;
}
