/* test_accuracy.c - ladders find planted errors, choose by arithmetic, and omissions change no
 * result. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "base/random.h"
#include "kernel/dynamics_program.h"
#include "kernel/trust.h"
#include "plan/plan.h"
#include "run/run.h"
#include "study/accuracy_ladder.h"
#include "study/stability_scene.h"
#include "study/trial.h"

static struct run_spec chain_spec(int n, int nrank)
{
    struct run_spec s = {
        .scenario = "test", .nrank = nrank, .seed = 1, .machine = trial_machine(nrank)};
    s.model = (struct model_spec){.generator = MODEL_SERIAL_CHAIN,
                                  .nbody = n,
                                  .joint = JOINT_REVOLUTE,
                                  .pose = POSE_COILED,
                                  .axes = AXES_TWISTED,
                                  .length = 1,
                                  .radius = 0.05,
                                  .mass = 1,
                                  .mass_ratio = 1,
                                  .gravity = {0, 0, -9.81},
                                  .rate = 1,
                                  .torque = 1,
                                  .seed = 1};
    s.kernel = (struct kernel_spec){.name = "forward",
                                    .formulation = FORMULATION_DIRECT,
                                    .composites_incoming = true,
                                    .solver = SOLVER_PCR_SYMMETRIC,
                                    .hybrid_levels = 1};
    return s;
}

static void a_planted_error_is_found(void **state)
{
    (void)state;
    const double right[4] = {1, -8, 2, 0};
    for (double planted = 1e-15; planted < 1; planted *= 10) {
        double x[4] = {1, -8 * (1 + planted), 2, 0};
        assert_true(fabs(trial_error(x, right, 4) / planted - 1) < 0.2);
    }
    const double none[4] = {1, NAN, 2, 0};
    assert_true(isinf(trial_error(none, right, 4)));
    assert_true(trial_error(right, right, 4) == 0);
}

static struct accuracy_rung *plant(struct ladder *l, const char *rung, double error, int64_t cost)
{
    struct accuracy_rung *r = ladder_add(l, "method", rung, "qdd", "reference");
    assert_int_equal(r->status, RUNG_FAILED);
    ladder_grade(r, error, 1e-2, 1e-1);
    r->machine_ps = cost;
    return r;
}

static void the_cheapest_good_enough_rung_is_chosen(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct accuracy_report report = {.arena = a};
    struct ladder l = {.report = &report, .name = "arithmetic", .at = "n=1"};
    plant(&l, "fine and dear", 1e-15, 1000);
    plant(&l, "good", 1e-8, 100);
    plant(&l, "coarse", 1e-3, 10);
    plant(&l, "no number", NAN, 1);
    plant(&l, "poor", 5e-2, 2);
    plant(&l, "no price", 1e-20, -1);
    assert_int_equal(report.rung[3].status, RUNG_FAILED);
    assert_int_equal(report.rung[4].status, RUNG_DEGRADED);
    struct accuracy_choice c = accuracy_choose(&report, "arithmetic", "qdd", 1e-6);
    assert_string_equal(c.rung->rung, "good");
    assert_string_equal(c.finest->rung, "fine and dear");
    assert_true(c.cost_ratio == 10);
    assert_string_equal(accuracy_choose(&report, "arithmetic", "qdd", 1e-2).rung->rung, "coarse");
    assert_null(accuracy_choose(&report, "arithmetic", "qdd", 1e-16).rung);
    assert_null(accuracy_choose(&report, "network", "makespan", 1).rung);
    arena_destroy(a);
}

static double error_of(const struct accuracy_report *r, const char *ladder, const char *method,
                       const char *rung)
{
    for (int i = 0; i < r->nrung; i++)
        if (strcmp(r->rung[i].ladder, ladder) == 0 && strcmp(r->rung[i].method, method) == 0 &&
            strcmp(r->rung[i].rung, rung) == 0)
            return r->rung[i].error;
    fail_msg("no rung %s %s %s", ladder, method, rung);
    return NAN;
}

/* The order of a method is what is known of its error beforehand: four times the steps, 4 and 16
 * times less of it. */
static void ladders_show_the_errors_that_theory_knows(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct accuracy_report r;
    struct err e;
    err_clear(&e);
    struct run_spec spec = chain_spec(5, 5);
    struct plan_options o = {0};
    assert_true(plan_machine(&spec.machine, MIMDSIM_SRCDIR "/machines/t3e-300.yaml", &o, a, NULL,
                             NULL, &e));
    assert_true(accuracy_measure(&spec, 1, 0, true, a, &r, &e));
    double one = error_of(&r, "integration", "own semi-implicit", "256 steps") /
                 error_of(&r, "integration", "own semi-implicit", "1024 steps");
    double two = error_of(&r, "integration", "own kdk", "256 steps") /
                 error_of(&r, "integration", "own kdk", "1024 steps");
    assert_true(one > 3.5 && one < 4.5);
    assert_true(two > 14 && two < 18);
    double single = error_of(&r, "arithmetic", "serial aba", "float");
    assert_true(single > 1e-9 && single < 1e-4);
    assert_true(error_of(&r, "arithmetic", "serial aba", "double") < 1e-13);
    assert_true(error_of(&r, "arithmetic", "serial cfa-direct", "quad") < 1e-15);
    assert_true(error_of(&r, "network", "auto", "auto") ==
                error_of(&r, "network", "packet", "packet"));
    assert_int_equal(r.nchoice, 3);
    /* in two parts, of which the second may be made elsewhere: the same rungs in the same order */
    struct accuracy_report parts, programs;
    assert_true(accuracy_network(&spec, 1, a, &parts, &e));
    assert_true(accuracy_programs(&spec, 1, a, &programs, &e));
    assert_int_equal(parts.nchoice + programs.nchoice, 0);
    accuracy_append(&parts, programs.rung, programs.nrung);
    accuracy_decide(&parts, 0);
    assert_int_equal(parts.nrung, r.nrung);
    for (int i = 0; i < r.nrung; i++) {
        assert_string_equal(parts.rung[i].rung, r.rung[i].rung);
        assert_memory_equal(&parts.rung[i].error, &r.rung[i].error, sizeof r.rung[i].error);
    }
    assert_int_equal(parts.nchoice, 3);
    for (int k = 1; k < 3; k++)
        assert_int_equal(parts.choice[k].rung - parts.rung, r.choice[k].rung - r.rung);
    arena_destroy(a);
}

/* Chains, trees and loops of any kind. */
static struct run_spec random_spec(uint64_t seed, const struct machine_spec *machine)
{
    static const enum model_generator generator[] = {MODEL_SERIAL_CHAIN, MODEL_RANDOM_TREE,
                                                     MODEL_RING, MODEL_COMB};
    static const enum network_level level[] = {LEVEL_LOGGP, LEVEL_LINK, LEVEL_PACKET, LEVEL_AUTO};
    static const enum model_joint joint[] = {JOINT_REVOLUTE, JOINT_SPHERICAL, JOINT_PRISMATIC};
    struct random r = random_make(seed, 7, 0);
    int n = 3 + (int)random_below(&r, 14);
    struct run_spec s = chain_spec(n, 1 + (int)random_below(&r, (uint64_t)n));
    s.machine = *machine;
    s.machine.network.level = level[random_below(&r, 4)];
    s.model.generator = generator[random_below(&r, 4)];
    s.model.joint = s.model.generator == MODEL_RING ? JOINT_REVOLUTE : joint[random_below(&r, 3)];
    s.model.base =
        s.model.generator != MODEL_RING && random_below(&r, 2) ? BASE_FLOATING : BASE_FIXED;
    s.model.branch = 2;
    s.model.seed = seed;
    memcpy(s.kernel.name, "dynamics", sizeof "dynamics");
    return s;
}

static void run(const struct run_spec *s, unsigned keep, struct arena *a, struct run_result *out)
{
    struct run_cache *cache = run_cache_create();
    const struct run_order order = {.keep = keep};
    struct err e;
    err_clear(&e);
    if (!run_sharing(s, &order, cache, a, out, &e)) fail_msg("%s", e.text);
    run_cache_destroy(cache);
}

/* To the picosecond, of every stage of every rank. */
static void same_times(const struct run_result *x, const struct run_result *y)
{
    assert_int_equal(x->makespan_ps, y->makespan_ps);
    assert_int_equal(x->messages, y->messages);
    for (int i = 0; i < x->nrank; i++) assert_int_equal(x->finish_ps[i], y->finish_ps[i]);
    for (int i = 0; i < x->nrank * x->nstage; i++) {
        assert_int_equal(x->stage[i].compute_ps, y->stage[i].compute_ps);
        assert_int_equal(x->stage[i].send_ps, y->stage[i].send_ps);
        assert_int_equal(x->stage[i].recv_ps, y->stage[i].recv_ps);
        assert_int_equal(x->stage[i].wait_ps + x->stage[i].contention_ps,
                         y->stage[i].wait_ps + y->stage[i].contention_ps);
    }
}

/* What the simulator leaves out; what the kernels do: test_omission.c. */
static void nothing_left_out_changes_a_result(void **state)
{
    (void)state;
    const unsigned host =
        KEEP_START_EVENTS | KEEP_SPANS | KEEP_LINKS | KEEP_BASELINE | KEEP_CONTENTION;
    struct machine_spec machine;
    struct plan_options o = {0};
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    assert_true(
        plan_machine(&machine, MIMDSIM_SRCDIR "/machines/t3e-300.yaml", &o, a, NULL, NULL, &e));
    int recorded = 0;
    for (uint64_t seed = 1; seed <= 40; seed++) {
        struct run_spec s = random_spec(seed, &machine);
        struct run_result without, with, loaded;
        run(&s, 0, a, &without);
        run(&s, host, a, &with);
        same_times(&with, &without);
        /* adding zero forces takes the machine time, but changes no number */
        run(&s, host | KEEP_EXTERNAL, a, &loaded);
        assert_int_equal(loaded.status, without.status);
        assert_int_equal(loaded.nerror, without.nerror);
        for (int i = 0; i < without.nerror; i++)
            assert_true(loaded.error[i].relative == without.error[i].relative);
        assert_true(loaded.residual == without.residual && loaded.condition == without.condition);
        recorded += with.nspan > 0 && without.nspan == 0;
    }
    assert_int_equal(recorded, 40);
    arena_destroy(a);
}

static void untrustworthy_answers_are_told(void **state)
{
    (void)state;
    double residual[2] = {1e-12, 1e-9}, condition[2] = {10, 20}, qdd[1] = {0};
    struct run_spec spec = chain_spec(2, 2);
    const struct model chain = {.nbody = 2, .is_chain = true};
    struct dynamics_run own = {.job = {.spec = &spec, .model = &chain, .nrank = 2}};
    struct program_run run = {.spec = spec,
                              .own = &own,
                              .output = {[OUTPUT_QDD] = {qdd, 1},
                                         [OUTPUT_RESIDUAL] = {residual, 2},
                                         [OUTPUT_CONDITION] = {condition, 2}}};
    own.job.spec = &run.spec;
    struct run_result r = {.status = RUN_OK};
    run.spec.kernel.refinement = REFINEMENT_AS_GIVEN;
    trust_check(&run, &r);
    assert_int_equal(r.status, RUN_OK);
    assert_true(r.residual == 1e-9 && r.condition == 20);
    residual[0] = 0.01;
    trust_check(&run, &r);
    assert_int_equal(r.status, RUN_INVALID);
    assert_non_null(strstr(r.text, "inner_refinements"));
    run.spec.kernel.refinement = REFINEMENT_AS_NEEDED; /* the run has tried that */
    r.status = RUN_OK;
    trust_check(&run, &r);
    assert_null(strstr(r.text, "inner_refinements"));
    r.status = RUN_OK, residual[0] = NAN;
    trust_check(&run, &r);
    assert_int_equal(r.status, RUN_INVALID);
    assert_non_null(strstr(r.text, "residual is no number"));
    double scale[2] = {1e-20, 1}; /* the first rank has nothing but rounding */
    r.status = RUN_OK, residual[0] = 1, run.output[OUTPUT_RESIDUAL_SCALE].x = scale;
    trust_check(&run, &r);
    assert_int_equal(r.status, RUN_OK);
    assert_true(r.residual == 1e-9);
    residual[1] = 0.1;
    trust_check(&run, &r);
    assert_int_equal(r.status, RUN_INVALID);
    r.status = RUN_OK, residual[0] = residual[1] = 0, condition[1] = 1e17;
    trust_check(&run, &r);
    assert_int_equal(r.status, RUN_INVALID);
    /* factors of no digit would leave a residual there */
    run.spec.kernel.residual = RESIDUAL_TWICE;
    r.status = RUN_OK;
    trust_check(&run, &r);
    assert_int_equal(r.status, RUN_OK);
}

static const struct stability_row *row_of(const struct stability_report *r, const char *algorithm)
{
    for (int i = 0; i < r->nrow; i++)
        if (strcmp(r->row[i].algorithm, algorithm) == 0 &&
            strcmp(r->row[i].precision, "double") == 0)
            return &r->row[i];
    fail_msg("no row for %s", algorithm);
    return NULL;
}

/* The rows of one scene of the suite, in `rows`. */
static struct stability_report rows_of(const char *name, struct arena *rows)
{
    int n;
    const struct stability_scene *c = scene_list(&n);
    while (n > 0 && strcmp(c->name, name) != 0) c++, n--;
    assert_true(n > 0);
    struct arena *a = arena_create();
    struct stability_report r = {.arena = rows};
    struct model *m;
    struct state *s;
    struct err e;
    err_clear(&e);
    assert_true(scene_build(c, a, &m, &s, &e));
    stability_accelerations(&r, c->name, m, s, true, a);
    arena_destroy(a);
    return r;
}

/* A light body between heavy ones is the bad case of every constraint-force form, and of those
 * alone: physics 8.3. */
static void the_suite_knows_good_from_bad(void **state)
{
    (void)state;
    struct arena *rows = arena_create();
    const struct stability_report r = rows_of("mass alternating 1e6", rows);
    assert_int_equal(row_of(&r, "aba")->status, STABILITY_OK);
    assert_int_equal(row_of(&r, "paper pcr")->status, STABILITY_FAILED);
    assert_int_equal(row_of(&r, "direct cr")->status, STABILITY_DEGRADED);
    assert_int_equal(row_of(&r, "robust cr")->status, STABILITY_OK);
    assert_true(row_of(&r, "paper pcr")->residual > 1e3 * row_of(&r, "direct cr")->residual);
    assert_true(row_of(&r, "paper pcr")->energy_drift >
                1e3 * row_of(&r, "direct cr")->energy_drift);
    assert_int_equal(row_of(&r, "direct pcr inner")->refinements, 1);
    assert_int_equal(row_of(&r, "robust cr")->refinements, 2);
    assert_true(row_of(&r, "cfa-robust")->refinements > 1);
    arena_destroy(rows);
}

/* What no refinement in working precision mends, twice the precision does. */
static void twice_the_precision_mends_the_worst(void **state)
{
    (void)state;
    static const char *const name[] = {"mass alternating 1e12", "nearly points"};
    for (int k = 0; k < 2; k++) {
        struct arena *rows = arena_create();
        const struct stability_report r = rows_of(name[k], rows);
        assert_true(row_of(&r, "robust cr")->error > 1e-5);
        assert_true(row_of(&r, "twice cr")->error < 1e-13);
        assert_int_equal(row_of(&r, "twice cr")->refinements, 20);
        arena_destroy(rows);
    }
}

/* Energy is kept by a conservative scene and lost by a damped one; corrections that are not needed
 * are not counted. */
static void the_suite_tells_what_moves_and_what_was_refined(void **state)
{
    (void)state;
    struct arena *a = arena_create(), *rows = arena_create();
    struct stability_report r = {.arena = rows};
    struct stability_scene c = {.name = "even",
                                .spec = {.nbody = 8, .pose = POSE_COILED, .axes = AXES_TWISTED}};
    struct model *m;
    struct state *s;
    struct err e;
    err_clear(&e);
    assert_true(scene_build(&c, a, &m, &s, &e));
    stability_accelerations(&r, c.name, m, s, false, a);
    stability_energy(&r, c.name, m, s, a);
    assert_int_equal(row_of(&r, "robust cr")->refinements,
                     1); /* the outer one was asked for, too */
    assert_true(row_of(&r, "motion rk8pd")->energy_drift < 1e-10);
    assert_true(row_of(&r, "motion rk4")->energy_drift < 1e-8);
    assert_int_equal(row_of(&r, "motion rk4")->status, STABILITY_OK);
    c.spec.damping = 1;
    r.nrow = 0;
    assert_true(scene_build(&c, a, &m, &s, &e));
    stability_energy(&r, c.name, m, s, a);
    assert_true(row_of(&r, "motion rk8pd")->energy_drift > 1e-3);
    assert_int_equal(row_of(&r, "motion rk8pd")->status, STABILITY_DEGRADED);
    arena_destroy(rows);
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_planted_error_is_found),
        cmocka_unit_test(the_cheapest_good_enough_rung_is_chosen),
        cmocka_unit_test(ladders_show_the_errors_that_theory_knows),
        cmocka_unit_test(nothing_left_out_changes_a_result),
        cmocka_unit_test(untrustworthy_answers_are_told),
        cmocka_unit_test(the_suite_knows_good_from_bad),
        cmocka_unit_test(twice_the_precision_mends_the_worst),
        cmocka_unit_test(the_suite_tells_what_moves_and_what_was_refined),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
