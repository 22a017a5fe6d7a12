/* test_predict.c - predictions beside measurements that are known: made by the simulator itself, on
 * a machine with one price changed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>

#include "base/arena.h"
#include "plan/plan.h"
#include "reality/predict.h"

static struct run_spec spec_of(struct plan *p, const char *const *set, int n)
{
    struct err e;
    err_clear(&e);
    const struct plan_options o = {.nset = n, .set = set};
    if (!plan_read(p, "speedup-t3e", &o, &e)) fail_msg("%s", e.text);
    return p->run[0];
}

static const char *const settings[] = {"n=16", "ranks=2", "level=loggp", "kernel=dynamics"};

/* What the simulator says of `spec`, as if it had been measured. */
static void measure(const struct run_spec *spec, struct real_result *out)
{
    struct arena *a = arena_create();
    struct run_result *r = TAKE(a, 1, struct run_result);
    struct err e;
    err_clear(&e);
    assert_true(run_one(spec, a, r, &e));
    memset(out, 0, sizeof *out);
    out->time.median = (double)r->makespan_ps * 1e-12;
    for (int k = 0; k < r->nstage; k++) {
        struct real_stage *s = &out->stage[out->nstage++];
        text_copy(s->name, sizeof s->name, r->stage_name[k]);
        for (int i = 0; i < r->nrank; i++) {
            const struct stage_time *t = &r->stage[i * r->nstage + k];
            s->median_s +=
                1e-12 / r->nrank *
                (double)(t->compute_ps + t->send_ps + t->recv_ps + t->wait_ps + t->contention_ps);
        }
    }
    arena_destroy(a);
}

static void predict(const struct run_spec *spec, const struct real_result *real,
                    struct prediction *out)
{
    struct err e;
    err_clear(&e);
    struct run_cache *cache = run_cache_create();
    if (!predict_run(spec, real, cache, out, &e)) fail_msg("%s", e.text);
    run_cache_destroy(cache);
}

static void its_own_prediction_is_exact(void **state)
{
    struct plan p;
    struct real_result real;
    struct prediction out;
    (void)state;
    const struct run_spec spec = spec_of(&p, settings, 4);
    measure(&spec, &real);
    predict(&spec, &real, &out);
    assert_true(out.error == 0);
    assert_int_equal(out.nstage, real.nstage);
    for (int i = 0; i < out.nstage; i++)
        assert_true(fabs(out.stage[i].predicted - out.stage[i].measured) <= 1e-15);
    assert_true(out.contribution[PRICE_FLOP] > 0 && out.contribution[PRICE_SEND] > 0);
    assert_true(fabs(out.factor - 1) < 1e-6);
    plan_free(&p);
}

/* Measured on a machine whose flops take a third longer: that price explains it, by that factor. */
static void the_changed_price_is_found(void **state)
{
    static const enum price_group group[] = {PRICE_FLOP, PRICE_SEND};
    struct plan p;
    struct real_result real;
    struct prediction out;
    (void)state;
    const struct run_spec spec = spec_of(&p, settings, 4);
    for (int i = 0; i < 2; i++) {
        struct run_spec other = spec;
        price_scale(&other.machine, group[i], 1.3);
        measure(&other, &real);
        predict(&spec, &real, &out);
        assert_true(out.error < 0);
        const double missing = out.measured - out.predicted;
        assert_true(fabs(missing / out.contribution[group[i]] - 0.3) < 0.02);
        assert_true(out.explains < PRICES && out.factor > 1);
        assert_true(out.worst >= 0);
    }
    plan_free(&p);
}

/* Every group changes something of a machine that has all of them, and a factor of 1 changes
 * nothing. */
static void groups_act(void **state)
{
    (void)state;
    for (int g = 0; g < PRICES; g++) {
        struct machine_spec m = {.node = {.flop_rate = 1e9,
                                          .clock = 1e9,
                                          .div_cycles = 1,
                                          .sqrt_cycles = 1,
                                          .trig_cycles = 1,
                                          .instruction_cycles = 1,
                                          .code = {1, 1, 1, 1, 1},
                                          .call_time = 1e-9,
                                          .copy_bandwidth = 1e9}},
                            same;
        m.network.end_latency = 1e-6;
        m.software.nsegment = 1;
        m.software.segment[0] = (struct software_segment){0, 1, 1, 1, 1, 1, 1, 1, -1, 0, 0, 0};
        m.software.send_overhead = m.software.recv_overhead = m.software.gap_per_byte = 1;
        same = m;
        price_scale(&same, (enum price_group)g, 1);
        assert_memory_equal(&same, &m, sizeof m);
        price_scale(&same, (enum price_group)g, 2);
        assert_memory_not_equal(&same, &m, sizeof m);
        /* What a list does not give stays not given. */
        assert_true(same.software.segment[0].rendezvous_latency == -1);
        assert_true(strlen(price_name((enum price_group)g)) > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(its_own_prediction_is_exact),
                                       cmocka_unit_test(the_changed_price_is_found),
                                       cmocka_unit_test(groups_act)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
