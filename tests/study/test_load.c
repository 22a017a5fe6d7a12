/* test_load.c - load curves against closed forms and the reference router. */
#include "config.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <string.h>

#include <cmocka.h>

#include "base/arena.h"
#include "study/load.h"
#include "study/netcheck_case.h"

#ifdef SANITIZERS /* slow, and more loads are more of the same */
enum { LOADS = 1 };
#else
enum { LOADS = 5 };
#endif

/* A network of the reference router under a pattern: flits of 16 B, cycles of 1 ns. */
struct asked {
    struct arena *a;
    struct machine_spec machine;
    struct load_question q;
    struct load_series s;
};

static void ask(struct asked *x, const char *network, int vcs, int buffer, enum network_level level,
                const char *pattern, int flits)
{
    struct topology_spec spec;
    struct err e;
    err_clear(&e);
    *x = (struct asked){.a = arena_create()};
    if (!netcheck_topology(network, 0, &spec, &e)) fail_msg("%s", e.text);
    x->machine = netcheck_machine(&spec, vcs, buffer, 0, 3);
    x->machine.network.level = level;
    x->q = (struct load_question){.machine = &x->machine,
                                  .traffic = pattern,
                                  .bytes = 16 * flits,
                                  .seed = 1,
                                  .within = 0.02,
                                  .most = 400000};
    if (!load_begin(&x->q, NULL, &x->s, x->a, &e)) fail_msg("%s", e.text);
}

static struct load_point point(struct asked *x, double offered)
{
    struct load_point p;
    struct err e;
    err_clear(&e);
    if (!load_measure(&x->q, offered, false, &p, &e)) fail_msg("%s", e.text);
    return p;
}

static bool probe(void *context, double offered, struct load_point *p, struct err *e)
{
    return load_measure(&((struct asked *)context)->q, offered, true, p, e);
}

static double saturation(struct asked *x)
{
    struct err e;
    err_clear(&e);
    if (!load_saturate(&x->s, probe, x, &e)) fail_msg("%s", e.text);
    return x->s.saturation;
}

/* T0 = 3 R + 2 + (S - 1) cycles, R = distance + 1. The mean distance of all pairs of a k-ary n-mesh
 * is n (k - 1/k) / 3, of a hypercube n/2, of a permutation by hand. */
static void empty_networks_are_exact(void **state)
{
    (void)state;
    static const struct {
        const char *network, *pattern;
        int flits;
        double distance;
    } list[] = {
        {"mesh8x8", "uniform", 4, 2 * (8 - 1 / 8.0) / 3},
        {"mesh4x4x4", "uniform", 1, 3 * (4 - 1 / 4.0) / 3},
        {"hcube6", "uniform", 7, 3},
        {"hcube6", "bitcomp", 4, 6},
        {"torus8x8", "tornado", 4, 6},
        {"mesh8x8", "bitcomp", 4, 8},
        {"ring8", "shift(1)", 2, 1},
        {"fattree_k4_n3", "shift(32)", 4, 4},
    };
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        struct asked x;
        ask(&x, list[i].network, 2, 16, LEVEL_PACKET, list[i].pattern, list[i].flits);
        double ps = 1000 * (3 * (list[i].distance + 1) + 2 + list[i].flits - 1);
        if (fabs(x.s.empty_ps - ps) > 1e-6 * ps)
            fail_msg("%s: %g, not %g", list[i].network, x.s.empty_ps, ps);
        assert_int_equal(x.s.flits, list[i].flits);
        assert_true(x.s.cycle_ps == 1000 && x.s.nodes == x.q.topology->nnode);
        arena_destroy(x.a);
    }
}

/* More pairs than are followed one by one: the mean of drawn ones is near. */
static void large_networks_are_drawn(void **state)
{
    (void)state;
    struct asked x;
    ask(&x, "mesh32x32", 1, 16, LEVEL_PACKET, "uniform", 4);
    double ps = 1000 * (3 * (2 * (32 - 1 / 32.0) / 3 + 1) + 5);
    assert_true(fabs(x.s.empty_ps / ps - 1) < 0.01);
    arena_destroy(x.a);
}

/* One source for each link: the wait is that of the queue Geo/D/1 at the source, with one arrival
 * in a cycle with probability p and S cycles of service, u = p S (Takagi, Queueing Analysis 3,
 * 1993): W = u (S - 1) / (2 (1 - u)),     which for small cycles is M/D/1's u S / (2 (1 - u)). */
static void a_single_link_is_a_queue(void **state)
{
    (void)state;
    static const enum network_level level[] = {LEVEL_LOGGP, LEVEL_LINK, LEVEL_PACKET, LEVEL_FLIT,
                                               LEVEL_AUTO};
    static const double load[] = {0.5, 0.1, 0.8};
    for (int l = 0; l < 5; l++)
        for (int k = 0; k < 3 && k < LOADS; k++) {
            struct asked x;
            ask(&x, "fullmesh4", 1, 32, level[l], "shift(1)", 20);
            struct load_point p = point(&x, load[k]);
            double wait = load[k] * 19 / (2 * (1 - load[k])), ps = 1000 * (3 * 2 + 2 + 19 + wait);
            /* the load really offered differs by chance: d ln W / d ln u = 1 / (1 - u) */
            double chance = ps * 0.01 + 1000 * wait * fabs(p.created / load[k] - 1) / (1 - load[k]);
            assert_true(p.status == LOAD_OK || p.status == LOAD_WIDE);
            if (fabs(p.mean_ps - ps) > p.half_ps + chance)
                fail_msg("level %d load %g: %g +- %g, not %g", l, load[k], p.mean_ps, p.half_ps,
                         ps);
            assert_true(fabs(p.accepted - load[k]) < 0.02 && fabs(p.accepted - p.created) < 0.01);
            assert_true(p.p50_ps <= p.p99_ps && p.p99_ps <= p.max_ps && p.p50_ps >= 27000);
            arena_destroy(x.a);
        }
}

/* There, W = 2 T0 at u = 4 T0 / (4 T0 + S - 1). */
static void saturation_of_a_queue_is_its_closed_form(void **state)
{
    (void)state;
    struct asked x;
    ask(&x, "fullmesh4", 1, 32, LEVEL_PACKET, "shift(1)", 20);
    double u = 4 * 27.0 / (4 * 27 + 19), found = saturation(&x);
    if (fabs(found / u - 1) > 0.02) fail_msg("%g, not %g", found, u);
    assert_true(x.s.low < found && found < x.s.high && x.s.probes > 3);
    assert_true(isnan(x.s.bound) || x.s.bound == 1);
    arena_destroy(x.a);
}

/* Under sanitizers the queue above, which takes the same way. */
#ifndef SANITIZERS
/* Saturation is at most the bound of the most loaded link, and reaches it where one flow has it
 * all. */
static void saturation_is_below_the_bound(void **state)
{
    (void)state;
    struct asked x;
    ask(&x, "mesh8x8", 1, 16, LEVEL_PACKET, "transpose", 4);
    assert_true(fabs(x.s.bound - 1 / 7.0) < 1e-12);
    double found = saturation(&x);
    assert_true(found < 1.01 / 7 && found > 0.95 / 7);
    arena_destroy(x.a);
    ask(&x, "ring8", 2, 16, LEVEL_FLIT, "tornado(8,1)", 4);
    assert_true(fabs(x.s.bound - 1 / 3.0) < 1e-12);
    found = saturation(&x);
    /* two channels are the two classes of the ring: heads of lines block */
    if (found > 1.01 / 3 || found < 0.6 / 3) fail_msg("saturation %g", found);
    arena_destroy(x.a);
}

static void saturation_is_that_of_the_reference_router(void **state)
{
    (void)state;
    struct asked x;
    ask(&x, "mesh8x8", 1, 16, LEVEL_FLIT, "uniform", 4);
    const double found = saturation(&x);
    if (found < 0.98 * 0.353 || found > 1.02 * 0.361) fail_msg("saturation %g", found);
    arena_destroy(x.a);
}
#endif

/* BookSim 2 (tests/data/net/latency_load.json, saturation.json): mesh 8x8, uniform, 4 flits, one
 * channel of 16. */
static void curves_are_those_of_the_reference_router(void **state)
{
    (void)state;
    static const struct {
        double offered, latency;
    } list[] = {{0.2203, 28.4948},
                {0.01, 24.3461},
                {0.1102, 25.2937},
                {0.2937, 33.1211},
                {0.3305, 39.4383}};
    struct asked x;
    ask(&x, "mesh8x8", 1, 16, LEVEL_FLIT, "uniform", 4);
    for (int i = 0; i < LOADS; i++) {
        struct load_point p = point(&x, list[i].offered);
        assert_int_equal(p.status, LOAD_OK);
        if (fabs(p.mean_ps / 1000 / list[i].latency - 1) > 0.03)
            fail_msg("load %g: %g, not %g", list[i].offered, p.mean_ps / 1000, list[i].latency);
        assert_true(p.half_ps <= 0.02 * p.mean_ps);
    }
    arena_destroy(x.a);
}

/* Beyond saturation there is no latency, but a load that gets through. */
static void overloads_have_no_latency(void **state)
{
    (void)state;
    struct asked x;
    ask(&x, "mesh8x8", 1, 16, LEVEL_PACKET, "uniform", 4);
    struct load_point p = point(&x, 0.9);
    assert_int_equal(p.status, LOAD_UNSTABLE);
    assert_true(isnan(p.mean_ps) && isnan(p.half_ps) && p.p50_ps == -1 && p.p99_ps == -1 &&
                p.max_ps == -1);
    assert_true(p.accepted > 0.3 && p.accepted < 0.5 && fabs(p.created - 0.9) < 0.02);
    assert_int_equal(load_side(&p, x.s.empty_ps), 1);
    arena_destroy(x.a);
}

/* A source that is nearly always busy takes 1 / (1 - u)^2 services to settle. Where the network is
 * empty and a way through it long, that is a small part of the latency: everything gets
 * through, and a run that is too short to see the end of the rise does not say that it has none. */
static void a_short_run_is_no_overload(void **state)
{
    (void)state;
    struct asked x;
    ask(&x, "mesh8x8", 1, 16, LEVEL_LOGGP, "uniform", 3);
    x.machine.network.hop_latency = 40e-9;
    x.q.most = 60000;
    struct err e;
    err_clear(&e);
    assert_true(load_begin(&x.q, NULL, &x.s, x.a, &e));
    struct load_point p = point(&x, 0.99);
    assert_int_equal(p.status, LOAD_WIDE);
    assert_true(p.mean_ps > x.s.empty_ps && p.mean_ps < 1.5 * x.s.empty_ps);
    assert_int_equal(load_side(&p, x.s.empty_ps), 0);
    assert_true(isnan(saturation(&x)));
    arena_destroy(x.a);
}

/* A ring without classes of channels: messages half way round wait for each other. */
static void deadlocks_are_points(void **state)
{
    (void)state;
    struct asked x;
    ask(&x, "ring8", 1, 5, LEVEL_FLIT, "shift(4)", 18);
    struct load_point p = point(&x, 1);
    assert_int_equal(p.status, LOAD_DEADLOCK);
    assert_true(p.text[0] != '\0' && isnan(p.mean_ps) && load_side(&p, x.s.empty_ps) == 1);
    arena_destroy(x.a);
}

/* What loggp leaves out: nothing saturates but the source itself. */
static void without_contention_the_source_is_the_limit(void **state)
{
    (void)state;
    struct asked x;
    ask(&x, "mesh8x8", 1, 16, LEVEL_LOGGP, "transpose", 1);
    /* messages of one flit never wait: W = 0 */
    assert_true(isnan(saturation(&x)) && x.s.low == 1 && isnan(x.s.high));
    arena_destroy(x.a);
}

static void sides_are_told_by_the_interval(void **state)
{
    (void)state;
    struct load_point p = {.status = LOAD_OK, .mean_ps = 310, .half_ps = 9};
    assert_int_equal(load_side(&p, 100), 1);
    p.half_ps = 11;
    assert_int_equal(load_side(&p, 100), 0);
    p.mean_ps = 280;
    assert_int_equal(load_side(&p, 100), -1);
    p.status = LOAD_UNSTABLE;
    assert_int_equal(load_side(&p, 100), 1);
}

/* A made network: what it answers at each load is known. */
struct made {
    double limit;        /* saturated above it, .. */
    double unsure, sure; /* .. and nobody can tell from one of these loads up to the other */
    double asked[64];
    int n;
};

static bool answer_made(void *context, double offered, struct load_point *p, struct err *e)
{
    struct made *m = context;
    (void)e;
    m->asked[m->n++] = offered;
    *p = (struct load_point){.status = LOAD_OK, .mean_ps = offered > m->limit ? 400 : 200};
    if (offered >= m->unsure && offered < m->sure) p->mean_ps = 301, p->half_ps = 50;
    return true;
}

/* limit, first load that cannot be told, bound of the routes; what comes of it. */
static void what_cannot_be_told_is_not_taken_for_an_answer(void **state)
{
    (void)state;
    static const struct {
        double limit, unsure, bound, saturation, low, high;
    } row[] = {
        {0.37, 9, NAN, 0.37, 0.365, 0.375}, /* all is known */
        {2, 9, 0.5, NAN, 1, NAN},           /* holds at full load */
        {2, 1, 0.5, NAN, 0.525, NAN},       /* holds above its bound, not told at full load */
        {2, 0.5, 0.5, NAN, 0, NAN},         /* nothing is known, not even at the bound */
        {2, 0.5, NAN, NAN, 0, NAN},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct made m = {.limit = row[i].limit, .unsure = row[i].unsure, .sure = 10};
        struct load_series s = {.empty_ps = 100, .bound = row[i].bound};
        struct err e;
        err_clear(&e);
        assert_true(load_saturate(&s, answer_made, &m, &e));
        assert_int_equal(s.probes, m.n);
        if (isnan(row[i].saturation)) {
            assert_true(isnan(s.saturation) && isnan(s.high));
            if (fabs(s.low - row[i].low) > 1e-9) fail_msg("row %zu: held at %g", i, s.low);
            continue;
        }
        assert_true(fabs(s.saturation - row[i].saturation) < 0.005 && s.low < row[i].saturation &&
                    s.high > row[i].saturation && s.high - s.low <= 0.01 * s.high);
    }
    /* Not told at the bound, but saturated at full load: the bracket ends at full load. */
    struct made m = {.limit = 0.5, .unsure = 0.52, .sure = 0.53};
    struct load_series s = {.empty_ps = 100, .bound = 0.5};
    struct err e;
    err_clear(&e);
    assert_true(load_saturate(&s, answer_made, &m, &e) && fabs(s.saturation - 0.5) < 0.01);
}

static void the_same_question_has_the_same_answer(void **state)
{
    (void)state;
    struct asked x, y;
    ask(&x, "mesh4x4", 1, 16, LEVEL_PACKET, "uniform", 4);
    ask(&y, "mesh4x4", 1, 16, LEVEL_AUTO, "uniform", 4);
    struct load_point p = point(&x, 0.2), again, by_auto = point(&y, 0.2);
    point(&x, 0.4);
    again = point(&x, 0.2);
    assert_true(p.mean_ps == again.mean_ps && p.max_ps == again.max_ps && p.events == again.events);
    /* auto has the answers of packet with fewer events */
    assert_true(fabs(by_auto.mean_ps / p.mean_ps - 1) < 0.01 && by_auto.events < p.events);
    y.q.seed = 2;
    assert_true(point(&y, 0.2).mean_ps != by_auto.mean_ps);
    arena_destroy(x.a);
    arena_destroy(y.a);
}

static void what_cannot_be_run_is_refused(void **state)
{
    (void)state;
    struct asked x;
    struct load_point p;
    struct load_series s;
    struct err e;
    err_clear(&e);
    ask(&x, "mesh32x32", 1, 16, LEVEL_PACKET, "uniform", 4);
    x.q.most = 10000;
    assert_false(load_measure(&x.q, 1, false, &p, &e));
    assert_true(e.kind == ERR_CONFIG && strstr(e.text, "at most 10000 are allowed"));
    err_clear(&e);
    x.machine.network.buffer_flits = 1;
    assert_false(load_begin(&x.q, NULL, &s, x.a, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    arena_destroy(x.a);
}

/* A run that was recorded: four ranks, two of which send 20 flits to rank 2 at once, 100 cycles
 * long. */
static struct load_recording two_to_one(struct arena *a)
{
    struct load_recording r = {.nmessage = 2, .nrank = 4, .period = 100000};
    r.src = TAKE(a, 2, int), r.dst = TAKE(a, 2, int);
    r.bytes = TAKE(a, 2, int64_t), r.time = TAKE(a, 2, sim_ps);
    r.src[1] = 1, r.dst[0] = r.dst[1] = 2, r.bytes[0] = r.bytes[1] = 320;
    return r;
}

/* Both arrive after T0 = 3 + 2 + 19 cycles of a crossbar, one of them 20 later, whatever the speed,
 * as long as a period has room for both: 40 cycles, load 40 / (4 x 40). */
static void recorded_runs_are_repeated_at_any_speed(void **state)
{
    (void)state;
    struct asked x;
    struct err e;
    err_clear(&e);
    ask(&x, "crossbar8", 1, 32, LEVEL_PACKET, "uniform", 20);
    struct load_recording r = two_to_one(x.a);
    assert_true(load_begin(&x.q, &r, &x.s, x.a, &e));
    assert_true(x.s.nodes == 4 && x.s.bytes == 0 && x.s.flits == 20 && fabs(r.load - 0.1) < 1e-12);
    assert_string_equal(x.s.note, "as recorded: load 0.1");
    static const double load[] = {0.01, 0.1, 0.2, 0.24};
    for (int i = 0; i < 4; i++) {
        struct load_point p = point(&x, load[i]);
        assert_int_equal(p.status, LOAD_OK);
        if (fabs(p.mean_ps - (x.s.empty_ps + 10000)) > 200)
            fail_msg("load %g: mean %g, empty %g", load[i], p.mean_ps, x.s.empty_ps);
        assert_true(p.max_ps == p.p99_ps && fabs((double)p.max_ps - x.s.empty_ps - 20000) < 2);
        assert_true(fabs(p.accepted / load[i] - 1) < 0.02);
    }
    assert_int_equal(point(&x, 0.3).status, LOAD_UNSTABLE);
    /* more ranks than the machine has places for */
    r.nrank = 9;
    assert_false(load_begin(&x.q, &r, &x.s, x.a, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    arena_destroy(x.a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(empty_networks_are_exact),
        cmocka_unit_test(large_networks_are_drawn),
        cmocka_unit_test(a_single_link_is_a_queue),
        cmocka_unit_test(saturation_of_a_queue_is_its_closed_form),
#ifndef SANITIZERS
        cmocka_unit_test(saturation_is_below_the_bound),
        cmocka_unit_test(saturation_is_that_of_the_reference_router),
#endif
        cmocka_unit_test(curves_are_those_of_the_reference_router),
        cmocka_unit_test(overloads_have_no_latency),
        cmocka_unit_test(a_short_run_is_no_overload),
        cmocka_unit_test(deadlocks_are_points),
        cmocka_unit_test(without_contention_the_source_is_the_limit),
        cmocka_unit_test(sides_are_told_by_the_interval),
        cmocka_unit_test(what_cannot_be_told_is_not_taken_for_an_answer),
        cmocka_unit_test(the_same_question_has_the_same_answer),
        cmocka_unit_test(what_cannot_be_run_is_refused),
        cmocka_unit_test(recorded_runs_are_repeated_at_any_speed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
