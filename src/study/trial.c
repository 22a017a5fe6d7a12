/* trial.c - a kernel, its job and its world, once; see trial.h.
 *
 * Unlike a run of a campaign a trial has no references, no cache and no row in a database:
 * ladders and suites make thousands of them in one process. */
#include "study/trial.h"

#include <math.h>

#include "base/check.h"
#include "base/text.h"
#include "kernel/dynamics_program.h"
#include "kernel/programs.h"
#include "kernel/trust.h"
#include "run/launch.h"
#include "run/run.h"

/* Relative to the largest number of the reference, not number by number: a component that
 * cancels has no relative accuracy of its own. */
double trial_error(const double *x, const double *reference, int n)
{
    double difference = 0, scale = 0;
    for (int i = 0; i < n; i++) {
        /* fmax would pass over what is no number */
        if (!isfinite(x[i]) || !isfinite(reference[i])) return INFINITY;
        difference = fmax(difference, fabs(x[i] - reference[i]));
        scale = fmax(scale, fabs(reference[i]));
    }
    /* A reference of zeros has no scale: the absolute error. */
    return scale > 0 ? difference / scale : difference;
}

double trial_change_error(const double *x, const double *reference, const double *begin, int n)
{
    double difference = 0, scale = 0;
    for (int i = 0; i < n; i++) {
        if (!isfinite(x[i]) || !isfinite(reference[i])) return INFINITY;
        difference = fmax(difference, fabs(x[i] - reference[i]));
        /* What has come to rest is measured by what it was. */
        scale = fmax(scale, fmax(fabs(reference[i]), fabs(begin[i])));
    }
    return scale > 0 ? difference / scale : difference;
}

/* Any machine does, for answers do not depend on it: a crossbar of round numbers, which has room
 * for any number of ranks. */
struct machine_spec trial_machine(int nrank)
{
    return (struct machine_spec){
        .name = "crossbar",
        .topology = {.family = TOPOLOGY_CROSSBAR,
                     .ndim = 1,
                     .dims = {nrank},
                     .nodes_per_router = 1,
                     .processors_per_node = 1},
        .node = {.flop_rate = 1e9, .clock = 1e9, .copy_bandwidth = 1e9},
        .network = {.level = LEVEL_LOGGP,
                    .link_bandwidth = 1e9,
                    .hop_latency = 1e-7,
                    .end_latency = 1e-7,
                    .virtual_channels = 1},
        .software = {.send_overhead = 1e-6, .recv_overhead = 1e-6, .eager_bytes = -1},
    };
}

/* A model that is there already is taken as it is; without one the program makes what its
 * settings say. */
bool trial_open(struct program_run *r, const struct run_spec *spec, const struct model *m,
                const struct state *s, struct arena *a, struct err *e)
{
    /* The program by its name, as for a run of a scenario. */
    *r = (struct program_run){.type = run_program(spec), .spec = *spec, .arena = a};
    if (!r->type) return err_set(e, ERR_CONFIG, "no kernel is called '%s'", spec->kernel.name);
    return m ? dynamics_open(r, m, s, e) : r->type->open(r, e);
}

/* Copies what a trial tells. The arrays are the program's outputs, in the caller's arena. */
static void answer(struct trial *t, const struct program_run *r, const struct run_result *result)
{
    t->answered = result->status == RUN_OK;
    text_copy(t->text, sizeof t->text, result->text);
    t->makespan_ps = result->makespan_ps;
    t->finish_ps = result->finish_ps;
    t->host_s = result->host_s;
    /* A program without a scene has times, but no outputs of dynamics. */
    if (!r->type->has_scene) return;
    t->tau = program_output(r, OUTPUT_TAU);
    t->qdd = program_output(r, OUTPUT_QDD);
    t->lambda = program_output(r, OUTPUT_LAMBDA);
    t->loop_rank = (int)*program_output(r, OUTPUT_LOOP_RANK);
    t->residual = trust_residual(r);
    t->condition = trust_condition(r);
    t->refined = (int)*program_output(r, OUTPUT_REFINED);
}

/* From the scene to the answer. Every failure on the way is a trial that did not answer, with
 * its text; nothing is left to the caller to free. Memory alone ends the process, as everywhere. */
struct trial trial_run(const struct run_spec *spec, const struct model *m, const struct state *s,
                       struct arena *a)
{
    /* Not answered, until the run says otherwise. */
    struct trial t = {.residual = NAN};
    struct run_result *result = TAKE(a, 1, struct run_result);
    struct program_run *r = TAKE(a, 1, struct program_run);
    struct err e;
    err_clear(&e);
    const bool good = trial_open(r, spec, m, s, a, &e) && r->type->prepare(r, a, &e) &&
                      launch_run(r, &spec->machine, &spec->record, run_spec_seed(spec),
                      launch_largest_message(r), NULL, a, NULL, a, result, &e);
    /* What the system refuses says nothing of the method: nothing is concluded from it. */
    if (!good && e.kind == ERR_INTERNAL) check_memory(0);
    if (good) answer(&t, r, result);
    else text_copy(t.text, sizeof t.text, e.text);
    run_close(r);
    return t;
}
