/* test_mpi_library.c - what programs keep in the library: info objects and attributes against plain
 * lists, error codes and handlers, and what the library says of itself. */
#include "base/random.h"
#include "mpi_world.h"

static void return_errors(void) { MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN); }

/* --- info --- */

enum { KEYS = 25 };

struct entries {
    int n;
    char key[KEYS][8], value[KEYS][40];
};

static int place_of(const struct entries *e, const char *key)
{
    for (int i = 0; i < e->n; i++)
        if (strcmp(e->key[i], key) == 0) return i;
    return -1;
}

static void check_info(MPI_Info info, const struct entries *e)
{
    int n, flag;
    char key[MPI_MAX_INFO_KEY], value[64];
    MPI_Info_get_nkeys(info, &n);
    assert_int_equal(n, e->n);
    for (int i = 0; i < e->n; i++) {
        MPI_Info_get_nthkey(info, i, key);
        assert_string_equal(key, e->key[i]);
        const int length = (int)strlen(e->value[i]);
        MPI_Info_get_valuelen(info, key, &n, &flag);
        assert_true(flag && n == length);
        /* cut to what there is room for, and the byte at the end besides; or with it counted */
        for (int room = 0; room <= length + 1; room++) {
            memset(value, 'z', sizeof value);
            MPI_Info_get(info, key, room, value, &flag);
            assert_true(flag && (int)strlen(value) == (room < length ? room : length));
            assert_memory_equal(value, e->value[i], strlen(value));
            memset(value, 'z', sizeof value);
            n = room;
            MPI_Info_get_string(info, key, &n, value, &flag);
            assert_true(flag && n == length + 1);
            if (room == 0) assert_int_equal(value[0], 'z');
            else assert_int_equal(strlen(value), room <= length ? room - 1 : length);
            assert_int_equal(value[room], 'z');
        }
    }
}

static void infos(void *context)
{
    struct random r = random_make(71, 0, 0);
    struct entries e = {0};
    MPI_Info info, copy;
    int flag, n;
    (void)context;
    return_errors();
    MPI_Info_create(&info);
    for (int round = 0; round < 1200; round++) {
        char key[8], padded[16], value[40];
        snprintf(key, sizeof key, "k%d", (int)random_below(&r, KEYS));
        snprintf(padded, sizeof padded, "%s%s%s", random_below(&r, 2) ? " " : "", key,
                 random_below(&r, 2) ? "\t " : "");
        const int at = place_of(&e, key), length = 1 + (int)random_below(&r, 30);
        for (int i = 0; i < length; i++) value[i] = (char)('a' + random_below(&r, 26));
        value[length] = '\0';
        if (random_below(&r, 3)) {
            assert_int_equal(MPI_Info_set(info, padded, value), MPI_SUCCESS);
            const int to = at >= 0 ? at : e.n++;
            strcpy(e.key[to], key), strcpy(e.value[to], value);
        } else {
            assert_int_equal(MPI_Info_delete(info, padded),
                             at >= 0 ? MPI_SUCCESS : MPI_ERR_INFO_NOKEY);
            if (at < 0) {
                MPI_Info_get_valuelen(info, padded, &n, &flag);
                assert_false(flag);
                MPI_Info_get_string(info, padded, &n, value, &flag);
                assert_false(flag);
                continue;
            }
            memmove(e.key[at], e.key[at + 1], sizeof e.key[0] * (size_t)(e.n - at - 1));
            memmove(e.value[at], e.value[at + 1], sizeof e.value[0] * (size_t)(e.n - at - 1));
            e.n--;
        }
        if (round % 20) continue;
        check_info(info, &e);
        MPI_Info_dup(info, &copy);
        MPI_Info_free(&info);
        check_info(copy, &e);
        info = copy;
    }
    MPI_Info_free(&info);
}

static void info_limits(void *context)
{
    char key[MPI_MAX_INFO_KEY + 2], *value = malloc(MPI_MAX_INFO_VAL + 2), back[8];
    MPI_Info info;
    int flag, n = sizeof back;
    (void)context;
    return_errors();
    MPI_Info_create(&info);
    memset(key, 'k', sizeof key);
    memset(value, 'v', MPI_MAX_INFO_VAL + 2);
    key[MPI_MAX_INFO_KEY - 1] = value[MPI_MAX_INFO_VAL - 1] = '\0';
    assert_int_equal(MPI_Info_set(info, key, value), MPI_SUCCESS);
    MPI_Info_get_valuelen(info, key, &n, &flag);
    assert_true(flag && n == MPI_MAX_INFO_VAL - 1);
    value[MPI_MAX_INFO_VAL - 1] = 'v', value[MPI_MAX_INFO_VAL] = '\0';
    assert_int_equal(MPI_Info_set(info, "k", value), MPI_ERR_INFO_VALUE);
    key[MPI_MAX_INFO_KEY - 1] = 'k', key[MPI_MAX_INFO_KEY] = '\0';
    assert_int_equal(MPI_Info_set(info, key, "v"), MPI_ERR_INFO_KEY);
    assert_int_equal(MPI_Info_set(info, "", "v"), MPI_ERR_INFO_KEY);
    assert_int_equal(MPI_Info_set(info, "  ", "v"), MPI_ERR_INFO_KEY);
    assert_int_equal(MPI_Info_set(info, "k", " \t"), MPI_ERR_INFO_VALUE);
    assert_int_equal(MPI_Info_get_nthkey(info, 1, key), MPI_ERR_ARG);
    assert_int_equal(MPI_Info_get_nthkey(info, -1, key), MPI_ERR_ARG);
    MPI_Info_get_nkeys(info, &n);
    assert_int_equal(n, 1);
    MPI_Info_free(&info);
    assert_true(info == MPI_INFO_NULL);
    assert_int_equal(MPI_Info_free(&info), MPI_ERR_INFO);
    assert_int_equal(MPI_Info_set(info, "k", "v"), MPI_ERR_INFO);
    assert_int_equal(MPI_Info_get_nkeys(info, &n), MPI_ERR_INFO);
    free(value);
}

static void infos_are_lists_of_keys(void **state)
{
    (void)state;
    mpi_ok(1, infos, NULL);
    mpi_ok(1, info_limits, NULL);
}

/* --- attributes --- */

enum { VALUES = 6 };
static int deleted[64], ndeleted, refuse_from; /* deletions from this number on are refused */

static int on_copy(MPI_Comm c, int key, void *extra, void *in, void *out, int *flag)
{
    (void)c, (void)key;
    *(void **)out = (void *)((uintptr_t)in + 100);
    *flag = *(int *)extra;
    return MPI_SUCCESS;
}
static int on_delete(MPI_Comm c, int key, void *value, void *extra)
{
    (void)c, (void)key, (void)extra;
    if (ndeleted >= refuse_from) return MPI_ERR_INTERN;
    deleted[ndeleted++] = (int)(intptr_t)value;
    return MPI_SUCCESS;
}

static void expect_deleted(int n, const int *values)
{
    assert_int_equal(ndeleted, n);
    assert_memory_equal(deleted, values, sizeof(int) * (size_t)n);
    ndeleted = 0;
}

static void attributes(void *context)
{
    static int no, yes = 1;
    int key[VALUES], flag, kept;
    MPI_Comm copy;
    void *v;
    (void)context;
    return_errors();
    ndeleted = 0, refuse_from = 1000;
    for (int k = 0; k < VALUES; k++)
        MPI_Comm_create_keyval(on_copy, on_delete, &key[k], k % 2 ? &yes : &no);
    /* replaced: the old one is deleted */
    for (int k = 0; k < VALUES; k++) MPI_Comm_set_attr(MPI_COMM_WORLD, key[k], (void *)(intptr_t)k);
    MPI_Comm_set_attr(MPI_COMM_WORLD, key[2], (void *)12);
    expect_deleted(1, (int[]){2});
    /* only those whose function says so are copied, each as the function says */
    MPI_Comm_dup(MPI_COMM_WORLD, &copy);
    for (int k = 0; k < VALUES; k++) {
        MPI_Comm_get_attr(copy, key[k], &v, &flag);
        assert_int_equal(flag, k % 2);
        if (flag) assert_int_equal((intptr_t)v, 100 + k);
    }
    /* a refused deletion keeps the communicator */
    refuse_from = 1;
    kept = MPI_Comm_free(&copy);
    assert_int_equal(kept, MPI_ERR_INTERN);
    assert_true(copy != MPI_COMM_NULL);
    assert_int_equal(ndeleted, 1);
    ndeleted = 0, refuse_from = 1000;
    MPI_Comm_get_attr(MPI_COMM_WORLD, key[0], &v, &flag);
    assert_true(flag && v == NULL);
    assert_int_equal(MPI_Comm_free(&copy), MPI_SUCCESS);
    assert_int_equal(ndeleted, 2);
    ndeleted = 0;
    /* a freed keyval serves the values that are there */
    kept = key[4];
    MPI_Comm_free_keyval(&key[4]);
    assert_int_equal(key[4], MPI_KEYVAL_INVALID);
    assert_int_equal(MPI_Comm_delete_attr(MPI_COMM_WORLD, kept), MPI_SUCCESS);
    expect_deleted(1, (int[]){4});
    assert_int_equal(MPI_Comm_get_attr(MPI_COMM_WORLD, kept, &v, &flag), MPI_ERR_KEYVAL);
    /* a refused replacement keeps the old value */
    refuse_from = 0;
    assert_int_equal(MPI_Comm_set_attr(MPI_COMM_WORLD, key[1], (void *)77), MPI_ERR_INTERN);
    MPI_Comm_get_attr(MPI_COMM_WORLD, key[1], &v, &flag);
    assert_int_equal((intptr_t)v, 1);
    refuse_from = 1000;
    /* the values of MPI_COMM_SELF end first of all in MPI_Finalize, the newest first */
    MPI_Comm_set_attr(MPI_COMM_SELF, key[0], (void *)50);
    MPI_Comm_set_attr(MPI_COMM_SELF, key[3], (void *)51);
    MPI_Comm_set_attr(MPI_COMM_SELF, key[1], (void *)52);
}

/* What is not there, and what is the library's. */
static void no_attributes(void *context)
{
    static int no;
    int key, flag;
    void *v;
    MPI_Comm none;
    (void)context;
    return_errors();
    MPI_Comm_set_errhandler(MPI_COMM_SELF, MPI_ERRORS_RETURN);
    MPI_Comm_create_keyval(on_copy, on_delete, &key, NULL);
    /* what is not there */
    assert_int_equal(MPI_Comm_delete_attr(MPI_COMM_SELF, key), MPI_ERR_KEYVAL);
    MPI_Comm_get_attr(MPI_COMM_SELF, key, &v, &flag);
    assert_false(flag);
    assert_int_equal(MPI_Comm_set_attr(MPI_COMM_WORLD, MPI_TAG_UB, &no), MPI_ERR_KEYVAL);
    assert_int_equal(MPI_Comm_delete_attr(MPI_COMM_WORLD, MPI_TAG_UB), MPI_ERR_KEYVAL);
    assert_int_equal(MPI_Comm_set_attr(MPI_COMM_WORLD, 0x1000 + 100000, &no), MPI_ERR_KEYVAL);
    none = MPI_COMM_NULL;
    assert_int_equal(MPI_Comm_set_attr(none, key, &no), MPI_ERR_COMM);
    assert_int_equal(MPI_Comm_get_attr(none, key, &v, &flag), MPI_ERR_COMM);
    MPI_Comm_free_keyval(&key);
}

static int type_copies(MPI_Datatype t, int key, void *extra, void *in, void *out, int *flag)
{
    (void)t, (void)key, (void)extra;
    *(void **)out = in;
    *flag = 1;
    return (intptr_t)in == 13 ? MPI_ERR_INTERN : MPI_SUCCESS;
}
static int type_deletes(MPI_Datatype t, int key, void *value, void *extra)
{
    (void)t, (void)key, (void)extra;
    deleted[ndeleted++] = (int)(intptr_t)value;
    return MPI_SUCCESS;
}

static void of_types_and_windows(void *context)
{
    int key, flag, *unit, *model, n;
    MPI_Aint *size;
    MPI_Datatype t, u;
    MPI_Win w;
    void *v, *base;
    char name[MPI_MAX_OBJECT_NAME];
    (void)context;
    return_errors();
    ndeleted = 0;
    MPI_Type_create_keyval(type_copies, type_deletes, &key, NULL);
    MPI_Type_contiguous(2, MPI_INT, &t);
    MPI_Type_set_attr(t, key, (void *)9);
    MPI_Type_dup(t, &u);
    MPI_Type_free(&t);
    expect_deleted(1, (int[]){9});
    MPI_Type_get_attr(u, key, &v, &flag);
    assert_true(flag && (intptr_t)v == 9);
    MPI_Type_delete_attr(u, key);
    expect_deleted(1, (int[]){9});
    MPI_Type_set_attr(u, key, (void *)13);
    assert_int_equal(MPI_Type_dup(u, &t), MPI_ERR_INTERN);
    assert_true(t == MPI_DATATYPE_NULL);
    MPI_Type_free(&u);
    expect_deleted(1, (int[]){13});
    MPI_Type_free_keyval(&key);
    /* of windows: their own are pointers, but the base */
    MPI_Win_allocate(24, 8, MPI_INFO_NULL, MPI_COMM_WORLD, &base, &w);
    MPI_Win_get_attr(w, MPI_WIN_BASE, &v, &flag);
    assert_true(flag && v == base);
    MPI_Win_get_attr(w, MPI_WIN_SIZE, &size, &flag);
    assert_true(flag && *size == 24);
    MPI_Win_get_attr(w, MPI_WIN_DISP_UNIT, &unit, &flag);
    assert_true(flag && *unit == 8);
    MPI_Win_get_attr(w, MPI_WIN_CREATE_FLAVOR, &model, &flag);
    assert_true(flag && *model == MPI_WIN_FLAVOR_ALLOCATE);
    MPI_Win_get_attr(w, MPI_WIN_MODEL, &model, &flag);
    assert_true(flag && *model == MPI_WIN_UNIFIED);
    MPI_Win_create_keyval(MPI_WIN_DUP_FN, MPI_WIN_NULL_DELETE_FN, &key, NULL);
    v = name;
    MPI_Win_get_attr(w, key, &v, &flag);
    assert_true(!flag && v == name); /* untouched where there is nothing */
    MPI_Win_set_attr(w, key, (void *)3);
    MPI_Win_get_attr(w, key, &v, &flag);
    assert_true(flag && (intptr_t)v == 3);
    MPI_Win_delete_attr(w, key);
    MPI_Win_get_attr(w, key, &v, &flag);
    assert_false(flag);
    MPI_Win_free_keyval(&key);
    MPI_Win_set_name(w, "memory");
    MPI_Win_get_name(w, name, &n);
    assert_string_equal(name, "memory");
    assert_int_equal(n, 6);
    MPI_Win_get_name(MPI_WIN_NULL, name, &n);
    assert_string_equal(name, "MPI_WIN_NULL");
    MPI_Win_free(&w);
}

static void attributes_live_and_end_with_their_objects(void **state)
{
    (void)state;
    mpi_ok(1, attributes, NULL);
    /* by MPI_Finalize: those of MPI_COMM_SELF backwards */
    assert_true(ndeleted >= 3);
    assert_true(deleted[0] == 52 && deleted[1] == 51 && deleted[2] == 50);
    mpi_ok(1, no_attributes, NULL);
    mpi_ok(1, of_types_and_windows, NULL);
}

static void of_the_library(void *context)
{
    int *v, flag, class;
    (void)context;
    MPI_Comm_get_attr(MPI_COMM_WORLD, MPI_UNIVERSE_SIZE, &v, &flag);
    assert_true(flag && *v == all_ranks());
    MPI_Comm_get_attr(MPI_COMM_WORLD, MPI_WTIME_IS_GLOBAL, &v, &flag);
    assert_true(flag && *v == 1);
    MPI_Comm_get_attr(MPI_COMM_WORLD, MPI_APPNUM, &v, &flag);
    assert_true(flag && *v == 0);
    MPI_Comm_get_attr(MPI_COMM_WORLD, MPI_TAG_UB, &v, &flag);
    assert_true(flag);
    const int most = *v;
    int in = 0;
    MPI_Sendrecv(&(int){3}, 1, MPI_INT, 0, most, &in, 1, MPI_INT, 0, most, MPI_COMM_SELF,
                 MPI_STATUS_IGNORE);
    assert_int_equal(in, 3);
    MPI_Comm_get_attr(MPI_COMM_WORLD, MPI_LASTUSEDCODE, &v, &flag);
    assert_true(flag && *v == MPI_ERR_LASTCODE);
    MPI_Add_error_class(&class);
    MPI_Comm_get_attr(MPI_COMM_WORLD, MPI_LASTUSEDCODE, &v, &flag);
    assert_int_equal(*v, class);
}

static void the_library_tells_its_own(void **state)
{
    (void)state;
    mpi_ok(3, of_the_library, NULL);
}

/* --- codes --- */

static void codes(void *context)
{
    char text[MPI_MAX_ERROR_STRING], seen[80][64];
    int n, class;
    (void)context;
    return_errors();
    /* the standard's: each its own class, each with a text of its own */
    for (int k = MPI_SUCCESS; k <= MPI_ERR_ABI; k++) {
        MPI_Error_class(k, &class);
        assert_int_equal(class, k);
        MPI_Error_string(k, text, &n);
        assert_true(n > 0 && n < 64 && (int)strlen(text) == n);
        strcpy(seen[k], text);
        for (int i = 0; i < k; i++) assert_string_not_equal(seen[i], seen[k]);
    }
    for (int k = 0; k < 3; k++) {
        MPI_Error_class((int[]){-1, MPI_ERR_ABI + 1, 1 << 30}[k], &class);
        assert_int_equal(class, MPI_ERR_UNKNOWN);
    }
}

static void added_codes(void *context)
{
    char text[MPI_MAX_ERROR_STRING], *longer = malloc(3 * MPI_MAX_ERROR_STRING);
    int n, class, first, code, other;
    (void)context;
    return_errors();
    MPI_Add_error_class(&first);
    assert_int_equal(first, MPI_ERR_LASTCODE + 1);
    MPI_Error_class(first, &class);
    assert_int_equal(class, first);
    MPI_Error_string(first, text, &n);
    assert_true(n == 0 && text[0] == '\0');
    MPI_Add_error_code(first, &code);
    MPI_Add_error_code(MPI_ERR_RANK, &other);
    MPI_Error_class(code, &class);
    assert_int_equal(class, first);
    MPI_Error_class(other, &class);
    assert_int_equal(class, MPI_ERR_RANK);
    MPI_Add_error_string(code, "one");
    MPI_Add_error_string(code, "two");
    MPI_Error_string(code, text, &n);
    assert_string_equal(text, "two");
    assert_int_equal(n, 3);
    memset(longer, 'x', 3 * MPI_MAX_ERROR_STRING);
    longer[3 * MPI_MAX_ERROR_STRING - 1] = '\0';
    MPI_Add_error_string(code, longer);
    MPI_Error_string(code, text, &n);
    assert_int_equal(n, MPI_MAX_ERROR_STRING - 1);
    assert_int_equal(strlen(text), n);
    MPI_Remove_error_string(code);
    MPI_Error_string(code, text, &n);
    assert_int_equal(n, 0);
    assert_int_equal(MPI_Add_error_string(MPI_ERR_RANK, "x"), MPI_ERR_ARG);
    assert_int_equal(MPI_Remove_error_string(MPI_ERR_RANK), MPI_ERR_ARG);
    assert_int_equal(MPI_Remove_error_code(MPI_ERR_RANK), MPI_ERR_ARG);
    assert_int_equal(MPI_Remove_error_class(12345), MPI_ERR_ARG);
    /* a number is not given twice */
    MPI_Remove_error_code(code);
    assert_int_equal(MPI_Remove_error_code(code), MPI_ERR_ARG);
    MPI_Error_class(code, &class);
    assert_int_equal(class, MPI_ERR_UNKNOWN);
    MPI_Add_error_code(first, &class);
    assert_int_equal(class, other + 1);
    /* as many as there is room for, then no more */
    int added = 4;
    while (MPI_Add_error_code(MPI_ERR_ARG, &code) == MPI_SUCCESS) added++;
    assert_int_equal(added, 256);
    assert_int_equal(MPI_Add_error_class(&code), MPI_ERR_OTHER);
    free(longer);
}

static void codes_have_classes_and_texts(void **state)
{
    (void)state;
    mpi_ok(1, codes, NULL);
    mpi_ok(1, added_codes, NULL);
}

/* --- handlers --- */

static int handled, last_code;
static void *last_object;
static void handler(MPI_Comm *c, int *code, ...) { handled++, last_code = *code, last_object = *c; }
static void win_handler(MPI_Win *w, int *code, ...)
{
    handled += 100, last_code = *code, last_object = *w;
}

static void handlers(void *context)
{
    MPI_Errhandler h, got, w;
    MPI_Comm copy, sub;
    MPI_Win win;
    int x, flag;
    (void)context;
    handled = 0;
    MPI_Comm_get_errhandler(MPI_COMM_WORLD, &got);
    assert_true(got == MPI_ERRORS_ARE_FATAL);
    MPI_Comm_create_errhandler(handler, &h);
    MPI_Comm_dup(MPI_COMM_WORLD, &copy);
    MPI_Comm_set_errhandler(copy, h);
    /* made of it: the same handler; the world has its own */
    MPI_Comm_split(copy, 0, 0, &sub);
    MPI_Comm_get_errhandler(sub, &got);
    assert_true(got == h);
    MPI_Errhandler_free(&got);
    assert_true(got == MPI_ERRHANDLER_NULL);
    MPI_Errhandler_free(&h);
    assert_int_equal(MPI_Send(&x, -1, MPI_INT, 0, 0, sub), MPI_ERR_COUNT);
    assert_true(handled == 1 && last_code == MPI_ERR_COUNT && last_object == (void *)sub);
    assert_int_equal(MPI_Comm_call_errhandler(copy, MPI_ERR_IO), MPI_SUCCESS);
    assert_true(handled == 2 && last_code == MPI_ERR_IO && last_object == (void *)copy);
    MPI_Comm_free(&sub);
    MPI_Comm_set_errhandler(copy, MPI_ERRORS_RETURN);
    assert_int_equal(MPI_Send(&x, -1, MPI_INT, 0, 0, copy), MPI_ERR_COUNT);
    assert_int_equal(handled, 2);
    assert_int_equal(MPI_Comm_call_errhandler(copy, MPI_ERR_IO), MPI_SUCCESS);
    /* a window's own, which does not take over the communicator's */
    MPI_Win_allocate(4, 4, MPI_INFO_NULL, copy, &(void *){NULL}, &win);
    MPI_Win_get_errhandler(win, &got);
    assert_true(got == MPI_ERRORS_ARE_FATAL);
    MPI_Win_create_errhandler(win_handler, &w);
    MPI_Win_set_errhandler(win, w);
    MPI_Errhandler_free(&w);
    MPI_Win_call_errhandler(win, MPI_ERR_BASE);
    assert_true(handled == 102 && last_code == MPI_ERR_BASE && last_object == (void *)win);
    MPI_Win_set_errhandler(win, MPI_ERRORS_RETURN);
    assert_int_equal(MPI_Win_unlock(0, win), MPI_ERR_RMA_SYNC);
    MPI_Win_free(&win);
    MPI_Comm_free(&copy);
    return_errors();
    assert_int_equal(MPI_Comm_create_errhandler(NULL, &h), MPI_ERR_ARG);
    assert_int_equal(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRHANDLER_NULL),
                     MPI_ERR_ERRHANDLER);
    MPI_Initialized(&flag);
    assert_true(flag);
}

static void reported(void *context)
{
    (void)context;
    MPI_Comm_call_errhandler(MPI_COMM_WORLD, MPI_ERR_IO);
}

static void handlers_get_what_went_wrong(void **state)
{
    (void)state;
    mpi_ok(1, handlers, NULL);
    mpi_fails(2, reported, NULL, "the program reports error 35: input or output failed");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(infos_are_lists_of_keys),
        cmocka_unit_test(attributes_live_and_end_with_their_objects),
        cmocka_unit_test(the_library_tells_its_own),
        cmocka_unit_test(codes_have_classes_and_texts),
        cmocka_unit_test(handlers_get_what_went_wrong),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
