/* test_stack_fault.c - a fiber that goes beyond its stack is told by its number, in any thread;
 * what else faults ends as it would have. */
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "sim/fiber.h"
#include "sim/stack_fault.h"

enum { N = 40, STACK = 16 * 1024, TOLD = 100, MISTOLD = 99, CAUGHT = 77, WELL = 55 };

/* The status says which fiber it was. */
static void tell(void *context, int fiber) { _exit(context == &tell ? TOLD + fiber : MISTOLD); }

static void use_stack(void *argument)
{
    volatile char big[STACK + 2048];
    /* from the top down, line by line, as calls would */
    for (size_t i = sizeof big; i > 0; i -= 64) big[i - 1] = 1;
    *(int *)argument = big[64];
}

static struct fiber_pool *make_pool(void)
{
    struct err e;
    err_clear(&e);
    struct fiber_pool *p = fiber_pool_create(N, STACK, &e);
    if (!p) _exit(MISTOLD);
    return p;
}

static void overflow(struct fiber_pool *p, int i)
{
    static int out;
    fiber_enter(fiber_start(p, i, use_stack, &out));
}

/* How a child ends that does `act`: its status, or 1000 and the signal. */
static int end_of(void (*act)(int argument), int argument)
{
    const pid_t child = fork();
    if (child == 0) {
        struct rlimit none = {0, 0};
        setrlimit(RLIMIT_CORE, &none);
        /* not the handlers of the test framework and of sanitizers */
        signal(SIGSEGV, SIG_DFL);
        signal(SIGBUS, SIG_DFL);
        act(argument);
        _exit(WELL);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFSIGNALED(status) ? 1000 + WTERMSIG(status) : WEXITSTATUS(status);
}

static void overflow_here(int fiber)
{
    struct fiber_pool *p = make_pool();
    stack_fault_begin(p, tell, &tell);
    overflow(p, fiber);
}

static void the_fiber_is_told_by_its_number(void **state)
{
    (void)state;
    static const int which[] = {0, 1, 17, N - 1};
    for (size_t i = 0; i < sizeof which / sizeof *which; i++)
        assert_int_equal(end_of(overflow_here, which[i]), TOLD + which[i]);
}

struct other {
    struct fiber_pool *pool;
    struct stack_fault *first;
    int fiber;
};

static void *work(void *context)
{
    const struct other *o = context;
    stack_fault_join(o->first);
    overflow(o->pool, o->fiber);
    return NULL;
}

static void overflow_in_thread(int fiber)
{
    pthread_t thread;
    struct other o = {.pool = make_pool(), .fiber = fiber};
    o.first = stack_fault_begin(o.pool, tell, &tell);
    if (pthread_create(&thread, NULL, work, &o) == 0) pthread_join(thread, NULL);
}

static void another_thread_tells_it_as_well(void **state)
{
    (void)state;
    assert_int_equal(end_of(overflow_in_thread, 23), TOLD + 23);
}

/* An address that nobody has. */
static void touch_nothing(int unused)
{
    (void)unused;
    stack_fault_begin(make_pool(), tell, &tell);
    volatile char *volatile nowhere = (char *)(uintptr_t)64;
    *nowhere = 1;
}

static void send_it(int number)
{
    stack_fault_begin(make_pool(), tell, &tell);
    raise(number);
}

static void caught(int number)
{
    (void)number;
    _exit(CAUGHT);
}

static void touch_with_handler(int unused)
{
    signal(SIGSEGV, caught);
    touch_nothing(unused);
}

static void other_faults_end_as_without_it(void **state)
{
    (void)state;
    assert_int_equal(end_of(touch_nothing, 0), 1000 + SIGSEGV);
    assert_int_equal(end_of(send_it, SIGSEGV), 1000 + SIGSEGV);
    assert_int_equal(end_of(send_it, SIGBUS), 1000 + SIGBUS);
    assert_int_equal(end_of(touch_with_handler, 0), CAUGHT);
}

/* After the end of it an overflow is any fault again. */
static void overflow_after_end(int fiber)
{
    struct fiber_pool *p = make_pool();
    stack_fault_end(stack_fault_begin(p, tell, &tell));
    overflow(p, fiber);
}

static void its_end_leaves_the_process_as_it_was(void **state)
{
    (void)state;
    struct sigaction before[2], after[2];
    stack_t stack_before, stack_after;
    sigaction(SIGSEGV, NULL, &before[0]);
    sigaction(SIGBUS, NULL, &before[1]);
    sigaltstack(NULL, &stack_before);
    struct fiber_pool *p = make_pool();
    struct stack_fault *first = stack_fault_begin(p, tell, &tell);
    assert_non_null(first);
    sigaction(SIGSEGV, NULL, &after[0]);
    assert_true(after[0].sa_sigaction != before[0].sa_sigaction);
    stack_fault_end(first);
    stack_fault_end(NULL);
    sigaction(SIGSEGV, NULL, &after[0]);
    sigaction(SIGBUS, NULL, &after[1]);
    sigaltstack(NULL, &stack_after);
    for (int i = 0; i < 2; i++) assert_true(after[i].sa_sigaction == before[i].sa_sigaction);
    assert_int_equal(stack_after.ss_flags & SS_DISABLE, stack_before.ss_flags & SS_DISABLE);
    assert_null(stack_fault_join(NULL));
    fiber_pool_destroy(p);
    const int end = end_of(overflow_after_end, 3);
    assert_true(end == 1000 + SIGSEGV || end == 1000 + SIGBUS);
}

/* Where a stack lies is read off a frame on it. */
static void note_place(void *argument)
{
    *(uintptr_t *)argument = (uintptr_t)__builtin_frame_address(0);
}

static void only_the_page_below_a_stack_is_below_it(void **state)
{
    (void)state;
    struct fiber_pool *p = make_pool();
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), stride = STACK + page;
    uintptr_t top = 0;
    assert_false(fiber_enter(fiber_start(p, 5, note_place, &top)));
    /* The end of its stack, from a place near it: the tops are shifted by less than a page. */
    const uintptr_t base = (top / page + 1) * page - 6 * stride;
    for (int i = 0; i < N; i++) {
        const char *guard = (const char *)(base + (size_t)i * stride);
        assert_int_equal(fiber_below(p, guard), i);
        assert_int_equal(fiber_below(p, guard + page - 1), i);
        assert_int_equal(fiber_below(p, guard + page), -1);
        assert_int_equal(fiber_below(p, guard + stride - 1), -1);
    }
    assert_int_equal(fiber_below(p, (const char *)base - 1), -1);
    assert_int_equal(fiber_below(p, (const char *)base + N * stride), -1);
    assert_int_equal(fiber_below(p, NULL), -1);
    fiber_pool_destroy(p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_fiber_is_told_by_its_number),
        cmocka_unit_test(another_thread_tells_it_as_well),
        cmocka_unit_test(other_faults_end_as_without_it),
        cmocka_unit_test(its_end_leaves_the_process_as_it_was),
        cmocka_unit_test(only_the_page_below_a_stack_is_below_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
