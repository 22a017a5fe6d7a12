/* real_samples.c - the repetitions of a real run, in bursts with the computer's speed before and
 * after each (real.h).
 *
 * All processes come to the same end of each loop, since they go by the same numbers: those that
 * real_repeat has gathered, and the clock of the first one. */
#include <math.h>
#include <time.h>

#include "base/memory.h"
#include "host/host_speed.h"
#include "run/real_parts.h"

/* SAMPLES: that are wanted where nobody says how many; MOST_SAMPLES: of one task. LATE_NS: a rank
 * that begins later than this has disturbed the repetition. LEAST_BURST: wanted repetitions of a
 * burst; LEAST_MADE: repetitions whatever the time. PAUSE_NS: between bursts, so that they see more
 * than one moment of a host that shares its processors by turns of some milliseconds. */
enum {
    SAMPLES = 30,
    MOST_SAMPLES = 20000,
    LATE_NS = 3000,
    LEAST_BURST = 3,
    LEAST_MADE = 3,
    PAUSE_NS = 20000000
};

/* The time of a repetition, and of its stages.
 *
 * One sample out of what all ranks told: from the common begin to the last end where they share a
 * clock, else the longest of them. */
static struct real_sample sample_of(const struct real *r, int64_t *faults, double *mean,
                                    double *largest)
{
    const bool one = host_comm_one_clock(r->comm);
    struct real_sample s = {0};
    int64_t begin = INT64_MAX, span = 0;
    *faults = 0;
    for (int i = 0; i < r->nrank; i++) {
        const int64_t *f = real_facts(r, i);
        if (f[FACT_BEGIN] < begin) begin = f[FACT_BEGIN];
        s.disturbed = s.disturbed || f[FACT_PREEMPTED] > 0 || f[FACT_LATE] > LATE_NS;
        *faults += f[FACT_FAULTS];
    }
    for (int i = 0; i < r->nrank; i++) {
        const int64_t *f = real_facts(r, i), took = f[FACT_END] - (one ? begin : f[FACT_BEGIN]);
        if (took > span) span = took;
    }
    s.seconds = (double)span * 1e-9;
    /* The last stage: what a rank idles until the last one has ended. */
    for (int k = 0; k <= r->nstage; k++) mean[k] = largest[k] = 0;
    for (int i = 0; i < r->nrank; i++) {
        const int64_t *f = real_facts(r, i);
        double rest = (double)span * 1e-9;
        for (int k = 0; k <= r->nstage; k++) {
            const double x = k < r->nstage ? (double)f[FACT_STAGES + k] * 1e-9 : fmax(rest, 0);
            mean[k] += x / r->nrank;
            largest[k] = fmax(largest[k], x);
            rest -= x;
        }
    }
    return s;
}

/* What is wanted, and how far it is. */
struct sampling {
    int wanted, most, clean; /* undisturbed repetitions; repetitions; undisturbed ones so far */
    int64_t *faults;         /* (most) page faults of each that was not interrupted; -1: it was */
    int64_t fewest;          /* of those */
    double limit;            /* [s] */
    int64_t begin_ns;        /* on the clock of the first process */
};

/* Since the first repetition [s], as all processes know it. */
static double elapsed(const struct real *r, const struct sampling *s)
{
    return (double)(real_facts(r, 0)[FACT_NOW] - s->begin_ns) * 1e-9;
}

/* A page that comes while the clock runs belongs to the program when it comes each time, as where a
 * program gets memory; the pages of its first hundreds of messages come once. So repetitions with
 * more page faults than that with the fewest are disturbed, but for the small differences of
 * programs that have many. */
static bool has_more_faults(const struct sampling *s, int i)
{
    return s->faults[i] > s->fewest + s->fewest / 8;
}

/* The last repetition is judged; a new fewest judges those before it once more. */
static void count(struct real_result *out, struct sampling *s)
{
    const int last = out->nsample - 1;
    int first = last;
    if (s->faults[last] >= 0 && s->faults[last] < s->fewest) {
        s->fewest = s->faults[last];
        first = out->disturbed = s->clean = 0;
    }
    for (int i = first; i <= last; i++) {
        out->sample[i].disturbed = s->faults[i] < 0 || has_more_faults(s, i);
        out->disturbed += out->sample[i].disturbed;
        s->clean += !out->sample[i].disturbed;
    }
}

/* One more repetition as a row of the tables. */
static bool one_more(struct real *r, struct sampling *s, struct err *e)
{
    struct real_result *out = r->out;
    const size_t at = (size_t)out->nsample * ((size_t)r->nstage + 1);
    if (!real_repeat(r, false, e)) return false;
    int64_t faults;
    const struct real_sample made = sample_of(r, &faults, &r->stage[0][at], &r->stage[1][at]);
    real_note_digest(r, false);
    s->faults[out->nsample] = made.disturbed ? -1 : faults;
    out->sample[out->nsample++] = made;
    count(out, s);
    return true;
}

/* Until a share of what is wanted is there: how many are enough depends on how often the host
 * disturbs them. Time and tries are shared among bursts as well, so that none takes those of the
 * others. */
static bool burst(struct real *r, struct sampling *s, int number, int bursts, struct err *e)
{
    const struct real_result *out = r->out;
    const int wanted = s->wanted * (number + 1) / bursts, most = s->most / bursts * (number + 1);
    const int first = out->nsample, least = s->wanted < LEAST_MADE ? s->wanted : LEAST_MADE;
    while (s->clean < wanted && out->nsample < most) {
        if (elapsed(r, s) > s->limit * (number + 1) / bursts && out->nsample - first >= least)
            break;
        if (!one_more(r, s, e)) return false;
    }
    return true;
}

/* A burst between two looks at the computer's speed. */
static bool watched_burst(struct real *r, struct sampling *s, int number, int bursts, struct err *e)
{
    static const struct timespec pause = {.tv_nsec = PAUSE_NS};
    struct real_result *out = r->out;
    struct real_burst *b = &out->burst[out->nburst];
    const int first = out->nsample;
    if (number > 0) nanosleep(&pause, NULL);
    if (!host_speed_now(r->hosts, r->comm, &b->before)) return real_lost(r, e);
    if (!burst(r, s, number, bursts, e)) return false;
    if (!host_speed_now(r->hosts, r->comm, &b->after)) return real_lost(r, e);
    b->n = out->nsample - first;
    out->nburst += b->n > 0;
    return true;
}

bool real_sample(struct real *r, const struct real_order *order, struct arena *a, struct err *e)
{
    struct real_result *out = r->out;
    struct sampling s = {.wanted = order->samples > 0 ? order->samples : SAMPLES,
                         .limit = order->seconds > 0 ? order->seconds : 5,
                         .fewest = INT64_MAX,
                         .begin_ns = real_facts(r, 0)[FACT_NOW]};
    s.most = s.wanted > MOST_SAMPLES / 8 ? MOST_SAMPLES : 8 * s.wanted;
    const size_t row = (size_t)r->nstage + 1;
    out->sample = TAKE(a, s.most, struct real_sample);
    s.faults = TAKE(a, s.most, int64_t);
    for (int i = 0; i < 2; i++) r->stage[i] = TAKE(a, size_product((size_t)s.most, row), double);
    if (order->bursts == 0) return burst(r, &s, 0, 1, e);
    int bursts = s.wanted / LEAST_BURST;
    if (bursts > order->bursts) bursts = order->bursts;
    if (bursts > REAL_BURSTS) bursts = REAL_BURSTS;
    if (bursts < 1) bursts = 1;
    /* A program so long that the time is up has been repeated often enough. */
    for (int i = 0; i < bursts && (i == 0 || elapsed(r, &s) <= s.limit); i++)
        if (!watched_burst(r, &s, i, bursts, e)) return false;
    return true;
}
