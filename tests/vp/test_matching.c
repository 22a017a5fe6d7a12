/* test_matching.c - Receives from any source, tests and probes: who takes what, and when. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "vp/world.h"

static const char *const stage_name[] = {"work"};

/* o_s 2 us + 1 ns/B, one resource of 100 ns, 300 ns at the ends, 1 B/ns behind the first byte, o_r
 * 3 us + 2 ns/B: a message of b bytes arrives 2400 ns + b ns + (b - 1) ns after its sender began.
 */
static struct machine_spec crossbar(int nodes)
{
    struct machine_spec m = {.name = "test"};
    m.topology = (struct topology_spec){.family = TOPOLOGY_CROSSBAR,
                                        .ndim = 1,
                                        .dims = {nodes},
                                        .nodes_per_router = 1,
                                        .processors_per_node = 1};
    m.node = (struct node_spec){.flop_rate = 1e9, .clock = 1e9, .copy_bandwidth = 1e9};
    m.network = (struct network_spec){.level = LEVEL_LOGGP,
                                      .link_bandwidth = 1e9,
                                      .hop_latency = 100e-9,
                                      .end_latency = 300e-9,
                                      .virtual_channels = 1};
    m.software = (struct software_spec){.send_overhead = 2e-6,
                                        .recv_overhead = 3e-6,
                                        .send_copy = 1e-9,
                                        .recv_copy = 2e-9,
                                        .eager_bytes = -1};
    return m;
}

static int64_t trip(int64_t bytes)
{
    return 2400000 + 1000 * bytes + 1000 * (bytes > 0 ? bytes - 1 : 0);
}
static int64_t receipt(int64_t bytes) { return 3000000 + 2000 * bytes; }

enum { US = 1000000 };

struct outcome {
    struct arena *arena;
    struct run_result r;
};

static struct outcome run_load(const struct machine_spec *m, struct world_load load)
{
    struct outcome o = {.arena = arena_create()};
    struct record_spec record = {.spans = false};
    struct err e;
    err_clear(&e);
    load.nstage = 1;
    load.stage_name = stage_name;
    load.largest_message = -1;
    if (!world_run(m, &load, &record, 1, o.arena, &o.r, &e)) fail_msg("%s", e.text);
    return o;
}

static struct outcome go(const struct machine_spec *m, int nrank, world_program *program,
                         void *context)
{
    return run_load(m, (struct world_load){.nrank = nrank,
                                           .program = program,
                                           .context = context,
                                           .timed = true,
                                           .foreign = true});
}

static void expect_ok(const struct outcome *o)
{
    if (o->r.status != RUN_OK) fail_msg("%s", o->r.text);
}

/* ---- by hand ---- */

/* Rank 1 sends at 5 us, rank 2 at 4 us; rank 0 asks at `context` us. */
struct two {
    int64_t ask_us;
    int source[2];
    int64_t tag[2], now[2];
};

static void two_senders(struct comm *c, void *context)
{
    struct two *t = context;
    char data[1000] = {0};
    if (comm_rank(c) > 0) {
        comm_elapse(c, (6 - comm_rank(c)) * US);
        data[999] = (char)comm_rank(c);
        comm_send(c, 0, 10 + comm_rank(c), data, 1000);
        return;
    }
    comm_elapse(c, t->ask_us * US);
    for (int i = 0; i < 2; i++) {
        struct comm_request r;
        comm_irecv_matching(c, COMM_ANY_SOURCE, 0, 0, data, 1000, &r);
        comm_wait(c, &r);
        t->source[i] = r.peer;
        t->tag[i] = r.tag;
        t->now[i] = comm_now_ps(c);
        assert_int_equal(data[999], r.peer);
        assert_int_equal(r.bytes, 1000);
        assert_false(r.truncated);
    }
}

static void the_first_to_arrive_is_received_first(void **state)
{
    (void)state;
    enum network_level level[] = {LEVEL_LOGGP, LEVEL_LINK};
    for (int k = 0; k < 4; k++) {
        struct machine_spec m = crossbar(3);
        m.network.level = level[k % 2];
        struct two t = {.ask_us = k < 2 ? 0 : 50};
        struct outcome o = go(&m, 3, two_senders, &t);
        expect_ok(&o);
        assert_int_equal(t.source[0], 2);
        assert_int_equal(t.source[1], 1);
        assert_int_equal(t.tag[0], 12);
        int64_t first = k < 2 ? 4 * US + trip(1000) : 50 * US;
        if (level[k % 2] == LEVEL_LINK)
            continue; /* the ejection port joins the messages differently */
        assert_int_equal(t.now[0], first + receipt(1000));
        assert_int_equal(t.now[1], first + 2 * receipt(1000));
        arena_destroy(o.arena);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_to_arrive_is_received_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
