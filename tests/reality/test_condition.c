/* test_condition.c - how fast a computer was, out of made-up looks: which bursts count, what
 * prices become, what a machine file keeps, and which points of a calibration are kept. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <string.h>

#include "reality/calibrate.h"
#include "reality/condition.h"
#include "reality/passes.h"

static bool near(double x, double y) { return fabs(x - y) <= 1e-9 * fmax(fabs(x), fabs(y)); }

/* All operations take `factor` ns. */
static struct host_speed look(double factor)
{
    struct host_speed s;
    for (int o = 0; o < HOST_OPERATIONS; o++) s.time[o] = factor * 1e-9;
    return s;
}

/* ---- bursts */

/* A run of up to five bursts of four repetitions of 10 us: burst i took factor[i] times as long. */
struct made {
    struct real_result r;
    struct real_sample sample[4 * REAL_BURSTS];
};

static void make(struct made *m, int n, const double *factor)
{
    memset(m, 0, sizeof *m);
    m->r.sample = m->sample;
    m->r.nburst = n;
    for (int i = 0; i < n; i++) {
        m->r.burst[i] = (struct real_burst){4, look(factor[i]), look(factor[i])};
        for (int k = 0; k < 4; k++) m->sample[m->r.nsample++].seconds = 1e-5 * factor[i];
    }
}

static void steady_bursts_have_their_own_time_and_speed(void **state)
{
    struct made m;
    (void)state;
    make(&m, 3, (const double[]){1, 1.5, 1});
    const struct condition c = condition_of(&m.r);
    assert_int_equal(c.bursts, 3);
    assert_int_equal(c.steady, 3);
    assert_false(condition_changed(&c));
    assert_true(near(c.burst[1].seconds, 1.5e-5) && near(c.burst[1].speed.time[HOST_CALL], 1.5e-9));
}

/* Ten per cent are the same; any of three operations tells a change, copies and messages do not. */
static void looks_that_differ_by_more_than_a_tenth_are_a_change(void **state)
{
    struct made m;
    (void)state;
    for (int o = 0; o < HOST_OPERATIONS; o++) {
        const bool tells = o != HOST_COPY && o != HOST_MESSAGE;
        make(&m, 1, (const double[]){1});
        m.r.burst[0].after.time[o] = 1.0999e-9;
        assert_int_equal(condition_of(&m.r).steady, 1);
        assert_true(near(condition_of(&m.r).burst[0].speed.time[o], 1.04995e-9));
        m.r.burst[0].after.time[o] = 1.1001e-9;
        assert_int_equal(condition_of(&m.r).steady, !tells);
        m.r.burst[0].after.time[o] = 1e-9 / 1.1001; /* faster is another one, too */
        assert_int_equal(condition_of(&m.r).steady, !tells);
    }
    make(&m, 1, (const double[]){1});
    m.r.burst[0].before.time[HOST_CALL] = 0; /* nobody looked */
    assert_int_equal(condition_of(&m.r).steady, 0);
}

static void a_run_counts_when_half_of_its_bursts_are_steady(void **state)
{
    (void)state;
    for (int n = 1; n <= REAL_BURSTS; n++)
        for (int off = 0; off <= n; off++) {
            struct made m;
            make(&m, n, (const double[]){1, 1, 1, 1, 1});
            for (int i = 0; i < off; i++) m.r.burst[i].after = look(2);
            const struct condition c = condition_of(&m.r);
            assert_int_equal(c.steady, n - off);
            assert_int_equal(condition_changed(&c), off > n - off);
        }
    const struct condition none = {0}; /* a row of an older version: nothing is known */
    assert_false(condition_changed(&none));
}

/* Fewer than three undisturbed repetitions are no burst; disturbed ones are in no median. */
static void disturbed_repetitions_do_not_count(void **state)
{
    struct made m;
    (void)state;
    make(&m, 2, (const double[]){1, 1});
    m.sample[4].seconds = 1;
    m.sample[4].disturbed = true;
    struct condition c = condition_of(&m.r);
    assert_int_equal(c.bursts, 2);
    assert_true(near(c.burst[1].seconds, 1e-5));
    m.sample[5].disturbed = true;
    c = condition_of(&m.r);
    assert_int_equal(c.bursts, 1);
    assert_int_equal(c.steady, 1);
    /* bursts that tell of more repetitions than there are */
    make(&m, 2, (const double[]){1, 1});
    m.r.burst[1].n = 400;
    assert_int_equal(condition_of(&m.r).bursts, 2);
}

static void the_middle_error_is_that_of_a_burst(void **state)
{
    (void)state;
    assert_int_equal(condition_middle((const double[]){5}, 1), 0);
    assert_int_equal(condition_middle((const double[]){0.9, -0.2, 0.1}, 3), 2);
    assert_int_equal(condition_middle((const double[]){4, 1, 3, 2}, 4), 3); /* the lower of two */
    assert_int_equal(condition_middle((const double[]){1, 1, 1, 9, 9}, 5), 0);
    assert_int_equal(condition_middle((const double[]){9, 9, 1, 9, 1}, 5), 0);
}

/* ---- prices */

static struct machine_spec machine(void)
{
    return (struct machine_spec){
        .node = {.flop_rate = 1e9,
                 .div_cycles = 10,
                 .sqrt_cycles = 10,
                 .trig_cycles = 10,
                 .instruction_cycles = 10,
                 .call_time = 1e-8,
                 .copy_bandwidth = 1e9,
                 .code = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}},
        .network = {.hop_latency = 1e-6},
        .software = {.send_overhead = 1e-6, .recv_overhead = 1e-6, .gap_per_byte = 1e-9}};
}

/* Every operation has a factor of its own, and each price that of its operation. */
static void each_price_follows_its_operation(void **state)
{
    static const double factor[HOST_OPERATIONS] = {
        [HOST_MULTIPLY_ADD] = 2, [HOST_CALL] = 3, [HOST_CHAIN] = 5, [HOST_COPY] = 7,
        [HOST_MESSAGE] = 11};
    const struct condition_reference reference = {look(1), look(0.5)};
    struct host_speed now;
    (void)state;
    for (int o = 0; o < HOST_OPERATIONS; o++) now.time[o] = factor[o] * 1e-9;
    struct machine_spec m = machine();
    condition_apply(&m, &reference, &now);
    assert_true(near(m.node.flop_rate, 1e9 / 2) && near(m.node.div_cycles, 20));
    assert_true(near(m.node.trig_cycles, 20) && near(m.node.sqrt_cycles, 50));
    assert_true(near(m.node.instruction_cycles, 50) && near(m.node.call_time, 3e-8));
    assert_true(near(m.node.copy_bandwidth, 1e9 / 7) && near(m.network.hop_latency, 11e-6));
    assert_true(near(m.software.send_overhead, 11e-6) && near(m.software.recv_overhead, 11e-6));
    assert_true(near(m.software.gap_per_byte, 7e-9));
    /* Code by its own reference, at which all took half as long. */
    const struct code_spec *c = &m.node.code;
    const double issue[] = {c->issue, c->load, c->whole, c->add, c->multiply, c->fetch};
    const double wait[] = {c->div, c->root, c->chain, c->step, c->add_latency, c->multiply_latency};
    for (int i = 0; i < 6; i++) assert_true(near(issue[i], 4) && near(wait[i], 10));
    assert_true(c->window == 1); /* so many at all times */
}

static void what_is_not_known_stays(void **state)
{
    const struct condition_reference none = {0}, known = {look(1), look(1)};
    const struct host_speed nothing = {0}, now = look(3);
    (void)state;
    const struct machine_spec before = machine();
    for (int i = 0; i < 2; i++) {
        struct machine_spec m = before;
        condition_apply(&m, i == 0 ? &none : &known, i == 0 ? &now : &nothing);
        assert_true(m.node.flop_rate == before.node.flop_rate);
        assert_true(m.node.call_time == before.node.call_time && m.node.code.chain == 1);
        assert_true(m.software.send_overhead == before.software.send_overhead);
    }
}

/* ---- the machine file */

static void sources_keep_the_reference(void **state)
{
    static const char *const key[] = {"node.flop_rate",         "node.call",
                                      "node.sqrt",              "node.copy.bandwidth",
                                      "network.link.bandwidth", "node.code.issue",
                                      "node.code.chain",        "node.div"};
    enum { KEYS = sizeof key / sizeof *key };
    struct condition_reference r = {look(0.25), look(4)}, back;
    char source[KEYS][100];
    struct origin origin[KEYS] = {0};
    (void)state;
    for (int i = 0; i < KEYS; i++) {
        strcpy(source[i], "fit");
        condition_note(&r, key[i], source[i], sizeof source[i]);
        strcat(source[i], "; host, 2026-11-24");
        origin[i].key = key[i];
        origin[i].source = source[i];
    }
    assert_string_equal(source[0], "fit; probe 0.25 ns; host, 2026-11-24");
    assert_string_equal(source[7], "fit; host, 2026-11-24");
    assert_true(condition_reference_of(origin, KEYS, &back));
    for (int o = 0; o < HOST_OPERATIONS; o++) assert_true(near(back.rates.time[o], 0.25e-9));
    assert_true(near(back.code.time[HOST_MULTIPLY_ADD], 4e-9));
    assert_true(near(back.code.time[HOST_CHAIN], 4e-9) && back.code.time[HOST_COPY] == 0);
    /* Files of before, of strangers, and with nonsense say nothing. */
    assert_false(condition_reference_of(&origin[7], 1, &back));
    static const char *const bad[] = {"; probe", "; probe x ns", "; probe -1 ns", "; probe 0 ns",
                                      "; probe nan ns", "; probe inf ns", ""};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        origin[0].source = bad[i];
        assert_false(condition_reference_of(origin, 1, &back));
        assert_true(back.rates.time[HOST_MULTIPLY_ADD] == 0);
    }
}

/* ---- passes of a calibration */

static struct rate_sample point(double seconds, double speed)
{
    return (struct rate_sample){.seconds = seconds, .before = look(speed), .after = look(speed)};
}

/* One pass over n points of these times and speeds. */
static void one_pass(struct passes *x, int n, const double *seconds, const double *speed)
{
    x->n = n;
    for (int i = 0; i < n; i++) {
        const struct rate_sample s = point(seconds[i], speed[i]);
        passes_add(x, i, &s);
    }
    x->made++;
}

static void the_lesser_time_is_kept_with_its_speed(void **state)
{
    struct passes x = {0}, none = {0};
    double by;
    (void)state;
    one_pass(&x, 3, (const double[]){1, 3, 1}, (const double[]){1, 1.6, 1});
    assert_int_equal(passes_changed(&x, &none, &by), 0);
    one_pass(&x, 3, (const double[]){1.05, 2, 1.5}, (const double[]){1, 1, 1.5});
    assert_true(x.kept[0].seconds == 1 && x.kept[1].seconds == 2 && x.kept[2].seconds == 1);
    assert_true(near(x.kept[1].before.time[HOST_CALL], 1e-9));
    /* two of three points changed by half, whichever pass was the slower one */
    assert_int_equal(passes_changed(&none, &x, &by), 2);
    assert_true(near(by, 0.5));
    /* later passes are no part of that */
    one_pass(&x, 3, (const double[]){9, 9, 0.5}, (const double[]){1, 1, 1});
    assert_int_equal(passes_changed(&x, &none, &by), 2);
    assert_true(x.kept[2].seconds == 0.5);
}

static void slow_points_are_measured_again(void **state)
{
    struct passes x = {0};
    (void)state;
    one_pass(&x, 4, (const double[]){1, 1, 1, 1}, (const double[]){1.05, 1, 1.09, 1.7});
    x.kept[0].after = look(1.2); /* changed meanwhile */
    const double least = passes_least(&x, 0);
    assert_true(near(least, 1e-9) && near(passes_least(&x, 0.9e-9), 0.9e-9));
    assert_true(passes_again(&x.kept[0], least) && passes_again(&x.kept[3], least));
    assert_false(passes_again(&x.kept[1], least) || passes_again(&x.kept[2], least));
    assert_int_equal(passes_slow(&x, least), 2);
    assert_true(near(passes_speed(&x).time[HOST_CALL], 1.125e-9)); /* the upper one of two */
    assert_true(passes_speed(&(struct passes){0}).time[HOST_CALL] == 0);
}

static void a_change_is_told(void **state)
{
    struct calibration c = {.points = 40, .changed = 4, .changed_by = 0.34};
    char text[500];
    (void)state;
    calibration_remark(&c, text, sizeof text);
    assert_string_equal(text, "");
    c.changed = 5;
    calibration_remark(&c, text, sizeof text);
    assert_string_equal(text, "This computer's speed changed during calibration: 5 of 40 points "
                              "took over 10 % longer in one pass than in the other, 34 % in their "
                              "median; the lesser times are kept");
    c.slow = 5;
    calibration_remark(&c, text, sizeof text);
    assert_non_null(strstr(text, "kept. 5 of 40 points were slowed down by over 10 %"));
    assert_non_null(strstr(text, "better calibrate again"));
    c.changed = 0;
    calibration_remark(&c, text, sizeof text);
    assert_true(strncmp(text, "5 of 40 points were slowed", 26) == 0);
}

/* ---- what the database keeps */

static void bursts_are_json(void **state)
{
    struct made m;
    char text[1024];
    (void)state;
    make(&m, 2, (const double[]){0.125, 2});
    m.r.burst[0].before.time[HOST_MESSAGE] = 0; /* one rank */
    real_bursts_text(&m.r, text, sizeof text);
    assert_string_equal(text,
                        "{\"bursts\":[4,4],\"multiply_add\":[0.125,0.125,2,2],"
                        "\"call\":[0.125,0.125,2,2],\"chain\":[0.125,0.125,2,2],"
                        "\"copy\":[0.125,0.125,2,2]}");
    /* The longest there is has room. */
    make(&m, REAL_BURSTS, (const double[]){1.2345e-5, 1.2345e-5, 1.2345e-5, 1.2345e-5, 1.2345e-5});
    for (int i = 0; i < REAL_BURSTS; i++) m.r.burst[i].n = 20000;
    real_bursts_text(&m.r, text, sizeof text);
    m.r.nburst = 0;
    real_bursts_text(&m.r, text, sizeof text);
    assert_string_equal(text, "");
}

#define TEST(function) cmocka_unit_test(function)

int main(void)
{
    const struct CMUnitTest tests[] = {TEST(steady_bursts_have_their_own_time_and_speed),
                                       TEST(looks_that_differ_by_more_than_a_tenth_are_a_change),
                                       TEST(a_run_counts_when_half_of_its_bursts_are_steady),
                                       TEST(disturbed_repetitions_do_not_count),
                                       TEST(the_middle_error_is_that_of_a_burst),
                                       TEST(each_price_follows_its_operation),
                                       TEST(what_is_not_known_stays),
                                       TEST(sources_keep_the_reference),
                                       TEST(the_lesser_time_is_kept_with_its_speed),
                                       TEST(slow_points_are_measured_again),
                                       TEST(a_change_is_told),
                                       TEST(bursts_are_json)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
