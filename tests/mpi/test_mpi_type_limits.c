/* test_mpi_type_limits.c - datatypes at their limits: messages that end inside of an element, wrong
 * arguments, packing into too little room, names that are too long, types by precision. */
#include "mpi_world.h"

static void return_errors(void) { MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN); }

/* --- a message that ends inside of an element --- */

static void cut(void *context)
{
    MPI_Datatype t, none;
    MPI_Status s = {0};
    int n;
    (void)context;
    return_errors();
    /* 4 bytes of the second double are no int */
    MPI_Type_create_struct(2, (int[]){2, 1}, (MPI_Aint[]){0, 16},
                           (MPI_Datatype[]){MPI_DOUBLE, MPI_INT}, &t);
    MPI_Status_set_elements(&s, MPI_BYTE, 12);
    MPI_Get_elements(&s, t, &n);
    assert_int_equal(n, MPI_UNDEFINED);
    MPI_Status_set_elements(&s, MPI_BYTE, 20 + 8);
    MPI_Get_elements(&s, t, &n);
    assert_int_equal(n, 4);
    MPI_Type_free(&t);
    /* elements of nothing in front of it */
    MPI_Type_contiguous(0, MPI_INT, &none);
    MPI_Type_create_struct(2, (int[]){1, 2}, (MPI_Aint[]){0, 0}, (MPI_Datatype[]){none, MPI_INT},
                           &t);
    MPI_Status_set_elements(&s, MPI_BYTE, 4);
    MPI_Get_elements(&s, t, &n);
    assert_int_equal(n, 1);
    MPI_Status_set_elements(&s, MPI_BYTE, 6);
    MPI_Get_elements(&s, t, &n);
    assert_int_equal(n, MPI_UNDEFINED);
    MPI_Type_free(&t);
    MPI_Type_free(&none);
    assert_int_equal(MPI_Status_set_elements(&s, MPI_INT, -1), MPI_ERR_COUNT);
    /* pairs are two elements each */
    MPI_Status_set_elements(&s, MPI_DOUBLE_INT, 3);
    MPI_Get_elements(&s, MPI_BYTE, &n);
    assert_int_equal(n, 20);
    MPI_Get_elements(&s, MPI_DOUBLE_INT, &n);
    assert_int_equal(n, 3);
    MPI_Get_count(&s, MPI_DOUBLE_INT, &n);
    assert_int_equal(n, MPI_UNDEFINED);
}

static void cut_messages_count_whole_elements(void **state)
{
    (void)state;
    mpi_ok(1, cut, NULL);
}

/* --- refusals --- */

static void refusals(void *context)
{
    const MPI_Datatype I = MPI_INT;
    MPI_Datatype t, two[] = {I, MPI_DATATYPE_NULL};
    const int one[] = {1, 1}, minus[] = {1, -1}, big[] = {9}, zero[] = {0};
    const MPI_Aint far[] = {0, 0};
    const MPI_Count huge[] = {INT64_MAX}, single[] = {1};
    const int c = MPI_ORDER_C;
    (void)context;
    return_errors();
    assert_int_equal(MPI_Type_contiguous(-1, I, &t), MPI_ERR_COUNT);
    assert_int_equal(MPI_Type_contiguous(1, MPI_DATATYPE_NULL, &t), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_vector(-1, 1, 1, I, &t), MPI_ERR_COUNT);
    assert_int_equal(MPI_Type_vector(1, -1, 1, I, &t), MPI_ERR_ARG);
    assert_int_equal(MPI_Type_create_hvector(1, -1, 1, I, &t), MPI_ERR_ARG);
    assert_int_equal(MPI_Type_indexed(-1, one, one, I, &t), MPI_ERR_COUNT);
    assert_int_equal(MPI_Type_indexed(2, minus, one, I, &t), MPI_ERR_ARG);
    assert_int_equal(MPI_Type_create_hindexed(2, minus, far, I, &t), MPI_ERR_ARG);
    assert_int_equal(MPI_Type_create_indexed_block(2, -1, one, I, &t), MPI_ERR_ARG);
    assert_int_equal(MPI_Type_create_hindexed_block(-2, 1, far, I, &t), MPI_ERR_COUNT);
    assert_int_equal(MPI_Type_create_struct(-1, one, far, two, &t), MPI_ERR_COUNT);
    assert_int_equal(MPI_Type_create_struct(2, one, far, two, &t), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_create_struct(1, minus + 1, far, two, &t), MPI_ERR_ARG);
    assert_int_equal(MPI_Type_create_subarray(0, one, one, one, c, I, &t), MPI_ERR_DIMS);
    static const int parts[][3] = {{0, 1, 0},  {3, 0, 0}, {3, 4, 0}, {3, 1, 3},
                                   {3, 1, -1}, {3, 2, 2}, {3, 3, 1}};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        const int *p = parts[k];
        assert_int_equal(MPI_Type_create_subarray(1, p, p + 1, p + 2, c, I, &t), MPI_ERR_ARG);
    }
    assert_int_equal(MPI_Type_create_subarray(1, big, one, zero, c + 1000, I, &t), MPI_ERR_ARG);
    assert_int_equal(MPI_Type_create_subarray_c(1, huge, single, huge, c, I, &t), MPI_ERR_ARG);
    t = I;
    assert_int_equal(MPI_Type_free(&t), MPI_ERR_TYPE);
    t = MPI_DATATYPE_NULL;
    assert_int_equal(MPI_Type_commit(&t), MPI_ERR_TYPE);
    assert_int_equal(MPI_Type_free(&t), MPI_ERR_TYPE);
}

static void wrong_arrays(void *context)
{
    const int block[] = {MPI_DISTRIBUTE_BLOCK, 99}, cyclic[] = {MPI_DISTRIBUTE_CYCLIC};
    const int none[] = {MPI_DISTRIBUTE_NONE}, zero[] = {0}, both[] = {2, 2}, nine[] = {9, 9};
    const int dflt[] = {MPI_DISTRIBUTE_DFLT_DARG, MPI_DISTRIBUTE_DFLT_DARG};
    const int m1[] = {-1}, m2[] = {-2, -2}, c = MPI_ORDER_C;
    const MPI_Datatype I = MPI_INT;
    MPI_Datatype t;
    (void)context;
    return_errors();
    /* size, rank, dimensions, sizes, distributions, arguments, grid, order */
    static const struct {
        int size, rank, n;
    } d[] = {{2, 2, 1}, {2, -1, 1}, {3, 0, 1}, {2, 0, 0}};
    for (size_t k = 0; k < 4; k++)
        assert_int_equal(
            MPI_Type_create_darray(d[k].size, d[k].rank, d[k].n, nine, block, dflt, both, c, I, &t),
            MPI_ERR_ARG);
    assert_int_equal(MPI_Type_create_darray(4, 0, 2, nine, block, dflt, both, c, I, &t),
                     MPI_ERR_ARG); /* a distribution that there is not */
    assert_int_equal(MPI_Type_create_darray(2, 0, 1, nine, none, dflt, both, c, I, &t),
                     MPI_ERR_ARG); /* not distributed over two */
    assert_int_equal(MPI_Type_create_darray(2, 0, 1, nine, block, (int[]){4}, both, c, I, &t),
                     MPI_ERR_ARG); /* two blocks of 4 for 9 */
    assert_int_equal(MPI_Type_create_darray(2, 0, 1, nine, cyclic, zero, both, c, I, &t),
                     MPI_ERR_ARG);
    assert_int_equal(MPI_Type_create_darray(2, 0, 1, zero, cyclic, dflt, both, c, I, &t),
                     MPI_ERR_ARG);
    assert_int_equal(MPI_Type_create_darray(4, 0, 2, nine, cyclic, dflt, m2, c, I, &t),
                     MPI_ERR_ARG);
    assert_int_equal(MPI_Type_create_darray(-1, 0, 1, nine, cyclic, dflt, m1, c, I, &t),
                     MPI_ERR_ARG);
    assert_int_equal(MPI_Type_create_darray(2, 0, 1, nine, block, dflt, both, 77, I, &t),
                     MPI_ERR_ARG);
}

static void packs(void *context)
{
    char out[16];
    int in[4] = {1, 2, 3, 4}, position = 0;
    MPI_Count at = 0, size;
    const MPI_Comm w = MPI_COMM_WORLD;
    (void)context;
    return_errors();
    assert_int_equal(MPI_Pack(in, -1, MPI_INT, out, 16, &position, w), MPI_ERR_COUNT);
    assert_int_equal(MPI_Pack(in, 4, MPI_INT, out, 15, &position, w), MPI_ERR_TRUNCATE);
    assert_int_equal(position, 0);
    assert_int_equal(MPI_Pack(in, 4, MPI_INT, out, 16, &position, w), MPI_SUCCESS);
    assert_int_equal(position, 16);
    assert_int_equal(MPI_Pack(in, 1, MPI_CHAR, out, 16, &position, w), MPI_ERR_TRUNCATE);
    assert_int_equal(MPI_Pack(in, 0, MPI_CHAR, out, 16, &position, w), MPI_SUCCESS);
    position = 13;
    assert_int_equal(MPI_Unpack(out, 16, &position, in, 1, MPI_INT, w), MPI_ERR_TRUNCATE);
    assert_int_equal(MPI_Unpack(out, 16, &position, in, -1, MPI_INT, w), MPI_ERR_COUNT);
    position = -4;
    assert_int_equal(MPI_Unpack(out, 16, &position, in, 1, MPI_INT, w), MPI_ERR_TRUNCATE);
    assert_int_equal(MPI_Pack(in, 1, MPI_INT, out, 16, &position, w), MPI_ERR_TRUNCATE);
    assert_int_equal(MPI_Pack(in, 1, MPI_DATATYPE_NULL, out, 16, &position, w), MPI_ERR_TYPE);
    assert_int_equal(MPI_Pack(in, 1, MPI_INT, out, 16, &position, MPI_COMM_NULL), MPI_ERR_COMM);
    /* more than any memory: not a small number by wrapping */
    assert_int_equal(MPI_Pack_c(in, (MPI_Count)1 << 62, MPI_INT, out, 16, &at, w),
                     MPI_ERR_TRUNCATE);
    assert_int_equal(MPI_Unpack_c(out, 16, &at, in, (MPI_Count)1 << 62, MPI_INT, w),
                     MPI_ERR_TRUNCATE);
    at = INT64_MAX - 2;
    assert_int_equal(MPI_Pack_c(in, 1, MPI_INT, out, 16, &at, w), MPI_ERR_TRUNCATE);
    assert_int_equal(MPI_Unpack_c(out, 16, &at, in, 1, MPI_INT, w), MPI_ERR_TRUNCATE);
    assert_int_equal(MPI_Pack_size(3, MPI_DOUBLE_INT, w, &position), MPI_SUCCESS);
    assert_int_equal(position, 36);
    assert_int_equal(MPI_Pack_size(-1, MPI_INT, w, &position), MPI_ERR_COUNT);
    assert_int_equal(MPI_Pack_size_c((MPI_Count)1 << 40, MPI_INT, w, &size), MPI_SUCCESS);
    assert_true(size == (MPI_Count)1 << 42);
    assert_int_equal(MPI_Pack_size(1 << 30, MPI_INT, w, &position), MPI_SUCCESS);
    assert_int_equal(position, MPI_UNDEFINED); /* more than an int holds */
}

static void far_away(void *context)
{
    MPI_Datatype t;
    (void)context;
    MPI_Type_create_hvector(3, 1, (MPI_Aint)1 << 60, MPI_INT, &t);
}

static void wrong_types_are_refused(void **state)
{
    (void)state;
    mpi_ok(1, refusals, NULL);
    mpi_ok(1, wrong_arrays, NULL);
    mpi_ok(1, packs, NULL);
    mpi_fails(1, far_away, NULL, "a datatype reaches over more than 2^56 bytes");
}

/* --- names, and types by precision --- */

static void names(void *context)
{
    char name[MPI_MAX_OBJECT_NAME], longer[3 * MPI_MAX_OBJECT_NAME];
    MPI_Datatype t, u;
    int n;
    (void)context;
    MPI_Type_get_name(MPI_2DOUBLE_PRECISION, name, &n);
    assert_string_equal(name, "MPI_2DOUBLE_PRECISION");
    MPI_Type_get_name(MPI_DATATYPE_NULL, name, &n);
    assert_string_equal(name, "MPI_DATATYPE_NULL");
    assert_int_equal(n, 17);
    MPI_Type_contiguous(1, MPI_INT, &t);
    MPI_Type_get_name(t, name, &n);
    assert_true(n == 0 && name[0] == '\0');
    memset(longer, 'x', sizeof longer);
    longer[sizeof longer - 1] = '\0';
    MPI_Type_set_name(t, longer);
    MPI_Type_get_name(t, name, &n);
    assert_int_equal(n, MPI_MAX_OBJECT_NAME - 1);
    assert_int_equal(strlen(name), n);
    MPI_Type_dup(t, &u);
    MPI_Type_get_name(u, name, &n);
    assert_int_equal(n, 0); /* names are not copied */
    MPI_Type_free(&u);
    MPI_Type_free(&t);
    MPI_Comm_set_name(MPI_COMM_WORLD, longer);
    MPI_Comm_get_name(MPI_COMM_WORLD, name, &n);
    assert_int_equal(n, MPI_MAX_OBJECT_NAME - 1);
    assert_int_equal(strlen(name), n);
}

static void by_precision(void *context)
{
    static const struct {
        int p, r;
        MPI_Datatype real, complex;
    } row[] = {
        {6, 37, MPI_REAL4, MPI_COMPLEX8},
        {7, 37, MPI_REAL8, MPI_COMPLEX16},
        {6, 38, MPI_REAL8, MPI_COMPLEX16},
        {15, 307, MPI_REAL8, MPI_COMPLEX16},
        {16, 307, MPI_REAL16, MPI_COMPLEX32},
        {15, 308, MPI_REAL16, MPI_COMPLEX32},
        {33, 4931, MPI_REAL16, MPI_COMPLEX32},
        {34, 0, MPI_DATATYPE_NULL, MPI_DATATYPE_NULL},
        {0, 4932, MPI_DATATYPE_NULL, MPI_DATATYPE_NULL},
        {MPI_UNDEFINED, 100, MPI_REAL8, MPI_COMPLEX16},
        {3, MPI_UNDEFINED, MPI_REAL4, MPI_COMPLEX8},
    };
    MPI_Datatype t;
    (void)context;
    return_errors();
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        const int code = row[k].real == MPI_DATATYPE_NULL ? MPI_ERR_ARG : MPI_SUCCESS;
        assert_int_equal(MPI_Type_create_f90_real(row[k].p, row[k].r, &t), code);
        assert_true(code || t == row[k].real);
        assert_int_equal(MPI_Type_create_f90_complex(row[k].p, row[k].r, &t), code);
        assert_true(code || t == row[k].complex);
    }
}

static void by_size(void *context)
{
    static const struct {
        int class, size;
        MPI_Datatype type;
    } match[] = {
        {MPI_TYPECLASS_INTEGER, 1, MPI_INTEGER1},
        {MPI_TYPECLASS_INTEGER, 8, MPI_INTEGER8},
        {MPI_TYPECLASS_REAL, 4, MPI_REAL4},
        {MPI_TYPECLASS_REAL, 16, MPI_REAL16},
        {MPI_TYPECLASS_COMPLEX, 8, MPI_COMPLEX8},
        {MPI_TYPECLASS_REAL, 2, MPI_DATATYPE_NULL},
        {MPI_TYPECLASS_COMPLEX, 4, MPI_DATATYPE_NULL},
        {12345, 4, MPI_DATATYPE_NULL},
    };
    static const int range[] = {1, 2, 3, 4, 5, 9, 10, 18, 19},
                     bytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 0};
    MPI_Datatype t;
    int size;
    (void)context;
    return_errors();
    for (size_t k = 0; k < sizeof match / sizeof *match; k++) {
        const int code = match[k].type == MPI_DATATYPE_NULL ? MPI_ERR_ARG : MPI_SUCCESS;
        assert_int_equal(MPI_Type_match_size(match[k].class, match[k].size, &t), code);
        assert_true(code || t == match[k].type);
    }
    for (size_t k = 0; k < sizeof range / sizeof *range; k++) {
        const int code = bytes[k] ? MPI_SUCCESS : MPI_ERR_ARG;
        assert_int_equal(MPI_Type_create_f90_integer(range[k], &t), code);
        if (code == MPI_SUCCESS) MPI_Type_size(t, &size), assert_int_equal(size, bytes[k]);
    }
    MPI_Type_get_value_index(MPI_LONG, MPI_INT, &t);
    assert_true(t == MPI_LONG_INT);
    MPI_Type_get_value_index(MPI_LONG, MPI_LONG, &t);
    assert_true(t == MPI_DATATYPE_NULL);
    MPI_Type_get_value_index(MPI_CHAR, MPI_INT, &t);
    assert_true(t == MPI_DATATYPE_NULL);
    assert_int_equal(MPI_Type_get_value_index(MPI_DATATYPE_NULL, MPI_INT, &t), MPI_ERR_TYPE);
}

static void names_and_precisions_have_their_limits(void **state)
{
    (void)state;
    mpi_ok(1, names, NULL);
    mpi_ok(1, by_precision, NULL);
    mpi_ok(1, by_size, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cut_messages_count_whole_elements),
        cmocka_unit_test(wrong_types_are_refused),
        cmocka_unit_test(names_and_precisions_have_their_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
