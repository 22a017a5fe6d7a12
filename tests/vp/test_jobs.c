/* test_jobs.c - Several jobs on one machine: what they do to each other, and what they do not. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <string.h>

#include "base/picoseconds.h"
#include "base/random.h"
#include "comm/collectives.h"
#include "vp/jobs.h"

static const char *const stage_name[] = {"first", "second"};

enum { NS = 1000, MOST = 4 };

/* A line of routers with `bristle` nodes each: 100 ns a hop, 1 B/ns, software takes no time. */
static struct machine_spec line(int routers, int bristle, enum network_level level)
{
    struct machine_spec m = {.name = "test"};
    m.topology = (struct topology_spec){.family = TOPOLOGY_MESH, .ndim = 1, .dims = {routers},
                                        .nodes_per_router = bristle, .processors_per_node = 1};
    m.node = (struct node_spec){.flop_rate = 1e9, .clock = 1e9, .copy_bandwidth = 1e9};
    m.network = (struct network_spec){.level = level,
                                      .link_bandwidth = 1e9,
                                      .hop_latency = 100e-9,
                                      .flit_bytes = 16,
                                      .packet_bytes = 256,
                                      .virtual_channels = 1,
                                      .buffer_flits = 64};
    m.software = (struct software_spec){.eager_bytes = -1};
    return m;
}

/* What the jobs of a test are, and what became of them. */
struct set {
    int n;
    struct world_load load[MOST];
    struct placement_spec place[MOST];
    struct world_job job[MOST];
    struct run_result out[MOST];
    struct record_spec record;
    struct arena *arena;
};

static void add(struct set *s, int nrank, world_program *program, int *list)
{
    const int i = s->n++;
    static const char *const names[] = {"a", "b", "c", "d"};
    s->load[i] = (struct world_load){.nrank = nrank, .program = program, .nstage = 2,
                                     .stage_name = stage_name, .largest_message = -1};
    s->place[i] = (struct placement_spec){.kind = list ? PLACEMENT_LIST : PLACEMENT_LINEAR,
                                          .nlist = list ? nrank : 0, .list = list};
    s->job[i] = (struct world_job){.name = names[i], .load = &s->load[i], .nrank = nrank,
                                   .placement = &s->place[i], .seed = 5, .record = &s->record,
                                   .out = &s->out[i]};
}

static void go(struct set *s, const struct machine_spec *m)
{
    struct err e;
    err_clear(&e);
    s->arena = arena_create();
    for (int i = 0; i < s->n; i++) s->job[i].arena = s->arena;
    memset(s->out, 0, sizeof s->out);
    if (!world_run_jobs(m, s->job, s->n, 1, NULL, NULL, &e)) fail_msg("%s", e.text);
}

/* The job alone, by the way of programs that have the machine for themselves. */
static void alone(struct set *s, int i, const struct machine_spec *m, struct run_result *out)
{
    struct err e;
    struct machine_spec own = *m;
    err_clear(&e);
    own.placement = s->place[i];
    memset(out, 0, sizeof *out);
    if (!world_run(&own, &s->load[i], &s->record, s->job[i].seed, s->arena, out, &e))
        fail_msg("%s", e.text);
}

static void send_once(struct comm *c, void *context)
{
    char data[1000] = {0};
    (void)context;
    if (comm_rank(c) == 0) comm_send(c, 1, 7, data, 1000);
    else comm_recv(c, 0, 7, data, 1000);
}

/* Two routers, one link between them. A message of 1000 B takes 2 x 100 ns and 999 ns behind its
 * head: 1199 ns. Both heads are at the link after 100 ns; it carries the first one's 1000 B until
 * 1100 ns, so the second one is 1000 ns late. */
static void jobs_that_meet_on_one_link_wait_as_long_as_it_is_taken(void **state)
{
    (void)state;
    struct machine_spec m = line(2, 2, LEVEL_LINK);
    m.network.flit_bytes = 0;
    m.network.packet_bytes = 0;
    int first[] = {0, 2}, second[] = {1, 3};
    for (int late = 0; late <= 1500; late += 500) {
        struct set s = {0};
        add(&s, 2, send_once, first);
        add(&s, 2, send_once, second);
        s.job[1].start_ps = late * NS;
        go(&s, &m);
        const int wait = late < 1000 ? 1000 - late : 0;
        assert_int_equal(s.out[0].makespan_ps, 1199 * NS);
        assert_int_equal(s.out[1].makespan_ps, (1199 + wait) * NS);
        assert_int_equal(s.out[0].stage[s.out[0].nstage].contention_ps, 0);
        assert_int_equal(s.out[1].stage[s.out[1].nstage].contention_ps, wait * NS);
        assert_int_equal(s.out[1].stage[s.out[1].nstage].wait_ps, 1199 * NS);
        arena_destroy(s.arena);
    }
}

/* Random but matching messages, a barrier, and a look at the clock. */
static void traffic(struct comm *c, void *context)
{
    const int rank = comm_rank(c), size = comm_size(c);
    struct random r = random_make(3, (uint64_t)rank, 0);
    (void)context;
    assert_int_equal(comm_now_ps(c), 0);
    for (int d = 1; d < size; d++) {
        char data[3000] = {0};
        struct work w = {.flop = random_below(&r, 2000)};
        const int64_t bytes = 40 + (rank * 977 + d * 331) % 2000,
                      other = 40 + ((rank - d + size) % size * 977 + d * 331) % 2000;
        comm_work(c, &w);
        comm_stage(c, d % 2);
        comm_send(c, (rank + d) % size, d, data, bytes);
        comm_recv(c, (rank - d + size) % size, d, data, other);
        if (d == 2) comm_barrier(c);
    }
}

static const enum network_level levels[] = {LEVEL_LOGGP, LEVEL_LINK, LEVEL_PACKET, LEVEL_FLIT,
                                            LEVEL_AUTO};
enum { LEVELS_TRIED = sizeof levels / sizeof *levels };

static void same_times(const struct run_result *a, const struct run_result *b)
{
    assert_int_equal(a->status, RUN_OK);
    assert_int_equal(a->makespan_ps, b->makespan_ps);
    assert_int_equal(a->messages, b->messages);
    assert_memory_equal(a->finish_ps, b->finish_ps, (size_t)a->nrank * sizeof *a->finish_ps);
    assert_memory_equal(a->stage, b->stage,
                        (size_t)(a->nrank * a->nstage) * sizeof *a->stage);
}

static void one_job_is_what_a_program_alone_is_with_its_digest(void **state)
{
    (void)state;
    for (int k = 0; k < LEVELS_TRIED; k++)
        for (int hardware = 0; hardware < 2; hardware++) {
            struct machine_spec m = line(5, 2, levels[k]);
            struct run_result r;
            struct set s = {.record = {.spans = true, .links = true}};
            m.software.barrier = hardware ? BARRIER_HARDWARE : BARRIER_SOFTWARE;
            m.noise.compute_cv = 0.1;
            add(&s, 9, traffic, NULL);
            go(&s, &m);
            alone(&s, 0, &m, &r);
            same_times(&s.out[0], &r);
            assert_true(s.out[0].digest == r.digest);
            assert_int_equal(s.out[0].events, r.events);
            assert_int_equal(s.out[0].nspan, r.nspan);
            assert_int_equal(s.out[0].nlink, r.nlink);
            assert_memory_equal(s.out[0].link, r.link, (size_t)r.nlink * sizeof *r.link);
            arena_destroy(s.arena);
        }
}

/* The halves of a line: no route of one comes into the other. Later starts change nothing. */
static void jobs_on_disjoint_parts_do_not_disturb_each_other(void **state)
{
    (void)state;
    for (int k = 0; k < LEVELS_TRIED; k++) {
        struct machine_spec m = line(8, 1, levels[k]);
        int low[] = {3, 0, 2, 1}, high[] = {4, 5, 7, 6};
        struct set s = {0};
        m.software.barrier = BARRIER_HARDWARE;
        m.noise.compute_cv = 0.1;
        add(&s, 4, traffic, low);
        add(&s, 4, traffic, high);
        s.job[1].start_ps = 700 * NS;
        s.job[1].seed = 9;
        go(&s, &m);
        for (int i = 0; i < 2; i++) {
            struct run_result r;
            alone(&s, i, &m, &r);
            same_times(&s.out[i], &r);
        }
        arena_destroy(s.arena);
    }
}

/* Interleaved places: they meet at every level that knows links, and nothing else differs. */
static void jobs_on_common_links_disturb_each_other_and_their_shares_add_up(void **state)
{
    (void)state;
    for (int k = 0; k < LEVELS_TRIED; k++) {
        struct machine_spec m = line(8, 1, levels[k]);
        int even[] = {0, 2, 4, 6}, odd[] = {1, 3, 5, 7};
        struct set s = {.record = {.links = true}};
        struct run_result r[2];
        add(&s, 4, traffic, even);
        add(&s, 4, traffic, odd);
        go(&s, &m);
        bool slower = false;
        for (int i = 0; i < 2; i++) {
            alone(&s, i, &m, &r[i]);
            assert_true(s.out[i].makespan_ps >= r[i].makespan_ps);
            slower = slower || s.out[i].makespan_ps > r[i].makespan_ps;
            /* Each job's share of a link is what it sends over it alone: routes do not change. */
            assert_int_equal(s.out[i].nlink, r[i].nlink);
            for (int l = 0; l < r[i].nlink; l++) {
                assert_int_equal(s.out[i].link[l].messages, r[i].link[l].messages);
                assert_int_equal(s.out[i].link[l].bytes, r[i].link[l].bytes);
            }
        }
        assert_int_equal(slower, levels[k] != LEVEL_LOGGP);
        arena_destroy(s.arena);
    }
}

/* Level auto has the answers of packet for several jobs, too. */
static void auto_is_packet_for_several_jobs(void **state)
{
    (void)state;
    struct run_result kept[2];
    struct set s[2] = {{0}, {0}};
    int even[] = {0, 2, 4, 6}, odd[] = {1, 3, 5, 7};
    for (int k = 0; k < 2; k++) {
        struct machine_spec m = line(8, 1, k == 0 ? LEVEL_PACKET : LEVEL_AUTO);
        add(&s[k], 4, traffic, even);
        add(&s[k], 4, traffic, odd);
        s[k].job[0].start_ps = 300 * NS;
        go(&s[k], &m);
        for (int i = 0; i < 2; i++) {
            if (k == 0) kept[i] = s[k].out[i];
            else same_times(&s[k].out[i], &kept[i]);
        }
    }
    arena_destroy(s[0].arena);
    arena_destroy(s[1].arena);
}

/* The place of a job that does not run stays free: the others lie where they lie beside it. */
static void a_job_that_is_idle_keeps_its_processors(void **state)
{
    (void)state;
    struct machine_spec m = line(8, 1, LEVEL_LINK);
    int low[] = {0, 1, 2, 3}, high[] = {4, 5, 6, 7};
    struct set s = {0};
    struct run_result r;
    add(&s, 4, traffic, NULL);
    add(&s, 4, traffic, NULL);
    s.job[0].load = NULL;
    s.record.links = true;
    go(&s, &m);
    s.place[1] = (struct placement_spec){.kind = PLACEMENT_LIST, .nlist = 4, .list = high};
    alone(&s, 1, &m, &r);
    same_times(&s.out[1], &r);
    assert_memory_equal(s.out[1].link, r.link, (size_t)r.nlink * sizeof *r.link);
    s.place[1].list = low;
    alone(&s, 1, &m, &r);
    assert_memory_not_equal(s.out[1].link, r.link, (size_t)r.nlink * sizeof *r.link);
    arena_destroy(s.arena);
}

/* ---- what goes wrong */

static void wait_for_ever(struct comm *c, void *context)
{
    char data[8];
    (void)context;
    comm_recv(c, 1 - comm_rank(c), 3, data, 8);
}

static void fails(struct comm *c, void *context)
{
    (void)context;
    if (comm_rank(c) == 1) comm_fail(c, "lost its way");
}

static void a_job_that_fails_spoils_the_others_and_is_named(void **state)
{
    (void)state;
    struct machine_spec m = line(8, 1, LEVEL_LINK);
    for (int how = 0; how < 2; how++) {
        struct set s = {0};
        add(&s, 4, traffic, NULL);
        add(&s, 2, how == 0 ? wait_for_ever : fails, NULL);
        s.load[1].foreign = true;
        go(&s, &m);
        assert_int_equal(s.out[1].status, how == 0 ? RUN_DEADLOCK : RUN_FAILED);
        assert_int_equal(s.out[0].status, RUN_FAILED);
        assert_null(s.out[0].stage);
        assert_non_null(strstr(s.out[0].text, "job 'b' beside it: "));
        assert_non_null(strstr(s.out[0].text, how == 0 ? "a cycle of 2" : "lost its way"));
        /* Ranks are those of the job. */
        assert_non_null(strstr(s.out[1].text, how == 0 ? "rank 0 in first waits" : "rank 1 in"));
        arena_destroy(s.arena);
    }
}

static void a_job_that_passes_the_end_of_time_is_named(void **state)
{
    (void)state;
    struct machine_spec m = line(8, 1, LEVEL_LINK);
    struct set s = {0};
    add(&s, 4, traffic, NULL);
    add(&s, 2, send_once, NULL);
    s.job[1].start_ps = PS_LAST - 5;
    go(&s, &m);
    assert_int_equal(s.out[1].status, RUN_FAILED);
    assert_non_null(strstr(s.out[1].text, "simulated time ends"));
    assert_non_null(strstr(s.out[0].text, "job 'b' beside it: simulated time ends"));
    arena_destroy(s.arena);
}

static void leaves_a_message(struct comm *c, void *context)
{
    (void)context;
    if (comm_rank(c) == 0) comm_send(c, 1, 7, NULL, 100);
}

static void a_message_left_behind_fails_its_job(void **state)
{
    (void)state;
    struct machine_spec m = line(8, 1, LEVEL_LINK);
    struct set s = {0};
    add(&s, 2, send_once, NULL);
    add(&s, 2, leaves_a_message, NULL);
    s.load[1].foreign = true;
    go(&s, &m);
    assert_int_equal(s.out[1].status, RUN_FAILED);
    assert_non_null(strstr(s.out[1].text, "without receiving the message of 100 bytes"));
    assert_non_null(strstr(s.out[0].text, "job 'b' beside it: rank 1"));
    arena_destroy(s.arena);
}

/* One kernel server for the whole machine serves all jobs: a message end takes 10 us of it. */
static void the_kernel_server_is_one_for_all_jobs(void **state)
{
    (void)state;
    struct machine_spec m = line(8, 1, LEVEL_LOGGP);
    int low[] = {0, 1}, high[] = {6, 7};
    struct set s = {0};
    struct run_result r;
    m.network.flit_bytes = 0;
    m.network.packet_bytes = 0;
    m.software.kernel_server = true;
    m.software.kernel_time = 10e-6;
    add(&s, 2, send_once, low);
    add(&s, 2, send_once, high);
    go(&s, &m);
    alone(&s, 1, &m, &r);
    /* Alone: sent until 10 us, there after 1199 ns, received 10 us later. Beside the other: sends
     * until 10 and 20 us, receives until 30 and 40 us, all one behind the other. */
    assert_int_equal(r.makespan_ps, 21199 * NS);
    assert_int_equal(s.out[0].makespan_ps, 30000 * NS);
    assert_int_equal(s.out[1].makespan_ps, 40000 * NS);
    assert_int_equal(s.out[1].stage[0].contention_ps, 10000 * NS);
    arena_destroy(s.arena);
}

static void repeated_runs_are_the_same_bits(void **state)
{
    (void)state;
    struct machine_spec m = line(8, 2, LEVEL_FLIT);
    uint64_t digest[2][2];
    m.noise.compute_cv = 0.2;
    for (int k = 0; k < 2; k++) {
        struct set s = {0};
        add(&s, 7, traffic, NULL);
        add(&s, 9, traffic, NULL);
        s.place[1] = (struct placement_spec){.kind = PLACEMENT_RANDOM, .seed = 4};
        go(&s, &m);
        for (int i = 0; i < 2; i++) digest[k][i] = s.out[i].digest;
        arena_destroy(s.arena);
    }
    assert_memory_equal(digest[0], digest[1], sizeof digest[0]);
    assert_true(digest[0][0] != digest[0][1]);
}

/* What a job does with collectives of the network: each rank comes when it says, and leaves. */
struct adding {
    int nrank, rounds;
    int64_t delay_ps[5], left_ps[5][3];
    double sum[5][3][10];
};

static void add_up(void *into, const void *with, bool before, int64_t n, void *context,
                   struct work *w)
{
    (void)before, (void)context, (void)w;
    for (int64_t i = 0; i < n; i++) ((double *)into)[i] += ((const double *)with)[i];
}

static void add_by_network(struct comm *c, void *context)
{
    struct adding *x = context;
    const int rank = comm_rank(c);
    const struct collective_op op = {.combine = add_up, .operation = COMM_REAL,
                                     .commutative = true};
    for (int round = 0; round < x->rounds; round++) {
        double send[10], recv[10], scratch[20];
        for (int i = 0; i < 10; i++) send[i] = 100 * x->nrank + 10 * rank + i + round;
        const struct collective_call k = {.kind = COLLECTIVE_ALLREDUCE, .comm = c, .tag = round,
                                          .count = 10, .element = 8, .send = send, .recv = recv,
                                          .op = &op, .scratch = scratch};
        comm_elapse(c, x->delay_ps[rank]);
        collective_run(collective_algorithm_find(COLLECTIVE_ALLREDUCE, "hardware"), &k);
        x->left_ps[rank][round] = comm_now_ps(c);
        memcpy(x->sum[rank][round], recv, sizeof recv);
    }
}

/* Each job's collectives are its own, whoever else is in one at the same time: they wait for its
 * ranks alone, take the way of its own places, and have its own sums. On a line of twelve routers:
 * 1 us + up and down from the first rank to the farthest, 50 ns a link, + 80 B at 1 B/ns. */
static void each_job_has_its_own_collectives_of_the_network(void **state)
{
    (void)state;
    int place[3][5] = {{0, 3, 6, 9}, {2, 1}, {11, 4, 5, 7, 10}};
    static const int nrank[3] = {4, 2, 5}, farthest[3] = {9, 1, 7}, rounds[3] = {3, 2, 3};
    for (int k = 0; k < LEVELS_TRIED; k++) {
        struct machine_spec m = line(12, 1, levels[k]);
        static struct adding x[3];
        struct set s = {0};
        strcpy(m.network.collective.kinds, "allreduce");
        m.network.collective.operations = OPERATIONS_REAL;
        m.network.collective.latency = 1e-6;
        m.network.collective.hop_latency = 50e-9;
        m.network.collective.bandwidth = 1e9;
        memset(x, 0, sizeof x);
        for (int i = 0; i < 3; i++) {
            add(&s, nrank[i], add_by_network, place[i]);
            x[i].nrank = nrank[i], x[i].rounds = rounds[i];
            for (int r = 0; r < nrank[i]; r++) x[i].delay_ps[r] = 1000 * NS * ((r + i) % 3);
            s.load[i].context = &x[i];
            s.load[i].meets = true;
            s.job[i].start_ps = 300 * NS * i;
        }
        go(&s, &m);
        for (int i = 0; i < 3; i++) {
            int64_t latest = 0;
            for (int r = 0; r < nrank[i]; r++)
                if (x[i].delay_ps[r] > latest) latest = x[i].delay_ps[r];
            const int64_t each = latest + (1000 + 2 * 50 * farthest[i] + 80) * NS;
            for (int r = 0; r < nrank[i]; r++)
                for (int round = 0; round < rounds[i]; round++) {
                    assert_int_equal(x[i].left_ps[r][round], (round + 1) * each);
                    for (int j = 0; j < 10; j++)
                        assert_true(x[i].sum[r][round][j] ==
                                    nrank[i] * (100 * nrank[i] + j + round) +
                                        5 * nrank[i] * (nrank[i] - 1));
                }
            assert_int_equal(s.out[i].status, RUN_OK);
            assert_int_equal(s.out[i].makespan_ps, rounds[i] * each);
            assert_int_equal(s.out[i].messages, 0);
        }
        arena_destroy(s.arena);
    }
}

/* A job whose ranks do not all come waits for ever, and is named; the ranks of others are not
 * counted in. */
static void leave_one_out(struct comm *c, void *context)
{
    struct adding *x = context;
    if (comm_rank(c) != 1) add_by_network(c, x);
}

static void ranks_of_other_jobs_do_not_count(void **state)
{
    (void)state;
    struct machine_spec m = line(8, 1, LEVEL_LINK);
    static struct adding x[2];
    struct set s = {0};
    strcpy(m.network.collective.kinds, "allreduce");
    m.network.collective.operations = OPERATIONS_REAL;
    memset(x, 0, sizeof x);
    for (int i = 0; i < 2; i++) {
        add(&s, 4, i == 0 ? leave_one_out : add_by_network, NULL);
        x[i].nrank = 4, x[i].rounds = 1;
        s.load[i].context = &x[i];
        s.load[i].meets = true;
    }
    go(&s, &m);
    assert_int_equal(s.out[0].status, RUN_DEADLOCK);
    assert_non_null(strstr(s.out[0].text, "3 of 4 ranks"));
    assert_int_equal(s.out[1].status, RUN_FAILED);
    assert_non_null(strstr(s.out[1].text, "a"));
    arena_destroy(s.arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jobs_that_meet_on_one_link_wait_as_long_as_it_is_taken),
        cmocka_unit_test(one_job_is_what_a_program_alone_is_with_its_digest),
        cmocka_unit_test(jobs_on_disjoint_parts_do_not_disturb_each_other),
        cmocka_unit_test(jobs_on_common_links_disturb_each_other_and_their_shares_add_up),
        cmocka_unit_test(auto_is_packet_for_several_jobs),
        cmocka_unit_test(a_job_that_is_idle_keeps_its_processors),
        cmocka_unit_test(a_job_that_fails_spoils_the_others_and_is_named),
        cmocka_unit_test(a_job_that_passes_the_end_of_time_is_named),
        cmocka_unit_test(a_message_left_behind_fails_its_job),
        cmocka_unit_test(the_kernel_server_is_one_for_all_jobs),
        cmocka_unit_test(repeated_runs_are_the_same_bits),
        cmocka_unit_test(each_job_has_its_own_collectives_of_the_network),
        cmocka_unit_test(ranks_of_other_jobs_do_not_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
