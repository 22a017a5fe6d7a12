/* test_arena.c - memory of a run: zeroed, aligned, given back by marks, cheap when untouched. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/resource.h>

#include <cmocka.h>

#include "base/arena.h"
#include "base/progress.h"
#include "base/random.h"

#include "../support/large_pages.h"

static bool all_are(const unsigned char *p, size_t size, unsigned char value)
{
    for (size_t k = 0; k < size; k++)
        if (p[k] != value) return false;
    return true;
}

static void takes_are_zeroed_aligned_and_apart(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct random r = random_make(1, 0, 0);
    unsigned char *p[500];
    size_t size[500];
    for (int i = 0; i < 500; i++) {
        size[i] = random_below(&r, i % 50 == 0 ? 1000000 : 3000);
        p[i] = arena_take(a, size[i]);
        assert_int_equal((uintptr_t)p[i] % 64, 0);
        assert_true(all_are(p[i], size[i], 0));
        memset(p[i], i & 255, size[i]);
    }
    for (int i = 0; i < 500; i++) assert_true(all_are(p[i], size[i], (unsigned char)i));
    arena_destroy(a);
}

/* The small first block comes from the heap, where the arena before has left its bytes. */
static void memory_of_an_arena_before_is_zeroed(void **state)
{
    (void)state;
    for (int i = 0; i < 20; i++) {
        struct arena *a = arena_create();
        const size_t size = i % 2 == 0 ? 60000 : 100;
        for (int k = 0; k < (i % 2 == 0 ? 3 : 600); k++) {
            unsigned char *p = arena_take(a, size);
            assert_int_equal((uintptr_t)p % 64, 0);
            assert_true(all_are(p, size, 0));
            memset(p, 255, size);
        }
        arena_destroy(a);
    }
}

static void memory_taken_again_after_a_release_is_zeroed(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    for (int i = 0; i < 200; i++) {
        struct arena_mark m = arena_mark(a);
        size_t size = (size_t)(i * 7919 % 400000) + 1;
        unsigned char *p = arena_take(a, size);
        assert_true(all_are(p, size, 0));
        memset(p, 255, size);
        arena_release(a, m);
    }
    arena_destroy(a);
}

/* Runs of changing sizes in one arena: each finds zeros, whatever the one before has left. */
static void an_emptied_arena_begins_anew(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct random r = random_make(7, 0, 0);
    for (int run = 0; run < 60; run++) {
        const int n = (int)random_below(&r, 40) + 1;
        size_t bytes = 0;
        assert_int_equal(arena_peak(a), 0);
        for (int i = 0; i < n; i++) {
            const size_t size = random_below(&r, run % 7 == 0 ? 500000 : 20000) + 1;
            unsigned char *p = arena_take(a, size);
            assert_int_equal((uintptr_t)p % 64, 0);
            assert_true(all_are(p, size, 0));
            memset(p, 255, size);
            bytes += size;
        }
        assert_true(arena_peak(a) >= bytes);
        arena_empty(a, run % 5 == 0 ? 0 : 1 << 20);
    }
    arena_destroy(a);
}

static void a_block_that_is_kept_is_found_again(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    /* the third time one block holds all that the two before took in several */
    char *first = NULL;
    for (int run = 0; run < 8; run++) {
        char *p = arena_take(a, 50000);
        for (int i = 0; i < 9; i++) arena_take(a, 50000);
        if (run == 5) first = p;
        if (run > 5) assert_ptr_equal(p, first);
        arena_empty(a, 4 << 20);
    }
    /* nothing that is larger than allowed stays */
    memset(arena_take(a, 8 << 20), 1, 8 << 20);
    arena_empty(a, 4 << 20);
    assert_true(all_are(arena_take(a, 8 << 20), 8 << 20, 0));
    arena_destroy(a);
}

static void marks_nest_and_spare_what_was_taken_before(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct arena_mark empty = arena_mark(a);
    char *kept = arena_text(a, "kept");
    struct arena_mark outer = arena_mark(a);
    char *first = arena_take(a, 100);
    struct arena_mark inner = arena_mark(a);
    memset(arena_take(a, 3000000), 1, 3000000); /* beyond the first block */
    memset(arena_take(a, 300000), 2, 300000);
    arena_release(a, inner);
    first[99] = 'x';
    arena_release(a, outer);
    assert_ptr_equal(arena_take(a, 100), first);
    assert_int_equal(first[99], 0);
    assert_string_equal(kept, "kept");
    arena_release(a, empty);
    assert_int_equal(((char *)arena_take(a, 5))[0], 0);
    arena_destroy(a);
}

static void the_peak_is_the_largest_use_not_the_last(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    assert_int_equal(arena_peak(a), 0);
    struct arena_mark m = arena_mark(a);
    arena_take(a, 1000000);
    arena_take(a, 1000000);
    arena_release(a, m);
    arena_take(a, 64);
    assert_in_range(arena_peak(a), 2000000, 2000000 + 1024);
    arena_destroy(a);
}

static void untouched_memory_costs_no_memory_of_the_host(void **state)
{
    (void)state;
    long before = host_peak_bytes();
    struct arena *a = arena_create();
    char *large = TAKE(a, 1l << 31, char);
    large[1l << 30] = 1;
    assert_true(host_peak_bytes() - before < 64l << 20);
    arena_destroy(a);
}

/* Page faults of this process. */
static long faults(void)
{
    struct rusage u;
    getrusage(RUSAGE_SELF, &u);
    return u.ru_minflt;
}

static void memory_that_was_touched_is_written_without_page_faults(void **state)
{
    (void)state;
    const size_t size = (size_t)4 << 20;
    struct arena *a = arena_create();
    unsigned char *p[3];
    for (int i = 0; i < 3; i++) p[i] = arena_take(a, size);
    memset(p[1], 7, size / 2);
    arena_touch(a, 0);
    assert_true(all_are(p[0], size, 0) && all_are(p[1], size / 2, 7));
    const long before = faults();
    for (int i = 0; i < 3; i++) memset(p[i], i + 1, size);
    /* The sanitizer's own pages are few beside these 3,072, large pages or not. */
    assert_true(faults() - before < 8);
    arena_destroy(a);
}

/* What will be written all over takes few faults; what may stay sparse takes memory for the pages
 * that are written alone. */
static void full_arrays_lie_in_large_pages_and_sparse_ones_do_not(void **state)
{
    (void)state;
    const size_t size = (size_t)32 << 20, page = 4096, pages = size / page;
    struct arena *a = arena_create();
    unsigned char *full = arena_take_full(a, size, true), *sparse = arena_take(a, size);
    long before = faults();
    memset(full, 5, size);
    const long of_full = faults() - before;
    assert_true(all_are(full, size, 5));
    before = faults();
    for (size_t i = 0; i < pages; i += 8) sparse[i * page] = 1;
    const long of_sparse = faults() - before;
    print_message("%zu pages: %ld faults, an eighth of them: %ld\n", pages, of_full, of_sparse);
    arena_destroy(a);
#if defined SANITIZERS || defined THREAD_SANITIZER
    skip(); /* their shadows have faults of their own */
#endif
    assert_true(of_sparse >= (long)pages / 8 - 2);
    if (large_pages_given()) assert_true(of_full < (long)pages / 8);
}

/* Whether the takes fill what is left of a block or need another one. */
static void takes_that_were_foreseen_meet_no_page_faults(void **state)
{
    (void)state;
    const size_t before_them[] = {0, 100, 60000, 200000, (size_t)3 << 20}, size = (size_t)1 << 20;
    for (size_t k = 0; k < sizeof before_them / sizeof *before_them; k++) {
        struct arena *a = arena_create();
        arena_take(a, before_them[k]);
        /* Three, which the sanitizer keeps apart, and one byte that takes a line. */
        arena_touch(a, 3 * (size + 64) + 128);
        const size_t used = arena_used(a);
        const long before = faults();
        for (int i = 0; i < 3; i++) {
            unsigned char *p = arena_take(a, size);
            assert_true(all_are(p, size, 0));
            memset(p, i + 1, size);
        }
        *(char *)arena_take(a, 1) = 1;
        assert_true(faults() - before < 8);
        assert_true(arena_used(a) - used >= 3 * size + 1);
        assert_true(arena_peak(a) == arena_used(a));
        arena_destroy(a);
    }
}

/* As the repetitions of a measurement take memory. */
static void takes_that_are_repeated_lie_at_the_same_addresses_and_are_zero(void **state)
{
    (void)state;
    const size_t size[] = {300, 70000, 5, (size_t)1 << 20, 64, 400000};
    enum { TAKES = sizeof size / sizeof *size };
    void *first[TAKES];
    size_t bytes = 0;
    struct arena *a = arena_create();
    for (int round = 0; round < 4; round++) {
        arena_empty(a, SIZE_MAX);
        arena_touch(a, bytes);
        const long before = faults();
        for (int i = 0; i < TAKES; i++) {
            unsigned char *p = arena_take(a, size[i]);
            assert_true(all_are(p, size[i], 0));
            memset(p, 0xff, size[i]);
            if (round == 1) first[i] = p;
            if (round > 1) assert_ptr_equal(p, first[i]);
        }
        if (round > 0) assert_true(faults() - before < 8);
        bytes = arena_peak(a);
    }
    arena_destroy(a);
}

static void an_empty_take_is_a_place_and_null_is_destroyed_in_peace(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    assert_non_null(arena_take(a, 0));
    arena_destroy(a);
    arena_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(takes_are_zeroed_aligned_and_apart),
        cmocka_unit_test(memory_of_an_arena_before_is_zeroed),
        cmocka_unit_test(memory_taken_again_after_a_release_is_zeroed),
        cmocka_unit_test(an_emptied_arena_begins_anew),
        cmocka_unit_test(a_block_that_is_kept_is_found_again),
        cmocka_unit_test(marks_nest_and_spare_what_was_taken_before),
        cmocka_unit_test(the_peak_is_the_largest_use_not_the_last),
        cmocka_unit_test(untouched_memory_costs_no_memory_of_the_host),
        cmocka_unit_test(memory_that_was_touched_is_written_without_page_faults),
        cmocka_unit_test(takes_that_were_foreseen_meet_no_page_faults),
        cmocka_unit_test(full_arrays_lie_in_large_pages_and_sparse_ones_do_not),
        cmocka_unit_test(takes_that_are_repeated_lie_at_the_same_addresses_and_are_zero),
        cmocka_unit_test(an_empty_take_is_a_place_and_null_is_destroyed_in_peace),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
