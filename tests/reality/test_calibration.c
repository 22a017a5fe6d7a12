/* test_calibration.c - machines out of made-up measurements: prices that are found again, files
 * that read back to the machine that was fitted, and machines with one group of prices scaled. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "../support/scratch.h"
#include "base/random.h"
#include "plan/plan.h"
#include "reality/calibrate.h"
#include "reality/predict.h"

static bool near(double x, double y, double relative)
{
    return fabs(x - y) <= relative * fmax(fabs(x), fabs(y));
}

/* ---- prices of kernels */

/* `n` kernels that take just what their counts cost. */
static struct rates made_rates(struct random *r, int n)
{
    struct rates x = {.flop = random_uniform(r, 1e-10, 1e-8),
                      .div = random_uniform(r, 1e-9, 1e-7),
                      .sqrt = random_uniform(r, 1e-9, 1e-7),
                      .trig = random_uniform(r, 1e-9, 1e-7),
                      .call = random_uniform(r, 1e-9, 1e-7),
                      .fixed = random_uniform(r, 1e-7, 1e-6),
                      .copy = 1e-10,
                      .instruction = 3e-10,
                      .n = n};
    for (int i = 0; i < n; i++) {
        struct rate_sample *s = &x.sample[i];
        snprintf(s->what, sizeof s->what, "kernel, n = %d", i);
        s->work = (struct work){.flop = 100 + random_below(r, 100000),
                                .div = random_below(r, 5000),
                                .sqrt = random_below(r, 1000),
                                .trig = random_below(r, 1000),
                                .call = random_below(r, 5000)};
        const struct work *w = &s->work;
        s->seconds = x.fixed + x.flop * (double)w->flop + x.div * (double)w->div +
                     x.sqrt * (double)w->sqrt + x.trig * (double)w->trig + x.call * (double)w->call;
        s->samples = 30, s->disturbed = i;
    }
    return x;
}

/* Divisions, calls and the constant are fitted; the others are given. */
static void prices_of_kernels_are_found_again(void **state)
{
    (void)state;
    struct random r = random_make(7, 7, 7);
    for (int round = 0; round < 100; round++) {
        const struct rates made = made_rates(&r, 4 + (int)random_below(&r, 30));
        struct rates x = made;
        x.div = x.call = x.fixed = -1;
        assert_true(rates_fit(&x));
        assert_true(near(x.div, made.div, 1e-6) && near(x.call, made.call, 1e-6));
        assert_true(near(x.fixed, made.fixed, 1e-4));
        assert_true(x.flop == made.flop && x.sqrt == made.sqrt && x.trig == made.trig);
        assert_true(x.residual < 1e-8 && x.median_residual <= x.residual);
        /* one sample off: the largest residual shows it, the median does not */
        struct rates off = made;
        off.n = 30;
        struct rates more = made_rates(&r, 30);
        off = more;
        off.sample[3].seconds *= 3;
        assert_true(rates_fit(&off));
        assert_true(off.residual > 0.2 && off.median_residual < off.residual / 2);
    }
}

static void too_few_kernels_have_no_prices(void **state)
{
    (void)state;
    struct random r = random_make(7, 7, 8);
    struct rates x = made_rates(&r, 3);
    assert_true(rates_fit(&x)); /* three prices, three equations */
    x = made_rates(&r, 2);
    assert_false(rates_fit(&x));
    x = made_rates(&r, 0);
    assert_false(rates_fit(&x));
    x = made_rates(&r, 2); /* what nobody does needs no equation, and has no price */
    for (int i = 0; i < 2; i++) {
        x.sample[i].seconds -= x.div * (double)x.sample[i].work.div;
        x.sample[i].work.div = 0;
    }
    assert_true(rates_fit(&x));
    assert_true(x.div == 0);
    assert_true(x.residual < 1e-8);
}

/* Loops that were slower than whole kernels leave something for the others all the same. */
static void no_price_is_below_nothing(void **state)
{
    (void)state;
    struct random r = random_make(7, 7, 9);
    for (int round = 0; round < 50; round++) {
        struct rates x = made_rates(&r, 12);
        for (int i = 0; i < 12; i++) x.sample[i].seconds *= random_uniform(&r, 0.2, 1.5);
        assert_true(rates_fit(&x));
        assert_true(x.div >= 0 && x.call >= 0 && x.fixed >= 0);
        assert_true(isfinite(x.residual) && x.residual >= x.median_residual);
    }
}

static void a_processor_has_these_prices(void **state)
{
    (void)state;
    const struct rates x = {
        .flop = 2e-9, .div = 1e-8, .sqrt = 3e-8, .trig = 5e-8, .call = 7e-9, .copy = 4e-10};
    const struct node_spec n = rates_node(&x, 2e9);
    assert_true(near(n.flop_rate, 5e8, 1e-12) && n.clock == 2e9);
    assert_true(near(n.div_cycles, 20, 1e-12) && near(n.sqrt_cycles, 60, 1e-12));
    assert_true(near(n.trig_cycles, 100, 1e-12) && n.call_time == 7e-9);
    assert_true(near(n.copy_bandwidth, 2.5e9, 1e-12));
    const struct rates free = {.copy = 1e-9};
    assert_true(rates_node(&free, 1e9).flop_rate >= 1e15); /* a flop that costs nothing */
}

/* ---- machine files */

/* Messages of software with two laws: eager below 8 KiB, a hand-shake above. */
static void made_messages(struct random *r, struct messages *m)
{
    const double os = random_uniform(r, 1e-7, 1e-6), or = random_uniform(r, 1e-7, 1e-6),
                 copy_s = random_uniform(r, 1e-11, 1e-10), copy_r = random_uniform(r, 1e-11, 1e-10),
                 latency = random_uniform(r, 1e-7, 2e-6), rate = random_uniform(r, 1e-10, 1e-9),
                 shake = random_uniform(r, 1e-6, 5e-6);
    *m = (struct messages){.eager_most = 4096, .barrier = 3e-6};
    for (int64_t b = 0; b <= 1 << 20; b = b ? b * 4 : 1) {
        struct message_point *p = &m->point[m->n++];
        const double x = (double)b;
        p->bytes = b, p->samples = 40, p->disturbed = m->n;
        p->rendezvous = b > 4096;
        p->send = os + (p->rendezvous ? 0 : copy_s * x);
        p->recv = or +(p->rendezvous ? 0 : copy_r * x);
        p->one_way = p->send + p->recv + latency + rate * x + (p->rendezvous ? shake : 0);
        p->train = 3e-6 + rate * x; /* the gap is more than either end takes */
    }
}

static struct calibration made_calibration(struct random *r)
{
    struct calibration c = {.rates = made_rates(r, 9),
                            .has_messages = true,
                            .load = {0.25, 1.5, 1.75},
                            .host = "box",
                            .processor = "a processor",
                            .library = "MPICH",
                            .date = "2026-11-23",
                            .processors = 2 + (int)random_below(r, 60),
                            .clock = 1e6 * (double)(500 + random_below(r, 4000))};
    made_messages(r, &c.messages);
    return c;
}

/* The machine of a calibration's file, read as any other. */
static struct machine_spec read_back(const struct calibration *c, char *kept, size_t size)
{
    char folder[192], path[512];
    struct text t = {0};
    struct machine_spec m;
    struct err e;
    calibration_text(c, &t);
    scratch_make(folder, sizeof folder);
    scratch_path(path, sizeof path, folder, "box.yaml");
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    assert_true(fputs(t.s, f) >= 0 && fclose(f) == 0);
    err_clear(&e);
    const struct plan_options none = {0};
    const bool good = plan_machine(&m, path, &none, arena, NULL, NULL, &e);
    if (!good) fail_msg("line %d: %s\n%s", e.line, e.text, t.s);
    scratch_remove(folder);
    snprintf(kept, size, "%s", t.s);
    text_free(&t);
    return m;
}

/* Every number to the digits that are printed. */
static void compare_software(const struct software_spec *x, const struct software_spec *y)
{
    assert_int_equal(x->nsegment, y->nsegment);
    for (int i = 0; i < x->nsegment; i++) {
        const struct software_segment *a = &x->segment[i], *b = &y->segment[i];
        assert_int_equal(a->from, b->from);
        assert_int_equal(a->protocol, b->protocol);
        const double pair[][2] = {{a->send_overhead, b->send_overhead},
                                  {a->send_copy, b->send_copy},
                                  {a->recv_overhead, b->recv_overhead},
                                  {a->recv_copy, b->recv_copy},
                                  {a->latency, b->latency},
                                  {a->gap, b->gap},
                                  {a->gap_per_byte, b->gap_per_byte}};
        for (size_t k = 0; k < sizeof pair / sizeof *pair; k++)
            if (!near(pair[k][0], pair[k][1], 1e-4))
                fail_msg("segment %d, %d: %g, %g", i, (int)k, pair[k][0], pair[k][1]);
        if (a->protocol == PROTOCOL_RENDEZVOUS)
            assert_true(near(a->rendezvous_latency, b->rendezvous_latency, 1e-4));
    }
}

static void the_file_is_the_machine_that_was_fitted(void **state)
{
    (void)state;
    struct random r = random_make(3, 5, 7);
    for (int round = 0; round < 25; round++) {
        char text[32768];
        struct calibration c = made_calibration(&r);
        c.has_code = round % 2;
        c.code = (struct code_rates){
            .price = {0.25, 4, 0, 3, 1.5, 0.5, 0.375, 0.4, 0.6, 1.25, 3.5, 4.5, 0.008},
            .n = 0};
        const struct machine_spec m = read_back(&c, text, sizeof text);
        const struct machine_spec base = m, fitted = calibration_machine(&c, &base);
        const struct node_spec *n = &m.node, *f = &fitted.node;
        assert_true(near(n->flop_rate, f->flop_rate, 1e-3) && n->clock == f->clock);
        assert_true(near(n->div_cycles, f->div_cycles, 1e-3));
        assert_true(near(n->sqrt_cycles, f->sqrt_cycles, 1e-3));
        assert_true(near(n->trig_cycles, f->trig_cycles, 1e-3));
        assert_true(near(n->call_time, f->call_time, 1e-3));
        assert_true(near(n->copy_bandwidth, f->copy_bandwidth, 1e-3));
        if (c.has_code) {
            assert_true(n->code.issue == 0.25 && n->code.div == 4 && n->code.chain == 3);
            assert_true(n->code.root > 0 && n->code.root < 1e-5); /* 0 would be another thing */
            assert_true(n->code.add == 0.4 && n->code.multiply == 0.6 && n->code.fetch == 1.25);
            assert_true(n->code.add_latency == 3.5 && n->code.multiply_latency == 4.5);
            assert_true(n->code.window == 125);
            assert_true(n->code.step == 1.5 && n->code.load == 0.5 && n->code.whole == 0.375);
        } else {
            assert_true(near(n->instruction_cycles, c.rates.instruction * c.clock, 1e-3));
            assert_true(n->code.issue == 0);
        }
        compare_software(&m.software, &fitted.software);
        assert_true(near(m.software.segment[0].gap, 3e-6, 1e-3));
        assert_int_equal(machine_spec_processors(&m), c.processors);
        assert_int_equal(m.network.level, LEVEL_LOGGP);
    }
}

/* Two processes, compilers, collectives: what was not measured is not in the file. */
static void the_file_says_what_was_measured(void **state)
{
    (void)state;
    struct random r = random_make(3, 5, 8);
    struct calibration c = made_calibration(&r);
    char text[32768];
    c.messages.eager_most = INT64_MAX;
    for (int i = 0; i < c.messages.n; i++) c.messages.point[i].rendezvous = false;
    struct machine_spec m = read_back(&c, text, sizeof text);
    assert_true(software_all_eager(&m.software, -1));
    assert_non_null(strstr(text, "# No size that was tried waits for its receive.\n"));
    assert_non_null(strstr(text, "other programs kept 0.25 processors busy; load average 1.50 "
                                 "before, 1.75 after"));
    assert_non_null(strstr(text, "box, 2026-11-23: a processor, "));
    assert_null(strstr(text, "  code:"));
    c = made_calibration(&r);
    c.processor[0] = '\0';
    m = read_back(&c, text, sizeof text);
    assert_non_null(strstr(text, "box, 2026-11-23: unknown processor, "));
    assert_non_null(strstr(text, "# Messages up to 4096 B are sent at once.\n"));
    assert_non_null(strstr(text, "# Between 4096 and 16384 B a message changes its line: "));
    assert_int_equal(software_eager_most(&m.software), 16383);
    c.has_messages = false; /* one process alone */
    m = read_back(&c, text, sizeof text);
    assert_int_equal(m.software.nsegment, 0);
    assert_null(strstr(text, "software:"));
    const struct machine_spec fitted = calibration_machine(&c, &m);
    assert_true(fitted.software.nsegment == 0 && fitted.software.eager_bytes == -1);
    assert_true(fitted.software.barrier == BARRIER_SOFTWARE);
    c.rates.flop = c.rates.div = c.rates.call = 0; /* classes that the fit gave nothing */
    m = read_back(&c, text, sizeof text);
    assert_true(m.node.flop_rate >= 1e14 && m.node.div_cycles == 0 && m.node.call_time == 0);
}

/* Rules of collectives stand in the file, and what was left out is told. */
static void rules_of_collectives_are_kept(void **state)
{
    (void)state;
    struct random r = random_make(3, 5, 9);
    struct calibration c = made_calibration(&r);
    char text[32768];
    c.has_collectives = true;
    c.collectives = (struct collective_times){.nrank = 4, .n = 1, .left_out = 2};
    c.collectives.sample[0] = (struct collective_sample){
        .kind = COLLECTIVE_ALLREDUCE,
        .algorithm = collective_algorithm_find(COLLECTIVE_ALLREDUCE, "ring"),
        .bytes = 65536,
        .measured = 12e-6,
        .predicted = 13e-6,
        .samples = 31,
        .disturbed = 4};
    snprintf(c.collectives.rules, sizeof c.collectives.rules, "allreduce ring");
    struct machine_spec m = read_back(&c, text, sizeof text);
    assert_string_equal(m.software.collectives, "allreduce ring");
    assert_non_null(strstr(text, "# 2 more were left out"));
    const char *line = strstr(text, "#   allreduce ");
    assert_non_null(line);
    assert_non_null(strstr(line, "65536 B     12.000     13.000  31 - 4\n"));
    c.collectives.rules[0] = '\0', c.collectives.left_out = 0;
    m = read_back(&c, text, sizeof text);
    assert_string_equal(m.software.collectives, "");
    assert_non_null(strstr(text, "# No collective is faster by another algorithm: 1 collectives"));
    assert_null(strstr(text, "left out"));
}

/* ---- groups of prices */

/* All numbers of a machine that a price may be, each another one. */
enum { NUMBERS = 46 };

static void numbers_of(struct machine_spec *m, double *at[NUMBERS], enum price_group group[NUMBERS])
{
    struct node_spec *n = &m->node;
    struct software_spec *s = &m->software;
    struct software_segment *x = &s->segment[0], *y = &s->segment[1];
    const struct {
        double *at;
        enum price_group group; /* PRICES: none */
    } row[NUMBERS] = {
        {&n->flop_rate, PRICE_FLOP},
        {&n->div_cycles, PRICE_DIV},
        {&n->sqrt_cycles, PRICE_SQRT},
        {&n->trig_cycles, PRICE_TRIG},
        {&n->call_time, PRICE_CALL},
        {&n->copy_bandwidth, PRICE_COPY},
        {&n->instruction_cycles, PRICE_INSTRUCTION},
        {&n->code.issue, PRICE_CODE},
        {&n->code.div, PRICE_CODE},
        {&n->code.root, PRICE_CODE},
        {&n->code.chain, PRICE_CODE},
        {&n->code.step, PRICE_CODE},
        {&n->code.load, PRICE_CODE},
        {&n->code.whole, PRICE_CODE},
        {&n->code.add, PRICE_CODE},
        {&n->code.multiply, PRICE_CODE},
        {&n->code.fetch, PRICE_CODE},
        {&n->code.add_latency, PRICE_CODE},
        {&n->code.multiply_latency, PRICE_CODE},
        {&n->code.window, PRICES},
        {&n->clock, PRICES},
        {&s->send_overhead, PRICE_SEND},
        {&s->recv_overhead, PRICE_RECV},
        {&s->send_copy, PRICE_BYTES},
        {&s->recv_copy, PRICE_BYTES},
        {&s->gap_per_byte, PRICE_BYTES},
        {&s->gap, PRICE_LATENCY},
        {&s->rendezvous_latency, PRICE_LATENCY},
        {&s->barrier_time, PRICE_LATENCY},
        {&m->network.hop_latency, PRICE_LATENCY},
        {&m->network.end_latency, PRICE_LATENCY},
        {&x->send_overhead, PRICE_SEND},
        {&x->recv_overhead, PRICE_RECV},
        {&x->send_copy, PRICE_BYTES},
        {&x->recv_copy, PRICE_BYTES},
        {&x->gap_per_byte, PRICE_BYTES},
        {&x->gap, PRICE_LATENCY},
        {&x->latency, PRICE_LATENCY},
        {&x->rendezvous_latency, PRICE_LATENCY},
        {&y->send_overhead, PRICE_SEND},
        {&y->recv_copy, PRICE_BYTES},
        {&y->latency, PRICE_LATENCY},
        {&s->segment[2].latency, PRICES}, /* behind the last one */
        {&m->noise.compute_cv, PRICES},
        {&s->copy_traffic, PRICES},
        {&s->kernel_time, PRICES},
    };
    for (int i = 0; i < NUMBERS; i++) at[i] = row[i].at, group[i] = row[i].group;
}

/* Times of the group grow by the factor, rates of it sink, all else stays to the last bit. */
static void a_group_scales_its_own_prices_alone(void **state)
{
    (void)state;
    for (int g = 0; g < PRICES; g++) {
        struct machine_spec m, was;
        double *at[NUMBERS];
        enum price_group group[NUMBERS];
        memset(&m, 0, sizeof m);
        m.software.nsegment = 2;
        numbers_of(&m, at, group);
        for (int i = 0; i < NUMBERS; i++) *at[i] = 1.5 + i;
        /* not given, and nothing: they stay so */
        m.software.segment[1].gap = -1, m.software.segment[1].send_copy = 0;
        was = m;
        price_scale(&m, (enum price_group)g, 4); /* a power of two: no rounding */
        for (int i = 0; i < NUMBERS; i++) {
            const bool rate = at[i] == &m.node.flop_rate || at[i] == &m.node.copy_bandwidth;
            const double factor = (int)group[i] != g ? 1 : rate ? 0.25 : 4;
            if (*at[i] != (1.5 + i) * factor)
                fail_msg("%s: number %d is %g", price_name((enum price_group)g), i, *at[i]);
        }
        assert_true(m.software.segment[1].gap == -1 && m.software.segment[1].send_copy == 0);
        price_scale(&m, (enum price_group)g, 0.25);
        assert_memory_equal(&m, &was, sizeof m);
        for (int k = 0; k < g; k++)
            assert_string_not_equal(price_name((enum price_group)k),
                                    price_name((enum price_group)g));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(prices_of_kernels_are_found_again),
        cmocka_unit_test(too_few_kernels_have_no_prices),
        cmocka_unit_test(no_price_is_below_nothing),
        cmocka_unit_test(a_processor_has_these_prices),
        cmocka_unit_test(the_file_is_the_machine_that_was_fitted),
        cmocka_unit_test(the_file_says_what_was_measured),
        cmocka_unit_test(rules_of_collectives_are_kept),
        cmocka_unit_test(a_group_scales_its_own_prices_alone),
    };
    return cmocka_run_group_tests(tests, make_arena, drop_arena);
}
