/* test_run.c - one run: accounted for to the picosecond, held against serial answers, refused when
 * it is wrong. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/check.h"
#include "base/random.h"
#include "dynamics/dynamics_table.h"
#include "dynamics/system.h"
#include "kernel/dynamics_program.h"
#include "kernel/kernel.h"
#include "measure/run_heartbeat.h"
#include "model/model.h"
#include "plan/plan.h"
#include "run/launch.h"
#include "run/run.h"

#include "../support/last_words.h"

enum { MOST_SETTINGS = 12 };

/* The only run of the benchmark scenario with these settings, "key=value", ended by NULL. */
static struct run_spec spec_with(struct plan *p, const char *const *setting)
{
    struct plan_options o = {.set = setting};
    struct err e;
    err_clear(&e);
    while (setting[o.nset]) o.nset++;
    if (!plan_read(p, MIMDSIM_SRCDIR "/scenarios/speedup-t3e.yaml", &o, &e)) fail_msg("%s", e.text);
    return p->run[0];
}

#define SPEC(p, ...) spec_with((p), (const char *const[MOST_SETTINGS]){__VA_ARGS__, NULL})

static struct run_result run(const struct run_spec *spec, struct arena *a)
{
    struct run_result r;
    struct err e;
    err_clear(&e);
    if (!run_one(spec, a, &r, &e)) fail_msg("%s", e.text);
    return r;
}

static void expect_accounted(const struct run_result *r)
{
    int64_t messages = 0;
    assert_true(r->makespan_ps > 0);
    for (int rank = 0; rank < r->nrank; rank++) {
        int64_t sum = 0;
        for (int stage = 0; stage < r->nstage; stage++) {
            const struct stage_time *t = &r->stage[(int64_t)rank * r->nstage + stage];
            assert_true(t->compute_ps >= 0 && t->send_ps >= 0 && t->recv_ps >= 0);
            assert_true(t->wait_ps >= 0 && t->contention_ps >= 0);
            sum += t->compute_ps + t->send_ps + t->recv_ps + t->wait_ps + t->contention_ps;
            messages += t->messages;
        }
        assert_true(sum == r->makespan_ps);
        assert_true(r->finish_ps[rank] <= r->makespan_ps);
    }
    assert_true(messages == r->messages && messages > 0);
}

static void every_level_accounts_for_every_picosecond(void **unused)
{
    (void)unused;
    static const char *const level[] = {"level=loggp", "level=link", "level=packet", "level=flit",
                                        "level=auto"};
    for (int i = 0; i < 5; i++) {
        for (int n = 6; n <= 13; n += 7) {
            char bodies[16];
            struct plan p;
            snprintf(bodies, sizeof bodies, "n=%d", n);
            struct run_spec spec = SPEC(&p, level[i], bodies);
            struct arena *a = arena_create();
            struct run_result r = run(&spec, a), again = run(&spec, a);
            assert_int_equal(r.status, RUN_OK);
            assert_int_equal(r.nrank, n);
            expect_accounted(&r);
            assert_true(r.digest == again.digest && r.makespan_ps == again.makespan_ps);
            arena_destroy(a);
            plan_free(&p);
        }
    }
}

static void contention_is_never_charged_without_links(void **unused)
{
    (void)unused;
    struct plan p;
    struct run_spec spec = SPEC(&p, "level=loggp", "n=16");
    struct arena *a = arena_create();
    struct run_result r = run(&spec, a);
    for (int i = 0; i < r.nrank * r.nstage; i++) assert_int_equal(r.stage[i].contention_ps, 0);
    arena_destroy(a);
    plan_free(&p);
}

/* A run with the answers of the serial programs, to be spoilt. */
static void serial_run(const struct run_spec *spec, struct run_cache *cache, struct arena *a,
                       struct program_run *r)
{
    struct err e;
    err_clear(&e);
    assert_true(run_open(spec, NULL, cache, a, r, &e) && r->type->prepare(r, a, &e));
    const struct kernel_job *job = &dynamics_run_of(r)->job;
    struct work w = {0};
    const struct dynamics_type *t = dynamics_type_of(PRECISION_DOUBLE);
    t->inverse(job->model, job->state, a, program_output(r, OUTPUT_TAU), &w);
    assert_true(t->forward(job->model, job->state, FORWARD_CRBA, a, program_output(r, OUTPUT_QDD),
                           NULL, NULL, &w));
}

static struct run_result checked(struct program_run *run, struct arena *a)
{
    struct run_result r = {.status = RUN_OK};
    run->type->check(run, a, &r);
    return r;
}

static void a_wrong_number_makes_the_run_invalid(void **unused)
{
    (void)unused;
    struct plan p;
    struct run_spec spec = SPEC(&p, "level=loggp", "n=12");
    struct arena *a = arena_create();
    struct run_cache *cache = run_cache_create();
    struct program_run run;
    serial_run(&spec, cache, a, &run);
    double *qdd = program_output(&run, OUTPUT_QDD), *tau = program_output(&run, OUTPUT_TAU);
    struct run_result r = checked(&run, a);
    assert_int_equal(r.status, RUN_OK);
    assert_int_equal(r.nerror, 2);
    assert_true(r.error[1].relative > 0 && r.error[1].relative < 1e-10); /* CRBA beside ABA */
    for (int i = 0; i < 12; i++) {
        double good = qdd[i], good_tau = tau[i], largest = 0;
        for (int k = 0; k < 12; k++) largest = fmax(largest, fabs(qdd[k]));
        qdd[i] += 1e-6 * largest;
        r = checked(&run, a);
        assert_int_equal(r.status, RUN_INVALID);
        assert_non_null(strstr(r.text, "qdd differs from aba"));
        assert_true(fabs(r.error[1].relative / 1e-6 - 1) < 1e-3);
        qdd[i] = NAN;
        assert_int_equal(checked(&run, a).status, RUN_INVALID);
        qdd[i] = good;
        tau[i] = -2 * good_tau - 1;
        r = checked(&run, a);
        assert_int_equal(r.status, RUN_INVALID);
        assert_non_null(strstr(r.text, "tau differs from rnea"));
        tau[i] = good_tau;
    }
    run_cache_destroy(cache);
    arena_destroy(a);
    plan_free(&p);
}

static void rounding_beyond_the_tolerance_makes_a_real_run_invalid(void **unused)
{
    (void)unused;
    struct plan p;
    struct run_spec spec = SPEC(&p, "level=loggp", "n=128", "kernel.precision=float",
                                "kernel.formulation=paper", "kernel.refinement=as-given");
    struct arena *a = arena_create();
    struct run_result r = run(&spec, a);
    assert_int_equal(r.status, RUN_INVALID);
    assert_non_null(strstr(r.text, "differs from"));
    expect_accounted(&r);
    plan_free(&p);
    spec = SPEC(&p, "level=loggp", "n=128", "kernel.precision=quad", "kernel.formulation=paper");
    r = run(&spec, a);
    assert_int_equal(r.status, RUN_OK);
    assert_true(r.error[1].relative < 1e-11);
    arena_destroy(a);
    plan_free(&p);
}

/* Masses of a wide range spoil parallel cyclic reduction; the residual tells it, and one refinement
 * repairs it. */
static void refinement_is_switched_on_where_the_residual_asks_for_it(void **unused)
{
    (void)unused;
    struct plan p;
    struct run_spec spec =
        SPEC(&p, "level=loggp", "n=64", "kernel.name=forward", "kernel.formulation=direct",
             "model.inertia=random", "model.mass_ratio=1e6", "kernel.refinement=as-given");
    struct arena *a = arena_create();
    const struct run_result plain = run(&spec, a);
    spec.kernel.refinement = REFINEMENT_AS_NEEDED;
    const struct run_result mended = run(&spec, a);
    spec.kernel.refinement = REFINEMENT_AS_GIVEN;
    spec.kernel.inner_refinements = 1;
    const struct run_result asked = run(&spec, a);
    assert_int_equal(plain.status, RUN_INVALID);
    assert_true(plain.inner_added == 0 && plain.residual > 1e-9);
    assert_int_equal(mended.status, RUN_OK);
    assert_true(mended.inner_added == 1 && mended.outer_added == 0);
    assert_true(mended.residual_before == plain.residual && mended.residual < 1e-10);
    assert_true(mended.error[0].relative < 1e-3 * plain.error[0].relative);
    /* the machine pays for it, exactly as if it had been asked for */
    assert_true(mended.makespan_ps > plain.makespan_ps && mended.makespan_ps == asked.makespan_ps);
    assert_true(mended.digest == asked.digest);
    arena_destroy(a);
    plan_free(&p);
}

static void nothing_is_refined_that_is_good_enough_or_keeps_no_factors(void **unused)
{
    (void)unused;
    struct plan p;
    struct arena *a = arena_create();
    struct run_spec spec = SPEC(&p, "level=loggp", "n=64", "kernel.name=forward");
    struct run_result r = run(&spec, a);
    assert_true(r.status == RUN_OK && r.inner_added + r.outer_added == 0);
    plan_free(&p);
    spec = SPEC(&p, "level=loggp", "n=64", "kernel.name=forward", "kernel.solver=pcr",
                "model.inertia=random", "model.mass_ratio=1e8");
    r = run(&spec, a);
    assert_true(r.status == RUN_INVALID && r.inner_added + r.outer_added == 0);
    plan_free(&p);
    /* where refining does not help, the answer as given is what is told, and that it is none */
    spec = SPEC(&p, "level=loggp", "n=64", "kernel.name=forward", "model.inertia=random",
                "model.mass_ratio=1e12");
    r = run(&spec, a);
    assert_true(r.status == RUN_INVALID && r.residual > 1e-3);
    assert_non_null(strstr(r.text, "not to be trusted"));
    plan_free(&p);
    /* the direct form has a further way: forces and residual in twice the digits */
    spec = SPEC(&p, "level=loggp", "n=64", "kernel.name=forward", "model.inertia=random",
                "model.mass_ratio=1e12", "kernel.formulation=direct");
    r = run(&spec, a);
    assert_true(r.status == RUN_OK && r.twice_added && r.inner_added == 4 &&
                r.residual_before > 0.1);
    assert_true(r.error[0].relative < 1e-9);
    plan_free(&p);
    arena_destroy(a);
}

/* What a tree's linearly implicit steps cannot have is neither tried nor named as a way out; what
 * is refined in vain is told as it was given. */
static void implicit_steps_of_trees_are_refined_from_outside(void **unused)
{
    (void)unused;
    struct plan p;
    struct arena *a = arena_create();
    struct run_spec spec = SPEC(&p, "level=link", "n=16", "ranks=4", "model.generator=random-tree",
                                "model.inertia=random", "model.mass_ratio=1e12",
                                "model.stiffness=1e6 N m/rad",
                                "kernel.name=forward", "kernel.formulation=direct",
                                "kernel.steps=2",
                                "kernel.step=linearly-implicit");
    struct run_result r = run(&spec, a);
    assert_int_equal(r.status, RUN_OK);
    assert_true(run_result_refined(&r) && r.inner_added == 0 && r.residual < r.residual_before);
    spec.model.seed = 5;
    r = run(&spec, a);
    assert_int_equal(r.status, RUN_INVALID);
    assert_true(!run_result_refined(&r) && r.residual == r.residual_before);
    assert_null(strstr(r.text, "refinements"));
    arena_destroy(a);
    plan_free(&p);
}

/* The residual of either formulation tells the error of its answer to within two decades and never
 * hides it. */
static void the_residual_tells_the_error(void **unused)
{
    (void)unused;
    static const char *const formulation[] = {"kernel.formulation=paper",
                                              "kernel.formulation=direct"};
    static const char *const ratio[] = {"model.mass_ratio=1", "model.mass_ratio=1e4",
                                        "model.mass_ratio=1e6", "model.mass_ratio=1e8"};
    struct arena *a = arena_create();
    for (int f = 0; f < 2; f++)
        for (int k = 0; k < 4; k++) {
            struct plan p;
            struct run_spec spec =
                SPEC(&p, "level=loggp", "n=64", "kernel.name=forward", formulation[f],
                     "model.inertia=random", ratio[k], "kernel.refinement=as-given");
            const struct run_result r = run(&spec, a);
            const double error = r.error[0].relative;
            assert_true(r.residual > 0.1 * error && r.residual < 100 * error + 1e-12);
            plan_free(&p);
        }
    arena_destroy(a);
}

static const struct baseline *baseline_of(const struct run_result *r, const char *name)
{
    for (int i = 0; i < r->nbaseline; i++)
        if (strcmp(r->baseline[i].name, name) == 0) return &r->baseline[i];
    fail_msg("no baseline '%s'", name);
    return NULL;
}

static void baselines_are_all_the_work_and_the_fastest_of_the_serial_codes(void **unused)
{
    (void)unused;
    static const char *const serial[] = {"rnea+aba", "rnea+crba", "rnea+cfa-paper",
                                         "rnea+cfa-direct"};
    struct plan p;
    struct run_spec spec = SPEC(&p, "level=loggp", "n=24");
    struct arena *a = arena_create();
    struct run_result r = run(&spec, a);
    struct work all = {0};
    for (int i = 0; i < r.nrank * r.nstage; i++) work_add(&all, &r.stage[i].work);
    const struct baseline *itself = baseline_of(&r, "parallel code on one processor");
    assert_memory_equal(&itself->work, &all, sizeof all);
    int64_t fastest = INT64_MAX;
    for (int i = 0; i < 4; i++) {
        const struct baseline *b = baseline_of(&r, serial[i]);
        if (b->time_ps < fastest) fastest = b->time_ps;
    }
    assert_true(baseline_of(&r, "fastest serial")->time_ps == fastest);
    assert_true(baseline_of(&r, "rnea")->time_ps < fastest && fastest < itself->time_ps);
    arena_destroy(a);
    plan_free(&p);
}

static void near(const char *what, double estimated, double counted)
{
    if (fabs(estimated - counted) > 0.2 * counted)
        fail_msg("%s: estimated %g, counted %g", what, estimated, counted);
}

static void estimates_are_within_a_fifth_of_what_is_counted(void **unused)
{
    (void)unused;
    static const char *const points[][3] = {{"n=3"},
                                            {"n=16"},
                                            {"n=45"},
                                            {"n=128"},
                                            {"n=96", "ranks=12"},
                                            {"n=32", "kernel.formulation=direct"},
                                            {"n=32", "kernel=inverse"},
                                            {"n=32", "kernel=forward"}};
    for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
        struct plan p;
        struct run_spec spec =
            SPEC(&p, "level=loggp", points[i][0], points[i][1] ? points[i][1] : "seed=1");
        struct arena *a = arena_create();
        struct run_result r = run(&spec, a);
        struct run_estimate x;
        struct err e;
        err_clear(&e);
        int64_t work = RUN_EXPLAIN_WORK;
        assert_true(run_explain(&spec, &work, &x, &e));
        double flops = 0;
        for (int k = 0; k < r.nrank * r.nstage; k++) flops += (double)r.stage[k].work.flop;
        near("messages", x.messages, (double)r.messages);
        near("bytes", x.bytes, (double)r.bytes);
        near("flops", x.flops, flops);
        assert_int_equal(x.nbody, spec.model.nbody);
        arena_destroy(a);
        plan_free(&p);
    }
}

static void what_cannot_run_is_refused(void **unused)
{
    (void)unused;
    struct plan p;
    struct run_spec spec = SPEC(&p, "level=loggp", "n=4");
    struct arena *a = arena_create();
    struct run_result r;
    struct err e;
    err_clear(&e);
    spec.nrank = 5;
    assert_false(run_one(&spec, a, &r, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    assert_non_null(strstr(e.text, "5 ranks for 4 bodies"));
    err_clear(&e);
    spec.nrank = 4;
    strcpy(spec.kernel.name, "dynamo");
    assert_false(run_one(&spec, a, &r, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    assert_non_null(strstr(e.text, "dynamo"));
    arena_destroy(a);
    plan_free(&p);
}

/* Called from within a run, as progress is. */
static void fail_a_check(void *context)
{
    CHECK(context == NULL && "planted");
}

/* What words_of calls has no arguments. */
static struct run_spec failing;
static struct run_order failing_order;
static void run_failing(void)
{
    struct run_result r;
    struct err e = {0};
    run_sharing(&failing, &failing_order, run_cache_create(), arena_create(), &r, &e);
}

static void a_failed_check_says_in_which_run(void **unused)
{
    (void)unused;
    struct plan p;
    struct run_heartbeat heartbeat = {.beat = fail_a_check, .context = &heartbeat};
    char text[2048];
    failing = SPEC(&p, "level=link", "n=128", "seed=7");
    failing_order = (struct run_order){.heartbeat = &heartbeat};
    expect_abort(run_failing, text, sizeof text);
    assert_non_null(strstr(text, "planted"));
    assert_non_null(strstr(text, "kernel dynamics, n = 128, 128 ranks"));
    assert_non_null(strstr(text, "seed 7"));
    plan_free(&p);
}

/* On packed stacks the depth is known to the word; with whole pages this build has none. Workspace
 * and calls of a rank may go no deeper than the program promises. Returns how much was left, -1:
 * not known. */
static int64_t left_below(const char *machine, const char *const *set, int threads)
{
    struct plan p;
    struct plan_options o = {.machine = machine, .set = set};
    struct err e;
    err_clear(&e);
    while (set[o.nset]) o.nset++;
    /* not all settings go with each machine */
    if (!plan_read(&p, MIMDSIM_SRCDIR "/scenarios/speedup-t3e.yaml", &o, &e)) return -1;
    const struct run_spec spec = p.run[0];
    struct run_cache *cache = run_cache_create();
    struct arena *a = arena_create(), *own = arena_create(), *scratch = arena_create();
    struct program_run r = {.spec = spec};
    if (!run_open(&spec, NULL, cache, own, &r, &e) || !r.type->prepare(&r, scratch, &e))
        fail_msg("%s: %s", machine, e.text);
    int64_t most = 0;
    for (int64_t k = 0, bytes; k < spec.nrank; k++)
        if ((bytes = (int64_t)r.rank->workspace_bytes(r.job, (int)k)) > most) most = bytes;
    const int64_t deepest = r.rank->deepest(r.job);
    struct run_result out;
    const struct run_order order = {.threads = threads};
    const bool made = run_sharing(&spec, &order, cache, a, &out, &e);
    const bool shared = r.rank->depth > 0 && most + r.rank->depth <= 4096;
    const bool formula = spec.machine.network.level == LEVEL_LOGGP &&
                         spec.machine.topology.family == TOPOLOGY_TORUS;
    const int64_t bound =
        deepest + (shared ? most : 0) + (formula ? 0 : LAUNCH_WAY_DEPTH) +
        (out.threads > 1 ? LAUNCH_THREADS_DEPTH : 0);
    run_close(&r);
    arena_destroy(own), arena_destroy(scratch), arena_destroy(a);
    run_cache_destroy(cache);
    plan_free(&p);
    return !made || deepest == 0 || out.stack_peak_bytes % 4096 == 0 ? -1
                                                                     : bound - out.stack_peak_bytes;
}

/* One of those that end with NULL. */
static const char *one_of(struct random *r, const char *const *choice)
{
    uint64_t n = 0;
    while (choice[n]) n++;
    return choice[random_below(r, n)];
}

static void ranks_go_no_deeper_than_their_program_promises(void **unused)
{
    (void)unused;
#define ANY(...) one_of(&r, (const char *const[]){__VA_ARGS__, NULL})
    static const char *const kernel[] = {"kernel.name=inverse", "kernel.name=forward",
                                         "kernel.name=dynamics"};
    struct random r = random_make(20261129, 1, 0);
    int64_t least[3] = {4096, 4096, 4096};
    int known[3] = {0};
    for (int trial = 0; trial < 600; trial++) {
        const int k = trial % 3,
                  extra = (int)random_below(&r, 4);
        const char *machine = ANY("t3e-300", "t3e-300", "bluegene-q", "cm-5", "infiniband-hdr",
                                  "slingshot-11", "what-if-dragonfly", "what-if-hyperx",
                                  "what-if-slim-fly", "what-if-random", "ncube-2", "origin2000",
                                  "t3e-300-shmem-adaptive", "paragon", "ideal");
        const char *set[MOST_SETTINGS] = {
            ANY("level=loggp", "level=link"),
            strcmp(machine, "t3e-300") == 0 ? ANY("n=2", "n=17", "n=64") : ANY("n=3", "n=16"),
            ANY("model.joint=revolute", "model.joint=mixed", "model.joint=helical",
                "model.joint=universal", "model.joint=spherical", "model.base=floating",
                "model.rate=0 rad/s"),
            kernel[k],
            ANY("machine.software.eager.limit=0 B", "machine.noise.compute=5 %",
                "machine.noise.background.load=10 %", "machine.software.offload=copies",
                "machine.software.offload=none", "machine.software.kernel.server=true",
                "record.links=true", "record.links=false", "record.spans=true")};
        int n = 5;
        if (k > 0) {
            const char *solver = ANY("kernel.solver=pcr-symmetric", "kernel.solver=cr",
                                     "kernel.solver=thomas", "kernel.solver=cr-pcr",
                                     "kernel.solver=pcr");
            set[n++] = solver;
            set[n++] = ANY("kernel.formulation=paper", "kernel.formulation=direct");
            /* the textbook's reduction keeps no factors to refine with */
            if (extra == 0) set[n++] = "kernel.composites_incoming=true";
            if (extra == 1 && strcmp(solver, "kernel.solver=pcr") != 0)
                set[n++] = "kernel.outer_refinements=2";
            if (extra == 2) {
                set[n++] = "kernel.steps=2";
                set[n++] = ANY("kernel.step=semi-implicit", "kernel.step=rk4", "kernel.step=kdk");
            }
        }
        const int64_t left = left_below(machine, set, 1 + (int)random_below(&r, 3));
        if (left >= 0) known[k]++;
        if (left >= 0 && left < least[k]) least[k] = left;
        if (left < -1) {
            for (int i = 0; i < n; i++) print_message("%s ", set[i]);
            fail_msg("%s: %lld bytes deeper", machine, (long long)-left);
        }
    }
    print_message("bytes left by inverse, forward, dynamics: %lld %lld %lld (of %d %d %d runs)\n",
                  (long long)least[0], (long long)least[1], (long long)least[2], known[0],
                  known[1], known[2]);
#undef ANY
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_level_accounts_for_every_picosecond),
        cmocka_unit_test(contention_is_never_charged_without_links),
        cmocka_unit_test(a_wrong_number_makes_the_run_invalid),
        cmocka_unit_test(rounding_beyond_the_tolerance_makes_a_real_run_invalid),
        cmocka_unit_test(refinement_is_switched_on_where_the_residual_asks_for_it),
        cmocka_unit_test(nothing_is_refined_that_is_good_enough_or_keeps_no_factors),
        cmocka_unit_test(implicit_steps_of_trees_are_refined_from_outside),
        cmocka_unit_test(the_residual_tells_the_error),
        cmocka_unit_test(baselines_are_all_the_work_and_the_fastest_of_the_serial_codes),
        cmocka_unit_test(estimates_are_within_a_fifth_of_what_is_counted),
        cmocka_unit_test(what_cannot_run_is_refused),
        cmocka_unit_test(a_failed_check_says_in_which_run),
        cmocka_unit_test(ranks_go_no_deeper_than_their_program_promises),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
