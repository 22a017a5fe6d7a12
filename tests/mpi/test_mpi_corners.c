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

/* --- reductions on types with gaps --- */

/* Two ints, 8 bytes apart from each other, and elements only 4 bytes apart: they interleave. */
static MPI_Datatype interleaved(void)
{
    MPI_Datatype pair, t;
    MPI_Type_create_indexed_block(2, 1, (int[]){1, 3}, MPI_INT, &pair);
    MPI_Type_create_resized(pair, 0, 4, &t);
    MPI_Type_commit(&t);
    MPI_Type_free(&pair);
    return t;
}

/* Elements one by one as the type says: the first int of the second is 4 bytes behind. */
static void add_pairs(void *in, void *inout, int *n, MPI_Datatype *t)
{
    const int *a = in;
    int *b = inout;
    (void)t;
    for (int i = 0; i < *n; i++) b[i + 1] += a[i + 1], b[i + 3] += a[i + 3];
}

/* Ints 1, 2, 3 and 4 belong to the elements, 0 and 5 are fences. */
static void expect_pairs(const int *got, int fence, int factor)
{
    for (int i = 0; i < 6; i++)
        assert_int_equal(got[i], i == 0 || i == 5 ? fence : factor * (10 + i));
}

static void reduce_pairs(void *context)
{
    int out[6] = {-7, 11, 12, 13, 14, -7}, n = all_ranks();
    MPI_Datatype t = interleaved();
    MPI_Op op[2];
    (void)context;
    MPI_Op_create((MPI_User_function *)add_pairs, 1, &op[0]);
    MPI_Op_create((MPI_User_function *)add_pairs, 0, &op[1]);
    for (int k = 0; k < 2; k++) {
        int in[6] = {-8, 0, 0, 0, 0, -8}, place[6];
        MPI_Allreduce(out, in, 2, t, op[k], MPI_COMM_WORLD);
        expect_pairs(in, -8, n);
        memcpy(place, out, sizeof place);
        MPI_Scan(MPI_IN_PLACE, place, 2, t, op[k], MPI_COMM_WORLD);
        expect_pairs(place, -7, own_rank() + 1);
        memcpy(place, out, sizeof place);
        MPI_Reduce_local(out, place, 2, t, op[k]);
        expect_pairs(place, -7, 2);
        MPI_Op_free(&op[k]);
    }
    MPI_Type_free(&t);
}

static void gaps_of_types_stay_as_they_are(void **state)
{
    (void)state;
    mpi_ok(3, reduce_pairs, NULL);
}

/* Each side's sum goes to the other; the type's first byte is far behind the buffer's begin. */
static void add_far(void *in, void *inout, int *n, MPI_Datatype *t)
{
    (void)t;
    for (int i = 0; i < *n; i++)
        ((int *)inout)[2000 * (i + 1) - 1] += ((const int *)in)[2000 * (i + 1) - 1];
}

static void reduce_across(void *context)
{
    static int out[4][4000], in[4][4000];
    int rank = own_rank(), other = rank % 2 ? 2 : 4, *o = out[rank], *i = in[rank];
    MPI_Comm side, both;
    MPI_Datatype raw, t;
    MPI_Op op;
    (void)context;
    MPI_Comm_split(MPI_COMM_WORLD, rank % 2, rank, &side);
    MPI_Intercomm_create(side, 0, MPI_COMM_WORLD, 1 - rank % 2, 5, &both);
    MPI_Type_create_indexed_block(1, 1, (int[]){1999}, MPI_INT, &raw);
    MPI_Type_create_resized(raw, 0, 8000, &t);
    MPI_Type_commit(&t);
    MPI_Op_create((MPI_User_function *)add_far, 1, &op);
    o[1999] = rank + 1, o[3999] = 10 * (rank + 1);
    MPI_Allreduce(o, i, 2, t, op, both);
    assert_int_equal(i[1999], other == 2 ? 1 + 3 : 2 + 4);
    assert_int_equal(i[3999], 10 * i[1999]);
    i[1999] = 0;
    MPI_Reduce_scatter_block(o, i, 1, t, op, both);
    assert_int_equal(i[1999], (rank < 2 ? 1 : 10) * (other == 2 ? 1 + 3 : 2 + 4));
    MPI_Op_free(&op);
    MPI_Type_free(&t);
    MPI_Type_free(&raw);
    MPI_Comm_free(&both);
    MPI_Comm_free(&side);
}

static void reductions_across_know_where_elements_begin(void **state)
{
    (void)state;
    mpi_ok(4, reduce_across, NULL);
}

/* An element without bytes, so that no memory is needed for more than an int counts. */
static int64_t counted;
static void count_elements(void *in, void *inout, int *n, MPI_Datatype *t)
{
    (void)in, (void)inout, (void)t;
    assert_true(*n > 0);
    counted += *n;
}

static void reduce_many(void *context)
{
    const MPI_Count many = ((MPI_Count)1 << 32) + 5;
    MPI_Datatype none;
    MPI_Op op;
    int x = 0, y = 0;
    (void)context;
    MPI_Type_contiguous(0, MPI_INT, &none);
    MPI_Type_commit(&none);
    MPI_Op_create((MPI_User_function *)count_elements, 1, &op);
    counted = 0;
    MPI_Reduce_local_c(&x, &y, many, none, op);
    assert_int_equal(counted, many);
    MPI_Op_free(&op);
    MPI_Type_free(&none);
}

static void large_counts_reach_functions_that_count_in_int(void **state)
{
    (void)state;
    mpi_ok(1, reduce_many, NULL);
}

/* --- operations inside operations --- */

static void start_inside(void *in, void *inout, int *n, MPI_Datatype *t)
{
    MPI_Request q;
    (void)in, (void)inout, (void)n, (void)t;
    MPI_Ibarrier(MPI_COMM_SELF, &q);
}

static void nested(void *context)
{
    int x = 1, y;
    MPI_Op op;
    MPI_Request q;
    (void)context;
    MPI_Op_create((MPI_User_function *)start_inside, 1, &op);
    MPI_Iallreduce(&x, &y, 1, MPI_INT, op, MPI_COMM_WORLD, &q);
    MPI_Wait(&q, MPI_STATUS_IGNORE);
}

static void nested_operations_are_refused(void **state)
{
    (void)state;
    mpi_fails(2, nested, NULL, "MPI_Ibarrier: called by a function inside an operation");
}

/* --- what operations in progress tell --- */

static int refuse_copy(MPI_Comm c, int key, void *extra, void *in, void *out, int *flag)
{
    (void)c, (void)key, (void)extra, (void)in, (void)out, (void)flag;
    return MPI_ERR_INTERN;
}

static void failing_copies(void *context)
{
    int key;
    MPI_Comm copy;
    MPI_Request q;
    (void)context;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Comm_create_keyval(refuse_copy, MPI_COMM_NULL_DELETE_FN, &key, NULL);
    MPI_Comm_set_attr(MPI_COMM_WORLD, key, &key);
    MPI_Comm_idup(MPI_COMM_WORLD, &copy, &q);
    assert_int_not_equal(MPI_Wait(&q, MPI_STATUS_IGNORE), MPI_SUCCESS);
    assert_true(copy == MPI_COMM_NULL);
    MPI_Comm_delete_attr(MPI_COMM_WORLD, key);
    MPI_Comm_free_keyval(&key);
}

/* The message of two ints does not fit in one. */
static void failing_exchanges(void *context)
{
    int out[2] = {1, 2}, in[2] = {0, 0}, other = 1 - own_rank();
    MPI_Request q;
    (void)context;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Isendrecv(out, 2, MPI_INT, other, 4, in, 1, MPI_INT, other, 4, MPI_COMM_WORLD, &q);
    assert_int_equal(MPI_Wait(&q, MPI_STATUS_IGNORE), MPI_ERR_TRUNCATE);
    assert_int_equal(in[1], 0);
}

static void errors_of_operations_are_the_waits(void **state)
{
    (void)state;
    mpi_ok(2, failing_copies, NULL);
    mpi_ok(2, failing_exchanges, NULL);
}

static void looks(void *context)
{
    int out = 7, in = 0, flag, index, n, indices[2], other = 1 - own_rank();
    MPI_Request q[2];
    MPI_Status s;
    (void)context;
    /* An inactive request beside one that is complete, then inactive ones alone. */
    MPI_Recv_init(&in, 1, MPI_INT, other, 9, MPI_COMM_WORLD, &q[0]);
    MPI_Isendrecv(&out, 1, MPI_INT, other, 4, &in, 1, MPI_INT, other, 4, MPI_COMM_WORLD, &q[1]);
    do MPI_Request_get_status(q[1], &flag, &s);
    while (!flag);
    assert_int_equal(s.MPI_SOURCE, other);
    assert_int_equal(s.MPI_TAG, 4);
    MPI_Request_get_status_any(2, q, &index, &flag, &s);
    assert_int_equal(index, 1);
    MPI_Request_get_status_some(2, q, &n, indices, MPI_STATUSES_IGNORE);
    assert_int_equal(n, 1);
    assert_int_equal(indices[0], 1);
    MPI_Wait(&q[1], MPI_STATUS_IGNORE);
    MPI_Request_get_status_any(2, q, &index, &flag, &s);
    assert_int_equal(index, MPI_UNDEFINED);
    assert_true(flag);
    MPI_Request_get_status_some(2, q, &n, indices, MPI_STATUSES_IGNORE);
    assert_int_equal(n, MPI_UNDEFINED);
    MPI_Request_free(&q[0]);
}

static void looks_pass_over_inactive_requests(void **state)
{
    (void)state;
    mpi_ok(2, looks, NULL);
}

/* Blanks around a key do not count, wherever it is given. */
static void padded_keys(void *context)
{
    MPI_Info info;
    char value[8] = "";
    int flag, n = sizeof value;
    (void)context;
    MPI_Info_create(&info);
    MPI_Info_set(info, " key ", "v");
    MPI_Info_get_string(info, "  key  ", &n, value, &flag);
    assert_true(flag);
    assert_string_equal(value, "v");
    MPI_Info_get_valuelen(info, "key ", &n, &flag);
    assert_true(flag);
    MPI_Info_delete(info, "key  ");
    MPI_Info_get_nkeys(info, &n);
    assert_int_equal(n, 0);
    MPI_Info_free(&info);
}

static void keys_are_found_with_their_blanks(void **state)
{
    (void)state;
    mpi_ok(1, padded_keys, NULL);
}

/* --- wrong arguments --- */

static void falling_index(void *context)
{
    MPI_Comm graph;
    (void)context;
    MPI_Graph_create(MPI_COMM_WORLD, 2, (int[]){3, 1}, (int[]){1, 0, 1}, 0, &graph);
}

static void freed_under_a_lock(void *context)
{
    MPI_Win w;
    int *memory;
    (void)context;
    MPI_Win_allocate(4, 4, MPI_INFO_NULL, MPI_COMM_WORLD, &memory, &w);
    MPI_Win_lock(MPI_LOCK_SHARED, 0, 0, w);
    MPI_Win_free(&w);
}

static void wrong_arguments_are_told(void **state)
{
    (void)state;
    mpi_fails(2, falling_index, NULL, "the list of node 1 ends at 1, before it begins");
    mpi_fails(2, freed_under_a_lock, NULL, "an epoch of the window is still open");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(failed_starts_leave_nothing),
        cmocka_unit_test(matched_probes_let_operations_go_on),
        cmocka_unit_test(types_of_blocks_are_checked),
        cmocka_unit_test(gaps_of_types_stay_as_they_are),
        cmocka_unit_test(reductions_across_know_where_elements_begin),
        cmocka_unit_test(large_counts_reach_functions_that_count_in_int),
        cmocka_unit_test(nested_operations_are_refused),
        cmocka_unit_test(errors_of_operations_are_the_waits),
        cmocka_unit_test(looks_pass_over_inactive_requests),
        cmocka_unit_test(keys_are_found_with_their_blanks),
        cmocka_unit_test(wrong_arguments_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
