/* stability_row.c - one row of the suite: how it is added and judged (stability_scene.h). */
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "study/stability_scene.h"

struct stability_row *row_add(struct stability_report *r, const char *subject,
                              const char *algorithm, const char *precision)
{
    /* The table doubles when full, in the report's arena; old copies are given back with it. */
    if (r->nrow == r->room) {
        int room = r->room > 0 ? 2 * r->room : 256;
        struct stability_row *larger = TAKE(r->arena, room, struct stability_row);
        if (r->nrow > 0) memcpy(larger, r->row, (size_t)r->nrow * sizeof *larger);
        r->row = larger;
        r->room = room;
    }
    struct stability_row *x = &r->row[r->nrow++];
    *x = (struct stability_row){0}; /* the table may have been used before */
    text_copy(x->subject, sizeof x->subject, subject);
    text_copy(x->algorithm, sizeof x->algorithm, algorithm);
    text_copy(x->precision, sizeof x->precision, precision);
    /* A row fails until its algorithm has an answer that row_grade accepts. */
    x->status = STABILITY_FAILED;
    x->error = x->residual = x->condition = x->growth = x->energy_drift = x->step_s = NAN;
    x->refinements = -1;
    return x;
}

void row_grade(struct stability_row *row, double error, bool single)
{
    /* Double precision has 16 digits and single 7. ok: about half of them are right; failed: not
     * even one or two are. */
    double fine = single ? 1e-3 : 1e-8, poor = single ? 1e-1 : 1e-2;
    row->error = isfinite(error) ? error : NAN;
    row->status = error <= fine   ? STABILITY_OK
                  : error <= poor ? STABILITY_DEGRADED
                                  : STABILITY_FAILED;
    /* The error itself is NULL in the database: the reason says why. */
    if (!isfinite(error)) text_copy(row->reason, sizeof row->reason,
                                    "the result is not a finite number");
}

void stability_append(struct stability_report *r, const struct stability_row *row, int n)
{
    for (int i = 0; i < n; i++)
        *row_add(r, row[i].subject, row[i].algorithm, row[i].precision) = row[i];
}
