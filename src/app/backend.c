/* backend.c - see backend.h.
 *
 * Every process of the job reads the scenario by itself, as for campaigns (campaign_mpi.h). A
 * machine does not act here, so runs of the plan that differ in nothing else are one task.
 *
 * The first process stores and prints; the others make the same calls in the same order and say
 * nothing. What one of them alone could refuse would leave the others waiting, so everything is
 * refused by what all of them know: the plan, the number of processes. */
#include "app/backend.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/campaign_mpi.h"
#include "app/flag.h"
#include "app/verb.h"
#include "base/memory.h"
#include "reality/condition.h"
#include "run/real.h"
#include "spec/run_label.h"
#include "spec/task.h"
#include "store/real_rows.h"

static const char doc[] =
    "Run the points of SCENARIO that have as many ranks as the job has processes on this computer, "
    "for real, and store each in the database: the rows of table real_run.\n\n"
    "Example: mpirun -n 2 mimdsim run speedup-t3e --set ranks=2 --set n=64 --backend mpi\n"
    "\vThe same program text runs on the system's MPI as on virtual processors: built-in programs "
    "and kernels in one file, with the same checks and stages. Each task is simulated first; what "
    "deadlocks or fails there is not run. Then it is repeated; repetitions in which the system "
    "took a processor away, or page faults came that others did without, are not counted. They "
    "come in five bursts; the speed of the computer is measured before and after each. The machine "
    "of the scenario has no effect (docs/reality.md).\n\n"
    "--samples N: undisturbed repetitions that are wanted (default 30). --limit SECONDS: no "
    "further repetition of a task after this time (default 5).";

/* One process's part of the command: what it was asked for, and what has come of it so far. The
 * counts are those of the first process, which ends the command with their status. */
struct backend {
    struct common *c;
    struct job *job;
    struct real_order order;
    struct store *store; /* process 0 */
    struct json json;    /* with --json */
    int made, invalid, deadlock, crowded;
};

/* --- which tasks ------------------------------------------------------------------------------ */

/* The tasks of the plan for `nrank` ranks, each once: their number; task[i] of run index[i]. */
static int choose(const struct plan *p, int nrank, struct run_spec *task, int *index)
{
    int n = 0;
    for (int i = 0; i < p->nrun; i++) {
        if (p->run[i].nrank != nrank) continue;
        const struct run_spec t = task_of(&p->run[i], p->arena);
        int k = 0;
        while (k < n && strcmp(task[k].config_hash, t.config_hash) != 0) k++;
        if (k < n) continue;
        task[n] = t;
        index[n++] = i;
    }
    return n;
}

/* The message names both ways out: other processes for these runs, or other runs for these
 * processes. A scenario whose ranks follow n has a range of them. */
static bool refuse_ranks(const struct plan *p, int nrank, struct err *e)
{
    int least = p->run[0].nrank, most = least;
    for (int i = 1; i < p->nrun; i++) {
        if (p->run[i].nrank < least) least = p->run[i].nrank;
        if (p->run[i].nrank > most) most = p->run[i].nrank;
    }
    char range[48];
    snprintf(range, sizeof range, least < most ? "%d to %d" : "%d", least, most);
    return err_set(e, ERR_CONFIG,
                   "no run of this scenario has as many ranks as the job has processes: %s ranks, "
                   "%d %s; start mpirun -n %d, or choose --set ranks=%d",
                   range, nrank, nrank == 1 ? "process" : "processes", least, nrank);
}

/* Whether the runs have their machine alone; of `jobs:` all or none share it. */
static bool is_alone(const struct plan *p, struct err *e)
{
    return p->run[0].jobs == NULL ||
           err_set(e, ERR_CONFIG,
                   "job '%s' shares its machine with others, which a real run cannot: take the "
                   "scenario without 'jobs'",
                   p->run[0].job.name);
}

/* --- the table -------------------------------------------------------------------------------- */

/* Columns as wide as the numbers of a run from a microsecond to some seconds need them. Times are
 * microseconds, as in tables of simulated runs. */
static void print_title(void)
{
    printf("%-18s %6s %4s %11s %11s %11s %11s %8s %-8s %-10s %s\n", "program", "n", "P", "min_us",
           "lower_us", "median_us", "upper_us", "samples", "status", "answer", "load");
}

/* "same bits", or how far off. */
static void answer_text(const struct real_result *r, char *buffer, int size)
{
    if (r->same_bits) snprintf(buffer, (size_t)size, "same bits");
    else if (!isfinite(r->difference)) snprintf(buffer, (size_t)size, "other");
    else snprintf(buffer, (size_t)size, "%.1e", r->difference);
}

/* What was not run for real has no times: its reason is on standard error. The samples are shown as
 * how many there were less how many were disturbed, since a row of disturbed ones says little. */
static void print_row(const struct run_spec *spec, const struct real_result *r)
{
    static const char *const word[] = {"ok", "invalid", "deadlock", "failed"};
    char answer[24], samples[24], load[16] = "-";
    answer_text(r, answer, (int)sizeof answer);
    if (r->nsample == 0) {
        printf("%-18s %6d %4d %11s %11s %11s %11s %8s %s\n", spec->kernel.name, spec->model.nbody,
               r->nrank, "-", "-", "-", "-", "0", word[r->status]);
        return;
    }
    if (isfinite(r->load.others)) snprintf(load, sizeof load, "%.2f", r->load.others);
    snprintf(samples, sizeof samples, "%d-%d", r->nsample, r->disturbed);
    printf("%-18s %6d %4d %11.3f %11.3f %11.3f %11.3f %8s %-8s %-10s %s\n", spec->kernel.name,
           spec->model.nbody, r->nrank, r->time.min * 1e6, r->time.lower * 1e6,
           r->time.median * 1e6, r->time.upper * 1e6, samples, word[r->status], answer, load);
}

/* The row of the database with its stages. */
static void print_json(const struct run_spec *task, const struct real_result *r, struct json *j)
{
    json_object(j);
    json_key_int(j, "n", task->model.nbody);
    json_key_text(j, "program", task->kernel.name);
    json_key(j, "run");
    columns_json(&real_result_columns, r, j);
    json_key(j, "stages");
    columns_json_list(&real_stage_columns, r->stage, r->nstage, sizeof *r->stage, j);
    json_key_text(j, "task_hash", task->config_hash);
    json_end(j);
}

/* --- runs ------------------------------------------------------------------------------------- */

/* Counted for the exit status, and told where a person has to know: what went wrong with its
 * reason, what differs from one repetition to the next, that times of more ranks than processors
 * are none. The last is told once. */
static void note(struct backend *b, const struct run_spec *spec, const struct real_result *r)
{
    b->made++;
    b->invalid += r->status == RUN_INVALID || r->status == RUN_FAILED;
    b->deadlock += r->status == RUN_DEADLOCK;
    if (r->status != RUN_OK)
        fprintf(stderr, "mimdsim: %s%s: %s\n", spec->kernel.name, run_size(spec, r->nrank).s,
                r->text);
    if (r->status == RUN_OK && !r->repeatable && !b->c->quiet)
        fprintf(stderr,
                "mimdsim: %s%s: the answer differs from repetition to repetition, within its "
                "tolerance\n",
                spec->kernel.name, run_size(spec, r->nrank).s);
    const struct condition condition = condition_of(r);
    if (r->status == RUN_OK && condition_changed(&condition) && !b->c->quiet)
        fprintf(stderr,
                "mimdsim: %s%s: the computer's speed changed during %d of %d bursts; predict does "
                "not count the run\n",
                spec->kernel.name, run_size(spec, r->nrank).s, condition.bursts - condition.steady,
                condition.bursts);
    if (r->oversubscribed && b->crowded++ == 0 && !b->c->quiet)
        fprintf(stderr, "mimdsim: %d ranks on %d processors: answers are right, times say little\n",
                r->nrank, r->processors);
}

/* One task on all processes; the first one stores and prints it. */
static bool run_task(struct backend *b, const struct plan *p, const struct run_spec *run,
                     const struct run_spec *task, struct host_comm *comm, struct run_cache *cache,
                     struct err *e)
{
    struct arena *a = arena_create();
    struct real_result *r = TAKE(a, 1, struct real_result);
    bool ok = run_real(run, &b->job->h, comm, &b->order, cache, a, r, e);
    if (ok && b->job->h.rank == 0) {
        const struct real_task what = {task->config_hash, p->name, task->kernel.name,
                                       task->model.nbody, task->config_text};
        note(b, run, r);
        ok = store_put_real(b->store, &what, r, e);
        if (ok && b->c->json) print_json(task, r, &b->json);
        else if (ok) print_row(run, r);
    }
    arena_destroy(a);
    return ok;
}

/* All tasks on one lane. The database is opened before the first of them runs: hours of measuring
 * are not lost to a file that cannot be written. A task that cannot be made ends the command; those
 * before it are stored. */
static bool run_tasks(struct backend *b, const struct plan *p, struct err *e)
{
    struct run_spec *task = memory_zeroed((size_t)p->nrun, sizeof *task);
    int *index = memory_zeroed((size_t)p->nrun, sizeof *index);
    const int n = choose(p, b->job->h.size, task, index);
    bool ok = is_alone(p, e) && (n > 0 || refuse_ranks(p, b->job->h.size, e));
    const bool all_begin = ok;
    b->job->started = true; /* all refuse alike: the job ends in order */
    struct host_comm *comm = ok ? host_comm_create(&b->job->h, e) : NULL;
    struct run_cache *cache = run_cache_create();
    ok = ok && comm != NULL;
    if (ok && b->job->h.rank == 0) {
        b->store = arguments_store(b->c, b->c->database, e);
        ok = b->store != NULL;
        b->json = json_make(stdout);
        if (ok && b->c->json) json_array(&b->json);
        else if (ok) print_title();
    }
    for (int i = 0; i < n && ok; i++)
        ok = run_task(b, p, &p->run[index[i]], &task[i], comm, cache, e);
    if (!ok && all_begin) b->job->gone++; /* the others may wait for this one */
    if (ok && b->c->json && b->job->h.rank == 0) {
        json_end(&b->json);
        json_finish(&b->json);
    }
    if (ok) host_comm_destroy(comm);
    run_cache_destroy(cache);
    free(task);
    free(index);
    return ok;
}

/* --- the command ------------------------------------------------------------------------------ */

/* At most as many as the memory of a task has room for, with eight times as many tries
 * (run/real.c). */
static bool take_samples(int *argc, char **argv, struct real_order *o, struct err *e)
{
    const char *text = take_value(argc, argv, "--samples");
    char *end = NULL;
    if (text == NULL) return true;
    const long n = strtol(text, &end, 10);
    if (end == text || *end != '\0' || n < 1 || n > 2500)
        return err_set(e, ERR_USAGE, "--samples '%.40s': expected a number from 1 to 2500", text);
    o->samples = (int)n;
    return true;
}

/* Worst first, as for simulated runs. Only the first process has a status of its own: launchers
 * tell that of any process that does not end with 0. */
static int status_of(bool ok, const struct backend *b, struct err *e)
{
    if (b->job->h.rank > 0) err_clear(e);     /* what went wrong on all is told once */
    if (!ok && e->kind == ERR_NONE) return 0; /* the first process of the job says why */
    if (!ok) return common_fail(b->c, e);
    if (b->deadlock > 0) return err_exit_status(ERR_DEADLOCK);
    return b->invalid > 0 ? err_exit_status(ERR_CHECK) : 0;
}

/* The job is joined before the options are read, so that a wrong one is told once and not by each
 * process (job_open silences all but the first). */
int backend_run(int argc, char **argv, const char *backend)
{
    struct common c;
    struct job job = {.kept = -1};
    struct backend b = {.c = &c, .job = &job, .order.bursts = REAL_BURSTS};
    struct plan p = {0};
    struct err e;
    err_clear(&e);
    bool ok = strcmp(backend, "mpi") == 0 ||
              err_set(&e, ERR_USAGE, "--backend '%.40s': expected mpi", backend);
    ok = ok && job_open_started(&job, &e);
    ok = take_samples(&argc, argv, &b.order, &e) && ok;
    ok = take_seconds(&argc, argv, "--limit", &b.order.seconds, &e) && ok;
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_STORE, "SCENARIO|PROGRAM", doc, 1, 1);
    ok = ok && job_open_alone(&job, &e);
    job_heard(&job, &c);
    struct plan_options o = common_plan(&c);
    ok = ok && plan_read(&p, c.arg[0], &o, &e);
    ok = job_agree(&job, &p, ok, &e);
    ok = ok && run_tasks(&b, &p, &e);
    store_close(b.store);
    plan_free(&p);
    return job_end(&job, status_of(ok, &b, &e));
}
