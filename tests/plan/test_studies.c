/* test_studies.c - samples, searches and conditions of scenarios: the points that they make, and
 * what is wrong is refused at its line. */
#include "scratch.h"

#include <math.h>

#include "plan/condition.h"
#include "plan/setting.h"

/* Lines 1 to 3 of each scenario, and sizes for those that do not sweep them. */
#define HEAD "schema_version: 1\nkernel: forward\nmachine: t3e-300\n"
#define SIZES "ranks: 4\nn: 16\n"

static struct plan plan_of(const char *rest)
{
    char text[4096];
    snprintf(text, sizeof text, HEAD "%s", rest);
    return scratch_plan(scratch_write(&scratch, "study.yaml", text), NULL, 0);
}

/* ---- samples ---- */

static const char sobol[] = "sweep:\n  sample:\n    points: 64\n    seed: 3\n    of:\n"
                            "      machine.network.link.bandwidth: {from: 100 MB/s, to: 1 GB/s}\n"
                            "      kernel.solver: [cr, pcr-symmetric]\n" SIZES;

static void a_sample_has_as_many_points_as_asked_for_within_the_range(void **state)
{
    (void)state;
    struct plan p = plan_of(sobol);
    int below = 0, cr = 0;
    assert_int_equal(p.nrun, 64);
    for (int i = 0; i < p.nrun; i++) {
        const double b = p.run[i].machine.network.link_bandwidth;
        assert_true(b >= 100e6 && b <= 1e9);
        below += b < sqrt(100e6 * 1e9);
        cr += p.run[i].kernel.solver == SOLVER_CR;
        for (int k = 0; k < i; k++)
            assert_string_not_equal(p.run[i].config_hash, p.run[k].config_hash);
    }
    /* Sobol's points fill the halves of every dimension alike, in the logarithm by default */
    assert_in_range(below, 30, 34);
    assert_in_range(cr, 30, 34);
    plan_free(&p);
}

static void the_same_seed_gives_the_same_points_and_another_seed_others(void **state)
{
    (void)state;
    char other[1024];
    snprintf(other, sizeof other, "%s", sobol);
    *strchr(strstr(other, "seed: "), '3') = '4';
    struct plan a = plan_of(sobol), b = plan_of(sobol), c = plan_of(other);
    int same = 0;
    for (int i = 0; i < a.nrun; i++) {
        assert_string_equal(a.run[i].config_hash, b.run[i].config_hash);
        same += strcmp(a.run[i].config_hash, c.run[i].config_hash) == 0;
    }
    assert_true(same < a.nrun / 4);
    plan_free(&a);
    plan_free(&b);
    plan_free(&c);
}

/* A hypercube has one point in each of as many slices of every key as it has points. */
static void a_latin_hypercube_has_one_point_a_slice(void **state)
{
    (void)state;
    struct plan p =
        plan_of("sweep:\n  sample:\n    points: 16\n    method: latin-hypercube\n"
                "    of: {machine.network.hop_latency: {from: 0 us, to: 16 us}}\n" SIZES);
    bool seen[16] = {false};
    assert_int_equal(p.nrun, 16);
    for (int i = 0; i < 16; i++) {
        const int slice = (int)(p.run[i].machine.network.hop_latency / 1e-6);
        assert_in_range(slice, 0, 15);
        assert_false(seen[slice]);
        seen[slice] = true;
    }
    plan_free(&p);
}

/* A whole number stays one, and both ends of the range are reached. */
static void a_range_of_whole_numbers_gives_whole_numbers(void **state)
{
    (void)state;
    struct plan p = plan_of("sweep:\n  sample:\n    points: 200\n    method: random\n"
                            "    of: {n: {from: 8, to: 11, scale: linear}}\nranks: 4\n");
    int count[4] = {0};
    for (int i = 0; i < p.nrun; i++) {
        assert_in_range(p.run[i].model.nbody, 8, 11);
        count[p.run[i].model.nbody - 8]++;
    }
    for (int i = 0; i < 4; i++) assert_true(count[i] > 0);
    plan_free(&p);
}

static void a_sample_is_one_axis_beside_others(void **state)
{
    (void)state;
    struct plan p =
        plan_of("sweep:\n  n: [8, 16]\n  sample:\n    points: 3\n    method: halton\n"
                "    of: {machine.network.hop_latency: {from: 1 us, to: 2 us}}\nranks: 4\n");
    assert_int_equal(p.nrun, 6);
    /* the last axis runs fastest, and both sizes see the same points */
    for (int i = 0; i < 3; i++) {
        assert_int_equal(p.run[i].model.nbody, 8);
        assert_int_equal(p.run[3 + i].model.nbody, 16);
        assert_true(p.run[i].machine.network.hop_latency ==
                    p.run[3 + i].machine.network.hop_latency);
    }
    plan_free(&p);
}

/* ---- searches ---- */

static void a_search_stands_at_the_middle_of_its_ranges(void **state)
{
    (void)state;
    struct plan p = plan_of("optimise:\n  least: makespan\n  within: n >= 8\n  over:\n"
                            "    machine.network.link.bandwidth: {from: 100 MB/s, to: 10 GB/s}\n"
                            "    kernel.solver: [cr, pcr-symmetric]\n  runs: 12\n" SIZES);
    assert_int_equal(p.nrun, 2);
    assert_non_null(p.search);
    assert_false(p.search->greatest);
    assert_int_equal(p.search->most, 12);
    assert_int_equal(p.search->nrange, 1);
    assert_string_equal(p.search->range[0].key, "machine.network.link.bandwidth");
    assert_true(p.search->range[0].log);
    assert_true(p.search->within != NULL);
    /* the middle in the logarithm; both solvers compete for one best */
    assert_true(fabs(p.run[0].machine.network.link_bandwidth - 1e9) < 1);
    assert_int_equal(p.ngroup, 1);
    assert_int_equal(p.group[0], p.group[1]);
    plan_free(&p);
}

static void a_search_is_made_for_each_point_of_the_sweep(void **state)
{
    (void)state;
    struct plan p = plan_of("sweep: {n: [8, 16, 32]}\noptimise:\n  greatest: speedup\n"
                            "  over: {kernel.solver: [cr, pcr-symmetric]}\nranks: 4\n");
    assert_int_equal(p.nrun, 6);
    assert_int_equal(p.ngroup, 3);
    assert_true(p.search->greatest);
    assert_int_equal(p.search->most, 100);
    for (int i = 0; i < p.nrun; i++)
        for (int k = 0; k < p.nrun; k++)
            assert_int_equal(p.group[i] == p.group[k],
                             p.run[i].model.nbody == p.run[k].model.nbody);
    plan_free(&p);
}

static void a_setting_of_the_command_ends_the_search_of_its_key(void **state)
{
    (void)state;
    const char *path = scratch_write(
        &scratch, "study.yaml",
        HEAD SIZES "optimise:\n  least: makespan\n  over:\n"
                   "    machine.network.link.bandwidth: {from: 100 MB/s, to: 10 GB/s}\n"
                   "    machine.network.hop_latency: {from: 1 us, to: 2 us}\n");
    const char *const set[] = {"machine.network.link.bandwidth=200 MB/s"};
    struct plan p = scratch_plan(path, set, 1);
    assert_int_equal(p.search->nrange, 1);
    assert_string_equal(p.search->range[0].key, "machine.network.hop_latency");
    assert_true(p.run[0].machine.network.link_bandwidth == 200e6);
    plan_free(&p);
}

static void another_value_of_a_run_is_a_run_of_its_own(void **state)
{
    (void)state;
    struct plan p = plan_of("optimise:\n  least: makespan\n  over:\n"
                            "    machine.network.hop_latency: {from: 1 us, to: 4 us}\n" SIZES);
    struct run_spec run;
    struct err e;
    const char *key = "machine.network.hop_latency", *good = "3 us", *bad = "3 kg";
    err_clear(&e);
    assert_true(plan_vary(&p, 0, 1, &key, &good, &run, &e));
    assert_true(fabs(run.machine.network.hop_latency - 3e-6) < 1e-18);
    assert_string_not_equal(run.config_hash, p.run[0].config_hash);
    assert_false(plan_vary(&p, 0, 1, &key, &bad, &run, &e));
    assert_int_equal(e.kind, ERR_DATA);
    plan_free(&p);
}

/* ---- ranges ---- */

static const struct {
    const char *low, *high, *scale;
    double u;
    const char *text;
} ranged[] = {
    {"100 MB/s", "1 GB/s", "linear", 0.5, "550 MB/s"},
    {"100 MB/s", "1 GB/s", "log", 0, "100 MB/s"},
    {"100 MB/s", "1 GB/s", "log", 1, "1 GB/s"},
    {"100 MB/s", "10 GB/s", "log", 0.5, "1 GB/s"},
    {"100 MB/s", "1 GB/s", "log", 0.5, "316.2 MB/s"}, /* sqrt(10), to four digits */
};

static void a_point_of_a_range_is_the_text_of_a_setting(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    for (size_t i = 0; i < sizeof ranged / sizeof *ranged; i++) {
        char text[300];
        snprintf(text, sizeof text,
                 "optimise:\n  least: makespan\n  over:\n    machine.network.link.bandwidth: "
                 "{from: %s, to: %s, scale: %s}\n" SIZES,
                 ranged[i].low, ranged[i].high, ranged[i].scale);
        struct plan p = plan_of(text);
        assert_string_equal(range_text(&p.search->range[0], ranged[i].u, a), ranged[i].text);
        plan_free(&p);
    }
    arena_destroy(a);
}

/* Neither the difference nor the ratio of their ends is a double. */
static void a_range_may_be_wider_than_a_double(void **state)
{
    (void)state;
    static const struct field bare = {.key = "x", .kind = FIELD_REAL};
    struct range r = {.key = "x", .field = &bare, .low = -1.6e308, .high = 1.6e308};
    struct arena *a = arena_create();
    assert_string_equal(range_text(&r, 0.5, a), "0");
    assert_string_equal(range_text(&r, 0.75, a), "8e307");
    r = (struct range){.key = "x", .field = &bare, .low = 1e-300, .high = 1e300, .log = true};
    assert_string_equal(range_text(&r, 0.5, a), "1");
    assert_string_equal(range_text(&r, 0.75, a), "1e150");
    arena_destroy(a);
}

/* ---- what is refused ---- */

#define OVER "  over: {kernel.solver: [cr, pcr-symmetric]}\n"
#define OF "    of: {n: {from: 8, to: 16}}\n"

static const struct {
    const char *text;
    int line;
    const char *message;
} wrong[] = {
    {"sweep:\n  sample: 5\n", 5, "expected {points: 64, of:"},
    {"sweep:\n  sample:\n    points: 4\n", 5, "sample: of is missing"},
    {"sweep:\n  sample:\n" OF, 5, "sample: points is missing"},
    {"sweep:\n  sample:\n    points: none\n" OF, 6, "points: 'none'"},
    {"sweep:\n  sample:\n    points: 0\n" OF, 6, "points: '0'"},
    {"sweep:\n  sample:\n    points: 4\n    point: 4\n" OF, 7, "did you mean 'points'"},
    {"sweep:\n  sample:\n    points: 4\n    zzz: 4\n" OF, 7, "expected points, method, seed, of"},
    {"sweep:\n  sample:\n    points: 4\n    method: sobel\n" OF, 7, "did you mean 'sobol'"},
    {"sweep:\n  sample:\n    points: 4\n    method: [1]\n" OF, 7,
     "expected sobol, latin-hypercube, halton or random"},
    {"sweep:\n  sample:\n    points: 4\n    seed: -1\n" OF, 7, "seed: '-1'"},
    {"sweep:\n  sample:\n    points: 4\n    of: [n]\n", 7, "expected 1 to 40 keys"},
    {"sweep:\n  sample:\n    points: 4\n    of: {}\n", 7, "expected 1 to 40 keys"},
    {"sweep:\n  sample:\n    points: 4\n    of: {modl.n: {from: 1, to: 2}}\n", 7,
     "did you mean 'model.n'"},
    {"sweep:\n  sample:\n    points: 4\n    of: {n: []}\n", 7, "at least one value"},
    {"sweep:\n  sample:\n    points: 4\n    of: {n: 7}\n", 7, "expected a list of values, or a"},
    {"sweep:\n  sample:\n    points: 4\n    of: {n: {from: 8}}\n", 7, "or a range such as"},
    {"sweep:\n  sample:\n    points: 4\n    of: {n: {from: 8, to: 8}}\n", 7,
     "'from' has to be below 'to'"},
    {"sweep:\n  sample:\n    points: 4\n    of: {n: {from: 8, to: 9, scales: log}}\n", 7,
     "did you mean 'scale'"},
    {"sweep:\n  sample:\n    points: 4\n    of: {n: {from: 8, to: 9, scale: cubic}}\n", 7,
     "expected linear or log"},
    {"sweep:\n  sample:\n    points: 4\n"
     "    of: {machine.network.hop_latency: {from: 0 us, to: 9 us, scale: log}}\n",
     7, "expected linear, as the range begins at 0"},
    {"sweep:\n  sample:\n    points: 4\n    of: {kernel.solver: {from: cr, to: pcr}}\n", 7,
     "no number, so it has no range"},
    {"sweep:\n  sample:\n    points: 4\n    of: {n: {from: 8 kg, to: 9 kg}}\n", 7, "8 kg"},
    {"optimise: fast\n", 4, "expected {least: makespan"},
    {"optimise:\n" OVER, 4, "the goal is missing"},
    {"optimise:\n  least: makespan\n", 4, "'over' is missing"},
    {"optimise:\n  least: makespan\n  greatest: speedup\n" OVER, 6, "one goal: least or greatest"},
    {"optimise:\n  least: 'makespan +'\n" OVER, 5, "least: 'makespan +'"},
    {"optimise:\n  least: [1]\n" OVER, 5, "expected a formula such as makespan"},
    {"optimise:\n  least: makespan\n  within: '(('\n" OVER, 6, "within: '(('"},
    {"optimise:\n  lest: makespan\n" OVER, 5, "did you mean 'least'"},
    {"optimise:\n  zzz: makespan\n" OVER, 5, "expected least, greatest, within, over, runs"},
    {"optimise:\n  least: makespan\n  runs: 3\n" OVER, 6, "runs: '3'"},
    {"optimise:\n  least: makespan\n  over: [n]\n", 6, "expected keys with lists or ranges"},
    {"optimise:\n  least: makespan\n  over: {modl.n: {from: 1, to: 2}}\n", 6,
     "did you mean 'model.n'"},
    {"sweep: {n: [8, 16]}\noptimise:\n  least: makespan\n  over: {n: {from: 8, to: 16}}\n", 4,
     "'model.n' is swept here and searched in line 7"},
};

static void what_is_wrong_is_told_at_its_line(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char text[4096];
        struct plan p;
        struct plan_options o = {0};
        struct err e;
        err_clear(&e);
        snprintf(text, sizeof text, HEAD "%s", wrong[i].text);
        if (plan_read(&p, scratch_write(&scratch, "wrong.yaml", text), &o, &e))
            fail_msg("%zu: not refused: %s", i, wrong[i].message);
        assert_int_equal(e.kind, ERR_DATA);
        if (!strstr(e.text, wrong[i].message))
            fail_msg("%zu: '%s' instead of '%s'", i, e.text, wrong[i].message);
        if (e.line != wrong[i].line)
            fail_msg("%zu: line %d instead of %d: %s", i, e.line, wrong[i].line, e.text);
    }
}

/* The keys of a sample with `points` points, each drawn from one or two values. */
static void read_keys(const char *const *key, int n, int points, struct err *e)
{
    struct text t = {0};
    struct plan p;
    struct plan_options o = {0};
    err_clear(e);
    text_add(&t, HEAD "sweep:\n  sample:\n    points: %d\n    method: random\n    of:\n", points);
    for (int i = 0; i < n; i++) text_add(&t, "      %s\n", key[i]);
    if (plan_read(&p, scratch_write(&scratch, "large.yaml", t.s), &o, e)) plan_free(&p);
    text_free(&t);
}

/* A few lines must not ask for any amount of memory. */
static void a_sample_too_large_is_refused_by_its_product(void **state)
{
    (void)state;
    static const char *const key[] = {"n: [8, 16]",
                                      "ranks: [4]",
                                      "seed: [1]",
                                      "machine.network.hop_latency: [1 us]",
                                      "machine.network.end_latency: [1 us]",
                                      "machine.network.credit_latency: [0 us]",
                                      "machine.network.routing_latency: [0 us]",
                                      "machine.network.vc_allocation_latency: [0 us]",
                                      "machine.network.link.bandwidth: [1 GB/s]",
                                      "machine.network.injection.bandwidth: [1 GB/s]",
                                      "machine.network.ejection.bandwidth: [1 GB/s]"};
    struct err e;
    read_keys(key, 11, 100000, &e);
    assert_int_equal(e.kind, ERR_DATA);
    assert_non_null(strstr(e.text, "100000 points of 11 keys are more than 1000000 values"));
    read_keys(key, 11, 2, &e);
    assert_int_equal(e.kind, ERR_NONE);
}

static void a_sample_has_at_most_forty_keys(void **state)
{
    (void)state;
    char name[41][32];
    const char *key[41];
    struct err e;
    for (int i = 0; i < 41; i++) {
        snprintf(name[i], sizeof name[i], "unknown%d: [1]", i);
        key[i] = name[i];
    }
    read_keys(key, 41, 2, &e);
    assert_non_null(strstr(e.text, "expected 1 to 40 keys"));
    read_keys(key, 40, 2, &e);
    assert_non_null(strstr(e.text, "unknown0"));
    assert_null(strstr(e.text, "expected 1 to 40 keys"));
}

/* ---- conditions ---- */

static bool holds(const char *text, const struct run_spec *run)
{
    struct arena *a = arena_create();
    struct condition c;
    struct err e;
    bool truth = false;
    err_clear(&e);
    if (!condition_read(&c, text, "--only", 0, a, &e) || !condition_holds(&c, run, &truth, &e))
        fail_msg("%s: %s", text, e.text);
    arena_destroy(a);
    return truth;
}

static void conditions_see_what_will_run(void **state)
{
    (void)state;
    struct plan p = plan_of("kernel.solver: cr\n" SIZES);
    static const char *const true_ones[] = {"n == 16",
                                            "P == 4",
                                            "ranks == 4",
                                            "n_over_p == 4",
                                            "processors >= 64",
                                            "machine.processors == processors",
                                            "kernel == forward",
                                            "kernel.solver == 'cr'",
                                            "machine == 't3e-300'",
                                            "level != flit",
                                            "n >= P and n % P == 0",
                                            "machine.network.link.bandwidth > 100 MB/s",
                                            "not (n < P)",
                                            "log2(n) == 4",
                                            "seed == 1"};
    static const char *const false_ones[] = {
        "n == 17",       "P > n",
        "n_over_p < 4",  "kernel.solver == pcr",
        "level == flit", "machine.network.link.bandwidth > 100 GB/s",
        "not n >= P"};
    for (size_t i = 0; i < sizeof true_ones / sizeof *true_ones; i++)
        if (!holds(true_ones[i], &p.run[0])) fail_msg("%s is false", true_ones[i]);
    for (size_t i = 0; i < sizeof false_ones / sizeof *false_ones; i++)
        if (holds(false_ones[i], &p.run[0])) fail_msg("%s is true", false_ones[i]);
    plan_free(&p);
}

static void a_condition_that_is_none_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } bad[] = {
        {"n +", "condition 'n +'"},
        {"n", "a value, not a condition"},
        {"bandwith > 3", "unknown name 'bandwith'"},
        {"kernel.solvr == cr", "did you mean 'kernel.solver'"},
        {"zzzzzzzzzzzz == 1", "unknown name 'zzzzzzzzzzzz'"},
        {"machine.network.hop_latency > 3 MB/s", "condition 'machine.network.hop_latency"},
        {"n < 3 < 4", "a second comparison"},
    };
    struct plan p = plan_of(SIZES);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct arena *a = arena_create();
        struct condition c;
        struct err e;
        bool truth;
        err_clear(&e);
        if (condition_read(&c, bad[i].text, "--only", 0, a, &e) &&
            condition_holds(&c, &p.run[0], &truth, &e))
            fail_msg("%s: taken", bad[i].text);
        assert_int_equal(e.kind, ERR_USAGE);
        if (!strstr(e.text, bad[i].message)) fail_msg("%s: %s", bad[i].text, e.text);
        arena_destroy(a);
    }
    plan_free(&p);
}

static void when_leaves_points_out(void **state)
{
    (void)state;
    struct plan p = plan_of("sweep:\n  n: [8, 16, 32]\n  ranks: [4, 8, 16, 32]\n"
                            "  when: P <= n and n_over_p <= 2\n");
    assert_int_equal(p.nrun, 6);
    for (int i = 0; i < p.nrun; i++)
        assert_true(p.run[i].nrank <= p.run[i].model.nbody &&
                    p.run[i].model.nbody <= 2 * p.run[i].nrank);
    /* the numbers are those of the whole product, so that a shard means the same points */
    assert_int_equal(p.point[0], 0);
    for (int i = 1; i < p.nrun; i++) assert_true(p.point[i] > p.point[i - 1]);
    assert_int_equal(p.point[p.nrun - 1], 11);
    plan_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sample_has_as_many_points_as_asked_for_within_the_range),
        cmocka_unit_test(the_same_seed_gives_the_same_points_and_another_seed_others),
        cmocka_unit_test(a_latin_hypercube_has_one_point_a_slice),
        cmocka_unit_test(a_range_of_whole_numbers_gives_whole_numbers),
        cmocka_unit_test(a_sample_is_one_axis_beside_others),
        cmocka_unit_test(a_search_stands_at_the_middle_of_its_ranges),
        cmocka_unit_test(a_search_is_made_for_each_point_of_the_sweep),
        cmocka_unit_test(a_setting_of_the_command_ends_the_search_of_its_key),
        cmocka_unit_test(another_value_of_a_run_is_a_run_of_its_own),
        cmocka_unit_test(a_point_of_a_range_is_the_text_of_a_setting),
        cmocka_unit_test(a_range_may_be_wider_than_a_double),
        cmocka_unit_test(what_is_wrong_is_told_at_its_line),
        cmocka_unit_test(a_sample_too_large_is_refused_by_its_product),
        cmocka_unit_test(a_sample_has_at_most_forty_keys),
        cmocka_unit_test(conditions_see_what_will_run),
        cmocka_unit_test(a_condition_that_is_none_is_refused),
        cmocka_unit_test(when_leaves_points_out),
    };
    return cmocka_run_group_tests(tests, open_scratch, close_scratch);
}
