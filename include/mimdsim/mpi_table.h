/* mpi_table.h - how the functions of MPI are called across the border between a program and the
 * simulator. Made by src/mpi/generate.awk. */
#ifndef MIMDSIM_MPI_TABLE_H
#define MIMDSIM_MPI_TABLE_H

#include "mpi.h"

struct mpi_rank;

/* Counts or displacements of either size. */
struct mpi_counts {
    const void *at;
    int large; /* MPI_Count instead of int */
};

/* How an operation is started; `request` where it is not blocking. */
enum mpi_start_mode { MPI_BLOCKING, MPI_NON_BLOCKING, MPI_PERSISTENT };
struct mpi_start {
    enum mpi_start_mode mode;
    MPI_Request *request;
};

struct mpi_functions {
    int size; /* of this struct: another size is another version */

    /* Before each call: its name, the program's address, whether it may come outside of Init and
     * Finalize; after the computing time since the last call was accounted for. */
    void (*enter)(struct mpi_rank *self, const char *call, const void *address, int anytime);

    /* For functions that are not there; does not return. */
    void (*refuse)(struct mpi_rank *self, const char *call, const char *reason);

    int (*init)(struct mpi_rank *self, int *argc, char ***argv);
    int (*init_thread)(struct mpi_rank *self, int *argc, char ***argv, int required,
    int *provided);
    int (*initialized)(struct mpi_rank *self, int *flag);
    int (*finalize)(struct mpi_rank *self);
    int (*finalized)(struct mpi_rank *self, int *flag);
    int (*abort)(struct mpi_rank *self, MPI_Comm comm, int errorcode);
    int (*query_thread)(struct mpi_rank *self, int *provided);
    int (*is_thread_main)(struct mpi_rank *self, int *flag);
    int (*get_processor_name)(struct mpi_rank *self, char *name, int *resultlen);
    int (*get_version)(struct mpi_rank *self, int *version, int *subversion);
    int (*get_library_version)(struct mpi_rank *self, char *version, int *resultlen);
    int (*pcontrol)(struct mpi_rank *self, const int level);
    int (*send)(struct mpi_rank *self, struct mpi_start start, const void *buf, MPI_Count count,
    MPI_Datatype datatype, int dest, int tag, MPI_Comm comm);
    int (*bsend)(struct mpi_rank *self, struct mpi_start start, const void *buf, MPI_Count count,
    MPI_Datatype datatype, int dest, int tag, MPI_Comm comm);
    int (*ssend)(struct mpi_rank *self, struct mpi_start start, const void *buf, MPI_Count count,
    MPI_Datatype datatype, int dest, int tag, MPI_Comm comm);
    int (*rsend)(struct mpi_rank *self, struct mpi_start start, const void *buf, MPI_Count count,
    MPI_Datatype datatype, int dest, int tag, MPI_Comm comm);
    int (*recv)(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype,
    int source, int tag, MPI_Comm comm, MPI_Status *status);
    int (*irecv)(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype,
    int source, int tag, MPI_Comm comm, MPI_Request *request);
    int (*recv_init)(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype,
    int source, int tag, MPI_Comm comm, MPI_Request *request);
    int (*sendrecv)(struct mpi_rank *self, const void *sendbuf, MPI_Count sendcount,
    MPI_Datatype sendtype, int dest, int sendtag, void *recvbuf, MPI_Count recvcount,
    MPI_Datatype recvtype, int source, int recvtag, MPI_Comm comm, MPI_Status *status);
    int (*isendrecv)(struct mpi_rank *self, const void *sendbuf, MPI_Count sendcount,
    MPI_Datatype sendtype, int dest, int sendtag, void *recvbuf, MPI_Count recvcount,
    MPI_Datatype recvtype, int source, int recvtag, MPI_Comm comm, MPI_Request *request);
    int (*sendrecv_replace)(struct mpi_rank *self, void *buf, MPI_Count count,
    MPI_Datatype datatype, int dest, int sendtag, int source, int recvtag, MPI_Comm comm,
    MPI_Status *status);
    int (*isendrecv_replace)(struct mpi_rank *self, void *buf, MPI_Count count,
    MPI_Datatype datatype, int dest, int sendtag, int source, int recvtag, MPI_Comm comm,
    MPI_Request *request);
    int (*buffer_attach)(struct mpi_rank *self, void *buffer, MPI_Count size);
    int (*buffer_detach)(struct mpi_rank *self, void *buffer_addr, MPI_Count *size);
    int (*buffer_flush)(struct mpi_rank *self);
    int (*buffer_iflush)(struct mpi_rank *self, MPI_Request *request);
    int (*comm_attach_buffer)(struct mpi_rank *self, MPI_Comm comm, void *buffer,
    MPI_Count size);
    int (*comm_detach_buffer)(struct mpi_rank *self, MPI_Comm comm, void *buffer_addr,
    MPI_Count *size);
    int (*comm_flush_buffer)(struct mpi_rank *self, MPI_Comm comm);
    int (*comm_iflush_buffer)(struct mpi_rank *self, MPI_Comm comm, MPI_Request *request);
    int (*probe)(struct mpi_rank *self, int source, int tag, MPI_Comm comm, MPI_Status *status);
    int (*iprobe)(struct mpi_rank *self, int source, int tag, MPI_Comm comm, int *flag,
    MPI_Status *status);
    int (*mprobe)(struct mpi_rank *self, int source, int tag, MPI_Comm comm,
    MPI_Message *message, MPI_Status *status);
    int (*improbe)(struct mpi_rank *self, int source, int tag, MPI_Comm comm, int *flag,
    MPI_Message *message, MPI_Status *status);
    int (*mrecv)(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype,
    MPI_Message *message, MPI_Status *status);
    int (*imrecv)(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype,
    MPI_Message *message, MPI_Request *request);
    int (*wait)(struct mpi_rank *self, MPI_Request *request, MPI_Status *status);
    int (*waitall)(struct mpi_rank *self, int count, MPI_Request array_of_requests[],
    MPI_Status *array_of_statuses);
    int (*waitany)(struct mpi_rank *self, int count, MPI_Request array_of_requests[], int *indx,
    MPI_Status *status);
    int (*waitsome)(struct mpi_rank *self, int incount, MPI_Request array_of_requests[],
    int *outcount, int array_of_indices[], MPI_Status *array_of_statuses);
    int (*test)(struct mpi_rank *self, MPI_Request *request, int *flag, MPI_Status *status);
    int (*testall)(struct mpi_rank *self, int count, MPI_Request array_of_requests[], int *flag,
    MPI_Status *array_of_statuses);
    int (*testany)(struct mpi_rank *self, int count, MPI_Request array_of_requests[], int *indx,
    int *flag, MPI_Status *status);
    int (*testsome)(struct mpi_rank *self, int incount, MPI_Request array_of_requests[],
    int *outcount, int array_of_indices[], MPI_Status *array_of_statuses);
    int (*start)(struct mpi_rank *self, MPI_Request *request);
    int (*startall)(struct mpi_rank *self, int count, MPI_Request array_of_requests[]);
    int (*request_free)(struct mpi_rank *self, MPI_Request *request);
    int (*request_get_status)(struct mpi_rank *self, MPI_Request request, int *flag,
    MPI_Status *status);
    int (*request_get_status_all)(struct mpi_rank *self, int count,
    const MPI_Request array_of_requests[], int *flag, MPI_Status *array_of_statuses);
    int (*request_get_status_any)(struct mpi_rank *self, int count,
    const MPI_Request array_of_requests[], int *indx, int *flag, MPI_Status *status);
    int (*request_get_status_some)(struct mpi_rank *self, int incount,
    const MPI_Request array_of_requests[], int *outcount, int array_of_indices[],
    MPI_Status *array_of_statuses);
    int (*cancel)(struct mpi_rank *self, MPI_Request *request);
    int (*test_cancelled)(struct mpi_rank *self, const MPI_Status *status, int *flag);
    int (*grequest_start)(struct mpi_rank *self, MPI_Grequest_query_function *query_fn,
    MPI_Grequest_free_function *free_fn, MPI_Grequest_cancel_function *cancel_fn,
    void *extra_state, MPI_Request *request);
    int (*grequest_complete)(struct mpi_rank *self, MPI_Request request);
    int (*get_count)(struct mpi_rank *self, const MPI_Status *status, MPI_Datatype datatype,
    MPI_Count *count);
    int (*get_elements)(struct mpi_rank *self, const MPI_Status *status, MPI_Datatype datatype,
    MPI_Count *count);
    int (*get_elements_x)(struct mpi_rank *self, const MPI_Status *status, MPI_Datatype datatype,
    MPI_Count *count);
    int (*status_set_elements)(struct mpi_rank *self, MPI_Status *status, MPI_Datatype datatype,
    MPI_Count count);
    int (*status_set_elements_x)(struct mpi_rank *self, MPI_Status *status,
    MPI_Datatype datatype, MPI_Count count);
    int (*status_set_cancelled)(struct mpi_rank *self, MPI_Status *status, int flag);
    int (*status_get_error)(struct mpi_rank *self, const MPI_Status *status, int *error);
    int (*status_get_source)(struct mpi_rank *self, const MPI_Status *status, int *source);
    int (*status_get_tag)(struct mpi_rank *self, const MPI_Status *status, int *tag);
    int (*status_set_error)(struct mpi_rank *self, MPI_Status *status, int error);
    int (*status_set_source)(struct mpi_rank *self, MPI_Status *status, int source);
    int (*status_set_tag)(struct mpi_rank *self, MPI_Status *status, int tag);
    int (*barrier)(struct mpi_rank *self, struct mpi_start start, MPI_Comm comm);
    int (*bcast)(struct mpi_rank *self, struct mpi_start start, void *buffer, MPI_Count count,
    MPI_Datatype datatype, int root, MPI_Comm comm);
    int (*gather)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount,
    MPI_Datatype recvtype, int root, MPI_Comm comm);
    int (*gatherv)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, struct mpi_counts recvcounts,
    struct mpi_counts displs, MPI_Datatype recvtype, int root, MPI_Comm comm);
    int (*scatter)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount,
    MPI_Datatype recvtype, int root, MPI_Comm comm);
    int (*scatterv)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    struct mpi_counts sendcounts, struct mpi_counts displs, MPI_Datatype sendtype, void *recvbuf,
    MPI_Count recvcount, MPI_Datatype recvtype, int root, MPI_Comm comm);
    int (*allgather)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount,
    MPI_Datatype recvtype, MPI_Comm comm);
    int (*allgatherv)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, struct mpi_counts recvcounts,
    struct mpi_counts displs, MPI_Datatype recvtype, MPI_Comm comm);
    int (*alltoall)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount,
    MPI_Datatype recvtype, MPI_Comm comm);
    int (*alltoallv)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    struct mpi_counts sendcounts, struct mpi_counts sdispls, MPI_Datatype sendtype,
    void *recvbuf, struct mpi_counts recvcounts, struct mpi_counts rdispls,
    MPI_Datatype recvtype, MPI_Comm comm);
    int (*alltoallw)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    struct mpi_counts sendcounts, struct mpi_counts sdispls, const MPI_Datatype sendtypes[],
    void *recvbuf, struct mpi_counts recvcounts, struct mpi_counts rdispls,
    const MPI_Datatype recvtypes[], MPI_Comm comm);
    int (*reduce)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    void *recvbuf, MPI_Count count, MPI_Datatype datatype, MPI_Op op, int root, MPI_Comm comm);
    int (*allreduce)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    void *recvbuf, MPI_Count count, MPI_Datatype datatype, MPI_Op op, MPI_Comm comm);
    int (*reduce_scatter)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    void *recvbuf, struct mpi_counts recvcounts, MPI_Datatype datatype, MPI_Op op,
    MPI_Comm comm);
    int (*reduce_scatter_block)(struct mpi_rank *self, struct mpi_start start,
    const void *sendbuf, void *recvbuf, MPI_Count recvcount, MPI_Datatype datatype, MPI_Op op,
    MPI_Comm comm);
    int (*scan)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    void *recvbuf, MPI_Count count, MPI_Datatype datatype, MPI_Op op, MPI_Comm comm);
    int (*exscan)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    void *recvbuf, MPI_Count count, MPI_Datatype datatype, MPI_Op op, MPI_Comm comm);
    int (*reduce_local)(struct mpi_rank *self, const void *inbuf, void *inoutbuf,
    MPI_Count count, MPI_Datatype datatype, MPI_Op op);
    int (*op_create)(struct mpi_rank *self, MPI_User_function *user_fn, int commute,
    MPI_Op *op);
    int (*op_create_c)(struct mpi_rank *self, MPI_User_function_c *user_fn, int commute,
    MPI_Op *op);
    int (*op_free)(struct mpi_rank *self, MPI_Op *op);
    int (*op_commutative)(struct mpi_rank *self, MPI_Op op, int *commute);
    int (*neighbor_allgather)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount,
    MPI_Datatype recvtype, MPI_Comm comm);
    int (*neighbor_allgatherv)(struct mpi_rank *self, struct mpi_start start,
    const void *sendbuf, MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf,
    struct mpi_counts recvcounts, struct mpi_counts displs, MPI_Datatype recvtype,
    MPI_Comm comm);
    int (*neighbor_alltoall)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount,
    MPI_Datatype recvtype, MPI_Comm comm);
    int (*neighbor_alltoallv)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    struct mpi_counts sendcounts, struct mpi_counts sdispls, MPI_Datatype sendtype,
    void *recvbuf, struct mpi_counts recvcounts, struct mpi_counts rdispls,
    MPI_Datatype recvtype, MPI_Comm comm);
    int (*neighbor_alltoallw)(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
    struct mpi_counts sendcounts, const MPI_Aint sdispls[], const MPI_Datatype sendtypes[],
    void *recvbuf, struct mpi_counts recvcounts, const MPI_Aint rdispls[],
    const MPI_Datatype recvtypes[], MPI_Comm comm);
    int (*type_contiguous)(struct mpi_rank *self, MPI_Count count, MPI_Datatype oldtype,
    MPI_Datatype *newtype);
    int (*type_vector)(struct mpi_rank *self, MPI_Count count, MPI_Count blocklength,
    MPI_Count stride, MPI_Datatype oldtype, MPI_Datatype *newtype);
    int (*type_create_hvector)(struct mpi_rank *self, MPI_Count count, MPI_Count blocklength,
    MPI_Count stride, MPI_Datatype oldtype, MPI_Datatype *newtype);
    int (*type_indexed)(struct mpi_rank *self, MPI_Count count,
    struct mpi_counts array_of_blocklengths, struct mpi_counts array_of_displacements,
    MPI_Datatype oldtype, MPI_Datatype *newtype);
    int (*type_create_hindexed)(struct mpi_rank *self, MPI_Count count,
    struct mpi_counts array_of_blocklengths, const MPI_Count array_of_displacements[],
    MPI_Datatype oldtype, MPI_Datatype *newtype);
    int (*type_create_indexed_block)(struct mpi_rank *self, MPI_Count count,
    MPI_Count blocklength, struct mpi_counts array_of_displacements, MPI_Datatype oldtype,
    MPI_Datatype *newtype);
    int (*type_create_hindexed_block)(struct mpi_rank *self, MPI_Count count,
    MPI_Count blocklength, const MPI_Count array_of_displacements[], MPI_Datatype oldtype,
    MPI_Datatype *newtype);
    int (*type_create_struct)(struct mpi_rank *self, MPI_Count count,
    struct mpi_counts array_of_blocklengths, const MPI_Count array_of_displacements[],
    const MPI_Datatype array_of_types[], MPI_Datatype *newtype);
    int (*type_create_subarray)(struct mpi_rank *self, int ndims,
    struct mpi_counts array_of_sizes, struct mpi_counts array_of_subsizes,
    struct mpi_counts array_of_starts, int order, MPI_Datatype oldtype, MPI_Datatype *newtype);
    int (*type_create_darray)(struct mpi_rank *self, int size, int rank, int ndims,
    struct mpi_counts array_of_gsizes, const int array_of_distribs[], const int array_of_dargs[],
    const int array_of_psizes[], int order, MPI_Datatype oldtype, MPI_Datatype *newtype);
    int (*type_create_resized)(struct mpi_rank *self, MPI_Datatype oldtype, MPI_Count lb,
    MPI_Count extent, MPI_Datatype *newtype);
    int (*type_create_f90_real)(struct mpi_rank *self, int p, int r, MPI_Datatype *newtype);
    int (*type_create_f90_complex)(struct mpi_rank *self, int p, int r, MPI_Datatype *newtype);
    int (*type_create_f90_integer)(struct mpi_rank *self, int r, MPI_Datatype *newtype);
    int (*type_match_size)(struct mpi_rank *self, int typeclass, int size,
    MPI_Datatype *datatype);
    int (*type_get_value_index)(struct mpi_rank *self, MPI_Datatype value_type,
    MPI_Datatype index_type, MPI_Datatype *pair_type);
    int (*type_dup)(struct mpi_rank *self, MPI_Datatype oldtype, MPI_Datatype *newtype);
    int (*type_commit)(struct mpi_rank *self, MPI_Datatype *datatype);
    int (*type_free)(struct mpi_rank *self, MPI_Datatype *datatype);
    int (*type_size)(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *size);
    int (*type_size_x)(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *size);
    int (*type_get_extent)(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *lb,
    MPI_Count *extent);
    int (*type_get_extent_x)(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *lb,
    MPI_Count *extent);
    int (*type_get_true_extent)(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *true_lb,
    MPI_Count *true_extent);
    int (*type_get_true_extent_x)(struct mpi_rank *self, MPI_Datatype datatype,
    MPI_Count *true_lb, MPI_Count *true_extent);
    int (*type_get_envelope)(struct mpi_rank *self, MPI_Datatype datatype, int *num_integers,
    int *num_addresses, int *num_datatypes, int *combiner);
    int (*type_get_contents)(struct mpi_rank *self, MPI_Datatype datatype, int max_integers,
    int max_addresses, int max_datatypes, int array_of_integers[], MPI_Aint array_of_addresses[],
    MPI_Datatype array_of_datatypes[]);
    int (*type_get_name)(struct mpi_rank *self, MPI_Datatype datatype, char *type_name,
    int *resultlen);
    int (*type_set_name)(struct mpi_rank *self, MPI_Datatype datatype, const char *type_name);
    int (*pack)(struct mpi_rank *self, const void *inbuf, MPI_Count incount,
    MPI_Datatype datatype, void *outbuf, MPI_Count outsize, MPI_Count *position, MPI_Comm comm);
    int (*unpack)(struct mpi_rank *self, const void *inbuf, MPI_Count insize,
    MPI_Count *position, void *outbuf, MPI_Count outcount, MPI_Datatype datatype,
    MPI_Comm comm);
    int (*pack_size)(struct mpi_rank *self, MPI_Count incount, MPI_Datatype datatype,
    MPI_Comm comm, MPI_Count *size);
    int (*get_address)(struct mpi_rank *self, const void *location, MPI_Aint *address);
    int (*alloc_mem)(struct mpi_rank *self, MPI_Aint size, MPI_Info info, void *baseptr);
    int (*free_mem)(struct mpi_rank *self, void *base);
    int (*group_size)(struct mpi_rank *self, MPI_Group group, int *size);
    int (*group_rank)(struct mpi_rank *self, MPI_Group group, int *rank);
    int (*group_translate_ranks)(struct mpi_rank *self, MPI_Group group1, int n,
    const int ranks1[], MPI_Group group2, int ranks2[]);
    int (*group_compare)(struct mpi_rank *self, MPI_Group group1, MPI_Group group2,
    int *result);
    int (*group_union)(struct mpi_rank *self, MPI_Group group1, MPI_Group group2,
    MPI_Group *newgroup);
    int (*group_intersection)(struct mpi_rank *self, MPI_Group group1, MPI_Group group2,
    MPI_Group *newgroup);
    int (*group_difference)(struct mpi_rank *self, MPI_Group group1, MPI_Group group2,
    MPI_Group *newgroup);
    int (*group_incl)(struct mpi_rank *self, MPI_Group group, int n, const int ranks[],
    MPI_Group *newgroup);
    int (*group_excl)(struct mpi_rank *self, MPI_Group group, int n, const int ranks[],
    MPI_Group *newgroup);
    int (*group_range_incl)(struct mpi_rank *self, MPI_Group group, int n, int ranges[][3],
    MPI_Group *newgroup);
    int (*group_range_excl)(struct mpi_rank *self, MPI_Group group, int n, int ranges[][3],
    MPI_Group *newgroup);
    int (*group_free)(struct mpi_rank *self, MPI_Group *group);
    int (*comm_size)(struct mpi_rank *self, MPI_Comm comm, int *size);
    int (*comm_rank)(struct mpi_rank *self, MPI_Comm comm, int *rank);
    int (*comm_compare)(struct mpi_rank *self, MPI_Comm comm1, MPI_Comm comm2, int *result);
    int (*comm_group)(struct mpi_rank *self, MPI_Comm comm, MPI_Group *group);
    int (*comm_dup)(struct mpi_rank *self, MPI_Comm comm, MPI_Comm *newcomm);
    int (*comm_dup_with_info)(struct mpi_rank *self, MPI_Comm comm, MPI_Info info,
    MPI_Comm *newcomm);
    int (*comm_idup)(struct mpi_rank *self, MPI_Comm comm, MPI_Comm *newcomm,
    MPI_Request *request);
    int (*comm_idup_with_info)(struct mpi_rank *self, MPI_Comm comm, MPI_Info info,
    MPI_Comm *newcomm, MPI_Request *request);
    int (*comm_create)(struct mpi_rank *self, MPI_Comm comm, MPI_Group group,
    MPI_Comm *newcomm);
    int (*comm_create_group)(struct mpi_rank *self, MPI_Comm comm, MPI_Group group, int tag,
    MPI_Comm *newcomm);
    int (*comm_split)(struct mpi_rank *self, MPI_Comm comm, int color, int key,
    MPI_Comm *newcomm);
    int (*comm_split_type)(struct mpi_rank *self, MPI_Comm comm, int split_type, int key,
    MPI_Info info, MPI_Comm *newcomm);
    int (*comm_free)(struct mpi_rank *self, MPI_Comm *comm);
    int (*comm_disconnect)(struct mpi_rank *self, MPI_Comm *comm);
    int (*comm_get_name)(struct mpi_rank *self, MPI_Comm comm, char *comm_name, int *resultlen);
    int (*comm_set_name)(struct mpi_rank *self, MPI_Comm comm, const char *comm_name);
    int (*comm_get_info)(struct mpi_rank *self, MPI_Comm comm, MPI_Info *info_used);
    int (*comm_set_info)(struct mpi_rank *self, MPI_Comm comm, MPI_Info info);
    int (*comm_test_inter)(struct mpi_rank *self, MPI_Comm comm, int *flag);
    int (*comm_remote_size)(struct mpi_rank *self, MPI_Comm comm, int *size);
    int (*comm_remote_group)(struct mpi_rank *self, MPI_Comm comm, MPI_Group *group);
    int (*intercomm_create)(struct mpi_rank *self, MPI_Comm local_comm, int local_leader,
    MPI_Comm peer_comm, int remote_leader, int tag, MPI_Comm *newintercomm);
    int (*intercomm_merge)(struct mpi_rank *self, MPI_Comm intercomm, int high,
    MPI_Comm *newintracomm);
    int (*comm_get_parent)(struct mpi_rank *self, MPI_Comm *parent);
    int (*cart_create)(struct mpi_rank *self, MPI_Comm comm_old, int ndims, const int dims[],
    const int periods[], int reorder, MPI_Comm *comm_cart);
    int (*cart_coords)(struct mpi_rank *self, MPI_Comm comm, int rank, int maxdims,
    int coords[]);
    int (*cart_get)(struct mpi_rank *self, MPI_Comm comm, int maxdims, int dims[], int periods[],
    int coords[]);
    int (*cart_map)(struct mpi_rank *self, MPI_Comm comm, int ndims, const int dims[],
    const int periods[], int *newrank);
    int (*cart_rank)(struct mpi_rank *self, MPI_Comm comm, const int coords[], int *rank);
    int (*cart_shift)(struct mpi_rank *self, MPI_Comm comm, int direction, int disp,
    int *rank_source, int *rank_dest);
    int (*cart_sub)(struct mpi_rank *self, MPI_Comm comm, const int remain_dims[],
    MPI_Comm *newcomm);
    int (*cartdim_get)(struct mpi_rank *self, MPI_Comm comm, int *ndims);
    int (*dims_create)(struct mpi_rank *self, int nnodes, int ndims, int dims[]);
    int (*topo_test)(struct mpi_rank *self, MPI_Comm comm, int *status);
    int (*graph_create)(struct mpi_rank *self, MPI_Comm comm_old, int nnodes, const int indx[],
    const int edges[], int reorder, MPI_Comm *comm_graph);
    int (*graph_get)(struct mpi_rank *self, MPI_Comm comm, int maxindex, int maxedges,
    int indx[], int edges[]);
    int (*graph_map)(struct mpi_rank *self, MPI_Comm comm, int nnodes, const int indx[],
    const int edges[], int *newrank);
    int (*graph_neighbors)(struct mpi_rank *self, MPI_Comm comm, int rank, int maxneighbors,
    int neighbors[]);
    int (*graph_neighbors_count)(struct mpi_rank *self, MPI_Comm comm, int rank,
    int *nneighbors);
    int (*graphdims_get)(struct mpi_rank *self, MPI_Comm comm, int *nnodes, int *nedges);
    int (*dist_graph_create)(struct mpi_rank *self, MPI_Comm comm_old, int n,
    const int sources[], const int degrees[], const int destinations[], const int *weights,
    MPI_Info info, int reorder, MPI_Comm *comm_dist_graph);
    int (*dist_graph_create_adjacent)(struct mpi_rank *self, MPI_Comm comm_old, int indegree,
    const int sources[], const int *sourceweights, int outdegree, const int destinations[],
    const int *destweights, MPI_Info info, int reorder, MPI_Comm *comm_dist_graph);
    int (*dist_graph_neighbors)(struct mpi_rank *self, MPI_Comm comm, int maxindegree,
    int sources[], int *sourceweights, int maxoutdegree, int destinations[], int *destweights);
    int (*dist_graph_neighbors_count)(struct mpi_rank *self, MPI_Comm comm, int *indegree,
    int *outdegree, int *weighted);
    int (*comm_create_keyval)(struct mpi_rank *self,
    MPI_Comm_copy_attr_function *comm_copy_attr_fn,
    MPI_Comm_delete_attr_function *comm_delete_attr_fn, int *comm_keyval, void *extra_state);
    int (*comm_free_keyval)(struct mpi_rank *self, int *comm_keyval);
    int (*comm_set_attr)(struct mpi_rank *self, MPI_Comm comm, int comm_keyval,
    void *attribute_val);
    int (*comm_get_attr)(struct mpi_rank *self, MPI_Comm comm, int comm_keyval,
    void *attribute_val, int *flag);
    int (*comm_delete_attr)(struct mpi_rank *self, MPI_Comm comm, int comm_keyval);
    int (*type_create_keyval)(struct mpi_rank *self,
    MPI_Type_copy_attr_function *type_copy_attr_fn,
    MPI_Type_delete_attr_function *type_delete_attr_fn, int *type_keyval, void *extra_state);
    int (*type_free_keyval)(struct mpi_rank *self, int *type_keyval);
    int (*type_set_attr)(struct mpi_rank *self, MPI_Datatype datatype, int type_keyval,
    void *attribute_val);
    int (*type_get_attr)(struct mpi_rank *self, MPI_Datatype datatype, int type_keyval,
    void *attribute_val, int *flag);
    int (*type_delete_attr)(struct mpi_rank *self, MPI_Datatype datatype, int type_keyval);
    int (*win_create_keyval)(struct mpi_rank *self, MPI_Win_copy_attr_function *win_copy_attr_fn,
    MPI_Win_delete_attr_function *win_delete_attr_fn, int *win_keyval, void *extra_state);
    int (*win_free_keyval)(struct mpi_rank *self, int *win_keyval);
    int (*win_set_attr)(struct mpi_rank *self, MPI_Win win, int win_keyval,
    void *attribute_val);
    int (*win_get_attr)(struct mpi_rank *self, MPI_Win win, int win_keyval, void *attribute_val,
    int *flag);
    int (*win_delete_attr)(struct mpi_rank *self, MPI_Win win, int win_keyval);
    int (*keyval_create)(struct mpi_rank *self, MPI_Copy_function *copy_fn,
    MPI_Delete_function *delete_fn, int *keyval, void *extra_state);
    int (*keyval_free)(struct mpi_rank *self, int *keyval);
    int (*attr_put)(struct mpi_rank *self, MPI_Comm comm, int keyval, void *attribute_val);
    int (*attr_get)(struct mpi_rank *self, MPI_Comm comm, int keyval, void *attribute_val,
    int *flag);
    int (*attr_delete)(struct mpi_rank *self, MPI_Comm comm, int keyval);
    int (*comm_create_errhandler)(struct mpi_rank *self,
    MPI_Comm_errhandler_function *comm_errhandler_fn, MPI_Errhandler *errhandler);
    int (*comm_set_errhandler)(struct mpi_rank *self, MPI_Comm comm, MPI_Errhandler errhandler);
    int (*comm_get_errhandler)(struct mpi_rank *self, MPI_Comm comm,
    MPI_Errhandler *errhandler);
    int (*comm_call_errhandler)(struct mpi_rank *self, MPI_Comm comm, int errorcode);
    int (*win_create_errhandler)(struct mpi_rank *self,
    MPI_Win_errhandler_function *win_errhandler_fn, MPI_Errhandler *errhandler);
    int (*win_set_errhandler)(struct mpi_rank *self, MPI_Win win, MPI_Errhandler errhandler);
    int (*win_get_errhandler)(struct mpi_rank *self, MPI_Win win, MPI_Errhandler *errhandler);
    int (*win_call_errhandler)(struct mpi_rank *self, MPI_Win win, int errorcode);
    int (*errhandler_free)(struct mpi_rank *self, MPI_Errhandler *errhandler);
    int (*error_class)(struct mpi_rank *self, int errorcode, int *errorclass);
    int (*error_string)(struct mpi_rank *self, int errorcode, char *string, int *resultlen);
    int (*add_error_class)(struct mpi_rank *self, int *errorclass);
    int (*add_error_code)(struct mpi_rank *self, int errorclass, int *errorcode);
    int (*add_error_string)(struct mpi_rank *self, int errorcode, const char *string);
    int (*remove_error_class)(struct mpi_rank *self, int errorclass);
    int (*remove_error_code)(struct mpi_rank *self, int errorcode);
    int (*remove_error_string)(struct mpi_rank *self, int errorcode);
    int (*info_create)(struct mpi_rank *self, MPI_Info *info);
    int (*info_set)(struct mpi_rank *self, MPI_Info info, const char *key, const char *value);
    int (*info_delete)(struct mpi_rank *self, MPI_Info info, const char *key);
    int (*info_get)(struct mpi_rank *self, MPI_Info info, const char *key, int valuelen,
    char *value, int *flag);
    int (*info_get_string)(struct mpi_rank *self, MPI_Info info, const char *key, int *buflen,
    char *value, int *flag);
    int (*info_get_valuelen)(struct mpi_rank *self, MPI_Info info, const char *key,
    int *valuelen, int *flag);
    int (*info_get_nkeys)(struct mpi_rank *self, MPI_Info info, int *nkeys);
    int (*info_get_nthkey)(struct mpi_rank *self, MPI_Info info, int n, char *key);
    int (*info_dup)(struct mpi_rank *self, MPI_Info info, MPI_Info *newinfo);
    int (*info_free)(struct mpi_rank *self, MPI_Info *info);
    int (*win_create)(struct mpi_rank *self, void *base, MPI_Aint size, MPI_Count disp_unit,
    MPI_Info info, MPI_Comm comm, MPI_Win *win);
    int (*win_allocate)(struct mpi_rank *self, MPI_Aint size, MPI_Count disp_unit, MPI_Info info,
    MPI_Comm comm, void *baseptr, MPI_Win *win);
    int (*win_allocate_shared)(struct mpi_rank *self, MPI_Aint size, MPI_Count disp_unit,
    MPI_Info info, MPI_Comm comm, void *baseptr, MPI_Win *win);
    int (*win_shared_query)(struct mpi_rank *self, MPI_Win win, int rank, MPI_Aint *size,
    MPI_Count *disp_unit, void *baseptr);
    int (*win_create_dynamic)(struct mpi_rank *self, MPI_Info info, MPI_Comm comm,
    MPI_Win *win);
    int (*win_attach)(struct mpi_rank *self, MPI_Win win, void *base, MPI_Aint size);
    int (*win_detach)(struct mpi_rank *self, MPI_Win win, const void *base);
    int (*win_free)(struct mpi_rank *self, MPI_Win *win);
    int (*win_get_group)(struct mpi_rank *self, MPI_Win win, MPI_Group *group);
    int (*win_get_name)(struct mpi_rank *self, MPI_Win win, char *win_name, int *resultlen);
    int (*win_set_name)(struct mpi_rank *self, MPI_Win win, const char *win_name);
    int (*win_get_info)(struct mpi_rank *self, MPI_Win win, MPI_Info *info_used);
    int (*win_set_info)(struct mpi_rank *self, MPI_Win win, MPI_Info info);
    int (*put)(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count,
    MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count,
    MPI_Datatype target_datatype, MPI_Win win);
    int (*get)(struct mpi_rank *self, void *origin_addr, MPI_Count origin_count,
    MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count,
    MPI_Datatype target_datatype, MPI_Win win);
    int (*accumulate)(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count,
    MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count,
    MPI_Datatype target_datatype, MPI_Op op, MPI_Win win);
    int (*get_accumulate)(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count,
    MPI_Datatype origin_datatype, void *result_addr, MPI_Count result_count,
    MPI_Datatype result_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count,
    MPI_Datatype target_datatype, MPI_Op op, MPI_Win win);
    int (*fetch_and_op)(struct mpi_rank *self, const void *origin_addr, void *result_addr,
    MPI_Datatype datatype, int target_rank, MPI_Aint target_disp, MPI_Op op, MPI_Win win);
    int (*compare_and_swap)(struct mpi_rank *self, const void *origin_addr,
    const void *compare_addr, void *result_addr, MPI_Datatype datatype, int target_rank,
    MPI_Aint target_disp, MPI_Win win);
    int (*rput)(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count,
    MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count,
    MPI_Datatype target_datatype, MPI_Win win, MPI_Request *request);
    int (*rget)(struct mpi_rank *self, void *origin_addr, MPI_Count origin_count,
    MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count,
    MPI_Datatype target_datatype, MPI_Win win, MPI_Request *request);
    int (*raccumulate)(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count,
    MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count,
    MPI_Datatype target_datatype, MPI_Op op, MPI_Win win, MPI_Request *request);
    int (*rget_accumulate)(struct mpi_rank *self, const void *origin_addr,
    MPI_Count origin_count, MPI_Datatype origin_datatype, void *result_addr,
    MPI_Count result_count, MPI_Datatype result_datatype, int target_rank, MPI_Aint target_disp,
    MPI_Count target_count, MPI_Datatype target_datatype, MPI_Op op, MPI_Win win,
    MPI_Request *request);
    int (*win_fence)(struct mpi_rank *self, int assert, MPI_Win win);
    int (*win_start)(struct mpi_rank *self, MPI_Group group, int assert, MPI_Win win);
    int (*win_complete)(struct mpi_rank *self, MPI_Win win);
    int (*win_post)(struct mpi_rank *self, MPI_Group group, int assert, MPI_Win win);
    int (*win_wait)(struct mpi_rank *self, MPI_Win win);
    int (*win_test)(struct mpi_rank *self, MPI_Win win, int *flag);
    int (*win_lock)(struct mpi_rank *self, int lock_type, int rank, int assert, MPI_Win win);
    int (*win_unlock)(struct mpi_rank *self, int rank, MPI_Win win);
    int (*win_lock_all)(struct mpi_rank *self, int assert, MPI_Win win);
    int (*win_unlock_all)(struct mpi_rank *self, MPI_Win win);
    int (*win_flush)(struct mpi_rank *self, int rank, MPI_Win win);
    int (*win_flush_all)(struct mpi_rank *self, MPI_Win win);
    int (*win_flush_local)(struct mpi_rank *self, int rank, MPI_Win win);
    int (*win_flush_local_all)(struct mpi_rank *self, MPI_Win win);
    int (*win_sync)(struct mpi_rank *self, MPI_Win win);
    double (*wtime)(struct mpi_rank *self);
    double (*wtick)(struct mpi_rank *self);
    int (*abi_get_version)(struct mpi_rank *self, int *abi_major, int *abi_minor);
    int (*address)(struct mpi_rank *self, void *location, MPI_Aint *address);
    int (*type_extent)(struct mpi_rank *self, MPI_Datatype datatype, MPI_Aint *extent);
    int (*type_lb)(struct mpi_rank *self, MPI_Datatype datatype, MPI_Aint *displacement);
    int (*type_ub)(struct mpi_rank *self, MPI_Datatype datatype, MPI_Aint *displacement);
    int (*type_hvector)(struct mpi_rank *self, int count, int blocklength, MPI_Aint stride,
    MPI_Datatype oldtype, MPI_Datatype *newtype);
    int (*type_hindexed)(struct mpi_rank *self, int count, int *array_of_blocklengths,
    MPI_Aint *array_of_displacements, MPI_Datatype oldtype, MPI_Datatype *newtype);
    int (*type_struct)(struct mpi_rank *self, int count, int *array_of_blocklengths,
    MPI_Aint *array_of_displacements, MPI_Datatype *array_of_types, MPI_Datatype *newtype);
    int (*errhandler_create)(struct mpi_rank *self, MPI_Comm_errhandler_function *errhandler_fn,
    MPI_Errhandler *errhandler);
    int (*errhandler_set)(struct mpi_rank *self, MPI_Comm comm, MPI_Errhandler errhandler);
    int (*errhandler_get)(struct mpi_rank *self, MPI_Comm comm, MPI_Errhandler *errhandler);
};

/* The simulator's side; every function is as the standard says. */
int mpi_init(struct mpi_rank *self, int *argc, char ***argv);
int mpi_init_thread(struct mpi_rank *self, int *argc, char ***argv, int required, int *provided);
int mpi_initialized(struct mpi_rank *self, int *flag);
int mpi_finalize(struct mpi_rank *self);
int mpi_finalized(struct mpi_rank *self, int *flag);
int mpi_abort(struct mpi_rank *self, MPI_Comm comm, int errorcode);
int mpi_query_thread(struct mpi_rank *self, int *provided);
int mpi_is_thread_main(struct mpi_rank *self, int *flag);
int mpi_get_processor_name(struct mpi_rank *self, char *name, int *resultlen);
int mpi_get_version(struct mpi_rank *self, int *version, int *subversion);
int mpi_get_library_version(struct mpi_rank *self, char *version, int *resultlen);
int mpi_pcontrol(struct mpi_rank *self, const int level);
int mpi_send(struct mpi_rank *self, struct mpi_start start, const void *buf, MPI_Count count, MPI_Datatype datatype, int dest, int tag, MPI_Comm comm);
int mpi_bsend(struct mpi_rank *self, struct mpi_start start, const void *buf, MPI_Count count, MPI_Datatype datatype, int dest, int tag, MPI_Comm comm);
int mpi_ssend(struct mpi_rank *self, struct mpi_start start, const void *buf, MPI_Count count, MPI_Datatype datatype, int dest, int tag, MPI_Comm comm);
int mpi_rsend(struct mpi_rank *self, struct mpi_start start, const void *buf, MPI_Count count, MPI_Datatype datatype, int dest, int tag, MPI_Comm comm);
int mpi_recv(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype, int source, int tag, MPI_Comm comm, MPI_Status *status);
int mpi_irecv(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype, int source, int tag, MPI_Comm comm, MPI_Request *request);
int mpi_recv_init(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype, int source, int tag, MPI_Comm comm, MPI_Request *request);
int mpi_sendrecv(struct mpi_rank *self, const void *sendbuf, MPI_Count sendcount, MPI_Datatype sendtype, int dest, int sendtag, void *recvbuf, MPI_Count recvcount, MPI_Datatype recvtype, int source, int recvtag, MPI_Comm comm, MPI_Status *status);
int mpi_isendrecv(struct mpi_rank *self, const void *sendbuf, MPI_Count sendcount, MPI_Datatype sendtype, int dest, int sendtag, void *recvbuf, MPI_Count recvcount, MPI_Datatype recvtype, int source, int recvtag, MPI_Comm comm, MPI_Request *request);
int mpi_sendrecv_replace(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype, int dest, int sendtag, int source, int recvtag, MPI_Comm comm, MPI_Status *status);
int mpi_isendrecv_replace(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype, int dest, int sendtag, int source, int recvtag, MPI_Comm comm, MPI_Request *request);
int mpi_buffer_attach(struct mpi_rank *self, void *buffer, MPI_Count size);
int mpi_buffer_detach(struct mpi_rank *self, void *buffer_addr, MPI_Count *size);
int mpi_buffer_flush(struct mpi_rank *self);
int mpi_buffer_iflush(struct mpi_rank *self, MPI_Request *request);
int mpi_comm_attach_buffer(struct mpi_rank *self, MPI_Comm comm, void *buffer, MPI_Count size);
int mpi_comm_detach_buffer(struct mpi_rank *self, MPI_Comm comm, void *buffer_addr, MPI_Count *size);
int mpi_comm_flush_buffer(struct mpi_rank *self, MPI_Comm comm);
int mpi_comm_iflush_buffer(struct mpi_rank *self, MPI_Comm comm, MPI_Request *request);
int mpi_probe(struct mpi_rank *self, int source, int tag, MPI_Comm comm, MPI_Status *status);
int mpi_iprobe(struct mpi_rank *self, int source, int tag, MPI_Comm comm, int *flag, MPI_Status *status);
int mpi_mprobe(struct mpi_rank *self, int source, int tag, MPI_Comm comm, MPI_Message *message, MPI_Status *status);
int mpi_improbe(struct mpi_rank *self, int source, int tag, MPI_Comm comm, int *flag, MPI_Message *message, MPI_Status *status);
int mpi_mrecv(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype, MPI_Message *message, MPI_Status *status);
int mpi_imrecv(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype, MPI_Message *message, MPI_Request *request);
int mpi_wait(struct mpi_rank *self, MPI_Request *request, MPI_Status *status);
int mpi_waitall(struct mpi_rank *self, int count, MPI_Request array_of_requests[], MPI_Status *array_of_statuses);
int mpi_waitany(struct mpi_rank *self, int count, MPI_Request array_of_requests[], int *indx, MPI_Status *status);
int mpi_waitsome(struct mpi_rank *self, int incount, MPI_Request array_of_requests[], int *outcount, int array_of_indices[], MPI_Status *array_of_statuses);
int mpi_test(struct mpi_rank *self, MPI_Request *request, int *flag, MPI_Status *status);
int mpi_testall(struct mpi_rank *self, int count, MPI_Request array_of_requests[], int *flag, MPI_Status *array_of_statuses);
int mpi_testany(struct mpi_rank *self, int count, MPI_Request array_of_requests[], int *indx, int *flag, MPI_Status *status);
int mpi_testsome(struct mpi_rank *self, int incount, MPI_Request array_of_requests[], int *outcount, int array_of_indices[], MPI_Status *array_of_statuses);
int mpi_start(struct mpi_rank *self, MPI_Request *request);
int mpi_startall(struct mpi_rank *self, int count, MPI_Request array_of_requests[]);
int mpi_request_free(struct mpi_rank *self, MPI_Request *request);
int mpi_request_get_status(struct mpi_rank *self, MPI_Request request, int *flag, MPI_Status *status);
int mpi_request_get_status_all(struct mpi_rank *self, int count, const MPI_Request array_of_requests[], int *flag, MPI_Status *array_of_statuses);
int mpi_request_get_status_any(struct mpi_rank *self, int count, const MPI_Request array_of_requests[], int *indx, int *flag, MPI_Status *status);
int mpi_request_get_status_some(struct mpi_rank *self, int incount, const MPI_Request array_of_requests[], int *outcount, int array_of_indices[], MPI_Status *array_of_statuses);
int mpi_cancel(struct mpi_rank *self, MPI_Request *request);
int mpi_test_cancelled(struct mpi_rank *self, const MPI_Status *status, int *flag);
int mpi_grequest_start(struct mpi_rank *self, MPI_Grequest_query_function *query_fn, MPI_Grequest_free_function *free_fn, MPI_Grequest_cancel_function *cancel_fn, void *extra_state, MPI_Request *request);
int mpi_grequest_complete(struct mpi_rank *self, MPI_Request request);
int mpi_get_count(struct mpi_rank *self, const MPI_Status *status, MPI_Datatype datatype, MPI_Count *count);
int mpi_get_elements(struct mpi_rank *self, const MPI_Status *status, MPI_Datatype datatype, MPI_Count *count);
int mpi_get_elements_x(struct mpi_rank *self, const MPI_Status *status, MPI_Datatype datatype, MPI_Count *count);
int mpi_status_set_elements(struct mpi_rank *self, MPI_Status *status, MPI_Datatype datatype, MPI_Count count);
int mpi_status_set_elements_x(struct mpi_rank *self, MPI_Status *status, MPI_Datatype datatype, MPI_Count count);
int mpi_status_set_cancelled(struct mpi_rank *self, MPI_Status *status, int flag);
int mpi_status_get_error(struct mpi_rank *self, const MPI_Status *status, int *error);
int mpi_status_get_source(struct mpi_rank *self, const MPI_Status *status, int *source);
int mpi_status_get_tag(struct mpi_rank *self, const MPI_Status *status, int *tag);
int mpi_status_set_error(struct mpi_rank *self, MPI_Status *status, int error);
int mpi_status_set_source(struct mpi_rank *self, MPI_Status *status, int source);
int mpi_status_set_tag(struct mpi_rank *self, MPI_Status *status, int tag);
int mpi_barrier(struct mpi_rank *self, struct mpi_start start, MPI_Comm comm);
int mpi_bcast(struct mpi_rank *self, struct mpi_start start, void *buffer, MPI_Count count, MPI_Datatype datatype, int root, MPI_Comm comm);
int mpi_gather(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount, MPI_Datatype recvtype, int root, MPI_Comm comm);
int mpi_gatherv(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, struct mpi_counts recvcounts, struct mpi_counts displs, MPI_Datatype recvtype, int root, MPI_Comm comm);
int mpi_scatter(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount, MPI_Datatype recvtype, int root, MPI_Comm comm);
int mpi_scatterv(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, struct mpi_counts sendcounts, struct mpi_counts displs, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount, MPI_Datatype recvtype, int root, MPI_Comm comm);
int mpi_allgather(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount, MPI_Datatype recvtype, MPI_Comm comm);
int mpi_allgatherv(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, struct mpi_counts recvcounts, struct mpi_counts displs, MPI_Datatype recvtype, MPI_Comm comm);
int mpi_alltoall(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount, MPI_Datatype recvtype, MPI_Comm comm);
int mpi_alltoallv(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, struct mpi_counts sendcounts, struct mpi_counts sdispls, MPI_Datatype sendtype, void *recvbuf, struct mpi_counts recvcounts, struct mpi_counts rdispls, MPI_Datatype recvtype, MPI_Comm comm);
int mpi_alltoallw(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, struct mpi_counts sendcounts, struct mpi_counts sdispls, const MPI_Datatype sendtypes[], void *recvbuf, struct mpi_counts recvcounts, struct mpi_counts rdispls, const MPI_Datatype recvtypes[], MPI_Comm comm);
int mpi_reduce(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, void *recvbuf, MPI_Count count, MPI_Datatype datatype, MPI_Op op, int root, MPI_Comm comm);
int mpi_allreduce(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, void *recvbuf, MPI_Count count, MPI_Datatype datatype, MPI_Op op, MPI_Comm comm);
int mpi_reduce_scatter(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, void *recvbuf, struct mpi_counts recvcounts, MPI_Datatype datatype, MPI_Op op, MPI_Comm comm);
int mpi_reduce_scatter_block(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, void *recvbuf, MPI_Count recvcount, MPI_Datatype datatype, MPI_Op op, MPI_Comm comm);
int mpi_scan(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, void *recvbuf, MPI_Count count, MPI_Datatype datatype, MPI_Op op, MPI_Comm comm);
int mpi_exscan(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, void *recvbuf, MPI_Count count, MPI_Datatype datatype, MPI_Op op, MPI_Comm comm);
int mpi_reduce_local(struct mpi_rank *self, const void *inbuf, void *inoutbuf, MPI_Count count, MPI_Datatype datatype, MPI_Op op);
int mpi_op_create(struct mpi_rank *self, MPI_User_function *user_fn, int commute, MPI_Op *op);
int mpi_op_create_c(struct mpi_rank *self, MPI_User_function_c *user_fn, int commute, MPI_Op *op);
int mpi_op_free(struct mpi_rank *self, MPI_Op *op);
int mpi_op_commutative(struct mpi_rank *self, MPI_Op op, int *commute);
int mpi_neighbor_allgather(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount, MPI_Datatype recvtype, MPI_Comm comm);
int mpi_neighbor_allgatherv(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, struct mpi_counts recvcounts, struct mpi_counts displs, MPI_Datatype recvtype, MPI_Comm comm);
int mpi_neighbor_alltoall(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount, MPI_Datatype recvtype, MPI_Comm comm);
int mpi_neighbor_alltoallv(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, struct mpi_counts sendcounts, struct mpi_counts sdispls, MPI_Datatype sendtype, void *recvbuf, struct mpi_counts recvcounts, struct mpi_counts rdispls, MPI_Datatype recvtype, MPI_Comm comm);
int mpi_neighbor_alltoallw(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, struct mpi_counts sendcounts, const MPI_Aint sdispls[], const MPI_Datatype sendtypes[], void *recvbuf, struct mpi_counts recvcounts, const MPI_Aint rdispls[], const MPI_Datatype recvtypes[], MPI_Comm comm);
int mpi_type_contiguous(struct mpi_rank *self, MPI_Count count, MPI_Datatype oldtype, MPI_Datatype *newtype);
int mpi_type_vector(struct mpi_rank *self, MPI_Count count, MPI_Count blocklength, MPI_Count stride, MPI_Datatype oldtype, MPI_Datatype *newtype);
int mpi_type_create_hvector(struct mpi_rank *self, MPI_Count count, MPI_Count blocklength, MPI_Count stride, MPI_Datatype oldtype, MPI_Datatype *newtype);
int mpi_type_indexed(struct mpi_rank *self, MPI_Count count, struct mpi_counts array_of_blocklengths, struct mpi_counts array_of_displacements, MPI_Datatype oldtype, MPI_Datatype *newtype);
int mpi_type_create_hindexed(struct mpi_rank *self, MPI_Count count, struct mpi_counts array_of_blocklengths, const MPI_Count array_of_displacements[], MPI_Datatype oldtype, MPI_Datatype *newtype);
int mpi_type_create_indexed_block(struct mpi_rank *self, MPI_Count count, MPI_Count blocklength, struct mpi_counts array_of_displacements, MPI_Datatype oldtype, MPI_Datatype *newtype);
int mpi_type_create_hindexed_block(struct mpi_rank *self, MPI_Count count, MPI_Count blocklength, const MPI_Count array_of_displacements[], MPI_Datatype oldtype, MPI_Datatype *newtype);
int mpi_type_create_struct(struct mpi_rank *self, MPI_Count count, struct mpi_counts array_of_blocklengths, const MPI_Count array_of_displacements[], const MPI_Datatype array_of_types[], MPI_Datatype *newtype);
int mpi_type_create_subarray(struct mpi_rank *self, int ndims, struct mpi_counts array_of_sizes, struct mpi_counts array_of_subsizes, struct mpi_counts array_of_starts, int order, MPI_Datatype oldtype, MPI_Datatype *newtype);
int mpi_type_create_darray(struct mpi_rank *self, int size, int rank, int ndims, struct mpi_counts array_of_gsizes, const int array_of_distribs[], const int array_of_dargs[], const int array_of_psizes[], int order, MPI_Datatype oldtype, MPI_Datatype *newtype);
int mpi_type_create_resized(struct mpi_rank *self, MPI_Datatype oldtype, MPI_Count lb, MPI_Count extent, MPI_Datatype *newtype);
int mpi_type_create_f90_real(struct mpi_rank *self, int p, int r, MPI_Datatype *newtype);
int mpi_type_create_f90_complex(struct mpi_rank *self, int p, int r, MPI_Datatype *newtype);
int mpi_type_create_f90_integer(struct mpi_rank *self, int r, MPI_Datatype *newtype);
int mpi_type_match_size(struct mpi_rank *self, int typeclass, int size, MPI_Datatype *datatype);
int mpi_type_get_value_index(struct mpi_rank *self, MPI_Datatype value_type, MPI_Datatype index_type, MPI_Datatype *pair_type);
int mpi_type_dup(struct mpi_rank *self, MPI_Datatype oldtype, MPI_Datatype *newtype);
int mpi_type_commit(struct mpi_rank *self, MPI_Datatype *datatype);
int mpi_type_free(struct mpi_rank *self, MPI_Datatype *datatype);
int mpi_type_size(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *size);
int mpi_type_size_x(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *size);
int mpi_type_get_extent(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *lb, MPI_Count *extent);
int mpi_type_get_extent_x(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *lb, MPI_Count *extent);
int mpi_type_get_true_extent(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *true_lb, MPI_Count *true_extent);
int mpi_type_get_true_extent_x(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *true_lb, MPI_Count *true_extent);
int mpi_type_get_envelope(struct mpi_rank *self, MPI_Datatype datatype, int *num_integers, int *num_addresses, int *num_datatypes, int *combiner);
int mpi_type_get_contents(struct mpi_rank *self, MPI_Datatype datatype, int max_integers, int max_addresses, int max_datatypes, int array_of_integers[], MPI_Aint array_of_addresses[], MPI_Datatype array_of_datatypes[]);
int mpi_type_get_name(struct mpi_rank *self, MPI_Datatype datatype, char *type_name, int *resultlen);
int mpi_type_set_name(struct mpi_rank *self, MPI_Datatype datatype, const char *type_name);
int mpi_pack(struct mpi_rank *self, const void *inbuf, MPI_Count incount, MPI_Datatype datatype, void *outbuf, MPI_Count outsize, MPI_Count *position, MPI_Comm comm);
int mpi_unpack(struct mpi_rank *self, const void *inbuf, MPI_Count insize, MPI_Count *position, void *outbuf, MPI_Count outcount, MPI_Datatype datatype, MPI_Comm comm);
int mpi_pack_size(struct mpi_rank *self, MPI_Count incount, MPI_Datatype datatype, MPI_Comm comm, MPI_Count *size);
int mpi_get_address(struct mpi_rank *self, const void *location, MPI_Aint *address);
int mpi_alloc_mem(struct mpi_rank *self, MPI_Aint size, MPI_Info info, void *baseptr);
int mpi_free_mem(struct mpi_rank *self, void *base);
int mpi_group_size(struct mpi_rank *self, MPI_Group group, int *size);
int mpi_group_rank(struct mpi_rank *self, MPI_Group group, int *rank);
int mpi_group_translate_ranks(struct mpi_rank *self, MPI_Group group1, int n, const int ranks1[], MPI_Group group2, int ranks2[]);
int mpi_group_compare(struct mpi_rank *self, MPI_Group group1, MPI_Group group2, int *result);
int mpi_group_union(struct mpi_rank *self, MPI_Group group1, MPI_Group group2, MPI_Group *newgroup);
int mpi_group_intersection(struct mpi_rank *self, MPI_Group group1, MPI_Group group2, MPI_Group *newgroup);
int mpi_group_difference(struct mpi_rank *self, MPI_Group group1, MPI_Group group2, MPI_Group *newgroup);
int mpi_group_incl(struct mpi_rank *self, MPI_Group group, int n, const int ranks[], MPI_Group *newgroup);
int mpi_group_excl(struct mpi_rank *self, MPI_Group group, int n, const int ranks[], MPI_Group *newgroup);
int mpi_group_range_incl(struct mpi_rank *self, MPI_Group group, int n, int ranges[][3], MPI_Group *newgroup);
int mpi_group_range_excl(struct mpi_rank *self, MPI_Group group, int n, int ranges[][3], MPI_Group *newgroup);
int mpi_group_free(struct mpi_rank *self, MPI_Group *group);
int mpi_comm_size(struct mpi_rank *self, MPI_Comm comm, int *size);
int mpi_comm_rank(struct mpi_rank *self, MPI_Comm comm, int *rank);
int mpi_comm_compare(struct mpi_rank *self, MPI_Comm comm1, MPI_Comm comm2, int *result);
int mpi_comm_group(struct mpi_rank *self, MPI_Comm comm, MPI_Group *group);
int mpi_comm_dup(struct mpi_rank *self, MPI_Comm comm, MPI_Comm *newcomm);
int mpi_comm_dup_with_info(struct mpi_rank *self, MPI_Comm comm, MPI_Info info, MPI_Comm *newcomm);
int mpi_comm_idup(struct mpi_rank *self, MPI_Comm comm, MPI_Comm *newcomm, MPI_Request *request);
int mpi_comm_idup_with_info(struct mpi_rank *self, MPI_Comm comm, MPI_Info info, MPI_Comm *newcomm, MPI_Request *request);
int mpi_comm_create(struct mpi_rank *self, MPI_Comm comm, MPI_Group group, MPI_Comm *newcomm);
int mpi_comm_create_group(struct mpi_rank *self, MPI_Comm comm, MPI_Group group, int tag, MPI_Comm *newcomm);
int mpi_comm_split(struct mpi_rank *self, MPI_Comm comm, int color, int key, MPI_Comm *newcomm);
int mpi_comm_split_type(struct mpi_rank *self, MPI_Comm comm, int split_type, int key, MPI_Info info, MPI_Comm *newcomm);
int mpi_comm_free(struct mpi_rank *self, MPI_Comm *comm);
int mpi_comm_disconnect(struct mpi_rank *self, MPI_Comm *comm);
int mpi_comm_get_name(struct mpi_rank *self, MPI_Comm comm, char *comm_name, int *resultlen);
int mpi_comm_set_name(struct mpi_rank *self, MPI_Comm comm, const char *comm_name);
int mpi_comm_get_info(struct mpi_rank *self, MPI_Comm comm, MPI_Info *info_used);
int mpi_comm_set_info(struct mpi_rank *self, MPI_Comm comm, MPI_Info info);
int mpi_comm_test_inter(struct mpi_rank *self, MPI_Comm comm, int *flag);
int mpi_comm_remote_size(struct mpi_rank *self, MPI_Comm comm, int *size);
int mpi_comm_remote_group(struct mpi_rank *self, MPI_Comm comm, MPI_Group *group);
int mpi_intercomm_create(struct mpi_rank *self, MPI_Comm local_comm, int local_leader, MPI_Comm peer_comm, int remote_leader, int tag, MPI_Comm *newintercomm);
int mpi_intercomm_merge(struct mpi_rank *self, MPI_Comm intercomm, int high, MPI_Comm *newintracomm);
int mpi_comm_get_parent(struct mpi_rank *self, MPI_Comm *parent);
int mpi_cart_create(struct mpi_rank *self, MPI_Comm comm_old, int ndims, const int dims[], const int periods[], int reorder, MPI_Comm *comm_cart);
int mpi_cart_coords(struct mpi_rank *self, MPI_Comm comm, int rank, int maxdims, int coords[]);
int mpi_cart_get(struct mpi_rank *self, MPI_Comm comm, int maxdims, int dims[], int periods[], int coords[]);
int mpi_cart_map(struct mpi_rank *self, MPI_Comm comm, int ndims, const int dims[], const int periods[], int *newrank);
int mpi_cart_rank(struct mpi_rank *self, MPI_Comm comm, const int coords[], int *rank);
int mpi_cart_shift(struct mpi_rank *self, MPI_Comm comm, int direction, int disp, int *rank_source, int *rank_dest);
int mpi_cart_sub(struct mpi_rank *self, MPI_Comm comm, const int remain_dims[], MPI_Comm *newcomm);
int mpi_cartdim_get(struct mpi_rank *self, MPI_Comm comm, int *ndims);
int mpi_dims_create(struct mpi_rank *self, int nnodes, int ndims, int dims[]);
int mpi_topo_test(struct mpi_rank *self, MPI_Comm comm, int *status);
int mpi_graph_create(struct mpi_rank *self, MPI_Comm comm_old, int nnodes, const int indx[], const int edges[], int reorder, MPI_Comm *comm_graph);
int mpi_graph_get(struct mpi_rank *self, MPI_Comm comm, int maxindex, int maxedges, int indx[], int edges[]);
int mpi_graph_map(struct mpi_rank *self, MPI_Comm comm, int nnodes, const int indx[], const int edges[], int *newrank);
int mpi_graph_neighbors(struct mpi_rank *self, MPI_Comm comm, int rank, int maxneighbors, int neighbors[]);
int mpi_graph_neighbors_count(struct mpi_rank *self, MPI_Comm comm, int rank, int *nneighbors);
int mpi_graphdims_get(struct mpi_rank *self, MPI_Comm comm, int *nnodes, int *nedges);
int mpi_dist_graph_create(struct mpi_rank *self, MPI_Comm comm_old, int n, const int sources[], const int degrees[], const int destinations[], const int *weights, MPI_Info info, int reorder, MPI_Comm *comm_dist_graph);
int mpi_dist_graph_create_adjacent(struct mpi_rank *self, MPI_Comm comm_old, int indegree, const int sources[], const int *sourceweights, int outdegree, const int destinations[], const int *destweights, MPI_Info info, int reorder, MPI_Comm *comm_dist_graph);
int mpi_dist_graph_neighbors(struct mpi_rank *self, MPI_Comm comm, int maxindegree, int sources[], int *sourceweights, int maxoutdegree, int destinations[], int *destweights);
int mpi_dist_graph_neighbors_count(struct mpi_rank *self, MPI_Comm comm, int *indegree, int *outdegree, int *weighted);
int mpi_comm_create_keyval(struct mpi_rank *self, MPI_Comm_copy_attr_function *comm_copy_attr_fn, MPI_Comm_delete_attr_function *comm_delete_attr_fn, int *comm_keyval, void *extra_state);
int mpi_comm_free_keyval(struct mpi_rank *self, int *comm_keyval);
int mpi_comm_set_attr(struct mpi_rank *self, MPI_Comm comm, int comm_keyval, void *attribute_val);
int mpi_comm_get_attr(struct mpi_rank *self, MPI_Comm comm, int comm_keyval, void *attribute_val, int *flag);
int mpi_comm_delete_attr(struct mpi_rank *self, MPI_Comm comm, int comm_keyval);
int mpi_type_create_keyval(struct mpi_rank *self, MPI_Type_copy_attr_function *type_copy_attr_fn, MPI_Type_delete_attr_function *type_delete_attr_fn, int *type_keyval, void *extra_state);
int mpi_type_free_keyval(struct mpi_rank *self, int *type_keyval);
int mpi_type_set_attr(struct mpi_rank *self, MPI_Datatype datatype, int type_keyval, void *attribute_val);
int mpi_type_get_attr(struct mpi_rank *self, MPI_Datatype datatype, int type_keyval, void *attribute_val, int *flag);
int mpi_type_delete_attr(struct mpi_rank *self, MPI_Datatype datatype, int type_keyval);
int mpi_win_create_keyval(struct mpi_rank *self, MPI_Win_copy_attr_function *win_copy_attr_fn, MPI_Win_delete_attr_function *win_delete_attr_fn, int *win_keyval, void *extra_state);
int mpi_win_free_keyval(struct mpi_rank *self, int *win_keyval);
int mpi_win_set_attr(struct mpi_rank *self, MPI_Win win, int win_keyval, void *attribute_val);
int mpi_win_get_attr(struct mpi_rank *self, MPI_Win win, int win_keyval, void *attribute_val, int *flag);
int mpi_win_delete_attr(struct mpi_rank *self, MPI_Win win, int win_keyval);
int mpi_keyval_create(struct mpi_rank *self, MPI_Copy_function *copy_fn, MPI_Delete_function *delete_fn, int *keyval, void *extra_state);
int mpi_keyval_free(struct mpi_rank *self, int *keyval);
int mpi_attr_put(struct mpi_rank *self, MPI_Comm comm, int keyval, void *attribute_val);
int mpi_attr_get(struct mpi_rank *self, MPI_Comm comm, int keyval, void *attribute_val, int *flag);
int mpi_attr_delete(struct mpi_rank *self, MPI_Comm comm, int keyval);
int mpi_comm_create_errhandler(struct mpi_rank *self, MPI_Comm_errhandler_function *comm_errhandler_fn, MPI_Errhandler *errhandler);
int mpi_comm_set_errhandler(struct mpi_rank *self, MPI_Comm comm, MPI_Errhandler errhandler);
int mpi_comm_get_errhandler(struct mpi_rank *self, MPI_Comm comm, MPI_Errhandler *errhandler);
int mpi_comm_call_errhandler(struct mpi_rank *self, MPI_Comm comm, int errorcode);
int mpi_win_create_errhandler(struct mpi_rank *self, MPI_Win_errhandler_function *win_errhandler_fn, MPI_Errhandler *errhandler);
int mpi_win_set_errhandler(struct mpi_rank *self, MPI_Win win, MPI_Errhandler errhandler);
int mpi_win_get_errhandler(struct mpi_rank *self, MPI_Win win, MPI_Errhandler *errhandler);
int mpi_win_call_errhandler(struct mpi_rank *self, MPI_Win win, int errorcode);
int mpi_errhandler_free(struct mpi_rank *self, MPI_Errhandler *errhandler);
int mpi_error_class(struct mpi_rank *self, int errorcode, int *errorclass);
int mpi_error_string(struct mpi_rank *self, int errorcode, char *string, int *resultlen);
int mpi_add_error_class(struct mpi_rank *self, int *errorclass);
int mpi_add_error_code(struct mpi_rank *self, int errorclass, int *errorcode);
int mpi_add_error_string(struct mpi_rank *self, int errorcode, const char *string);
int mpi_remove_error_class(struct mpi_rank *self, int errorclass);
int mpi_remove_error_code(struct mpi_rank *self, int errorcode);
int mpi_remove_error_string(struct mpi_rank *self, int errorcode);
int mpi_info_create(struct mpi_rank *self, MPI_Info *info);
int mpi_info_set(struct mpi_rank *self, MPI_Info info, const char *key, const char *value);
int mpi_info_delete(struct mpi_rank *self, MPI_Info info, const char *key);
int mpi_info_get(struct mpi_rank *self, MPI_Info info, const char *key, int valuelen, char *value, int *flag);
int mpi_info_get_string(struct mpi_rank *self, MPI_Info info, const char *key, int *buflen, char *value, int *flag);
int mpi_info_get_valuelen(struct mpi_rank *self, MPI_Info info, const char *key, int *valuelen, int *flag);
int mpi_info_get_nkeys(struct mpi_rank *self, MPI_Info info, int *nkeys);
int mpi_info_get_nthkey(struct mpi_rank *self, MPI_Info info, int n, char *key);
int mpi_info_dup(struct mpi_rank *self, MPI_Info info, MPI_Info *newinfo);
int mpi_info_free(struct mpi_rank *self, MPI_Info *info);
int mpi_win_create(struct mpi_rank *self, void *base, MPI_Aint size, MPI_Count disp_unit, MPI_Info info, MPI_Comm comm, MPI_Win *win);
int mpi_win_allocate(struct mpi_rank *self, MPI_Aint size, MPI_Count disp_unit, MPI_Info info, MPI_Comm comm, void *baseptr, MPI_Win *win);
int mpi_win_allocate_shared(struct mpi_rank *self, MPI_Aint size, MPI_Count disp_unit, MPI_Info info, MPI_Comm comm, void *baseptr, MPI_Win *win);
int mpi_win_shared_query(struct mpi_rank *self, MPI_Win win, int rank, MPI_Aint *size, MPI_Count *disp_unit, void *baseptr);
int mpi_win_create_dynamic(struct mpi_rank *self, MPI_Info info, MPI_Comm comm, MPI_Win *win);
int mpi_win_attach(struct mpi_rank *self, MPI_Win win, void *base, MPI_Aint size);
int mpi_win_detach(struct mpi_rank *self, MPI_Win win, const void *base);
int mpi_win_free(struct mpi_rank *self, MPI_Win *win);
int mpi_win_get_group(struct mpi_rank *self, MPI_Win win, MPI_Group *group);
int mpi_win_get_name(struct mpi_rank *self, MPI_Win win, char *win_name, int *resultlen);
int mpi_win_set_name(struct mpi_rank *self, MPI_Win win, const char *win_name);
int mpi_win_get_info(struct mpi_rank *self, MPI_Win win, MPI_Info *info_used);
int mpi_win_set_info(struct mpi_rank *self, MPI_Win win, MPI_Info info);
int mpi_put(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count, MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count, MPI_Datatype target_datatype, MPI_Win win);
int mpi_get(struct mpi_rank *self, void *origin_addr, MPI_Count origin_count, MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count, MPI_Datatype target_datatype, MPI_Win win);
int mpi_accumulate(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count, MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count, MPI_Datatype target_datatype, MPI_Op op, MPI_Win win);
int mpi_get_accumulate(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count, MPI_Datatype origin_datatype, void *result_addr, MPI_Count result_count, MPI_Datatype result_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count, MPI_Datatype target_datatype, MPI_Op op, MPI_Win win);
int mpi_fetch_and_op(struct mpi_rank *self, const void *origin_addr, void *result_addr, MPI_Datatype datatype, int target_rank, MPI_Aint target_disp, MPI_Op op, MPI_Win win);
int mpi_compare_and_swap(struct mpi_rank *self, const void *origin_addr, const void *compare_addr, void *result_addr, MPI_Datatype datatype, int target_rank, MPI_Aint target_disp, MPI_Win win);
int mpi_rput(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count, MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count, MPI_Datatype target_datatype, MPI_Win win, MPI_Request *request);
int mpi_rget(struct mpi_rank *self, void *origin_addr, MPI_Count origin_count, MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count, MPI_Datatype target_datatype, MPI_Win win, MPI_Request *request);
int mpi_raccumulate(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count, MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count, MPI_Datatype target_datatype, MPI_Op op, MPI_Win win, MPI_Request *request);
int mpi_rget_accumulate(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count, MPI_Datatype origin_datatype, void *result_addr, MPI_Count result_count, MPI_Datatype result_datatype, int target_rank, MPI_Aint target_disp, MPI_Count target_count, MPI_Datatype target_datatype, MPI_Op op, MPI_Win win, MPI_Request *request);
int mpi_win_fence(struct mpi_rank *self, int assert, MPI_Win win);
int mpi_win_start(struct mpi_rank *self, MPI_Group group, int assert, MPI_Win win);
int mpi_win_complete(struct mpi_rank *self, MPI_Win win);
int mpi_win_post(struct mpi_rank *self, MPI_Group group, int assert, MPI_Win win);
int mpi_win_wait(struct mpi_rank *self, MPI_Win win);
int mpi_win_test(struct mpi_rank *self, MPI_Win win, int *flag);
int mpi_win_lock(struct mpi_rank *self, int lock_type, int rank, int assert, MPI_Win win);
int mpi_win_unlock(struct mpi_rank *self, int rank, MPI_Win win);
int mpi_win_lock_all(struct mpi_rank *self, int assert, MPI_Win win);
int mpi_win_unlock_all(struct mpi_rank *self, MPI_Win win);
int mpi_win_flush(struct mpi_rank *self, int rank, MPI_Win win);
int mpi_win_flush_all(struct mpi_rank *self, MPI_Win win);
int mpi_win_flush_local(struct mpi_rank *self, int rank, MPI_Win win);
int mpi_win_flush_local_all(struct mpi_rank *self, MPI_Win win);
int mpi_win_sync(struct mpi_rank *self, MPI_Win win);
double mpi_wtime(struct mpi_rank *self);
double mpi_wtick(struct mpi_rank *self);
int mpi_abi_get_version(struct mpi_rank *self, int *abi_major, int *abi_minor);
int mpi_address(struct mpi_rank *self, void *location, MPI_Aint *address);
int mpi_type_extent(struct mpi_rank *self, MPI_Datatype datatype, MPI_Aint *extent);
int mpi_type_lb(struct mpi_rank *self, MPI_Datatype datatype, MPI_Aint *displacement);
int mpi_type_ub(struct mpi_rank *self, MPI_Datatype datatype, MPI_Aint *displacement);
int mpi_type_hvector(struct mpi_rank *self, int count, int blocklength, MPI_Aint stride, MPI_Datatype oldtype, MPI_Datatype *newtype);
int mpi_type_hindexed(struct mpi_rank *self, int count, int *array_of_blocklengths, MPI_Aint *array_of_displacements, MPI_Datatype oldtype, MPI_Datatype *newtype);
int mpi_type_struct(struct mpi_rank *self, int count, int *array_of_blocklengths, MPI_Aint *array_of_displacements, MPI_Datatype *array_of_types, MPI_Datatype *newtype);
int mpi_errhandler_create(struct mpi_rank *self, MPI_Comm_errhandler_function *errhandler_fn, MPI_Errhandler *errhandler);
int mpi_errhandler_set(struct mpi_rank *self, MPI_Comm comm, MPI_Errhandler errhandler);
int mpi_errhandler_get(struct mpi_rank *self, MPI_Comm comm, MPI_Errhandler *errhandler);
void mpi_enter(struct mpi_rank *self, const char *call, const void *address, int anytime);
void mpi_refuse(struct mpi_rank *self, const char *call, const char *reason);

#endif
