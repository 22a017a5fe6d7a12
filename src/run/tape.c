/* tape.c - see tape.h.
 *
 * Writing: a struct comm of our own between the program and the virtual processor notes each call
 * and hands it on. Repeating: the notes, called one after the other. Requests live with the
 * program; a note knows them by their place among those of the rank that are in progress.
 *
 * A tape is read once a run, by ranks in turn, so that it comes from memory and not from the cache.
 * Few notes differ in more than their peer, and these are told apart once: a step is a peer and the
 * number of a call in a table that stays in the cache, 8 bytes instead of 88. */
#include "run/tape.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/digest.h"
#include "base/memory.h"
#include "sim/fiber.h"
#include "spec/collective_spec.h"

/* MOST_TASKS, MOST_BYTES: what one process keeps. MOST_REQUESTS: of a rank in progress at once; a
 * program with more is not repeated. */
enum { MOST_TASKS = 512, MOST_BYTES = 192 << 20, MOST_REQUESTS = 64, NO_REQUEST = MOST_REQUESTS };

enum what { SEND, RECEIVE, WAIT, BARRIER, WORK, STAGE };

/* A call; `at`: number of its request, or of its stage. All of its bytes are members'. */
struct call {
    int64_t bytes, tag;
    struct work work;
    int32_t at, what;
};

/* A call of one rank as it is written down; `at`: also the number of its work. */
struct note {
    int64_t bytes, tag;
    int32_t peer, at;
    int32_t what;
};

/* The same in a tape that is whole. */
struct step {
    int32_t peer, call;
};

/* What one rank did. */
struct part {
    struct note *note;       /* (n) owned, NULL when the tape is whole */
    struct work *work;       /* (nwork) likewise */
    const struct step *step; /* (n) of a whole tape, which owns it */
    int n, room, nwork, work_room;
    int requests; /* the most in progress at once */
    bool unfit;   /* it did what cannot be repeated */
};

/* What the ranks' doing follows from: no machine, no seed. */
struct task {
    const struct program_type *type;
    struct model_spec model;
    struct kernel_spec kernel;
    unsigned keep;
    int nrank;
};

struct tape {
    struct task task;
    struct tapes *all;
    bool whole, unfit;
    struct part *part;               /* (task.nrank) owned, NULL: nothing is written */
    struct step *step;               /* of all ranks, one after the other; owned, as is call */
    struct call *call;               /* those that differ */
    double *output[PROGRAM_OUTPUTS]; /* owned; NULL: none */
    int64_t stack_peak_bytes;        /* of the program itself */
};

struct tapes {
    bool at_once;
    struct fiber_pool *stacks; /* of the last run that repeated one, NULL: none; owned */
    int n;
    size_t bytes; /* of all that are whole */
    struct tape tape[MOST_TASKS];
};

struct tapes *tapes_create(bool at_once)
{
    struct tapes *t = memory_zeroed(1, sizeof *t);
    t->at_once = at_once;
    return t;
}

/* What was written down goes: a whole tape has its steps. */
static void clear_notes(struct tape *t)
{
    for (int i = 0; t->part && i < t->task.nrank; i++) {
        free(t->part[i].note);
        free(t->part[i].work);
        t->part[i].note = NULL;
        t->part[i].work = NULL;
    }
}

/* Its notes go, its task stays known. */
static void clear(struct tape *t)
{
    clear_notes(t);
    for (int i = 0; i < PROGRAM_OUTPUTS; i++) free(t->output[i]), t->output[i] = NULL;
    free(t->part);
    free(t->step);
    free(t->call);
    t->part = NULL;
    t->step = NULL;
    t->call = NULL;
    t->whole = false;
}

void tapes_destroy(struct tapes *t)
{
    for (int i = 0; t && i < t->n; i++) clear(&t->tape[i]);
    if (t) fiber_pool_destroy(t->stacks);
    free(t);
}

/* Structs are compared as bytes: padding that differs would only cost a tape. */
static bool same(const struct task *a, const struct task *b)
{
    return a->type == b->type && a->nrank == b->nrank && a->keep == b->keep &&
           memcmp(&a->kernel, &b->kernel, sizeof a->kernel) == 0 &&
           memcmp(&a->model, &b->model, sizeof a->model) == 0;
}

static struct task task_of(const struct program_run *r)
{
    return (struct task){r->type, r->spec.model, r->spec.kernel, r->order.keep, r->spec.nrank};
}

/* What is known of a task; NULL: nothing. */
static struct tape *tape_of(struct tapes *t, const struct task *task)
{
    for (int i = 0; i < t->n; i++)
        if (same(&t->tape[i].task, task)) return &t->tape[i];
    return NULL;
}

struct tape *tape_for(struct tapes *t, const struct program_run *r)
{
    const struct task task = task_of(r);
    /* Processes that share a run have parts of its ranks. What a network does by itself depends on
     * the machine. */
    if (!t || !r->type->repeats || r->order.hosts || (r->order.keep & KEEP_SCENES) ||
        collective_meets(&r->spec))
        return NULL;
    struct tape *tape = tape_of(t, &task);
    const bool seen = tape != NULL;
    if (!tape && t->n < MOST_TASKS) {
        tape = &t->tape[t->n++];
        *tape = (struct tape){.task = task, .all = t};
    }
    /* A first run, and one that has turned out not to repeat itself, are made as ever. */
    if (!tape || tape->unfit || !(seen || t->at_once)) return NULL;
    if (!tape->part) tape->part = memory_zeroed((size_t)task.nrank, sizeof *tape->part);
    return tape;
}

bool tape_whole(const struct tape *t) { return t->whole; }

struct fiber_pool **tape_stacks(const struct tape *t) { return t->whole ? &t->all->stacks : NULL; }

size_t tape_workspace(const struct tape *t, int rank)
{
    return ((size_t)t->part[rank].requests + 1) * sizeof(struct comm_request);
}

/* --- writing ---------------------------------------------------------------------------------- */

/* The comm that a program sees while it is written down. */
struct writer {
    struct comm comm; /* first: the program's */
    struct comm *real;
    struct part *part;
    int n; /* requests in progress, each at its place; NULL: a free one */
    struct comm_request *request[MOST_REQUESTS];
};

static struct writer *writer_of(struct comm *c) { return (struct writer *)c; }

/* The call site goes on to whoever explains a deadlock. */
static struct comm *real_of(struct comm *c)
{
    struct comm *real = writer_of(c)->real;
    comm_site(real, c->file, c->line);
    return real;
}

static void add(struct part *p, const struct note *note)
{
    if (p->n == p->room) {
        p->room = p->room ? 2 * p->room : 64;
        p->note = memory_resize(p->note, (size_t)p->room, sizeof *p->note);
    }
    p->note[p->n++] = *note;
}

/* The place of a request that begins: its own where it has one, else a free one. */
static int place_of(struct writer *w, struct comm_request *r)
{
    int place = 0;
    if (!r) return NO_REQUEST;
    for (int i = w->n - 1; i >= 0; i--)
        if (w->request[i] == r) return i;
    while (place < w->n && w->request[place]) place++;
    if (place == MOST_REQUESTS) {
        w->part->unfit = true;
        return NO_REQUEST;
    }
    if (place == w->n) w->n++;
    if (w->n > w->part->requests) w->part->requests = w->n;
    w->request[place] = r;
    return place;
}

static void write_send(struct comm *c, int dst, int64_t tag, const void *data, int64_t bytes,
                       struct comm_request *r)
{
    struct writer *w = writer_of(c);
    struct comm *real = real_of(c);
    add(w->part, &(struct note){bytes, tag, dst, place_of(w, r), SEND});
    real->type->isend(real, dst, tag, data, bytes, r);
}

static void write_receive(struct comm *c, int src, int64_t tag, void *buffer, int64_t bytes,
                          struct comm_request *r)
{
    struct writer *w = writer_of(c);
    struct comm *real = real_of(c);
    add(w->part, &(struct note){bytes, tag, src, place_of(w, r), RECEIVE});
    real->type->irecv(real, src, tag, buffer, bytes, r);
}

/* A request that never began is complete: waiting for it is a call all the same. */
static void write_wait(struct comm *c, struct comm_request *r)
{
    struct writer *w = writer_of(c);
    struct comm *real = real_of(c);
    int place = NO_REQUEST;
    for (int i = w->n - 1; i >= 0 && place == NO_REQUEST; i--)
        if (w->request[i] == r) place = i;
    add(w->part, &(struct note){.at = place, .what = WAIT});
    if (place != NO_REQUEST) w->request[place] = NULL;
    real->type->wait(real, r);
}

static void write_barrier(struct comm *c)
{
    struct comm *real = real_of(c);
    add(writer_of(c)->part, &(struct note){.what = BARRIER});
    real->type->barrier(real);
}

static void write_work(struct comm *c, const struct work *work)
{
    struct writer *w = writer_of(c);
    struct part *p = w->part;
    if (p->nwork == p->work_room) {
        p->work_room = p->work_room ? 2 * p->work_room : 64;
        p->work = memory_resize(p->work, (size_t)p->work_room, sizeof *p->work);
    }
    p->work[p->nwork] = *work;
    add(p, &(struct note){.at = p->nwork++, .what = WORK});
    w->real->type->work(w->real, work);
}

static void write_stage(struct comm *c, int stage)
{
    struct writer *w = writer_of(c);
    add(w->part, &(struct note){.at = stage, .what = STAGE});
    w->real->type->stage(w->real, stage);
}

/* Costs no time: outputs are kept as a whole when all ranks have ended (tape_end). */
static void write_publish(struct comm *c, int output, int64_t first, int64_t n, const double *data)
{
    struct comm *real = writer_of(c)->real;
    real->type->publish(real, output, first, n, data);
}

static void write_end(struct comm *c, const char *text)
{
    struct comm *real = real_of(c);
    real->type->end_run(real, text);
}

/* Who looks at the clock may do something else on another machine. */
static int64_t write_now(struct comm *c)
{
    struct writer *w = writer_of(c);
    w->part->unfit = true;
    return w->real->type->now_ps(w->real);
}

static void write_elapse(struct comm *c, int64_t ps)
{
    struct writer *w = writer_of(c);
    w->part->unfit = true;
    w->real->type->elapse(w->real, ps);
}

/* Calls that depend on time (comm_match.h), and the network's own collectives, are not there:
 * programs that repeat themselves make none (program_type.repeats). */
static const struct comm_type writer_type = {
    .name = "written down",
    .isend = write_send,
    .irecv = write_receive,
    .wait = write_wait,
    .barrier = write_barrier,
    .work = write_work,
    .stage = write_stage,
    .now_ps = write_now,
    .publish = write_publish,
    .elapse = write_elapse,
    .end_run = write_end,
};

static void write_rank(struct part *p, struct comm *c, const struct rank_program *rank,
                       const void *job, void *workspace)
{
    struct writer w = {.comm = *c, .real = c, .part = p};
    w.comm.type = &writer_type;
    rank->run(&w.comm, job, workspace);
}

/* --- repeating -------------------------------------------------------------------------------- */

/* Messages without contents leave buffers as they are, so that there are none. */
static void repeat_rank(const struct part *p, const struct call *call, struct comm *c,
                        struct comm_request *request)
{
    struct comm_request *complete = &request[p->requests];
    for (const struct step *s = p->step; s < p->step + p->n; s++) {
        const struct call *x = &call[s->call];
        struct comm_request *r = x->at == NO_REQUEST ? NULL : &request[x->at];
        switch ((enum what)x->what) {
        case SEND:
            comm_isend(c, s->peer, x->tag, NULL, x->bytes, r);
            break;
        case RECEIVE:
            comm_irecv(c, s->peer, x->tag, NULL, x->bytes, r);
            break;
        case WAIT:
            comm_wait(c, r ? r : complete);
            break;
        case BARRIER:
            comm_barrier(c);
            break;
        case WORK:
            comm_work(c, &x->work);
            break;
        case STAGE:
            comm_stage(c, x->at);
            break;
        }
    }
}

void tape_rank(struct tape *t, struct comm *c, const struct rank_program *rank, const void *job,
               void *workspace)
{
    struct part *p = &t->part[comm_rank(c)];
    if (t->whole) repeat_rank(p, t->call, c, workspace);
    else write_rank(p, c, rank, job, workspace);
}

/* --- from notes to steps ---------------------------------------------------------------------- */

/* The calls found so far, by open addressing with linear probing. */
struct calls {
    struct call *call; /* (n) */
    int n, *slot;      /* slot: (room, a power of two) number of a call + 1; 0: empty */
    size_t room;
};

static uint64_t call_digest(const struct call *x)
{
    const struct work *w = &x->work;
    uint64_t h = digest_mix(DIGEST_START, (uint64_t)x->bytes);
    h = digest_mix(digest_mix(h, (uint64_t)x->tag), (uint64_t)x->at);
    h = digest_mix(digest_mix(h, (uint64_t)x->what), w->flop);
    h = digest_mix(digest_mix(h, w->div), w->sqrt);
    h = digest_mix(digest_mix(h, w->trig), w->bytes);
    return digest_mix(digest_mix(h, w->call), w->moved);
}

/* Where `x` is, or belongs. */
static int *slot_of(const struct calls *all, const struct call *x)
{
    size_t at = (size_t)call_digest(x) & (all->room - 1);
    while (all->slot[at] && memcmp(&all->call[all->slot[at] - 1], x, sizeof *x) != 0)
        at = (at + 1) & (all->room - 1);
    return &all->slot[at];
}

/* At most half full, so that probing stays short. */
static void grow(struct calls *all)
{
    free(all->slot);
    all->room = all->room ? 4 * all->room : 1024;
    all->slot = memory_zeroed(all->room, sizeof *all->slot);
    all->call = memory_resize(all->call, all->room / 2, sizeof *all->call);
    for (int i = 0; i < all->n; i++) *slot_of(all, &all->call[i]) = i + 1;
}

static int number_of(struct calls *all, const struct call *x)
{
    if ((size_t)all->n == all->room / 2) grow(all);
    int *slot = slot_of(all, x);
    if (*slot == 0) {
        all->call[all->n] = *x;
        *slot = ++all->n;
    }
    return *slot - 1;
}

/* The notes of all ranks as steps in one block, in the ranks' order; returns its bytes and those of
 * the calls. */
static size_t tell_apart(struct tape *t)
{
    struct calls all = {0};
    size_t n = 0;
    for (int i = 0; i < t->task.nrank; i++) n += (size_t)t->part[i].n;
    struct step *step = t->step = memory_take(n, sizeof *step);
    for (int i = 0; i < t->task.nrank; i++) {
        struct part *p = &t->part[i];
        p->step = step;
        for (const struct note *x = p->note; x < p->note + p->n; x++) {
            struct call call = {.bytes = x->bytes, .tag = x->tag, .at = x->at, .what = x->what};
            if (x->what == WORK) call.work = p->work[x->at], call.at = 0;
            *step++ = (struct step){x->peer, number_of(&all, &call)};
        }
    }
    free(all.slot);
    t->call = all.call;
    clear_notes(t);
    return n * sizeof *step + (size_t)all.n * sizeof *all.call;
}

/* --- the end ---------------------------------------------------------------------------------- */

/* Whether all of it can be repeated. */
static bool fit(const struct tape *t)
{
    bool good = true;
    for (int i = 0; i < t->task.nrank; i++) good = good && !t->part[i].unfit;
    return good;
}

static void keep_outputs(struct tape *t, const struct program_run *r)
{
    for (int i = 0; i < PROGRAM_OUTPUTS; i++) {
        const struct comm_output *o = &r->output[i];
        if (!o->x) continue;
        t->output[i] = memory_zeroed((size_t)o->n + 1, sizeof *o->x);
        memcpy(t->output[i], o->x, (size_t)o->n * sizeof *o->x);
    }
}

void tape_none(struct tapes *all, const struct program_run *r, const struct run_result *out)
{
    const struct task task = task_of(r);
    struct tape *t = all ? tape_of(all, &task) : NULL;
    if (t && out->status == RUN_OK) t->stack_peak_bytes = out->stack_peak_bytes;
}

bool tape_end(struct tapes *all, struct tape *t, struct program_run *r, struct run_result *out)
{
    const bool well = out->status == RUN_OK;
    if (t->whole) {
        /* The answer is judged and checked like any other. */
        for (int i = 0; well && i < PROGRAM_OUTPUTS; i++)
            if (t->output[i])
                memcpy(r->output[i].x, t->output[i], (size_t)r->output[i].n * sizeof(double));
        out->stack_peak_bytes = t->stack_peak_bytes;
        return well;
    }
    const bool fits = well && fit(t);
    const size_t bytes = fits ? tell_apart(t) : 0;
    /* A tape that is not whole says nothing: a run that failed, a request too many, no room. */
    if (!fits || all->bytes + bytes > MOST_BYTES) {
        clear(t);
        t->unfit = true;
        return true;
    }
    keep_outputs(t, r);
    /* Writing takes stack as well: a run before that was not written down tells the program's. */
    if (t->stack_peak_bytes) out->stack_peak_bytes = t->stack_peak_bytes;
    else t->stack_peak_bytes = out->stack_peak_bytes;
    t->whole = true;
    all->bytes += bytes;
    return true;
}
