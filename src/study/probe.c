/* probe.c - published quantities measured on a simulated machine (probe.h).
 *
 * A machine file has parameters, and papers publish measurements. Here the measurement is
 * repeated on the simulated machine, by the benchmark that the paper used: a ping-pong, a flood,
 * an exchange. So a parameter that is right by itself, but has the wrong effect, shows up. */
#include "study/probe.h"

#include <math.h>
#include <string.h>

#include "base/arena.h"
#include "machine/node_use.h"
#include "machine/topology.h"
#include "run/run.h"
#include "study/probe_collective.h"
#include "study/rates.h"

/* Sizes and repetitions of the benchmarks: a small message [B], the length of a flood
 * [messages], the largest size tried for n-half [B], elements of a vector, bytes that a rank
 * exchanges in all. */
enum { SMALL_BYTES = 8, MEBIBYTE = 1 << 20, FLOOD = 64, LARGEST_SIZE = 1 << 22, VECTOR = 10000,
       EXCHANGE_BYTES = 1 << 17, SERVED_BYTES = 1 << 20 };

/* What one micro-benchmark tells. */
struct measured {
    double time, send, recv; /* of the kernel; of rank 0 per message [s] */
    double last_send;        /* of the last rank per message [s] */
};

/* More ranks than these are asked at the machine's own level alone. */
enum { FEW_RANKS = 64 };

static bool is_collective(enum probe_quantity q) { return q >= PROBE_BROADCAST && q < PROBE_B_EFF; }

/* Whether the network level matters for a quantity: only where more than two ranks talk. */
bool probe_contends(enum probe_quantity q, double at, int ranks)
{
    if (is_collective(q)) return ranks > 2 && ranks <= FEW_RANKS;
    return (q == PROBE_BARRIER || q == PROBE_EXCHANGE || q == PROBE_HALVES) && at > 2;
}

/* `kernel` with messages of `bytes` on `nrank` ranks. Two ranks are alone on the machine's
 * wires, so that all network levels agree there, and the cheapest one that knows of contention
 * is taken. */
static bool bench(const struct machine_spec *m, const char *kernel, int nrank, int64_t bytes,
                  int repeat, struct measured *out, struct err *e)
{
    struct run_spec spec = {.machine = *m, .nrank = nrank};
    struct run_result r;
    struct arena *a = arena_create();
    strncpy(spec.kernel.name, kernel, sizeof spec.kernel.name - 1);
    spec.kernel.message_bytes = bytes;
    spec.kernel.repeat = repeat;
    if (nrank <= 2) spec.machine.network.level = LEVEL_LINK;
    /* Noise belongs to a program's run, not to what a machine can do. */
    spec.machine.noise = (struct noise_spec){0};
    bool ok = run_one(&spec, a, &r, e);
    if (ok && r.status != RUN_OK) ok = err_set(e, ERR_CONFIG, "%s: %s", m->name, r.text);
    if (ok) {
        /* Rank 0 and the last rank: in "hot-spot" one receives and the other sends. A stage
         * without messages has no overhead per message. */
        const struct stage_time *s = &r.stage[0], *last = &r.stage[(nrank - 1) * r.nstage];
        double messages = s->messages > 0 ? (double)s->messages : 1;
        double of_last = last->messages > 0 ? (double)last->messages : 1;
        *out = (struct measured){r.measured_s, (double)s->send_ps * 1e-12 / messages,
                                 (double)s->recv_ps * 1e-12 / messages,
                                 (double)last->send_ps * 1e-12 / of_last};
    }
    arena_destroy(a);
    return ok;
}

/* One-way time [s] of a message: half of a ping-pong's round trip. */
static bool one_way(const struct machine_spec *m, int64_t bytes, double *t, struct err *e)
{
    struct measured x;
    if (!bench(m, "pingpong", 2, bytes, 1, &x, e)) return false;
    *t = x.time;
    return true;
}

/* r_inf (Hockney): the slope of the time between 4 and 8 MiB, where the start-up cancels. */
static bool asymptotic_rate(const struct machine_spec *m, double *rate, struct err *e)
{
    double t4, t8;
    if (!one_way(m, 4 * MEBIBYTE, &t4, e) || !one_way(m, 8 * MEBIBYTE, &t8, e)) return false;
    *rate = 4.0 * MEBIBYTE / (t8 - t4);
    return true;
}

/* n_half (Hockney): the size that reaches half of r_inf. Doubling finds an interval, halving the
 * size in it; the rate rises with the size, but for steps of the protocol. */
static bool half_rate_size(const struct machine_spec *m, double *size, struct err *e)
{
    double rate, t;
    int64_t low = 0, high = 1;
    if (!asymptotic_rate(m, &rate, e)) return false;
    for (;; low = high, high *= 2) {
        if (!one_way(m, high, &t, e)) return false;
        if ((double)high / t >= rate / 2 || high >= LARGEST_SIZE) break;
    }
    /* Invariant: `high` reaches half the rate, `low` does not. */
    while (high - low > 1) {
        int64_t middle = (low + high) / 2;
        if (!one_way(m, middle, &t, e)) return false;
        if ((double)middle / t >= rate / 2) high = middle;
        else low = middle;
    }
    *size = (double)high;
    return true;
}

/* The gap between messages. Rank 1 sends FLOOD messages to rank 0 without pause, then twice as
 * many: n messages take a + n g, which is a / n + g each; twice that of 2 n less that of n is g. */
static bool flood_gap(const struct machine_spec *m, double *gap, struct err *e)
{
    struct measured a, b;
    if (!bench(m, "hot-spot", 2, SMALL_BYTES, FLOOD, &a, e) ||
        !bench(m, "hot-spot", 2, SMALL_BYTES, 2 * FLOOD, &b, e))
        return false;
    /* `time` is per message: 2 b - a is the gap. */
    *gap = 2 * b.time - a.time;
    return true;
}

/* What one message costs its sender until the send is complete, held by a synchronous one: rank 1
 * sends and waits. */
static bool send_overhead(const struct machine_spec *m, int64_t bytes, double *value, struct err *e)
{
    struct measured x;
    if (!bench(m, "hot-spot", 2, bytes, 1, &x, e)) return false;
    *value = x.last_send;
    return true;
}

/* LogP's latency is what remains of the one-way time after both overheads. */
static bool overheads(const struct machine_spec *m, enum probe_quantity q, double at, double *value,
                      struct err *e)
{
    struct measured x;
    /* 0: the published overhead is of a short message */
    const int64_t bytes = at > 0 ? (int64_t)at : SMALL_BYTES;
    if (q == PROBE_SEND_OVERHEAD) return send_overhead(m, bytes, value, e);
    if (!bench(m, "pingpong", 2, bytes, 1, &x, e)) return false;
    *value = q == PROBE_RECV_OVERHEAD ? x.recv : x.time - x.send - x.recv;
    return true;
}

/* The first node that is `links` links away from node 0; -1 with *e set: none. */
static int node_at(const struct machine_spec *m, int links, struct err *e)
{
    struct arena *a = arena_create();
    const struct topology *t = topology_create(&m->topology, a, e);
    int found = -1;
    for (int i = 1; t && i < t->nnode && found < 0; i++)
        if (topology_distance(t, 0, i) == links) found = i;
    if (t && found < 0)
        err_set(e, ERR_CONFIG, "%s: no route of %d links from node 0", m->name, links);
    arena_destroy(a);
    return found;
}

/* The time of the wire alone: two ranks `links` links apart and software that takes no time. */
static bool wire(const struct machine_spec *m, int links, double *t, struct err *e)
{
    struct machine_spec bare = *m;
    /* By placement, since ranks 0 and 1 would lie on one node or on neighbours. */
    int list[2] = {0, node_at(m, links, e)};
    if (list[1] < 0) return false;
    /* Ranks are placed on processors: the first one of each node. */
    list[0] *= m->topology.processors_per_node;
    list[1] *= m->topology.processors_per_node;
    bare.software = (struct software_spec){.eager_bytes = -1};
    bare.placement = (struct placement_spec){.kind = PLACEMENT_LIST, .nlist = 2, .list = list};
    return one_way(&bare, 0, t, e);
}

/* One-sided transfer: only the caller's processor takes part, while interface and wire are those
 * of messages. A get needs a request of its own in the other direction. */
static bool one_sided(const struct machine_spec *m, enum probe_quantity q, int64_t bytes, double *t,
                      struct err *e)
{
    const struct software_spec *s = &m->software;
    const double overhead = q == PROBE_GET ? s->get_overhead : s->put_overhead;
    struct machine_spec bare = *m;
    double request = 0;
    /* A machine file without that overhead describes a machine without one-sided transfers. */
    if (!(overhead > 0))
        return err_set(e, ERR_CONFIG, "%s: software.%s.overhead is 0: no one-sided %s", m->name,
                       probe_name(q), probe_name(q));
    /* No message software but its gap per byte, which is the interface's. */
    bare.software = (struct software_spec){.eager_bytes = -1, .gap_per_byte = s->gap_per_byte};
    if (q == PROBE_GET && !one_way(&bare, 0, &request, e)) return false;
    if (!one_way(&bare, bytes, t, e)) return false;
    *t += overhead + request;
    return true;
}

/* A read waits for two messages; what the memories and hubs take is the caller's to add. No network
 * interface and no message software is in its way: the end's latency does not count. */
static bool remote_read(const struct machine_spec *m, int routers, double *t, struct err *e)
{
    /* Memory accesses go by hardware: the network interface's latency is not theirs. */
    struct machine_spec coherent = *m;
    coherent.network.end_latency = 0;
    if (!wire(&coherent, routers - 1, t, e)) return false;
    /* request and answer */
    *t *= 2;
    return true;
}

/* In which half of dimension d router r lies. Routers are numbered with dimension 0 fastest; of
 * a hypercube, dimension d is bit d. */
static bool upper_half(const struct topology_spec *s, int d, int r)
{
    if (s->family == TOPOLOGY_HYPERCUBE) return r >> d & 1;
    for (int k = 0; k < d; k++) r /= s->dims[k];
    return r % s->dims[d] >= s->dims[d] / 2;
}

/* Rate of all links, in both directions, that join the halves of dimension d [B/s]. */
static double cut_rate(const struct machine_spec *m, const struct topology *t, int d)
{
    double rate = 0;
    for (int l = 0; l < t->nlink; l++) {
        int from, to, port;
        topology_link_ends(t, l, &from, &to, &port);
        if (upper_half(t->spec, d, from) != upper_half(t->spec, d, to))
            rate += m->network.link_bandwidth *
                    topology_link_bandwidth(t, l, m->network.link_bandwidth);
    }
    return rate;
}

/* The bisection is the worst cut through the middle. An odd dimension has no two halves. */
static bool bisection_rate(const struct machine_spec *m, const struct topology *t, double *rate,
                           struct err *e)
{
    const struct topology_spec *s = t->spec;
    bool cube = s->family == TOPOLOGY_HYPERCUBE;
    if (!cube && s->family != TOPOLOGY_TORUS && s->family != TOPOLOGY_MESH)
        return err_set(e, ERR_CONFIG, "%s: halves are defined for torus, mesh and hypercube",
                       m->name);
    *rate = INFINITY;
    for (int d = 0; d < (cube ? s->dims[0] : s->ndim); d++) {
        if (!cube && s->dims[d] % 2) continue;
        *rate = fmin(*rate, cut_rate(m, t, d));
    }
    return isfinite(*rate) || err_set(e, ERR_CONFIG, "%s: no dimension can be halved", m->name);
}

/* Rate of a dragonfly's global links. topology_link_ends gives both directions; a published rate
 * counts one. A link is global when its routers are in different groups. */
static bool global_rate(const struct machine_spec *m, const struct topology *t, double *rate,
                        struct err *e)
{
    if (t->spec->family != TOPOLOGY_DRAGONFLY)
        return err_set(e, ERR_CONFIG, "%s: only a dragonfly has groups", m->name);
    *rate = 0;
    for (int l = 0; l < t->nlink; l++) {
        int from, to, port, group = t->spec->dims[1];
        topology_link_ends(t, l, &from, &to, &port);
        if (from / group != to / group)
            *rate += m->network.link_bandwidth *
                     topology_link_bandwidth(t, l, m->network.link_bandwidth) / 2;
    }
    return true;
}

static bool cut(const struct machine_spec *m, enum probe_quantity q, double *value, struct err *e)
{
    struct arena *a = arena_create();
    const struct topology *t = topology_create(&m->topology, a, e);
    bool ok =
        t && (q == PROBE_BISECTION ? bisection_rate(m, t, value, e) : global_rate(m, t, value, e));
    arena_destroy(a);
    return ok;
}

/* Four barriers in a row; the time of one. */
static bool barrier(const struct machine_spec *m, int ranks, double *t, struct err *e)
{
    struct measured x;
    if (!bench(m, "barrier", ranks, 0, 4, &x, e)) return false;
    *t = x.time;
    return true;
}

/* The rate at which each rank sends in a kernel where it has `partners`. The start-up cancels
 * between a length and twice that length. Behind a kernel's server copies hide while messages
 * wait for it, until they are long. */
static bool rate_among(const struct machine_spec *m, const char *kernel, int ranks, int partners,
                       double *rate, struct err *e)
{
    struct measured once, twice;
    if (ranks < 2) return err_set(e, ERR_CONFIG, "%s: an exchange of %d ranks", m->name, ranks);
    const int64_t all = m->software.kernel_server ? SERVED_BYTES : EXCHANGE_BYTES;
    /* The messages to all partners are `all` bytes together, in whole doubles. */
    const int64_t bytes = all / partners / SMALL_BYTES * SMALL_BYTES;
    if (!bench(m, kernel, ranks, bytes, 1, &once, e) ||
        !bench(m, kernel, ranks, 2 * bytes, 1, &twice, e))
        return false;
    *rate = (double)(bytes * partners) / (twice.time - once.time);
    return true;
}

bool probe_computes(enum probe_quantity q) { return q >= PROBE_LINPACK && q <= PROBE_MEMORY_COPY; }

/* What a code passes over on one processor [B]: the matrix of LINPACK, the vectors of an inner
 * product; those of STREAM are longer than any cache by its rule. */
static int64_t code_bytes(enum probe_quantity q, int n)
{
    if (q == PROBE_LINPACK) return 8 * (int64_t)n * n;
    return q == PROBE_INNER_PRODUCT ? 16 * (int64_t)n : INT64_MAX;
}

/* Each is executed with its operations and bytes counted (rates.h). */
static struct rate_count code_of(enum probe_quantity q, int n)
{
    if (q == PROBE_LINPACK) return rate_linpack(n);
    if (q == PROBE_INNER_PRODUCT) return rate_inner_product(n);
    if (q == PROBE_MEMORY_COPY) return rate_stream(RATE_COPY, n);
    return rate_stream((enum rate_stream)(q - PROBE_STREAM_COPY), n);
}

/* Serial codes. `at` is the order or the length of vectors, of STREAM how many processors run it at
 * once: as ranks are placed, so that those that share a memory do. */
static bool computing(const struct machine_spec *m, enum probe_quantity q, double at, double *rate,
                      struct err *e)
{
    const bool sized = q == PROBE_LINPACK || q == PROBE_INNER_PRODUCT;
    const int n = sized ? (int)at : VECTOR, processors = sized || at < 1 ? 1 : (int)at;
    struct node_use use;
    if (n < 1 || n > MEBIBYTE)
        return err_set(e, ERR_CONFIG, "%s: %s of %g elements", m->name, probe_name(q), at);
    if (processors > machine_spec_processors(m))
        return err_set(e, ERR_CONFIG, "%s: %s on %d of %lld processors", m->name, probe_name(q),
                       processors, (long long)machine_spec_processors(m));
    if (!node_use_make(m, processors, code_bytes(q, n), &use, e)) return false;
    const struct rate_count c = code_of(q, n);
    const struct node_cost cost = node_use_cost(&m->node, &use);
    /* STREAM counts a byte copied twice */
    *rate = rate_at(&cost, &c) * processors * (q == PROBE_MEMORY_COPY ? 0.5 : 1);
    return true;
}

/* One number per quantity; units: seconds, bytes, bytes or operations per second (probe.h). */
bool probe_measure(const struct machine_spec *m, enum probe_quantity q, double at, int ranks,
                   double *value, struct err *e)
{
    switch (q) {
    case PROBE_ONE_WAY:
        return one_way(m, (int64_t)at, value, e);
    case PROBE_ROUND_TRIP:
        if (!one_way(m, (int64_t)at, value, e)) return false;
        *value *= 2;
        return true;
    case PROBE_BANDWIDTH:
        if (!one_way(m, (int64_t)at, value, e)) return false;
        *value = at / *value;
        return true;
    case PROBE_R_INF:
        return asymptotic_rate(m, value, e);
    case PROBE_N_HALF:
        return half_rate_size(m, value, e);
    case PROBE_SEND_OVERHEAD:
    case PROBE_RECV_OVERHEAD:
    case PROBE_LATENCY:
        return overheads(m, q, at, value, e);
    case PROBE_GAP:
        return flood_gap(m, value, e);
    case PROBE_WIRE:
        return wire(m, (int)at, value, e);
    case PROBE_READ:
        return remote_read(m, (int)at, value, e);
    case PROBE_BISECTION:
    case PROBE_GLOBAL:
        return cut(m, q, value, e);
    case PROBE_BARRIER:
        return barrier(m, (int)at, value, e);
    case PROBE_EXCHANGE:
        return rate_among(m, "all-to-all", (int)at, (int)at - 1, value, e);
    case PROBE_HALVES:
        return rate_among(m, "bisection", (int)at, 1, value, e);
    case PROBE_LINPACK:
    case PROBE_STREAM_COPY:
    case PROBE_STREAM_SCALE:
    case PROBE_STREAM_ADD:
    case PROBE_STREAM_TRIAD:
    case PROBE_INNER_PRODUCT:
    case PROBE_MEMORY_COPY:
        return computing(m, q, at, value, e);
    case PROBE_PUT:
    case PROBE_GET:
        return one_sided(m, q, (int64_t)at, value, e);
    /* the quantities of many ranks follow */
    default:
        break;
    }
    if (q >= PROBE_BROADCAST && q <= PROBE_B_EFF)
        return probe_collective(m, q, (int64_t)at, ranks, value, e);
    return err_set(e, ERR_CONFIG, "%s: no such quantity", m->name);
}
