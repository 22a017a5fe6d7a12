/* cmd_accuracy.c - mimdsim accuracy: error against run time, for each ladder of a scenario. */
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
    "Measure how wrong each cheaper way is, at the largest points of SCENARIO that\n"
    "take seconds: network levels, precisions and algorithms, steppers and step\n"
    "sizes. Rows go to table `ladder` of the database, work-precision diagrams to\n"
    "accuracy-SCENARIO.png and .svg; failed methods are listed. Ends with the\n"
    "cheapest rung of each ladder.\n\n"
    "Example: mimdsim accuracy scenarios/speedup-t3e.yaml --within 2%\n\v"
    "--within X: the relative error that may be, 2% or 1e-6; without it 2% of simulated times, 1e-10 of accelerations "
    "and 1e-6 of states.";

/* "--within X": X is a number or a percentage; NULL: not asked for. */
static bool read_within(const char *text, double *within, struct err *e)
{
    char *end;
    if (!text) return true;
    *within = strtod(text, &end);
    bool number = end != text;
    if (strcmp(end, "%") == 0) *within /= 100, end++;
    if (!number || *end || !(*within > 0) || !isfinite(*within))
        return err_set(e, ERR_USAGE, "--within: '%s' is not a positive number such as 2%% or 1e-6", text);
    return true;
}

static bool keep_and_draw(const struct common *c, const struct accuracy_report *r, struct err *e)
{
    struct store *s = store_open(c->database, STORE_WRITE, e);
    if (!s) return false;
    struct text figure = {0};
    text_add(&figure, "accuracy-%s", r->scenario);
    bool ok = keep_accuracy(s, r, e) && keep_draw(c, s, figure.s, e);
    text_free(&figure);
    store_close(s);
    return ok;
}

int cmd_accuracy(int argc, char **argv)
{
    struct common c;
    struct err e;
    err_clear(&e);
    double within = 0;
    bool ok = read_within(take_value(&argc, argv, "--within"), &within, &e);
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_STORE | TAKES_DIR, "SCENARIO", doc, 1, 1);
    struct plan p = {0};
    struct plan_options o = common_plan(&c);
    struct arena *a = arena_create();
    struct accuracy_report r;
    ok = ok && plan_read(&p, c.arg[0], &o, &e) && accuracy_measure(p.run, p.nrun, within, c.quiet, a, &r, &e);
    if (ok && !c.json) accuracy_print(stdout, &r);
    ok = ok && keep_and_draw(&c, &r, &e);
    if (ok && c.json) accuracy_print_json(stdout, &r);
    arena_destroy(a);
    plan_free(&p);
    return ok ? 0 : common_fail(&c, &e);
}
