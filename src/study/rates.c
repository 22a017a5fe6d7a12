/* rates.c - small serial benchmark codes executed with every operation counted (rates.h).
 *
 * The codes are written as the benchmarks are: LINPACK by columns with daxpy, STREAM in one
 * pass. Their counts are what a node's prices are multiplied with; a better algorithm would
 * measure another code. */
#include "study/rates.h"

#include <math.h>

#include "base/arena.h"
#include "base/check.h"

/* ---- LINPACK ---- */

/* Bytes that an element loads and stores, 8 for each number: y, x and y again; x and x again; x;
 * two vectors. */
enum { DAXPY_BYTES = 24, DSCAL_BYTES = 16, IDAMAX_BYTES = 8, INNER_BYTES = 16 };

/* y += s x. As in the benchmark's library, a multiplier of zero ends the call at once. */
static void daxpy(int n, double s, const double *x, double *y, struct work *w)
{
    w->call++;
    if (n <= 0 || s == 0) return;
    for (int i = 0; i < n; i++) y[i] += s * x[i];
    w->flop += 2 * (uint64_t)n;
    w->moved += DAXPY_BYTES * (uint64_t)n;
}

/* x *= s */
static void dscal(int n, double s, double *x, struct work *w)
{
    w->call++;
    for (int i = 0; i < n; i++) x[i] *= s;
    w->flop += (uint64_t)n;
    w->moved += DSCAL_BYTES * (uint64_t)n;
}

/* The index of the largest |x[i]|, the first of equals. Comparisons are no floating-point
 * operations by the benchmark's rule. */
static int idamax(int n, const double *x, struct work *w)
{
    int largest = 0;
    w->call++;
    w->moved += IDAMAX_BYTES * (uint64_t)n;
    for (int i = 1; i < n; i++)
        if (fabs(x[i]) > fabs(x[largest])) largest = i;
    return largest;
}

/* Moving numbers is not counted: the benchmark's rule counts arithmetic. */
static void exchange(double *x, int i, int k)
{
    double t = x[i];
    x[i] = x[k];
    x[k] = t;
}

/* LU factors of a (n x n, column-major) in place, with partial pivoting: LINPACK's dgefa. Work
 * goes by columns (daxpy), as the benchmark does on every machine. */
static void dgefa(double *a, int n, int *pivot, struct work *w)
{
    for (int k = 0; k < n - 1; k++) {
        double *column = a + (size_t)k * (size_t)n;
        /* Partial pivoting: the largest of the column below the diagonal. */
        int l = pivot[k] = k + idamax(n - k, column + k, w);
        exchange(column, l, k);
        /* -1 / pivot, the multipliers' common factor. */
        w->div++;
        dscal(n - k - 1, -1 / column[k], column + k + 1, w);
        /* Rank-1 update of all later columns, which exchange their rows first. */
        for (int j = k + 1; j < n; j++) {
            double *other = a + (size_t)j * (size_t)n;
            exchange(other, l, k);
            daxpy(n - k - 1, other[k], column + k + 1, other + k + 1, w);
        }
    }
    pivot[n - 1] = n - 1;
}

/* The solution in place of b, from the factors: first with L and the row exchanges, then with U. */
static void dgesl(const double *a, int n, const int *pivot, double *b, struct work *w)
{
    for (int k = 0; k < n - 1; k++) {
        exchange(b, pivot[k], k);
        daxpy(n - k - 1, b[k], a + (size_t)k * (size_t)n + k + 1, b + k + 1, w);
    }
    for (int k = n - 1; k >= 0; k--) {
        const double *column = a + (size_t)k * (size_t)n;
        b[k] /= column[k];
        w->div++;
        daxpy(k, -b[k], column, b, w);
    }
}

/* The benchmark's matrix by its own random numbers, and the right-hand side whose solution is
 * all ones: so that rate_linpack can check what it computed. */
static void matgen(double *a, double *b, int n)
{
    int seed = 1325;
    for (int i = 0; i < n; i++) b[i] = 0;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            /* Lehmer's generator; the product stays below 2^28. */
            seed = 3125 * seed % 65536;
            /* numbers in -2 .. 2, as in the original */
            a[(size_t)j * (size_t)n + (size_t)i] = (seed - 32768.0) / 16384.0;
            b[i] += a[(size_t)j * (size_t)n + (size_t)i];
        }
}

/* What the benchmark divides by the time, whatever was executed: 2 n^3 / 3 + 2 n^2. */
static double nominal_linpack(double n) { return 2 * n * n * n / 3 + 2 * n * n; }

/* Operations of dgefa, then of dgesl, without executing them. A step with m columns left has a
 * pivot search, a scaling (m flops) and m updates of 2 m flops, and one update of b; each step
 * back has one. */
struct rate_count rate_linpack_summed(int n)
{
    struct rate_count c = {.nominal = nominal_linpack(n)};
    for (uint64_t m = (uint64_t)n - 1; m > 0; m--) {
        c.work.div++;
        c.work.call += 2 + m + 1;
        c.work.flop += m + 2 * m * m + 2 * m;
        c.work.moved += IDAMAX_BYTES * (m + 1) + DSCAL_BYTES * m + DAXPY_BYTES * (m * m + m);
    }
    for (uint64_t m = 0; m < (uint64_t)n; m++) {
        c.work.div++;
        c.work.call++;
        c.work.flop += 2 * m;
        c.work.moved += DAXPY_BYTES * m;
    }
    return c;
}

/* Executed up to RATE_EXECUTED: the counts are then those of a program that gave the right
 * answer. */
struct rate_count rate_linpack(int n)
{
    if (n > RATE_EXECUTED) return rate_linpack_summed(n);
    struct rate_count c = {.nominal = nominal_linpack(n)};
    struct arena *memory = arena_create();
    double *a = TAKE(memory, size_product(n, n), double), *b = TAKE(memory, n, double);
    int *pivot = TAKE(memory, n, int);
    matgen(a, b, n);
    dgefa(a, n, pivot, &c.work);
    dgesl(a, n, pivot, b, &c.work);
    /* a wrong solution would mean counts of another algorithm */
    for (int i = 0; i < n; i++) CHECK(fabs(b[i] - 1) < 1e-6);
    arena_destroy(memory);
    return c;
}

/* One pass of STREAM: a = b, a = q b, a = b + s, a = b + q s, with q = 3. */

/* a of n elements from b, or from b and s. */
static void stream_pass(enum rate_stream kind, int n, double *a, const double *b, const double *s)
{
    switch (kind) {
    case RATE_COPY:
        for (int i = 0; i < n; i++) a[i] = b[i];
        break;
    case RATE_SCALE:
        for (int i = 0; i < n; i++) a[i] = 3 * b[i];
        break;
    case RATE_ADD:
        for (int i = 0; i < n; i++) a[i] = b[i] + s[i];
        break;
    case RATE_TRIAD:
        for (int i = 0; i < n; i++) a[i] = b[i] + 3 * s[i];
        break;
    }
}

/* The pass is executed and checked, its operations follow from the kind. */
struct rate_count rate_stream(enum rate_stream kind, int n)
{
    /* Flops per element, vectors read or written, and the result for b = 2, s = 5: kept so that
     * the pass cannot be wrong unnoticed. */
    static const int flops[] = {0, 1, 1, 2}, vectors[] = {2, 2, 3, 3}, result[] = {2, 6, 7, 17};
    struct arena *memory = arena_create();
    double *a = TAKE(memory, n, double), *b = TAKE(memory, n, double), *s = TAKE(memory, n, double);
    for (int i = 0; i < n; i++) {
        b[i] = 2;
        s[i] = 5;
    }
    stream_pass(kind, n, a, b, s);
    for (int i = 0; i < n; i++) CHECK(a[i] == result[kind]);
    arena_destroy(memory);
    /* A node's price is for a byte copied, which is read and written: half of STREAM's bytes. */
    uint64_t bytes = (uint64_t)n * (uint64_t)vectors[kind] * sizeof(double);
    return (struct rate_count){
        .nominal = (double)bytes,
        .work = {.call = 1,
                 .flop = (uint64_t)(n * flops[kind]),
                 .bytes = bytes / 2,
                 .moved = bytes}};
}

/* Two flops per element; nothing is stored, so no bytes are copied. */
struct rate_count rate_inner_product(int n)
{
    struct arena *memory = arena_create();
    double *x = TAKE(memory, n, double), *y = TAKE(memory, n, double), sum = 0;
    for (int i = 0; i < n; i++) {
        x[i] = i;
        y[i] = 0.5;
    }
    for (int i = 0; i < n; i++) sum += x[i] * y[i];
    /* A sum of halves, exact in double for every n that is asked for (at most 2^20). */
    CHECK(sum == 0.25 * n * (n - 1.0));
    arena_destroy(memory);
    return (struct rate_count){.nominal = 2.0 * n,
                               .work = {.call = 1,
                                        .flop = 2 * (uint64_t)n,
                                        .moved = INNER_BYTES * (uint64_t)n}};
}

/* The rate is nominal work over simulated time of the executed work. A node without costs has an
 * infinite rate. */
double rate_of(const struct node_spec *node, const struct rate_count *count)
{
    const struct node_cost cost = node_cost_make(node);
    return rate_at(&cost, count);
}

/* Of any costs: those of a cache, or of a memory that others use, too. */
double rate_at(const struct node_cost *cost, const struct rate_count *count)
{
    int64_t ps = node_cost_ps(cost, &count->work);
    return ps > 0 ? count->nominal / ((double)ps * 1e-12) : INFINITY;
}
