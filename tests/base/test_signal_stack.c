/* test_signal_stack.c - a handler finds its data, also behind those of somebody later. */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/signal_stack.h"

struct data {
    struct signal_stack stack;
    int number;
};

static struct data *made(enum signal_stack_kind kind, int number)
{
    struct data *d = signal_stack_make(kind);
    assert_non_null(d);
    assert_int_equal(d->number, 0);
    d->number = number;
    return d;
}

static int found(enum signal_stack_kind kind)
{
    const struct data *d = signal_stack_find(kind);
    return d ? d->number : -1;
}

static void each_kind_is_found_behind_others(void **state)
{
    (void)state;
    stack_t before, after;
    assert_int_equal(sigaltstack(NULL, &before), 0);
    assert_int_equal(found(SIGNAL_STACK_CRASH), -1);
    struct data *crash = made(SIGNAL_STACK_CRASH, 1);
    assert_int_equal(found(SIGNAL_STACK_CRASH), 1);
    assert_int_equal(found(SIGNAL_STACK_FAULT), -1);
    struct data *fault = made(SIGNAL_STACK_FAULT, 2), *again = made(SIGNAL_STACK_FAULT, 3);
    assert_int_equal(found(SIGNAL_STACK_CRASH), 1);
    assert_int_equal(found(SIGNAL_STACK_FAULT), 3);
    signal_stack_end(&again->stack);
    assert_int_equal(found(SIGNAL_STACK_FAULT), 2);
    signal_stack_end(&fault->stack);
    assert_int_equal(found(SIGNAL_STACK_FAULT), -1);
    assert_int_equal(found(SIGNAL_STACK_CRASH), 1);
    signal_stack_end(&crash->stack);
    assert_int_equal(found(SIGNAL_STACK_CRASH), -1);
    assert_int_equal(sigaltstack(NULL, &after), 0);
    assert_ptr_equal(after.ss_sp, before.ss_sp);
    assert_int_equal(after.ss_flags, before.ss_flags);
}

/* Of the same size, and full of nothing: not ours. */
static void a_stranger_hides_what_is_behind_it(void **state)
{
    (void)state;
    struct data *crash = made(SIGNAL_STACK_CRASH, 1);
    stack_t before, other = {.ss_sp = calloc(1, SIGNAL_STACK_BYTES), .ss_size = SIGNAL_STACK_BYTES};
    assert_non_null(other.ss_sp);
    assert_int_equal(sigaltstack(&other, &before), 0);
    assert_int_equal(found(SIGNAL_STACK_CRASH), -1);
    assert_int_equal(sigaltstack(&before, NULL), 0);
    assert_int_equal(found(SIGNAL_STACK_CRASH), 1);
    signal_stack_end(&crash->stack);
    free(other.ss_sp);
}

static volatile int seen;

static void handle(int number)
{
    (void)number;
    seen = found(SIGNAL_STACK_CRASH);
}

static void found_on_the_stack_of_a_handler(void **state)
{
    (void)state;
    struct sigaction before, a = {.sa_flags = SA_ONSTACK, .sa_handler = handle};
    struct data *crash = made(SIGNAL_STACK_CRASH, 41), *fault = made(SIGNAL_STACK_FAULT, 2);
    sigaction(SIGUSR1, &a, &before);
    raise(SIGUSR1);
    sigaction(SIGUSR1, &before, NULL);
    assert_int_equal(seen, 41);
    signal_stack_end(&fault->stack);
    signal_stack_end(&crash->stack);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_kind_is_found_behind_others),
        cmocka_unit_test(a_stranger_hides_what_is_behind_it),
        cmocka_unit_test(found_on_the_stack_of_a_handler),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
