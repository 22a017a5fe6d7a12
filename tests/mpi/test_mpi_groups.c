/* test_mpi_groups.c - groups against lists of ranks, by random sequences of all operations on sets;
 * communicators made of them, and between two of them; what is refused. */
#include <limits.h>

#include "base/random.h"
#include "mpi_world.h"

enum { RANKS = 9, KEPT = 12 };

static void return_errors(void) { MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN); }

/* --- the model: ranks of the world in the group's order --- */

struct list {
    int n, rank[RANKS];
};

static int place_in(const struct list *l, int rank)
{
    for (int i = 0; i < l->n; i++)
        if (l->rank[i] == rank) return i;
    return MPI_UNDEFINED;
}

/* The ranks of `a` in (or not in) b, then those of b alone where `rest`. */
static struct list sets(const struct list *a, const struct list *b, bool common, bool own,
                        bool rest)
{
    struct list l = {0};
    for (int i = 0; i < a->n; i++)
        if (place_in(b, a->rank[i]) != MPI_UNDEFINED ? common : own) l.rank[l.n++] = a->rank[i];
    for (int i = 0; rest && i < b->n; i++)
        if (place_in(a, b->rank[i]) == MPI_UNDEFINED) l.rank[l.n++] = b->rank[i];
    return l;
}

/* Those named, in the order named, or all others in the group's. */
static struct list chosen(const struct list *a, int n, const int *named, bool include)
{
    struct list l = {0};
    for (int i = 0; include && i < n; i++) l.rank[l.n++] = a->rank[named[i]];
    for (int i = 0; !include && i < a->n; i++) {
        bool out = false;
        for (int k = 0; k < n; k++) out |= named[k] == i;
        if (!out) l.rank[l.n++] = a->rank[i];
    }
    return l;
}

/* --- checks --- */

/* Ranks share what is static: each has its own. */
static MPI_Group worlds[RANKS];
#define world worlds[own_rank()]

static void check_group(MPI_Group g, const struct list *l)
{
    int n, rank, one[RANKS], all[RANKS];
    MPI_Group_size(g, &n);
    assert_int_equal(n, l->n);
    assert_true((g == MPI_GROUP_EMPTY) == (n == 0));
    MPI_Group_rank(g, &rank);
    assert_int_equal(rank, place_in(l, own_rank()));
    for (int i = 0; i < RANKS; i++) one[i] = i;
    MPI_Group_translate_ranks(g, n, one, world, all);
    assert_memory_equal(all, l->rank, sizeof(int) * (size_t)n);
    MPI_Group_translate_ranks(world, RANKS, one, g, all);
    for (int i = 0; i < RANKS; i++) assert_int_equal(all[i], place_in(l, i));
}

static void check_compare(MPI_Group a, const struct list *x, MPI_Group b, const struct list *y)
{
    int found, expected = x->n == y->n ? MPI_IDENT : MPI_UNEQUAL;
    for (int i = 0; i < x->n && expected != MPI_UNEQUAL; i++) {
        const int at = place_in(y, x->rank[i]);
        if (at == MPI_UNDEFINED) expected = MPI_UNEQUAL;
        else if (at != i) expected = MPI_SIMILAR;
    }
    MPI_Group_compare(a, b, &found);
    assert_int_equal(found, expected);
}

/* n different numbers below `most`. */
static void draw(struct random *r, int n, int most, int *out)
{
    int all[RANKS];
    for (int i = 0; i < most; i++) all[i] = i;
    for (int i = 0; i < n; i++) {
        const int k = i + (int)random_below(r, (uint64_t)(most - i)), kept = all[i];
        out[i] = all[k], all[k] = kept;
    }
}

/* --- random sequences --- */

/* Up to two ranges whose ranks differ from each other, listed in `named`. */
static int draw_ranges(struct random *r, int size, int ranges[2][3], int *named)
{
    int n = 0, m = 0;
    for (int tries = 0; tries < 4 && n < 2; tries++) {
        const int first = (int)random_below(r, (uint64_t)size),
                  last = (int)random_below(r, (uint64_t)size),
                  step = (1 + (int)random_below(r, 3)) * (last < first ? -1 : 1);
        int before = m, k = first, clash = 0;
        for (; step > 0 ? k <= last : k >= last; k += step) {
            for (int i = 0; i < before; i++) clash |= named[i] == k;
            if (m < RANKS) named[m++] = k;
        }
        if (clash) m = before;
        else ranges[n][0] = first, ranges[n][1] = last, ranges[n++][2] = step;
    }
    return n;
}

static MPI_Group next(struct random *r, MPI_Group a, const struct list *x, MPI_Group b,
                      const struct list *y, struct list *out)
{
    MPI_Group g = MPI_GROUP_NULL;
    int named[2 * RANKS], ranges[2][3];
    const int way = (int)random_below(r, 7), n = (int)random_below(r, (uint64_t)x->n + 1);
    if (way == 0) *out = sets(x, y, true, true, true), MPI_Group_union(a, b, &g);
    if (way == 1) *out = sets(x, y, true, false, false), MPI_Group_intersection(a, b, &g);
    if (way == 2) *out = sets(x, y, false, true, false), MPI_Group_difference(a, b, &g);
    if (way == 3 || way == 4) {
        draw(r, n, x->n, named);
        *out = chosen(x, n, named, way == 3);
        if (way == 3) MPI_Group_incl(a, n, named, &g);
        else MPI_Group_excl(a, n, named, &g);
    }
    if (way >= 5) {
        const int m = x->n ? draw_ranges(r, x->n, ranges, named) : 0;
        int all = 0;
        for (int i = 0; i < m; i++) all += (ranges[i][1] - ranges[i][0]) / ranges[i][2] + 1;
        *out = chosen(x, all, named, way == 5);
        if (way == 5) MPI_Group_range_incl(a, m, ranges, &g);
        else MPI_Group_range_excl(a, m, ranges, &g);
    }
    return g;
}

static void sequences(void *context)
{
    struct list kept[KEPT];
    MPI_Group group[KEPT];
    (void)context;
    return_errors();
    MPI_Comm_group(MPI_COMM_WORLD, &world);
    /* the same seeds on all ranks; each sees its own place */
    struct random r = random_make(41, 0, 0);
    for (int k = 0; k < KEPT; k++) {
        kept[k].n = RANKS;
        for (int i = 0; i < RANKS; i++) kept[k].rank[i] = i;
        MPI_Comm_group(MPI_COMM_WORLD, &group[k]);
    }
    for (int round = 0; round < 1500; round++) {
        const int a = (int)random_below(&r, KEPT), b = (int)random_below(&r, KEPT),
                  to = (int)random_below(&r, KEPT);
        struct list l;
        MPI_Group g = next(&r, group[a], &kept[a], group[b], &kept[b], &l);
        check_group(g, &l);
        check_compare(g, &l, group[b], &kept[b]);
        check_compare(group[a], &kept[a], group[b], &kept[b]);
        /* small groups would stay small: now and then one begins again with all */
        if (l.n < 3 && random_below(&r, 3)) {
            if (l.n) MPI_Group_free(&g);
            MPI_Comm_group(MPI_COMM_WORLD, &g);
            l.n = RANKS;
            for (int i = 0; i < RANKS; i++) l.rank[i] = i;
        }
        if (kept[to].n) MPI_Group_free(&group[to]);
        group[to] = g, kept[to] = l;
    }
    for (int k = 0; k < KEPT; k++)
        if (kept[k].n) MPI_Group_free(&group[k]);
    MPI_Group_free(&world);
}

static void sets_of_ranks_are_those_of_the_lists(void **state)
{
    (void)state;
    mpi_ok(RANKS, sequences, NULL);
}

/* --- communicators of groups --- */

/* A communicator's ranks are the group's, in its order: everybody tells the rank of the world. */
static void check_comm(MPI_Comm c, const struct list *l)
{
    int all[RANKS], own = own_rank(), n, rank;
    MPI_Comm_size(c, &n);
    assert_int_equal(n, l->n);
    MPI_Comm_rank(c, &rank);
    assert_int_equal(rank, place_in(l, own));
    MPI_Allgather(&own, 1, MPI_INT, all, 1, MPI_INT, c);
    assert_memory_equal(all, l->rank, sizeof(int) * (size_t)n);
}

static void of_groups(void *context)
{
    struct random r = random_make(42, 0, 0);
    (void)context;
    MPI_Comm_group(MPI_COMM_WORLD, &world);
    for (int round = 0; round < 20; round++) {
        int named[RANKS], result;
        const int n = (int)random_below(&r, RANKS + 1);
        struct list l = {.n = n};
        MPI_Group g;
        MPI_Comm c, d;
        draw(&r, n, RANKS, named);
        memcpy(l.rank, named, sizeof(int) * (size_t)n);
        MPI_Group_incl(world, n, named, &g);
        MPI_Comm_create(MPI_COMM_WORLD, g, &c);
        assert_true((c == MPI_COMM_NULL) == (place_in(&l, own_rank()) == MPI_UNDEFINED));
        if (c != MPI_COMM_NULL) {
            check_comm(c, &l);
            /* only the members make the second one */
            MPI_Comm_create_group(MPI_COMM_WORLD, g, round, &d);
            check_comm(d, &l);
            MPI_Comm_compare(c, d, &result);
            assert_int_equal(result, MPI_CONGRUENT);
            MPI_Comm_compare(c, c, &result);
            assert_int_equal(result, MPI_IDENT);
            MPI_Comm_compare(c, MPI_COMM_WORLD, &result);
            bool in_order = true;
            for (int i = 0; i < n; i++) in_order &= l.rank[i] == i;
            assert_int_equal(result, n < RANKS  ? MPI_UNEQUAL
                                     : in_order ? MPI_CONGRUENT
                                                : MPI_SIMILAR);
            MPI_Comm_free(&d);
            MPI_Comm_free(&c);
        }
        if (n) MPI_Group_free(&g);
    }
    /* colours and keys, equal keys by the old ranks */
    for (int round = 0; round < 20; round++) {
        int colour[RANKS], key[RANKS];
        struct list l = {0};
        MPI_Comm c;
        for (int i = 0; i < RANKS; i++) {
            colour[i] = (int)random_below(&r, 4) - 1;
            if (colour[i] < 0) colour[i] = MPI_UNDEFINED;
            key[i] = (int)random_below(&r, 5) - 2;
        }
        const int own = own_rank();
        for (int k = -2; k <= 2; k++)
            for (int i = 0; i < RANKS; i++)
                if (key[i] == k && colour[i] == colour[own]) l.rank[l.n++] = i;
        MPI_Comm_split(MPI_COMM_WORLD, colour[own], key[own], &c);
        assert_true((c == MPI_COMM_NULL) == (colour[own] == MPI_UNDEFINED));
        if (c == MPI_COMM_NULL) continue;
        check_comm(c, &l);
        MPI_Comm_free(&c);
    }
    MPI_Group_free(&world);
}

static void communicators_have_the_ranks_of_their_groups(void **state)
{
    (void)state;
    mpi_ok(RANKS, of_groups, NULL);
}

/* --- between two groups --- */

struct sides {
    struct list side[2];
    int mine;
};

/* The intercommunicator between the first `n` ranks and the rest; leaders are the last of each. */
static MPI_Comm join(int n, struct sides *s)
{
    MPI_Comm half, inter;
    *s = (struct sides){.mine = own_rank() >= n};
    for (int i = 0; i < RANKS; i++) {
        struct list *l = &s->side[i >= n];
        l->rank[l->n++] = i;
    }
    MPI_Comm_split(MPI_COMM_WORLD, s->mine, 0, &half);
    MPI_Intercomm_create(half, s->side[s->mine].n - 1, MPI_COMM_WORLD, s->mine ? n - 1 : RANKS - 1,
                         7, &inter);
    MPI_Comm_free(&half);
    return inter;
}

static void check_inter(MPI_Comm inter, const struct sides *s)
{
    const struct list *own = &s->side[s->mine], *far = &s->side[!s->mine];
    int flag, n, rank;
    MPI_Group g;
    MPI_Comm_test_inter(inter, &flag);
    assert_true(flag);
    MPI_Comm_size(inter, &n);
    assert_int_equal(n, own->n);
    MPI_Comm_remote_size(inter, &n);
    assert_int_equal(n, far->n);
    MPI_Comm_rank(inter, &rank);
    assert_int_equal(rank, place_in(own, own_rank()));
    MPI_Comm_group(inter, &g);
    check_group(g, own);
    MPI_Group_free(&g);
    MPI_Comm_remote_group(inter, &g);
    check_group(g, far);
    MPI_Group_free(&g);
    /* ranks of messages are the other side's: everybody writes to the one with the own number,
     * around the shorter side */
    int out = 100 + own_rank(), in = -1;
    MPI_Request q = MPI_REQUEST_NULL;
    if (rank < far->n) MPI_Irecv(&in, 1, MPI_INT, rank, 5, inter, &q);
    if (rank < far->n) MPI_Send(&out, 1, MPI_INT, rank, 5, inter);
    MPI_Wait(&q, MPI_STATUS_IGNORE);
    assert_int_equal(in, rank < far->n ? 100 + far->rank[rank] : -1);
}

/* What each collective operation brings is the other side's. */
static void check_operations(MPI_Comm inter, const struct sides *s)
{
    const struct list *own = &s->side[s->mine], *far = &s->side[!s->mine];
    const int me = own_rank(), root_side = 1;
    int rank, x, y[RANKS * RANKS], sum = 0, out[RANKS];
    MPI_Comm_rank(inter, &rank);
    for (int i = 0; i < far->n; i++) sum += far->rank[i];
    MPI_Barrier(inter);
    MPI_Allgather(&me, 1, MPI_INT, y, 1, MPI_INT, inter);
    assert_memory_equal(y, far->rank, sizeof(int) * (size_t)far->n);
    MPI_Allreduce(&me, &x, 1, MPI_INT, MPI_SUM, inter);
    assert_int_equal(x, sum);
    for (int i = 0; i < far->n; i++) out[i] = 1000 * me + i;
    MPI_Alltoall(out, 1, MPI_INT, y, 1, MPI_INT, inter);
    for (int i = 0; i < far->n; i++) assert_int_equal(y[i], 1000 * far->rank[i] + rank);
    /* of one rank of the second side to or from all of the first */
    for (int k = 0; k < s->side[root_side].n; k++) {
        const int root = s->mine != root_side ? k : rank == k ? MPI_ROOT : MPI_PROC_NULL;
        const bool is_root = root == MPI_ROOT, hears = s->mine != root_side;
        const int there = s->side[root_side].rank[k];
        x = me;
        MPI_Bcast(&x, 1, MPI_INT, root, inter);
        assert_int_equal(x, hears ? there : me);
        memset(y, -1, sizeof y);
        MPI_Gather(&me, 1, MPI_INT, y, 1, MPI_INT, root, inter);
        for (int i = 0; i < far->n; i++) assert_int_equal(y[i], is_root ? far->rank[i] : -1);
        x = -1;
        MPI_Reduce(&me, &x, 1, MPI_INT, MPI_SUM, root, inter);
        assert_int_equal(x, is_root ? sum : -1);
        x = -1;
        for (int i = 0; i < far->n; i++) out[i] = 1000 * me + i;
        MPI_Scatter(out, 1, MPI_INT, &x, 1, MPI_INT, root, inter);
        assert_int_equal(x, hears ? 1000 * there + rank : -1);
    }
    (void)own;
}

static void between(void *context)
{
    (void)context;
    MPI_Comm_group(MPI_COMM_WORLD, &world);
    for (int n = 1; n < RANKS; n += n == 1 ? 3 : 2) {
        struct sides s;
        MPI_Comm inter = join(n, &s), copy, all;
        int result, order[RANKS], m;
        check_inter(inter, &s);
        check_operations(inter, &s);
        MPI_Comm_dup(inter, &copy);
        MPI_Comm_compare(inter, copy, &result);
        assert_int_equal(result, MPI_CONGRUENT);
        MPI_Comm_compare(inter, MPI_COMM_WORLD, &result);
        assert_int_equal(result, MPI_UNEQUAL);
        MPI_Comm_free(&inter);
        check_inter(copy, &s);
        check_operations(copy, &s);
        /* one of both: the side that does not say `high` comes first */
        for (int first = 0; first < 2; first++) {
            MPI_Intercomm_merge(copy, s.mine != first, &all);
            MPI_Comm_test_inter(all, &result);
            assert_false(result);
            m = own_rank();
            MPI_Allgather(&m, 1, MPI_INT, order, 1, MPI_INT, all);
            const struct list *a = &s.side[first], *b = &s.side[!first];
            for (int i = 0; i < RANKS; i++)
                assert_int_equal(order[i], i < a->n ? a->rank[i] : b->rank[i - a->n]);
            MPI_Comm_free(&all);
        }
        MPI_Comm_free(&copy);
    }
    MPI_Group_free(&world);
}

static void operations_between_groups_bring_the_other_sides_data(void **state)
{
    (void)state;
    mpi_ok(RANKS, between, NULL);
}

/* --- refusals --- */

static void refusals(void *context)
{
    MPI_Group g, w;
    int x;
    (void)context;
    return_errors();
    MPI_Comm_group(MPI_COMM_WORLD, &w);
    static const int twice[] = {1, 0, 1}, beyond[] = {0, 3}, below[] = {-1}, good[] = {0, 1};
    assert_int_equal(MPI_Group_incl(w, 3, twice, &g), MPI_ERR_RANK);
    assert_int_equal(MPI_Group_excl(w, 3, twice, &g), MPI_ERR_RANK);
    assert_int_equal(MPI_Group_incl(w, 2, beyond, &g), MPI_ERR_RANK);
    assert_int_equal(MPI_Group_excl(w, 2, beyond, &g), MPI_ERR_RANK);
    assert_int_equal(MPI_Group_incl(w, 1, below, &g), MPI_ERR_RANK);
    assert_int_equal(MPI_Group_incl(w, -1, good, &g), MPI_ERR_ARG);
    assert_int_equal(MPI_Group_excl(w, -1, good, &g), MPI_ERR_ARG);
    assert_int_equal(MPI_Group_range_incl(w, -1, NULL, &g), MPI_ERR_ARG);
    static const struct {
        int range[3], code, size; /* of the ranks included */
    } row[] = {
        {{0, 2, 0}, MPI_ERR_ARG, 0},
        {{0, 3, 1}, MPI_ERR_ARG, 0},
        {{-1, 2, 1}, MPI_ERR_ARG, 0},
        {{2, -1, -1}, MPI_ERR_ARG, 0},
        {{0, 2, 1}, MPI_SUCCESS, 3},
        {{2, 0, -1}, MPI_SUCCESS, 3},
        {{2, 0, 1}, MPI_SUCCESS, 0},
        {{0, 2, 2}, MPI_SUCCESS, 2},
        {{1, 2, INT_MAX}, MPI_SUCCESS, 1},
        {{2, 1, INT_MIN}, MPI_SUCCESS, 1},
        {{0, INT_MAX, INT_MAX}, MPI_ERR_ARG, 0},
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        int range[1][3];
        memcpy(range, row[k].range, sizeof range);
        if (MPI_Group_range_incl(w, 1, range, &g) != row[k].code) fail_msg("range %d", (int)k);
        if (row[k].code != MPI_SUCCESS) continue;
        MPI_Group_size(g, &x);
        assert_int_equal(x, row[k].size);
        if (x) MPI_Group_free(&g);
    }
    int again[2][3] = {{0, 1, 1}, {1, 2, 1}};
    assert_true(MPI_Group_range_incl(w, 2, again, &g) != MPI_SUCCESS);
    MPI_Group_free(&w);
}

/* Ranks, groups and communicators that are none. */
static void no_groups(void *context)
{
    static const int beyond[] = {0, 3};
    MPI_Group g, w;
    MPI_Comm c;
    int out[3], x;
    (void)context;
    return_errors();
    MPI_Comm_set_errhandler(MPI_COMM_SELF, MPI_ERRORS_RETURN);
    MPI_Comm_group(MPI_COMM_WORLD, &w);
    assert_int_equal(MPI_Group_translate_ranks(w, 2, beyond, w, out), MPI_ERR_RANK);
    int none[] = {MPI_PROC_NULL, 2};
    assert_int_equal(MPI_Group_translate_ranks(w, 2, none, w, out), MPI_SUCCESS);
    assert_true(out[0] == MPI_PROC_NULL && out[1] == 2);
    assert_int_equal(MPI_Group_size(MPI_GROUP_NULL, &x), MPI_ERR_GROUP);
    assert_int_equal(MPI_Group_union(w, MPI_GROUP_NULL, &g), MPI_ERR_GROUP);
    assert_int_equal(MPI_Group_compare(MPI_GROUP_NULL, w, &x), MPI_ERR_GROUP);
    g = MPI_GROUP_NULL;
    assert_int_equal(MPI_Group_free(&g), MPI_ERR_GROUP);
    /* what has one group has no other one */
    assert_int_equal(MPI_Comm_remote_size(MPI_COMM_WORLD, &x), MPI_ERR_COMM);
    assert_int_equal(MPI_Comm_remote_group(MPI_COMM_WORLD, &g), MPI_ERR_COMM);
    assert_int_equal(MPI_Intercomm_merge(MPI_COMM_WORLD, 0, &c), MPI_ERR_COMM);
    assert_int_equal(MPI_Intercomm_create(MPI_COMM_SELF, 1, MPI_COMM_WORLD, 0, 0, &c),
                     MPI_ERR_RANK);
    assert_int_equal(MPI_Intercomm_create(MPI_COMM_SELF, 0, MPI_COMM_WORLD, 3, 0, &c),
                     MPI_ERR_RANK);
    assert_int_equal(MPI_Intercomm_create(MPI_COMM_SELF, 0, MPI_COMM_WORLD, -1, 0, &c),
                     MPI_ERR_RANK);
    assert_int_equal(MPI_Intercomm_create(MPI_COMM_NULL, 0, MPI_COMM_WORLD, 0, 0, &c),
                     MPI_ERR_COMM);
    assert_int_equal(MPI_Comm_split(MPI_COMM_WORLD, -5, 0, &c), MPI_ERR_ARG);
    MPI_Group_free(&w);
}

/* A group that the program has freed serves the communicators made of it. */
static void freed(void *context)
{
    MPI_Group w, g;
    MPI_Comm c, d;
    int n;
    (void)context;
    MPI_Comm_group(MPI_COMM_WORLD, &w);
    MPI_Group_incl(w, 2, (int[]){2, 0}, &g);
    MPI_Group_free(&w);
    MPI_Comm_create(MPI_COMM_WORLD, g, &c);
    MPI_Group_free(&g);
    if (c == MPI_COMM_NULL) return;
    MPI_Comm_dup(c, &d);
    MPI_Comm_free(&c);
    MPI_Comm_group(d, &g);
    MPI_Comm_free(&d);
    MPI_Group_size(g, &n);
    assert_int_equal(n, 2);
    MPI_Group_rank(g, &n);
    assert_int_equal(n, own_rank() == 0);
    MPI_Group_free(&g);
}

static void wrong_groups_are_refused(void **state)
{
    (void)state;
    mpi_ok(3, refusals, NULL);
    mpi_ok(3, no_groups, NULL);
    mpi_ok(3, freed, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sets_of_ranks_are_those_of_the_lists),
        cmocka_unit_test(communicators_have_the_ranks_of_their_groups),
        cmocka_unit_test(operations_between_groups_bring_the_other_sides_data),
        cmocka_unit_test(wrong_groups_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
