/* forward_exact.c - the operator form of the constraints in twice the working precision
 * (forward_exact.h). */
#include "kernel/forward_exact.h"

#include "kernel/extremes.h"
#include "kernel/forward_rows.h"

/* Working precision to the longer type: exact. */
static void widen(const real *x, twice *y)
{
    for (int k = 0; k < SPACE; k++) y[k] = x[k];
}

/* Forces of the present solution become the leading digits; corrections are added to both forms. */
void exact_begin(struct forward *f)
{
    const struct chain *ch = &f->chain;
    for (int i = ch->lo; i < ch->hi; i++) widen(chain_at(ch, f->force, i), exact_force(f, i));
    if (ch->lo > 0) widen(f->force_left, exact_force(f, ch->lo - 1));
    if (ch->hi < ch->n) widen(f->force_right, exact_force(f, ch->hi));
}

/* y = M x, or M^T x; y may be x. */
static void multiply(const real *M, bool transposed, const twice *x, twice *y)
{
    twice sum[SPACE] = {0};
    for (int i = 0; i < SQUARE; i++) /* most of the factors are zeros */
        if (M[i] != 0)
            sum[transposed ? i % SPACE : i / SPACE] +=
                (twice)M[i] * x[transposed ? i / SPACE : i % SPACE];
    for (int i = 0; i < SPACE; i++) y[i] = sum[i];
}

/* X is applied as the product of its shift and its rotation, whose entries are numbers of working
 * precision: multiplied out, X itself would be rounded. y = X f, or X^T v, by the factors of X,
 * which are exact; y may be the argument. */
static void transform(struct forward *f, int i, bool transposed, twice *y)
{
    real shift[SQUARE] = {0}, turn[SQUARE] = {0};
    xform_factors(&chain_pose(&f->chain, i)->x, shift, turn);
    multiply(transposed ? shift : turn, transposed, y, y);
    multiply(transposed ? turn : shift, transposed, y, y);
    f->chain.work.flop += TWICE_FLOP * (transposed ? XFORM_MOTION_FLOP : XFORM_FORCE_FLOP);
}

/* y = S^-1 x for the symmetric positive definite `about` of a body, by Cholesky's factors without
 * roots (L D L^T): roots in twice the digits would be expensive. Zeros at the beginning of a row
 * stay zeros in its factor, so that nothing is computed with them: an inertia is a block of three
 * rows at most, and a mass. */
static void divide(const real *about, twice *y)
{
    twice L[SQUARE], D[SPACE];
    int first[SPACE]; /* of each row: where it begins */
    for (int i = 0; i < SPACE; i++) {
        for (first[i] = 0; first[i] < i && about[SPACE * i + first[i]] == 0;) first[i]++;
        for (int j = first[i]; j <= i; j++) {
            twice sum = about[SPACE * i + j];
            for (int k = first[i] > first[j] ? first[i] : first[j]; k < j; k++)
                sum -= L[SPACE * i + k] * D[k] * L[SPACE * j + k];
            if (i == j) D[i] = sum;
            else L[SPACE * i + j] = sum / D[j];
        }
        for (int k = first[i]; k < i; k++) y[i] -= L[SPACE * i + k] * y[k];
    }
    for (int i = 0; i < SPACE; i++) y[i] /= D[i];
    /* By rows of L^T, whose numbers stand below the diagonal of L. */
    for (int i = SPACE - 1; i >= 0; i--)
        for (int k = i + 1; k < SPACE; k++)
            if (i >= first[k]) y[i] -= L[SPACE * k + i] * y[k];
}

/* y = I^-1 y, I = shift about shift^T; shift is a unit matrix plus a block whose square is zero, so
 * that its inverse is the same with the block's sign changed. */
static void accelerate(struct forward *f, int i, twice *y)
{
    real shift[SQUARE] = {0}, about[SQUARE] = {0};
    body_inertia_factors(forward_body(f, i), shift, about);
    for (int k = 0; k < SQUARE; k++) shift[k] = k % (SPACE + 1) == 0 ? 1 : -shift[k];
    multiply(shift, false, y, y);
    divide(about, y);
    multiply(shift, true, y, y);
    f->chain.work.flop += TWICE_FLOP * BODY_ACCELERATE_FLOP;
    f->chain.work.call++;
}

/* y: acceleration of body i by its forces: Phi_i (F_i - X_{i+1} F_{i+1} + gain), physics 4.8. */
static void body_acceleration(struct forward *f, int i, const real *gain, twice *y)
{
    const struct chain *ch = &f->chain;
    twice above[SPACE];
    for (int k = 0; k < SPACE; k++) y[k] = exact_force(f, i)[k];
    if (i + 1 < ch->n) {
        for (int k = 0; k < SPACE; k++) above[k] = exact_force(f, i + 1)[k];
        transform(f, i + 1, false, above);
        for (int k = 0; k < SPACE; k++) y[k] -= above[k];
    }
    for (int k = 0; gain && k < SPACE; k++) y[k] += gain[k];
    accelerate(f, i, y);
    f->chain.work.flop += 2 * TWICE_FLOP * SCREW_ADD_FLOP;
}

/* narrow: x rounded. */
static void narrow(const twice *x, real *y)
{
    for (int k = 0; k < SPACE; k++) y[k] = (real)x[k];
}

/* physics (4.8) body by body: z = y_i - X_i^T y_{i-1} - b_i. Everything is held in twice the digits
 * and rounded once at the end; the factored system then corrects what is left. */
void exact_operator_form(struct forward *f, bool gain, bool bias, bool base)
{
    struct chain *ch = &f->chain;
    twice before[SPACE], y[SPACE], moved[SPACE];
    real rounded[SPACE], residual = 0, scale = 0;
    /* The body before the block is computed here again: its forces are known on both sides. */
    if (ch->lo > 0) body_acceleration(f, ch->lo - 1, gain ? f->gain_left : NULL, before);
    else widen(ch->shared->base, before);
    for (int i = ch->lo; i < ch->hi; i++) {
        real *z = chain_at(ch, f->z, i);
        body_acceleration(f, i, gain ? chain_at(ch, f->gain, i) : NULL, y);
        narrow(y, rounded);
        scale = largest_size(scale, SPACE, rounded);
        /* Without a base term nothing comes from below the first body. */
        for (int k = 0; k < SPACE; k++) moved[k] = i > 0 || base ? before[k] : 0;
        if (i > 0 || base) transform(f, i, true, moved);
        for (int k = 0; k < SPACE; k++) before[k] = y[k];
        for (int k = 0; k < SPACE; k++) y[k] -= moved[k] + (bias ? chain_at(ch, ch->b, i)[k] : 0);
        ch->work.flop += 2 * TWICE_FLOP * SCREW_ADD_FLOP;
        narrow(y, z);
        forward_violation(f, i, z, rounded);
        residual = largest_size(residual, forward_row_size(f, i), rounded);
    }
    f->residual = scale > 0 ? residual / scale : residual;
    f->residual_scale = scale;
}
