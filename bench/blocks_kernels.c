/* blocks_kernels.c - small loops of several kinds, which bench_blocks compiles and times. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

enum { LONG = 1 << 21, SHORT = 1 << 10, SIDE = 192, CELLS = 1 << 18, BODIES = 400 };

static double a[LONG], b[LONG], c[LONG];
static double left[SIDE][SIDE], right[SIDE][SIDE], product[SIDE][SIDE];
static int32_t sorted[CELLS], next[CELLS], column[5 * CELLS];
static double body[BODIES][3], pull[BODIES][3];
static uint32_t seed = 1;

volatile double result;

static uint32_t drawn(void) { return seed = seed * 1664525u + 1013904223u; }

/* Numbers for all kernels; without them a compiler knows that nothing but zeros is read. */
void fill(void);
void fill(void)
{
    for (int i = 0; i < LONG; i++) b[i] = drawn() * 1e-9, c[i] = drawn() * 1e-9;
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++) left[i][j] = drawn() * 1e-9, right[i][j] = drawn() * 1e-9;
    for (int i = 0; i < BODIES; i++)
        for (int k = 0; k < 3; k++) body[i][k] = drawn() * 1e-9;
    for (int i = 0; i < 5 * CELLS; i++) column[i] = (int)(drawn() % CELLS);
    for (int i = 0; i < CELLS; i++) next[i] = i;
    for (int i = CELLS - 1; i > 0; i--) { /* one cycle through all, by Sattolo's algorithm */
        int j = (int)(drawn() % (uint32_t)i), t = next[i];
        next[i] = next[j], next[j] = t;
    }
}

void triad_memory(void);
void triad_cache(void);
void dot(void);
void matrix_product(void);
void stencil(void);
void sparse_product(void);
void pull_bodies(void);
void sines(void);
void quicksort(void);
void chase(void);
void fibonacci(void);
void histogram(void);

static void triad(int n, int rounds)
{
    for (int r = 0; r < rounds; r++) {
        for (int i = 0; i < n; i++) a[i] = b[i] + 3.0 * c[i];
        result = a[r];
    }
}

void triad_memory(void) { triad(LONG, 4); }
void triad_cache(void) { triad(SHORT, 4 * (LONG / SHORT)); }

void dot(void)
{
    double sum = 0;
    for (int r = 0; r < 4 * (LONG / SHORT); r++)
        for (int i = 0; i < SHORT; i++) sum += a[i] * b[i];
    result = sum;
}

void matrix_product(void)
{
    for (int i = 0; i < SIDE; i++)
        for (int k = 0; k < SIDE; k++)
            for (int j = 0; j < SIDE; j++) product[i][j] += left[i][k] * right[k][j];
    result = product[3][4];
}

void stencil(void)
{
    enum { N = 512 };
    for (int r = 0; r < 20; r++)
        for (int i = 1; i < N - 1; i++)
            for (int j = 1; j < N - 1; j++)
                b[i * N + j] = 0.25 * (a[i * N + j - 1] + a[i * N + j + 1] + a[(i - 1) * N + j] +
                                       a[(i + 1) * N + j]);
    result = b[N + 1];
}

void sparse_product(void)
{
    for (int r = 0; r < 3; r++)
        for (int i = 0; i < CELLS; i++) {
            double sum = 0;
            for (int k = 0; k < 5; k++) sum += c[5 * i + k] * a[column[5 * i + k]];
            b[i] = sum;
        }
    result = b[5];
}

void pull_bodies(void)
{
    for (int r = 0; r < 10; r++)
        for (int i = 0; i < BODIES; i++)
            for (int j = 0; j < BODIES; j++) {
                double x = body[i][0] - body[j][0] + 0.1, y = body[i][1] - body[j][1],
                       z = body[i][2] - body[j][2];
                double d = x * x + y * y + z * z, f = 1 / (d * sqrt(d));
                pull[i][0] += f * x, pull[i][1] += f * y, pull[i][2] += f * z;
            }
    result = pull[1][0];
}

void sines(void)
{
    double sum = 0;
    for (int i = 0; i < 1000000; i++) sum += sin(1e-3 * i);
    result = sum;
}

static void sort(int32_t *x, int n)
{
    while (n > 12) {
        int32_t pivot = x[n / 2];
        int i = 0, j = n - 1;
        for (;; i++, j--) {
            while (x[i] < pivot) i++;
            while (pivot < x[j]) j--;
            if (i >= j) break;
            int32_t t = x[i];
            x[i] = x[j], x[j] = t;
        }
        sort(x, i);
        x += i, n -= i;
    }
    for (int i = 1; i < n; i++) {
        int32_t t = x[i];
        int j = i;
        for (; j > 0 && x[j - 1] > t; j--) x[j] = x[j - 1];
        x[j] = t;
    }
}

void quicksort(void)
{
    for (int i = 0; i < CELLS; i++) sorted[i] = (int32_t)(drawn() >> 1);
    sort(sorted, CELLS);
    result = sorted[9];
}

void chase(void)
{
    int at = 0;
    for (int i = 0; i < 4 * CELLS; i++) at = next[at];
    result = at;
}

static int numbered(int n) { return n < 2 ? n : numbered(n - 1) + numbered(n - 2); }
void fibonacci(void) { result = numbered(30); }

void histogram(void)
{
    static int32_t count[256];
    for (int i = 0; i < 1 << 22; i++) {
        uint32_t x = drawn();
        count[(x >> 13) & 255] += (x & 64) ? 1 : 2;
    }
    result = count[17];
}
