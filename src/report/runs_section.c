/* runs_section.c - see runs_section.h. */
#include "report/runs_section.h"

#include "base/text.h"
#include "report/findings.h"
#include "report/how_sure.h"

/* Where the writing stands; an error inside a row's function stops it. */
struct section {
    struct page *page;
    struct store *store;
    struct err *e;
};

/* A line for each machine and level; a changed machine says how it differs from the shipped one.
 * Runs that failed are counted here, as no figure shows them. */
static const char machines_of[] =
    "SELECT l.name AS machine, ifnull((SELECT group_concat(key || ' ' || value, ', ') FROM "
    "json_each(iif(json_valid(r.machine_changes), r.machine_changes, '{}'))), '') AS changes, "
    "r.level, "
    "count(*) AS runs, sum(r.status <> 'ok') AS failed, iif(min(r.n) = max(r.n), format('%d', "
    "min(r.n)), format('%d to %d', min(r.n), max(r.n))) AS n, iif(min(r.P) = max(r.P), "
    "format('%d', min(r.P)), format('%d to %d', min(r.P), max(r.P))) AS P, format('%.4g', "
    "min(iif(r.status = 'ok', ifnull(r.measured_s * 1e6, r.makespan_ps / 1e6), NULL))) AS "
    "\"shortest [us]\", format('%.4g', max(iif(r.status = 'ok', ifnull(r.measured_s * 1e6, "
    "r.makespan_ps / 1e6), NULL))) AS \"longest [us]\" FROM run r JOIN v_label l ON l.run_id = "
    "r.id WHERE r.kernel = ?1 GROUP BY l.name, r.level ORDER BY r.machine, min(r.id)";

static bool tell_kernel(void *context, int ncolumn, const char *const *name,
                        const char *const *value)
{
    struct section *c = context;
    const char *const kernel[] = {value[0]};
    struct text figure = {0};
    (void)ncolumn;
    (void)name;
    page_heading(c->page, 3, value[0]);
    /* The second column: whether any run ended well, so that there is something to draw. */
    text_add(&figure, "runs-%s", value[0]);
    if (value[1][0] == '1')
        page_figures(c->page, c->store, figure.s,
                     "Every run that ended well: its time against the setting that takes most "
                     "values, a curve for each combination of the others.");
    text_free(&figure);
    return page_table(c->page, c->store, machines_of, 1, kernel, "No run.", c->e);
}

bool runs_section(struct page *p, struct store *s, struct err *e)
{
    struct section c = {p, s, e};
    bool any;
    if (!findings_any(s, "SELECT 1 FROM run LIMIT 1", &any, e)) return false;
    if (!any) return true;
    /* Kernels with most runs first: they are what the database is about. */
    page_heading(p, 2, "Runs by kernel and machine");
    page_paragraph(p, "All runs of the database. A machine that was changed has a name of its own, "
                      "and the table says what was changed.");
    struct how_sure sure;
    struct text sentence = {0};
    if (!how_sure_read(s, NULL, &sure, e)) return false;
    how_sure_sentence(&sure, &sentence);
    if (sentence.length > 0) page_paragraph(p, sentence.s);
    text_free(&sentence);
    return store_select(s,
                        "SELECT kernel, max(status = 'ok') FROM run GROUP BY kernel"
                        " ORDER BY count(*) DESC, kernel",
                        0, NULL, tell_kernel, &c, e) &&
           e->kind == ERR_NONE;
}
