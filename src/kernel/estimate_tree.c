/* estimate_tree.c - costs of the programs for trees, from the plan that they follow (estimate.h). */
#include "kernel/compound.h"
#include "kernel/estimate.h"
#include "kernel/tree_plan.h"
#include "linalg/spatial.h"

/* What one operation costs with five constraints and one column of loads [flop]: counted. */
enum { RAKE_FLOP = 1100, ABSORB_FLOP = 2700, MERGE_FLOP = 3300, UNDO_FLOP = 320, BODY_FLOP = 250 };

static void add(struct kernel_estimate *e, double messages, double numbers)
{
    e->messages += messages;
    e->bytes += messages * numbers * (double)sizeof(real);
}

/* jumps: messages of one scan over the pieces: from anchors to pieces, then between ancestors; `composing` of them
 * carry a transform too. */
struct jumps {
    double entries, jumps, composing;
};

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

/* scan: one recurrence along the tree. */
static void scan(const struct jumps *j, double n, bool first, struct kernel_estimate *e)
{
    add(e, j->entries, first ? XFORM_NUMBERS + SPACE : SPACE);
    add(e, j->jumps, SPACE);
    if (first) e->bytes += XFORM_NUMBERS * j->composing * (double)sizeof(real);
    e->flops += (2 * n + j->jumps) * (XFORM_FORCE_FLOP + SCREW_ADD_FLOP) +
                (first ? (n + j->composing) * XFORM_COMPOSE_FLOP : 0);
}

/* contraction: one solution for m columns. */
static void contraction(const struct tree_plan *p, const struct model *model, double m, bool terms,
                        struct kernel_estimate *e)
{
    for (int i = 0; i < p->nop; i++) {
        const struct tree_op *op = &p->op[i];
        const int v = p->absorbed[op->first];
        const double d = model->u_at[v + 1] - model->u_at[v], nq = model->q_at[v + 1] - model->q_at[v];
        const bool away = op->from != op->to;
        if (op->kind == TREE_RAKE) {
            if (away) add(e, 1, PACKED + SPACE * m);
            if (away) add(e, 1, SPACE * m);
            e->flops += op->count * RAKE_FLOP + ABSORB_FLOP + (1 + op->count) * UNDO_FLOP * m;
        } else {
            if (away) add(e, 1, compound_size((int)m) + nq + d + (terms ? SPACE : 0));
            if (away) add(e, 1, 2 * SPACE * m);
            e->flops += MERGE_FLOP + UNDO_FLOP * m;
        }
    }
}

void estimate_tree(const struct run_spec *spec, const struct model *model, const struct job_omit *omit, bool inverse,
                   bool forward, struct kernel_estimate *out)
{
    struct arena *a = arena_create();
    const struct tree_plan *p = tree_plan_make(model, spec->nrank, a);
    const struct jumps j = jumps_of(p);
    const double n = model->nbody, m = 1 + model->nrow;
    const bool direct = spec->kernel.formulation == FORMULATION_DIRECT;
    const double passes = (1.0 + spec->kernel.inner_refinements) * (1.0 + spec->kernel.outer_refinements);
    /* up: velocities (loops need the places that their scan finds), accelerations; down: forces */
    const bool forces = inverse || (!direct && !omit->bias);
    const int scans = (!omit->velocity || model->nloop > 0) + 2 * forces;
    for (int k = 0; k < scans; k++) scan(&j, n, k == 0, out);
    out->flops += n * BODY_FLOP;
    if (forward) {
        struct kernel_estimate one = {0};
        contraction(p, model, m, direct && !omit->velocity, &one);
        add(&one, j.entries, SPACE * m);
        out->messages += passes * one.messages;
        out->bytes += passes * one.bytes;
        out->flops += passes * (one.flops + n * m * 2 * BODY_FLOP);
    }
    double most = 0;
    for (int k = 0; k < spec->nrank; k++)
        if (p->bodies.at[k + 1] - p->bodies.at[k] > most) most = p->bodies.at[k + 1] - p->bodies.at[k];
    out->rank_bytes = most * (54 + 60 + (forward ? 78 + 90 + 60 * m : 0)) * (double)sizeof(real) + 1024;
    arena_destroy(a);
}
