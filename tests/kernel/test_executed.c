/* test_executed.c - the parallel programs count what all their ranks together execute.
 *
 * The linker brings every run on many ranks through here (--wrap), between the start and the stop
 * of the meter. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/flop_meter.h"
#include "../support/planar_models.h"
#include "dynamics/system.h"
#include "evaluation.h"

static struct work executed;

struct many_ranks_result __real_many_ranks_publishing(int nrank, many_ranks_program *program,
                                                      void *context,
                                                      const struct comm_output *output,
                                                      int noutput);
struct many_ranks_result __wrap_many_ranks_publishing(int nrank, many_ranks_program *program,
                                                      void *context,
                                                      const struct comm_output *output,
                                                      int noutput);
struct many_ranks_result __wrap_many_ranks_publishing(int nrank, many_ranks_program *program,
                                                      void *context,
                                                      const struct comm_output *output, int noutput)
{
    flop_meter_start();
    const struct many_ranks_result r =
        __real_many_ranks_publishing(nrank, program, context, output, noutput);
    executed = flop_meter_stop();
    return r;
}

/* A monitor, which costs the machine nothing. */
typedef __float128 quad;
quad __real_reduction_condition_f128(int c, const quad *before, const quad *pivot);
quad __wrap_reduction_condition_f128(int c, const quad *before, const quad *pivot);
quad __wrap_reduction_condition_f128(int c, const quad *before, const quad *pivot)
{
    flop_meter_pause();
    const quad condition = __real_reduction_condition_f128(c, before, pivot);
    flop_meter_resume();
    return condition;
}

static long difference(uint64_t x, uint64_t y) { return (long)(x - y); }

/* Whether x is y but for a share of it. */
static bool near(uint64_t x, uint64_t y, double share)
{
    return (double)x >= (1 - share) * (double)y && (double)x <= (1 + share) * (double)y;
}

/* Whether the run's account is wrong by more than a share; says how. */
static int wrong(const struct run_spec *spec, const struct evaluation *v, double share)
{
    struct work all = {0};
    for (int stage = 0; stage < MANY_RANKS_STAGES; stage++)
        work_add(&all, &v->counts.stage_work[stage]);
    if (share > 0 && near(all.flop + all.div, executed.flop + executed.div, share)) return 0;
    if (all.flop == executed.flop && all.div == executed.div && all.sqrt == executed.sqrt &&
        all.trig == executed.trig)
        return 0;
    print_error("%s, %d %s bodies on %d ranks, generator %d, formulation %d, solver %d, rate %g, "
                "steps %d, in %d: flop %+ld of %lu, div %+ld, sqrt %+ld, trig %+ld\n",
                spec->kernel.name, spec->model.nbody, joint_name(spec->model.joint), spec->nrank,
                spec->model.generator, spec->kernel.formulation, spec->kernel.solver,
                spec->model.rate, spec->kernel.steps, spec->kernel.composites_incoming,
                difference(all.flop, executed.flop), (unsigned long)executed.flop,
                difference(all.div, executed.div), difference(all.sqrt, executed.sqrt),
                difference(all.trig, executed.trig));
    return 1;
}

static int run(const struct run_spec *spec, double share)
{
    struct arena *a = arena_create();
    struct err e = {0};
    const struct model *m = model_build(&spec->model, a, &e);
    if (!m) fail_msg("%s", e.text);
    const struct evaluation v = evaluate_unwatched(spec, m, state_make(m, &spec->model, a), a);
    const int bad = wrong(spec, &v, share);
    arena_destroy(a);
    return bad;
}

static void inverse_dynamics_counts_what_it_executes(void **state)
{
    (void)state;
    int bad = 0;
    for (int joint = 0; joint < JOINT_MIXED; joint++)
        for (int n = 0; n < 8; n++) {
            struct run_spec spec = evaluation_spec("inverse", 4 + n * 3, 4);
            spec.kernel.precision = PRECISION_QUAD;
            spec.model.joint = joint;
            spec.kernel.composites_incoming = n & 1;
            if (n & 2) spec.model.external_force = 1;
            if (n & 4) spec.nrank = spec.model.nbody;
            bad += run(&spec, 0);
        }
    assert_int_equal(bad, 0);
}

/* Even without optimisation clang 14 leaves out c operations of each block row's update: there the
 * meter tells nothing of the source. */
#ifdef __clang__
#define NEEDS_GCC skip()
#else
#define NEEDS_GCC (void)0
#endif

static void forward_dynamics_counts_what_it_executes(void **state)
{
    (void)state;
    NEEDS_GCC;
    int bad = 0;
    for (int joint = 0; joint < JOINT_MIXED; joint++)
        for (int n = 0; n < 16; n++) {
            struct run_spec spec = evaluation_spec("forward", 4 + n, 4);
            spec.kernel.precision = PRECISION_QUAD;
            spec.model.joint = joint;
            spec.kernel.formulation = n & 1 ? FORMULATION_DIRECT : FORMULATION_PAPER;
            spec.kernel.composites_incoming = n & 2;
            if (n & 4) spec.model.external_force = 1;
            spec.kernel.solver = n & 8 ? SOLVER_PARTITION : SOLVER_PCR_SYMMETRIC;
            bad += run(&spec, 0);
        }
    assert_int_equal(bad, 0);
}

static void every_solver_counts_what_it_executes(void **state)
{
    (void)state;
    NEEDS_GCC;
    static const enum solver solver[] = {SOLVER_PCR_SYMMETRIC, SOLVER_CR, SOLVER_CR_PCR,
                                         SOLVER_THOMAS, SOLVER_PARTITION};
    int bad = 0;
    for (int k = 0; k < 5; k++)
        for (int n = 0; n < 12; n++) {
            struct run_spec spec =
                evaluation_spec(n % 3 ? "forward" : "dynamics", 5 + n, n % 4 == 3 ? 5 + n : 5);
            spec.kernel.precision = PRECISION_QUAD;
            spec.kernel.solver = solver[k];
            spec.kernel.hybrid_levels = 1;
            if (spec.nrank < spec.model.nbody && k > 0 && k < 3)
                spec.kernel.solver = SOLVER_PARTITION, spec.kernel.part_solver = PART_CR;
            if (n & 1) spec.kernel.formulation = FORMULATION_PAPER;
            if (n & 2) spec.kernel.inner_refinements = 1;
            if (n & 4)
                spec.kernel.steps = 2, spec.kernel.step_size = 1e-3, spec.kernel.step = n % 3;
            bad += run(&spec, 0);
        }
    assert_int_equal(bad, 0);
}

/* Forward dynamics of trees solves general 6 x 6 systems, which are charged by formula; a second
 * one with the same matrix is charged as a substitution, and its residual is a monitor. */
static void trees_count_what_they_execute(void **state)
{
    (void)state;
    static const enum model_generator generator[] = {MODEL_COMB, MODEL_RANDOM_TREE,
                                                     MODEL_DENDRIMER};
    int bad = 0;
    for (int k = 0; k < 3; k++)
        for (int n = 0; n < 6; n++) {
            struct run_spec spec = evaluation_spec(n % 2 ? "forward" : "inverse", 9 + 2 * n, 4);
            spec.kernel.precision = PRECISION_QUAD;
            spec.model.generator = generator[k];
            bad += run(&spec, n % 2 ? 0.02 : 0);
        }
    assert_int_equal(bad, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inverse_dynamics_counts_what_it_executes),
        cmocka_unit_test(forward_dynamics_counts_what_it_executes),
        cmocka_unit_test(every_solver_counts_what_it_executes),
        cmocka_unit_test(trees_count_what_they_execute),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
