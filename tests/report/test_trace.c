/* test_trace.c - timelines that other programs open: nested slices, matched messages, order of
 * time, limits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <sqlite3.h>

#include "../support/made_run.h"
#include "../support/scratch.h"
#include "base/arena.h"
#include "base/text.h"
#include "report/trace.h"

enum { NRANK = 4, NSPAN = NRANK * 7 * 4 };

struct fixture {
    char folder[200];
    struct arena *a;
    struct run_spec spec;
    struct run_result r;
    struct trace_options o;
    struct err e;
    int64_t left_out;
    char *text;
};

static int make_fixture(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    scratch_make(f->folder, sizeof f->folder);
    f->a = arena_create();
    f->spec = made_spec(f->a, "origin2000", NRANK, NRANK, 0);
    f->r = made_result(f->a, &f->spec);
    made_spans(&f->r, f->a);
    f->o.title = "n = P = 4 \"made\"";
    *state = f;
    return 0;
}

static int drop_fixture(void **state)
{
    struct fixture *f = *state;
    free(f->text);
    arena_destroy(f->a);
    scratch_remove(f->folder);
    free(f);
    return 0;
}

static const char *trace(struct fixture *f, enum trace_format format)
{
    size_t size;
    free(f->text);
    FILE *out = open_memstream(&f->text, &size);
    bool ok = trace_write(&f->r, format, &f->o, out, &f->left_out, &f->e);
    fclose(out);
    if (!ok) fail_msg("%s", f->e.text);
    return f->text;
}

/* The integer that `sql` gives, with the events of the Chrome trace as rows of `event`. */
static int64_t ask(struct fixture *f, const char *sql)
{
    sqlite3 *db;
    sqlite3_stmt *q;
    assert_int_equal(sqlite3_open(":memory:", &db), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(db,
                                        "CREATE TABLE event AS SELECT value ->> 'ph' AS ph, value "
                                        "->> 'tid' AS tid, value ->> 'name' AS name, value ->> "
                                        "'cat' AS cat, value ->> 'ts' AS ts, value ->> 'dur' AS "
                                        "dur, value ->> 'id' AS id FROM json_each(json_extract(?1, "
                                        "'$.traceEvents'))",
                                        -1, &q, NULL),
                     SQLITE_OK);
    sqlite3_bind_text(q, 1, f->text, -1, SQLITE_STATIC);
    assert_int_equal(sqlite3_step(q), SQLITE_DONE);
    sqlite3_finalize(q);
    assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &q, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(q), SQLITE_ROW);
    int64_t answer = sqlite3_column_int64(q, 0);
    sqlite3_finalize(q);
    sqlite3_close(db);
    return answer;
}

static void chrome_slices_nest_and_carry_their_times(void **state)
{
    struct fixture *f = *state;
    trace(f, TRACE_CHROME);
    assert_int_equal(ask(f, "SELECT count(*) FROM event WHERE ph = 'X' AND cat = 'stage'"),
                     NRANK * 7);
    assert_int_equal(ask(f, "SELECT count(*) FROM event WHERE ph = 'X' AND cat <> 'stage'"), NSPAN);
    /* every slice lies within one of its stage, none overlaps its neighbour */
    assert_int_equal(ask(f, "SELECT count(*) FROM event x WHERE ph = 'X' AND cat <> 'stage' AND 1 "
                            "<> (SELECT count(*) FROM event y WHERE y.cat = 'stage' AND y.tid = "
                            "x.tid AND y.ts <= x.ts + 1e-9 AND x.ts + x.dur <= y.ts + y.dur + 1e-6 "
                            "AND y.ts + y.dur > x.ts + 1e-9)"),
                     0);
    assert_int_equal(
        ask(f,
            "SELECT count(*) FROM event x JOIN event y ON x.tid = y.tid AND x.cat <> 'stage' AND "
            "y.cat <> 'stage' AND x.ph = 'X' AND y.ph = 'X' AND x.ts < y.ts AND x.ts + x.dur > "
            "y.ts + 1e-6"),
        0);
    assert_int_equal(ask(f, "SELECT round(1e6 * max(ts + dur)) FROM event WHERE ph = 'X'"),
                     f->r.makespan_ps / 7 * 7);
}

static void chrome_flows_are_matched_and_bound_to_slices(void **state)
{
    struct fixture *f = *state;
    trace(f, TRACE_CHROME);
    assert_int_equal(ask(f, "SELECT count(*) FROM event s JOIN event r ON s.ph = 's' AND r.ph = "
                            "'f' AND s.id = r.id AND s.tid <> r.tid AND s.ts <= r.ts"),
                     NRANK * 7);
    assert_int_equal(ask(f, "SELECT count(*) FROM event WHERE ph IN ('s', 'f')"), 2 * NRANK * 7);
    assert_int_equal(ask(f, "SELECT count(DISTINCT id) FROM event WHERE ph = 's'"), NRANK * 7);
    assert_int_equal(ask(f, "SELECT count(*) FROM event s WHERE s.ph = 's' AND NOT EXISTS (SELECT "
                            "1 FROM event x WHERE x.ph = 'X' AND x.name = 'send' AND x.tid = s.tid "
                            "AND x.ts = s.ts)"),
                     0);
    assert_int_equal(ask(f, "SELECT count(*) FROM event WHERE ph = 'M' AND name = 'thread_name'"),
                     NRANK);
}

static void a_limit_leaves_out_the_latest_and_no_flow_is_torn(void **state)
{
    struct fixture *f = *state;
    f->o.max_spans = 50;
    trace(f, TRACE_CHROME);
    assert_int_equal(f->left_out, NSPAN - 50);
    assert_int_equal(ask(f, "SELECT count(*) FROM event WHERE ph = 'X' AND cat <> 'stage'"), 50);
    assert_int_equal(ask(f, "SELECT count(*) FROM event WHERE ph = 's'"),
                     ask(f, "SELECT count(*) FROM event WHERE ph = 'f'"));
    assert_int_equal(ask(f, "SELECT count(*) FROM event s JOIN event r ON s.ph = 's' AND r.ph = "
                            "'f' AND s.id = r.id"),
                     ask(f, "SELECT count(*) FROM event WHERE ph = 's'"));
    int64_t last = ask(f, "SELECT 1e6 * max(ts) FROM event WHERE ph = 'X'");
    assert_true(last < f->r.makespan_ps * 3 / 5);
}

static void window_and_ranks_select(void **state)
{
    struct fixture *f = *state;
    f->o.first_rank = 1;
    f->o.last_rank = 2;
    trace(f, TRACE_CHROME);
    assert_int_equal(ask(f, "SELECT count(DISTINCT tid) * 10 + min(tid) FROM event WHERE ph = 'X'"),
                     21);
    assert_int_equal(ask(f, "SELECT count(*) FROM event WHERE ph = 's'"),
                     0); /* partners 0-1 and 2-3 are torn */
    f->o = (struct trace_options){.begin_ps = f->r.makespan_ps / 7 + 5000,
                                  .end_ps = f->r.makespan_ps / 7 * 2 - 5000};
    trace(f, TRACE_CHROME);
    assert_int_equal(ask(f, "SELECT count(*) FROM event WHERE ph = 'X' AND cat <> 'stage'"),
                     NRANK * 4);
    f->o.begin_ps = f->r.makespan_ps * 2;
    f->o.end_ps = f->r.makespan_ps * 3;
    assert_false(trace_write(&f->r, TRACE_CHROME, &f->o, stderr, &f->left_out, &f->e));
    assert_int_equal(f->e.kind, ERR_CONFIG);
}

static void paje_is_in_order_of_time_and_pj_dump_reads_it(void **state)
{
    struct fixture *f = *state;
    char path[256], command[1000];
    if (system("command -v pj_dump >/dev/null 2>&1") != 0) skip();
    FILE *out = fopen(scratch_path(path, sizeof path, f->folder, "t.paje"), "w");
    assert_true(trace_write(&f->r, TRACE_PAJE, &f->o, out, &f->left_out, &f->e));
    fclose(out);
    snprintf(command, sizeof command, "pj_dump %s >%s/dump 2>%s/errors && [ ! -s %s/errors ]", path,
             f->folder, f->folder, f->folder);
    assert_int_equal(system(command), 0);
    snprintf(command, sizeof command,
             "[ $(grep -c '^Link' %s/dump) = %d ] && [ $(grep -c '^State.*activity' %s/dump) = %d "
             "] && [ $(grep -c '^State.*stage' %s/dump) = %d ] && [ $(grep -c '^Container' "
             "%s/dump) = %d ]",
             f->folder, NRANK * 7, f->folder, NSPAN + NRANK, f->folder, NRANK * 7, f->folder,
             NRANK + 2);
    if (system(command) != 0) {
        snprintf(command, sizeof command, "cut -d, -f1-3 %s/dump | sort | uniq -c >&2", f->folder);
        (void)!system(command);
        fail();
    }
}

static void csv_has_a_row_per_span(void **state)
{
    struct fixture *f = *state;
    const char *csv = trace(f, TRACE_CSV);
    int lines = 0;
    for (const char *c = csv; *c; c++) lines += *c == '\n';
    assert_int_equal(lines, 1 + NSPAN);
    assert_memory_equal(
        csv, "rank,stage,kind,begin_ps,end_ps,peer,bytes,message\r\n0,Pre-processing,compute,0,",
        79);
}

static void text_shows_what_each_rank_does(void **state)
{
    struct fixture *f = *state;
    f->o.columns = 70;
    const char *text = trace(f, TRACE_TEXT);
    /* ten letters a stage: five of computing, one of sending, three of waiting, one of receiving */
    assert_non_null(strstr(text, "AAAAAAAAAABBBBBBBBBB"));
    assert_non_null(strstr(text, "       0  #####>...<#####>...<"));
    assert_non_null(strstr(text, "       3  #####>...<"));
    assert_non_null(strstr(text, "A Pre-processing"));
}

static void a_run_without_spans_says_how_to_record_them(void **state)
{
    struct fixture *f = *state;
    f->r.nspan = 0;
    assert_false(trace_write(&f->r, TRACE_CHROME, &f->o, stderr, &f->left_out, &f->e));
    assert_int_equal(f->e.kind, ERR_NO_INPUT);
    assert_non_null(strstr(f->e.text, "spans: true"));
}

static void a_stored_timeline_comes_back(void **state)
{
    struct fixture *f = *state;
    char path[256];
    struct run_result back;
    struct store *s =
        store_open(scratch_path(path, sizeof path, f->folder, "t.db"), STORE_WRITE, &f->e);
    assert_non_null(s);
    assert_true(store_put(s, &f->spec, NULL, &f->r, &f->e));
    assert_true(trace_read(s, store_run_id(s, &f->spec), f->a, &back, &f->e));
    assert_int_equal(back.nspan, f->r.nspan);
    assert_int_equal(back.nrank, NRANK);
    for (int64_t i = 0; i < back.nspan; i++) {
        const struct span *x = &back.span[i], *y = &f->r.span[i];
        assert_true(x->rank == y->rank && x->stage == y->stage && x->kind == y->kind &&
                    x->begin_ps == y->begin_ps && x->end_ps == y->end_ps && x->peer == y->peer &&
                    x->bytes == y->bytes && x->message == y->message);
    }
    char *direct = strdup(trace(f, TRACE_CHROME));
    f->r = back;
    assert_string_equal(trace(f, TRACE_CHROME), direct);
    free(direct);
    assert_false(trace_read(s, 99, f->a, &back, &f->e));
    assert_int_equal(f->e.kind, ERR_NO_INPUT);
    store_close(s);
}

static void a_full_disk_is_an_error(void **state)
{
    struct fixture *f = *state;
    FILE *out = fopen("/dev/full", "w");
    if (out == NULL) skip();
    assert_false(trace_write(&f->r, TRACE_CHROME, &f->o, out, &f->left_out, &f->e));
    assert_int_equal(f->e.kind, ERR_IO);
    fclose(out);
}

static void formats_have_names(void **state)
{
    (void)state;
    enum trace_format format;
    assert_true(trace_format_find("paje", &format) && format == TRACE_PAJE);
    assert_false(trace_format_find("otf", &format));
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, make_fixture, drop_fixture)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(chrome_slices_nest_and_carry_their_times),
        TEST(chrome_flows_are_matched_and_bound_to_slices),
        TEST(a_limit_leaves_out_the_latest_and_no_flow_is_torn),
        TEST(window_and_ranks_select),
        TEST(paje_is_in_order_of_time_and_pj_dump_reads_it),
        TEST(csv_has_a_row_per_span),
        TEST(text_shows_what_each_rank_does),
        TEST(a_run_without_spans_says_how_to_record_them),
        TEST(a_stored_timeline_comes_back),
        TEST(a_full_disk_is_an_error),
        TEST(formats_have_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
