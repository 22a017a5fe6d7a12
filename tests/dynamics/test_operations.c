/* test_operations.c - every operation executes the flops that it declares beside itself; compiled
 * for both spaces. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/flop_meter.h"
#include "../support/planar_models.h"
#include "linalg/dense.h"
#include "linalg/screw.h"
#include "scene.h"
#if SPACE == 6
#include "dynamics/body.h"
#include "dynamics/loop.h"
#else
#include "dynamics/planar_body.h"
#include "dynamics/planar_loop.h"
#endif

/* What `call` executes is `declared`. */
static void compare(const char *call, const struct work *declared)
{
    const struct work done = flop_meter_stop();
    if (declared->flop != done.flop || declared->div != done.div || declared->sqrt != done.sqrt ||
        declared->trig != done.trig)
        fail_msg("%s: declared %d flop, %d div, %d sqrt, %d trig; executed %d, %d, %d, %d", call,
                 (int)declared->flop, (int)declared->div, (int)declared->sqrt, (int)declared->trig,
                 (int)done.flop, (int)done.div, (int)done.sqrt, (int)done.trig);
}

#define EXECUTES(call, ...)                                                                        \
    do {                                                                                           \
        flop_meter_start();                                                                        \
        (void)(call);                                                                              \
        compare(#call, &(struct work){.flop = __VA_ARGS__});                                       \
    } while (0)

/* x, y, z: room for any operand. */
static real x[64], y[64], z[64];

static void fill(void)
{
    for (int i = 0; i < 64; i++) x[i] = 1 + i, y[i] = 2 - (real)0.5 * i, z[i] = (real)0.25 * i;
}

static void transforms_execute_what_they_declare(void **state)
{
    (void)state;
    struct xform a, b = {.p = {1, 2}}, c = {.p = {3, 4}};
    fill();
    EXECUTES(screw_add(x, y), SCREW_ADD_FLOP);
    EXECUTES(screw_sub(x, y), SCREW_ADD_FLOP);
    EXECUTES(screw_axpy(x, 2, y), SCREW_AXPY_FLOP);
    EXECUTES(z[0] = screw_dot(x, y), SCREW_DOT_FLOP);
    EXECUTES(xform_force(x, &b, y), XFORM_FORCE_FLOP);
    EXECUTES(xform_motion(x, &b, y), XFORM_MOTION_FLOP);
    EXECUTES(xform_slide(x, &b, y), XFORM_SLIDE_FLOP);
    EXECUTES(xform_compose(&a, &b, &c), XFORM_COMPOSE_FLOP);
    EXECUTES(xform_factors(&b, x, y), 0);
}

#if SPACE == 6
static void vectors_execute_what_they_declare(void **state)
{
    (void)state;
    struct xform a, b = {.p = {1, 2, 3}};
    struct inertia i = {0}, j = {0};
    struct sym6 s = {.a = {1}}, t;
    fill();
    EXECUTES(vec3_add(x, y), VEC3_ADD_FLOP);
    EXECUTES(vec3_sub(x, y), VEC3_ADD_FLOP);
    EXECUTES(vec3_scale(x, 2, y), VEC3_SCALE_FLOP);
    EXECUTES(z[0] = vec3_dot(x, y), VEC3_DOT_FLOP);
    EXECUTES(z[0] = vec3_norm(x), VEC3_DOT_FLOP, .sqrt = 1);
    EXECUTES(vec3_cross(x, y, z), VEC3_CROSS_FLOP);
    EXECUTES(vec3_cross_add(x, y, z), VEC3_CROSS_ADD_FLOP);
    EXECUTES(vec3_cross_sub(x, y, z), VEC3_CROSS_ADD_FLOP);
    EXECUTES(mat3_mul_vec(x, y, z), MAT3_VEC_FLOP);
    EXECUTES(mat3_mul_vec_transposed(x, y, z), MAT3_VEC_FLOP);
    EXECUTES(mat3_mul(x, y, z), MAT3_MUL_FLOP);
    EXECUTES(mat3_mul_transposed(x, y, z), MAT3_MUL_FLOP);
    EXECUTES(mat3_transposed_mul(x, y, z), MAT3_MUL_FLOP);
    EXECUTES(sym3_mul_vec(x, y, z), SYM3_VEC_FLOP);
    EXECUTES(sym3_rotate(x, y, z), SYM3_ROTATE_FLOP);
    EXECUTES(xform_inverse(&a, &b), MAT3_VEC_FLOP);
    EXECUTES(inertia_mul(x, &i, y), INERTIA_MUL_FLOP);
    EXECUTES(inertia_gyro(x, &i, y), INERTIA_GYRO_FLOP);
    EXECUTES(inertia_move(&j, &b, &i), INERTIA_MOVE_FLOP);
    EXECUTES(inertia_add(&j, &i), INERTIA_ADD_FLOP);
    EXECUTES(sym6_mul(x, &s, y), SYM6_MUL_FLOP);
    EXECUTES(sym6_move(&t, &b, &s), SYM6_MOVE_FLOP);
    EXECUTES(sym6_add(&t, &s), SYM6_ADD_FLOP);
}

/* The small operators add what they did to an account; general inverse and solution are charged by
 * formula. */
static void small_matrices_execute_what_they_declare(void **state)
{
    (void)state;
    struct work w;
#define ACCOUNTS(call)                                                                             \
    do {                                                                                           \
        fill();                                                                                    \
        w = (struct work){0};                                                                      \
        flop_meter_start();                                                                        \
        (void)(call);                                                                              \
        compare(#call, &w);                                                                        \
    } while (0)
    for (int c = 1; c <= 6; c++)
        for (int m = 1; m <= 6; m++) {
            real matrix[21];
            for (int i = 0; i < c; i++)
                for (int j = 0; j <= i; j++) matrix[packed_index(i, j)] = i == j ? 10 : 1;
            ACCOUNTS(dense_factor(c, matrix, matrix, &w));
            assert_int_equal(w.flop + w.div, dense_factor_flops(c));
            ACCOUNTS(dense_forward(c, m, matrix, x, &w));
            ACCOUNTS(dense_scale(c, m, matrix, x, &w));
            ACCOUNTS(dense_backward(c, m, matrix, x, &w));
            ACCOUNTS(dense_solve(c, m, matrix, x, &w));
            assert_int_equal(w.flop, 2 * dense_triangular_flops(c, m) - c * m);
            for (int k = 1; k <= 6; k++) {
                ACCOUNTS(dense_product(c, m, k, x, y, z, &w));
                assert_int_equal(w.flop, dense_product_flops(c, m, k));
                ACCOUNTS(dense_product_tn(c, m, k, x, y, z, &w));
            }
            ACCOUNTS(dense_subtract(c * m, x, y, &w));
        }
}
#endif

/* The local computations of a body at q, moving with u. */
static void check_body(const struct body *b, const real *q, const real *u)
{
    const struct joint_cost *c = body_cost(b);
    struct body_pose pose;
    real own[8], force[6] = {1, 2, 3, 4, 5, 6};
    fill();
    for (int k = 0; k < b->nq; k++) own[k] = q[k];
    EXECUTES(body_place(b, q, &pose), (uint64_t)c->place, .div = (uint64_t)c->place_div,
             .trig = (uint64_t)c->place_trig);
    EXECUTES(body_rate(&pose, u, x), (uint64_t)c->rate);
    EXECUTES(body_bias(b, &pose, y, x, u, z), (uint64_t)c->bias);
    EXECUTES(subspace_h(&pose.s, u, x), (uint64_t)c->h);
    EXECUTES(subspace_w(&pose.s, y, x), (uint64_t)c->w);
    EXECUTES(subspace_h_transposed(&pose.s, x, y), (uint64_t)c->h_transposed);
    EXECUTES(subspace_w_transposed(&pose.s, x, y), (uint64_t)c->w_transposed);
    EXECUTES(body_gyro(b, y, x), BODY_GYRO_FLOP);
    EXECUTES(body_force(b, y, x), BODY_FORCE_FLOP);
    EXECUTES(body_accelerate(b, y, x), BODY_ACCELERATE_FLOP);
    EXECUTES(body_load(b, (const double[6]){1, 2, 3, 4, 5, 6}, force), body_load_flops(b));
    EXECUTES(body_spring(b, q, u, y), (uint64_t)(b->has_spring ? BODY_SPRING_FLOP : 0));
    EXECUTES(body_qdot(b, q, u, x), c->qdot.flop, .div = c->qdot.div, .trig = c->qdot.trig);
    EXECUTES(body_step(b, own, u, (real)0.1), c->step.flop, .div = c->step.div,
             .sqrt = c->step.sqrt, .trig = c->step.trig);
#if SPACE == 6
    EXECUTES(subspace_project(&pose.s, false, x, &pose.s, false, y), (uint64_t)c->hh);
    EXECUTES(subspace_project(&pose.s, false, x, &pose.s, true, y), (uint64_t)c->hw);
    EXECUTES(subspace_project(&pose.s, true, x, &pose.s, true, y), (uint64_t)c->ww);
#endif
}

/* All bodies of a system, in a state of it. */
static void check_bodies(const struct model *m, const struct state *s, struct arena *a)
{
    const struct body *body = bodies_make(m, a);
    real q[8], u[6];
    for (int i = 0; i < m->nbody; i++) {
        for (int k = 0; k < body[i].nq; k++) q[k] = (real)s->q[body[i].q_at + k];
        for (int k = 0; k < body[i].d; k++) u[k] = (real)s->qd[body[i].u_at + k];
        check_body(&body[i], q, u);
    }
}

static void bodies_execute_what_they_declare(void **state)
{
    (void)state;
    for (int n = 0; n < 48; n++) {
#if SPACE == 6
        struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, 4, n % JOINT_MIXED, (uint64_t)n);
        if (n % 2) spec.stiffness = 1;
        struct scene s = scene_of(&spec);
        check_bodies(s.model, s.state, s.a);
        scene_end(&s);
#else
        const struct planar_options o = {
            .n = 4, .joint = JOINT_MIXED, .springs = n % 2, .seed = (uint64_t)n};
        struct arena *a = arena_create();
        const struct model *m = planar_model(&o, a);
        check_bodies(m, planar_state(&o, m, a), a);
        arena_destroy(a);
#endif
    }
}

#if SPACE == 6
static void bodies_share_what_is_alike(void **state)
{
    enum { OF_RODS = 8 };
    (void)state;
    /* Rods of one kind on axes that are twisted against each other. */
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, OF_RODS, JOINT_REVOLUTE, 1);
    spec.inertia = INERTIA_UNIFORM;
    struct scene s = scene_of(&spec);
    const struct body *b = bodies_make(s.model, s.a);
    for (int i = 1; i < OF_RODS; i++) {
        assert_memory_not_equal(&b[i].tree, &b[0].tree, sizeof b->tree);
        assert_ptr_equal(b[i].mass, b[0].mass);
        assert_ptr_equal(b[i].details, b[0].details);
    }
    scene_end(&s);
    spec.inertia = INERTIA_RANDOM;
    spec.stiffness = 1; /* springs rest where the scene starts */
    s = scene_of(&spec);
    b = bodies_make(s.model, s.a);
    for (int i = 1; i < OF_RODS; i++) {
        assert_ptr_not_equal(b[i].mass, b[i - 1].mass);
        assert_ptr_not_equal(b[i].details, b[i - 1].details);
        assert_true(b[i].mass->inertia.m == (real)s.model->body[i].mass);
        assert_true(b[i].details->spring.rest == (real)s.model->body[i].rest);
    }
    scene_end(&s);
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transforms_execute_what_they_declare),
#if SPACE == 6
        cmocka_unit_test(vectors_execute_what_they_declare),
        cmocka_unit_test(small_matrices_execute_what_they_declare),
#endif
        cmocka_unit_test(bodies_execute_what_they_declare),
#if SPACE == 6
        cmocka_unit_test(bodies_share_what_is_alike),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
