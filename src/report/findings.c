/* findings.c - see findings.h.
 *
 * The tables and sentences are SQL: what is counted, how it is rounded and in which order it
 * stands can be tried in any SQLite shell on a user's database. This file puts them in order. */
#include "report/findings.h"

#include "base/text.h"

/* Where the writing of one section stands; an error inside a row's function stops it. */
struct section {
    struct page *page;
    struct store *store;
    struct err *e;
};

/* One row is enough to know that there are any. */
static bool note_row(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)ncolumn;
    (void)name;
    (void)value;
    *(bool *)context = true;
    return false;
}

bool findings_any(struct store *s, const char *sql, bool *any, struct err *e)
{
    *any = false;
    return store_select(s, sql, 0, NULL, note_row, any, e);
}

/* The rows of a query, with the section's name as ?1 where it asks for it. */
static bool table(struct section *c, const char *sql, const char *param, const char *empty)
{
    return page_table(c->page, c->store, sql, param != NULL, &param, empty, c->e);
}

/* A sentence of a query as a paragraph. */
static bool tell_sentence(void *context, int ncolumn, const char *const *name,
                          const char *const *value)
{
    struct section *c = context;
    (void)ncolumn;
    (void)name;
    page_paragraph(c->page, value[0]);
    return true;
}

/* A paragraph for each row of `sql`. */
static bool sentences(struct section *c, const char *sql, const char *param)
{
    return store_select(c->store, sql, param != NULL, &param, tell_sentence, c, c->e);
}

/* --- error against run time ------------------------------------------------------------------- */

/* One sentence per choice of a ladder: the cheapest within the tolerance, its error and cost,
 * and what the most accurate one would cost. Numbers and grammar both come from the query. */
static const char choice_sentences[] =
    "SELECT format('%s (%s, %s within %g): ', c.ladder, c.at, c.quantity, c.tolerance) || "
    "iif(c.method IS NULL, 'no method is within the tolerance.', format('cheapest is %s %s%s%s; "
    "%s.',  c.method || iif(c.rung = c.method, '', ', ' || c.rung),  iif(c.relative_error = 0, "
    "'and exact', format('with an error of %.1e', c.relative_error)),  iif(c.ladder = 'network' OR "
    "l.machine_ps IS NULL, '', format(', %.4g us on the machine', l.machine_ps / 1e6)),  "
    "iif(c.ladder = 'integration', ' (' || l.text || ')', ''),  iif(c.cost_ratio = 1, 'no more "
    "accurate method has a time',   format('the most accurate costs %.3g times as much', "
    "c.cost_ratio)))) FROM ladder_choice c LEFT JOIN ladder l ON l.scenario = c.scenario AND "
    "l.ladder = c.ladder AND l.at = c.at  AND l.method = c.method AND l.rung = c.rung AND "
    "l.quantity = c.quantity WHERE c.scenario = ?1 GROUP BY c.ladder, c.at, c.quantity, "
    "c.tolerance ORDER BY CASE c.ladder WHEN 'network' THEN 1 WHEN 'arithmetic' THEN 2 ELSE 3 END, "
    "c.tolerance";

/* Which rungs gave no usable answer, each reason once. */
static const char failed_rungs[] =
    "SELECT ladder, at, method, group_concat(rung, ', ') AS rungs, reason FROM (SELECT *, "
    "iif(relative_error IS NULL, text, format('error %.1e', relative_error)) AS reason FROM ladder "
    " WHERE scenario = ?1 AND status = 'failed' AND quantity IN ('makespan', 'qdd', 'state') ORDER "
    "BY ordinal) GROUP BY ladder, at, method, reason ORDER BY min(ordinal)";

/* One scenario: choices in words, the figure, failures. */
static bool tell_ladders(void *context, int ncolumn, const char *const *name,
                         const char *const *value)
{
    struct section *c = context;
    struct text figure = {0};
    (void)ncolumn;
    (void)name;
    page_heading(c->page, 3, value[0]);
    /* the drawings are called after the scenario */
    text_add(&figure, "accuracy-%s", value[0]);
    bool ok = sentences(c, choice_sentences, value[0]);
    if (ok)
        page_figures(c->page, c->store, figure.s,
                     "Error against the run time on this computer and on the simulated machine; "
                     "exact results are on the line at the bottom.");
    if (ok) page_paragraph(c->page, "Failed:");
    ok = ok && table(c, failed_rungs, value[0], "None.");
    text_free(&figure);
    return ok;
}

/* Nothing of this section appears in a report of a database without ladders. */
bool findings_accuracy(struct page *p, struct store *s, struct err *e)
{
    struct section c = {p, s, e};
    bool any;
    if (!findings_any(s, "SELECT 1 FROM ladder LIMIT 1", &any, e)) return false;
    if (!any) return true;
    page_heading(p, 2, "Error against run time");
    page_paragraph(p, "Errors of cheaper models and methods: network levels against the most "
                      "detailed one, accelerations of every algorithm and precision against quad "
                      "precision, motions against a reference with tight tolerance. The cost is "
                      "the run time on this computer for network levels, and the predicted run "
                      "time on the machine otherwise. Measured by mimdsim accuracy.");
    /* First the overview over all scenarios, then a part for each. */
    if (!table(&c,
               /* The choices: what a user may take instead of the most accurate method. */
               "SELECT scenario, ladder, at, quantity, format('%g', tolerance) AS \"tolerance\", "
               "ifnull(method || iif(rung = method, '', ', ' || rung), 'none within the "
               "tolerance') AS cheapest, CASE WHEN relative_error IS NULL THEN '' WHEN "
               "relative_error = 0 THEN 'exact' ELSE format('%.1e', relative_error) END AS "
               "\"error\", iif(cost_ratio IS NULL, '', format('%.3g', cost_ratio)) AS \"cost of "
               "the most accurate, relative\" FROM ladder_choice ORDER BY scenario, CASE ladder "
               "WHEN 'network' THEN 1 WHEN 'arithmetic' THEN 2 ELSE 3 END, tolerance",
               NULL, "No choice was made."))
        return false;
    if (!table(&c,
               /* How many rungs of each ladder are of any use. */
               "SELECT scenario, ladder, at, reference, sum(status = 'ok') AS ok, sum(status = "
               "'degraded') AS degraded, sum(status = 'failed') AS failed FROM ladder WHERE "
               "quantity IN ('makespan', 'qdd', 'state') GROUP BY scenario, ladder, at, family "
               "ORDER BY scenario, min(ordinal)",
               NULL, "No result is stored."))
        return false;
    return store_select(s, "SELECT DISTINCT scenario FROM ladder ORDER BY 1", 0, NULL, tell_ladders,
                        &c, e) &&
           e->kind == ERR_NONE;
}

/* --- stability -------------------------------------------------------------------------------- */

/* What became of the claim that a symmetric positive definite matrix guarantees stability. */
static const char spd_sentence[] =
    /* the three groups of algorithms that the claim distinguishes */
    "WITH kind AS (SELECT CASE  WHEN algorithm IN ('cfa-paper', 'paper cr', 'paper pcr', 'paper "
    "contraction') THEN 'paper'  WHEN algorithm IN ('cfa-direct', 'direct cr', 'direct pcr', "
    "'direct contraction') THEN 'direct'  WHEN algorithm LIKE '%robust%' OR algorithm LIKE 'twice "
    "%' THEN 'repaired' END AS kind, status  FROM stability WHERE suite = ?1 AND precision = "
    "'double') SELECT format('The paper calls its method stable because its matrix is symmetric "
    "positive definite. In double precision the paper''s formulation gives %d of %d answers ok, %d "
    "degraded and %d failed; the direct formulation %d of %d, %d and %d; the direct formulation "
    "with scaling and refinement %d of %d, %d and %d.', sum(kind = 'paper' AND status = 'ok'), "
    "sum(kind = 'paper'), sum(kind = 'paper' AND status = 'degraded'), sum(kind = 'paper' AND "
    "status = 'failed'), sum(kind = 'direct' AND status = 'ok'), sum(kind = 'direct'), sum(kind = "
    "'direct' AND status = 'degraded'), sum(kind = 'direct' AND status = 'failed'), sum(kind = "
    "'repaired' AND status = 'ok'), sum(kind = 'repaired'), sum(kind = 'repaired' AND status = "
    "'degraded'), sum(kind = 'repaired' AND status = 'failed')) FROM kind WHERE kind IS NOT NULL "
    "HAVING count(*) > 0";

/* Grades by algorithm, with the case in which each did worst: failures before degraded answers,
 * missing numbers before large errors. */
static const char by_algorithm[] =
    "SELECT algorithm, precision, sum(status = 'ok') AS ok, sum(status = 'degraded') AS degraded, "
    "sum(status = 'failed') AS failed, iif(max(relative_error) IS NULL, '', format('%.1e', "
    "max(relative_error))) AS \"largest error\","
    /* min and max of the status tell whether all rows are ok. */
    " iif(min(status) = 'ok' AND max(status) = 'ok', '', (SELECT subject FROM stability w   WHERE "
    "w.suite = s.suite AND w.algorithm = s.algorithm   AND w.precision = s.precision ORDER BY "
    "w.status = 'failed' DESC, w.status = 'degraded' DESC,   w.relative_error IS NULL DESC, "
    "w.relative_error DESC LIMIT 1)) AS \"worst case\" FROM stability s WHERE suite = ?1 GROUP BY "
    "algorithm, precision ORDER BY min(ordinal)";

/* The cases in which most algorithms fail, at most 16: beyond that a reader learns nothing new. */
static const char worst_cases[] =
    "SELECT subject AS \"worst cases\", sum(status = 'failed') AS failed, sum(status = 'degraded') "
    "AS degraded, count(*) AS answers, iif(max(condition) IS NULL, '', format('%.0e', "
    "max(condition))) AS condition, iif(max(growth) IS NULL, '', format('%.0e', max(growth))) AS "
    "growth, ifnull(replace(group_concat(DISTINCT iif(status = 'failed', algorithm || "
    "iif(precision = 'double', '',  ' (' || precision || ')'), NULL)), ',', ', '), '') AS \"failed "
    "by\", ifnull(max(iif(status = 'failed', nullif(reason, ''), NULL)), '') AS reason FROM "
    "stability WHERE suite = ?1 GROUP BY subject HAVING sum(status <> 'ok') > 0 ORDER BY failed "
    "DESC, degraded DESC, min(ordinal) LIMIT 16";

/* Evaluations stand at the beginning of a motion's reason. */
static const char stiff_motions[] =
    "WITH motion AS (SELECT *, algorithm IN ('rk1imp', 'rk2imp', 'rk4imp', 'bsimp', 'msbdf', 'own "
    "implicit') AS implicit,  iif(status = 'ok' AND reason GLOB '[0-9]*evaluations*', CAST(reason "
    "AS REAL), NULL) AS evaluations  FROM stability WHERE suite = ?1 AND (algorithm LIKE 'own %' "
    "OR algorithm IN ('rkf45', 'rk8pd', 'msadams',  'rk1imp', 'rk2imp', 'rk4imp', 'bsimp', "
    "'msbdf'))) SELECT subject AS \"stiff motion\",  iif(max(iif(algorithm LIKE 'own %' AND NOT "
    "implicit, step_s, NULL)) IS NULL, 'none',  format('%.2e', max(iif(algorithm LIKE 'own %' AND "
    "NOT implicit, step_s, NULL))))  AS \"largest stable explicit step\", min(iif(implicit, NULL, "
    "evaluations)) AS \"explicit evaluations\",  min(iif(implicit, evaluations, NULL)) AS "
    "\"implicit evaluations\",  CASE WHEN min(iif(implicit, evaluations, NULL)) IS NULL THEN 'no "
    "implicit integrator is ok'   WHEN min(iif(implicit, NULL, evaluations)) IS NULL THEN 'no "
    "explicit integrator is ok' ELSE   format('%.3g', min(iif(implicit, NULL, evaluations)) / "
    "min(iif(implicit, evaluations, NULL))) END  AS \"explicit over implicit\", sum(status = "
    "'failed') AS \"failed integrators\" FROM motion GROUP BY subject ORDER BY min(ordinal)";

/* One suite: its counts, figure, and three tables. The sentence on the paper's claim needs the
 * built-in cases: a scenario's points are no sample of anything. */
static bool tell_suite(void *context, int ncolumn, const char *const *name,
                       const char *const *value)
{
    struct section *c = context;
    struct text figure = {0};
    /* Columns of the query in findings_stability: suite, whether it is the built-in one, counts. */
    const bool built_in = value[1][0] == '1';
    (void)ncolumn;
    (void)name;
    page_heading(c->page, 3, built_in ? "The suite" : value[0]);
    text_add(&figure, "stability-%s", value[0]);
    page_paragraph(c->page, value[2]);
    page_figures(c->page, c->store, figure.s,
                "Cases and algorithms; each cell gives the power of ten of the relative error. For "
                "stiff motions: error, step, evaluations (if not run: the number needed) and "
                "energy drift.");
    /* Overview by algorithm, then by case, then motions; the figure shows all of them at once. */
    bool ok = (!built_in || sentences(c, spd_sentence, value[0])) &&
              table(c, by_algorithm, value[0], "No row.") &&
              table(c, worst_cases, value[0], "No result failed or degraded.") &&
              table(c, stiff_motions, value[0],
                    "No motion of a scene with springs or dampers was simulated.");
    text_free(&figure);
    return ok;
}

bool findings_stability(struct page *p, struct store *s, struct err *e)
{
    struct section c = {p, s, e};
    bool any;
    if (!findings_any(s, "SELECT 1 FROM stability LIMIT 1", &any, e)) return false;
    if (!any) return true;
    page_heading(p, 2, "Stability");
    page_paragraph(p, "Stiff and extreme scenes with every algorithm and integrator. An error of "
                      "accelerations up to 1e-8 is graded ok and up to 1e-2 degraded, in single "
                      "precision up to 1e-3 and 1e-1. Measured by mimdsim stability.");
    /* The built-in suite first. */
    return store_select(s,
                        "SELECT suite, suite = 'suite', format('%d ok, %d degraded, %d failed of "
                        "%d answers on %d scene%s.', sum(status = 'ok'), sum(status = 'degraded'), "
                        "sum(status = 'failed'), count(*), count(DISTINCT subject), "
                        "iif(count(DISTINCT subject) = 1, '', 's')) FROM stability GROUP BY suite "
                        "ORDER BY suite <> 'suite', suite",
                        0, NULL, tell_suite, &c, e) &&
           e->kind == ERR_NONE;
}

/* --- what leaving out saves ------------------------------------------------------------------- */

/* One omission: what and why, its class, and what it saves. Savings within the noise are told as
 * such. */
static const char saving_rows[] =
    "SELECT what, why, class || iif(bound IS NULL, '', format(' %.0e', bound)) AS class, at, CASE "
    "WHEN host_saved_s IS NULL THEN 'cannot be undone'  WHEN abs(host_saved_s) <= host_noise_s "
    "THEN format('less than the noise, %.2g ms', host_noise_s * 1e3)  WHEN host_saved_s < 0 THEN "
    "format('nothing: it costs %.2g ms more', -host_saved_s * 1e3)  ELSE format('%.3g ms of %.3g', "
    "host_saved_s * 1e3, (host_s + host_saved_s) * 1e3) END AS \"saved on this computer\", CASE "
    "WHEN machine_saved_ps IS NULL THEN '' WHEN machine_saved_ps = 0 THEN 'nothing'  ELSE "
    "format('%.4g us of %.6g', machine_saved_ps / 1e6, (machine_ps + machine_saved_ps) / 1e6) END "
    "AS \"saved on the machine (predicted)\" FROM omission WHERE scenario = ?1 ORDER BY ordinal";

static bool tell_savings(void *context, int ncolumn, const char *const *name,
                         const char *const *value)
{
    struct section *c = context;
    struct text figure = {0};
    (void)ncolumn;
    (void)name;
    page_heading(c->page, 3, value[0]);
    text_add(&figure, "omissions-%s", value[0]);
    page_figures(c->page, c->store, figure.s,
                "Time saved by each omission: the time of the same run with the omission undone, "
                "minus the time of the run with the omission.");
    text_free(&figure);
    return table(c, saving_rows, value[0], "Nothing.");
}

/* The heading is written by the caller, who has more to say of omissions. */
bool findings_savings(struct page *p, struct store *s, struct err *e)
{
    struct section c = {p, s, e};
    return store_select(s, "SELECT DISTINCT scenario FROM omission ORDER BY 1", 0, NULL,
                        tell_savings, &c, e) &&
           e->kind == ERR_NONE;
}
