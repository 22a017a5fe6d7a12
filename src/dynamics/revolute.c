/* revolute.c - compact constants of all-revolute systems; what their fast paths execute. */
#include "dynamics/revolute.h"

#include "model/model_part.h"

/* 22 numbers a body in one piece of memory: what the three sweeps read. */
struct revolute *revolutes_take(const struct model *m, const struct body *b, struct arena *a)
{
    /* From the rounded constants, so that both texts compute with the same numbers. */
    struct revolute *out = TAKE_FULL(a, m->nbody, struct revolute, model_whole(m));
    for (int i = m->first; i < m->end; i++) {
        struct revolute *r = &out[i];
        const real *j = b[i].mass->jc, half = REAL(0.5);
        for (int k = 0; k < 9; k++) r->e[k] = b[i].tree.r[k];
        vec3_copy(r->t, b[i].tree.p);
        r->m = b[i].mass->inertia.m;
        vec3_copy(r->s, b[i].mass->s);
        /* S = tr(J)/2 U - J: the products of inertia change sign. */
        r->second[0] = half * ((j[3] - j[0]) + j[5]);
        r->second[3] = half * ((j[0] - j[3]) + j[5]);
        r->second[5] = half * ((j[0] - j[5]) + j[3]);
        r->second[1] = -j[1], r->second[2] = -j[2], r->second[4] = -j[4];
        r->parent = b[i].parent;
    }
    return out;
}

/* The counts of the three fast paths have one shape. */
void revolute_count(const struct dynamics *d, struct revolute_cost cost, struct work *w)
{
    /* References and drift checks are not charged. */
    if (!w) return;
    /* Bodies on the base save the part that concerns their parent. */
    uint64_t children = 0;
    const struct model *m = d->model;
    for (int i = m->first; i < m->end; i++) children += d->revolute[i].parent >= 0;
    const uint64_t n = (uint64_t)(m->end - m->first);
    w->flop += n * (uint64_t)cost.body + children * (uint64_t)cost.child;
    w->div += n * (uint64_t)cost.div;
    w->trig += 2 * n;
    w->call += n;
}
