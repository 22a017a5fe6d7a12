/* test_tree.c - parallel dynamics of trees and closed chains equals the serial algorithms; the plan
 * is sound. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>

#include "dynamics/system.h"
#include "evaluation.h"
#include "kernel/tree_plan.h"

static const enum model_generator trees[] = {MODEL_COMB, MODEL_STAR, MODEL_RANDOM_TREE,
                                             MODEL_DENDRIMER};

/* check: both answers within the given relative errors. */
static struct evaluation check(const struct run_spec *spec, double tau, double qdd)
{
    struct arena *a = arena_create();
    struct evaluation v = evaluate(spec, a);
    if (!(v.tau_error < tau && v.qdd_error < qdd))
        fail_msg("generator %d n %d P %d joint %d formulation %d: tau %.1e qdd %.1e",
                 spec->model.generator, spec->model.nbody, spec->nrank, spec->model.joint,
                 spec->kernel.formulation, v.tau_error, v.qdd_error);
    arena_destroy(a);
    return v;
}

static void every_tree_on_every_number_of_ranks(void **state)
{
    (void)state;
    for (int g = 0; g < 4; g++)
        for (int n = 2; n <= 24; n += n < 8 ? 1 : 5)
            for (int P = 1; P <= n; P++)
                for (int variant = 0; variant < 4; variant++) {
                    struct run_spec s = evaluation_spec("dynamics", n, P);
                    s.model.generator = trees[g];
                    s.model.joint = JOINT_MIXED;
                    s.model.base = variant & 2 ? BASE_FLOATING : BASE_FIXED;
                    s.model.external_force = 1;
                    s.kernel.formulation = variant & 1 ? FORMULATION_DIRECT : FORMULATION_PAPER;
                    check(&s, 1e-13, 1e-10);
                }
}

static void every_joint_in_a_tree(void **state)
{
    (void)state;
    for (int joint = 0; joint < JOINT_MIXED; joint++)
        for (int P = 1; P <= 11; P += 5) {
            struct run_spec s = evaluation_spec("dynamics", 11, P);
            s.model.generator = MODEL_RANDOM_TREE;
            s.model.joint = joint;
            check(&s, 1e-13, 1e-9);
        }
}

static void large_trees(void **state)
{
    (void)state;
    for (int g = 0; g < 4; g++)
        for (int P = 1; P <= 300; P = P * 4 + 3) {
            struct run_spec s = evaluation_spec("dynamics", 300, P);
            s.model.generator = trees[g];
            check(&s, 1e-12, 1e-9);
        }
}

static void refinement_reaches_the_last_digits(void **state)
{
    (void)state;
    for (int g = 0; g < 4; g++)
        for (int formulation = 0; formulation < 2; formulation++) {
            struct run_spec s = evaluation_spec("forward", 24, 5);
            s.model.generator = trees[g];
            s.kernel.formulation = formulation;
            s.kernel.inner_refinements = 1;
            s.kernel.outer_refinements = 1;
            check(&s, 1, 1e-13);
        }
}

static void closed_chains(void **state)
{
    (void)state;
    for (int n = 3; n <= 20; n += n < 8 ? 1 : 4)
        for (int P = 1; P <= n; P += P < 6 ? 1 : 5)
            for (int variant = 0; variant < 8; variant++) {
                struct run_spec s = evaluation_spec("dynamics", n, P);
                s.model.generator = MODEL_RING;
                s.model.base = variant & 2 ? BASE_FLOATING : BASE_FIXED;
                s.kernel.formulation = variant & 1 ? FORMULATION_DIRECT : FORMULATION_PAPER;
                s.kernel.outer_refinements = variant >> 2;
                check(&s, 1e-13, 1e-8);
            }
}

static void a_four_bar_has_three_redundant_constraints(void **state)
{
    (void)state;
    for (int P = 1; P <= 3; P++) {
        struct run_spec s = evaluation_spec("dynamics", 3, P);
        s.model.generator = MODEL_FOUR_BAR;
        const struct evaluation v = check(&s, 1e-13, 1e-10);
        assert_int_equal(v.loop_rank, 2);
    }
}

static void loops_of_all_kinds(void **state)
{
    (void)state;
    static const char *const files[] = {"closed_floatring_n0013", "closed_fourbar_rot",
                                        "closed_platform_3x3R",   "closed_slidercrank",
                                        "closed_two_4R_point3",   "closed_two_6R_weld6"};
    for (int k = 0; k < 6; k++)
        for (int P = 1; P <= 13; P += 3)
            for (int variant = 0; variant < 4; variant++) {
                struct arena *a = arena_create();
                struct err e = {0};
                struct run_spec s = evaluation_spec("dynamics", 1, P);
                s.model.generator = MODEL_VECTOR;
                snprintf(s.model.path, sizeof s.model.path,
                         MIMDSIM_SRCDIR "/tests/data/vectors/%s.json", files[k]);
                s.kernel.formulation = variant & 1 ? FORMULATION_DIRECT : FORMULATION_PAPER;
                s.kernel.inner_refinements = variant >> 1;
                const struct model *m = model_build(&s.model, a, &e);
                if (!m) fail_msg("%s", e.text);
                if (P <= m->nbody) {
                    const struct evaluation v =
                        evaluate_model(&s, m, state_make(m, &s.model, a), a);
                    if (!(v.tau_error < 1e-13 && v.qdd_error < 1e-10))
                        fail_msg("%s P %d: tau %.1e qdd %.1e", files[k], P, v.tau_error,
                                 v.qdd_error);
                }
                arena_destroy(a);
            }
}

/* depth: of a piece. */
static int depth(const struct tree_plan *p, int k)
{
    return p->parent[k] < 0 ? 0 : 1 + depth(p, p->parent[k]);
}

static void pieces_are_connected_and_balanced(void **state)
{
    (void)state;
    for (int g = 0; g < 4; g++)
        for (int n = 1; n <= 200; n = 2 * n + 1)
            for (int P = 1; P <= n; P = 2 * P + 1) {
                struct arena *a = arena_create();
                struct err e = {0};
                struct run_spec s = evaluation_spec("forward", n, P);
                s.model.generator = trees[g];
                const struct model *m = model_build(&s.model, a, &e);
                if (!m) {
                    arena_destroy(a);
                    continue; /* too small for such a tree */
                }
                const int limit = (m->nbody + P - 1) / P;
                const struct tree_plan *p = tree_plan_make(m, P, a);
                assert_true(p->npiece >= 1 && p->npiece <= P);
                for (int k = 0; k < P; k++)
                    assert_true(p->bodies.at[k + 1] - p->bodies.at[k] <= 2 * limit);
                for (int i = 0; i < m->nbody; i++) {
                    const int k = p->owner[i], parent = m->body[i].parent;
                    assert_true(k >= 0 && k < p->npiece);
                    assert_true(parent == p->anchor[k] || (parent >= 0 && p->owner[parent] == k));
                }
                int deepest = 0;
                for (int k = 0; k < p->npiece; k++)
                    deepest = depth(p, k) > deepest ? depth(p, k) : deepest;
                assert_true(deepest == 0
                                ? p->nlevel == 0
                                : 1 << (p->nlevel - 1) <= deepest && deepest < 1 << p->nlevel);
                assert_int_equal(p->nop + p->nroot <= m->nbody, 1);
                arena_destroy(a);
            }
}

static void contraction_takes_logarithmically_many_rounds(void **state)
{
    (void)state;
    /* a chain with one body per rank */
    static const int known[3][2] = {{64, 6}, {256, 8}, {1024, 10}};
    for (int k = 0; k < 3; k++) {
        struct arena *a = arena_create();
        struct err e = {0};
        struct run_spec s = evaluation_spec("forward", known[k][0], known[k][0]);
        assert_int_equal(tree_plan_make(model_build(&s.model, a, &e), known[k][0], a)->nround,
                         known[k][1]);
        arena_destroy(a);
    }
}

/* count: what a run sends and computes equals the estimate; for loops the flops but for the least
 * norm solution. */
static void count(const struct run_spec *spec, struct job_omit omit)
{
    struct arena *a = arena_create();
    struct err err = {0};
    const struct model *m = model_build(&spec->model, a, &err);
    if (!m) fail_msg("%s", err.text);
    const struct evaluation v = evaluate_omitting(spec, m, state_make(m, &spec->model, a), omit, a);
    struct program_estimate e;
    kernel_find(spec->kernel.name)->estimate(spec, m, &omit, &e);
    double flops = 0;
    for (int stage = 0; stage < MANY_RANKS_STAGES; stage++)
        flops += (double)v.counts.stage_work[stage].flop;
    const double least = m->nloop > 0 ? 0.96 * flops : flops;
    if (!(e.flops >= least && e.flops <= flops) || e.messages != (double)v.counts.messages ||
        e.bytes != (double)v.counts.bytes)
        fail_msg("%s, generator %d n %d P %d joint %d formulation %d steps %d: %.0f flops, %.0f "
                 "messages, %.0f bytes; counted %.0f, %ld, %ld",
                 spec->kernel.name, spec->model.generator, spec->model.nbody, spec->nrank,
                 spec->model.joint, spec->kernel.formulation, spec->kernel.steps, e.flops,
                 e.messages, e.bytes, flops, (long)v.counts.messages, (long)v.counts.bytes);
    arena_destroy(a);
}

static void estimates_are_what_is_counted(void **state)
{
    (void)state;
    static const char *const names[] = {"inverse", "forward", "dynamics"};
    for (int k = 0; k < 3 * 2 * 5 * (JOINT_MIXED + 1); k++) {
        struct run_spec s = evaluation_spec(names[k % 3], 33, 1 + k % 11);
        s.kernel.formulation = k / 3 % 2 ? FORMULATION_DIRECT : FORMULATION_PAPER;
        s.model.generator = k / 6 % 5 < 4 ? trees[k / 6 % 5] : MODEL_RING;
        s.model.joint = (enum model_joint)(k / 30);
        const bool ring = s.model.generator == MODEL_RING;
        /* nothing to close, and joints that rings cannot have */
        if (ring && s.model.joint == JOINT_FIXED) continue;
        /* of a ring both sides of the loop have owners then */
        if (k % 4 > 1) s.model.base = BASE_FLOATING;
        s.model.external_force = k % 4 == 0;
        s.kernel.outer_refinements =
            k % 5 == 0 && s.kernel.formulation == FORMULATION_PAPER && !ring;
        s.kernel.steps = k % 7 == 0 && k % 3 > 0 ? 2 : 0;
        s.kernel.step = k % 14 == 0 ? STEP_RK4 : STEP_SEMI_IMPLICIT;
        s.kernel.step_size = 1e-4;
        const bool rest = k % 3 == 1 && k % 13 == 0 && s.kernel.steps == 0;
        if (rest) s.model.rate = 0;
        count(&s, (struct job_omit){
                      .velocity = rest, .load = rest && s.model.external_force == 0, .turn = true});
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_tree_on_every_number_of_ranks),
        cmocka_unit_test(every_joint_in_a_tree),
        cmocka_unit_test(large_trees),
        cmocka_unit_test(refinement_reaches_the_last_digits),
        cmocka_unit_test(closed_chains),
        cmocka_unit_test(loops_of_all_kinds),
        cmocka_unit_test(a_four_bar_has_three_redundant_constraints),
        cmocka_unit_test(pieces_are_connected_and_balanced),
        cmocka_unit_test(estimates_are_what_is_counted),
        cmocka_unit_test(contraction_takes_logarithmically_many_rounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
