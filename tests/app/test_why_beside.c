/* test_why_beside.c - slack, links and roofs in words, as JSON and as rows: of a run made by hand,
 * where every number is known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "../support/made_run.h"
#include "app/why_beside.h"
#include "base/random.h"
#include "base/text.h"

enum { RANKS = 4, STAGES = 3 };
#define NEVER INT64_MAX

/* What `print` writes. */
static char *printed(void (*print)(const struct why *w, FILE *out), const struct why *w)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    print(w, out);
    fclose(out);
    char *kept = arena_text(arena, text);
    free(text);
    return kept;
}

/* Four ranks in three stages: 0 is critical, 3 does nothing that the end follows from. */
static struct why made_why(void)
{
    static const int64_t slack[RANKS * STAGES] = {0,     5000,  NEVER, /* rank 0 */
                                                  7000,  2000,  NEVER, /* 1 */
                                                  9000,  NEVER, 4000,  /* 2 */
                                                  NEVER, NEVER, NEVER};
    static const struct slack_row row[] = {{PATH_COMPUTE, 1, 12, 8000000, 2000000, 6000000, 250},
                                           {PATH_SEND, 0, 3, 1000000, 1000000, 1000000, NEVER}};
    static const struct link_load link[] = {
        {3, 7, -1, 1, 8, 1, 0}, {-1, 2, 5, 1, 8, 1, 0}, {2, -1, 6, 1, 8, 1, 0}};
    static const struct roofline_row roof[] = {{.stage = -1,
                                                .flops = 4e6,
                                                .sent_bytes = 1e3,
                                                .messages = 7,
                                                .intensity = 4e3,
                                                .attained = 20e6,
                                                .computing = 80e6,
                                                .bandwidth = 160e6,
                                                .software = 40e6,
                                                .lowest = ROOF_SOFTWARE},
                                               {.stage = 1,
                                                .flops = 1e6,
                                                .intensity = INFINITY,
                                                .attained = 30e6,
                                                .computing = 60e6,
                                                .bandwidth = INFINITY,
                                                .software = INFINITY,
                                                .lowest = ROOF_COMPUTING}};
    struct why w = {.nresource = 3, .resource = {{1, 500000}, {0, 250000}, {2, 0}}, .nroof = 2};
    struct run_result *r = &w.run;
    r->makespan_ps = 1000000, r->nrank = RANKS, r->nstage = STAGES;
    for (int i = 0; i < STAGES; i++) snprintf(r->stage_name[i], 24, "stage %d", i);
    r->rank_slack = TAKE(arena, RANKS * STAGES, int64_t);
    memcpy(r->rank_slack, slack, sizeof slack);
    r->nslack = 2, r->slack = TAKE(arena, 2, struct slack_row);
    memcpy(r->slack, row, sizeof row);
    r->nlink = 3, r->link = TAKE(arena, 3, struct link_load);
    memcpy(r->link, link, sizeof link);
    w.roof = TAKE(arena, 2, struct roofline_row);
    memcpy(w.roof, roof, sizeof roof);
    return w;
}

static void durations_have_the_unit_that_reads_well(void **state)
{
    static const struct {
        double ps;
        const char *text;
    } row[] = {{0, "0 ps"},      {1, "1 ps"},
               {999, "999 ps"},  {1000, "1 ns"},
               {1500, "1.5 ns"}, {999999, "1000 ns"},
               {1e6, "1 us"},    {-2.5e6, "-2.5 us"},
               {1e9, "1 ms"},    {123456789, "123.5 us"},
               {1e12, "1 s"},    {3.6e15, "3600 s"},
               {-1, "-1 ps"},    {-1000, "-1 ns"},
               {0.5, "0.5 ps"},  {999.4e9, "999.4 ms"}};
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char buffer[32];
        assert_ptr_equal(why_duration(row[i].ps, buffer, sizeof buffer), buffer);
        assert_string_equal(buffer, row[i].text);
    }
    char small[4]; /* cut, and ended */
    why_duration(123456789, small, sizeof small);
    assert_string_equal(small, "123");
}

static void the_sentence_tells_how_near_the_others_are(void **state)
{
    (void)state;
    struct why w = made_why();
    assert_string_equal(printed(why_slack_sentence, &w),
                        "Beside it 2 ranks have slack: 2 ns at least, 4 ns in the median, 4 ns at "
                        "most.\n");
    w.run.rank_slack[2 * STAGES + 2] = 0; /* rank 2 is critical, too */
    assert_string_equal(printed(why_slack_sentence, &w),
                        "Beside it 1 rank has slack: 2 ns at least, 2 ns in the median, 2 ns at "
                        "most.\n");
    w.run.rank_slack[1 * STAGES] = 0;
    assert_string_equal(
        printed(why_slack_sentence, &w),
        "Every rank is on a critical path: a delay of any of them is one of the run.\n");
    w.run.rank_slack = NULL;
    assert_string_equal(printed(why_slack_sentence, &w), "");
}

/* Of any numbers: least, middle and largest of what is neither critical nor idle. */
static void the_sentence_is_that_of_a_sorted_list(void **state)
{
    (void)state;
    struct random r = random_make(4, 4, 4);
    struct why w = made_why();
    for (int round = 0; round < 200; round++) {
        int64_t worst[RANKS];
        int n = 0;
        for (int i = 0; i < RANKS; i++) {
            int64_t least = NEVER;
            for (int k = 0; k < STAGES; k++) {
                int64_t *x = &w.run.rank_slack[i * STAGES + k];
                *x = random_below(&r, 3) ? (int64_t)random_below(&r, 6) * 1000 : NEVER;
                if (*x < least) least = *x;
            }
            if (least == 0 || least == NEVER) continue;
            int at = n++;
            for (; at > 0 && worst[at - 1] > least; at--) worst[at] = worst[at - 1];
            worst[at] = least;
        }
        char expected[200] = "Every rank";
        if (n > 0)
            snprintf(expected, sizeof expected,
                     "Beside it %d %s slack: %d ns at least, %d ns in the median, %d ns at most.\n",
                     n, n == 1 ? "rank has" : "ranks have", (int)(worst[0] / 1000),
                     (int)(worst[n / 2] / 1000), (int)(worst[n - 1] / 1000));
        const char *said = printed(why_slack_sentence, &w);
        if (strncmp(said, expected, strlen(expected)) != 0) fail_msg("%s, not %s", said, expected);
    }
}

/* Words of a line, blanks between them as one. */
static const char *line_of(const char *text, const char *word)
{
    const char *at = strstr(text, word);
    if (at == NULL) return "";
    while (at > text && at[-1] != '\n') at--;
    struct text t = {0};
    text_add(&t, "%s", "");
    for (; *at != '\0' && *at != '\n'; at++)
        if (*at != ' ' || (t.length > 0 && t.s[t.length - 1] != ' ')) text_add(&t, "%c", *at);
    const char *line = arena_text(arena, t.s);
    text_free(&t);
    return line;
}

static void tables_show_what_is_there(void **state)
{
    (void)state;
    struct why w = made_why();
    const char *text = printed(why_beside_print, &w);
    static const char *const line[][2] = {
        {"link 3 -> 7", "link 3 -> 7 250 ns 25.0 %"},
        {"injection port", "injection port of node 5 500 ns 50.0 %"},
        {"ejection port", "ejection port of node 6 0 ps 0.0 %"},
        /* ranks that are active in the stage; those with slack */
        {"stage 0", "stage 0 3 1 7 ns 9 ns 9 ns"},
        {"stage 2", "stage 2 1 0 4 ns 4 ns 4 ns"},
        {"send overhead", "stage 0 send overhead 1 us 100.0 % 100.0 % -"},
        {"whole run", "whole run 4000 20 80 160 40 message software (50 % of it)"},
    };
    for (size_t i = 0; i < sizeof line / sizeof *line; i++)
        assert_string_equal(line_of(text, line[i][0]), line[i][1]);
    /* the second stage in three tables, in their order */
    const char *ranks = strstr(text, "stage 1");
    assert_string_equal(line_of(ranks, "stage 1"), "stage 1 2 0 2 ns 5 ns 5 ns");
    const char *causes = strstr(ranks + 1, "stage 1");
    assert_string_equal(line_of(causes, "stage 1"), "stage 1 computing 8 us 25.0 % 75.0 % 250 ps");
    const char *roofs = strstr(causes + 1, "stage 1");
    assert_string_equal(line_of(roofs, "stage 1"), "stage 1 - 30 60 - - computing (50 % of it)");
    w.roof[1].stage = 0;
    const char *first = strstr(strstr(printed(why_beside_print, &w), "roofline"), "stage 0");
    assert_string_equal(line_of(first, "stage 0"), "stage 0 - 30 60 - - computing (50 % of it)");
    /* nobody is active in a stage: no line of it; nothing is recorded: no table of it */
    w.run.rank_slack[2 * STAGES + 2] = NEVER;
    assert_null(strstr(printed(why_beside_print, &w), "stage 2"));
    w.run.rank_slack = NULL, w.nresource = 0, w.nroof = 0;
    assert_string_equal(printed(why_beside_print, &w), "");
}

static void print_json(const struct why *w, FILE *out)
{
    struct json j = json_make(out);
    json_object(&j);
    why_beside_json(w, &j);
    json_end(&j);
    json_finish(&j);
}

/* JSON is a table for the database: its functions read it. */
static struct store *database;

static bool take_text(void *context, int n, const char *const *name, const char *const *value)
{
    (void)n, (void)name;
    text_add(context, "%s ", value[0] ? value[0] : "null");
    return true;
}

static const char *answer(const char *sql, const char *param)
{
    struct text t = {0};
    struct err e;
    err_clear(&e);
    text_add(&t, "%s", "");
    if (!store_select(database, sql, param != NULL, &param, take_text, &t, &e))
        fail_msg("%s", e.text);
    const char *kept = arena_text(arena, t.s);
    text_free(&t);
    return kept;
}

static void json_has_all_rows(void **state)
{
    (void)state;
    struct why w = made_why();
    const char *text = printed(print_json, &w);
    static const char *const row[][2] = {
        {"SELECT value FROM json_each(?1, '$.rank_slack_ps')", "0 2000 4000 null "},
        {"SELECT value ->> 'stage' FROM json_each(?1, '$.slack')", "stage 1 stage 0 "},
        {"SELECT value ->> 'cause' FROM json_each(?1, '$.slack')", "computing send overhead "},
        {"SELECT value ->> 'steps' FROM json_each(?1, '$.slack')", "12 3 "},
        {"SELECT value ->> 'time_ps' FROM json_each(?1, '$.slack')", "8000000 1000000 "},
        {"SELECT value ->> 'critical_ps' FROM json_each(?1, '$.slack')", "2000000 1000000 "},
        {"SELECT value ->> 'near_ps' FROM json_each(?1, '$.slack')", "6000000 1000000 "},
        {"SELECT value ->> 'least_ps' FROM json_each(?1, '$.slack')", "250 null "},
        {"SELECT value ->> 'resource' FROM json_each(?1, '$.resources')",
         "injection port of node 5 link 3 -> 7 ejection port of node 6 "},
        {"SELECT value ->> 'time_ps' FROM json_each(?1, '$.resources')", "500000 250000 0 "},
        {"SELECT value ->> 'stage' FROM json_each(?1, '$.roofline')", "whole run stage 1 "},
        {"SELECT CAST(value ->> 'flops_per_byte' AS INTEGER) FROM json_each(?1, '$.roofline')",
         "4000 null "},
        {"SELECT CAST(value ->> 'attained_flop_per_s' AS INTEGER) FROM json_each(?1, "
         "'$.roofline')",
         "20000000 30000000 "},
        {"SELECT CAST(value ->> 'computing_flop_per_s' AS INTEGER) FROM json_each(?1, "
         "'$.roofline')",
         "80000000 60000000 "},
        {"SELECT CAST(value ->> 'bandwidth_flop_per_s' AS INTEGER) FROM json_each(?1, "
         "'$.roofline')",
         "160000000 null "},
        {"SELECT CAST(value ->> 'software_flop_per_s' AS INTEGER) FROM json_each(?1, "
         "'$.roofline')",
         "40000000 null "},
        {"SELECT value ->> 'lowest_roof' FROM json_each(?1, '$.roofline')",
         "message software computing "},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const char *said = answer(row[i][0], text);
        if (strcmp(said, row[i][1]) != 0) fail_msg("%s: %s", row[i][0], said);
    }
    w.run.rank_slack = NULL, w.run.nslack = w.nresource = w.nroof = 0;
    assert_string_equal(answer("SELECT json_array_length(?1, '$.rank_slack_ps') + "
                               "json_array_length(?1, '$.slack') + "
                               "json_array_length(?1, '$.resources') + "
                               "json_array_length(?1, '$.roofline')",
                               printed(print_json, &w)),
                        "0 ");
}

/* Rows of one run take the place of its older ones, and leave those of others. */
static void rows_replace_older_ones(void **state)
{
    (void)state;
    struct why w = made_why();
    struct err e;
    err_clear(&e);
    int64_t id[2];
    for (int i = 0; i < 2; i++) {
        const struct run_spec spec = made_spec(arena, "t3e-300", 16, 4, i);
        const struct run_result r = made_result(arena, &spec);
        if (!store_put(database, &spec, NULL, &r, &e)) fail_msg("%s", e.text);
        id[i] = store_run_id(database, &spec);
        if (!why_beside_put(database, id[i], &w, &e)) fail_msg("%s", e.text);
    }
    for (int pass = 0; pass < 2; pass++) {
        assert_string_equal(answer("SELECT count(*) FROM slack", NULL), "4 ");
        assert_string_equal(answer("SELECT count(*) FROM rank_slack", NULL), "6 ");
        assert_string_equal(answer("SELECT count(*) FROM path_resource", NULL), "6 ");
        assert_string_equal(answer("SELECT count(*) FROM roofline", NULL), "4 ");
        assert_true(why_beside_put(database, id[1], &w, &e)); /* again: the same rows */
    }
    /* the stage in which a rank has least, and how much */
    assert_string_equal(answer("SELECT rank || ':' || stage || ':' || slack_ps FROM rank_slack "
                               "WHERE run_id = (SELECT min(run_id) FROM rank_slack) ORDER BY rank",
                               NULL),
                        "0:stage 0:0 1:stage 1:2000 2:stage 2:4000 ");
    assert_string_equal(answer("SELECT least_ps FROM slack WHERE run_id = (SELECT min(run_id) FROM "
                               "slack) ORDER BY time_ps DESC",
                               NULL),
                        "250 null ");
    assert_string_equal(answer("SELECT link || '=' || name FROM path_resource WHERE run_id = "
                               "(SELECT min(run_id) FROM slack) ORDER BY link",
                               NULL),
                        "0=link 3 -> 7 1=injection port of node 5 2=ejection port of node 6 ");
    assert_string_equal(answer("SELECT stage || (bandwidth IS NULL) || (software IS NULL) FROM "
                               "roofline GROUP BY ordinal ORDER BY ordinal",
                               NULL),
                        "whole run00 stage 111 ");
    /* fewer rows than before: the others go */
    w.run.nslack = 1, w.nresource = 0, w.run.rank_slack = NULL, w.nroof = 1;
    assert_true(why_beside_put(database, id[1], &w, &e));
    assert_string_equal(answer("SELECT count(*) FROM slack", NULL), "3 ");
    assert_string_equal(answer("SELECT count(*) FROM rank_slack", NULL), "3 ");
    assert_string_equal(answer("SELECT count(*) FROM path_resource", NULL), "3 ");
    assert_string_equal(answer("SELECT count(*) FROM roofline", NULL), "3 ");
}

static int open_database(void **state)
{
    struct err e;
    err_clear(&e);
    make_arena(state);
    database = store_open("why", STORE_SCRATCH, &e);
    return database == NULL;
}

static int close_database(void **state)
{
    store_close(database);
    return drop_arena(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(durations_have_the_unit_that_reads_well),
        cmocka_unit_test(the_sentence_tells_how_near_the_others_are),
        cmocka_unit_test(the_sentence_is_that_of_a_sorted_list),
        cmocka_unit_test(tables_show_what_is_there),
        cmocka_unit_test(json_has_all_rows),
        cmocka_unit_test(rows_replace_older_ones),
    };
    return cmocka_run_group_tests(tests, open_database, close_database);
}
