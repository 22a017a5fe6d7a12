/* closure.c - loop forces from the open system's accelerations (closure.h).
 *
 * Steps of an evaluation: closure_meet (poses and velocities between the two owners of each loop),
 * closure_loads (unit loop forces as loads of their bodies), the solution of the open system,
 * closure_solve (S and residual to rank 0, lambda to all). At most four messages a loop, and a
 * broadcast. */
#include "kernel/closure.h"

#include <string.h>

#include "comm/collectives.h"
#include "kernel/scan.h"
#include "kernel/tags.h"
#include "linalg/least_norm.h"

/* A meeting message is the pose of a loop's body and its velocity. */
enum { TAG_MEET = TAG_LOOP, TAG_CONTRIBUTE, TAG_LAMBDA, MEETING = XFORM_NUMBERS + SPACE };

/* Made once; the number of columns of all solutions follows from it. */
struct closure_shared *closure_shared_make(const struct model *m, const struct body *body,
                                           const real *base, const int *owner, struct arena *a)
{
    if (m->nloop == 0) return NULL;
    struct closure_shared *s = TAKE(a, 1, struct closure_shared);
    struct loop *loop = TAKE(a, m->nloop, struct loop);
    int *place = TAKE(a, m->nrow, int);
    loops_make(m, loop, place);
    *s = (struct closure_shared){.nloop = m->nloop,
                                 .nrow = loop_rows(m),
                                 .loop = loop,
                                 .place = place,
                                 .owner = owner,
                                 .body = body,
                                 .base = base};
    return s;
}

/* Only ranks that own a side need room for poses; only rank 0 solves. */
void closure_carve(struct closure *cl, struct carve *c, const struct closure_shared *shared,
                   int rank)
{
    *cl = (struct closure){.shared = shared, .m = shared ? 1 + shared->nrow : 1};
    if (!shared) return;
    const int n = shared->nrow, sides = 2 * shared->nloop;
    for (int s = 0; s < sides; s++) cl->takes_part = cl->takes_part || shared->owner[s] == rank;
    cl->lambda = CARVE(c, n, real);
    if (!cl->takes_part && rank != 0) return;
    cl->contribution = CARVE(c, SPACE * (cl->m + 1), real);
    cl->pose = CARVE(c, shared->nloop, struct loop_pose);
    cl->side_pose = CARVE(c, sides, struct xform);
    cl->side_velocity = CARVE(c, SPACE * sides, real);
    if (rank != 0) return;
    cl->S = CARVE(c, n * n, real);
    cl->reference = CARVE(c, n, real);
    cl->scratch = CARVE(c, n * n + 2 * n, real);
}

/* Both owners of a loop compute its place and its bias gamma (physics 7.3) from the two poses and
 * velocities: 144 bytes each way, less than the place itself. */
void closure_meet(struct closure *cl, struct work *w)
{
    const struct closure_shared *s = cl->shared;
    const int k = comm_rank(cl->comm);
    real message[MEETING];
    if (!cl->takes_part) return;
    /* All sends before any receive: two ranks with a loop between them would wait for each
     * other. */
    for (int side = 0; side < 2 * s->nloop; side++) {
        const int other = s->owner[side ^ 1];
        if (s->owner[side] != k || other < 0 || other == k) continue;
        memcpy(message, &cl->side_pose[side], XFORM_NUMBERS * sizeof(real));
        memcpy(message + XFORM_NUMBERS, cl->side_velocity + SPACE * side, SPACE * sizeof(real));
        comm_send(cl->comm, other, TAG_MEET, message, (int64_t)sizeof message);
    }
    for (int side = 0; side < 2 * s->nloop; side++) {
        if (s->owner[side] == k) continue;
        /* The base does not move, and its frame is the reference. */
        if (s->owner[side] < 0) {
            xform_identity(&cl->side_pose[side]);
            screw_zero(cl->side_velocity + SPACE * side);
        } else if (s->owner[side ^ 1] == k) {
            comm_recv(cl->comm, s->owner[side], TAG_MEET, message, (int64_t)sizeof message);
            memcpy(&cl->side_pose[side], message, XFORM_NUMBERS * sizeof(real));
            memcpy(cl->side_velocity + SPACE * side, message + XFORM_NUMBERS, SPACE * sizeof(real));
        }
    }
    /* Both sides are known: the loop's frames, W, gamma and stabilisation (physics 7.2, 7.3). */
    for (int l = 0; l < s->nloop; l++) {
        if (s->owner[2 * l] != k && s->owner[2 * l + 1] != k) continue;
        loop_place(&s->loop[l], &cl->side_pose[2 * l], &cl->side_pose[2 * l + 1],
                   cl->side_velocity + 2 * SPACE * l, cl->side_velocity + 2 * SPACE * l + SPACE,
                   &cl->pose[l]);
        w->flop += (uint64_t)loop_place_flops(&s->loop[l]);
        w->call++;
    }
    work_report(cl->comm, w);
}

void closure_loads(struct closure *cl, int body, real *load, struct work *w)
{
    const struct closure_shared *s = cl->shared;
    if (!s || !cl->takes_part) return;
    for (int side = 0; side < 2 * s->nloop; side++) {
        if (closure_body(s, side) != body) continue;
        real column[6 * SPACE];
        const struct loop *l = &s->loop[side / 2];
        loop_column(&cl->pose[side / 2], side % 2, column);
        for (int k = 0; k < l->c; k++)
            screw_add(load + SPACE * (1 + l->row_at + k), column + SPACE * k);
        w->flop += (uint64_t)(l->c * (XFORM_FORCE_FLOP + SCREW_ADD_FLOP));
    }
}

/* contribute: what one side adds to the loop's rows, [c x m residual columns, c reference
 * elements]; the side that exists alone, or b, brings the velocity terms and the base.
 *
 * r = W^T (T_b^T a_b - T_a^T a_a + gamma) + stabilisation (physics 7.2): the sides enter with
 * opposite signs. The reference is the side's part of the diagonal of A_ll (physics 7.4). */
static void contribute(struct closure *cl, int side, const real *acceleration, real *out,
                       struct work *w)
{
    const struct closure_shared *s = cl->shared;
    const int l = side / 2, c = s->loop[l].c, m = cl->m;
    const struct loop_pose *p = &cl->pose[l];
    const struct xform *here = side % 2 ? &p->tb : &p->ta, *there = side % 2 ? &p->ta : &p->tb;
    /* F acts on b and -F on a (physics 7.2). */
    const real sign = side % 2 ? 1 : -1;
    const bool alone = s->owner[side ^ 1] < 0;
    real column[6 * SPACE], moved[SPACE], accelerated[SPACE];
    for (int j = 0; j < m; j++) {
        xform_motion(moved, here, acceleration + SPACE * j);
        for (int k = 0; k < SPACE; k++) moved[k] *= sign;
        /* A side on the base accelerates with -g, in the real column. */
        if (j == 0 && alone && s->base) {
            xform_motion(accelerated, there, s->base);
            screw_axpy(moved, -sign, accelerated);
        }
        if (j == 0 && (alone || side % 2)) screw_add(moved, p->gamma);
        for (int k = 0; k < c; k++) out[k * m + j] = screw_dot(p->w + SPACE * k, moved);
    }
    /* Scaling by the diagonal of S itself would turn its rounding noise into full rank (physics
     * 7.7). */
    loop_column(p, side % 2, column);
    for (int k = 0; k < c; k++) {
        if (alone || side % 2) out[k * m] += p->stabilise[k];
        body_accelerate(&s->body[closure_body(s, side)], column + SPACE * k, accelerated);
        out[c * m + k] = screw_dot(column + SPACE * k, accelerated);
    }
    w->flop += (uint64_t)(m * (XFORM_MOTION_FLOP + SCREW_DOT_FLOP * c) +
                          c * (XFORM_FORCE_FLOP + BODY_ACCELERATE_FLOP + SCREW_DOT_FLOP));
    w->call += 3;
}

/* collect: add a side's contribution to S, the residual (in lambda) and the reference. lambda is
 * the right-hand side -r, solved in place. */
static void collect(struct closure *cl, int side, const real *in, struct work *w)
{
    const struct loop *l = &cl->shared->loop[side / 2];
    const int n = cl->shared->nrow, m = cl->m;
    for (int k = 0; k < l->c; k++) {
        for (int j = 0; j < n; j++) cl->S[(l->row_at + k) * n + j] += in[k * m + 1 + j];
        cl->lambda[l->row_at + k] -= in[k * m];
        cl->reference[l->row_at + k] += in[l->c * m + k];
    }
    w->flop += (uint64_t)(l->c * (m + 1));
}

/* solve: lambda from what was collected: S lambda = -r in the least-norm sense, since loops may be
 * redundant (physics 7.4): then lambda is not unique, but u' is. */
static void solve(struct closure *cl, struct work *w)
{
    const int n = cl->shared->nrow;
    /* S is symmetric but for rounding; the mean of both halves makes it exactly so. */
    for (int i = 0; i < n; i++)
        for (int j = 0; j < i; j++)
            cl->S[i * n + j] = cl->S[j * n + i] = (real)0.5 * (cl->S[i * n + j] + cl->S[j * n + i]);
    w->flop += (uint64_t)(n * (n - 1));
    cl->rank = least_norm_solve(n, cl->reference, cl->S, cl->lambda, cl->scratch, w);
}

/* Rank 0 gathers, solves and broadcasts lambda in ceil(log2 P) steps of 8 nrow bytes (physics 7.2).
 * S is small, with few loops: a parallel solution would cost more messages than it saves flops. */
void closure_solve(struct closure *cl, real *const *acceleration, struct work *w)
{
    const struct closure_shared *s = cl->shared;
    struct comm *comm = cl->comm;
    const int k = comm_rank(comm), n = s->nrow;
    if (k == 0) {
        memset(cl->S, 0, (size_t)(n * n) * sizeof(real));
        memset(cl->lambda, 0, (size_t)n * sizeof(real));
        memset(cl->reference, 0, (size_t)n * sizeof(real));
    }
    /* Sides in order, so that rank 0 adds in an order that no timing can change. */
    for (int side = 0; side < 2 * s->nloop; side++) {
        const int c = s->loop[side / 2].c;
        const int64_t bytes = c * (cl->m + 1) * (int64_t)sizeof(real);
        /* Rank 0 looks at every side, the others at their own. */
        if (s->owner[side] < 0 || (k != 0 && s->owner[side] != k)) continue;
        if (s->owner[side] == k) contribute(cl, side, acceleration[side], cl->contribution, w);
        work_report(comm, w);
        if (k != 0) {
            comm_send(comm, 0, TAG_CONTRIBUTE, cl->contribution, bytes);
            continue;
        }
        if (s->owner[side] != 0)
            comm_recv(comm, s->owner[side], TAG_CONTRIBUTE, cl->contribution, bytes);
        collect(cl, side, cl->contribution, w);
    }
    if (k == 0) solve(cl, w);
    work_report(comm, w);
    collective_broadcast(comm, 0, TAG_LAMBDA, cl->lambda, n * (int64_t)sizeof(real));
}
