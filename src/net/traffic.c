/* traffic.c - replay of message lists: starts what is ready, counts down dependencies as messages
 * arrive.
 *
 * Messages without dependencies are started one event ahead, in the order (time, number), so that
 * the queue holds what is in the network and not the whole list. The same lists drive flit-level
 * reference simulators, so that levels can be compared message by message (docs/network.md 4). */
#include "net/traffic.h"

#include <string.h>

#include "base/check.h"
#include "base/picoseconds.h"
#include "net/net_clocked.h"

/* A message under way, or one that waits for the next to start. */
struct under_way {
    struct net_message message; /* first: what a level gives back */
    struct under_way *next;
};

struct replay {
    const struct traffic *q;
    struct net *net;
    struct sim *sim;
    struct arena *arena;
    struct under_way *free; /* records that are not in use */
    sim_ps *ready;          /* (nmessage) latest of time and arrivals + delay so far */
    int *waits;             /* (nmessage) dependencies that have not arrived */
    int *out_first, *out;   /* who depends on m */
    int *initial;           /* messages without dependencies by (time, number) */
    int ninitial, next_initial;
    bool ahead;   /* arrivals are told before their time (net_gather) */
    bool gathers; /* messages of one instant start in one event */
    bool late;    /* an arrival after q->stop was told before its time */
    struct traffic_result *result;
};

static void start_message(void *subject, uint64_t argument, sim_ps now);

static void start_at(struct replay *r, int m)
{
    sim_at(r->sim, r->ready[m], NET_LANE_START, (uint64_t)m, start_message, r, (uint64_t)m);
}

/* Few messages are under way at a time: their records stay in the cache, where those of all would
 * not. */
static void send(struct replay *r, int m, sim_ps now)
{
    enum { CHUNK = 64 };
    if (!r->free) {
        struct under_way *chunk = TAKE(r->arena, CHUNK, struct under_way);
        for (int i = 0; i < CHUNK; i++) {
            chunk[i].next = r->free;
            r->free = &chunk[i];
        }
    }
    struct under_way *w = r->free;
    r->free = w->next;
    w->message = (struct net_message){
        .src = r->q->src[m], .dst = r->q->dst[m], .bytes = r->q->bytes[m], .id = m, .ready = now};
    net_send(r->net, &w->message);
}

static void start_message(void *subject, uint64_t argument, sim_ps now)
{
    struct replay *r = subject;
    int m = (int)argument;
    /* This start releases the next one in the list: one event pending at a time. Those of the same
     * instant need none, unless one that waited for others may come between them. */
    while (r->next_initial < r->ninitial && r->initial[r->next_initial - 1] == m) {
        const int next = r->initial[r->next_initial++];
        if (!r->gathers || r->ready[next] != now) {
            start_at(r, next);
            break;
        }
        send(r, m, now);
        m = next;
    }
    send(r, m, now);
}

static void message_arrived(void *context, struct net_message *msg)
{
    struct replay *r = context;
    struct traffic_result *out = r->result;
    int m = (int)msg->id;
    struct under_way *w = (struct under_way *)(void *)msg;
    w->next = r->free;
    r->free = w;
    /* Told ahead of time what is not simulated. */
    if (r->ahead && r->q->stop > 0 && msg->arrival > r->q->stop) {
        r->late = true;
        return;
    }
    if (r->ahead && msg->arrival > PS_LAST) return;
    out->arrived++;
    if (msg->arrival > out->makespan) out->makespan = msg->arrival;
    if (out->arrival) out->arrival[m] = msg->arrival;
    if (out->injected) out->injected[m] = msg->injected;
    if (out->uncontended) out->uncontended[m] = msg->uncontended;
    if (!r->out_first) return;
    /* Dependents start at the latest arrival plus their delay, when the last of their dependencies
     * has arrived. */
    for (int i = r->out_first[m]; i < r->out_first[m + 1]; i++) {
        int later = r->out[i];
        sim_ps ready = msg->arrival + r->q->delay[later];
        if (ready > r->ready[later]) r->ready[later] = ready;
        if (--r->waits[later] == 0) start_at(r, later);
    }
}

static bool traffic_check(const struct traffic *q, const struct topology *t, struct err *e)
{
    for (int m = 0; m < q->nmessage; m++) {
        if (q->src[m] < 0 || q->src[m] >= t->nnode || q->dst[m] < 0 || q->dst[m] >= t->nnode)
            return err_set(e, ERR_DATA,
                           "message %d goes from node %d to node %d; the network has nodes 0 to %d",
                           m, q->src[m], q->dst[m], t->nnode - 1);
        if (q->bytes[m] < 0 || q->time[m] < 0 || (q->delay && q->delay[m] < 0))
            return err_set(e, ERR_DATA, "message %d has a negative size, time or delay", m);
        if (!q->dep_first) continue;
        for (int i = q->dep_first[m]; i < q->dep_first[m + 1]; i++)
            if (q->dep[i] < 0 || q->dep[i] >= q->nmessage || q->dep[i] == m)
                return err_set(
                    e, ERR_DATA,
                    "message %d depends on message %d, which does not exist or is itself", m,
                    q->dep[i]);
    }
    return true;
}

/* The inverse of the dependencies, and how many each message waits for. Counting sort; the offset
 * by two lets the same array serve as running sums and as write positions. */
static void dependents_make(struct replay *r, struct arena *a)
{
    const struct traffic *q = r->q;
    int n = q->nmessage;
    r->waits = TAKE_FULL(a, n + 1, int, true);
    if (!q->dep_first) return;
    r->out_first = TAKE(a, n + 2, int);
    r->out = TAKE(a, q->dep_first[n] + 1, int);
    for (int i = 0; i < q->dep_first[n]; i++) r->out_first[q->dep[i] + 2]++;
    for (int m = 0; m < n; m++) r->out_first[m + 2] += r->out_first[m + 1];
    for (int m = 0; m < n; m++) {
        r->waits[m] = q->dep_first[m + 1] - q->dep_first[m];
        for (int i = q->dep_first[m]; i < q->dep_first[m + 1]; i++)
            r->out[r->out_first[q->dep[i] + 1]++] = m;
    }
}

/* list[n] by `time`, of equal times in the order in which it is; swap[n] is scratch. Digit by
 * digit, the lowest first: linear in n, where comparing would cost as much as playing the message.
 * Returns the one of both that has the result. */
static int *sort_by_time(int *list, int *swap, int n, const sim_ps *time)
{
    enum { BITS = 11, DIGITS = 1 << BITS };
    sim_ps all = 0;
    for (int i = 0; i < n; i++) all |= time[list[i]];
    for (int shift = 0; shift < 63 && all >> shift; shift += BITS) {
        int place[DIGITS + 1] = {0};
        for (int i = 0; i < n; i++) place[(time[list[i]] >> shift & (DIGITS - 1)) + 1]++;
        for (int d = 0; d < DIGITS; d++) place[d + 1] += place[d];
        for (int i = 0; i < n; i++) swap[place[time[list[i]] >> shift & (DIGITS - 1)]++] = list[i];
        int *sorted = swap;
        swap = list;
        list = sorted;
    }
    return list;
}

static void initial_make(struct replay *r, struct arena *a)
{
    int n = r->q->nmessage;
    int *list = TAKE_FULL(a, n + 1, int, true), *swap = TAKE_FULL(a, n + 1, int, true);
    for (int m = 0; m < n; m++)
        if (r->waits[m] == 0) list[r->ninitial++] = m;
    r->initial = sort_by_time(list, swap, r->ninitial, r->q->time);
}

/* What never arrives keeps SIM_NEVER. */
static void result_clear(const struct replay *r)
{
    const struct traffic_result *out = r->result;
    for (int m = 0; m < r->q->nmessage; m++) {
        if (out->arrival) out->arrival[m] = SIM_NEVER;
        if (out->injected) out->injected[m] = SIM_NEVER;
        if (out->uncontended) out->uncontended[m] = SIM_NEVER;
    }
}

static void replay_make(struct replay *r, struct arena *a)
{
    const struct traffic *q = r->q;
    int n = q->nmessage;
    r->arena = a;
    r->ready = TAKE_FULL(a, n + 1, sim_ps, true);
    for (int m = 0; m < n; m++) r->ready[m] = q->time[m];
    dependents_make(r, a);
    initial_make(r, a);
}

/* Whether what comes next is later than anybody wants to know: what is left is then under way, not
 * stuck. */
static bool is_over(const struct replay *r)
{
    return r->q->stop > 0 && sim_pending(r->sim) > 0 && sim_next_time(r->sim) > r->q->stop;
}

/* The list in cycles, where it and the network are of that kind (net_clocked.h). */
static bool replay_clocked(const struct replay *r, bool want_links)
{
    const struct traffic *q = r->q;
    struct traffic_result *out = r->result;
    /* What would have been without others is told by the levels alone. */
    if (q->singly || q->dep_first || want_links || out->uncontended) return false;
    const struct clocked_list list = {.count = q->nmessage,
                                      .src = q->src,
                                      .dst = q->dst,
                                      .bytes = q->bytes,
                                      .time = q->time,
                                      .order = r->initial,
                                      .stop = q->stop};
    result_clear(r);
    struct clocked_result c = {.arrival = out->arrival, .injected = out->injected};
    if (!net_clocked(r->net, &list, &c)) return false;
    out->arrived = c.arrived;
    out->makespan = c.makespan;
    out->events = c.events;
    out->digest = c.digest;
    out->link = NULL;
    out->nlink = 0;
    out->deadlock = false;
    out->clocked = true;
    return true;
}

static void replay_run(struct replay *r, struct arena *a)
{
    struct traffic_result *out = r->result;
    /* Also of a list that was given up in the middle of its cycles. */
    result_clear(r);
    if (r->ninitial > 0) start_at(r, r->initial[r->next_initial++]);
    bool stopped = false;
    while (!(stopped = is_over(r)) && sim_step(r->sim)) continue;
    out->events = sim_events(r->sim);
    out->digest = sim_digest(r->sim);
    out->link = net_links(r->net, 0, a, &out->nlink);
    /* No event left and messages missing, but for those that only the end of the list cuts off: the
     * net names its cycle, or the list itself is circular. */
    out->deadlock = !stopped && !r->late && out->arrived < r->q->nmessage;
    if (out->deadlock && !net_deadlock(r->net, out->text, (int)sizeof out->text))
        strcpy(out->text, "messages wait for each other");
}

/* Asked before any is sent: a replay has no other way to fail. */
static bool all_taken(const struct net *n, const struct traffic *q, struct err *e)
{
    char why[256];
    for (int m = 0; m < q->nmessage; m++) {
        if (m > 0 && q->bytes[m] == q->bytes[m - 1]) continue;
        if (!net_takes(n, q->bytes[m], why, sizeof why)) return err_set(e, ERR_DATA, "%s", why);
    }
    return true;
}

/* The simulation is made and destroyed here; everything else lives in the caller's arena. */
bool traffic_run(const struct traffic *q, const struct machine_spec *m, const struct topology *t,
                 struct arena *a, bool want_links, struct traffic_result *out, struct err *e)
{
    if (!traffic_check(q, t, e)) return false;
    out->makespan = 0;
    out->arrived = 0;
    out->clocked = false;
    out->text[0] = '\0';
    struct replay r = {.q = q, .sim = sim_create(), .result = out};
    r.net = net_create(m, t, r.sim, a, message_arrived, &r, want_links, e);
    if (r.net && !all_taken(r.net, q, e)) r.net = NULL;
    if (r.net) {
        replay_make(&r, a);
        if (!replay_clocked(&r, want_links)) {
            r.ahead = !q->singly && net_gather(r.net);
            /* Messages that wait for others start in the order of events. */
            r.gathers = r.ahead && !q->dep_first;
            replay_run(&r, a);
        }
    }
    sim_destroy(r.sim);
    return r.net != NULL;
}
