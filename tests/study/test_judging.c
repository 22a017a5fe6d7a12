/* test_judging.c - how answers of studies are graded and searched: errors by hand, grades at their
 * limits, and saturation by a probe whose answer is known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/random.h"
#include "study/accuracy_ladder.h"
#include "study/load.h"
#include "study/stability_scene.h"
#include "study/trial.h"

static void errors_are_of_the_largest_number(void **state)
{
    (void)state;
    static const struct {
        double x[3], reference[3], error, change; /* change: with a beginning of 8, 0, 0 */
    } row[] = {
        {{1, 2, 4}, {1, 2, 4}, 0, 0},
        {{1, 2, 5}, {1, 2, 4}, 0.25, 0.125},
        {{1.5, 2, 4}, {1, 2, 4}, 0.125, 0.0625},
        {{1, 2, -4}, {1, 2, 4}, 2, 1},
        /* without a scale the difference itself */
        {{0, 0.5, 0}, {0, 0, 0}, 0.5, 0.0625},
        {{0, 0, 0}, {0, 0, 0}, 0, 0},
        /* no numbers are no answer, and none to be held against */
        {{NAN, 2, 4}, {1, 2, 4}, INFINITY, INFINITY},
        {{1, 2, -INFINITY}, {1, 2, 4}, INFINITY, INFINITY},
        {{1, 2, 4}, {1, NAN, 4}, INFINITY, INFINITY},
        {{1, 2, 4}, {1, 2, INFINITY}, INFINITY, INFINITY},
    };
    static const double begin[] = {8, 0, 0};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const double error = trial_error(row[i].x, row[i].reference, 3),
                     change = trial_change_error(row[i].x, row[i].reference, begin, 3);
        if (error != row[i].error || change != row[i].change)
            fail_msg("row %d: %g and %g", (int)i, error, change);
    }
    assert_true(trial_error(NULL, NULL, 0) == 0);
}

static void grades_change_at_their_limits(void **state)
{
    (void)state;
    static const struct {
        double error;
        enum stability_status twice, once; /* of double, of single precision */
    } row[] = {
        {0, STABILITY_OK, STABILITY_OK},
        {1e-8, STABILITY_OK, STABILITY_OK},
        {1.001e-8, STABILITY_DEGRADED, STABILITY_OK},
        {1e-3, STABILITY_DEGRADED, STABILITY_OK},
        {1.001e-3, STABILITY_DEGRADED, STABILITY_DEGRADED},
        {1e-2, STABILITY_DEGRADED, STABILITY_DEGRADED},
        {1.001e-2, STABILITY_FAILED, STABILITY_DEGRADED},
        {1e-1, STABILITY_FAILED, STABILITY_DEGRADED},
        {1.001e-1, STABILITY_FAILED, STABILITY_FAILED},
        {INFINITY, STABILITY_FAILED, STABILITY_FAILED},
        {NAN, STABILITY_FAILED, STABILITY_FAILED},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        for (int single = 0; single < 2; single++) {
            struct stability_row x = {.reason = ""};
            row_grade(&x, row[i].error, single);
            assert_int_equal(x.status, single ? row[i].once : row[i].twice);
            /* what is no number is none in the row, and the reason says so */
            const bool number = isfinite(row[i].error);
            assert_true(number ? x.error == row[i].error : isnan(x.error));
            assert_int_equal(x.reason[0] != '\0', !number);
            struct accuracy_rung rung = {.error = 1};
            ladder_grade(&rung, row[i].error, single ? 1e-3 : 1e-8, single ? 1e-1 : 1e-2);
            assert_int_equal(rung.status, x.status == STABILITY_OK         ? RUNG_OK
                                          : x.status == STABILITY_DEGRADED ? RUNG_DEGRADED
                                                                           : RUNG_FAILED);
        }
}

/* As many rows as are added, the first ones unchanged, each failed until it is graded. */
static void rows_begin_as_failures_and_stay_in_order(void **state)
{
    (void)state;
    enum { ROWS = 1100 };
    struct arena *a = arena_create();
    struct stability_report r = {.arena = a};
    struct accuracy_report accuracy = {.arena = a};
    struct ladder l = {.report = &accuracy, .name = "network", .at = "P=8", .family = "f"};
    char name[24];
    for (int i = 0; i < ROWS; i++) {
        snprintf(name, sizeof name, "scene %d", i);
        struct stability_row *x = row_add(&r, name, "aba", "double");
        assert_int_equal(x->status, STABILITY_FAILED);
        assert_true(isnan(x->error) && isnan(x->growth) && isnan(x->step_s));
        assert_int_equal(x->refinements, -1);
        assert_string_equal(x->reason, "");
        row_grade(x, i * 1e-10, false);
        struct accuracy_rung *g = ladder_add(&l, "link", name, "makespan", "flit");
        assert_int_equal(g->status, RUNG_FAILED);
        assert_true(isnan(g->error) && isnan(g->host_s) && g->machine_ps == -1);
        ladder_grade(g, i, ROWS / 2, ROWS);
    }
    assert_int_equal(r.nrow, ROWS);
    assert_int_equal(accuracy.nrung, ROWS);
    for (int i = 0; i < ROWS; i++) {
        snprintf(name, sizeof name, "scene %d", i);
        assert_string_equal(r.row[i].subject, name);
        assert_int_equal(r.row[i].status, i <= 100 ? STABILITY_OK : STABILITY_DEGRADED);
        assert_string_equal(accuracy.rung[i].rung, name);
        assert_string_equal(accuracy.rung[i].ladder, "network");
        assert_int_equal(accuracy.rung[i].status, i <= ROWS / 2 ? RUNG_OK : RUNG_DEGRADED);
    }
    /* names that are too long are cut, not written beyond their place */
    char longest[200];
    memset(longest, 'x', sizeof longest);
    longest[199] = '\0';
    struct stability_row *x = row_add(&r, longest, longest, longest);
    assert_true(strlen(x->subject) < sizeof x->subject && strlen(x->precision) < 8);
    arena_destroy(a);
}

/* Every scene of the suite up to some size is made as its name says. */
static void scenes_are_what_their_names_say(void **state)
{
    (void)state;
    int n;
    const struct stability_scene *list = scene_list(&n);
    assert_true(n > 50);
    for (int i = 0; i < n; i++) {
        struct model *m;
        struct state *s;
        struct err e;
        for (int k = 0; k < i; k++) assert_string_not_equal(list[k].name, list[i].name);
        if (list[i].spec.nbody > 128) continue;
        struct arena *a = arena_create();
        err_clear(&e);
        if (!scene_build(&list[i], a, &m, &s, &e)) fail_msg("%s: %s", list[i].name, e.text);
        double least = INFINITY, most = 0;
        for (int b = 0; b < m->nbody; b++) {
            least = fmin(least, m->body[b].mass);
            most = fmax(most, m->body[b].mass);
        }
        if (list[i].spread == SPREAD_RANDOM)
            assert_true(most / least <= list[i].ratio * (1 + 1e-9) && most / least > 10);
        else if (list[i].spread != SPREAD_EVEN)
            assert_true(fabs(most / least / list[i].ratio - 1) < 1e-9);
        const double *mass_of = &m->body[0].mass;
        if (list[i].spread == SPREAD_UP) assert_true(*mass_of == least);
        if (list[i].spread == SPREAD_DOWN) assert_true(*mass_of == most);
        const double *g = m->gravity;
        assert_true((g[0] == 0 && g[1] == 0 && g[2] == 0) == list[i].weightless);
        for (int k = 0; k < m->nu && list[i].at_rest; k++) assert_true(s->qd[k] == 0);
        arena_destroy(a);
    }
}

/* A network that saturates at a known load; loads within `blur` of it cannot be told. */
struct known {
    double at, blur;
    int asked, refuse; /* refuse: the probe that fails, -1: none */
};

static bool probe(void *context, double offered, struct load_point *p, struct err *e)
{
    struct known *k = context;
    assert_true(offered > 0 && offered <= 1);
    if (k->asked++ == k->refuse) return err_set(e, ERR_CONFIG, "no answer");
    *p = (struct load_point){
        .offered = offered, .mean_ps = 300 + (offered - k->at) * 1e4, .half_ps = k->blur * 1e4};
    return true;
}

static void saturation_is_found_to_a_hundredth(void **state)
{
    (void)state;
    struct random x = random_make(41, 0, 0);
    for (int round = 0; round < 500; round++) {
        struct known k = {.at = random_uniform(&x, 0.01, 1.2), .refuse = -1};
        /* a bound by the routes: below, near or far above, or not known */
        struct load_series s = {.empty_ps = 100,
                                .bound = round % 4 == 0 ? NAN : k.at * random_uniform(&x, 0.5, 2)};
        struct err e;
        err_clear(&e);
        if (round % 3 == 0) k.blur = 0.002 * k.at;
        assert_true(load_saturate(&s, probe, &k, &e));
        assert_int_equal(s.probes, k.asked);
        if (k.at - k.blur > 1) {
            assert_true(isnan(s.saturation) && isnan(s.high) && s.low == 1);
            continue;
        }
        if (isnan(s.saturation)) { /* the first load could not be told */
            assert_true(k.blur > 0);
            continue;
        }
        assert_true(s.low < s.high && s.low <= k.at + k.blur && s.high >= k.at - k.blur);
        assert_true(s.saturation > s.low && s.saturation < s.high);
        assert_true(fabs(s.saturation - k.at) <= 0.01 * s.high + k.blur + 1e-12);
    }
}

static void a_probe_that_fails_ends_the_search(void **state)
{
    (void)state;
    for (int refuse = 0; refuse < 4; refuse++) {
        struct known k = {.at = 0.5, .refuse = refuse};
        struct load_series s = {.empty_ps = 100, .bound = 0.4};
        struct err e;
        err_clear(&e);
        assert_false(load_saturate(&s, probe, &k, &e));
        assert_int_equal(e.kind, ERR_CONFIG);
        assert_int_equal(k.asked, refuse + 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_of_the_largest_number),
        cmocka_unit_test(grades_change_at_their_limits),
        cmocka_unit_test(rows_begin_as_failures_and_stay_in_order),
        cmocka_unit_test(scenes_are_what_their_names_say),
        cmocka_unit_test(saturation_is_found_to_a_hundredth),
        cmocka_unit_test(a_probe_that_fails_ends_the_search),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
