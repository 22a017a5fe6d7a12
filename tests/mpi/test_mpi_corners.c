/* test_mpi_corners.c - rare calls: what fails and goes on, matched probes beside operations in
 * progress, types for each block. */
#include "mpi_world.h"

/* Nothing was started where the call returned an error: MPI_Finalize must not miss it. */
static void failed_starts(void *context)
{
    static char room[64];
    int data[4] = {0}, size;
    MPI_Request q, kept;
    (void)context;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Buffer_attach(room, 4);
    assert_int_equal(MPI_Ibsend(data, 4, MPI_INT, 0, 0, MPI_COMM_WORLD, &q), MPI_ERR_BUFFER);
    assert_true(q == MPI_REQUEST_NULL);
    /* A persistent one stays inactive, and may be freed. */
    MPI_Bsend_init(data, 4, MPI_INT, 0, 0, MPI_COMM_WORLD, &kept);
    assert_int_equal(MPI_Start(&kept), MPI_ERR_BUFFER);
    assert_int_equal(MPI_Wait(&kept, MPI_STATUS_IGNORE), MPI_SUCCESS);
    MPI_Request_free(&kept);
    MPI_Buffer_detach(&(void *){NULL}, &size);
}

static void failed_starts_leave_nothing(void **state)
{
    (void)state;
    mpi_ok(1, failed_starts, NULL);
}

/* Rank 2 leaves the barrier only when rank 0, which waits for its message, has passed the barrier
 * on. */
static void matched_probe(void *context)
{
    int got = 0;
    MPI_Request q;
    MPI_Message m;
    (void)context;
    MPI_Ibarrier(MPI_COMM_WORLD, &q);
    if (own_rank() == 0) {
        MPI_Mprobe(2, 7, MPI_COMM_WORLD, &m, MPI_STATUS_IGNORE);
        MPI_Mrecv(&got, 1, MPI_INT, &m, MPI_STATUS_IGNORE);
        assert_int_equal(got, 5);
    }
    MPI_Wait(&q, MPI_STATUS_IGNORE);
    if (own_rank() == 2)
        MPI_Send(&(int){5}, 1, MPI_INT, 0, 7, MPI_COMM_WORLD);
}

static void matched_probes_let_operations_go_on(void **state)
{
    (void)state;
    mpi_ok(4, matched_probe, NULL);
}

/* The second block's type is wrong on all ranks; where a count is 0 the type may be none. */
static void block_types(void *context)
{
    int out[2] = {1, 2}, in[2] = {0}, count[2] = {1, 1}, place[2] = {0, 4};
    MPI_Aint far[2] = {0, 4};
    MPI_Datatype raw, good[2] = {MPI_INT, MPI_INT}, none[2] = {MPI_INT, MPI_DATATYPE_NULL},
                      bad[2] = {MPI_INT, NULL};
    MPI_Comm line;
    (void)context;
    MPI_Type_contiguous(1, MPI_INT, &raw);
    bad[1] = raw;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Cart_create(MPI_COMM_WORLD, 1, &(int){2}, &(int){1}, 0, &line);
    assert_int_equal(MPI_Alltoallw(out, count, place, none, in, count, place, good, MPI_COMM_WORLD),
                     MPI_ERR_TYPE);
    assert_int_equal(MPI_Alltoallw(out, count, place, good, in, count, place, none, MPI_COMM_WORLD),
                     MPI_ERR_TYPE);
    assert_int_equal(MPI_Alltoallw(out, count, place, good, in, count, place, bad, MPI_COMM_WORLD),
                     MPI_ERR_TYPE);
    assert_int_equal(MPI_Neighbor_alltoallw(out, count, far, none, in, count, far, good, line),
                     MPI_ERR_TYPE);
    assert_int_equal(MPI_Neighbor_alltoallw(out, count, far, good, in, count, far, none, line),
                     MPI_ERR_TYPE);
    count[1] = -1;
    assert_int_equal(MPI_Neighbor_alltoallw(out, count, far, good, in, count, far, good, line),
                     MPI_ERR_COUNT);
    /* An empty block: rank 0 sends to itself alone, and rank 1 to rank 0. */
    int some[2] = {1, 0}, from[2] = {own_rank() == 0, own_rank() == 0};
    assert_int_equal(MPI_Alltoallw(out, some, place, none, in, from, place, good, MPI_COMM_WORLD),
                     MPI_SUCCESS);
    assert_int_equal(in[1], own_rank() == 0 ? 1 : 0);
    MPI_Type_free(&raw);
    MPI_Comm_free(&line);
}

static void types_of_blocks_are_checked(void **state)
{
    (void)state;
    mpi_ok(2, block_types, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(failed_starts_leave_nothing),
        cmocka_unit_test(matched_probes_let_operations_go_on),
        cmocka_unit_test(types_of_blocks_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
