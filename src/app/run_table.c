/* run_table.c - see run_table.h.
 *
 * The table is a query, so that what `run` prints and what a user asks of the database are the
 * same numbers. */
#include "app/run_table.h"

#include <string.h>

#include "report/report.h"

enum { MOST_SWEPT = 64 }; /* more columns nobody reads */

/* Swept keys that have a column in every table, under another name. */
static const char *const always[] = {"machine.name",  "kernel.name",           "kernel.formulation",
                                     "kernel.solver", "machine.network.level", "model.n",
                                     "ranks",         "program.n",             "program.file"};
static const char *const fixed[] = {"machine", /* names that a swept key cannot have */
                                    "kernel",
                                    "formulation",
                                    "solver",
                                    "message",
                                    "level",
                                    "n",
                                    "P",
                                    "rep",
                                    "makespan_us",
                                    "digest",
                                    "status",
                                    "speedup_vs_fastest_serial",
                                    "speedup_vs_itself",
                                    "relative_error",
                                    "measured_us"};

/* %s: whether messages are swept; else only micro-benchmarks have a message size. */
static const char first_sql[] =
    "SELECT r.label AS machine, r.kernel, iif(r.nu > 0, r.formulation, NULL) AS formulation,"
    " iif(r.nu > 0, r.solver, NULL) AS solver,"
    " iif(%s, (SELECT value FROM v_setting v WHERE v.run_id = r.id AND v.key = 'kernel.message'),"
    " NULL) AS message,"
    " r.level, iif(r.nu > 0 OR EXISTS (SELECT 1 FROM v_setting v WHERE v.run_id = r.id AND v.key = 'program.n'),"
    " r.n, NULL) AS n, r.P";

/* The rows of the plan, in its order: ?1 is a JSON array of [hash, seed, repetition]. */
static const char last_sql[] =
    ", iif(r.status IN ('ok', 'invalid'), r.makespan_ps / 1e6, NULL) AS makespan_us,"
    " (SELECT s.speedup FROM v_speedup s WHERE s.run_id = r.id AND s.baseline = 'fastest serial')"
    "   AS speedup_vs_fastest_serial,"
    " (SELECT s.speedup FROM v_speedup s WHERE s.run_id = r.id"
    " AND s.baseline = 'parallel code on one processor')"
    "   AS speedup_vs_itself,"
    " (SELECT max(e.relative_error) FROM error_check e WHERE e.run_id = r.id) AS relative_error,"
    " r.measured_s * 1e6 AS measured_us, r.digest, r.status"
    " FROM run r JOIN json_each(?1) k ON r.config_hash = k.value ->> 0 AND r.seed = k.value ->> 1"
    " AND r.rep = k.value ->> 2 ORDER BY k.key";

static bool is_one_of(const char *word, const char *const *list, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (strcmp(list[i], word) == 0) return true;
    return false;
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
    while (name > key) {
        do name--;
        /* One word more to the left each time. */
        while (name > key && name[-1] != '.');
        bool taken = is_one_of(name, fixed, sizeof fixed / sizeof *fixed);
        for (int i = 0; i < p->nswept; i++)
            taken = taken || (i != at && ends_in(p->swept[i].key, name));
        if (!taken) break;
    }
    return name;
}

/* A swept setting as a column; numbers as numbers, so that they sort and align. */
static void add_column(struct text *sql, const struct plan *p, int at)
{
    const char *key = p->swept[at].key, *name = short_name(p, at);
    /* No setting of the run: n and P are. */
    if (strcmp(key, "n_over_p") == 0) text_add(sql, ", r.n / r.P AS n_over_p");
    else
        text_add(sql,
                 ", (SELECT %s FROM v_setting v WHERE v.run_id = r.id AND v.key = '%s') AS \"%s\"",
                 p->swept[at].number ? "CAST(value AS NUMERIC)" : "value", key, name);
}

/* The columns of a plan: what is swept, repetitions where there are any. */
static void make_sql(const struct plan *p, struct text *sql)
{
    bool message = false, repeated = false;
    for (int i = 0; i < p->nswept; i++)
        message = message || strcmp(p->swept[i].key, "kernel.message") == 0;
    for (int i = 0; i < p->nrun; i++) repeated = repeated || p->run[i].rep > 0;
    text_add(sql, first_sql, message ? "1" : "r.measured_s IS NOT NULL");
    for (int i = 0; i < p->nswept && i < MOST_SWEPT; i++)
        if (!is_one_of(p->swept[i].key, always, sizeof always / sizeof *always) &&
            strcmp(p->swept[i].key, "kernel.message") != 0)
            add_column(sql, p, i);
    text_add(sql, "%s%s", repeated ? ", r.rep" : "", last_sql);
}

/* The identities of the plan's runs as one parameter: a list of any length, and no text of a
 * user in SQL. */
bool run_table_print(struct store *s, const struct plan *p, bool json, FILE *out, struct err *e)
{
    struct text keys = {0}, sql = {0};
    for (int i = 0; i < p->nrun; i++)
        text_add(&keys, "%s[\"%s\",%lld,%d]", i ? "," : "[", p->run[i].config_hash,
                 (long long)p->run[i].seed, p->run[i].rep);
    text_add(&keys, "]");
    make_sql(p, &sql);
    const char *param = keys.s;
    bool ok = report_query(s, sql.s, 1, &param, json, out, e);
    text_free(&keys);
    text_free(&sql);
    return ok;
}
