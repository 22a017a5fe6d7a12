/* test_comm_serial.c - one rank alone: what it publishes, what it may ask, and that each way to
 * talk to somebody stops the program. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdio.h>
#include <string.h>

#include "../support/last_words.h"
#include "base/random.h"
#include "comm/comm_serial.h"

/* --- work and stages, against sums --- */

static void work_is_counted_in_its_stage(void **state)
{
    struct comm_serial s = comm_serial_make();
    struct work sum[COMM_SERIAL_STAGES] = {{0}};
    struct random r = random_make(81, 0, 0);
    int stage = 0;
    (void)state;
    for (int k = 0; k < 2000; k++) {
        if (random_below(&r, 3) == 0)
            comm_stage(&s.comm, stage = (int)random_below(&r, COMM_SERIAL_STAGES));
        const struct work w = {.flop = random_below(&r, 9),
                               .div = random_below(&r, 9),
                               .sqrt = random_below(&r, 9),
                               .trig = random_below(&r, 9),
                               .bytes = random_below(&r, 9),
                               .call = random_below(&r, 9)};
        comm_work(&s.comm, &w);
        sum[stage].flop += w.flop, sum[stage].div += w.div, sum[stage].sqrt += w.sqrt;
        sum[stage].trig += w.trig, sum[stage].bytes += w.bytes, sum[stage].call += w.call;
        /* neither time nor barriers are anything here */
        comm_elapse(&s.comm, (int64_t)random_below(&r, 1000));
        comm_barrier(&s.comm);
        assert_int_equal(comm_now_ps(&s.comm), 0);
    }
    assert_memory_equal(s.work, sum, sizeof sum);
    /* two communicators have nothing in common */
    struct comm_serial other = comm_serial_make();
    for (int i = 0; i < COMM_SERIAL_STAGES; i++) assert_int_equal(other.work[i].flop, 0);
}

/* --- outputs --- */

static void what_is_wanted_is_published(void **state)
{
    struct comm_serial s = comm_serial_make();
    double x[4] = {-1, -1, -1, -1};
    const double data[3] = {1, 2, 3};
    const struct comm_output out[3] = {{NULL, 5}, {x, 4}, {x, 0}};
    (void)state;
    /* nobody wants anything */
    comm_publish(&s.comm, 0, 100, 3, data);
    assert_false(comm_wanted(&s.comm, 0));
    s.comm.output = out, s.comm.noutput = 3;
    assert_false(comm_wanted(&s.comm, 0));
    assert_true(comm_wanted(&s.comm, 1));
    assert_false(comm_wanted(&s.comm, 3));
    comm_publish(&s.comm, 0, 100, 3, data);
    comm_publish(&s.comm, 3, 100, 3, data);
    comm_publish(&s.comm, 1, 1, 3, data);
    comm_publish(&s.comm, 1, 4, 0, data);
    comm_publish(&s.comm, 2, 0, 0, data);
    assert_true(x[0] == -1 && x[1] == 1 && x[2] == 2 && x[3] == 3);
    comm_publish(&s.comm, 1, 0, 1, data + 2);
    assert_true(x[0] == 3 && x[1] == 1);
}

/* --- nothing is ever under way --- */

static void nothing_is_ever_pending(void **state)
{
    struct comm_serial s = comm_serial_make();
    struct comm_request none = {0}, *list[3] = {NULL, &none, &none};
    struct comm_envelope e;
    (void)state;
    comm_wait(&s.comm, &none);
    comm_waitall(&s.comm, 1, &none);
    assert_int_equal(comm_test(&s.comm, &none), 1);
    assert_int_equal(comm_test_any(&s.comm, 3, list), -1);
    assert_int_equal(comm_wait_any(&s.comm, 3, list), -1);
    assert_int_equal(comm_wait_any(&s.comm, 0, NULL), -1);
    assert_int_equal(comm_probe(&s.comm, COMM_ANY_SOURCE, 3, COMM_WHOLE_TAG, 0, &e), 0);
    assert_int_equal(comm_probe_take(&s.comm, COMM_ANY_SOURCE, 3, COMM_WHOLE_TAG, 0, &e, &none), 0);
    assert_int_equal(s.comm.type->cancel(&s.comm, &none), 0);
    assert_null(s.comm.type->next_complete(&s.comm, 1000));
}

/* --- what stops the program --- */

static struct comm_serial alone;
static struct comm *c; /* &alone.comm */
static struct comm_request request;
static double number;
static struct comm_output one = {&number, 1};

static void send_to_itself(void) { comm_send(c, 0, 1, &number, 8); }
static void send_to_others(void) { comm_send(c, 1, 1, &number, 8); }
static void send_to_nobody(void) { comm_send(c, -1, 1, &number, 8); }
static void send_of_nothing(void) { comm_send(c, 0, 1, NULL, 0); }
static void receive_itself(void) { comm_recv(c, 0, 1, &number, 8); }
static void receive_others(void) { comm_recv(c, 1, 1, &number, 8); }
static void receive_below(void) { comm_irecv(c, -2, 1, &number, 8, &request); }
static void hand_shake(void) { comm_isend_synchronous(c, -1, 1, &number, 8, &request); }
static void receive_any(void)
{
    comm_irecv_matching(c, COMM_ANY_SOURCE, 1, COMM_WHOLE_TAG, &number, 8, &request);
}
static void wait_for_probe(void)
{
    comm_probe(c, COMM_ANY_SOURCE, 1, COMM_WHOLE_TAG, 1, &(struct comm_envelope){0});
}
static void active(void) { request.active = 1; }
static void wait_active(void) { active(), comm_wait(c, &request); }
static void test_active(void) { active(), (void)comm_test(c, &request); }
static void any_active(void)
{
    active(), (void)comm_wait_any(c, 1, &(struct comm_request *){&request});
}
static void cancel_active(void) { active(), (void)c->type->cancel(c, &request); }
static void take_active(void) { active(), comm_receive_into(c, &request, &number, 8); }
static void watch_active(void) { active(), c->type->watch(c, &request); }
static void stage_below(void) { comm_stage(c, -1); }
static void stage_beyond(void) { comm_stage(c, COMM_SERIAL_STAGES); }
static void back_in_time(void) { comm_elapse(c, -1); }
static void publish_beyond(void) { comm_publish(c, 0, 1, 1, &number); }
static void publish_below(void) { comm_publish(c, 0, -1, 1, &number); }
static void publish_fewer(void) { comm_publish(c, 0, 0, -1, &number); }
static void publish_far(void) { comm_publish(c, 0, INT64_MAX, 1, &number); }

static void talking_to_somebody_stops_the_program(void **state)
{
    static void (*const wrong[])(void) = {
        send_to_itself, send_to_others, send_to_nobody, send_of_nothing, receive_itself,
        receive_others, receive_below,  hand_shake,     receive_any,     wait_for_probe,
        wait_active,    test_active,    any_active,     cancel_active,   take_active,
        watch_active,   stage_below,    stage_beyond,   back_in_time,    publish_beyond,
        publish_below,  publish_fewer,  publish_far,
    };
    (void)state;
    alone = comm_serial_make();
    c = &alone.comm;
    c->output = &one, c->noutput = 1;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char words[512];
        expect_abort(wrong[k], words, sizeof words);
        if (!strstr(words, "CHECK(")) fail_msg("%d: '%s'", (int)k, words);
    }
}

static void fail_here(void) { comm_fail(c, "out of ideas"); }

static void a_failure_tells_its_place(void **state)
{
    char words[512], line[32];
    (void)state;
    alone = comm_serial_make();
    c = &alone.comm;
    expect_abort(fail_here, words, sizeof words);
    assert_non_null(strstr(words, ": out of ideas\n"));
    snprintf(line, sizeof line, "test_comm_serial.c:");
    assert_non_null(strstr(words, line));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(work_is_counted_in_its_stage),
        cmocka_unit_test(what_is_wanted_is_published),
        cmocka_unit_test(nothing_is_ever_pending),
        cmocka_unit_test(talking_to_somebody_stops_the_program),
        cmocka_unit_test(a_failure_tells_its_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
