/* test_level_choice.c - the cheapest level within a tolerance, and which runs share a ladder. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "spec/identity.h"
#include "study/level_choice.h"
#include "study/trial.h"

/* As a ladder may have measured them, in no order. */
static const struct level_error measured[] = {
    {"flit", 0, "P=8"}, {"packet", 1e-3, "P=8"}, {"auto", 1e-3, "P=8"}, {"link", 8e-3, "P=8"},
    {"closed form", 0, "P=8"}, {"loggp", 0.3, "P=8"},
};
enum { MEASURED = sizeof measured / sizeof *measured };

static const char *cheapest(double tolerance)
{
    int k = level_cheapest(measured, MEASURED, tolerance);
    return k < 0 ? "none" : measured[k].level;
}

static void the_cheapest_level_within_the_tolerance_is_taken(void **state)
{
    (void)state;
    assert_string_equal(cheapest(0.5), "loggp");
    assert_string_equal(cheapest(0.3), "loggp"); /* the bound itself is within */
    assert_string_equal(cheapest(0.29), "link");
    assert_string_equal(cheapest(2e-3), "auto"); /* the times of packet for less */
    assert_string_equal(cheapest(0), "flit");    /* a formula is no level that could run a kernel */
    assert_int_equal(level_cheapest(measured + 1, MEASURED - 1, 1e-4), -1);
}

static void a_run_takes_the_level_and_is_the_run_at_that_level(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct run_spec s = {.machine = trial_machine(8), .nrank = 8}, plain = s;
    struct level_choice choice;
    s.machine.network.level = LEVEL_AUTO_TOLERANCE;
    s.machine.network.tolerance = 0.01;
    run_identify(&s, a);
    char asked[65];
    memcpy(asked, s.config_hash, sizeof asked);
    level_take(&s, &measured[3], &choice, a);
    assert_int_equal(s.machine.network.level, LEVEL_LINK);
    assert_true(choice.made && choice.error == 8e-3 && choice.tolerance == 0.01);
    assert_string_equal(choice.at, "P=8");
    /* Its identity is its own: not that of the question, but that of a run that asks for the level
     * at once. */
    assert_string_not_equal(s.config_hash, asked);
    plain.machine.network.level = LEVEL_LINK;
    plain.machine.network.tolerance = 0.02; /* the default */
    run_identify(&plain, a);
    assert_string_equal(s.config_hash, plain.config_hash);
    assert_non_null(strstr(s.config_text, "machine.network.level = link\n"));
    arena_destroy(a);
}

static void a_family_is_alike_but_for_its_size(void **state)
{
    (void)state;
    struct run_spec a = {.scenario = "one", .machine = trial_machine(8), .nrank = 8}, b = a;
    char one[65], other[65];
    b.nrank = 128, b.model.nbody = 500, b.model.seed = 7, b.seed = 3, b.record.links = true;
    b.machine.network.level = LEVEL_AUTO_TOLERANCE, b.machine.network.tolerance = 0.5;
    strcpy(b.scenario, "two");
    level_family(&a, one);
    level_family(&b, other);
    assert_string_equal(one, other);
    b.machine.network.link_bandwidth *= 2;
    level_family(&b, other);
    assert_string_not_equal(one, other);
    b = a, b.kernel.solver = SOLVER_CR;
    level_family(&b, other);
    assert_string_not_equal(one, other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_cheapest_level_within_the_tolerance_is_taken),
        cmocka_unit_test(a_run_takes_the_level_and_is_the_run_at_that_level),
        cmocka_unit_test(a_family_is_alike_but_for_its_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
