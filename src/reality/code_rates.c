/* code_rates.c - see code_rates.h.
 *
 * A block takes the longest of several times (machine/node_cost.h), so the time of a loop is no sum
 * of prices. But it is one piece by piece: with the prices at hand, each loop is simulated once
 * more with each price a little higher, which tells how often it counts there. Prices of that
 * linear piece follow from least squares; where they lead to another piece, it is done again. */
#include "reality/code_rates.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "reality/fit.h"
#include "reality/predict.h"
#include "run/run.h"

/* So many times this part of the way, as the piece beyond may have other slopes. With half of it
 * one fit in four did not get near the least residual. */
enum { ROUNDS = 16 };
#define FIT_PART 0.4

/* A price is raised by this part of itself, or of a small price where it is none [cycles]. */
#define STEP 0.02
#define SMALL_PRICE 0.05
#define SMALL_WINDOW 0.001

static const char *const names[CODE_PRICES] = {
    "issue", "div", "root",     "chain", "step",        "load",
    "whole", "add", "multiply", "fetch", "add_latency", "multiply_latency", "window"};

const char *code_price_name(int i) { return names[i]; }

double code_price_window(const double *price) { return 1 / fmax(price[CODE_WINDOW], 1e-6); }

/* --- the fit ---------------------------------------------------------------------------------- */

/* What the samples take at `price`: fitted times, residuals, and the sum of their squares. */
static bool judge(struct code_rates *r, const double *price, code_time_fn *time, void *context,
                  double *squares, struct err *e)
{
    double off[CODE_RATES_MOST];
    *squares = 0;
    for (int i = 0; i < r->n; i++) {
        struct code_sample *s = &r->sample[i];
        if (!time(context, i, price, &s->fitted, e)) return false;
        off[i] = fabs(s->fitted / s->seconds - 1);
        *squares += off[i] * off[i];
    }
    fit_residuals(off, r->n, &r->median_residual, &r->residual);
    memcpy(r->price, price, sizeof r->price);
    return true;
}

/* Prices that are right where each counts as often as it does at r->price. Times that no price
 * explains (divisions) are taken away first. */
static bool linear_piece(const struct code_rates *r, code_time_fn *time, void *context,
                         double *price, struct err *e)
{
    double count[CODE_RATES_MOST * CODE_PRICES], y[CODE_RATES_MOST], unused;
    for (int i = 0; i < r->n; i++) {
        const double now = r->sample[i].fitted;
        double explained = 0;
        for (int j = 0; j < CODE_PRICES; j++) {
            double raised[CODE_PRICES], after;
            memcpy(raised, r->price, sizeof raised);
            const double step =
                STEP * fmax(raised[j], j == CODE_WINDOW ? SMALL_WINDOW : SMALL_PRICE);
            raised[j] += step;
            if (!time(context, i, raised, &after, e)) return false;
            /* Whole picoseconds a block are rounded: less than a thousandth is none. */
            const double slope = fabs(after - now) < 1e-3 * STEP * now ? 0 : (after - now) / step;
            count[i * CODE_PRICES + j] = slope;
            explained += slope * r->price[j];
        }
        y[i] = r->sample[i].seconds - (now - explained);
        if (y[i] <= 0) y[i] = r->sample[i].seconds / 2;
    }
    if (!fit_prices(count, y, r->n, CODE_PRICES, price, &unused))
        return err_set(e, ERR_DATA, "%d loops are too few to fit prices of code to", r->n);
    /* A price that counts nowhere on this piece stays, since it may count on another one. */
    for (int j = 0; j < CODE_PRICES; j++) {
        bool counts = false;
        for (int i = 0; i < r->n; i++) counts = counts || count[i * CODE_PRICES + j] != 0;
        if (!counts) price[j] = r->price[j];
    }
    return true;
}

bool code_rates_fit(struct code_rates *r, code_time_fn *time, void *context, struct err *e)
{
    /* A processor of four instructions, two loads, additions and products a cycle and one piece of
     * code, whose additions take three. */
    double price[CODE_PRICES] = {0.25, 5, 8, 3, 1, 0.5, 0.25, 0.5, 0.5, 1, 3, 4, 0.01};
    double best[CODE_PRICES], least = INFINITY, squares;
    memcpy(best, price, sizeof best);
    if (r->n < CODE_PRICES)
        return err_set(e, ERR_DATA, "%d loops are too few to fit prices of code to", r->n);
    for (int k = 0; k < ROUNDS; k++) {
        double next[CODE_PRICES];
        if (!judge(r, price, time, context, &squares, e)) return false;
        if (squares < least) {
            least = squares;
            memcpy(best, price, sizeof best);
        }
        if (!linear_piece(r, time, context, next, e)) return false;
        for (int j = 0; j < CODE_PRICES; j++) price[j] += FIT_PART * (next[j] - price[j]);
    }
    return judge(r, best, time, context, &squares, e);
}

/* --- measuring -------------------------------------------------------------------------------- */

/* What simulating a sample needs. */
struct simulated {
    const struct plan *plan;
    const struct node_spec *node;
    struct run_cache *cache;
};

static bool simulated_time(void *context, int i, const double *price, double *seconds,
                           struct err *e)
{
    const struct simulated *x = context;
    struct run_spec spec = x->plan->run[i];
    spec.machine.node = *x->node;
    /* A price of nothing at all would switch finer rules off, or ask for node.div. */
    spec.machine.node.code = (struct code_spec){.issue = fmax(price[0], 1e-6),
                                                .div = fmax(price[1], 1e-6),
                                                .root = fmax(price[2], 1e-6),
                                                .chain = price[3],
                                                .step = price[4],
                                                .load = fmax(price[5], 1e-6),
                                                .whole = price[6],
                                                .add = price[7],
                                                .multiply = price[8],
                                                .fetch = price[9],
                                                .add_latency = fmax(price[10], 1e-6),
                                                .multiply_latency = fmax(price[11], 1e-6),
                                                .window = code_price_window(price)};
    return predict_time(&spec, x->cache, seconds, e);
}

/* "calibrate-code, loop = sum": settings that the points differ in. */
static void name_of(const struct run_spec *spec, struct code_sample *s)
{
    const char *p = spec->program.parameters;
    const char *loop = p != NULL ? strstr(p, "loop = ") : NULL;
    const int n = loop != NULL ? (int)strcspn(loop, "\n") : 0;
    snprintf(s->what, sizeof s->what, "%.24s, %.*s", spec->kernel.name, n, n > 0 ? loop : "");
}

bool code_rates_take(const struct plan *p, const struct passes *measured,
                     const struct node_spec *node, struct code_rates *out, struct err *e)
{
    struct simulated x = {p, node, run_cache_create()};
    out->n = measured->n < CODE_RATES_MOST ? measured->n : CODE_RATES_MOST;
    for (int i = 0; i < out->n; i++) {
        const struct rate_sample *one = &measured->kept[i];
        out->sample[i] = (struct code_sample){
            .seconds = one->seconds, .samples = one->samples, .disturbed = one->disturbed};
        name_of(&p->run[i], &out->sample[i]);
    }
    const bool ok = code_rates_fit(out, simulated_time, &x, e);
    run_cache_destroy(x.cache);
    return ok;
}
