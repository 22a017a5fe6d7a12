/* mpi_type.c - datatypes made by the program: pieces of memory of other types, with their bounds.
 *
 * A type is a list of pieces; a piece is count blocks, `stride` bytes apart, each of `length`
 * elements one behind the other. So a vector is one piece whatever its count, and an array's part
 * is as many types as it has dimensions.
 *
 * Section 5.1 of MPI 5.0. The list of pieces replaces the type map of the standard, which
 * would have an entry for each basic element: a column of a matrix of a million rows is
 * one piece here. All lengths and places are bytes in 64 bits. */
#include "mpi/mpi_internal.h"

/* Pieces come zeroed; who fills them in calls mpi_type_finish. */
struct mpi_type *mpi_type_make(struct mpi_rank *r, int combiner, int npiece)
{
    struct mpi_type *t = mpi_take_zero(r->world, sizeof *t);
    mpi_handle_make(r, t, KIND_TYPE);
    t->combiner = combiner;
    t->npiece = npiece;
    t->piece = mpi_take_zero(r->world, npiece * (int64_t)sizeof *t->piece);
    return t;
}

/* Types that others are made of live on after their handles. The type that refers to
 * another holds a use of it, so that a tree of types ends from the top. */
void mpi_type_drop(struct mpi_rank *r, struct mpi_type *t)
{
    if (!t || mpi_type_is_basic(t) || --t->o.uses > 0) return;
    for (int i = 0; i < t->ntype; i++) mpi_type_drop(r, t->type[i]);
    mpi_attributes_end(r, KIND_TYPE, t);
    mpi_handle_end(r, t);
    mpi_give(r->world, t->piece);
    mpi_give(r->world, t->integer);
    mpi_give(r->world, t->address);
    mpi_give(r->world, t->type);
    mpi_give(r->world, t->given_name);
    mpi_give(r->world, t);
}

/* mpi_type_bytes: a times b, at most MPI_TYPE_REACH either way: what a program asks for may be
 * larger than any number, and wrapped it would be a small type. */
int64_t mpi_type_bytes(int64_t a, int64_t b)
{
    int64_t c;
    const bool wraps = __builtin_mul_overflow(a, b, &c);
    if (wraps || c > MPI_TYPE_REACH || c < -MPI_TYPE_REACH)
        return (a < 0) == (b < 0) ? MPI_TYPE_REACH : -MPI_TYPE_REACH;
    return c;
}

/* No type reaches further than any memory; sums of a few such numbers still fit. */
static void check_reach(struct mpi_rank *r, int64_t bytes)
{
    if (bytes >= MPI_TYPE_REACH || bytes <= -MPI_TYPE_REACH)
        mpi_fail(r, "a datatype reaches over more than 2^56 bytes");
}

/* What bounds are made of; empty until something was put in. */
struct bounds {
    int64_t low, high, true_low, true_high;
    bool any, data, marked; /* any, data: something was put in, something with data */
};

/* Bounds that the program has set go before those of data (section 5.1.7): beside a type that has
 * some, low and high of the others do not count. True bounds are those of data (5.1.8). An extent
 * may be negative, so a low bound may lie above a high one. */
static void include(struct bounds *b, int64_t at, const struct mpi_type *of)
{
    int64_t low = at + of->lb, high = low + of->extent;
    int64_t true_low = at + of->true_lb, true_high = true_low + of->true_extent;
    const bool first = !b->any || (of->marked && !b->marked), counts = of->marked == b->marked;
    if (first || (counts && low < b->low)) b->low = low;
    if (first || (counts && high > b->high)) b->high = high;
    b->any = true;
    b->marked = b->marked || of->marked;
    if (of->basics == 0) return;
    if (!b->data || true_low < b->true_low) b->true_low = true_low;
    if (!b->data || true_high > b->true_high) b->true_high = true_high;
    b->data = true;
}

/* The four corners of a piece bound it, whatever the signs of strides and extents. Every
 * block in between lies within these four, because places are linear in both indices. */
static void include_piece(struct bounds *b, const struct mpi_piece *p)
{
    if (p->count == 0 || p->length == 0 || (p->of->basics == 0 && !p->of->marked)) return;
    int64_t last = mpi_type_bytes(p->count - 1, p->stride),
            end = mpi_type_bytes(p->length - 1, p->of->extent);
    include(b, p->at, p->of);
    include(b, p->at + last, p->of);
    include(b, p->at + end, p->of);
    include(b, p->at + last + end, p->of);
}

/* Whether piece i is one run of bytes from `at` on; the run's end in *end. A block of one
 * type that is dense is itself a run; several are one if the stride is their length. */
static bool is_run(const struct mpi_piece *p, int64_t *end)
{
    if (!p->of->dense) return false;
    int64_t block = mpi_type_bytes(p->length, p->of->size);
    if (p->count > 1 && p->stride != block) return false;
    *end = p->at + mpi_type_bytes(p->count, block);
    return true;
}

/* mpi_type_finish: sums and bounds out of the pieces. A struct's end is aligned as its strictest
 * element. */
void mpi_type_finish(struct mpi_rank *r, struct mpi_type *t)
{
    /* Dense means that the bytes lie in the order of packing, from 0 on and without a
     * gap, so that neither packing nor unpacking is needed. */
    struct bounds b = {0};
    int64_t end = 0, next;
    bool run = true;
    t->size = t->basics = 0;
    t->align = 1;
    /* Empty pieces count neither for bounds nor for runs (section 5.1.7 speaks of entries
     * of the type map, and they have none), but for bounds that were set. */
    for (int i = 0; i < t->npiece; i++) {
        const struct mpi_piece *p = &t->piece[i];
        int64_t n = mpi_type_bytes(p->count, p->length);
        check_reach(r, p->at);
        t->size += mpi_type_bytes(n, p->of->size);
        t->basics += mpi_type_bytes(n, p->of->basics);
        check_reach(r, t->size);
        check_reach(r, t->basics);
        /* Section 5.1.6: the extent is rounded up as a C compiler would pad a struct.
         * Only structs do so, so that arrays of elements keep their places. */
        if (n && p->of->basics && p->of->align > t->align) t->align = p->of->align;
        include_piece(&b, p);
        if (n == 0) continue;
        run = run && p->at == end && is_run(p, &next);
        if (run) end = next;
    }
    check_reach(r, b.low);
    check_reach(r, b.high);
    check_reach(r, b.true_low);
    check_reach(r, b.true_high);
    /* A type without data has all bounds 0. */
    t->lb = b.low;
    t->extent = b.high - b.low;
    t->marked = b.marked;
    t->true_lb = b.true_low;
    t->true_extent = b.true_high - b.true_low;
    if (t->combiner == MPI_COMBINER_STRUCT && !t->marked && t->extent % t->align)
        t->extent += t->align - t->extent % t->align;
    t->dense = run && t->lb == 0 && t->extent == t->size;
}

/* --- what a type was made of --- */

void mpi_type_remember(struct mpi_rank *r, struct mpi_type *t, int ninteger, int naddress,
                       int ntype)
{
    t->ninteger = ninteger;
    t->naddress = naddress;
    t->ntype = ntype;
    t->integer = mpi_take_zero(r->world, ninteger * (int64_t)sizeof *t->integer);
    t->address = mpi_take_zero(r->world, naddress * (int64_t)sizeof *t->address);
    t->type = mpi_take_zero(r->world, ntype * (int64_t)sizeof *t->type);
}

/* --- constructors --- */

/* Arrays of counts are of int or of MPI_Count, as the call has a _c in its name or not;
 * one function serves both. */
int64_t mpi_count_at(struct mpi_counts c, int64_t i)
{
    return c.large ? ((const MPI_Count *)c.at)[i] : ((const int *)c.at)[i];
}

/* A negative count has a class of its own in the standard, any other length has not. */
static bool negative(struct mpi_rank *r, const char *what, int64_t n)
{
    if (n >= 0) return false;
    r->code = mpi_error(r, NULL, strcmp(what, "count") == 0 ? MPI_ERR_COUNT : MPI_ERR_ARG,
                        "%s %lld is negative", what, (long long)n);
    return true;
}

static int finish(struct mpi_rank *r, struct mpi_type *t, MPI_Datatype *newtype)
{
    mpi_type_finish(r, t);
    *newtype = mpi_handle(t);
    return MPI_SUCCESS;
}

/* One piece of one type, and the integers that describe it. What MPI_Type_get_contents
 * will return (section 5.1.13) is kept beside the piece: it cannot be recovered from
 * that. */
static struct mpi_type *one_piece(struct mpi_rank *r, int combiner, struct mpi_piece piece,
                                  int ninteger, int naddress)
{
    struct mpi_type *t = mpi_type_make(r, combiner, 1);
    t->piece[0] = piece;
    mpi_type_remember(r, t, ninteger, naddress, 1);
    t->type[0] = piece.of;
    mpi_type_use(piece.of);
    return t;
}

/* One block of `count` elements, each an extent behind the last. */
int mpi_type_contiguous(struct mpi_rank *self, MPI_Count count, MPI_Datatype oldtype,
                        MPI_Datatype *newtype)
{
    struct mpi_type *of = mpi_type_of(self, oldtype);
    if (!of || negative(self, "count", count)) return self->code;
    struct mpi_piece piece = {.count = 1, .length = count, .of = of};
    struct mpi_type *t = one_piece(self, MPI_COMBINER_CONTIGUOUS, piece, 1, 0);
    t->integer[0] = count;
    return finish(self, t, newtype);
}

/* A vector's stride counts extents of the old type, an hvector's counts bytes. */
static int vector(struct mpi_rank *r, int combiner, int64_t count, int64_t length, int64_t stride,
                  MPI_Datatype oldtype, MPI_Datatype *newtype)
{
    struct mpi_type *of = mpi_type_of(r, oldtype);
    if (!of || negative(r, "count", count) || negative(r, "blocklength", length)) return r->code;
    bool in_bytes = combiner == MPI_COMBINER_HVECTOR;
    struct mpi_piece piece = {.count = count, .length = length, .of = of};
    piece.stride = in_bytes ? stride : mpi_type_bytes(stride, of->extent);
    struct mpi_type *t = one_piece(r, combiner, piece, in_bytes ? 2 : 3, in_bytes);
    t->integer[0] = count;
    t->integer[1] = length;
    if (in_bytes) t->address[0] = stride;
    else t->integer[2] = stride;
    return finish(r, t, newtype);
}

int mpi_type_vector(struct mpi_rank *self, MPI_Count count, MPI_Count blocklength, MPI_Count stride,
                    MPI_Datatype oldtype, MPI_Datatype *newtype)
{
    return vector(self, MPI_COMBINER_VECTOR, count, blocklength, stride, oldtype, newtype);
}

int mpi_type_create_hvector(struct mpi_rank *self, MPI_Count count, MPI_Count blocklength,
                            MPI_Count stride, MPI_Datatype oldtype, MPI_Datatype *newtype)
{
    return vector(self, MPI_COMBINER_HVECTOR, count, blocklength, stride, oldtype, newtype);
}

int mpi_type_hvector(struct mpi_rank *self, int count, int blocklength, MPI_Aint stride,
                     MPI_Datatype oldtype, MPI_Datatype *newtype)
{
    return vector(self, MPI_COMBINER_HVECTOR, count, blocklength, stride, oldtype, newtype);
}

/* The four kinds of indexed types: blocks of `length` or lengths[i] at places in elements
 * or bytes. Displacements in elements become bytes here: pieces know bytes alone. */
static int indexed(struct mpi_rank *r, int combiner, int64_t count, int64_t length,
                   struct mpi_counts lengths, struct mpi_counts places, MPI_Datatype oldtype,
                   MPI_Datatype *newtype)
{
    struct mpi_type *of = mpi_type_of(r, oldtype);
    if (!of || negative(r, "count", count) || negative(r, "blocklength", length)) return r->code;
    bool in_bytes = combiner == MPI_COMBINER_HINDEXED || combiner == MPI_COMBINER_HINDEXED_BLOCK;
    for (int64_t i = 0; i < count && lengths.at; i++)
        if (negative(r, "blocklength", mpi_count_at(lengths, i))) return r->code;
    /* One piece for each block: they lie anywhere. */
    struct mpi_type *t = mpi_type_make(r, combiner, (int)count);
    /* integers are count, lengths and then places, unless those are bytes */
    int nlength = lengths.at ? (int)count : 1;
    mpi_type_remember(r, t, 1 + nlength + (in_bytes ? 0 : (int)count), in_bytes ? (int)count : 0,
                      1);
    t->integer[0] = count;
    for (int i = 0; i < nlength; i++)
        t->integer[1 + i] = lengths.at ? mpi_count_at(lengths, i) : length;
    for (int i = 0; i < (int)count; i++) {
        int64_t place = mpi_count_at(places, i);
        if (in_bytes) t->address[i] = place;
        else t->integer[1 + nlength + i] = place;
        t->piece[i] =
            (struct mpi_piece){.at = in_bytes ? place : mpi_type_bytes(place, of->extent),
                               .count = 1,
                               .of = of};
        t->piece[i].length = lengths.at ? mpi_count_at(lengths, i) : length;
    }
    t->type[0] = of;
    mpi_type_use(of);
    return finish(r, t, newtype);
}

/* Blocks of one length need no array. */
static const struct mpi_counts none;

int mpi_type_indexed(struct mpi_rank *self, MPI_Count count,
                     struct mpi_counts array_of_blocklengths,
                     struct mpi_counts array_of_displacements, MPI_Datatype oldtype,
                     MPI_Datatype *newtype)
{
    return indexed(self, MPI_COMBINER_INDEXED, count, 0, array_of_blocklengths,
                   array_of_displacements, oldtype, newtype);
}

int mpi_type_create_hindexed(struct mpi_rank *self, MPI_Count count,
                             struct mpi_counts array_of_blocklengths,
                             const MPI_Aint array_of_displacements[], MPI_Datatype oldtype,
                             MPI_Datatype *newtype)
{
    return indexed(self, MPI_COMBINER_HINDEXED, count, 0, array_of_blocklengths,
                   (struct mpi_counts){array_of_displacements, 1}, oldtype, newtype);
}

int mpi_type_hindexed(struct mpi_rank *self, int count, int *array_of_blocklengths,
                      MPI_Aint *array_of_displacements, MPI_Datatype oldtype, MPI_Datatype *newtype)
{
    return indexed(self, MPI_COMBINER_HINDEXED, count, 0,
                   (struct mpi_counts){array_of_blocklengths, 0},
                   (struct mpi_counts){array_of_displacements, 1}, oldtype, newtype);
}

int mpi_type_create_indexed_block(struct mpi_rank *self, MPI_Count count, MPI_Count blocklength,
                                  struct mpi_counts array_of_displacements, MPI_Datatype oldtype,
                                  MPI_Datatype *newtype)
{
    return indexed(self, MPI_COMBINER_INDEXED_BLOCK, count, blocklength, none,
                   array_of_displacements, oldtype, newtype);
}

int mpi_type_create_hindexed_block(struct mpi_rank *self, MPI_Count count, MPI_Count blocklength,
                                   const MPI_Aint array_of_displacements[], MPI_Datatype oldtype,
                                   MPI_Datatype *newtype)
{
    return indexed(self, MPI_COMBINER_HINDEXED_BLOCK, count, blocklength, none,
                   (struct mpi_counts){array_of_displacements, 1}, oldtype, newtype);
}

static int structure(struct mpi_rank *r, int64_t count, struct mpi_counts lengths,
                     const MPI_Aint *places, const MPI_Datatype *types, MPI_Datatype *newtype)
{
    if (negative(r, "count", count)) return r->code;
    /* All arguments first: nothing is half-made when one is wrong. */
    for (int64_t i = 0; i < count; i++)
        if (!mpi_type_of(r, types[i]) || negative(r, "blocklength", mpi_count_at(lengths, i)))
            return r->code;
    struct mpi_type *t = mpi_type_make(r, MPI_COMBINER_STRUCT, (int)count);
    mpi_type_remember(r, t, (int)count + 1, (int)count, (int)count);
    t->integer[0] = count;
    for (int i = 0; i < (int)count; i++) {
        struct mpi_type *of = mpi_type_of(r, types[i]);
        t->integer[1 + i] = mpi_count_at(lengths, i);
        t->address[i] = places[i];
        t->type[i] = of;
        t->piece[i] =
            (struct mpi_piece){.at = places[i], .count = 1, .length = t->integer[1 + i], .of = of};
        mpi_type_use(of);
    }
    return finish(r, t, newtype);
}

int mpi_type_create_struct(struct mpi_rank *self, MPI_Count count,
                           struct mpi_counts array_of_blocklengths,
                           const MPI_Aint array_of_displacements[],
                           const MPI_Datatype array_of_types[], MPI_Datatype *newtype)
{
    return structure(self, count, array_of_blocklengths, array_of_displacements, array_of_types,
                     newtype);
}

int mpi_type_struct(struct mpi_rank *self, int count, int *array_of_blocklengths,
                    MPI_Aint *array_of_displacements, MPI_Datatype *array_of_types,
                    MPI_Datatype *newtype)
{
    return structure(self, count, (struct mpi_counts){array_of_blocklengths, 0},
                     array_of_displacements, array_of_types, newtype);
}

/* The pieces stay, only the bounds change (section 5.1.7): that is how blocks of a matrix
 * come to lie side by side in one message. */
int mpi_type_create_resized(struct mpi_rank *self, MPI_Datatype oldtype, MPI_Count lb,
                            MPI_Count extent, MPI_Datatype *newtype)
{
    struct mpi_type *of = mpi_type_of(self, oldtype);
    if (!of) return self->code;
    struct mpi_piece piece = {.count = 1, .length = 1, .of = of};
    struct mpi_type *t = one_piece(self, MPI_COMBINER_RESIZED, piece, 0, 2);
    t->address[0] = lb;
    /* Whatever the bounds were, the program's count. True bounds stay those of the data. */
    t->address[1] = extent;
    check_reach(self, lb);
    check_reach(self, extent);
    mpi_type_finish(self, t);
    t->lb = lb;
    t->extent = extent;
    t->marked = true;
    t->dense = of->dense && lb == 0 && extent == t->size;
    *newtype = mpi_handle(t);
    return MPI_SUCCESS;
}

/* A duplicate is as good as the original in reductions, too, hence its class (section
 * 5.1.10). A refused attribute undoes it. */
int mpi_type_dup(struct mpi_rank *self, MPI_Datatype oldtype, MPI_Datatype *newtype)
{
    struct mpi_type *of = mpi_type_of(self, oldtype);
    if (!of) return self->code;
    struct mpi_piece piece = {.count = 1, .length = 1, .of = of};
    struct mpi_type *t = one_piece(self, MPI_COMBINER_DUP, piece, 0, 0);
    mpi_type_finish(self, t);
    t->lb = of->lb;
    t->extent = of->extent;
    t->dense = of->dense;
    t->class = of->class;
    t->committed = of->committed;
    int code = mpi_attributes_copy(self, KIND_TYPE, of, t);
    if (code != MPI_SUCCESS) {
        *newtype = MPI_DATATYPE_NULL;
        mpi_type_drop(self, t);
        return code;
    }
    *newtype = mpi_handle(t);
    return MPI_SUCCESS;
}

/* Nothing is compiled at commit: pieces are ready when a type is made. The mark is there
 * because communication asks for it (section 5.1.9). */
int mpi_type_commit(struct mpi_rank *self, MPI_Datatype *datatype)
{
    struct mpi_type *t = mpi_type_of(self, *datatype);
    if (!t) return self->code;
    if (!t->committed) t->committed = true;
    return MPI_SUCCESS;
}

int mpi_type_free(struct mpi_rank *self, MPI_Datatype *datatype)
{
    struct mpi_type *t = mpi_type_of(self, *datatype);
    if (!t) return self->code;
    if (mpi_type_is_basic(t))
        return mpi_error(self, NULL, MPI_ERR_TYPE, "%s cannot be freed", t->name);
    /* The handle ends now; the type when nothing is made of it or under way with it. */
    if (t->o.uses > 1) {
        mpi_attributes_end(self, KIND_TYPE, t);
        mpi_handle_end(self, t);
    }
    mpi_type_drop(self, t);
    *datatype = MPI_DATATYPE_NULL;
    return MPI_SUCCESS;
}
