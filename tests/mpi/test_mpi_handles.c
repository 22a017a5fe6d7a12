/* test_mpi_handles.c - handles that are none in each call on types, operations and windows; names
 * of functions that the standard has removed; statuses that are empty, cancelled or set. */
#include "mpi_world.h"

static void return_errors(void) { MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN); }

/* --- no types --- */

/* Each call on `t`, which is the null handle, or was freed, or is of another kind. */
static void each_on(MPI_Datatype t)
{
    int n, i[4] = {0};
    MPI_Aint a = 0, b = 0;
    MPI_Count c, d;
    MPI_Datatype u, kept = t;
    MPI_Status s = {0};
    char name[MPI_MAX_OBJECT_NAME];
    assert_int_equal(MPI_Type_size(t, &n), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_size_x(t, &c), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_get_extent(t, &a, &b), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_get_extent_x(t, &c, &d), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_get_true_extent(t, &a, &b), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_get_true_extent_x(t, &c, &d), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_get_envelope(t, &n, &n, &n, &n), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_get_contents(t, 0, 0, 0, i, &a, &u), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_set_name(t, "x"), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_dup(t, &u), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_create_resized(t, 0, 4, &u), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_create_hvector(1, 1, 1, t, &u), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_indexed(1, i, i, t, &u), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_create_subarray(1, i, i, i, MPI_ORDER_C, t, &u), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_create_darray(1, 0, 1, i, i, i, i, MPI_ORDER_C, t, &u), MPI_ERR_TYPE);
    assert_int_equal(MPI_Get_count(&s, t, &n), MPI_ERR_TYPE);
    assert_int_equal(MPI_Get_elements(&s, t, &n), MPI_ERR_TYPE);
    assert_int_equal(MPI_Get_elements_x(&s, t, &c), MPI_ERR_TYPE);
    assert_int_equal(MPI_Status_set_elements(&s, t, 1), MPI_ERR_TYPE);
    assert_int_equal(MPI_Pack_size(1, t, MPI_COMM_WORLD, &n), MPI_ERR_TYPE);
    assert_int_equal(MPI_Unpack(name, 4, &n, i, 1, t, MPI_COMM_WORLD), MPI_ERR_TYPE);
    assert_int_equal(MPI_Send(i, 1, t, 0, 0, MPI_COMM_WORLD), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_commit(&kept), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_free(&kept), MPI_ERR_TYPE);
    assert_true(kept == t); /* what could not be freed stays */
}

static void no_types(void *context)
{
    MPI_Datatype t, kept;
    MPI_Info info;
    (void)context;
    return_errors();
    each_on(MPI_DATATYPE_NULL);
    MPI_Type_contiguous(2, MPI_INT, &t);
    kept = t;
    MPI_Type_free(&t);
    each_on(kept);
    MPI_Info_create(&info);
    each_on((MPI_Datatype)(intptr_t)info);
    MPI_Info_free(&info);
    /* numbers within the standard's range that name no type */
    each_on((MPI_Datatype)0x2ff);
    each_on((MPI_Datatype)0x200);
}

static void handles_of_no_type_are_refused(void **state)
{
    (void)state;
    mpi_ok(1, no_types, NULL);
}

/* --- names of old programs --- */

static void same_type(MPI_Datatype a, MPI_Datatype b)
{
    int n[2], out[2][24], at = 0;
    MPI_Aint lb[2], extent[2], ub;
    int memory[24];
    for (int i = 0; i < 24; i++) memory[i] = i;
    MPI_Type_commit(&a), MPI_Type_commit(&b);
    MPI_Type_size(a, &n[0]), MPI_Type_size(b, &n[1]);
    assert_int_equal(n[0], n[1]);
    MPI_Type_get_extent(a, &lb[0], &extent[0]);
    MPI_Type_lb(b, &lb[1]), MPI_Type_extent(b, &extent[1]), MPI_Type_ub(b, &ub);
    assert_true(lb[0] == lb[1] && extent[0] == extent[1] && ub == lb[1] + extent[1]);
    MPI_Pack(memory, 1, a, out[0], 96, &at, MPI_COMM_WORLD), at = 0;
    MPI_Pack(memory, 1, b, out[1], 96, &at, MPI_COMM_WORLD);
    assert_memory_equal(out[0], out[1], (size_t)n[0]);
    MPI_Type_free(&a), MPI_Type_free(&b);
}

static void old_names(void *context)
{
    int lengths[] = {2, 1}, key, flag;
    MPI_Aint places[] = {16, 8}, here, there;
    MPI_Datatype types[] = {MPI_INT, MPI_FLOAT}, a, b;
    MPI_Errhandler h;
    void *v;
    (void)context;
    MPI_Type_create_hvector(2, 1, 12, MPI_INT, &a), MPI_Type_hvector(2, 1, 12, MPI_INT, &b);
    same_type(a, b);
    MPI_Type_create_hindexed(2, lengths, places, MPI_INT, &a);
    MPI_Type_hindexed(2, lengths, places, MPI_INT, &b);
    same_type(a, b);
    MPI_Type_create_struct(2, lengths, places, types, &a);
    MPI_Type_struct(2, lengths, places, types, &b);
    same_type(a, b);
    MPI_Get_address(&lengths[1], &here), MPI_Address(&lengths[0], &there);
    assert_int_equal(MPI_Aint_diff(here, there), sizeof(int));
    assert_int_equal(MPI_Aint_add(there, sizeof(int)), here);
    MPI_Keyval_create(MPI_DUP_FN, MPI_NULL_DELETE_FN, &key, NULL);
    MPI_Attr_put(MPI_COMM_WORLD, key, &flag);
    MPI_Attr_get(MPI_COMM_WORLD, key, &v, &flag);
    assert_true(flag && v == &flag);
    MPI_Attr_delete(MPI_COMM_WORLD, key);
    MPI_Attr_get(MPI_COMM_WORLD, key, &v, &flag);
    assert_false(flag);
    MPI_Keyval_free(&key);
    MPI_Errhandler_set(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Errhandler_get(MPI_COMM_WORLD, &h);
    assert_true(h == MPI_ERRORS_RETURN);
}

static void removed_names_do_as_their_successors(void **state)
{
    (void)state;
    mpi_ok(1, old_names, NULL);
}

/* --- statuses --- */

static void statuses(void *context)
{
    MPI_Request q = MPI_REQUEST_NULL;
    MPI_Status s;
    int n, flag, in, position = 0;
    (void)context;
    /* of nothing: empty */
    memset(&s, 7, sizeof s);
    MPI_Wait(&q, &s);
    assert_true(s.MPI_SOURCE == MPI_ANY_SOURCE && s.MPI_TAG == MPI_ANY_TAG);
    MPI_Get_count(&s, MPI_BYTE, &n);
    assert_int_equal(n, 0);
    MPI_Test_cancelled(&s, &flag);
    assert_false(flag);
    /* of a receive that nobody answers */
    MPI_Irecv(&in, 1, MPI_INT, 0, 9, MPI_COMM_SELF, &q);
    MPI_Cancel(&q);
    MPI_Wait(&q, &s);
    MPI_Test_cancelled(&s, &flag);
    assert_true(flag);
    MPI_Status_set_cancelled(&s, 0);
    MPI_Test_cancelled(&s, &flag);
    assert_false(flag);
    MPI_Status_set_cancelled(&s, 5);
    MPI_Test_cancelled(&s, &flag);
    assert_true(flag);
    /* of one that came */
    MPI_Sendrecv(&(int){3}, 1, MPI_INT, 0, 4, &in, 1, MPI_INT, 0, 4, MPI_COMM_SELF, &s);
    MPI_Test_cancelled(&s, &flag);
    assert_true(!flag && s.MPI_SOURCE == 0 && s.MPI_TAG == 4);
    /* from the first byte on, and of nothing */
    MPI_Unpack(&in, 4, &position, &n, 1, MPI_INT, MPI_COMM_SELF);
    assert_true(n == 3 && position == 4);
    MPI_Pack_size(0, MPI_INT, MPI_COMM_SELF, &n);
    assert_int_equal(n, 0);
}

static void statuses_tell_what_happened(void **state)
{
    (void)state;
    mpi_ok(1, statuses, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(handles_of_no_type_are_refused),
        cmocka_unit_test(removed_names_do_as_their_successors),
        cmocka_unit_test(statuses_tell_what_happened),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
