/* dynamics-mpi.c - a tridiagonal system by parallel cyclic reduction, one row on each rank: the step
 * that gives the paper's forward dynamics its O(log n), here for rows of one number. */
#include <mpi.h>
#include <stdlib.h>
#ifdef __MIMDSIM__
#include <mimdsim/compute.h>
#else
#define mimdsim_compute(flops, bytes) ((void)0)
#endif

enum { MOST = 4096, LEVEL_FLOPS = @level@ };

/* low x(i-1) + middle x(i) + high x(i+1) = right: row i of the system, 4 numbers. */
struct row {
    double low, middle, high, right;
};

static struct row row_of(int i, int n)
{
    return (struct row){i > 0 ? -1 : 0, 4, i < n - 1 ? -1 : 0, 1 + i % 5};
}

/* `own`, with the unknowns before and behind it eliminated by the rows that have them in the middle:
 * what is left couples it to the unknowns twice as far away. */
static struct row eliminate(struct row own, struct row below, struct row above)
{
    const double f = own.low / below.middle, g = own.high / above.middle;
    return (struct row){-f * below.low, own.middle - f * below.high - g * above.low,
                        -g * above.high, own.right - f * below.right - g * above.right};
}

/* Whether x is unknown number `me` of n, by Gaussian elimination without pivots, and back. */
static int is_right(double x, int me, int n)
{
    static struct row row[MOST];
    double next = 0, error = 1;
    for (int i = 0; i < n; i++) {
        row[i] = row_of(i, n);
        if (i == 0) continue;
        const double f = row[i].low / row[i - 1].middle;
        row[i].middle -= f * row[i - 1].high;
        row[i].right -= f * row[i - 1].right;
    }
    for (int i = n - 1; i >= me; i--) {
        next = (row[i].right - row[i].high * next) / row[i].middle;
        if (i == me) error = next - x;
    }
    return error < 1e-12 && error > -1e-12;
}

int main(int argc, char **argv)
{
    int me, p;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &p);
    if (p > MOST) MPI_Abort(MPI_COMM_WORLD, 2);
    struct row own = row_of(me, p);
    for (int d = 1; d < p; d *= 2) {
        /* A row outside the system changes nothing. */
        struct row below = {0, 1, 0, 0}, above = {0, 1, 0, 0};
        /* GAP: send the own row (4 numbers, tag d) first to rank me + d, then to rank me - d, as far
         * as there are such ranks; then receive `below` from rank me - d and `above` from rank
         * me + d. Messages that small are buffered: MPI_Send does not wait. */
        own = eliminate(own, below, above);
        mimdsim_compute(LEVEL_FLOPS, 0);
    }
    MPI_Finalize();
    return is_right(own.right / own.middle, me, p) ? EXIT_SUCCESS : EXIT_FAILURE;
}
