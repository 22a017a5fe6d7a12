/* campaign.c - many runs on worker processes, results handed over in plan order by the one parent.
 * A run that is refused, or whose worker dies, is a result, too: failed, with the reason; the
 * others go on.
 *
 * Each worker reads run numbers from its pipe and answers with the result's bytes; the parent alone
 * sees the store. */
#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/check.h"
#include "base/memory.h"
#include "base/process.h"
#include "base/progress.h"
#include "base/whole.h"
#include "loader/crash.h"
#include "measure/run_heartbeat.h"
#include "run/result_parts.h"
#include "run/interrupt.h"
#include "run/run.h"

/* Poll this often [us], so that the progress of long runs moves although no run ends; and to ask a
 * dealer. */
enum { MOST_WORKERS = 256, HEARTBEAT_US = 200000, LEAST_PAUSE_US = 100, MOST_PAUSE_US = 5000 };

/* What a worker answers: this struct as bytes, then the arrays if the run was made. Pointers in
 * it mean nothing to the reader, who replaces them. */
struct answer {
    int index;
    bool ok; /* the run was made, whatever came of it */
    struct err error; /* why it could not be made, where not ok */
    struct run_result result;
};

/* From the worker to its parent. */
static bool send_answer(int fd, struct answer *a)
{
    if (!write_whole(fd, a, sizeof *a)) return false;
    if (!a->ok) return true;
    struct result_parts p = result_parts(&a->result);
    for (int i = 0; i < RESULT_PARTS; i++)
        if (!write_whole(fd, *p.array[i], p.bytes[i])) return false;
    return true;
}

/* The arrays get memory of the parent's arena. */
static bool receive_answer(int fd, struct answer *a, struct arena *arena)
{
    if (!read_whole(fd, a, sizeof *a)) return false;
    if (!a->ok) return true;
    struct result_parts p = result_parts(&a->result);
    for (int i = 0; i < RESULT_PARTS; i++) {
        *p.array[i] = p.bytes[i] ? arena_take(arena, p.bytes[i]) : NULL;
        if (!read_whole(fd, *p.array[i], p.bytes[i])) return false;
    }
    return true;
}

struct worker {
    pid_t pid;
    int orders, answers; /* pipe ends of the parent */
    int busy;            /* run number it works on, -1: none */
    struct crash_record *crash; /* shared with it: how it crashed, NULL: no memory for that */
};

struct campaign {
    const struct run_spec *spec;
    const struct run_order *order; /* (nspec), NULL: as usual */
    /* next: not yet given to a worker; handed: all before it have been handed over; ndone of
     * ntodo: progress. */
    int nspec, next, handed, nworker, ndone, ntodo;
    pid_t parent; /* whose workers these are */
    struct run_cache *cache; /* what every worker begins with; NULL: nothing. Borrowed */
    int cores; /* processors for each run */
    const bool *skip; /* (nspec) not to be made; NULL: none */
    struct worker worker[MOST_WORKERS];
    struct answer **slot; /* (nspec) results waiting for their turn */
    struct arena **arena; /* (nspec) their memory */
    run_done_fn *done; /* called in plan order, in this process */
    void *context;
    struct progress progress;
    char detail[96]; /* of the progress line */
    /* (MOST_WORKERS) of each worker, in memory shared with it; NULL: nobody looks */
    struct run_heartbeat *heartbeat;
};

/* [s] of the host; shorter runs show in the number of those done */
static const double LONG_RUN_S = 0.9;

/* Show the progress, with how far the long runs of busy workers are (worker 0 is this process when
 * there are none). */
static void show_progress(void *context)
{
    struct campaign *c = context;
    double events = 0, rate = 0, now = host_seconds();
    int ended = 0, nrank = 0;
    if (!progress_due(&c->progress)) return;
    /* Relaxed loads: a number that is a moment old is good enough for a progress line. */
    for (int i = 0; c->heartbeat && (i < c->nworker || i == 0); i++) {
        const struct run_heartbeat *p = &c->heartbeat[i];
        double mine = (double)atomic_load_explicit(&p->events, memory_order_relaxed);
        double spent = now - atomic_load_explicit(&p->begin, memory_order_relaxed);
        if (mine == 0 || spent < LONG_RUN_S || (c->nworker > 0 && c->worker[i].busy < 0)) continue;
        events += mine;
        rate += mine / spent;
        ended += atomic_load_explicit(&p->ended, memory_order_relaxed);
        nrank += atomic_load_explicit(&p->nrank, memory_order_relaxed);
    }
    snprintf(c->detail, sizeof c->detail,
             "%.3g million events, %.2g million/s, %d of %d ranks ended", 1e-6 * events,
             1e-6 * rate, ended, nrank);
    c->progress.detail = events > 0 ? c->detail : NULL;
    progress_show(&c->progress, c->ndone);
}

/* The order of run `index`, with its part of the processors and a place to tell how far it is. */
static struct run_order own_order(const struct run_order *order, int index, int cores,
                                  struct run_heartbeat *heartbeat)
{
    struct run_order own = {0};
    if (order) own = order[index];
    own.heartbeat = heartbeat;
    own.cores = cores;
    if (heartbeat) atomic_store_explicit(&heartbeat->events, 0, memory_order_relaxed);
    return own;
}

/* What the runs of one process share. */
static struct run_cache *own_cache(void)
{
    struct run_cache *cache = run_cache_create();
    run_cache_repeat(cache, false);
    return cache;
}

/* A worker's life: orders in, answers out. It ends when the parent closes the pipe, or goes. */
static _Noreturn void worker_main(const struct campaign *c, int at, int orders, int answers)
{
    int index;
    /* A parent that is killed takes its workers along: nobody would read their answers, and code of
     * people may be in an endless loop. */
    if (!process_end_with(c->parent)) _exit(0);
    struct run_heartbeat *heartbeat = c->heartbeat ? &c->heartbeat[at] : NULL;
    struct run_cache *cache = c->cache ? c->cache : own_cache();
    struct err unguarded; /* a crash is then told by its signal alone */
    err_clear(&unguarded);
    if (c->worker[at].crash) crash_guard_begin(c->worker[at].crash, &unguarded);
    while (read_whole(orders, &index, sizeof index)) {
        struct arena *arena = arena_create();
        struct answer a = {.index = index};
        const struct run_order own = own_order(c->order, index, c->cores, heartbeat);
        a.ok = run_sharing(&c->spec[index], &own, cache, arena, &a.result, &a.error);
        if (!send_answer(answers, &a)) _exit(err_exit_status(ERR_IO));
        arena_destroy(arena);
    }
    _exit(0);
}

/* Start the worker of place `at`, which is free: the next one, or that of a worker that died. */
static bool start_worker(struct campaign *c, int at, struct err *e)
{
    int orders[2], answers[2];
    /* The record outlives the worker: a new worker in its place uses it again. */
    struct crash_record *crash = c->worker[at].crash ? c->worker[at].crash : crash_record_create();
    c->worker[at].crash = crash;
    if (crash) crash_record_clear(crash);
    if (pipe(orders) != 0 || pipe(answers) != 0)
        return err_set(e, ERR_INTERNAL, "no pipe: %s", strerror(errno));
    c->parent = getpid();
    pid_t pid = fork();
    if (pid < 0) return err_set(e, ERR_INTERNAL, "no worker process: %s", strerror(errno));
    /* The child keeps its own two ends only: an end left open here would keep other workers from
     * seeing theirs closed. */
    if (pid == 0) {
        close(orders[1]);
        close(answers[0]);
        for (int i = 0; i < c->nworker; i++) {
            if (i == at) continue;
            close(c->worker[i].orders);
            close(c->worker[i].answers);
        }
        worker_main(c, at, orders[0], answers[1]);
    }
    close(orders[0]);
    close(answers[1]);
    c->worker[at] = (struct worker){pid, orders[1], answers[0], -1, crash};
    /* a new place; else the one of a worker that ended */
    if (at == c->nworker) c->nworker++;
    return true;
}

/* Hand run `index` to a worker, -1: none. When it is dead by now, that shows when its answer is
 * read. */
static void give_run(struct worker *w, int index)
{
    w->busy = index;
    /* A worker without its order would be waited for for ever. */
    if (index >= 0 && !write_whole(w->orders, &w->busy, sizeof w->busy)) kill(w->pid, SIGKILL);
}

/* The next run in plan order that is to be made. */
static void give_order(struct campaign *c, struct worker *w)
{
    while (c->next < c->nspec && c->skip && c->skip[c->next]) c->next++;
    give_run(w, c->next < c->nspec ? c->next++ : -1);
}

struct run_result run_refused(const struct err *why)
{
    struct run_result r = {.status = RUN_FAILED,
                           .residual = NAN,
                           .measured_s = NAN,
                           .residual_before = NAN,
                           .loop_rank = -1,
                           .refusal = why->kind};
    if (why->line > 0)
        snprintf(r.text, sizeof r.text, "%s:%d: %s", why->file, why->line, why->text);
    else snprintf(r.text, sizeof r.text, "%s%s%s", why->file, why->file[0] ? ": " : "", why->text);
    return r;
}

/* A run that could not be made is handed over as failed: it has its place in plan order like any
 * other. */
static bool hand_refused(struct campaign *c, int index, const struct err *why)
{
    struct run_result r = run_refused(why);
    r.nrank = c->spec[index].nrank;
    return c->done(c->context, &c->spec[index], &r);
}

/* Hand over the result of run i, which is there, and give its memory back. */
static bool hand_one(struct campaign *c, int i)
{
    struct answer *a = c->slot[i];
    const bool ok =
        a->ok ? c->done(c->context, &c->spec[i], &a->result) : hand_refused(c, i, &a->error);
    arena_destroy(c->arena[i]);
    c->arena[i] = NULL;
    c->slot[i] = NULL;
    c->ndone++;
    return ok;
}

/* Hand over what is next in plan order, as far as it is there. */
static bool hand_over(struct campaign *c)
{
    while (c->handed < c->nspec) {
        int i = c->handed;
        /* NULL: still running; results behind it wait. */
        const bool skipped = c->skip && c->skip[i];
        if (!skipped && !c->slot[i]) return true;
        c->handed++;
        if (skipped) continue;
        const bool ok = hand_one(c, i);
        show_progress(c);
        if (!ok) return false;
    }
    return true;
}

static bool is_code(const struct program_spec *p)
{
    return p->kind == PROGRAM_KERNEL || p->kind == PROGRAM_MPI;
}

/* Such code may crash, loop for ever, or leave memory behind. */
bool run_loads_code(const struct run_spec *spec)
{
    bool loads = is_code(&spec->program);
    for (int i = 0; spec->jobs && i < spec->jobs->n && !loads; i++)
        loads = !spec->jobs->idle[i] && is_code(&spec->jobs->job[i]->program);
    return loads;
}

/* Wait for the end of a worker that gets no more orders. */
static int end_worker(struct worker *w)
{
    int status = 0;
    close(w->orders);
    close(w->answers);
    while (waitpid(w->pid, &status, 0) < 0 && errno == EINTR) {}
    w->pid = 0;
    return status;
}

/* The run of a worker that died has failed; another worker takes its place for those that are left.
 * A crash that the worker has described was the run's own end, anything else is a run that could
 * not be made. */
static bool replace_worker(struct campaign *c, struct worker *w, struct answer *a, struct err *e)
{
    kill(w->pid, SIGKILL); /* it may only have answered wrongly */
    const int status = end_worker(w);
    err_clear(&a->error);
    a->ok = w->crash && crash_text(w->crash, a->error.text, sizeof a->error.text);
    if (a->ok) {
        a->result = run_refused(&a->error);
        a->result.nrank = c->spec[a->index].nrank;
    } else if (WIFSIGNALED(status))
        err_set(&a->error, ERR_INTERNAL, "its worker process was killed by signal %d (%s)",
                WTERMSIG(status), strsignal(WTERMSIG(status)));
    else
        err_set(&a->error, ERR_INTERNAL, "its worker process ended with status %d%s",
                WEXITSTATUS(status),
                WEXITSTATUS(status) == err_exit_status(ERR_INTERNAL)
                    ? ": the system refused more memory"
                : WEXITSTATUS(status) == err_exit_status(ERR_IO)
                    ? ": its answer could not be written"
                    : "");
    return start_worker(c, (int)(w - c->worker), e);
}

/* The answer of a worker that has one, or its death, into the slot of its run. The worker has no
 * order then. */
static bool take_answer(struct campaign *c, struct worker *w, struct err *e)
{
    const int index = w->busy;
    c->arena[index] = arena_create();
    c->slot[index] = TAKE(c->arena[index], 1, struct answer);
    if (!receive_answer(w->answers, c->slot[index], c->arena[index])) {
        *c->slot[index] = (struct answer){.index = index};
        if (!replace_worker(c, w, c->slot[index], e)) return false;
    } else if (run_loads_code(&c->spec[index])) {
        /* What such a run has left in the process goes with the process. */
        end_worker(w);
        if (!start_worker(c, (int)(w - c->worker), e)) return false;
    }
    CHECK(c->slot[index]->index == index);
    w->busy = -1;
    return true;
}

/* Wait for workers with an order, `us` at most; poll skips the others (fd -1). */
static bool wait_for_answers(struct campaign *c, struct pollfd *p, int64_t us, struct err *e)
{
    const struct timespec most = {us / 1000000, us % 1000000 * 1000};
    for (int i = 0; i < c->nworker; i++)
        p[i] = (struct pollfd){.fd = c->worker[i].busy >= 0 ? c->worker[i].answers : -1,
                               .events = POLLIN};
    if (ppoll(p, (nfds_t)c->nworker, &most, NULL) >= 0) return true;
    for (int i = 0; i < c->nworker; i++) p[i].revents = 0;
    return errno == EINTR || err_set(e, ERR_INTERNAL, "poll: %s", strerror(errno));
}

/* Until everything is handed over. */
static bool serve(struct campaign *c, struct err *e)
{
    for (int i = 0; i < c->nworker; i++) give_order(c, &c->worker[i]);
    while (c->handed < c->nspec) {
        struct pollfd p[MOST_WORKERS];
        if (!wait_for_answers(c, p, HEARTBEAT_US, e)) return false;
        show_progress(c);
        for (int i = 0; i < c->nworker; i++) {
            if (p[i].fd < 0 || !p[i].revents) continue;
            if (!take_answer(c, &c->worker[i], e)) return false;
            give_order(c, &c->worker[i]);
            if (!hand_over(c)) return false;
        }
    }
    return true;
}

/* Give runs of the dealer to idle workers. Returns how many are busy then; *active when one was
 * given. */
static int deal(struct campaign *c, const struct run_dealer *d, bool *more, bool *active)
{
    int busy = 0;
    for (int i = 0; i < c->nworker; i++) {
        if (c->worker[i].busy < 0 && *more) {
            const int index = d->next(d->context);
            *more = index != RUN_NO_MORE;
            if (index >= 0) give_run(&c->worker[i], index), *active = true;
        }
        busy += c->worker[i].busy >= 0;
    }
    return busy;
}

/* Until the dealer has no more. It must be asked again and again, as its news come by another way
 * than pipes: often while something happens, ever less often while nothing does. */
static bool serve_stream(struct campaign *c, const struct run_dealer *d, struct err *e)
{
    int64_t pause = LEAST_PAUSE_US;
    for (bool more = true;;) {
        bool active = false;
        if (!d->attend(d->context, &active, e)) return false;
        if (deal(c, d, &more, &active) == 0 && !more) return true;
        struct pollfd p[MOST_WORKERS];
        pause = active ? LEAST_PAUSE_US : pause < MOST_PAUSE_US ? 2 * pause : MOST_PAUSE_US;
        if (!wait_for_answers(c, p, pause, e)) return false;
        for (int i = 0; i < c->nworker; i++) {
            if (p[i].fd < 0 || !p[i].revents) continue;
            const int index = c->worker[i].busy;
            pause = LEAST_PAUSE_US;
            if (!take_answer(c, &c->worker[i], e) || !hand_one(c, index)) return false;
        }
    }
}

/* After a failure workers are killed; otherwise they end by themselves when their pipes close.
 * All are told before any is waited for. */
static void stop_workers(struct campaign *c, bool at_once)
{
    for (int i = 0; i < c->nworker; i++) {
        if (c->worker[i].pid <= 0) continue;
        close(c->worker[i].orders);
        close(c->worker[i].answers);
        if (at_once) kill(c->worker[i].pid, SIGKILL);
    }
    for (int i = 0; i < c->nworker; i++) {
        if (c->worker[i].pid > 0) waitpid(c->worker[i].pid, NULL, 0);
        crash_record_destroy(c->worker[i].crash);
    }
}

/* All runs in this process, in order: one worker would only add copying. */
static bool run_here(struct campaign *c)
{
    struct run_cache *cache = c->cache ? c->cache : own_cache();
    bool ok = true;
    for (int i = 0; ok && i < c->nspec; i++) {
        if (c->skip && c->skip[i]) continue;
        struct arena *arena = arena_create();
        struct run_result result;
        const struct run_order own = own_order(c->order, i, c->cores, c->heartbeat);
        struct err why;
        err_clear(&why);
        if (run_sharing(&c->spec[i], &own, cache, arena, &result, &why))
            ok = c->done(c->context, &c->spec[i], &result);
        else ok = hand_refused(c, i, &why);
        arena_destroy(arena);
        c->ndone++;
        show_progress(c);
    }
    if (!c->cache) run_cache_destroy(cache);
    return ok;
}

/* On `workers` processes, in plan order, or as `dealer` (NULL: nobody) says. */
static bool run_workers(struct campaign *c, int workers, const struct run_dealer *dealer,
                        struct err *e)
{
    c->slot = memory_zeroed((size_t)c->nspec, sizeof *c->slot);
    c->arena = memory_zeroed((size_t)c->nspec, sizeof *c->arena);
    /* A worker that dies must not end the parent when it is written to. */
    struct sigaction ignore = {.sa_handler = SIG_IGN}, before;
    sigaction(SIGPIPE, &ignore, &before);
    bool ok = true;
    while (ok && c->nworker < workers) ok = start_worker(c, c->nworker, e);
    if (dealer) ok = ok && serve_stream(c, dealer, e);
    else ok = ok && hand_over(c) && serve(c, e);
    stop_workers(c, !ok);
    /* What is printed into a closed pipe later ends this process, as anybody expects. */
    sigaction(SIGPIPE, &before, NULL);
    /* results that were never handed over */
    for (int i = 0; i < c->nspec; i++) arena_destroy(c->arena[i]);
    free(c->arena);
    free(c->slot);
    return ok;
}

/* Memory that workers share with the parent, all zero; NULL when there is none, which only costs a
 * remark. */
static struct run_heartbeat *heartbeats_make(void)
{
    void *p = mmap(NULL, MOST_WORKERS * sizeof(struct run_heartbeat), PROT_READ | PROT_WRITE,
                   MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return p == MAP_FAILED ? NULL : p;
}

/* All runs of a campaign that is filled in as its functions say. */
static bool run_all(struct campaign *c, int workers, bool quiet, struct err *e)
{
    bool apart = false; /* people's code never runs in this process */
    for (int i = 0; i < c->nspec; i++) {
        if (c->skip && c->skip[i]) continue;
        c->ntodo++;
        if (run_loads_code(&c->spec[i])) apart = true;
    }
    /* Everything is stored already: no process is started. */
    if (c->ntodo == 0) return true;
    c->progress = progress_make("runs", c->ntodo, quiet);
    /* No more workers than runs; the limits are those of the arrays. */
    const int online = (int)sysconf(_SC_NPROCESSORS_ONLN);
    if (workers <= 0) workers = online;
    if (workers > c->ntodo) workers = c->ntodo;
    if (workers > MOST_WORKERS) workers = MOST_WORKERS;
    /* Runs side by side share the processors. */
    c->cores = online > workers ? online / workers : 1;
    if (!quiet) c->heartbeat = heartbeats_make();
    if (c->heartbeat && workers <= 1 && !apart)
        c->heartbeat->beat = show_progress, c->heartbeat->context = c;
    struct interrupt ctrl_c; /* whoever counts what is stored has begun one that knows more */
    interrupt_begin(&ctrl_c, NULL, c->ntodo);
    bool ok = workers <= 1 && !apart ? run_here(c) : run_workers(c, workers, NULL, e);
    interrupt_end(&ctrl_c);
    progress_end(&c->progress);
    if (c->heartbeat) munmap(c->heartbeat, MOST_WORKERS * sizeof *c->heartbeat);
    return ok;
}

bool run_campaign(const struct run_spec *spec, const struct run_order *order, int nspec,
                  const bool *skip, int workers, bool quiet, run_done_fn *done, void *context,
                  struct err *e)
{
    struct campaign c = {.spec = spec,
                         .order = order,
                         .nspec = nspec,
                         .skip = skip,
                         .done = done,
                         .context = context};
    return run_all(&c, workers, quiet, e);
}

bool run_campaign_again(const struct run_spec *spec, int nspec, int workers,
                        struct run_cache *cache, run_done_fn *done, void *context, struct err *e)
{
    struct campaign c = {
        .spec = spec, .nspec = nspec, .cache = cache, .done = done, .context = context};
    return run_all(&c, workers, true, e);
}

bool run_stream(const struct run_spec *spec, const struct run_order *order, int nspec, int workers,
                const struct run_dealer *dealer, struct err *e)
{
    struct campaign c = {
        .spec = spec, .order = order, .nspec = nspec, .done = dealer->done,
        .context = dealer->context};
    return run_workers(&c, workers < MOST_WORKERS ? workers : MOST_WORKERS, dealer, e);
}
