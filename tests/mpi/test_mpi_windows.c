/* test_mpi_windows.c - one-sided communication: every operation, every way to synchronize. */
#include "mpi_world.h"

enum { N = 5 };

/* Everybody puts into the right neighbour, gets from the left and adds to all. */
static void fenced(void *context)
{
    int n = all_ranks(), rank = own_rank(), right = (rank + 1) % n, left = (rank + n - 1) % n;
    long memory[3 * N] = {0}, out[N], in[N] = {0};
    MPI_Win w;
    (void)context;
    for (int i = 0; i < N; i++) out[i] = 100 * rank + i, memory[N + i] = 7 * rank + i;
    MPI_Win_create(memory, sizeof memory, sizeof(long), MPI_INFO_NULL, MPI_COMM_WORLD, &w);
    MPI_Win_fence(0, w);
    MPI_Put(out, N, MPI_LONG, right, 0, N, MPI_LONG, w);
    MPI_Get(in, N, MPI_LONG, left, N, N, MPI_LONG, w);
    for (int r = 0; r < n; r++) MPI_Accumulate(out, N, MPI_LONG, r, 2 * N, N, MPI_LONG, MPI_SUM, w);
    MPI_Win_fence(0, w);
    for (int i = 0; i < N; i++) {
        assert_int_equal(memory[i], 100 * left + i);
        assert_int_equal(in[i], 7 * left + i);
        assert_int_equal(memory[2 * N + i], 100 * n * (n - 1) / 2 + n * i);
    }
    MPI_Win_free(&w);
    assert_true(w == MPI_WIN_NULL);
}

static void fences_complete_all_operations(void **state)
{
    (void)state;
    for (int n = 1; n <= 6; n++) mpi_ok(n, fenced, NULL);
}

/* Even ranks expose, odd ones access their neighbours; into every second element. */
static void groups(void *context)
{
    int n = all_ranks(), rank = own_rank(), peer = rank ^ 1, flag = 0, rounds = 0;
    int memory[2 * N] = {0}, out[N];
    MPI_Group all, one;
    MPI_Win w;
    MPI_Datatype second;
    (void)context;
    MPI_Type_vector(N, 1, 2, MPI_INT, &second);
    MPI_Type_commit(&second);
    for (int i = 0; i < N; i++) out[i] = rank * 10 + i;
    MPI_Win_create(memory, sizeof memory, sizeof(int), MPI_INFO_NULL, MPI_COMM_WORLD, &w);
    MPI_Comm_group(MPI_COMM_WORLD, &all);
    assert_true(n % 2 == 0);
    MPI_Group_incl(all, 1, &peer, &one);
    if (rank % 2) {
        MPI_Win_start(one, 0, w);
        MPI_Put(out, N, MPI_INT, peer, 0, 1, second, w);
        MPI_Win_complete(w);
    } else {
        MPI_Win_post(one, 0, w);
        if (rank % 4) MPI_Win_wait(w);
        else
            while (!flag) {
                MPI_Win_test(w, &flag);
                assert_true(rounds++ < 10000);
            }
        for (int i = 0; i < N; i++) assert_int_equal(memory[2 * i], peer * 10 + i);
        for (int i = 0; i < N; i++) assert_int_equal(memory[2 * i + 1], 0);
    }
    MPI_Group_free(&one);
    MPI_Group_free(&all);
    MPI_Type_free(&second);
    MPI_Win_free(&w);
}

static void groups_expose_and_access(void **state)
{
    (void)state;
    mpi_ok(2, groups, NULL);
    mpi_ok(6, groups, NULL);
}

enum { ROUNDS = 20 };

/* Counters on rank 0 are raised by everybody in four ways; none is lost. */
static void counters(void *context)
{
    int n = all_ranks(), rank = own_rank();
    long *memory, one = 1, was;
    MPI_Win w;
    (void)context;
    MPI_Win_allocate(rank ? 0 : 4 * (MPI_Aint)sizeof(long), sizeof(long), MPI_INFO_NULL,
                     MPI_COMM_WORLD, &memory, &w);
    for (int i = 0; i < ROUNDS; i++) {
        /* alone: read, add, write */
        MPI_Win_lock(MPI_LOCK_EXCLUSIVE, 0, 0, w);
        MPI_Get(&was, 1, MPI_LONG, 0, 0, 1, MPI_LONG, w);
        MPI_Win_flush(0, w);
        was++;
        MPI_Put(&was, 1, MPI_LONG, 0, 0, 1, MPI_LONG, w);
        MPI_Win_unlock(0, w);
        /* together: operations are one at a time */
        MPI_Win_lock_all(0, w);
        MPI_Accumulate(&one, 1, MPI_LONG, 0, 0, 1, MPI_LONG, MPI_SUM,
                       w); /* none while a rank is alone */
        MPI_Fetch_and_op(&one, &was, MPI_LONG, 0, 1, MPI_SUM, w);
        MPI_Request q;
        MPI_Raccumulate(&one, 1, MPI_LONG, 0, 2, 1, MPI_LONG, MPI_SUM, w, &q);
        MPI_Wait(&q, MPI_STATUS_IGNORE);
        long expected, found = -1;
        do {
            expected = found < 0 ? 0 : found;
            was = expected + 1;
            MPI_Compare_and_swap(&was, &expected, &found, MPI_LONG, 0, 3, w);
            MPI_Win_flush(0, w);
        } while (found != expected);
        MPI_Win_unlock_all(w);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    for (int k = 0; k < 4 && rank == 0; k++)
        assert_int_equal(memory[k], (k == 0 ? 2 : 1) * ROUNDS * n);
    MPI_Win_free(&w);
}

static void locks_and_atomic_operations_lose_nothing(void **state)
{
    (void)state;
    for (int n = 1; n <= 5; n++) mpi_ok(n, counters, NULL);
}

static void shared(void *context)
{
    int n = all_ranks(), rank = own_rank(), unit;
    int *own, *other;
    MPI_Aint size;
    MPI_Win w;
    (void)context;
    MPI_Win_allocate_shared((rank + 1) * (MPI_Aint)sizeof(int), sizeof(int), MPI_INFO_NULL,
                            MPI_COMM_WORLD, &own, &w);
    for (int i = 0; i <= rank; i++) own[i] = rank;
    MPI_Win_fence(0, w);
    MPI_Win_shared_query(w, (rank + 1) % n, &size, &unit, &other);
    assert_int_equal(size, ((rank + 1) % n + 1) * (MPI_Aint)sizeof(int));
    assert_int_equal(other[(rank + 1) % n], (rank + 1) % n);
    MPI_Win_fence(0, w);
    MPI_Win_free(&w);
}

static void memory_is_shared(void **state)
{
    (void)state;
    for (int n = 1; n <= 4; n++) mpi_ok(n, shared, NULL);
}

static void outside(void *context)
{
    char memory[8];
    MPI_Win w;
    (void)context;
    MPI_Win_create(memory, sizeof memory, 1, MPI_INFO_NULL, MPI_COMM_WORLD, &w);
    MPI_Win_fence(0, w);
    if (own_rank() == 1) MPI_Put(memory, 8, MPI_CHAR, 0, 4, 8, MPI_CHAR, w);
    MPI_Win_fence(0, w);
    MPI_Win_free(&w);
}

static void forgotten(void *context)
{
    static char memory[8];
    MPI_Win w;
    (void)context;
    MPI_Win_create(memory, sizeof memory, 1, MPI_INFO_NULL, MPI_COMM_WORLD, &w);
}

static void accesses_outside_and_forgotten_windows_are_told(void **state)
{
    (void)state;
    mpi_fails(2, outside, NULL, "rank 1 accesses bytes 4 .. 11 of a window of 8 bytes");
    mpi_fails(2, forgotten, NULL, "a window was not freed");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fences_complete_all_operations),
        cmocka_unit_test(groups_expose_and_access),
        cmocka_unit_test(locks_and_atomic_operations_lose_nothing),
        cmocka_unit_test(memory_is_shared),
        cmocka_unit_test(accesses_outside_and_forgotten_windows_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
