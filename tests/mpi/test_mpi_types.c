/* test_mpi_types.c - datatypes against the type map of the standard: random trees of constructors
 * beside a list of all their basic elements, then what they were made of. */
#include <limits.h>

#include "base/random.h"
#include "mpi_world.h"

enum { MOST = 600, SPACE = 1 << 16, ORIGIN = SPACE / 2 };

static void return_errors(void) { MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN); }

/* --- the model: every basic element with its place, and bounds that were set --- */

struct map {
    int n;
    struct {
        long at;
        int size;
    } e[MOST];
    bool any;    /* something bounds it */
    bool marked; /* bounds were set: then they alone bound what is made of it */
    long lb, ub;
    int align;
};

/* Bounds of a list of parts grow with each of them. */
static void grow(struct map *m, const struct map *part, long at)
{
    if (!part->any) return;
    const bool first = !m->any || (part->marked && !m->marked);
    if (first || part->marked == m->marked) {
        if (first || part->lb + at < m->lb) m->lb = part->lb + at;
        if (first || part->ub + at > m->ub) m->ub = part->ub + at;
    }
    m->any = true;
    m->marked |= part->marked;
    if (part->n > 0 && part->align > m->align) m->align = part->align;
    for (int i = 0; i < part->n && m->n < MOST; i++) {
        m->e[m->n].at = part->e[i].at + at;
        m->e[m->n++].size = part->e[i].size;
    }
}

/* A block of n, each an extent behind the last. */
static void grow_block(struct map *m, const struct map *part, long at, long n)
{
    for (long i = 0; i < n; i++) grow(m, part, at + i * (part->ub - part->lb));
}

static long size_of(const struct map *m)
{
    long size = 0;
    for (int i = 0; i < m->n; i++) size += m->e[i].size;
    return size;
}

/* --- random types --- */

struct maker {
    struct random r;
    MPI_Datatype made[64]; /* to be freed */
    int n;
};

static int below(struct maker *k, int n) { return (int)random_below(&k->r, (uint64_t)n); }

static MPI_Datatype keep(struct maker *k, MPI_Datatype t) { return k->made[k->n++] = t; }

static MPI_Datatype make(struct maker *k, int depth, struct map *m);

static MPI_Datatype make_basic(struct maker *k, struct map *m)
{
    static const struct {
        MPI_Datatype type;
        int size;
    } basic[] = {{MPI_CHAR, 1}, {MPI_SHORT, 2},  {MPI_INT, 4}, {MPI_FLOAT, 4},
                 {MPI_BYTE, 1}, {MPI_DOUBLE, 8}, {MPI_LONG, 8}};
    const int i = below(k, 7), s = basic[i].size;
    *m = (struct map){.n = 1, .e = {{0, s}}, .any = true, .lb = 0, .ub = s, .align = s};
    return basic[i].type;
}

/* Blocks of one old type at places in extents or bytes. */
static MPI_Datatype make_indexed(struct maker *k, MPI_Datatype old, const struct map *o,
                                 struct map *m)
{
    const int n = below(k, 4), way = below(k, 4), one = below(k, 3);
    int lengths[4], places[4];
    MPI_Aint bytes[4];
    MPI_Datatype t;
    for (int i = 0; i < n; i++) {
        lengths[i] = way < 2 ? below(k, 3) : one;
        places[i] = below(k, 9) - 4;
        bytes[i] = 4 * (below(k, 41) - 20);
        grow_block(m, o, way % 2 ? bytes[i] : places[i] * (o->ub - o->lb), lengths[i]);
    }
    if (way == 0) MPI_Type_indexed(n, lengths, places, old, &t);
    if (way == 1) MPI_Type_create_hindexed(n, lengths, bytes, old, &t);
    if (way == 2) MPI_Type_create_indexed_block(n, one, places, old, &t);
    if (way == 3) MPI_Type_create_hindexed_block(n, one, bytes, old, &t);
    return keep(k, t);
}

static MPI_Datatype make_struct(struct maker *k, int depth, struct map *m)
{
    const int n = below(k, 4);
    int lengths[4];
    MPI_Aint places[4];
    MPI_Datatype types[4], t;
    for (int i = 0; i < n; i++) {
        struct map *part = calloc(1, sizeof *part);
        types[i] = make(k, depth - 1, part);
        lengths[i] = below(k, 3);
        places[i] = below(k, 81) - 40;
        grow_block(m, part, places[i], lengths[i]);
        free(part);
    }
    /* the end as a C compiler would pad it */
    if (!m->marked && m->align > 0 && (m->ub - m->lb) % m->align)
        m->ub += m->align - (m->ub - m->lb) % m->align;
    MPI_Type_create_struct(n, lengths, places, types, &t);
    return keep(k, t);
}

/* A part of an array of up to three dimensions, element by element. */
static MPI_Datatype make_subarray(struct maker *k, MPI_Datatype old, const struct map *o,
                                  struct map *m)
{
    const int n = 1 + below(k, 3), order = below(k, 2) ? MPI_ORDER_C : MPI_ORDER_FORTRAN;
    const long extent = o->ub - o->lb;
    int size[3], part[3], start[3], at[3] = {0};
    long whole = 1;
    MPI_Datatype t;
    for (int d = 0; d < n; d++) {
        size[d] = 1 + below(k, 3);
        part[d] = 1 + below(k, size[d]);
        start[d] = below(k, size[d] - part[d] + 1);
        whole *= size[d];
    }
    for (;;) {
        long place = 0;
        for (int i = 0; i < n; i++) {
            const int d = order == MPI_ORDER_C ? i : n - 1 - i;
            place = place * size[d] + start[d] + at[d];
        }
        grow(m, o, place * extent);
        int i = 0;
        for (; i < n; i++) {
            const int d = order == MPI_ORDER_C ? n - 1 - i : i;
            if (++at[d] < part[d]) break;
            at[d] = 0;
        }
        if (i == n) break;
    }
    m->any = m->marked = true, m->lb = 0, m->ub = whole * extent;
    MPI_Type_create_subarray(n, size, part, start, order, old, &t);
    return keep(k, t);
}

static MPI_Datatype make(struct maker *k, int depth, struct map *m)
{
    if (depth == 0) return make_basic(k, m);
    const int way = below(k, 7);
    *m = (struct map){.n = 0};
    if (way == 0) return make_struct(k, depth, m);
    struct map *o = calloc(1, sizeof *o);
    MPI_Datatype old = make(k, depth - 1, o), t = MPI_DATATYPE_NULL;
    const long extent = o->ub - o->lb;
    if (way == 1) {
        const int n = below(k, 4);
        grow_block(m, o, 0, n);
        MPI_Type_contiguous(n, old, &t);
    } else if (way == 2 || way == 3) {
        const int n = below(k, 4), length = below(k, 3), stride = below(k, 9) - 4;
        const MPI_Aint bytes = way == 2 ? stride * extent : 4 * stride;
        for (int i = 0; i < n; i++) grow_block(m, o, i * bytes, length);
        if (way == 2) MPI_Type_vector(n, length, stride, old, &t);
        else MPI_Type_create_hvector(n, length, bytes, old, &t);
    } else if (way == 4) {
        *m = *o;
        if (below(k, 2)) {
            MPI_Type_dup(old, &t);
        } else {
            m->any = m->marked = true;
            m->lb = 4 * (below(k, 9) - 4), m->ub = m->lb + 4 * below(k, 12);
            MPI_Type_create_resized(old, m->lb, m->ub - m->lb, &t);
        }
    } else if (way == 5) {
        t = make_indexed(k, old, o, m);
    } else {
        t = make_subarray(k, old, o, m);
    }
    if (way < 5) keep(k, t);
    free(o);
    return t;
}

/* --- what is checked of each --- */

static char memory[SPACE], copy[SPACE], packed[2 * 8 * MOST];

/* One byte that tells where it lies. */
static char byte_at(long i) { return (char)(i * 37 + (i >> 8) * 11 + 1); }

static void check_bounds(MPI_Datatype t, const struct map *m)
{
    MPI_Aint lb, extent;
    MPI_Count low, wide;
    int size;
    long first = 0, last = 0;
    for (int i = 0; i < m->n; i++) {
        if (i == 0 || m->e[i].at < first) first = m->e[i].at;
        if (i == 0 || m->e[i].at + m->e[i].size > last) last = m->e[i].at + m->e[i].size;
    }
    MPI_Type_size(t, &size);
    assert_int_equal(size, size_of(m));
    MPI_Type_get_true_extent(t, &lb, &extent);
    assert_int_equal(lb, first);
    assert_int_equal(extent, last - first);
    MPI_Type_get_extent(t, &lb, &extent);
    assert_int_equal(lb, m->lb);
    assert_int_equal(extent, m->ub - m->lb);
    MPI_Type_get_extent_x(t, &low, &wide);
    assert_true(low == lb && wide == extent);
    MPI_Type_get_true_extent_x(t, &low, &wide);
    assert_true(low == first && wide == last - first);
}

/* Packed bytes are those of the map, in its order; unpacked they go to no other places. */
static void check_packing(MPI_Datatype t, const struct map *m, int count)
{
    int position = 3, n = 3;
    const long extent = m->ub - m->lb;
    MPI_Pack(memory + ORIGIN, count, t, packed, sizeof packed, &position, MPI_COMM_WORLD);
    for (int c = 0; c < count; c++)
        for (int i = 0; i < m->n; i++)
            for (int b = 0; b < m->e[i].size; b++)
                assert_int_equal(packed[n++], byte_at(ORIGIN + c * extent + m->e[i].at + b));
    assert_int_equal(position, n);
    memset(copy, 0, sizeof copy);
    position = 3;
    MPI_Unpack(packed, n, &position, copy + ORIGIN, count, t, MPI_COMM_WORLD);
    assert_int_equal(position, n);
    static char expected[SPACE];
    memset(expected, 0, sizeof expected);
    for (int c = 0; c < count; c++)
        for (int i = 0; i < m->n; i++)
            for (int b = 0; b < m->e[i].size; b++) {
                const long at = ORIGIN + c * extent + m->e[i].at + b;
                expected[at] = byte_at(at);
            }
    assert_memory_equal(copy, expected, sizeof copy);
    /* the same by a message to the rank itself, which is cut where it ends */
    const long whole = n - 3, some = whole * 2 / 3;
    MPI_Status s;
    memset(copy, 0, sizeof copy);
    MPI_Sendrecv(packed + 3, (int)some, MPI_BYTE, 0, 1, copy + ORIGIN, count, t, 0, 1,
                 MPI_COMM_SELF, &s);
    memset(expected, 0, sizeof expected);
    long left = some;
    int basics = 0;
    bool odd = false;
    for (int c = 0; c < count; c++)
        for (int i = 0; i < m->n; i++) {
            if (left >= m->e[i].size) basics++;
            else if (left > 0) odd = true;
            for (int b = 0; b < m->e[i].size && left > 0; b++, left--) {
                const long at = ORIGIN + c * extent + m->e[i].at + b;
                expected[at] = packed[3 + some - left];
            }
        }
    assert_memory_equal(copy, expected, sizeof copy);
    int found;
    MPI_Get_elements(&s, t, &found);
    assert_int_equal(found, odd ? MPI_UNDEFINED : basics);
    MPI_Get_count(&s, t, &found);
    const long size = size_of(m);
    assert_int_equal(found, size == 0 ? 0 : some % size ? MPI_UNDEFINED : some / size);
    /* and what is set is told again, any number of elements */
    for (int i = 0; i <= 2 * m->n && m->n > 0; i++) {
        MPI_Status_set_elements(&s, t, i);
        MPI_Get_elements(&s, t, &found);
        assert_int_equal(found, i);
    }
}

static void random_types(void *context)
{
    struct map *m = calloc(1, sizeof *m);
    int checked = 0;
    (void)context;
    for (long i = 0; i < SPACE; i++) memory[i] = byte_at(i);
    for (uint64_t seed = 0; seed < 1500; seed++) {
        struct maker k = {.r = random_make(seed, 9, 0)};
        MPI_Datatype t = make(&k, (int)(seed % 5), m);
        const long reach = 3 * labs(m->ub - m->lb) + labs(m->lb) + 2000;
        if (m->n < MOST / 2 && reach < ORIGIN) {
            MPI_Type_commit(&t);
            check_bounds(t, m);
            for (int i = 0; i < m->n; i++) assert_true(labs(m->e[i].at) < ORIGIN - reach / 2);
            check_packing(t, m, 1 + (int)(seed % 3));
            checked++;
        }
        /* in the order made: what others are made of lives on */
        for (int i = 0; i < k.n; i++) MPI_Type_free(&k.made[i]);
    }
    assert_true(checked > 1000);
    free(m);
}

static void random_types_are_their_maps(void **state)
{
    (void)state;
    mpi_ok(1, random_types, NULL);
}

/* --- distributed arrays: the parts of all processes are the whole --- */

/* The owner of index i of g, by dealing one by one. */
static int owner(int i, int g, int distribution, int argument, int n)
{
    if (distribution == MPI_DISTRIBUTE_NONE) return 0;
    if (argument == MPI_DISTRIBUTE_DFLT_DARG)
        argument = distribution == MPI_DISTRIBUTE_BLOCK ? (g + n - 1) / n : 1;
    return i / argument % n;
}

static void arrays(void *context)
{
    struct random r = random_make(77, 0, 0);
    (void)context;
    for (int round = 0; round < 300; round++) {
        int n = 1 + (int)random_below(&r, 3), g[3], how[3], argument[3], p[3], size = 1;
        long whole = 1;
        const int order = random_below(&r, 2) ? MPI_ORDER_C : MPI_ORDER_FORTRAN;
        for (int d = 0; d < n; d++) {
            static const int kinds[] = {MPI_DISTRIBUTE_NONE, MPI_DISTRIBUTE_BLOCK,
                                        MPI_DISTRIBUTE_CYCLIC};
            how[d] = kinds[random_below(&r, 3)];
            g[d] = 1 + (int)random_below(&r, 7);
            p[d] = how[d] == MPI_DISTRIBUTE_NONE ? 1 : 1 + (int)random_below(&r, 4);
            argument[d] = MPI_DISTRIBUTE_DFLT_DARG;
            if (how[d] == MPI_DISTRIBUTE_CYCLIC && random_below(&r, 2))
                argument[d] = 1 + (int)random_below(&r, 4);
            if (how[d] == MPI_DISTRIBUTE_BLOCK && random_below(&r, 2))
                argument[d] = (g[d] + p[d] - 1) / p[d] + (int)random_below(&r, 2);
            size *= p[d], whole *= g[d];
        }
        for (int rank = 0; rank < size; rank++) {
            int in[343], out[343], position = 0, m = 0, bytes;
            MPI_Datatype t;
            MPI_Aint lb, extent;
            for (int i = 0; i < 343; i++) in[i] = i;
            MPI_Type_create_darray(size, rank, n, g, how, argument, p, order, MPI_INT, &t);
            MPI_Type_commit(&t);
            MPI_Type_get_extent(t, &lb, &extent);
            assert_true(lb == 0 && extent == whole * (long)sizeof(int));
            MPI_Pack(in, 1, t, out, sizeof out, &position, MPI_COMM_WORLD);
            /* indices in the order of memory: those whose owners are this process */
            for (int i = 0; i < whole; i++) {
                int rest = i, place = rank, mine = 1, index[3], at[3];
                for (int k = 0; k < n; k++) {
                    const int d = order == MPI_ORDER_C ? n - 1 - k : k;
                    index[d] = rest % g[d], rest /= g[d];
                }
                for (int d = n - 1; d >= 0; d--) at[d] = place % p[d], place /= p[d];
                for (int d = 0; d < n; d++)
                    mine &= owner(index[d], g[d], how[d], argument[d], p[d]) == at[d];
                if (mine) assert_int_equal(out[m++], i);
            }
            MPI_Type_size(t, &bytes);
            assert_int_equal(bytes, m * (int)sizeof(int));
            assert_int_equal(position, bytes);
            MPI_Type_free(&t);
        }
    }
}

static void distributed_arrays_are_dealt_out(void **state)
{
    (void)state;
    mpi_ok(1, arrays, NULL);
}

/* --- what a type was made of --- */

static void expect_contents(MPI_Datatype t, int combiner, int ni, const int *i, int na,
                            const MPI_Aint *a, int nd, MPI_Datatype first)
{
    int n, m, d, c, integers[32];
    MPI_Aint addresses[8];
    MPI_Datatype types[8] = {MPI_DATATYPE_NULL};
    assert_int_equal(MPI_Type_get_envelope(t, &n, &m, &d, &c), MPI_SUCCESS);
    assert_int_equal(c, combiner);
    assert_true(n == ni && m == na && d == nd);
    if (ni > 0)
        assert_int_equal(MPI_Type_get_contents(t, ni - 1, na, nd, integers, addresses, types),
                         MPI_ERR_ARG);
    if (na > 0)
        assert_int_equal(MPI_Type_get_contents(t, ni, na - 1, nd, integers, addresses, types),
                         MPI_ERR_ARG);
    if (nd > 0)
        assert_int_equal(MPI_Type_get_contents(t, ni, na, nd - 1, integers, addresses, types),
                         MPI_ERR_ARG);
    assert_int_equal(MPI_Type_get_contents(t, ni, na, nd, integers, addresses, types), MPI_SUCCESS);
    if (ni > 0) assert_memory_equal(integers, i, sizeof(int) * (size_t)ni);
    if (na > 0) assert_memory_equal(addresses, a, sizeof(MPI_Aint) * (size_t)na);
    for (int k = 0; k < nd; k++) assert_true(types[k] == first);
    MPI_Type_free(&t);
}

static void contents(void *context)
{
    const MPI_Datatype I = MPI_INT;
    const int li[] = {2, 3}, at[] = {-5, 7}, g[] = {4, 6}, part[] = {2, 3}, from[] = {1, 2},
              how[] = {MPI_DISTRIBUTE_BLOCK, MPI_DISTRIBUTE_CYCLIC}, dargs[] = {2, 1},
              grid[] = {2, 3};
    const MPI_Aint far[] = {-8, 16};
    MPI_Datatype t, u;
    (void)context;
    return_errors();
    MPI_Type_contiguous(9, I, &t);
    expect_contents(t, MPI_COMBINER_CONTIGUOUS, 1, (int[]){9}, 0, NULL, 1, I);
    MPI_Type_create_hvector(3, 2, -40, I, &t);
    expect_contents(t, MPI_COMBINER_HVECTOR, 2, (int[]){3, 2}, 1, (MPI_Aint[]){-40}, 1, I);
    MPI_Type_indexed(2, li, at, I, &t);
    expect_contents(t, MPI_COMBINER_INDEXED, 5, (int[]){2, 2, 3, -5, 7}, 0, NULL, 1, I);
    MPI_Type_create_hindexed(2, li, far, I, &t);
    expect_contents(t, MPI_COMBINER_HINDEXED, 3, (int[]){2, 2, 3}, 2, far, 1, I);
    MPI_Type_create_indexed_block(2, 4, at, I, &t);
    expect_contents(t, MPI_COMBINER_INDEXED_BLOCK, 4, (int[]){2, 4, -5, 7}, 0, NULL, 1, I);
    MPI_Type_create_hindexed_block(2, 4, far, I, &t);
    expect_contents(t, MPI_COMBINER_HINDEXED_BLOCK, 2, (int[]){2, 4}, 2, far, 1, I);
    MPI_Type_create_struct(2, li, far, (MPI_Datatype[]){I, I}, &t);
    expect_contents(t, MPI_COMBINER_STRUCT, 3, (int[]){2, 2, 3}, 2, far, 2, I);
    MPI_Type_create_resized(I, -4, 12, &t);
    expect_contents(t, MPI_COMBINER_RESIZED, 0, NULL, 2, (MPI_Aint[]){-4, 12}, 1, I);
    MPI_Type_dup(I, &t);
    expect_contents(t, MPI_COMBINER_DUP, 0, NULL, 0, NULL, 1, I);
    MPI_Type_create_subarray(2, g, part, from, MPI_ORDER_FORTRAN, I, &t);
    expect_contents(t, MPI_COMBINER_SUBARRAY, 8, (int[]){2, 4, 6, 2, 3, 1, 2, MPI_ORDER_FORTRAN}, 0,
                    NULL, 1, I);
    MPI_Type_create_darray(6, 4, 2, g, how, dargs, grid, MPI_ORDER_C, I, &t);
    expect_contents(t, MPI_COMBINER_DARRAY, 12,
                    (int[]){6, 4, 2, 4, 6, how[0], how[1], 2, 1, 2, 3, MPI_ORDER_C}, 0, NULL, 1, I);
    /* a type that the program has freed can still be asked for, and used */
    MPI_Type_contiguous(2, I, &u);
    MPI_Type_contiguous(3, u, &t);
    MPI_Type_free(&u);
    for (int k = 0; k < 3; k++) {
        int n, size;
        assert_int_equal(MPI_Type_get_contents(t, 1, 0, 1, &n, NULL, &u), MPI_SUCCESS);
        MPI_Type_size(u, &size);
        assert_int_equal(size, 8);
        MPI_Type_free(&u);
    }
    MPI_Type_size(t, &(int){0});
    MPI_Type_free(&t);
    int n, m, d, c;
    MPI_Type_get_envelope(MPI_DOUBLE, &n, &m, &d, &c);
    assert_true(n == 0 && m == 0 && d == 0 && c == MPI_COMBINER_NAMED);
    assert_int_equal(MPI_Type_get_contents(MPI_DOUBLE, 0, 0, 0, &n, NULL, &u), MPI_ERR_TYPE);
}

static void contents_are_what_was_given(void **state)
{
    (void)state;
    mpi_ok(1, contents, NULL);
}

/* --- bounds by hand, where the model's rules could share a mistake with the program's --- */

static void bounds(void *context)
{
    MPI_Datatype t, u;
    MPI_Aint lb, extent;
    (void)context;
    /* the standard's example of {(double, 0), (char, 8)}: 16 bytes, 9 of data */
    MPI_Type_create_struct(2, (int[]){1, 1}, (MPI_Aint[]){0, 8},
                           (MPI_Datatype[]){MPI_DOUBLE, MPI_CHAR}, &t);
    MPI_Type_get_extent(t, &lb, &extent);
    assert_true(lb == 0 && extent == 16);
    MPI_Type_get_true_extent(t, &lb, &extent);
    assert_true(lb == 0 && extent == 9);
    MPI_Type_free(&t);
    /* its resized (lb -3, extent 9), then two of them: from -3 to 15 */
    MPI_Type_create_resized(MPI_INT, -3, 9, &u);
    MPI_Type_contiguous(2, u, &t);
    MPI_Type_get_extent(t, &lb, &extent);
    assert_true(lb == -3 && extent == 18);
    MPI_Type_get_true_extent(t, &lb, &extent);
    assert_true(lb == 0 && extent == 13);
    MPI_Type_free(&t);
    /* beside bounds that were set, data do not count, and nothing is padded */
    MPI_Type_create_struct(2, (int[]){1, 1}, (MPI_Aint[]){0, 100}, (MPI_Datatype[]){u, MPI_DOUBLE},
                           &t);
    MPI_Type_get_extent(t, &lb, &extent);
    assert_true(lb == -3 && extent == 9);
    MPI_Type_get_true_extent(t, &lb, &extent);
    assert_true(lb == 0 && extent == 108);
    MPI_Type_free(&t);
    MPI_Type_free(&u);
    /* nothing at all */
    MPI_Type_contiguous(0, MPI_DOUBLE, &t);
    MPI_Type_get_extent(t, &lb, &extent);
    assert_true(lb == 0 && extent == 0);
    MPI_Type_free(&t);
}

static void bounds_follow_the_standard(void **state)
{
    (void)state;
    mpi_ok(1, bounds, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_types_are_their_maps),
        cmocka_unit_test(distributed_arrays_are_dealt_out),
        cmocka_unit_test(contents_are_what_was_given),
        cmocka_unit_test(bounds_follow_the_standard),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
