/* test_shared.c - one run shared by the processes of a job: whatever their number, process 0 has
 * every number and every word of a run on one. The processes are threads here, and their messages
 * queues in memory (a table of hosts.h). */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <pthread.h>

#include "base/random.h"
#include "measure/rank_sums.h"
#include "vp/world.h"

#include "../support/thread_hosts.h"
#include "crossbar.h"

enum { RANKS = 97, MOST = THREAD_HOSTS };

/* --- runs --- */

static const char *const stage_name[] = {"first", "second"};

static struct machine_spec barrier_crossbar(int nodes)
{
    struct machine_spec m = crossbar(nodes);
    m.software.barrier = BARRIER_HARDWARE;
    m.software.barrier_time = 1e-6;
    return m;
}

struct outcome {
    struct arena *arena;
    struct run_result r;
    double output[RANKS * 3];
};

struct process {
    pthread_t thread;
    struct hosts hosts;
    world_program *program;
    int nrank, threads, number;
    bool alone, sums;
    struct outcome out;
};

static void *execute(void *argument)
{
    struct process *p = argument;
    const struct machine_spec m = barrier_crossbar(p->nrank);
    const struct record_spec record = {.links = true};
    const struct comm_output output = {p->out.output, RANKS * 3};
    struct err e;
    err_clear(&e);
    thread_hosts_join(p->hosts.rank);
    p->out.arena = arena_create();
    const struct world_load load = {.nrank = p->nrank,
                                    .program = p->program,
                                    .nstage = 2,
                                    .stage_name = stage_name,
                                    .largest_message = -1,
                                    .threads = p->threads,
                                    .output = &output,
                                    .noutput = 1,
                                    .hosts = p->alone ? NULL : &p->hosts,
                                    .job_run = p->number,
                                    .sums = p->sums,
                                    .keeps_outputs = p->sums};
    if (!world_run(&m, &load, &record, 7, p->out.arena, &p->out.r, &e)) fail_msg("%s", e.text);
    return NULL;
}

static void job(struct process *p, int size, world_program *program, int nrank, int threads,
                bool sums)
{
    static int number;
    number++;
    thread_hosts_begin();
    for (int i = 0; i < size; i++) {
        p[i] = (struct process){.hosts = {i, size, &thread_hosts},
                                .program = program,
                                .nrank = nrank,
                                .threads = threads,
                                .number = number,
                                .sums = sums};
        assert_int_equal(pthread_create(&p[i].thread, NULL, execute, &p[i]), 0);
    }
    for (int i = 0; i < size; i++) pthread_join(p[i].thread, NULL);
    assert_int_equal(thread_hosts_end(), 0); /* nothing is left over */
}

static void every_number_of_processes(world_program *program, int nrank, enum run_status status)
{
    static struct process one, many[MOST];
    one = (struct process){.program = program, .nrank = nrank, .alone = true};
    execute(&one);
    assert_int_equal(one.out.r.status, status);
    for (int size = 1; size <= MOST; size += size < 4 ? 1 : 4)
        for (int threads = 1; threads <= 3; threads += 2) {
            job(many, size, program, nrank, threads, false);
            const struct run_result *a = &one.out.r, *b = &many[0].out.r;
            assert_int_equal(a->status, b->status);
            assert_string_equal(a->text, b->text);
            for (int i = 1; i < size; i++) assert_int_equal(many[i].out.r.status, status);
            if (status == RUN_OK) {
                assert_int_equal(a->digest, b->digest);
                assert_int_equal(a->makespan_ps, b->makespan_ps);
                assert_int_equal(a->messages, b->messages);
                assert_int_equal(a->bytes, b->bytes);
                assert_memory_equal(a->stage, b->stage,
                                    (size_t)a->nrank * (size_t)a->nstage * sizeof *a->stage);
                assert_memory_equal(a->finish_ps, b->finish_ps,
                                    (size_t)a->nrank * sizeof *a->finish_ps);
                assert_int_equal(a->nlink, b->nlink);
                assert_memory_equal(a->link, b->link, (size_t)a->nlink * sizeof *a->link);
                assert_memory_equal(one.out.output, many[0].out.output, sizeof one.out.output);
            }
            for (int i = 0; i < size; i++) arena_destroy(many[i].out.arena);
        }
    arena_destroy(one.out.arena);
}

/* Exchanges at all distances, barriers in between, and an output. */
static void exchanges(struct comm *c, void *context)
{
    (void)context;
    const int rank = comm_rank(c), size = comm_size(c);
    struct random r = random_make(3, (uint64_t)rank, 0);
    double out[40], in[40];
    for (int step = 0; step < 12; step++) {
        const int d = 1 + (step * step * 7 + step) % (size - 1), n = 1 + step * 3;
        const int to = (rank + d) % size, from = (rank - d + size) % size;
        const struct work w = {.flop = (int64_t)random_below(&r, 4000), .div = 3};
        comm_stage(c, step > 5);
        comm_work(c, &w);
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < n; i++) out[i] = rank * 1000.0 + step * 10 + k;
            comm_send(c, to, step, out, n * (int64_t)sizeof *out);
        }
        if (step == 4) comm_send(c, to, 77, NULL, 1 << 20); /* a size without content */
        if (step % 4 == 0) comm_barrier(c);
        for (int k = 0; k < 3; k++) {
            comm_recv(c, from, step, in, n * (int64_t)sizeof *in);
            assert_true(in[0] == from * 1000.0 + step * 10 + k && in[n - 1] == in[0]);
        }
        if (step == 4) comm_recv(c, from, 77, NULL, 1 << 20);
    }
    comm_publish(c, 0, rank, 1, in);
    comm_publish(c, 0, RANKS + 2 * rank, 2, in + 1);
}

static void exchanges_are_the_same(void **state)
{
    (void)state;
    every_number_of_processes(exchanges, RANKS, RUN_OK);
    every_number_of_processes(exchanges, 3, RUN_OK); /* some processes have no rank */
}

static void stuck_ring(struct comm *c, void *context)
{
    char data[16];
    exchanges(c, context);
    const int rank = comm_rank(c), size = comm_size(c);
    if (rank % 3 == 0) comm_recv(c, (rank + 3) % size / 3 * 3, 42, data, sizeof data);
}

static void stuck_at_a_barrier(struct comm *c, void *context)
{
    char data[16];
    exchanges(c, context);
    if (comm_rank(c) == 50) comm_recv(c, 51, 9, data, sizeof data);
    comm_barrier(c);
}

static void a_deadlock_is_explained_in_the_same_words(void **state)
{
    (void)state;
    every_number_of_processes(stuck_ring, RANKS, RUN_DEADLOCK);
    every_number_of_processes(stuck_at_a_barrier, RANKS, RUN_DEADLOCK);
}

static void same_spread(const struct spread *a, const struct spread *b)
{
    assert_int_equal(a->sum, b->sum);
    assert_int_equal(a->min, b->min);
    assert_int_equal(a->max, b->max);
    assert_int_equal(a->fits, b->fits);
}

/* What is known of all ranks, from their own times or as it was added up. */
static void same_sums(const struct run_result *a, const struct run_result *b)
{
    const struct rank_summary x = rank_summary_make(a), y = rank_summary_make(b);
    for (int i = 0; i < a->nstage; i++) {
        const struct stage_row p = stage_row_make(a, i), q = stage_row_make(b, i);
        assert_string_equal(p.name, q.name);
        same_spread(&p.compute, &q.compute);
        same_spread(&p.send, &q.send);
        same_spread(&p.recv, &q.recv);
        same_spread(&p.wait, &q.wait);
        same_spread(&p.contention, &q.contention);
        same_spread(&p.total, &q.total);
        assert_memory_equal(&p.all, &q.all, sizeof p.all);
    }
    assert_true(y.has_stages && y.has_finish);
    assert_int_equal(x.accounting_error, y.accounting_error);
    assert_int_equal(x.compute_min, y.compute_min);
    assert_int_equal(x.compute_max, y.compute_max);
    assert_int_equal(x.finish_min, y.finish_min);
    assert_int_equal(x.finish_max, y.finish_max);
}

/* Single ranks' times and outputs stay where they are; what all come to is the same. */
static void sums_are_those_of_one_process(void **state)
{
    (void)state;
    static struct process one, many[MOST];
    one = (struct process){.program = exchanges, .nrank = RANKS, .alone = true};
    execute(&one);
    for (int size = 1; size <= MOST; size++) {
        job(many, size, exchanges, RANKS, 1, true);
        const struct run_result *a = &one.out.r, *b = &many[0].out.r;
        assert_int_equal(b->status, RUN_OK);
        assert_int_equal(a->digest, b->digest);
        assert_int_equal(a->makespan_ps, b->makespan_ps);
        assert_int_equal(a->messages, b->messages);
        assert_int_equal(a->bytes, b->bytes);
        assert_null(b->stage);
        assert_null(b->finish_ps);
        same_sums(a, b);
        /* Each process has what its own ranks published, and nothing else. */
        for (int i = 0; i < RANKS; i++) {
            int holders = 0;
            for (int k = 0; k < size; k++) {
                const double *x = many[k].out.output;
                holders += x[i] != 0;
                assert_true(x[i] == 0 || x[i] == one.out.output[i]);
            }
            assert_int_equal(holders, one.out.output[i] != 0);
        }
        for (int i = 0; i < size; i++) arena_destroy(many[i].out.arena);
    }
    arena_destroy(one.out.arena);
}

/* Simulated time ends at one rank: the run has failed on every process. */
static void too_long(struct comm *c, void *context)
{
    exchanges(c, context);
    if (comm_rank(c) == 60)
        for (int i = 0; i < 100; i++) comm_elapse(c, INT64_MAX);
    exchanges(c, context);
}

static void a_failure_ends_all_processes(void **state)
{
    (void)state;
    static struct process p[MOST];
    for (int size = 2; size <= 4; size++) {
        static int number = 5000;
        thread_hosts_begin();
        for (int i = 0; i < size; i++) {
            p[i] = (struct process){.hosts = {i, size, &thread_hosts},
                                    .program = too_long,
                                    .nrank = RANKS,
                                    .threads = 1,
                                    .number = number + size};
            assert_int_equal(pthread_create(&p[i].thread, NULL, execute, &p[i]), 0);
        }
        for (int i = 0; i < size; i++) {
            pthread_join(p[i].thread, NULL);
            assert_int_equal(p[i].out.r.status, RUN_FAILED);
            assert_false(p[i].out.r.job_broken);
            arena_destroy(p[i].out.arena);
        }
        thread_hosts_end(); /* letters of a run that failed are nobody's */
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exchanges_are_the_same),
        cmocka_unit_test(sums_are_those_of_one_process),
        cmocka_unit_test(a_deadlock_is_explained_in_the_same_words),
        cmocka_unit_test(a_failure_ends_all_processes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
