/* compound.c - rake and merge (compound.h).
 *
 * A compound answers two forces with two accelerations, whatever bodies it consists of:
 *
 *     f_1, a_1 -> [ top joint ... bottom body ] <- f_2, a_2
 *
 * RAKE closes a joint between a leaf and the bottom of its parent: the leaf becomes an inertia dI
 * and a load dp that the parent feels. MERGE closes the joint between the bottom of u and the top
 * of v: f_v follows from the condition that the joint's constraints hold, and u and v become one
 * compound. */
#include "kernel/compound.h"

#include <string.h>

#include "linalg/dense.h"

/* Packed to full: products read rows and columns. */
static void unpack(const real *S, real *full)
{
    for (int i = 0; i < SPACE; i++)
        for (int j = 0; j <= i; j++)
            full[SPACE * i + j] = full[SPACE * j + i] = S[packed_index(i, j)];
}

/* pack: the symmetric part of a full matrix that is symmetric but for rounding. Taking the mean
 * keeps the system exactly symmetric, which the factorisation relies on. */
static void pack(const real *full, real *S, struct work *w)
{
    for (int i = 0; i < SPACE; i++)
        for (int j = 0; j <= i; j++)
            S[packed_index(i, j)] = (real)0.5 * (full[SPACE * i + j] + full[SPACE * j + i]);
    w->flop += 2 * PACKED;
}

static void transpose(const real *M, real *out)
{
    for (int i = 0; i < SPACE; i++)
        for (int j = 0; j < SPACE; j++) out[SPACE * j + i] = M[SPACE * i + j];
}

void packed_multiply(const real *S, const real *x, real *y, struct work *w)
{
    real full[SQUARE];
    unpack(S, full);
    for (int i = 0; i < SPACE; i++) y[i] = screw_dot(full + SPACE * i, x);
    w->flop += SQUARE_VEC_FLOP;
    w->call++;
}

/* soft_compliance: N = (Z + H s^-1 H^T)^-1 (physics 9.0). Every component of such a joint's force
 * is unknown, so that nothing is projected. */
static bool soft_compliance(const struct joint_view *v, const real *Z, real *N, struct work *w)
{
    real G[PACKED], inverse[SQUARE] = {0}, h[SPACE];
    memcpy(G, Z, sizeof G);
    for (int k = 0; k < v->s->d; k++) {
        subspace_column(v->s, k, h);
        for (int i = 0; i < SPACE; i++)
            for (int j = 0; j <= i; j++) G[packed_index(i, j)] += h[i] * h[j] / v->resistance;
    }
    if (!dense_factor(SPACE, G, G, w)) return false;
    for (int i = 0; i < SPACE; i++) inverse[(SPACE + 1) * i] = 1;
    dense_solve(SPACE, SPACE, G, inverse, w);
    pack(inverse, N, w);
    w->flop += (uint64_t)(v->s->d * 2 * PACKED);
    w->div += (uint64_t)(v->s->d * PACKED);
    return true;
}

bool joint_compliance(const struct joint_view *v, const real *Z, real *N, struct work *w)
{
    const struct subspace *s = v->s;
    /* N = W (W^T Z W)^-1 W^T: the force response of the constraints. It is formed explicitly,
     * because it is applied to many columns and also moved through the joint by itself. */
    const int c = s->c;
    real full[SQUARE], projected[SQUARE], G[PACKED], columns[SQUARE], spread[SQUARE];
    if (v->resistance > 0) return soft_compliance(v, Z, N, w);
    unpack(Z, full);
    subspace_project(s, true, full, s, true, projected);
    for (int i = 0; i < c; i++)
        for (int j = 0; j <= i; j++) G[packed_index(i, j)] = projected[i * c + j];
    /* Not positive definite: the joint's bodies have no inertia along W, or rounding has used it up
     * (physics 8.5). */
    if (!dense_factor(c, G, G, w)) return false;
    memset(projected, 0, sizeof projected); /* the inverse */
    for (int i = 0; i < c; i++) projected[i * c + i] = 1;
    dense_solve(c, c, G, projected, w);
    memset(full, 0, sizeof full);
    /* Axes that pick components: W spreads the inverse without a product. */
    if (s->pick) {
        for (int i = 0; i < c; i++)
            for (int j = 0; j < c; j++)
                full[SPACE * s->pick[s->d + i] + s->pick[s->d + j]] = projected[i * c + j];
    } else {
        /* W^T, (c x SPACE) */
        for (int k = 0; k < c; k++) subspace_column(s, s->d + k, columns + SPACE * k);
        dense_product(c, SPACE, c, projected, columns, spread, w);
        dense_product_tn(SPACE, SPACE, c, columns, spread, full, w);
        w->flop += (uint64_t)(SQUARE_VEC_FLOP * c + SCREW_DOT_FLOP * c * c);
    }
    pack(full, N, w);
    return true;
}

/* The joint force for each column: h_0 of (6.2), (6.4). Given forces and biases belong to column 0;
 * the other columns are unit loads of loop constraints. */
void joint_force(const struct joint_view *v, int m, const real *Z, const real *N, const real *beta,
                 const real *entry, real *h, struct work *w)
{
    for (int j = 0; j < m; j++) {
        real given[SPACE] = {0}, seen[SPACE], rest[SPACE];
        screw_copy(rest, beta + SPACE * j);
        if (j == 0 && v->active) {
            subspace_h(v->s, v->active, given);
            packed_multiply(Z, given, seen, w);
            screw_add(rest, seen);
            w->flop += SCREW_ADD_FLOP;
        }
        /* The acceleration of the parent's side counts against the own one. */
        if (entry) screw_sub(rest, entry + SPACE * j);
        if (j == 0 && v->bias) screw_sub(rest, v->bias);
        packed_multiply(N, rest, seen, w);
        for (int k = 0; k < SPACE; k++) h[SPACE * j + k] = given[k] - seen[k];
        w->flop += (uint64_t)((1 + (entry != NULL) + (j == 0 && v->bias)) * SCREW_ADD_FLOP);
    }
}

/* move_forces: out row k = X f_k (force): (X M^T)^T for the rows of M. 42 flops a row instead of
 * the 66 of a square matrix. */
static void move_forces(const struct xform *x, const real *M, real *out, struct work *w)
{
    for (int k = 0; k < SPACE; k++) xform_force(out + SPACE * k, x, M + SPACE * k);
    w->flop += SPACE * XFORM_FORCE_FLOP;
    w->call++;
}

/* move_motions: out row k = X^T row k: M X. */
static void move_motions(const struct xform *x, const real *M, real *out, struct work *w)
{
    for (int k = 0; k < SPACE; k++) xform_motion(out + SPACE * k, x, M + SPACE * k);
    w->flop += SPACE * XFORM_MOTION_FLOP;
    w->call++;
}

/* physics (6.2): dI = X N X^T, dp = X h. Both are sums over leaves, and a leaf is only needed again
 * to receive its force. */
bool compound_rake(const struct joint_view *v, int m, const struct compound *leaf, real *joint,
                   real *dI, real *dp, struct work *w)
{
    real full[SQUARE], moved[SQUARE], packed[PACKED], carried[SPACE];
    real *N = joint, *h = joint + PACKED;
    if (!joint_compliance(v, leaf->p11, N, w)) return false;
    joint_force(v, m, leaf->p11, N, leaf->beta1, NULL, h, w);
    unpack(N, full);
    move_forces(v->x, full, moved, w); /* N X^T */
    transpose(moved, full);
    move_forces(v->x, full, moved, w); /* X N X^T */
    pack(moved, packed, w);
    for (int i = 0; i < PACKED; i++) dI[i] += packed[i];
    for (int j = 0; j < m; j++) {
        xform_force(carried, v->x, h + SPACE * j);
        screw_add(dp + SPACE * j, carried);
    }
    w->flop += (uint64_t)(PACKED + m * (XFORM_FORCE_FLOP + SCREW_ADD_FLOP));
    return true;
}

/* physics (6.3): K = (U + P22 dI)^-1 applied to everything that the parent's bottom body sees. P22
 * dI is not symmetric, hence a general solution. */
bool compound_absorb(int m, struct compound *u, const real *dI, const real *dp, real *record,
                     struct work *w)
{
    real load[SQUARE], P12[SQUARE], P22[SQUARE], K[SQUARE], column[SPACE], right[2 * SQUARE];
    real product[SQUARE], *n21 = record + PACKED;
    real *after22 = n21 + SQUARE, *dp_kept = record + COMPOUND_MATRICES,
         *beta2 = dp_kept + SPACE * m;
    memcpy(record, dI, PACKED * sizeof *record);
    memcpy(dp_kept, dp, (size_t)(SPACE * m) * sizeof *dp);
    unpack(dI, load);
    unpack(u->p22, P22);
    memcpy(P12, u->p12, sizeof P12);
    dense_product(SPACE, SPACE, SPACE, P22, load, K, w);
    for (int i = 0; i < SPACE; i++) K[(SPACE + 1) * i] += 1;
    /* Right-hand sides [P12^T, P22] in one solution: n21 and the new P22. */
    for (int i = 0; i < SPACE; i++)
        for (int j = 0; j < SPACE; j++)
            right[2 * SPACE * i + j] = P12[SPACE * j + i],
            right[2 * SPACE * i + SPACE + j] = P22[SPACE * i + j];
    /* The solver destroys its matrix; the columns below need it again. */
    real again[SQUARE];
    memcpy(again, K, sizeof K);
    if (!dense_solve_general(SPACE, 2 * SPACE, K, right, w)) return false;
    for (int i = 0; i < SPACE; i++)
        for (int j = 0; j < SPACE; j++)
            n21[SPACE * i + j] = right[2 * SPACE * i + j],
            product[SPACE * i + j] = right[2 * SPACE * i + SPACE + j];
    pack(product, after22, w);
    /* K (beta_2 - P22 dp), one column at a time; then beta_1 -= P12 (dp + dI beta_2) */
    for (int j = 0; j < m; j++) {
        real K_copy[SQUARE];
        memcpy(K_copy, again, sizeof again);
        packed_multiply(u->p22, dp + SPACE * j, column, w);
        for (int k = 0; k < SPACE; k++) beta2[SPACE * j + k] = u->beta2[SPACE * j + k] - column[k];
        struct work uncounted = {0}; /* the factors are those of the solution above */
        if (!dense_solve_general(SPACE, 1, K_copy, beta2 + SPACE * j, &uncounted)) return false;
        packed_multiply(dI, beta2 + SPACE * j, column, w);
        screw_add(column, dp + SPACE * j);
        for (int k = 0; k < SPACE; k++)
            u->beta1[SPACE * j + k] -= screw_dot(P12 + SPACE * k, column);
        w->flop += 2 * SQUARE + SQUARE_VEC_FLOP + 3 * SCREW_ADD_FLOP;
    }
    /* P11 -= P12 dI n21, with the old P12. */
    dense_product(SPACE, SPACE, SPACE, load, n21, product, w);
    dense_product(SPACE, SPACE, SPACE, P12, product, K, w);
    pack(K, product, w);
    for (int i = 0; i < PACKED; i++) u->p11[i] -= product[i];
    transpose(n21, u->p12);
    memcpy(u->p22, after22, PACKED * sizeof(real));
    memcpy(u->beta2, beta2, (size_t)(SPACE * m) * sizeof(real));
    w->flop += SPACE + PACKED;
    return true;
}

/* pulled_back: Z (packed) = P11 + X^T P22 X: what the joint between two compounds feels (physics
 * 6.4). */
static void pulled_back(const struct xform *x, const real *p11, const real *p22, real *Z,
                        struct work *w)
{
    real full[SQUARE], moved[SQUARE];
    unpack(p22, full);
    move_motions(x, full, moved, w); /* P22 X */
    transpose(moved, full);
    move_motions(x, full, moved, w); /* X^T P22 X */
    pack(moved, Z, w);
    for (int i = 0; i < PACKED; i++) Z[i] += p11[i];
    w->flop += PACKED;
}

/* subtract_product: S (packed) -= A B for full A, B with symmetric product; half of it is
 * computed. */
static void subtract_product(const real *A, const real *B, real *S, struct work *w)
{
    for (int i = 0; i < SPACE; i++)
        for (int j = 0; j <= i; j++) {
            real sum = A[SPACE * i] * B[j];
            for (int k = 1; k < SPACE; k++) sum += A[SPACE * i + k] * B[SPACE * k + j];
            S[packed_index(i, j)] -= sum;
        }
    w->flop += PACKED * SCREW_AXPY_FLOP;
    w->call++;
}

bool compound_merge(const struct joint_view *v, int m, struct compound *u,
                    const struct compound *below, real *record, struct work *w)
{
    real Z[PACKED], N[PACKED], full[SQUARE], P12X[SQUARE], turned[SQUARE];
    real *h = record, *M1 = record + SPACE * m, *M3 = M1 + SQUARE;
    real entry[SPACE], moved[SPACE];
    /* Z, N and h_0: the joint in between, once u's bottom and v's top act on each other. */
    pulled_back(v->x, below->p11, u->p22, Z, w);
    if (!joint_compliance(v, Z, N, w)) return false;
    for (int j = 0; j < m; j++) xform_motion(h + SPACE * j, v->x, u->beta2 + SPACE * j);
    w->flop += (uint64_t)(m * XFORM_MOTION_FLOP);
    /* one column at a time: h holds the entries until they are used */
    for (int j = 0; j < m; j++) {
        struct joint_view column = *v;
        if (j > 0) column.active = column.bias = NULL;
        screw_copy(entry, h + SPACE * j);
        joint_force(&column, 1, Z, N, below->beta1 + SPACE * j, entry, h + SPACE * j, w);
    }
    /* M_1 = N X^T P12_u^T and M_3 = N P12_v: f_v as a function of the forces at both ends. */
    move_motions(v->x, u->p12, P12X, w);
    unpack(N, full);
    transpose(P12X, turned);
    dense_product(SPACE, SPACE, SPACE, full, turned, M1, w);
    dense_product(SPACE, SPACE, SPACE, full, below->p12, M3, w);
    memcpy(M3 + SQUARE, v->x, XFORM_NUMBERS * sizeof(real));
    /* The new matrices of (6.4). P22 is v's, since v's bottom is the bottom of both. */
    subtract_product(P12X, M1, u->p11, w);
    dense_product(SPACE, SPACE, SPACE, P12X, M3, u->p12, w);
    transpose(below->p12, turned);
    memcpy(u->p22, below->p22, PACKED * sizeof(real));
    subtract_product(turned, M3, u->p22, w);
    for (int j = 0; j < m; j++) {
        for (int k = 0; k < SPACE; k++) {
            u->beta1[SPACE * j + k] -= screw_dot(P12X + SPACE * k, h + SPACE * j);
            moved[k] = screw_dot(turned + SPACE * k, h + SPACE * j);
        }
        for (int k = 0; k < SPACE; k++)
            u->beta2[SPACE * j + k] = below->beta2[SPACE * j + k] + moved[k];
        w->flop += 2 * (SQUARE_VEC_FLOP + SCREW_ADD_FLOP);
    }
    return true;
}
