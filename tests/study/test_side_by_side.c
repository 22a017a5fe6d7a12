/* test_side_by_side.c - pieces on worker processes: the same results in order, and a death is
 * told. */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "study/side_by_side.h"
#include "study/stability.h"

enum { PIECES = 40, LARGEST = 300000 };

struct log {
    /* pieces that end their worker, that have an error, that are not taken; -1: none */
    int dies, fails, refuses;
    int taken;
    uint64_t sum;
    bool backwards; /* the last piece is begun first */
    char data[LARGEST];
};

/* Pieces of very different sizes, larger than a pipe holds, some of none; early ones take
 * longest. */
static bool make(void *context, int i, const void **data, size_t *bytes, struct err *e)
{
    struct log *k = context;
    if (i == k->dies) raise(SIGKILL);
    if (i == k->fails) return err_set(e, ERR_DATA, "piece %d is bad", i);
    if (i < 4) usleep(20000);
    *bytes = (size_t)(i * 7919) % LARGEST;
    memset(k->data, i, *bytes);
    k->taken = 1000; /* is seen by nobody else when this is another process */
    *data = k->data;
    return true;
}

static bool take(void *context, int i, const void *data, size_t bytes, struct err *e)
{
    struct log *k = context;
    if (k->taken >= 1000) k->taken -= 1000 - i; /* made in this process */
    assert_int_equal(i, k->taken);
    assert_int_equal(bytes, (size_t)(i * 7919) % LARGEST);
    for (size_t b = 0; b < bytes; b++) k->sum = k->sum * 31 + ((const unsigned char *)data)[b];
    k->taken = i + 1;
    return i != k->refuses || err_set(e, ERR_IO, "no room for piece %d", i);
}

static bool all(struct log *k, int workers, struct err *e)
{
    int turn[PIECES];
    for (int i = 0; i < PIECES; i++) turn[i] = PIECES - 1 - i;
    const struct pieces p = {PIECES, k->backwards ? turn : NULL, k, make, take};
    err_clear(e);
    return side_by_side(&p, workers, e);
}

static void results_do_not_depend_on_workers(void **state)
{
    (void)state;
    struct err e;
    uint64_t sum = 0;
    static const int workers[] = {1, 2, 3, 7, 0, 1000};
    for (size_t w = 0; w < sizeof workers / sizeof *workers; w++) {
        static struct log k;
        k = (struct log){-1, -1, -1, 0, 0, false, {0}};
        assert_true(all(&k, workers[w], &e));
        assert_int_equal(k.taken, PIECES);
        if (w == 0) sum = k.sum;
        assert_true(k.sum == sum);
        k = (struct log){-1, -1, -1, 0, 0, true, {0}};
        assert_true(all(&k, workers[w], &e));
        assert_int_equal(k.taken, PIECES);
        assert_true(k.sum == sum);
    }
    const struct pieces none = {0, NULL, NULL, make, take};
    assert_true(side_by_side(&none, 2, &e));
}

/* The first error in order counts, whoever was faster. */
static void errors_and_deaths_are_told(void **state)
{
    (void)state;
    struct err e;
    for (int workers = 1; workers <= 3; workers++) {
        static struct log k;
        k = (struct log){-1, 9, -1, 0, 0, false, {0}};
        assert_false(all(&k, workers, &e));
        assert_string_equal(e.text, "piece 9 is bad");
        assert_int_equal(e.kind, ERR_DATA);
        k = (struct log){-1, -1, 5, 0, 0, false, {0}};
        assert_false(all(&k, workers, &e));
        assert_string_equal(e.text, "no room for piece 5");
        if (workers == 1) continue;
        k = (struct log){12, -1, -1, 0, 0, false, {0}};
        assert_false(all(&k, workers, &e));
        assert_int_equal(e.kind, ERR_INTERNAL);
        assert_string_equal(e.text, "a worker process died before piece 13 was done");
    }
}

/* The rows of the suite's small scenes, made here and made by three workers. */
static void the_suite_is_the_same_on_several_processes(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct stability_report r[2];
    struct err e;
    err_clear(&e);
    for (int k = 0; k < 2; k++) {
        const struct stability_options o = {
            .most_bodies = 7, .workers = k == 0 ? 1 : 3, .quiet = true};
        assert_true(stability_measure(NULL, 0, &o, a, &r[k], &e));
    }
    assert_int_equal(r[0].nrow, r[1].nrow);
    assert_true(r[0].nrow > 50);
    assert_memory_equal(r[0].row, r[1].row, (size_t)r[0].nrow * sizeof *r[0].row);
    /* and scene by scene */
    struct stability_report all = {.arena = a};
    for (int i = 0; i < stability_suite_size(); i++) {
        const struct stability_options one = {
            .most_bodies = 7, .workers = 1, .first = i, .scenes = 1, .quiet = true};
        assert_true(stability_measure(NULL, 0, &one, a, &r[1], &e));
        if (stability_suite_bodies(i) > 7) assert_int_equal(r[1].nrow, 0);
        stability_append(&all, r[1].row, r[1].nrow);
    }
    assert_int_equal(all.nrow, r[0].nrow);
    assert_memory_equal(all.row, r[0].row, (size_t)r[0].nrow * sizeof *r[0].row);
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_do_not_depend_on_workers),
        cmocka_unit_test(errors_and_deaths_are_told),
        cmocka_unit_test(the_suite_is_the_same_on_several_processes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
