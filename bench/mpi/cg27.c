/* cg27.c - conjugate gradients on a 27-point stencil, one slab of n x n x n points a rank: an MPI
 * program of the shape of HPCCG. Usage: cg27 [N [ITERATIONS]]
 *
 * Each rank holds its rows of the matrix and exchanges one plane with either neighbour in an
 * iteration; two dot products are all-reduced. Prints the residual, which is the same on every
 * machine. */
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int n = 12, rank, size;
static double *x, *b, *r, *p, *ap; /* p has a plane more at either end */

static int at(int i, int j, int k) { return (k * n + j) * n + i; }

/* The planes that the neighbours need, both ways at once. */
static void exchange(double *v)
{
    const int plane = n * n, last = n * plane;
    const int below = rank > 0 ? rank - 1 : MPI_PROC_NULL,
              above = rank + 1 < size ? rank + 1 : MPI_PROC_NULL;
    MPI_Request q[4];
    MPI_Irecv(v - plane, plane, MPI_DOUBLE, below, 1, MPI_COMM_WORLD, &q[0]);
    MPI_Irecv(v + last, plane, MPI_DOUBLE, above, 2, MPI_COMM_WORLD, &q[1]);
    MPI_Isend(v + last - plane, plane, MPI_DOUBLE, above, 1, MPI_COMM_WORLD, &q[2]);
    MPI_Isend(v, plane, MPI_DOUBLE, below, 2, MPI_COMM_WORLD, &q[3]);
    MPI_Waitall(4, q, MPI_STATUSES_IGNORE);
}

/* 27 on the diagonal, -1 for each of the neighbours within the domain. */
static void multiply(const double *v, double *out)
{
    for (int k = 0; k < n; k++)
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++) {
                double sum = 28 * v[at(i, j, k)];
                for (int dk = -1; dk <= 1; dk++) {
                    if ((k + dk < 0 && rank == 0) || (k + dk == n && rank == size - 1)) continue;
                    for (int dj = -1; dj <= 1; dj++) {
                        if (j + dj < 0 || j + dj == n) continue;
                        for (int di = -1; di <= 1; di++)
                            if (i + di >= 0 && i + di < n) sum -= v[at(i + di, j + dj, k + dk)];
                    }
                }
                out[at(i, j, k)] = sum;
            }
}

static double dot(const double *u, const double *v)
{
    double mine = 0, all;
    for (int i = 0; i < n * n * n; i++) mine += u[i] * v[i];
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return all;
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    int iterations = 30;
    if (argc > 1) n = atoi(argv[1]);
    if (argc > 2) iterations = atoi(argv[2]);
    const size_t points = (size_t)n * n * n, plane = (size_t)n * n;
    x = calloc(points, sizeof *x);
    b = malloc(points * sizeof *b);
    r = malloc(points * sizeof *r);
    ap = malloc(points * sizeof *ap);
    double *planes = calloc(points + 2 * plane, sizeof *planes);
    if (!x || !b || !r || !ap || !planes) MPI_Abort(MPI_COMM_WORLD, 1);
    p = planes + plane;
    for (size_t i = 0; i < points; i++) p[i] = r[i] = b[i] = 1 + 0.001 * (double)(i % 97);
    double rr = dot(r, r);
    const double first = rr;
    for (int k = 0; k < iterations; k++) {
        exchange(p);
        multiply(p, ap);
        const double alpha = rr / dot(p, ap);
        for (size_t i = 0; i < points; i++) x[i] += alpha * p[i], r[i] -= alpha * ap[i];
        const double next = dot(r, r), beta = next / rr;
        for (size_t i = 0; i < points; i++) p[i] = r[i] + beta * p[i];
        rr = next;
    }
    if (rank == 0)
        printf("cg27: %d ranks, %d^3 points each, residual %.6e\n", size, n, rr / first);
    MPI_Finalize();
    return 0;
}
