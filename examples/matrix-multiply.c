/* matrix-multiply.c - C = A B for square matrices of n rows, by three algorithms:
 *   rows    strips of rows of A and C on each rank; the strips of B go round a ring (1-D)
 *   summa   square blocks; blocks of A go along rows and of B along columns of ranks (2-D, van de
 * Geijn and Watts 1997) cannon  square blocks that shift by one place a step (Cannon 1969) The
 * latter two need a square number of ranks whose root divides n. */
#include <mimdsim/program.h>
#include <string.h>

enum { ROWS, SUMMA, CANNON };

static int64_t n = 96;
static int method = ROWS;

static double a_at(int64_t i, int64_t j) { return (double)((i * 3 + j * 5) % 17) - 8; }
static double b_at(int64_t i, int64_t j) { return (double)((i * 7 + j * 2) % 13) - 6; }

/* c (m x w) += a (m x k) b (k x w); rows of a, b, c are lda, ldb, ldc apart. */
static void add_product(int64_t m, int64_t k, int64_t w, const double *a, int64_t lda,
                        const double *b, int64_t ldb, double *c, int64_t ldc)
{
    for (int64_t i = 0; i < m; i++)
        for (int64_t l = 0; l < k; l++)
            for (int64_t j = 0; j < w; j++) c[i * ldc + j] += a[i * lda + l] * b[l * ldb + j];
}

static void fill(double *x, int64_t i0, int64_t m, int64_t j0, int64_t w,
                 double (*at)(int64_t, int64_t))
{
    for (int64_t i = 0; i < m; i++)
        for (int64_t j = 0; j < w; j++) x[i * w + j] = at(i0 + i, j0 + j);
}

static int64_t first(int rank, int p) { return n * rank / p; }

static void rows(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    const int64_t i0 = first(me, p), m = first(me + 1, p) - i0, most = (n + p - 1) / p;
    double *a = comm_memory(c, m * n * 8), *product = comm_memory(c, m * n * 8);
    double *b = comm_memory(c, most * n * 8), *next = comm_memory(c, most * n * 8);
    fill(a, i0, m, 0, n, a_at);
    fill(b, i0, m, 0, n, b_at);
    for (int step = 0; step < p; step++) {
        /* The strip that is here now, and the one that comes from the right. */
        const int from = (me + step) % p, then = (from + 1) % p;
        const int64_t k0 = first(from, p), k = first(from + 1, p) - k0;
        struct comm_request r = {0};
        comm_stage(c, 0);
        if (step < p - 1) {
            comm_send(c, (me + p - 1) % p, step, b, k * n * 8);
            comm_irecv(c, (me + 1) % p, step, next, (first(then + 1, p) - first(then, p)) * n * 8,
                       &r);
        }
        comm_stage(c, 1);
        add_product(m, k, n, a + k0, n, b, n, product, n);
        comm_stage(c, 0);
        comm_wait(c, &r);
        double *t = b;
        b = next;
        next = t;
    }
    comm_publish(c, 0, i0 * n, m * n, product);
}

/* One block for another of the same size, sent to `to` and received from `from`. */
static void exchange(struct comm *c, int to, int from, int tag, double **x, double **spare,
                     int64_t bytes)
{
    comm_send(c, to, tag, *x, bytes);
    comm_recv(c, from, tag, *spare, bytes);
    double *t = *x;
    *x = *spare;
    *spare = t;
}

static void blocks(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    int q = 1;
    while (q * q < p) q++;
    if (q * q != p || n % q)
        comm_fail(c, "%d ranks: expected a square number whose root divides n = %ld", p, (long)n);
    const int row = me / q, column = me % q;
    const int64_t m = n / q, bytes = m * m * 8;
    double *a = comm_memory(c, bytes), *b = comm_memory(c, bytes), *product = comm_memory(c, bytes);
    double *spare = comm_memory(c, bytes), *other = comm_memory(c, bytes);
    /* Cannon's skew costs nothing here: each rank makes the blocks with which it begins. */
    const int skew = method == CANNON ? row + column : column,
              skew_b = method == CANNON ? row + column : row;
    fill(a, row * m, m, skew % q * m, m, a_at);
    fill(b, skew_b % q * m, m, column * m, m, b_at);
    for (int step = 0; step < q; step++) {
        double *left = a, *right = b;
        comm_stage(c, 0);
        if (method == SUMMA) {
            /* Who has block `step` of this row and of this column sends it to the others. */
            for (int i = 0; i < q; i++) {
                if (column == step && i != column) comm_send(c, row * q + i, step, a, bytes);
                if (row == step && i != row) comm_send(c, i * q + column, q + step, b, bytes);
            }
            if (column != step) comm_recv(c, row * q + step, step, left = spare, bytes);
            if (row != step) comm_recv(c, step * q + column, q + step, right = other, bytes);
        }
        comm_stage(c, 1);
        add_product(m, m, m, left, m, right, m, product, m);
        comm_stage(c, 0);
        if (method == CANNON && step < q - 1) {
            exchange(c, row * q + (column + q - 1) % q, row * q + (column + 1) % q, 2 * step, &a,
                     &spare, bytes);
            exchange(c, (row + q - 1) % q * q + column, (row + 1) % q * q + column, 2 * step + 1,
                     &b, &spare, bytes);
        }
    }
    for (int64_t i = 0; i < m; i++)
        comm_publish(c, 0, (row * m + i) * n + column * m, m, product + i * m);
}

static void run(struct comm *c)
{
    if (method == ROWS) rows(c);
    else blocks(c);
}

static void serial(struct comm *c)
{
    double *a = comm_memory(c, n * n * 8), *b = comm_memory(c, n * n * 8),
           *product = comm_memory(c, n * n * 8);
    fill(a, 0, n, 0, n, a_at);
    fill(b, 0, n, 0, n, b_at);
    add_product(n, n, n, a, n, b, n, product, n);
    comm_publish(c, 0, 0, n * n, product);
}

static void estimate(int ranks, struct mimdsim_estimate *out)
{
    int q = 1;
    while (q * q < ranks) q++;
    const double p = ranks, steps = method == SUMMA ? p * 2 * (q - 1) : p * 2 * (q - 1);
    out->messages = method == ROWS ? p * (p - 1) : steps;
    out->bytes =
        method == ROWS ? 8.0 * (double)(n * n) * (p - 1) : steps * 8.0 * (double)(n * n) / p;
    out->flops = 2.0 * (double)(n * n) * (double)n;
    out->rank_bytes = 5 * 8.0 * (double)(n * n) / p;
}

PROGRAM(.title = "matrix multiplication: strips in a ring, SUMMA, Cannon",
        .parameter = {PROGRAM_WHOLE(n, 1, 4096, "rows of the matrices"),
                      PROGRAM_CHOICE(method, "rows|summa|cannon", "algorithm")},
        .stage = {"messages", "multiply"}, .output = {"product"}, .run = run,
        .serial = {{"three loops", serial}}, .tolerance = 1e-12, .estimate = estimate);
