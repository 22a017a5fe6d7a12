/* test_mpi_neighbours.c - operations among neighbours: every block comes from the edge that it
 * belongs to, on grids with and without edges, one or two places wide, and on graphs with edges
 * that are there twice. */
#include "base/random.h"
#include "mpi_world.h"

enum { RANKS = 12, EDGES = 40 };

/* What edge number `edge` of a rank carries. */
static int value(int rank, int edge, int i) { return 10000 * rank + 100 * edge + i; }

/* The edges of all ranks, as everybody draws them: of the k-th edge into a rank the rank that sends
 * and its number among that rank's edges out; -1: nobody sends. */
struct net {
    int nin[RANKS], nout[RANKS];
    struct {
        int from, edge;
    } in[RANKS][EDGES];
};

/* The same by all operations that move blocks, blocking and not. */
static void exchange(MPI_Comm c, const struct net *w, int way)
{
    const int me = own_rank(), nin = w->nin[me], nout = w->nout[me];
    int out[EDGES * 4], in[EDGES * 4], oc[EDGES], ic[EDGES], op[EDGES], ip[EDGES], one = 500 + me;
    MPI_Aint of[EDGES], far[EDGES];
    MPI_Datatype types[EDGES];
    MPI_Request q = MPI_REQUEST_NULL;
    for (int k = 0; k < EDGES * 4; k++) in[k] = -1, out[k] = -2;
    /* uneven: 1 to 3 integers by the edge's sender and number, in places of 4, backwards */
    for (int k = 0; k < nout; k++) {
        oc[k] = way < 2 ? 2 : 1 + (me + k) % 3;
        op[k] = way < 2 ? 2 * k : 4 * (nout - 1 - k);
        for (int i = 0; i < oc[k]; i++) out[op[k] + i] = value(me, k, i);
        of[k] = op[k] * (MPI_Aint)sizeof(int);
    }
    for (int k = 0; k < nin; k++) {
        const int from = w->in[me][k].from;
        ic[k] = way < 2 ? 2 : from < 0 ? 1 : 1 + (from + w->in[me][k].edge) % 3;
        ip[k] = way < 2 ? 2 * k : 4 * (nin - 1 - k);
        far[k] = ip[k] * (MPI_Aint)sizeof(int);
    }
    for (int k = 0; k < EDGES; k++) types[k] = MPI_INT;
    switch (way) {
    case 0:
        MPI_Neighbor_alltoall(out, 2, MPI_INT, in, 2, MPI_INT, c);
        break;
    case 1:
        MPI_Ineighbor_alltoall(out, 2, MPI_INT, in, 2, MPI_INT, c, &q);
        break;
    case 2:
        MPI_Neighbor_alltoallv(out, oc, op, MPI_INT, in, ic, ip, MPI_INT, c);
        break;
    case 3:
        MPI_Ineighbor_alltoallv(out, oc, op, MPI_INT, in, ic, ip, MPI_INT, c, &q);
        break;
    case 4:
        MPI_Neighbor_alltoallw(out, oc, of, types, in, ic, far, types, c);
        break;
    case 5:
        MPI_Neighbor_alltoallw_init(out, oc, of, types, in, ic, far, types, c, MPI_INFO_NULL, &q);
        MPI_Start(&q);
        break;
    }
    MPI_Wait(&q, MPI_STATUS_IGNORE);
    if (way == 5) MPI_Request_free(&q);
    int expected[EDGES * 4];
    for (int k = 0; k < EDGES * 4; k++) expected[k] = -1;
    for (int k = 0; k < nin; k++)
        for (int i = 0; i < ic[k] && w->in[me][k].from >= 0; i++)
            expected[ip[k] + i] = value(w->in[me][k].from, w->in[me][k].edge, i);
    if (memcmp(in, expected, sizeof in)) fail_msg("rank %d, way %d", me, way);
    /* one block to all: with displacements in turn */
    for (int k = 0; k < nin; k++) ic[k] = 1, ip[k] = 2 * (nin - 1 - k) + 1;
    for (int k = 0; k < EDGES * 4; k++) in[k] = expected[k] = -1;
    if (way % 2) MPI_Neighbor_allgatherv(&one, 1, MPI_INT, in, ic, ip, MPI_INT, c);
    else MPI_Neighbor_allgather(&one, 1, MPI_INT, in, 1, MPI_INT, c);
    for (int k = 0; k < nin; k++)
        if (w->in[me][k].from >= 0) expected[way % 2 ? ip[k] : k] = 500 + w->in[me][k].from;
    assert_memory_equal(in, expected, sizeof in);
}

/* --- grids --- */

static void grids(void *context)
{
    static const struct {
        int n, dim[3], period[3];
    } shape[] = {
        {1, {12}, {0}},
        {1, {12}, {1}},
        {2, {6, 2}, {1, 1}},
        {2, {12, 1}, {0, 1}},
        {3, {2, 3, 2}, {1, 0, 1}},
        {3, {1, 4, 3}, {0, 1, 1}},
        {3, {2, 2, 3}, {0, 0, 0}},
    };
    (void)context;
    for (size_t k = 0; k < sizeof shape / sizeof *shape; k++) {
        struct net w = {0};
        MPI_Comm cart;
        MPI_Cart_create(MPI_COMM_WORLD, shape[k].n, shape[k].dim, shape[k].period, 0, &cart);
        for (int r = 0; r < RANKS; r++) {
            int below = RANKS, rest = r;
            w.nin[r] = w.nout[r] = 2 * shape[k].n;
            for (int d = 0; d < shape[k].n; d++) {
                const int size = shape[k].dim[d];
                below /= size;
                const int at = rest / below;
                rest %= below;
                /* what comes from the one before was its block for the one behind */
                for (int behind = 0; behind < 2; behind++) {
                    int to = at + (behind ? 1 : -1);
                    const bool outside = to < 0 || to >= size;
                    to = (to + size) % size;
                    w.in[r][2 * d + behind].from =
                        outside && !shape[k].period[d] ? -1 : r + (to - at) * below;
                    w.in[r][2 * d + behind].edge = 2 * d + !behind;
                }
            }
        }
        for (int way = 0; way < 6; way++) exchange(cart, &w, way);
        MPI_Comm_free(&cart);
    }
}

static void blocks_on_grids_come_from_the_right_side(void **state)
{
    (void)state;
    mpi_ok(RANKS, grids, NULL);
}

/* --- graphs --- */

/* The m-th edge from i to k is the m-th one from i among those that k hears. */
static void link(struct net *w, int times[RANKS][RANKS])
{
    for (int i = 0; i < RANKS; i++)
        for (int k = 0; k < RANKS; k++)
            for (int m = 0; m < times[i][k]; m++) {
                w->in[k][w->nin[k]].from = i;
                w->in[k][w->nin[k]++].edge = w->nout[i]++;
            }
}

static void graphs(void *context)
{
    (void)context;
    for (uint64_t seed = 0; seed < 6; seed++) {
        struct random r = random_make(seed, 61, 0);
        int times[RANKS][RANKS] = {{0}}, me = own_rank(), n = 0, m = 0, in[EDGES], out[EDGES];
        struct net w = {0};
        MPI_Comm graph;
        for (int i = 0; i < RANKS; i++)
            for (int k = 0; k < RANKS; k++)
                if (random_below(&r, 4) == 0) times[i][k] = 1 + (int)random_below(&r, 2);
        link(&w, times);
        for (int i = 0; i < RANKS; i++)
            for (int t = 0; t < times[i][me]; t++) in[n++] = i;
        for (int k = 0; k < RANKS; k++)
            for (int t = 0; t < times[me][k]; t++) out[m++] = k;
        MPI_Dist_graph_create_adjacent(MPI_COMM_WORLD, n, in, MPI_UNWEIGHTED, m, out,
                                       MPI_UNWEIGHTED, MPI_INFO_NULL, 0, &graph);
        for (int way = 0; way < 6; way++) exchange(graph, &w, way);
        MPI_Comm_free(&graph);
        /* as a graph that all know, whose edges go both ways */
        int ends[RANKS], edges[RANKS * EDGES], ne = 0;
        struct net both = {0};
        for (int i = 0; i < RANKS; i++)
            for (int k = 0; k < i; k++) times[k][i] = times[i][k];
        link(&both, times);
        for (int i = 0; i < RANKS; i++) {
            for (int k = 0; k < RANKS; k++)
                for (int t = 0; t < times[i][k]; t++) edges[ne++] = k;
            ends[i] = ne;
        }
        MPI_Graph_create(MPI_COMM_WORLD, RANKS, ends, edges, 0, &graph);
        for (int way = 0; way < 6; way++) exchange(graph, &both, way);
        MPI_Comm_free(&graph);
    }
}

static void blocks_on_graphs_come_along_their_edges(void **state)
{
    (void)state;
    mpi_ok(RANKS, graphs, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_on_grids_come_from_the_right_side),
        cmocka_unit_test(blocks_on_graphs_come_along_their_edges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
