/* netcheck_ask.c - plays a case's messages on each level and compares times with the
 * reference's. */
#include "study/netcheck_ask.h"

#include <math.h>
#include <string.h>

#include "base/sorted.h"
#include "base/text.h"
#include "study/netcheck_case.h"

/* n + 1 elements: an arena gives no array of none. */
static double *cycles_of(const sim_ps *ps, int n, struct arena *a)
{
    double *x = TAKE(a, n + 1, double);
    for (int i = 0; i < n; i++) x[i] = (double)ps[i] / NETCHECK_CYCLE_PS;
    return x;
}

/* In an empty network each of `routers` routers takes the head `head` cycles, entry and exit
 * take `end`, and the rest of the message follows flit by flit:
 *     t = t_start + head routers + end + (flits - 1) */
double netcheck_empty(const struct netcheck_question *k, int m)
{
    /* Latencies are in seconds and a cycle is 1 ns (netcheck_case.h). */
    const struct network_spec *w = &k->machine.network;
    double cycle = NETCHECK_CYCLE_PS, head = round(w->hop_latency * 1e9),
           end = round(w->end_latency * 1e9);
    int routers = topology_distance(k->topology, k->q.src[m], k->q.dst[m]) + 1;
    double flits = (double)(k->q.bytes[m] / NETCHECK_FLIT_BYTES);
    return (double)k->q.time[m] / cycle + head * routers + end + fmax(flits, 1) - 1;
}

/* The mean of messages after the warm-up, as in the reference, which leaves out the first ones:
 * they meet an empty network. */
double netcheck_empty_latency(const struct netcheck_question *k)
{
    double sum = 0;
    int n = 0;
    for (int m = 0; m < k->q.nmessage; m++) {
        if (k->q.time[m] < k->warm) continue;
        sum += netcheck_empty(k, m) - (double)k->q.time[m] / NETCHECK_CYCLE_PS;
        n++;
    }
    return n > 0 ? sum / n + k->channel : 0;
}

/* ---- judging ---- */

/* Arrivals one by one. In a case with any_order, the reference says which times occur but not
 * which message has which: both are sorted, and compared as sets. */
static void compare_messages(const struct netcheck_question *k, const sim_ps *arrival,
                             struct netcheck_answer *answer)
{
    int n = k->q.nmessage;
    double *found = cycles_of(arrival, n, k->arena), *reference = TAKE(k->arena, n + 1, double),
           sum = 0;
    /* A copy: sorting must not change the case's own list. */
    memcpy(reference, k->arrival, (size_t)n * sizeof *reference);
    if (k->any_order) {
        sort_numbers(found, (size_t)n);
        sort_numbers(reference, (size_t)n);
    }
    for (int i = 0; i < n; i++) {
        /* The error of an arrival at 0 is absolute: at least a cycle in the denominator. */
        double error = fabs(found[i] - reference[i]) / fmax(reference[i], 1);
        /* Equal means within a thousandth of a cycle, 1 ps. */
        answer->differing += fabs(found[i] - reference[i]) > 1e-3;
        answer->message_worst = fmax(answer->message_worst, error);
        sum += error;
    }
    answer->message_error = n > 0 ? sum / n : 0;
}

/* Whether packet i was born after the warm-up, and in the sample. */
static bool in_sample(const struct netcheck_question *k, int i)
{
    return k->q.time[i] >= k->warm && (k->until == 0 || k->q.time[i] < k->until);
}

/* The latency that the reference calls "plat": from the creation of a packet to its arrival,
 * queueing at the source included, plus what its long channels take (`channel`). */
static double mean_latency(const struct netcheck_question *k, const sim_ps *arrival)
{
    double sum = 0;
    int64_t n = 0;
    for (int i = 0; i < k->q.nmessage; i++) {
        if (!in_sample(k, i)) continue;
        sum += (double)(arrival[i] - k->q.time[i]) / NETCHECK_CYCLE_PS;
        n++;
    }
    return n > 0 ? sum / (double)n + k->channel : 0;
}

static sim_ps last_arrival(const struct netcheck_question *k, const sim_ps *arrival)
{
    sim_ps last = 0;
    for (int i = 0; i < k->q.nmessage; i++)
        if (in_sample(k, i) && arrival[i] > last) last = arrival[i];
    return last;
}

/* Relative error against the band low .. high: 0 inside, else to its nearer end. A case with one
 * answer has low = high. */
double netcheck_error(const struct netcheck_row *row, double found)
{
    /* the point of the band that is closest to the answer */
    double nearest = fmin(fmax(found, row->low), row->high);
    return nearest > 0 ? (found - nearest) / nearest : 0;
}

/* The answer of one level from its run. Deadlocks are compared first: where one is expected,
 * only its presence counts; elsewhere a deadlock is an error of 100 %. */
static void judge(const struct netcheck_question *k, const struct traffic_result *r,
                  enum network_level level)
{
    const struct netcheck_row *row = k->row;
    struct netcheck_answer *answer = &k->row->answer[level];
    /* These levels have no buffers: that they do not deadlock is no finding. */
    if (row->expect_deadlock && (level == LEVEL_LOGGP || level == LEVEL_LINK)) {
        text_copy(answer->why, sizeof answer->why, "without buffers nothing blocks");
        return;
    }
    answer->ran = true;
    answer->events = r->events;
    answer->deadlock = r->deadlock;
    if (r->deadlock || row->expect_deadlock) {
        answer->found = r->deadlock ? NAN : (double)r->makespan / NETCHECK_CYCLE_PS;
        answer->error = r->deadlock == row->expect_deadlock ? 0 : 1;
        text_copy(answer->why, sizeof answer->why, r->text);
        return;
    }
    /* A played row has no reference, so it keeps the arrivals; another is judged at once. */
    answer->found =
        k->latency ? mean_latency(k, r->arrival) : (double)r->makespan / NETCHECK_CYCLE_PS;
    if (row->played) answer->arrival = cycles_of(r->arrival, k->q.nmessage, k->rows);
    else answer->error = netcheck_error(row, answer->found);
    if (row->compared) compare_messages(k, r->arrival, answer);
}

/* ---- asking ---- */

/* Cut-through is for packets that fit the buffers. Without packet_bytes our levels cut a longer
 * message into pieces of a buffer's size, which the reference's routers do not do: no comparison.
 */
static bool fits_buffers(const struct netcheck_question *k, enum network_level level,
                         struct netcheck_answer *answer)
{
    if ((level != LEVEL_PACKET && level != LEVEL_AUTO) || !k->row->worms) return true;
    snprintf(answer->why, sizeof answer->why, "its packets do not fit buffers of %d flits",
             k->machine.network.buffer_flits);
    return false;
}

/* What a message is on these levels: cut into packets, of which one may be longer than a buffer
 * and then hold several buffers at once (a worm). */
static void sizes_of(struct netcheck_question *k)
{
    const struct network_spec *w = &k->machine.network;
    /* The longest message decides for the whole list. */
    int64_t longest = 0;
    for (int m = 0; m < k->q.nmessage; m++)
        if (k->q.bytes[m] > longest) longest = k->q.bytes[m];
    k->row->cuts = w->packet_bytes > 0 && longest > w->packet_bytes;
    if (k->row->cuts) longest = w->packet_bytes;
    k->row->worms = longest > w->buffer_flits * w->flit_bytes;
    k->row->nmessage = k->q.nmessage;
}

/* One run of the list at `level`. Arrivals in scratch memory of n + 1 elements. */
static bool play(struct netcheck_question *k, enum network_level level, struct traffic_result *r,
                 struct err *e)
{
    /* traffic_run fills the arrivals of all messages. */
    *r = (struct traffic_result){.arrival = TAKE(k->arena, k->q.nmessage + 1, sim_ps)};
    err_clear(e);
    k->machine.network.level = level;
    return traffic_run(&k->q, &k->machine, k->topology, k->arena, false, r, e);
}

void netcheck_unanswered(struct netcheck_row *row, const char *why)
{
    for (int l = 0; l < LEVELS; l++) text_copy(row->answer[l].why, sizeof row->answer[l].why, why);
}

/* Each level wanted answers the same question; k->machine is changed for it and nothing else. */
void netcheck_ask(struct netcheck_question *k)
{
    struct err e;
    struct traffic_result r;
    sizes_of(k);
    for (int l = 0; l < LEVELS; l++) {
        struct netcheck_answer *answer = &k->row->answer[l];
        if (!k->n->level[l] || !fits_buffers(k, (enum network_level)l, answer)) continue;
        struct arena_mark mark = arena_mark(k->arena);
        /* A level that cannot run the case says why; that is no error of the file. */
        if (play(k, (enum network_level)l, &r, &e)) judge(k, &r, (enum network_level)l);
        else text_copy(answer->why, sizeof answer->why, e.text);
        arena_release(k->arena, mark);
    }
}

bool netcheck_mean(struct netcheck_question *k, enum network_level level, double *latency)
{
    struct err e;
    struct traffic_result r;
    struct netcheck_answer *answer = &k->row->answer[level];
    struct arena_mark mark = arena_mark(k->arena);
    sizes_of(k);
    bool done = fits_buffers(k, level, answer);
    if (done) {
        done = play(k, level, &r, &e);
        if (!done) text_copy(answer->why, sizeof answer->why, e.text);
    }
    if (done) {
        answer->events += r.events;
        answer->deadlock = r.deadlock;
        done = !r.deadlock;
        if (!done) text_copy(answer->why, sizeof answer->why, r.text);
    }
    if (done) {
        *latency = mean_latency(k, r.arrival);
        k->last = last_arrival(k, r.arrival);
    }
    arena_release(k->arena, mark);
    return done;
}

/* ---- saturation: the load at which the mean latency is three times the empty network's ---- */

enum { SATURATION_CYCLES = 10000, SATURATION_SEED = 1 };
static const double criterion = 3, step = 1.05, finest = 0.01;

/* Whether the mean latency at `load` is `criterion` times that of the empty network: 1 or 0; -1:
 * the level cannot say, and the answer has the reason. */
static int saturated(struct netcheck_question *k, enum network_level level, const char *pattern,
                     int flits, double load, struct netcheck_answer *answer)
{
    struct err e;
    struct traffic_result r;
    struct arena_mark mark = arena_mark(k->arena);
    int verdict = -1;
    err_clear(&e);
    if (netcheck_load(pattern, k->topology, flits, load, SATURATION_CYCLES, SATURATION_SEED,
                      k->arena, &k->q, &e)) {
        /* The first quarter is warm-up. */
        k->warm = (sim_ps)(SATURATION_CYCLES / 4) * NETCHECK_CYCLE_PS;
        sizes_of(k);
        if (fits_buffers(k, level, answer) && play(k, level, &r, &e)) {
            /* A network in deadlock is saturated. */
            verdict =
                r.deadlock || mean_latency(k, r.arrival) >= criterion * netcheck_empty_latency(k);
            answer->events += r.events;
        }
    }
    if (e.kind != ERR_NONE) text_copy(answer->why, sizeof answer->why, e.text);
    arena_release(k->arena, mark);
    return verdict;
}

/* Bisection from the reference's bracket: outwards in steps of 5 % while the answer is the same,
 * then halves until the bracket is 1 % wide. A load of 1 flit per node and cycle is the most
 * there is. */
static void ask_one_saturation(struct netcheck_question *k, enum network_level level,
                               const char *pattern, int flits)
{
    struct netcheck_answer *answer = &k->row->answer[level];
    double below = k->row->low, above = k->row->high;
    int s;
    /* Saturated already at the lower end: go down, but at most to an eighth of it. */
    while ((s = saturated(k, level, pattern, flits, below, answer)) == 1 &&
           below > k->row->low / 8) {
        above = below;
        below /= step;
    }
    if (s < 0) return;
    /* Not saturated at the upper end: go up. */
    while (below >= k->row->low && above <= 1 &&
           (s = saturated(k, level, pattern, flits, above, answer)) == 0) {
        below = above;
        above *= step;
    }
    if (s < 0) return;
    /* Halve only a bracket that left the reference's: inside, the error is 0 whatever the value. */
    while (above - below > finest * below && (below < k->row->low || below >= k->row->high)) {
        double middle = (below + above) / 2;
        if (saturated(k, level, pattern, flits, fmin(middle, 1), answer) == 1) above = middle;
        else below = middle;
    }
    answer->ran = true;
    answer->found = fmin((below + above) / 2, 1);
    answer->error = netcheck_error(k->row, answer->found);
}

/* loggp has no contention at all: its latency does not depend on the load. */
void netcheck_ask_saturation(struct netcheck_question *k, const char *pattern, int flits)
{
    for (int l = 0; l < LEVELS; l++) {
        if (l == LEVEL_LOGGP)
            text_copy(k->row->answer[l].why, sizeof k->row->answer[l].why,
                      "without contention nothing saturates");
        else if (k->n->level[l]) ask_one_saturation(k, (enum network_level)l, pattern, flits);
    }
}
