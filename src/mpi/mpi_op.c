/* mpi_op.c - operations of reductions: the standard's on every class of basic type, and the
 * program's own.
 *
 * An operation on n elements counts n floating-point operations, whatever the type: an integer's
 * takes about as long. Sums of integers wrap as unsigned ones do, so that no element is undefined.
 *
 * Section 6.9.2 of MPI 5.0 says which operation is defined on which types, section 6.9.4
 * what the pairs are, section 6.9.5 what a program's own function gets. One plain loop
 * for each pair of operation and class: no function is called for an element, and
 * compilers make vectors of it. */
#include <complex.h>

#include "mpi/mpi_internal.h"

/* ONE: a combine function named after operation and class, from an expression of a (into) and b
 * (with). */
#define ONE(op, class, type, expression, cost)                                                     \
    static void op##_##class(void *into, const void *with, bool before, int64_t n, void *context,  \
                             struct work *w)                                                       \
    {                                                                                              \
        type *x = into;                                                                            \
        const type *y = with;                                                                      \
        (void)before, (void)context;                                                               \
        for (int64_t i = 0; i < n; i++) {                                                          \
            const type a = x[i], b = y[i];                                                         \
            x[i] = (type)(expression);                                                             \
        }                                                                                          \
        w->flop += (uint64_t)n * (cost);                                                           \
    }

/* A comparison with a number that is none is false: then `a` stays, the same on every
 * machine. */
#define ORDERED(class, type)                                                                       \
    ONE(max, class, type, b > a ? b : a, 1)                                                        \
    ONE(min, class, type, b < a ? b : a, 1)

/* Results are 0 or 1 in the type of the operands. */
#define LOGICAL(class, type)                                                                       \
    ONE(land, class, type, a != 0 && b != 0, 1)                                                    \
    ONE(lor, class, type, a != 0 || b != 0, 1)                                                     \
    ONE(lxor, class, type, (a != 0) != (b != 0), 1)

/* Not for floating-point numbers, whose bits mean nothing here. */
#define BITS(class, type)                                                                          \
    ONE(band, class, type, a &b, 1)                                                                \
    ONE(bor, class, type, a | b, 1)                                                                \
    ONE(bxor, class, type, a ^ b, 1)

/* The sum is formed in 64 unsigned bits and cut to the type, which is the sum modulo its
 * range. */
#define INTEGER(class, type)                                                                       \
    ONE(sum, class, type, (uint64_t)a + (uint64_t)b, 1)                                            \
    ONE(prod, class, type, (uint64_t)a *(uint64_t)b, 1)                                            \
    ORDERED(class, type)                                                                           \
    BITS(class, type)                                                                              \
    LOGICAL(class, type)

/* Order of operands and of elements is fixed, so that results have the same bits
 * everywhere. */
#define REAL(class, type)                                                                          \
    ONE(sum, class, type, a + b, 1)                                                                \
    ONE(prod, class, type, a *b, 1)                                                                \
    ORDERED(class, type)                                                                           \
    LOGICAL(class, type)

/* A complex addition is two, a multiplication six. */
#define COMPLEX(class, type)                                                                       \
    ONE(sum, class, type, a + b, 2)                                                                \
    ONE(prod, class, type, a *b, 6)

/* The smaller index wins where values are equal. Section 6.9.4. Ties must be decided, or
 * the result would depend on the algorithm's order. */
#define PAIR(class, value_type, index_type)                                                        \
    struct pair_##class                                                                            \
    {                                                                                              \
        value_type v;                                                                              \
        index_type i;                                                                              \
    };                                                                                             \
    ONE(minloc, class, struct pair_##class, b.v < a.v || (b.v == a.v && b.i < a.i) ? b : a, 1)     \
    ONE(maxloc, class, struct pair_##class, b.v > a.v || (b.v == a.v && b.i < a.i) ? b : a, 1)

INTEGER(INT8, int8_t)
INTEGER(INT16, int16_t)
INTEGER(INT32, int32_t)
INTEGER(INT64, int64_t)
INTEGER(UINT8, uint8_t)
INTEGER(UINT16, uint16_t)
INTEGER(UINT32, uint32_t)
INTEGER(UINT64, uint64_t)
REAL(FLOAT, float)
REAL(DOUBLE, double)
REAL(LONG_DOUBLE, long double)
REAL(QUAD, __float128)
COMPLEX(COMPLEX_FLOAT, float _Complex)
COMPLEX(COMPLEX_DOUBLE, double _Complex)
COMPLEX(COMPLEX_LONG_DOUBLE, long double _Complex)
LOGICAL(BOOL, _Bool)
LOGICAL(LOGICAL8, int8_t)
LOGICAL(LOGICAL16, int16_t)
LOGICAL(LOGICAL32, int32_t)
LOGICAL(LOGICAL64, int64_t)
BITS(BYTE, uint8_t)
PAIR(FLOAT_INT, float, int)
PAIR(DOUBLE_INT, double, int)
PAIR(LONG_INT, long, int)
PAIR(INT_INT, int, int)
PAIR(SHORT_INT, short, int)
PAIR(LONG_DOUBLE_INT, long double, int)
PAIR(FLOAT_FLOAT, float, float)
PAIR(DOUBLE_DOUBLE, double, double)

/* Rows of the table below, class by class. */
#define NUMBERS(op)                                                                                \
    [CLASS_INT8] = op##_INT8, [CLASS_INT16] = op##_INT16, [CLASS_INT32] = op##_INT32,              \
    [CLASS_INT64] = op##_INT64, [CLASS_UINT8] = op##_UINT8, [CLASS_UINT16] = op##_UINT16,          \
    [CLASS_UINT32] = op##_UINT32, [CLASS_UINT64] = op##_UINT64
#define REALS(op)                                                                                  \
    [CLASS_FLOAT] = op##_FLOAT, [CLASS_DOUBLE] = op##_DOUBLE,                                      \
    [CLASS_LONG_DOUBLE] = op##_LONG_DOUBLE, [CLASS_QUAD] = op##_QUAD
#define COMPLEXES(op)                                                                              \
    [CLASS_COMPLEX_FLOAT] = op##_COMPLEX_FLOAT, [CLASS_COMPLEX_DOUBLE] = op##_COMPLEX_DOUBLE,      \
    [CLASS_COMPLEX_LONG_DOUBLE] = op##_COMPLEX_LONG_DOUBLE
#define TRUTHS(op)                                                                                 \
    [CLASS_BOOL] = op##_BOOL, [CLASS_LOGICAL8] = op##_LOGICAL8,                                    \
    [CLASS_LOGICAL16] = op##_LOGICAL16, [CLASS_LOGICAL32] = op##_LOGICAL32,                        \
    [CLASS_LOGICAL64] = op##_LOGICAL64
#define PAIRS(op)                                                                                  \
    [CLASS_FLOAT_INT] = op##_FLOAT_INT, [CLASS_DOUBLE_INT] = op##_DOUBLE_INT,                      \
    [CLASS_LONG_INT] = op##_LONG_INT, [CLASS_INT_INT] = op##_INT_INT,                              \
    [CLASS_SHORT_INT] = op##_SHORT_INT, [CLASS_LONG_DOUBLE_INT] = op##_LONG_DOUBLE_INT,            \
    [CLASS_FLOAT_FLOAT] = op##_FLOAT_FLOAT, [CLASS_DOUBLE_DOUBLE] = op##_DOUBLE_DOUBLE

/* Handles of operations are 0x20 to 0x3f in the ABI, so the handle is the index. */
enum { FIRST_OP = 0x20, OPS = 0x20 };

/* By handle and class; NULL: not defined. */
static mpi_combine *const combine[OPS][CLASSES] = {
    [0x21 - FIRST_OP] = {NUMBERS(sum), REALS(sum), COMPLEXES(sum)},
    [0x22 - FIRST_OP] = {NUMBERS(min), REALS(min)},
    [0x23 - FIRST_OP] = {NUMBERS(max), REALS(max)},
    [0x24 - FIRST_OP] = {NUMBERS(prod), REALS(prod), COMPLEXES(prod)},
    [0x28 - FIRST_OP] = {NUMBERS(band), [CLASS_BYTE] = band_BYTE},
    [0x29 - FIRST_OP] = {NUMBERS(bor), [CLASS_BYTE] = bor_BYTE},
    [0x2a - FIRST_OP] = {NUMBERS(bxor), [CLASS_BYTE] = bxor_BYTE},
    [0x30 - FIRST_OP] = {NUMBERS(land), REALS(land), TRUTHS(land)},
    [0x31 - FIRST_OP] = {NUMBERS(lor), REALS(lor), TRUTHS(lor)},
    [0x32 - FIRST_OP] = {NUMBERS(lxor), REALS(lxor), TRUTHS(lxor)},
    [0x38 - FIRST_OP] = {PAIRS(minloc)},
    [0x39 - FIRST_OP] = {PAIRS(maxloc)},
};

/* Idempotent operations may see an element twice, which some algorithms of
 * comm/collectives.h use. All of the standard's commute, although sums of floating-point
 * numbers do not associate: the order of those is the algorithm's, and always the same. */
#define OP(handle, text, idempotent_)                                                              \
    [handle - FIRST_OP] = {                                                                        \
        .o = {KIND_OP, -1, 1}, .commutative = true, .idempotent = idempotent_, .name = text}

static const struct mpi_op standard[OPS] = {
    OP(0x21, "MPI_SUM", false),    OP(0x22, "MPI_MIN", true),    OP(0x23, "MPI_MAX", true),
    OP(0x24, "MPI_PROD", false),   OP(0x28, "MPI_BAND", true),   OP(0x29, "MPI_BOR", true),
    OP(0x2a, "MPI_BXOR", false),   OP(0x30, "MPI_LAND", true),   OP(0x31, "MPI_LOR", true),
    OP(0x32, "MPI_LXOR", false),   OP(0x38, "MPI_MINLOC", true), OP(0x39, "MPI_MAXLOC", true),
    OP(0x3c, "MPI_REPLACE", true), OP(0x3d, "MPI_NO_OP", true),
};

struct mpi_op *mpi_op_of(struct mpi_rank *r, MPI_Op handle)
{
    intptr_t i = (intptr_t)handle - FIRST_OP;
    if (i > 0 && i < OPS && standard[i].name) return (struct mpi_op *)&standard[i];
    struct mpi_op *op = mpi_object(r, handle, KIND_OP);
    return op ? op : mpi_bad_handle(r, handle, KIND_OP);
}

/* The program's own operations lie elsewhere in memory. */
static bool is_standard(const struct mpi_op *op) { return op >= standard && op < standard + OPS; }

/* --- the program's functions --- */

/* call: inout = in op inout, as the standard has it; `into` comes from higher ranks when
 * `before`. */
static void call(struct mpi_reduction *x, const void *in, void *inout, int64_t n)
{
    /* The function gets pointers to length and type (section 6.9.5). Functions made by
     * MPI_Op_create_c count in MPI_Count, all others in int. */
    MPI_Datatype type = mpi_type_handle(x->type);
    int64_t most = x->op->large ? n : INT32_MAX;
    /* More elements than an int counts are handed over in several calls. */
    for (int64_t i = 0; i < n; i += most) {
        MPI_Count large = n - i < most ? n - i : most;
        int small = (int)large;
        intptr_t length = x->op->large ? (intptr_t)&large : (intptr_t)&small;
        int64_t at = i * x->type->extent;
        const intptr_t argument[6] = {(intptr_t)in + at, (intptr_t)inout + at, length,
                                      (intptr_t)&type};
        mpi_call_program(x->self, (void *)(intptr_t)x->op->function, argument);
    }
}

/* call_apart: the same for elements that lie `element` bytes apart. Where that is not the
 * type's extent, which is all that the function knows, each element needs a call. */
static void call_apart(struct mpi_reduction *x, const char *in, char *inout, int64_t n)
{
    if (x->element == x->type->extent) {
        call(x, in, inout, n);
        return;
    }
    for (int64_t i = 0; i < n; i++) call(x, in + i * x->element, inout + i * x->element, 1);
}

/* combine_user: elements are extents of the type; functions expect them where the type's lower
 * bound is. */
static void combine_user(void *into, const void *with, bool before, int64_t n, void *context,
                         struct work *w)
{
    struct mpi_reduction *x = context;
    (void)w;
    /* inout is the right operand. When `into` comes from higher ranks it is that already;
     * where order does not matter, no copy is needed either. */
    if (before || x->op->commutative) {
        call_apart(x, (const char *)with - x->offset, (char *)into - x->offset, n);
        return;
    }
    /* into op with: the function writes over its second argument, so that one is a copy */
    int64_t bytes = n * x->element;
    char *copy = mpi_take(x->self->world, bytes);
    memcpy(copy, with, (size_t)bytes);
    call_apart(x, (const char *)into - x->offset, copy - x->offset, n);
    memcpy(into, copy, (size_t)bytes);
    mpi_give(x->self->world, copy);
}

/* What an operation asks of hardware that combines: nothing that is known has units for products,
 * pairs or complex numbers. */
static enum comm_operation hardware_operation(const struct mpi_op *op, const struct mpi_type *t)
{
    const intptr_t handle = FIRST_OP + (op - standard);
    /* Sums and extremes stand side by side, and so do bits and truths. */
    if (handle >= (intptr_t)MPI_BAND && handle <= (intptr_t)MPI_LXOR) return COMM_LOGICAL;
    if (handle < (intptr_t)MPI_SUM || handle > (intptr_t)MPI_MAX) return COMM_OWN;
    if (t->class >= CLASS_INT8 && t->class <= CLASS_UINT64) return COMM_INTEGER;
    return t->class == CLASS_FLOAT || t->class == CLASS_DOUBLE ? COMM_REAL : COMM_OWN;
}

/* mpi_reduction_make: the operation on elements of the type, as collectives.h wants it. */
int mpi_reduction_make(struct mpi_rank *r, struct mpi_reduction *x, struct mpi_op *op,
                       struct mpi_type *t, struct mpi_comm *c)
{
    /* Elements must not overlap where an algorithm moves them: of types whose bytes reach
     * beyond their extent they lie further apart than in the program's memory. */
    *x = (struct mpi_reduction){.self = r, .op = op, .type = t, .offset = t->true_lb};
    x->copied = !t->dense && !mpi_type_is_basic(t);
    x->element = t->true_extent > t->extent ? t->true_extent : t->extent;
    x->work = (struct collective_op){.commutative = op->commutative, .idempotent = op->idempotent};
    x->work.context = x;
    x->work.combine = combine_user;
    if (!is_standard(op)) return MPI_SUCCESS;
    /* A built-in operation works on basic types alone (section 6.9.2); a type made by the
     * program has no class. */
    x->work.operation = hardware_operation(op, t);
    x->work.combine = t->class == CLASS_NONE ? NULL : combine[op - standard][t->class];
    if (x->work.combine) return MPI_SUCCESS;
    return mpi_error(r, c, MPI_ERR_OP, "%s is not defined on %s", op->name,
                     t->name ? t->name : "a type of the program");
}

/* Each element from its first byte to its last; `memory` NULL: zeros. */
void *mpi_reduction_copy(struct mpi_rank *r, const struct mpi_reduction *x, const void *memory,
                         int64_t n)
{
    char *copy = mpi_take_zero(r->world, n * x->element + 1);
    for (int64_t i = 0; memory && i < n; i++)
        memcpy(copy + i * x->element, (const char *)memory + i * x->type->extent + x->offset,
               (size_t)x->type->true_extent);
    if (memory) mpi_charge_copy(r, n * x->type->size);
    return copy;
}

/* Bytes in the gaps of the type stay the program's: other elements may lie there. */
void mpi_reduction_back(struct mpi_rank *r, const struct mpi_reduction *x, void *memory,
                        const void *copy, int64_t n)
{
    char *packed = mpi_take(r->world, x->type->size + 1);
    for (int64_t i = 0; i < n; i++) {
        mpi_pack_bytes(packed, (const char *)copy + i * x->element - x->offset, 1, x->type);
        mpi_unpack_bytes((char *)memory + i * x->type->extent, packed, x->type->size, 1, x->type);
    }
    mpi_charge_copy(r, n * x->type->size);
    mpi_give(r->world, packed);
}

int mpi_reduce_local(struct mpi_rank *self, const void *inbuf, void *inoutbuf, MPI_Count count,
                     MPI_Datatype datatype, MPI_Op op)
{
    struct mpi_type *t = mpi_type_of(self, datatype);
    struct mpi_op *o = t ? mpi_op_of(self, op) : NULL;
    struct mpi_reduction x;
    struct work w = {0};
    if (!o) return self->code;
    if (count < 0)
        return mpi_error(self, NULL, MPI_ERR_COUNT, "count %lld is negative", (long long)count);
    int code = mpi_reduction_make(self, &x, o, t, NULL);
    if (code != MPI_SUCCESS || count == 0) return code;
    /* Elements of the program's lie as its functions expect them. */
    if (!is_standard(o)) {
        call(&x, inbuf, inoutbuf, count);
        return MPI_SUCCESS;
    }
    /* Section 6.9.7: inout = in op inout, on this rank, for the time that its operations
     * take. */
    x.work.combine((char *)inoutbuf + x.offset, (const char *)inbuf + x.offset, true, count,
                   x.work.context, &w);
    comm_work(self->comm, &w);
    return MPI_SUCCESS;
}

/* --- handles --- */

/* Handles of operations in both widths share a kind, and free alike. */
static int create(struct mpi_rank *r, MPI_User_function *function, bool large, int commute,
                  MPI_Op *op)
{
    if (!function) return mpi_error(r, NULL, MPI_ERR_ARG, "the function is NULL");
    struct mpi_op *o = mpi_take_zero(r->world, sizeof *o);
    *op = mpi_handle_make(r, o, KIND_OP);
    o->commutative = commute != 0;
    o->function = function;
    o->large = large;
    return MPI_SUCCESS;
}

int mpi_op_create(struct mpi_rank *self, MPI_User_function *user_fn, int commute, MPI_Op *op)
{
    return create(self, user_fn, false, commute, op);
}

int mpi_op_create_c(struct mpi_rank *self, MPI_User_function_c *user_fn, int commute, MPI_Op *op)
{
    return create(self, (MPI_User_function *)(intptr_t)user_fn, true, commute, op);
}

void mpi_op_drop(struct mpi_rank *r, struct mpi_op *o)
{
    if (!o || is_standard(o) || --o->o.uses > 0) return;
    mpi_handle_end(r, o);
    mpi_give(r->world, o);
}

void mpi_op_use(struct mpi_op *o)
{
    if (!is_standard(o)) o->o.uses++;
}

/* Reductions in progress keep the function (section 6.9.5); the handle ends now. */
int mpi_op_free(struct mpi_rank *self, MPI_Op *op)
{
    struct mpi_op *o = mpi_op_of(self, *op);
    if (!o) return self->code;
    if (is_standard(o)) return mpi_error(self, NULL, MPI_ERR_OP, "%s cannot be freed", o->name);
    if (o->o.uses > 1) mpi_handle_end(self, o);
    mpi_op_drop(self, o);
    *op = MPI_OP_NULL;
    return MPI_SUCCESS;
}

int mpi_op_commutative(struct mpi_rank *self, MPI_Op op, int *commute)
{
    struct mpi_op *o = mpi_op_of(self, op);
    if (!o) return self->code;
    *commute = o->commutative;
    return MPI_SUCCESS;
}
