/* cmd_netcheck.c - mimdsim netcheck: the network levels against files of reference answers.
 *
 * The verdict is about this program: answers outside of the stated accuracy end with status 1,
 * so that the verb can be used as a test. */
#include <stdlib.h>
#include <string.h>

#include "app/flag.h"
#include "app/verb.h"
#include "study/netcheck_verdict.h"

static const char doc[] =
    "Run the reference cases of each FILE at the network levels, print the error of each case and "
    "statistics, and compare them with the accuracy stated for each level and class of case. A "
    "message list without reference times is simulated and its times are printed.\n\n"
    "Example: mimdsim netcheck tests/data/net/makespan.json --level packet\n"
    "\v      --within=PERCENT       require every error to be within this, instead of the stated "
    "accuracy\n"
    "      --stated               print the stated accuracies and run nothing\n\n"
    "The form of a case follows from its keys: step (distance), list (trace), hand (messages), "
    "load (points), saturation (saturation_low). With --json one FILE gives one object, several "
    "give a list of objects. Cases that a level cannot run are counted as skipped, with the "
    "reason. The exit status is 1 if a verdict is FAIL, and 65 if a file has an unknown form or "
    "none of its cases can be run.";

/* Several files are told apart by their names. */
static void print_one(const struct netcheck *n, const struct common *c, double within,
                      struct json *j)
{
    if (c->json) {
        netcheck_json_object(n, within, j);
        return;
    }
    if (c->narg > 1) printf("%s\n", n->path);
    netcheck_print(n, within, c->brief, stdout);
    if (c->narg > 1) putchar('\n');
}

/* Every file is read and run before anything is printed, so that a wrong one leaves no half
 * answer. */
static bool check_files(const struct common *c, const bool *wanted, double within, bool *pass,
                        struct arena *a, struct err *e)
{
    struct netcheck *n = TAKE(a, c->narg, struct netcheck);
    for (int i = 0; i < c->narg; i++)
        if (!netcheck_run(&n[i], c->arg[i], wanted, NULL, c->quiet, a, e)) return false;
    struct json j = json_make(stdout);
    /* One file is one object, several are a list: a script for one file need not unpack a list. */
    if (c->json && c->narg > 1) json_array(&j);
    for (int i = 0; i < c->narg; i++) print_one(&n[i], c, within, &j);
    if (c->json && c->narg > 1) json_end(&j);
    if (c->json) json_finish(&j);
    *pass = true;
    for (int i = 0; i < c->narg; i++) *pass = *pass && netcheck_pass(&n[i], within);
    return true;
}

/* "5" or "5%" as a fraction; -1 without the option, which stands for the stated accuracy. */
static bool within_of(const char *word, double *within, struct err *e)
{
    char *end;
    *within = -1; /* the stated accuracy */
    if (!word) return true;
    double percent = strtod(word, &end);
    if (*end == '%') end++; /* both forms mean per cent */
    if (end == word || *end || !(percent >= 0) || percent > 1e6)
        return err_set(e, ERR_USAGE, "--within: '%s' is not a percentage of 0 or more", word);
    *within = percent / 100;
    return true;
}

/* Status 1: a verdict is FAIL; 65: a file that proves nothing. */
int cmd_netcheck(int argc, char **argv)
{
    struct common c;
    const char *limit = take_value(&argc, argv, "--within");
    double within;
    bool pass = true, stated = take_flag(&argc, argv, "--stated");
    common_parse(&c, argc, argv, TAKES_LEVEL, "FILE...", doc, stated ? 0 : 1, 64);
    /* The table needs no file. */
    if (stated) {
        if (c.json) netcheck_json_stated(stdout);
        else netcheck_print_stated(stdout);
        return 0;
    }
    struct err e;
    err_clear(&e);
    enum network_level level = LEVEL_LOGGP; /* of --level */
    bool wanted[LEVELS] = {false}; /* only that one, where it is given */
    bool ok = within_of(limit, &within, &e) && (!c.level || level_named("", c.level, &level, &e));
    /* NULL, not an array of true: without --level every level is wanted. */
    if (ok && c.level) wanted[level] = true;
    struct arena *a = arena_create();
    ok = ok && check_files(&c, c.level ? wanted : NULL, within, &pass, a, &e);
    arena_destroy(a);
    if (!ok) return common_fail(&c, &e);
    return pass ? 0 : err_exit_status(ERR_CHECK);
}
