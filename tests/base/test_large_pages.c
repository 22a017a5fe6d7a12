/* test_large_pages.c - the heap in large pages: what many small takes cost in faults, and that it
 * stays with the process. */
#include "config.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/large_pages.h"
#include "base/memory.h"

#include "../support/large_pages.h"

enum { PIECES = 1000, PIECE = 4096 };

/* Faults of this process up to now. */
static long faults(void)
{
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    return used.ru_minflt;
}

/* The faults of 4 MB in pieces of a page, each written to; they are free afterwards. */
static long faults_of_pieces(void)
{
    static void *piece[PIECES];
    const long before = faults();
    for (int i = 0; i < PIECES; i++) piece[i] = memset(memory_take(1, PIECE), 1, PIECE);
    const long after = faults();
    for (int i = 0; i < PIECES; i++) free(piece[i]);
    return after - before;
}

/* With as much address space as `ulimit -v 300000` leaves, the heap takes none of it ahead. */
static void little_address_space_is_left_to_others(void **state)
{
    (void)state;
    struct rlimit before;
    getrlimit(RLIMIT_AS, &before);
    const struct rlimit little = {.rlim_cur = 300000 << 10, .rlim_max = before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_AS, &little), 0);
    const char *end = sbrk(0);
    large_pages_for_heap();
    free(memory_take(1, 1 << 18));
    const char *grown = sbrk(0);
    setrlimit(RLIMIT_AS, &before);
    assert_true(grown - end < 1 << 20);
}

static void memory_that_was_free_is_taken_again_without_a_fault(void **state)
{
    (void)state;
    large_pages_for_heap();
    const long first = faults_of_pieces(), again = faults_of_pieces();
    print_message("%d pages: %ld faults, again %ld\n", PIECES, first, again);
#if defined SANITIZERS || defined THREAD_SANITIZER || !defined __GLIBC__
    skip(); /* their heap is another */
#endif
    assert_true(again < 10);
    if (large_pages_given()) assert_true(first < PIECES / 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(little_address_space_is_left_to_others), /* before what cannot be undone */
        cmocka_unit_test(memory_that_was_free_is_taken_again_without_a_fault),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
