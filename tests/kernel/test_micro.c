/* test_micro.c - the micro-benchmarks send what they say and measure something on every rank. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <string.h>

#include "comm/collective_rules.h"
#include "evaluation.h"
#include "kernel/micro_collective.h"
#include "kernel/programs.h"

/* micro: the kernel of a micro-benchmark; NULL when there is none. */
static const struct kernel_type *micro(const char *name)
{
    const struct program_type *t = program_find(name);
    return t ? t->context : NULL;
}

static void messages_and_bytes_are_as_announced(void **state)
{
    (void)state;
    static const char *const names[] = {"pingpong", "shift", "bisection", "all-to-all",
                                        "hot-spot", "barrier", "ring",    "random-ring"};
    for (int k = 0; k < 8; k++)
        for (int P = 2; P <= 12; P += 2)
            for (int64_t bytes = 0; bytes <= 100000; bytes = 100 * bytes + 8) {
                struct arena *a = arena_create();
                struct run_spec s = evaluation_spec(names[k], 1, P);
                s.kernel.repeat = 3;
                s.kernel.message_bytes = bytes;
                s.kernel.distance = 5;
                const struct evaluation v = evaluate(&s, a);
                struct program_estimate e;
                micro(names[k])->estimate(&s, NULL, NULL, &e);
                assert_int_equal(v.counts.messages, (int64_t)e.messages);
                assert_int_equal(v.counts.bytes, (int64_t)e.bytes);
                assert_int_equal(v.counts.reports, 0);
                arena_destroy(a);
            }
}

/* Every algorithm that can: what the formula says is sent and computed, from and to any root. */
static void collectives_are_as_announced(void **state)
{
    (void)state;
    static const char *const names[] = {"broadcast", "reduce",         "allreduce",      "gather",
                                        "scatter",   "allgather",      "alltoall",       "scan",
                                        "alltoallv", "reduce-scatter", "message-barrier"};
    for (int k = 0; k < 11; k++)
        for (int P = 1; P <= 17; P += 1 + P / 4)
            for (int64_t bytes = 0; bytes <= 10000; bytes = 30 * bytes + 12) {
                struct run_spec s = evaluation_spec(names[k], 1, P);
                int n;
                s.kernel.repeat = 2;
                s.kernel.message_bytes = bytes;
                s.kernel.root = -1;
                const struct collective_algorithm *row =
                    collective_algorithms(micro_collective_shape(&s).kind, &n);
                for (int i = -1; i < n; i++) {
                    struct err e = {0};
                    struct program_estimate wanted;
                    struct arena *a = arena_create();
                    strcpy(s.kernel.algorithm, i < 0 ? "auto" : row[i].name);
                    if (micro(names[k])->accepts(&(struct kernel_job){.spec = &s}, &e)) {
                        const struct evaluation v = evaluate(&s, a);
                        micro(names[k])->estimate(&s, NULL, NULL, &wanted);
                        assert_int_equal(v.counts.messages, (int64_t)wanted.messages);
                        assert_int_equal(v.counts.bytes, (int64_t)wanted.bytes);
                        assert_int_equal(v.counts.stage_work[0].flop, (uint64_t)wanted.flops);
                    } else
                        assert_non_null(strstr(e.text, i >= 0 && !strcmp(row[i].name, "hardware")
                                                           ? "by 'hardware'"
                                                           : "it needs"));
                    arena_destroy(a);
                }
            }
}

static const char *chosen(const char *kernel, int P, int64_t bytes, const char *rules)
{
    struct err e = {0};
    struct run_spec s = evaluation_spec(kernel, 1, P);
    s.kernel.message_bytes = bytes;
    strcpy(s.machine.software.collectives, rules);
    const struct collective_algorithm *a = micro_collective_algorithm(&s, &e);
    return a ? a->name : "";
}

static void the_machine_may_state_the_algorithms(void **state)
{
    (void)state;
    static const char rules[] =
        "[allreduce reduce-broadcast, allreduce ring from 1 KiB on 4 ranks; gather linear]";
    assert_string_equal(chosen("allreduce", 8, 8, ""), "recursive-doubling");
    assert_string_equal(chosen("allreduce", 8, 8, rules), "reduce-broadcast");
    assert_string_equal(chosen("allreduce", 8, 1024, rules), "ring");
    assert_string_equal(chosen("allreduce", 3, 1024, rules), "reduce-broadcast");
    assert_string_equal(chosen("gather", 3, 1024, rules), "linear");
    assert_string_equal(chosen("scatter", 3, 1024, rules), "binomial");
    assert_string_equal(chosen("alltoallv", 8, 8, ""), "linear");
}

static void refused(const char *rules, const char *expected)
{
    char why[320] = "";
    assert_false(collective_rules_valid(rules, why, (int)sizeof why));
    if (!strstr(why, expected)) fail_msg("'%s': %s", rules, why);
}

static void bad_rules_say_what_is_expected(void **state)
{
    (void)state;
    char why[320];
    refused("brodcast binomial", "expected 'broadcast'");
    refused("broadcast bruck", "expected one of binomial, scatter-allgather");
    refused("broadcast", "has no algorithm ''");
    refused("broadcast binomial from 8", "no unit");
    refused("broadcast binomial from -8 B", "no size");
    refused("broadcast binomial from 8 B on two ranks", "expected a number of ranks");
    refused("broadcast binomial above 8 B", "expected 'from SIZE'");
    assert_true(collective_rules_valid(" [ ] ", why, (int)sizeof why));
    assert_true(collective_rules_valid("broadcast binomial on 8 from 2 KiB", why, (int)sizeof why));
    assert_true(collective_choice_valid("ring", why, (int)sizeof why));
    assert_false(collective_choice_valid("rink", why, (int)sizeof why));
    assert_non_null(strstr(why, "'ring'"));
}

static void what_makes_no_sense_is_refused(void **state)
{
    (void)state;
    struct err e = {0};
    struct run_spec s = evaluation_spec("pingpong", 1, 1);
    assert_false(micro("pingpong")->accepts(&(struct kernel_job){.spec = &s}, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    err_clear(&e);
    s.nrank = 3;
    assert_false(micro("bisection")->accepts(&(struct kernel_job){.spec = &s}, &e));
    assert_null(micro("ping"));
    err_clear(&e);
    s = evaluation_spec("alltoall", 1, 3);
    strcpy(s.kernel.algorithm, "xor");
    assert_false(micro("alltoall")->accepts(&(struct kernel_job){.spec = &s}, &e));
    assert_non_null(strstr(e.text, "power of two"));
    err_clear(&e);
    s = evaluation_spec("broadcast", 1, 3);
    s.kernel.root = 3;
    assert_false(micro("broadcast")->accepts(&(struct kernel_job){.spec = &s}, &e));
    err_clear(&e);
    s.kernel.ring_ranks = 1;
    assert_false(micro("ring")->accepts(&(struct kernel_job){.spec = &s}, &e));
}

static void expect_complete(const struct kernel_type *t, const char *name)
{
    assert_non_null(t);
    assert_string_equal(t->name, name);
    assert_true(t->title && t->rank.nstage > 0 && t->rank.stage_name && t->accepts && t->prepare &&
                t->rank.workspace_bytes && t->rank.run && t->estimate);
}

static void every_program_is_complete_in_every_precision(void **state)
{
    (void)state;
    int n;
    const struct program_type *const *list = program_list(&n);
    assert_true(n >= 22);
    for (int k = 0; k < n; k++) {
        const struct program_type *t = list[k];
        assert_true(t->name && t->title && t->open && t->prepare && t->estimate);
        assert_ptr_equal(program_find(t->name), t);
        struct kernel_spec spec = {0};
        snprintf(spec.name, sizeof spec.name, "%s", t->name);
        assert_int_equal(kernel_spec_has(&spec, PROGRAM_SCENE), t->has_scene);
        for (int precision = 0; precision < 3 && t->has_scene; precision++)
            expect_complete(kernel_find_precision(t->name, (enum precision)precision), t->name);
        if (!t->has_scene) expect_complete(t->context, t->name);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(messages_and_bytes_are_as_announced),
        cmocka_unit_test(collectives_are_as_announced),
        cmocka_unit_test(the_machine_may_state_the_algorithms),
        cmocka_unit_test(bad_rules_say_what_is_expected),
        cmocka_unit_test(what_makes_no_sense_is_refused),
        cmocka_unit_test(every_program_is_complete_in_every_precision),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
