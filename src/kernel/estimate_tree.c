/* estimate_tree.c - costs of the programs for trees, from the plan that they follow (estimate.h).
 *
 * The number of operations depends on the tree's shape and has no formula: the plan itself is
 * walked, and each operation of it adds what its function executes (tree.c, contraction.c,
 * contraction_solve.c, compound.c). Only the eigenvalues of loops' least norm solution are left
 * out, whose rotations depend on the numbers. */
#include "dynamics/algebra.h"
#include "kernel/compound.h"
#include "kernel/estimate.h"
#include "kernel/implicit.h"
#include "kernel/tree_plan.h"
#include "linalg/dense.h"

/* A motion or force moved through a joint and added. */
enum {
    ADD_MOTION = XFORM_MOTION_FLOP + SCREW_ADD_FLOP,
    ADD_FORCE = XFORM_FORCE_FLOP + SCREW_ADD_FLOP
};

/* tree_walk: what an estimate looks at. */
struct tree_walk {
    const struct model *model;
    const struct body *body; /* (nbody) */
    const struct loop *loop; /* (nloop) */
    const struct tree_plan *plan;
    const struct job_omit *omit;
    bool wrenches;           /* external forces act */
    real step;               /* implicit_step */
    double entries, jumps, composing; /* of one scan, see count_jumps */
    /* bodies whose parent is in their piece; bodies on the base */
    double inner_bodies, on_base;
    double placing;                   /* bodies of pieces that compose transforms */
};

/* given: what one solution has in its columns (struct contraction_given). */
struct given {
    double m;
    bool active, bias, load, base;
};

static void add(struct program_estimate *e, double messages, double numbers)
{
    e->messages += messages;
    e->bytes += messages * numbers * (double)sizeof(real);
}

/* count_jumps: messages of one scan over the pieces: from anchors to pieces, then between
 * ancestors; `composing` of them carry a transform, too: with loops all, since places in the base
 * are wanted. */
static void count_jumps(struct tree_walk *t)
{
    const struct tree_plan *p = t->plan;
    for (int k = 0; k < p->npiece; k++) {
        t->entries += p->parent[k] >= 0;
        for (int level = 0; level < p->nlevel; level++) {
            const int a = tree_plan_ancestor(p, level, k);
            if (a < 0 || p->parent[a] < 0) continue;
            t->jumps += 1;
            t->composing += t->model->nloop > 0 || tree_plan_ancestor(p, level, a) >= 0;
        }
    }
}

/* count_bodies: a body on another piece's body takes part in one of the two sweeps of a piece. */
static void count_bodies(struct tree_walk *t)
{
    const struct tree_plan *p = t->plan;
    for (int i = 0; i < t->model->nbody; i++) {
        const int parent = t->model->body[i].parent, piece = p->owner[i];
        const bool inner = parent >= 0 && p->owner[parent] == piece;
        /* the first sweep and the paths serve pieces that hang here, and loops */
        const bool serves = p->kids.at[piece + 1] > p->kids.at[piece];
        t->on_base += parent < 0;
        t->inner_bodies += inner && serves;
        t->placing += inner && (serves || t->model->nloop > 0);
    }
}

/* scan_up: one recurrence up the tree (physics 6.4): a sweep inside the pieces that others hang at,
 * the jumps, a sweep with what enters. */
static void scan_up(const struct tree_walk *t, bool first, struct program_estimate *e)
{
    add(e, t->entries, first ? XFORM_NUMBERS + SPACE : SPACE);
    add(e, t->jumps, SPACE);
    if (first) e->bytes += XFORM_NUMBERS * t->composing * (double)sizeof(real);
    e->flops += (t->inner_bodies + t->jumps + t->model->nbody - t->on_base) * ADD_MOTION +
                (first ? (t->placing + t->composing) * XFORM_COMPOSE_FLOP : 0);
}

/* scan_down: forces: all bodies of pieces that hang somewhere, the jumps, what reaches the anchors,
 * and all bodies but those on the base. */
static void scan_down(const struct tree_walk *t, struct program_estimate *e)
{
    double hanging = 0;
    for (int i = 0; i < t->model->nbody; i++) hanging += t->plan->parent[t->plan->owner[i]] >= 0;
    add(e, t->entries, SPACE);
    add(e, t->jumps, SPACE);
    e->flops += (hanging + t->jumps + t->model->nbody - t->on_base) * ADD_FORCE +
                t->entries * SCREW_ADD_FLOP;
}

/* gyro: P - Fext of all bodies. */
static double gyro(const struct tree_walk *t)
{
    double flops = 0;
    for (int i = 0; i < t->model->nbody; i++)
        flops += (t->omit->velocity ? 0 : BODY_GYRO_FLOP) +
                 (t->wrenches ? body_load_flops(&t->body[i]) + SCREW_ADD_FLOP : 0);
    return flops;
}

/* place: transforms, velocities and bias accelerations. */
static void place(const struct tree_walk *t, struct program_estimate *e)
{
    const bool still = t->omit->velocity, moves = !still || t->model->nloop > 0;
    for (int i = 0; i < t->model->nbody; i++) {
        const struct joint_cost *c = body_cost(&t->body[i]);
        e->flops += c->place + (moves ? c->rate : 0) + (still ? 0 : c->bias);
    }
    if (moves) scan_up(t, true, e);
}

/* newton_euler: accelerations from rates u' (or zero), then forces; `more`: forces of loops come on
 * top. `first`: no scan has composed the transforms yet. */
static void newton_euler(const struct tree_walk *t, bool rates, bool more, bool first,
                         struct program_estimate *e)
{
    const bool terms = !t->omit->velocity || t->wrenches;
    for (int i = 0; i < t->model->nbody; i++) {
        const struct joint_cost *c = body_cost(&t->body[i]);
        e->flops += (rates ? c->h : 0) + c->h_transposed + BODY_FORCE_FLOP +
                    (terms + more) * SCREW_ADD_FLOP;
    }
    if (!t->omit->base)
        e->flops += t->on_base * (SCREW_ADD_FLOP +
                                  (t->omit->turn ? XFORM_SLIDE_FLOP : XFORM_MOTION_FLOP));
    if (terms) e->flops += gyro(t);
    scan_up(t, first, e);
    scan_down(t, e);
}

/* compliance: joint_compliance; divisions are not among the flops. */
static double compliance(const struct tree_walk *t, const struct body *b)
{
    const bool soft = spring_resistance(b, t->step) > 0;
    const int c = soft ? SPACE : SPACE - b->d;
    /* factor, solve for the inverse, take the symmetric part */
    double flops = dense_factor_flops(c) - c + 2.0 * c * c * (c - 1) + c * c + 2 * PACKED;
    if (soft) return flops + 2.0 * b->d * PACKED;
    if (body_picks(b)) return flops;
    /* columns that are no unit vectors: projected, and spread again */
    return flops + dense_product_flops(c, SPACE, c) + dense_product_flops(SPACE, SPACE, c) +
           SQUARE_VEC_FLOP * c + SCREW_DOT_FLOP * c * c;
}

/* joint_force for m columns; given forces and bias count once, in column 0. */
static double force(double m, bool active, bool bias, bool entry)
{
    return m * (SQUARE_VEC_FLOP + (1 + entry) * SCREW_ADD_FLOP) + bias * SCREW_ADD_FLOP +
           active * (SQUARE_VEC_FLOP + SCREW_ADD_FLOP);
}

/* What the functions of compound.h do (physics 6.2, 6.3, 6.4), and what undoing them does. */
static double rake(const struct tree_walk *t, const struct body *b, const struct given *g)
{
    enum { LEAF_UNDO = XFORM_MOTION_FLOP + SQUARE_VEC_FLOP + SCREW_ADD_FLOP };
    return compliance(t, b) + force(g->m, g->active, g->bias, false) +
           2 * SPACE * XFORM_FORCE_FLOP + 3 * PACKED + g->m * (ADD_FORCE + LEAF_UNDO);
}
static double absorb(const struct given *g)
{
    enum {
        SOLVE = 2 * SPACE * SPACE * SPACE / 3 + 4 * SPACE * SPACE * SPACE - SPACE,
        COLUMN = 3 * SQUARE_VEC_FLOP + 2 * SQUARE + 3 * SCREW_ADD_FLOP,
        UNDO = 3 * SQUARE_VEC_FLOP + 4 * SCREW_ADD_FLOP
    };
    return 3 * SQUARE_MUL_FLOP + SOLVE + 5 * PACKED + SPACE + g->m * (COLUMN + UNDO);
}
static double merge(const struct tree_walk *t, const struct body *b, bool away,
                    const struct given *g)
{
    /* a fixed joint's message has no forces, where its own rank adds zero */
    const bool active = g->active && !(away && b->d == 0);
    enum {
        COLUMN = XFORM_MOTION_FLOP + 2 * (SQUARE_VEC_FLOP + SCREW_ADD_FLOP),
        UNDO = 2 * SQUARE_VEC_FLOP + 2 * SCREW_ADD_FLOP + XFORM_FORCE_FLOP
    };
    return compliance(t, b) + force(g->m, active, g->bias, true) + 3 * SPACE * XFORM_MOTION_FLOP +
           3 * PACKED + 3 * SQUARE_MUL_FLOP + 2 * PACKED * SCREW_AXPY_FLOP + g->m * (COLUMN + UNDO);
}

/* contract: contraction_solve. An operation whose parts lie on one rank sends nothing. */
static void contract(const struct tree_walk *t, const struct given *g, struct program_estimate *e)
{
    const struct tree_plan *p = t->plan;
    if (g->load) e->flops += t->model->nbody * g->m * BODY_ACCELERATE_FLOP;
    for (int i = 0; i < p->nop; i++) {
        const struct tree_op *op = &p->op[i];
        const struct body *b = &t->body[p->absorbed[op->first]];
        const bool away = op->from != op->to;
        /* Up the loads of the leaves, down the acceleration of their parent's bottom. */
        if (op->kind == TREE_RAKE) {
            if (away) add(e, 1, PACKED + SPACE * g->m);
            if (away) add(e, 1, SPACE * g->m);
            for (int k = 0; k < op->count; k++)
                e->flops += rake(t, &t->body[p->absorbed[op->first + k]], g);
            e->flops += absorb(g);
        } else {
            /* Up a compound and its joint, which is placed again, down the pair (f_v, f_2). */
            if (away)
                add(e, 1, compound_size((int)g->m) + b->nq + (g->active ? b->d : 0) +
                              (g->bias ? SPACE : 0));
            if (away) add(e, 1, 2 * SPACE * g->m);
            e->flops += merge(t, b, away, g) + (away ? body_cost(b)->place : 0);
        }
    }
    for (int i = 0; i < p->nroot; i++)
        e->flops += compliance(t, &t->body[p->root[i]]) + force(g->m, g->active, true, false) +
                    (g->base ? ADD_MOTION : 0);
}

/* solution: contract, accelerations of all bodies in every column, the joints' share of them. What
 * the joints see is given by `seen`: a refinement inside a solution sees all that the solution saw.
 * `again`: its accelerations are added. */
static void solution(const struct tree_walk *t, const struct given *g, const struct given *seen,
                     bool again, struct program_estimate *e)
{
    const double n = t->model->nbody, m = g->m;
    contract(t, g, e);
    /* accelerations of anchors to the pieces there */
    add(e, t->entries, SPACE * m);
    e->flops += n * m * (BODY_ACCELERATE_FLOP + (1 + g->load + again) * SCREW_ADD_FLOP);
    e->flops += ((n - t->on_base) * m + (seen->base ? t->on_base : 0)) * ADD_MOTION;
    if (seen->bias) e->flops += n * SCREW_ADD_FLOP;
    for (int i = 0; i < t->model->nbody; i++) e->flops += m * body_cost(&t->body[i])->h_transposed;
}

/* meet: the loops' sides once: places, unit forces (physics 7.2). */
static void meet(const struct tree_walk *t, struct program_estimate *e)
{
    const struct model *m = t->model;
    for (int l = 0; l < m->nloop; l++) {
        const struct loop *loop = &t->loop[l];
        const int a = loop->body_a < 0 ? -1 : t->plan->owner[loop->body_a],
                  b = loop->body_b < 0 ? -1 : t->plan->owner[loop->body_b];
        /* both owners place the loop, each from the poses and velocities of both sides */
        const bool apart = a >= 0 && b >= 0 && a != b;
        if (apart) add(e, 2, XFORM_NUMBERS + SPACE);
        e->flops += (1 + apart) * loop_place_flops(loop) +
                    ((a >= 0) + (b >= 0)) * (XFORM_COMPOSE_FLOP + loop->c * ADD_FORCE);
    }
}

/* close_loops: residuals and S to rank 0, the loops' forces to all; the solution itself depends on
 * the numbers. */
static void close_loops(const struct tree_walk *t, struct program_estimate *e)
{
    const double rows = loop_rows(t->model), m = 1 + rows;
    for (int side = 0; side < 2 * t->model->nloop; side++) {
        const struct loop *l = &t->loop[side / 2];
        const int body = side % 2 ? l->body_b : l->body_a;
        if (body < 0) continue;
        if (t->plan->owner[body] != 0) add(e, 1, l->c * (m + 1));
        e->flops += SCREW_ADD_FLOP + m * (XFORM_MOTION_FLOP + SCREW_DOT_FLOP * l->c) +
                    l->c * (XFORM_FORCE_FLOP + BODY_ACCELERATE_FLOP + SCREW_DOT_FLOP) +
                    l->c * (m + 1);
    }
    if (rows > 0) add(e, t->plan->nrank - 1, rows);
    e->flops += rows * (rows - 1) + (2 * rows + 1) * t->model->nu + rows * t->plan->nrank;
}

/* agree: numbers that all ranks must know, by dissemination (extremes.h). */
static void agree(const struct tree_walk *t, double numbers, struct program_estimate *e)
{
    for (int d = 1; d < t->plan->nrank; d *= 2) add(e, t->plan->nrank, numbers);
}

/* forward: physics 6 and 7: the given forces less the paper's bias forces, the first solution for
 * all columns, refinements with one column each. */
static void forward(const struct tree_walk *t, const struct kernel_spec *k,
                    struct program_estimate *e)
{
    const bool direct = k->formulation == FORMULATION_DIRECT, loops = t->model->nloop > 0;
    const bool soft = kernel_spec_implicit(k), bias = direct && !t->omit->velocity;
    const bool terms = direct && !t->omit->load, composed = !t->omit->velocity || loops;
    place(t, e);
    for (int i = 0; i < t->model->nbody; i++)
        if (t->body[i].has_spring) e->flops += BODY_SPRING_FLOP + (soft ? 3 : 0);
    if (!direct && !t->omit->bias) {
        newton_euler(t, false, false, !composed, e);
        e->flops += t->model->nu;
    }
    const struct given given = {1.0 + loop_rows(t->model), true, bias, terms || loops,
                                direct && !t->omit->base};
    const struct given inside = {1, false, true, false, false},
                       outside = {1, true, false, false, false};
    meet(t, e);
    if (terms) e->flops += gyro(t);
    solution(t, &given, &given, false, e);
    for (int pass = 0; pass < k->inner_refinements; pass++) solution(t, &inside, &given, true, e);
    close_loops(t, e);
    /* Exact if no refinement stops early; then it is an upper bound. */
    if (k->outer_refinements > 0) agree(t, 1, e);
    for (int pass = 0; pass < k->outer_refinements; pass++) {
        newton_euler(t, true, true, !composed && pass == 0 && (direct || t->omit->bias), e);
        e->flops += (soft ? 3 : 1) * t->model->nu;
        solution(t, &outside, &outside, false, e);
        for (int k_in = 0; k_in < k->inner_refinements; k_in++)
            solution(t, &inside, &outside, true, e);
        close_loops(t, e);
        agree(t, 2, e);
    }
}

/* memory: of the largest piece. */
static double memory(const struct tree_walk *t, bool solves)
{
    const double m = 1 + loop_rows(t->model);
    double most = 0;
    for (int k = 0; k < t->plan->nrank; k++) {
        const double n = t->plan->bodies.at[k + 1] - t->plan->bodies.at[k];
        most = n > most ? n : most;
    }
    return most * (19 * SPACE + (solves ? COMPOUND_MATRICES + (15 + 10 * m) * SPACE : 0)) *
               (double)sizeof(real) +
           1024;
}

void estimate_tree(const struct run_spec *spec, const struct model *model,
                   const struct job_omit *omit, bool inverse, bool solves,
                   struct program_estimate *out)
{
    struct arena *a = arena_create();
    struct tree_walk t = {.model = model, .omit = omit, .body = bodies_make(model, a)};
    t.plan = tree_plan_make(model, spec->nrank, a);
    struct loop *loop = TAKE(a, model->nloop + 1, struct loop);
    loops_make(model, loop, TAKE(a, model->nrow + 1, int));
    t.loop = loop;
    /* a state at rest that carries loads carries wrenches */
    t.wrenches = spec->model.external_force > 0 || (omit->velocity && !omit->load);
    if (kernel_spec_implicit(&spec->kernel))
        t.step = (real)(spec->kernel.step_size / model->second);
    count_jumps(&t);
    count_bodies(&t);
    if (inverse) {
        place(&t, out);
        newton_euler(&t, true, false, omit->velocity && model->nloop == 0, out);
    }
    if (solves) forward(&t, &spec->kernel, out);
    out->rank_bytes = memory(&t, solves);
    arena_destroy(a);
}
