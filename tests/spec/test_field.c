/* test_field.c - the tables are complete, and every value survives printing and reading. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "base/random.h"
#include "spec/field.h"
#include "spec/spec_fields.h"
#include "random_value.h"

static size_t entry_size(const struct field *f)
{
    switch (f->kind) {
    case FIELD_REAL:
        return sizeof(double);
    case FIELD_INT:
    case FIELD_CHOICE:
        return sizeof(int);
    case FIELD_INT64:
    case FIELD_SEED:
        return sizeof(int64_t);
    case FIELD_BOOL:
        return sizeof(bool);
    case FIELD_TEXT:
        return (size_t)f->capacity;
    case FIELD_INTS:
        return (size_t)f->capacity * sizeof(int);
    case FIELD_REALS:
        return (size_t)f->capacity * sizeof(double);
    case FIELD_INT_LIST:
    case FIELD_PAIR_LIST:
        return sizeof(void *);
    case FIELD_SEGMENTS:
        return (size_t)f->capacity * sizeof(struct software_segment);
    }
    return 0;
}

/* Marks what the rows of one table cover; two rows may not cover the same byte. */
static void cover(const struct field_table *t, size_t base, unsigned char *covered)
{
    for (int i = 0; i < t->nfield; i++) {
        const struct field *f = &t->field[i];
        for (size_t b = 0; b < entry_size(f); b++)
            assert_int_equal(covered[base + f->offset + b]++, 0);
        for (size_t b = 0; f->count != 0 && b < sizeof(int); b++)
            assert_int_equal(covered[base + f->count + b]++, 0);
    }
}

static void every_member_of_a_run_has_one_field(void **state)
{
    (void)state;
    unsigned char covered[sizeof(struct run_spec)] = {0};
    int ntable, gap = 0;
    const struct field_table *const *table = field_tables(&ntable);
    for (int i = 0; i < ntable; i++) cover(table[i], table[i]->offset, covered);
    /* what the plan itself fills in */
    memset(covered + offsetof(struct run_spec, rep), 1, sizeof(int));
    memset(covered + offsetof(struct run_spec, model_file), 1, 65);
    const size_t found = offsetof(struct run_spec, program.kind);
    memset(covered + found, 1, offsetof(struct run_spec, program.image) + sizeof(char *) - found);
    memset(covered + offsetof(struct run_spec, config_hash), 1, 65);
    memset(covered + offsetof(struct run_spec, config_text), 1, sizeof(char *));
    memset(covered + offsetof(struct run_spec, machine_changes), 1, sizeof(char *));
    memset(covered + offsetof(struct run_spec, machine_hash), 1, sizeof(char *));
    memset(covered + offsetof(struct run_spec, called), 1, sizeof(char *));
    memset(covered + offsetof(struct run_spec, refused), 1, sizeof(char *));
    memset(covered + offsetof(struct run_spec, refused_kind), 1, sizeof(int));
    memset(covered + offsetof(struct run_spec, jobs), 1, sizeof(void *));
    /* a study's own question, which no file asks: shares that are made even */
    memset(covered + offsetof(struct run_spec, record.balance), 1, sizeof(void *));
    /* of no meaning: nobody shares the first cache, and the memory has no capacity */
    memset(covered + offsetof(struct run_spec, machine.node.level[NODE_L1].shared), 1,
           sizeof(double));
    memset(covered + offsetof(struct run_spec, machine.node.level[NODE_L1].processors), 1,
           sizeof(int));
    memset(covered + offsetof(struct run_spec, machine.node.level[NODE_MEMORY].bytes), 1,
           sizeof(int64_t));
    for (size_t b = 0; b < sizeof covered; b++) {
        gap = covered[b] ? 0 : gap + 1;
        if (gap >= 8) fail_msg("byte %zu of run_spec belongs to no field", b);
    }
}

static void keys_are_unique_and_documented(void **state)
{
    (void)state;
    int ntable;
    const struct field_table *const *table = field_tables(&ntable), *found;
    for (int i = 0; i < ntable; i++) {
        for (int j = 0; j < table[i]->nfield; j++) {
            const struct field *f = &table[i]->field[j];
            char full[128];
            snprintf(full, sizeof full, "%s%s%s", table[i]->prefix, table[i]->prefix[0] ? "." : "",
                     f->key);
            assert_int_equal(field_find(table[i], f->key), j);
            assert_ptr_equal(field_find_full(full, &found), f);
            assert_ptr_equal(found, table[i]);
            assert_true(strlen(f->doc) > 4 && strchr(f->doc, '\n') == NULL);
            assert_true(f->kind != FIELD_CHOICE || f->choice != NULL);
        }
    }
    assert_null(field_find_full("machine.network", &found));
    assert_null(field_find_full("machinenetwork.level", &found));
    assert_int_equal(field_find(&model_table, "length "), -1);
}

static void values_read_back_to_the_same_bits(void **state)
{
    (void)state;
    int ntable;
    const struct field_table *const *table = field_tables(&ntable);
    struct random r = random_make(11, 0, 0);
    for (int round = 0; round < 200; round++) {
        for (int i = 0; i < ntable; i++) {
            for (int j = 0; j < table[i]->nfield; j++) {
                const struct field *f = &table[i]->field[j];
                struct run_spec once = {0}, twice = {0};
                struct text first = {0}, second = {0};
                char text[1024], why[256] = "";
                random_value(f, &r, text, sizeof text);
                void *a = (char *)&once + table[i]->offset, *b = (char *)&twice + table[i]->offset;
                if (!field_set(f, a, text, arena, why, (int)sizeof why))
                    fail_msg("%s: %s: %s", f->key, text, why);
                field_print(f, a, &first);
                if (!field_set(f, b, first.s, arena, why, (int)sizeof why))
                    fail_msg("%s: %s", f->key, why);
                field_print(f, b, &second);
                assert_string_equal(first.s, second.s);
                if (f->kind != FIELD_INT_LIST && f->kind != FIELD_PAIR_LIST)
                    assert_memory_equal((char *)a + f->offset, (char *)b + f->offset,
                                        entry_size(f));
                text_free(&first);
                text_free(&second);
            }
        }
    }
}

static void defaults_are_valid_and_complete(void **state)
{
    (void)state;
    struct run_spec run;
    struct text t = {0};
    memset(&run, 0x5a, sizeof run);
    field_defaults(&run_table, &run, arena);
    field_defaults(&machine_table, &run.machine, arena);
    field_defaults(&model_table, &run.model, arena);
    field_defaults(&kernel_table, &run.kernel, arena);
    assert_int_equal(run.model.nbody, 16);
    assert_true(run.model.gravity[2] == -9.81);
    assert_int_equal(run.machine.software.eager_bytes, -1);
    assert_int_equal(run.machine.network.buffer_flits, 16);
    assert_string_equal(run.kernel.name, "dynamics");
    fields_config(&run, &t);
    assert_non_null(strstr(t.s, "machine.software.eager.limit = unlimited\n"));
    assert_non_null(strstr(t.s, "model.gravity = [0 m/s^2, 0 m/s^2, -9.81 m/s^2]\n"));
    assert_null(strstr(t.s, "machine.title"));
    text_free(&t);
}

static void set_ok(const char *key, const char *text, struct run_spec *run)
{
    const struct field_table *t;
    const struct field *f = field_find_full(key, &t);
    char why[256] = "";
    assert_non_null(f);
    if (!field_set(f, (char *)run + t->offset, text, arena, why, (int)sizeof why))
        fail_msg("%s: %s", text, why);
}

static void lists_are_read_in_every_spelling(void **state)
{
    (void)state;
    static const char *const dims[] = {"[16, 8, 8]", "16x8x8", "16 8 8", "16, 8, 8",
                                       " [ 16 , 8,8 ] "};
    struct run_spec run = {0};
    for (size_t i = 0; i < sizeof dims / sizeof *dims; i++) {
        set_ok("machine.topology.dims", "[1, 2, 3, 4, 5]", &run);
        set_ok("machine.topology.dims", dims[i], &run);
        assert_int_equal(run.machine.topology.ndim, 3);
        assert_int_equal(run.machine.topology.dims[0], 16);
        assert_int_equal(run.machine.topology.dims[2], 8);
        assert_int_equal(run.machine.topology.dims[3], 0);
    }
    static const char *const gravity[] = {"[0, 0, -1.5] m/s^2", "0 0 -1.5 m/s^2",
                                          "0, 0, -1.5 m/s^2", "[0 m/s^2, 0 m/s^2, -1.5 m/s^2]",
                                          "0 m/s^2 0 m/s^2 -1.5 m/s^2"};
    for (size_t i = 0; i < sizeof gravity / sizeof *gravity; i++) {
        run.model.gravity[2] = 0;
        set_ok("model.gravity", gravity[i], &run);
        assert_true(run.model.gravity[2] == -1.5 && run.model.gravity[0] == 0);
    }
    set_ok("machine.topology.dim_bandwidth", "[5.25 GB/s, 15.75 GB/s]", &run);
    assert_true(run.machine.topology.dim_bandwidth[1] == 15.75e9 &&
                run.machine.topology.dim_bandwidth[2] == 0);
    set_ok("machine.topology.links", "[[0,1],[1,2],]", &run);
    assert_int_equal(run.machine.topology.nlink, 2);
    assert_int_equal(run.machine.topology.link[1][1], 2);
    set_ok("machine.placement.list", "[3, 1, 2]", &run);
    assert_int_equal(run.machine.placement.nlist, 3);
    assert_int_equal(run.machine.placement.list[2], 2);
}

static void wrong_values_are_refused_with_what_was_expected(void **state)
{
    (void)state;
    static const struct {
        const char *key, *text, *expected;
    } wrong[] = {
        {"model.n", "0", "out of range; expected 1 to"},
        {"model.n", "3.5", "not a whole number"},
        {"model.n", "", "not a whole number"},
        {"model.n", "99999999999999999999", "out of range"},
        {"machine.network.link.bandwidth", "480",
         "no unit; expected a bandwidth such as '480 MB/s'"},
        {"machine.network.link.bandwidth", "480 MHz", "unit of a frequency"},
        {"machine.network.link.bandwidth", "-1 MB/s", "out of range"},
        {"machine.network.link.bandwidth", "inf MB/s", "finite"},
        {"machine.network.link.bandwidth", "1e999 MB/s", "too large"},
        {"machine.network.link.bandwidth", "nan B/s", "finite"},
        {"machine.network.flit", "1.5 B", "whole number of bytes"},
        {"machine.software.eager.limit", "-1 B", "cannot be negative"},
        {"machine.network.level", "lnk", "did you mean 'link'?"},
        {"machine.network.level", "", "expected one of loggp, link, packet, flit, auto"},
        {"record.links", "1", "expected 'true' or 'false'"},
        {"seed", "-1", "not a seed"},
        {"seed", "18446744073709551616", "not a seed"},
        {"model.gravity", "[0, 0] m/s^2", "2 numbers; expected 3"},
        {"model.gravity", "[0, 0, 0, 0] m/s^2", "too many entries"},
        {"model.gravity", "[0, 0, -9.81]", "no unit"},
        {"model.gravity", "[0, 0, -9.81 m/s^2", "a bracket is not closed"},
        {"machine.topology.dims", "[]", "empty list"},
        {"machine.topology.dims", "[1,2,3,4,5,6,7,8,9]", "too many entries"},
        {"machine.topology.dims", "[0]", "out of range"},
        {"machine.topology.dims", "[4", "brackets do not match"},
        {"machine.topology.dims", "[4, four]", "not a list of whole numbers"},
        {"machine.topology.links", "[[0]]", "not a list of pairs"},
        {"machine.topology.links", "[[0, 1]", "brackets do not match"},
        {"kernel.name", "a\nb", "control characters"},
        {"kernel.name", "0123456789012345678901234567890123456789", "too long"},
    };
    struct run_spec run = {0};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const struct field_table *t;
        const struct field *f = field_find_full(wrong[i].key, &t);
        char why[256] = "";
        assert_non_null(f);
        if (field_set(f, (char *)&run + t->offset, wrong[i].text, arena, why, (int)sizeof why))
            fail_msg("%s accepts '%s'", wrong[i].key, wrong[i].text);
        if (strstr(why, wrong[i].expected) == NULL)
            fail_msg("%s '%s': %s", wrong[i].key, wrong[i].text, why);
    }
    struct run_spec untouched = {0};
    assert_memory_equal(&run, &untouched, sizeof run);
}

static void the_manual_has_every_key(void **state)
{
    (void)state;
    char *manual = NULL;
    size_t size = 0;
    int ntable;
    FILE *out = open_memstream(&manual, &size);
    fields_document(out);
    fclose(out);
    const struct field_table *const *table = field_tables(&ntable);
    for (int i = 0; i < ntable; i++) {
        for (int j = 0; j < table[i]->nfield; j++) {
            char entry[160];
            snprintf(entry, sizeof entry, "- `%s%s%s`: ", table[i]->prefix,
                     table[i]->prefix[0] ? "." : "", table[i]->field[j].key);
            if (strstr(manual, entry) == NULL) fail_msg("the manual lacks %s", entry);
        }
    }
    free(manual);
}

static void processors_follow_from_the_topology(void **state)
{
    (void)state;
    static const struct {
        const char *family, *dims;
        int nodes_per_router, processors_per_node, expected;
    } cases[] = {{"torus", "8x4x4", 1, 1, 128},
                 {"mesh", "16x16", 1, 1, 256},
                 {"hypercube", "2", 2, 2, 16},
                 {"hypercube", "7", 1, 1, 128},
                 {"bus", "4", 1, 1, 4},
                 {"crossbar", "8", 1, 2, 16},
                 {"full-mesh", "5", 2, 1, 10},
                 {"fat-tree", "4 3", 1, 1, 64},
                 {"fat-tree", "32 2", 1, 4, 4096},
                 {"dragonfly", "4 16 8 9", 1, 1, 576},
                 {"graph", "6", 1, 2, 12}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct run_spec run = {0};
        run.machine.topology.nodes_per_router = cases[i].nodes_per_router;
        run.machine.topology.processors_per_node = cases[i].processors_per_node;
        set_ok("machine.topology.family", cases[i].family, &run);
        set_ok("machine.topology.dims", cases[i].dims, &run);
        assert_int_equal(machine_spec_processors(&run.machine), cases[i].expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_member_of_a_run_has_one_field),
        cmocka_unit_test(keys_are_unique_and_documented),
        cmocka_unit_test(values_read_back_to_the_same_bits),
        cmocka_unit_test(defaults_are_valid_and_complete),
        cmocka_unit_test(lists_are_read_in_every_spelling),
        cmocka_unit_test(wrong_values_are_refused_with_what_was_expected),
        cmocka_unit_test(the_manual_has_every_key),
        cmocka_unit_test(processors_follow_from_the_topology),
    };
    return cmocka_run_group_tests(tests, make_arena, drop_arena);
}
