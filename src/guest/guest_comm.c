/* guest_comm.c - the functions behind mimdsim/program.h: what a program asks for, checked, and
 * handed on to comm.h and the collectives.
 *
 * What the program's header calls struct comm is a struct guest_rank. A request of the program
 * holds one of ours in its reserved bytes. Whatever is wrong in a call ends the run as failed: the
 * program is somebody's, and its mistakes are no reason to end the simulator.
 *
 * docs/own-program.md describes the calls for their users. Images reach them through a
 * table (guest_calls), so that they need no symbol of the simulator. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/memory.h"
#include "base/picoseconds.h"
#include "comm/collectives.h"
#include "guest/guest_world.h"
#include "program/program.h"

/* Half of the tags of 31 bits each, so that no receive with a mask can take a
 * collective's message. */
enum { TAGS = 1 << 30 }; /* of programs: those from here on are the collectives' */

_Static_assert(sizeof(struct comm_request) <= sizeof((struct mimdsim_request *)0)->reserved,
               "a request of ours fits into one of the program's");

static struct guest_rank *rank_of(const struct comm *handle) { return (struct guest_rank *)handle; }

/* The rank's comm, which from now on is called from `file`, line `line`. Call sites are
 * the program's (keep_site): collectives inside must not overwrite them with places in
 * the simulator. */
static struct comm *at(const struct comm *handle, const char *file, int line)
{
    struct comm *c = rank_of(handle)->comm;
    c->keep_site = 0;
    comm_site(c, file, line);
    c->keep_site = 1;
    return c;
}

/* end_run does not return; the compiler cannot know that of a pointer to a function. */
static _Noreturn void stop(struct comm *c, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static _Noreturn void stop(struct comm *c, const char *format, ...)
{
    char text[512];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    c->type->end_run(c, text);
    __builtin_unreachable();
}

/* --- messages --------------------------------------------------------------------------------- */

/* The program owns the memory; whatever it does to it, only its own run suffers. */
static struct comm_request *ours(struct mimdsim_request *r)
{
    return (struct comm_request *)(void *)r->reserved;
}

/* What a request received, where the program looks for it. */
static void tell(struct mimdsim_request *r)
{
    const struct comm_request *in = ours(r);
    r->source = in->peer;
    r->tag = in->tag;
    r->bytes = in->bytes;
    r->truncated = in->truncated;
}

/* Checked here in the words of program.h; rooms below would speak of their own terms. */
static void check_message(struct comm *c, int peer, bool any, int64_t tag, int64_t bytes,
                          const void *data)
{
    if ((peer < 0 || peer >= c->size) && !(any && peer == COMM_ANY_SOURCE))
        stop(c, "names rank %d; expected 0 to %d", peer, c->size - 1);
    if (tag < 0 || tag >= TAGS)
        stop(c, "uses tag %lld; expected 0 to %d", (long long)tag, TAGS - 1);
    if (bytes < 0) stop(c, "names a message of %lld bytes", (long long)bytes);
    if (bytes > 0 && data == NULL)
        stop(c, "names a message of %lld bytes at NULL", (long long)bytes);
}

/* Without a request nobody waits for the end of the send, which a synchronous one would
 * make pointless. */
static void call_isend(struct comm *handle, int to, int64_t tag, const void *data, int64_t bytes,
                       int synchronous, struct mimdsim_request *r, const char *file, int line)
{
    struct comm *c = at(handle, file, line);
    check_message(c, to, false, tag, bytes, data);
    /* A request that the program did not initialise is as good as one that it did. */
    if (r != NULL) *r = (struct mimdsim_request){0};
    if (synchronous && r == NULL) stop(c, "a synchronous send needs a request to wait for");
    if (synchronous) c->type->isend_synchronous(c, to, tag, data, bytes, ours(r));
    else c->type->isend(c, to, tag, data, bytes, r != NULL ? ours(r) : NULL);
}

/* A receive of exactly that size: a message of another one is a mistake that the run
 * names. */
static void call_irecv(struct comm *handle, int from, int64_t tag, void *buffer, int64_t bytes,
                       struct mimdsim_request *r, const char *file, int line)
{
    struct comm *c = at(handle, file, line);
    check_message(c, from, false, tag, bytes, buffer);
    *r = (struct mimdsim_request){0};
    c->type->irecv(c, from, tag, buffer, bytes, ours(r));
}

/* Of a mask the bits above the program's tags count always: no message of a collective is taken. */
static int64_t whole_mask(int64_t mask)
{
    return (mask & (TAGS - 1)) | (COMM_WHOLE_TAG & ~(int64_t)(TAGS - 1));
}

/* Up to `capacity`: what is longer is cut, and the request says so. */
static void call_irecv_matching(struct comm *handle, int from, int64_t tag, int64_t mask,
                                void *buffer, int64_t capacity, struct mimdsim_request *r,
                                const char *file, int line)
{
    struct comm *c = at(handle, file, line);
    check_message(c, from, true, tag, capacity, buffer);
    *r = (struct mimdsim_request){0};
    c->type->irecv_matching(c, from, tag, whole_mask(mask), buffer, capacity, ours(r));
}

/* Waiting for a request that is not active does nothing, so loops over requests need no
 * special case. */
static void call_wait(struct comm *handle, struct mimdsim_request *r, const char *file, int line)
{
    struct comm *c = at(handle, file, line);
    if (!ours(r)->active) return;
    c->type->wait(c, ours(r));
    tell(r);
}

/* The requests of a list as ours; NULL and complete ones are passed over by the
 * simulator. The list is rebuilt at each call, as the program's structures are larger
 * than ours. */
static int complete_any(struct comm *c, int n, struct mimdsim_request **r, int block)
{
    struct comm_request **list = memory_zeroed((size_t)n + 1, sizeof *list);
    for (int i = 0; i < n; i++) list[i] = r[i] != NULL ? ours(r[i]) : NULL;
    const int done = c->type->complete_any(c, n, list, block);
    free(list);
    if (done >= 0) tell(r[done]);
    return done;
}

/* A request that is complete needs no look and costs no time. */
static int call_test(struct comm *handle, struct mimdsim_request *r, const char *file, int line)
{
    struct comm *c = at(handle, file, line);
    return !ours(r)->active || complete_any(c, 1, &r, 0) == 0;
}

static int call_wait_any(struct comm *handle, int n, struct mimdsim_request **r, int block,
                         const char *file, int line)
{
    struct comm *c = at(handle, file, line);
    if (n < 0) stop(c, "waits for one of %d requests", n);
    return complete_any(c, n, r, block);
}

static int call_probe(struct comm *handle, int from, int64_t tag, int64_t mask, int block,
                      struct mimdsim_request *out, const char *file, int line)
{
    struct comm *c = at(handle, file, line);
    struct comm_envelope seen = {0};
    check_message(c, from, true, tag, 0, NULL);
    const int there = c->type->probe(c, from, tag, whole_mask(mask), block, &seen, NULL);
    /* `out` is an envelope here and no request: it is never active. */
    *out = (struct mimdsim_request){.source = seen.source, .tag = seen.tag, .bytes = seen.bytes};
    return there;
}

/* 1: the receive was taken back; 0: its message is there or on its way into it. */
static int call_cancel(struct comm *handle, struct mimdsim_request *r, const char *file, int line)
{
    struct comm *c = at(handle, file, line);
    return ours(r)->active ? c->type->cancel(c, ours(r)) : 0;
}

/* --- collectives ------------------------------------------------------------------------------ */

/* Elements are eight bytes wide; one operation each is charged, as in room mpi. */
#define COMBINE(name, type, expression)                                                     \
    static void name(void *into_, const void *with_, bool before, int64_t n, void *context, \
                     struct work *w)                                                        \
    {                                                                                       \
        type *into = into_;                                                                 \
        const type *with = with_;                                                           \
        (void)before, (void)context;                                                        \
        w->flop += (uint64_t)n;                                                             \
        for (int64_t i = 0; i < n; i++) into[i] = (expression);                             \
    }
COMBINE(sum, double, into[i] + with[i])
COMBINE(product, double, into[i] * with[i])
COMBINE(least, double, with[i] < into[i] ? with[i] : into[i])
COMBINE(most, double, with[i] > into[i] ? with[i] : into[i])
/* Whole numbers wrap as the machine's do, without the compiler's leave to assume that none does. */
COMBINE(sum_int64, uint64_t, into[i] + with[i])
COMBINE(product_int64, uint64_t, into[i] * with[i])
COMBINE(least_int64, int64_t, with[i] < into[i] ? with[i] : into[i])
COMBINE(most_int64, int64_t, with[i] > into[i] ? with[i] : into[i])

/* In the order of enum comm_op. */
enum { MOST_INT64 = 7 };
static const struct collective_op ops[] = {
    {.combine = sum, .commutative = true, .operation = COMM_REAL},
    {.combine = product, .commutative = true},
    {.combine = least, .commutative = true, .idempotent = true, .operation = COMM_REAL},
    {.combine = most, .commutative = true, .idempotent = true, .operation = COMM_REAL},
    {.combine = sum_int64, .commutative = true, .operation = COMM_INTEGER},
    {.combine = product_int64, .commutative = true},
    {.combine = least_int64, .commutative = true, .idempotent = true, .operation = COMM_INTEGER},
    [MOST_INT64] = {.combine = most_int64,
                    .commutative = true,
                    .idempotent = true,
                    .operation = COMM_INTEGER},
};

/* The program's numbers are part of its binary interface, the simulator's are not. */
static enum collective_kind kind_of(struct comm *c, int kind)
{
    static const enum collective_kind kinds[] = {[MIMDSIM_BARRIER] = COLLECTIVE_BARRIER,
                                                 [MIMDSIM_BROADCAST] = COLLECTIVE_BROADCAST,
                                                 [MIMDSIM_REDUCE] = COLLECTIVE_REDUCE,
                                                 [MIMDSIM_ALLREDUCE] = COLLECTIVE_ALLREDUCE,
                                                 [MIMDSIM_GATHER] = COLLECTIVE_GATHER,
                                                 [MIMDSIM_SCATTER] = COLLECTIVE_SCATTER,
                                                 [MIMDSIM_ALLGATHER] = COLLECTIVE_ALLGATHER,
                                                 [MIMDSIM_ALLTOALL] = COLLECTIVE_ALLTOALL,
                                                 [MIMDSIM_SCAN] = COLLECTIVE_SCAN};
    if (kind < 0 || kind >= (int)(sizeof kinds / sizeof *kinds))
        stop(c, "calls no collective that there is");
    return kinds[kind];
}

/* These have an operation and elements; all others move bytes. */
static bool is_reduction(enum collective_kind kind)
{
    return kind == COLLECTIVE_REDUCE || kind == COLLECTIVE_ALLREDUCE || kind == COLLECTIVE_SCAN;
}

/* Sizes are those of this rank; whether ranks agree is seen when messages meet. */
static void check_collective(struct comm *c, const struct mimdsim_collective *k,
                             enum collective_kind kind)
{
    if (k->root < 0 || k->root >= c->size)
        stop(c, "names rank %d as root; expected 0 to %d", k->root, c->size - 1);
    if (k->n < 0) stop(c, "names a block or vector of length %lld", (long long)k->n);
    if (is_reduction(kind) && (k->op < 0 || k->op >= (int)(sizeof ops / sizeof *ops)))
        stop(c, "names operation %d, which there is not", k->op);
    for (int i = 0; i < c->size; i++)
        if ((k->send_bytes != NULL && k->send_bytes[i] < 0) ||
            (k->recv_bytes != NULL && k->recv_bytes[i] < 0))
            stop(c, "names a block of a negative size for rank %d", i);
}

/* A call of ours; buffers that the program leaves out where they do not count stand for nothing. */
static struct collective_call make_call(struct comm *c, const struct mimdsim_collective *k)
{
    /* Reductions count elements, all others bytes. The tags from TAGS on belong to
     * collectives, which are called one at a time. */
    struct collective_call call = {.kind = kind_of(c, k->kind),
                                   .comm = c,
                                   .tag = TAGS,
                                   .root = k->root,
                                   .count = k->n,
                                   .element = 1,
                                   .send = k->send,
                                   .recv = k->recv};
    check_collective(c, k, call.kind);
    if (is_reduction(call.kind)) {
        call.element = 8;
        call.op = &ops[k->op];
        call.exclusive = k->exclusive;
    }
    call.counts = k->recv_bytes;
    call.send_counts = k->send_bytes;
    return call;
}

static void call_collective(struct comm *handle, const struct mimdsim_collective *k,
                            const char *file, int line);

/* One step of a search: by the machine's eureka, else all ranks ask each other whether one has
 * found, and whether one has more to look at. Who has nothing left goes on asking. */
static int search(struct comm *handle, int state, const char *file, int line)
{
    struct comm *c = at(handle, file, line);
    if (state < COMM_SEARCH_GOES_ON || state > COMM_SEARCH_BEGIN)
        stop(c, "says %d in a search, which is no enum comm_search_state", state);
    if (c->hardware != NULL && c->hardware->eureka && c->type->search != NULL)
        return c->type->search(c, state);
    if (state == COMM_SEARCH_BEGIN) return 0;
    int64_t any[2];
    const struct mimdsim_collective k = {
        .kind = MIMDSIM_ALLREDUCE, .op = MOST_INT64, .send = any, .recv = any, .n = 2};
    do {
        any[0] = state == COMM_SEARCH_FOUND;
        any[1] = state == COMM_SEARCH_GOES_ON;
        call_collective(handle, &k, file, line);
    } while (state == COMM_SEARCH_EXHAUSTED && any[0] == 0 && any[1] != 0);
    return any[0] != 0 ? 1 + (state == COMM_SEARCH_FOUND) : any[1] != 0 ? 0 : -1;
}

static void call_collective(struct comm *handle, const struct mimdsim_collective *k,
                            const char *file, int line)
{
    struct guest_rank *g = rank_of(handle);
    if (k->kind == MIMDSIM_SEARCH) {
        *(int *)k->recv = search(handle, k->op, file, line);
        return;
    }
    struct comm *c = at(handle, file, line);
    struct collective_call call = make_call(c, k);
    const struct collective_algorithm *by = g->algorithm[call.kind];
    /* A barrier may be the machine's hardware, which no algorithm knows. */
    if (call.kind == COLLECTIVE_BARRIER && by == NULL) {
        c->type->barrier(c);
        return;
    }
    /* By name if the program chose one, else by the machine's rules, as built-in programs
     * do. A named one that does not apply ends the run: silently taking another would
     * falsify a measurement. */
    const struct collective_shape shape = collective_shape(&call);
    if (by != NULL && !collective_applies(by, &shape))
        stop(c, "%s by '%s' on %d ranks: it needs %s", collective_name(call.kind), by->name,
             c->size, by->needs);
    if (by == NULL) by = collective_choose(&shape, g->world->rule, g->world->nrule);
    /* From the heap and not from the run's arena, which would keep it until the run ends. */
    call.scratch = memory_take((size_t)collective_scratch(by, &shape, c->rank) + 64, 1);
    collective_run(by, &call);
    free(call.scratch);
}

/* For this rank from now on; all ranks must choose alike, as on a machine. */
static void call_algorithm(struct comm *handle, const char *collective, const char *name,
                           const char *file, int line)
{
    struct guest_rank *g = rank_of(handle);
    struct comm *c = at(handle, file, line);
    const enum collective_kind kind = collective_find(collective);
    if (kind == COLLECTIVE_KINDS) stop(c, "there is no collective '%.40s'", collective);
    g->algorithm[kind] = NULL;
    if (strcmp(name, "auto") == 0) return;
    g->algorithm[kind] = collective_algorithm_find(kind, name);
    char names[240];
    collective_algorithm_names(kind, names, (int)sizeof names);
    if (g->algorithm[kind] == NULL)
        stop(c, "%s has no algorithm '%.40s'; expected auto, %s", collective, name, names);
}

/* --- computing, stages, results --------------------------------------------------------------- */

static int call_rank(const struct comm *handle) { return rank_of(handle)->comm->rank; }
static int call_ranks(const struct comm *handle) { return rank_of(handle)->comm->size; }

/* A serial code that asks depends on the number of ranks, so its answer is kept for that
 * number alone (serial_answers.c). */
static int call_run_ranks(const struct comm *handle)
{
    struct guest_world *w = rank_of(handle)->world;
    w->asked_size = true;
    return w->spec->nrank;
}

static void call_count(struct comm *handle, const struct mimdsim_counts *n)
{
    struct guest_rank *g = rank_of(handle);
    /* Bytes that an author states are those that move; a single one says that there are none, since
     * 0 would mean that nobody has counted. */
    const struct work w = {.moved = n->bytes > 0 ? n->bytes : 1,
                           .flop = n->flop,
                           .div = n->div,
                           .sqrt = n->sqrt,
                           .trig = n->trig,
                           .bytes = n->bytes,
                           .call = n->call};
    /* Counted blocks or host time tell the cost otherwise: then the author's counts do
     * nothing. */
    const double factor = g->world->spec->program.factor;
    if (g->world->cost != PROGRAM_COST_AUTHOR) return;
    /* Operations are counted by stage, unless a factor makes their time another one. */
    if (factor == 1) comm_work(g->comm, &w);
    else comm_elapse(g->comm, ps_rounded((double)node_cost_ps(&g->world->node, &w) * factor));
}

/* A serial code has one stage, whatever the program declares. */
static void call_stage(struct comm *handle, int stage, const char *file, int line)
{
    struct comm *c = at(handle, file, line);
    int n = 0;
    while (n < MIMDSIM_STAGES && rank_of(handle)->declared->stage[n] != NULL) n++;
    if (stage < 0 || stage >= n) stop(c, "names stage %d; the program declares %d", stage, n);
    if (!rank_of(handle)->world->alone) c->type->stage(c, stage);
}

static int64_t call_now_ps(struct comm *handle) { return comm_now_ps(rank_of(handle)->comm); }

/* Memory of the run, given back when it ends: programs need not free. It takes no simulated time;
 * on a real processor the clock stands until the system has given every page. */
static void *call_memory(struct comm *handle, int64_t bytes, const char *file, int line)
{
    struct comm *c = at(handle, file, line);
    if (bytes < 0) stop(c, "asks for %lld bytes of memory", (long long)bytes);
    const size_t size = (size_t)(bytes > 0 ? bytes : 1);
    if (c->type->pause == NULL) return arena_take(rank_of(handle)->world->memory, size);
    c->type->pause(c, 1);
    volatile char *memory = arena_take(rank_of(handle)->world->memory, size);
    for (size_t i = 0; i < size; i += 4096) memory[i] = 0;
    c->type->pause(c, 0);
    return (void *)(uintptr_t)memory;
}

/* By number in the program's declaration, which its header names by an enumeration. */
static void check_output(struct comm *handle, struct comm *c, int output)
{
    const char *const *name = rank_of(handle)->declared->output;
    if (output < 0 || output >= MIMDSIM_OUTPUTS || name[output] == NULL)
        stop(c, "names result %d, which the program does not declare", output);
}

/* Results are gathered on the host and take no simulated time. */
static void call_publish(struct comm *handle, int output, int64_t first, int64_t n,
                         const double *data, const char *file, int line)
{
    struct comm *c = at(handle, file, line);
    char why[160];
    check_output(handle, c, output);
    /* Ranks that share no memory: the backend gathers it, and kernel_take puts it in place. */
    if (c->type->mark != NULL) {
        comm_publish(c, output, first, n, data);
        return;
    }
    if (!guest_results_put(rank_of(handle)->world->results, output, first, n, data, why,
                           (int)sizeof why))
        stop(c, "%s, '%s'", why, rank_of(handle)->declared->output[output]);
}

/* The check sees what ranks published, whole; ranks do not see each other's. */
static const double *call_output(struct comm *handle, int output, int64_t *n, const char *file,
                                 int line)
{
    struct comm *c = at(handle, file, line);
    const struct guest_results *seen = rank_of(handle)->world->seen;
    check_output(handle, c, output);
    if (seen == NULL) stop(c, "comm_output is for check alone");
    *n = seen->of[output].n;
    return *n > 0 ? seen->of[output].x : NULL;
}

/* Compared with the declared tolerance where results are judged (program_check_add). */
static void call_error(struct comm *handle, const char *quantity, double relative, const char *file,
                       int line)
{
    struct comm *c = at(handle, file, line);
    struct guest_world *w = rank_of(handle)->world;
    if (w->check == NULL) stop(c, "comm_error is for check alone");
    if (w->check->nerror == RUN_MAX_ERRORS) stop(c, "states more than %d errors", RUN_MAX_ERRORS);
    program_check_add(w->check, quantity, "check", relative, w->tolerance);
}

/* Lines that were begun are printed before the message that ends the run. */
static void call_fail(struct comm *handle, const char *text, const char *file, int line)
{
    guest_rank_end_lines(rank_of(handle));
    stop(at(handle, file, line), "%s", text);
}

const struct comm_functions guest_calls = {
    .abi = MIMDSIM_COMM_ABI,
    .size = sizeof(struct comm_functions),
    .rank = call_rank,
    .ranks = call_ranks,
    .run_ranks = call_run_ranks,
    .isend = call_isend,
    .irecv = call_irecv,
    .irecv_matching = call_irecv_matching,
    .wait = call_wait,
    .test = call_test,
    .wait_any = call_wait_any,
    .probe = call_probe,
    .cancel = call_cancel,
    .collective = call_collective,
    .algorithm = call_algorithm,
    .count = call_count,
    .stage = call_stage,
    .now_ps = call_now_ps,
    .memory = call_memory,
    .publish = call_publish,
    .output = call_output,
    .error = call_error,
    .fail = call_fail,
};
