/* trial.c - a kernel, its job and its world, once; see trial.h. */
#include "run/trial.h"

#include <math.h>

#include "base/text.h"
#include "kernel/kernel.h"
#include "run/launch.h"
#include "run/trust.h"
#include "run/omission.h"

double trial_error(const double *x, const double *reference, int n)
{
    double difference = 0, scale = 0;
    for (int i = 0; i < n; i++) {
        if (!isfinite(x[i])) return INFINITY;
        difference = fmax(difference, fabs(x[i] - reference[i]));
        scale = fmax(scale, fabs(reference[i]));
    }
    return scale > 0 ? difference / scale : difference;
}

double trial_change_error(const double *x, const double *reference, const double *begin, int n)
{
    double difference = 0, scale = 0;
    for (int i = 0; i < n; i++) {
        if (!isfinite(x[i]) || !isfinite(reference[i])) return INFINITY;
        difference = fmax(difference, fabs(x[i] - reference[i]));
        scale = fmax(scale, fmax(fabs(reference[i]), fabs(begin[i])));
    }
    return scale > 0 ? difference / scale : difference;
}

struct machine_spec trial_machine(int nrank)
{
    return (struct machine_spec){
        .name = "crossbar",
        .topology = {.family = TOPOLOGY_CROSSBAR, .ndim = 1, .dims = {nrank}, .nodes_per_router = 1,
                     .processors_per_node = 1},
        .node = {.flop_rate = 1e9, .clock = 1e9, .copy_bandwidth = 1e9},
        .network = {.level = LEVEL_LOGGP, .link_bandwidth = 1e9, .hop_latency = 1e-7, .end_latency = 1e-7,
                    .virtual_channels = 1},
        .software = {.send_overhead = 1e-6, .recv_overhead = 1e-6, .eager_bytes = -1},
    };
}

static bool job_make(struct kernel_job *job, const struct kernel_type *kernel, const struct run_spec *spec,
                     const struct model *m, const struct state *s, struct arena *a, struct err *e)
{
    *job = (struct kernel_job){.spec = spec, .model = m, .state = s, .nrank = spec->nrank};
    job->omit = omission_job(spec, m, s);
    job_want(job, OUTPUT_RESIDUAL, spec->nrank, a);
    job_want(job, OUTPUT_RESIDUAL_SCALE, spec->nrank, a);
    job_want(job, OUTPUT_CONDITION, spec->nrank, a);
    job_want(job, OUTPUT_REFINED, 1, a);
    if (m && kernel->does_inverse) job_want(job, OUTPUT_TAU, m->nu, a);
    if (m && kernel->does_forward) job_want(job, OUTPUT_QDD, m->nu, a);
    if (m && m->nrow > 0) job_want(job, OUTPUT_LAMBDA, m->nrow, a);
    return kernel->accepts(spec, m, e) && kernel->prepare(job, a, e);
}

static void answer(struct trial *t, const struct kernel_job *job, const struct run_result *r)
{
    t->answered = r->status == RUN_OK;
    text_copy(t->text, sizeof t->text, r->text);
    t->tau = job_output(job, OUTPUT_TAU);
    t->qdd = job_output(job, OUTPUT_QDD);
    t->residual = trust_residual(job);
    t->condition = trust_condition(job);
    t->refined = (int)*job_output(job, OUTPUT_REFINED);
    t->makespan_ps = r->makespan_ps;
    t->finish_ps = r->finish_ps;
    t->host_s = r->host_s;
}

struct trial trial_run(const struct run_spec *spec, const struct model *m, const struct state *s, struct arena *a)
{
    struct trial t = {.residual = NAN};
    struct run_result *result = TAKE(a, 1, struct run_result);
    struct kernel_job job;
    struct err e;
    err_clear(&e);
    const struct kernel_type *kernel = omission_kernel(spec, m, s, &e);
    bool good = kernel && job_make(&job, kernel, spec, m, s, a, &e);
    good = good && launch_job(kernel, &job, &spec->machine, &spec->record, spec->seed,
                              launch_largest_message(kernel, &job), a, a, result, &e);
    if (good) answer(&t, &job, result);
    else text_copy(t.text, sizeof t.text, e.text);
    return t;
}
