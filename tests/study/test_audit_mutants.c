/* test_audit_mutants.c - the audit of databases checked: changed rows are found, and the share of
 * them is printed. */
#include "config.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../plan/scratch.h"
#include "base/random.h"
#include "base/text.h"
#include "run/run.h"
#include "study/audit.h"

#ifdef SANITIZERS /* slow, and the rules are the same */
enum { COLUMNS_APART = 4 };
#else
enum { COLUMNS_APART = 1 };
#endif
enum { MOST_COLUMNS = 80 };

/* --- a small database ------------------------------------------------------------------------- */

static const char scenario[] =
    "schema_version: 1\nquestion: \"?\"\nmachine: t3e-300\nkernel: {name: dynamics}\nmodel: {n: "
    "4}\nranks: n\n"
    "sweep:\n  level: [link, loggp]\nrecord: {links: true, spans: true}\n";
static const char noisy[] =
    "schema_version: 1\nquestion: \"?\"\nmachine: t3e-300-mpich\nkernel: {name: "
    "dynamics}\nmodel: {n: 4, stiffness: 3 N m/rad}\n"
    "ranks: 2\nmachine.noise.compute: 5 %\nrecord: {links: true}\n";
static const char blocked[] =
    "schema_version: 1\nquestion: \"?\"\nmachine: t3e-300\nkernel: {name: shift, message: "
    "4096 B, distance: 2}\nranks: 4\n"
    "level: flit\nmachine.topology.dims: [4]\nmachine.network.virtual_channels: 1\n"
    "machine.network.buffer: 4\nmachine.network.packet: 0 B\n"
    "machine.software.eager.limit: unlimited\n";

static bool put(void *context, const struct run_spec *spec, const struct run_result *r)
{
    struct err e;
    err_clear(&e);
    if (!store_put(context, spec, NULL, r, &e)) fail_msg("%s", e.text);
    return true;
}

static void add_runs(struct store *s, struct scratch *dir, const char *name, const char *text)
{
    struct plan p = scratch_plan(scratch_write(dir, name, text), NULL, 0);
    struct err e;
    err_clear(&e);
    assert_true(run_campaign(p.run, NULL, p.nrun, NULL, 1, true, put, s, &e));
    plan_free(&p);
}

static void change(struct store *s, const char *sql)
{
    struct err e;
    err_clear(&e);
    if (!store_select(s, sql, 0, NULL, NULL, NULL, &e)) fail_msg("%s: %s", sql, e.text);
}

/* Views rank_stage and link_load show entries of a text: what is written to a view is written
 * there, for this connection. */
static const char *const writable_view[] = {
    "CREATE TEMP TRIGGER rank_delete INSTEAD OF DELETE ON main.rank_stage BEGIN UPDATE rank_times "
    "SET entries = (SELECT json_group_array(json(value)) FROM json_each(entries) WHERE "
    "json_extract(value, '$[0]') IS NOT OLD.rank OR json_extract(value, '$[1]') IS NOT OLD.stage) "
    "WHERE run_id = OLD.run_id; END",
    "CREATE TEMP TRIGGER rank_update INSTEAD OF UPDATE ON main.rank_stage BEGIN UPDATE rank_times "
    "SET entries = (SELECT json_group_array(json(value)) FROM json_each(entries) WHERE "
    "json_extract(value, '$[0]') IS NOT OLD.rank OR json_extract(value, '$[1]') IS NOT OLD.stage) "
    "WHERE run_id = OLD.run_id; UPDATE rank_times SET entries = json_insert(entries, '$[#]', "
    "json_array(NEW.rank, NEW.stage, NEW.compute_ps, NEW.send_ps, NEW.recv_ps, NEW.wait_ps, "
    "NEW.contention_ps, NEW.messages, NEW.sent_bytes, NEW.flops)) WHERE run_id = NEW.run_id; END",
    "CREATE TEMP TRIGGER link_delete INSTEAD OF DELETE ON main.link_load BEGIN UPDATE link_loads "
    "SET entries = (SELECT json_group_array(json(value)) FROM json_each(entries) WHERE "
    "json_extract(value, '$[0]') IS NOT OLD.link) WHERE run_id = OLD.run_id; END",
    "CREATE TEMP TRIGGER link_update INSTEAD OF UPDATE ON main.link_load BEGIN UPDATE link_loads "
    "SET entries = (SELECT json_group_array(json(value)) FROM json_each(entries) WHERE "
    "json_extract(value, '$[0]') IS NOT OLD.link) WHERE run_id = OLD.run_id; UPDATE link_loads SET "
    "entries = json_insert(entries, '$[#]', json_array(NEW.link, NEW.from_router, NEW.to_router, "
    "NEW.node, NEW.messages, NEW.sent_bytes, NEW.busy_ps, NEW.queue_ps)) WHERE run_id = "
    "NEW.run_id; END"};
enum { WRITABLE_VIEWS = sizeof writable_view / sizeof *writable_view };

static struct store *make_database(struct scratch *dir)
{
    char path[128];
    struct err e;
    err_clear(&e);
    scratch_open(dir);
    snprintf(path, sizeof path, "%s/small.db", dir->dir);
    struct store *s = store_open(path, STORE_WRITE, &e);
    assert_non_null(s);
    add_runs(s, dir, "small.yaml", scenario);
    add_runs(s, dir, "noisy.yaml", noisy);
    add_runs(s, dir, "blocked.yaml", blocked);
    for (int i = 0; i < WRITABLE_VIEWS; i++) change(s, writable_view[i]);
    change(s, "INSERT INTO check_point (suite, subject, quantity, at, unit, reference, value, "
              "relative_error, tolerance, class, verdict, source, cause) VALUES ('s', 'm', "
              "'one-way', '8', 'us', 10, 10.5, 0.05, 0.1, 'P', 'pass', 'x', ''), ('s', 'm', "
              "'r-inf', '', 'MB/s', 100, 60, -0.4, 0.1, 'P', 'explained', 'x', 'known')");
    return s;
}

/* --- one mutant ------------------------------------------------------------------------------- */

enum kind { DIGIT, SIGN, EXCHANGE, EMPTY, DELETED, KINDS };
static const char *const kind_name[KINDS] = {"digit", "sign", "exchange", "NULL", "deleted"};

/* Tables, what tells their rows apart, and columns of which another value changes no answer of the
 * row's run: what the host and the clock give, and numbers of rows. */
static const struct table {
    const char *name, *key, *free;
} tables[] = {
    {"run", "id",
     " id build_id created_utc host_s host_total_s host_peak_bytes stack_peak_bytes label "},
    {"run_setting", "run_id, setting_id", " "},
    {"setting", "id", " id "},
    {"stage", "run_id, stage", " "},
    {"rank_stage", "run_id, rank, stage", " "},
    {"baseline", "run_id, ordinal", " "},
    {"error_check", "run_id, ordinal", " "},
    {"run_omission", "run_id, what", " "},
    {"link_load", "run_id, link", " "},
    {"span", "run_id, span", " "},
    {"check_point", "id",
     " id suite subject quantity at unit class source cause verdict tolerance "},
};
enum { TABLES = sizeof tables / sizeof *tables };

struct values {
    int n;
    char name[MOST_COLUMNS][40];
    enum store_kind kind[MOST_COLUMNS];
    char text[MOST_COLUMNS][8192];
};

static bool take(void *context, int ncolumn, const char *const *name, const struct store_value *v)
{
    struct values *x = context;
    assert_true(ncolumn <= MOST_COLUMNS);
    x->n = ncolumn;
    for (int i = 0; i < ncolumn; i++) {
        text_copy(x->name[i], sizeof x->name[i], name[i]);
        x->kind[i] = v[i].kind;
        if (v[i].kind == STORE_INT)
            snprintf(x->text[i], sizeof x->text[i], "%lld", (long long)v[i].integer);
        else if (v[i].kind == STORE_REAL)
            snprintf(x->text[i], sizeof x->text[i], "%.17g", v[i].real);
        else text_copy(x->text[i], sizeof x->text[i], v[i].kind == STORE_TEXT ? v[i].text : "");
    }
    return true;
}

static void row(struct store *s, const struct table *t, int64_t at, struct values *x)
{
    struct text sql = {0};
    struct err e;
    err_clear(&e);
    text_add(&sql, "SELECT * FROM %s ORDER BY %s LIMIT 1 OFFSET %lld", t->name, t->key,
             (long long)at);
    if (!store_query(s, sql.s, 0, NULL, NULL, take, x, &e)) fail_msg("%s", e.text);
    text_free(&sql);
}

static int64_t count(struct store *s, const char *table)
{
    static struct values x;
    struct text sql = {0};
    struct err e;
    err_clear(&e);
    text_add(&sql, "SELECT count(*) FROM %s", table);
    assert_true(store_query(s, sql.s, 0, NULL, NULL, take, &x, &e));
    text_free(&sql);
    return strtoll(x.text[0], NULL, 10);
}

/* One digit becomes another one, one letter of a text the next. */
static void change_digit(char *text, enum store_kind kind, struct random *r)
{
    int place[8192], n = 0;
    for (int i = 0; text[i] && n < 8192; i++) {
        bool digit = text[i] >= '0' && text[i] <= '9';
        if (kind == STORE_REAL && text[i] == 'e') break;
        if (digit || (kind == STORE_TEXT && text[i] > ' ' && text[i] < '~')) place[n++] = i;
        if (kind == STORE_REAL && n == 12)
            break; /* further digits are within the rounding of a comparison */
    }
    if (n == 0) {
        if (kind == STORE_TEXT) text_copy(text, 8192, "x");
        return;
    }
    char *c = &text[place[random_below(r, (uint64_t)n)]];
    if (*c >= '0' && *c <= '9') *c = (char)('0' + (*c - '0' + 1 + (int)random_below(r, 9)) % 10);
    else *c = *c == 'z' ? 'y' : (char)(*c + 1);
}

static void add_literal(struct text *sql, enum store_kind kind, const char *text)
{
    if (kind == STORE_NULL) text_add(sql, "NULL");
    if (kind == STORE_INT || kind == STORE_REAL) text_add(sql, "%s", text);
    if (kind != STORE_TEXT) return;
    text_add(sql, "'");
    for (; *text; text++) text_add(sql, *text == '\'' ? "''" : "%c", *text);
    text_add(sql, "'");
}

/* " WHERE (keys) = (SELECT keys FROM table ... row `at`)" */
static void add_where(struct text *sql, const struct table *t, int64_t at)
{
    text_add(sql, " WHERE (%s) IN (SELECT %s FROM %s ORDER BY %s LIMIT 1 OFFSET %lld)", t->key,
             t->key, t->name, t->key, (long long)at);
}

/* The statement of a mutant, false when there is nothing to change. */
static bool mutate(struct store *s, const struct table *t, int column, enum kind kind,
                   struct random *r, struct text *sql)
{
    static struct values x, y;
    int64_t n = count(s, t->name), at = (int64_t)random_below(r, (uint64_t)n);
    row(s, t, at, &x);
    enum store_kind as = x.kind[column];
    if (kind == DELETED) {
        text_add(sql, "DELETE FROM %s", t->name);
        add_where(sql, t, at);
        return true;
    }
    char *value = x.text[column], old[8192];
    text_copy(old, sizeof old, value);
    if (kind == DIGIT && as != STORE_NULL) change_digit(value, as, r);
    if (kind == SIGN && (as == STORE_INT || as == STORE_REAL) && strtod(value, NULL) != 0) {
        value[0] = '-';
        text_copy(*old == '-' ? value : value + 1, 8000, *old == '-' ? old + 1 : old);
    }
    if (kind == EMPTY && as != STORE_NULL) as = STORE_NULL;
    if (kind == EXCHANGE) {
        row(s, t, (int64_t)random_below(r, (uint64_t)n), &y);
        as = y.kind[column];
        text_copy(value, 8192, y.text[column]);
    }
    if (as == x.kind[column] && strcmp(value, old) == 0) return false;
    text_add(sql, "UPDATE %s SET %s = ", t->name, x.name[column]);
    add_literal(sql, as, value);
    add_where(sql, t, at);
    return true;
}

/* --- verdicts --------------------------------------------------------------------------------- */

static int64_t findings(struct store *s, int again)
{
    struct arena *a = arena_create();
    struct audit_report *r = TAKE(a, 1, struct audit_report);
    const struct audit_options o = {.again = again, .seed = 1, .jobs = 1, .quiet = true};
    struct err e;
    err_clear(&e);
    int64_t n =
        audit_database(s, &o, a, r, &e) ? r->nfinding : 1; /* what cannot be read is not accepted */
    arena_destroy(a);
    return n;
}

static void no_contradictions_in_what_runs_store(void **state)
{
    struct store *s = *state;
    struct arena *a = arena_create();
    struct audit_report *r = TAKE(a, 1, struct audit_report);
    const struct audit_options o = {.again = AUDIT_ALL, .jobs = 1, .quiet = true};
    struct err e;
    err_clear(&e);
    assert_true(audit_database(s, &o, a, r, &e));
    for (int i = 0; i < r->nfinding && i < 20; i++)
        fprintf(stderr, "%s: %s\n", r->finding[i].rule, r->finding[i].text);
    assert_int_equal(r->nfinding, 0);
    assert_int_equal(r->nrun, 4);
    assert_int_equal(r->nagain, 4);
    arena_destroy(a);
}

struct tally {
    int made, by_rules, by_all, free, refused;
};

/* One mutant in a transaction that is forgotten: what the audit says of it. */
static void judge(struct store *s, const char *sql, bool matters, struct tally *t)
{
    struct err e;
    err_clear(&e);
    assert_true(store_begin(s, &e));
    if (!store_select(s, sql, 0, NULL, NULL, NULL, &e)) {
        t->refused++; /* the schema forbids it */
    } else if (findings(s, 0)) {
        t->made++, t->by_rules++, t->by_all++;
    } else if (!matters) {
        t->free++;
    } else {
        const bool found = findings(s, AUDIT_ALL) > 0;
        t->made++;
        t->by_all += found;
        if (!found) fprintf(stderr, "accepted: %.300s\n", sql);
    }
    store_rollback(s);
}

static void add(struct tally *sum, const struct tally *t)
{
    sum->made += t->made, sum->by_rules += t->by_rules, sum->by_all += t->by_all;
    sum->free += t->free, sum->refused += t->refused;
}

static void print(const char *name, const struct tally *t)
{
    print_message("%-14s %5d mutants: found by rules %5.1f %%, with the runs made again %5.1f %%; "
                  "%d of no effect on an answer, %d refused by the schema\n",
                  name, t->made, t->made ? 100.0 * t->by_rules / t->made : 100,
                  t->made ? 100.0 * t->by_all / t->made : 100, t->free, t->refused);
}

static void all_mutants_that_matter_are_found(void **state)
{
    struct store *s = *state;
    struct tally all = {0}, of_kind[KINDS] = {0};
    struct random r = random_make(2718, 0, 0);
    static struct values x;
    for (int k = 0; k < TABLES; k++) {
        const struct table *t = &tables[k];
        struct tally of_table = {0};
        row(s, t, 0, &x);
        for (int c = 0; c < x.n; c += COLUMNS_APART)
            for (int kind = 0; kind < KINDS && (kind != DELETED || c == 0); kind++) {
                struct text sql = {0}, word = {0};
                struct tally one = {0};
                static struct values names;
                /* Nobody misses a run that may never have been made, nor a point that nobody
                 * asked for. */
                const bool whole = strcmp(t->key, "id") == 0;
                row(s, t, 0, &names);
                text_add(&word, " %s ", names.name[c]);
                const bool matters = kind == DELETED ? !whole : !strstr(t->free, word.s);
                if (mutate(s, t, c, (enum kind)kind, &r, &sql)) judge(s, sql.s, matters, &one);
                add(&of_table, &one);
                add(&of_kind[kind], &one);
                text_free(&sql);
                text_free(&word);
            }
        print(t->name, &of_table);
        add(&all, &of_table);
    }
    for (int kind = 0; kind < KINDS; kind++) print(kind_name[kind], &of_kind[kind]);
    print("all", &all);
    assert_true(all.made > 250 / COLUMNS_APART);
    assert_int_equal(all.by_all, all.made);
}

static void changed_views_and_limits_are_found(void **state)
{
    struct store *s = *state;
    static const char *const sql[] = {"DROP VIEW v_speedup",
                                      "UPDATE meta SET value = 1 WHERE key = 'rank_rows_limit'",
                                      "DELETE FROM meta WHERE key = 'link_rows_limit'"};
    for (int i = 0; i < 3; i++) {
        struct tally t = {0};
        judge(s, sql[i], true, &t);
        assert_int_equal(t.by_rules, 1);
    }
}

static struct scratch folder;

static int set_up(void **state)
{
    *state = make_database(&folder);
    return 0;
}

static int tear_down(void **state)
{
    store_close(*state);
    scratch_close(&folder);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_contradictions_in_what_runs_store),
        cmocka_unit_test(all_mutants_that_matter_are_found),
        cmocka_unit_test(changed_views_and_limits_are_found),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
