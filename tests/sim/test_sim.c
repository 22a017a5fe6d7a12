/* test_sim.c - the loop against a list: what is dispatched, when, and how it is counted; where time
 * ends; what stops the program; fibers that use each other's places. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../support/last_words.h"
#include "base/picoseconds.h"
#include "base/random.h"
#include "sim/event_queue.h"
#include "sim/fiber.h"

/* --- the loop against a list --- */

struct posted {
    sim_ps time;
    unsigned lane;
    uint64_t key;
    bool done;
};

enum { MOST = 3000 };
struct model {
    struct sim *sim;
    struct random random;
    struct posted event[MOST];
    int n, left;
    sim_ps spread, last_time;
    unsigned last_lane;
    int64_t dispatched, ties;
};

/* The first of the model: time, lane, key, then the order of posting, which is the order of the
 * list. */
static int model_first(const struct model *m)
{
    int best = -1;
    for (int i = 0; i < m->n; i++) {
        const struct posted *e = &m->event[i], *b = &m->event[best < 0 ? 0 : best];
        if (e->done) continue;
        if (best < 0 || e->time < b->time ||
            (e->time == b->time && (e->lane < b->lane || (e->lane == b->lane && e->key < b->key))))
            best = i;
    }
    return best;
}

static void happens(void *subject, uint64_t argument, sim_ps now);

/* In the present the lane must not come before that of the event being dispatched. */
static void post(struct model *m, sim_ps now, unsigned lane)
{
    if (m->n == MOST) return;
    struct posted *e = &m->event[m->n];
    e->time = now + (sim_ps)random_below(&m->random, (uint64_t)m->spread);
    e->lane = (unsigned)random_below(&m->random, 3) * 32767;
    if (e->time == now && e->lane < lane) e->lane = lane;
    e->key = random_below(&m->random, 3) * ((UINT64_C(1) << 47) - 1);
    e->done = false;
    sim_at(m->sim, e->time, e->lane, e->key, happens, m, (uint64_t)m->n);
    m->n++, m->left++;
}

static void happens(void *subject, uint64_t argument, sim_ps now)
{
    struct model *m = subject;
    const int first = model_first(m);
    assert_int_equal(argument, first);
    struct posted *e = &m->event[first];
    assert_int_equal(now, e->time);
    assert_int_equal(sim_now(m->sim), now);
    e->done = true, m->left--;
    m->ties += m->dispatched > 0 && e->time == m->last_time && e->lane == m->last_lane;
    m->dispatched++;
    m->last_time = e->time, m->last_lane = e->lane;
    /* branching of 1 on average, so that the number pending walks up and down */
    for (uint64_t k = random_below(&m->random, 3); k > 0; k--) post(m, now, e->lane);
}

static uint64_t run_model(uint64_t seed, sim_ps spread)
{
    static struct model m;
    m = (struct model){.sim = sim_create(), .random = random_make(seed, 0, 0), .spread = spread};
    assert_int_equal(sim_next_time(m.sim), SIM_NEVER);
    assert_false(sim_step(m.sim));
    for (int k = 0; k < 60; k++) post(&m, 0, 0);
    for (int step = 0; step < 1200 && m.left > 0; step++) {
        assert_int_equal(sim_pending(m.sim), m.left);
        assert_int_equal(sim_next_time(m.sim), m.event[model_first(&m)].time);
        assert_true(sim_step(m.sim));
        assert_int_equal(sim_events(m.sim), m.dispatched);
        assert_int_equal(sim_ties(m.sim), m.ties);
    }
    assert_true(m.dispatched > 60);
    const uint64_t digest = sim_digest(m.sim);
    sim_destroy(m.sim);
    return digest;
}

static void events_happen_as_a_list_says(void **state)
{
    (void)state;
    static const sim_ps spread[] = {1, 5, 4096, 8193, 262144, INT64_C(1) << 44};
    for (size_t k = 0; k < sizeof spread / sizeof *spread; k++) {
        const uint64_t digest = run_model(k, spread[k]);
        /* the same again: no address of this process is in it */
        assert_int_equal(run_model(k, spread[k]), digest);
        assert_int_not_equal(run_model(k + 100, spread[k]), digest);
    }
}

/* --- what the digest and the ties see --- */

static void nothing(void *subject, uint64_t argument, sim_ps now)
{
    (void)subject, (void)argument, (void)now;
}

static void the_digest_sees_time_lane_and_key_and_nothing_else(void **state)
{
    (void)state;
    static const struct {
        sim_ps time;
        unsigned lane;
        uint64_t key, argument;
        bool same;
    } row[] = {{7, 2, 3, 0, true},  {7, 2, 3, 9, true},  {8, 2, 3, 0, false},
               {7, 3, 3, 0, false}, {7, 2, 4, 0, false}, {7, 2, (UINT64_C(1) << 48) - 1, 0, false}};
    uint64_t first = 0;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        struct sim *s = sim_create();
        sim_at(s, row[k].time, row[k].lane, row[k].key, nothing, NULL, row[k].argument);
        while (sim_step(s)) {
        }
        if (k == 0) first = sim_digest(s);
        assert_true((sim_digest(s) == first) == row[k].same);
        sim_destroy(s);
    }
    sim_destroy(NULL);
}

static void a_tie_has_the_same_time_and_lane(void **state)
{
    (void)state;
    struct sim *s = sim_create();
    /* the first event, at time 0 in lane 0, ties with nothing */
    sim_at(s, 0, 0, 0, nothing, NULL, 0);
    sim_at(s, 0, 0, 8, nothing, NULL, 0); /* tie: another key */
    sim_at(s, 0, 1, 8, nothing, NULL, 0); /* another lane */
    sim_at(s, 1, 1, 8, nothing, NULL, 0); /* another time */
    sim_at(s, 1, 1, 8, nothing, NULL, 0); /* tie */
    static const int64_t ties[] = {0, 1, 1, 1, 2};
    for (int k = 0; k < 5; k++) {
        assert_true(sim_step(s));
        assert_int_equal(sim_ties(s), ties[k]);
    }
    assert_false(sim_step(s));
    assert_int_equal(sim_events(s), 5);
    sim_destroy(s);
}

/* --- where time ends --- */

static void the_last_picosecond_still_happens(void **state)
{
    (void)state;
    struct sim *s = sim_create();
    sim_at(s, PS_LAST, 0, 0, nothing, NULL, 0);
    sim_at(s, PS_LAST + 1, 0, 0, nothing, NULL, 0);
    sim_at(s, PS_TOO_LONG, 0, 0, nothing, NULL, 0);
    assert_true(sim_step(s));
    assert_false(sim_beyond(s));
    assert_int_equal(sim_now(s), PS_LAST);
    assert_false(sim_step(s));
    assert_true(sim_beyond(s));
    assert_int_equal(sim_now(s), PS_LAST);
    assert_int_equal(sim_events(s), 1);
    assert_false(sim_step(s));
    sim_destroy(s);
    /* an empty queue is not beyond */
    s = sim_create();
    assert_false(sim_step(s));
    assert_false(sim_beyond(s));
    sim_destroy(s);
}

static void durations_are_rounded_until_they_are_too_long(void **state)
{
    (void)state;
    assert_int_equal(sim_from_seconds(0.4e-12), 0);
    assert_int_equal(sim_from_seconds(0.6e-12), 1);
    assert_int_equal(sim_from_seconds(1), INT64_C(1000000000000));
    assert_int_equal(sim_from_seconds(1152921), INT64_C(1152921000000000000));
    assert_int_equal(sim_from_seconds(1152922), PS_TOO_LONG);
    assert_int_equal(sim_from_seconds(1e300), PS_TOO_LONG);
    assert_int_equal(sim_from_seconds((double)INFINITY), PS_TOO_LONG);
}

/* --- events that are announced --- */

struct foreseen {
    struct sim *sim;
    int early[2], late; /* announced at each step; happened */
    bool told[200][2], happened[200];
};

static void announced(void *subject, uint64_t argument, int step)
{
    struct foreseen *f = subject;
    assert_true(step == 0 || step == 1);
    assert_false(f->happened[argument]); /* before it is due */
    /* the farther step comes first, but for those that the window begins with */
    if (argument >= 16 && step == 1) assert_true(f->told[argument][0]);
    f->told[argument][step] = true;
    f->early[step]++;
}

static void due(void *subject, uint64_t argument, sim_ps now)
{
    struct foreseen *f = subject;
    (void)now;
    f->happened[argument] = true;
    f->late++;
}

static void only_the_foreseen_action_is_announced(void **state)
{
    (void)state;
    for (int steps = 1; steps <= 2; steps++) {
        struct foreseen f = {.sim = sim_create()}, plain = {.sim = f.sim};
        sim_foresee(f.sim, due, announced, steps);
        /* in one window of the queue, ahead of the present; every other one of another action */
        for (uint64_t k = 0; k < 200; k++)
            sim_at(f.sim, 5000 + (sim_ps)k, 0, 0, k % 2 ? nothing : due,
                   k % 2 ? (void *)&plain : &f, k);
        while (sim_step(f.sim)) {
        }
        assert_int_equal(f.late, 100);
        assert_true(f.early[0] > 80 && f.early[0] <= 100);
        if (steps > 1) assert_true(f.early[1] > 80 && f.early[1] <= 100);
        else assert_int_equal(f.early[1], 0);
        assert_true(plain.early[0] == 0 && plain.early[1] == 0);
        sim_destroy(f.sim);
    }
}

/* --- what stops the program --- */

static struct sim *stopped;

static void post_in_the_past(void) { sim_at(stopped, 99, 0, 0, nothing, NULL, 0); }
static void lane_too_large(void) { sim_at(stopped, 200, 65536, 0, nothing, NULL, 0); }
static void key_too_large(void) { sim_at(stopped, 200, 0, UINT64_C(1) << 48, nothing, NULL, 0); }
static void negative_seconds(void) { (void)sim_from_seconds(-1e-12); }
static void no_number_of_seconds(void) { (void)sim_from_seconds((double)NAN); }

static void what_cannot_be_posted_stops_the_program(void **state)
{
    (void)state;
    static void (*const wrong[])(void) = {post_in_the_past, lane_too_large, key_too_large,
                                          negative_seconds, no_number_of_seconds};
    stopped = sim_create();
    sim_at(stopped, 100, 0, 0, nothing, NULL, 0);
    assert_true(sim_step(stopped));
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char words[512];
        expect_abort(wrong[k], words, sizeof words);
        if (!strstr(words, "CHECK(")) fail_msg("%d: '%s'", (int)k, words);
    }
    /* the limits themselves are allowed */
    sim_at(stopped, 100, 65535, (UINT64_C(1) << 48) - 1, nothing, NULL, 0);
    assert_true(sim_step(stopped));
    sim_destroy(stopped);
}

/* --- the queue when it is empty, and when many share one time --- */

static void an_empty_queue_has_no_first_event(void **state)
{
    (void)state;
    struct event_queue q;
    struct event e = {.time = 3};
    event_queue_init(&q);
    assert_int_equal(event_queue_next_time(&q), SIM_NEVER);
    assert_false(event_queue_pop(&q, &e));
    assert_int_equal(e.time, 3); /* left alone */
    event_queue_push(&q, &(struct event){.time = SIM_NEVER});
    assert_int_equal(event_queue_next_time(&q), SIM_NEVER);
    assert_true(event_queue_pop(&q, &e));
    assert_int_equal(e.time, SIM_NEVER);
    assert_false(event_queue_pop(&q, &e));
    event_queue_done(&q);
}

/* Some far ahead, some in the present window; those of one time and order by age, through all
 * levels of the wheel. */
static void equal_events_keep_the_order_of_posting(void **state)
{
    (void)state;
    static const sim_ps time[] = {
        0, 4095, 4096, 70 << WINDOW_BITS, INT64_C(5000) << WINDOW_BITS, INT64_C(1) << 50};
    for (size_t k = 0; k < sizeof time / sizeof *time; k++) {
        struct event_queue q;
        struct event e;
        event_queue_init(&q);
        enum { N = 3 * CHUNK_EVENTS + 5 };
        /* keys in falling order, each twice */
        for (uint64_t i = 0; i < N; i++)
            event_queue_push(&q,
                             &(struct event){.time = time[k], .order = (N - i) / 2, .argument = i});
        uint64_t last_order = 0, last = 0;
        for (int i = 0; i < N; i++) {
            assert_int_equal(event_queue_next_time(&q), time[k]);
            assert_true(event_queue_pop(&q, &e));
            assert_true(e.order > last_order ||
                        (e.order == last_order && (i == 0 || e.argument > last)));
            last_order = e.order, last = e.argument;
        }
        assert_false(event_queue_pop(&q, &e));
        event_queue_done(&q);
    }
}

/* --- fibers --- */

struct relay {
    struct fiber *me;
    int turns, *trace, *n, id;
};

static void runs(void *argument)
{
    struct relay *r = argument;
    for (int i = 0; i < r->turns; i++) {
        r->trace[(*r->n)++] = r->id;
        if (i + 1 < r->turns) fiber_leave(r->me);
    }
}

/* A fiber that has returned can be started again in its place, on the same stack. */
static void fibers_run_when_they_are_entered_and_start_again(void **state)
{
    (void)state;
    struct err e;
    int trace[16], n = 0;
    err_clear(&e);
    struct fiber_pool *p = fiber_pool_create(2, 1, &e); /* rounded up to a page */
    assert_non_null(p);
    for (int round = 1; round <= 3; round++) {
        struct relay a = {.turns = 2, .trace = trace, .n = &n, .id = 1}, b = a;
        b.id = 2, b.turns = 1, n = 0;
        a.me = fiber_start(p, 0, runs, &a), b.me = fiber_start(p, 1, runs, &b);
        assert_int_equal(n, 0); /* nothing runs before it is entered */
        fiber_prefetch(a.me);
        fiber_prefetch_stack(a.me);
        assert_true(fiber_enter(a.me));
        assert_false(fiber_enter(b.me));
        assert_false(fiber_enter(a.me));
        assert_int_equal(n, 3);
        assert_true(trace[0] == 1 && trace[1] == 2 && trace[2] == 1);
        assert_int_equal(fiber_pool_switches(p), 3 * round);
    }
    fiber_pool_destroy(p);
    assert_true(strcmp(fiber_backend(), "fcontext") == 0 ||
                strcmp(fiber_backend(), "ucontext") == 0);
}

static void mark_place(void *argument) { *(char **)argument = __builtin_frame_address(0); }

/* Addresses: those of a stack belong to nobody below it; those just below the stack of fiber i are
 * fiber i's. */
static void an_address_below_a_stack_names_its_fiber(void **state)
{
    (void)state;
    enum { N = 5, STACK = 64 * 1024 };
    struct err e;
    int outside = 0;
    char *marked = NULL;
    err_clear(&e);
    struct fiber_pool *p = fiber_pool_create(N, STACK, &e);
    assert_non_null(p);
    for (int i = 0; i < N; i++) {
        assert_false(fiber_enter(fiber_start(p, i, mark_place, &marked)));
        assert_int_equal(fiber_below(p, marked), -1);
        assert_int_equal(fiber_below(p, marked - STACK), i);
    }
    assert_int_equal(fiber_below(p, &outside), -1);
    assert_int_equal(fiber_below(p, NULL), -1);
    fiber_pool_destroy(p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(events_happen_as_a_list_says),
        cmocka_unit_test(the_digest_sees_time_lane_and_key_and_nothing_else),
        cmocka_unit_test(a_tie_has_the_same_time_and_lane),
        cmocka_unit_test(the_last_picosecond_still_happens),
        cmocka_unit_test(durations_are_rounded_until_they_are_too_long),
        cmocka_unit_test(only_the_foreseen_action_is_announced),
        cmocka_unit_test(what_cannot_be_posted_stops_the_program),
        cmocka_unit_test(an_empty_queue_has_no_first_event),
        cmocka_unit_test(equal_events_keep_the_order_of_posting),
        cmocka_unit_test(fibers_run_when_they_are_entered_and_start_again),
        cmocka_unit_test(an_address_below_a_stack_names_its_fiber),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
