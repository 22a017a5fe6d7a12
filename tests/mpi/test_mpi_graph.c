/* test_mpi_graph.c - graphs that all ranks know against the lists they were given as, distributed
 * ones against matrices of edges; and what is refused. */
#include "base/random.h"
#include "mpi_world.h"

static void return_errors(void) { MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN); }

/* --- graphs that all know --- */

static void whole_graph(void *context)
{
    /* 5 nodes, one without edges, one with a loop and one with an edge twice; symmetric */
    static const int ends[] = {2, 3, 3, 6, 8}, edges[] = {1, 3, 0, 0, 3, 4, 3, 4};
    MPI_Comm graph, copy;
    int nodes, n, x[9], y[9], mapped;
    (void)context;
    return_errors();
    MPI_Graph_map(MPI_COMM_WORLD, 5, ends, edges, &mapped);
    assert_int_equal(mapped, own_rank() < 5 ? own_rank() : MPI_UNDEFINED);
    MPI_Graph_create(MPI_COMM_WORLD, 5, ends, edges, 1, &graph);
    assert_true((graph == MPI_COMM_NULL) == (own_rank() >= 5));
    if (graph == MPI_COMM_NULL) return;
    MPI_Comm_dup(graph, &copy);
    MPI_Comm_free(&graph);
    MPI_Topo_test(copy, &n);
    assert_int_equal(n, MPI_GRAPH);
    MPI_Graphdims_get(copy, &nodes, &n);
    assert_true(nodes == 5 && n == 8);
    for (int k = 0; k < 9; k++) x[k] = y[k] = -7;
    MPI_Graph_get(copy, 3, 4, x, y);
    assert_true(x[2] == 3 && x[3] == -7 && y[3] == 0 && y[4] == -7);
    MPI_Graph_get(copy, 9, 9, x, y);
    assert_memory_equal(x, ends, sizeof ends);
    assert_memory_equal(y, edges, sizeof edges);
    assert_true(x[5] == -7 && y[8] == -7);
    for (int r = 0; r < 5; r++) {
        const int first = r ? ends[r - 1] : 0, m = ends[r] - first;
        MPI_Graph_neighbors_count(copy, r, &n);
        assert_int_equal(n, m);
        for (int room = 0; room <= m + 1; room++) {
            for (int k = 0; k < 9; k++) x[k] = -7;
            assert_int_equal(MPI_Graph_neighbors(copy, r, room, x), MPI_SUCCESS);
            for (int k = 0; k < 9; k++)
                assert_int_equal(x[k], k < m && k < room ? edges[first + k] : -7);
        }
    }
    assert_int_equal(MPI_Graph_neighbors_count(copy, 5, &n), MPI_ERR_RANK);
    assert_int_equal(MPI_Graph_neighbors_count(copy, -1, &n), MPI_ERR_RANK);
    assert_int_equal(MPI_Graph_neighbors(copy, 5, 9, x), MPI_ERR_RANK);
    assert_int_equal(MPI_Graph_neighbors(copy, -1, 9, x), MPI_ERR_RANK);
    MPI_Comm_free(&copy);
}

static void graph_refusals(void *context)
{
    static const struct {
        int nodes, ends[3], edges[3];
    } row[] = {
        {-1, {0}, {0}},      {4, {0, 0, 0}, {0}}, {2, {1, 2}, {2, 0}},    {2, {1, 2}, {-1, 0}},
        {2, {2, 1}, {0, 0}}, {1, {-1}, {0}},      {3, {1, 1, 2}, {1, 3}},
    };
    MPI_Comm graph;
    int x;
    (void)context;
    return_errors();
    for (size_t k = 0; k < sizeof row / sizeof *row; k++)
        assert_int_equal(
            MPI_Graph_create(MPI_COMM_WORLD, row[k].nodes, row[k].ends, row[k].edges, 0, &graph),
            MPI_ERR_ARG);
    assert_int_equal(MPI_Graph_map(MPI_COMM_WORLD, 0, NULL, NULL, &x), MPI_ERR_ARG);
    assert_int_equal(MPI_Graph_map(MPI_COMM_WORLD, 4, NULL, NULL, &x), MPI_ERR_ARG);
    assert_int_equal(MPI_Graph_create(MPI_COMM_WORLD, 0, NULL, NULL, 0, &graph), MPI_SUCCESS);
    assert_true(graph == MPI_COMM_NULL);
    assert_int_equal(MPI_Graph_create(MPI_COMM_NULL, 0, NULL, NULL, 0, &graph), MPI_ERR_COMM);
}

static void graphs_are_as_given(void **state)
{
    (void)state;
    mpi_ok(6, whole_graph, NULL);
    mpi_ok(3, graph_refusals, NULL);
}

/* --- distributed graphs --- */

enum { NODES = 6 };

/* How often each edge is there, and its weight: the same matrix on all ranks. */
static void draw(uint64_t seed, int times[NODES][NODES], int weight[NODES][NODES])
{
    struct random r = random_make(seed, 3, 0);
    for (int i = 0; i < NODES; i++)
        for (int k = 0; k < NODES; k++) {
            times[i][k] = random_below(&r, 3) == 0 ? 1 + (int)random_below(&r, 2) : 0;
            weight[i][k] = (int)random_below(&r, 50);
        }
}

/* The own neighbours must be those of the column and row of the matrix, in the order of ranks. */
static void expect_neighbours(MPI_Comm graph, int times[NODES][NODES], int weight[NODES][NODES],
                              bool weighted)
{
    int in, out, flag, n, rank = own_rank(), from[2 * NODES + 1], to[2 * NODES + 1],
                          fw[2 * NODES + 1], tw[2 * NODES + 1];
    MPI_Dist_graph_neighbors_count(graph, &in, &out, &flag);
    assert_int_equal(!!flag, weighted);
    for (int k = 0; k <= 2 * NODES; k++) from[k] = to[k] = fw[k] = tw[k] = -7;
    MPI_Dist_graph_neighbors(graph, in, from, fw, out, to, tw);
    n = 0;
    for (int i = 0; i < NODES; i++)
        for (int k = 0; k < times[i][rank]; k++, n++) {
            assert_int_equal(from[n], i);
            assert_int_equal(fw[n], weighted ? weight[i][rank] : -7);
        }
    assert_int_equal(in, n);
    n = 0;
    for (int i = 0; i < NODES; i++)
        for (int k = 0; k < times[rank][i]; k++, n++) {
            assert_int_equal(to[n], i);
            assert_int_equal(tw[n], weighted ? weight[rank][i] : -7);
        }
    assert_int_equal(out, n);
    assert_true(from[in] == -7 && to[out] == -7);
    /* as much as there is room for, and no weights that nobody wants */
    for (int k = 0; k <= 2 * NODES; k++) from[k] = to[k] = -7;
    if (in > 0 && out > 0) {
        MPI_Dist_graph_neighbors(graph, in - 1, from, MPI_UNWEIGHTED, out - 1, to, MPI_UNWEIGHTED);
        assert_true(from[in - 1] == -7 && to[out - 1] == -7);
    }
    /* data go along the edges: every neighbour in hears the rank's own number */
    int got[2 * NODES + 1];
    MPI_Neighbor_allgather(&rank, 1, MPI_INT, got, 1, MPI_INT, graph);
    n = 0;
    for (int i = 0; i < NODES; i++)
        for (int k = 0; k < times[i][rank]; k++) assert_int_equal(got[n++], i);
}

static void distributed(void *context)
{
    (void)context;
    for (uint64_t seed = 0; seed < 8; seed++) {
        int times[NODES][NODES], weight[NODES][NODES], rank = own_rank();
        bool weighted = seed % 2;
        MPI_Comm graph, copy;
        draw(seed, times, weight);
        /* rank r names the edges from i to k where (i + k + seed) % NODES is r */
        int n = 0, sources[NODES * NODES], degrees[NODES * NODES], m = 0, to[2 * NODES * NODES],
            w[2 * NODES * NODES];
        for (int i = NODES - 1; i >= 0; i--) {
            const int before = m;
            for (int k = 0; k < NODES; k++)
                for (int e = 0; e < times[i][k]; e++)
                    if ((i + k + (int)seed) % NODES == rank) to[m] = k, w[m++] = weight[i][k];
            if (m == before && i % 2) continue; /* sources without edges may be named, too */
            sources[n] = i, degrees[n++] = m - before;
        }
        MPI_Dist_graph_create(MPI_COMM_WORLD, n, sources, degrees, to,
                              !weighted ? MPI_UNWEIGHTED
                              : m       ? w
                                        : MPI_WEIGHTS_EMPTY,
                              MPI_INFO_NULL, 1, &graph);
        expect_neighbours(graph, times, weight, weighted);
        MPI_Comm_dup(graph, &copy);
        MPI_Comm_free(&graph);
        expect_neighbours(copy, times, weight, weighted);
        MPI_Comm_free(&copy);
        /* the same by every rank's own ends */
        int in[2 * NODES], iw[2 * NODES], out[2 * NODES], ow[2 * NODES], nin = 0, nout = 0;
        for (int i = 0; i < NODES; i++) {
            for (int e = 0; e < times[i][rank]; e++) in[nin] = i, iw[nin++] = weight[i][rank];
            for (int e = 0; e < times[rank][i]; e++) out[nout] = i, ow[nout++] = weight[rank][i];
        }
        MPI_Dist_graph_create_adjacent(MPI_COMM_WORLD, nin, in,
                                       !weighted ? MPI_UNWEIGHTED
                                       : nin     ? iw
                                                 : MPI_WEIGHTS_EMPTY,
                                       nout, out,
                                       !weighted ? MPI_UNWEIGHTED
                                       : nout    ? ow
                                                 : MPI_WEIGHTS_EMPTY,
                                       MPI_INFO_NULL, 0, &graph);
        expect_neighbours(graph, times, weight, weighted);
        MPI_Comm_free(&graph);
    }
}

static void distributed_refusals(void *context)
{
    const int good = 0, beyond = 2, below = -1, one = 1, minus = -1;
    MPI_Comm g;
    MPI_Info i = MPI_INFO_NULL;
    const MPI_Comm c = MPI_COMM_WORLD;
    int *const u = MPI_UNWEIGHTED;
    (void)context;
    return_errors();
    assert_int_equal(MPI_Dist_graph_create(c, 1, &beyond, &one, &good, u, i, 0, &g), MPI_ERR_RANK);
    assert_int_equal(MPI_Dist_graph_create(c, 1, &below, &one, &good, u, i, 0, &g), MPI_ERR_RANK);
    assert_int_equal(MPI_Dist_graph_create(c, 1, &good, &one, &beyond, u, i, 0, &g), MPI_ERR_RANK);
    assert_int_equal(MPI_Dist_graph_create(c, 1, &good, &one, &below, u, i, 0, &g), MPI_ERR_RANK);
    assert_int_equal(MPI_Dist_graph_create(c, 1, &good, &minus, &good, u, i, 0, &g), MPI_ERR_ARG);
    assert_int_equal(MPI_Dist_graph_create(c, -1, &good, &one, &good, u, i, 0, &g), MPI_ERR_ARG);
    assert_int_equal(MPI_Dist_graph_create(c, 1, &good, &one, &good, NULL, i, 0, &g), MPI_ERR_ARG);
    assert_int_equal(MPI_Dist_graph_create_adjacent(c, 1, &beyond, u, 1, &good, u, i, 0, &g),
                     MPI_ERR_RANK);
    assert_int_equal(MPI_Dist_graph_create_adjacent(c, 1, &good, u, 1, &below, u, i, 0, &g),
                     MPI_ERR_RANK);
    assert_int_equal(MPI_Dist_graph_create_adjacent(c, -1, &good, u, 1, &good, u, i, 0, &g),
                     MPI_ERR_ARG);
    assert_int_equal(MPI_Dist_graph_create_adjacent(c, 1, &good, u, -1, &good, u, i, 0, &g),
                     MPI_ERR_ARG);
    assert_int_equal(MPI_Dist_graph_create_adjacent(c, 1, &good, NULL, 1, &good, NULL, i, 0, &g),
                     MPI_ERR_ARG);
}

static void distributed_graphs_are_those_of_the_matrix(void **state)
{
    (void)state;
    mpi_ok(NODES, distributed, NULL);
    mpi_ok(2, distributed_refusals, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(graphs_are_as_given),
        cmocka_unit_test(distributed_graphs_are_those_of_the_matrix),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
