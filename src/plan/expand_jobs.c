/* expand_jobs.c - the jobs of a scenario at one point of its sweep: a run for each job of each
 * combination.
 *
 * All jobs are resolved once; every combination has its own list of who is idle. So the places of
 * all jobs are the same in each of them, and a run alone differs from one beside others by the
 * others' messages and nothing else. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "plan/expand_parts.h"
#include "spec/spec_fields.h"

/* Combinations of the jobs, one after the other: the i-th of n, whose jobs run. False behind the
 * last. */
struct combination {
    const struct scenario_jobs *jobs;
    unsigned left; /* COMBINE_* that are still to come */
    int first, second; /* of pairs; first of those alone */
    bool runs[JOB_MOST];
};

/* What pairs or single jobs say already is not run again as all. */
static struct combination combination_start(const struct scenario_jobs *jobs)
{
    /* One job is all of them; two are a pair. */
    unsigned which = jobs->combine != 0 ? jobs->combine : COMBINE_ALL;
    if (jobs->n == 1) which = COMBINE_ALL;
    if (jobs->n == 2 && (which & COMBINE_PAIRS)) which &= ~(unsigned)COMBINE_ALL;
    return (struct combination){.jobs = jobs, .left = which, .second = 1};
}

/* Alone first, then pairs, then all. */
static bool combination_next(struct combination *c)
{
    const int n = c->jobs->n;
    /* Each kind crosses itself out when its last combination is made. */
    memset(c->runs, 0, sizeof c->runs);
    if (c->left & COMBINE_ALONE) {
        c->runs[c->first++] = true;
        if (c->first == n) c->left &= ~(unsigned)COMBINE_ALONE, c->first = 0;
        return true;
    }
    if (c->left & COMBINE_PAIRS) {
        /* 0 with 1, 2, ..., then 1 with 2, 3, ... */
        c->runs[c->first] = c->runs[c->second] = true;
        if (++c->second == n) c->second = ++c->first + 1;
        if (c->first + 1 >= n) c->left &= ~(unsigned)COMBINE_PAIRS;
        return true;
    }
    if (!(c->left & COMBINE_ALL)) return false;
    c->left = 0;
    for (int i = 0; i < n; i++) c->runs[i] = true;
    return true;
}

int64_t expand_jobs_runs(const struct scenario_jobs *jobs)
{
    struct combination c = combination_start(jobs);
    int64_t n = 0;
    /* Counted by the same steps that make them. */
    while (combination_next(&c))
        for (int i = 0; i < jobs->n; i++) n += c.runs[i];
    return n;
}

/* ---- do they fit */

/* A processor that a list names. */
struct place {
    int processor, job, rank;
};

static int compare_places(const void *a, const void *b)
{
    const struct place *x = a, *y = b;
    if (x->processor != y->processor) return x->processor < y->processor ? -1 : 1;
    if (x->job != y->job) return x->job < y->job ? -1 : 1;
    return x->rank < y->rank ? -1 : x->rank > y->rank;
}

/* A list has a processor of the machine for every rank. */
static bool check_list(struct expansion *x, const struct run_spec *job, int i, int64_t all,
                       struct err *e)
{
    const struct scenario_job *j = &x->scenario->jobs->job[i];
    const struct placement_spec *s = &job[i].machine.placement;
    /* Orders and chance find their places when the run is made. */
    if (s->kind != PLACEMENT_LIST) return true;
    if (s->nlist < job[i].nrank)
        return err_set_at(e, ERR_CONFIG, x->scenario->path, j->line,
                          "job '%s' has %d ranks, but its list names %d processors", j->name,
                          job[i].nrank, s->nlist);
    for (int r = 0; r < job[i].nrank; r++)
        if (s->list[r] >= all)
            return err_set_at(e, ERR_CONFIG, x->scenario->path, j->line,
                              "job '%s': processor %d of rank %d; expected 0 to %lld", j->name,
                              s->list[r], r, (long long)all - 1);
    return true;
}

/* Lists of two jobs must not meet. */
static bool check_lists(struct expansion *x, const struct run_spec *job, struct err *e)
{
    const struct scenario_jobs *jobs = x->scenario->jobs;
    size_t n = 0;
    bool fine = true;
    for (int i = 0; i < jobs->n; i++)
        if (job[i].machine.placement.kind == PLACEMENT_LIST) n += (size_t)job[i].nrank;
    /* Sorted by processor, two that meet stand side by side: n log n for lists of any length. */
    struct arena *scratch = arena_create();
    struct place *place = TAKE(scratch, n + 1, struct place);
    /* Only ranks that there are: a list may be longer. */
    n = 0;
    for (int i = 0; i < jobs->n; i++) {
        const struct placement_spec *s = &job[i].machine.placement;
        if (s->kind != PLACEMENT_LIST) continue;
        for (int r = 0; r < job[i].nrank && r < s->nlist; r++)
            place[n++] = (struct place){s->list[r], i, r};
    }
    qsort(place, n, sizeof *place, compare_places);
    for (size_t k = 1; k < n && fine; k++) {
        const struct place *a = &place[k - 1], *b = &place[k];
        if (a->processor != b->processor || a->job == b->job) continue;
        fine = err_set_at(e, ERR_CONFIG, x->scenario->path, jobs->job[b->job].line,
                          "jobs '%s' and '%s' overlap: rank %d of one and rank %d of the other on "
                          "processor %d",
                          jobs->job[a->job].name, jobs->job[b->job].name, a->rank, b->rank,
                          a->processor);
    }
    arena_destroy(scratch);
    return fine;
}

/* All jobs together, those that are idle included: their places are kept. */
static bool check_room(struct expansion *x, const struct run_spec *job, struct err *e)
{
    const struct scenario_jobs *jobs = x->scenario->jobs;
    const int64_t all = machine_spec_processors(&job[0].machine); /* one machine for all */
    int64_t used = 0;
    /* The job that has no room any more is told, with its line. */
    for (int i = 0; i < jobs->n; i++) {
        if (job[i].nrank > all - used)
            return err_set_at(e, ERR_CONFIG, x->scenario->path, jobs->job[i].line,
                              "job '%s' has %d ranks, but the jobs before it leave %lld of the "
                              "%lld processors of machine '%s'; reduce ranks or enlarge "
                              "machine.topology.dims",
                              jobs->job[i].name, job[i].nrank, (long long)(all - used),
                              (long long)all, job[i].machine.name);
        used += job[i].nrank;
        if (!check_list(x, job, i, all, e)) return false;
    }
    return check_lists(x, job, e);
}

/* ---- runs */

/* All jobs at the present point, each with its own settings. */
static bool make_jobs(struct expansion *x, struct run_spec *job)
{
    const struct scenario_jobs *jobs = x->scenario->jobs;
    bool fine = true;
    for (int i = 0; i < jobs->n && fine; i++) {
        x->job = &jobs->job[i].set;
        /* Resolved as a run of its own, sizes and parameters included. */
        fine = expand_spec(x, &job[i]) && expand_path(x, &job[i]);
        /* Zeros behind the name: identities compare bytes. */
        memset(&job[i].job, 0, sizeof job[i].job);
        text_copy(job[i].job.name, sizeof job[i].job.name, jobs->job[i].name);
        job[i].job.number = i + 1;
        job[i].job.start = jobs->job[i].start;
    }
    /* From here on settings are those of all again. */
    x->job = NULL;
    return fine;
}

/* What all combinations share: the jobs as others see them, and their texts. */
static struct job_set make_set(struct expansion *x, const struct run_spec *job, char digest[17])
{
    const int n = x->scenario->jobs->n;
    struct arena *a = x->plan->arena;
    /* They live as long as the plan: every run of it points here. */
    struct run_spec *alone = TAKE(a, n, struct run_spec);
    const struct run_spec **member = TAKE(a, n, const struct run_spec *);
    const char **text = TAKE(a, n, const char *);
    for (int i = 0; i < n; i++) {
        alone[i] = job_alone(&job[i]);
        member[i] = &alone[i];
        text[i] = identity_job(x->identity, &alone[i], a);
    }
    /* Nobody is idle here: each combination says so itself. */
    const struct job_set set = {.n = n, .job = member, .text = text};
    /* The machine without anybody's place on it. */
    struct run_spec bare = job_alone(&job[0]);
    bare.machine = job[0].machine;
    bare.machine.placement = (struct placement_spec){.seed = 1};
    memset(&bare.job, 0, sizeof bare.job);
    /* Whatever the place of the first job is, the machine is the same. */
    struct text machine = {0};
    fields_print(&machine_table, &bare.machine, false, &machine);
    job_set_digest(&set, machine.s, digest);
    text_free(&machine);
    return set;
}

/* Who else runs: names up to the room there is. */
static void name_others(const struct scenario_jobs *jobs, const bool *runs, int own, char *beside)
{
    struct text t = {0};
    int n = 0;
    for (int i = 0; i < jobs->n; i++) {
        if (i == own || !runs[i]) continue;
        /* Names have neither blanks nor plus signs. */
        text_add(&t, "%s%s", n++ > 0 ? " + " : "", jobs->job[i].name);
    }
    /* Many names are counted: the lines of the other jobs have them all. */
    memset(beside, 0, JOB_BESIDE);
    if (t.length < JOB_BESIDE) text_copy(beside, JOB_BESIDE, t.s != NULL ? t.s : "");
    else snprintf(beside, JOB_BESIDE, "%d jobs", n);
    text_free(&t);
}

/* The runs of one combination, behind each other; how many, -1 with x->err. `room`: why the jobs do
 * not fit, NULL: they do. */
static int add_combination(struct expansion *x, const struct combination *c,
                           const struct run_spec *job, const struct job_set *all,
                           const char *digest, const struct err *room, struct run_spec *run)
{
    struct arena *a = x->plan->arena;
    struct job_set *set = TAKE(a, 1, struct job_set);
    /* Only this differs between combinations. */
    bool *idle = TAKE(a, all->n, bool);
    for (int i = 0; i < all->n; i++) idle[i] = !c->runs[i];
    *set = *all;
    set->idle = idle;
    int n = 0;
    for (int i = 0; i < all->n; i++) {
        if (!c->runs[i]) continue;
        /* A run that a condition leaves out is overwritten by the next. */
        struct run_spec *r = &run[n];
        *r = job[i];
        name_others(c->jobs, c->runs, i, r->job.beside);
        text_copy(r->job.set, sizeof r->job.set, digest);
        r->jobs = set;
        /* Messages name the job's own ranks. */
        x->job = &c->jobs->job[i].set;
        x->room = room;
        const int made = expand_finish(x, r);
        x->job = NULL;
        x->room = NULL;
        if (made < 0) return -1;
        n += made;
    }
    return n;
}

int expand_jobs(struct expansion *x, struct run_spec *run)
{
    const struct scenario_jobs *jobs = x->scenario->jobs;
    struct run_spec *job = TAKE(x->plan->arena, jobs->n, struct run_spec);
    char digest[17];
    if (!make_jobs(x, job)) return -1;
    /* What is swept differs from point to point, so each point has a set of its own. */
    const struct job_set set = make_set(x, job, digest);
    struct combination c = combination_start(jobs);
    int n = 0;
    /* Jobs that do not fit are refused together: none of them could run. Asked once, as those that
     * are idle keep their places. */
    struct err room;
    err_clear(&room);
    const bool fits =
        check_room(x, job, &room) && expand_fits(x, &job[0].machine, job[0].nrank, &set, &room);
    /* One behind the other: alone, pairs, all. */
    while (combination_next(&c)) {
        const int made = add_combination(x, &c, job, &set, digest, fits ? NULL : &room, &run[n]);
        if (made < 0) return -1;
        n += made;
    }
    return n;
}
