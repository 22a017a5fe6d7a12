/* bench_net.c - messages per second of the network levels: recursive doubling on large machines,
 * random loads beside the cycle-by-cycle router simulator BookSim 2.0.
 *
 *     bench_net [LIST...] [LEVEL...]    doubling load routed; loggp link packet flit auto
 *
 * All lists when none is named, all levels likewise.
 *
 * Seconds are of the processor, best of three; events include the one with which the replay starts
 * each message. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/arena.h"
#include "base/check.h"
#include "base/large_pages.h"
#include "net/traffic.h"
#include "study/netcheck.h"
#include "study/netcheck_case.h"

enum { FLITS = 20, BUFFER = 22, DELAY_PS = 20000, LOAD_CYCLES = 40000, BIG = 4096, REPEATS = 3 };

/* One list on one network. */
struct job {
    struct arena *arena;
    struct machine_spec machine;
    struct topology *topology;
    struct traffic q;
};

static void job_open(struct job *j, const char *topology, int vcs)
{
    struct topology_spec s;
    struct err e;
    err_clear(&e);
    *j = (struct job){.arena = arena_create()};
    CHECK(netcheck_topology(topology, 0, &s, &e));
    j->machine = netcheck_machine(&s, vcs, BUFFER, 0, 3);
    j->topology = topology_create(&j->machine.topology, j->arena, &e);
    CHECK(j->topology);
}

/* step j: i sends to i + 2^j mod N after its own send of the step before has arrived, and what it
 * then received */
static void doubling(struct job *j)
{
    int nnode = j->topology->nnode, steps = 0, ndep = 0;
    while (1 << steps < nnode) steps++;
    int n = nnode * steps;
    struct traffic *q = &j->q;
    struct arena *a = j->arena;
    *q = (struct traffic){.nmessage = n,
                          .src = TAKE(a, n, int),
                          .dst = TAKE(a, n, int),
                          .bytes = TAKE(a, n, int64_t),
                          .time = TAKE(a, n, sim_ps),
                          .delay = TAKE(a, n, sim_ps),
                          .dep_first = TAKE(a, n + 1, int),
                          .dep = TAKE(a, 2 * n, int)};
    for (int k = 0; k < n; k++) {
        int step = k / nnode, i = k % nnode, before = (step - 1) * nnode;
        q->src[k] = i;
        q->dst[k] = (i + (1 << step)) % nnode;
        q->bytes[k] = FLITS * NETCHECK_FLIT_BYTES;
        q->delay[k] = DELAY_PS;
        q->dep_first[k] = ndep;
        if (step == 0) continue;
        q->dep[ndep++] = before + i;
        q->dep[ndep++] = before + (i - (1 << (step - 1)) + nnode) % nnode;
    }
    q->dep_first[n] = ndep;
}

static double cpu_seconds(void) { return (double)clock() / CLOCKS_PER_SEC; }

/* bytes per node of a network in which nothing has moved yet */
static double idle_bytes(const struct job *j)
{
    struct err e;
    struct arena *a = arena_create();
    struct sim *s = sim_create();
    err_clear(&e);
    double bytes = net_create(&j->machine, j->topology, s, a, NULL, NULL, false, &e)
                       ? (double)arena_peak(a)
                       : 0;
    sim_destroy(s);
    arena_destroy(a);
    return bytes / j->topology->nnode;
}

/* replay on a level, best of three, and print a line; booksim: its packets per second, 0: not
 * known */
static void measure(struct job *j, const char *what, enum network_level level, double booksim)
{
    struct traffic_result r = {0};
    double best = 1e9, n = j->q.nmessage;
    j->machine.network.level = level;
    printf("%-26s %-7s ", what, netcheck_level_name(level));
    for (int i = 0; i < REPEATS; i++) {
        struct arena *a = arena_create();
        struct err e;
        err_clear(&e);
        double begin = cpu_seconds();
        bool ok = traffic_run(&j->q, &j->machine, j->topology, a, false, &r, &e);
        double took = cpu_seconds() - begin;
        if (took < best) best = took;
        arena_destroy(a);
        if (ok) continue;
        printf("%s\n", e.text);
        return;
    }
    printf("%9.0f %10.0f %9.0f %9.2f %9.0f", n, n / best, best / n * 1e9, (double)r.events / n,
           idle_bytes(j));
    if (booksim > 0) printf(" %8.0f x", n / best / booksim);
    printf("\n");
    fflush(stdout);
}

static void bench_doubling(const bool *wanted)
{
    static const struct {
        const char *topology;
        int vcs;
    } networks[] = {
        {"torus8x4x4", 2}, {"torus32x32x16", 2}, {"mesh16x16", 1}, {"hcube7", 1}, {"hcube14", 1}};
    for (size_t i = 0; i < sizeof networks / sizeof *networks; i++) {
        struct job j;
        char what[64];
        job_open(&j, networks[i].topology, networks[i].vcs);
        doubling(&j);
        snprintf(what, sizeof what, "doubling %s", networks[i].topology);
        for (int l = 0; l < LEVELS; l++) {
            bool flit_by_flit = l == LEVEL_FLIT && networks[i].vcs > 1;
            if (wanted[l] && !(flit_by_flit && j.topology->nnode > BIG))
                measure(&j, what, (enum network_level)l, 0);
        }
        arena_destroy(j.arena);
    }
}

static void bench_loads(const bool *wanted)
{
    static const double loads[] = {0.001, 0.02, 0.1};
    static const struct {
        const char *topology;
        int vcs;
        double booksim[3]; /* 20-flit packets per second of one core at those loads */
    } networks[] = {{"mesh8x8", 1, {260, 3900, 7900}},
                    {"torus4x4x8", 2, {210, 3400, 7100}},
                    {"hcube7", 1, {90, 1500, 4000}},
                    {"mesh16x16", 1, {310, 2600, 3100}}};
    for (size_t i = 0; i < sizeof networks / sizeof *networks; i++)
        for (int k = 0; k < 3; k++) {
            struct job j;
            struct err e;
            char what[64];
            err_clear(&e);
            job_open(&j, networks[i].topology, networks[i].vcs);
            int cycles = k == 0 ? 20 * LOAD_CYCLES : LOAD_CYCLES;
            CHECK(netcheck_load("uniform", j.topology, FLITS, loads[k], cycles, 1, j.arena, &j.q,
                                &e));
            snprintf(what, sizeof what, "load %g %s", loads[k], networks[i].topology);
            for (int l = 0; l < LEVELS; l++)
                if (wanted[l]) measure(&j, what, (enum network_level)l, networks[i].booksim[k]);
            arena_destroy(j.arena);
        }
}

/* Series of BookSim at a load of 0.1, packets of 4 flits, on its router of four stages; two of 512
 * routers, the last one with hops as long as those of today's cables, which are no whole number of
 * flits. */
static const struct {
    struct topology_spec topology;
    enum routing_rule rule;
    const char *what, *pattern;
    int vcs, buffer;
    double booksim; /* packets per second of one core; 0: not measured */
    int cycles;     /* of the list; 0: LOAD_CYCLES */
    double hop;     /* [s]; 0: that of the router */
} series[] = {
    {{.family = TOPOLOGY_MESH, .ndim = 2, .dims = {8, 8}, .nodes_per_router = 1},
     ROUTING_ADAPTIVE_XY_YX,
     "mesh8x8 adaptive-xy-yx",
     "transpose",
     4,
     16,
     .booksim = 27000},
    {{.family = TOPOLOGY_TORUS, .ndim = 2, .dims = {8, 8}, .nodes_per_router = 1},
     ROUTING_BOOKSIM_MIN_ADAPT,
     "torus8x8 min-adapt",
     "tornado(8,2)",
     4,
     16,
     .booksim = 27000},
    {{.family = TOPOLOGY_HYPERX, .ndim = 2, .dims = {4, 4}, .nodes_per_router = 4},
     ROUTING_BOOKSIM_UGAL,
     "flatfly4x4c4 ugal",
     "tornado(8,2)",
     4,
     16,
     .booksim = 56000},
    {{.family = TOPOLOGY_FAT_TREE, .ndim = 2, .dims = {4, 3}, .nodes_per_router = 1},
     ROUTING_NCA,
     "fattree_k4_n3 nca",
     "uniform",
     4,
     16,
     .booksim = 34000},
    {{.family = TOPOLOGY_DRAGONFLY,
      .ndim = 4,
      .dims = {2, 4, 2, 0},
      .nodes_per_router = 1,
      .dim_latency = {9e-9, 99e-9}},
     ROUTING_BOOKSIM_UGAL,
     "dragonfly72 ugal",
     "uniform",
     3,
     256,
     .booksim = 41000},
    {{.family = TOPOLOGY_TORUS, .ndim = 3, .dims = {8, 8, 8}, .nodes_per_router = 1},
     ROUTING_BOOKSIM_DIM_ORDER,
     "torus8x8x8 dim-order",
     "uniform",
     4,
     16,
     .booksim = 14200,
     .cycles = LOAD_CYCLES / 4},
    {{.family = TOPOLOGY_TORUS, .ndim = 3, .dims = {8, 8, 8}, .nodes_per_router = 1},
     ROUTING_BOOKSIM_DIM_ORDER,
     "torus8x8x8 long hops",
     "uniform",
     8,
     256,
     .cycles = LOAD_CYCLES / 4,
     .hop = 117.2e-9},
};

static void bench_routed(const bool *wanted)
{
    enum { ROUTED_FLITS = 4, STAGES = 4 };
    for (size_t i = 0; i < sizeof series / sizeof *series; i++) {
        struct job j = {.arena = arena_create()};
        struct topology_spec s = series[i].topology;
        struct err e;
        err_clear(&e);
        s.processors_per_node = 1;
        s.tie = TIE_RANDOM;
        j.machine = netcheck_machine(&s, series[i].vcs, series[i].buffer, ROUTED_FLITS, STAGES);
        j.machine.network.routing = series[i].rule;
        j.machine.network.vc_allocator = ALLOCATOR_ISLIP;
        if (series[i].hop > 0) j.machine.network.hop_latency = series[i].hop;
        const int cycles = series[i].cycles > 0 ? series[i].cycles : LOAD_CYCLES;
        j.topology = topology_create(&j.machine.topology, j.arena, &e);
        CHECK(j.topology);
        CHECK(netcheck_load(series[i].pattern, j.topology, ROUTED_FLITS, 0.1, cycles, 1, j.arena,
                            &j.q, &e));
        for (int l = 0; l < LEVELS; l++)
            if (wanted[l]) measure(&j, series[i].what, (enum network_level)l, series[i].booksim);
        arena_destroy(j.arena);
    }
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*bench)(const bool *wanted);
    } list[] = {{"doubling", bench_doubling}, {"load", bench_loads}, {"routed", bench_routed}};
    enum { LISTS = sizeof list / sizeof *list };
    large_pages_for_heap(); /* as the program does */
    bool wanted[LEVELS] = {false}, listed[LISTS] = {false}, levels = false, lists = false;
    for (int i = 1; i < argc; i++) {
        bool known = false;
        for (int l = 0; l < LEVELS; l++)
            if (strcmp(argv[i], netcheck_level_name((enum network_level)l)) == 0)
                wanted[l] = levels = known = true;
        for (int k = 0; k < LISTS; k++)
            if (strcmp(argv[i], list[k].name) == 0) listed[k] = lists = known = true;
        if (known) continue;
        fprintf(stderr, "bench_net: %s: expected doubling, load, routed or a level\n", argv[i]);
        return 64;
    }
    printf("%-26s %-7s %9s %10s %9s %9s %9s %10s\n", "pattern", "level", "messages", "messages/s",
           "ns/mess.", "ev./mess.", "B/node", "BookSim");
    for (int l = 0; l < LEVELS; l++) wanted[l] = wanted[l] || !levels;
    for (int k = 0; k < LISTS; k++)
        if (listed[k] || !lists) list[k].bench(wanted);
    return 0;
}
