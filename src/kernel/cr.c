/* cr.c - cyclic reduction in natural placement, optionally ending in parallel cyclic reduction
 * (physics 5.2, 5.4 d).
 *
 * With kappa = rank + 1, level s = 1, 2, 4, ..: rows with kappa mod 2s = s are eliminated, those
 * with kappa mod 2s = 0 go on. A row is eliminated once, so one factor is all that a further
 * right-hand side needs. Backward stable. P = 7, rows by kappa, x: eliminated at this level:
 *
 *     s = 1    x   2   x   4   x   6   x
 *     s = 2        x       4       x
 *     s = 4                4               solved alone; then 2 and 6, then 1, 3, 5, 7 */
#include "kernel/scan.h"
#include "kernel/reduction.h"
#include "kernel/tags.h"

/* Neighbours of the own row at a level: their ranks and the orders of their rows (0: none). */
struct level_neighbours {
    bool has_a, has_b;
    int a, b, nl, nu;
};

static struct level_neighbours neighbours(const struct reduction *s, int distance)
{
    const int k = comm_rank(s->comm), P = comm_size(s->comm);
    struct level_neighbours v = {.has_a = k >= distance, .has_b = k + distance < P};
    v.a = k - distance, v.b = k + distance;
    v.nl = v.has_a ? s->size[v.a] : 0;
    v.nu = v.has_b ? s->size[v.b] : 0;
    return v;
}

/* give_way: send the updates to the neighbours (to_a, to_b numbers), wait for their solutions and
 * substitute. To the right first (physics 5.2). */
static void give_way(struct reduction *s, const struct level_neighbours *v, int tag, int to_a,
                     int to_b, struct work *w)
{
    struct comm *comm = s->comm;
    const int m = s->m;
    work_report(comm, w);
    if (v->has_b) comm_send(comm, v->b, tag, s->out_b, to_b * (int64_t)sizeof(real));
    if (v->has_a) comm_send(comm, v->a, tag, s->out_a, to_a * (int64_t)sizeof(real));
    if (v->has_a) comm_recv(comm, v->a, tag + TAG_STEP, s->in_a, v->nl * m * (int64_t)sizeof(real));
    if (v->has_b) comm_recv(comm, v->b, tag + TAG_STEP, s->in_b, v->nu * m * (int64_t)sizeof(real));
    block_row_resubstitute(s->c, v->nl, v->nu, m, s->factor, s->y, s->in_a, s->in_b, w);
    /* s->y was needed beside the factor; the caller looks for the solution in r. */
    for (int i = 0; i < s->c * m; i++) s->r[i] = s->y[i];
    work_report(comm, w);
}

/* serve: solutions to the rows eliminated at levels `distance`, distance/2, .. 1 that lie beside
 * this one: the way back of physics 5.2. Messages 8 c m bytes. */
static void serve(struct reduction *s, int distance, int tag)
{
    struct comm *comm = s->comm;
    const int kappa = comm_rank(comm) + 1;
    const int64_t bytes = s->c * s->m * (int64_t)sizeof(real);
    int slot = 0;
    /* The level's number, which gave its updates their tags, tags the solutions too. */
    while ((1 << slot) < distance) slot++;
    for (; distance >= 1; distance /= 2, slot--) {
        if (kappa % (2 * distance) != 0) continue;
        if (kappa + distance <= comm_size(comm))
            comm_send(comm, kappa + distance - 1, tag + slot + TAG_STEP, s->r, bytes);
        /* The left neighbour exists: kappa is a multiple of 2 distance. */
        comm_send(comm, kappa - distance - 1, tag + slot + TAG_STEP, s->r, bytes);
    }
}

/* receive: the update of the row eliminated at rank `peer`; `far` is the order of the row behind
 * it. Behind the update lies E, which stays where it is and becomes the new coupling. */
static void receive(struct reduction *s, int peer, int tag, real *in, int far, struct work *w)
{
    const int c = s->c, m = s->m, packed = packed_size(c);
    comm_recv(s->comm, peer, tag, in, (block_update_size(c, m) + c * far) * (int64_t)sizeof(real));
    dense_subtract(packed, s->D, in, w);
    dense_subtract(c * m, s->r, in + packed, w);
    work_report(s->comm, w);
}

/* The tags: updates at tag + slot, embedded parallel cyclic reduction from tag + 32, solutions from
 * tag + TAG_STEP. */
enum { EMBEDDED = TAG_STEP / 2 };

void cr_run(struct reduction *s, int levels, int tag, struct work *w)
{
    struct comm *comm = s->comm;
    const int kappa = comm_rank(comm) + 1, P = comm_size(comm), m = s->m;
    int distance = 1;
    bool eliminated = false;
    for (int slot = 0; slot < levels && 2 * distance <= P; slot++, distance *= 2) {
        /* A row that goes on couples next to those at twice the distance; E has their order. */
        const struct level_neighbours v = neighbours(s, distance),
                                      far = neighbours(s, 2 * distance);
        if (kappa % (2 * distance) == distance) {
            reduction_eliminate(s, 0, v.nl, v.nu, w);
            const int coupling = v.nl * v.nu;
            give_way(s, &v, tag + slot, block_update_size(v.nl, m) + coupling,
                     block_update_size(v.nu, m) + coupling, w);
            eliminated = true;
            break;
        }
        /* A row that goes on has a left neighbour at this level: kappa >= 2 distance. */
        receive(s, v.a, tag + slot, s->in_a, far.nl, w);
        if (v.has_b) receive(s, v.b, tag + slot, s->in_b, far.nu, w);
    }
    /* The rows left over: after all levels one, which pcr_run merely solves; in the hybrid method
     * P/2^levels, and parallel cyclic reduction in place of more levels saves their way back. */
    if (!eliminated) pcr_run(s, distance, tag + EMBEDDED, w);
    serve(s, distance / 2, tag);
}

/* receive_vector: r -= v of the row eliminated at rank `peer`. */
static void receive_vector(struct reduction *s, int peer, int tag, struct work *w)
{
    comm_recv(s->comm, peer, tag, s->in_a, s->c * s->m * (int64_t)sizeof(real));
    dense_subtract(s->c * s->m, s->r, s->in_a, w);
    work_report(s->comm, w);
}

/* The same schedule with vectors only. A row is eliminated once, so one factor suffices. */
void cr_rerun(struct reduction *s, int levels, int tag, struct work *w)
{
    struct comm *comm = s->comm;
    const int kappa = comm_rank(comm) + 1, P = comm_size(comm), m = s->m;
    int distance = 1;
    bool eliminated = false;
    for (int slot = 0; slot < levels && 2 * distance <= P; slot++, distance *= 2) {
        const struct level_neighbours v = neighbours(s, distance);
        if (kappa % (2 * distance) == distance) {
            block_row_reduce(s->c, v.nl, v.nu, m, s->factor, s->r, s->y, s->out_a, s->out_b, w);
            give_way(s, &v, tag + slot, v.nl * m, v.nu * m, w);
            eliminated = true;
            break;
        }
        receive_vector(s, v.a, tag + slot, w);
        if (v.has_b) receive_vector(s, v.b, tag + slot, w);
    }
    if (!eliminated) pcr_rerun(s, distance, tag + EMBEDDED, w);
    serve(s, distance / 2, tag);
}
