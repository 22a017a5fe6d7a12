/* test_counts.c - the declared operations of the serial algorithms are those that their source
 * executes, to the flop.
 *
 * They are the denominator of every speedup. Quad precision stands for all: the source is one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "../support/flop_meter.h"
#include "../support/planar_models.h"
#include "base/random.h"
#include "dynamics/dynamics_table.h"
#include "dynamics/integrate.h"
#include "dynamics/planar_dynamics.h"
#include "dynamics/system.h"
#include "scene.h"

/* A measurement: what was declared, until stop compares it with what was executed. */
struct account {
    struct work declared;
    const char *what;
    const struct model *model;
    const struct state *state;
    int wrong;
};

static struct work *begin(struct account *a, const char *what)
{
    a->what = what;
    a->declared = (struct work){0};
    flop_meter_start();
    return &a->declared;
}

static long difference(uint64_t x, uint64_t y) { return (long)(x - y); }

static void end(struct account *a)
{
    const struct work done = flop_meter_stop(), *w = &a->declared;
    if (w->flop == done.flop && w->div == done.div && w->sqrt == done.sqrt && w->trig == done.trig)
        return;
    a->wrong++;
    print_error(
        "%s, %d %s bodies, %s%s%s%s%s%d loops: flop %+ld of %lu, div %+ld, sqrt %+ld, trig %+ld\n",
        a->what, a->model->nbody, joint_name(a->model->body[a->model->nbody - 1].joint),
        a->model->is_chain ? "" : "tree, ", a->state->at_rest ? "at rest, " : "",
        a->state->fext ? "loads, " : "", a->model->body[0].stiffness != 0 ? "springs, " : "",
        a->model->has_phi ? "" : "no phi, ", a->model->nloop, difference(w->flop, done.flop),
        (unsigned long)done.flop, difference(w->div, done.div), difference(w->sqrt, done.sqrt),
        difference(w->trig, done.trig));
}

extern const struct dynamics_type dynamics_type_f128;

/* Every algorithm and integrator on one system; those that do not apply or break down say
 * nothing. */
static int wrong_counts(struct scene *s)
{
    const struct dynamics_type *type = &dynamics_type_f128;
    struct account a = {.model = s->model, .state = s->state};
    const int nu = s->model->nu;
    double *x = TAKE(s->a, nu, double), *mass = TAKE(s->a, size_product(nu, nu), double);
    struct forward_report report;
    type->inverse(s->model, s->state, s->a, x, begin(&a, "rnea"));
    end(&a);
    type->mass_matrix(s->model, s->state, s->a, mass, begin(&a, "mass matrix"));
    end(&a);
    for (int k = 0; k < 2 * FORWARD_METHODS; k++) {
        struct work *w = begin(&a, forward_method_name(k / 2));
        if (type->forward(s->model, s->state, k / 2, s->a, x, NULL, k % 2 ? &report : NULL, w))
            end(&a);
    }
    for (enum step_rule rule = STEP_SEMI_IMPLICIT; rule <= STEP_LINEARLY_IMPLICIT; rule++) {
        static const char *const name[] = {"semi-implicit", "kdk", "rk4", "linearly implicit"};
        struct work *w = begin(&a, name[rule]);
        if (type->advance(s->model, s->state, rule, 1e-3, 2, s->a, w)) end(&a);
    }
    return a.wrong;
}

/* The n-th of all kinds of open systems. */
static struct model_spec open_system(int n)
{
    static const enum model_generator generator[] = {MODEL_SERIAL_CHAIN, MODEL_RANDOM_TREE,
                                                     MODEL_COMB};
    struct random r = random_make((uint64_t)n, 0, 0);
    struct model_spec spec =
        spec_random(generator[random_below(&r, 3)], 1 + (int)random_below(&r, 7),
                    n % (JOINT_MIXED + 1), (uint64_t)n);
    spec.base = (enum model_base)random_below(&r, 3);
    if (spec.base == BASE_MOVING)
        for (int k = 0; k < 6; k++) spec.base_acceleration[k] = k - 2.5;
    if (random_below(&r, 3) == 0) spec.rate = 0;
    if (random_below(&r, 2)) spec.external_force = 0;
    if (random_below(&r, 3) == 0) spec.gravity[0] = spec.gravity[1] = spec.gravity[2] = 0;
    if (random_below(&r, 3) == 0) spec.stiffness = 2, spec.damping = 0.1;
    if (random_below(&r, 2)) spec.axes = AXES_PARALLEL;
    return spec;
}

static void open_systems_are_counted_to_the_flop(void **state)
{
    (void)state;
    int wrong = 0;
    for (int n = 0; n < 400; n++) {
        const struct model_spec spec = open_system(n);
        struct scene s = scene_of(&spec);
        s.state->at_rest = spec.rate == 0;
        wrong += wrong_counts(&s);
        scene_end(&s);
    }
    assert_int_equal(wrong, 0);
}

/* Trees whose branches meet again, in every closing joint and in rows. */
static struct scene closed_system(int n)
{
    static const enum model_joint closing[] = {JOINT_FIXED,       JOINT_REVOLUTE,   JOINT_PRISMATIC,
                                               JOINT_CYLINDRICAL, JOINT_SPHERICAL,  JOINT_PLANAR,
                                               JOINT_SLOT,        JOINT_POINT_PLANE};
    struct random r = random_make((uint64_t)n, 1, 0);
    struct model_spec spec = spec_random(n % 2 ? MODEL_RANDOM_TREE : MODEL_SERIAL_CHAIN, 9,
                                         n % 3 ? JOINT_SPHERICAL : JOINT_REVOLUTE, (uint64_t)n);
    spec.base = (enum model_base)random_below(&r, 3);
    if (n % 4 == 0) spec.rate = 0;
    if (n % 5 == 0) spec.external_force = 0;
    struct scene s = {.a = arena_create()};
    struct err e;
    err_clear(&e);
    struct model *tree = model_build(&spec, s.a, &e), *m = model_begin(s.a, NULL);
    for (int i = 0; i < tree->nbody; i++) {
        struct body_def body = tree->body[i];
        /* no Phi */
        if (n % 7 == 0 && i == 3) body.mass = 0, memset(body.inertia, 0, sizeof body.inertia);
        assert_true(model_add_body(m, &body, &e) >= 0);
    }
    for (int k = 0; k < 1 + n % 3; k++) {
        struct loop_def l = {
            .name = "loop", .body_a = k ? 2 : -1, .body_b = 8 - k, .joint = closing[random_below(&r,
            8)]};
        l.frame_a = (struct frame){{0.1, 0.2, -0.3, 0.9}, {0.3, 0.1, 0.2}};
        l.frame_b = (struct frame){{-0.4, 0.1, 0.5, 0.6}, {0.5, -0.1, 0.1}};
        l.alpha = l.beta = n % 2;
        if (random_below(&r, 3) == 0) l.nrow = 2, l.row[0][0] = l.row[1][4] = 1;
        assert_true(model_add_loop(m, &l, &e) >= 0);
    }
    memcpy(m->gravity, spec.gravity, sizeof spec.gravity);
    if (!model_finish(m, n % 7 == 0, &e)) fail_msg("%s", e.text);
    s.model = m;
    s.state = state_make(m, &spec, s.a);
    s.state->at_rest = spec.rate == 0;
    return s;
}

/* Putting a state back on its loops. */
static int wrong_projection(struct scene *s)
{
    struct account a = {.model = s->model, .state = s->state};
    struct dynamics *d = dynamics_take(s->model, s->a);
    real *q = TAKE(s->a, s->model->nq, real), *u = TAKE(s->a, s->model->nu, real);
    for (int k = 0; k < s->model->nq; k++) q[k] = s->state->q[k];
    for (int k = 0; k < s->model->nu; k++) u[k] = s->state->qd[k] + 0.1;
    struct work *w = begin(&a, "projection");
    if (loop_project(d, q, u, 2, w)) end(&a);
    return a.wrong;
}

static void closed_systems_are_counted_to_the_flop(void **state)
{
    (void)state;
    int wrong = 0;
    for (int n = 0; n < 60; n++) {
        struct scene s = closed_system(n);
        wrong += wrong_counts(&s) + wrong_projection(&s);
        scene_end(&s);
    }
    assert_int_equal(wrong, 0);
}

/* The serial algorithms in three components. */
static void planar_systems_are_counted_to_the_flop(void **state)
{
    (void)state;
    static const enum model_joint joint[] = {JOINT_REVOLUTE, JOINT_PRISMATIC, JOINT_PLANAR,
                                             JOINT_MIXED};
    struct account a = {0};
    for (int n = 0; n < 160; n++) {
        const struct planar_options o = {.n = 1 + n % 9,
                                         .tree = n & 8,
                                         .joint = joint[n / 16 % 4],
                                         .springs = n & 1,
                                         .loads = n & 2,
                                         .loops = n % 9 > 4 ? n / 4 % 3 : 0,
                                         .seed = (uint64_t)n};
        struct arena *arena = arena_create();
        const struct model *m = planar_model(&o, arena);
        struct state *s = planar_state(&o, m, arena);
        s->at_rest = n % 5 == 0;
        for (int k = 0; k < m->nu && s->at_rest; k++) s->qd[k] = 0;
        a.model = m, a.state = s;
        double *x = TAKE(arena, m->nu, double);
        planar_inverse(m, s, arena, x, begin(&a, "planar rnea"));
        end(&a);
        if (planar_forward(m, s, arena, x, begin(&a, "planar aba"))) end(&a);
        arena_destroy(arena);
    }
    assert_int_equal(a.wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(open_systems_are_counted_to_the_flop),
        cmocka_unit_test(closed_systems_are_counted_to_the_flop),
        cmocka_unit_test(planar_systems_are_counted_to_the_flop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
