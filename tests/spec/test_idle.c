/* test_idle.c - settings that cannot act in a run say why, and act where they can. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "spec/field.h"

static void set(struct run_spec *run, const char *key, const char *text)
{
    const struct field_table *t;
    const struct field *f = field_find_full(key, &t);
    char why[256] = "";
    if (f == NULL) fail_msg("there is no setting %s", key);
    else if (!field_set(f, (char *)run + t->offset, text, arena, why, (int)sizeof why))
        fail_msg("%s = %s: %s", key, text, why);
}

/* A run with all defaults but those in "key=value; key=value". */
static void make_run(struct run_spec *run, const char *changes)
{
    char line[400], *save = NULL;
    run_spec_defaults(run, arena);
    snprintf(line, sizeof line, "%s", changes);
    for (char *s = strtok_r(line, ";", &save); s != NULL; s = strtok_r(NULL, ";", &save)) {
        while (*s == ' ') s++;
        char *value = strchr(s, '=');
        assert_non_null(value);
        *value++ = '\0';
        set(run, s, value);
    }
}

/* A setting in a run, and a part of the reason why it is idle; NULL: it acts. */
struct idle_case {
    const char *changes, *key, *reason;
};

static void check(const struct idle_case *c, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        struct run_spec run;
        const struct field_table *t;
        const struct field *f = field_find_full(c[i].key, &t);
        make_run(&run, c[i].changes);
        if (f == NULL) fail_msg("there is no setting %s", c[i].key);
        const char *why = f->idle == NULL ? NULL : f->idle(&run);
        if (c[i].reason == NULL && why != NULL)
            fail_msg("[%s] %s is idle: %s", c[i].changes, c[i].key, why);
        if (c[i].reason != NULL && (why == NULL || strstr(why, c[i].reason) == NULL))
            fail_msg("[%s] %s: '%s', expected '%s'", c[i].changes, c[i].key, why ? why : "acts",
                     c[i].reason);
    }
}
#define CHECK_CASES(list) check(list, sizeof list / sizeof *list)

#define FAMILY(word) "machine.topology.family=" word

static void settings_of_topologies(void **state)
{
    (void)state;
    static const struct idle_case cases[] = {
        /* who says how many nodes a router has */
        {FAMILY("torus"), "machine.topology.nodes_per_router", NULL},
        {FAMILY("crossbar"), "machine.topology.nodes_per_router", NULL},
        {FAMILY("fat-tree"), "machine.topology.nodes_per_router", "topology.dims"},
        {FAMILY("dragonfly"), "machine.topology.nodes_per_router", "topology.dims"},
        {FAMILY("dragonfly-plus"), "machine.topology.nodes_per_router", "topology.dims"},
        {FAMILY("folded-clos"), "machine.topology.nodes_per_router", "topology.dims"},
        {FAMILY("hyperx"), "machine.topology.nodes_per_router", NULL},
        /* links between routers */
        {FAMILY("crossbar"), "machine.topology.dim_bandwidth", "no links"},
        {FAMILY("bus"), "machine.topology.dim_latency", "no links"},
        {FAMILY("bus"), "machine.network.failed.links", "no links"},
        {FAMILY("crossbar"), "machine.network.failed.routers", "no links"},
        {FAMILY("bus"), "machine.network.routing", "no links"},
        {FAMILY("full-mesh"), "machine.topology.dim_latency", NULL},
        {FAMILY("graph"), "machine.network.failed.links", NULL},
        /* two ways round: a plain torus alone */
        {FAMILY("torus"), "machine.topology.tie", NULL},
        {FAMILY("mesh"), "machine.topology.tie", "only a torus"},
        {FAMILY("express-mesh"), "machine.topology.tie", "only a torus"},
        {FAMILY("dragonfly"), "machine.topology.routing", NULL},
        {FAMILY("fat-tree"), "machine.topology.routing", NULL},
        {FAMILY("folded-clos"), "machine.topology.routing", NULL},
        {FAMILY("dragonfly-plus"), "machine.topology.routing", "dragonflies and fat trees"},
        {FAMILY("torus"), "machine.topology.routing", "dragonflies and fat trees"},
        {FAMILY("hypercube"), "machine.topology.xpress", NULL},
        {FAMILY("torus"), "machine.topology.xpress", "hypercube"},
        {FAMILY("hyperx"), "machine.topology.bundle", NULL},
        {FAMILY("folded-clos"), "machine.topology.bundle", NULL},
        {FAMILY("graph"), "machine.topology.bundle", NULL},
        {FAMILY("fat-tree"), "machine.topology.bundle", "bundles"},
        {FAMILY("folded-clos"), "machine.topology.up", NULL},
        {FAMILY("fat-tree"), "machine.topology.up", "folded Clos"},
        {FAMILY("hyperx"), "machine.topology.up", "folded Clos"},
        {FAMILY("hyperx"), "machine.topology.links", "from the file"},
        {FAMILY("express-mesh"), "machine.topology.express", NULL},
        {FAMILY("express-torus"), "machine.topology.express", NULL},
        {FAMILY("twisted-torus"), "machine.topology.express", "express cubes"},
        {FAMILY("twisted-torus"), "machine.topology.twist", NULL},
        {FAMILY("torus"), "machine.topology.twist", "twisted torus"},
        {FAMILY("random-regular"), "machine.topology.seed", NULL},
        {FAMILY("slim-fly"), "machine.topology.seed", "drawn"},
        {FAMILY("graph"), "machine.topology.links", NULL},
        {FAMILY("graph"), "machine.topology.link_weight", NULL},
        {FAMILY("random-regular"), "machine.topology.links", "from the file"},
        {FAMILY("torus"), "machine.topology.link_percent", "from the file"},
    };
    CHECK_CASES(cases);
}

#define LEVEL(word) "machine.network.level=" word

static void settings_of_network_levels(void **state)
{
    (void)state;
    static const struct idle_case cases[] = {
        {LEVEL("loggp"), "machine.network.buffer", "'loggp' moves whole messages"},
        {LEVEL("link"), "machine.network.buffer", "'link' moves whole messages"},
        {LEVEL("packet"), "machine.network.buffer", NULL},
        {LEVEL("flit"), "machine.network.virtual_channels", NULL},
        {LEVEL("auto"), "machine.network.credit_latency", NULL},
        {LEVEL("auto-tolerance"), "machine.network.arbitration", NULL},
        {LEVEL("link"), "machine.network.tolerance", "'auto-tolerance'"},
        {LEVEL("auto-tolerance"), "machine.network.tolerance", NULL},
        /* the first reason that holds is told */
        {LEVEL("link") ";machine.network.routing=adaptive", "machine.network.vc_allocator",
         "whole messages"},
        {LEVEL("flit"), "machine.network.vc_allocator", "'deterministic'"},
        {LEVEL("flit"), "machine.network.allocator_iterations", "'deterministic'"},
        {LEVEL("link") ";machine.topology.dim_latency=3 ns", "machine.network.allocator_iterations",
         "moves whole messages"},
        {LEVEL("flit") ";machine.topology.dim_latency=3 ns", "machine.network.allocator_iterations",
         NULL},
        {LEVEL("flit") ";machine.network.routing=adaptive", "machine.network.vc_allocator", NULL},
        {LEVEL("loggp"), "machine.noise.background.load", "no links"},
        {LEVEL("link"), "machine.noise.background.load", NULL},
        {LEVEL("link"), "machine.noise.background.message", "noise.background.load is 0"},
        {LEVEL("link") ";machine.noise.background.load=10 %", "machine.noise.background.message",
         NULL},
        {LEVEL("loggp") ";machine.noise.background.load=10 %", "machine.noise.background.message",
         "no links"},
        {"", "machine.price.router", "machines --topology"},
        {"", "machine.floor.pitch", "machines --topology"},
        {"", "machine.software.put.overhead", "validate"},
    };
    CHECK_CASES(cases);
}

/* Prices that one setting switches on; without segments what they could give acts itself. */
static void settings_that_another_one_switches_on(void **state)
{
    (void)state;
    static const struct idle_case cases[] = {
        {"", "machine.node.code.div", "node.code.issue is 0"},
        {"", "machine.node.code.step", "node.code.issue is 0"},
        {"machine.node.code.issue=0.5 cycles", "machine.node.code.div", NULL},
        {"", "machine.software.copy_traffic", "node.model 'rates'"},
        {"machine.node.model=roofline", "machine.software.copy_traffic", NULL},
        {"", "machine.network.collective.latency", "collective.kinds is empty"},
        {"machine.network.collective.kinds=allreduce", "machine.network.collective.latency",
         "no collective is done by 'hardware'"},
        {"", "machine.software.send.overhead", NULL},
        {"", "machine.software.recv.overhead", NULL},
        {"", "machine.software.gap", NULL},
        {"", "machine.software.eager.limit", NULL},
    };
    CHECK_CASES(cases);
}

#define SEGMENTS "machine.software.segments="

static const struct idle_case software_cases[] = {
    {"", "machine.software.kernel.time", "kernel.server is off"},
    {"machine.software.kernel.server=true", "machine.software.kernel.per_byte", NULL},
    {"", "machine.software.short.saving", "short.limit is 0"},
    {"machine.software.short.limit=1 B", "machine.software.short.saving", NULL},
    {"machine.software.short.limit=1 B", "machine.software.short.copy", NULL},
    {"", "machine.software.rendezvous.latency", "unlimited"},
    {"machine.software.eager.limit=0 B", "machine.software.rendezvous.latency", NULL},
    {"", "machine.software.barrier.time", "'hardware'"},
    {"machine.software.barrier.kind=hardware", "machine.software.barrier.time", NULL},
    /* a list takes the place of the limits ... */
    {SEGMENTS "[{from: 0 B}]", "machine.software.eager.limit", "by size"},
    {SEGMENTS "[{from: 0 B}]", "machine.software.eager.copy", "by size"},
    {SEGMENTS "[{from: 0 B}];machine.software.short.limit=8 B", "machine.software.short.saving",
     "by size"},
    /* ... and of a number only where every segment gives it */
    {SEGMENTS "[{from: 0 B, gap: 1 us}]", "machine.software.gap", "every segment"},
    {SEGMENTS "[{from: 0 B, gap: 1 us}]", "machine.software.gap_per_byte", NULL},
    {SEGMENTS "[{from: 0 B, gap: 1 us}, {from: 1 B}]", "machine.software.gap", NULL},
    {SEGMENTS "[{from: 0 B}, {from: 1 B, send.copy: 1 ns/B}]", "machine.software.send.copy", NULL},
    {SEGMENTS "[{from: 0 B, send.copy: 1 ns/B}]", "machine.software.send.copy", "every segment"},
    {SEGMENTS "[{from: 0 B, send.overhead: 0 s}]", "machine.software.send.overhead",
     "every segment"},
    {SEGMENTS "[{from: 0 B, send.overhead: 0 s}]", "machine.software.recv.overhead", NULL},
    {SEGMENTS "[{from: 0 B, recv.overhead: 0 s}]", "machine.software.recv.overhead",
     "every segment"},
    {SEGMENTS "[{from: 0 B, recv.copy: 0 s/B}]", "machine.software.recv.copy", "every segment"},
    {SEGMENTS "[{from: 0 B, gap_per_byte: 0 s/B}]", "machine.software.gap_per_byte",
     "every segment"},
    {SEGMENTS "[{from: 0 B}]", "machine.software.rendezvous.latency", "no segment"},
    {SEGMENTS "[{from: 0 B}, {from: 9 B, protocol: rendezvous}]",
     "machine.software.rendezvous.latency", NULL},
    {SEGMENTS "[{from: 0 B, protocol: synchronous}]", "machine.software.rendezvous.latency", NULL},
    {SEGMENTS "[{from: 0 B, protocol: synchronous, rendezvous.latency: 0 s}]",
     "machine.software.rendezvous.latency", "no segment"},
    /* channels within a node need several processors, then a bandwidth */
    {"", "machine.software.shared.bandwidth", "one processor"},
    {"", "machine.software.shared.latency", "one processor"},
    {"machine.topology.processors_per_node=2", "machine.software.shared.latency",
     "shared.bandwidth is 0"},
    {"machine.topology.processors_per_node=2;machine.software.shared.bandwidth=1 GB/s",
     "machine.software.shared.latency", NULL},
    {"machine.topology.processors_per_node=2", "machine.placement.spread", NULL},
    {"", "machine.placement.spread", "one processor"},
    {"", "machine.placement.seed", "'random'"},
    {"machine.placement.kind=random", "machine.placement.seed", NULL},
    {"machine.placement.kind=random", "machine.placement.list", "'list'"},
    {"machine.placement.kind=list", "machine.placement.list", NULL},
    {"", "machine.software.collectives", "no collective"},
    {"kernel.name=ring", "machine.software.collectives", "no collective"},
    {"kernel.name=scan", "machine.software.collectives", NULL},
    {"kernel.name=barrier", "machine.software.collectives", "no collective"},
    {"kernel.name=message-barrier", "machine.software.collectives", NULL},
};

static void settings_of_message_software(void **state)
{
    (void)state;
    CHECK_CASES(software_cases);
}

#define NAME(word) "kernel.name=" word
#define MODEL(word) "model.generator=" word

static void settings_of_programs(void **state)
{
    (void)state;
    static const struct idle_case cases[] = {
        {NAME("inverse"), "kernel.solver", "solves no system"},
        {NAME("forward"), "kernel.solver", NULL},
        {NAME("dynamics") ";" MODEL("ring"), "kernel.solver", "contracted"},
        {NAME("dynamics") ";" MODEL("polymer"), "kernel.solver", NULL},
        {NAME("dynamics") ";" MODEL("urdf"), "kernel.solver", NULL},
        {NAME("dynamics") ";" MODEL("star"), "kernel.residual", "contracted"},
        {NAME("dynamics"), "kernel.part_solver", "'partition'"},
        {"kernel.solver=partition", "kernel.part_solver", NULL},
        {"kernel.solver=partition", "kernel.hybrid_levels", "'cr-pcr'"},
        {"kernel.solver=cr-pcr", "kernel.hybrid_levels", NULL},
        {"kernel.solver=cr-pcr;" MODEL("comb"), "kernel.hybrid_levels", "contracted"},
        {"", "kernel.step", "kernel.steps is 0"},
        {"kernel.steps=1", "kernel.step", NULL},
        {NAME("ring") ";kernel.steps=1", "kernel.step_size", "only sends messages"},
        {NAME("barrier"), "kernel.message", "a barrier has no size"},
        {NAME("message-barrier"), "kernel.message", "a barrier has no size"},
        {NAME("pingpong"), "kernel.message", NULL},
        {NAME("forward"), "kernel.message", "only the message benchmarks"},
        {NAME("shift"), "kernel.distance", NULL},
        {NAME("pingpong"), "kernel.distance", "'shift'"},
        {NAME("bisection"), "kernel.algorithm", "only collectives"},
        {NAME("allreduce"), "kernel.algorithm", NULL},
        {NAME("allreduce"), "kernel.root", "have a root"},
        {NAME("scatter"), "kernel.root", NULL},
        {NAME("ring"), "kernel.ring_ranks", NULL},
        {NAME("all-to-all"), "kernel.ring_ranks", "'random-ring'"},
        {NAME("ring"), "kernel.precision", "only sends messages"},
        {NAME("ring"), "record.baselines", "no serial code"},
        {NAME("inverse"), "record.baselines", "one serial code"},
        {NAME("dynamics"), "record.baselines", NULL},
        {NAME("ring"), "seed", "no noise"},
        {NAME("random-ring"), "seed", NULL},
        {"", "program.factor", "no program of your own"},
        {"program.file=x.c", "program.factor", NULL},
        {"program.file=x.c", "program.arguments", "programs with main"},
        {"", "program.arguments", "no program of your own"},
    };
    CHECK_CASES(cases);
}

/* Which form composites take matters only where something is scanned along an open chain. */
static void the_form_of_composites(void **state)
{
    (void)state;
    static const struct idle_case cases[] = {
        {"", "kernel.composites_incoming", NULL},
        {MODEL("comb"), "kernel.composites_incoming", "always take incoming"},
        {NAME("forward") ";kernel.formulation=direct;model.rate=0 rad/s",
         "kernel.composites_incoming", "nothing moves, so the direct"},
        {NAME("forward") ";kernel.formulation=direct", "kernel.composites_incoming", NULL},
        {NAME("dynamics") ";kernel.formulation=direct;model.rate=0 rad/s",
         "kernel.composites_incoming", NULL},
        {NAME("forward") ";kernel.formulation=direct;model.rate=0 rad/s;kernel.steps=1",
         "kernel.composites_incoming", NULL},
        {NAME("forward") ";kernel.formulation=direct;model.rate=0 rad/s;kernel.outer_refinements=1",
         "kernel.composites_incoming", NULL},
        {NAME("forward") ";kernel.formulation=paper;model.rate=0 rad/s",
         "kernel.composites_incoming", NULL}, /* gravity */
        {NAME("forward") ";kernel.formulation=paper;model.rate=0 rad/s;model.gravity=[0, 0, 0] "
                         "m/s^2",
         "kernel.composites_incoming", "nothing weighs"},
        {NAME("forward") ";kernel.formulation=paper;model.rate=0 rad/s;model.gravity=[0, 0, 0] "
                         "m/s^2;model.external_force=1 N",
         "kernel.composites_incoming", NULL},
        {NAME("forward") ";kernel.formulation=paper;model.rate=0 rad/s;model.gravity=[0, 0, 0] "
                         "m/s^2;model.base_acceleration.linear=[0, 0, 1] m/s^2",
         "kernel.composites_incoming", "nothing weighs"},
        {NAME("forward") ";kernel.formulation=paper;model.rate=0 rad/s;model.gravity=[0, 0, 0] "
                         "m/s^2;model.base_acceleration.linear=[0, 0, 1] m/s^2;model.base=moving",
         "kernel.composites_incoming", NULL},
        {NAME("forward") ";kernel.formulation=paper;model.rate=0 rad/s;model.gravity=[0, 0, 0] "
                         "m/s^2;model.generator=vector",
         "kernel.composites_incoming", NULL},
    };
    CHECK_CASES(cases);
}

static void settings_of_models(void **state)
{
    (void)state;
    static const struct idle_case cases[] = {
        {NAME("ring"), "model.n", "no model"},
        {MODEL("four-bar"), "model.n", "three moving bodies"},
        {MODEL("urdf"), "model.n", "file says it"},
        {MODEL("vector"), "model.n", "file says it"},
        {MODEL("ring"), "model.n", NULL},
        {MODEL("four-bar"), "model.joint", "a four-bar fixes it"},
        {MODEL("polymer"), "model.joint", "a polymer fixes it"},
        {MODEL("ring"), "model.joint", NULL},
        {MODEL("ring"), "model.axes", "a ring fixes it"},
        {MODEL("star"), "model.axes", NULL},
        {MODEL("vector"), "model.base", "vector file"},
        {MODEL("urdf"), "model.base", NULL},
        {MODEL("urdf"), "model.pose", NULL},
        {MODEL("ring"), "model.pose", "closes it"},
        {MODEL("polymer"), "model.mass", "not rods"},
        {MODEL("four-bar"), "model.mass", NULL},
        {"", "model.mass_ratio", "not 'random'"},
        {"model.inertia=random", "model.mass_ratio", NULL},
        {"model.inertia=random;" MODEL("polymer"), "model.mass_ratio", "polymer"},
        {"", "model.base_acceleration.linear", "not 'moving'"},
        {"model.base=moving", "model.base_acceleration.angular", NULL},
        {NAME("inverse"), "model.torque", "finds the forces itself"},
        {NAME("forward"), "model.torque", NULL},
        {MODEL("vector"), "model.torque", "vector file"},
        {MODEL("ring"), "model.stiffness", "without springs"},
        {MODEL("four-bar"), "model.damping", "without springs"},
        {MODEL("urdf"), "model.stiffness", "file says it"},
        {MODEL("dendrimer"), "model.stiffness", NULL},
        {MODEL("ring"), "model.stabilisation", NULL},
        {"", "model.stabilisation", "loops to stabilise"},
        {MODEL("comb"), "model.branch", NULL},
        {MODEL("dendrimer"), "model.branch", NULL},
        {MODEL("random-tree"), "model.branch", "only a comb"},
        {"", "model.path", "without a file"},
        {MODEL("urdf"), "model.path", NULL},
    };
    CHECK_CASES(cases);
}

/* A person's own program has none of the settings of built-in ones, whatever its name is. */
static void own_programs(void **state)
{
    (void)state;
    static const char *const idle[] = {
        "kernel.solver",    "kernel.formulation", "kernel.message", "kernel.repeat", "kernel.root",
        "kernel.algorithm", "kernel.precision",   "model.n",        "model.gravity"};
    struct run_spec run;
    make_run(&run, NAME("allreduce") ";program.file=x.c");
    run.kernel.own = true;
    for (size_t i = 0; i < sizeof idle / sizeof *idle; i++) {
        const struct field_table *t;
        const struct field *f = field_find_full(idle[i], &t);
        assert_non_null(f);
        const char *why = f->idle(&run);
        if (why == NULL || strstr(why, "only built-in programs") == NULL)
            fail_msg("%s: %s", idle[i], why ? why : "acts");
    }
    assert_false(kernel_spec_has(&run.kernel, PROGRAM_COLLECTIVE));
    assert_false(kernel_spec_needs_model(&run.kernel));
    /* arguments and costs depend on its kind */
    const struct field_table *t;
    field_idle_fn *arguments = field_find_full("program.arguments", &t)->idle,
                  *cost = field_find_full("program.cost", &t)->idle;
    run.program.kind = PROGRAM_MPI;
    assert_null(arguments(&run));
    assert_null(cost(&run));
    run.program.kind = PROGRAM_SCHEDULE;
    assert_non_null(arguments(&run));
    assert_non_null(strstr(cost(&run), "schedule"));
    run.program.kind = PROGRAM_KERNEL;
    assert_non_null(arguments(&run));
    assert_null(cost(&run));
}

/* The run's own seed is used where something is drawn from it, and there alone. */
static void what_makes_repetitions_differ(void **state)
{
    (void)state;
    static const struct {
        const char *changes;
        bool random;
    } cases[] = {
        {"", false},
        {"machine.noise.compute=1 %", true},
        {LEVEL("link") ";machine.noise.background.load=1 %", true},
        {LEVEL("loggp") ";machine.noise.background.load=1 %", false},
        {FAMILY("fat-tree") ";machine.topology.routing=valiant", true},
        {FAMILY("torus") ";machine.topology.routing=valiant", false},
        {FAMILY("torus") ";machine.topology.tie=random", true},
        {FAMILY("mesh") ";machine.topology.tie=random", false},
        {FAMILY("torus") ";" LEVEL("flit") ";machine.network.routing=valiant", true},
        {FAMILY("random-regular") ";machine.topology.seed=9", false},
        {"machine.placement.kind=random", false},
        {NAME("random-ring"), true},
        {MODEL("random-tree") ";model.seed=4", false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct run_spec run;
        make_run(&run, cases[i].changes);
        if (run_spec_is_random(&run) != cases[i].random)
            fail_msg("[%s]: expected %s", cases[i].changes, cases[i].random ? "random" : "not");
    }
}

/* No repetition of one seed is a run of another: no two of a square of seeds and repetitions. */
static void seeds_of_repetitions_differ(void **state)
{
    (void)state;
    enum { SIDE = 40 };
    uint64_t seen[SIDE * SIDE];
    struct run_spec run;
    make_run(&run, "");
    for (int i = 0; i < SIDE * SIDE; i++) {
        run.seed = (uint64_t)(i / SIDE);
        run.rep = i % SIDE;
        seen[i] = run_spec_seed(&run);
        assert_true(seen[i] == run_spec_seed(&run));
        for (int j = 0; j < i; j++)
            if (seen[i] == seen[j]) fail_msg("runs %d and %d have one seed", i, j);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(settings_that_another_one_switches_on),
        cmocka_unit_test(settings_of_topologies),
        cmocka_unit_test(settings_of_network_levels),
        cmocka_unit_test(settings_of_message_software),
        cmocka_unit_test(settings_of_programs),
        cmocka_unit_test(the_form_of_composites),
        cmocka_unit_test(settings_of_models),
        cmocka_unit_test(own_programs),
        cmocka_unit_test(what_makes_repetitions_differ),
        cmocka_unit_test(seeds_of_repetitions_differ),
    };
    return cmocka_run_group_tests(tests, make_arena, drop_arena);
}
