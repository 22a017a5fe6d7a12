/* stencil-mpi.c - Jacobi's iteration on a square grid of N by N points, in strips of rows. With the
 * argument "unchecked" the result is not compared with that of one processor. */
#include <math.h>
#include <mpi.h>
#include <stdlib.h>
#include <string.h>

enum { N = @n@, STEPS = @steps@ };

static double begin(int i, int j) { return (i * 31 + j * 17) % 97; }

/* Rows first .. last - 1 of a strip: each inner point becomes the mean of its four neighbours. */
static void relax(const double *from, double *to, int first, int last)
{
    for (int i = first; i < last; i++)
        for (int j = 1; j < N - 1; j++)
            to[i * N + j] = 0.25 * (from[(i - 1) * N + j] + from[(i + 1) * N + j] +
                                    from[i * N + j - 1] + from[i * N + j + 1]);
}

/* The strip of rows first .. first + m - 1, with a row more on each side; the edge of the grid
 * stays. */
static void fill(double *x, int first, int m)
{
    for (int i = -1; i <= m; i++)
        for (int j = 0; j < N; j++) x[(i + 1) * N + j] = begin(first + i, j);
}

/* Whether rows first .. first + m - 1 are those that one processor computes. */
static int is_right(const double *x, int first, int m)
{
    double *from = malloc((N + 2) * N * sizeof *from), *to = malloc((N + 2) * N * sizeof *to);
    double error = 0;
    fill(from, 0, N);
    fill(to, 0, N);
    for (int s = 0; s < STEPS; s++) {
        relax(from, to, 2, N);
        memcpy(from, to, (N + 2) * N * sizeof *from);
    }
    for (int i = 0; i < m * N; i++)
        error = fmax(error, fabs(x[N + i] - from[(first + 1) * N + i]));
    free(from);
    free(to);
    return error < 1e-11;
}

int main(int argc, char **argv)
{
    int me, p;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &p);
    const int first = N * me / p, m = N * (me + 1) / p - first;
    double *x = malloc((size_t)(m + 2) * N * sizeof *x), *y = malloc((size_t)(m + 2) * N * sizeof *y);
    fill(x, first, m);
    fill(y, first, m);
    /* Rows 1 .. m are the own ones; the first and last row of the grid are never computed. */
    const int low = me == 0 ? 2 : 1, high = me == p - 1 ? m : m + 1;
    for (int s = 0; s < STEPS; s++) {
        MPI_Request r[4] = {MPI_REQUEST_NULL, MPI_REQUEST_NULL, MPI_REQUEST_NULL, MPI_REQUEST_NULL};
        /* GAP: begin to receive both neighbours' rows (MPI_Irecv into r[0], r[1]; row 0 of x is the
         * upper neighbour's, row m + 1 the lower one's), and to send the own first and last row
         * (rows 1 and m; MPI_Isend into r[2], r[3]). The first rank has no upper neighbour, the
         * last one no lower neighbour. */
        relax(x, y, 2, m);
        MPI_Waitall(4, r, MPI_STATUSES_IGNORE);
        if (low == 1) relax(x, y, 1, high < 2 ? high : 2);
        if (high == m + 1 && m > 1) relax(x, y, m, m + 1);
        double *t = x;
        x = y;
        y = t;
    }
    MPI_Finalize();
    const int right = (argc > 1 && strcmp(argv[1], "unchecked") == 0) || is_right(x, first, m);
    free(x);
    free(y);
    return right ? EXIT_SUCCESS : EXIT_FAILURE;
}
