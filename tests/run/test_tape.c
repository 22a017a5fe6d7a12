/* test_tape.c - what ranks did, repeated on other machines: every number of the result is that of
 * the program itself. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "plan/plan.h"
#include "run/result_parts.h"
#include "run/run_parts.h"

enum { MOST_SETTINGS = 12 };

/* Tasks of every kind that repeats itself: solvers, inverse dynamics, time steps, trees, loops,
 * planes, and runs that refine their answer in further attempts. */
static const char *const task[][MOST_SETTINGS] = {
    {"kernel.solver=pcr-symmetric", "n=24", "ranks=24"},
    {"kernel.name=dynamics", "kernel.solver=partition", "n=40", "ranks=8"},
    {"kernel.name=inverse", "n=33", "ranks=16"},
    {"kernel.formulation=direct", "kernel.outer_refinements=2", "n=20", "ranks=20"},
    {"kernel.steps=2", "kernel.step_size=1 ms", "n=9", "ranks=4"},
    {"model.generator=star", "n=17", "ranks=8"},
    {"model.generator=ring", "model.gravity=[0, -9.81, 0] m/s^2", "n=9", "ranks=4"},
    {"kernel.refinement=as-needed", "kernel.formulation=paper", "kernel.precision=float", "n=96",
     "ranks=16"},
};
enum { TASKS = sizeof task / sizeof *task };

/* The machines that they run on, from fast to slow messages, one of them noisy. */
static const char *const machine[][4] = {
    {"level=link"},
    {"level=loggp", "machine.software.send.overhead=3 us"},
    {"level=packet", "machine.network.end_latency=2 us"},
    {"level=link", "machine.software.eager.limit=64 B"},
    {"level=link", "machine.noise.compute=10 %", "seed=7"},
    {"level=link", "machine.software.offload=none", "machine.software.eager.limit=64 B"},
};
enum { MACHINES = sizeof machine / sizeof *machine };

static struct run_spec spec_of(struct plan *p, int t, int m)
{
    const char *set[2 * MOST_SETTINGS];
    struct plan_options o = {.set = set};
    struct err e;
    err_clear(&e);
    for (int i = 0; i < MOST_SETTINGS && task[t][i]; i++) set[o.nset++] = task[t][i];
    for (int i = 0; i < 4 && machine[m][i]; i++) set[o.nset++] = machine[m][i];
    if (!plan_read(p, MIMDSIM_SRCDIR "/scenarios/speedup-t3e.yaml", &o, &e)) fail_msg("%s", e.text);
    struct run_spec spec = p->run[0];
    spec.record.spans = spec.record.path = true;
    return spec;
}

static void run(const struct run_spec *spec, const struct run_order *order, struct run_cache *cache,
                struct arena *a, struct run_result *r)
{
    struct err e;
    err_clear(&e);
    if (!run_sharing(spec, order, cache, a, r, &e)) fail_msg("%s", e.text);
}

/* All of a result but what the host takes for it. */
static void expect_same(struct run_result *x, struct run_result *y)
{
    const struct result_parts a = result_parts(x), b = result_parts(y);
    for (int i = 0; i < RESULT_PARTS; i++) {
        assert_int_equal(a.bytes[i], b.bytes[i]);
        if (a.bytes[i] > 0) assert_memory_equal(*a.array[i], *b.array[i], a.bytes[i]);
        *a.array[i] = *b.array[i] = NULL;
    }
    x->stack_peak_bytes = y->stack_peak_bytes = x->host_peak_bytes = y->host_peak_bytes = 0;
    x->host_s = y->host_s = x->host_total_s = y->host_total_s = 0;
    assert_memory_equal(x, y, sizeof *x);
}

/* Whether the next such run repeats what another one did. */
static bool repeats(const struct run_spec *spec, unsigned keep, struct run_cache *cache)
{
    struct arena *a = arena_create();
    struct program_run r;
    struct err e;
    err_clear(&e);
    const struct run_order order = {.keep = keep};
    assert_true(run_open(spec, &order, cache, a, &r, &e));
    const struct tape *tape = tape_for(cache->tapes, &r);
    const bool whole = tape && tape_whole(tape);
    run_close(&r);
    arena_destroy(a);
    return whole;
}

/* One cache for all tasks and machines; the machine on which a task is written down is another one
 * each time. */
static void every_number_is_the_programs_own(void **unused)
{
    (void)unused;
    struct run_cache *cache = run_cache_create();
    run_cache_repeat(cache, true);
    for (int t = 0; t < TASKS; t++)
        for (int k = 0; k < MACHINES; k++) {
            struct plan p;
            const struct run_spec spec = spec_of(&p, t, (t + k) % MACHINES);
            struct arena *a = arena_create();
            static struct run_result whole, shared;
            struct run_cache *none = run_cache_create();
            assert_int_equal(repeats(&spec, 0, cache), k > 0);
            run(&spec, NULL, none, a, &whole);
            run(&spec, NULL, cache, a, &shared);
            assert_true(whole.makespan_ps > 0 && whole.nspan > 0 && whole.nerror > 0);
            expect_same(&whole, &shared);
            run_cache_destroy(none);
            arena_destroy(a);
            plan_free(&p);
        }
    run_cache_destroy(cache);
}

/* On a machine that never ends the run is made without the tape, and says what it would have said.
 */
static void runs_that_fail_are_made(void **unused)
{
    (void)unused;
    struct run_cache *cache = run_cache_create(), *none = run_cache_create();
    struct arena *a = arena_create();
    static struct run_result well, whole, shared;
    struct plan p;
    struct run_spec spec = spec_of(&p, 0, 0);
    run_cache_repeat(cache, true);
    run(&spec, NULL, cache, a, &well);
    assert_int_equal(well.status, RUN_OK);
    assert_true(repeats(&spec, 0, cache));
    spec.machine.node.flop_rate = 1e-6;
    run(&spec, NULL, none, a, &whole);
    run(&spec, NULL, cache, a, &shared);
    assert_int_equal(whole.status, RUN_FAILED);
    assert_true(strlen(whole.text) > 0);
    expect_same(&whole, &shared);
    run_cache_destroy(cache);
    run_cache_destroy(none);
    arena_destroy(a);
    plan_free(&p);
}

/* Most tasks are run once: the second run is written down, the third repeated; nothing is where
 * runs are to share nothing, or where the program looks at the clock. */
static void when_runs_are_repeated(void **unused)
{
    (void)unused;
    struct run_cache *cache = run_cache_create();
    struct arena *a = arena_create();
    struct run_result *r = TAKE(a, 1, struct run_result);
    struct plan p;
    const struct run_spec spec = spec_of(&p, 0, 0);
    run_cache_repeat(cache, false);
    /* A look is what a run does first: it counts as one. */
    const struct run_order apart = {.keep = KEEP_SCENES};
    for (int k = 0; k < 3; k++) {
        run(&spec, NULL, cache, a, r);
        run(&spec, &apart, cache, a, r);
        if (k == 0) assert_false(repeats(&spec, 0, cache));
    }
    assert_true(repeats(&spec, 0, cache));
    assert_false(repeats(&spec, KEEP_SCENES, cache));
    plan_free(&p);
    struct err e;
    err_clear(&e);
    assert_true(plan_read(&p, MIMDSIM_SRCDIR "/scenarios/pingpong.yaml", NULL, &e));
    for (int k = 0; k < 3; k++) run(&p.run[0], NULL, cache, a, r);
    assert_false(repeats(&p.run[0], 0, cache));
    plan_free(&p);
    run_cache_destroy(cache);
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_number_is_the_programs_own),
        cmocka_unit_test(runs_that_fail_are_made),
        cmocka_unit_test(when_runs_are_repeated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
