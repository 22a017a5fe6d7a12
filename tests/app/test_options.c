/* test_options.c - options of single verbs: what is taken out of the arguments, and what is
 * refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "app/flag.h"
#include "app/load_options.h"
#include "app/plot_options.h"
#include "app/shard.h"
#include "base/digest.h"
#include "base/random.h"
#include "study/load.h"

/* A command line from words divided by blanks ("_" in a word stands for one); argv[0] is "verb". */
struct line {
    int argc;
    char text[6000];
    char *argv[700];
};

static struct line *make_line(const char *words)
{
    static struct line l;
    char *save = NULL;
    snprintf(l.text, sizeof l.text, "verb %s", words);
    l.argc = 0;
    for (char *s = strtok_r(l.text, " ", &save); s != NULL; s = strtok_r(NULL, " ", &save)) {
        assert_true(l.argc < 699);
        for (char *c = s; *c; c++)
            if (*c == '_') *c = ' ';
        l.argv[l.argc++] = s;
    }
    l.argv[l.argc] = NULL;
    return &l;
}

/* What is left of the line, words joined by blanks; argv still ends with NULL. */
static void left_is(const struct line *l, const char *expected)
{
    char left[6000] = "";
    for (int i = 1; i < l->argc; i++) {
        if (i > 1) strcat(left, " ");
        strcat(left, l->argv[i]);
    }
    assert_string_equal(left, expected);
    assert_null(l->argv[l->argc]);
}

static void flags_are_taken_wherever_they_stand(void **state)
{
    (void)state;
    struct line *l = make_line("--keep a --keep b --keeper --keep");
    assert_true(take_flag(&l->argc, l->argv, "--keep"));
    left_is(l, "a b --keeper");
    assert_false(take_flag(&l->argc, l->argv, "--keep"));
    l = make_line("a -- --keep");
    assert_false(take_flag(&l->argc, l->argv, "--keep"));
    left_is(l, "a -- --keep");
    l = make_line("");
    assert_false(take_flag(&l->argc, l->argv, "verb")); /* the verb itself is no option */
    left_is(l, "");
    l = make_line("--keep=1");
    assert_false(take_flag(&l->argc, l->argv, "--keep"));
}

static void values_are_taken_in_both_spellings(void **state)
{
    (void)state;
    static const struct {
        const char *line, *value, *left; /* value NULL: none */
    } cases[] = {
        {"--x 1 a", "1", "a"},
        {"--x=1 a", "1", "a"},
        {"a --x= b", "", "a b"},
        {"a --x", "", "a"},
        {"--xy 1 a", NULL, "--xy 1 a"},
        {"--x 1 --x=2 a --x 3", "3", "a"}, /* the last one counts, none is left */
        {"--x --x 1", "--x", "1"},         /* a value is whatever follows */
        {"--x a=b", "a=b", ""},
        {"--x=a=b", "a=b", ""},
        {"a -- --x 1", NULL, "a -- --x 1"},
        {"", NULL, ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct line *l = make_line(cases[i].line);
        const char *value = take_value(&l->argc, l->argv, "--x");
        if (cases[i].value == NULL) assert_null(value);
        else {
            assert_non_null(value);
            assert_string_equal(value, cases[i].value);
        }
        left_is(l, cases[i].left);
    }
    struct line *l = make_line("--x 1 --x=2 a --x 3");
    assert_string_equal(take_first_value(&l->argc, l->argv, "--x"), "1");
    left_is(l, "--x=2 a --x 3");
    assert_string_equal(take_first_value(&l->argc, l->argv, "--x"), "2");
    assert_string_equal(take_first_value(&l->argc, l->argv, "--x"), "3");
    assert_null(take_first_value(&l->argc, l->argv, "--x"));
}

static void seconds_and_threads(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        double seconds; /* -1: refused */
    } cases[] = {{"", 0},           {"--for 2.5", 2.5},  {"--for=1e-3", 1e-3},
                 {"--for 0", -1},   {"--for -1", -1},    {"--for nan", -1},
                 {"--for inf", -1}, {"--for 1s", -1},    {"--for", -1},
                 {"--for=", -1},    {"--for 1e999", -1}, {"--for 3 --for 4", 4}};
    struct err e;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct line *l = make_line(cases[i].line);
        double seconds = 99;
        err_clear(&e);
        const bool taken = take_seconds(&l->argc, l->argv, "--for", &seconds, &e);
        assert_true(taken == (cases[i].seconds >= 0));
        if (taken) assert_true(seconds == cases[i].seconds);
        else {
            assert_int_equal(e.kind, ERR_USAGE);
            assert_non_null(strstr(e.text, "--for: '"));
        }
        left_is(l, "");
    }
    static const struct {
        const char *line;
        int threads; /* 0: refused */
    } threads[] = {{"", RUN_THREADS_AUTO},     {"--threads auto", RUN_THREADS_AUTO},
                   {"--threads 1", 1},         {"--threads=1024", 1024},
                   {"--threads 1025", 0},      {"--threads 0", 0},
                   {"--threads -1", 0},        {"--threads 4x", 0},
                   {"--threads", 0},           {"--threads 99999999999999999999", 0},
                   {"--threads 4294967297", 0}};
    for (size_t i = 0; i < sizeof threads / sizeof *threads; i++) {
        struct line *l = make_line(threads[i].line);
        int n = 99;
        err_clear(&e);
        assert_true(take_threads(&l->argc, l->argv, &n, &e) == (threads[i].threads != 0));
        if (threads[i].threads != 0) assert_int_equal(n, threads[i].threads);
        else assert_int_equal(e.kind, ERR_USAGE);
    }
}

static void shards_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int number, of; /* of -1: refused */
    } cases[] = {{NULL, 0, 0},         {"1/1", 1, 1},
                 {"3/8", 3, 8},        {"1000000/1000000", 1000000, 1000000},
                 {"0/8", 0, -1},       {"9/8", 0, -1},
                 {"1/1000001", 0, -1}, {"1/0", 0, -1},
                 {"-1/8", 0, -1},      {"1/-8", 0, -1},
                 {"3", 0, -1},         {"3/", 0, -1},
                 {"/8", 0, -1},        {"", 0, -1},
                 {"3/8x", 0, -1},      {"3/8/9", 0, -1},
                 {"3.5/8", 0, -1},     {"1/4294967297", 0, -1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct shard s = {7, 7};
        struct err e;
        err_clear(&e);
        const bool read = shard_parse(cases[i].text, &s, &e);
        if (read != (cases[i].of >= 0)) fail_msg("%s: %s", cases[i].text, e.text);
        if (!read) assert_int_equal(e.kind, ERR_USAGE);
        else assert_true(s.number == cases[i].number && s.of == cases[i].of);
    }
}

/* Every run is in one shard of each division, whatever else is there, and shards are even. */
static void every_run_belongs_to_one_shard(void **state)
{
    (void)state;
    enum { RUNS = 2000 };
    static const int division[] = {1, 2, 3, 7, 64, 1000000};
    for (size_t k = 0; k < sizeof division / sizeof *division; k++) {
        const int of = division[k];
        int least = RUNS, most = 0;
        static int count[65];
        memset(count, 0, sizeof count);
        for (int i = 0; i < RUNS; i++) {
            static struct run_spec run;
            char text[32];
            snprintf(text, sizeof text, "run %d", i / 4);
            digest_sha256_hex(text, strlen(text), run.config_hash);
            run.rep = i % 4;
            const int at = shard_of(&run, of);
            assert_true(at >= 1 && at <= of && at == shard_of(&run, of));
            const struct shard own = {at, of}, other = {at % of + 1, of}, all = {0, 0};
            assert_true(shard_has(&own, &run) && shard_has(&all, &run));
            assert_true(shard_has(&other, &run) == (of == 1));
            if (of <= 64) count[at]++;
        }
        for (int i = 1; i <= of && of <= 64; i++) {
            if (count[i] < least) least = count[i];
            if (count[i] > most) most = count[i];
        }
        if (of <= 7) assert_true(least > RUNS / of * 8 / 10 && most < RUNS / of * 12 / 10 + 1);
        if (of == 64) assert_true(least > 5);
    }
}

static void repetitions_are_dealt_out_and_named(void **state)
{
    (void)state;
    static struct run_spec run;
    char name[RUN_NAME], expected[RUN_NAME];
    digest_sha256_hex("x", 1, run.config_hash);
    const int first = shard_of(&run, 8);
    for (int rep = 0; rep < 8; rep++) {
        run.rep = rep;
        assert_int_equal(shard_of(&run, 8), (first - 1 + rep) % 8 + 1);
    }
    run.rep = INT32_MAX;
    run_name(&run, name);
    snprintf(expected, sizeof expected, "%s-2147483647", run.config_hash);
    assert_string_equal(name, expected);
}

static bool take_plot(const char *words, struct plot_request *r, bool *given, struct err *e)
{
    struct line *l = make_line(words);
    err_clear(e);
    const bool taken = plot_options_take(r, &l->argc, l->argv, given, arena, e);
    if (taken) left_is(l, "");
    return taken;
}

static void plots_are_asked_for(void **state)
{
    (void)state;
    struct plot_request r;
    struct err e;
    bool given;
    assert_true(take_plot("", &r, &given, &e));
    assert_false(given);
    assert_true(r.x == NULL && r.by == NULL && r.nwhere == 0 && r.kind == PLOT_AUTO);
    assert_int_equal(r.x_scale, PLOT_SCALE_AUTO);
    assert_true(take_plot("--x n --y=speedup --by= --where n>=64 --where level=link --kind bars "
                          "--log x --title A_title --as name",
                          &r, &given, &e));
    assert_true(given);
    assert_string_equal(r.x, "n");
    assert_string_equal(r.y, "speedup");
    assert_string_equal(r.by, ""); /* everything on one curve */
    assert_string_equal(r.title, "A title");
    assert_string_equal(r.as, "name");
    assert_int_equal(r.nwhere, 2);
    assert_string_equal(r.where[0].key, "n");
    assert_string_equal(r.where[1].value, "link");
    assert_int_equal(r.kind, PLOT_BARS);
    assert_int_equal(r.x_scale, PLOT_SCALE_LOG);
    assert_int_equal(r.y_scale, PLOT_SCALE_LINEAR);
    static const struct {
        const char *words;
        enum plot_scale x, y;
    } logs[] = {{"--log none", PLOT_SCALE_LINEAR, PLOT_SCALE_LINEAR},
                {"--log y", PLOT_SCALE_LINEAR, PLOT_SCALE_LOG},
                {"--log xy", PLOT_SCALE_LOG, PLOT_SCALE_LOG}};
    for (size_t i = 0; i < 3; i++) {
        assert_true(take_plot(logs[i].words, &r, &given, &e));
        assert_false(given); /* no axis was there */
        assert_true(r.x_scale == logs[i].x && r.y_scale == logs[i].y);
    }
    assert_true(take_plot("--z time --kind heat", &r, &given, &e));
    assert_true(given && r.kind == PLOT_HEAT);
}

static void wrong_requests_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *words, *told;
    } cases[] = {{"--x", "--x: a value is missing"},
                 {"--title=", "--title: a value is missing"},
                 {"--as", "--as: a value is missing"},
                 {"--kind bar", "did you mean 'bars'"},
                 {"--kind pie-chart-in-3d", "expected one of auto, lines, bars, heat"},
                 {"--log z", "--log: 'z'"},
                 {"--where level", "--where 'level': expected KEY=VALUE"},
                 {"--where", "--where ''"}};
    struct plot_request r;
    struct err e;
    bool given;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_false(take_plot(cases[i].words, &r, &given, &e));
        assert_int_equal(e.kind, ERR_USAGE);
        if (strstr(e.text, cases[i].told) == NULL) fail_msg("%s: %s", cases[i].words, e.text);
    }
    char many[2000] = "";
    for (int i = 0; i < MOST_CONDITIONS; i++) strcat(many, "--where n=1 ");
    assert_true(take_plot(many, &r, &given, &e));
    assert_int_equal(r.nwhere, MOST_CONDITIONS);
    strcat(many, "--where n=1");
    assert_false(take_plot(many, &r, &given, &e));
    assert_string_equal(e.text, "more than 32 times --where");
}

static void pictures_are_named_after_what_they_show(void **state)
{
    (void)state;
    static const struct {
        struct plot_request r;
        const char *query, *name;
    } cases[] = {
        {{.as = "mine"}, "q.sql", "mine"},
        {{0}, "/some/where/cost.sql", "cost"},
        {{0}, "cost.sql", "cost"},
        {{.x = "n", .y = "speedup"}, NULL, "speedup-over-n"},
        {{.x = "n"}, NULL, "y-over-n"},
        {{.y = "speedup"}, NULL, "speedup-over-x"},
        {{.x = "n", .y = "P", .z = "time"}, NULL, "time-over-n-P"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct plot_request r = cases[i].r;
        plot_options_name(&r, cases[i].query, arena);
        assert_string_equal(r.as, cases[i].name);
    }
    struct plot_request r = {.as = "../x;rm"};
    plot_options_name(&r, NULL, arena);
    assert_null(strpbrk(r.as, "/;"));
}

static bool take_load(const char *words, struct load_options *o, struct err *e)
{
    struct line *l = make_line(words);
    err_clear(e);
    const bool taken = load_options_take(&l->argc, l->argv, o, arena, e);
    if (taken) left_is(l, "");
    return taken;
}

static void loads_without_options(void **state)
{
    (void)state;
    struct load_options o;
    struct err e;
    assert_true(take_load("", &o, &e));
    assert_int_equal(o.ntraffic, 1);
    assert_string_equal(o.traffic[0], "uniform");
    assert_true(o.nrouting == 0 && o.nlevel == 0 && o.saturation && !o.software);
    assert_int_equal(o.nrate, 20);
    for (int i = 0; i < 20; i++) assert_true(fabs(o.rate[i] - 0.05 * (i + 1)) < 1e-12);
    assert_true(o.rate[19] == 1);
    assert_int_equal(o.bytes, 64);
    assert_true(o.within == 0.02 && o.seed == 1);
    assert_true(take_load("--no-saturation --software --seed 0 --size 4_KiB --within 5% "
                          "--routing minimal,valiant --traffic uniform,hotspot(3,4),shift",
                          &o, &e));
    assert_true(!o.saturation && o.software && o.seed == 0 && o.bytes == 4096);
    assert_true(fabs(o.within - 0.05) < 1e-15);
    assert_int_equal(o.nrouting, 2);
    assert_string_equal(o.routing[1], "valiant");
    assert_int_equal(o.ntraffic, 3);
    assert_string_equal(o.traffic[1], "hotspot(3,4)"); /* commas in brackets divide nothing */
    assert_string_equal(o.traffic[2], "shift");
}

static void rates_are_rising_and_each_once(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int n;
        double rate[8];
    } cases[] = {
        {"0.5", 1, {0.5}},
        {"1", 1, {1}},
        {"0.3,0.1,0.2,0.1", 3, {0.1, 0.2, 0.3}},
        {"0.1:0.5:0.1", 5, {0.1, 0.2, 0.3, 0.4, 0.5}},
        {"0.1:0.45:0.1", 5, {0.1, 0.2, 0.3, 0.4, 0.45}}, /* the end is always among them */
        {"0.1:0.1", 1, {0.1}},
        {"0.1:0.2:5", 2, {0.1, 0.2}},
        {"0.9,0.1:0.3:0.1", 4, {0.1, 0.2, 0.3, 0.9}},
        /* sums and numbers that were typed are one load, whatever their last bits are */
        {"0.1:0.5:0.1,0.3", 5, {0.1, 0.2, 0.3, 0.4, 0.5}},
        {"0.3,0.1:0.4:0.1,0.2:0.4:0.05", 6, {0.1, 0.2, 0.25, 0.3, 0.35, 0.4}},
    };
    struct load_options o;
    struct err e;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char words[200];
        snprintf(words, sizeof words, "--rates %s", cases[i].text);
        if (!take_load(words, &o, &e)) fail_msg("%s: %s", words, e.text);
        if (o.nrate != cases[i].n) fail_msg("%s: %d loads", words, o.nrate);
        for (int k = 0; k < o.nrate; k++) {
            assert_true(fabs(o.rate[k] - cases[i].rate[k]) < 1e-9);
            assert_true(k == 0 || o.rate[k] > o.rate[k - 1]);
        }
    }
    assert_true(take_load("--rates 0.1:0.3:0.1", &o, &e)); /* 0.1 + 2 x 0.1 is above 0.3 */
    assert_true(o.nrate == 3 && o.rate[2] == 0.3);
    assert_true(take_load("--rates 0.2:0.39", &o, &e)); /* twenty without a step */
    assert_int_equal(o.nrate, 20);
    assert_true(o.rate[0] == 0.2 && fabs(o.rate[1] - 0.21) < 1e-12 && o.rate[19] == 0.39);
}

static const struct {
    const char *words, *told;
} wrong_loads[] = {
    {"--rates 0", "above 0 and up to 1"},
    {"--rates 1.1", "--rates: 1.1"},
    {"--rates -0.5", "above 0"},
    {"--rates nan", "'nan' is not a number"},
    {"--rates fast", "'fast' is not a number"},
    {"--rates 0.5x", "is not a number"},
    {"--rates 0.1,,0.2", "has an empty entry"},
    {"--rates 0.1,", "has an empty entry"},
    {"--rates=", "has an empty entry"},
    {"--rates 0.5:0.1", "expected LOW:HIGH"},
    {"--rates 0.1:0.5:0", "expected LOW:HIGH"},
    {"--rates 0.1:0.5:-1", "expected LOW:HIGH"},
    {"--rates 0.1:0.5:0.1:2", "expected LOW:HIGH"},
    {"--rates :", "expected LOW:HIGH"},
    {"--rates 0:0.5:0.1", "above 0"},
    {"--rates 0.1:1:1e-9", "more than 256 loads"},
    {"--rates 0.5:1.5:0.5", "above 0 and up to 1"},
    {"--size 64", "no unit"},
    {"--size 0_B", "1 B to 1 GiB"},
    {"--size 1.5_B", "1 B to 1 GiB"},
    {"--size 2_GiB", "1 B to 1 GiB"},
    {"--within 0", "an error such as 2%"},
    {"--within 1", "an error such as 2%"},
    {"--within 100%", "an error such as 2%"},
    {"--within 2%%", "an error such as 2%"},
    {"--within few", "an error such as 2%"},
    {"--seed -1", "from 0 to 1000000000"},
    {"--seed 1.5", "expected a whole number"},
    {"--seed 99999999999999999999", "expected a whole number"},
    {"--messages 0", "expected a whole number"},
    {"--traffic uniform,", "--traffic: 'uniform,' has an empty entry"},
    {"--routing=", "has an empty entry"},
};

static void wrong_loads_are_refused(void **state)
{
    (void)state;
    struct load_options o;
    struct err e;
    for (size_t i = 0; i < sizeof wrong_loads / sizeof *wrong_loads; i++) {
        if (take_load(wrong_loads[i].words, &o, &e)) fail_msg("%s is taken", wrong_loads[i].words);
        assert_int_equal(e.kind, ERR_USAGE);
        if (strstr(e.text, wrong_loads[i].told) == NULL)
            fail_msg("%s: %s", wrong_loads[i].words, e.text);
    }
    char words[1000];
    snprintf(words, sizeof words, "--messages %d", LOAD_LEAST_MESSAGES);
    assert_true(take_load(words, &o, &e));
    snprintf(words, sizeof words, "--messages %d", LOAD_LEAST_MESSAGES - 1);
    assert_false(take_load(words, &o, &e));
    snprintf(words, sizeof words, "--messages %d", LOAD_MOST_MESSAGES);
    assert_true(take_load(words, &o, &e));
    assert_int_equal(o.most, LOAD_MOST_MESSAGES);
    /* as many words as there may be, and one more */
    snprintf(words, sizeof words, "--traffic a");
    for (int i = 1; i < LOAD_MOST_WORDS; i++) strcat(words, ",a");
    assert_true(take_load(words, &o, &e));
    assert_int_equal(o.ntraffic, LOAD_MOST_WORDS);
    strcat(words, ",a");
    assert_false(take_load(words, &o, &e));
    assert_non_null(strstr(e.text, "more than 64 entries"));
}

static void levels_of_loads(void **state)
{
    (void)state;
    struct load_options o = {0};
    struct err e;
    err_clear(&e);
    assert_true(load_options_levels(NULL, &o, arena, &e));
    assert_int_equal(o.nlevel, 0);
    assert_true(load_options_levels("flit,packet", &o, arena, &e));
    assert_int_equal(o.nlevel, 2);
    assert_true(o.level[0] == LEVEL_FLIT && o.level[1] == LEVEL_PACKET);
    assert_true(load_options_levels("loggp,link,packet,flit,auto", &o, arena, &e));
    assert_int_equal(o.nlevel, LEVELS);
    static const char *const wrong[][2] = {{"flt", "did you mean 'flit'"},
                                           {"auto-tolerance", "no level 'auto-tolerance'"},
                                           {"", "empty entry"},
                                           {"flit,,link", "empty entry"},
                                           {"xyzzyxyzzy", "known: loggp, link, packet, flit, auto"},
                                           {"link,link,link,link,link,link", "more than 5"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        err_clear(&e);
        assert_false(load_options_levels(wrong[i][0], &o, arena, &e));
        assert_int_equal(e.kind, ERR_USAGE);
        if (strstr(e.text, wrong[i][1]) == NULL) fail_msg("%s: %s", wrong[i][0], e.text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flags_are_taken_wherever_they_stand),
        cmocka_unit_test(values_are_taken_in_both_spellings),
        cmocka_unit_test(seconds_and_threads),
        cmocka_unit_test(shards_are_read),
        cmocka_unit_test(every_run_belongs_to_one_shard),
        cmocka_unit_test(repetitions_are_dealt_out_and_named),
        cmocka_unit_test(plots_are_asked_for),
        cmocka_unit_test(wrong_requests_are_refused),
        cmocka_unit_test(pictures_are_named_after_what_they_show),
        cmocka_unit_test(loads_without_options),
        cmocka_unit_test(rates_are_rising_and_each_once),
        cmocka_unit_test(wrong_loads_are_refused),
        cmocka_unit_test(levels_of_loads),
    };
    return cmocka_run_group_tests(tests, make_arena, drop_arena);
}
