/* explanations.c - see explanations.h. Every number is the answer of a query.
 *
 * The sentences were made when the search ended (table explain_answer): the report repeats them,
 * so that both always say the same. */
#include "report/explanations.h"

#include "base/text.h"
#include "report/findings.h"
#include "report/report.h"

/* Claims by number, all of them together last; of one claim its own goal before any other. */
#define IN_ORDER " ORDER BY subject = 'together', length(subject), subject, goal = 'any'"

/* One claim: what has to change for it to hold, in sentences, and its map if there is one. */
static bool tell_answer(void *context, int ncolumn, const char *const *name,
                        const char *const *value)
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
        /* the map that `claims --explain` drew */
        text_add(&figure, "explain-%s", value[0]);
        page_figure(p, figure.s,
                    "Where the claim holds in the plane of the two most important parameters, with "
                    "the others as in the answer. Each cell is a simulated and judged point.");
        text_free(&figure);
    }
    text_free(&heading);
    return true;
}

/* The sentences of a claim are one paragraph; its map is only asked for. */
static const char sentences[] =
    "SELECT a.subject, group_concat(a.sentence, ' '), (SELECT statement FROM claim WHERE id = "
    "a.subject AND variant = ''), (SELECT 1 FROM explain_map m WHERE m.subject = a.subject LIMIT 1)"
    " FROM (SELECT * FROM explain_answer" IN_ORDER ") a GROUP BY a.subject"
    " ORDER BY a.subject = 'together', length(a.subject), a.subject";

/* The same answers as a table: exp(distance) is the product of all factors, that is how large
 * the change is as a single one. */
static const char table_sql[] =
    "SELECT subject AS claim, iif(goal = 'own', 'as judged', 'any choice') AS goal, verdict, "
    "variant, iif(distance IS NULL, '', format('%.3g', exp(distance))) AS factor, settings, "
    "points, CASE confirmed WHEN 1 THEN 'yes' WHEN 0 THEN 'no' ELSE '' END AS confirmed FROM "
    "explain_answer" IN_ORDER;

/* A database without a search has no such section. */
bool explanations_section(struct page *p, struct store *s, struct err *e)
{
    bool any;
    if (!findings_any(s, "SELECT 1 FROM explain_answer LIMIT 1", &any, e)) return false;
    if (!any) return true;
    page_heading(p, 2, "Changes under which failed claims hold");
    /* What was varied, how a change is measured, and what finding nothing means. */
    page_paragraph(p, "The paper does not state the flop rate of its code, the cost of a call or a "
                      "message, how its serial code was written, or who else used the machine. For "
                      "each failed claim these parameters are varied to find the smallest change "
                      "under which the claim holds. The size of a change is the sum of |ln(value / "
                      "nominal)|, that is, the product of all factors; other operators or another "
                      "serial baseline count as a factor of 2 each. Every point is simulated and "
                      "judged by the query of the claim. Factors range from 1/10 to 10, traffic of "
                      "others up to 90 %, variation of computing times up to 100 %. If no point "
                      "was found, the claim may still hold at a point that was not tried, unless a "
                      "reason is given why it cannot.");
    /* Sentences first; the table below has the numbers behind them. */
    return store_select(s, sentences, 0, NULL, tell_answer, p, e) &&
           page_table(p, s, table_sql, 0, NULL, "No search was made.", e);
}

/* On a terminal the sentences are enough. */
static bool print_answer(void *context, int ncolumn, const char *const *name,
                         const char *const *value)
{
    (void)ncolumn;
    (void)name;
    fprintf(context, "%s\n\n", value[0]);
    return true;
}

bool explanations_print(struct store *s, bool json, FILE *out, struct err *e)
{
    if (json)
        return report_query(s, "SELECT * FROM explain_answer" IN_ORDER, 0, NULL, true, out, e);
    return store_select(s, "SELECT sentence FROM explain_answer" IN_ORDER, 0, NULL, print_answer,
                        out, e);
}
