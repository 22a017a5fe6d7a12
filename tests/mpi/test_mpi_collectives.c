/* test_mpi_collectives.c - collective operations against their definitions: every number of ranks,
 * root, way to start, in place, types with gaps, operations that do not commute; messages against
 * the closed forms. */
#include "comm/collectives.h"
#include "mpi_world.h"

enum { WAYS = 3 }; /* blocking, non-blocking, persistent and started twice */

/* by: run one call in the way wanted; `kind`_init needs an info. */
#define BY(way, blocking, non_blocking, persistent)                                                \
    do {                                                                                           \
        MPI_Request q_ = MPI_REQUEST_NULL;                                                         \
        if ((way) == 0) blocking;                                                                  \
        else if ((way) == 1) {                                                                     \
            non_blocking;                                                                          \
            MPI_Wait(&q_, MPI_STATUS_IGNORE);                                                      \
        } else {                                                                                   \
            persistent;                                                                            \
            MPI_Start(&q_);                                                                        \
            MPI_Wait(&q_, MPI_STATUS_IGNORE);                                                      \
            MPI_Request_free(&q_);                                                                 \
        }                                                                                          \
    } while (0)

/* Integers spread out, every second one: a type with gaps. */
static MPI_Datatype spread(int n)
{
    MPI_Datatype vector, type;
    MPI_Type_vector(n, 1, 2, MPI_INT, &vector);
    MPI_Type_create_resized(vector, 0, 2 * n * (MPI_Aint)sizeof(int), &type);
    MPI_Type_commit(&type);
    MPI_Type_free(&vector);
    return type;
}

enum { N = 3 };

/* --- moving data: rank r's element i for rank s is 10000 r + 100 s + i --- */

static int value(int r, int s, int i) { return 10000 * r + 100 * s + i; }

static void rooted(int way, int root, MPI_Datatype gaps)
{
    int n = all_ranks(), rank = own_rank();
    int own[2 * N], *all = calloc((size_t)n * 2 * N, sizeof *all);
    /* broadcast from a spread type into a plain one */
    for (int i = 0; i < 2 * N; i++)
        own[i] = rank == root && i % 2 == 0 ? value(root, 0, i / 2) : -1;
    if (rank == root)
        BY(way, MPI_Bcast(own, 1, gaps, root, MPI_COMM_WORLD),
           MPI_Ibcast(own, 1, gaps, root, MPI_COMM_WORLD, &q_),
           MPI_Bcast_init(own, 1, gaps, root, MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    else
        BY(way, MPI_Bcast(own, N, MPI_INT, root, MPI_COMM_WORLD),
           MPI_Ibcast(own, N, MPI_INT, root, MPI_COMM_WORLD, &q_),
           MPI_Bcast_init(own, N, MPI_INT, root, MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    for (int i = 0; i < N && rank != root; i++) assert_int_equal(own[i], value(root, 0, i));
    /* gather plain ones into spread ones, the root's in place */
    int mine[N];
    for (int i = 0; i < N; i++) mine[i] = value(rank, root, i);
    if (rank == root)
        for (int i = 0; i < N; i++) all[root * 2 * N + 2 * i] = mine[i];
    const void *out = rank == root ? MPI_IN_PLACE : mine;
    BY(way, MPI_Gather(out, N, MPI_INT, all, 1, gaps, root, MPI_COMM_WORLD),
       MPI_Igather(out, N, MPI_INT, all, 1, gaps, root, MPI_COMM_WORLD, &q_),
       MPI_Gather_init(out, N, MPI_INT, all, 1, gaps, root, MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    for (int k = 0; k < n * N && rank == root; k++)
        assert_int_equal(all[2 * k], value(k / N, root, k % N));
    /* and back again */
    int in[N];
    BY(way, MPI_Scatter(all, 1, gaps, in, N, MPI_INT, root, MPI_COMM_WORLD),
       MPI_Iscatter(all, 1, gaps, in, N, MPI_INT, root, MPI_COMM_WORLD, &q_),
       MPI_Scatter_init(all, 1, gaps, in, N, MPI_INT, root, MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    for (int i = 0; i < N; i++) assert_int_equal(in[i], mine[i]);
    free(all);
}

/* Rank r has r % 3 elements, with a gap before each block. */
static void uneven(int way, int root)
{
    int n = all_ranks(), rank = own_rank(), total = 0;
    int *counts = calloc((size_t)n, sizeof *counts), *places = calloc((size_t)n, sizeof *places);
    for (int r = 0; r < n; r++) {
        counts[r] = r % 3;
        places[r] = total + 1;
        total += counts[r] + 1;
    }
    int *all = calloc((size_t)total + 1, sizeof *all), mine[3], in[3] = {0};
    for (int i = 0; i < 3; i++) mine[i] = value(rank, 0, i);
    BY(way,
       MPI_Gatherv(mine, counts[rank], MPI_INT, all, counts, places, MPI_INT, root, MPI_COMM_WORLD),
       MPI_Igatherv(mine, counts[rank], MPI_INT, all, counts, places, MPI_INT, root, MPI_COMM_WORLD,
                    &q_),
       MPI_Gatherv_init(mine, counts[rank], MPI_INT, all, counts, places, MPI_INT, root,
                        MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    for (int r = 0; r < n && rank == root; r++)
        for (int i = 0; i < counts[r]; i++) assert_int_equal(all[places[r] + i], value(r, 0, i));
    BY(way,
       MPI_Scatterv(all, counts, places, MPI_INT, in, counts[rank], MPI_INT, root, MPI_COMM_WORLD),
       MPI_Iscatterv(all, counts, places, MPI_INT, in, counts[rank], MPI_INT, root, MPI_COMM_WORLD,
                     &q_),
       MPI_Scatterv_init(all, counts, places, MPI_INT, in, counts[rank], MPI_INT, root,
                         MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    for (int i = 0; i < counts[rank]; i++) assert_int_equal(in[i], mine[i]);
    memset(all, 0, (size_t)total * sizeof *all);
    BY(way,
       MPI_Allgatherv(mine, counts[rank], MPI_INT, all, counts, places, MPI_INT, MPI_COMM_WORLD),
       MPI_Iallgatherv(mine, counts[rank], MPI_INT, all, counts, places, MPI_INT, MPI_COMM_WORLD,
                       &q_),
       MPI_Allgatherv_init(mine, counts[rank], MPI_INT, all, counts, places, MPI_INT,
                           MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    for (int r = 0; r < n; r++)
        for (int i = 0; i < counts[r]; i++) assert_int_equal(all[places[r] + i], value(r, 0, i));
    free(counts), free(places), free(all);
}

static void all_to_all(int way, MPI_Datatype gaps)
{
    int n = all_ranks(), rank = own_rank();
    int *out = calloc((size_t)n * N, sizeof *out), *in = calloc((size_t)n * 2 * N, sizeof *in);
    int *counts = calloc((size_t)n, sizeof *counts), *places = calloc((size_t)n, sizeof *places);
    MPI_Datatype *types = calloc((size_t)n, sizeof(MPI_Datatype));
    for (int s = 0; s < n; s++)
        for (int i = 0; i < N; i++) out[s * N + i] = value(rank, s, i);
    BY(way, MPI_Alltoall(out, N, MPI_INT, in, 1, gaps, MPI_COMM_WORLD),
       MPI_Ialltoall(out, N, MPI_INT, in, 1, gaps, MPI_COMM_WORLD, &q_),
       MPI_Alltoall_init(out, N, MPI_INT, in, 1, gaps, MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    for (int r = 0; r < n; r++)
        for (int i = 0; i < N; i++) assert_int_equal(in[r * 2 * N + 2 * i], value(r, rank, i));
    /* in place; counts and types for each rank, places in bytes */
    for (int r = 0; r < n; r++) counts[r] = N, places[r] = r * N, types[r] = MPI_INT;
    BY(way,
       MPI_Alltoallv(MPI_IN_PLACE, NULL, NULL, MPI_INT, out, counts, places, MPI_INT,
                     MPI_COMM_WORLD),
       MPI_Ialltoallv(MPI_IN_PLACE, NULL, NULL, MPI_INT, out, counts, places, MPI_INT,
                      MPI_COMM_WORLD, &q_),
       MPI_Alltoallv_init(MPI_IN_PLACE, NULL, NULL, MPI_INT, out, counts, places, MPI_INT,
                          MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    for (int k = 0; k < n * N; k++) assert_int_equal(out[k], value(k / N, rank, k % N));
    for (int r = 0; r < n; r++) places[r] = r * N * (int)sizeof(int);
    memset(in, 0, (size_t)n * N * sizeof *in);
    BY(way, MPI_Alltoallw(out, counts, places, types, in, counts, places, types, MPI_COMM_WORLD),
       MPI_Ialltoallw(out, counts, places, types, in, counts, places, types, MPI_COMM_WORLD, &q_),
       MPI_Alltoallw_init(out, counts, places, types, in, counts, places, types, MPI_COMM_WORLD,
                          MPI_INFO_NULL, &q_));
    for (int k = 0; k < n * N; k++) assert_int_equal(in[k], value(rank, k / N, k % N));
    /* everybody's block to all, in place */
    for (int i = 0; i < N; i++) out[rank * N + i] = value(rank, 7, i);
    BY(way, MPI_Allgather(MPI_IN_PLACE, 0, MPI_INT, out, N, MPI_INT, MPI_COMM_WORLD),
       MPI_Iallgather(MPI_IN_PLACE, 0, MPI_INT, out, N, MPI_INT, MPI_COMM_WORLD, &q_),
       MPI_Allgather_init(MPI_IN_PLACE, 0, MPI_INT, out, N, MPI_INT, MPI_COMM_WORLD, MPI_INFO_NULL,
                          &q_));
    for (int k = 0; k < n * N; k++) assert_int_equal(out[k], value(k / N, 7, k % N));
    free(out), free(in), free(counts), free(places), free(types);
}

static void moving(void *context)
{
    (void)context;
    MPI_Datatype gaps = spread(N);
    for (int way = 0; way < WAYS; way++) {
        for (int root = 0; root < all_ranks(); root += 1 + all_ranks() / 3) {
            rooted(way, root, gaps);
            uneven(way, root);
        }
        all_to_all(way, gaps);
        BY(way, MPI_Barrier(MPI_COMM_WORLD), MPI_Ibarrier(MPI_COMM_WORLD, &q_),
           MPI_Barrier_init(MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    }
    MPI_Type_free(&gaps);
}

static void data_go_where_they_belong(void **state)
{
    (void)state;
    for (int n = 1; n <= 9; n++) mpi_ok(n, moving, NULL);
    mpi_ok(16, moving, NULL);
}

/* --- combining: maps x -> a x + b modulo a prime, whose composition does not commute --- */

struct map {
    unsigned a, b;
};
enum { PRIME = 10007 };

static void compose(void *in, void *inout, int *n, MPI_Datatype *type)
{
    struct map *x = in, *y = inout;
    (void)type;
    for (int i = 0; i < *n; i++)
        y[i] = (struct map){x[i].a * y[i].a % PRIME, (x[i].a * y[i].b + x[i].b) % PRIME};
}

static struct map map_of(int rank, int i)
{
    return (struct map){(unsigned)(rank * 31 + i * 7 + 2), (unsigned)(rank + 11 * i)};
}

static struct map product(int from, int to, int i)
{
    struct map x = map_of(from, i);
    for (int r = from + 1; r <= to; r++) {
        struct map y = map_of(r, i);
        x = (struct map){x.a * y.a % PRIME, (x.a * y.b + x.b) % PRIME};
    }
    x.a %= PRIME;
    x.b %= PRIME;
    return x;
}

static void same(struct map a, struct map b)
{
    assert_true(a.a % PRIME == b.a && a.b % PRIME == b.b);
}

static void in_order(int way, MPI_Op op, MPI_Datatype type)
{
    int n = all_ranks(), rank = own_rank(), root = n / 2;
    struct map *out = calloc((size_t)(n * N), sizeof *out), in[N] = {{0}};
    for (int i = 0; i < n * N; i++) out[i] = map_of(rank, i);
    BY(way, MPI_Reduce(out, in, N, type, op, root, MPI_COMM_WORLD),
       MPI_Ireduce(out, in, N, type, op, root, MPI_COMM_WORLD, &q_),
       MPI_Reduce_init(out, in, N, type, op, root, MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    for (int i = 0; i < N && rank == root; i++) same(in[i], product(0, n - 1, i));
    BY(way, MPI_Allreduce(out, in, N, type, op, MPI_COMM_WORLD),
       MPI_Iallreduce(out, in, N, type, op, MPI_COMM_WORLD, &q_),
       MPI_Allreduce_init(out, in, N, type, op, MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    for (int i = 0; i < N; i++) same(in[i], product(0, n - 1, i));
    BY(way, MPI_Scan(out, in, N, type, op, MPI_COMM_WORLD),
       MPI_Iscan(out, in, N, type, op, MPI_COMM_WORLD, &q_),
       MPI_Scan_init(out, in, N, type, op, MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    for (int i = 0; i < N; i++) same(in[i], product(0, rank, i));
    BY(way, MPI_Exscan(out, in, N, type, op, MPI_COMM_WORLD),
       MPI_Iexscan(out, in, N, type, op, MPI_COMM_WORLD, &q_),
       MPI_Exscan_init(out, in, N, type, op, MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    for (int i = 0; i < N && rank > 0; i++) same(in[i], product(0, rank - 1, i));
    BY(way, MPI_Reduce_scatter_block(out, in, N, type, op, MPI_COMM_WORLD),
       MPI_Ireduce_scatter_block(out, in, N, type, op, MPI_COMM_WORLD, &q_),
       MPI_Reduce_scatter_block_init(out, in, N, type, op, MPI_COMM_WORLD, MPI_INFO_NULL, &q_));
    for (int i = 0; i < N; i++) same(in[i], product(0, n - 1, rank * N + i));
    free(out);
}

static void sums(int way)
{
    int n = all_ranks(), rank = own_rank(), total = 0, place = 0;
    int *counts = calloc((size_t)n, sizeof *counts);
    for (int r = 0; r < n; r++) {
        counts[r] = (r + 1) % 3;
        if (r < rank) place += counts[r];
        total += counts[r];
    }
    long *x = calloc((size_t)total + 1, sizeof *x), in[3] = {0};
    for (int i = 0; i < total; i++) x[i] = rank + 1000L * i;
    BY(way, MPI_Reduce_scatter(x, in, counts, MPI_LONG, MPI_SUM, MPI_COMM_WORLD),
       MPI_Ireduce_scatter(x, in, counts, MPI_LONG, MPI_SUM, MPI_COMM_WORLD, &q_),
       MPI_Reduce_scatter_init(x, in, counts, MPI_LONG, MPI_SUM, MPI_COMM_WORLD, MPI_INFO_NULL,
                               &q_));
    for (int i = 0; i < counts[rank]; i++)
        assert_int_equal(in[i], n * (n - 1) / 2 + 1000L * n * (place + i));
    /* in place: all of the above but the scatter of blocks */
    long y[2] = {rank, -rank};
    BY(way, MPI_Allreduce(MPI_IN_PLACE, y, 2, MPI_LONG, MPI_MAX, MPI_COMM_WORLD),
       MPI_Iallreduce(MPI_IN_PLACE, y, 2, MPI_LONG, MPI_MAX, MPI_COMM_WORLD, &q_),
       MPI_Allreduce_init(MPI_IN_PLACE, y, 2, MPI_LONG, MPI_MAX, MPI_COMM_WORLD, MPI_INFO_NULL,
                          &q_));
    assert_true(y[0] == n - 1 && y[1] == 0);
    y[0] = 1;
    MPI_Scan(MPI_IN_PLACE, y, 1, MPI_LONG, MPI_SUM, MPI_COMM_WORLD);
    assert_int_equal(y[0], rank + 1);
    y[0] = 1;
    MPI_Reduce(rank == n - 1 ? MPI_IN_PLACE : y, y, 1, MPI_LONG, MPI_SUM, n - 1, MPI_COMM_WORLD);
    if (rank == n - 1) assert_int_equal(y[0], n);
    MPI_Reduce_scatter(MPI_IN_PLACE, x, counts, MPI_LONG, MPI_SUM, MPI_COMM_WORLD);
    for (int i = 0; i < counts[rank]; i++) assert_int_equal(x[i], in[i]);
    free(counts), free(x);
}

static void combining(void *context)
{
    MPI_Op op;
    MPI_Datatype type;
    (void)context;
    MPI_Op_create(compose, 0, &op);
    MPI_Type_contiguous(2, MPI_UNSIGNED, &type);
    MPI_Type_commit(&type);
    for (int way = 0; way < WAYS; way++) {
        in_order(way, op, type);
        sums(way);
    }
    struct {
        double v;
        int i;
    } least = {(double)(own_rank() % 2), own_rank()}, found;
    MPI_Allreduce(&least, &found, 1, MPI_DOUBLE_INT, MPI_MAXLOC, MPI_COMM_WORLD);
    assert_int_equal(found.i, all_ranks() > 1 ? 1 : 0);
    MPI_Allreduce(&least, &found, 1, MPI_DOUBLE_INT, MPI_MINLOC, MPI_COMM_WORLD);
    assert_true(found.i == 0 && found.v == 0);
    MPI_Op_free(&op);
    MPI_Type_free(&type);
}

static void operations_keep_their_order(void **state)
{
    (void)state;
    for (int n = 1; n <= 9; n++) mpi_ok(n, combining, NULL);
    mpi_ok(16, combining, NULL);
}

/* --- several in progress at once, completed out of order, while messages come and go --- */

static void overlapping(void *context)
{
    int n = all_ranks(), rank = own_rank(), flag = 0, rounds = 0;
    long sum[6];
    MPI_Request q[6];
    (void)context;
    for (int k = 0; k < 6; k++) {
        sum[k] = rank * (k + 1);
        MPI_Iallreduce(MPI_IN_PLACE, &sum[k], 1, MPI_LONG, MPI_SUM, MPI_COMM_WORLD, &q[k]);
    }
    int token = rank, in = -1;
    MPI_Sendrecv(&token, 1, MPI_INT, (rank + 1) % n, 0, &in, 1, MPI_INT, (rank + n - 1) % n, 0,
                 MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    assert_int_equal(in, (rank + n - 1) % n);
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Wait(&q[5 - rank % 6], MPI_STATUS_IGNORE);
    while (!flag) {
        MPI_Testall(6, q, &flag, MPI_STATUSES_IGNORE);
        assert_true(rounds++ < 1000);
    }
    for (int k = 0; k < 6; k++) assert_int_equal(sum[k], (k + 1) * n * (n - 1) / 2);
}

static void operations_go_on_beside_each_other(void **state)
{
    (void)state;
    for (int n = 1; n <= 8; n++) mpi_ok(n, overlapping, NULL);
}

/* --- what is sent --- */

static void one_allreduce(void *context)
{
    int n = *(int *)context;
    double *x = calloc((size_t)n + 1, sizeof *x), *y = calloc((size_t)n + 1, sizeof *y);
    MPI_Allreduce(x, y, n, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    free(x), free(y);
}

static void nothing(void *context) { (void)context; }

static void messages_are_those_of_the_closed_forms(void **state)
{
    (void)state;
    for (int P = 2; P <= 16; P += 2)
        for (int n = 1; n <= 4096; n *= 16) {
            struct outcome with = mpi_go(P, one_allreduce, &n), without = mpi_go(P, nothing, NULL);
            expect_ok(&with);
            struct collective_shape s = {
                .kind = COLLECTIVE_ALLREDUCE, .size = P, .count = n, .total = n * P};
            struct collective_cost cost;
            s.element = sizeof(double);
            s.commutative = true;
            collective_choose(&s, NULL, 0)->cost(&s, &cost);
            assert_int_equal(messages_of(&with) - messages_of(&without), cost.messages);
            assert_int_equal(bytes_of(&with) - bytes_of(&without), cost.bytes);
            arena_destroy(with.arena);
            arena_destroy(without.arena);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(data_go_where_they_belong),
        cmocka_unit_test(operations_keep_their_order),
        cmocka_unit_test(operations_go_on_beside_each_other),
        cmocka_unit_test(messages_are_those_of_the_closed_forms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
