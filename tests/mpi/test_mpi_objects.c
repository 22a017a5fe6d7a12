/* test_mpi_objects.c - datatypes, groups, communicators, topologies, attributes, info. */
#include "mpi_world.h"

/* --- types --- */

/* A type's elements of integers, by packing 0, 1, 2, ... */
static void expect_elements(MPI_Datatype t, int n, const int *element, MPI_Aint lb, MPI_Aint extent)
{
    int memory[64], packed[64], position = 0, size;
    MPI_Aint l, e;
    for (int i = 0; i < 64; i++) memory[i] = i;
    MPI_Type_commit(&t);
    MPI_Type_size(t, &size);
    assert_int_equal(size, n * (int)sizeof(int));
    MPI_Type_get_extent(t, &l, &e);
    assert_int_equal(l, lb * (MPI_Aint)sizeof(int));
    assert_int_equal(e, extent * (MPI_Aint)sizeof(int));
    MPI_Pack(memory, 1, t, packed, sizeof packed, &position, MPI_COMM_SELF);
    assert_int_equal(position, size);
    for (int i = 0; i < n; i++) assert_int_equal(packed[i], element[i]);
    /* and back to where they were */
    for (int i = 0; i < 64; i++) memory[i] = -1;
    position = 0;
    MPI_Unpack(packed, sizeof packed, &position, memory, 1, t, MPI_COMM_SELF);
    int found = 0;
    for (int i = 0; i < 64; i++) found += memory[i] == i;
    assert_int_equal(found, n);
    MPI_Type_free(&t);
}

static void types(void *context)
{
    MPI_Datatype t, u;
    const int s = sizeof(int);
    (void)context;
    MPI_Type_vector(3, 2, 5, MPI_INT, &t);
    expect_elements(t, 6, (int[]){0, 1, 5, 6, 10, 11}, 0, 12);
    MPI_Type_indexed(3, (int[]){1, 3, 0}, (int[]){4, 8, 0}, MPI_INT, &t);
    expect_elements(t, 4, (int[]){4, 8, 9, 10}, 4, 7);
    MPI_Type_create_indexed_block(2, 2, (int[]){6, 1}, MPI_INT, &t);
    expect_elements(t, 4, (int[]){6, 7, 1, 2}, 1, 7);
    MPI_Type_create_hindexed(2, (int[]){1, 2}, (MPI_Aint[]){8 * s, 3 * s}, MPI_INT, &t);
    expect_elements(t, 3, (int[]){8, 3, 4}, 3, 6);
    MPI_Type_create_struct(2, (int[]){2, 1}, (MPI_Aint[]){s, 5 * s},
                           (MPI_Datatype[]){MPI_INT, MPI_INT}, &t);
    expect_elements(t, 3, (int[]){1, 2, 5}, 1, 5);
    MPI_Type_create_subarray(2, (int[]){4, 6}, (int[]){2, 3}, (int[]){1, 2}, MPI_ORDER_C, MPI_INT,
                             &t);
    expect_elements(t, 6, (int[]){8, 9, 10, 14, 15, 16}, 0, 24);
    MPI_Type_create_subarray(2, (int[]){6, 4}, (int[]){3, 2}, (int[]){2, 1}, MPI_ORDER_FORTRAN,
                             MPI_INT, &t);
    expect_elements(t, 6, (int[]){8, 9, 10, 14, 15, 16}, 0, 24);
    /* rank 1 of 2 x 2 has rows 0 and 1, and of the columns in turns of two those from 2 on */
    MPI_Type_create_darray(
        4, 1, 2, (int[]){4, 6}, (int[]){MPI_DISTRIBUTE_BLOCK, MPI_DISTRIBUTE_CYCLIC},
        (int[]){MPI_DISTRIBUTE_DFLT_DARG, 2}, (int[]){2, 2}, MPI_ORDER_C, MPI_INT, &t);
    expect_elements(t, 4, (int[]){2, 3, 8, 9}, 0, 24);
    MPI_Type_vector(2, 1, 3, MPI_INT, &u);
    MPI_Type_create_resized(u, 0, 8 * s, &t);
    MPI_Type_free(&u);
    expect_elements(t, 2, (int[]){0, 3}, 0, 8);
    int integers, addresses, datatypes, combiner, i[4];
    MPI_Aint a[1];
    MPI_Datatype d[1];
    MPI_Type_vector(3, 2, 5, MPI_INT, &t);
    MPI_Type_get_envelope(t, &integers, &addresses, &datatypes, &combiner);
    assert_true(integers == 3 && addresses == 0 && datatypes == 1 &&
                combiner == MPI_COMBINER_VECTOR);
    MPI_Type_get_contents(t, 4, 1, 1, i, a, d);
    assert_true(i[0] == 3 && i[1] == 2 && i[2] == 5 && d[0] == MPI_INT);
    MPI_Type_free(&t);
}

static void types_lie_where_they_say(void **state)
{
    (void)state;
    mpi_ok(1, types, NULL);
}

/* --- groups and communicators --- */

static void communicators(void *context)
{
    int n = all_ranks(), rank = own_rank(), r, m, result;
    MPI_Comm half, dup, none, inter, merged;
    MPI_Group all, odd, even, both;
    (void)context;
    MPI_Comm_split(MPI_COMM_WORLD, rank % 2, -rank, &half);
    MPI_Comm_rank(half, &r);
    MPI_Comm_size(half, &m);
    assert_int_equal(m, (n + 1 - rank % 2) / 2);
    assert_int_equal(r, m - 1 - rank / 2);
    MPI_Comm_split(MPI_COMM_WORLD, rank == 0 ? MPI_UNDEFINED : 1, 0, &none);
    assert_true((none == MPI_COMM_NULL) == (rank == 0));
    if (rank > 0) MPI_Comm_free(&none);
    MPI_Comm_dup(half, &dup);
    MPI_Comm_compare(half, dup, &result);
    assert_int_equal(result, MPI_CONGRUENT);
    int sum = 1;
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_INT, MPI_SUM, dup);
    assert_int_equal(sum, m);
    MPI_Comm_free(&dup);
    MPI_Comm_group(MPI_COMM_WORLD, &all);
    MPI_Comm_group(half, &odd);
    MPI_Group_difference(all, odd, &even);
    MPI_Group_union(odd, even, &both);
    MPI_Group_compare(all, both, &result);
    assert_true(result == MPI_IDENT || result == MPI_SIMILAR);
    MPI_Group_translate_ranks(odd, 1, &r, all, &result);
    assert_int_equal(result, rank);
    MPI_Comm_create_group(MPI_COMM_WORLD, odd, 5, &dup);
    MPI_Comm_size(dup, &result);
    assert_int_equal(result, m);
    MPI_Comm_free(&dup);
    /* between the halves: a sum of the other's, and one group of both */
    if (n > 1) {
        MPI_Intercomm_create(half, 0, MPI_COMM_WORLD, rank % 2 ? (n - 1) / 2 * 2 : n / 2 * 2 - 1, 3,
                             &inter);
        sum = rank;
        int other = 0;
        MPI_Allreduce(&sum, &other, 1, MPI_INT, MPI_SUM, inter);
        for (int k = 1 - rank % 2; k < n; k += 2) other -= k;
        assert_int_equal(other, 0);
        MPI_Intercomm_merge(inter, rank % 2, &merged);
        MPI_Comm_size(merged, &result);
        assert_int_equal(result, n);
        MPI_Comm_free(&merged);
        MPI_Comm_free(&inter);
    }
    MPI_Group_free(&all), MPI_Group_free(&odd), MPI_Group_free(&even), MPI_Group_free(&both);
    MPI_Comm_free(&half);
}

static void ranks_are_grouped_as_asked(void **state)
{
    (void)state;
    for (int n = 1; n <= 7; n++) mpi_ok(n, communicators, NULL);
}

/* --- topologies --- */

static void grid(void *context)
{
    int dims[2] = {0, 0}, periods[2] = {1, 0}, at[2], rank, from, to, n = all_ranks();
    MPI_Comm cart, row;
    (void)context;
    MPI_Dims_create(n, 2, dims);
    assert_true(dims[0] * dims[1] == n && dims[0] >= dims[1]);
    MPI_Cart_create(MPI_COMM_WORLD, 2, dims, periods, 1, &cart);
    MPI_Comm_rank(cart, &rank);
    MPI_Cart_coords(cart, rank, 2, at);
    MPI_Cart_shift(cart, 1, 1, &from, &to);
    assert_int_equal(to, at[1] + 1 < dims[1] ? rank + 1 : MPI_PROC_NULL);
    MPI_Cart_shift(cart, 0, 1, &from, &to);
    assert_int_equal(to, (at[0] + 1) % dims[0] * dims[1] + at[1]);
    int out[4], in[4] = {-1, -1, -1, -1};
    for (int k = 0; k < 4; k++) out[k] = 10 * rank + k;
    MPI_Neighbor_alltoall(out, 1, MPI_INT, in, 1, MPI_INT, cart);
    /* what comes from one side was sent to the other */
    assert_int_equal(in[0], 10 * from + 1);
    assert_int_equal(in[1], 10 * to + 0);
    assert_int_equal(in[3], at[1] + 1 < dims[1] ? 10 * (rank + 1) + 2 : -1);
    MPI_Cart_sub(cart, (int[]){0, 1}, &row);
    int size, sum = 1;
    MPI_Comm_size(row, &size);
    assert_int_equal(size, dims[1]);
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_INT, MPI_SUM, row);
    assert_int_equal(sum, dims[1]);
    MPI_Comm_free(&row);
    MPI_Comm_free(&cart);
}

/* A ring by edges that the rank before names: everybody hears from the left and tells the right. */
static void graph(void *context)
{
    int n = all_ranks(), rank = own_rank(), one = 1, next = (rank + 1) % n, after = (rank + 2) % n,
        in, out, weighted;
    MPI_Comm ring;
    (void)context;
    MPI_Dist_graph_create(MPI_COMM_WORLD, 1, &next, &one, &after, MPI_UNWEIGHTED, MPI_INFO_NULL, 0,
                          &ring);
    MPI_Dist_graph_neighbors_count(ring, &in, &out, &weighted);
    assert_true(in == 1 && out == 1 && !weighted);
    int got = -1;
    MPI_Neighbor_allgather(&rank, 1, MPI_INT, &got, 1, MPI_INT, ring);
    assert_int_equal(got, (rank + n - 1) % n);
    MPI_Comm_free(&ring);
}

static void neighbours_are_those_of_the_topology(void **state)
{
    (void)state;
    for (int n = 1; n <= 12; n++) mpi_ok(n, grid, NULL);
    for (int n = 1; n <= 5; n++) mpi_ok(n, graph, NULL);
}

/* --- attributes and info --- */

static int copies, deletions;
static int copy(MPI_Comm c, int keyval, void *extra, void *in, void *out, int *flag)
{
    (void)c, (void)keyval;
    copies++;
    *(void **)out = (char *)in + *(int *)extra;
    *flag = 1;
    return MPI_SUCCESS;
}
static int delete_one(MPI_Comm c, int keyval, void *value, void *extra)
{
    (void)c, (void)keyval, (void)value, (void)extra;
    deletions++;
    return MPI_SUCCESS;
}

static void attributes(void *context)
{
    static char place[100];
    int keyval, flag, extra = 7, *last, length;
    char *found, value[20];
    MPI_Comm dup;
    MPI_Info info;
    (void)context;
    MPI_Comm_create_keyval(copy, delete_one, &keyval, &extra);
    MPI_Comm_set_attr(MPI_COMM_WORLD, keyval, place);
    MPI_Comm_dup(MPI_COMM_WORLD, &dup);
    MPI_Comm_get_attr(dup, keyval, &found, &flag);
    assert_true(flag && found == place + 7);
    MPI_Comm_free(&dup);
    MPI_Comm_delete_attr(MPI_COMM_WORLD, keyval);
    MPI_Comm_get_attr(MPI_COMM_WORLD, keyval, &found, &flag);
    assert_false(flag);
    MPI_Comm_free_keyval(&keyval);
    MPI_Comm_create_keyval(MPI_COMM_DUP_FN, MPI_COMM_NULL_DELETE_FN, &keyval, NULL);
    MPI_Comm_set_attr(MPI_COMM_WORLD, keyval, place);
    MPI_Comm_dup(MPI_COMM_WORLD, &dup);
    MPI_Comm_get_attr(dup, keyval, &found, &flag);
    assert_true(flag && found == place);
    MPI_Comm_free(&dup);
    MPI_Comm_free_keyval(&keyval);
    MPI_Comm_get_attr(MPI_COMM_WORLD, MPI_TAG_UB, &last, &flag);
    assert_true(flag && *last >= 32767);
    MPI_Info_create(&info);
    MPI_Info_set(info, "one", " first ");
    MPI_Info_set(info, "two", "second");
    MPI_Info_set(info, "one", "third");
    MPI_Info_get(info, "one", 19, value, &flag);
    assert_true(flag && strcmp(value, "third") == 0);
    MPI_Info_get_nkeys(info, &length);
    assert_int_equal(length, 2);
    MPI_Info_delete(info, "one");
    MPI_Info_get(info, "one", 19, value, &flag);
    assert_false(flag);
    MPI_Info_free(&info);
}

static void values_are_copied_and_deleted(void **state)
{
    (void)state;
    copies = deletions = 0;
    mpi_ok(3, attributes, NULL);
    assert_int_equal(copies, 3);
    assert_int_equal(deletions, 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(types_lie_where_they_say),
        cmocka_unit_test(ranks_are_grouped_as_asked),
        cmocka_unit_test(neighbours_are_those_of_the_topology),
        cmocka_unit_test(values_are_copied_and_deleted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
