/* test_offload.c - what ranks do of their messages themselves and what an engine does beside them:
 * exact times, worked out by hand; and what must hold of any program. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "vp/world.h"

#include "crossbar.h"

enum { BIG = 4000, LARGE = 1000, TAG = 7, US = 1000000 }; /* [B], [B], -, [ps] */

static const char *const stage_name[] = {"all"};

/* 500 ns more for the hand-shake of messages above `eager` bytes. */
static struct machine_spec pair(enum offload offload, int64_t eager)
{
    struct machine_spec m = crossbar(4);
    m.software.rendezvous_latency = 500e-9;
    m.software.eager_bytes = eager;
    m.software.offload = offload;
    return m;
}

static struct run_result go(const struct machine_spec *m, int nrank, world_program *program,
                            void *context, bool path, struct arena *a)
{
    struct run_result r = {0};
    const struct record_spec record = {.path = path};
    struct err e;
    err_clear(&e);
    const struct world_load load = {.nrank = nrank,
                                    .program = program,
                                    .context = context,
                                    .nstage = 1,
                                    .stage_name = stage_name,
                                    .largest_message = -1};
    if (!world_run(m, &load, &record, 1, a, &r, &e)) fail_msg("%s", e.text);
    assert_int_equal(r.status, RUN_OK);
    return r;
}

/* The steps of the path follow each other from 0 to the makespan. */
static void assert_whole(const struct run_result *r)
{
    int64_t time = 0;
    for (int64_t i = 0; i < r->npath; i++) {
        assert_int_equal(r->path[i].begin_ps, time);
        time = r->path[i].end_ps;
    }
    assert_int_equal(time, r->makespan_ps);
}

/* Finishing times of both ranks, with and without a record of the path. */
static void assert_ends(const struct machine_spec *m, world_program *program, void *context,
                        int64_t first, int64_t second)
{
    for (int path = 0; path < 2; path++) {
        struct arena *a = arena_create();
        const struct run_result r = go(m, 2, program, context, path, a);
        assert_int_equal(r.finish_ps[0], first);
        assert_int_equal(r.finish_ps[1], second);
        if (path) assert_whole(&r);
        arena_destroy(a);
    }
}

/* --- hand-shakes ------------------------------------------------------------------------------ */

static void compute(struct comm *c, int us)
{
    comm_work(c, &(struct work){.flop = (uint64_t)us * 1000});
}

/* One large message: its sender computes for 10 us and 10 us more, with or without a call in
 * between that takes no time; its receiver for 10 us. */
static void large(struct comm *c, void *context)
{
    const bool call = *(const bool *)context;
    struct comm_request r = {0}, other = {0};
    char data[LARGE] = {0}, small[8] = {0};
    if (comm_rank(c) == 1) {
        comm_irecv(c, 0, TAG, data, LARGE, &r);
        compute(c, 10);
        comm_wait(c, &r);
        comm_send(c, 0, TAG, small, 8);
        return;
    }
    comm_isend(c, 1, TAG, data, LARGE, &r);
    compute(c, 10);
    if (call) comm_irecv(c, 1, TAG, small, 8, &other);
    compute(c, 10);
    if (!call) comm_irecv(c, 1, TAG, small, 8, &other);
    comm_wait(c, &r);
    comm_wait(c, &other);
}

/* Sent at 2 + 1 us; the request is there at 3.4, the answer at 3.4 + 0.5 + 0.4 = 4.3, the data at
 * 4.3 + 0.4 + 0.999 = 5.699: long before the receiver waits, at 10, and pays 3 + 2 us. Its answer
 * of 8 B takes 2.008 us of it and is there 407 ns later; the other end has computed until 23 us and
 * pays 3.016. */
static void handshakes_go_on_while_ranks_compute(void **state)
{
    (void)state;
    const struct machine_spec m = pair(OFFLOAD_HANDSHAKES, 100);
    bool call = false;
    assert_ends(&m, large, &call, 23 * US + 3016000, 15 * US + 2008000);
}

/* The receiver answers at 10 us, the answer is there at 10.9. The sender sees it at the end of its
 * computing, at 13 or 23 us: data at 14.399 or 24.399, for 5 us of the receiver. Its own answer of
 * 2.008 us and 407 ns meets a rank that waits. */
static void without_an_engine_they_wait_for_the_end_of_computing(void **state)
{
    (void)state;
    const struct machine_spec m = pair(OFFLOAD_NONE, 100);
    for (int call = 0; call < 2; call++) {
        bool calls = call;
        const int64_t there = (call ? 13 : 23) * US + 1399000, second = there + 5 * US + 2008000;
        const int64_t busy = 23 * US, first = second + 407000 > busy ? second + 407000 : busy;
        assert_ends(&m, large, &calls, first + 3016000, second);
    }
}

/* Rank 0 is woken by the end of a large send, sends another one, computes for 10 us, and goes on
 * with many short pieces with calls in between before anything else happens. */
static void pieces(struct comm *c, void *context)
{
    struct comm_request r[2] = {{0}, {0}}, other[20] = {{0}};
    char data[2][LARGE] = {{0}}, small[8] = {0};
    (void)context;
    if (comm_rank(c) == 1) {
        for (int i = 0; i < 2; i++) comm_irecv(c, 0, TAG, data[i], LARGE, &r[i]);
        comm_waitall(c, 2, r);
        for (int i = 0; i < 20; i++) comm_send(c, 0, TAG, small, 8);
        return;
    }
    comm_isend(c, 1, TAG, data[0], LARGE, &r[0]);
    comm_wait(c, &r[0]);
    comm_isend(c, 1, TAG, data[1], LARGE, &r[1]);
    compute(c, 10);
    for (int i = 0; i < 20; i++) {
        comm_irecv(c, 1, TAG, small, 8, &other[i]);
        compute(c, 1);
    }
    comm_wait(c, &r[1]);
    comm_waitall(c, 20, other);
}

/* Software that takes no time: the first answer is there at 0.4 + 0.5 + 0.4 us. The second one
 * comes while rank 0 computes, until 11.3 us; its data are there 1.399 us later. What is kept of
 * that long piece must outlast twenty others. */
static void long_computing_is_not_forgotten(void **state)
{
    (void)state;
    struct machine_spec m = pair(OFFLOAD_NONE, 100);
    m.network.level = LEVEL_LINK;
    m.software.send_overhead = m.software.recv_overhead = 0;
    m.software.send_copy = m.software.recv_copy = 0;
    assert_ends(&m, pieces, NULL, 31300000, 12699000);
}

/* --- copies ----------------------------------------------------------------------------------- */

/* Its copy of 1 us is done before the answer to the request of 2 us comes, at 3.3: the data are
 * there at 4.699, copied at 6.699; the receiver pays 3 us from 10 on. */
static void an_engine_copies_during_the_handshake(void **state)
{
    (void)state;
    const struct machine_spec m = pair(OFFLOAD_COPIES, 100);
    bool call = false;
    assert_ends(&m, large, &call, 22 * US + 3 * US, 13 * US + 2 * US);
}

/* Two messages, one behind the other. */
static void two(struct comm *c, void *context)
{
    (void)context;
    char data[BIG] = {0};
    for (int i = 0; i < 2; i++) {
        if (comm_rank(c) == 0) comm_send(c, 1, TAG, data, BIG);
        else comm_recv(c, 0, TAG, data, BIG);
    }
}

/* 3 ns a byte sent. The processor is free at 4 us. The engine copies from 2 to 14 and from 14 to 26
 * us; the messages are there at 18.399 and 30.399 us, and copied 8 us later; 3 us of the receiver
 * each. Own copies keep the sender until 28 us, and the receiver for 11 us each. */
static void an_engine_makes_one_copy_after_the_other(void **state)
{
    (void)state;
    struct machine_spec engine = pair(OFFLOAD_COPIES, -1), none = pair(OFFLOAD_NONE, -1);
    engine.software.send_copy = none.software.send_copy = 3e-9;
    assert_ends(&engine, two, NULL, 4 * US, 38399000 + 3 * US);
    assert_ends(&none, two, NULL, 28 * US, 32399000 + 11 * US);
}

/* A copy of 10 us, from 2 to 12 us, is done long after the answer has come: the data are there at
 * 13.399 us, copied at 15.399, and received at 18.399. */
static void data_wait_for_their_copy(void **state)
{
    (void)state;
    struct machine_spec m = pair(OFFLOAD_COPIES, 100);
    bool call = false;
    m.software.send_copy = 10e-9;
    assert_ends(&m, large, &call, 22 * US + 3 * US, 18399000 + 2 * US);
}

static void a_kernel_makes_its_copies_itself(void **state)
{
    (void)state;
    struct machine_spec m = pair(OFFLOAD_COPIES, -1);
    struct run_result r;
    struct err e;
    struct arena *a = arena_create();
    const struct world_load load = {
        .nrank = 2, .program = two, .nstage = 1, .stage_name = stage_name, .largest_message = -1};
    m.software.kernel_server = true;
    err_clear(&e);
    assert_false(world_run(&m, &load, &(struct record_spec){0}, 1, a, &r, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    assert_non_null(strstr(e.text, "expected handshakes or none"));
    arena_destroy(a);
}

/* --- any program ------------------------------------------------------------------------------ */

enum { ROUNDS = 12, MOST = 4 };

/* What a rank does in one round: computes before, in the middle and behind; which rank each sends
 * to, how much. All ranks know all of it. */
struct plan {
    int nrank, before[ROUNDS][MOST], middle[ROUNDS][MOST], shift[ROUNDS];
    int64_t bytes[ROUNDS];
};

static void rounds(struct comm *c, void *context)
{
    const struct plan *p = context;
    static const char data[BIG];
    char in[BIG];
    for (int k = 0; k < ROUNDS; k++) {
        const int me = comm_rank(c), n = p->nrank;
        struct comm_request r[2] = {{0}, {0}};
        compute(c, p->before[k][me]);
        comm_irecv(c, (me + n - p->shift[k]) % n, k, in, p->bytes[k], &r[0]);
        comm_isend(c, (me + p->shift[k]) % n, k, data, p->bytes[k], &r[1]);
        compute(c, p->middle[k][me]);
        comm_waitall(c, 2, r);
    }
}

static struct plan drawn(struct random *r)
{
    struct plan p = {.nrank = 2 + (int)random_below(r, MOST - 1)};
    for (int k = 0; k < ROUNDS; k++) {
        p.shift[k] = 1 + (int)random_below(r, (uint64_t)p.nrank - 1);
        p.bytes[k] = (int64_t)random_below(r, BIG);
        for (int i = 0; i < p.nrank; i++) {
            p.before[k][i] = (int)random_below(r, 20);
            p.middle[k][i] = (int)random_below(r, 40);
        }
    }
    return p;
}

static int64_t time_with(enum offload offload, int64_t eager, bool copies, struct plan *p,
                         uint64_t *digest)
{
    struct arena *a = arena_create();
    struct machine_spec m = pair(offload, eager);
    if (!copies) m.software.send_copy = m.software.recv_copy = 0;
    const struct run_result r = go(&m, p->nrank, rounds, p, true, a);
    const int64_t time = r.makespan_ps;
    assert_whole(&r);
    *digest = r.digest;
    arena_destroy(a);
    return time;
}

/* Each rank sends to one and hears from one in a round: nobody overtakes, so waiting for the end of
 * computing never helps, and neither does a processor that copies. What has nothing to do is as if
 * it were not there, to the last event. */
static void engines_never_make_such_a_program_slower(void **state)
{
    (void)state;
    struct random r = random_make(5, 0, 0);
    int slower = 0, faster = 0;
    for (int k = 0; k < 300; k++) {
        struct plan p = drawn(&r);
        uint64_t by, none, engine;
        const int64_t usual = time_with(OFFLOAD_HANDSHAKES, 500, true, &p, &by);
        const int64_t alone = time_with(OFFLOAD_NONE, 500, true, &p, &none);
        const int64_t beside = time_with(OFFLOAD_COPIES, 500, true, &p, &engine);
        assert_true(alone >= usual && beside <= usual);
        slower += alone > usual;
        faster += beside < usual;
        time_with(OFFLOAD_HANDSHAKES, -1, true, &p, &by);
        time_with(OFFLOAD_NONE, -1, true, &p, &none);
        assert_int_equal(by, none);
        time_with(OFFLOAD_HANDSHAKES, 500, false, &p, &by);
        time_with(OFFLOAD_COPIES, 500, false, &p, &engine);
        assert_int_equal(by, engine);
    }
    assert_true(slower > 200 && faster > 200);
}

/* --- the end of time -------------------------------------------------------------------------- */

/* Five copies, none of which stands on the rank's own clock, of 46 days each. */
static void endless(struct comm *c, void *context)
{
    enum { MANY = 5, HUGE_BYTES = 4000000 };
    static char data[HUGE_BYTES];
    struct comm_request r[MANY] = {{0}};
    (void)context;
    for (int i = 0; i < MANY; i++)
        if (comm_rank(c) == 0) comm_isend(c, 1, TAG, data, HUGE_BYTES, &r[i]);
        else comm_irecv(c, 0, TAG, data, HUGE_BYTES, &r[i]);
    comm_waitall(c, MANY, r);
}

static void copies_that_never_end_fail_the_run(void **state)
{
    (void)state;
    for (int receiver = 0; receiver < 2; receiver++) {
        struct arena *a = arena_create();
        struct run_result r = {0};
        struct err e;
        err_clear(&e);
        struct machine_spec m = pair(OFFLOAD_COPIES, -1);
        if (receiver) m.software.recv_copy = 1;
        else m.software.send_copy = 1;
        const struct record_spec nothing = {0};
        const struct world_load load = {.nrank = 2,
                                        .program = endless,
                                        .nstage = 1,
                                        .stage_name = stage_name,
                                        .largest_message = -1};
        assert_true(world_run(&m, &load, &nothing, 1, a, &r, &e));
        assert_int_equal(r.status, RUN_FAILED);
        assert_non_null(strstr(r.text, "simulated time"));
        arena_destroy(a);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(handshakes_go_on_while_ranks_compute),
        cmocka_unit_test(without_an_engine_they_wait_for_the_end_of_computing),
        cmocka_unit_test(an_engine_copies_during_the_handshake),
        cmocka_unit_test(an_engine_makes_one_copy_after_the_other),
        cmocka_unit_test(data_wait_for_their_copy),
        cmocka_unit_test(long_computing_is_not_forgotten),
        cmocka_unit_test(a_kernel_makes_its_copies_itself),
        cmocka_unit_test(engines_never_make_such_a_program_slower),
        cmocka_unit_test(copies_that_never_end_fail_the_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
