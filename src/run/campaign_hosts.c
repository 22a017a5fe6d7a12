/* campaign_hosts.c - see campaign_hosts.h.
 *
 * Self-scheduling: the office (rank 0) deals one run after the other to whoever has made one, so
 * that long and short runs, fast and slow hosts need no planning. Every process has one order more
 * than it has workers, so that none waits for a message. Processes tell that they live; one that is
 * silent for long is taken for gone. */
#include "run/campaign_hosts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/check.h"
#include "base/progress.h"
#include "run/result_parts.h"

/* What messages are about. */
enum tag { TAG_ORDER = 1, TAG_RESULT, TAG_ALIVE, TAG_STOP, TAG_FAILED, TAG_LEFT };

static const double ALIVE_S = 1.0, PATIENCE_S = 20.0; /* how often they tell; how long is silent */

/* Where a run is. */
struct place {
    int process; /* that makes it; NOBODY, or ENDED */
    bool lost;   /* a process has gone with it before */
};
enum { NOBODY = -1, ENDED = -2, PAUSE_US = 500 };

/* A process as the office sees it. */
struct clerk {
    double heard;    /* host seconds of its last message */
    int open;        /* orders that it has not answered */
    bool gone, left; /* has gone by itself; has left in order */
};

/* What rank 0 knows. */
struct office {
    const struct hosts *h;
    const struct run_spec *spec;
    const bool *skip;
    int nspec, next, left, workers; /* next: not dealt before; left: runs without a result */
    int lost;                       /* runs that came back and wait for another process */
    struct place *place;            /* (nspec) */
    struct clerk *clerk;            /* (h->size) */
    run_done_fn *done;
    void *context;
    struct progress progress;
    bool failed; /* `done` has said stop */
};

/* --- the office ------------------------------------------------------------------------------- */

/* A run for `process`: one that was lost, else the next of the plan. RUN_LATER: all are dealt, but
 * one may come back. */
static int deal(struct office *o, int process)
{
    int found = RUN_LATER;
    for (int i = 0; o->lost > 0 && i < o->next && found < 0; i++)
        if (o->place[i].process == NOBODY && o->place[i].lost) found = i, o->lost--;
    while (found < 0 && o->next < o->nspec) {
        if (!o->skip || !o->skip[o->next]) found = o->next;
        o->next++;
    }
    if (found < 0) return o->left > 0 ? RUN_LATER : RUN_NO_MORE;
    o->place[found].process = process;
    return found;
}

/* For the office's own workers, who get theirs without a message. */
static int deal_here(void *context)
{
    struct office *o = context;
    return o->failed ? RUN_NO_MORE : deal(o, 0);
}

/* The result of a run, once: whoever was taken for gone may still have sent one. */
static bool end_run(struct office *o, int i, const struct run_result *r)
{
    if (o->place[i].process == ENDED) return true;
    if (o->place[i].process == NOBODY && o->place[i].lost) o->lost--;
    o->place[i].process = ENDED;
    o->left--;
    o->failed = o->failed || !o->done(o->context, &o->spec[i], r);
    progress_show(&o->progress, o->progress.total - o->left);
    return !o->failed;
}

/* What they have made. */
static bool done_here(void *context, const struct run_spec *spec, const struct run_result *r)
{
    struct office *o = context;
    return end_run(o, (int)(spec - o->spec), r);
}

/* What its runs become: another process gets them, once. A run that was lost twice has failed: it
 * may be what ends them. */
static bool lose_runs(struct office *o, int process)
{
    for (int i = 0; i < o->next; i++) {
        if (o->place[i].process != process) continue;
        o->place[i].process = NOBODY;
        if (!o->place[i].lost) {
            o->place[i].lost = true;
            o->lost++;
            continue;
        }
        o->lost++; /* end_run counts it out again */
        struct err why;
        err_clear(&why);
        err_set(&why, ERR_INTERNAL, "two processes of the job ended while they made this run");
        struct run_result r = run_refused(&why);
        r.nrank = o->spec[i].nrank;
        if (!end_run(o, i, &r)) return false;
    }
    return true;
}

/* Told once: the user may want to look after that host. */
static bool lose_process(struct office *o, int process, const char *why)
{
    struct clerk *c = &o->clerk[process];
    if (c->gone) return true;
    c->gone = true;
    fprintf(stderr, "mimdsim: process %d of the job %s; other processes make its runs\n", process,
            why);
    return lose_runs(o, process);
}

/* Fill up the orders of all processes. */
static bool send_orders(struct office *o, bool *active)
{
    for (int p = 1; p < o->h->size; p++) {
        struct clerk *c = &o->clerk[p];
        while (!c->gone && c->open < o->workers + 1) {
            const int i = deal(o, p);
            if (i < 0) break;
            *active = true;
            c->open++;
            if (!o->h->call->send(p, TAG_ORDER, &i, sizeof i) &&
                !lose_process(o, p, "takes no messages"))
                return false;
        }
    }
    return true;
}

/* A result of another process. */
static bool take_result(struct office *o, const struct hosts_message *m, const void *block)
{
    struct arena *a = arena_create();
    struct run_result r;
    int i;
    o->clerk[m->from].open--; /* it may have another one */
    bool ok = true;
    if (!result_unpack(block, m->bytes, &i, &r, a) || i < 0 || i >= o->nspec)
        ok = lose_process(o, m->from, "sent what is no result");
    else ok = end_run(o, i, &r);
    arena_destroy(a);
    return ok;
}

/* Whatever a process tells, it lives. */
static bool take_message(struct office *o, const struct hosts_message *m, struct err *e)
{
    char *block = malloc(m->bytes + 1);
    CHECK(block != NULL);
    bool ok = o->h->call->receive(m, block) ||
              err_set(e, ERR_INTERNAL, "a message of process %d was lost", m->from);
    block[m->bytes] = '\0';
    o->clerk[m->from].heard = host_seconds();
    if (ok && m->tag == TAG_RESULT) ok = take_result(o, m, block);
    else if (ok && m->tag == TAG_FAILED) ok = lose_process(o, m->from, block);
    else if (ok && m->tag == TAG_ALIVE) (void)o->h->call->send(m->from, TAG_ALIVE, "", 0);
    free(block);
    return ok;
}

/* Messages, then processes that have been silent for too long, then new orders. */
static bool attend_office(void *context, bool *active, struct err *e)
{
    struct office *o = context;
    struct hosts_message m;
    bool there;
    for (;;) {
        if (!o->h->call->look(HOSTS_ANY, HOSTS_ANY, false, &there, &m))
            return err_set(e, ERR_INTERNAL, "%s reports an error", o->h->call->library);
        if (!there) break;
        *active = *active || m.tag != TAG_ALIVE;
        if (!take_message(o, &m, e)) return false;
    }
    const double now = host_seconds();
    for (int p = 1; p < o->h->size; p++)
        if (now - o->clerk[p].heard > PATIENCE_S && !lose_process(o, p, "is silent")) return false;
    progress_show(&o->progress, o->progress.total - o->left);
    return send_orders(o, active);
}

/* No process waits for more. `at_once`: what they are making is not wanted. */
static void stop_all(struct office *o, bool at_once)
{
    const int how = at_once;
    for (int p = 1; p < o->h->size; p++)
        if (!o->clerk[p].gone && !o->h->call->send(p, TAG_STOP, &how, sizeof how))
            o->clerk[p].gone = true;
}

/* A message that nobody received would be there when MPI ends: the last one of each process is
 * waited for. Who does not send it in time has gone. */
static void wait_for_all(struct office *o)
{
    const double begin = host_seconds();
    int here = 0;
    for (int p = 1; p < o->h->size; p++) here += !o->clerk[p].gone;
    while (here > 0 && host_seconds() - begin < PATIENCE_S) {
        struct hosts_message m;
        bool there;
        if (!o->h->call->look(HOSTS_ANY, HOSTS_ANY, false, &there, &m)) break;
        if (!there) {
            usleep(PAUSE_US);
            continue;
        }
        char *block = malloc(m.bytes + 1);
        CHECK(block != NULL);
        if (o->h->call->receive(&m, block) && m.tag == TAG_LEFT && !o->clerk[m.from].gone) {
            o->clerk[m.from].left = true;
            here--;
        }
        free(block);
    }
    for (int p = 1; p < o->h->size; p++) o->clerk[p].gone = !o->clerk[p].left;
}

/* Deal until every run has a result, then tell all to stop. */
static bool run_office(struct office *o, const struct run_order *order, bool quiet, int *gone,
                       struct err *e)
{
    o->place = calloc((size_t)o->nspec + 1, sizeof *o->place);
    o->clerk = calloc((size_t)o->h->size, sizeof *o->clerk);
    CHECK(o->place && o->clerk);
    for (int i = 0; i < o->nspec; i++) {
        o->place[i].process = NOBODY;
        o->left += !o->skip || !o->skip[i];
    }
    for (int p = 0; p < o->h->size; p++) o->clerk[p].heard = host_seconds();
    o->progress = progress_make("runs", o->left > 0 ? o->left : 1, quiet);
    /* Without work no process of our own is started, but the others wait for the end. */
    const struct run_dealer dealer = {deal_here, attend_office, done_here, o};
    const bool ok = o->left == 0 || run_stream(o->spec, order, o->nspec, o->workers, &dealer, e);
    progress_end(&o->progress);
    stop_all(o, !ok);
    wait_for_all(o);
    *gone = 0;
    for (int p = 1; p < o->h->size; p++) *gone += o->clerk[p].gone;
    free(o->clerk);
    free(o->place);
    return ok;
}

/* --- other processes -------------------------------------------------------------------------- */

/* Orders that wait for a worker: the office keeps to a few. */
enum { MOST_ORDERS = 512 };

struct member {
    const struct hosts *h;
    const struct run_spec *spec;
    int nspec, norder, order[MOST_ORDERS];
    bool stop, at_once;
    double heard, told; /* of the office, by this process; host seconds */
};

/* In the order in which they came. */
static int next_order(void *context)
{
    struct member *w = context;
    if (w->norder == 0) return w->stop ? RUN_NO_MORE : RUN_LATER;
    /* A handful: moving them is nothing beside a run. */
    const int first = w->order[0];
    memmove(w->order, w->order + 1, (size_t)--w->norder * sizeof *w->order);
    return first;
}

/* The office stores it. */
static bool send_result(void *context, const struct run_spec *spec, const struct run_result *r)
{
    struct member *w = context;
    size_t bytes;
    void *block = result_pack((int)(spec - w->spec), r, &bytes);
    w->told = host_seconds();
    const bool ok = w->h->call->send(0, TAG_RESULT, block, bytes);
    free(block);
    return ok;
}

/* An order, a reply that the office lives, or the end. */
static bool take_word(struct member *w, const struct hosts_message *m)
{
    int word = 0;
    if (m->bytes > sizeof word || !w->h->call->receive(m, &word)) return false;
    w->heard = host_seconds();
    if (m->tag == TAG_ORDER && word >= 0 && word < w->nspec && w->norder < MOST_ORDERS)
        w->order[w->norder++] = word;
    if (m->tag == TAG_STOP) w->stop = true, w->at_once = word != 0;
    return true;
}

/* Messages of the office; then a sign of life for it. */
static bool attend_member(void *context, bool *active, struct err *e)
{
    struct member *w = context;
    struct hosts_message m;
    bool there = true;
    for (bool ok = true; ok && there;) {
        ok = w->h->call->look(0, HOSTS_ANY, false, &there, &m) && (!there || take_word(w, &m));
        if (!ok) return err_set(e, ERR_INTERNAL, "the first process of the job has gone");
        *active = *active || (there && m.tag != TAG_ALIVE);
    }
    /* A job whose first process has gone, and that nobody ends, ends itself. */
    const double now = host_seconds();
    if (now - w->heard > PATIENCE_S)
        return err_set(e, ERR_INTERNAL, "the first process of the job is silent");
    if (now - w->told > ALIVE_S) {
        w->told = now;
        (void)w->h->call->send(0, TAG_ALIVE, "", 0);
    }
    return !w->at_once || err_set(e, ERR_INTERNAL, "the first process of the job stopped it");
}

/* Until the office says stop. */
static bool run_member(const struct hosts *h, const struct run_spec *spec,
                       const struct run_order *order, int nspec, int workers, struct err *e)
{
    struct member *w = calloc(1, sizeof *w);
    CHECK(w != NULL);
    *w = (struct member){.h = h, .spec = spec, .nspec = nspec, .heard = host_seconds()};
    const struct run_dealer dealer = {next_order, attend_member, send_result, w};
    const bool ok = run_stream(spec, order, nspec, workers, &dealer, e);
    /* What goes wrong here (no process, no memory) is told where people read it. */
    if (!ok && !w->stop) (void)h->call->send(0, TAG_FAILED, e->text, strlen(e->text));
    (void)h->call->send(0, TAG_LEFT, "", 0);
    free(w);
    return ok;
}

/* The first process is the office. */
bool run_campaign_hosts(const struct hosts *h, const struct run_spec *spec,
                        const struct run_order *order, int nspec, const bool *skip, int workers,
                        bool quiet, run_done_fn *done, void *context, int *gone, struct err *e)
{
    *gone = 0;
    if (h->rank > 0) return run_member(h, spec, order, nspec, workers, e);
    struct office o = {.h = h,
                       .spec = spec,
                       .skip = skip,
                       .nspec = nspec,
                       .workers = workers,
                       .done = done,
                       .context = context};
    return run_office(&o, order, quiet, gone, e);
}
