/* cmd_check.c - mimdsim check: validate scenario and machine files without running, databases by
 * their own rows.
 *
 * All files are checked, whatever the first one is like: a user wants the list of mistakes, not
 * the first of them. What kind a file is follows from its content. */
#include "app/verb.h"
#include <stdlib.h>
#include <string.h>

#include "app/flag.h"
#include "base/json.h"
#include "measure/column.h"
#include "plan/file_kind.h"
#include "study/audit.h"
#include "study/model_file.h"
#include "study/probe.h"

/* The text before \v stands above the options in --help, the rest below them (argp). */
static const char doc[] =
    "Validate scenario, machine, robot (.urdf) and reference vector (.json) files without running "
    "anything (networks are built, and models); and databases, whose rows must not contradict each "
    "other.\n\n"
    "Example: mimdsim check scenarios/speedup-t3e.yaml machines/t3e-300.yaml\n"
    "         mimdsim check mimdsim.db --again 5\n"
    "\vAll files are checked; the exit status is that of the first invalid one. A warning on "
    "standard error names a machine on which a message is faster than one that is a byte smaller "
    "(where a segment of its message software begins).\n\n"
    "Of a database: the times of ranks add up to those of stages, these to the makespan; columns "
    "and identity are those of the stored configuration; checks passed where the error is within "
    "the tolerance; serial codes take what their operations cost; views are those of this program. "
    "--again K also makes K of its runs again (`all`: every run), chosen at random by --seed S "
    "(default 1), and compares every stored number that does not depend on this computer, bit by "
    "bit. Each contradiction is printed with its run and rule; the exit status is then 1.";

/* A contradiction in JSON. */
#define FINDING(member) .offset = offsetof(struct audit_finding, member)
static const struct column finding_column[] = {
    {"rule", COLUMN_STRING, FINDING(rule), .doc = "that the rows break"},
    {"run", COLUMN_INT64, FINDING(run), .doc = "its row in table run, 0: none"},
    {"text", COLUMN_STRING, FINDING(text), .doc = "what contradicts what"},
};
static const struct column_table finding_columns = COLUMNS(finding_column);

/* A database that could be read: the keys that common_error_json has for any file, and what was
 * found. */
struct audited {
    const char *file, *kind, *text;
    int exit_status, line;
    const struct audit_report *report;
};

/* The contradictions that were found; at most AUDIT_KEPT of them. */
static void json_findings(const struct column *c, const void *row, struct json *j)
{
    (void)c;
    const struct audit_report *r = ((const struct audited *)row)->report;
    const int n = r->nfinding < AUDIT_KEPT ? (int)r->nfinding : AUDIT_KEPT;
    columns_json_list(&finding_columns, r->finding, n, sizeof *r->finding, j);
}

#define AUDITED(member) .offset = offsetof(struct audited, member)
#define REPORT(member)                                                                             \
    .part = PART(struct audited, report), .offset = offsetof(struct audit_report, member)
static const struct column audited_column[] = {
    {"contradictions", COLUMN_INT64, REPORT(nfinding), .doc = "how many were found"},
    {"exit_status", COLUMN_INT, AUDITED(exit_status), .doc = "of this file"},
    {"file", COLUMN_STRING, AUDITED(file), .doc = "as it was named"},
    {"findings", COLUMN_STRING, .json = json_findings, .doc = "the first contradictions"},
    {"kind", COLUMN_STRING, AUDITED(kind), .doc = "of the error"},
    {"line", COLUMN_INT, AUDITED(line), .doc = "of the error in the file, 0: none"},
    {"made_again", COLUMN_INT, REPORT(nagain), .doc = "runs that were made again"},
    {"not_made_again", COLUMN_INT, REPORT(nleft), .doc = "chosen runs that could not be"},
    {"runs", COLUMN_INT64, REPORT(nrun), .doc = "in the database"},
    {"text", COLUMN_STRING, AUDITED(text), .doc = "of the error"},
};
static const struct column_table audited_columns = COLUMNS(audited_column);

static void print_database(struct json *j, const char *file, const struct err *e,
                           const struct audit_report *r)
{
    const struct audited row = {.file = file,
                                .kind = err_word(e->kind),
                                .text = e->kind == ERR_NONE ? "" : e->text,
                                .exit_status = err_exit_status(e->kind),
                                .line = e->line,
                                .report = r};
    columns_json(&audited_columns, &row, j);
}

/* Whether all segments of the message software were measured, as `mimdsim calibrate` writes. */
static bool is_measured(const struct origin *origin, int n)
{
    bool measured = false;
    for (int i = 0; i < n; i++)
        measured = measured || (strcmp(origin[i].key, "software.segments") == 0 &&
                                strcmp(origin[i].evidence, "measured") == 0);
    return measured;
}

/* Steps of the message software that go down: a message that is faster than one a byte smaller.
 * They may be meant, as where a protocol is switched too late, so this is a warning. Of a measured
 * machine it is a remark: nobody meant anything. */
static void tell_steps_down(const char *file)
{
    struct machine_spec m;
    struct software_segment list[SOFTWARE_MAX_SEGMENTS];
    struct err e;
    struct arena *a = arena_create();
    /* "./" in front: a name without a slash would be looked up among the shipped machines. */
    struct text path = {0};
    err_clear(&e);
    text_add(&path, "%s%s", strchr(file, '/') == NULL ? "./" : "", file);
    /* Only machine files have segments; of a scenario n is 0. */
    struct origin *origin = NULL;
    int norigin = 0;
    const int n = plan_machine(&m, path.s, NULL, a, &origin, &norigin, &e)
                      ? software_segments(&m.software, list)
                      : 0;
    const char *end =
        n > 0 && is_measured(origin, norigin) ? ", as measured" : ": is this intended?";
    for (int i = 1; i < n; i++) {
        /* The last size of one segment and the first of the next. */
        double below, at, size = (double)list[i].from;
        if (!probe_measure(&m, PROBE_ONE_WAY, size - 1, 0, &below, &e) ||
            !probe_measure(&m, PROBE_ONE_WAY, size, 0, &at, &e))
            break;
        if (at < below)
            fprintf(stderr, "%s: a message of %.0f B takes %.4g us, one of %.0f B only %.4g us%s\n",
                    file, size - 1, below * 1e6, size, at * 1e6, end);
    }
    text_free(&path);
    arena_destroy(a);
}

/* Contradictions on the terminal; all are in the document. */
enum { SHOWN = 50 };

/* The first contradictions on standard error. Any of them makes the file invalid: *e is set, and
 * the return value false. */
static bool tell_findings(const char *file, const struct audit_report *r, struct err *e)
{
    /* The first ones are enough to act on; --json has more. */
    const int n = r->nfinding < SHOWN ? (int)r->nfinding : SHOWN;
    for (int i = 0; i < n; i++) {
        const struct audit_finding *f = &r->finding[i];
        fprintf(stderr, "%s: ", file);
        if (f->run) fprintf(stderr, "run %lld: ", (long long)f->run);
        fprintf(stderr, "%s: %s\n", f->rule, f->text);
    }
    if (r->nfinding > n) fprintf(stderr, "%s: and %lld more\n", file, (long long)r->nfinding - n);
    return r->nfinding == 0 || err_set(e, ERR_CHECK, "%s: %lld contradictions in %lld runs", file,
                                       (long long)r->nfinding, (long long)r->nrun);
}

/* One line of a database in order, with how many of its runs were made again. */
static void tell_database(const char *file, const struct audit_report *r)
{
    printf("%s: ok: %lld runs, %d rules", file, (long long)r->nrun, r->nrule);
    if (r->nagain + r->nleft > 0) printf("; %d runs made again, equal in every bit", r->nagain);
    if (r->nleft > 0) printf("; %d cannot be made from their row alone", r->nleft);
    putchar('\n');
}

/* Whether the rows of database `file` agree; *r is filled when it could be read. */
static bool check_database(const char *file, const struct audit_options *o, struct arena *a,
                           struct audit_report **report, struct err *e)
{
    /* The report has room for AUDIT_KEPT findings: too large for the stack. */
    struct audit_report *r = TAKE(a, 1, struct audit_report);
    /* An older database is audited in an upgraded copy: the rules are those of this version. */
    struct store *s = store_open(file, STORE_READ, e);
    if (s && store_remark(s) && !o->quiet) fprintf(stderr, "mimdsim: %s\n", store_remark(s));
    bool ok = s && audit_database(s, o, a, r, e);
    store_close(s);
    if (ok) *report = r;
    return ok && tell_findings(file, r, e);
}

/* One file of any kind; *report stays NULL where it is no database. Returns whether it is valid;
 * *e has the reason. */
static bool check_file(const struct common *c, const char *file, const struct audit_options *audit,
                       struct arena *a, struct audit_report **report, struct err *e)
{
    const struct plan_options o = common_plan(c);
    if (file_kind_of(file, a) == FILE_DATABASE) {
        const bool fine = check_database(file, audit, a, report, e);
        if (fine && !c->quiet && !c->json) tell_database(file, *report);
        return fine;
    }
    const bool model = model_file_is(file);
    /* Models are built, and the networks of scenarios and machines: nothing is run in any case. */
    const bool fine = model ? model_file_check(file, c->quiet ? NULL : stderr, e)
                            : plan_check_file(file, &o, e);
    if (fine && !c->quiet && !c->json) printf("%s: ok\n", file);
    if (fine && !c->quiet && !model) tell_steps_down(file);
    return fine;
}

/* --again K and --seed S. Returns false with *e set for what is no number. */
static bool read_options(const char *again, const char *seed, struct audit_options *o,
                         struct err *e)
{
    char *end;
    if (again && strcmp(again, "all") == 0) o->again = AUDIT_ALL;
    else if (again) {
        const long n = strtol(again, &end, 10);
        if (end == again || *end || n < 0 || n > 1000000000)
            return err_set(e, ERR_USAGE, "--again: '%s' is not a number of runs, nor 'all'", again);
        o->again = (int)n;
    }
    if (!seed) return true;
    o->seed = strtoull(seed, &end, 10);
    /* strtoull would take "-1" for a large number. */
    return (end != seed && !*end && *seed != '-') ||
           err_set(e, ERR_USAGE, "--seed: '%s' is not a whole number", seed);
}

/* Returns the exit status of the first invalid file. */
int cmd_check(int argc, char **argv)
{
    struct common c;
    struct err e;
    struct audit_options audit = {.seed = 1};
    /* Options of this verb alone are taken before argp reads the rest. */
    const char *again = take_value(&argc, argv, "--again"),
               *seed = take_value(&argc, argv, "--seed");
    common_parse(&c, argc, argv, TAKES_JOBS, "FILE...", doc, 1, 64);
    err_clear(&e);
    if (!read_options(again, seed, &audit, &e)) return common_fail(&c, &e);
    /* What all databases share; each file has an error of its own below. */
    audit.jobs = c.jobs;
    audit.quiet = c.quiet;
    struct json j = json_make(stdout);
    int status = 0;
    if (c.json) json_array(&j);
    for (int i = 0; i < c.narg; i++) {
        struct arena *a = arena_create();
        struct audit_report *report = NULL;
        err_clear(&e);
        const bool fine = check_file(&c, c.arg[i], &audit, a, &report, &e);
        if (c.json && report) print_database(&j, c.arg[i], &e, report);
        else if (c.json) common_error_json(&j, c.arg[i], &e);
        if (!fine) err_print(&e);
        if (!status) status = err_exit_status(e.kind);
        arena_destroy(a);
    }
    if (c.json) {
        json_end(&j);
        json_finish(&j);
    }
    return status;
}
