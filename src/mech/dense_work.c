/* dense_work.c - operation counts of generic 6x6 code. */
#include "mech/dense_work.h"

enum {
    MM = 396,               /* 6x6 times 6x6 */
    MV = 66,                /* 6x6 times vector */
    PLACE = 18 + MM,        /* rotation, then the tree transform times the joint's */
    SCAN = MV + 6,          /* transform a vector and add */
    BIAS = 3 * MV + 22,     /* b with cross products as matrices */
    SHIFT = 2 * MM,         /* inertia to the joint's origin */
    LOAD = SHIFT + 3 * MV + MV + 24, /* I A + P - load, P = V x I V */
    INVERT = 2 * 6 * 6 * 6  /* inverse of the inertia */
};

static void add(struct work *w, int flop) { w->flop += (uint64_t)flop; }

/* Velocities, and bias accelerations: the part that all methods share. */
static void add_velocities(int d, struct work *w)
{
    add(w, PLACE + 6 * d + SCAN + BIAS);
    w->trig += 2;
    w->call += 4;
}

void dense_work_inverse(const struct model *m, struct work *w)
{
    for (int i = 0; i < m->nbody; i++) {
        int d = joint_nu(m->body[i].joint);
        add_velocities(d, w);
        add(w, 12 * d + SCAN + LOAD + SCAN + 12 * d);
        w->call += 5;
    }
}

static void add_articulated(const struct model *m, struct work *w)
{
    for (int i = 0; i < m->nbody; i++) {
        int d = joint_nu(m->body[i].joint);
        add_velocities(d, w);
        add(w, SHIFT + 3 * MV + 12);                      /* I, P - load */
        add(w, MV * d + 11 * d * d + d * d * d / 3 + 12 * d); /* Q = I H, H^T Q, factor, e */
        add(w, 36 * 2 * d + 6 * d * d + MV + 12 * d + 12); /* I^a, p^a */
        add(w, 2 * MM + 36 + SCAN);                       /* X I^a X^T, X p^a to the parent */
        add(w, SCAN + 6 + 12 * d + 2 * d * d + 12 * d);   /* a, u' */
        w->div += (uint64_t)d;
        w->call += 9;
    }
}

/* Composite inertias, then every pair of a body and one of its ancestors. */
static void add_composite(const struct model *m, struct work *w)
{
    for (int i = 0; i < m->nbody; i++) {
        int d = joint_nu(m->body[i].joint);
        add(w, 2 * MM + 36 + (MV + 11 * d) * d);
        w->call += 3;
        for (int j = m->body[i].parent; j >= 0; j = m->body[j].parent)
            add(w, (MV + 11 * joint_nu(m->body[j].joint)) * d);
    }
}

static void add_cholesky(const struct model *m, struct work *w)
{
    uint64_t n = (uint64_t)m->nu;
    w->flop += n * (n + 1) * (2 * n + 1) / 6 - n * (n + 1) / 2 + 2 * n * n;
    w->div += n * (n + 1) / 2;
    w->sqrt += n;
}

/* The same with the zeros of the tree left alone: each pair on a path once for each common ancestor. */
static void add_sparse_factor(const struct model *m, struct work *w)
{
    for (int i = 0; i < m->nbody; i++) {
        uint64_t depth = 0, d = (uint64_t)joint_nu(m->body[i].joint);
        for (int j = m->body[i].parent; j >= 0; j = m->body[j].parent) depth += (uint64_t)joint_nu(m->body[j].joint);
        w->flop += d * (depth * (depth + 1) + 4 * depth);
        w->div += d * (depth + 1);
    }
}

/* Blocks of A, B, C and the block elimination: c constraints of a joint, cp of the one before. */
static void add_constraints(const struct model *m, bool direct, struct work *w)
{
    for (int i = 0; i < m->nbody; i++) {
        int d = joint_nu(m->body[i].joint), c = 6 - d, p = m->body[i].parent;
        int cp = p < 0 ? 0 : 6 - joint_nu(m->body[p].joint);
        add(w, SHIFT + INVERT);                                          /* Phi */
        add(w, p < 0 ? 0 : 2 * MM + 36);                                 /* E = X^T Phi, D */
        add(w, MV * c + 11 * c * c + (p < 0 ? 0 : MV * cp + 11 * c * cp)); /* A_ii, L_i */
        add(w, 3 * (MV * d + 11 * c * d) + 2 * (MV * d + 11 * d * d));   /* B, C */
        add(w, 60);                                                      /* right-hand side, u' */
        add(w, 2 * c * c * c + 2 * (2 * c - 1) * c * cp + 4 * c * c + 4 * c * cp); /* inverse, Schur, solve */
        w->div += (uint64_t)c;
        w->call += 14;
        if (direct) add_velocities(d, w);
    }
    if (!direct) dense_work_inverse(m, w);
}

void dense_work_forward(const struct model *m, enum forward_method method, struct work *w)
{
    switch (method) {
    case FORWARD_ABA: add_articulated(m, w); break;
    case FORWARD_CRBA:
    case FORWARD_CRBA_SPARSE:
        dense_work_inverse(m, w);
        add_composite(m, w);
        if (method == FORWARD_CRBA)
            add_cholesky(m, w);
        else
            add_sparse_factor(m, w);
        break;
    case FORWARD_CFA_PAPER: add_constraints(m, false, w); break;
    case FORWARD_CFA_DIRECT:
    case FORWARD_CFA_ROBUST: add_constraints(m, true, w); break;
    case FORWARD_METHODS: break;
    }
}
