/* cmd_verify.c - mimdsim verify: every algorithm against reference vectors computed by other people's programs. */
#include <stdlib.h>
#include <string.h>

#include "app/verb.h"
#include "base/check.h"
#include "base/progress.h"
#include "run/verify.h"

static const char doc[] =
    "Run every applicable serial and parallel algorithm, with every solver and several numbers of ranks, on reference\n"
    "vectors (dynref-1 JSON) and judge the relative errors. Exit status 1 when a case fails.\n\n"
    "Example: mimdsim verify tests/data/vectors/*.json\n\v"
    "Tolerances: 1e-12 for inverse and 1e-10 for forward dynamics, raised to what rounding of the inputs and the best "
    "of the libraries quoted in the file allow.";

enum { KEY_TOLERANCE = 0x200, KEY_SERIAL, KEY_ALL_RANKS, KEY_BRIEF, KEY_PRECISION, KEY_MARKDOWN, KEY_JSON_OUT };

static const struct argp_option options[] = {
    {"tolerance", KEY_TOLERANCE, "X[,Y]", 0,
     "relative tolerance of inverse (X) and forward (Y, default 100 X) dynamics", 0},
    {"serial", KEY_SERIAL, NULL, 0, "serial algorithms only", 0},
    {"all-ranks", KEY_ALL_RANKS, NULL, 0, "large cases too on P = 1, 2, 3, n/2, n", 0},
    {"precision", KEY_PRECISION, "double|float|quad", 0, "of the algorithms (default double)", 0},
    {"brief", KEY_BRIEF, NULL, 0, "one line a case; rows only where they do not pass", 0},
    {"markdown", KEY_MARKDOWN, NULL, 0, "one table of errors, for documents", 0},
    {"json", KEY_JSON_OUT, NULL, 0, "answer with one JSON document on standard output", 0},
    {"quiet", 'q', NULL, 0, "no progress", 0},
    {0},
};

struct request {
    struct verify_options options;
    struct common common; /* json, quiet */
    bool brief, markdown;
    const char **file;
    int nfile;
};

static void set_tolerance(struct request *r, const char *arg, struct argp_state *state)
{
    char *end;
    double x = strtod(arg, &end), y = 100 * x;
    if (*end == ',') y = strtod(end + 1, &end);
    if (*end || end == arg || !(x > 0) || !(y > 0))
        argp_error(state, "--tolerance: '%s' is not a positive number", arg);
    r->options.tolerance_inverse = x;
    r->options.tolerance_forward = y;
}

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

static error_t parse(int key, char *arg, struct argp_state *state)
{
    struct request *r = state->input;
    switch (key) {
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

static bool verify_all(const struct request *r, struct verify_report *report, struct arena *a, struct err *e)
{
    struct progress p = progress_make("cases", r->nfile, r->common.quiet);
    for (int i = 0; i < r->nfile; i++) {
        if (!verify_file(r->file[i], &r->options, a, &report[i], e)) return false;
        progress_show(&p, i + 1);
    }
    progress_end(&p);
    return true;
}

int cmd_verify(int argc, char **argv)
{
    struct request r = {.options = {.parallel = true}, .file = calloc((size_t)argc, sizeof *r.file)};
    CHECK(r.file);
    static const struct argp argp = {.options = options, .parser = parse, .args_doc = "FILE.json...", .doc = doc};
    argp_parse(&argp, argc, argv, 0, NULL, &r);
    struct err e;
    err_clear(&e);
    struct arena *a = arena_create();
    struct verify_report *report = TAKE(a, r.nfile, struct verify_report);
    bool ok = verify_all(&r, report, a, &e);
    int failed = 0;
    for (int i = 0; ok && i < r.nfile; i++) failed += !report[i].passed;
    if (ok) print_all(&r, report);
    arena_destroy(a);
    free(r.file);
    if (!ok) return common_fail(&r.common, &e);
    return failed ? err_exit_status(ERR_CHECK) : 0;
}
