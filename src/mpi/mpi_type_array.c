/* mpi_type_array.c - parts of arrays as datatypes: subarrays, and what a rank has of a distributed
 * array.
 *
 * Both are built from the fastest dimension outwards: runs of indices of a dimension are pieces of
 * the type below it, and the extent is that of the whole dimension.
 *
 * Sections 5.1.3 and 5.1.4 of MPI 5.0. The standard defines both dimension by dimension, too. */
#include "mpi/mpi_internal.h"

/* Indices first .. first + length - 1, count times, each `stride` further; then a shorter rest. */
struct runs {
    int64_t first, length, count, stride, rest_first, rest;
};

/* dimension: `of` over the runs of a dimension of `whole` indices. The caller's use of `of` goes
 * over to the result. */
static struct mpi_type *dimension(struct mpi_rank *r, struct mpi_type *of, int64_t whole,
                                  const struct runs *x)
{
    struct mpi_type *t = mpi_type_make(r, MPI_COMBINER_RESIZED, 2);
    t->piece[0] = (struct mpi_piece){
        .at = mpi_type_bytes(x->first, of->extent),
        .count = x->count,
        .length = x->length,
        .of = of};
    t->piece[0].stride = mpi_type_bytes(x->stride, of->extent);
    t->piece[1] = (struct mpi_piece){
        .at = mpi_type_bytes(x->rest_first, of->extent), .count = 1, .length = x->rest, .of = of};
    mpi_type_finish(r, t);
    /* Finishing set the bounds by what is there; a part of an array has those of the
     * whole, so that the next dimension, or the next element, lies behind all of it. */
    t->lb = 0;
    t->marked = true;
    t->dense = of->dense && x->first == 0 && x->count == 1 && x->length == whole;
    t->extent = mpi_type_bytes(whole, of->extent);
    mpi_type_remember(r, t, 0, 0, 1);
    t->type[0] = of;
    return t;
}

/* outermost: the last dimension's type gets the caller's combiner and arguments in place of its
 * own. */
static int outermost(struct mpi_rank *r, struct mpi_type *t, struct mpi_type *of, int combiner,
                     int ninteger, MPI_Datatype *newtype)
{
    /* Attributes, names and contents belong to what the program made, which is one type
     * and not a type for each dimension. */
    struct mpi_type *whole = mpi_type_make(r, combiner, 1);
    whole->piece[0] = (struct mpi_piece){.count = 1, .length = 1, .of = t};
    mpi_type_finish(r, whole);
    whole->lb = t->lb;
    whole->extent = t->extent;
    whole->dense = t->dense;
    /* the first is what the program is told of, the second keeps the pieces */
    mpi_type_remember(r, whole, ninteger, 0, 2);
    whole->type[0] = of;
    whole->type[1] = t;
    mpi_type_use(of);
    *newtype = mpi_handle(whole);
    return MPI_SUCCESS;
}

/* The order of memory says which dimension is the fastest: the last in C, the first in
 * Fortran. */
int mpi_type_create_subarray(struct mpi_rank *self, int ndims, struct mpi_counts array_of_sizes,
                             struct mpi_counts array_of_subsizes, struct mpi_counts array_of_starts,
                             int order, MPI_Datatype oldtype, MPI_Datatype *newtype)
{
    struct mpi_type *of = mpi_type_of(self, oldtype), *t = of;
    if (!of) return self->code;
    if (ndims < 1) return mpi_error(self, NULL, MPI_ERR_DIMS, "an array of %d dimensions", ndims);
    if (order != MPI_ORDER_C && order != MPI_ORDER_FORTRAN)
        return mpi_error(self, NULL, MPI_ERR_ARG,
                         "order %d is neither MPI_ORDER_C nor MPI_ORDER_FORTRAN", order);
    for (int d = 0; d < ndims; d++) {
        int64_t size = mpi_count_at(array_of_sizes, d), part = mpi_count_at(array_of_subsizes, d);
        int64_t start = mpi_count_at(array_of_starts, d);
        if (size < 1 || part < 1 || start < 0 || start > size - part)
            return mpi_error(self, NULL, MPI_ERR_ARG,
                             "dimension %d: %lld from %lld on is not within 0 .. %lld", d,
                             (long long)part, (long long)start, (long long)size - 1);
    }
    /* dimension() passes this use on from type to type. */
    mpi_type_use(of);
    for (int i = 0; i < ndims; i++) {
        int d = order == MPI_ORDER_C ? ndims - 1 - i : i;
        struct runs x = {.first = mpi_count_at(array_of_starts, d),
                         .length = mpi_count_at(array_of_subsizes, d)};
        x.count = 1;
        t = dimension(self, t, mpi_count_at(array_of_sizes, d), &x);
    }
    int code = outermost(self, t, of, MPI_COMBINER_SUBARRAY, 3 * ndims + 2, newtype);
    struct mpi_type *made = mpi_type_of(self, *newtype);
    /* The program's arguments in the order of section 5.1.13. */
    made->integer[0] = ndims;
    for (int d = 0; d < ndims; d++) {
        made->integer[1 + d] = mpi_count_at(array_of_sizes, d);
        made->integer[1 + ndims + d] = mpi_count_at(array_of_subsizes, d);
        made->integer[1 + 2 * ndims + d] = mpi_count_at(array_of_starts, d);
    }
    made->integer[1 + 3 * ndims] = order;
    return code;
}

/* What process `p` of n has of g indices dealt out in blocks of b, round and round.
 * Blocks p, p + n, p + 2 n, ... belong to p; the last one of all may be shorter. */
static struct runs dealt(int64_t g, int64_t b, int p, int n)
{
    struct runs x = {.first = p * b, .length = b, .stride = n * b};
    for (int64_t at = x.first; at < g; at += x.stride) {
        if (at + b <= g) x.count++;
        else x.rest_first = at, x.rest = g - at;
    }
    return x;
}

/* The block of a distribution's argument; 0: the two do not fit together. Section 5.1.4:
 * by default, blocks are as large as they must be for one each, and cycles have blocks of
 * one. */
static int64_t block_of(int distribution, int argument, int64_t g, int n)
{
    if (distribution == MPI_DISTRIBUTE_NONE) return n == 1 ? g : 0;
    if (distribution == MPI_DISTRIBUTE_BLOCK) {
        int64_t b = argument == MPI_DISTRIBUTE_DFLT_DARG ? (g + n - 1) / n : argument;
        return b * n >= g ? b : 0;
    }
    if (distribution != MPI_DISTRIBUTE_CYCLIC) return 0;
    return argument == MPI_DISTRIBUTE_DFLT_DARG ? 1 : argument;
}

int mpi_type_create_darray(struct mpi_rank *self, int size, int rank, int ndims,
                           struct mpi_counts array_of_gsizes, const int array_of_distribs[],
                           const int array_of_dargs[], const int array_of_psizes[], int order,
                           MPI_Datatype oldtype, MPI_Datatype *newtype)
{
    struct mpi_type *of = mpi_type_of(self, oldtype), *t = of;
    if (!of) return self->code;
    /* A grid of another size than that of the processes fits nobody. */
    int64_t grid = 1;
    bool fits = ndims > 0;
    for (int d = 0; d < ndims; d++) {
        fits = fits && array_of_psizes[d] > 0 && mpi_count_at(array_of_gsizes, d) > 0;
        if (__builtin_mul_overflow(grid, array_of_psizes[d], &grid)) fits = false;
    }
    if (order != MPI_ORDER_C && order != MPI_ORDER_FORTRAN)
        return mpi_error(self, NULL, MPI_ERR_ARG,
                         "order %d is neither MPI_ORDER_C nor MPI_ORDER_FORTRAN", order);
    if (!fits || grid != size || rank < 0 || rank >= size)
        return mpi_error(self, NULL, MPI_ERR_ARG, "rank %d in a grid of %lld processes of %d", rank,
                         (long long)grid, size);
    mpi_type_use(of);
    /* The grid of processes is in C's order whatever the array's. `below` counts the
     * processes in one step of dimension d. */
    for (int i = 0; i < ndims; i++) {
        int d = order == MPI_ORDER_C ? ndims - 1 - i : i, below = 1;
        for (int k = d + 1; k < ndims; k++) below *= array_of_psizes[k];
        int64_t g = mpi_count_at(array_of_gsizes, d);
        int64_t b = block_of(array_of_distribs[d], array_of_dargs[d], g, array_of_psizes[d]);
        if (b < 1) {
            mpi_type_drop(self, t);
            return mpi_error(self, NULL, MPI_ERR_ARG,
                             "dimension %d: distribution %d with argument %d", d,
                             array_of_distribs[d], array_of_dargs[d]);
        }
        struct runs x = dealt(g, b, rank / below % array_of_psizes[d], array_of_psizes[d]);
        t = dimension(self, t, g, &x);
    }
    int code = outermost(self, t, of, MPI_COMBINER_DARRAY, 4 * ndims + 4, newtype);
    MPI_Count *integer = mpi_type_of(self, *newtype)->integer;
    integer[0] = size, integer[1] = rank, integer[2] = ndims, integer[3 + 4 * ndims] = order;
    for (int d = 0; d < ndims; d++) {
        integer[3 + d] = mpi_count_at(array_of_gsizes, d);
        integer[3 + ndims + d] = array_of_distribs[d];
        integer[3 + 2 * ndims + d] = array_of_dargs[d];
        integer[3 + 3 * ndims + d] = array_of_psizes[d];
    }
    return code;
}
