/* explanations.c - see explanations.h. Every number is the answer of a query. */
#include "report/explanations.h"

#include "base/text.h"
#include "report/findings.h"
#include "report/report.h"

#define IN_ORDER " ORDER BY subject = 'together', length(subject), subject, goal = 'any'"

static bool tell_answer(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    struct page *p = context;
    struct text heading = {0};
    (void)ncolumn;
    (void)name;
    text_add(&heading, "%s%s%s", value[0], value[2] ? ": " : "", value[2] ? value[2] : "");
    page_heading(p, 3, heading.s);
    page_paragraph(p, value[1]);
    if (value[3]) {
        struct text figure = {0};
        text_add(&figure, "explain-%s", value[0]);
        page_figure(p, figure.s,
                    "Where the claim holds in the plane of the two parameters that matter most, the others as in the "
                    "answer: each cell is a point that was simulated and judged.");
        text_free(&figure);
    }
    text_free(&heading);
    return true;
}

static const char sentences[] = "SELECT a.subject, group_concat(a.sentence, ' '),"
                                " (SELECT statement FROM claim WHERE id = a.subject AND variant = ''),"
                                " (SELECT 1 FROM explain_map m WHERE m.subject = a.subject LIMIT 1)"
                                " FROM (SELECT * FROM explain_answer" IN_ORDER ") a GROUP BY a.subject"
                                " ORDER BY a.subject = 'together', length(a.subject), a.subject";

static const char table_sql[] =
    "SELECT subject AS claim, iif(goal = 'own', 'as judged', 'any choice') AS \"looked for\", verdict, variant,"
    " iif(distance IS NULL, '', format('%.3g', exp(distance))) AS factor, settings, points,"
    " CASE confirmed WHEN 1 THEN 'yes' WHEN 0 THEN 'no' ELSE '' END AS confirmed FROM explain_answer" IN_ORDER;

bool explanations_section(struct page *p, struct store *s, struct err *e)
{
    bool any;
    if (!findings_any(s, "SELECT 1 FROM explain_answer LIMIT 1", &any, e)) return false;
    if (!any) return true;
    page_heading(p, 2, "What would make the paper true");
    page_paragraph(p, "The paper does not state what its code sustained, what a call or a message cost it, how its "
                      "serial code was written, or who else used the machine. For each claim that fails these are "
                      "changed, and the smallest change is looked for under which it holds: small is a small sum of "
                      "|ln(value / nominal)|, that is, a small product of all factors; other operators or another "
                      "serial baseline count as a factor of 2 each. Every point is simulated and judged by the claim's "
                      "own query. Factors go to ten either way, others' traffic to 90 %, spread of computations to "
                      "100 %. A claim for which no point was found may hold at one that was not tried, unless a reason "
                      "is given why it cannot.");
    return store_select(s, sentences, 0, NULL, tell_answer, p, e) &&
           page_table(p, s, table_sql, 0, NULL, "Nothing was looked for.", e);
}

static bool print_answer(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)ncolumn;
    (void)name;
    fprintf(context, "%s\n\n", value[0]);
    return true;
}

bool explanations_print(struct store *s, bool json, FILE *out, struct err *e)
{
    if (json) return report_query(s, "SELECT * FROM explain_answer" IN_ORDER, 0, NULL, true, out, e);
    return store_select(s, "SELECT sentence FROM explain_answer" IN_ORDER, 0, NULL, print_answer, out, e);
}
