/* claims_print.c - the verdicts as a table for people and as JSON.
 *
 * For people the table comes first and the reasons below it; a program gets one object per claim
 * with all of its variants. */
#include "base/json.h"
#include "report/claims.h"
#include "report/report.h"

/* C2 before C10, indicators last, as claims.c sorts the rules. */
static const char order[] = " ORDER BY substr(id, 1, 1) <> 'C', length(id), id, variant";

/* One line per claim: value, threshold, range and share over the samples, in how many variants
 * it holds. */
static const char table_sql[] =
    "SELECT id, verdict, iif(value IS NULL, '-', format('%.4g', value)) AS value, threshold, unit, "
    "iif(samples > 0 AND value_low IS NOT NULL, format('%.3g .. %.3g', value_low, value_high), "
    "'-') AS range, iif(share IS NULL, '-', format('%d %%', round(100 * share))) AS share, "
    "iif(testable > 0, holding || ' of ' || testable, '-') AS \"holds in\", statement FROM claim "
    "WHERE variant = '' ORDER BY substr(id, 1, 1) <> 'C', length(id), id";

/* How each verdict came about. */
static const char reason_sql[] = "SELECT id, verdict, judged, test, note FROM claim"
                                 " WHERE variant = ''"
                                 " ORDER BY substr(id, 1, 1) <> 'C', length(id), id";

/* Test and tolerance stand before the finding: a reader should judge the rule before the result. */
static bool tell_reason(void *context, int ncolumn, const char *const *name,
                        const struct store_value *value)
{
    FILE *out = context;
    (void)ncolumn;
    (void)name;
    fprintf(out, "\n%s %s\n  test:   %s\n  judged: %s\n  found:  %s\n", value[0].text,
            value[1].text, value[3].text, value[2].text, value[4].text);
    return true;
}

/* The rows of table claim, of which the one with the empty variant opens a claim. */
struct listing {
    struct json j;
    bool open;
    char verdict[16]; /* of the claim that is open: its key comes after the variants, as keys are
                         sorted */
};

/* Ends the list of variants and the claim around it. */
static void close_claim(struct listing *l)
{
    if (!l->open) return;
    json_end(&l->j);
    json_key_text(&l->j, "verdict", l->verdict);
    json_end(&l->j);
    l->open = false;
}

/* Columns of json_sql; a variant does not repeat what all variants of a claim share. */
enum claim_column { COLUMN_JUDGED = 2, COLUMN_STATEMENT = 6, COLUMN_TESTABLE = 8, COLUMN_UNIT = 10,
              COLUMN_VARIANT = 14, COLUMN_VERDICT = 15 };
static const char json_sql[] = "SELECT holding, id, judged, note, samples, share, statement, test,"
                               " testable, threshold, unit, value, value_high, value_low, variant, "
                               "verdict FROM claim";

/* A row with an empty variant begins a claim; those that follow are in its list `variants`. Keys
 * are sorted, so a claim stays open until its last variant and its verdict, the last key. */
static bool json_claim(void *context, int ncolumn, const char *const *name,
                       const struct store_value *value)
{
    struct listing *l = context;
    bool own = *value[COLUMN_VARIANT].text == '\0';
    if (own) close_claim(l);
    json_object(&l->j);
    for (int i = 0; i < ncolumn; i++) {
        /* What a variant shares with its claim: columns by their places in json_sql. */
        bool shared = i <= COLUMN_JUDGED || (i >= COLUMN_STATEMENT && i <= COLUMN_TESTABLE) ||
                      i == COLUMN_UNIT;
        if (own ? i >= COLUMN_VARIANT : shared) continue;
        json_key(&l->j, name[i]);
        report_value_json(&l->j, &value[i]);
    }
    if (own) {
        json_key(&l->j, "variants");
        json_array(&l->j);
        l->open = true;
        text_copy(l->verdict, sizeof l->verdict, value[COLUMN_VERDICT].text);
    /* a variant is complete */
    } else json_end(&l->j);
    return true;
}

bool claims_print(struct store *s, bool json, FILE *out, struct err *e)
{
    if (!json)
        return report_query(s, table_sql, 0, NULL, false, out, e) &&
               store_query(s, reason_sql, 0, NULL, NULL, tell_reason, out, e);
    struct listing l = {.j = json_make(out)};
    char sql[512];
    snprintf(sql, sizeof sql, "%s%s", json_sql, order);
    json_array(&l.j);
    bool ok = store_query(s, sql, 0, NULL, NULL, json_claim, &l, e);
    close_claim(&l);
    json_end(&l.j);
    json_finish(&l.j);
    return ok;
}
