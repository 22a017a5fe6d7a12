/* nbody-ring.c - gravity between all pairs of n bodies. Each rank has a block of bodies; copies of
 * the blocks go round a ring, and every rank adds what each passing block does to its own. */
#include <math.h>
#include <mimdsim/program.h>

static int64_t n = 512;

struct body {
    double x[3], mass;
};

static struct body make(int64_t i)
{
    const double t = (double)i;
    return (struct body){{cos(t) * (1 + 0.01 * t), sin(t) * (1 + 0.02 * t), 0.1 * cos(3 * t)},
                         1 + (double)(i % 7)};
}

/* What k bodies do to m others: acceleration, softened, so that a body does nothing to itself. */
static void attract(const struct body *to, int64_t m, const struct body *from, int64_t k, double *a)
{
    for (int64_t i = 0; i < m; i++)
        for (int64_t j = 0; j < k; j++) {
            double d[3], r2 = 1e-4;
            for (int l = 0; l < 3; l++) d[l] = from[j].x[l] - to[i].x[l], r2 += d[l] * d[l];
            const double s = from[j].mass / (r2 * sqrt(r2));
            for (int l = 0; l < 3; l++) a[3 * i + l] += s * d[l];
        }
}

static int64_t first(int rank, int p) { return n * rank / p; }

static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    const int64_t m = first(me + 1, p) - first(me, p), most = n / p + 1;
    struct body *own = comm_memory(c, most * (int64_t)sizeof *own),
                *here = comm_memory(c, most * (int64_t)sizeof *here);
    struct body *next = comm_memory(c, most * (int64_t)sizeof *next);
    double *a = comm_memory(c, 3 * m * 8);
    for (int64_t i = 0; i < m; i++) here[i] = own[i] = make(first(me, p) + i);
    for (int step = 0; step < p; step++) {
        /* The next block is on its way while this one is used. */
        const int from = (me + p - step) % p, then = (from + p - 1) % p;
        const int64_t k = first(from + 1, p) - first(from, p);
        struct comm_request r = {0};
        comm_stage(c, 0);
        if (step < p - 1) {
            comm_send(c, (me + 1) % p, step, here, k * (int64_t)sizeof *here);
            comm_irecv(c, (me + p - 1) % p, step, next,
                       (first(then + 1, p) - first(then, p)) * (int64_t)sizeof *next, &r);
        }
        comm_stage(c, 1);
        attract(own, m, here, k, a);
        comm_stage(c, 0);
        comm_wait(c, &r);
        struct body *t = here;
        here = next;
        next = t;
    }
    comm_publish(c, 0, 3 * first(me, p), 3 * m, a);
}

static void serial(struct comm *c)
{
    struct body *all = comm_memory(c, n * (int64_t)sizeof *all);
    double *a = comm_memory(c, 3 * n * 8);
    for (int64_t i = 0; i < n; i++) all[i] = make(i);
    attract(all, n, all, n, a);
    comm_publish(c, 0, 0, 3 * n, a);
}

PROGRAM(.title = "gravity between all pairs of bodies, blocks in a ring",
        .parameter = {PROGRAM_WHOLE(n, 1, 1e6, "bodies")}, .stage = {"ring", "forces"},
        .output = {"acceleration"}, .run = run, .serial = {{"all pairs", serial}},
        .tolerance = 1e-9);
