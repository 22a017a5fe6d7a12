/* test_collective_rules.c - rules for algorithms as a text: what reads, what does not and what is
 * said then, and which rule counts. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "comm/collective_rules.h"

static struct collective_rule rule[COLLECTIVE_MAX_RULES];
static int count;
static char why[256];

static void read_rules(const char *text)
{
    memset(rule, 0xa5, sizeof rule);
    if (!collective_rules_parse(text, rule, &count, why, sizeof why))
        fail_msg("'%s': %s", text, why);
    /* the other two ways to read it say the same */
    int again = -1;
    assert_true(collective_rules_valid(text, why, sizeof why));
    assert_true(collective_rules_parse(text, NULL, &again, why, sizeof why));
    assert_int_equal(again, count);
}

static void is_rule(int i, const char *collective, const char *algorithm, int64_t bytes, int ranks)
{
    assert_true(i < count);
    assert_string_equal(collective_name(rule[i].kind), collective);
    assert_string_equal(rule[i].algorithm->name, algorithm);
    assert_ptr_equal(rule[i].algorithm, collective_algorithm_find(rule[i].kind, algorithm));
    assert_int_equal(rule[i].from_bytes, bytes);
    assert_int_equal(rule[i].from_ranks, ranks);
}

static void the_example_of_the_header_reads(void **state)
{
    (void)state;
    read_rules("allreduce recursive-doubling; allreduce rabenseifner from 2 KiB on 8 ranks");
    assert_int_equal(count, 2);
    is_rule(0, "allreduce", "recursive-doubling", 0, 0);
    is_rule(1, "allreduce", "rabenseifner", 2048, 8);
}

/* One rule in many dresses. */
static void separators_blanks_and_the_order_of_conditions_do_not_matter(void **state)
{
    (void)state;
    static const char *const same[] = {
        "allreduce ring from 64 KiB on 16 ranks",
        "allreduce ring from 64KiB on 16",
        "allreduce ring on 16 ranks from 64 KiB",
        "allreduce ring on 16 from 65536 B",
        "  allreduce\tring   from  64  KiB  on 16  ranks  ",
        "[allreduce ring from 64 KiB on 16 ranks]",
        "[ allreduce ring from 64 KiB on 16 ranks ]",
        ";;, ;allreduce ring from 64 KiB on 16 ranks,;\n",
        "allreduce ring\nfrom 64 KiB\non 16 ranks",
        "allreduce ring on 3 from 64 KiB on 16", /* the later one holds */
        "allreduce ring from 1 KiB from 64 KiB on 16",
        "allreduce ring from 1 KiB on 16 from 64 KiB",
    };
    for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
        read_rules(same[k]);
        if (count != 1) fail_msg("'%s': %d rules", same[k], count);
        is_rule(0, "allreduce", "ring", 65536, 16);
    }
}

static void a_text_without_rules_has_none(void **state)
{
    (void)state;
    static const char *const none[] = {"", " ", ";", "[]", "[ , ; ]", "\n\t "};
    for (size_t k = 0; k < sizeof none / sizeof *none; k++) {
        read_rules(none[k]);
        assert_int_equal(count, 0);
    }
}

static void sizes_and_ranks_have_limits(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int64_t bytes;
        int ranks;
    } row[] = {{"gather binomial from 0 B", 0, 0},
               {"gather binomial from 1 B on 0", 1, 0},
               {"gather binomial from 1.5 KiB", 1536, 0},
               {"gather binomial from 2 kB", 2000, 0},
               {"gather binomial from 1 MiB on 1", 1048576, 1},
               {"gather binomial from 1000000000000000 B", INT64_C(1000000000000000), 0},
               {"gather binomial on 1073741824 ranks", 0, 1 << 30}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        read_rules(row[k].text);
        is_rule(0, "gather", "binomial", row[k].bytes, row[k].ranks);
    }
}

/* What is wrong, and what the message must name. */
static void what_is_wrong_is_named(void **state)
{
    (void)state;
    static const struct {
        const char *text, *found, *expected;
    } row[] = {
        {"broadcats binomial", "'broadcats'", "broadcast"},
        {"qqqqqq binomial", "'qqqqqq'", "allreduce"},
        {"broadcast", "broadcast has no algorithm ''", "binomial"},
        {"broadcast binomal", "'binomal'", "binomial"},
        {"scan ring", "scan has no algorithm 'ring'", "expected one of"},
        {"broadcast binomial at 3", "'at'", "from SIZE"},
        {"broadcast binomial 3", "'3'", "on N ranks"},
        {"broadcast binomial on", "'on '", "on 8 ranks"},
        {"broadcast binomial on ranks", "'on ranks'", "number of ranks"},
        {"broadcast binomial on -1 ranks", "'on -1'", "number of ranks"},
        {"broadcast binomial on 8x", "'on 8x'", "number of ranks"},
        {"broadcast binomial on 1073741825", "'on 1073741825'", "number of ranks"},
        {"broadcast binomial on 99999999999999999999", "'on 9999", "number of ranks"},
        {"broadcast binomial from 8 s", "'s'", "a size"},
        {"broadcast binomial from many", "many", ""},
        {"broadcast binomial from", "", ""},
        {"broadcast binomial from on 8", "", ""},
        {"broadcast binomial from -1 B", "-1", ""},
        {"broadcast binomial from 1e16 B", "1e16", "no size"},
        {"broadcast binomial from nan B", "nan", ""},
        {"broadcast binomial; scan ring; allreduce ring", "'ring'", "scan"},
        {"broadcast binomial ranks 8", "'ranks'", "from SIZE"},
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        int n;
        why[0] = '\0';
        if (collective_rules_parse(row[k].text, rule, &n, why, sizeof why))
            fail_msg("'%s' has been read", row[k].text);
        if (!*why || !strstr(why, row[k].found) || !strstr(why, row[k].expected))
            fail_msg("'%s': %s", row[k].text, why);
        assert_false(collective_rules_valid(row[k].text, why, sizeof why));
        assert_null(strchr(why, '\n'));
    }
}

/* Room in `why` and in the list of rules: one less, as many, one more. */
static void room_is_never_exceeded(void **state)
{
    (void)state;
    char text[8192] = "", small[8], words[4096];
    int n;
    for (int k = 0; k < COLLECTIVE_MAX_RULES; k++) strcat(text, "barrier dissemination; ");
    read_rules(text);
    assert_int_equal(count, COLLECTIVE_MAX_RULES);
    strcat(text, "barrier dissemination");
    assert_false(collective_rules_parse(text, rule, &n, why, sizeof why));
    assert_non_null(strstr(why, "64"));
    /* a rule of 255 characters reads, one of 256 does not */
    strcpy(words, "barrier dissemination");
    memset(words + strlen(words), ' ', 300);
    words[255] = '\0';
    read_rules(words);
    words[255] = ' ', words[256] = '\0';
    assert_false(collective_rules_parse(words, rule, &n, why, sizeof why));
    assert_non_null(strstr(why, "256"));
    /* long words, long sizes, and a short room for the message */
    memset(words, 'x', 200), words[200] = '\0';
    memset(small, 0x5a, sizeof small);
    assert_false(collective_rules_parse(words, rule, &n, small, 4));
    assert_int_equal(strlen(small), 3);
    assert_int_equal(small[4], 0x5a);
    strcpy(text, "barrier dissemination from ");
    for (int k = 0; k < 20; k++) strcat(text, "1234 ");
    assert_false(collective_rules_parse(text, rule, &n, why, sizeof why));
    snprintf(text, sizeof text, "barrier dissemination from %.100s", words);
    assert_false(collective_rules_parse(text, rule, &n, why, sizeof why));
}

static void every_algorithm_can_be_asked_for_by_rule_and_by_name(void **state)
{
    (void)state;
    for (int kind = 0; kind < COLLECTIVE_KINDS; kind++) {
        int n;
        char names[512], text[128];
        const struct collective_algorithm *row =
            collective_algorithms((enum collective_kind)kind, &n);
        collective_algorithm_names((enum collective_kind)kind, names, sizeof names);
        const char *at = names;
        for (int i = 0; i < n; i++) {
            assert_int_equal(strncmp(at, row[i].name, strlen(row[i].name)), 0);
            at += strlen(row[i].name);
            if (i + 1 < n) assert_int_equal(strncmp(at, ", ", 2), 0), at += 2;
            snprintf(text, sizeof text, "%s %s", collective_name((enum collective_kind)kind),
                     row[i].name);
            read_rules(text);
            is_rule(0, collective_name((enum collective_kind)kind), row[i].name, 0, 0);
            assert_true(collective_choice_valid(row[i].name, why, sizeof why));
            assert_int_equal(collective_by_network(&row[i]), strcmp(row[i].name, "hardware") == 0);
        }
        assert_string_equal(at, "");
        collective_algorithm_names((enum collective_kind)kind, names, 5);
        assert_true(strlen(names) <= 4);
    }
    assert_true(collective_choice_valid("auto", why, sizeof why));
    static const char *const wrong[] = {"", "Auto", "binomia", "zzzzzz", "auto ", "ring;"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_false(collective_choice_valid(wrong[k], why, sizeof why));
        assert_non_null(strstr(why, "'auto'"));
    }
    assert_false(collective_choice_valid("binomia", why, sizeof why));
    assert_non_null(strstr(why, "'binomial'"));
}

/* --- which rule counts --- */

/* The last rule of the shape's collective whose size and ranks are reached and whose algorithm can
 * do it; NULL: none. What rules compare is written out here: of allgather and reduce-scatter all
 * blocks together, of a barrier nothing, and nothing where only some ranks know the blocks. */
static const struct collective_algorithm *last_match(const struct collective_shape *s)
{
    const struct collective_algorithm *found = NULL;
    const bool together = s->kind == COLLECTIVE_ALLGATHER || s->kind == COLLECTIVE_REDUCE_SCATTER;
    const bool unknown = s->kind == COLLECTIVE_BARRIER || (s->irregular && !together);
    const int64_t bytes = unknown ? 0 : (together ? s->total : s->count) * s->element;
    for (int i = 0; i < count; i++)
        if (rule[i].kind == s->kind && bytes >= rule[i].from_bytes &&
            s->size >= rule[i].from_ranks && collective_applies(rule[i].algorithm, s))
            found = rule[i].algorithm;
    return found;
}

static void random_rules(struct random *r)
{
    char text[4096] = "";
    for (uint64_t k = random_below(r, 12); k > 0; k--) {
        const enum collective_kind kind = (enum collective_kind)random_below(r, COLLECTIVE_KINDS);
        int n;
        const struct collective_algorithm *row = collective_algorithms(kind, &n);
        size_t at = strlen(text);
        at += (size_t)snprintf(text + at, sizeof text - at, "%s %s", collective_name(kind),
                               row[random_below(r, (uint64_t)n)].name);
        if (random_below(r, 2))
            at += (size_t)snprintf(text + at, sizeof text - at, " from %d B",
                                   (int)random_below(r, 4) * 96);
        if (random_below(r, 2))
            at += (size_t)snprintf(text + at, sizeof text - at, " on %d", 1 << random_below(r, 6));
        snprintf(text + at, sizeof text - at, "%s", random_below(r, 2) ? "; " : ",");
    }
    read_rules(text);
}

static void the_last_rule_that_matches_and_applies_counts(void **state)
{
    (void)state;
    struct random r = random_make(41, 0, 0);
    int ruled = 0;
    for (int trial = 0; trial < 4000; trial++) {
        if (trial % 20 == 0) random_rules(&r);
        struct collective_shape s = {.kind =
                                         (enum collective_kind)random_below(&r, COLLECTIVE_KINDS),
                                     .size = 1 + (int)random_below(&r, 40),
                                     .count = (int64_t)random_below(&r, 40),
                                     .element = 8,
                                     .commutative = random_below(&r, 2),
                                     .idempotent = random_below(&r, 2),
                                     .exclusive = random_below(&r, 2),
                                     .irregular = random_below(&r, 3) == 0};
        s.total = s.count * s.size;
        const struct collective_algorithm *want = last_match(&s);
        const struct collective_algorithm *got = collective_choose(&s, rule, count);
        if (want && got != want)
            fail_msg("%s: %s, not %s", collective_name(s.kind), got->name, want->name);
        /* the default is one of the same table that can do it */
        if (!want) assert_ptr_equal(got, collective_choose(&s, NULL, 0));
        assert_true(collective_applies(got, &s));
        assert_ptr_equal(collective_algorithm_find(s.kind, got->name), got);
        ruled += want != NULL;
    }
    assert_true(ruled > 300);
}

/* Without a network that does it, "hardware" is never chosen; with one, as far as it goes. */
static void hardware_does_what_its_network_says(void **state)
{
    (void)state;
    const struct comm_hardware network = {.kinds = 1u << COLLECTIVE_ALLREDUCE |
                                                   1u << COLLECTIVE_BROADCAST,
                                          .operations = COMM_INTEGER,
                                          .largest = 64};
    static const struct {
        enum collective_kind kind;
        int64_t count;
        enum comm_operation operation;
        bool commutative, irregular, does;
    } row[] = {
        {COLLECTIVE_ALLREDUCE, 8, COMM_INTEGER, true, false, true},
        {COLLECTIVE_ALLREDUCE, 8, COMM_LOGICAL, true, false, true},
        {COLLECTIVE_ALLREDUCE, 8, COMM_REAL, true, false, false},
        {COLLECTIVE_ALLREDUCE, 8, COMM_OWN, true, false, false},
        {COLLECTIVE_ALLREDUCE, 9, COMM_INTEGER, true, false, false},
        {COLLECTIVE_ALLREDUCE, 0, COMM_INTEGER, true, false, true},
        {COLLECTIVE_BROADCAST, 8, COMM_OWN, true, false, true},
        {COLLECTIVE_BROADCAST, 9, COMM_OWN, true, false, false},
        {COLLECTIVE_REDUCE, 8, COMM_INTEGER, true, false, false},
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        struct collective_shape s = {.kind = row[k].kind,
                                     .size = 16,
                                     .count = row[k].count,
                                     .total = 16 * row[k].count,
                                     .element = 8,
                                     .commutative = row[k].commutative,
                                     .operation = row[k].operation,
                                     .irregular = row[k].irregular,
                                     .hardware = &network};
        const struct collective_algorithm *a = collective_algorithm_find(row[k].kind, "hardware");
        assert_non_null(a);
        if (collective_applies(a, &s) != row[k].does) fail_msg("row %d", (int)k);
        s.hardware = NULL;
        assert_false(collective_applies(a, &s));
    }
}

/* What rules compare, at sizes where the two definitions differ. */
static void a_size_is_one_block_or_all_of_them(void **state)
{
    (void)state;
    for (int kind = 0; kind < COLLECTIVE_KINDS; kind++) {
        struct collective_call k = {.kind = (enum collective_kind)kind, .count = 3, .element = 8};
        struct comm c = {.rank = 0, .size = 5};
        const struct collective_op op = {.commutative = true};
        k.comm = &c, k.op = &op;
        const struct collective_shape s = collective_shape(&k);
        const bool all = kind == COLLECTIVE_ALLGATHER || kind == COLLECTIVE_REDUCE_SCATTER;
        assert_int_equal(s.size, 5);
        assert_int_equal(s.total, 15);
        assert_false(s.irregular);
        assert_true(s.commutative);
        if (kind != COLLECTIVE_BARRIER)
            assert_int_equal(collective_shape_bytes(&s), all ? 120 : 24);
    }
    /* blocks of different sizes: the largest and the sum */
    struct comm c = {.rank = 1, .size = 4};
    const int64_t counts[4] = {2, 0, 9, 4};
    const struct collective_call k = {
        .kind = COLLECTIVE_ALLGATHER, .comm = &c, .count = 0, .element = 4, .counts = counts};
    const struct collective_shape s = collective_shape(&k);
    assert_true(s.irregular);
    assert_int_equal(s.count, 9);
    assert_int_equal(s.total, 15);
    assert_int_equal(collective_shape_bytes(&s), 60);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_example_of_the_header_reads),
        cmocka_unit_test(separators_blanks_and_the_order_of_conditions_do_not_matter),
        cmocka_unit_test(a_text_without_rules_has_none),
        cmocka_unit_test(sizes_and_ranks_have_limits),
        cmocka_unit_test(what_is_wrong_is_named),
        cmocka_unit_test(room_is_never_exceeded),
        cmocka_unit_test(every_algorithm_can_be_asked_for_by_rule_and_by_name),
        cmocka_unit_test(the_last_rule_that_matches_and_applies_counts),
        cmocka_unit_test(hardware_does_what_its_network_says),
        cmocka_unit_test(a_size_is_one_block_or_all_of_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
