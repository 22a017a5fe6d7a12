/* test_threads.c - one run on several host threads: whatever their number and whatever delays them,
 * every number and every word is that of one thread. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "vp/world.h"

#include "crossbar.h"
#include "outcome.h"

enum { RANKS = 97 }; /* no multiple of anything: shares are of different sizes */

static const char *const stage_name[] = {"first", "second"};

static struct machine_spec noisy_crossbar(int nodes)
{
    struct machine_spec m = crossbar(nodes);
    m.software.barrier = BARRIER_HARDWARE;
    m.software.barrier_time = 1e-6;
    m.noise.compute_cv = 0.2;
    return m;
}

/* Of exchanges, for each rank: a rank that never ends frees nothing. */
enum { MOST = 3000 };

static struct outcome go(world_program *program, int nrank, int threads, uint64_t delays)
{
    struct outcome o = {.arena = arena_create()};
    const struct machine_spec m = noisy_crossbar(nrank);
    const struct record_spec record = {.links = true};
    struct err e;
    err_clear(&e);
    double *buffers = calloc((size_t)nrank * 2 * MOST, sizeof *buffers);
    assert_non_null(buffers);
    const struct world_load load = {.nrank = nrank,
                                    .program = program,
                                    .context = buffers,
                                    .nstage = 2,
                                    .stage_name = stage_name,
                                    .largest_message = -1,
                                    .threads = threads,
                                    .delays = delays};
    assert_null(world_alone(&m, &load, &record));
    if (!world_run(&m, &load, &record, 7, o.arena, &o.r, &e)) fail_msg("%s", e.text);
    free(buffers);
    return o;
}

/* The run on one thread against N threads, undisturbed and with delays of several seeds. */
static void every_number_of_threads(world_program *program, int nrank, enum run_status status)
{
    static const int threads[] = {2, 3, 8, 200};
    struct outcome one = go(program, nrank, 1, 0);
    assert_int_equal(one.r.status, status);
    for (size_t i = 0; i < sizeof threads / sizeof *threads; i++)
        for (uint64_t delays = 0; delays < 4; delays++) {
            struct outcome o = go(program, nrank, threads[i], delays);
            same(&one.r, &o.r);
            arena_destroy(o.arena);
        }
    arena_destroy(one.arena);
}

/* Exchanges at all distances, of sizes of all classes, several under way between the same two
 * ranks. */
static void exchanges(struct comm *c, void *context)
{
    const int rank = comm_rank(c), size = comm_size(c);
    struct random r = random_make(3, (uint64_t)rank, 0);
    double *out = (double *)context + (size_t)rank * 2 * MOST, *in = out + MOST;
    for (int step = 0; step < 12; step++) {
        const int d = 1 + (step * step * 7 + step) % (size - 1);
        const int to = (rank + d) % size, from = (rank - d + size) % size;
        const int64_t n = step % 4 == 3 ? MOST : 1 + step * 3;
        const struct work w = {.flop = (int64_t)random_below(&r, 4000), .div = 3};
        comm_stage(c, step > 5);
        comm_work(c, &w);
        for (int k = 0; k < 3; k++) {
            for (int64_t i = 0; i < n; i++) out[i] = rank * 1000.0 + step * 10 + k;
            comm_send(c, to, step, out, n * (int64_t)sizeof *out);
        }
        comm_send(c, rank, 1000 + step, out, 8); /* to itself */
        for (int k = 0; k < 3; k++) {
            comm_recv(c, from, step, in, n * (int64_t)sizeof *in);
            assert_true(in[0] == from * 1000.0 + step * 10 + k && in[n - 1] == in[0]);
        }
        comm_recv(c, rank, 1000 + step, in, 8);
    }
}

static void exchanges_are_the_same(void **state)
{
    (void)state;
    every_number_of_threads(exchanges, RANKS, RUN_OK);
    every_number_of_threads(exchanges, 2, RUN_OK);
}

/* Everybody waits for the slowest, again and again, with messages in between. */
static void barriers(struct comm *c, void *context)
{
    (void)context;
    const int rank = comm_rank(c), size = comm_size(c);
    for (int step = 0; step < 20; step++) {
        const struct work w = {.flop = (rank * 31 + step * 17) % 50 * 100};
        int32_t token = rank * 100 + step, other;
        comm_work(c, &w);
        comm_barrier(c);
        comm_send(c, (rank + step) % size, 5, &token, sizeof token);
        comm_recv(c, (rank + size * 20 - step) % size, 5, &other, sizeof other);
        assert_int_equal(other, (rank + size * 20 - step) % size * 100 + step);
    }
}

static void barriers_are_the_same(void **state)
{
    (void)state;
    every_number_of_threads(barriers, RANKS, RUN_OK);
}

/* One rank sends to all others for a long time before anybody answers: pools run empty at one side,
 * and many messages with one tag are under way to each, which must keep their order. */
static void one_way(struct comm *c, void *context)
{
    (void)context;
    int data[100] = {0};
    const int rank = comm_rank(c), size = comm_size(c);
    for (int k = 0; k < 60; k++)
        for (int to = 1; to < size; to++) {
            data[99] = k;
            if (rank == 0) comm_send(c, to, 5, data, sizeof data);
            else if (rank == to) comm_recv(c, 0, 5, data, sizeof data);
            assert_int_equal(data[99], k);
        }
    if (rank > 0) comm_send(c, 0, 99, data, rank);
    for (int from = 1; rank == 0 && from < size; from++) comm_recv(c, from, 99, data, from);
}

static void traffic_in_one_direction_is_the_same(void **state)
{
    (void)state;
    every_number_of_threads(one_way, RANKS, RUN_OK);
}

/* A ring of receives that nobody sends for, after traffic. */
static void stuck_ring(struct comm *c, void *context)
{
    char data[16];
    exchanges(c, context);
    const int rank = comm_rank(c), size = comm_size(c);
    if (rank % 3 == 0) comm_recv(c, (rank + 3) % size / 3 * 3, 42, data, sizeof data);
}

static void stuck_at_a_barrier(struct comm *c, void *context)
{
    char data[16];
    barriers(c, context);
    if (comm_rank(c) == 50) comm_recv(c, 51, 9, data, sizeof data);
    comm_barrier(c);
}

static void a_deadlock_is_explained_in_the_same_words(void **state)
{
    (void)state;
    every_number_of_threads(stuck_ring, RANKS, RUN_DEADLOCK);
    every_number_of_threads(stuck_at_a_barrier, RANKS, RUN_DEADLOCK);
}

/* Simulated time ends at several ranks. Which of them is told depends on the host (launch_run makes
 * such a run again); that the run has failed does not. */
static void too_long(struct comm *c, void *context)
{
    exchanges(c, context);
    if (comm_rank(c) % 10 == 4)
        for (int i = 0; i < 100; i++) comm_elapse(c, INT64_MAX);
    exchanges(c, context);
}

static void a_failure_is_a_failure(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 4; threads++) {
        struct outcome o = go(too_long, RANKS, threads, (uint64_t)threads);
        assert_int_equal(o.r.status, RUN_FAILED);
        assert_non_null(strstr(o.r.text, "simulated time ends at"));
        arena_destroy(o.arena);
    }
}

/* Each reason for the order of time. */
static void what_depends_on_order_says_so(void **state)
{
    (void)state;
    struct machine_spec m = noisy_crossbar(4), other;
    const struct record_spec nothing = {0}, spans = {.spans = true}, path = {.path = true};
    struct world_load load = {.nrank = 4,
                              .program = exchanges,
                              .nstage = 2,
                              .stage_name = stage_name,
                              .largest_message = -1,
                              .threads = 2},
                      changed;
    assert_null(world_ordered(&m, &load, &nothing));
    assert_null(world_alone(&m, &load, &nothing));
    assert_non_null(strstr(world_ordered(&m, &load, &spans), "timeline"));
    assert_non_null(strstr(world_ordered(&m, &load, &path), "critical path"));
    changed = load, changed.timed = true;
    assert_non_null(strstr(world_ordered(&m, &changed, &nothing), "anybody"));
    changed = load, changed.foreign = true;
    assert_non_null(strstr(world_ordered(&m, &changed, &nothing), "built-in"));
    other = m, other.network.level = LEVEL_LINK;
    assert_non_null(strstr(world_ordered(&other, &load, &nothing), "links"));
    other = m, other.topology.processors_per_node = 2;
    assert_non_null(strstr(world_ordered(&other, &load, &nothing), "port"));
    other = m, other.software.kernel_server = true;
    assert_non_null(strstr(world_ordered(&other, &load, &nothing), "server"));
    other = m, other.software.eager_bytes = 1000;
    assert_non_null(strstr(world_ordered(&other, &load, &nothing), "hands"));
    changed = load, changed.largest_message = 1000; /* none of its messages is large */
    assert_null(world_ordered(&other, &changed, &nothing));
    other = m, other.noise.background_load = 0.1;
    assert_non_null(strstr(world_ordered(&other, &load, &nothing), "traffic"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exchanges_are_the_same),
        cmocka_unit_test(barriers_are_the_same),
        cmocka_unit_test(traffic_in_one_direction_is_the_same),
        cmocka_unit_test(a_deadlock_is_explained_in_the_same_words),
        cmocka_unit_test(a_failure_is_a_failure),
        cmocka_unit_test(what_depends_on_order_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
