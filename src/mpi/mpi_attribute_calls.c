/* mpi_attribute_calls.c - the functions of keyvals and attributes. */
#include "mpi/mpi_window.h"

/* The four pairs differ in the types of their functions alone, which the standard gives
 * for each kind of object (sections 7.7.2 to 7.7.4); MPI_Keyval_create is the deprecated
 * name of the first. */
#define KEYVALS(create_name, free_name, copy_type, delete_type, a, b, c)                           \
    int create_name(struct mpi_rank *self, copy_type *a, delete_type *b, int *c,                   \
                    void *extra_state)                                                             \
    {                                                                                              \
        return mpi_keyval_make(self, (void *)(intptr_t)a, (void *)(intptr_t)b, c, extra_state);    \
    }                                                                                              \
    int free_name(struct mpi_rank *self, int *c) { return mpi_keyval_end(self, c); }
KEYVALS(mpi_comm_create_keyval, mpi_comm_free_keyval, MPI_Comm_copy_attr_function,
        MPI_Comm_delete_attr_function, comm_copy_attr_fn, comm_delete_attr_fn, comm_keyval)
KEYVALS(mpi_type_create_keyval, mpi_type_free_keyval, MPI_Type_copy_attr_function,
        MPI_Type_delete_attr_function, type_copy_attr_fn, type_delete_attr_fn, type_keyval)
KEYVALS(mpi_win_create_keyval, mpi_win_free_keyval, MPI_Win_copy_attr_function,
        MPI_Win_delete_attr_function, win_copy_attr_fn, win_delete_attr_fn, win_keyval)
KEYVALS(mpi_keyval_create, mpi_keyval_free, MPI_Copy_function, MPI_Delete_function, copy_fn,
        delete_fn, keyval)

/* --- communicators; the standard's own attributes are pointers to integers --- */

int mpi_comm_set_attr(struct mpi_rank *self, MPI_Comm comm, int comm_keyval, void *attribute_val)
{
    return mpi_attribute_set(self, KIND_COMM, mpi_comm_of(self, comm), comm_keyval, attribute_val);
}

/* Section 9.1.2 asks for pointers to integers that the program must not change, so these
 * stand in constants, or in the rank's state where they differ between runs. */
int mpi_comm_get_attr(struct mpi_rank *self, MPI_Comm comm, int comm_keyval, void *attribute_val,
                      int *flag)
{
    static const int tag_last = TAG_LAST, none = MPI_PROC_NULL, yes = 1, zero = 0;
    struct mpi_comm *c = mpi_comm_of(self, comm);
    const int *fixed = NULL;
    if (!c) return self->code;
    /* MPI_LASTUSEDCODE moves when the program adds codes: it is brought up to date at
     * each look. */
    self->last_code = mpi_last_code(self);
    if (comm_keyval == MPI_TAG_UB) fixed = &tag_last;
    if (comm_keyval == MPI_IO || comm_keyval == MPI_HOST) fixed = &none;
    if (comm_keyval == MPI_WTIME_IS_GLOBAL) fixed = &yes;
    if (comm_keyval == MPI_APPNUM) fixed = &zero;
    if (comm_keyval == MPI_UNIVERSE_SIZE) fixed = &self->size;
    if (comm_keyval == MPI_LASTUSEDCODE) fixed = &self->last_code;
    if (!fixed) return mpi_attribute_get(self, KIND_COMM, c, comm_keyval, attribute_val, flag);
    /* Attributes of the standard cannot be set or deleted: they never reach the list of
     * values. */
    *flag = 1;
    *(const void **)attribute_val = fixed;
    return MPI_SUCCESS;
}

int mpi_comm_delete_attr(struct mpi_rank *self, MPI_Comm comm, int comm_keyval)
{
    return mpi_attribute_delete(self, KIND_COMM, mpi_comm_of(self, comm), comm_keyval);
}

/* Deprecated since MPI 2.0 under these names; old programs still use them. */
int mpi_attr_put(struct mpi_rank *self, MPI_Comm comm, int keyval, void *attribute_val)
{
    return mpi_comm_set_attr(self, comm, keyval, attribute_val);
}

int mpi_attr_get(struct mpi_rank *self, MPI_Comm comm, int keyval, void *attribute_val, int *flag)
{
    return mpi_comm_get_attr(self, comm, keyval, attribute_val, flag);
}

int mpi_attr_delete(struct mpi_rank *self, MPI_Comm comm, int keyval)
{
    return mpi_comm_delete_attr(self, comm, keyval);
}

/* --- types --- */

int mpi_type_set_attr(struct mpi_rank *self, MPI_Datatype datatype, int type_keyval,
                      void *attribute_val)
{
    return mpi_attribute_set(self, KIND_TYPE, mpi_type_of(self, datatype), type_keyval,
                             attribute_val);
}

int mpi_type_get_attr(struct mpi_rank *self, MPI_Datatype datatype, int type_keyval,
                      void *attribute_val, int *flag)
{
    return mpi_attribute_get(self, KIND_TYPE, mpi_type_of(self, datatype), type_keyval,
                             attribute_val, flag);
}

int mpi_type_delete_attr(struct mpi_rank *self, MPI_Datatype datatype, int type_keyval)
{
    return mpi_attribute_delete(self, KIND_TYPE, mpi_type_of(self, datatype), type_keyval);
}

/* --- windows: their own attributes are in mpi_window.c --- */

int mpi_win_set_attr(struct mpi_rank *self, MPI_Win win, int win_keyval, void *attribute_val)
{
    return mpi_attribute_set(self, KIND_WIN, mpi_window_of(self, win), win_keyval, attribute_val);
}

/* The window's own attributes first: MPI_WIN_BASE is the address itself, the others are
 * pointers (section 12.2.6). */
int mpi_win_get_attr(struct mpi_rank *self, MPI_Win win, int win_keyval, void *attribute_val,
                     int *flag)
{
    struct mpi_window *w = mpi_window_of(self, win);
    if (!w) return self->code;
    if (mpi_window_attribute(w, win_keyval, attribute_val)) {
        *flag = 1;
        return MPI_SUCCESS;
    }
    return mpi_attribute_get(self, KIND_WIN, w, win_keyval, attribute_val, flag);
}

int mpi_win_delete_attr(struct mpi_rank *self, MPI_Win win, int win_keyval)
{
    return mpi_attribute_delete(self, KIND_WIN, mpi_window_of(self, win), win_keyval);
}
