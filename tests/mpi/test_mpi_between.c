/* test_mpi_between.c - intercommunicators split and created at random against lists kept here, and
 * blocks of uneven sizes between two groups. */
#include "mpi_world.h"

#include "base/random.h"

enum { RANKS = 7, MOST = 12 };

/* Ranks of the world, in the order of a group. */
struct list {
    int n, rank[RANKS];
};

static struct random stream;

static int below(int n) { return (int)random_below(&stream, (uint64_t)n); }

/* All ranks draw the same numbers, since nobody waits between two draws: each keeps a stream of its
 * own. */
static void draw_as(uint64_t seed) { stream = random_make(seed, 3, 0); }

static int place_in(const struct list *l, int rank)
{
    for (int i = 0; i < l->n; i++)
        if (l->rank[i] == rank) return i;
    return -1;
}

/* The intercommunicator between two sides, which hold all ranks. */
static MPI_Comm join(struct list side[2], int first)
{
    MPI_Comm half, inter;
    const int mine = own_rank() >= first;
    side[0].n = side[1].n = 0;
    for (int i = 0; i < RANKS; i++) side[i >= first].rank[side[i >= first].n++] = i;
    MPI_Comm_split(MPI_COMM_WORLD, mine, 0, &half);
    MPI_Intercomm_create(half, 0, MPI_COMM_WORLD, mine ? 0 : first, 7, &inter);
    MPI_Comm_free(&half);
    return inter;
}

static void check_group(MPI_Group g, const struct list *l)
{
    int n, rank[RANKS], world_rank[RANKS];
    MPI_Group world;
    MPI_Group_size(g, &n);
    assert_int_equal(n, l->n);
    for (int i = 0; i < n; i++) rank[i] = i;
    MPI_Comm_group(MPI_COMM_WORLD, &world);
    MPI_Group_translate_ranks(g, n, rank, world, world_rank);
    assert_memory_equal(world_rank, l->rank, sizeof(int) * (size_t)n);
    MPI_Group_free(&world);
    MPI_Group_free(&g);
}

/* Groups, and that messages of one tag go to this part alone: every rank writes to every rank of
 * the other side. */
static void check_part(MPI_Comm c, const struct list *near, const struct list *far, int word)
{
    MPI_Group g;
    int in[RANKS], out = 1000 * word + own_rank(), sum = 0, total;
    MPI_Request q[2 * RANKS];
    const int place = place_in(near, own_rank());
    if (near->n == 0 || far->n == 0 || place < 0) {
        assert_true(c == MPI_COMM_NULL);
        return;
    }
    assert_true(c != MPI_COMM_NULL);
    MPI_Comm_group(c, &g);
    check_group(g, near);
    MPI_Comm_remote_group(c, &g);
    check_group(g, far);
    for (int i = 0; i < far->n; i++) {
        MPI_Irecv(&in[i], 1, MPI_INT, i, 1, c, &q[i]);
        MPI_Isend(&out, 1, MPI_INT, i, 1, c, &q[far->n + i]);
    }
    MPI_Waitall(2 * far->n, q, MPI_STATUSES_IGNORE);
    for (int i = 0; i < far->n; i++) assert_int_equal(in[i], 1000 * word + far->rank[i]);
    MPI_Allreduce(&out, &total, 1, MPI_INT, MPI_SUM, c);
    for (int i = 0; i < far->n; i++) sum += 1000 * word + far->rank[i];
    assert_int_equal(total, sum);
}

/* ---- splits ---- */

/* Colors and keys of all ranks. */
struct choices {
    int color[RANKS], key[RANKS];
};

/* Those of a side with one color, by key, then by place: insertion, as on paper. */
static struct list part_of(const struct list *side, const struct choices *x, int color)
{
    struct list l = {0};
    for (int i = 0; i < side->n; i++) {
        const int rank = side->rank[i];
        if (color == MPI_UNDEFINED || x->color[rank] != color) continue;
        int at = l.n++;
        for (; at > 0 && x->key[l.rank[at - 1]] > x->key[rank]; at--) l.rank[at] = l.rank[at - 1];
        l.rank[at] = rank;
    }
    return l;
}

static void split_at_random(void *context)
{
    struct list side[2];
    draw_as(*(uint64_t *)context);
    struct random own = stream;
    for (int round = 0; round < 4; round++) {
        stream = own;
        const int first = 1 + below(RANKS - 1);
        struct choices x, y;
        for (int i = 0; i < RANKS; i++) {
            x.color[i] = below(4) == 0 ? MPI_UNDEFINED : below(3) + 5 * (round % 2);
            x.key[i] = below(5) - 2;
            y.color[i] = below(2), y.key[i] = -below(100);
        }
        own = stream;
        MPI_Comm inter = join(side, first), part, again = MPI_COMM_NULL;
        const int me = own_rank(), mine = me >= first;
        MPI_Comm_split(inter, x.color[me], x.key[me], &part);
        struct list near = part_of(&side[mine], &x, x.color[me]),
                    far = part_of(&side[!mine], &x, x.color[me]);
        check_part(part, &near, &far, round);
        /* the part is an intercommunicator like any other: split once more, beside its parent */
        if (part != MPI_COMM_NULL) {
            MPI_Comm_split(part, y.color[me], y.key[me], &again);
            const struct list deep = part_of(&near, &y, y.color[me]),
                              there = part_of(&far, &y, y.color[me]);
            check_part(again, &deep, &there, 100 + round);
            check_part(part, &near, &far, 200 + round);
            if (again != MPI_COMM_NULL) MPI_Comm_free(&again);
            MPI_Comm_free(&part);
        }
        check_part(inter, &side[mine], &side[!mine], 300 + round);
        MPI_Comm_free(&inter);
    }
}

static void splits_go_by_color_and_key_on_both_sides(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 8; seed++) mpi_ok(RANKS, split_at_random, &seed);
}

/* ---- groups ---- */

/* Some ranks of a side in any order. */
static struct list drawn(const struct list *side)
{
    struct list l = {0};
    for (int i = 0; i < side->n; i++) {
        if (below(3) == 0) continue;
        const int at = below(l.n + 1);
        memmove(&l.rank[at + 1], &l.rank[at], sizeof(int) * (size_t)(l.n - at));
        l.rank[at] = side->rank[i];
        l.n++;
    }
    return l;
}

static void create_at_random(void *context)
{
    struct list side[2], part[2];
    draw_as(*(uint64_t *)context);
    struct random own = stream;
    for (int round = 0; round < 4; round++) {
        stream = own;
        const int first = 1 + below(RANKS - 1);
        MPI_Group world, g;
        for (int h = 0; h < 2; h++) {
            side[h].n = 0;
            for (int i = 0; i < RANKS; i++)
                if ((i >= first) == h) side[h].rank[side[h].n++] = i;
            part[h] = drawn(&side[h]);
        }
        own = stream;
        const int mine = own_rank() >= first;
        MPI_Comm inter = join(side, first), made;
        MPI_Comm_group(MPI_COMM_WORLD, &world);
        MPI_Group_incl(world, part[mine].n, part[mine].rank, &g);
        MPI_Comm_create(inter, g, &made);
        check_part(made, &part[mine], &part[!mine], round);
        if (made != MPI_COMM_NULL) MPI_Comm_free(&made);
        MPI_Group_free(&g);
        MPI_Group_free(&world);
        MPI_Comm_free(&inter);
    }
}

static void each_side_gives_its_part_in_any_order(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 8; seed++) mpi_ok(RANKS, create_at_random, &seed);
}

/* Both sides say the same: the one with the smaller first rank of the world comes first. */
static void merge_of_equals(void *context)
{
    struct list side[2];
    (void)context;
    for (int high = 0; high < 2; high++)
        for (int first = 1; first < RANKS; first += 2) {
            MPI_Comm inter = join(side, first), all;
            int rank;
            MPI_Intercomm_merge(inter, high, &all);
            MPI_Comm_rank(all, &rank);
            assert_int_equal(rank, own_rank());
            MPI_Comm_free(&all);
            MPI_Comm_free(&inter);
        }
}

static void of_two_alike_the_first_in_the_world_comes_first(void **state)
{
    (void)state;
    mpi_ok(RANKS, merge_of_equals, NULL);
}

/* ---- blocks of uneven sizes ---- */

/* What element i of rank r is. */
static int element(int r, int i) { return 100 * r + i; }

/* n numbers >= 0 with this sum. */
static void parts_of(int sum, int n, int *count)
{
    for (int i = 0; i < n; i++) count[i] = 0;
    for (int k = 0; k < sum; k++) count[below(n)]++;
}

/* One drawing of sizes: those of a reduction, whose sums are equal on both sides, and from each
 * rank to each. */
struct sizes {
    struct list side[2];
    int first, count[2][RANKS], to[RANKS][RANKS];
    int mine, place; /* of this rank */
    const struct list *near, *far;
};

enum { SUM = 20 };

static MPI_Comm uneven_sides(uint64_t seed, struct sizes *x)
{
    draw_as(seed);
    x->first = 1 + below(RANKS - 1);
    parts_of(SUM, x->first, x->count[0]);
    parts_of(SUM, RANKS - x->first, x->count[1]);
    for (int i = 0; i < RANKS; i++)
        for (int k = 0; k < RANKS; k++) x->to[i][k] = below(4);
    MPI_Comm inter = join(x->side, x->first);
    x->mine = own_rank() >= x->first;
    x->near = &x->side[x->mine], x->far = &x->side[!x->mine];
    x->place = place_in(x->near, own_rank());
    return inter;
}

/* Reduced over the other side, scattered over the own one. */
static void reduce_uneven(void *context)
{
    struct sizes x;
    int out[SUM], in[SUM + 1], begin = 0;
    MPI_Request q;
    MPI_Comm inter = uneven_sides(*(uint64_t *)context, &x);
    const int *count = x.count[x.mine], own = count[x.place];
    for (int i = 0; i < SUM; i++) out[i] = element(own_rank(), i);
    for (int i = 0; i < x.place; i++) begin += count[i];
    for (int way = 0; way < 2; way++) {
        memset(in, -1, sizeof in);
        if (way == 0) MPI_Reduce_scatter(out, in, count, MPI_INT, MPI_SUM, inter);
        else {
            MPI_Ireduce_scatter(out, in, count, MPI_INT, MPI_SUM, inter, &q);
            MPI_Wait(&q, MPI_STATUS_IGNORE);
        }
        for (int i = 0; i < own; i++) {
            int sum = 0;
            for (int k = 0; k < x.far->n; k++) sum += element(x.far->rank[k], begin + i);
            assert_int_equal(in[i], sum);
        }
        assert_int_equal(in[own], -1);
    }
    MPI_Comm_free(&inter);
}

/* From each of the other side its own count, with a gap before each block. */
static void gather_uneven(void *context)
{
    struct sizes x;
    int out[SUM], in[RANKS * MOST], counts[RANKS], places[RANKS], at = 0;
    MPI_Comm inter = uneven_sides(*(uint64_t *)context, &x);
    for (int i = 0; i < SUM; i++) out[i] = element(own_rank(), i);
    for (int k = 0; k < x.far->n; k++) {
        counts[k] = x.count[!x.mine][k] % MOST, places[k] = ++at;
        at += counts[k];
    }
    memset(in, -1, sizeof in);
    MPI_Allgatherv(out, x.count[x.mine][x.place] % MOST, MPI_INT, in, counts, places, MPI_INT,
                   inter);
    for (int k = 0; k < x.far->n; k++) {
        assert_int_equal(in[places[k] - 1], -1);
        for (int i = 0; i < counts[k]; i++)
            assert_int_equal(in[places[k] + i], element(x.far->rank[k], i));
    }
    MPI_Comm_free(&inter);
}

/* To and from each rank another count; blocks of two and more overlap, as sent data may. */
static void exchange_uneven(void *context)
{
    struct sizes x;
    const int me = own_rank();
    int out[SUM], in[RANKS * MOST], counts[RANKS], places[RANKS], sends[RANKS], from[RANKS], at = 0;
    MPI_Comm inter = uneven_sides(*(uint64_t *)context, &x);
    for (int i = 0; i < SUM; i++) out[i] = element(me, i);
    for (int k = 0, given = 0; k < x.far->n; k++) {
        sends[k] = x.to[me][x.far->rank[k]], from[k] = given;
        given += sends[k] < 2;
        counts[k] = x.to[x.far->rank[k]][me], places[k] = at;
        at += counts[k];
    }
    memset(in, -1, sizeof in);
    MPI_Alltoallv(out, sends, from, MPI_INT, in, counts, places, MPI_INT, inter);
    for (int k = 0; k < x.far->n; k++) {
        int given = 0;
        for (int j = 0; j < x.place; j++) given += x.to[x.far->rank[k]][x.near->rank[j]] < 2;
        for (int i = 0; i < counts[k]; i++)
            assert_int_equal(in[places[k] + i], element(x.far->rank[k], given + i));
    }
    assert_int_equal(in[at], -1);
    MPI_Comm_free(&inter);
}

static void uneven_blocks_reach_the_other_side(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        mpi_ok(RANKS, reduce_uneven, &seed);
        mpi_ok(RANKS, gather_uneven, &seed);
        mpi_ok(RANKS, exchange_uneven, &seed);
    }
}

/* Of and to one rank, with counts that differ. */
static void rooted(void *context)
{
    struct list side[2];
    (void)context;
    for (int first = 1; first < RANKS; first += 2)
        for (int root_side = 0; root_side < 2; root_side++) {
            MPI_Comm inter = join(side, first);
            const int me = own_rank(), mine = me >= first, holds = mine == root_side;
            const struct list *near = &side[mine], *far = &side[!mine];
            const int last = side[root_side].n - 1, place = place_in(near, me),
                      root = !holds          ? last
                             : place == last ? MPI_ROOT
                                             : MPI_PROC_NULL;
            int out[MOST], in[RANKS * MOST], counts[RANKS], places[RANKS], at = 0;
            for (int i = 0; i < MOST; i++) out[i] = element(me, i);
            for (int k = 0; k < far->n; k++) {
                counts[k] = (far->rank[k] * 3) % 5, places[k] = at;
                at += counts[k] + 2;
            }
            memset(in, -1, sizeof in);
            MPI_Gatherv(out, (me * 3) % 5, MPI_INT, in, counts, places, MPI_INT, root, inter);
            for (int k = 0; root == MPI_ROOT && k < far->n; k++) {
                for (int i = 0; i < counts[k]; i++)
                    assert_int_equal(in[places[k] + i], element(far->rank[k], i));
                assert_int_equal(in[places[k] + counts[k]], -1);
            }
            if (root != MPI_ROOT) assert_int_equal(in[0], -1);
            int deal[RANKS * MOST];
            for (int i = 0; i < RANKS * MOST; i++) deal[i] = element(me, i);
            memset(in, -1, sizeof in);
            MPI_Scatterv(deal, counts, places, MPI_INT, in, (me * 3) % 5, MPI_INT, root, inter);
            int begins = 0;
            for (int j = 0; j < place; j++) begins += (near->rank[j] * 3) % 5 + 2;
            for (int i = 0; !holds && i < (me * 3) % 5; i++)
                assert_int_equal(in[i], element(side[root_side].rank[last], begins + i));
            assert_int_equal(in[holds ? 0 : (me * 3) % 5], -1);
            MPI_Comm_free(&inter);
        }
}

static void one_rank_gathers_and_deals_uneven_blocks(void **state)
{
    (void)state;
    mpi_ok(RANKS, rooted, NULL);
}

/* ---- what is refused ---- */

static void refused(void *context)
{
    struct list side[2];
    MPI_Comm inter, c = MPI_COMM_NULL;
    int x = 0, y;
    (void)context;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    inter = join(side, 3);
    MPI_Comm_set_errhandler(inter, MPI_ERRORS_RETURN);
    /* an intercommunicator has no order of all its ranks */
    assert_int_equal(MPI_Scan(&x, &y, 1, MPI_INT, MPI_SUM, inter), MPI_ERR_COMM);
    assert_int_equal(MPI_Exscan(&x, &y, 1, MPI_INT, MPI_SUM, inter), MPI_ERR_COMM);
    assert_int_equal(MPI_Cart_create(inter, 1, (int[]){1}, (int[]){0}, 0, &c), MPI_ERR_COMM);
    assert_int_equal(MPI_Intercomm_create(inter, 0, MPI_COMM_WORLD, 0, 1, &c), MPI_ERR_COMM);
    /* a root is a rank of the other side, MPI_ROOT or MPI_PROC_NULL */
    const int far = own_rank() >= 3 ? 3 : RANKS - 3;
    assert_int_equal(MPI_Bcast(&x, 1, MPI_INT, far, inter), MPI_ERR_ROOT);
    assert_int_equal(MPI_Reduce(&x, &y, 1, MPI_INT, MPI_SUM, -77, inter), MPI_ERR_ROOT);
    assert_int_equal(MPI_Send(&x, 1, MPI_INT, far, 0, inter), MPI_ERR_RANK);
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Comm_free(&inter);
}

static void what_two_groups_cannot_do_is_refused(void **state)
{
    (void)state;
    mpi_ok(RANKS, refused, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(splits_go_by_color_and_key_on_both_sides),
        cmocka_unit_test(each_side_gives_its_part_in_any_order),
        cmocka_unit_test(of_two_alike_the_first_in_the_world_comes_first),
        cmocka_unit_test(uneven_blocks_reach_the_other_side),
        cmocka_unit_test(one_rank_gathers_and_deals_uneven_blocks),
        cmocka_unit_test(what_two_groups_cannot_do_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
