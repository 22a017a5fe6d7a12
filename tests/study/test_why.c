/* test_why.c - the critical path: its steps are the run's time, its counts are derivatives, checked
 * against runs whose parameters differ by a picosecond. MIMDSIM_WHY_SCENES sets the number of
 * random scenes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "plan/plan.h"
#include "run/catalogue.h"
#include "run/run.h"
#include "study/why.h"

static struct plan read_plan(int nset, const char *const *set)
{
    struct plan p;
    struct err e;
    err_clear(&e);
    const struct plan_options o = {.nset = nset, .set = set};
    if (!plan_read(&p, "speedup-t3e", &o, &e)) fail_msg("%s", e.text);
    return p;
}

/* The steps follow each other without a gap from 0 to the makespan. */
static void assert_whole(const struct run_result *r)
{
    int64_t time = 0;
    for (int64_t i = 0; i < r->npath; i++) {
        assert_int_equal(r->path[i].begin_ps, time);
        assert_true(r->path[i].end_ps > time);
        assert_in_range(r->path[i].rank, 0, r->nrank - 1);
        assert_in_range(r->path[i].stage, 0, r->nstage - 1);
        time = r->path[i].end_ps;
    }
    assert_int_equal(time, r->makespan_ps);
}

static struct why study(const struct run_spec *spec, struct arena *a)
{
    struct why w;
    struct err e;
    err_clear(&e);
    if (!why_study(spec, 0, 1, true, a, &w, &e)) fail_msg("%s", e.text);
    assert_whole(&w.run);
    return w;
}

static int64_t makespan(const struct run_spec *spec, struct arena *a)
{
    struct run_result r;
    struct err e;
    err_clear(&e);
    if (!run_one(spec, a, &r, &e)) fail_msg("%s", e.text);
    return r.makespan_ps;
}

static int64_t time_of(const struct why *w, enum path_cause cause)
{
    int64_t sum = 0;
    for (int i = 0; i < w->nshare; i++)
        if (w->share[i].cause == cause) sum += w->share[i].time_ps;
    return sum;
}

/* ---- by hand ---- */

/* Two ranks, one message there and back, an empty one: o_s + hops + end + o_r, twice. */
static void a_pingpong_is_what_its_closed_form_says(void **state)
{
    (void)state;
    static const char *const set[] = {"machine=ideal",
                                      "kernel=pingpong",
                                      "kernel.message=8 B",
                                      "kernel.repeat=1",
                                      "ranks=2",
                                      "level=loggp",
                                      "machine.topology.family=torus",
                                      "machine.topology.dims=[2]",
                                      "machine.network.flit=1 B",
                                      "machine.network.packet=0 B",
                                      "machine.network.header=0 B",
                                      "machine.network.link.bandwidth=1000 MB/s",
                                      "machine.network.hop_latency=100 ns",
                                      "machine.network.end_latency=1 us",
                                      "machine.software.send.overhead=3 us",
                                      "machine.software.recv.overhead=2 us"};
    struct plan p = read_plan(sizeof set / sizeof set[0], set);
    struct arena *a = arena_create();
    const struct why w = study(&p.run[0], a);
    const int64_t messages = time_of(&w, PATH_SEND) / 3000000;
    assert_true(messages >= 2 && messages % 2 == 0);
    assert_int_equal(time_of(&w, PATH_SEND), messages * 3000000);
    assert_int_equal(time_of(&w, PATH_RECV), messages * 2000000);
    assert_int_equal(time_of(&w, PATH_END), messages * 1000000);
    assert_int_equal(time_of(&w, PATH_HOP), messages * 2 * 100000);
    assert_int_equal(time_of(&w, PATH_LINK_BYTES), messages * 7 * 1000);
    assert_int_equal(w.messages, messages);
    assert_int_equal(w.ranks, 2);
    arena_destroy(a);
    plan_free(&p);
}

/* ---- nodes with a memory ---- */

/* So slow a memory that it decides on nearly all computing: its bandwidth stands for what a run
 * with a thousandth less of it takes longer, and the flop rate for next to nothing. By rates
 * neither cache nor memory is a parameter. */
static void a_memory_that_binds_is_a_parameter_of_the_path(void **state)
{
    (void)state;
    static const char *const set[] = {"machine=t3e-300",
                                      "n=64",
                                      "ranks=16",
                                      "level=loggp",
                                      "kernel=dynamics",
                                      "machine.node.l1.size=64 B",
                                      "machine.node.memory.bandwidth=20 MB/s",
                                      "machine.node.memory.shared=30 MB/s",
                                      "machine.node.memory.processors=4",
                                      "machine.node.model=roofline"};
    static const char key[] = "machine.node.memory.shared";
    for (int roofline = 1; roofline >= 0; roofline--) {
        struct plan p = read_plan(9 + roofline, set);
        struct arena *a = arena_create();
        struct run_spec slower = p.run[0];
        const struct why w = study(&p.run[0], a);
        const int64_t share = why_contribution(&p.run[0], &w.run, key);
        const int64_t flops = why_contribution(&p.run[0], &w.run, "machine.node.flop_rate");
        assert_int_equal(why_contribution(&p.run[0], &w.run, "machine.node.memory.bandwidth"), 0);
        assert_true(why_scale(&slower.machine, key, 1.001));
        const int64_t longer = makespan(&slower, a) - w.run.makespan_ps;
        if (roofline) {
            assert_true(w.run.working_set > 64 && share > w.run.makespan_ps / 2);
            assert_true(flops < share / 20);
            assert_true(llabs(1000 * longer - share) < share / 50);
        } else {
            assert_true(share == 0 && longer == 0 && flops > 0);
        }
        arena_destroy(a);
        plan_free(&p);
    }
}

/* An engine's copies are steps of their own and stand for the same parameters: rounds of long
 * messages, with a thousandth more on each byte received or sent. */
static void copies_of_an_engine_are_parameters_of_the_path(void **state)
{
    (void)state;
    static const char *const set[] = {
        "machine=paragon", "kernel=ring", "ranks=8", "level=loggp", "kernel.message=16 KiB",
        "kernel.repeat=2", "machine.software.recv.copy=40 ns/B",
        "machine.software.send.copy=50 ns/B", "machine.software.offload=copies"};
    static const char *const key[] = {"machine.software.recv.copy", "machine.software.send.copy"};
    static const enum path_cause cause[] = {PATH_ENGINE_RECV, PATH_ENGINE_SEND};
    struct plan p = read_plan(sizeof set / sizeof set[0], set);
    struct arena *a = arena_create();
    const struct why w = study(&p.run[0], a);
    for (int i = 0; i < 2; i++) {
        struct run_spec slower = p.run[0];
        const int64_t share = why_contribution(&p.run[0], &w.run, key[i]);
        assert_true(why_scale(&slower.machine, key[i], 1.001));
        const int64_t longer = makespan(&slower, a) - w.run.makespan_ps;
        assert_true(share > 0 && share == time_of(&w, cause[i]));
        assert_true(llabs(1000 * longer - share) <= share / 100);
    }
    arena_destroy(a);
    plan_free(&p);
}

static int64_t time_stood_for(const struct why *w, const char *key)
{
    for (int i = 0; i < w->nparameter; i++)
        if (strcmp(w->parameter[i].key, key) == 0) return w->parameter[i].time_ps;
    return 0;
}

/* Long cables are told apart from routers at every level that says who binds, and have a derivative
 * of their own: with all of them longer by a part, the run is longer by that part of their time. */
static void cables_have_a_cause_and_a_derivative_of_their_own(void **state)
{
    (void)state;
    static const char *const level[] = {"level=loggp", "level=link"};
    static const char key[] = "machine.topology.dim_latency";
    for (int l = 0; l < 2; l++) {
        const char *const set[] = {"machine=t3e-300", "machine.topology.dims=[4, 2, 2]",
                                   "machine.topology.dim_latency=[700 ns, 300 ns, 100 ns]",
                                   "n=16", level[l]};
        struct plan p = read_plan(5, set);
        struct run_spec longer = p.run[0], short_ones = p.run[0];
        struct arena *a = arena_create();
        const struct why w = study(&p.run[0], a);
        const int64_t cables = time_of(&w, PATH_CABLE);
        assert_true(cables > 0 && cables % 100000 == 0);
        assert_int_equal(time_stood_for(&w, key), cables);
        assert_int_equal(time_stood_for(&w, "machine.network.hop_latency"), time_of(&w, PATH_HOP));
        /* A thousandth is whole picoseconds for each of the three. */
        assert_true(why_scale(&longer.machine, key, 1.001));
        assert_int_equal(makespan(&longer, a) - w.run.makespan_ps, cables / 1000);
        memset(short_ones.machine.topology.dim_latency, 0,
               sizeof short_ones.machine.topology.dim_latency);
        const struct why without = study(&short_ones, a);
        assert_int_equal(time_of(&without, PATH_CABLE), 0);
        assert_true(without.run.makespan_ps < w.run.makespan_ps);
        arena_destroy(a);
        plan_free(&p);
    }
}

/* ---- derivatives ---- */

static const char *const machines[] = {"t3e-300",     "paragon",    "paragon-am",
                                       "t3e-300-mpt", "meiko-cs-2", "ideal"};

struct scene {
    char machine[32], n[32], ranks[32], kernel[32], solver[40];
    char seed[32];
};

static struct plan random_scene(struct random *r, const char *level)
{
    static const char *const kernels[] = {"inverse",   "forward", "dynamics",
                                          "allreduce", "ring",    "alltoall"};
    static const char *const solvers[] = {"pcr-symmetric", "cr", "partition"};
    struct scene s;
    char level_set[32];
    const int ranks = 2 + (int)random_below(r, 15);
    snprintf(s.machine, sizeof s.machine, "machine=%s", machines[random_below(r, 6)]);
    snprintf(s.ranks, sizeof s.ranks, "ranks=%d", ranks);
    snprintf(s.n, sizeof s.n, "n=%d", ranks + (int)random_below(r, 20));
    snprintf(s.kernel, sizeof s.kernel, "kernel=%s", kernels[random_below(r, 6)]);
    snprintf(s.solver, sizeof s.solver, "kernel.solver=%s", solvers[random_below(r, 3)]);
    snprintf(s.seed, sizeof s.seed, "model.seed=%d", (int)random_below(r, 1000));
    snprintf(level_set, sizeof level_set, "level=%s", level);
    const char *const set[] = {s.machine, s.n, s.ranks, s.kernel, s.solver, s.seed, level_set};
    return read_plan(7, set);
}

/* One picosecond more on a time that the machine's file gives. */
static bool longer(struct run_spec *run, const char *key, double ps)
{
    struct machine_spec *m = &run->machine;
    struct {
        const char *key;
        double *at;
    } table[] = {{"machine.software.send.overhead", &m->software.send_overhead},
                 {"machine.software.recv.overhead", &m->software.recv_overhead},
                 {"machine.network.hop_latency", &m->network.hop_latency},
                 {"machine.network.end_latency", &m->network.end_latency},
                 {"machine.software.gap", &m->software.gap},
                 {"machine.software.rendezvous.latency", &m->software.rendezvous_latency},
                 {"machine.software.barrier.time", &m->software.barrier_time}};
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++)
        if (strcmp(table[i].key, key) == 0) return *table[i].at += ps * 1e-12, true;
    return false;
}

/* Without contention the makespan is the longest of all paths, so it is convex in every time: a
 * picosecond more costs at least the count, a picosecond less gains at most the count. Where no
 * other path is as long, both are the count. */
static void counts_are_derivatives_to_the_picosecond(void **state)
{
    (void)state;
    const char *wanted = getenv("MIMDSIM_WHY_SCENES");
    const int scenes = wanted ? atoi(wanted) : 60;
    struct random r = random_make(7, 0, 0);
    int asked = 0, equal = 0;
    for (int k = 0; k < scenes; k++) {
        struct plan p = random_scene(&r, "loggp");
        struct arena *a = arena_create();
        const struct why w = study(&p.run[0], a);
        for (int i = 0; i < w.nparameter; i++) {
            struct run_spec more = p.run[0], less = p.run[0];
            const int64_t count = llround(w.parameter[i].count);
            if (w.parameter[i].count == 0 || !longer(&more, w.parameter[i].key, 1)) continue;
            longer(&less, w.parameter[i].key, -1);
            const int64_t up = makespan(&more, a) - w.run.makespan_ps,
                          down = w.run.makespan_ps - makespan(&less, a);
            if (up < count || down > count)
                fail_msg("scene %d, %s on %s, n = %d, P = %d: %s is paid %lld times, +1 ps costs "
                         "%lld, -1 ps gains %lld",
                         k, p.run[0].kernel.name, p.run[0].machine.name, p.run[0].model.nbody,
                         p.run[0].nrank, w.parameter[i].key, (long long)count, (long long)up,
                         (long long)down);
            asked++;
            equal += up == count && down == count;
        }
        arena_destroy(a);
        plan_free(&p);
    }
    print_message("%d derivatives, %d equal on both sides\n", asked, equal);
    assert_true(asked > 2 * scenes);
    assert_true(equal > asked / 2);
}

/* Where messages share links the derivative keeps the order of contention: how near it is to a run
 * again. */
static void derivatives_with_contention_are_near(void **state)
{
    (void)state;
    struct random r = random_make(8, 0, 0);
    int asked = 0, near = 0;
    for (int k = 0; k < 40; k++) {
        struct plan p = random_scene(&r, "link");
        struct arena *a = arena_create();
        const struct why w = study(&p.run[0], a);
        for (int i = 0; i < w.nparameter; i++) {
            struct run_spec more = p.run[0];
            const double count = w.parameter[i].count;
            if (count < 1 || !longer(&more, w.parameter[i].key, 100)) continue;
            const double up = (double)(makespan(&more, a) - w.run.makespan_ps) / 100;
            asked++;
            near += fabs(up - count) <= 0.05 * count;
        }
        arena_destroy(a);
        plan_free(&p);
    }
    print_message("%d derivatives at level link, %d within 5 %%\n", asked, near);
    assert_true(near > asked * 8 / 10);
}

/* The same run without recording has the same digest, so that what explains a run changes
 * nothing. */
static void assert_same_unrecorded(const struct run_spec *spec, const struct run_result *recorded,
                                   struct arena *a)
{
    struct run_spec plain = *spec;
    struct run_result r;
    struct err e;
    err_clear(&e);
    plain.record.spans = plain.record.links = plain.record.path = false;
    if (!run_one(&plain, a, &r, &e)) fail_msg("%s", e.text);
    assert_true(r.digest == recorded->digest);
    assert_int_equal(r.makespan_ps, recorded->makespan_ps);
    assert_int_equal(r.npath, 0);
}

/* Every level and every kind of software: the path is whole, and recording changes no digest. */
static void the_path_is_whole_everywhere(void **state)
{
    (void)state;
    static const char *const level[] = {"loggp", "link", "packet", "flit", "auto"};
    static const char *const machine[] = {
        "machine=t3e-300",  "machine=origin2000",     "machine=quad-ppro", "machine=quad-ppro-shm",
        "machine=smp-node", "machine=infiniband-qdr", "machine=aries"};
    static const char *const kernel[] = {"kernel=dynamics", "kernel=alltoall", "kernel=barrier"};
    int whole = 0;
    for (int m = 0; m < 7; m++)
        for (int l = 0; l < 5; l++)
            for (int k = 0; k < 3; k++) {
                char word[32];
                snprintf(word, sizeof word, "level=%s", level[l]);
                const char *const set[] = {machine[m], word,  kernel[k],
                                           "ranks=4",  "n=8", "kernel.message=20 kB"};
                struct plan p = {0};
                struct err e;
                err_clear(&e);
                const struct plan_options o = {.nset = 6, .set = set};
                struct arena *a = arena_create();
                if (!plan_read(&p, "speedup-t3e", &o, &e))
                    print_message("%s: %s\n", machine[m], e.text);
                else {
                    struct why w;
                    if (why_study(&p.run[0], 0, 1, true, a, &w, &e)) 
                        assert_whole(&w.run), assert_same_unrecorded(&p.run[0], &w.run, a), whole++;
                }
                arena_destroy(a);
                plan_free(&p);
            }
    assert_true(whole >= 60);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pingpong_is_what_its_closed_form_says),
        cmocka_unit_test(a_memory_that_binds_is_a_parameter_of_the_path),
        cmocka_unit_test(copies_of_an_engine_are_parameters_of_the_path),
        cmocka_unit_test(cables_have_a_cause_and_a_derivative_of_their_own),
        cmocka_unit_test(counts_are_derivatives_to_the_picosecond),
        cmocka_unit_test(derivatives_with_contention_are_near),
        cmocka_unit_test(the_path_is_whole_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
