/* rates.c - see rates.h. Kernels run by the same path as real runs (run/real.h), so what surrounds
 * a kernel there is part of the fixed cost here. */
#include "reality/rates.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "host/host_speed.h"
#include "linalg/angle.h"
#include "reality/fit.h"
#include "run/real.h"

enum {
    UNKNOWNS = 3,
    CHAIN = 1000,
    ANGLES = 512,
    LOOP_SAMPLES = 200,
    LEAST_GOOD = 3
};

/* Least time of one operation in a loop in which each waits for the one before, as pivots and
 * angles do in kernels [s]. */
static double root_price(void)
{
    double least = INFINITY;
    volatile double seed = 2;
    for (int i = 0; i < LOOP_SAMPLES; i++) {
        double x = seed;
        const int64_t before = host_interruptions(), begin = host_clock_ns();
        for (int k = 0; k < CHAIN; k++) x = sqrt(x + 1);
        const double took = (double)(host_clock_ns() - begin) * 1e-9;
        seed = x > 1 ? 2 : 3; /* the result is used */
        if (host_interruptions() == before) least = fmin(least, took / CHAIN);
    }
    return least;
}

/* Angles of many joints are independent of each other, and a loop over them runs side by side. */
static double angle_price(void)
{
    double least = INFINITY, angle[ANGLES], sine[ANGLES], cosine[ANGLES];
    for (int k = 0; k < ANGLES; k++) angle[k] = 0.01 * k;
    for (int i = 0; i < LOOP_SAMPLES; i++) {
        const int64_t before = host_interruptions(), begin = host_clock_ns();
        for (int k = 0; k < ANGLES; k++) angle_sincos(angle[k], &sine[k], &cosine[k]);
        const double took = (double)(host_clock_ns() - begin) * 1e-9;
        __asm__ volatile("" ::"r"(sine), "r"(cosine) : "memory"); /* the results are used */
        /* Two evaluations each, as they are counted. */
        if (host_interruptions() == before) least = fmin(least, took / ANGLES / 2);
    }
    return least;
}

/* Divisions, calls of small operators and a constant are fitted. Flops, roots and angles grow with
 * n as calls do, so a fit cannot tell them apart: they are measured on their own, in loops without
 * calls. A division's price is that of what waits for it: the factors of a block. */
static double known_time(const struct rates *r, const struct work *w)
{
    return (double)w->flop * r->flop + (double)w->sqrt * r->sqrt + (double)w->trig * r->trig;
}

bool rates_fit(struct rates *r)
{
    double count[RATES_MOST * UNKNOWNS], y[RATES_MOST], x[UNKNOWNS], off[RATES_MOST], unused;
    for (int i = 0; i < r->n; i++) {
        const struct work *w = &r->sample[i].work;
        const double row[UNKNOWNS] = {(double)w->div, (double)w->call, 1};
        memcpy(&count[i * UNKNOWNS], row, sizeof row);
        y[i] = r->sample[i].seconds - known_time(r, w);
        if (y[i] <= 0)
            y[i] = r->sample[i].seconds / 2; /* the loops above were slower than kernels */
    }
    if (!fit_prices(count, y, r->n, UNKNOWNS, x, &unused)) return false;
    r->div = x[0], r->call = x[1], r->fixed = x[2];
    for (int i = 0; i < r->n; i++) {
        const struct work *w = &r->sample[i].work;
        double sum = known_time(r, w);
        for (int j = 0; j < UNKNOWNS; j++) sum += count[i * UNKNOWNS + j] * x[j];
        off[i] = fabs(sum - r->sample[i].seconds) / r->sample[i].seconds;
    }
    fit_residuals(off, r->n, &r->median_residual, &r->residual);
    return true;
}

/* Operations that cost nothing measurable are done at a rate that no computer has. */
struct node_spec rates_node(const struct rates *r, double clock)
{
    return (struct node_spec){.flop_rate = r->flop > 0 ? 1 / r->flop : 1e15,
                              .clock = clock,
                              .div_cycles = r->div * clock,
                              .sqrt_cycles = r->sqrt * clock,
                              .trig_cycles = r->trig * clock,
                              .call_time = r->call,
                              .copy_bandwidth = 1 / r->copy};
}

bool rate_sample_take(const struct run_spec *spec, struct host_comm *comm, int samples,
                      double seconds, struct run_cache *cache, struct rate_sample *s, struct err *e)
{
    const struct real_order order = {samples, seconds, 1};
    struct arena *a = arena_create();
    struct real_result *r = TAKE(a, 1, struct real_result);
    bool ok = run_real(spec, NULL, comm, &order, cache, a, r, e);
    if (ok && r->status != RUN_OK)
        ok = err_set(e, ERR_CHECK, "%s: %.600s", spec->kernel.name, r->text);
    if (ok) {
        *s = (struct rate_sample){.work = r->work,
                                  .seconds = r->time.median,
                                  .samples = r->nsample,
                                  .disturbed = r->disturbed,
                                  .before = r->burst[0].before,
                                  .after = r->burst[0].after};
        snprintf(s->what, sizeof s->what, "%.24s, n = %d", spec->kernel.name, spec->model.nbody);
        if (r->nsample - r->disturbed < LEAST_GOOD)
            ok = err_set(e, ERR_BUSY,
                         "%s: of %d repetitions only %d were undisturbed, fewer than %d: other "
                         "programs take the processors; try again when the computer is quieter",
                         s->what, r->nsample, r->nsample - r->disturbed, LEAST_GOOD);
    }
    arena_destroy(a);
    return ok;
}

static void lesser(double *kept, double again)
{
    if (*kept <= 0 || again < *kept) *kept = again;
}

void rates_loops(struct rates *r)
{
    lesser(&r->copy, host_speed_least(HOST_COPY));
    lesser(&r->flop, host_speed_least(HOST_MULTIPLY_ADD));
    lesser(&r->instruction, host_speed_least(HOST_CHAIN));
    lesser(&r->sqrt, root_price());
    lesser(&r->trig, angle_price());
}
