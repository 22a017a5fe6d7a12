/* probe_collective.c - collectives, rings and the effective bandwidth of a simulated machine
 * (probe_collective.h). */
#include "study/probe_collective.h"

#include <math.h>
#include <string.h>

#include "base/arena.h"
#include "run/run.h"

enum { EFFECTIVE_SIZES = 21, SMALL_SIZES = 13, PATTERNS = 6 };

/* Seconds that `kernel` measures, with the collective's algorithm that the machine takes by
 * itself and without noise: a published number is a best or typical one. */
static bool seconds(const struct machine_spec *m, const char *kernel, int64_t bytes, int ranks,
                    int ring_ranks, double *value, struct err *e)
{
    struct run_spec spec = {.machine = *m, .nrank = ranks, .seed = 1};
    struct run_result r;
    struct arena *a = arena_create();
    strncpy(spec.kernel.name, kernel, sizeof spec.kernel.name - 1);
    strncpy(spec.kernel.algorithm, "auto", sizeof spec.kernel.algorithm - 1);
    spec.kernel.message_bytes = bytes;
    /* ranks per ring of a pattern; 0: one ring of all */
    spec.kernel.ring_ranks = ring_ranks;
    spec.kernel.repeat = 1;
    spec.machine.noise = (struct noise_spec){0};
    bool ok = run_one(&spec, a, &r, e);
    if (ok && r.status != RUN_OK) ok = err_set(e, ERR_CONFIG, "%s: %s", m->name, r.text);
    if (ok) *value = r.measured_s;
    arena_destroy(a);
    return ok;
}

/* Bytes per second that all ranks together send to their two neighbours. */
static bool ring_rate(const struct machine_spec *m, const char *kernel, int64_t bytes, int ranks,
                      int ring_ranks, double *rate, struct err *e)
{
    double t;
    if (!seconds(m, kernel, bytes, ranks, ring_ranks, &t, e)) return false;
    /* Each rank sends a message to the left and one to the right. */
    *rate = 2.0 * ranks * (double)bytes / t;
    return true;
}

/* The sizes of b_eff (Koniges, Rabenseifner, Solchenbach 2001): 13 powers of two from 1 B to 4
 * KiB, then 8 in equal ratios up to the largest. */
static int64_t effective_size(int k, int64_t largest)
{
    if (k < SMALL_SIZES) return (int64_t)1 << k;
    double small = (double)((int64_t)1 << (SMALL_SIZES - 1)), part = (double)(k - SMALL_SIZES + 1);
    return (int64_t)floor(
        small * pow((double)largest / small, part / (EFFECTIVE_SIZES - SMALL_SIZES)) + 0.5);
}

/* Logarithmic mean over the ring patterns of one order, each the mean over the sizes. b_eff has
 * six patterns: rings of 2, 4, 8, max(16, P/4), max(32, P/2) and P ranks. */
static bool order_rate(const struct machine_spec *m, const char *kernel, int64_t largest, int ranks,
                       double *rate, struct err *e)
{
    /* The two patterns in the middle, with the least sizes that the benchmark prescribes. */
    const int quarter = ranks / 4 > 16 ? ranks / 4 : 16, half = ranks / 2 > 32 ? ranks / 2 : 32;
    const int ring[PATTERNS] = {2, 4, 8, quarter, half, ranks};
    double logarithm = 0;
    for (int p = 0; p < PATTERNS; p++) {
        double sum = 0, one;
        for (int k = 0; k < EFFECTIVE_SIZES; k++) {
            if (!ring_rate(m, kernel, effective_size(k, largest), ranks, ring[p], &one, e))
                return false;
            sum += one;
        }
        logarithm += log(sum / EFFECTIVE_SIZES) / PATTERNS;
    }
    *rate = exp(logarithm);
    return true;
}

/* b_eff is the logarithmic mean of its value for ranks in order and for random neighbours. */
static bool effective_bandwidth(const struct machine_spec *m, int64_t largest, int ranks,
                                double *rate, struct err *e)
{
    double in_order, random;
    if (!order_rate(m, "ring", largest, ranks, &in_order, e) ||
        !order_rate(m, "random-ring", largest, ranks, &random, e))
        return false;
    *rate = sqrt(in_order * random);
    return true;
}

/* One quantity of many ranks; `bytes` is the message size, for b-eff the largest one. */
bool probe_collective(const struct machine_spec *m, enum probe_quantity q, int64_t bytes, int ranks,
                      double *value, struct err *e)
{
    if (ranks < 2)
        return err_set(e, ERR_CONFIG, "%s: a %s of %d ranks", m->name, probe_name(q), ranks);
    if (q == PROBE_B_EFF) return effective_bandwidth(m, bytes, ranks, value, e);
    if (q == PROBE_RING || q == PROBE_RANDOM_RING)
        return ring_rate(m, probe_name(q), bytes, ranks, 0, value, e);
    return seconds(m, probe_name(q), bytes, ranks, 0, value, e);
}
