/* test_schedule_run.c - Schedules executed by ranks: times by hand, on a machine of round numbers.
 */
#include "../vp/timed_world.h"

#include <stdio.h>
#include <string.h>

#include "schedule/schedule_run.h"

static void rank_main(struct comm *c, void *context)
{
    struct schedule_job *job = context;
    void *workspace = arena_take(job->arena, schedule_workspace(job, comm_rank(c)));
    schedule_rank(c, job, workspace);
}

/* Runs the text on the crossbar; units are nanoseconds. */
static struct outcome run_text(const struct machine_spec *m, const char *text)
{
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    struct schedule_job job = {.schedule = goal_read_text(text, strlen(text), "x.goal", a, &e),
                               .path = "x.goal",
                               .unit_ps = 1000,
                               .arena = a};
    if (!job.schedule) fail_msg("%d: %s", e.line, e.text);
    struct outcome o = go(m, job.schedule->nrank, rank_main, &job);
    arena_destroy(a);
    return o;
}

static void expect_finish(const char *text, int64_t eager, const int64_t *finish)
{
    enum network_level level[] = {LEVEL_LOGGP, LEVEL_LINK};
    for (int k = 0; k < 2; k++) {
        struct machine_spec m = crossbar(4);
        m.network.level = level[k];
        m.software.eager_bytes = eager;
        struct outcome o = run_text(&m, text);
        expect_ok(&o);
        for (int i = 0; i < o.r.nrank; i++)
            if (o.r.finish_ps[i] != finish[i])
                fail_msg("rank %d ends at %lld, not at %lld ps", i, (long long)o.r.finish_ps[i],
                         (long long)finish[i]);
        arena_destroy(o.arena);
    }
}

static void a_message_takes_what_the_machine_says(void **state)
{
    (void)state;
    const int64_t there = 5 * US + trip(1000);
    expect_finish("num_ranks 2\n"
                  "rank 0 {\na: calc 5000\nb: send 1000b to 1 tag 3\nb requires a\n}\n"
                  "rank 1 {\nrecv 1000b from 0 tag 3\n}\n",
                  -1, (const int64_t[]){5 * US + 3 * US, there + receipt(1000)});
}

/* The receive of 3 finishes before 7000 ns of computing can start, which started behind the first
 * 6000. */
static void what_is_there_earlier_goes_first(void **state)
{
    (void)state;
    expect_finish("num_ranks 2\n"
                  "rank 0 {\nsend 0b to 1\n}\n"
                  "rank 1 {\n"
                  "x: recv 0b from 0\n"
                  "a: calc 6000\n"
                  "b: calc 7000\nb requires a\n"
                  "c: calc 100\nc requires x\n"
                  "}\n",
                  -1, (const int64_t[]){2 * US, (6000 + 3000 + 7000 + 100) * 1000});
}

/* The send could start with the computing time, before the message came: it goes first, at 6 us. */
static void what_could_start_earlier_goes_first(void **state)
{
    (void)state;
    expect_finish("num_ranks 2\n"
                  "rank 0 {\nsend 0b to 1\nrecv 0b from 1\n}\n"
                  "rank 1 {\n"
                  "recv 0b from 0\n"
                  "a: calc 6000\n"
                  "b: send 0b to 0\nb irequires a\n"
                  "}\n",
                  -1, (const int64_t[]){6 * US + trip(0) + receipt(0), 11 * US});
}

/* b waits for a's end, c for its start alone. */
static void requirements_are_ends_or_starts(void **state)
{
    (void)state;
    const int64_t ends = 10 * US + 2 * US, there = 2400000;
    /* on another processor what requires the start of the long one is over before that ends */
    expect_finish("num_ranks 2\n"
                  "rank 0 {\n"
                  "a: calc 10000 cpu 1\n"
                  "b: send 0b to 1 tag 1\nb requires a\n"
                  "c: send 0b to 1 tag 2\nc irequires a\n"
                  "}\n"
                  "rank 1 {\nr: recv 0b from 0 tag 2\ns: recv 0b from 0 tag 1\nt: calc 100\nt "
                  "requires r\n}\n",
                  -1, (const int64_t[]){ends, 10 * US + there + receipt(0)});
}

static void processors_compute_beside_each_other(void **state)
{
    (void)state;
    expect_finish("num_ranks 1\n"
                  "rank 0 {\n"
                  "a: calc 3000 cpu 0\nb: calc 5000 cpu 1\nc: calc 1000 cpu 1\nd: calc 500 cpu 0\n"
                  "d requires b\n"
                  "}\n",
                  -1, (const int64_t[]){6 * US});
}

/* Beyond the limit a send has finished when it has been answered: posted at 50 us, answered 400 ns
 * later. */
static void large_sends_wait_for_their_receive(void **state)
{
    (void)state;
    const char text[] = "num_ranks 2\n"
                        "rank 0 {\na: send 1000b to 1\nb: calc 70000\nb %s a\n}\n"
                        "rank 1 {\nx: calc 50000\ny: recv 1000b from 0\ny requires x\n}\n";
    const int64_t answered = 50400000, received = answered + 400000 + 999000 + receipt(1000);
    char one[400];
    snprintf(one, sizeof one, text, "requires");
    expect_finish(one, 100, (const int64_t[]){answered + 70 * US, received});
    snprintf(one, sizeof one, text, "irequires");
    expect_finish(one, 100, (const int64_t[]){3 * US + 70 * US, received});
}

static void any_rank_and_any_tag_take_the_first(void **state)
{
    (void)state;
    expect_finish("num_ranks 3\n"
                  "rank 0 {\na: recv 8b from -1 tag -1\nb: calc 1000\nb requires a\nc: recv 8b "
                  "from 1 tag 7\nc requires b\n}\n"
                  "rank 1 {\na: calc 5000\nb: send 8b to 0 tag 7\nb requires a\n}\n"
                  "rank 2 {\nsend 8b to 0 tag 9\n}\n",
                  -1,
                  (const int64_t[]){5 * US + trip(8) + receipt(8), 7 * US + 8000, 2 * US + 8000});
}

static void what_cannot_end_is_told(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(2);
    struct outcome o =
        run_text(&m, "num_ranks 2\nrank 0 {\n}\nrank 1 {\n\nrecv 5b from 0 tag 3\n}\n");
    assert_int_equal(o.r.status, RUN_DEADLOCK);
    if (!strstr(o.r.text, "tag 3, from rank 0 (x.goal:6)")) fail_msg("%s", o.r.text);
    arena_destroy(o.arena);
    o = run_text(&m, "num_ranks 2\nrank 0 {\n}\nrank 1 {\nsend 5b to 0 tag 3\n}\n");
    assert_int_equal(o.r.status, RUN_FAILED);
    if (!strstr(o.r.text, "without receiving the message of 5 bytes, tag 3, that rank 1 sent it"))
        fail_msg("%s", o.r.text);
    arena_destroy(o.arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_message_takes_what_the_machine_says),
        cmocka_unit_test(what_is_there_earlier_goes_first),
        cmocka_unit_test(what_could_start_earlier_goes_first),
        cmocka_unit_test(requirements_are_ends_or_starts),
        cmocka_unit_test(processors_compute_beside_each_other),
        cmocka_unit_test(large_sends_wait_for_their_receive),
        cmocka_unit_test(any_rank_and_any_tag_take_the_first),
        cmocka_unit_test(what_cannot_end_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
