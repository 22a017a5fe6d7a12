/* planar_loop.c - loop joints seen along the normal: constants, pose, velocity terms
 * (planar_loop.h). */
#include "dynamics/planar_loop.h"

#include "base/check.h"
#include "dynamics/planar_frame.h"

/* A constraint in the axes of its loop frame, [angular; linear]: a row of the file's or one of the
 * joint's. Both kinds as one row of six numbers. */
static void spatial_row(const struct loop_def *def, int k, quad *row)
{
    for (int j = 0; j < 6; j++) row[j] = 0;
    if (def->nrow > 0)
        for (int j = 0; j < 6; j++) row[j] = def->row[k][(j + 3) % 6];
    else row[planar_loop_direction(def->joint, k)] = 1;
}

/* Its part in the plane, for the loop frame's planar axes. False: nothing of it acts. */
static bool planar_row(const struct loop_def *def, int k, const quad *rows, real *w)
{
    quad full[6], part[3] = {0}, square = 0;
    spatial_row(def, k, full);
    /* The angular part along the normal, the linear one along x and y. */
    for (int j = 0; j < 3; j++) {
        part[0] += rows[j] * full[j];
        part[1] += rows[3 + j] * full[3 + j];
        part[2] += rows[6 + j] * full[3 + j];
    }
    for (int j = 0; j < 3; j++) {
        square += part[j] * part[j];
        w[j] = (real)part[j];
    }
    /* A constraint out of the plane is met by every motion in it. */
    return square > 1e-18Q;
}

/* Rounded once, as all constants. */
static void to_transform(const quad *outer, const quad *inner, const struct frame *f,
                         struct xform *x)
{
    quad y[4];
    planar_placement(outer, inner, f, y);
    *x = (struct xform){(real)y[0], (real)y[1], {(real)y[2], (real)y[3]}};
}

/* Loop i's constants; the model's numbers of its acting constraints into `place`. */
static void loop_make(const struct model *m, int i, const quad *normal, struct loop *l, int *place)
{
    const struct loop_def *def = &m->loop[i];
    const int nrow = m->row_at[i + 1] - m->row_at[i];
    quad a[9], b[9], frame[9], inner[3];
    /* Planar frames of both bodies, and one for the loop's own frame b. */
    planar_frame(m, def->body_a, normal + 3 * (def->body_a + 1), a);
    planar_frame(m, def->body_b, normal + 3 * (def->body_b + 1), b);
    planar_normal_in(&def->frame_b, b, inner);
    planar_frame(m, -1, inner, frame);
    *l = (struct loop){.body_a = def->body_a, .body_b = def->body_b, .by_rows = def->nrow > 0};
    l->alpha = (real)def->alpha;
    l->beta = (real)def->beta;
    to_transform(a, frame, &def->frame_a, &l->a);
    to_transform(b, frame, &def->frame_b, &l->b);
    for (int k = 0; k < nrow; k++)
        if (planar_row(def, k, frame, l->w + SPACE * l->c)) place[l->c++] = m->row_at[i] + k;
}

/* Constraints that do not act have no row: numbers are those of the plane. */
void loops_make(const struct model *m, struct loop *loop, int *place)
{
    struct arena *scratch = arena_create();
    struct err e;
    err_clear(&e);
    const quad *normal = planar_normals(m, 1e-3Q, scratch, &e);
    CHECK(normal);
    int n = 0;
    for (int i = 0; i < m->nloop; i++) {
        loop_make(m, i, normal, &loop[i], place + n);
        loop[i].row_at = n;
        n += loop[i].c;
    }
    arena_destroy(scratch);
}

/* By making them: whether a row acts depends on the normal. */
int loop_rows(const struct model *m)
{
    if (m->nloop == 0) return 0;
    struct arena *scratch = arena_create();
    struct loop *loop = TAKE(scratch, m->nloop, struct loop);
    loops_make(m, loop, TAKE(scratch, m->nrow, int));
    const int n = loop[m->nloop - 1].row_at + loop[m->nloop - 1].c;
    arena_destroy(scratch);
    return n;
}

/* y = r^T x. */
enum { TURN_BACK_FLOP = 6 };
/* Into the axes of r. */
static void turn_back(const struct xform *r, const real *x, real *y)
{
    const real a = r->c * x[0] + r->s * x[1], b = r->c * x[1] - r->s * x[0];
    y[0] = a;
    y[1] = b;
}

/* y = a^-1 o b. */
enum { BETWEEN_FLOP = 2 + 6 + TURN_BACK_FLOP };
/* The relative pose of two frames. */
static void between(struct xform *y, const struct xform *a, const struct xform *b)
{
    const real p[2] = {b->p[0] - a->p[0], b->p[1] - a->p[1]};
    y->c = a->c * b->c + a->s * b->s;
    y->s = a->c * b->s - a->s * b->c;
    turn_back(a, p, y->p);
}

/* gamma += sign times the centripetal acceleration of a point at p on a body that turns at the rate
 * w. */
enum { CENTRIPETAL_FLOP = 8 };
static void add_centripetal(real sign, real w, const real *p, real *gamma)
{
    gamma[1] -= sign * (w * w) * p[0];
    gamma[2] -= sign * (w * w) * p[1];
}

/* As place_rows and place_joint of loop.c, in three components. */
void loop_place(const struct loop *l, const struct xform *xa, const struct xform *xb,
                const real *va, const real *vb, struct loop_pose *p)
{
    struct xform wa, wb, rel;
    real a[SPACE], b[SPACE], relative[SPACE], error[SPACE], pa[2], pb[2];
    /* Both frames in the base's. */
    xform_compose(&wa, xa, &l->a);
    xform_compose(&wb, xb, &l->b);
    between(&rel, &wa, &wb);
    if (l->by_rows) { /* axes of frame a, each body's own point */
        p->ta = l->a;
        between(&p->tb, xb, &wa);
        p->tb.p[0] = l->b.p[0], p->tb.p[1] = l->b.p[1];
    } else { /* frame b throughout */
        p->tb = l->b;
        between(&p->ta, xa, &wb);
    }
    /* rho of (7.1). */
    xform_motion(a, &p->ta, va);
    xform_motion(b, &p->tb, vb);
    /* Velocities of both frames, in the loop's axes; then gamma (physics 7.3). */
    for (int k = 0; k < SPACE; k++) relative[k] = b[k] - a[k];
    turn_back(&p->ta, p->ta.p, pa);
    turn_back(&p->tb, p->tb.p, pb);
    screw_zero(p->gamma);
    add_centripetal(1, b[0], pb, p->gamma);
    add_centripetal(-1, a[0], pa, p->gamma);
    /* Joints are seen from b's turning frame. */
    if (!l->by_rows) {
        const real t = a[0] + a[0] + relative[0];
        p->gamma[1] += t * relative[2];
        p->gamma[2] -= t * relative[1];
    }
    /* The sine stands for the angle: exact where the constraint is met. */
    error[0] = rel.s;
    if (l->by_rows) error[1] = rel.p[0], error[2] = rel.p[1];
    else turn_back(&rel, rel.p, error + 1);
    p->c = l->c;
    for (int k = 0; k < l->c; k++) {
        const real *w = l->w + SPACE * k;
        screw_copy(p->w + SPACE * k, w);
        /* (7.2): 2 alpha W^T rho + beta^2 g. */
        p->stabilise[k] =
            2 * l->alpha * screw_dot(w, relative) + l->beta * l->beta * screw_dot(w, error);
    }
}

/* The sums of what loop_place calls. */
int loop_place_flops(const struct loop *l)
{
    return 2 * XFORM_COMPOSE_FLOP + 2 * BETWEEN_FLOP + 2 * XFORM_MOTION_FLOP + SCREW_ADD_FLOP +
           2 * TURN_BACK_FLOP + 2 * CENTRIPETAL_FLOP + (l->by_rows ? 0 : 6 + TURN_BACK_FLOP) +
           l->c * (2 * SCREW_DOT_FLOP + 5);
}

/* As in space. */
void loop_column(const struct loop_pose *p, bool side_b, real *out)
{
    for (int k = 0; k < p->c; k++) {
        xform_force(out + SPACE * k, side_b ? &p->tb : &p->ta, p->w + SPACE * k);
        for (int j = 0; j < SPACE && !side_b; j++) out[SPACE * k + j] = -out[SPACE * k + j];
    }
}
