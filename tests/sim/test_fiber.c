/* test_fiber.c - Fibers keep their place and their stacks apart. */
#include "config.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "sim/fiber.h"
#include "sim/guard.h"

struct counter {
    struct fiber *fiber;
    int id, seen, rounds;
};

static int64_t peak_of(struct fiber_pool *p)
{
    int overflowed;
    const int64_t peak = fiber_pool_stack_peak(p, &overflowed);
    assert_int_equal(overflowed, -1);
    return peak;
}

static void count_rounds(void *argument)
{
    struct counter *c = argument;
    volatile char local[512];
    memset((void *)local, c->id, sizeof local);
    for (int i = 0; i < c->rounds; i++) {
        fiber_leave(c->fiber);
        for (size_t k = 0; k < sizeof local; k++) assert_int_equal((char)local[k], (char)c->id);
        c->seen++;
    }
}

static void fibers_interleave_and_keep_their_stacks(void **state)
{
    (void)state;
    enum { N = 100 };
    struct err e;
    err_clear(&e);
    struct fiber_pool *p = fiber_pool_create(N, 64 * 1024, &e);
    assert_non_null(p);
    struct counter *c = calloc(N, sizeof *c);
    for (int i = 0; i < N; i++) {
        c[i] = (struct counter){.id = i, .rounds = i % 7};
        c[i].fiber = fiber_start(p, i, count_rounds, &c[i]);
    }
    int alive = N;
    while (alive)
        for (int i = 0; i < N; i++)
            if (c[i].fiber && !fiber_enter(c[i].fiber)) {
                c[i].fiber = NULL;
                alive--;
            }
    for (int i = 0; i < N; i++) assert_int_equal(c[i].seen, c[i].rounds);
    int64_t entered = 0;
    for (int i = 0; i < N; i++) entered += c[i].rounds + 1;
    assert_int_equal(fiber_pool_switches(p), entered);
    assert_true(peak_of(p) >= 4096);
    assert_true(peak_of(p) <= 64 * 1024);
    free(c);
    fiber_pool_destroy(p);
}

static void use_stack(void *argument)
{
    volatile char big[24 * 1024];
    /* touched line by line: no optimiser may leave it out */
    for (size_t i = 0; i < sizeof big; i += 64) big[i] = 1;
    *(int *)argument = big[64 * 100];
}

/* More fibers than the system has mappings for. Where it makes guards without mappings, the guard
 * ends the process; elsewhere the last ones have none, and the spare page tells afterwards. */
static void an_overflow_of_one_of_very_many_is_seen(void **state)
{
    (void)state;
    enum { MANY = 300000, SEEN = 3 };
    pid_t child = fork();
    if (child == 0) {
        struct err e;
        struct rlimit none = {0, 0};
        err_clear(&e);
        setrlimit(RLIMIT_CORE, &none);
        signal(SIGSEGV, SIG_DFL); /* not the handler of the test framework */
        struct fiber_pool *p = fiber_pool_create(MANY, 16 * 1024, &e);
        int out = 0, overflowed;
        if (!p) _exit(SEEN);
        fiber_pool_stack_peak(p, &overflowed);
        if (overflowed != -1) _exit(1);
        fiber_enter(fiber_start(p, MANY - 7, use_stack, &out));
        fiber_pool_stack_peak(p, &overflowed);
        _exit(overflowed == MANY - 7 ? SEEN : 2);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) assert_int_equal(WTERMSIG(status), SIGSEGV);
    else assert_int_not_equal(WEXITSTATUS(status), 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) < SEEN)
        fail_msg("not seen: %d", WEXITSTATUS(status));
}

static void the_peak_sees_what_was_used(void **state)
{
    (void)state;
    struct err e;
    err_clear(&e);
    struct fiber_pool *p = fiber_pool_create(3, 64 * 1024, &e);
    int out = 0;
    assert_false(fiber_enter(fiber_start(p, 1, use_stack, &out)));
    assert_int_equal(out, 1);
    assert_true(peak_of(p) >= 20 * 1024);
    fiber_pool_destroy(p);
}

static void too_many_stacks_are_refused_with_a_message(void **state)
{
    (void)state;
    struct err e;
    err_clear(&e);
    assert_null(fiber_pool_create(1 << 30, 1 << 20, &e));
    assert_int_equal(e.kind, ERR_INTERNAL);
    assert_non_null(strstr(e.text, "virtual processors"));
}

/* The signal that ends a process which writes to this byte, 0: none. */
static int signal_of_writing(char *at)
{
    int status;
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        signal(SIGSEGV, SIG_DFL);
        *(volatile char *)at = 1;
        _exit(0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

/* More than one system call can take. */
static void every_guard_ends_who_touches_it(void **state)
{
    (void)state;
    enum { N = 2500 };
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), stride = 3 * page;
    char *base = mmap(NULL, N * stride, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_true(base != MAP_FAILED);
    const int n = guard_pages(base, stride, page, N);
    assert_int_equal(n, N);
    static const int place[] = {0, 1, 1023, 1024, 1025, 2047, 2048, N - 1};
    for (size_t i = 0; i < sizeof place / sizeof *place; i++) {
        char *guard = base + stride * (size_t)place[i];
        assert_int_equal(signal_of_writing(guard), SIGSEGV);
        assert_int_equal(signal_of_writing(guard + page - 1), SIGSEGV);
        assert_int_equal(signal_of_writing(guard + page), 0);
        assert_int_equal(signal_of_writing(guard + stride - 1), 0);
    }
    munmap(base, N * stride);
}

/* The next fibers find nothing of those before, but for pages that are touched already. */
static void a_pool_is_used_again(void **state)
{
    (void)state;
    static const int n[] = {9, 4, 9, 1};
    struct err e;
    err_clear(&e);
    struct fiber_pool *p = fiber_pool_create(9, 64 * 1024, &e);
    assert_non_null(p);
    for (int k = 0; k < 4; k++) {
        struct counter c[9] = {0};
        if (k > 0) assert_true(fiber_pool_again(p, n[k], 64 * 1024 - 1));
        assert_int_equal(fiber_pool_switches(p), 0);
        for (int i = 0; i < n[k]; i++) {
            c[i] = (struct counter){.id = 10 * k + i, .rounds = 3};
            c[i].fiber = fiber_start(p, i, count_rounds, &c[i]);
        }
        for (int round = 0; round < 4; round++)
            for (int i = 0; i < n[k]; i++) assert_int_equal(fiber_enter(c[i].fiber), round < 3);
        for (int i = 0; i < 9; i++) assert_int_equal(c[i].seen, i < n[k] ? 3 : 0);
        assert_int_equal(fiber_pool_switches(p), 4 * n[k]);
        assert_true(peak_of(p) > 0);
        /* those that are not in use have no guard of their own for now */
        assert_int_equal(fiber_below(p, (char *)c), -1);
    }
    assert_false(fiber_pool_again(p, 10, 64 * 1024));
    assert_false(fiber_pool_again(p, 4, 128 * 1024));
    fiber_pool_destroy(p);
}

/* Where in its page a fiber's first frame lies. */
static void note_place(void *argument)
{
    /* sanitizers may keep variables elsewhere */
    *(uintptr_t *)argument = (uintptr_t)__builtin_frame_address(0) % 4096;
}

/* Where a fiber's first frame lies. */
static void note_address(void *argument)
{
    *(uintptr_t *)argument = (uintptr_t)__builtin_frame_address(0);
}

/* Tops are shifted against each other, but for those that fill a page; a pool that is used again
 * begins anew. */
static void filled_pages_have_no_shifted_tops(void **state)
{
    (void)state;
    struct err e;
    err_clear(&e);
    struct fiber_pool *p = fiber_pool_create(2, 64 * 1024, &e);
    assert_non_null(p);
    for (int k = 0; k < 3; k++) {
        uintptr_t place[2];
        if (k > 0) assert_true(fiber_pool_again(p, 2, 64 * 1024));
        if (k == 1) fiber_pool_fill(p);
        for (int i = 0; i < 2; i++)
            assert_false(fiber_enter(fiber_start(p, i, note_place, &place[i])));
        assert_int_equal(place[0] == place[1], k == 1);
    }
    fiber_pool_destroy(p);
}

/* Writes to its stack from the place that it was given on. */
struct writer {
    char *lowest;
    int value;
};

static void write_down_to(void *argument)
{
    const struct writer *w = argument;
    /* Not by a frame of that size: sanitizers may keep arrays elsewhere. */
    *(volatile char *)w->lowest = (char)w->value;
}

/* Fibers of a page each; both kinds of memory that they may come from. Spare bytes that are written
 * to are seen, from the first of them on. */
static void packed_stacks_tell_how_deep_they_were_and_who_went_too_far(void **state)
{
    (void)state;
    enum { FEW = 5, MANY = 1000, AT = 3 };
    static const int size[] = {FEW, MANY};
    const int page = (int)sysconf(_SC_PAGESIZE);
    for (int k = 0; k < 2; k++) {
        static struct counter c[MANY];
        struct err e;
        err_clear(&e);
        struct fiber_pool *p = fiber_pool_create_packed(size[k], &e);
        assert_non_null(p);
        for (int i = 0; i < size[k]; i++) {
            c[i] = (struct counter){.id = i, .rounds = 2};
            c[i].fiber = fiber_start(p, i, count_rounds, &c[i]);
        }
        for (int round = 0; round < 3; round++)
            for (int i = 0; i < size[k]; i++)
                assert_int_equal(fiber_enter(c[i].fiber), round < 2);
        for (int i = 0; i < size[k]; i++) assert_int_equal(c[i].seen, 2);
        const int64_t usual = peak_of(p);
        assert_true(usual > 0 && usual < page);
        assert_false(fiber_pool_again(p, FEW, page));
        /* a fiber's own first byte: the bytes of page AT begin one page above those of AT - 1 */
        uintptr_t place = 0;
        assert_false(fiber_enter(fiber_start(p, AT, note_address, &place)));
        char *bottom = (char *)(place / (uintptr_t)page * (uintptr_t)page);
        assert_int_equal(fiber_below(p, bottom - 1), -1);
        assert_int_equal(fiber_below(p, bottom), -1);
        static const int above[] = {FIBER_PACKED_SPARE + 7, FIBER_PACKED_SPARE, 56, 7, 0};
        for (int j = 0; j < 5; j++) {
            struct writer w = {bottom + above[j], 1};
            int overflowed;
            assert_false(fiber_enter(fiber_start(p, AT, write_down_to, &w)));
            assert_int_equal(fiber_pool_stack_peak(p, &overflowed), page - above[j] / 8 * 8);
            assert_int_equal(overflowed, above[j] < FIBER_PACKED_SPARE ? AT : -1);
        }
        fiber_pool_destroy(p);
    }
}

static void on_signal(int number) { (void)number; }

/* A handler that would run on a rank's stack needs most of a page; one with a stack of its own, or
 * for faults, does not matter. */
static void stacks_are_packed_unless_a_handler_would_run_there(void **state)
{
    (void)state;
    const bool usual = fiber_packs();
    struct sigaction before, other = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
#ifdef KNOWN_DEPTH
    assert_true(usual);
#endif
    sigaction(SIGUSR1, &other, &before);
    assert_false(fiber_packs());
    other.sa_flags |= SA_ONSTACK;
    sigaction(SIGUSR1, &other, NULL);
    assert_int_equal(fiber_packs(), usual);
    sigaction(SIGUSR1, &before, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fibers_interleave_and_keep_their_stacks),
        cmocka_unit_test(the_peak_sees_what_was_used),
        cmocka_unit_test(every_guard_ends_who_touches_it),
        cmocka_unit_test(an_overflow_of_one_of_very_many_is_seen),
        cmocka_unit_test(too_many_stacks_are_refused_with_a_message),
        cmocka_unit_test(a_pool_is_used_again),
        cmocka_unit_test(filled_pages_have_no_shifted_tops),
        cmocka_unit_test(stacks_are_packed_unless_a_handler_would_run_there),
        cmocka_unit_test(packed_stacks_tell_how_deep_they_were_and_who_went_too_far),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
