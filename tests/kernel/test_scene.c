/* test_scene.c - scenes that runs share and forget, bodies that become part of others, and what
 * many evaluations have seen, each against a plain model of it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "dynamics/system.h"
#include "evaluation.h"
#include "kernel/motion.h"
#include "kernel/omission.h"
#include "kernel/scene.h"

static double relative_error(int n, const double *x, const double *y)
{
    double difference = 0, size = 0;
    for (int i = 0; i < n; i++) {
        difference = fmax(difference, fabs(x[i] - y[i]));
        size = fmax(size, fabs(y[i]));
    }
    return size > 0 ? difference / size : difference;
}

/* --- the cache --- */

static struct scene *taken(struct program_cache *cache, const struct run_spec *spec, unsigned keep)
{
    struct err e;
    err_clear(&e);
    struct scene *s = scene_take(cache, spec, keep, NULL, &e);
    if (!s) fail_msg("%s", e.text);
    return s;
}

/* What a scene depends on makes another one; what it does not depend on takes the same again. */
static void runs_share_a_scene_where_they_may(void **state)
{
    (void)state;
    struct program_cache *cache = scene_cache_create();
    const struct run_spec spec = evaluation_spec("forward", 6, 3);
    struct scene *first = taken(cache, &spec, 0);
    struct run_spec other = spec;
    other.nrank = 6, other.kernel.solver = SOLVER_THOMAS, other.kernel.outer_refinements = 2;
    snprintf(other.kernel.name, sizeof other.kernel.name, "inverse");
    assert_ptr_equal(taken(cache, &other, 0), first);
    other = spec, other.model.seed++;
    struct scene *seed = taken(cache, &other, 0);
    assert_ptr_not_equal(seed, first);
    other = spec, other.kernel.steps = 3;
    struct scene *moving = taken(cache, &other, 0);
    assert_true(moving != first && moving != seed);
    assert_true(first->still && !moving->still);
    struct scene *kept = taken(cache, &spec, 1u << 30);
    assert_true(kept != first && kept != seed && kept != moving);
    /* all four are still there */
    assert_ptr_equal(taken(cache, &other, 0), moving);
    assert_ptr_equal(taken(cache, &spec, 1u << 30), kept);
    assert_ptr_equal(taken(cache, &spec, 0), first);
    /* whoever keeps scenes apart shares none */
    struct scene *alone = taken(cache, &spec, KEEP_SCENES);
    assert_ptr_not_equal(taken(cache, &spec, KEEP_SCENES), alone);
    scene_cache_destroy(cache);
    scene_cache_destroy(NULL);
}

/* Whether bodies could merge for P counts, not whether they did: a loop whose two bodies would
 * become one is in the way. */
static void a_loop_in_the_way_of_merging_costs_no_scene(void **state)
{
    (void)state;
    struct program_cache *cache = scene_cache_create();
    struct run_spec spec = evaluation_spec("forward", 4, 1);
    spec.model.generator = MODEL_RING;
    spec.model.base = BASE_FLOATING;
    spec.model.joint = JOINT_FIXED;
    struct scene *ring = taken(cache, &spec, 0);
    assert_int_equal(ring->mergeable, 3);
    assert_int_equal(ring->fixed, 0);
    assert_ptr_equal(taken(cache, &spec, 0), ring);
    /* with more ranks than moving bodies none could */
    spec.nrank = 2;
    assert_ptr_not_equal(taken(cache, &spec, 0), ring);
    scene_cache_destroy(cache);
}

/* A few dozen scenes of which the one used longest ago goes, as a list says: an answer that has
 * been asked for is only there in a scene that was kept. */
static void the_scene_used_longest_ago_is_forgotten(void **state)
{
    (void)state;
    enum { ROOM = 32, KINDS = 48 };
    struct program_cache *cache = scene_cache_create();
    struct random r = random_make(71, 0, 0);
    int list[ROOM + 1], n = 0, hits = 0; /* the one used last stands first */
    struct run_spec spec = evaluation_spec("forward", 2, 1);
    for (int trial = 0; trial < 1500; trial++) {
        const int kind = (int)random_below(&r, random_below(&r, 2) ? KINDS : 8);
        int at = 0;
        while (at < n && list[at] != kind) at++;
        const bool held = at < n;
        spec.model.seed = 1000 + (uint64_t)kind;
        struct scene *s = taken(cache, &spec, 0);
        if (s->inverse.asked != held) fail_msg("trial %d, kind %d", trial, kind);
        assert_true(scene_inverse(s)->found);
        if (!held) at = n < ROOM ? n++ : ROOM - 1;
        memmove(list + 1, list, sizeof *list * (size_t)at);
        list[0] = kind;
        hits += held;
    }
    assert_true(hits > 500 && hits < 1400);
    scene_cache_destroy(cache);
}

static void a_scene_that_cannot_be_built_leaves_the_others(void **state)
{
    (void)state;
    struct program_cache *cache = scene_cache_create();
    struct run_spec spec = evaluation_spec("forward", 4, 2), wrong = spec;
    struct scene *good = taken(cache, &spec, 0);
    wrong.model.generator = MODEL_URDF;
    snprintf(wrong.model.path, sizeof wrong.model.path, "/nowhere/at/all.urdf");
    struct err e;
    err_clear(&e);
    assert_null(scene_take(cache, &wrong, 0, NULL, &e));
    assert_true(e.kind != ERR_NONE && strstr(e.file, "all.urdf"));
    assert_ptr_equal(taken(cache, &spec, 0), good);
    scene_cache_destroy(cache);
}

/* Answers are computed once; those of all methods agree, and undo each other. */
static void serial_answers_are_computed_once_and_agree(void **state)
{
    (void)state;
    struct program_cache *cache = scene_cache_create();
    struct run_spec spec = evaluation_spec("forward", 9, 3);
    spec.model.axes = AXES_PARALLEL;
    struct scene *s = taken(cache, &spec, 0);
    const struct serial_answer *aba = scene_forward(s, FORWARD_ABA);
    const struct work once = aba->work;
    assert_true(aba->found && once.flop > 0);
    assert_ptr_equal(scene_forward(s, FORWARD_ABA), aba);
    assert_memory_equal(&aba->work, &once, sizeof once);
    for (int k = 0; k < FORWARD_METHODS; k++) {
        const struct serial_answer *x = scene_forward(s, (enum forward_method)k);
        assert_true(x->found);
        assert_true(relative_error(9, x->x, aba->x) < 1e-10);
        for (int j = 0; j < k; j++)
            assert_ptr_not_equal(x, scene_forward(s, (enum forward_method)j));
    }
    assert_true(relative_error(9, scene_planar_forward(s)->x, aba->x) < 1e-10);
    assert_true(relative_error(9, scene_planar_inverse(s)->x, scene_inverse(s)->x) < 1e-12);
    assert_true(scene_planar_inverse(s)->work.flop < scene_inverse(s)->work.flop);
    /* inverse dynamics of the accelerations gives the joint forces back */
    double tau[9];
    memcpy(s->state->qdd, aba->x, sizeof tau);
    struct work w = {0};
    dynamics_type_of(PRECISION_DOUBLE)->inverse(s->model, s->state, s->arena, tau, &w);
    assert_true(relative_error(9, tau, s->state->tau) < 1e-10);
    scene_cache_destroy(cache);
}

/* --- bodies that become part of others --- */

/* A tree with some fixed joints; bit i of `fixed` fixes body i. */
static struct model *partly_fixed(int n, unsigned fixed, struct random *r, struct arena *a)
{
    struct err e;
    err_clear(&e);
    struct model *m = model_begin(a, NULL);
    for (int i = 0; i < n; i++) {
        struct body_def b = {.parent = i - 1 - (i > 1 ? (int)random_below(r, 2) : 0),
                             .joint = fixed >> i & 1 ? JOINT_FIXED : JOINT_REVOLUTE,
                             .axis = {0, 1, 1},
                             .placement = {{0.1, 0.2, 0, 1}, {0.3, 0, 1}},
                             .mass = 1 + i,
                             .com = {0.1, 0.2, 0.3},
                             .inertia = {1, 0.1, 0, 1, 0, 1}};
        snprintf(b.name, sizeof b.name, "b%d", i);
        assert_true(model_add_body(m, &b, &e) >= 0);
    }
    m->gravity[2] = -9.81;
    if (!model_finish(m, false, &e)) fail_msg("%s", e.text);
    return m;
}

/* As many merge as was foretold; what is left fits the ranks, weighs as much and moves as
 * before. */
static void merged_bodies_weigh_and_move_as_before(void **state)
{
    (void)state;
    struct random r = random_make(72, 0, 0);
    int merged = 0, none = 0;
    for (int trial = 0; trial < 300; trial++) {
        struct arena *a = arena_create();
        const int n = 1 + (int)random_below(&r, 9), nrank = 1 + (int)random_below(&r, (uint64_t)n);
        const unsigned fixed = (unsigned)random_below(&r, 1u << n);
        struct model *m = partly_fixed(n, fixed, &r, a), *less = m;
        struct state *s = state_take(m, a), *small = s;
        for (int i = 0; i < m->nu; i++) {
            s->q[i] = random_uniform(&r, -1, 1), s->qd[i] = random_uniform(&r, -1, 1);
            s->tau[i] = random_uniform(&r, -1, 1);
        }
        const int movable = omission_movable(m);
        assert_int_equal(movable, n - __builtin_popcount(fixed));
        const int foretold = omission_mergeable(nrank, 0, n, movable);
        const int did = omission_scene(nrank, 0, &less, &small, a);
        assert_int_equal(did, foretold);
        assert_int_equal(less->nbody, n - did);
        assert_true(less->nbody >= nrank);
        assert_int_equal(less->nu, m->nu);
        if (did == 0) assert_true(less == m && small == s);
        merged += did > 0, none += did == 0;
        if (m->nu > 0) {
            double x[9], y[9];
            struct work w = {0};
            const struct dynamics_type *d = dynamics_type_of(PRECISION_DOUBLE);
            system_prepare(m), system_prepare(less);
            assert_true(d->forward(m, s, FORWARD_ABA, a, x, NULL, NULL, &w));
            assert_true(d->forward(less, small, FORWARD_ABA, a, y, NULL, NULL, &w));
            assert_true(relative_error(m->nu, y, x) < 1e-10);
        }
        arena_destroy(a);
    }
    assert_true(merged > 40 && none > 40);
}

/* --- what evaluations have seen --- */

/* The largest violation over the largest scale; a number that is none, and a condition that is
 * none, stay. */
static void the_worst_of_all_evaluations_is_kept(void **state)
{
    (void)state;
    struct random r = random_make(73, 0, 0);
    for (int trial = 0; trial < 500; trial++) {
        struct motion_seen seen = {0};
        double violation = 0, scale = 0, condition = 0;
        bool lost = false, blind = false;
        for (int k = 0; k < 8; k++) {
            const bool none = random_below(&r, 24) == 0, no_condition = random_below(&r, 24) == 0;
            const double residual = none ? NAN : random_uniform(&r, 0, 1),
                         size = pow(10, random_uniform(&r, -6, 6)),
                         at = no_condition ? NAN : random_uniform(&r, 0, 100);
            motion_watch(&seen, residual, size, at);
            lost = lost || none, blind = blind || no_condition;
            violation = fmax(violation, residual * size), scale = fmax(scale, size);
            condition = fmax(condition, at);
            assert_true(seen.any);
            if (blind) assert_true(isnan(seen.condition));
            else assert_true(seen.condition == condition);
            if (lost) assert_true(isnan(seen.residual));
            else assert_true(fabs(seen.residual - violation / scale) <= 1e-14 * seen.residual);
        }
    }
    /* at rest: no term at all, the residual itself is told */
    struct motion_seen seen = {0};
    motion_watch(&seen, 0.25, 0, 3);
    assert_true(seen.residual == 0.25 && seen.scale == 0 && seen.condition == 3);
    motion_watch(&seen, 0.25, 0, 1);
    assert_true(seen.residual == 0.25);
    motion_watch(&seen, 1e-3, 8, 2);
    assert_true(seen.residual == 1e-3 && seen.scale == 8 && seen.condition == 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(runs_share_a_scene_where_they_may),
        cmocka_unit_test(a_loop_in_the_way_of_merging_costs_no_scene),
        cmocka_unit_test(the_scene_used_longest_ago_is_forgotten),
        cmocka_unit_test(a_scene_that_cannot_be_built_leaves_the_others),
        cmocka_unit_test(serial_answers_are_computed_once_and_agree),
        cmocka_unit_test(merged_bodies_weigh_and_move_as_before),
        cmocka_unit_test(the_worst_of_all_evaluations_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
