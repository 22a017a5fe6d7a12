/* test_matching_fuzz.c - Seeded programs with receives from any source against an account of their
 * messages in time, and against the same programs with the sources they found given. */
#include "timed_world.h"

#include <stdlib.h>
#include <string.h>

#include "base/random.h"

/* In every round each rank sends to a few others, and posts as many receives as it will get
 * messages: some from given senders, then others from anybody, between pieces of computing; and
 * waits for them in any order. */
enum { ROUNDS = 3, SENDS = 3, LARGEST = 400 };

struct message_note {
    int64_t arrival;   /* by the formula of the crossbar */
    int source, count; /* the sender's counter: order of equal arrivals */
    bool taken;
};

struct receive_note {
    int want, source; /* COMM_ANY_SOURCE, and what was found */
    int64_t posted;
};

struct rank_note {
    int n[ROUNDS];                        /* messages in each round */
    int *sender[ROUNDS];                  /* (n) who sends, in the order of ranks */
    struct receive_note *receive[ROUNDS]; /* (n) in the order of posting */
    struct message_note *message[ROUNDS]; /* (n) */
    int nmessage[ROUNDS];
    int64_t sum;
};

struct fuzz {
    uint64_t seed;
    int nrank;
    bool given;    /* the sources are those of the notes */
    bool by_tests; /* wait by testing */
    bool crowded;  /* messages pass each other */
    bool promised; /* that no send is synchronous: what is sent is known at once */
    struct rank_note *rank;
};

static int target(const struct fuzz *f, int rank, int round, int k)
{
    struct random r = random_make(f->seed, (uint64_t)rank, (uint64_t)(round * SENDS + k) + 1000);
    /* a third of the messages go to a few ranks, where they meet */
    int64_t crowd = f->nrank / 16 + 1;
    return (int)random_below(&r, random_below(&r, 3) ? f->nrank : crowd);
}

static void count_messages(struct fuzz *f)
{
    f->rank = calloc((size_t)f->nrank, sizeof *f->rank);
    for (int fill = 0; fill < 2; fill++)
        for (int round = 0; round < ROUNDS; round++) {
            for (int i = 0; i < f->nrank; i++) f->rank[i].n[round] = 0;
            for (int i = 0; i < f->nrank; i++)
                for (int k = 0; k < SENDS; k++) {
                    struct rank_note *to = &f->rank[target(f, i, round, k)];
                    if (fill) to->sender[round][to->n[round]] = i;
                    to->n[round]++;
                }
            for (int i = 0; i < f->nrank && !fill; i++) {
                struct rank_note *n = &f->rank[i];
                n->sender[round] = calloc((size_t)n->n[round] + 1, sizeof(int));
                n->receive[round] = calloc((size_t)n->n[round] + 1, sizeof(struct receive_note));
                n->message[round] = calloc((size_t)n->n[round] + 1, sizeof(struct message_note));
            }
        }
}

static void fuzz_done(struct fuzz *f)
{
    for (int i = 0; i < f->nrank; i++)
        for (int round = 0; round < ROUNDS; round++) {
            free(f->rank[i].sender[round]);
            free(f->rank[i].receive[round]);
            free(f->rank[i].message[round]);
        }
    free(f->rank);
}

static void think(struct comm *c, struct random *r)
{
    comm_elapse(c, (int64_t)random_below(r, 4000) * 1000);
}

/* 2 us + 1 ns/B, 400 ns on the way, 1 ns/B behind the first byte */
static int64_t arrival_of(int64_t begin, int64_t bytes)
{
    return begin + 2400000 + 1000 * bytes + 1000 * (bytes > 0 ? bytes - 1 : 0);
}

static void send_round(struct comm *c, struct fuzz *f, struct random *r, int round)
{
    char data[LARGEST] = {0};
    for (int k = 0; k < SENDS; k++) {
        int to = target(f, comm_rank(c), round, k);
        int64_t bytes = 8 + (int64_t)random_below(r, LARGEST - 8),
                value = comm_rank(c) * 100 + round * 10 + k;
        memcpy(data, &value, sizeof value);
        struct rank_note *n = &f->rank[to];
        n->message[round][n->nmessage[round]++] = (struct message_note){
            arrival_of(comm_now_ps(c), bytes), comm_rank(c), round * SENDS + k, false};
        think(c, r);
        n->message[round][n->nmessage[round] - 1].arrival = arrival_of(comm_now_ps(c), bytes);
        comm_send(c, to, 16 * round + k, data, bytes); /* the receives want the round alone */
    }
}

static void fuzz_rank(struct comm *c, void *context)
{
    struct fuzz *f = context;
    struct rank_note *own = &f->rank[comm_rank(c)];
    struct random r = random_make(f->seed, (uint64_t)comm_rank(c), 0);
    for (int round = 0; round < ROUNDS; round++) {
        int n = own->n[round], ngiven = n ? (int)random_below(&r, n / 2 + 1) : 0;
        char(*data)[LARGEST] = calloc((size_t)n + 1, LARGEST);
        struct comm_request *request = calloc((size_t)n + 1, sizeof *request);
        bool first = random_below(&r, 2);
        if (first) send_round(c, f, &r, round);
        for (int i = 0; i < n; i++) {
            struct receive_note *note = &own->receive[round][i];
            /* the first ones want the senders of the end of the list, several of the same perhaps
             */
            note->want = i < ngiven ? own->sender[round][n - 1 - i] : COMM_ANY_SOURCE;
            if (random_below(&r, 3) == 0) think(c, &r);
            note->posted = comm_now_ps(c);
            comm_irecv_matching(c, f->given ? note->source : note->want, 16 * round, ~INT64_C(15),
                                data[i], LARGEST, &request[i]);
        }
        if (!first) send_round(c, f, &r, round);
        think(c, &r);
        int from = n ? (int)random_below(&r, n) : 0;
        for (int k = 0; k < n; k++) {
            int i = (from + k) % n;
            if (f->by_tests)
                while (!comm_test(c, &request[i]))
                    ;
            else comm_wait(c, &request[i]);
            int64_t value;
            memcpy(&value, data[i], sizeof value);
            assert_int_equal(value / 100, request[i].peer);
            own->sum += value * (request[i].peer + 1);
            if (!f->given) own->receive[round][i].source = request[i].peer;
            else assert_int_equal(own->receive[round][i].source, request[i].peer);
        }
        free(data);
        free(request);
    }
}

static struct outcome go_fuzz(const struct machine_spec *m, struct fuzz *f, bool timed,
                              const int *order)
{
    struct world_load load = {.nrank = f->nrank,
                              .program = fuzz_rank,
                              .context = f,
                              .timed = timed,
                              .order = order,
                              .no_synchronous = f->promised};
    for (int i = 0; i < f->nrank; i++) {
        f->rank[i].sum = 0;
        memset(f->rank[i].nmessage, 0, sizeof f->rank[i].nmessage);
    }
    struct outcome o = run_load(m, load);
    if (o.r.status != RUN_OK) fail_msg("seed %d, %d ranks: %s", (int)f->seed, f->nrank, o.r.text);
    return o;
}

static int by_arrival(const void *a, const void *b)
{
    const struct message_note *x = a, *y = b;
    if (x->arrival != y->arrival) return x->arrival < y->arrival ? -1 : 1;
    if (x->source != y->source) return x->source < y->source ? -1 : 1;
    return x->count < y->count ? -1 : x->count > y->count;
}

/* What MPI says, step by step: messages come in the order of arrival, receives in that of posting;
 * whichever comes finds the first of the other kind that is there and fits. */
static void expect_order(struct fuzz *f, int rank, int round)
{
    struct rank_note *note = &f->rank[rank];
    const int n = note->n[round];
    struct receive_note *r = note->receive[round];
    struct message_note *m = note->message[round];
    int *found = calloc((size_t)n + 1, sizeof *found), posted = 0, come = 0;
    qsort(m, (size_t)n, sizeof *m, by_arrival);
    for (int i = 0; i < n; i++) found[i] = -1;
    while (posted < n || come < n) {
        if (come == n || (posted < n && r[posted].posted <= m[come].arrival)) {
            for (int k = 0; k < come && found[posted] < 0; k++)
                if (!m[k].taken && (r[posted].want < 0 || r[posted].want == m[k].source))
                    m[k].taken = true, found[posted] = m[k].source;
            posted++;
        } else {
            for (int i = 0; i < posted && !m[come].taken; i++)
                if (found[i] < 0 && (r[i].want < 0 || r[i].want == m[come].source))
                    m[come].taken = true, found[i] = m[come].source;
            come++;
        }
    }
    for (int i = 0; i < n; i++)
        if (found[i] != r[i].source)
            fail_msg("seed %d, %d ranks: rank %d, round %d: receive %d took the message of %d "
                     "instead of %d",
                     (int)f->seed, f->nrank, rank, round, i, r[i].source, found[i]);
    free(found);
}

/* Also where the time of each rank went: what a rank waits for without others in the way is known
 * in both. */
static void expect_equal(const struct fuzz *f, const char *what, const struct outcome *a,
                         const struct outcome *b, bool digests)
{
    for (int i = 0; i < a->r.nrank; i++) {
        const struct stage_time *x = &a->r.stage[i * a->r.nstage],
                                *y = &b->r.stage[i * a->r.nstage];
        /* what passed another message counts as held up by it, or not, as it was found: crowded
         * machines */
        const bool same = f->crowded
                              ? x->wait_ps + x->contention_ps == y->wait_ps + y->contention_ps
                              : x->wait_ps == y->wait_ps && x->contention_ps == y->contention_ps;
        if (a->r.finish_ps[i] != b->r.finish_ps[i] || x->recv_ps != y->recv_ps || !same)
            fail_msg("%s: seed %d, %d ranks: rank %d ends at %lld and %lld, waits %lld and %lld, "
                     "is held up %lld and %lld ps",
                     what, (int)f->seed, f->nrank, i, (long long)a->r.finish_ps[i],
                     (long long)b->r.finish_ps[i], (long long)x->wait_ps, (long long)y->wait_ps,
                     (long long)x->contention_ps, (long long)y->contention_ps);
    }
    /* over memory messages are known before their time: which events that saves is the host's
     * affair */
    if (digests && !f->crowded) assert_int_equal(a->r.digest, b->r.digest);
}

static int *shuffled(int n, uint64_t seed)
{
    int *order = calloc((size_t)n, sizeof *order);
    struct random r = random_make(seed, 77, 0);
    for (int i = 0; i < n; i++) {
        int k = (int)random_below(&r, i + 1);
        order[i] = order[k];
        order[k] = i;
    }
    return order;
}

/* One program at one level: as MPI says (`loggp`), the same again, the same whatever the order of
 * the ranks on the host, and with the sources given the same times, also where nothing may ask for
 * time. */
static void try_on(uint64_t seed, int nrank, const struct machine_spec *machine)
{
    struct fuzz f = {.seed = seed, .nrank = nrank, .crowded = machine->network.flit_bytes > 0};
    const struct machine_spec m = *machine;
    const int level = m.network.level;
    const int64_t eager = m.software.eager_bytes;
    count_messages(&f);
    int *order = shuffled(nrank, seed);
    struct outcome wild = go_fuzz(&m, &f, true, NULL);
    int64_t sum = 0;
    for (int i = 0; i < nrank; i++) {
        sum += f.rank[i].sum;
        for (int round = 0; round < ROUNDS && level == LEVEL_LOGGP && eager < 0 && !f.crowded;
             round++)
            expect_order(&f, i, round);
    }
    struct outcome other = go_fuzz(&m, &f, true, order);
    expect_equal(&f, "other order of ranks", &wild, &other, true);
    arena_destroy(other.arena);
    f.promised = true;
    other = go_fuzz(&m, &f, true, order);
    expect_equal(&f, "promised", &wild, &other, false);
    arena_destroy(other.arena);
    f.promised = seed % 2;
    f.given = true;
    other = go_fuzz(&m, &f, true, NULL);
    expect_equal(&f, "sources given", &wild, &other, false);
    arena_destroy(other.arena);
    /* without time, receives from one source do not wait for each other over memory, nor behind the
     * copies of an engine */
    if (m.software.shared_bandwidth == 0 && m.software.offload != OFFLOAD_COPIES) {
        other = go_fuzz(&m, &f, false, NULL);
        expect_equal(&f, "without time", &wild, &other, false);
        arena_destroy(other.arena);
    }
    f.given = false;
    f.by_tests = true;
    other = go_fuzz(&m, &f, true, NULL);
    int64_t tested = 0;
    for (int i = 0; i < nrank; i++) tested += f.rank[i].sum;
    assert_int_equal(tested, sum);
    arena_destroy(other.arena);
    arena_destroy(wild.arena);
    free(order);
    fuzz_done(&f);
}

static void try_program(uint64_t seed, int nrank, enum network_level level, int64_t eager)
{
    struct machine_spec m = crossbar(nrank);
    m.network.level = level;
    m.software.eager_bytes = eager;
    try_on(seed, nrank, &m);
}

/* Where messages are in each other's way in many ways: levels with packets and flits, processors
 * that share a port and a memory over which small messages pass large ones, one server for all
 * software. */
static void crowded_machines(void **state)
{
    (void)state;
    enum network_level level[] = {LEVEL_LOGGP, LEVEL_LINK, LEVEL_PACKET, LEVEL_FLIT, LEVEL_AUTO};
    for (uint64_t seed = 1; seed <= 120; seed++) {
        const int nrank = 4 + (int)(seed % 12);
        struct machine_spec m = crossbar(nrank);
        m.network.level = level[seed % 5];
        m.network.flit_bytes = 8;
        m.network.packet_bytes = 64;
        m.network.buffer_flits = 64;
        m.network.credit_latency = 20e-9;
        m.network.virtual_channels = 2;
        m.software.eager_bytes = seed % 3 ? -1 : 150;
        if (seed % 2) m.topology.family = TOPOLOGY_MESH;
        if (seed % 4 > 1) {
            m.topology.processors_per_node = 2;
            m.software.shared_latency = 1e-6;
            m.software.shared_bandwidth = seed % 8 > 3 ? 2e7 : 0;
        }
        if (seed % 7 == 0) m.software.kernel_server = true, m.software.kernel_time = 1e-6;
        try_on(seed, nrank, &m);
    }
}

/* Hand-shakes that wait for computing, and copies that are made beside it: what a rank does on the
 * host before an event must not decide on what the event finds. */
static void programs_with_engines_and_without(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 100; seed++) {
        const int nrank = 2 + (int)(seed % 8);
        struct machine_spec m = crossbar(nrank);
        m.network.level = seed % 3 ? LEVEL_LOGGP : LEVEL_LINK;
        m.software.offload = seed % 2 ? OFFLOAD_NONE : OFFLOAD_COPIES;
        m.software.eager_bytes = seed % 5 ? 100 : 0;
        try_on(seed, nrank, &m);
    }
}

static void small_programs(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 150; seed++) {
        try_program(seed, 2 + (int)(seed % 9), LEVEL_LOGGP, -1);
        try_program(seed, 2 + (int)(seed % 7), LEVEL_LOGGP, 100);
        try_program(seed, 2 + (int)(seed % 8), LEVEL_LINK, seed % 2 ? -1 : 200);
    }
}

static void programs_of_many_ranks(void **state)
{
    (void)state;
    int nrank[] = {64, 512, 4096};
    for (int k = 0; k < 3; k++) {
        try_program(1000 + (uint64_t)k, nrank[k], LEVEL_LOGGP, -1);
        try_program(1010 + (uint64_t)k, nrank[k], LEVEL_LOGGP, 200);
        try_program(1020 + (uint64_t)k, nrank[k], LEVEL_LINK, -1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(programs_with_engines_and_without),
        cmocka_unit_test(small_programs),
        cmocka_unit_test(crowded_machines),
        cmocka_unit_test(programs_of_many_ranks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
