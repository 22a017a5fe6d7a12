/* dense_tally.c - sums over the bodies of products of full matrices; see dense_tally.h. */
#include "kernel/dense_tally.h"

#include <stdint.h>

/* An a x b matrix by a b x k one. */
static uint64_t product(int a, int b, int k) { return (uint64_t)(a * k * (2 * b - 1)); }

/* flops for one body, sizes as in the column "dense" of physics 2.5. */
enum {
    PLACE = 58 + 396,      /* joint transform, expanded and multiplied by the tree's */
    SCAN = 66 + 6,         /* X v + w */
    BIAS = 220,            /* velocity-dependent acceleration */
    MOVED_INERTIA = 792,   /* S^T I S, two products of 6x6 matrices */
    GYROSCOPIC = 222,      /* velocity-dependent force */
    INVERTED_INERTIA = 432 /* of a 6x6 matrix */
};

/* Newton-Euler: place, velocity, acceleration, load, force, projection. 14 operator calls. */
static uint64_t newton_euler(int d)
{
    return PLACE + 6 * (uint64_t)d + SCAN + BIAS + 12 * (uint64_t)d + SCAN + MOVED_INERTIA +
           GYROSCOPIC + 66 + SCAN + 12 * (uint64_t)d;
}

/* Articulated bodies (physics 2.6, 2.7): U = I H, D = H^T U, I - U D^-1 U^T, X^T I X, X^T p, the
 * accelerations outwards. 18 calls. */
static uint64_t articulated(int d)
{
    const uint64_t velocity = PLACE + 6 * (uint64_t)d + SCAN + BIAS + MOVED_INERTIA + GYROSCOPIC;
    const uint64_t reduce = product(6, 6, d) + product(d, 6, d) + 12 * (uint64_t)d +
                            product(6, d, d) + product(6, d, 6) + 36;
    const uint64_t inwards = SCAN + product(6, d, 1) + 6 + 2 * product(6, 6, 6) + 36 + SCAN;
    return velocity + reduce + inwards + SCAN + 24 * (uint64_t)d + product(d, d, 1);
}

/* Composite bodies (physics 2.3): the inertia moved inwards, one column of the mass matrix for each
 * ancestor. */
static uint64_t composite(int d, int ancestors)
{
    const uint64_t project = product(6, 6, d) + product(d, 6, d);
    return 2 * product(6, 6, 6) + 36 + project + (uint64_t)ancestors * project;
}

/* Constraint forces (physics 4.2): blocks of A (with B and C in the paper's form), factors and
 * back-substitution. 31 calls. The direct form needs no force sweep, hence the subtraction. */
static uint64_t constraint_forces(int d, bool paper)
{
    const int c = 6 - d;
    const uint64_t block = product(6, 6, c) + product(c, 6, c), other = product(6, 6, d);
    uint64_t flops = newton_euler(d) + MOVED_INERTIA + INVERTED_INERTIA + 2 * product(6, 6, 6) +
                     36 + 2 * block + 60;
    if (paper) flops += 2 * other + product(c, 6, d) + product(d, 6, d);
    else flops -= SCAN + 12 * (uint64_t)d;
    return flops + (uint64_t)(2 * c * c * c) + 2 * product(c, c, c) + 4 * product(c, c, 1);
}

static int joint_freedom(const struct model *m, int i) { return m->u_at[i + 1] - m->u_at[i]; }

static int ancestors_of(const struct model *m, int i)
{
    int n = 0;
    for (int k = m->body[i].parent; k >= 0; k = m->body[k].parent) n++;
    return n;
}

void dense_tally_inverse(const struct model *m, struct work *w)
{
    w->flop = 0;
    w->call = 14 * (uint64_t)m->nbody;
    for (int i = 0; i < m->nbody; i++) w->flop += newton_euler(joint_freedom(m, i));
}

/* Newton-Euler for the bias, Cholesky n (n+1) (2n+1)/6 and two triangular solutions 2 n^2. */
static void mass_matrix(const struct model *m, struct work *w)
{
    const uint64_t n = (uint64_t)m->nu;
    dense_tally_inverse(m, w);
    w->flop += n * (n + 1) * (2 * n + 1) / 6 + 2 * n * n;
    for (int i = 0; i < m->nbody; i++) {
        int ancestors = ancestors_of(m, i);
        w->flop += composite(joint_freedom(m, i), ancestors);
        w->call += 4 + 2 * (uint64_t)ancestors;
    }
}

void dense_tally_forward(const struct model *m, enum forward_method method, struct work *w)
{
    if (method == FORWARD_CRBA || method == FORWARD_CRBA_SPARSE) {
        mass_matrix(m, w);
        return;
    }
    w->flop = 0;
    w->call = (method == FORWARD_ABA ? 18u : 31u) * (uint64_t)m->nbody;
    for (int i = 0; i < m->nbody; i++) {
        int d = joint_freedom(m, i);
        w->flop += method == FORWARD_ABA ? articulated(d)
                                         : constraint_forces(d, method == FORWARD_CFA_PAPER);
    }
}
