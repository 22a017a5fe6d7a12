/* test_executed.c - the parallel programs count what all their ranks together execute.
 *
 * The linker brings every run on many ranks through here (--wrap), between the start and the stop of the meter. */
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

struct many_ranks_result __real_many_ranks_publishing(int nrank, many_ranks_program *program, void *context,
                                                      const struct comm_output *output, int noutput);
struct many_ranks_result __wrap_many_ranks_publishing(int nrank, many_ranks_program *program, void *context,
                                                      const struct comm_output *output, int noutput);
struct many_ranks_result __wrap_many_ranks_publishing(int nrank, many_ranks_program *program, void *context,
                                                      const struct comm_output *output, int noutput)
{
    flop_meter_start();
    const struct many_ranks_result r = __real_many_ranks_publishing(nrank, program, context, output, noutput);
    executed = flop_meter_stop();
    return r;
}

static long difference(uint64_t x, uint64_t y) { return (long)(x - y); }

/* Whether the run's account is wrong; says how. */
static int wrong(const struct run_spec *spec, const struct evaluation *v)
{
    struct work all = {0};
    for (int stage = 0; stage < MANY_RANKS_STAGES; stage++) work_add(&all, &v->counts.stage_work[stage]);
    if (all.flop == executed.flop && all.div == executed.div && all.sqrt == executed.sqrt && all.trig == executed.trig)
        return 0;
    print_error("%s, %d %s bodies on %d ranks, generator %d, formulation %d, solver %d, rate %g, steps %d, in %d: flop "
                "%+ld of %lu, div %+ld, "
                "sqrt %+ld, trig %+ld\n",
                spec->kernel.name, spec->model.nbody, joint_name(spec->model.joint), spec->nrank, spec->model.generator,
                spec->kernel.formulation, spec->kernel.solver, spec->model.rate, spec->kernel.steps,
                spec->kernel.composites_incoming, difference(all.flop, executed.flop), (unsigned long)executed.flop,
                difference(all.div, executed.div), difference(all.sqrt, executed.sqrt),
                difference(all.trig, executed.trig));
    return 1;
}

static int run(const struct run_spec *spec)
{
    struct arena *a = arena_create();
    const struct evaluation v = evaluate(spec, a);
    const int bad = wrong(spec, &v);
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
            bad += run(&spec);
        }
    assert_int_equal(bad, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inverse_dynamics_counts_what_it_executes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
