/* cmd_stability.c - mimdsim stability: stiff and extreme scenes against every algorithm.
 *
 * A scene on which algorithms fail is a result: the exit status is that of the verb, not of the
 * algorithms. */
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/keep.h"
#include "app/verb.h"
#include "base/text.h"
#include "store/store.h"
#include "study/stability.h"

static const char doc[] =
    "Run the suite of stiff and extreme scenes, or the scenes of SCENARIO, with\n"
    "every algorithm and integrator, and grade each result: ok, degraded or failed.\n"
    "Results go to table `stability` of the database, and charts to\n"
    "stability-suite-GROUP.png and .svg, a group of cases each, or to\n"
    "stability-SCENARIO-cases and stability-SCENARIO-motions.\n\n"
    "Example: mimdsim stability\n";

/* The charts have the scenario's name, or "suite". */
static bool keep_and_draw(const struct common *c, const struct stability_report *r,
                          struct store *s, struct err *e)
{
    struct text figure = {0};
    text_add(&figure, "stability-%s", r->suite);
    bool ok = keep_stability(s, r, e) && store_publish(s, e) && keep_draw(c, s, figure.s, e);
    text_free(&figure);
    return ok;
}

/* Without SCENARIO the built-in suite; a scenario gives its points as scenes. */
int cmd_stability(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_STORE | TAKES_DIR | TAKES_JOBS, "[SCENARIO]",
                 doc, 0, 1);
    struct err e;
    err_clear(&e);
    struct plan p = {0};
    struct plan_options o = common_plan(&c);
    struct arena *a = arena_create();
    struct stability_report r;
    bool ok = c.narg == 0 || plan_read(&p, c.arg[0], &o, &e);
    const struct stability_options how = {.workers = c.jobs, .quiet = c.quiet};
    struct store *s = ok ? keep_open(&c, &e) : NULL;
    ok = ok && s && stability_measure(p.run, p.nrun, &how, a, &r, &e);
    /* The table before the drawing; a document last. */
    if (ok && !c.json) stability_print(stdout, &r);
    ok = ok && keep_and_draw(&c, &r, s, &e);
    if (ok && c.json) stability_print_json(stdout, &r);
    store_close(s);
    arena_destroy(a);
    plan_free(&p);
    return ok ? 0 : common_fail(&c, &e);
}
