/* probe.c - published quantities measured on a simulated machine (probe.h). */
#include "study/probe.h"

#include <math.h>
#include <string.h>

#include "base/arena.h"
#include "machine/topology.h"
#include "run/run.h"
#include "study/probe_collective.h"
#include "study/rates.h"

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

bool probe_contends(enum probe_quantity q, double at, int ranks)
{
    if (is_collective(q)) return ranks > 2 && ranks <= FEW_RANKS;
    return (q == PROBE_BARRIER || q == PROBE_EXCHANGE || q == PROBE_HALVES) && at > 2;
}

/* `kernel` with messages of `bytes` on `nrank` ranks. Nobody else is on the machine's wires where
 * two ranks talk, so all network levels agree there and level link is the cheapest that knows of
 * others. */
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
    spec.machine.noise = (struct noise_spec){0};
    bool ok = run_one(&spec, a, &r, e);
    if (ok && r.status != RUN_OK) ok = err_set(e, ERR_CONFIG, "%s: %s", m->name, r.text);
    if (ok) {
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

static bool one_way(const struct machine_spec *m, int64_t bytes, double *t, struct err *e)
{
    struct measured x;
    if (!bench(m, "pingpong", 2, bytes, 1, &x, e)) return false;
    *t = x.time;
    return true;
}

static bool asymptotic_rate(const struct machine_spec *m, double *rate, struct err *e)
{
    double t4, t8;
    if (!one_way(m, 4 * MEBIBYTE, &t4, e) || !one_way(m, 8 * MEBIBYTE, &t8, e)) return false;
    *rate = 4.0 * MEBIBYTE / (t8 - t4);
    return true;
}

/* Doubling, then halving the interval: the rate rises with the size but for steps of the
 * protocol. */
static bool half_rate_size(const struct machine_spec *m, double *size, struct err *e)
{
    double rate, t;
    int64_t low = 0, high = 1;
    if (!asymptotic_rate(m, &rate, e)) return false;
    for (;; low = high, high *= 2) {
        if (!one_way(m, high, &t, e)) return false;
        if ((double)high / t >= rate / 2 || high >= LARGEST_SIZE) break;
    }
    while (high - low > 1) {
        int64_t middle = (low + high) / 2;
        if (!one_way(m, middle, &t, e)) return false;
        if ((double)middle / t >= rate / 2) high = middle;
        else low = middle;
    }
    *size = (double)high;
    return true;
}

/* Rank 1 sends to rank 0 without pause; the start-up goes away between two lengths. */
static bool flood_gap(const struct machine_spec *m, double *gap, struct err *e)
{
    struct measured a, b;
    if (!bench(m, "hot-spot", 2, SMALL_BYTES, FLOOD, &a, e) ||
        !bench(m, "hot-spot", 2, SMALL_BYTES, 2 * FLOOD, &b, e))
        return false;
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

static bool overheads(const struct machine_spec *m, enum probe_quantity q, double at, double *value,
                      struct err *e)
{
    struct measured x;
    const int64_t bytes = at > 0 ? (int64_t)at : SMALL_BYTES;
    if (q == PROBE_SEND_OVERHEAD) return send_overhead(m, bytes, value, e);
    if (!bench(m, "pingpong", 2, bytes, 1, &x, e)) return false;
    *value = q == PROBE_RECV_OVERHEAD ? x.recv : x.time - x.send - x.recv;
    return true;
}

/* The first node that is `links` links away from node 0, -1: none. */
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

/* The wire alone: ranks on two nodes `links` apart, software that takes no time. */
static bool wire(const struct machine_spec *m, int links, double *t, struct err *e)
{
    struct machine_spec bare = *m;
    int list[2] = {0, node_at(m, links, e)};
    if (list[1] < 0) return false;
    list[0] *= m->topology.processors_per_node;
    list[1] *= m->topology.processors_per_node;
    bare.software = (struct software_spec){.eager_bytes = -1};
    bare.placement = (struct placement_spec){.kind = PLACEMENT_LIST, .nlist = 2, .list = list};
    return one_way(&bare, 0, t, e);
}

/* Nobody's processor but the caller's takes part; interface and wire are those of messages. */
static bool one_sided(const struct machine_spec *m, enum probe_quantity q, int64_t bytes, double *t,
                      struct err *e)
{
    const struct software_spec *s = &m->software;
    const double overhead = q == PROBE_GET ? s->get_overhead : s->put_overhead;
    struct machine_spec bare = *m;
    double request = 0;
    if (!(overhead > 0))
        return err_set(e, ERR_CONFIG, "%s: software.%s.overhead is 0: no one-sided %s", m->name,
                       probe_name(q), probe_name(q));
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
    struct machine_spec coherent = *m;
    coherent.network.end_latency = 0;
    if (!wire(&coherent, routers - 1, t, e)) return false;
    *t *= 2;
    return true;
}

/* Which half of dimension d router r lies in. */
static bool upper_half(const struct topology_spec *s, int d, int r)
{
    if (s->family == TOPOLOGY_HYPERCUBE) return r >> d & 1;
    for (int k = 0; k < d; k++) r /= s->dims[k];
    return r % s->dims[d] >= s->dims[d] / 2;
}

/* Rate of all links, both directions, that join the halves of dimension d. */
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

static bool barrier(const struct machine_spec *m, int ranks, double *t, struct err *e)
{
    struct measured x;
    if (!bench(m, "barrier", ranks, 0, 4, &x, e)) return false;
    *t = x.time;
    return true;
}

/* What each rank sends in a kernel where it has `partners`; the start-up goes away between two
 * lengths. Behind a kernel's server copies hide while messages wait for it, until they are long. */
static bool rate_among(const struct machine_spec *m, const char *kernel, int ranks, int partners,
                       double *rate, struct err *e)
{
    struct measured once, twice;
    if (ranks < 2) return err_set(e, ERR_CONFIG, "%s: an exchange of %d ranks", m->name, ranks);
    const int64_t all = m->software.kernel_server ? SERVED_BYTES : EXCHANGE_BYTES;
    const int64_t bytes = all / partners / SMALL_BYTES * SMALL_BYTES;
    if (!bench(m, kernel, ranks, bytes, 1, &once, e) ||
        !bench(m, kernel, ranks, 2 * bytes, 1, &twice, e))
        return false;
    *rate = (double)(bytes * partners) / (twice.time - once.time);
    return true;
}

/* Codes of computing have a size that is an order or a length. */
static bool computing(const struct machine_spec *m, enum probe_quantity q, double at, double *rate,
                      struct err *e)
{
    int n = q == PROBE_LINPACK || q == PROBE_INNER_PRODUCT ? (int)at : VECTOR;
    struct rate_count c;
    if (n < 1 || n > MEBIBYTE)
        return err_set(e, ERR_CONFIG, "%s: %s of %g elements", m->name, probe_name(q), at);
    if (q == PROBE_LINPACK) c = rate_linpack(n);
    else if (q == PROBE_INNER_PRODUCT) c = rate_inner_product(n);
    else if (q == PROBE_MEMORY_COPY) c = rate_stream(RATE_COPY, n);
    else c = rate_stream((enum rate_stream)(q - PROBE_STREAM_COPY), n);
    *rate = rate_of(&m->node, &c) *
            (q == PROBE_MEMORY_COPY ? 0.5 : 1); /* STREAM counts a byte copied twice */
    return true;
}

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
    default:
        break;
    }
    if (q >= PROBE_BROADCAST && q <= PROBE_B_EFF)
        return probe_collective(m, q, (int64_t)at, ranks, value, e);
    return err_set(e, ERR_CONFIG, "%s: no such quantity", m->name);
}
