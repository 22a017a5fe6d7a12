/* segments.c - see segments.h.
 *
 * Where one segment ends and the next begins follows from the measured times (jumps.h). */
#include "reality/segments.h"

#include <math.h>

#include "reality/fit.h"
#include "reality/jumps.h"

/* The points of one segment as columns. */
struct columns {
    double bytes[MESSAGES_SIZES], one_way[MESSAGES_SIZES], send[MESSAGES_SIZES],
        recv[MESSAGES_SIZES], rest[MESSAGES_SIZES], train[MESSAGES_SIZES];
    int n;
};

/* The receiver cannot take more than the round trip leaves to it: a receive that is measured alone
 * finds the caches as its waiting left them. */
static void add_point(struct columns *c, const struct message_point *p)
{
    const double left = p->one_way - p->send;
    const double recv = p->recv < left ? p->recv : fmax(left, 0);
    c->bytes[c->n] = (double)p->bytes;
    c->one_way[c->n] = p->one_way;
    c->send[c->n] = p->send;
    c->recv[c->n] = recv;
    c->rest[c->n] = fmax(left - recv, 0);
    c->train[c->n] = p->train;
    c->n++;
}

/* The largest g that trains ask for beside the rate: what is left when neither end is the slower
 * one. */
static double gap_of(const struct columns *c, double per_byte)
{
    double gap = INFINITY;
    for (int i = 0; i < c->n; i++) {
        if (c->train[i] <= 0) continue; /* of long messages no trains are sent */
        const double ends = fmax(c->send[i], c->recv[i]);
        const double g = c->train[i] > ends ? c->train[i] - per_byte * c->bytes[i] : 0;
        gap = fmin(gap, fmax(g, 0));
    }
    return isinf(gap) ? 0 : gap;
}

/* Eager: the four lines. */
static void fit_eager(const struct columns *c, struct fitted_segment *out)
{
    const struct fit_line send = fit_line_of(c->bytes, c->send, c->n),
                          recv = fit_line_of(c->bytes, c->recv, c->n),
                          rest = fit_line_of(c->bytes, c->rest, c->n);
    out->segment.send_overhead = send.at_zero;
    out->segment.send_copy = send.slope;
    out->segment.recv_overhead = recv.at_zero;
    out->segment.recv_copy = recv.slope;
    out->segment.latency = rest.at_zero;
    out->segment.gap_per_byte = rest.slope;
    out->segment.gap = gap_of(c, rest.slope);
    out->segment.protocol = PROTOCOL_EAGER;
    out->send = send.residual;
    out->recv = recv.residual;
}

/* Rendezvous: the receiver's time is that of a short message, `short_recv`; request and answer take
 * `short_latency` each; the rest is the hand-shake's software and the rate (docs/network.md). */
static void fit_rendezvous(const struct columns *c, double short_recv, double short_latency,
                           struct fitted_segment *out)
{
    double rest[MESSAGES_SIZES];
    const struct fit_line send = fit_line_of(c->bytes, c->send, c->n);
    for (int i = 0; i < c->n; i++) rest[i] = fmax(c->one_way[i] - c->send[i] - short_recv, 0);
    const struct fit_line line = fit_line_of(c->bytes, rest, c->n);
    out->segment.send_overhead = send.at_zero;
    out->segment.send_copy = send.slope;
    out->segment.recv_overhead = short_recv;
    out->segment.gap_per_byte = line.slope;
    out->segment.rendezvous_latency = fmax(line.at_zero - 2 * short_latency, 0);
    out->segment.protocol = PROTOCOL_RENDEZVOUS;
    out->send = send.residual;
    out->recv = 0;
}

/* What the segment predicts for a message of `bytes`, and how far off it is at worst. */
static double one_way_residual(const struct columns *c, const struct software_segment *s,
                               double short_latency)
{
    double most = 0;
    for (int i = 0; i < c->n; i++) {
        double t = s->send_overhead + s->recv_overhead + s->latency;
        t += c->bytes[i] * (s->send_copy + s->recv_copy + s->gap_per_byte);
        if (s->protocol == PROTOCOL_RENDEZVOUS) t += 2 * short_latency + s->rendezvous_latency;
        most = fmax(most, fabs(t - c->one_way[i]) / c->one_way[i]);
    }
    return most;
}

int segments_of(const struct messages *m, struct fitted_segment *out)
{
    int n = 0, first[SOFTWARE_MAX_SEGMENTS];
    const int pieces = jumps_find(m, first);
    double short_recv = 0, short_latency = 0;
    for (int piece = 0; piece < pieces; piece++) {
        struct columns c = {.n = 0};
        const int i = first[piece], end = piece + 1 < pieces ? first[piece + 1] : m->n;
        for (int k = i; k < end; k++) add_point(&c, &m->point[k]);
        struct fitted_segment *s = &out[n++];
        *s = (struct fitted_segment){.points = c.n, .segment = {.from = m->point[i].bytes}};
        if (m->point[i].rendezvous) fit_rendezvous(&c, short_recv, short_latency, s);
        else fit_eager(&c, s);
        /* Control messages of a hand-shake are messages of no bytes: of the first segment. */
        if (n == 1) {
            short_recv = s->segment.recv_overhead;
            short_latency = s->segment.latency;
        }
        s->one_way = one_way_residual(&c, &s->segment, short_latency);
    }
    return n;
}
