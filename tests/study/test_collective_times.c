/* test_collective_times.c - collectives simulated at level loggp take what their closed forms say,
 * to the picosecond. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "kernel/micro_collective.h"
#include "run/run.h"

/* LogGP: o_s 2 us, o_r 3 us, L = 400 ns through the crossbar and 700 ns at the ends, G 1 ns a byte;
 * 1 ns a flop and a byte copied. */
enum { SEND = 2000000, RECEIVE = 3000000, WIRE = 1100000, BYTE = 1000, FLOP = 1000, COPY = 1000 };

static struct run_spec spec_of(const char *kernel, const char *algorithm, int P, int64_t bytes)
{
    struct run_spec s = {.nrank = P};
    struct machine_spec *m = &s.machine;
    strcpy(m->name, "loggp");
    m->topology = (struct topology_spec){
        .family = TOPOLOGY_CROSSBAR, .ndim = 1, .dims = {P}, .nodes_per_router = 1,
        .processors_per_node = 1};
    m->node = (struct node_spec){.flop_rate = 1e9, .clock = 1e9, .copy_bandwidth = 1e9};
    m->network = (struct network_spec){.level = LEVEL_LOGGP,
                                       .link_bandwidth = 1e9,
                                       .hop_latency = 400e-9,
                                       .end_latency = 700e-9,
                                       .flit_bytes = 1,
                                       .virtual_channels = 1,
                                       .buffer_flits = 64};
    m->software =
        (struct software_spec){.send_overhead = 2e-6, .recv_overhead = 3e-6, .eager_bytes = -1};
    strcpy(s.kernel.name, kernel);
    strcpy(s.kernel.algorithm, algorithm);
    s.kernel.repeat = 1;
    s.kernel.message_bytes = bytes;
    return s;
}

/* The time when all ranks are done [ps]. */
static int64_t simulated(const struct run_spec *s)
{
    struct arena *a = arena_create();
    struct run_result r;
    struct err e;
    err_clear(&e);
    if (!run_one(s, a, &r, &e)) fail_msg("%s", e.text);
    assert_int_equal(r.status, RUN_OK);
    int64_t ps = r.makespan_ps;
    arena_destroy(a);
    return ps;
}

static int64_t at_most_one_less(int64_t bytes) { return bytes > 0 ? bytes - 1 : 0; }
static int64_t message(int64_t bytes)
{
    return SEND + WIRE + RECEIVE + at_most_one_less(bytes) * BYTE;
}

static void is(const struct run_spec *s, int64_t wanted)
{
    int64_t found = simulated(s);
    if (found != wanted)
        fail_msg("%s by %s, P = %d, %lld bytes: %lld ps, not %lld", s->kernel.name,
                 s->kernel.algorithm, s->nrank, (long long)s->kernel.message_bytes,
                 (long long)found, (long long)wanted);
}

/* rounds (o_s + L + o_r) + (path - rounds) G, and what is computed on the path; all messages have
 * bytes or none has. */
static int64_t in_rounds(const struct run_spec *s, int64_t computed)
{
    struct err e = {0};
    struct collective_cost c;
    const struct collective_shape shape = micro_collective_shape(s);
    micro_collective_algorithm(s, &e)->cost(&shape, &c);
    assert_true(c.path >= 0);
    return c.rounds * (SEND + WIRE + RECEIVE) + (c.path ? c.path - c.rounds : 0) * BYTE + computed;
}

static int log2_of(int P)
{
    int d = 0;
    while (1 << d < P) d++;
    return d;
}

enum { BYTES = 8 * 3840 }; /* 3840 elements: a multiple of all P below */

static void broadcast(void **state)
{
    (void)state;
    for (int P = 2; P <= 64; P *= 2) {
        struct run_spec s = spec_of("broadcast", "binomial", P, BYTES);
        is(&s, log2_of(P) * message(BYTES)); /* ceil(log2 P) (L + 2 o + (k - 1) G) */
        s = spec_of("broadcast", "binomial", P, 0);
        is(&s, log2_of(P) * message(0));
        s = spec_of("broadcast", "scatter-allgather", P, BYTES);
        is(&s, in_rounds(&s, 0));
        s = spec_of("broadcast", "scatter-recursive-doubling", P, BYTES);
        is(&s, in_rounds(&s, 0));
    }
    for (int P = 2; P <= 17; P++) {
        struct run_spec s = spec_of("broadcast", "chain", P, BYTES);
        is(&s, (P - 1) * message(BYTES));
        s = spec_of("broadcast", "linear", P, BYTES); /* the root's port is busy k G with each */
        is(&s, (P - 2) * (int64_t)BYTES * BYTE + message(BYTES));
        s = spec_of("broadcast", "linear", P, 8);
        int64_t last = (P - 2) * SEND + message(8), root = (P - 1) * (int64_t)SEND;
        is(&s, last > root ? last : root);
    }
}

/* The same for those that combine; the elements of a rank's path, one flop each. */
static void reductions(void **state)
{
    (void)state;
    const int64_t count = BYTES / 8;
    for (int P = 2; P <= 32; P *= 2) {
        const int64_t whole = log2_of(P) * count * FLOP, parts = (count - count / P) * FLOP;
        struct run_spec s = spec_of("reduce", "binomial", P, BYTES);
        is(&s, in_rounds(&s, whole));
        s = spec_of("reduce", "rabenseifner", P, BYTES);
        is(&s, in_rounds(&s, parts));
        s = spec_of("allreduce", "recursive-doubling", P, BYTES);
        is(&s, in_rounds(&s, whole));
        s = spec_of("allreduce", "reduce-broadcast", P, BYTES);
        is(&s, in_rounds(&s, whole));
        s = spec_of("allreduce", "rabenseifner", P, BYTES);
        is(&s, in_rounds(&s, parts));
        s = spec_of("reduce-scatter", "recursive-halving", P, BYTES);
        is(&s, in_rounds(&s, (P - 1) * count * FLOP));
    }
    for (int P = 2; P <= 16; P++) {
        if (count % P) continue;
        struct run_spec s = spec_of("allreduce", "ring", P, BYTES);
        is(&s, in_rounds(&s, (count - count / P) * FLOP));
        s = spec_of("reduce-scatter", "ring", P, BYTES);
        is(&s, in_rounds(&s, (P - 1) * count * FLOP));
        s = spec_of("reduce-scatter", "pairwise", P, BYTES);
        is(&s, in_rounds(&s, (P - 1) * count * FLOP));
        s = spec_of("reduce", "chain", P, BYTES);
        is(&s, in_rounds(&s, (P - 1) * count * FLOP));
        s = spec_of("scan", "linear", P, BYTES);
        is(&s, in_rounds(&s, (P - 1) * count * FLOP));
    }
}

static void blocks(void **state)
{
    (void)state;
    enum { BLOCK = 4096 };
    for (int P = 2; P <= 32; P *= 2) {
        struct run_spec s = spec_of("gather", "binomial", P, BLOCK);
        is(&s, in_rounds(&s, (int64_t)P * BLOCK * COPY));
        s = spec_of("scatter", "binomial", P, BLOCK);
        is(&s, in_rounds(&s, (int64_t)P * BLOCK * COPY));
        s = spec_of("allgather", "recursive-doubling", P, BLOCK);
        is(&s, in_rounds(&s, 0));
        s = spec_of("alltoall", "xor", P, BLOCK);
        is(&s, in_rounds(&s, 0));
    }
    for (int P = 2; P <= 17; P++) {
        int64_t moves = 0;
        for (int d = 1; d < P; d++) moves += __builtin_popcount((unsigned)d);
        struct run_spec s = spec_of("allgather", "ring", P, BLOCK);
        is(&s, in_rounds(&s, 0));
        s = spec_of("allgather", "bruck", P, BLOCK);
        is(&s, in_rounds(&s, (int64_t)(P + 1) * BLOCK * COPY));
        s = spec_of("alltoall", "pairwise", P, BLOCK);
        is(&s, in_rounds(&s, 0));
        s = spec_of("alltoall", "bruck", P, BLOCK);
        is(&s, in_rounds(&s, (2 * P + 2 * moves) * BLOCK * COPY));
        s = spec_of("all-to-all", "", P, BLOCK); /* the whole machine, round by round */
        is(&s, (P - 1) * message(BLOCK));
        s = spec_of("gather", "linear", P, 8); /* the root's processor takes one after the other */
        is(&s, message(8) + (P - 2) * (int64_t)RECEIVE);
    }
}

static void barriers(void **state)
{
    (void)state;
    for (int P = 2; P <= 33; P++) {
        struct run_spec s = spec_of("message-barrier", "dissemination", P, 0);
        is(&s, log2_of(P) * message(0));
        s = spec_of("barrier", "", P, 0);
        is(&s, log2_of(P) * message(0));
    }
    for (int P = 2; P <= 32; P *= 2) {
        struct run_spec s = spec_of("message-barrier", "recursive-doubling", P, 0);
        is(&s, log2_of(P) * message(0));
        s = spec_of("message-barrier", "binomial", P, 0);
        is(&s, 2 * log2_of(P) * message(0));
    }
}

/* Both neighbours: the second message follows the first out of the port, and its receiver takes
 * two. */
static void rings(void **state)
{
    (void)state;
    for (int P = 2; P <= 12; P++)
        for (int random = 0; random < 2; random++) {
            struct run_spec s = spec_of(random ? "random-ring" : "ring", "", P, 8192);
            is(&s, 2 * SEND + (8192 - (int64_t)SEND / BYTE) * BYTE + WIRE + 8191 * (int64_t)BYTE +
                       RECEIVE);
            s = spec_of(random ? "random-ring" : "ring", "", P, 8);
            /* the first is there before the second is sent */
            is(&s, 2 * (int64_t)SEND + 2 * (int64_t)RECEIVE);
            s.kernel.ring_ranks = 2;
            /* the first is there before the second is sent */
            is(&s, 2 * (int64_t)SEND + 2 * (int64_t)RECEIVE);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(broadcast), cmocka_unit_test(reductions), cmocka_unit_test(blocks),
        cmocka_unit_test(barriers),  cmocka_unit_test(rings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
