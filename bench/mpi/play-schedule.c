/* play-schedule.c - an MPI program that makes the messages and computing times of a schedule:
 * SMPI's part of bench/compare-peers.sh.
 *
 *   play-schedule OPERATIONS OFFSETS
 *
 * OPERATIONS: per rank lines "c PICOSECONDS", "s BYTES TO TAG", "r BYTES FROM TAG" and "e".
 * OFFSETS: where each rank's lines begin, 16 bytes a rank, so that no process reads what is not its
 * own. A host computes 10^12 operations a second, so that a picosecond is an operation. */
#include <mpi.h>
#include <smpi/smpi.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    int rank;
    char line[96];
    static char data[1 << 20]; /* one for all ranks of a process: nobody looks at it */
    long sent = 0, all = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    FILE *f = fopen(argv[2], "r");
    if (!f || fseek(f, 16L * rank, SEEK_SET) != 0 || !fgets(line, sizeof line, f)) return 1;
    const long from = atol(line);
    fclose(f);
    f = fopen(argv[1], "r");
    if (!f || fseek(f, from, SEEK_SET) != 0) return 1;
    while (fgets(line, sizeof line, f) && line[0] != 'e') {
        double time;
        int bytes, other, tag;
        if (sscanf(line, "c %lf", &time) == 1) {
            smpi_execute_flops(time);
        } else if (sscanf(line, "s %d %d %d", &bytes, &other, &tag) == 3) {
            MPI_Send(data, bytes, MPI_BYTE, other, tag, MPI_COMM_WORLD);
            sent++;
        } else if (sscanf(line, "r %d %d %d", &bytes, &other, &tag) == 3) {
            MPI_Recv(data, bytes, MPI_BYTE, other, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        }
    }
    fclose(f);
    MPI_Reduce(&sent, &all, 1, MPI_LONG, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank == 0) printf("messages %ld\n", all);
    MPI_Finalize();
    return 0;
}
