/* mpi_cart.c - Cartesian topologies. Ranks are never reordered: places are counted with the last
 * dimension fastest.
 *
 * Section 8.5. A library may place ranks so that neighbours of the grid are near in the
 * machine (`reorder`); here the machine's placement decides that, so that a program's
 * ranks mean the same under every setting and a study of placements compares like with
 * like. */
#include <stdlib.h>

#include "mpi/mpi_topology.h"

int mpi_topo_test(struct mpi_rank *self, MPI_Comm comm, int *status)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    *status = c->topology ? c->topology->kind : MPI_UNDEFINED;
    return MPI_SUCCESS;
}

/* --- places --- */

/* Row-major order, as section 8.2 has it. In C the remainder of a negative number is
 * negative, hence the second step. */
int mpi_cart_rank_of(const struct mpi_topology *t, const int *coordinate)
{
    int rank = 0;
    for (int d = 0; d < t->ndim; d++) {
        int at = coordinate[d], n = t->dim[d];
        if (at < 0 || at >= n) {
            if (!t->period[d]) return MPI_PROC_NULL;
            at = (at % n + n) % n;
        }
        rank = rank * n + at;
    }
    return rank;
}

/* The inverse: the last dimension is the fastest. */
static void place_of(int ndim, const int *dim, int rank, int *coordinate)
{
    for (int d = ndim - 1; d >= 0; d--) {
        coordinate[d] = rank % dim[d];
        rank /= dim[d];
    }
}

/* One dimension changes, so the rank moves by the number of places that lie in one step
 * of it. Coordinates are not looked at again: halo exchanges call this once for each
 * neighbour. */
int mpi_cart_shifted(const struct mpi_topology *t, int d, int64_t by)
{
    int below = 1, n = t->dim[d], own = 0;
    int64_t at = t->coordinate[d] + by;
    if (at < 0 || at >= n) {
        if (!t->period[d]) return MPI_PROC_NULL;
        at = (at % n + n) % n;
    }
    for (int k = 0; k < t->ndim; k++) own = own * t->dim[k] + t->coordinate[k];
    for (int k = d + 1; k < t->ndim; k++) below *= t->dim[k];
    return own + (int)(at - t->coordinate[d]) * below;
}

/* --- making --- */

/* A grid may be smaller than the communicator, never larger (section 8.5.1). A product of
 * dimensions may pass even 64 bits before it is refused: then it stays at their largest. */
static int grid_size(struct mpi_rank *r, struct mpi_comm *c, int ndims, const int *dims,
                     int64_t *size)
{
    *size = 1;
    if (ndims < 0) return mpi_error(r, c, MPI_ERR_DIMS, "%d dimensions", ndims);
    for (int d = 0; d < ndims; d++) {
        if (dims[d] < 1)
            return mpi_error(r, c, MPI_ERR_DIMS, "dimension %d has %d places", d, dims[d]);
        if (__builtin_mul_overflow(*size, dims[d], size)) *size = INT64_MAX;
    }
    if (*size <= c->size) return MPI_SUCCESS;
    return mpi_error(r, c, MPI_ERR_TOPOLOGY, "a grid of %lld places for %d ranks", (long long)*size,
                     c->size);
}

/* Periods are kept as 0 or 1, whatever the program gives. One element more than needed: a
 * grid of no dimensions is legal and still needs an array. */
static struct mpi_topology *grid(struct mpi_rank *r, int ndims, const int *dims, const int *periods,
                                 int rank)
{
    struct mpi_topology *t = mpi_topology_take(r, MPI_CART);
    t->ndim = ndims;
    t->dim = mpi_topology_ints(r, dims, ndims);
    t->period = mpi_topology_ints(r, periods, ndims);
    t->coordinate = mpi_take_zero(r->world, (ndims + 1) * (int64_t)sizeof *t->coordinate);
    for (int d = 0; d < ndims; d++) t->period[d] = periods[d] != 0;
    place_of(ndims, dims, rank, t->coordinate);
    return t;
}

/* Ranks behind the grid get MPI_COMM_NULL, but take part in agreeing on the context: the
 * call is collective over the old communicator. */
int mpi_cart_create(struct mpi_rank *self, MPI_Comm comm_old, int ndims, const int dims[],
                    const int periods[], int reorder, MPI_Comm *comm_cart)
{
    struct mpi_comm *c = mpi_topology_base(self, comm_old);
    int64_t size;
    static const int nothing;
    (void)reorder;
    if (!c) return self->code;
    /* The program may pass NULL for arrays without elements, which grid() must not copy
     * from. */
    if (ndims == 0) dims = periods = &nothing;
    int code = grid_size(self, c, ndims, dims, &size);
    if (code != MPI_SUCCESS) return code;
    struct mpi_comm *made = mpi_comm_first(self, c, (int)size);
    *comm_cart = MPI_COMM_NULL;
    if (!made) return MPI_SUCCESS;
    made->topology = grid(self, ndims, dims, periods, made->rank);
    *comm_cart = mpi_handle(made);
    return MPI_SUCCESS;
}

int mpi_cart_sub(struct mpi_rank *self, MPI_Comm comm, const int remain_dims[], MPI_Comm *newcomm)
{
    struct mpi_comm *c;
    struct mpi_topology *t = mpi_topology_of(self, comm, MPI_CART, &c);
    if (!t) return self->code;
    /* Dropped dimensions say which part, remaining ones the place in it. MPI_Comm_split
     * does the rest (section 8.5.7): ranks with equal coordinates in all dropped
     * dimensions form one part, in row-major order of those that remain. */
    int color = 0, key = 0, n = 0;
    int *dims = mpi_take(self->world, 2 * (t->ndim + 1) * (int64_t)sizeof *dims),
        *periods = dims + t->ndim + 1;
    for (int d = 0; d < t->ndim; d++) {
        int *which = remain_dims[d] ? &key : &color;
        *which = *which * t->dim[d] + t->coordinate[d];
        if (!remain_dims[d]) continue;
        dims[n] = t->dim[d];
        periods[n++] = t->period[d];
    }
    struct mpi_comm *made = mpi_comm_split_of(self, c, color, key);
    made->topology = grid(self, n, dims, periods, made->rank);
    mpi_give(self->world, dims);
    *newcomm = mpi_handle(made);
    return MPI_SUCCESS;
}

/* --- queries --- */

int mpi_cartdim_get(struct mpi_rank *self, MPI_Comm comm, int *ndims)
{
    struct mpi_comm *c;
    struct mpi_topology *t = mpi_topology_of(self, comm, MPI_CART, &c);
    if (!t) return self->code;
    *ndims = t->ndim;
    return MPI_SUCCESS;
}

/* `maxdims` limits what is written, not what is known: fewer is no error. */
int mpi_cart_get(struct mpi_rank *self, MPI_Comm comm, int maxdims, int dims[], int periods[],
                 int coords[])
{
    struct mpi_comm *c;
    struct mpi_topology *t = mpi_topology_of(self, comm, MPI_CART, &c);
    if (!t) return self->code;
    for (int d = 0; d < t->ndim && d < maxdims; d++) {
        dims[d] = t->dim[d];
        periods[d] = t->period[d];
        coords[d] = t->coordinate[d];
    }
    return MPI_SUCCESS;
}

/* Coordinates outside of a dimension that is not periodic are erroneous (section 8.5.5),
 * unlike those of a shift, which lead to MPI_PROC_NULL. */
int mpi_cart_rank(struct mpi_rank *self, MPI_Comm comm, const int coords[], int *rank)
{
    struct mpi_comm *c;
    struct mpi_topology *t = mpi_topology_of(self, comm, MPI_CART, &c);
    if (!t) return self->code;
    *rank = mpi_cart_rank_of(t, coords);
    if (*rank != MPI_PROC_NULL) return MPI_SUCCESS;
    return mpi_error(self, c, MPI_ERR_ARG,
                     "the coordinates are outside of a dimension that is not periodic");
}

int mpi_cart_coords(struct mpi_rank *self, MPI_Comm comm, int rank, int maxdims, int coords[])
{
    struct mpi_comm *c;
    struct mpi_topology *t = mpi_topology_of(self, comm, MPI_CART, &c);
    if (!t) return self->code;
    if (rank < 0 || rank >= c->size)
        return mpi_error(self, c, MPI_ERR_RANK, "rank %d of %d", rank, c->size);
    if (maxdims < t->ndim)
        return mpi_error(self, c, MPI_ERR_ARG, "room for %d of %d dimensions", maxdims, t->ndim);
    place_of(t->ndim, t->dim, rank, coords);
    return MPI_SUCCESS;
}

/* Both directions from the own place. At an edge the rank is MPI_PROC_NULL, to which
 * messages go without effect, so that programs need no special case there. */
int mpi_cart_shift(struct mpi_rank *self, MPI_Comm comm, int direction, int disp, int *rank_source,
                   int *rank_dest)
{
    struct mpi_comm *c;
    struct mpi_topology *t = mpi_topology_of(self, comm, MPI_CART, &c);
    if (!t) return self->code;
    if (direction < 0 || direction >= t->ndim)
        return mpi_error(self, c, MPI_ERR_DIMS, "direction %d of %d dimensions", direction,
                         t->ndim);
    *rank_source = mpi_cart_shifted(t, direction, -(int64_t)disp);
    *rank_dest = mpi_cart_shifted(t, direction, disp);
    return MPI_SUCCESS;
}

/* What a good placement would be: the identity, as nothing is reordered. */
int mpi_cart_map(struct mpi_rank *self, MPI_Comm comm, int ndims, const int dims[],
                 const int periods[], int *newrank)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    int64_t size = 0;
    (void)periods;
    int code = c ? grid_size(self, c, ndims, dims, &size) : self->code;
    if (code == MPI_SUCCESS) *newrank = c->rank < size ? c->rank : MPI_UNDEFINED;
    return code;
}

/* --- balanced dimensions --- */

/* balance: the n free numbers with product `nodes`, as close to each other as they get, the largest
 * first. Each takes the smallest divisor of what is left that is not below the root of the number
 * of those still free. */
static bool balance(int nodes, int n, int *out);

/* Whether divisor `first` may be the largest of the n; *best is the last one that was tried.
 * Products are compared as doubles, exact far beyond any number of ranks. */
static bool is_largest(int nodes, int n, int first, int *best, int *out)
{
    double power = 1;
    for (int i = 0; i < n; i++) power *= first;
    if (power < nodes) return false;
    *best = first;
    return balance(nodes / first, n - 1, out + 1) && out[1] <= first;
}

static bool balance(int nodes, int n, int *out)
{
    int best = -1, step = 1;
    bool found = false;
    if (n == 0) return nodes == 1;
    if (n == 1) {
        out[0] = nodes;
        return true;
    }
    /* All divisors upwards: those up to the square root, then what they leave, so that a large
     * prime takes no longer than its root says. The last try is `nodes` itself with ones behind
     * it, so there is always an answer. */
    for (; !found && step <= nodes / step; step++)
        if (nodes % step == 0) found = is_largest(nodes, n, step, &best, out);
    for (step--; !found && step >= 1; step--)
        if (nodes % step == 0) found = is_largest(nodes, n, nodes / step, &best, out);
    out[0] = best;
    return true;
}

/* Dimensions that the program has set stay; what they leave is shared by the others, the
 * largest first (section 8.5.2). */
int mpi_dims_create(struct mpi_rank *self, int nnodes, int ndims, int dims[])
{
    int left = nnodes, n = 0;
    if (nnodes < 1 || ndims < 0)
        return mpi_error(self, NULL, MPI_ERR_DIMS, "%d nodes in %d dimensions", nnodes, ndims);
    for (int d = 0; d < ndims; d++) {
        if (dims[d] < 0)
            return mpi_error(self, NULL, MPI_ERR_DIMS, "dimension %d is %d", d, dims[d]);
        if (dims[d] > 0 && left % dims[d])
            return mpi_error(self, NULL, MPI_ERR_DIMS, "%d nodes do not make dimensions of %d",
                             nnodes, dims[d]);
        if (dims[d] > 0) left /= dims[d];
        else n++;
    }
    if (n == 0 && left != 1)
        return mpi_error(self, NULL, MPI_ERR_DIMS, "the dimensions do not have %d nodes together",
                         nnodes);
    /* The free dimensions get the numbers in order, so that they do not increase with the
     * index. */
    int *chosen = mpi_take(self->world, (n + 1) * (int64_t)sizeof *chosen), at = 0;
    balance(left, n, chosen);
    for (int d = 0; d < ndims; d++)
        if (dims[d] == 0) dims[d] = chosen[at++];
    mpi_give(self->world, chosen);
    return MPI_SUCCESS;
}
