/* host_comm.c - see host_comm.h. Messages of programs that know their senders are matched by MPI;
 * those of others in host_match.c.
 *
 * A send copies its data into memory of its own and is then MPI's: a program of comm.h may use its
 * data again at once, and two ranks that send to each other first must not wait for each other.
 * Memory of sends is used again, so that a program that repeats itself touches no new pages. */
#include "host/host_comm.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/check.h"
#include "base/digest.h"
#include "base/memory.h"
#include "comm/collectives.h"
#include "host/host_parts.h"

static struct host_comm *mine(struct comm *c) { return (struct host_comm *)c; }
static const struct lane_calls *lane(const struct host_comm *h) { return h->hosts->call->lane; }

/* comm_fail of a program: with the line of the call. */
static void end_run(struct comm *c, const char *text)
{
    host_stop(mine(c), "line %d: %s", c->line, text);
}

/* Errors of MPI, such as a rank that has gone, end this one: nothing sensible can follow. */
static void need(struct host_comm *h, bool ok, const char *what)
{
    if (!ok) host_stop(h, "%s reports an error in %s", h->hosts->call->library, what);
}

/* --- sending ---------------------------------------------------------------------------------- */

/* Sends that nobody waits for are looked at when others begin: the oldest only, which is done first
 * as a rule. */
static void reap(struct host_comm *h)
{
    while (h->sent.first != NULL && host_test_send(h, h->sent.first))
        host_pending_free(h, host_list_remove(&h->sent, &h->sent.first));
}

/* Ranks and sizes are looked at here and not by MPI, whose message would name neither line nor
 * program.
 *
 * Arguments come from programs, also from somebody else's. */
static void check_peer(struct host_comm *h, int peer, int64_t bytes)
{
    if (peer < 0 || peer >= h->comm.size)
        host_stop(h, "names rank %d; expected 0 to %d", peer, h->comm.size - 1);
    if (h->hosts == NULL) host_stop(h, "a message on one processor without MPI");
    if (bytes < 0 || bytes > INT_MAX)
        host_stop(h, "a message of %lld bytes; expected 0 to %d", (long long)bytes, INT_MAX);
}

/* The three parts of a send: may it be sent, the copy, the request.
 *
 * MPI gets the copy, so that the caller may go on; the node is the request, or joins the list of
 * those that nobody waits for. */
static void send(struct comm *c, int dst, int64_t tag, const void *data, int64_t bytes,
                 bool synchronous, struct comm_request *r)
{
    struct host_comm *h = mine(c);
    check_peer(h, dst, bytes);
    reap(h);
    struct host_pending *p = host_pending_new(h, (size_t)bytes);
    if (data != NULL && bytes > 0) memcpy(p->copy, data, (size_t)bytes);
    p->send = true;
    p->held = r != NULL;
    need(h,
         lane(h)->send_begin(&h->lane, dst, host_tag(h, tag), p->copy, (size_t)bytes, synchronous,
                             &p->mpi),
         "a send");
    h->times.messages++;
    h->times.bytes += bytes;
    if (r == NULL) {
        host_list_add(&h->sent, p);
        return;
    }
    /* What the program may read of its request, and where the call stands, for messages. */
    *r = (struct comm_request){.bytes = bytes,
                               .tag = tag,
                               .peer = dst,
                               .active = 1,
                               .detail = p,
                               .file = c->file,
                               .line = c->line};
}

/* The two kinds of send differ in one word to MPI. */
static void isend(struct comm *c, int dst, int64_t tag, const void *data, int64_t bytes,
                  struct comm_request *r)
{
    send(c, dst, tag, data, bytes, false, r);
}

static void isend_synchronous(struct comm *c, int dst, int64_t tag, const void *data, int64_t bytes,
                              struct comm_request *r)
{
    send(c, dst, tag, data, bytes, true, r);
}

/* --- receiving -------------------------------------------------------------------------------- */

/* A receive from a known sender.
 *
 * Straight into the program's buffer; where it has none, the message goes into the node's. */
static void irecv(struct comm *c, int src, int64_t tag, void *buffer, int64_t bytes,
                  struct comm_request *r)
{
    struct host_comm *h = mine(c);
    check_peer(h, src, bytes);
    if (h->timed) {
        host_match_receive(c, src, tag, COMM_WHOLE_TAG, buffer, bytes, r);
        return;
    }
    struct host_pending *p = host_pending_new(h, buffer == NULL ? (size_t)bytes : 0);
    p->held = true;
    *r = (struct comm_request){.buffer = buffer,
                               .bytes = bytes,
                               .tag = tag,
                               .peer = src,
                               .active = 1,
                               .detail = p,
                               .file = c->file,
                               .line = c->line};
    need(h,
         lane(h)->receive_begin(&h->lane, src, host_tag(h, tag), buffer != NULL ? buffer : p->copy,
                                (size_t)bytes, &p->mpi),
         "a receive");
}

/* MPI says how long the message was: another length is a program's mistake, as on virtual
 * processors. */
static void wait(struct comm *c, struct comm_request *r)
{
    struct host_comm *h = mine(c);
    if (!r->active) return;
    struct host_pending *p = r->detail;
    if (!p->send && h->timed) {
        host_match_wait(h, r);
        return;
    }
    size_t got = (size_t)r->bytes;
    if (!p->done)
        need(h, lane(h)->wait(&p->mpi, p->send ? NULL : &got),
             p->send ? "a send" : "a receive: the message may be longer than its buffer");
    if (got != (size_t)r->bytes)
        host_stop(h, "line %d: receives %lld bytes, and the message has %zu", r->line,
                  (long long)r->bytes, got);
    host_finish(h, r);
}

/* --- time ------------------------------------------------------------------------------------- */

/* Window synchronisation: ranks that leave a barrier do so one after the other, by more than the
 * messages that are to be measured take (Hunold, Carpen-Amarie 2016).
 *
 * All ranks begin at one time of the host's clock where they share it, so that the run's time is
 * from there to the end of the last. LEAD: enough for all to hear of it. */
enum { LEAD_NS = 30000 };

static void synchronise(struct host_comm *h)
{
    int64_t when = 0;
    if (h->hosts == NULL || h->comm.size == 1) return;
    need(h, h->warm == NULL || host_warm_caches(h), "an exchange of messages");
    need(h, lane(h)->barrier(&h->lane), "a barrier");
    /* Clocks of several computers differ by more than a message takes. */
    if (!h->one_clock) return;
    when = host_clock_ns() + LEAD_NS;
    need(h, h->hosts->call->reduce(HOSTS_LARGEST, &when, 1), "a reduction");
    h->faults = host_faults(); /* the first messages of a job may bring pages */
    /* Spinning: sleeping would begin late by the time of a switch. */
    while (host_clock_ns() < when) continue;
    h->times.begin_ns = when;
    h->times.late_ns = host_clock_ns() - when;
}

/* The end is read first thing, the beginning last thing: neither is part of what is measured. */
static void mark(struct comm *c, int begin)
{
    struct host_comm *h = mine(c);
    if (!begin) {
        const int64_t now = host_clock_ns();
        h->times.stage_ns[h->stage] += now - h->mark_ns;
        h->times.end_ns = now;
        h->times.preempted = host_switches() - h->switches;
        h->times.faults = host_faults() - h->faults;
        h->running = false;
        return;
    }
    h->stage = 0;
    h->running = true;
    h->switches = host_switches();
    h->faults = host_faults();
    h->times.begin_ns = 0;
    synchronise(h);
    if (h->times.begin_ns == 0) h->times.begin_ns = host_clock_ns();
    h->mark_ns = h->times.begin_ns;
}

/* One look at the clock ends a stage and begins the next: nothing is lost between them. */
static void set_stage(struct comm *c, int stage)
{
    struct host_comm *h = mine(c);
    const int64_t now = host_clock_ns();
    CHECK(stage >= 0 && stage < h->nstage);
    h->times.stage_ns[h->stage] += now - h->mark_ns;
    h->mark_ns = now;
    h->stage = stage;
}

/* Since the common beginning, as in a simulated run. */
static int64_t now_ps(struct comm *c)
{
    struct host_comm *h = mine(c);
    return h->running ? (host_clock_ns() - h->times.begin_ns) * 1000 : 0;
}

/* The processor has done it. */
static void work(struct comm *c, const struct work *w) { (void)c, (void)w; }

/* Computing that is only stated takes its time. */
static void elapse(struct comm *c, int64_t ps)
{
    const int64_t until = host_clock_ns() + ps / 1000;
    (void)c;
    while (host_clock_ns() < until) continue;
}

/* By messages, as on virtual processors without hardware for it. */
static void barrier(struct comm *c)
{
    if (c->size > 1) collective_barrier(c, FAR_TAGS);
}

/* --- results ---------------------------------------------------------------------------------- */

/* The stage's time is counted from a later moment: as if nothing had been done meanwhile. */
static void clock_pause(struct comm *c, int begin)
{
    struct host_comm *h = mine(c);
    const int64_t now = host_clock_ns();
    if (begin) {
        h->paused_ns = now;
        return;
    }
    h->mark_ns += now - h->paused_ns;
    h->times.published_ns += now - h->paused_ns;
}

/* Whoever asks is not part of the program: the clock stands meanwhile. */
static void publish(struct comm *c, int output, int64_t first, int64_t n, const double *data)
{
    struct host_comm *h = mine(c);
    const struct host_place place = {output, first, n,
                                     (int64_t)(h->numbers.length / sizeof(double))};
    clock_pause(c, 1);
    text_add_bytes(&h->places, (const char *)&place, sizeof place);
    if (n > 0) text_add_bytes(&h->numbers, (const char *)data, (size_t)n * sizeof *data);
    clock_pause(c, 0);
}

/* Places are copied out: the text that holds them is bytes. */
bool host_comm_published(const struct host_comm *h, int i, struct host_published *out)
{
    struct host_place p;
    if ((size_t)i >= h->places.length / sizeof p) return false;
    memcpy(&p, h->places.s + (size_t)i * sizeof p, sizeof p);
    const double *x = (const double *)(const void *)h->numbers.s;
    *out = (struct host_published){p.output, p.first, p.n, p.n > 0 ? x + p.at : NULL};
    return true;
}

/* Both texts are whole 64-bit words. */
uint64_t host_comm_digest(const struct host_comm *h)
{
    uint64_t d = DIGEST_START, bits;
    for (size_t i = 0; i < h->places.length / sizeof bits; i++) {
        memcpy(&bits, h->places.s + i * sizeof bits, sizeof bits);
        d = digest_mix(d, bits);
    }
    for (size_t i = 0; i < h->numbers.length / sizeof bits; i++) {
        memcpy(&bits, h->numbers.s + i * sizeof bits, sizeof bits);
        d = digest_mix(d, bits);
    }
    return d;
}

/* --- what a rank is --------------------------------------------------------------------------- */

/* Schedules alone watch requests; they state their computing times, and are not run for real. */
static void no_watch(struct comm *c, struct comm_request *r)
{
    (void)r;
    host_stop(mine(c), "watches requests, which is for simulated schedules");
}

static struct comm_request *no_next(struct comm *c, int64_t time_ps)
{
    (void)time_ps;
    host_stop(mine(c), "watches requests, which is for simulated schedules");
}

/* comm.h, and comm_match.h from another file. */
static const struct comm_type host_type = {
    .name = "mpi",
    .isend = isend,
    .irecv = irecv,
    .wait = wait,
    .barrier = barrier,
    .work = work,
    .stage = set_stage,
    .now_ps = now_ps,
    .publish = publish,
    .pause = clock_pause,
    .elapse = elapse,
    .end_run = end_run,
    .mark = mark,
    .isend_synchronous = isend_synchronous,
    .irecv_matching = host_match_receive,
    .complete_any = host_match_any,
    .probe = host_match_probe,
    .receive_into = host_match_into,
    .cancel = host_match_cancel,
    .watch = no_watch,
    .next_complete = no_next,
};

/* One host: all processes have the same name of it and see the same boot of it. */
static bool one_host(const struct hosts *hosts)
{
    struct text boot = {0};
    struct err e;
    /* Names alone do not do: many computers are called localhost. */
    char name[256] = "";
    uint64_t h = DIGEST_START;
    err_clear(&e);
    gethostname(name, sizeof name - 1);
    FILE *file = fopen("/proc/sys/kernel/random/boot_id", "r");
    if (file != NULL && !text_read_stream(&boot, file, "boot_id", &e)) boot.length = 0;
    if (file != NULL) fclose(file);
    for (const char *s = name; *s != '\0'; s++) h = digest_mix(h, (unsigned char)*s);
    for (size_t i = 0; i < boot.length; i++) h = digest_mix(h, (unsigned char)boot.s[i]);
    text_free(&boot);
    int64_t least = (int64_t)h, largest = (int64_t)h;
    return hosts->call->reduce(HOSTS_LEAST, &least, 1) &&
           hosts->call->reduce(HOSTS_LARGEST, &largest, 1) && least == largest;
}

/* A lane of its own, so that no message of the program is taken for one of the job. */
struct host_comm *host_comm_create(const struct hosts *hosts, struct err *e)
{
    struct host_comm *h = memory_zeroed(1, sizeof *h);
    h->hosts = hosts;
    h->comm = (struct comm){.type = &host_type,
                            .rank = hosts != NULL ? hosts->rank : 0,
                            .size = hosts != NULL ? hosts->size : 1};
    h->one_clock = true;
    if (hosts == NULL) return h;
    if (!hosts->call->lane->open(&h->lane, &h->largest_tag)) {
        err_set(e, ERR_INTERNAL, "%s gives no communicator", hosts->call->library);
        free(h);
        return NULL;
    }
    h->one_clock = one_host(hosts);
    /* Processes that take turns would spin for each other, and their times say little. */
    if (h->one_clock && hosts->size > sysconf(_SC_NPROCESSORS_ONLN)) return h;
    need(h, host_warm_messages(h), "an exchange of messages");
    return h;
}

/* Nodes of operations that were never completed are few and go with the process. */
static void free_all(struct host_pending *p)
{
    while (p != NULL) {
        struct host_pending *next = p->next;
        free(p->copy);
        free(p);
        p = next;
    }
}

void host_comm_destroy(struct host_comm *h)
{
    if (h == NULL) return;
    if (h->hosts != NULL) h->hosts->call->lane->close(&h->lane);
    free_all(h->spare);
    free(h->warm);
    text_free(&h->places);
    text_free(&h->numbers);
    free(h);
}

/* Nothing of the run before is left but memory. */
struct comm *host_comm_run_begin(struct host_comm *h, bool timed, int nstage,
                                 const struct comm_output *output, int n)
{
    h->timed = timed;
    h->nstage = nstage;
    h->times = (struct host_times){0};
    h->places.length = h->numbers.length = 0;
    h->comm.output = output;
    h->comm.noutput = n;
    h->comm.file = NULL;
    return &h->comm;
}

/* Nobody has a message under way behind the barrier, so what is still there was not received. */
bool host_comm_run_end(struct host_comm *h, struct host_times *out, bool *left)
{
    *out = h->times;
    *left = false;
    if (h->hosts == NULL) return true;
    /* First what this rank has sent, or its partners could not come to the barrier. */
    while (h->sent.first != NULL) reap(h);
    if (!lane(h)->barrier(&h->lane)) return false;
    *left = host_match_drain(h);
    return lane(h)->barrier(&h->lane);
}

bool host_comm_one_clock(const struct host_comm *h) { return h->one_clock; }

bool host_comm_barrier(struct host_comm *h)
{
    return h->hosts == NULL || lane(h)->barrier(&h->lane);
}
