/* broadcast-mpi.c - a message from rank 0 to all others: by a binomial tree, or with the argument
 * "star" as a star. */
#include <mpi.h>
#include <stdlib.h>
#include <string.h>

enum { BYTES = @b@ };

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

int main(int argc, char **argv)
{
    static char message[BYTES];
    int me, p;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &p);
    if (me == 0) message[0] = 42;
    if (argc > 1 && strcmp(argv[1], "star") == 0) send_star(me, p, message);
    else send_tree(me, p, message);
    MPI_Finalize();
    /* Every rank must have the message. */
    return message[0] == 42 ? EXIT_SUCCESS : EXIT_FAILURE;
}
