/* bench_loader.c - what private data cost: making a rank's copy, and switching between ranks that
 * write their globals, beside plain fibers that write the same through a pointer. Usage:
 * bench_loader [RANKS...] in the build folder. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/progress.h"
#include "loader/loader.h"
#include "sim/fiber.h"

static const char source[] = "#include <mimdsim/host.h>\n"
                             "static long counter[16]; long total;\n"
                             "void turns(long n) {\n"
                             "  for (long i = 0; i < n; i++) {\n"
                             "    counter[i & 15]++; total += i;\n"
                             "    mimdsim_host->runtime->sleep_ps(mimdsim_host, 1);\n"
                             "  }\n"
                             "}\n";

struct rank {
    struct fiber *fiber;
    struct loader_instance *instance;
    void *turns;
    long n;
    long *counter, total; /* of a plain fiber */
};

static void next_rank(void *context, int64_t ps)
{
    struct rank *r = context;
    (void)ps;
    fiber_leave(r->fiber);
}

static void loaded(void *argument)
{
    struct rank *r = argument;
    loader_call(r->instance, r->turns, (const int64_t[4]){r->n});
}

static void plain(void *argument)
{
    struct rank *r = argument;
    for (long i = 0; i < r->n; i++) {
        r->counter[i & 15]++;
        r->total += i;
        next_rank(r, 1);
    }
}

/* Seconds of a whole run, all ranks in turn. */
static double run(struct rank *rank, int nrank, bool ahead)
{
    const double begin = host_processor_seconds();
    for (int left = 1; left;) {
        left = 0;
        for (int i = 0; i < nrank; i++) {
            if (i + 3 < nrank) fiber_prefetch(rank[i + 3].fiber); /* as room vp does */
            if (ahead && i + 3 < nrank) loader_prefetch(rank[i + 3].instance);
            left += fiber_enter(rank[i].fiber);
        }
    }
    return host_processor_seconds() - begin;
}

static void refuse(const struct err *e)
{
    err_print(e);
    exit(1);
}

static void measure(const char *path, int nrank, bool rank_by_rank)
{
    static const struct loader_hooks hooks = {.sleep_ps = next_rank};
    const long rounds = 4000000 / nrank;
    struct err e;
    err_clear(&e);
    struct rank *rank = calloc((size_t)nrank, sizeof *rank);
    long *counters = calloc((size_t)nrank, 16 * sizeof *counters);

    /* Copies: time of all of them, from a file already read. */
    struct loader_template *t = loader_open(path, &e);
    if (!t || !loader_reserve(t, nrank, &hooks, &e)) refuse(&e);
    double begin = host_processor_seconds();
    for (int i = 0; i < nrank; i++) {
        rank[i] = (struct rank){.n = rounds, .counter = counters + 16L * i};
        rank[i].instance = loader_instantiate(t, i, &rank[i], &e);
        if (!rank[i].instance) refuse(&e);
        rank[i].turns = loader_symbol(rank[i].instance, "turns");
    }
    const double copy = (host_processor_seconds() - begin) / nrank;

    /* Switches: the same loop, five times each, the best of them; the first one also touches the
     * pages. */
    double best[2] = {1e9, 1e9};
    for (int trial = 0; rank_by_rank && trial < 10; trial++) {
        struct fiber_pool *p = fiber_pool_create(nrank, 64 * 1024, &e);
        if (!p) refuse(&e);
        for (int i = 0; i < nrank; i++)
            rank[i].fiber = fiber_start(p, i, trial % 2 ? plain : loaded, &rank[i]);
        const double s = run(rank, nrank, trial % 2 == 0) / ((double)rounds * nrank);
        if (s < best[trial % 2]) best[trial % 2] = s;
        fiber_pool_destroy(p);
    }
    printf("%6d ranks: a copy %6.2f us, %5.1f KiB a rank", nrank, 1e6 * copy,
           (double)loader_bytes(t) / 1024);
    if (rank_by_rank)
        printf("; a switch %5.1f ns, of plain fibers %5.1f ns", 1e9 * best[0], 1e9 * best[1]);
    printf("; peak of the process %.0f MiB\n", (double)host_peak_bytes() / (1 << 20));
    loader_close(t);
    free(counters);
    free(rank);
}

int main(int argc, char **argv)
{
    char path[] = "bench_loader.guest", command[1024];
    FILE *f = fopen("bench_loader.guest.c", "w");
    if (!f || fputs(source, f) < 0 || fclose(f) != 0) return 1;
    snprintf(command, sizeof command,
             "gcc -O2 -shared -fPIC -Wl,-Bsymbolic -I%s/include -o %s %s.c -Wl,--whole-archive "
             "libmimdsim-guest.a "
             "-Wl,--no-whole-archive -lm",
             MIMDSIM_SRCDIR, path, path);
    if (system(command) != 0) return 1;
    if (argc > 1)
        for (int i = 1; i < argc; i++) measure(path, atoi(argv[i]), false);
    else
        for (int nrank = 128; nrank <= 4096; nrank = nrank == 128 ? 1024 : 4 * nrank)
            measure(path, nrank, true);
    remove(path);
    remove("bench_loader.guest.c");
    return 0;
}
