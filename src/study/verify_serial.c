/* verify_serial.c - rows of the serial algorithms: inverse dynamics, kinematics, mass matrix,
 * every way forward.
 *
 * They are the baselines of every speedup, so they are verified first, and as strictly as the
 * parallel ones. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "study/verify_rows.h"

/* --- all but accelerations -------------------------------------------------------------------- */

/* Which algorithm answers a quantity; what is not named is an acceleration or a loop force. */
static const char *const answered_by[VERIFY_QUANTITIES] = {
    [VERIFY_TAU_ID] = "rnea",      [VERIFY_BIAS] = "rnea",         [VERIFY_GRAVITY_TORQUE] = "rnea",
    [VERIFY_WRENCH] = "rnea",      [VERIFY_FK] = "kinematics",     [VERIFY_KINETIC] = "totals",
    [VERIFY_POTENTIAL] = "totals", [VERIFY_LINEAR] = "totals",     [VERIFY_ANGULAR] = "totals",
    [VERIFY_COM] = "totals",       [VERIFY_TOTAL_MASS] = "totals", [VERIFY_MASS_MATRIX] = "crba"};

/* All quantities but accelerations in one computation, then a row for each that the file has.
 * Quad precision explains a failure; no scene is singular for these algorithms. */
static void inverse_rows(struct verify_case *v)
{
    const struct verify_answers *x = &v->answers;
    double *y = TAKE(v->arena, x->n + 1, double);
    verify_answers_compute(x, v->vector, v->model, v->state, v->options->precision, v->arena, y);
    for (int k = 0; k < VERIFY_QUANTITIES; k++) {
        if (!answered_by[k] || x->at[k] == x->at[k + 1]) continue;
        struct verify_row *row =
            verify_row_add(v, answered_by[k], verify_quantity_name((enum verify_quantity)k));
        verify_row_judge(v, row, (enum verify_quantity)k, y + x->at[k],
                         verify_tolerance_inverse(v->options));
        if (row->verdict != VERIFY_FAIL || verify_row_refuted(v, row, (enum verify_quantity)k))
            continue;
        verify_row_explain(
            row, verify_answers_error(x, (enum verify_quantity)k, x->exact + x->at[k]), false);
    }
}

/* --- forward dynamics ------------------------------------------------------------------------- */

/* One answer of forward dynamics. good: no pivot broke down. */
struct answer {
    double *qdd, *lambda;
    struct forward_report report;
    bool good;
};

/* Constraint-force algorithms run on the lumped model, others on the file's own: their
 * accelerations have the same size, as fixed joints have no degrees of freedom. */
static struct answer forward(const struct verify_case *v, enum precision precision,
                             enum forward_method method)
{
    bool cfa = method >= FORWARD_CFA_PAPER;
    const struct model *m = cfa ? v->lumped : v->model;
    const struct state *s = cfa ? v->lumped_state : v->state;
    struct answer x = {.qdd = TAKE(v->arena, m->nu + 1, double),
                       .lambda = TAKE(v->arena, m->nrow + 1, double)};
    struct work w = {0};
    x.good = dynamics_type_of(precision)->forward(m, s, method, v->arena, x.qdd, x.lambda,
                                                  &x.report, &w);
    return x;
}

/* NULL as the answer: a pivot broke down. */
static void judge(const struct verify_case *v, struct verify_row *row, enum verify_quantity k,
                  const double *y, bool good)
{
    verify_row_judge(v, row, k, good ? y : NULL, verify_tolerance_forward(v->options));
}

/* Rows above the tolerance, accelerations and loop forces (may be NULL), by a second run in quad
 * precision. Only if that is wrong as well, the even scene is asked. */
static bool explain(struct verify_case *v, enum forward_method method, struct verify_row *qdd,
                    struct verify_row *lambda, struct err *e)
{
    const struct verify_answers *x = &v->answers;
    bool ask_qdd = qdd->verdict == VERIFY_FAIL && !verify_row_refuted(v, qdd, VERIFY_QDD_FD);
    bool ask_lambda =
        lambda && lambda->verdict == VERIFY_FAIL && !verify_row_refuted(v, lambda, VERIFY_LAMBDA);
    if (!ask_qdd && !ask_lambda) return true;
    struct answer quad = forward(v, PRECISION_QUAD, method);
    double error = quad.good ? verify_answers_error(x, VERIFY_QDD_FD, quad.qdd) : INFINITY,
           lambda_error = INFINITY;
    if (quad.good && ask_lambda) lambda_error = verify_answers_error(x, VERIFY_LAMBDA, quad.lambda);
    bool sane = true;
    if ((ask_qdd && error > qdd->tolerance) || (ask_lambda && lambda_error > lambda->tolerance)) {
        if (!verify_even(v, e)) return false;
        struct answer even = forward(v->even, PRECISION_QUAD, method);
        sane = even.good && verify_even_right(v, even.qdd);
    }
    if (ask_qdd) verify_row_explain(qdd, error, sane);
    if (ask_lambda) verify_row_explain(lambda, lambda_error, sane);
    return true;
}

/* A row for the loop forces: its place, or -1: there is none, or redundant loops make them not
 * unique. */
static int lambda_row(struct verify_case *v, const char *name, const struct answer *x)
{
    if (!v->vector->lambda || verify_loops_skip(v, name)) return -1;
    judge(v, verify_row_add(v, name, "lambda"), VERIFY_LAMBDA, x->lambda, x->good);
    return v->report->nrow - 1;
}

/* Why the method is left out, or NULL. */
static const char *left_out(const struct verify_case *v, enum forward_method method,
                            const char *unfit)
{
    /* O(n^3) in the degrees of freedom; the O(n) algorithms have no limit. */
    enum { MASS_MATRIX_LIMIT = 512 };
    bool mass_matrix = method == FORWARD_CRBA || method == FORWARD_CRBA_SPARSE;
    if (method >= FORWARD_CFA_PAPER) return unfit;
    if (mass_matrix && v->vector->nv > MASS_MATRIX_LIMIT && !v->options->all_ranks)
        return "left out: its time grows as the cube of the size (--all-ranks runs it)";
    return NULL;
}

/* unfit: why constraint forces do not apply, NULL when they do. One algorithm: a row for its
 * accelerations, and one for the loop forces. Pointers are taken after both rows exist, since rows
 * move. */
static bool forward_row(struct verify_case *v, enum forward_method method, const char *unfit,
                        struct err *e)
{
    const char *name = forward_method_name(method), *why = left_out(v, method, unfit);
    if (why) {
        verify_row_skip(v, name, "qdd_fd", why);
        return true;
    }
    struct answer x = forward(v, v->options->precision, method);
    /* places, not pointers: the next row may move the table */
    int at = v->report->nrow;
    judge(v, verify_row_add(v, name, "qdd_fd"), VERIFY_QDD_FD, x.qdd, x.good);
    int at_lambda = lambda_row(v, name, &x);
    struct verify_row *qdd = &v->report->row[at],
                      *lambda = at_lambda >= 0 ? &v->report->row[at_lambda] : NULL;
    bool wrong = qdd->verdict == VERIFY_FAIL || (lambda && lambda->verdict == VERIFY_FAIL);
    return !wrong || explain(v, method, qdd, lambda, e);
}

/* The robust form contains two algorithms and refines both: in double precision it must pass
 * wherever another one passes, and no excuse counts. */
static void robust_judge(const struct verify_case *v)
{
    /* `other`: another algorithm passes */
    struct verify_row *row = v->report->row, *robust = NULL;
    bool other = false;
    for (int i = 0; i < v->report->nrow; i++) {
        bool here = strcmp(row[i].quantity, "qdd_fd") == 0;
        if (here && strcmp(row[i].algorithm, forward_method_name(FORWARD_CFA_ROBUST)) == 0)
            robust = &row[i];
        else if (here && row[i].verdict == VERIFY_PASS) other = true;
    }
    if (!robust || !other || robust->verdict == VERIFY_PASS ||
        robust->verdict == VERIFY_NOT_APPLICABLE)
        return;
    if (v->options->precision == PRECISION_DOUBLE) robust->verdict = VERIFY_FAIL;
}

/* Every serial algorithm on the case. */
bool verify_serial(struct verify_case *v, struct err *e)
{
    char unfit[96];
    const char *why = verify_unfit_body(v->lumped, unfit, sizeof unfit) ? unfit : NULL;
    inverse_rows(v);
    for (int k = 0; v->vector->qdd_fd && k < FORWARD_METHODS; k++)
        if (!forward_row(v, (enum forward_method)k, why, e)) return false;
    robust_judge(v);
    return true;
}
