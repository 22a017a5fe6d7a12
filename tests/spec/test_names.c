/* test_names.c - what runs are called, and settings as numbers in base units. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "spec/run_label.h"
#include "spec/setting_number.h"
#include "spec/spec_fields.h"

static void short_keys_are_unique_and_say_something(void **state)
{
    (void)state;
    assert_string_equal(field_short_key(&machine_table, "network.hop_latency"), "hop_latency");
    assert_string_equal(field_short_key(&machine_table, "network.link.bandwidth"),
                        "link.bandwidth");
    assert_string_equal(field_short_key(&machine_table, "placement.kind"), "placement.kind");
    assert_string_equal(field_short_key(&machine_table, "topology.dims"), "topology.dims");
    /* No two rows of the table share one. */
    for (int i = 0; i < machine_table.nfield; i++)
        for (int j = 0; j < i; j++)
            assert_string_not_equal(field_short_key(&machine_table, machine_table.field[i].key),
                                    field_short_key(&machine_table, machine_table.field[j].key));
}

static void is_called(const char *name, const char *changes, const char *expected)
{
    struct text t = {0};
    run_label_changed(name, changes, &t);
    assert_string_equal(t.s, expected);
    text_free(&t);
}

static void a_changed_machine_is_named_by_its_changes(void **state)
{
    (void)state;
    is_called("t3e-300", NULL, "t3e-300");
    is_called("t3e-300", "{}", "t3e-300");
    is_called("t3e-300", "{\"network.hop_latency\": \"60 us\"}", "t3e-300, hop_latency 60 us");
    is_called("x", "{\"topology.dims\": \"[8, 4, 4]\", \"node.call\": \"3 us\"}",
              "x, topology.dims 8x4x4, node.call 3 us");
    /* A key that is not known any more is told in full; quotes are read back. */
    is_called("x", "{\"network.gone\": \"a \\\"b\\\" c\"}", "x, network.gone a \"b\" c");
    /* Half an object ends where it ends. */
    is_called("x", "{\"network.hop_latency\": \"60 us\", \"node.c", "x, hop_latency 60 us");
    is_called("x", "not an object", "x");
}

static void many_or_long_changes_stay_told_apart(void **state)
{
    (void)state;
    struct text a = {0}, b = {0};
    run_label_changed("x", "{\"node.clock\": \"1 GHz\", \"node.div\": \"2 cycles\", "
                           "\"node.sqrt\": \"3 cycles\", \"node.trig\": \"4 cycles\"}", &a);
    run_label_changed("x", "{\"node.clock\": \"1 GHz\", \"node.div\": \"2 cycles\", "
                           "\"node.sqrt\": \"3 cycles\", \"node.trig\": \"5 cycles\"}", &b);
    assert_non_null(strstr(a.s, "node.sqrt 3 cycles and 1 more ("));
    assert_string_not_equal(a.s, b.s);
    text_free(&a);
    text_free(&b);
    run_label_changed(
        "x", "{\"software.collectives\": \"a very long text that no legend has room for\"}", &a);
    assert_non_null(strstr(a.s, "x, collectives changed ("));
    text_free(&a);
}

static void a_given_name_goes_before_all(void **state)
{
    (void)state;
    static struct run_spec run;
    struct text t = {0};
    memset(&run, 0, sizeof run);
    text_copy(run.machine.name, sizeof run.machine.name, "t3e-300");
    run.machine_changes = "{\"node.call\": \"3 us\"}";
    run_label(&run, &t);
    text_add(&t, "|");
    text_copy(run.machine.label, sizeof run.machine.label, "Cray");
    run_label(&run, &t);
    text_add(&t, "|");
    text_copy(run.label, sizeof run.label, "slow calls");
    run_label(&run, &t);
    text_add(&t, "|");
    run.called = "slow calls, dims 4";
    run_label(&run, &t);
    assert_string_equal(t.s, "t3e-300, node.call 3 us|Cray, node.call 3 us|slow calls|"
                             "slow calls, dims 4");
    text_free(&t);
}

static void questions_are_no_part_of_a_machine(void **state)
{
    (void)state;
    char a[LABEL_KEY_LENGTH + 1], b[LABEL_KEY_LENGTH + 1];
    machine_fingerprint("ranks = 4\nmachine.name = x\nmachine.network.level = link\nn = 1\n", a);
    machine_fingerprint("ranks = 8\nmachine.name = x\nmachine.network.level = loggp", b);
    assert_string_equal(a, b);
    assert_int_equal(strlen(a), LABEL_KEY_LENGTH);
    machine_fingerprint("machine.name = x\nmachine.node.call = 1 us", b);
    assert_string_not_equal(a, b);
    machine_fingerprint(NULL, b);
    assert_int_equal(strlen(b), LABEL_KEY_LENGTH);
}

static void is_number(const char *key, const char *value, double expected, const char *si)
{
    double number = NAN;
    enum unit unit;
    if (!setting_number(key, value, &number, &unit)) fail_msg("%s = %s is no number", key, value);
    if (fabs(number - expected) > 1e-12 * fabs(expected)) fail_msg("%s: %.17g", value, number);
    assert_string_equal(units_si(unit), si);
}

static void is_word(const char *key, const char *value)
{
    double number;
    enum unit unit;
    if (setting_number(key, value, &number, &unit)) fail_msg("%s = %s is a number", key, value);
}

static void settings_are_numbers_in_base_units(void **state)
{
    (void)state;
    is_number("machine.network.hop_latency", "60 us", 60e-6, "s");
    is_number("machine.network.link.bandwidth", "960 MB/s", 960e6, "B_per_s");
    is_number("kernel.message", "64 KiB", 65536, "B");
    is_number("machine.noise.compute", "20 %", 0.2, "fraction");
    is_number("ranks", "128", 128, "");
    is_number("seed", "7", 7, "");
    is_word("machine.network.level", "link");
    is_word("machine.topology.dims", "[8, 4, 4]");
    is_word("machine.network.buffer", "unlimited");
    is_word("machine.network.hop_latency", "60");
    is_word("no.such.key", "60");
    /* Parameters of programs: a plain number, or what only one kind of quantity can be. */
    is_number("program.size", "1024", 1024, "");
    is_number("program.block", "4 KiB", 4096, "B");
    is_number("program.pause", "3 ms", 3e-3, "s");
    is_word("program.method", "jacobi");
    is_word("program.method", "");
}

/* n only where it says something: of bodies, or of a parameter that is called so. */
static void sizes_name_n_where_there_is_one(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct run_spec run;
    run_spec_defaults(&run, a);
    run.model.nbody = 134217728;
    assert_string_equal(run_size(&run, 1048576).s, ", n = 134217728, P = 1048576");
    text_copy(run.kernel.name, sizeof run.kernel.name, "pingpong");
    assert_string_equal(run_size(&run, 2).s, ", P = 2");
    run.kernel.own = true;
    assert_string_equal(run_size(&run, 2).s, ", P = 2");
    run.program.parameters = "bytes = 8 B\nrun = 3\n";
    assert_string_equal(run_size(&run, 2).s, ", P = 2");
    run.program.parameters = "bytes = 8 B\nn = 134217728\n";
    assert_string_equal(run_size(&run, 3).s, ", n = 134217728, P = 3");
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(short_keys_are_unique_and_say_something),
        cmocka_unit_test(a_changed_machine_is_named_by_its_changes),
        cmocka_unit_test(many_or_long_changes_stay_told_apart),
        cmocka_unit_test(a_given_name_goes_before_all),
        cmocka_unit_test(questions_are_no_part_of_a_machine),
        cmocka_unit_test(settings_are_numbers_in_base_units),
        cmocka_unit_test(sizes_name_n_where_there_is_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
