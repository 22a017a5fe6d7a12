/* test_mpi_topology.c - grids and graphs against plain models: coordinates counted one by one,
 * shifts by walking, balanced dimensions by trying all, edges from matrices; and what is refused.
 */
#include <limits.h>

#include "mpi_world.h"

static void return_errors(void) { MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN); }

/* --- grids --- */

struct shape {
    int ndim, dim[4], period[4], size;
};

/* The rank at coordinates by the standard's order, -1 outside. */
static int model_rank(const struct shape *g, const int *at)
{
    int rank = 0;
    for (int d = 0; d < g->ndim; d++) {
        int x = at[d];
        while (g->period[d] && x < 0) x += g->dim[d];
        while (g->period[d] && x >= g->dim[d]) x -= g->dim[d];
        if (x < 0 || x >= g->dim[d]) return -1;
        rank = rank * g->dim[d] + x;
    }
    return rank;
}

/* Coordinates of the rank by counting up from 0. */
static void model_place(const struct shape *g, int rank, int *at)
{
    for (int d = 0; d < g->ndim; d++) at[d] = 0;
    for (; rank > 0; rank--)
        for (int d = g->ndim - 1; d >= 0; d--) {
            if (++at[d] < g->dim[d]) break;
            at[d] = 0;
        }
}

static const struct shape shapes[] = {
    {1, {12}, {0}, 12},
    {1, {12}, {1}, 12},
    {1, {1}, {1}, 1},
    {2, {3, 4}, {1, 0}, 12},
    {2, {4, 3}, {0, 0}, 12},
    {2, {5, 2}, {1, 1}, 10},
    {3, {2, 3, 2}, {0, 1, 1}, 12},
    {3, {1, 11, 1}, {1, 0, 1}, 11},
    {4, {2, 1, 2, 3}, {1, 1, 0, 0}, 12},
    {0, {0}, {0}, 1},
};
enum { SHAPES = sizeof shapes / sizeof *shapes };

static void check_shape(MPI_Comm cart, const struct shape *g)
{
    int at[4], found[4], dims[4], periods[4], rank, size, n, kind;
    MPI_Comm_rank(cart, &rank);
    MPI_Comm_size(cart, &size);
    assert_int_equal(size, g->size);
    MPI_Topo_test(cart, &kind);
    assert_int_equal(kind, MPI_CART);
    MPI_Cartdim_get(cart, &n);
    assert_int_equal(n, g->ndim);
    /* all places there and back */
    for (int r = 0; r < size; r++) {
        model_place(g, r, at);
        assert_int_equal(MPI_Cart_coords(cart, r, 4, found), MPI_SUCCESS);
        assert_memory_equal(found, at, sizeof(int) * (size_t)g->ndim);
        assert_int_equal(MPI_Cart_rank(cart, at, &n), MPI_SUCCESS);
        assert_int_equal(n, r);
    }
    model_place(g, rank, at);
    MPI_Cart_get(cart, 4, dims, periods, found);
    assert_memory_equal(found, at, sizeof(int) * (size_t)g->ndim);
    assert_memory_equal(dims, g->dim, sizeof(int) * (size_t)g->ndim);
    assert_memory_equal(periods, g->period, sizeof(int) * (size_t)g->ndim);
    /* every shift up to twice around, and places far outside */
    for (int d = 0; d < g->ndim; d++)
        for (int by = -2 * g->dim[d] - 1; by <= 2 * g->dim[d] + 1; by++) {
            int from, to, other[4];
            memcpy(other, at, sizeof other);
            assert_int_equal(MPI_Cart_shift(cart, d, by, &from, &to), MPI_SUCCESS);
            other[d] = at[d] + by;
            const int there = model_rank(g, other);
            assert_int_equal(to, there < 0 ? MPI_PROC_NULL : there);
            assert_int_equal(MPI_Cart_rank(cart, other, &n), there < 0 ? MPI_ERR_ARG : MPI_SUCCESS);
            if (there >= 0) assert_int_equal(n, there);
            other[d] = at[d] - by;
            const int back = model_rank(g, other);
            assert_int_equal(from, back < 0 ? MPI_PROC_NULL : back);
        }
}

static void grids(void *context)
{
    (void)context;
    return_errors();
    for (int k = 0; k < SHAPES; k++) {
        MPI_Comm cart, copy;
        int mapped;
        MPI_Cart_map(MPI_COMM_WORLD, shapes[k].ndim, shapes[k].dim, shapes[k].period, &mapped);
        assert_int_equal(mapped, own_rank() < shapes[k].size ? own_rank() : MPI_UNDEFINED);
        MPI_Cart_create(MPI_COMM_WORLD, shapes[k].ndim, shapes[k].dim, shapes[k].period, k % 2,
                        &cart);
        assert_true((cart == MPI_COMM_NULL) == (own_rank() >= shapes[k].size));
        if (cart == MPI_COMM_NULL) continue;
        check_shape(cart, &shapes[k]);
        /* a duplicate has a topology of its own */
        MPI_Comm_dup(cart, &copy);
        MPI_Comm_free(&cart);
        check_shape(copy, &shapes[k]);
        MPI_Comm_free(&copy);
    }
}

static void grids_are_those_of_the_model(void **state)
{
    (void)state;
    mpi_ok(12, grids, NULL);
}

/* All ways to keep dimensions of a 2 x 3 x 2 grid: the part is a grid of those kept, at the same
 * coordinates, and its ranks are those that differ in them alone. */
static void parts(void *context)
{
    const struct shape *g = &shapes[6];
    MPI_Comm cart, part;
    int at[4];
    (void)context;
    return_errors();
    MPI_Cart_create(MPI_COMM_WORLD, 3, g->dim, g->period, 0, &cart);
    model_place(g, own_rank(), at);
    for (int keep = 0; keep < 8; keep++) {
        struct shape p = {.size = 1};
        int remain[3], here[4] = {0}, found[4], rank, sum = own_rank(), expected = 0;
        for (int d = 0; d < 3; d++) {
            remain[d] = keep >> d & 1 ? 5 : 0; /* any number but 0 keeps */
            if (!remain[d]) continue;
            p.dim[p.ndim] = g->dim[d], p.period[p.ndim] = g->period[d], here[p.ndim] = at[d];
            p.ndim++, p.size *= g->dim[d];
        }
        MPI_Cart_sub(cart, remain, &part);
        check_shape(part, &p);
        MPI_Comm_rank(part, &rank);
        MPI_Cart_coords(part, rank, 4, found);
        assert_memory_equal(found, here, sizeof(int) * (size_t)p.ndim);
        for (int r = 0; r < 12; r++) {
            int other[4], same = 1;
            model_place(g, r, other);
            for (int d = 0; d < 3; d++) same &= remain[d] || other[d] == at[d];
            expected += same * r;
        }
        MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_INT, MPI_SUM, part);
        assert_int_equal(sum, expected);
        MPI_Comm_free(&part);
    }
    MPI_Comm_free(&cart);
}

static void parts_of_grids_are_grids(void **state)
{
    (void)state;
    mpi_ok(12, parts, NULL);
}

static void short_arrays(void *context)
{
    MPI_Comm cart;
    int dims[3] = {-7, -7, -7}, periods[3] = {-7, -7, -7}, at[3] = {-7, -7, -7};
    (void)context;
    return_errors();
    MPI_Cart_create(MPI_COMM_WORLD, 2, (int[]){2, 1}, (int[]){-3, 0}, 0, &cart);
    /* fewer than there are is no error for the grid's own data, and nothing more is written */
    assert_int_equal(MPI_Cart_get(cart, 1, dims, periods, at), MPI_SUCCESS);
    assert_true(dims[0] == 2 && dims[1] == -7 && periods[0] == 1 && periods[1] == -7);
    assert_true(at[0] == own_rank() && at[1] == -7);
    assert_int_equal(MPI_Cart_coords(cart, 0, 1, at), MPI_ERR_ARG);
    assert_int_equal(MPI_Cart_coords(cart, 2, 2, at), MPI_ERR_RANK);
    assert_int_equal(MPI_Cart_coords(cart, -1, 2, at), MPI_ERR_RANK);
    MPI_Comm_free(&cart);
}

/* Both halves of the world and the communicator between them. */
static MPI_Comm between(void)
{
    MPI_Comm half, inter;
    MPI_Comm_split(MPI_COMM_WORLD, own_rank() % 2, 0, &half);
    MPI_Intercomm_create(half, 0, MPI_COMM_WORLD, 1 - own_rank() % 2, 3, &inter);
    MPI_Comm_free(&half);
    return inter;
}

static void refusals(void *context)
{
    static const struct {
        int ndim, dim[3], class;
    } row[] = {
        {-1, {1}, MPI_ERR_DIMS},
        {1, {0}, MPI_ERR_DIMS},
        {2, {2, -1}, MPI_ERR_DIMS},
        {1, {3}, MPI_ERR_TOPOLOGY},
        {2, {2, 2}, MPI_ERR_TOPOLOGY},
        {2, {1 << 16, 1 << 16}, MPI_ERR_TOPOLOGY},
        {3, {1 << 30, 1 << 30, 1 << 4}, MPI_ERR_TOPOLOGY},
        {3, {INT_MAX, INT_MAX, INT_MAX}, MPI_ERR_TOPOLOGY},
    };
    MPI_Comm cart;
    int x, periods[3] = {0, 0, 0};
    (void)context;
    return_errors();
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        assert_int_equal(
            MPI_Cart_create(MPI_COMM_WORLD, row[k].ndim, row[k].dim, periods, 0, &cart),
            row[k].class);
        assert_int_equal(MPI_Cart_map(MPI_COMM_WORLD, row[k].ndim, row[k].dim, periods, &x),
                         row[k].class);
    }
}

/* What needs a topology, where there is none. */
static void no_topology(void *context)
{
    MPI_Comm cart;
    int x = 0, y, kind;
    (void)context;
    return_errors();
    MPI_Topo_test(MPI_COMM_WORLD, &kind);
    assert_int_equal(kind, MPI_UNDEFINED);
    assert_int_equal(MPI_Cartdim_get(MPI_COMM_WORLD, &x), MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Cart_get(MPI_COMM_WORLD, 0, &x, &x, &x), MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Cart_rank(MPI_COMM_WORLD, &x, &y), MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Cart_coords(MPI_COMM_WORLD, 0, 0, &y), MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Cart_shift(MPI_COMM_WORLD, 0, 1, &x, &y), MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Cart_sub(MPI_COMM_WORLD, &x, &cart), MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Graphdims_get(MPI_COMM_WORLD, &x, &y), MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Graph_get(MPI_COMM_WORLD, 0, 0, &x, &y), MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Graph_neighbors_count(MPI_COMM_WORLD, 0, &x), MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Graph_neighbors(MPI_COMM_WORLD, 0, 1, &x), MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Dist_graph_neighbors_count(MPI_COMM_WORLD, &x, &y, &kind),
                     MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Dist_graph_neighbors(MPI_COMM_WORLD, 0, &x, &x, 0, &y, &y),
                     MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Neighbor_allgather(&x, 1, MPI_INT, &y, 1, MPI_INT, MPI_COMM_WORLD),
                     MPI_ERR_TOPOLOGY);
}

/* What is too far, or of another kind. */
static void too_far(void *context)
{
    MPI_Comm cart, inter;
    int x, y, kind;
    (void)context;
    return_errors();
    MPI_Cart_create(MPI_COMM_WORLD, 1, (int[]){2}, (int[]){1}, 0, &cart);
    assert_int_equal(MPI_Graphdims_get(cart, &x, &y), MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Dist_graph_neighbors_count(cart, &x, &y, &kind), MPI_ERR_TOPOLOGY);
    assert_int_equal(MPI_Cart_shift(cart, 1, 1, &x, &y), MPI_ERR_DIMS);
    assert_int_equal(MPI_Cart_shift(cart, -1, 1, &x, &y), MPI_ERR_DIMS);
    /* the furthest that a call can ask for: 2 divides INT_MAX + 1 */
    assert_int_equal(MPI_Cart_shift(cart, 0, INT_MAX, &x, &y), MPI_SUCCESS);
    assert_int_equal(y, 1 - own_rank());
    assert_int_equal(MPI_Cart_shift(cart, 0, INT_MIN, &x, &y), MPI_SUCCESS);
    assert_true(x == own_rank() && y == own_rank());
    MPI_Comm_free(&cart);
    /* topologies are of one group */
    inter = between();
    assert_int_equal(MPI_Cart_create(inter, 1, (int[]){1}, (int[]){1}, 0, &cart), MPI_ERR_COMM);
    assert_int_equal(MPI_Graph_create(inter, 1, (int[]){0}, NULL, 0, &cart), MPI_ERR_COMM);
    assert_int_equal(MPI_Dist_graph_create_adjacent(inter, 0, NULL, MPI_UNWEIGHTED, 0, NULL,
                                                    MPI_UNWEIGHTED, MPI_INFO_NULL, 0, &cart),
                     MPI_ERR_COMM);
    assert_int_equal(
        MPI_Dist_graph_create(inter, 0, NULL, NULL, NULL, MPI_UNWEIGHTED, MPI_INFO_NULL, 0, &cart),
        MPI_ERR_COMM);
    MPI_Comm_free(&inter);
}

static void wrong_grids_are_refused(void **state)
{
    (void)state;
    mpi_ok(2, short_arrays, NULL);
    mpi_ok(2, refusals, NULL);
    mpi_ok(2, no_topology, NULL);
    mpi_ok(2, too_far, NULL);
}

/* --- balanced dimensions --- */

/* Among all n factors with the product, not increasing: the least first, then the least second, and
 * so on. */
static bool least(int nodes, int n, int most, int *out)
{
    if (n == 0) return nodes == 1;
    for (int f = 1; f <= most && f <= nodes; f++)
        if (nodes % f == 0 && least(nodes / f, n - 1, f, out + 1)) {
            out[0] = f;
            return true;
        }
    return false;
}

static void dimensions(void *context)
{
    (void)context;
    return_errors();
    for (int n = 1; n <= 5; n++)
        for (int nodes = 1; nodes <= 150; nodes++) {
            int dims[5] = {0}, expected[5] = {0};
            assert_true(least(nodes, n, nodes, expected));
            assert_int_equal(MPI_Dims_create(nodes, n, dims), MPI_SUCCESS);
            if (memcmp(dims, expected, sizeof dims))
                fail_msg("%d nodes in %d dimensions: %d %d %d", nodes, n, dims[0], dims[1],
                         dims[2]);
        }
    static const struct {
        int nodes, n, given[4], class, made[4];
    } row[] = {
        {6, 3, {0, 3, 0}, MPI_SUCCESS, {2, 3, 1}},
        {7, 3, {0, 3, 0}, MPI_ERR_DIMS, {0, 3, 0}},
        {24, 4, {0, 2, 0, 1}, MPI_SUCCESS, {4, 2, 3, 1}},
        {6, 2, {2, 3}, MPI_SUCCESS, {2, 3}},
        {6, 2, {2, 2}, MPI_ERR_DIMS, {2, 2}},
        {12, 2, {2, 3}, MPI_ERR_DIMS, {2, 3}},
        {1, 0, {0}, MPI_SUCCESS, {0}},
        {2, 0, {0}, MPI_ERR_DIMS, {0}},
        {0, 2, {0, 0}, MPI_ERR_DIMS, {0, 0}},
        {-4, 2, {0, 0}, MPI_ERR_DIMS, {0, 0}},
        {4, -1, {0}, MPI_ERR_DIMS, {0}},
        {4, 2, {0, -2}, MPI_ERR_DIMS, {0, -2}},
        {2147483647, 2, {0, 0}, MPI_SUCCESS, {2147483647, 1}},
        {2147483646, 2, {0, 0}, MPI_SUCCESS, {49981, 42966}},
        {1073741824, 3, {0, 0, 0}, MPI_SUCCESS, {1024, 1024, 1024}},
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        int dims[4];
        memcpy(dims, row[k].given, sizeof dims);
        assert_int_equal(MPI_Dims_create(row[k].nodes, row[k].n, dims), row[k].class);
        if (memcmp(dims, row[k].made, sizeof dims))
            fail_msg("row %d: %d x %d x %d", (int)k, dims[0], dims[1], dims[2]);
    }
}

static void dimensions_are_as_equal_as_they_get(void **state)
{
    (void)state;
    mpi_ok(1, dimensions, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grids_are_those_of_the_model),
        cmocka_unit_test(parts_of_grids_are_grids),
        cmocka_unit_test(wrong_grids_are_refused),
        cmocka_unit_test(dimensions_are_as_equal_as_they_get),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
