/* chain.c - parallel Newton-Euler on blocks of a chain (chain.h).
 *
 * With m bodies a rank each recurrence is: a local sweep that starts from zero, a scan over the
 * ends of the blocks, a shift of the true end by one rank, and a second local sweep (physics 3.3).
 * Time on an ideal machine, per body x + 6 flops for a transform and a sum (x = 42, dense 66), y =
 * 63 for a composition:
 *
 *     V    (2 (x + 6) + y) (m - 1) + scan        V'   2 (x + 6) (m - 1) + scan
 *     F    (2 m - 1) (x + 6) + scan              (physics 10.9; the shift hides behind the scan) */
#include "kernel/chain.h"

#include <string.h>

#include "kernel/assembly.h"
#include "kernel/blocks.h"
#include "kernel/implicit.h"
#include "kernel/tags.h"
#include "linalg/dense.h"
#include "model/model_part.h"

/* Rates of joints lo .. hi-1 are contiguous, bodies being numbered along the chain. */
int chain_nu(const struct chain_shared *shared, int lo, int hi)
{
    const struct body *last = &shared->body[hi - 1];
    return last->u_at + last->d - shared->body[lo].u_at;
}

int chain_nq(const struct chain_shared *shared, int lo, int hi)
{
    const struct body *last = &shared->body[hi - 1];
    return last->q_at + last->nq - shared->body[lo].q_at;
}

/* weight: of a body whose joint has c constraints, in a balanced partition: its share of the sweeps
 * and of the assembly, the elimination (physics 5.1) towards two neighbours, and the substitution.
 * [flop] */
static int64_t weight(int c)
{
    return BODY_SHARE_FLOP + dense_factor_flops(c) + dense_triangular_flops(c, 2 * c + 1) +
           2 * dense_symmetric_flops(c, c) + dense_product_flops(c, c + 4, c);
}

/* split: first body of every rank: equal numbers, larger blocks first, or nearly equal weights.
 * With more ranks than bodies there is nothing to split; dynamics_kernel.c refuses such a run. */
static int *split(const unsigned char *size, int n, int nrank, bool balanced, struct arena *a)
{
    int *first = TAKE(a, nrank + 1, int);
    if (nrank > n) return first;
    for (int k = 0; k <= nrank; k++) first[k] = kernel_block(n, nrank, k);
    if (!balanced) return first;
    /* Cut where the sum of weights passes k/nrank of the total; half a body's weight rounds to the
     * nearer side. The bound on i leaves one body for each rank that is still to come. Integers, so
     * that every compiler cuts at the same places. */
    int64_t total = 0, sum = 0;
    for (int i = 0; i < n; i++) total += weight(size[i]);
    for (int i = 0, k = 1; k < nrank; k++) {
        while (i < n - (nrank - k) && (sum + weight(size[i]) / 2) * nrank < total * k)
            sum += weight(size[i++]);
        if (i <= first[k - 1]) sum += weight(size[i++]); /* every rank has a body */
        first[k] = i;
    }
    return first;
}

struct chain_shared *chain_shared_make(const struct kernel_job *job, struct arena *a)
{
    const struct model *model = job->model;
    const int n = model->nbody, nrank = job->nrank;
    const int first = model_known_first(model), end = model_known_end(model);
    struct chain_shared *s = TAKE(a, 1, struct chain_shared);
    unsigned char *size = TAKE(a, n, unsigned char), *interface = TAKE(a, nrank, unsigned char);
    bool picked = true;
    s->body = bodies_make(model, a);
    s->layout =
        (struct row_layout){.nrow = n, .nrank = nrank, .size = size, .interface = interface};
    /* A spring that is treated linearly implicitly makes all six components of its joint's force
     * unknown (physics 9.0): a row of order 6. Any other joint has one unknown per constraint. */
    for (int i = first; i < end; i++) {
        const bool soft = spring_resistance(&s->body[i], implicit_step(job)) > 0;
        size[i] = (unsigned char)(soft ? SPACE : SPACE - s->body[i].d);
        if (size[i] > s->layout.largest) s->layout.largest = size[i];
        picked = picked && body_picks(&s->body[i]);
    }
    /* Of a part all joints are revolute, here or not (model_divides). */
    memset(size, SPACE - 1, (size_t)first);
    memset(size + end, SPACE - 1, (size_t)(n - end));
    /* The rank's last body carries the interface row, which the reduction between ranks sees. */
    s->layout.first = split(size, n, nrank, job->spec->kernel.partition == PARTITION_BALANCED, a);
    for (int k = 0; k < nrank; k++) interface[k] = size[s->layout.first[k + 1] - 1];
    /* Where every joint's axes are axes of its frame, H and W pick components. Their columns are
     * the last members of the structs, and no rank keeps room for them. */
    s->pose_bytes = picked ? offsetof(struct body_pose, s.col) : sizeof(struct body_pose);
    s->subspace_bytes = picked ? offsetof(struct subspace, col) : sizeof(struct subspace);
    base_motion(model, job->state, s->base);
    return s;
}

void chain_carve(struct chain *ch, struct carve *c, const struct kernel_job *job, int rank,
                 bool edge, bool forces, bool once)
{
    const struct chain_shared *s = job->shared;
    const int n = job->model->nbody, lo = s->layout.first[rank], hi = s->layout.first[rank + 1];
    /* With the pose of the right neighbour's first body the rank assembles its coupling without
     * another message: X_hi follows from q_hi, physics 4.5 step 0. */
    const int room = hi - lo + (edge && hi < n ? 1 : 0);
    ch->job = job;
    ch->shared = s;
    ch->n = n, ch->lo = lo, ch->hi = hi;
    ch->dense = job->spec->kernel.operators == OPERATORS_DENSE;
    ch->q = CARVE(c, chain_nq(s, lo, hi), real);
    ch->u = CARVE(c, chain_nu(s, lo, hi), real);
    ch->pose = CARVE(c, (size_t)room * s->pose_bytes, char);
    ch->matrix = CARVE(c, ch->dense ? SQUARE * room : 0, real);
    const int moving = job->omit.velocity ? 0 : SPACE * (hi - lo);
    ch->h = CARVE(c, moving, real);
    ch->v = CARVE(c, moving, real);
    ch->b = CARVE(c, moving, real);
    const bool shared = once && moving > 0;
    ch->a = shared ? ch->b : CARVE(c, forces ? SPACE * (hi - lo) : 0, real);
    ch->f = shared ? ch->h : CARVE(c, forces ? SPACE * (hi - lo) : 0, real);
}

void chain_load(struct chain *ch)
{
    const struct state *state = ch->job->state;
    const struct body *first = &ch->shared->body[ch->lo];
    const int nq = chain_nq(ch->shared, ch->lo, ch->hi), nu = chain_nu(ch->shared, ch->lo, ch->hi);
    for (int k = 0; k < nq; k++) ch->q[k] = (real)state->q[first->q_at + k];
    for (int k = 0; k < nu; k++) ch->u[k] = (real)state->qd[first->u_at + k];
}

/* Work is counted per body, as it is done; the machine hears of it once, at the end of the loop. */
void chain_place(struct chain *ch)
{
    const bool moves = !ch->job->omit.velocity;
    /* New coordinates: the composites of earlier scans are void. */
    ch->composed = false;
    for (int i = ch->lo; i < ch->hi; i++) {
        const struct body *b = &ch->shared->body[i];
        const struct joint_cost *cost = body_cost(b);
        struct body_pose *pose = chain_pose(ch, i);
        body_place(b, ch->q + chain_q_at(ch, i), pose);
        if (moves) body_rate(pose, ch->u + chain_u_at(ch, i), chain_at(ch, ch->h, i));
        ch->work.flop += (uint64_t)(cost->place + (!moves      ? 0
                                                   : ch->dense ? SPACE * b->d
                                                               : cost->rate));
        ch->work.trig += (uint64_t)cost->place_trig;
        ch->work.div += (uint64_t)cost->place_div;
        ch->work.call += moves ? 2 : 1;
        if (ch->dense)
            transform_expand(true, ch->matrix + SQUARE * (i - ch->lo), &pose->x, &ch->work);
    }
    chain_report(ch);
}

/* compose_block: C = X_lo o .. o X_{hi-1}, the transform from this block's end to the end of the
 * block before (physics 3.3): 63 flops for each body but the first, once per configuration. Not
 * inlined: no matrix may lie in the frame of whoever waits for messages, once on each rank's
 * stack. */
static __attribute__((noinline)) void compose_block(struct chain *ch, real *C)
{
    const int size = ch->scan.size;
    real next[SQUARE];
    memcpy(C, chain_transform(ch, ch->lo), (size_t)size * sizeof(real));
    for (int i = ch->lo + 1; i < ch->hi; i++) {
        transform_compose(ch->dense, next, C, chain_transform(ch, i), &ch->work);
        memcpy(C, next, (size_t)size * sizeof(real));
    }
}

/* begin_composites: level 0 of the scan's transforms. In the outgoing form it is the right
 * neighbour's: one more round of messages at the start (physics 3.2). Rank 0 has no composite in
 * the incoming form, since nothing is scanned across the base. */
static void begin_composites(struct chain *ch)
{
    const int k = comm_rank(ch->comm);
    const int64_t bytes = ch->scan.size * (int64_t)sizeof(real);
    if (ch->scan.incoming) {
        if (k > 0) compose_block(ch, ch->scan.level);
        return;
    }
    if (k > 0) {
        compose_block(ch, ch->scan.in);
        chain_report(ch);
        comm_send(ch->comm, k - 1, TAG_COMPOSITE, ch->scan.in, bytes);
    }
    if (k + 1 < comm_size(ch->comm))
        comm_recv(ch->comm, k + 1, TAG_COMPOSITE, ch->scan.level, bytes);
}

/* sweep_up: x_i = X_i^T x_{i-1} + x_i for i = from .. to-1, in place; `before` (SPACE) is
 * x_{from-1}. */
static void sweep_up(struct chain *ch, real *x, const real *before, int from, int to)
{
    for (int i = from; i < to; i++) {
        real moved[SPACE], *now = chain_at(ch, x, i);
        transform_motion(ch->dense, moved, chain_transform(ch, i), before, &ch->work);
        screw_add(now, moved);
        ch->work.flop += SCREW_ADD_FLOP;
        before = now;
    }
}

/* end_of_block: x at the block's last body when x before the block is zero; x is not changed,
 * because the second sweep starts again from the sources. */
static void end_of_block(struct chain *ch, real *x, real *end)
{
    screw_copy(end, chain_at(ch, x, ch->lo));
    for (int i = ch->lo + 1; i < ch->hi; i++) {
        transform_motion(ch->dense, end, chain_transform(ch, i), end, &ch->work);
        screw_add(end, chain_at(ch, x, i));
        ch->work.flop += SCREW_ADD_FLOP;
    }
}

/* scan_up: x_i += X_i^T x_{i-1} along the whole chain, in place (physics 3.1, 3.3). Local sum, scan
 * of the blocks' ends, shift of the true end to the next rank, second sweep. Twice the work of a
 * serial sweep, but a depth of 2 m + log2 P instead of n. */
static void scan_up(struct chain *ch, real *x, int tag)
{
    const bool first = !ch->composed;
    struct comm *c = ch->comm;
    const int k = comm_rank(c), P = comm_size(c), m = ch->hi - ch->lo;
    /* Bodies of the right neighbour: with one it takes its value from the scan itself. */
    const int next = k + 1 < P ? ch->shared->layout.first[k + 2] - ch->hi : 0;
    const int shift = TAG_SHIFT + tag / TAG_STEP;
    real end[SPACE];
    /* The first scan at these coordinates builds the composites, all later ones only use them. */
    if (first) begin_composites(ch);
    end_of_block(ch, x, end);
    if (first) scan_first(&ch->scan, tag, end, &ch->work);
    else scan_motion(&ch->scan, tag, end, &ch->work);
    ch->composed = true;
    /* A right neighbour with one body has all that it needs from the scan. */
    if (next > 1) comm_send(c, k + 1, shift, end, (int64_t)sizeof end);
    /* The last body's value comes from the scan; the sweep stops before it. */
    screw_copy(chain_at(ch, x, ch->hi - 1), end);
    if (m > 1 && k > 0) {
        comm_recv(c, k - 1, shift, end, (int64_t)sizeof end); /* where the block before ends */
        sweep_up(ch, x, end, ch->lo, ch->hi - 1);
    } else if (m > 1) {
        sweep_up(ch, x, x, ch->lo + 1, ch->hi - 1);
    }
    chain_report(ch);
}

/* sweep_down: f_i += X_{i+1} f_{i+1} inside the block, in place. */
static void sweep_down(struct chain *ch, real *f)
{
    for (int i = ch->hi - 2; i >= ch->lo; i--) {
        real moved[SPACE];
        transform_force(ch->dense, moved, chain_transform(ch, i + 1), chain_at(ch, f, i + 1),
                        &ch->work);
        screw_add(chain_at(ch, f, i), moved);
        ch->work.flop += SCREW_ADD_FLOP;
    }
}

/* entering: total force that enters the block at its last body, from the blocks' own sums. Shift
 * first, then scan, so that the composites of the motions are the right ones: the other order needs
 * transforms between first bodies, which no rank holds (physics 3.3). */
static void entering(struct chain *ch, real *total)
{
    struct comm *c = ch->comm;
    const int k = comm_rank(c);
    real sum[SPACE];
    screw_copy(sum, chain_at(ch, ch->f, ch->hi - 1));
    /* The block's own sum, seen at its first body. */
    for (int i = ch->hi - 1; i > ch->lo; i--) {
        transform_force(ch->dense, sum, chain_transform(ch, i), sum, &ch->work);
        screw_add(sum, chain_at(ch, ch->f, i - 1));
        ch->work.flop += SCREW_ADD_FLOP;
    }
    /* Carried over the edge joint, it is seen at the last body of the rank before. */
    if (k > 0) {
        transform_force(ch->dense, sum, chain_transform(ch, ch->lo), sum, &ch->work);
        chain_report(ch);
        comm_send(c, k - 1, TAG_SHIFT + TAG_FORCE / TAG_STEP, sum, (int64_t)sizeof sum);
    }
    screw_zero(total);
    if (k + 1 < comm_size(c))
        /* Now the sums of all blocks to the right, by the composites kept from the motions. */
        comm_recv(c, k + 1, TAG_SHIFT + TAG_FORCE / TAG_STEP, total,
                  (int64_t)(SPACE * sizeof *total));
    scan_force(&ch->scan, TAG_FORCE, total, &ch->work);
}

void chain_velocity(struct chain *ch)
{
    /* Without velocities V, and with it the bias terms, is zero: the stage has no messages at
     * all. */
    if (ch->job->omit.velocity) return;
    memcpy(ch->v, ch->h, (size_t)(SPACE * (ch->hi - ch->lo)) * sizeof(real));
    scan_up(ch, ch->v, TAG_VELOCITY);
}

/* b needs the body's own V only (physics 1.9), so that there is no message here. The paper sends
 * V_{i-1} for it (erratum E4). */
void chain_bias(struct chain *ch)
{
    for (int i = ch->lo; i < ch->hi && !ch->job->omit.velocity; i++) {
        const struct body *b = &ch->shared->body[i];
        body_bias(b, chain_pose(ch, i), chain_at(ch, ch->v, i), chain_at(ch, ch->h, i),
                  ch->u + chain_u_at(ch, i), chain_at(ch, ch->b, i));
        ch->work.flop += (uint64_t)body_cost(b)->bias;
        ch->work.call++;
    }
}

void chain_acceleration(struct chain *ch, const real *ud)
{
    const size_t size = (size_t)(SPACE * (ch->hi - ch->lo)) * sizeof(real);
    /* Sources of the recurrence: b_i + H_i u'_i (physics 2.2). */
    if (ch->job->omit.velocity) memset(ch->a, 0, size);
    else if (ch->a != ch->b) memcpy(ch->a, ch->b, size);
    for (int i = ch->lo; i < ch->hi && ud; i++) {
        const struct body *b = &ch->shared->body[i];
        subspace_h(&chain_pose(ch, i)->s, ud + chain_u_at(ch, i), chain_at(ch, ch->a, i));
        ch->work.flop += (uint64_t)(ch->dense ? SCREW_AXPY_FLOP * b->d : body_cost(b)->h);
    }
    /* The acceleration of the base enters as part of body 0's source (physics 3.1). */
    if (ch->lo == 0 && !ch->job->omit.base) {
        real moved[SPACE];
        transform_base(ch->dense, ch->job->omit.turn, moved, chain_transform(ch, 0),
                       ch->shared->base, &ch->work);
        screw_add(ch->a, moved);
        ch->work.flop += SCREW_ADD_FLOP;
    }
    scan_up(ch, ch->a, TAG_ACCELERATION);
}

void chain_gyro(struct chain *ch, int i, real *f)
{
    const struct body *b = &ch->shared->body[i];
    const double *fext = ch->job->state->fext;
    if (ch->job->omit.velocity) {
        screw_zero(f);
    } else {
        body_gyro(b, chain_at(ch, ch->v, i), f);
        ch->work.flop += BODY_GYRO_FLOP;
        ch->work.call++;
    }
    /* An external force is subtracted from what the joints must carry (physics 2.4). */
    if (!fext) return;
    real load[SPACE];
    body_load(b, fext + 6 * i, load);
    screw_sub(f, load);
    ch->work.flop += (uint64_t)body_load_flops(b) + SCREW_ADD_FLOP;
}

/* Fext - P, the load of the direct form (physics 4.5). */
void chain_gain(struct chain *ch, real *gain)
{
    for (int i = ch->lo; i < ch->hi; i++) {
        real *f = chain_at(ch, gain, i);
        chain_gyro(ch, i, f);
        for (int k = 0; k < SPACE; k++) f[k] = -f[k];
    }
}

/* S^T I S by two products of full matrices, as a code without structured inertia does in every
 * evaluation. The transpose in between is a copy and costs no operation. */
void chain_shifted_inertia(const struct body *b, real *inertia, struct work *w)
{
    real shift[SQUARE] = {0}, about[SQUARE] = {0}, product[SQUARE];
    body_inertia_factors(b, shift, about);
    dense_product(SPACE, SPACE, SPACE, shift, about, product, w);
    for (int i = 0; i < SPACE; i++)
        for (int j = 0; j < i; j++) {
            const real t = shift[SPACE * i + j];
            shift[SPACE * i + j] = shift[SPACE * j + i];
            shift[SPACE * j + i] = t;
        }
    dense_product(SPACE, SPACE, SPACE, product, shift, inertia, w);
}

/* dense_load: I a of own body i by full matrices. Not inlined, as compose_block. */
static __attribute__((noinline)) void dense_load(struct chain *ch, int i, real *inertial)
{
    real inertia[SQUARE];
    chain_shifted_inertia(&ch->shared->body[i], inertia, &ch->work);
    dense_product(SPACE, 1, SPACE, inertia, chain_at(ch, ch->a, i), inertial, &ch->work);
}

/* load: f = I a + P - Fext of own body i, (2.3) and (2.4) of physics without the children's
 * part. */
static void load(struct chain *ch, int i)
{
    const struct body *b = &ch->shared->body[i];
    real inertial[SPACE], *f = chain_at(ch, ch->f, i);
    /* At rest and without external force P - Fext is zero: nothing to add. */
    const bool more = !ch->job->omit.velocity || ch->job->state->fext;
    if (more) chain_gyro(ch, i, f);
    if (ch->dense) {
        dense_load(ch, i, inertial);
    } else {
        body_force(b, chain_at(ch, ch->a, i), inertial);
        ch->work.flop += BODY_FORCE_FLOP;
        ch->work.call++;
    }
    if (more) screw_add(f, inertial);
    else screw_copy(f, inertial);
    ch->work.flop += more ? SCREW_ADD_FLOP : 0;
}

void chain_force(struct chain *ch, real *tau)
{
    /* Loads first, then one recurrence downwards (physics 2.3, 2.4). */
    for (int i = ch->lo; i < ch->hi; i++) load(ch, i);
    /* One body per rank: the scan is the whole sweep and needs no shift (physics 3.1). */
    if (ch->n == comm_size(ch->comm)) {
        scan_force(&ch->scan, TAG_FORCE, ch->f, &ch->work);
    } else {
        real total[SPACE];
        entering(ch, total);
        screw_add(chain_at(ch, ch->f, ch->hi - 1), total);
        ch->work.flop += SCREW_ADD_FLOP;
        sweep_down(ch, ch->f);
    }
    /* tau_i = H_i^T F_i (physics 2.5). */
    for (int i = ch->lo; i < ch->hi; i++) {
        const struct body *b = &ch->shared->body[i];
        subspace_h_transposed(&chain_pose(ch, i)->s, chain_at(ch, ch->f, i),
                              tau + chain_u_at(ch, i));
        ch->work.flop += (uint64_t)(ch->dense ? SCREW_DOT_FLOP * b->d : body_cost(b)->h_transposed);
    }
    chain_report(ch);
}

/* With u' = 0 the joint forces are the bias xi of the equations of motion (physics 4.2). */
void chain_bias_force(struct chain *ch, real *tau)
{
    comm_stage(ch->comm, STAGE_VELOCITY);
    chain_velocity(ch);
    comm_stage(ch->comm, STAGE_ACCELERATION);
    chain_bias(ch);
    chain_acceleration(ch, NULL);
    comm_stage(ch->comm, STAGE_FORCE);
    chain_force(ch, tau);
}
