/* software_spec.c - lists completed; short, eager and rendezvous messages made segments
 * (software_spec.h).
 *
 *     o_s = send.overhead + b send.copy        o_r = recv.overhead + b recv.copy
 *
 * of a message of b bytes, by the numbers of its segment. The classic form (limits of short and
 * eager messages) is the same thing with up to three segments, so that levels and processors need
 * one rule:
 *
 *     0 B up to the lower limit, from there to the higher one, beyond it */
#include "spec/software_spec.h"

/* -1 in a segment: not given there. */
static double given(double value, double otherwise) { return value < 0 ? otherwise : value; }

/* After this every number of a segment is final; only latency has no value for all sizes, since
 * network.end_latency is that. */
static struct software_segment completed(const struct software_spec *s, struct software_segment x)
{
    x.send_overhead = given(x.send_overhead, s->send_overhead);
    x.send_copy = given(x.send_copy, s->send_copy);
    x.recv_overhead = given(x.recv_overhead, s->recv_overhead);
    x.recv_copy = given(x.recv_copy, s->recv_copy);
    x.latency = given(x.latency, 0);
    x.gap = given(x.gap, s->gap);
    x.gap_per_byte = given(x.gap_per_byte, s->gap_per_byte);
    x.rendezvous_latency = given(x.rendezvous_latency, s->rendezvous_latency);
    return x;
}

/* What short.*, eager.* and rendezvous.* say of messages of `from` bytes, the smallest of a
 * segment. All messages of a segment are alike: no limit lies inside one. */
static struct software_segment classic(const struct software_spec *s, int64_t from)
{
    struct software_segment x = {.from = from,
                                 .send_overhead = s->send_overhead,
                                 .send_copy = s->send_copy,
                                 .recv_overhead = s->recv_overhead,
                                 .recv_copy = s->recv_copy,
                                 .gap = s->gap,
                                 .gap_per_byte = s->gap_per_byte,
                                 .rendezvous_latency = s->rendezvous_latency};
    /* Limits are inclusive; a limit below 0 is none. */
    const bool is_short = s->short_bytes > 0 && from <= s->short_bytes;
    const bool eager = s->eager_bytes < 0 || from <= s->eager_bytes;
    /* A saving cannot be larger than the overhead: time never becomes negative. */
    if (is_short)
        x.send_saving = s->short_saving < s->send_overhead ? s->short_saving : s->send_overhead;
    /* An eager message is copied out of a buffer at the receiver; a rendezvous arrives in place. */
    if (eager) x.recv_extra = is_short ? s->short_copy : s->eager_copy;
    x.protocol = eager ? PROTOCOL_EAGER : PROTOCOL_RENDEZVOUS;
    return x;
}

/* A list takes the place of short.* and eager.*; without one these make one to three segments, and
 * all other code knows segments only. */
int software_segments(const struct software_spec *s, struct software_segment *out)
{
    int n = 0;
    for (int i = 0; i < s->nsegment; i++) out[n++] = completed(s, s->segment[i]);
    if (n > 0) return n;

    /* the two limits in rising order; where they agree there is one step */
    const int64_t after_short = s->short_bytes > 0 ? s->short_bytes + 1 : 0;
    const int64_t after_eager = s->eager_bytes >= 0 ? s->eager_bytes + 1 : 0;
    const int64_t low = after_short < after_eager ? after_short : after_eager;
    const int64_t high = after_short < after_eager ? after_eager : after_short;
    out[n++] = classic(s, 0);
    if (low > 0) out[n++] = classic(s, low);
    if (high > low) out[n++] = classic(s, high);
    return n;
}

/* From the end: long messages are few segments away; at most eight. */
const struct software_segment *software_segment_of(const struct software_segment *segment, int n,
                                                   int64_t bytes)
{
    while (n > 1 && bytes < segment[n - 1].from) n--;
    return &segment[n - 1];
}

/* Segments rise in size: the first that shakes hands ends the eager range. */
int64_t software_eager_most(const struct software_spec *s)
{
    struct software_segment list[SOFTWARE_MAX_SEGMENTS];
    const int n = software_segments(s, list);
    for (int i = 0; i < n; i++)
        if (list[i].protocol != PROTOCOL_EAGER) return list[i].from - 1;
    return INT64_MAX;
}

/* The promise of the largest message decides before the run whether any can need a hand-shake. */
bool software_all_eager(const struct software_spec *s, int64_t largest)
{
    const int64_t most = software_eager_most(s);
    return most == INT64_MAX || (largest >= 0 && largest <= most);
}
