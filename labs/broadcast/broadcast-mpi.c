/* broadcast-mpi.c - a message from rank 0 to all others: by a binomial tree, or with the argument
 * "star" as a star, or with a number as a pipeline of so many segments.
 *
 *   broadcast-mpi [tree|star|SEGMENTS] */
#include <mpi.h>
#include <stdlib.h>
#include <string.h>

enum { BYTES = @b@, LONG = @B@ };

static void send_star(int me, int p, char *message)
{
    for (int to = 1; me == 0 && to < p; to++)
        MPI_Send(message, BYTES, MPI_BYTE, to, 0, MPI_COMM_WORLD);
    if (me != 0) MPI_Recv(message, BYTES, MPI_BYTE, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

static void send_tree(int me, int p, char *message)
{
    (void)me, (void)p, (void)message;
    /* GAP: receive the message from the rank below that has it first, and send it to the ranks
     * 1, 2, 4, ... above that do not have it yet. Rank 5 (binary 101) receives from rank 1, and
     * sends to ranks 5 + 8, 5 + 16, ... as far as there are ranks. */
}

/* The long message along the chain 0, 1, 2, ... in `segments` pieces of equal length. */
static void send_pipeline(int me, int p, char *message, int segments)
{
    const int m = LONG / segments;
    (void)me, (void)p, (void)message, (void)m;
    /* GAP: one piece after the other, of m bytes from message + i * m on: receive it from the rank
     * before, and send it to the rank behind at once. The first rank receives nothing, the last one
     * sends nothing. */
}

int main(int argc, char **argv)
{
    static char message[LONG];
    const char *way = argc > 1 ? argv[1] : "tree";
    const int segments = atoi(way);
    int me, p, last = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &p);
    if (segments > 0) last = LONG - 1;
    if (me == 0) message[0] = message[last] = 42;
    if (strcmp(way, "star") == 0) send_star(me, p, message);
    else if (segments > 0) send_pipeline(me, p, message, segments);
    else send_tree(me, p, message);
    MPI_Finalize();
    /* Every rank must have the whole message. */
    return message[0] == 42 && message[last] == 42 ? EXIT_SUCCESS : EXIT_FAILURE;
}
