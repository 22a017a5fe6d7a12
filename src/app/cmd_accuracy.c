/* cmd_accuracy.c - mimdsim accuracy: error against run time, for each ladder of a scenario.
 *
 * Order of a study's verb, here and in stability and explain --measure: open the database and look
 * at the folder, measure, print for people, store, draw, print the document. What fails late has
 * still printed and stored what was measured. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/flag.h"
#include "app/keep.h"
#include "app/verb.h"
#include "base/text.h"
#include "store/store.h"
#include "study/accuracy.h"

static const char doc[] =
    "Measure the error and the cost of network levels, of precisions and algorithms,\n"
    "and of integrators and step sizes, at the largest points of SCENARIO that take\n"
    "seconds. Results go to table `ladder` of the database, and work-precision\n"
    "diagrams to accuracy-SCENARIO-network.png and .svg, -arithmetic and\n"
    "-integration; failed methods are listed. At the end the cheapest level, method\n"
    "and integrator within the error are printed.\n\n"
    "Example: mimdsim accuracy scenarios/speedup-t3e.yaml --within 2%\n"
    "\v--within X: the permitted relative error, such as 2% or 1e-6. The default is 2% for "
    "simulated times, 1e-10 for accelerations and 1e-6 for states.";

/* "--within X": X is a number or a percentage. Without the option *within stays as it is. */
static bool read_within(const char *text, double *within, struct err *e)
{
    /* NULL: the option was not given */
    char *end;
    if (!text) return true;
    *within = strtod(text, &end);
    bool number = end != text;
    /* "2%" and "2 %" differ by the shell's word limits only: no blank is accepted. */
    if (strcmp(end, "%") == 0) *within /= 100, end++;
    /* An error of 200 % is nobody's wish: the sign was forgotten. */
    if (number && *end == '\0' && text[strlen(text) - 1] != '%' && *within >= 1)
        return err_set(e, ERR_USAGE, "--within: '%s' is an error of %g %%; did you mean '%s%%'?",
                       text, 100 * *within, text);
    if (!number || *end || !(*within > 0) || !isfinite(*within))
        return err_set(e, ERR_USAGE, "--within: '%s' is not a positive number such as 2%% or 1e-6",
                       text);
    return true;
}

/* Rows first, the figure from them: what is drawn is what is stored. */
static bool keep_and_draw(const struct common *c, const struct accuracy_report *r, struct store *s,
                          struct err *e)
{
    struct text figure = {0};
    text_add(&figure, "accuracy-%s", r->scenario);
    bool ok = keep_accuracy(s, r, e) && store_publish(s, e) && keep_draw(c, s, figure.s, e);
    text_free(&figure);
    return ok;
}

/* A scenario for which no ladder can be climbed is an error; rungs that fail are rows. */
int cmd_accuracy(int argc, char **argv)
{
    struct common c;
    struct err e;
    err_clear(&e);
    /* The option is taken before argp sees the rest; a wrong value is told after the verb's own
     * errors. */
    double within = 0;
    bool ok = read_within(take_value(&argc, argv, "--within"), &within, &e);
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_STORE | TAKES_DIR, "SCENARIO", doc, 1, 1);
    struct plan p = {0};
    /* Parsing ends the process at wrong options, so nothing is allocated before it. */
    struct plan_options o = common_plan(&c);
    struct arena *a = arena_create();
    struct accuracy_report r;
    struct store *s = NULL;
    ok = ok && plan_read(&p, c.arg[0], &o, &e) && (s = keep_open(&c, &e)) != NULL &&
         accuracy_measure(p.run, p.nrun, within, c.quiet, a, &r, &e);
    /* People see the table before drawing, which takes a second; a document must be the last
     * output. */
    if (ok && !c.json) accuracy_print(stdout, &r);
    ok = ok && keep_and_draw(&c, &r, s, &e);
    if (ok && c.json) accuracy_print_json(stdout, &r);
    store_close(s);
    arena_destroy(a);
    plan_free(&p);
    return ok ? 0 : common_fail(&c, &e);
}
