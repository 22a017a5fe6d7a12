/* mpi_type_basic.c - the basic datatypes: what the standard's handles of types stand for on this
 * host.
 *
 * The types of sections 3.2.2 and 6.9.4 of MPI 5.0, with the handles of the ABI chapter:
 * ten bits that begin with 10 are types. Types of Fortran are those of gfortran's default
 * kinds. */
#include <complex.h>
#include <stdalign.h>
#include <wchar.h>

#include "mpi/mpi_internal.h"

/* Pairs for MPI_MINLOC and MPI_MAXLOC, laid out as C lays them out. */
struct float_int {
    float v;
    int i;
};
struct double_int {
    double v;
    int i;
};
struct long_int {
    long v;
    int i;
};
struct int_int {
    int v;
    int i;
};
struct short_int {
    short v;
    int i;
};
struct long_double_int {
    long double v;
    int i;
};

/* The handle is the index: looking a type up takes no search and no table of pointers. */
enum { FIRST_TYPE = 0x200, TYPES = 0x100 };

/* One run of bytes, dense and committed; constants without a number, so nobody counts or
 * frees them. Alignment is the compiler's for the C type: structs are padded by it
 * (mpi_type_finish). */
#define BASIC(handle, type, class_, text)                                                          \
    [(int)(handle)-FIRST_TYPE] = {.o = {KIND_TYPE, -1, 1},                                         \
                                  .combiner = MPI_COMBINER_NAMED,                                  \
                                  .class = class_,                                                 \
                                  .dense = true,                                                   \
                                  .committed = true,                                               \
                                  .size = sizeof(type),                                            \
                                  .extent = sizeof(type),                                          \
                                  .true_extent = sizeof(type),                                     \
                                  .basics = 1,                                                     \
                                  .align = alignof(type),                                          \
                                  .name = text}

/* Pairs are two pieces where the compiler leaves a gap behind them. The extent has the
 * gap, the size has not (section 6.9.4), so messages of pairs carry no padding. */
#define PAIR(handle, type, class_, text, first, gap)                                               \
    [(int)(handle)-FIRST_TYPE] = {.o = {KIND_TYPE, -1, 1},                                         \
                                  .combiner = MPI_COMBINER_NAMED,                                  \
                                  .class = class_,                                                 \
                                  .dense = !(gap),                                                 \
                                  .committed = true,                                               \
                                  .size = sizeof(first) + sizeof(int),                             \
                                  .extent = sizeof(type),                                          \
                                  .true_extent = offsetof(type, i) + sizeof(int),                  \
                                  .basics = 2,                                                     \
                                  .align = alignof(type),                                          \
                                  .npiece = 2,                                                     \
                                  .piece = (struct mpi_piece *)pieces_of_##class_,                 \
                                  .name = text}

/* `basic` is declared ahead, as the pieces point into the table that they are part of. */
#define PAIR_PIECES(class_, type, first)                                                           \
    static const struct mpi_piece pieces_of_##class_[2] = {                                        \
        {.at = 0, .count = 1, .length = 1, .of = (struct mpi_type *)&basic[(first)-FIRST_TYPE]},   \
        {.at = offsetof(type, i),                                                                  \
         .count = 1,                                                                               \
         .length = 1,                                                                              \
         .of = (struct mpi_type *)&basic[0x209 - FIRST_TYPE]}}

static const struct mpi_type basic[TYPES];
/* The number is the handle of the value's type; the index is an int (0x209). */
PAIR_PIECES(CLASS_FLOAT_INT, struct float_int, 0x210);
PAIR_PIECES(CLASS_DOUBLE_INT, struct double_int, 0x214);
PAIR_PIECES(CLASS_LONG_INT, struct long_int, 0x20a);
PAIR_PIECES(CLASS_INT_INT, struct int_int, 0x209);
PAIR_PIECES(CLASS_SHORT_INT, struct short_int, 0x208);
PAIR_PIECES(CLASS_LONG_DOUBLE_INT, struct long_double_int, 0x220);

/* Types that have no name in C, for their size and alignment. */
typedef struct {
    char bytes[2];
} half;
typedef struct {
    double re, im;
} double_pair;
typedef struct {
    float re, im;
} float_pair;
typedef struct {
    int32_t v, i;
} integer_pair;
typedef struct {
    __float128 re, im;
} quad_pair;

/* CLASS_NONE: bytes can be moved, but no operation is defined, or the simulator has none
 * for it. */
static const struct mpi_type basic[TYPES] = {
    BASIC(0x201, MPI_Aint, CLASS_INT64, "MPI_AINT"),
    BASIC(0x202, MPI_Count, CLASS_INT64, "MPI_COUNT"),
    BASIC(0x203, MPI_Offset, CLASS_INT64, "MPI_OFFSET"),
    /* MPI_PACKED counts bytes; what is in them only MPI_Unpack knows. */
    BASIC(0x207, char, CLASS_NONE, "MPI_PACKED"),
    BASIC(0x208, short, CLASS_INT16, "MPI_SHORT"),
    BASIC(0x209, int, CLASS_INT32, "MPI_INT"),
    BASIC(0x20a, long, CLASS_INT64, "MPI_LONG"),
    BASIC(0x20b, long long, CLASS_INT64, "MPI_LONG_LONG_INT"),
    BASIC(0x20c, unsigned short, CLASS_UINT16, "MPI_UNSIGNED_SHORT"),
    BASIC(0x20d, unsigned, CLASS_UINT32, "MPI_UNSIGNED"),
    BASIC(0x20e, unsigned long, CLASS_UINT64, "MPI_UNSIGNED_LONG"),
    BASIC(0x20f, unsigned long long, CLASS_UINT64, "MPI_UNSIGNED_LONG_LONG"),
    BASIC(0x210, float, CLASS_FLOAT, "MPI_FLOAT"),
    /* Types of C++ are those of C: both compilers lay complex numbers out alike. */
    BASIC(0x212, float _Complex, CLASS_COMPLEX_FLOAT, "MPI_C_FLOAT_COMPLEX"),
    BASIC(0x213, float _Complex, CLASS_COMPLEX_FLOAT, "MPI_CXX_FLOAT_COMPLEX"),
    BASIC(0x214, double, CLASS_DOUBLE, "MPI_DOUBLE"),
    BASIC(0x216, double _Complex, CLASS_COMPLEX_DOUBLE, "MPI_C_DOUBLE_COMPLEX"),
    BASIC(0x217, double _Complex, CLASS_COMPLEX_DOUBLE, "MPI_CXX_DOUBLE_COMPLEX"),
    /* Fortran's default kinds: a LOGICAL is as wide as an INTEGER, and any value but 0 is
     * taken as true. */
    BASIC(0x218, int32_t, CLASS_LOGICAL32, "MPI_LOGICAL"),
    BASIC(0x219, int32_t, CLASS_INT32, "MPI_INTEGER"),
    BASIC(0x21a, float, CLASS_FLOAT, "MPI_REAL"),
    BASIC(0x21b, float_pair, CLASS_COMPLEX_FLOAT, "MPI_COMPLEX"),
    BASIC(0x21c, double, CLASS_DOUBLE, "MPI_DOUBLE_PRECISION"),
    BASIC(0x21d, double_pair, CLASS_COMPLEX_DOUBLE, "MPI_DOUBLE_COMPLEX"),
    BASIC(0x21e, char, CLASS_INT8, "MPI_CHARACTER"),
    BASIC(0x220, long double, CLASS_LONG_DOUBLE, "MPI_LONG_DOUBLE"),
    BASIC(0x224, long double _Complex, CLASS_COMPLEX_LONG_DOUBLE, "MPI_C_LONG_DOUBLE_COMPLEX"),
    BASIC(0x225, long double _Complex, CLASS_COMPLEX_LONG_DOUBLE, "MPI_CXX_LONG_DOUBLE_COMPLEX"),
    /* The gap is there where the value is wider than an int or narrower. */
    PAIR(0x228, struct float_int, CLASS_FLOAT_INT, "MPI_FLOAT_INT", float, 0),
    PAIR(0x229, struct double_int, CLASS_DOUBLE_INT, "MPI_DOUBLE_INT", double, 1),
    PAIR(0x22a, struct long_int, CLASS_LONG_INT, "MPI_LONG_INT", long, 1),
    PAIR(0x22b, struct int_int, CLASS_INT_INT, "MPI_2INT", int, 0),
    PAIR(0x22c, struct short_int, CLASS_SHORT_INT, "MPI_SHORT_INT", short, 1),
    PAIR(0x22d, struct long_double_int, CLASS_LONG_DOUBLE_INT, "MPI_LONG_DOUBLE_INT", long double,
         1),
    BASIC(0x230, float_pair, CLASS_FLOAT_FLOAT, "MPI_2REAL"),
    BASIC(0x231, double_pair, CLASS_DOUBLE_DOUBLE, "MPI_2DOUBLE_PRECISION"),
    BASIC(0x232, integer_pair, CLASS_INT_INT, "MPI_2INTEGER"),
    BASIC(0x238, _Bool, CLASS_BOOL, "MPI_C_BOOL"),
    BASIC(0x239, _Bool, CLASS_BOOL, "MPI_CXX_BOOL"),
    BASIC(0x23c, wchar_t, CLASS_NONE, "MPI_WCHAR"),
    BASIC(0x240, int8_t, CLASS_INT8, "MPI_INT8_T"),
    BASIC(0x241, uint8_t, CLASS_UINT8, "MPI_UINT8_T"),
    BASIC(0x243, char, CLASS_INT8, "MPI_CHAR"),
    BASIC(0x244, signed char, CLASS_INT8, "MPI_SIGNED_CHAR"),
    BASIC(0x245, unsigned char, CLASS_UINT8, "MPI_UNSIGNED_CHAR"),
    /* Bytes have bit operations and no others (section 6.9.2). */
    BASIC(0x247, char, CLASS_BYTE, "MPI_BYTE"),
    BASIC(0x248, int16_t, CLASS_INT16, "MPI_INT16_T"),
    BASIC(0x249, uint16_t, CLASS_UINT16, "MPI_UINT16_T"),
    BASIC(0x250, int32_t, CLASS_INT32, "MPI_INT32_T"),
    BASIC(0x251, uint32_t, CLASS_UINT32, "MPI_UINT32_T"),
    BASIC(0x258, int64_t, CLASS_INT64, "MPI_INT64_T"),
    BASIC(0x259, uint64_t, CLASS_UINT64, "MPI_UINT64_T"),
    /* Types of Fortran with their sizes in bytes in the name. */
    BASIC(0x2c0, int8_t, CLASS_LOGICAL8, "MPI_LOGICAL1"),
    BASIC(0x2c1, int8_t, CLASS_INT8, "MPI_INTEGER1"),
    BASIC(0x2c8, int16_t, CLASS_LOGICAL16, "MPI_LOGICAL2"),
    BASIC(0x2c9, int16_t, CLASS_INT16, "MPI_INTEGER2"),
    BASIC(0x2ca, half, CLASS_NONE, "MPI_REAL2"),
    BASIC(0x2d0, int32_t, CLASS_LOGICAL32, "MPI_LOGICAL4"),
    BASIC(0x2d1, int32_t, CLASS_INT32, "MPI_INTEGER4"),
    BASIC(0x2d2, float, CLASS_FLOAT, "MPI_REAL4"),
    BASIC(0x2d3, float, CLASS_NONE, "MPI_COMPLEX4"),
    BASIC(0x2d8, int64_t, CLASS_LOGICAL64, "MPI_LOGICAL8"),
    BASIC(0x2d9, int64_t, CLASS_INT64, "MPI_INTEGER8"),
    BASIC(0x2da, double, CLASS_DOUBLE, "MPI_REAL8"),
    BASIC(0x2db, float_pair, CLASS_COMPLEX_FLOAT, "MPI_COMPLEX8"),
    BASIC(0x2e0, double_pair, CLASS_NONE, "MPI_LOGICAL16"),
    BASIC(0x2e1, double_pair, CLASS_NONE, "MPI_INTEGER16"),
    BASIC(0x2e2, __float128, CLASS_QUAD, "MPI_REAL16"),
    BASIC(0x2e3, double_pair, CLASS_COMPLEX_DOUBLE, "MPI_COMPLEX16"),
    BASIC(0x2eb, quad_pair, CLASS_NONE, "MPI_COMPLEX32"),
};

/* Gaps in the table have no name and are no types. */
struct mpi_type *mpi_type_basic(const void *handle)
{
    intptr_t i = (intptr_t)handle - FIRST_TYPE;
    return i > 0 && i < TYPES && basic[i].name ? (struct mpi_type *)&basic[i] : NULL;
}

/* The basic ones are one array, so that the place says the handle. */
MPI_Datatype mpi_type_handle(const struct mpi_type *t)
{
    if (t >= basic && t < basic + TYPES) return (MPI_Datatype)(intptr_t)(FIRST_TYPE + (t - basic));
    return mpi_handle(t);
}

bool mpi_type_is_basic(const struct mpi_type *t) { return t >= basic && t < basic + TYPES; }

struct mpi_type *mpi_type_of(struct mpi_rank *r, MPI_Datatype handle)
{
    struct mpi_type *t = mpi_type_basic(handle);
    if (!t) t = mpi_object(r, handle, KIND_TYPE);
    return t ? t : mpi_bad_handle(r, handle, KIND_TYPE);
}

void mpi_type_use(struct mpi_type *t)
{
    if (!mpi_type_is_basic(t)) t->o.uses++;
}
