/* test_values.c - values at the edges of what fields take: lists, segments, words for 0, numbers
 * for figures, parameters of people's own programs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "spec/field.h"
#include "spec/field_list.h"
#include "spec/spec_fields.h"

/* Sets `key` in a run of zeros; whether it was taken, and how it prints then. */
static bool take(const char *key, const char *text, char *printed, size_t size, char *why)
{
    static struct run_spec run;
    const struct field_table *t;
    const struct field *f = field_find_full(key, &t);
    struct text out = {0};
    memset(&run, 0, sizeof run);
    if (f == NULL) fail_msg("there is no setting %s", key);
    *why = '\0';
    if (!field_set(f, (char *)&run + t->offset, text, arena, why, 256)) {
        const struct run_spec untouched = {0};
        assert_memory_equal(&run, &untouched, sizeof run);
        return false;
    }
    field_print(f, (char *)&run + t->offset, &out);
    snprintf(printed, size, "%s", out.s);
    text_free(&out);
    return true;
}

static void lists_print_in_one_form(void **state)
{
    (void)state;
    static const struct {
        const char *key, *text, *printed;
    } cases[] = {
        {"machine.topology.dims", "1x2x3x4x5x6x7x8", "[1, 2, 3, 4, 5, 6, 7, 8]"},
        {"machine.topology.dims", "16777216", "[16777216]"},
        {"machine.topology.dims", "8 x 4", "[8, 4]"},
        {"machine.topology.dims", "[8 4]", "[8, 4]"},
        {"machine.placement.list", "[]", "[]"},
        {"machine.placement.list", "[0]", "[0]"},
        {"machine.topology.links", "[]", "[]"},
        {"machine.topology.links", " [ [ 0 , 1 ] ] ", "[[0, 1]]"},
        {"machine.topology.dim_latency", "1 us", "[1 us]"},
        {"machine.topology.dim_latency", "[1 us, 0 s, 2 us, 0 s]", "[1 us, 0 s, 2 us]"},
        {"machine.topology.dim_latency", "[1, 2, 3, 4, 5, 6, 7, 8] us",
         "[1 us, 2 us, 3 us, 4 us, 5 us, 6 us, 7 us, 8 us]"},
        {"machine.topology.dim_latency", "[1 us, 2] ns", "[1 us, 2 ns]"},
        {"machine.topology.dim_latency", "[0 s, 0 s]", "[0 s]"},
        {"model.gravity", "[1, 0, 0] m/s^2", "[1 m/s^2, 0 m/s^2, 0 m/s^2]"},
        {"model.gravity", "1 2 3 m/s^2", "[1 m/s^2, 2 m/s^2, 3 m/s^2]"},
        {"model.gravity", "+1 -2 .5 m/s^2", "[1 m/s^2, -2 m/s^2, 0.5 m/s^2]"},
        {"model.gravity", "0, 0, -9.81 m/s^2", "[0 m/s^2, 0 m/s^2, -9.81 m/s^2]"},
        {"machine.software.segments", "[]", "[]"},
        {"machine.software.segments", "[{from: 0 B}]", "[{from: 0 B}]"},
        {"machine.software.segments", " [ {\n gap : 1 us ,\n from: 0 B } ] ",
         "[{from: 0 B, gap: 1 us}]"},
        {"machine.software.segments",
         "[{from: 0 B, protocol: eager}, {from: 1 B, protocol: "
         "rendezvous, rendezvous.latency: 2 us}]",
         "[{from: 0 B}, {from: 1 B, protocol: rendezvous, rendezvous.latency: 2 us}]"},
        {"machine.software.segments", "[{from: 0 B, send.overhead: 0 s, send.copy: 0 s/B}]",
         "[{from: 0 B, send.overhead: 0 s, send.copy: 0 s/B}]"},
        {"machine.software.eager.limit", "unlimited", "unlimited"},
        {"machine.software.eager.limit", "0 B", "0 B"},
        {"machine.network.flit", "1.5 KiB", "1.536 kB"},
        {"kernel.name", "0123456789012345678901234567890", "0123456789012345678901234567890"},
        {"seed", "18446744073709551615", "18446744073709551615"},
        {"record.links", "on", "true"},
        {"record.links", "no", "false"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char printed[512], why[256];
        if (!take(cases[i].key, cases[i].text, printed, sizeof printed, why))
            fail_msg("%s = %s: %s", cases[i].key, cases[i].text, why);
        assert_string_equal(printed, cases[i].printed);
    }
}

static const struct {
    const char *key, *text, *expected;
} wrong_lists[] = {
    {"machine.topology.dims", "", "empty list"},
    {"machine.topology.dims", "8x", "missing at the end"},
    {"machine.topology.dims", "[8,]", "missing at the end"},
    {"machine.topology.dims", "8,,4", "not a list of whole numbers"},
    {"machine.topology.dims", "[8]]", "brackets do not match"},
    {"machine.topology.dims", "8]", "brackets do not match"},
    {"machine.topology.dims", "[8x4]", "not a list of whole numbers"},
    {"machine.topology.dims", "8.5x4", "not a list of whole numbers"},
    {"machine.topology.dims", "8+4", "not a list of whole numbers"},
    {"machine.topology.dims", "16777217", "out of range"},
    {"machine.topology.dims", "99999999999999999999", "out of range"},
    {"machine.topology.dims", "4294967297", "out of range"},
    {"machine.topology.links", "[0, 1]", "not a list of pairs"},
    {"machine.topology.links", "[[0, 1, 2]]", "not a list of pairs"},
    {"machine.topology.links", "[[0, 1],,[1, 2]]", "not a list of pairs"},
    {"machine.topology.links", "[[0, 1]] 2", "brackets do not match"},
    {"machine.topology.links", "[[0, -1]]", "out of range"},
    {"machine.topology.links", "", "not a list of pairs"},
    {"machine.topology.dim_latency", "[]", "0 numbers; expected 1"},
    {"machine.topology.dim_latency", "[1,2,3,4,5,6,7,8,9] us", "too many entries"},
    {"machine.topology.dim_latency", "[2 s]", "out of range"},
    {"machine.topology.dim_latency", "[1 us] us]", ""},
    {"model.gravity", "[0, , 1] m/s^2", ""},
    {"model.gravity", "[0, 0, 1] kg", "m/s^2"},
    {"model.gravity", "[0, 0, nan] m/s^2", "finite"},
    /* a number of more digits than are read is refused, not cut to another one */
    {"model.gravity",
     "[0, 0, 1.00000000000000000000000000000000000000000000000000000000000000000e3] m/s^2",
     "too long"},
    {"model.gravity",
     "[0, 0, 1] m/s^2                                                        "
     "        rubbish",
     ""},
    {"machine.software.eager.limit", "Unlimited", ""},
    {"machine.network.flit", "unlimited", ""},
    {"machine.network.flit", "-1 B", "negative"},
    {"machine.network.flit", "0 B", "out of range"},
    {"machine.network.flit", "1048577 B", "out of range"},
    {"seed", "", "not a seed"},
    {"seed", " 1", "not a seed"},
    {"seed", "+1", "not a seed"},
    {"seed", "1 ", "not a seed"},
    {"record.links", "True", "'true' or 'false'"},
    {"ranks", "16 777 216", "not a whole number"},
    {"ranks", "16777217", "out of range"},
    {"scenario", "a\tb", "control characters"},
    {"machine.software.collectives", "reduce no-such-way", ""},
};

static void wrong_lists_are_refused_whole(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof wrong_lists / sizeof *wrong_lists; i++) {
        char printed[512], why[256];
        if (take(wrong_lists[i].key, wrong_lists[i].text, printed, sizeof printed, why))
            fail_msg("%s takes '%s' as %s", wrong_lists[i].key, wrong_lists[i].text, printed);
        if (strstr(why, wrong_lists[i].expected) == NULL || why[0] == '\0')
            fail_msg("%s = '%s': %s", wrong_lists[i].key, wrong_lists[i].text, why);
    }
}

static void wrong_segments_are_named(void **state)
{
    (void)state;
    static const struct {
        const char *text, *expected;
    } cases[] = {
        {"", "expected a list of segments"},
        {"{from: 0 B}", "expected a list of segments"},
        {"[from: 0 B]", "expected a list of segments"},
        {"[{}]", "segment 1 has no 'from'"},
        {"[{gap: 1 us}]", "segment 1 has no 'from'"},
        {"[{from: 1 B}]", "the first segment begins at 1 B; expected one from 0 B"},
        {"[{from: 0 B}, {from: 0 B}]", "segments 1 and 2 both begin at 0 B"},
        {"[{from: 0 B}, {from: 9 B}, {from: 8 B}]", "segment 3 begins at 8 B, after one from 9 B"},
        {"[{from: 0 B, from: 0 B}]", "segment 1: 'from' is given twice"},
        {"[{from: 0 B, gaps: 1 us}]", "segment 1: unknown key 'gaps'; did you mean 'gap'?"},
        {"[{from: 0 B, colour: red}]", "segment 1: unknown key 'colour'; expected one of from,"},
        {"[{from: 0 B}, {from: 1 B, gap: 1 m}]", "segment 2: gap '1 m': "},
        {"[{from: 0 B, gap: -1 us}]", "segment 1: gap '-1 us': out of range"},
        {"[{from: 0 B, gap: 11 s}]", "out of range; expected 0 s to 10 s"},
        {"[{from: 0 B, send.overhead: 10.5 s}]", "out of range; expected 0 s to 10 s"},
        {"[{from: 0 B, recv.overhead: 10.5 s}]", "out of range; expected 0 s to 10 s"},
        {"[{from: 0 B, send.copy: 1.5 s/B}]", "out of range; expected 0 s/B to 1 s/B"},
        /* words of as many bytes as there is room for, and longer ones */
        {"[{from: 0 B, abcdefghijklmnopqrstuvwxyz01234: 1 us}]", "unknown key 'abcdefghijklmn"},
        {"[{from: 0 B, abcdefghijklmnopqrstuvwxyz012345: 1 us}]", "expected a list of segments"},
        {"[{from: 0 B, gap: 0.00000000000000000000000000000000000000000000000000000000000001 us}]",
         "segment 1: expected a list of segments"},
        {"[{from: 0 B, protocol: slow}]", "expected one of eager, rendezvous, synchronous"},
        {"[{from: 0 B, rendezvous.latency: 1 us}]", "rendezvous.latency of an eager segment"},
        {"[{from: 0 B, protocol: eager, rendezvous.latency: 1 us}]", "of an eager segment"},
        {"[{from: 0 B", "segment 1"},
        {"[{from: 0 B}", "expected a list of segments"},
        {"[{from: 0 B}] x", "brackets do not match"},
        {"[{from: 0 B} {from: 1 B}]", "expected a list of segments"},
        {"[{from}]", "segment 1: expected a list of segments"},
        {"[{from: 0 B, gap: 1 us recv.copy: 1 us/B}]", "segment 1: gap"},
    };
    char printed[512], why[256], many[512];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        if (take("machine.software.segments", cases[i].text, printed, sizeof printed, why))
            fail_msg("segments '%s' are taken", cases[i].text);
        if (strstr(why, cases[i].expected) == NULL) fail_msg("'%s': %s", cases[i].text, why);
    }
    /* as many as there may be, and one more */
    size_t n = (size_t)snprintf(many, sizeof many, "[{from: 0 B}");
    for (int i = 1; i < SOFTWARE_MAX_SEGMENTS; i++)
        n += (size_t)snprintf(many + n, sizeof many - n, ", {from: %d B}", i);
    snprintf(many + n, sizeof many - n, "]");
    assert_true(take("machine.software.segments", many, printed, sizeof printed, why));
    assert_string_equal(printed, many);
    snprintf(many + n, sizeof many - n, ", {from: 99 B}]");
    assert_false(take("machine.software.segments", many, printed, sizeof printed, why));
    assert_non_null(strstr(why, "more than 8 segments"));
}

static void a_zero_that_is_no_small_number_has_a_word(void **state)
{
    (void)state;
    const struct field_table *t;
    const struct field *f = field_find_full("machine.network.link.bandwidth", &t);
    struct run_spec run = {0};
    struct text out = {0};
    char why[200];
    void *base = &run.machine;
    run.machine.network.link_bandwidth = 5;
    assert_true(field_set(f, base, "unlimited", arena, why, (int)sizeof why));
    assert_true(run.machine.network.link_bandwidth == 0);
    assert_false(field_is_wordless_zero(f, base, "unlimited"));
    assert_true(field_is_wordless_zero(f, base, "0 B/s"));
    field_show(f, base, &out);
    text_add(&out, "|");
    field_print(f, base, &out); /* identities keep the number */
    run.machine.network.link_bandwidth = 1e6;
    text_add(&out, "|");
    field_show(f, base, &out);
    assert_string_equal(out.s, "unlimited|0 B/s|1 MB/s");
    assert_false(field_is_wordless_zero(f, base, "1 MB/s"));
    text_free(&out);
    /* 0 of others is a number */
    const struct field *hop = field_find_full("machine.network.hop_latency", &t);
    assert_false(field_set(hop, base, "unlimited", arena, why, (int)sizeof why));
    assert_false(field_is_wordless_zero(hop, base, "0 s"));
    /* of files and databases, for people: words, also where it stands for another setting */
    const struct field *port = field_find_full("machine.network.injection.bandwidth", &t);
    assert_string_equal(field_word(f, "0 B/s"), "unlimited");
    assert_string_equal(field_word(port, "0 B/s"), "as a link");
    assert_string_equal(field_word(port, "3 MB/s"), "3 MB/s");
    assert_string_equal(field_word(hop, "0 s"), "0 s");
    assert_string_equal(field_word(NULL, "0 s"), "0 s");
}

static void fields_that_hold_a_number_say_it(void **state)
{
    (void)state;
    static const struct {
        const char *key, *text;
        double number; /* NAN: none */
    } cases[] = {
        {"machine.network.hop_latency", "60 us", 60e-6},
        {"machine.network.flit", "4 KiB", 4096},
        {"machine.software.eager.limit", "unlimited", -1},
        {"ranks", "128", 128},
        {"seed", "9007199254740992", 9007199254740992.0},
        {"record.links", "true", NAN},
        {"machine.network.level", "link", NAN},
        {"machine.topology.dims", "[8]", NAN},
        {"model.gravity", "[0, 0, 1] m/s^2", NAN},
        {"kernel.name", "7", NAN},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct run_spec run = {0};
        const struct field_table *t;
        const struct field *f = field_find_full(cases[i].key, &t);
        double number = 0;
        char why[200];
        assert_true(field_set(f, (char *)&run + t->offset, cases[i].text, arena, why, 200));
        bool is = field_number(f, (char *)&run + t->offset, &number);
        assert_true(is == !isnan(cases[i].number));
        if (is && fabs(number - cases[i].number) > 1e-15 * fabs(cases[i].number))
            fail_msg("%s = %s: %.17g", cases[i].key, cases[i].text, number);
    }
}

static void whole_numbers_of_64_bits(void **state)
{
    (void)state;
    int64_t v = 7;
    char why[200];
    assert_true(field_int_parse("9223372036854775807", &v, why, 200));
    assert_true(v == INT64_MAX);
    assert_true(field_int_parse("-9223372036854775808 ", &v, why, 200));
    assert_true(v == INT64_MIN);
    v = 7;
    assert_false(field_int_parse("9223372036854775808", &v, why, 200));
    assert_non_null(strstr(why, "64-bit"));
    assert_false(field_int_parse("16x", &v, why, 200));
    assert_false(field_int_parse(" ", &v, why, 200));
    assert_int_equal(v, 7);
}

/* A clause never runs over its buffer, however short that is. */
static void reasons_fit_their_buffer(void **state)
{
    (void)state;
    static const char *const wrong[][2] = {{"machine.network.level", "lnk"},
                                           {"machine.network.level", ""},
                                           {"machine.software.segments", "[{colour: 1}]"},
                                           {"model.gravity", "[1] m/s^2"},
                                           {"model.n", "0"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        for (int size = 1; size < 120; size++) {
            struct run_spec run = {0};
            const struct field_table *t;
            const struct field *f = field_find_full(wrong[i][0], &t);
            char why[600];
            memset(why, 'x', sizeof why);
            assert_false(field_set(f, (char *)&run + t->offset, wrong[i][1], arena, why, size));
            assert_non_null(memchr(why, '\0', (size_t)size));
            for (size_t k = (size_t)size; k < sizeof why; k++) assert_int_equal(why[k], 'x');
        }
}

static void tables_print_their_rows_in_order(void **state)
{
    (void)state;
    struct run_spec run;
    struct text with = {0}, without = {0};
    field_defaults(&machine_table, &run.machine, arena);
    fields_print(&machine_table, &run.machine, true, &with);
    fields_print(&machine_table, &run.machine, false, &without);
    assert_non_null(strstr(with.s, "machine.title = \n"));
    assert_null(strstr(without.s, "machine.title"));
    int n = 0, labels = 0, lines = 0;
    const char *at = with.s;
    for (; n < machine_table.nfield; n++) {
        char line[128];
        snprintf(line, sizeof line, "machine.%s = ", machine_table.field[n].key);
        assert_memory_equal(at, line, strlen(line));
        at = strchr(at, '\n') + 1;
        labels += machine_table.field[n].label;
    }
    assert_int_equal(*at, '\0');
    for (const char *s = without.s; *s != '\0'; s++) lines += *s == '\n';
    assert_int_equal(lines, n - labels);
    text_free(&with);
    text_free(&without);
}

static void parameters_of_programs(void **state)
{
    (void)state;
    static const char *const ways[] = {"jacobi", "gauss", NULL};
    static const struct field parameter[] = {
        {.key = "size", .kind = FIELD_INT64, .min = 1, .max = 1e6},
        {.key = "block", .kind = FIELD_INT64, .unit = UNIT_BYTES, .min = 0, .max = 1e9},
        {.key = "pause", .kind = FIELD_REAL, .unit = UNIT_TIME, .min = 0, .max = 1},
        {.key = "check", .kind = FIELD_BOOL},
        {.key = "way", .kind = FIELD_CHOICE, .choice = ways},
    };
    const struct program_sheet sheet = {.nparameter = 5, .parameter = parameter};
    static const struct {
        const char *name, *text, *canonical; /* NULL: refused */
    } cases[] = {
        {"size", "1", "1"},        {"size", "0", NULL},          {"size", "1000001", NULL},
        {"size", "4 KiB", NULL},   {"block", "8192 B", "8 KiB"}, {"block", "unlimited", NULL},
        {"pause", "1 s", "1 s"},   {"pause", "1.5 s", NULL},     {"check", "yes", "true"},
        {"way", "gauss", "gauss"}, {"way", "gaus", NULL},
    };
    char why[200];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct field *f = program_sheet_find(&sheet, cases[i].name);
        assert_non_null(f);
        why[0] = '\0';
        const char *text = program_parameter_text(f, cases[i].text, arena, why, 200);
        if (cases[i].canonical == NULL) {
            assert_null(text);
            assert_int_not_equal(why[0], '\0');
        } else {
            assert_non_null(text);
            assert_string_equal(text, cases[i].canonical);
        }
    }
    assert_non_null(strstr(why, "did you mean 'gauss'"));
    assert_null(program_sheet_find(&sheet, "siz"));
    assert_null(program_sheet_find(&sheet, "sizes"));
    assert_null(program_sheet_find(&(struct program_sheet){0}, "size"));
}

static void values_of_programs_travel_as_lines(void **state)
{
    (void)state;
    struct text lines = {0}, printed = {0};
    char value[16] = "none";
    program_lines_add(&lines, "n", "4");
    program_lines_add(&lines, "nn", "a = b");
    program_lines_add(&lines, "empty", "");
    assert_true(program_value_find(lines.s, "n", value, sizeof value));
    assert_string_equal(value, "4");
    assert_true(program_value_find(lines.s, "nn", value, sizeof value));
    assert_string_equal(value, "a = b");
    assert_true(program_value_find(lines.s, "empty", value, sizeof value));
    assert_string_equal(value, "");
    assert_false(program_value_find(lines.s, "a", value, sizeof value));
    assert_false(program_value_find(lines.s, "", value, sizeof value));
    assert_false(program_value_find(NULL, "n", value, sizeof value));
    assert_false(program_value_find("", "n", value, sizeof value));
    assert_true(program_value_find("last = 9", "last", value, sizeof value));
    assert_string_equal(value, "9");
    assert_true(program_value_find(lines.s, "nn", value, 3));
    assert_string_equal(value, "a ");
    program_lines_print(lines.s, &printed);
    assert_string_equal(printed.s, "program.n = 4\nprogram.nn = a = b\nprogram.empty = \n");
    text_free(&printed);
    program_lines_print(NULL, &printed);
    program_lines_print("", &printed);
    assert_true(printed.s == NULL || printed.s[0] == '\0');
    text_free(&printed);
    text_free(&lines);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_print_in_one_form),
        cmocka_unit_test(wrong_lists_are_refused_whole),
        cmocka_unit_test(wrong_segments_are_named),
        cmocka_unit_test(a_zero_that_is_no_small_number_has_a_word),
        cmocka_unit_test(fields_that_hold_a_number_say_it),
        cmocka_unit_test(whole_numbers_of_64_bits),
        cmocka_unit_test(reasons_fit_their_buffer),
        cmocka_unit_test(tables_print_their_rows_in_order),
        cmocka_unit_test(parameters_of_programs),
        cmocka_unit_test(values_of_programs_travel_as_lines),
    };
    return cmocka_run_group_tests(tests, make_arena, drop_arena);
}
