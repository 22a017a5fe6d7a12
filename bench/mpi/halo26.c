/* halo26.c - an explicit step on a cube of ranks: faces, edges and corners to 26 neighbours, then
 * the smallest time step of all: an MPI program of the shape of LULESH. Usage: halo26 [N [STEPS]];
 * the number of ranks is a cube. Prints a sum, which is the same on every machine. */
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

static int n = 12, rank, size, side, place[3];
static double *e, *next;
static double *send[27], *recv[27];

static int at(int i, int j, int k) { return (k * n + j) * n + i; }

/* The neighbour in direction d of 27, MPI_PROC_NULL beyond the cube's surface. */
static int neighbour(int d)
{
    const int to[3] = {place[0] + d % 3 - 1, place[1] + d / 3 % 3 - 1, place[2] + d / 9 - 1};
    for (int a = 0; a < 3; a++)
        if (to[a] < 0 || to[a] == side) return MPI_PROC_NULL;
    return (to[2] * side + to[1]) * side + to[0];
}

/* How many points lie at the side that direction d looks at; their first and last index in a
 * dimension. */
static void range(int d, int from[3], int to[3])
{
    const int step[3] = {d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1};
    for (int a = 0; a < 3; a++) {
        from[a] = step[a] == 1 ? n - 1 : 0;
        to[a] = step[a] == -1 ? 0 : n - 1;
    }
}

static int pack(int d, double *out)
{
    int from[3], to[3], m = 0;
    range(d, from, to);
    for (int k = from[2]; k <= to[2]; k++)
        for (int j = from[1]; j <= to[1]; j++)
            for (int i = from[0]; i <= to[0]; i++) out[m++] = e[at(i, j, k)];
    return m;
}

/* What came from direction d is averaged into the points at that side. */
static void unpack(int d, const double *in)
{
    int from[3], to[3], m = 0;
    range(d, from, to);
    for (int k = from[2]; k <= to[2]; k++)
        for (int j = from[1]; j <= to[1]; j++)
            for (int i = from[0]; i <= to[0]; i++, m++)
                e[at(i, j, k)] = 0.5 * (e[at(i, j, k)] + in[m]);
}

static void exchange(void)
{
    MPI_Request q[52];
    int count[27], nq = 0;
    for (int d = 0; d < 27; d++) {
        count[d] = 0;
        if (d == 13 || neighbour(d) == MPI_PROC_NULL) continue;
        count[d] = pack(d, send[d]);
        MPI_Irecv(recv[d], count[d], MPI_DOUBLE, neighbour(d), 26 - d, MPI_COMM_WORLD, &q[nq++]);
    }
    for (int d = 0; d < 27; d++)
        if (count[d])
            MPI_Isend(send[d], count[d], MPI_DOUBLE, neighbour(d), d, MPI_COMM_WORLD, &q[nq++]);
    MPI_Waitall(nq, q, MPI_STATUSES_IGNORE);
    for (int d = 0; d < 27; d++)
        if (count[d]) unpack(d, recv[d]);
}

/* Work of the kind that hydrodynamics does in an element: divisions, a square root, neighbours. */
static double advance(double dt)
{
    double least = 1e30;
    for (int k = 0; k < n; k++)
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++) {
                const double here = e[at(i, j, k)], left = e[at(i ? i - 1 : i, j, k)],
                             right = e[at(i < n - 1 ? i + 1 : i, j, k)];
                const double flux = dt * (left - 2 * here + right) / (1 + here * here);
                next[at(i, j, k)] = here + flux;
                const double speed = __builtin_sqrt(1 + here * here);
                if (1 / speed < least) least = 1 / speed;
            }
    double *swap = e;
    e = next;
    next = swap;
    return least;
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    int steps = 20;
    if (argc > 1) n = atoi(argv[1]);
    if (argc > 2) steps = atoi(argv[2]);
    while (side * side * side < size) side++;
    if (side * side * side != size) {
        if (rank == 0) fprintf(stderr, "halo26: %d ranks are no cube\n", size);
        MPI_Abort(MPI_COMM_WORLD, 2);
    }
    place[0] = rank % side, place[1] = rank / side % side, place[2] = rank / side / side;
    const size_t points = (size_t)n * n * n;
    e = malloc(points * sizeof *e);
    next = malloc(points * sizeof *next);
    for (int d = 0; d < 27; d++)
        send[d] = malloc((size_t)n * n * sizeof(double)),
        recv[d] = malloc((size_t)n * n * sizeof(double));
    for (size_t i = 0; i < points; i++) e[i] = (double)((i + 31 * (size_t)rank) % 101) * 0.01;
    double dt = 0.1;
    for (int s = 0; s < steps; s++) {
        exchange();
        const double mine = advance(dt);
        MPI_Allreduce(&mine, &dt, 1, MPI_DOUBLE, MPI_MIN, MPI_COMM_WORLD);
        dt *= 0.1;
    }
    double sum = 0, all;
    for (size_t i = 0; i < points; i++) sum += e[i];
    MPI_Reduce(&sum, &all, 1, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank == 0) printf("halo26: %d ranks, %d^3 points each, sum %.9e\n", size, n, all);
    MPI_Finalize();
    return 0;
}
