/* estimate_tree.c - costs of the programs for trees, from the plan that they follow (estimate.h).
 */
#include "kernel/algebra.h"
#include "kernel/compound.h"
#include "kernel/estimate.h"
#include "kernel/tree_plan.h"

/* What the functions of compound.h do: joint_compliance of c constraints, joint_force for m
 * columns, one more given force in the first; rake of a leaf, absorb, merge (physics 6.2, 6.3,
 * 6.4); what undoing the two does at the parent, and at a leaf. */
static double compliance(double c) { return c * (c + 1) * (2 * c + 1) / 6 + c * c * (2 * c - 1); }
static double force(double m)
{
    return SQUARE_VEC_FLOP + SCREW_ADD_FLOP + m * (SQUARE_VEC_FLOP + 3 * SCREW_ADD_FLOP);
}
static double rake(double c, double m)
{
    return compliance(c) + force(m) + 2 * SPACE * XFORM_FORCE_FLOP + PACKED +
           m * (XFORM_FORCE_FLOP + SCREW_ADD_FLOP);
}
static double absorb(double m)
{
    const double column = 3 * SQUARE_VEC_FLOP + 2 * SQUARE + 3 * SCREW_ADD_FLOP;
    return 3 * SQUARE_MUL_FLOP + (4 + 2.0 / 3) * SPACE * SQUARE + m * column + SPACE + PACKED;
}
static double merge(double c, double m)
{
    const double column = XFORM_MOTION_FLOP + 2 * (SQUARE_VEC_FLOP + SCREW_ADD_FLOP);
    return compliance(c) + force(m) + 3 * SPACE * XFORM_MOTION_FLOP + PACKED + 3 * SQUARE_MUL_FLOP +
           2 * PACKED * SCREW_AXPY_FLOP + m * column;
}
enum {
    UNRAKE_FLOP = 3 * SQUARE_VEC_FLOP + 4 * SCREW_ADD_FLOP,
    LEAF_FLOP = XFORM_MOTION_FLOP + SQUARE_VEC_FLOP + SCREW_ADD_FLOP,
    UNMERGE_FLOP = 2 * SQUARE_VEC_FLOP + 2 * SCREW_ADD_FLOP + XFORM_FORCE_FLOP
};

static void add(struct program_estimate *e, double messages, double numbers)
{
    e->messages += messages;
    e->bytes += messages * numbers * (double)sizeof(real);
}

/* jumps: messages of one scan over the pieces: from anchors to pieces, then between ancestors;
 * `composing` of them carry a transform too. */
struct jumps {
    double entries, jumps, composing;
};

/* The plan itself is walked: the number of messages depends on the tree's shape and has no
 * formula. */
static struct jumps jumps_of(const struct tree_plan *p)
{
    struct jumps j = {0};
    for (int k = 0; k < p->npiece; k++) {
        j.entries += p->parent[k] >= 0;
        for (int level = 0; level < p->nlevel; level++) {
            const int a = tree_plan_ancestor(p, level, k);
            if (a < 0 || p->parent[a] < 0) continue;
            j.jumps += 1;
            j.composing += tree_plan_ancestor(p, level, a) >= 0;
        }
    }
    return j;
}

/* scan: one recurrence along the tree (physics 6.4): two sweeps over the bodies and the jumps.
 * Inverse and forward scans cost the same. */
static void scan(const struct jumps *j, double n, bool first, struct program_estimate *e)
{
    add(e, j->entries, first ? XFORM_NUMBERS + SPACE : SPACE);
    add(e, j->jumps, SPACE);
    if (first) e->bytes += XFORM_NUMBERS * j->composing * (double)sizeof(real);
    e->flops += (2 * n + j->jumps) * (XFORM_FORCE_FLOP + SCREW_ADD_FLOP) +
                (first ? (n + j->composing) * XFORM_COMPOSE_FLOP : 0);
}

/* contraction: one solution for m columns. */
static void contraction(const struct tree_plan *p, const struct model *model, double m, bool terms,
                        struct program_estimate *e)
{
    /* Every operation of the plan; one whose parts lie on one rank sends nothing. */
    for (int i = 0; i < p->nop; i++) {
        const struct tree_op *op = &p->op[i];
        const int v = p->absorbed[op->first];
        const double d = model->u_at[v + 1] - model->u_at[v],
                     nq = model->q_at[v + 1] - model->q_at[v];
        const bool away = op->from != op->to;
        /* Up the loads of the leaves, down the acceleration of their parent's bottom. */
        if (op->kind == TREE_RAKE) {
            if (away) add(e, 1, PACKED + SPACE * m);
            if (away) add(e, 1, SPACE * m);
            e->flops +=
                op->count * (rake(SPACE - d, m) + m * LEAF_FLOP) + absorb(m) + m * UNRAKE_FLOP;
        } else {
            /* Up a compound and its joint, down the pair (f_v, f_2). */
            if (away) add(e, 1, compound_size((int)m) + nq + d + (terms ? SPACE : 0));
            if (away) add(e, 1, 2 * SPACE * m);
            e->flops += merge(SPACE - d, m) + m * UNMERGE_FLOP;
        }
    }
}

/* bodies: what is done for each body alone: inverse dynamics' part, once; a solution's part, per
 * pass. */
static double bodies(const struct model *m, const struct job_omit *omit, bool forces)
{
    double flops = 0;
    for (int i = 0; i < m->nbody; i++) {
        const struct joint_cost *c = joint_cost_of(m->body[i].joint);
        flops += c->place + (omit->velocity ? 0 : c->rate + c->bias + BODY_GYRO_FLOP) +
                 (forces ? BODY_FORCE_FLOP + SCREW_ADD_FLOP : 0);
    }
    return flops;
}
/* Accelerations of all bodies in every column, and the joints' share of them. */
static double solutions(const struct model *model, bool terms, double m)
{
    const double loads = terms || m > 1 ? BODY_ACCELERATE_FLOP + SCREW_ADD_FLOP : 0;
    const double column = BODY_ACCELERATE_FLOP + loads + 2 * SCREW_ADD_FLOP + XFORM_MOTION_FLOP;
    return model->nbody * (m * column + (terms ? SCREW_ADD_FLOP : 0));
}

void estimate_tree(const struct run_spec *spec, const struct model *model,
                   const struct job_omit *omit, bool inverse, bool forward,
                   struct program_estimate *out)
{
    struct arena *a = arena_create();
    const struct tree_plan *p = tree_plan_make(model, spec->nrank, a);
    const struct jumps j = jumps_of(p);
    const double n = model->nbody, m = 1 + loop_rows(model);
    const bool direct = spec->kernel.formulation == FORMULATION_DIRECT;
    /* Each refinement is one more contraction; inner ones are made within every outer one. */
    /* Exact if no refinement stops early; then it is an upper bound. */
    const double passes =
        (1.0 + spec->kernel.inner_refinements) * (1.0 + spec->kernel.outer_refinements);
    /* up: velocities (loops need the places that their scan finds), accelerations; down: forces */
    const bool forces = inverse || (!direct && !omit->bias);
    const int scans = (!omit->velocity || model->nloop > 0) + 2 * forces;
    for (int k = 0; k < scans; k++) scan(&j, n, k == 0, out);
    out->flops += bodies(model, omit, forces);
    if (forward) {
        struct program_estimate one = {0};
        contraction(p, model, m, direct && !omit->velocity, &one);
        add(&one, j.entries, SPACE * m);
        out->messages += passes * one.messages;
        out->bytes += passes * one.bytes;
        out->flops += passes * (one.flops + solutions(model, direct && !omit->velocity, m));
    }
    /* Memory follows the largest piece. */
    double most = 0;
    for (int k = 0; k < spec->nrank; k++)
        if (p->bodies.at[k + 1] - p->bodies.at[k] > most)
            most = p->bodies.at[k + 1] - p->bodies.at[k];
    out->rank_bytes = most *
                          (19 * SPACE + (forward ? COMPOUND_MATRICES + (15 + 10 * m) * SPACE : 0)) *
                          (double)sizeof(real) +
                      1024;
    arena_destroy(a);
}
