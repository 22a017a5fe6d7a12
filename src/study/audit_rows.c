/* audit_rows.c - the rules of the audit that are queries: each gives the rows that contradict
 * others (audit.h). */
#include <string.h>

#include "base/text.h"
#include "study/audit_rules.h"

/* What a query of a rule needs to report its rows. */
struct asking {
    struct store *store;
    struct audit_report *report;
    const char *rule;
    struct err *e;
};

/* A rule gives (run, text): one row is one contradiction. A text of NULL comes from a missing
 * number in the expression that makes it, which is a contradiction as well. A third column that is
 * not NULL is a query that gives such rows. */
static bool take_finding(void *context, int ncolumn, const char *const *name,
                         const struct store_value *value)
{
    (void)name;
    struct asking *q = context;
    if (ncolumn > 2 && value[2].kind == STORE_TEXT)
        return store_query(q->store, value[2].text, 0, NULL, NULL, take_finding, q, q->e);
    audit_find(q->report, value[0].kind == STORE_INT ? value[0].integer : 0, q->rule, "%s",
               value[1].kind == STORE_TEXT ? value[1].text : "a number is missing");
    return true;
}

/* --- views and limits are the program's ------------------------------------------------------- */

/* Views and limits as one list of (name, text); both databases are asked with the same query. */
static const char schema[] =
    "SELECT 'view ' || name, sql FROM sqlite_schema WHERE type = 'view' UNION ALL SELECT "
    "'meta ' || key, value FROM meta";

struct listing {
    struct audit_report *report;
    struct store *other;
    int n;
};

static bool is_there(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)ncolumn, (void)name, (void)value;
    *(bool *)context = true;
    return true;
}

static bool compare_object(void *context, int ncolumn, const char *const *name,
                           const char *const *value)
{
    (void)ncolumn, (void)name;
    struct listing *l = context;
    bool same = false;
    struct err e;
    err_clear(&e);
    static const char find[] =
        "SELECT 1 FROM (SELECT 'view ' || name AS n, sql AS t FROM sqlite_schema WHERE type = "
        "'view' UNION ALL SELECT 'meta ' || key, value FROM meta) WHERE n = ?1 AND t = ?2";
    /* The other database must have an object of this name with this text: one statement finds
     * both a changed and a missing one. */
    if (value[1] && store_select(l->other, find, 2, value, is_there, &same, &e) && !same)
        audit_find(l->report, 0, "schema", "%s is not as this program makes it", value[0]);
    return true;
}

/* A changed view would change every figure and every claim, without any row being wrong. A new
 * database in memory has what this program makes. */
static bool compare_schema(struct store *s, struct audit_report *r, struct err *e)
{
    struct store *fresh = store_open("in memory", STORE_MEMORY, e);
    struct listing l = {r, s, 0};
    bool ok = fresh && store_select(fresh, schema, 0, NULL, compare_object, &l, e);
    store_close(fresh);
    r->nrule++;
    return ok;
}

/* The rules of audit.sql, each a line "-- rule: NAME" and the query below it, up to the next
 * one. */
bool audit_rows(struct store *s, struct audit_report *r, struct err *e)
{
    static const char mark[] = "-- rule: ";
    if (!compare_schema(s, r, e)) return false;
    bool ok = true;
    for (const char *at = strstr(audit_sql(), mark), *next; at && ok; at = next) {
        /* The name ends with its line; the query ends where the next rule begins. */
        const char *name = at + strlen(mark), *sql = strchr(name, '\n');
        next = strstr(sql, mark);
        struct text rule = {0}, query = {0};
        text_add_bytes(&rule, name, (size_t)(sql - name));
        text_add_bytes(&query, sql, next ? (size_t)(next - sql) : strlen(sql));
        struct asking q = {s, r, rule.s, e};
        ok = store_query(s, query.s, 0, NULL, NULL, take_finding, &q, e) && e->kind == ERR_NONE;
        r->nrule++;
        text_free(&rule);
        text_free(&query);
    }
    return ok;
}
