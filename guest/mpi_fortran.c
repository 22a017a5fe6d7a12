/* mpi_fortran.c - what of MPI differs in Fortran by more than its arguments' passing: indices count
 * from one, constants are variables, and older functions have addresses of four bytes. */
#include "mpi_fortran.h"

/* Aligned as the largest common block may be. */
#define SIGN int __attribute__((aligned(32)))
SIGN mimdsim_mpi_bottom_;
SIGN mimdsim_mpi_in_place_;
SIGN mimdsim_mpi_status_ignore_[8];
SIGN mimdsim_mpi_statuses_ignore_[8];
SIGN mimdsim_mpi_unweighted_[1];
SIGN mimdsim_mpi_weights_empty_[1];

#define HANDLE(type, p) ((type)(intptr_t) * (p))
#define BACK(p, handle) (*(p) = (MPI_Fint)(intptr_t)(handle))

void mpi_init_(MPI_Fint *ierror) { *ierror = MPI_Init(NULL, NULL); }
void mpi_init_thread_(int *required, int *provided, MPI_Fint *ierror)
{
    *ierror = MPI_Init_thread(NULL, NULL, *required, provided);
}
void mpi_pcontrol_(int *level) { MPI_Pcontrol(*level); }

MPI_Aint mpi_aint_add_(MPI_Aint *base, MPI_Aint *disp) { return *base + *disp; }
MPI_Aint mpi_aint_diff_(MPI_Aint *a, MPI_Aint *b) { return *a - *b; }

void mpi_buffer_detach_(void *buffer, int *size, MPI_Fint *ierror)
{
    void *was;
    (void)buffer;
    *ierror = MPI_Buffer_detach(&was, size);
}

void mpi_alloc_mem_(MPI_Aint *size, MPI_Fint *info, void *baseptr, MPI_Fint *ierror)
{
    *ierror = MPI_Alloc_mem(*size, HANDLE(MPI_Info, info), baseptr);
}
void mpi_free_mem_(void *base, MPI_Fint *ierror) { *ierror = MPI_Free_mem(base); }

/* --- completing some of many: places count from one --- */

static int from_one(int index) { return index == MPI_UNDEFINED ? index : index + 1; }

void mpi_waitany_(int *count, MPI_Fint *requests, int *index, MPI_Status *status, MPI_Fint *ierror)
{
    HANDLES_IN(MPI_Request, requests, *count);
    *ierror = MPI_Waitany(*count, requests_, index, status_of(status));
    HANDLES_OUT(requests, *count);
    *index = from_one(*index);
}

void mpi_testany_(int *count, MPI_Fint *requests, int *index, int *flag, MPI_Status *status,
                  MPI_Fint *ierror)
{
    HANDLES_IN(MPI_Request, requests, *count);
    *ierror = MPI_Testany(*count, requests_, index, flag, status_of(status));
    HANDLES_OUT(requests, *count);
    *index = from_one(*index);
}

void mpi_waitsome_(int *count, MPI_Fint *requests, int *found, int *indices, MPI_Status *statuses,
                   MPI_Fint *ierror)
{
    HANDLES_IN(MPI_Request, requests, *count);
    *ierror = MPI_Waitsome(*count, requests_, found, indices, status_of(statuses));
    HANDLES_OUT(requests, *count);
    for (int i = 0; i < *found; i++) indices[i] = from_one(indices[i]);
}

void mpi_testsome_(int *count, MPI_Fint *requests, int *found, int *indices, MPI_Status *statuses,
                   MPI_Fint *ierror)
{
    HANDLES_IN(MPI_Request, requests, *count);
    *ierror = MPI_Testsome(*count, requests_, found, indices, status_of(statuses));
    HANDLES_OUT(requests, *count);
    for (int i = 0; i < *found; i++) indices[i] = from_one(indices[i]);
}

/* --- types --- */

void mpi_type_get_contents_(MPI_Fint *datatype, int *max_integers, int *max_addresses,
                            int *max_datatypes, int *integers, MPI_Aint *addresses,
                            MPI_Fint *datatypes, MPI_Fint *ierror)
{
    MPI_Datatype types_[*max_datatypes > 0 ? *max_datatypes : 1];
    int integers_n, addresses_n, types_n = 0, combiner;
    MPI_Type_get_envelope(HANDLE(MPI_Datatype, datatype), &integers_n, &addresses_n, &types_n,
                          &combiner);
    *ierror = MPI_Type_get_contents(HANDLE(MPI_Datatype, datatype), *max_integers, *max_addresses,
                                    *max_datatypes, integers, addresses, types_);
    for (int i = 0; i < types_n && i < *max_datatypes; i++) BACK(&datatypes[i], types_[i]);
}

/* Addresses of four bytes, of before MPI-2: relative to MPI_BOTTOM they would not fit, so they are
 * counted from it as a program's variables are, and only differences of them are of use. */
void mpi_address_(void *location, int *address, MPI_Fint *ierror)
{
    *address = (int)((char *)location - (char *)&mimdsim_mpi_bottom_);
    *ierror = MPI_SUCCESS;
}

#define BOUND(name, function)                                                                      \
    void name(MPI_Fint *datatype, int *out, MPI_Fint *ierror)                                      \
    {                                                                                              \
        MPI_Aint x = 0;                                                                            \
        *ierror = function(HANDLE(MPI_Datatype, datatype), &x);                                    \
        *out = (int)x;                                                                             \
    }
BOUND(mpi_type_extent_, MPI_Type_extent)
BOUND(mpi_type_lb_, MPI_Type_lb)
BOUND(mpi_type_ub_, MPI_Type_ub)

void mpi_type_hvector_(int *count, int *length, int *stride, MPI_Fint *oldtype, MPI_Fint *newtype,
                       MPI_Fint *ierror)
{
    MPI_Datatype made = MPI_DATATYPE_NULL;
    *ierror =
        MPI_Type_create_hvector(*count, *length, *stride, HANDLE(MPI_Datatype, oldtype), &made);
    BACK(newtype, made);
}

void mpi_type_hindexed_(int *count, int *lengths, int *places, MPI_Fint *oldtype, MPI_Fint *newtype,
                        MPI_Fint *ierror)
{
    MPI_Datatype made = MPI_DATATYPE_NULL;
    MPI_Aint wide[*count > 0 ? *count : 1];
    for (int i = 0; i < *count; i++) wide[i] = places[i];
    *ierror = MPI_Type_create_hindexed(*count, lengths, wide, HANDLE(MPI_Datatype, oldtype), &made);
    BACK(newtype, made);
}

void mpi_type_struct_(int *count, int *lengths, int *places, MPI_Fint *types, MPI_Fint *newtype,
                      MPI_Fint *ierror)
{
    MPI_Datatype made = MPI_DATATYPE_NULL;
    MPI_Aint wide[*count > 0 ? *count : 1];
    HANDLES_IN(MPI_Datatype, types, *count);
    for (int i = 0; i < *count; i++) wide[i] = places[i];
    *ierror = MPI_Type_create_struct(*count, lengths, wide, types_, &made);
    BACK(newtype, made);
}

/* --- graphs: the signs for no weights --- */

void mpi_dist_graph_create_(MPI_Fint *old, int *n, int *sources, int *degrees, int *destinations,
                            int *weights, MPI_Fint *info, int *reorder, MPI_Fint *graph,
                            MPI_Fint *ierror)
{
    MPI_Comm made = MPI_COMM_NULL;
    *ierror = MPI_Dist_graph_create(HANDLE(MPI_Comm, old), *n, sources, degrees, destinations,
                                    weights_of(weights), HANDLE(MPI_Info, info), *reorder, &made);
    BACK(graph, made);
}

void mpi_dist_graph_create_adjacent_(MPI_Fint *old, int *nin, int *sources, int *in_weights,
                                     int *nout, int *destinations, int *out_weights, MPI_Fint *info,
                                     int *reorder, MPI_Fint *graph, MPI_Fint *ierror)
{
    MPI_Comm made = MPI_COMM_NULL;
    *ierror = MPI_Dist_graph_create_adjacent(
        HANDLE(MPI_Comm, old), *nin, sources, weights_of(in_weights), *nout, destinations,
        weights_of(out_weights), HANDLE(MPI_Info, info), *reorder, &made);
    BACK(graph, made);
}

void mpi_dist_graph_neighbors_(MPI_Fint *comm, int *nin, int *sources, int *in_weights, int *nout,
                               int *destinations, int *out_weights, MPI_Fint *ierror)
{
    *ierror =
        MPI_Dist_graph_neighbors(HANDLE(MPI_Comm, comm), *nin, sources, weights_of(in_weights),
                                 *nout, destinations, weights_of(out_weights));
}

/* --- attributes: values are integers of an address's size; of the old functions, of four bytes ---
 */

/* Functions that a program names and that are never called. */
void mpi_null_copy_fn_(void) {}
void mpi_dup_fn_(void) {}
void mpi_null_delete_fn_(void) {}
void mpi_comm_null_copy_fn_(void) __attribute__((alias("mpi_null_copy_fn_")));
void mpi_comm_dup_fn_(void) __attribute__((alias("mpi_dup_fn_")));
void mpi_comm_null_delete_fn_(void) __attribute__((alias("mpi_null_delete_fn_")));
void mpi_type_null_copy_fn_(void) __attribute__((alias("mpi_null_copy_fn_")));
void mpi_type_dup_fn_(void) __attribute__((alias("mpi_dup_fn_")));
void mpi_type_null_delete_fn_(void) __attribute__((alias("mpi_null_delete_fn_")));

typedef void function(void);

void mpi_comm_create_keyval_(function *copy, function *remove, int *keyval, void *extra,
                             MPI_Fint *ierror)
{
    (void)extra;
    if ((copy != mpi_null_copy_fn_ && copy != mpi_dup_fn_) || remove != mpi_null_delete_fn_)
        mimdsim_mpi_refuse("MPI_Comm_create_keyval", "functions of Fortran for attributes",
                           __builtin_return_address(0));
    *ierror = MPI_Comm_create_keyval(copy == mpi_dup_fn_ ? MPI_COMM_DUP_FN : MPI_COMM_NULL_COPY_FN,
                                     MPI_COMM_NULL_DELETE_FN, keyval, NULL);
}
void mpi_keyval_create_(function *, function *, int *, void *, MPI_Fint *)
    __attribute__((alias("mpi_comm_create_keyval_")));

void mpi_comm_set_attr_(MPI_Fint *comm, int *keyval, MPI_Aint *value, MPI_Fint *ierror)
{
    *ierror = MPI_Comm_set_attr(HANDLE(MPI_Comm, comm), *keyval, (void *)*value);
}
void mpi_attr_put_(MPI_Fint *comm, int *keyval, int *value, MPI_Fint *ierror)
{
    *ierror = MPI_Comm_set_attr(HANDLE(MPI_Comm, comm), *keyval, (void *)(intptr_t)*value);
}

/* The standard's own attributes are integers that C gets the address of. */
void mpi_comm_get_attr_(MPI_Fint *comm, int *keyval, MPI_Aint *value, int *flag, MPI_Fint *ierror)
{
    void *got = NULL;
    *ierror = MPI_Comm_get_attr(HANDLE(MPI_Comm, comm), *keyval, &got, flag);
    if (!*flag) return;
    *value = *keyval >= MPI_TAG_UB && *keyval <= MPI_UNIVERSE_SIZE ? *(int *)got : (MPI_Aint)got;
}
void mpi_attr_get_(MPI_Fint *comm, int *keyval, int *value, int *flag, MPI_Fint *ierror)
{
    MPI_Aint wide = 0;
    mpi_comm_get_attr_(comm, keyval, &wide, flag, ierror);
    if (*flag) *value = (int)wide;
}

/* --- info --- */

void mpi_info_get_(MPI_Fint *info, const char *key, int *valuelen, char *value, int *flag,
                   MPI_Fint *ierror, size_t key_length, size_t value_length)
{
    char got[MPI_MAX_INFO_VAL + 1];
    (void)valuelen;
    TEXT_IN(key, key_length);
    *ierror = MPI_Info_get(HANDLE(MPI_Info, info), key_, MPI_MAX_INFO_VAL, got, flag);
    if (*flag) text_out(value, value_length, got);
}
