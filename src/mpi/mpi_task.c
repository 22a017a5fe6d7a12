/* mpi_task.c - operations that go on while their rank does something else, each on a stack of its
 * own.
 *
 * A non-blocking collective runs the same algorithm as the blocking one. Where it has to wait it
 * leaves its stack; the rank goes on, and whenever the rank itself waits or tests, it waits for
 * what its operations wait for as well and lets those go on whose message came. So progress depends
 * on simulated time and on the program's calls alone. */
#include "base/check.h"
#include "mpi/mpi_internal.h"
#include "sim/fiber.h"

enum { FIRST_POOL = 8 };

/* Stacks are mapped by the dozen, each pool twice the one before, and kept for the next operation
 * of any rank. */
struct mpi_pool {
    struct mpi_pool *next;
    struct fiber_pool *fibers;
    int n;
};

struct mpi_stack {
    struct mpi_stack *next;
    struct fiber_pool *fibers;
    struct fiber *fiber;
    int number;
};

/* Doubling keeps the number of mappings small: the kernel limits them. Stacks are given
 * back when the run ends. */
static void more_stacks(struct mpi_world *w)
{
    struct err e = {0};
    struct mpi_pool *p = arena_take(w->arena, sizeof *p);
    p->n = w->pools ? 2 * w->pools->n : FIRST_POOL;
    p->fibers = fiber_pool_create(p->n, TASK_STACK, &e);
    if (!p->fibers) check_memory((size_t)p->n * TASK_STACK);
    p->next = w->pools;
    w->pools = p;
    /* From the last down, so that the free list begins with the first: runs use the same
     * stacks. */
    for (int i = p->n - 1; i >= 0; i--) {
        struct mpi_stack *s = arena_take(w->arena, sizeof *s);
        *s = (struct mpi_stack){.next = w->free_stack, .fibers = p->fibers, .number = i};
        w->free_stack = s;
    }
}

void mpi_tasks_end(struct mpi_world *w)
{
    for (struct mpi_pool *p = w->pools; p; p = p->next) fiber_pool_destroy(p->fibers);
    w->pools = NULL;
}

/* The first and last that runs on the operation's own stack. */
static void begin(void *argument)
{
    struct mpi_task *t = argument;
    t->run(t->self, t->argument);
    t->done = true;
}

/* Run t until it waits or is done; a task that ends leaves the list. */
void mpi_task_go_on(struct mpi_rank *r, struct mpi_task *t)
{
    /* The operation may call functions of the program, which call MPI: the rank's call in
     * progress comes back after it. */
    const char *call = r->call;
    r->running = t;
    fiber_enter(t->stack->fiber);
    r->running = NULL;
    r->call = call;
    if (!t->done) return;
    t->stack->next = r->world->free_stack;
    r->world->free_stack = t->stack;
    t->stack = NULL;
    for (struct mpi_task **at = &r->tasks; *at; at = &(*at)->next)
        if (*at == t) {
            *at = t->next;
            break;
        }
}

struct mpi_task *mpi_task_start(struct mpi_rank *r, mpi_task_fn *run, void *argument)
{
    /* Operations do not start operations: a program's function that is called inside one
     * may not either. */
    if (r->running) mpi_fail(r, "called by a function inside an operation in progress");
    struct mpi_task *t = mpi_take_zero(r->world, sizeof *t), **end = &r->tasks;
    if (!r->world->free_stack) more_stacks(r->world);
    struct mpi_stack *s = r->world->free_stack;
    r->world->free_stack = s->next;
    *t = (struct mpi_task){.self = r, .stack = s, .run = run, .argument = argument};
    /* the oldest first, so that equal times are served in the order of the calls */
    while (*end) end = &(*end)->next;
    *end = t;
    /* It runs until its first wait. If it never waits, it is done on return; its memory
     * is the request's to free. */
    s->fiber = fiber_start(s->fibers, s->number, begin, t);
    mpi_task_go_on(r, t);
    return t;
}

/* Up to MOST requests are looked at in one call without asking for memory. */
enum { MOST = 32 };

/* watch: what is wanted, then what each task waits for; their number in *n. Returns `few` or memory
 * of its own. */
static struct comm_request **watch(struct mpi_rank *r, int nwanted,
                                   struct comm_request *const *wanted, struct comm_request **few,
                                   int *n)
{
    struct comm_request **all = few;
    *n = nwanted;
    for (struct mpi_task *t = r->tasks; t; t = t->next) (*n)++;
    if (*n > MOST) all = mpi_take(r->world, *n * (int64_t)sizeof *all);
    for (int i = 0; i < nwanted; i++) all[i] = wanted[i];
    int i = nwanted;
    for (struct mpi_task *t = r->tasks; t; t = t->next) all[i++] = t->blocked;
    return all;
}

/* One look or wait over all at once. The index found says who is meant: the caller's own,
 * or a task's. */
int mpi_progress(struct mpi_rank *r, int nwanted, struct comm_request *const *wanted, bool block)
{
    struct comm_request *few[MOST];
    int n, found;
    struct comm_request **all = watch(r, nwanted, wanted, few, &n);
    if (block) found = comm_wait_any(r->comm, n, all);
    else found = comm_test_any(r->comm, n, all);
    if (all != few) mpi_give(r->world, all);
    /* A task whose message is there goes on now, on its own stack, while the rank's stack
     * stands here. */
    if (found < nwanted) return found < 0 ? PROGRESS_NONE : found;
    struct mpi_task *t = r->tasks;
    for (int i = nwanted; i < found; i++) t = t->next;
    mpi_task_go_on(r, t);
    return PROGRESS_TASK;
}

/* The same call on both kinds of stack. On an operation's it leaves, and whoever waits on
 * the rank's stack finds `blocked`; on the rank's it waits for all, or plainly when
 * nothing else goes on, which costs no search. */
void mpi_wait_request(struct mpi_rank *r, struct comm_request *q)
{
    while (q->active) {
        if (r->running) {
            r->running->blocked = q;
            fiber_leave(r->running->stack->fiber);
        } else if (!r->tasks) comm_wait(r->comm, q);
        else mpi_progress(r, 1, &q, true);
    }
}

/* Something must move, or the run is a deadlock, which comm.h reports. */
void mpi_wait_task(struct mpi_rank *r, const struct mpi_task *t)
{
    while (!t->done) CHECK(mpi_progress(r, 0, NULL, true) == PROGRESS_TASK);
}

/* Each look that finds nothing takes the time of a poll, so a loop of these ends. */
void mpi_poll_tasks(struct mpi_rank *r)
{
    while (r->tasks && mpi_progress(r, 0, NULL, false) == PROGRESS_TASK) continue;
}
