/* pcr.c - symmetric parallel cyclic reduction (physics 5.3 ii): the sender computes, the receiver
 * adds.
 *
 * In step j every row is eliminated towards its neighbours at distance 2^j and at the same time
 * receives theirs; after ceil(log2 n) steps every row stands alone. No way back, hence half the
 * steps of cyclic reduction, for n log2 n eliminations in place of n; not backward stable (physics
 * 8.4). */
#include "kernel/scan.h"
#include "kernel/reduction.h"

/* receive: D -= S, r -= v from `peer`; the new coupling stays where it was received, behind S and
 * v. */
static void receive(struct reduction *s, int peer, int tag, real *in, int elements, struct work *w)
{
    const int packed = packed_size(s->c);
    comm_recv(s->comm, peer, tag, in, elements * (int64_t)sizeof(real));
    dense_subtract(packed, s->D, in, w);
    dense_subtract(s->c * s->m, s->r, in + packed, w);
    work_report(s->comm, w);
}

/* stride > 1: the rows left over by cyclic reduction. Distances are in rows, ranks `stride`
 * apart. */
void pcr_run(struct reduction *s, int stride, int tag, struct work *w)
{
    struct comm *comm = s->comm;
    const int n = comm_size(comm) / stride, k = (comm_rank(comm) + 1) / stride - 1, c = s->c,
              m = s->m;
    int slot = 0;
    for (int d = 1; d < n; d *= 2, slot++) {
        const bool has_a = k >= d, has_b = k + d < n;
        const int a = comm_rank(comm) - d * stride, b = comm_rank(comm) + d * stride;
        const int nl = has_a ? s->size[a] : 0, nu = has_b ? s->size[b] : 0;
        /* Towards both neighbours, with the couplings of this step. S, v and E are computed once,
         * here, not by the two receivers: 360 bytes and 915 flops a step for c = 5 against 640 and
         * about 2000. */
        reduction_eliminate(s, slot, nl, nu, w);
        work_report(comm, w);
        const int coupling = nl * nu;
        /* A message to the far side exists whenever the row does; no padding for general P. */
        if (has_b)
            comm_send(comm, b, tag + slot, s->out_b,
                      (block_update_size(nu, m) + coupling) * (int64_t)sizeof(real));
        if (has_a)
            comm_send(comm, a, tag + slot, s->out_a,
                      (block_update_size(nl, m) + coupling) * (int64_t)sizeof(real));
        /* E that comes from a couples to a's neighbour on the far side, two distances away; absent
         * if there is none. */
        const int far_a = k >= 2 * d ? s->size[a - d * stride] : 0,
                  far_b = k + 2 * d < n ? s->size[b + d * stride] : 0;
        const int own = block_update_size(c, m);
        if (has_a) receive(s, a, tag + slot, s->in_a, own + c * far_a, w);
        if (has_b) receive(s, b, tag + slot, s->in_b, own + c * far_b, w);
    }
    reduction_finish(s, slot, w);
}

/* receive_vector: r -= v. */
static void receive_vector(struct reduction *s, int peer, int tag, struct work *w)
{
    comm_recv(s->comm, peer, tag, s->in_a, s->c * s->m * (int64_t)sizeof(real));
    dense_subtract(s->c * s->m, s->r, s->in_a, w);
    work_report(s->comm, w);
}

/* A further right-hand side: 125 flops and 40 bytes a step for c = 5 (physics 5.3). */
void pcr_rerun(struct reduction *s, int stride, int tag, struct work *w)
{
    struct comm *comm = s->comm;
    const int n = comm_size(comm) / stride, k = (comm_rank(comm) + 1) / stride - 1, m = s->m;
    int slot = 0;
    for (int d = 1; d < n; d *= 2, slot++) {
        const bool has_a = k >= d, has_b = k + d < n;
        const int a = comm_rank(comm) - d * stride, b = comm_rank(comm) + d * stride;
        const int nl = has_a ? s->size[a] : 0, nu = has_b ? s->size[b] : 0;
        block_row_reduce(s->c, nl, nu, m, s->factor + slot * s->factor_size, s->r, s->y, s->out_a,
                         s->out_b, w);
        work_report(comm, w);
        if (has_b) comm_send(comm, b, tag + slot, s->out_b, nu * m * (int64_t)sizeof(real));
        if (has_a) comm_send(comm, a, tag + slot, s->out_a, nl * m * (int64_t)sizeof(real));
        if (has_a) receive_vector(s, a, tag + slot, w);
        if (has_b) receive_vector(s, b, tag + slot, w);
    }
    reduction_refinish(s, slot, w);
}
