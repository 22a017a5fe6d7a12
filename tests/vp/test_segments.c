/* test_segments.c - message software by size: every segment's times by hand, at every level the
 * same. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "vp/world.h"

enum { TAU = 50000, END = 300000, FLIT = 8 }; /* [ps], [ps], [B] */

static const char *const stage_name[] = {"all"};

/* A line of four nodes, 1 ns a byte, every level possible. */
static struct machine_spec line_of_nodes(enum network_level level)
{
    struct machine_spec m = {.name = "test"};
    m.topology = (struct topology_spec){
        .family = TOPOLOGY_MESH, .ndim = 1, .dims = {4}, .nodes_per_router = 1,
        .processors_per_node = 1};
    m.node = (struct node_spec){.flop_rate = 1e9, .clock = 1e9, .copy_bandwidth = 1e9};
    m.network = (struct network_spec){.level = level,
                                      .link_bandwidth = 1e9,
                                      .hop_latency = TAU * 1e-12,
                                      .end_latency = END * 1e-12,
                                      .flit_bytes = FLIT,
                                      .virtual_channels = 1,
                                      .buffer_flits = 64};
    m.software = (struct software_spec){
        .send_overhead = 1e-6, .recv_overhead = 2e-6, .gap = 3e-6, .eager_bytes = -1};
    return m;
}

static const struct software_segment nothing = {.send_overhead = -1,
                                                .send_copy = -1,
                                                .recv_overhead = -1,
                                                .recv_copy = -1,
                                                .latency = -1,
                                                .gap = -1,
                                                .gap_per_byte = -1,
                                                .rendezvous_latency = -1};

/* Up to 999 B constant; then copies, 600 ns more of the interfaces, and 2 ns a byte at the port;
 * from 8000 B hand-shakes; from 16000 B the sender is held and the copies are gone. */
static void four_segments(struct software_spec *s)
{
    s->nsegment = 4;
    for (int i = 0; i < 4; i++) s->segment[i] = nothing;
    s->segment[1].from = 1000;
    s->segment[1].send_copy = 1e-9;
    s->segment[1].recv_copy = 2e-9;
    s->segment[1].gap_per_byte = 2e-9;
    s->segment[1].gap = 7e-6;
    s->segment[1].latency = 600e-9;
    s->segment[2] = s->segment[1];
    s->segment[2].from = 8000;
    s->segment[2].protocol = PROTOCOL_RENDEZVOUS;
    s->segment[2].rendezvous_latency = 4e-6;
    s->segment[3].from = 16000;
    s->segment[3].recv_overhead = 5e-6;
    s->segment[3].protocol = PROTOCOL_SYNCHRONOUS;
}

struct outcome {
    struct arena *arena;
    struct run_result r;
};

static struct outcome go(const struct machine_spec *m, int nrank, world_program *program,
                         void *context)
{
    struct outcome o = {.arena = arena_create()};
    struct record_spec record = {0};
    struct err e;
    err_clear(&e);
    struct world_load load = {.nrank = nrank, .program = program, .context = context, .nstage = 1,
                              .stage_name = stage_name, .largest_message = -1};
    if (!world_run(m, &load, &record, 1, o.arena, &o.r, &e)) fail_msg("%s", e.text);
    assert_int_equal(o.r.status, RUN_OK);
    return o;
}

static char data[1 << 16];

static void one_message(struct comm *c, void *context)
{
    const int64_t bytes = *(const int64_t *)context;
    if (comm_rank(c) == 0) {
        struct comm_request r = {0};
        comm_isend(c, 1, 7, data, bytes, &r);
        comm_wait(c, &r);
    } else if (comm_rank(c) == 1) {
        static char in[1 << 16];
        comm_recv(c, 0, 7, in, bytes);
    }
}

/* Two resources to the neighbour; all flits but the first at `flit` ps each, which is 16 ns where
 * the interfaces take longer too. */
static int64_t wire(int64_t bytes, int64_t flit)
{
    const int64_t latency = flit == 16000 ? 600000 : 0;
    const int64_t flits = bytes > 0 ? (bytes + FLIT - 1) / FLIT : 1;
    return 2 * TAU + (flits - 1) * flit + END + latency;
}

/* When the sender goes on and when the receiver has its message [ps]. */
static void by_hand(int64_t bytes, int64_t *sender, int64_t *receiver)
{
    const int64_t zero = wire(0, 8000);
    if (bytes < 1000) {
        *sender = 1000000;
        *receiver = *sender + wire(bytes, 8000) + 2000000;
    } else if (bytes < 8000) {
        *sender = 1000000 + 1000 * bytes;
        *receiver = *sender + wire(bytes, 16000) + 2000000 + 2000 * bytes;
    } else if (bytes < 16000) {
        *sender = 1000000 + 1000 * bytes + zero + 4000000 + zero; /* request, 4 us, clearance */
        /* the request has the port for its own segment's gap of 3 us, which is over by then */
        *receiver = *sender + wire(bytes, 16000) + 2000000 + 2000 * bytes;
    } else {
        *sender = 1000000 + zero + zero;
        /* the gap after the request */
        if (*sender < 1000000 + 3000000) *sender = 1000000 + 3000000;
        *sender += wire(bytes, 8000);
        *receiver = *sender + 5000000;
    }
}

static void every_segment_takes_its_own_time_at_every_level(void **state)
{
    (void)state;
    static const int64_t sizes[] = {0,    1,    8,     999,   1000,  1001, 7999,
                                    8000, 8001, 15999, 16000, 16001, 40000};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int level = LEVEL_LOGGP; level <= LEVEL_AUTO; level++) {
            struct machine_spec m = line_of_nodes((enum network_level)level);
            four_segments(&m.software);
            int64_t bytes = sizes[i], sender, receiver;
            struct outcome o = go(&m, 2, one_message, &bytes);
            by_hand(bytes, &sender, &receiver);
            if (o.r.finish_ps[0] != sender || o.r.finish_ps[1] != receiver)
                fail_msg("level %d, %lld B: %lld and %lld, not %lld and %lld", level,
                         (long long)bytes, (long long)o.r.finish_ps[0], (long long)o.r.finish_ps[1],
                         (long long)sender, (long long)receiver);
            const struct stage_time *s = &o.r.stage[0];
            assert_int_equal(s->contention_ps, 0);
            /* held by its software, not waiting */
            if (bytes >= 16000) assert_int_equal(s->send_ps, sender);
            assert_int_equal(o.r.stage[o.r.nstage].contention_ps, 0);
            arena_destroy(o.arena);
        }
}

static void two_messages(struct comm *c, void *context)
{
    const int64_t *bytes = context;
    for (int k = 0; k < 2; k++) {
        if (comm_rank(c) == 0) comm_send(c, 1, k, data, bytes[k]);
        static char in[1 << 16];
        if (comm_rank(c) == 1) comm_recv(c, 0, k, in, bytes[k]);
    }
}

/* The port is taken by the first message as its own segment says: its flits at its own rate, and
 * its own gap after the last one begins. What one waits for one's own message is no contention. */
static void a_gap_is_that_of_the_message_before_it(void **state)
{
    (void)state;
    for (int order = 0; order < 2; order++)
        for (int level = LEVEL_LOGGP; level <= LEVEL_AUTO; level++) {
            struct machine_spec m = line_of_nodes((enum network_level)level);
            four_segments(&m.software);
            int64_t bytes[2] = {order ? 1600 : 0, order ? 0 : 1600};
            struct outcome o = go(&m, 2, two_messages, bytes);
            int64_t first = 1000000 + (order ? 1600000 : 0),
                    second = first + 1000000 + (order ? 0 : 1600000);
            int64_t port = first + (order ? 199 * 16000 + 7000000 : 3000000),
                    at = second > port ? second : port;
            int64_t arrived = at + (order ? wire(0, 8000) : wire(1600, 16000));
            int64_t before =
                first + wire(bytes[0], order ? 16000 : 8000) + 2000000 + (order ? 3200000 : 0);
            int64_t end = (arrived > before ? arrived : before) + 2000000 + (order ? 0 : 3200000);
            assert_int_equal(o.r.finish_ps[1], end);
            assert_int_equal(o.r.stage[o.r.nstage].contention_ps, 0);
            arena_destroy(o.arena);
        }
}

static void chatter(struct comm *c, void *context)
{
    (void)context;
    static char in[1 << 16];
    struct random r = random_make(3, 0, 0);
    for (int k = 0; k < 60; k++) {
        const int a = (int)random_below(&r, 4), b = (a + 1 + (int)random_below(&r, 3)) % 4;
        const int64_t bytes = (int64_t)random_below(&r, 3000);
        if (comm_rank(c) == a) comm_send(c, b, k, data, bytes);
        if (comm_rank(c) == b) comm_recv(c, a, k, in, bytes);
    }
}

static uint64_t digest_of(const struct machine_spec *m)
{
    struct outcome o = go(m, 4, chatter, NULL);
    uint64_t digest = o.r.digest;
    arena_destroy(o.arena);
    return digest;
}

/* One segment that gives nothing is the machine without segments; short, eager and rendezvous
 * messages are segments. */
static void segments_say_what_the_limits_say(void **state)
{
    (void)state;
    for (int level = LEVEL_LOGGP; level <= LEVEL_AUTO; level++) {
        struct machine_spec plain = line_of_nodes((enum network_level)level), listed = plain;
        plain.software.send_copy = listed.software.send_copy = 0.7e-9;
        listed.software.nsegment = 1;
        listed.software.segment[0] = nothing;
        assert_true(digest_of(&plain) == digest_of(&listed));

        plain.software.short_bytes = 200;
        plain.software.short_saving = 0.4e-6;
        plain.software.short_copy = 3e-9;
        plain.software.eager_bytes = 1500;
        plain.software.eager_copy = 2e-9;
        plain.software.rendezvous_latency = 1e-6;
        struct software_segment *s = listed.software.segment;
        listed.software.nsegment = 3;
        s[0] = s[1] = s[2] = nothing;
        s[0].send_overhead = 0.6e-6;
        s[0].recv_copy = 3e-9;
        s[1].from = 201;
        s[1].recv_copy = 2e-9;
        s[2].from = 1501;
        s[2].protocol = PROTOCOL_RENDEZVOUS;
        s[2].rendezvous_latency = 1e-6;
        assert_true(digest_of(&plain) == digest_of(&listed));
        s[1].from = 400;
        assert_true(digest_of(&plain) != digest_of(&listed));
    }
}

static void limits_become_segments(void **state)
{
    (void)state;
    struct software_spec s = {.send_overhead = 1e-6, .eager_bytes = -1};
    struct software_segment list[SOFTWARE_MAX_SEGMENTS];
    assert_int_equal(software_segments(&s, list), 1);
    assert_true(software_eager_most(&s) == INT64_MAX);
    s.eager_bytes = 4096;
    s.short_bytes = 4096;
    assert_int_equal(software_segments(&s, list), 2);
    assert_int_equal(list[1].from, 4097);
    assert_int_equal(software_eager_most(&s), 4096);
    s.short_bytes = 128;
    s.eager_bytes = 0;
    assert_int_equal(software_segments(&s, list), 3);
    assert_int_equal(list[1].from, 1);
    assert_int_equal(list[2].from, 129);
    assert_int_equal(software_eager_most(&s), 0);
    assert_ptr_equal(software_segment_of(list, 3, 128), &list[1]);
    assert_ptr_equal(software_segment_of(list, 3, 129), &list[2]);
    assert_ptr_equal(software_segment_of(list, 3, 0), &list[0]);
    four_segments(&s);
    assert_int_equal(software_segments(&s, list), 4);
    assert_true(list[3].send_overhead == 1e-6 && list[3].recv_copy == 0);
    assert_int_equal(software_eager_most(&s), 7999);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_segment_takes_its_own_time_at_every_level),
        cmocka_unit_test(a_gap_is_that_of_the_message_before_it),
        cmocka_unit_test(segments_say_what_the_limits_say),
        cmocka_unit_test(limits_become_segments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
