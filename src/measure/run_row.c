/* run_row.c - a run as rows of tables (run_row.h). */
#include "measure/run_row.h"

/* A stage that a rank never entered: no line in tables. */
bool stage_time_idle(const struct stage_time *t)
{
    return stage_time_total(t) == 0 && t->messages == 0 && t->work.flop == 0;
}

/* What the columns read: pointers to spec and result, and what must be summed up first. */
struct run_row run_row_make(const struct run_spec *spec, const struct run_order *order,
                            const struct run_result *r)
{
    struct run_row row = {.spec = spec, .order = order, .result = r, .ranks = rank_summary_make(r)};
    /* An empty text, not NULL: nothing was left out. */
    text_add(&row.left_out, "%s", "");
    for (int i = 0; i < r->nomission; i++)
        text_add(&row.left_out, "%s%s: %s", i > 0 ? "; " : "", r->omission[i].what,
                 r->omission[i].why);
    return row;
}

void run_row_free(struct run_row *row) { text_free(&row->left_out); }
