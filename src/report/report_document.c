/* report_document.c - the chapters of the report (report_document.h). Each number comes from a
 * query.
 *
 * Texts say what the tables are and how to read them; what the numbers mean for a claim is
 * decided by its rule (claims.h), not here. */
#include "report/report_document.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "report/explanations.h"
#include "report/findings.h"
#include "report/opening.h"
#include "report/page.h"
#include "report/runs_section.h"

/* C2 before C10, indicators last. */
#define IN_ORDER " ORDER BY substr(id, 1, 1) <> 'C', length(id), id"

/* What each chapter needs. A chapter is a function that writes its heading and its parts; false
 * stops the report with *e set. */
struct chapter {
    const struct document *d;
    struct page *page;
    struct err *e;
};

/* The rows of a query without parameters. */
static bool table(struct chapter *c, const char *sql, const char *empty)
{
    return page_table(c->page, c->d->store, sql, 0, NULL, empty, c->e);
}

/* --- what contradicts the paper --------------------------------------------------------------- */

/* A claim that failed: rule first, then what the model gives, then how sure that is. */
static bool tell_claim(void *context, int ncolumn, const char *const *name,
                       const char *const *value)
{
    struct chapter *c = context;
    struct text t = {0};
    (void)ncolumn;
    (void)name;
    text_add(&t, "%s: %s", value[0], value[1]);
    page_heading(c->page, 3, t.s);
    text_free(&t);
    /* Columns as in the query of contradictions: rule and reason first. */
    text_add(&t, "Test: %s. Judged: %s", value[2], value[8]);
    if (value[3])
        text_add(&t, " The model gives %s (%s)", value[3], value[4]);
    else
        text_add(&t, " The model gives no value");
    /* Without samples nothing is said of uncertainty. */
    if (value[6]) text_add(&t, ", over the samples of the machine parameters %s", value[6]);
    if (value[7]) text_add(&t, "; the claim holds in %s of the samples", value[7]);
    text_add(&t, ". In detail: %s.", value[5]);
    page_paragraph(c->page, t.s);
    text_free(&t);
    return true;
}

/* Only failed claims: what a reader of the paper wants to know. */
static bool contradictions(struct chapter *c)
{
    page_heading(c->page, 2, "Where the model contradicts the paper");
    page_paragraph(c->page,
                   "The paper gives no numbers for its figures, its machines were shared with "
                   "other users, and its serial baseline is not fully specified. Each claim is "
                   "therefore tested for every serial baseline, with structured and with dense "
                   "operators. The variant closest to the text of the paper determines the "
                   "verdict. \"Judged\" gives the reason for that variant, and the tolerance.");
    return store_select(
        c->d->store,
        "SELECT id, statement, test, iif(value IS NULL, NULL, format('%.4g', value)), unit, note, "
        "iif(samples > 0 AND value_low IS NOT NULL, format('%.3g to %.3g', value_low, value_high), "
        "NULL), iif(share IS NULL, NULL, format('%d %%', round(100 * share))), judged FROM claim "
        "WHERE variant = '' AND "
        "verdict = 'fail'" IN_ORDER,
        0, NULL, tell_claim, c, c->e);
}

/* The estimates were made by hand before; the query compares them with what was simulated. */
static bool estimates(struct chapter *c)
{
    struct text path = {0}, sql = {0};
    text_add(&path, "%s/plots/estimates.sql", c->d->data_dir);
    page_heading(c->page, 2, "Analytic estimates, confirmed or refuted");
    page_paragraph(c->page,
                   "The claims were estimated analytically before they were simulated. The table "
                   "compares the two.");
    bool ok = text_read_file(&sql, path.s, c->e) && table(c, sql.s, "No claim has been judged.");
    text_free(&path);
    text_free(&sql);
    return ok;
}

/* --- all claims ------------------------------------------------------------------------------- */

/* All claims as one table, with what the samples say. */
static bool claims(struct chapter *c)
{
    page_heading(c->page, 2, "The claims");
    page_paragraph(c->page,
                   "Share: the fraction of the samples in which a claim holds. Each sample draws "
                   "all machine parameters that have a published range from log-uniform "
                   "distributions and repeats the simulation, at fewer points than the study. A "
                   "value over many points may therefore lie outside its range.");
    return table(
        c,
        "SELECT id, verdict, iif(value IS NULL, '', format('%.4g', value)) AS value, threshold, "
        "unit, iif(samples > 0 AND value_low IS NOT NULL, format('%.3g to %.3g', value_low, "
        "value_high), '') AS range, iif(share IS NULL, '', format('%d %%', round(100 * share))) AS "
        "share, iif(testable > 0, holding || ' of ' || testable, '') AS holds_in_variants, test"
        " FROM claim WHERE variant = ''" IN_ORDER,
        "No claim has been judged.");
}

/* Each claim for all variants: the verdict may depend on the serial baseline, and here a reader
 * sees how. */
static bool tell_variants(void *context, int ncolumn, const char *const *name,
                          const char *const *value)
{
    struct chapter *c = context;
    struct text t = {0};
    (void)ncolumn;
    (void)name;
    text_add(&t, "%s: %s", value[0], value[1]);
    page_heading(c->page, 3, t.s);
    text_free(&t);
    text_add(&t, "Test: %s. Value: %s. Judged: %s", value[2], value[3], value[4]);
    page_paragraph(c->page, t.s);
    text_free(&t);
    return page_table(
        c->page, c->d->store,
        /* A variant's note is its own: which runs it lacks, or what its value is made of. */
        "SELECT variant, verdict, iif(value IS NULL, '', format('%.4g', value)) AS value, "
        "iif(samples > 0 AND value_low IS NOT NULL, format('%.3g to %.3g', value_low, value_high), "
        "'') AS range, iif(share IS NULL, '', format('%d %%', round(100 * share))) AS share, note "
        "FROM claim WHERE id = ?1 AND variant <> '' ORDER BY variant",
        1, value, "No run is stored for this claim.", c->e);
}

/* All claims again, one after the other. */
static bool variants(struct chapter *c)
{
    page_heading(c->page, 2, "Each claim for each baseline");
    static const char sql[] =
        "SELECT id, statement, test, unit, judged FROM claim WHERE variant = ''" IN_ORDER;
    /* A row's function stops the query by false; whether that was an error, *e tells. */
    return store_select(c->d->store, sql, 0, NULL, tell_variants, c, c->e) &&
           c->e->kind == ERR_NONE;
}

/* --- figures ---------------------------------------------------------------------------------- */

/* The comment that opens NAME.sql as the figure's caption, without the lines for the program; the
 * first part of a query that has several ends it. */
static void caption(const char *sql, struct text *out)
{
    while (strncmp(sql, "-- ", 3) == 0 && strncmp(sql, "-- shared:", 10) != 0) {
        size_t n = strcspn(sql, "\n");
        if (strncmp(sql, "-- needs:", 9) != 0 && strncmp(sql, "-- each:", 8) != 0) {
            if (out->length) text_add(out, " ");
            text_add_bytes(out, sql + 3, n - 3);
        }
        sql += n + (sql[n] == '\n');
    }
}

/* Figures in the order of the study. One that was not drawn is told as such (page_figure). */
static bool figures(struct chapter *c)
{
    /* An empty chapter appears in the report on the paper only, where it means that something is
     * missing. */
    if (!c->d->whole && c->d->nfigure == 0) return true;
    page_heading(c->page, 2, "Figures");
    for (int i = 0; i < c->d->nfigure; i++) {
        struct text path = {0}, sql = {0}, words = {0};
        text_add(&path, "%s/plots/%s.sql", c->d->data_dir, c->d->figure[i]);
        bool ok = text_read_file(&sql, path.s, c->e);
        if (ok) {
            caption(sql.s, &words);
            page_figures(c->page, c->d->store, c->d->figure[i], words.s ? words.s : "");
        }
        text_free(&path);
        text_free(&sql);
        text_free(&words);
        if (!ok) return false;
    }
    return true;
}

/* --- machines, accuracy, the rest ------------------------------------------------------------- */

/* Every parameter with the evidence for it: a prediction is no better than these numbers. */
static bool machines(struct chapter *c)
{
    /* Parameters come sorted by machine: one table each. */
    static const char *const head[] = {"key", "value", "range", "evidence", "source"};
    if (!c->d->whole && c->d->nparameter == 0) return true;
    page_heading(c->page, 2, "The machines");
    page_paragraph(c->page,
                   "Evidence: P published and checked in the source, PR published but quoted from "
                   "memory, D derived, E estimated. The uncertain parameters are those with a "
                   "range.");
    const char *machine = "";
    for (int i = 0; i < c->d->nparameter; i++) {
        const struct document_parameter *p = &c->d->parameter[i];
        const char *const cell[] = {p->key, p->value, p->range, p->evidence, p->source};
        /* A new machine begins a new table. */
        if (strcmp(machine, p->machine) != 0) {
            page_table_end(c->page);
            page_heading(c->page, 3, p->machine);
            page_row(c->page, true, 5, head);
            machine = p->machine;
        }
        page_row(c->page, false, 5, cell);
    }
    page_table_end(c->page);
    return true;
}

/* Errors of the numbers that the simulated processors computed, over all runs; then whether all
 * simulated time is accounted for. */
static bool numerics(struct chapter *c)
{
    page_heading(c->page, 2, "Accuracy of the numerics");
    page_paragraph(c->page,
                   "The simulated processors compute actual numbers. The result of each run is "
                   "compared with that of a serial code. The errors are relative, and the largest "
                   "of all runs.");
    if (!table(
            c,
            /* The largest error beside the largest tolerance: a failed check shows in the last
             * column. A program without bodies has no formulation and solver. */
            "SELECT e.kernel, iif(r.nu > 0, e.formulation, '') AS formulation, iif(r.nu > 0, "
            "e.solver, '') AS solver, iif(r.nu > 0, e.precision, '') AS precision, quantity, "
            "reference, count(*) AS runs, max(e.n) AS largest_n, format('%.1e', "
            "max(relative_error)) AS largest_error, format('%.1e', max(tolerance)) AS "
            "largest_tolerance, count(*) - sum(passed) AS failed FROM v_errors e JOIN run r ON "
            "r.id = e.run_id GROUP BY 1, 2, 3, 4, 5, 6",
            "No run is stored."))
        return false;
    page_paragraph(c->page,
                   "All simulated time is accounted for, to the picosecond: computing, sending, "
                   "receiving, waiting and contention of all ranks add up to P times the run "
                   "time.");
    return table(c,
                 /* Sums over all ranks, exact in picoseconds: any difference is a mistake of the
                  * simulator. */
                 "SELECT count(*) AS runs, sum(difference_ps <> 0) AS runs_that_do_not_add_up,"
                 " max(abs(difference_ps)) AS largest_difference_ps FROM v_accounting",
                 "No run is stored.");
}

/* What no run of this database contains: failed runs, serial codes that were too slow,
 * contention at cheap levels, packets; then the program's own omissions. */
static bool left_out_of_runs(struct chapter *c)
{
    return table(c,
                 /* A line per kind, with how many runs it concerns. */
                 "SELECT 'failed runs' AS what, count(*) AS runs, ifnull(group_concat(DISTINCT "
                 "status), '') AS which  FROM run WHERE status <> 'ok' UNION ALL SELECT 'serial "
                 "composite-body code: O(n^3), not run', count(*), format('n from %d to %d', "
                 "min(n), max(n)) FROM run r  WHERE status = 'ok' AND kernel = 'dynamics'  AND NOT "
                 "EXISTS (SELECT 1 FROM baseline b WHERE b.run_id = r.id AND b.name LIKE '%crba') "
                 "GROUP BY 1 UNION ALL SELECT 'contention, level ' || level, "
                 "count(*), group_concat(DISTINCT scenario) FROM run  WHERE level = 'loggp' GROUP "
                 "BY level UNION ALL SELECT 'packets and flits: messages hold whole links, level ' "
                 "|| level, count(*),  group_concat(DISTINCT scenario) FROM run WHERE level = "
                 "'link' GROUP BY level UNION ALL SELECT 'single links and routes of the "
                 "machine''s own traffic are not stored', count(*), '' FROM run WHERE links = 0",
                 "Nothing.") &&
           table(c,
                 /* The program's own omissions, each with its reason. */
                 "SELECT what, why, class || iif(max(bound) IS NULL, '', format(' %.0e', "
                 "max(bound))) AS class, count(*) AS runs FROM run_omission GROUP BY what, why, "
                 "class ORDER BY runs DESC, what",
                 "No run has omissions.");
}

/* In a report of a part of the study the chapter appears only if there is something in it. */
static bool omissions(struct chapter *c)
{
    bool runs, savings;
    if (!findings_any(c->d->store, "SELECT 1 FROM run LIMIT 1", &runs, c->e) ||
        !findings_any(c->d->store, "SELECT 1 FROM omission LIMIT 1", &savings, c->e))
        return false;
    if (!c->d->whole && !runs && !savings) return true;
    page_heading(c->page, 2, "Omissions");
    if ((c->d->whole || runs) && !left_out_of_runs(c)) return false;
    return findings_savings(c->page, c->d->store, c->e);
}

/* Time of this command is 0 when it ran nothing. */
static bool effort(struct chapter *c)
{
    struct text t = {0};
    page_heading(c->page, 2, "Run time on this computer");
    text_add(&t, "The command that wrote this report took %.1f s, without the runs that were "
                 "stored before.",
             c->d->host_s);
    if (c->d->host_s > 0) page_paragraph(c->page, t.s);
    text_free(&t);
    return table(
        c,
        /* Host times of all scenarios, of all together, and of the samples, whose runs are not
         * stored. */
        "SELECT scenario, count(*) AS runs, max(P) AS largest_P, sum(events) AS events, "
        "format('%.2f', sum(host_s)) AS simulating_s, format('%.2f', sum(host_total_s)) AS "
        "in_all_s, format('%.0f', max(host_peak_bytes) / 1e6) AS peak_MB FROM run GROUP BY "
        "scenario UNION ALL SELECT 'all', count(*), max(P), sum(events), format('%.2f', "
        "sum(host_s)), format('%.2f', sum(host_total_s)), format('%.0f', max(host_peak_bytes) / "
        "1e6) FROM run UNION ALL SELECT 'samples, wall time', (SELECT count(DISTINCT sample) FROM "
        "claim_sample), NULL, NULL, NULL, value, NULL FROM meta WHERE key = 'samples_s'",
        "No run is stored.");
}

/* Which programs made the runs, and hashes that change when a setting or a result does. */
static bool provenance(struct chapter *c)
{
    page_heading(c->page, 2, "Provenance");
    if (!table(c,
               /* By program: a database may have runs of several versions. */
               "SELECT 'mimdsim ' || version AS program, git, compiler, flags, count(*) AS runs,"
               " min(created_utc) AS first_run, max(created_utc) AS last_run FROM v_provenance"
               " GROUP BY 1, 2, 3, 4",
               "No run is stored."))
        return false;
    return table(c,
                 /* Least and largest hash of a scenario: not a proof of equality, but enough to
                  * see a difference. */
                 "SELECT scenario, count(*) AS runs, group_concat(DISTINCT machine) AS machines,"
                 " substr(min(config_hash), 1, 12) || ' ... ' || substr(max(config_hash), 1, 12)"
                 " AS configurations,"
                 " min(digest) || ' ... ' || max(digest) AS digests FROM run GROUP BY scenario",
                 "No run is stored.");
}

/* The order of the report: verdicts, reasons, evidence, then what it is based on. `whole`: the
 * report on the paper, in which an empty chapter is told as empty; others leave it out. */
static bool chapters(struct chapter *c)
{
    const struct document *d = c->d;
    bool claimed, run;
    if (!findings_any(d->store, "SELECT 1 FROM claim LIMIT 1", &claimed, c->e) ||
        !findings_any(d->store, "SELECT 1 FROM run LIMIT 1", &run, c->e))
        return false;
    /* The report on the paper tells what is missing. */
    claimed = claimed || d->whole;
    run = run || d->whole;
    if (claimed && !opening_abstract(c->page, d->store, d->data_dir, c->e)) return false;
    page_contents(c->page);
    return (!claimed || (contradictions(c) && explanations_section(c->page, d->store, c->e) &&
                         estimates(c) && claims(c))) &&
           (d->whole || runs_section(c->page, d->store, c->e)) && figures(c) &&
           findings_accuracy(c->page, d->store, c->e) &&
           findings_stability(c->page, d->store, c->e) && (!claimed || variants(c)) &&
           machines(c) && (!run || numerics(c)) && omissions(c) &&
           (!run || (effort(c) && provenance(c))) &&
           (!claimed || opening_glossary(c->page, d->store, d->data_dir, c->e));
}

bool document_write(const struct document *d, struct err *e)
{
    struct page page = {.data_dir = d->data_dir};
    /* The report lies beside its folder of figures, so that links are short: its folder is the
     * path above, without trailing slashes. */
    char *figures_folder = memory_text(d->figures);
    for (size_t n = strlen(figures_folder); n > 1 && figures_folder[n - 1] == '/'; n--)
        figures_folder[n - 1] = '\0';
    char *slash = strrchr(figures_folder, '/');
    struct text folder = {0};
    if (slash)
        text_add(&folder, "%.*s", slash == figures_folder ? 1 : (int)(slash - figures_folder),
                 figures_folder);
    else text_add(&folder, ".");
    struct chapter c = {d, &page, e};
    page.figures = figures_folder;
    bool ok = page_open(&page, d->title, e) && chapters(&c);
    /* Half a report is none: the files of an earlier one stay. */
    ok = page_close(&page, folder.s, d->name, ok, e) && ok;
    text_free(&folder);
    free(figures_folder);
    return ok;
}
