/* test_lump.c - frames, and bodies on fixed joints made one: mass, moments, loads and loops of
 * random trees are those of their parts, worked out by quaternions and by points. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "base/random.h"
#include "model/lump.h"
#include "model/pose.h"

static void cross(const double *a, const double *b, double *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* v + 2 w (u x v) + 2 u x (u x v) of the quaternion (u, w), of any length. */
static void turn(const double quat[4], const double *v, double *out)
{
    double t[3], tt[3], length = 0;
    for (int i = 0; i < 4; i++) length += quat[i] * quat[i];
    cross(quat, v, t);
    cross(quat, t, tt);
    for (int i = 0; i < 3; i++) out[i] = v[i] + 2 * (quat[3] * t[i] + tt[i]) / length;
}

static void place(const struct frame *f, const double *x, double *y)
{
    double t[3];
    turn(f->quat, x, t);
    for (int i = 0; i < 3; i++) y[i] = t[i] + f->p[i];
}

static void near(const double *a, const double *b, int n, double tolerance)
{
    for (int i = 0; i < n; i++)
        if (!(fabs(a[i] - b[i]) <= tolerance)) fail_msg("%d: %.17g, not %.17g", i, a[i], b[i]);
}

static struct frame random_frame(struct random *r)
{
    struct frame f;
    pose_quaternion(r, f.quat);
    for (int i = 0; i < 3; i++) f.p[i] = random_uniform(r, -2, 2);
    return f;
}

static void frames_turn_and_compose(void **state)
{
    (void)state;
    struct random r = random_make(3, 0, 0);
    for (int round = 0; round < 200; round++) {
        struct frame a = random_frame(&r), b = random_frame(&r);
        const double x[3] = {random_normal(&r), random_normal(&r), random_normal(&r)};
        double y[3], z[3], inner[3];
        frame_turn(&a, x, y);
        turn(a.quat, x, z);
        near(y, z, 3, 1e-14);
        place(&b, x, inner);
        place(&a, inner, z);
        struct frame both = frame_compose(&a, &b);
        frame_apply(&both, x, y);
        near(y, z, 3, 1e-13);
        double same[3] = {x[0], x[1], x[2]}; /* in place */
        frame_apply(&b, same, same);
        near(same, inner, 3, 1e-14);
    }
    /* a quarter turn about z, then a step along x: by hand */
    const double h = sqrt(0.5), x[3] = {1, 2, 3}, expected[3] = {-1, 1, 3};
    struct frame f = {{0, 0, h, h}, {1, 0, 0}};
    double y[3];
    frame_apply(&f, x, y);
    near(y, expected, 3, 1e-15);
}

static void any_quaternion_becomes_one_of_length_1(void **state)
{
    (void)state;
    struct frame f = {{0, 0, 0, 0}, {7, 8, 9}};
    frame_normalise(&f);
    const double identity[4] = {0, 0, 0, 1}, third[4] = {0, 0.6, 0, -0.8};
    near(f.quat, identity, 4, 0);
    assert_true(f.p[0] == 7 && f.p[2] == 9);
    f = (struct frame){{0, 3e5, 0, -4e5}, {0}};
    frame_normalise(&f);
    near(f.quat, third, 4, 1e-15);
}

/* A body that points could make: seven unlike points, so that nothing is symmetric. */
static void random_body(struct random *r, struct body_def *b)
{
    double p[7][3], m[7];
    b->mass = 0;
    memset(b->com, 0, sizeof b->com);
    memset(b->inertia, 0, sizeof b->inertia);
    for (int k = 0; k < 7; k++) {
        m[k] = random_uniform(r, 0.1, 2);
        b->mass += m[k];
        for (int i = 0; i < 3; i++) p[k][i] = random_uniform(r, -1, 1);
    }
    for (int k = 0; k < 7; k++)
        for (int i = 0; i < 3; i++) b->com[i] += m[k] * p[k][i] / b->mass;
    for (int k = 0; k < 7; k++) {
        double d[3], square = 0;
        for (int i = 0; i < 3; i++) d[i] = p[k][i] - b->com[i], square += d[i] * d[i];
        for (int i = 0, n = 0; i < 3; i++)
            for (int j = i; j < 3; j++, n++)
                b->inertia[n] += m[k] * ((i == j ? square : 0) - d[i] * d[j]);
    }
}

/* Mass, first moment and the tensor about the world's origin of bodies whose frames are known. */
struct moments {
    double mass, first[3], tensor[6];
};

static void add_moments(struct moments *x, const struct body_def *b, const struct frame *at)
{
    double com[3], column[3][3], square = 0;
    place(at, b->com, com);
    for (int i = 0; i < 3; i++) square += com[i] * com[i];
    /* R J R^T by the images of the axes */
    const double *j = b->inertia;
    const double full[3][3] = {{j[0], j[1], j[2]}, {j[1], j[3], j[4]}, {j[2], j[4], j[5]}};
    for (int k = 0; k < 3; k++) {
        const double unit[3] = {k == 0, k == 1, k == 2};
        turn(at->quat, unit, column[k]);
    }
    x->mass += b->mass;
    for (int i = 0; i < 3; i++) x->first[i] += b->mass * com[i];
    for (int i = 0, n = 0; i < 3; i++)
        for (int l = i; l < 3; l++, n++) {
            double sum = b->mass * ((i == l ? square : 0) - com[i] * com[l]);
            for (int p = 0; p < 3; p++)
                for (int q = 0; q < 3; q++) sum += column[p][i] * full[p][q] * column[q][l];
            x->tensor[n] += sum;
        }
}

/* Frames of all bodies at q = 0 in the world. */
static void world_frames(const struct model *m, struct frame *at)
{
    for (int i = 0; i < m->nbody; i++) {
        const struct frame *own = &m->body[i].placement;
        const int parent = m->body[i].parent;
        at[i] = *own;
        if (parent < 0) continue;
        place(&at[parent], own->p, at[i].p);
        const double *a = at[parent].quat, *b = own->quat;
        double v[3];
        cross(a, b, v);
        for (int k = 0; k < 3; k++) at[i].quat[k] = a[3] * b[k] + b[3] * a[k] + v[k];
        at[i].quat[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
    }
}

enum { MOST = 24 };

static struct model *random_tree(struct random *r, int n, struct err *e)
{
    struct model *m = model_begin(arena, NULL);
    m->gravity[1] = -3;
    m->metre = 0.5, m->kilogram = 4, m->second = 2;
    for (int i = 0; i < n; i++) {
        struct body_def b = {.parent = (int)random_below(r, (uint64_t)i + 1) - 1,
                             .axis = {0, 0, 1},
                             .joint = i > 0 && random_below(r, 2) ? JOINT_FIXED
                                      : random_below(r, 2)        ? JOINT_REVOLUTE
                                                                  : JOINT_SPHERICAL};
        random_body(r, &b);
        b.placement = random_frame(r);
        for (int k = 0; k < 4; k++) b.placement.quat[k] *= 3; /* any length */
        snprintf(b.name, sizeof b.name, "body%d", i);
        assert_int_equal(model_add_body(m, &b, e), i);
    }
    return m;
}

static void check_tree(const struct model *m, const struct lumped *l)
{
    struct frame old[MOST], new[MOST];
    struct moments before[MOST] = {0}, after[MOST] = {0};
    int movable = 0;
    world_frames(m, old);
    world_frames(l->model, new);
    assert_true(l->model->gravity[1] == -3 && l->model->metre == 0.5);
    assert_true(l->model->kilogram == 4 && l->model->second == 2);
    for (int i = 0; i < m->nbody; i++) {
        if (m->body[i].joint != JOINT_FIXED) {
            /* bodies that move keep their order, name and frame */
            assert_int_equal(l->body[i], movable);
            assert_string_equal(l->model->body[movable++].name, m->body[i].name);
        } else {
            const int parent = m->body[i].parent;
            assert_int_equal(l->body[i], parent < 0 ? -1 : l->body[parent]);
        }
        if (l->body[i] < 0) continue;
        add_moments(&before[l->body[i]], &m->body[i], &old[i]);
        /* the old body's origin, seen from the new one's frame */
        double p[3];
        place(&new[l->body[i]], l->at[i].p, p);
        near(p, old[i].p, 3, 1e-11);
    }
    assert_int_equal(l->model->nbody, movable);
    for (int i = 0; i < movable; i++) {
        assert_int_not_equal(l->model->body[i].joint, JOINT_FIXED);
        add_moments(&after[i], &l->model->body[i], &new[i]);
        near(&after[i].mass, &before[i].mass, 1, 1e-11);
        near(after[i].first, before[i].first, 3, 1e-9);
        near(after[i].tensor, before[i].tensor, 6, 1e-7);
    }
}

/* Forces and moments about the world's origin of all old bodies that are part of a new one. */
static void check_loads(const struct model *m, const struct lumped *l, struct random *r)
{
    struct frame old[MOST], new[MOST];
    double sum[MOST][6] = {{0}};
    struct state *s = state_take(m, arena);
    const struct state *none = lump_state(l, m, s, arena);
    assert_null(none->fext);
    double *fext = state_fext_need(s, m, arena);
    for (int i = 0; i < 6 * m->nbody; i++) fext[i] = random_normal(r);
    const struct state *t = lump_state(l, m, s, arena);
    assert_ptr_equal(t->q, s->q);
    world_frames(m, old);
    world_frames(l->model, new);
    for (int i = 0; i < m->nbody; i++) {
        double f[3], n[3], pf[3];
        if (l->body[i] < 0) continue;
        turn(old[i].quat, fext + 6 * i, f);
        turn(old[i].quat, fext + 6 * i + 3, n);
        cross(old[i].p, f, pf);
        for (int k = 0; k < 3; k++)
            sum[l->body[i]][k] += f[k], sum[l->body[i]][3 + k] += n[k] + pf[k];
    }
    for (int i = 0; i < l->model->nbody; i++) {
        double world[6], pf[3];
        turn(new[i].quat, t->fext + 6 * i, world);
        turn(new[i].quat, t->fext + 6 * i + 3, world + 3);
        cross(new[i].p, world, pf);
        for (int k = 0; k < 3; k++) world[3 + k] += pf[k];
        near(world, sum[i], 6, 1e-9);
    }
}

static void random_trees_keep_their_moments_and_loads(void **state)
{
    (void)state;
    struct random r = random_make(8, 0, 0);
    struct err e;
    err_clear(&e);
    for (int round = 0; round < 60; round++) {
        struct lumped l;
        struct model *m = random_tree(&r, 1 + (int)random_below(&r, MOST), &e);
        assert_true(model_finish(m, false, &e));
        if (!lump_fixed(m, false, arena, &l, &e)) fail_msg("%s", e.text);
        check_tree(m, &l);
        check_loads(m, &l, &r);
    }
}

static struct body_def unit_body(int parent, enum model_joint joint)
{
    return (struct body_def){.parent = parent,
                             .joint = joint,
                             .axis = {0, 0, 1},
                             .mass = 1,
                             .inertia = {1, 0, 0, 1, 0, 1},
                             .placement = {.p = {1, 0, 0}}};
}

static void what_is_fixed_to_the_base_vanishes(void **state)
{
    (void)state;
    struct err e;
    struct lumped l;
    err_clear(&e);
    struct model *m = model_begin(arena, NULL);
    struct body_def base = unit_body(-1, JOINT_FIXED), arm = unit_body(0, JOINT_REVOLUTE);
    model_add_body(m, &base, &e);
    assert_true(model_finish(m, false, &e));
    assert_true(lump_fixed(m, false, arena, &l, &e));
    assert_null(l.model); /* nothing can move */
    assert_int_equal(l.body[0], -1);
    m = model_begin(arena, NULL);
    model_add_body(m, &base, &e);
    model_add_body(m, &arm, &e);
    assert_true(model_finish(m, false, &e));
    assert_true(lump_fixed(m, false, arena, &l, &e));
    assert_int_equal(l.model->nbody, 1);
    assert_int_equal(l.model->body[0].parent, -1);
    assert_true(l.model->body[0].placement.p[0] == 2 && l.model->body[0].mass == 1);
}

/* Two rods of hand: masses 1 and 3, centres 4 apart, reduced mass 3/4: 0.75 * 16 = 12. */
static void two_bodies_by_hand(void **state)
{
    (void)state;
    struct err e;
    struct lumped l;
    err_clear(&e);
    struct model *m = model_begin(arena, NULL);
    struct body_def arm = unit_body(-1, JOINT_REVOLUTE), hand = unit_body(0, JOINT_FIXED);
    hand.mass = 3;
    hand.placement.p[0] = 4;
    model_add_body(m, &arm, &e);
    model_add_body(m, &hand, &e);
    assert_true(model_finish(m, false, &e) && lump_fixed(m, false, arena, &l, &e));
    const struct body_def *b = &l.model->body[0];
    const double com[3] = {3, 0, 0}, inertia[6] = {2, 0, 0, 14, 0, 14};
    near(b->com, com, 3, 1e-14);
    near(b->inertia, inertia, 6, 1e-13);
    assert_true(b->mass == 4);
    /* frames without mass change nothing, where they are allowed */
    m = model_begin(arena, NULL);
    hand.mass = 0;
    memset(hand.inertia, 0, sizeof hand.inertia);
    model_add_body(m, &arm, &e);
    model_add_body(m, &hand, &e);
    assert_true(model_finish(m, true, &e) && lump_fixed(m, false, arena, &l, &e));
    assert_true(l.model->body[0].mass == 1 && l.model->body[0].com[0] == 0);
    assert_true(l.model->body[0].inertia[3] == 1);
    /* a body that has no mass alone is refused in the lumped model, too */
    m = model_begin(arena, NULL);
    hand.joint = JOINT_REVOLUTE;
    model_add_body(m, &arm, &e);
    model_add_body(m, &hand, &e);
    assert_true(model_finish(m, true, &e));
    assert_false(lump_fixed(m, false, arena, &l, &e));
    assert_int_equal(e.kind, ERR_DATA);
}

static void loops_keep_their_frames_in_space(void **state)
{
    (void)state;
    struct random r = random_make(12, 0, 0);
    struct err e;
    err_clear(&e);
    for (int round = 0; round < 20; round++) {
        struct lumped l;
        struct frame old[MOST], new[MOST];
        struct model *m = random_tree(&r, MOST, &e);
        struct loop_def loop = {.body_a = -1, .joint = JOINT_SPHERICAL, .alpha = 2, .beta = 3};
        loop.frame_a = random_frame(&r), loop.frame_b = random_frame(&r);
        loop.frame_b.quat[0] = 0, loop.frame_b.quat[1] = 0;
        loop.body_b = MOST - 1;
        if (m->body[MOST - 1].joint == JOINT_FIXED) m->body[MOST - 1].joint = JOINT_SPHERICAL;
        assert_int_equal(model_add_loop(m, &loop, &e), 0);
        loop.body_a = MOST - 2;
        assert_int_equal(model_add_loop(m, &loop, &e), 1);
        assert_true(model_finish(m, false, &e));
        if (!lump_fixed(m, false, arena, &l, &e)) fail_msg("%s", e.text);
        world_frames(m, old);
        world_frames(l.model, new);
        for (int k = 0; k < 2; k++) {
            const struct loop_def *a = &m->loop[k], *b = &l.model->loop[k];
            double from[3], to[3];
            assert_true(b->alpha == 2 && b->beta == 3 && b->joint == JOINT_SPHERICAL);
            place(&old[a->body_b], a->frame_b.p, from);
            place(&new[b->body_b], b->frame_b.p, to);
            near(to, from, 3, 1e-10);
            assert_int_equal(b->body_b, l.body[a->body_b]);
            assert_int_equal(b->body_a, a->body_a < 0 ? -1 : l.body[a->body_a]);
            if (a->body_a < 0 || b->body_a < 0) continue;
            place(&old[a->body_a], a->frame_a.p, from);
            place(&new[b->body_a], b->frame_a.p, to);
            near(to, from, 3, 1e-10);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_turn_and_compose),
        cmocka_unit_test(any_quaternion_becomes_one_of_length_1),
        cmocka_unit_test(random_trees_keep_their_moments_and_loads),
        cmocka_unit_test(what_is_fixed_to_the_base_vanishes),
        cmocka_unit_test(two_bodies_by_hand),
        cmocka_unit_test(loops_keep_their_frames_in_space),
    };
    return cmocka_run_group_tests(tests, make_arena, drop_arena);
}
