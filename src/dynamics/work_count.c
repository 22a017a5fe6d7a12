/* work_count.c - operation counts of the serial algorithms. */
#include "dynamics/work_count.h"

/* Sums over joint types: the source executes nothing else. */
void work_count_place(const struct dynamics *d, struct work *w)
{
    if (!w) return;
    for (int i = 0; i < d->nbody; i++) {
        const struct joint_cost *c = joint_cost_of(d->body[i].joint);
        w->flop += (uint64_t)c->place;
        w->trig += (uint64_t)c->place_trig;
        w->div += (uint64_t)c->place_div;
    }
}

/* The base carries no velocity, so that its bodies add none. */
void work_count_velocities(const struct dynamics *d, struct work *w)
{
    if (!w || d->at_rest) return;
    for (int i = 0; i < d->nbody; i++) {
        const struct joint_cost *c = joint_cost_of(d->body[i].joint);
        w->flop += (uint64_t)(c->rate + c->bias +
                              (d->body[i].parent >= 0 ? XFORM_MOTION_FLOP + SCREW_ADD_FLOP : 0));
    }
}

/* One spring a joint at the most. */
void work_count_springs(const struct dynamics *d, struct work *w)
{
    if (!w) return;
    /* Stiffness and damper are counted together, also where one is zero. */
    for (int i = d->model->first; i < d->model->end; i++)
        w->flop += d->body[i].has_spring ? BODY_SPRING_FLOP : 0;
}

/* Only turned bodies compute anything. */
void work_count_load(const struct dynamics *d, struct work *w)
{
    if (!w || !d->load) return;
    for (int i = d->model->first; i < d->model->end; i++)
        w->flop += (uint64_t)body_load_flops(&d->body[i]);
}

/* rnea_full, term by term in its order. */
void work_count_rnea(const struct dynamics *d, struct work *w)
{
    if (!w) return;
    int load = d->load ? SCREW_ADD_FLOP : 0;
    work_count_place(d, w);
    for (int i = 0; i < d->nbody; i++) {
        const struct body *b = &d->body[i];
        const struct joint_cost *c = joint_cost_of(b->joint);
        /* Bodies on the base neither hand forces on nor are carried. */
        bool child = b->parent >= 0;
        w->call += 1;
        w->flop +=
            (uint64_t)(c->h + c->h_transposed + XFORM_MOTION_FLOP + SCREW_ADD_FLOP +
                       BODY_FORCE_FLOP + load + (child ? XFORM_FORCE_FLOP + SCREW_ADD_FLOP : 0));
        /* Angular velocities, bias and P. */
        if (!d->at_rest)
            w->flop += (uint64_t)(c->rate + c->bias + (child ? MAT3_VEC_FLOP + VEC3_ADD_FLOP : 0) +
                                  BODY_GYRO_FLOP + SCREW_ADD_FLOP);
    }
}

/* aba.c: eliminate in joint axes: factor d, solve, Schur complement on c, forces; accelerate. */
static void count_eliminate(const struct body *b, const struct joint_cost *cost, struct work *w)
{
    uint64_t d = (uint64_t)b->d, c = 6 - d;
    /* chol(d) of (2.9); d of its operations are divisions, which are counted below. */
    /* factor, solve, forward */
    w->flop += d * (d + 1) * (2 * d + 1) / 6 - d + (2 * d * d - d) + d * (d - 1) * c;
    /* e, Schur, p */
    w->flop += d + c * (c + 1) / 2 * 3 * d + 2 * c * d;
    w->div += d;
    /* Into joint axes and back, where columns are not unit vectors. */
    /* joint axes and back */
    if (!body_picks(b)) w->flop += 396 + 21 * 11 + 66 + c * c * 21 * 3;
    /* accelerate */
    w->flop += 2 * c * d + (2 * d * d - d) + 2 * d;
    w->flop += (uint64_t)(2 * cost->h + 2 * cost->w + cost->h_transposed + cost->w_transposed);
}

/* The three sweeps of aba.c. */
void work_count_aba(const struct dynamics *d, bool moving, struct work *w)
{
    if (!w) return;
    for (int i = 0; i < d->nbody; i++) {
        const struct body *b = &d->body[i];
        w->call += 1;
        w->flop += XFORM_MOTION_FLOP;
        if (d->load) w->flop += SCREW_ADD_FLOP;
        /* P, I_a b, and the bias on both ways. */
        if (moving && !d->at_rest)
            w->flop += (uint64_t)(BODY_GYRO_FLOP + SYM6_MUL_FLOP + SCREW_ADD_FLOP + SCREW_ADD_FLOP);
        if (b->parent >= 0)
            w->flop +=
                (uint64_t)(SYM6_MOVE_FLOP + SYM6_ADD_FLOP + XFORM_FORCE_FLOP + SCREW_ADD_FLOP);
        count_eliminate(b, joint_cost_of(b->joint), w);
    }
}

/* Composites, then each column's walk. */
void work_count_crba(const struct dynamics *d, struct work *w)
{
    if (!w) return;
    work_count_place(d, w);
    for (int i = 0; i < d->nbody; i++) {
        const struct body *b = &d->body[i];
        w->call += 1;
        if (b->parent >= 0) w->flop += INERTIA_MOVE_FLOP + INERTIA_ADD_FLOP;
        /* Each column walks to the root: depth matters, not the number of bodies. */
        uint64_t column = INERTIA_MUL_FLOP + (uint64_t)joint_cost_of(b->joint)->h_transposed;
        for (int j = i; d->body[j].parent >= 0; j = d->body[j].parent)
            column += XFORM_FORCE_FLOP +
                      (uint64_t)joint_cost_of(d->body[d->body[j].parent].joint)->h_transposed;
        w->flop += column * (uint64_t)b->d;
    }
}
