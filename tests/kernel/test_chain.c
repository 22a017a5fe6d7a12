/* test_chain.c - parallel dynamics of chains equals the serial algorithms: every joint, size, split
 * and solver. */
#include <setjmp.h>
#include "config.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "evaluation.h"

/* check: both answers within the given relative errors. */
static void check(const struct run_spec *spec, double tau, double qdd)
{
    struct arena *a = arena_create();
    const struct evaluation v = evaluate(spec, a);
    if (!(v.tau_error < tau && v.qdd_error < qdd))
        fail_msg("n %d P %d joint %d solver %d formulation %d: tau %.1e qdd %.1e",
                 spec->model.nbody, spec->nrank, spec->model.joint, spec->kernel.solver,
                 spec->kernel.formulation, v.tau_error, v.qdd_error);
    arena_destroy(a);
}

static void every_joint_on_every_number_of_ranks(void **state)
{
    (void)state;
    for (int n = 1; n <= 13; n++)
        for (int P = 1; P <= n; P++)
            for (int joint = 0; joint <= JOINT_MIXED; joint++) {
                struct run_spec s = evaluation_spec("dynamics", n, P);
                s.model.joint = joint;
                s.kernel.solver = SOLVER_PARTITION;
                s.kernel.formulation = FORMULATION_DIRECT;
                check(&s, 1e-13, 1e-10);
                s.kernel.formulation = FORMULATION_PAPER;
                check(&s, 1e-13, 1e-8);
            }
}

static void every_solver_and_variant(void **state)
{
    (void)state;
    for (int n = 2; n <= 33; n += n < 9 ? 1 : 6)
        for (int P = 1; P <= n; P += P < 8 ? 1 : 5)
            for (int solver = 0; solver <= SOLVER_THOMAS; solver++)
                for (int variant = 0; variant < 8; variant++) {
                    struct run_spec s = evaluation_spec("dynamics", n, P);
                    s.model.joint = variant & 4 ? JOINT_SPHERICAL : JOINT_MIXED;
                    s.model.base = variant & 1 ? BASE_FLOATING : BASE_FIXED;
                    s.model.external_force = 1;
                    s.kernel.solver = solver;
                    s.kernel.hybrid_levels = variant % 3;
                    s.kernel.formulation = variant & 1 ? FORMULATION_PAPER : FORMULATION_DIRECT;
                    s.kernel.part_solver = variant & 2 ? PART_CR : PART_PCR;
                    s.kernel.operators = variant & 2 ? OPERATORS_DENSE : OPERATORS_STRUCTURED;
                    s.kernel.composites_incoming = !(variant & 4);
                    s.kernel.partition = variant & 1 ? PARTITION_BALANCED : PARTITION_BLOCK;
                    check(&s, 1e-13, 1e-9);
                }
}

static void refinement_reaches_the_last_digits(void **state)
{
    (void)state;
    for (int solver = 0; solver <= SOLVER_THOMAS; solver++)
        for (int formulation = 0; formulation < 2; formulation++)
            for (int P = 3; P <= 24; P += 7) {
                if (solver == SOLVER_PCR) continue;
                struct run_spec s = evaluation_spec("forward", 24, P);
                s.model.joint = JOINT_MIXED;
                s.kernel.solver = solver;
                s.kernel.hybrid_levels = 2;
                s.kernel.formulation = formulation;
                s.kernel.inner_refinements = 1;
                s.kernel.outer_refinements = 1;
                check(&s, 1, 1e-13);
            }
}

static void a_moving_base_is_felt(void **state)
{
    (void)state;
    for (int formulation = 0; formulation < 2; formulation++) {
        struct run_spec s = evaluation_spec("dynamics", 9, 4);
        s.model.base = BASE_MOVING;
        s.kernel.solver = SOLVER_PARTITION;
        s.kernel.formulation = formulation;
        for (int k = 0; k < 6; k++) s.model.base_acceleration[k] = 0.5 + k;
        check(&s, 1e-13, 1e-10);
    }
}

static void long_chains(void **state)
{
    (void)state;
    static const int sizes[][2] = {{100, 100}, {100, 7}, {300, 128}, {300, 300}, {128, 128}};
    for (int k = 0; k < 5; k++)
        for (int solver = 0; solver <= SOLVER_THOMAS; solver++) {
            struct run_spec s = evaluation_spec("dynamics", sizes[k][0], sizes[k][1]);
            s.kernel.solver = solver;
            s.kernel.hybrid_levels = 2;
            s.model.joint = k % 2 ? JOINT_SPHERICAL : JOINT_REVOLUTE;
            check(&s, 1e-12, 1e-8);
        }
}

static void float_and_quad_compute_the_same(void **state)
{
    (void)state;
    for (int n = 1; n <= 16; n += 5)
        for (int P = 1; P <= n; P += 3) {
            struct run_spec s = evaluation_spec("dynamics", n, P);
            s.kernel.solver = SOLVER_PARTITION;
            s.kernel.precision = PRECISION_FLOAT;
            check(&s, 1e-4, 1e-2);
            s.kernel.precision = PRECISION_QUAD;
            check(&s, 1e-13, 1e-11);
        }
}

static void the_answer_does_not_depend_on_the_split(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct run_spec s = evaluation_spec("dynamics", 40, 1);
    s.kernel.solver = SOLVER_PARTITION;
    s.kernel.inner_refinements = 1;
    const struct evaluation first = evaluate(&s, a);
    for (int P = 2; P <= 40; P++) {
        s.nrank = P;
        const struct evaluation v = evaluate(&s, a);
        for (int i = 0; i < 40; i++) {
            assert_true(v.qdd[i] - first.qdd[i] < 1e-10 && first.qdd[i] - v.qdd[i] < 1e-10);
            assert_true(v.tau[i] - first.tau[i] < 1e-9 && first.tau[i] - v.tau[i] < 1e-9);
        }
    }
    arena_destroy(a);
}

static void a_rank_of_a_large_machine_is_small(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct run_spec s = evaluation_spec("dynamics", 4096, 4096);
    s.model.inertia = INERTIA_UNIFORM;
    const struct evaluation v = evaluate(&s, a);
    assert_true(v.rank_bytes <= 4096);
#ifndef SANITIZERS /* which widen every frame */
    assert_true(v.counts.stack_bytes <= 8192);
#endif
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_joint_on_every_number_of_ranks),
        cmocka_unit_test(every_solver_and_variant),
        cmocka_unit_test(refinement_reaches_the_last_digits),
        cmocka_unit_test(a_moving_base_is_felt),
        cmocka_unit_test(long_chains),
        cmocka_unit_test(float_and_quad_compute_the_same),
        cmocka_unit_test(the_answer_does_not_depend_on_the_split),
        cmocka_unit_test(a_rank_of_a_large_machine_is_small),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
