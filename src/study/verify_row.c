/* verify_row.c - one row of a comparison: how it is judged, explained or skipped
 * (verify_rows.h). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "study/verify_rows.h"

struct verify_row *verify_row_add(struct verify_case *v, const char *algorithm,
                                  const char *quantity)
{
    struct verify_report *r = v->report;
    if (r->nrow == r->row_room) {
        int room = r->row_room > 0 ? 2 * r->row_room : 32;
        struct verify_row *larger = TAKE(r->arena, room, struct verify_row);
        if (r->nrow > 0) memcpy(larger, r->row, (size_t)r->nrow * sizeof *larger);
        r->row = larger;
        r->row_room = room;
    }
    struct verify_row *row = &r->row[r->nrow++];
    text_copy(row->algorithm, sizeof row->algorithm, algorithm);
    text_copy(row->quantity, sizeof row->quantity, quantity);
    return row;
}

void verify_row_skip(struct verify_case *v, const char *algorithm, const char *quantity,
                     const char *why)
{
    struct verify_row *row = verify_row_add(v, algorithm, quantity);
    row->verdict = VERIFY_NOT_APPLICABLE;
    text_copy(row->note, sizeof row->note, why);
}

bool verify_loops_skip(struct verify_case *v, const char *algorithm)
{
    char why[96];
    int nrow = v->vector->nrow, redundant = v->answers.redundant;
    if (redundant == 0) return false;
    snprintf(why, sizeof why, "redundant loops (rank %d of %d): lambda is not unique",
             nrow - redundant, nrow);
    verify_row_skip(v, algorithm, "lambda", why);
    return true;
}

double verify_tolerance_inverse(const struct verify_options *o)
{
    return o->tolerance_inverse > 0          ? o->tolerance_inverse
           : o->precision == PRECISION_FLOAT ? 1e-4
                                             : 1e-12;
}

double verify_tolerance_forward(const struct verify_options *o)
{
    return o->tolerance_forward > 0          ? o->tolerance_forward
           : o->precision == PRECISION_FLOAT ? 1e-3
                                             : 1e-10;
}

void verify_row_judge(const struct verify_case *v, struct verify_row *row, enum verify_quantity k,
                      const double *y, double tolerance)
{
    const struct verify_answers *x = &v->answers;
    row->tolerance = tolerance;
    row->error = y ? verify_answers_error(x, k, y) : INFINITY;
    row->plain = y ? verify_answers_plain(x, k, y) : INFINITY;
    row->verdict = row->error <= tolerance ? VERIFY_PASS : VERIFY_FAIL;
    if (!y) text_copy(row->note, sizeof row->note, "breaks down");
    if (row->verdict != VERIFY_PASS || verify_answers_tells(x, k, tolerance)) return;
    row->verdict = VERIFY_NOT_APPLICABLE;
    text_copy(row->note, sizeof row->note, "the inputs' rounding alone decides this answer");
}

bool verify_row_refuted(const struct verify_case *v, struct verify_row *row, enum verify_quantity k)
{
    const struct verify_answers *x = &v->answers;
    bool exact = x->forward || (k != VERIFY_QDD_FD && k != VERIFY_LAMBDA);
    if (exact && verify_answers_error(x, k, x->exact + x->at[k]) <= row->tolerance) return false;
    char before[sizeof row->note];
    text_copy(before, sizeof before, row->note);
    snprintf(row->note, sizeof row->note, "%.80s%s%s", before, before[0] ? "; " : "",
             exact ? "quad precision contradicts the file too"
                   : "articulated bodies break down in quad precision");
    return true;
}

void verify_row_explain(struct verify_row *row, double quad, bool sane)
{
    char before[sizeof row->note];
    bool mended = quad <= row->tolerance;
    row->verdict = mended ? VERIFY_ROUNDING : sane ? VERIFY_ALGORITHM_FAILS : VERIFY_FAIL;
    row->quad = quad;
    text_copy(before, sizeof before, row->note);
    snprintf(row->note, sizeof row->note, "%.80s%sin quad precision %.1e%s", before,
             before[0] ? "; " : "", quad, mended || sane ? "" : "; wrong about an even scene too");
}

bool verify_unfit_body(const struct model *m, char *why, int size)
{
    if (m->has_phi) return false;
    for (int i = 0; i < m->nbody; i++) {
        const struct body_def *b = &m->body[i];
        double trace = b->inertia[0] + b->inertia[3] + b->inertia[5];
        if (b->mass > 0 && trace > 0) continue;
        snprintf(why, (size_t)size, "%s body %d ('%s')", b->mass > 0 ? "point mass in" : "massless",
                 i, b->name);
        return true;
    }
    snprintf(why, (size_t)size, "a body's inertia has no inverse");
    return true;
}
