/* bench_overhead.c - what simulating costs beside the kernels themselves.
 *
 *   bench_overhead [P...]      default 16 128 1024 4096
 *
 * The main scenario with n = P, inverse and forward dynamics: host seconds of the simulated run
 * over those of the same kernels on the same number of ranks without any simulator (fibers, plain
 * memory copies for messages, no clocks). And what watching the answer costs: the kernels with
 * residual and condition over those without. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../tests/support/many_ranks.h"
#include "base/large_pages.h"
#include "base/progress.h"
#include "dynamics/system.h"
#include "kernel/dynamics_program.h"
#include "kernel/programs.h"
#include "model/model.h"
#include "plan/plan.h"
#include "run/run.h"
#include "torus_plan.h"

enum { MOST_ROUNDS = 200 };

struct bare {
    struct program_run run;
    char **workspace;
};

static void program(struct comm *c, void *context)
{
    struct bare *b = context;
    b->run.rank->run(c, b->run.job, b->workspace[comm_rank(c)]);
}

/* rounds_for: repetitions that fill about a second, at least three. */
static int rounds_for(int nrank)
{
    const int n = 40000 / nrank;
    return n < 3 ? 3 : n > MOST_ROUNDS ? MOST_ROUNDS : n;
}

/* bare_seconds: the best of some rounds without a simulator; everything is set up before. */
static double bare_seconds(const struct run_spec *spec, bool watch, struct err *e)
{
    struct arena *a = arena_create();
    struct bare b = {.run = {.type = program_find(spec->kernel.name), .spec = *spec, .arena = a}};
    struct program_run *r = &b.run;
    struct model *m = model_build(&spec->model, a, e);
    if (!m) return 0;
    system_prepare(m);
    if (!dynamics_open(r, m, state_make(m, &spec->model, a), e)) return 0;
    dynamics_run_of(r)->job.watch = watch;
    if (!r->type->prepare(r, a, e)) return 0;
    b.workspace = TAKE(a, spec->nrank, char *);
    for (int k = 0; k < spec->nrank; k++)
        b.workspace[k] = arena_take(a, r->rank->workspace_bytes(r->job, k));
    double best = 1e30;
    for (int round = 0; round < rounds_for(spec->nrank); round++) {
        for (int k = 0; k < spec->nrank; k++)
            memset(b.workspace[k], 0, r->rank->workspace_bytes(r->job, k));
        const double begin = host_seconds();
        many_ranks_publishing(spec->nrank, program, &b, r->output, PROGRAM_OUTPUTS);
        const double took = host_seconds() - begin;
        if (took < best) best = took;
    }
    arena_destroy(a);
    return best;
}

/* watching_direct: what watching costs in the direct formulation, as a ratio. */
static double watching_direct(const struct run_spec *spec, struct err *e)
{
    struct run_spec direct = *spec;
    direct.kernel.formulation = FORMULATION_DIRECT;
    const double bare = bare_seconds(&direct, false, e);
    return bare_seconds(&direct, true, e) / bare;
}

/* simulated_seconds: the best of some rounds of the simulation proper. */
static double simulated_seconds(const struct run_spec *spec, struct err *e)
{
    double best = 1e30;
    for (int round = 0; round < rounds_for(spec->nrank) / 2 + 1; round++) {
        struct arena *a = arena_create();
        struct run_result r;
        const bool good = run_one(spec, a, &r, e);
        if (good && r.host_s < best) best = r.host_s;
        arena_destroy(a);
        if (!good) return 0;
    }
    return best;
}

static bool measure(int nrank)
{
    static const char *const levels[] = {"loggp", "link"};
    struct err e;
    err_clear(&e);
    double bare = 0, watched = 0, direct = 0, simulated[2];
    for (int k = 0; k < 2; k++) {
        struct plan p = {0};
        if (!torus_plan_read(&p, nrank, levels[k], &e)) break;
        if (k == 0) bare = bare_seconds(&p.run[0], false, &e);
        if (k == 0) watched = bare_seconds(&p.run[0], true, &e);
        if (k == 0) direct = watching_direct(&p.run[0], &e);
        simulated[k] = simulated_seconds(&p.run[0], &e);
    }
    if (e.kind != ERR_NONE) {
        err_print(&e);
        return false;
    }
    printf("%8d %12.3f %12.3f %12.3f %12.2f %12.2f %12.2f %12.2f\n", nrank, 1e3 * bare,
           1e3 * simulated[0], 1e3 * simulated[1], watched / bare, direct, simulated[0] / watched,
           simulated[1] / watched);
    fflush(stdout);
    return true;
}

int main(int argc, char **argv)
{
    static const int standard[] = {16, 128, 1024, 4096};
    const int n = argc > 1 ? argc - 1 : 4;
    bool good = true;
    large_pages_for_heap(); /* as the program does */
    printf("%8s %12s %12s %12s %12s %12s %12s %12s\n", "P", "bare ms", "loggp ms", "link ms",
           "watched/bare", "same, direct", "loggp/watched", "link/watched");
    for (int i = 0; i < n; i++) good = measure(argc > 1 ? atoi(argv[i + 1]) : standard[i]) && good;
    return !good;
}
