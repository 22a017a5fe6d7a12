/* mpi_share.h - what the files of room mpi call of each other, but for requests (mpi_request.h). */
#ifndef MPI_MPI_SHARE_H
#define MPI_MPI_SHARE_H

/* --- mpi_memory.c: blocks of any size, not zeroed but by mpi_take_zero; mpi_give accepts NULL ---
 */
void *mpi_take(struct mpi_world *w, int64_t bytes);
void *mpi_take_zero(struct mpi_world *w, int64_t bytes);
char *mpi_take_text(struct mpi_world *w, const char *s);
void mpi_give(struct mpi_world *w, void *block);
void mpi_memory_end(struct mpi_world *w);

/* --- mpi_handle.c: make gives an object its number and one use; object is NULL for handles that
 * are not of that kind; bad_handle reports one and returns NULL with the code in r->code --- */
void *mpi_handle_make(struct mpi_rank *r, void *object, enum mpi_kind kind);
void *mpi_handle(const void *object);
void mpi_handle_end(struct mpi_rank *r, void *object);
void *mpi_object(struct mpi_rank *r, const void *handle, enum mpi_kind kind);
void *mpi_bad_handle(struct mpi_rank *r, const void *handle, enum mpi_kind kind);

/* --- X_of: the object of a handle, NULL after an error was reported (r->code). X_use, X_drop: one
 * more use, one less --- */
struct mpi_comm *mpi_comm_of(struct mpi_rank *r, MPI_Comm handle);
struct mpi_group *mpi_group_of(struct mpi_rank *r, MPI_Group handle);
struct mpi_type *mpi_type_of(struct mpi_rank *r, MPI_Datatype handle);
struct mpi_op *mpi_op_of(struct mpi_rank *r, MPI_Op handle);
struct mpi_request *mpi_request_of(struct mpi_rank *r, MPI_Request handle);
struct mpi_errhandler *mpi_errhandler_of(struct mpi_rank *r, MPI_Errhandler handle);
void mpi_comm_drop(struct mpi_rank *r, struct mpi_comm *c);
void mpi_group_drop(struct mpi_rank *r, struct mpi_group *g);
void mpi_type_use(struct mpi_type *t);
void mpi_type_drop(struct mpi_rank *r, struct mpi_type *t);
void mpi_op_use(struct mpi_op *o);
void mpi_op_drop(struct mpi_rank *r, struct mpi_op *o);
void mpi_errhandler_use(struct mpi_errhandler *h);
void mpi_errhandler_drop(struct mpi_rank *r, struct mpi_errhandler *h);
MPI_Errhandler mpi_errhandler_handle(struct mpi_errhandler *h);

/* --- mpi_error.c: mpi_error returns `code` where the handler says so, else the run ends. mpi_fail
 * always ends it --- */
int mpi_error(struct mpi_rank *r, struct mpi_comm *c, int code, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
int mpi_error_handled(struct mpi_rank *r, void *object, struct mpi_errhandler *h, int code);
_Noreturn void mpi_fail(struct mpi_rank *r, const char *text);
int mpi_last_code(struct mpi_rank *r);
intptr_t mpi_call_program(struct mpi_rank *r, void *function, const intptr_t argument[6]);

/* --- mpi_type*.c, mpi_pack.c --- */
struct mpi_type *mpi_type_basic(const void *handle);
MPI_Datatype mpi_type_handle(const struct mpi_type *t);
bool mpi_type_is_basic(const struct mpi_type *t);
struct mpi_type *mpi_type_make(struct mpi_rank *r, int combiner, int npiece);
/* how far a type may reach [B]; beyond it the run ends by name */
#define MPI_TYPE_REACH (INT64_C(1) << 56)
int64_t mpi_type_bytes(int64_t a, int64_t b);
void mpi_type_finish(struct mpi_rank *r, struct mpi_type *t);
void mpi_type_remember(struct mpi_rank *r, struct mpi_type *t, int ninteger, int naddress,
                       int ntype);
int64_t mpi_count_at(struct mpi_counts c, int64_t i);
void mpi_pack_bytes(void *packed, const void *memory, int64_t n, const struct mpi_type *t);
void mpi_unpack_bytes(void *memory, const void *packed, int64_t bytes, int64_t n,
                      const struct mpi_type *t);
void mpi_charge_copy(struct mpi_rank *r, int64_t bytes);
int64_t mpi_copy_typed(struct mpi_rank *r, void *to, int64_t nto, const struct mpi_type *tto,
                       const void *from, int64_t nfrom, const struct mpi_type *tfrom);

/* --- mpi_group.c: world: rank of the world; find: the reverse, MPI_UNDEFINED --- */
int mpi_group_world(const struct mpi_group *g, int rank);
int mpi_group_find(struct mpi_rank *r, struct mpi_group *g, int world);
struct mpi_group *mpi_group_make(struct mpi_rank *r, const int *list, int n);
MPI_Group mpi_group_handle(struct mpi_group *g);
int mpi_groups_compare(struct mpi_rank *r, struct mpi_group *a, struct mpi_group *b);

/* --- mpi_comm.c, mpi_channel.c: make takes over the caller's use of g; split_of, first: NULL for
 * ranks left out --- */
MPI_Comm mpi_comm_handle(struct mpi_rank *r, const struct mpi_comm *c);
struct mpi_comm *mpi_comm_make(struct mpi_rank *r, struct mpi_group *g, int context,
                               struct mpi_comm *like);
struct mpi_comm *mpi_comm_split_of(struct mpi_rank *r, struct mpi_comm *c, int color, int key);
struct mpi_comm *mpi_comm_first(struct mpi_rank *r, struct mpi_comm *c, int n);
int mpi_context_agree(struct mpi_rank *r, struct mpi_channel *k, unsigned sequence);
int mpi_context_give(struct mpi_rank *r);
int mpi_context_of(struct mpi_rank *r, int given, int rank);
int64_t mpi_tag(int context, enum mpi_plane plane, int64_t tag);
void mpi_channel_make(struct mpi_channel *k, struct mpi_rank *r, struct mpi_group *g, int context,
                      enum mpi_plane plane);
int mpi_intercomm_part(struct mpi_rank *r, struct mpi_comm *c, struct mpi_group *g,
                       MPI_Comm *newcomm);
int mpi_intercomm_split(struct mpi_rank *r, struct mpi_comm *c, int color, int key,
                        MPI_Comm *newcomm);
int mpi_intercomm_dup(struct mpi_rank *r, struct mpi_comm *c, MPI_Comm *newcomm);
void mpi_topology_copy(struct mpi_rank *r, const struct mpi_comm *from, struct mpi_comm *to);
void mpi_topology_end(struct mpi_rank *r, struct mpi_comm *c);

/* --- mpi_op.c: an operation on elements of a type, as collectives.h wants it --- */
struct mpi_reduction {
    struct mpi_rank *self;
    struct mpi_op *op;
    struct mpi_type *type;
    int64_t offset;  /* [B] of an element's first byte */
    int64_t element; /* [B] from one element to the next where combine sees them */
    bool copied;     /* the type has gaps: algorithms work on copies */
    struct collective_op work;
};
void *mpi_reduction_copy(struct mpi_rank *r, const struct mpi_reduction *x, const void *memory,
                         int64_t n);
void mpi_reduction_back(struct mpi_rank *r, const struct mpi_reduction *x, void *memory,
                        const void *copy, int64_t n);
int mpi_reduction_make(struct mpi_rank *r, struct mpi_reduction *x, struct mpi_op *op,
                       struct mpi_type *t, struct mpi_comm *c);

/* --- mpi_collective.c --- */
void mpi_collective_tell(struct mpi_rank *r, struct mpi_channel *k, unsigned sequence, int *value);
void mpi_collective_allgather(struct mpi_rank *r, struct mpi_channel *k, unsigned sequence,
                              const void *own, void *all, int64_t bytes);
void mpi_collective_barrier(struct mpi_rank *r, struct mpi_comm *c, unsigned sequence);

/* --- mpi_attribute.c: object NULL: an error was reported before --- */
int mpi_keyval_make(struct mpi_rank *r, void *copy, void *remove, int *keyval, void *extra);
int mpi_keyval_end(struct mpi_rank *r, int *keyval);
int mpi_attribute_set(struct mpi_rank *r, enum mpi_kind kind, const void *object, int keyval,
                      void *value);
int mpi_attribute_get(struct mpi_rank *r, enum mpi_kind kind, const void *object, int keyval,
                      void *value, int *flag);
int mpi_attribute_delete(struct mpi_rank *r, enum mpi_kind kind, const void *object, int keyval);
int mpi_attributes_end(struct mpi_rank *r, enum mpi_kind kind, const void *object);
int mpi_attributes_copy(struct mpi_rank *r, enum mpi_kind kind, const void *from, const void *to);
const char *mpi_name_given(struct mpi_rank *r, enum mpi_kind kind, const void *object,
                           const char *else_);
void mpi_name_give(struct mpi_rank *r, enum mpi_kind kind, const void *object, const char *name);
int mpi_text_out(char *to, int capacity, const char *text, int *length);

/* --- mpi_window.c: attribute: one of the standard's, false: none of them --- */
bool mpi_window_attribute(struct mpi_window *w, int keyval, void *value);

#endif
