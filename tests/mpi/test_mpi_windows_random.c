/* test_mpi_windows_random.c - one-sided operations drawn at random against a copy of all windows
 * that every rank keeps; counters under locks; accesses outside of a window. */
#include "base/random.h"
#include "mpi_world.h"

enum { RANKS = 5, CELLS = 40 };

static void return_errors(void) { MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN); }

/* --- epochs of operations that do not meet --- */

/* What the ranks do in one epoch is drawn alike by all; each does its own part. */
struct drawn {
    int origin, target, at, n, kind; /* n cells from `at` on */
    int value[4];
};

/* Cells of one target belong to one operation of an epoch. */
static int draw_epoch(struct random *r, struct drawn *d)
{
    int n = 0;
    for (int t = 0; t < RANKS; t++)
        for (int at = 0; at < CELLS;) {
            struct drawn *x = &d[n++];
            *x = (struct drawn){.origin = (int)random_below(r, RANKS), .target = t, .at = at};
            x->n = 1 + (int)random_below(r, 4);
            if (x->n > CELLS - at) x->n = CELLS - at;
            x->kind = (int)random_below(r, 7);
            for (int i = 0; i < 4; i++) x->value[i] = (int)random_below(r, 1000) - 500;
            at += x->n;
        }
    return n;
}

/* Start the own operation; `got` is what comes back. */
static void start(const struct drawn *d, MPI_Win w, int *got, MPI_Request *q)
{
    const int n = d->n, t = d->target, at = d->at;
    const MPI_Datatype I = MPI_INT;
    switch (d->kind) {
    case 0:
        MPI_Put(d->value, n, I, t, at, n, I, w);
        break;
    case 1:
        MPI_Get(got, n, I, t, at, n, I, w);
        break;
    case 2:
        MPI_Accumulate(d->value, n, I, t, at, n, I, MPI_SUM, w);
        break;
    case 3:
        MPI_Get_accumulate(d->value, n, I, got, n, I, t, at, n, I, MPI_MAX, w);
        break;
    case 4:
        MPI_Get_accumulate(d->value, n, I, got, n, I, t, at, n, I, MPI_NO_OP, w);
        break;
    case 5:
        MPI_Rput(d->value, n, I, t, at, n, I, w, q);
        break;
    case 6:
        MPI_Rget_accumulate(d->value, n, I, got, n, I, t, at, n, I, MPI_REPLACE, w, q);
        break;
    }
}

/* The same on the copy; returns whether something came back, and that is what was there. */
static void apply(const struct drawn *d, int *cell, const int *got)
{
    static const bool back[] = {false, true, false, true, true, false, true};
    for (int i = 0; i < d->n; i++) {
        if (d->origin == own_rank() && back[d->kind]) assert_int_equal(got[i], cell[i]);
        if (d->kind == 0 || d->kind == 5 || d->kind == 6) cell[i] = d->value[i];
        if (d->kind == 2) cell[i] += d->value[i];
        if (d->kind == 3 && d->value[i] > cell[i]) cell[i] = d->value[i];
    }
}

/* Epochs by fences, by locks of all, or by groups. */
static void open_epoch(int way, MPI_Group all, MPI_Win w)
{
    if (way == 0) MPI_Win_fence(0, w);
    if (way == 1) MPI_Win_lock_all(0, w);
    if (way == 2) MPI_Win_post(all, 0, w), MPI_Win_start(all, 0, w);
}
static void close_epoch(int way, MPI_Win w)
{
    if (way == 0) MPI_Win_fence(0, w);
    if (way == 1) MPI_Win_unlock_all(w), MPI_Barrier(MPI_COMM_WORLD);
    if (way == 2) MPI_Win_complete(w), MPI_Win_wait(w);
}

static void epochs(void *context)
{
    struct random r = random_make(111, 0, 0);
    int *cell, copy[RANKS][CELLS] = {{0}};
    MPI_Group all;
    MPI_Win w;
    (void)context;
    MPI_Comm_group(MPI_COMM_WORLD, &all);
    MPI_Win_allocate(CELLS * sizeof(int), sizeof(int), MPI_INFO_NULL, MPI_COMM_WORLD, &cell, &w);
    for (int epoch = 0; epoch < 60; epoch++) {
        struct drawn d[RANKS * CELLS];
        static int got[RANKS][RANKS * CELLS][4];
        MPI_Request q[RANKS * CELLS];
        const int n = draw_epoch(&r, d), me = own_rank();
        open_epoch(epoch % 3, all, w);
        for (int i = 0; i < n; i++) {
            q[i] = MPI_REQUEST_NULL;
            if (d[i].origin == me) start(&d[i], w, got[me][i], &q[i]);
        }
        MPI_Waitall(n, q, MPI_STATUSES_IGNORE);
        close_epoch(epoch % 3, w);
        for (int i = 0; i < n; i++) apply(&d[i], &copy[d[i].target][d[i].at], got[me][i]);
        assert_memory_equal(cell, copy[me], sizeof copy[me]);
        MPI_Barrier(MPI_COMM_WORLD); /* nobody begins while others still look */
    }
    MPI_Win_free(&w);
    MPI_Group_free(&all);
}

static void windows_are_what_was_done_to_them(void **state)
{
    (void)state;
    mpi_ok(RANKS, epochs, NULL);
}

/* --- operations that meet --- */

/* Every rank takes numbers from a counter: none twice, none missing; the sum is what was added. */
static void counters(void *context)
{
    enum { EACH = 12 };
    int64_t *cell;
    const int64_t one = 1;
    int64_t got[EACH], all[RANKS * EACH];
    bool seen[RANKS * EACH] = {false};
    MPI_Win w;
    (void)context;
    MPI_Win_allocate(16, 8, MPI_INFO_NULL, MPI_COMM_WORLD, &cell, &w);
    for (int k = 0; k < EACH; k++) {
        const int lock = k % 3 ? MPI_LOCK_SHARED : MPI_LOCK_EXCLUSIVE;
        MPI_Win_lock(lock, 0, 0, w);
        if (k % 2) {
            MPI_Fetch_and_op(&one, &got[k], MPI_INT64_T, 0, 0, MPI_SUM, w);
        } else { /* the same by trying until nobody was faster */
            int64_t old, seen_now;
            MPI_Fetch_and_op(NULL, &old, MPI_INT64_T, 0, 0, MPI_NO_OP, w);
            MPI_Win_flush(0, w);
            for (;;) {
                const int64_t next = old + 1;
                MPI_Compare_and_swap(&next, &old, &seen_now, MPI_INT64_T, 0, 0, w);
                MPI_Win_flush(0, w);
                if (seen_now == old) break;
                old = seen_now;
            }
            got[k] = old;
        }
        MPI_Win_unlock(0, w);
    }
    MPI_Allgather(got, EACH, MPI_INT64_T, all, EACH, MPI_INT64_T, MPI_COMM_WORLD);
    for (int i = 0; i < RANKS * EACH; i++) {
        assert_true(all[i] >= 0 && all[i] < RANKS * EACH && !seen[all[i]]);
        seen[all[i]] = true;
    }
    for (int k = 1; k < EACH; k++) assert_true(got[k] > got[k - 1]);
    MPI_Win_free(&w);
}

static void counters_give_each_number_once(void **state)
{
    (void)state;
    mpi_ok(RANKS, counters, NULL);
}

/* --- limits --- */

/* Types without data, with gaps, and backwards: within the window all that is reached counts. */
static void types(void *context)
{
    int *cell, one = 5, back[3] = {7, 8, 9};
    MPI_Datatype none, gaps, down;
    MPI_Win w;
    (void)context;
    MPI_Type_indexed(0, NULL, NULL, MPI_INT, &none);
    MPI_Type_vector(2, 1, 3, MPI_INT, &gaps);
    MPI_Type_create_resized(MPI_INT, 0, -4, &down);
    MPI_Type_commit(&none), MPI_Type_commit(&gaps), MPI_Type_commit(&down);
    MPI_Win_allocate(16, 4, MPI_INFO_NULL, MPI_COMM_WORLD, &cell, &w);
    MPI_Win_fence(0, w);
    MPI_Accumulate(&one, 1, none, 0, 0, 1, none, MPI_SUM, w);
    MPI_Put(&one, 0, MPI_INT, 0, 100, 0, MPI_INT, w); /* nothing, wherever */
    MPI_Put(&one, 1, MPI_INT, MPI_PROC_NULL, 100, 1, MPI_INT, w);
    MPI_Win_fence(0, w);
    MPI_Put(back, 2, MPI_INT, 0, 0, 1, gaps, w); /* cells 0 and 3 */
    MPI_Win_fence(0, w);
    assert_true(own_rank() || (cell[0] == 7 && cell[1] == 0 && cell[2] == 0 && cell[3] == 8));
    MPI_Win_fence(0, w);
    MPI_Put(back, 3, MPI_INT, 0, 2, 3, down, w); /* cells 2, 1, 0 */
    MPI_Win_fence(0, w);
    assert_true(own_rank() || (cell[2] == 7 && cell[1] == 8 && cell[0] == 9 && cell[3] == 8));
    MPI_Win_free(&w);
    MPI_Type_free(&none), MPI_Type_free(&gaps), MPI_Type_free(&down);
}

/* Accumulates on elements with gaps: of a type, and of pairs as C lays them out. */
static void gaps(void *context)
{
    struct pair {
        double v;
        int i;
    } * cell, x[2] = {{2, 9}, {5, 1}}, got[2];
    int *integer, ones[2] = {10, 20};
    MPI_Datatype apart;
    MPI_Win w;
    (void)context;
    MPI_Win_allocate(2 * sizeof *cell, sizeof *cell, MPI_INFO_NULL, MPI_COMM_WORLD, &cell, &w);
    cell[0] = (struct pair){2, 4 + own_rank()}, cell[1] = (struct pair){7, 7};
    MPI_Win_fence(0, w);
    if (own_rank() == 1)
        MPI_Get_accumulate(x, 2, MPI_DOUBLE_INT, got, 2, MPI_DOUBLE_INT, 0, 0, 2, MPI_DOUBLE_INT,
                           MPI_MINLOC, w);
    MPI_Win_fence(0, w);
    if (own_rank() == 1) assert_true(got[0].v == 2 && got[0].i == 4 && got[1].v == 7);
    if (own_rank() == 0) assert_true(cell[0].i == 4 && cell[1].v == 5 && cell[1].i == 1);
    if (own_rank() == 1) assert_true(cell[0].i == 5 && cell[1].v == 7);
    MPI_Win_free(&w);
    /* the integers 1 and 3 of the window */
    MPI_Type_create_indexed_block(2, 1, (int[]){1, 3}, MPI_INT, &apart);
    MPI_Type_commit(&apart);
    MPI_Win_allocate(16, 4, MPI_INFO_NULL, MPI_COMM_WORLD, &integer, &w);
    for (int k = 0; k < 4; k++) integer[k] = k;
    MPI_Win_fence(0, w);
    MPI_Accumulate(ones, 2, MPI_INT, 0, 0, 1, apart, MPI_SUM, w);
    MPI_Win_fence(0, w);
    for (int k = 0; k < 4; k++)
        assert_int_equal(integer[k], k + (own_rank() == 0 ? 2 * (k == 1   ? 10
                                                                 : k == 3 ? 20
                                                                          : 0)
                                                          : 0));
    /* its first byte lies behind where it begins: from -1 on these are the integers 0 and 2 */
    MPI_Win_fence(0, w);
    MPI_Put(ones, 2, MPI_INT, own_rank(), -1, 1, apart, w);
    MPI_Win_fence(0, w);
    assert_true(integer[0] == 10 && integer[2] == 20);
    MPI_Win_free(&w);
    MPI_Type_free(&apart);
}

/* Whoever wants a window alone is not passed by those who could share it. */
static int order[8], norder;
static void queue(void *context)
{
    int *cell;
    MPI_Win w;
    (void)context;
    MPI_Win_allocate(4, 4, MPI_INFO_NULL, MPI_COMM_WORLD, &cell, &w);
    if (own_rank() == 0) norder = 0;
    MPI_Barrier(MPI_COMM_WORLD);
    /* rank 1 shares it for a while; rank 2 asks for it alone, then rank 3 to share it */
    for (int k = 1; k < own_rank(); k++) {
        const double begin = MPI_Wtime();
        while (MPI_Wtime() < begin + 100e-6) {
        }
    }
    if (own_rank() > 0) {
        MPI_Win_lock(own_rank() == 2 ? MPI_LOCK_EXCLUSIVE : MPI_LOCK_SHARED, 0, 0, w);
        order[norder++] = own_rank();
        const double begin = MPI_Wtime();
        while (own_rank() == 1 && MPI_Wtime() < begin + 1e-3) {
        }
        MPI_Win_unlock(0, w);
    }
    MPI_Win_free(&w);
}

struct outside {
    MPI_Aint at;
    int n;
    bool backwards;
};

static void reaches(void *context)
{
    const struct outside *o = context;
    int *cell, data[8] = {0};
    MPI_Datatype down;
    MPI_Win w;
    MPI_Type_create_resized(MPI_INT, 0, -4, &down);
    MPI_Type_commit(&down);
    MPI_Win_allocate(16, 4, MPI_INFO_NULL, MPI_COMM_WORLD, &cell, &w);
    MPI_Win_fence(0, w);
    MPI_Put(data, o->n, MPI_INT, 0, o->at, o->n, o->backwards ? down : MPI_INT, w);
    MPI_Win_fence(0, w);
    MPI_Win_free(&w);
    MPI_Type_free(&down);
}

static void what_lies_outside_of_a_window_is_refused(void **state)
{
    static struct outside good[] = {{0, 4, false}, {3, 1, false}, {3, 4, true}, {0, 1, true}},
                          bad[] = {{0, 5, false}, {4, 1, false}, {-1, 1, false},
                                   {0, 2, true},  {4, 1, true},  {(MPI_Aint)1 << 62, 1, false}};
    (void)state;
    mpi_ok(2, types, NULL);
    mpi_ok(2, gaps, NULL);
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) mpi_ok(1, reaches, &good[k]);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        mpi_fails(1, reaches, &bad[k], "of a window of 16 bytes");
}

static void locks_are_granted_in_the_order_of_asking(void **state)
{
    (void)state;
    mpi_ok(4, queue, NULL);
    assert_int_equal(norder, 3);
    for (int k = 0; k < 3; k++) assert_int_equal(order[k], k + 1);
}

static void refusals(void *context)
{
    int *cell, x = 0;
    MPI_Win w, other;
    MPI_Group g;
    (void)context;
    return_errors();
    assert_int_equal(MPI_Win_create(&x, -4, 4, MPI_INFO_NULL, MPI_COMM_WORLD, &other),
                     MPI_ERR_SIZE);
    assert_int_equal(MPI_Win_create(&x, 4, 0, MPI_INFO_NULL, MPI_COMM_WORLD, &other), MPI_ERR_DISP);
    assert_int_equal(MPI_Win_allocate(-1, 4, MPI_INFO_NULL, MPI_COMM_WORLD, &cell, &other),
                     MPI_ERR_SIZE);
    MPI_Win_allocate(16, 4, MPI_INFO_NULL, MPI_COMM_WORLD, &cell, &w);
    MPI_Win_set_errhandler(w, MPI_ERRORS_RETURN);
    assert_int_equal(MPI_Put(&x, 1, MPI_INT, 2, 0, 1, MPI_INT, w), MPI_ERR_RANK);
    assert_int_equal(MPI_Put(&x, 1, MPI_INT, -7, 0, 1, MPI_INT, w), MPI_ERR_RANK);
    assert_int_equal(MPI_Put(&x, -1, MPI_INT, 0, 0, 1, MPI_INT, w), MPI_ERR_COUNT);
    assert_int_equal(MPI_Put(&x, 1, MPI_INT, 0, 0, -1, MPI_INT, w), MPI_ERR_COUNT);
    assert_int_equal(MPI_Put(&x, 1, MPI_DATATYPE_NULL, 0, 0, 1, MPI_INT, w), MPI_ERR_TYPE);
    assert_int_equal(MPI_Get(&x, 1, MPI_INT, 0, 0, 1, MPI_DATATYPE_NULL, w), MPI_ERR_TYPE);
    assert_int_equal(MPI_Win_unlock(0, w), MPI_ERR_RMA_SYNC);
    assert_int_equal(MPI_Win_unlock_all(w), MPI_ERR_RMA_SYNC);
    assert_int_equal(MPI_Win_complete(w), MPI_ERR_RMA_SYNC);
    assert_int_equal(MPI_Win_wait(w), MPI_ERR_RMA_SYNC);
    assert_int_equal(MPI_Win_test(w, &x), MPI_ERR_RMA_SYNC);
    assert_int_equal(MPI_Win_lock(99, 0, 0, w), MPI_ERR_LOCKTYPE);
    assert_int_equal(MPI_Win_lock(MPI_LOCK_SHARED, 2, 0, w), MPI_ERR_RANK);
    assert_int_equal(MPI_Win_lock(MPI_LOCK_SHARED, MPI_PROC_NULL, 0, w), MPI_SUCCESS);
    assert_int_equal(MPI_Win_lock(MPI_LOCK_SHARED, 0, 0, w), MPI_SUCCESS);
    assert_int_equal(MPI_Win_lock(MPI_LOCK_SHARED, 0, 0, w), MPI_ERR_RMA_SYNC);
    MPI_Win_unlock(0, w);
    MPI_Win_lock_all(0, w);
    assert_int_equal(MPI_Win_lock_all(0, w), MPI_ERR_RMA_SYNC);
    MPI_Win_unlock_all(w);
    assert_int_equal(MPI_Win_shared_query(w, 0, &(MPI_Aint){0}, &x, &cell), MPI_ERR_RMA_FLAVOR);
    MPI_Win_get_group(w, &g);
    MPI_Group_size(g, &x);
    assert_int_equal(x, 2);
    MPI_Group_free(&g);
    MPI_Win_free(&w);
    assert_true(w == MPI_WIN_NULL);
    assert_int_equal(MPI_Win_fence(0, w), MPI_ERR_WIN);
}

static void wrong_epochs_and_arguments_are_refused(void **state)
{
    (void)state;
    mpi_ok(2, refusals, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(windows_are_what_was_done_to_them),
        cmocka_unit_test(counters_give_each_number_once),
        cmocka_unit_test(locks_are_granted_in_the_order_of_asking),
        cmocka_unit_test(what_lies_outside_of_a_window_is_refused),
        cmocka_unit_test(wrong_epochs_and_arguments_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
