/* calibrate.c - see calibrate.h.
 *
 * The machine is one crossbar whose nodes are the processors: in shared memory no link is between
 * them that messages could meet on, or none that these measurements could tell. Everything that a
 * message costs is message software, by segments of its size. */
#include "reality/calibrate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/units.h"
#include "reality/jumps.h"
#include "reality/segments.h"

double calibration_clock(void)
{
    char line[256];
    double mhz = 0;
    FILE *f = fopen("/proc/cpuinfo", "r");
    while (f != NULL && mhz == 0 && fgets(line, sizeof line, f) != NULL)
        if (sscanf(line, "cpu MHz : %lf", &mhz) != 1) mhz = 0;
    if (f != NULL) fclose(f);
    return mhz > 0 ? round(mhz) * 1e6 : 1e9;
}

struct machine_spec calibration_machine(const struct calibration *c,
                                        const struct machine_spec *base)
{
    struct machine_spec m = *base;
    struct fitted_segment fitted[SOFTWARE_MAX_SEGMENTS];
    m.node = rates_node(&c->rates, c->clock);
    m.software = (struct software_spec){.eager_bytes = -1, .barrier = BARRIER_SOFTWARE};
    m.software.nsegment = c->has_messages ? segments_of(&c->messages, fitted) : 0;
    for (int i = 0; i < m.software.nsegment; i++) m.software.segment[i] = fitted[i].segment;
    return m;
}

/* "class: measured, source: ..." behind a value; what is said of all is said once, at the top. */
static void leaf(struct text *t, const char *indent, const char *key, const char *value,
                 const char *source, const struct calibration *c)
{
    text_add(t, "%s%s: {value: %s, class: measured, source: \"%s; %s, %s\"}\n", indent, key, value,
             source, c->host, c->date);
}

/* The same with how fast the computer was: `place` is the key in full. */
static void noted_leaf(struct text *t, const char *indent, const char *place, const char *value,
                       const char *source, const struct calibration *c)
{
    char noted[256];
    const char *dot = strrchr(place, '.');
    text_copy(noted, sizeof noted, source);
    condition_note(&c->condition, place, noted, sizeof noted);
    leaf(t, indent, dot != NULL ? dot + 1 : place, value, noted, c);
}

/* A price as cycles of the stated clock. */
static void cycles(struct text *t, const char *place, double price, const char *source,
                   const struct calibration *c)
{
    char value[48];
    snprintf(value, sizeof value, "%.4g cycles", price * c->clock);
    noted_leaf(t, "  ", place, value, source, c);
}

/* The finer prices of programs in one file, all of one fit. */
static void add_code(const struct calibration *c, struct text *t)
{
    const struct code_rates *r = &c->code;
    char value[48], source[160];
    snprintf(source, sizeof source, "fit to %d loops, residual %.1f %% median, %.1f %% largest",
             r->n, 100 * r->median_residual, 100 * r->residual);
    text_add(t, "  code:\n");
    for (int i = 0; i < CODE_PRICES; i++) {
        /* Nothing at all would mean something else. */
        const double price = fmax(r->price[i], 1e-6);
        if (i == CODE_WINDOW) snprintf(value, sizeof value, "%.4g", code_price_window(r->price));
        else snprintf(value, sizeof value, "%.4g cycles", price);
        char place[48];
        snprintf(place, sizeof place, "node.code.%s", code_price_name(i));
        noted_leaf(t, "    ", place, value, source, c);
    }
}

/* Rates: a price of 0 is a class of operations that the fit gave nothing. */
static void add_node(const struct calibration *c, struct text *t)
{
    const struct rates *r = &c->rates;
    char value[48], source[160];
    snprintf(source, sizeof source,
             "fit to %d runs of kernels on one processor, residual %.1f %% median, %.1f %% largest",
             r->n, 100 * r->median_residual, 100 * r->residual);
    text_add(t, "node:\n");
    /* At least 1 flop/s is asked for; a flop that costs nothing gets the largest rate there is. */
    snprintf(value, sizeof value, "%.4g Mflop/s", r->flop > 0 ? 1e-6 / r->flop : 1e9);
    noted_leaf(t, "  ", "node.flop_rate", value,
               "products of a 6x6 matrix and a vector, least time", c);
    snprintf(value, sizeof value, "%.0f MHz", c->clock * 1e-6);
    leaf(t, "  ", "clock", value, "as the system states it: the unit of the cycles below", c);
    cycles(t, "node.div", r->div, source, c);
    cycles(t, "node.sqrt", r->sqrt, "a loop of roots, each of the one before, least time", c);
    cycles(t, "node.trig", r->trig, "a loop over 512 angles, least time", c);
    if (c->has_code) add_code(c, t);
    else
        cycles(t, "node.instruction", r->instruction,
               "a scalar product, five instructions an element, least time", c);
    snprintf(value, sizeof value, "%.4g ns", r->call * 1e9);
    noted_leaf(t, "  ", "node.call", value, source, c);
    text_add(t, "  copy:\n");
    snprintf(value, sizeof value, "%.4g MB/s", 1e-6 / r->copy);
    noted_leaf(t, "    ", "node.copy.bandwidth", value,
               "copies of 16 KiB within the first cache, least time", c);
}

/* One segment on a line, with how well its lines fit. */
static void add_segment(const struct fitted_segment *f, struct text *t)
{
    const struct software_segment *s = &f->segment;
    text_add(t, "    - {from: %lld B, send.overhead: %.5g ns, send.copy: %.5g ns/B, ",
             (long long)s->from, s->send_overhead * 1e9, s->send_copy * 1e9);
    text_add(t, "recv.overhead: %.5g ns, recv.copy: %.5g ns/B,\n", s->recv_overhead * 1e9,
             s->recv_copy * 1e9);
    text_add(t, "       latency: %.5g ns, gap: %.5g ns, gap_per_byte: %.5g ns/B, ",
             s->latency * 1e9, s->gap * 1e9, s->gap_per_byte * 1e9);
    if (s->protocol == PROTOCOL_RENDEZVOUS)
        text_add(t, "protocol: rendezvous, rendezvous.latency: %.5g ns,\n       ",
                 s->rendezvous_latency * 1e9);
    text_add(t,
             "class: measured, source: \"%d sizes, residual of a message %.1f %%, o_s %.1f %%, o_r "
             "%.1f %%\"}\n",
             f->points, 100 * f->one_way, 100 * f->send, 100 * f->recv);
}

/* Which algorithms are faster than those that would be chosen. What a barrier and the collectives
 * take follows from their messages; how well, the residual says. */
static void add_collectives(const struct calibration *c, struct text *t)
{
    const struct collective_times *x = &c->collectives;
    char source[200], value[560];
    snprintf(source, sizeof source,
             "%d collectives by algorithm and size on %d processors; predicted from the segments "
             "with a residual of %.1f %% median, %.1f %% largest",
             x->n, x->nrank, 100 * x->median_residual, 100 * x->residual);
    snprintf(value, sizeof value, "\"%s\"", x->rules);
    if (x->rules[0] != '\0') leaf(t, "  ", "collectives", value, source, c);
    else text_add(t, "# No collective is faster by another algorithm: %s.\n", source);
    if (x->left_out > 0)
        text_add(t,
                 "# %d more were left out: fewer than 3 of their repetitions were undisturbed.\n",
                 x->left_out);
    text_add(t, "# Barrier and collectives on %d processors [us]: measured, predicted; samples - "
                "disturbed\n", x->nrank);
    for (int i = 0; i < x->n; i++) {
        const struct collective_sample *s = &x->sample[i];
        text_add(t, "#   %-14s %-26s %8lld B %10.3f %10.3f  %d - %d\n", collective_name(s->kind),
                 s->algorithm->name, (long long)s->bytes, s->measured * 1e6, s->predicted * 1e6,
                 s->samples, s->disturbed);
    }
}

/* Where the time of a message leaves its line, beside the switch to rendezvous. */
static void add_jumps(const struct messages *m, struct text *t)
{
    int first[SOFTWARE_MAX_SEGMENTS];
    const int n = jumps_find(m, first);
    for (int k = 1; k < n; k++)
        text_add(t, "# Between %lld and %lld B a message changes its line: %+.0f %%.\n",
                 (long long)m->point[first[k] - 1].bytes, (long long)m->point[first[k]].bytes,
                 100 * jumps_height(m, first[k]));
}

static void add_software(const struct calibration *c, struct text *t)
{
    struct fitted_segment segment[SOFTWARE_MAX_SEGMENTS];
    const struct messages *m = &c->messages;
    char value[48];
    const int n = segments_of(m, segment);
    text_add(t, "\nsoftware:\n  segments:\n");
    for (int i = 0; i < n; i++) add_segment(&segment[i], t);
    snprintf(value, sizeof value, "%.4g ns", m->barrier * 1e9);
    text_add(t,
             "\n# Programs make barriers of messages here, as mimdsim does on this MPI. MPI's own "
             "barrier: %s.\n",
             value);
    if (m->eager_most == INT64_MAX)
        text_add(t, "# No size that was tried waits for its receive.\n");
    else text_add(t, "# Messages up to %lld B are sent at once.\n", (long long)m->eager_most);
    add_jumps(m, t);
    if (c->has_collectives) add_collectives(c, t);
}

/* What was measured, one line each, for people who want to judge the fits. */
static void add_points(const struct calibration *c, struct text *t)
{
    text_add(t, "\n# Measured, median of the undisturbed samples [us]: bytes, one way, send, late "
                "receive, in a train; samples - disturbed\n");
    for (int i = 0; i < c->messages.n; i++) {
        const struct message_point *p = &c->messages.point[i];
        text_add(t, "#   %8lld %10.3f %10.3f %10.3f %10.3f  %d - %d\n", (long long)p->bytes,
                 p->one_way * 1e6, p->send * 1e6, p->recv * 1e6, p->train * 1e6, p->samples,
                 p->disturbed);
    }
}

static void add_kernels(const struct calibration *c, struct text *t)
{
    text_add(t, "\n# Kernels on one processor: measured [us], flops; samples - disturbed\n");
    for (int i = 0; i < c->rates.n; i++) {
        const struct rate_sample *s = &c->rates.sample[i];
        text_add(t, "#   %-28s %12.3f %12llu  %d - %d\n", s->what, s->seconds * 1e6,
                 (unsigned long long)s->work.flop, s->samples, s->disturbed);
    }
    text_add(t, "# Fixed cost of a run: %.3f us, which no prediction adds.\n",
             c->rates.fixed * 1e6);
    if (c->has_code)
        text_add(t, "\n# Loops of programs in one file: measured, by the prices [us]; samples - "
                    "disturbed\n");
    for (int i = 0; c->has_code && i < c->code.n; i++) {
        const struct code_sample *s = &c->code.sample[i];
        text_add(t, "#   %-36s %10.3f %10.3f  %d - %d\n", s->what, s->seconds * 1e6,
                 s->fitted * 1e6, s->samples, s->disturbed);
    }
}

void calibration_remark(const struct calibration *c, char *text, size_t size)
{
    int n = 0;
    text[0] = '\0';
    if (c->changed > c->points / 10)
        n = snprintf(text, size,
                     "This computer's speed changed during calibration: %d of %d points took over "
                     "%.0f %% longer in one pass than in the other, %.0f %% in their median; the "
                     "lesser times are kept",
                     c->changed, c->points, 100 * PASSES_SAME, 100 * c->changed_by);
    if (c->slow > c->points / 10 && n < (int)size)
        snprintf(text + n, size - (size_t)n,
                 "%s%d of %d points were slowed down by over %.0f %% whenever they were measured: "
                 "better calibrate again",
                 n > 0 ? ". " : "", c->slow, c->points, 100 * PASSES_SAME);
}

void calibration_text(const struct calibration *c, struct text *t)
{
    char remark[500];
    text_add(t, "# Measured by mimdsim calibrate on %s, %s: %s, %d processors, %s.\n", c->host,
             c->date, c->processor[0] != '\0' ? c->processor : "unknown processor", c->processors,
             c->library);
    text_add(t,
             "# Load meanwhile: other programs kept %.2f processors busy; load average %.2f "
             "before, %.2f after.\n",
             c->load.others, c->load.before, c->load.after);
    calibration_remark(c, remark, sizeof remark);
    if (remark[0] != '\0') text_add(t, "# %s.\n", remark);
    text_add(t, "# probe: what an operation took meanwhile, to which predict compares it when a "
                "program runs.\n");
    text_add(t, "schema_version: 1\ntitle: \"%s, measured %s\"\n\ntopology:\n", c->host, c->date);
    leaf(t, "  ", "family", "crossbar", "processors of one computer", c);
    leaf(t, "  ", "dims", "[1]", "the same", c);
    char value[32];
    snprintf(value, sizeof value, "%d", c->processors);
    leaf(t, "  ", "nodes_per_router", value, "processors that the job may use, a node each", c);
    text_add(t, "\n");
    add_node(c, t);
    text_add(t, "\nnetwork:\n  level: loggp\n  link:\n");
    noted_leaf(t, "    ", "network.link.bandwidth", "unlimited", "the rate is in the segments", c);
    if (c->has_messages) add_software(c, t);
    if (c->has_messages) add_points(c, t);
    add_kernels(c, t);
}
