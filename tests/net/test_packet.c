/* test_packet.c - virtual cut-through: hand cases, the reference router, refusals, deadlock,
 * accounts. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "net/traffic.h"
#include "study/netcheck_case.h"

#include "reference.h"

static const bool levels[LEVELS] = {[LEVEL_PACKET] = true};

static void hand_cases_are_exact(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct netcheck n;
    int exact = 0;
    ask(&n, levels, DATA "hand_cases.json", "cut-through", a);
    for (int i = 0; i < n.nrow; i++) {
        const struct netcheck_answer *x = &n.row[i].answer[LEVEL_PACKET];
        assert_true(x->ran && x->error == 0);
        if (n.row[i].name[0] == 'L') { /* derived for one FIFO per link; with two dateline classes
                                          one arrives earlier */
            assert_int_equal(x->differing, 1);
            continue;
        }
        if (x->differing > 0) fail_msg("%s differs", n.row[i].name);
        exact++;
    }
    assert_int_equal(exact, 12);
    arena_destroy(a);
}

/* message and buffer size [flits], from the name of a row */
static int flits_of(const char *name)
{
    const char *s = strstr(name, "S=");
    assert_non_null(s);
    return atoi(s + 2);
}

static int buffer_of(const char *name)
{
    const char *s = strstr(name, "B=");
    assert_non_null(s);
    return atoi(s + 2);
}

static void steps_whose_messages_fit_the_buffers(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct netcheck n;
    double sum = 0, worst = 0;
    int count = 0, single = 0;
    ask(&n, levels, DATA "makespan.json", NULL, a);
    for (int i = 0; i < n.nrow; i++) {
        const struct netcheck_row *row = &n.row[i];
        const struct netcheck_answer *x = &row->answer[LEVEL_PACKET];
        if (flits_of(row->name) > buffer_of(row->name)) continue;
        double error = x->error < 0 ? -x->error : x->error;
        assert_true(x->ran && !x->deadlock);
        sum += error;
        count++;
        if (error > worst) worst = error;
        if (!strstr(row->group, "vc=1")) continue;
        single++;
        if (x->differing > 0) fail_msg("%s: %d arrivals differ", row->name, x->differing);
    }
    assert_true(count >= 350 && single >= 180);
    assert_true(sum / count <= 0.001); /* required: 0.01 */
    assert_true(worst <= 0.07);        /* required: 0.16; arbitration of two classes on one link */
    arena_destroy(a);
}

static void collectives(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct netcheck n;
    double sum = 0, worst = 0;
    int torus = 0, single = 0;
    ask(&n, levels, DATA "collectives.json", NULL, a);
    for (int i = 0; i < n.nrow; i++) {
        const struct netcheck_row *row = &n.row[i];
        const struct netcheck_answer *x = &row->answer[LEVEL_PACKET];
        double error = x->error < 0 ? -x->error : x->error;
        if (!x->ran) { /* longer than the buffers, and not cut into packets */
            assert_non_null(strstr(x->why, "do not fit"));
            continue;
        }
        assert_false(x->deadlock);
        if (strstr(row->group, "torus")) {
            torus++;
            sum += error;
            if (error > worst) worst = error;
        } else {
            single++;
            assert_true(error <= 1e-9); /* required: 0.03 */
            assert_true(x->differing == 0);
        }
    }
    assert_true(torus >= 20 && single >= 10);
    assert_true(sum / torus <= 0.01); /* required: 0.06 */
    assert_true(worst <= 0.07);       /* required: 0.15 */
    arena_destroy(a);
}

static void steps_of_several_packets_lie_in_the_band(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct netcheck n;
    int count = 0;
    ask(&n, levels, DATA "makespan_sensitivity.json", "torus", a);
    for (int i = 0; i < n.nrow; i++) {
        const struct netcheck_row *row = &n.row[i];
        if (flits_of(row->name) > buffer_of(row->name) && buffer_of(row->name) != 22) continue;
        const struct netcheck_answer *x = &row->answer[LEVEL_PACKET];
        count++;
        if (x->found < 0.85 * row->low || x->found > 1.15 * row->high)
            fail_msg("%s: %g outside %g to %g", row->name, x->found, row->low, row->high);
    }
    assert_int_equal(count, 14);
    arena_destroy(a);
}

/* ---- one machine, lists made here ---- */

struct bench {
    struct arena *arena;
    struct topology_spec spec;
    struct machine_spec machine;
    struct topology *topology;
};

static void bench_open(struct bench *b, const char *topology, int vcs, int buffer)
{
    struct err e;
    err_clear(&e);
    b->arena = arena_create();
    assert_true(netcheck_topology(topology, 0, &b->spec, &e));
    b->machine = netcheck_machine(&b->spec, vcs, buffer, 0, 3);
    b->machine.network.level = LEVEL_PACKET;
    b->topology = topology_create(&b->machine.topology, b->arena, &e);
    assert_non_null(b->topology);
}

static void refused(struct bench *b, const char *key, const char *value)
{
    struct err e;
    struct traffic q = {0};
    struct traffic_result r = {0};
    err_clear(&e);
    assert_false(traffic_run(&q, &b->machine, b->topology, b->arena, false, &r, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    if (!strstr(e.text, key) || !strstr(e.text, value))
        fail_msg("'%s' names neither %s nor %s", e.text, key, value);
}

static void buffers_too_small_are_refused(void **state)
{
    (void)state;
    struct bench b;
    bench_open(&b, "mesh4x4", 1, 4);
    refused(&b, "network.buffer", "at least 5");
    b.machine.network.buffer_flits = 16;
    b.machine.network.packet_bytes = 17 * 16;
    refused(&b, "network.packet", "buffer >= 17");
    b.machine.network.packet_bytes = 16 * 16;
    b.machine.network.header_bytes = 8;
    refused(&b, "network.header", "packet <= 248");
    b.machine.network.header_bytes = 0;
    b.machine.network.virtual_channels = 0;
    refused(&b, "network.virtual_channels", "1 to");
    b.machine.network.virtual_channels = 1;
    b.machine.network.flit_bytes = 0;
    refused(&b, "network.flit", "at least 1 B");
    arena_destroy(b.arena);
}

/* every node of a ring of four sends two hops on: L with one FIFO per link, 3S + 4; with buffers of
 * one message the FIFOs fill in a circle */
static void a_ring_without_classes(void **state)
{
    (void)state;
    int src[4] = {0, 1, 2, 3}, dst[4] = {2, 3, 0, 1};
    int64_t bytes[4] = {288, 288, 288, 288};
    sim_ps time[4] = {0}, arrival[4];
    struct traffic q = {.nmessage = 4, .src = src, .dst = dst, .bytes = bytes, .time = time};
    struct traffic_result r = {.arrival = arrival};
    struct bench b;
    struct err e;
    err_clear(&e);
    bench_open(&b, "ring4", 1, 64);
    assert_true(traffic_run(&q, &b.machine, b.topology, b.arena, false, &r, &e));
    assert_false(r.deadlock);
    for (int m = 0; m < 4; m++) assert_int_equal(arrival[m], 58000);
    b.machine.network.buffer_flits = 18;
    r = (struct traffic_result){.arrival = arrival};
    assert_true(traffic_run(&q, &b.machine, b.topology, b.arena, false, &r, &e));
    assert_true(r.deadlock);
    assert_int_equal(r.arrived, 0);
    for (int l = 0; l < 4; l++) {
        char name[32];
        snprintf(name, sizeof name, "router %d to %d", l, (l + 1) % 4);
        if (!strstr(r.text, name)) fail_msg("'%s' does not name %s", r.text, name);
    }
    arena_destroy(b.arena);
}

/* A message of 40 flits on buffers of 16 is 16 + 16 + 8, back to back: alone as fast as in one
 * piece, and the message behind it on the same way waits for its last flit. */
static void long_messages_travel_in_pieces(void **state)
{
    (void)state;
    int src[2] = {0, 0}, dst[2] = {5, 3};
    int64_t bytes[2] = {640, 64};
    sim_ps time[2] = {0}, arrival[2], uncontended[2];
    struct traffic q = {.nmessage = 2, .src = src, .dst = dst, .bytes = bytes, .time = time};
    struct traffic_result r = {.arrival = arrival, .uncontended = uncontended};
    struct bench b;
    struct err e;
    err_clear(&e);
    bench_open(&b, "mesh1x8", 1, 16);
    assert_true(traffic_run(&q, &b.machine, b.topology, b.arena, true, &r, &e));
    assert_int_equal(arrival[0], (6 * 3 + 2 + 39) * 1000);
    assert_int_equal(arrival[1], (40 + 4 * 3 + 2 + 3) * 1000);
    assert_int_equal(uncontended[0], arrival[0]);
    assert_int_equal(uncontended[1], arrival[1]);
    assert_int_equal(r.link[0].messages, 2);
    assert_int_equal(r.link[0].busy_ps, 44000);
    assert_int_equal(r.link[0].queue_ps, 40000);
    arena_destroy(b.arena);
}

/* Case B, the second message 10 B short of 18 flits: what each resource did, by hand. */
static void loads_by_hand(void **state)
{
    (void)state;
    int src[2] = {0, 1}, dst[2] = {3, 3};
    int64_t bytes[2] = {288, 278};
    sim_ps time[2] = {0}, uncontended[2], injected[2];
    struct traffic q = {.nmessage = 2, .src = src, .dst = dst, .bytes = bytes, .time = time};
    struct traffic_result r = {.uncontended = uncontended, .injected = injected};
    struct bench b;
    struct err e;
    err_clear(&e);
    bench_open(&b, "mesh1x8", 1, 64);
    assert_true(traffic_run(&q, &b.machine, b.topology, b.arena, true, &r, &e));
    assert_int_equal(uncontended[0], 31000);
    assert_int_equal(uncontended[1], 28000);
    assert_int_equal(injected[0] + injected[1], 0);
    int shared = 0;
    for (int i = 0; i < r.nlink; i++) {
        const struct link_load *l = &r.link[i];
        assert_int_equal(l->busy_ps, l->messages * 18000);
        if (l->messages != 2) continue;
        shared++;
        assert_int_equal(l->bytes, 566);
        assert_int_equal(l->queue_ps, l->from == 1 ? 15000 : 0);
    }
    assert_int_equal(shared, 3);
    arena_destroy(b.arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hand_cases_are_exact),
        cmocka_unit_test(steps_whose_messages_fit_the_buffers),
        cmocka_unit_test(collectives),
        cmocka_unit_test(steps_of_several_packets_lie_in_the_band),
        cmocka_unit_test(buffers_too_small_are_refused),
        cmocka_unit_test(a_ring_without_classes),
        cmocka_unit_test(long_messages_travel_in_pieces),
        cmocka_unit_test(loads_by_hand),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
