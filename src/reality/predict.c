/* predict.c - see predict.h.
 *
 * How much of the predicted time is due to a group of prices is found by simulating once more with
 * them a little higher: the difference holds for the whole program with its overlaps, which a sum
 * over counted operations would not. */
#include "reality/predict.h"

#include <math.h>
#include <string.h>

#include "base/text.h"

/* A step that is small beside the differences that are to be explained, and large beside rounding
 * to picoseconds. */
#define STEP 0.02

static const char *const names[PRICES] = {"node.flop_rate",
                                          "node.div",
                                          "node.sqrt",
                                          "node.trig",
                                          "node.call",
                                          "node.copy",
                                          "node.instruction",
                                          "node.code",
                                          "software send overhead",
                                          "software receive overhead",
                                          "latency",
                                          "time per byte of messages"};

const char *price_name(enum price_group g) { return names[g]; }

/* In lists a time below 0 is not given, and stays so. */
static double longer(double time, double factor) { return time > 0 ? time * factor : time; }

/* Times of messages are in software itself and in each of its segments. */
static void scale_software(struct software_spec *s, enum price_group g, double factor)
{
    double *const whole[PRICES][3] = {
        [PRICE_SEND] = {&s->send_overhead},
        [PRICE_RECV] = {&s->recv_overhead},
        [PRICE_LATENCY] = {&s->rendezvous_latency, &s->gap, &s->barrier_time},
        [PRICE_BYTES] = {&s->send_copy, &s->recv_copy, &s->gap_per_byte}};
    for (int k = 0; k < 3; k++)
        if (whole[g][k] != NULL) *whole[g][k] = longer(*whole[g][k], factor);
    for (int i = 0; i < s->nsegment; i++) {
        struct software_segment *x = &s->segment[i];
        double *const part[PRICES][3] = {
            [PRICE_SEND] = {&x->send_overhead},
            [PRICE_RECV] = {&x->recv_overhead},
            [PRICE_LATENCY] = {&x->latency, &x->rendezvous_latency, &x->gap},
            [PRICE_BYTES] = {&x->send_copy, &x->recv_copy, &x->gap_per_byte}};
        for (int k = 0; k < 3; k++)
            if (part[g][k] != NULL) *part[g][k] = longer(*part[g][k], factor);
    }
}

void price_scale(struct machine_spec *m, enum price_group g, double factor)
{
    struct node_spec *n = &m->node;
    switch (g) {
    case PRICE_FLOP: {
        /* What an instruction costs may follow from the flop rate (node_cost.c): not here. */
        n->flop_rate /= factor;
        return;
    }
    case PRICE_DIV:
        n->div_cycles *= factor;
        return;
    case PRICE_SQRT:
        n->sqrt_cycles *= factor;
        return;
    case PRICE_TRIG:
        n->trig_cycles *= factor;
        return;
    case PRICE_CALL:
        n->call_time *= factor;
        return;
    case PRICE_COPY:
        n->copy_bandwidth /= factor;
        return;
    case PRICE_INSTRUCTION:
        n->instruction_cycles *= factor;
        return;
    case PRICE_CODE:
        n->code = (struct code_spec){.issue = n->code.issue * factor,
                                     .div = n->code.div * factor,
                                     .root = n->code.root * factor,
                                     .chain = n->code.chain * factor,
                                     .step = n->code.step * factor,
                                     .load = n->code.load * factor,
                                     .whole = n->code.whole * factor,
                                     .add = n->code.add * factor,
                                     .multiply = n->code.multiply * factor,
                                     .fetch = n->code.fetch * factor,
                                     .add_latency = n->code.add_latency * factor,
                                     .multiply_latency = n->code.multiply_latency * factor,
                                     .window = n->code.window};
        return;
    default:
        break;
    }
    if (g == PRICE_LATENCY) {
        m->network.hop_latency *= factor;
        m->network.end_latency *= factor;
    }
    scale_software(&m->software, g, factor);
}

static bool simulate(const struct run_spec *spec, const struct run_order *order,
                     struct run_cache *cache, struct arena *a, struct run_result *out,
                     struct err *e)
{
    if (!run_sharing(spec, order, cache, a, out, e)) return false;
    if (out->status == RUN_OK) return true;
    return err_set(e, ERR_CHECK, "the simulated run is not ok: %.600s", out->text);
}

bool predict_simulate(const struct run_spec *spec, struct run_cache *cache, struct arena *a,
                      struct run_result *out, struct err *e)
{
    return simulate(spec, NULL, cache, a, out, e);
}

/* For runs by the hundred, with other prices: what they compute is the same. */
bool predict_time(const struct run_spec *spec, struct run_cache *cache, double *seconds,
                  struct err *e)
{
    static const struct run_order order = {.times = true};
    struct arena *a = arena_create();
    struct run_result *r = TAKE(a, 1, struct run_result);
    const bool ok = simulate(spec, &order, cache, a, r, e);
    *seconds = ok ? (double)r->makespan_ps * 1e-12 : 0;
    arena_destroy(a);
    return ok;
}

/* Mean over the ranks, as real stages are. The simulator's last stage is idling, too. */
static double stage_mean(const struct run_result *r, int stage)
{
    double sum = 0;
    for (int i = 0; i < r->nrank; i++) {
        const struct stage_time *t = &r->stage[(size_t)i * (size_t)r->nstage + (size_t)stage];
        sum += (double)(t->compute_ps + t->send_ps + t->recv_ps + t->wait_ps + t->contention_ps);
    }
    return sum * 1e-12 / r->nrank;
}

/* By name: a stage that only one of the two has stands alone. */
static void compare_stages(const struct run_result *r, const struct real_result *real,
                           struct prediction *out)
{
    double most = -1;
    out->worst = -1;
    for (int i = 0; i < real->nstage; i++) {
        struct predicted_stage *s = &out->stage[out->nstage++];
        text_copy(s->name, sizeof s->name, real->stage[i].name);
        s->measured = real->stage[i].median_s;
        s->predicted = NAN;
        for (int k = 0; k < r->nstage; k++)
            if (strcmp(r->stage_name[k], s->name) == 0) s->predicted = stage_mean(r, k);
        const double off = fabs(s->predicted - s->measured);
        if (isnan(off) || off <= most) continue;
        most = off;
        out->worst = i;
    }
}

/* The group whose times would have to change least, as a factor, for the prediction to be right. A
 * group cannot take away more than it contributes. */
static void explain(struct prediction *p)
{
    const double missing = p->measured - p->predicted;
    double least = INFINITY;
    p->explains = PRICES;
    p->factor = 1;
    for (int g = 0; g < PRICES; g++) {
        if (p->contribution[g] <= 0) continue;
        const double factor = 1 + missing / p->contribution[g];
        if (factor <= 0 || fabs(log(factor)) >= least) continue;
        least = fabs(log(factor));
        p->explains = (enum price_group)g;
        p->factor = factor;
    }
}

/* Time that grows with the prices of group g, by a second simulation. */
static bool contribution(const struct run_spec *spec, enum price_group g, struct run_cache *cache,
                         double before, double *out, struct err *e)
{
    struct run_spec changed = *spec;
    double seconds;
    price_scale(&changed.machine, g, 1 + STEP);
    const bool ok = predict_time(&changed, cache, &seconds, e);
    *out = ok ? (seconds - before) / STEP : 0;
    return ok;
}

bool predict_run(const struct run_spec *spec, const struct real_result *real,
                 struct run_cache *cache, struct prediction *out, struct err *e)
{
    struct arena *a = arena_create();
    struct run_result *r = TAKE(a, 1, struct run_result);
    memset(out, 0, sizeof *out);
    bool ok = predict_simulate(spec, cache, a, r, e);
    if (ok) {
        out->predicted = (double)r->makespan_ps * 1e-12;
        out->measured = real->time.median;
        out->error = out->predicted / out->measured - 1;
        compare_stages(r, real, out);
    }
    for (int g = 0; ok && g < PRICES; g++)
        ok = contribution(spec, (enum price_group)g, cache, out->predicted, &out->contribution[g],
                          e);
    if (ok) explain(out);
    arena_destroy(a);
    return ok;
}
