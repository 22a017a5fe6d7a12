/* test_frames.c - frames and directions in quad precision: orthonormal, right-handed, and the same
 * place in the plane as in space. */
#undef REAL_BITS
#define REAL_BITS 128
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "../support/planar_models.h"
#include "base/random.h"
#include "dynamics/body_constants.h"
#include "dynamics/planar_frame.h"

static quad size_of(quad x) { return x < 0 ? -x : x; }

static quad dot(const quad *a, const quad *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* x = R a */
static void turn(quad *x, const quad *r, const quad *a)
{
    for (int i = 0; i < 3; i++) x[i] = dot(r + 3 * i, a);
}

/* x = R^T a */
static void turn_back(quad *x, const quad *r, const quad *a)
{
    for (int i = 0; i < 3; i++) x[i] = r[i] * a[0] + r[3 + i] * a[1] + r[6 + i] * a[2];
}

static quad determinant(const quad *r)
{
    return r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) +
           r[2] * (r[3] * r[7] - r[4] * r[6]);
}

/* A rotation of space: rows orthonormal, right-handed. */
static void assert_rotation(const quad *r)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            assert_true(size_of(dot(r + 3 * i, r + 3 * j) - (i == j)) < 1e-31Q);
    assert_true(size_of(determinant(r) - 1) < 1e-31Q);
}

/* By conjugation, x' = c x c*, which is no formula of the program. */
static void rotate_by_quaternion(const double *c, const quad *a, quad *x)
{
    const quad v[3] = {c[0], c[1], c[2]}, w = c[3];
    const quad norm = dot(v, v) + w * w;
    quad t[3] = {v[1] * a[2] - v[2] * a[1], v[2] * a[0] - v[0] * a[2], v[0] * a[1] - v[1] * a[0]};
    const quad along = dot(v, a);
    quad tt[3] = {v[1] * t[2] - v[2] * t[1], v[2] * t[0] - v[0] * t[2], v[0] * t[1] - v[1] * t[0]};
    /* c (0, a) c* = (v.a) v + w^2 a + 2 w v x a + v x (v x a) */
    for (int k = 0; k < 3; k++) x[k] = (along * v[k] + w * w * a[k] + 2 * w * t[k] + tt[k]) / norm;
}

static void directions_are_unit_and_orthogonal(void **state)
{
    (void)state;
    struct random r = random_make(4, 0, 0);
    for (int trial = 0; trial < 200; trial++) {
        double from[3];
        quad n[3], t[3], any[3];
        /* of every length that a file may hold, and with small components */
        const double size = pow(10, random_uniform(&r, -300, 300));
        for (int k = 0; k < 3; k++)
            from[k] = size * random_uniform(&r, -1, 1) * (trial % 3 == k ? 1e-9 : 1);
        direction_unit(from, n);
        assert_true(size_of(dot(n, n) - 1) < 1e-32Q);
        for (int k = 0; k < 3; k++)
            assert_true(size_of(n[k] * from[(k + 1) % 3] - n[(k + 1) % 3] * from[k]) <=
                        1e-32Q * size);
        assert_true(n[trial % 3 == 0 ? 1 : 0] * from[trial % 3 == 0 ? 1 : 0] > 0);
        for (int k = 0; k < 3; k++) t[k] = n[k] * 5 + random_uniform(&r, -1, 1);
        const quad given[3] = {t[0], t[1], t[2]};
        direction_orthonormalise(t, n);
        assert_true(size_of(dot(t, n)) < 1e-30Q && size_of(dot(t, t) - 1) < 1e-32Q);
        /* in the plane of the two, on the side that was given */
        const quad m[3] = {n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2],
                           n[0] * t[1] - n[1] * t[0]};
        assert_true(size_of(dot(m, given)) < 1e-30Q && dot(t, given) > 0);
        direction_any_orthogonal(n, any);
        assert_true(size_of(dot(any, n)) < 1e-32Q && size_of(dot(any, any) - 1) < 1e-32Q);
    }
}

static void axes_have_exact_orthogonals(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++)
        for (int sign = -1; sign <= 1; sign += 2) {
            quad n[3] = {0}, t[3];
            n[k] = sign;
            direction_any_orthogonal(n, t);
            int ones = 0;
            for (int i = 0; i < 3; i++) {
                assert_true(t[i] == 0 || t[i] == 1 || t[i] == -1);
                ones += t[i] != 0;
            }
            assert_int_equal(ones, 1);
            assert_true(t[k] == 0);
        }
}

/* One body with a joint whose axes lie anyhow. */
static const struct model *one_body(struct arena *a, enum model_joint joint, struct random *r,
                                    struct body_def *b)
{
    struct err e;
    err_clear(&e);
    struct model *m = model_begin(a, NULL);
    *b = (struct body_def){.name = "b",
                           .parent = -1,
                           .joint = joint,
                           .mass = 2.5,
                           .inertia = {0.5, 0.01, -0.02, 0.6, 0.03, 0.7}};
    for (int k = 0; k < 3; k++) {
        b->axis[k] = random_uniform(r, -2, 2);
        b->com[k] = random_uniform(r, -1, 1);
        b->placement.p[k] = random_uniform(r, -1, 1);
    }
    for (int k = 0; k < 4; k++) b->placement.quat[k] = random_uniform(r, -3, 3);
    if (joint_has(joint, JOINT_TWO_AXES) || joint_has(joint, JOINT_NORMAL)) {
        b->axis2[0] = -b->axis[1], b->axis2[1] = b->axis[0];
    }
    if (joint_has(joint, JOINT_PITCH)) b->pitch = 0.2;
    if (model_add_body(m, b, &e) != 0 || !model_finish(m, false, &e)) fail_msg("%s", e.text);
    return m;
}

/* The internal frame is a rotation of the user's, its axis where the joint's is; mass, inertia and
 * place are the same thing in both. */
static void constants_are_the_body_in_other_axes(void **state)
{
    (void)state;
    struct random r = random_make(9, 0, 0);
    for (int trial = 0; trial < 110; trial++) {
        struct arena *a = arena_create();
        const enum model_joint joint = (enum model_joint)(trial % JOINT_MIXED);
        struct body_def b;
        const struct model *m = one_body(a, joint, &r, &b);
        struct body_constants c;
        body_constants_place(m, 0, &c);
        body_constants_inertia(m, 0, &c);
        assert_rotation(c.user);
        assert_rotation(c.slide);
        assert_rotation(c.tree_r);
        quad axis[3], x[3], y[3];
        direction_unit(b.axis, axis);
        const int along = joint_has(joint, JOINT_ALONG_X) ? 0 : 2;
        if (joint_has(joint, JOINT_AS_IT_LIES)) {
            /* rows: the own axes; the free directions first, a normal last */
            assert_false(c.turned);
            const quad *row = c.slide + 3 * along;
            for (int k = 0; k < 3; k++) assert_true(size_of(row[k] - axis[k]) < 1e-31Q);
        } else if (joint_has(joint, JOINT_AXIS)) {
            assert_true(c.turned);
            for (int k = 0; k < 3; k++)
                assert_true(size_of(c.user[3 * k + along] - axis[k]) < 1e-31Q);
        } else {
            assert_false(c.turned);
        }
        /* a vector of the user's axes goes into the internal ones and on to the parent as the
         * placement's quaternion turns it */
        const quad v[3] = {0.3Q, -0.7Q, 1.1Q};
        quad inside[3];
        turn_back(inside, c.user, v);
        turn(x, c.tree_r, inside);
        rotate_by_quaternion(b.placement.quat, v, y);
        for (int k = 0; k < 3; k++) {
            assert_true(size_of(x[k] - y[k]) < 1e-30Q);
            assert_true(c.tree_p[k] == b.placement.p[k]);
        }
        /* v . J v and the centre, in either axes; about the origin by the parallel-axis theorem */
        const double *j = b.inertia;
        const quad user = j[0] * v[0] * v[0] + j[3] * v[1] * v[1] + j[5] * v[2] * v[2] +
                          2 * (j[1] * v[0] * v[1] + j[2] * v[0] * v[2] + j[4] * v[1] * v[2]);
        const quad *w = inside;
#define QUADRATIC(J)                                                                               \
    ((J)[0] * w[0] * w[0] + (J)[3] * w[1] * w[1] + (J)[5] * w[2] * w[2] +                          \
     2 * ((J)[1] * w[0] * w[1] + (J)[2] * w[0] * w[2] + (J)[4] * w[1] * w[2]))
        assert_true(size_of(QUADRATIC(c.jc) - user) < 1e-30Q);
        const quad s[3] = {b.com[0], b.com[1], b.com[2]};
        const quad moved = user + b.mass * (dot(s, s) * dot(v, v) - dot(s, v) * dot(s, v));
        assert_true(size_of(QUADRATIC(c.j) - moved) < 1e-29Q);
        turn(x, c.user, c.s);
        for (int k = 0; k < 3; k++) assert_true(size_of(x[k] - s[k]) < 1e-31Q);
        for (int k = 0; k < 3; k++) assert_true(size_of(c.ms[k] - b.mass * c.s[k]) < 1e-31Q);
        assert_true(size_of(c.unit * c.unit * (1 + (quad)b.pitch * b.pitch) - 1) < 1e-32Q);
        arena_destroy(a);
    }
}

/* Phi [J, m s~; -m s~, m U] = U, the inverse of the inertia about the origin: applied to the force
 * that a motion needs it gives the motion. */
static void phi_undoes_the_inertia(void **state)
{
    (void)state;
    struct random r = random_make(5, 0, 0);
    for (int trial = 0; trial < 40; trial++) {
        struct arena *a = arena_create();
        struct body_def b;
        struct body_constants c;
        const struct model *m = one_body(a, (enum model_joint)(trial % JOINT_MIXED), &r, &b);
        body_constants_place(m, 0, &c);
        body_constants_inertia(m, 0, &c);
        quad w[3], v[3], f[3], n[3], back[6] = {0};
        for (int k = 0; k < 3; k++)
            w[k] = random_uniform(&r, -1, 1), v[k] = random_uniform(&r, -1, 1);
        /* f = m v + w x ms, n = J w + ms x v */
        const quad *s = c.ms;
        const quad ws[3] = {w[1] * s[2] - w[2] * s[1], w[2] * s[0] - w[0] * s[2],
                            w[0] * s[1] - w[1] * s[0]},
                   sv[3] = {s[1] * v[2] - s[2] * v[1], s[2] * v[0] - s[0] * v[2],
                            s[0] * v[1] - s[1] * v[0]};
        static const int at[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
        for (int k = 0; k < 3; k++) {
            f[k] = b.mass * v[k] + ws[k];
            n[k] = sv[k];
            for (int i = 0; i < 3; i++) n[k] += c.j[at[k][i]] * w[i];
        }
        /* [a b; b^T c] */
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 3; i++) {
                back[k] += c.phi_a[at[k][i]] * n[i] + c.phi_b[3 * k + i] * f[i];
                back[3 + k] += c.phi_b[3 * i + k] * n[i] + c.phi_c[at[k][i]] * f[i];
            }
        for (int k = 0; k < 3; k++)
            assert_true(size_of(back[k] - w[k]) < 1e-29Q && size_of(back[3 + k] - v[k]) < 1e-29Q);
        arena_destroy(a);
    }
}

/* ---- planar frames ---- */

/* A point of a body's plane by the planar frames, and by space. */
static void placements_in_the_plane_are_those_in_space(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 12; seed++) {
        struct arena *a = arena_create();
        struct err e;
        err_clear(&e);
        const struct planar_options o = {
            .n = 9, .tree = seed % 2, .joint = JOINT_MIXED, .seed = seed};
        const struct model *m = planar_model(&o, a);
        const quad *normal = planar_normals(m, 1e-12Q, a, &e);
        if (normal == NULL) fail_msg("%s", e.text);
        for (int i = 0; i < m->nbody; i++) {
            const struct body_def *b = &m->body[i];
            quad outer[9], inner[9], x[4], axis[3];
            planar_frame(m, b->parent, normal + 3 * (b->parent + 1), outer);
            planar_frame(m, i, normal + 3 * (i + 1), inner);
            assert_rotation(outer);
            assert_rotation(inner);
            for (int k = 0; k < 3; k++)
                assert_true(size_of(inner[k] - normal[3 * (i + 1) + k]) < 1e-31Q);
            if (b->joint == JOINT_PRISMATIC) {
                direction_unit(b->axis, axis);
                assert_true(size_of(dot(inner + 3, axis) - 1) < 1e-30Q);
            }
            planar_placement(outer, inner, &b->placement, x);
            assert_true(size_of(x[0] * x[0] + x[1] * x[1] - 1) < 1e-11Q);
            for (int corner = 0; corner < 3; corner++) {
                /* the point (px, py) of the body's plane */
                const quad px = corner == 1, py = corner == 2, at[3] = {0, px, py};
                quad in_frame[3], in_outer[3], place[3];
                turn_back(in_frame, inner, at);
                rotate_by_quaternion(b->placement.quat, in_frame, in_outer);
                for (int k = 0; k < 3; k++) in_outer[k] += b->placement.p[k];
                turn(place, outer, in_outer);
                assert_true(size_of(place[1] - (x[0] * px - x[1] * py + x[2])) < 1e-11Q);
                assert_true(size_of(place[2] - (x[1] * px + x[0] * py + x[3])) < 1e-11Q);
            }
            /* the normal of the parent's frame in the joint's: where it is turned back to, it is
             * the parent's */
            quad seen[3], again[3];
            planar_normal_in(&b->placement, outer, seen);
            rotate_by_quaternion(b->placement.quat, seen, again);
            for (int k = 0; k < 3; k++) assert_true(size_of(again[k] - outer[k]) < 1e-30Q);
        }
        arena_destroy(a);
    }
}

/* An axis that leaves the plane by more than what is allowed is told. */
static void a_tilt_is_found_at_its_tolerance(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        static const double tilt[] = {1e-9, 1e-9, 1e-5, 1e-5};
        static const double tolerance[] = {1e-8, 1e-10, 1e-4, 1e-6};
        struct arena *a = arena_create();
        struct err e;
        err_clear(&e);
        const struct planar_options o = {
            .n = 5, .joint = JOINT_REVOLUTE, .tilt = tilt[k], .seed = 3};
        const quad *normal = planar_normals(planar_model(&o, a), tolerance[k], a, &e);
        assert_int_equal(normal != NULL, k % 2 == 0);
        assert_int_equal(e.kind != ERR_NONE, k % 2 == 1);
        arena_destroy(a);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_are_unit_and_orthogonal),
        cmocka_unit_test(axes_have_exact_orthogonals),
        cmocka_unit_test(constants_are_the_body_in_other_axes),
        cmocka_unit_test(phi_undoes_the_inertia),
        cmocka_unit_test(placements_in_the_plane_are_those_in_space),
        cmocka_unit_test(a_tilt_is_found_at_its_tolerance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
