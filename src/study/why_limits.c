/* why_limits.c - the idealised machines of why.h: each takes one hindrance away, all else stays. */
#include "study/why_limits.h"

#include <string.h>

#include "measure/balance.h"
#include "study/why_runs.h"

/* --- idealised machines ----------------------------------------------------------------------- */

static void no_latency(struct machine_spec *m)
{
    m->network.hop_latency = m->network.end_latency = m->network.routing_latency = 0;
    memset(m->topology.dim_latency, 0, sizeof m->topology.dim_latency);
    m->network.vc_allocation_latency = m->network.credit_latency = 0;
    m->software.rendezvous_latency = m->software.shared_latency = 0;
    m->network.collective.latency = m->network.collective.hop_latency = 0;
    for (int i = 0; i < m->software.nsegment; i++)
        m->software.segment[i].latency = m->software.segment[i].rendezvous_latency = 0;
}

static void no_overhead(struct machine_spec *m)
{
    struct software_spec *s = &m->software;
    s->send_overhead = s->recv_overhead = s->send_copy = s->recv_copy = s->eager_copy = 0;
    s->short_saving = s->short_copy = s->kernel_time = s->kernel_per_byte = s->gap = 0;
    for (int i = 0; i < s->nsegment; i++) {
        struct software_segment *x = &s->segment[i];
        x->send_overhead = x->recv_overhead = x->send_copy = x->recv_copy = x->gap = 0;
        x->send_saving = x->recv_extra = 0;
    }
}

/* So fast that a flit takes the least time there is, 1 ps. Levels with flits refuse the rate 0,
 * which means unlimited elsewhere; ports without a bandwidth of their own have the link's. */
static void no_bytes(struct machine_spec *m)
{
    m->network.link_bandwidth = 1e18;
    /* a latency is many such flits, which a buffer has to hold */
    m->network.buffer_flits = 1 << 24;
    m->network.injection_bandwidth = m->network.ejection_bandwidth = 0;
    m->network.collective.bandwidth = 0; /* that of a link */
    memset(m->topology.dim_bandwidth, 0, sizeof m->topology.dim_bandwidth);
    m->software.gap_per_byte = 0;
    for (int i = 0; i < m->software.nsegment; i++) m->software.segment[i].gap_per_byte = 0;
}

static void no_computing(struct machine_spec *m)
{
    /* node_cost.c: no cost, neither of operations nor of instructions */
    m->node.flop_rate = m->node.clock = 0;
    m->node.div_cycles = m->node.sqrt_cycles = m->node.trig_cycles = m->node.call_time = 0;
    m->node.copy_bandwidth = 0;
    for (int i = 0; i < NODE_LEVELS; i++)
        m->node.level[i].bandwidth = m->node.level[i].shared = 0;
}

static void no_contention(struct machine_spec *m) { m->network.level = LEVEL_LOGGP; }

static const struct ideal {
    const char *name, *what;
    void (*change)(struct machine_spec *m);
} ideals[] = {
    {"zero latency", "hop, end, cable, segment and rendezvous latencies are 0", no_latency},
    {"zero overhead", "o_s, o_r, copies and gap g are 0", no_overhead},
    {"infinite bandwidth", "links, ports and G take no time a byte", no_bytes},
    {"infinitely fast nodes", "no operation takes time", no_computing},
    {"no contention", "level loggp: messages wait for their own port alone", no_contention},
};

static const char even[] = "in each stage every rank computes the mean over all ranks";

enum { IDEALS = sizeof ideals / sizeof ideals[0] };

struct balance *why_even(const struct run_result *r, struct arena *a)
{
    const int64_t cells = (int64_t)r->nrank * r->nstage;
    int64_t *own = TAKE(a, cells, int64_t), *target = TAKE(a, cells, int64_t);
    for (int64_t i = 0; i < cells; i++) own[i] = r->stage[i].compute_ps;
    for (int k = 0; k < r->nstage; k++) {
        /* The sum over the ranks stays what it is, to the picosecond. */
        int64_t sum = 0;
        for (int i = 0; i < r->nrank; i++) sum += own[(int64_t)i * r->nstage + k];
        for (int i = 0; i < r->nrank; i++)
            target[(int64_t)i * r->nstage + k] = sum / r->nrank + (i < sum % r->nrank);
    }
    struct balance *b = TAKE(a, 1, struct balance);
    *b = (struct balance){.nrank = r->nrank, .nstage = r->nstage, .own = own, .target = target};
    return b;
}

bool why_limits(const struct run_spec *spec, int workers, bool quiet, struct arena *a,
                struct why *w, struct err *e)
{
    struct run_spec run[IDEALS + 1];
    struct run_result result[IDEALS + 1];
    for (int i = 0; i < IDEALS; i++) {
        run[i] = why_bare(spec, false);
        ideals[i].change(&run[i].machine);
    }
    /* No setting of a machine shares work: the same machine, with other times of computing. */
    run[IDEALS] = why_bare(spec, false);
    run[IDEALS].record.balance = why_even(&w->run, a);
    if (!why_batch(run, IDEALS + 1, workers, quiet, a, result, e)) return false;
    for (int i = 0; i <= IDEALS; i++) {
        struct why_limit *l = &w->limit[w->nlimit++];
        *l = i < IDEALS ? (struct why_limit){.name = ideals[i].name, .what = ideals[i].what}
                        : (struct why_limit){.name = "perfect balance", .what = even};
        if (result[i].status <= RUN_INVALID) l->makespan_ps = result[i].makespan_ps;
    }
    return true;
}
