/* subspace.c - products with a joint's motion subspace and its complement; unit columns are picked,
 * not multiplied. */
#include "dynamics/subspace.h"
#include "linalg/screw.h"

/* y += columns k0 .. k0 + n - 1 times x. */
static void expand(const struct subspace *s, int k0, int n, const real *x, real *y)
{
    /* Picked columns add where others multiply. */
    for (int k = 0; k < n; k++)
        if (s->pick) y[s->pick[k0 + k]] += x[k];
        else screw_axpy(y, x[k], s->col + SPACE * (k0 + k));
}

/* y = columns' products with x. */
static void reduce(const struct subspace *s, int k0, int n, const real *x, real *y)
{
    for (int k = 0; k < n; k++)
        y[k] = s->pick ? x[s->pick[k0 + k]] : screw_dot(s->col + SPACE * (k0 + k), x);
}

void subspace_h(const struct subspace *s, const real *x, real *y) { expand(s, 0, s->d, x, y); }
void subspace_w(const struct subspace *s, const real *x, real *y) { expand(s, s->d, s->c, x, y); }
void subspace_h_transposed(const struct subspace *s, const real *x, real *y)
{
    reduce(s, 0, s->d, x, y);
}
void subspace_w_transposed(const struct subspace *s, const real *x, real *y)
{
    reduce(s, s->d, s->c, x, y);
}

/* As a vector, for those who multiply by it. */
void subspace_column(const struct subspace *s, int k, real *y)
{
    screw_zero(y);
    if (s->pick) y[s->pick[k]] = REAL(1);
    else screw_copy(y, s->col + SPACE * k);
}

/* Two products; picked columns choose rows and columns instead. */
void subspace_project(const struct subspace *a, bool a_w, const real *m, const struct subspace *b,
                      bool b_w, real *out)
{
    int a0 = a_w ? a->d : 0, na = a_w ? a->c : a->d, b0 = b_w ? b->d : 0, nb = b_w ? b->c : b->d;
    real t[SQUARE]; /* M B, (SPACE x nb) */
    /* First M B, one column after the other, then its products with the columns of A. */
    for (int j = 0; j < nb; j++)
        for (int i = 0; i < SPACE; i++)
            t[SPACE * j + i] = b->pick ? m[SPACE * i + b->pick[b0 + j]]
                                       : screw_dot(m + SPACE * i, b->col + SPACE * (b0 + j));
    for (int j = 0; j < nb; j++)
        for (int i = 0; i < na; i++)
            out[nb * i + j] = a->pick ? t[SPACE * j + a->pick[a0 + i]]
                                      : screw_dot(a->col + SPACE * (a0 + i), t + SPACE * j);
}
