/* test_task.c - the identity of a task: what the ranks do counts, how it is simulated does not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>

#include "base/arena.h"
#include "spec/field.h"
#include "spec/task.h"

static void set_defaults(struct run_spec *run, struct arena *a)
{
    run_spec_defaults(run, a);
    run->nrank = 2;
}

/* Whether `key = text` makes another task of a run with defaults. */
static bool another(const char *key, const char *text)
{
    struct arena *a = arena_create();
    struct run_spec run;
    const struct field_table *table;
    char why[200] = "";
    set_defaults(&run, a);
    const struct run_spec before = task_of(&run, a);
    const struct field *f = field_find_full(key, &table);
    assert_non_null(f);
    if (!field_set(f, (char *)&run + table->offset, text, a, why, (int)sizeof why))
        fail_msg("%s: %s", key, why);
    const struct run_spec after = task_of(&run, a);
    const bool other = strcmp(before.config_hash, after.config_hash) != 0;
    arena_destroy(a);
    return other;
}

static void what_ranks_do_counts(void **state)
{
    (void)state;
    assert_true(another("ranks", "3"));
    assert_true(another("kernel.solver", "pcr"));
    assert_true(another("kernel.message", "9 B"));
    assert_true(another("model.n", "77"));
    assert_true(another("program.arguments", "-x"));
}

static void how_it_is_simulated_does_not(void **state)
{
    (void)state;
    assert_false(another("scenario", "other"));
    assert_false(another("seed", "99"));
    assert_false(another("record.spans", "true"));
    assert_false(another("machine.network.level", "flit"));
    assert_false(another("machine.node.flop_rate", "5 Gflop/s"));
    assert_false(another("program.cost", "host"));
    assert_false(another("program.factor", "2"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_ranks_do_counts),
                                       cmocka_unit_test(how_it_is_simulated_does_not)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
