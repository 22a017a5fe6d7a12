/* cmd_predict.c - mimdsim predict: measured runs beside what a machine file predicts of them.
 *
 * The two meet in the task (spec/task.h): what the ranks do, whatever the machine. The plan says
 * which tasks are asked for and on which machine they are simulated; the database says what they
 * took on a computer. A prediction is made anew each time, since it takes milliseconds, and a
 * stored one would have to be of the same machine file.
 *
 * The error is against the median of the undisturbed repetitions: the least of many is what a
 * computer can do at its best, the median what it does. A machine file describes it at its best, so
 * the error against the least is told, too: where the two differ by much, other guests of the same
 * host may be the reason, which nothing in a virtual machine shows. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/flag.h"
#include "app/measured_run.h"
#include "app/verb.h"
#include "base/memory.h"
#include "base/sorted.h"
#include "reality/predict.h"
#include "spec/task.h"

static const char doc[] =
    "Compare the measured runs of SCENARIO in the database with what --machine predicts, or the "
    "scenario's machine where that is a file of your own.\n\n"
    "Example: mimdsim predict speedup-t3e --set ranks=2 --set n=16,64 -m my-host.yaml\n"
    "\vMeasured are the rows that mimdsim run --backend mpi has stored; of each task the latest. "
    "The "
    "error is that of the predicted time against the median of the undisturbed repetitions; "
    "shortest_us is the shortest of them, and the last lines have the errors against both. The "
    "last "
    "columns name the parameters of the machine that would have to change least for the prediction "
    "to "
    "be right, by which factor, and the stage that differs most. Runs with more ranks than "
    "processors, "
    "those with fewer than 5 undisturbed repetitions, and those during which the computer's speed "
    "changed, are shown and not counted.\n\n"
    "A real run notes how fast the computer was before and after each burst of repetitions, and "
    "calibrate notes it in the machine file. From the two follows a corrected prediction: each "
    "price of the machine is multiplied by how many times as long its operation took at the run. "
    "Column slower is the corrected prediction over the plain one, and corrected_% its error "
    "(docs/reality.md).\n\n"
    "--stages: each stage on a line of its own.";

enum { MOST_ROWS = 1000 };

/* The prediction at the condition of a run: with the machine's prices as its operations took at the
 * burst that is the middle one of all. */
struct at_condition {
    bool known;
    double measured, predicted; /* [s] */
    double error;
    double slower; /* predicted, over what the machine predicts as it is */
};

/* What all rows together say: the errors of those that count, whose median and largest end the
 * table, and how many tasks have nothing to be compared with. */
struct summary {
    struct common *c;
    struct store *store;
    bool stages;
    double error[MOST_ROWS];    /* (n) of those that count, by size */
    double shortest[MOST_ROWS]; /* (n) the same against the shortest repetition */
    double at[MOST_ROWS];       /* (nat) the same at their condition */
    double least, most;         /* of these: how many times longer the prediction is there */
    int n, nat, shown, missing, unnoted;
    char machines[256]; /* told last: which machine predicts, and what was measured */
    struct json json;
};

/* Against the shortest undisturbed repetition. */
static double error_of_shortest(const struct measured_run *m, const struct prediction *p)
{
    return p->predicted / m->real.time.min - 1;
}

/* --- printing --------------------------------------------------------------------------------- */

/* Measured, then predicted; a stage that only one of the two has shows nan for the other one. */
static void print_stages(const struct prediction *p)
{
    for (int i = 0; i < p->nstage; i++) {
        const struct predicted_stage *s = &p->stage[i];
        printf("    %-24s %12.3f %12.3f us\n", s->name, s->measured * 1e6, s->predicted * 1e6);
    }
}

/* What a run is predicted on, as tables and figures call it. */
static const char *machine_of(const struct run_spec *spec)
{
    return spec->called != NULL && spec->called[0] != '\0' ? spec->called : spec->machine.name;
}

/* Which machine predicts and which computer was measured, before the first row and wherever one of
 * them changes: they are two, and may be meant to be one. */
static void print_machines(struct summary *s, const struct run_spec *spec,
                           const struct measured_run *m)
{
    char now[sizeof s->machines];
    snprintf(now, sizeof now, "predicted on %s, measured on %s", machine_of(spec), m->host);
    if (strcmp(now, s->machines) == 0) return;
    text_copy(s->machines, sizeof s->machines, now);
    printf("%s\n", now);
}

/* The title comes with the first row, so that an empty answer is only its message. The load is that
 * of the measurement: a difference that is due to other programs is not the model's. */
static void print_row(struct summary *s, const struct run_spec *spec, const struct measured_run *m,
                      const struct prediction *p, const struct at_condition *at)
{
    char why[48] = "-", load[24] = "-", slower[24] = "-", error[24] = "-";
    print_machines(s, spec, m);
    if (s->shown == 0)
        printf("%-18s %6s %4s %12s %12s %12s %8s %6s %7s %11s  %-34s %s\n", "program", "n", "P",
               "measured_us", "shortest_us", "predicted_us", "error_%", "load", "slower",
               "corrected_%", "explained by", "stage");
    if (p->explains < PRICES)
        snprintf(why, sizeof why, "%s x %.2f", price_name(p->explains), p->factor);
    if (isfinite(m->real.load.others)) snprintf(load, sizeof load, "%.2f", m->real.load.others);
    else if (isfinite(m->real.load.before))
        snprintf(load, sizeof load, "(%.1f)", m->real.load.before);
    if (at->known) {
        snprintf(slower, sizeof slower, "%.2f", at->slower);
        snprintf(error, sizeof error, "%.1f", 100 * at->error);
    }
    printf("%-18s %6d %4d %12.3f %12.3f %12.3f %8.1f %6s %7s %11s  %-34s %s%s%s\n",
           spec->kernel.name, spec->model.nbody, spec->nrank, p->measured * 1e6,
           m->real.time.min * 1e6, p->predicted * 1e6, 100 * p->error, load, slower, error, why,
           p->worst >= 0 ? p->stage[p->worst].name : "-",
           measured_run_left_out(m)[0] != '\0' ? "; not counted: " : "", measured_run_left_out(m));
    if (s->stages) print_stages(p);
}

/* The same for programs, with all stages and in SI units; keys are in alphabetical order, as
 * everywhere. */
static void print_json(struct summary *s, const struct run_spec *spec, const struct measured_run *m,
                       const struct prediction *p, const struct at_condition *at)
{
    struct json *j = &s->json;
    json_object(j);
    json_key_int(j, "P", spec->nrank);
    json_key_int(j, "bursts", m->condition.bursts);
    json_key_bool(j, "counted", measured_run_left_out(m)[0] == '\0');
    json_key_real(j, "error", p->error);
    json_key_real(j, "error_at_condition", at->known ? at->error : NAN);
    json_key_real(j, "error_of_shortest", error_of_shortest(m, p));
    json_key_text(j, "explained_by", p->explains < PRICES ? price_name(p->explains) : "");
    json_key_real(j, "factor", p->factor);
    json_key_text(j, "host", m->host);
    json_key_real(j, "load_before", m->real.load.before);
    json_key_real(j, "load_others", m->real.load.others);
    json_key_text(j, "machine", machine_of(spec));
    json_key_real(j, "measured_at_condition_s", at->known ? at->measured : NAN);
    json_key_real(j, "measured_s", p->measured);
    json_key_int(j, "n", spec->model.nbody);
    json_key_real(j, "predicted_at_condition_s", at->known ? at->predicted : NAN);
    json_key_real(j, "predicted_s", p->predicted);
    json_key_text(j, "program", spec->kernel.name);
    json_key_real(j, "shortest_s", m->real.time.min);
    json_key_real(j, "slower", at->known ? at->slower : NAN);
    json_key(j, "stages");
    json_array(j);
    for (int i = 0; i < p->nstage; i++) {
        json_object(j);
        json_key_real(j, "measured_s", p->stage[i].measured);
        json_key_text(j, "name", p->stage[i].name);
        json_key_real(j, "predicted_s", p->stage[i].predicted);
        json_end(j);
    }
    json_end(j);
    json_key_int(j, "steady_bursts", m->condition.steady);
    json_key_text(j, "utc", m->utc);
    json_end(j);
}

/* The median is that of the sorted errors, the upper one of two. Tasks without a measurement are
 * told once, since a scenario may sweep more than was measured. */
static void print_summary(struct summary *s)
{
    if (s->missing > 0 && !s->c->quiet)
        fprintf(stderr, "mimdsim: %d of the tasks have no measured run in %s\n", s->missing,
                s->c->database);
    if (s->unnoted > 0 && !s->c->quiet)
        fprintf(stderr, "mimdsim: the machine file does not say how fast the computer was when it "
                        "was calibrated, so no prediction is corrected for its speed at a run: "
                        "calibrate again\n");
    if (s->c->json || s->n == 0) return;
    sort_numbers(s->error, (size_t)s->n);
    sort_numbers(s->shortest, (size_t)s->n);
    printf("error of %d: median %.1f %%, largest %.1f %%; against the shortest repetitions: median "
           "%.1f %%, largest %.1f %%\n",
           s->n, 100 * s->error[s->n / 2], 100 * s->error[s->n - 1], 100 * s->shortest[s->n / 2],
           100 * s->shortest[s->n - 1]);
    if (s->nat == 0) return;
    sort_numbers(s->at, (size_t)s->nat);
    printf("error of %d, corrected for the speed of the computer at each run (which makes "
           "predictions %.2f to %.2f times as long): median %.1f %%, largest %.1f %%\n",
           s->nat, s->least, s->most, 100 * s->at[s->nat / 2], 100 * s->at[s->nat - 1]);
}

/* --- the command ------------------------------------------------------------------------------ */

/* Runs that differ only in machine or level are one task, simulated on the first one's machine: a
 * plan with several machines is to be asked about one at a time. */
static bool is_first(const struct plan *p, const struct run_spec *task, int i)
{
    (void)p;
    for (int k = 0; k < i; k++)
        if (strcmp(task[k].config_hash, task[i].config_hash) == 0) return false;
    return true;
}

/* A shipped machine is never the computer at hand. Who means to compare with one says so; who
 * forgot the machine file of this computer would take the difference for an error of the model. */
static bool check_machine(const struct summary *s, const struct run_spec *run,
                          const struct measured_run *m, struct err *e)
{
    bool named = s->c->machine != NULL || run->machine_changes == NULL;
    for (int i = 0; i < s->c->nset; i++)
        named = named || strncmp(s->c->set[i], "machine=", 8) == 0;
    return named ||
           err_set(e, ERR_USAGE,
                   "the runs were measured on %s, and %s is another machine: name the machine file "
                   "of %s with --machine (mpirun -n 2 mimdsim calibrate writes one), or say "
                   "--machine %s to compare with that",
                   m->host, run->machine.name, m->host, run->machine.name);
}

/* How fast the computer was when run i's machine was measured; false where its file does not say.
 * A machine that nobody measured has nothing to say. */
static bool reference_of(struct summary *s, const struct plan *p, int i,
                         struct condition_reference *out)
{
    const struct origin *origin;
    int n;
    plan_origins(p, i, &origin, &n);
    if (condition_reference_of(origin, n, out)) return true;
    for (int k = 0; k < n; k++)
        s->unnoted += strcmp(origin[k].key, "node.flop_rate") == 0 &&
                      strcmp(origin[k].evidence, "measured") == 0;
    return false;
}

/* Each steady burst beside what the machine would predict at the burst's condition. The one whose
 * error is the middle one stands for the run: a look that missed a change does not decide. */
static bool predict_at(struct summary *s, const struct plan *p, int i, const struct measured_run *m,
                       double as_it_is, struct run_cache *cache, struct at_condition *out,
                       struct err *e)
{
    struct condition_reference reference;
    double error[REAL_BURSTS], predicted[REAL_BURSTS];
    const struct condition *c = &m->condition;
    *out = (struct at_condition){0};
    if (c->steady == 0 || !reference_of(s, p, i, &reference)) return true;
    for (int k = 0; k < c->steady; k++) {
        struct run_spec spec = p->run[i];
        struct arena *a = arena_create();
        struct run_result *r = TAKE(a, 1, struct run_result);
        condition_apply(&spec.machine, &reference, &c->burst[k].speed);
        const bool ok = predict_simulate(&spec, cache, a, r, e);
        if (ok) predicted[k] = (double)r->makespan_ps * 1e-12;
        arena_destroy(a);
        if (!ok) return false;
        error[k] = predicted[k] / c->burst[k].seconds - 1;
    }
    const int middle = condition_middle(error, c->steady);
    *out = (struct at_condition){true, c->burst[middle].seconds, predicted[middle], error[middle],
                                 predicted[middle] / as_it_is};
    return true;
}

/* What counts, with and without the condition. */
static void count(struct summary *s, const struct measured_run *m, const struct prediction *p,
                  const struct at_condition *at)
{
    if (s->n == MOST_ROWS) return;
    s->shortest[s->n] = fabs(error_of_shortest(m, p));
    s->error[s->n++] = fabs(p->error);
    if (!at->known) return;
    if (s->nat == 0) s->least = s->most = at->slower;
    s->least = fmin(s->least, at->slower);
    s->most = fmax(s->most, at->slower);
    s->at[s->nat++] = fabs(at->error);
}

/* A task that nobody measured costs nothing; one that was is simulated about a dozen times
 * (predict.c). */
static bool predict_one(struct summary *s, const struct plan *plan, int i,
                        const struct run_spec *task, struct run_cache *cache, struct err *e)
{
    const struct run_spec *run = &plan->run[i];
    struct measured_run m;
    struct prediction p;
    struct at_condition at;
    if (!measured_run_find(s->store, task->config_hash, &m, e)) return false;
    if (!m.found) {
        s->missing++;
        return true;
    }
    if (!check_machine(s, run, &m, e) || !predict_run(run, &m.real, cache, &p, e) ||
        !predict_at(s, plan, i, &m, p.predicted, cache, &at, e))
        return false;
    if (s->c->json) print_json(s, run, &m, &p, &at);
    else print_row(s, run, &m, &p, &at);
    s->shown++;
    if (measured_run_left_out(&m)[0] == '\0') count(s, &m, &p, &at);
    return true;
}

/* Scenes and serial answers are shared among all simulations of the table. */
static bool predict_all(struct summary *s, const struct plan *p, struct err *e)
{
    struct run_spec *task = TAKE(p->arena, p->nrun, struct run_spec);
    struct run_cache *cache = run_cache_create();
    bool ok = true;
    s->json = json_make(stdout);
    if (s->c->json) json_array(&s->json);
    for (int i = 0; ok && i < p->nrun; i++) {
        task[i] = task_of(&p->run[i], p->arena);
        if (p->run[i].refused == NULL && is_first(p, task, i))
            ok = predict_one(s, p, i, &task[i], cache, e);
    }
    run_cache_destroy(cache);
    if (ok && s->c->json) {
        json_end(&s->json);
        json_finish(&s->json);
    }
    if (ok && s->shown == 0)
        ok =
            err_set(e, ERR_NO_INPUT,
                    "%s has no measured run of this scenario; make some by mpirun -n 2 mimdsim run "
                    "%s --backend mpi --set ranks=2, and ask here with the same --set",
                    s->c->database, p->name);
    if (ok) print_summary(s);
    return ok;
}

/* Nothing is stored: the same question can be asked of another machine file at once. */
int cmd_predict(int argc, char **argv)
{
    struct common c;
    struct summary *s = memory_zeroed(1, sizeof *s);
    struct plan p = {0};
    struct err e;
    err_clear(&e);
    s->c = &c;
    s->stages = take_flag(&argc, argv, "--stages");
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_STORE, "SCENARIO|PROGRAM", doc, 1, 1);
    struct plan_options o = common_plan(&c);
    bool ok = plan_read(&p, c.arg[0], &o, &e);
    s->store = ok ? store_open(c.database, STORE_READ, &e) : NULL;
    ok = ok && s->store != NULL && predict_all(s, &p, &e);
    store_close(s->store);
    plan_free(&p);
    free(s);
    return ok ? 0 : common_fail(&c, &e);
}
