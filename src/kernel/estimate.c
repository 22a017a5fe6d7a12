/* estimate.c - costs of the dynamics kernels by formula (estimate.h). */
#include "kernel/estimate.h"

#include "kernel/blocks.h"
#include "kernel/chain.h"
#include "model/model.h"

/* What the formulas need of a spec: P ranks, n bodies, orders of a typical joint (that of the last
 * body, since the first may be the floating base). */
struct outline {
    double P, n, steps; /* steps: ceil(log2 P) */
    double pairs;   /* sum over the steps of the ranks that have a partner: messages of one scan */
    double triples; /* of the ranks with partners on both sides, the receiving one's sender having
                       another */
    double c, d, nq;
    double place, rate, bias; /* flops of that joint's own */
    double x, y, T; /* flops of a transform and of a composition; numbers of a transform */
    bool split;               /* more than one body on some rank */
    double shifts,
        many; /* ranks with several bodies that have a left neighbour; ranks with several bodies */
};

static struct outline outline_of(const struct run_spec *spec, const struct model *model)
{
    const int P = spec->nrank, n = model->nbody, last = n - 1;
    struct outline o = {.P = P, .n = n};
    /* Step d of a scan: ranks d .. P-1 receive, those from 2 d on with a transform (physics 3.1).
     * For P = 2^lg the sums are P lg - P + 1 and P lg - 2 (P - 1). */
    for (int d = 1; d < P; d *= 2) {
        o.steps += 1;
        o.pairs += P - d;
        o.triples += P > 2 * d ? P - 2 * d : 0;
    }
    o.d = model->u_at[last + 1] - model->u_at[last];
    o.nq = model->q_at[last + 1] - model->q_at[last];
    const struct body_def *b = &model->body[last];
    const bool soft = kernel_spec_implicit(&spec->kernel);
    /* An implicit spring makes all components unknown (physics 9.0). */
    o.c = soft && (b->stiffness > 0 || b->damping > 0) ? SPACE : SPACE - o.d;
    const struct joint_cost *cost = joint_cost_of(model->body[last].joint);
    o.place = cost->place;
    o.rate = cost->rate;
    o.bias = cost->bias;
    const bool dense = spec->kernel.operators == OPERATORS_DENSE;
    o.x = dense ? SQUARE_VEC_FLOP : XFORM_FORCE_FLOP;
    o.y = dense ? SQUARE_MUL_FLOP : XFORM_COMPOSE_FLOP;
    o.T = dense ? SQUARE : XFORM_NUMBERS;
    o.split = n > P;
    /* Blocks of nearly equal size: with n < 2 P the first n - P ranks have two bodies. */
    o.many = !o.split ? 0 : n >= 2 * P ? P : n - P;
    o.shifts = o.many > 0 ? o.many - 1 : 0;
    return o;
}

/* add: messages of `numbers` reals each. */
static void add(struct program_estimate *e, double messages, double numbers)
{
    e->messages += messages;
    e->bytes += messages * numbers * (double)sizeof(real);
}

/* first_scan, of velocities or, at rest, accelerations; vector_scan: physics 3.1 to 3.3. Bodies
 * inside the blocks are swept twice. */
static void first_scan(const struct outline *o, bool incoming, struct program_estimate *e)
{
    const double inside = o->n - o->P;
    add(e, o->pairs, SPACE);
    if (incoming) {
        e->bytes += o->triples * o->T * (double)sizeof(real);
    } else {
        /* Outgoing: transforms are messages of their own, and one more round fetches the first ones
         * (3.2). */
        add(e, o->triples + o->P - 1, o->T);
    }
    add(e, o->shifts, SPACE);
    e->flops += o->pairs * (o->x + SPACE) + o->triples * o->y;
    e->flops += inside * (2 * (o->x + SPACE) + o->y);
}

static void vector_scan(const struct outline *o, bool force, struct program_estimate *e)
{
    const double inside = o->n - o->P;
    add(e, o->pairs, SPACE);
    /* Forces are shifted before the scan, by every rank but the first; motions after it, to ranks
     * with several bodies (3.3). */
    add(e, force ? (o->split ? o->P - 1 : 0) : o->shifts, SPACE);
    e->flops += o->pairs * (o->x + SPACE) + 2 * inside * (o->x + SPACE) +
                (force && o->split ? (o->P - 1) * o->x : 0);
}

/* local_work: of single bodies; `forces`: inertial forces are wanted, not only velocities. */
static void local_work(const struct run_spec *spec, const struct outline *o,
                       const struct job_omit *omit, bool forces, struct program_estimate *e)
/* Flops of physics 2.5: place, velocity terms, inertial force, base. */
{
    const bool dense = spec->kernel.operators == OPERATORS_DENSE;
    const double place = o->place + (dense ? SQUARE_MUL_FLOP : 0);
    const double bias = omit->velocity ? 0 : o->rate + o->bias + BODY_GYRO_FLOP;
    const double force = !forces ? 0
                         : dense ? 2 * SQUARE_MUL_FLOP + SQUARE_VEC_FLOP + SPACE
                                 : BODY_FORCE_FLOP + SCREW_ADD_FLOP;
    const double base = forces && !omit->base ? o->x + SPACE : 0;
    e->flops += o->n * (place + bias + force + o->d) + base;
}

/* reduction of one interface row per rank: physics (5.2), 5.3. */
static void interface(const struct run_spec *spec, const struct outline *o, double m,
                      struct program_estimate *e)
{
    /* chol(c), trs(c, m), mm of (2.9); `one` and `two` are w1 and w2 of (5.2), update the numbers
     * of B1. */
    const double c = o->c, packed = c * (c + 1) / 2;
    const double factor = c * (c + 1) * (2 * c + 1) / 6, triangular = c * c,
                 product = c * (2 * c - 1);
    const double one =
        factor + m * triangular + c * triangular + packed * (2 * c - 1) + m * product;
    const double two = one + c * triangular + packed * (2 * c - 1) + m * product + c * product;
    const double update = packed + c * m;
    const enum solver s = spec->kernel.solver;
    const bool cyclic = s == SOLVER_CR || s == SOLVER_CR_PCR ||
                        (s == SOLVER_PARTITION && spec->kernel.part_solver == PART_CR);
    /* Thomas: rows to rank 0, solutions with the row in front back; the elimination is serial
     * (5.1). */
    if (s == SOLVER_THOMAS) {
        add(e, o->P - 1, o->n / o->P * (packed + c * c + c * m) + 0);
        add(e, o->P - 1, (o->n / o->P + 1) * c * m);
        e->flops +=
            o->n * (factor + triangular * c + packed * 2 * c + m * (2 * triangular + 4 * c * c));
    } else if (s == SOLVER_PCR) {
        /* Textbook (5.3 i): whole rows both ways in every step; an inverse and three products a
         * neighbour. */
        add(e, 2 * o->pairs, 3 * c * c + c * m);
        e->flops += 2 * o->pairs * (2 * c * c * c + 3 * c * product + c * c + m * (product + c));
        e->flops += o->P * (2 * c * c * c + m * product);
    } else if (cyclic) {
        /* Cyclic reduction (5.2): every row but the last is eliminated once. Couplings that edge
         * rows lack make the bytes a bound, not an equality. */
        const double messages = 2 * (o->P - 1) - o->steps;
        add(e, messages, update + c * c);
        add(e, messages, c * m);
        e->flops += o->P * (two + m * (triangular + 2 * product + 2 * c)) + messages * update;
    } else {
        /* Symmetric (5.3 ii): rows at the ends have one neighbour, E goes only where both exist. */
        add(e, 2 * o->pairs, update);
        e->bytes += 2 * o->triples * c * c * (double)sizeof(real);
        const double edges = 2 * (o->pairs - o->triples), both = o->P * o->steps - edges;
        e->flops += both * two + edges * one + 2 * o->pairs * update +
                    o->P * (factor + m * (2 * triangular - c));
    }
}

/* even_owner: the rank that owns row i of an even split, larger blocks first: split of chain.c
 * without its table. */
static int even_owner(int nrow, int nrank, int i)
{
    const int q = nrow / nrank, rest = nrow % nrank, cut = rest * (q + 1);
    return i < cut ? i / (q + 1) : rest + (i - cut) / q;
}

/* rows: reduction of all rows of all ranks (5.4 b): what crosses ranks, step by step. */
static void rows(const struct run_spec *spec, const struct outline *o, struct program_estimate *e)
{
    const int n = (int)o->n, P = (int)o->P;
    const bool textbook = spec->kernel.solver == SOLVER_PCR;
    const double c = o->c, packed = c * (c + 1) / 2;
    struct outline all = *o; /* as if every row had a rank of its own, for the work */
    struct program_estimate work = {0};
    all.P = o->n, all.steps = all.pairs = all.triples = 0;
    for (int d = 1; d < n; d *= 2) {
        all.steps += 1;
        all.pairs += n - d;
        all.triples += n > 2 * d ? n - 2 * d : 0;
        /* Rows are walked in order, so that a change of either owner begins a new message; one for
         * each of the two directions. */
        int from = -1, to = -1;
        for (int i = 0; i + d < n; i++) {
            const int a = even_owner(n, P, i), b = even_owner(n, P, i + d);
            if (a == b) continue;
            /* updates that carry a coupling */
            const double right = i >= d ? 1 : 0, left = i + 2 * d < n ? 1 : 0;
            const double numbers =
                textbook ? 2 * (3 * c * c + c) : 2 * (packed + c) + (right + left) * c * c;
            if (a != from || b != to) e->messages += 2;
            e->bytes += numbers * (double)sizeof(real);
            from = a, to = b;
        }
    }
    /* The work is that of one row per rank; its messages are replaced by those counted above. */
    interface(spec, &all, 1, &work);
    e->flops += work.flops;
    add(e, o->P - 1, c * c);
    add(e, o->P - 1, c);
}

/* solution: the block tridiagonal system. */
static void solution(const struct run_spec *spec, const struct outline *o,
                     struct program_estimate *e)
{
    const double c = o->c, packed = c * (c + 1) / 2;
    /* With one row per rank, these are the interface solvers themselves. */
    if (o->split &&
        (spec->kernel.solver == SOLVER_PCR || spec->kernel.solver == SOLVER_PCR_SYMMETRIC)) {
        rows(spec, o, e);
        return;
    }
    interface(spec, o, 1, e);
    if (spec->kernel.solver == SOLVER_THOMAS) return;
    add(e, o->P - 1, c * c); /* coupling to the left, with the Schur complement of several rows */
    e->bytes += o->shifts * (packed + c) * (double)sizeof(real);
    add(e, o->P - 1, c); /* interface solution to the right */
    /* The first rank has no spike: one neighbour (physics 5.4 a). The interior of the others is
     * eliminated towards two, and substituted from two. */
    const double factor = c * (c + 1) * (2 * c + 1) / 6, product = c * (2 * c - 1);
    const double first = o->P < o->n ? (double)(int)((o->n + o->P - 1) / o->P) - 1 : 0,
                 others = o->n - o->P - first;
    /* towards one neighbour */
    const double side = c * c * c + packed * (2 * c - 1) + product + packed + c;
    e->flops += first * (factor + c * c + side + c * c + product + c);
    e->flops += others * (factor + c * c + 2 * side + c * product + c * c + 2 * (product + c));
}

/* rank_memory: what a rank's workspace holds, roughly: bodies, scan levels, the interface row with
 * its factors (one a step if they are kept), interior rows. 512 bytes for structs and alignment. */
static double rank_memory(const struct outline *o, bool keep)
{
    const double c = o->c, update = c * (c + 1) / 2 + c + c * c,
                 factor = c * (c + 1) / 2 + 2 * c * c, m = o->n / o->P;
    const double row = 4 * update + factor * (keep ? o->steps + 1 : 1) + 4 * c + c * (c + 1) / 2;
    const double rows = m > 1 ? m * (c * (c + 1) / 2 + c * c + c + factor) : 0;
    return (m * (XFORM_NUMBERS + SQUARE + 60) + o->T * (o->steps + 1) + row + rows) *
               (double)sizeof(real) +
           512;
}

/* evaluations: forward dynamics of all time steps (physics 9). */
static double evaluations(const struct kernel_spec *k)
{
    if (k->steps == 0) return 1;
    return k->step == STEP_RK4 ? 4.0 * k->steps : k->step == STEP_KDK ? k->steps + 1.0 : k->steps;
}

/* repeat: the same again and again. */
static void repeat(struct program_estimate *e, double times)
{
    e->messages *= times;
    e->bytes *= times;
    e->flops *= times;
}

/* stepping: what the time steps themselves do to coordinates and rates (motion.c). */
static double stepping(const struct kernel_spec *k, const struct model *m, double ranks)
{
    double drift = 0, slope = 0;
    for (int i = 0; i < m->nbody; i++) {
        const struct joint_cost *c = joint_cost_of(m->body[i].joint);
        drift += (double)c->step.flop;
        slope += (double)c->qdot.flop;
    }
    /* a kick is two flops a rate; Runge-Kutta weighs and adds, scales and adds, in four stages */
    if (k->step == STEP_RK4)
        return k->steps * (4 * (slope + 4.0 * (m->nq + m->nu)) + drift + ranks);
    if (k->step == STEP_KDK) return k->steps * (6.0 * m->nu + drift + ranks);
    return k->steps * (2.0 * m->nu + drift);
}

void estimate_inverse(const struct run_spec *spec, const struct model *model,
                      const struct job_omit *omit, struct program_estimate *out)
{
    const struct outline o = outline_of(spec, model);
    *out = (struct program_estimate){0};
    if (kernel_branches(model, omit)) {
        estimate_tree(spec, model, omit, true, false, out);
        return;
    }
    first_scan(&o, spec->kernel.composites_incoming, out);
    if (!omit->velocity) vector_scan(&o, false, out);
    vector_scan(&o, true, out);
    local_work(spec, &o, omit, true, out);
    out->rank_bytes = (o.n / o.P * (XFORM_NUMBERS + SQUARE + SQUARE) + o.T * (o.steps + 2)) *
                          (double)sizeof(real) +
                      512;
}

void estimate_forward(const struct run_spec *spec, const struct model *model,
                      const struct job_omit *omit, struct program_estimate *out)
{
    const struct outline o = outline_of(spec, model);
    const bool direct = spec->kernel.formulation == FORMULATION_DIRECT;
    *out = (struct program_estimate){0};
    if (kernel_branches(model, omit)) {
        estimate_tree(spec, model, omit, false, true, out);
        repeat(out, evaluations(&spec->kernel));
    out->flops += stepping(&spec->kernel, model, spec->nrank);
        return;
    }
    /* The paper's form needs all three scans for its bias, the direct one only the velocities (4.2,
     * 4.3). */
    const bool scans = direct ? !omit->velocity : !omit->bias;
    if (scans) first_scan(&o, spec->kernel.composites_incoming, out);
    if (!direct && scans) {
        if (!omit->velocity) vector_scan(&o, false, out);
        vector_scan(&o, true, out);
    }
    local_work(spec, &o, omit, !direct && scans, out);
    /* Edge data of physics 4.5: joints both ways, active forces both ways (the direct form's with
     * y), the reactions to the left. */
    const double edges = o.P - 1;
    add(out, 2 * edges, o.nq);
    add(out, edges, o.d);
    add(out, edges, o.d + (direct && !omit->load ? SPACE : 0));
    solution(spec, &o, out);
    add(out, edges, o.c);
    /* Assembly of A (two moved matrices a joint), projections, and one neighbour's joint placed
     * again. */
    out->flops += (o.n - 1) * (2 * SPACE * XFORM_MOTION_FLOP + PACKED) + (o.n + 2 * edges) * SPACE +
                  edges * o.place;
    const double moved = o.x + SPACE, terms = (!omit->load + !omit->velocity) * SPACE,
                 base = omit->base ? 0 : moved;
    /* Operator form (4.8), once before and once after the solution; or products with B and C. */
    if (direct)
        out->flops += 2 * (o.n * (BODY_ACCELERATE_FLOP + terms) + 2 * (o.n - 1) * moved + base +
                           edges * (BODY_ACCELERATE_FLOP + SPACE + moved));
    else out->flops += o.n * (6 * o.d * (o.c + SPACE) - o.c) + edges * SPACE * XFORM_MOTION_FLOP;
    out->rank_bytes =
        rank_memory(&o, spec->kernel.inner_refinements + spec->kernel.outer_refinements > 0);
    repeat(out, evaluations(&spec->kernel));
    out->flops += stepping(&spec->kernel, model, spec->nrank);
}

void estimate_dynamics(const struct run_spec *spec, const struct model *model,
                       const struct job_omit *omit, struct program_estimate *out)
{
    struct program_estimate inverse, forward;
    estimate_inverse(spec, model, omit, &inverse);
    /* One after the other: everything adds up but the memory, which is the larger one's. */
    estimate_forward(spec, model, omit, &forward);
    *out = forward;
    out->messages += inverse.messages;
    out->bytes += inverse.bytes;
    out->flops += inverse.flops;
}
