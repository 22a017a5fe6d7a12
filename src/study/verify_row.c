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
    /* Rows move when the table grows: a pointer to one holds until the next is added. */
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

/* The loops' rank comes from quad precision, not from the algorithm under test, which might be
 * wrong about it. */
bool verify_loops_skip(struct verify_case *v, const char *algorithm)
{
    char why[96];
    int nrow = v->vector->nrow, redundant = v->answers.redundant;
    /* Loop forces are unique: compare them. */
    if (redundant == 0) return false;
    snprintf(why, sizeof why, "redundant loops (rank %d of %d): lambda is not unique",
             nrow - redundant, nrow);
    verify_row_skip(v, algorithm, "lambda", why);
    return true;
}

/* The user's tolerance, or 1e-12 of the answers' scales in double (some 5,000 roundings) and
 * 1e-4 in single precision (some 1,000). */
double verify_tolerance_inverse(const struct verify_options *o)
{
    return o->tolerance_inverse > 0          ? o->tolerance_inverse
           : o->precision == PRECISION_FLOAT ? 1e-4
                                             : 1e-12;
}

/* Accelerations come from a linear system: a hundred or ten times as much. */
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
    /* NaN fails: the comparison is false. */
    row->verdict = row->error <= tolerance ? VERIFY_PASS : VERIFY_FAIL;
    if (!y) text_copy(row->note, sizeof row->note, "breaks down");
    /* A row that passes although a wrong answer would pass as well is not counted. */
    if (row->verdict != VERIFY_PASS || verify_answers_tells(x, k, tolerance)) return;
    row->verdict = VERIFY_NOT_APPLICABLE;
    text_copy(row->note, sizeof row->note, "the inputs' rounding alone decides this answer");
}

/* The exact answer misses the file's: the file is wrong, or both formulations differ. Either way
 * the algorithm under test is not excused. */
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

/* In quad precision the error vanishes: rounding. It stays, but the even scene is right: this
 * algorithm fails on this scene. Neither: the code is wrong. */
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

/* Inverse inertias need mass and extent: the first body without them is named. */
bool verify_unfit_body(const struct model *m, char *why, int size)
{
    if (m->has_phi) return false;
    for (int i = 0; i < m->nbody; i++) {
        const struct body_def *b = &m->body[i];
        /* inertia[0], [3], [5] are the diagonal: xx, yy, zz. */
        double trace = b->inertia[0] + b->inertia[3] + b->inertia[5];
        if (b->mass > 0 && trace > 0) continue;
        snprintf(why, (size_t)size, "%s body %d ('%s')", b->mass > 0 ? "point mass in" : "massless",
                 i, b->name);
        return true;
    }
    snprintf(why, (size_t)size, "a body's inertia has no inverse");
    return true;
}
