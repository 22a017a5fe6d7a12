/* test_mpi_messages.c - sending and receiving in all modes, requests, probes, wildcards. */
#include "mpi_world.h"

/* --- one message in every mode --- */

static void modes(void *context)
{
    int n = all_ranks(), rank = own_rank(), right = (rank + 1) % n, left = (rank + n - 1) % n;
    char room[4000];
    (void)context;
    MPI_Buffer_attach(room, sizeof room);
    for (int mode = 0; mode < 4; mode++) {
        double out[3] = {rank, mode, 7}, in[3] = {-1, -1, -1};
        MPI_Status s;
        MPI_Request q;
        MPI_Irecv(in, 3, MPI_DOUBLE, left, mode, MPI_COMM_WORLD, &q);
        if (mode == 0) MPI_Send(out, 3, MPI_DOUBLE, right, mode, MPI_COMM_WORLD);
        if (mode == 1) MPI_Bsend(out, 3, MPI_DOUBLE, right, mode, MPI_COMM_WORLD);
        if (mode == 2) MPI_Ssend(out, 3, MPI_DOUBLE, right, mode, MPI_COMM_WORLD);
        if (mode == 3) MPI_Rsend(out, 3, MPI_DOUBLE, right, mode, MPI_COMM_WORLD);
        MPI_Wait(&q, &s);
        int count;
        MPI_Get_count(&s, MPI_DOUBLE, &count);
        assert_true(in[0] == left && in[1] == mode && in[2] == 7);
        assert_int_equal(s.MPI_SOURCE, left);
        assert_int_equal(s.MPI_TAG, mode);
        assert_int_equal(count, 3);
        assert_true(q == MPI_REQUEST_NULL);
    }
    void *back;
    int size;
    MPI_Buffer_detach(&back, &size);
    assert_ptr_equal(back, room);
    assert_int_equal(size, sizeof room);
}

static void every_mode_brings_the_data(void **state)
{
    (void)state;
    for (int n = 1; n <= 5; n++) mpi_ok(n, modes, NULL);
}

/* Rank 0 sends tags 1 and 2; rank 1 takes 2 first. */
static void out_of_order(void *context)
{
    (void)context;
    for (int tag = 1; tag <= 2; tag++) {
        int value = 0;
        if (own_rank() == 0) MPI_Send(&tag, 1, MPI_INT, 1, tag, MPI_COMM_WORLD);
        else MPI_Recv(&value, 1, MPI_INT, 0, 3 - tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        if (own_rank() == 1) assert_int_equal(value, 3 - tag);
    }
}

static void tags_choose_the_message(void **state)
{
    (void)state;
    mpi_ok(2, out_of_order, NULL);
}

/* --- persistent requests, waits of all kinds --- */

static void persistent(void *context)
{
    int n = all_ranks(), rank = own_rank(), right = (rank + 1) % n, left = (rank + n - 1) % n;
    int out = 0, in = 0;
    MPI_Request q[2];
    (void)context;
    MPI_Send_init(&out, 1, MPI_INT, right, 5, MPI_COMM_WORLD, &q[0]);
    MPI_Recv_init(&in, 1, MPI_INT, left, 5, MPI_COMM_WORLD, &q[1]);
    for (int k = 0; k < 4; k++) {
        out = 100 * rank + k;
        MPI_Startall(2, q);
        MPI_Waitall(2, q, MPI_STATUSES_IGNORE);
        assert_int_equal(in, 100 * left + k);
        assert_true(q[0] != MPI_REQUEST_NULL);
    }
    MPI_Status s;
    int flag;
    MPI_Test(&q[1], &flag, &s); /* inactive: an empty status at once */
    assert_true(flag && s.MPI_SOURCE == MPI_ANY_SOURCE);
    MPI_Request_free(&q[0]);
    MPI_Request_free(&q[1]);
    assert_true(q[0] == MPI_REQUEST_NULL);
}

static void persistent_requests_start_again(void **state)
{
    (void)state;
    for (int n = 1; n <= 4; n++) mpi_ok(n, persistent, NULL);
}

enum { MANY = 40 };

/* Rank 0 receives MANY messages from each other rank and completes them by one of five calls. */
static void completions(void *context)
{
    int way = *(int *)context, n = all_ranks(), rank = own_rank(), total = MANY * (n - 1),
        left = total;
    if (rank > 0) {
        for (int k = 0; k < MANY; k++) {
            int value = rank * 1000 + k;
            MPI_Send(&value, 1, MPI_INT, 0, k, MPI_COMM_WORLD);
        }
        return;
    }
    int *in = calloc((size_t)total + 1, sizeof *in),
        *index = calloc((size_t)total + 1, sizeof *index);
    MPI_Request *q = calloc((size_t)total + 1, sizeof *q);
    MPI_Status *s = calloc((size_t)total + 1, sizeof *s);
    for (int i = 0; i < total; i++)
        MPI_Irecv(&in[i], 1, MPI_INT, 1 + i % (n - 1), i / (n - 1), MPI_COMM_WORLD, &q[i]);
    int rounds = 0;
    while (left > 0) {
        int done = 0, flag = 1, one = 0;
        assert_true(rounds++ < 100000);
        if (way == 0) MPI_Waitany(total, q, &one, &s[0]), done = 1;
        if (way == 1) MPI_Testany(total, q, &one, &flag, &s[0]), done = flag;
        if (way == 2) MPI_Waitsome(total, q, &done, index, s);
        if (way == 3) MPI_Testsome(total, q, &done, index, s);
        if (way == 4) MPI_Testall(total, q, &flag, s), done = flag ? total : 0;
        for (int k = 0; k < done && way < 4; k++) {
            int i = way < 2 ? one : index[k];
            assert_true(q[i] == MPI_REQUEST_NULL);
            assert_int_equal(s[k].MPI_SOURCE, 1 + i % (n - 1));
            assert_int_equal(s[k].MPI_TAG, i / (n - 1));
        }
        left -= done;
    }
    for (int i = 0; i < total; i++) assert_int_equal(in[i], (1 + i % (n - 1)) * 1000 + i / (n - 1));
    int one, flag;
    MPI_Waitany(total, q, &one, s);
    assert_int_equal(one, MPI_UNDEFINED);
    MPI_Testall(total, q, &flag, s);
    assert_true(flag);
    free(in), free(index), free(q), free(s);
}

static void requests_complete_by_every_call(void **state)
{
    (void)state;
    for (int way = 0; way < 5; way++) mpi_ok(4, completions, &way);
}

/* --- wildcards and probes --- */

/* Every rank sends its number as many times as it is; rank 0 finds them all, by receives or by
 * probes first. */
static void from_anybody(void *context)
{
    int way = *(int *)context, n = all_ranks(), rank = own_rank(), total = n * (n - 1) / 2;
    int *got = calloc((size_t)n, sizeof *got);
    for (int k = 0; k < rank; k++) MPI_Send(&rank, 1, MPI_INT, 0, 10 + k, MPI_COMM_WORLD);
    for (int k = 0; rank == 0 && k < total; k++) {
        int value = -1, flag = 1, count;
        MPI_Status s;
        MPI_Message m;
        if (way == 1) MPI_Probe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &s);
        if (way == 2) do
                MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &flag, &s);
            while (!flag);
        if (way == 3) MPI_Mprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &m, &s);
        if (way > 0) {
            MPI_Get_count(&s, MPI_INT, &count);
            assert_int_equal(count, 1);
        }
        if (way == 0) MPI_Recv(&value, 1, MPI_INT, MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &s);
        else if (way == 3) MPI_Mrecv(&value, 1, MPI_INT, &m, &s);
        else MPI_Recv(&value, 1, MPI_INT, s.MPI_SOURCE, s.MPI_TAG, MPI_COMM_WORLD, &s);
        assert_int_equal(value, s.MPI_SOURCE);
        /* messages of one sender come in the order sent */
        assert_int_equal(s.MPI_TAG, 10 + got[value]);
        got[value]++;
    }
    for (int r = 1; rank == 0 && r < n; r++) assert_int_equal(got[r], r);
    free(got);
}

static void wildcards_and_probes_find_everything_in_order(void **state)
{
    (void)state;
    for (int way = 0; way < 4; way++) mpi_ok(7, from_anybody, &way);
}

/* --- exchanges, the rank that is none, cancel, generalized requests --- */

static void exchanges(void *context)
{
    int n = all_ranks(), rank = own_rank(), right = (rank + 1) % n, left = (rank + n - 1) % n;
    int out = rank, in = -1, both = rank;
    MPI_Status s;
    MPI_Request q;
    (void)context;
    MPI_Sendrecv(&out, 1, MPI_INT, right, 1, &in, 1, MPI_INT, left, 1, MPI_COMM_WORLD, &s);
    assert_int_equal(in, left);
    assert_int_equal(s.MPI_SOURCE, left);
    MPI_Sendrecv_replace(&both, 1, MPI_INT, right, 1, left, 1, MPI_COMM_WORLD, &s);
    assert_int_equal(both, left);
    MPI_Isendrecv(&out, 1, MPI_INT, left, 2, &in, 1, MPI_INT, right, 2, MPI_COMM_WORLD, &q);
    MPI_Wait(&q, &s);
    assert_int_equal(in, right);
    assert_int_equal(s.MPI_SOURCE, right);
    in = -7;
    MPI_Recv(&in, 1, MPI_INT, MPI_PROC_NULL, 1, MPI_COMM_WORLD, &s);
    MPI_Send(&in, 1, MPI_INT, MPI_PROC_NULL, 1, MPI_COMM_WORLD);
    assert_true(in == -7 && s.MPI_SOURCE == MPI_PROC_NULL && s.MPI_TAG == MPI_ANY_TAG);
    /* a receive that nobody answers is taken back */
    int flag;
    MPI_Irecv(&in, 1, MPI_INT, left, 999, MPI_COMM_WORLD, &q);
    MPI_Cancel(&q);
    MPI_Wait(&q, &s);
    MPI_Test_cancelled(&s, &flag);
    assert_true(flag);
}

static void exchanges_and_cancels_do_as_the_standard_says(void **state)
{
    (void)state;
    for (int n = 1; n <= 5; n++) mpi_ok(n, exchanges, NULL);
}

static int freed;
static int query(void *extra, MPI_Status *s)
{
    MPI_Status_set_elements(s, MPI_INT, *(int *)extra);
    MPI_Status_set_cancelled(s, 0);
    s->MPI_SOURCE = 3;
    return MPI_SUCCESS;
}
static int release(void *extra)
{
    freed += *(int *)extra;
    return MPI_SUCCESS;
}
static int cancel(void *extra, int complete)
{
    (void)extra, (void)complete;
    return MPI_SUCCESS;
}

static void general(void *context)
{
    MPI_Request q;
    MPI_Status s;
    int extra = 5, flag, count;
    (void)context;
    MPI_Grequest_start(query, release, cancel, &extra, &q);
    MPI_Test(&q, &flag, &s);
    assert_false(flag);
    MPI_Grequest_complete(q);
    MPI_Wait(&q, &s);
    MPI_Get_count(&s, MPI_INT, &count);
    assert_true(count == 5 && s.MPI_SOURCE == 3);
}

static void requests_of_the_program_complete(void **state)
{
    (void)state;
    freed = 0;
    mpi_ok(2, general, NULL);
    assert_int_equal(freed, 10);
}

/* --- the buffer of MPI_Bsend, where more than 100 bytes wait for their receiver --- */

static int buffered(char *data, int bytes)
{
    int class;
    MPI_Error_class(MPI_Bsend(data, bytes, MPI_CHAR, 1, 0, MPI_COMM_WORLD), &class);
    return class;
}

static void one_millisecond(void)
{
    double end = MPI_Wtime() + 1e-3;
    while (MPI_Wtime() < end) continue;
}

/* Rank 1 receives what has left, after a millisecond each time. */
static void full(void *context)
{
    static char data[1000];
    char room[2500];
    void *back;
    int size;
    double *detached = context;
    MPI_Init(NULL, NULL);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    if (own_rank() == 1) {
        for (int i = 0; i < 10; i++) {
            if (i < 2) one_millisecond();
            MPI_Recv(data, 1000, MPI_CHAR, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
            if (i == 1) MPI_Send(data, 1, MPI_CHAR, 0, 1, MPI_COMM_WORLD);
        }
        one_millisecond();
        MPI_Recv(data, 1000, MPI_CHAR, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    } else {
        MPI_Buffer_attach(room, sizeof room);
        assert_int_equal(buffered(data, 1000), MPI_SUCCESS);
        assert_int_equal(buffered(data, 1000), MPI_SUCCESS);
        assert_int_equal(buffered(data, 1000), MPI_ERR_BUFFER);
        /* eager ones take no room once they are sent */
        for (int i = 0; i < 8; i++) assert_int_equal(buffered(data, 100), MPI_SUCCESS);
        MPI_Recv(data, 1, MPI_CHAR, 1, 1, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        assert_int_equal(buffered(data, 1000), MPI_SUCCESS);
        MPI_Buffer_detach(&back, &size);
        *detached = MPI_Wtime();
        assert_true(back == room && size == sizeof room);
    }
    MPI_Finalize();
}

static void a_buffer_is_full_until_messages_leave(void **state)
{
    static const struct mpi_setup setup;
    struct machine_spec m = crossbar(2);
    double detached = 0;
    (void)state;
    m.software.eager_bytes = 100;
    struct outcome o = mpi_bare(&m, 2, &setup, full, &detached);
    expect_ok(&o);
    arena_destroy(o.arena);
    assert_true(detached > 3e-3 && detached < 3.2e-3);
}

/* --- statuses --- */

static void assert_empty(const MPI_Status *s)
{
    int count;
    MPI_Get_count(s, MPI_INT, &count);
    assert_true(s->MPI_SOURCE == MPI_ANY_SOURCE && s->MPI_TAG == MPI_ANY_TAG);
    assert_true(s->MPI_ERROR == MPI_SUCCESS && count == 0);
}

/* What is not there has an empty status, its error field included (section 3.7.3). */
static void nothing(void *context)
{
    MPI_Request none = MPI_REQUEST_NULL, idle;
    MPI_Status s;
    int flag, index, data = 0;
    (void)context;
    memset(&s, 0x55, sizeof s);
    MPI_Request_get_status(none, &flag, &s);
    assert_true(flag);
    assert_empty(&s);
    memset(&s, 0x55, sizeof s);
    MPI_Wait(&none, &s);
    assert_empty(&s);
    memset(&s, 0x55, sizeof s);
    MPI_Waitany(1, &none, &index, &s);
    assert_int_equal(index, MPI_UNDEFINED);
    assert_empty(&s);
    MPI_Recv_init(&data, 1, MPI_INT, 0, 0, MPI_COMM_WORLD, &idle);
    memset(&s, 0x55, sizeof s);
    MPI_Test(&idle, &flag, &s);
    assert_true(flag);
    assert_empty(&s);
    MPI_Request_free(&idle);
}

/* A look at a request tells what its completion will: of a receive from nobody, and of one from any
 * rank of the other side, whose ranks are not those of the world. */
static void looks(void *context)
{
    int rank = own_rank(), side = rank / 2, data = rank, flag = 0;
    MPI_Comm half, inter;
    MPI_Request q;
    MPI_Status seen, told;
    (void)context;
    MPI_Irecv(&data, 1, MPI_INT, MPI_PROC_NULL, 3, MPI_COMM_WORLD, &q);
    MPI_Request_get_status(q, &flag, &seen);
    assert_true(flag && seen.MPI_SOURCE == MPI_PROC_NULL);
    MPI_Wait(&q, &told);
    assert_int_equal(told.MPI_SOURCE, MPI_PROC_NULL);
    MPI_Comm_split(MPI_COMM_WORLD, side, rank, &half);
    MPI_Intercomm_create(half, 0, MPI_COMM_WORLD, side ? 0 : 2, 3, &inter);
    data = rank;
    if (side == 1) MPI_Send(&data, 1, MPI_INT, 1 - rank % 2, rank, inter);
    else {
        MPI_Irecv(&data, 1, MPI_INT, MPI_ANY_SOURCE, MPI_ANY_TAG, inter, &q);
        while (flag = 0, MPI_Request_get_status(q, &flag, &seen), !flag) continue;
        MPI_Wait(&q, &told);
        assert_int_equal(told.MPI_SOURCE, 1 - rank);
        assert_true(seen.MPI_SOURCE == told.MPI_SOURCE && seen.MPI_TAG == told.MPI_TAG);
        assert_true(told.MPI_TAG == 3 - rank && data == 3 - rank);
    }
    MPI_Comm_free(&inter);
    MPI_Comm_free(&half);
}

static void statuses_tell_what_happened(void **state)
{
    (void)state;
    mpi_ok(1, nothing, NULL);
    mpi_ok(4, looks, NULL);
}

/* --- time --- */

static void clocks(void *context)
{
    double *times = context, begin = MPI_Wtime();
    char data[1000] = {0};
    if (own_rank() == 0) MPI_Send(data, 1000, MPI_CHAR, 1, 0, MPI_COMM_WORLD);
    else MPI_Recv(data, 1000, MPI_CHAR, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    times[own_rank()] = MPI_Wtime() - begin;
}

static void time_is_simulated(void **state)
{
    double times[2];
    (void)state;
    mpi_ok(2, clocks, times);
    assert_true(times[0] > 2.9e-6 && times[0] < 3.1e-6); /* o_s and a byte's share of 1000 */
    const double expected = (double)(trip(1000) + receipt(1000) + 20000); /* a look at the clock */
    assert_true(times[1] * 1e12 - expected < 1 && times[1] * 1e12 - expected > -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_mode_brings_the_data),
        cmocka_unit_test(tags_choose_the_message),
        cmocka_unit_test(persistent_requests_start_again),
        cmocka_unit_test(requests_complete_by_every_call),
        cmocka_unit_test(wildcards_and_probes_find_everything_in_order),
        cmocka_unit_test(exchanges_and_cancels_do_as_the_standard_says),
        cmocka_unit_test(requests_of_the_program_complete),
        cmocka_unit_test(a_buffer_is_full_until_messages_leave),
        cmocka_unit_test(statuses_tell_what_happened),
        cmocka_unit_test(time_is_simulated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
