/* keep.c - see keep.h. */
#include "app/keep.h"

#include <math.h>

#include "app/levels.h"
#include "report/report.h"

static bool store_choice(struct store *s, const char *scenario, const struct accuracy_choice *c, struct err *e)
{
    static const char *const name[] = {"scenario", "ladder", "at", "quantity", "tolerance", "method", "rung",
                                       "relative_error", "cost_ratio"};
    const struct store_value value[] = {
        store_text(scenario), store_text(c->ladder), store_text(c->at), store_text(c->quantity),
        store_real(c->tolerance), store_text(c->rung ? c->rung->method : NULL),
        store_text(c->rung ? c->rung->rung : NULL), store_real(c->rung ? c->rung->error : NAN),
        store_real(c->rung ? c->cost_ratio : NAN)};
    return store_insert(s, "ladder_choice", 9, name, value, e);
}

bool keep_accuracy(struct store *s, const struct accuracy_report *r, struct err *e)
{
    if (!store_begin(s, e)) return false;
    bool ok = store_note_build(s, e) && store_delete(s, "ladder", "scenario", store_text(r->scenario), e) &&
              store_delete(s, "ladder_choice", "scenario", store_text(r->scenario), e) && ladder_store(s, r, e);
    for (int i = 0; ok && i < r->nchoice; i++) ok = store_choice(s, r->scenario, &r->choice[i], e);
    if (ok) return store_commit(s, e);
    store_rollback(s);
    return false;
}

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

bool keep_stability(struct store *s, const struct stability_report *r, struct err *e)
{
    if (!store_begin(s, e)) return false;
    bool ok = store_note_build(s, e) && store_delete(s, "stability", "suite", store_text(r->suite), e);
    for (int i = 0; ok && i < r->nrow; i++) ok = store_row(s, r, i, e);
    if (ok) return store_commit(s, e);
    store_rollback(s);
    return false;
}

bool keep_draw(const struct common *c, struct store *s, const char *figure, struct err *e)
{
    if (!report_figure(s, plan_data_dir(), figure, c->directory, e)) return false;
    if (!c->quiet)
        fprintf(stderr, "mimdsim: figure %s/%s.png; its section: mimdsim report %s\n", c->directory, figure,
                c->database);
    return true;
}
