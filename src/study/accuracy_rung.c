/* accuracy_rung.c - one rung of a ladder: how it is added and judged (accuracy_ladder.h). */
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "study/accuracy_ladder.h"

/* The list doubles when it is full: memory of an arena is not given back, so the copies left behind
 * add up to at most the size of the last. */
static struct accuracy_rung *rung_add(struct accuracy_report *r)
{
    if (r->nrung == r->room) {
        int room = r->room > 0 ? 2 * r->room : 64;
        struct accuracy_rung *larger = TAKE(r->arena, room, struct accuracy_rung);
        if (r->nrung > 0) memcpy(larger, r->rung, (size_t)r->nrung * sizeof *larger);
        r->rung = larger;
        r->room = room;
    }
    return &r->rung[r->nrung++];
}

void accuracy_append(struct accuracy_report *r, const struct accuracy_rung *rung, int n)
{
    for (int i = 0; i < n; i++) *rung_add(r) = rung[i];
}

struct accuracy_rung *ladder_add(struct ladder *l, const char *method, const char *rung,
                                 const char *quantity, const char *reference)
{
    struct accuracy_rung *x = rung_add(l->report);
    text_copy(x->ladder, sizeof x->ladder, l->name);
    text_copy(x->at, sizeof x->at, l->at);
    text_copy(x->family, sizeof x->family, l->family);
    text_copy(x->method, sizeof x->method, method);
    text_copy(x->rung, sizeof x->rung, rung);
    text_copy(x->quantity, sizeof x->quantity, quantity);
    text_copy(x->reference, sizeof x->reference, reference);
    /* Failed with everything unknown, until the maker of the rung grades it: one that returns
     * early is told as failed. */
    x->error = x->host_s = NAN;
    x->machine_ps = -1;
    x->status = RUNG_FAILED;
    return x;
}

void ladder_grade(struct accuracy_rung *r, double error, double fine, double poor)
{
    /* An infinite error is stored as NAN, which the database knows as NULL; comparisons with NAN
     * fail, so both are RUNG_FAILED. */
    r->error = isfinite(error) ? error : NAN;
    r->status = error <= fine ? RUNG_OK : error <= poor ? RUNG_DEGRADED : RUNG_FAILED;
}
