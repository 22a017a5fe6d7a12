/* side_by_side.c - see side_by_side.h.
 *
 * Whoever is idle takes the next piece, by a counter that all share: pieces may be of very
 * different lengths. Each worker answers through a pipe of its own. */
#include "study/side_by_side.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/check.h"
#include "base/process.h"
#include "base/whole.h"

enum { MOST_WORKERS = 64 };

/* What travels in front of a result. */
struct head {
    int piece;
    bool ok;
    struct err error;
    size_t bytes;
};

/* A result that waits for its turn. */
struct waiting {
    bool here;
    struct head head;
    char *data; /* owned */
};

struct crew {
    const struct pieces *p;
    atomic_int *next;        /* shared by all processes */
    struct waiting *waiting; /* (p->n) */
    int taken;               /* all before it have been taken */
    int nworker;
    pid_t pid[MOST_WORKERS];
    struct pollfd answers[MOST_WORKERS]; /* fd -1: has ended */
};

/* Pieces, until there are no more; a worker ends with its parent. */
static _Noreturn void work(const struct crew *c, pid_t parent, int answers)
{
    if (!process_end_with(parent)) _exit(0);
    for (int at; (at = atomic_fetch_add(c->next, 1)) < c->p->n;) {
        const int i = c->p->turn ? c->p->turn[at] : at;
        struct head h = {.piece = i};
        const void *data = NULL;
        err_clear(&h.error);
        h.ok = c->p->make(c->p->context, i, &data, &h.bytes, &h.error);
        if (!h.ok) h.bytes = 0;
        if (!write_whole(answers, &h, sizeof h) || !write_whole(answers, data, h.bytes)) break;
    }
    _exit(0);
}

/* Children keep no end of a pipe that is not theirs, or others would not see it closed. */
static bool start(struct crew *c, struct err *e)
{
    int fd[2];
    if (pipe(fd) != 0) return err_set(e, ERR_INTERNAL, "no pipe: %s", strerror(errno));
    const pid_t parent = getpid(), pid = fork();
    if (pid < 0) return err_set(e, ERR_INTERNAL, "no worker process: %s", strerror(errno));
    if (pid == 0) {
        close(fd[0]);
        for (int i = 0; i < c->nworker; i++) close(c->answers[i].fd);
        work(c, parent, fd[1]);
    }
    close(fd[1]);
    c->pid[c->nworker] = pid;
    c->answers[c->nworker++] = (struct pollfd){.fd = fd[0], .events = POLLIN};
    return true;
}

/* Hand over what is next in order, as far as it is there. */
static bool take_some(struct crew *c, struct err *e)
{
    while (c->taken < c->p->n && c->waiting[c->taken].here) {
        struct waiting *w = &c->waiting[c->taken];
        if (!w->head.ok) *e = w->head.error;
        const bool ok =
            w->head.ok && c->p->take(c->p->context, c->taken, w->data, w->head.bytes, e);
        free(w->data);
        w->data = NULL;
        c->taken++;
        if (!ok) return false;
    }
    return true;
}

/* One answer; false when the worker has closed its pipe. */
static bool receive(struct crew *c, int fd)
{
    struct head h;
    if (!read_whole(fd, &h, sizeof h)) return false;
    CHECK(h.piece >= 0 && h.piece < c->p->n);
    struct waiting *w = &c->waiting[h.piece];
    *w = (struct waiting){.head = h, .data = malloc(h.bytes + 1)};
    CHECK(w->data != NULL);
    w->here = read_whole(fd, w->data, h.bytes);
    return w->here;
}

/* Until all pieces are taken. A pipe that ends before means that a worker has died. */
static bool serve(struct crew *c, struct err *e)
{
    int open = c->nworker;
    while (c->taken < c->p->n) {
        if (open == 0)
            return err_set(e, ERR_INTERNAL, "a worker process died before piece %d was done",
                           c->taken + 1);
        if (poll(c->answers, (nfds_t)c->nworker, -1) < 0) {
            if (errno == EINTR) continue;
            return err_set(e, ERR_INTERNAL, "poll: %s", strerror(errno));
        }
        for (int i = 0; i < c->nworker; i++) {
            if (c->answers[i].revents == 0 || receive(c, c->answers[i].fd)) continue;
            close(c->answers[i].fd);
            c->answers[i] = (struct pollfd){.fd = -1};
            open--;
        }
        if (!take_some(c, e)) return false;
    }
    return true;
}

/* After a failure nobody waits for what is still being made. */
static void end(struct crew *c, bool at_once)
{
    for (int i = 0; i < c->nworker; i++) {
        if (at_once) kill(c->pid[i], SIGKILL);
        while (waitpid(c->pid[i], NULL, 0) < 0 && errno == EINTR) {
        }
        if (c->answers[i].fd >= 0) close(c->answers[i].fd);
    }
    for (int i = 0; i < c->p->n; i++) free(c->waiting[i].data);
    free(c->waiting);
}

/* In this process: one worker would only add copying. */
static bool one_by_one(const struct pieces *p, struct err *e)
{
    for (int i = 0; i < p->n; i++) {
        const void *data = NULL;
        size_t bytes = 0;
        if (!p->make(p->context, i, &data, &bytes, e) || !p->take(p->context, i, data, bytes, e))
            return false;
    }
    return true;
}

bool side_by_side(const struct pieces *p, int workers, struct err *e)
{
    if (workers <= 0) workers = (int)sysconf(_SC_NPROCESSORS_ONLN);
    if (workers > MOST_WORKERS) workers = MOST_WORKERS;
    if (workers > p->n) workers = p->n;
    if (workers <= 1) return one_by_one(p, e);
    struct crew c = {.p = p};
    c.next = mmap(NULL, sizeof *c.next, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (c.next == MAP_FAILED) return err_set(e, ERR_INTERNAL, "no memory: %s", strerror(errno));
    c.waiting = calloc((size_t)p->n, sizeof *c.waiting);
    CHECK(c.waiting != NULL);
    bool ok = true;
    for (int i = 0; ok && i < workers; i++) ok = start(&c, e);
    ok = ok && serve(&c, e);
    end(&c, !ok);
    munmap(c.next, sizeof *c.next);
    return ok;
}
