/* test_counts.c - messages, bytes and operations of the kernels equal the formulas. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "dynamics/system.h"
#include "evaluation.h"
#include "linalg/block_row.h"

/* total: flop, div and sqrt count one each. */
static uint64_t operations(const struct work *w) { return w->flop + w->div + w->sqrt; }

static struct many_ranks_result counts_of(struct run_spec spec)
{
    struct arena *a = arena_create();
    const struct many_ranks_result r = evaluate(&spec, a).counts;
    arena_destroy(a);
    return r;
}

static void a_scan_sends_P_lg_P_minus_P_plus_1_messages(void **state)
{
    (void)state;
    for (int lg = 0; lg <= 7; lg++) {
        const int P = 1 << lg, phase = P * lg - P + 1;
        const struct many_ranks_result r = counts_of(evaluation_spec("inverse", P, P));
        for (int stage = 1; stage <= 3; stage++) assert_int_equal(r.stage_messages[stage], phase);
        assert_int_equal(r.stage_bytes[2], 48 * phase);
        assert_int_equal(r.stage_bytes[3], 48 * phase);
        assert_int_equal(r.stage_bytes[1], 48 * phase + 96 * (P > 1 ? P * lg - 2 * (P - 1) : 0));
    }
}

static void inverse_dynamics_of_128_bodies(void **state)
{
    (void)state;
    struct run_spec spec = evaluation_spec("inverse", 128, 128);
    struct many_ranks_result r = counts_of(spec);
    assert_int_equal(r.messages, 3 * 769);
    assert_int_equal(r.bytes, 98544 + 2 * 36912);
    spec.kernel.operators = OPERATORS_DENSE;
    r = counts_of(spec);
    assert_int_equal(r.stage_bytes[1], 769 * 48 + (128 * 7 - 254) * 288);
}

/* solve_stage: what the block solver of a chain of 128 revolute joints sends, without the two
 * neighbour messages. */
static struct many_ranks_result solver_counts(enum solver solver)
{
    struct run_spec spec = evaluation_spec("forward", 128, 128);
    spec.kernel.solver = solver;
    struct many_ranks_result r = counts_of(spec);
    r.stage_messages[5] -= 2 * 127;
    r.stage_bytes[5] -= 127 * (200 + 40);
    return r;
}

static void solvers_send_what_the_formulas_say(void **state)
{
    (void)state;
    struct many_ranks_result r = solver_counts(SOLVER_PCR_SYMMETRIC);
    assert_int_equal(r.stage_messages[5], 1538);
    assert_int_equal(r.stage_bytes[5], 502880);
    r = solver_counts(SOLVER_PCR);
    assert_int_equal(r.stage_messages[5], 1538);
    assert_int_equal(r.stage_bytes[5], 984320);
    r = solver_counts(SOLVER_CR);
    assert_int_equal(r.stage_messages[5], 4 * 127 - 2 * 7);
}

static void forward_dynamics_of_128_bodies(void **state)
{
    (void)state;
    static const struct {
        enum formulation formulation;
        enum solver solver;
        int messages, bytes;
    } known[] = {{FORMULATION_PAPER, SOLVER_PCR_SYMMETRIC, 4734, 714872},
                 {FORMULATION_DIRECT, SOLVER_PCR_SYMMETRIC, 3196, 647144},
                 {FORMULATION_PAPER, SOLVER_CR, 3690, 309392}};
    for (int k = 0; k < 3; k++) {
        struct run_spec spec = evaluation_spec("forward", 128, 128);
        spec.kernel.formulation = known[k].formulation;
        spec.kernel.solver = known[k].solver;
        const struct many_ranks_result r = counts_of(spec);
        assert_int_equal(r.messages, known[k].messages);
        assert_int_equal(r.bytes, known[k].bytes);
    }
}

static void the_solvers_work_adds_up(void **state)
{
    (void)state;
    for (int lg = 1; lg <= 7; lg++) {
        const int P = 1 << lg, pairs = P * lg - P + 1;
        int edges = 0;
        for (int d = 1; d < P; d *= 2) edges += 2 * (P - d > d ? d : P - d);
        struct run_spec spec = evaluation_spec("forward", P, P);
        const struct many_ranks_result r = counts_of(spec);
        const uint64_t expected =
            (uint64_t)(915 * (P * lg - edges) + 385 * edges + 20 * 2 * pairs + P * (55 + 45));
        assert_int_equal(operations(&r.stage_work[5]), expected);
    }
}

static void eliminating_a_row_costs_915_385_and_212(void **state)
{
    (void)state;
    real D[21], L[36] = {0}, U[36] = {0}, r[6] = {0}, factor[100], y[6], a[70], b[70];
    for (int i = 0; i < 6; i++)
        for (int j = 0; j <= i; j++) D[packed_index(i, j)] = i == j;
    static const int cases[][4] = {{5, 5, 5, 915}, {5, 5, 0, 385}, {5, 0, 5, 385}, {3, 3, 3, 212}};
    for (int k = 0; k < 4; k++) {
        struct work w = {0};
        assert_true(block_row_eliminate(cases[k][0], cases[k][1], cases[k][2], 1, D, L, U, r,
                                        factor, y, a, b, &w));
        assert_int_equal(operations(&w), cases[k][3]);
    }
}

static void estimates_equal_what_is_sent(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1},     {2, 2},   {7, 7},   {64, 64},
                                   {100, 100}, {64, 16}, {61, 16}, {37, 5}};
    for (int k = 0; k < 8; k++)
        for (int variant = 0; variant < 8; variant++) {
            struct run_spec spec = evaluation_spec("dynamics", sizes[k][0], sizes[k][1]);
            spec.kernel.formulation = variant & 1 ? FORMULATION_DIRECT : FORMULATION_PAPER;
            spec.kernel.composites_incoming = !(variant & 2);
            spec.kernel.solver = variant & 4 ? SOLVER_PARTITION : SOLVER_PCR_SYMMETRIC;
            if (sizes[k][0] > sizes[k][1]) spec.kernel.solver = SOLVER_PARTITION;
            const struct many_ranks_result r = counts_of(spec);
            struct program_estimate e;
            struct err err = {0};
            struct arena *a = arena_create();
            kernel_find("dynamics")
                ->estimate(&spec, model_build(&spec.model, a, &err), &(struct job_omit){0}, &e);
            arena_destroy(a);
            assert_int_equal((int64_t)e.messages, r.messages);
            assert_int_equal((int64_t)e.bytes, r.bytes);
            struct work all = {0};
            for (int stage = 0; stage < MANY_RANKS_STAGES; stage++)
                work_add(&all, &r.stage_work[stage]);
            const double done = (double)operations(&all);
            assert_true(e.flops > 0.9 * done && e.flops < 1.1 * done);
        }
}

/* At rest, with and without gravity: all counts fall, and the estimates know. */
static void estimates_know_what_is_left_out(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {7, 7}, {64, 64}, {61, 16}};
    static const char *const names[] = {"inverse", "forward", "dynamics"};
    for (int variant = 0; variant < 4 * 3 * 8; variant++) {
        const int *size = sizes[variant % 4], bits = variant / 12;
        struct run_spec spec = evaluation_spec(names[variant / 4 % 3], size[0], size[1]);
        spec.model.rate = 0;
        spec.model.gravity[2] = bits & 1 ? 0 : -9.81;
        spec.kernel.formulation = bits & 2 ? FORMULATION_DIRECT : FORMULATION_PAPER;
        spec.kernel.composites_incoming = bits & 4;
        spec.kernel.solver = SOLVER_PARTITION;
        struct arena *a = arena_create();
        struct err err = {0};
        const struct kernel_type *kernel = kernel_find(spec.kernel.name);
        const struct model *m = model_build(&spec.model, a, &err);
        const struct job_omit omit = {
            .velocity = true, .load = true, .base = bits & 1, .bias = bits & 1};
        const struct evaluation whole = evaluate(&spec, a);
        const struct evaluation lean =
            evaluate_omitting(&spec, m, state_make(m, &spec.model, a), omit, a);
        struct program_estimate e;
        kernel->estimate(&spec, m, &omit, &e);
        assert_int_equal((int64_t)e.messages, lean.counts.messages);
        assert_int_equal((int64_t)e.bytes, lean.counts.bytes);
        assert_true(lean.counts.messages <= whole.counts.messages &&
                    lean.counts.bytes <= whole.counts.bytes);
        struct work all = {0};
        for (int stage = 0; stage < MANY_RANKS_STAGES; stage++)
            work_add(&all, &lean.counts.stage_work[stage]);
        const double done = (double)operations(&all);
        if (size[0] > 1 && !(e.flops > 0.9 * done && e.flops < 1.1 * done))
            fail_msg("variant %d: %g flops, not %g", variant, e.flops, done);
        for (int i = 0; i < m->nu; i++) {
            if (lean.qdd) assert_true(lean.qdd[i] == whole.qdd[i]);
            if (lean.tau) assert_true(lean.tau[i] == whole.tau[i]);
        }
        arena_destroy(a);
    }
}

static void estimates_of_all_rows_and_of_trees(void **state)
{
    (void)state;
    static const struct {
        enum model_generator generator;
        enum solver solver;
    } cases[] = {{MODEL_SERIAL_CHAIN, SOLVER_PCR},
                 {MODEL_SERIAL_CHAIN, SOLVER_PCR_SYMMETRIC},
                 {MODEL_COMB, SOLVER_PCR_SYMMETRIC},
                 {MODEL_RANDOM_TREE, SOLVER_PCR_SYMMETRIC},
                 {MODEL_DENDRIMER, SOLVER_PCR_SYMMETRIC}};
    for (int k = 0; k < 5; k++)
        for (int P = 1; P <= 40; P += 6) {
            struct run_spec spec = evaluation_spec("forward", 61, P);
            spec.model.generator = cases[k].generator;
            spec.kernel.solver = cases[k].solver;
            const struct many_ranks_result r = counts_of(spec);
            struct program_estimate e;
            struct err err = {0};
            struct arena *a = arena_create();
            kernel_find("forward")->estimate(&spec, model_build(&spec.model, a, &err),
                                             &(struct job_omit){0}, &e);
            arena_destroy(a);
            assert_int_equal((int64_t)e.messages, r.messages);
            assert_int_equal((int64_t)e.bytes, r.bytes);
            struct work all = {0};
            for (int stage = 0; stage < MANY_RANKS_STAGES; stage++)
                work_add(&all, &r.stage_work[stage]);
            const double done = (double)operations(&all);
            if (!(e.flops > 0.95 * done && e.flops < 1.1 * done))
                fail_msg("case %d P %d: %g, not %g", k, P, e.flops, done);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scan_sends_P_lg_P_minus_P_plus_1_messages),
        cmocka_unit_test(inverse_dynamics_of_128_bodies),
        cmocka_unit_test(solvers_send_what_the_formulas_say),
        cmocka_unit_test(forward_dynamics_of_128_bodies),
        cmocka_unit_test(the_solvers_work_adds_up),
        cmocka_unit_test(eliminating_a_row_costs_915_385_and_212),
        cmocka_unit_test(estimates_equal_what_is_sent),
        cmocka_unit_test(estimates_know_what_is_left_out),
        cmocka_unit_test(estimates_of_all_rows_and_of_trees),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
