/* work_count.c - operation counts of the serial algorithms. */
#include "dynamics/work_count.h"

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

void work_count_velocities(const struct dynamics *d, struct work *w)
{
    if (!w || d->at_rest) return;
    for (int i = 0; i < d->nbody; i++) {
        const struct joint_cost *c = joint_cost_of(d->body[i].joint);
        w->flop += (uint64_t)(c->rate + c->bias + (d->body[i].parent >= 0 ? XFORM_MOTION_FLOP + SCREW_ADD_FLOP : 0));
    }
}

/* rnea_revolute, per body: carry 15 + 15 + 18 + 15 + 6 (H, b), K 15, force 21 + 3, moment 33 + 12; tau and hand_down
 * 15 + 15 + 12 + 6; E Rz 18. */
enum { RNEA_REVOLUTE_OUT = 18 + 69 + 15 + 24 + 45, RNEA_REVOLUTE_IN = 48 };
/* At rest: E Rz 18, carry 15 + 12 + 15 + 1, force 15, moment 21 + 12. */
enum { RNEA_REVOLUTE_AT_REST = 18 + 43 + 15 + 33 };

void work_count_rnea(const struct dynamics *d, struct work *w)
{
    if (!w) return;
    int load = d->load ? SCREW_ADD_FLOP : 0;
    for (int i = 0; i < d->nbody; i++) {
        const struct body *b = &d->body[i];
        const struct joint_cost *c = joint_cost_of(b->joint);
        bool child = b->parent >= 0;
        w->call += 1;
        if (d->revolute) {
            const int out = d->at_rest ? RNEA_REVOLUTE_AT_REST : RNEA_REVOLUTE_OUT;
            w->flop += (uint64_t)(out + (child ? RNEA_REVOLUTE_IN : 0) + load);
            w->trig += 2;
            continue;
        }
        w->flop += (uint64_t)(c->place + c->h + c->h_transposed + XFORM_MOTION_FLOP + SCREW_ADD_FLOP +
                              BODY_FORCE_FLOP + load + (child ? XFORM_FORCE_FLOP + SCREW_ADD_FLOP : 0));
        if (!d->at_rest)
            w->flop += (uint64_t)(c->rate + c->bias + (child ? MAT3_VEC_FLOP + 3 : 0) + BODY_GYRO_FLOP);
        w->trig += (uint64_t)c->place_trig;
        w->div += (uint64_t)c->place_div;
    }
}

/* aba_revolute, per body: E Rz 18; start 15 + 3 + 18 + 15 + 18 + 3 + 15 + 9 + 12; rigid 21; eliminate 5 + 1 + 1 + 30 +
 * 55; hand_down: rotate 18 + 18 + 27 + 45 + 75, shift 36 + 48 + 9 + 15 + 6, force 48; accelerate 12 + 30 + 5 + 11. */
enum { ABA_REVOLUTE_OUT = 18 + 108 + 21 + 92 + 58, ABA_REVOLUTE_IN = 183 + 114 + 48 };
/* At rest: no start; eliminate without I^a b: 5 * 9 fewer; accelerate without b: 5 fewer. */
enum { ABA_REVOLUTE_AT_REST = 18 + 21 + 47 + 53 };

/* aba_general: eliminate in joint axes: factor d, solve, Schur complement on c, forces. */
static void count_eliminate(const struct body *b, const struct joint_cost *cost, struct work *w)
{
    uint64_t d = (uint64_t)b->d, c = 6 - d;
    bool dense = cost->h_transposed > 0;
    w->flop += d * (d + 1) * (2 * d + 1) / 6 + (2 * d * d - d) + d * (d - 1) * c; /* e, factor, solve, forward */
    w->flop += c * (c + 1) / 2 * 3 * d + 2 * c * d;                                       /* Schur, p */
    w->div += d;
    if (dense) w->flop += 396 + 21 * 11 + 66 + c * c * 21 * 3;                            /* joint axes and back */
    w->flop += 2 * c * d + (2 * d * d - d) + 2 * d;                                       /* accelerate */
    w->flop += (uint64_t)(2 * cost->h + cost->w + cost->h_transposed + cost->w_transposed);
}

void work_count_aba(const struct dynamics *d, struct work *w)
{
    if (!w) return;
    if (!d->revolute) {
        work_count_place(d, w);
        work_count_velocities(d, w);
    }
    for (int i = 0; i < d->nbody; i++) {
        const struct body *b = &d->body[i];
        bool child = b->parent >= 0;
        w->call += 1;
        if (d->load) w->flop += SCREW_ADD_FLOP;
        if (d->revolute) {
            const int out = d->at_rest ? ABA_REVOLUTE_AT_REST : ABA_REVOLUTE_OUT;
            w->flop += (uint64_t)(out + (child ? ABA_REVOLUTE_IN : 0));
            w->trig += 2;
            w->div += 1;
            continue;
        }
        w->flop += XFORM_MOTION_FLOP;
        if (!d->at_rest) w->flop += (uint64_t)(BODY_GYRO_FLOP + SYM6_MUL_FLOP + 6 + 6);
        if (child) w->flop += (uint64_t)(SYM6_MOVE_FLOP + 21 + XFORM_FORCE_FLOP + 6);
        count_eliminate(b, joint_cost_of(b->joint), w);
    }
}

/* crba_revolute: pose 18 + 63 + 9, force 15 + 15 + 12 besides the composite's move; 11 a pair. */
static void count_crba_revolute(const struct dynamics *d, struct work *w)
{
    for (int i = 0; i < d->nbody; i++) {
        bool child = d->body[i].parent >= 0;
        w->call += 1;
        w->trig += 2;
        w->flop += (uint64_t)(18 + 9 + (child ? XFORM_COMPOSE_FLOP + 42 + INERTIA_MOVE_FLOP + INERTIA_ADD_FLOP : 0));
        for (int j = d->body[i].parent; j >= 0; j = d->body[j].parent) w->flop += 11;
    }
}

void work_count_crba(const struct dynamics *d, struct work *w)
{
    if (!w) return;
    if (d->revolute) {
        count_crba_revolute(d, w);
        return;
    }
    work_count_place(d, w);
    for (int i = 0; i < d->nbody; i++) {
        const struct body *b = &d->body[i];
        w->call += 1;
        if (b->parent >= 0) w->flop += INERTIA_MOVE_FLOP + INERTIA_ADD_FLOP;
        uint64_t column = INERTIA_MUL_FLOP + (uint64_t)joint_cost_of(b->joint)->h_transposed;
        for (int j = i; d->body[j].parent >= 0; j = d->body[j].parent)
            column += XFORM_FORCE_FLOP + (uint64_t)joint_cost_of(d->body[d->body[j].parent].joint)->h_transposed;
        w->flop += column * (uint64_t)b->d;
    }
}
