/* compound.c - rake and merge (compound.h). */
#include "kernel/compound.h"

#include <string.h>

#include "linalg/dense.h"

static void unpack(const real *S, real *full)
{
    for (int i = 0; i < 6; i++)
        for (int j = 0; j <= i; j++) full[6 * i + j] = full[6 * j + i] = S[packed_index(i, j)];
}

/* pack: the symmetric part of a full matrix that is symmetric but for rounding. */
static void pack(const real *full, real *S)
{
    for (int i = 0; i < 6; i++)
        for (int j = 0; j <= i; j++) S[packed_index(i, j)] = (full[6 * i + j] + full[6 * j + i]) / 2;
}

static void transpose(const real *M, real *out)
{
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) out[6 * j + i] = M[6 * i + j];
}

void packed_multiply(const real *S, const real *x, real *y, struct work *w)
{
    real full[36];
    unpack(S, full);
    for (int i = 0; i < 6; i++) y[i] = six_dot(full + 6 * i, x);
    w->flop += 66;
    w->call++;
}

bool joint_compliance(const struct subspace *s, const real *Z, real *N, struct work *w)
{
    const int c = s->c;
    real full[36], projected[36], G[21], columns[36], spread[36];
    unpack(Z, full);
    subspace_project(s, true, full, s, true, projected);
    for (int i = 0; i < c; i++)
        for (int j = 0; j <= i; j++) G[packed_index(i, j)] = projected[i * c + j];
    if (!dense_factor(c, G, G, w)) return false;
    memset(projected, 0, sizeof projected); /* the inverse */
    for (int i = 0; i < c; i++) projected[i * c + i] = 1;
    dense_solve(c, c, G, projected, w);
    memset(full, 0, sizeof full);
    if (s->pick) {
        for (int i = 0; i < c; i++)
            for (int j = 0; j < c; j++) full[6 * s->pick[s->d + i] + s->pick[s->d + j]] = projected[i * c + j];
    } else {
        for (int k = 0; k < c; k++) subspace_column(s, s->d + k, columns + 6 * k); /* W^T, (c x 6) */
        dense_product(c, 6, c, projected, columns, spread, w);
        dense_product_tn(6, 6, c, columns, spread, full, w);
        w->flop += (uint64_t)(66 * c + 11 * c * c);
    }
    pack(full, N);
    return true;
}

void joint_force(const struct joint_view *v, int m, const real *Z, const real *N, const real *beta, const real *entry,
                 real *h, struct work *w)
{
    for (int j = 0; j < m; j++) {
        real given[6] = {0}, seen[6], rest[6];
        six_copy(rest, beta + 6 * j);
        if (j == 0 && v->active) {
            subspace_h(v->s, v->active, given);
            packed_multiply(Z, given, seen, w);
            six_add(rest, seen);
            w->flop += SIX_ADD_FLOP;
        }
        if (entry) six_sub(rest, entry + 6 * j);
        if (j == 0 && v->bias) six_sub(rest, v->bias);
        packed_multiply(N, rest, seen, w);
        for (int k = 0; k < 6; k++) h[6 * j + k] = given[k] - seen[k];
        w->flop += 3 * SIX_ADD_FLOP;
    }
}

/* move_rows: out row k = X f_k (force): (X M^T)^T for the rows of M. */
static void move_forces(const struct xform *x, const real *M, real *out, struct work *w)
{
    for (int k = 0; k < 6; k++) xform_force(out + 6 * k, x, M + 6 * k);
    w->flop += 6 * XFORM_FORCE_FLOP;
    w->call++;
}

/* move_motions: out row k = X^T row k: M X. */
static void move_motions(const struct xform *x, const real *M, real *out, struct work *w)
{
    for (int k = 0; k < 6; k++) xform_motion(out + 6 * k, x, M + 6 * k);
    w->flop += 6 * XFORM_MOTION_FLOP;
    w->call++;
}

bool compound_rake(const struct joint_view *v, int m, const struct compound *leaf, real *joint, real *dI, real *dp,
                   struct work *w)
{
    real full[36], moved[36], packed[21], carried[6];
    real *N = joint, *h = joint + 21;
    if (!joint_compliance(v->s, leaf->p11, N, w)) return false;
    joint_force(v, m, leaf->p11, N, leaf->beta1, NULL, h, w);
    unpack(N, full);
    move_forces(v->x, full, moved, w); /* N X^T */
    transpose(moved, full);
    move_forces(v->x, full, moved, w); /* X N X^T */
    pack(moved, packed);
    for (int i = 0; i < 21; i++) dI[i] += packed[i];
    for (int j = 0; j < m; j++) {
        xform_force(carried, v->x, h + 6 * j);
        six_add(dp + 6 * j, carried);
    }
    w->flop += (uint64_t)(21 + m * (XFORM_FORCE_FLOP + SIX_ADD_FLOP));
    return true;
}

bool compound_absorb(int m, struct compound *u, const real *dI, const real *dp, real *record, struct work *w)
{
    real load[36], P12[36], P22[36], K[36], column[6], right[6 * 12], *n21 = record + 21, product[36];
    real *after22 = record + 57, *dp_kept = record + 78, *beta2 = dp_kept + 6 * m;
    memcpy(record, dI, 21 * sizeof *record);
    memcpy(dp_kept, dp, (size_t)(6 * m) * sizeof *dp);
    unpack(dI, load);
    unpack(u->p22, P22);
    memcpy(P12, u->p12, sizeof P12);
    dense_product(6, 6, 6, P22, load, K, w);
    for (int i = 0; i < 6; i++) K[7 * i] += 1;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) right[12 * i + j] = P12[6 * j + i], right[12 * i + 6 + j] = P22[6 * i + j];
    real again[36];
    memcpy(again, K, sizeof K);
    if (!dense_solve_general(6, 12, K, right, w)) return false;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) n21[6 * i + j] = right[12 * i + j], product[6 * i + j] = right[12 * i + 6 + j];
    pack(product, after22);
    for (int j = 0; j < m; j++) { /* K (beta_2 - P22 dp), one column at a time; then beta_1 -= P12 (dp + dI beta_2) */
        real K_copy[36];
        memcpy(K_copy, again, sizeof again);
        packed_multiply(u->p22, dp + 6 * j, column, w);
        for (int k = 0; k < 6; k++) beta2[6 * j + k] = u->beta2[6 * j + k] - column[k];
        struct work uncounted = {0}; /* the factors are those of the solution above */
        if (!dense_solve_general(6, 1, K_copy, beta2 + 6 * j, &uncounted)) return false;
        packed_multiply(dI, beta2 + 6 * j, column, w);
        six_add(column, dp + 6 * j);
        for (int k = 0; k < 6; k++) u->beta1[6 * j + k] -= six_dot(P12 + 6 * k, column);
        w->flop += 72 + 66 + 3 * SIX_ADD_FLOP;
    }
    dense_product(6, 6, 6, load, n21, product, w);
    dense_product(6, 6, 6, P12, product, K, w);
    pack(K, product);
    for (int i = 0; i < 21; i++) u->p11[i] -= product[i];
    transpose(n21, u->p12);
    memcpy(u->p22, after22, 21 * sizeof(real));
    memcpy(u->beta2, beta2, (size_t)(6 * m) * sizeof(real));
    w->flop += 6 + 21;
    return true;
}

/* pulled_back: Z (packed) = P11 + X^T P22 X. */
static void pulled_back(const struct xform *x, const real *p11, const real *p22, real *Z, struct work *w)
{
    real full[36], moved[36];
    unpack(p22, full);
    move_motions(x, full, moved, w); /* P22 X */
    transpose(moved, full);
    move_motions(x, full, moved, w); /* X^T P22 X */
    pack(moved, Z);
    for (int i = 0; i < 21; i++) Z[i] += p11[i];
    w->flop += 21;
}

/* subtract_product: S (packed) -= A B for full A, B with symmetric product; half of it is computed. */
static void subtract_product(const real *A, const real *B, real *S, struct work *w)
{
    for (int i = 0; i < 6; i++)
        for (int j = 0; j <= i; j++) {
            real sum = 0;
            for (int k = 0; k < 6; k++) sum += A[6 * i + k] * B[6 * k + j];
            S[packed_index(i, j)] -= sum;
        }
    w->flop += 21 * 12;
    w->call++;
}

bool compound_merge(const struct joint_view *v, int m, struct compound *u, const struct compound *below, real *record,
                    struct work *w)
{
    real Z[21], N[21], full[36], P12X[36], turned[36], *h = record, *M1 = record + 6 * m, *M3 = M1 + 36;
    real entry[6], moved[6];
    pulled_back(v->x, below->p11, u->p22, Z, w);
    if (!joint_compliance(v->s, Z, N, w)) return false;
    for (int j = 0; j < m; j++) xform_motion(h + 6 * j, v->x, u->beta2 + 6 * j);
    w->flop += (uint64_t)(m * XFORM_MOTION_FLOP);
    for (int j = 0; j < m; j++) { /* one column at a time: h holds the entries until they are used */
        struct joint_view column = *v;
        if (j > 0) column.active = column.bias = NULL;
        six_copy(entry, h + 6 * j);
        joint_force(&column, 1, Z, N, below->beta1 + 6 * j, entry, h + 6 * j, w);
    }
    move_motions(v->x, u->p12, P12X, w);
    unpack(N, full);
    transpose(P12X, turned);
    dense_product(6, 6, 6, full, turned, M1, w);
    dense_product(6, 6, 6, full, below->p12, M3, w);
    memcpy(M3 + 36, v->x, 12 * sizeof(real));
    subtract_product(P12X, M1, u->p11, w);
    dense_product(6, 6, 6, P12X, M3, u->p12, w);
    transpose(below->p12, turned);
    memcpy(u->p22, below->p22, 21 * sizeof(real));
    subtract_product(turned, M3, u->p22, w);
    for (int j = 0; j < m; j++) {
        for (int k = 0; k < 6; k++) {
            u->beta1[6 * j + k] -= six_dot(P12X + 6 * k, h + 6 * j);
            moved[k] = six_dot(turned + 6 * k, h + 6 * j);
        }
        for (int k = 0; k < 6; k++) u->beta2[6 * j + k] = below->beta2[6 * j + k] + moved[k];
        w->flop += 2 * (66 + SIX_ADD_FLOP);
    }
    return true;
}
