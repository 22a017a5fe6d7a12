/* micro_program.c - see micro_program.h. */
#include "kernel/micro_program.h"

#include <math.h>
#include <string.h>

#include "kernel/kernel.h"

/* program_run.own */
struct micro_run {
    const struct kernel_type *kernel;
    struct kernel_job job;
};

/* Micro-benchmarks have no model and no scene: opening them is a look at the settings. */
bool micro_open(struct program_run *r, struct err *e)
{
    struct micro_run *m = TAKE(r->arena, 1, struct micro_run);
    m->kernel = r->type->context;
    m->job = (struct kernel_job){.spec = &r->spec, .nrank = r->spec.nrank};
    r->own = m;
    r->rank = &m->kernel->rank;
    r->job = &m->job;
    return m->kernel->accepts(&m->job, e);
}

/* One output: the time that each rank measured. */
bool micro_prepare(struct program_run *r, struct arena *a, struct err *e)
{
    struct micro_run *m = r->own;
    memset(r->output, 0, sizeof r->output);
    program_want(r, OUTPUT_SECONDS, r->spec.nrank, a);
    return m->kernel->prepare(&m->job, a, e);
}

/* Nothing is compared: a benchmark's answer is the time that the slowest rank measured. */
void micro_check(struct program_run *r, struct arena *scratch, struct run_result *out)
{
    (void)scratch;
    const double *seconds = program_output(r, OUTPUT_SECONDS);
    /* Ranks that take no part publish 0 and do not count. */
    out->measured_s = 0;
    for (int i = 0; i < r->spec.nrank; i++) out->measured_s = fmax(out->measured_s, seconds[i]);
}

/* No model and no omissions: the settings say it all. */
void micro_estimate(const struct program_run *r, struct program_estimate *out)
{
    const struct micro_run *m = r->own;
    m->kernel->estimate(&r->spec, NULL, NULL, out);
}
