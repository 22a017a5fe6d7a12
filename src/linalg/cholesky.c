/* cholesky.c - see cholesky.h. The textbook form, row by row: n^3 / 3 products, whatever the matrix
 * looks like. */
#include "linalg/cholesky.h"

#include <stddef.h>
#include <string.h>

bool cholesky_factor(int n, real *m)
{
    for (int i = 0; i < n; i++) {
        real *row = m + (size_t)i * n;
        for (int j = 0; j <= i; j++) {
            const real *other = m + (size_t)j * n;
            real s = row[j];
            for (int k = 0; k < j; k++) s -= row[k] * other[k];
            /* Off the diagonal a division, on it the root. */
            if (j < i) row[j] = s / other[j];
            else if (!(s > 0)) return false;
            else row[i] = real_sqrt(s);
        }
    }
    return true;
}

/* L y = x, then L^T x = y, in place. */
void cholesky_solve(int n, const real *m, real *x)
{
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++) x[i] -= m[(size_t)i * n + k] * x[k];
        x[i] /= m[(size_t)i * n + i];
    }
    /* By columns of L^T, which are rows of L. */
    for (int i = n - 1; i >= 0; i--) {
        x[i] /= m[(size_t)i * n + i];
        for (int k = 0; k < i; k++) x[k] -= m[(size_t)i * n + k] * x[i];
    }
}

/* Where operations are counted, all of them are those of the source in its own precision. */
#if REAL_BITS == 128 && !defined REAL_COUNTED
/* The same in double precision, whose factor quad precision begins with. */
bool cholesky_factor_f64(int n, double *m);
void cholesky_solve_f64(int n, const double *m, double *x);

/* The largest number, or one that is none. */
static real largest(int n, const real *x)
{
    real size = 0;
    for (int i = 0; i < n; i++)
        if (!(real_fabs(x[i]) <= size)) size = real_fabs(x[i]);
    return size;
}

/* given - m x, in quad precision; then the correction that the factor makes of it. */
static void correction(int n, const real *m, const double *factor, const real *given, const real *x,
                       real *more, double *rounded)
{
    for (int i = 0; i < n; i++) {
        real s = given[i];
        for (int k = 0; k < n; k++) s -= m[(size_t)i * n + k] * x[k];
        rounded[i] = (double)s;
    }
    cholesky_solve_f64(n, factor, rounded);
    for (int i = 0; i < n; i++) more[i] = rounded[i];
}

/* x = m^-1 x by refinement; false, with x as it was, where double precision has no factor or its
 * corrections do not get smaller: then the matrix is as good as singular there. */
static bool refined(int n, const real *m, real *x, struct arena *scratch)
{
    const real enough = 1e-20Q; /* of the answer: its doubles end at 1e-16 */
    double *factor = TAKE(scratch, size_product(n, n), double), *rounded = TAKE(scratch, n, double);
    real *answer = TAKE(scratch, n, real), *more = TAKE(scratch, n, real);
    /* What doubles cannot hold, too large or too small, makes no factor or no progress. */
    for (size_t i = 0; i < (size_t)n * (size_t)n; i++) factor[i] = (double)m[i];
    if (!cholesky_factor_f64(n, factor)) return false;
    /* The first correction is the whole answer. */
    for (real before = 4;;) {
        correction(n, m, factor, x, answer, more, rounded);
        for (int i = 0; i < n; i++) answer[i] += more[i];
        const real whole = largest(n, answer), part = largest(n, more);
        if (part <= enough * whole) break;
        /* Half a digit a step at least; false for what is no number. */
        if (!(part <= whole * before * (real)0.3)) return false;
        before = part / whole;
    }
    memcpy(x, answer, (size_t)n * sizeof *x);
    return true;
}

bool cholesky_answer(int n, real *m, real *x, struct arena *scratch)
{
    struct arena_mark mark = arena_mark(scratch);
    bool good = refined(n, m, x, scratch);
    arena_release(scratch, mark);
    if (good) return true;
    good = cholesky_factor(n, m);
    if (good) cholesky_solve(n, m, x);
    return good;
}
#else
bool cholesky_answer(int n, real *m, real *x, struct arena *scratch)
{
    (void)scratch;
    const bool good = cholesky_factor(n, m);
    if (good) cholesky_solve(n, m, x);
    return good;
}
#endif
