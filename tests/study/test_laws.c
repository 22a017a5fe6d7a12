/* test_laws.c - seeded random scenes through whole runs: every answer is right, on any machine the
 * same.
 *
 * A run compares its own answers with the serial algorithms; here the scenes, kernels and machines
 * are drawn at random over all joints, generators, bases, solvers, formulations, partitions, n from
 * 1 to 300 and P from 1 to n. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "run/run.h"

static int draw(struct random *r, int n) { return (int)random_below(r, (uint64_t)n); }

/* Rings need three sides, and their loop closes them in a pose of their own. */
static struct model_spec random_model(struct random *r, int n, uint64_t seed)
{
    static const enum model_generator generators[] = {
        MODEL_SERIAL_CHAIN, MODEL_SERIAL_CHAIN, MODEL_COMB, MODEL_STAR,
        MODEL_RANDOM_TREE,  MODEL_DENDRIMER,    MODEL_RING, MODEL_POLYMER};
    struct model_spec m = {.generator = generators[draw(r, 8)],
                           .nbody = n,
                           .joint = (enum model_joint)draw(r, JOINT_MIXED + 1),
                           .base = (enum model_base)draw(r, 3),
                           .inertia = (enum model_inertia)draw(r, 2),
                           .pose = POSE_RANDOM,
                           .axes = AXES_TWISTED,
                           .length = 1,
                           .radius = 0.1,
                           .mass = 1,
                           .mass_ratio = 3,
                           .gravity = {1, -2, -9.81},
                           .base_acceleration = {0.3, -0.2, 0.1, 1, 2, -1},
                           .rate = 0.5,
                           .torque = 1,
                           .external_force = draw(r, 2),
                           .branch = 1 + draw(r, 4),
                           .seed = seed};
    if (m.generator == MODEL_RING && n < 3) m.generator = MODEL_SERIAL_CHAIN;
    /* stiff rings lose digits as they grow */
    if (m.generator == MODEL_RING && n > 40) m.nbody = n = 40;
    if (m.generator == MODEL_POLYMER) m.rate = 0, m.torque = 0, m.external_force = 0;
    return m;
}

static struct kernel_spec random_kernel(struct random *r)
{
    static const char *const name[] = {"inverse", "forward", "dynamics"};
    struct kernel_spec k = {.formulation = (enum formulation)draw(r, 2),
                            .solver = (enum solver)draw(r, 6),
                            .part_solver = (enum part_solver)draw(r, 2),
                            .partition = (enum partition_rule)draw(r, 2),
                            .composites_incoming = draw(r, 2),
                            .hybrid_levels = draw(r, 4)};
    snprintf(k.name, sizeof k.name, "%s", name[draw(r, 3)]);
    if (k.solver != SOLVER_PCR) k.inner_refinements = draw(r, 2), k.outer_refinements = draw(r, 2);
    return k;
}

/* A crossbar, a ring, or a fat tree of at least P nodes. */
static struct machine_spec machine_of(int kind, int P)
{
    struct machine_spec m = {
        .name = "any",
        .topology = {.family = TOPOLOGY_CROSSBAR, .ndim = 1, .dims = {P}, .nodes_per_router = 1,
                     .processors_per_node = 1},
        .node = {.flop_rate = kind == 1 ? 1e7 : 1e9, .clock = 1e9, .copy_bandwidth = 1e9},
        .network = {.level = kind == 0 ? LEVEL_LOGGP : LEVEL_LINK, .link_bandwidth = 1e8,
        .hop_latency = 1e-7,
                    .end_latency = 1e-6, .virtual_channels = 2},
        .software = {.send_overhead = 1e-6, .recv_overhead = 2e-6,
        .eager_bytes = kind == 2 ? 64 : -1},
    };
    if (kind == 1) m.topology.family = TOPOLOGY_TORUS, m.topology.ndim = 2, m.topology.dims[1] = 2;
    if (kind == 2) m.topology.nodes_per_router = 2, m.topology.family = TOPOLOGY_MESH;
    return m;
}

static struct run_result run_on(int kind, const struct run_spec *given, struct arena *a)
{
    struct run_spec spec = *given;
    struct run_result out;
    struct err e;
    err_clear(&e);
    spec.machine = machine_of(kind, spec.nrank);
    if (!run_one(&spec, a, &out, &e)) fail_msg("%s", e.text);
    return out;
}

static struct run_spec random_run(uint64_t seed)
{
    static const int size[] = {4, 12, 40, 300};
    struct random r = random_make(seed, 1, 0);
    int n = 1 + draw(&r, size[draw(&r, 4)]);
    struct run_spec s = {
        .seed = seed, .model = random_model(&r, n, seed), .kernel = random_kernel(&r)};
    s.nrank = 1 + draw(&r, s.model.nbody);
    return s;
}

static void random_scenes_are_right_on_any_machine(void **state)
{
    int differ = 0;
    (void)state;
    for (uint64_t seed = 1; seed <= 400; seed++) {
        struct arena *a = arena_create();
        const struct run_spec s = random_run(seed);
        struct run_result first = run_on(0, &s, a);
        if (first.status != RUN_OK)
            fail_msg("seed %d: %s, generator %d, joint %d, base %d, n %d, P %d, solver %d: %s",
                     (int)seed, s.kernel.name, s.model.generator, s.model.joint, s.model.base,
                     s.model.nbody, s.nrank, s.kernel.solver, first.text);
        for (int kind = 1; kind < 3 && seed % 3 == 0; kind++) { /* the very bits */
            struct run_result other = run_on(kind, &s, a);
            assert_int_equal(other.nerror, first.nerror);
            for (int i = 0; i < first.nerror; i++)
                assert_memory_equal(&other.error[i].relative, &first.error[i].relative,
                                    sizeof(double));
            differ += other.makespan_ps != first.makespan_ps;
        }
        arena_destroy(a);
    }
    assert_true(differ > 100); /* the machines are not the same one */
}

/* Time steps in parallel end where serial ones do; of closed chains the drift is told, and grows
 * without mending. */
static void steps_end_where_serial_ones_do(void **state)
{
    (void)state;
    for (int step = 0; step < 3; step++)
        for (int generator = 0; generator < 3; generator++) {
            static const enum model_generator kind[] = {MODEL_SERIAL_CHAIN, MODEL_RANDOM_TREE,
                                                        MODEL_FOUR_BAR};
            struct arena *a = arena_create();
            struct random r = random_make(5, 1, 0);
            struct run_spec s = {.nrank = 3, .model = random_model(&r, 9, 5)};
            s.model.generator = kind[generator];
            s.model.base = BASE_FIXED;
            s.model.joint = JOINT_SPHERICAL;
            s.kernel = (struct kernel_spec){.name = "forward",
                                            .formulation = FORMULATION_DIRECT,
                                            .steps = 12,
                                            .step_size = 2e-3,
                                            .step = (enum step_rule)step};
            struct run_result out = run_on(0, &s, a);
            if (out.status != RUN_OK)
                fail_msg("step %d, generator %d: %s", step, generator, out.text);
            assert_int_equal(out.nerror, 2);
            assert_string_equal(out.error[0].quantity, "q");
            assert_true(out.error[0].tolerance < 1e-6);
            if (generator < 2) {
                assert_int_equal(out.loop_rows, 0);
            } else {
                assert_int_equal(out.loop_rows, 5);
                assert_int_equal(out.loop_rank, 2);
                assert_true(out.drift_position > 0 && out.drift_position < 1e-2);
                assert_true(out.drift_velocity > 0 && out.drift_velocity < 1e-1);
            }
            arena_destroy(a);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_scenes_are_right_on_any_machine),
        cmocka_unit_test(steps_end_where_serial_ones_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
