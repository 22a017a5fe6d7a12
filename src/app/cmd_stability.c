/* cmd_stability.c - mimdsim stability: stiff and extreme scenes against every algorithm. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/verb.h"
#include "base/text.h"
#include "report/report.h"
#include "run/stability.h"
#include "store/store.h"

static const char doc[] =
    "Run the suite of stiff and extreme scenes, or the scenes of SCENARIO, by every algorithm and stepper, and grade\n"
    "each answer: ok, degraded or failed. Rows go to table `stability` of the database, a table of marks to\n"
    "stability.png and .svg, that of a scenario to stability-SCENARIO.png and .svg.\n\n"
    "Example: mimdsim stability\n";

static bool store_row(struct store *s, const struct stability_report *r, int i, struct err *e)
{
    static const char *const name[] = {"suite", "subject", "algorithm", "precision", "ordinal", "status",
                                       "relative_error", "residual", "condition", "growth", "refinements",
                                       "energy_drift", "step_s", "reason"};
    const struct stability_row *x = &r->row[i];
    const struct store_value value[] = {
        store_text(r->suite), store_text(x->subject), store_text(x->algorithm), store_text(x->precision), store_int(i),
        store_text(stability_word(x->status)), store_real(x->error), store_real(x->residual), store_real(x->condition),
        store_real(x->growth), x->refinements >= 0 ? store_int(x->refinements) : store_null(),
        store_real(x->energy_drift), store_real(x->step_s), store_text(x->reason)};
    return store_insert(s, "stability", 14, name, value, e);
}

static bool keep_and_draw(const struct common *c, const struct stability_report *r, struct err *e)
{
    struct store *s = store_open(c->database, STORE_WRITE, e);
    if (!s) return false;
    bool ok = store_begin(s, e) && store_delete(s, "stability", "suite", store_text(r->suite), e);
    for (int i = 0; ok && i < r->nrow; i++) ok = store_row(s, r, i, e);
    if (ok) ok = store_commit(s, e);
    else store_rollback(s);
    struct text figure = {0};
    text_add(&figure, strcmp(r->suite, "suite") == 0 ? "stability" : "stability-%s", r->suite);
    ok = ok && report_figure(s, plan_data_dir(), figure.s, c->directory, e);
    if (ok && !c->quiet) fprintf(stderr, "mimdsim: figure %s/%s.png\n", c->directory, figure.s);
    text_free(&figure);
    store_close(s);
    return ok;
}

int cmd_stability(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_STORE | TAKES_DIR, "[SCENARIO]", doc, 0, 1);
    struct err e;
    err_clear(&e);
    struct plan p = {0};
    struct plan_options o = common_plan(&c);
    struct arena *a = arena_create();
    struct stability_report r;
    bool ok = c.narg == 0 || plan_read(&p, c.arg[0], &o, &e);
    ok = ok && stability_measure(p.run, p.nrun, 0, c.quiet, a, &r, &e);
    if (ok && !c.json) stability_print(stdout, &r);
    ok = ok && keep_and_draw(&c, &r, &e);
    if (ok && c.json) stability_print_json(stdout, &r);
    arena_destroy(a);
    plan_free(&p);
    return ok ? 0 : common_fail(&c, &e);
}
