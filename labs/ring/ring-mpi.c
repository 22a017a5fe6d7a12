/* ring-mpi.c - a token goes once round a ring of ranks; every rank adds one to it. Two experiments
 * are ready to measure what the ring cannot tell: a train of messages, and a late receive.
 *
 *   ring-mpi [BYTES [ring|train|late]] */
#include <mpi.h>
#include <stdlib.h>
#include <string.h>
#ifdef __MIMDSIM__
#include <mimdsim/compute.h>
#else
#define mimdsim_compute(flops, bytes) ((void)0)
#endif

enum { MESSAGES_OF_TRAIN = 11, LATE_FLOPS = 100000 /* 1 ms on this machine */ };

static double token[1 << 16];
static int me, p, bytes = @b@;

static void ring(void)
{
    if (me == 0) {
        token[0] = 1;
        MPI_Send(token, bytes, MPI_BYTE, 1, 0, MPI_COMM_WORLD);
        MPI_Recv(token, bytes, MPI_BYTE, p - 1, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    } else {
        /* GAP: receive the token from the rank before, add one to token[0], and send it to the
         * rank behind. Behind the last rank comes rank 0. */
    }
}

/* Rank 0 sends 11 messages to rank 1, one after the other. */
static void train(void)
{
    for (int i = 0; i < MESSAGES_OF_TRAIN; i++) {
        if (me == 0) MPI_Send(token, bytes, MPI_BYTE, 1, 0, MPI_COMM_WORLD);
        if (me == 1) MPI_Recv(token, bytes, MPI_BYTE, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    }
}

/* Rank 1 computes for 1 ms; the message has been there for long when its receive begins. */
static void late(void)
{
    if (me == 0) MPI_Send(token, bytes, MPI_BYTE, 1, 0, MPI_COMM_WORLD);
    if (me == 1) {
        mimdsim_compute(LATE_FLOPS, 0);
        MPI_Recv(token, bytes, MPI_BYTE, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    }
}

int main(int argc, char **argv)
{
    const char *experiment = argc > 2 ? argv[2] : "ring";
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &p);
    if (argc > 1) bytes = atoi(argv[1]);
    if (bytes < 8 || bytes > (int)sizeof token) MPI_Abort(MPI_COMM_WORLD, 2);
    if (strcmp(experiment, "train") == 0) train();
    else if (strcmp(experiment, "late") == 0) late();
    else ring();
    MPI_Finalize();
    /* Every rank must have added its one. */
    if (strcmp(experiment, "ring") != 0) return EXIT_SUCCESS;
    return token[0] == (me == 0 ? p : me + 1) ? EXIT_SUCCESS : EXIT_FAILURE;
}
