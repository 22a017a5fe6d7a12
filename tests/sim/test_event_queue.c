/* test_event_queue.c - The event queue against a dumb twin, and the loop's total order. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdlib.h>

#include "base/random.h"
#include "sim/event_queue.h"

static bool twin_before(const struct event *a, const struct event *b)
{
    if (a->time != b->time) return a->time < b->time;
    if (a->order != b->order) return a->order < b->order;
    return a->argument < b->argument; /* the order of posting */
}

static size_t twin_first(const struct event *e, size_t n)
{
    size_t best = 0;
    for (size_t i = 1; i < n; i++)
        if (twin_before(&e[i], &e[best])) best = i;
    return best;
}

/* Random posting and taking, times up to `spread` ahead, against a list searched for its first. */
static void against_the_list(uint64_t spread)
{
    enum { MOST = 1000 };
    struct random r = random_make(7, spread, 0);
    struct event_queue q;
    event_queue_init(&q);
    struct event *twin = calloc(MOST, sizeof *twin);
    size_t n = 0;
    sim_ps now = 0;
    for (uint64_t step = 0; step < 8000; step++) {
        if (n < MOST && (n == 0 || random_below(&r, 5) < 3)) {
            struct event e = {now + (sim_ps)random_below(&r, spread), random_below(&r, 4), NULL,
                              NULL, step};
            event_queue_push(&q, &e);
            twin[n++] = e;
            continue;
        }
        struct event e;
        size_t best = twin_first(twin, n);
        /* Half of them only if they are due by some limit. After a no all that follows is later. */
        const sim_ps limit =
            random_below(&r, 2) ? SIM_NEVER : now + (sim_ps)random_below(&r, 2 * spread);
        const bool taken = event_queue_pop_by(&q, limit, &e);
        assert_int_equal(taken, twin[best].time <= limit);
        if (!taken) {
            now = limit + 1;
            continue;
        }
        assert_int_equal(e.argument, twin[best].argument);
        assert_int_equal(e.time, twin[best].time);
        now = e.time;
        twin[best] = twin[--n];
    }
    assert_int_equal(q.count, n);
    if (n) assert_int_equal(event_queue_next_time(&q), twin[twin_first(twin, n)].time);
    free(twin);
    event_queue_done(&q);
}

static void events_come_out_as_from_a_list(void **state)
{
    (void)state;
    static const uint64_t spread[] = {1, 3, 50, 64, 65, 4095, 4096, 4097, 300000, 1000000,
                                      UINT64_C(1) << 40, UINT64_C(1) << 55};
    for (size_t i = 0; i < sizeof spread / sizeof *spread; i++) against_the_list(spread[i]);
}

struct seen {
    struct sim *sim;
    uint64_t order[16];
    int n;
};

static void note(void *subject, uint64_t argument, sim_ps now)
{
    (void)now;
    struct seen *s = subject;
    s->order[s->n++] = argument;
}

static void note_and_post(void *subject, uint64_t argument, sim_ps now)
{
    struct seen *s = subject;
    note(s, argument, now);
    sim_at(s->sim, now, 2, 0, note, s, argument + 100);
}

static void events_come_by_time_then_lane_then_key_then_age(void **state)
{
    (void)state;
    struct seen s = {.sim = sim_create()};
    sim_at(s.sim, 20, 0, 0, note, &s, 6);
    sim_at(s.sim, 10, 2, 0, note, &s, 4);
    sim_at(s.sim, 10, 1, 9, note, &s, 3);
    sim_at(s.sim, 10, 1, 5, note, &s, 1);
    sim_at(s.sim, 10, 1, 5, note, &s, 2);
    sim_at(s.sim, 10, 0, 7, note_and_post, &s, 0);
    while (sim_step(s.sim)) {
    }
    uint64_t expected[] = {0, 1, 2, 3, 4, 100, 6};
    assert_int_equal(s.n, 7);
    for (int i = 0; i < 7; i++) assert_int_equal(s.order[i], expected[i]);
    assert_int_equal(sim_events(s.sim), 7);
    assert_int_equal(sim_ties(s.sim), 3);
    assert_int_equal(sim_now(s.sim), 20);
    sim_destroy(s.sim);
}

static uint64_t digest_of(sim_ps second)
{
    struct seen s = {.sim = sim_create()};
    sim_at(s.sim, 10, 1, 1, note, &s, 0);
    sim_at(s.sim, second, 1, 2, note, &s, 1);
    while (sim_step(s.sim)) {
    }
    uint64_t d = sim_digest(s.sim);
    sim_destroy(s.sim);
    return d;
}

static void the_digest_sees_one_picosecond(void **state)
{
    (void)state;
    assert_int_equal(digest_of(30), digest_of(30));
    assert_int_not_equal(digest_of(30), digest_of(31));
}

static void seconds_become_the_nearest_picosecond(void **state)
{
    (void)state;
    assert_int_equal(sim_from_seconds(1.001e-9), 1001);
    assert_int_equal(sim_from_seconds(0), 0);
    assert_int_equal(sim_from_seconds(16e-6), 16000000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(events_come_out_as_from_a_list),
        cmocka_unit_test(events_come_by_time_then_lane_then_key_then_age),
        cmocka_unit_test(the_digest_sees_one_picosecond),
        cmocka_unit_test(seconds_become_the_nearest_picosecond),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
