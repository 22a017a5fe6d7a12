/* test_mpi_operators.c - each operation on each type on which the standard defines it, against
 * plain arithmetic of 128 bits; on which types it is none; the order of the program's own. */
#include <complex.h>
#include <math.h>

#include "base/random.h"
#include "mpi_world.h"

static void return_errors(void) { MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN); }

enum { MOST = 9 };
typedef __int128 wide;

/* --- integers of any width --- */

struct whole {
    MPI_Datatype type;
    int bytes;
    bool sign;
};

static const struct whole wholes[] = {
    {MPI_SIGNED_CHAR, 1, true}, {MPI_UNSIGNED_CHAR, 1, false},
    {MPI_SHORT, 2, true},       {MPI_UNSIGNED_SHORT, 2, false},
    {MPI_INT, 4, true},         {MPI_UNSIGNED, 4, false},
    {MPI_LONG, 8, true},        {MPI_UNSIGNED_LONG, 8, false},
    {MPI_LONG_LONG, 8, true},   {MPI_UNSIGNED_LONG_LONG, 8, false},
    {MPI_INT8_T, 1, true},      {MPI_UINT8_T, 1, false},
    {MPI_INT16_T, 2, true},     {MPI_UINT16_T, 2, false},
    {MPI_INT32_T, 4, true},     {MPI_UINT32_T, 4, false},
    {MPI_INT64_T, 8, true},     {MPI_UINT64_T, 8, false},
    {MPI_INTEGER, 4, true},     {MPI_INTEGER1, 1, true},
    {MPI_INTEGER2, 2, true},    {MPI_INTEGER4, 4, true},
    {MPI_INTEGER8, 8, true},    {MPI_AINT, 8, true},
    {MPI_COUNT, 8, true},       {MPI_OFFSET, 8, true},
};

/* Elements are little-endian here, as on every host of the simulator. */
static wide get(const char *at, int bytes, bool sign)
{
    uint64_t bits = 0;
    memcpy(&bits, at, (size_t)bytes);
    wide x = bits;
    if (sign && bits >> (8 * bytes - 1) & 1) x -= (wide)1 << 8 * bytes;
    return x;
}
static void put(char *at, int bytes, wide x)
{
    const uint64_t bits = (uint64_t)x;
    memcpy(at, &bits, (size_t)bytes);
}

/* a op b by the standard's words; b is the second operand. */
static wide combined(MPI_Op op, wide a, wide b)
{
    if (op == MPI_SUM) return a + b;
    if (op == MPI_PROD) return (wide)((unsigned __int128)a * (unsigned __int128)b);
    if (op == MPI_MAX) return a > b ? a : b;
    if (op == MPI_MIN) return a < b ? a : b;
    if (op == MPI_LAND) return a && b;
    if (op == MPI_LOR) return a || b;
    if (op == MPI_LXOR) return !a != !b;
    if (op == MPI_BAND) return a & b;
    if (op == MPI_BOR) return a | b;
    assert_true(op == MPI_BXOR);
    return a ^ b;
}

static const struct {
    MPI_Op op;
    bool logical, bits, order;
} ops[] = {{MPI_SUM, false, false, false}, {MPI_PROD, false, false, false},
           {MPI_MAX, false, false, true},  {MPI_MIN, false, false, true},
           {MPI_LAND, true, false, false}, {MPI_LOR, true, false, false},
           {MPI_LXOR, true, false, false}, {MPI_BAND, false, true, false},
           {MPI_BOR, false, true, false},  {MPI_BXOR, false, true, false}};
enum { OPS = sizeof ops / sizeof *ops };

/* Numbers at the ends of the range, around zero, and anywhere. */
static uint64_t draw(struct random *r)
{
    static const uint64_t ends[] = {0,          1,          2,         UINT64_MAX,
                                    0x7f,       0x80,       0x7fff,    0x8000,
                                    0x7fffffff, 0x80000000, INT64_MAX, (uint64_t)INT64_MAX + 1};
    return random_below(r, 2) ? ends[random_below(r, sizeof ends / sizeof *ends)] : random_u64(r);
}

static void integers(void *context)
{
    struct random r = random_make(51, 0, 0);
    (void)context;
    for (size_t k = 0; k < sizeof wholes / sizeof *wholes; k++) {
        const struct whole *w = &wholes[k];
        for (int o = 0; o < OPS; o++)
            for (int n = 0; n <= MOST; n += 3) {
                char in[8 * MOST + 1], out[8 * MOST + 1], kept[8 * MOST + 1];
                for (int i = 0; i < 8 * MOST + 1; i++) in[i] = kept[i] = 0x5a;
                for (int i = 0; i < n; i++) {
                    put(in + i * w->bytes, w->bytes, draw(&r));
                    put(kept + i * w->bytes, w->bytes, draw(&r));
                }
                memcpy(out, kept, sizeof out);
                assert_int_equal(MPI_Reduce_local(in, out, n, w->type, ops[o].op), MPI_SUCCESS);
                for (int i = 0; i < n; i++) {
                    put(kept + i * w->bytes, w->bytes,
                        combined(ops[o].op, get(in + i * w->bytes, w->bytes, w->sign),
                                 get(kept + i * w->bytes, w->bytes, w->sign)));
                }
                if (memcmp(out, kept, sizeof out)) fail_msg("type %d, op %d", (int)k, o);
            }
    }
}

/* Bits of bytes, and truths: those of C are 0 or 1, those of Fortran true when not 0. */
static void bytes_and_truths(void *context)
{
    static const struct {
        MPI_Datatype type;
        int bytes;
    } truth[] = {{MPI_C_BOOL, 1},   {MPI_CXX_BOOL, 1}, {MPI_LOGICAL, 4}, {MPI_LOGICAL1, 1},
                 {MPI_LOGICAL2, 2}, {MPI_LOGICAL4, 4}, {MPI_LOGICAL8, 8}};
    (void)context;
    return_errors();
    for (size_t k = 0; k < sizeof truth / sizeof *truth; k++)
        for (int o = 0; o < OPS; o++) {
            char in[64] = {0}, out[64] = {0};
            const int b = truth[k].bytes;
            for (int i = 0; i < 4; i++) put(in + i * b, b, i & 1), put(out + i * b, b, i >> 1);
            const int code = MPI_Reduce_local(in, out, 4, truth[k].type, ops[o].op);
            assert_int_equal(code, ops[o].logical ? MPI_SUCCESS : MPI_ERR_OP);
            for (int i = 0; i < 4; i++)
                assert_int_equal(get(out + i * b, b, false),
                                 code ? i >> 1 : (int)combined(ops[o].op, i & 1, i >> 1));
        }
    for (int o = 0; o < OPS; o++) {
        unsigned char in[2] = {0x0f, 0xaa}, out[2] = {0x35, 0xff};
        const int code = MPI_Reduce_local(in, out, 2, MPI_BYTE, ops[o].op);
        assert_int_equal(code, ops[o].bits ? MPI_SUCCESS : MPI_ERR_OP);
        assert_int_equal(out[0], code ? 0x35 : (int)combined(ops[o].op, 0x0f, 0x35));
        assert_int_equal(out[1], code ? 0xff : (int)combined(ops[o].op, 0xaa, 0xff));
    }
}

static void integers_are_combined_modulo_their_range(void **state)
{
    (void)state;
    mpi_ok(1, integers, NULL);
    mpi_ok(1, bytes_and_truths, NULL);
}

/* --- numbers with fractions, complex ones, pairs --- */

/* Quarters of small numbers: sums and products are exact in all types. */
#define REAL(name, type, handle)                                                                   \
    static void name(struct random *r)                                                             \
    {                                                                                              \
        for (int o = 0; o < 4; o++) {                                                              \
            type in[MOST], out[MOST], kept[MOST];                                                  \
            for (int i = 0; i < MOST; i++) {                                                       \
                in[i] = (type)((int)random_below(r, 201) - 100) / 4;                               \
                kept[i] = out[i] = (type)((int)random_below(r, 201) - 100) / 4;                    \
            }                                                                                      \
            assert_int_equal(MPI_Reduce_local(in, out, MOST - 1, handle, ops[o].op), MPI_SUCCESS); \
            for (int i = 0; i < MOST; i++) {                                                       \
                type x = kept[i];                                                                  \
                if (o == 0) x = in[i] + x;                                                         \
                if (o == 1) x = in[i] * x;                                                         \
                if (o == 2) x = in[i] > x ? in[i] : x;                                             \
                if (o == 3) x = in[i] < x ? in[i] : x;                                             \
                assert_true(out[i] == (i < MOST - 1 ? x : kept[i]));                               \
            }                                                                                      \
        }                                                                                          \
        type in = 1, out = 2;                                                                      \
        for (int o = 0; o < OPS; o++)                                                              \
            if (ops[o].bits)                                                                       \
                assert_int_equal(MPI_Reduce_local(&in, &out, 1, handle, ops[o].op), MPI_ERR_OP);   \
        assert_int_equal(MPI_Reduce_local(&in, &out, 1, handle, MPI_MINLOC), MPI_ERR_OP);          \
    }
REAL(of_float, float, MPI_FLOAT)
REAL(of_double, double, MPI_DOUBLE)
REAL(of_long_double, long double, MPI_LONG_DOUBLE)
REAL(of_real, float, MPI_REAL)
REAL(of_double_precision, double, MPI_DOUBLE_PRECISION)
REAL(of_real4, float, MPI_REAL4)
REAL(of_real8, double, MPI_REAL8)
REAL(of_real16, __float128, MPI_REAL16)

static float small(struct random *r) { return (float)random_below(r, 21); }

#define COMPLEX(name, type, handle)                                                                \
    static void name(struct random *r)                                                             \
    {                                                                                              \
        for (int o = 0; o < OPS; o++) {                                                            \
            type in[3], out[3], kept[3];                                                           \
            for (int i = 0; i < 3; i++) {                                                          \
                in[i] = small(r) + small(r) * I;                                                   \
                kept[i] = out[i] = small(r) - small(r) * I;                                        \
            }                                                                                      \
            const int code = MPI_Reduce_local(in, out, 3, handle, ops[o].op);                      \
            assert_int_equal(code, o < 2 ? MPI_SUCCESS : MPI_ERR_OP);                              \
            for (int i = 0; i < 3; i++) {                                                          \
                const type x = o == 0 ? in[i] + kept[i] : in[i] * kept[i];                         \
                assert_true(out[i] == (o < 2 ? x : kept[i]));                                      \
            }                                                                                      \
        }                                                                                          \
    }
COMPLEX(of_complex, float _Complex, MPI_C_FLOAT_COMPLEX)
COMPLEX(of_double_complex, double _Complex, MPI_C_DOUBLE_COMPLEX)
COMPLEX(of_long_double_complex, long double _Complex, MPI_C_LONG_DOUBLE_COMPLEX)
COMPLEX(of_fortran_complex, float _Complex, MPI_COMPLEX)
COMPLEX(of_fortran_double, double _Complex, MPI_DOUBLE_COMPLEX)
COMPLEX(of_complex16, double _Complex, MPI_COMPLEX16)

/* The smaller index among equals; `v` from few values, so that there are equal ones. */
#define PAIR(name, value, index, handle)                                                           \
    static void name(struct random *r)                                                             \
    {                                                                                              \
        for (int largest = 0; largest < 2; largest++) {                                            \
            struct {                                                                               \
                value v;                                                                           \
                index i;                                                                           \
            } in[40], out[40], kept[40];                                                           \
            memset(in, 0, sizeof in), memset(kept, 0, sizeof kept);                                \
            for (int k = 0; k < 40; k++) {                                                         \
                in[k].v = (value)((int)random_below(r, 3) - 1);                                    \
                in[k].i = (index)(int)random_below(r, 3);                                          \
                kept[k].v = (value)((int)random_below(r, 3) - 1);                                  \
                kept[k].i = (index)(int)random_below(r, 3);                                        \
            }                                                                                      \
            memcpy(out, kept, sizeof out);                                                         \
            assert_int_equal(                                                                      \
                MPI_Reduce_local(in, out, 40, handle, largest ? MPI_MAXLOC : MPI_MINLOC),          \
                MPI_SUCCESS);                                                                      \
            for (int k = 0; k < 40; k++) {                                                         \
                const bool better = largest ? in[k].v > kept[k].v : in[k].v < kept[k].v,           \
                           same = in[k].v == kept[k].v;                                            \
                const value v = better ? in[k].v : kept[k].v;                                      \
                const index i = better                        ? in[k].i                            \
                                : same && in[k].i < kept[k].i ? in[k].i                            \
                                                              : kept[k].i;                         \
                assert_true(out[k].v == v && out[k].i == i);                                       \
            }                                                                                      \
            assert_int_equal(MPI_Reduce_local(in, out, 1, handle, MPI_SUM), MPI_ERR_OP);           \
            assert_int_equal(MPI_Reduce_local(in, out, 1, handle, MPI_MAX), MPI_ERR_OP);           \
        }                                                                                          \
    }
PAIR(of_float_int, float, int, MPI_FLOAT_INT)
PAIR(of_double_int, double, int, MPI_DOUBLE_INT)
PAIR(of_long_int, long, int, MPI_LONG_INT)
PAIR(of_2int, int, int, MPI_2INT)
PAIR(of_short_int, short, int, MPI_SHORT_INT)
PAIR(of_long_double_int, long double, int, MPI_LONG_DOUBLE_INT)
PAIR(of_2real, float, float, MPI_2REAL)
PAIR(of_2double, double, double, MPI_2DOUBLE_PRECISION)
PAIR(of_2integer, int, int, MPI_2INTEGER)

static void numbers(void *context)
{
    static void (*const all[])(struct random *) = {of_float,
                                                   of_double,
                                                   of_long_double,
                                                   of_real,
                                                   of_double_precision,
                                                   of_real4,
                                                   of_real8,
                                                   of_real16,
                                                   of_complex,
                                                   of_double_complex,
                                                   of_long_double_complex,
                                                   of_fortran_complex,
                                                   of_fortran_double,
                                                   of_complex16,
                                                   of_float_int,
                                                   of_double_int,
                                                   of_long_int,
                                                   of_2int,
                                                   of_short_int,
                                                   of_long_double_int,
                                                   of_2real,
                                                   of_2double,
                                                   of_2integer};
    struct random r = random_make(52, 0, 0);
    (void)context;
    return_errors();
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        for (int round = 0; round < 5; round++) all[k](&r);
}

/* A number that is none is neither larger nor smaller: what was there stays. */
static void no_numbers(void *context)
{
    double in[2] = {NAN, 1}, out[2] = {1, NAN};
    (void)context;
    MPI_Reduce_local(in, out, 2, MPI_DOUBLE, MPI_MAX);
    assert_true(out[0] == 1 && isnan(out[1]));
    MPI_Reduce_local(in, out, 2, MPI_DOUBLE, MPI_MIN);
    assert_true(out[0] == 1 && isnan(out[1]));
}

static void numbers_are_combined_as_c_does(void **state)
{
    (void)state;
    mpi_ok(1, numbers, NULL);
    mpi_ok(1, no_numbers, NULL);
}

/* --- refusals, and what operations say of themselves --- */

static void nothing(void *in, void *inout, int *n, MPI_Datatype *t)
{
    (void)in, (void)inout, (void)n, (void)t;
}

static void refusals(void *context)
{
    static const MPI_Op all[] = {MPI_SUM,    MPI_MIN,    MPI_MAX,     MPI_PROD, MPI_BAND,
                                 MPI_BOR,    MPI_BXOR,   MPI_LAND,    MPI_LOR,  MPI_LXOR,
                                 MPI_MINLOC, MPI_MAXLOC, MPI_REPLACE, MPI_NO_OP};
    char in[64] = {0}, out[64] = {0};
    MPI_Datatype t;
    MPI_Op op;
    int flag;
    (void)context;
    return_errors();
    MPI_Type_contiguous(1, MPI_INT, &t);
    MPI_Type_commit(&t);
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        assert_int_equal(MPI_Reduce_local(in, out, 1, MPI_PACKED, all[k]), MPI_ERR_OP);
        assert_int_equal(MPI_Reduce_local(in, out, 1, MPI_WCHAR, all[k]), MPI_ERR_OP);
        assert_int_equal(MPI_Reduce_local(in, out, 1, t, all[k]), MPI_ERR_OP);
        assert_int_equal(MPI_Allreduce(in, out, 1, t, all[k], MPI_COMM_WORLD), MPI_ERR_OP);
        assert_int_equal(MPI_Op_commutative(all[k], &flag), MPI_SUCCESS);
        assert_int_equal(flag, 1);
        op = all[k];
        assert_int_equal(MPI_Op_free(&op), MPI_ERR_OP);
    }
    /* operations of one-sided calls alone */
    assert_int_equal(MPI_Reduce_local(in, out, 1, MPI_INT, MPI_REPLACE), MPI_ERR_OP);
    assert_int_equal(MPI_Reduce_local(in, out, 1, MPI_INT, MPI_NO_OP), MPI_ERR_OP);
    assert_int_equal(MPI_Reduce_local(in, out, -1, MPI_INT, MPI_SUM), MPI_ERR_COUNT);
    assert_int_equal(MPI_Reduce_local(in, out, 1, MPI_DATATYPE_NULL, MPI_SUM), MPI_ERR_TYPE);
    assert_int_equal(MPI_Reduce_local(in, out, 1, MPI_INT, MPI_OP_NULL), MPI_ERR_OP);
    assert_int_equal(MPI_Op_create(NULL, 1, &op), MPI_ERR_ARG);
    for (int commute = 0; commute < 3; commute++) {
        MPI_Op kept;
        MPI_Op_create(nothing, commute, &op);
        MPI_Op_commutative(op, &flag);
        assert_int_equal(flag, commute != 0);
        kept = op;
        assert_int_equal(MPI_Op_free(&op), MPI_SUCCESS);
        assert_true(op == MPI_OP_NULL);
        assert_int_equal(MPI_Op_commutative(kept, &flag), MPI_ERR_OP);
    }
    MPI_Type_free(&t);
    /* a duplicate of a basic type is as good as the type */
    MPI_Type_dup(MPI_INT, &t);
    in[0] = 5, out[0] = 6;
    assert_int_equal(MPI_Reduce_local(in, out, 1, t, MPI_SUM), MPI_SUCCESS);
    assert_int_equal(out[0], 11);
    MPI_Type_free(&t);
    MPI_Type_dup(MPI_DOUBLE_INT, &t);
    struct {
        double v;
        int i;
    } a = {2, 3}, b = {2, 1}, c = {0, 0};
    assert_int_equal(MPI_Reduce_local(&a, &b, 1, t, MPI_MAXLOC), MPI_SUCCESS);
    assert_int_equal(b.i, 1);
    b.i = 7 + own_rank();
    assert_int_equal(MPI_Allreduce(&b, &c, 1, t, MPI_MINLOC, MPI_COMM_WORLD), MPI_SUCCESS);
    assert_true(c.v == 2 && c.i == 7);
    MPI_Type_free(&t);
}

static void operations_are_refused_where_they_are_none(void **state)
{
    (void)state;
    mpi_ok(3, refusals, NULL);
}

/* --- all of them over several ranks: the same by any algorithm --- */

static void everywhere(void *context)
{
    struct random r = random_make(53, 0, 0);
    const int rank = own_rank(), n = all_ranks();
    (void)context;
    for (size_t k = 0; k < sizeof wholes / sizeof *wholes; k += 3)
        for (int o = 0; o < OPS; o++) {
            const struct whole *w = &wholes[k];
            char all[8][8 * MOST], expected[8][8 * MOST], got[8 * MOST];
            for (int i = 0; i < n; i++)
                for (int e = 0; e < MOST; e++) put(all[i] + e * w->bytes, w->bytes, draw(&r));
            /* expected[i]: over ranks 0 .. i */
            memcpy(expected, all, sizeof expected);
            for (int i = 1; i < n; i++)
                for (int e = 0; e < MOST; e++) {
                    const int at = e * w->bytes;
                    put(expected[i] + at, w->bytes,
                        combined(ops[o].op, get(expected[i - 1] + at, w->bytes, w->sign),
                                 get(all[i] + at, w->bytes, w->sign)));
                }
            const size_t size = (size_t)(MOST * w->bytes);
            MPI_Allreduce(all[rank], got, MOST, w->type, ops[o].op, MPI_COMM_WORLD);
            /* of truths only the last result is 0 or 1 on one rank alone */
            if (n > 1) assert_memory_equal(got, expected[n - 1], size);
            MPI_Scan(all[rank], got, MOST, w->type, ops[o].op, MPI_COMM_WORLD);
            assert_memory_equal(got, expected[rank], size);
            memset(got, 0x33, sizeof got);
            MPI_Exscan(all[rank], got, MOST, w->type, ops[o].op, MPI_COMM_WORLD);
            if (rank > 0) assert_memory_equal(got, expected[rank - 1], size);
            else assert_int_equal(got[0], 0x33);
            const int root = (int)(k + (size_t)o) % n;
            MPI_Reduce(all[rank], got, MOST, w->type, ops[o].op, root, MPI_COMM_WORLD);
            if (rank == root && n > 1) assert_memory_equal(got, expected[n - 1], size);
        }
}

static void all_ranks_have_the_same_results(void **state)
{
    (void)state;
    for (int n = 1; n <= 8; n += n < 4 ? 1 : 2) mpi_ok(n, everywhere, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integers_are_combined_modulo_their_range),
        cmocka_unit_test(numbers_are_combined_as_c_does),
        cmocka_unit_test(operations_are_refused_where_they_are_none),
        cmocka_unit_test(all_ranks_have_the_same_results),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
