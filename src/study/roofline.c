/* roofline.c - see roofline.h.
 *
 * All roofs have one form: the operations of the stage over the time that one part of the machine
 * needs for it, so a stage below its lowest roof waits, for others or for latencies. */
#include "study/roofline.h"

#include <math.h>

#include "base/check.h"
#include "vp/cost.h"

const char *roofline_word(enum roof roof)
{
    static const char *const word[] = {"computing", "bandwidth", "message software"};
    return word[roof];
}

double roofline_bandwidth(const struct machine_spec *m, int64_t bytes)
{
    const struct network_spec *w = &m->network;
    /* Ports without a bandwidth of their own have the link's; 0 is unlimited there. */
    double rate = w->injection_bandwidth > 0 ? w->injection_bandwidth : w->link_bandwidth;
    struct software_segment list[SOFTWARE_MAX_SEGMENTS];
    const int n = software_segments(&m->software, list);
    const double per_byte = software_segment_of(list, n, bytes)->gap_per_byte;
    if (rate <= 0) rate = INFINITY;
    return per_byte * rate > 1 ? 1 / per_byte : rate;
}

/* Sums over ranks of one stage, or of all. */
struct total {
    double flops, bytes, messages, compute_ps, time_ps;
};

static void add(struct total *t, const struct stage_time *s)
{
    t->flops += (double)s->work.flop;
    t->bytes += (double)s->bytes;
    t->messages += (double)s->messages;
    t->compute_ps += (double)s->compute_ps;
    t->time_ps +=
        (double)(s->compute_ps + s->send_ps + s->recv_ps + s->wait_ps + s->contention_ps);
}

/* A rate that takes no time is no roof. */
static double rate_of(double flops, double ps) { return ps > 0 ? flops / (ps * 1e-12) : INFINITY; }

/* Times are summed over processors, so flops over them are one processor's rate. */
static struct roofline_row row_of(const struct machine_spec *m, const struct node_use *use,
                                  int stage, const struct total *t)
{
    const struct software_cost cost = software_cost_used(m, use);
    const int64_t mean = t->messages > 0 ? llround(t->bytes / t->messages) : 0;
    const struct message_cost *c = message_cost(&cost, mean);
    /* Who sends a message handles one that comes in, too, in the mean over all ranks. */
    const double each = (double)(byte_cost(c->send, c->send_byte, mean) +
                                 byte_cost(c->recv, c->recv_byte, mean));
    const double wire = t->bytes / roofline_bandwidth(m, mean) * 1e12;
    struct roofline_row r = {.stage = stage,
                             .flops = t->flops,
                             .sent_bytes = t->bytes,
                             .messages = t->messages,
                             .intensity = t->bytes > 0 ? t->flops / t->bytes : INFINITY,
                             .attained = rate_of(t->flops, t->time_ps),
                             .computing = rate_of(t->flops, t->compute_ps),
                             .bandwidth = rate_of(t->flops, wire),
                             .software = rate_of(t->flops, t->messages * each)};
    r.lowest = ROOF_COMPUTING;
    if (r.bandwidth < r.computing) r.lowest = ROOF_BANDWIDTH;
    if (r.software < fmin(r.computing, r.bandwidth)) r.lowest = ROOF_SOFTWARE;
    return r;
}

struct roofline_row *roofline_rows(const struct machine_spec *m, const struct run_result *r, int *n,
                                   struct arena *a)
{
    struct total all = {0}, stage[RUN_MAX_STAGES] = {0};
    struct roofline_row *row = TAKE(a, r->nstage + 1, struct roofline_row);
    *n = 0;
    for (int64_t i = 0; r->stage != NULL && i < (int64_t)r->nrank * r->nstage; i++) {
        add(&stage[i % r->nstage], &r->stage[i]);
        add(&all, &r->stage[i]);
    }
    if (all.flops <= 0) return row;
    struct node_use use;
    struct err e;
    err_clear(&e);
    /* The run has placed its ranks on this machine: it holds them. */
    CHECK(node_use_make(m, r->nrank, r->working_set, &use, &e));
    row[(*n)++] = row_of(m, &use, -1, &all);
    for (int k = 0; k < r->nstage; k++)
        if (stage[k].flops > 0) row[(*n)++] = row_of(m, &use, k, &stage[k]);
    return row;
}
