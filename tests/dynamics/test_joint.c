/* test_joint.c - joints against finite differences in quad precision: velocities, accelerations,
 * subspaces, steps. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "dynamics/dynamics.h"
#include "scene.h"

#if REAL_BITS != 128
#error "compile with -DREAL_BITS=128"
#endif

static real larger(real x, real y) { return x > y ? x : y; }

/* A chain of three joints of one type in a random motion. */
struct chain {
    struct scene scene;
    struct dynamics *d;
    real *q, *u, *ud;
};

static struct chain chain_of(enum model_joint joint, uint64_t seed)
{
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, 3, joint, seed);
    struct chain c = {.scene = scene_of(&spec)};
    const struct model *m = c.scene.model;
    c.d = dynamics_take(m, c.scene.a);
    c.q = TAKE(c.scene.a, m->nq, real), c.u = TAKE(c.scene.a, m->nu, real),
    c.ud = TAKE(c.scene.a, m->nu, real);
    for (int k = 0; k < m->nq; k++) c.q[k] = (real)c.scene.state->q[k];
    for (int k = 0; k < m->nu; k++)
        c.u[k] = (real)c.scene.state->qd[k], c.ud[k] = (real)c.scene.state->qdd[k];
    return c;
}

/* The motion of all bodies a time h later: q along q' = N(q) u to second order by two half-steps of
 * the midpoint. */
static void at_time(const struct chain *c, real h, struct body_motion *out)
{
    const struct model *m = c->scene.model;
    real *q = TAKE(c->scene.a, m->nq, real), *mid = TAKE(c->scene.a, m->nq, real);
    real *rate = TAKE(c->scene.a, m->nq, real);
    real *u = TAKE(c->scene.a, m->nu, real), *um = TAKE(c->scene.a, m->nu, real);
    for (int k = 0; k < m->nu; k++)
        u[k] = c->u[k] + h * c->ud[k], um[k] = c->u[k] + h / 2 * c->ud[k];
    for (int i = 0; i < m->nbody; i++) {
        const struct body *b = &c->d->body[i];
        body_qdot(b, c->q + b->q_at, c->u + b->u_at, rate + b->q_at);
        for (int k = 0; k < b->nq; k++)
            mid[b->q_at + k] = c->q[b->q_at + k] + h / 2 * rate[b->q_at + k];
        body_qdot(b, mid + b->q_at, um + b->u_at, rate + b->q_at);
        for (int k = 0; k < b->nq; k++) q[b->q_at + k] = c->q[b->q_at + k] + h * rate[b->q_at + k];
    }
    forward_kinematics(c->d, q, u, c->ud, out);
}

/* Central differences of positions are velocities, of velocities accelerations: so H, kappa, b, N
 * and X belong together. */
static void motion_is_the_derivative_of_position(void **state)
{
    (void)state;
    const real h = 1e-9Q;
    for (int joint = JOINT_FIXED + 1; joint <= JOINT_MIXED; joint++)
        for (uint64_t seed = 1; seed < 4; seed++) {
            struct chain c = chain_of((enum model_joint)joint, seed);
            struct body_motion before[3], now[3], after[3];
            at_time(&c, -h, before);
            at_time(&c, 0, now);
            at_time(&c, h, after);
            real worst = 0;
            for (int i = 0; i < 3; i++)
                for (int k = 0; k < 3; k++) {
                    const real *w = now[i].w, *r = now[i].r;
                    worst = larger(worst,
                                   fabsq((after[i].p[k] - before[i].p[k]) / (2 * h) - now[i].v[k]));
                    worst = larger(worst,
                                   fabsq((after[i].v[k] - before[i].v[k]) / (2 * h) - now[i].a[k]));
                    worst = larger(
                        worst, fabsq((after[i].w[k] - before[i].w[k]) / (2 * h) - now[i].alpha[k]));
                    /* r' = w~ r, column k */
                    for (int j = 0; j < 3; j++) {
                        int a = (j + 1) % 3, b = (j + 2) % 3;
                        real turn = w[a] * r[3 * b + k] - w[b] * r[3 * a + k];
                        worst =
                            larger(worst, fabsq((after[i].r[3 * j + k] - before[i].r[3 * j + k]) /
                                                    (2 * h) -
                                                turn));
                    }
                }
            assert_true(worst < 1e-13Q);
            scene_end(&c.scene);
        }
}

/* [H W] is orthonormal; body_subspace and body_place give the same; pick and columns the same
 * products. */
static void subspaces_are_orthonormal(void **state)
{
    (void)state;
    for (int joint = JOINT_FIXED; joint < JOINT_MIXED; joint++) {
        struct chain c = chain_of((enum model_joint)joint, 7);
        struct subspace s;
        const struct body *b = &c.d->body[1];
        struct body_pose pose;
        body_place(b, c.q + b->q_at, &pose);
        body_subspace(b, c.q + b->q_at, &s);
        assert_int_equal(s.d + s.c, 6);
        assert_int_equal(s.d, joint_nu((enum model_joint)joint));
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 6; j++) {
                real x[6], y[6];
                subspace_column(&s, i, x);
                subspace_column(&pose.s, j, y);
                assert_true(fabsq(screw_dot(x, y) - (i == j)) < 1e-32Q);
            }
        scene_end(&c.scene);
    }
}

/* Projections of a matrix equal those column by column. */
static void projection_is_the_product_with_columns(void **state)
{
    (void)state;
    for (int joint = JOINT_FIXED; joint < JOINT_MIXED; joint++) {
        struct chain c = chain_of((enum model_joint)joint, 2);
        const struct body *b = &c.d->body[1];
        struct subspace s;
        real m[36], out[36], x[6], y[6], t[6];
        body_subspace(b, c.q + b->q_at, &s);
        for (int k = 0; k < 36; k++) m[k] = (real)(k * k % 17) - 5;
        for (int half = 0; half < 2; half++) {
            int n = half ? s.c : s.d, at = half ? s.d : 0;
            subspace_project(&s, half, m, &s, half, out);
            for (int i = 0; i < n; i++)
                for (int j = 0; j < n; j++) {
                    subspace_column(&s, at + i, x);
                    subspace_column(&s, at + j, y);
                    for (int k = 0; k < 6; k++) t[k] = screw_dot(m + 6 * k, y);
                    assert_true(fabsq(screw_dot(x, t) - out[n * i + j]) < 1e-30Q);
                }
        }
        scene_end(&c.scene);
    }
}

/* body_step moves along q' to first order and keeps quaternions normalised; pure rotations are
 * exact. */
static void steps_follow_the_group(void **state)
{
    (void)state;
    const real h = 1e-8Q;
    for (int joint = JOINT_FIXED + 1; joint < JOINT_MIXED; joint++) {
        struct chain c = chain_of((enum model_joint)joint, 3);
        const struct body *b = &c.d->body[0];
        real q[7], rate[7], length = 0, norm = 0;
        int at = joint == JOINT_FLOATING ? 3 : 0;
        for (int k = 0; k < 4 && b->nq >= 4; k++) norm += c.q[at + k] * c.q[at + k];
        /* the scene's is rounded to double */
        for (int k = 0; k < 4 && b->nq >= 4; k++) c.q[at + k] /= sqrtq(norm);
        body_qdot(b, c.q, c.u, rate);
        for (int k = 0; k < b->nq; k++) q[k] = c.q[k];
        body_step(b, q, c.u, h);
        for (int k = 0; k < b->nq; k++) assert_true(fabsq((q[k] - c.q[k]) / h - rate[k]) < 1e-6Q);
        for (int k = 0; k < 4 && b->nq >= 4; k++) length += q[at + k] * q[at + k];
        assert_true(b->nq < 4 || fabsq(length - 1) < 1e-32Q);
        scene_end(&c.scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(motion_is_the_derivative_of_position),
        cmocka_unit_test(subspaces_are_orthonormal),
        cmocka_unit_test(projection_is_the_product_with_columns),
        cmocka_unit_test(steps_follow_the_group),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
