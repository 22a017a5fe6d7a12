/* test_planar.c - planar scenes in three components: tau and u' equal those of the serial
 * algorithms in six. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>

#include "../support/planar_models.h"
#include "dynamics/system.h"
#include "evaluation.h"

/* The largest errors of a test, printed with it. */
struct worst {
    double tau, qdd;
};

static struct run_spec planar_spec(const char *name, int n, int P)
{
    struct run_spec s = evaluation_spec(name, n, P);
    s.kernel.algebra = ALGEBRA_PLANAR;
    s.kernel.solver = SOLVER_PARTITION;
    return s;
}

/* check: both answers within the given relative errors. */
static void check(const struct run_spec *spec, const struct planar_options *o, double tau,
                  double qdd, struct worst *w)
{
    struct arena *a = arena_create();
    const struct model *m = planar_model(o, a);
    const struct evaluation v = evaluate_model(spec, m, planar_state(o, m, a), a);
    if (!(v.tau_error < tau && v.qdd_error < qdd))
        fail_msg(
            "n %d P %d seed %d joint %d solver %d formulation %d precision %d: tau %.1e qdd %.1e",
            o->n, spec->nrank, (int)o->seed, o->joint, spec->kernel.solver,
            spec->kernel.formulation, spec->kernel.precision, v.tau_error, v.qdd_error);
    w->tau = fmax(w->tau, v.tau_error);
    w->qdd = fmax(w->qdd, v.qdd_error);
    arena_destroy(a);
}

static void tell(const char *what, const struct worst *w)
{
    print_message("%s: largest errors tau %.1e, qdd %.1e\n", what, w->tau, w->qdd);
}

static void chains_of_every_joint(void **state)
{
    (void)state;
    static const enum model_joint joints[] = {JOINT_REVOLUTE, JOINT_PRISMATIC, JOINT_PLANAR,
                                              JOINT_MIXED};
    struct worst w = {0};
    for (int n = 1; n <= 13; n++)
        for (int P = 1; P <= n; P++)
            for (int k = 0; k < 4; k++) {
                const struct planar_options o = {
                    .n = n, .joint = joints[k], .springs = k & 1, .loads = n % 3 == 0,
                    .seed = (uint64_t)(n + 17 * k)};
                struct run_spec s = planar_spec("dynamics", n, P);
                s.kernel.formulation = FORMULATION_DIRECT;
                check(&s, &o, 1e-12, 1e-10, &w);
                s.kernel.formulation = FORMULATION_PAPER;
                check(&s, &o, 1e-12, 1e-9, &w);
            }
    tell("chains", &w);
}

static void every_solver_and_variant(void **state)
{
    (void)state;
    struct worst w = {0};
    for (int n = 2; n <= 27; n += n < 6 ? 1 : 7)
        for (int P = 1; P <= n; P += P < 4 ? 1 : 6)
            for (int solver = 0; solver <= SOLVER_THOMAS; solver++)
                for (int variant = 0; variant < 8; variant++) {
                    const struct planar_options o = {
                        .n = n, .joint = JOINT_MIXED, .loads = true, .seed = (uint64_t)(40 + n)};
                    struct run_spec s = planar_spec("dynamics", n, P);
                    s.kernel.solver = solver;
                    s.kernel.hybrid_levels = variant % 3;
                    s.kernel.formulation = variant & 1 ? FORMULATION_PAPER : FORMULATION_DIRECT;
                    s.kernel.part_solver = variant & 2 ? PART_CR : PART_PCR;
                    s.kernel.operators = variant & 2 ? OPERATORS_DENSE : OPERATORS_STRUCTURED;
                    s.kernel.composites_incoming = !(variant & 4);
                    s.kernel.partition = variant & 1 ? PARTITION_BALANCED : PARTITION_BLOCK;
                    check(&s, &o, 1e-12, 1e-10, &w);
                }
    tell("solvers", &w);
}

static void trees_of_every_joint(void **state)
{
    (void)state;
    static const enum model_joint joints[] = {JOINT_REVOLUTE, JOINT_PRISMATIC, JOINT_PLANAR,
                                              JOINT_MIXED};
    struct worst w = {0};
    for (int n = 2; n <= 31; n += n < 8 ? 1 : 8)
        for (int P = 1; P <= n; P += P < 5 ? 1 : 6)
            for (int k = 0; k < 8; k++) {
                const struct planar_options o = {.n = n,
                                                 .tree = true,
                                                 .joint = joints[k / 2],
                                                 .springs = k & 2,
                                                 .loads = k >= 6,
                                                 .seed = (uint64_t)(100 + n + k)};
                struct run_spec s = planar_spec("dynamics", n, P);
                s.kernel.formulation = k & 1 ? FORMULATION_DIRECT : FORMULATION_PAPER;
                check(&s, &o, 1e-12, 1e-10, &w);
            }
    tell("trees", &w);
}

static void refinements_keep_the_answer(void **state)
{
    (void)state;
    struct worst w = {0};
    for (int tree = 0; tree < 2; tree++)
        for (int formulation = 0; formulation < 2; formulation++)
            for (int P = 3; P <= 24; P += 7) {
                const struct planar_options o = {
                    .n = 24, .tree = tree, .joint = JOINT_MIXED, .loads = true,
                    .seed = (uint64_t)(7 + P)};
                struct run_spec s = planar_spec("dynamics", 24, P);
                s.kernel.formulation = formulation;
                s.kernel.inner_refinements = 1;
                s.kernel.outer_refinements = 1;
                check(&s, &o, 1e-12, 1e-12, &w);
            }
    tell("refined", &w);
}

static void float_and_quad_compute_the_same(void **state)
{
    (void)state;
    struct worst single = {0}, quad = {0};
    for (int tree = 0; tree < 2; tree++)
        for (int n = 1; n <= 16; n += 5)
            for (int P = 1; P <= n; P += 3) {
                const struct planar_options o = {
                    .n = n, .tree = tree, .joint = JOINT_MIXED, .loads = n > 1,
                    .seed = (uint64_t)(3 * n)};
                struct run_spec s = planar_spec("dynamics", n, P);
                s.kernel.precision = PRECISION_FLOAT;
                check(&s, &o, 1e-4, 1e-2, &single);
                s.kernel.precision = PRECISION_QUAD;
                check(&s, &o, 1e-12, 1e-11, &quad);
            }
    tell("float", &single);
    tell("quad", &quad);
}

/* Time steps end where those of the spatial programs do. */
static void time_steps_end_in_the_same_state(void **state)
{
    (void)state;
    double largest = 0;
    for (int rule = 0; rule <= STEP_LINEARLY_IMPLICIT; rule++)
        for (int tree = 0; tree < 2; tree++) {
            struct arena *a = arena_create();
            const struct planar_options o = {
                .n = 9, .tree = tree, .joint = JOINT_MIXED, .springs = true,
                .seed = (uint64_t)(rule + 5)};
            const struct model *m = planar_model(&o, a);
            struct run_spec s = planar_spec("forward", 9, 4);
            s.kernel.steps = 10;
            s.kernel.step = rule;
            if (rule == STEP_LINEARLY_IMPLICIT) s.kernel.formulation = FORMULATION_DIRECT;
            s.kernel.step_size = 1e-3;
            const struct evaluation v = evaluate_model(&s, m, planar_state(&o, m, a), a);
            s.kernel.algebra = ALGEBRA_SPATIAL;
            const struct evaluation u = evaluate_model(&s, m, planar_state(&o, m, a), a);
            for (int i = 0; i < m->nq; i++) largest = fmax(largest, fabs(v.q_end[i] - u.q_end[i]));
            for (int i = 0; i < m->nu; i++)
                largest = fmax(largest, fabs(v.qd_end[i] - u.qd_end[i]));
            arena_destroy(a);
        }
    print_message("steps: largest difference %.1e\n", largest);
    assert_true(largest < 1e-10);
}

/* Loop forces, too, and the rank of the constraints, are those of the spatial programs; what they
 * have out of the plane is zero. Constraints that contradict each other have no answer to
 * compare. */
static void closed_chains(void **state)
{
    (void)state;
    struct worst w = {0};
    double largest = 0;
    int compared = 0;
    for (int variant = 0; variant < 96; variant++) {
        const int loops = 1 + variant % 3;
        const struct planar_options o = {.n = 11,
                                         .tree = variant & 1,
                                         .joint = JOINT_MIXED,
                                         .springs = variant & 2,
                                         .loads = variant & 4,
                                         .twins = variant & 8,
                                         .loops = loops,
                                         .seed = (uint64_t)(variant + 1)};
        struct arena *a = arena_create();
        const struct model *m = planar_model(&o, a);
        struct run_spec s = planar_spec("forward", o.n, 1 + variant % 11);
        s.kernel.formulation = variant & 16 ? FORMULATION_PAPER : FORMULATION_DIRECT;
        const struct evaluation v = evaluate_model(&s, m, planar_state(&o, m, a), a);
        s.kernel.algebra = ALGEBRA_SPATIAL;
        const struct evaluation u = evaluate_model(&s, m, planar_state(&o, m, a), a);
        double scale = 0;
        assert_int_equal(u.loop_rank, v.loop_rank);
        const int different = o.twins ? (loops + 1) / 2 : loops;
        if (v.loop_rank == 2 * different) {
            for (int k = 0; k < m->nrow; k++) scale = fmax(scale, fabs(u.lambda[k]));
            for (int k = 0; k < m->nrow; k++)
                largest = fmax(largest, fabs(u.lambda[k] - v.lambda[k]) / scale);
            w.qdd = fmax(w.qdd, v.qdd_error);
            compared++;
        }
        arena_destroy(a);
    }
    tell("loops", &w);
    print_message("%d scenes; loop forces: largest difference %.1e\n", compared, largest);
    assert_true(compared > 48 && w.qdd < 1e-9 && largest < 1e-7);
}

/* operations: flop and div count one each. */
static double operations(const struct many_ranks_result *r)
{
    double sum = 0;
    for (int stage = 0; stage < MANY_RANKS_STAGES; stage++)
        sum += (double)(r->stage_work[stage].flop + r->stage_work[stage].div);
    return sum;
}

static void estimates_equal_what_is_sent(void **state)
{
    (void)state;
    static const int sizes[][2] = {{2, 2}, {7, 7}, {64, 64}, {64, 16}, {61, 16}, {37, 5}};
    for (int k = 0; k < 6; k++)
        for (int variant = 0; variant < 16; variant++) {
            struct arena *a = arena_create();
            struct run_spec s = planar_spec("dynamics", sizes[k][0], sizes[k][1]);
            struct err err = {0};
            struct program_estimate e;
            s.model.axes = AXES_PARALLEL;
            s.model.generator = variant & 8 ? MODEL_DENDRIMER : MODEL_SERIAL_CHAIN;
            s.kernel.formulation = variant & 1 ? FORMULATION_DIRECT : FORMULATION_PAPER;
            s.kernel.composites_incoming = !(variant & 2);
            if (sizes[k][0] == sizes[k][1] && variant & 4) s.kernel.solver = SOLVER_PCR_SYMMETRIC;
            const struct model *m = model_build(&s.model, a, &err);
            const struct evaluation v = evaluate_model(&s, m, state_make(m, &s.model, a), a);
            kernel_find_planar("dynamics", PRECISION_DOUBLE)
                ->estimate(&s, m, &(struct job_omit){0}, &e);
            assert_int_equal((int64_t)e.messages, v.counts.messages);
            assert_int_equal((int64_t)e.bytes, v.counts.bytes);
            const double done = operations(&v.counts);
            if (!(e.flops > 0.9 * done && e.flops < (variant & 8 ? 1.15 : 1.1) * done))
                fail_msg("n %d P %d variant %d: %g, not %g", sizes[k][0], sizes[k][1], variant,
                         e.flops, done);
            arena_destroy(a);
        }
}

/* Blocks of two constraints, screws of three numbers, transforms of four. */
static void messages_are_as_small_as_the_plane(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    for (int lg = 1; lg <= 6; lg++) {
        const int P = 1 << lg, phase = P * lg - P + 1;
        struct run_spec s = planar_spec("inverse", P, P);
        s.model.axes = AXES_PARALLEL;
        struct err err = {0};
        const struct model *m = model_build(&s.model, a, &err);
        const struct many_ranks_result r =
            evaluate_model(&s, m, state_make(m, &s.model, a), a).counts;
        for (int stage = 1; stage <= 3; stage++) assert_int_equal(r.stage_messages[stage], phase);
        assert_int_equal(r.stage_bytes[1], 24 * phase + 32 * (P * lg - 2 * (P - 1)));
        assert_int_equal(r.stage_bytes[2], 24 * phase);
        assert_int_equal(r.stage_bytes[3], 24 * phase);
    }
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chains_of_every_joint),
        cmocka_unit_test(every_solver_and_variant),
        cmocka_unit_test(trees_of_every_joint),
        cmocka_unit_test(refinements_keep_the_answer),
        cmocka_unit_test(float_and_quad_compute_the_same),
        cmocka_unit_test(time_steps_end_in_the_same_state),
        cmocka_unit_test(closed_chains),
        cmocka_unit_test(estimates_equal_what_is_sent),
        cmocka_unit_test(messages_are_as_small_as_the_plane),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
