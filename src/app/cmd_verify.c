/* cmd_verify.c - mimdsim verify: every algorithm against reference vectors computed by other
 * people's programs.
 *
 * Nothing in a file can make it pass: tolerances follow from the condition of each number, and
 * unknown keys are refused. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/verb.h"
#include "base/check.h"
#include "base/memory.h"
#include "base/progress.h"
#include "study/verify.h"

static const char doc[] =
    "Run every applicable serial and parallel algorithm, with every solver and several numbers of "
    "ranks, on reference vectors (dynref-1 JSON). The tolerance of each number takes into account "
    "how much rounding of the inputs changes it.\n"
    "\nExample: mimdsim verify tests/data/vectors/*.json\n\vVerdicts: pass; rounding: the error "
    "exceeds the tolerance in working precision, but not in quad precision; algorithm-fails: it "
    "does in quad precision too, although the reference value is confirmed and the algorithm is "
    "correct for the same scene with equal masses (the text names an alternative); fail; "
    "not-applicable.\n\nExit status: 1 if a row fails or no algorithm passes for a quantity, with "
    "--strict also for algorithm-fails; 65 for a file with an unknown key, a missing result, or "
    "the name of a URDF file that does not exist.\n\nRelative tolerances: 1e-12 for inverse and "
    "1e-10 for forward dynamics (single precision: 1e-4 and 1e-3), multiplied by the condition of "
    "each number. Nothing in the file changes them.";

enum {
    KEY_TOLERANCE = 0x200, /* beyond letters, and apart from the keys of common.c */
    KEY_SERIAL,
    KEY_ALL_RANKS,
    KEY_BRIEF,
    KEY_PRECISION,
    KEY_MARKDOWN,
    KEY_JSON_OUT,
    KEY_STRICT
};

/* Options of this verb alone: it takes no scenario and no database, so it has a parser of its
 * own. */
static const struct argp_option options[] = {
    {"tolerance", KEY_TOLERANCE, "X[,Y]", 0,
     "relative tolerance of inverse (X) and forward (Y, default 100 X) dynamics", 0},
    {"serial", KEY_SERIAL, NULL, 0, "serial algorithms only", 0},
    {"all-ranks", KEY_ALL_RANKS, NULL, 0,
     "run large cases too on P = 1, 2, 3, n/2, n, and with the mass matrix", 0},
    {"strict", KEY_STRICT, NULL, 0, "exit status 1 also for the verdict algorithm-fails", 0},
    {"precision", KEY_PRECISION, "double|float|quad", 0,
     "precision of the algorithms (default double)", 0},
    {"brief", KEY_BRIEF, NULL, 0, "one line per case; rows only if they do not pass", 0},
    {"markdown", KEY_MARKDOWN, NULL, 0, "a table of errors in Markdown", 0},
    {"json", KEY_JSON_OUT, NULL, 0, "write one JSON document to standard output", 0},
    {"quiet", 'q', NULL, 0, "no progress", 0},
    {0},
};

/* The command line. */
struct request {
    struct verify_options options;
    struct common common; /* json, quiet */
    bool brief, markdown, strict; /* forms of the report; whether a weakness fails, too */
    const char **file; /* (nfile) borrowed from argv */
    int nfile; /* at least 1 after parsing */
};

/* "X" or "X,Y". Y is 100 X where it is not given, as in the defaults: accelerations come from a
 * linear system. */
static void set_tolerance(struct request *r, const char *arg, struct argp_state *state)
{
    /* A missing Y keeps the ratio of the defaults, 1e-12 and 1e-10. */
    char *end;
    double x = strtod(arg, &end), y = 100 * x;
    if (*end == ',') y = strtod(end + 1, &end);
    /* The whole word must be used up, so that "1e-9x" is refused; NAN fails both comparisons. */
    if (*end || end == arg || !(x > 0) || !(y > 0))
        argp_error(state, "--tolerance: '%s' is not a positive number", arg);
    r->options.tolerance_inverse = x;
    r->options.tolerance_forward = y;
}

/* Precisions are counted as in enum precision. */
static void set_precision(struct request *r, const char *arg, struct argp_state *state)
{
    static const char *const word[] = {"double", "float", "quad"};
    for (int i = 0; i < 3; i++)
        if (strcmp(arg, word[i]) == 0) {
            r->options.precision = (enum precision)i;
            return;
        }
    argp_error(state, "--precision: '%s' is not double, float or quad", arg);
}

/* One key of argp; errors end the process with the usage status. */
static error_t parse(int key, char *arg, struct argp_state *state)
{
    struct request *r = state->input;
    switch (key) {
    /* numbers and words are checked by functions of their own, which end the process */
    case KEY_TOLERANCE:
        set_tolerance(r, arg, state);
        break;
    case KEY_PRECISION:
        set_precision(r, arg, state);
        break;
    case KEY_SERIAL:
        r->options.parallel = false;
        break;
    case KEY_ALL_RANKS:
        r->options.all_ranks = true;
        break;
    case KEY_STRICT:
        r->strict = true;
        break;
    case KEY_BRIEF:
        r->brief = true;
        break;
    case KEY_MARKDOWN:
        r->markdown = true;
        break;
    case KEY_JSON_OUT:
        r->common.json = true;
        break;
    case 'q':
        r->common.quiet = true;
        break;
    /* r->file has room for all words of the command line. */
    case ARGP_KEY_ARG:
        r->file[r->nfile++] = arg;
        break;
    case ARGP_KEY_NO_ARGS:
        argp_error(state, "a reference file is missing");
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

/* Three forms, one at a time: a document, a matrix in Markdown, tables. */
static void print_all(const struct request *r, const struct verify_report *report)
{
    if (r->common.json) {
        verify_print_json(stdout, report, r->nfile);
        return;
    }
    if (r->markdown) {
        verify_print_matrix(stdout, report, r->nfile);
        return;
    }
    for (int i = 0; i < r->nfile; i++) verify_print(stdout, &report[i], r->brief);
    verify_print_summary(stdout, report, r->nfile);
}

/* Verifies every file. One that cannot be used is a failed case without rows; the others are
 * verified all the same. Returns the exit status of the first such file, 0: none. */
static int verify_all(const struct request *r, struct verify_report *report, struct arena *a)
{
    struct progress p = progress_make("cases", r->nfile, r->common.quiet);
    int status = 0;
    for (int i = 0; i < r->nfile; i++) {
        struct err e;
        err_clear(&e);
        /* The report has a row for every file, or numbers of the summary would not add up. */
        if (!verify_file(r->file[i], &r->options, a, &report[i], &e)) {
            /* err_print and the text: *e lives only in this loop. */
            const char *text = arena_text(a, e.text);
            err_print(&e);
            /* The columns need texts and numbers: empty ones, and NAN for what is not known. */
            report[i] = (struct verify_report){.path = r->file[i],
                                               .name = r->file[i],
                                               .group = "",
                                               .peer_id_name = "",
                                               .peer_fd_name = "",
                                               .floor_id = NAN,
                                               .floor_fd = NAN,
                                               .peer_id = NAN,
                                               .peer_fd = NAN};
            snprintf(report[i].text, sizeof report[i].text, "cannot be used: %s", text);
            if (status == 0) status = err_exit_status(e.kind);
        }
        progress_show(&p, i + 1);
    }
    progress_end(&p);
    return status;
}

/* Whether any row fails its case or, with --strict, shows an algorithm that fails. */
static bool any_failed(const struct request *r, const struct verify_report *report)
{
    for (int i = 0; i < r->nfile; i++) {
        if (!report[i].passed) return true;
        for (int k = 0; k < report[i].nrow && r->strict; k++)
            if (report[i].row[k].verdict == VERIFY_ALGORITHM_FAILS) return true;
    }
    return false;
}

/* Files in the order of the command line; the arena holds all reports until they are printed. */
int cmd_verify(int argc, char **argv)
{
    struct request r = {.options = {.parallel = true},
                        .file = memory_zeroed((size_t)argc, sizeof *r.file)};
    static const struct argp argp = {
        .options = options, .parser = parse, .args_doc = "FILE.json...", .doc = doc};
    /* Anything else than wrong usage, which ends the process, is a lack of memory. */
    if (argp_parse(&argp, argc, argv, 0, NULL, &r) != 0) check_memory(0);
    struct arena *a = arena_create();
    struct verify_report *report = TAKE(a, r.nfile, struct verify_report);
    /* All files first, then the report: JSON is one document. */
    int status = verify_all(&r, report, a);
    bool failed = any_failed(&r, report);
    print_all(&r, report);
    arena_destroy(a);
    free(r.file);
    /* A file that cannot be read is worse than a failed case. */
    return status ? status : failed ? err_exit_status(ERR_CHECK) : 0;
}
