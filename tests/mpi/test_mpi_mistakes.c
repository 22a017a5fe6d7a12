/* test_mpi_mistakes.c - what programs do wrong: each ends the run by rank, call and values, or
 * returns its class. */
#include "mpi_world.h"

static int data[4];

static void too_long(void *context)
{
    (void)context;
    if (own_rank() == 0) MPI_Send(data, 4, MPI_INT, 1, 3, MPI_COMM_WORLD);
    else MPI_Recv(data, 2, MPI_INT, 0, 3, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}
static void no_rank(void *context)
{
    (void)context;
    MPI_Send(data, 1, MPI_INT, 2, 0, MPI_COMM_WORLD);
}
static void negative_count(void *context)
{
    (void)context;
    MPI_Send(data, -1, MPI_INT, 0, 0, MPI_COMM_WORLD);
}
static void negative_tag(void *context)
{
    (void)context;
    MPI_Send(data, 1, MPI_INT, 0, -5, MPI_COMM_WORLD);
}
static void null_buffer(void *context)
{
    (void)context;
    MPI_Send(NULL, 1, MPI_INT, 0, 0, MPI_COMM_WORLD);
}
static void freed_type(void *context)
{
    MPI_Datatype t, kept;
    (void)context;
    MPI_Type_contiguous(2, MPI_INT, &t);
    MPI_Type_commit(&t);
    kept = t;
    MPI_Type_free(&t);
    MPI_Send(data, 1, kept, 0, 0, MPI_COMM_WORLD);
}
static void not_committed(void *context)
{
    MPI_Datatype t;
    (void)context;
    MPI_Type_contiguous(2, MPI_INT, &t);
    MPI_Send(data, 1, t, 0, 0, MPI_COMM_WORLD);
}
static void wrong_kind(void *context)
{
    MPI_Group g;
    int n;
    (void)context;
    MPI_Comm_group(MPI_COMM_WORLD, &g);
    MPI_Comm_size((MPI_Comm)(intptr_t)g, &n);
}
static void wrong_op(void *context)
{
    double x = 1, y;
    (void)context;
    MPI_Allreduce(&x, &y, 1, MPI_DOUBLE, MPI_BAND, MPI_COMM_WORLD);
}
static void wrong_root(void *context)
{
    (void)context;
    MPI_Bcast(data, 1, MPI_INT, 9, MPI_COMM_WORLD);
}
static void unfinished(void *context)
{
    static MPI_Request q;
    (void)context;
    MPI_Irecv(data, 1, MPI_INT, 0, 9, MPI_COMM_WORLD, &q);
}
static void aborts(void *context)
{
    (void)context;
    if (own_rank() == 1) MPI_Abort(MPI_COMM_WORLD, 42);
    MPI_Barrier(MPI_COMM_WORLD);
}
static void refused(void *context)
{
    MPI_File f;
    (void)context;
    MPI_File_open(MPI_COMM_WORLD, "x", MPI_MODE_RDONLY, MPI_INFO_NULL, &f);
}
static void outside_of_grid(void *context)
{
    const int size = 2, not_periodic = 0, at = 2;
    int rank;
    MPI_Comm line;
    (void)context;
    MPI_Cart_create(MPI_COMM_WORLD, 1, &size, &not_periodic, 0, &line);
    MPI_Cart_rank(line, &at, &rank);
}
static void late(void *context)
{
    (void)context;
    MPI_Finalize();
    MPI_Barrier(MPI_COMM_WORLD);
}
static void too_large_for_buffer(void *context)
{
    static char room[100];
    (void)context;
    MPI_Buffer_attach(room, 4);
    MPI_Bsend(data, 4, MPI_INT, 0, 0, MPI_COMM_WORLD);
}

static void mistakes_are_told(void **state)
{
    static const struct {
        mpi_program *program;
        const char *text;
    } mistake[] = {
        {too_long,
         "MPI_Recv: the message of 16 bytes from rank 0 with tag 3 is longer than the buffer of 8"},
        {no_rank, "MPI_Send: rank 2 is not in the communicator of 2 ranks"},
        {negative_count, "MPI_Send: count -1 is negative"},
        {negative_tag, "MPI_Send: tag -5 is negative"},
        {null_buffer, "MPI_Send: the buffer is NULL"},
        {freed_type, "is not the handle of a datatype (or it was freed)"},
        {not_committed, "the datatype was not committed"},
        {wrong_kind, "a communicator is expected, and the handle is a group's"},
        {wrong_op, "MPI_BAND is not defined on MPI_DOUBLE"},
        {wrong_root, "root 9 is not in the communicator of 2 ranks"},
        {unfinished, "MPI_Finalize: 1 request was started and neither completed nor freed"},
        {aborts, "the program ends the run with code 42"},
        {refused, "MPI_File_open: this function is not supported: MPI-IO"},
        {outside_of_grid, "the coordinates are outside of a dimension that is not periodic"},
        {late, "MPI_Barrier: called after MPI_Finalize"},
        {too_large_for_buffer, "16 bytes do not fit in the attached buffer of 4"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof mistake / sizeof mistake[0]; k++)
        mpi_fails(2, mistake[k].program, NULL, mistake[k].text);
}

/* --- without Init or Finalize --- */

static void early(void *context)
{
    (void)context;
    MPI_Barrier(MPI_COMM_WORLD);
}
static void never_ends(void *context)
{
    int flag;
    (void)context;
    MPI_Initialized(&flag);
    assert_false(flag);
    MPI_Init(NULL, NULL);
    MPI_Initialized(&flag);
    assert_true(flag);
}

static void init_and_finalize_are_asked_for(void **state)
{
    static const struct mpi_setup setup;
    struct machine_spec m = crossbar(2);
    (void)state;
    struct outcome a = mpi_bare(&m, 2, &setup, early, NULL),
                   b = mpi_bare(&m, 2, &setup, never_ends, NULL);
    assert_non_null(strstr(a.r.text, "MPI_Barrier: called before MPI_Init"));
    assert_non_null(strstr(b.r.text, "the program ends without MPI_Finalize"));
    arena_destroy(a.arena);
    arena_destroy(b.arena);
}

/* --- handlers --- */

static int told;
static void handler(MPI_Comm *comm, int *code, ...)
{
    assert_true(*comm == MPI_COMM_WORLD);
    told += *code;
}

static void returned(void *context)
{
    MPI_Errhandler h;
    char text[MPI_MAX_ERROR_STRING];
    int length, class, code;
    (void)context;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    assert_int_equal(MPI_Send(data, 1, MPI_INT, 99, 0, MPI_COMM_WORLD), MPI_ERR_RANK);
    assert_int_equal(MPI_Send(data, -1, MPI_INT, 0, 0, MPI_COMM_WORLD), MPI_ERR_COUNT);
    MPI_Error_string(MPI_ERR_RANK, text, &length);
    assert_string_equal(text, "invalid rank");
    MPI_Comm_create_errhandler(handler, &h);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, h);
    MPI_Errhandler_free(&h);
    assert_int_equal(MPI_Send(data, 1, MPI_INT, 99, 0, MPI_COMM_WORLD), MPI_ERR_RANK);
    MPI_Add_error_class(&class);
    MPI_Add_error_code(class, &code);
    MPI_Add_error_string(code, "mine");
    MPI_Error_string(code, text, &length);
    assert_string_equal(text, "mine");
    MPI_Error_class(code, &length);
    assert_int_equal(length, class);
}

static void handlers_and_codes_are_the_programs(void **state)
{
    (void)state;
    told = 0;
    mpi_ok(3, returned, NULL);
    assert_int_equal(told, 3 * MPI_ERR_RANK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_are_told),
        cmocka_unit_test(init_and_finalize_are_asked_for),
        cmocka_unit_test(handlers_and_codes_are_the_programs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
