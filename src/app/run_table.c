/* run_table.c - see run_table.h.
 *
 * The table is a query, so that what `run` prints and what a user asks of the database are the
 * same numbers. Every predicted time stands beside how far it is known: the error of the network
 * level, of the machine's parameters, of the arithmetic (view v_known_error). */
#include "app/run_table.h"

#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "app/flag.h"
#include "base/arena.h"
#include "report/csv.h"
#include "report/report.h"

enum { MOST_SWEPT = 64, MOST_COLUMNS = 96 }; /* more columns nobody reads */

/* For whom a column is. */
enum { PEOPLE = 1, PROGRAMS = 2, BOTH = 3, ASKED = 4 /* people who ask for it */ };

struct shown {
    const char *name, *sql;
    unsigned whom;
};

/* As in view v_speedup, whose twenty columns, looked up for each of two numbers, would be a third
 * of what the query takes. A serial program that takes no time, as one whose cost its author
 * states, is no baseline. */
#define SPEEDUP(baseline)                                                                          \
    "(SELECT nullif(CAST(b.time_ps AS REAL) / nullif(r.makespan_ps, 0), 0) FROM baseline b WHERE " \
    "b.run_id = r.id AND r.status = 'ok' AND b.name = '" baseline "')"
/* An error that is not known is said to be; what has no predicted time has no error either. */
#define NOT_KNOWN(value, text)                                                                     \
    "CASE WHEN k.run_id IS NULL THEN NULL WHEN " value " IS NULL THEN 'not known' ELSE " text " E" \
    "ND"
/* Failed runs have no model; what the kernel's other runs have tells whether n means anything. */
#define HAS_N                                                                                      \
    "r.nu > 0 OR EXISTS (SELECT 1 FROM v_setting v WHERE v.run_id = r.id AND v.key = 'program.n')" \
    " OR (r.status = 'failed' AND EXISTS (SELECT 1 FROM run q WHERE q.kernel = r.kernel AND q.nu " \
    "> 0))"

/* The size of a message: of all runs where it is swept, else of micro-benchmarks. */
#define MESSAGE "(SELECT value FROM v_setting v WHERE v.run_id = r.id AND v.key = 'kernel.message')"

/* Which run it is. What depends on the plan is written where a plan is known (plan_sql). */
static const struct shown before[] = {
    {"machine", "r.label", BOTH},
    {"kernel", "r.kernel", BOTH},
    {"formulation", "iif(r.nu > 0, r.formulation, NULL)", BOTH},
    {"solver", "iif(r.nu > 0, r.solver, NULL)", BOTH},
    {"message", NULL, BOTH},
    {"level", "r.level", BOTH},
    {"n", NULL, BOTH},
    {"P", "r.P", BOTH},
};

/* What it came to. The time that a micro-benchmark measured is told of micro-benchmarks alone. */
static const struct shown behind[] = {
    {"makespan_us", "iif(r.status IN ('ok', 'invalid'), r.makespan_ps / 1e6, NULL)", BOTH},
    {"level_error", NOT_KNOWN("k.level_error", "printf('%.2g %%', 100 * k.level_error)"), PEOPLE},
    {"machine_error",
     NOT_KNOWN("k.machine_low",
               "printf('%+.0f..%+.0f %%', 100 * k.machine_low, 100 * k.machine_high)"),
     PEOPLE},
    {"arithmetic_error", NOT_KNOWN("k.arithmetic_error", "printf('%.1e', k.arithmetic_error)"),
     PEOPLE},
    {"level_error", "k.level_error", PROGRAMS},
    {"machine_low", "k.machine_low", PROGRAMS},
    {"machine_high", "k.machine_high", PROGRAMS},
    {"relative_error", "k.arithmetic_error", PROGRAMS | ASKED},
    {"speedup_vs_fastest_serial", SPEEDUP("fastest serial"), BOTH},
    {"speedup_vs_itself", SPEEDUP("parallel code on one processor"), BOTH},
    {"measured_us", "r.measured_s * 1e6", BOTH},
    {"digest", "r.digest", PROGRAMS | ASKED},
    {"status", "r.status", BOTH},
    {"reason", "iif(r.status = 'ok', NULL, r.text)", PROGRAMS | ASKED},
};
enum { BEFORE = sizeof before / sizeof *before, BEHIND = sizeof behind / sizeof *behind };

/* The rows of the plan, in its order: ?1 is a JSON array of [hash, seed, repetition]. */
static const char from_sql[] =
    " FROM run r LEFT JOIN v_known_error k ON k.run_id = r.id"
    " JOIN json_each(?1) j ON r.config_hash = j.value ->> 0 AND r.seed = j.value ->> 1"
    " AND r.rep = j.value ->> 2 ORDER BY j.key";

/* Swept keys that have a column in every table, under another name. */
static const char *const always[] = {
    "machine.name", "kernel.name", "kernel.formulation", "kernel.solver", "machine.network.level",
    "model.n",      "ranks",       "program.n",          "program.file",  "kernel.message",
    "label"};

/* The columns of one table. */
struct columns {
    struct arena *arena;
    int n;
    struct shown at[MOST_COLUMNS];
};

/* Beyond the most, columns of a scenario that sweeps dozens of keys are left out. */
static void add(struct columns *c, const char *name, const char *sql, unsigned whom)
{
    if (c->n < MOST_COLUMNS) c->at[c->n++] = (struct shown){name, sql, whom};
}

/* ---- swept keys */

static bool is_one_of(const char *word, const char *const *list, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (strcmp(list[i], word) == 0) return true;
    return false;
}

/* Whether a column that is always there has this name. */
static bool is_fixed(const char *name)
{
    for (int i = 0; i < BEFORE; i++)
        if (strcmp(before[i].name, name) == 0) return true;
    for (int i = 0; i < BEHIND; i++)
        if (strcmp(behind[i].name, name) == 0) return true;
    return strcmp(name, "rep") == 0;
}

/* Whether `key` ends with the whole words `name`. */
static bool ends_in(const char *key, const char *name)
{
    size_t n = strlen(key), m = strlen(name);
    return m <= n && strcmp(key + n - m, name) == 0 && (m == n || key[n - m - 1] == '.');
}

/* The shortest end of swept key number `at` that names no other column: "bandwidth" instead of
 * "machine.network.link.bandwidth", unless something else ends so. */
static const char *short_name(const struct plan *p, int at)
{
    const char *key = p->swept[at].key, *name = key + strlen(key);
    if (strcmp(key, "job.name") == 0) return "job";
    while (name > key) {
        do name--;
        /* One word more to the left each time. */
        while (name > key && name[-1] != '.');
        bool taken = is_fixed(name);
        for (int i = 0; i < p->nswept; i++)
            taken = taken || (i != at && ends_in(p->swept[i].key, name));
        if (!taken) break;
    }
    return name;
}

/* A swept setting as a column; numbers as numbers, so that they sort and align. */
static void add_swept(struct columns *c, const struct plan *p, int at)
{
    const char *key = p->swept[at].key;
    struct text sql = {0};
    /* No setting of the run: n and P are. */
    if (strcmp(key, "n_over_p") == 0) text_add(&sql, "r.n / r.P");
    else
        text_add(&sql, "(SELECT %s FROM v_setting v WHERE v.run_id = r.id AND v.key = '%s')",
                 p->swept[at].number ? "CAST(value AS NUMERIC)" : "value", key);
    add(c, short_name(p, at), arena_text(c->arena, sql.s), BOTH);
    text_free(&sql);
}

/* Columns of before[] that say something of some programs alone. Where all runs have a scene, each
 * has an n and none measures messages; to ask the rows would be a third of what the query takes. */
static const char *plan_sql(const struct plan *p, const char *name)
{
    bool swept = false, scenes = true;
    for (int i = 0; i < p->nswept; i++)
        swept = swept || strcmp(p->swept[i].key, "kernel.message") == 0;
    for (int i = 0; i < p->nrun; i++)
        scenes = scenes && kernel_spec_needs_model(&p->run[i].kernel);
    if (strcmp(name, "n") == 0) return scenes ? "r.n" : "iif(" HAS_N ", r.n, NULL)";
    return swept    ? MESSAGE
           : scenes ? "NULL"
                    : "iif(r.measured_s IS NOT NULL, " MESSAGE ", NULL)";
}

/* All columns there are for a plan: which run, what is swept, repetitions, results. */
static void list_columns(struct columns *c, const struct plan *p)
{
    bool repeated = false;
    for (int i = 0; i < p->nrun; i++) repeated = repeated || p->run[i].rep > 0;
    for (int i = 0; i < BEFORE; i++)
        add(c, before[i].name, before[i].sql != NULL ? before[i].sql : plan_sql(p, before[i].name),
            before[i].whom);
    for (int i = 0; i < p->nswept && i < MOST_SWEPT; i++)
        if (!is_one_of(p->swept[i].key, always, sizeof always / sizeof *always)) add_swept(c, p, i);
    if (repeated) add(c, "rep", "r.rep", BOTH);
    for (int i = 0; i < BEHIND; i++) add(c, behind[i].name, behind[i].sql, behind[i].whom);
}

/* ---- which of them */

/* "SQL AS name", with commas. */
static void add_to_query(struct text *sql, const struct shown *x)
{
    text_add(sql, "%s%s AS \"%s\"", sql->length > 0 ? ", " : "", x->sql, x->name);
}

/* One name of --columns: the column as people see it, else as programs do. */
static bool choose(const struct columns *c, const char *name, struct text *sql, struct err *e)
{
    const char *names[MOST_COLUMNS];
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < c->n; i++) {
            names[i] = c->at[i].name;
            if (strcmp(names[i], name) != 0 || (pass == 0 && !(c->at[i].whom & PEOPLE))) continue;
            add_to_query(sql, &c->at[i]);
            return true;
        }
    struct text all = {0};
    const char *near = text_nearest(name, names, c->n);
    for (int i = 0; i < c->n; i++)
        if (c->at[i].whom != PROGRAMS) text_add(&all, "%s%s", all.length ? ", " : "", names[i]);
    if (near != NULL)
        err_set(e, ERR_USAGE, "--columns: no column '%.60s'; did you mean '%s'?", name, near);
    else err_set(e, ERR_USAGE, "--columns: no column '%.60s'; expected some of %s", name, all.s);
    text_free(&all);
    return false;
}

/* The columns of --columns in the order given; all of them or the usual ones without it. */
static bool choose_columns(const struct columns *c, const struct run_table_look *l,
                           struct text *sql, struct err *e)
{
    const bool all = l->columns != NULL && strcmp(l->columns, "all") == 0;
    const unsigned whom = l->json || l->csv ? PROGRAMS : all ? PEOPLE | ASKED : PEOPLE;
    if (l->columns == NULL || all) {
        for (int i = 0; i < c->n; i++)
            if (c->at[i].whom & whom) add_to_query(sql, &c->at[i]);
        return true;
    }
    /* in the order in which they were asked for */
    char *rest = arena_text(c->arena, l->columns);
    for (char *word = strsep(&rest, ","); word != NULL; word = strsep(&rest, ","))
        if (!choose(c, word, sql, e)) return false;
    return true;
}

/* The width of the terminal; 0: none is looked at, or it is not known. */
static int terminal_width(FILE *out)
{
    struct winsize size;
    const char *columns = getenv("COLUMNS");
    /* a file or a pipe takes lines of any length */
    /* stdout may be a filter: escape.h */
    const int fd = out == stdout ? STDOUT_FILENO : fileno(out);
    if (!isatty(fd)) return 0;
    /* shells do not export it: who does means it */
    if (columns != NULL && atoi(columns) > 0) return atoi(columns);
    return ioctl(fd, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

/* Both are options of this verb alone. */
bool run_table_take(int *argc, char **argv, struct run_table_look *l, struct err *e)
{
    *l = (struct run_table_look){.csv = take_flag(argc, argv, "--csv"),
                                 .columns = take_value(argc, argv, "--columns")};
    if (l->columns == NULL || l->columns[0] != '\0') return true;
    return err_set(e, ERR_USAGE, "--columns: expected names with commas, such as n,P,makespan_us");
}

/* The query as JSON, as CSV or as a table. */
bool run_table_show(struct store *s, const char *sql, const char *param,
                    const struct run_table_look *l, FILE *out, struct err *e)
{
    int64_t rows;
    if (l->json) return report_query(s, sql, 1, &param, true, out, e);
    if (l->csv)
        return csv_write(s, sql, 1, &param, out, NULL, NULL, &rows, e) &&
               (fflush(out) == 0 || err_set(e, ERR_IO, "the output cannot be written"));
    /* who asks for columns gets them, whatever they hold */
    const struct report_look look = {.compact = l->columns == NULL, .width = terminal_width(out)};
    return report_table(s, sql, 1, &param, &look, out, e);
}

/* The columns follow from the plan alone. */
bool run_table_check(const struct plan *p, const struct run_table_look *l, struct err *e)
{
    struct columns c = {.arena = arena_create()};
    struct text sql = {0};
    list_columns(&c, p);
    const bool ok = choose_columns(&c, l, &sql, e);
    text_free(&sql);
    arena_destroy(c.arena);
    return ok;
}

/* The identities of the plan's runs as one parameter: a list of any length, and no text of a
 * user in SQL. */
bool run_table_print(struct store *s, const struct plan *p, const struct run_table_look *l,
                     FILE *out, struct err *e)
{
    struct columns c = {.arena = arena_create()};
    struct text keys = {0}, sql = {0}, whole = {0};
    for (int i = 0; i < p->nrun; i++)
        text_add(&keys, "%s[\"%s\",%lld,%d]", i ? "," : "[", p->run[i].config_hash,
                 (long long)p->run[i].seed, p->run[i].rep);
    text_add(&keys, "]");
    list_columns(&c, p);
    bool ok = choose_columns(&c, l, &sql, e);
    if (ok) {
        text_add(&whole, "SELECT %s%s", sql.s, from_sql);
        ok = run_table_show(s, whole.s, keys.s, l, out, e);
    }
    text_free(&keys);
    text_free(&sql);
    text_free(&whole);
    arena_destroy(c.arena);
    return ok;
}
