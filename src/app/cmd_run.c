/* cmd_run.c - mimdsim run: answer a scenario.
 *
 * The database is the answer; the table is what a person reads of it. Runs that are stored are
 * not made again, so a scenario can be extended, interrupted and begun again at no cost. */
#include <stdlib.h>
#include <string.h>

#include "app/answer.h"
#include "app/arguments.h"
#include "app/backend.h"
#include "app/campaign_mpi.h"
#include "app/flag.h"
#include "app/known_error.h"
#include "app/levels.h"
#include "app/run_table.h"
#include "app/search.h"
#include "app/shard.h"
#include "app/uncertainty.h"
#include "app/verb.h"
#include "base/check.h"
#include "base/memory.h"
#include "report/report.h"
#include "run/interrupt.h"
#include "run/run.h"
#include "spec/run_label.h"
#include "store/store.h"
#include "store/swept.h"
#include "study/model_file.h"

static const char doc[] =
    "Run every point of SCENARIO, store each in the database, and print the table.\n\n"
    "Example: mimdsim run scenarios/speedup-t3e.yaml --set machine.network.link.bandwidth=\"960 "
    "MB/s\"\n"
    "\vRuns that are stored already are not repeated, unless --force is given. If the result of a "
    "run is wrong, the run is stored as invalid and the exit status is 1; a deadlock ends with 70. "
    "If a point cannot run, its worker process dies, or simulated time overflows (13.3 days), it "
    "is stored as failed, with the reason. The other points run, and the exit status is 1. A plan "
    "with no valid point is refused. Failed points are tried again the next time.\n\n"
    "--shard K/N: only the runs of shard K of N, so that N hosts share the plan (mimdsim merge "
    "joins their databases). --point ID: only this run of the plan (mimdsim plan lists them).\n\n"
    "PROGRAM: a program of your own, as source or as made by mimdsim cc, makes a scenario by "
    "itself (t3e-300, 1 to 16 ranks); see docs/own-program.md. --limit SECONDS: a run of such a "
    "program has failed when it takes more processor time than this (default 600 s).\n\n"
    "--campaign mpi: the processes that mpirun has started share the plan, and the first one "
    "stores the results: mpirun -n 8 mimdsim run fig6 --campaign mpi. Each makes --jobs runs at a "
    "time (default 1).\n\n"
    "--threads N|auto: host threads for each run. Where the order of ranks acts on nothing (level "
    "loggp), or only through the network (level link), several run its ranks at once, with the "
    "same results to the bit (docs/parallel.md: all conditions). auto, the default: as many as "
    "help, on the processors that --jobs leaves.\n\n"
    "--spread mpi: the processes that mpirun has started share the ranks of each run, so that its "
    "memory is divided among them: mpirun -n 2 mimdsim run SCENARIO --spread mpi. Runs that need "
    "the order of time (see --threads) stay in the first process.\n\n"
    "--uncertainty N: draw the uncertain parameters of the machine from their ranges, run each "
    "point again with them, and show the band that holds 90 % of the predicted times, and which "
    "parameters it comes from: N (k + 2) runs for k parameters, or 2 N with --bands-only "
    "(docs/studies.md).\n\n"
    "The table shows the columns that matter for these runs, and how far each time is known: the "
    "error of the network level, of the machine's parameters, of the arithmetic. --columns NAMES: "
    "these columns instead (names with commas, or all). --csv: all of them, for programs.\n\n"
    "A scenario with `optimise:` is searched: the answer is the best setting for each point of the "
    "other axes (docs/studies.md).\n\n"
    "A scenario with `answer:` is answered by a sentence below the table, and by a picture in the "
    "folder --dir (docs/what-if.md): mimdsim run what-if-failed-link.\n\n"
    "--keep-all: also compute what the scene does not need (mimdsim explain lists it, and the "
    "error bound of leaving it out); the predicted time includes it.";

/* What run_campaign's results are counted and stored by. */
struct keep {
    struct store *store;
    struct err *error;
    struct identity *by; /* owned, of the plan's runs */
    /* (the plan's number) the runs that are made, and how each is executed */
    const struct run_spec *run;
    struct run_order *order; /* in step with `run` */
    int invalid, deadlock, redundant, refined, alone; /* runs that ended so */
    int done, failed;      /* runs, failed ones among them */
    struct interrupt interrupt;
    char reason[300];      /* of the run that was told last to have gone wrong, "": none was */
    int alike, untold;     /* runs in a row for this reason, those of them that were not told */
    int refusals, refusal; /* those that could not be made, err_kind of the first */
    double limit;          /* of people's own programs [s], 0: as usual */
    int threads;           /* of each run, as in run_order */
    bool quiet, keep_all;
    bool spread;           /* each run is shared by the processes of a job */
    bool whole;            /* the only run: a new database is there when all of it is */
};

/* How many more runs ended for the reason that was told last. */
static void say_rest(struct keep *k)
{
    if (k->untold > 0) fprintf(stderr, "mimdsim: and %d more: %s\n", k->untold, k->reason);
    k->alike = k->untold = 0;
    k->reason[0] = '\0';
}

/* The same reason again and again, as of a placement that no machine of the sweep takes, is told of
 * the first runs only: each row has it. */
static void say_wrong(struct keep *k, const struct run_spec *spec, const struct run_result *r)
{
    enum { TOLD = 3 };
    char reason[sizeof k->reason];
    text_copy(reason, sizeof reason, r->text);
    if (strcmp(k->reason, reason) != 0) say_rest(k);
    text_copy(k->reason, sizeof k->reason, reason);
    if (k->alike++ >= TOLD) k->untold++;
    else
        fprintf(stderr, "mimdsim: %s%s: %s\n", spec->kernel.name, run_size(spec, spec->nrank).s,
                r->text);
}

/* One result, in plan order: counted, told where it is no plain success, stored. Remarks that
 * hold for many runs are made once. */
static bool keep_result(void *context, const struct run_spec *spec, const struct run_result *r)
{
    struct keep *k = context;
    k->done++;
    k->invalid += r->status == RUN_INVALID || r->status == RUN_FAILED;
    k->failed += r->status == RUN_FAILED;
    if (r->refusal && k->refusals++ == 0) k->refusal = r->refusal;
    k->deadlock += r->status == RUN_DEADLOCK;
    if (r->status != RUN_OK) say_wrong(k, spec, r);
    else if (r->loop_rank >= 0 && r->loop_rank < r->loop_rows && k->redundant++ == 0 && !k->quiet)
        fprintf(stderr,
                "mimdsim: %d of %d loop constraints are redundant: solved with least norm\n",
                r->loop_rows - r->loop_rank, r->loop_rows);
    if (r->alone[0] && k->alone++ == 0 && !k->quiet)
        fprintf(stderr, "mimdsim: %s%s: %s: %s\n", spec->kernel.name,
                run_size(spec, spec->nrank).s, k->spread ? "in one process" : "on one thread",
                r->alone);
    if (run_result_refined(r) && k->refined++ == 0 && !k->quiet)
        fprintf(stderr,
                "mimdsim: %s%s: refinement switched on (%d inner, %d outer%s), the residual was "
                "%.2g\n",
                spec->kernel.name, run_size(spec, spec->nrank).s, r->inner_added, r->outer_added,
                r->twice_added ? ", twice the digits" : "", r->residual_before);
    const bool stored = store_put(k->store, spec, &k->order[spec - k->run], r, k->error);
    if (stored && !k->whole) atomic_fetch_add(&k->interrupt.stored, 1);
    return stored;
}

/* A launcher ends all processes when one has died, without a word from this one. So the run is
 * stored as failed before it begins, and its result takes the place of that. */
static bool begin_spread(void *context, const struct run_spec *spec)
{
    struct keep *k = context;
    struct err why;
    err_clear(&why);
    err_set(&why, ERR_INTERNAL,
            "the job ended while its processes made this run: one of them died, or it was stopped");
    struct run_result r = run_refused(&why);
    r.nrank = spec->nrank;
    return store_put(k->store, spec, &k->order[spec - k->run], &r, k->error);
}

/* Which part of the plan is asked for. */
struct part {
    struct shard shard;
    const char *point; /* "HASH-REP" or the beginning of one; NULL: all */
};

/* Whether `point` is the beginning of the run's name, HASH-REP; NULL: any run. */
static bool is_point(const char *point, const struct run_spec *r)
{
    char id[RUN_NAME];
    run_name(r, id);
    return point == NULL || strncmp(id, point, strlen(point)) == 0;
}

/* What the options of this verb ask for. */
struct asked {
    bool keep_all;
    double limit; /* [s], 0: as usual */
    int threads;
    struct part part;
    struct uncertainty_options uncertainty;
    struct run_table_look look;
};

/* Options of this verb alone, taken out before the common ones are read. */
static bool take_options(int *argc, char **argv, struct asked *a, struct err *e)
{
    a->keep_all = take_flag(argc, argv, "--keep-all");
    const char *shard = take_value(argc, argv, "--shard");
    a->part.point = take_value(argc, argv, "--point");
    return take_seconds(argc, argv, "--limit", &a->limit, e) &&
           take_threads(argc, argv, &a->threads, e) &&
           uncertainty_take(argc, argv, &a->uncertainty, e) &&
           run_table_take(argc, argv, &a->look, e) && shard_parse(shard, &a->part.shard, e);
}

/* A point is one run: what names none, or several, was mistyped or cut too short. */
static bool check_point(const char *point, const struct plan *p, struct err *e)
{
    int n = 0;
    for (int i = 0; point != NULL && i < p->nrun; i++) n += is_point(point, &p->run[i]);
    if (point == NULL || n == 1) return true;
    return err_set(e, ERR_USAGE, "--point '%.80s': %s; `mimdsim plan` lists the runs", point,
                   n == 0 ? "no run of this plan" : "the beginning of several runs");
}

/* What is stored already, and what other shards make. The plan's own runs decide about the shard:
 * every host reads the same, before levels are settled by what its database knows. */
static bool *skipped(struct store *s, const struct plan *p, const struct run_spec *settled,
                     const struct part *part, bool force)
{
    bool *skip = memory_zeroed((size_t)p->nrun, sizeof *skip);
    for (int i = 0; i < p->nrun; i++)
        skip[i] = !shard_has(&part->shard, &p->run[i]) || !is_point(part->point, &p->run[i]) ||
                  (!force && store_has(s, &settled[i]));
    return skip;
}

/* How many runs are left to be made; what is stored already is told, as it takes no time. */
static int say_skipped(const struct common *c, const struct plan *p, const struct part *part,
                       const bool *skip)
{
    int mine = 0, todo = 0;
    for (int i = 0; i < p->nrun; i++) {
        mine += shard_has(&part->shard, &p->run[i]) && is_point(part->point, &p->run[i]);
        todo += !skip[i];
    }
    if (todo < mine && !c->quiet)
        fprintf(stderr, "mimdsim: %d of %d runs are stored already (--force repeats them)\n",
                mine - todo, mine);
    return todo;
}

/* Runs of its own for the settled plan, everything else is shared; and how each is executed. */
static struct run_spec *orders_usual(const struct plan *p, struct keep *k, struct plan *settled)
{
    struct run_spec *run = TAKE(p->arena, p->nrun, struct run_spec);
    memcpy(run, p->run, (size_t)p->nrun * sizeof *run);
    k->run = settled->run = run;
    k->order = TAKE(p->arena, p->nrun, struct run_order);
    const struct run_order usual = {
        .keep = k->keep_all ? KEEP_ALL : 0, .host_limit = k->limit, .threads = k->threads};
    for (int i = 0; i < p->nrun; i++) k->order[i] = usual;
    return run;
}

/* Settings that act in no run. */
static void say_unused(const struct plan *p)
{
    for (int i = 0; i < p->nunused; i++) fprintf(stderr, "mimdsim: unused: %s\n", p->unused[i]);
}

static void say_failed(const struct keep *k)
{
    fprintf(stderr,
            "mimdsim: %d of %d runs failed; each is stored with its reason, and tried again next "
            "time\n",
            k->failed, k->done);
}

/* Runs that are stored already get the name that is given now; without one they keep theirs. */
static bool call_stored(struct store *s, const struct run_spec *run, const bool *skip, int n,
                        struct err *e)
{
    /* One transaction for all: a name costs no more than a row. */
    bool ok = store_begin(s, e);
    for (int i = 0; i < n && ok; i++)
        if (skip[i] && run[i].label[0] != '\0') ok = store_call(s, &run[i], e);
    if (ok) return store_commit(s, e);
    store_rollback(s);
    return false;
}

/* Whether one run is all that there is to store: then nothing is lost by storing it at the end, and
 * a new database costs one flush. */
static bool is_single(const struct plan *p, const struct asked *asked, const struct job *job,
                      const struct keep *k)
{
    return p->nrun == 1 && !job->on && !k->spread && asked->uncertainty.n == 0 && p->search == NULL;
}

/* Whether the rows are followed by an answer: for people, and not of a part of the runs. */
static bool is_answered(const struct plan *p, const struct asked *asked)
{
    const struct run_table_look *look = &asked->look;
    return p->answer != NULL && !look->json && !look->csv && look->columns == NULL &&
           asked->part.shard.of == 0 && asked->part.point == NULL;
}

/* The question's answer behind the rows, for people: a sentence, then the picture. */
static bool answer_question(const struct common *c, const struct plan *p, const struct asked *asked,
                            struct store *s, struct err *e)
{
    if (!is_answered(p, asked)) return true;
    struct text said = {0};
    struct arena *a = arena_create();
    const struct answer *x = answer_read(p, s, a, e);
    if (x != NULL) {
        answer_sentence(x, &said);
        printf("\n%s\n%s\n", p->question, said.s);
        fflush(stdout);
    }
    const bool ok = x != NULL && answer_draw(x, s, c->directory, e);
    if (ok && !c->quiet) printf("%s/%s.png\n", c->directory, p->name);
    text_free(&said);
    arena_destroy(a);
    return ok;
}

/* Settle levels, leave out what is stored, run the rest, print all. */
static bool answer(const struct common *c, const struct plan *p, const struct asked *asked,
                   struct job *job, struct keep *k, struct err *e)
{
    struct plan settled = *p;
    if (!c->quiet) say_unused(p);
    /* A robot that cannot be read is told before a database is made. */
    if (!model_file_look(p->run, p->nrun, c->quiet ? NULL : stderr, e)) return false;
    if (is_answered(p, asked) && !report_folder_check(c->directory, e)) return false;
    k->whole = is_single(p, asked, job, k);
    k->store = k->whole ? arguments_store_whole(c, c->database, e)
                        : arguments_store(c, c->database, e);
    if (!k->store) return false;
    struct run_spec *run = orders_usual(p, k, &settled);
    if (!levels_settle(k->store, run, k->order, p->nrun, c->quiet, p->arena, e)) return false;
    bool *skip = skipped(k->store, p, settled.run, &asked->part, c->force);
    const int todo = say_skipped(c, p, &asked->part, skip);
    bool ok = call_stored(k->store, k->run, skip, p->nrun, e);
    /* a launcher has its own way of ending a job */
    if (k->whole && todo > 0 && !run_loads_code(k->run)) interrupt_begin_single(&k->interrupt);
    else interrupt_begin(&k->interrupt, c->database, job->on ? 0 : todo);
    if (ok && k->spread)
        ok = job_spread(job, p, run, k->order, skip, begin_spread, keep_result, k, e);
    else if (ok && job->on) ok = job_run(job, p, run, k->order, skip, c, keep_result, k, e);
    else if (ok)
        ok = run_campaign(k->run, k->order, p->nrun, skip, c->jobs, c->quiet, keep_result, k, e);
    /* What is known of the errors, before the rows are shown. */
    ok = ok && known_error_note(k->store, k->by, k->run, p->nrun, e) &&
         store_swept_view(k->store, e) && store_publish(k->store, e);
    if (ok && k->whole) atomic_fetch_add(&k->interrupt.stored, k->done);
    interrupt_end(&k->interrupt);
    free(skip);
    say_rest(k);
    const struct uncertainty_options *u = &asked->uncertainty;
    ok = ok && (u->n == 0 || uncertainty_run(c, &settled, u, k->store, e));
    const bool search =
        settled.search != NULL && asked->part.shard.of == 0 && asked->part.point == NULL;
    ok = ok && (!search || search_run(&settled, k->store, e));
    if (ok && search && asked->look.columns == NULL)
        return search_print(k->store, &settled, &asked->look, stdout, e);
    if (!ok || !run_table_print(k->store, &settled, &asked->look, stdout, e)) return false;
    if (!answer_question(c, &settled, asked, k->store, e)) return false;
    return u->n == 0 || !u->shares || asked->look.json || asked->look.csv ||
           uncertainty_print(k->store, &settled, stdout, e);
}

/* What the other processes of a job do of this: they make runs, and store and print nothing. */
static bool help_out(struct job *job, const struct common *c, const struct plan *p, struct keep *k,
                     struct err *e)
{
    struct plan settled = *p;
    struct run_spec *run = orders_usual(p, k, &settled);
    if (k->spread) return job_spread(job, p, run, k->order, NULL, begin_spread, keep_result, k, e);
    return job_run(job, p, run, k->order, NULL, c, keep_result, k, e);
}

/* Worst first: an error of the command, a deadlock, a plan of which nothing could run, wrong or
 * failed runs. */
static int exit_status(bool ok, const struct keep *k, bool none, const struct common *c,
                       const struct err *e)
{
    if (!ok && e->kind == ERR_NONE) return 0; /* the first process of a job says why */
    if (!ok) return common_fail(c, e);
    if (k->deadlock) return err_exit_status(ERR_DEADLOCK);
    if (k->failed > 0) say_failed(k);
    if (k->refusals > 0 && none) return err_exit_status((enum err_kind)k->refusal);
    return k->invalid ? err_exit_status(ERR_CHECK) : 0;
}

/* --spread mpi: each run on all processes; --campaign mpi: whole runs on each. */
static bool spread_parse(const char *spread, const char *campaign, struct err *e)
{
    if (spread == NULL) return true;
    if (strcmp(spread, "mpi") != 0)
        return err_set(e, ERR_USAGE, "--spread '%.40s': expected mpi", spread);
    return campaign == NULL ||
           err_set(e, ERR_USAGE, "--spread and --campaign: a job does one or the other");
}

/* The whole of it, on one process or on several. */
int cmd_run(int argc, char **argv)
{
    struct common c;
    struct asked asked = {0};
    struct job job = {.kept = -1};
    struct err e;
    err_clear(&e);
    const char *backend = take_value(&argc, argv, "--backend");
    if (backend != NULL) return backend_run(argc, argv, backend);
    const char *campaign = take_value(&argc, argv, "--campaign"),
               *spread = take_value(&argc, argv, "--spread");
    const bool understood = take_options(&argc, argv, &asked, &e);
    bool ok = spread_parse(spread, campaign, &e) &&
              job_open(&job, spread ? spread : campaign, &e) && understood;
    /* The processes of a job share the processors already. */
    if (job.on && asked.threads == RUN_THREADS_AUTO) asked.threads = 1;
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_STORE | TAKES_JOBS | TAKES_DIR,
                 "SCENARIO|PROGRAM", doc, 1,
                 1);
    job_heard(&job, &c);
    asked.look.json = c.json;
    struct plan p = {0};
    struct plan_options o = common_plan(&c);
    struct keep k = {.error = &e,
                     .by = o.identity = identity_of_runs(),
                     .quiet = c.quiet,
                     .limit = asked.limit,
                     .keep_all = asked.keep_all,
                     .threads = asked.threads,
                     .spread = spread != NULL};
    ok = ok && plan_read(&p, c.arg[0], &o, &e) && check_point(asked.part.point, &p, &e) &&
         run_table_check(&p, &asked.look, &e) &&
         uncertainty_count(&p, &asked.uncertainty, &e) && search_check(&p, &e) &&
         answer_check(&p, &e);
    ok = job_agree(&job, &p, ok, &e);
    c.force = c.force || asked.keep_all; /* the same results, but not the same row */
    if (ok)
        ok =
            job.h.rank == 0 ? answer(&c, &p, &asked, &job, &k, &e) : help_out(&job, &c, &p, &k, &e);
    store_close(k.store);
    const bool none = k.refusals == p.nrun; /* nothing of the plan could run */
    plan_free(&p);
    identity_destroy(k.by);
    return job_end(&job, exit_status(ok, &k, none, &c, &e));
}
