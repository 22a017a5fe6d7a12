/* test_windows.c - one run on several host threads by windows of simulated time: on any network,
 * whatever the ranks do, every number and every word is that of one thread. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <string.h>

#include "base/random.h"
#include "vp/windows.h"
#include "vp/world.h"

#include "crossbar.h"
#include "outcome.h"

static const char *const stage_name[] = {"first", "second"};

/* The thread sanitizer sees every access, and takes fifty times as long. */
#ifdef __SANITIZE_THREAD__
enum { DRAWS = 7 };
#else
enum { DRAWS = 42 };
#endif

/* What all ranks of a run do, and for how long. */
struct traffic {
    uint64_t seed;
    int steps;
    bool stuck; /* at its end a few wait for ever */
};

/* ---- what ranks do ---- */

enum { MOST = 700 };

/* Large messages shake hands on some machines: nobody waits for an answer before all is sent. */
static void send(struct comm *c, int to, int step, int64_t bytes, struct comm_request *r)
{
    char data[MOST];
    memset(data, (comm_rank(c) * 31 + step) & 0x7f, sizeof data);
    comm_isend(c, to, step, data, bytes, r);
}

static void receive(struct comm *c, int from, int step, int64_t bytes)
{
    char data[MOST] = {0};
    comm_recv(c, from, step, data, bytes);
    if (bytes > 0) assert_int_equal(data[bytes - 1], (from * 31 + step) & 0x7f);
}

/* To both sides at one distance, every second rank in the other order: so heads with the same
 * number meet at links, and only the order in which they set out decides. */
static void to_both_sides(struct comm *c, int distance, int step, int64_t bytes)
{
    const int rank = comm_rank(c), size = comm_size(c);
    const int up = (rank + distance) % size, down = (rank - distance + size) % size;
    const bool turned = rank % 2 == 1;
    struct comm_request one, other;
    send(c, turned ? down : up, step, bytes, &one);
    send(c, turned ? up : down, step, bytes, &other);
    receive(c, down, step, bytes);
    receive(c, up, step, bytes);
    comm_wait(c, &one);
    comm_wait(c, &other);
}

/* To a mirror image, to one rank and back, or nothing but a wait for all others. */
static void one_step(struct comm *c, struct random *r, int step)
{
    const int rank = comm_rank(c), size = comm_size(c);
    const int kind = (int)random_below(r, 5), at = (int)random_below(r, (uint64_t)size);
    const int64_t bytes = (int64_t)random_below(r, MOST);
    const int mirror = (at + size - rank) % size;
    struct comm_request s;
    switch (kind) {
    case 0:
        comm_barrier(c);
        break;
    case 1:
        send(c, mirror, step, bytes, &s);
        receive(c, mirror, step, bytes);
        comm_wait(c, &s);
        break;
    case 2:
        if (rank != at) {
            send(c, at, step, bytes, &s);
            comm_wait(c, &s);
        }
        for (int i = 0; rank == at && i < size; i++)
            if (i != at) receive(c, i, step, bytes);
        break;
    default:
        if (at > 0) to_both_sides(c, at, step, bytes);
    }
}

static void program(struct comm *c, void *context)
{
    const struct traffic *t = context;
    struct random common = random_make(t->seed, 1, 0);
    for (int step = 0; step < t->steps; step++) {
        const struct work w = {.flop = (int64_t)random_below(&common, 3000)};
        comm_stage(c, step > t->steps / 2);
        comm_work(c, &w);
        one_step(c, &common, step);
    }
    char data[8];
    if (t->stuck && comm_rank(c) % 3 == 0) comm_recv(c, 0, 999, data, 8);
    if (t->stuck) comm_barrier(c);
}

/* ---- on which machines ---- */

static const struct topology_spec topologies[] = {
    {.family = TOPOLOGY_TORUS, .ndim = 2, .dims = {12, 8}},
    {.family = TOPOLOGY_TORUS, .ndim = 3, .dims = {4, 3, 2}, .dim_latency = {0, 0, 200e-9}},
    {.family = TOPOLOGY_MESH, .ndim = 2, .dims = {7, 7}},
    {.family = TOPOLOGY_HYPERCUBE, .ndim = 1, .dims = {5}},
    {.family = TOPOLOGY_FAT_TREE, .ndim = 2, .dims = {3, 3}},
    {.family = TOPOLOGY_BUS, .ndim = 1, .dims = {23}},
    {.family = TOPOLOGY_CROSSBAR, .ndim = 1, .dims = {29}},
};
enum { TOPOLOGIES = sizeof topologies / sizeof *topologies };

/* Times that are often equal, so that ties are many; sometimes nothing at the ends, or in the
 * software, or on the wire. */
static struct machine_spec machine(uint64_t seed)
{
    struct random r = random_make(seed, 2, 0);
    struct machine_spec m = crossbar(1);
    m.topology = topologies[seed % TOPOLOGIES];
    m.topology.nodes_per_router = m.topology.family == TOPOLOGY_MESH ? 2 : 1;
    m.topology.processors_per_node = random_below(&r, 4) == 0 ? 2 : 1;
    m.network.level = random_below(&r, 5) == 0 ? LEVEL_LOGGP : LEVEL_LINK;
    m.network.link_bandwidth = random_below(&r, 2) == 0 ? 1e9 : 1e8;
    m.network.hop_latency = (double)random_below(&r, 3) * 50e-9;
    m.network.end_latency = (double)random_below(&r, 3) * 400e-9;
    if (random_below(&r, 3) == 0) m.software.recv_overhead = 1e-7;
    if (random_below(&r, 3) == 0) m.software.barrier = BARRIER_HARDWARE;
    m.software.barrier_time = (double)random_below(&r, 2) * 1e-6;
    if (random_below(&r, 3) == 0) m.noise.compute_cv = 0.2;
    /* The ends' latency alone then tells what can follow. */
    if (m.network.end_latency > 0 && random_below(&r, 2) == 0) {
        m.software.eager_bytes = 300;
        m.software.rendezvous_latency = (double)random_below(&r, 2) * 1e-6;
        if (random_below(&r, 2) == 0) m.software.offload = OFFLOAD_COPIES;
    }
    return m;
}

/* threads 0: one, where a timeline keeps every rank in the order of events. */
static struct outcome go(const struct machine_spec *m, struct traffic *t, int threads,
                         uint64_t delays)
{
    struct outcome o = {.arena = arena_create()};
    const struct record_spec record = {.links = true, .spans = threads == 0};
    struct err e;
    err_clear(&e);
    const struct world_load load = {.nrank = (int)machine_spec_processors(m),
                                    .program = program,
                                    .context = t,
                                    .nstage = 2,
                                    .stage_name = stage_name,
                                    .largest_message = -1,
                                    .threads = threads,
                                    .delays = delays};
    if (threads > 0) assert_null(world_alone(m, &load, &record));
    if (!world_run(m, &load, &record, 7, o.arena, &o.r, &e)) fail_msg("%s", e.text);
    return o;
}

static void any_number_of_threads(uint64_t seed, struct traffic *t, enum run_status status)
{
    const int threads[] = {1, 2, 3, 8, seed % 10 == 0 ? 200 : 4};
    const struct machine_spec m = machine(seed);
    struct outcome one = go(&m, t, 0, 0);
    assert_int_equal(one.r.status, status);
    for (size_t i = 0; i < sizeof threads / sizeof *threads; i++) {
        struct outcome many = go(&m, t, threads[i], (seed + i) % 3 == 0 ? seed + 1 : 0);
        same(&one.r, &many.r);
        arena_destroy(many.arena);
    }
    arena_destroy(one.arena);
}

static void any_traffic_on_any_network_is_the_same(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < DRAWS; seed++) {
        struct traffic t = {.seed = seed, .steps = 12};
        any_number_of_threads(seed, &t, RUN_OK);
    }
}

static void a_deadlock_is_explained_in_the_same_words(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < (DRAWS + 2) / 3; seed++) {
        struct traffic t = {.seed = seed, .steps = 4, .stuck = true};
        any_number_of_threads(seed, &t, RUN_DEADLOCK);
    }
}

/* ---- barriers ---- */

/* One after the other, with nothing in between, at the beginning, and while messages are under way
 * to ranks that wait for something else. */
static void barriers_only(struct comm *c, void *context)
{
    const int rank = comm_rank(c), size = comm_size(c);
    char data[64] = {0};
    (void)context;
    comm_barrier(c);
    comm_barrier(c);
    for (int step = 0; step < 30; step++) {
        comm_send(c, (rank + step) % size, step, data, sizeof data);
        if (step % 3 == 0) comm_barrier(c);
        comm_recv(c, (rank + size * 30 - step) % size, step, data, sizeof data);
        if (step % 7 == 0) comm_barrier(c);
        comm_barrier(c);
    }
}

static void barriers_are_the_same(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < DRAWS / 2; seed++) {
        struct machine_spec m = machine(seed);
        m.software.barrier = BARRIER_HARDWARE;
        struct outcome o[3];
        for (int k = 0; k < 3; k++) {
            struct err e;
            const struct record_spec record = {.links = true};
            const struct world_load load = {.nrank = (int)machine_spec_processors(&m),
                                            .program = barriers_only,
                                            .nstage = 2,
                                            .stage_name = stage_name,
                                            .largest_message = -1,
                                            .threads = k + 1};
            err_clear(&e);
            o[k] = (struct outcome){.arena = arena_create()};
            if (!world_run(&m, &load, &record, 7, o[k].arena, &o[k].r, &e)) fail_msg("%s", e.text);
            assert_int_equal(o[k].r.status, RUN_OK);
            same(&o[0].r, &o[k].r);
        }
        for (int k = 0; k < 3; k++) arena_destroy(o[k].arena);
    }
}

/* ---- when, and why not ---- */

/* Worked out by hand: o_s 2 us, o_r 3 us, 300 ns at the ends, 100 ns a hop. */
static void the_lookahead_is_what_a_message_takes_at_least(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(4);
    const struct world_load load = {.largest_message = -1};
    assert_int_equal(windows_lookahead(&m, &load), 5300000);
    m.network.level = LEVEL_LINK;
    assert_int_equal(windows_lookahead(&m, &load), 5400000);
    /* Processors that share a port begin with an event at the time when the message is ready. */
    m.topology.processors_per_node = 2;
    assert_int_equal(windows_lookahead(&m, &load), 5300000);
    /* Hand-shakes are answered by no processor. */
    m.software.eager_bytes = 1000;
    assert_int_equal(windows_lookahead(&m, &load), 300000);
    m.software.eager_bytes = -1;
    /* The cheapest kind of message counts. */
    m.software.short_bytes = 10;
    m.software.short_saving = 1.5e-6;
    assert_int_equal(windows_lookahead(&m, &load), 3800000);
}

static void what_windows_cannot_do_says_so(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(4), other;
    const struct record_spec nothing = {0}, spans = {.spans = true}, path = {.path = true};
    struct world_load load = {.nrank = 4, .largest_message = -1, .threads = 2}, changed;
    m.network.level = LEVEL_LINK;
    assert_non_null(world_ordered(&m, &load, &nothing));
    assert_null(world_alone(&m, &load, &nothing));
    assert_non_null(strstr(world_alone(&m, &load, &spans), "timeline"));
    assert_non_null(strstr(world_alone(&m, &load, &path), "critical path"));
    changed = load, changed.timed = true;
    assert_non_null(strstr(world_alone(&m, &changed, &nothing), "anybody"));
    changed = load, changed.foreign = true;
    assert_non_null(strstr(world_alone(&m, &changed, &nothing), "built-in"));
    other = m, other.network.level = LEVEL_PACKET;
    assert_non_null(strstr(world_alone(&other, &load, &nothing), "network.level"));
    other = m, other.software.eager_bytes = 1000;
    assert_null(world_alone(&other, &load, &nothing));
    other.software.offload = OFFLOAD_NONE;
    assert_non_null(strstr(world_alone(&other, &load, &nothing), "hands"));
    changed = load, changed.largest_message = 1000; /* none of its messages is large */
    assert_null(world_alone(&other, &changed, &nothing));
    other = m, other.software.nsegment = 1;
    other.software.segment[0] = (struct software_segment){.protocol = PROTOCOL_SYNCHRONOUS};
    assert_non_null(strstr(world_alone(&other, &load, &nothing), "hands"));
    other = m, other.topology.processors_per_node = 2;
    assert_null(world_alone(&other, &load, &nothing));
    other.software.shared_bandwidth = 1e9;
    assert_non_null(strstr(world_alone(&other, &load, &nothing), "memory"));
    other = m, other.software.kernel_server = true;
    assert_non_null(strstr(world_alone(&other, &load, &nothing), "server"));
    other = m, other.noise.background_load = 0.1;
    assert_non_null(strstr(world_alone(&other, &load, &nothing), "traffic"));
    other = m, other.network.routing = ROUTING_DETERMINISTIC + 1;
    assert_non_null(strstr(world_alone(&other, &load, &nothing), "routes"));
    /* No time, no window. */
    other = m, other.network.hop_latency = other.network.end_latency = 0;
    other.software.send_overhead = other.software.recv_overhead = 0;
    assert_non_null(strstr(world_alone(&other, &load, &nothing), "no time"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_traffic_on_any_network_is_the_same),
        cmocka_unit_test(a_deadlock_is_explained_in_the_same_words),
        cmocka_unit_test(barriers_are_the_same),
        cmocka_unit_test(the_lookahead_is_what_a_message_takes_at_least),
        cmocka_unit_test(what_windows_cannot_do_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
