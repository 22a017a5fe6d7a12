/* test_plot_rows.c - conditions on rows, and rows as points of curves, on sheets made by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "report/plot_points.h"
#include "report/plot_where.h"

/* A sheet of the lines in `text`: the first has the names of columns, cells are divided by commas.
 * A column is of numbers when each of its values that is not empty is one. */
static void make_sheet(struct plot_sheet *s, const char *text)
{
    *s = (struct plot_sheet){.arena = arena_create()};
    char *copy = arena_text(s->arena, text);
    int lines = 0, at = 0;
    for (const char *c = text; *c; c++) lines += *c == '\n';
    for (char *c = copy; *c != '\n'; c++) s->ncolumn += *c == ',';
    s->ncolumn++;
    s->nrow = lines - 1;
    s->column = TAKE(s->arena, s->ncolumn, struct plot_column);
    s->cell = calloc((size_t)(lines * s->ncolumn), sizeof *s->cell);
    s->run_id = calloc((size_t)lines, sizeof *s->run_id);
    assert_non_null(s->cell);
    assert_non_null(s->run_id);
    for (char *c = copy; *c != '\0'; at++) {
        char *end = c + strcspn(c, ",\n"), *rest;
        const int column = at % s->ncolumn;
        const bool last = *end == '\n';
        *end = '\0';
        assert_true(last == (column == s->ncolumn - 1));
        if (at < s->ncolumn)
            s->column[at] = (struct plot_column){.key = c, .title = c, .number = true};
        else {
            struct plot_cell *cell = &s->cell[at - s->ncolumn];
            *cell = (struct plot_cell){c, strtod(c, &rest)};
            if (rest == c || *rest != '\0') cell->number = NAN;
            if (*c != '\0' && isnan(cell->number)) s->column[column].number = false;
            s->run_id[at / s->ncolumn - 1] = at / s->ncolumn;
        }
        c = end + 1;
    }
}

static void conditions_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *text, *key, *value; /* key NULL: refused */
        enum plot_operator operator;
    } cases[] = {
        {"level=link", "level", "link", PLOT_EQUAL},
        {"level==link", "level", "link", PLOT_EQUAL},
        {" n >= 64 ", "n", "64", PLOT_AT_LEAST},
        {"n<=64", "n", "64", PLOT_AT_MOST},
        {"n<64", "n", "64", PLOT_LESS},
        {"n>64", "n", "64", PLOT_MORE},
        {"name!=a|b", "name", "a|b", PLOT_NOT_EQUAL},
        {"name~t3e*", "name", "t3e*", PLOT_LIKE},
        {"hop_latency\t<\t1 us", "hop_latency", "1 us", PLOT_LESS},
        {"name=a<b", "name", "a<b", PLOT_EQUAL}, /* the first operator divides */
        {"name==", "name", "", PLOT_EQUAL},
        {"name = ", "name", "", PLOT_EQUAL},
        {"", NULL, NULL, PLOT_EQUAL},
        {"level", NULL, NULL, PLOT_EQUAL},
        {"=link", NULL, NULL, PLOT_EQUAL},
        {"  <= 3", NULL, NULL, PLOT_EQUAL},
        {"a!b", NULL, NULL, PLOT_EQUAL},
    };
    struct arena *a = arena_create();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct plot_condition c;
        struct err e;
        err_clear(&e);
        const bool read = plot_where_parse(&c, cases[i].text, a, &e);
        if (read != (cases[i].key != NULL)) fail_msg("'%s': %s", cases[i].text, e.text);
        if (!read) {
            assert_int_equal(e.kind, ERR_USAGE);
            continue;
        }
        assert_string_equal(c.key, cases[i].key);
        assert_string_equal(c.value, cases[i].value);
        assert_int_equal(c.operator, cases[i].operator);
    }
    arena_destroy(a);
}

static const char rows[] = "id,n,level,time\n"
                           "1,8,link,0.1\n"
                           "2,16,link,0.2\n"
                           "3,16,packet,0.30000000000000004\n"
                           "4,,flit,\n"
                           "5,64,,0.5\n";

/* The ids of the rows that fulfil all conditions (divided by ';') are `expected`. */
static void keeps(const char *conditions, const char *expected)
{
    struct plot_sheet s;
    struct plot_condition c[8];
    struct err e;
    char line[200], found[64] = "", *save = NULL;
    int n = 0;
    err_clear(&e);
    make_sheet(&s, rows);
    s.column[3].unit = UNIT_TIME;
    snprintf(line, sizeof line, "%s", conditions);
    for (char *t = strtok_r(line, ";", &save); t != NULL; t = strtok_r(NULL, ";", &save))
        assert_true(plot_where_parse(&c[n++], t, s.arena, &e));
    if (!plot_where_keep(&s, n, c, &e)) fail_msg("%s: %s", conditions, e.text);
    for (int i = 0; i < s.nrow; i++) {
        strcat(found, plot_sheet_at(&s, i, 0)->text);
        assert_int_equal(s.run_id[i], atoi(plot_sheet_at(&s, i, 0)->text));
    }
    if (strcmp(found, expected) != 0) fail_msg("%s: %s, not %s", conditions, found, expected);
    plot_sheet_free(&s);
    assert_null(s.cell);
}

static void rows_that_fulfil_conditions_stay(void **state)
{
    (void)state;
    keeps("n=16", "23");
    keeps("n=16.0", "23"); /* as numbers */
    keeps("n=8|64", "15");
    keeps("n!=16", "145"); /* no value fulfils != alone */
    keeps("n<16", "1");
    keeps("n<=16", "123");
    keeps("n>16", "5");
    keeps("n>=16", "235");
    keeps("level=link", "12");
    keeps("level!=link|flit", "35");
    keeps("level~*", "1234"); /* row 5 has no value */
    keeps("level~[lf]*", "124");
    keeps("time=0.3", "3"); /* but for rounding */
    keeps("time>=0.3", "35");
    keeps("time<=0.3", "123");
    keeps("time<200 ms", "1");
    keeps("time=200 ms|0.5", "25");
    keeps("n>8;level!=packet", "25");
    keeps("id>0", "12345");
    keeps("time=0.2000000001", "2"); /* as many digits as somebody types */
}

static void refuses(const char *text, enum err_kind kind, const char *told)
{
    struct plot_sheet s;
    struct plot_condition c;
    struct err e;
    err_clear(&e);
    make_sheet(&s, rows);
    s.column[3].unit = UNIT_TIME;
    assert_true(plot_where_parse(&c, text, s.arena, &e));
    assert_false(plot_where_keep(&s, 1, &c, &e));
    if (e.kind != kind || strstr(e.text, told) == NULL) fail_msg("%s: %s", text, e.text);
    assert_int_equal(s.nrow, 5);
    plot_sheet_free(&s);
}

static void conditions_that_cannot_be_are_refused(void **state)
{
    (void)state;
    refuses("levl=link", ERR_USAGE, "did you mean 'level'");
    refuses("level<3", ERR_USAGE, "its values are words");
    refuses("n<many", ERR_USAGE, "many");
    refuses("n<inf", ERR_USAGE, "inf");
    refuses("time<3 MB", ERR_USAGE, "3 MB");
    refuses("n=9", ERR_NO_INPUT, "its values are: 8; 16; (none); 64");
    refuses("n>64", ERR_NO_INPUT, "no row fulfils");
    refuses("level=lin", ERR_NO_INPUT, "link; packet; flit; (none)");
    struct plot_sheet s;
    struct err e;
    err_clear(&e);
    make_sheet(&s, "n,m\n");
    assert_false(plot_where_keep(&s, 0, NULL, &e));
    assert_int_equal(e.kind, ERR_NO_INPUT);
    plot_sheet_free(&s);
}

static void queries_may_have_any_number_of_columns(void **state)
{
    (void)state;
    enum { COLUMNS = 1500 };
    struct plot_sheet s = {.arena = arena_create(), .ncolumn = COLUMNS};
    struct err e;
    err_clear(&e);
    s.column = TAKE(s.arena, COLUMNS, struct plot_column);
    for (int i = 0; i < COLUMNS; i++) {
        char name[32];
        snprintf(name, sizeof name, "column_%d_of_many", i);
        s.column[i].key = s.column[i].title = arena_text(s.arena, name);
    }
    assert_int_equal(plot_sheet_find(&s, "column_3_of_many", &e), 3);
    assert_int_equal(plot_sheet_find(&s, "column_1499_of_many", &e), 1499);
    assert_int_equal(plot_sheet_find(&s, "column_7_of_manx", &e), -1);
    assert_int_equal(e.kind, ERR_USAGE);
    plot_sheet_free(&s);
}

/* Columns x, y and what tells curves apart, of a sheet made from `text`. */
struct drawn {
    struct plot_sheet sheet;
    struct plot_points p;
    struct plot_axes axes;
    struct err e;
    bool made;
};

static void draw(struct drawn *d, const char *text, const char *x, const char *y, const char *value,
                 const char *by)
{
    *d = (struct drawn){0};
    err_clear(&d->e);
    make_sheet(&d->sheet, text);
    d->axes.x = plot_sheet_find(&d->sheet, x, &d->e);
    d->axes.y = y ? plot_sheet_find(&d->sheet, y, &d->e) : -1;
    d->axes.value = plot_sheet_find(&d->sheet, value, &d->e);
    if (by) {
        d->axes.by_given = true;
        if (*by) d->axes.by[d->axes.nby++] = plot_sheet_find(&d->sheet, by, &d->e);
    }
    d->made = plot_points_make(&d->p, &d->sheet, &d->axes, &d->e);
}

static void drop(struct drawn *d)
{
    text_free(&d->p.differ);
    plot_sheet_free(&d->sheet);
}

static void rows_become_points_in_the_order_of_the_axis(void **state)
{
    (void)state;
    struct drawn d;
    draw(&d,
         "n,level,time\n64,link,4\n8,link,1\n16,link,2\n8,flit,3\n100,flit,9\n,flit,5\n7,link,"
         "\n",
         "n", NULL, "time", NULL);
    assert_true(d.made);
    assert_int_equal(d.p.n, 5);
    assert_int_equal(d.p.nx, 4);
    assert_int_equal(d.p.unknown, 2);
    assert_int_equal(d.p.nseries, 2);
    assert_int_equal(d.p.npanel, 1);
    assert_string_equal(d.p.series[0], "link");
    assert_string_equal(d.p.series[1], "flit");
    static const struct plot_point expected[] = {{.series = 0, .xi = 0, .value = 1},
                                                 {.series = 0, .xi = 1, .value = 2},
                                                 {.series = 0, .xi = 2, .value = 4},
                                                 {.series = 1, .xi = 0, .value = 3},
                                                 {.series = 1, .xi = 3, .value = 9}};
    for (int i = 0; i < 5; i++) {
        assert_int_equal(d.p.at[i].series, expected[i].series);
        assert_int_equal(d.p.at[i].xi, expected[i].xi);
        assert_true(d.p.at[i].value == expected[i].value && d.p.at[i].rows == 1);
        assert_true(isnan(d.p.at[i].low) && isnan(d.p.at[i].high));
    }
    assert_false(d.p.band);
    assert_string_equal(plot_sheet_at(&d.sheet, d.p.x[3], 0)->text, "100");
    drop(&d);
}

static void words_keep_the_order_in_which_they_come(void **state)
{
    (void)state;
    struct drawn d;
    draw(&d, "machine,time\nt3e,1\nparagon,2\nbeowulf,3\n", "machine", NULL, "time", NULL);
    assert_true(d.made);
    assert_int_equal(d.p.nx, 3);
    for (int i = 0; i < 3; i++) assert_int_equal(d.p.x[i], i);
    drop(&d);
}

/* Rows that differ in more are a mean with their range, and in what they differ is told. */
static void rows_of_one_place_are_a_mean_with_its_range(void **state)
{
    (void)state;
    struct drawn d;
    draw(&d, "n,hop_rate,rate,time\n8,1,5,1\n8,2,6,4\n8,1,5,1\n", "n", NULL, "time", "");
    assert_true(d.made);
    assert_int_equal(d.p.n, 1);
    assert_true(d.p.at[0].value == 2 && d.p.at[0].low == 1 && d.p.at[0].high == 4);
    assert_int_equal(d.p.at[0].rows, 3);
    assert_int_equal(d.p.mixed, 1);
    assert_int_equal(d.p.repeated, 0);
    assert_true(d.p.band);
    assert_string_equal(d.p.differ.s, "hop_rate, rate");
    drop(&d);
    draw(&d, "n,rates,rate,time\n8,1,5,1\n8,2,6,4\n8,3,7,1\n", "n", NULL, "time", "");
    assert_string_equal(d.p.differ.s, "rates, rate");
    drop(&d);
    draw(&d, "n,time, a,a,,b a\n8,1,1,1,1,1\n8,2,2,2,2,2\n", "n", NULL, "time", "");
    assert_string_equal(d.p.differ.s, " a, a, , b a");
    drop(&d);
}

/* Repetitions of one run: Student's interval. Of 1, 2, 3: mean 2, s = 1, t(2) = 4.303. */
static void repetitions_have_an_interval(void **state)
{
    (void)state;
    struct drawn d;
    static const char text[] = "n,config_hash,time\n8,a,1\n8,a,2\n8,a,3\n9,a,7\n9,b,8\n10,a,5\n";
    *(&d) = (struct drawn){0};
    err_clear(&d.e);
    make_sheet(&d.sheet, text);
    d.sheet.runs = true;
    d.axes = (struct plot_axes){.x = 0, .y = -1, .value = 2, .by_given = true};
    assert_true(plot_points_make(&d.p, &d.sheet, &d.axes, &d.e));
    assert_int_equal(d.p.n, 3);
    const double half = 4.303 / sqrt(3);
    assert_true(fabs(d.p.at[0].low - (2 - half)) < 1e-12);
    assert_true(fabs(d.p.at[0].high - (2 + half)) < 1e-12);
    assert_int_equal(d.p.repeated, 1);
    assert_int_equal(d.p.mixed, 1);
    assert_true(d.p.at[1].low == 7 && d.p.at[1].high == 8);
    drop(&d);
    /* eleven of them: between the values of the tables for 10 degrees of freedom */
    char many[400] = "n,config_hash,time\n";
    for (int i = 0; i < 11; i++) snprintf(many + strlen(many), 40, "8,a,%d\n", i);
    make_sheet(&d.sheet, many);
    d.sheet.runs = true;
    assert_true(plot_points_make(&d.p, &d.sheet, &d.axes, &d.e));
    const double t = (d.p.at[0].high - 5) / (sqrt(11) / sqrt(11));
    assert_true(fabs(t - 2.228) < 0.03);
    drop(&d);
}

/* A run without a value of a column is another curve than one with it. */
static void a_missing_value_is_no_value_of_a_curve(void **state)
{
    (void)state;
    struct drawn d;
    draw(&d, "n,size,time\n8,5,1\n8,,2\n16,5,3\n16,,4\n", "n", NULL, "time", "size");
    assert_true(d.made);
    assert_int_equal(d.p.n, 4);
    assert_int_equal(d.p.nseries, 2);
    assert_int_equal(d.p.mixed, 0);
    assert_string_equal(d.p.series[0], "size 5");
    assert_string_equal(d.p.series[1], "");
    drop(&d);
}

static void columns_are_added_until_curves_are_told_apart(void **state)
{
    (void)state;
    struct drawn d;
    /* level tells the rows apart; machine has one value, and time and n are numbers */
    draw(&d, "machine,n,level,time\nt3e,8,link,1\nt3e,8,flit,2\n", "n", NULL, "time", NULL);
    assert_true(d.made);
    assert_int_equal(d.axes.nby, 1);
    assert_int_equal(d.axes.by[0], 2);
    assert_int_equal(d.p.n, 2);
    drop(&d);
    /* nothing needs to be told apart where no two rows have one place */
    draw(&d, "machine,n,time\nt3e,8,1\nparagon,9,2\n", "n", NULL, "time", NULL);
    assert_int_equal(d.axes.nby, 0);
    assert_int_equal(d.p.nseries, 1);
    drop(&d);
}

/* A column of more values than a legend holds is a sample; what all rows share is not named. */
static void legends_name_what_tells_curves_apart(void **state)
{
    (void)state;
    struct drawn d;
    char text[2000] = "n,sample,level,time\n";
    for (int i = 0; i < 25; i++) snprintf(text + strlen(text), 40, "8,s%d,link,%d\n", i, i);
    draw(&d, text, "n", NULL, "time", NULL);
    assert_true(d.made);
    assert_int_equal(d.axes.nby, 0);
    assert_int_equal(d.p.n, 1);
    assert_string_equal(d.p.differ.s, "sample");
    drop(&d);
    draw(&d, text, "n", NULL, "time", "level");
    assert_int_equal(d.p.nseries, 1);
    assert_string_equal(d.p.series[0], "");
    drop(&d);
    /* a word alone, but a number or a truth with the name of its column */
    static const char *const by[] = {"level", "tree", "k"},
                      *const first[] = {"link", "tree true", "k 1"};
    for (int i = 0; i < 3; i++) {
        draw(&d, "n,tree,level,k,time\n8,true,link,1,2\n8,false,flit,2,3\n", "n", NULL, "time",
             by[i]);
        assert_int_equal(d.p.nseries, 2);
        assert_string_equal(d.p.series[0], first[i]);
        drop(&d);
    }
}

static void a_curve_upon_another_is_told(void **state)
{
    (void)state;
    struct drawn d;
    draw(&d,
         "n,level,time\n1,a,100\n2,a,200\n1,b,100\n2,b,200\n1,c,100.4\n2,c,200\n1,d,101\n"
         "2,d,200\n1,e,100\n",
         "n", NULL, "time", "level");
    assert_true(d.made);
    assert_string_equal(d.p.series[0], "a");
    assert_string_equal(d.p.series[1], "b = a");
    assert_string_equal(d.p.series[2], "c = a within 0.4 %");
    assert_string_equal(d.p.series[3], "d");
    assert_string_equal(d.p.series[4], "e"); /* it ends alone */
    drop(&d);
    /* one that lies on a hidden curve alone can be seen beside the first */
    draw(&d, "n,level,time\n1,a,100\n1,b,100.4\n1,c,100.8\n", "n", NULL, "time", "level");
    assert_string_equal(d.p.series[1], "b = a within 0.4 %");
    assert_string_equal(d.p.series[2], "c");
    drop(&d);
}

static void too_many_curves_become_panels_or_are_refused(void **state)
{
    (void)state;
    struct drawn d;
    char text[2000] = "n,machine,level,time\n";
    for (int i = 0; i < 12; i++)
        for (int k = 0; k < 2; k++)
            snprintf(text + strlen(text), 60, "8,m%d,l%d,%d\n", i, k, 10 + i * 20 + k * 7);
    draw(&d, text, "n", NULL, "time", NULL);
    assert_true(d.made);
    assert_int_equal(d.p.npanel, MOST_PANELS);
    assert_int_equal(d.p.nseries, 2);
    assert_string_equal(d.p.panel[11], "m11");
    assert_string_equal(d.p.series[1], "l1");
    drop(&d);
    snprintf(text + strlen(text), 60, "8,m12,l0,1\n8,m12,l1,2\n");
    draw(&d, text, "n", NULL, "time", NULL);
    assert_false(d.made);
    assert_int_equal(d.e.kind, ERR_USAGE);
    assert_non_null(strstr(d.e.text, "machine (13 values), level (2 values)"));
    drop(&d);
    /* six curves fit, seven do not, where there is nothing to divide them by */
    for (int n = MOST_SERIES; n <= MOST_SERIES + 1; n++) {
        snprintf(text, sizeof text, "n,level,time\n");
        for (int i = 0; i < n; i++) snprintf(text + strlen(text), 40, "8,l%d,%d\n", i, 10 << i);
        draw(&d, text, "n", NULL, "time", "level");
        assert_int_equal(d.made, n == MOST_SERIES);
        drop(&d);
    }
}

static void nothing_to_draw_is_told(void **state)
{
    (void)state;
    struct drawn d;
    draw(&d, "n,time\n8,\n,3\n", "n", NULL, "time", NULL);
    assert_false(d.made);
    assert_int_equal(d.e.kind, ERR_NO_INPUT);
    assert_string_equal(d.e.text, "no row has a number for time and a value for n");
    drop(&d);
}

static void heat_maps_have_two_axes(void **state)
{
    (void)state;
    struct drawn d;
    draw(&d,
         "n,P,level,time\n8,1,link,1\n8,2,link,2\n16,2,link,3\n16,1,link,4\n16,1,flit,5\n"
         "4,,link,1\n",
         "n", "P", "time", NULL);
    assert_true(d.made);
    assert_int_equal(d.p.nx, 2);
    assert_int_equal(d.p.ny, 2);
    assert_int_equal(d.p.npanel, 2); /* a panel for each level */
    assert_int_equal(d.p.nseries, 1);
    assert_int_equal(d.p.unknown, 1);
    for (int i = 0; i < d.p.n; i++) {
        const struct plot_point *q = &d.p.at[i];
        const int n = atoi(plot_sheet_at(&d.sheet, d.p.x[q->xi], 0)->text),
                  P = atoi(plot_sheet_at(&d.sheet, d.p.y[q->yi], 1)->text);
        assert_int_equal(n, atoi(plot_sheet_at(&d.sheet, q->row, 0)->text));
        assert_int_equal(P, atoi(plot_sheet_at(&d.sheet, q->row, 1)->text));
    }
    drop(&d);
}

/* Random rows against sums by place: every row is in one point, and means are of these. */
static void random_rows_are_all_in_points(void **state)
{
    (void)state;
    struct random r = random_make(21, 0, 0);
    for (int round = 0; round < 100; round++) {
        char text[4000] = "x,curve,v\n";
        double sum[6][4] = {{0}};
        int count[6][4] = {{0}}, points = 0, total = 0;
        const int n = 1 + (int)random_below(&r, 60);
        for (int i = 0; i < n; i++) {
            const int x = (int)random_below(&r, 6), c = (int)random_below(&r, 4),
                      v = 1 + (int)random_below(&r, 1000);
            snprintf(text + strlen(text), 40, "%d,c%d,%d\n", x * 10, c, v);
            sum[x][c] += v, count[x][c]++;
        }
        for (int x = 0; x < 6; x++)
            for (int c = 0; c < 4; c++) points += count[x][c] > 0;
        struct drawn d;
        draw(&d, text, "x", NULL, "v", "curve");
        assert_true(d.made);
        assert_int_equal(d.p.n, points);
        for (int i = 0; i < points; i++) {
            const struct plot_point *q = &d.p.at[i];
            const int x = atoi(plot_sheet_at(&d.sheet, d.p.x[q->xi], 0)->text) / 10,
                      c = atoi(plot_sheet_at(&d.sheet, q->row, 1)->text + 1);
            assert_int_equal(q->rows, count[x][c]);
            assert_true(fabs(q->value - sum[x][c] / count[x][c]) < 1e-9);
            total += q->rows;
        }
        assert_int_equal(total, n);
        drop(&d);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(conditions_are_read),
        cmocka_unit_test(rows_that_fulfil_conditions_stay),
        cmocka_unit_test(conditions_that_cannot_be_are_refused),
        cmocka_unit_test(queries_may_have_any_number_of_columns),
        cmocka_unit_test(rows_become_points_in_the_order_of_the_axis),
        cmocka_unit_test(words_keep_the_order_in_which_they_come),
        cmocka_unit_test(rows_of_one_place_are_a_mean_with_its_range),
        cmocka_unit_test(repetitions_have_an_interval),
        cmocka_unit_test(a_missing_value_is_no_value_of_a_curve),
        cmocka_unit_test(columns_are_added_until_curves_are_told_apart),
        cmocka_unit_test(legends_name_what_tells_curves_apart),
        cmocka_unit_test(a_curve_upon_another_is_told),
        cmocka_unit_test(too_many_curves_become_panels_or_are_refused),
        cmocka_unit_test(nothing_to_draw_is_told),
        cmocka_unit_test(heat_maps_have_two_axes),
        cmocka_unit_test(random_rows_are_all_in_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
