/* claims_print.c - the verdicts as a table for people and as JSON. */
#include "base/json.h"
#include "report/claims.h"
#include "report/report.h"

static const char order[] = " ORDER BY substr(id, 1, 1) <> 'C', length(id), id, variant";

static const char table_sql[] =
    "SELECT id, verdict, iif(value IS NULL, '-', format('%.4g', value)) AS value, threshold, unit,"
    " iif(samples > 0 AND value_low IS NOT NULL, format('%.3g .. %.3g', value_low, value_high), '-') AS range,"
    " iif(share IS NULL, '-', format('%d %%', round(100 * share))) AS share, statement"
    " FROM claim WHERE variant = '' ORDER BY substr(id, 1, 1) <> 'C', length(id), id";

/* The rows of table claim, of which the one with the empty variant opens a claim. */
struct listing {
    struct json j;
    bool open;
};

static void member(struct json *j, const char *key, const struct store_value *v)
{
    json_key(j, key);
    if (v->kind == STORE_TEXT) json_text(j, v->text);
    else if (v->kind == STORE_INT) json_int(j, v->integer);
    else if (v->kind == STORE_REAL) json_real(j, v->real);
    else json_null(j);
}

static void members(struct json *j, int first, int last, const char *const *name, const struct store_value *value)
{
    for (int i = first; i < last; i++) member(j, name[i], &value[i]);
}

static void close_claim(struct listing *l)
{
    if (!l->open) return;
    json_end(&l->j);
    json_end(&l->j);
    l->open = false;
}

static bool json_claim(void *context, int ncolumn, const char *const *name, const struct store_value *value)
{
    struct listing *l = context;
    bool own = *value[0].text == '\0';
    if (own) close_claim(l);
    json_object(&l->j);
    members(&l->j, own ? 1 : 0, own ? ncolumn : ncolumn - 4, name, value);
    if (own) {
        json_key(&l->j, "variants");
        json_array(&l->j);
        l->open = true;
    } else json_end(&l->j);
    return true;
}

bool claims_print(struct store *s, bool json, FILE *out, struct err *e)
{
    if (!json) return report_query(s, table_sql, 0, NULL, false, out, e);
    struct listing l = {.j = json_make(out)};
    char sql[512];
    snprintf(sql, sizeof sql,
             "SELECT variant, verdict, value, threshold, value_low, value_high, samples, share, note,"
             " id, statement, test, unit FROM claim%s",
             order);
    json_array(&l.j);
    bool ok = store_query(s, sql, 0, NULL, NULL, json_claim, &l, e);
    close_claim(&l);
    json_end(&l.j);
    json_finish(&l.j);
    return ok;
}
