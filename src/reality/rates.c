/* rates.c - see rates.h. Kernels run by the same path as real runs (run/real.h), so what surrounds
 * a kernel there is part of the fixed cost here. */
#include "reality/rates.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/progress.h"
#include "host/host_load.h"
#include "linalg/angle.h"
#include "reality/fit.h"
#include "run/real.h"

enum {
    UNKNOWNS = 3,
    CHAIN = 1000,
    ROWS = 6,
    PER_PRODUCT = 5,
    ANGLES = 512,
    COPY_BYTES = 16384,
    COPY_ROUNDS = 64,
    COPY_SAMPLES = 200,
    LEAST_GOOD = 3
};

/* Copies are too few in kernels on one rank to be fitted: a block is copied to and fro, within the
 * first cache, as packing does it. */
static double copy_price(void)
{
    char *a = memory_zeroed(COPY_BYTES, 1), *b = memory_zeroed(COPY_BYTES, 1);
    double least = INFINITY;
    for (int i = 0; i < COPY_SAMPLES; i++) {
        const int64_t switches = host_switches(), begin = host_clock_ns();
        for (int k = 0; k < COPY_ROUNDS; k++) {
            memcpy(k % 2 ? a : b, k % 2 ? b : a, COPY_BYTES);
            __asm__ volatile("" ::: "memory"); /* the copy is made, although nobody reads it */
        }
        const double took = (double)(host_clock_ns() - begin) * 1e-9;
        if (host_switches() == switches) least = fmin(least, took / COPY_ROUNDS / COPY_BYTES);
    }
    free(a);
    free(b);
    return least;
}

/* Least time of one operation in a loop in which each waits for the one before, as pivots and
 * angles do in kernels [s]. */
static double root_price(void)
{
    double least = INFINITY;
    volatile double seed = 2;
    for (int i = 0; i < COPY_SAMPLES; i++) {
        double x = seed;
        const int64_t switches = host_switches(), begin = host_clock_ns();
        for (int k = 0; k < CHAIN; k++) x = sqrt(x + 1);
        const double took = (double)(host_clock_ns() - begin) * 1e-9;
        seed = x > 1 ? 2 : 3; /* the result is used */
        if (host_switches() == switches) least = fmin(least, took / CHAIN);
    }
    return least;
}

/* Angles of many joints are independent of each other, and a loop over them runs side by side. */
static double angle_price(void)
{
    double least = INFINITY, angle[ANGLES], sine[ANGLES], cosine[ANGLES];
    for (int k = 0; k < ANGLES; k++) angle[k] = 0.01 * k;
    for (int i = 0; i < COPY_SAMPLES; i++) {
        const int64_t switches = host_switches(), begin = host_clock_ns();
        for (int k = 0; k < ANGLES; k++) angle_sincos(angle[k], &sine[k], &cosine[k]);
        const double took = (double)(host_clock_ns() - begin) * 1e-9;
        __asm__ volatile("" ::"r"(sine), "r"(cosine) : "memory"); /* the results are used */
        /* Two evaluations each, as they are counted. */
        if (host_switches() == switches) least = fmin(least, took / ANGLES / 2);
    }
    return least;
}

/* Products of a 6x6 matrix and a vector, as the operators of kernels are made of, within the first
 * cache. */
static double flop_price(void)
{
    double least = INFINITY, a[ROWS * ROWS], x[ROWS], y[ROWS];
    for (int k = 0; k < ROWS * ROWS; k++) a[k] = 1.0 / (k + 1);
    for (int k = 0; k < ROWS; k++) x[k] = 1;
    for (int i = 0; i < COPY_SAMPLES; i++) {
        const int64_t switches = host_switches(), begin = host_clock_ns();
        for (int round = 0; round < CHAIN; round++) {
            for (int r = 0; r < ROWS; r++) {
                double sum = 0;
                for (int k = 0; k < ROWS; k++) sum += a[r * ROWS + k] * x[k];
                y[r] = sum;
            }
            __asm__ volatile("" ::"r"(y), "r"(a), "r"(x) : "memory"); /* each round is made */
        }
        const double took = (double)(host_clock_ns() - begin) * 1e-9;
        if (host_switches() == switches) least = fmin(least, took / CHAIN / (2 * ROWS * ROWS));
    }
    return least;
}

/* A scalar product, whose sum waits for each product: five instructions an element (load, load and
 * multiply, add, advance, branch), as node_cost.c counts them where no file says what one costs. */
static double instruction_price(void)
{
    double least = INFINITY, x[ANGLES], y[ANGLES];
    volatile double kept = 0;
    for (int k = 0; k < ANGLES; k++) x[k] = y[k] = 1.0 / (k + 1);
    for (int i = 0; i < COPY_SAMPLES; i++) {
        const int64_t switches = host_switches(), begin = host_clock_ns();
        double sum = 0;
        for (int k = 0; k < ANGLES; k++) sum += x[k] * y[k];
        kept = sum;
        const double took = (double)(host_clock_ns() - begin) * 1e-9;
        __asm__ volatile("" ::"r"(x), "r"(y) : "memory");
        if (host_switches() == switches) least = fmin(least, took / ANGLES / PER_PRODUCT);
    }
    return kept >= 0 ? least : INFINITY;
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
    const struct real_order order = {samples, seconds};
    struct arena *a = arena_create();
    struct real_result *r = TAKE(a, 1, struct real_result);
    bool ok = run_real(spec, NULL, comm, &order, cache, a, r, e);
    if (ok && r->status != RUN_OK)
        ok = err_set(e, ERR_CHECK, "%s: %.600s", spec->kernel.name, r->text);
    if (ok) {
        *s = (struct rate_sample){.work = r->work,
                                  .seconds = r->time.median,
                                  .samples = r->nsample,
                                  .disturbed = r->disturbed};
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

bool rates_measure(const struct plan *p, int samples, double seconds, bool quiet, struct rates *out,
                   struct err *e)
{
    struct host_comm *comm = host_comm_create(NULL, e);
    struct run_cache *cache = run_cache_create();
    struct progress progress = progress_make("kernels", p->nrun, quiet);
    memset(out, 0, sizeof *out);
    bool ok = true;
    for (int i = 0; ok && i < p->nrun && i < RATES_MOST; i++) {
        ok = rate_sample_take(&p->run[i], comm, samples, seconds, cache, &out->sample[out->n], e);
        out->n += ok;
        progress_show(&progress, i + 1);
    }
    progress_end(&progress);
    out->copy = copy_price();
    out->flop = flop_price();
    out->instruction = instruction_price();
    out->sqrt = root_price();
    out->trig = angle_price();
    run_cache_destroy(cache);
    host_comm_destroy(comm);
    return ok && (rates_fit(out) ||
                  err_set(e, ERR_DATA, "%d points are too few to fit rates to", out->n));
}
