/* mpi_request.h - messages and requests: from arguments to comm.h, waiting, and operations in
 * progress. */
#ifndef MPI_MPI_REQUEST_H
#define MPI_MPI_REQUEST_H

/* --- mpi_message.c: check: arguments into *q; begin: send or post; finish: unpack and tell;
 * status: tell alone --- */
struct mpi_message {
    enum mpi_mode mode;
    bool receive;
    const void *buffer;
    MPI_Count count;
    MPI_Datatype type;
    int peer, tag;
    MPI_Comm comm;
};
int mpi_message_check(struct mpi_rank *r, struct mpi_request *q, struct mpi_message m);
int mpi_message_begin(struct mpi_rank *r, struct mpi_request *q);
void mpi_message_status(struct mpi_rank *r, const struct mpi_request *q, MPI_Status *status);
int mpi_message_finish(struct mpi_rank *r, struct mpi_request *q, MPI_Status *status);
void *mpi_receive_room(struct mpi_rank *r, struct mpi_request *q);
void mpi_status_set(MPI_Status *s, int source, int tag, int64_t bytes);
void mpi_status_empty(MPI_Status *s);

/* --- mpi_buffered.c: room for a message of MPI_Bsend, sent by the request returned, NULL: none;
 * drain: wait until all of a list have left --- */
struct comm_request *mpi_buffer_room(struct mpi_rank *r, struct mpi_comm *c, int64_t bytes);
void mpi_buffer_drain(struct mpi_rank *r, struct mpi_buffered **list);

/* --- mpi_request.c, mpi_wait.c: poll: the first that is ready after a look, -1 --- */
struct mpi_request *mpi_request_make(struct mpi_rank *r, enum mpi_request_kind what);
int mpi_request_start(struct mpi_rank *r, const struct mpi_request *checked,
                      struct mpi_start start);
int mpi_request_task(struct mpi_rank *r, struct mpi_comm *c, mpi_task_fn *run, const void *argument,
                     int64_t bytes, int64_t status_at, struct mpi_start start);
void mpi_request_release(struct mpi_rank *r, MPI_Request request,
                         void (*release)(struct mpi_rank *r, void *argument));
MPI_Request mpi_request_nothing(struct mpi_rank *r);
bool mpi_request_ready(const struct mpi_request *q);
int mpi_request_finish(struct mpi_rank *r, struct mpi_request *q, MPI_Request *request,
                       MPI_Status *status);
int mpi_poll(struct mpi_rank *r, int n, struct mpi_request *const *q);

/* --- mpi_task.c: progress: the index of a wanted request that is complete, or what else happened
 * --- */
enum { PROGRESS_TASK = -1, PROGRESS_NONE = -2 };
struct mpi_task *mpi_task_start(struct mpi_rank *r, mpi_task_fn *run, void *argument);
int mpi_progress(struct mpi_rank *r, int nwanted, struct comm_request *const *wanted, bool block);
void mpi_wait_request(struct mpi_rank *r, struct comm_request *q);
void mpi_task_go_on(struct mpi_rank *r, struct mpi_task *t);
void mpi_wait_task(struct mpi_rank *r, const struct mpi_task *t);
void mpi_poll_tasks(struct mpi_rank *r);
void mpi_tasks_end(struct mpi_world *w);

#endif
