/* calibrate-code.c - what `mimdsim calibrate` runs to learn what the code of programs in one file
 * costs: loops of several kinds. Their data are too large for a first cache and fit into a second
 * one, as those of many programs do on one processor. Some loops wait for their last result, some
 * load and store much, some compute much with what they have, in numbers one by one or in vectors.
 */
#include <math.h>
#include <mimdsim/program.h>

enum { SUM, SCALED, BLUR, VECTOR, RECURRENCE, POLYNOMIAL, DRAW, CHASE, COUNT, SCAN, RATIO, ROOT,
       LOADS, MORE_LOADS, ROWS, MIX, ADDITIONS, PRODUCTS, POWERS, SHIFTED, SERIES, NESTED };
enum { MOST = 16384, RING = 512, NEAR = 768 };

/* Places of different arrays are not a multiple of 4 KiB apart, where a load would be taken for one
 * of what was stored last. */
enum { APART = 72 };

static int64_t length = 12288, rounds = 20;
static int loop = SUM;

static double *a, *b, *c; /* (length) */
static int32_t *next;

/* Values that a compiler does not know, and that stay finite through all rounds. */
static void fill(int64_t n)
{
    int64_t after = 149;
    for (int64_t i = 0; i < n; i++, after++) {
        a[i] = 1 - 0.001 * (double)i;
        b[i] = 0.5 + (double)(i & 7) * 0.0625;
        c[i] = (double)(i & 63) * 0.01;
        /* One ring through the first 512 places, as 149 and 512 have no common factor. */
        if (after >= RING) after -= RING;
        next[i] = (int32_t)after;
    }
}

/* Waits for its sum. Each loop begins with a number of its own, so that none is left out as done.
 */
static double sum(int64_t n, double by)
{
    double x = by;
    for (int64_t i = 0; i < n; i++) x += a[i] * b[i];
    return x;
}

/* Nothing waits; two loads and a store each. */
static double scaled(int64_t n, double by)
{
    for (int64_t i = 0; i < n; i++) c[i] = c[i] * 0.5 + by * a[i];
    return c[n - 1];
}

static double blur(int64_t n, double by)
{
    for (int64_t i = 1; i < n - 1; i++) c[i] = by * (a[i - 1] + a[i + 1]) + 0.5 * b[i];
    return c[n / 2];
}

/* The number of times is known, so that gcc takes two numbers at once. */
static double vector(double by)
{
    double *restrict z = c;
    for (int i = 0; i < 3 * MOST / 4; i++) z[i] = by * a[i] + b[i];
    return z[5];
}

/* Each value waits for a product and a sum. */
static double recurrence(int64_t n, double by)
{
    double x = by;
    for (int64_t i = 0; i < n; i++) x = 0.75 * x + 0.125;
    return x;
}

/* Chains of their own side by side. */
static double polynomial(int64_t n, double by)
{
    for (int64_t i = 0; i < n; i++) {
        const double x = b[i];
        c[i] = (((((by * x + 0.2) * x - 0.3) * x + 0.4) * x - 0.5) * x + 0.6) * x;
    }
    return c[1];
}

/* Whole numbers: each waits for a product and a sum. */
static double draw(int64_t n, double by)
{
    uint64_t x = (uint64_t)by;
    for (int64_t i = 0; i < n; i++) x = x * UINT64_C(6364136223846793005) + 1442695040888963407u;
    return (double)(x >> 40);
}

/* Each address waits for the one before; all of them are in the first cache. */
static double chase(int64_t n, double by)
{
    int at = (int)by;
    for (int64_t i = 0; i < n; i++) at = next[at];
    return at;
}

/* A condition each, foreseen by most processors. */
static double count(int64_t n, double by)
{
    int64_t many = (int64_t)by;
    for (int64_t i = 0; i < n; i++) {
        if (i > 3 && i < n - 3) many += next[i] & 3;
        c[i] = (double)i;
    }
    return (double)many;
}

/* A sum that is stored on its way. */
static double scan(int64_t n, double by)
{
    double x = by;
    for (int64_t i = 0; i < n; i++) c[i] = x += b[i];
    return c[n - 1];
}

/* Divisions that do not wait for each other, and roots. */
static double ratio(int64_t n, double by)
{
    for (int64_t i = 0; i < n; i++) c[i] = (a[i] + by) / b[i];
    return c[n - 1];
}

static double root(int64_t n, double by)
{
    for (int64_t i = 0; i < n; i++) c[i] = sqrt(b[i] + by);
    return c[n - 1];
}

/* From here on the first numbers of each array alone, which stay in a first cache: loads
 * that wait for the processor's units, not for memory. */
static double loads(int64_t n, double by)
{
    for (int64_t k = 0; k < n; k += NEAR)
        for (int64_t i = 0; i < NEAR; i++) c[i] = by * (a[i] + a[i + 9]) + (b[i] + b[i + 9]);
    return c[5];
}

static double more_loads(int64_t n, double by)
{
    for (int64_t k = 0; k < n; k += NEAR)
        for (int64_t i = 0; i < NEAR; i++)
            c[i] = by * (a[i] + a[i + 9]) + (b[i] + b[i + 9]) + (a[i + 17] + b[i + 17]);
    return c[5];
}

/* Short loops, each with a sum of its own. */
static double rows(int64_t n, double by)
{
    for (int64_t k = 0; k < n; k += NEAR)
        for (int64_t i = 0; i + 5 <= NEAR; i += 5) {
            double x = by;
            for (int64_t j = 0; j < 5; j++) x += a[i + j] * b[j];
            c[i] = x;
        }
    return c[5];
}

/* Whole numbers that wait for nothing. */
static double mix(int64_t n, double by)
{
    for (int64_t i = 0; i < n; i++) {
        uint64_t x = (uint64_t)i ^ (uint64_t)i << 13;
        x ^= x >> 7;
        x += x << 17 | x >> 11;
        c[i] = (double)(int64_t)(x & 1023);
    }
    return c[5] + by;
}

/* Floating-point units: many additions, and many products, of what was loaded once. */
static double additions(int64_t n, double by)
{
    for (int64_t k = 0; k < n; k += NEAR)
        for (int64_t i = 0; i < NEAR; i++) {
            const double x = a[i], y = b[i];
            c[i] = ((x + y) + (x + by)) + ((y - by) + (x - 0.1)) + ((y + 0.2) - (0.3 - x)) + (0.4 - y);
        }
    return c[5];
}

static double products(int64_t n, double by)
{
    for (int64_t k = 0; k < n; k += NEAR)
        for (int64_t i = 0; i < NEAR; i++) {
            const double x = a[i], y = b[i];
            c[i] = ((x * y) * (x * by)) * ((y * 1.01) * (x * 0.9)) * ((y * 0.8) * (x * 1.2)) * (y * 1.1);
        }
    return c[5];
}

/* Each product waits for the one before. */
static double powers(int64_t n, double by)
{
    double x = 1 + by;
    for (int64_t i = 0; i < n; i++) x *= 0.999999;
    return x;
}

/* A short loop: few instructions, none of which waits. */
static double shifted(int64_t n, double by)
{
    for (int64_t k = 0; k < n; k += NEAR)
        for (int64_t i = 0; i < NEAR; i++) c[i] = a[i] + by;
    return c[5];
}

/* Long rounds whose instructions wait for each other, but not for those of another round: terms of
 * a series, of which each is a product of the one before, and a polynomial. */
static double series(int64_t n, double by)
{
    for (int64_t k = 0; k < n; k += NEAR)
        for (int64_t i = 0; i < NEAR; i++) {
            const double x = 0.9 * a[i];
            double term = by, s = by;
            for (int j = 0; j < 12; j++) s += term *= x;
            c[i] = s;
        }
    return c[5];
}

static double nested(int64_t n, double by)
{
    for (int64_t k = 0; k < n; k += NEAR)
        for (int64_t i = 0; i < NEAR; i++) {
            const double x = b[i];
            double s = (((((by * x + 0.2) * x - 0.3) * x + 0.4) * x - 0.5) * x + 0.6) * x - 0.7;
            s = (((((s * x + 0.2) * x - 0.3) * x + 0.4) * x - 0.5) * x + 0.6) * x - 0.7;
            c[i] = (((((s * x + 0.2) * x - 0.3) * x + 0.4) * x - 0.5) * x + 0.6) * x - 0.7;
        }
    return c[5];
}

static double once(int64_t n, double by)
{
    switch (loop) {
    case SUM:
        return sum(n, by);
    case SCALED:
        return scaled(n, by);
    case BLUR:
        return blur(n, by);
    case VECTOR:
        return vector(by);
    case RECURRENCE:
        return recurrence(n, by);
    case POLYNOMIAL:
        return polynomial(n, by);
    case DRAW:
        return draw(n, by);
    case CHASE:
        return chase(n, by);
    case COUNT:
        return count(n, by);
    case RATIO:
        return ratio(n, by);
    case ROOT:
        return root(n, by);
    case LOADS:
        return loads(n, by);
    case MORE_LOADS:
        return more_loads(n, by);
    case ROWS:
        return rows(n, by);
    case MIX:
        return mix(n, by);
    case ADDITIONS:
        return additions(n, by);
    case PRODUCTS:
        return products(n, by);
    case POWERS:
        return powers(n, by);
    case SHIFTED:
        return shifted(n, by);
    case SERIES:
        return series(n, by);
    case NESTED:
        return nested(n, by);
    default:
        return scan(n, by);
    }
}

static void run(struct comm *comm)
{
    double result = 0;
    /* Memory that is asked for so is there before the clock goes on. */
    a = comm_memory(comm, (MOST + APART) * 8);
    b = comm_memory(comm, (MOST + 2 * APART) * 8);
    c = comm_memory(comm, MOST * 8);
    next = comm_memory(comm, MOST * 4);
    fill(length);
    for (int64_t r = 0; r < rounds; r++) result += once(length, (double)(r % 3));
    comm_publish(comm, 0, 0, 1, &result);
}

PROGRAM(.title = "loops of several kinds",
        .parameter = {PROGRAM_WHOLE(length, RING, MOST, "numbers of a loop"),
                      PROGRAM_WHOLE(rounds, 1, 1e6, "how often it is made"),
                      PROGRAM_CHOICE(loop,
                                     "sum|scaled|blur|vector|recurrence|polynomial|draw|chase|"
                                     "count|scan|ratio|root|loads|more_loads|rows|mix|"
                                     "additions|products|powers|shifted|series|nested",
                                     "which loop")},
        .output = {"result"}, .run = run, .serial = {{"the same", run}}, .tolerance = 1e-12);
