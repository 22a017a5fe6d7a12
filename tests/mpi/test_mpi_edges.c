/* test_mpi_edges.c - epochs without anybody, calls in the wrong order, and functions of attributes
 * that change what is attached. */
#include "mpi_world.h"

/* ---- epochs ---- */

/* Without anybody to expose to or to access an epoch is empty, and ends at once; in the wrong order
 * calls are refused, and nothing has changed. */
static void epochs(void *context)
{
    int memory[4] = {0}, one = 5, flag = 0;
    MPI_Win w;
    MPI_Group all, self, none = MPI_GROUP_EMPTY;
    const int me = own_rank();
    (void)context;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Win_create(memory, sizeof memory, sizeof(int), MPI_INFO_NULL, MPI_COMM_WORLD, &w);
    MPI_Win_set_errhandler(w, MPI_ERRORS_RETURN);
    assert_int_equal(MPI_Win_complete(w), MPI_ERR_RMA_SYNC);
    assert_int_equal(MPI_Win_wait(w), MPI_ERR_RMA_SYNC);
    assert_int_equal(MPI_Win_test(w, &flag), MPI_ERR_RMA_SYNC);
    assert_int_equal(MPI_Win_post(MPI_GROUP_NULL, 0, w), MPI_ERR_GROUP);
    assert_int_equal(MPI_Win_start(MPI_GROUP_NULL, 0, w), MPI_ERR_GROUP);
    assert_int_equal(MPI_Win_complete(w), MPI_ERR_RMA_SYNC);
    for (int round = 0; round < 3; round++) {
        assert_int_equal(MPI_Win_post(none, 0, w), MPI_SUCCESS);
        assert_int_equal(MPI_Win_post(none, 0, w), MPI_ERR_RMA_SYNC);
        assert_int_equal(MPI_Win_start(none, 0, w), MPI_SUCCESS);
        assert_int_equal(MPI_Win_start(none, 0, w), MPI_ERR_RMA_SYNC);
        assert_int_equal(MPI_Win_complete(w), MPI_SUCCESS);
        flag = 0;
        if (round % 2) assert_int_equal(MPI_Win_wait(w), MPI_SUCCESS);
        else assert_int_equal(MPI_Win_test(w, &flag), MPI_SUCCESS);
        assert_true(round % 2 || flag);
        /* the constant is not used up by windows that held it */
        MPI_Group_size(none, &flag);
        assert_int_equal(flag, 0);
    }
    /* with oneself; the group may be freed while the window has it */
    MPI_Comm_group(MPI_COMM_WORLD, &all);
    MPI_Group_incl(all, 1, &me, &self);
    MPI_Group_free(&all);
    MPI_Win_post(self, 0, w);
    MPI_Win_start(self, 0, w);
    MPI_Group_free(&self);
    MPI_Put(&one, 1, MPI_INT, me, 2, 1, MPI_INT, w);
    MPI_Win_complete(w);
    MPI_Win_wait(w);
    assert_int_equal(memory[2], 5);
    /* locks */
    assert_int_equal(MPI_Win_unlock(me, w), MPI_ERR_RMA_SYNC);
    assert_int_equal(MPI_Win_unlock_all(w), MPI_ERR_RMA_SYNC);
    assert_int_equal(MPI_Win_lock(77, me, 0, w), MPI_ERR_LOCKTYPE);
    assert_int_equal(MPI_Win_lock(MPI_LOCK_SHARED, all_ranks(), 0, w), MPI_ERR_RANK);
    assert_int_equal(MPI_Win_lock(MPI_LOCK_SHARED, -5, 0, w), MPI_ERR_RANK);
    assert_int_equal(MPI_Win_lock(MPI_LOCK_EXCLUSIVE, MPI_PROC_NULL, 0, w), MPI_SUCCESS);
    assert_int_equal(MPI_Win_unlock(MPI_PROC_NULL, w), MPI_SUCCESS);
    assert_int_equal(MPI_Win_lock(MPI_LOCK_SHARED, me, 0, w), MPI_SUCCESS);
    assert_int_equal(MPI_Win_lock(MPI_LOCK_SHARED, me, 0, w), MPI_ERR_RMA_SYNC);
    assert_int_equal(MPI_Win_unlock(me, w), MPI_SUCCESS);
    assert_int_equal(MPI_Win_lock_all(0, w), MPI_SUCCESS);
    assert_int_equal(MPI_Win_lock_all(0, w), MPI_ERR_RMA_SYNC);
    assert_int_equal(MPI_Win_unlock_all(w), MPI_SUCCESS);
    MPI_Win_free(&w);
}

static void empty_epochs_end_at_once_and_wrong_ones_are_refused(void **state)
{
    (void)state;
    mpi_ok(3, epochs, NULL);
}

/* An exposure ends when those who access have completed, not before: the one that exposes looks
 * before it lets the other begin. */
static void exposures(void *context)
{
    int memory = 0, one = 7, flag = 1, go = 0, looks = 0;
    const int me = own_rank(), peer = 1 - me;
    MPI_Win w;
    MPI_Group all, other;
    (void)context;
    MPI_Win_create(&memory, sizeof memory, sizeof memory, MPI_INFO_NULL, MPI_COMM_WORLD, &w);
    MPI_Comm_group(MPI_COMM_WORLD, &all);
    MPI_Group_incl(all, 1, &peer, &other);
    if (me == 0) {
        MPI_Win_post(other, 0, w);
        for (int i = 0; i < 3; i++) {
            MPI_Win_test(w, &flag);
            assert_false(flag);
        }
        MPI_Send(&go, 1, MPI_INT, 1, 0, MPI_COMM_WORLD);
        while (!flag) {
            MPI_Win_test(w, &flag);
            assert_true(looks++ < 100000);
        }
        assert_int_equal(memory, 7);
    } else {
        MPI_Recv(&go, 1, MPI_INT, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        MPI_Win_start(other, 0, w);
        MPI_Put(&one, 1, MPI_INT, 0, 0, 1, MPI_INT, w);
        MPI_Win_complete(w);
    }
    MPI_Group_free(&other);
    MPI_Group_free(&all);
    MPI_Win_free(&w);
}

static void an_exposure_ends_with_the_last_access(void **state)
{
    (void)state;
    mpi_ok(2, exposures, NULL);
}

/* No call takes a window that is none. */
static void no_window(void *context)
{
    int flag;
    MPI_Group all;
    (void)context;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Comm_set_errhandler(MPI_COMM_SELF, MPI_ERRORS_RETURN);
    MPI_Comm_group(MPI_COMM_WORLD, &all);
    const int code[] = {MPI_Win_fence(0, MPI_WIN_NULL),
                        MPI_Win_post(all, 0, MPI_WIN_NULL),
                        MPI_Win_start(all, 0, MPI_WIN_NULL),
                        MPI_Win_complete(MPI_WIN_NULL),
                        MPI_Win_wait(MPI_WIN_NULL),
                        MPI_Win_test(MPI_WIN_NULL, &flag),
                        MPI_Win_lock(MPI_LOCK_SHARED, 0, 0, MPI_WIN_NULL),
                        MPI_Win_unlock(0, MPI_WIN_NULL),
                        MPI_Win_lock_all(0, MPI_WIN_NULL),
                        MPI_Win_unlock_all(MPI_WIN_NULL),
                        MPI_Win_flush(0, MPI_WIN_NULL),
                        MPI_Win_flush_all(MPI_WIN_NULL),
                        MPI_Win_flush_local(0, MPI_WIN_NULL),
                        MPI_Win_flush_local_all(MPI_WIN_NULL),
                        MPI_Win_sync(MPI_WIN_NULL)};
    for (size_t i = 0; i < sizeof code / sizeof *code; i++) assert_int_equal(code[i], MPI_ERR_WIN);
    MPI_Group_free(&all);
}

static void no_call_takes_the_null_window(void **state)
{
    (void)state;
    mpi_ok(1, no_window, NULL);
}

/* ---- attributes ---- */

/* A copy function that changes what is attached to the communicator that is copied. */
static int busy_key, other_key;

static int copy_and_delete(MPI_Comm from, int key, void *extra, void *in, void *out, int *flag)
{
    (void)extra;
    *(void **)out = (char *)in + 1;
    *flag = 1;
    MPI_Comm_delete_attr(from, key);
    MPI_Comm_set_attr(from, other_key, (void *)80);
    return MPI_SUCCESS;
}

/* A delete function that attaches another value to the object that loses one. */
static int ndelete;
static int delete_and_set(MPI_Comm c, int key, void *value, void *extra)
{
    (void)key, (void)extra;
    if (ndelete++ == 0) MPI_Comm_set_attr(c, other_key, (char *)value + 1);
    return MPI_SUCCESS;
}

static void callbacks(void *context)
{
    MPI_Comm c, copy;
    void *v;
    int flag;
    (void)context;
    ndelete = 0;
    MPI_Comm_dup(MPI_COMM_WORLD, &c);
    MPI_Comm_create_keyval(copy_and_delete, MPI_COMM_NULL_DELETE_FN, &busy_key, NULL);
    MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, delete_and_set, &other_key, NULL);
    MPI_Comm_set_attr(c, busy_key, (void *)70);
    MPI_Comm_dup(c, &copy);
    MPI_Comm_get_attr(copy, busy_key, &v, &flag);
    assert_true(flag && (intptr_t)v == 71);
    MPI_Comm_get_attr(c, busy_key, &v, &flag);
    assert_false(flag);
    MPI_Comm_get_attr(c, other_key, &v, &flag);
    assert_true(flag && (intptr_t)v == 80);
    MPI_Comm_get_attr(copy, other_key, &v, &flag);
    assert_false(flag);
    /* deleted by a function that sets it anew: one value is there, and one more deletion takes it
     */
    MPI_Comm_delete_attr(c, other_key);
    MPI_Comm_get_attr(c, other_key, &v, &flag);
    assert_true(!flag || (intptr_t)v == 81);
    MPI_Comm_free(&copy);
    MPI_Comm_free(&c);
    assert_true(ndelete >= 1 && ndelete <= 3);
    MPI_Comm_free_keyval(&busy_key);
    MPI_Comm_free_keyval(&other_key);
}

static void callbacks_may_change_what_is_attached(void **state)
{
    (void)state;
    mpi_ok(1, callbacks, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(empty_epochs_end_at_once_and_wrong_ones_are_refused),
        cmocka_unit_test(an_exposure_ends_with_the_last_access),
        cmocka_unit_test(no_call_takes_the_null_window),
        cmocka_unit_test(callbacks_may_change_what_is_attached),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
