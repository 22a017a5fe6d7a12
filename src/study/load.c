/* load.c - one point of a load curve: messages made, played, cut to the steady state, summed up.
 *
 * Everything of a point depends on its question alone, so points may be measured in any order and
 * by several threads. */
#include "study/load.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/picoseconds.h"
#include "base/progress.h"
#include "base/sorted.h"
#include "base/text.h"
#include "machine/placement.h"
#include "study/steady.h"

/* Of the first run of a point: messages that are made, and how often the latency of the empty
 * network fits into it. Draws where not all pairs can be taken. */
enum { FIRST_MESSAGES = 6000, FIRST_LATENCIES = 60, LEAST_LATENCIES = 10, DRAWS = 1 << 16 };

/* Part of a run whose messages are measured; the traffic goes on behind them. */
static const double measured_part = 0.75;

/* Batch means that are more alike than this are lengthened: two standard errors of an
 * autocorrelation of STEADY_BATCHES values, 2 / sqrt(20). */
static const double most_lag = 0.45;

/* ---- the messages */

/* The recorded run again and again, so much faster or slower that it offers `load`. */
static void repeat(const struct load_question *q, double load, sim_ps length, struct arena *a,
                   struct traffic *t)
{
    const struct load_recording *r = q->recording;
    const double slower = r->load / load, period = (double)r->period * slower;
    int64_t most = (int64_t)(ceil((double)length / period) + 1) * r->nmessage;
    *t = (struct traffic){.nmessage = 0};
    t->src = TAKE_FULL(a, most, int, true);
    t->dst = TAKE_FULL(a, most, int, true);
    t->bytes = TAKE_FULL(a, most, int64_t, true);
    t->time = TAKE_FULL(a, most, sim_ps, true);
    for (int64_t k = 0; k < most; k++) {
        int m = (int)(k % r->nmessage), n = t->nmessage;
        double at = (double)(k / r->nmessage) * period + (double)r->time[m] * slower;
        if (at >= (double)length) continue;
        t->src[n] = r->src[m];
        t->dst[n] = r->dst[m];
        t->bytes[n] = r->bytes[m];
        t->time[n] = (sim_ps)at;
        t->nmessage++;
    }
}

/* Messages per cycle of all nodes together, in the mean. */
static double rate_of(const struct load_question *q, double offered)
{
    const struct load_recording *r = q->recording;
    if (r) return offered / r->load * r->nmessage * q->cycle_ps / (double)r->period;
    return offered / q->flits * q->topology->nnode;
}

static bool make_messages(const struct load_question *q, double offered, int64_t cycles,
                          struct arena *a, struct traffic *t, struct err *e)
{
    const struct pattern_load l = {.load = offered,
                                   .flits = q->flits,
                                   .bytes = q->bytes,
                                   .cycle_ps = q->cycle_ps,
                                   .cycles = cycles,
                                   .seed = q->seed,
                                   .most = LOAD_MOST_MESSAGES};
    if (q->recording) repeat(q, offered, (sim_ps)((double)cycles * q->cycle_ps), a, t);
    else if (!pattern_traffic(&q->pattern, &l, a, t, e)) return false;
    t->stop = (sim_ps)((double)cycles * q->cycle_ps);
    return true;
}

/* ---- one run */

/* A message by its creation. */
struct created {
    sim_ps time;
    int message;
};

static int by_creation(const void *a, const void *b)
{
    const struct created *x = a, *y = b;
    if (x->time != y->time) return x->time < y->time ? -1 : 1;
    return x->message < y->message ? -1 : 1;
}

/* What one run of T cycles says. */
struct attempt {
    int64_t n;       /* messages created in the measured part */
    int64_t late;    /* of them, not arrived at the end */
    double *latency; /* (n) in the order of creation; only where none is late */
    sim_ps *created; /* (n) */
    sim_ps length;
    bool deadlock;
    char text[160];
    struct steady steady; /* where none is late and n suffices */
    bool judged;
};

/* Messages of the measured part in the order of creation. */
static void sort_out(const struct traffic *t, const sim_ps *arrival, struct attempt *x,
                     struct arena *a)
{
    struct created *list = TAKE_FULL(a, t->nmessage + 1, struct created, true);
    const sim_ps end = (sim_ps)(measured_part * (double)x->length);
    for (int m = 0; m < t->nmessage; m++) {
        if (t->time[m] >= end) continue;
        list[x->n++] = (struct created){t->time[m], m};
        x->late += arrival[m] > x->length;
    }
    qsort(list, (size_t)x->n, sizeof *list, by_creation);
    x->latency = TAKE_FULL(a, x->n + 1, double, true);
    x->created = TAKE_FULL(a, x->n + 1, sim_ps, true);
    for (int64_t i = 0; i < x->n; i++) {
        x->created[i] = list[i].time;
        x->latency[i] = (double)(arrival[list[i].message] - list[i].time);
    }
}

/* Flits of a message, of a pattern all alike. */
static double flits_of(const struct load_question *q, const struct traffic *t, int m)
{
    if (!q->recording) return q->flits;
    return fmax(1, ceil((double)t->bytes[m] * q->flits / (double)q->bytes));
}

/* What was created and what was delivered from `from` to the end, per node and cycle. */
static void sum_flits(const struct load_question *q, const struct traffic *t, const sim_ps *arrival,
                      sim_ps from, sim_ps to, struct load_point *p)
{
    double created = 0, accepted = 0, span = (double)(to - from) / q->cycle_ps * q->nodes;
    for (int m = 0; m < t->nmessage; m++) {
        double flits = flits_of(q, t, m);
        if (t->time[m] >= from && t->time[m] < to) created += flits;
        if (arrival[m] >= from && arrival[m] < to) accepted += flits;
    }
    p->created = created / span;
    p->accepted = accepted / span;
}

/* Run T cycles at `offered`; *p gets what holds whether there is a steady state or not. */
static bool run_once(const struct load_question *q, double offered, int64_t cycles, struct arena *a,
                     struct attempt *x, struct load_point *p, struct err *e)
{
    struct traffic t;
    *x = (struct attempt){.n = 0};
    if (!make_messages(q, offered, cycles, a, &t, e)) return false;
    struct traffic_result r = {.arrival = TAKE_FULL(a, t.nmessage + 1, sim_ps, true)};
    x->length = t.stop;
    if (!traffic_run(&t, q->machine, q->topology, a, false, &r, e)) return false;
    p->events += r.events;
    x->deadlock = r.deadlock;
    text_copy(x->text, sizeof x->text, r.text);
    sort_out(&t, r.arrival, x, a);
    x->judged = !r.deadlock && x->late == 0 && x->n >= STEADY_LEAST;
    if (x->judged) x->steady = steady_state(x->latency, x->n);
    /* Without a steady state the second half of the run says what gets through. */
    sim_ps from = x->judged ? x->created[x->steady.warmup] : x->length / 2;
    sum_flits(q, &t, r.arrival, from, x->length, p);
    p->warmup_ps = from;
    p->length_ps = x->length;
    p->messages = x->judged ? x->n - x->steady.warmup : x->n;
    return true;
}

/* ---- a point */

/* Mean and quantiles of what the warm-up leaves. */
static void fill_latency(struct attempt *x, struct load_point *p)
{
    double *from = x->latency + x->steady.warmup;
    const int64_t n = x->n - x->steady.warmup;
    p->mean_ps = x->steady.mean;
    p->half_ps = x->steady.half;
    p->lag = x->steady.lag;
    sort_numbers(from, (size_t)n);
    p->p50_ps = (int64_t)steady_quantile(from, n, 0.5);
    p->p99_ps = (int64_t)steady_quantile(from, n, 0.99);
    p->max_ps = (int64_t)from[n - 1];
}

/* Whether the mean still rises: MSER-5 finds no end of the warm-up, or the batch means have a
 * slope that chance does not explain. */
static bool is_rising(const struct steady *s) { return !s->settled || s->trend > s->trend_99; }

/* Whether the run says what is asked: closely enough, or, of a probe, on which side of saturation
 * the mean lies. */
static bool is_enough(const struct load_question *q, const struct attempt *x, bool probe)
{
    const struct steady *s = &x->steady;
    if (!x->judged || is_rising(s) || s->lag > most_lag) return false;
    return s->half <= q->within * s->mean ||
           (probe && fabs(s->mean - LOAD_CRITERION * q->empty_ps) > s->half);
}

double load_least_messages(const struct load_question *q, double offered)
{
    return LEAST_LATENCIES * q->empty_ps / q->cycle_ps * rate_of(q, offered);
}

/* The length of the first run: enough messages, and time enough for them to get through; no more
 * messages than are permitted. */
static bool first_length(const struct load_question *q, double offered, double *cycles,
                         struct err *e)
{
    const double rate = rate_of(q, offered), crossing = q->empty_ps / q->cycle_ps;
    double least = LEAST_LATENCIES * crossing;
    *cycles = ceil(fmax(FIRST_LATENCIES * crossing, FIRST_MESSAGES / rate));
    /* a recorded run is looked at for some of its periods */
    if (q->recording)
        *cycles = fmax(*cycles, 4 * (double)q->recording->period * q->recording->load / offered /
                                    q->cycle_ps);
    if (*cycles * rate > q->most) *cycles = floor(q->most / rate);
    if (*cycles < least)
        return err_set(e, ERR_CONFIG,
                       "load %g needs at least %.0f messages, to cross the network %d times; at "
                       "most %d are allowed: allow more (--messages), or ask for larger ones "
                       "(--size) or lower loads",
                       offered, ceil(load_least_messages(q, offered)), LEAST_LATENCIES, q->most);
    if (*cycles * q->cycle_ps > (double)PS_LAST / 4)
        return err_set(e, ERR_CONFIG, "load %g takes longer than the largest simulated time",
                       offered);
    return true;
}

/* What the last run came to. Latencies that rise far below those of saturation are of a run that is
 * too short: a queue that is nearly always busy takes 1 / (1 - load)^2 services to settle, and
 * accepts all that is offered. */
static void finish(const struct load_question *q, struct attempt *x, bool enough,
                   struct load_point *p)
{
    const double beyond = LOAD_CRITERION * q->empty_ps - x->steady.mean;
    const bool rising = x->judged && is_rising(&x->steady);
    p->mean_ps = p->half_ps = p->lag = NAN;
    p->p50_ps = p->p99_ps = p->max_ps = -1;
    p->status = x->deadlock                             ? LOAD_DEADLOCK
                : !x->judged || (rising && beyond <= 0) ? LOAD_UNSTABLE
                : enough                                ? LOAD_OK
                                                        : LOAD_WIDE;
    if (p->status == LOAD_DEADLOCK) text_copy(p->text, sizeof p->text, x->text);
    if (p->status == LOAD_OK || p->status == LOAD_WIDE) fill_latency(x, p);
    if (p->status == LOAD_WIDE && rising) p->half_ps = fmax(p->half_ps, beyond);
}

bool load_measure(const struct load_question *q, double offered, bool probe, struct load_point *p,
                  struct err *e)
{
    *p = (struct load_point){.offered = offered, .probe = probe};
    double cycles, start = host_processor_seconds();
    if (!first_length(q, offered, &cycles, e)) return false;
    struct arena *a = arena_create();
    struct attempt x;
    bool ok = true, enough = false;
    int stuck = 0;
    for (bool last = false; ok && !last; cycles *= 2) {
        struct arena_mark mark = arena_mark(a);
        ok = run_once(q, offered, (int64_t)cycles, a, &x, p, e);
        /* Messages that take a quarter of the run are a backlog, if they are many or a run twice as
         * long has them, too. */
        stuck = x.late > x.n / 10 ? 2 : x.late > 0 ? stuck + 1 : 0;
        enough = ok && is_enough(q, &x, probe);
        last =
            !ok || enough || x.deadlock || stuck >= 2 || 2 * cycles * rate_of(q, offered) > q->most;
        if (last && ok) finish(q, &x, enough, p);
        arena_release(a, mark);
    }
    arena_destroy(a);
    p->host_s = host_processor_seconds() - start;
    return ok;
}

/* ---- the facts of a series */

/* A message of the pattern by its number: every pair once where they are few. */
static void pair_of(const struct load_question *q, int64_t k, int64_t total, struct random *r,
                    struct net_message *m)
{
    const int nnode = q->topology->nnode;
    const struct load_recording *rec = q->recording;
    *m = (struct net_message){.bytes = q->bytes, .id = k};
    if (rec) {
        m->src = rec->src[k % rec->nmessage];
        m->dst = rec->dst[k % rec->nmessage];
        m->bytes = rec->bytes[k % rec->nmessage];
        return;
    }
    m->src = (int)(total >= nnode ? k % nnode : (int64_t)random_below(r, (uint64_t)nnode));
    bool every = q->pattern.rule == PATTERN_UNIFORM && total == (int64_t)nnode * nnode;
    m->dst = every ? (int)(k / nnode) : pattern_destination(&q->pattern, m->src, r);
}

/* Mean latency of the empty network, over all pairs or over drawn ones. */
static double empty_latency(const struct load_question *q, const struct net *n)
{
    const int64_t nnode = q->topology->nnode;
    bool chance = !q->topology->fixed_routes || q->pattern.rule == PATTERN_BAD_GROUP;
    int64_t all = q->recording                         ? q->recording->nmessage
                  : q->pattern.rule == PATTERN_UNIFORM ? nnode * nnode
                                                       : nnode,
            total = chance || all > DRAWS ? DRAWS : all;
    struct random r = random_make(q->seed, 0x656d7074, 0); /* "empt" */
    double sum = 0;
    for (int64_t k = 0; k < total; k++) {
        struct net_message m;
        pair_of(q, k, total, &r, &m);
        sum += (double)net_zero_load_of(n, &m);
    }
    return sum / (double)total;
}

/* Of recorded messages: how long one is in the mean, and what they offer. */
static void sum_recording(struct load_question *q, struct load_recording *r, const struct net *n,
                          struct load_series *s)
{
    double flits = 0, bytes = 0;
    for (int m = 0; m < r->nmessage; m++) {
        flits += (double)net_flits(n, r->bytes[m]);
        bytes += (double)r->bytes[m];
    }
    r->load = flits * q->cycle_ps / ((double)r->period * q->nodes);
    snprintf(s->note, sizeof s->note, "as recorded: load %.4g", r->load);
    s->flits = flits / r->nmessage;
    /* sums of flits are taken by bytes */
    q->bytes = bytes > 0 ? (int64_t)bytes : 1;
    q->flits = (int)fmin(flits, INT32_MAX);
}

/* Ranks become the nodes that the machine's placement gives them. */
static bool place_ranks(struct load_question *q, struct load_recording *r, struct arena *a,
                        struct err *e)
{
    struct placement p;
    if (!placement_create(&p, q->machine, q->topology, r->nrank, a, e)) return false;
    bool *used = TAKE(a, q->topology->nnode, bool);
    q->nodes = 0;
    for (int i = 0; i < r->nrank; i++) {
        q->nodes += !used[p.node[i]];
        used[p.node[i]] = true;
    }
    for (int m = 0; m < r->nmessage; m++) {
        r->src[m] = p.node[r->src[m]];
        r->dst[m] = p.node[r->dst[m]];
    }
    return true;
}

/* Nobody listens: the net is made for what it knows of the machine. */
static void deliver_nothing(void *context, struct net_message *m) { (void)context, (void)m; }

bool load_begin(struct load_question *q, struct load_recording *recording, struct load_series *s,
                struct arena *keep, struct err *e)
{
    q->topology = topology_create(&q->machine->topology, keep, e);
    if (!q->topology ||
        (!recording && !pattern_read(&q->pattern, q->traffic, q->topology, keep, e)))
        return false;
    q->nodes = q->topology->nnode;
    if (recording && !place_ranks(q, recording, keep, e)) return false;
    /* The net is made for what it knows of the machine, and goes with all that it used. */
    struct arena *a = arena_create();
    struct sim *sim = sim_create();
    struct net *n = net_create(q->machine, q->topology, sim, a, deliver_nothing, NULL, false, e);
    q->recording = recording;
    if (n) {
        q->cycle_ps = net_flit_ps(n);
        if (recording) sum_recording(q, recording, n, s);
        else s->flits = q->flits = (int)net_flits(n, q->bytes);
        q->empty_ps = empty_latency(q, n);
        double most = recording ? 0
                                : pattern_channel_load(&q->pattern, q->topology, 64,
                                                       q->machine->network.link_bandwidth, a);
        s->nodes = q->nodes;
        s->bytes = recording ? 0 : q->bytes;
        s->cycle_ps = q->cycle_ps;
        s->empty_ps = q->empty_ps;
        s->bound = most > 0 ? 1 / most : NAN;
        s->saturation = s->low = s->high = NAN;
    }
    sim_destroy(sim);
    arena_destroy(a);
    return n != NULL;
}
