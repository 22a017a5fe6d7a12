/* test_launching.c - what stands before a run: stacks of ranks as the environment says, threads of
 * the host, programs by their names, what is refused before anything is made. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "plan/plan.h"
#include "run/catalogue.h"
#include "run/launch.h"
#include "run/omission.h"
#include "run/rank_stack.h"
#include "run/real.h"
#include "run/run.h"
#include "sim/fiber.h"

static struct plan plan_of(const char *const *set, int n)
{
    struct plan p;
    struct err e;
    const struct plan_options o = {.nset = n, .set = set};
    err_clear(&e);
    if (!plan_read(&p, "speedup-t3e", &o, &e)) fail_msg("%s", e.text);
    return p;
}

static void stacks_are_as_large_as_the_environment_says(void **state)
{
    (void)state;
    enum { BEFORE = 12345 };
    static const struct {
        const char *text;
        int64_t bytes; /* -1: refused */
    } row[] = {
        {"4 KiB", 4096},   {"4096 B", 4096}, {"1 GiB", 1 << 30}, {"256 KiB", 256 << 10},
        {"4.5 KiB", 4608}, {"", BEFORE},     {"4095 B", -1},     {"1073741825 B", -1},
        {"256", -1},       {"256 KiBs", -1}, {"256 ms", -1},     {"-1 MiB", -1},
        {"nan B", -1},     {"inf B", -1},    {"0 B", -1},        {"unlimited", -1},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct world_load load = {.stack_bytes = BEFORE};
        struct err e;
        err_clear(&e);
        setenv(RANK_STACK_VARIABLE, row[i].text, 1);
        if (rank_stack_set(&load, &e) != (row[i].bytes >= 0)) fail_msg("'%s'", row[i].text);
        /* whoever needs more is told in either case, and a refusal changes no size */
        assert_non_null(load.overflowed);
        assert_true(load.stack_bytes == (row[i].bytes >= 0 ? row[i].bytes : BEFORE));
        if (row[i].bytes >= 0) continue;
        assert_int_equal(e.kind, ERR_USAGE);
        assert_non_null(strstr(e.text, RANK_STACK_VARIABLE));
        assert_non_null(strstr(e.text, row[i].text));
    }
    struct world_load load = {.stack_bytes = BEFORE};
    struct err e;
    err_clear(&e);
    unsetenv(RANK_STACK_VARIABLE);
    assert_true(rank_stack_set(&load, &e));
    assert_int_equal(load.stack_bytes, BEFORE);
}

static void threads_are_those_asked_for_or_worth_their_messages(void **state)
{
    (void)state;
    cpu_set_t set;
    assert_int_equal(sched_getaffinity(0, sizeof set, &set), 0);
    const int mine = CPU_COUNT(&set);
    /* what is asked for holds, and is one at least */
    for (int asked = 1; asked < 200; asked *= 3)
        assert_int_equal(launch_threads(asked, 4, 1, asked % 2 == 0), asked);
    assert_int_equal(launch_threads(RUN_THREADS_AUTO, 4, 1, false), 1);
    assert_int_equal(launch_threads(RUN_THREADS_AUTO, 1, 1 << 20, false), 1);
    assert_int_equal(launch_threads(RUN_THREADS_AUTO, mine + 5, 1 << 20, false), mine);
    /* never more than this process may use, nor than there are processors for it */
    int before = 1;
    for (int nrank = 1; nrank <= 1 << 20; nrank *= 2) {
        const int all = launch_threads(RUN_THREADS_AUTO, 0, nrank, false),
                  two = launch_threads(RUN_THREADS_AUTO, 2, nrank, false),
                  windows = launch_threads(RUN_THREADS_AUTO, 0, nrank, true);
        assert_true(all >= before && all <= mine && all <= nrank);
        assert_int_equal(two, all < 2 ? all : 2);
        /* windows need more ranks for each, and few threads have enough of the network */
        assert_true(windows >= 1 && windows <= all && windows <= 4);
        if (nrank < 4096) assert_int_equal(windows, 1);
        if (nrank == 4096 && mine >= 2) assert_int_equal(windows, 2);
        before = all;
    }
    assert_int_equal(before, mine);
}

static void programs_have_names_and_titles(void **state)
{
    (void)state;
    const struct catalogue c = catalogue_of_kernels();
    assert_true(c.n > 10 && c.n <= CATALOGUE_MOST);
    for (int i = 0; i < c.n; i++) {
        struct run_spec spec = {.nrank = 1};
        assert_true(c.name[i][0] != '\0' && c.title[i][0] != '\0');
        assert_null(strchr(c.title[i], '\n'));
        for (int k = 0; k < i; k++) assert_string_not_equal(c.name[k], c.name[i]);
        snprintf(spec.kernel.name, sizeof spec.kernel.name, "%s", c.name[i]);
        const struct program_type *type = run_program(&spec);
        assert_non_null(type);
        assert_string_equal(type->name, c.name[i]);
    }
    assert_true(strcmp(run_fibers(), "fcontext") == 0 || strcmp(run_fibers(), "ucontext") == 0);
}

static void what_has_no_program_is_refused(void **state)
{
    (void)state;
    struct plan p = plan_of((const char *const[]){"n=4"}, 1);
    struct run_cache *cache = run_cache_create();
    struct arena *a = arena_create();
    for (int own = 0; own < 2; own++) {
        struct run_spec spec = p.run[0];
        struct run_result out;
        struct run_estimate estimate;
        struct program_run r;
        struct err e;
        snprintf(spec.kernel.name, sizeof spec.kernel.name, "%s", own == 1 ? "dynamics" : "nobody");
        spec.kernel.own = own == 1;
        const char *part =
            own ? "program 'dynamics' is not at hand" : "no kernel is called 'nobody'";
        int64_t work = RUN_EXPLAIN_WORK;
        for (int way = 0; way < 3; way++) {
            err_clear(&e);
            if (way == 0) {
                assert_false(run_open(&spec, NULL, cache, a, &r, &e));
                run_close(&r);
            } else if (way == 1) assert_false(run_one(&spec, a, &out, &e));
            else assert_false(run_explain(&spec, &work, &estimate, &e));
            assert_int_equal(e.kind, ERR_CONFIG);
            if (strstr(e.text, part) == NULL) fail_msg("'%s' is not in '%s'", part, e.text);
        }
        /* what it leaves as the row of a campaign */
        out = run_refused(&e);
        assert_int_equal(out.status, RUN_FAILED);
        assert_int_equal(out.refusal, ERR_CONFIG);
        assert_non_null(strstr(out.text, part));
    }
    arena_destroy(a);
    run_cache_destroy(cache);
    run_cache_destroy(NULL);
    plan_free(&p);
}

/* With one rank there is nobody to talk to: the real run needs no MPI, and its answer has the bits
 * of the simulated one. */
static void one_rank_runs_for_real_in_this_process(void **state)
{
    (void)state;
    static const char *const set[] = {"n=3", "ranks=1", "level=loggp"};
    struct plan p = plan_of(set, 3);
    struct run_cache *cache = run_cache_create();
    struct arena *a = arena_create();

    const struct real_order order = {.samples = 6, .seconds = 0.2};
    struct real_result out;
    struct err e;
    err_clear(&e);
    struct host_comm *comm = host_comm_create(NULL, &e);
    assert_non_null(comm);
    /* both levels of the sweep were replaced by one */
    assert_int_equal(p.nrun, 1);
    if (!run_real(&p.run[0], NULL, comm, &order, cache, a, &out, &e)) fail_msg("%s", e.text);
    assert_int_equal(out.status, RUN_OK);
    assert_int_equal(out.nrank, 1);
    assert_true(out.nsample >= 1 && out.nsample <= 20000 && out.disturbed <= out.nsample);
    assert_true(out.same_bits && out.repeatable && out.difference == 0);
    assert_true(out.messages == 0 && out.bytes == 0);
    const struct real_times *t = &out.time;
    assert_true(t->min > 0 && t->min <= t->lower && t->lower <= t->median &&
                t->median <= t->upper && t->upper <= t->max);
    /* more ranks than there are processes */
    struct run_spec four = p.run[0];
    four.nrank = 4;
    assert_false(run_real(&four, NULL, comm, &order, cache, a, &out, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    host_comm_destroy(comm);
    arena_destroy(a);
    run_cache_destroy(cache);
    plan_free(&p);
}

/* A program that promises a depth, and of which one rank needs more. */
enum { PROMISED = 600, DEEP_RANK = 2 };

static size_t two_kilobytes(const void *job, int rank)
{
    (void)job, (void)rank;
    return 2048;
}

static int promised(const void *job)
{
    (void)job;
    return PROMISED;
}

static __attribute__((noinline)) void go_deep(void)
{
    volatile char frame[3000];
    for (size_t i = 0; i < sizeof frame; i += 8) frame[i] = 1;
}

static void deep_run(struct comm *c, const void *job, void *workspace)
{
    (void)job;
    memset(workspace, 1, 2048);
    if (comm_rank(c) == DEEP_RANK) go_deep();
}

static void shallow_run(struct comm *c, const void *job, void *workspace)
{
    (void)c, (void)job;
    memset(workspace, 1, 2048);
}

/* Without guards it writes over its neighbour's stack, which is seen, and the run made again on
 * stacks that have more. */
static void a_rank_deeper_than_was_promised_gets_more(void **state)
{
    (void)state;
    static const char *const set[] = {"n=4", "ranks=4", "level=loggp"}, *const stage[] = {"all"};
    struct plan p = plan_of(set, 3);
    for (int deep = 0; deep < 2; deep++) {
        const struct program_type type = {.name = "deep"};
        const struct rank_program rank = {.nstage = 1,
                                          .stage_name = stage,
                                          .workspace_bytes = two_kilobytes,
                                          .run = deep ? deep_run : shallow_run,
                                          .depth = PROMISED,
                                          .deepest = promised};
        struct program_run r = {
            .type = &type, .spec = p.run[0], .packs = fiber_packs(), .rank = &rank};
        struct arena *scratch = arena_create(), *a = arena_create();
        struct run_result out = {0};
        struct err e;
        err_clear(&e);
        if (!launch_run(&r, &r.spec.machine, &r.spec.record, 1, -1, NULL, scratch, NULL, a, &out,
                        &e))
            fail_msg("%s", e.text);
        assert_int_equal(out.status, RUN_OK);
        print_message("deepest: %lld bytes\n", (long long)out.stack_peak_bytes);
        if (deep) assert_true(out.stack_peak_bytes >= 8192 && out.stack_peak_bytes % 4096 == 0);
        else assert_true(out.stack_peak_bytes <= 4096);
        arena_destroy(a);
        arena_destroy(scratch);
    }
    plan_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stacks_are_as_large_as_the_environment_says),
        cmocka_unit_test(threads_are_those_asked_for_or_worth_their_messages),
        cmocka_unit_test(programs_have_names_and_titles),
        cmocka_unit_test(what_has_no_program_is_refused),
        cmocka_unit_test(one_rank_runs_for_real_in_this_process),
        cmocka_unit_test(a_rank_deeper_than_was_promised_gets_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
