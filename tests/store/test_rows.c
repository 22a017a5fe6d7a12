/* test_rows.c - single kinds of rows: times of ranks as one text, runs on real computers, the bytes
 * of a new file. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../support/made_run.h"
#include "database_file.h"
#include "base/random.h"
#include "base/text.h"
#include "store/image.h"
#include "store/publish.h"
#include "store/real_rows.h"
#include "store/run_entries.h"

static bool take_row(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    struct text *t = context;
    (void)name;
    if (t->length > 0) text_add(t, ";");
    for (int i = 0; i < ncolumn; i++)
        text_add(t, "%s%s", i > 0 ? " " : "", value[i] ? value[i] : "NULL");
    return true;
}

static void assert_rows(struct store *s, const char *query, const char *wanted)
{
    struct text t = {0};
    struct err e = {0};
    text_add(&t, "%s", "");
    if (!store_select(s, query, 0, NULL, take_row, &t, &e)) fail_msg("%s: %s", query, e.text);
    assert_string_equal(t.s, wanted);
    text_free(&t);
}

/* ---- times of ranks ---- */

/* Numbers at which the count of digits changes; `any`: with a sign, and the ends of what there
 * is. */
static int64_t odd_number(struct random *r, bool any)
{
    static const int64_t edge[] = {0,  1,  9,   10,  99,        100,      999, 1000000000000,
                                   -1, -9, -10, -99, INT64_MAX, INT64_MIN};
    if (random_below(r, 3) > 0) return edge[random_below(r, any ? 14 : 8)];
    return (int64_t)(random_u64(r) >> (random_below(r, 50) + 8));
}

/* The text by printf. */
static void reference(const struct run_result *r, struct text *t)
{
    bool first = true;
    text_add(t, "[");
    for (int k = 0; k < r->nrank; k++)
        for (int i = 0; i < r->nstage; i++) {
            const struct stage_time *x = &r->stage[k * r->nstage + i];
            if (!(x->compute_ps | x->send_ps | x->recv_ps | x->wait_ps | x->contention_ps |
                  x->messages | x->bytes) &&
                x->work.flop == 0)
                continue;
            text_add(t, "%s[%d,%d,%lld,%lld,%lld,%lld,%lld,%lld,%lld,%lld]", first ? "" : ",", k, i,
                     (long long)x->compute_ps, (long long)x->send_ps, (long long)x->recv_ps,
                     (long long)x->wait_ps, (long long)x->contention_ps, (long long)x->messages,
                     (long long)x->bytes, (long long)x->work.flop);
            first = false;
        }
    text_add(t, "]");
}

static void times_of_ranks_are_written_to_the_digit(void **state)
{
    (void)state;
    struct stage_time stage[5 * 4];
    for (uint64_t seed = 0; seed < 300; seed++) {
        struct random r = random_make(seed, 0, 0);
        struct run_result result = {
            .nrank = (int)random_below(&r, 6), .nstage = (int)random_below(&r, 5), .stage = stage};
        memset(stage, 0, sizeof stage);
        for (int i = 0; i < 20; i++) {
            /* a third of them did nothing */
            if (random_below(&r, 3) == 0) continue;
            stage[i] = (struct stage_time){.compute_ps = odd_number(&r, false),
                                           .send_ps = odd_number(&r, false),
                                           .recv_ps = odd_number(&r, false),
                                           .wait_ps = odd_number(&r, false),
                                           .contention_ps = odd_number(&r, false),
                                           .messages = odd_number(&r, true),
                                           .bytes = odd_number(&r, true)};
            stage[i].work.flop = random_u64(&r) >> 1;
        }
        struct text is = {0}, wanted = {0};
        text_add(&is, "before ");
        text_add(&wanted, "before ");
        rank_entries(&result, &is);
        reference(&result, &wanted);
        assert_string_equal(is.s, wanted.s);
        assert_int_equal(is.length, wanted.length);
        text_free(&is);
        text_free(&wanted);
    }
}

/* ---- loads of links ---- */

/* A number of a router or node, or the word for none. */
static void number_or_null(struct text *t, int x)
{
    if (x < 0) text_add(t, ",null");
    else text_add(t, ",%d", x);
}

static void loads_of_links_are_written_in_their_order(void **state)
{
    (void)state;
    struct link_load link[12];
    for (uint64_t seed = 0; seed < 200; seed++) {
        struct random r = random_make(seed, 0, 0);
        struct run_result result = {.nlink = (int)random_below(&r, 13), .link = link};
        struct text is = {0}, wanted = {0};
        text_add(&is, "before ");
        text_add(&wanted, "before [");
        for (int i = 0; i < result.nlink; i++) {
            struct link_load *x = &link[i];
            *x = (struct link_load){.from = (int)random_below(&r, 4) - 1,
                                    .to = (int)random_below(&r, 4) - 1,
                                    .node = (int)random_below(&r, 2000) - 1000,
                                    .messages = odd_number(&r, true),
                                    .bytes = odd_number(&r, true),
                                    .busy_ps = odd_number(&r, false),
                                    .queue_ps = odd_number(&r, false)};
            if (x->node < 0) x->node = -1;
            text_add(&wanted, "%s[%d", i > 0 ? "," : "", i);
            number_or_null(&wanted, x->from);
            number_or_null(&wanted, x->to);
            number_or_null(&wanted, x->node);
            text_add(&wanted, ",%lld,%lld,%lld,%lld]", (long long)x->messages, (long long)x->bytes,
                     (long long)x->busy_ps, (long long)x->queue_ps);
        }
        text_add(&wanted, "]");
        link_entries(&result, &is);
        assert_string_equal(is.s, wanted.s);
        assert_int_equal(is.length, wanted.length);
        text_free(&is);
        text_free(&wanted);
    }
}

/* ---- runs on real computers ---- */

static const struct real_task task = {"0123abcd", "heat", "mine", 0, "a = 1\nb = 'x'"};

static struct real_result real_made(struct real_sample *sample, int nsample)
{
    struct real_result r = {.status = RUN_INVALID,
                            .text = "wrong by 3",
                            .backend = "mpi",
                            .library = "MPICH",
                            .host = "node7",
                            .processor = "some",
                            .placement = "0,2",
                            .nrank = 4,
                            .processors = 2,
                            .oversubscribed = true,
                            .nsample = nsample,
                            .sample = sample,
                            .time = {1, 2, 3, 4, 5},
                            .load = {0.25, NAN, 1.5},
                            .repeatable = true,
                            .difference = INFINITY,
                            .answer = UINT64_C(0x00ab),
                            .checks = 2,
                            .worst_error = NAN,
                            .worst_tolerance = 1e-9,
                            .messages = 1 << 20,
                            .bytes = 1LL << 40,
                            .nstage = 2};
    r.stage[0] = (struct real_stage){"setup", 0.5, 0.75, 1};
    r.stage[1] = (struct real_stage){"end", 0, 0.125, 0.5};
    return r;
}

static void a_measurement_comes_back_as_it_was(void **state)
{
    struct fixture *f = *state;
    struct store *s = store_open(f->path, STORE_WRITE, &f->e);
    struct real_sample sample[3] = {{1, false}, {3, true}, {5, false}};
    struct real_result r = real_made(sample, 3);
    /* measured twice: two rows, although all of it is equal */
    for (int i = 0; i < 2; i++)
        if (!store_put_real(s, &task, &r, &f->e)) fail_msg("%s", f->e.text);
    assert_rows(s, "SELECT count(*), count(DISTINCT real_id) FROM real_run", "2 2");
    assert_rows(s,
                "SELECT DISTINCT task_hash, scenario, program, n, settings, backend, mpi, host, "
                "processor, placement, P, processors, oversubscribed, status, text FROM real_run",
                "0123abcd heat mine 0 a = 1\nb = 'x' mpi MPICH node7 some 0,2 4 2 1 invalid wrong "
                "by 3");
    assert_rows(s,
                "SELECT DISTINCT samples, min_s, lower_s, median_s, upper_s, max_s, load_others, "
                "load_before, load_after FROM real_run",
                "3 1.0 2.0 3.0 4.0 5.0 0.25 NULL 1.5");
    assert_rows(s,
                "SELECT DISTINCT same_bits, repeatable, difference, answer, checks, worst_error, "
                "worst_tolerance, messages, sent_bytes FROM real_run",
                "0 1 NULL 00000000000000ab 2 NULL 1.0e-09 1048576 1099511627776");
    assert_rows(s,
                "SELECT stage, name, min_s, median_s, largest_s, count(*) FROM real_stage GROUP BY "
                "stage",
                "0 setup 0.5 0.75 1.0 2;1 end 0.0 0.125 0.5 2");
    assert_rows(s, "SELECT sample, seconds, disturbed, count(*) FROM real_sample GROUP BY sample",
                "0 1.0 0 2;1 3.0 1 2;2 5.0 0 2");
    assert_rows(s, "SELECT count(*) FROM real_run r JOIN build b ON b.id = r.build_id", "2");
    store_close(s);
}

static void without_samples_there_are_no_times(void **state)
{
    struct fixture *f = *state;
    struct store *s = store_open(f->path, STORE_WRITE, &f->e);
    struct real_result r = real_made(NULL, 0);
    r.nstage = 0;
    if (!store_put_real(s, &task, &r, &f->e)) fail_msg("%s", f->e.text);
    assert_rows(s, "SELECT samples, min_s, lower_s, median_s, upper_s, max_s FROM real_run",
                "0 NULL NULL NULL NULL NULL");
    assert_rows(s, "SELECT (SELECT count(*) FROM real_stage) + (SELECT count(*) FROM real_sample)",
                "0");
    store_close(s);
}

/* The last sample is no number: nothing of the run is stored, and the next one is. */
static void a_measurement_is_stored_whole_or_not_at_all(void **state)
{
    struct fixture *f = *state;
    struct store *s = store_open(f->path, STORE_WRITE, &f->e);
    struct real_sample sample[2] = {{1, false}, {NAN, false}};
    struct real_result r = real_made(sample, 2);
    assert_false(store_put_real(s, &task, &r, &f->e));
    assert_int_equal(f->e.kind, ERR_DATA);
    err_clear(&f->e);
    assert_rows(s,
                "SELECT (SELECT count(*) FROM real_run) + (SELECT count(*) FROM real_stage) + "
                "(SELECT count(*) FROM real_sample)",
                "0");
    sample[1].seconds = 2;
    if (!store_put_real(s, &task, &r, &f->e)) fail_msg("%s", f->e.text);
    assert_rows(s, "SELECT count(*) FROM real_run r JOIN build b ON b.id = r.build_id", "1");
    store_close(s);
}

/* ---- what programs say ---- */

/* Lines keep their blanks; of very many the beginning is kept. */
static void lines_of_programs_are_rows(void **state)
{
    struct fixture *f = *state;
    struct arena *a = arena_create();
    struct store *s = store_open(f->path, STORE_WRITE, &f->e);
    const struct run_spec spec = made_spec(a, "t3e-300", 4, 4, 0);
    struct run_result r = made_result(a, &spec);
    char said[] = "0 1   indented\n12 2 7 8 9\n3 1 \n3 1 last, without its end";
    r.said = said, r.nsaid = sizeof said;
    if (!store_put(s, &spec, NULL, &r, &f->e)) fail_msg("%s", f->e.text);
    assert_rows(s, "SELECT rank, stream, quote(text) FROM program_line ORDER BY line",
                "0 1 '  indented';12 2 '7 8 9';3 1 '';3 1 'last, without its end'");
    struct text many = {0};
    for (int i = 0; i < 1001; i++) text_add(&many, "%d 1 line %d\n", i % 4, i);
    r.said = many.s, r.nsaid = (int64_t)many.length + 1;
    if (!store_put(s, &spec, NULL, &r, &f->e)) fail_msg("%s", f->e.text);
    assert_rows(s,
                "SELECT count(*), max(text = 'line 999'), max(text = 'line 1000') FROM "
                "program_line",
                "1000 1 0");
    text_free(&many);
    store_close(s);
    arena_destroy(a);
}

/* Of more links than there is room for, those with the longest queues; among equal ones the
 * busiest, then the first. */
static void the_links_that_limit_a_run_are_kept(void **state)
{
    enum { MANY = 16384 + 3 };
    struct fixture *f = *state;
    struct arena *a = arena_create();
    struct store *s = store_open("passing", STORE_SCRATCH, &f->e);
    const struct run_spec spec = made_spec(a, "t3e-300", 4, 4, 0);
    struct run_result r = made_result(a, &spec);
    r.nlink = MANY;
    r.link = TAKE(a, MANY, struct link_load);
    for (int i = 0; i < MANY; i++)
        r.link[i] = (struct link_load){i, i + 1, -1, 1, 1, .busy_ps = 50, .queue_ps = 10};
    r.link[1].queue_ps = 9; /* goes: the shortest queue, however busy */
    r.link[1].busy_ps = 1000;
    r.link[2].busy_ps = 49;         /* goes: the least busy of the others */
    r.link[MANY - 1].queue_ps = 11; /* stays */
    /* and of those that are alike the last one goes */
    if (!store_put(s, &spec, NULL, &r, &f->e)) fail_msg("%s", f->e.text);
    assert_rows(s,
                "SELECT count(*), max(link = 0), max(link = 1), max(link = 2), max(link = 16384), "
                "max(link = 16385), max(link = 16386) FROM link_load",
                "16384 1 0 0 1 0 1");
    store_close(s);
    arena_destroy(a);
}

/* ---- files ---- */

static void the_folder_of_a_path(void **state)
{
    (void)state;
    static const char *const row[][2] = {{"a.db", "./"},       {"x/a.db", "x/"}, {"/a.db", "/"},
                                         {"/x//a.db", "/x//"}, {"x/", "x/"},     {"", "./"}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char *folder = publish_folder(row[i][0]);
        assert_string_equal(folder, row[i][1]);
        free(folder);
    }
}

/* A file is linked when it is whole; where another one is, that one stays. */
static void a_file_takes_its_place_once(void **state)
{
    struct fixture *f = *state;
    struct published first = {.file = -1}, second = {.file = -1};
    if (!publish_place(f->path, NULL, 0, false, &first, &f->e)) fail_msg("%s", f->e.text);
    assert_false(first.late);
    struct stat info, again;
    assert_int_equal(stat(f->path, &info), 0);
    assert_int_equal(access(first.name, F_OK), 0);
    if (!publish_place(f->path, NULL, 0, false, &second, &f->e)) fail_msg("%s", f->e.text);
    assert_true(second.late);
    assert_string_not_equal(first.name, second.name);
    assert_int_equal(stat(f->path, &again), 0);
    assert_int_equal(again.st_ino, info.st_ino);
    char beside[300];
    snprintf(beside, sizeof beside, "%s", first.name);
    publish_drop(&first);
    assert_int_equal(access(beside, F_OK), -1);
    snprintf(beside, sizeof beside, "%s", second.name);
    publish_drop(&second);
    assert_int_equal(access(beside, F_OK), -1);
    assert_int_equal(access(f->path, F_OK), 0);
    /* in a folder that is not there, none */
    struct published none = {.file = -1};
    assert_false(publish_place("/no-such-folder-at-all/x.db", NULL, 0, false, &none, &f->e));
    assert_int_equal(f->e.kind, ERR_CREATE);
    publish_drop(&none);
}

static bool is_there(const char *path, const char *suffix)
{
    char name[300];
    snprintf(name, sizeof name, "%s%s", path, suffix);
    return access(name, F_OK) == 0;
}

/* Logs of a database that is gone would be read as those of the new one; with a database at the
 * place they are that one's and stay. */
static void logs_without_their_database_are_removed(void **state)
{
    static const char *const suffix[] = {"-wal", "-shm", "-journal", "-other"};
    struct fixture *f = *state;
    for (int there = 0; there < 2; there++) {
        for (int i = 0; i < 4; i++) {
            char name[300];
            snprintf(name, sizeof name, "%s%s", f->path, suffix[i]);
            fclose(fopen(name, "w"));
        }
        struct published b = {.file = -1};
        if (!publish_place(f->path, NULL, 0, false, &b, &f->e)) fail_msg("%s", f->e.text);
        publish_drop(&b);
        for (int i = 0; i < 4; i++) assert_int_equal(is_there(f->path, suffix[i]), there || i == 3);
    }
}

/* A folder of this computer is not one of several hosts, and neither is one that is not there. */
static void the_own_disk_is_no_network(void **state)
{
    struct fixture *f = *state;
    assert_false(publish_network(f->folder));
    assert_false(publish_network("/proc"));
    assert_false(publish_network("/no-such-folder-at-all"));
}

/* The bytes tell how the file is to be used (1.3.3 of SQLite's file format), and are a database of
 * this program with either. */
static void the_bytes_say_which_journal(void **state)
{
    struct fixture *f = *state;
    for (int wal = 0; wal < 2; wal++) {
        unlink(f->path);
        FILE *file = fopen(f->path, "w+");
        assert_true(image_write(fileno(file), wal));
        unsigned char head[100];
        rewind(file);
        assert_int_equal(fread(head, 1, sizeof head, file), sizeof head);
        fclose(file);
        assert_memory_equal(head, "SQLite format 3", 16);
        assert_int_equal(head[18], wal ? 2 : 1);
        assert_int_equal(head[19], wal ? 2 : 1);
        struct store *s = store_open(f->path, STORE_READ, &f->e);
        if (s == NULL) fail_msg("%s", f->e.text);
        assert_rows(s, "SELECT count(*) FROM run", "0");
        store_close(s);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(times_of_ranks_are_written_to_the_digit),
        TEST(loads_of_links_are_written_in_their_order),
        TEST(a_measurement_comes_back_as_it_was),
        TEST(without_samples_there_are_no_times),
        TEST(a_measurement_is_stored_whole_or_not_at_all),
        TEST(lines_of_programs_are_rows),
        TEST(the_links_that_limit_a_run_are_kept),
        TEST(the_folder_of_a_path),
        TEST(a_file_takes_its_place_once),
        TEST(logs_without_their_database_are_removed),
        TEST(the_own_disk_is_no_network),
        TEST(the_bytes_say_which_journal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
