/* test_template.c - what can be read and changed of a program before it runs, calls into it, and
 * many copies. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "loader/loader.h"
#include "support/guests.h"
#include "support/scratch.h"

static char folder[256], path[512];
static const struct loader_hooks no_hooks;

static int make(void **state)
{
    (void)state;
    scratch_make(folder, sizeof folder);
    guests_build(folder, "parts.c", "-O1", path);
    return 0;
}

static int remove_it(void **state)
{
    (void)state;
    scratch_remove(folder);
    return 0;
}

static struct loader_template *open_it(void)
{
    struct err e;
    err_clear(&e);
    struct loader_template *t = loader_open(path, &e);
    if (!t) fail_msg("%s", e.text);
    return t;
}

static void reserve(struct loader_template *t, int nrank)
{
    struct err e;
    err_clear(&e);
    if (!loader_reserve(t, nrank, &no_hooks, &e)) fail_msg("%s", e.text);
}

static struct loader_instance *instance(struct loader_template *t, int rank)
{
    struct err e;
    err_clear(&e);
    struct loader_instance *i = loader_instantiate(t, rank, NULL, &e);
    if (!i) fail_msg("%s", e.text);
    return i;
}

static struct loader_outcome call(struct loader_instance *i, const char *name, int64_t a)
{
    void *f = loader_symbol(i, name);
    assert_non_null(f);
    return loader_call(i, f, (const int64_t[4]){a, 20, 3, 4});
}

static void sections_and_constants_are_found_and_patched(void **state)
{
    (void)state;
    struct loader_template *t = open_it();
    size_t size;
    unsigned char *own = loader_template_section(t, "own_section", &size);
    assert_non_null(own);
    assert_int_equal(size, 5);
    assert_int_equal(own[4], 5);
    assert_null(loader_template_section(t, "no_section", &size));
    assert_null(loader_template_section(t, ".comment", &size)); /* is not loaded */
    int *constant = loader_template_symbol(t, "constant", &size);
    assert_int_equal(size, sizeof *constant);
    assert_int_equal(*constant, 17);
    assert_ptr_equal(loader_template_at(t, loader_template_address(t, constant), 4), constant);
    assert_null(loader_template_at(t, UINT64_C(1) << 40, 4));
    assert_null(loader_template_symbol(t, "nothing", NULL));

    /* What is patched in the template is what every rank executes. */
    *constant = 18;
    reserve(t, 2);
    assert_int_equal(call(instance(t, 0), "get_constant", 0).value, 18);
    assert_int_equal(call(instance(t, 1), "get_constant", 0).value, 18);
    loader_close(t);
}

static void calls_return_or_exit_and_begin_anew(void **state)
{
    (void)state;
    struct loader_template *t = open_it();
    reserve(t, 1);
    struct loader_instance *i = instance(t, 0);
    assert_false(loader_start(i, 0, (char *[]){NULL}).exited);
    assert_int_equal(call(i, "sum", 100).value, 1127);
    assert_int_equal(call(i, "sum", 200).value, 2227);
    const int64_t six[6] = {1, 2, 3, 4, 5, 6};
    assert_int_equal(loader_call_six(i, loader_symbol(i, "weighted"), six).value, 91);
    struct loader_outcome o = call(i, "leave", 5);
    assert_true(o.exited);
    assert_int_equal(o.status, 5);
    o = call(i, "sum", 0);
    assert_false(o.exited);
    assert_int_equal(o.value, 3027);
    loader_close(t);
}

static void add_up(void *context, int64_t ps) { *(int64_t *)context += ps; }

static struct loader_instance *counting;
static void count_twice(void)
{
    call(counting, "count", 100);
    call(counting, "count", 23);
}

/* The host's register is as before, and what the program added to its own goes to the clock. */
static void counts_in_register_15_are_handed_over(void **state)
{
    (void)state;
    static const struct loader_hooks hooks = {.elapse_ps = add_up};
    struct loader_template *t = open_it();
    struct err e;
    int64_t sum = 0, after = 0;
    err_clear(&e);
    assert_true(loader_reserve(t, 1, &hooks, &e));
    counting = loader_instantiate(t, 0, &sum, &e);
    assert_non_null(counting);
    /* On a stack aligned for the call, below what the compiler may keep under the stack pointer. */
    __asm__ volatile("mov %%rsp, %%rbx\n sub $256, %%rsp\n and $-16, %%rsp\n mov $4711, %%r15\n"
                     "call *%1\n mov %%rbx, %%rsp\n mov %%r15, %0"
                     : "=r"(after)
                     : "r"(count_twice)
                     : "rax", "rbx", "rcx", "rdx", "rsi", "rdi", "r8", "r9", "r10", "r11", "r15",
                       "memory", "cc");
    assert_int_equal(after, 4711);
    assert_int_equal(sum, 123);
    loader_close(t);
}

/* More ranks than the system has mappings for: groups of them share one. */
static void ranks_that_share_a_mapping_keep_their_data_apart(void **state)
{
    (void)state;
    enum { MANY = 40000 };
    struct loader_template *t = open_it();
    reserve(t, MANY);
    struct loader_instance *last = NULL;
    for (int k = 0; k < MANY; k++) {
        last = instance(t, k);
        for (int n = 0; n <= k % 3; n++)
            assert_int_equal(call(last, "sum", k).value, 1000 * (n + 1) + k + 27);
    }
    assert_int_equal(loader_host(last)->rank, MANY - 1);
    assert_int_equal(loader_host(last)->nrank, MANY);
    loader_close(t);
}

static void what_is_no_program_is_refused_with_what_is_wrong(void **state)
{
    (void)state;
    char file[600];
    struct err e;
    err_clear(&e);
    assert_null(loader_open(scratch_path(file, sizeof file, folder, "none"), &e));
    assert_int_equal(e.kind, ERR_NO_INPUT);
    err_clear(&e);
    assert_null(loader_open(folder, &e));
    assert_int_equal(e.kind, ERR_DATA);
    err_clear(&e);
    snprintf(file, sizeof file, "%s.log", path);
    assert_null(loader_open(file, &e));
    assert_int_equal(e.kind, ERR_DATA);
    assert_non_null(strstr(e.text, "no ELF file"));
    err_clear(&e);
    assert_null(loader_open("/proc/self/exe", &e));
    assert_int_equal(e.kind, ERR_DATA);
#ifdef __PIE__
    assert_non_null(strstr(e.text, "not made by `mimdsim cc`"));
#else
    /* at fixed addresses, as it was asked for */
    assert_non_null(strstr(e.text, "an ordinary executable; link it with `mimdsim cc`"));
#endif
    assert_string_equal(e.file, "/proc/self/exe");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(sections_and_constants_are_found_and_patched, make,
                                        remove_it),
        cmocka_unit_test_setup_teardown(calls_return_or_exit_and_begin_anew, make, remove_it),
        cmocka_unit_test_setup_teardown(counts_in_register_15_are_handed_over, make, remove_it),
        cmocka_unit_test_setup_teardown(ranks_that_share_a_mapping_keep_their_data_apart, make,
                                        remove_it),
        cmocka_unit_test_setup_teardown(what_is_no_program_is_refused_with_what_is_wrong, make,
                                        remove_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
