/* test_arrivals.c - receivers that go on together have the results of receivers that go on at once,
 * as they do where a timeline is recorded. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <string.h>

#include "base/random.h"
#include "comm/collectives.h"
#include "vp/world.h"

#include "crossbar.h"

static const char *const stage_name[] = {"first", "second"};

static struct run_result go(const struct machine_spec *m, int nrank, world_program *program,
                            void *context, bool at_once, struct arena *a)
{
    struct run_result r = {0};
    const struct record_spec record = {.spans = at_once, .links = true};
    const struct world_load load = {.nrank = nrank,
                                    .program = program,
                                    .context = context,
                                    .nstage = 2,
                                    .stage_name = stage_name,
                                    .largest_message = -1};
    struct err e;
    err_clear(&e);
    if (!world_run(m, &load, &record, 1, a, &r, &e)) fail_msg("%s", e.text);
    return r;
}

/* Everything but the timeline, and what describes the host. Every rank goes on as often: each has
 * its turn before the next message is matched. */
static void same(const struct machine_spec *m, int nrank, world_program *program, void *context)
{
    struct arena *arena = arena_create();
    const struct run_result a = go(m, nrank, program, context, true, arena),
                            b = go(m, nrank, program, context, false, arena);
    assert_int_equal(a.status, b.status);
    assert_string_equal(a.text, b.text);
    assert_int_equal(a.digest, b.digest);
    assert_int_equal(a.events, b.events);
    assert_int_equal(a.ties, b.ties);
    assert_int_equal(a.makespan_ps, b.makespan_ps);
    assert_int_equal(a.messages, b.messages);
    /* A run that failed has no times. */
    assert_int_equal(!a.stage, !b.stage);
    if (a.stage)
        assert_memory_equal(a.stage, b.stage, (size_t)nrank * (size_t)a.nstage * sizeof *a.stage);
    assert_int_equal(!a.finish_ps, !b.finish_ps);
    if (a.finish_ps)
        assert_memory_equal(a.finish_ps, b.finish_ps, (size_t)nrank * sizeof *a.finish_ps);
    assert_int_equal(a.nlink, b.nlink);
    if (a.nlink) assert_memory_equal(a.link, b.link, (size_t)a.nlink * sizeof *a.link);
    assert_int_equal(a.switches, b.switches);
    arena_destroy(arena);
}

/* Neighbours at random distances, the same for all ranks; receives before and after the sends,
 * several with one tag, pieces of computing of any length, collectives in between. */
static void rounds(struct comm *c, void *context)
{
    const int rank = comm_rank(c), size = comm_size(c);
    struct random all = random_make(*(const uint64_t *)context, 1, 0),
                  own = random_make(*(const uint64_t *)context, 2, (uint64_t)rank);
    double out[64], in[4][64], sum = 0;
    for (int round = 0; round < 12; round++) {
        const int d = 1 + (int)random_below(&all, (uint64_t)(size - 1)), n = 1 + round % 4;
        const int to = (rank + d) % size, from = (rank - d + size) % size;
        const bool early = random_below(&all, 2);
        const int64_t bytes = 8 * (int64_t)random_below(&all, 65);
        struct comm_request r[4], s;
        comm_work(c, &(struct work){.flop = random_below(&own, 9000)});
        comm_stage(c, round % 2);
        for (int k = 0; k < 64; k++) out[k] = rank + 1000 * round + sum;
        for (int i = 0; early && i < n; i++) comm_irecv(c, from, 7, in[i], bytes, &r[i]);
        for (int i = 0; i < n; i++) {
            comm_isend(c, to, 7, out, bytes, &s);
            comm_wait(c, &s);
        }
        for (int i = 0; !early && i < n; i++) comm_irecv(c, from, 7, in[i], bytes, &r[i]);
        for (int i = n - 1; i >= 0; i--) comm_wait(c, &r[i]);
        /* What came goes on, so that a wrong match would show in later sums. */
        sum += bytes > 0 ? in[n - 1][0] : 1;
        if (round % 5 == 4) comm_barrier(c);
    }
}

static struct machine_spec torus(int nodes)
{
    struct machine_spec m = crossbar(nodes);
    m.topology.family = TOPOLOGY_TORUS;
    m.topology.ndim = 2;
    m.topology.dims[0] = 4;
    m.topology.dims[1] = nodes / 4;
    m.network.level = LEVEL_LINK;
    return m;
}

static void every_machine(world_program *program, void *context)
{
    for (int kind = 0; kind < 9; kind++) {
        struct machine_spec m = torus(48);
        int nrank = 48;
        if (kind == 1) m.network.end_latency = 0;
        if (kind == 2) m.network.end_latency = 20e-6;
        /* several heads at one place at one time: what is served first is seen in later times */
        if (kind == 3) m.software.send_overhead = m.software.recv_overhead = 0;
        if (kind == 4) m.software.barrier = BARRIER_HARDWARE;
        if (kind == 5) m.software.kernel_server = true, m.software.kernel_time = 1e-6;
        if (kind == 6) m.topology.processors_per_node = 2, nrank = 96;
        if (kind == 7) m.noise.compute_cv = 0.3;
        if (kind == 8) m.topology.tie = TIE_RANDOM, m.network.hop_latency = 0;
        same(&m, nrank, program, context);
    }
}

static void all_results_are_the_same(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 6; seed++) every_machine(rounds, &seed);
}

/* Rank 5 never sends what its neighbour waits for; the others get stuck one by one. */
static void one_forgets(struct comm *c, void *context)
{
    const int rank = comm_rank(c), size = comm_size(c);
    char b[64] = {0};
    (void)context;
    for (int round = 0; round < 20; round++) {
        if (rank != 5 || round < 3) comm_send(c, (rank + 1) % size, round, b, 64);
        comm_recv(c, (rank + size - 1) % size, round, b, 64);
    }
}

/* Computes longer and longer, until simulated time ends. */
static void too_long(struct comm *c, void *context)
{
    const int rank = comm_rank(c), size = comm_size(c);
    char b[64] = {0};
    (void)context;
    for (int round = 0; round < 70; round++) {
        comm_elapse(c, (INT64_C(1) << (round < 60 ? round : 60)) + rank);
        comm_send(c, (rank + 1) % size, round, b, 64);
        comm_recv(c, (rank + size - 1) % size, round, b, 64);
    }
}

static void ends_that_fail_have_the_same_words(void **state)
{
    (void)state;
    const struct machine_spec m = torus(48);
    same(&m, 48, one_forgets, NULL);
    same(&m, 48, too_long, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_results_are_the_same),
        cmocka_unit_test(ends_that_fail_have_the_same_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
