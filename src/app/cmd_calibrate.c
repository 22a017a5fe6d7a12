/* cmd_calibrate.c - mimdsim calibrate: a machine file of this computer.
 *
 * This verb joins the job, divides the work among its processes and writes the file; what is
 * measured and how is in room reality. It is a job also with one process, since the same MPI that
 * carries the messages has to be there for real runs.
 *
 * The exit status of a computer that is too busy is that of a locked database: try again. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/campaign_mpi.h"
#include "app/flag.h"
#include "app/verb.h"
#include "base/beside.h"
#include "base/memory.h"
#include "base/progress.h"
#include "host/host_load.h"
#include "host/host_speed.h"
#include "hosts/hosts_copy.h"
#include "reality/calibrate.h"

static const char doc[] =
    "Measure this computer and write a machine file of it.\n\n"
    "Example: mimdsim calibrate -o my-host.yaml\n"
    "\vRates of one processor are fitted to measured times of our own kernels, whose operations "
    "are counted; prices of the code of programs in one file to loops of several kinds. Messages "
    "between two processes are measured by size: overheads, latency, gap, rate, the switch from "
    "eager to rendezvous and other jumps; then the barrier and the collectives. Every number has "
    "its residual, date and host. Samples in which the system took a processor away are not "
    "counted; when too few are left, nothing is written and the exit status is 75. Messages need "
    "two processes: mpirun -n 2 mimdsim calibrate. With one there are rates alone "
    "(docs/reality.md).\n\n"
    "Kernels and loops are measured at the beginning and at the end, and the shorter times are "
    "kept; a message says when the computer's speed changed in between. How fast it was is noted "
    "in the file, where predict finds it.\n\n"
    "--quick: fewer samples and sizes of kernels, under 30 s; else under 5 minutes.";

enum { TAG_DONE = 600, QUICK_SAMPLES = 60, FULL_SAMPLES = 400, MORE_PASSES = 3 };

/* How much is measured: samples of messages, repetitions of kernels. Both are what is wanted; more
 * are made where some are disturbed. */
struct effort {
    int messages, kernels; /* samples */
    double seconds;        /* of one kernel at one size at most */
    double passes;         /* no further pass begins so long after the second one began [s] */
    bool large;            /* collectives of 1 MiB, too */
};

/* Quick: what fits into half a minute when nothing else runs, and into a minute when much does. */
static struct effort effort_of(bool quick)
{
    return quick ? (struct effort){QUICK_SAMPLES, 10, 1, 20, false}
                 : (struct effort){FULL_SAMPLES, 40, 4, 120, true};
}

/* What is measured on the first process alone, in several passes. Both plans live as long. */
struct alone {
    struct plan kernels, loops; /* loops: none without gcc */
    struct passes kernel, loop;
};

/* Loops of a program in one file, which `mimdsim cc` compiles first: without gcc the machine file
 * has one price for all instructions, and says so. */
static bool open_alone(struct alone *x, const struct common *c, struct calibration *out,
                       struct err *e)
{
    struct plan_options o = common_plan(c);
    struct err without;
    err_clear(&without);
    if (!plan_read(&x->kernels, "calibrate", &o, e)) return false;
    /* A scenario with a program: reading it compiles, once for this computer. */
    out->has_code = plan_read(&x->loops, "calibrate-code", &o, &without);
    if (!out->has_code && !c->quiet)
        fprintf(stderr, "mimdsim: the code of programs in one file is not measured: %s\n",
                without.text);
    return true;
}

/* One pass over both, of all points or of those that took longer than at the computer's best. */
static bool pass(struct alone *x, const struct common *c, const struct effort *effort, double least,
                 struct calibration *out, struct err *e)
{
    rates_loops(&out->rates);
    return passes_run(&x->kernel, &x->kernels, "kernels", effort->kernels, effort->seconds, least,
                      c->quiet, e) &&
           (!out->has_code || passes_run(&x->loop, &x->loops, "loops", effort->kernels,
                                         effort->seconds, least, c->quiet, e));
}

/* Rates by what has been kept so far. */
static bool fit_kernels(const struct alone *x, struct calibration *out, struct err *e)
{
    out->rates.n = x->kernel.n;
    memcpy(out->rates.sample, x->kernel.kept, sizeof out->rates.sample);
    return rates_fit(&out->rates) ||
           err_set(e, ERR_DATA, "%d points are too few to fit rates to", out->rates.n);
}

/* The second pass, others where that did not meet the computer at its best, and what they say. */
static bool finish_alone(struct alone *x, const struct common *c, const struct effort *effort,
                         struct calibration *out, struct err *e)
{
    const double began = host_seconds();
    if (!pass(x, c, effort, 0, out, e)) return false;
    double least = passes_least(&x->loop, passes_least(&x->kernel, 0));
    for (int i = 0; i < MORE_PASSES; i++) {
        if (passes_slow(&x->kernel, least) + passes_slow(&x->loop, least) == 0) break;
        /* A computer that stays busy is not waited for: the file says that it was. */
        if (host_seconds() - began > effort->passes) break;
        if (!pass(x, c, effort, least, out, e)) return false;
        least = passes_least(&x->loop, passes_least(&x->kernel, least));
    }
    out->points = x->kernel.n + x->loop.n;
    out->slow = passes_slow(&x->kernel, least) + passes_slow(&x->loop, least);
    out->changed = passes_changed(&x->kernel, &x->loop, &out->changed_by);
    const double message = out->condition.rates.time[HOST_MESSAGE];
    out->condition.rates = passes_speed(&x->kernel);
    out->condition.rates.time[HOST_MESSAGE] = message;
    out->condition.code = passes_speed(&x->loop);
    if (!fit_kernels(x, out, e)) return false;
    /* What no loop tells is priced as measured before. */
    const struct node_spec node = rates_node(&out->rates, out->clock);
    return !out->has_code || code_rates_take(&x->loops, &x->loop, &node, &out->code, e);
}

/* The kernels on the first process alone; the others sleep until it is done: spinning, they would
 * heat the processor and take memory bandwidth. */
static bool measure_rates(struct job *job, struct alone *x, const struct common *c,
                          const struct effort *effort, bool first, struct calibration *out,
                          struct err *e)
{
    bool ok = true;
    if (job->h.rank == 0 && first)
        ok = open_alone(x, c, out, e) && pass(x, c, effort, 0, out, e) && fit_kernels(x, out, e);
    else if (job->h.rank == 0) ok = finish_alone(x, c, effort, out, e);
    if (!hosts_tell(&job->h, TAG_DONE, &ok, sizeof ok))
        return err_set(e, ERR_INTERNAL, "%s cannot reach all processes", job->h.call->library);
    return ok;
}

/* On a lane that lives for this measurement alone. Processes beyond the second take part in
 * barriers and do nothing else. */
static bool measure_messages(struct job *job, const struct effort *effort, struct calibration *out,
                             struct err *e)
{
    if (job->h.size < 2) return true;
    struct host_comm *comm = host_comm_create(&job->h, e);
    if (comm == NULL) return false;
    out->has_messages = true;
    struct host_speed before, after;
    const bool ok = (host_speed_now(&job->h, comm, &before) &&
                     messages_measure(&job->h, comm, effort->messages, &out->messages, e) &&
                     host_speed_now(&job->h, comm, &after)) ||
                    (e->kind == ERR_NONE &&
                     err_set(e, ERR_INTERNAL, "%s reports an error", job->h.call->library));
    /* Messages were measured between the two. */
    if (ok)
        out->condition.rates.time[HOST_MESSAGE] =
            (before.time[HOST_MESSAGE] + after.time[HOST_MESSAGE]) / 2;
    host_comm_destroy(comm);
    return ok;
}

/* Collectives by all processes of the job, where each has a processor: in turns their times would
 * be those of the system's. */
static bool measure_collectives(struct job *job, const struct common *c,
                                const struct effort *effort, struct calibration *out,
                                struct err *e)
{
    struct plan p = {0};
    struct plan_options o = common_plan(c);
    char ranks[32];
    const char *const set[] = {ranks};
    struct machine_spec machine;
    if (job->h.size < 2 || job->h.size > sysconf(_SC_NPROCESSORS_ONLN)) return true;
    /* The scenario has two ranks; the job may have more. */
    snprintf(ranks, sizeof ranks, "ranks=%d", job->h.size);
    o.nset = 1;
    o.set = set;
    /* Every process reads the plan by itself, as for real runs (backend.c). */
    struct host_comm *comm = host_comm_create(&job->h, e);
    bool ok = comm != NULL && plan_read(&p, "calibrate-collectives", &o, e);
    /* The first process predicts with what has been measured so far; the others only take part. */
    if (ok) {
        machine = calibration_machine(out, &p.run[0].machine);
        ok = collective_times_measure(&p, &job->h, comm, job->h.rank == 0 ? &machine : NULL,
                                      effort->kernels, effort->seconds / 4, effort->large,
                                      &out->collectives, e);
        out->has_collectives = ok && out->collectives.n > 0;
    }
    plan_free(&p);
    host_comm_destroy(comm);
    if (!hosts_tell(&job->h, TAG_DONE, &ok, sizeof ok))
        return err_set(e, ERR_INTERNAL, "%s cannot reach all processes", job->h.call->library);
    return ok;
}

/* Around everything that is measured: the load of others is what the system was busy with, less the
 * processor time of this job, whose processes wait by spinning. */
static bool measure(struct job *job, const struct common *c, bool quick, struct calibration *out,
                    struct err *e)
{
    const struct effort effort = effort_of(quick);
    const struct host_load_begin load = host_load_start();
    const double own = host_processor_seconds();
    out->clock = calibration_clock();
    struct alone *x = memory_zeroed(1, sizeof *x);
    const bool ok = measure_rates(job, x, c, &effort, true, out, e) &&
                    measure_messages(job, &effort, out, e) &&
                    measure_collectives(job, c, &effort, out, e) &&
                    measure_rates(job, x, c, &effort, false, out, e);
    plan_free(&x->kernels);
    plan_free(&x->loops);
    free(x);
    if (!ok) return false;
    int64_t used = (int64_t)((host_processor_seconds() - own) * 1e9);
    if (!job->h.call->reduce(HOSTS_SUM, &used, 1))
        return err_set(e, ERR_INTERNAL, "%s cannot reach all processes", job->h.call->library);
    /* Bound processes have a processor each: as many as the job has, at least. */
    out->processors = host_processors(host_processor_set());
    if (out->processors < job->h.size) out->processors = job->h.size;
    out->load = host_load_read(&load, (double)used * 1e-9);
    host_name(out->host, (int)sizeof out->host);
    host_processor_name(out->processor, (int)sizeof out->processor);
    text_copy(out->library, sizeof out->library, job->h.call->library);
    host_date(out->date);
    return true;
}

/* A line for each thing that was learnt, so that a bad fit or a busy computer is seen at once and
 * not only in the file. */
static void say(const struct calibration *c, const char *path)
{
    const struct rates *r = &c->rates;
    printf("%s: %.4g Mflop/s, kernels within %.1f %% (median), %.1f %% (largest)\n", path,
           r->flop > 0 ? 1e-6 / r->flop : 0, 100 * r->median_residual, 100 * r->residual);
    /* Rates of code by what a person knows of processors: how many instructions a cycle. */
    if (c->has_code)
        printf("code: %.2f instructions a cycle, loops within %.1f %% (median), %.1f %% "
               "(largest)\n",
               1 / fmax(c->code.price[0], 1e-6), 100 * c->code.median_residual,
               100 * c->code.residual);
    if (c->has_messages)
        printf("messages: %.3f us for 0 B, %.3f us for 8 KiB; barrier of MPI %.3f us\n",
               c->messages.point[0].one_way * 1e6, c->messages.point[8].one_way * 1e6,
               c->messages.barrier * 1e6);
    else printf("messages: not measured; start two processes: mpirun -n 2 mimdsim calibrate\n");
    if (c->has_collectives)
        printf("collectives: %d within %.1f %% (median), %.1f %% (largest) of what messages "
               "predict\n",
               c->collectives.n, 100 * c->collectives.median_residual,
               100 * c->collectives.residual);
    char remark[500];
    calibration_remark(c, remark, sizeof remark);
    if (remark[0] != '\0') printf("%s.\n", remark);
    printf("load: other programs kept %.2f processors busy\n", c->load.others);
}

/* Nothing is written before all of it is measured: a file is whole, or the one of before stays. */
int cmd_calibrate(int argc, char **argv)
{
    struct common c;
    struct job job = {.kept = -1};
    struct err e;
    struct text text = {0};
    struct beside file = {0};
    err_clear(&e);
    const bool quick = take_flag(&argc, argv, "--quick");
    bool ok = job_open_started(&job, &e);
    common_parse(&c, argc, argv, TAKES_STORE, "", doc, 0, 0);
    ok = ok && job_open_alone(&job, &e);
    job_heard(&job, &c);
    struct arena *a = arena_create();
    struct calibration *out = TAKE(a, 1, struct calibration);
    const char *path = c.database_given ? c.database : "my-host.yaml";
    job.started = true;
    /* A file that cannot be made is told before the minutes of measuring. */
    ok = ok &&
         (job.h.rank > 0 || (beside_begin(&file, path, &e) && beside_end(&file, false, &e))) &&
         measure(&job, &c, quick, out, &e);
    if (ok && job.h.rank == 0) {
        calibration_text(out, &text);
        ok = beside_write(path, text.s, text.length, &e);
        if (ok) say(out, path);
    }
    text_free(&text);
    arena_destroy(a);
    if (job.h.rank > 0) err_clear(&e);
    return job_end(&job, ok ? 0 : e.kind == ERR_NONE ? 0 : common_fail(&c, &e));
}
